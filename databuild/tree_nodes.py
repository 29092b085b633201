"""Builds data/tree_nodes.json.zst: the nodes of behaviour trees that each version of released packages registers, and
the classes and functions that tell their ports.

Read are the packages that depend on BehaviorTree.CPP, or on one that does, as the manifests of the snapshot say, as far
as clones of their repositories are at hand. What an installed library or program is compiled from registers nodes; any
header or source outside of tests tells of classes.

    python -P -m rosimpact.databuild.tree_nodes CLONES
"""

from __future__ import annotations

import os
import sys
from collections import defaultdict
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import msgspec

from ..impact.conditions import Environment, evaluate_all
from ..impact.facts import kinds
from ..impact.facts.cpp.lexical import scan
from ..impact.facts.cpp.tree_nodes import COMPUTED, NodeClass, RegisteredNode, TreeNodes
from ..impact.facts.store import Store
from ..impact.model.package import find_folder_role
from ..impact.model.workspace import Package
from ..impact.targets.snapshot import Snapshot, load_snapshot
from ..impact.targets.tables import DATA
from ..impact.targets.tree_nodes import PackageNodes, TreeNodesTable
from ..impact.targets.version import parse
from ..impact.tree import Tree, TreeError
from .surface.clones import Clone, Clones
from .surface.package import link_build, list_compiled
from .surface.releases import normalize_url
from .surface_file import find_spans
from .surfaces import plan
from .table_file import write_table

_LIBRARY = "behaviortree/behaviortree.cpp"
_NOTHING_KNOWN = Environment()


def list_packages(data: Snapshot) -> frozenset[str]:
    """The packages of BehaviorTree.CPP, and those that are built with, or hand on, one of them or of each other."""
    names = dict(data.fetch("SELECT id, name FROM package"))
    found = set(list_libraries(data))
    dependants: dict[str, set[str]] = defaultdict(set)
    entries = dict(data.fetch("SELECT id, entries FROM dependencies"))
    for package, listed in data.fetch("SELECT DISTINCT package, dependencies FROM manifest"):
        for line in (entries.get(listed) or "").splitlines():
            name, _, how = line.partition("\t")
            if set("be") & set(how.partition("\t")[0]):
                dependants[name].add(names[package])
    todo = list(found)
    while todo:
        new = dependants[todo.pop()] - found
        found |= new
        todo += new
    return frozenset(found)


def list_libraries(data: Snapshot) -> frozenset[str]:
    """The packages of BehaviorTree.CPP itself."""
    urls = data.fetch(
        "SELECT DISTINCT p.name, u.text FROM package p JOIN home h ON h.package = p.id JOIN source s ON"
        " s.distro = h.distro AND s.repository = h.repository JOIN url u ON u.id = s.url"
    )
    return frozenset(package for package, url in urls if url and normalize_url(url) == _LIBRARY)


def read_package(package: Package, tree: Tree, known: dict[str, Any]) -> tuple[TreeNodes, tuple[str, ...]]:
    """What a package has, and the names of PackageNodes.unsure. known: what files tell, by their content, to add to."""
    compiled = list_compiled(package, ("library", "module", "executable"))
    base = f"{package.path}/" if package.path else ""
    sure: dict[str, RegisteredNode] = {}
    unsure: set[str] = set()
    classes, functions = set(), set()
    for path in package.files:
        full = path if path.startswith(base) else f"{base}{path}"
        if kinds.find_kind(full) != "cpp" or find_folder_role(full[len(base) :]) is not None:
            continue
        key = tree.find_content_id(full)
        if key not in known:
            scanned = scan(tree.read(full))
            known[key] = (tuple(scanned.list_tree_nodes()), scanned.read_tree_nodes())
        nodes, found = known[key]
        if found is not None:
            classes.update(found.classes)
            functions.update(found.functions)
        for node in nodes if full in compiled else ():
            holds = evaluate_all(node.conditions, _NOTHING_KNOWN)
            if node.name == COMPUTED or holds is None:
                unsure.add(node.name)
            elif holds:
                sure[node.name] = msgspec.structs.replace(node, conditions=())
    read = TreeNodes(
        tuple(sure[name] for name in sorted(sure)), tuple(sorted(classes, key=repr)), tuple(sorted(functions, key=repr))
    )
    return read, tuple(sorted(unsure.difference(sure)))


