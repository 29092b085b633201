"""refused-cmake-name: CMake rejects the name of a target, since it contains a slash.

What it does
    Reports targets with a slash in their names, including those that install_python_package() makes from its argument.

Why it breaks
    CMake stops: "The target name is reserved or not valid for certain CMake features".

Severity
    error; warning where CMake may not reach the place.

Example
    ament_python_install_package(scripts/)

Use instead
    ament_python_install_package(scripts)

Not reported
    Programs and libraries under the policies of a CMake before 3.0, which only warns of them.
"""

from ...targets.version import is_at_least
from ..vocabulary import Diagnostic, Package, TargetView, Text, list_place_doubts, rule
from .refused_names import find_policy_version

# From here on install_python_package() makes custom targets. Source: commit 42b972e of ament_cmake.
_MAKES_TARGETS = "1.1.0"


@rule(preview=True, texts=Text("target name `{subject}` contains a slash", "remove the slash from the name"))
def refused_cmake_name(view: TargetView, package: Package):
    build = package.build
    refused = ("custom", "executable", "library") if find_policy_version(package) >= (3,) else ("custom",)
    slashed = [(target.name, target.at, target.conditions) for target in build.targets if target.kind in refused]
    version = view.target.find_version("ament_cmake_python") or "0"
    if is_at_least(version, _MAKES_TARGETS) and package.build_type != "catkin":
        slashed += [(i.destination, i.at, i.conditions) for i in build.installs if i.kind == "python"]
    for name, at, conditions in slashed:
        if "/" in name and "$" not in name:
            yield Diagnostic(at, name, package.name, doubts=list_place_doubts(view, "build", conditions))
