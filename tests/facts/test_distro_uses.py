"""Distros that files name: folders in code, and the stages and jobs of Dockerfiles and CI files."""

import pytest
from rosimpact.impact.facts.distros import extract, find_distros

FOLDERS = [
    ("source /opt/ros/humble/setup.bash", [("humble", False)]),
    ("# source /opt/ros/humble/setup.bash", []),
    ("echo source /opt/ros/humble/setup.bash", []),
    ("[ -d /opt/ros/humble ] && source /opt/ros/humble/setup.bash", [("humble", True)]),
    ("if true; then\n  source /opt/ros/humble/setup.bash\nfi", [("humble", True)]),
    ("cp /opt/ros/humble/a .\necho $ROS_DISTRO", [("humble", True)]),
    ("source /opt/ros/$ROS_DISTRO/setup.bash", []),
    ("ls /opt/ros/humble_ws", []),
    ('#include "/opt/ros/humble/include/a.hpp"', [("humble", False)]),
    ("// /opt/ros/humble", []),
    ("/* from\n   /opt/ros/humble */", []),
    ('"""Reads /opt/ros/humble."""', []),
    ("include_directories(/opt/ros/foxy/include)", [("foxy", False)]),
    ("message(STATUS /opt/ros/foxy)", []),
    ('IF(EXISTS "/opt/ros/foxy/include")\n  SET(ROOT /opt/ros/foxy)\nENDIF()', [("foxy", True), ("foxy", True)]),
    ("# generated from genmsg/cmake/pkg-genmsg.cmake.em\nset(FLAGS -I/opt/ros/foxy/share)", []),
]


@pytest.mark.parametrize(("text", "expected"), FOLDERS)
def test_folders(text, expected):
    found = find_distros(text.encode(), "shell")
    assert [(use.distro, use.tested) for use in (found.uses if found else ())] == expected


PACKAGES = [
    ("sudo apt-get install -y ros-humble-desktop git", "shell", ["ros-humble-desktop"]),
    ("apt install \\\n  ros-humble-nav2-bringup \\\n  ros-humble-slam-toolbox", "shell",
     ["ros-humble-nav2-bringup", "ros-humble-slam-toolbox"]),
    ("source /opt/ros/humble/setup.bash && apt install ros-foxy-desktop", "shell",
     ["/opt/ros/humble", "ros-foxy-desktop"]),
    ("apt install ros-${ROS_DISTRO}-desktop", "shell", []),
    ("echo apt install ros-humble-desktop", "shell", []),
    ("# apt install ros-humble-desktop", "shell", []),
    ("names = ['ros-humble-desktop']", "python", []),
]  # fmt: skip


@pytest.mark.parametrize(("text", "kind", "expected"), PACKAGES)
def test_packages(text, kind, expected):
    found = find_distros(text.encode(), kind)
    assert [use.text for use in (found.uses if found else ())] == expected


PARTS = [
    ("dockerfile", "FROM ros:jazzy AS a\nFROM a\nRUN apt install ros-humble-desktop", [
        (("ros:jazzy",), [], False), (("ros:jazzy",), ["ros-humble-desktop"], False)]),
    ("dockerfile", "FROM ros:jazzy\n# ros-humble-desktop\nCOPY --from=old /opt/ros/humble /opt/ros/humble",
     [(("ros:jazzy",), [], False)]),
    ("dockerfile", "FROM ros:${ROS_DISTRO}\nRUN apt install ros-humble-desktop ros-humble-rmw-*",
     [(("ros:${ROS_DISTRO}",), ["ros-humble-desktop"], True)]),
    ("ci", "jobs:\n  a:\n    container: ros:humble\n  b:\n    strategy:\n      matrix: {x: [1]}\n    image: ros:jazzy",
     [((), [], False), (("ros:humble",), [], False), (("ros:jazzy",), [], True)]),
]  # fmt: skip


@pytest.mark.parametrize(("kind", "text", "expected"), PARTS)
def test_parts(kind, text, expected):
    parts = extract(text.encode(), kind).parts
    assert [(part.images, [use.text for use in part.uses], part.open) for part in parts] == expected
