"""nonexistent-export: a package exports an include directory, a library or a name that does not exist.

What it does
    Compares what a package exports with what is there: include directories that do not exist or whose headers no rule
    installs, libraries that no command makes or that are not installed, system libraries under a name whose variables
    nothing sets, and packages of ament_export_dependencies() that nobody has, declares or looks for.

Why it breaks
    The package's own configuration stops, or that of every package that finds it: the exported configuration names a
    library that was never built, or finds a package that nobody has.

Severity
    error where the package's own configuration stops (an include directory that does not exist), for a library of its
    own that catkin_package() exports and no command makes, and for a library that is exported and not installed;
    warning where dependants are not linked to it, for headers that are not installed, a package that nobody has, or a
    misspelt name in DEPENDS; note for other names in DEPENDS.

Example
    ament_export_libraries(arm_control)         # and no add_library(arm_control ...)

Use instead
    ament_export_libraries(arm_controller)

Not reported
    Libraries of the system; names that are not known; packages whose CMake code cannot be read in full; headers that no
    rule installs where the package offers no library and nobody in the workspace includes them.
"""

import posixpath
import re
from collections.abc import Iterator

from ...model.misspelling import SpellingIndex
from ...targets.providers.library import list_variables
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule
from .absent_paths import is_absent
from .ament_exports import read_ament_exports
from .install_rules import is_installed

_UNSET = "nothing sets `{subject}_INCLUDE_DIRS` or `{subject}_LIBRARIES`, so DEPENDS exports nothing"


@rule(
    group="missing-export",
    texts={
        "directory": Text(
            "the exported include directory `{directory}` does not exist, so catkin stops",
            "create it, or drop INCLUDE_DIRS",
        ),
        "no header": Text(
            "`{directory}` is exported as include directory, but its headers are not installed",
            "install(DIRECTORY {directory}/ DESTINATION {place})",
        ),
        "no target": Text(
            "the exported library `{subject}` is not a target of `{package}`", "export the library's target name"
        ),
        "program": Text(
            "`{subject}` is exported as library but is a program, so find_package({package}) stops",
            "leave it out of LIBRARIES",
        ),
        "system": Text(_UNSET, "find `{subject}` first"),
        "system, other name": Text(_UNSET, "write `{replacement}`"),
        "not installed": Text(
            "the exported library `{subject}` is not installed, so find_package({package}) stops",
            "add it to install(TARGETS ...)",
        ),
        "not built": Text(
            "the exported library `{subject}` is never built, so dependants are not linked to it",
            "export what the package builds, or drop it",
        ),
        "no package": Text(
            "package `{subject}` is neither known nor declared, so find_package({package}) stops",
            "leave it out of ament_export_dependencies",
        ),
    },
)
def nonexistent_export(view: TargetView, package: Package):
    if package.build.catkin_package is not None:
        yield from _list_directories(view, package)
        yield from _list_without_headers(view, package)
        yield from _list_of_catkin(view, package)
    ament = read_ament_exports(view, package)
    if ament is not None:
        yield from _list_without_headers(view, package)
        yield from _list_of_ament(view, package, ament.exports)
        yield from _list_unknown_packages(view, package, ament.dependencies)


def _list_directories(view: TargetView, package: Package):
    made = {posixpath.normpath(i.destination) for i in package.build.installs}
    for export in package.build.exports:
        if export.how != "include_dirs" or "$" in export.item or not view.is_sure(export.conditions):
            continue
        if export.item.startswith("/") or export.item in made:
            continue
        item = posixpath.normpath(export.item)
        inside = package.strip_path(item) if package.path and item.startswith(package.path + "/") else item
        path = posixpath.normpath(posixpath.join(package.path, inside))
        if inside.startswith("..") or not is_absent(view, package, path):
            continue
        yield Diagnostic(export.at, "INCLUDE_DIRS", package.name, {"directory": inside}, "directory")


# The exports of libraries to link.
_OF_LIBRARIES = frozenset({"ament_export_libraries", "libraries"})


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
        yield Diagnostic(export.at, data["directory"], package.name, data, "no header", (Doubt.DISTURBS,))


