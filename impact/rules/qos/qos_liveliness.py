"""qos-liveliness: a subscriber asks for a stricter liveliness than the publisher offers.

What it does
    Reports a subscriber that asks for liveliness `manual_by_topic` of a publisher whose liveliness is `automatic`, and
    a subscriber whose lease is shorter than the publisher's. Both have to be known.

Why it breaks
    The two are not connected and no message arrives; the running nodes warn about incompatible QoS.

Example
    create_publisher<Imu>("imu", rclcpp::QoS(5).liveliness(RMW_QOS_POLICY_LIVELINESS_AUTOMATIC));
    create_subscription<Imu>("imu", rclcpp::QoS(5).liveliness(RMW_QOS_POLICY_LIVELINESS_MANUAL_BY_TOPIC), on_imu);

Use instead
    create_publisher<Imu>("imu", rclcpp::QoS(5).liveliness(RMW_QOS_POLICY_LIVELINESS_MANUAL_BY_TOPIC));

Not reported
    Leases that are not known as numbers; nodes that no launch file starts together, if one of them has another partner.
"""

from ..vocabulary import Workspace, rule
from .offers import build_qos_text, iterate_qos_pairs, make_diagnostic


@rule(
    scope="flow",
    severity="warning",
    preview=True,
    texts={
        "kind": build_qos_text(
            "asks for liveliness `manual_by_topic`",
            "offers `automatic`",
            help="make the publisher assert its liveliness (`manual_by_topic`), or the subscriber `automatic`",
        ),
        "lease": build_qos_text(
            "asks for a liveliness lease of {asked:g} s",
            "offers {offered:g} s",
            help="give the publisher a lease of at most {asked:g} s",
        ),
    },
)
def qos_liveliness(workspace: Workspace):
    for pair, offered, asked in iterate_qos_pairs(workspace):
        if offered.liveliness == "automatic" and asked.liveliness == "manual_by_topic":
            yield make_diagnostic(pair, "kind")
        elif offered.lease is not None and asked.lease is not None and offered.lease > asked.lease:
            yield make_diagnostic(pair, "lease", offered=offered.lease, asked=asked.lease)
