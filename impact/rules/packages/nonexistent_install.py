"""nonexistent-install: an install rule names a file or folder that does not exist, or a variable that nothing sets.

What it does
    Reports files, programs and folders in install() that neither the tree has nor the build makes, patterns such as
    `lib/*.so`, which install() does not expand, rules without DESTINATION, generator expressions as folders, and
    variables of catkin for places that are misspelt, were removed in Groovy, or are used before catkin_package() sets
    them.

Why it breaks
    `make install` stops: "file INSTALL cannot find". CMake stops at a rule without destination, also where its variable
    is empty; an empty variable before a path puts the files into a wrong place.

Severity
    error; warning for generator expressions, at which only installing symbolic links stops, and for folders of which
    only matching files are installed, since CMake goes on without them.

Example
    install(DIRECTORY launch config DESTINATION share/${PROJECT_NAME})     # there is no folder `config`

Use instead
    install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})

Not reported
    Libraries, what is OPTIONAL, and folders that git cannot keep while they are empty; files that the build makes;
    rules under a condition that is unknown on the target.
"""

import posixpath
import re
from collections.abc import Iterator

from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule
from .absent_paths import is_absent
from .install_rules import read_installs


@rule(
    group="missing-install",
    texts={
        "absent": Text("`{subject}` is installed but does not exist", "create it, or drop it from the rule"),
        "pattern": Text(
            "install({kind}) does not expand `{subject}` and finds no file of that name",
            "use install(DIRECTORY) with `FILES_MATCHING PATTERN`, or list the files by `file(GLOB)`",
        ),
        "nothing": Text("`{subject}` does not exist, so the rule installs nothing", "correct the folder"),
        "target": Text(
            "install(TARGETS) names `{subject}`, which is not a CMake target, so CMake stops", "add it, or drop it"
        ),
        "no destination": Text("install({kind}) has no {subject}, so CMake stops", "add it"),
        "symlinks": Text(
            "`colcon build --symlink-install` treats `{subject}` as the name of a folder", "write the folder itself"
        ),
        "early": Text("`{subject}` is used before catkin_package() sets it", "call catkin_package() before install()"),
        "never": Text("`{subject}` is set by catkin_package(), which is never called", "call catkin_package()"),
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
def nonexistent_install(view: TargetView, package: Package):
    installs = read_installs(view, package)
    if installs is not None:
        yield from _list_absent(view, package, installs)
        yield from _list_absent_targets(view, package, installs)
        yield from _list_unset(view, package)


def _list_absent(view: TargetView, package: Package, installs) -> Iterator[Diagnostic]:
    for install in installs:
        if install.kind not in ("files", "programs", "directory") or not view.is_sure(install.conditions):
            continue
        if not install.destination:
            yield Diagnostic(install.at, "DESTINATION", package.name, {"kind": install.kind.upper()}, "no destination")
        for item in () if install.optional else install.items:
            path = posixpath.normpath(item)
            if _stops_symlinks(package, install, item):
                subject = item.replace(f"{package.path}/", "") if package.path else item
                yield Diagnostic(install.at, subject, package.name, kind="symlinks", doubts=(Doubt.CONDITIONAL,))
            if re.search(r"[*?]", item) and "$<" not in item:
                doubts = (Doubt.DISTURBS,) if install.only else ()
                subject, data = path.removeprefix(f"{package.path}/"), {"kind": install.kind.upper()}
                yield Diagnostic(install.at, subject, package.name, data, "pattern", doubts=doubts)
                continue
            if item.startswith(("/", "build", "devel")) or re.search(r"[$<>]", item):
                continue
            if package.path and not path.startswith(package.path + "/"):
                continue
            if install.kind == "directory" and _may_be_empty(package, path):
                continue
            if install.kind == "files" and "." in path and not path.endswith(_BY_HAND):
                continue
            if is_absent(view, package, path):
                # A folder of which only some files are installed may be missing.
                kind, doubts = ("nothing", (Doubt.DISTURBS,)) if install.only else ("absent", ())
                subject = path[len(package.path) :].lstrip("/")
                yield Diagnostic(install.at, subject, package.name, kind=kind, doubts=doubts)


def _list_absent_targets(view: TargetView, package: Package, installs) -> Iterator[Diagnostic]:
    """Targets that nothing in the package adds, or only where an option is set that is not set by default."""
    build = package.build
    if build.unresolved or any(t.kind in ("external", "fetched") or t.name.endswith("()") for t in build.targets):
        return  # what is not read may add it
    added = [t for t in build.targets if t.kind != "unknown"]
    for install in installs:
        if install.kind != "targets" or not view.is_sure(install.conditions):
            continue
        for item in install.items:
            own = [t for t in added if t.name == item]
            if re.search(r"[$*<]", item) or any(view.applies(t.conditions) for t in own):
                continue
            yield Diagnostic(install.at, item, package.name, kind="target")


def _may_be_empty(package: Package, path: str) -> bool:
    """Whether a folder may be one for headers or built files that git cannot keep while it is empty, and not
    one of `include` beside others that are there."""
    above = f"{posixpath.dirname(path)}/"
    if "/include/" in f"/{above}" and any(name.startswith(above) for name in package.digest.files):
        return False
    return re.search(r"(^|/)(include|lib|bin)(/|$)", path) is not None


def _stops_symlinks(package: Package, install, item: str) -> bool:
    """Whether ament's own install(DIRECTORY), which links files instead of copying them, takes an item for the name of
    a folder that does not exist. Source: ament_cmake_symlink_install_directory.cmake of ament_cmake_core."""
    if package.build.ament_package is None or install.kind != "directory" or "$<" not in item:
        return False
    return not (install.executable or install.only or any("~" in pattern for pattern in install.patterns))


# Endings of files that people write; the build itself may write others.
_BY_HAND = (".launch", ".xml", ".yaml", ".py", ".h", ".hpp", ".md", ".rviz")
# What catkin itself sets that may name a place (catkin's all.cmake and catkin_package.cmake).
_PLACES = frozenset({"CATKIN_DEVEL_PREFIX", "CATKIN_TEST_RESULTS_DIR", "CATKIN_ENV"})
# What catkin_package() sets of them.
_OF_CATKIN_PACKAGE = frozenset(
    f"CATKIN_PACKAGE_{name}_DESTINATION" for name in ("BIN", "ETC", "INCLUDE", "LIB", "PYTHON", "SHARE")
)


def _may_be_set(view: TargetView, package: Package) -> bool:
    """Whether a package whose CMake is not known may set variables of its own that are called as catkin's are."""
    others = {found.name for found in package.build.found} - {"catkin"} - view.workspace.packages.keys()
    return any(view.offers.find_package(name) is None for name in others if view.is_package(name))


def _list_unset(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    """Catkin's variables for places, misspelt or of a time before Groovy."""
    seen = set()
    for use in package.build.uses:
        if use.kind != "variable" or use.context != "install" or not use.name.startswith("CATKIN_"):
            continue
        if not use.name.endswith(("_PREFIX", "_DESTINATION", "_DIR")) or use.name in _PLACES:
            continue
        if use.name in seen or package.build_type != "catkin" or package.name == "catkin":
            continue
        if not view.is_sure(use.conditions):
            continue
        kind = "unset, build" if use.name == "CATKIN_BUILD_PREFIX" else "unset"
        if use.name in _OF_CATKIN_PACKAGE:
            unknown = any(one.kind == "command" and not one.context for one in package.build.uses)
            if package.build.catkin_package is None and (package.build.unresolved or unknown):
                continue  # a command that is not known may call it
            kind = "early" if package.build.catkin_package else "never"
        if kind == "unset" and _may_be_set(view, package):
            continue
        seen.add(use.name)
        yield Diagnostic(use.at, use.name, package.name, kind=kind)
