"""Findings about what is there and will be gone: one treatment for all rules.

What goes with the next sync breaks in the build farm already, and counts as if it were gone. What goes with a later
update, or on the newest platform, is worth one warning for each thing that changes (a package or library, or a header
of it): its first place by what breaks first. The rest are notes, and so is what only a distro further ahead lacks.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from ..targets.symbol import Horizon
from .rule import Diagnostic
from .severity import Doubt, Repeats, severity


class Upcoming(NamedTuple):
    """A diagnostic of something that is still there. changed: what one warning is enough of. order: what breaks first
    comes first."""

    diagnostic: Diagnostic
    changed: str
    horizon: Horizon
    order: tuple = ()


def rate_upcoming(found: Iterable[Diagnostic | Upcoming]) -> Iterator[Diagnostic]:
    """The diagnostics of one package, those of what is upcoming last and with their severities."""
    every: list[Upcoming] = []
    for one in found:
        if isinstance(one, Upcoming):
            every.append(one)
        else:
            yield one
    repeats = Repeats()
    severities: dict[int, str] = {}
    for number, one in sorted(enumerate(every), key=lambda entry: (entry[1].order, entry[0])):
        doubts = one.diagnostic.doubts
        if one.horizon.soon:
            severities[number] = severity(*doubts)
        else:
            late = Doubt.FAR if one.horizon.far else Doubt.UPCOMING
            severities[number] = repeats.severity(one.changed, *doubts, late)
    for number, one in enumerate(every):
        evidence = one.diagnostic.evidence
        evidence = evidence._replace(ahead=True) if evidence is not None else None
        yield one.diagnostic._replace(severity=severities[number], evidence=evidence)
