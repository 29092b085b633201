"""Is it there, on this target? One question for packages, headers, names of C++ and Python and how they are used, CMake
names, targets, components, programs, plugins, launch files, parameters, interfaces and their fields.

What answers are surfaces that were derived from the releases themselves, the lists of their headers and the table of
interfaces; of platform libraries, and where a release was not read, the reviewed rows of data/changes*.json. Versions
decide, never the names of distros; a package of the other ROS generation never answers. What is there is looked for on
what the target is going to be as well (see Horizon), so that `upcoming` means the same to every rule.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Iterable, Iterator
from functools import cached_property
from itertools import islice
from typing import TYPE_CHECKING

from ...edges.memory import cache_method
from .changes import (
    DISTROS,
    ChangeRow,
    behaves_differently,
    find_row_version,
    find_state,
    find_version,
    has_had_header,
    has_reached,
    index_rows,
    load_uses,
)
from .distro.known import list_known_distros, release_day
from .evidence import make_evidence, make_offer_evidence
from .evidence_record import Evidence
from .providers.libraries import load_libraries
from .providers.library import find_gone_component, knows_components
from .providers.providers import Providers, load_providers
from .providers.version_macros import make_version_test
from .surface.changes import PARAMETER
from .surface.fields import covers, load_fields, was_there_before
from .surface.offers import Offered, Offers, PackageOffer
from .surface.offers_cpp import check_use
from .surface.offers_python import PythonOffers
from .surface.surface import BuildSurface
from .symbol import Availability, CppUseForm, Horizon, State, Symbol

if TYPE_CHECKING:
    from .distro.distro import DistroTarget

# Parts of a build by kind: what of a surface can be unknown as a whole, and the names that one version has.
_BUILT: dict[str, tuple[str, Callable[[BuildSurface], Iterable[str]]]] = {
    "target": ("targets", lambda build: (target.name for target in build.targets)),
    "command": ("commands", lambda build: build.commands),
    "variable": ("commands", lambda build: build.variables),
    "executable": ("programs", lambda build: (program.name for program in build.programs)),
    "launch file": ("launches", lambda build: (launch.path for launch in build.launches)),
    "launch argument": (
        "launches",
        lambda build: (f"{launch.path} {name}" for launch in build.launches for name, _ in launch.arguments),
    ),
    "header": ("headers", lambda build: (header.include for header in build.headers)),
    "plugin": ("plugins", lambda build: (name for plugin in build.plugins for name in (plugin.name, plugin.type))),
}
# Tools whose builds are read to the last header that they install; what plain CMake installs is often made by macros.
_INSTALLING = frozenset(("ament_cmake", "catkin"))
_WITH_ALIKE = frozenset(("executable", "launch file", "plugin", "target"))
_STARTED = frozenset(("executable", "launch file", "plugin"))
"""Kinds whose names are misspelt where no version has them and the target's has one like them."""
_STATES: dict[str, State] = {
    "removed": "removed",
    "moved": "removed",
    "absent": "not yet",
    "deprecated": "deprecated",
    "changed": "present",
}
_CMAKE = frozenset(("command", "target", "variable"))
_STORED = frozenset(("c++", "python", "header"))
_REFUSED_FORMS = frozenset(("arguments", "types", "override", "call"))
"""Forms whose change by an update breaks a use."""


def list_horizons(target: DistroTarget, asked: Iterable[str] = ()) -> tuple[Horizon, ...]:
    """What is to come for a target, soonest first: the next sync of its distro, the distro as of the data's newest day,
    and the newest long-term distro of its generation. asked: distros that are judged anyway, and are left out."""
    found = []
    if (testing := target.find_testing()) is not None:
        found.append(Horizon(testing, f"the next sync of {target.distro}"))
    if (updated := target.find_updated()) is not None:
        found.append(Horizon(updated, f"{target.distro} of {updated.date}"))
    newest = target.find_newest()
    if newest is not None and newest.distro not in asked:
        far = target.has_ended() or _count_newer_lts(target) > _NEAR
        found.append(Horizon(newest, newest.distro, platform=True, far=far))
    return tuple(found)


