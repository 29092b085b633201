"""refused-cmake-name: CMake rejects the name of a package, target or command.

What it does
    Reports names that CMake never accepts: find_package() of an imported target or of a package of Debian, a second
    target with the same name, a name that is given include directories or libraries and is no target, or not yet, or
    that only branches for other distros add, a project that is not called as package.xml calls the package, a target
    that is linked with keywords and without, a property of a target whose value is an unset version, a version of the
    project under the policies of a CMake before 3.0, commands that are misspelt by a letter, and target names with a
    slash, including those that install_python_package() makes from its argument.

Why it breaks
    CMake finds no package `a::b` or `liba-dev`, since no configuration file has such a name. It stops at a second
    target with the same name, at what is no target, and at a target name with a slash; catkin_package() and
    ament_package() stop at another name of the project.

Severity
    error where CMake always stops; warning where CMake may not reach the place, and for packages that are not REQUIRED.

Example
    find_package(MANIF::manif REQUIRED)

Use instead
    find_package(manif REQUIRED)

Not reported
    Targets of different branches of an if(), and those under if(NOT TARGET ...); names that cannot be resolved, and
    targets that a command which is not known may add.
"""

from collections.abc import Iterator

from ...facts.condition import Condition
from ...model.cmake.build import RefusedName
from ...model.cmake.conditions import make_version_key
from ...model.cmake.interpreter import HANDLERS, WRAPPERS
from ...model.cmake.names import COMMANDS
from ...model.misspelling import is_slip
from ...targets.version import is_at_least
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, list_place_doubts, rule

# From here on install_python_package() makes custom targets. Source: commit 42b972e of ament_cmake.
_MAKES_TARGETS = "1.1.0"
_KNOWN = (COMMANDS, HANDLERS, WRAPPERS)
# Letters of a command: shorter ones are alike by chance.
_SHORTEST = 8


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
        "command": Text("`{subject}` is not a command of CMake or of a known package", "did you mean `{replacement}`?"),
        "project": Text(
            "the project is called `{subject}`, but package.xml names the package `{package}`, so CMake stops",
            "project({package})",
        ),
        "version": Text(
            "project({subject}) with a version needs cmake_minimum_required(VERSION 3.0) or newer, so CMake stops",
            "ask for CMake 3.0 or newer",
        ),
        "no target": Text("`{subject}` is not a CMake target, so CMake stops", "name a target that the package adds"),
        "too early": Text("`{subject}` is used as a target before it is added, so CMake stops", "add the target first"),
        "branch": Text(
            "`{subject}` is no target on {distro}, since other distros alone add it, so CMake stops",
            "add the target on {distro} too",
        ),
        "mixed": Text(
            "`{subject}` is linked with PUBLIC or PRIVATE and without, so CMake stops",
            "write the keyword in all calls of target_link_libraries() and ament_target_dependencies(), or in none",
        ),
        "no value": Text(
            "`{subject}` is empty, so a target property has no value and CMake stops",
            "give project() a version",
        ),
        "slash": Text("target name `{subject}` contains a slash", "remove the slash from the name"),
    },
)
def refused_cmake_name(view: TargetView, package: Package):
    build = package.build
    for found in build.found:
        if found.how not in ("find_package", "catkin") or not view.applies(found.conditions):
            continue
        kind = "target" if "::" in found.name else "debian" if _is_of_debian(view, package, found.name) else ""
        if kind:
            doubts = (*list_place_doubts(view, "build", found.conditions), found.required or Doubt.OPTIONAL)
            yield Diagnostic(found.at, found.name, package.name, kind=kind, doubts=doubts)
    seen = set()
    for kind, refused in _list_refused(package):
        # In other branches a target is made on other machines alone.
        if refused.kind == "branch" and (
            any(map(view.applies, refused.ways)) or not any(map(_asks_for_distro, refused.ways))
        ):
            continue
        if refused.name not in seen and view.applies(refused.conditions):
            seen.add(refused.name)
            doubts = list_place_doubts(view, "build", refused.conditions)
            data = {"package": package.name, "distro": view.target.distro}
            yield Diagnostic(refused.at, refused.name, package.name, data, kind, doubts)
    yield from _list_misspelt(view, package)
    refused = ("custom", "executable", "library") if _find_policy_version(package) >= (3,) else ("custom",)
    slashed = [(target.name, target.at, target.conditions) for target in build.targets if target.kind in refused]
    if (
        is_at_least(view.target.find_version("ament_cmake_python") or "0", _MAKES_TARGETS)
        and package.build_type != "catkin"
    ):
        slashed += [(i.destination, i.at, i.conditions) for i in build.installs if i.kind == "python"]
    for name, at, conditions in slashed:
        if "/" in name and "$" not in name and view.applies(conditions):
            yield Diagnostic(at, name, package.name, kind="slash", doubts=list_place_doubts(view, "build", conditions))


def _list_misspelt(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    """Calls of commands that are known to nobody, and one letter off one that is."""
    build, of_packages = package.build, view.providers.commands.get(view.target.ros, {})
    seen = set()
    for use in build.uses:
        if use.kind != "command" or use.name in seen or any(use.name in known for known in (*_KNOWN, of_packages)):
            continue
        seen.add(use.name)
        meant = {name for known in (*_KNOWN, of_packages) for name in known if is_slip(use.name, name)}
        if len(use.name) >= _SHORTEST and len(meant) == 1 and view.applies(use.conditions):
            complete = not build.unresolved and not view.unknown_contents.list_unknown_found(package)
            doubts = (*list_place_doubts(view, "build", use.conditions), complete or Doubt.INCOMPLETE)
            yield Diagnostic(use.at, use.name, package.name, {"replacement": meant.pop()}, "command", doubts)


def _list_refused(package: Package) -> Iterator[tuple[str, RefusedName]]:
    """The names at which the commands stop that are given them, with the kind of text; none that what is not read may
    make or set."""
    build = package.build
    hidden = build.unresolved or any(t.kind in ("external", "fetched") or t.name.endswith("()") for t in build.targets)
    added = {target.name for target in build.targets if target.kind != "unknown"}
    for refused in build.refused:
        early = refused.kind == "no target" and refused.name in added
        if refused.kind in ("twice", "project", "mixed", "version") or not hidden:
            yield "too early" if early else refused.kind, refused


def _asks_for_distro(conditions: tuple[Condition, ...]) -> bool:
    return any("ROS_DISTRO" in condition.text for condition in conditions)


def _is_of_debian(view: TargetView, package: Package, name: str) -> bool:
    """Whether a name is that of a Debian package which is not known to have a configuration of this name."""
    if not (name.endswith("-dev") or name.startswith("python3-")) or name in view.workspace.find_modules:
        return False
    known = view.target.knows_key(name) or view.providers.knows_system((name,))
    return known and not view.find_cmake(name) and not view.is_package(name) and not package.build.unresolved


def _find_policy_version(package: Package) -> tuple[int, ...]:
    """The version whose policies CMake follows; from 3.0 on it refuses a slash in any name (CMP0037)."""
    lower, _, upper = (package.build.minimum or ("", None))[0].partition("...")
    return make_version_key(upper or lower)
