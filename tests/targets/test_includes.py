"""What headers of libraries and ROS packages bring along."""

from __future__ import annotations

import pytest
from rosimpact.impact.targets.build.includes import Header as Read
from rosimpact.impact.targets.build.includes import defined, direct, included, table_of
from rosimpact.impact.targets.includes import Includes, Machine, default, machine_of, offered


@pytest.mark.parametrize(
    ("distro", "header", "brought", "expected"),
    [
        ("foxy", "tf2_ros/transform_listener.h", "tf2_ros/buffer.h", True),
        ("galactic", "tf2_ros/transform_listener.h", "tf2_ros/buffer.h", False),
        ("galactic", "tf2_ros/transform_listener.h", "rclcpp/node.hpp", True),
        ("humble", "rclcpp/rclcpp.hpp", "rclcpp/node_interfaces/node_base_interface.hpp", True),
        ("humble", "rclcpp/rclcpp.hpp", "cfloat", False),
        ("humble", "pcl/conversions.h", "boost/foreach.hpp", True),
        ("lyrical", "pcl/conversions.h", "boost/foreach.hpp", False),
        ("humble", "sensor_msgs/msg/image.hpp", "string", True),
        ("jazzy", "string", "cstdint", False),
        ("humble", "memory", "bits/shared_ptr", True),
    ],
)
def test_what_a_header_brings_along(distro, header, brought, expected):
    assert (brought in machine_of(distro, 2).brought(header).headers) == expected


@pytest.mark.parametrize(
    ("distro", "header", "brought", "expected"),
    [
        ("melodic", "sensor_msgs/Image.h", "ros/serialization.h", True),
        ("noetic", "ros/ros.h", "boost/shared_ptr.hpp", True),
        ("melodic", "rviz/message_filter_display.h", "ros/callback_queue.h", True),
        ("noetic", "rviz/message_filter_display.h", "ros/callback_queue.h", False),
        ("noetic", "winch/WinchConfig.h", "dynamic_reconfigure/config_tools.h", True),
    ],
)
def test_what_a_header_of_ros_1_brings_along(distro, header, brought, expected):
    assert (brought in machine_of(distro, 1).brought(header).headers) == expected


def test_a_header_that_nothing_is_known_of_is_outside():
    brought = machine_of("humble", 2).brought("winch/winch.hpp")
    assert brought.outside == {"winch/winch.hpp"} and machine_of("humble", 2).owner("winch/winch.hpp") is None


def test_names_are_offered_by_headers_that_the_table_knows():
    known = default()
    assert "tf2_ros/buffer.h" in offered()["tf2_ros::Buffer"]
    assert all(any(h in known.owners_of for h in headers) for headers in known.table.names.values())


def _includes(sparse=()):
    header = lambda *paths: Read(paths, frozenset(), frozenset())  # noqa: E731
    versions = {
        "1.0": {"winch/all.h": header("winch/detail/rope.h"), "winch/detail/rope.h": header("list", "../hook.h")},
        "1.4": {"winch/all.h": header("vector")},
    }
    versions["1.0"]["winch/hook.h"] = header()
    states = {"winch": {v: direct(state, lambda path: "/detail/" not in path) for v, state in versions.items()}}
    return Includes(table_of(states, {"winch"}, sparse))


@pytest.mark.parametrize(
    ("version", "sparse", "expected"),
    [
        ("0.9", (), None),
        ("1.0", (), ("list", "winch/hook.h")),
        ("1.2", (), ("list", "winch/hook.h")),
        ("1.4.2", (), ("vector",)),
        ("1.2", ("winch",), ("list", "winch/hook.h", "vector")),
        ("1.0.3", ("winch",), ("list", "winch/hook.h")),
    ],
)
def test_versions_between_those_read(version, sparse, expected):
    assert _includes(sparse).included("winch", "winch/all.h", version) == expected


def test_a_header_may_be_gone_in_a_version():
    machine = Machine(2, lambda owner, library: "1.4" if library else None, _includes())
    assert machine.includes("winch/hook.h") is None and machine.owner("winch/all.h") == ("winch", "1.4")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('#include <a.h>\n# include "b.h"\n// #include <c.h>\n/* #include <d.h>\n*/', ("a.h", "b.h")),
        ("#ifdef _WIN32\n#include <windows.h>\n#else\n#include <unistd.h>\n#endif\n#include <z>", ("unistd.h", "z")),
        ("#ifndef _WIN32\n#include <unistd.h>\n#endif", ("unistd.h",)),
        ("#if !defined(_WIN32)\n#include <unistd.h>\n#endif", ("unistd.h",)),
        ("#ifdef WITH_ROPE\n#include <rope.h>\n#endif", ("rope.h",)),
        ("#include WINCH_HEADER", ()),
    ],
)
def test_include_lines(text, expected):
    assert included(text) == expected


@pytest.mark.parametrize(
    ("text", "names", "announced"),
    [
        ("namespace a { class B {}; class C; }", {"a::B"}, {"a::C"}),
        ("namespace a::b { struct WINCH_PUBLIC C : D { struct Inner {}; }; }", {"a::b::C"}, set()),
        ("namespace a { using B = int; typedef long C; void f() { struct Local {}; } }", {"a::B", "a::C"}, set()),
        ("struct Plain {};", set(), set()),
        ("namespace a { // class B {};\n}", set(), set()),
    ],
)
def test_types_of_a_header(text, names, announced):
    assert defined(text) == (names, announced)
