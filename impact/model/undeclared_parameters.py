"""Parameters set for nodes and plugins of released packages whose version on the target does not declare them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from ...edges.memory import cache_in_derived
from ..targets.availability import decides
from ..targets.parameters import find_last_part, find_renamed_parameters
from ..targets.surface.changes import PARAMETER
from ..targets.surface.offers import Offered, PackageOffer
from .package import SettingUse
from .view import TargetView
from .workspace import Package


class UndeclaredParameter(NamedTuple):
    """A parameter that an earlier or later version of a package declares, and the target's does not. instead: its other
    name there, empty where none is known."""

    use: SettingUse
    offered: Offered
    instead: str

    @property
    def is_gone(self) -> bool:
        """Whether an earlier version declared it."""
        return self.offered.state != "absent"


def list_undeclared_parameters(view: TargetView, package: Package) -> Iterator[UndeclaredParameter]:
    """Those that files of a package set, beside which no other name of the same parameter is set, and to another value
    than that which holds without."""
    uses = [use for use in package.linked.settings if use.role == "run"]
    beside: dict[tuple[str, str, str], set[str]] = {}
    for use in uses:
        beside.setdefault((use.at.path, use.plugin, use.node), set()).add(find_last_part(use.name))
    for use in dict.fromkeys(uses):
        offered = next((found for offer in _list_owners(view, use) if (found := _find_offered(view, offer, use))), None)
        if offered is None:
            continue
        others = find_renamed_parameters(offered.package).get(find_last_part(use.name), ())
        if beside[use.at.path, use.plugin, use.node].isdisjoint(others):
            instead = _find_replacement(view, offered, others)
            if not _is_default(view, use, offered, instead):
                yield UndeclaredParameter(use, offered, instead)


def _list_owners(view: TargetView, use: SettingUse) -> Iterator[PackageOffer]:
    """The packages that have the node or plugin on the target: one that is named, or those of which a program is called
    like the node."""
    changing = view.offers.surfaces.changing_parameters.get(find_last_part(use.name), frozenset[str]())
    for name in [use.package] if use.package else sorted(changing):
        if name in view.workspace.packages:
            continue
        if not use.package and _find_starters(view).get(use.node, {name}) != {name}:
            continue  # by that name another package's program is meant
        offer = view.offers.find_package(name)
        if offer is None:
            continue
        programs = (program.name for program in offer.build.programs)
        plugins = (known for plugin in offer.build.plugins for known in (plugin.name, plugin.type))
        if use.plugin in plugins if use.plugin else use.node in programs:
            yield offer


@cache_in_derived
def _find_starters(view: TargetView) -> dict[str, set[str]]:
    """The packages whose program of a name the workspace builds, or starts from a launch file."""
    found: dict[str, set[str]] = {}
    for package in view.workspace:
        names = [target.name for target in package.build.targets if target.kind == "executable"]
        names += [name for _, setup in package.linked.setup for name, *_ in setup.entry_points]
        names += [path.rpartition("/")[2].removesuffix(".py") for path in package.linked.scripts]
        for name in names:
            found.setdefault(name, set()).add(package.name)
        for use in package.linked.references:
            if use.reference.kind == "executable" and use.reference.name:
                found.setdefault(use.reference.name, set()).add(use.reference.package)
    return found


def _find_offered(view: TargetView, offer: PackageOffer, use: SettingUse) -> Offered | None:
    """What is known of a parameter that the package lacks on the target, None where it is not sure that it does."""
    last = find_last_part(use.name)
    found = None
    for declared in offer.line.events.get(PARAMETER, ()):
        if find_last_part(declared) == last and means(declared, use.name, of_plugin=bool(use.plugin)):
            offered = offer.get(PARAMETER, declared)
            if offered is None or offered.state not in ("removed", "moved", "absent"):
                return None
            if offered.sure and decides(offer, offered):
                found = found or offered
    if found is None or _is_declared_by(view, (offer.package, *use.others), last):
        return None
    return found


def means(declared: str, name: str, *, of_plugin: bool = False) -> bool:
    """Whether a name that is set is one that is declared, in which `*` stands for one part or more. of_plugin: it is
    set below the name of a plugin, which the declared one may begin with."""
    wanted, given = declared.replace("/", ".").lstrip("~.").split("."), name.split(".")
    return _fits(wanted, given) or (of_plugin and wanted[0] == "*" and _fits(wanted[1:], given))


def _fits(wanted: list[str], given: list[str]) -> bool:
    if not wanted or not given:
        return not wanted and not given
    if wanted[0] == "*":
        return any(_fits(wanted[1:], given[count:]) for count in range(1, len(given)))
    return wanted[0] == given[0] and _fits(wanted[1:], given[1:])


def _is_declared_by(view: TargetView, packages: Iterable[str], last: str) -> bool:
    """Whether some of these packages, or of what is installed with them, may declare a parameter that ends so."""
    for name in view.list_transitive(packages):
        if name in view.workspace.packages:
            return True
        offer = view.offers.find_package(name)
        if offer is not None and any(find_last_part(declared) == last for declared in offer.parameters):
            return True
    return False


def _find_replacement(view: TargetView, offered: Offered, others: Iterable[str]) -> str:
    """The other name of a parameter that is declared on the target."""
    offer = view.offers.find_package(offered.package)
    declared = {find_last_part(name) for name in offer.parameters} if offer is not None else set()
    return next((name for name in others if name in declared), "")


def _is_default(view: TargetView, use: SettingUse, offered: Offered, instead: str) -> bool:
    """Whether the value that is set is that which holds without: what the other name has by default, and where there is
    no other name what the parameter itself had."""
    offer = view.offers.find_package(offered.package)
    if offer is None or offered.state == "absent" or not use.value:
        return False
    if instead:
        default = next((value for name, value in offer.parameters.items() if find_last_part(name) == instead), None)
    else:
        default = offer.find_last_default(offered.name)
    return default is not None and _normalise_value(default) == _normalise_value(use.value)


def _normalise_value(value: str) -> str | float:
    text = value.strip("\"'").lower()
    try:
        return float(text)
    except ValueError:
        return text
