"""missing-package-call: CMake never calls what makes a package known to others.

What it does
    Reports packages of ament_cmake whose CMake code never calls ament_package() or ament_auto_package(), and packages
    of catkin that never call catkin_package().

Why it breaks
    The package builds, and its files are installed. Nothing tells where it is: `ros2 run`, launch files and
    find_package() do not find it.

Severity
    error where another package of the workspace finds it, or launch files look for it; warning otherwise.

Example
    install(PROGRAMS scripts/trim.py DESTINATION lib/${PROJECT_NAME})
    # the end of CMakeLists.txt

Use instead
    install(PROGRAMS scripts/trim.py DESTINATION lib/${PROJECT_NAME})
    ament_package()

Not reported
    CMake code that calls commands which nobody is known to have, or that is not known in full; code of rosbuild.
"""

from ...model.cmake.interpreter import is_modelled
from ..vocabulary import At, Diagnostic, Doubt, Package, TargetView, Text, rule

_CALLS = {"ament_cmake": "ament_package", "catkin": "catkin_package"}


@rule(
    group="missing-install",
    texts=Text("CMake never calls {subject}(), so nothing finds `{package}`", "call {subject}() at the end"),
)
def missing_package_call(view: TargetView, package: Package):
    build, wanted = package.build, _CALLS.get(package.build_type)
    if wanted is None or not build.files or not build.project or build.unresolved:
        return
    if build.ament_package is not None or build.catkin_package is not None or package.manifest.metapackage:
        return
    known = view.providers.commands.get(view.target.ros, {})
    called = {use.name for use in build.uses if use.kind == "command"}
    if any(name.startswith("rosbuild_") or not (is_modelled(name, ()) or name in known) for name in called):
        return
    found = any(other.name != package.name and _is_found_by(other, package.name) for other in view.list_built())
    path = build.files[0]
    yield Diagnostic(At(path, 1), wanted, package.name, doubts=(found or Doubt.DISTURBS,))


def _is_found_by(package: Package, name: str) -> bool:
    return any(f.name == name for f in package.build.found) or any(
        use.reference.package == name for use in package.digest.references
    )
