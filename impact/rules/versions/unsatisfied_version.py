"""unsatisfied-version: a version bound of the manifest does not hold on a target.

What it does
    Compares `version_gte`, `version_gt`, `version_lt`, `version_lte` and `version_eq` of every dependency with the
    version that the workspace or the target has.

Why it breaks
    catkin and bloom write the bound into the Debian package, so installing fails; rosdep ignores the bound, so a source
    build goes on and fails later, in the compiler or at run time.

Severity
    error where the target's release or library, or that of the next sync, breaks the bound; warning where a package of
    the workspace itself does, or a later update of the distro.

Example
    <depend version_gte="2.9.0">moveit_core</depend>     # the robot, humble, has 2.5.9

Use instead
    A bound that holds on every target, or code for both versions.

Not reported
    Bounds on packages whose version on the target is not known, and under a condition that does not hold there.
"""

from ...facts.manifest import Dependency
from ...targets.version import compare
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Upcoming, rule

_HOLDS = {
    "version_lt": lambda c: c < 0,
    "version_lte": lambda c: c <= 0,
    "version_eq": lambda c: c == 0,
    "version_gte": lambda c: c >= 0,
    "version_gt": lambda c: c > 0,
}
_SIGN = {"version_lt": "<", "version_lte": "<=", "version_eq": "=", "version_gte": ">=", "version_gt": ">"}


@rule(
    texts={
        "": Text(
            "package.xml asks for `{subject}` {bound}, but the target has {version}",
            "relax the bound, or update that target",
        ),
        "upcoming": Text(
            "package.xml asks for `{subject}` {bound}, but {horizon} has {version}", "relax the bound, or ask for `>=`"
        ),
    },
)
def unsatisfied_version(view: TargetView, package: Package):
    seen = set()
    for dependency in package.manifest.dependencies:
        if not dependency.bounds or dependency.kind in ("conflict", "replace", "group") or dependency.name in seen:
            continue
        if dependency.condition and not view.active_manifest(dependency.condition):
            continue
        here = view.workspace.packages.get(dependency.name)
        version = (
            here.manifest.version
            if here
            else view.target.version(dependency.name) or view.target.library(dependency.name)
        )
        if not version:
            continue
        for name, bound in dependency.bounds:
            if name in _HOLDS and not _HOLDS[name](compare(version, bound)):
                seen.add(dependency.name)
                yield Diagnostic(
                    view.manifest_place(package, dependency),
                    dependency.name,
                    package.name,
                    {"version": version, "bound": f"{_SIGN[name]} {bound}"},
                    doubts=(Doubt.DISTURBS,) if here else (),
                )
                break
        else:
            if not here and (later := _find_later(view, package, dependency)) is not None:
                seen.add(dependency.name)
                yield later


def _find_later(view: TargetView, package: Package, dependency: Dependency) -> Upcoming | None:
    """The first update of the distro whose version a bound does not allow."""
    for ahead in view.updates:
        version = ahead.target.version(dependency.name) or ""
        for name, bound in dependency.bounds if version else ():
            if name in _HOLDS and not _HOLDS[name](compare(version, bound)):
                data = {"version": version, "bound": f"{_SIGN[name]} {bound}", "horizon": ahead.name}
                at = view.manifest_place(package, dependency)
                found = Diagnostic(at, dependency.name, package.name, data, "upcoming")
                return Upcoming(found, dependency.name, ahead, (at.path, at.line))
    return None
