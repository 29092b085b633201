"""removed-package: a package that is used was taken out of ROS.

What it does
    Reports declared dependencies and find_package calls that name a package which the known-changes table says was
    removed, without a successor of the same role, before the target's version of the distro.

Why it breaks
    Nothing installs the package there.

Severity
    error when it is used unconditionally; warning otherwise.

Example
    <depend>shape_tools</depend>                // merged away in kinetic

Use instead
    What the table names, where it names something.
"""

from ...model.view import View
from ..rule import Hit, rule


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
            if view.available(dependency.name) or dependency.condition and not view.active_manifest(dependency.condition):
                continue
            told.add(dependency.name)
            yield Hit(view.manifest_place(package, dependency), dependency.name, _message(view, change, dependency.name),
                      f"depend on `{change.new}`" if change.new else "remove the dependency", package.name,
                      severity="error" if dependency.kind in ("build", "buildtool", "exec") else "warning")  # fmt: skip
        for found in package.build.found:
            change = gone.get(found.name)
            if change is None or found.name in told or view.available(found.name) or not view.active(found.conditions):
                continue
            told.add(found.name)
            yield Hit(found.at, found.name, _message(view, change, found.name),
                      f"find `{change.new}`" if change.new else "", package.name,
                      severity="error" if found.required and view.certain(found.conditions) else "warning")  # fmt: skip


def _message(view: View, change, name: str) -> str:
    return f"`{name}` is gone in {view.target.distro}" + (f", its successor is `{change.new}`" if change.new else "")
