"""qos-durability: a subscriber asks for messages from before it came, and the publisher keeps none.

What it does
    Reports a subscriber that is `transient_local` on a topic whose publisher is `volatile`. Both have to tell so: by a
    profile, a setting, or the default that a bare depth stands for.

Why it breaks
    The two do not match, and no message arrives, not even a new one; the nodes warn of incompatible QoS once they run.

Severity
    warning.

Example
    create_publisher<OccupancyGrid>("map", 1);                                   // 1: volatile
    create_subscription<OccupancyGrid>("map", rclcpp::QoS(1).transient_local(), on_map);

Use instead
    create_publisher<OccupancyGrid>("map", rclcpp::QoS(1).transient_local());

Not reported
    A transient-local publisher and a volatile subscriber, which match; latched publishers of ROS 1; qualities that are
    not told, or left to the system; nodes that no launch file starts together, when one has somebody else to talk to.
"""

from ...model.workspace import Workspace
from ..rule import rule
from .offers import meetings, refused


@rule(scope="flow", severity="warning", preview=True)
def qos_durability(workspace: Workspace):
    for pair, offered, asked in meetings(workspace):
        if offered.durability == "volatile" and asked.durability == "transient_local":
            cure = "make the publisher transient local, or the subscriber volatile"
            yield refused(pair, "is volatile", "is transient local", cure)
