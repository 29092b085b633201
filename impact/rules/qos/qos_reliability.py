"""qos-reliability: a subscriber asks for reliable delivery of what is published as best effort.

What it does
    Reports a subscriber that is `reliable` on a topic whose publisher is `best_effort`. Both have to tell so: by a
    profile, a setting, or the default that a bare depth stands for.

Why it breaks
    The two do not match, and no message arrives; the nodes warn of incompatible QoS once they run.

Severity
    warning.

Example
    create_publisher<LaserScan>("scan", rclcpp::SensorDataQoS());
    create_subscription<LaserScan>("scan", 10, on_scan);                         // 10: reliable

Use instead
    create_subscription<LaserScan>("scan", rclcpp::SensorDataQoS(), on_scan);

Not reported
    A reliable publisher and a best-effort subscriber, which match; qualities that are not told, or left to the system;
    nodes that no launch file starts together, when one of them has somebody else to talk to.
"""

from ...model.workspace import Workspace
from ..rule import rule
from .offers import meetings, refused


@rule(scope="flow", severity="warning", preview=True)
def qos_reliability(workspace: Workspace):
    for pair, offered, asked in meetings(workspace):
        if offered.reliability == "best_effort" and asked.reliability == "reliable":
            cure = "make the subscriber best effort (`SensorDataQoS`), or the publisher reliable"
            yield refused(pair, "is best effort", "is reliable", cure)
