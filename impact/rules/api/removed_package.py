"""removed-package: a package that is used was taken out of ROS.

What it does
    Reports declared dependencies and find_package calls that name a package which the known-changes table says was
    taken out of ROS before, or with, the target's distro, or will be with an update of it or in the newest distro.

Why it breaks
    Nothing installs the package there.

Severity
    error for a build or run dependency and for a find_package(REQUIRED) that surely counts on the target; warning for
    dependencies of tests and documentation, for optional or guarded calls, and for the first use of a package that is
    still there; note for such calls that ask for a package of the other generation of ROS, and for the other uses.

Example
    <exec_depend>ros1_bridge</exec_depend>              <!-- not released since Humble -->

Use instead
    <exec_depend condition="$ROS_DISTRO == foxy">ros1_bridge</exec_depend>

Not reported
    Names that the workspace, the target's distro or rosdep provides all the same; dependencies under a condition that
    does not hold on the target; what find_package(... QUIET) looks for where a test of its X_FOUND follows.
"""

from collections.abc import Iterator

from ...facts.condition import Condition
from ...model.cmake.build import FoundPackage
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Upcoming, limit_severity, list_place_doubts, rule

_GONE = "package `{subject}` is not available in {distro}"
_ENDED = f"{_GONE}; its successor `{{replacement}}` has another API"
_LEAVING = "package `{subject}` will be removed: not in {distro}"
TEXTS = {
    "declared": Text(_GONE, "remove the dependency"),
    "declared, renamed": Text(f"{_GONE}: it was renamed to `{{replacement}}`", "depend on `{replacement}`"),
    "declared, succeeded": Text(_ENDED, "port to `{replacement}`, or put a condition on the dependency"),
    "found": Text(_GONE),
    "found, renamed": Text(f"{_GONE}: it was renamed to `{{replacement}}`", "find `{replacement}`"),
    "found, succeeded": Text(_ENDED, "port to `{replacement}`"),
    "upcoming": Text(_LEAVING, "use something else there, or a condition"),
    "upcoming, renamed": Text(f"{_LEAVING}, where it is `{{replacement}}`", "use `{replacement}` there"),
    "upcoming, succeeded": Text(
        f"{_LEAVING}, where its successor `{{replacement}}` has another API", "port to `{replacement}` there"
    ),
}


@rule(texts=TEXTS)
def removed_package(view: TargetView, package: Package):
    return list_gone_packages(view, package, "")


def list_gone_packages(view: TargetView, package: Package, form: str) -> Iterator[Diagnostic | Upcoming]:
    """Diagnostics for every use of a package that a reviewed row of the given form says is gone, or will be."""
    uses = [
        (d.name, "declared", (Condition("manifest", d.condition),) if d.condition else (), view.find_place(package, d),
         (d.kind in ("build", "buildtool", "exec") or Doubt.TEST,))
        for d in package.manifest.dependencies
        if d.kind not in ("conflict", "replace") and view.is_declaration_active(d.condition)
    ]  # fmt: skip
    uses += [
        (f.name, "found", f.conditions, f.at, _collect_search_doubts(view, f))
        for f in package.build.found
        if not (f.quiet and not f.required and f.name in package.build.asked)
    ]
    seen = set()
    for name, how, conditions, at, doubts in uses:
        # Whoever corrects the manifest alone is stopped by CMake.
        stops = how == "found" and limit_severity(*doubts) == "error"
        if name in seen or (name, how) in seen or ((name, "declared") in seen and not stops):
            continue
        rows = {row.state: row for row in reversed(view.find_reviewed("package", name)) if row.form == form}
        later = rows.get("upcoming")
        if later is not None and not view.may_have(name) and view.target.find_version(name) is not None:
            if later.horizon is not None and view.is_active_on(later.horizon, conditions):
                seen.add(name)
                data = {"distro": later.horizon.name, "replacement": later.replacement}
                found = Diagnostic(
                    at, name, package.name, data, f"upcoming{_find_fate(view, name, later.replacement)}", doubts
                )
                repository = view.target.find_repository(name)
                home = repository[0] if repository is not None else ""
                yield Upcoming(found, name, later.horizon, (at.path, at.line), home)
            continue
        gone = rows.get("removed")
        if gone is None or view.is_available(name):
            continue
        seen.add((name, how))
        data = {"distro": view.target.distro, "replacement": gone.replacement}
        yield Diagnostic(at, name, package.name, data, f"{how}{_find_fate(view, name, gone.replacement)}", doubts)


def _find_fate(view: TargetView, name: str, replacement: str) -> str:
    """What became of a package that is gone, as the kinds of texts name it."""
    if not replacement:
        return ""
    return ", renamed" if view.offers.lives_on(name, replacement) else ", succeeded"


def _collect_search_doubts(view: TargetView, found: FoundPackage) -> tuple[Doubt | bool, ...]:
    """What speaks against an error where CMake looks for a package. What it does not always look for, or goes on
    without, and belongs to the other generation of ROS, is for builds in that."""
    doubts = (*list_place_doubts(view, "build", found.conditions), found.required or Doubt.OPTIONAL)
    dispensable = any(isinstance(each, Doubt) for each in doubts) and view.target.is_other_generation(found.name)
    return (*doubts, Doubt.DISPENSABLE) if dispensable else doubts
