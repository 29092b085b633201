"""Findings about what is there and will be gone: one treatment for all rules.

What goes with the next sync breaks in the build farm already, and counts as if it were gone. What goes with a later
update, or on the newest platform, is worth one warning for each thing that changes (a package or library, or a header
of it): its first place by what breaks first. The rest are notes, and so is what only a distro further ahead lacks.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from ...targets.availability import Horizon
from ..rule import Hit
from ..severity import Doubt, Repeats, severity


class Upcoming(NamedTuple):
    """A finding without its severity. changed: what one warning is enough of. order: what breaks first comes
    first. doubts: about the place and the evidence."""

    hit: Hit
    changed: str
    horizon: Horizon
    doubts: tuple[Doubt | bool | None, ...] = ()
    order: tuple = ()


def rated_all(found: Iterable[Hit | Upcoming]) -> Iterator[Hit]:
    """The findings of one package, of which some have their severity already."""
    upcoming = []
    for one in found:
        if isinstance(one, Upcoming):
            upcoming.append(one)
        else:
            yield one
    yield from rated(upcoming)


def rated(package: Iterable[Upcoming]) -> Iterator[Hit]:
    """The findings of one package with their severities, in the order given."""
    every = list(package)
    repeats = Repeats()
    severities: dict[int, str] = {}
    for number, one in sorted(enumerate(every), key=lambda entry: (entry[1].order, entry[0])):
        if one.horizon.soon:
            severities[number] = severity(*one.doubts)
        else:
            late = Doubt.FAR if one.horizon.far else Doubt.UPCOMING
            severities[number] = repeats.severity(one.changed, *one.doubts, late)
    for number, one in enumerate(every):
        evidence = one.hit.evidence._replace(ahead=True) if one.hit.evidence is not None else None
        yield one.hit._replace(severity=severities[number], evidence=evidence)
