"""Worlds, models and robot descriptions: the plugins of Gazebo Classic in them, and what they are told of ROS.

Source: gazebo_ros/node.hpp of gazebo_ros_pkgs for ROS 2: `<ros>` holds a namespace and remappings.
"""

from __future__ import annotations

import re

import msgspec

from .markup import Document, Element, scan
from .place import Problem


class GazeboRemapping(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A `<remapping>`, as written: `old:=new`."""

    text: str
    line: int


class GazeboPlugin(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A `<plugin>` with a library. name and namespace: as written, empty for none."""

    library: str
    name: str
    namespace: str
    remappings: tuple[GazeboRemapping, ...]
    line: int


class GazeboFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """The plugins of a file, in its order."""

    plugins: tuple[GazeboPlugin, ...] = ()
    problems: tuple[Problem, ...] = ()


_LIBRARY = re.compile(r"lib\w+\.so")


def extract(data: bytes) -> GazeboFile:
    """The plugins of a file. Never raises."""
    document = scan(data)
    found = (_read_plugin(document, each) for each in document.elements if each.name == "plugin")
    return GazeboFile(tuple(plugin for plugin in found if _LIBRARY.fullmatch(plugin.library)), document.problems)


def _read_plugin(document: Document, element: Element) -> GazeboPlugin:
    inner = [each for ros in element.children if ros.name == "ros" for each in ros.children]
    namespace = next((each.text for each in inner if each.name == "namespace"), "")
    remappings = tuple(
        GazeboRemapping(each.text, document.locate(each.text_offset)[0]) for each in inner if each.name == "remapping"
    )
    library = element.get("filename").strip().rpartition("/")[2]
    return GazeboPlugin(library, element.get("name"), namespace, remappings, document.locate(element.offset)[0])
