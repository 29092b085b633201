"""install-without-destination: install() of files has no DESTINATION.

What it does
    Reports install(FILES), install(PROGRAMS) and install(DIRECTORY) that name neither DESTINATION nor TYPE.

Why it breaks
    CMake stops: "install FILES given no DESTINATION".

Example
    install(DIRECTORY launch)

Use instead
    install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})

Not reported
    Rules whose arguments are in a variable, or that are under a condition that is unknown on the target.
"""

from ..vocabulary import Diagnostic, Package, TargetView, Text, rule
from .install_rules import list_copying_rules


@rule(
    group="nonexistent-install",
    texts=Text("install({kind}) has no {subject}, so CMake stops", "add it"),
)
def install_without_destination(view: TargetView, package: Package):
    for install in list_copying_rules(view, package):
        if not install.destination:
            yield Diagnostic(install.at, "DESTINATION", package.name, {"kind": install.kind.upper()})
