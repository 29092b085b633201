"""cmake-version: cmake_minimum_required does not fit a target's CMake.

What it does
    Compares the version with the CMake of the target's platform: newer than it has, or older than CMake 4 accepts. Also
    reports commands, modules and policies that only newer versions of CMake have.

Why it breaks
    CMake stops when a project asks for a newer CMake or uses a feature of one, and since 4.0 when it asks for
    compatibility with less than 3.5.

Severity
    error: CMake stops.

Example
    cmake_minimum_required(VERSION 2.8.3)       # CMake 4 stops here

Use instead
    cmake_minimum_required(VERSION 3.5...3.28)

Not reported
    Versions that are not plain numbers, and platforms whose CMake is not known. Uses under a condition that may tell
    versions apart, such as if(COMMAND ...), and find modules whose library installs a configuration of its own.
"""

from collections.abc import Iterator

from ...targets.version import compare, is_at_least
from ..vocabulary import Diagnostic, Package, TargetView, Text, rule


@rule(
    texts={
        "newer": Text(
            "`cmake_minimum_required` asks for CMake {subject}, but the target has {version}",
            help="ask for at most CMake {version}",
        ),
        "feature": Text(
            "`{subject}` is not available in CMake {version} (added in {since})",
            "use it only if CMAKE_VERSION is {since} or newer",
        ),
        "older": Text(
            "CMake {version} does not accept projects for CMake {subject}",
            help="write `cmake_minimum_required(VERSION 3.5)` or newer",
        ),
    },
)
def cmake_version(view: TargetView, package: Package):
    cmake = view.target.find_library("cmake")
    if not cmake:
        return
    text, at = package.build.minimum or ("", None)
    low, _, high = text.partition("...")
    data = {"version": cmake}
    if low[:1].isdigit() and compare(low, cmake) > 0:
        yield Diagnostic(at, low, package.name, data, kind="newer")
        return
    if low[:1].isdigit() and is_at_least(cmake, "4.0") and not is_at_least(high or low, "3.5"):
        yield Diagnostic(at, low, package.name, data, kind="older")
    yield from _list_features(view, package, cmake)


def _list_features(view: TargetView, package: Package, cmake: str) -> Iterator[Diagnostic]:
    seen = set()
    for use in package.build.uses:
        if use.kind != "feature" or use.name in seen or is_at_least(cmake, use.context):
            continue
        if not view.is_sure(use.conditions):
            continue
        name = use.name.removeprefix("Find")
        if name != use.name and (view.providers.find_installed_cmake(name) or view.workspace.find_modules.get(name)):
            continue
        seen.add(use.name)
        yield Diagnostic(use.at, use.name, package.name, {"version": cmake, "since": use.context}, kind="feature")
