"""Known changes of ROS packages: the facts as a target sees them, and the shape of the two files they stand in."""

import re
from pathlib import Path

import pytest
from rosimpact.impact.targets import changes
from rosimpact.impact.targets.changes import DISTROS, iterate_in_force
from rosimpact.impact.targets.distro.distro import DistroTarget
from rosimpact.impact.targets.unpacked import read_table

DATA = Path(changes.__file__).parent / "data"
FILES = ("changes_ros.json", "changes_ros_tags.json.zst")
KINDS = {
    f"{subject}-{what}"
    for subject, whats in {
        "header": "removed renamed",
        "package": "removed renamed",
        "api": "removed renamed changed",
        "python": "removed api",
        "msg": "removed field",
        "cmake": "removed renamed",
    }.items()
    for what in whats.split()
}
BOUND = re.compile(r"\d+(\.\d+)+\Z")
SPELLING = {
    "header": r"[\w./+-]+\.(h|hpp|hh|hxx)",
    "package": r"\w+",
    "api": r"[A-Za-z_]\w*(::[A-Za-z_]\w*)*",
    "python": r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*",
    "cmake": r"[A-Za-z_]\w*(::\w+)?",
    "msg": r"\w+/\w+(\.\w+)?",
}


def read(name):
    return read_table(DATA / name, dict)["changes"]


@pytest.mark.parametrize("name", FILES)
def test_every_group_says_what_when_and_whence(name):
    for group in read(name):
        about = f"{group['package']} {group['kind']} {group['names']}"
        assert group["kind"] in KINDS, about
        assert group["source"] and group["names"], about
        assert group.get("removed_in") or group.get("deprecated_in"), f"a change that never happens: {about}"
        for key in ("removed_in", "deprecated_in", "new_since", "back_in"):
            bound = group.get(key)
            assert not bound or bound == "ros2" or bound in DISTROS or BOUND.match(bound), about


@pytest.mark.parametrize("name", FILES)
def test_names_are_spelt_as_scanners_find_them(name):
    for group in read(name):
        pattern = SPELLING[group["kind"].split("-")[0]]
        for old, new in group["names"].items():
            assert re.fullmatch(pattern, old), old
            assert old != new, old


@pytest.mark.parametrize("name", FILES)
def test_a_file_says_a_thing_once(name):
    told = [
        (group["kind"], group["package"], group.get("ros", 0), old) for group in read(name) for old in group["names"]
    ]
    assert len(told) == len(set(told))


# kind, package, old name, new name, distros where the old one is gone, distros where it is not
SEEN = [
    ("api-removed", "rclcpp", "rclcpp::executor::FutureReturnCode", "rclcpp::FutureReturnCode", "galactic", "foxy"),
    ("api-renamed", "rosidl_generator_c", "rosidl_generator_c__String", "rosidl_runtime_c__String", "foxy", "eloquent"),
    ("api-renamed", "nav2_util", "nav2_util::LifecycleNode", "nav2::LifecycleNode", "lyrical", "humble kilted"),
    ("api-removed", "pluginlib", "PLUGINLIB_DECLARE_CLASS", "PLUGINLIB_EXPORT_CLASS", "melodic noetic", "kinetic"),
    ("header-renamed", "class_loader", "class_loader/class_loader.h", "class_loader/class_loader.hpp", "foxy", ""),
    ("msg-field", "controller_manager_msgs", "controller_manager_msgs/SwitchController_Request.start_controllers",
     "controller_manager_msgs/SwitchController_Request.activate_controllers", "iron jazzy", "humble"),
    ("python-removed", "lifecycle_msgs", "lifecycle_msgs.msg.Transition.TRANSITION_SHUTDOWN",
     "lifecycle_msgs.msg.Transition.TRANSITION_ACTIVE_SHUTDOWN", "dashing", ""),
    ("package-renamed", "gazebo_ros", "gazebo_ros", "ros_gz_sim", "jazzy", "humble noetic"),
]  # fmt: skip


@pytest.mark.parametrize(("kind", "package", "old", "new", "gone", "there"), SEEN)
def test_gone_where_it_is_gone(kind, package, old, new, gone, there):
    for distro in (*gone.split(), *there.split()):
        removed = [row for row, state in iterate_in_force(DistroTarget(distro)) if state == "removed"]
        found = [row for row in removed if (row.kind, row.package, row.old) == (kind, package, old)]
        assert bool(found) == (distro in gone.split()), distro
        assert all(row.new == new for row in found)


def test_numbers_of_ros2_are_not_those_of_ros1():
    # ROS 2's sensor_msgs deprecated it in 0.9.0; ROS 1's, which is 1.13, never did.
    def told(distro):
        rows = iterate_in_force(DistroTarget(distro))
        return {row.old for row, state in rows if row.package == "sensor_msgs" and state == "deprecated"}

    assert "sensor_msgs::convertPointCloudToPointCloud2" in told("humble")
    assert "sensor_msgs::convertPointCloudToPointCloud2" not in told("noetic")
