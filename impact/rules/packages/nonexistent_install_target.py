"""nonexistent-install-target: install(TARGETS) names what is not a CMake target.

What it does
    Reports names in install(TARGETS) that no command of the package adds as a target, or only where an option is set
    that is not set by default.

Why it breaks
    CMake stops: "install TARGETS given target which does not exist".

Example
    add_executable(crane_node src/crane.cpp)
    install(TARGETS crane DESTINATION lib/${PROJECT_NAME})

Use instead
    install(TARGETS crane_node DESTINATION lib/${PROJECT_NAME})

Not reported
    Packages whose CMake code cannot be read in full, or that call the build of something else; names that are given to
    a function of another package of which it is not known what it does.
"""

import re

from ...model.cmake.interpreter import is_modelled
from ..vocabulary import Diagnostic, Package, TargetView, Text, rule
from .install_rules import read_installs


@rule(
    group="nonexistent-install",
    texts=Text("install(TARGETS) names `{subject}`, which is not a CMake target, so CMake stops", "add it, or drop it"),
)
def nonexistent_install_target(view: TargetView, package: Package):
    if package.build.may_add_targets:
        return
    added = {t.name for t in package.build.targets if t.kind != "unknown"}
    for use in package.build.uses:
        if use.kind == "command" and not is_modelled(use.name, use.conditions):
            added.update(use.makes)
    for install in read_installs(view, package) or ():
        if install.kind == "targets" and view.is_sure(install.conditions):
            for item in install.items:
                if item not in added and not re.search(r"[$*<]", item):
                    yield Diagnostic(install.at, item, package.name)
