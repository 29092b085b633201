"""unsatisfied-version: a version bound of the manifest does not hold on a target.

What it does
    Compares `version_gte`, `version_gt`, `version_lt`, `version_lte` and `version_eq` of every dependency with the
    version that the workspace or the target has.

Why it breaks
    catkin and bloom write the bound into the Debian package, so installing fails; rosdep ignores the bound, so a source
    build goes on and fails later, in the compiler or at run time.

Severity
    error where the target's release or library breaks the bound; warning where a package of the workspace itself does,
    or an update of the distro.

Example
    <depend version_gte="2.9.0">moveit_core</depend>     # the robot, humble, has 2.5.9

Use instead
    A bound that holds on every target, or code for both versions.

Not reported
    Bounds on packages whose version on the target is not known, and under a condition that does not hold there.
"""

import operator

from ...facts.manifest import Dependency
from ...targets.version import compare
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Upcoming, rule

_BOUNDS = {
    "version_lt": ("<", operator.lt),
    "version_lte": ("<=", operator.le),
    "version_eq": ("=", operator.eq),
    "version_gte": (">=", operator.ge),
    "version_gt": (">", operator.gt),
}


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
    for dependency in view.list_dependencies(package):
        if not dependency.bounds or dependency.name in seen:
            continue
        here = view.workspace.packages.get(dependency.name)
        version = (
            here.manifest.version
            if here
            else view.target.find_version(dependency.name) or view.target.find_library(dependency.name)
        )
        if not version:
            continue
        if bound := _find_broken(dependency, version):
            seen.add(dependency.name)
            data, doubts = {"version": version, "bound": bound}, (Doubt.DISTURBS,) if here else ()
            yield Diagnostic(view.find_place(package, dependency), dependency.name, package.name, data, "", doubts)
        elif not here and (later := _find_later(view, package, dependency)) is not None:
            seen.add(dependency.name)
            yield later


def _find_broken(dependency: Dependency, version: str) -> str:
    """The first bound that a version does not keep, as it is read; empty where it keeps all."""
    broken = (f"{_BOUNDS[name][0]} {bound}" for name, bound in dependency.bounds
              if name in _BOUNDS and not _BOUNDS[name][1](compare(version, bound), 0))  # fmt: skip
    return next(broken, "")


def _find_later(view: TargetView, package: Package, dependency: Dependency) -> Upcoming | None:
    """The first update of the distro whose version a bound does not allow."""
    for ahead, _ in view.updates:
        version = ahead.target.find_version(dependency.name) or ""
        if version and (bound := _find_broken(dependency, version)):
            data = {"version": version, "bound": bound, "horizon": ahead.name}
            at = view.find_place(package, dependency)
            found = Diagnostic(at, dependency.name, package.name, data, "upcoming")
            return Upcoming(found, dependency.name, ahead, (at.path, at.line))
    return None
