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

import re

from ...model.misspelling import Names, one_edit
from ...model.view import View
from ...targets.providers.library import not_answering, variables
from ..fix_actions import Replace
from ..rule import Diagnostic, rule
from ..severity import Doubt
from ..text import Text

_WRITE = "write `{replacement}`"
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


@rule(
    scope="target",
    severity="error",
    texts={
        "run together": Text("`{subject}` is `{first}` and `{second}` run together", "write `{first} {second}`"),
        "near": Text("no package provides `{subject}`; `{replacement}` is declared", _WRITE),
        "case": Text("CMake package `{subject}` not found: names are case-sensitive", "did you mean `{replacement}`?"),
        "case since": Text(
            "CMake package `{subject}` not found: {replacement} {version} has `{replacement}Config.cmake`, and names "
            "are case-sensitive",
            _WRITE,
        ),
        "variable": Text("nothing sets `{subject}`; find_package({found}) is called", _WRITE),
        "other variable": Text("find_package({found}) sets `{variable}`, so `{subject}` is empty", _WRITE),
    },
)
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
                sure = required or (exported and view.certain(conditions))
                data = {"first": halves[0], "second": halves[1]}
                fix = (Replace(at.path, at.line, at.column, name, " ".join(halves)),)
                yield Diagnostic(at, name, package.name, data, "run together", (sure or Doubt.OPTIONAL,), fix=fix)
                continue
            meant = near.nearest(name) if exact else None
            if meant is not None and meant != name and view.target.ever_released(name) is False:
                doubts = (required or Doubt.OPTIONAL, view.certain(conditions) or Doubt.CONDITIONAL)
                fix = (Replace(at.path, at.line, at.column, name, meant),)
                yield Diagnostic(at, name, package.name, {"replacement": meant}, "near", doubts, fix=fix)
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
        fix = (Replace(f.at.path, f.at.line, f.at.column, f.name, meant[0]),)
        doubts = (sure or Doubt.INCOMPLETE,)
        yield Diagnostic(f.at, f.name, package.name, {"replacement": meant[0]}, "case", doubts, fix=fix)


def _case_that_matters_now(view: View, package):
    """find_package names to which the target's version of a library answers no longer, where the build needs them."""
    linked = {link.item for target in package.build.targets for link in target.links if link.how == "ament"}
    for f in package.build.found:
        if f.how != "find_package" or f.via or not (f.required or f.name in linked) or not view.active(f.conditions):
            continue
        version = not_answering(view.target, f.name)
        if not version or f"Find{f.name}.cmake" in view.workspace.cmake_files:
            continue
        data = {"replacement": f.name.lower(), "version": version}
        doubts = (f.required or Doubt.OPTIONAL, view.certain(f.conditions) or Doubt.CONDITIONAL)
        yield Diagnostic(f.at, f.name, package.name, data, "case since", doubts)


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


def _is_slip(stem: str, name: str) -> bool:
    """True when the stem of a variable is a letter or an underscore away from a package's name; a library's variables
    often have another number or other separators in them than its name."""
    letters = re.sub(r"[\W_\d]", "", name)
    return (
        len(letters) > 4
        and one_edit(stem, name)
        and stem.lower() != name.lower()
        and re.sub(r"\D", "", stem) == re.sub(r"\D", "", name)
        and (len(stem) > len(name) or re.sub(r"[\W_]", "", stem) != re.sub(r"[\W_]", "", name))
    )


def _set_by_hand(package) -> set[str]:
    """Variables that calls other than find_package() name the beginning of."""
    return {f"{f.prefix}{suffix}" for f in package.build.found if f.prefix for suffix in _SUFFIXES}


def _variables(view: View, package, found):
    """Variables that only differ in case from what a find_package of the package sets."""
    folded = {name.lower(): name for name in found}
    seen = set()
    for use in package.build.uses:
        if use.name in seen or use.kind != "variable" or not view.active(use.conditions):
            continue
        for suffix in _SUFFIXES:
            if use.name.endswith(suffix):
                stem = use.name[: -len(suffix)]
                break
        else:
            continue
        meant = next((name for name in found if name.isidentifier() and _is_slip(stem, name)), None)
        if meant is not None and not view.cmake(stem) and use.name not in _set_by_hand(package):
            seen.add(use.name)
            yield _diagnose_variable(package, use, meant, f"{meant}{suffix}", "variable")
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
            seen.add(use.name)
            if use.name in _set_by_hand(package):
                continue
            yield _diagnose_variable(package, use, meant, right, "other variable")


def _diagnose_variable(package, use, found: str, variable: str, kind: str) -> Diagnostic:
    """That a variable is empty, where another one that a find_package() sets was meant."""
    new = f"${{{variable}}}"
    fix = (Replace(use.at.path, use.at.line, use.at.column, f"${{{use.name}}}", new),)
    data = {"found": found, "variable": variable, "replacement": new}
    return Diagnostic(use.at, use.name, package.name, data, kind, (Doubt.INCOMPLETE,), fix=fix)
