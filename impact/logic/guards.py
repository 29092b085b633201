"""What happened to the conditions of a publish statement between two revisions.

    compare_ways(old, new)       # "tightened", "widened", "equivalent" or "changed"
    explain_ways(old, new)       # "only when `scan_received_` too"

All of it is about the same moment: a name, and a call with the same arguments, has the same value wherever it stands in
the two conditions. That calls have effects and that variables are assigned between two guards is not seen, save where
guards would then contradict each other: nothing but what stands in both is then known of them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Literal, NamedTuple

from ..model.flow.graph import GuardAt
from .guard_reading import Language, language_of, pieces_of, this_left_out
from .guard_solver import Solver, Undecided
from .guard_terms import FALSE, TRUE, Conjunct, Term, join
from .guard_words import words_of_ways

Kind = Literal["tightened", "widened", "equivalent", "changed"]
Guards = Sequence[GuardAt]
Ways = Sequence[Guards]
_Side = tuple[tuple[Conjunct, ...], ...]

MILLISECONDS = 100
_NOTHING: Mapping[str, str] = {}


class NameReading(NamedTuple):
    """How the names in two conditions are to be understood.

    renames: identifiers of the old revision that are called otherwise in the new one. language: as the guards' paths
    tell it when it is not given. milliseconds: what each of the few questions to z3 may take, on any machine the same
    work.
    """

    renames: Mapping[str, str] = _NOTHING
    language: Language | None = None
    milliseconds: int = MILLISECONDS


AS_WRITTEN = NameReading()


def compare_ways(old: Ways, new: Ways, reading: NameReading = AS_WRITTEN) -> Kind:
    """What happened to the guards of a statement, of each of the ways that lead to it outermost first: it runs when all
    of one way hold; `changed` when the time was not enough."""
    if not reading.renames and _written(old) == _written(new):
        return "equivalent"
    before, after, solver = _sides(old, new, reading)
    if _said(before) == _said(after):
        return "equivalent"
    try:
        forward, backward, possible = solver().relation(_any_way(before), _any_way(after))
        if not possible and not all(_is_settled(side, solver) for side in (before, after)):
            forward, backward, _ = solver().relation(_any_way(before, _as_whole), _any_way(after, _as_whole))
    except Undecided:
        return "changed"
    if forward and backward:
        return "equivalent"
    if forward and backward is False:
        return "tightened"
    return "widened" if backward and forward is False else "changed"


def explain_ways(old: Ways, new: Ways, reading: NameReading = AS_WRITTEN) -> str:
    """One clause that tells people what was added or removed, with code in backticks: "only when `a` too", "no longer
    asks for `x > 3`", "`x > 3` was `x > 0`"; empty when the two say the same."""
    if compare_ways(old, new, reading) == "equivalent":
        return ""
    before, after, solver = _sides(old, new, reading)

    def asked(pieces: Sequence[Conjunct], piece: Conjunct) -> bool:
        try:
            forward, _, possible = solver().relation(piece.term, _all_of(pieces))
        except Undecided:
            return False
        return forward is True and possible

    return words_of_ways(before, after, asked)


def impossible(guards: Guards, language: Language | None = None, milliseconds: int = MILLISECONDS) -> bool:
    """Whether guards contradict each other. That tells that the statement never runs only where nothing they name is
    assigned between them."""
    language = language or language_of((guards,))
    pieces = pieces_of(guards, language, _NOTHING)
    try:
        return not Solver(language, milliseconds).possible(_all_of(pieces))
    except Undecided:
        return False


def _written(ways: Ways) -> frozenset[tuple[tuple[str, str], ...]]:
    return frozenset(tuple((guard.kind, guard.text) for guard in way) for way in ways)


def _sides(old: Ways, new: Ways, reading: NameReading) -> tuple[_Side, _Side, Callable[[], Solver]]:
    """Both sides as terms, and what makes a solver for them."""
    language = reading.language or language_of((*old, *new))
    before = tuple(pieces_of(way, language, reading.renames) for way in old)
    after = tuple(pieces_of(way, language, _NOTHING) for way in new)
    if language == "cpp":
        before, after = this_left_out((before, after))
    return before, after, lambda: Solver(language, reading.milliseconds)


def _said(side: _Side) -> frozenset[frozenset[Term]]:
    return frozenset(frozenset(piece.term for piece in way) for way in side)


def _is_settled(side: _Side, solver: Callable[[], Solver]) -> bool:
    """Whether a side can hold, or does not since on each way one guard contradicts itself: nothing is assigned within
    a guard. Raises Undecided."""
    if solver().possible(_any_way(side)):
        return True
    for way in side:
        guards = [[piece for piece in way if piece.guard == place] for place in {piece.guard for piece in way}]
        if all(solver().possible(_all_of(pieces)) for pieces in guards):
            return False
    return True


def _as_whole(term: Term) -> Term:
    """The term as something of which nothing is known."""
    return Term("op", "whole", (term,))


def _as_it_is(term: Term) -> Term:
    return term


def _all_of(pieces: Sequence[Conjunct], seen=_as_it_is) -> Term:
    return join("and", [seen(piece.term) for piece in pieces]) if pieces else TRUE


def _any_way(side: _Side, seen=_as_it_is) -> Term:
    return join("or", [_all_of(way, seen) for way in side]) if side else FALSE
