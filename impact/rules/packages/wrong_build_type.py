"""wrong-build-type: package.xml exports no build type, or one that its files do not fit.

What it does
    Reports packages of ROS 2 that export the build type `ament_python` and have no setup.py, and those that export none
    and either call ament_package() or have a setup.py alone.

Why it breaks
    colcon asks setup.py what to build. A package without a build type is one of catkin: colcon has CMake build it, and
    does not add it to AMENT_PREFIX_PATH, so that neither `ros2 run` nor other packages find it.

Severity
    error; warning for packages without a build type that CMake builds.

Example
    <build_type>ament_python</build_type>       <!-- beside CMakeLists.txt -->

Use instead
    <build_type>ament_cmake</build_type>

Not reported
    Build types of ROS 1; packages with a pyproject.toml.
"""

import posixpath

from ..vocabulary import At, Diagnostic, Doubt, Package, TargetView, Text, rule

_HELP = "export `<build_type>{replacement}</build_type>`"


@rule(
    group="invalid-manifest",
    texts={
        "no setup": Text(
            "`{package}` has the build type `{subject}`, but no setup.py", "add setup.py[[, or write `{replacement}`]]"
        ),
        "none": Text("package.xml exports no build type, so `{package}` is built as a package of catkin", _HELP),
    },
)
def wrong_build_type(view: TargetView, package: Package):
    path = package.linked.manifest_path
    has_cmake, has_setup, has_project = (
        posixpath.join(package.path, name) in package.files for name in ("CMakeLists.txt", "setup.py", "pyproject.toml")
    )
    if view.target.ros == 1 or has_project:
        return
    if not package.manifest.build_types:
        scripts = has_setup and not has_cmake
        if scripts or package.build.ament_package is not None:
            replacement = "ament_python" if scripts else "ament_cmake"
            doubts = (scripts or Doubt.DISTURBS,)
            yield Diagnostic(At(path, 1), "build_type", package.name, {"replacement": replacement}, "none", doubts)
    elif package.build_type == "ament_python" and not has_setup:
        line = next((one.line for one in package.manifest.exports if one.text == package.build_type), 1)
        data = {"replacement": "ament_cmake" if has_cmake else ""}
        yield Diagnostic(At(path, line), package.build_type, package.name, data, "no setup")
