"""widened-publish-condition: a message is published in more cases than at the base.

What it does
    Compares the conditions of every publish statement with the base, as tightened-publish-condition does. Reports a
    statement whose old condition implies the new one, and is not implied by it.

Why it matters
    Whoever reads the topic gets messages in situations in which there were none, and perhaps with values that did not
    occur.

Severity
    note.

Not reported
    What tightened-publish-condition leaves alone.
"""

from collections.abc import Iterator

from ...logic.changes import Change
from ...model.workspace import Workspace
from ..rule import Hit, rule
from .statements import conditions, hits


@rule(severity="note", compares=True)
def widened_publish_condition(workspace: Workspace, base: Workspace) -> Iterator[Hit]:
    def says(change: Change) -> str:
        return f"`{change.topic}` is published in more cases, {change.why}: {conditions(change)}"

    cure = "make sure that its readers can handle the messages that come now"
    yield from hits(workspace, base, lambda change: change.kind == "widened", says, cure)
