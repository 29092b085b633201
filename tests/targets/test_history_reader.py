"""Surfaces of packages read from git trees: a small repository with the layouts that ROS packages have."""

import pygit2
import pytest
from rosimpact.databuild.history import SurfaceReader

FILES = {
    "core/package.xml": "<package><name>demo_core</name></package>",
    "core/include/demo_core/node.h": "",
    "core/include/demo/other.hpp": "",
    "core/planning/include/demo/deep.h": "",
    "core/include/demo_core/version.h.in": "",
    "core/test/include/demo_core/fixture.h": "",
    "core/src/private.h": "",
    "core/src/demo_tools/__init__.py": "",
    "core/src/demo_core/__init__.py": "",
    "core/nested/package.xml": "<package><name>hidden</name></package>",
    "view/package.xml": "<package><name>demo_view</name></package>",
    "view/src/demo_view/CMakeLists.txt": "install(DIRECTORY ./ DESTINATION ${CATKIN_PACKAGE_INCLUDE_DESTINATION})",
    "view/src/demo_view/panel.h": "",
    "old/package.xml": "<package><name>demo_old</name></package>",
    "old/include/demo_old/Thing.h": "",
    "old/cmake/demo_old-extras.cmake.installspace.in": 'list(APPEND @PROJECT_NAME@_INCLUDE_DIRS "include/demo_old")',
    "vendor/package.xml": "<package><name>foo_vendor</name></package>",
    "vendor/cmake/FindFoo.cmake": "",
    "examples/package.xml": "<package><name>demo_example</name></package>",
    "broken/package.xml": "no manifest",
}


@pytest.fixture
def surfaces(tmp_path):
    repository = pygit2.init_repository(str(tmp_path), bare=True)
    index = pygit2.Index()
    for path, text in FILES.items():
        index.add(pygit2.IndexEntry(path, repository.create_blob(text.encode()), pygit2.enums.FileMode.BLOB))
    tree = repository[index.write_tree(repository)]
    return {surface.name: surface for surface in SurfaceReader(repository).read_packages(tree)}


def test_packages_as_colcon_finds_them(surfaces):
    assert sorted(surfaces) == ["demo_core", "demo_old", "demo_view", "foo_vendor"]


@pytest.mark.parametrize(
    ("package", "headers"),
    [
        ("demo_core", {"demo_core/node.h", "demo/other.hpp", "demo/deep.h", "demo_core/version.h"}),
        ("demo_view", {"demo_view/panel.h"}),  # installed from where the source lies
        ("demo_old", {"demo_old/Thing.h", "Thing.h"}),  # its CMake extras put the folder on the path
        ("foo_vendor", set()),
    ],
)
def test_headers(surfaces, package, headers):
    assert surfaces[package].headers == headers


def test_modules_and_cmake_names_that_differ_from_the_package(surfaces):
    assert surfaces["demo_core"].modules == {"demo_tools"}
    assert surfaces["foo_vendor"].cmake == {"Foo"}
