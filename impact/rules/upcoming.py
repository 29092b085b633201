"""Findings about what is there and will be gone: one treatment for all rules.

Nothing breaks on the target yet. What goes with the next sync, a later update or on the newest distro is worth one
warning for each package or library that changes, in the whole workspace: its first place by what breaks first. The rest
are notes, and so is what only a distro further ahead lacks.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, NamedTuple

from ..targets.symbol import Horizon
from .severity import Doubt, Together

if TYPE_CHECKING:
    from .rule import Diagnostic


class Upcoming(NamedTuple):
    """A diagnostic of something that is still there. changed: the package or library that goes without it. order: what
    breaks first comes first."""

    diagnostic: Diagnostic
    changed: str
    horizon: Horizon
    order: tuple = ()


def rate_upcoming(found: Iterable[Diagnostic | Upcoming]) -> Iterator[Diagnostic]:
    """The diagnostics of one package, those of what is upcoming last, what breaks first before the others."""
    every: list[Upcoming] = []
    for one in found:
        if isinstance(one, Upcoming):
            every.append(one)
        else:
            yield one
    for diagnostic, changed, horizon, _ in sorted(every, key=lambda one: one.order):
        evidence = diagnostic.evidence
        diagnostic = diagnostic._replace(evidence=evidence and evidence._replace(ahead=True))
        late = Doubt.FAR if horizon.far else Doubt.UPCOMING
        together = (Together(f"{changed} of {horizon.name}", everywhere=True),)
        yield diagnostic._replace(doubts=(*diagnostic.doubts, late), together=together)
