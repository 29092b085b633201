"""What is an error because nothing about it hangs on chance, where its neighbour is a warning."""

from pathlib import Path

import pytest
from rosimpact.impact.analysis.check import check
from rosimpact.impact.analysis.session import Options

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
        ("noetic", "", set()),  # no build runs it
        # Noetic's Python 3 lies ahead.
        ("melodic@2022-06-01", "catkin_add_nosetests(test/timing.py)\n", {"warning"}),
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
        ("ros::CallbackQueue * queue_;", "rviz", {"note"}),  # which is announced
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


@pytest.mark.parametrize(
    ("target", "includes", "use", "header", "expected"),
    [
        # libav 0.8 brings it, and 9 does not; log4cxx, behind ros.h, needs neither it nor Boost.
        ("hydro", "ros/ros.h libavcodec/avcodec.h", "av_free(place)", "libavutil/mem.h", set()),
        ("indigo", "ros/ros.h libavcodec/avcodec.h", "av_free(place)", "libavutil/mem.h", {"error"}),
        # Boost's whole header of pointers brought it later.
        ("hydro", "boost/smart_ptr.hpp", "boost::make_shared<int>(1)", "boost/make_shared.hpp", {"error"}),
        ("indigo", "boost/smart_ptr.hpp", "boost::make_shared<int>(1)", "boost/make_shared.hpp", set()),
        ("hydro", "boost/smart_ptr.hpp sled.hpp", "boost::make_shared<int>(1)", "boost/make_shared.hpp", set()),
        ("noetic", "boost/thread/mutex.hpp", "boost::bind(&run, 1)", "boost/bind.hpp", {"error"}),
        ("noetic", "boost/signals2.hpp", "boost::bind(&run, 1)", "boost/bind.hpp", set()),
    ],
)
def test_a_name_of_a_library_that_nothing_included_brings(target, includes, use, header, expected, tmp_path):
    told = severities(
        tmp_path, "missing-include", header, target, depend="roscpp", cmake="add_library(sled sled.cpp)\n",
        sled_DOT_cpp="".join(f"#include <{path}>\n" for path in includes.split()) + f"void sled() {{ {use}; }}\n",
    )  # fmt: skip
    assert told == expected


def test_a_path_through_the_folder_of_a_library_is_told_loudly_once(tmp_path):
    include = "#include <opencv4/opencv2/core.hpp>\n"
    files = {"a_DOT_cpp": include, "b_DOT_cpp": include, "cmake": "add_library(sled a.cpp b.cpp)\n"}
    told = severities(tmp_path, "removed-header", "opencv4/opencv2/core.hpp", "noetic", **files)
    assert told == {"warning", "note"}


@pytest.mark.parametrize(
    ("included", "source", "expected"),
    [
        ("geometry_msgs/Pose.h", "nav_msgs::PathConstPtr path;", {"error"}),
        ("nav_msgs/GetPlan.h", "nav_msgs::PathConstPtr path;", set()),  # a field of it
        ("tf/transform_listener.h", "geometry_msgs::PoseStamped pose;", set()),  # comes along, over many headers
        ("sled/unknown.h", "nav_msgs::PathConstPtr path;", set()),
        (
            "ros/message_forward.h",
            "namespace nav_msgs {\nROS_DECLARE_MESSAGE(Path)\n}\nnav_msgs::PathConstPtr path;",
            set(),
        ),
        ("geometry_msgs/Pose.h", "namespace sled { class Path; }\nnav_msgs::PathConstPtr path;", {"error"}),
        ("sensor_msgs/PointCloud2.h", "sensor_msgs::PointCloud2Modifier fields(cloud);", set()),  # is no message
    ],
)
def test_a_message_type_whose_header_nothing_brings(included, source, expected, tmp_path):
    told = severities(
        tmp_path, "missing-include", "nav_msgs/Path.h", "noetic", depend="geometry_msgs nav_msgs sensor_msgs tf",
        cmake="add_library(sled sled.cpp)\n", sled_DOT_cpp=f"#include <{included}>\n{source}\n",
    )  # fmt: skip
    assert told == expected