def _list_of_catkin(view: TargetView, package: Package):
    targets = {name: t for t in package.build.targets for name in (t.output_name, t.name)}
    found = {f.name for f in package.build.found} | {f.prefix for f in package.build.found}
    installed = {posixpath.basename(item) for install in package.build.installs for item in install.items}
    for export in package.build.exports:
        if "$" in export.item:
            continue
        target = targets.get(export.item)
        if export.how == "libraries" and target is not None:
            if target.kind == "executable" and target.name == export.item and view.is_sure(export.conditions):
                yield Diagnostic(export.at, export.item, package.name, kind="program", doubts=(Doubt.DISTURBS,))
        elif export.how == "libraries" and not package.build.unresolved:
            if (
                "/" in export.item
                or export.item.startswith("-")
                or export.item.endswith((".so", ".a"))
                or (view.find_cmake(export.item) and export.item != package.name)
                or not installed.isdisjoint((f"lib{export.item}.so", f"lib{export.item}.a"))  # built elsewhere
            ):
                continue
            # Some export their own name by habit, and nobody asks for it.
            asked = export.item != package.name
            sure = asked and view.is_sure(export.conditions) and _is_own(view, package, export.item)
            doubts = () if sure else (Doubt.AMBIGUOUS,)
            yield Diagnostic(export.at, export.item, package.name, kind="no target", doubts=doubts)
        elif export.how == "system_depends" and export.item not in found and not _sets(package, export.item):
            near = next((f for f in found if f and f.lower().rstrip("3") == export.item.lower().rstrip("3")), None)
            other = near.upper() if near == "Eigen3" else near
            kind = "system, other name" if near else "system"
            doubts = (Doubt.DISTURBS,) if near else (Doubt.DISPENSABLE,)
            yield Diagnostic(export.at, export.item, package.name, {"replacement": other or ""}, kind, doubts)


def _is_own(view: TargetView, package: Package, library: str) -> bool:
    """True for the name of a library that can only be one of the package's own: CMake finds those of the system."""
    if library.startswith("boost_") or any(map(view.providers.find_pkgconfig, (library, f"lib{library}"))):
        return False
    return all(link.item != library for link in package.build.target_links)


def _sets(package: Package, stem: str) -> bool:
    """True when a find_package of the package sets variables that begin with the stem."""
    for found in package.build.found:
        names = list_variables(found.name)
        if names is None and found.name.lower() == stem.lower():
            return True
        if names and any(
            name.startswith(stem + "_") and not name.endswith(("FOUND", "VERSION", "DIR")) for name in names
        ):
            return True
    return False


def _list_of_ament(view: TargetView, package: Package, exports) -> Iterator[Diagnostic]:
    """ament_export_libraries() of what no target makes, of which dependants are only warned, or of a target that is not
    installed, at which they stop."""
    targets = {t.name: t for t in package.build.targets if t.kind != "unknown"}
    names = {*targets, *(t.output_name for t in targets.values())}
    installed = package.build.installed_targets
    if package.build.unresolved or any("$" in name for name in (*names, *installed)):
        return
    if package.build.builds_others:
        return  # another build system makes libraries of its own
    for export in exports:
        item = export.item
        if export.how != "ament_export_libraries" or re.search(r"[$/.:]|^-", item):
            continue
        if not view.is_sure(export.conditions):
            continue
        target = targets.get(item)
        if target is not None and target.kind == "library" and item not in installed and not target.alias_of:
            yield Diagnostic(export.at, item, package.name, kind="not installed")
        elif item not in names and (not view.find_cmake(item) or item == package.name):
            yield Diagnostic(export.at, item, package.name, kind="not built", doubts=(Doubt.DISTURBS,))


def _list_unknown_packages(view: TargetView, package: Package, dependencies: frozenset[str]) -> Iterator[Diagnostic]:
    """Packages that dependants look for and nothing else speaks of."""
    if package.build.unresolved:
        return
    known = {package.name, *view.collect_declared(package), *(f.name for f in package.build.found)}
    known |= {*view.workspace.find_modules, *(i for r in package.build.installs if r.kind == "export" for i in r.items)}
    near = SpellingIndex(known)
    for name in sorted(dependencies - known):
        if view.is_package(name) or view.find_cmake(name) or view.is_private(name) or view.target.knows_key(name):
            continue  # what has the name of a system package may bring it
        if near.find_nearest(name) or any(name.startswith(first) and name[len(first) :] in known for first in known):
            continue  # misspelt-cmake-name says it
        export = next(e for e in package.build.exports if e.item == name and e.how == "ament_export_dependencies")
        if view.is_sure(export.conditions):
            yield Diagnostic(export.at, name, package.name, kind="no package", doubts=(Doubt.DISTURBS,))
