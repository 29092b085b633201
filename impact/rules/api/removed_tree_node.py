"""removed-tree-node: a behaviour tree has a node that no package registers on the target.

What it does
    Reports nodes in the XML of BehaviorTree.CPP, version 3 or 4, that an earlier or later version of a package
    registers and the target's does not; nodes of a package that another one took the place of, such as those of
    BehaviorTree.CPP 3 where the target's packages use version 4; and misspelt names.

Why it breaks
    BehaviorTree.CPP knows no node of that name, so the tree is not loaded, and the node that loads it does not start.

Severity
    warning, since it is not known which tree is loaded; note in examples.

Example
    <SequenceStar name="patrol">                # BehaviorTree.CPP 3: Humble and Iron

Use instead
    <SequenceWithMemory name="patrol">          # BehaviorTree.CPP 4: Jazzy and later

Not reported
    What the workspace itself registers, anything at all where it computes names that it registers; names that no
    version of a released package is known to register, unless they are misspelt; files in folders named after another
    distro.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator

from ....edges.memory import cache_in_derived
from ...facts.cpp.tree_nodes import COMPUTED
from ...model.misspelling import is_slip
from ...model.package import ReferenceUse
from ...targets.surface.surface import TREE_NODE
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Upcoming, list_place_doubts, rule
from .diagnosis import build_availability_texts, diagnose, find_missing, is_of_another_distro


@rule(
    severity="warning",
    preview=True,
    texts={
        **build_availability_texts(),
        "elsewhere": Text(
            "`{subject}` is not available in {upstream} {version}, only in {owner}", help="[[use `{replacement}`]]"
        ),
        "misspelt": Text("`{subject}` is not a node of {upstream} {version}", help="did you mean `{alike}`?"),
    },
)
def removed_tree_node(view: TargetView, package: Package):
    by_file: dict[str, dict[str, ReferenceUse]] = {}
    for use in package.linked.references:
        if use.reference.kind == "tree node":
            by_file.setdefault(use.at.path, {}).setdefault(use.reference.name, use)
    files = frozenset(package.linked.files)
    if not by_file or COMPUTED in _list_own(view):
        return
    for path, uses in by_file.items():
        if is_of_another_distro(view, path, files):
            continue
        along = _list_packages(view, frozenset(uses))
        known = _list_own(view).union(_list_registered(view, along))
        unknown = [name for name in uses if name not in known and name not in view.offers.surfaces.tree_nodes]
        for name, use in uses.items():
            if name not in known:
                yield from _find_problems(view, package, use, along, len(unknown) > 1)


def _find_problems(
    view: TargetView, package: Package, use: ReferenceUse, along: frozenset[str], open_ended: bool
) -> Iterator[Diagnostic | Upcoming]:
    """What is wrong with a node that nothing registers here for sure. along: packages that come along. open_ended: the
    tree has other nodes that nobody is known to register, so that who registers them may register this one."""
    name = use.reference.name
    doubts = (*list_place_doubts(view, use.role), Doubt.LATE)
    owners = view.offers.surfaces.tree_nodes.get(name, ())
    there = [owner for owner in owners if owner in along]
    found = find_missing(view, "plugin", name, there) if there else None
    if found is not None and found.form != "never":
        # A new node is often called like another one that does something else.
        found = found._replace(alike=found.alike if is_slip(found.alike, name) else "")
        yield diagnose(found, use.at, name, package.name, doubts)
        return
    for owner in owners:
        if owner not in along and (heir := _find_heir(view, owner, along)):
            data = {"upstream": heir, "version": view.target.find_version(heir) or "", "owner": owner,
                    "replacement": _find_other_name(view, heir, name)}  # fmt: skip
            yield Diagnostic(use.at, name, package.name, data, "elsewhere", (*doubts, Doubt.INCOMPLETE))
            return
    if owners or open_ended or any(name in one.linked.modelled for one in view.workspace):
        return
    alike = [(known, owner) for known, owner in _list_registered(view, along).items() if is_slip(known, name)]
    if len(alike) == 1:
        ((known, owner),) = alike
        data = {"upstream": owner, "version": view.target.find_version(owner) or "", "alike": known}
        yield Diagnostic(use.at, name, package.name, data, "misspelt", (*doubts, Doubt.INCOMPLETE))


@cache_in_derived
def _list_own(view: TargetView) -> frozenset[str]:
    """The nodes that the workspace registers, and the trees that it defines."""
    return frozenset(name for one in view.workspace for name in (*one.linked.tree_nodes, *one.linked.trees))


@cache_in_derived
def _list_nodes_by_package(view: TargetView) -> dict[str, set[str]]:
    """The nodes that released packages registered in any version."""
    found: dict[str, set[str]] = defaultdict(set)
    for name, owners in view.offers.surfaces.tree_nodes.items():
        for owner in owners:
            found[owner].add(name)
    return found


_TELLING = 3
"""Nodes of a tree that one package alone registers, from which on the tree is written for that package."""


@cache_in_derived
def _list_packages(view: TargetView, names: frozenset[str]) -> frozenset[str]:
    """The packages that register nodes and come along with the workspace, or with one that a tree of some nodes is
    evidently written for."""
    known = _list_nodes_by_package(view)
    owners = view.offers.surfaces.tree_nodes
    sole = Counter(owners[name][0] for name in names if len(owners.get(name, ())) == 1)
    meant = [owner for owner, count in sole.items() if count >= _TELLING and view.is_available(owner)]
    return view.brought_to_workspace.union(view.list_transitive(meant)).intersection(known)


@cache_in_derived
def _list_registered(view: TargetView, packages: frozenset[str]) -> dict[str, str]:
    """The nodes that packages surely register on the target, each with its package."""
    offers = (view.offers.find_package(name) for name in sorted(packages))
    return {
        plugin.name: offer.package
        for offer in offers
        if offer is not None
        for plugin in offer.build.plugins
        if plugin.base == TREE_NODE and plugin.sure
    }


def _find_other_name(view: TargetView, owner: str, name: str) -> str:
    """The name under which a package surely registers what it registers by another one in some builds alone."""
    offer = view.offers.find_package(owner)
    nodes = [node for node in offer.build.plugins if node.base == TREE_NODE] if offer is not None else []
    types = {node.type for node in nodes if node.name == name and node.type}
    return next((node.name for node in nodes if node.sure and node.type in types), "")


def _find_heir(view: TargetView, owner: str, along: frozenset[str]) -> str:
    """The package of those that come along which has most of the nodes of one that does not; empty where none has
    half of them."""
    nodes = _list_nodes_by_package(view)
    common = {name: len(nodes[owner] & nodes[name]) for name in sorted(along)}
    best = max(common, key=lambda name: common[name], default="")
    return best if best and 2 * common[best] >= len(nodes[owner]) else ""
