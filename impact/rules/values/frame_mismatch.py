"""frame-mismatch: a publisher sends a frame that its subscriber does not handle.

What it does
    Reports a publish statement whose message has a `frame_id` or `child_frame_id` that is none of those for which a
    subscriber does something.

Why it matters
    The subscriber drops every message of this publisher.

Severity
    warning; note where another subscriber of the workspace does something with it.

Example
    msg.header.frame_id = "odom"     # the subscriber tests for "map"

Use instead
    msg.header.frame_id = "map"

Not reported
    Frames that come from somewhere else, frames longer than the bound for texts. It runs only where it, or `values`, is
    selected by name.
"""

from ...values.matching import FRAME
from ..vocabulary import Text, Workspace, rule
from .mismatches import find_diagnostics


@rule(
    scope="workspace",
    severity="warning",
    preview=True,
    on_request=True,
    texts=Text(
        "`{topic}` is sent with the frame {value}, which `{subscriber}` ({reader}) does not handle"
        "[[; first sent at {origin}]]",
        help="use the same frame on both sides",
    ),
)
def frame_mismatch(workspace: Workspace):
    return find_diagnostics(workspace, FRAME)
