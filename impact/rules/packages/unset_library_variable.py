"""unset-library-variable: a target links the variable of a library that nothing finds.

What it does
    Reports `${X_LIBRARIES}` in link_target_libraries() that no find_package or pkg_check_modules of the package sets,
    where X is a library that is known; `${QT_LIBRARIES}` of Qt 4 where a later Qt alone is found; and
    check_pkgconfig_modules() whose first argument, the prefix of its variables, is REQUIRED.

Why it breaks
    CMake takes an unknown variable as empty, and the linker misses the library.

Severity
    error where the target compiles headers of the library and nothing that is found may set the variable; warning
    otherwise.

Example
    target_link_libraries(node ${YAML_CPP_LIBRARIES})       # and no find_package(yaml-cpp REQUIRED)

Use instead
    find_package(yaml-cpp REQUIRED)

Not reported
    Variables that what is found may set, such as those of Qt and Python.
"""

import re

from ...model.cmake.names import MODULES
from ...targets.platform import strip_to_letters
from ...targets.providers.library import list_variables
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule

_LIBRARIES = re.compile(r"(.+)_(?:LIBRARIES|LIBRARY|LIBS)\Z")
# Variables that other things than a find_package of their own name set: test macros, Python, Qt, catkin itself, what
# PCL, gazebo and rviz find along.
_SET_ALONG = re.compile(
    r"(?i)(gtest|gmock|python|pythonlibs|qt|qt\d?\w*|catkin|boost\w*|rviz.*|ogre\w*|eigen\d?|opengl|gl|x11|openmp\w*|"
    r"threads|sdformat|protobuf|vtk|openssl\w*|tinyxml\d?|console_bridge|urdfdom\w*|mpi|cuda\w*|.*_cuda|dl|m|rt)\Z"
)


@rule(
    group="missing-find-package",
    texts={
        "unset": Text("`{variable}` is linked, but nothing sets it", "find_package({stem} REQUIRED)"),
        "qt": Text(
            "`{variable}` is set by find_package(Qt4) alone, and `{found}` is found",
            "link targets of Qt, such as `Qt5::Widgets`",
        ),
        "unset module": Text(
            "`{variable}` is linked, but nothing sets it", "pkg_check_modules({stem} REQUIRED {subject})"
        ),
        "prefix": Text(
            "pkg_check_modules() uses `{prefix}` as the prefix of its variables, so `{subject}` is not {prefix}",
            "pkg_check_modules({variable} {prefix} {subject})",
        ),
    },
)
def unset_library_variable(view: TargetView, package: Package):
    if package.is_ros_cmake:
        yield from _list_unset(view, package)
        yield from _list_prefixes(package)


def _list_unset(view: TargetView, package: Package):
    """`${X_LIBRARIES}` that a target links and nothing sets: the linker then misses the library."""
    build = package.build
    if build.unresolved or any("$" in f.name for f in build.found):
        return
    sought = {strip_to_letters(n) for f in build.found for n in (f.name, f.prefix) if n}
    reachable = {strip_to_letters(name) for name in view.list_transitive(f.name for f in build.found)}
    qt = {f.name for f in build.found if f.name.startswith("Qt")}
    seen = set()
    for use in build.uses:
        match = (
            _LIBRARIES.match(use.name) if use.kind == "variable" and use.context == "target_link_libraries" else None
        )
        if match is None or use.name in seen or not view.is_sure(use.conditions):
            continue
        stem = match.group(1)
        folded = strip_to_letters(stem)
        later = next((name for name in qt if name not in ("Qt", "Qt4")), "")
        if use.name == "QT_LIBRARIES" and later and qt.isdisjoint(("Qt", "Qt4")):
            seen.add(use.name)
            data = {"variable": use.name, "found": later}
            yield Diagnostic(use.at, use.name, package.name, data, "qt", (Doubt.INCOMPLETE,))
            continue
        if not folded or _SET_ALONG.match(stem) or view.is_package(stem):
            continue
        if any(folded in other or other in folded for other in (*sought, *reachable) if len(other) > 2):
            continue
        seen.add(use.name)
        module = next((m for m in (stem, f"lib{stem}") if view.providers.find_pkgconfig(m)), "")
        known = module or (stem if view.find_cmake(stem) else "")
        if not known:
            continue
        if view.unknown_contents.may_hold(package, stem):
            continue
        doubts = _collect_doubts(view, package, use.name, module, stem)
        data = {"variable": use.name, "stem": stem}
        yield Diagnostic(use.at, known, package.name, data, "unset module" if module else "unset", doubts)


def _collect_doubts(view: TargetView, package: Package, variable: str, module: str, stem: str) -> tuple[Doubt, ...]:
    """What speaks against a linker that misses the library of an empty variable."""
    providers = view.providers.find_pkgconfig(module) if module else view.find_cmake(stem)
    owners = {p.package or p.name for p in providers}
    if not _is_compiled_with(view, package, variable, stem, owners) or _sets_others(view, package):
        return (Doubt.INCOMPLETE,)
    # Where the package of another library that is found depends on this one's, it may pass it on.
    found = {p.package for f in package.build.found for p in view.find_cmake(f.name)[:1] if p.kind == "system"}
    library = providers[0].package
    return (Doubt.LUCKY,) if any(library in view.apt.list_added(name) for name in found - {library, ""}) else ()


def _sets_others(view: TargetView, package: Package) -> bool:
    """True where a library that is found may set variables of others: its configuration may look for what it needs,
    which CMake's own find modules leave to the caller."""
    return any(
        f.how == "find_package"
        and f"Find{f.name}" not in MODULES
        and not view.is_package(f.name)
        and list_variables(f.name) is None
        for f in package.build.found
    )


def _is_compiled_with(view: TargetView, package: Package, variable: str, stem: str, owners: set[str]) -> bool:
    """True when a target that links the empty variable, and nothing that could stand for it, compiles the library's
    headers."""
    for target in package.build.targets:
        items = [link.item for link in target.links if link.how == "link"]
        if f"${{{variable}}}" not in items or not view.is_sure(target.conditions):
            continue
        if any("$" not in item and strip_to_letters(stem) in strip_to_letters(item) for item in items):
            continue
        includes = (i for i in package.linked.includes if target.name in i.targets and view.is_sure(i.conditions))
        if any((p.package or p.name) in owners for i in includes for p in view.find_header(i.path)[:1]):
            return True
    return False


def _list_prefixes(package: Package):
    """pkg_check_modules(REQUIRED x): its first argument names the variables, so that x is not required."""
    for found in package.build.found:
        if found.how == "pkg_check_modules" and found.prefix in ("REQUIRED", "QUIET"):
            data = {"prefix": found.prefix, "variable": found.name.upper().replace("-", "_")}
            yield Diagnostic(found.at, found.name, package.name, data, "prefix", (Doubt.DISTURBS,))
