"""missing-scope-keyword: a command of CMake gives a target something without PUBLIC, PRIVATE or INTERFACE.

What it does
    Reports calls of target_include_directories(), target_compile_definitions(), target_compile_options(),
    target_compile_features() and target_sources() in which something else stands where the keyword has to be, as a
    second target does.

Why it breaks
    CMake stops: "called with invalid arguments".

Severity
    error; warning where CMake may not reach the place.

Example
    target_include_directories(tracker filter PUBLIC include)

Use instead
    target_include_directories(tracker PUBLIC include)
    target_include_directories(filter PUBLIC include)

Not reported
    Arguments that cannot be resolved, since a variable may hold the keyword.
"""

from ..vocabulary import Package, TargetView, Text, rule
from .refused_names import diagnose_refused


@rule(
    group="refused-cmake-name",
    texts=Text(
        "`{subject}` stands where PUBLIC, PRIVATE or INTERFACE has to be, so CMake stops",
        "write one of these keywords behind the target",
    ),
)
def missing_scope_keyword(view: TargetView, package: Package):
    yield from diagnose_refused(view, package, "no scope")
