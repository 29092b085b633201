"""nonexistent-install: an install rule names a file or folder that does not exist, or a variable that nothing sets.

What it does
    Reports files, programs and folders in install() that neither the tree has nor the build makes, and variables of
    catkin for places that are misspelt or were removed in Groovy.

Why it breaks
    `make install` stops: "file INSTALL cannot find". With an empty variable the files end up in a wrong place.

Severity
    error.

Example
    install(DIRECTORY launch config DESTINATION share/${PROJECT_NAME})     # there is no folder `config`

Use instead
    install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})

Not reported
    Libraries, and folders that git cannot keep while they are empty; files that the build makes; rules under a
    condition that is unknown on the target.
"""

import posixpath
import re
from collections.abc import Iterator

from ...model.view import TargetView
from ..rule import Diagnostic, Doubt, Text, rule
from .install_rules import list_installing


@rule(
    scope="target",
    group="missing-install",
    texts={
        "absent": Text("`{subject}` is installed but does not exist", "create it, or drop it from the rule"),
        "unset": Text(
            "nothing sets `{subject}`, so files are looked for, or installed, in a wrong place",
            "correct the variable's name",
        ),
        "unset, build": Text(
            "nothing sets `{subject}`, so files are looked for, or installed, in a wrong place",
            "write `${{CATKIN_DEVEL_PREFIX}}`",
        ),
    },
)
def nonexistent_install(view: TargetView):
    for package, installs in list_installing(view):
        yield from _list_absent(view, package, installs)
        yield from _list_unset(view, package)


def _list_absent(view: TargetView, package, installs) -> Iterator[Diagnostic]:
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
            if path + ".in" in package.files or (install.kind == "files" and "." in path and _is_written(path)):
                continue
            if _is_made(made, path, install.kind) or view.workspace.is_unread(path):
                continue
            inside = path[len(package.path) :].lstrip("/")
            yield Diagnostic(install.at, inside, package.name, kind="absent")


def _is_made(made: frozenset[str], path: str, kind: str) -> bool:
    """True for a path that configuring or building writes, or that holds such ones; made: as Build.made."""
    if path in made or any(item.endswith("/") and f"{path}/".startswith(item) for item in made):
        return True
    return kind == "directory" and any(item.startswith(f"{path}/") for item in made)


def _is_written(path: str) -> bool:
    """True for files that the build itself writes: another command mentions their name."""
    return not any(path.endswith(e) for e in (".launch", ".xml", ".yaml", ".py", ".h", ".hpp", ".md", ".rviz"))


# What catkin itself sets that may name a place (catkin's all.cmake and catkin_package.cmake).
_PLACES = frozenset({"CATKIN_DEVEL_PREFIX", "CATKIN_TEST_RESULTS_DIR", "CATKIN_ENV"})


def _list_unset(view: TargetView, package) -> Iterator[Diagnostic]:
    """Catkin's variables for places, misspelt or of a time before Groovy."""
    others = {found.name for found in package.build.found} - {"catkin"} - view.workspace.packages.keys()
    # A package whose CMake is not known may set variables of its own that are called so.
    unknown = any(view.offers.package(name) is None for name in others if view.is_package(name))
    doubts = (Doubt.INCOMPLETE,) if unknown else ()
    seen = set()
    for use in package.build.uses:
        if use.kind != "variable" or use.context != "install" or not use.name.startswith("CATKIN_"):
            continue
        if not use.name.endswith(("_PREFIX", "_DESTINATION", "_DIR")) or use.name in _PLACES:
            continue
        if use.name in seen or package.build_type != "catkin" or package.name == "catkin":
            continue
        if not view.certain(use.conditions):
            continue
        seen.add(use.name)
        kind = "unset, build" if use.name == "CATKIN_BUILD_PREFIX" else "unset"
        yield Diagnostic(use.at, use.name, package.name, kind=kind, doubts=doubts)
