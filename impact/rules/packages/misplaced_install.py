"""misplaced-install: an install rule puts headers, modules, components or scripts where they cannot be used.

What it does
    Reports a folder `include` that is installed into another `include`, headers that are installed under another folder
    name than code includes them by, nodes outside of `lib/` and the package's name, scripts that install(FILES) or
    install(DIRECTORY) copies without execute permission, registered components outside of `lib`, install folders of a
    Python version other than the target's, and programs whose first line names `python` where the target has `python3`
    alone (Ubuntu focal, Debian bullseye and later).

Why it breaks
    The package itself builds. But dependants do not find its headers, rosrun or ros2 run its scripts, Python its
    modules, or component containers its library, which they load from `lib`.

Severity
    error where another package of the workspace compiles such a header, and for scripts that are installed among
    programs, or nodes in Python (ROS 1); warning otherwise.

Example
    install(DIRECTORY include DESTINATION include)

Use instead
    install(DIRECTORY include/ DESTINATION include)

Not reported
    Launch files and other scripts that programs run as data, or that CMake code gives to the interpreter.
"""

import posixpath
import re
from collections.abc import Iterator

from ...model.cmake.build import Install
from ...model.cmake.installed import list_copied_files
from ...model.cmake.links import list_linked_items, resolve_package
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Together, rule
from .dependants import list_compiled_elsewhere
from .install_rules import is_installed, list_references, read_installs

_OTHER_INTERPRETER = "`{subject}` is to be run by `python`, which {platform} does not have, and is installed as it is"


@rule(
    group="missing-install",
    texts={
        "doubled": Text(
            "the folder `include` is installed into `include`, so headers end up in include/include",
            "write `include/` with a slash at its end",
        ),
        "not executable": Text(
            "`{subject}` is installed with install(FILES), so it cannot be executed", "install(PROGRAMS ...)"
        ),
        "folder": Text(
            "`{file}` is installed with install(DIRECTORY), which does not keep it executable",
            "add USE_SOURCE_PERMISSIONS, or use install(PROGRAMS ...)",
        ),
        "renamed": Text(
            "headers that are included as `{name}/...` are installed into `{destination}`",
            "install them into `{place}`",
        ),
        "component": Text(
            "the component library `{subject}` is installed into `{destination}`, but containers load it from `lib`",
            "install(TARGETS {subject} LIBRARY DESTINATION lib)",
        ),
        "program": Text(
            "`{subject}` is installed into `{destination}`, but {command} looks in `lib/{package}`",
            "install(TARGETS {subject} DESTINATION lib/${{PROJECT_NAME}})",
        ),
        "python": Text(
            "`{subject}` belongs to Python {version}, but the target has Python {own}",
            "use ament_python_install_package(), or the folder of the Python that CMake finds",
        ),
        "interpreter": Text(_OTHER_INTERPRETER, "start it with `#!/usr/bin/env python3`"),
        "interpreter, catkin": Text(_OTHER_INTERPRETER, "install it with catkin_install_python()"),
    },
)
def misplaced_install(view: TargetView, package: Package):
    installs = read_installs(view, package)
    for find in _FAULTS if installs else ():
        yield from find(view, package, installs)


def _list_headers(view: TargetView, package: Package, installs) -> Iterator[Diagnostic]:
    """Folders called include that are installed into one of that name, so that headers end up in include/include, and
    folders of headers whose name is lost: include/a/ installed into include/b while sources include <a/...>."""
    for install in installs:
        root, include, tail = install.destination.rstrip("/").rpartition("include")
        for item in install.items if install.kind == "directory" and include else ():
            # How others include what lies outside of the workspace is not known.
            folder = _FOLDER.search(item) if "$" not in item else None
            if tail == "" and root[-1:] in ("", "/") and item.rpartition("/")[2] == "include":
                kind, subject, lost, data = "doubled", "include", item, {}
            elif folder is not None and not root and tail.count("/") == 1 and tail != f"/{folder[1]}":
                kind, subject, lost = "renamed", install.destination, item.rstrip("/").removesuffix(folder[1])
                data = {"name": folder[1], "destination": subject, "place": f"include/{folder[1]}"}
                if tail == f"/{package.name}" and package.build_type == "catkin":
                    subject = "CATKIN_PACKAGE_INCLUDE_DESTINATION"
                    data["place"] = f"${{CATKIN_GLOBAL_INCLUDE_DESTINATION}}/{folder[1]}"
            else:
                continue
            doubts = (_is_lost(view, package, install, lost) or Doubt.DISTURBS,)
            yield Diagnostic(install.at, subject, package.name, data, kind, doubts)


_FOLDER = re.compile(r"(?:^|/)include/([\w-]+)/\Z")


def _is_lost(view: TargetView, package: Package, install, folder: str) -> bool:
    """True when another package of the workspace compiles a header of the folder, or the package exports the place
    where its headers should lie, and no other rule installs them there."""
    if not view.is_sure(install.conditions) or package.build.unresolved:
        return False
    exported = [e.item for e in package.build.exports if "include" in e.how and view.is_sure(e.conditions)]
    exported.extend(place for target in package.build.targets for place in target.installed_includes)
    if any("$" in item or item.rstrip("/").endswith("include/include") for item in exported):
        return False
    others = [i for i in package.build.installs if i is not install and i.kind in ("directory", "files")]
    start = posixpath.normpath(folder) + "/"
    headers = {h[len(start) :] for h in package.linked.headers if h.startswith(start)}
    if any(is_installed(others, start + h) for h in headers):
        return False
    if headers and any(item.rstrip("/") in ("include", install.destination.rstrip("/")) for item in exported):
        return True
    return any(path in headers for _, path in list_compiled_elsewhere(view, package))


