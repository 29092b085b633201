"""cmake-version: cmake_minimum_required does not fit a target's CMake.

What it does
    Compares the version with the CMake of the target's platform: newer than it has, or older than CMake 4 accepts.

Why it breaks
    CMake stops when a project asks for a newer CMake, and since 4.0 when it asks for compatibility with less than 3.5.

Severity
    error: CMake stops at the first line.

Example
    cmake_minimum_required(VERSION 2.8.3)       # CMake 4 stops here

Use instead
    cmake_minimum_required(VERSION 3.5...3.28)

Not reported
    Versions that are not plain numbers, and platforms whose CMake is not known.
"""

from ...model.view import TargetView
from ...model.workspace import Package
from ...targets.version import at_least, compare
from ..rule import Diagnostic, Text, rule


@rule(
    texts={
        "newer": Text(
            "`cmake_minimum_required` asks for CMake {subject}, but the target has {version}",
            help="ask for at most CMake {version}",
        ),
        "older": Text(
            "CMake {version} does not accept projects for CMake {subject}",
            help="write `cmake_minimum_required(VERSION 3.5)` or newer",
        ),
    },
)
def cmake_version(view: TargetView, package: Package):
    cmake = view.target.library("cmake")
    if not cmake:
        return
    if package.build.minimum is None:
        return
    text, at = package.build.minimum
    low, _, high = text.partition("...")
    if not low[:1].isdigit():
        return
    if compare(low, cmake) > 0:
        yield Diagnostic(at, low, package.name, {"version": cmake}, kind="newer")
    elif at_least(cmake, "4.0") and not at_least(high or low, "3.5"):
        yield Diagnostic(at, low, package.name, {"version": cmake}, kind="older")
