"""target-without-sources: a library or program is made of what file(GLOB) finds, which is nothing.

What it does
    Reports add_library() and add_executable() whose sources are all from a file(GLOB) that matches no file.

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
    Patterns in folders that were not read, such as submodules, and below those that the build makes; targets that
    target_sources() gives more; packages with code that is not read.
"""

import posixpath

from ..vocabulary import Diagnostic, Package, TargetView, Text, list_place_doubts, rule
from .absent_paths import is_absent
from .refused_names import list_refused


@rule(
    group="refused-cmake-name",
    texts=Text("`{subject}` has no sources, since no file matches `{pattern}`", "correct the pattern"),
)
def target_without_sources(view: TargetView, package: Package):
    filled = {
        target.name
        for target in package.build.targets
        if target.sources or any(link.how == "objects" for link in target.links)
    }
    for refused in list_refused(view, package, "no sources"):
        inside = all(is_absent(view, package, posixpath.normpath(pattern)) for pattern in refused.patterns)
        if inside and refused.name not in filled:
            doubts = list_place_doubts(view, "build", refused.conditions)
            data = {"pattern": package.strip_path(refused.patterns[0])}
            yield Diagnostic(refused.at, refused.name, package.name, data, doubts=doubts)
