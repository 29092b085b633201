"""missing-install: a file or target that is used or exported is not installed.

What it does
    Compares the install rules of CMake with what the package offers: executables and libraries, plugin libraries and
    their descriptions, launch files and scripts that something of the workspace starts or opens.

Why it breaks
    Everything works from the build tree (catkin's devel space, symlinked installs), and the installed robot lacks it.

Severity
    error where the installed package is sure to fail: a library that catkin_package() exports beside installed ones, a
    program that an installed launch file starts in any case, the description of plugins whose library is installed, all
    of a package that only holds data which launch files open. warning otherwise: in a workspace that is never installed
    all of this works.

Example
    add_executable(udp_socket_node src/udp_socket_node.cpp)     # and install(TARGETS tcp_socket_node ...)

Use instead
    install(TARGETS tcp_socket_node udp_socket_node ...)

Not reported
    Tests, examples and benchmarks; static libraries; files that the build makes; packages without CMake.
"""

import posixpath
import re
from collections.abc import Iterator

from ...model.cmake.build import At
from ...model.package import role_of_folder
from ...model.view import View
from ..rule import Diagnostic, rule
from ..severity import Doubt
from ..text import Text
from .install_rules import is_installed, list_installing

_TARGETS = "add it to install(TARGETS ...)"


@rule(
    scope="target",
    severity="error",
    texts={
        "started": Text("`{subject}` is not installed, although a launch file starts it", _TARGETS),
        "exported": Text("`{subject}` is not installed, although it is exported", _TARGETS),
        "plugin": Text("`{subject}` is not installed, although a plugin description names it", _TARGETS),
        "linked": Text("`{subject}` is not installed, although an installed target links it", _TARGETS),
        "program": Text("`{subject}` is not installed, although other executables are", _TARGETS),
        "no description": Text("the exported plugin description `{subject}` does not exist", "correct the path"),
        "description": Text(
            "the exported plugin description `{subject}` is not installed",
            "install(FILES {file} DESTINATION ${{CATKIN_PACKAGE_SHARE_DESTINATION}})",
        ),
        "nothing": Text(
            "`{package}` installs nothing, but it has {folders}",
            "install(DIRECTORY {listed} DESTINATION ${{CATKIN_PACKAGE_SHARE_DESTINATION}})",
        ),
        "opened": Text(
            "`{file}` is opened through the package's share folder but is not installed",
            "install(DIRECTORY {subject} DESTINATION {share})",
        ),
        "script": Text("`{subject}` is started by a launch file but is not installed", "{how}"),
    },
)
def missing_install(view: View):
    referred = _list_referred(view)
    for package, installs in list_installing(view):
        used = referred.get(package.name, {})
        if not installs and package.build_type == "catkin" and not package.build.targets:
            yield from _list_nothing(package, opened=bool(used))
            continue
        yield from _list_targets(view, package, installs, used)
        yield from _list_descriptions(view, package, installs)
        yield from _list_opened(package, installs, used)


def _list_referred(view: View) -> dict[str, dict[str, set[str]]]:
    """Package to what the workspace's launch files and scripts start or open in it: kind to names."""
    found: dict[str, dict[str, set[str]]] = {}
    for package in view.workspace:
        for use in package.digest.references:
            r = use.reference
            if r.package and r.name and use.role == "run":
                found.setdefault(r.package, {}).setdefault(r.kind, set()).add(r.name)
    return found


_DATA = ("launch", "urdf", "meshes", "robots", "worlds")


def _list_nothing(package, opened: bool) -> Iterator[Diagnostic]:
    """A package that only holds data, and installs none of it. opened: a launch file or a script opens files of it."""
    folders = tuple(folder for folder in _DATA if package.has_files(folder))
    if folders and package.build.catkin_package is not None and not package.manifest.metapackage:
        data = {"folders": folders, "listed": " ".join(folders)}
        doubts = (opened or Doubt.DISTURBS,)
        yield Diagnostic(package.build.catkin_package, "install", package.name, data, "nothing", doubts)


