"""Which components CMake packages list themselves: VTK's configuration, and what Gazebo's libraries add."""

import pytest
from rosimpact.databuild.components import list_added, read_listed
from rosimpact.impact.facts.cmake import extract
from rosimpact.impact.targets.distro.distro import DistroTarget
from rosimpact.impact.targets.providers.components import find_missing_component, load_components


def test_a_configuration_lists_its_components():
    listed = b'set("${CMAKE_FIND_PACKAGE_NAME}_AVAILABLE_COMPONENTS" "CommonCore;vtksys;eigen")\n'
    members = {"usr/lib/cmake/vtk-9.1/vtk-config.cmake": listed, "usr/lib/cmake/vtk-9.1/other.cmake": b"set(A B)"}
    assert read_listed(members) == {"CommonCore", "vtksys", "eigen"}


@pytest.mark.parametrize(
    ("files", "added"),
    [
        (["gz_add_component(events SOURCES a.cc)\nign_add_component(io)"], {"events", "io"}),
        (["set(engine_name dart-plugin)\ngz_add_component(${engine_name})"], {"dart-plugin"}),
        # A function adds one for each of its calls, in whatever file.
        (
            [
                "function(gz_add_system system_name)\nset(system_name ${system_name}-system)\n"
                "gz_add_component(${system_name} SOURCES b.cc)\nendfunction()",
                "gz_add_system(imu SOURCES imu.cc)\nGZ_ADD_SYSTEM(wind)",
            ],
            {"imu-system", "wind-system"},
        ),
        (["add_library(core a.cc)"], set()),
        (["foreach(each ${all})\ngz_add_component(${each})\nendforeach()", "gz_add_component(io)"], None),
    ],
)
def test_components_that_cmake_files_add(files, added):
    assert list_added(extract(text.encode()).commands for text in files) == added


@pytest.mark.parametrize(
    ("distro", "package", "component", "near"),
    [
        ("humble", "VTK", "vtkRenderingOpenGL", "RenderingOpenGL2"),
        ("jazzy", "VTK", "commoncore", "CommonCore"),
        ("jazzy", "gz-common5", "graphic", "graphics"),
        ("humble", "ignition-common4", "geospatial", ""),
    ],
)
def test_components_that_a_target_lacks(distro, package, component, near):
    found = find_missing_component(DistroTarget(distro), package, component)
    assert found is not None and found.near == near


@pytest.mark.parametrize(
    ("distro", "package", "component"),
    [
        ("humble", "VTK", "RenderingOpenGL2"),
        ("humble", "VTK", "vtkCommonCore"),
        ("humble", "VTK", "vtksys"),
        # Of VTK 7, of other systems, and of packages that list none, nothing is known.
        ("noetic", "VTK", "CommonNothing"),
        ("jazzy", "gz-common5", "graphics"),
        ("jazzy", "gz-common5", "all"),
        ("jazzy", "gz-nothing1", "graphics"),
    ],
)
def test_components_that_a_target_has_or_may_have(distro, package, component):
    assert find_missing_component(DistroTarget(distro), package, component) is None


def test_another_version_than_the_platforms_tells_nothing():
    target = DistroTarget("humble", versions={"vtk": "9.9"})
    assert find_missing_component(target, "VTK", "vtkRenderingOpenGL") is None


def test_both_names_of_a_library_have_the_same_components():
    always = load_components().always
    assert always["gz-math6"] == always["ignition-math6"] == "eigen3"
