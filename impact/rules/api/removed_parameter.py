"""removed-parameter: a parameter is set that the target's version of a node or plugin does not declare.

What it does
    Reports parameters that parameter files of ROS 2 and launch files set for nodes and plugins of released packages,
    that an earlier or later version of the package declares, and that the target's does not. Whose a parameter is, is
    told by the `plugin:` beside it, the `type:` that the controller manager has for the node, or the node's program.

Why it matters
    Most nodes ignore what they do not declare, without a word: the robot runs with the default.

Severity
    warning.

Example
    progress_checker_plugin: "progress_checker"         # nav2_controller until Iron

Use instead
    progress_checker_plugins: ["progress_checker"]      # Jazzy and later

Not reported
    Names that no version declares; names that the sources of the target's version, or of what is installed with it,
    still mention; nodes and plugins of the workspace; names beside which the new one is set as well; tests, examples
    and files in folders that are called after another distro; parameter files of ROS 1.
"""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from ...facts.parameters import last_part
from ...model.package import SettingUse
from ...model.view import View
from ...model.workspace import Package
from ...targets.availability import decides
from ...targets.evidence import of_offered
from ...targets.parameters import renamed_parameters
from ...targets.surface.changes import PARAMETER
from ...targets.surface.offers import Offer, Offered
from ..rule import Diagnostic, rule
from ..text import Text
from .diagnosis import is_of_another_distro

_FEW = 3
"""So many of one owner are reported one by one; of more the first is reported, and how many there are."""
_HELP = "[[set `{replacement}`]]"


class _Lost(NamedTuple):
    """A parameter that is not declared on the target. instead: its other name there, empty where none is known."""

    use: SettingUse
    offered: Offered
    instead: str


@rule(
    scope="target",
    severity="warning",
    texts={
        "removed": Text("the parameter `{subject}` is no longer declared by {upstream} {version}", _HELP),
        "removed, many": Text(
            "`{subject}` and {more} more parameters of this file are no longer declared by {upstream} {version}", _HELP
        ),
        "not yet": Text(
            "the parameter `{subject}` is not declared by {upstream} {version}[[ (added in {since})]]", _HELP
        ),
        "not yet, many": Text(
            "`{subject}` and {more} more parameters of this file are not declared by {upstream} {version}"
            "[[ (added in {since})]]",
            _HELP,
        ),
    },
)
def removed_parameter(view: View):
    for package in view:
        by_owner: dict[tuple[str, str, str, bool], list[_Lost]] = {}
        for lost in _lost(view, package):
            owner = lost.use.plugin or lost.use.node
            by_owner.setdefault((lost.use.at.path, owner, lost.offered.package, _gone(lost)), []).append(lost)
        for found in by_owner.values():
            if len(found) <= _FEW:
                yield from (_diagnose(package, lost) for lost in found)
            else:
                yield _diagnose(package, found[0], len(found) - 1)


def _gone(lost: _Lost) -> bool:
    return lost.offered.state != "absent"


def _diagnose(package: Package, lost: _Lost, more: int = 0) -> Diagnostic:
    offered = lost.offered
    data = {
        "upstream": offered.package,
        "version": offered.version,
        "since": "" if _gone(lost) else offered.first,
        "replacement": lost.instead,
        "more": more,
    }
    kind = f"{'removed' if _gone(lost) else 'not yet'}{', many' if more else ''}"
    return Diagnostic(lost.use.at, lost.use.name, package.name, data, kind, evidence=of_offered(offered))


def _lost(view: View, package: Package) -> Iterator[_Lost]:
    files = frozenset(package.digest.files)
    uses = [use for use in package.digest.settings if use.role == "run"]
    if not uses:
        return
    # What a reviewed row about a value says at the same place says more.
    explained = {(use.at.path, use.at.line) for use in package.digest.uses if use.language == "yaml"}
    beside: dict[tuple[str, str, str], set[str]] = {}
    for use in uses:
        beside.setdefault((use.at.path, use.plugin, use.node), set()).add(last_part(use.name))
    for use in dict.fromkeys(uses):
        if (use.at.path, use.at.line) in explained or is_of_another_distro(view, use.at.path, files):
            continue
        offered = next((found for offer in _owners(view, use) if (found := _offered(view, offer, use))), None)
        if offered is None:
            continue
        others = renamed_parameters(offered.package).get(last_part(use.name), ())
        if beside[use.at.path, use.plugin, use.node].isdisjoint(others):
            yield _Lost(use, offered, _instead(view, offered, others))


def _owners(view: View, use: SettingUse) -> Iterator[Offer]:
    """The packages that have the node or plugin on the target: one that is named, or those of which a program is called
    like the node."""
    changing = view.offers.surfaces.changing_parameters.get(last_part(use.name), frozenset[str]())
    for name in [use.package] if use.package else sorted(changing):
        if name in view.workspace.packages or (not use.package and _started(view).get(use.node, {name}) != {name}):
            continue  # by that name another package's program is meant
        offer = view.offers.package(name)
        if offer is None:
            continue
        programs = (program.name for program in offer.build.programs)
        plugins = (known for plugin in offer.build.plugins for known in (plugin.name, plugin.type))
        if use.plugin in plugins if use.plugin else use.node in programs:
            yield offer


def _started(view: View) -> dict[str, set[str]]:
    """The packages whose program of a name the workspace builds, or starts from a launch file."""
    known = view.worked_out.get(("programs", ""))
    if known is None:
        known = view.worked_out["programs", ""] = {}
        for package in view.workspace:
            names = [target.name for target in package.build.targets if target.kind == "executable"]
            names += [name for _, setup in package.digest.setup for name, _, _ in setup.entry_points]
            names += [path.rpartition("/")[2].removesuffix(".py") for path in package.digest.scripts]
            for name in names:
                known.setdefault(name, set()).add(package.name)
            for use in package.digest.references:
                if use.reference.kind == "executable" and use.reference.name:
                    known.setdefault(use.reference.name, set()).add(use.reference.package)
    return known


def _offered(view: View, offer: Offer, use: SettingUse) -> Offered | None:
    """What is known of a parameter that the package lacks on the target, None where it is not sure that it does."""
    last = last_part(use.name)
    found = None
    for declared in offer.line.events.get(PARAMETER, ()):
        if last_part(declared) == last and means(declared, use.name, of_plugin=bool(use.plugin)):
            offered = offer.get(PARAMETER, declared)
            if offered is None or offered.state not in ("removed", "moved", "absent"):
                return None
            if offered.sure and decides(offer, offered):
                found = found or offered
    if found is None or _declared_by(view, (offer.package, *use.others), last):
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


def _declared_by(view: View, packages: Iterable[str], last: str) -> bool:
    """Whether some of these packages, or of what is installed with them, may declare a parameter that ends so."""
    for name in view.spread(packages):
        if name in view.workspace.packages:
            return True
        offer = view.offers.package(name)
        if offer is not None and any(last_part(declared) == last for declared in offer.parameters):
            return True
    return False


def _instead(view: View, offered: Offered, others: Iterable[str]) -> str:
    """The other name of a parameter that is declared on the target."""
    offer = view.offers.package(offered.package)
    declared = {last_part(name) for name in offer.parameters} if offer is not None else set()
    return next((name for name in others if name in declared), "")