def _list_targets(view: View, package, installs, used) -> Iterator[Diagnostic]:
    installed = {item for i in installs if i.kind == "targets" for item in i.items}
    if any("$" in item for item in installed) or (any(i.kind == "export" for i in installs) and not installed):
        return
    exported = {e.item for e in package.build.exports if e.how == "libraries"}
    started = used.get("executable", set())
    plugins = {posixpath.basename(c.library).removeprefix("lib").removesuffix(".so") for _, c in package.digest.plugins}
    linked = {link.item for t in package.build.targets if t.name in installed for link in t.links if link.how == "link"}
    for target in package.build.targets:
        if (
            target.name in installed
            or target.kind not in ("executable", "library", "module")
            or not view.certain(target.conditions)
        ):
            continue
        if _is_aside(package, target):
            continue
        name = target.output_name or target.name
        why = None
        if target.kind == "executable" and name in started:
            why = "started"
        elif target.kind != "executable" and (target.name in exported or name in exported):
            why = "exported"
        elif target.kind != "executable" and (target.name in plugins or name in plugins):
            why = "plugin"
        elif target.kind == "library" and target.name in linked and not target.static:
            why = "linked"
        elif target.kind == "executable" and any(
            t.name in installed for t in package.build.targets if t.kind == "executable"
        ):
            why = "program"
        if why:
            # Who finds a package that exports a library stops where the library is neither a target nor installed.
            stops = installed and (why == "exported" or (why == "started" and _is_started(view, package, name)))
            doubts = () if stops and not package.build.unresolved else (Doubt.DISTURBS,)
            yield Diagnostic(target.at, name, package.name, kind=why, doubts=doubts)


def _is_started(view: View, package, name: str) -> bool:
    """True when an installed launch file starts a program of the package in any case."""
    for other in view.everyone():
        installs = [i for i in other.build.installs if view.certain(i.conditions)]
        for use in other.digest.references:
            r = use.reference
            if (r.package, r.name, r.kind, use.role) != (package.name, name, "executable", "run") or r.conditional:
                continue
            if ".launch" in use.at.path and is_installed(other, installs, use.at.path):
                return True
    return False


def _is_aside(package, target) -> bool:
    inside = lambda p: p[len(package.path) :].lstrip("/")  # noqa: E731
    if role_of_folder(inside(target.at.path)) or re.search(
        r"(^|_)(test|tests|example|demo|benchmark)(_|$)", target.name
    ):
        return True
    return bool(target.sources) and all(role_of_folder(inside(s)) for s in target.sources)


def _list_descriptions(view: View, package, installs) -> Iterator[Diagnostic]:
    """Plugin descriptions that the manifest exports (catkin)."""
    for export in package.manifest.exports:
        value = export.attributes.get("plugin", "")
        if not value.startswith("${prefix}"):
            continue
        path = posixpath.normpath(posixpath.join(package.path, value[len("${prefix}/") :]))
        if path not in package.files:
            if path + ".in" in package.files or is_installed(package, installs, path):
                continue
            at, subject = At(package.digest.manifest_path, export.line), value[len("${prefix}/") :]
            yield Diagnostic(at, subject, package.name, kind="no description", doubts=(Doubt.DISTURBS,))
        elif package.build_type == "catkin" and not is_installed(package, installs, path):
            at, doubts = At(package.digest.manifest_path, export.line), ()
            if not _is_shipped(view, package, installs, path):
                doubts = (Doubt.DISTURBS,)
            data = {"file": value[len("${prefix}/") :]}
            yield Diagnostic(at, posixpath.basename(path), package.name, data, "description", doubts)


def _is_shipped(view: View, package, installs, description: str) -> bool:
    """True when a library that the description names is installed, so that the plugins are there for others."""
    if package.build.unresolved:
        return False
    libraries = (posixpath.basename(c.library) for path, c in package.digest.plugins if path == description)
    names = {name.removeprefix("lib").removesuffix(".so") for name in libraries}
    return any(
        item in names and view.certain(i.conditions) for i in installs if i.kind == "targets" for item in i.items
    )


def _list_opened(package, installs, used) -> Iterator[Diagnostic]:
    """Launch files and data that something of the workspace opens and no rule installs."""
    opened = used.get("file", set())
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
        yield Diagnostic(at, folder, package.name, data, "opened", (Doubt.DISTURBS,))
    scripts = used.get("executable", set())
    for path in package.digest.scripts:
        name = posixpath.basename(path)
        if name in scripts and not is_installed(package, installs, path):
            how = "install(PROGRAMS ... DESTINATION lib/${PROJECT_NAME})"
            how = "catkin_install_python(PROGRAMS ...)" if catkin else how
            yield Diagnostic(At(path, 1), name, package.name, {"how": how}, "script", (Doubt.DISTURBS,))
