"""find-order: a package is found before the one that brings its find module.

What it does
    Reports find_package calls whose name is answered by a find module that another package installs
    (eigen3_cmake_module, cmake_modules, python_cmake_module ...), when that package is found later in the same run.

Why it breaks
    Find modules are on CMAKE_MODULE_PATH only after the package that brings them was found. Before, CMake looks for a
    configuration of the library's own, which not every platform has.

Severity
    warning.

Example
    find_package(Eigen3 REQUIRED)
    find_package(eigen3_cmake_module REQUIRED)

Use instead
    find_package(eigen3_cmake_module REQUIRED)
    find_package(Eigen3 REQUIRED)

Not reported
    Packages under a condition that is unknown on the target, and find modules that the tree itself carries.
"""

import re

from ...model.view import TargetView
from ...model.workspace import Package
from ..rule import Diagnostic, Text, rule

# How packages that install find modules are called.
_BRINGS_MODULES = re.compile(r"cmake_modules?\Z")


@rule(
    severity="warning",
    texts=Text(
        "`{found}` is found before `{subject}`, which provides its find module",
        "call find_package({subject} REQUIRED) first",
    ),
)
def find_order(view: TargetView, package: Package):
    own = {name.rsplit("/", 1)[-1] for name in package.files if name.endswith(".cmake")}
    asked = [f for f in package.build.found if f.how in ("find_package", "catkin") and view.certain(f.conditions)]
    place = {}
    for number, found in enumerate(asked):
        place.setdefault(found.name, number)
    for number, found in enumerate(asked):
        if place[found.name] != number or found.how != "find_package" or f"Find{found.name}.cmake" in own:
            continue
        later = next(
            (
                p.name
                for p in view.cmake(found.name)
                if p.kind == "ros" and _BRINGS_MODULES.search(p.name) and place.get(p.name, -1) > number
            ),
            "",
        )
        if later and not found.via:
            yield Diagnostic(found.at, later, package.name, {"found": found.name})
