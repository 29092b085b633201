"""widened-publish-condition: a message is published in more cases than at the base.

What it does
    Compares the conditions of every publish statement with the base, as tightened-publish-condition does. Reports a
    statement whose old condition implies the new one and is not equivalent.

Why it matters
    Subscribers get messages in situations in which there were none before, and perhaps with values that did not occur
    before.

Not reported
    What tightened-publish-condition does not report.
"""

from ..vocabulary import Text, Workspace, rule
from .statements import CONDITIONS, READERS, find_changes


@rule(
    scope="change",
    severity="note",
    texts=Text(
        f"`{{subject}}` is published in more cases ({{change}}): {CONDITIONS}; {READERS}",
        help="check that the subscribers can handle the additional messages",
    ),
)
def widened_publish_condition(workspace: Workspace, base: Workspace):
    return find_changes(workspace, base, lambda change: change.kind == "widened")
