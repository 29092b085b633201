"""What happened to the conditions of a publish statement between two revisions.

    compare_ways(old, new, reading)       # "tightened", "widened", "equivalent" or "changed"
    explain_ways(old, new, reading)       # "only when `scan_received_` too"

All of it is about the same moment: a name, and a call with the same arguments, has the same value wherever it stands in
the two conditions. That calls have effects and that variables are assigned between two guards is not seen, save where
guards would then contradict each other: nothing but what stands in both is then known of them.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from typing import Literal, NamedTuple

from ...edges.groups import group_pairs
from ..model.flow.graph import GuardAt
from .guard_reading import Language, collect_pieces, drop_this
from .guard_solver import Solver, Undecided
from .guard_terms import FALSE, TRUE, Conjunct, Term, join, list_names, rewrite
from .guard_words import describe_replacement, describe_ways

Kind = Literal["tightened", "widened", "equivalent", "changed"]
Guards = Sequence[GuardAt]
Ways = Sequence[Guards]
_WORDS_JOINED = re.compile(r"[._]")
_Side = tuple[tuple[Conjunct, ...], ...]

MILLISECONDS = 100
"""What each of the few questions to z3 may take, on any machine the same work."""


class NameReading(NamedTuple):
    """How the names in two conditions are to be understood. renames: identifiers of the old revision that are called
    otherwise in the new one."""

    renames: Mapping[str, str]
    language: Language


def compare_ways(old: Ways, new: Ways, reading: NameReading) -> Kind:
    """What happened to the guards of a statement, of each of the ways that lead to it outermost first: it runs when all
    of one way hold; `changed` when the time was not enough."""
    if not reading.renames and _collect_texts(old) == _collect_texts(new):
        return "equivalent"
    before, after, solver = _build_sides(old, new, reading)
    if _collect_terms(before) == _collect_terms(after):
        return "equivalent"
    try:
        forward, backward, possible = solver().compare(_join_ways(before), _join_ways(after))
        if not possible and not all(_is_settled(side, solver) for side in (before, after)):
            forward, backward, _ = solver().compare(_join_ways(before, _make_opaque), _join_ways(after, _make_opaque))
    except Undecided:
        return "changed"
    if forward and backward:
        return "equivalent"
    if forward and backward is False:
        return "tightened"
    return "widened" if backward and forward is False else "changed"


def explain_ways(old: Ways, new: Ways, reading: NameReading) -> str:
    """One clause that tells people what was added or removed, with code in backticks: "only when `a` too", "no longer
    asks for `x > 3`", "`x > 3` was `x > 0`"; empty when the two say the same."""
    if compare_ways(old, new, reading) == "equivalent":
        return ""
    replaced = _find_replaced(old, new)
    if replaced is not None:
        return describe_replacement(*replaced)
    before, after, solver = _build_sides(old, new, reading)

    def is_implied(pieces: Sequence[Conjunct], piece: Conjunct) -> bool:
        try:
            forward, _, possible = solver().compare(piece.term, _join_pieces(pieces))
        except Undecided:
            return False
        return forward is True and possible

    return describe_ways(before, after, is_implied)


def is_impossible(guards: Guards, language: Language) -> bool:
    """Whether guards contradict each other. That tells that the statement never runs only where nothing they name is
    assigned between them."""
    pieces = collect_pieces(guards, language, {})
    try:
        return not Solver(language, MILLISECONDS).is_possible(_join_pieces(pieces))
    except Undecided:
        return False


def is_unlikely(guard: GuardAt, language: Language) -> bool:
    """Whether a guard cannot hold when different constants are different."""
    pieces = collect_pieces([guard], language, {})
    try:
        return not Solver(language, MILLISECONDS).is_likely(_join_pieces(pieces))
    except Undecided:
        return False


def _find_replaced(old: Ways, new: Ways) -> tuple[str, str] | None:
    """The one condition that differs, before and after, where some ways ask for it and others for its contrary; None
    where more differs."""
    sides = [{(guard.kind, guard.text) for way in ways for guard in way} for ways in (old, new)]
    both = [{text for kind, text in side if kind == "if" and ("unless", text) in side} for side in sides]
    gone, come = both[0] - {text for _, text in sides[1]}, both[1] - {text for _, text in sides[0]}
    if len(gone) != 1 or len(come) != 1:
        return None
    was, is_now = gone.pop(), come.pop()
    changed = frozenset(
        tuple((kind, is_now if text == was else text) for kind, text in way) for way in _collect_texts(old)
    )
    return (was, is_now) if changed == _collect_texts(new) else None


def _collect_texts(ways: Ways) -> frozenset[tuple[tuple[str, str], ...]]:
    return frozenset(tuple((guard.kind, guard.text) for guard in way) for way in ways)


def _build_sides(old: Ways, new: Ways, reading: NameReading) -> tuple[_Side, _Side, Callable[[], Solver]]:
    """Both sides as terms, and what makes a solver for them."""
    before = tuple(collect_pieces(way, reading.language, reading.renames) for way in old)
    after = tuple(collect_pieces(way, reading.language, {}) for way in new)
    if reading.language == "cpp":
        before, after = drop_this((before, after))
    before = _follow_moves(before, after)
    return before, after, lambda: Solver(reading.language, MILLISECONDS)