_NEAR = 2


def _count_newer_lts(target: DistroTarget) -> int:
    """How many long-term distros of a target's generation are newer than it."""
    here = release_day(target.distro)
    return sum(one.lts and one.ros == target.ros and one.released > here for one in list_known_distros())


def _is_coming(row: ChangeRow, target: DistroTarget, ahead: Horizon) -> bool:
    """Whether a row removes something on a horizon which a target has: of packages and libraries that are there in
    another version, and packages themselves."""
    then = ahead.target
    if find_state(row, then) != "removed" or find_state(row, target) == "removed":
        return False
    if row.kind.startswith("package") and then.find_version(row.old or row.package) is None:
        return True
    if ahead.platform and not row.library:
        return False
    return find_row_version(row, target) != find_row_version(row, then)


class Availabilities:
    """What is there on one target. offers, providers: where to look, by default what is shipped. ahead: see
    horizons()."""

    def __init__(
        self,
        target: DistroTarget,
        offers: Offers | None = None,
        providers: Providers | None = None,
        ahead: tuple[Horizon, ...] | None = None,
    ):
        self.target = target
        self.offers = offers or Offers(target)
        self.providers = providers or load_providers()
        self._given = ahead

    @cache_method
    def find_availability(self, symbol: Symbol) -> Availability:
        """How the target stands to a symbol, what is to come left out."""
        if symbol.use is not None:
            return self._find_use(symbol) or Availability(symbol, "present")
        if symbol.kind == "package":
            return self._find_package(symbol)
        if symbol.kind == "component":
            return self._find_component(symbol)
        if symbol.kind in ("field", "interface"):
            return self._find_interface(symbol)
        if symbol.kind == "behaviour":
            return self._find_behaviour(symbol)
        missing, nothing = None, Availability(symbol, "unknown")
        for package in symbol.packages:
            found = self._find_header(symbol, package) if symbol.kind == "header" else self._find_other(symbol, package)
            if found.state not in ("unknown", "removed", "not yet"):
                return found
            if found.state != "unknown":
                missing = missing or found
            elif found.alike:
                nothing = found
        return missing or self._find_reviewed(symbol) or self._find_library(symbol) or nothing

    @cached_property
    def _python_offers(self) -> PythonOffers:
        return PythonOffers(self.offers)

    def _find_use(self, symbol: Symbol) -> Availability | None:
        """How a name is changed, gone or deprecated for how it is used, by the stored surfaces."""
        if isinstance(symbol.use, CppUseForm):
            found = check_use(self.offers, symbol.packages[0], symbol.name, *symbol.use)
            taken_in = found is not None and found.is_missing and self._may_be_taken_in(symbol.packages[0], symbol.name)
            return Availability(symbol, "unknown") if taken_in else found
        return self._python_offers.ask(symbol.use, symbol.packages) if symbol.use is not None else None

    def _may_be_taken_in(self, package: str, name: str) -> bool:
        """Whether a name may be that of another namespace, since the headers of the package open that in the name's own
        by `using namespace`: one that declares such a name, or of which nothing is known."""
        offer = self.offers.find_package(package)
        owner, _, last = name.rpartition("::")
        for entity in offer.history.iterate_entities(owner, offer.stored) if offer is not None else ():
            if entity.kind != "using namespace":
                continue
            around = owner.split("::") if owner else []
            space = entity.type.removeprefix("::")
            head = space.partition("::")[0]
            if head not in around and self.offers.find_package(head) is None:
                return True
            meanings = ("::".join([*around[:length], space, last]) for length in range(len(around), -1, -1))
            known = (package, head, *(self.offers.list_exports(package) or ()))
            if any(self.offers.has_name("c++", full, other) for full in meanings for other in known):
                return True
        return False

    def _find_component(self, symbol: Symbol) -> Availability:
        """A component of a library, by the table of those that went and Debian's configurations."""
        package = symbol.packages[0]
        gone = find_gone_component(self.target, package, symbol.name)
        if gone is not None:
            return Availability(symbol, "removed", package, gone.version, library=True, detail=gone.help)
        known = knows_components(self.target, package)
        return Availability(symbol, "present" if known else "unknown", package, library=True)

    def _find_behaviour(self, symbol: Symbol) -> Availability:
        """What compiles on all versions, by its label in the table of what some treat otherwise."""
        row = load_uses("behaviour").get(symbol.name)
        differs = behaves_differently(row, self.target) if row is not None else None
        if row is None or row.pattern is None or differs is None:
            return Availability(symbol, "unknown")
        state: State = "changed" if differs else "present"
        evidence = Evidence(row.package, "changed", row.old, first=row.removed_in,
                            library=row.library, source=row.source)  # fmt: skip
        return Availability(symbol, state, row.package, find_row_version(row, self.target), row.removed_in, row.new,
                            library=row.library, evidence=evidence, detail=row.pattern.clause)  # fmt: skip

    def _find_library(self, symbol: Symbol) -> Availability | None:
        """What Debian's releases of a system library tell of a target that some of them export."""
        target = self.target
        if symbol.kind != "target" or not target.platform:
            return None
        found = load_libraries().find_target(symbol.name, target.platform, target.find_library)
        if found is None or found.here is None:
            return None
        state: State = "present" if found.here else "removed" if found.lost else "not yet"
        version = target.find_library(found.library) or found.version
        return Availability(symbol, state, found.library, version, library=True)

    def find_on_horizon(self, symbol: Symbol, counts: Callable[[Horizon], bool] = lambda _: True) -> Availability:
        """The same, and `upcoming` for what is there and is removed, or not usable so, on the nearest horizon that
        counts. A newer distro counts for platform libraries, and for what is deprecated here already."""
        here = self.find_availability(symbol)
        if here.state not in ("present", "deprecated") and here.form != "default":
            return here
        for horizon, then in self.ahead:
            if symbol.use is not None and all(map(self._is_alike(horizon), symbol.packages)):
                continue
            found = then.find_availability(symbol)
            breaks = found.state == "removed" or found.form in _REFUSED_FORMS
            relevant = found.library or not horizon.platform or self._is_deprecated(here)
            if breaks and found.earlier and relevant and counts(horizon):
                return found.apply_horizon(horizon)
        return here

    def _is_alike(self, horizon: Horizon) -> Callable[[str], bool]:
        """Whether a horizon has the same version of a package."""
        return lambda package: horizon.target.find_version(package) == self.target.find_version(package)

    @cache_method
    def find_reviewed(self, kind: str, name: str) -> tuple[Availability, ...]:
        """What reviewed rows say of a name that is not as it was: what is in force on the target, then what is upcoming
        on the nearest horizon. kind: as of symbols, and `use`."""
        old, new = (rows.get(_make_key(kind, name), ()) for rows in index_rows())
        here = [(row, state) for row in old if (state := find_state(row, self.target))]
        here = [(row, state) for row, state in here if state != "absent" or row.pattern is not None]
        here += [(row, "absent") for row in new if find_state(row, self.target) == "absent"]
        found = [_convert_row(kind, row, state, self.target) for row, state in here]
        found = [one for one in found if not self._is_contradicted(one)]
        coming = (
            (one, ahead)
            for ahead, then in self.ahead
            for row in old
            if _is_coming(row, self.target, ahead)
            and not then._is_contradicted(one := _convert_row(kind, row, "removed", ahead.target))
        )
        found += [one.apply_horizon(ahead) for one, ahead in islice(coming, 1)]
        return tuple(one for one in found if one.symbol.name == name or kind == "command")

    def _is_contradicted(self, row: Availability) -> bool:
        """Whether what is stored of the very release has a name that a reviewed row denies."""
        stored = not row.library or self.offers.surfaces.is_library(row.package)
        if not stored or not row.is_missing or (row.symbol.kind not in _STORED and row.symbol.kind not in _CMAKE):
            return False
        if row.symbol.kind == "header":
            found = self._find_header_in(row.symbol, row.package, row.version)
        else:
            found = self._find_other(row.symbol, row.package)
        return found.state in ("present", "deprecated")

    def iterate_reviewed_uses(self) -> Iterator[Availability]:
        """The same of all uses."""
        for label in load_uses():
            yield from self.find_reviewed("use", label)

    def has_replacing_header(self, path: str) -> bool | None:
        """Whether a header is there that reviewed rows name for others that are not as they were; None where they name
        it for none."""
        rows = index_rows()[1].get(("header", path), ())
        states = [state for row in rows if (state := find_state(row, self.target))]
        return states[-1] != "absent" if states else None

    def _is_deprecated(self, here: Availability) -> bool:
        """Whether the target warns of something, by what its version says or by a reviewed row."""
        if here.state == "deprecated":
            return True
        row = self._find_reviewed(here.symbol)
        return row is not None and row.state == "deprecated"

    @cached_property
    def ahead(self) -> list[tuple[Horizon, Availabilities]]:
        ahead = list_horizons(self.target) if self._given is None else self._given
        return [(one, Availabilities(one.target, providers=self.providers, ahead=())) for one in ahead]

    def _find_package(self, symbol: Symbol) -> Availability:
        target, name = self.target, symbol.name
        version = target.find_version(name)
        row = self._find_reviewed(symbol)
        if version is not None:
            late = row is not None and row.state == "deprecated"
            return Availability(symbol, "deprecated" if late else "present", name, version,
                                replacement=row.replacement if row is not None and late else "")  # fmt: skip
        if row is not None:
            return row
        last = target.find_last_distro(name)
        if not last or last not in DISTROS or target.distro not in DISTROS:
            return Availability(symbol, "unknown", name)
        return Availability(symbol, "removed" if DISTROS[last] < DISTROS[target.distro] else "not yet", name)

    def _find_header(self, symbol: Symbol, package: str) -> Availability:
        version = self.target.find_version(package)
        if version is None:
            return Availability(symbol, "unknown", package)
        found = self._find_header_in(symbol, package, version)
        if found.state == "unknown" and self._generates(package, version, symbol.name):
            return Availability(symbol, "present", package, version)
        offer = self.offers.find_package(package)
        if offer is None or not (found.is_missing or found.state == "unknown"):
            return found
        if symbol.name in self._list_made_headers(offer):
            return Availability(symbol, "present", package, version)
        # `include/PACKAGE` is exported where headers are installed a folder deeper, so that the path stays as it was.
        nested = f"{package}/{symbol.name}" in self._list_made_headers(offer)
        alone = symbol.packages == (package,) and not self.providers.list_header_spans(package, symbol.name)
        if found.state == "unknown" and alone and not nested:
            return self._find_never_installed(symbol, offer)
        hidden = offer.build.has_empty_folders or any(part == "headers" for part, _ in offer.build.unknown)
        closed = not nested and not hidden
        return found if closed else Availability(symbol, "unknown", package, version)

    def _find_header_in(self, symbol: Symbol, package: str, version: str) -> Availability:
        by_surface = self._find_other(symbol, package)
        has = self.providers.has_header(package, symbol.name, self.target.distro, version)
        if has is None or has == (by_surface.state in ("present", "deprecated")):
            return by_surface
        if has:
            return Availability(symbol, "present", package, version)
        if by_surface.state != "unknown":
            return by_surface if by_surface.is_missing else Availability(symbol, "unknown", package, version)
        early = has_had_header(package, symbol.name, self.target, self.providers)
        if early is None:
            return Availability(symbol, "unknown", package, version)
        evidence = Evidence(package, "removed" if early else "added", symbol.name, side="header", header=symbol.name)
        return Availability(symbol, "removed" if early else "not yet", package, version, evidence=evidence)

    def _generates(self, package: str, version: str, path: str) -> bool:
        """Whether a header is one that a version of a package is known to make: from an interface, or of its macros."""
        macros = make_version_test(package, False, version, ros=self.target.ros, oldest=version)
        if macros is not None and macros.header.strip("<>") == path:
            return True
        history = load_fields().find_history(package, self.target.ros)
        stem = path.partition("/")[2].rpartition(".")[0]
        name = history.by_header.get(stem) if history is not None else None
        return name is not None and self._find_interface(Symbol("interface", name, (package,))).state == "present"

    def _find_never_installed(self, symbol: Symbol, offer: PackageOffer) -> Availability:
        """How the target stands to a header that no read version of a package has. Where its own was not read as a
        whole the answer is unknown, and names what is called alike; that is sure where a release between was not read
        alone, which brings no headers called like others but for their endings."""
        path, build, package = symbol.name, offer.build, offer.package
        unknown = Availability(symbol, "unknown", package, offer.version)
        if build.build_type not in _INSTALLING or not build.headers or offer.stored in offer.line.approximate:
            return unknown
        if offer.get("header", path) is not None or _WRITTEN.search(path):
            return unknown
        if _OF_INTERFACES[self.target.ros].match(path):
            return unknown
        hidden = any(part == "headers" for part, _ in build.unknown)
        read = offer.exact or self.providers.has_header(package, path, self.target.distro, offer.version) is not None
        alike = _find_similar_name(offer, "header", path)
        alike = alike if _is_misspelling(path, alike) else ""
        if read and not hidden:
            return unknown._replace(state="not yet", alike=alike, form="never")
        return unknown._replace(alike=alike, sure=not hidden and path.rpartition(".")[2] == alike.rpartition(".")[2])

    @cache_method
    def _list_made_headers(self, offer: PackageOffer) -> frozenset[str]:
        """Headers of the stored version that its tree does not have: those that its build makes, and whatever its own
        headers include."""
        found = {header.include for header in offer.build.headers}
        included = self.offers.surfaces.find_included(offer.package, self.target.ros)
        if included is not None:
            for header in included.headers:
                found.update(one.path for one in included.list_includes(header, offer.stored) or ())
        return frozenset(found)

    def _find_other(self, symbol: Symbol, package: str) -> Availability:
        offer = self.offers.find_package(package)
        if offer is None:
            return Availability(symbol, "unknown", package, self.target.find_version(package) or "")
        side = PARAMETER if symbol.kind == "parameter" else symbol.kind
        # CMake minds no case in names of commands, and neither do surfaces.
        name = symbol.name.lower() if side == "command" else symbol.name
        offered = offer.get(side, name)
        if offered is None:
            if self._has(offer, side, name):
                return Availability(symbol, "present", package, offer.version)
            if alike := _find_misspelled_name(offer, side, name):
                return Availability(symbol, "not yet", package, offer.version, alike=alike, sure=False, form="never")
            if side == "plugin" and _names_plugins(offer, name) and not self.offers.has_plugin_owner(name):
                return Availability(symbol, "not yet", package, offer.version, sure=False, form="never")
        if offered is None or not decides(offer, offered):
            return Availability(symbol, "unknown", package, offer.version)
        state = _STATES[offered.state]
        if side == "c++" and state in ("removed", "not yet") and offer.build.has_empty_folders:
            return Availability(symbol, "unknown", package, offer.version)
        sure = offered.sure
        if side in _BUILT:
            part, names = _BUILT[side]
            if state in ("removed", "not yet") and name in names(offer.build):
                return Availability(symbol, "present", package, offer.version)
            sure = sure and all(one != part for one, _ in offer.build.unknown)
        return Availability(
            symbol, state, package, offer.version, offered.first, offered.instead or _find_older_name(offer, offered),
            offered.moved_to,
            _find_similar_name(offer, side, name) if state in ("removed", "not yet") and side in _WITH_ALIKE else "",
            sure=sure, evidence=_merge_evidence(offer, offered),
        )  # fmt: skip

    def _has(self, offer: PackageOffer, side: str, name: str) -> bool:
        if side in _BUILT:
            return name in _BUILT[side][1](offer.build)
        if side == PARAMETER:
            return name in offer.parameters
        return self.offers.has_name(side, name, offer.package)

    def _find_interface(self, symbol: Symbol) -> Availability:
        name, *parts = symbol.name.split(".")
        member = parts[-1] if parts else ""
        for package in symbol.packages:
            version = self.target.find_version(package)
            history = load_fields().find_history(package, self.target.ros) if version else None
            state = history.find_state(version) if history is not None and version else None
            if history is None or state is None or not version:
                continue
            instead = ""
            if member:
                definition = history.find_definition(name)
                if definition is None or not covers(definition.spans, state):
                    continue
                sections = [".".join(parts[:-1])] if parts[:-1] else [s for s in definition.sections if "." not in s]
                rows = [row for section in sections for row in definition.list_members(section, member)]
                spans = tuple(span for row in rows for span in row.spans)
                successor = next((row.successor for row in rows if row.successor), "")
                # The comparison of versions only guesses what came for a field.
                if any(covers(row.spans, state) for one in sections for row in definition.list_members(one, successor)):
                    instead = successor
            else:
                spans = history.find_spans(name) or ()
            if not spans:
                continue
            if covers(spans, state):
                return Availability(symbol, "present", package, version)
            if history.may_be_back(spans, version):
                continue
            if was_there_before(spans, state):
                ends = [last for _, last in spans if 0 <= last < state]
                since = history.starts[max(ends) + 1] if ends else ""
                evidence = Evidence(package, "removed", member or name, first=since)
                reviewed = self._find_reviewed_field(package, name, parts) if member else ""
                return Availability(symbol, "removed", package, version, since, reviewed,
                                    alike="" if reviewed else instead, evidence=evidence)  # fmt: skip
            if history.read_up_to(version):
                since = history.starts[min(first for first, _ in spans)]
                evidence = Evidence(package, "added", member or name, first=since)
                return Availability(symbol, "not yet", package, version, since, evidence=evidence)
        return Availability(symbol, "unknown")

    def _find_reviewed_field(self, package: str, interface: str, parts: list[str]) -> str:
        """What a reviewed row says stands for a field; rows call it `Name.field` or `Name_Part.field`."""
        section = "" if parts[:-1] in ([], ["message"]) else f"_{parts[0].capitalize()}"
        name = f"{interface.rpartition('/')[2]}{section}.{parts[-1]}"
        for row in self.find_reviewed("field", f"{package}/{name}"):
            if row.replacement and row.state == "removed" and row.package == package:
                return row.replacement.rpartition(".")[2]
        return ""

    def _find_reviewed(self, symbol: Symbol) -> Availability | None:
        for row in self.find_reviewed(symbol.kind, symbol.name):
            if row.state != "upcoming" and (not symbol.packages or row.library or row.package in symbol.packages):
                return row._replace(symbol=symbol)
        for row in index_rows()[0].get(_make_key(symbol.kind, symbol.name), ()):
            if not row.library or not row.removed_in or row.new_since or row.back_in:
                continue
            version = find_version(row.package, True, self.target)
            if version and not has_reached(row.removed_in, version, self.target):
                return Availability(symbol, "present", row.package, version, library=True)
        return None


