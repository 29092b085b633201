"""Nodes of behaviour trees in the surface of a package: those of installed libraries, compiled in a release."""

import textwrap

from rosimpact.databuild.surface.package import build_surfaces
from rosimpact.impact.facts.store import Store
from rosimpact.impact.targets.surface.surface import TREE_NODE, Plugin
from rosimpact.impact.tree import WorkingTree

MANIFEST = """<package format="3"><name>arm</name><version>1.2.3</version><description>d</description>
<maintainer email="a@b.c">m</maintainer><license>l</license>
<buildtool_depend condition="$ROS_VERSION == 1">catkin</buildtool_depend>
<buildtool_depend condition="$ROS_VERSION == 2">ament_cmake</buildtool_depend>
<export><build_type condition="$ROS_VERSION == 1">catkin</build_type>
<build_type condition="$ROS_VERSION == 2">ament_cmake</build_type></export></package>"""
CMAKE = """
cmake_minimum_required(VERSION 3.16)
project(arm)
find_package(catkin)
add_library(nodes SHARED src/nodes.cpp)
add_library(samples SHARED src/samples.cpp)
add_executable(show src/show.cpp)
install(TARGETS nodes DESTINATION lib)
install(TARGETS samples DESTINATION share/arm/samples)
catkin_package()
"""
NODES = """
void add(Factory & factory)
{
  factory.registerNodeType<arm::Wave>("Wave");
#ifdef OLD_NAMES
  factory.registerNodeType<arm::Wave>("WaveStar");
#endif
#if 0
  factory.registerNodeType<arm::Never>("Never");
#endif
  factory.registerNodeType<arm::Some>(name);
}
"""


def test_what_installed_libraries_register(tmp_path):
    files = {"package.xml": MANIFEST, "CMakeLists.txt": CMAKE, "src/nodes.cpp": NODES}
    files["src/samples.cpp"] = 'void add(F & f) { f.registerNodeType<A>("Sample"); }'
    files["src/show.cpp"] = 'int main() { F f; f.registerNodeType<A>("Show"); }'
    for path, text in files.items():
        (tmp_path / "arm" / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "arm" / path).write_text(textwrap.dedent(text))
    with Store(tmp_path / "cache") as store:
        surface = build_surfaces(WorkingTree(tmp_path), store, 1)["arm"]
    assert surface.build.plugins == (
        Plugin("Wave", "arm::Wave", TREE_NODE), Plugin("WaveStar", "arm::Wave", TREE_NODE, False),
    )  # fmt: skip
    # It calls catkin_package() in what is read of its CMake, and its manifest says that it is for both.
    assert surface.build.build_type == "ament_cmake"
