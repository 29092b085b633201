"""qos-deadline: a subscriber asks for a shorter deadline than the publisher offers.

What it does
    Reports a subscriber whose deadline is shorter than that of the topic's publisher. Both have to be known as numbers.

Why it breaks
    The two are not connected and no message arrives; the running nodes warn about incompatible QoS.

Example
    create_publisher<Imu>("imu", rclcpp::QoS(5).deadline(200ms));
    create_subscription<Imu>("imu", rclcpp::QoS(5).deadline(100ms), on_imu);

Use instead
    create_publisher<Imu>("imu", rclcpp::QoS(5).deadline(100ms));

Not reported
    Deadlines that are not known as numbers; nodes that no launch file starts together, if one of them has another
    partner.
"""

from ..vocabulary import Workspace, rule
from .offers import build_qos_text, iterate_qos_pairs, make_diagnostic


@rule(
    scope="flow",
    severity="warning",
    preview=True,
    texts=build_qos_text(
        "asks for a deadline of {asked:g} s",
        "offers {offered:g} s",
        help="give the publisher a deadline of at most {asked:g} s",
    ),
)
def qos_deadline(workspace: Workspace):
    for pair, offered, asked in iterate_qos_pairs(workspace):
        if offered.deadline is not None and asked.deadline is not None and offered.deadline > asked.deadline:
            yield make_diagnostic(pair, offered=offered.deadline, asked=asked.deadline)
