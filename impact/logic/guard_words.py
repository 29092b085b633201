"""In words, what guards ask for that they did not, and what they ask for no longer."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import takewhile

from .guard_terms import Conjunct, Term, names_in

_LONGEST = 100
_MOST = 4
_MOST_WAYS = 3
_AROUND = 3
_BLOCKS = ("macro ", "catch ")

Asked = Callable[[Sequence[Conjunct], Conjunct], bool]
"""Whether some pieces together already ask for another."""


def words(before: Sequence[Conjunct], after: Sequence[Conjunct], asked: Asked) -> str:
    """One clause about two conjunctions; empty when there is nothing to tell. asked: see Asked."""
    removed, added = _without(before, after), _without(after, before)
    clauses: list[str] = []
    for piece in list(added):
        other = next((other for other in removed if _is_other_form(other.term, piece.term)), None)
        if other is not None:
            removed.remove(other)
            added.remove(piece)
            clauses.append(_instead(other, piece))
    removed = [piece for piece in removed if not asked(after, piece)]
    added = [piece for piece in added if not asked(before, piece)]
    if len(removed) == len(added) == 1 and not clauses and _is_block(added[0]) == _is_block(removed[0]):
        return _instead(removed[0], added[0])
    more = " too" if before else ""
    for place, pieces in (("when", [p for p in added if not _is_block(p)]), ("inside", list(filter(_is_block, added)))):
        if pieces:
            clauses.append(f"only {place} {_listed(pieces)}{more}")
    for place, pieces in (
        ("asks for", [piece for piece in removed if not _is_block(piece)]),
        ("inside", list(filter(_is_block, removed))),
    ):
        if pieces:
            clauses.append(f"no longer {place} {_listed(pieces)}")
    return ", ".join(clauses)


def words_of_ways(before: Sequence[Sequence[Conjunct]], after: Sequence[Sequence[Conjunct]], asked: Asked) -> str:
    """One clause about ways that lead to a statement."""
    old_ways, new_ways = {_terms(way) for way in before}, {_terms(way) for way in after}
    removed = [way for way in before if _terms(way) not in new_ways]
    added = [way for way in after if _terms(way) not in old_ways]
    if len(removed) == len(added) == 1:
        return words(removed[0], added[0], asked)
    if removed and added:
        in_old, in_new = (frozenset.intersection(*map(_terms, ways)) for ways in (removed, added))
        if {_terms(way) - in_old for way in removed} == {_terms(way) - in_new for way in added}:
            # All ways changed alike.
            return words(_those(removed[0], in_old), _those(added[0], in_new), asked)
        # What all of them ask for is not what changed.
        shared = frozenset.intersection(*map(_terms, (*removed, *added)))
        removed, added = ([[p for p in way if p.term not in shared] for way in ways] for ways in (removed, added))
        if removed == [[]]:
            return f"only when {_either(added)} too"
        if added == [[]]:
            return f"no longer asks for {_either(removed)}"
    clauses = [*_each_once("also", added), *_each_once("no longer", removed)]
    return ", ".join(clauses)


def _those(way: Sequence[Conjunct], terms: frozenset[Term]) -> list[Conjunct]:
    return [piece for piece in way if piece.term in terms]


def _either(ways: Sequence[Sequence[Conjunct]]) -> str:
    listed = _few(_listed(way) for way in ways)
    return ", or ".join(listed) if any(len(way) > 1 for way in ways) else " or ".join(listed)


def _each_once(verb: str, ways: Sequence[Sequence[Conjunct]]) -> list[str]:
    """Clauses about ways; of many the first, and how many more there are."""
    said = list(dict.fromkeys(f"{verb} {_when(way)}" for way in ways))
    if len(said) > _MOST_WAYS:
        said = [*said[: _MOST_WAYS - 1], f"{verb} on {len(said) - _MOST_WAYS + 1} more ways"]
    return said


def _when(way: Sequence[Conjunct]) -> str:
    return f"when {_listed(way)}" if way else "without any condition"


def _terms(way: Sequence[Conjunct]) -> frozenset[Term]:
    return frozenset(piece.term for piece in way)


def _without(pieces: Sequence[Conjunct], others: Sequence[Conjunct]) -> list[Conjunct]:
    """The pieces that the others have not, each once."""
    known = {piece.term for piece in others}
    result: list[Conjunct] = []
    for piece in pieces:
        if piece.term not in known:
            known.add(piece.term)
            result.append(piece)
    return result


def _instead(old: Conjunct, new: Conjunct) -> str:
    """What one condition became; of long ones the part that differs, with a few words around it."""
    was, now = old.text.split(" "), new.text.split(" ")
    if max(len(old.text), len(new.text)) > _LONGEST:
        start = sum(1 for _ in takewhile(_same, zip(was, now, strict=False)))
        same = sum(1 for _ in takewhile(_same, zip(was[start:][::-1], now[start:][::-1], strict=False)))
        was, now = _part(was, start, same), _part(now, start, same)
    return f"{_shown(' '.join(now))} was {_shown(' '.join(was))}"


def _same(pair: tuple[str, str]) -> bool:
    return pair[0] == pair[1]


def _part(words: list[str], start: int, end: int) -> list[str]:
    """The words without those of a beginning and an end that are too far from the rest."""
    first, last = max(start - _AROUND, 0), min(len(words) - end + _AROUND, len(words))
    return ["…"] * (first > 0) + words[first:last] + ["…"] * (last < len(words))


def _is_other_form(old: Term, new: Term) -> bool:
    """Whether a condition is about what another one was about, as far as names tell."""
    was, now = _about(old), _about(new)
    if was == now:
        return bool(was)
    return _kind(old) == _kind(new) in ("and", "or", "compare") and bool(was & now)


def _about(term: Term) -> frozenset[str]:
    """The names in a condition that are no constants."""
    return frozenset(name for name in names_in(term) if not name.rpartition("::")[2].isupper())


def _kind(term: Term) -> str:
    return term.parts[0].kind if term.kind == "not" else term.kind


def _is_block(piece: Conjunct) -> bool:
    term = piece.term
    return term.kind == "each" or (term.kind == "opaque" and term.text.startswith(_BLOCKS))


def _listed(pieces: Sequence[Conjunct]) -> str:
    quoted = _few(_shown(piece.text) for piece in pieces)
    return " and ".join(([", ".join(quoted[:-1])] if quoted[:-1] else []) + quoted[-1:])


def _few(texts: Iterable[str]) -> list[str]:
    """Each once; of many the first, and how many more there are."""
    every = list(dict.fromkeys(texts))
    return every if len(every) <= _MOST else [*every[: _MOST - 1], f"{len(every) - _MOST + 1} more"]


def _shown(text: str) -> str:
    return f"`{text if len(text) <= _LONGEST else text[: _LONGEST - 1] + '…'}`"
