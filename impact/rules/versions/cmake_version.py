"""cmake-version: cmake_minimum_required does not fit a target's CMake.

What it does
    Compares the version with the CMake of the target's platform: newer than it has, or older than CMake 4 accepts, in
    files of subdirectories and in cmake_policy(VERSION) too. Also reports commands, modules and policies that only
    newer versions of CMake have, policies that are set to OLD and can only be NEW, and commands and modules that the
    policies of the version that is asked for take away.

Why it breaks
    CMake stops when a project asks for a newer CMake or uses a feature of one, and since 4.0 when it asks for
    compatibility with less than 3.5. Policies that are as old can only be NEW in it. A module that a policy takes away,
    such as FindPythonInterp from 3.27 on, is not found.

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

from ...model.cmake.names import MODULE_OF, SINCE
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
        "policies": Text(
            "CMake {version} does not accept policies of CMake {subject}", help="ask for those of 3.5 or newer"
        ),
        "old policy": Text(
            "`{subject}` cannot be OLD in CMake {version} (only NEW since {since})",
            "set it to NEW, or drop the call",
        ),
        "dropped": Text(
            "CMake {version} has no `{subject}` under the policies of CMake {since} ({policy} is NEW)",
            "port to its successor, or set {policy} to OLD before",
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
    yield from _list_policies(view, package, cmake)


def _list_features(view: TargetView, package: Package, cmake: str) -> Iterator[Diagnostic]:
    seen = set()
    for use in package.build.uses:
        if use.kind != "feature" or use.name in seen or is_at_least(cmake, use.context):
            continue
        if not view.is_sure(use.conditions):
            continue
        if _is_found_otherwise(view, MODULE_OF.get(use.name, use.name)):
            continue
        seen.add(use.name)
        yield Diagnostic(use.at, use.name, package.name, {"version": cmake, "since": use.context}, kind="feature")


def _is_found_otherwise(view: TargetView, module: str) -> bool:
    """Whether a find module may be none of CMake's: the library installs a configuration, or the tree has a module."""
    name = module.removeprefix("Find")
    return name != module and bool(
        view.providers.find_installed_cmake(name) or view.workspace.find_modules.get(name)
    )


def _list_policies(view: TargetView, package: Package, cmake: str) -> Iterator[Diagnostic]:
    """Policies that this CMake refuses, and what those that it follows take away."""
    for use in package.build.uses:
        data = {"version": cmake}
        if not view.is_sure(use.conditions):
            continue
        if use.kind == "policies":
            low, _, high = use.name.partition("...")
            if low[:1].isdigit() and is_at_least(cmake, "4.0") and not is_at_least(high or low, "3.5"):
                yield Diagnostic(use.at, low, package.name, data, kind="policies")
        elif use.kind == "old policy" and is_at_least(cmake, use.context):
            yield Diagnostic(use.at, use.name, package.name, {**data, "since": use.context}, kind="old policy")
        elif use.kind == "dropped" and is_at_least(cmake, since := SINCE.get(use.context, "3.0")):
            if _is_found_otherwise(view, use.name):
                continue
            named = {**data, "since": since, "policy": use.context}
            yield Diagnostic(use.at, use.name, package.name, named, kind="dropped")
