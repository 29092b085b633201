"""qos-reliability: a subscriber asks for reliable delivery, and the publisher offers best effort.

What it does
    Reports a subscriber that is `reliable` on a topic whose publisher is `best_effort`. Both have to be known: from a
    profile, a setting, or the default of a plain queue depth.

Why it breaks
    The two are not connected and no message arrives; the running nodes warn about incompatible QoS.

Example
    create_publisher<LaserScan>("scan", rclcpp::SensorDataQoS());
    create_subscription<LaserScan>("scan", 10, on_scan);                         // 10: reliable

Use instead
    create_subscription<LaserScan>("scan", rclcpp::SensorDataQoS(), on_scan);

Not reported
    A reliable publisher and a best-effort subscriber, which match; settings that are not known, or are the default of
    the system; nodes that no launch file starts together, if one of them has another partner.
"""

from ..vocabulary import Workspace, rule
from .offers import build_qos_text, iterate_qos_pairs, make_diagnostic


@rule(
    scope="flow",
    severity="warning",
    preview=True,
    texts=build_qos_text(
        "asks for reliable delivery",
        "offers best effort",
        help="make the subscriber best effort (`SensorDataQoS`), or the publisher reliable",
    ),
)
def qos_reliability(workspace: Workspace):
    for pair, offered, asked in iterate_qos_pairs(workspace):
        if offered.reliability == "best_effort" and asked.reliability == "reliable":
            yield make_diagnostic(pair)
