"""What rules promise to leave alone, each beside the small change that makes them speak; and nothing new where nothing
changed.
"""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import NamedTuple

import pytest
import rule_cases
from rosimpact.impact.analysis.check import check
from rosimpact.impact.analysis.session import Options
from rosimpact.impact.cli.app import app
from rosimpact.impact.rules.rule import load_rules
from rule_cases import Case
from typer.testing import CliRunner

CASES = [case for case in rule_cases.find_cases() if case.findings]
Files = dict[str, str]


class Silent(NamedTuple):
    """A workspace on which a rule says nothing above a note, and an edit (path, old, new) behind which it does."""

    rule: str
    targets: tuple[str, ...]
    files: Files
    spoilt: tuple[str, str, str]


def manifest(*lines: str, tool: str = "ament_cmake", version: int = 3, name: str = "sled") -> str:
    """A manifest of these dependencies: `name` for a depend, `tag:name`, or a whole element."""
    elements = [
        line
        if line.startswith("<")
        else "<{0}>{1}</{0}>".format(*(line if ":" in line else f"depend:{line}").split(":"))
        for line in (f"buildtool_depend:{tool}", *lines)
    ]
    return (
        f'<?xml version="1.0"?>\n<package format="{version}">\n<name>{name}</name>\n<version>1.0.0</version>\n'
        '<description>sled</description>\n<maintainer email="robots@example.org">Robots</maintainer>\n'
        "<license>Apache-2.0</license>\n" + "\n".join(elements) + "\n</package>\n"
    )


HEAD = "cmake_minimum_required(VERSION 3.5)\nproject(sled)\n"


def ament(cmake: str, *dependencies: str, **sources: str) -> Files:
    """A package for colcon. sources: text by file name, with `_` for the dot."""
    text = f"{HEAD}find_package(ament_cmake REQUIRED)\n{cmake}\nament_package()\n"
    return {"package.xml": manifest(*dependencies), "CMakeLists.txt": text, **named(sources)}


def catkin(components: str, cmake: str, *dependencies: str, **sources: str) -> Files:
    """A package for catkin. sources: text by file name, with `_` for the dot."""
    text = f"{HEAD}find_package(catkin REQUIRED COMPONENTS {components})\n{cmake}\n"
    return {"package.xml": manifest(*dependencies, tool="catkin", version=2), "CMakeLists.txt": text, **named(sources)}


def named(sources: dict[str, str]) -> Files:
    return {name.replace("__", "/").replace("_", "."): text for name, text in sources.items()}


def add_programs(lift: str, draw: str = "") -> Files:
    """A package below packages/ with an installed program, a folder of modules beside it, and a tool."""
    install = "DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})\n"
    return {
        "packages/sled/package.xml": manifest("exec_depend:rospy", tool="catkin", version=2),
        "packages/sled/CMakeLists.txt": f"{HEAD}find_package(catkin REQUIRED)\ncatkin_package()\n"
        f"catkin_install_python(PROGRAMS scripts/lift.py {install}install(DIRECTORY scripts/parts {install}",
        "packages/sled/scripts/lift.py": lift,
        "packages/sled/scripts/parts/hook.py": "WIDTH = 3\n",
        "packages/sled/tools/draw.py": draw,
    }


NODE = "find_package(rclcpp REQUIRED)\nadd_executable(run run.cpp)\ntarget_link_libraries(run rclcpp::rclcpp {})\n"
INSTALLED = "install(TARGETS run DESTINATION lib/${PROJECT_NAME})"
TF2 = NODE.format("tf2_geometry_msgs::tf2_geometry_msgs") + "find_package(tf2_geometry_msgs REQUIRED)\n" + INSTALLED
CATKIN_NODE = "catkin_package()\ninclude_directories(${catkin_INCLUDE_DIRS})\nadd_executable(run run.cpp)\n"
OPENCV = (
    "find_package(OpenCV REQUIRED)\n" + CATKIN_NODE + "target_link_libraries(run ${catkin_LIBRARIES} ${OpenCV_LIBS})"
)
H, HPP = "#include <tf2_geometry_msgs/tf2_geometry_msgs.h>\n", "#include <tf2_geometry_msgs/tf2_geometry_msgs.hpp>\n"
NAMED_TARGET = (
    "set(SLEDGE_TARGET_NAME run)\nadd_executable(${SLEDGE_TARGET_NAME} run.cpp)\n"
    "install(TARGETS ${SLEDGE_NAME} DESTINATION lib)\n"
)
RCLCPP = "#include <rclcpp/rclcpp.hpp>\n"
MAIN = "int main() { return 0; }\n"
READ = '#include <opencv2/imgcodecs.hpp>\n#include <ros/ros.h>\nint main() { return cv::imread("a", %s).rows; }\n'
FLOE = {"msg/Floe.msg": "float64 size\n"}
FLOE_CMAKE = "add_message_files(FILES Floe.msg)\ngenerate_messages()\ncatkin_package(CATKIN_DEPENDS message_runtime)\n"
FLOE_DEPENDS = (
    "build_depend:message_generation",
    "build_export_depend:message_runtime",
    "exec_depend:message_runtime",
    "roscpp",
)

