"""Whether one condition implies another, decided with z3.

Numbers are real unless they are known to be whole, so that an implication that is proved holds for integers and for
floating point alike (NaN and overflow aside). That one does *not* hold is believed only when whole numbers, not
negative, show it too, wherever the terms could be of such a type. What lies between these two is not decided.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import Any

from .guard_terms import FORMULAS, NULL, Term, owner_of

_ENUMERATOR = re.compile(r"(?P<scope>.+)::(?:[A-Z]|k[A-Z])\w*|(?P<class>.+)\.[A-Z][A-Z0-9_]+")
_CONSTANT = re.compile(r"[A-Z][A-Z0-9_]+|k[A-Z]\w*")
_COUNTS = frozenset(
    ("count", "getNumSubscribers", "get_subscription_count", "get_num_connections", "getNumPublishers", "use_count")
) | {"get_intra_process_subscription_count", "get_publisher_count", "get_subscriber_count", "qsize"}
_RESOURCES_PER_MILLISECOND = 6000


class Undecided(Exception):
    """The limit was reached, or the conditions are more than can be told to z3."""


class Solver:
    """Compares two conditions of one language.

    types: of names, as they are written where they are declared. milliseconds: for all questions together, turned into
    an amount of work that is the same on every machine.
    """

    def __init__(self, language: str, types: Mapping[str, str], milliseconds: int) -> None:
        import z3

        self.z3 = z3
        self.python = language == "python"
        self.types = types
        self.solver = z3.SimpleSolver()
        self.solver.set("rlimit", max(milliseconds, 1) * _RESOURCES_PER_MILLISECOND)
        # Should the amount of work be misjudged, it ends all the same.
        self.solver.set("timeout", max(milliseconds, 1) * 20)
        self.numbers: dict[Term, Any] = {}
        self.truths: dict[Term, Any] = {}
        self.nulls: dict[Term, Any] = {}
        self.texts: dict[str, Any] = {}
        self.valued: set[Term] = set()
        self.counted: set[Term] = set()
        self.ordered: set[Term] = set()
        self.fractional: set[Term] = set()
        self.signed: set[Term] = set()
        self.equated: dict[Term, set[Term]] = {}

    # Questions

    def relation(self, old: Term, new: Term) -> tuple[bool | None, bool | None, bool]:
        """Whether new implies old, and old implies new (None: true of some types only), and whether that is so of
        conditions that can hold at all. Raises Undecided."""
        try:
            return self._relation(old, new)
        except (self.z3.Z3Exception, RecursionError, ArithmeticError) as error:
            raise Undecided from error

    def _relation(self, old: Term, new: Term) -> tuple[bool | None, bool | None, bool]:
        for term in (old, new):
            self.look(term, False)
        before, after = self.truth(old), self.truth(new)
        self.solver.add(*self.known())
        forward = not self.holds(self.z3.And(after, self.z3.Not(before)))
        backward = not self.holds(self.z3.And(before, self.z3.Not(after)))
        if not forward and not backward:
            return False, False, True
        possible = self.holds(before) and self.holds(after)
        if forward and backward:
            return True, True, possible
        self.solver.add(*self.supposed())
        one_sided = self.z3.And(before, self.z3.Not(after)) if forward else self.z3.And(after, self.z3.Not(before))
        if self.holds(one_sided):
            return forward, backward, possible
        return (True, None, possible) if forward else (None, True, possible)

    def possible(self, term: Term) -> bool:
        """Whether a condition can hold. Raises Undecided."""
        try:
            self.look(term, False)
            asked = self.truth(term)
            self.solver.add(*self.known())
            return self.holds(asked)
        except (self.z3.Z3Exception, RecursionError, ArithmeticError) as error:
            raise Undecided from error

    def holds(self, formula: Any) -> bool:
        """Whether something makes a formula true."""
        self.solver.push()
        self.solver.add(formula)
        answer = self.solver.check()
        self.solver.pop()
        if answer == self.z3.unknown:
            raise Undecided
        return answer == self.z3.sat

    # What terms are used as

    def look(self, term: Term, valued: bool) -> None:
        """Notes what terms are used as. valued: as a number rather than for its truth."""
        kind, parts = term.kind, term.parts
        if kind in ("and", "or", "not", "truth"):
            for part in parts:
                self.look(part, False)
        elif kind == "compare":
            self.look_compared(term)
        elif kind == "choice":
            self.look(parts[0], False)
            self.look(parts[1], valued)
            self.look(parts[2], valued)
        elif self.is_arithmetic(term):
            for part in parts:
                self.look(part, True)
        elif kind == "size":
            self.counted.add(parts[0])
        elif kind == "abs":
            self.look(parts[0], True)
        elif valued and kind not in ("whole", "real", "string", "null", "true", "false"):
            self.valued.add(term)

    def look_compared(self, term: Term) -> None:
        left, right = term.parts
        if term.text == "==":
            for one, other in ((left, right), (right, left)):
                if one.kind in ("true", "false", "null"):
                    self.look(other, False)
                    return
                if one.kind in ("string", "whole", "real") or self.is_constant(one):
                    self.equated.setdefault(other, set()).add(one)
            if left.kind in FORMULAS or right.kind in FORMULAS:
                self.look(left, False)
                self.look(right, False)
                return
        self.look(left, True)
        self.look(right, True)
        bases = {base for part in term.parts for base in self.bases(part)}
        literals = [literal for part in term.parts for literal in self.literals(part)]
        if term.text != "==" and (literals or self.is_arithmetic(left) or self.is_arithmetic(right)):
            self.ordered |= bases
        if any(literal.kind == "real" for literal in literals):
            self.fractional |= bases
        if any(Fraction(literal.text) < 0 for literal in literals) or any(part.kind == "-" for part in term.parts):
            self.signed |= bases
        if (term.text == "<" and self.fold(right) == 0) or (term.text == "<=" and self.fold(left) == 0):
            self.signed |= bases

    def bases(self, term: Term) -> Iterable[Term]:
        """The unknowns in an arithmetic expression."""
        if self.is_arithmetic(term) or term.kind == "abs":
            for part in term.parts:
                yield from self.bases(part)
        elif term.kind == "choice":
            yield from self.bases(term.parts[1])
            yield from self.bases(term.parts[2])
        elif term.kind not in ("whole", "real", "string", "null", "true", "false"):
            yield term

    def literals(self, term: Term) -> Iterable[Term]:
        if term.kind in ("whole", "real"):
            yield term
        elif self.is_arithmetic(term):
            for part in term.parts:
                yield from self.literals(part)

    def is_arithmetic(self, term: Term) -> bool:
        """Whether a term is a sum or a multiple of others."""
        if term.kind in ("+", "-"):
            if any(part.kind == "string" for part in term.parts):
                return False
            return term.kind == "+" or not any(self.type_of(part) == "unsigned" for part in term.parts)
        if term.kind == "*":
            return any(self.fold(part) is not None for part in term.parts)
        if term.kind == "op" and term.text == "/" and len(term.parts) == 2:
            divisor = self.fold(term.parts[1])
            # 1 / 2 is 0 or 0.5.
            return bool(divisor) and any(
                literal.kind == "real" for part in term.parts for literal in self.literals(part)
            )
        return False

    def is_constant(self, term: Term) -> bool:
        return term.kind == "name" and bool(_ENUMERATOR.fullmatch(term.text) or _CONSTANT.fullmatch(term.text))

    def fold(self, term: Term) -> Fraction | None:
        """The number that a term of literals alone is."""
        if term.kind in ("whole", "real"):
            return Fraction(term.text)
        if term.kind in ("+", "-", "*"):
            left, right = self.fold(term.parts[0]), self.fold(term.parts[1])
            if left is None or right is None:
                return None
            return left + right if term.kind == "+" else left - right if term.kind == "-" else left * right
        return None

    def type_of(self, term: Term) -> str:
        """`float`, `integer`, `unsigned`, `bool`, `pointer`, `optional`, or empty for what is not known."""
        if term.kind == "size":
            return "integer" if self.python else "unsigned"
        if term.kind == "call":
            return "integer" if owner_of(term.parts[0])[1] in _COUNTS else ""
        if term.kind == "op" and term.text == "cut":
            return "integer"
        return type_class(self.types.get(term.text, "")) if term.kind == "name" else ""

    # Terms to z3

    def fresh(self, sort: Any) -> Any:
        number = len(self.numbers) + len(self.truths) + len(self.nulls) + len(self.texts)
        return self.z3.Const(f"{sort.name()[0]}{number}", sort)

    def number_of(self, term: Term) -> Any:
        """The unknown number that a term is."""
        if term.kind == "*" or (term.kind == "op" and term.text in ("&", "|", "^")):
            term = Term(term.kind, term.text, tuple(sorted(term.parts)))
        if term not in self.numbers:
            self.numbers[term] = self.fresh(self.z3.RealSort())
        return self.numbers[term]

    def value(self, term: Term) -> Any:
        z3, kind, parts = self.z3, term.kind, term.parts
        folded = self.fold(term)
        if folded is not None:
            return z3.RealVal(str(folded))
        if kind in FORMULAS:
            return z3.If(self.truth(term), z3.RealVal(1), z3.RealVal(0))
        if kind == "choice":
            return z3.If(self.truth(parts[0]), self.value(parts[1]), self.value(parts[2]))
        if self.is_arithmetic(term):
            left, right = self.value(parts[0]), self.value(parts[1])
            if kind == "+":
                return left + right
            if kind == "-":
                return left - right
            return left * right if kind == "*" else left / right
        if kind == "abs":
            inside = self.value(parts[0])
            return z3.If(inside >= 0, inside, -inside)
        if kind == "null" and not self.python:
            return z3.RealVal(0)
        if kind == "string":
            if term.text not in self.texts:
                self.texts[term.text] = self.fresh(z3.RealSort())
            return self.texts[term.text]
        return self.number_of(term)

    def truth(self, term: Term) -> Any:
        z3, kind, parts = self.z3, term.kind, term.parts
        if kind in ("true", "false"):
            return z3.BoolVal(kind == "true")
        if kind in ("and", "or"):
            return (z3.And if kind == "and" else z3.Or)([self.truth(part) for part in parts])
        if kind == "not":
            return z3.Not(self.truth(parts[0]))
        if kind == "truth":
            return self.truth(parts[0])
        if kind == "compare":
            return self.compared(term.text, *parts)
        if kind == "choice":
            return z3.If(self.truth(parts[0]), self.truth(parts[1]), self.truth(parts[2]))
        if kind == "null":
            return z3.BoolVal(False)
        if kind == "string":
            return z3.BoolVal(not self.python or not is_empty(term.text))
        if kind in ("whole", "real", "size", "abs") or self.is_arithmetic(term):
            return self.value(term) != 0
        if not self.python and term in self.valued and self.type_of(term) != "optional":
            return self.value(term) != 0
        if term not in self.truths:
            self.truths[term] = self.fresh(z3.BoolSort())
        return self.truths[term]

    def compared(self, operator: str, left: Term, right: Term) -> Any:
        if operator == "==":
            for one, other in ((left, right), (right, left)):
                if one.kind == "null":
                    return self.is_null(other)
            for one, other in ((left, right), (right, left)):
                if one.kind in ("true", "false"):
                    # Who compares with `true` has a bool.
                    truth = self.truth(other)
                    return truth if one.kind == "true" else self.z3.Not(truth)
            if left.kind in FORMULAS or right.kind in FORMULAS:
                return self.truth(left) == self.truth(right)
            if left.kind == "string" and right.kind == "string":
                return self.z3.BoolVal(left.text == right.text)
            return self.value(left) == self.value(right)
        first, second = self.value(left), self.value(right)
        return first < second if operator == "<" else first <= second

    def is_null(self, term: Term) -> Any:
        if not self.python:
            return self.z3.Not(self.truth(term))
        if term == NULL:
            return self.z3.BoolVal(True)
        if term.kind in FORMULAS or term.kind in ("whole", "real", "string", "size") or self.is_arithmetic(term):
            return self.z3.BoolVal(False)
        if term not in self.nulls:
            self.nulls[term] = self.fresh(self.z3.BoolSort())
        return self.nulls[term]

    # What is known of them

    def known(self) -> list[Any]:
        """What holds of the terms whatever their types are."""
        result: list[Any] = []
        if self.python:
            result.extend(self.truth_in_python())
        for term, others in self.equated.items():
            for text in (other for other in others if other.kind == "string"):
                if term in self.counted:
                    size = self.value(Term("size", "", (term,)))
                    filled = size == 0 if is_empty(text.text) else size > 0
                    result.append(self.z3.Implies(self.value(term) == self.value(text), filled))
                    if is_empty(text.text):
                        result.append(self.z3.Implies(filled, self.value(term) == self.value(text)))
        if len(self.texts) > 1:
            result.append(self.z3.Distinct(*self.texts.values()))
        scopes: dict[str, list[Any]] = {}
        for term, value in self.numbers.items():
            match = _ENUMERATOR.fullmatch(term.text) if term.kind == "name" else None
            if match:
                scopes.setdefault(match["scope"] or match["class"], []).append(value)
            type_ = self.type_of(term)
            if type_ in ("integer", "unsigned", "bool"):
                result.append(self.whole(value))
            if type_ in ("unsigned", "bool") or (term.kind in ("size", "call") and type_ == "integer"):
                result.append(value >= 0)
            if type_ == "bool":
                result.append(value <= 1)
        result.extend(self.z3.Distinct(*values) for values in scopes.values() if len(values) > 1)
        return result

    def truth_in_python(self) -> Iterable[Any]:
        """What the truth of a value, its being None, its length and its being equal to something have to do with each
        other."""
        z3 = self.z3
        for term in list(self.truths):
            truth = self.truths[term]
            there = z3.Not(self.nulls[term]) if term in self.nulls else z3.BoolVal(True)
            type_ = self.type_of(term)
            if term in self.counted:
                yield truth == z3.And(there, self.value(Term("size", "", (term,))) != 0)
            elif term in self.valued and (term in self.ordered or type_ in ("integer", "float", "bool")):
                yield truth == z3.And(there, self.value(term) != 0)
            else:
                yield z3.Implies(truth, there)
        for term, others in self.equated.items():
            for other in others:
                if term not in self.valued:
                    continue
                equal = self.value(term) == self.value(other)
                if term in self.nulls:
                    yield z3.Implies(equal, z3.Not(self.nulls[term]))
                if term in self.truths and not self.is_constant(other):
                    filled = self.truth(other)
                    yield z3.Implies(equal, self.truths[term] == filled)
                    if (
                        other.kind == "string"
                        and is_empty(other.text)
                        and type_class(self.types.get(term.text, "")) == "str"
                    ):
                        yield z3.Implies(z3.Not(self.truths[term]), equal)

    def supposed(self) -> list[Any]:
        """What may hold of them besides: a difference that only shows otherwise is not believed."""
        result: list[Any] = []
        constants: list[Any] = []
        for term, value in self.numbers.items():
            if self.type_of(term) == "float":
                continue
            if term.kind == "name" and _CONSTANT.fullmatch(term.text):
                constants.append(value)
            if term not in self.fractional:
                result.append(self.whole(value))
            if term not in self.fractional and term not in self.signed and self.type_of(term) != "integer":
                result.append(value >= 0)
        if len(constants) > 1:
            result.append(self.z3.Distinct(*constants))
        return result

    def whole(self, value: Any) -> Any:
        return value == self.z3.ToReal(self.z3.Int(f"{value}'"))


def is_empty(literal: str) -> bool:
    """Whether a string literal is the empty string."""
    return bool(re.fullmatch(r"\w*(\"\"|''|R\"\(\)\")", literal))


_FLOATING = re.compile(r"\b(?:double|float|float32_t|float64_t)\b")
_UNSIGNED = re.compile(r"\b(?:unsigned|uint(?:_fast|_least)?\d*_t|uint|uint\d+|size_t|size_type)\b")
_SIGNED = re.compile(r"\b(?:int|long|short|s?size_t|int(?:_fast|_least)?\d*_t|int\d+)\b")


def type_class(type_: str) -> str:
    """`float`, `integer`, `unsigned`, `bool`, `pointer`, `optional`, `str` or empty, for a type as it is written."""
    if not type_:
        return ""
    if "optional" in type_ or "Optional" in type_:
        return "optional"
    if "*" in type_ or re.search(r"(?:Ptr|_ptr)\b", type_):
        return "pointer"
    if "<" in type_ or "[" in type_:
        return ""
    for pattern, name in ((_FLOATING, "float"), (_UNSIGNED, "unsigned"), (_SIGNED, "integer")):
        if pattern.search(type_):
            return name
    return {"bool": "bool", "str": "str"}.get(type_.replace("const", "").strip(), "")
