"""Names that CMake defines for the sources of a target, or of all."""

import pytest
from joining import graph_on_disk, manifest

CODE = """
    #include <rclcpp/rclcpp.hpp>
    #include "names.hpp"
    BEFORE
    int main(int argc, char ** argv) {
      rclcpp::init(argc, argv);
      auto node = rclcpp::Node::make_shared("arm");
      auto pub = node->create_publisher<std_msgs::msg::Bool>(NAME, 1);
      rclcpp::spin(node);
    }
"""


def list_names(tmp_path, cmake, name="TOPIC", before="", header=""):
    found = graph_on_disk(tmp_path, {
        "arm/package.xml": manifest("arm", "ament_cmake"),
        "arm/CMakeLists.txt": f"""
            cmake_minimum_required(VERSION 3.16)
            project(arm)
            find_package(ament_cmake REQUIRED)
            find_package(rclcpp REQUIRED)
            add_executable(arm arm.cpp)
            {cmake}
            ament_package()
        """,
        "arm/arm.cpp": CODE.replace("NAME", name).replace("BEFORE", before),
        "arm/names.hpp": header,
    })  # fmt: skip
    return {(one.topic, one.only_if) for one in found.endpoints if one.role == "publisher" and not one.implied}


@pytest.mark.parametrize(("cmake", "name", "expected"), [
    ('target_compile_definitions(arm PRIVATE TOPIC="bent")', "TOPIC", "/bent"),
    ('target_compile_definitions(arm PRIVATE "TOPIC=\\"bent\\"")', "TOPIC", "/bent"),
    ('target_compile_definitions(arm PUBLIC "TOPIC=\\"${PROJECT_NAME}\\"")', "TOPIC", "/arm"),
    ('target_compile_definitions(arm PUBLIC BELOW="upper")', 'BELOW "/bent"', "/upper/bent"),
    ('add_definitions(-DTOPIC="bent")', "TOPIC", "/bent"),
    ('add_compile_definitions(TOPIC="bent")', "TOPIC", "/bent"),
    ("add_compile_definitions(SIDE=2)", '"side_" + std::to_string(SIDE)', "/side_2"),
])  # fmt: skip
def test_what_the_build_defines(tmp_path, cmake, name, expected):
    assert list_names(tmp_path, cmake, name) == {(expected, "")}


def test_a_header_has_what_the_targets_of_its_package_have(tmp_path):
    header = "constexpr auto FULL = TOPIC;"
    assert list_names(tmp_path, 'add_definitions(-DTOPIC="bent")', "FULL", header=header) == {("/bent", "")}


@pytest.mark.parametrize("cmake", [
    'if(SLOW)\ntarget_compile_definitions(arm PRIVATE TOPIC="bent")\nendif()',
    # The header may define it only where nothing else does.
    'target_compile_definitions(arm PRIVATE TOPIC="bent")',
])  # fmt: skip
def test_of_several_definitions_none_is_certain(tmp_path, cmake):
    depends = "`TOPIC` is defined so"
    found = list_names(tmp_path, cmake, before='#ifndef TOPIC\n#define TOPIC "straight"\n#endif')
    assert found == {("/bent", depends), ("/straight", depends)}


@pytest.mark.parametrize("cmake", [
    # It is for another target.
    'add_library(other other.cpp)\ntarget_compile_definitions(other PRIVATE TOPIC="bent")',
    'target_compile_definitions(arm PRIVATE TOPIC="$ENV{TOPIC}")',
    "target_compile_definitions(arm PRIVATE TOPIC=make_topic)",
])  # fmt: skip
def test_what_is_not_known_gives_no_name(tmp_path, cmake):
    assert list_names(tmp_path, cmake) == {("", "")}