SILENT = {
    "what the interfaces of the package rest on": Silent(
        "ungiven-package",
        ("jazzy",),
        ament(
            "find_package(geometry_msgs REQUIRED)\nfind_package(rosidl_default_generators REQUIRED)\n"
            'rosidl_generate_interfaces(sled "msg/Pull.msg" DEPENDENCIES geometry_msgs)\n'
            "add_executable(drive drive.cpp)\n"
            "rosidl_get_typesupport_target(typesupport sled rosidl_typesupport_cpp)\n"
            "target_link_libraries(drive ${typesupport})",
            "geometry_msgs",
            "buildtool_depend:rosidl_default_generators",
            "exec_depend:rosidl_default_runtime",
            "<member_of_group>rosidl_interface_packages</member_of_group>",
            drive_cpp="#include <geometry_msgs/msg/point.hpp>\nint main() { return 0; }\n",
        )
        | {"msg/Pull.msg": "geometry_msgs/Point at\n"},
        ("CMakeLists.txt", "target_link_libraries(drive ${typesupport})", ""),
    ),
    "variables of a package that is looked for under several names": Silent(
        "misspelt-cmake-variable",
        ("jazzy",),
        ament(
            "set(VERSION_MAJOR 1)\nfind_package(QT NAMES Qt6 Qt5 REQUIRED COMPONENTS Core)\n"
            "add_library(sled sled.cpp)\ntarget_link_libraries(sled Qt${QT_VERSION_MAJOR}::Core)",
            "qtbase5-dev",
            sled_cpp="int pull() { return 0; }\n",
        ),
        ("CMakeLists.txt", "find_package(QT NAMES Qt6 Qt5 REQUIRED COMPONENTS Core)\n", ""),
    ),
    "headers of what the build downloads": Silent(
        "removed-header",
        ("humble",),
        ament(
            "include(FetchContent)\nFetchContent_Declare(Catch2 GIT_REPOSITORY https://example.org/Catch2.git)\n"
            "FetchContent_MakeAvailable(Catch2)\nadd_executable(weigh weigh.cpp)\n"
            "target_link_libraries(weigh Catch2::Catch2)",
            "catch2",
            weigh_cpp="#include <catch2/catch_test_macros.hpp>\nint main() { return 0; }\n",
        ),
        ("CMakeLists.txt", "FetchContent_MakeAvailable(Catch2)\n", ""),
    ),
    "a target of a library that the build downloads": Silent(
        "removed-cmake-name",
        ("humble",),
        ament(
            "include(FetchContent)\nFetchContent_Declare(yaml-cpp URL https://example.org/y.tar.gz)\n"
            "FetchContent_MakeAvailable(yaml-cpp)\nfind_package(yaml-cpp REQUIRED)\nadd_executable(weigh weigh.cpp)\n"
            "target_link_libraries(weigh yaml-cpp::yaml-cpp)",
            "yaml-cpp",
            weigh_cpp="int main() { return 0; }\n",
        ),
        ("CMakeLists.txt", "FetchContent_MakeAvailable(yaml-cpp)\n", ""),
    ),
    "headers in a folder of the build that an external project fills": Silent(
        "undeclared-package",
        ("humble",),
        ament(
            "include(ExternalProject)\nExternalProject_Add(vendored_parser URL https://example.org/y.tar.gz)\n"
            "add_executable(weigh weigh.cpp)\n"
            "target_include_directories(weigh PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/yaml/include)",
            weigh_cpp="#include <yaml-cpp/yaml.h>\nint main() { return 0; }\n",
        ),
        ("CMakeLists.txt", "ExternalProject_Add(vendored_parser URL https://example.org/y.tar.gz)\n", ""),
    ),
    "a header that is called after what the build downloads": Silent(
        "undeclared-package",
        ("humble",),
        ament(
            "include(FetchContent)\nFetchContent_Declare(yaml-cpp URL https://example.org/y.tar.gz)\n"
            "FetchContent_MakeAvailable(yaml-cpp)\nadd_executable(weigh weigh.cpp)\n"
            "target_include_directories(weigh PRIVATE ${yaml-cpp_SOURCE_DIR}/include)",
            weigh_cpp="#include <yaml-cpp/yaml.h>\nint main() { return 0; }\n",
        ),
        ("CMakeLists.txt", "FetchContent_MakeAvailable(yaml-cpp)\n", ""),
    ),
    "an included file of the package that is not called like a header": Silent(
        "removed-header",
        ("humble",),
        ament(
            "add_executable(pull pull.cpp)\ntarget_include_directories(pull PRIVATE include)",
            pull_cpp='#include "sled/pull.hpp"\n#include "sled/types.macro"\nint main() { return 0; }\n',
        )
        | {"include/sled/types.macro": "TYPE(int)\n", "include/sled/pull.hpp": "int pull();\n"},
        ("pull.cpp", "types.macro", "kinds.macro"),
    ),
    "a header of ROS 1 in a package that ros1_bridge gives it to": Silent(
        "unknown-header",
        ("humble",),
        ament(
            "find_package(ros1_bridge REQUIRED)\nfind_ros1_package(std_msgs REQUIRED)\nadd_library(sled sled.cpp)",
            "ros1_bridge",
            "std_msgs",
            sled_cpp="#include <std_msgs/String.h>\n",
        ),
        ("package.xml", "<depend>ros1_bridge</depend>", ""),
    ),
    "a header for ROS 2 of a package that is made for both": Silent(
        "unknown-header",
        ("noetic",),
        catkin(
            "roscpp sensor_msgs",
            "catkin_package()\ninclude_directories(${catkin_INCLUDE_DIRS})\n"
            "add_executable(pull pull.cpp)\ntarget_link_libraries(pull ${catkin_LIBRARIES})\n"
            "if(SLED_OF_ROS2)\nadd_executable(push push.cpp)\nendif()\n",
            "roscpp",
            "sensor_msgs",
            pull_cpp="#include <ros/ros.h>\n#include <sensor_msgs/Imu.h>\nint main() { return 0; }\n",
            push_cpp="#include <rclcpp/rclcpp.hpp>\n#include <sensor_msgs/msg/imu.hpp>\nint main() { return 0; }\n",
        ),
        ("push.cpp", "#include <rclcpp/rclcpp.hpp>\n", ""),
    ),
    "a relative import that is called like what another package had": Silent(
        "removed-symbol",
        ("humble",),
        ament("ament_python_install_package(sled)", "buildtool_depend:ament_cmake_python", "exec_depend:launch")
        | {
            "sled/__init__.py": "from .launch.launcher import Launcher\n",
            "sled/launch/__init__.py": "",
            "sled/launch/launcher.py": "class Launcher:\n    pass\n",
        },
        ("sled/__init__.py", "from .launch", "from launch"),
    ),
    "what every machine has by the configuration": Silent(
        "undeclared-package",
        ("humble",),
        ament(
            "find_package(Boost REQUIRED)\nfind_package(geometry_msgs REQUIRED)\nadd_library(sled sled.cpp)\n"
            "target_link_libraries(sled Boost::boost geometry_msgs::geometry_msgs)",
            sled_cpp="#include <boost/array.hpp>\n#include <geometry_msgs/msg/point.hpp>\n",
            rosimpact_toml='[workspace]\ninstalled = ["common_interfaces", "libboost-all-dev"]\n',
        ),
        ("rosimpact.toml", '"common_interfaces", ', ""),
    ),
    "the folder of a Python package that the build installs": Silent(
        "nonexistent-install",
        ("jazzy",),
        ament(
            "find_package(ament_cmake_python REQUIRED)\nament_python_install_package(${PROJECT_NAME})",
            "ament_cmake_python",
        )
        | {"sled/__init__.py": ""},
        ("CMakeLists.txt", "package(${PROJECT_NAME})", "package(${PROJECT_NAME}_tools)"),
    ),
    "a program whose last of several destinations is where it is looked for": Silent(
        "misplaced-install",
        ("jazzy",),
        ament(
            "add_executable(pull pull.cpp)\n"
            "install(TARGETS pull RUNTIME DESTINATION bin\n  DESTINATION lib/${PROJECT_NAME})\n"
            "install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})",
            pull_cpp="int main() { return 0; }\n",
            launch__pull_launch_xml='<launch><node pkg="sled" exec="pull"/></launch>\n',
        ),
        ("CMakeLists.txt", "bin\n  DESTINATION lib/${PROJECT_NAME}", "bin"),
    ),
    "a target that a command of a found package may add": Silent(
        "nonexistent-target",
        ("jazzy",),
        ament(
            "find_package(ament_cmake_gtest REQUIRED)\nament_find_gtest()\ntarget_link_libraries(gtest_main gtest)",
            "ament_cmake_gtest",
        ),
        ("CMakeLists.txt", "ament_find_gtest()\n", ""),
    ),
    "a command by the name that it has where the tree defines it anew": Silent(
        "misspelt-command",
        ("jazzy",),
        ament(
            "include(GoogleTest)\nfunction(gtest_discover_tests)\n  _gtest_discover_tests(${ARGV})\nendfunction()\n"
            "gtest_discover_tests(sled)",
        ),
        ("CMakeLists.txt", "_gtest_discover_tests(${ARGV})", "gtest_discover_testss(${ARGV})"),
    ),
    "a header that is called nearly like the one that it wraps": Silent(
        "unknown-header",
        ("dashing",),
        {
            **ament(
                "find_package(OpenSplice REQUIRED)\nadd_executable(pull pull.cpp)\n"
                "target_include_directories(pull PRIVATE include)",
                "libopensplice69",
                pull_cpp='#include "rope__handle.h"\nint main() { return 0; }\n',
            ),
            "include/rope__handle.h": "#include <rope_handle.h>\n",
        },
        ("pull.cpp", "rope__handle.h", "rope_handle.h"),
    ),
    "modules that the package's own virtual environment may hold": Silent(
        "undeclared-package",
        ("noetic@2024-06-01",),
        catkin(
            "catkin_virtualenv rospy",
            "catkin_generate_virtualenv(PYTHON_INTERPRETER python3)\n"
            "catkin_package()\ncatkin_install_python(PROGRAMS weigh.py DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})",
            "build_depend:catkin_virtualenv",
            "rospy",
            weigh_py="#!/usr/bin/env python3\nimport requests\nimport rospy\n",
        ),
        ("CMakeLists.txt", "catkin_generate_virtualenv(PYTHON_INTERPRETER python3)\n", ""),
    ),
    "boost that every machine has by the configuration": Silent(
        "undeclared-package",
        ("humble",),
        ament(
            "find_package(Boost REQUIRED)\nadd_library(sled sled.cpp)\ntarget_link_libraries(sled Boost::boost)",
            sled_cpp="#include <boost/array.hpp>\n",
            rosimpact_toml='[workspace]\ninstalled = ["libboost-all-dev"]\n',
        ),
        ("rosimpact.toml", '"libboost-all-dev"', ""),
    ),
    "components that a macro which cannot be read may ask for": Silent(
        "unlinked-boost",
        ("humble",),
        ament(
            "include(cmake/macros.cmake)\nfind_package(Boost REQUIRED)\n"
            "add_project_dependency(Boost COMPONENTS thread)\nadd_library(sled sled.cpp)\n"
            "target_link_libraries(sled Boost::thread)",
            "libboost-dev",
            sled_cpp="#include <boost/thread.hpp>\n",
        ),
        ("CMakeLists.txt", "include(cmake/macros.cmake)\n", ""),
    ),
    "a header chosen by __has_include": Silent(
        "removed-header",
        ("humble", "jazzy"),
        ament(
            TF2,
            "rclcpp",
            "tf2_geometry_msgs",
            run_cpp="#if __has_include(<tf2_geometry_msgs/tf2_geometry_msgs.hpp>)\n"
            + HPP
            + "#else\n"
            + H
            + "#endif\n"
            + MAIN,
        ),
        ("run.cpp", "#else\n" + H, "#endif\n" + H + "#if 1\n"),
    ),
    "a header chosen by a version": Silent(
        "removed-header",
        ("humble", "jazzy"),
        ament(
            TF2,
            "rclcpp",
            "tf2_geometry_msgs",
            run_cpp="#include <rclcpp/version.h>\n#if RCLCPP_VERSION_GTE(28, 0, 0)\n"
            + HPP
            + "#else\n"
            + H
            + "#endif\n"
            + MAIN,
        ),
        ("run.cpp", "#if RCLCPP_VERSION_GTE(28, 0, 0)", "#if 0"),
    ),
    "the path by which all versions of OpenCV are included": Silent(
        "removed-header",
        ("humble", "jazzy"),
        ament(
            NODE.format("${OpenCV_LIBS}") + "find_package(OpenCV REQUIRED)\n" + INSTALLED,
            "rclcpp",
            "libopencv-dev",
            run_cpp="#include <opencv2/core.hpp>\n" + MAIN,
        ),
        ("run.cpp", "<opencv2", "<opencv4/opencv2"),
    ),
    "another spelling of a package that pkg-config may stand for": Silent(
        "misspelt-cmake-name",
        ("humble",),
        ament(
            "find_package(rclcpp REQUIRED)\nfind_package(ASSIMP QUIET)\nif(NOT ASSIMP_FOUND)\n"
            "  find_package(PkgConfig REQUIRED)\n  pkg_check_modules(ASSIMP REQUIRED assimp)\nendif()\n"
            "add_executable(run run.cpp)\nament_target_dependencies(run rclcpp)\n"
            "target_link_libraries(run ${ASSIMP_LIBRARIES})\n" + INSTALLED,
            "rclcpp",
            "assimp-dev",
            run_cpp=RCLCPP + MAIN,
        ),
        ("CMakeLists.txt", "dependencies(run rclcpp)", "dependencies(run rclcpp ASSIMP)"),
    ),
    "a header in code that is switched off": Silent(
        "removed-header",
        ("jazzy",),
        ament(TF2, "rclcpp", "tf2_geometry_msgs", run_cpp="#if 0\n" + H + "#endif\n" + HPP + MAIN),
        ("run.cpp", "#if 0", "#if 1"),
    ),
    "a header that the workspace brings": Silent(
        "removed-header",
        ("jazzy",),
        ament(TF2, "rclcpp", "tf2_geometry_msgs", run_cpp=H + MAIN, include__tf2_geometry_msgs__tf2_geometry_msgs_h="")
        | {"include/tf2_geometry_msgs/tf2_geometry_msgs.h": "#pragma once\n"},
        ("run.cpp", "tf2_geometry_msgs.h>", "tf2_geometry_msgs.h>\n#include <tf2_eigen/tf2_eigen.h>"),
    ),
    "ROS 1 names of messages in a bridge": Silent(
        "removed-header",
        ("humble",),
        ament(
            NODE.format("") + "find_package(std_msgs REQUIRED)\n" + INSTALLED,
            "rclcpp",
            "std_msgs",
            run_cpp="#include <ros/ros.h>\n#include <rclcpp/rclcpp.hpp>\n#include <std_msgs/String.h>\n" + MAIN,
        ),
        ("run.cpp", "#include <ros/ros.h>\n", ""),
    ),
    "a macro that the package defines": Silent(
        "removed-symbol",
        ("noetic",),
        catkin(
            "roscpp",
            OPENCV,
            "roscpp",
            "libopencv-dev",
            run_cpp="#ifndef CV_LOAD_IMAGE_ANYDEPTH\n#define CV_LOAD_IMAGE_ANYDEPTH 2\n#endif\n"
            + READ % "CV_LOAD_IMAGE_ANYDEPTH",
        ),
        ("run.cpp", "#define CV_LOAD_IMAGE_ANYDEPTH 2\n", ""),
    ),
    "a name chosen by a version": Silent(
        "removed-symbol",
        ("noetic",),
        catkin(
            "roscpp",
            OPENCV,
            "roscpp",
            "libopencv-dev",
            run_cpp="#include <opencv2/core/version.hpp>\n#if CV_VERSION_MAJOR < 4\n"
            "int how() { return CV_LOAD_IMAGE_ANYDEPTH; }\n#endif\n" + READ % "2",
        ),
        ("run.cpp", "#if CV_VERSION_MAJOR < 4", "#if CV_VERSION_MAJOR < 5"),
    ),
    "a name that another package's header may bring back": Silent(
        "removed-symbol",
        ("humble", "jazzy"),
        ament(
            NODE.format("${OpenCV_LIBS} grid_map_cv::grid_map_cv")
            + "find_package(OpenCV REQUIRED)\nfind_package(grid_map_cv REQUIRED)\n"
            + INSTALLED,
            "rclcpp",
            "libopencv-dev",
            "grid_map_cv",
            run_cpp="#include <grid_map_cv/GridMapCvConverter.hpp>\n#include <opencv2/imgproc.hpp>\n"
            "int main() { return CV_RETR_LIST; }\n",
        ),
        ("run.cpp", "#include <grid_map_cv/GridMapCvConverter.hpp>\n", ""),
    ),
    "a header of C beside that of C++": Silent(
        "removed-header",
        ("jazzy",),
        ament(
            NODE.format("${std_msgs_TARGETS}")
            + "find_package(std_msgs REQUIRED)\ntarget_include_directories(run PRIVATE include)\n"
            + INSTALLED,
            "rclcpp",
            "std_msgs",
            run_cpp='#include "sled/sled.hpp"\n' + MAIN,
            include__sled__sled_hpp="#pragma once\n#include <rclcpp/rclcpp.hpp>\n#include <std_msgs/msg/string.h>\n"
            "#include <std_msgs/msg/string.hpp>\n",
        ),
        ("include/sled/sled.hpp", "#include <std_msgs/msg/string.hpp>\n", ""),
    ),
    "a variable that is called like a function of old": Silent(
        "removed-symbol",
        ("noetic",),
        catkin(
            "roscpp",
            OPENCV,
            "roscpp",
            "libopencv-dev",
            run_cpp="int x(const cv::Point* all) {\n  const cv::Point &cvPoint = all[0];\n  return cvPoint.x;\n}\n"
            + READ % "2",
        ),
        ("run.cpp", "&cvPoint = all[0]", "&one = cvPoint(1, 2)"),
    ),
    "a name in a comment and in a text": Silent(
        "removed-symbol",
        ("noetic",),
        catkin(
            "roscpp",
            OPENCV,
            "roscpp",
            "libopencv-dev",
            run_cpp='// CV_LOAD_IMAGE_ANYDEPTH\nconst char* text = "CV_LOAD_IMAGE_ANYDEPTH";\n' + READ % "2",
        ),
        ("run.cpp", '"CV_LOAD_IMAGE_ANYDEPTH"', "(const char*)CV_LOAD_IMAGE_ANYDEPTH"),
    ),
    "a name deprecated there, under a version test": Silent(
        "deprecated-name",
        ("kilted",),
        ament(
            NODE.format("") + INSTALLED,
            "rclcpp",
            run_cpp=RCLCPP + "#if RCLCPP_VERSION_GTE(29, 0, 0)\nrclcpp::executors::SingleThreadedExecutor e;\n#else\n"
            "rclcpp::executors::StaticSingleThreadedExecutor e;\n#endif\n" + MAIN,
        ),
        ("run.cpp", "RCLCPP_VERSION_GTE(29, 0, 0)", "0"),
    ),
    "a renamed package under a condition": Silent(
        "renamed-package",
        ("galactic", "humble"),
        ament("", '<exec_depend condition="$ROS_DISTRO == galactic">nav2_recoveries</exec_depend>'),
        ("package.xml", ' condition="$ROS_DISTRO == galactic"', ""),
    ),
    "a removed package that the workspace brings": Silent(
        "removed-package",
        ("humble",),
        {
            "a/package.xml": manifest("exec_depend:ros1_bridge"),
            "a/CMakeLists.txt": "project(sled)\n",
            "b/package.xml": manifest(name="ros1_bridge"),
            "b/CMakeLists.txt": "project(ros1_bridge)\n",
        },
        ("b/package.xml", "<name>ros1_bridge", "<name>my_bridge"),
    ),
    "an include in code that is switched off": Silent(
        "undeclared-package",
        ("humble",),
        ament(
            NODE.format("") + INSTALLED,
            "rclcpp",
            run_cpp=RCLCPP + "#if 0\n#include <pcl_conversions/pcl_conversions.h>\n#endif\n" + MAIN,
        ),
        ("run.cpp", "#if 0", "#if 1"),
    ),
    "an include of a file that nothing compiles": Silent(
        "undeclared-package",
        ("humble",),
        ament(
            NODE.format("") + INSTALLED,
            "rclcpp",
            run_cpp=RCLCPP + MAIN,
            old_cpp="#include <pcl_conversions/pcl_conversions.h>\n",
        ),
        ("CMakeLists.txt", "add_executable(run run.cpp)", "add_executable(run run.cpp old.cpp)"),
    ),
    "an include of a file that is only compiled where a library happens to be": Silent(
        "undeclared-package",
        ("humble",),
        ament(
            "find_package(rclcpp REQUIRED)\npkg_check_modules(LTTNG lttng-ust)\nset(SOURCES run.cpp)\n"
            "if(LTTNG_FOUND)\n  list(APPEND SOURCES trace.cpp)\nendif()\nadd_executable(run ${SOURCES})\n"
            "target_link_libraries(run rclcpp::rclcpp)\ninstall(DIRECTORY include/ DESTINATION include)\n" + INSTALLED,
            "rclcpp",
            run_cpp=RCLCPP + MAIN,
            trace_cpp="#include <sled/trace.h>\n",
            include__sled__trace_h="#include <pcl_conversions/pcl_conversions.h>\n",
        ),
        ("CMakeLists.txt", "set(SOURCES run.cpp)", "set(SOURCES run.cpp trace.cpp)"),
    ),
    "a call of a method that the workspace declares": Silent(
        "changed-signature",
        ("humble",),
        ament(
            NODE.format("") + INSTALLED,
            "rclcpp",
            run_cpp=RCLCPP + "struct Sled : rclcpp::Node\n{\n  void create_timer(double period, void (*callback)());\n"
            "  void go() { this->create_timer(100ms, callback_); }\n};\n" + MAIN,
        ),
        ("run.cpp", "  void create_timer(double period, void (*callback)());\n", ""),
    ),
    "a call of a method that a package it is built with declares": Silent(
        "changed-signature",
        ("humble",),
        {
            f"sled/{name}": text
            for name, text in ament(
                NODE.format("") + INSTALLED,
                "rclcpp",
                "raft",
                run_cpp=RCLCPP
                + "struct Sled : rclcpp::Node\n{\n  void go() { this->create_timer(100ms, callback_); }\n};\n"
                + MAIN,
            ).items()
        }
        | {
            "raft/package.xml": manifest(name="raft"),
            "raft/CMakeLists.txt": HEAD.replace("sled", "raft") + "find_package(ament_cmake REQUIRED)\n"
            "add_library(raft raft.cpp)\nament_package()\n",
            "raft/raft.cpp": "struct Raft\n{\n  void create_timer(double period, void (*callback)());\n};\n",
        },
        ("sled/package.xml", "<depend>raft</depend>\n", ""),
    ),
    "sources of an interface package that generates what another one lists": Silent(
        "removed-header",
        ("jazzy",),
        ament(
            "find_package(rosidl_default_generators REQUIRED)\nfind_package(floes REQUIRED)\n"
            "rosidl_generate_interfaces(${PROJECT_NAME} msg/Floe.msg ${floes_MSG_FILES})\n"
            "add_executable(run run.cpp)\n" + INSTALLED,
            "rosidl_default_generators",
            **{"msg/Floe_msg": "float64 size\n", "run_cpp": "#include <sled/msg/berg.hpp>\n" + MAIN},
        ),
        ("CMakeLists.txt", " ${floes_MSG_FILES}", ""),
    ),
    "the CMake name of what a declared vendor package brings": Silent(
        "misspelt-cmake-name",
        ("jazzy",),
        ament("find_package(gz-sim REQUIRED)", "gz_sim_vendor", "ros_gz_sim"),
        ("CMakeLists.txt", "gz-sim", "ros_gz_sin"),
    ),
    "messages that another declared package brings": Silent(
        "undeclared-package",
        ("humble", "jazzy"),
        ament(
            NODE.format("${sensor_msgs_TARGETS}") + "find_package(sensor_msgs REQUIRED)\n" + INSTALLED,
            "rclcpp",
            "sensor_msgs",
            run_cpp=RCLCPP + "#include <std_msgs/msg/header.hpp>\n" + MAIN,
        ),
        ("run.cpp", "std_msgs/msg/header", "shape_msgs/msg/plane"),
    ),
    "a package looked for and not required": Silent(
        "undeclared-package",
        ("jazzy",),
        ament(NODE.format("") + "find_package(pcl_conversions QUIET)\n" + INSTALLED, "rclcpp", run_cpp=RCLCPP + MAIN),
        ("CMakeLists.txt", "pcl_conversions QUIET", "pcl_conversions REQUIRED"),
    ),
    "a dependency whose condition holds": Silent(
        "undeclared-package",
        ("noetic",),
        {
            **catkin(
                "roscpp tf2_eigen",
                CATKIN_NODE + "target_link_libraries(run ${catkin_LIBRARIES})",
                run_cpp="#include <ros/ros.h>\n#include <tf2_eigen/tf2_eigen.h>\n" + MAIN,
            ),
            "package.xml": manifest(
                "roscpp", '<depend condition="$ROS_VERSION == 1">tf2_eigen</depend>', tool="catkin"
            ),
        },
        ("package.xml", "$ROS_VERSION == 1", "$ROS_VERSION == 2"),
    ),
    "an import with an except branch": Silent(
        "undeclared-package",
        ("humble",),
        ament(
            "install(PROGRAMS run.py DESTINATION lib/${PROJECT_NAME})",
            "exec_depend:rclpy",
            run_py="#!/usr/bin/env python3\nimport rclpy\n"
            "try:\n    import serial\nexcept ImportError:\n    serial = None\n",
        ),
        ("run.py", "try:\n    import serial\nexcept ImportError:\n    serial = None\n", "import serial\n"),
    ),
    "a dependency for tests, of what another brings": Silent(
        "wrong-dependency-kind",
        ("humble",),
        ament(
            NODE.format("${sensor_msgs_TARGETS}")
            + "find_package(sensor_msgs REQUIRED)\nfind_package(std_msgs REQUIRED)\n"
            + INSTALLED,
            "rclcpp",
            "sensor_msgs",
            "test_depend:std_msgs",
            run_cpp=RCLCPP + "#include <std_msgs/msg/header.hpp>\n" + MAIN,
        ),
        ("package.xml", "<depend>sensor_msgs</depend>", "<test_depend>sensor_msgs</test_depend>"),
    ),
    "executables that only tests run": Silent(
        "missing-install",
        ("jazzy",),
        ament(
            NODE.format("") + "add_executable(test_run test/probe.cpp)\n" + INSTALLED,
            "rclcpp",
            run_cpp=MAIN,
            test__probe_cpp=MAIN,
        ),
        ("CMakeLists.txt", "add_executable(test_run test/probe.cpp)", "add_executable(walk run.cpp)"),
    ),
    "targets installed by a list": Silent(
        "missing-install",
        ("humble",),
        ament(
            "add_executable(run run.cpp)\nadd_executable(walk run.cpp)\nset(TOOLS run walk)\n"
            "install(TARGETS ${TOOLS} DESTINATION lib/${PROJECT_NAME})",
            run_cpp=MAIN,
        ),
        ("CMakeLists.txt", "set(TOOLS run walk)", "set(TOOLS run)"),
    ),
    "headers that a build fetches": Silent(
        "missing-install",
        ("jazzy",),
        ament(
            "install(DIRECTORY ${arm_SOURCE_DIR}/include/arm/ DESTINATION include/sled)",
            include__arm__arm_hpp="#pragma once\n",
        ),
        ("CMakeLists.txt", "${arm_SOURCE_DIR}/", ""),
    ),
    "a target that waits through a library": Silent(
        "missing-interface-wiring",
        ("noetic",),
        catkin(
            "message_generation roscpp",
            FLOE_CMAKE + "include_directories(${catkin_INCLUDE_DIRS})\nadd_library(floe floe.cpp)\n"
            "add_dependencies(floe ${PROJECT_NAME}_generate_messages_cpp)\nadd_executable(run run.cpp)\n"
            "target_link_libraries(run floe)",
            *FLOE_DEPENDS,
            run_cpp="#include <sled/Floe.h>\n" + MAIN,
            floe_cpp="#include <sled/Floe.h>\n",
        )
        | FLOE,
        ("CMakeLists.txt", "target_link_libraries(run floe)", ""),
    ),
    "messages of another package, waited for by catkin's variable": Silent(
        "missing-interface-wiring",
        ("noetic",),
        {
            **{
                f"a/{path}": text
                for path, text in {**catkin("message_generation", FLOE_CMAKE, *FLOE_DEPENDS[:3]), **FLOE}.items()
            },
            **{
                f"b/{path}": text.replace("sled)", "dogs)").replace("<name>sled", "<name>dogs")
                for path, text in catkin(
                    "sled",
                    CATKIN_NODE + "add_dependencies(run ${catkin_EXPORTED_TARGETS})",
                    "sled",
                    run_cpp="#include <sled/Floe.h>\n" + MAIN,
                ).items()
            },
        },
        ("b/CMakeLists.txt", "add_dependencies(run ${catkin_EXPORTED_TARGETS})", ""),
    ),
    "a package that comes with one that is found": Silent(
        "missing-find-package",
        ("humble",),
        ament(
            "find_package(sensor_msgs REQUIRED)\nadd_executable(run run.cpp)\nament_target_dependencies(run std_msgs)\n"
            + INSTALLED,
            "sensor_msgs",
            "std_msgs",
            run_cpp="#include <std_msgs/msg/header.hpp>\n" + MAIN,
        ),
        ("CMakeLists.txt", "find_package(sensor_msgs REQUIRED)", ""),
    ),
    "a package of one's own": Silent(
        "misspelt-dependency",
        ("jazzy",),
        {**ament("", "exec_depend:python3-seriall"), "rosimpact.toml": '[workspace]\nprivate = ["python3-seriall"]\n'},
        ("rosimpact.toml", "python3-seriall", "python3-other"),
    ),
    "a key under a condition that does not hold": Silent(
        "unresolvable-key",
        ("jazzy",),
        ament("", '<exec_depend condition="$ROS_VERSION == 1">python-serial</exec_depend>'),
        ("package.xml", "$ROS_VERSION == 1", "$ROS_VERSION == 2"),
    ),
    "an unreleased package that the workspace brings": Silent(
        "unreleased-package",
        ("jazzy",),
        {
            "a/package.xml": manifest("exec_depend:audio_capture"),
            "a/CMakeLists.txt": "project(sled)\n",
            "b/package.xml": manifest(name="audio_capture"),
            "b/CMakeLists.txt": "project(audio_capture)\n",
        },
        ("b/package.xml", "<name>audio_capture", "<name>my_audio"),
    ),
    "a cycle that only tests close": Silent(
        "dependency-cycle",
        ("humble",),
        {
            "a/package.xml": manifest("dogs"),
            "a/CMakeLists.txt": "project(sled)\n",
            "b/package.xml": manifest("test_depend:sled", name="dogs"),
            "b/CMakeLists.txt": "project(dogs)\n",
        },
        ("b/package.xml", "test_depend>", "exec_depend>"),
    ),
    "a name that nothing resembles": Silent(
        "misspelt-cmake-name",
        ("jazzy",),
        ament(NODE.format("") + "ament_export_dependencies(fjord)\n" + INSTALLED, "rclcpp", run_cpp=MAIN),
        ("CMakeLists.txt", "(fjord)", "(rclcppp)"),
    ),
    "a standard that CMake raises": Silent(
        "language-standard",
        ("humble", "jazzy"),
        ament("set(CMAKE_CXX_STANDARD 14)\n" + NODE.format("") + INSTALLED, "rclcpp", run_cpp=RCLCPP + MAIN),
        ("CMakeLists.txt", "set(CMAKE_CXX_STANDARD 14)", "add_compile_options(-std=c++14)"),
    ),
    "two versions asked for in turn": Silent(
        "library-version",
        ("melodic", "noetic"),
        catkin(
            "roscpp",
            "find_package(OpenCV 4 QUIET)\nif(NOT OpenCV_FOUND)\n  find_package(OpenCV 3 REQUIRED)\nendif()\n"
            + CATKIN_NODE,
            "roscpp",
            "libopencv-dev",
            run_cpp=MAIN,
        ),
        ("CMakeLists.txt", "find_package(OpenCV 4 QUIET)\n", ""),
    ),
    "a range that reaches far enough": Silent(
        "cmake-version",
        ("humble", "lyrical"),
        {"package.xml": manifest(), "CMakeLists.txt": "cmake_minimum_required(VERSION 3.0...3.22)\nproject(sled)\n"},
        ("CMakeLists.txt", "3.0...3.22", "3.0"),
    ),
    "a bound under a condition that does not hold": Silent(
        "unsatisfied-version",
        ("humble",),
        ament("", '<depend version_gte="2.9.0" condition="$ROS_DISTRO == jazzy">moveit_core</depend>'),
        ("package.xml", "== jazzy", "== humble"),
    ),
    "a module that Python lost, with an except branch": Silent(
        "removed-python-module",
        ("jazzy",),
        ament(
            "install(PROGRAMS run.py DESTINATION lib/${PROJECT_NAME})",
            "exec_depend:rclpy",
            run_py="#!/usr/bin/env python3\nimport rclpy\n"
            "try:\n    import imp\nexcept ImportError:\n    import importlib as imp\n",
        ),
        ("run.py", "try:\n    import imp\nexcept ImportError:\n    import importlib as imp\n", "import imp\n"),
    ),
    "a module that Python lost, under a version test": Silent(
        "removed-python-module",
        ("jazzy",),
        ament(
            "install(PROGRAMS run.py DESTINATION lib/${PROJECT_NAME})",
            "exec_depend:rclpy",
            run_py="#!/usr/bin/env python3\nimport sys\nimport rclpy\nif sys.version_info < (3, 12):\n    import imp\n",
        ),
        ("run.py", "sys.version_info < (3, 12)", "sys.version_info < (3, 13)"),
    ),
    "what C++17 makes without copying it": Silent(
        "changed-signature",
        ("foxy",),
        ament(
            "set(CMAKE_CXX_STANDARD 17)\nfind_package(rclcpp REQUIRED)\nadd_library(sled sled.cpp)\n"
            "ament_target_dependencies(sled rclcpp)\ninstall(TARGETS sled DESTINATION lib)",
            "depend:rclcpp",
            sled_cpp=RCLCPP + "void run() { auto rate = rclcpp::Rate(5.0); rate.sleep(); }\n",
        ),
        ("CMakeLists.txt", "STANDARD 17", "STANDARD 14"),
    ),
    "a message that comes along with one that holds it": Silent(
        "missing-include",
        ("jazzy",),
        ament(
            "find_package(geometry_msgs REQUIRED)\nadd_library(sled sled.cpp)\n"
            "ament_target_dependencies(sled geometry_msgs)\ninstall(TARGETS sled DESTINATION lib)",
            "depend:geometry_msgs",
            sled_cpp="#include <geometry_msgs/msg/pose_stamped.hpp>\ngeometry_msgs::msg::Pose here();\n",
        ),
        ("sled.cpp", "pose_stamped", "vector3_stamped"),
    ),
    "a message that comes along with one of the workspace": Silent(
        "missing-include",
        ("jazzy",),
        ament(
            "find_package(rosidl_default_generators REQUIRED)\nfind_package(geometry_msgs REQUIRED)\n"
            "rosidl_generate_interfaces(sled msg/Tracks.msg DEPENDENCIES geometry_msgs)\n"
            "add_library(sledding sled.cpp)\nament_target_dependencies(sledding geometry_msgs)\n"
            'rosidl_get_typesupport_target(cpp sled "rosidl_typesupport_cpp")\ntarget_link_libraries(sledding ${cpp})\n'
            "install(TARGETS sledding DESTINATION lib)",
            "buildtool_depend:rosidl_default_generators",
            "depend:geometry_msgs",
            "exec_depend:rosidl_default_runtime",
            "member_of_group:rosidl_interface_packages",
            msg__Tracks_msg="geometry_msgs/Pose[] poses\n",
            sled_cpp="#include <sled/msg/tracks.hpp>\ngeometry_msgs::msg::Pose here();\n",
        ),
        ("msg/Tracks.msg", "geometry_msgs/Pose[] poses", "float64 length"),
    ),
    "a name that comes along under the C++ standard that is set": Silent(
        "missing-standard-include",
        ("jazzy",),
        ament(
            "set(CMAKE_CXX_STANDARD 20)\nadd_library(sled sled.cpp)\ninstall(TARGETS sled DESTINATION lib)",
            sled_cpp="#include <memory>\nuint8_t length(const std::string & s) { return s.size(); }\n",
        ),
        ("CMakeLists.txt", "STANDARD 20", "STANDARD 17"),
    ),
    "a macro that the file defines where nothing else does": Silent(
        "missing-standard-include",
        ("jazzy",),
        ament(
            "find_package(PCL REQUIRED)\nadd_library(sled sled.cpp)\n"
            "target_include_directories(sled PRIVATE ${PCL_INCLUDE_DIRS})\n"
            "target_link_libraries(sled ${PCL_LIBRARIES})\ninstall(TARGETS sled DESTINATION lib)",
            "depend:libpcl-all-dev",
            sled_cpp="#include <pcl/filters/voxel_grid.h>\n#ifndef FLT_MAX\n#define FLT_MAX 3.4e38F\n#endif\n"
            "float far() { return FLT_MAX; }\n",
        ),
        ("sled.cpp", "#define FLT_MAX 3.4e38F", "#define FAR 3.4e38F"),
    ),
    "a header that only a program of tests compiles": Silent(
        "missing-standard-include",
        ("jazzy",),
        ament(
            "add_executable(slide test/slide.cpp)\ninstall(DIRECTORY include/ DESTINATION include)\n"
            "install(TARGETS slide DESTINATION lib/${PROJECT_NAME})\n"
            "target_include_directories(slide PRIVATE include)",
            include__sled__sled_hpp="#pragma once\n#include <vector>\nstd::vector<std::map<int, int>> all();\n",
            test__slide_cpp="#include <map>\n#include <sled/sled.hpp>\nint main() { return 0; }\n",
        ),
        ("test/slide.cpp", "#include <map>\n", ""),
    ),
    "a header of the compiler that the source includes first": Silent(
        "missing-standard-include",
        ("jazzy",),
        ament(
            "find_package(PCL REQUIRED)\nadd_library(sled sled.cpp)\n"
            "target_include_directories(sled PRIVATE ${PCL_INCLUDE_DIRS})\n"
            "target_link_libraries(sled ${PCL_LIBRARIES})\ninstall(TARGETS sled DESTINATION lib)",
            "depend:libpcl-all-dev",
            sled_hpp="#pragma once\ninline float find_most() { return FLT_MAX; }\n",
            sled_cpp='#include <float.h>\n#include <pcl/filters/voxel_grid.h>\n#include "sled.hpp"\n',
        ),
        ("sled.cpp", "#include <float.h>\n", ""),
    ),
    "a header that comes through the package's own": Silent(
        "missing-standard-include",
        ("jazzy",),
        ament(
            "add_library(sled sled.cpp)\ninstall(TARGETS sled DESTINATION lib)",
            sled_hpp="#pragma once\n#include <cstdint>\n",
            sled_cpp='#include "sled.hpp"\n#include <string>\n'
            "uint32_t length(const std::string & s) { return s.size(); }\n",
        ),
        ("sled.cpp", '#include "sled.hpp"\n', ""),
    ),
    "a header whose need its source includes first": Silent(
        "missing-include",
        ("jazzy",),
        ament(
            "find_package(tf2_ros REQUIRED)\nadd_library(sled sled.cpp)\nament_target_dependencies(sled tf2_ros)\n"
            "install(TARGETS sled DESTINATION lib)",
            "depend:tf2_ros",
            sled_hpp="#pragma once\n#include <tf2_ros/transform_listener.h>\ntf2_ros::Buffer & frames();\n",
            sled_cpp='#include <tf2_ros/buffer.h>\n#include "sled.hpp"\n',
        ),
        ("sled.cpp", "#include <tf2_ros/buffer.h>\n", ""),
    ),
    "a conversion of the package's own": Silent(
        "missing-include",
        ("jazzy",),
        ament(
            "find_package(tf2 REQUIRED)\nadd_library(sled sled.cpp)\nament_target_dependencies(sled tf2)\n"
            "install(TARGETS sled DESTINATION lib)",
            "depend:tf2",
            sled_cpp="#include <tf2/utils.h>\nstruct Pose {};\n"
            "namespace tf2 {\nPose toMsg(const Transform &) { return {}; }\n}\n"
            "Pose here(const tf2::Transform & at) { return tf2::toMsg(at); }\n",
        ),
        ("sled.cpp", "namespace tf2 {\nPose toMsg(const Transform &) { return {}; }\n}\n", ""),
    ),
    "a type that the package announces itself": Silent(
        "missing-include",
        ("jazzy",),
        ament(
            "find_package(tf2_ros REQUIRED)\nadd_library(sled sled.cpp)\nament_target_dependencies(sled tf2_ros)\n"
            "install(TARGETS sled DESTINATION lib)",
            "depend:tf2_ros",
            sled_cpp="#include <tf2_ros/transform_listener.h>\nnamespace tf2_ros { class Buffer; }\n"
            "tf2_ros::Buffer * frames() { return nullptr; }\n",
        ),
        ("sled.cpp", "namespace tf2_ros { class Buffer; }\n", ""),
    ),
    "a comment that silences a finding": Silent(
        "removed-header",
        ("jazzy",),
        ament(
            TF2, "rclcpp", "tf2_geometry_msgs", run_cpp=H.rstrip() + "  // rosimpact: allow(removed-header)\n" + MAIN
        ),
        ("run.cpp", "  // rosimpact: allow(removed-header)", ""),
    ),
    "a package of CATKIN_DEPENDS that is built and run with": Silent(
        "catkin-depends",
        ("melodic", "noetic"),
        catkin("roscpp tf", "catkin_package(CATKIN_DEPENDS roscpp tf)", "roscpp", "tf"),
        ("package.xml", "<depend>tf</depend>", "<exec_depend>tf</exec_depend>"),
    ),
    "a plain CMake package among the system's": Silent(
        "catkin-depends",
        ("melodic",),
        catkin(
            "roscpp",
            "find_package(orocos_kdl REQUIRED)\ncatkin_package(CATKIN_DEPENDS roscpp DEPENDS orocos_kdl)",
            "roscpp",
            "orocos_kdl",
        ),
        ("CMakeLists.txt", "roscpp DEPENDS orocos_kdl", "roscpp orocos_kdl"),
    ),
    "a system library that is no component of catkin": Silent(
        "missing-find-package",
        ("noetic",),
        catkin("roscpp", "find_package(yaml-cpp REQUIRED)\ncatkin_package()", "roscpp", "yaml-cpp"),
        ("CMakeLists.txt", "COMPONENTS roscpp", "COMPONENTS roscpp yaml-cpp"),
    ),
    "a library that its vendor package no longer finds": Silent(
        "missing-find-package",
        ("jazzy",),
        ament(
            "find_package(yaml_cpp_vendor REQUIRED)\nfind_package(yaml-cpp REQUIRED)\nadd_executable(run run.cpp)\n"
            "target_link_libraries(run yaml-cpp::yaml-cpp)\n" + INSTALLED,
            "yaml_cpp_vendor",
            run_cpp="#include <yaml-cpp/yaml.h>\n" + MAIN,
        ),
        (
            "CMakeLists.txt",
            "find_package(yaml-cpp REQUIRED)\nadd_executable(run run.cpp)\n"
            "target_link_libraries(run yaml-cpp::yaml-cpp)",
            "add_executable(run run.cpp)\nament_target_dependencies(run yaml_cpp_vendor)",
        ),
    ),
    "a library's variables that pkg-config sets": Silent(
        "missing-find-package",
        ("jazzy",),
        ament(
            "find_package(PkgConfig REQUIRED)\npkg_check_modules(avcodec REQUIRED libavcodec)\n"
            "add_executable(run run.cpp)\ntarget_link_libraries(run ${avcodec_LIBRARIES})\n" + INSTALLED,
            "ffmpeg",
            run_cpp=MAIN,
        ),
        ("CMakeLists.txt", "pkg_check_modules(avcodec REQUIRED libavcodec)", ""),
    ),
    "a prefix before REQUIRED": Silent(
        "missing-find-package",
        ("noetic",),
        catkin(
            "roscpp",
            "find_package(PkgConfig REQUIRED)\npkg_check_modules(YAML REQUIRED yaml-cpp)\ncatkin_package()",
            "roscpp",
            "yaml-cpp",
        ),
        ("CMakeLists.txt", "YAML REQUIRED", "REQUIRED"),
    ),
    "a package that is found for more than the tests": Silent(
        "missing-find-package",
        ("noetic",),
        catkin(
            "roscpp",
            "find_package(catkin REQUIRED COMPONENTS angles)\nif(CATKIN_ENABLE_TESTING)\nendif()\n"
            + CATKIN_NODE
            + "target_link_libraries(run ${catkin_LIBRARIES})\n"
            "install(TARGETS run RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})",
            "roscpp",
            "angles",
            run_cpp="#include <angles/angles.h>\n#include <ros/ros.h>\n" + MAIN,
        ),
        (
            "CMakeLists.txt",
            "find_package(catkin REQUIRED COMPONENTS angles)\nif(CATKIN_ENABLE_TESTING)\n",
            "if(CATKIN_ENABLE_TESTING)\nfind_package(catkin REQUIRED COMPONENTS angles)\n",
        ),
    ),
    "a program that is linked to its client library": Silent(
        "missing-find-package",
        ("noetic",),
        catkin(
            "roscpp",
            CATKIN_NODE + "target_link_libraries(run ${catkin_LIBRARIES})\n"
            "install(TARGETS run RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})",
            "roscpp",
            run_cpp='#include <ros/ros.h>\nint main(int c, char** v) { ros::init(c, v, "run"); }\n',
        ),
        ("CMakeLists.txt", "target_link_libraries(run ${catkin_LIBRARIES})", ""),
    ),
    "the include folder of ROS under a component's name": Silent(
        "missing-find-package",
        ("noetic",),
        catkin(
            "roscpp",
            "catkin_package()\ninclude_directories(${roscpp_INCLUDE_DIRS})\nadd_executable(run run.cpp)\n"
            "target_link_libraries(run ${catkin_LIBRARIES})\n"
            "install(TARGETS run RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})",
            "roscpp",
            run_cpp="#include <ros/ros.h>\n" + MAIN,
        ),
        ("CMakeLists.txt", "include_directories(${roscpp_INCLUDE_DIRS})", ""),
    ),
    "a find_package name in its own case": Silent(
        "misspelt-cmake-name",
        ("noetic",),
        catkin(
            "roscpp", "find_package(GeographicLib)\nfind_package(ZLIB REQUIRED)\ncatkin_package()", "roscpp", "zlib"
        ),
        ("CMakeLists.txt", "ZLIB", "Zlib"),
    ),
    "a Boost component that the program is linked to": Silent(
        "library-component",
        ("jazzy",),
        ament(
            "find_package(Boost REQUIRED COMPONENTS program_options)\nadd_executable(run run.cpp)\n"
            "target_link_libraries(run Boost::program_options)\n" + INSTALLED,
            "boost",
            run_cpp="#include <boost/program_options.hpp>\nboost::program_options::variables_map given;\n" + MAIN,
        ),
        ("CMakeLists.txt", "target_link_libraries(run Boost::program_options)\n", ""),
    ),
    "a Boost component that comes with a library of the package": Silent(
        "library-component",
        ("jazzy",),
        ament(
            "find_package(Boost REQUIRED COMPONENTS filesystem)\nadd_library(sled sled.cpp)\n"
            "target_link_libraries(sled PUBLIC ${Boost_LIBRARIES})\nadd_executable(run run.cpp)\n"
            "target_link_libraries(run PRIVATE sled)\ninstall(TARGETS sled DESTINATION lib)\n" + INSTALLED,
            "boost",
            run_cpp="#include <boost/filesystem.hpp>\nboost::filesystem::path place;\n" + MAIN,
            sled_cpp="int sled() { return 0; }\n",
        ),
        ("CMakeLists.txt", "target_link_libraries(run PRIVATE sled)", ""),
    ),
    "a compiled library that each program is linked to": Silent(
        "library-component",
        ("jazzy",),
        ament(
            "find_package(yaml-cpp REQUIRED)\nadd_executable(run run.cpp)\nadd_executable(walk run.cpp)\n"
            "target_link_libraries(run yaml-cpp::yaml-cpp)\ntarget_link_libraries(walk yaml-cpp)\n"
            "install(TARGETS run walk DESTINATION lib/${PROJECT_NAME})",
            "yaml-cpp",
            run_cpp='#include <yaml-cpp/yaml.h>\nint main() { return YAML::LoadFile("a.yaml").size(); }\n',
        ),
        ("CMakeLists.txt", "target_link_libraries(walk yaml-cpp)\n", ""),
    ),
    "a standard header of the standard that is set": Silent(
        "language-standard",
        ("kinetic",),
        catkin(
            "roscpp",
            "add_compile_options(-std=c++11)\n" + CATKIN_NODE + "target_link_libraries(run ${catkin_LIBRARIES})\n"
            "install(TARGETS run RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})",
            "roscpp",
            run_cpp="#include <mutex>\n#include <ros/ros.h>\n" + MAIN,
        ),
        ("CMakeLists.txt", "add_compile_options(-std=c++11)\n", ""),
    ),
    "a flag for the standard that linked targets ask for": Silent(
        "language-standard",
        ("jazzy",),
        ament(
            'set(CMAKE_CXX_FLAGS "${CMAKE_CXX_FLAGS} -std=c++17")\n' + NODE.format("") + INSTALLED,
            "rclcpp",
            run_cpp=RCLCPP + MAIN,
        ),
        ("CMakeLists.txt", "-std=c++17", "-std=c++14"),
    ),
    "a lower CMAKE_CXX_STANDARD, which CMake raises": Silent(
        "language-standard",
        ("jazzy",),
        ament(
            "set(CMAKE_CXX_STANDARD 14)\n" + NODE.format("") + INSTALLED,
            "rclcpp",
            run_cpp=RCLCPP + MAIN,
        ),
        ("CMakeLists.txt", "set(CMAKE_CXX_STANDARD 14)", "add_compile_options(-std=c++14)"),
    ),
    "a linked target that may ask for a higher standard": Silent(
        "changed-signature",
        ("melodic",),
        catkin(
            "roscpp",
            "set(CMAKE_CXX_STANDARD 11)\nfind_package(barometer REQUIRED)\n"
            + CATKIN_NODE
            + "target_link_libraries(run ${catkin_LIBRARIES} barometer::core)",
            "roscpp",
            run_cpp="#include <memory>\nint main() { return *std::make_unique<int>(0); }\n",
        ),
        ("CMakeLists.txt", "barometer::core", "barometer"),
    ),
    "a command that a private package may find along": Silent(
        "unfound-command",
        ("humble",),
        {
            "package.xml": manifest(),
            "CMakeLists.txt": HEAD + "find_package(our_build_tools REQUIRED)\nament_package()\n",
        },
        ("CMakeLists.txt", "find_package(our_build_tools REQUIRED)\n", ""),
    ),
    "a command of a package that a variable names": Silent(
        "unfound-command",
        ("humble",),
        {
            "package.xml": manifest(),
            "CMakeLists.txt": HEAD + "find_package($ENV{BUILD_TOOL} REQUIRED)\nament_package()\n",
        },
        ("CMakeLists.txt", "find_package($ENV{BUILD_TOOL} REQUIRED)\n", ""),
    ),
    "a variable that a package which is found may set": Silent(
        "misspelt-cmake-variable",
        ("jazzy",),
        ament(
            "find_package(sledge REQUIRED)\n" + NAMED_TARGET,
            run_cpp=MAIN,
        ),
        ("CMakeLists.txt", "find_package(sledge REQUIRED)\n", ""),
    ),
    "a variable that a script outside the tree may set": Silent(
        "misspelt-cmake-variable",
        ("jazzy",),
        ament(
            "include(${OUR_TOOLS}/names.cmake)\n" + NAMED_TARGET,
            run_cpp=MAIN,
        ),
        ("CMakeLists.txt", "include(${OUR_TOOLS}/names.cmake)\n", ""),
    ),
    "a library that nobody knows": Silent(
        "undeclared-package",
        ("humble",),
        ament("find_package(OurFingers REQUIRED)"),
        ("CMakeLists.txt", "OurFingers", "our_fingers"),
    ),
    "a target that catkin makes for a test, called after its file": Silent(
        "nonexistent-target",
        ("noetic",),
        catkin(
            "",
            "catkin_package()\nadd_library(sled look.cpp)\n"
            "if(CATKIN_ENABLE_TESTING)\n  find_package(rostest REQUIRED)\n  add_rostest(test/play.xml)\n"
            "  add_dependencies(run_tests_sled_rostest_test_play.xml sled)\nendif()",
            "test_depend:rostest",
            look_cpp="int look() { return 0; }\n",
            test__play_xml="<launch/>\n",
        ),
        ("CMakeLists.txt", "run_tests_sled_rostest_test_play.xml", "tests_of_sled"),
    ),
    "a package that nobody knows, of whose interfaces the sources include": Silent(
        "misspelt-cmake-name",
        ("humble",),
        {
            "sledge_msgs/package.xml": manifest(name="sledge_msgs"),
            "sledge_msgs/CMakeLists.txt": HEAD.replace("sled", "sledge_msgs")
            + "find_package(ament_cmake REQUIRED)\nament_package()\n",
            "sled/package.xml": manifest("sledge_msgs"),
            "sled/CMakeLists.txt": f"{HEAD}find_package(ament_cmake REQUIRED)\nfind_package(sledg_msgs REQUIRED)\n"
            "add_executable(run run.cpp)\nament_target_dependencies(run sledg_msgs)\nament_package()\n",
            "sled/run.cpp": "#include <sledg_msgs/msg/load.hpp>\nint main() { return 0; }\n",
        },
        ("sled/run.cpp", "sledg_msgs", "sledge_msgs"),
    ),
    "files that only the other generation gives to its generator": Silent(
        "unlisted-field-package",
        ("jazzy",),
        {
            "package.xml": manifest("std_msgs", "geometry_msgs", "buildtool_depend:rosidl_default_generators"),
            "CMakeLists.txt": HEAD + 'if("$ENV{ROS_VERSION}" STREQUAL "2")\n  set(DETECTED_ROS2 TRUE)\nelse()\n'
            "  set(DETECTED_ROS1 TRUE)\nendif()\nif(DETECTED_ROS1)\n"
            "  find_package(catkin REQUIRED COMPONENTS message_generation std_msgs)\n"
            "  add_message_files(DIRECTORY msg-ros1 FILES Load.msg)\n  generate_messages(DEPENDENCIES std_msgs)\n"
            "  catkin_package()\nendif()\nif(DETECTED_ROS2)\n  find_package(ament_cmake REQUIRED)\n"
            "  find_package(std_msgs REQUIRED)\n  find_package(rosidl_default_generators REQUIRED)\n"
            '  rosidl_generate_interfaces(sled "msg-ros2/Load.msg" DEPENDENCIES std_msgs)\n  ament_package()\n'
            "endif()\n",
            "msg-ros1/Load.msg": "Header header\nfloat64 mass\n",
            "msg-ros2/Load.msg": "std_msgs/Header header\nfloat64 mass\n",
        },
        ("msg-ros2/Load.msg", "std_msgs/Header header", "geometry_msgs/Pose pose"),
    ),
    "a folder without CMakeLists.txt, which old policies ignore": Silent(
        "nonexistent-path",
        ("kinetic",),
        {
            "package.xml": manifest(tool="catkin", version=2),
            "CMakeLists.txt": "cmake_minimum_required(VERSION 2.4)\nproject(sled)\nfind_package(catkin REQUIRED)\n"
            "catkin_package()\nadd_subdirectory(test)\n",
            "test/drive.txt": "\n",
        },
        ("CMakeLists.txt", "VERSION 2.4", "VERSION 2.8.3"),
    ),
    "a library that a command makes in the devel space": Silent(
        "nonexistent-export",
        ("melodic",),
        {
            "package.xml": manifest(tool="catkin", version=2),
            "CMakeLists.txt": f"{HEAD}find_package(catkin REQUIRED)\n"
            "add_custom_command(OUTPUT ${CATKIN_DEVEL_PREFIX}/lib/librunner.so COMMAND make -f Makefile.runner)\n"
            "add_custom_target(make_runner ALL DEPENDS ${CATKIN_DEVEL_PREFIX}/lib/librunner.so)\n"
            "catkin_package(LIBRARIES runner)\n",
        },
        ("CMakeLists.txt", "lib/librunner.so", "lib/librail.so"),
    ),
    "the body of a class that derives from one whose constructor changed": Silent(
        "changed-signature",
        ("melodic",),
        catkin(
            "",
            "find_package(OpenCV REQUIRED)\ncatkin_package()\nadd_executable(look look.cpp)\n"
            "target_link_libraries(look ${OpenCV_LIBS})",
            "libopencv-dev",
            look_cpp="#include <opencv2/features2d.hpp>\nclass Blobs : public cv::SimpleBlobDetector\n{\npublic:\n"
            "  Blobs(const cv::SimpleBlobDetector::Params & given);\n};\nint main()\n{\n"
            "  cv::SimpleBlobDetector::Params given;\n  return 0;\n}\n",
        ),
        ("look.cpp", "  return 0;", "  cv::SimpleBlobDetector blobs(given);\n  return 0;"),
    ),
    "a module that a command for a shell writes into the package": Silent(
        "undefined-name",
        ("jazzy",),
        {
            **ament(
                'add_custom_target(make_schemas ALL COMMAND eval "python3 make.py '
                '--output ${CMAKE_CURRENT_LIST_DIR}/sled/schemas.py")\n'
                "find_package(ament_cmake_python REQUIRED)\nament_python_install_package(${PROJECT_NAME})\n"
                "install(PROGRAMS scripts/tell.py DESTINATION lib/sled)",
                "buildtool_depend:ament_cmake_python",
            ),
            "sled/__init__.py": "",
            "scripts/tell.py": "from sled import schemas\n\nprint(schemas)\n",
        },
        ("CMakeLists.txt", "sled/schemas.py", "sled/models.py"),
    ),
    "a module by its path, where the program adds a folder to the path": Silent(
        "undefined-name",
        ("noetic",),
        add_programs(
            lift='import sys\n\nsys.path.append("/opt/sled")\n'
            "from packages.sled.scripts.parts.hook import WIDTH\n\nprint(WIDTH)\n",
        ),
        ("packages/sled/scripts/lift.py", 'sys.path.append("/opt/sled")', "print(sys.argv)"),
    ),
    "a module by its path, in a tool that is started at the top of the repository": Silent(
        "undefined-name",
        ("noetic",),
        add_programs(
            lift="import rospy\nfrom parts.hook import WIDTH\n\nprint(WIDTH)\n",
            draw="from packages.sled.scripts.parts.hook import WIDTH\n\nprint(WIDTH)\n",
        ),
        ("packages/sled/scripts/lift.py", "parts.hook", "packages.sled.scripts.parts.hook"),
    ),
}


