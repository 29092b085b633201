"""What is sure to stop on a machine that has just what the manifests bring, and what comes along by some luck."""

from __future__ import annotations

import pytest
import rule_cases
from rosimpact.impact.analysis.session import Options
from test_wiring import MAIN, Files, ament, catkin

GTEST = "include(CTest)\nif(BUILD_TESTING)\n  find_package(ament_cmake_gtest REQUIRED)\nendif()"
SLED = ament("sled", GTEST)
SLEDGE = ament("sledge", "", "test_depend:ament_cmake_gtest")
MODULES = "find_package(PkgConfig)\npkg_check_modules(usb {}libusb)\ncatkin_package()"
BRING = "libusb-dev"
HARNESS = "install(DIRECTORY include/ DESTINATION include/sled {})\nament_export_include_directories(include/sled)"
SEAT = "add_library({0} SHARED seat.cpp)\ntarget_link_libraries({0} PUBLIC angles::angles)\n"
EXPORT = "install(TARGETS {0} EXPORT sled)\nament_export_targets(sled)\n{1}"
FREE = "add_library(free SHARED seat.cpp)\n"


def exporting(*linked: str, exported: str = "") -> Files:
    """A package that exports a library which passes a package on, and one that links what is said."""
    cmake = "find_package(angles REQUIRED)\n" + SEAT.format("seat") + FREE
    one = ament("sled", cmake + EXPORT.format("seat free", exported), "angles", seat_cpp="int seat;\n")
    links = "".join(f"target_link_libraries(run {item})\n" for item in linked)
    text = f"find_package(sled REQUIRED)\nadd_executable(run run.cpp)\n{links}"
    return {**one, **ament("sledge", text, "sled", run_cpp=MAIN)}


