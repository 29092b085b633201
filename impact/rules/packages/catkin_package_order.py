"""catkin-package-order: a target is added before catkin_package() is called.

What it does
    Reports libraries and programs that CMake adds before it comes to catkin_package().

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
    Tests; targets under a condition that is unknown on the target.
"""

from ...model.view import TargetView
from ...model.workspace import Package
from ..rule import Diagnostic, Text, rule


@rule(
    severity="warning",
    texts=Text("catkin_package() is called after {targets}", "call it before add_library() and add_executable()"),
)
def catkin_package_order(view: TargetView, package: Package):
    call = package.build.catkin_package
    if call is None or package.build_type != "catkin":
        return
    before = set(package.build.before_catkin_package)
    early = tuple(
        target.name
        for target in package.build.targets
        if target.name in before
        and target.kind in ("library", "executable", "module")
        and view.certain(target.conditions)
    )
    if early:
        yield Diagnostic(call, "catkin_package", package.name, {"targets": early})
