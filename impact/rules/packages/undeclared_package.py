"""undeclared-package: something of another package is used and no dependency brings it.

What it does
    Reports packages and system libraries that CMake or pkg-config is asked for, sources include, Python imports, launch
    files or scripts start, programs of ROS packages that launch files run by their names, programs that
    ExternalProject_Add or FetchContent start, plugins that settings or models name in a package that starts something,
    components with a package of their own, environment variables that CMake tests and `ros_environment` sets, and the
    tool of the build type, when neither the manifest nor anything it declares brings them, directly or in turn. What a
    rosdep key's packages depend on comes along.

Why it breaks
    The build works on the machine of whoever happens to have the package. On a machine that has just what the manifest
    declares (a build farm, a new colleague, the robot) the configuration, the compiler, or the node stops.

Severity
    error: an unconditional find_package(REQUIRED), component of it or of catkin, pkg_check_modules(REQUIRED), program,
    or include of compiled code (or of an installed header that another package here compiles) that is sure to miss its
    package on a clean machine of the target: nothing that is declared brings it, and where the target's manifest of
    something declared is not known, no version of that in any distro does. What CMake is asked for where tests are
    built counts, since it is asked whenever the package is configured, and so do tests of ROS 2, which are compiled
    along. In ROS 2 also what a program in Python imports, or an installed launch file starts, in any case, and no
    package of the workspace brings, where at most five such are missing. warning: environment variables, tests of ROS
    1, other imports and launch files, settings, the tool of the build type, installed headers that nothing here
    compiles, or where a dependency is known nowhere and may bring it (a package named like an interface package may
    provide interfaces), and names that nobody is known to have, that CMake cannot go without and that are called as
    packages of ROS are (`finger_tricks`) or given to `ament_target_dependencies()`; error for those whose interfaces
    are included or imported. note: conditional code, examples (installed ones too, in what they import and start),
    documentation, files that nothing compiles, or is known to install, and all but the first of more than five imports
    (in ROS 1 and in tests, of several), or packages that launch files start, which a package does not declare, and
    further packages that lack the same; for distros that have ended, whose machines were set up while they were
    maintained, all that is no error.

Example
    find_package(tf2_eigen REQUIRED)            # and package.xml does not mention tf2_eigen

Use instead
    <depend>tf2_eigen</depend>

Not reported
    What a declared package brings (dependency-by-chance reports what is there by chance alone); code that is switched
    off on the target; nodes of other workspaces that start only under an argument; names that nobody is known to
    provide (they are counted as unresolved), unless the form of the use says that a package is meant, and nothing that
    could bring it is known: a find module, a download, a submodule, a folder that CMake is pointed to.
"""

from ..vocabulary import (
    SEVERITIES,
    Diagnostic,
    Doubt,
    Need,
    Package,
    TargetView,
    Together,
    limit_severity,
    list_ended_doubts,
    make_sort_key,
    rule,
)
from .clean_machine import ASKED, collect_missing_doubts
from .undeclared_needs import declare_need, describe_need, find_kind, find_undeclared, make_texts

_FEW = 5
"""So many undeclared imports, or packages that launch files start, are each reported in ROS 2. Who runs ROS 1 has most
of it at hand, and its manifests were rarely complete: there one of a package tells of all."""
_NOWHERE, _CONDITION = ", nowhere", ", condition"


@rule(
    texts={
        **make_texts("`{package}` does not depend on `{subject}`"),
        **make_texts(
            "`{package}` does not depend on `{subject}`",
            "declare it and add its repository: `{subject}` is neither in the workspace nor in {distro}",
            _NOWHERE,
        ),
        **make_texts(
            "`{package}` declares `{subject}` only under `{condition}`",
            "declare it without the condition, or use it under the same one",
            _CONDITION,
        ),
    },
)
def undeclared_package(view: TargetView, package: Package):
    missing = find_undeclared(view, package).missing
    # Of more things that a package runs with and does not declare, the first is reported, best such as the target has.
    firsts = [(*_find_gravest(view, package, name, needs), name) for name, needs in missing.items()]
    firsts.sort(key=lambda first: (not view.is_available(first[2]), make_sort_key(first[0])))
    # Where so many are missing, those who run the package set their machines up by other means than its manifest.
    habit = sum(first.how not in (*ASKED, "include") for first, _, _ in firsts) > _FEW
    for first, doubts, name in firsts:
        if habit and first.how not in (*ASKED, "include"):
            doubts = (*doubts, Doubt.LUCKY)
        condition = next((d.condition for d in package.manifest.dependencies if d.name == name and d.condition), "")
        if condition and "$ROS_" not in condition:
            doubts = (*doubts, Doubt.CONDITIONAL)  # whoever uses it may set the variable
        if doubts:  # machines of an ended distro were set up while it was maintained
            doubts = (*doubts, *list_ended_doubts(view))
        known = view.is_available(name) or view.is_private(name) or name in view.declared_somewhere
        data = {**describe_need(package, first), "condition": condition, "distro": view.target.distro}
        yield Diagnostic(
            first.at,
            name,
            package.name,
            data,
            find_kind(first, _CONDITION if condition else "" if known else _NOWHERE),
            doubts,
            fix=declare_need(view, package, first, name) if limit_severity(*doubts) != "note" and not condition else (),
            together=_find_together(view, first, name),
        )


def _find_gravest(view: TargetView, package: Package, name: str, needs: list[Need]) -> tuple[Need, tuple[Doubt, ...]]:
    """The need of a package that is surest to break, with what speaks against an error there. Settings for what CMake
    looks for, and goes on without, are of use where that is there."""
    spared = any(need.how == "find_package" and not need.required for need in needs)
    needs = [need for need in sorted(needs, key=make_sort_key) if not (spared and need.how == "setting")]
    found = [(need, collect_missing_doubts(view, package, need, name)) for need in needs]
    return max(found, key=lambda one: SEVERITIES.index(limit_severity(*one[1])))


def _find_together(view: TargetView, need: Need, name: str) -> tuple[Together, ...]:
    """Launch files and modules are used one by one, and whoever declares the first looks for the others: those of the
    package and, of what several packages lack, those of the others."""
    if need.how == "program":
        return (Together(f"`{name}` is not declared, program", everywhere=True),)
    if need.how in (*ASKED, "include"):
        return ()
    early = view.target.ros == 1
    apart = need.how in ("setting", "shell") or (need.how == "import" and not early)
    cause = "test" if need.role == "test" and not early else need.how if apart else "started"
    few = 1 if early or need.role == "test" else _FEW
    return (Together(cause, few=few), Together(f"`{name}` is not declared, {cause}", everywhere=True))
