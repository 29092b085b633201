"""misplaced-install: an install rule puts headers, modules, programs or components where nobody looks for them.

What it does
    Reports a folder `include` that is installed into another `include` or below it, headers that are installed under
    another folder name than code includes them by or one folder too deep, nodes outside of `lib/` and the package's
    name, launch files outside of the package's folder in share, registered components outside of `lib`, and install
    folders of a Python version other than the target's.

Why it breaks
    The package itself builds. But dependants do not find its headers, rosrun or ros2 run its programs, Python its
    modules, or component containers its library, which they load from `lib`.

Severity
    error where dependants of an ament package miss such a header; warning otherwise.

Example
    install(DIRECTORY include DESTINATION include)

Use instead
    install(DIRECTORY include/ DESTINATION include)

Not reported
    Folders whose name contains a variable that is not known.
"""

import posixpath
import re
from collections.abc import Iterator

from ...model.cmake.build import Install
from ...model.cmake.installed import list_copied_files
from ...model.cmake.links import resolve_package
from ...model.package import find_folder_role
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule
from .dependants import list_compiled_elsewhere
from .install_rules import is_installed, list_places, list_references, read_installs


@rule(
    group="missing-install",
    texts={
        "doubled": Text(
            "the folder `include` is installed into `{destination}`, so headers end up in {destination}/include",
            "write `{instead}` with a slash at its end",
        ),
        "nested": Text(
            "the folder `{name}` is installed into `{destination}`, so headers end up in {destination}/{name}",
            "write `{instead}` with a slash at its end",
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
        "launch": Text(
            "`{file}` is installed into `{destination}`, but launch files are looked for in `{place}`",
            "install it into `{place}`",
        ),
        "python": Text(
            "`{subject}` belongs to Python {version}, but the target has Python {own}",
            "use ament_python_install_package(), or the folder of the Python that CMake finds",
        ),
    },
)
def misplaced_install(view: TargetView, package: Package):
    installs = read_installs(view, package) or ()
    for find in (_list_headers, _list_components, _list_programs, _list_launch_files, _list_other_python):
        yield from find(view, package, installs)


def _list_headers(view: TargetView, package: Package, installs) -> Iterator[Diagnostic]:
    """Folders called include that are installed into one of that name, so that headers end up in include/include, and
    folders of headers whose name is lost: include/a/ installed into include/b while sources include <a/...>."""
    for install in installs:
        root, include, tail = install.destination.rstrip("/").rpartition("include")
        for item in install.items if install.kind == "directory" and include else ():
            # How others include what lies outside of the workspace is not known.
            folder = _FOLDER.search(item) if "$" not in item else None
            if tail[:1] in ("", "/") and root[-1:] in ("", "/") and item.rpartition("/")[2] == "include":
                kind, subject, lost, place = "doubled", "include", item, install.destination.rstrip("/")
                if any(exported.rstrip("/").endswith(f"{place}/include") for exported in _list_exported(view, package)):
                    continue
                instead = f"include{tail.rstrip('/')}/" if package.build_type == "catkin" else "include/"
                data = {"destination": place, "instead": instead}
            elif not root and "$" not in item and item.endswith(f"/{include}{tail}") and tail.count("/") == 1:
                kind, subject, lost = "nested", install.destination, posixpath.dirname(item)
                exported = _list_exported(view, package)
                unknown = package.build_type != "catkin" and any("$" in one for one in exported)
                if unknown or any(one.rstrip("/").endswith(f"{include}{tail}") for one in exported):
                    continue
                if _is_copied_too(package, install, item):
                    continue
                data = {"destination": subject, "name": tail[1:], "instead": f"{include}{tail}/"}
                if tail == f"/{package.name}" and package.build_type == "catkin":
                    subject = "CATKIN_PACKAGE_INCLUDE_DESTINATION"
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


def _is_copied_too(package: Package, install: Install, folder: str) -> bool:
    """Whether another rule takes a header of a folder."""
    others = [one for one in package.build.installs if one is not install and one.kind in ("directory", "files")]
    return any(is_installed(others, header) for header in package.linked.headers if header.startswith(f"{folder}/"))


_FOLDER = re.compile(r"(?:^|/)include/([\w-]+)/\Z")


def _list_exported(view: TargetView, package: Package) -> list[str]:
    """The folders that dependants search for headers."""
    exported = [e.item for e in package.build.exports if "include" in e.how and view.is_sure(e.conditions)]
    return [*exported, *(place for target in package.build.targets for place in target.installed_includes)]


def _is_lost(view: TargetView, package: Package, install, folder: str) -> bool:
    """True when another package of the workspace compiles a header of the folder, or the package exports the place
    where its headers should lie, and no other rule installs them there; not of catkin, whose devel space has them."""
    if not view.is_sure(install.conditions) or package.build.unresolved or package.build.catkin_package is not None:
        return False
    exported = _list_exported(view, package)
    if any("$" in item for item in exported):
        return False
    others = [i for i in package.build.installs if i is not install and i.kind in ("directory", "files")]
    start = posixpath.normpath(folder) + "/"
    headers = {h[len(start) :] for h in package.linked.headers if h.startswith(start)}
    if any(is_installed(others, start + h) for h in headers):
        return False
    if headers and any(item.rstrip("/") in ("include", install.destination.rstrip("/")) for item in exported):
        return True
    return any(path in headers for _, path in list_compiled_elsewhere(view, package))


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
            resolve_package(item) for item in package.build.list_linked_items(target.name) or ()
        }
        if not node and (target.output_name or target.name) not in started:
            continue
        command = "ros2 run" if view.target.ros == 2 else "rosrun"
        data = {"destination": place.destination, "command": command}
        yield Diagnostic(place.at, target.name, package.name, data, "program", (Doubt.LATE,))


