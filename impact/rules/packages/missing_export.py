"""missing-export: dependants of the package will miss something that it promises or that its headers need.

What it does
    Compares what a package exports with what is there and with what dependants need: include directories and libraries
    that do not exist or are not installed, system libraries exported under a name whose variables nobody sets, packages
    that installed headers include or that an exported target links publicly and that are not exported (in catkin:
    packages of which its messages are made), components of these that dependants do not ask for, and include
    directories of its own headers or of system libraries off the compiler's path.

Why it breaks
    The package builds, and every package that depends on it fails: the header's own includes are not found, or the
    exported configuration names a library that was never built.

Severity
    error where the package's own configuration stops (an include directory that does not exist), and for a library of
    its own that catkin_package() exports and no command makes; warning where a dependant of the workspace, or an
    exported target or library, needs what is missing; note otherwise.

Example
    ament_export_dependencies(rclcpp)           # and include/p/p.hpp includes angles/angles.h

Use instead
    ament_export_dependencies(rclcpp angles)

Not reported
    What an exported package brings in turn; packages that ament_auto exports; until Galactic, where all headers lay in
    one folder, a missing ament_export_dependencies is a note.
"""

import posixpath

from ...model.cmake.links import found_with
from ...model.view import View
from ...targets.providers.library import variables
from ..rule import Diagnostic, rule
from ..severity import Doubt
from ..text import Text
from .exports_ament import TEXTS, list_unexported


@rule(
    scope="target",
    severity="error",
    texts={
        **TEXTS,
        "directory": Text(
            "the exported include directory `{directory}` does not exist, so catkin stops",
            "create it, or drop INCLUDE_DIRS",
        ),
        "no target": Text(
            "the exported library `{subject}` is not a target of `{package}`", "export the library's target name"
        ),
        "system": Text(
            "nothing sets `{subject}_INCLUDE_DIRS` or `{subject}_LIBRARIES`, so DEPENDS exports nothing",
            "{advice}",
        ),
        "messages": Text(
            "the messages use those of `{subject}`, but `{subject}` is not in CATKIN_DEPENDS",
            "add `{subject}` to CATKIN_DEPENDS of catkin_package()",
        ),
    },
)
def missing_export(view: View):
    for package in view:
        if not package.build.files:
            continue
        yield from _directories(view, package)
        if package.build.catkin_package is not None:
            yield from _catkin(view, package)
            yield from _message_packages(view, package)
        if package.build.ament_package is not None:
            yield from list_unexported(view, package)


def _directories(view: View, package):
    made = {posixpath.normpath(i.destination) for i in package.build.installs}
    for export in package.build.exports:
        if export.how != "include_dirs" or "$" in export.item or not view.certain(export.conditions):
            continue
        if package.build.catkin_package is None or export.item.startswith("/") or export.item in made:
            continue
        item = posixpath.normpath(export.item)
        inside = item[len(package.path) :].lstrip("/") if package.path and item.startswith(package.path + "/") else item
        if inside in (".", "") or package.has_files(inside) or inside.startswith(".."):
            continue
        yield Diagnostic(export.at, "INCLUDE_DIRS", package.name, {"directory": inside}, "directory")


def _catkin(view: View, package):
    targets = {t.name for t in package.build.targets} | {t.output_name for t in package.build.targets}
    found = {f.name for f in package.build.found} | {f.prefix for f in package.build.found}
    for export in package.build.exports:
        if not view.active(export.conditions) or "$" in export.item:
            continue
        if export.how == "libraries" and export.item not in targets and not package.build.unresolved:
            if (
                "/" in export.item
                or export.item.startswith("-")
                or export.item.endswith((".so", ".a"))
                or view.cmake(export.item)
            ):
                continue
            sure = view.certain(export.conditions) and _is_own(view, package, export.item)
            doubts = () if sure else (Doubt.AMBIGUOUS,)
            yield Diagnostic(export.at, export.item, package.name, kind="no target", doubts=doubts)
        elif export.how == "system_depends" and export.item not in found and not _sets(package, export.item):
            near = next((f for f in found if f and f.lower().rstrip("3") == export.item.lower().rstrip("3")), None)
            other = near.upper() if near == "Eigen3" else near
            advice = f"write `{other}`" if near else f"find `{export.item}` first"
            doubts = (Doubt.DISTURBS,) if near else (Doubt.DISPENSABLE,)
            yield Diagnostic(export.at, export.item, package.name, {"advice": advice}, "system", doubts)


def _is_own(view: View, package, library: str) -> bool:
    """True for the name of a library that can only be one of the package's own: CMake finds those of the system."""
    if library.startswith("boost_") or view.providers.pkgconfig(library) or view.providers.pkgconfig(f"lib{library}"):
        return False
    return all(link.item != library for target in package.build.targets for link in target.links)


def _sets(package, stem: str) -> bool:
    """True when a find_package of the package sets variables that begin with the stem."""
    for found in package.build.found:
        names = variables(found.name)
        if names is None and found.name.lower() == stem.lower():
            return True
        if names and any(
            name.startswith(stem + "_") and not name.endswith(("FOUND", "VERSION", "DIR")) for name in names
        ):
            return True
    return False


def _message_packages(view: View, package):
    """Packages of messages that the package's own are made of, and that catkin_package() does not hand on."""
    exports = [e for e in package.build.exports if view.active(e.conditions)]
    named = {e.item for e in exports if e.how in ("catkin_depends", "system_depends")}
    if any("$" in name for name in named):
        return
    reach = found_with(view, named)
    for made in package.build.generated:
        if made.how != "catkin" or not made.offered or not view.certain(made.conditions):
            continue
        for name, at in made.dependencies:
            if "$" not in name and name not in reach and name != package.name:
                reach |= {name}
                yield Diagnostic(at, name, package.name, kind="messages", doubts=(Doubt.DISTURBS,))
