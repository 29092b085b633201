"""missing-install: a target that is used or exported is not installed.

What it does
    Compares the install rules of CMake with what the package offers: executables that launch files start, or beside
    others that are installed, libraries that are exported, linked by installed ones, or named as plugins, and programs
    and libraries of a package that installs no target at all.

Why it breaks
    Everything works from the build tree (catkin's devel space, symlinked installs), and the installed robot lacks it.

Severity
    error where the installed package is sure to fail: a library that catkin_package() exports beside installed ones, a
    program that an installed launch file starts in any case (in ROS 1 where others are installed). warning otherwise:
    in a workspace that is never installed all of this works. Where more than three programs of a package are not
    installed beside others, or where none at all is, one of them is enough, and the rest are notes; so is all that is
    no error in ROS 1 where the distro has ended, since nothing is released into it any more.

Example
    add_executable(udp_socket_node src/udp_socket_node.cpp)     # and install(TARGETS tcp_socket_node ...)

Use instead
    install(TARGETS tcp_socket_node udp_socket_node ...)

Not reported
    Tests, examples and benchmarks; static libraries that other targets link; packages without CMake; packages of ROS 1
    that install no target and were never released.
"""

import posixpath
import re

from ...model.cmake.build import BuildTarget, is_for_tests
from ...model.package import find_folder_role
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Together, rule
from .install_rules import is_installed, list_install_doubts, list_references, read_installs

_ONCE, _STARTED = (Together("no target installed"),), (Together("no target installed", few=3),)
_HABIT = (Together("program not installed", few=3),)
_TARGETS = "add it to install(TARGETS ...)[[, where nothing sets `{unset}`]]"


@rule(
    texts={
        "started": Text("`{subject}` is not installed, although a launch file starts it", _TARGETS),
        "exported": Text("`{subject}` is not installed, although it is exported", _TARGETS),
        "plugin": Text("`{subject}` is not installed, although a plugin description names it", _TARGETS),
        "linked": Text("`{subject}` is not installed, although an installed target links it", _TARGETS),
        "program": Text("`{subject}` is not installed, although other executables are", _TARGETS),
        "nothing": Text("`{subject}` is not installed: `{package}` installs no target at all", _TARGETS),
    },
)
def missing_install(view: TargetView, package: Package):
    installs = read_installs(view, package)
    if installs is None:
        return
    started = list_references(view, package, "executable")
    unset = {f"${{{use.name}}}" for use in package.build.uses if use.kind == "unset"}
    installed = package.build.installed_targets - unset
    if any("$" in item for item in installed) or (any(i.kind == "export" for i in installs) and not installed):
        return
    exported = {e.item for e in package.build.exports if e.how == "libraries"}
    plugins = {plugin.library_name for _, plugin in package.linked.plugins}
    linked = {link.item for t in package.build.targets if t.name in installed for link in t.links if link.how == "link"}
    for target in package.build.targets:
        if (
            target.name in installed
            or target.kind not in ("executable", "library", "module")
            or not view.is_sure(target.conditions)
            or is_for_tests(target.conditions)
        ):
            continue
        name = target.output_name or target.name
        why = None
        if target.kind == "executable" and name in started:
            why = "started"
        elif target.kind != "executable" and (target.name in exported or name in exported):
            why = "exported"
        elif target.kind != "executable" and (target.name in plugins or name in plugins):
            why = "plugin"
        elif target.kind == "library" and target.name in linked and not target.archive:
            why = "linked"
        elif target.kind == "executable" and any(
            t.name in installed for t in package.build.targets if t.kind == "executable"
        ):
            why = "program"
        elif not installed and not _is_used(package, target) and _is_to_be_installed(view, package, installs):
            why = "nothing"
        if why and (why == "started" or not _is_aside(package, target)):
            # Who finds a package that exports a library stops where the library is neither a target nor installed, and
            # ROS 2 starts nothing that is not installed.
            started_anyway = why == "started" and _is_started(view, package, name)
            stops = (installed and why == "exported") or ((installed or view.target.ros == 2) and started_anyway)
            sure = stops and not (unset or package.build.unresolved)
            doubts = () if sure else (Doubt.DISTURBS, *list_install_doubts(view, package))
            together = {"nothing": _ONCE, "program": _HABIT}.get(why, () if installed else _STARTED)
            data = {"unset": min(unset, default="")}
            yield Diagnostic(target.at, name, package.name, data, kind=why, doubts=doubts, together=together)


def _is_to_be_installed(view: TargetView, package: Package, installs) -> bool:
    """Whether the programs of a package are of use only where they are installed: ros2 run finds no others, and a
    Debian package holds no others."""
    if package.build.unresolved or any("$" in item for install in installs for item in install.items):
        return False
    return view.target.ros == 2 or view.target.was_ever_released(package.name)


def _is_used(package: Package, target: BuildTarget) -> bool:
    """Whether a library is of use without an install rule, as targets link it that are no tests, or nonexistent-export
    tells that it is exported."""
    if target.kind == "executable":
        return False
    names = {target.name, *(t.name for t in package.build.targets if t.alias_of == target.name)}
    links = (link for t in package.build.targets if not is_for_tests(t.conditions) for link in t.links)
    exported = (e.item for e in package.build.exports if e.how == "ament_export_libraries")
    return not names.isdisjoint((*(link.item for link in links if link.how != "order"), *exported))


def _is_started(view: TargetView, package: Package, name: str) -> bool:
    """True when an installed launch file starts a program of the package in any case."""
    for other in view.list_built():
        installs = [i for i in other.build.installs if view.is_sure(i.conditions)]
        for use in other.linked.references:
            r = use.reference
            if (r.package, r.name, r.kind, use.role) != (package.name, name, "executable", "run") or r.conditional:
                continue
            if "launch" in posixpath.basename(use.at.path) and is_installed(installs, use.at.path):
                return True
    return False


def _is_aside(package: Package, target) -> bool:
    roles = [find_folder_role(package.strip_path(path)) for path in (target.at.path, *target.sources)]
    if roles[0] or re.search(r"(^|_)(test|tests|example|demo|benchmark)(_|$)", target.name):
        return True
    return len(roles) > 1 and all(roles)