@pytest.mark.parametrize("row", SILENT.values(), ids=SILENT)
def test_what_is_left_alone(row: Silent, cache: Path):
    def reports(files: Files) -> bool:
        """Whether the rule reports something, for most rules above a note."""
        options = Options(targets=row.targets, preview=True, cache=cache, select=(row.rule,))
        quiet = () if load_rules()[row.rule].severity == "note" else ("note",)
        return any(finding.severity not in quiet for finding in rule_cases.check_files(files, options).findings)

    assert not reports(row.files)
    path, old, new = row.spoilt
    assert row.files[path].count(old) >= 1
    assert reports({**row.files, path: row.files[path].replace(old, new)})


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_where_nothing_changed_nothing_is_new(case: Case, cache: Path):
    report = rule_cases.check_files(case.files, Options(targets=case.targets, preview=True, cache=cache), case.files)
    comparing = rule_cases.rules_that_compare()
    assert [f for f in report.findings if f.new or f.rule in comparing] == []


def test_a_commit_without_changes_does_not_fail(tmp_path: Path, cache: Path):
    for name, text in SILENT["a header chosen by a version"].files.items():
        (tmp_path / name).write_text(text.replace("#if RCLCPP_VERSION_GTE(28, 0, 0)", "#if 0"))
    git = ["git", "-C", str(tmp_path), "-c", "user.name=r", "-c", "user.email=r@example.org"]
    for command in (["init", "-q"], ["add", "."], ["commit", "-q", "-m", "first"]):
        subprocess.run([*git, *command], check=True)
    command = ["check", str(tmp_path), "--target", "jazzy", "--quiet"]
    environment = {"ROSIMPACT_CACHE": str(cache)}
    assert CliRunner().invoke(app, command, env=environment).exit_code == 1
    assert CliRunner().invoke(app, [*command, "--base", "HEAD"], env=environment).exit_code == 0


