"""What headers of libraries and ROS packages bring along."""

from __future__ import annotations

import pytest
from rosimpact.databuild.extract.cpp import extract as header
from rosimpact.databuild.includes import HeaderContent as Read
from rosimpact.databuild.includes import build_table, drop_stored, extend_table, find_types, list_direct, list_includes
from rosimpact.databuild.jobs import Packing
from rosimpact.databuild.surface.compare import RepositorySurfaces
from rosimpact.databuild.surface.headers import keep_compiled_includes
from rosimpact.databuild.surface_file import write
from rosimpact.impact.targets.providers.includes import (
    HeadersOfMachine,
    Includes,
    IncludesTable,
    load_includes,
    load_machine,
    load_offered,
)
from rosimpact.impact.targets.surface.store import Surfaces
from rosimpact.impact.targets.surface.surface import BuildSurface, PythonSurface, Surface


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
        ("humble", "libavutil/imgutils.h", "libavutil/mem.h", True),
        ("jazzy", "libavutil/imgutils.h", "libavutil/mem.h", False),
    ],
)
def test_what_a_header_brings_along(distro, header, brought, expected):
    assert (brought in load_machine(distro, 2).find_brought(header).headers) == expected


@pytest.mark.parametrize(
    ("distro", "header", "brought", "expected"),
    [
        ("melodic", "sensor_msgs/Image.h", "ros/serialization.h", True),
        ("noetic", "ros/ros.h", "boost/shared_ptr.hpp", True),
        ("melodic", "rviz/message_filter_display.h", "ros/callback_queue.h", True),
        ("noetic", "rviz/message_filter_display.h", "ros/callback_queue.h", False),
        ("noetic", "winch/WinchConfig.h", "dynamic_reconfigure/config_tools.h", True),
        ("hydro", "libavcodec/avcodec.h", "libavutil/mem.h", True),
        ("indigo", "libavcodec/avcodec.h", "libavutil/mem.h", False),
        ("indigo", "Eigen/Geometry", "limits", True),
        ("noetic", "Eigen/Geometry", "limits", True),
        ("noetic", "Eigen/Geometry", "map", False),
        ("melodic", "opencv2/highgui/highgui.hpp", "opencv2/core.hpp", True),
        ("noetic", "opencv2/highgui/highgui.hpp", "vector", True),
    ],
)
def test_what_a_header_of_ros_1_brings_along(distro, header, brought, expected):
    assert (brought in load_machine(distro, 1).find_brought(header).headers) == expected


def test_a_header_that_nothing_is_known_of_is_outside():
    brought = load_machine("humble", 2).find_brought("winch/winch.hpp")
    assert brought.outside == {"winch/winch.hpp"} and load_machine("humble", 2).find_owner("winch/winch.hpp") is None


def test_names_are_offered_by_headers_that_are_known():
    assert {"tf2_ros/buffer.h", "tf2_ros/buffer.hpp"} <= set(load_offered()["tf2_ros::Buffer"])
    known = load_machine("humble", 2)
    assert all(any(map(known.knows, headers)) for headers in load_includes().table.names.values())


def test_the_table_has_only_what_surfaces_do_not_tell(tmp_path):
    table = IncludesTable(
        ("string", "list", "vector"),
        {"arm": {"arm/a.h": "0.5 0;1.0 1;2.0 2", "arm/made.h": "0.5 2;2.0 -", "arm/b.h": "1.5 0"},
         "rope": {"rope/rope.h": "1.0 1"}},
        frozenset(("rope",)),
        frozenset(),
        {"arm::A": ("arm/a.h",)},
        {},
        {"humble": {"arm": "2.0", "gcc": "11"}},
    )  # fmt: skip
    packing = Packing()
    for version, code in (("1.0", "namespace arm { class A {}; }"), ("2.0", "")):
        code += "namespace arm { class A; }" if version == "2.0" else ""
        new = tuple((f"arm/{name}.h", keep_compiled_includes(header(code.encode()))) for name in "ab")
        one = Surface("arm", version, BuildSurface("arm"), PythonSurface("arm"), new)
        packing.add("arm", version, (2,), RepositorySurfaces({"arm": one}))
    write(tmp_path / "x", packing.pack_packages())
    kept = drop_stored(Surfaces(tmp_path / "x"), table)
    assert kept.owners == {
        "arm": {"arm/a.h": "0.5 0", "arm/made.h": "0.5 1;2.0 -"},
        "rope": {"rope/rope.h": "1.0 2"},
    }
    assert kept.paths == ("string", "vector", "list")
    assert kept.names == kept.announced == {"arm::A": ("arm/a.h", "arm/b.h")}


def _includes(sparse=()):
    header = lambda *paths: Read(paths, frozenset(), frozenset())  # noqa: E731
    versions = {
        "1.0": {"winch/all.h": header("winch/detail/rope.h"), "winch/detail/rope.h": header("list", "../hook.h")},
        "1.4": {"winch/all.h": header("vector")},
    }
    versions["1.0"]["winch/hook.h"] = header()
    states = {"winch": {v: list_direct(state, lambda path: "/detail/" not in path) for v, state in versions.items()}}
    return Includes(build_table(states, {"winch"}, sparse))


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
    assert _includes(sparse).list_included("winch", "winch/all.h", version) == expected


