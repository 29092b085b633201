"""mismatched-project-name: the CMake project is not called as package.xml calls the package.

What it does
    Compares project() with the name in package.xml, where catkin_package() or ament_package() is called.

Why it breaks
    catkin_package() and ament_package() stop: "the package name in package.xml does not match the project name".

Severity
    error; warning where CMake may not reach the place.

Example
    project(estimation)                         # and <name>estimator</name>

Use instead
    project(estimator)

Not reported
    Another project() after catkin_package() or ament_package().
"""

from ..vocabulary import Package, TargetView, Text, rule
from .refused_names import diagnose_refused


@rule(
    group="refused-cmake-name",
    texts=Text(
        "the project is called `{subject}`, but package.xml names the package `{package}`, so CMake stops",
        "project({package})",
    ),
)
def mismatched_project_name(view: TargetView, package: Package):
    yield from diagnose_refused(view, package, "project")
