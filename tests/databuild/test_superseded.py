"""What the stored surfaces make of rows of known changes."""

import json
from collections import Counter

import pytest
from rosimpact.databuild.superseded import derive_bounds, drop_superseded, judge_row
from rosimpact.impact.targets.changes import load_rows
from rosimpact.impact.targets.tables import DATA


@pytest.mark.parametrize(
    ("kind", "package", "old", "new", "removed_in", "verdict"),
    [
        # Versions before the first that has a header lack it, and it is not gone there.
        ("header-removed", "mavros", "mavros/gps_conversions.h", "", "0.20.0", "answered"),
        ("header-removed", "mavros", "mavros/gps_conversions.h", "", "kinetic", "contradicted"),
        # Versions of a release branch lack it, and later ones of another have it: it was gone at last with Noetic.
        ("header-removed", "roscpp", "ros/internal/condition_variable.h", "", "noetic", "answered"),
        ("header-removed", "roscpp", "ros/internal/condition_variable.h", "", "melodic", "contradicted"),
        # A member goes with its class.
        ("api-removed", "moveit_ros_planning_interface", "moveit::planning_interface::MoveGroup::Plan", "", "0.10.6",
         "answered"),
        ("api-removed", "rclcpp", "rclcpp::GenericRate", "rclcpp::Rate", "29.0.0", "contradicted"),
        ("api-removed", "rclcpp", "rclcpp::GenericRate", "rclcpp::Rate", "28.3.2", "more"),
        # What is made of interfaces, the table of interfaces tells.
        ("header-removed", "cob_srvs", "cob_srvs/SetMaxVel.h", "", "0.6.3", "answered"),
        ("api-removed", "cob_srvs", "cob_srvs::SetMaxVel", "", "0.6.3", "answered"),
        ("python-removed", "nav2_msgs", "nav2_msgs.action.BackUp.Goal.NONE", "", "1.3.0", "answered"),
        ("api-removed", "no_such_package", "no_such_package::Name", "", "1.0.0", "unknown"),
    ],
)  # fmt: skip
def test_what_becomes_of_a_row(kind, package, old, new, removed_in, verdict):
    assert judge_row(kind, package, old, new, removed_in, 0) == verdict


@pytest.mark.parametrize(
    ("kind", "package", "old", "bounds"),
    [
        ("api-removed", "rclcpp", "rclcpp::GenericRate", {2: "28.3.2"}),
        ("header-removed", "mavros", "mavros/gps_conversions.h", {1: "0.20.0"}),
        # Each generation lost it in a version of its own.
        ("header-removed", "moveit_core", "moveit/macros/deprecation.h", {1: "1.1.6", 2: "2.12.0"}),
        ("api-removed", "rclcpp", "rclcpp::Node", {}),
    ],
)
def test_a_bound_is_the_first_stored_version_without_the_name(kind, package, old, bounds):
    assert derive_bounds(kind, package, old, 0) == bounds


@pytest.mark.parametrize(
    ("group", "verdicts", "left"),
    [
        # Every stored version has it.
        ({"kind": "header-renamed", "package": "tf2", "removed_in": "lyrical",
          "names": {"tf2/visibility_control.h": "tf2/visibility_control.hpp"}}, ["wrong"], []),
        # 2.0.0 is where ROS 2 begins.
        ({"kind": "api-removed", "package": "slam_toolbox", "removed_in": "1.5.7", "back_in": "2.0.0",
          "names": {"vis_utils::toMarker": ""}}, ["answered"], []),
        # Each generation lost it in a version of its own, and only a row tells what for.
        ({"kind": "msg-field", "package": "moveit_msgs", "removed_in": "2.3.0",
          "names": {"moveit_msgs/MotionPlanRequest.cartesian_speed_end_effector_link": "moveit_msgs/A.b"}},
         ["more"], [("0.11.3", 1), ("2.3.0", 2)]),
    ],
)  # fmt: skip
def test_what_becomes_of_a_group(group, verdicts, left, tmp_path):
    file = tmp_path / "changes.json"
    file.write_text(json.dumps({"changes": [{"source": "its change log", **group}]}))
    content, count = drop_superseded(file)
    assert [verdict for _, verdict in count] == verdicts
    assert [(one["removed_in"], one["ros"]) for one in content["changes"]] == left


