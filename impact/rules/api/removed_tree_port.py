"""removed-tree-port: a behaviour tree gives a node a port that it does not have on the target.

What it does
    Reports attributes in the XML of BehaviorTree.CPP, version 3 or 4, that are no port of their node: the class that
    the target's version of a package, or the workspace, registers for it does not provide one of that name.

Why it breaks
    BehaviorTree.CPP refuses the tree: "Possible typo? In the XML, you tried to remap port", and the node that loads it
    does not start.

Severity
    warning, since it is not known which tree is loaded; note in examples.

Example
    <ComputePathToPose goal="{goal}" error_code_id="{code}"/>           # Humble has no such port

Use instead
    <ComputePathToPose goal="{goal}"/>

Not reported
    Nodes whose ports are not known: of classes that compute them, that several packages define, or whose base classes
    are of packages that are not known; attributes of subtrees; files in folders named after another distro.
"""

from __future__ import annotations

from collections.abc import Iterator

from ...facts.cpp.tree_nodes import TreeNodes
from ...model.misspelling import is_slip
from ...model.package import ReferenceUse
from ...targets.tree_nodes import PortsFinder, load_tree_nodes
from ...targets.version import parse
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, list_place_doubts, rule
from .diagnosis import make_version_together
from .tree_registrations import (
    find_ports,
    list_computed,
    list_node_names,
    list_own_nodes,
    list_own_trees,
    list_packages_along,
    list_tree_files,
    read_released,
)

_IN = "`{subject}` is not a port of `{node}` in {upstream} {version}"
_ALIKE = "[[did you mean `{alike}`?]]"


@rule(
    severity="warning",
    preview=True,
    texts={
        "removed": Text(f"{_IN}[[ (removed in {{since}})]]", _ALIKE),
        "not yet": Text(f"{_IN}[[ (added in {{since}})]]", _ALIKE),
        "never": Text(_IN, _ALIKE),
        "own": Text("`{subject}` is not a port of `{node}`, which {upstream} registers", _ALIKE),
    },
)
def removed_tree_port(view: TargetView, package: Package):
    trees = list_own_trees(view)
    for _, uses in list_tree_files(view, package):
        along = list_packages_along(view, list_node_names(uses))
        for use in uses:
            node, _, port = use.reference.name.rpartition(" ")
            if use.reference.kind == "tree port" and node not in trees and node not in list_computed(view, along):
                yield from _find_problem(view, package, use, along, node, port)


def _find_problem(
    view: TargetView, package: Package, use: ReferenceUse, along: frozenset[str], node: str, port: str
) -> Iterator[Diagnostic]:
    """What is wrong with a port of a node. along: released packages that come along."""
    own = [(one.name, one.linked.tree_nodes) for one in list_own_nodes(view).get(node, ())]
    known = ((name, read_released(view, name)) for name in sorted(along) if name not in view.workspace.packages)
    released = [(name, nodes) for name, nodes in known if nodes is not None and _registers(nodes, node)]
    ports = [find_ports(view, name, nodes, node) for name, nodes in (*own, *released)]
    found = frozenset[str]().union(*(each for each in ports if each is not None))
    if not ports or None in ports or port in found:
        return
    alike = [one for one in sorted(found) if is_slip(one, port)]
    owner = own[0][0] if own else released[0][0]
    data = {"node": node, "upstream": owner, "version": "", "since": "", "alike": alike[0] if len(alike) == 1 else ""}
    kind = "own"
    if not own:
        data["version"] = view.target.find_version(owner) or ""
        kind, data["since"] = _find_change(view, owner, node, port)
    doubts = (*list_place_doubts(view, use.role), Doubt.LATE)
    together = () if own else make_version_together(owner)
    yield Diagnostic(use.at, port, package.name, data, kind, doubts, together=together)


def _registers(nodes: TreeNodes, name: str) -> bool:
    return any(node.name == name for node in nodes.nodes)


def _find_change(view: TargetView, owner: str, node: str, port: str) -> tuple[str, str]:
    """How it came that a port is not there: the kind of a text, and the version of the change."""
    version = parse(view.target.find_version(owner) or "")
    had: list[str] = []
    lost = ""
    for other, nodes in load_tree_nodes().packages[owner].iterate_versions():
        classes = [one.class_name for one in nodes.nodes if one.name == node]
        has = any(port in (PortsFinder((nodes,)).find_ports(name) or ()) for name in classes)
        if has and parse(other) > version:
            return ("removed", lost) if had else ("not yet", other)
        if has:
            had.append(other)
            lost = ""
        elif had and not lost:
            lost = other
    return ("removed", lost) if had else ("never", "")
