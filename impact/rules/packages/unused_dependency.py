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
    Metapackages; released packages of which it is not known what they offer, or that have nothing to include or import
    (build tools, message runtimes, vendored libraries); packages with programs, plugins or launch files; libraries that
    are asked for at run time alone, and modules that extend another package, since both may be loaded by name;
    dependencies of packages with unresolved CMake.
"""

from collections.abc import Collection

from ...targets.surface.surface import Surface
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
    """Whether a use of a package need not show in a file: it has programs, plugins or launch files, which
    people and settings start; nothing to include or import; a library that is asked for at run time alone; or modules
    that extend another package, which may load them by name."""
    if name in OF_ENVIRONMENT:
        return False
    if (own := view.workspace.packages.get(name)) is not None:
        linked = own.linked
        programs = any(target.kind == "executable" for target in own.build.targets) or linked.scripts
        return "exec" in kinds and bool(programs or linked.plugins or linked.registered)
    offer = view.offers.find_package(name)
    if offer is None:
        return True
    build, surface = offer.build, offer.history.load_surface(offer.stored)
    if surface is None or ("exec" in kinds and (build.programs or build.plugins or build.launches)):
        return True
    if surface.interfaces or ("build" in kinds and build.headers):
        return False
    return not surface.python.modules or _is_extension(surface)


def _is_extension(surface: Surface) -> bool:
    """Whether a module of a package has a class that is derived from one of a package which comes along."""
    for module in surface.python.modules:
        taken = {
            one.name
            for one in module.surface.imports
            if not one.level and one.module.partition(".")[0] in surface.runs_with
        }
        bases = (base.partition(".")[0] for name in module.surface.names for base in name.bases)
        if not taken.isdisjoint(bases):
            return True
    return False
