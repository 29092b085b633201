"""What the stored surfaces make of rows of known changes."""

from collections import Counter

import pytest
from rosimpact.databuild.superseded import derive_bound, drop_superseded, judge_row
from rosimpact.impact.targets.changes import load_rows
from rosimpact.impact.targets.snapshot import DATA


@pytest.mark.parametrize(
    ("kind", "package", "old", "new", "removed_in", "verdict"),
    [
        # Versions before the first that has a header lack it, and it is not gone there.
        ("header-removed", "mavros", "mavros/gps_conversions.h", "", "0.20.0", "answered"),
        ("header-removed", "mavros", "mavros/gps_conversions.h", "", "kinetic", "contradicted"),
        # A member goes with its class.
        ("api-removed", "moveit_ros_planning_interface", "moveit::planning_interface::MoveGroup::Plan", "", "0.10.6",
         "answered"),
        ("api-removed", "rclcpp", "rclcpp::GenericRate", "rclcpp::Rate", "29.0.0", "contradicted"),
        ("api-removed", "rclcpp", "rclcpp::GenericRate", "rclcpp::Rate", "28.3.2", "more"),
        ("api-removed", "no_such_package", "no_such_package::Name", "", "1.0.0", "unknown"),
    ],
)  # fmt: skip
def test_what_becomes_of_a_row(kind, package, old, new, removed_in, verdict):
    assert judge_row(kind, package, old, new, removed_in, 0) == verdict


@pytest.mark.parametrize(
    ("kind", "package", "old", "bound"),
    [
        ("api-removed", "rclcpp", "rclcpp::GenericRate", ("28.3.2", 2)),
        ("header-removed", "mavros", "mavros/gps_conversions.h", ("0.20.0", 1)),
        # Each generation lost it in a version of its own.
        ("header-removed", "moveit_core", "moveit/macros/deprecation.h", ("", 0)),
        ("api-removed", "rclcpp", "rclcpp::Node", ("", 0)),
    ],
)
def test_a_bound_is_the_first_stored_version_without_the_name(kind, package, old, bound):
    assert derive_bound(kind, package, old, 0) == bound


@pytest.mark.parametrize("file", sorted(DATA.glob("changes*.json")), ids=lambda path: path.name)
def test_no_shipped_row_is_answered_by_the_surfaces(file):
    _, count = drop_superseded(file)
    assert not [(kind, verdict) for kind, verdict in count if verdict in ("answered", "bare")]


def test_no_name_has_two_rows_that_say_the_same():
    rows = Counter(
        (row.kind.partition("-")[0], row.package, row.old, row.new, row.removed_in, row.deprecated_in, row.new_since)
        for row in load_rows()
    )
    assert [row for row, number in rows.items() if number > 1] == []
