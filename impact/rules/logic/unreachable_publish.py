"""unreachable-publish: a publish statement that ran at the base can no longer run.

What it does
    Reports a publish statement that follows a `return`, `throw`, `break` or the like that always runs, or whose
    conditions contradict each other (decided with z3), and that could run at the base.

Why it breaks
    Nothing is published there any more, although the statement is still in the source.

Severity
    warning; note when nothing in the workspace subscribes to the topic.

Example
    return;                       // left over from debugging
    pub_.publish(message);

Use instead
    pub_.publish(message);

Not reported
    Statements that could not run at the base either; conditions on values that may change between the two tests.
"""

from ..vocabulary import Text, Workspace, rule
from .statements import READERS, find_changes


@rule(
    scope="change",
    severity="warning",
    texts=Text(
        "`{subject}` is no longer published here: the statement {change}; its condition was {old:no condition}; "
        + READERS,
        help="remove the statement, or what keeps it from running",
    ),
)
def unreachable_publish(workspace: Workspace, base: Workspace):
    return find_changes(workspace, base, lambda change: change.unreachable)
