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

from collections.abc import Iterator

from ...model.misspelling import is_slip
from ...model.package import ReferenceUse
from ...targets.surface.surface import TREE_NODE
from ...targets.tree_nodes import load_tree_nodes
from ...targets.version import find_newest_up_to, parse
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Upcoming, list_place_doubts, rule
from .diagnosis import build_availability_texts, diagnose, find_missing, make_version_together
from .tree_registrations import (
    find_misspelt,
    list_known_packages,
    list_node_names,
    list_own_nodes,
    list_own_trees,
    list_owners,
    list_packages_along,
    list_registered,
    list_tree_files,
    registers_computed,
)


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
    if registers_computed(view):
        return
    for _, uses in list_tree_files(view, package):
        names = list_node_names(uses)
        along = list_packages_along(view, names)
        known = list_own_trees(view).union(list_own_nodes(view), list_registered(view, along))
        unknown = [name for name in names if name not in known and not list_owners(view, name)]
        reported: set[str] = set()
        for use in uses:
            name = use.reference.name
            if use.reference.kind == "tree node" and name not in known and name not in reported:
                reported.add(name)
                yield from _find_problems(view, package, use, along, len(unknown) > 1)


def _find_problems(
    view: TargetView, package: Package, use: ReferenceUse, along: frozenset[str], open_ended: bool
) -> Iterator[Diagnostic | Upcoming]:
    """What is wrong with a node that nothing registers here for sure. along: packages that come along. open_ended: the
    tree has other nodes that nobody is known to register, so that who registers them may register this one."""
    name = use.reference.name
    doubts = (*list_place_doubts(view, use.role), Doubt.LATE)
    owners = list_owners(view, name)
    there = [owner for owner in owners if owner in along]
    stored = [owner for owner in there if owner in view.offers.surfaces.tree_nodes.get(name, ())]
    found = find_missing(view, "plugin", name, stored) if stored else None
    if found is not None and found.form != "never":
        # A new node is often called like another one that does something else.
        found = found._replace(alike=found.alike if is_slip(found.alike, name) else "")
        yield diagnose(found, use.at, name, package.name, doubts)
        return
    if there and not stored:
        yield from _find_change(view, package, use, there[0], doubts)
        return
    for owner in owners:
        if owner not in along and (heir := _find_heir(view, owner, along)):
            data = {"upstream": heir, "version": view.target.find_version(heir) or "", "owner": owner,
                    "replacement": _find_other_name(view, heir, name)}  # fmt: skip
            yield Diagnostic(use.at, name, package.name, data, "elsewhere", (*doubts, Doubt.INCOMPLETE))
            return
    if owners or open_ended or any(name in one.linked.modelled for one in view.workspace):
        return
    alike = find_misspelt(view, along, name)
    if alike is not None:
        known, owner = alike
        data = {"upstream": owner, "version": view.target.find_version(owner) or "", "alike": known}
        yield Diagnostic(use.at, name, package.name, data, "misspelt", (*doubts, Doubt.INCOMPLETE))


def _find_change(
    view: TargetView, package: Package, use: ReferenceUse, owner: str, doubts: tuple[Doubt | bool | None, ...]
) -> Iterator[Diagnostic]:
    """A node that other versions of a package register than the target's, as the table of nodes tells."""
    name, version = use.reference.name, view.target.find_version(owner)
    stored = load_tree_nodes().packages[owner]
    here = find_newest_up_to(version, stored.versions) if version is not None else None
    if version is None or here is None:
        return
    having = [one for one, nodes in stored.iterate_versions() if any(node.name == name for node in nodes.nodes)]
    before = [one for one in having if parse(one) < parse(here)]
    after = [one for one in having if parse(one) > parse(here)]
    if before:
        following = stored.versions.index(before[-1]) + 1
        kind, since = "removed", stored.versions[following]
    else:
        kind, since = "not yet", after[0]
    empty = dict.fromkeys(("replacement", "available", "moved_to", "alike", "detail"), "")
    data = {**empty, "upstream": owner, "version": version, "since": since}
    yield Diagnostic(use.at, name, package.name, data, kind, doubts, together=make_version_together(owner))


def _find_other_name(view: TargetView, owner: str, name: str) -> str:
    """The name under which a package surely registers what it registers by another one in some builds alone."""
    offer = view.offers.find_package(owner)
    nodes = [node for node in offer.build.plugins if node.base == TREE_NODE] if offer is not None else []
    types = {node.type for node in nodes if node.name == name and node.type}
    return next((node.name for node in nodes if node.sure and node.type in types), "")


def _find_heir(view: TargetView, owner: str, along: frozenset[str]) -> str:
    """The package of those that come along which has most of the nodes of one that does not; empty where none has
    half of them."""
    nodes = list_known_packages(view)
    common = {name: len(nodes[owner] & nodes[name]) for name in sorted(along)}
    best = max(common, key=lambda name: common[name], default="")
    return best if best and 2 * common[best] >= len(nodes[owner]) else ""
