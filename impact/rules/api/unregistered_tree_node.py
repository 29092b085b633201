"""unregistered-tree-node: a behaviour tree has a node that nothing registers.

What it does
    Reports nodes in the XML of BehaviorTree.CPP, version 3 or 4, that no package of the workspace registers, and none
    that it uses, in trees that have nodes of the workspace.

Why it breaks
    BehaviorTree.CPP knows no node of that name, so the tree is not loaded, and the node that loads it does not start.

Severity
    warning, since it is not known which tree is loaded; note in examples.

Example
    <OpenGriper/>                               # factory.registerNodeType<OpenGripper>("OpenGripper");

Use instead
    <OpenGripper/>

Not reported
    Anything at all where the workspace, or a package that it uses, computes names that it registers, or where
    packages that may register nodes are not known; nodes of released packages, which removed-tree-node looks at; trees
    without nodes of the workspace; files in folders named after another distro.
"""

from ...facts.cpp.tree_nodes import COMPUTED
from ...model.misspelling import is_slip
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, list_place_doubts, rule
from .tree_registrations import (
    find_misspelt,
    is_registering_known,
    list_computed,
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
    texts=Text(
        "no package of the workspace registers the node `{subject}`, nor one that it uses",
        help="[[did you mean `{alike}`?]]",
    ),
)
def unregistered_tree_node(view: TargetView, package: Package):
    own = list_own_nodes(view)
    if not own or registers_computed(view) or not is_registering_known(view):
        return
    for _, uses in list_tree_files(view, package):
        names = list_node_names(uses)
        along = list_packages_along(view, names)
        computed = list_computed(view, along)
        if names.isdisjoint(own) or COMPUTED in computed:
            continue
        known = list_own_trees(view).union(own, list_registered(view, along), computed)
        unknown = {name for name in names - known if not list_owners(view, name)}
        if len(unknown) == 1 and find_misspelt(view, along, *unknown) is not None:
            continue  # removed-tree-node reports it
        for use in uses:
            if use.reference.kind == "tree node" and use.reference.name in unknown:
                unknown.remove(use.reference.name)
                alike = [name for name in sorted(own) if is_slip(name, use.reference.name)]
                data = {"alike": alike[0] if len(alike) == 1 else ""}
                doubts = (*list_place_doubts(view, use.role), Doubt.LATE)
                yield Diagnostic(use.at, use.reference.name, package.name, data, doubts=doubts)
