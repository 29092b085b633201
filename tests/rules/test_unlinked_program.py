"""Programs that are linked to nothing which brings a library of ROS, and what brings it."""

from pathlib import Path

import pytest
from rosimpact.impact.analysis.check import check
from rosimpact.impact.analysis.session import Options

MANIFEST = (
    '<package format="2"><name>{name}</name><version>1.0.0</version><description>d</description>'
    '<maintainer email="robots@example.org">Robots</maintainer><license>MIT</license>'
    "<buildtool_depend>catkin</buildtool_depend><depend>roscpp</depend><depend>tf</depend><depend>laser_geometry</depend>"
    "<depend>image_transport</depend><depend>plough_tools</depend></package>"
)
LISTENS = "#include <tf/transform_listener.h>\nint main()\n{\n  tf::TransformListener listener;\n}\n"


def told(folder: Path, cmake: str, target: str = "noetic", tools: str = "", **sources: str) -> list[tuple[str, str]]:
    """(severity, subject) of what is said about links in a workspace of two packages, of which `plough` is built by
    `cmake`, and `plough_tools` exports `tools`."""
    files = {
        "plough/package.xml": MANIFEST.format(name="plough").replace("<depend>plough</depend>", ""),
        "plough/CMakeLists.txt": f"cmake_minimum_required(VERSION 3.0)\nproject(plough)\n{cmake}\ncatkin_package()\n",
        "plough_tools/package.xml": MANIFEST.format(name="plough_tools").replace("<depend>plough_tools</depend>", ""),
        "plough_tools/CMakeLists.txt": "cmake_minimum_required(VERSION 3.0)\nproject(plough_tools)\n"
        f"find_package(catkin REQUIRED COMPONENTS tf)\ncatkin_package({tools})\n",
        **{f"plough/{name.replace('_DOT_', '.')}": text for name, text in sources.items()},
    }
    for path, text in files.items():
        place = folder / path
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(text)
    options = Options(targets=(target,), select=("missing-find-package",), cache=folder / "cache", jobs=1)
    return [(f.severity, f.subject) for f in check(folder, options).findings if f.rule == "unlinked-package"]


LINKED = "add_executable(plough plough.cpp)\ntarget_link_libraries(plough ${catkin_LIBRARIES})\n"


@pytest.mark.parametrize(
    ("components", "tools", "expected"),
    [
        ("roscpp", "", [("warning", "tf")]),
        ("roscpp tf", "", []),
        ("laser_geometry", "", []),  # exports tf, as its released version does
        ("image_transport", "", [("warning", "tf")]),  # which does not
        ("plough_tools", "CATKIN_DEPENDS tf", []),
        ("plough_tools", "", [("warning", "tf")]),
    ],
)
def test_a_program_gets_what_its_components_export(components, tools, expected, tmp_path):
    cmake = f"find_package(catkin REQUIRED COMPONENTS {components})\n{LINKED}"
    assert told(tmp_path, cmake, tools=tools, plough_DOT_cpp=LISTENS) == expected


def test_a_component_that_the_target_has_not_got_may_export_anything(tmp_path):
    cmake = f"find_package(catkin REQUIRED COMPONENTS roscpp moveit_core)\n{LINKED}"
    assert told(tmp_path, cmake, "kinetic@2016-06-28", plough_DOT_cpp=LISTENS) == []


@pytest.mark.parametrize("target", ["indigo", "kinetic", "noetic"])
def test_what_a_library_of_the_package_misses_may_come_with_another(target, tmp_path):
    cmake = (
        "find_package(catkin REQUIRED COMPONENTS roscpp)\nadd_library(share share.cpp)\n"
        "add_executable(plough plough.cpp)\ntarget_link_libraries(plough share ${catkin_LIBRARIES})\n"
    )
    idle = "int main() {}\n"
    assert told(tmp_path, cmake, target, share_DOT_cpp=LISTENS, plough_DOT_cpp=idle) == []
    assert told(tmp_path, cmake, target, share_DOT_cpp=idle, plough_DOT_cpp=LISTENS) == [("warning", "tf")]


@pytest.mark.parametrize(
    "link",
    [
        "tf",  # by its name
        "${tf_LIBRARIES}",
        "/opt/ros/noetic/lib/libtf.so",
        "${EVERYTHING}",  # which nobody knows
    ],
)
def test_what_may_be_the_library_is_taken_for_it(link, tmp_path):
    cmake = (
        "find_package(catkin REQUIRED COMPONENTS roscpp)\nadd_executable(plough plough.cpp)\n"
        f"target_link_libraries(plough ${{catkin_LIBRARIES}} {link})\n"
    )
    assert told(tmp_path, cmake, plough_DOT_cpp=LISTENS) == []


