"""What each kind of guard says, as pieces that must all hold."""

import re
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Literal

from ..model.flow.graph import GuardAt
from . import guard_cpp, guard_python
from .guard_terms import (
    FALSE,
    Conjunct,
    GuardReading,
    Term,
    define,
    find_elements,
    join,
    list_names,
    make_place,
    negate,
    rebuild_term,
    rename_term,
    rewrite,
    split_outside,
    split_owner,
    substitute_names,
)
from .meaning import PARAMETER

Language = Literal["cpp", "python"]
_PARAMETER = re.compile(rf"(\w+?){PARAMETER}(\d+)")
_PLACE = re.compile(r"[A-Za-z]\w*(?<!_)")
"""A variable that is no member, as far as the name tells."""


def collect_pieces(way: Sequence[GuardAt], language: Language, renames: Mapping[str, str]) -> tuple[Conjunct, ...]:
    """All that must hold on one way, outermost first, with variables of loops and conditions put back into what they
    stand for."""
    result: list[Conjunct] = []
    names: dict[str, dict[str, Term]] = {}
    for place, guard in enumerate(way):
        known = names.setdefault(guard.of, {})
        reading = read(language, guard.kind, guard.text)
        for piece in reading.pieces:
            term = find_elements(substitute_names(piece.term, known)) if known else piece.term
            if renames:
                term = rename_term(term, renames)
            text = piece.text
            if PARAMETER in text:
                term, text = rewrite(term, _drop_parameter_name), _PARAMETER.sub(r"\1", text)
            if term.kind != "true":
                result.append(Conjunct(text, term, place))
        for name, value in reading.names:
            define(known, name, value)
    return tuple(result)


def _drop_parameter_name(term: Term) -> Term | None:
    """A parameter by its place alone."""
    if term.kind in ("name", "opaque") and PARAMETER in term.text:
        return Term(term.kind, _PARAMETER.sub(r"parameter \2", term.text), term.parts)
    return None


def drop_this(sides: Sequence[Sequence[Sequence[Conjunct]]]) -> tuple[tuple[tuple[Conjunct, ...], ...], ...]:
    """C++ sides (of ways, of pieces) with `this->x` as `x`, unless one side has both."""
    for side in sides:
        named = {name for way in side for piece in way for name in list_names(piece.term)}
        ours = {name.removeprefix("this.").partition(".")[0] for name in named if name.startswith("this.")}
        if any(name.partition(".")[0] in ours for name in named):
            return tuple(tuple(tuple(way) for way in side) for side in sides)
    return tuple(
        tuple(tuple(piece._replace(term=_strip_this(piece.term)) for piece in way) for way in side) for side in sides
    )


def _strip_this(term: Term) -> Term:
    if term.kind == "name" and term.text.startswith("this."):
        return Term("name", term.text.removeprefix("this."))
    if not term.parts:
        return term
    return rebuild_term(term.kind, term.text, tuple(map(_strip_this, term.parts)))


@lru_cache(16384)
def read(language: Language, kind: str, text: str) -> GuardReading:
    """One guard by itself; kind and text as in facts."""
    reader = guard_cpp if language == "cpp" else guard_python
    if kind in ("if", "while"):
        reading = reader.parse_condition(text, True)
        return _read_walk(reading) if kind == "while" and language == "cpp" else reading
    if kind == "unless":
        if re.match(r"(?:catch|except)\b", text):
            return GuardReading((Conjunct(f"no {text}", negate(_parse_caught(text))),))
        return reader.parse_condition(text, False)
    if kind == "cpp":
        return guard_cpp.parse_directive(text, True)
    if kind == "case":
        return read_case(language, text)
    if kind == "for":
        return reader.loop(text)
    if kind in ("do", "with", "passed"):
        # What runs once at least, inside a context, or where something raised leads nowhere, runs under no condition.
        return GuardReading()
    if kind == "never":
        return GuardReading((Conjunct(f"never: {text}", FALSE),))
    if kind == "catch":
        return GuardReading((Conjunct(f"catch ({text})", _parse_caught(text)),))
    return GuardReading((Conjunct(text, Term("opaque", f"{kind} {' '.join(text.split())}")),))


def _read_walk(reading: GuardReading) -> GuardReading:
    """The condition of a loop that walks through a container, as one that says that there is an element:
    `it != v.end()` and `i < v.size()`, as `for (auto& one : v)`."""
    if len(reading.pieces) != 1 or reading.names:
        return reading
    piece = reading.pieces[0]
    term = piece.term.parts[0] if piece.term.kind == "not" else piece.term
    operator = "!=" if piece.term.kind == "not" and term.text == "==" else term.text
    if term.kind != "compare" or operator not in ("!=", "<"):
        return reading
    for place, end in (term.parts, term.parts[::-1]) if operator == "!=" else (term.parts,):
        if place.kind != "name" or not _PLACE.fullmatch(place.text):
            continue
        if end.kind == "size":
            element = Term("each", "", end.parts)
            return GuardReading((piece._replace(term=element),), ((place.text, make_place(end.parts[0])),))
        owner, method = split_owner(end.parts[0]) if end.kind == "call" and len(end.parts) == 1 else (None, "")
        if owner is not None and operator == "!=" and method in ("end", "cend", "rend", "crend"):
            element = Term("each", "", (owner,))
            return GuardReading((piece._replace(term=element),), ((place.text, element),))
    return reading


def _parse_caught(text: str) -> Term:
    """That an exception was caught; the text is what is caught, alone or after `catch` or `except`."""
    match = re.match(r"catch\s*\((.*)\)$|except\b(.*)", text.strip())
    inside = match[1] or match[2] or "" if match else text
    return guard_cpp.make_caught_term(re.sub(r"\s+as\s+\w+$", "", inside.strip()))


def read_case(language: Language, text: str) -> GuardReading:
    """`subject == a or b` or `subject other than a, b`."""
    subject, other, values = text.partition(" other than ")
    if other:
        named = _split(values, ",")
    else:
        subject, _, values = text.partition(" == ")
        named = _split(values, " or ")
    reader = guard_cpp if language == "cpp" else guard_python
    asked = reader.parse_expression(subject)
    alternatives: list[Term] = []
    names: tuple[tuple[str, Term], ...] = ()
    for value in named:
        # Where each value comes with the subject again.
        value = value.removeprefix(f"{subject} == ")
        if language == "python":
            reading = guard_python.parse_case_pattern(asked, value)
            alternatives.append(reading.pieces[0].term)
            names += reading.names
        else:
            alternatives.append(_build_case_term(asked, value))
    if not alternatives:
        return GuardReading()
    term = join("or", alternatives)
    return GuardReading((Conjunct(text, negate(term) if other else term),), () if other else names)


def _build_case_term(subject: Term, value: str) -> Term:
    first, dots, last = value.partition(" ... ")
    if dots:
        low, high = guard_cpp.parse_expression(first), guard_cpp.parse_expression(last)
        return join("and", (guard_cpp.compare("<=", low, subject), guard_cpp.compare("<=", subject, high)))
    return guard_cpp.compare("==", subject, guard_cpp.parse_expression(value))


_QUOTED = r"\"(?:[^\"\\]|\\(?:.|\Z))*(?:\"|\Z)|'(?:[^'\\]|\\(?:.|\Z))*(?:'|\Z)"


def _split(text: str, separator: str) -> list[str]:
    """The parts of a text between separators outside brackets and quotes."""
    return [part for part in split_outside(text, separator, _QUOTED) if part]
