"""missing-package-call: CMake never calls what makes a package known to others.

What it does
    Reports packages of ament_cmake whose CMake code never calls ament_package() or ament_auto_package(), and packages
    of catkin that never call catkin_package().

Why it breaks
    The package builds, and its files are installed. Nothing tells where it is: `ros2 run`, launch files and
    find_package() do not find it. In catkin's devel space, launch files find it in the source tree, and its programs
    where a macro such as generate_messages() or generate_dynamic_reconfigure_options() calls catkin_destinations().

Severity
    error where another package of the workspace finds it, or launch files look for it; warning otherwise, also where
    they look for a package of catkin that only fails where it is installed.

Example
    install(PROGRAMS scripts/trim.py DESTINATION lib/${PROJECT_NAME})
    # the end of CMakeLists.txt

Use instead
    install(PROGRAMS scripts/trim.py DESTINATION lib/${PROJECT_NAME})
    ament_package()

Not reported
    CMake code that calls commands which nobody is known to have, or that is not known in full; code of rosbuild.
"""

from collections.abc import Collection

from ...model.cmake.interpreter import is_modelled
from ..vocabulary import At, Diagnostic, Doubt, Package, TargetView, Text, rule
from .dependants import is_found_elsewhere

_HELP = "call {subject}()[[ after find_package({after})]][[ at the end of {file}]]"
_CALLS = {
    "ament_cmake": ("ament_package", {"after": "", "file": "CMakeLists.txt"}),
    "catkin": ("catkin_package", {"after": "catkin", "file": ""}),
}


@rule(
    group="missing-install",
    texts={
        "": Text("CMake never calls {subject}(), so nothing finds `{package}`", _HELP),
        "installed": Text("CMake never calls {subject}(), so nothing finds `{package}` once it is installed", _HELP),
    },
)
def missing_package_call(view: TargetView, package: Package):
    build = package.build
    if package.build_type not in _CALLS or not build.files or not build.project or build.unresolved:
        return
    if build.packaged is not None or package.manifest.metapackage:
        return
    known = view.providers.commands.get(view.target.ros, {})
    called = {use.name for use in build.uses if use.kind == "command"}
    foreign = {name for name in called if not is_modelled(name, ())}
    if any(name.startswith("rosbuild_") for name in called) or not foreign <= known.keys():
        return
    command, data = _CALLS[package.build_type]
    found = is_found_elsewhere(view, package)
    if package.build_type == "ament_cmake":
        found = found or _is_launched(view, package)
    elif not build.catkin_destinations and not foreign:  # which may call catkin_destinations()
        found = found or _is_launched(view, package, {t.name for t in build.targets if t.kind == "executable"})
    kind = "" if found or package.build_type == "ament_cmake" else "installed"
    yield Diagnostic(At(build.files[0], 1), command, package.name, data, kind, (found or Doubt.DISTURBS,))


def _is_launched(view: TargetView, package: Package, programs: Collection[str] | None = None) -> bool:
    """Whether launch files or scripts of another package start or open something of one; only the named programs of it,
    where they are given."""
    others = (other for other in view.list_built() if other.name != package.name)
    references = (use.reference for other in others for use in other.linked.references)
    return any(
        r.package == package.name and (programs is None or (r.kind == "executable" and r.name in programs))
        for r in references
    )