def _follow_moves(before: _Side, after: _Side) -> _Side:
    """The old side with members named as the new one does that have moved into an object inside theirs, or out of one:
    `planner.ready` and `planner.state.ready`, where each side has but one of them."""
    before = _follow_getters(before, after)
    was, is_now = _collect_paths(before, after), _collect_paths(after, before)
    moves = _pair_constants(was - is_now, is_now - was)
    for old in was - is_now:
        new = [name for name in is_now - was if _is_moved(old, name)]
        if len(new) == 1 and sum(_is_moved(other, new[0]) for other in was - is_now) == 1:
            moves[old] = new[0]
    if not moves:
        return before

    def change(term: Term) -> Term | None:
        return Term("name", moves[term.text]) if term.kind == "name" and term.text in moves else None

    return tuple(tuple(piece._replace(term=rewrite(piece.term, change)) for piece in way) for way in before)


def _follow_getters(before: _Side, after: _Side) -> _Side:
    """The old side with members that the new one asks by a method of their name, or the other way round."""
    (was_asked, was_read), (asked, read) = _collect_asked(before), _collect_asked(after)
    turned = {**_select_turned(was_asked, was_read, read, asked), **_select_turned(was_read, was_asked, asked, read)}
    if not turned:
        return before

    def change(term: Term) -> Term | None:
        if _is_getter(term) and _strip(term.parts[0].text) in turned:
            return Term("name", turned[_strip(term.parts[0].text)])
        if term.kind == "name" and "." in term.text and _strip(term.text) in turned:
            return Term("call", "", (Term("name", turned[_strip(term.text)]),))
        return None

    return tuple(tuple(piece._replace(term=rewrite(piece.term, change)) for piece in way) for way in before)


def _select_turned(
    old: Mapping[str, str], old_others: Mapping[str, str], new: Mapping[str, str], new_others: Mapping[str, str]
) -> dict[str, str]:
    """Paths of one kind that are of the other kind now, as they are written now; by what they are without underscores.
    """
    turned = (old.keys() - old_others.keys()) & (new.keys() - new_others.keys())
    return {path: new[path] for path in turned}


def _collect_asked(side: _Side) -> tuple[dict[str, str], dict[str, str]]:
    """The paths that are called without arguments, and those that are read; by what they are without underscores."""
    called: dict[str, str] = {}
    read: dict[str, str] = {}
    waiting = [piece.term for way in side for piece in way]
    while waiting:
        term = waiting.pop()
        if _is_getter(term):
            called[_strip(term.parts[0].text)] = term.parts[0].text
            continue
        if term.kind == "name" and "." in term.text:
            read[_strip(term.text)] = term.text
        waiting.extend(term.parts)
    return called, read


def _strip(path: str) -> str:
    """A path without underscores that mark a member."""
    return path.rstrip("_")


def _is_getter(term: Term) -> bool:
    return term.kind == "call" and len(term.parts) == 1 and term.parts[0].kind == "name" and "." in term.parts[0].text


def _pair_constants(gone: frozenset[str], come: frozenset[str]) -> dict[str, str]:
    """Constants that another scope has now, by their names: each the only one of its name."""
    sides = [group_pairs((name.rpartition("::")[2], name) for name in names if "::" in name) for names in (gone, come)]
    return {
        names[0]: sides[1][last][0]
        for last, names in sides[0].items()
        if last[:1].isupper() and len(names) == len(sides[1].get(last, ())) == 1
    }


def _collect_paths(side: _Side, other: _Side) -> frozenset[str]:
    """The paths of a side, and names that have the words of a path of the other side."""
    sides = [{name for way in one for piece in way for name in list_names(piece.term)} for one in (side, other)]
    joined = {_WORDS_JOINED.sub("", name) for name in sides[1] if "." in name}
    return frozenset(name for name in sides[0] if "." in name or "::" in name or _WORDS_JOINED.sub("", name) in joined)


def _is_moved(one: str, other: str) -> bool:
    """Whether two paths begin and end alike, and one has all of the other besides; or have the same words, however
    these are joined."""
    if _WORDS_JOINED.sub("", one) == _WORDS_JOINED.sub("", other) and one.count(".") != other.count("."):
        return True
    long, short = sorted((one.split("."), other.split(".")), key=len, reverse=True)
    if len(long) == len(short) or (long[0], long[-1]) != (short[0], short[-1]) or long[:2] == ["this", short[-1]]:
        return False
    rest = iter(long)
    return all(part in rest for part in short) and (short[0] != "this" or len(short) > 2)


def _collect_terms(side: _Side) -> frozenset[frozenset[Term]]:
    return frozenset(frozenset(piece.term for piece in way) for way in side)


def _is_settled(side: _Side, solver: Callable[[], Solver]) -> bool:
    """Whether a side can hold, or does not since on each way one guard contradicts itself: nothing is assigned within
    a guard. Raises Undecided."""
    if solver().is_possible(_join_ways(side)):
        return True
    for way in side:
        guards = [[piece for piece in way if piece.guard == place] for place in {piece.guard for piece in way}]
        if all(solver().is_possible(_join_pieces(pieces)) for pieces in guards):
            return False
    return True


def _make_opaque(term: Term) -> Term:
    """The term as something of which nothing is known."""
    return Term("op", "whole", (term,))


def _keep_term(term: Term) -> Term:
    return term


def _join_pieces(pieces: Sequence[Conjunct], seen=_keep_term) -> Term:
    return join("and", [seen(piece.term) for piece in pieces]) if pieces else TRUE


def _join_ways(side: _Side, seen=_keep_term) -> Term:
    return join("or", [_join_pieces(way, seen) for way in side]) if side else FALSE