def read_clones(clones: Clones, data: Snapshot) -> Iterator[tuple[str, str, TreeNodes, tuple[str, ...]]]:
    """(package, version, what it has, what is unsure) of all that a folder of clones has of list_packages()."""
    distros = [name for (name,) in data.fetch("SELECT name FROM distro")]
    libraries = list_libraries(data)
    jobs, _ = plan(clones, distros, list_packages(data), "all", data)
    known: dict[str, Any] = {}
    with Store() as store:
        for job in jobs:
            opened: dict[str, Clone] = {}
            for state in job.states:
                clone = opened.setdefault(state.clone, Clone(Path(state.place), state.clone))
                try:
                    tree = clone.read_tree(state.revision)
                    workspace = link_build(tree, store)
                except (TreeError, OSError) as error:
                    print(f"{state.clone} {state.version}: {error}", file=sys.stderr)
                    continue
                for package in workspace:
                    if package.name in state.packages:
                        nodes, unsure = read_package(package, tree, known)
                        if package.name in libraries:
                            # What it computes there is what others register.
                            unsure = tuple(name for name in unsure if name != COMPUTED)
                        yield package.name, state.version, nodes, unsure


def build_table(read: Iterable[tuple[str, str, TreeNodes, tuple[str, ...]]]) -> TreeNodesTable:
    """The table of what packages have by version. Classes that are no nodes, as far as all of them tell, are left
    out."""
    found: dict[str, dict[str, tuple[TreeNodes, tuple[str, ...]]]] = defaultdict(dict)
    for package, version, nodes, unsure in read:
        found[package].setdefault(version, (nodes, unsure))
    kept = _find_node_classes(nodes for versions in found.values() for nodes, _ in versions.values())
    return TreeNodesTable({name: _pack_versions(versions, kept) for name, versions in sorted(found.items())})


def _find_node_classes(all_nodes: Iterable[TreeNodes]) -> frozenset[str]:
    """The classes that nodes are of, that derive from TreeNode or that have ports, and what these derive from."""
    derived: dict[str, set[str]] = defaultdict(set)
    bases: dict[str, set[str]] = defaultdict(set)
    todo = {"TreeNode"}
    for nodes in all_nodes:
        todo.update(node.class_name for node in nodes.nodes)
        todo.update(function.of for function in nodes.functions)
        for one in nodes.classes:
            bases[one.name].update(one.bases)
            for base in one.bases:
                derived[base].add(one.name)
    found: set[str] = set()
    below = ["TreeNode"]
    while below:
        new = derived[below.pop()] - todo
        todo |= new
        below += new
    while todo:
        name = todo.pop()
        found.add(name)
        todo |= bases[name] - found
    return frozenset(found)


def _pack_versions(versions: dict[str, tuple[TreeNodes, tuple[str, ...]]], kept: frozenset[str]) -> PackageNodes:
    order = sorted(versions, key=parse)
    rows: dict[str, dict[Any, list[int]]] = {"nodes": {}, "classes": {}, "functions": {}, "unsure": {}}
    for place, version in enumerate(order):
        nodes, unsure = versions[version]
        named: dict[str, Iterable[NodeClass | Any]] = {
            "nodes": nodes.nodes,
            "classes": (one for one in nodes.classes if one.name in kept),
            "functions": (one for one in nodes.functions if one.of in kept),
            "unsure": unsure,
        }
        for part, values in named.items():
            for value in values:
                rows[part].setdefault(value, []).append(place)
    packed = {
        part: tuple((value, tuple(find_spans(places, len(order)))) for value, places in sorted(each.items(), key=repr))
        for part, each in rows.items()
    }
    return PackageNodes(tuple(order), **packed)


def main(arguments: list[str]) -> None:
    """Writes the table."""
    table = build_table(read_clones(Clones(Path(os.path.abspath(arguments[0]))), load_snapshot()))
    write_table(DATA / "tree_nodes.json.zst", table)


if __name__ == "__main__":
    main(sys.argv[1:])
