"""The install rules of packages, as the rules on them ask for it."""

import posixpath
import re
from collections.abc import Iterable, Iterator

from ....edges.memory import cache_in_derived
from ...model.cmake.build import Install
from ...model.cmake.installed import lets_in, list_copied_files
from ..vocabulary import At, Doubt, Package, TargetView, list_ended_doubts
from .data_files import read_data_files

LAUNCH_FILE = re.compile(r"[._]launch\.(?:py|xml|ya?ml)\Z")
"""Launch files of ROS 2, which `ros2 launch` finds in the share folder alone."""


def read_installs(view: TargetView, package: Package) -> list[Install] | None:
    """The install rules of a package that count on the target; None where they are not known."""
    if not package.build.files or not package.is_ros_cmake:
        return None
    if package.build.finds_declared and package.build.packaged is None:
        return None
    return [i for i in package.build.installs if view.applies(i.conditions)]


def list_install_doubts(view: TargetView, package: Package) -> tuple[Doubt, ...]:
    """What speaks against more than a note where a rule to install something is missing: packages of catkin run from
    the build tree, and into a distro that has ended nothing is released any more."""
    return list_ended_doubts(view) if package.build_type == "catkin" else ()


def list_copying_rules(view: TargetView, package: Package) -> Iterator[Install]:
    """The install rules that surely count on the target and copy files, programs or folders."""
    for install in read_installs(view, package) or ():
        if install.kind in ("files", "programs", "directory") and view.is_sure(install.conditions):
            yield install


def is_installed(installs: Iterable[Install], path: str) -> bool:
    """Whether an install rule takes a file, or may take it: a path with a variable may be any that ends like it."""
    for install in installs:
        for item in install.items if install.kind != "targets" else ():  # these are built
            name = posixpath.basename(item)
            if "$" in item and ("$" in name or install.kind not in ("files", "programs")):
                return True
            if "$" in item and name == posixpath.basename(path):
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


def may_stay_behind(view: TargetView, package: Package, path: str) -> bool:
    """Whether a Python file counts as installed only since install rules take what is not known: a variable that
    nothing sets may name it, or not, and so may data_files that only running setup.py tells, and all that a build
    system does whose files are not read. What a launch file or script starts is there."""
    if package.build_type == "ament_python":
        folder, inside = posixpath.dirname(path), package.strip_path(path)
        if "/" not in inside or inside.startswith((f"{package.name}/", "launch/")) or read_data_files(package):
            return False
        module = f"{folder}/__init__.py" in package.files or path.endswith("launch.py")
        return not module and posixpath.basename(path) not in list_references(view, package, "executable")
    installs = [rule for rule in package.build.installs if view.applies(rule.conditions)]
    known = [rule for rule in installs if not any("$" in item for item in rule.items)]
    inside = package.strip_path(path)
    by_setup = package.build_type == "catkin" and inside.startswith("src/") and package.has_files("setup.py")
    is_read = bool(package.build.files) or package.build_type == "catkin"
    if (is_read and len(known) == len(installs)) or by_setup or is_installed(known, path):
        return False
    return posixpath.basename(path) not in list_references(view, package, "executable")


def list_places(package: Package, installs: Iterable[Install]) -> frozenset[str] | None:
    """The paths in the prefix of all files that install rules copy from the tree, and of their folders; None where
    a rule may put files to places that are not known."""
    rules = [install for install in installs if install.kind in ("files", "programs", "directory")]
    if any("$" in text or "*" in text for rule in rules for text in (rule.destination, *rule.items)):
        return None
    found: set[str] = set()
    for rule in rules:
        for _, place in list_copied_files(rule, posixpath.normpath(rule.destination), package.linked.files):
            while place and place not in found:
                found.add(place)
                place = posixpath.dirname(place)
    return frozenset(found)


def list_references(view: TargetView, package: Package, *kinds: str) -> dict[str, At]:
    """What the workspace's launch files and scripts start or open in a package, each with the first place that does; of
    all kinds where none is given."""
    found = _list_all_references(view).get(package.name, {})
    return {name: at for kind in kinds or found for name, at in found.get(kind, {}).items()}


@cache_in_derived
def _list_all_references(view: TargetView) -> dict[str, dict[str, dict[str, At]]]:
    """Package to kind to names, with their first places. An example that is installed is started there as well."""
    found: dict[str, dict[str, dict[str, At]]] = {}
    for package in view.workspace:
        installs = read_installs(view, package) or []
        for use in package.linked.references:
            r = use.reference
            example = use.role == "aside" and r.package == package.name and is_installed(installs, use.at.path)
            if r.package and r.name and (use.role == "run" or example):
                found.setdefault(r.package, {}).setdefault(r.kind, {}).setdefault(r.name, use.at)
    return found
