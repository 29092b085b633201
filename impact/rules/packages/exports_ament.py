"""What an ament package leaves out of its exports: packages, libraries and components that dependants will miss."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...model.cmake.links import exported_targets, found_with, package_of, public_links
from ...model.view import View
from ...model.workspace import Package
from ...targets.version import at_least
from ..rule import Diagnostic
from ..severity import EXPORTED, Doubt, Together
from ..text import Text
from .dependants import links_without
from .find_targets import ONE_FOLDER

_HOWS = frozenset(
    {"ament_export_targets", "ament_export_libraries", "ament_export_include_directories", "ament_export_dependencies"}
)


_ADD = "add `{subject}` to ament_export_dependencies"
_COMPONENTS = "find it with its components in a file given to ament_package(CONFIG_EXTRAS ...)"
TEXTS = {
    "nothing": Text(
        "`{package}` installs headers but exports neither include directories nor a target",
        "call ament_export_targets or ament_export_include_directories",
    ),
    "link": Text("`{target}` links `{item}` publicly, but `{subject}` is not exported", _ADD),
    "include": Text("an installed header includes `{header}`, but `{subject}` is not exported", _ADD),
    "not installed": Text(
        "the exported library `{subject}` is not installed, so find_package({package}) stops",
        "add it to install(TARGETS ...)",
    ),
    "not built": Text(
        "the exported library `{subject}` is never built, so dependants are not linked to it",
        "export what the package builds, or drop it",
    ),
    "no components": Text(
        "dependants find `{subject}` without components, so its configuration stops", _COMPONENTS
    ),
    "component": Text(
        "`{target}` links `{item}` publicly, but dependants find {subject} without components", _COMPONENTS
    ),
    "include directory": Text(
        "an installed header includes `{header}`, but the include directory of `{subject}` is not exported",
        "export its package, or its include directories",
    ),
}


def list_unexported(view: View, package: Package) -> Iterator[Diagnostic]:
    """Everything that ament_export_*() of a package leaves out or names wrongly."""
    exports = [e for e in package.build.exports if view.active(e.conditions)]
    if not _HOWS & {e.how for e in exports}:
        yield from _list_nothing(view, package, exports)
        return
    if any(f.how == "ament_auto" for f in package.build.found):
        return
    if any("$" in e.item for e in exports if e.how == "ament_export_dependencies"):
        return
    named = {e.item for e in exports if e.how == "ament_export_dependencies"}
    named |= {f.name for f in package.build.handed_on}
    reach = found_with(view, named)
    seen: set[str] = set()
    yield from _passed_on(view, package, {name.lower() for name in reach}, seen)
    yield from _included(view, package, reach, exports, seen)
    yield from _never_built(view, package, exports)
    yield from _without_components(view, package, exports)
    yield from _off_path(view, package, exports, reach)


def _installed(package: Package) -> set[str]:
    return {item for rule_ in package.build.installs if rule_.kind == "targets" for item in rule_.items}


def _list_nothing(view: View, package: Package, exports) -> Iterator[Diagnostic]:
    """Headers and a library that are installed, and nothing that tells dependants where."""
    first = package.build.ament_package
    if not package.digest.public_headers or any(f.how == "ament_auto" for f in package.build.found) or first is None:
        return
    installed = _installed(package)
    if not any(t.kind in ("library", "interface") and t.name in installed for t in package.build.targets):
        return
    if not any("/include/" in f"/{h}" for h in package.digest.public_headers):
        return
    # Plugins of a base class of its own: it is there for others to include.
    own_base = any(e.how == "plugin_description" and e.context == package.name for e in exports)
    if package.name not in view.workspace.includers and not own_base:
        return
    subject = "ament_export_include_directories"
    yield Diagnostic(first, subject, package.name, kind="nothing", doubts=(Doubt.DISTURBS,))


# From this version on ament_target_dependencies() links targets where it linked libraries by their paths before.
# Source: CHANGELOG.rst of ament_cmake_target_dependencies.
_BY_TARGET = "0.9.0"


def _passed_on(
    view: View, package: Package, reach: set[str], seen: set[str]
) -> Iterator[Diagnostic]:
    """Packages that an exported target passes on, and that dependants are not seen to find: CMake stops at a target of
    theirs."""
    found = {f.name.lower(): f for f in package.build.found}
    by_target = at_least(view.target.version("ament_cmake_target_dependencies") or _BY_TARGET, _BY_TARGET)
    for target in exported_targets(package):
        if not view.certain(target.conditions):
            continue
        for link in public_links(target):
            name = _named_by(link) if by_target or link.how != "ament" else ""
            known = found.get(name.lower())
            if known is None or known.name in seen or known.name.lower() in reach or known.name == package.name:
                continue
            if not view.certain(link.conditions) or {p.name.lower() for p in view.cmake(known.name)} & reach:
                continue
            seen.add(known.name)
            item = link.item if link.how == "link" else known.name
            doubts = _doubts_of_passed_on(view, package, target, link, known.name)
            data = {"target": target.name, "item": item}
            few = Together("passed on", EXPORTED)
            yield Diagnostic(link.at, known.name, package.name, data, "link", doubts, together=few)


def _doubts_of_passed_on(view: View, package: Package, target, link, name: str) -> tuple[Doubt, ...]:
    if link.how == "ament" and _is_only_loaded(view, package):
        return (Doubt.UNCOMPILED,)
    if _comes_with_client_library(view, name):
        return (Doubt.DISPENSABLE,)
    other = view.workspace.packages.get(name)
    by_target = link.how == "link" or (
        other is not None and any(e.how == "ament_export_targets" for e in other.build.exports)
    )
    return () if by_target and links_without(view, package, target, name) else (Doubt.DISTURBS,)


def _comes_with_client_library(view: View, name: str) -> bool:
    """True for what comes along with the client library: dependants that build a node find it all the same."""
    return name in view.spread(("rclcpp",))


def _is_only_loaded(view: View, package: Package) -> bool:
    """True for a package of plugins that no package of the workspace looks for: it is loaded rather than linked."""
    plugins = any(e.how in ("plugin_description", "component") for e in package.build.exports)
    return plugins and not any(
        found.name == package.name for other in view.everyone() for found in other.build.found if other is not package
    )


def _named_by(link) -> str:
    """The package whose targets a link passes on; empty for libraries that are handed on by their paths."""
    if link.how == "ament":
        return "" if "$" in link.item else link.item
    if link.how != "link" or ("$" in link.item and not link.item.endswith("_TARGETS}")):
        return ""
    return package_of(link.item) if "::" in link.item or "$" in link.item else ""


def _included(
    view: View, package: Package, reach: frozenset[str], exports, seen: set[str]
) -> Iterator[Diagnostic]:
    """Packages that installed headers include."""
    hows = {e.how for e in exports}
    links = "ament_export_libraries" in hows or "ament_export_targets" in hows
    needed = links or package.name in view.workspace.includers
    found = {f.name for f in package.build.found}
    for need in view.weighed(package):
        if need.how != "include" or not need.public or not need.certain or view.answered(need.providers, reach):
            continue
        name = next((p.name for p in need.providers if p.name in found), "")
        if not name or name in seen or name == package.name or need.providers[0].kind != "ros":
            continue
        seen.add(name)
        # What the distro does not bring lies in a folder of its own there too.
        overlaid = name in view.workspace.packages or view.target.version(name) is None
        apart = view.target.distro not in ONE_FOLDER or overlaid
        missed = apart and needed and not _comes_with_client_library(view, name)
        doubts = (Doubt.DISTURBS, missed or Doubt.DISPENSABLE)
        few = Together("included", EXPORTED)
        yield Diagnostic(need.at, name, package.name, {"header": need.subject}, "include", doubts, together=few)


def _never_built(view: View, package: Package, exports) -> Iterator[Diagnostic]:
    """ament_export_libraries() of what no target makes, of which dependants are only warned, or of a target that is not
    installed, at which they stop."""
    targets = {t.name: t for t in package.build.targets if t.kind != "unknown"}
    names = {*targets, *(t.output_name for t in targets.values())}
    installed = _installed(package)
    if package.build.unresolved or any("$" in name for name in (*names, *installed)):
        return
    if any(t.kind in ("external", "fetched") for t in targets.values()):
        return  # another build system makes libraries of its own
    for export in exports:
        item = export.item
        if export.how != "ament_export_libraries" or re.search(r"[$/.:]|^-", item):
            continue
        if not view.certain(export.conditions):
            continue
        target = targets.get(item)
        if target is not None and target.kind == "library" and item not in installed and not target.alias_of:
            yield Diagnostic(export.at, item, package.name, kind="not installed")
        elif item not in names and (not view.cmake(item) or item == package.name):
            yield Diagnostic(export.at, item, package.name, kind="not built", doubts=(Doubt.DISTURBS,))


# Packages whose configuration defines targets for the components asked for alone, and of these the components that need
# not be asked for; and those that are not found at all without components. Source: FindBoost in cmake-modules(7);
# Qt5Config.cmake and Qt6Config.cmake.
_COMPONENTS_ALONE = {"Boost": frozenset({"boost", "headers"}), "Qt5": frozenset(), "Qt6": frozenset()}
_NONE_WITHOUT = frozenset({"Qt5", "Qt6"})


def _without_components(view: View, package: Package, exports) -> Iterator[Diagnostic]:
    """Targets of components that an exported target passes on, whose package dependants find without components."""
    handed = {f.name for f in package.build.handed_on if f.components}
    named = {e.item for e in exports if e.how == "ament_export_dependencies"}
    seen: set[str] = set()
    for export in exports:
        if export.how == "ament_export_dependencies" and export.item in _NONE_WITHOUT - handed - seen:
            seen.add(export.item)
            yield Diagnostic(export.at, export.item, package.name, kind="no components", doubts=(Doubt.DISTURBS,))
    for target in exported_targets(package):
        if not view.certain(target.conditions):
            continue
        for link in public_links(target):
            head = package_of(link.item)
            if head not in _COMPONENTS_ALONE or head in seen or head not in named or head in handed:
                continue
            asked = {name for f in package.build.found if f.name == head for name, _ in f.components}
            rest = link.item.partition("::")[2]
            names = ({rest} & asked if rest else asked if link.how == "ament" else set()) - _COMPONENTS_ALONE[head]
            if names:
                seen.add(head)
                data = {"target": target.name, "item": f"{head}::{min(names)}"}
                yield Diagnostic(link.at, head, package.name, data, "component", (Doubt.DISTURBS,))


# System libraries whose headers lie in a folder of their own that the compiler does not search by itself.
_OFF_PATH = frozenset({"eigen", "bullet", "libbullet-dev", "libpcl-all-dev", "libpcl-dev", "libogre-dev", "libxml2"})


def _off_path(view: View, package: Package, exports, reach: frozenset[str]) -> Iterator[Diagnostic]:
    """Header-only packages that leave the include folder of a system library out."""
    if any(e.how == "cfg_extras" for e in exports) or _installed(package):
        return
    seen = set()
    for need in view.weighed(package):
        name = need.providers[0].name
        if need.how != "include" or not need.public or not need.certain or name not in _OFF_PATH or name in seen:
            continue
        if view.answered(need.providers, reach) or any("$" in e.item for e in exports if "include" in e.how):
            continue
        seen.add(name)
        data = {"header": need.subject}
        yield Diagnostic(need.at, name, package.name, data, "include directory", (Doubt.DISTURBS,))
