"""What is known of one machine, and versions compared as far as they are known."""

import operator
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

COMPARISONS: dict[str, Callable[[Any, Any], bool]] = {
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    ">": operator.gt,
    "<=": operator.le,
    ">=": operator.ge,
}
PARTS = {"MAJOR": 0, "MINOR": 1, "PATCH": 2, "REVISION": 2, "SUBMINOR": 2}


@dataclass(frozen=True, eq=False)
class Environment:
    """What is known of one machine.

    ros_distro: `humble`; ros_version: `1` or `2`; python: (3, minor) or (2, 7); codename of the platform (`jammy`).
    versions: the version of a package or library by name (`rclcpp`, `opencv`, `gcc`), None when unknown. packages:
    whether a ROS package is there, None for names that are none's. headers: whether the compiler finds a header, None
    when unknown. testing: whether tests are built, None when both must be
    considered. gone: whether a `package` or a `command` of CMake that once was is surely not there. An empty string
    stands for unknown.
    """

    ros_distro: str = ""
    ros_version: str = ""
    python: tuple[int, int] | None = None
    codename: str = ""
    versions: Callable[[str], str | None] = lambda name: None
    packages: Callable[[str], bool | None] = lambda name: None
    headers: Callable[[str], bool | None] = lambda name: None
    testing: bool | None = None
    gone: Callable[[str, str], bool] = lambda kind, name: False


# Names used by macros and CMake variables, in lower case, where they differ from the package's or library's own.
_LIBRARY_NAMES = {
    "cv": ("opencv",),
    "eigen": ("eigen3",),
    "fcl": ("fcl", "libfcl"),
    "moveit_fcl": ("fcl", "libfcl"),
    "gazebo": ("gazebo-classic", "gazebo"),
    "kdl": ("orocos-kdl", "orocos_kdl"),
    "orocos_kdl": ("orocos-kdl", "orocos_kdl"),
    "moveit": ("moveit_core",),
    "ros": ("roscpp",),
    "urdf": ("urdfdom-headers", "urdfdom_headers"),
    "qt5": ("qt",),
    "qt5core": ("qt",),
    "zmq": ("zeromq",),
    "yaml_cpp": ("yaml-cpp",),
    "cmake_cxx_compiler": ("gcc",),
}


def find_version(name: str, environment: Environment) -> str | None:
    """The version of what a macro or variable prefix stands for: `CV`, `rclcpp`, `OpenCV`, `Python3`."""
    lower = name.lower()
    if lower in ("python", "python3", "py", "pythoninterp", "pythonlibs", "python_interpreter"):
        return None if environment.python is None else "{}.{}".format(*environment.python)
    for candidate in _LIBRARY_NAMES.get(lower, (lower, name, lower.replace("_", "-"))):
        version = environment.versions(candidate)
        if version:
            return version
    return None


def parse_version_numbers(version: str) -> tuple[int, ...]:
    """The leading numbers of a version: `1.12.1+dfsg-3` gives (1, 12, 1), `1:4.5` the part after the epoch."""
    found = re.match(r"(?:\d{1,9}:)?v?(\d{1,9}(?:\.\d{1,9})*)", version.strip())
    return tuple(int(part) for part in found.group(1).split(".")) if found else ()


def compare_version(version: str | None, wanted: tuple[int, ...]) -> int | None:
    """How a version compares with numbers asked for: -1, 0, 1, or None where it is not known finely enough."""
    known = parse_version_numbers(version) if version else ()
    if not known:
        return None
    if len(known) < len(wanted) and known == wanted[: len(known)] and any(wanted[len(known) :]):
        return None
    size = max(len(known), len(wanted))
    left, right = (each + (0,) * (size - len(each)) for each in (known, wanted))
    return (left > right) - (left < right)
