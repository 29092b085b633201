"""changed-trigger: a message is published by another trigger, or with another quality of service, than at the base.

What it does
    Compares what triggers each publish statement with the base: the callback and its topic, the timer and its period, a
    loop and its rate; and the publisher's queue, latch and quality of service.

Why it breaks
    Messages arrive less often, more often, at other times or at fewer subscribers. Subscribers with a timeout, a filter
    or a synchronizer behave differently, without any warning.

Severity
    warning; note when nothing in the workspace subscribes to the topic.

Example
    timer_ = nh.createTimer(ros::Duration(5.0), &Driver::send, this);     // was 0.1

Use instead
    timer_ = nh.createTimer(ros::Duration(0.1), &Driver::send, this);     // or inform the users of the topic

Not reported
    Statements whose trigger is not known; callbacks and timers that only have another name.
"""

from ..vocabulary import Text, Workspace, rule
from .statements import READERS, find_changes


@rule(
    scope="change",
    severity="warning",
    texts=Text(
        f"the trigger or the quality of service of `{{subject}}` changed: {{change}}; {READERS}",
        help="check that the subscribers tolerate the new rate, trigger and quality of service",
    ),
)
def changed_trigger(workspace: Workspace, base: Workspace):
    return find_changes(workspace, base, lambda change: change.kind == "trigger changed")
