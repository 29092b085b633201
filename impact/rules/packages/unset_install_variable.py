"""unset-install-variable: install() uses a variable of catkin that is not set there.

What it does
    Reports variables of catkin for places (`CATKIN_..._DESTINATION`, `..._PREFIX`, `..._DIR`) that are misspelt, were
    removed in Groovy, or are used where catkin_package(), which sets them, is called later or never.

Why it breaks
    An empty variable before a path puts the files into a wrong place; CMake stops at a rule whose whole destination is
    empty.

Example
    install(DIRECTORY launch DESTINATION ${CATKIN_PACKAGE_LAUNCH_DESTINATION})

Use instead
    install(DIRECTORY launch DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION}/launch)

Not reported
    Variables that another package may set whose CMake code is not known; rules under a condition that is unknown on the
    target.
"""

from ..vocabulary import Diagnostic, Package, TargetView, Text, rule
from .install_rules import read_installs

# What catkin itself sets that may name a place (catkin's all.cmake and catkin_package.cmake).
_PLACES = frozenset({"CATKIN_DEVEL_PREFIX", "CATKIN_TEST_RESULTS_DIR", "CATKIN_ENV"})
# What catkin_package() sets of them.
_OF_CATKIN_PACKAGE = frozenset(
    f"CATKIN_PACKAGE_{name}_DESTINATION" for name in ("BIN", "ETC", "INCLUDE", "LIB", "PYTHON", "SHARE")
)
_UNSET = "nothing sets `{subject}`, so files are looked for, or installed, in a wrong place"


@rule(
    group="nonexistent-install",
    texts={
        "early": Text("`{subject}` is used before catkin_package() sets it", "call catkin_package() before install()"),
        "never": Text("`{subject}` is set by catkin_package(), which is never called", "call catkin_package()"),
        "unset": Text(_UNSET, "correct the variable's name"),
        "unset, build": Text(_UNSET, "write `${{CATKIN_DEVEL_PREFIX}}`"),
    },
)
def unset_install_variable(view: TargetView, package: Package):
    build = package.build
    if read_installs(view, package) is None or package.build_type != "catkin" or package.name == "catkin":
        return
    unknown = any(use.kind == "command" and not use.context for use in build.uses)
    seen = set()
    for use in build.uses:
        if use.kind != "variable" or use.context != "install" or use.name in (*seen, *_PLACES):
            continue
        if not use.name.startswith("CATKIN_") or not use.name.endswith(("_PREFIX", "_DESTINATION", "_DIR")):
            continue
        if not view.is_sure(use.conditions):
            continue
        kind = "unset, build" if use.name == "CATKIN_BUILD_PREFIX" else "unset"
        if use.name in _OF_CATKIN_PACKAGE:
            if build.catkin_package is None and (build.unresolved or unknown):
                continue  # a command that is not known may call it
            kind = "early" if build.catkin_package else "never"
        if kind == "unset" and _may_be_set(view, package):
            continue
        seen.add(use.name)
        yield Diagnostic(use.at, use.name, package.name, kind=kind)


def _may_be_set(view: TargetView, package: Package) -> bool:
    """Whether a package whose CMake is not known may set variables of its own that are called as catkin's are."""
    others = {found.name for found in package.build.found} - {"catkin"} - view.workspace.packages.keys()
    return any(view.offers.find_package(name) is None for name in others if view.is_package(name))
