"""nonexistent-export: a package exports a library or a name that does not exist.

What it does
    Compares what a package exports with what is there: libraries that no command makes or that are not installed,
    system libraries under a name whose variables nothing sets, and in ament_export_dependencies() targets, and packages
    that nobody has, declares or looks for.

Why it breaks
    Every package that finds it stops: the exported configuration names a library that was never built, or finds a
    package that nobody has.

Severity
    error for a library of its own that catkin_package() exports and no command makes, for a library that is exported
    and not installed, and for targets among dependencies where another package of the workspace finds this one;
    warning for other such targets, where dependants are not linked to a library, for a package that nobody has, or a
    misspelt name in DEPENDS; note for other names in DEPENDS, and for the own name of a package that makes no library.

Example
    ament_export_libraries(arm_control)         # and no add_library(arm_control ...)

Use instead
    ament_export_libraries(arm_controller)

Not reported
    Libraries of the system and of other packages; names that are not known; packages whose CMake code cannot be read in
    full.
"""

import posixpath
import re
from collections.abc import Iterator

from ...model.misspelling import SpellingIndex
from ...targets.machine.sonames import load_sonames
from ...targets.providers.library import sets_variables
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Together, rule
from .ament_exports import read_ament_exports
from .dependants import is_surely_found_elsewhere

_TARGETS = (Together("targets as packages"),)
_UNSET = "nothing sets `{subject}_INCLUDE_DIRS` or `{subject}_LIBRARIES`, so DEPENDS exports nothing"


@rule(
    group="missing-export",
    texts={
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
        "target": Text(
            "ament_export_dependencies() is given the target `{subject}`, so find_package({package}) stops",
            "name the package that has it instead",
        ),
        "no package": Text(
            "package `{subject}` is neither known nor declared, so find_package({package}) stops",
            "leave it out of ament_export_dependencies",
        ),
    },
)
def nonexistent_export(view: TargetView, package: Package):
    if package.build.catkin_package is not None:
        yield from _list_of_catkin(view, package)
    yield from _list_targets_as_packages(view, package)
    if ament := read_ament_exports(view, package):
        yield from _list_of_ament(view, package, ament.exports)
        yield from _list_unknown_packages(view, package, ament.dependencies)


def _list_of_catkin(view: TargetView, package: Package):
    targets = {name: t for t in package.build.targets for name in (t.output_name, t.name)}
    names = {f.name for f in package.build.found}
    found = names | {f.prefix for f in package.build.found}
    installs = (item for install in package.build.installs for item in install.items)
    made = {posixpath.basename(item) for item in (*installs, *package.build.made)}
    # A package without libraries and messages gives nothing for which others would find it.
    libraries = any(target.kind == "library" for target in package.build.targets)
    messages = any(generated.how != "reconfigure" for generated in package.build.generated)
    wanted = libraries or messages or package.name in view.workspace.includers
    for export in (export for export in package.build.exports if "$" not in export.item):
        item, target = export.item, targets.get(export.item)
        if export.how == "libraries" and target is not None:
            if target.kind == "executable" and target.name == item and view.is_sure(export.conditions):
                yield Diagnostic(export.at, item, package.name, kind="program", doubts=(Doubt.DISTURBS,))
        elif export.how == "libraries" and not package.build.unresolved:
            asked = item != package.name  # some export their own name by habit, and nobody asks for it
            outside = re.search(r"/|^-|\.(?:so|a)\Z", item) or (asked and view.find_cmake(item))
            outside = outside or (asked and _is_elsewhere(view, item))
            if not outside and made.isdisjoint((f"lib{item}.so", f"lib{item}.a")):  # of which no target is known
                own = asked and all(link.item != item for link in package.build.target_links)
                own = own and not view.unknown_contents.may_hold(package, item)
                sure = own and view.is_sure(export.conditions)
                doubts = (sure or Doubt.AMBIGUOUS, asked or wanted or Doubt.DISPENSABLE)
                yield Diagnostic(export.at, item, package.name, kind="no target", doubts=doubts)
        elif export.how == "system_depends" and item not in found and not any(sets_variables(f, item) for f in names):
            near = next((f for f in found if f and f.lower().rstrip("3") == item.lower().rstrip("3")), "")
            data = {"replacement": "EIGEN3" if near == "Eigen3" else near}
            kind, doubt = ("system, other name", Doubt.DISTURBS) if near else ("system", Doubt.DISPENSABLE)
            yield Diagnostic(export.at, item, package.name, data, kind, (doubt,))