ROWS = {
    "before bloom left tests out": ("undeclared-package", "foxy@2021-06-01", {**SLED, **SLEDGE}, {"error"}),
    "since, where a neighbour declares it": ("undeclared-package", "foxy@2022-06-01", {**SLED, **SLEDGE}, {"warning"}),
    "since, where nobody does": ("undeclared-package", "foxy@2022-06-01", SLED, {"error"}),
    "only what is declared to run brings what configures tests": (
        "undeclared-package", "melodic@2020-01-01",
        catkin(
            "twist_mux", "", "if(CATKIN_ENABLE_TESTING)\n  find_package(rostest REQUIRED)\nendif()\ncatkin_package()",
            "exec_depend:tf",
        ),
        {"error"},
    ),
    "modules are required": (
        "undeclared-package", "kinetic", catkin("sled", "", MODULES.format("REQUIRED "), BRING), {"error"},
    ),
    "modules are not required": ("undeclared-package", "kinetic", catkin("sled", "", MODULES.format(""), BRING), set()),
    "the launch command brings it": (
        "undeclared-package", "jazzy",
        {**ament("sled", "", "build_depend:launch_ros"), "sled/launch/run.launch.py": "import launch_ros\n"}, set(),
    ),
    "the tool for tests brings it": (
        "undeclared-package", "jazzy",
        ament(
            "sled", "if(BUILD_TESTING)\n  add_executable(run test/run.cpp)\nendif()",
            "test_depend:ament_cmake_google_benchmark", test__run_cpp="#include <benchmark/benchmark.h>\n" + MAIN,
        ),
        set(),
    ),
    "built with what is declared to run": (
        "wrong-dependency-kind", "jazzy", ament("twist_mux", "find_package(angles REQUIRED)", "exec_depend:angles"),
        {"error"},
    ),
    "no build farm ever built it": (
        "wrong-dependency-kind", "jazzy", ament("sled", "find_package(angles REQUIRED)", "exec_depend:angles"),
        {"warning"},
    ),
    "a dependant links the target": ("missing-export", "jazzy", exporting("sled::seat"), {"error"}),
    "a dependant links another one": ("missing-export", "jazzy", exporting("sled::free"), {"warning"}),
    "nobody links it": ("missing-export", "jazzy", exporting(), {"warning"}),
    "it is exported": (
        "missing-export", "jazzy", exporting("sled::seat", exported="ament_export_dependencies(angles)"), set(),
    ),
    "an exported library is not installed": (
        "missing-install", "melodic",
        catkin(
            "sled", "", "catkin_package(LIBRARIES seat free)\nadd_library(seat seat.cpp)\nadd_library(free seat.cpp)\n"
            "install(TARGETS seat DESTINATION lib)", seat_cpp="int seat;\n",
        ),
        {"error"},
    ),
    "a static library is linked": (
        "missing-install", "melodic",
        catkin(
            "sled", "", "catkin_package()\nadd_library(seat STATIC seat.cpp)\nadd_executable(run run.cpp)\n"
            "target_link_libraries(run seat)\ninstall(TARGETS run DESTINATION lib/sled)",
            seat_cpp="int seat;\n", run_cpp=MAIN,
        ),
        set(),
    ),
    "headers lie beside the exported folder": (
        "missing-install", "jazzy",
        ament(
            "sled", "install(DIRECTORY include DESTINATION include)\nament_export_include_directories(include)",
            include__sled__seat_hpp="#pragma once\n",
        ),
        {"error"},
    ),
    "no folder is exported": (
        "missing-install", "jazzy",
        ament("sled", "install(DIRECTORY include DESTINATION include)", include__sled__seat_hpp="#pragma once\n"),
        {"warning"},
    ),
    "ament_target_dependencies stops": (
        "missing-find-package", "foxy",
        ament("sled", "add_library(seat seat.cpp)\nament_target_dependencies(seat sled)", seat_cpp="int seat;\n"),
        {"error"},
    ),
    "it did not stop yet": (
        "missing-find-package", "dashing",
        ament("sled", "add_library(seat seat.cpp)\nament_target_dependencies(seat sled)", seat_cpp="int seat;\n"),
        set(),
    ),
    "a program of tests links nothing": (
        "unlinked-library", "melodic",
        catkin(
            "sled", "", "catkin_package()\nadd_executable(run run.cpp)", "gtest",
            run_cpp="#include <gtest/gtest.h>\nTEST(Sled, stands) {}\n" + MAIN,
        ),
        {"error"},
    ),
    "it is built on request": (
        "unlinked-library", "melodic",
        catkin(
            "sled", "", "catkin_package()\nadd_executable(run EXCLUDE_FROM_ALL run.cpp)", "gtest",
            run_cpp="#include <gtest/gtest.h>\nTEST(Sled, stands) {}\n" + MAIN,
        ),
        {"warning"},
    ),
    "an installed header that nobody can compile": (
        "removed-header", "melodic",
        catkin(
            "sled", "", "catkin_package(INCLUDE_DIRS include)\ninstall(DIRECTORY include/ DESTINATION include)",
            "std_srvs",
            include__sled__seat_h="#include <std_srvs/SetSled.h>\n",
        ),
        {"error"},
    ),
}  # fmt: skip


def severities(files: Files, target: str, rule: str, cache) -> set[str]:
    """The severities of what a rule says of files, above a note."""
    report = rule_cases.check_files(files, Options(targets=(target,), cache=cache, select=(rule,)))
    return {finding.severity for finding in report.findings} - {"note"}


@pytest.mark.parametrize(("rule", "target", "files", "expected"), ROWS.values(), ids=ROWS)
def test_what_is_sure_is_an_error(rule, target, files, expected, tmp_path):
    assert severities(files, target, rule, tmp_path) == expected


@pytest.mark.parametrize(("included", "expected"), [("sled/seat.h", {"error"}), ("sled/free.h", {"warning"})])
def test_a_dependant_compiles_a_header_that_includes_what_is_not_installed(included, expected, tmp_path):
    sled = ament(
        "sled", HARNESS.format('FILES_MATCHING PATTERN "*.h"'), include__sled__free_h="#pragma once\n",
        include__sled__seat_h='#include "sled/rope.hpp"\n', include__sled__rope_hpp="#pragma once\n",
    )  # fmt: skip
    text = "find_package(sled REQUIRED)\nadd_executable(run run.cpp)\nament_target_dependencies(run sled)"
    files = {**sled, **ament("sledge", text, "sled", run_cpp=f"#include <{included}>\n{MAIN}")}
    assert severities(files, "jazzy", "uninstalled-header", tmp_path) == expected
