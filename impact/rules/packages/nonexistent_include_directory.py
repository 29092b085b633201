"""nonexistent-include-directory: a package exports an include directory that does not exist, or is not installed.

What it does
    Reports include directories of catkin_package() that do not exist, and exported ones whose headers no rule installs.

Why it breaks
    catkin_package() stops at a folder that does not exist. Where headers are not installed, dependants stop at them.

Severity
    error where the folder does not exist; warning where its headers are not installed; of that, note in
    ROS 1 where the distro has ended, since nothing is released into it any more.

Example
    ament_export_include_directories(include)   # and no rule installs its headers

Use instead
    install(DIRECTORY include/ DESTINATION include)

Not reported
    Headers that no rule installs where the package offers no library and nobody in the workspace includes them.
"""

import posixpath
from collections.abc import Iterator

from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule
from .absent_paths import is_absent
from .ament_exports import read_ament_exports
from .install_rules import is_installed, list_install_doubts

# The exports of libraries to link.
_OF_LIBRARIES = frozenset({"ament_export_libraries", "libraries"})


@rule(
    group="nonexistent-export",
    texts={
        "directory": Text(
            "the exported include directory `{directory}` does not exist, so catkin stops",
            "create it, or drop INCLUDE_DIRS",
        ),
        "no header": Text(
            "`{directory}` is exported as include directory, but its headers are not installed",
            "install(DIRECTORY {directory}/ DESTINATION {place})",
        ),
    },
)
def nonexistent_include_directory(view: TargetView, package: Package):
    of_catkin = package.build.catkin_package is not None
    if of_catkin:
        yield from _list_directories(view, package)
    if of_catkin or read_ament_exports(view, package) is not None:
        yield from _list_without_headers(view, package)


def _list_directories(view: TargetView, package: Package):
    made = {posixpath.normpath(i.destination) for i in package.build.installs}
    for export in package.build.exports:
        if export.how != "include_dirs" or "$" in export.item or not view.is_sure(export.conditions):
            continue
        if export.item.startswith("/") or export.item in made:
            continue
        item = posixpath.normpath(export.item)
        if package.path and not item.startswith(f"{package.path}/"):
            continue  # of another folder of the workspace, or outside of it
        if not item.startswith("..") and is_absent(view, package, item):
            data = {"directory": package.strip_path(item)}
            yield Diagnostic(export.at, "INCLUDE_DIRS", package.name, data, "directory")


def _list_without_headers(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    """Include directories of the source space that have headers, none of which an install rule takes."""
    installs = package.build.installs
    exports = [e for e in package.build.exports if view.is_sure(e.conditions)]
    libraries = {t.name for t in package.build.targets if t.kind == "library"} & package.build.installed_targets
    offers = any(e.how in _OF_LIBRARIES and e.item in libraries for e in exports)
    if not offers and package.name not in view.workspace.includers:
        return  # nobody uses the headers
    if package.build.unresolved or any("$" in item for i in installs for item in i.items):
        return
    catkin = package.build_type == "catkin"
    for export in exports:
        folder = "$"
        if export.how == "include_dirs":
            folder = posixpath.normpath(export.item)
        elif export.how == "ament_export_include_directories" and posixpath.normpath(export.item) == "include":
            folder = posixpath.join(package.path, "include")
        headers = [path for path in package.linked.headers if path.startswith(f"{folder}/")]
        if not headers or any(is_installed(installs, path) for path in headers):
            continue
        place = "${CATKIN_GLOBAL_INCLUDE_DESTINATION}" if catkin else "include"
        data = {"directory": package.strip_path(folder), "place": place}
        doubts = (Doubt.DISTURBS, *list_install_doubts(view, package))
        yield Diagnostic(export.at, data["directory"], package.name, data, "no header", doubts)
