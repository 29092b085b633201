"""Fixes applied to the cases of rules through the command line: what is proposed, and what is left alone."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
import rule_cases
from rosimpact.impact.cli.app import app
from typer.testing import CliRunner

# Cases whose fix is known on every target that they ask for: it undoes the change that they make, to the byte.
FIXED = (
    "api/moved_header",
    "api/removed_cmake_name__linked",
    "api/removed_header",
    "packages/invalid_manifest",
    "packages/misspelt_cmake_name",
    "packages/misspelt_cmake_variable",
    "packages/misspelt_component__fixed",
    "packages/misspelt_dependency",
    "packages/misspelt_dependency__spelling",
    "packages/misspelt_dependency__system_package",
    "packages/missing_interface_wiring",
    "packages/missing_interface_group",
    "packages/undeclared_package",
    "packages/undeclared_package__format_1",
    "packages/unreachable_script__copied",
    "packages/unresolvable_key",
    "packages/wrong_dependency_kind",
    "sources/missing_standard_include",
)
Fix = Callable[..., str]


@pytest.fixture(scope="module")
def fix(cache: Path) -> Fix:
    """Runs `check --fix` and returns what it reports afterwards."""

    def fixed(workspace: Path, *targets: str) -> str:
        asked = [word for target in targets for word in ("--target", target)]
        options = ["--fix", "--preview", "--notes", "--quiet", "--fail-on", "never"]
        outcome = CliRunner().invoke(
            app, ["check", str(workspace), *asked, *options], env={"ROSIMPACT_CACHE": str(cache)}
        )
        assert outcome.exit_code == 0, outcome.output
        return outcome.output

    return fixed


def files_of(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize("case", FIXED)
def test_a_fix_undoes_the_change_of_a_case(case: str, fix: Fix, tmp_path: Path):
    (broken,) = (one for one in rule_cases.read_cases(rule_cases.HERE / f"{case}.md") if one.findings)
    workspace = rule_cases.write_files(tmp_path / "ws", broken.files)
    output = fix(workspace, *broken.targets)
    assert files_of(workspace) == {path: text.encode() for path, text in broken.unchanged.items()}
    assert f"[{broken.rule}]" not in output


MANIFEST = """<?xml version="1.0"?>
<package format="{version}">
  <name>ice</name>
  <version>1.0.0</version>
  <description>ice</description>
  <maintainer email="robots@example.org">Robots</maintainer>
  <license>Apache-2.0</license>
  <buildtool_depend>{tool}</buildtool_depend>
{body}</package>
"""
CMAKE_2 = """cmake_minimum_required(VERSION 3.8)
project(ice)
find_package(ament_cmake REQUIRED)
find_package(rclcpp REQUIRED)
find_package({package} REQUIRED)
add_executable(ice ice.cpp)
target_link_libraries(ice rclcpp::rclcpp {package}::{package})
install(TARGETS ice DESTINATION lib/${{PROJECT_NAME}})
ament_package()
"""


def ament(*, body: str, package: str, source: str) -> dict[str, str]:
    return {
        "package.xml": MANIFEST.format(version=3, tool="ament_cmake", body=body),
        "CMakeLists.txt": CMAKE_2.format(package=package),
        "ice.cpp": source,
    }


NODE = "#include <{header}>\n#include <rclcpp/rclcpp.hpp>\nint main() {{ return 0; }}\n"
RCLCPP = "  <depend>rclcpp</depend>\n"
# What a rule says, and does not fix: rule (empty: nothing is said), targets, files.
UNTOUCHED = {
    # cv_bridge.hpp came with Iron, so one spelling is not right on both.
    "the new header is not on every target": (
        "removed-header",
        ("humble", "jazzy"),
        ament(
            body=RCLCPP + "  <depend>cv_bridge</depend>\n",
            package="cv_bridge",
            source=NODE.format(header="cv_bridge/cv_bridge.h"),
        ),
    ),
    "the code chooses for itself": (
        "",
        ("humble", "jazzy"),
        ament(
            body=RCLCPP + "  <depend>cv_bridge</depend>\n",
            package="cv_bridge",
            source="#if __has_include(<cv_bridge/cv_bridge.hpp>)\n#include <cv_bridge/cv_bridge.hpp>\n#else\n"
            + NODE.format(header="cv_bridge/cv_bridge.h").replace("h>\n", "h>\n#endif\n", 1),
        ),
    ),
    # ros1_bridge left with Humble; to declare it would be wrong there.
    "the package is not on every target": (
        "undeclared-package",
        ("foxy", "humble"),
        ament(body=RCLCPP, package="ros1_bridge", source=NODE.format(header="ros1_bridge/bridge.hpp")),
    ),
    "the dependency is declared under a condition": (
        "undeclared-package",
        ("jazzy",),
        ament(
            body=RCLCPP + '  <depend condition="$ROS_DISTRO == humble">angles</depend>\n',
            package="angles",
            source=NODE.format(header="angles/angles.h"),
        ),
    ),
    # As eigen2 and eigen3: one letter, and another thing.
    "a digit tells versions apart": (
        "unknown-dependency",
        ("jazzy",),
        ament(
            body=RCLCPP + "  <depend>python4-serial</depend>\n",
            package="angles",
            source=NODE.format(header="rclcpp/rclcpp.hpp"),
        )
        | {"CMakeLists.txt": CMAKE_2.format(package="rclcpp").replace(" rclcpp::rclcpp rclcpp", " rclcpp")},
    ),
    "a dependency that would close a circle": (
        "undeclared-package",
        ("jazzy",),
        {
            "a/package.xml": MANIFEST.format(version=3, tool="ament_cmake", body=""),
            "a/CMakeLists.txt": CMAKE_2.format(package="snow").replace("find_package(rclcpp REQUIRED)\n", ""),
            "a/ice.cpp": "int main() { return 0; }\n",
            "b/package.xml": MANIFEST.format(version=3, tool="ament_cmake", body="  <depend>ice</depend>\n").replace(
                "<name>ice", "<name>snow"
            ),
            "b/CMakeLists.txt": "cmake_minimum_required(VERSION 3.8)\nproject(snow)\nfind_package(ice REQUIRED)\n",
        },
    ),
    "a package of which no targets are known is linked": (
        "removed-cmake-name",
        ("lyrical",),
        {
            **ament(body=RCLCPP, package="rclcpp", source=NODE.format(header="rclcpp/rclcpp.hpp")),
            "CMakeLists.txt": CMAKE_2.format(package="OurPrivateLights").replace(
                "target_link_libraries(ice rclcpp::rclcpp OurPrivateLights::OurPrivateLights)",
                "ament_target_dependencies(ice rclcpp OurPrivateLights)",
            ),
        },
    ),
    "other people's code": (
        "removed-cmake-name",
        ("lyrical",),
        {
            f"third_party/ice/{path}": text.replace(
                "target_link_libraries(ice rclcpp::rclcpp rclcpp::rclcpp)", "ament_target_dependencies(ice rclcpp)"
            )
            for path, text in ament(
                body=RCLCPP, package="rclcpp", source=NODE.format(header="rclcpp/rclcpp.hpp")
            ).items()
        },
    ),
    "the key is another one for each Python": (
        "undeclared-package",
        ("melodic", "noetic"),
        {
            "CMakeLists.txt": "cmake_minimum_required(VERSION 3.0.2)\nproject(ice)\nfind_package(catkin REQUIRED)\n"
            "catkin_package()\ncatkin_install_python(PROGRAMS scripts/melt DESTINATION lib)\n",
            "scripts/melt": "#!/usr/bin/env python\nimport rospy\nimport scipy\n\nprint(rospy, scipy)\n",
            "package.xml": MANIFEST.format(version=2, tool="catkin", body="  <exec_depend>rospy</exec_depend>\n"),
        },
    ),
    "a misspelt tag whose end stands in another line": (
        "invalid-manifest",
        ("jazzy",),
        {
            "package.xml": MANIFEST.format(
                version=3, tool="ament_cmake", body="  <build-depend>\n    rclcpp</build-depend>\n"
            ),
            "CMakeLists.txt": "cmake_minimum_required(VERSION 3.8)\nproject(ice)\n",
        },
    ),
}


@pytest.mark.parametrize(("rule", "targets", "files"), UNTOUCHED.values(), ids=UNTOUCHED)
def test_what_is_not_surely_right_is_left_to_a_person(rule, targets, files, fix: Fix, tmp_path: Path):
    workspace = rule_cases.write_files(tmp_path / "ws", files)
    before = files_of(workspace)
    output = fix(workspace, *targets)
    assert files_of(workspace) == before
    assert f"[{rule}]" in output if rule else "] " not in output.partition("ice\n")[0]


CATKIN = """cmake_minimum_required(VERSION 3.0.2)\r
project(ice)\r
find_package(catkin REQUIRED COMPONENTS message_generation roscpp)\r
add_message_files(FILES Floe.msg)\r
generate_messages()\r
catkin_package(CATKIN_DEPENDS message_runtime)\r
include_directories(${catkin_INCLUDE_DIRS})\r
  add_executable(\r
    melt  # the sun\r
    melt.cpp\r
  )\r
