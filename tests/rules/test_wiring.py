"""What manifests, generators, install rules and exports must tell: each row is a workspace on which a rule is content,
and the small change behind which it speaks.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest
import rule_cases
from rosimpact.impact.analysis.session import Options

Files = dict[str, str]
Said = Callable[[Files, str, str], list[tuple[str, str]]]


class Row(NamedTuple):
    """rule: its name. target: a distro. files: the workspace. spoilt: path, old, new text. told: what is then said, as
    (severity, subject)."""

    rule: str
    target: str
    files: Files
    spoilt: tuple[str, str, str]
    told: tuple[str, str]


def manifest(name: str, *lines: str, tool: str = "ament_cmake", export: str = "") -> str:
    """A manifest of format 2 whose lines are `name` for a depend, or `tag:name`."""
    pairs = [line.split(":") if ":" in line else ["depend", line] for line in (f"buildtool_depend:{tool}", *lines)]
    elements = "\n".join(f"<{tag}>{text}</{tag}>" for tag, text in pairs)
    return (
        f'<?xml version="1.0"?>\n<package format="2">\n<name>{name}</name>\n<version>1.0.0</version>\n'
        f'<description>{name}</description>\n<maintainer email="robots@example.org">Robots</maintainer>\n'
        f"<license>Apache-2.0</license>\n{elements}\n<export>{export}</export>\n</package>\n"
    )


def ament(name: str, cmake: str, *lines: str, **sources: str) -> Files:
    """A package for colcon in a folder of its name. sources: text by path, `__` for a slash and `_` for the dot."""
    text = f"cmake_minimum_required(VERSION 3.8)\nproject({name})\nfind_package(ament_cmake REQUIRED)\n{cmake}\n"
    return _package(name, manifest(name, *lines), text + "ament_package()\n", sources)


def catkin(name: str, components: str, cmake: str, *lines: str, **sources: str) -> Files:
    """The same for catkin."""
    text = (
        f"cmake_minimum_required(VERSION 3.0.2)\nproject({name})\nfind_package(catkin REQUIRED {components})\n{cmake}\n"
    )
    return _package(name, manifest(name, *lines, tool="catkin"), text, sources)


def _package(name: str, xml: str, cmake: str, sources: Files) -> Files:
    named = {path.replace("__", "/").replace("_", "."): text for path, text in sources.items()}
    return {f"{name}/{path}": text for path, text in {"package.xml": xml, "CMakeLists.txt": cmake, **named}.items()}


MAIN = "int main() { return 0; }\n"
LIBRARY = "add_library(sled sled.cpp)\ninstall(TARGETS sled EXPORT sled DESTINATION lib)\n"
HEADERS = "install(DIRECTORY include/ DESTINATION include)\n"
ANGLES = "#include <angles/angles.h>\n"
FLOE = {"sled/msg/Floe.msg": "float64 size\n"}
GENERATED = "add_message_files(FILES Floe.msg)\ngenerate_messages()\ncatkin_package(CATKIN_DEPENDS message_runtime)\n"
LAUNCH = (
    '<launch>\n<arg name="remote" default="false"/>\n<group if="$(arg remote)">\n'
    '<node pkg="rosbridge_server" type="rosbridge_websocket" name="bridge"/>\n</group>\n</launch>\n'
)
PLACES = "catkin_package()\ninstall(FILES ${CATKIN_DEVEL_PREFIX}/etc/sled.conf DESTINATION etc)\n"
TESTED = (
    "if(BUILD_TESTING)\n  find_package(ament_lint_auto REQUIRED)\n  ament_lint_auto_find_test_dependencies()\n"
    "  ament_add_gtest(probe test/probe.cpp)\nendif()\n"
)
PACK = {path: text for name in ("husky", "malamute", "samoyed") for path, text in {**ament(name, "", "rclcpp")}.items()}
TEAM = {**PACK, **ament("team", "", "exec_depend:husky", "exec_depend:malamute", "exec_depend:samoyed")}
TEAM["team/package.xml"] = TEAM["team/package.xml"].replace("<export>", "<export><metapackage/>")

BUNDLE = ament("kit", "", "exec_depend:ament_cmake_cpplint")
VENDOR = (
    "include(ExternalProject)\nExternalProject_Add(ice GIT_REPOSITORY https://example.org/ice.git\n"
    "  PATCH_COMMAND patch -p1 UPDATE_COMMAND \"\")\n"
)
NODE = {"sled/sled/__init__.py": "", "sled/sled/node.py": "import yaml\n"}
MODULE = "find_package(ament_cmake_python REQUIRED)\nament_python_install_package(sled)\n"

ROWS = {
    "an import at run time, brought by a test tool": Row(
        "undeclared-package",
        "humble",
        {
            **ament("sled", MODULE, "buildtool_depend:ament_cmake_python", "test_depend:launch_testing",
                    "exec_depend:python3-yaml"),
            **NODE,
        },
        ("sled/package.xml", "<exec_depend>python3-yaml</exec_depend>", ""),
        ("warning", "python3-yaml"),
    ),
    "a program that ExternalProject_Add starts": Row(
        "undeclared-package",
        "humble",
        ament("sled", VENDOR, "build_depend:git"),
        ("sled/package.xml", "<build_depend>git</build_depend>", ""),
        ("error", "git"),
    ),
    "a program that a find module of CMake looks for": Row(
        "undeclared-package",
        "kinetic",
        catkin("sled", "", "find_package(Doxygen REQUIRED)\ncatkin_package()", "build_depend:doxygen"),
        ("sled/package.xml", "<build_depend>doxygen</build_depend>", ""),
        ("error", "doxygen"),
    ),
    "a test that starts nodes with a launch file's actions": Row(
        "undeclared-package",
        "humble",
        {
            **ament("sled", "find_package(ament_cmake_pytest REQUIRED)\nament_add_pytest_test(run test/test_run.py)",
                    "test_depend:ament_cmake_pytest", "test_depend:launch_ros"),
            "sled/test/test_run.py": "import launch_ros.actions\n",
        },
        ("sled/package.xml", "<test_depend>launch_ros</test_depend>", ""),
        ("warning", "launch_ros"),
    ),
    "a library that CMake asks for by name and a package uses for itself": Row(
        "undeclared-package",
        "melodic@2022-06-01",
        {
            **catkin("eyes", "", "catkin_package()\nadd_library(eyes eyes.cpp)", "build_depend:libopencv-dev",
                     "exec_depend:libopencv-dev", eyes_cpp="int eyes;\n"),
            **catkin("sled", "", "find_package(OpenCV REQUIRED)\ncatkin_package()", "eyes", "libopencv-dev"),
        },
        ("sled/package.xml", "<depend>libopencv-dev</depend>", ""),
        ("warning", "libopencv-dev"),
    ),
    "the tool of the package's own build": Row(
        "undeclared-package",
        "melodic@2022-06-01",
        catkin("sled", "", "catkin_package()", "exec_depend:roscpp"),
        ("sled/package.xml", "<buildtool_depend>catkin</buildtool_depend>", ""),
        ("warning", "catkin"),
    ),
    "a header of the package itself with a letter too many": Row(
        "removed-header",
        "humble",
        ament(
            "sled", HEADERS + "add_executable(run run.cpp)\ntarget_include_directories(run PUBLIC include)",
            include__sled__dogharness_hpp="#pragma once\n",
            run_cpp='#include "sled/dogharness.hpp"\n' + MAIN,
        ),
        ("sled/run.cpp", "sled/dogharness.hpp", "dogharnness.hpp"),
        ("error", "dogharnness.hpp"),
    ),
    "an interface that no version has": Row(
        "removed-header",
        "melodic",
        catkin(
            "sled", "COMPONENTS std_srvs", "catkin_package()\nadd_executable(run run.cpp)", "std_srvs",
            run_cpp="#include <std_srvs/SetBool.h>\n" + MAIN,
        ),
        ("sled/run.cpp", "SetBool", "SetString"),
        ("error", "std_srvs/SetString.h"),
    ),
    "a header that a declared package hands on": Row(
        "undeclared-package",
        "humble",
        {
            **ament("ice", HEADERS, include__ice__ice_hpp="#pragma once\n"),
            **ament("dogs", "find_package(ice REQUIRED)\nament_export_dependencies(ice)", "ice"),
            **ament("cats", "", "ice"),
            **ament("sled", "add_executable(run run.cpp)", "dogs", "cats", run_cpp="#include <ice/ice.hpp>\n" + MAIN),
        },
        ("dogs/CMakeLists.txt", "ament_export_dependencies(ice)", ""),
        ("warning", "ice"),
    ),
    "a component of a library that has a package of its own": Row(
        "undeclared-package",
        "noetic",
        catkin(
            "sled", "", "find_package(Boost REQUIRED COMPONENTS filesystem)\ncatkin_package()",
            "libboost-thread-dev", "libboost-filesystem-dev",
        ),
        ("sled/package.xml", "<depend>libboost-filesystem-dev</depend>", ""),
        ("error", "libboost-filesystem-dev"),
    ),
    "a node started under an argument that is off": Row(
        "undeclared-package",
        "noetic@2024-06-01",
        {**catkin("sled", "", "catkin_package()"), "sled/launch/run.launch": LAUNCH},
        ("sled/launch/run.launch", 'default="false"', 'default="true"'),
        ("warning", "rosbridge_server"),
    ),
    "a package of others, started on demand": Row(
        "undeclared-package",
        "noetic@2024-06-01",
        {
            **catkin("sled", "", "catkin_package()"),
            **catkin("dogs", "", "catkin_package()"),
            "sled/launch/run.launch": LAUNCH,
        },
        ("sled/launch/run.launch", "rosbridge_server", "dogs"),
        ("warning", "dogs"),
    ),
    "an installed header that nothing here compiles": Row(
        "undeclared-package",
        "humble",
        ament("sled", HEADERS, "angles", include__sled__sled_hpp="#pragma once\n" + ANGLES),
        ("sled/package.xml", "<depend>angles</depend>", ""),
        ("warning", "angles"),
    ),
    "an installed header that another package compiles": Row(
        "undeclared-package",
        "humble",
        {
            **ament("sled", HEADERS, "angles", include__sled__sled_hpp="#pragma once\n" + ANGLES),
            **ament("dogs", "add_executable(run run.cpp)", "sled", run_cpp="#include <sled/sled.hpp>\n" + MAIN),
        },
        ("sled/package.xml", "<depend>angles</depend>", ""),
        ("error", "angles"),
    ),
    "a header of a distro that has no cache": Row(
        "undeclared-package",
        "indigo",
        catkin("sled", "", "catkin_package()\nadd_executable(run run.cpp)", "roscpp", "angles", run_cpp=ANGLES + MAIN),
        ("sled/package.xml", "<depend>angles</depend>", ""),
        ("error", "angles"),
    ),
    "a generated header of a released package": Row(
        "undeclared-package",
        "kinetic",
        catkin(
            "sled", "", "catkin_package()\nadd_executable(run run.cpp)", "roscpp", "geographic_msgs",
            run_cpp="#include <geographic_msgs/GeoPoint.h>\n" + MAIN,
        ),
        ("sled/package.xml", "<depend>geographic_msgs</depend>", ""),
        ("error", "geographic_msgs"),
    ),
    "a module asked of pkg-config, and not required": Row(
        "undeclared-package",
        "noetic",
        catkin("sled", "", "find_package(PkgConfig REQUIRED)\npkg_check_modules(V4L libv4l2)\ncatkin_package()",
               "pkg-config"),
        ("sled/CMakeLists.txt", "V4L libv4l2", "V4L REQUIRED libv4l2"),
        ("error", "libv4l-dev"),
    ),
    "a test command that a declared package brings": Row(
        "undeclared-package",
        "humble",
        ament("sled", TESTED, "test_depend:ament_lint_auto", "test_depend:ament_cmake_gtest", test__probe_cpp=MAIN),
        ("sled/package.xml", "<test_depend>ament_cmake_gtest</test_depend>", ""),
        ("error", "ament_cmake_gtest"),
    ),
    "a metapackage of all packages": Row(
        "undeclared-package",
        "humble",
        {**TEAM, **ament("malamute2", "")} | {"team/package.xml": TEAM["team/package.xml"].replace(
            "<exec_depend>husky", "<exec_depend>malamute2</exec_depend>\n<exec_depend>husky")},
        ("team/package.xml", "<exec_depend>malamute2</exec_depend>\n", ""),
        ("warning", "malamute2"),
    ),
    "a library that dependants link too": Row(
        "wrong-dependency-kind",
        "jazzy",
        ament("sled", LIBRARY + "target_link_libraries(sled PUBLIC cap)", "libcap-dev", sled_cpp="int f;\n"),
        ("sled/package.xml", "<depend>libcap-dev</depend>", "<build_depend>libcap-dev</build_depend>"),
        ("warning", "libcap-dev"),
    ),
    "a key that brings headers": Row(
        "wrong-dependency-kind",
        "noetic",
        catkin(
            "sled", "", "find_package(Boost REQUIRED)\ncatkin_package()\nadd_executable(run run.cpp)",
            "libboost-thread-dev", run_cpp="#include <boost/thread.hpp>\n" + MAIN,
        ),
        ("sled/package.xml", "libboost-thread-dev", "libboost-thread"),
        ("error", "boost"),
    ),
    "headers for whoever includes the public header": Row(
        "wrong-dependency-kind",
        "noetic",
        catkin(
            "sled", "", "catkin_package()\n" + HEADERS, "build_depend:liborocos-kdl-dev",
            "exec_depend:liborocos-kdl-dev", include__sled__sled_hpp="#pragma once\n#include <kdl/frames.hpp>\n",
        ),
        ("sled/package.xml", "<exec_depend>liborocos-kdl-dev", "<exec_depend>liborocos-kdl"),
        ("warning", "liborocos-kdl-dev"),
    ),
    "a package of a repository": Row(
        "misspelt-dependency",
        "noetic",
        catkin("sled", "", "catkin_package()", "exec_depend:husky_msgs"),
        ("sled/package.xml", "husky_msgs", "husky"),
        ("error", "husky"),
    ),
    "a script installed as a program": Row(
        "missing-install",
        "noetic",
        catkin(
            "sled", "", "catkin_package()\ninstall(PROGRAMS scripts/run.py DESTINATION share/sled)\n",
            scripts__run_py="#!/usr/bin/env python3\nprint()\n",
        ),
        ("sled/CMakeLists.txt", "PROGRAMS", "FILES"),
        ("warning", "run.py"),
    ),
    "a node installed as a program": Row(
        "missing-install",
        "noetic",
        catkin(
            "sled", "", "catkin_package()\ninstall(PROGRAMS scripts/run.py DESTINATION share/sled)\n", "rospy",
            scripts__run_py="#!/usr/bin/env python3\nimport rospy\n",
        ),
        ("sled/CMakeLists.txt", "PROGRAMS", "FILES"),
        ("error", "run.py"),
    ),
    "a script among programs that may be executed": Row(
        "missing-install",
        "noetic",
        catkin(
            "sled", "", "catkin_package()\ninstall(FILES scripts/run.py DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION} "
            "PERMISSIONS OWNER_READ OWNER_EXECUTE)\n", scripts__run_py="#!/usr/bin/env python3\nprint()\n",
        ),
        ("sled/CMakeLists.txt", "PERMISSIONS OWNER_READ OWNER_EXECUTE", ""),
        ("error", "run.py"),
    ),
    "headers that another package includes by the name they are installed under": Row(
        "missing-install",
        "noetic",
        {
            **catkin(
                "sled", "", "catkin_package(INCLUDE_DIRS include)\ninstall(DIRECTORY include/runner/ "
                "DESTINATION ${CATKIN_GLOBAL_INCLUDE_DESTINATION}/runner)\n",
                include__runner__runner_h="#pragma once\n",
            ),
            **catkin(
                "dogs", "COMPONENTS sled", "catkin_package()\nadd_executable(run run.cpp)", "sled",
                run_cpp="#include <runner/runner.h>\n" + MAIN,
            ),
        },
        ("sled/CMakeLists.txt", "${CATKIN_GLOBAL_INCLUDE_DESTINATION}/runner", "${CATKIN_PACKAGE_INCLUDE_DESTINATION}"),
        ("warning", "CATKIN_PACKAGE_INCLUDE_DESTINATION"),
    ),
    "headers that another package compiles, installed in their place": Row(
        "missing-install",
        "humble",
        {
            **ament("sled", HEADERS, include__sled__sled_hpp="#pragma once\n"),
            **ament(
                "dogs",
                "add_executable(run run.cpp)\ninstall(TARGETS run DESTINATION lib/dogs)",
                "sled",
                run_cpp="#include <sled/sled.hpp>\n" + MAIN,
            ),
        },
        ("sled/CMakeLists.txt", "DIRECTORY include/ ", "DIRECTORY include "),
        ("error", "include"),
    ),
    "headers in their place that nothing here compiles": Row(
        "missing-install",
        "humble",
        ament("sled", HEADERS, include__sled__sled_hpp="#pragma once\n"),
        ("sled/CMakeLists.txt", "DIRECTORY include/ ", "DIRECTORY include "),
        ("warning", "include"),
    ),
    "the description of installed plugins": Row(
        "missing-install",
        "noetic",
        catkin(
            "sled",
            "COMPONENTS pluginlib",
            "catkin_package()\nadd_library(sled sled.cpp)\ninstall(TARGETS sled DESTINATION lib)\n"
            "install(FILES plugins.xml DESTINATION share/sled)\n",
            "pluginlib",
            sled_cpp="int f;\n",
            plugins_xml='<library path="lib/libsled"><class name="sled/A" type="A" base_class_type="B"/></library>\n',
        )
        | {
            "sled/package.xml": manifest(
                "sled", "pluginlib", tool="catkin", export='<nav_core plugin="${prefix}/plugins.xml"/>'
            )
        },
        ("sled/CMakeLists.txt", "install(FILES plugins.xml DESTINATION share/sled)\n", ""),
        ("error", "plugins.xml"),
    ),
    "a program that an installed launch file starts": Row(
        "missing-install",
        "noetic",
        catkin(
            "sled",
            "",
            "catkin_package()\nadd_executable(run run.cpp)\nadd_executable(stop stop.cpp)\n"
            "install(TARGETS run stop DESTINATION lib/sled)\ninstall(DIRECTORY launch DESTINATION share/sled)\n",
            run_cpp=MAIN,
            stop_cpp=MAIN,
            launch__all_launch='<launch>\n<node pkg="sled" type="run" name="run"/>\n</launch>\n',
        ),
        ("sled/CMakeLists.txt", "TARGETS run stop", "TARGETS stop"),
        ("error", "run"),
    ),
    "a program that a launch file starts on demand": Row(
        "missing-install",
        "noetic@2024-06-01",
        catkin(
            "sled",
            "",
            "catkin_package()\nadd_executable(run run.cpp)\nadd_executable(stop stop.cpp)\n"
            "install(TARGETS run stop DESTINATION lib/sled)\ninstall(DIRECTORY launch DESTINATION share/sled)\n",
            run_cpp=MAIN,
            stop_cpp=MAIN,
            launch__all_launch=LAUNCH.replace("rosbridge_server", "sled").replace("rosbridge_websocket", "run"),
        ),
        ("sled/CMakeLists.txt", "TARGETS run stop", "TARGETS stop"),
        ("warning", "run"),
    ),
    "headers installed under the name they are included by": Row(
        "missing-install",
        "noetic",
        catkin(
            "sled", "", "catkin_package()\ninstall(DIRECTORY include/runner/ "
            "DESTINATION ${CATKIN_GLOBAL_INCLUDE_DESTINATION}/runner)\n", include__runner__runner_h="#pragma once\n",
        ),
        ("sled/CMakeLists.txt", "${CATKIN_GLOBAL_INCLUDE_DESTINATION}/runner", "${CATKIN_PACKAGE_INCLUDE_DESTINATION}"),
        ("warning", "CATKIN_PACKAGE_INCLUDE_DESTINATION"),
    ),
    "a place that catkin sets": Row(
        "missing-install",
        "noetic",
        catkin("sled", "", PLACES),
        ("sled/CMakeLists.txt", "CATKIN_DEVEL_PREFIX", "CATKIN_BUILD_PREFIX"),
        ("error", "CATKIN_BUILD_PREFIX"),
    ),
    "an exported library that is built": Row(
        "missing-export",
        "humble",
        ament("sled", LIBRARY + "ament_export_libraries(sled)", sled_cpp="int f;\n"),
        ("sled/CMakeLists.txt", "ament_export_libraries(sled)", "ament_export_libraries(sledge)"),
        ("warning", "sledge"),
    ),
    "an exported library that catkin builds": Row(
        "missing-export",
        "noetic",
        catkin("sled", "", "catkin_package(LIBRARIES sled)\n" + LIBRARY, sled_cpp="int f;\n"),
        ("sled/CMakeLists.txt", "LIBRARIES sled", "LIBRARIES sledge"),
        ("error", "sledge"),
    ),
    "exported names apart": Row(
        "misspelt-cmake-name",
        "humble",
        ament(
            "sled",
            "find_package(angles REQUIRED)\nfind_package(rclcpp REQUIRED)\nament_export_dependencies(angles rclcpp)",
            "angles",
            "rclcpp",
        ),
        ("sled/CMakeLists.txt", "(angles rclcpp)", "(anglesrclcpp)"),
        ("error", "anglesrclcpp"),
    ),
    "variables of a module that pkg-config is asked for": Row(
        "missing-find-package",
        "noetic",
        catkin(
            "sled",
            "",
            "find_package(PkgConfig REQUIRED)\npkg_check_modules(v4l2 REQUIRED libv4l2)\ncatkin_package()\n"
            "add_executable(run run.cpp)\ntarget_link_libraries(run ${v4l2_LIBRARIES})\n",
            "libv4l-dev",
            run_cpp="#include <libv4l2.h>\n" + MAIN,
        ),
        ("sled/CMakeLists.txt", "pkg_check_modules(v4l2 REQUIRED libv4l2)\n", ""),
        ("error", "libv4l2"),
    ),
    "a component of catkin that is no system library": Row(
        "missing-find-package",
        "noetic",
        catkin("sled", "COMPONENTS roscpp", "catkin_package()", "roscpp", "libconsole-bridge-dev"),
        ("sled/CMakeLists.txt", "COMPONENTS roscpp", "COMPONENTS roscpp console_bridge"),
        ("error", "console_bridge"),
    ),
    "headers of a base class, exported": Row(
        "missing-export",
        "humble",
        {
            **ament(
                "sled",
                "find_package(pluginlib REQUIRED)\n" + LIBRARY + HEADERS + "ament_export_include_directories(include)\n"
                "pluginlib_export_plugin_description_file(sled plugins.xml)",
                "pluginlib",
                sled_cpp="int f;\n",
                include__sled__base_hpp="#pragma once\n",
            ),
            "sled/plugins.xml": '<library path="sled"><class name="sled/A" type="A" base_class_type="B"/></library>\n',
        },
        ("sled/CMakeLists.txt", "ament_export_include_directories(include)\n", ""),
        ("warning", "ament_export_include_directories"),
    ),
    "headers off the beaten path, exported": Row(
        "missing-export",
        "humble",
        ament(
            "sled",
            "find_package(Eigen3 REQUIRED)\n" + HEADERS + "ament_export_include_directories(include)\n"
            "ament_export_dependencies(Eigen3)",
            "eigen",
            include__sled__sled_hpp="#pragma once\n#include <Eigen/Core>\n",
        ),
        ("sled/CMakeLists.txt", "ament_export_dependencies(Eigen3)", ""),
        ("warning", "eigen"),
    ),
    "a compiled part of Boost, kept private": Row(
        "missing-export",
        "humble",
        ament(
            "sled",
            "find_package(Boost REQUIRED COMPONENTS filesystem)\n" + LIBRARY + "target_link_libraries(sled PRIVATE "
            "Boost::filesystem)\nament_export_targets(sled)\nament_export_dependencies(Boost)",
            "libboost-filesystem-dev",
            sled_cpp="int f;\n",
        ),
        ("sled/CMakeLists.txt", "PRIVATE", "PUBLIC"),
        ("warning", "Boost"),
    ),
    "an exported dependency, beside linters": Row(
        "missing-export",
        "humble",
        ament(
            "sled",
            "find_package(angles REQUIRED)\n" + LIBRARY + HEADERS + "ament_export_libraries(sled)\n"
            "ament_export_dependencies(angles)\nif(BUILD_TESTING)\n  find_package(ament_lint_auto REQUIRED)\n"
            "  ament_lint_auto_find_test_dependencies()\nendif()",
            "angles",
            "test_depend:ament_lint_auto",
            "test_depend:ament_lint_common",
            sled_cpp="#include <sled/sled.hpp>\n",
            include__sled__sled_hpp="#pragma once\n" + ANGLES,
        ),
        ("sled/CMakeLists.txt", "ament_export_dependencies(angles)", ""),
        ("warning", "angles"),
    ),
    "include directories under a variable in capitals": Row(
        "missing-find-package",
        "jazzy",
        ament(
            "sled",
            "find_package(ompl REQUIRED)\ninclude_directories(${OMPL_INCLUDE_DIRS})\nadd_executable(run run.cpp)",
            "ompl",
            run_cpp="#include <ompl/base/StateSpace.h>\n" + MAIN,
        ),
        ("sled/CMakeLists.txt", "include_directories(${OMPL_INCLUDE_DIRS})\n", ""),
        ("warning", "ompl"),
    ),
    "a generator that is found": Row(
        "missing-interface-wiring",
        "noetic",
        {
            **catkin("sled", "COMPONENTS message_generation", GENERATED, "message_generation", "message_runtime"),
            **FLOE,
        },
        ("sled/CMakeLists.txt", "COMPONENTS message_generation", ""),
        ("error", "message_generation"),
    ),
    "order behind the messages that are included": Row(
        "missing-interface-wiring",
        "noetic",
        {
            **catkin("sled", "COMPONENTS message_generation", GENERATED, "message_generation", "message_runtime"),
            **FLOE,
            **catkin(
                "dogs",
                "COMPONENTS sled",
                "catkin_package()\nadd_executable(run run.cpp)\nadd_dependencies(run sled_gencpp)",
                "sled",
                run_cpp="#include <sled/Floe.h>\n" + MAIN,
            ),
        },
        ("dogs/CMakeLists.txt", "(run sled_gencpp)", "(run nav_msgs_gencpp)"),
        ("warning", "sled_generate_messages_cpp"),
    ),
    "order by the project's own name": Row(
        "missing-interface-wiring",
        "noetic",
        {
            **catkin(
                "sled",
                "COMPONENTS message_generation roscpp",
                GENERATED + "add_executable(run run.cpp)\nadd_dependencies(run sled_generate_messages_cpp)\n",
                "message_generation", "message_runtime", "roscpp",
                run_cpp="#include <sled/Floe.h>\n" + MAIN,
            ),
            **FLOE,
        },
        ("sled/CMakeLists.txt", "add_dependencies(run sled_generate_messages_cpp)\n", ""),
        ("warning", "sled_generate_messages_cpp"),
    ),
    "order by the project's variable": Row(
        "missing-interface-wiring",
        "noetic",
        {
            **catkin(
                "sled",
                "COMPONENTS message_generation roscpp",
                GENERATED + "add_executable(${PROJECT_NAME}_run run.cpp)\n"
                "add_dependencies(${PROJECT_NAME}_run ${PROJECT_NAME}_generate_messages_cpp)\n",
                "message_generation", "message_runtime", "roscpp",
                run_cpp="#include <sled/Floe.h>\n" + MAIN,
            ),
            **FLOE,
        },
        ("sled/CMakeLists.txt", "add_dependencies(${PROJECT_NAME}_run ${PROJECT_NAME}_generate_messages_cpp)\n", ""),
        ("warning", "sled_generate_messages_cpp"),
    ),
}  # fmt: skip


# What is a warning at most, since the evidence is not complete.
UNSURE = {
    "a group, of which any member may bring it": (
        {
            path: text.replace("</license>", "</license>\n<group_depend>drivers</group_depend>").replace(
                'format="2"', 'format="3"'
            )
            for path, text in ament("sled", "find_package(angles REQUIRED)").items()
        },
        "<group_depend>drivers</group_depend>",
        "",
    ),
}


SILENT: dict[str, tuple[str, str, Files]] = {
    "what a key's packages depend on": (
        "undeclared-package",
        "humble",
        ament("sled", "find_package(OpenGL REQUIRED)", "libglew-dev"),
    ),
    "a program of every machine that builds": (
        "undeclared-package",
        "humble",
        ament("sled", VENDOR, "build_depend:git"),
    ),
    "what a package without anything of its own brings": (
        "undeclared-package",
        "humble",
        {
            **BUNDLE,
            **ament("sled", "if(BUILD_TESTING)\n  find_package(ament_cmake_cpplint REQUIRED)\nendif()",
                    "test_depend:kit"),
        },
    ),
    "a library that a declared package exports": (
        "undeclared-package",
        "melodic",
        catkin("sled", "", "find_package(OpenCV REQUIRED)\ncatkin_package()", "cv_bridge"),
    ),
    "what starts a launch file, in one": (
        "undeclared-package",
        "humble",
        {
            **ament("sled", "install(DIRECTORY launch DESTINATION share/sled)"),
            "sled/launch/run.launch.py": "import yaml\nimport launch\nimport launch_ros.actions\n",
        },
    ),
    "a header of dynamic_reconfigure": (
        "removed-header",
        "melodic",
        catkin(
            "sled", "COMPONENTS std_srvs", "catkin_package()\nadd_executable(run run.cpp)", "std_srvs",
            run_cpp="#include <std_srvs/SledConfig.h>\n" + MAIN,
        ),
    ),
}  # fmt: skip


@pytest.fixture
def said(cache: Path) -> Said:
    """Writes files, and gives severity and subject of what a rule says of the workspace above a note."""

    def said_by(files: Files, target: str, rule: str) -> list[tuple[str, str]]:
        report = rule_cases.check_files(files, Options(targets=(target,), cache=cache, select=(rule,)))
        return [(f.severity, f.subject) for f in report.findings if f.severity != "note"]

    return said_by


@pytest.mark.parametrize("row", ROWS.values(), ids=ROWS)
def test_the_rule_is_content_until_it_is_spoilt(row: Row, said: Said):
    assert said(row.files, row.target, row.rule) == []
    path, old, new = row.spoilt
    assert old in row.files[path]
    assert row.told in said({**row.files, path: row.files[path].replace(old, new)}, row.target, row.rule)


@pytest.mark.parametrize(("files", "old", "new"), UNSURE.values(), ids=UNSURE)
def test_no_error_without_all_the_evidence(files: Files, old: str, new: str, said: Said):
    assert ("warning", "angles") in said(files, "humble", "undeclared-package")
    sure = {path: text.replace(old, new) for path, text in files.items()}
    assert ("error", "angles") in said(sure, "humble", "undeclared-package")


def test_what_a_dependency_brings_in_another_distro_is_no_error(said: Said):
    """The manifest that movie_publisher has in Indigo is not known; in the nearest distro it brings no image_transport,
    in another one it does."""
    source = "#include <image_transport/image_transport.h>\n" + MAIN
    built = "catkin_package()\nadd_executable(run run.cpp)"
    files = catkin("sled", "", built, "roscpp", "movie_publisher", run_cpp=source)
    assert said(files, "indigo@2018-06-01", "undeclared-package") == [("warning", "image_transport")]
    sure = {path: text.replace("<depend>movie_publisher</depend>", "") for path, text in files.items()}
    assert said(sure, "indigo@2018-06-01", "undeclared-package") == [("error", "image_transport")]


@pytest.mark.parametrize(("rule", "target", "files"), SILENT.values(), ids=SILENT)
def test_what_is_at_hand_is_not_reported(rule: str, target: str, files: Files, said: Said):
    assert said(files, target, rule) == []
