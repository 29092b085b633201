"""nonexistent-target: a CMake command is given a target that does not exist, or not yet.

What it does
    Reports names that are given include directories, libraries or properties, and that no command adds as a target,
    that a later command adds, or that only branches for other distros add.

Why it breaks
    CMake stops: "Cannot specify link libraries for target which is not built by this project".

Severity
    error; warning where CMake may not reach the place.

Example
    target_link_libraries(tracker Eigen3::Eigen)
    add_library(tracker src/tracker.cpp)

Use instead
    add_library(tracker src/tracker.cpp)
    target_link_libraries(tracker Eigen3::Eigen)

Not reported
    Names that cannot be resolved, and targets that a command which is not known may add.
"""

from ..vocabulary import Diagnostic, Package, TargetView, Text, list_place_doubts, rule
from .refused_names import list_refused


@rule(
    group="refused-cmake-name",
    texts={
        "no target": Text("`{subject}` is not a CMake target, so CMake stops", "name a target that the package adds"),
        "too early": Text("`{subject}` is used as a target before it is added, so CMake stops", "add the target first"),
        "branch": Text(
            "`{subject}` is no target on {distro}, since other distros alone add it, so CMake stops",
            "add the target on {distro} too",
        ),
    },
)
def nonexistent_target(view: TargetView, package: Package):
    added = {target.name for target in package.build.targets if target.kind != "unknown"}
    for refused in list_refused(view, package, "no target", "branch"):
        kind = "too early" if refused.kind == "no target" and refused.name in added else refused.kind
        doubts = list_place_doubts(view, "build", refused.conditions)
        yield Diagnostic(refused.at, refused.name, package.name, {"distro": view.target.distro}, kind, doubts)
