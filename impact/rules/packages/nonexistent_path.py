"""nonexistent-path: a build or a launch file reads a file that does not exist or is not part of a release.

What it does
    Reports files that neither exist nor are made by the build: sources of targets, files given to test commands and to
    the generator of interfaces, files that include() and add_subdirectory() read, and launch files, parameter files and
    robot descriptions that a launch file opens in the share folder of a package of the workspace. Also reports paths in
    CMake that exist only in some places: outside the package's folder (`../common.cmake`), in a user's home folder,
    below `${CMAKE_SOURCE_DIR}` as if the build always started in a folder above the package, and libraries linked by
    the folder that some system has them in (`/usr/lib/libompl.so`).

Why it breaks
    CMake stops: "Cannot find source file", "could not find requested file". A release contains only the package's
    folder, and `${CMAKE_SOURCE_DIR}` is that folder when colcon, catkin_make_isolated or the build farm builds the
    package. A launch file stops when it opens the file.

Severity
    error for files that a build reads; warning for tests, under a condition, where the build downloads something or
    what is run while configuring may write files, for paths that exist only in some places, and for files that launch
    files open; note for files outside of a package that was never released.

Example
    add_executable(sled_node src/sled_nod.cpp)

Use instead
    add_executable(sled_node src/sled_node.cpp)

Not reported
    Files that the build makes, and sources in folders that something in it may make; paths that cannot be resolved;
    folders that were not read, such as submodules; include directories in other packages, which need not exist.
"""

import posixpath
import re
from collections.abc import Iterator

from ...model.absent_headers import may_be_made
from ...model.cmake.build import WrittenPath, is_for_tests
from ...model.cmake.interpreter import calls_unmodelled
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Together, rule
from .absent_paths import is_absent
from .data_files import list_copied
from .install_rules import list_places
from .refused_names import find_policy_version

_CORRECT = "correct or remove the path"


