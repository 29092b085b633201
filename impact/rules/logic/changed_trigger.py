"""changed-trigger: what makes a node publish is another than at the base.

What it does
    Compares what triggers each publish statement with the base: the callback and its topic, the timer and its period, a
    loop and its rate; and the publisher's queue, latch and quality of service.

Why it breaks
    Messages come more seldom, more often, at another moment or to fewer subscribers. Readers with a timeout, a filter
    or a synchronizer behave otherwise, and nothing says so.

Severity
    warning; note when nothing in the workspace reads the topic.

Example
    timer_ = nh.createTimer(ros::Duration(5.0), &Driver::send, this);     // was 0.1

Use instead
    timer_ = nh.createTimer(ros::Duration(0.1), &Driver::send, this);     // or tell the readers of the topic

Not reported
    Statements of which it is not known what leads to them; callbacks and timers that are merely called otherwise.
"""

from collections.abc import Iterator

from ...logic.changes import Change
from ...model.workspace import Workspace
from ..rule import Hit, rule
from .statements import hits


@rule(severity="warning", compares=True)
def changed_trigger(workspace: Workspace, base: Workspace) -> Iterator[Hit]:
    def says(change: Change) -> str:
        return f"`{change.topic}` is published by another trigger: {change.why}"

    cure = "make sure that its readers can do with the new pace, moment and quality of service"
    yield from hits(workspace, base, lambda change: change.kind == "trigger changed", says, cure)
