"""Conditions as terms: what C++ and Python conditions become before they are compared."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from typing import NamedTuple


class Term(NamedTuple):
    """An expression. Two expressions that differ in spelling alone are the same term.

    | kind | text | parts |
    |---|---|---|
    | and, or | | the operands, those of nested ones of the same kind among them |
    | not, truth | | what is negated; what is asked for its truth as by `bool(x)` |
    | compare | `==`, `<` or `<=` | left, right; the operands of `==` in a fixed order |
    | choice | | condition, value if true, value if false |
    | true, false, null | | |
    | whole, real | the number as a fraction; real: written with a point or exponent | |
    | string | the literal as written, without prefix | |
    | name | a path: `a.b.c` (`->` is `.`, `self` and `this` are `this`), `ns::kName` | |
    | + - * | | left, right |
    | size, abs | | what is measured |
    | call | | the function, then the arguments |
    | index | | the container, then the indices |
    | member | the member's name | what it belongs to, which is no path |
    | op | any other operator | its operands |
    | each | | what a loop walks through, for the variable of the loop |
    | opaque | tokens with single blanks between them | |
    """

    kind: str
    text: str = ""
    parts: tuple[Term, ...] = ()


class Conjunct(NamedTuple):
    """One of the conditions that must all hold. text: as a person would write it; term: what it says; guard: the place
    of the guard it comes from."""

    text: str
    term: Term
    guard: int = 0


class GuardReading(NamedTuple):
    """What a guard says. names: variables that it makes (`if (auto p = f())`, `for x in xs`), with what they stand for
    in the guards further in."""

    pieces: tuple[Conjunct, ...] = ()
    names: tuple[tuple[str, Term], ...] = ()


TRUE = Term("true")
FALSE = Term("false")
NULL = Term("null")
NOW = Term("call", "", (Term("name", "now"),))
"""The time that nodes of ROS 1 and ROS 2 go by."""
FORMULAS = frozenset(("and", "or", "not", "truth", "compare", "true", "false"))
FLIPPED = {"==": "!=", "!=": "==", "<": ">=", ">=": "<", ">": "<=", "<=": ">"}
DEEPEST = 80
"""How many levels of an expression are looked into; what lies deeper is opaque."""
LONGEST = 4000
"""Longer conditions are opaque. Extractors cut them off at this length, so that no more is known of them anyway."""

_IDENTIFIER = re.compile(r"[^\W\d]\w*")
_FIRST = re.compile(r"([^\W\d]\w*)(::|\.|$)")
_LONGEST_NUMBER = 80
_LARGEST_EXPONENT = 99
_LARGEST = 500


def make_opaque(text: str) -> Term:
    """What is not understood, as written."""
    return Term("opaque", " ".join(text.split()))


def join(kind: str, parts: Iterable[Term]) -> Term:
    """`and` or `or` of some terms, in a fixed order and each but once."""
    flat: set[Term] = set()
    for part in parts:
        flat.update(part.parts if part.kind == kind else (part,))
    return next(iter(flat)) if len(flat) == 1 else Term(kind, "", tuple(sorted(flat)))


def negate(term: Term) -> Term:
    if term.kind == "true":
        return FALSE
    if term.kind == "false":
        return TRUE
    return Term("not", "", (term,))


def compare(operator: str, left: Term, right: Term) -> Term:
    """operator: one of FLIPPED."""
    if operator == "!=":
        return negate(compare("==", left, right))
    if operator in (">", ">="):
        return Term("compare", "<" if operator == ">" else "<=", (right, left))
    return Term("compare", operator, tuple(sorted((left, right))) if operator == "==" else (left, right))


def make_member(owner: Term, name: str) -> Term:
    """`owner.name`; `(*p).x` is `p.x`."""
    if owner.kind == "op" and owner.text == "*" and len(owner.parts) == 1:
        owner = owner.parts[0]
    if owner.kind == "name":
        return Term("name", f"{owner.text}.{name}")
    return Term("member", name, (owner,))


def split_owner(function: Term) -> tuple[Term | None, str]:
    """What a method is called on, and its name; None for a function without an owner."""
    if function.kind == "member":
        return function.parts[0], function.text
    if function.kind == "name":
        before, dot, last = function.text.rpartition(".")
        return (Term("name", before), last) if dot else (None, function.text)
    return None, ""


def parse_number(written: str) -> Term | None:
    """A decimal number as a term; None when it is none or too large to be of use."""
    exponent = re.search(r"[eE][+-]?(\d+)$", written)
    if len(written) > _LONGEST_NUMBER or (exponent and int(exponent[1]) > _LARGEST_EXPONENT):
        return None
    try:
        value = Fraction(written)
    except (ValueError, ZeroDivisionError):
        return None
    return Term("whole" if written.lstrip("+-").isdigit() else "real", str(value))


def rewrite(term: Term, change: Callable[[Term], Term | None]) -> Term:
    """The term with every part replaced for which change gives another; what it gives is not looked into again."""
    changed = change(term)
    if changed is not None:
        return changed
    return rebuild_term(term.kind, term.text, tuple(rewrite(part, change) for part in term.parts))


def rebuild_term(kind: str, text: str, parts: tuple[Term, ...]) -> Term:
    """A term of these, in the form that such terms have."""
    if kind in ("and", "or"):
        return join(kind, parts)
    if kind == "compare":
        return compare(text, *parts)
    if kind == "member":
        return make_member(parts[0], text)
    return Term(kind, text, parts)


def rename_term(term: Term, renames: Mapping[str, str]) -> Term:
    """The term with identifiers (parts of paths) called otherwise. What became a path (`ready`, `state.ready`) is a
    variable or member: only where a path begins with it."""
    text = term.text
    if term.kind in ("name", "opaque", "member"):

        def change(match: re.Match[str]) -> str:
            successor = renames.get(match[0], match[0])
            begins = term.kind == "name" and text[: match.start()] in ("", "this.")
            return match[0] if "." in successor and not begins else successor

        path = next((name for name in renames if "." in name and f"{text}.".startswith(f"{name}.")), "")
        text = renames[path] + text[len(path) :] if path and term.kind == "name" else _IDENTIFIER.sub(change, text)
    return rebuild_term(term.kind, text, tuple(rename_term(part, renames) for part in term.parts))


def substitute_names(term: Term, names: Mapping[str, Term]) -> Term:
    """The term with variables and namespaces, alone or at the start of a path, replaced by what they stand for."""

    def change(part: Term) -> Term | None:
        if part.kind != "name":
            return None
        match = _FIRST.match(part.text)
        value = names.get(match[1]) if match else None
        if match is None or value is None:
            return None
        rest = part.text[match.end() :]
        if match[2] == "::":
            return Term("name", f"{value.text}::{rest}") if value.kind == "name" else None
        for name in rest.split(".") if rest else ():
            value = make_member(value, name)
        return value

    return rewrite(term, change)


def make_place(container: Term) -> Term:
    """What a loop through the places of a container calls each of them, for the variable of the loop."""
    return Term("op", "place", (container,))


def find_elements(term: Term) -> Term:
    """The term with `v[i]` and `*it`, where a loop walks through `v` so, as the element of the loop."""

    def change(part: Term) -> Term | None:
        if part.kind == "op" and part.text == "*" and len(part.parts) == 1 and part.parts[0].kind == "each":
            return part.parts[0]
        if part.kind == "index" and len(part.parts) == 2 and part.parts[1].text == "place":
            container = find_elements(part.parts[0])
            return Term("each", "", (container,)) if find_elements(part.parts[1]) == make_place(container) else None
        return None

    return rewrite(term, change)


def define(known: dict[str, Term], name: str, value: Term) -> None:
    """Lets a name stand for a value, with what is known put into it; for itself where that would grow too large."""
    value = substitute_names(value, known)
    known.pop(name, None)
    if _count_terms(value) <= _LARGEST:
        known[name] = value


def _count_terms(term: Term) -> int:
    return 1 + sum(map(_count_terms, term.parts))


def build_reading(pieces: Iterable[Conjunct], names: Iterable[tuple[str, Term]]) -> GuardReading:
    """A condition with the variables that it makes put back into what they stand for."""
    known: dict[str, Term] = {}
    for name, value in names:
        define(known, name, value)
    if not known:
        return GuardReading(tuple(pieces))
    return GuardReading(
        tuple(piece._replace(term=substitute_names(piece.term, known)) for piece in pieces), tuple(known.items())
    )


def list_names(term: Term) -> Iterable[str]:
    """The paths named in a term."""
    if term.kind == "name":
        yield term.text
    for part in term.parts:
        yield from list_names(part)


def split_outside(text: str, mark: str, hidden: str = "(?!)") -> list[str]:
    """The parts of a text between marks that stand in no brackets, blanks around them taken off. mark, hidden: regular
    expressions; in what the second one matches nothing is looked for."""
    parts: list[str] = []
    depth = start = 0
    for match in re.finditer(rf"(?s:{hidden})|(?P<bracket>[(\[{{}}\])])|(?P<mark>{mark})", text):
        if match["bracket"]:
            depth += 1 if match["bracket"] in "([{" else -1
        elif match["mark"] and depth <= 0:
            parts.append(text[start : match.start()].strip())
            start = match.end()
    return [*parts, text[start:].strip()]
