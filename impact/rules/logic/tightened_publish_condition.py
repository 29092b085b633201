"""tightened-publish-condition: a message is published in fewer cases than at the base.

What it does
    Compares the conditions of every publish statement with the base: nested branches, early returns, loops, and those
    of the functions that lead there. Reports a statement whose new condition implies the old one, and is not implied by
    it.

Why it breaks
    Whoever reads the topic waits for messages that no longer come. Nothing fails to compile, and nothing says so.

Severity
    warning; note when nothing in the workspace reads the topic.

Example
    if (range_max <= 0.0) { return; }        // new
    cloud_pub_.publish(cloud);               // a viewer waits for it

Use instead
    cloud_pub_.publish(cloud);               // as before, perhaps empty; or tell the readers of the topic

Not reported
    Conditions that were reworded, moved into helpers or given names; statements of which it is not known what leads to
    them; statements that are new or gone, and conditions that neither imply the other (`rosimpact impact` lists them).
"""

from collections.abc import Iterator

from ...logic.changes import Change
from ...model.workspace import Workspace
from ..rule import Hit, rule
from .statements import conditions, hits


@rule(severity="warning", compares=True)
def tightened_publish_condition(workspace: Workspace, base: Workspace) -> Iterator[Hit]:
    def fits(change: Change) -> bool:
        return change.kind == "tightened" and not change.unreachable

    def says(change: Change) -> str:
        return f"`{change.topic}` is published in fewer cases, {change.why}: {conditions(change)}"

    yield from hits(
        workspace, base, fits, says, "make sure that its readers do without the messages that no longer come"
    )
