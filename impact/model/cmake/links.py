"""What the targets of a package are linked to, and what of it they pass on to those who link them."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Container, Iterable, Iterator
from functools import lru_cache

from ....edges.memory import cache_in_derived
from ....edges.reach import walk
from ...targets.version import is_at_least
from ..view import TargetView
from ..workspace import Package
from .build import At, BuildTarget, Link, is_for_tests
from .names import MODULES

_OF_PACKAGE = re.compile(r"\$\{([^${}]+?)_(?:LIBRARIES|TARGETS|INCLUDE_DIRS?|LIBRARY|LIBS|EXPORTED_TARGETS)\}")


@lru_cache(maxsize=10000)
def resolve_package(item: str) -> str:
    """The package that a link item stands for: `pkg::target`, `${pkg_LIBRARIES}`, or the item itself."""
    match = _OF_PACKAGE.match(item)
    return match.group(1) if match else item.partition("::")[0]


def is_opaque(item: str) -> bool:
    """Whether a link item holds a variable that stands for no package, so that it cannot be known what is linked."""
    return "$" in item and _OF_PACKAGE.fullmatch(item) is None


def may_hide(item: str, name: str) -> bool:
    """Whether an item with a variable that nothing sets may stand for a package: the texts around the variable have to
    allow it, and the variables that a found package sets stand for that package alone."""
    if "$" not in item:
        return False
    if not is_opaque(item):
        return resolve_package(item).lower() == name.lower()
    plain = re.split(r"\$(?:ENV)?\{[^{}]*\}", item)
    before, after = plain[0].lower(), plain[-1].lower().partition("::")[0]
    if not name.lower().startswith(before):
        return False
    return ("::" in plain[-1] and not after) or name.lower().endswith(after)


def list_exported_targets(package: Package) -> Iterator[BuildTarget]:
    """The libraries of the package that dependants link as imported targets, through ament_export_targets() or a
    configuration of its own."""
    sets = {e.item for e in package.build.exports if e.how == "ament_export_targets"}
    if package.build.handed_on:
        sets.update(item for i in package.build.installs if i.kind == "export" for item in i.items)
    names = {name for i in package.build.installs if i.kind == "targets" and i.export in sets for name in i.items}
    for target in package.build.targets:
        if target.name in names and target.kind in ("library", "interface"):
            yield target


def list_public_links(target: BuildTarget) -> Iterator[Link]:
    """What a target passes on to those who link it. A static library passes all on."""
    for link in target.links:
        if link.how in ("link", "ament", "interfaces") and (link.visibility != "PRIVATE" or target.static):
            yield link


def resolve_passed_package(link: Link) -> str:
    """The package whose targets a link passes on; empty for libraries that are handed on by their paths."""
    if link.how == "ament":
        return "" if "$" in link.item else link.item
    if link.how != "link" or ("$" in link.item and not link.item.endswith("_TARGETS}")):
        return ""
    return resolve_package(link.item) if "::" in link.item or "$" in link.item else ""


def list_found_names(view: TargetView, package: Package) -> set[str] | None:
    """Every package CMake looks for, under the names others know them by; None when CMake finds by names unknown."""
    names: set[str] = set()
    for found in package.build.found:
        if found.how == "declared":
            names.update(n for n, kinds in view.collect_declared(package).items() if kinds & {"build", "buildtool"})
        names.add(found.name)
        names.update(p.name for p in view.find_cmake(found.name))
    for export in package.build.exports:
        if export.how == "ament_export_dependencies":
            names.add(export.item)
    if any("${" in f.name for f in package.build.found):
        return None
    return names


def stops_at_names(view: TargetView) -> bool:
    """Whether add_target_dependencies() stops at a name that was not found. Before 0.8.0 it meant to, and its test
    was never true. Source: commit 99d316a of ament_cmake."""
    return is_at_least(view.target.find_version("ament_cmake_target_dependencies") or "0.8.0", "0.8.0")


def list_given_names(view: TargetView, package: Package) -> Iterator[tuple[At, str, str, str]]:
    """What only find_package() can define, with the place, what is written there, and how it is used: `given` by
    ament_target_dependencies, `linked` as what stands before `::`, where nothing of the package has targets of that
    name, or `made`: what interfaces are said to depend on."""
    own = {t.name for t in package.build.targets}
    spaces = {name.partition("::")[0] for name in own if "::" in name}
    for link in package.build.target_links:
        if not view.is_sure(link.conditions) or "$" in link.item or link.item in own or is_for_tests(link.conditions):
            continue
        head, separator, _ = link.item.partition("::")
        if link.how == "ament" or (link.how == "link" and separator and head not in spaces):
            yield link.at, head, link.item, "linked" if separator else "given"
    for made in package.build.generated:
        if made.how in ("rosidl", "catkin") and view.is_sure(made.conditions) and not is_for_tests(made.conditions):
            yield from ((at, name, name, "made") for name, at in made.dependencies if "$" not in name)


@cache_in_derived
def find_brought(view: TargetView, package: Package, target: str) -> tuple[frozenset[str], set[str]] | None:
    """What comes along with all that a target is given, and the items that may stand for something else; None where
    that cannot be known."""
    build = package.build
    items = build.list_linked_items(target, None)
    if items is None:
        return None
    # Targets of the package's own interfaces bring along the packages that these rest on.
    items |= {
        name
        for made in build.generated
        if any(item == made.target or item.startswith(f"{made.target}__rosidl_") for item in items)
        for name, _ in made.dependencies
    }
    hiding, kinds = set(filter(is_opaque, items)), {t.name: t.kind for t in build.targets}
    # Packages name their variables in capitals too: ${OMPL_INCLUDE_DIRS} is ompl's.
    # A target of the package may be called like a package, and brings none of what that declares.
    own = kinds.keys() - {link.item for link in build.target_links if link.how == "ament"}
    given = {resolve_package(item) for item in (*(items - hiding - own), *(i for i, _ in build.include_dirs))}
    given -= {"", package.name}
    known = view.collect_declared(package).keys() | {f.name for f in build.found}
    if view.unknown_contents.list_unknown(frozenset(given & known)):
        return None  # what one of them brings is not known
    if any(kinds.get(item) == "generated" for item in items):
        given.update(name for made in build.generated for name, _ in made.dependencies)
    return view.list_transitive(s for n in given for s in (n, n.lower())), hiding


def describe_finding(view: TargetView, key: str, header: str) -> str:
    """The call by which CMake finds the library that a key installs, by CMake's own module, the library's configuration
    or pkg-config, where that is called as the key, its package or the header is; empty where there is none."""
    stems = [re.sub(r"\Alib|-dev\Z", "", name) for name in (key, *sorted(view.list_debs(key)))]
    stems.append(posixpath.splitext(header.partition("/")[0])[0])
    for name in (name for stem in stems for name in view.providers.list_spellings(stem)):
        known = view.find_cmake(name) if f"Find{name}" in MODULES else view.providers.find_installed_cmake(name)
        if any(p.name == key for p in known):
            return f"find_package({name} REQUIRED)"
    for name in (name for stem in stems for name in (stem, f"lib{stem}")):
        if any(p.name == key for p in view.providers.find_pkgconfig(name)):
            return f"pkg_check_modules({name} REQUIRED IMPORTED_TARGET {name})"
    return ""


def list_given_items(package: Package, names: Container[str]) -> Iterator[str]:
    """What targets of a package are given, themselves or as all are. names: of these targets."""
    yield from (item for item, _ in package.build.include_dirs)
    yield from (link.item for link in package.build.links)
    for target in package.build.targets:
        if target.name in names:
            yield from (link.item for link in target.links)


def is_linked_otherwise(view: TargetView, name: str, items: Iterable[str]) -> bool:
    """Whether something else than the variables of packages that a target is linked to may bring a package."""
    known = [item for item in items if "$" not in item]
    packages = {item.partition("::")[0] for item in known}
    if any("$" in item and not re.fullmatch(r"\$\{\w+_LIBRARIES\}", item) for item in items):
        return True
    brought = walk(packages, lambda one: view.offers.list_exports(one) or ())
    return name in brought or any(one in view.workspace.packages for one in packages)
