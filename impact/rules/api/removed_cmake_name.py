"""removed-cmake-name: a CMake command, variable or target of another package is gone on a target.

What it does
    Reports calls of macros and functions, and uses of imported targets and variables, that the target's version of the
    providing package does not define: by the known-changes table no longer, and by what its sources and those of other
    versions export no longer or not yet.

Why it breaks
    CMake stops at an unknown command or target; an unknown variable is empty and the build fails later.

Severity
    error for commands and targets that are surely reached; warning for variables, which only the table tells of, under
    conditions that are not known, and where the exports of the target's version cannot be told whole.

Example
    ament_target_dependencies(node rclcpp)      # removed in ament_cmake 2.8.5

Use instead
    target_link_libraries(node rclcpp::rclcpp)

Not reported
    Calls under a condition that does not hold on the target; names that the package or the workspace defines.
"""

from collections.abc import Iterator

from ...model.cmake.build import At
from ...model.view import View
from ...model.workspace import Package
from ...targets.evidence import evidence_of, of_offered
from ..rule import Hit, rule
from .build_api import lacking


@rule(severity="error")
def removed_cmake_name(view: View):
    gone = {c.old: c for c in view.changes("cmake-removed", "cmake-renamed") if c.state == "removed"}
    folded = {name.lower(): c for name, c in gone.items()}
    for package in view:
        told = set()
        names = [(u.name, u.at, u.conditions, u.kind) for u in package.build.uses]
        names += [
            (link.item, link.at, (*t.conditions, *link.conditions), "target")
            for t in package.build.targets
            for link in t.links
        ]
        yield from _by_surfaces(view, package, [name for name in names if name[0] not in gone])
        for name, at, conditions, kind in names:
            change = gone.get(name) or (folded.get(name.lower()) if kind == "command" else None)
            if change is None or name in told or not view.active(conditions):
                continue
            told.add(name)
            yield Hit(
                at,
                name,
                f"`{name}` is gone in {change.package} {change.version}".strip(),
                f"use `{change.new}`" if change.new else "",
                package.name,
                severity="warning" if kind == "variable" or not view.certain(conditions) else "error",
                evidence=evidence_of(change),
            )


def _by_surfaces(view: View, package: Package, names: list[tuple]) -> Iterator[Hit]:
    """What the stored versions of the packages that are found do not export alike."""
    found = dict.fromkeys(one.name for one in package.build.found if one.how != "pkg_check_modules")
    own = {target.name for one in view.workspace for target in one.build.targets}
    places: dict[tuple[str, str], tuple[At, bool]] = {}
    for name, at, conditions, kind in names:
        # A variable may be set in more ways than its package shows.
        if kind == "variable" or (kind == "target" and ("::" not in name or "$" in name or name in own)):
            continue
        if not view.active(conditions):
            continue
        certain = view.certain(conditions)
        key = kind, name.lower() if kind == "command" else name
        if key not in places or (certain and not places[key][1]):
            places[key] = at, certain
    for (kind, name), (at, certain) in places.items():
        packages = [name.partition("::")[0]] if kind == "target" else list(found)
        lost = lacking(view, kind, name, packages)
        if lost is not None:
            severity = "error" if certain and lost.sure else "warning"
            yield Hit(
                at, name, lost.message, lost.help, package.name, severity=severity, evidence=of_offered(lost.offered)
            )
