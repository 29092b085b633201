"""uninstalled-file: a file that is started or opened where the package is installed is not installed.

What it does
    Compares the install rules of CMake with the launch files, scripts and data that launch files and scripts of the
    workspace start or open in the package's share folder, and reports packages of catkin that only hold data and
    install nothing.

Why it breaks
    Everything works from the source tree (catkin's devel space, symlinked installs), and the installed robot lacks it.

Severity
    error for all of a package that only holds data which launch files open; warning otherwise: in a workspace that is
    never installed all of this works.

Example
    install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})         # and a launch file opens config/robot.yaml

Use instead
    install(DIRECTORY launch config DESTINATION share/${PROJECT_NAME})

Not reported
    Files that the build makes; names that are not known; packages without CMake.
"""

import posixpath
from collections.abc import Iterator

from ...model.cmake.build import At
from ...model.package import role_of_folder
from ...model.view import TargetView
from ..rule import Diagnostic, Doubt, Text, Together, rule
from .install_rules import is_installed, list_installing, list_references


@rule(
    scope="target",
    group="missing-install",
    texts={
        "nothing": Text(
            "`{package}` installs nothing, but it has {folders}",
            "install(DIRECTORY {listed} DESTINATION ${{CATKIN_PACKAGE_SHARE_DESTINATION}})",
        ),
        "opened": Text(
            "`{file}` is opened through the package's share folder but is not installed",
            "install(DIRECTORY {subject} DESTINATION {share})",
        ),
        "script": Text("`{subject}` is started by a launch file but is not installed", "{how}"),
        "beside": Text("`{subject}` is not installed, but other programs in its folder are", "{how}"),
    },
)
def uninstalled_file(view: TargetView):
    references = list_references(view)
    for package, installs in list_installing(view):
        used = references.get(package.name, {})
        if not installs and package.build_type == "catkin" and not package.build.targets:
            yield from _list_nothing(package, opened=bool(used))
        else:
            yield from _list_opened(package, installs, used.get("file", set()))
            yield from _list_scripts(package, installs, used.get("executable", set()))


_ONCE = (Together("not installed"),)
_DATA = ("launch", "urdf", "meshes", "robots", "worlds")


def _list_nothing(package, opened: bool) -> Iterator[Diagnostic]:
    """A package that only holds data, and installs none of it. opened: a launch file or a script opens files of it."""
    folders = tuple(folder for folder in _DATA if package.has_files(folder))
    if folders and package.build.catkin_package is not None and not package.manifest.metapackage:
        data = {"folders": folders, "listed": " ".join(folders)}
        doubts = (opened or Doubt.DISTURBS,)
        yield Diagnostic(package.build.catkin_package, "install", package.name, data, "nothing", doubts)


def _list_opened(package, installs, opened: set[str]) -> Iterator[Diagnostic]:
    """Launch files and data that something of the workspace opens and no rule installs."""
    missing: dict[str, str] = {}
    catkin = package.build_type == "catkin"
    for name in sorted(opened):
        path = posixpath.normpath(posixpath.join(package.path, name)) if "$" not in name else ""
        if path in package.files and not is_installed(package, installs, path):
            folder = name.split("/")[0] if "/" in name else name
            missing.setdefault(folder, name)
    missing.pop("package.xml", None)  # every build type installs it
    for folder, name in missing.items():
        at = package.build.catkin_package or package.build.ament_package or At(package.build.files[0], 1)
        share = "${CATKIN_PACKAGE_SHARE_DESTINATION}" if catkin else "share/${PROJECT_NAME}"
        data = {"file": name, "share": share}
        yield Diagnostic(at, folder, package.name, data, "opened", (Doubt.DISTURBS,), together=_ONCE)


def _list_scripts(package, installs, scripts: set[str]) -> Iterator[Diagnostic]:
    """Scripts that a launch file starts, or that lie beside programs that are installed, and that no rule installs."""
    programs = [item for i in installs if i.kind == "programs" for item in i.items]
    folders, others = {posixpath.dirname(item) for item in programs}, {posixpath.basename(item) for item in programs}
    for path in (*package.digest.scripts, *package.digest.shells):
        name, folder = posixpath.basename(path), posixpath.dirname(path)
        beside = folder in folders and folder != package.path and "." not in name and role_of_folder(name) is None
        if (name in scripts or beside) and name not in others and not is_installed(package, installs, path):
            how = "install(PROGRAMS ... DESTINATION lib/${PROJECT_NAME})"
            if package.build_type == "catkin" and path not in package.digest.shells:
                how = "catkin_install_python(PROGRAMS ...)"
            kind = "script" if name in scripts else "beside"
            yield Diagnostic(At(path, 1), name, package.name, {"how": how}, kind, (Doubt.DISTURBS,), together=_ONCE)
