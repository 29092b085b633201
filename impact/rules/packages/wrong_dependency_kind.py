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
    note where what is needed to run is declared for tests, and for distros that have ended: nothing is released into
    them any more, and whoever builds from source has all that is declared.

Example
    <test_depend>moveit_ros_planning</test_depend>      # and CMakeLists.txt finds it outside BUILD_TESTING

Use instead
    <depend>moveit_ros_planning</depend>

Not reported
    What another declared dependency brings as the right kind. Linked packages of interfaces, and those that are not
    known to have a shared library.
"""

from ..vocabulary import (
    Diagnostic,
    Doubt,
    Package,
    TargetView,
    Text,
    Together,
    list_ended_doubts,
    rule,
    translate_tag,
)
from .clean_machine import collect_chance_doubts
from .dependency_kinds import fix_kind, list_wrong_kinds

_ONCE = (Together("linked and declared to build"),)
_IMPORTED = (Together("needed to run and declared to build"),)
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
        if wrong.lacking == "dependants":
            continue  # which unexported-dependency reports
        at, kind, doubts, together = wrong.need.at, "run, to build", (Doubt.LATE,), _IMPORTED
        if wrong.lacking == "linked":
            at, kind, together = view.find_place(package, wrong.name), "run, linked", _ONCE
        elif wrong.lacking == "build":
            chance = collect_chance_doubts(view, package, wrong.need)
            together = ()
            if Doubt.LUCKY not in chance:
                doubts = chance  # rosdep installs run dependencies along, and the build farm does not
            others = "to run" if "exec" in wrong.kinds else "for dependants"
            kind = "build, for tests" if wrong.kinds == {"test"} else f"build, {others}"
        elif wrong.kinds == {"test"}:
            kind, doubts, together = "run, for tests", (Doubt.DISPENSABLE,), ()
        doubts = (*doubts, *list_ended_doubts(view))
        tag = "depend" if wrong.lacking == "build" else "exec_depend"
        fix = fix_kind(view, package, wrong.name, tag, wrong.kinds)
        data = {"tag": translate_tag(tag, package.manifest.format)[0]}
        yield Diagnostic(at, wrong.name, package.name, data, kind, doubts, fix=fix, together=together)
