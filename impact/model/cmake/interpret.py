"""The CMake of one package interpreted without building it."""

from collections.abc import Callable, Mapping

from ...facts.cmake import CMakeFile
from ...facts.condition import Condition
from . import ament, catkin, catkin_simple, find, install, language, lists, paths, targets
from .build import Build, DeclaredPackages
from .interpreter import Interpreter

# Importing these registers what their commands mean.
_FAMILIES = (language, lists, paths, find, targets, install, catkin, catkin_simple, ament)


def interpret(
    package_path: str,
    read: Callable[[str], CMakeFile | None],
    exists: Callable[[str], bool | None],
    glob: Callable[[str, bool], list[str]],
    *,
    package: str = "",
    dependencies: tuple[str, ...] = (),
    test_dependencies: tuple[str, ...] = (),
    exported_dependencies: tuple[str, ...] | None = None,
    conditional_dependencies: Mapping[str, Condition] | None = None,
    extras: Callable[[str], tuple[str, ...]] = lambda _: (),
) -> Build:
    """Interprets the CMakeLists.txt of a package, and all that it includes, without building.

    All paths are posix paths relative to the workspace root, `` being the root. read gives the facts of a CMake file,
    None when there is none; exists tells about files (what is a folder is asked through glob); glob(pattern,
    recursive) lists the files that match a pattern whose last part may hold wildcards, in all folders below when
    recursive; neither is relied upon outside of the package. package: its name in package.xml. extras: the CMake files
    that another package of the workspace gives to those that find it, see list_extras().

    For ament_cmake_auto and ament_lint_auto, what package.xml declares: dependencies to build with (build and
    buildtool), test_dependencies, exported_dependencies (build_export, buildtool_export and exec; None counts all of
    `dependencies` as exported), and the conditions of conditional_dependencies, which nothing declares without one.

    Always returns; what could not be known or went beyond the bounds is in `unresolved`.
    """
    declared = DeclaredPackages(
        dependencies,
        test_dependencies,
        dependencies if exported_dependencies is None else exported_dependencies,
        conditional_dependencies or {},
    )
    return Interpreter(package_path, read, exists, glob, package, declared, extras).run()


def list_extras(package_path: str, glob: Callable[[str, bool], list[str]]) -> tuple[str, ...]:
    """The files from which dependants of a package get its functions and macros.

    These are all CMake files in its `cmake` folder and beside its CMakeLists.txt, templates included. The caller reads
    templates (`.cmake.in`, `.cmake.em`) as CMake.
    """
    base = f"{package_path}/" if package_path else ""
    found: dict[str, None] = {}
    for ending in (".cmake", ".cmake.in", ".cmake.em"):
        found.update(dict.fromkeys(sorted(glob(f"{base}*{ending}", False))))
        found.update(dict.fromkeys(sorted(glob(f"{base}cmake/*{ending}", True))))
    return tuple(found)
