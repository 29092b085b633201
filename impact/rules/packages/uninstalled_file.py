"""uninstalled-file: a file that is opened where the package is installed is not installed.

What it does
    Compares the install rules of CMake, or data_files of setup.py, with the launch files and data that launch files and
    scripts of the workspace open in the package's share folder, and with the folder `launch` of packages of ROS 2, and
    of ROS 1 where other folders are installed. Reports packages of catkin that compile and install nothing.

Why it breaks
    Everything works from the source tree (catkin's devel space, symlinked installs), and the installed robot lacks it.

Severity
    error for a folder of launch files of ROS 2, which `ros2 launch` finds nowhere else; warning; note in ROS 1 where
    the distro has ended, since nothing is released into it any more.

Example
    install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})         # and a launch file opens config/robot.yaml

Use instead
    install(DIRECTORY launch config DESTINATION share/${PROJECT_NAME})

Not reported
    Files that the build makes; folders in which only programs have left something, such as locks; names that are not
    known; data_files that setup.py computes.
"""

import posixpath
import re
from collections.abc import Iterator, Mapping

from ...model.package import find_folder_role
from ..vocabulary import At, Diagnostic, Doubt, Package, TargetView, Text, Together, rule
from .data_files import list_copied
from .install_rules import (
    LAUNCH_FILE,
    is_installed,
    list_install_doubts,
    list_places,
    list_references,
    read_installs,
)

_OPENED = "`{file}` is opened through the package's share folder ({opener}) but is not installed"
_LAUNCHED = "`{file}` cannot be launched: the folder `{subject}` is not installed"
_INSTALL_FOLDER = "install(DIRECTORY {subject} DESTINATION {share})"
_ADD_FOLDER = "add `('{share}/{subject}', glob('{subject}/*'))` to data_files"
_FOLDERS = (Together("folder not installed", few=3),)
_DATA = ("launch", "urdf", "meshes", "robots", "worlds")


@rule(
    group="missing-install",
    texts={
        "nothing": Text(
            "`{package}` installs nothing, but it has {folders}",
            "install(DIRECTORY {listed} DESTINATION ${{CATKIN_PACKAGE_SHARE_DESTINATION}})",
        ),
        "opened": Text(_OPENED, _INSTALL_FOLDER),
        "opened, data_files": Text(_OPENED, _ADD_FOLDER),
        "elsewhere": Text(
            "`{file}` is opened through the package's share folder ({opener}) but is installed elsewhere",
            "install it as {share}/{file}",
        ),
        "launch": Text(_LAUNCHED, _INSTALL_FOLDER),
        "launch, data_files": Text(_LAUNCHED, _ADD_FOLDER),
    },
)
def uninstalled_file(view: TargetView, package: Package):
    opened = _list_exported(package) | list_references(view, package, "file", "place")
    installs = read_installs(view, package)
    if installs is None:
        if copied := list_copied(package):
            yield from _list_opened(package, copied, opened, ())
    elif not installs and package.build_type == "catkin" and not package.build.targets:
        yield from _list_nothing(package, opened, list_install_doubts(view, package))
    else:
        yield from _list_opened(package, installs, opened, list_install_doubts(view, package))


def _list_exported(package: Package) -> dict[str, At]:
    """The files that the manifest exports to whoever reads it, and where: not those of tests, the settings of
    documentation, nor descriptions of plugins, which uninstalled-plugin-description looks at."""
    exports = [export for export in package.manifest.exports if not export.tag.startswith("rosdoc")]
    found = {}
    for export in exports:
        values = [(export.text, (export.line, export.column))]
        values += ((value, export.places[key]) for key, value in export.attributes.items() if key != "plugin")
        for value, (line, column) in values:
            name = value.removeprefix("${prefix}/")
            if posixpath.join(package.path, name) in package.files and find_folder_role(name) is None:
                found[name] = At(package.linked.manifest_path, line, column + len(value) - len(name))
    return found


def _list_nothing(package: Package, opened: Mapping[str, At], doubts: tuple[Doubt, ...]) -> Iterator[Diagnostic]:
    """A package that compiles nothing and installs nothing. opened: what launch files and scripts open in it. doubts:
    of list_install_doubts()."""
    inside = {posixpath.normpath(name).split("/")[0] for name in opened}
    folders = tuple(folder for folder in (*_DATA, *sorted(inside - {*_DATA})) if package.has_files(folder))
    if folders and package.build.catkin_package is not None and not package.manifest.metapackage:
        data = {"folders": folders, "listed": " ".join(folders)}
        doubts = (Doubt.DISTURBS, *doubts)
        yield Diagnostic(package.build.catkin_package, "install", package.name, data, "nothing", doubts)


