"""In words, what guards ask for that they did not, and what they ask for no longer."""

import re
from collections.abc import Callable, Iterable, Sequence
from itertools import takewhile

from .guard_terms import Conjunct, Term, list_names

_LONGEST = 100
_MOST = 4
_MOST_WAYS = 3
_AROUND = 3
_BLOCKS = ("macro ", "catch ")

_COMPARED = re.compile(r"\w+ ?(?:<|!=)")
"""The condition of a loop as it is written, and no head of one."""

Asked = Callable[[Sequence[Conjunct], Conjunct], bool]
"""Whether some pieces together already ask for another."""


def describe_change(before: Sequence[Conjunct], after: Sequence[Conjunct], asked: Asked) -> str:
    """One clause about two conjunctions; empty when there is nothing to tell. asked: see Asked."""
    removed, added = _exclude_pieces(before, after), _exclude_pieces(after, before)
    clauses: list[str] = []
    for piece in list(added):
        other = next((other for other in removed if _is_other_form(other.term, piece.term)), None)
        other = other or next((other for other in removed if _is_alternative(other, piece, asked)), None)
        if other is not None:
            removed.remove(other)
            added.remove(piece)
            clauses.append(describe_replacement(other.text, piece.text))
    removed = [piece for piece in removed if not asked(after, piece)]
    added = [piece for piece in added if not asked(before, piece)]
    if len(removed) == len(added) == 1 and not clauses and _is_block(added[0]) == _is_block(removed[0]):
        return describe_replacement(removed[0].text, added[0].text)
    more = " too" if before else ""
    for words, pieces, end in (
        ("only when", [piece for piece in added if not _is_block(piece)], more),
        ("only inside", list(filter(_is_block, added)), more),
        ("no longer asks for", [piece for piece in removed if not _is_block(piece)], ""),
        ("no longer inside", list(filter(_is_block, removed)), ""),
    ):
        clauses += [f"{words} {_format_pieces(pieces)}{end}"] if pieces else []
    return ", ".join(clauses)


def describe_ways(before: Sequence[Sequence[Conjunct]], after: Sequence[Sequence[Conjunct]], asked: Asked) -> str:
    """One clause about ways that lead to a statement."""
    old_ways, new_ways = {_collect_terms(way) for way in before}, {_collect_terms(way) for way in after}
    removed = [way for way in before if _collect_terms(way) not in new_ways]
    added = [way for way in after if _collect_terms(way) not in old_ways]
    if len(removed) == len(added) == 1:
        return describe_change(removed[0], added[0], asked)
    if removed and added:
        in_old, in_new = (frozenset.intersection(*map(_collect_terms, ways)) for ways in (removed, added))
        if {_collect_terms(way) - in_old for way in removed} == {_collect_terms(way) - in_new for way in added}:
            # All ways changed alike.
            return describe_change(_select_pieces(removed[0], in_old), _select_pieces(added[0], in_new), asked)
        # What all of them ask for is not what changed.
        shared = frozenset.intersection(*map(_collect_terms, (*removed, *added)))
        removed, added = ([[p for p in way if p.term not in shared] for way in ways] for ways in (removed, added))
        if removed == [[]]:
            return f"only when {_format_alternatives(added)} too"
        if added == [[]]:
            return f"no longer asks for {_format_alternatives(removed)}"
        if [] in added and [] not in removed:
            return f"also without {_format_alternatives(removed)}"
    clauses = [*_format_way_clauses("also", added), *_format_way_clauses("no longer", removed)]
    return ", ".join(clauses)


def _select_pieces(way: Sequence[Conjunct], terms: frozenset[Term]) -> list[Conjunct]:
    return [piece for piece in way if piece.term in terms]


def _format_alternatives(ways: Sequence[Sequence[Conjunct]]) -> str:
    listed = _limit_texts(_format_pieces(way) for way in ways)
    return ", or ".join(listed) if any(len(way) > 1 for way in ways) else " or ".join(listed)


