"""What is an error because nothing about it hangs on chance, where its neighbour is a warning."""

from pathlib import Path

import pytest
from rosimpact.impact.check import Options, check

MANIFEST = (
    '<package format="2"><name>sled</name><version>1.0.0</version><description>sled</description>'
    '<maintainer email="robots@example.org">Robots</maintainer><license>MIT</license>'
    "<buildtool_depend>catkin</buildtool_depend><depend>roscpp</depend><depend>rospy</depend></package>"
)
CMAKE = "cmake_minimum_required(VERSION 3.0)\nproject(sled)\nfind_package(catkin REQUIRED COMPONENTS roscpp rospy)\n"


def severities(folder: Path, rule: str, subject: str, target: str, **files: str) -> set[str]:
    depend = "".join(f"<depend>{name}</depend></package>" for name in files.pop("depend", "").split())
    (folder / "package.xml").write_text(MANIFEST.replace("</package>", depend or "</package>"))
    (folder / "CMakeLists.txt").write_text(CMAKE + files.pop("cmake", "") + "catkin_package()\n")
    for path, text in files.items():
        place = folder / path.replace("__", "/").replace("_DOT_", ".")
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(text)
    found = check(folder, Options(targets=(target,), select=(rule,), cache=folder / "cache", jobs=1)).findings
    return {finding.severity for finding in found if finding.subject == subject}


@pytest.mark.parametrize(
    ("target", "cmake", "expected"),
    [
        ("noetic", "catkin_add_nosetests(test/timing.py)\n", {"error"}),
        ("noetic", "", {"warning"}),  # nobody may run it
        ("melodic", "catkin_add_nosetests(test/timing.py)\n", set()),
    ],
)
def test_a_python_test_that_calls_what_is_gone(target, cmake, expected, tmp_path):
    text = "import time, unittest\nclass Timing(unittest.TestCase):\n    def test(self):\n        time.clock()\n"
    told = severities(tmp_path, "removed-symbol", "time.clock", target, cmake=cmake, test__timing_DOT_py=text)
    assert told - {"note"} == expected


@pytest.mark.parametrize(("module", "expected"), [("FindEigen", {"error"}), ("FindSkid", {"warning"})])
def test_a_find_module_of_the_package_in_another_case(module, expected, tmp_path):
    told = severities(
        tmp_path, "misspelt-cmake-name", "EIGEN", "hydro",
        cmake="list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_SOURCE_DIR}/cmake)\nfind_package(EIGEN REQUIRED)\n",
        **{f"cmake__{module}_DOT_cmake": "set(EIGEN_FOUND TRUE)\n"},
    )  # fmt: skip
    assert told == expected


@pytest.mark.parametrize(("target", "expected"), [("kinetic", {"error"}), ("melodic", set())])
def test_a_standard_that_an_old_qt_does_not_raise(target, expected, tmp_path):
    told = severities(
        tmp_path, "language-standard", "-std=c++11", target,
        cmake="find_package(Qt5 REQUIRED COMPONENTS Widgets)\nadd_executable(sled sled.cpp)\n",
        sled_DOT_cpp="#include <moveit/planning_scene/planning_scene.h>\n",
    )  # fmt: skip
    assert told == expected


@pytest.mark.parametrize(
    ("member", "depend", "expected"),
    [
        ("ros::CallbackQueue queue_;", "rviz", {"error"}),
        ("ros::CallbackQueue * queue_;", "rviz", {"warning"}),  # which is announced
        ("ros::CallbackQueue queue_;", "", {"warning"}),  # the file may not be compiled at all
    ],
)
def test_a_header_that_rviz_stopped_to_include_beside_those_of_its_libraries(member, depend, expected, tmp_path):
    told = severities(
        tmp_path, "missing-include", "ros/callback_queue.h", "noetic", depend=depend,
        cmake="find_package(rviz)\nif(rviz_FOUND)\n  add_library(sled sled.cpp)\nendif()\n",
        sled_DOT_cpp=f"#include <rviz/message_filter_display.h>\nclass Panel {{\n  {member}\n}};\n",
    )  # fmt: skip
    assert told == expected


def test_a_path_through_the_folder_of_a_library_is_told_loudly_once(tmp_path):
    include = "#include <opencv4/opencv2/core.hpp>\n"
    files = {"a_DOT_cpp": include, "b_DOT_cpp": include, "cmake": "add_library(sled a.cpp b.cpp)\n"}
    told = severities(tmp_path, "removed-header", "opencv4/opencv2/core.hpp", "noetic", **files)
    assert told == {"warning", "note"}
