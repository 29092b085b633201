"""unused-dependency: nothing in a package uses a declared dependency.

What it does
    Reports build and run dependencies for which no find_package, include, import, launch reference, message field,
    plugin or exported name was found, and that no launch file, YAML or robot description mentions.

Why it matters
    Each one is installed on every machine, and can be removed from a distro.

Severity
    note: a dependency may be needed for reasons that no file shows.

Example
    <depend>laser_geometry</depend>             <!-- and nothing includes, finds, links or starts it -->

Use instead
    A manifest without it.

Not reported
    Metapackages; released packages of which it is not known what they offer, that have nothing to include or import
    (build tools, message runtimes, vendored libraries), or that have programs, plugins or launch files; what is asked
    for at run time alone, unless it has interfaces; dependencies of packages with unresolved CMake.
"""

from collections.abc import Collection

from ..vocabulary import Diagnostic, Package, TargetView, Text, rule
from .used_names import OF_ENVIRONMENT, list_used_names, shows_uses


@rule(
    severity="note",
    texts=Text(
        "nothing in `{package}` uses `{subject}`",
        help="remove the dependency if it is not needed for another reason",
    ),
)
def unused_dependency(view: TargetView, package: Package):
    if not shows_uses(package):
        return
    used = list_used_names(view, package)
    debian = {p.package for need in view.list_needs(package) for p in need.providers}
    found = {f.name for f in package.build.found}
    for name, kinds in view.collect_declared(package).items():
        if name in used or not kinds & {"build", "exec"} or _may_be_used_unseen(view, name, kinds):
            continue
        if (
            name in found
            and kinds & {"build"}
            and any(name in link.item for link in package.build.target_links)
        ):
            continue
        if view.list_debs(name) & debian or (
            view.target.find_version(name) is None and name not in view.workspace.packages
        ):
            continue
        yield Diagnostic(view.find_place(package, name), name, package.name)


def _may_be_used_unseen(view: TargetView, name: str, kinds: Collection[str]) -> bool:
    """Whether a use of a released package need not show in a file: it has programs, plugins or launch files, which
    people and settings start; nothing to include or import; or libraries and modules that are asked for at run time
    alone, and may be loaded by name."""
    if name in view.workspace.packages or name in OF_ENVIRONMENT:
        return False
    offer = view.offers.find_package(name)
    if offer is None:
        return True
    build, surface = offer.build, offer.history.load_surface(offer.stored)
    if "exec" in kinds and (build.programs or build.plugins or build.launches):
        return True
    interfaces = surface.interfaces if surface is not None else ()
    modules = surface.python.modules if surface is not None else ()
    shown = (*interfaces, *((*build.headers, *modules) if "build" in kinds else ()))
    return not shown
