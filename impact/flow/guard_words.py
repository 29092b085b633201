"""In words, what guards ask for that they did not, and what they ask for no longer."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from .guard_terms import Piece, Term, names_in

_LONGEST = 100
_MOST = 4
_BLOCKS = ("macro ", "with ", "catch ")

Asked = Callable[[Sequence[Piece], Piece], bool]
"""Whether some pieces together already ask for another."""


def words(before: Sequence[Piece], after: Sequence[Piece], asked: Asked) -> str:
    """One clause about two conjunctions; empty when there is nothing to tell. asked: see Asked."""
    removed, added = _without(before, after), _without(after, before)
    clauses: list[str] = []
    for piece in list(added):
        other = next((other for other in removed if _is_other_form(other.term, piece.term)), None)
        if other is not None:
            removed.remove(other)
            added.remove(piece)
            clauses.append(f"{_quoted(piece)} was {_quoted(other)}")
    removed = [piece for piece in removed if not asked(after, piece)]
    added = [piece for piece in added if not asked(before, piece)]
    if len(removed) == len(added) == 1 and not clauses and _is_block(added[0]) == _is_block(removed[0]):
        return f"{_quoted(added[0])} was {_quoted(removed[0])}"
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


def words_of_ways(before: Sequence[Sequence[Piece]], after: Sequence[Sequence[Piece]], asked: Asked) -> str:
    """One clause about ways that lead to a statement."""
    old_ways, new_ways = {_terms(way) for way in before}, {_terms(way) for way in after}
    removed = [way for way in before if _terms(way) not in new_ways]
    added = [way for way in after if _terms(way) not in old_ways]
    if len(removed) == len(added) == 1:
        return words(removed[0], added[0], asked)
    clauses = [f"also {_when(way)}" for way in added] + [f"no longer {_when(way)}" for way in removed]
    return ", ".join(clauses)


def _when(way: Sequence[Piece]) -> str:
    return f"when {_listed(way)}" if way else "without any condition"


def _terms(way: Sequence[Piece]) -> frozenset[Term]:
    return frozenset(piece.term for piece in way)


def _without(pieces: Sequence[Piece], others: Sequence[Piece]) -> list[Piece]:
    """The pieces that the others have not, each once."""
    known = {piece.term for piece in others}
    result: list[Piece] = []
    for piece in pieces:
        if piece.term not in known:
            known.add(piece.term)
            result.append(piece)
    return result


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


def _is_block(piece: Piece) -> bool:
    term = piece.term
    return term.kind == "each" or (term.kind == "opaque" and term.text.startswith(_BLOCKS))


def _listed(pieces: Sequence[Piece]) -> str:
    quoted = [_quoted(piece) for piece in pieces]
    if len(quoted) > _MOST:
        quoted = [*quoted[: _MOST - 1], f"{len(quoted) - _MOST + 1} more"]
    return " and ".join(([", ".join(quoted[:-1])] if quoted[:-1] else []) + quoted[-1:])


def _quoted(piece: Piece) -> str:
    text = piece.text
    return f"`{text if len(text) <= _LONGEST else text[: _LONGEST - 1] + '…'}`"
