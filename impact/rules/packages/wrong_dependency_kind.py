"""wrong-dependency-kind: a dependency is declared, and not as what it is used for.

What it does
    Reports packages that built code needs and the manifest declares only for tests, for running or for dependants, and
    packages needed at run time that are declared for building or tests only: what is imported or launched, and shared
    libraries that installed programs and libraries are linked to.

Why it breaks
    A build without tests, or a machine that only builds, lacks the package. An installed robot lacks what the node
    imports.

Severity
    error where the build farm, which installs no dependencies to run, lacks what CMake or the compiler needs; warning;
    note where what is needed to run is declared for tests.

Example
    <test_depend>moveit_ros_planning</test_depend>      # and CMakeLists.txt finds it outside BUILD_TESTING

Use instead
    <depend>moveit_ros_planning</depend>

Not reported
    What another declared dependency brings as the right kind. Linked packages of interfaces, and those that are not
    known to have a shared library.
"""

from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Together, rule
from .clean_machine import collect_chance_doubts
from .dependency_kinds import WrongKind, fix_kind, list_wrong_kinds

_ONCE = (Together("linked and declared to build"),)
_AS_DEPEND = "declare it as `<{tag}>`"


@rule(
    texts={
        "build, for tests": Text("`{subject}` is needed to build but is declared only for tests", _AS_DEPEND),
        "build, for dependants": Text("`{subject}` is needed to build but is declared only for dependants", _AS_DEPEND),
        "build, to run": Text("`{subject}` is needed to build but is declared only to run", _AS_DEPEND),
        "run, linked": Text(
            "an installed target is linked to `{subject}`, which is declared only to build", _AS_DEPEND
        ),
        "run, for tests": Text("`{subject}` is needed to run but is declared only for tests", _AS_DEPEND),
        "run, to build": Text("`{subject}` is needed to run but is declared only to build", _AS_DEPEND),
    },
)
def wrong_dependency_kind(view: TargetView, package: Package):
    for wrong in list_wrong_kinds(view, package):
        if wrong.lacking == "build":
            yield _diagnose_build(view, package, wrong)
        elif wrong.lacking == "run":
            yield _diagnose_run(view, package, wrong)
        elif wrong.lacking == "linked":
            data = {"tag": _tag_to_run(package)}
            fix = fix_kind(view, package, wrong.name, "exec_depend", wrong.kinds)
            at = view.find_place(package, wrong.name)
            yield Diagnostic(
                at, wrong.name, package.name, data, "run, linked", (Doubt.LATE,), fix=fix, together=_ONCE
            )


def _tag_to_run(package: Package) -> str:
    return "run_depend" if package.manifest.format == 1 else "exec_depend"


def _diagnose_build(view: TargetView, package: Package, wrong: WrongKind) -> Diagnostic:
    need, name, kinds, _ = wrong
    old = package.manifest.format == 1
    doubts: tuple[Doubt, ...] = (Doubt.LATE,)  # rosdep installs run dependencies along, and bloom does not
    chance = collect_chance_doubts(view, package, need)
    if Doubt.LUCKY not in chance:
        doubts = chance  # the build farm does not install it
    kind = "for tests" if kinds == {"test"} else "to run" if "exec" in kinds else "for dependants"
    fix = fix_kind(view, package, name, "depend", kinds)
    data = {"tag": "build_depend" if old else "depend"}
    return Diagnostic(need.at, name, package.name, data, f"build, {kind}", doubts, fix=fix)


def _diagnose_run(view: TargetView, package: Package, wrong: WrongKind) -> Diagnostic:
    need, name, kinds, _ = wrong
    kind, doubt = ("for tests", Doubt.DISPENSABLE) if kinds == {"test"} else ("to build", Doubt.LATE)
    data = {"tag": _tag_to_run(package)}
    fix = fix_kind(view, package, name, "exec_depend", kinds)
    return Diagnostic(need.at, name, package.name, data, f"run, {kind}", (doubt,), fix=fix)
