"""mixed-link-keywords: a target is linked with PUBLIC or PRIVATE and without.

What it does
    Compares all calls of target_link_libraries() and ament_target_dependencies() for a target.

Why it breaks
    CMake stops: "The keyword signature for target_link_libraries has already been used with the target".

Severity
    error; warning where CMake may not reach the place.

Example
    target_link_libraries(filter PUBLIC Eigen3::Eigen)
    target_link_libraries(filter tracker)

Use instead
    target_link_libraries(filter PUBLIC Eigen3::Eigen tracker)

Not reported
    Calls in different branches of an if().
"""

from ..vocabulary import Package, TargetView, Text, rule
from .refused_names import diagnose_refused


@rule(
    group="refused-cmake-name",
    texts=Text(
        "`{subject}` is linked with PUBLIC or PRIVATE and without, so CMake stops",
        "write the keyword in all calls of target_link_libraries() and ament_target_dependencies(), or in none",
    ),
)
def mixed_link_keywords(view: TargetView, package: Package):
    yield from diagnose_refused(view, package, "mixed")