_LAUNCH = re.compile(r"\.launch(?:\.(?:py|xml|ya?ml))?\Z|_launch\.py\Z")


def _list_launch_files(view: TargetView, package: Package, installs) -> Iterator[Diagnostic]:
    """Launch files that no rule installs into the package's own folder in share, but one does elsewhere."""
    share = f"share/{package.name}/"
    places = list_places(package, installs)
    names = {posixpath.basename(place) for place in places or () if place.startswith(share)}
    for install in installs if places else ():
        folder = posixpath.normpath(install.destination)
        first, _, rest = folder.partition("/")
        if first in _NO_DATA or (first == "share" and rest.partition("/")[0] in view.workspace.packages):
            continue
        if install.kind not in ("directory", "files"):
            continue
        copied = list_copied_files(install, folder, package.linked.files)
        lost = next((f for f, place in copied if _LAUNCH.search(place) and posixpath.basename(place) not in names), "")
        if lost and find_folder_role(package.strip_path(lost)) is None:
            data = {"file": posixpath.basename(lost), "destination": install.destination, "place": share.rstrip("/")}
            subject = posixpath.basename(posixpath.dirname(lost)) or data["file"]
            yield Diagnostic(install.at, subject, package.name, data, "launch", (Doubt.LATE,))


# Where files may lie for others than those who start launch files by package and name.
_NO_DATA = frozenset(("", ".", "..", "bin", "etc", "include", "lib"))


def _list_other_python(view: TargetView, package: Package, installs) -> Iterator[Diagnostic]:
    """Install folders of a Python version that the target does not have."""
    own = f"{view.target.python_major}.{view.target.python}"
    for install in installs:
        found = re.search(r"(?:^|/)python([23]\.\d+)/(?:site|dist)-packages", install.destination)
        if found is not None and found.group(1) != own and view.is_sure(install.conditions):
            data = {"version": found.group(1), "own": own}
            yield Diagnostic(install.at, install.destination, package.name, data, "python", (Doubt.LATE,))
