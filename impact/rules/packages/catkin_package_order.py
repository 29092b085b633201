"""catkin-package-order: a target is added before catkin_package() is called, or it is never called.

What it does
    Reports libraries and programs that CMake adds before it comes to catkin_package(), and packages that find catkin
    and do not call it at all.

Why it breaks
    catkin_package() sets where targets are built and what they export: those that were added before it land in the
    build folder instead of the devel space, where nothing that depends on the package, and no rosrun, finds them.
    Without it, nobody finds the package, and its package.xml is not installed.

Severity
    warning, since installed packages do without the devel space.

Example
    add_library(arm src/arm.cpp)
    catkin_package(LIBRARIES arm)

Use instead
    catkin_package(LIBRARIES arm)
    add_library(arm src/arm.cpp)

Not reported
    Tests; targets under a condition that is unknown on the target; packages that call commands which nobody is known to
    define, since these may call it.
"""

import re
from collections.abc import Iterator

from ..vocabulary import Diagnostic, Package, TargetView, Text, rule


@rule(
    severity="warning",
    texts={
        "": Text("catkin_package() is called after {targets}", "call it before add_library() and add_executable()"),
        "never": Text("catkin is found, but catkin_package() is never called", "call it after find_package(catkin)"),
    },
)
def catkin_package_order(view: TargetView, package: Package):
    call = package.build.catkin_package
    if package.build_type != "catkin":
        return
    if call is None:
        yield from _find_none(view, package)
        return
    before = set(package.build.before_catkin_package)
    early = tuple(
        target.name
        for target in package.build.targets
        if target.name in before
        and target.kind in ("library", "executable", "module")
        and view.is_sure(target.conditions)
    )
    if early:
        yield Diagnostic(call, "catkin_package", package.name, {"targets": early})


def _find_none(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    """The place where catkin is found, in a package in which nothing may call catkin_package()."""
    build, known = package.build, view.providers.commands.get(view.target.ros, {})
    commands = {use.name for use in build.uses if use.kind == "command"}
    found = next((f for f in build.found if f.name == "catkin" and view.is_sure(f.conditions)), None)
    parts = tuple(f"{f.name}_" for f in build.found)
    harmless = all(name in known or name.startswith(parts) for name in commands)
    if found is not None and not build.unresolved and harmless and not re.search("package|export", " ".join(commands)):
        yield Diagnostic(found.at, "catkin_package", package.name, kind="never")
