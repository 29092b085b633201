"""refused-cmake-name: CMake rejects the name of a package or target.

What it does
    Reports names that CMake never accepts: find_package() of an imported target or of a package of Debian, a second
    target with the same name, and target names with a slash, including those that ament_python_install_package() makes
    from its argument.

Why it breaks
    CMake finds no package `a::b` or `liba-dev`, since no configuration file has such a name. It stops at a second
    target with the same name and at a target name with a slash.

Severity
    error where CMake always stops; warning where CMake may not reach the place, and for packages that are not REQUIRED.

Example
    find_package(MANIF::manif REQUIRED)

Use instead
    find_package(manif REQUIRED)

Not reported
    Targets of different branches of an if(), and those under if(NOT TARGET ...); names that cannot be resolved.
"""

from ...model.cmake.conditions import version_key
from ...model.view import TargetView
from ...model.workspace import Package
from ...targets.version import at_least
from ..rule import Diagnostic, Doubt, Text, doubts_of_place, rule

# From here on ament_python_install_package() makes custom targets. Source: commit 42b972e of ament_cmake.
_MAKES_TARGETS = "1.1.0"


@rule(
    texts={
        "target": Text(
            "`{subject}` is a target, not a package", "call find_package() with the package that defines the target"
        ),
        "debian": Text(
            "`{subject}` is a package of Debian, not a CMake package",
            "declare it in package.xml, and call find_package() with the name of its CMake configuration",
        ),
        "twice": Text("a target named `{subject}` already exists", "rename one of the two targets"),
        "slash": Text("target name `{subject}` contains a slash", "remove the slash from the name"),
    },
)
def refused_cmake_name(view: TargetView, package: Package):
    build = package.build
    for found in build.found:
        if found.how not in ("find_package", "catkin") or not view.active(found.conditions):
            continue
        kind = "target" if "::" in found.name else "debian" if _is_of_debian(view, package, found.name) else ""
        if kind:
            doubts = (*doubts_of_place(view, "build", found.conditions), found.required or Doubt.OPTIONAL)
            yield Diagnostic(found.at, found.name, package.name, kind=kind, doubts=doubts)
    seen = set()
    for name, at, conditions in build.repeated:
        if name not in seen and view.active(conditions):
            seen.add(name)
            doubts = doubts_of_place(view, "build", conditions)
            yield Diagnostic(at, name, package.name, kind="twice", doubts=doubts)
    refused = ("custom", "executable", "library") if _find_policy_version(package) >= (3,) else ("custom",)
    slashed = [(target.name, target.at, target.conditions) for target in build.targets if target.kind in refused]
    if at_least(view.target.version("ament_cmake_python") or "0", _MAKES_TARGETS) and package.build_type != "catkin":
        slashed += [(i.destination, i.at, i.conditions) for i in build.installs if i.kind == "python"]
    for name, at, conditions in slashed:
        if "/" in name and "$" not in name and view.active(conditions):
            yield Diagnostic(at, name, package.name, kind="slash", doubts=doubts_of_place(view, "build", conditions))


def _is_of_debian(view: TargetView, package: Package, name: str) -> bool:
    """Whether a name is that of a Debian package which is not known to have a configuration of this name."""
    if not (name.endswith("-dev") or name.startswith("python3-")) or name in view.workspace.find_modules:
        return False
    known = view.target.known_key(name) or view.providers.knows_system((name,))
    return known and not view.cmake(name) and not view.is_package(name) and not package.build.unresolved


def _find_policy_version(package: Package) -> tuple[int, ...]:
    """The version whose policies CMake follows; from 3.0 on it refuses a slash in any name (CMP0037)."""
    lower, _, upper = (package.build.minimum or ("", None))[0].partition("...")
    return version_key(upper or lower)