@pytest.mark.parametrize(("module", "severity"), [("distutils.version", "warning"), ("imp", "error")])
def test_distutils_is_brought_back_by_setuptools(module, severity, tmp_path, cache):
    files = ament(
        "install(PROGRAMS run.py DESTINATION lib/${PROJECT_NAME})",
        "exec_depend:rclpy",
        run_py=f"#!/usr/bin/env python3\nimport {module}\nimport rclpy\n",
    )
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    report = check(tmp_path, Options(targets=("jazzy",), cache=cache, jobs=1))
    found = [(f.severity, f.subject) for f in report.findings if f.rule == "removed-python-module"]
    assert found == [(severity, module)]


@pytest.mark.parametrize(
    ("folder", "expected"),
    [
        ("external/cv_bridge", []),
        ("external/vision_opencv", []),  # the repository that releases cv_bridge
        ("external/vision", ["error"]),
    ],
)
def test_a_submodule_that_is_not_checked_out_has_the_package_that_it_is_called_after(folder, expected, tmp_path):
    files = ament(
        "find_package(cv_bridge REQUIRED)\nadd_executable(look look.cpp)\n"
        "target_link_libraries(look cv_bridge::cv_bridge)",
        "cv_bridge",
        look_cpp="#include <cv_bridge/cv_bridge.h>\nint main() { return 0; }\n",
    )
    files[".gitmodules"] = f'[submodule "bridge"]\n\tpath = {folder}\n\turl = https://example.org/b.git\n'
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    report = check(tmp_path, Options(targets=("jazzy",), cache=tmp_path / "cache", jobs=1))
    assert [finding.severity for finding in report.findings if finding.rule == "removed-header"] == expected


