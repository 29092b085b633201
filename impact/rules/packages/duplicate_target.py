"""duplicate-target: CMake adds two targets with the same name.

What it does
    Reports a second add_executable(), add_library(), add_custom_target() or generated interface with the name of a
    target that the package already has.

Why it breaks
    CMake stops: "another target with the same name already exists".

Severity
    error; warning where CMake may not reach the place.

Example
    rosidl_generate_interfaces(tracker "msg/Track.msg")
    add_executable(tracker src/tracker.cpp)

Use instead
    add_executable(tracker_node src/tracker.cpp)

Not reported
    Targets in different branches of an if(), and those under if(NOT TARGET ...).
"""

from ..vocabulary import Package, TargetView, Text, rule
from .refused_names import diagnose_refused


@rule(
    group="refused-cmake-name",
    texts=Text("a target named `{subject}` already exists", "rename one of the two targets"),
)
def duplicate_target(view: TargetView, package: Package):
    yield from diagnose_refused(view, package, "twice")
