"""unexported-target: a package links a target that another package of the workspace does not export.

What it does
    Compares links of the form `package::target` with what that package exports with ament_export_targets(), where it
    is in the workspace.

Why it breaks
    CMake stops: "Target links to package::target but the target was not found". An alias of this name lives in the
    package's own build alone.

Severity
    error; warning under a condition.

Example
    install(TARGETS arm_kinematics DESTINATION lib)     # and another package links arm::arm_kinematics

Use instead
    install(TARGETS arm_kinematics EXPORT arm_targets DESTINATION lib)
    ament_export_targets(arm_targets)

Not reported
    Packages whose exports cannot all be seen: those of ament_auto, of plain CMake, with generated targets or with
    scripts of their own for dependants.
"""

from collections.abc import Iterator

from ...model.cmake.build import Link
from ...model.cmake.links import list_exported_targets
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule

_EXPORT = "put `{target}` into an export set with install(TARGETS ... EXPORT ...), and call ament_export_targets()"


@rule(
    scope="target",
    group="missing-export",
    texts={
        "own": Text("`{by}` links `{subject}`, but `{owner}` does not export the target", _EXPORT),
        "unknown": Text("`{owner}` exports no target `{subject}`", "link a target that it exports"),
    },
)
def unexported_target(view: TargetView) -> Iterator[Diagnostic]:
    seen = set()
    for package in view.list_built():
        own = {target.name for target in package.build.targets}
        for link in package.build.target_links:
            head, separator, name = link.item.partition("::")
            owner = view.workspace.packages.get(head) if separator and link.how == "link" else None
            if owner is None or owner.name == package.name or link.item in own or (owner.name, name) in seen:
                continue
            exported = _list_names(view, owner)
            if exported is None or name in exported or "$" in name or package.build.unresolved:
                continue
            seen.add((owner.name, name))
            yield from _diagnose(view, package, link, owner)


def _list_names(view: TargetView, owner: Package) -> set[str] | None:
    """The names, below the package's own namespace, of all targets that a package exports; None where not all of them
    can be seen."""
    build = owner.build
    if build.ament_package is None or build.unresolved or build.handed_on or build.generated:
        return None
    if build.finds_declared or any(e.how == "cfg_extras" for e in build.exports):
        return None
    if any(t.kind in ("external", "fetched", "imported", "unknown") for t in build.targets):
        return None
    if any(i.kind == "export" or any("$" in item for item in i.items) for i in build.installs):
        return None
    sets = [e for e in build.exports if e.how == "ament_export_targets"]
    if any("$" in e.item or e.context not in ("", f"{owner.name}::") for e in sets):
        return None
    return {target.export_name or target.name for target in list_exported_targets(owner)}


def _diagnose(view: TargetView, package: Package, link: Link, owner: Package) -> Iterator[Diagnostic]:
    name = link.item.partition("::")[2]
    doubts = (view.is_sure(link.conditions) or Doubt.CONDITIONAL,)
    data = {"by": package.name, "owner": owner.name, "target": name}
    made = next((t for t in owner.build.targets if name in (t.name, t.export_name, t.output_name)), None)
    if made is not None and view.reports_on(owner.name):
        yield Diagnostic(made.at, link.item, owner.name, data, "own", doubts)
    elif made is None and view.reports_on(package.name):
        yield Diagnostic(link.at, link.item, package.name, data, "unknown", doubts)
