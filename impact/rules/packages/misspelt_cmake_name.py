"""misspelt-cmake-name: the name of a package or library is misspelt in CMakeLists.txt.

What it does
    Reports names in find_package, catkin COMPONENTS, ament_export_dependencies, ament_target_dependencies and
    catkin_package that nobody provides and that are two known names run together, or one edit or a different case away
    from a name the package declares or finds; what a target links that is one edit away from a library of the package.

Why it breaks
    An unknown package stops this build or a dependant's; the linker finds no library of an unknown name.

Severity
    error where configuration of the package itself stops, or that of whoever looks for it (exported names run
    together); warning otherwise.

Example
    ament_export_dependencies(nav2_costmap_2dnav2_util)

Use instead
    ament_export_dependencies(nav2_costmap_2d nav2_util)

Not reported
    Names that anybody is known to provide, of which CMake itself has a module, that some distro has released, or that
    no declared name resembles; names that resemble a released package of plain CMake whose configurations are not
    known.
"""

import re
from collections.abc import Iterator

from ...model.cmake.links import stops_at_names
from ...model.cmake.names import MODULES
from ...model.misspelling import SpellingIndex, fold_name, is_slip
from ..vocabulary import Diagnostic, Doubt, Package, Replace, TargetView, Text, list_place_doubts, rule
from .unresolved_names import find_intended, is_used_too, list_unknown

_PLAIN = re.compile(r"[A-Za-z_][\w.+-]+")
# Letters of a library's name: shorter ones are alike by chance.
_SHORTEST = 6


@rule(
    texts={
        "run together": Text("`{subject}` is `{first}` and `{second}` run together", "write `{first} {second}`"),
        "near": Text("no package provides `{subject}`; `{replacement}` is declared", "write `{replacement}`"),
        "declared too": Text("no package provides `{subject}`", "write `{replacement}`, here and in {manifest}"),
        "library": Text("`{target}` links `{subject}`, which is not a CMake target", "write `{replacement}`"),
    },
)
def misspelt_cmake_name(view: TargetView, package: Package):
    declared = view.collect_declared(package)
    found = {f.name for f in package.build.found}
    prefixes = {f.prefix for f in package.build.found if f.prefix}
    near = None
    for at, name, required, conditions, exported in _list_named(view, package):
        if package.name in view.workspace.find_modules.get(name, ()):
            continue
        if (
            not view.applies(conditions)
            or view.find_cmake(name)
            or (name in declared and not required)
            or (name in found and not required)
        ):
            continue
        if name in prefixes or f"Find{name}" in MODULES:
            continue
        if name in declared:
            unknown = any(one.name == name for one in list_unknown(view, package))
            intended = find_intended(view, package, name) if unknown else None
            if intended is not None and intended.kind == "near":
                doubts = (view.is_sure(conditions) or Doubt.CONDITIONAL,)
                data = {"replacement": intended.names[0], "manifest": package.linked.manifest_path}
                fix = (Replace(at.path, at.line, at.column, name, intended.names[0]),)
                yield Diagnostic(at, name, package.name, data, "declared too", doubts, fix)
            continue
        if near is None:
            near = SpellingIndex(
                set(declared) | {f for f in found if view.find_cmake(f)} | set(view.workspace.packages)
            )
        halves = _run_together(name, near.names)
        if halves:
            sure = required or (exported and view.is_sure(conditions))
            data = {"first": halves[0], "second": halves[1]}
            fix = (Replace(at.path, at.line, at.column, name, " ".join(halves)),)
            yield Diagnostic(at, name, package.name, data, "run together", (sure or Doubt.OPTIONAL,), fix=fix)
            continue
        meant = near.find_nearest(name)
        if meant is not None and (_may_install_any(view, meant, name) or is_used_too(view, package, name)):
            continue
        if meant is not None and meant != name and view.target.was_ever_released(name) is False:
            doubts = (required or Doubt.OPTIONAL, view.is_sure(conditions) or Doubt.CONDITIONAL)
            fix = (Replace(at.path, at.line, at.column, name, meant),)
            yield Diagnostic(at, name, package.name, {"replacement": meant}, "near", doubts, fix=fix)

    yield from _list_libraries(view, package)


def _list_libraries(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    """Plain names that targets link, of no target and no known library, and one letter off a library of the package."""
    targets = package.build.targets
    names = {name for target in targets for name in (target.name, target.output_name, target.export_name)}
    libraries = [target.name for target in targets if target.kind == "library" and len(target.name) >= _SHORTEST]
    found = {name for f in package.build.found for name in (f.name, f.prefix)}
    for target in targets if libraries and not package.build.unresolved else ():
        for link in target.links if target.kind in ("executable", "library", "module", "test") else ():
            name, conditions = link.item, link.conditions
            if link.how != "link" or name in names or name in found or not _PLAIN.fullmatch(name):
                continue
            meant = [library for library in libraries if is_slip(name, library)]
            if len(meant) == 1 and view.applies(conditions) and not view.find_cmake(name) and not view.is_package(name):
                data = {"target": target.name, "replacement": meant[0]}
                doubts = (not target.static or Doubt.DISTURBS, *list_place_doubts(view, "build", conditions))
                yield Diagnostic(link.at, name, package.name, data, "library", doubts)


def _may_install_any(view: TargetView, meant: str, name: str) -> bool:
    """Whether a package of which it is not known what it installs may give a configuration this name: one that the
    target is not known to have (openarm_can installs `OpenArmCAN`); of the released ones, one of plain CMake, or built
    by what is not known (protobuf_comm installs `ProtobufComm`); of ament, a name with other separators
    (kuka_external_control_sdk installs `kuka-external-control-sdk`)."""
    if meant in view.workspace.packages or view.providers.find_cmake(meant):
        return False
    if view.target.find_version(meant) is None:
        return True
    if view.target.build_type(meant) in ("cmake", ""):
        return True
    return view.offers.find_package(meant) is None and fold_name(meant) == fold_name(name)


def _list_named(view: TargetView, package: Package):
    for f in package.build.found:
        if f.how in ("find_package", "catkin") and f.name != "catkin":
            yield f.at, f.name, f.required or f.how == "catkin", f.conditions, False
    for e in package.build.exports:
        if e.how in ("ament_export_dependencies", "catkin_depends"):
            yield e.at, e.item, False, e.conditions, e.how == "ament_export_dependencies"
    for link in package.build.target_links:
        if link.how == "ament" and "$" not in link.item:
            yield link.at, link.item, stops_at_names(view), link.conditions, False


def _run_together(name: str, names) -> tuple[str, str] | None:
    for cut in range(3, len(name) - 2):
        if name[:cut] in names and name[cut:] in names:
            return name[:cut], name[cut:]
    return None
