"""unfed-subscriber: a node subscribes to a message that nothing publishes.

What it does
    Reports subscribers of messages that the workspace itself defines and that nothing in the workspace publishes, on
    any topic. One note for each topic.

Why it matters
    Its callback never runs: the publisher was renamed or removed, or was never written.

Example
    self.create_subscription(BatteryReport, "battery", self.on_battery, 10)      # nothing publishes battery

Use instead
    Remove the subscriber, or publish the topic.

Not reported
    Topics whose types come from other packages, since drivers, simulators and other workspaces may publish them;
    private topics and topics for debugging; types that something in the workspace publishes on another topic.
"""

from ..vocabulary import Text, Workspace, rule
from .one_sided import find_one_sided


@rule(
    scope="flow",
    severity="note",
    preview=True,
    texts=Text(
        "nothing in the workspace publishes `{type}`, which `{node}` expects on `{subject}`",
        help="publish `{subject}`, or remove the subscriber",
    ),
)
def unfed_subscriber(workspace: Workspace):
    return find_one_sided(workspace, "subscriber")
