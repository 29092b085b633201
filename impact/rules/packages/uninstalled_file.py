"""uninstalled-file: a file that is started or opened where the package is installed is not installed.

What it does
    Compares the install rules of CMake, or data_files of setup.py, with the launch files, scripts and data that launch
    files and scripts of the workspace start or open in the package's share folder, and with the folder `launch` of
    packages of ROS 2, and of ROS 1 where other folders are installed. Reports packages of catkin that compile and
    install nothing, and nodes in Python of packages that install no program.

Why it breaks
    Everything works from the source tree (catkin's devel space, symlinked installs), and the installed robot lacks it.

Severity
    warning, since in a workspace that is never installed all of this works.

Example
    install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})         # and a launch file opens config/robot.yaml

Use instead
    install(DIRECTORY launch config DESTINATION share/${PROJECT_NAME})

Not reported
    Files that the build makes; names that are not known; data_files that setup.py computes.
"""

import posixpath
import re
from collections.abc import Iterator

from ...model.package import find_folder_role
from ..vocabulary import At, Diagnostic, Package, TargetView, Text, Together, rule
from .data_files import list_copied
from .install_rules import is_installed, list_places, list_references, read_installs

_OPENED = "`{file}` is opened through the package's share folder but is not installed"
_LAUNCHED = "`{file}` cannot be launched: the folder `{subject}` is not installed"
_INSTALL_FOLDER = "install(DIRECTORY {subject} DESTINATION {share})"
_ADD_FOLDER = "add `('{share}/{subject}', glob('{subject}/*'))` to data_files"
_INSTALL_PROGRAM = "install(PROGRAMS ... DESTINATION lib/${{PROJECT_NAME}})"
_PROGRAM = {
    "script": "`{subject}` is started by a launch file or script but is not installed",
    "node": "`{subject}` is a node, but no rule installs it",
    "beside": "`{subject}` is not installed, but other programs in its folder are",
}


@rule(
    severity="warning",
    group="missing-install",
    texts={
        "nothing": Text(
            "`{package}` installs nothing, but it has {folders}",
            "install(DIRECTORY {listed} DESTINATION ${{CATKIN_PACKAGE_SHARE_DESTINATION}})",
        ),
        "opened": Text(_OPENED, _INSTALL_FOLDER),
        "opened, data_files": Text(_OPENED, _ADD_FOLDER),
        "elsewhere": Text(
            "`{file}` is opened through the package's share folder but is installed elsewhere",
            "install it as {share}/{file}",
        ),
        "launch": Text(_LAUNCHED, _INSTALL_FOLDER),
        "launch, data_files": Text(_LAUNCHED, _ADD_FOLDER),
        **{kind: Text(text, _INSTALL_PROGRAM) for kind, text in _PROGRAM.items()},
        **{f"{kind}, catkin": Text(text, "catkin_install_python(PROGRAMS ...)") for kind, text in _PROGRAM.items()},
    },
)
def uninstalled_file(view: TargetView, package: Package):
    opened = list_references(view, package, "file", "place")
    started = list_references(view, package, "executable")
    installs = read_installs(view, package)
    if installs is None:
        if copied := list_copied(package):
            yield from _list_opened(package, copied, opened)
    elif not installs and package.build_type == "catkin" and not package.build.targets:
        yield from _list_nothing(package, opened)
    else:
        yield from _list_opened(package, installs, opened)
        yield from _list_scripts(package, installs, started)


_ONCE = (Together("not installed"),)
_FOLDERS = (Together("folder not installed", few=3),)
_DATA = ("launch", "urdf", "meshes", "robots", "worlds")


def _list_nothing(package: Package, opened: set[str]) -> Iterator[Diagnostic]:
    """A package that compiles nothing and installs nothing. opened: what launch files and scripts open in it."""
    inside = {posixpath.normpath(name).split("/")[0] for name in opened}
    folders = tuple(folder for folder in (*_DATA, *sorted(inside - {*_DATA})) if package.has_files(folder))
    if folders and package.build.catkin_package is not None and not package.manifest.metapackage:
        data = {"folders": folders, "listed": " ".join(folders)}
        yield Diagnostic(package.build.catkin_package, "install", package.name, data, "nothing")