def _list_not_executable(view: TargetView, package: Package, installs) -> Iterator[Diagnostic]:
    """Scripts that are installed as data, where programs belong, or that no other rule installs as programs."""
    programs = {posixpath.normpath(item) for i in installs if i.kind == "programs" for item in i.items}
    scripts = {*package.linked.scripts, *package.linked.shells}
    # Nodes of ROS 1, which rosrun and roslaunch start from the package's share folder too.
    nodes = {i.at.path for i in package.linked.imports if i.module == "rospy" and view.target.ros == 1}
    for install in installs:
        among_programs = _OF_PROGRAMS.search(install.destination)
        if install.kind == "directory" and not install.executable and among_programs:
            copied = [path for path, _ in list_copied_files(install, "", package.linked.files) if path in scripts]
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
            if name in package.linked.interpreted:
                continue
            sure = bool(among_programs) or path in nodes
            doubts = (sure or Doubt.LATE, view.is_sure(install.conditions) or Doubt.CONDITIONAL)
            if install.kind == "directory":
                data = {"file": inside}
                subject = posixpath.dirname(inside)
                yield Diagnostic(install.at, subject, package.name, data, "folder", (*doubts, Doubt.LATE))
                break
            yield Diagnostic(install.at, name, package.name, kind="not executable", doubts=doubts)


_ONE_LINE = (Together("interpreter"),)
# Folders for programs, as install rules name them.
_OF_PROGRAMS = re.compile(r"(^|/)(bin|lib)(/|$)|_BIN_DESTINATION")
# Scripts that other programs run, as data.
_RUN_BY = (".launch.py", "setup.py", "conftest.py")


def _list_components(view: TargetView, package: Package, installs) -> Iterator[Diagnostic]:
    """Libraries of registered components that no rule installs into lib, where the resource index says they are."""
    components = {e.context for e in package.build.exports if e.how == "component"}
    by_name = {t.name for t in package.build.targets if t.kind in ("library", "module") and not t.static}
    for name in sorted(components & by_name):
        place = _find_wrong_place(installs, name, "lib")
        if place is not None:
            data = {"destination": place.destination}
            yield Diagnostic(place.at, name, package.name, data, "component", (Doubt.LATE,))


def _find_wrong_place(installs, target: str, folder: str) -> Install | None:
    """The first rule that installs a target, where surely none does into its folder."""
    rules = [install for install in installs if install.kind == "targets" and target in install.items]
    folders = {install.destination.rstrip("/") for install in rules}
    known = folder not in folders and not any("$" in place or not place for place in folders)
    return rules[0] if rules and known else None


def _list_programs(view: TargetView, package: Package, installs) -> Iterator[Diagnostic]:
    """Nodes of ROS 2, and programs that a launch file starts, that no rule installs where those who start them look."""
    started = list_references(view, package, "executable")
    for target in package.build.targets:
        place = _find_wrong_place(installs, target.name, f"lib/{package.name}")
        if target.kind != "executable" or place is None:
            continue
        node = view.target.ros == 2 and "rclcpp" in {
            resolve_package(item) for item in list_linked_items(package, target.name) or ()
        }
        if not node and (target.output_name or target.name) not in started:
            continue
        command = "ros2 run" if view.target.ros == 2 else "rosrun"
        data = {"destination": place.destination, "command": command}
        yield Diagnostic(place.at, target.name, package.name, data, "program", (Doubt.LATE,))


def _list_other_python(view: TargetView, package: Package, installs) -> Iterator[Diagnostic]:
    """Install folders of a Python version that the target does not have."""
    own = f"{view.target.python_major}.{view.target.python}"
    for install in installs:
        found = re.search(r"(?:^|/)python([23]\.\d+)/(?:site|dist)-packages", install.destination)
        if found is not None and found.group(1) != own and view.is_sure(install.conditions):
            data = {"version": found.group(1), "own": own}
            yield Diagnostic(install.at, install.destination, package.name, data, "python", (Doubt.LATE,))


# The minor version of Python 3 since which the systems of targets have no command `python`.
_WITHOUT_PLAIN = 8


def _list_plain(view: TargetView, package: Package, installs) -> Iterator[Diagnostic]:
    """Programs that ask for `python`, where there is none and nothing writes another interpreter into their copies."""
    target = view.target
    if target.python_major < 3 or target.python < _WITHOUT_PLAIN:
        return
    kind = "interpreter, catkin" if package.build_type == "catkin" else "interpreter"
    for install in installs:
        programs = install.kind == "programs" or (install.kind == "directory" and install.executable)
        if not programs or install.rewritten or not _OF_PROGRAMS.search(install.destination):
            continue
        for path, _ in list_copied_files(install, "", package.linked.files):
            name = posixpath.basename(path)
            if path in package.linked.plain_scripts and name not in package.linked.interpreted:
                data = {"platform": target.platform}
                doubts = (Doubt.LATE, view.is_sure(install.conditions) or Doubt.CONDITIONAL)
                yield Diagnostic(install.at, name, package.name, data, kind, doubts, together=_ONE_LINE)


_FAULTS = (_list_headers, _list_not_executable, _list_components, _list_programs, _list_other_python, _list_plain)