@pytest.mark.parametrize(("folder", "expected"), [("external/audio", []), ("external/vision", ["warning"])])
def test_a_submodule_that_is_not_checked_out_has_packages_that_are_called_after_it(folder, expected, tmp_path):
    files = ament("", "exec_depend:audio_capture")
    files[".gitmodules"] = f'[submodule "bridge"]\n\tpath = {folder}\n\turl = https://example.org/b.git\n'
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    report = check(tmp_path, Options(targets=("jazzy",), cache=tmp_path / "cache", jobs=1))
    assert [finding.severity for finding in report.findings if finding.rule == "unreleased-package"] == expected


@pytest.mark.parametrize(
    ("folder", "declared", "expected"),
    [("docs", "", ["error"]), ("p/third_party", "", []), ("external/audio", "audio", [])],
)
def test_own_headers_may_lie_in_a_folder_that_was_not_read(folder, declared, expected, tmp_path):
    code = '#include "boom/lift.h"\nint main() { return 0; }\n'
    files = {f"p/{name}": text for name, text in ament("add_executable(m m.cpp)", declared, m_cpp=code).items()}
    files |= {"p/include/boom/lift.h": "", ".gitmodules": f'[submodule "s"]\n\tpath = {folder}\n\turl = s.git\n'}
    rule_cases.write_files(tmp_path, files)
    report = check(tmp_path, Options(targets=("jazzy",), cache=tmp_path / "cache", jobs=1))
    assert [finding.severity for finding in report.findings if finding.rule == "unsearched-header"] == expected