def _make_key(kind: str, name: str) -> tuple[str, str]:
    """What index_rows() has rows on a symbol by."""
    return ("cmake", name.lower() if "::" not in name else name) if kind in _CMAKE else (kind, name)


def _convert_row(kind: str, row: ChangeRow, in_force: str, target: DistroTarget) -> Availability:
    """What a reviewed row says of its name. kind: of the symbol. in_force: as find_state() has it."""
    state: State = "changed" if row.kind in ("api-changed", "call-changed") else "removed"
    name, other = row.old or row.package, row.new
    since, earlier = "" if row.pattern is not None else row.removed_in, True
    if in_force == "absent":
        since, earlier = row.new_in.get(target.distro) or row.new_since, False
        if row.pattern is None:
            state, name, other = "not yet", row.new, row.old
    elif in_force == "deprecated":
        state, since = "deprecated", ""
    form = "renamed" if row.kind.endswith(("-renamed", "-moved")) else ""
    return Availability(Symbol(kind, name), state, row.package, find_row_version(row, target), since, other,
                        library=row.library, evidence=make_evidence(row, in_force),
                        replacement_since=row.format_arrival() if earlier else "",
                        form="meaning" if row.kind == "api-changed" else form, earlier=earlier,
                        detail=row.pattern.clause if row.pattern is not None else "")  # fmt: skip


