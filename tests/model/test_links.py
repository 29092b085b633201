"""What a link item stands for, and what one with a variable that nothing sets may stand for."""

import pytest
from rosimpact.impact.model.cmake.links import may_hide, resolve_package


@pytest.mark.parametrize(
    ("item", "package"),
    [
        ("tf2::tf2", "tf2"),
        ("${tf2_LIBRARIES}", "tf2"),
        ("${sensor_msgs_TARGETS}", "sensor_msgs"),
        ("yaml-cpp", "yaml-cpp"),
    ],
)
def test_the_package_of_an_item(item, package):
    assert resolve_package(item) == package


@pytest.mark.parametrize(
    ("item", "name", "may"),
    [
        ("rclcpp::rclcpp", "rclcpp", False),  # no variable: it says what it is
        ("${GZ_SIM}", "rclcpp", True),
        ("ignition-msgs${VER}::core", "rclcpp", False),  # another prefix
        ("ignition-msgs${VER}::core", "ignition-msgs7", True),
        ("${PREFIX}_msgs", "std_msgs", True),
        ("${PREFIX}_msgs", "rclcpp", False),
        ("${NAME}::core", "rclcpp", True),
        ("${rclcpp_LIBRARIES}", "tf2", False),  # a found package sets it
        ("${rclcpp_LIBRARIES}", "rclcpp", True),
    ],
)
def test_an_unset_variable_hides_what_its_surroundings_allow(item, name, may):
    assert may_hide(item, name) is may
