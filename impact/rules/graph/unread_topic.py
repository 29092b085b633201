"""unread-topic: nothing subscribes to a message that a node publishes.

What it does
    Reports publishers of messages that the workspace itself defines and that nothing in the workspace subscribes to, on
    any topic. One note for each topic.

Why it matters
    The messages are published for nothing, or the subscriber was renamed or never written.

Example
    self.create_publisher(BatteryReport, "battery", 10)          # nothing subscribes to battery

Use instead
    Remove the publisher, or subscribe to it.

Not reported
    Topics whose types come from other packages, since tools, other workspaces and recordings may read them; private
    topics and topics for debugging; types that something in the workspace subscribes to on another topic.
"""

from ..vocabulary import Text, Workspace, rule
from .one_sided import find_one_sided


@rule(
    scope="flow",
    severity="note",
    preview=True,
    texts=Text(
        "nothing in the workspace subscribes to `{type}`, which `{node}` publishes on `{subject}`",
        help="subscribe to `{subject}`, or remove the publisher",
    ),
)
def unread_topic(workspace: Workspace):
    return find_one_sided(workspace, "publisher")
