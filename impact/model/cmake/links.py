"""What the targets of a package are linked to, and what of it they pass on to those who link them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import lru_cache
from typing import TYPE_CHECKING

from ...targets.providers.library import standard_year
from .build import BuildTarget, Link

if TYPE_CHECKING:
    from ..view import View
    from ..workspace import Package

_OF_PACKAGE = re.compile(r"\$\{(.+?)_(?:LIBRARIES|TARGETS|INCLUDE_DIRS|INCLUDE_DIR|LIBRARY|LIBS|EXPORTED_TARGETS)\}")


@lru_cache(maxsize=10000)
def package_of(item: str) -> str:
    """The package that a link item stands for: `pkg::target`, `${pkg_LIBRARIES}`, or the item itself."""
    match = _OF_PACKAGE.match(item)
    return match.group(1) if match else item.partition("::")[0]


def may_hide(item: str, name: str) -> bool:
    """Whether an item with a variable that nothing sets may stand for a package: the texts around the variable have to
    allow it, and the variables that a found package sets stand for that package alone."""
    if "$" not in item:
        return False
    match = _OF_PACKAGE.fullmatch(item)
    if match is not None and "$" not in match.group(1):
        return match.group(1).lower() == name.lower()
    plain = re.split(r"\$(?:ENV)?\{[^{}]*\}", item)
    before, after = plain[0].lower(), plain[-1].lower().partition("::")[0]
    if not name.lower().startswith(before):
        return False
    return ("::" in plain[-1] and not after) or name.lower().endswith(after)


def linked_items(package: Package, target: str) -> set[str] | None:
    """All that a target is linked to, itself and through targets of its package; None where that cannot be told."""
    targets = {one.name: one for one in package.build.targets}
    items = {link.item for link in package.build.links}
    seen: set[str] = set()
    waiting = [target, *items]
    while waiting:
        own = targets.get(waiting.pop())
        if own is None or own.name in seen:
            continue
        if own.kind in ("unknown", "external", "fetched", "imported"):
            return None
        seen.add(own.name)
        waiting.extend([own.alias_of] if own.alias_of else [])
        for link in own.links:
            if link.how in ("link", "ament"):
                items.add(link.item)
                waiting.append(link.item)
    return items


def exported_targets(package: Package) -> Iterator[BuildTarget]:
    """The libraries of the package that dependants link as imported targets, through ament_export_targets()."""
    sets = {e.item for e in package.build.exports if e.how == "ament_export_targets"}
    names = {name for i in package.build.installs if i.kind == "targets" and i.export in sets for name in i.items}
    for target in package.build.targets:
        if target.name in names and target.kind in ("library", "interface"):
            yield target


def public_links(target: BuildTarget) -> Iterator[Link]:
    """What a target passes on to those who link it. A static library passes all on."""
    for link in target.links:
        if link.how in ("link", "ament", "interfaces") and (link.visibility != "PRIVATE" or target.static):
            yield link


def found_with(view: View, names: set[str]) -> frozenset[str]:
    """Packages that are found along with these, by what each looks for where it is found: packages of the workspace by
    what they export, others by what their manifests depend on."""
    found: set[str] = set()
    waiting = list(names)
    while waiting:
        name = waiting.pop()
        if name in found:
            continue
        found.add(name)
        package = view.workspace.packages.get(name)
        further = _exported(package) if package is not None else None
        if further is None:
            found |= view.spread({name} | {p.name for p in view.cmake(name)})
        else:
            waiting.extend(further)
    return frozenset(found)


def _exported(package: Package) -> list[str] | None:
    """The packages that one of the workspace looks for where it is found; None where that is not known."""
    build = package.build
    names = [e.item for e in build.exports if e.how in ("ament_export_dependencies", "catkin_depends")]
    if not build.files or any("$" in name for name in names) or any(f.how == "ament_auto" for f in build.found):
        return None
    names.extend(f.name for f in build.handed_on)
    names.extend(name for made in build.generated for name, _ in made.dependencies)
    return names


def standards_asked(view: View, package: Package) -> dict[str, int]:
    """The years of the C++ standards that targets are compiled under at least: each one's own, and those that what it
    links asks of its users, in the package, the workspace and the released packages of the target."""
    targets = {target.name: target for target in package.build.targets}
    found: dict[str, int] = {}
    for target in targets.values():
        year, waiting, seen = standard_year(target.standard) if target.standard else 0, [target.name], set()
        others: set[str] = set()
        while waiting:
            own = targets.get(waiting.pop())
            if own is None or own.name in seen:
                continue
            seen.add(own.name)
            if own.public_standard:
                year = max(year, standard_year(own.public_standard))
            waiting.extend([own.alias_of] if own.alias_of else [])
            for link in own.links:
                if link.how in ("link", "ament", "interfaces"):
                    waiting.append(link.item)
                    others.add(package_of(link.item))
        if "catkin" in others:
            others.update(f.name for f in package.build.found if f.how == "catkin")
        for name in found_with(view, others - targets.keys()) if others else ():
            other = view.workspace.packages.get(name)
            asked = max((t.public_standard for t in other.build.targets), default=0) if other is not None else (
                view.offers.standard(name)
            )
            year = max(year, standard_year(asked) if asked else 0)
        if year:
            found[target.name] = year
    return found
