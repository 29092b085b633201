"""Which gz-sim a target has, and how names of its systems are read."""

import pytest
from rosimpact.impact.targets.distro.distro import DistroTarget
from rosimpact.impact.targets.gz_systems import find_gz_version, split_name


@pytest.mark.parametrize(
    ("library", "parts"),
    [
        ("gz-sim-imu-system", ("gz-sim", "", "imu")),
        ("libignition-gazebo6-diff-drive-system.so", ("ignition-gazebo", "6", "diff-drive")),
        ("gz-sim-lighter_than_air_dynamics-system", ("gz-sim", "", "lighter_than_air_dynamics")),
        ("libgz_ros2_control-system.so", None),
        ("gz-sim-imu", None),
    ],
)
def test_names_of_libraries(library, parts):
    assert split_name(library) == parts


@pytest.mark.parametrize(
    ("target", "along", "major"),
    [
        ("jazzy", (), "8"),
        ("kilted", ("ignition-gazebo6",), "9"),
        ("humble", ("ros_gz_sim", "ignition-gazebo6", "ignition-plugin"), "6"),
        ("foxy", ("libignition-gazebo3-dev",), "3"),
        ("humble", ("rclcpp",), ""),
        ("humble", ("ignition-gazebo6", "gz-sim8"), ""),
    ],
)
def test_the_version_of_a_target(target, along, major):
    assert find_gz_version(DistroTarget(target), along).partition(".")[0] == major
