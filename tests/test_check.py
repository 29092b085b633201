"""The main job as other Python code calls it: what goes in, what comes out, and what is right on which target."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
import rosimpact.impact
from rosimpact.impact.analysis.check import check, check_workspace
from rosimpact.impact.analysis.check_opened import is_right_on
from rosimpact.impact.analysis.findings import SettingsError
from rosimpact.impact.analysis.session import CheckError, Options, open_workspace
from rosimpact.impact.config import ConfigError, load
from rosimpact.impact.rules.fix_actions import Declare, Insert, Remove, Replace
from rosimpact.impact.targets.distro.distro import TargetError
from rosimpact.impact.tree import TreeError

EXAMPLE = Path(__file__).parents[1] / "examples/ros2_ws"


@pytest.fixture(autouse=True)
def _cache(cache, monkeypatch):
    monkeypatch.setenv("ROSIMPACT_CACHE", str(cache))
    monkeypatch.delenv("ROS_DISTRO", raising=False)


def test_findings_for_other_tools():
    findings = rosimpact.impact.check_workspace(EXAMPLE, targets=["jazzy", "humble@2025-06-01"])
    assert all(isinstance(finding, rosimpact.impact.Finding) for finding in findings)
    opencv = [finding for finding in findings if finding.rule == "library-version"]
    assert [(finding.path, finding.targets) for finding in opencv] == [
        ("src/porter_vision/CMakeLists.txt", ("jazzy", "humble@2025-06-01"))
    ]
    assert findings == sorted(findings, key=lambda finding: (finding.path, finding.line, finding.column, finding.rule))


@pytest.mark.parametrize(
    ("arguments", "error", "words"),
    [
        ({"targets": ["gutsy"]}, TargetError, "gutsy"),
        ({"select": ["nonsense"]}, SettingsError, "nonsense"),
        ({"config": "nowhere.toml"}, ConfigError, r"nowhere\.toml"),
        ({"base": ["no-such-revision"]}, TreeError, "no-such-revision"),
        ({"rev": "no-such-revision"}, TreeError, "no-such-revision"),
    ],
)
def test_what_cannot_be_done_is_an_exception(arguments, error, words):
    with pytest.raises(error, match=words):
        check_workspace(EXAMPLE, **arguments)


def test_no_package_is_an_exception_and_no_empty_answer(tmp_path):
    with pytest.raises(CheckError, match="no package was found"):
        check_workspace(tmp_path)
    with pytest.raises(TreeError, match="does not exist"):
        check_workspace(tmp_path / "nowhere")
    assert check(tmp_path).failure


def test_a_second_run_says_the_same():
    first, second = (check(EXAMPLE, Options(targets=("jazzy",))) for _ in range(2))
    assert first.findings == second.findings and first.coverage == second.coverage


def test_the_order_of_targets_changes_nothing_but_their_order():
    one = check(EXAMPLE, Options(targets=("jazzy", "humble"))).findings
    other = check(EXAMPLE, Options(targets=("humble", "jazzy"))).findings
    assert [(f.fingerprint, f.severity, set(f.targets)) for f in one] == [
        (f.fingerprint, f.severity, set(f.targets)) for f in other
    ]


def test_a_target_more_takes_nothing_away():
    alone = {(f.rule, f.path, f.line, f.subject) for f in check(EXAMPLE, Options(targets=("jazzy",))).findings}
    both = {
        (f.rule, f.path, f.line, f.subject)
        for f in check(EXAMPLE, Options(targets=("jazzy", "humble"))).findings
        # That no spelling serves all targets is only said of several.
        if "jazzy" in f.targets and f.rule != "unguarded-split"
    }
    assert alone == both


@pytest.mark.parametrize(
    ("fix", "on_jazzy", "on_humble"),
    [
        (Declare("package.xml", "rclcpp"), True, True),
        (Declare("package.xml", "porter_msgs"), True, True),
        (Declare("package.xml", "no_such_package"), False, False),
        (Declare("package.xml", "libopencv-dev"), True, True),
        (Replace("a.cpp", 1, 11, "x.h", "tf2_geometry_msgs/tf2_geometry_msgs.hpp"), True, True),
        (Replace("a.cpp", 1, 11, "x.hpp", "tf2_geometry_msgs/tf2_geometry_msgs.h"), False, True),
        (Replace("a.cpp", 1, 11, "x.h", "<vector>"), True, True),
        (Replace("a.cpp", 1, 11, "x.h", "porter_vision/marker_detector.hpp"), True, True),
        (Replace("a.cpp", 1, 11, "x.h", "no/such/header.hpp"), False, False),
        (Insert("a.cpp", 1, "#include <cstdint>"), True, True),
        (Insert("a.cpp", 1, "int x;"), False, False),
        (Remove("package.xml", "rclcpp"), False, False),
    ],
)
def test_a_fix_is_right_elsewhere_only_where_that_is_known(fix, on_jazzy, on_humble):
    with open_workspace(EXAMPLE, Options(targets=("jazzy", "humble"))) as opened:
        jazzy, humble = opened.views
        assert (is_right_on(fix, jazzy), is_right_on(fix, humble)) == (on_jazzy, on_humble)


def test_configuration(tmp_path):
    (tmp_path / "rosimpact.toml").write_text(
        "\ufeff[targets.robot]\ndistro = 'humble'\n[targets.laptop]\ndistro = 'jazzy'\n"
        "[check]\nselect = 'packages'\nseverity = { unused-dependency = 'off' }\nfail_on = 'warning'\n"
        "[workspace]\nprivate = ['ours']\ninstalled = 'ros_base'\nindex = 'https://example.org/index-v4.yaml'\n"
        "[paths.'src/**']\nignore = ['all']\n",
        encoding="utf-8",
    )
    config = load(tmp_path)
    assert config.default_targets == ("robot", "laptop")
    assert config.select == ("packages",) and config.severity == {"unused-dependency": "off"}
    assert config.fail_on == "warning" and config.private == ("ours",)
    assert config.installed == ("ros_base",)
    assert config.paths[0].pattern == "src/**" and config.paths[0].ignore == ("all",)
    assert load(tmp_path / "nowhere").path is None


def test_every_file_is_counted_once(tmp_path):
    package = tmp_path / "a"
    package.mkdir()
    (package / "package.xml").write_text("<package format='3'><name>a</name></package>")
    (package / "gone.cpp").symlink_to("nowhere.cpp")
    (package / "colcon.pkg").write_text("[")
    (package / "mesh.stl").write_text("of no interest")
    coverage = check(tmp_path, Options(targets=("jazzy",))).coverage
    assert (coverage.packages, coverage.files, coverage.parsed) == (1, 3, 0)


@pytest.mark.parametrize(
    ("made", "unresolved"),
    [
        ("std::make_shared<rclcpp::Node>(name)", 0),
        ("elsewhere::made(name)", 1),
        ("static_cast<Unknown *>(handle)", 1),
    ],
)
def test_members_of_what_is_not_known_are_counted(tmp_path, made, unresolved):
    (tmp_path / "CMakeLists.txt").write_text(
        "project(dock)\nfind_package(rclcpp REQUIRED)\nadd_executable(crane crane.cpp)\n"
        "target_link_libraries(crane rclcpp::rclcpp)\n"
    )
    (tmp_path / "package.xml").write_text(
        "<package format='3'><name>dock</name><version>1.0.0</version><depend>rclcpp</depend>"
        "<export><build_type>ament_cmake</build_type></export></package>"
    )
    (tmp_path / "crane.cpp").write_text(
        "#include <rclcpp/rclcpp.hpp>\n"
        "rclcpp::Node::SharedPtr other;\n"
        f'int main() {{ auto node = {made}; node->declare_parameter("speed"); node->lift(); }}\n'
    )
    coverage = check(tmp_path, Options(targets=("jazzy",))).coverage
    assert coverage.unresolved.get("receiver", 0) == unresolved


@pytest.mark.parametrize(
    ("submodule", "missing"), [("gait/include/steps", []), ("gait/include/other", ["INCLUDE_DIRS"])]
)
def test_a_folder_that_another_repository_fills_is_not_missing(tmp_path, submodule, missing):
    subprocess.run(["git", "init", "-q", tmp_path], check=True)
    (tmp_path / ".gitmodules").write_text(f'[submodule "steps"]\n\tpath = {submodule}\n\turl = ../steps.git\n')
    (tmp_path / "gait/include/gait").mkdir(parents=True)
    (tmp_path / "gait/include/gait/gait.h").write_text("#pragma once\n")
    (tmp_path / "gait/package.xml").write_text(
        "<package format='2'><name>gait</name><version>1.0.0</version>"
        "<buildtool_depend>catkin</buildtool_depend></package>"
    )
    (tmp_path / "gait/CMakeLists.txt").write_text(
        "project(gait)\nfind_package(catkin REQUIRED)\ncatkin_package(INCLUDE_DIRS include include/steps)\n"
    )
    findings = check_workspace(tmp_path, targets=["noetic"], select=["nonexistent-export"])
    assert [finding.subject for finding in findings] == missing


@pytest.mark.parametrize(
    ("header", "unresolved"),
    [
        ("rclcpp/rclcpp.hpp", 0),
        ("rclcpp/version.h", 0),
        ("std_msgs/msg/string.hpp", 0),
        ("rclcpp/node_interfaces/no_such_traits.hpp", 1),  # the build makes others of them
        ("std_msgs/msg/detail/string__struct.hpp", 1),
    ],
)
def test_headers_that_may_be_there_are_counted(tmp_path, header, unresolved):
    (tmp_path / "package.xml").write_text(
        '<package format="3"><name>sled</name><version>1.0.0</version><description>sled</description>'
        '<maintainer email="robots@example.org">Robots</maintainer><license>MIT</license>'
        "<buildtool_depend>ament_cmake</buildtool_depend><depend>rclcpp</depend><depend>std_msgs</depend>"
        "<export><build_type>ament_cmake</build_type></export></package>"
    )
    (tmp_path / "CMakeLists.txt").write_text("project(sled)\nfind_package(rclcpp)\nadd_library(sled sled.cpp)\n")
    (tmp_path / "sled.cpp").write_text(f"#include <{header}>\n")
    with open_workspace(tmp_path, Options(targets=("jazzy",))) as opened:
        (view,) = opened.views
        for package in view:
            view.list_needs(package)
    assert sum(one.kind == "include" for one in view.unresolved) == unresolved
