"""Names that are misspelt, and names that differ on purpose."""

import pytest
from rosimpact.impact.model.flow.misspelling import is_in_namespace, is_slip_of_name

MISSPELT = (
    ("/cmd_vel", "/cmdvel"), ("/wheel_odom", "/wheels_odom"), ("/base/scan_front", "/base/scan_frnot"),
    ("/tide_level", "/tide_levels"), ("/Joint_States", "/joint_states"), ("/odometry", "/odometri"),
)  # fmt: skip
APART = (
    ("/camera1/image", "/camera2/image"), ("/arm_l", "/arm_r"), ("/pose_x", "/pose_y"), ("/left_wheel", "/right_wheel"),
    ("/a/image", "/b/image"), ("/goal", "/gold"), ("/map", "/maps"), ("/scan/front", "/scam/frond"), ("/odom", "/odom"),
    ("/robot/odom", "/odom"), ("/input_image", "/output_image"), ("/imu_data", "/imu_date_time"),
    ("/l_wheel", "/r_wheel"), ("/arm_l_joint", "/arm_r_joint"),
)  # fmt: skip


@pytest.mark.parametrize(("one", "other"), MISSPELT)
def test_misspelt_names_are_recognised(one: str, other: str):
    assert is_slip_of_name(one, other)
    assert is_slip_of_name(other, one)


@pytest.mark.parametrize(("one", "other"), APART)
def test_told_apart(one: str, other: str):
    assert not is_slip_of_name(one, other)
    assert not is_slip_of_name(other, one)


@pytest.mark.parametrize(
    ("one", "other", "expected"),
    [
        ("/odom", "/robot/odom", True),
        ("/robot/odom", "/odom", True),
        ("/odom", "/robot_odom", False),
        ("/odom", "/odom", False),
        ("/x", "/a/x", False),
    ],
)
def test_within_a_namespace(one: str, other: str, expected: bool):
    assert is_in_namespace(one, other) is expected
