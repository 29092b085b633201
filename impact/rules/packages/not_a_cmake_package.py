"""not-a-cmake-package: find_package() is given the name of a target or of a Debian package.

What it does
    Reports find_package() of an imported target (`a::b`), and of a package of Debian (`liba-dev`) that is not known to
    have a configuration of this name.

Why it breaks
    CMake does not find it, since no configuration file has such a name.

Severity
    error where it is REQUIRED and CMake always reaches the place; warning otherwise.

Example
    find_package(MANIF::manif REQUIRED)

Use instead
    find_package(manif REQUIRED)

Not reported
    Names for which the workspace has a find module.
"""

from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, list_place_doubts, rule


@rule(
    group="refused-cmake-name",
    texts={
        "target": Text(
            "`{subject}` is a target, not a package", "call find_package() with the package that defines the target"
        ),
        "debian": Text(
            "`{subject}` is a package of Debian, not a CMake package",
            "declare it in package.xml, and call find_package() with the name of its CMake configuration",
        ),
    },
)
def not_a_cmake_package(view: TargetView, package: Package):
    for found in package.build.found:
        if found.how not in ("find_package", "catkin"):
            continue
        kind = "target" if "::" in found.name else "debian" if _is_of_debian(view, package, found.name) else ""
        if kind:
            doubts = (*list_place_doubts(view, "build", found.conditions), found.required or Doubt.OPTIONAL)
            yield Diagnostic(found.at, found.name, package.name, kind=kind, doubts=doubts)


def _is_of_debian(view: TargetView, package: Package, name: str) -> bool:
    """Whether a name is that of a Debian package which is not known to have a configuration of this name."""
    if not (name.endswith("-dev") or name.startswith("python3-")) or name in view.workspace.find_modules:
        return False
    known = view.target.knows_key(name) or view.providers.knows_system((name,))
    return known and not view.find_cmake(name) and not view.is_package(name) and not package.build.unresolved
