"""Where the targets asked for need different spellings, the help is the guarded form, and following it is right."""

import pytest
from rosimpact.impact.analysis.check import check
from rosimpact.impact.analysis.session import Options
from rosimpact.impact.conditions import Environment, evaluate_all
from rosimpact.impact.facts.condition import Condition
from rosimpact.impact.targets.providers.version_macros import make_version_test

MANIFEST = """<package format="3">
  <name>winch</name><version>1.0.0</version><description>d</description>
  <maintainer email="a@example.com">a</maintainer><license>MIT</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <depend>rclcpp</depend><depend>cv_bridge</depend><depend>message_filters</depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""
CMAKE = """cmake_minimum_required(VERSION 3.8)
project(winch)
find_package(ament_cmake REQUIRED)
find_package(cv_bridge REQUIRED)
find_package(message_filters REQUIRED)
find_package(rclcpp REQUIRED)
add_executable(winch src/winch.cpp)
target_link_libraries(winch cv_bridge::cv_bridge message_filters::message_filters rclcpp::rclcpp)
install(TARGETS winch DESTINATION lib/${PROJECT_NAME})
ament_package()
"""


@pytest.fixture
def findings(tmp_path):
    def run(code, *targets):
        (tmp_path / "src").mkdir(exist_ok=True)
        (tmp_path / "package.xml").write_text(MANIFEST)
        (tmp_path / "CMakeLists.txt").write_text(CMAKE)
        (tmp_path / "src/winch.cpp").write_text(code)
        found = check(tmp_path, Options(targets=targets, cache=tmp_path / "cache", jobs=1)).findings
        return [f for f in found if f.path.endswith(".cpp") and f.severity != "note"]

    return run


OLD = "#include <cv_bridge/cv_bridge.h>\n"


def test_a_header_with_another_name_on_each_target(findings):
    (found,) = findings(OLD, "humble", "jazzy")
    assert (found.targets, found.fix) == (("jazzy",), ())
    assert found.help == (
        "`#if __has_include(<cv_bridge/cv_bridge.hpp>)`, include it, `#else` include `cv_bridge/cv_bridge.h`: "
        "humble has only `cv_bridge/cv_bridge.h`"
    )


def test_the_same_where_the_new_name_is_used(findings):
    (found,) = findings("#include <cv_bridge/cv_bridge.hpp>\n", "humble", "jazzy")
    assert found.targets == ("humble",)
    assert found.help.startswith("`#if __has_include(<cv_bridge/cv_bridge.hpp>)`, include it, `#else`")


def test_one_name_is_right_where_all_targets_take_it(findings):
    (found,) = findings(OLD, "jazzy", "rolling")
    assert found.help.startswith("include `cv_bridge/cv_bridge.hpp`")
    assert found.fix


def test_who_follows_the_help_hears_nothing_more(findings):
    guarded = (
        "#if __has_include(<cv_bridge/cv_bridge.hpp>)\n#include <cv_bridge/cv_bridge.hpp>\n"
        "#else\n#include <cv_bridge/cv_bridge.h>\n#endif\n"
    )
    assert findings(guarded, "humble", "jazzy") == []


TESTS = [
    # package, library, version, from which on the macro is there, versions below and at it
    ("rclcpp", False, "28.0.0", "16.0.19", "27.9.9", "28.0.0", "RCLCPP_VERSION_GTE(28, 0, 0)"),
    ("rclcpp_action", False, "28.3.2", "16.0.19", "28.3.1", "28.3.2", "RCLCPP_VERSION_GTE(28, 3, 2)"),
    ("hardware_interface", False, "4.8.0", "4.8.0", "4.7.0", "4.8.0", "HARDWARE_INTERFACE_VERSION_GTE(4, 8, 0)"),
    ("opencv", True, "4.0", "3.2.0", "3.4.1", "4.0.0", "CV_VERSION_MAJOR >= 4"),
    ("opencv", True, "4.7", "4.5.4", "4.6.0", "4.8.1",
     "CV_VERSION_MAJOR > 4 || (CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR >= 7)"),
    ("pcl", True, "1.12", "1.8.1", "1.11.1", "1.12.1", "PCL_VERSION_COMPARE(>=, 1, 12, 0)"),
    ("boost", True, "1.67", "1.58.0", "1.66.0", "1.67.0", "BOOST_VERSION >= 106700"),
    ("eigen3", True, "3.4", "3.3.7", "3.3.9", "3.4.0", "EIGEN_VERSION_AT_LEAST(3, 4, 0)"),
    ("fmt", True, "9.0", "6.1.2", "8.1.1", "9.1.0", "FMT_VERSION >= 90000"),
    ("spdlog", True, "1.10", "1.5.0", "1.9.2", "1.10.0", "SPDLOG_VERSION >= 11000"),
    ("qt", True, "6.0", "5.15.3", "5.15.13", "6.4.2", "QT_VERSION >= QT_VERSION_CHECK(6, 0, 0)"),
    ("gazebo-classic", True, "9", "7.0.0", "7.16.0", "9.0.0", "GAZEBO_MAJOR_VERSION >= 9"),
    ("roscpp", False, "1.15.0", "1.14.13", "1.14.13", "1.15.0", "ROS_VERSION_MINIMUM(1, 15, 0)"),
]  # fmt: skip


@pytest.mark.parametrize(("package", "library", "version", "oldest", "below", "at", "text"), TESTS)
def test_version_macros_hold_from_their_version_on(package, library, version, oldest, below, at, text):
    test = make_version_test(package, library, version, ros=1 if package == "roscpp" else 2, oldest=oldest)
    assert test is not None and test.text == text
    name = {"rclcpp_action": "rclcpp"}.get(package, package)
    for there, expected in ((below, False), (at, True)):
        environment = Environment(versions={name: there}.get)
        assert evaluate_all((Condition("cpp", test.text),), environment) is expected


@pytest.mark.parametrize(
    ("package", "library", "version", "oldest", "ros"),
    [
        ("rclcpp", False, "28.0.0", "9.2.2", 2),  # galactic's rclcpp has no such macro
        ("nav2_util", False, "1.3.0", "1.1.0", 2),  # nor has this package
        ("roscpp", False, "1.15.0", "1.14.0", 2),
        ("gazebo-classic", True, "11.3", "9.0", 1),  # the macro knows no second number
    ],
)
def test_where_no_macro_tells_nothing_is_made_up(package, library, version, oldest, ros):
    assert make_version_test(package, library, version, ros=ros, oldest=oldest) is None
