"""catkin-package-order: a target is added before catkin_package() is called.

What it does
    Reports the first library or program that stands before catkin_package() in the same CMakeLists.txt.

Why it breaks
    catkin_package() sets where targets are built and what they export: those that were added before it land in the
    build folder instead of the devel space, where nothing that depends on the package, and no rosrun, finds them.

Severity
    warning, since installed packages do without the devel space.

Example
    add_library(arm src/arm.cpp)
    catkin_package(LIBRARIES arm)

Use instead
    catkin_package(LIBRARIES arm)
    add_library(arm src/arm.cpp)

Not reported
    Targets of other files, which may be read later; tests; targets under a condition that is unknown on the target.
"""

from ...model.view import View
from ..rule import Hit, rule


@rule(severity="warning")
def catkin_package_order(view: View):
    for package in view:
        call = package.build.catkin_package
        if call is None or package.build_type != "catkin":
            continue
        early = [
            target
            for target in package.build.targets
            if target.kind in ("library", "executable", "module")
            and (target.at.path, target.at.line < call.line) == (call.path, True)
            and view.certain(target.conditions)
        ]
        if early:
            names = ", ".join(f"`{target.name}`" for target in early[:3]) + (", ..." if len(early) > 3 else "")
            yield Hit(
                call,
                "catkin_package",
                f"catkin_package() is called after {names} {'is' if len(early) == 1 else 'are'} added",
                "call it before add_library() and add_executable()",
                package.name,
            )
