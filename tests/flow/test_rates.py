"""How often a timer fires, by its period as the source has it."""

import pytest
from rosimpact.impact.report.graph.rates import find_rate


@pytest.mark.parametrize(
    ("period", "rate"),
    [
        ("100ms", 10), ("1s", 1), ("0.5", 2), (".25", 4), ("1.0 / 30", 30), ("1/20.0", 20), ("1.0f / 50.0f", 50),
        ("std::chrono::milliseconds(20)", 50), ("std::chrono::seconds{2}", 0.5), ("ros::Duration(0.1)", 10),
        ("std::chrono::duration<double>(1.0 / 50)", 50), ("ros::Rate(10)", 10), ("rospy.Duration(4)", 0.25),
        ("ros::Duration(1.0 / rate_)", None), ("period_", None), ("0", None), ("1/0", None), ("ros::Duration(0)", None),
        ("rclcpp::Duration(1, 0)", None), ("", None), ("std::chrono::milliseconds(period)", None),
    ],
)  # fmt: skip
def test_rates(period, rate):
    assert find_rate(period) == (rate and pytest.approx(rate))
