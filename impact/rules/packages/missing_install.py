"""missing-install: a file or target that is used or exported is not installed.

What it does
    Compares the install rules of CMake with what the package offers: executables and libraries, plugin libraries and
    their descriptions, launch files and scripts that something of the workspace starts or opens; and finds install
    rules whose file or folder does not exist, that name a place by a variable that catkin does not set, that install
    scripts as plain files, or headers under another name than they are included by.

Why it breaks
    Everything works from the build tree (catkin's devel space, symlinked installs), and the installed robot lacks it.

Severity
    error for an install rule of something that does not exist, or with a variable that nothing sets; and where the
    installed package is sure to fail: a library that catkin_package() exports beside installed ones, a program that an
    installed launch file starts in any case, a script among programs, or a node in Python, that cannot be executed, the
    description of plugins whose library is installed, all of a package that only holds data which launch files open,
    headers in a folder where another package of the workspace, which compiles them, does not look. warning otherwise:
    in a workspace that is never installed all of this works.

Example
    add_executable(udp_socket_node src/udp_socket_node.cpp)     # and install(TARGETS tcp_socket_node ...)

Use instead
    install(TARGETS tcp_socket_node udp_socket_node ...)

Not reported
    Tests, examples and benchmarks; static libraries; files that the build makes; packages without CMake.
"""

import posixpath
import re

from ...model.cmake.build import At
from ...model.cmake.installed import lets_in
from ...model.view import View
from ..rule import Hit, rule


@rule(severity="warning")
def missing_install(view: View):
    referred = _referred(view)
    for package in view:
        if not package.build.files:
            continue
        if package.build_type not in ("catkin", "ament_cmake", "ament_cmake_auto"):
            continue
        if any(f.how == "ament_auto" for f in package.build.found) and package.build.ament_package is None:
            continue
        installs = [i for i in package.build.installs if view.active(i.conditions)]
        yield from _absent(view, package, installs)
        yield from _doubled(view, package, installs)
        yield from _not_executable(view, package, installs)
        yield from _under_another_name(view, package, installs)
        yield from _variables(view, package)
        if not installs and package.build_type == "catkin" and not package.build.targets:
            yield from _nothing(package, opened=package.name in referred)
            continue
        yield from _targets(view, package, installs, referred)
        yield from _descriptions(view, package, installs)
        yield from _folders(view, package, installs, referred)


def _referred(view: View) -> dict[str, dict[str, set[str]]]:
    """Package to what the workspace's launch files and scripts start or open in it: kind to names."""
    found: dict[str, dict[str, set[str]]] = {}
    for package in view.workspace:
        for use in package.digest.references:
            r = use.reference
            if r.package and r.name and use.role == "run":
                found.setdefault(r.package, {}).setdefault(r.kind, set()).add(r.name)
    return found


def _is_made(made: frozenset[str], path: str, kind: str) -> bool:
    """True for a path that configuring or building writes, or that holds such ones; made: as Build.made."""
    if path in made or any(item.endswith("/") and f"{path}/".startswith(item) for item in made):
        return True
    return kind == "directory" and any(item.startswith(f"{path}/") for item in made)


def _absent(view: View, package, installs):
    made = frozenset(package.build.made)
    for install in installs:
        if install.kind not in ("files", "programs", "directory") or not view.certain(install.conditions):
            continue
        for item in install.items:
            path = posixpath.normpath(item)
            if (
                "$" in item
                or item.startswith("/")
                or path in package.files
                or path in package.folders
                or path in (".", package.path)
            ):
                continue
            if package.path and not path.startswith(package.path + "/"):
                continue
            if any(path.startswith(p) for p in ("build", "devel")) or re.search(r"[*?<>]", item):
                continue
            if re.search(r"\.so(\.|$)|\.a$|\.dylib$", path) or (
                install.kind == "directory" and re.search(r"(^|/)(include|lib|bin)(/|$)", item)
            ):
                continue  # made by the build, or a folder that git cannot keep while it is empty
            if path + ".in" in package.files or (install.kind == "files" and "." in path and _made(package, path)):
                continue
            if _is_made(made, path, install.kind):
                continue
            inside = path[len(package.path) :].lstrip("/")
            yield Hit(
                install.at,
                inside,
                f"`{inside}` is installed and does not exist",
                "create it, or drop it from the rule",
                package.name,
                severity="error",
            )