def drop_library(tmp_path, name="changes_libraries.json", **group):
    """What becomes of a group of rows on a library: verdicts, and (names, bounds) of the groups that are left."""
    file = tmp_path / name
    file.write_text(json.dumps({"changes": [{"source": "its change log", "library": True, **group}]}))
    content, count = drop_superseded(file)
    left = [(list(one["names"]), {key: one[key] for key in ("last_in", "removed_in", "deprecated_in") if key in one})
            for one in content["changes"]]  # fmt: skip
    return {verdict for _, verdict in count if verdict != "unknown"}, left


@pytest.mark.parametrize(
    ("package", "bound", "names", "verdicts", "left"),
    [
        # Debian's newest version declares it.
        ("opencv", {"removed_in": "4.0"}, ["cv::estimateRigidTransform"], {"wrong"}, []),
        ("ffmpeg-libavcodec", {"removed_in": "8.0"}, ["av_buffersrc_get_status", "av_no_such_name"], {"wrong"},
         [(["av_no_such_name"], {"removed_in": "8.0"})]),
        # It was deprecated before, which stands; and so does each way to spell it.
        ("boost", {"removed_in": "1.87", "deprecated_in": "1.66"}, ["boost::asio::null_buffers", "asio::null_buffers"],
         {"wrong"}, [(["boost::asio::null_buffers", "asio::null_buffers"], {"deprecated_in": "1.66"})]),
        # 1.74 and 1.83 have it, 1.92 has not.
        ("boost", {"removed_in": "1.70"}, ["boost::asio::basic_io_object::get_io_service"], {"contradicted"},
         [(["boost::asio::basic_io_object::get_io_service"], {"last_in": "1.83.0", "removed_in": "1.92.0"})]),
        # One header takes it over from `std`; no other has it.
        ("pcl", {"removed_in": "1.12"}, ["pcl::uint32_t"], set(), [(["pcl::uint32_t"], {"removed_in": "1.12"})]),
        # It is as the row says, or of a library that was not read.
        ("ceres", {"removed_in": "2.2"}, ["ceres::LocalParameterization"], set(),
         [(["ceres::LocalParameterization"], {"removed_in": "2.2"})]),
        ("gazebo-classic", {"removed_in": "9.0"}, ["cv::Mat"], set(), [(["cv::Mat"], {"removed_in": "9.0"})]),
    ],
)  # fmt: skip
def test_what_debian_declares_is_not_gone(package, bound, names, verdicts, left, tmp_path):
    group = {"kind": "api-removed", "package": package, **bound, "names": dict.fromkeys(names, "")}
    assert drop_library(tmp_path, **group) == (verdicts, left)


@pytest.mark.parametrize(
    ("more", "verdicts"), [({}, {"twice"}), ({"unless": ["fcl/old.h"]}, set()), ({"package": "fcl_of_ours"}, set())]
)
def test_what_a_more_special_table_says_too_goes(more, verdicts, tmp_path):
    group = {"kind": "header-removed", "package": "fcl", "removed_in": "0.6", "names": {"fcl/collision.h": ""}, **more}
    found, left = drop_library(tmp_path, "changes.json", **group)
    assert (found, bool(left)) == (verdicts, not verdicts)
    # It is the general table alone that gives way.
    assert drop_library(tmp_path, **group) == (set(), [(["fcl/collision.h"], {"removed_in": "0.6"})])


@pytest.mark.parametrize("file", sorted(DATA.glob("changes*.json*")), ids=lambda path: path.name)
def test_no_shipped_row_is_answered_by_the_surfaces(file):
    _, count = drop_superseded(file)
    gone = ("answered", "contradicted", "wrong", "bare", "twice")
    assert not [(kind, verdict) for kind, verdict in count if verdict in gone]


def test_no_name_has_two_rows_that_say_the_same():
    rows = Counter(
        (row.kind.partition("-")[0], row.package, row.old, row.new, row.removed_in, row.deprecated_in, row.new_since)
        for row in load_rows()
    )
    assert [row for row, number in rows.items() if number > 1] == []
