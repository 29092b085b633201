"""unhandled-value: a publisher sends a value that no subscriber does anything with.

What it does
    Reports a publish statement whose message has a value in a field with which surely nothing follows in a subscriber
    that tells the values of this field from each other: no publish, no call, no change of state.

Why it matters
    The message is lost without a word. Often a constant was added to the message and not to the subscriber.

Severity
    warning where the subscriber lists the values that it handles and no other subscriber of the workspace does anything
    with this one; note otherwise.

Example
    msg.mode = Mode.CALIBRATE        # the subscriber's switch has no such case
    pub.publish(msg)

Use instead
    Handle the value in the subscriber, or do not send it.

Not reported
    Values that are calculated, subscribers that do nothing but log, publishers and subscribers of which not every way
    could be followed. It runs only where it, or `values`, is selected by name.
"""

from ...values.matching import UNHANDLED
from ..vocabulary import Text, Workspace, rule
from .mismatches import find_diagnostics


@rule(
    scope="workspace",
    severity="warning",
    preview=True,
    on_request=True,
    texts=Text(
        "`{topic}` is sent with `{subject}` = `{value}`, which `{subscriber}` ({reader}) does not handle"
        "[[; first sent at {origin}]]",
        help="handle the value in the subscriber, or do not send it",
    ),
)
def unhandled_value(workspace: Workspace):
    return find_diagnostics(workspace, UNHANDLED)
