"""qos-durability: a subscriber asks for messages from before it started, and the publisher does not keep them.

What it does
    Reports a subscriber that is `transient_local` on a topic whose publisher is `volatile`. Both have to be known: from
    a profile, a setting, or the default of a plain queue depth.

Why it breaks
    The two are not connected and no message arrives, not even a new one; the running nodes warn about incompatible QoS.

Example
    create_publisher<OccupancyGrid>("map", 1);                                   // 1: volatile
    create_subscription<OccupancyGrid>("map", rclcpp::QoS(1).transient_local(), on_map);

Use instead
    create_publisher<OccupancyGrid>("map", rclcpp::QoS(1).transient_local());

Not reported
    A transient-local publisher and a volatile subscriber, which match; latched publishers of ROS 1; settings that are
    not known, or are the default of the system; nodes that no launch file starts together, if one of them has another
    partner.
"""

from ..vocabulary import Workspace, rule
from .offers import build_qos_text, iterate_qos_pairs, make_diagnostic


@rule(
    scope="flow",
    severity="warning",
    preview=True,
    texts=build_qos_text(
        "asks for transient local durability",
        "is volatile",
        help="make the publisher transient local, or the subscriber volatile",
    ),
)
def qos_durability(workspace: Workspace):
    for pair, offered, asked in iterate_qos_pairs(workspace):
        if offered.durability == "volatile" and asked.durability == "transient_local":
            yield make_diagnostic(pair)
