"""What is known only when all targets are looked at together: other behaviour, and spellings that part them."""

import pytest
import rule_cases
from rosimpact.impact.analysis.check import check
from rosimpact.impact.analysis.session import Options


@pytest.fixture
def told(tmp_path):
    def run(case, *targets):
        options = Options(targets=targets, cache=tmp_path / "cache")
        findings = rule_cases.check_files(rule_cases.read_changed_files(f"api/{case}"), options).findings
        rule = case.replace("_", "-")
        return [(f.targets, [one[:3] for one in f.evidence.targets] if f.evidence else []) for f in findings
                if f.rule == rule]  # fmt: skip

    return run


@pytest.mark.parametrize(
    ("targets", "expected"),
    [
        # MultiThreadedExecutor has two threads at least since rclcpp 17.1.0: Humble has 16, Iron 21, Jazzy 28.
        (("humble", "jazzy"), [(("jazzy",), [("humble", "16.0.19", False), ("jazzy", "28.1.21", True)])]),
        (("jazzy", "rolling"), []),  # both have it, and nobody is surprised
        (("jazzy",), [(("jazzy",), [("jazzy", "28.1.21", True)])]),  # it came since the long-term distro before
        (("kilted",), []),  # that was Jazzy
        (("humble",), []),
    ],
)
def test_behaviour_is_told_where_targets_differ_or_a_target_is_the_first_with_it(told, targets, expected):
    assert told("changed_behaviour", *targets) == expected


@pytest.mark.parametrize(
    ("targets", "parted"),
    [(("humble", "jazzy"), True), (("humble",), False), (("jazzy",), False), (("jazzy", "rolling"), False)],
)
def test_spellings_part_only_targets_that_need_different_ones(told, targets, parted):
    assert told("unguarded_split", *targets) == ([(targets, [])] if parted else [])


def test_an_allow_comment_silences_what_is_said_last(tmp_path):
    files = dict(rule_cases.read_changed_files("api/unguarded_split"))
    code = files["winch/src/winch.cpp"]
    comment = "  // rosimpact: allow(unguarded-split)"
    files["winch/src/winch.cpp"] = code.replace("cv_bridge.h>", f"cv_bridge.h>{comment}", 1)
    options = Options(targets=("humble", "jazzy"), cache=tmp_path / "cache")
    found = rule_cases.check_files(files, options).findings
    assert [finding.rule for finding in found] == ["removed-header"]


def test_a_name_in_a_module_that_is_gone_is_not_called_deprecated(tmp_path):
    files = dict(rule_cases.read_changed_files("api/removed_python_name"))
    # Deprecated since rclpy 4.0.0; rclpy 10.0.0 has no such module.
    files["arm/arm/node.py"] = (
        "from rclpy.qos_event import PublisherEventCallbacks\nfrom rclpy.qos_event import UnsupportedEventTypeError\n"
    )
    found = rule_cases.check_files(files, Options(targets=("jazzy", "lyrical"), cache=tmp_path / "cache")).findings
    assert [(f.rule, f.line, f.targets) for f in found if f.rule in ("deprecated-name", "removed-python-name")] == [
        ("removed-python-name", 1, ("lyrical",)),
        ("deprecated-name", 1, ("jazzy",)),
        ("deprecated-name", 2, ("jazzy",)),
    ]


PARAMETERS = """\
controller_server:
  ros__parameters:
    controller_frequency: 20.0  # of enable_stamped_cmd_vel nothing is said
"""


@pytest.mark.parametrize(
    ("folder", "added", "depends", "expected"),
    [
        ("config", "", "nav2_bringup", [(2, ("kilted",))]),
        ("config", "    enable_stamped_cmd_vel: true\n", "nav2_bringup", []),
        ("config", "", "rclcpp", []),  # whose server that is, nobody knows
        ("config/humble", "", "nav2_bringup", []),
    ],
)
def test_parameters_mean_something_else(folder, added, depends, expected, tmp_path):
    (tmp_path / "porter" / folder).mkdir(parents=True)
    (tmp_path / "porter" / folder / "nav2.yaml").write_text(f"# Navigation\n{PARAMETERS}{added}")
    (tmp_path / "porter/package.xml").write_text(
        '<package format="3"><name>porter</name><version>1.0.0</version><description>p</description>'
        '<maintainer email="robots@example.org">R</maintainer><license>MIT</license>'
        f"<buildtool_depend>ament_cmake</buildtool_depend><exec_depend>{depends}</exec_depend></package>"
    )
    (tmp_path / "porter/CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.8)\nproject(porter)\nfind_package(ament_cmake REQUIRED)\n"
        "install(DIRECTORY config DESTINATION share/${PROJECT_NAME})\nament_package()\n"
    )
    found = check(tmp_path, Options(targets=("humble", "kilted"), cache=tmp_path / "cache", jobs=1)).findings
    assert [(f.line, f.targets) for f in found if f.rule == "changed-behaviour"] == expected


_FOR_BOTH = {
    "winch/package.xml": """<package format="3">
<name>winch</name><version>1.0.0</version><description>winch</description>
<maintainer email="robots@example.org">Robots</maintainer><license>Apache-2.0</license>
<buildtool_depend condition="$ROS_VERSION == 1">catkin</buildtool_depend>
<buildtool_depend condition="$ROS_VERSION == 2">ament_cmake</buildtool_depend>
<build_depend>ros_environment</build_depend>
<depend condition="$ROS_VERSION == 1">roscpp</depend><depend condition="$ROS_VERSION == 2">rclcpp</depend>
<export><build_type condition="$ROS_VERSION == 1">catkin</build_type>
<build_type condition="$ROS_VERSION == 2">ament_cmake</build_type></export></package>""",
    "winch/CMakeLists.txt": """cmake_minimum_required(VERSION 3.8)
project(winch)
if($ENV{ROS_VERSION} EQUAL 1)
  find_package(catkin REQUIRED COMPONENTS roscpp tf)
  catkin_package()
else()
  find_package(ament_cmake REQUIRED)
  find_package(rclcpp REQUIRED)
  find_package(pluginlib REQUIRED)
  ament_package()
endif()
""",
}


@pytest.mark.parametrize("targets", [("noetic", "jazzy"), ("jazzy", "noetic", "humble"), ("noetic",), ("jazzy",)])
def test_a_package_for_both_generations_is_checked_as_each_target_builds_it(tmp_path, targets):
    options = Options(targets=targets, cache=tmp_path / "cache")
    found = rule_cases.check_files(_FOR_BOTH, options).findings
    expected = {"noetic": "tf", "jazzy": "pluginlib", "humble": "pluginlib"}
    errors = {(target, f.subject) for f in found if f.severity == "error" for target in f.targets}
    assert errors == {(target, expected[target]) for target in targets}
    # What was there before is not new on either.
    assert not any(f.new for f in rule_cases.check_files(_FOR_BOTH, options, _FOR_BOTH).findings)