def _is_elsewhere(view: TargetView, library: str) -> bool:
    """Whether the system or another package has a library of a name: CMake looks in all their folders for what
    catkin_package() is given."""
    if library.startswith("boost_") or any(map(view.providers.find_pkgconfig, (library, f"lib{library}"))):
        return True
    others = (target for other in view.workspace.packages.values() for target in other.build.targets)
    if any(target.kind == "library" and library in (target.name, target.output_name) for target in others):
        return True
    return load_sonames().has_stem(library) or bool(view.offers.list_library_owners(library))


def _list_of_ament(view: TargetView, package: Package, exports) -> Iterator[Diagnostic]:
    """ament_export_libraries() of what no target makes, of which dependants are only warned, or of a target that is not
    installed, at which they stop."""
    targets = {t.name: t for t in package.build.targets if t.kind != "unknown"}
    names = {*targets, *(t.output_name for t in targets.values())}
    installed = package.build.installed_targets
    unknown = package.build.unresolved or any("$" in name for name in (*names, *installed))
    if unknown or package.build.builds_others:  # another build system makes libraries of its own
        return
    for export in (e for e in exports if e.how == "ament_export_libraries" and view.is_sure(e.conditions)):
        item, target = export.item, targets.get(export.item)
        if re.search(r"[$/.:]|^-", item) or (package.build.generated and "__rosidl_" in item):
            continue  # the generator of interfaces makes libraries of its own
        if target is not None and target.kind == "library" and item not in installed and not target.alias_of:
            yield Diagnostic(export.at, item, package.name, kind="not installed")
        elif item not in names and (not view.find_cmake(item) or item == package.name):
            # Some export their own name by habit: of a package that makes no library at all, nobody wants to link one.
            linked = item != package.name or package.name in view.workspace.includers
            linked = linked or any(t.kind == "library" for t in targets.values())
            doubts = (Doubt.DISTURBS, linked or Doubt.DISPENSABLE)
            yield Diagnostic(export.at, item, package.name, kind="not built", doubts=doubts)


def _list_targets_as_packages(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    """Targets among the packages that dependants are to find."""
    for export in package.build.exports:
        if export.how == "ament_export_dependencies" and "::" in export.item and view.is_sure(export.conditions):
            doubts = (is_surely_found_elsewhere(view, package) or Doubt.DISTURBS,)
            yield Diagnostic(export.at, export.item, package.name, {}, "target", doubts, together=_TARGETS)


def _list_unknown_packages(view: TargetView, package: Package, dependencies: frozenset[str]) -> Iterator[Diagnostic]:
    """Packages that dependants look for and nothing else speaks of."""
    if package.build.unresolved:
        return
    known = {package.name, *view.collect_declared(package), *(f.name for f in package.build.found)}
    known |= {*view.workspace.find_modules, *(i for r in package.build.installs if r.kind == "export" for i in r.items)}
    near = SpellingIndex(known)
    for name in sorted(name for name in dependencies - known if "::" not in name):
        if view.is_package(name) or view.find_cmake(name) or view.is_private(name) or view.target.knows_key(name):
            continue  # what has the name of a system package may bring it
        if near.find_nearest(name) or any(name.startswith(first) and name[len(first) :] in known for first in known):
            continue  # misspelt-cmake-name says it
        export = next(e for e in package.build.exports if e.item == name and e.how == "ament_export_dependencies")
        if view.is_sure(export.conditions):
            yield Diagnostic(export.at, name, package.name, kind="no package", doubts=(Doubt.DISTURBS,))