@rule(
    texts={
        "source": Text("target `{by}` lists source `{subject}`, which does not exist", _CORRECT),
        "test": Text("test file `{subject}` does not exist", _CORRECT),
        "read": Text("{by}() reads `{subject}`, which does not exist", _CORRECT),
        "opened": Text(
            "package `{by}` has no file `{subject}`, which is opened here", "correct the path, or create the file"
        ),
        "above": Text(
            "`{subject}` is below `${{CMAKE_SOURCE_DIR}}` only when catkin_make builds the whole workspace",
            "write `${{PROJECT_SOURCE_DIR}}/{subject}`",
        ),
        "outside": Text(
            "`{subject}` is outside the package, so it is missing when `{package}` is built from its release",
            "move it into this package, or into a dependency that installs it",
        ),
        "machine": Text("`{subject}` is a path of one machine", "use find_package() or find_path() instead"),
        "library": Text(
            "`{subject}` is linked by a path that exists only where something outside of this build put it there",
            "use find_package() or find_library() instead",
        ),
    },
)
def nonexistent_path(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    yield from _list_opened(view, package)
    seen: set[str] = set()
    for use in package.build.list_paths():
        kind, subject = _find_fault(view, package, use)
        if not kind or not view.applies(use.conditions):
            continue
        certain = view.is_sure(use.conditions)
        if kind in ("outside", "machine", "library", "read") and (subject in seen or not certain):
            continue  # it may be asked for first
        seen.add(subject)
        tests = kind == "test" or is_for_tests(use.conditions)
        doubts = (
            Doubt.DISTURBS if kind in ("above", "outside", "machine", "library") else None,
            certain or Doubt.CONDITIONAL,
            kind != "outside" or view.target.was_ever_released(package.name) or Doubt.DISPENSABLE,
            not tests or (view.is_built("test") and view.roles.farm_makes_tests) or Doubt.TEST,
            not (package.build.builds_others or package.build.starts or calls_unmodelled(package.build))
            or Doubt.INCOMPLETE,
        )
        yield Diagnostic(use.at, subject, package.name, {"by": use.by}, kind, doubts)


_LIBRARY = re.compile(r"/(?:usr|opt|lib)/.+\.(?:so[\d.]*|a)\Z")
_READ = (".cmake", ".txt", ".msg", ".srv", ".action", ".idl")
_HOME = re.compile(r"(?:/home|/Users)/[\w.-]+/|/root/|[A-Za-z]:[/\\]")


def _find_fault(view: TargetView, package: Package, use: WrittenPath) -> tuple[str, str]:
    """What is wrong with a path, as the kind of a text and the subject, both empty where nothing is."""
    path = posixpath.normpath(use.path)
    if _HOME.match(path):
        return "machine", path
    if use.how == "link" and _LIBRARY.match(path):
        return "library", path
    if inside := package.find_doubled(path):
        return "above", inside
    if use.how in ("link", "include") or re.search(r"[$*?<>\[\]]", path) or path.startswith("/"):
        return "", ""
    if path.startswith("../") or (package.path and not f"{path}/".startswith(f"{package.path}/")):
        # What lies in another package has to be there; of what lies in none, the packages cannot tell.
        owner = next((other for other in view.list_built() if path.startswith(f"{other.path}/")), None)
        if owner is not None and (path, owner.name) in package.build.from_found:
            return "", ""  # found beside the CMake files that the owner installs
        if owner is not None and path not in owner.files and path not in owner.folders:
            return "", ""
        return "outside", posixpath.relpath(path, package.path or ".")
    file = posixpath.join(path, "CMakeLists.txt") if use.by in ("add_subdirectory", "subdirs") else path
    if use.how == "install" or (use.how == "read" and not file.endswith(_READ)) or posixpath.basename(file).isupper():
        return "", ""  # what is all capitals is a keyword
    if file != path and path in package.folders and find_policy_version(package) < (2, 8):
        return "", ""  # a folder without CMakeLists.txt, which was ignored (CMP0014)
    folder = posixpath.dirname(path)
    apart = folder != package.path and folder not in package.folders
    if use.how == "source" and apart and (package.build.unresolved or may_be_made(package, posixpath.basename(path))):
        return "", ""  # generators make folders of their own
    return (use.how, package.strip_path(path)) if is_absent(view, package, file) else ("", "")


_OPENED = re.compile(r"\.(?:launch|launch\.(?:py|xml|yaml)|ya?ml|urdf|xacro|srdf|rviz)\Z")


def _list_opened(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    """Files in share folders of the workspace that a launch file opens in any case."""
    for use in package.linked.references:
        r = use.reference
        owner = view.workspace.packages.get(r.package)
        opens = r.kind in ("file", "sought") and use.role == "run" and not r.conditional
        if not opens or owner is None or "launch" not in use.at.path:
            continue
        name = posixpath.normpath(r.name)
        known = r.kind == "sought" and any(posixpath.basename(file) == name for file in owner.files)
        if known or not _OPENED.search(name) or "$" in name or name.startswith(".."):
            continue
        path = posixpath.join(owner.path, name)
        installs = owner.build.installs if owner.build.files else list_copied(owner)
        if installs is None or owner.build.unresolved or not is_absent(view, owner, path):
            continue
        last = f"/{posixpath.basename(name)}"
        if not owner.build.files and not any(file.endswith(last) for file in owner.linked.files):
            continue  # it may be made, as calibrations are
        places = list_places(owner, installs)
        if places is not None and f"share/{owner.name}/{name}" not in places:  # as which another file is installed
            # Of many, the files have been moved, or the package has never been launched where it is installed.
            same = (Together(f"no {name} in {owner.name}", everywhere=True), Together("opened", few=3))
            data = {"by": owner.name}
            yield Diagnostic(use.at, name, package.name, data, "opened", (Doubt.DISTURBS,), together=same)
