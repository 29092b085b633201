"""size-mismatch: a publisher sends arrays that are shorter than a subscriber reads.

What it does
    Reports a line of a subscriber that reads an element which an array does not have in a message that a publisher of
    the workspace sends: one array is indexed by the size of another, or by a number.

Why it breaks
    The node reads past the end of the array, or ends with an exception.

Severity
    As for crashing-value: error where nothing else decides, warning where what the publisher receives does, note where
    the state of the subscriber or something that is not known does.

Example
    for (size_t i = 0; i < msg->name.size(); ++i)
      use(msg->position[i]);         // a publisher fills name and leaves position empty

Use instead
    if (msg->position.size() < msg->name.size()) return;

Not reported
    Sizes beyond the bounds of the exploration, publishers whose message is not known. It runs only where it, or
    `values`, is selected by name.
"""

from ...values.matching import SIZE
from ..vocabulary import Text, Workspace, rule
from .mismatches import find_diagnostics


@rule(
    scope="workspace",
    severity="error",
    preview=True,
    on_request=True,
    texts=Text(
        "`{topic}` {word} sent with arrays of these sizes: {value} ({sender}); a longer one {reads} here"
        "[[; first sent at {origin}]]",
        help="compare the sizes before this line, or send all elements",
    ),
)
def size_mismatch(workspace: Workspace):
    return find_diagnostics(workspace, SIZE)
