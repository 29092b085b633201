"""Parameters that are set and not declared: how they are told together, and what keeps them from being told."""

from pathlib import Path

import pytest
from rosimpact.impact.analysis.check import check
from rosimpact.impact.analysis.session import Options

MANIFEST = (
    '<package format="3"><name>{name}</name><version>1.0.0</version><description>d</description>'
    '<maintainer email="robots@example.org">Robots</maintainer><license>MIT</license>'
    "<buildtool_depend>ament_cmake</buildtool_depend><export><build_type>ament_cmake</build_type></export></package>"
)
CMAKE = (
    "cmake_minimum_required(VERSION 3.16)\nproject({name})\nfind_package(ament_cmake REQUIRED)\n"
    "install(DIRECTORY config DESTINATION share/${{PROJECT_NAME}})\nament_package()\n"
)


@pytest.fixture
def told(tmp_path):
    """Line, targets, message and help of what is told of a file of parameters."""

    def run(text: str, *targets: str, own: str = "", folder: str = "config") -> list[tuple[int, str, str, str]]:
        for name in ("rover", *own.split()):
            place = tmp_path / name
            (place / "config").mkdir(parents=True)
            (place / "package.xml").write_text(MANIFEST.format(name=name))
            if not (place / "CMakeLists.txt").exists():
                (place / "CMakeLists.txt").write_text(CMAKE.format(name=name))
        file = Path(tmp_path, "rover", folder, "drive.yaml")
        file.parent.mkdir(exist_ok=True)
        file.write_text(text)
        options = Options(targets=targets, select=("removed-parameter",), cache=tmp_path / "cache", jobs=1)
        found = [f for f in check(tmp_path, options).findings if f.rule == "removed-parameter"]
        assert [f.severity for f in found[:1]] in ([], ["warning"])
        return [(f.line, " ".join(t.partition("@")[0] for t in f.targets), f.message, f.help) for f in found]

    return run


OLD = "controller_server:\n  ros__parameters:\n    progress_checker_plugin: checker\n"
NEW = OLD.replace("_plugin: checker", "_plugins: [checker]")


def test_an_old_name_and_a_new_one(told):
    ((line, targets, message, remedy),) = told(OLD, "humble", "jazzy")
    assert (line, targets, remedy) == (3, "jazzy", "set `progress_checker_plugins`")
    assert message.startswith("the parameter `progress_checker_plugin` is no longer declared by nav2_controller 1.3.")


def test_a_name_that_is_not_there_yet(told):
    ((line, targets, message, remedy),) = told(NEW, "humble", "jazzy")
    assert (line, targets, remedy) == (3, "humble", "set `progress_checker_plugin`")
    assert message.startswith("the parameter `progress_checker_plugins` is not declared by nav2_controller 1.1.")


@pytest.mark.parametrize(
    ("text", "own", "folder"),
    [
        (OLD + NEW.splitlines()[-1] + "\n", "", "config"),  # every version finds its own
        (OLD, "nav2_controller", "config"),
        (OLD, "nav2_util", "config"),  # which comes along with it, and may declare it
        (OLD, "", "test"),
        (OLD, "", "humble"),
        (OLD.replace("progress", "program"), "", "config"),
        (OLD.replace("controller_server", "controller_servant"), "", "config"),
        (OLD.replace("controller_server", "/**"), "", "config"),
        ("moveit:\n  ros__parameters:\n    stateful: true\n", "", "config"),
        # The row of changed-behaviour on this value says more.
        (
            "c:\n  ros__parameters:\n    Follow:\n"
            "      plugin: nav2_regulated_pure_pursuit_controller::RegulatedPurePursuitController\n"
            "      use_interpolation: false\n",
            "",
            "config",
        ),
    ],
)
def test_nothing_is_told(told, text, own, folder):
    assert told(text, "jazzy", own=own, folder=folder) == []


PROGRAM = CMAKE.replace("install(", "add_executable(controller_server main.cpp)\ninstall(")
LAUNCH = '<launch><node pkg="{0}" exec="{1}" name="{2}"/></launch>'


@pytest.mark.parametrize(
    ("more", "expected"),
    [
        ({}, 1),
        ({"CMakeLists.txt": PROGRAM.format(name="rover")}, 0),
        ({"launch/a.launch.xml": LAUNCH.format("nav2_controller", "controller_server", "controller_server")}, 1),
        ({"launch/a.launch.xml": LAUNCH.format("other_controller", "controller_server", "any")}, 0),
        ({"launch/a.launch.xml": LAUNCH.format("other_controller", "any", "controller_server")}, 0),
    ],
)
def test_a_node_of_that_name_may_be_another_packages(told, tmp_path, more, expected):
    for path, text in more.items():
        file = tmp_path / "rover" / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    assert len(told(OLD, "jazzy")) == expected


GRACEFUL = """controller_server:
  ros__parameters:
    Follow:
      plugin: "nav2_graceful_controller::GracefulController"
      motion_target_dist: 0.8
      final_rotation: false
"""
WHEELS = """controller_manager:
  ros__parameters:
    wheels: {type: joint_trajectory_controller/JointTrajectoryController}
wheels:
  ros__parameters:
    speed_scaling: {command_interface: a, initial_scaling_factor: 1.0, state_interface: b}
    constraints:
      decelerate_on_cancel: true
      arm: {max_deceleration_on_cancel: 1.0}
"""


def test_a_few_are_told_one_by_one(told):
    assert [(line, remedy) for line, _, _, remedy in told(GRACEFUL, "jazzy")] == [
        (5, ""),
        (6, "set `prefer_final_rotation`"),
    ]


def test_the_first_of_one_owner_is_the_warning(told):
    assert [line for line, *_ in told(WHEELS, "humble")] == [6, 6, 6, 8, 9]