@pytest.mark.parametrize(("folder", "expected"), [("sdk", []), ("sdk/inner", []), ("docs", ["warning"])])
def test_cmake_does_not_stop_for_what_a_submodule_that_is_not_checked_out_may_have(folder, expected, tmp_path):
    stop = "if(NOT EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/sdk/inner/lift.h)\n  message(FATAL_ERROR \"fetch it\")\nendif()\n"
    files = catkin("roscpp", stop + "catkin_package()", "roscpp")
    files |= {".gitmodules": f'[submodule "s"]\n\tpath = {folder}\n\turl = s.git\n'}
    rule_cases.write_files(tmp_path, files)
    report = check(tmp_path, Options(targets=("noetic",), cache=tmp_path / "cache", jobs=1))
    assert [finding.severity for finding in report.findings if finding.rule == "missing-package-call"] == expected


@pytest.mark.parametrize(("before", "expected"), [(True, []), (False, ["warning"])])
def test_cmake_does_not_stop_for_what_a_program_that_it_runs_before_may_write(before, expected, tmp_path):
    run = "execute_process(COMMAND bash -c ${CMAKE_CURRENT_SOURCE_DIR}/fetch.sh)\n"
    stop = 'if(NOT EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/sdk/lift.h)\n  message(FATAL_ERROR "fetch it")\nendif()\n'
    body = run + stop if before else stop + run
    rule_cases.write_files(tmp_path, {**catkin("roscpp", body + "catkin_package()", "roscpp"), "fetch.sh": ""})
    report = check(tmp_path, Options(targets=("noetic",), cache=tmp_path / "cache", jobs=1))
    assert [finding.severity for finding in report.findings if finding.rule == "missing-package-call"] == expected


