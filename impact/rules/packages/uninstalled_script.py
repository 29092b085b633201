"""uninstalled-script: a script that is started where the package is installed is not installed.

What it does
    Reports scripts that no install rule of CMake takes: those that launch files or scripts of the workspace start, that
    lie beside installed programs, and nodes in Python: of ROS 2, and of packages of ROS 1 that install no program.

Why it breaks
    Everything works from the source tree (catkin's devel space, symlinked installs), and the installed robot lacks it.

Severity
    warning for what launch files or scripts start, and for nodes and commands (programs without an ending) that are not
    called like tools of developers; note for other scripts beside installed programs, and in ROS 1 where the distro has
    ended, since nothing is released into it any more.

Example
    install(PROGRAMS scripts/drive DESTINATION lib/${PROJECT_NAME})     # and a launch file starts scripts/steer

Use instead
    install(PROGRAMS scripts/drive scripts/steer DESTINATION lib/${PROJECT_NAME})

Not reported
    Modules that other scripts import, and tools of packages that install no program; programs that import rospy in ROS
    2, which nobody has ported.
"""

import posixpath
import re
from collections import Counter
from collections.abc import Collection, Mapping
from itertools import chain

from ....edges.groups import group_pairs
from ...model.package import find_folder_role
from ..vocabulary import At, Diagnostic, Doubt, Package, TargetView, Text, Together, rule
from .install_rules import is_installed, list_install_doubts, list_references, read_installs

_ONCE = (Together("not installed"),)
_OF_CATKIN = "catkin_install_python(PROGRAMS ...)"
# Folders where programs of packages lie, and modules that programs import to be nodes.
_OF_PROGRAMS = frozenset(("bin", "nodes", "scripts"))
_OF_NODES = {1: frozenset(("rospy", "rqt_gui")), 2: frozenset(("rclpy", "rqt_gui"))}
# What a program imports that a generation of ROS does not have, as before it was ported.
_OF_OTHERS = {1: "rclpy", 2: "rospy"}
# How tools are called that their developers run from the sources.
_FOR_DEVELOPERS = re.compile(r"(?i)(?:\A|[/_-])(?:bench(?:mark)?s?|calibrat\w*|debug|experiments?)(?=[/_.-]|\Z)")


@rule(
    severity="warning",
    group="uninstalled-file",
    texts={
        "script": Text("`{subject}` is started by a launch file or script but is not installed", "{command}"),
        "node": Text("`{subject}` is a node, but no rule installs it", "{command}"),
        "beside": Text("`{subject}` is not installed, but other programs in its folder are", "{command}"),
    },
)
def uninstalled_script(view: TargetView, package: Package):
    installs = read_installs(view, package)
    if not installs and (installs is None or (package.build_type == "catkin" and not package.build.targets)):
        return  # uninstalled-file tells of a package that installs nothing at all
    scripts = list_references(view, package, "executable")
    programs = [item for i in installs if i.kind == "programs" for item in i.items]
    imported = group_pairs((use.at.path, use.module.partition(".")[0]) for use in package.linked.imports)
    folders, others = {posixpath.dirname(item) for item in programs}, {posixpath.basename(item) for item in programs}
    runs = {path for path, modules in imported.items() if not _OF_NODES[view.target.ros].isdisjoint(modules)}
    nodes = _list_nodes(package, installs, view.target.ros, imported, folders)
    kinds = Counter((posixpath.dirname(item), posixpath.splitext(item)[1]) for item in programs)
    found: dict[str, list[Diagnostic]] = {"script": [], "node": [], "beside": []}
    for path in (*package.linked.scripts, *package.linked.shells, *_list_shells(package, kinds)):
        name, folder = posixpath.basename(path), posixpath.dirname(path)
        alike = "." not in name or kinds[folder, posixpath.splitext(name)[1]] > 1
        beside = folder in folders and folder != package.path and alike and find_folder_role(name) is None
        node = path in nodes
        if _OF_OTHERS[view.target.ros] in imported.get(path, ()):
            continue
        if (name in scripts or beside or node) and name not in others and not is_installed(installs, path):
            kind = "script" if name in scripts else "beside" if beside else "node"
            of_catkin = package.build_type == "catkin" and path not in package.linked.shells
            data = {"command": _OF_CATKIN if of_catkin else "install(PROGRAMS ... DESTINATION lib/${PROJECT_NAME})"}
            inside = package.strip_path(path)
            sure = (node or "." not in name or path in runs) and not _FOR_DEVELOPERS.search(inside)
            doubts = (kind == "script" or sure or Doubt.UNCHECKED, *list_install_doubts(view, package))
            found[kind].append(Diagnostic(At(path, 1), name, package.name, data, kind, doubts, together=_ONCE))
    yield from chain.from_iterable(found.values())  # the first of them is the warning


def _list_shells(package: Package, kinds: Counter[tuple[str, str]]) -> list[str]:
    """The shell scripts with an ending beside installed ones. kinds: how often programs of a folder have an ending."""
    folders = {folder for folder, ending in kinds if ending == ".sh"}
    return [path for path in package.linked.files if path.endswith(".sh") and posixpath.dirname(path) in folders]


def _list_nodes(
    package: Package, installs, ros: int, imported: Mapping[str, Collection[str]], folders: set[str]
) -> frozenset[str]:
    """The nodes in Python of a package of ROS 2; in ROS 1, where a launch file in the source space starts them as well,
    of one that installs something, and makes and installs no program at all.
    install_python_setup() puts what setup.py calls scripts into the folder of all programs, where rosrun does not look.
    folders: those of installed programs.
    """
    made = any(t.kind == "executable" for t in package.build.targets)
    has_programs = made or any(i.kind == "programs" or i.executable for i in installs)
    if package.build.ament_package is None and (not installs or has_programs):
        return frozenset()
    nodes = (path for path in package.linked.scripts if not _OF_NODES[ros].isdisjoint(imported.get(path, ())))
    inside = {path: package.strip_path(path) for path in nodes}
    return frozenset(
        path
        for path, below in inside.items()
        if (below.split("/")[0] in _OF_PROGRAMS or posixpath.dirname(path) in folders - {package.path})
        and find_folder_role(below) is None
    )
