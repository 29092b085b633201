"""target-given-own-package: add_target_dependencies() is given the package that calls it.

What it does
    Reports targets that are given their own package, which nothing has found while it is built.

Why it breaks
    CMake stops: the package was not found before.

Example
    ament_target_dependencies(filter rclcpp sonar_filter)       # in the package sonar_filter

Use instead
    target_link_libraries(filter sonar_filter)

Not reported
    Packages that find an installed version of themselves; ament_cmake_target_dependencies before 0.8.0, which goes on.
"""

from ...model.cmake.links import stops_at_names
from ..vocabulary import Diagnostic, Package, TargetView, Text, rule


@rule(
    group="missing-find-package",
    texts=Text(
        "`{target}` is given `{package}`, which is this package itself, so CMake stops",
        "target_link_libraries({target} {package})",
    ),
)
def target_given_own_package(view: TargetView, package: Package):
    if not stops_at_names(view):
        return
    if any(f.name == package.name or "$" in f.name for f in package.build.found):
        return
    given = (
        (target, link)
        for target in package.build.targets
        for link in target.links
        if link.how == "ament" and link.item == package.name and view.is_sure(link.conditions)
    )
    for target, link in given:
        yield Diagnostic(link.at, "ament_target_dependencies", package.name, {"target": target.name})
        break
