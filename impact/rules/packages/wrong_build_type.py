"""wrong-build-type: package.xml exports no build type, or one that its files do not fit.

What it does
    Reports packages of ROS 2 that export the build type `ament_python` and have no setup.py, those that export one of
    CMake and have no CMakeLists.txt, and those that export none and either call ament_package() or have a setup.py
    alone. Reports misspelt build types, those that are packages of ament_cmake, and packages that are built with catkin
    in ROS 1 and export one of ament there.

Why it breaks
    colcon asks setup.py or CMakeLists.txt what to build, and leaves out a package whose build type nothing can build;
    so does catkin_make_isolated, and catkin_make stops. A package without a build type is one of catkin: colcon has
    CMake build it, and does not add it to AMENT_PREFIX_PATH, so that neither `ros2 run` nor other packages find it.

Severity
    error; warning for packages without a build type that CMake builds.

Example
    <build_type>ament_python</build_type>       <!-- beside CMakeLists.txt -->

Use instead
    <build_type>ament_cmake</build_type>

Not reported
    Packages of ROS 2 with a pyproject.toml; build types of which nothing is known.
"""

import posixpath
from collections.abc import Iterator

from ...model.misspelling import is_slip
from ...model.package import build_type_of
from ..vocabulary import At, Diagnostic, Doubt, Package, TargetView, Text, rule

# What colcon, its known extensions, catkin_make_isolated and catkin_tools can build between them.
_BY_CMAKE = ("ament_cmake", "cmake")
_KNOWN = (*_BY_CMAKE, "ament_python", "ament_cargo", "ament_gradle", "ament_meson", "ament_nodejs", "catkin")
_HELP = "export `<build_type>{replacement}</build_type>`"


@rule(
    scope="target",
    group="invalid-manifest",
    texts={
        "no setup": Text(
            "`{package}` has the build type `{subject}`, but no setup.py", "add setup.py[[, or write `{replacement}`]]"
        ),
        "no cmake": Text(
            "`{package}` has the build type `{subject}`, but no CMakeLists.txt",
            "add CMakeLists.txt[[, or write `{replacement}`]]",
        ),
        "none": Text("package.xml exports no build type, so `{package}` is built as a package of catkin", _HELP),
        "misspelt": Text("nothing builds packages of the build type `{subject}`", "did you mean `{replacement}`?"),
        "ros1": Text(
            "catkin does not build `{package}`, since package.xml exports the build type `{subject}` for ROS 1 too",
            'export `<build_type condition="$ROS_VERSION == 2">{subject}</build_type>`',
        ),
    },
)
def wrong_build_type(view: TargetView) -> Iterator[Diagnostic]:
    for package in view.workspace:  # with those that a wrong type keeps from being built
        found = _find_fault(view, package) if view.reports_on(package.name) else None
        if found is not None:
            kind, subject, replacement = found
            exports = package.manifest.exports
            place = next(((one.line, one.column) for one in exports if one.text == subject), (1, 0))
            doubts = (Doubt.DISTURBS,) if kind == "none" and replacement == "ament_cmake" else ()
            at = At(package.linked.manifest_path, *place)
            yield Diagnostic(at, subject, package.name, {"replacement": replacement}, kind, doubts)


def _find_fault(view: TargetView, package: Package) -> tuple[str, str, str] | None:
    """What is wrong with the build type of a package: the kind of a text, the subject, and what it should be."""
    has_cmake, has_setup, has_project = (
        posixpath.join(package.path, name) in package.files for name in ("CMakeLists.txt", "setup.py", "pyproject.toml")
    )
    declared = build_type_of(package.manifest, view.target.ros)
    if view.target.ros == 1:
        tools = (d for d in package.manifest.dependencies if d.kind == "buildtool" and d.name == "catkin")
        if declared.startswith("ament") and any(view.is_declaration_active(tool.condition) for tool in tools):
            return "ros1", declared, ""
    elif not view.builds(package) or has_project:
        return None
    elif not package.manifest.build_types:
        scripts = has_setup and not has_cmake
        replacement = "ament_python" if scripts else "ament_cmake"
        return ("none", "build_type", replacement) if scripts or package.build.ament_package is not None else None
    elif declared in _BY_CMAKE and not has_cmake:
        return "no cmake", declared, "ament_python" if has_setup else ""
    elif declared == "ament_python" and not has_setup:
        return "no setup", declared, "ament_cmake" if has_cmake else ""
    if declared in _KNOWN:
        return None
    # `ament_cmake_python` is a package of CMake functions.
    meant = "ament_cmake" if declared.startswith("ament_cmake_") else ""
    meant = meant or next((name for name in _KNOWN if is_slip(declared, name)), "")
    return ("misspelt", declared, meant) if meant else None