@pytest.mark.parametrize(("run", "expected"), [("git clone https://example.org/x FFmpeg", "warning"), ("", "error")])
def test_a_program_that_cmake_runs_may_fetch_the_headers_of_a_folder_that_is_searched(run, expected, tmp_path):
    body = f"execute_process(COMMAND {run})\n" if run else ""
    body += "include_directories(FFmpeg)\nadd_executable(m m.cpp)\ninstall(TARGETS m DESTINATION lib/${PROJECT_NAME})"
    files = ament(body, m_cpp="#include <libavcodec/avcodec.h>\nint main() { return 0; }\n")
    rule_cases.write_files(tmp_path, files)
    report = check(tmp_path, Options(targets=("jazzy",), cache=tmp_path / "cache", jobs=1))
    found = [finding for finding in report.findings if finding.subject in ("ffmpeg", "libavcodec-dev")]
    assert [finding.severity for finding in found] == [expected], report.findings


@pytest.mark.parametrize(("ignored", "expected"), [("made.cmake", []), ("other.cmake", ["error"])])
def test_cmake_may_include_what_git_ignores(ignored, expected, tmp_path):
    rule_cases.write_files(tmp_path, {**ament("include(made.cmake)"), ".gitignore": f"{ignored}\n"})
    report = check(tmp_path, Options(targets=("jazzy",), preview=True, cache=tmp_path / "cache", jobs=1))
    assert [finding.severity for finding in report.findings if finding.rule == "nonexistent-path"] == expected


