"""impossible-branch: a subscriber waits for a value that no publisher sends.

What it does
    Reports a callback that tells values of a field from each other of which one is sent by none of the publishers of
    the topic, where all of them are known and followed to the end.

Why it matters
    The code for this value never runs.

Example
    case Mode::CALIBRATE:            // no publisher sends it
      calibrate();

Use instead
    Remove the case, or send the value.

Not reported
    Topics with a publisher that was not followed, such as a program with a loop, or with one whose name is not known.
    Fields of which every value is handled, and lengths of texts: nothing waits for these.
    It runs only where it, or `values`, is selected by name.
"""

from ...values.matching import IMPOSSIBLE
from ..vocabulary import Text, Workspace, rule
from .mismatches import find_diagnostics


@rule(
    scope="workspace",
    severity="note",
    preview=True,
    on_request=True,
    texts=Text(
        "`{subscriber}` waits for `{subject}` = `{value}` on `{topic}`, which no publisher of the workspace sends",
        help="remove what never runs, or send the value",
    ),
)
def impossible_branch(workspace: Workspace):
    return find_diagnostics(workspace, IMPOSSIBLE)
