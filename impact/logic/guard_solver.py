"""Whether one condition implies another, decided with z3.

Numbers are real unless they are known to be whole, so that an implication that is proved holds for integers and for
floating point alike (NaN and overflow aside). That one does *not* hold is believed only when whole numbers, not
negative, show it too, wherever the terms could be of such a type. What lies between these two is not decided.
"""

import contextlib
import re
from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction
from math import ceil
from typing import Any

from .guard_reading import Language
from .guard_terms import FORMULAS, NULL, Term, split_owner

_ENUMERATOR = re.compile(
    r"(?P<type>(?:.+::)?[A-Z]\w*)::\w+|(?P<scope>.+)::(?:[A-Z]|k[A-Z])\w*|(?P<class>.+)\.[A-Z][A-Z0-9_]+"
)
_CONSTANT = re.compile(r"[A-Z][A-Z0-9_]+|k[A-Z]\w*")
_COUNTS = frozenset(
    ("count", "getNumSubscribers", "get_subscription_count", "get_num_connections", "getNumPublishers", "use_count")
) | {"get_intra_process_subscription_count", "get_publisher_count", "get_subscriber_count", "qsize"}
_RESOURCES_PER_MILLISECOND = 500
_MARGIN = 8
"""How far beyond the numbers in conditions a difference between them is looked for before it is given up."""


MOST_QUESTIONS = 3_000
"""How often z3 is asked for one comparison of two states; a change of more conditions than that is not looked through
condition by condition."""
_left: list[int] = []


class Undecided(Exception):
    """The limit was reached, or the conditions are nested too deep."""


@contextlib.contextmanager
def limit_questions(number: int = MOST_QUESTIONS) -> Iterator[None]:
    """Within it only so many questions are decided, all others are Undecided. By number and not by time, so that the
    answer is the same on every machine."""
    _left.append(number)
    try:
        yield
    finally:
        _left.pop()


