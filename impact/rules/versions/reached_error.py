"""reached-error: an `#error` of a C++ file is reached on a target.

What it does
    Reports `#error` lines in compiled files under conditions that hold on the target: macros that CMake defines for
    distros, and versions of packages and libraries.

Why it breaks
    The compiler stops with this message.

Severity
    error; warning where CMake may not reach the target that compiles the file; note in tests of ROS 1.

Example
    #if defined(ROS_HUMBLE)
    using Status = bool;
    #else
    #error "unsupported distro"
    #endif

Use instead
    #if defined(ROS_HUMBLE)
    using Status = bool;
    #elif defined(ROS_JAZZY)
    using Status = std::optional<bool>;
    #endif

Not reported
    Conditions that cannot be decided, and those that test neither distros nor versions.
"""

from ..vocabulary import Diagnostic, Package, TargetView, Text, list_place_doubts, rule


@rule(
    preview=True,
    group="refused-distro",
    texts={
        "said": Text("the compiler stops on {distro}: `{message}`", help="add a branch for {distro}"),
        "mute": Text("the compiler stops on {distro} at an `#error`", help="add a branch for {distro}"),
    },
)
def reached_error(view: TargetView, package: Package):
    for error in package.linked.errors:
        asked = any("ROS_DISTRO" in one.text or "VERSION" in one.text for one in error.conditions)
        if not asked or not view.is_sure(error.conditions):
            continue
        message = error.text.strip('"')
        data = {"distro": view.target.distro, "message": message}
        doubts = list_place_doubts(view, error.role, error.conditions)
        yield Diagnostic(error.at, "#error", package.name, data, "said" if message else "mute", doubts)
