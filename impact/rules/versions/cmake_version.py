"""cmake-version: cmake_minimum_required does not suit a target's CMake.

What it does
    Compares the version with the CMake of the target's platform: newer than it has, or older than CMake 4 accepts.

Why it breaks
    CMake refuses a project that asks for a newer CMake, and since 4.0 one that asks for compatibility with less than
    3.5.

Severity
    error: the configuration stops at its first line.

Example
    cmake_minimum_required(VERSION 2.8.3)       # CMake 4 stops here

Use instead
    cmake_minimum_required(VERSION 3.5...3.28)

Not reported
    A version that is not a plain number, and platforms whose CMake is not known.
"""

from ...model.view import View
from ...targets.version import at_least, compare
from ..rule import Hit, rule


@rule(severity="error")
def cmake_version(view: View):
    cmake = view.target.library("cmake")
    if not cmake:
        return
    for package in view:
        if package.build.minimum is None:
            continue
        text, at = package.build.minimum
        low, _, high = text.partition("...")
        if not low[:1].isdigit():
            continue
        if compare(low, cmake) > 0:
            yield Hit(
                at,
                low,
                f"CMake {low} is asked for and {view.target.platform} has {cmake}",
                f"ask for at most {cmake}",
                package.name,
            )
        elif at_least(cmake, "4.0") and not at_least(high or low, "3.5"):
            yield Hit(
                at,
                low,
                f"CMake {cmake} no longer accepts projects written for {low}",
                "cmake_minimum_required(VERSION 3.5) or newer",
                package.name,
            )
