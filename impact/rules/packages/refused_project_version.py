"""refused-project-version: project() has a version under the policies of a CMake before 3.0.

What it does
    Reports project(NAME VERSION ...) where cmake_minimum_required() asks for CMake 2.8 or older.

Why it breaks
    CMake stops: "VERSION not allowed unless CMP0048 is set to NEW".

Severity
    error; warning where CMake may not reach the place.

Example
    cmake_minimum_required(VERSION 2.8)
    project(estimator VERSION 1.2.0)

Use instead
    cmake_minimum_required(VERSION 3.5)
    project(estimator VERSION 1.2.0)

Not reported
    Files that set the policy CMP0048 themselves.
"""

from ..vocabulary import Package, TargetView, Text, rule
from .refused_names import diagnose_refused


@rule(
    group="refused-cmake-name",
    texts=Text(
        "project({subject}) with a version needs cmake_minimum_required(VERSION 3.0) or newer, so CMake stops",
        "ask for CMake 3.0 or newer",
    ),
)
def refused_project_version(view: TargetView, package: Package):
    yield from diagnose_refused(view, package, "version")
