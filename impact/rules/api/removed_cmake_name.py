"""removed-cmake-name: a CMake command, variable or target of another package is gone on a target.

What it does
    Reports calls of macros and functions, and uses of imported targets and variables, that the known-changes table says
    the target's version of the providing package no longer defines.

Why it breaks
    CMake stops at an unknown command or target; an unknown variable is empty and the build fails later.

Severity
    error for commands and targets that are surely reached; warning for variables and under conditions that are not
    known.

Example
    ament_target_dependencies(node rclcpp)      # removed in ament_cmake 2.8.5

Use instead
    target_link_libraries(node rclcpp::rclcpp)

Not reported
    Calls under a condition that does not hold on the target; names that the package or the workspace defines.
"""

from ...model.view import View
from ...targets.evidence import evidence_of
from ..rule import Hit, rule


@rule(severity="error")
def removed_cmake_name(view: View):
    gone = {c.old: c for c in view.changes("cmake-removed", "cmake-renamed") if c.state == "removed"}
    folded = {name.lower(): c for name, c in gone.items()}
    if not gone:
        return
    for package in view:
        told = set()
        names = [(u.name, u.at, u.conditions, u.kind) for u in package.build.uses]
        names += [
            (link.item, link.at, (*t.conditions, *link.conditions), "target")
            for t in package.build.targets
            for link in t.links
        ]
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
