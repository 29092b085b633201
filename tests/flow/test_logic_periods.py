"""Periods as code writes them."""

from fractions import Fraction

import pytest
from rosimpact.impact.logic.periods import parse_period

TENTH = Fraction(1, 10)


@pytest.mark.parametrize(
    ("text", "seconds"),
    [
        ("100ms", TENTH),
        ("0.1s", TENTH),
        ("std::chrono::milliseconds(100)", TENTH),
        ("chrono::milliseconds{100}", TENTH),
        ("ros::Duration(0.1)", TENTH),
        ("rclcpp::Duration::from_seconds(0.1)", TENTH),
        ("ros::Rate(10)", TENTH),
        ("ros::Duration(1.0 / 10)", TENTH),
        ("0.1", TENTH),
        ("0.05f * 2", TENTH),
        ("1'500us", Fraction(15, 10_000)),
        ("ros::Duration(1 / 10)", None),
        ("std::chrono::duration(1.0 / rate_)", None),
        ("std::chrono::duration(100)", None),
        ("period_", None),
        ("ros::Rate(0)", None),
        ("1.0 / 0", None),
        ("9" * 90, None),
        ("", None),
    ],
)
def test_a_period_in_seconds(text: str, seconds: Fraction | None) -> None:
    assert parse_period(text) == seconds
