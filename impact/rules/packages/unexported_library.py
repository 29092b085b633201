"""unexported-library: a package exports the headers of a library, and not the library.

What it does
    Reports libraries that are built from exported headers, that nothing in the package links or loads, and that the
    package does not export, where it exports no other library either.

Why it breaks
    The package builds, and dependants compile and are not linked: undefined references.

Example
    catkin_package(INCLUDE_DIRS include)        # and add_library(arm src/arm.cpp)

Use instead
    catkin_package(INCLUDE_DIRS include LIBRARIES arm)

Not reported
    Packages with CONFIG_EXTRAS or CFG_EXTRAS, those of catkin whose headers others of the workspace include, and those
    of plugins: with a plugin description, or nodes that libraries register for behaviour trees; libraries that launch
    files or settings name.
"""

import posixpath

from ..vocabulary import Diagnostic, Package, TargetView, Text, rule
from .ament_exports import read_ament_exports

_ALONE = "the headers of `{subject}` are exported, but the library is not, so dependants cannot link it"
# What tells dependants about a library, or loads it.
_OFFERS = frozenset(
    {"ament_export_targets", "ament_export_libraries", "cfg_extras", "component", "libraries", "plugin_description"}
)
_OF_FOLDERS = frozenset({"ament_export_include_directories", "include_dirs"})


@rule(
    severity="warning",
    group="unexported-include-directory",
    texts={
        "ament": Text(_ALONE, "call ament_export_targets() or ament_export_libraries()"),
        "catkin": Text(_ALONE, "add it to LIBRARIES of catkin_package()"),
    },
)
def unexported_library(view: TargetView, package: Package):
    catkin = package.build.catkin_package is not None
    if (package.build.finds_declared or not catkin) and read_ament_exports(view, package) is None:
        return
    exports = package.build.exports
    folders = tuple(f"{posixpath.normpath(e.item)}/" for e in exports if e.how in _OF_FOLDERS)
    if not folders or package.build.unresolved or _makes_plugins(package):
        return
    if any(e.how in _OFFERS or "$" in e.item for e in exports):
        return
    if catkin and package.name in view.workspace.includers:
        return  # unexported-header looks at those who include them
    public = [p for p, _ in package.linked.source_targets if p.startswith(folders)] if catkin else ()
    offered = frozenset(public or package.linked.public_headers)
    linked = {link.item for link in package.build.target_links}.union(package.linked.named)
    headers = {name for path, names in package.linked.source_targets if path in offered for name in names} - linked
    # Those who find a package of catkin in the devel space ask for no install rule.
    made = headers if catkin else headers & package.build.installed_targets
    for target in package.build.targets:
        if target.kind == "library" and target.name in made and view.is_sure(target.conditions):
            yield Diagnostic(target.at, target.name, package.name, kind="catkin" if catkin else "ament")


def _makes_plugins(package: Package) -> bool:
    """Whether the libraries of a package are loaded at run time."""
    linked = package.linked
    return bool(linked.registered or linked.plugins or linked.tree_nodes.nodes)