def _doubled(view: View, package, installs):
    """Folders called include that are installed into one of that name, so that headers end up in include/include."""
    for install in installs:
        if install.kind != "directory" or install.destination.rstrip("/").rpartition("/")[2] != "include":
            continue
        for item in install.items:
            if item.rpartition("/")[2] == "include" and not item.endswith("/"):
                yield Hit(
                    install.at,
                    "include",
                    "the folder `include` is installed into `include`, so headers end up in include/include",
                    "write `include/` with a slash at its end",
                    package.name,
                    severity="error" if _lost(view, package, install, item) else "warning",
                )


def _lost(view: View, package, install, folder: str) -> bool:
    """True when another package of the workspace compiles a header of the folder, or the package exports the place
    where its headers should lie, and no other rule installs them there."""
    if not view.certain(install.conditions) or package.build.unresolved:
        return False
    told = [e.item for e in package.build.exports if "include" in e.how and view.certain(e.conditions)]
    told.extend(place for target in package.build.targets for place in target.installed_includes)
    if any("$" in item or item.rstrip("/").endswith("include/include") for item in told):
        return False
    others = [i for i in package.build.installs if i is not install and i.kind in ("directory", "files")]
    start = posixpath.normpath(folder) + "/"
    headers = {h[len(start) :] for h in package.digest.headers if h.startswith(start)}
    if any(_covered(package, others, start + h) for h in headers):
        return False
    if headers and any(item.rstrip("/") in ("include", install.destination.rstrip("/")) for item in told):
        return True
    return any(
        include.path in headers and include.role == "build" and include.targets and view.certain(include.conditions)
        for other in view.everyone()
        if other.name != package.name
        for include in other.digest.includes
    )


def _not_executable(view: View, package, installs):
    """Scripts that are installed as data, where programs belong, or that no other rule installs as programs."""
    programs = {posixpath.normpath(item) for i in installs if i.kind == "programs" for item in i.items}
    for install in installs:
        if install.kind != "files":
            continue
        among_programs = re.search(r"(^|/)(bin|lib)(/|$)|_BIN_DESTINATION", install.destination)
        for item in install.items:
            path = posixpath.normpath(item)
            inside = path[len(package.path) :].lstrip("/")
            started = among_programs or inside.split("/")[0] in ("scripts", "nodes", "bin")
            if path in package.digest.scripts and started and path not in programs and not inside.endswith(_RUN_BY):
                name = posixpath.basename(path)
                lost = among_programs or _is_node(view, package, path)
                yield Hit(
                    install.at,
                    name,
                    f"`{name}` is installed with install(FILES), so it cannot be executed",
                    "install(PROGRAMS ...)",
                    package.name,
                    severity="error" if lost and view.certain(install.conditions) else "warning",
                )


def _is_node(view: View, package, script: str) -> bool:
    """True for a node of ROS 1, which rosrun and roslaunch start from the package's share folder too."""
    return view.target.ros == 1 and any(i.at.path == script and i.module == "rospy" for i in package.digest.imports)


# Scripts that other programs run, as data.
_RUN_BY = (".launch.py", "setup.py", "conftest.py")


def _under_another_name(view: View, package, installs):
    """Folders of headers whose name is lost: include/a/ installed into include/b while sources include <a/...>."""
    for install in installs:
        if install.kind != "directory":
            continue
        root, _, tail = install.destination.rstrip("/").rpartition("include")
        for item in install.items:
            folder = re.search(r"(?:^|/)include/([\w-]+)/\Z", item)
            if "$" in item:
                continue  # how others include what lies outside of the workspace is not known
            if folder is None or root or tail in ("", "/" + folder.group(1)) or tail.count("/") != 1:
                continue
            name = folder.group(1)
            lost = _lost(view, package, install, item.rstrip("/").removesuffix(name))
            catkin = tail == "/" + package.name and package.build_type == "catkin"
            yield Hit(
                install.at,
                "CATKIN_PACKAGE_INCLUDE_DESTINATION" if catkin else install.destination,
                f"headers that are included as `{name}/...` are installed into `{install.destination}`",
                "install them into "
                + (f"${{CATKIN_GLOBAL_INCLUDE_DESTINATION}}/{name}" if catkin else f"`include/{name}`"),
                package.name,
                severity="error" if lost else "warning",
            )


