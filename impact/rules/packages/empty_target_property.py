"""empty-target-property: a property of a target gets no value, since its variable is empty.

What it does
    Reports set_target_properties() whose value is the version of a project that has none.

Why it breaks
    CMake stops: "set_target_properties called with incorrect number of arguments".

Severity
    error; warning where CMake may not reach the place.

Example
    project(estimator)
    set_target_properties(filter PROPERTIES VERSION ${PROJECT_VERSION})

Use instead
    project(estimator VERSION 1.2.0)

Not reported
    Versions that something sets, and packages whose CMake code cannot be read in full.
"""

from ..vocabulary import Package, TargetView, Text, rule
from .refused_names import diagnose_refused


@rule(
    group="refused-cmake-name",
    texts=Text(
        "`{subject}` is empty, so a target property has no value and CMake stops", "give project() a version"
    ),
)
def empty_target_property(view: TargetView, package: Package):
    yield from diagnose_refused(view, package, "no value")
