"""misplaced-install: an install rule puts programs, launch files, modules or components where nobody looks for them.

What it does
    Reports nodes outside of `lib/` and the package's name, launch files outside of the package's folder in share,
    registered components outside of `lib`, and install folders of a Python version other than the target's.

Why it breaks
    The package itself builds. But rosrun or ros2 run do not find its programs, roslaunch or ros2 launch its launch
    files, Python its modules, or component containers its library, which they load from `lib`.

Example
    install(TARGETS winch_node DESTINATION bin)

Use instead
    install(TARGETS winch_node DESTINATION lib/${PROJECT_NAME})

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
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Together, rule
from .install_rules import list_places, list_references, read_installs


@rule(
    group="missing-install",
    doubts=(Doubt.LATE,),
    texts={
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
    for find in (_list_components, _list_programs, _list_launch_files, _list_other_python):
        yield from find(view, package, installs)


def _list_components(view: TargetView, package: Package, installs) -> Iterator[Diagnostic]:
    """Libraries of registered components that no rule installs into lib, where the resource index says they are."""
    components = {e.context for e in package.build.exports if e.how == "component"}
    by_name = {t.name for t in package.build.targets if t.kind in ("library", "module") and not t.static}
    for name in sorted(components & by_name):
        place = _find_wrong_place(installs, name, "lib")
        if place is not None:
            data = {"destination": place.destination}
            yield Diagnostic(place.at, name, package.name, data, "component")


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
        yield Diagnostic(place.at, target.name, package.name, data, "program")


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
            yield Diagnostic(install.at, subject, package.name, data, "launch")


# Where files may lie for others than those who start launch files by package and name.
_NO_DATA = frozenset(("", ".", "..", "bin", "etc", "include", "lib"))


def _list_other_python(view: TargetView, package: Package, installs) -> Iterator[Diagnostic]:
    """Install folders of a Python version that the target does not have."""
    own = f"{view.target.python_major}.{view.target.python}"
    for install in installs:
        found = re.search(r"(?:^|/)python([23]\.\d+)/(?:site|dist)-packages", install.destination)
        if found is None or found.group(1) == own or install.guessed or not view.is_sure(install.conditions):
            continue
        data = {"version": found.group(1), "own": own}
        same = (Together(f"folder of Python {found.group(1)}"),)
        yield Diagnostic(install.at, install.destination, package.name, data, "python", together=same)
