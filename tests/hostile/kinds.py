"""Every kind of file of a workspace that rosimpact opens, with a content that holds a word."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from .harness import MANIFEST, NODE, cmake, manifest


class Kind(NamedTuple):
    """A file. path: where it lies. text: its content; WORD stands for the word. beside: other files that make it
    count. shown: `check --notes` quotes the word, so that a file that is not read is noticed. setting: rosimpact.toml,
    for which the status 2 with a clear error is right too."""

    name: str
    path: str
    text: str
    beside: Mapping[str, str] = {}
    shown: bool = True
    setting: str = ""

    def content(self, word: str) -> str:
        return self.text.replace("WORD", word)


_PACKAGE = {"src/bad/CMakeLists.txt": cmake("bad", "find_package(rclcpp REQUIRED)")}
_INTERFACES = {
    "src/bad/package.xml": MANIFEST.format(
        name="bad",
        depends="<build_depend>rosidl_default_generators</build_depend><exec_depend>rosidl_default_runtime</exec_depend>"
        "<member_of_group>rosidl_interface_packages</member_of_group>",
    ),
    "src/bad/CMakeLists.txt": cmake(
        "bad",
        "find_package(rosidl_default_generators REQUIRED)\n"
        'rosidl_generate_interfaces(bad "msg/Bad.msg" "srv/Bad.srv" "action/Bad.action")',
    ),
    "src/bad/msg/Bad.msg": "int32 a\n",
    "src/bad/srv/Bad.srv": "int32 a\n---\nint32 b\n",
    "src/bad/action/Bad.action": "int32 a\n---\nint32 b\n---\nint32 c\n",
}
_PYTHON = {
    "src/bad/package.xml": manifest("bad", "rclpy").replace(">ament_cmake<", ">ament_python<"),
    "src/bad/setup.py": "from setuptools import setup\nsetup(name='bad', packages=['bad'])\n",
    "src/bad/bad/__init__.py": "",
}
OLD = "find_package(OpenCV 8 REQUIRED)  # WORD\n"
_COMPILED = {
    "src/bad/package.xml": manifest("bad", "tf2_geometry_msgs"),
    "src/bad/CMakeLists.txt": cmake(
        "bad",
        "find_package(tf2_geometry_msgs REQUIRED)\ninclude_directories(include)\nadd_executable(bad_node "
        "src/node.cpp)\n"
        "target_link_libraries(bad_node tf2_geometry_msgs::tf2_geometry_msgs)",
    ),
}
GONE = "#include <tf2_geometry_msgs/tf2_geometry_msgs.h>  // WORD\n"

KINDS = [
    Kind("manifest", "src/bad/package.xml", manifest("bad", "rclcpp", "WORD"), _PACKAGE),
    Kind("cmake", "src/bad/CMakeLists.txt", cmake("bad", OLD)),
    Kind(
        "cmake-include",
        "src/bad/cmake/more.cmake",
        OLD + "\n",
        {"src/bad/CMakeLists.txt": cmake("bad", "include(cmake/more.cmake)")},
    ),
    Kind(
        "cmake-subdirectory",
        "src/bad/sub/CMakeLists.txt",
        OLD,
        {"src/bad/CMakeLists.txt": cmake("bad", "add_subdirectory(sub)")},
    ),
    Kind("cpp", "src/bad/src/node.cpp", GONE, _COMPILED),
    Kind(
        "header",
        "src/bad/include/bad/a.hpp",
        GONE,
        {**_COMPILED, "src/bad/src/node.cpp": '#include "bad/a.hpp"\nint main() {}\n'},
    ),
    Kind(
        "node",
        "src/bad/src/talker.cpp",
        NODE.format(Class="Bad", node="bad_node", topic="WORD", bound=1).replace("msgs.h>", "msgs.h>  // WORD"),
        {"src/bad/CMakeLists.txt": cmake("bad", "add_executable(bad_node src/talker.cpp)")},
    ),
    Kind("python", "src/bad/scripts/node.py", "from launch_ros.actions import Node  # WORD\n"),
    Kind("python-module", "src/bad/bad/node.py", "from launch_ros.actions import Node  # WORD\n", _PYTHON),
    Kind(
        "setup.py",
        "src/bad/setup.py",
        "from distutils.core import setup  # WORD\nsetup(name='bad')\n",
        _PYTHON,
        shown=False,
    ),
    Kind("setup.cfg", "src/bad/setup.cfg", "[metadata\nname = WORD\n= y\n", _PYTHON, shown=False),
    Kind("pyproject", "src/bad/pyproject.toml", "[project\nname = 'WORD'\n", _PYTHON, shown=False),
    Kind(
        "launch.py",
        "src/bad/launch/a.launch.py",
        "from launch import LaunchDescription\nfrom launch_ros.actions import Node  # WORD\n\n\n"
        "def generate_launch_description():\n"
        "    return LaunchDescription([Node(package='bad', executable='WORD')])\n",
    ),
    Kind("launch.xml", "src/bad/launch/a.launch.xml", "<launch><node pkg='tf2_ros' exec='x' name='WORD'/></launch>\n"),
    Kind(
        "launch",
        "src/bad/launch/a.launch",
        "<launch><node pkg='tf2_ros' exec='x' name='WORD'/></launch>\n",
        shown=False,
    ),
    Kind("launch.yaml", "src/bad/launch/a.launch.yaml", "launch:\n- node: {pkg: tf2_ros, exec: WORD}\n"),
    Kind("parameters", "src/bad/config/a.yaml", "/bad_node:\n  ros__parameters:\n    WORD: 1\n", shown=False),
    Kind("msg", "src/bad/msg/Bad.msg", "WORD/Word word\n", _INTERFACES),
    Kind("srv", "src/bad/srv/Bad.srv", "WORD/Word word\n---\n", _INTERFACES),
    Kind("action", "src/bad/action/Bad.action", "WORD/Word word\n---\n---\n", _INTERFACES),
    Kind(
        "xacro",
        "src/bad/urdf/a.urdf.xacro",
        "<robot xmlns:xacro='x'><xacro:include filename='$(find tf2_ros)/WORD'/></robot>\n",
    ),
    Kind(
        "plugins",
        "src/bad/plugins.xml",
        "<library path='WORD'><class type='WORD' base_class_type='WORD'/></library>\n",
        shown=False,
    ),
    Kind("shell", "src/bad/scripts/run.sh", "#!/bin/sh\nros2 run bad WORD\n", shown=False),
    Kind("toml", "rosimpact.toml", "[check]\nselect = ['WORD']\n", setting="rosimpact.toml"),
    Kind("gitmodules", ".gitmodules", '[submodule "WORD"]\n\tpath = src/WORD\n\turl = x\n', shown=False),
    Kind("colcon.meta", "colcon.meta", "names: {bad: {dependencies: [WORD]}}\n", shown=False),
    Kind("colcon.pkg", "src/bad/colcon.pkg", "dependencies: [WORD]\n", shown=False),
    Kind("defaults.yaml", "defaults.yaml", "build:\n  packages-skip: [WORD]\n", shown=False),
    Kind("dot-defaults.yaml", ".colcon/defaults.yaml", "build:\n  packages-skip: [WORD]\n", shown=False),
    Kind("manifest.xml", "src/old/manifest.xml", "<package><depend package='WORD'/></package>\n", shown=False),
    Kind("CHANGELOG", "src/bad/CHANGELOG.rst", "WORD\n", shown=False),
]
