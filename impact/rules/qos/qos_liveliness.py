"""qos-liveliness: a subscriber wants stronger signs of life than the publisher gives.

What it does
    Reports a subscriber that asks for liveliness `manual_by_topic` of a publisher whose liveliness is `automatic`, and
    a subscriber whose lease is shorter than the publisher's. Both have to tell so.

Why it breaks
    The two do not match, and no message arrives; the nodes warn of incompatible QoS once they run.

Severity
    warning.

Example
    create_publisher<Imu>("imu", rclcpp::QoS(5).liveliness(RMW_QOS_POLICY_LIVELINESS_AUTOMATIC));
    create_subscription<Imu>("imu", rclcpp::QoS(5).liveliness(RMW_QOS_POLICY_LIVELINESS_MANUAL_BY_TOPIC), on_imu);

Use instead
    create_publisher<Imu>("imu", rclcpp::QoS(5).liveliness(RMW_QOS_POLICY_LIVELINESS_MANUAL_BY_TOPIC));

Not reported
    Leases that are not told, or not as numbers; nodes that no launch file starts together, when one of them has
    somebody else to talk to.
"""

from ...model.workspace import Workspace
from ..rule import rule
from .offers import meetings, refused


@rule(scope="flow", severity="warning", preview=True)
def qos_liveliness(workspace: Workspace):
    for pair, offered, asked in meetings(workspace):
        if offered.liveliness == "automatic" and asked.liveliness == "manual_by_topic":
            cure = "make the publisher assert its liveliness (manual by topic), or the subscriber automatic"
            yield refused(pair, "gives automatic ones", "wants signs of life by topic", cure)
        elif offered.lease is not None and asked.lease is not None and offered.lease > asked.lease:
            yield refused(
                pair,
                f"promises one every {offered.lease:g} s",
                f"wants a sign of life every {asked.lease:g} s",
                f"give the publisher a lease of at most {asked.lease:g} s",
            )