@pytest.mark.parametrize(("folder", "expected"), [("audio_common", []), ("audio", ["warning"])])
def test_launch_files_start_what_a_submodule_that_is_not_checked_out_may_have(folder, expected, tmp_path):
    launch = '<launch><node pkg="sound_play" exec="soundplay_node.py"/></launch>'
    files = ament("install(FILES a.launch.xml DESTINATION share/${PROJECT_NAME})", a_launch_xml=launch)
    files[".gitmodules"] = f'[submodule "sound"]\n\tpath = {folder}\n\turl = https://example.org/s.git\n'
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    report = check(tmp_path, Options(targets=("dashing",), cache=tmp_path / "cache", jobs=1))
    assert [finding.severity for finding in report.findings if finding.rule == "removed-executable"] == expected


@pytest.mark.parametrize("folder", ["external/our_gimbal", "external/drivers"])
def test_a_submodule_that_is_not_checked_out_may_have_a_package_that_nobody_knows(folder, tmp_path):
    files = ament("find_package(our_gimbal_msgs REQUIRED)", "our_gimbal_msgs")
    files[".gitmodules"] = f'[submodule "ours"]\n\tpath = {folder}\n\turl = https://example.org/b.git\n'
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    report = check(tmp_path, Options(targets=("jazzy",), cache=tmp_path / "cache", jobs=1))
    (finding,) = (one for one in report.findings if one.rule == "unknown-dependency")
    assert finding.severity == "note"
    assert finding.message.endswith(f"may be in a submodule that was not read: `{folder}`")
