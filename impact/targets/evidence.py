"""What a finding about a changed name rests on: how it was and is, between which versions, and since when on whom.

A rule gives what holds for everybody (`Evidence` without targets); `seen_on` adds, of every target asked for, whether
the change is in force there and on which day its distro got it, told by the shipped history of releases.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache, cmp_to_key

from .changes import DISTROS, ChangeRow, find_version, has_reached
from .distro.distro import DistroTarget
from .distro.known import list_releases, release_day
from .evidence_record import Evidence, OnTarget
from .providers.providers import Providers
from .surface.changes import ChangeEvent, Line
from .surface.offers import Offered, classify_event, find_standing, list_declared
from .surface.store import load_shipped
from .version import compare, is_at_least, parse


def make_evidence(row: ChangeRow, state: str) -> Evidence:
    """The evidence for a known change of changes.py that is in force in this way, as find_state() has it."""
    if row.pattern is not None:
        first = row.new_since if state == "absent" else row.removed_in
        side = "python" if row.pattern.language == "python" else "c++"
        return Evidence(row.package, _WHAT.get(state, "removed"), row.old, side=side,
                        last=row.last_in or _find_before(first, row.library, row.source, row.package), first=first,
                        library=row.library, source=row.source)  # fmt: skip
    if state == "deprecated":
        return _make_gone(row)._replace(change="deprecated", last="", first=row.deprecated_in, header="")
    here, other = (_make_new(row), _make_gone(row)) if state == "absent" else (_make_gone(row), _make_new(row))
    known = other.name and not row.back_in and (other.first or other.new_in or other.header)
    return here._replace(other=other) if known else here


_WHAT = {"absent": "added", "deprecated": "deprecated"}
_SIDES = {"header": "header", "python": "python", "cmake": "cmake", "api": "c++"}


def _make_gone(row: ChangeRow) -> Evidence:
    """That the old name went."""
    side = _SIDES.get(row.kind.partition("-")[0], "")
    # Where an old name came back, no one version tells who has it.
    first = "" if row.back_in else row.removed_in
    return Evidence(row.package, "changed" if row.kind == "api-changed" else "removed", row.old, row.new, side,
                    last=row.last_in or _find_before(first, row.library, row.source, row.package), first=first,
                    library=row.library,
                    source=row.source, header="" if row.library or side != "header" else row.old)  # fmt: skip


def _make_new(row: ChangeRow) -> Evidence:
    """That the new name came."""
    gone = _make_gone(row)
    return Evidence(row.package, "added", row.new, row.old, gone.side, first=row.new_since, library=row.library,
                    source=row.source, new_in=tuple(row.new_in.items()),
                    header=row.new if gone.header else "")  # fmt: skip


def _find_before(first: str, library: bool, source: str, package: str) -> str:
    """The newest released version before one, for rows that were made by comparing one release with the next."""
    if library or not first[:1].isdigit() or not source.startswith("release tags of"):
        return ""
    return find_release_before(package, first)


@cache
def find_release_before(package: str, version: str) -> str:
    """The highest version of a ROS package below this one that a distro of the same generation ever had. Empty when
    none had one, or none this version, so that the generation is not known."""
    released = list_releases(package)
    generations = {ros for ros, other in released if other == version}
    older = (other for ros, other in released if generations == {ros} and not is_at_least(other, version))
    return max(older, key=cmp_to_key(compare), default="")


def make_offer_evidence(offered: Offered) -> Evidence:
    """The evidence for what the offers of a target say of a name."""
    change = {"moved": "removed", "absent": "added"}.get(offered.state, offered.state)
    return Evidence(offered.package, change, offered.name, offered.instead, offered.side,
                    last=offered.last, first=offered.first, stored=True)  # fmt: skip


def add_surfaces(evidence: Evidence, target: DistroTarget) -> Evidence:
    """The evidence with what the stored surfaces tell of the name: declarations, and the versions between which it
    changed as a target sees it. As it was where they know nothing of such a change."""
    version = None if evidence.library or evidence.ahead else target.find_version(evidence.package)
    line = load_shipped().find_line(evidence.package, target.ros) if version and evidence.side else None
    place = line.find_place(version) if line is not None and version else None
    if line is None or place is None:
        return evidence
    sides = ("command", "target", "variable") if evidence.side == "cmake" else (evidence.side,)
    for side in sides:
        events = line.events.get(side, {}).get(evidence.name, ())
        event = next((one for one in events if evidence.stored and line.versions[one.place] == evidence.first), None)
        event = event or _find_deciding_event(evidence.change, side, events, place)
        if event is not None and event.place:
            last, first = line.versions[event.place - 1], line.versions[event.place]
            found = evidence._replace(side=side, last=last, first=first, new_in=(), stored=True)
            found = found if evidence.change == "deprecated" else _add_declarations(found, target.ros)
            guessed = not evidence.stored and (last in line.approximate or first in line.approximate)
            if guessed or evidence.new_in or evidence.first[:1].isdigit():
                # A branch stood for one of them; or a person found out the very version, and not all are stored.
                return found._replace(
                    last=evidence.last, first=evidence.first, new_in=evidence.new_in, stored=evidence.stored
                )
            return found
    return evidence


def _add_declarations(evidence: Evidence, ros: int) -> Evidence:
    """The evidence with the declarations before and since."""
    history = load_shipped().find_history(evidence.package, ros)
    old, new = (
        list_declared(history, evidence.side, evidence.name, version) for version in (evidence.last, evidence.first)
    )
    # What only changed beneath, such as a base, is declared as before.
    return evidence._replace(old=old, new=new) if old != new else evidence


def _find_deciding_event(change: str, side: str, events: Sequence[ChangeEvent], place: int) -> ChangeEvent | None:
    """The event of a name that made it what it is on a target; None when none did."""
    if change == "added":
        found = next((event for event in events if event.place > place), None)
        return found if found is not None and classify_event(side, found) == "come" else None
    past = [event for event in events if event.place <= place]
    if change == "deprecated":
        return next((e for e in reversed(past) if any(reported.kind == "deprecated" for reported in e.reported)), None)
    if not past or (classify_event(side, past[-1]) == "gone") != (change == "removed"):
        return None
    return past[-1]


def add_target_states(
    evidence: Evidence, targets: Sequence[DistroTarget], spoken_of: Iterable[str], providers: Providers
) -> Evidence | None:
    """The evidence with how each target stands to it, in the order given; targets that lack the package or library, or
    have it in an unknown version, are left out.

    spoken_of: names of the targets that the finding holds for. Where what is known of the versions contradicts the
    finding, versions and days are left out rather than shown; None when nothing remains.
    """
    spoken = frozenset(spoken_of)
    reported = next((target for target in targets if target.name in spoken), None)
    evidence = add_surfaces(evidence, reported) if reported is not None else evidence
    found = tuple(one for target in targets if (one := _make_target_state(evidence, target, providers)) is not None)
    expected = (evidence.change != "added") != evidence.ahead
    if any(one.holds != expected for one in found if one.target in spoken):
        evidence = evidence._replace(first="", last="")
        found = ()
    if not (evidence.old or evidence.new or evidence.first or evidence.last or evidence.source or found):
        return None
    return evidence._replace(targets=found)


def holds_on(evidence: Evidence, target: DistroTarget, providers: Providers) -> bool | None:
    """Whether a change is in force on a target; None when that is not known."""
    found = _make_target_state(evidence, target, providers)
    return None if found is None else found.holds


def find_arrival(side: str, name: str, package: str, target: DistroTarget, providers: Providers) -> str:
    """ISO day on which a target's distro first had something of a package: that of its first release where all stored
    versions have it; empty where that is not known. side: as of Evidence, with `executable`."""
    line = load_shipped().find_line(package, target.ros)
    events = line.events.get(side, {}).get(name) if line is not None else None
    if line is not None and not events:
        return target.find_first_day(package)
    evidence = Evidence(package, "added", name, side=side, stored=bool(events), header=name if side == "header" else "")
    day = _find_first_day(evidence, target, True, providers)
    # What a distro had when it was announced came with the package, before.
    return target.find_first_day(package) if day and day <= release_day(target.distro) else day


def _make_target_state(evidence: Evidence, target: DistroTarget, providers: Providers) -> OnTarget | None:
    # Of a library, only rows that were read from packages tell the last version before.
    version = find_version(evidence.package, evidence.library, target, bool(evidence.last))
    if not version or not (evidence.first or evidence.new_in or evidence.header):
        return None
    holds = _holds(evidence, version, target, providers)
    if holds is None:
        return None
    return OnTarget(target.name, version, holds, _find_first_day(evidence, target, holds, providers))


def _holds(evidence: Evidence, version: str, target: DistroTarget, providers: Providers) -> bool | None:
    """Whether a change is in force in a version that a target has, or had; None when that is not known."""
    if evidence.stored:
        line = load_shipped().find_line(evidence.package, target.ros)
        return _holds_by(line, evidence, version) if line is not None else None
    if evidence.header:
        there = providers.has_header(evidence.package, evidence.header, target.distro, version)
        if there is not None:
            return there == (evidence.change == "added")
    distros = dict(evidence.new_in)
    if target.distro in distros:
        first = distros[target.distro]
        return bool(first) and is_at_least(version, first)
    if evidence.library and evidence.last and parse(evidence.last) < parse(version) < parse(evidence.first):
        return None  # between two packaged versions
    return has_reached(evidence.first, version, target) if evidence.first else None


def _holds_by(line: Line, evidence: Evidence, version: str) -> bool | None:
    """The same by the stored versions. One that is not stored is taken to be like the stored one that shares its first
    two numbers; else it is known where its stored neighbours agree."""
    place = line.find_place(version)
    events = line.events.get(evidence.side, {}).get(evidence.name)
    if place is None or not events:
        return None
    near = [at for at in (place, place + 1) if at < len(line.versions)]
    alike = [at for at in near if parse(line.versions[at])[:2] == parse(version)[:2]]
    asked = alike[:1] or near
    held = {_holds_at(evidence, events, line, at) for at in asked}
    return held.pop() if len(held) == 1 else None


def _holds_at(evidence: Evidence, events: tuple[ChangeEvent, ...], line: Line, place: int) -> bool:
    if evidence.change in ("changed", "deprecated"):
        return is_at_least(line.versions[place], evidence.first)
    return find_standing(evidence.side, events, place).there == (evidence.change == "added")


def _find_first_day(evidence: Evidence, target: DistroTarget, holds: bool, providers: Providers) -> str:
    released = release_day(target.distro)
    if evidence.library:
        return released if holds and target.was_added_with_release(evidence.package) else ""
    if target.is_overridden(evidence.package):
        return ""

    if holds and target.distro == "rolling" and evidence.first in DISTROS:
        return ""  # such a bound is only known to hold from a release on
    # Before its announced release a distro is being made.
    begin = released if target.distro != "rolling" else ""
    since, unknown, met = "", False, False
    for day, version in target.list_arrivals(evidence.package):
        there = _holds(evidence, version, target, providers) if version is not None else None
        # Rolling has no day on which it began: what its first version had, nobody there has seen otherwise.
        always, met = there and not met and target.distro == "rolling", met or version is not None
        if there is None:
            unknown = version is not None
        elif not there:
            since, unknown = "", False
        elif not since:
            # Which of the versions before brought it, is not known; before the release nobody cares.
            since = max(day, begin) if not always and (not unknown or day <= begin) else "?"
    return since.rstrip("?")