def test_a_header_of_the_package_may_include_it_for_another_source(tmp_path):
    cmake = f"find_package(catkin REQUIRED COMPONENTS roscpp)\n{LINKED}"
    sources = {"share_DOT_h": LISTENS.splitlines()[0] + "\n", "plough_DOT_cpp": '#include "share.h"\nint main() {}\n'}
    assert told(tmp_path, cmake, **sources) == []


def test_headers_that_need_no_library_say_nothing(tmp_path):
    cmake = f"find_package(catkin REQUIRED COMPONENTS roscpp)\n{LINKED}"
    assert told(tmp_path, cmake, plough_DOT_cpp="#include <tf/transform_datatypes.h>\nint main() {}\n") == []


SHOWS = "#include <opencv2/highgui/highgui.hpp>\nint main() { cv::imshow(name, image); }\n"


@pytest.mark.parametrize(
    ("target", "components", "link", "expected"),
    [
        ("kinetic", "roscpp cv_bridge", "", {"error"}),
        ("noetic", "roscpp cv_bridge", "", {"error"}),
        ("noetic", "roscpp", "", {"error"}),
        ("indigo", "roscpp cv_bridge", "", set()),  # whose cv_bridge hands on all of OpenCV
        ("noetic", "roscpp cv_bridge image_geometry", "", set()),  # which does so to this day
        ("noetic", "roscpp cv_bridge plough_tools", "", set()),
        ("noetic", "roscpp cv_bridge", "${OpenCV_LIBRARIES}", set()),
        ("noetic", "roscpp cv_bridge", "opencv_highgui", set()),
        ("noetic", "roscpp cv_bridge", "${rtabmap_LIBRARIES}", set()),  # which may have it along
    ],
)
def test_functions_of_opencv_that_cv_bridge_does_not_hand_on(target, components, link, expected, tmp_path):
    cmake = (
        f"find_package(catkin REQUIRED COMPONENTS {components})\nfind_package(OpenCV REQUIRED)\n"
        f"find_package(RTABMap)\nadd_executable(plough plough.cpp)\n"
        f"target_link_libraries(plough ${{catkin_LIBRARIES}} {link})\n"
    )
    assert opencv(tmp_path, cmake, target, SHOWS) == expected


@pytest.mark.parametrize("call", ["cv::imwrite(name, image)", "cv::cvtColor(image, grey, code)", "my::imshow(image)"])
def test_functions_that_cv_bridge_hands_on(call, tmp_path):
    cmake = f"find_package(catkin REQUIRED COMPONENTS roscpp cv_bridge)\n{LINKED}"
    assert opencv(tmp_path, cmake, "noetic", SHOWS.replace("cv::imshow(name, image)", call)) == set()


def opencv(folder: Path, cmake: str, target: str, source: str) -> set[str]:
    told(folder, cmake, target, "DEPENDS OpenCV", plough_DOT_cpp=source)
    options = Options(targets=(target,), select=("library-component",), cache=folder / "cache", jobs=1)
    return {f.severity for f in check(folder, options).findings if f.subject == "OpenCV"}


OPTIONS = (
    "#include <boost/program_options.hpp>\n#include <ros/ros.h>\n"
    "int main() { boost::program_options::variables_map given; }\n"
)


@pytest.mark.parametrize(
    ("components", "boost", "expected"),
    [
        ("roscpp tf", "", {"error"}),  # hand on what they find of Boost themselves
        ("roscpp tf", "find_package(Boost REQUIRED COMPONENTS thread)", {"error"}),
        ("roscpp tf", "find_package(Boost REQUIRED COMPONENTS program_options)", set()),
        ("roscpp rosbag_storage", "", set()),  # which finds this part
        ("roscpp plough_tools", "", set()),  # which may have found anything
        ("roscpp", "find_package(PCL REQUIRED)", set()),
    ],
)
def test_a_part_of_boost_that_no_component_hands_on(components, boost, expected, tmp_path):
    cmake = (
        f"find_package(catkin REQUIRED COMPONENTS {components})\n{boost}\nadd_executable(plough plough.cpp)\n"
        "target_link_libraries(plough ${catkin_LIBRARIES} ${Boost_LIBRARIES})\n"
    )
    told(tmp_path, cmake, tools="DEPENDS Boost", plough_DOT_cpp=OPTIONS)
    options = Options(targets=("noetic",), select=("library-component",), cache=tmp_path / "cache", jobs=1)
    said = check(tmp_path, options).findings
    assert {f.severity for f in said if f.subject == "Boost::program_options"} == expected
