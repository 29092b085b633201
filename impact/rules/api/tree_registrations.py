"""Which nodes of behaviour trees are registered where a tree of the workspace is loaded, as the rules on trees ask."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator

from ....edges.memory import cache_in_derived
from ...facts.cpp.tree_nodes import COMPUTED, TreeNodes
from ...model.misspelling import is_slip
from ...model.package import ReferenceUse
from ...targets.surface.surface import TREE_NODE
from ...targets.tree_nodes import PortsFinder, load_tree_nodes
from ..vocabulary import Package, TargetView
from .diagnosis import is_of_another_distro


def list_tree_files(view: TargetView, package: Package) -> Iterator[tuple[str, list[ReferenceUse]]]:
    """The files with trees of a package, as far as they are for the target, with their nodes and ports in order."""
    by_file: dict[str, list[ReferenceUse]] = {}
    for use in package.linked.references:
        if use.reference.kind in ("tree node", "tree port"):
            by_file.setdefault(use.at.path, []).append(use)
    files = frozenset(package.linked.files)
    return ((path, uses) for path, uses in by_file.items() if not is_of_another_distro(view, path, files))


def list_node_names(uses: list[ReferenceUse]) -> frozenset[str]:
    """The nodes among what a file names."""
    return frozenset(use.reference.name for use in uses if use.reference.kind == "tree node")


@cache_in_derived
def list_own_nodes(view: TargetView) -> dict[str, tuple[Package, ...]]:
    """The nodes that the workspace registers, COMPUTED among them, with the packages that do."""
    found: dict[str, list[Package]] = defaultdict(list)
    for one in view.workspace:
        for name in {node.name for node in one.linked.tree_nodes.nodes}:
            found[name].append(one)
    return {name: tuple(packages) for name, packages in found.items()}


@cache_in_derived
def list_own_trees(view: TargetView) -> frozenset[str]:
    """The trees that the workspace defines."""
    return frozenset(name for one in view.workspace for name in one.linked.trees)


@cache_in_derived
def list_known_packages(view: TargetView) -> dict[str, frozenset[str]]:
    """The nodes that released packages registered in any version."""
    found: dict[str, set[str]] = defaultdict(set)
    for name, owners in view.offers.surfaces.tree_nodes.items():
        for owner in owners:
            found[owner].add(name)
    for name, package in load_tree_nodes().packages.items():
        found[name] |= package.list_all_nodes()
    return {name: frozenset(nodes) for name, nodes in found.items() if nodes}


def list_owners(view: TargetView, name: str) -> tuple[str, ...]:
    """The released packages of which some version surely registers a node."""
    owners = (*view.offers.surfaces.tree_nodes.get(name, ()), *load_tree_nodes().list_owners(name))
    return tuple(dict.fromkeys(owners))


_TELLING = 3
"""Nodes of a tree that one package alone registers, from which on the tree is written for that package."""


@cache_in_derived
def list_packages_along(view: TargetView, names: frozenset[str]) -> frozenset[str]:
    """The packages that register nodes and come along with the workspace, or with one that a tree of some nodes is
    evidently written for, as far as the target has them."""
    here = ([one for one in list_owners(view, name) if _registers(view, one, name)] for name in names)
    sole = Counter(owners[0] for owners in here if len(owners) == 1)
    meant = [owner for owner, count in sole.items() if count >= _TELLING and view.is_available(owner)]
    along = view.brought_to_workspace.union(view.list_transitive(meant)).intersection(list_known_packages(view))
    return frozenset(name for name in along if view.target.find_version(name) is not None)


def _registers(view: TargetView, package: str, name: str) -> bool:
    """Whether a package surely registers a node on the target."""
    return name in list_registered(view, frozenset((package,)))


@cache_in_derived
def list_registered(view: TargetView, packages: frozenset[str]) -> dict[str, str]:
    """The nodes that packages surely register on the target, each with its package."""
    found = {name: package for package in sorted(packages) for name in _list_in_table(view, package)}
    offers = (view.offers.find_package(name) for name in sorted(packages))
    for offer in (one for one in offers if one is not None):
        for plugin in offer.build.plugins:
            if plugin.base == TREE_NODE and plugin.sure:
                found[plugin.name] = offer.package
    return found


def _list_in_table(view: TargetView, package: str) -> Iterator[str]:
    nodes = read_released(view, package)
    return (node.name for node in (nodes.nodes if nodes is not None else ()))


def read_released(view: TargetView, package: str) -> TreeNodes | None:
    """What the target's version of a released package has; None where that is not known."""
    stored, version = load_tree_nodes().packages.get(package), view.target.find_version(package)
    return stored.read_version(version) if stored is not None and version is not None else None


@cache_in_derived
def list_computed(view: TargetView, packages: frozenset[str]) -> frozenset[str]:
    """The nodes that packages register on the target in some builds alone; COMPUTED among them where they register
    others that nothing tells."""
    found: set[str] = set()
    for name in packages:
        stored, version = load_tree_nodes().packages.get(name), view.target.find_version(name)
        if stored is not None and version is not None:
            found |= stored.list_unsure(version)
    return frozenset(found)


@cache_in_derived
def make_ports_finder(view: TargetView, first: str) -> PortsFinder:
    """What finds the ports of the classes of a package of the workspace, or of a released one, on the target."""
    own = [one.linked.tree_nodes for one in view.workspace if one.name != first and one.linked.tree_nodes.classes]
    along = view.brought_to_workspace.union(view.list_transitive([first])).intersection(load_tree_nodes().packages)
    released = [nodes for name in sorted(along - {first}) if (nodes := read_released(view, name)) is not None]
    package = view.workspace.packages.get(first)
    if package is not None:
        return PortsFinder((package.linked.tree_nodes, *own, *released))
    nodes = read_released(view, first)
    return PortsFinder((*(() if nodes is None else (nodes,)), *released))


def find_ports(view: TargetView, package: str, nodes: TreeNodes, name: str) -> frozenset[str] | None:
    """The ports of a node that a package registers, in one way or several; None where they are not known."""
    finder = make_ports_finder(view, package)
    found: frozenset[str] = frozenset()
    for node in (one for one in nodes.nodes if one.name == name):
        ports = finder.find_ports(node.class_name)
        if ports is None:
            return None
        found |= ports
    return found


def find_misspelt(view: TargetView, along: frozenset[str], name: str) -> tuple[str, str] | None:
    """The one node of packages that come along which a name has a letter less or other of, with its package."""
    alike = [(known, owner) for known, owner in list_registered(view, along).items() if is_slip(known, name)]
    return alike[0] if len(alike) == 1 else None


@cache_in_derived
def is_registering_known(view: TargetView) -> bool:
    """Whether all packages are known that may register nodes: what the workspace declares is there, and what of it is
    built with BehaviorTree.CPP is in the workspace, or was read."""
    table = load_tree_nodes()
    if view.underlaid:
        return False
    for package in view.workspace:
        declared = view.collect_declared(package)
        if table.libraries.isdisjoint(view.list_transitive(declared)):
            continue
        if any(name not in view.workspace.packages and not view.is_available(name) for name in declared):
            return False
    others = view.brought_to_workspace.difference(view.workspace.packages, table.packages)
    return all(table.libraries.isdisjoint(view.list_installed_with(name)) for name in others)


def registers_computed(view: TargetView) -> bool:
    """Whether the workspace computes names that it registers."""
    return COMPUTED in list_own_nodes(view)