def _list_opened(package: Package, installs, opened: set[str]) -> Iterator[Diagnostic]:
    """Launch files and data that something of the workspace opens, and launch files of ROS 2, that no rule puts into
    the share folder at the path by which they are opened."""
    missing: dict[str, tuple[str, str]] = {}
    catkin = package.build_type == "catkin"
    places = list_places(package, installs)
    for name in sorted(name for name in opened if "$" not in name):
        path = posixpath.normpath(posixpath.join(package.path, name))
        files = [path] if path in package.files else _list_below(package, path)
        inside = posixpath.relpath(path, package.path or ".")
        if not files or inside == "." or _lies_in(places, package.name, inside):
            continue
        kind = "opened"
        if any(is_installed(installs, file) for file in files):
            if places is None:
                continue
            kind = "elsewhere"
        missing.setdefault(inside.split("/")[0], (inside, kind))
    missing.pop("package.xml", None)  # every build type installs it
    for folder, name in _list_launch_folders(package, installs):
        missing.setdefault(folder, (name, "launch"))
    for folder, (name, kind) in missing.items():
        build = package.build
        at = (
            build.catkin_package or build.ament_package or At(build.files[0] if build.files else installs[0].at.path, 1)
        )
        share = "${CATKIN_PACKAGE_SHARE_DESTINATION}" if catkin else "share/${PROJECT_NAME}"
        if package.build_type == "ament_python":
            share, kind = f"share/{package.name}", f"{kind}, data_files" if kind != "elsewhere" else kind
        data = {"file": name, "share": share}
        yield Diagnostic(at, folder, package.name, data, kind, together=_FOLDERS)


def _list_below(package: Package, folder: str) -> list[str]:
    """The files of a folder of the package."""
    return [path for path in package.linked.files if path.startswith(f"{folder}/")] if folder in package.folders else []


def _lies_in(places: frozenset[str] | None, package: str, inside: str) -> bool:
    """Whether a file or folder is found where the package is installed, by its path below the share folder. roslaunch
    looks for a program by its name alone in lib/<package>. Source: _find_executable() of its substitution_args.py."""
    name = posixpath.basename(inside)
    return places is not None and not places.isdisjoint((f"share/{package}/{inside}", f"lib/{package}/{name}"))


# Launch files of ROS 2, which `ros2 launch` finds in the share folder alone.
_LAUNCH = re.compile(r"[._]launch\.(?:py|xml|ya?ml)\Z")


def _list_launch_folders(package: Package, installs) -> Iterator[tuple[str, str]]:
    """The folder of launch files where no rule installs any file of it, with a launch file in it that starts or opens
    something: in ROS 1, which finds them in the source space too, an installed program of the package, or anything
    where other folders of it are installed."""
    files = _list_below(package, posixpath.join(package.path, "launch"))
    built = package.build.catkin_package or package.build.ament_package
    if built is None and package.build_type != "ament_python":
        return  # what comes after a command that cannot be followed is not known
    if any(is_installed(installs, path) for path in files):
        return
    programs = package.build.installed_targets
    catkin = package.build_type == "catkin"
    siblings = catkin and any(i.kind == "directory" and i.destination.split("/")[0] == "share" for i in installs)
    for use in package.linked.references:
        path, r = use.at.path, use.reference
        own = siblings or ((r.kind, r.package) == ("executable", package.name) and r.name in programs)
        if use.role == "run" and path in files and (own if catkin else _LAUNCH.search(path)):
            yield "launch", package.strip_path(path)
            return


# Folders where programs of packages lie, and modules that programs import to be nodes.
_OF_PROGRAMS = frozenset(("bin", "nodes", "scripts"))
_OF_NODES = frozenset(("rclpy", "rospy", "rqt_gui"))


def _list_scripts(package: Package, installs, scripts: set[str]) -> Iterator[Diagnostic]:
    """Scripts that no rule installs: those that a launch file starts, that lie beside programs which are installed, or
    that are nodes: of ROS 2, which starts none from the source space, or of a package without other programs."""
    programs = [item for i in installs if i.kind == "programs" for item in i.items]
    nodes = _list_nodes(package, installs)
    folders, others = {posixpath.dirname(item) for item in programs}, {posixpath.basename(item) for item in programs}
    for path in (*package.linked.scripts, *package.linked.shells):
        name, folder = posixpath.basename(path), posixpath.dirname(path)
        beside = folder in folders and folder != package.path and "." not in name and find_folder_role(name) is None
        node = path in nodes
        if (name in scripts or beside or node) and name not in others and not is_installed(installs, path):
            kind = "script" if name in scripts else "beside" if beside else "node"
            if package.build_type == "catkin" and path not in package.linked.shells:
                kind = f"{kind}, catkin"
            yield Diagnostic(At(path, 1), name, package.name, kind=kind, together=_ONCE)


def _list_nodes(package: Package, installs) -> frozenset[str]:
    """The nodes in Python of a package that installs something: all of ROS 2, and of ROS 1, where a launch file in the
    source space starts them as well, those of a package that makes and installs no program at all.
    install_python_setup() puts what setup.py calls scripts into the folder of all programs, where rosrun does not look.
    """
    made = any(t.kind == "executable" for t in package.build.targets)
    has_programs = made or any(i.kind == "programs" or i.executable for i in installs)
    if not installs or (has_programs and package.build.ament_package is None):
        return frozenset()
    nodes = {use.at.path for use in package.linked.imports if use.module.partition(".")[0] in _OF_NODES}
    inside = {path: package.strip_path(path) for path in package.linked.scripts if path in nodes}
    return frozenset(p for p, i in inside.items() if i.split("/")[0] in _OF_PROGRAMS and find_folder_role(i) is None)