def _format_way_clauses(verb: str, ways: Sequence[Sequence[Conjunct]]) -> list[str]:
    """Clauses about ways; of many the first, and how many more there are."""
    said = list(dict.fromkeys(f"{verb} {_format_way(way)}" for way in ways))
    if len(said) > _MOST_WAYS:
        said = [*said[: _MOST_WAYS - 1], f"{verb} on {len(said) - _MOST_WAYS + 1} more ways"]
    return said


def _format_way(way: Sequence[Conjunct]) -> str:
    return f"when {_format_pieces(way)}" if way else "without any condition"


def _collect_terms(way: Sequence[Conjunct]) -> frozenset[Term]:
    return frozenset(piece.term for piece in way)


def _exclude_pieces(pieces: Sequence[Conjunct], others: Sequence[Conjunct]) -> list[Conjunct]:
    """The pieces that the others have not, each once."""
    known = {piece.term for piece in others}
    result: list[Conjunct] = []
    for piece in pieces:
        if piece.term not in known:
            known.add(piece.term)
            result.append(piece)
    return result


def describe_replacement(old: str, new: str) -> str:
    """What one condition became; of long ones the part that differs, with a few words around it."""
    was, now = old.split(" "), new.split(" ")
    if max(len(old), len(new)) > _LONGEST:
        start = sum(1 for _ in takewhile(_is_same, zip(was, now, strict=False)))
        same = sum(1 for _ in takewhile(_is_same, zip(was[start:][::-1], now[start:][::-1], strict=False)))
        was, now = _cut_words(was, start, same), _cut_words(now, start, same)
    return f"{_quote_text(' '.join(now))} was {_quote_text(' '.join(was))}"


def _is_same(pair: tuple[str, str]) -> bool:
    return pair[0] == pair[1]


def _cut_words(words: list[str], start: int, end: int) -> list[str]:
    """The words without those of a beginning and an end that are too far from the rest."""
    first, last = max(start - _AROUND, 0), min(len(words) - end + _AROUND, len(words))
    return ["…"] * (first > 0) + words[first:last] + ["…"] * (last < len(words))


def _is_other_form(old: Term, new: Term) -> bool:
    """Whether a condition is about what another one was about, as far as names tell."""
    was, now = _collect_names(old), _collect_names(new)
    if was == now:
        return bool(was)
    return _get_kind(old) == _get_kind(new) in ("and", "or", "compare") and bool(was & now)


def _is_alternative(old: Conjunct, new: Conjunct, asked: Asked) -> bool:
    """Whether one of two conditions is the other one with an alternative."""
    either = any(_get_kind(one.term) == ("and" if one.term.kind == "not" else "or") for one in (old, new))
    return either and (asked([old], new) or asked([new], old))


def _collect_names(term: Term) -> frozenset[str]:
    """The names in a condition that are no constants."""
    return frozenset(name for name in list_names(term) if not name.rpartition("::")[2].isupper())


def _get_kind(term: Term) -> str:
    return term.parts[0].kind if term.kind == "not" else term.kind


def _is_block(piece: Conjunct) -> bool:
    term = piece.term
    if term.kind == "each":
        return not _COMPARED.match(piece.text)
    return term.kind == "opaque" and term.text.startswith(_BLOCKS)


def _format_pieces(pieces: Sequence[Conjunct]) -> str:
    quoted = _limit_texts(_quote_text(piece.text) for piece in pieces)
    return " and ".join(([", ".join(quoted[:-1])] if quoted[:-1] else []) + quoted[-1:])


def _limit_texts(texts: Iterable[str]) -> list[str]:
    """Each once; of many the first, and how many more there are."""
    every = list(dict.fromkeys(texts))
    return every if len(every) <= _MOST else [*every[: _MOST - 1], f"{len(every) - _MOST + 1} more"]


def _quote_text(text: str) -> str:
    return f"`{text if len(text) <= _LONGEST else text[: _LONGEST - 1] + '…'}`"
