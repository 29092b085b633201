"""unread-topic: nothing reads what a node publishes.

What it does
    Reports publishers of messages that the workspace itself defines, and that nothing in the workspace subscribes to,
    whatever the topic. One note a topic.

Why it matters
    It is work for nobody, or a sign that the reader was renamed or never written.

Severity
    note.

Example
    self.create_publisher(BatteryReport, "battery", 10)          # nobody subscribes to battery

Use instead
    Remove the publisher, or subscribe to it.

Not reported
    Topics of types from other packages, which tools, other workspaces and recordings read as well; private topics and
    those for debugging; types that something in the workspace reads under another name.
"""

from ...model.cmake.build import At
from ...model.flow.edges import said
from ...model.workspace import Workspace
from ..rule import Hit, rule
from .own_topics import one_sided


@rule(severity="note", preview=True, flow=True)
def unread_topic(workspace: Workspace):
    for one in one_sided(workspace, "publisher"):
        endpoint = one.endpoint
        yield Hit(
            At(endpoint.path, endpoint.line),
            endpoint.topic,
            f"nothing in the workspace reads `{endpoint.type}`, which `{said(one.node)}` publishes on "
            f"`{endpoint.topic}`",
            f"subscribe to `{endpoint.topic}`, or stop publishing it",
            one.node.package,
        )
