"""The sources that nothing compiles, so that no node has their code."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

from ...facts.flow import FlowFile
from ..workspace import Package, Workspace
from .code import SOURCES

# What CMake makes itself is none of the sources that are there.
_MADE = ("${CMAKE_BINARY_DIR}/", "$<TARGET_OBJECTS:")
_BUILT_BY_CMAKE = frozenset(("ament_cmake", "catkin", "cmake"))


def find_uncompiled(workspace: Workspace, files: Mapping[str, FlowFile]) -> frozenset[str]:
    """The sources in C++ that no target of the workspace compiles and no file includes, in packages whose CMake says
    completely what it compiles. files: flow facts by path."""
    compiled = {path for package in workspace for target in package.build.targets for path in target.sources}
    included = {header.rpartition("/")[2] for file in files.values() for header in file.includes}
    return frozenset(
        path
        for package in workspace
        if _tells_sources(package)
        for path in _list_governed(package)
        if path in files and path not in compiled and path.rpartition("/")[2] not in included
    )


def _tells_sources(package: Package) -> bool:
    """Whether the CMake of a package says completely what it compiles."""
    build = package.build
    if not build.files or build.may_add_targets or package.build_type.partition(".")[0] not in _BUILT_BY_CMAKE:
        return False
    sources = (path for target in build.targets for path in target.sources)
    return not any("$" in path and not path.startswith(_MADE) for path in sources)


def _list_governed(package: Package) -> Iterator[str]:
    """The sources of a package, but for those in folders with a CMakeLists.txt that its build does not read."""
    read: Collection[str] = package.build.files
    others = tuple(
        path.removesuffix("CMakeLists.txt")
        for path in package.linked.files
        if path.endswith("/CMakeLists.txt") and path not in read
    )
    for path in package.linked.files:
        if path.endswith(SOURCES) and not path.startswith(others):
            yield path