target_link_libraries(melt ${catkin_LIBRARIES})\r
"""
CATKIN_BODY = (
    "  <build_depend>message_generation</build_depend>\n  <build_depend>roscpp</build_depend>\n"
    "  <run_depend>message_runtime</run_depend>\n  <run_depend>roscpp</run_depend>\n"
)
BARE = "cmake_minimum_required(VERSION 3.0.2)\nproject(ice)\nfind_package(catkin REQUIRED)\ncatkin_package()\n"
EIGEN = "  <depend>eigen</depend>\n  <depend>Eigen</depend>\n"
FLOE = "#include <ice/Floe.h>\n#include <ros/ros.h>\nint main() { return 0; }\n"
EDITED = {
    "behind a command of several lines, with the file's own line ends": (
        ("noetic",),
        {"CMakeLists.txt": CATKIN, "msg/Floe.msg": "float64 size\n", "melt.cpp": FLOE,
         "package.xml": MANIFEST.format(version=1, tool="catkin", body=CATKIN_BODY)},
        "CMakeLists.txt",
        ("  )\r\n", "  )\r\n  add_dependencies(melt ${ice_EXPORTED_TARGETS})\r\n"),
    ),
    "a run dependency in the words of format 1": (
        ("noetic@2024-06-01",),
        {"CMakeLists.txt": BARE + "catkin_install_python(PROGRAMS scripts/melt DESTINATION lib)\n",
         "scripts/melt": "#!/usr/bin/env python3\nimport rospy\nimport serial\n\nprint(rospy, serial)\n",
         "package.xml": MANIFEST.format(version=1, tool="catkin", body="  <run_depend>rospy</run_depend>\n")},
        "package.xml",
        ("rospy</run_depend>\n", "rospy</run_depend>\n  <run_depend>python3-serial</run_depend>\n"),
    ),
    "a dependency once, whatever needs it": (
        ("humble", "jazzy", "rolling"),
        ament(body="  <depend>rclcpp</depend>\n", package="angles", source=NODE.format(header="angles/angles.h")),
        "package.xml",
        ("  <depend>rclcpp</depend>\n", "  <depend>rclcpp</depend>\n  <depend>angles</depend>\n"),
    ),
    "a name misspelt everywhere": (
        ("noetic",),
        {"CMakeLists.txt": BARE,
         "package.xml": MANIFEST.format(version=1, tool="catkin", body="  <build_depend>Eigen</build_depend>\n")},
        "package.xml",
        ("<build_depend>Eigen<", "<build_depend>eigen<"),
    ),
    "a misspelt name beside the right one": (
        ("noetic",),
        {"CMakeLists.txt": BARE,
         "package.xml": MANIFEST.format(version=2, tool="catkin", body=EIGEN)},
        "package.xml",
        ("  <depend>Eigen</depend>\n", ""),
    ),
}  # fmt: skip


def list_facts(workspace: Path, targets: tuple[str, ...], cache: Path) -> set[tuple[str, str, str, str]]:
    """What a check finds: rule, path, subject and target of each."""
    asked = [word for target in targets for word in ("--target", target)]
    options = ["--preview", "--quiet", "--fail-on", "never", "--format", "json"]
    outcome = CliRunner().invoke(app, ["check", str(workspace), *asked, *options], env={"ROSIMPACT_CACHE": str(cache)})
    found = json.loads(outcome.stdout)["findings"]
    return {(one["rule"], one["path"], one["subject"], target) for one in found for target in one["targets"] or ("",)}


WITH_FIX = {
    **{name: (targets, files) for name, (targets, files, _, _) in EDITED.items()},
    **{name: (targets, files) for name, (_, targets, files) in UNTOUCHED.items()},
    # On one target the key of its Python is right; the other target is not asked about.
    "a module of Python 2": (("melodic",), UNTOUCHED["the key is another one for each Python"][2]),
}


@pytest.mark.parametrize(("targets", "files"), WITH_FIX.values(), ids=WITH_FIX)
def test_a_fix_causes_nothing_that_the_next_check_reports(targets, files, fix: Fix, cache: Path, tmp_path: Path):
    workspace = rule_cases.write_files(tmp_path / "ws", files)
    before = list_facts(workspace, targets, cache)
    fix(workspace, *targets)
    assert list_facts(workspace, targets, cache) <= before


@pytest.mark.parametrize(("targets", "files", "path", "edit"), EDITED.values(), ids=EDITED)
def test_a_fix_changes_what_it_says_and_nothing_else(targets, files, path, edit, fix: Fix, tmp_path: Path):
    workspace = rule_cases.write_files(tmp_path / "ws", files)
    fix(workspace, *targets)
    assert files[path].count(edit[0]) == 1
    expected = {name: text.encode() for name, text in files.items()}
    expected[path] = files[path].replace(*edit).encode()
    assert files_of(workspace) == expected