class Solver:
    """Compares two conditions of one language.

    milliseconds: for each question, turned into an amount of work that is the same on every machine.
    """

    def __init__(self, language: Language, milliseconds: int) -> None:
        self.python = language == "python"
        self.milliseconds = max(milliseconds, 1)
        self.numbers: dict[Term, str] = {}
        self.truths: dict[Term, str] = {}
        self.nulls: dict[Term, str] = {}
        self.texts: dict[str, str] = {}
        self.script: list[str] = []
        self.valued: set[Term] = set()
        self.counted: set[Term] = set()
        # Told to be less than something that is a number; told to be less than anything, or calculated with.
        self.ordered: set[Term] = set()
        self.measured: set[Term] = set()
        self.fractional: set[Term] = set()
        self.signed: set[Term] = set()
        self.equated: dict[Term, set[Term]] = {}
        self.largest = 0

    def compare(self, old: Term, new: Term) -> tuple[bool | None, bool | None, bool]:
        """Whether new implies old, and old implies new (None: true of some types only), and whether that is so of
        conditions that can hold at all. Raises Undecided."""
        before, after = self.build_formulas(old, new)
        loses, gains = f"(and {before} (not {after}))", f"(and {after} (not {before}))"
        ask = self.make_checker(before=before, after=after, loses=loses, gains=gains)
        lost, gained = ask("loses", "supposed"), ask("gains", "supposed")
        if lost and gained:
            return False, False, True
        forward = False if gained else None if ask("gains") else True
        backward = False if lost else None if ask("loses") else True
        return forward, backward, (lost or ask("before")) and (gained or ask("after"))

    def is_possible(self, term: Term) -> bool:
        """Whether a condition can hold. Raises Undecided."""
        (asked,) = self.build_formulas(term)
        return self.make_checker(asked=asked)("asked")

    def is_likely(self, term: Term) -> bool:
        """Whether a condition can hold when different constants are different, too. Raises Undecided."""
        (asked,) = self.build_formulas(term)
        return self.make_checker(asked=asked)("asked", "supposed")

    def build_formulas(self, *terms: Term) -> list[str]:
        """The terms as formulas, in the language of SMT-LIB; `script` says what is in them."""
        try:
            for term in terms:
                self.look(term, False)
            return [self.encode_truth(term) for term in terms]
        except RecursionError as error:
            raise Undecided from error

    def make_checker(self, **formulas: str) -> Callable[..., bool]:
        """A function that tells whether some of the formulas, by their names, hold together for some values. Besides
        them there are `supposed` and `near`: see list_assumptions() and near()."""
        import z3

        if _left:
            if _left[-1] <= 0:
                raise Undecided
            _left[-1] -= 1
        formulas["supposed"], formulas["near"] = _join_all(self.list_assumptions()), _join_all(self.list_bounds())
        known = [f"(assert {fact})" for fact in self.list_axioms()]
        named = [f"(declare-const {name} Bool)(assert (=> {name} {formula}))" for name, formula in formulas.items()]
        solver = z3.SimpleSolver()
        solver.set("rlimit", self.milliseconds * _RESOURCES_PER_MILLISECOND)
        # Should the amount of work be misjudged, it ends all the same.
        solver.set("timeout", self.milliseconds * 20)
        # Otherwise z3 takes Ctrl-C for itself: nothing is decided, and the run goes on.
        solver.set("ctrl_c", False)
        try:
            solver.from_string("".join((*self.script, *known, *named)))
        except z3.Z3Exception as error:
            raise Undecided from error

        def decide(*names: str) -> Any:
            try:
                return solver.check(*map(z3.Bool, names))
            except z3.Z3Exception as error:
                raise Undecided from error

        def ask(*names: str) -> bool:
            answer = decide(*names)
            if answer == z3.unknown:
                answer = decide(*names, "near")
                # A difference that is only supposed is none where nothing near shows it.
                if answer == z3.unknown or (answer == z3.unsat and "supposed" not in names):
                    raise Undecided
            return answer == z3.sat

        return ask

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
        bases = {base for part in term.parts for base in self.find_unknowns(part)}
        literals = [literal for part in term.parts for literal in self.find_literals(part)]
        self.largest = max(self.largest, *(ceil(abs(Fraction(literal.text))) for literal in literals), 0)
        calculated = self.is_arithmetic(left) or self.is_arithmetic(right)
        if term.text != "==" and (literals or calculated):
            self.ordered |= bases
        if term.text != "==" or calculated:
            self.measured |= bases
        if any(literal.kind == "real" for literal in literals):
            self.fractional |= bases
        if any(Fraction(literal.text) < 0 for literal in literals) or any(part.kind == "-" for part in term.parts):
            self.signed |= bases
        if (term.text == "<" and self.fold(right) == 0) or (term.text == "<=" and self.fold(left) == 0):
            self.signed |= bases

    def find_unknowns(self, term: Term) -> Iterable[Term]:
        """The unknowns in an arithmetic expression."""
        if self.is_arithmetic(term) or term.kind == "abs":
            for part in term.parts:
                yield from self.find_unknowns(part)
        elif term.kind == "choice":
            yield from self.find_unknowns(term.parts[1])
            yield from self.find_unknowns(term.parts[2])
        elif term.kind not in ("whole", "real", "string", "null", "true", "false"):
            yield term

    def find_literals(self, term: Term) -> Iterable[Term]:
        if term.kind in ("whole", "real"):
            yield term
        elif self.is_arithmetic(term):
            for part in term.parts:
                yield from self.find_literals(part)

    def is_arithmetic(self, term: Term) -> bool:
        """Whether a term is a sum or a multiple of others."""
        if term.kind in ("+", "-"):
            if any(part.kind == "string" for part in term.parts):
                return False
            # A size less something is never negative in C++: 0 - 1 is a large number there.
            return term.kind == "+" or self.python or not any(part.kind == "size" for part in term.parts)
        if term.kind == "*":
            return any(self.fold(part) is not None for part in term.parts)
        if term.kind == "op" and term.text == "/" and len(term.parts) == 2:
            divisor = self.fold(term.parts[1])
            # 1 / 2 is 0 or 0.5.
            return bool(divisor) and any(
                literal.kind == "real" for part in term.parts for literal in self.find_literals(part)
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

    def is_whole(self, term: Term) -> bool:
        """Whether a term is a whole number in whatever types it is made of."""
        if term.kind == "call":
            return split_owner(term.parts[0])[1] in _COUNTS
        return term.kind == "size" or (term.kind == "op" and term.text == "cut")

    def declare_unknown(self, sort: str) -> str:
        name = f"{sort[0].lower()}{len(self.script)}"
        self.script.append(f"(declare-const {name} {sort})")
        return name

    def encode_number(self, term: Term) -> str:
        """The unknown number that a term is."""
        if term.kind == "*" or (term.kind == "op" and term.text in ("&", "|", "^")):
            term = Term(term.kind, term.text, tuple(sorted(term.parts)))
        if term not in self.numbers:
            self.numbers[term] = self.declare_unknown("Real")
        return self.numbers[term]

    def encode(self, term: Term) -> str:
        kind, parts = term.kind, term.parts
        folded = self.fold(term)
        if folded is not None:
            return _format_real(folded)
        if kind in FORMULAS:
            return f"(ite {self.encode_truth(term)} 1.0 0.0)"
        if kind == "choice":
            return f"(ite {self.encode_truth(parts[0])} {self.encode(parts[1])} {self.encode(parts[2])})"
        if self.is_arithmetic(term):
            return f"({term.text or kind} {self.encode(parts[0])} {self.encode(parts[1])})"
        if kind == "abs":
            inside = self.encode(parts[0])
            return f"(ite (>= {inside} 0.0) {inside} (- {inside}))"
        if kind == "null" and not self.python:
            return "0.0"
        if kind == "string":
            if term.text not in self.texts:
                self.texts[term.text] = self.declare_unknown("Real")
            return self.texts[term.text]
        return self.encode_number(term)

    def encode_truth(self, term: Term) -> str:
        kind, parts = term.kind, term.parts
        if kind in ("true", "false"):
            return kind
        if kind in ("and", "or", "not"):
            return f"({kind} {' '.join(map(self.encode_truth, parts))})"
        if kind == "truth":
            return self.encode_truth(parts[0])
        if kind == "compare":
            return self.encode_comparison(term.text, *parts)
        if kind == "choice":
            return f"(ite {' '.join(map(self.encode_truth, parts))})"
        if kind == "null" or (kind == "string" and self.python and is_empty(term.text)):
            return "false"
        if kind == "string":
            return "true"
        measured = kind in ("whole", "real", "size", "abs") or self.is_arithmetic(term)
        if measured or (not self.python and term in self.valued):
            return f"(not (= {self.encode(term)} 0.0))"
        if term not in self.truths:
            self.truths[term] = self.declare_unknown("Bool")
        return self.truths[term]

    def encode_comparison(self, operator: str, left: Term, right: Term) -> str:
        if operator != "==":
            return f"({operator} {self.encode(left)} {self.encode(right)})"
        for one, other in ((left, right), (right, left)):
            if one.kind == "null":
                return self.is_null(other)
        for one, other in ((left, right), (right, left)):
            if one.kind in ("true", "false"):
                # Who compares with `true` has a bool.
                truth = self.encode_truth(other)
                return truth if one.kind == "true" else f"(not {truth})"
        if left.kind in FORMULAS or right.kind in FORMULAS:
            return f"(= {self.encode_truth(left)} {self.encode_truth(right)})"
        return f"(= {self.encode(left)} {self.encode(right)})"

    def is_null(self, term: Term) -> str:
        if not self.python:
            return f"(not {self.encode_truth(term)})"
        if term == NULL:
            return "true"
        if term.kind in FORMULAS or term.kind in ("whole", "real", "string", "size") or self.is_arithmetic(term):
            return "false"
        if term not in self.nulls:
            self.nulls[term] = self.declare_unknown("Bool")
        return self.nulls[term]

    # What is known of them

    def list_axioms(self) -> list[str]:
        """What holds of the terms whatever their types are."""
        result = list(self.list_python_axioms()) if self.python else []
        for term, truth in self.truths.items():
            if term.kind == "each":
                # A loop through a container runs when there is something in it.
                size = self.numbers.get(Term("size", "", term.parts))
                if size is not None:
                    result.append(f"(= {truth} (> {size} 0.0))")
                if self.python and term.parts[0] in self.truths:
                    result.append(f"(=> {truth} {self.truths[term.parts[0]]})")
        for term, others in self.equated.items():
            for text in sorted(other for other in others if other.kind == "string" and term in self.counted):
                size, equal = self.encode(Term("size", "", (term,))), f"(= {self.encode(term)} {self.encode(text)})"
                same = is_empty(text.text)
                result.append(f"(= {equal} (= {size} 0.0))" if same else f"(=> {equal} (> {size} 0.0))")
        scopes: dict[str, list[str]] = {"a text": list(self.texts.values())}
        for term, value in self.numbers.items():
            match = _ENUMERATOR.fullmatch(term.text) if term.kind == "name" else None
            if match:
                scopes.setdefault(match["type"] or match["scope"] or match["class"], []).append(value)
            if self.is_whole(term):
                result.append(f"(is_int {value})")
                if term.kind != "op":
                    result.append(f"(>= {value} 0.0)")
        result.extend(f"(distinct {' '.join(values)})" for values in scopes.values() if len(values) > 1)
        return result

    def list_python_axioms(self) -> Iterable[str]:
        """What the truth of a value, its being None, its length and its being equal to something have to do with each
        other."""
        for term, truth in self.truths.items():
            there = f"(not {self.nulls[term]})" if term in self.nulls else "true"
            if term in self.counted:
                yield f"(= {truth} (and {there} (not (= {self.encode(Term('size', '', (term,)))} 0.0))))"
            elif term in self.valued and (term in self.ordered or self.is_whole(term)):
                yield f"(= {truth} (and {there} (not (= {self.encode(term)} 0.0))))"
            else:
                yield f"(=> {truth} {there})"
        for term, others in self.equated.items():
            for other in sorted(others):
                if term not in self.valued:
                    continue
                equal = f"(= {self.encode(term)} {self.encode(other)})"
                if term in self.nulls:
                    yield f"(=> {equal} (not {self.nulls[term]}))"
                if term in self.truths and not self.is_constant(other):
                    yield f"(=> {equal} (= {self.truths[term]} {self.encode_truth(other)}))"

    def list_assumptions(self) -> list[str]:
        """What may hold of them besides: a difference that only shows otherwise is not believed."""
        result: list[str] = []
        constants: list[str] = []
        for term, value in self.numbers.items():
            if term.kind == "name" and _CONSTANT.fullmatch(term.text):
                constants.append(value)
            if self.is_counting(term):
                result.append(f"(is_int {value})")
                if term not in self.signed and not self.is_whole(term):
                    result.append(f"(>= {value} 0.0)")
        if len(constants) > 1:
            result.append(f"(distinct {' '.join(constants)})")
        return result

    def list_bounds(self) -> list[str]:
        """That whole numbers lie close to the numbers in the conditions. Without it z3 may go through ever larger ones
        and come to no end."""
        bound = self.largest + _MARGIN
        whole = (value for term, value in self.numbers.items() if self.is_counting(term))
        return [f"(<= (- {bound}.0) {value} {bound}.0)" for value in whole]

    def is_counting(self, term: Term) -> bool:
        """Whether a term is supposed to be a whole number. That does not matter for those that are only said to be
        equal or not."""
        return term in self.measured and term not in self.fractional


def _join_all(formulas: list[str]) -> str:
    return f"(and {' '.join(formulas)})" if formulas else "true"


def _format_real(number: Fraction) -> str:
    """A number in the language of SMT-LIB."""
    written = f"{abs(number.numerator)}.0"
    if number.denominator != 1:
        written = f"(/ {written} {number.denominator}.0)"
    return f"(- {written})" if number < 0 else written


def is_empty(literal: str) -> bool:
    """Whether a string literal is the empty string."""
    return bool(re.fullmatch(r"\w*(\"\"|''|R\"\(\)\")", literal))
