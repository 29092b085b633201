"""unreachable-publish: a publish statement that ran at the base never runs any more.

What it does
    Reports a publish statement that stands behind a `return`, `throw`, `break` or the like which always happens, or
    whose conditions contradict each other (decided with z3), and that could be reached at the base.

Why it breaks
    Nothing is published there any more, though the statement is still to be seen.

Severity
    warning; note when nothing in the workspace reads the topic.

Example
    return;                       // left over from debugging
    pub_.publish(message);

Use instead
    pub_.publish(message);

Not reported
    Statements that were never reached; contradictions between conditions that something may change in between.
"""

from collections.abc import Iterator

from ...logic.changes import Change
from ...model.workspace import Workspace
from ..rule import Hit, rule
from .statements import hits, quoted


@rule(severity="warning", compares=True)
def unreachable_publish(workspace: Workspace, base: Workspace) -> Iterator[Hit]:
    def says(change: Change) -> str:
        was = f"it ran under {quoted(change.old)}"
        return f"`{change.topic}` is published here no longer: the statement {change.why}; {was}"

    yield from hits(
        workspace, base, lambda change: change.unreachable, says, "remove the statement, or what keeps it off"
    )
