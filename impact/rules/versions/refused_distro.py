"""refused-distro: CMakeLists.txt stops with an error on a target.

What it does
    Reports message(FATAL_ERROR) under conditions on ROS_DISTRO that hold on the target.

Why it breaks
    CMake stops with this message when it configures the package.

Example
    if("$ENV{ROS_DISTRO}" STREQUAL "humble")
      add_compile_definitions(ROS_HUMBLE)
    else()
      message(FATAL_ERROR "unsupported distro")
    endif()

Use instead
    if("$ENV{ROS_DISTRO}" STREQUAL "humble")
      add_compile_definitions(ROS_HUMBLE)
    endif()

Not reported
    Conditions that cannot be decided, and those that do not test ROS_DISTRO. No other finding in the files of such a
    package, but in its manifest, is reported on that target.
"""

from collections.abc import Iterator

from ..vocabulary import Diagnostic, Package, TargetView, Text, rule


@rule(
    texts=Text("CMakeLists.txt stops on {distro}: {message}", help="add a branch for {distro}"),
)
def refused_distro(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    stop = view.find_stop(package)
    if stop is not None:
        at, message, _ = stop
        data = {"distro": view.target.distro, "message": f"`{message}`" if message else "message(FATAL_ERROR)"}
        yield Diagnostic(at, "FATAL_ERROR", package.name, data)
