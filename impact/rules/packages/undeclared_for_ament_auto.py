"""undeclared-for-ament-auto: ament_auto is told to require a name that package.xml does not declare.

What it does
    Compares the names given to ament_auto_find_build_dependencies(REQUIRED ...) and ament_auto_find_test_dependencies
    with the dependencies of package.xml.

Why it breaks
    ament_auto stops at a name that package.xml does not have among the dependencies to build with. Another name for the
    same, such as its rosdep key, does not count.

Severity
    error; warning under a condition that is unknown on the target.

Example
    ament_auto_find_build_dependencies(REQUIRED Eigen3)     # and package.xml has <depend>eigen</depend>

Use instead
    find_package(Eigen3 REQUIRED)

Not reported
    Names in variables whose value is unknown.
"""

from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule

# Source: ament_cmake_auto's ament_auto_find_build_dependencies.cmake, the same in all distros.
_KINDS = frozenset(("build", "buildtool", "test"))


@rule(
    group="undeclared-package",
    texts=Text(
        "`{subject}` is REQUIRED of ament_auto, which refuses what `{package}` does not declare",
        help="declare `{subject}` by this name, or find_package({subject} REQUIRED) on its own",
    ),
)
def undeclared_for_ament_auto(view: TargetView, package: Package):
    named = {d.name for d in package.manifest.dependencies if d.kind in _KINDS}
    for found in package.build.found:
        if found.how != "declared" or not found.required or found.name in named or "$" in found.name:
            continue
        doubts = (view.is_sure(found.conditions) or Doubt.CONDITIONAL,)
        yield Diagnostic(found.at, found.name, package.name, doubts=doubts)
