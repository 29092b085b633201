"""find-order: a package is found before what it needs.

What it does
    Reports find_package calls whose name is answered by a find module that another package installs
    (eigen3_cmake_module, cmake_modules, python_cmake_module ...), when that package is found later in the same run; and
    pybind11_add_module() after find_package(ament_cmake), where Python3 is not found with its component Development.

Why it breaks
    Find modules are on CMAKE_MODULE_PATH only after the package that brings them was found. Before, CMake looks for a
    configuration of the library's own, which not every platform has. Since 1.2.0 ament_cmake finds the interpreter of
    Python3 alone; pybind11 from 2.6 on then looks for nothing itself, and CMake stops: "Unknown CMake command
    python3_add_library".

Example
    find_package(Eigen3 REQUIRED)
    find_package(eigen3_cmake_module REQUIRED)

Use instead
    find_package(eigen3_cmake_module REQUIRED)
    find_package(Eigen3 REQUIRED)

Not reported
    Python, where generated interfaces or the module PythonExtra find it along; packages under a condition that is
    unknown on the target, and find modules that the tree itself carries.
"""

import re

from ...targets.version import is_at_least
from ..vocabulary import Diagnostic, Package, TargetView, Text, rule

# How packages that install find modules are called.
_BRINGS_MODULES = re.compile(r"cmake_modules?\Z")


@rule(
    severity="warning",
    texts={
        "module": Text(
            "`{found}` is found before `{subject}`, which provides its find module",
            "call find_package({subject} REQUIRED) first",
        ),
        "python": Text(
            "pybind11_add_module() of pybind11 {version} needs the component Development of `{subject}`, which is not "
            "found before",
            "call find_package({subject} REQUIRED COMPONENTS Interpreter Development) before find_package(pybind11)",
        ),
    },
)
def find_order(view: TargetView, package: Package):
    own = {name.rsplit("/", 1)[-1] for name in package.files if name.endswith(".cmake")}
    asked = [f for f in package.build.found if f.how in ("find_package", "catkin") and view.is_sure(f.conditions)]
    place = {}
    for number, found in enumerate(asked):
        place.setdefault(found.name, number)
    for number, found in enumerate(asked):
        if place[found.name] != number or found.how != "find_package" or f"Find{found.name}.cmake" in own:
            continue
        later = next(
            (
                p.name
                for p in view.find_cmake(found.name)
                if p.kind == "ros" and _BRINGS_MODULES.search(p.name) and place.get(p.name, -1) > number
            ),
            "",
        )
        if later and not found.via:
            yield Diagnostic(found.at, later, package.name, {"found": found.name}, "module")
    version = view.target.find_library("pybind11") or ""
    if _lacks_python(view, package, place) and is_at_least(version or "0", "2.6"):
        yield Diagnostic(asked[place["pybind11"]].at, "Python3", package.name, {"version": version}, "python")


# Since when ament_cmake finds Python3. Source: commit 0998713 of ament_cmake; pybind11's tools/pybind11Common.cmake.
_FINDS_PYTHON = "1.2.0"


def _lacks_python(view: TargetView, package: Package, place: dict[str, int]) -> bool:
    """Whether pybind11 finds the interpreter of Python3 that ament_cmake found, and nothing finds the rest. place: of
    the packages that CMake surely finds, in their order."""
    before = min((number for name, number in place.items() if name.startswith("ament_cmake")), default=None)
    if before is None or place.get("pybind11", -1) < before or package.build.generated:
        return False
    if not is_at_least(view.target.find_version("ament_cmake_core") or "0", _FINDS_PYTHON):
        return False
    found = package.build.found
    return (
        any(use.name == "pybind11_add_module" and view.is_sure(use.conditions) for use in package.build.uses)
        and not any(c.startswith("Development") for f in found for c in (*dict(f.components), *f.optional_components))
        and not any(t.kind in ("external", "fetched") and "pybind" in t.name.lower() for t in package.build.targets)
        and (
            "PythonExtra" not in place
            or not is_at_least(view.target.find_version("python_cmake_module") or "0", "0.11")
        )
    )
