"""qos-deadline: a subscriber wants messages more often than the publisher promises.

What it does
    Reports a subscriber whose deadline is shorter than that of the topic's publisher. Both have to be told as numbers.

Why it breaks
    The two do not match, and no message arrives; the nodes warn of incompatible QoS once they run.

Severity
    warning.

Example
    create_publisher<Imu>("imu", rclcpp::QoS(5).deadline(200ms));
    create_subscription<Imu>("imu", rclcpp::QoS(5).deadline(100ms), on_imu);

Use instead
    create_publisher<Imu>("imu", rclcpp::QoS(5).deadline(100ms));

Not reported
    Deadlines that are not told, or not as numbers; nodes that no launch file starts together, when one of them has
    somebody else to talk to.
"""

from ...model.workspace import Workspace
from ..rule import rule
from .offers import meetings, refused


@rule(scope="flow", severity="warning", preview=True)
def qos_deadline(workspace: Workspace):
    for pair, offered, asked in meetings(workspace):
        if offered.deadline is not None and asked.deadline is not None and offered.deadline > asked.deadline:
            yield refused(
                pair,
                f"promises one every {offered.deadline:g} s",
                f"wants a message every {asked.deadline:g} s",
                f"give the publisher a deadline of at most {asked.deadline:g} s",
            )
