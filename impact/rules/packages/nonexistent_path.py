"""nonexistent-path: CMake or a launch file reads a file that does not exist.

What it does
    Reports sources of targets, files given to test commands, and what include() and add_subdirectory() read, where
    neither the tree has the file nor the build makes it, files that are looked for below `${CMAKE_SOURCE_DIR}` as if
    the build always began in a folder above the package, and launch files, parameters and robot descriptions that a
    launch file opens in the share folder of a package of the workspace.

Why it breaks
    CMake stops: "Cannot find source file", "could not find requested file". `${CMAKE_SOURCE_DIR}` is the package itself
    where it is built alone, as colcon, catkin_make_isolated and the build farm do. A launch file stops when it opens
    the file.

Severity
    error; warning for tests, under a condition, where something is downloaded for the build, for what is there as long
    as catkin_make builds the workspace, and for what launch files open.

Example
    add_executable(sled_node src/sled_nod.cpp)

Use instead
    add_executable(sled_node src/sled_node.cpp)

Not reported
    Files that the build makes; paths that are not known; folders that were not read, as a submodule is.
"""

import posixpath
import re
from collections.abc import Iterator

from ...model.cmake.build import At, BuildTarget
from ...model.cmake.installed import copied_files
from ...model.view import TargetView
from ...model.workspace import Package
from ..rule import Diagnostic, Doubt, Text, rule

_DROP = "correct the path, or drop it"


@rule(
    texts={
        "source": Text("`{target}` is built of `{subject}`, which does not exist", _DROP),
        "test": Text("the test `{subject}` does not exist, so CMake stops", _DROP),
        "opened": Text("`{subject}` of `{owner}` is opened but does not exist", "correct the path, or create the file"),
        "read": Text("{command}() reads `{subject}`, which does not exist", _DROP),
        "above": Text(
            "`{subject}` is found below `${{CMAKE_SOURCE_DIR}}` only where catkin_make builds the whole workspace",
            "write `${{PROJECT_SOURCE_DIR}}/{subject}`",
        ),
    },
)
def nonexistent_path(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    yield from _list_sources(view, package)
    for read in package.build.read_elsewhere:
        path = posixpath.join(read.path, "CMakeLists.txt") if read.command != "include" else read.path
        if path.endswith((".cmake", ".txt")) and view.certain(read.conditions) and _is_absent(view, package, path):
            data = {"command": read.command}
            yield from _diagnose(view, package, read.path, read.at, read.conditions, data, "read")
    for target in package.build.targets:
        for link in target.links:
            if re.search(r"\.(?:so|a)(?:\.[\d.]+)?\Z", link.item) and _find_above(package, link.item):
                yield from _diagnose(view, package, link.item, link.at, (*target.conditions, *link.conditions), {})
    yield from _list_opened(view, package)


_OPENED = re.compile(r"\.(?:launch|launch\.(?:py|xml|yaml)|ya?ml|urdf|xacro|srdf|rviz)\Z")


def _list_opened(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    """Files in share folders of the workspace that a launch file opens in any case."""
    for use in package.digest.references:
        r = use.reference
        owner = view.workspace.packages.get(r.package)
        if r.kind != "file" or use.role != "run" or r.conditional or owner is None or "launch" not in use.at.path:
            continue
        name = posixpath.normpath(r.name)
        if not _OPENED.search(name) or name.startswith("..") or not owner.build.files or owner.build.unresolved:
            continue
        path = posixpath.join(owner.path, name)
        if _is_absent(view, owner, path) and f"{path}.in" not in owner.files and not _is_renamed(owner, name):
            data = {"owner": owner.name}
            yield Diagnostic(use.at, name, package.name, data, "opened", (Doubt.DISTURBS,))


def _is_renamed(owner: Package, name: str) -> bool:
    """Whether an install rule puts, or may put, a file to a place of the share folder."""
    place = f"share/{owner.name}/{name}"
    for install in owner.build.installs:
        if any("$" in text for text in (install.destination, *install.items)):
            return True
        copied = copied_files(install, install.destination, owner.digest.files)
        if install.kind in ("files", "directory", "programs") and any(to == place for _, to in copied):
            return True
    return any(g.how == "parameters" for g in owner.build.generated)


def _list_sources(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    """Sources of targets, and files that tests run."""
    for target in package.build.targets:
        if target.kind not in ("executable", "library", "module", "test"):
            continue
        guarded = dict(target.guarded)
        for path in target.sources:
            if _is_absent(view, package, path):
                conditions = (*target.conditions, *guarded.get(path, ()))
                kind = "test" if _runs_file(target, path) else "source"
                yield from _diagnose(view, package, path, target.at, conditions, {"target": target.name}, kind)


def _runs_file(target: BuildTarget, path: str) -> bool:
    """True for a test whose only source is a file that it runs."""
    return target.kind == "test" and target.sources == (path,) and not re.search(r"\.(?:c|cc|cpp|cxx)\Z", path)


def _diagnose(view, package, path: str, at: At, conditions, data: dict[str, str], kind="") -> Iterator[Diagnostic]:
    if not view.active(conditions):
        return
    above = _find_above(package, path)
    subject = above or path[len(package.path) :].lstrip("/")
    doubts = (
        Doubt.DISTURBS if above else None,
        view.certain(conditions) or Doubt.CONDITIONAL,
        kind != "test" or view.built("test") or Doubt.TEST,
        all(t.kind not in ("external", "fetched") for t in package.build.targets) or Doubt.INCOMPLETE,
    )
    yield Diagnostic(at, subject, package.name, data, "above" if above else kind, doubts)


def _find_above(package: Package, path: str) -> str:
    """The file of the package that a path means where its folder's name stands twice: below the package's folder as
    CMAKE_SOURCE_DIR, and in the path itself. Relative to the package; empty for other paths."""
    doubled = f"{package.path}/{posixpath.basename(package.path)}/" if package.path else f"{package.name}/"
    inside = path[len(doubled) :] if path.startswith(doubled) and path not in package.files else ""
    return inside if inside and posixpath.join(package.path, inside) in package.files else ""


def _is_absent(view: TargetView, package: Package, path: str) -> bool:
    """True for a path below the package that neither the tree has nor the build makes."""
    if re.search(r"[$*?<>\[\]]", path) or path.endswith((".o", ".obj", ".a", ".so")):
        return False
    path = posixpath.normpath(path)
    if package.path and not path.startswith(package.path + "/"):
        return False
    if path.startswith(("/", "..")) or path in package.files or path in package.folders or path == ".":
        return False
    if view.workspace.is_unread(path) or any(path in other.files for other in view.everyone()):
        return False
    if "." not in posixpath.basename(path) and any(file.startswith(f"{path}.") for file in package.files):
        return False  # CMake tries the endings of sources
    name = posixpath.basename(path)
    return not any(
        made.rstrip("/").rpartition("/")[2] == name or (made.endswith("/") and path.startswith(made))
        for made in package.build.made
    )
