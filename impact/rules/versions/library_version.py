"""library-version: CMake asks for a version of a library that a target does not have.

What it does
    Compares the version in find_package(X n) and pkg_check_modules(... x>=n) with the platform's version of the
    library, by the rule that the library's own configuration uses (same major for OpenCV, at least for Boost ...).

Why it breaks
    CMake stops: "Could not find a configuration file that is compatible with requested version".

Severity
    error for an unconditional REQUIRED request; warning for a REQUIRED one under a condition that is not known; note
    for an optional one.

Example
    find_package(OpenCV 3 REQUIRED)             # Ubuntu focal and newer have 4

Use instead
    find_package(OpenCV REQUIRED)               # and code for both, by CV_VERSION_MAJOR

Not reported
    Requests beside another one for the same library that the platform satisfies; libraries whose version is not known.
"""

from ...model.cmake.build import FoundPackage
from ...targets.providers.library import check_version
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule


@rule(
    texts=Text(
        "CMake asks for {subject} {requested}, but the target has {version}",
        help="ask for a version that all targets have, or for no version",
    ),
)
def library_version(view: TargetView, package: Package):
    for found in package.build.found:
        version = _find_refused(view, found)
        if not version or found.name in view.workspace.packages:
            continue
        # A second, weaker request beside it (`find_package(OpenCV 4 QUIET)` then 3) means that both are handled.
        others = [f for f in package.build.found if f.name == found.name and f is not found]
        if any(not _find_refused(view, other) or other.quiet for other in others) or found.quiet:
            continue
        data = {"version": version, "requested": found.version}
        doubts = (
            found.required or Doubt.DISPENSABLE,
            view.is_sure(found.conditions) or Doubt.CONDITIONAL,
            not view.unknown_contents.is_likely(package, found.name) or Doubt.INCOMPLETE,
        )
        yield Diagnostic(found.at, found.name, package.name, data, doubts=doubts)


def _find_refused(view: TargetView, found: FoundPackage) -> str:
    """The version of a library that the target has, where it is not what is asked for."""
    answer = check_version(view.target, found.name, found.version, found.exact) if found.version else None
    return "" if answer is None or answer.holds else answer.version
