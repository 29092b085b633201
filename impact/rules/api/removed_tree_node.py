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

from collections import defaultdict
from collections.abc import Iterator

from ....edges.memory import cache_in_derived
from ...facts.cpp.tree_nodes import COMPUTED
from ...model.misspelling import is_slip
from ...model.package import ReferenceUse
from ...targets.surface.surface import TREE_NODE
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Upcoming, list_place_doubts, rule
from .diagnosis import build_availability_texts, diagnose, find_missing, is_of_another_distro


@rule(
    preview=True,
    texts={
        **build_availability_texts(),
        "elsewhere": Text("`{subject}` is not available in {upstream} {version}, only in {owner}"),
        "misspelt": Text("`{subject}` is not a node of {upstream} {version}", help="did you mean `{alike}`?"),
    },
)
def removed_tree_node(view: TargetView, package: Package):
    uses = [use for use in package.linked.references if use.reference.kind == "tree node"]
    if not uses or COMPUTED in _list_own(view):
        return
    files = frozenset(package.linked.files)
    unknown = {use.at.path for use in uses if not _is_known(view, use.reference.name)}
    reported: dict[str, set[str]] = defaultdict(set)
    for use in uses:
        name = use.reference.name
        if name in _list_own(view) or name in _list_registered(view) or name in reported[use.at.path]:
            continue
        if is_of_another_distro(view, use.at.path, files):
            continue
        for diagnostic in _find_problems(view, package, use, use.at.path in unknown):
            reported[use.at.path].add(name)
            yield diagnostic


def _find_problems(
    view: TargetView, package: Package, use: ReferenceUse, open_ended: bool
) -> Iterator[Diagnostic | Upcoming]:
    """What is wrong with a node that nothing registers here for sure. open_ended: its file has others that nobody is
    known to register, as the packages of the workspace may all do."""
    name = use.reference.name
    doubts = (*list_place_doubts(view, use.role), Doubt.LATE)
    owners = view.offers.surfaces.tree_nodes.get(name, ())
    along = [owner for owner in owners if owner in view.brought_to_workspace]
    found = find_missing(view, "plugin", name, along) if along else None
    if found is not None and found.form != "never":
        yield diagnose(found, use.at, name, package.name, doubts)
        return
    for owner in owners:
        if owner not in along and (heir := _find_heir(view, owner)):
            data = {"upstream": heir, "version": view.target.find_version(heir) or "", "owner": owner}
            yield Diagnostic(use.at, name, package.name, data, "elsewhere", (*doubts, Doubt.INCOMPLETE))
            return
    if owners or open_ended or name in set().union(*(one.linked.modelled for one in view.workspace)):
        return
    alike = [(known, owner) for known, owner in _list_registered(view).items() if is_slip(known, name)]
    if len(alike) == 1:
        ((known, owner),) = alike
        data = {"upstream": owner, "version": view.target.find_version(owner) or "", "alike": known}
        yield Diagnostic(use.at, name, package.name, data, "misspelt", (*doubts, Doubt.INCOMPLETE))


def _is_known(view: TargetView, name: str) -> bool:
    """Whether somebody is known to register a node, or it is one letter off a node of the target."""
    if name in _list_own(view) or name in view.offers.surfaces.tree_nodes:
        return True
    return any(is_slip(known, name) for known in _list_registered(view))


@cache_in_derived
def _list_own(view: TargetView) -> frozenset[str]:
    """The nodes that the workspace registers, and the trees that it defines."""
    return frozenset(name for one in view.workspace for name in (*one.linked.tree_nodes, *one.linked.trees))


@cache_in_derived
def _list_nodes_of(view: TargetView) -> dict[str, set[str]]:
    """The nodes that released packages registered in any version, by package."""
    found: dict[str, set[str]] = defaultdict(set)
    for name, owners in view.offers.surfaces.tree_nodes.items():
        for owner in owners:
            found[owner].add(name)
    return found


@cache_in_derived
def _list_registered(view: TargetView) -> dict[str, str]:
    """The nodes that packages which come along with the workspace surely register on the target, with their package."""
    offers = (view.offers.find_package(name) for name in _list_nodes_of(view) if name in view.brought_to_workspace)
    return {
        plugin.name: offer.package
        for offer in offers
        if offer is not None
        for plugin in offer.build.plugins
        if plugin.base == TREE_NODE and plugin.sure
    }


def _find_heir(view: TargetView, owner: str) -> str:
    """The package that comes along with the workspace and has most of the nodes of one that does not; else empty."""
    nodes = _list_nodes_of(view)
    had = nodes[owner]
    common = {
        name: len(had & nodes[name]) for name in nodes if name != owner and name in view.brought_to_workspace
    }
    best = max(common, key=lambda name: common[name], default="")
    return best if best and 2 * common[best] >= min(len(had), len(nodes[best])) else ""
