"""missing-export: dependants of the package will miss a package that its targets or headers need.

What it does
    Compares the packages that a package of ament or plain CMake exports with those that dependants need: packages that
    installed headers include or that an exported target links publicly, and that are not exported.

Why it breaks
    The package builds, and every package that depends on it fails: CMake stops at a target that is not found, or the
    header's own includes are missing.

Severity
    error where a dependant of the workspace stops; warning where a dependant, or an exported target or library, needs
    what is missing; note otherwise.

Example
    ament_export_dependencies(rclcpp)           # and include/p/p.hpp includes angles/angles.h

Use instead
    ament_export_dependencies(rclcpp angles)

Not reported
    What an exported package brings in turn; packages that ament_auto exports; until Galactic, where all headers lay in
    one folder, a missing ament_export_dependencies is a note.
"""

from collections.abc import Iterator

from ...model.cmake.links import list_exported_targets, list_public_links, resolve_passed_package
from ...targets.version import is_at_least
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Together, rule
from .ament_exports import AmentExports, read_ament_exports
from .dependants import is_only_loaded, links_without
from .include_folders import shares_one_folder

_ONCE = (Together("not exported"),)
_EACH = (Together("not exported", few=3),)
_ADD = "add `{subject}` to ament_export_dependencies"


@rule(
    texts={
        "link": Text("`{target}` links `{item}` publicly, but `{subject}` is not exported", _ADD),
        "written": Text(
            "`{target}` links `{item}` publicly, but the configuration of `{package}` does not find `{subject}`",
            "call find_dependency({subject}) in the configuration",
        ),
        "include": Text("an installed header includes `{header}`, but `{subject}` is not exported", _ADD),
    },
)
def missing_export(view: TargetView, package: Package):
    ament = read_ament_exports(view, package)
    if ament is not None:
        seen: set[str] = set()
        yield from _list_linked(view, package, ament, seen)
        yield from _list_included(view, package, ament, seen)


# From this version on add_target_dependencies() links targets where it linked libraries by their paths before.
# Source: CHANGELOG.rst of ament_cmake_target_dependencies.
_BY_TARGET = "0.9.0"


def _list_linked(view: TargetView, package: Package, ament: AmentExports, seen: set[str]) -> Iterator[Diagnostic]:
    """Packages that an exported target passes on, and that dependants are not seen to find: CMake stops at a target of
    theirs."""
    reach = {name.lower() for name in ament.found}
    found = {f.name.lower(): f for f in package.build.found}
    by_target = is_at_least(view.target.find_version("ament_cmake_target_dependencies") or _BY_TARGET, _BY_TARGET)
    # A habit of those whose libraries are loaded; whoever links a library stops at each of them.
    together = _ONCE if is_only_loaded(view, package) else _EACH
    for target in list_exported_targets(package):
        if not view.is_sure(target.conditions):
            continue
        for link in list_public_links(target):
            name = resolve_passed_package(link) if by_target or link.how != "ament" else ""
            known = found.get(name.lower())
            if known is None or known.name in seen or known.name.lower() in reach or known.name == package.name:
                continue
            if not view.is_sure(link.conditions) or {p.name.lower() for p in view.find_cmake(known.name)} & reach:
                continue
            seen.add(known.name)
            item = link.item if link.how == "link" else known.name
            kind, doubts = "link", _collect_passed_on_doubts(view, package, target, link, known.name)
            data = {"target": target.name, "item": item}
            if package.build.ament_package is None:
                kind, doubts = "written", (Doubt.DISTURBS,)
            yield Diagnostic(link.at, known.name, package.name, data, kind, doubts, together=together)


def _collect_passed_on_doubts(view: TargetView, package: Package, target, link, name: str) -> tuple[Doubt, ...]:
    if is_only_loaded(view, package) and not package.linked.public_headers:
        return (Doubt.UNCOMPILED,)  # without headers nobody links it
    if view.roles.comes_with_client_library(name):
        return (Doubt.DISPENSABLE,)
    other = view.workspace.packages.get(name)
    by_target = link.how == "link" or (
        other is not None and any(e.how == "ament_export_targets" for e in other.build.exports)
    )
    return () if by_target and links_without(view, package, target, name) else (Doubt.DISTURBS,)


def _list_included(view: TargetView, package: Package, ament: AmentExports, seen: set[str]) -> Iterator[Diagnostic]:
    """Packages that installed headers include."""
    links = not ament.hows.isdisjoint(("ament_export_libraries", "ament_export_targets"))
    needed, loaded = links or package.name in view.workspace.includers, is_only_loaded(view, package)
    found = {f.name for f in package.build.found}
    for need in view.sort_needs(package):
        if need.how != "include" or not need.public or not need.certain or view.is_met(need.providers, ament.found):
            continue
        name = next((p.name for p in need.providers if p.name in found), "")
        if not name or name in seen or name == package.name or need.providers[0].kind != "ros":
            continue
        seen.add(name)
        # What the distro does not bring lies in a folder of its own there too.
        overlaid = name in view.workspace.packages or view.target.find_version(name) is None
        apart = overlaid or not shares_one_folder(view)
        missed = apart and needed and not loaded and not view.roles.comes_with_client_library(name)
        doubts = (Doubt.DISTURBS, missed or Doubt.DISPENSABLE)
        data = {"header": need.subject}
        yield Diagnostic(need.at, name, package.name, data, "include", doubts, together=_ONCE)