_SEVERAL = 3
"""Commands that go with one version, when no command is left."""


def decides(offer: PackageOffer, offered: Offered) -> bool:
    """Whether what is known of a name rests on versions that were read: not on a branch, which may hold something else
    than the release, and not on one of two stored versions that differ in this, with the target's between them. Where
    all commands of CMake are gone at once, they may be installed in a way that is not read (a configuration that a
    macro of the package writes)."""
    line = offer.line
    if offered.what == "command" and offered.here is None and not offer.build.commands:
        changed = (line.versions[event.place] for events in line.events["command"].values() for event in events)
        if sum(version == offered.first for version in changed) >= _SEVERAL:
            return False
    if any(version in line.approximate for version in (offer.stored, offered.last, offered.first)):
        return False
    return offer.exact or all(e.place != offer.place + 1 for e in line.events[offered.side][offered.name])


def _find_older_name(offer: PackageOffer, offered: Offered) -> str:
    """The name that one which is not there yet is going to replace."""
    if offered.state != "absent":
        return ""
    every = offer.line.events.get(offered.side, {})
    changes = ((old, thing) for old, events in every.items() for event in events for thing in event.reported)
    return next((old for old, thing in changes if thing.instead == offered.name), "")


def _merge_evidence(offer: PackageOffer, offered: Offered) -> Evidence:
    """The evidence for what surfaces say of a name, with that for what stands for it."""
    evidence = make_offer_evidence(offered)
    if (old := _find_older_name(offer, offered)) and (gone := offer.get(offered.side, old)) is not None:
        first = gone.gone_in or gone.first
        other = Evidence(offered.package, "removed", old, offered.name, offered.side, first=first, stored=True)
        return evidence._replace(instead=old, other=other)
    new = offer.get(offered.side, offered.instead) if offered.instead else None
    if new is None or not new.first:
        return evidence
    return evidence._replace(
        other=Evidence(offered.package, "added", new.name, offered.name, offered.side, first=new.first, stored=True)
    )


