"""target-without-sources: a library or program has no sources where CMake makes it.

What it does
    Reports add_library() and add_executable() whose sources are all from a file(GLOB) that matches no file, or all from
    branches for other distros than the target's.

Why it breaks
    CMake stops: "No SOURCES given to target".

Severity
    error; warning where CMake may not reach the place.

Example
    file(GLOB sources src/tracker/*.cpp)            # and the folder is called src/tracking
    add_executable(tracker ${sources})

Use instead
    file(GLOB sources src/tracking/*.cpp)

Not reported
    Patterns in folders that were not read, such as submodules, outside of the package, and below those that the build
    makes; targets that target_sources() gives more; packages with code that is not read.
"""

import posixpath
from collections.abc import Iterator

from ..vocabulary import Diagnostic, Package, TargetView, Text, list_place_doubts, rule
from .absent_paths import is_absent
from .refused_names import list_refused


@rule(
    group="refused-cmake-name",
    texts={
        "pattern": Text("`{subject}` has no sources, since no file matches `{pattern}`", "correct the pattern"),
        "branch": Text(
            "`{subject}` has no sources on {distro}, since branches for other distros alone give it some",
            "add a branch for {distro}",
        ),
    },
)
def target_without_sources(view: TargetView, package: Package):
    filled = {
        target.name
        for target in package.build.targets
        if target.sources or any(link.how == "objects" for link in target.links)
    }
    for refused in list_refused(view, package, "no sources"):
        patterns = [posixpath.normpath(pattern) for pattern in refused.patterns]
        inside = all(pattern.startswith(f"{package.path}/".lstrip("/")) for pattern in patterns)
        if inside and all(is_absent(view, package, pattern) for pattern in patterns) and refused.name not in filled:
            doubts = list_place_doubts(view, "build", refused.conditions)
            data = {"pattern": package.strip_path(refused.patterns[0])}
            yield Diagnostic(refused.at, refused.name, package.name, data, "pattern", doubts)
    yield from _list_left_out(view, package)


def _list_left_out(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    """Targets all of whose sources stand in branches for other distros."""
    targets = {target.name: target for target in package.build.targets}
    for refused in list_refused(view, package, "branch sources"):
        target = targets.get(refused.name)
        if target is None or set(target.sources) - set(refused.patterns):
            continue
        if not any(link.how == "objects" for link in target.links):
            data, doubts = {"distro": view.target.distro}, list_place_doubts(view, "build", refused.conditions)
            yield Diagnostic(refused.at, refused.name, package.name, data, "branch", doubts)
