"""removed-package: a package that is used was taken out of ROS.

What it does
    Reports declared dependencies and find_package calls that name a package which the known-changes table says was
    taken out of ROS before, or with, the target's distro.

Why it breaks
    Nothing installs the package there.

Severity
    error for a build or run dependency and for a find_package(REQUIRED) that surely counts on the target; warning for
    dependencies of tests and documentation, and for optional or guarded calls.

Example
    <exec_depend>ros1_bridge</exec_depend>              <!-- not released since Humble -->

Use instead
    <exec_depend condition="$ROS_DISTRO == foxy">ros1_bridge</exec_depend>

Not reported
    Names that the workspace, the target's distro or rosdep provides all the same; dependencies under a condition that
    does not hold on the target.
"""

from ...model.view import View
from ..rule import Hit, rule
from ..severity import Doubt, doubts_of_place, severity


@rule(severity="error")
def removed_package(view: View):
    yield from gone_packages(view, "package-removed")


def gone_packages(view: View, kind: str):
    """Hits for every use of a package whose change of the given kind is in force."""
    gone = {c.old or c.package: c for c in view.changes(kind) if c.state == "removed"}
    for package in view:
        told = set()
        for dependency in package.manifest.dependencies:
            change = gone.get(dependency.name)
            if change is None or dependency.name in told or dependency.kind in ("conflict", "replace"):
                continue
            if view.available(dependency.name) or (
                dependency.condition and not view.active_manifest(dependency.condition)
            ):
                continue
            told.add(dependency.name)
            yield Hit(
                view.manifest_place(package, dependency),
                dependency.name,
                _message(view, change, dependency.name),
                f"depend on `{change.new}`" if change.new else "remove the dependency",
                package.name,
                severity=severity(dependency.kind in ("build", "buildtool", "exec") or Doubt.TEST),
            )
        for found in package.build.found:
            change = gone.get(found.name)
            if change is None or found.name in told or view.available(found.name) or not view.active(found.conditions):
                continue
            told.add(found.name)
            yield Hit(
                found.at,
                found.name,
                _message(view, change, found.name),
                f"find `{change.new}`" if change.new else "",
                package.name,
                severity=severity(*doubts_of_place(view, "build", found.conditions), found.required or Doubt.OPTIONAL),
            )


def _message(view: View, change, name: str) -> str:
    return f"`{name}` is gone in {view.target.distro}" + (f", its successor is `{change.new}`" if change.new else "")