def _list_opened(
    package: Package, installs, opened: Mapping[str, At], ended: tuple[Doubt, ...]
) -> Iterator[Diagnostic]:
    """Launch files and data that something of the workspace opens, and launch files of ROS 2, that no rule puts into
    the share folder at the path by which they are opened. ended: of list_install_doubts()."""
    missing: dict[str, tuple[str, str, str]] = {}
    catkin = package.build_type == "catkin"
    places = list_places(package, installs)
    for name in sorted(name for name in opened if "$" not in name):
        path = posixpath.normpath(posixpath.join(package.path, name))
        files = [path] if path in package.files else _list_below(package, path)
        inside = posixpath.relpath(path, package.path or ".")
        left_by_programs = files != [path] and all(map(_LEFT_BY_PROGRAMS.search, files))
        if not files or inside == "." or left_by_programs or _lies_in(places, package.name, inside):
            continue
        taken = any(is_installed(installs, file) for file in files)
        if not taken or places is not None:
            opener = f"{opened[name].path}:{opened[name].line}"
            missing.setdefault(inside.split("/")[0], (inside, "elsewhere" if taken else "opened", opener))
    missing.pop("package.xml", None)  # every build type installs it
    if name := _find_launch_file(package, installs):
        missing.setdefault("launch", (name, "launch", ""))
    for folder, (name, kind, opener) in missing.items():
        build = package.build
        at = build.packaged or At(build.files[0] if build.files else installs[0].at.path, 1)
        share = "${CATKIN_PACKAGE_SHARE_DESTINATION}" if catkin else "share/${PROJECT_NAME}"
        if package.build_type == "ament_python":
            share, kind = f"share/{package.name}", f"{kind}, data_files" if kind != "elsewhere" else kind
        data = {"file": name, "share": share, "opener": opener}
        # ROS 1 finds all of it in the source space too; what is opened may be opened on request alone.
        doubts = () if kind.startswith("launch") and not catkin else (Doubt.DISTURBS,)
        yield Diagnostic(at, folder, package.name, data, kind, (*doubts, *ended), together=_FOLDERS)


# What keeps an empty folder in a repository, and what a program that has its state in a folder leaves there.
_LEFT_BY_PROGRAMS = re.compile(r"(?:/\.[^/]*|\.(?:lock|pid|log))\Z")


def _list_below(package: Package, folder: str) -> list[str]:
    """The files of a folder of the package."""
    return [path for path in package.linked.files if path.startswith(f"{folder}/")] if folder in package.folders else []


def _lies_in(places: frozenset[str] | None, package: str, inside: str) -> bool:
    """Whether a file or folder is found where the package is installed, by its path below the share folder. roslaunch
    looks for a program by its name alone in lib/<package>. Source: _find_executable() of its substitution_args.py."""
    name = posixpath.basename(inside)
    return places is not None and not places.isdisjoint((f"share/{package}/{inside}", f"lib/{package}/{name}"))


def _find_launch_file(package: Package, installs) -> str:
    """Where no rule installs any file of the folder of launch files, one in it that starts or opens something: in
    ROS 1, which finds them in the source space too, an installed program of the package, or anything where other
    folders of it are installed. Empty where there is none."""
    files = _list_below(package, posixpath.join(package.path, "launch"))
    if package.build.packaged is None and package.build_type != "ament_python":
        return ""  # what comes after a command that cannot be followed is not known
    if any(is_installed(installs, path) for path in files):
        return ""
    catkin = package.build_type == "catkin"
    # What ROS 2 starts has to be installed, which missing-install tells where it is not.
    made = () if catkin else (target.output_name or target.name for target in package.build.targets)
    programs = package.build.installed_targets.union(made)
    siblings = catkin and any(i.kind == "directory" and i.destination.split("/")[0] == "share" for i in installs)
    for use in package.linked.references:
        path, r = use.at.path, use.reference
        own = siblings or ((r.kind, r.package) == ("executable", package.name) and r.name in programs)
        if use.role == "run" and path in files and (own or (not catkin and LAUNCH_FILE.search(path))):
            return package.strip_path(path)
    return ""
