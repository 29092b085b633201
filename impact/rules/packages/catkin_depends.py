"""catkin-depends: catkin_package() names a package in CATKIN_DEPENDS that it refuses.

What it does
    Makes the checks of catkin_package(CATKIN_DEPENDS ...): every package of it has to be a catkin package and a run
    dependency, and a build dependency too when it is a component of find_package(catkin).

Why it breaks
    catkin_package() ends with FATAL_ERROR: nothing of the package is built, on any machine.

Severity
    error; warning where only another distro's manifest says that the package is a plain CMake one, and yet another's
    says otherwise.

Example
    catkin_package(CATKIN_DEPENDS roscpp tf)    # and package.xml has <build_depend>tf</build_depend> alone

Use instead
    <depend>tf</depend>                         # format 1: <run_depend>tf</run_depend> beside it

Not reported
    Names under a condition that is not known; packages whose build type is not known.
"""

from ...model.view import View
from ..rule import Hit, rule

_BUILD = frozenset({"build"})
_RUN = frozenset({"exec", "build_export"})


@rule(severity="error")
def catkin_depends(view: View):
    if view.target.ros != 1:
        return
    for package in view:
        build = package.build
        if build.catkin_package is None or package.build_type != "catkin":
            continue
        declared = view.declared(package)
        components = {f.name for f in build.found if f.how == "catkin" and view.certain(f.conditions)}
        told = set()
        for export in build.exports:
            name = export.item
            if export.how != "catkin_depends" or "$" in name or name in told or not view.certain(export.conditions):
                continue
            told.add(name)
            kinds = declared.get(name, set())
            plain, sure = _not_catkin(view, name)
            if plain and any(f.name == name and f.required for f in build.found):
                yield Hit(
                    export.at,
                    name,
                    f"`{name}` is in CATKIN_DEPENDS and {plain}, so catkin_package() stops",
                    f"name `{name}` in DEPENDS instead",
                    package.name,
                    severity="error" if sure else "warning",
                )
            elif not kinds & _RUN:
                yield Hit(
                    export.at,
                    name,
                    f"`{name}` is in CATKIN_DEPENDS and is no run dependency, so catkin_package() stops",
                    _cure(package, name, "run_depend", "depend" if not kinds else "exec_depend"),
                    package.name,
                )
            elif name in components and not kinds & _BUILD:
                yield Hit(
                    export.at,
                    name,
                    f"`{name}` is found, is in CATKIN_DEPENDS and is no build dependency, so catkin_package() stops",
                    _cure(package, name, "build_depend", "build_depend"),
                    package.name,
                )


def _cure(package, name: str, first: str, second: str) -> str:
    tag = first if package.manifest.format == 1 else second
    return f"add `<{tag}>{name}</{tag}>` to {package.digest.manifest_path}"


def _not_catkin(view: View, name: str) -> tuple[str, bool]:
    """Why a package is no catkin package on the target, as the end of a clause, and whether that is sure; empty when it
    is one or may be."""
    own = view.workspace.packages.get(name)
    if own is not None:
        return ("is a plain CMake package", True) if own.build_type == "cmake" else ("", False)
    if view.target.version(name) is not None:
        known = view.target.build_type(name)
        plain = (known or view.target.similar_build_type(name)) == "cmake"
        sure = bool(known) or view.target.known_build_types(name) == {"cmake"}
        return ("is a plain CMake package", sure) if plain else ("", False)
    if view.target.resolve(name) is not None and not view.underlaid:
        return "is a system library", True
    return "", False
