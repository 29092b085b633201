"""The CMake interpreter: values, conditions, control flow, and what each family of commands means."""

from __future__ import annotations

from collections.abc import Callable

from ...facts.cmake import CMakeFile
from . import ament, catkin, find, install, language, lists, paths, targets
from .interpreter import Interpreter
from .package import Build, Declared

# Importing these registers what their commands mean.
_FAMILIES = (language, lists, paths, find, targets, install, catkin, ament)


def interpret_package(
    package_path: str,
    read: Callable[[str], CMakeFile | None],
    exists: Callable[[str], bool],
    glob: Callable[[str, bool], list[str]],
    package: str,
    declared: Declared,
    extras: Callable[[str], tuple[str, ...]],
) -> Build:
    """See build.interpret()."""
    return Interpreter(package_path, read, exists, glob, package, declared, extras).run()
