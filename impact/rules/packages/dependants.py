"""Packages of the workspace that are sure to stop at what another one of it offers them."""

from collections.abc import Iterator

from ....edges.memory import cache_in_derived
from ...model.cmake.build import BuildTarget
from ...model.cmake.links import resolve_package
from ..vocabulary import Package, TargetView


def list_compiled_elsewhere(view: TargetView, package: Package) -> Iterator[tuple[Package, str]]:
    """The paths that targets of other packages include in any case, each with its package."""
    for other in view.list_built():
        for include in other.linked.includes if other.name != package.name else ():
            if include.role == "build" and include.targets and view.is_sure(include.conditions):
                yield other, include.path


def is_compiled_elsewhere(view: TargetView, package: Package, header: str) -> bool:
    """Whether a target of another package compiles a header of this one in any case. header: path in the workspace."""
    name = f"/{header}".rpartition("/include/")[2]
    return any(name in view.find_outward((path,))[1] for _, path in list_compiled_elsewhere(view, package))


def links_without(view: TargetView, package: Package, target: BuildTarget, needed: str) -> bool:
    """Whether another package links an exported target of this one, and finds `needed` neither by itself nor along with
    others: CMake stops at a target of it. needed: as CMake calls it."""
    names = {needed.lower(), *(provider.name.lower() for provider in view.find_cmake(needed))}
    for other in view.list_built():
        if other.name == package.name or not _links(view, other, package.name, target.export_name or target.name):
            continue
        found = {f.name for f in other.build.found}
        if any("$" in name for name in found) or other.build.finds_declared:
            continue
        if names.isdisjoint(name.lower() for name in view.roles.list_found_with(found)):
            return True
    return False


def _links(view: TargetView, package: Package, other: str, target: str) -> bool:
    """Whether a target that is built in any case is linked to one of another package, by name or as all that it has."""
    return any(
        resolve_package(link.item) == other
        and (link.how == "ament" or link.item == f"{other}::{target}" or link.item.endswith("_TARGETS}"))
        and view.is_sure(link.conditions)
        for link in package.build.target_links
        if link.how in ("link", "ament")
    )


def is_only_loaded(view: TargetView, package: Package) -> bool:
    """True for a package of plugins that no package of the workspace looks for: it is loaded rather than linked."""
    plugins = any(e.how in ("plugin_description", "component") for e in package.build.exports)
    return plugins and not is_found_elsewhere(view, package)


def is_found_elsewhere(view: TargetView, package: Package) -> bool:
    """Whether the CMake of another package of the workspace looks for this one."""
    return not _list_finders(view).get(package.name, set()) <= {package.name}


def is_surely_found_elsewhere(view: TargetView, package: Package) -> bool:
    """The same in any case, whatever the conditions are that others stand under."""
    others = (other for other in view.list_built() if other.name != package.name)
    return any(f.name == package.name and view.is_sure(f.conditions) for other in others for f in other.build.found)


@cache_in_derived
def _list_finders(view: TargetView) -> dict[str, set[str]]:
    """What CMake looks for, with the packages of the workspace that do."""
    finders: dict[str, set[str]] = {}
    for package in view.list_built():
        for found in package.build.found:
            finders.setdefault(found.name, set()).add(package.name)
    return finders
