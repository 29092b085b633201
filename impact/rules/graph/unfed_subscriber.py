"""unfed-subscriber: a node listens to what nothing publishes.

What it does
    Reports subscribers of messages that the workspace itself defines, and that nothing in the workspace publishes,
    whatever the topic. One note a topic.

Why it matters
    Its callback never runs: the publisher was renamed, is missing, or was never written.

Severity
    note.

Example
    self.create_subscription(BatteryReport, "battery", self.on_battery, 10)      # nobody publishes battery

Use instead
    Remove the subscriber, or publish the topic.

Not reported
    Topics of types from other packages, which drivers, simulators and other workspaces publish as well; private topics
    and those for debugging; types that something in the workspace publishes under another name.
"""

from ...model.cmake.build import At
from ...model.flow.edges import said
from ...model.workspace import Workspace
from ..rule import Hit, rule
from .own_topics import one_sided


@rule(severity="note", preview=True, flow=True)
def unfed_subscriber(workspace: Workspace):
    for one in one_sided(workspace, "subscriber"):
        endpoint = one.endpoint
        yield Hit(
            At(endpoint.path, endpoint.line),
            endpoint.topic,
            f"nothing in the workspace publishes `{endpoint.type}`, which `{said(one.node)}` reads on "
            f"`{endpoint.topic}`",
            f"publish `{endpoint.topic}`, or stop subscribing to it",
            one.node.package,
        )