@pytest.mark.parametrize(
    ("name", "first", "expected"),
    [
        ("length_impl", "", {"warning"}),
        ("length_impl", "#include <nav_msgs/Path.h>\n", set()),
        ("length", "#include <nav_msgs/Path.h>\n", {"warning"}),  # which others may include by itself
    ],
)
def test_an_installed_header_that_only_another_header_includes(name, first, expected, tmp_path):
    told = severities(
        tmp_path, "missing-include", "nav_msgs/Path.h", "noetic", depend="nav_msgs",
        cmake="install(DIRECTORY include/${PROJECT_NAME}/ DESTINATION ${CATKIN_PACKAGE_INCLUDE_DESTINATION})\n",
        include__sled__sled_DOT_h=f"{first}#include <vector>\n#include <sled/{name}.h>\n",
        **{
            f"include__sled__{name}_DOT_h": "#pragma once\n"
            "inline bool any(nav_msgs::Path & path) { return path.poses.size(); }\n"
        },
    )  # fmt: skip
    assert told == expected


@pytest.mark.parametrize("opened", ["sled", "snow"])
def test_a_package_of_data_that_installs_none_of_it_works_in_the_devel_space(opened, tmp_path):
    launch = f'<launch><include file="$(find {opened})/launch/drive.launch" /></launch>\n'
    told = severities(tmp_path, "missing-install", "install", "noetic@2024-06-01", launch__sled_DOT_launch=launch)
    assert told == {"warning"}


@pytest.mark.parametrize(
    ("test", "expected"),
    [
        ("NOT glasses_FOUND", {"error"}),  # where they are not found nothing is built, and nothing breaks
        ("NOT cv_bridge_FOUND", {"error"}),
        ("NOT BUILD_SLED", {"warning"}),
        ("NOT turtlebot_teleop_FOUND", {"warning"}),  # which the target does not have
        ("NOT rclcpp_FOUND", set()),  # which is of ROS 2
    ],
)
def test_what_is_only_built_behind_a_gate(test, expected, tmp_path):
    told = severities(
        tmp_path, "removed-header", "opencv/cv.h", "noetic", depend="cv_bridge",
        cmake=f"if({test})\n  return()\nendif()\nadd_executable(sled sled.cpp)\n",
        sled_DOT_cpp="#include <opencv/cv.h>\n",
    )  # fmt: skip
    assert told == expected


@pytest.mark.parametrize(
    ("cmake", "include", "expected"),
    [
        ("find_package(Eigen REQUIRED)", "<vector>", {"error"}),
        ("find_package(Eigen)", "<Eigen/Core>", {"warning"}),
        ("find_package(Eigen)", "<vector>", {"note"}),
        ("find_package(Eigen)\nfind_package(PCL REQUIRED)", "<Eigen/Core>", {"note"}),  # brings its folder
        ("find_package(cmake_modules)\nfind_package(Eigen)", "<Eigen/Core>", set()),
    ],
)
def test_a_find_module_of_cmake_modules(cmake, include, expected, tmp_path):
    told = severities(
        tmp_path, "missing-find-package", "cmake_modules", "indigo",
        cmake=f"{cmake}\nadd_library(sled sled.cpp)\n", sled_DOT_cpp=f"#include {include}\n",
    )  # fmt: skip
    assert told == expected


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("std::ostringstream text;", {"error"}),
        ("void write(std::ostringstream & to);", set()),  # <vector> brings nothing, and others announce it
    ],
)
def test_a_stream_whose_header_nothing_brings(source, expected, tmp_path):
    told = severities(
        tmp_path, "missing-standard-include", "sstream", "noetic",
        cmake="add_library(sled sled.cpp)\n", sled_DOT_cpp=f"#include <vector>\n{source}\n",
    )  # fmt: skip
    assert told == expected


@pytest.mark.parametrize(
    ("more", "expected"),
    [
        ("", {"warning"}),
        ("include(ExternalProject)\nExternalProject_Add(rope GIT_REPOSITORY https://example.org/rope.git)\n", set()),
    ],
)
def test_an_exported_library_that_another_build_system_may_make(more, expected, tmp_path):
    export = "<export><build_type>ament_cmake</build_type></export></package>"
    manifest = MANIFEST.replace("<buildtool_depend>catkin</buildtool_depend>", "").replace("</package>", export)
    (tmp_path / "package.xml").write_text(manifest.replace("<depend>roscpp</depend><depend>rospy</depend>", ""))
    (tmp_path / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.8)\nproject(sled)\nfind_package(ament_cmake REQUIRED)\n"
        f"{more}ament_export_libraries(rope-core)\nament_package()\n"
    )
    options = Options(targets=("jazzy",), select=("missing-export",), cache=tmp_path / "cache", jobs=1)
    assert {f.severity for f in check(tmp_path, options).findings if f.subject == "rope-core"} == expected
