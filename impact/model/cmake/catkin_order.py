"""What targets of catkin packages wait for: what makes the headers that they include."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import partial

from ....edges.groups import group_pairs
from ....edges.memory import cache_in_derived
from ....edges.reach import walk
from ..view import TargetView, find_included_interface
from ..workspace import Package
from .catkin_links import find_linked_packages


def find_generator(view: TargetView, package: Package, header: str) -> str:
    """What makes a header while a package is built: `gencfg`, of dynamic_reconfigure, or `generate_messages_cpp`, of
    the package itself, another one of the workspace, or one that is not released here, so that it is built along from
    elsewhere. Empty for all else."""
    head, _, rest = header.partition("/")
    if head != package.name and head not in view.workspace.packages:
        beside = "/" not in rest and rest.endswith(".h") and head in package.build.catkin_components
        named = beside and not view.is_available(head) and find_included_interface(view, header)
        return "generate_messages_cpp" if named else ""
    made = {generated.how for generated in package.build.generated}
    if head == package.name and "reconfigure" in made and rest.endswith("Config.h"):
        return "gencfg"
    makes = head != package.name or "catkin" in made
    return "generate_messages_cpp" if makes and view.workspace.is_interface_header(head, rest) else ""


def waits_for(view: TargetView, package: Package, target: str, maker: str, generator: str) -> bool:
    """Whether a target of a package waits for what makes headers of `maker`: by what it is given itself or through
    other targets of the package. For those of another package also through a library that it is linked to, which others
    of the workspace export: in one CMake run (catkin_make) such a library is a target."""
    items, packages = _index_awaited(view, package).get(target, ()), view.workspace.packages
    if any(_makes(item, maker, generator, package.name) for item in items):
        return True
    start = [(package.name, item) for item in items] if maker != package.name else ()
    return any(
        _makes(item, maker, generator, name) and maker in view.build_environment(packages[name])
        for name, item in walk(start, partial(_list_next, view))
        if name != package.name
    )


@cache_in_derived
def _index_awaited(view: TargetView, package: Package) -> dict[str, set[str]]:
    """By the targets of a package: all that they wait for within it."""
    direct = _index_links(view, package)
    return {name: set(walk(items, lambda item: direct.get(item, ()))) for name, items in direct.items()}


@cache_in_derived
def _index_links(view: TargetView, package: Package) -> dict[str, list[str]]:
    """By the targets of a package: what they wait for themselves."""
    links = ((target.name, link) for target in package.build.targets for link in target.links)
    return group_pairs((name, link.item) for name, link in links if link.how in ("order", "link"))


def _list_next(view: TargetView, place: tuple[str, str]) -> Iterator[tuple[str, str]]:
    """Where something leads that a target of a package of the workspace is given: further items, each with the package
    whose targets are given it, or which exports it as a library."""
    (user, item), packages = place, view.workspace.packages

    def list_exported(name: str, how: str) -> list[str]:
        return [e.item for e in packages[name].build.exports if e.how == how] if name in packages else []

    yield from ((user, link) for link in _index_links(view, packages[user]).get(item, ()))
    linked = find_linked_packages(view, packages[user], [item])
    for name in walk(linked, lambda one: list_exported(one, "catkin_depends")):
        yield from ((name, library) for library in list_exported(name, "libraries"))


_MAKES_ANYTHING = re.compile("PROJECT_NAME|ROSBUILD|GENCPP")


def _makes(item: str, maker: str, generator: str, package: str) -> bool:
    """Whether what a target of a package is given makes the headers of `maker`."""
    text = item.strip("${}")
    if text in ("catkin_EXPORTED_TARGETS", "catkin_TARGETS"):
        return maker != package
    if _MAKES_ANYTHING.search(text):
        return True
    if not text.startswith(f"{maker}_") or not ("_gen" in text[len(maker) :] or text.endswith("_EXPORTED_TARGETS")):
        return False
    if generator == "gencfg":
        return text.endswith(("_gencfg", "_EXPORTED_TARGETS", "_genparam"))
    return not text.endswith("_gencfg")
