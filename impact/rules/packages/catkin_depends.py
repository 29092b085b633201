"""catkin-depends: catkin_package() names a package in CATKIN_DEPENDS that it refuses.

What it does
    Makes the checks of catkin_package(CATKIN_DEPENDS ...): every package of it has to be a catkin package and a run
    dependency, and a build dependency too when it is a component of find_package(catkin). What a package is that is
    found after catkin_package() only, or not at all, is not looked at.

Why it breaks
    catkin_package() ends with FATAL_ERROR: nothing of the package is built, on any machine.

Severity
    error; warning where only another distro's manifest says that the package is a plain CMake one, and yet another's
    says otherwise, and where code includes headers below a folder called so, of which none is known.

Example
    catkin_package(CATKIN_DEPENDS roscpp tf)    # and package.xml has <build_depend>tf</build_depend> alone

Use instead
    <depend>tf</depend>                         # format 1: <run_depend>tf</run_depend> beside it

Not reported
    Names under a condition that is not known; packages whose build type is not known.
"""

from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule

_BUILD = frozenset({"build"})
_RUN = frozenset({"exec", "build_export"})
_STOPS = ", so catkin_package() stops"
_HELP = "add `<{tag}>{subject}</{tag}>` to {manifest}"


@rule(
    texts={
        "cmake": Text(
            f"`{{subject}}` is in CATKIN_DEPENDS but is a plain CMake package{_STOPS}",
            "name `{subject}` in DEPENDS instead",
        ),
        "system": Text(
            f"`{{subject}}` is in CATKIN_DEPENDS but is a system library{_STOPS}", "name `{subject}` in DEPENDS instead"
        ),
        "run": Text(f"`{{subject}}` is in CATKIN_DEPENDS but is not a run dependency{_STOPS}", _HELP),
        "build": Text(f"`{{subject}}` is found and is in CATKIN_DEPENDS but is not a build dependency{_STOPS}", _HELP),
    },
)
def catkin_depends(view: TargetView, package: Package):
    build = package.build
    if view.target.ros != 1 or build.catkin_package is None or package.build_type != "catkin":
        return
    declared = view.collect_declared(package)
    call = build.catkin_package
    found = [f for f in build.found if f.at.path != call.path or f.at.line < call.line]
    components = {f.name for f in found if f.how == "catkin" and view.is_sure(f.conditions)}
    old = package.manifest.format == 1
    seen = set()
    for export in build.exports:
        name = export.item
        if export.how != "catkin_depends" or "$" in name or name in seen or not view.is_sure(export.conditions):
            continue
        seen.add(name)
        kinds = declared.get(name, set())
        kind, sure = _explain_not_catkin(view, name)
        tag = "build_depend"
        if not kind or not any(f.name == name and f.required for f in found):
            sure = True
            if not kinds & _RUN:
                kind, tag = "run", "run_depend" if old else "exec_depend" if kinds else "depend"
            elif name in components and not kinds & _BUILD:
                kind = "build"
            else:
                continue
        data = {"tag": tag, "manifest": package.linked.manifest_path} if kind in ("run", "build") else {}
        yield Diagnostic(export.at, name, package.name, data, kind, (sure or Doubt.INCOMPLETE,))


def _explain_not_catkin(view: TargetView, name: str) -> tuple[str, bool]:
    """Why a package is no catkin package on the target (`cmake`, `system`), and whether that is sure; empty when it is
    one or may be."""
    own = view.workspace.packages.get(name)
    if own is not None:
        return ("cmake", True) if own.build_type == "cmake" else ("", False)
    if view.target.find_version(name) is not None:
        known = view.target.build_type(name)
        plain = (known or view.target.find_similar_build_type(name)) == "cmake"
        sure = bool(known) or view.target.list_build_types(name) == {"cmake"}
        return ("cmake", sure) if plain else ("", False)
    if view.target.resolve(name) is not None and not view.underlaid and not view.is_program(name):
        return "system", not view.means_package(name)
    return "", False
