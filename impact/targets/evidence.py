"""What a finding about a changed name rests on: how it was and is, between which versions, and since when on whom.

A rule gives what holds for everybody (`Evidence` without targets); `seen_on` adds, of every target asked for, whether
the change is in force there and on which day its distro got it, told by the shipped history of releases.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cache
from typing import Literal, NamedTuple

from .changes import DISTROS, Row, all_rows, reached, version_of
from .distro import DistroTarget, known_distros, releases
from .providers import Providers
from .target import Change, Target
from .uses import all_uses
from .version import at_least

What = Literal["removed", "added", "changed", "deprecated"]


class OnTarget(NamedTuple):
    """A change as one target has it.

    version: of the package or library there, empty when not known. holds: whether the change is in force there. since:
    ISO day on which its distro got the change, be it before or after the target's own day; empty when it has not, or
    that is not known.
    """

    target: str
    version: str
    holds: bool
    since: str = ""


class Evidence(NamedTuple):
    """The change that a finding rests on.

    package: a ROS package or, where library is set, a platform library. change: removed, added, changed or deprecated.
    name: what is used; instead: the other spelling, where there is one that some versions take: the new one of a name
    that was removed, the old one of a name that was added. language: `cpp`, `python`, `cmake` or `header`.
    old, new: the declarations before and since, a line each, one for each overload; empty where none is recorded. last,
    first: the last version before the change and the first with it, as far as they are known; first may be a bound as
    in changes.Row. source: what says so, for rows that a person wrote. new_in: where `first` does not tell, distro to
    the first version with the change (empty: never there). header: an include path whose presence in a release of the
    package decides instead, where that is known. ahead: the finding is about what is to come on its targets. other:
    the same about `instead`, where it is known. targets: see seen_on().
    """

    package: str
    change: str
    name: str = ""
    instead: str = ""
    language: str = ""
    old: tuple[str, ...] = ()
    new: tuple[str, ...] = ()
    last: str = ""
    first: str = ""
    library: bool = False
    source: str = ""
    new_in: tuple[tuple[str, str], ...] = ()
    header: str = ""
    ahead: bool = False
    other: Evidence | None = None
    targets: tuple[OnTarget, ...] = ()


# -- from the reviewed tables ------------------------------------------------------------------------------------------


def evidence_of(change: Change, *, ahead: bool = False) -> Evidence:
    """The evidence for a known change of changes.py or uses.py. ahead: it is still to come where it is told."""
    return _evidence_of(change)._replace(ahead=ahead)


def _evidence_of(change: Change) -> Evidence:
    row = _rows().get((change.kind, change.package, change.old))
    if row is not None:
        return _of_row(row, change.state)
    use = _uses().get(change.old) if change.kind == "call-changed" else None
    what = _WHAT.get(change.state, "removed")
    if use is None:
        return Evidence(change.package, what, library=change.library, source=change.source)
    first = use.new_since if change.state == "absent" else use.removed_in
    return Evidence(use.package, what, use.label, language=use.pattern.language,
                    last=_before(first, use.library, use.source, use.package), first=first, library=use.library,
                    source=use.source)  # fmt: skip


_WHAT = {"absent": "added", "deprecated": "deprecated"}
_LANGUAGES = {"header": "header", "python": "python", "cmake": "cmake", "api": "cpp"}


def _of_row(row: Row, state: str) -> Evidence:
    if state == "deprecated":
        return _gone(row)._replace(change="deprecated", last="", first=row.deprecated_in, header="")
    here, other = (_new(row), _gone(row)) if state == "absent" else (_gone(row), _new(row))
    known = other.name and not row.back_in and (other.first or other.new_in or other.header)
    return here._replace(other=other) if known else here


def _gone(row: Row) -> Evidence:
    """That the old name went."""
    language = _LANGUAGES.get(row.kind.partition("-")[0], "")
    # Where an old name came back, no one version tells who has it.
    first = "" if row.back_in else row.removed_in
    return Evidence(row.package, "changed" if row.kind == "api-changed" else "removed", row.old, row.new, language,
                    last=_before(first, row.library, row.source, row.package), first=first, library=row.library,
                    source=row.source, header="" if row.library or language != "header" else row.old)  # fmt: skip


def _new(row: Row) -> Evidence:
    """That the new name came."""
    gone = _gone(row)
    return Evidence(row.package, "added", row.new, row.old, gone.language, first=row.new_since, library=row.library,
                    source=row.source, new_in=tuple(row.new_in.items()),
                    header=row.new if gone.header else "")  # fmt: skip


def _before(first: str, library: bool, source: str, package: str) -> str:
    """The newest released version before one, for rows that were made by comparing one release with the next."""
    if library or not first[:1].isdigit() or not source.startswith("release tags of"):
        return ""
    return released_before(package, first)


@cache
def released_before(package: str, version: str) -> str:
    """The highest version of a ROS package below this one that a distro of the same generation ever had. Empty when
    none had one, or none this version, so that the generation is not known."""
    released = releases(package)
    generations = {ros for ros, other in released if other == version}
    best = ""
    for ros, other in released if len(generations) == 1 else ():
        if ros in generations and not at_least(other, version) and (not best or at_least(other, best)):
            best = other
    return best


@cache
def _rows() -> dict[tuple[str, str, str], Row]:
    # An absent name is known by its new spelling too, and the change keeps the old one.
    return {(row.kind, row.package, row.old): row for row in all_rows()}


@cache
def _uses():
    return {use.label: use for use in all_uses()}


# -- on the targets asked for ------------------------------------------------------------------------------------------


def seen_on(
    evidence: Evidence, targets: Sequence[Target], spoken_of: Iterable[str], providers: Providers
) -> Evidence | None:
    """The evidence with how each target stands to it, in the order given; targets that lack the package or library, or
    have it in an unknown version, are left out.

    spoken_of: names of the targets that the finding holds for. Where what is known of the versions contradicts the
    finding, versions and days are left out rather than shown; None when nothing remains.
    """
    evidence = _with_version(evidence, providers)
    found = tuple(one for target in targets if (one := _on(evidence, target, providers)) is not None)
    spoken = frozenset(spoken_of)
    expected = (evidence.change != "added") != evidence.ahead
    if any(one.holds != expected for one in found if one.target in spoken):
        evidence = evidence._replace(first="", last="")
        found = ()
    if not (evidence.old or evidence.new or evidence.first or evidence.last or evidence.source or found):
        return None
    return evidence._replace(targets=found)


def _with_version(evidence: Evidence, providers: Providers) -> Evidence:
    """The evidence with versions instead of a distro, where the releases of rolling tell in which one a header came or
    went: whatever changes comes to rolling first."""
    if not evidence.header or evidence.first[:1].isdigit() or evidence.first == "ros2" or evidence.new_in:
        return evidence
    there: list[tuple[str, bool]] = []
    for _, version in _rolling().arrivals(evidence.package):
        has = providers.has_header(evidence.package, evidence.header, "rolling", version) if version else None
        if version and has is not None:
            there.append((version, has))
    changes = [(old, new) for old, new in zip(there, there[1:], strict=False) if old[1] != new[1]]
    if len(changes) != 1 or changes[0][1][1] != (evidence.change == "added"):
        return evidence
    (last, _), (first, _) = changes[0]
    return evidence._replace(last=last, first=first)


@cache
def _rolling() -> DistroTarget:
    return DistroTarget("rolling")


def holds_on(evidence: Evidence, target: Target, providers: Providers) -> bool | None:
    """Whether a change is in force on a target; None when that is not known."""
    found = _on(evidence, target, providers)
    return None if found is None else found.holds


def _on(evidence: Evidence, target: Target, providers: Providers) -> OnTarget | None:
    version = version_of(evidence.package, evidence.library, target)
    if not version or not (evidence.first or evidence.new_in or evidence.header):
        return None
    holds = _holds(evidence, version, target, providers)
    if holds is None:
        return None
    return OnTarget(target.name, version, holds, _since(evidence, target, holds, providers))


def _holds(evidence: Evidence, version: str, target: Target, providers: Providers) -> bool | None:
    """Whether a change is in force in a version that a target has, or had; None when that is not known."""
    if evidence.header:
        there = providers.has_header(evidence.package, evidence.header, target.distro, version)
        if there is not None:
            return there == (evidence.change == "added")
    distros = dict(evidence.new_in)
    if target.distro in distros:
        first = distros[target.distro]
        return bool(first) and at_least(version, first)
    return reached(evidence.first, version, target) if evidence.first else None


def _since(evidence: Evidence, target: Target, holds: bool, providers: Providers) -> str:
    if not isinstance(target, DistroTarget):
        return ""
    released = _release_days().get(target.distro, "")
    if evidence.library:
        return released if holds and target.came_with_release(evidence.package) else ""
    if target.overridden(evidence.package):
        return ""

    def there(version: str) -> bool:
        return bool(_holds(evidence, version, target, providers))

    day = _first_day(target.arrivals(evidence.package), there)
    if holds and target.distro == "rolling" and evidence.first in DISTROS:
        return ""  # such a bound is only known to hold from a release on
    # Before its announced release a distro is being made.
    return max(day, released) if day and target.distro != "rolling" else day


def _first_day(arrivals: Iterable[tuple[str, str | None]], there: Callable[[str], bool]) -> str:
    """The day since which all later versions have a change; empty when the last one has not."""
    since = ""
    for day, version in arrivals:
        if version is not None:
            since = (since or day) if there(version) else ""
    return since


@cache
def _release_days() -> dict[str, str]:
    return {known.name: known.released for known in known_distros()}
