"""misspelt-cmake-name: a name given to CMake is a slip away from the one that was meant.

What it does
    Reports names in find_package, catkin COMPONENTS, ament_export_dependencies, ament_target_dependencies and
    catkin_package that nobody provides and that are two known names run together, or one edit or a different case away
    from a name the package declares or finds; names in find_package that are known in another case alone, in general or
    with the target's version of a library; and variables such as `Eigen3_INCLUDE_DIR` that no find module sets, one
    edit or case away from one that is.

Why it breaks
    CMake takes an unknown variable as empty and says nothing; an unknown package stops this build or a dependant's.

Severity
    error where configuration of the package itself stops, or that of whoever looks for it (exported names run
    together); warning otherwise.

Example
    ament_export_dependencies(nav2_costmap_2dnav2_util)

Use instead
    ament_export_dependencies(nav2_costmap_2d nav2_util)

Not reported
    Names that anybody is known to provide, that some distro has released, or that no declared name resembles.
"""

from ...model.misspelling import Names
from ...model.view import View
from ...targets.providers.library import not_answering, variables
from ..fix_actions import Replace
from ..rule import Hit, rule

_SUFFIXES = (
    "_INCLUDE_DIRS",
    "_INCLUDE_DIR",
    "_LIBRARIES",
    "_LIBRARY",
    "_LIBS",
    "_EXPORTED_TARGETS",
    "_DEFINITIONS",
    "_VERSION",
)


@rule(severity="warning")
def misspelt_cmake_name(view: View):
    for package in view:
        declared = view.declared(package)
        found = {f.name for f in package.build.found}
        near = None
        for at, name, required, conditions, exact, exported in _named(package):
            if package.name in view.workspace.find_modules.get(name, ()):
                continue
            if not view.active(conditions) or view.cmake(name) or name in declared or (name in found and not required):
                continue
            if near is None:
                near = Names(set(declared) | {f for f in found if view.cmake(f)} | set(view.workspace.packages))
            halves = _run_together(name, near.names)
            if halves:
                yield Hit(
                    at,
                    name,
                    f"`{name}` is `{halves[0]}` and `{halves[1]}` run together",
                    f"write `{halves[0]} {halves[1]}`",
                    package.name,
                    severity="error" if required or (exported and view.certain(conditions)) else "warning",
                    fix=(Replace(at.path, at.line, at.column, name, " ".join(halves)),),
                )
                continue
            meant = near.nearest(name) if exact else None
            if meant is not None and meant != name and view.target.ever_released(name) is False:
                yield Hit(
                    at,
                    name,
                    f"nobody provides `{name}`; `{meant}` is declared",
                    f"write `{meant}`",
                    package.name,
                    severity="error" if required and view.certain(conditions) else "warning",
                    fix=(Replace(at.path, at.line, at.column, name, meant),),
                )
        yield from _wrong_case(view, package)
        yield from _case_that_matters_now(view, package)
        yield from _variables(view, package, found)


def _wrong_case(view: View, package):
    """find_package names that are known in another case alone: CMake looks for files of this very name."""
    own = view.workspace.cmake_files
    for f in package.build.found:
        if f.how != "find_package" or not f.required or not view.certain(f.conditions) or view.is_package(f.name):
            continue
        if f.name.islower():
            continue  # `x-config.cmake` answers to it, which no list of files need show
        if {f"Find{f.name}.cmake", f"{f.name}Config.cmake"} & own or any(p.sure for p in view.cmake(f.name)):
            continue
        meant = [n for n in view.providers.spellings(f.name) if n != f.name]
        if len(meant) != 1 or not view.cmake(f.name) or meant[0] == f.name.lower():
            continue
        # Whoever brings the module along under the other name means that one, whatever the platform has.
        sure = f"Find{meant[0]}.cmake" in own or view.target.platform in view.providers.platforms
        yield Hit(
            f.at,
            f.name,
            f"nobody provides `{f.name}`; CMake minds the case of `{meant[0]}`",
            f"write `{meant[0]}`",
            package.name,
            severity="error" if sure else "warning",
            fix=(Replace(f.at.path, f.at.line, f.at.column, f.name, meant[0]),),
        )


def _case_that_matters_now(view: View, package):
    """find_package names to which the target's version of a library answers no longer, where the build needs them."""
    linked = {link.item for target in package.build.targets for link in target.links if link.how == "ament"}
    for f in package.build.found:
        if f.how != "find_package" or f.via or not (f.required or f.name in linked) or not view.active(f.conditions):
            continue
        version = not_answering(view.target, f.name)
        if not version or f"Find{f.name}.cmake" in view.workspace.cmake_files:
            continue
        meant = f.name.lower()
        yield Hit(
            f.at,
            f.name,
            f"`{f.name}` is not found: {meant} {version} has `{meant}Config.cmake`, which minds the case",
            f"write `{meant}`",
            package.name,
            severity="error" if f.required and view.certain(f.conditions) else "warning",
        )


def _named(package):
    for f in package.build.found:
        if f.how in ("find_package", "catkin") and f.name != "catkin":
            yield f.at, f.name, f.required or f.how == "catkin", f.conditions, True, False
    for e in package.build.exports:
        if e.how in ("ament_export_dependencies", "catkin_depends"):
            yield e.at, e.item, False, e.conditions, True, e.how == "ament_export_dependencies"
    for target in package.build.targets:
        for link in target.links:
            if link.how == "ament" and "$" not in link.item:
                yield link.at, link.item, False, link.conditions, False, False


def _run_together(name: str, names) -> tuple[str, str] | None:
    for cut in range(3, len(name) - 2):
        if name[:cut] in names and name[cut:] in names:
            return name[:cut], name[cut:]
    return None


def _variables(view: View, package, found):
    """Variables that only differ in case from what a find_package of the package sets."""
    folded = {name.lower(): name for name in found}
    told = set()
    for use in package.build.uses:
        if use.name in told or use.kind != "variable" or not view.active(use.conditions):
            continue
        for suffix in _SUFFIXES:
            if use.name.endswith(suffix):
                stem = use.name[: -len(suffix)]
                break
        else:
            continue
        if stem.lower() not in folded or (stem in found and variables(stem) is None):
            continue
        meant = folded[stem.lower()]
        sets = variables(meant)
        if meant == "Eigen3" and "eigen3_cmake_module" in found:
            continue  # it sets the variables in both spellings
        if sets is None or use.name in sets:
            continue
        right = next((v for v in sorted(sets) if v.endswith(suffix)), None)
        if right is None:
            right = next(
                (v for v in sorted(sets) if v.lower() == use.name.lower() or v.lower() == use.name.lower() + "s"), None
            )
        if right is not None:
            told.add(use.name)
            if any(use.name == f"{f.prefix}{suffix}" for f in package.build.found if f.prefix):
                continue
            yield Hit(
                use.at,
                use.name,
                f"find_package({meant}) sets `{right}`, so `{use.name}` is empty",
                f"write `${{{right}}}`",
                package.name,
                fix=(Replace(use.at.path, use.at.line, use.at.column, f"${{{use.name}}}", f"${{{right}}}"),),
            )
