"""crashing-value: a publisher can send a message that crashes a subscriber.

What it does
    Explores what publishers put into messages and what subscribers do with them (`rosimpact values` does the same and
    shows more), and reports a line of a subscriber that fails for a message that a publisher of the workspace sends:
    a division by zero, an index out of range, a null pointer, an exception that nobody catches, a failed assertion.

Why it breaks
    The node ends as soon as the message arrives. In rospy the callback alone ends, and the message is lost.

Severity
    error where the publisher sends this very message without being asked, or because of what it is known to receive,
    and nothing else decides; warning where what the publisher receives decides, in rospy, in tests, and where launch
    files start one of the two programs without the other; note where the state of the subscriber, or something that is
    not known, decides.

Example
    rate_ = 1000 / msg->period;      // a publisher leaves period at 0

Use instead
    if (msg->period == 0) return;

Not reported
    Values of other sizes than were looked at, publishers whose topic or message is not known, other types of the same
    topic. The rule takes seconds for each callback: it runs only where it, or `values`, is selected by name.
"""

from ...values.matching import CRASHING
from ..vocabulary import Text, Workspace, rule
from .mismatches import find_diagnostics


@rule(
    scope="workspace",
    severity="error",
    preview=True,
    on_request=True,
    texts=Text(
        "`{topic}` {word} sent with `{subject}` = `{value}` ({sender}), which {ends} in {crash} here"
        "[[; first sent at {origin}]]",
        help="test the value before this line, or do not send it",
    ),
)
def crashing_value(workspace: Workspace):
    return find_diagnostics(workspace, CRASHING)
