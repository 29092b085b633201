"""unfound-command: a command of another package is called, but CMakeLists.txt never finds that package.

What it does
    Reports calls of functions and macros that a released package defines, where the caller finds neither that package
    nor one that brings it, or only for its tests, and configurations that call find_dependency() first of all and do
    not include its module.

Why it breaks
    CMake stops: "Unknown CMake command".

Severity
    error; warning where what is found happens to bring a declared package, though its CMake is not known to hand it on,
    where CMake may not reach the call, where a found package has unknown dependencies, and in ROS 1,
    where catkin_make configures all packages in one CMake run, so that another one may have found the package before;
    warning for configurations, which whoever finds them may have brought the macro.

Example
    project(visualizer)
    ament_package()                             # without find_package(ament_cmake REQUIRED)

Use instead
    find_package(ament_cmake REQUIRED)

Not reported
    Commands that the workspace defines; packages that find something that nobody is known to provide; test commands
    that no declared package brings (undeclared-test-command reports them).
"""

import re

from ....edges.memory import cache_in_derived
from ...model.cmake.build import is_for_tests
from ...model.unknown_contents import FINDING
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, list_place_doubts, rule
from .undeclared_test_command import find_test_commands


@rule(
    group="missing-find-package",
    texts={
        "": Text(
            "command `{subject}` comes from `{owner}`, which CMakeLists.txt does not find",
            "add find_package({owner} REQUIRED)",
        ),
        "lucky": Text(
            "command `{subject}` comes from `{owner}`, which CMakeLists.txt does not find; another package happens to "
            "bring it",
            "add find_package({owner} REQUIRED)",
        ),
        "configuration": Text(
            "the configuration calls {subject}() without including `{owner}`, which defines it",
            "add include({owner})",
        ),
    },
)
def unfound_command(view: TargetView, package: Package):
    for use in package.build.uses:
        written = use.name == "find_dependency" and re.search(r"onfig\.cmake(?:\.in)?\Z", use.at.path)
        if use.kind == "command" and written:
            data = {"owner": use.context}
            yield Diagnostic(use.at, use.name, package.name, data, "configuration", (Doubt.DISTURBS,))
            break
    build, commands = package.build, view.providers.commands.get(view.target.ros, {})
    calls = [use for use in build.uses if use.kind == "command" and use.name in commands]
    if not calls or not build.project or any("find_package(" in reason for _, reason in build.unresolved):
        return
    found = [f for f in build.found if f.how in FINDING]
    if view.unknown_contents.list_unknown_found(package):
        return
    seen = set()
    for use in calls:
        owners = commands[use.name].split()
        if owners == ["genmsg"] and build.generated:
            continue  # missing-message-generation reports it
        testing = is_for_tests(use.conditions)
        names = frozenset(f.name for f in found if testing or not is_for_tests(f.conditions))
        reached = _list_reached(view, package, names)
        if not any(view.is_available(owner) for owner in owners):
            continue
        if not reached.isdisjoint(owners):
            owner = _find_lucky(view, package, owners, names)
            if owner and owner not in seen:
                seen.add(owner)
                yield Diagnostic(use.at, use.name, package.name, {"owner": owner}, "lucky", (Doubt.LUCKY,))
            continue
        if use.name in find_test_commands(view) and view.build_environment(package).isdisjoint(owners):
            continue
        owner = _choose_name(view, package, owners)
        if owner not in seen:
            seen.add(owner)
            known = not build.unresolved and not view.unknown_contents.list_unknown(reached)
            doubts = (*list_place_doubts(view, "build", use.conditions), known or Doubt.INCOMPLETE)
            together = view.target.ros == 2 or Doubt.LUCKY
            yield Diagnostic(use.at, use.name, package.name, {"owner": owner}, doubts=(*doubts, together))


@cache_in_derived
def _list_reached(view: TargetView, package: Package, names: frozenset[str]) -> frozenset[str]:
    """What finding packages may bring."""
    return view.list_widest_dependencies(names) | view.roles.list_found_with(names) | {package.name}


def _find_lucky(view: TargetView, package: Package, owners: list[str], names: frozenset[str]) -> str:
    """What the manifest declares to have a command that none of what is found is known to hand on by its CMake, so that
    it comes along by chance; empty where there is none."""
    if package.build.unresolved or not view.roles.list_brought(names).isdisjoint((*owners, package.name)):
        return ""
    build = [name for name, kinds in view.collect_declared(package).items() if kinds & {"build", "buildtool"}]
    return next((n for n in build if n not in names and not view.roles.list_brought([n]).isdisjoint(owners)), "")


def _choose_name(view: TargetView, package: Package, owners: list[str]) -> str:
    """The package that one would look for: an owner, or what is declared and brings it (ament_cmake)."""
    declared = list(view.collect_declared(package))
    near = [name for name in declared if not view.list_transitive([name]).isdisjoint(owners)]
    near.sort(key=lambda name: (name not in owners, name != package.build_type))
    return near[0] if near else owners[0]
