"""unexecutable-script: a script is installed so that it cannot be executed.

What it does
    Reports scripts that install(FILES) or install(DIRECTORY) copies without execute permission, and programs whose
    first line names `python` where the target has `python3` alone (Ubuntu focal, Debian bullseye and later), or a
    Python in somebody's home folder: installed ones, and in ROS 1 those that a launch file starts where they lie.

Why it breaks
    The package itself builds. But rosrun, ros2 run or a launch file cannot start the script.

Severity
    error for scripts that are installed among programs, and for nodes in Python (ROS 1); warning otherwise.

Example
    install(FILES scripts/measure DESTINATION lib/${PROJECT_NAME})

Use instead
    install(PROGRAMS scripts/measure DESTINATION lib/${PROJECT_NAME})

Not reported
    Launch files and other scripts that programs run as data, or that CMake code gives to the interpreter; modules that
    programs of the same folder import, unless they are nodes or something starts them.
"""

import posixpath
import re
from collections.abc import Iterator

from ...model.cmake.installed import list_copied_files
from ..vocabulary import At, Diagnostic, Doubt, Package, TargetView, Text, Together, rule
from .install_rules import is_installed, list_references, read_installs

_OTHER_INTERPRETER = "`{subject}` is to be run by `python`, which {platform} does not have, and is {installed}"
_ONE_LINE = (Together("interpreter"),)
# Who runs such where they lie may have the command by other means, and has it for all of them.
_BY_OTHER_MEANS = (Together("command python", everywhere=True),)
# Folders for programs, as install rules name them.
_OF_PROGRAMS = re.compile(r"(^|/)(bin|lib)(/|$)|_BIN_DESTINATION")
# Folders for modules: `lib/python3/dist-packages/winch`, ${PYTHON_INSTALL_DIR}.
_OF_MODULES = re.compile(r"-packages(/|$)|_?PYTHON_(INSTALL_DIR|DESTINATION)|(^|/)lib/python[\d.]*/")
# Scripts that other programs run, as data.
_RUN_BY = (".launch.py", "setup.py", "conftest.py")
# The minor version of Python 3 since which the systems of targets have no command `python`.
_WITHOUT_PLAIN = 8


@rule(
    group="misplaced-install",
    texts={
        "not executable": Text(
            "`{subject}` is installed with install(FILES), so it cannot be executed", "install(PROGRAMS ...)"
        ),
        "folder": Text(
            "`{file}` is installed with install(DIRECTORY), which does not keep it executable",
            "add USE_SOURCE_PERMISSIONS, or use install(PROGRAMS ...)",
        ),
        "interpreter": Text(_OTHER_INTERPRETER, "start it with `#!/usr/bin/env python3`"),
        "home": Text(
            "`{subject}` is to be run by `{interpreter}`, which other machines do not have, and is {installed}",
            "start it with `#!/usr/bin/env python{major}`",
        ),
        "interpreter, catkin": Text(_OTHER_INTERPRETER, "install it with catkin_install_python()"),
    },
)
def unexecutable_script(view: TargetView, package: Package):
    installs = read_installs(view, package)
    if installs is not None:
        yield from _list_not_executable(view, package, installs)
        yield from _list_plain(view, package, installs)


def _list_not_executable(view: TargetView, package: Package, installs) -> Iterator[Diagnostic]:
    """Scripts that are installed as data, where programs belong, or that no other rule installs as programs."""
    programs = {posixpath.normpath(item) for i in installs if i.kind == "programs" for item in i.items}
    scripts = {*package.linked.scripts, *package.linked.shells}
    # Nodes of ROS 1, which rosrun and roslaunch start from the package's share folder too.
    nodes = {i.at.path for i in package.linked.imports if i.module == "rospy" and view.target.ros == 1}
    modules = set(package.linked.imported_beside) - nodes
    started_by_name = list_references(view, package, "executable") if modules else {}
    for install in installs:
        if _OF_MODULES.search(install.destination):
            continue
        among_programs = _OF_PROGRAMS.search(install.destination)
        if install.kind == "directory" and not install.executable:
            # Elsewhere than among programs lies much that nobody starts.
            those = scripts if among_programs else nodes.intersection(package.linked.scripts)
            copied = [path for path, _ in list_copied_files(install, "", package.linked.files) if path in those]
        elif install.kind == "files":
            copied = [path for item in install.items if (path := posixpath.normpath(item)) in package.linked.scripts]
        else:
            continue
        for path in copied:
            inside = package.strip_path(path)
            started = among_programs or inside.split("/")[0] in ("scripts", "nodes", "bin")
            if not started or path in programs or inside.endswith(_RUN_BY):
                continue
            name = posixpath.basename(path)
            if name in package.linked.interpreted or (path in modules and name not in started_by_name):
                continue
            sure = bool(among_programs) or path in nodes
            doubts = (sure or Doubt.LATE, view.is_sure(install.conditions) or Doubt.CONDITIONAL)
            if install.kind == "directory":
                doubts, data = (*doubts, Doubt.LATE), {"file": inside}
                yield Diagnostic(install.at, posixpath.dirname(inside), package.name, data, "folder", doubts)
                break
            yield Diagnostic(install.at, name, package.name, kind="not executable", doubts=doubts)


def _list_plain(view: TargetView, package: Package, installs) -> Iterator[Diagnostic]:
    """Programs that ask for `python`, where there is none, or for a Python in a home folder, and nothing writes another
    interpreter into their copies, or into those that a launch file starts where they lie, as of ROS 1."""
    target, catkin, at_home = view.target, package.build_type == "catkin", dict(package.linked.at_home)
    absent = () if target.python_major < 3 or target.python < _WITHOUT_PLAIN else package.linked.plain_scripts
    plain = [p for p in (*absent, *at_home) if posixpath.basename(p) not in package.linked.interpreted]
    found = {}
    for install in installs:
        programs = install.kind == "programs" or (install.kind == "directory" and install.executable)
        if programs and not install.rewritten and _OF_PROGRAMS.search(install.destination):
            copied = (path for path, _ in list_copied_files(install, "", package.linked.files) if path in plain)
            found.update((path, (install.at, "installed as it is", install.conditions, _ONE_LINE)) for path in copied)
    started = list_references(view, package, "executable") if catkin else ()
    for path in plain:
        if posixpath.basename(path) in started and not is_installed(installs, path):
            found[path] = At(path, 1), "not installed", (), _BY_OTHER_MEANS
    for path, (at, how, conditions, together) in found.items():
        data = {"platform": target.platform, "installed": how, "major": str(target.python_major)}
        data["interpreter"] = at_home.get(path, "")
        doubts = (Doubt.LATE, view.is_sure(conditions) or Doubt.CONDITIONAL)
        kind = "home" if path in at_home else "interpreter, catkin" if catkin else "interpreter"
        yield Diagnostic(at, posixpath.basename(path), package.name, data, kind, doubts, together=together)