def test_versions_are_added_to_a_table_that_keeps_what_it_tells():
    known = build_table({"pcl": {"1.0": {"a.h": ("b.h",), "c.h": ()}, "1.2": {"a.h": ()}}}, {"pcl"}, set())
    known = IncludesTable(known.paths, known.owners, known.libraries, known.sparse, names={"pcl::A": ("a.h",)})
    more = {"pcl": {"1.1": {"a.h": ("d.h",), "c.h": ()}}, "boost": {"1.74": {"e.h": ("a.h",)}}}
    both = Includes(extend_table(known, more, {"boost"}, {"boost"}))
    assert both.list_states("pcl", "a.h") == (((1, 0), ("b.h",)), ((1, 1), ("d.h",)), ((1, 2), ()))
    assert both.list_states("pcl", "c.h") == (((1, 0), ()), ((1, 2), None))
    assert both.list_states("boost", "e.h") == (((1, 74), ("a.h",)),)
    assert both.table.libraries == {"pcl", "boost"} and both.table.sparse == {"boost": ("1.74",)}
    assert both.table.names == known.names and both.table.versions["humble"]["boost"] == "1.74.0"


def test_a_header_may_be_gone_in_a_version():
    machine = HeadersOfMachine(2, lambda owner, library: "1.4" if library else None, _includes())
    assert machine.includes("winch/hook.h") is None and machine.find_owner("winch/all.h") == ("winch", "1.4")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('#include <a.h>\n# include "b.h"\n// #include <c.h>\n/* #include <d.h>\n*/', ("a.h", "b.h")),
        ("#ifdef _WIN32\n#include <windows.h>\n#else\n#include <unistd.h>\n#endif\n#include <z>", ("unistd.h", "z")),
        ("#ifndef _WIN32\n#include <unistd.h>\n#endif", ("unistd.h",)),
        ("#if !defined(_WIN32)\n#include <unistd.h>\n#endif", ("unistd.h",)),
        ("#ifdef WITH_ROPE\n#include <rope.h>\n#endif", ("rope.h",)),
        ("#include WINCH_HEADER", ()),
        ("#if 0\n#include <for_scanners.h>\n#endif", ()),
        ("#if defined(_MSC_VER) || defined __BORLANDC__\n#include <float.h>\n#elif 1\n#include <a>\n#endif", ("a",)),
        (
            "#if defined(__linux__)\n#include <a>\n#elif defined(WITH_ROPE)\n#include <b>\n#else\n#include <c>\n#endif",
            ("a",),
        ),
        ("#if __cplusplus >= 201703L\n#include <a>\n#else\n#include <b>\n#endif", ("a", "b")),
        ("#if defined(_WIN32) && WINCH(\n#include <a>\n#endif", ("a",)),
    ],
)
def test_include_lines(text, expected):
    assert list_includes(text) == expected


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
    assert find_types(text) == (names, announced)


@pytest.mark.parametrize(
    ("distro", "header", "name", "year", "expected"),
    [
        ("humble", "pcl/filters/voxel_grid.h", "FLT_MAX", 2017, True),
        ("jazzy", "pcl/filters/voxel_grid.h", "FLT_MAX", 2017, False),
        ("jazzy", "boost/config.hpp", "FLT_MAX", 2017, False),
        ("jazzy", "opencv2/core.hpp", "std::string", 2017, True),
        ("jazzy", "opencv4/opencv2/core.hpp", "std::string", 2017, True),
        ("jazzy", "eigen3/Eigen/Core", "std::sqrt", 2017, True),
        ("jazzy", "sensor_msgs/msg/image.hpp", "std::vector", 2017, True),
        ("jazzy", "sensor_msgs/msg/image.h", "uint8_t", 2017, True),
        ("jazzy", "sensor_msgs/msg/image.h", "std::vector", 2017, False),
        ("jazzy", "rclcpp/logging.hpp", "std::stringstream", 2017, True),
        ("jazzy", "rclcpp/version.h", "std::string", 2017, False),
        ("jazzy", "memory", "std::find", 2017, False),
        ("jazzy", "memory", "std::find", 2020, True),
        # Of GCC 7 only the headers are known, and names that are defined in one of its own: others may always be there.
        ("crystal", "memory", "std::winch", 2017, True),
        ("crystal", "memory", "std::unique_ptr", 2017, True),
        ("crystal", "vector", "std::regex", 2017, False),
    ],
)
def test_names_of_the_standard_library_that_a_header_brings_along(distro, header, name, year, expected):
    assert load_machine(distro, 2).brings(name, frozenset((header,)), year) is expected


@pytest.mark.parametrize("header", ["rclcpp/version.h", "rclcpp/logging.hpp", "sensor_msgs/msg/image.h"])
def test_headers_that_a_package_writes_while_it_is_built_are_known(header):
    assert header not in load_machine("jazzy", 2).find_brought(header).outside