# What catkin itself sets that may name a place (catkin's all.cmake and catkin_package.cmake).
_PLACES = frozenset({"CATKIN_DEVEL_PREFIX", "CATKIN_TEST_RESULTS_DIR", "CATKIN_ENV"})


def _variables(view: View, package):
    """Catkin's variables for places, misspelt or of a time before Groovy."""
    told = set()
    for use in package.build.uses:
        if use.kind != "variable" or use.context != "install" or not use.name.startswith("CATKIN_"):
            continue
        if not use.name.endswith(("_PREFIX", "_DESTINATION", "_DIR")) or use.name in _PLACES:
            continue
        if use.name in told or package.build_type != "catkin" or package.name == "catkin":
            continue
        if not view.certain(use.conditions):
            continue
        told.add(use.name)
        yield Hit(
            use.at,
            use.name,
            f"nothing sets `{use.name}`, so what is installed is looked for, or put, in a wrong place",
            "write `${CATKIN_DEVEL_PREFIX}`" if use.name == "CATKIN_BUILD_PREFIX" else "correct the variable's name",
            package.name,
            severity="error",
        )


_DATA = ("launch", "urdf", "meshes", "robots", "worlds")


def _nothing(package, opened: bool):
    """A package that only holds data, and installs none of it. opened: a launch file or a script opens files of it."""
    folders = [folder for folder in _DATA if package.has_files(folder)]
    if folders and package.build.catkin_package is not None and not package.manifest.metapackage:
        yield Hit(
            package.build.catkin_package,
            "install",
            f"nothing of `{package.name}` is installed, and it has {', '.join(folders)}",
            f"install(DIRECTORY {' '.join(folders)} DESTINATION ${{CATKIN_PACKAGE_SHARE_DESTINATION}})",
            package.name,
            severity="error" if opened else "warning",
        )


def _made(package, path: str) -> bool:
    """True for files that the build itself writes: another command mentions their name."""
    return not any(path.endswith(e) for e in (".launch", ".xml", ".yaml", ".py", ".h", ".hpp", ".md", ".rviz"))


def _targets(view: View, package, installs, referred):
    installed = {item for i in installs if i.kind == "targets" for item in i.items}
    if any("$" in item for item in installed) or (any(i.kind == "export" for i in installs) and not installed):
        return
    exported = {e.item for e in package.build.exports if e.how == "libraries"}
    started = referred.get(package.name, {}).get("executable", set())
    plugins = {posixpath.basename(c.library).removeprefix("lib").removesuffix(".so") for _, c in package.digest.plugins}
    linked = {link.item for t in package.build.targets if t.name in installed for link in t.links if link.how == "link"}
    for target in package.build.targets:
        if (
            target.name in installed
            or target.kind not in ("executable", "library", "module")
            or not view.certain(target.conditions)
        ):
            continue
        if _aside(package, target):
            continue
        name = target.output_name or target.name
        why = None
        if target.kind == "executable" and name in started:
            why = "a launch file starts it"
        elif target.kind != "executable" and (target.name in exported or name in exported):
            why = "it is exported"
        elif target.kind != "executable" and (target.name in plugins or name in plugins):
            why = "a plugin description names it"
        elif target.kind == "library" and target.name in linked and not target.static:
            why = "an installed target links it"
        elif target.kind == "executable" and any(
            t.name in installed for t in package.build.targets if t.kind == "executable"
        ):
            why = "other executables are"
        if why:
            # Who finds a package that exports a library stops where the library is neither a target nor installed.
            stops = installed and (why == "it is exported" or (
                target.kind == "executable" and _is_started(view, package, name)
            ))  # fmt: skip
            yield Hit(
                target.at,
                name,
                f"`{name}` is not installed, although {why}",
                "add it to install(TARGETS ...)",
                package.name,
                severity="error" if stops and not package.build.unresolved else "warning",
            )


def _is_started(view: View, package, name: str) -> bool:
    """True when an installed launch file starts a program of the package in any case."""
    for other in view.everyone():
        installs = [i for i in other.build.installs if view.certain(i.conditions)]
        for use in other.digest.references:
            r = use.reference
            if (r.package, r.name, r.kind, use.role) != (package.name, name, "executable", "run") or r.conditional:
                continue
            if ".launch" in use.at.path and _covered(other, installs, use.at.path):
                return True
    return False


