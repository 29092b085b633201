"""misspelt-cmake-name: the name of a package is misspelt in CMakeLists.txt.

What it does
    Reports names in find_package, catkin COMPONENTS, ament_export_dependencies, ament_target_dependencies and
    catkin_package that nobody provides and that are two known names run together, or one edit or a different case away
    from a name the package declares or finds.

Why it breaks
    An unknown package stops this build or a dependant's.

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

from ...model.cmake.links import stops_at_names
from ...model.cmake.names import MODULES
from ...model.misspelling import SpellingIndex, folded
from ...model.view import TargetView
from ...model.workspace import Package
from ..rule import Diagnostic, Doubt, Replace, Text, rule


@rule(
    texts={
        "run together": Text("`{subject}` is `{first}` and `{second}` run together", "write `{first} {second}`"),
        "near": Text("no package provides `{subject}`; `{replacement}` is declared", "write `{replacement}`"),
    },
)
def misspelt_cmake_name(view: TargetView, package: Package):
    declared = view.declared(package)
    found = {f.name for f in package.build.found}
    prefixes = {f.prefix for f in package.build.found if f.prefix}
    near = None
    for at, name, required, conditions, exported in _list_named(view, package):
        if package.name in view.workspace.find_modules.get(name, ()):
            continue
        if not view.active(conditions) or view.cmake(name) or name in declared or (name in found and not required):
            continue
        if name in prefixes or f"Find{name}" in MODULES:
            continue
        if near is None:
            near = SpellingIndex(set(declared) | {f for f in found if view.cmake(f)} | set(view.workspace.packages))
        halves = _run_together(name, near.names)
        if halves:
            sure = required or (exported and view.certain(conditions))
            data = {"first": halves[0], "second": halves[1]}
            fix = (Replace(at.path, at.line, at.column, name, " ".join(halves)),)
            yield Diagnostic(at, name, package.name, data, "run together", (sure or Doubt.OPTIONAL,), fix=fix)
            continue
        meant = near.nearest(name)
        if meant is not None and _may_install_any(view, meant, name):
            continue
        if meant is not None and meant != name and view.target.ever_released(name) is False:
            doubts = (required or Doubt.OPTIONAL, view.certain(conditions) or Doubt.CONDITIONAL)
            fix = (Replace(at.path, at.line, at.column, name, meant),)
            yield Diagnostic(at, name, package.name, {"replacement": meant}, "near", doubts, fix=fix)


def _may_install_any(view: TargetView, meant: str, name: str) -> bool:
    """Whether a released package, of which it is not known what it installs, may give a configuration this name: one
    of plain CMake, or built by what is not known (protobuf_comm installs `ProtobufComm`); of ament, a name with other
    separators (kuka_external_control_sdk installs `kuka-external-control-sdk`)."""
    if meant in view.workspace.packages or view.target.version(meant) is None or view.providers.cmake(meant):
        return False
    if view.target.build_type(meant) in ("cmake", ""):
        return True
    return view.offers.package(meant) is None and folded(meant) == folded(name)


def _list_named(view: TargetView, package: Package):
    for f in package.build.found:
        if f.how in ("find_package", "catkin") and f.name != "catkin":
            yield f.at, f.name, f.required or f.how == "catkin", f.conditions, False
    for e in package.build.exports:
        if e.how in ("ament_export_dependencies", "catkin_depends"):
            yield e.at, e.item, False, e.conditions, e.how == "ament_export_dependencies"
    for target in package.build.targets:
        for link in target.links:
            if link.how == "ament" and "$" not in link.item:
                yield link.at, link.item, stops_at_names(view), (*target.conditions, *link.conditions), False


def _run_together(name: str, names) -> tuple[str, str] | None:
    for cut in range(3, len(name) - 2):
        if name[:cut] in names and name[cut:] in names:
            return name[:cut], name[cut:]
    return None
