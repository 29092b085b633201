"""path-outside-package: CMake reads a file that lies outside of the package, or on one machine alone.

What it does
    Reports include(), add_subdirectory(), sources and install rules whose path leads out of the package's folder
    (`../common.cmake`), and paths into somebody's home folder.

Why it breaks
    A release holds the package's folder alone, and so does the machine that builds it: CMake stops, as the file is not
    there. A home folder is nowhere else at all.

Severity
    warning; note for a package that was never released, whose whole repository may always be at hand.

Example
    include(../cmake/version.cmake)

Use instead
    include(cmake/version.cmake)            # in the package's own folder, or exported by a package of its own

Not reported
    Paths under a condition; folders of headers in other packages, which need not exist; links within the repository.
"""

import posixpath
import re
from collections.abc import Iterator

from ...facts.condition import Condition
from ...model.cmake.build import At
from ...model.view import TargetView
from ...model.workspace import Package
from ..rule import Diagnostic, Doubt, Text, rule

_HOME = re.compile(r"(?:/home|/Users)/[\w.-]+/|/root/|[A-Za-z]:[/\\]")


@rule(
    severity="warning",
    texts={
        "outside": Text(
            "`{subject}` lies outside of the package, so it is not there where `{package}` is built from its release",
            "move it into the package, or into one that exports it",
        ),
        "machine": Text("`{subject}` exists on one machine alone", "look for it with find_package or find_path"),
    },
)
def path_outside_package(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    known = view.target.ever_released(package.name)
    seen: set[str] = set()
    for path, at, conditions in _list_paths(package):
        if path in seen or not view.certain(conditions):
            continue
        seen.add(path)
        if _HOME.match(path):
            yield Diagnostic(at, path, package.name, kind="machine")
        elif _is_outside(view, package, path):
            doubts = () if known else (Doubt.DISPENSABLE,)
            shown = posixpath.relpath(path, package.path or ".")
            yield Diagnostic(at, shown, package.name, kind="outside", doubts=doubts)


def _list_paths(package: Package) -> Iterator[tuple[str, At, tuple[Condition, ...]]]:
    """The paths that CMake reads, with their place and conditions; of folders of headers those that are absolute."""
    build = package.build
    for read in build.read_elsewhere:
        yield read.path, read.at, read.conditions
    for target in build.targets:
        guarded = dict(target.guarded)
        for path in target.sources:
            yield path, target.at, (*target.conditions, *guarded.get(path, ()))
        for link in target.links:
            if link.item.startswith("/") and link.how in ("link", "include"):
                yield link.item, link.at, (*target.conditions, *link.conditions)
    for path, at in build.include_dirs:
        if path.startswith("/"):
            yield path, at, ()
    for install in build.installs:
        for path in install.items if install.kind in ("files", "programs", "directory") else ():
            yield path, install.at, install.conditions


def _is_outside(view: TargetView, package: Package, path: str) -> bool:
    """True for a path that leads out of the package's folder and, where it stays in the tree, is there."""
    if "$" in path or path.startswith("/"):
        return False
    if not package.path:
        return posixpath.normpath(path).startswith("../")
    path = posixpath.normpath(path)
    if path == package.path or path.startswith(package.path + "/"):
        return False
    return path.startswith("../") or path in view.workspace.gathered.ids or any(
        path in other.folders for other in view.everyone()
    )
