"""generator-expression-folder: install(DIRECTORY) is given a generator expression, which ament cannot link.

What it does
    Reports generator expressions among the folders of install(DIRECTORY) in ament packages.

Why it breaks
    `colcon build --symlink-install` stops: ament's own install(DIRECTORY), which links files instead of copying them,
    takes the expression for the name of a folder.

Severity
    warning, since installing copies works.

Example
    install(DIRECTORY $<BUILD_INTERFACE:config> DESTINATION share/${PROJECT_NAME})

Use instead
    install(DIRECTORY config DESTINATION share/${PROJECT_NAME})

Not reported
    Rules with USE_SOURCE_PERMISSIONS or patterns that ament leaves to CMake.
"""

from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule
from .install_rules import list_copying_rules


@rule(
    group="nonexistent-install",
    doubts=(Doubt.CONDITIONAL,),
    texts=Text(
        "`colcon build --symlink-install` treats `{subject}` as the name of a folder", "write the folder itself"
    ),
)
def generator_expression_folder(view: TargetView, package: Package):
    if package.build.ament_package is None:
        return
    for install in list_copying_rules(view, package):
        # Source: ament_cmake_symlink_install_directory.cmake of ament_cmake_core.
        copies = install.executable or install.only or any("~" in pattern for pattern in install.patterns)
        if install.kind != "directory" or install.optional or copies:
            continue
        for item in install.items:
            if "$<" in item:
                subject = item.replace(f"{package.path}/", "") if package.path else item
                yield Diagnostic(install.at, subject, package.name)