_ALIKE, _MISSPELT = 0.75, 0.85
"""How much of two names has to agree, as difflib measures it."""


def _find_similar_name(offer: PackageOffer, side: str, name: str) -> str:
    """What the target's version has that is called most alike; empty where nothing is."""
    close = difflib.get_close_matches(name, list(dict.fromkeys(_BUILT[side][1](offer.build))), 1, _ALIKE)
    return close[0] if close else ""


def _find_misspelled_name(offer: PackageOffer, side: str, name: str) -> str:
    """What the target's version has and a name is a misspelling of: only the last part of it differs, by little. Empty
    where not all that the version has is known."""
    if not offer.exact or side not in _STARTED or any(one == _BUILT[side][0] for one, _ in offer.build.unknown):
        return ""
    alike = _find_similar_name(offer, side, name)
    return alike if _is_misspelling(name, alike) else ""


def _names_plugins(offer: PackageOffer, name: str) -> bool:
    """Whether a name begins as those of the plugins that a version has, all of which are known: as `package/Class`. A
    class may lie in the namespace of another package."""
    if "/" not in name or not offer.exact or any(part == "plugins" for part, _ in offer.build.unknown):
        return False
    return any(_split(plugin.name)[0] == _split(name)[0] for plugin in offer.build.plugins)


def _is_misspelling(name: str, alike: str) -> bool:
    """Whether only the last part of two names differs, by little."""
    (head, tail), (other_head, other) = _split(name), _split(alike)
    return head == other_head and difflib.SequenceMatcher(None, tail, other).ratio() >= _MISSPELT


# Headers that commands of CMake write and install, without a trace in what is read of a build.
_WRITTEN = re.compile(r"[/_](?:version|config|export|visibility|visibility_control|parameters)\.h(?:pp)?\Z")
# Headers that are generated from interfaces, by generation of ROS: the table of interfaces tells of these, since their
# definitions may lie in another package.
_OF_INTERFACES = {1: re.compile(r"\w+/[A-Z]\w*\.h\Z"), 2: re.compile(r"\w+/(?:msg|srv|action)/")}


def _split(name: str) -> tuple[str, str]:
    at = max(name.rfind("/"), name.rfind(":")) + 1
    return name[:at], name[at:]
