"""Libraries that ROS releases and whose contents are not stored may bring any header and any CMake package; a member
whose object shows no type, and a name that the file declares itself, are no errors."""

from __future__ import annotations

import pytest
from rosimpact.impact.analysis.session import Options
from rule_cases import check_files

MANIFEST = """<?xml version="1.0"?>
<package format="3">
  <name>mapper</name><version>1.0.0</version><description>maps</description>
  <maintainer email="robots@example.org">Robots</maintainer><license>Apache-2.0</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <depend>{declared}</depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""
CMAKE = """cmake_minimum_required(VERSION 3.16)
project(mapper)
find_package(ament_cmake REQUIRED)
{find}
add_library(mapper SHARED src/mapper.cpp)
{link}
install(TARGETS mapper DESTINATION lib)
ament_package()
"""


def errors(tmp_path, code: str, declared: str, find: str, link: str, target: str = "iron") -> list[str]:
    files = {
        "mapper/package.xml": MANIFEST.format(declared=declared),
        "mapper/CMakeLists.txt": CMAKE.format(find=find, link=link),
        "mapper/src/mapper.cpp": code,
    }
    report = check_files(files, Options(targets=(target,), cache=tmp_path, jobs=1), None)
    return [f"{f.rule} {f.subject}" for f in report.findings if f.severity == "error"]


MAPS = "#include <mrpt/maps/CVoxelMap.h>\nint main_() { return 0; }\n"


@pytest.mark.parametrize(
    ("declared", "found"),
    [
        ("mrpt_libmaps", []),
        ("rsl", ["removed-header mrpt/maps/CVoxelMap.h", "undeclared-package mrpt"]),
    ],
    ids=["a library whose contents are not stored", "one that is called otherwise"],
)
def test_headers_and_cmake_packages(tmp_path, declared, found):
    link = "target_link_libraries(mapper mrpt::maps)"
    assert sorted(errors(tmp_path, MAPS, declared, "find_package(mrpt-maps REQUIRED)", link)) == found


OWN = """#include <rclcpp/rclcpp.hpp>
#include <moveit/kinematics_base/kinematics_base.h>
namespace solver {{
{declaration}
class Solver : public kinematics::KinematicsBase {{
 public:
  void search() {{ RCLCPP_INFO(LOGGER, "searching"); }}
}};
}}
"""


@pytest.mark.parametrize(
    ("declaration", "found"),
    [
        ('namespace { auto const LOGGER = rclcpp::get_logger("solver"); }', False),
        ("", True),
    ],
    ids=["the file has its own", "only the base had it"],
)
def test_a_name_that_a_base_class_lost(tmp_path, declaration, found):
    code = OWN.replace("{{", "{").replace("}}", "}").replace("{declaration}", declaration)
    find = "find_package(moveit_core REQUIRED)\nfind_package(rclcpp REQUIRED)"
    link = "ament_target_dependencies(mapper moveit_core rclcpp)"
    got = errors(tmp_path, code, "moveit_core", find, link, "jazzy")
    assert any(one.startswith("removed-symbol") and one.endswith("LOGGER") for one in got) is found


def test_a_member_of_something_whose_type_does_not_show(tmp_path):
    code = (
        "#include <rosbag2_cpp/reader.hpp>\nstruct Point { double time_stamp; };\n"
        "double sum(const Point& a, rosbag2_cpp::Reader&) { return a.time_stamp; }\n"
    )
    find, link = "find_package(rosbag2_cpp REQUIRED)", "ament_target_dependencies(mapper rosbag2_cpp)"
    assert errors(tmp_path, code, "rosbag2_cpp", find, link, "jazzy") == []