def _aside(package, target) -> bool:
    from ...model.package import role_of_folder

    inside = lambda p: p[len(package.path) :].lstrip("/")  # noqa: E731
    if role_of_folder(inside(target.at.path)) or re.search(
        r"(^|_)(test|tests|example|demo|benchmark)(_|$)", target.name
    ):
        return True
    return bool(target.sources) and all(role_of_folder(inside(s)) for s in target.sources)


def _covered(package, installs, path: str) -> bool:
    """True when an install rule takes the file."""
    for install in installs:
        for item in install.items:
            if "$" in item:
                return True
            item = posixpath.normpath(item.rstrip("/")) if item.rstrip("/") else ""
            if path == item:
                return True
            base = "" if item in ("", ".") else f"{item}/"
            if install.kind == "directory" and path.startswith(base) and lets_in(install, path[len(base) :]):
                return True
            if install.kind == "python" and (path.startswith(item + "/") or not item):
                return True
    return False


def _descriptions(view: View, package, installs):
    """Plugin descriptions that the manifest exports (catkin)."""
    for export in package.manifest.exports:
        value = export.attributes.get("plugin", "")
        if not value.startswith("${prefix}"):
            continue
        path = posixpath.normpath(posixpath.join(package.path, value[len("${prefix}/") :]))
        if path not in package.files:
            if path + ".in" in package.files or _covered(package, installs, path):
                continue
            yield Hit(
                At(package.digest.manifest_path, export.line),
                value[len("${prefix}/") :],
                f"the exported plugin description `{value[len('${prefix}/') :]}` does not exist",
                "correct the path",
                package.name,
            )
        elif package.build_type == "catkin" and not _covered(package, installs, path):
            yield Hit(
                At(package.digest.manifest_path, export.line),
                posixpath.basename(path),
                f"the exported plugin description `{posixpath.basename(path)}` is not installed",
                f"install(FILES {value[len('${prefix}/') :]} DESTINATION ${{CATKIN_PACKAGE_SHARE_DESTINATION}})",
                package.name,
                severity="error" if _is_shipped(view, package, installs, path) else "warning",
            )


def _is_shipped(view: View, package, installs, description: str) -> bool:
    """True when a library that the description names is installed, so that the plugins are there for others."""
    if package.build.unresolved:
        return False
    libraries = (posixpath.basename(c.library) for path, c in package.digest.plugins if path == description)
    names = {name.removeprefix("lib").removesuffix(".so") for name in libraries}
    return any(
        item in names and view.certain(i.conditions) for i in installs if i.kind == "targets" for item in i.items
    )


def _folders(view: View, package, installs, referred):
    """Launch files and data that something of the workspace opens and no rule installs."""
    opened = referred.get(package.name, {}).get("file", set())
    missing: dict[str, str] = {}
    for name in sorted(opened):
        path = posixpath.normpath(posixpath.join(package.path, name)) if "$" not in name else ""
        if path in package.files and not _covered(package, installs, path):
            folder = name.split("/")[0] if "/" in name else name
            missing.setdefault(folder, name)
    missing.pop("package.xml", None)  # every build type installs it
    for folder, name in missing.items():
        at = package.build.catkin_package or package.build.ament_package or At(package.build.files[0], 1)
        yield Hit(
            at,
            folder,
            f"`{name}` is opened through the package's share folder and not installed",
            f"install(DIRECTORY {folder} DESTINATION "
            + ("${CATKIN_PACKAGE_SHARE_DESTINATION})" if package.build_type == "catkin" else "share/${PROJECT_NAME})"),
            package.name,
        )
    scripts = referred.get(package.name, {}).get("executable", set())
    for path in package.digest.scripts:
        name = posixpath.basename(path)
        if name in scripts and not _covered(package, installs, path):
            yield Hit(
                At(path, 1),
                name,
                f"`{name}` is started by a launch file and not installed",
                "catkin_install_python(PROGRAMS ...)"
                if package.build_type == "catkin"
                else "install(PROGRAMS ... DESTINATION lib/${PROJECT_NAME})",
                package.name,
            )
