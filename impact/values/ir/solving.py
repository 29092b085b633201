"""Questions to the solver: only the conditions that matter to one, answers kept, floats guessed before they are solved.

z3 takes seconds for products of floats; most of the time a handful of values (those that the conditions compare with,
their neighbours, 0, 1, NaN) answers. A guess is checked by calculating the conditions, so it is never wrong.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import z3

from ..outcomes import InputKind, SymbolicInput, UnknownFunction
from .guessing import Guessing
from .ranges import Ranges, narrow_floats
from .terms import pack_float, read_float_value, reduce_term

_EFFORT = 4_000_000
"""What a question may cost; about a million a second."""
_SLOW_EFFORT = 400_000
"""The same where it calculates with floats: what is not solved soon is not solved at all."""
_SLOW_OPERATIONS = frozenset(
    (
        z3.Z3_OP_FPA_ADD, z3.Z3_OP_FPA_SUB, z3.Z3_OP_FPA_MUL, z3.Z3_OP_FPA_DIV, z3.Z3_OP_FPA_SQRT, z3.Z3_OP_FPA_FMA,
        z3.Z3_OP_FPA_REM, z3.Z3_OP_FPA_ROUND_TO_INTEGRAL, z3.Z3_OP_FPA_TO_SBV, z3.Z3_OP_FPA_TO_UBV,
    )
)  # fmt: skip


class SolverTimeout(Exception):
    """The solver gave no answer in time."""


class Traits(NamedTuple):
    """What a term is made of. names: of variables; constants: floats in it; is_slow: whether it calculates with
    floats; has_products: whether it multiplies integers."""

    names: frozenset[str]
    constants: frozenset[float]
    is_slow: bool
    has_products: bool


def is_certain(value: Any) -> bool:
    """Whether a truth value is the number 1: a term that stays open is not."""
    return isinstance(value, int) and value == 1


_NOTHING = Traits(frozenset(), frozenset(), False, False)
Model = Mapping[str, int]


_LARGE = 30_000
"""A size that no bound is near to."""


class Solving:
    """The variables of one exploration, and answers about conjunctions of conditions over them. inputs: the variables
    where somebody else keeps them."""

    def __init__(self, deadline: float, inputs: dict[str, SymbolicInput] | None = None):
        self.deadline = deadline
        self.inputs: dict[str, SymbolicInput] = inputs if inputs is not None else {}
        # Variables that are no inputs, and what each stands for.
        self.assumed: dict[str, str] = {}
        self.derived: dict[str, UnknownFunction] = {}
        # Sizes of arrays and texts of which something was asked that only larger ones fulfil.
        self.exceeded: set[str] = set()
        self.questions = 0
        self.undecided = 0
        self._traits: dict[int, tuple[z3.ExprRef, Traits]] = {}
        self._integers: dict[int, tuple[z3.ExprRef, tuple[int, ...]]] = {}
        self._answers: dict[frozenset[int], tuple[Model | SolverTimeout | None, Sequence[z3.BoolRef]]] = {}
        self._pairs: dict[tuple[str, int], tuple[z3.ExprRef, z3.ExprRef]] = {}
        self.guessing = Guessing(self.inputs, self.derived, self.holds_settled)

    def make_input(self, path: str, kind: InputKind, bits: int, is_signed: bool = False, most: int = 0):
        """The variable of a path; made when it is asked for first. Where it is asked for in another size, as parameters
        may be whose names are not known, that is another variable."""
        found = self.inputs.get(path)
        if found is not None and found.bits != bits:
            path = f"{path}#{bits}"
            found = self.inputs.get(path)
        if found is None:
            found = SymbolicInput(path, kind, bits, is_signed, z3.BitVec(path, bits), most)
            self.inputs[path] = found
        return found

    def note_impossible(self, term: z3.BoolRef) -> None:
        """Takes in a condition that no input within the bounds fulfils: a larger array or text may. One that is larger
        by one tells nothing, since every loop asks for it at its end."""
        names = self.find_traits(term).names
        if len(names) != 1 or (name := next(iter(names))) in self.exceeded:
            return
        size = self.inputs.get(name)
        if size is None or size.kind is not InputKind.SIZE or not size.most or size.most + 1 >= _LARGE:
            return
        next_one, large = (
            z3.simplify(z3.substitute(term, (size.term, z3.BitVecVal(count, size.bits))))
            for count in (size.most + 1, _LARGE)
        )
        if z3.is_false(next_one) and z3.is_true(large):
            self.exceeded.add(name)

    def find_traits(self, term: z3.ExprRef) -> Traits:
        known = self._traits.get(term.get_id())
        if known is not None:
            return known[1]
        pending = [term]
        while pending:
            each = pending[-1]
            number = each.get_id()
            if number in self._traits:
                pending.pop()
                continue
            children = each.children()
            missing = [child for child in children if child.get_id() not in self._traits]
            if missing:
                pending.extend(missing)
                continue
            self._traits[number] = (each, self._derive_traits(each, children))
            pending.pop()
        return self._traits[term.get_id()][1]

    def list_integers(self, term: z3.ExprRef) -> tuple[int, ...]:
        """The constants in a term, and their negatives."""
        known = self._integers.get(term.get_id())
        if known is None:
            found: set[int] = set()
            pending, seen = [term], set()
            while pending:
                each = pending.pop()
                if each.get_id() in seen:
                    continue
                seen.add(each.get_id())
                if z3.is_bv_value(each):
                    value = each.as_long()  # pyright: ignore[reportAttributeAccessIssue]
                    found.update((value, -value))
                else:
                    pending.extend(each.children())
            known = self._integers[term.get_id()] = term, tuple(sorted(found))
        return known[1]

    def _derive_traits(self, term: z3.ExprRef, children: Sequence[z3.ExprRef]) -> Traits:
        if not children:
            if z3.is_fp_value(term):
                return Traits(frozenset(), frozenset((read_float_value(term),)), False, False)
            if z3.is_const(term) and term.decl().kind() == z3.Z3_OP_UNINTERPRETED:
                name = term.decl().name()
                names = {name}
                if name in self.derived:
                    for argument in self.derived[name].arguments:
                        if isinstance(argument, z3.ExprRef):
                            names |= self.find_traits(argument).names
                return Traits(frozenset(names), frozenset(), False, False)
            return _NOTHING
        parts = [self._traits[child.get_id()][1] for child in children]
        if len(parts) == 1:
            names, constants = parts[0].names, parts[0].constants
        else:
            names = frozenset().union(*(part.names for part in parts))
            constants = frozenset().union(*(part.constants for part in parts))
        is_slow = any(part.is_slow for part in parts) or term.decl().kind() in _SLOW_OPERATIONS
        has_products = any(part.has_products for part in parts) or term.decl().kind() == z3.Z3_OP_BMUL
        return Traits(names, constants, is_slow, has_products)

    def select_related(self, conditions: Iterable[z3.BoolRef], names: Iterable[str]) -> list[z3.BoolRef]:
        """Those that speak of some variables, and of what these are tied to."""
        needed = set(names)
        left = [(each, self.find_traits(each).names) for each in conditions]
        found = []
        while True:
            rest = []
            before = len(found)
            for each, own in left:
                if own & needed:
                    found.append(each)
                    needed |= own
                else:
                    rest.append((each, own))
            left = rest
            if len(found) == before or not left:
                return found

    def evaluate(self, term: Any, model: Model) -> Any:
        """A term under a model (what it does not name is 0): a number, or a term where it stays open."""
        if not isinstance(term, z3.ExprRef):
            return term
        pairs = [self._pair(name, model.get(name, 0)) for name in self.find_traits(term).names]
        return reduce_term(z3.substitute(term, *pairs)) if pairs else reduce_term(term)

    def _pair(self, name: str, value: int):
        key = (name, value)
        if key not in self._pairs:
            term = self.inputs[name].term
            self._pairs[key] = (term, z3.BitVecVal(value, term.size()))
        return self._pairs[key]

    def settle(self, model: dict[str, int], names: Iterable[str]):
        """Calculates the derived variables among names from the others, in place."""
        for name in self.derived:
            if name in names:
                derived = self.derived[name]
                values = [self.evaluate(each, model) for each in derived.arguments]
                if all(isinstance(each, float | int) for each in values):
                    try:
                        model[name] = pack_float(derived.compute(*values), derived.bits)
                    except (ValueError, OverflowError, ZeroDivisionError):
                        model[name] = pack_float(math.nan, derived.bits)

    def holds(self, conditions: Iterable[z3.BoolRef], model: Model) -> bool:
        return all(is_certain(self.evaluate(each, model)) for each in conditions)

    def find_model(self, conditions: Sequence[z3.BoolRef], model: Model) -> dict[str, int] | None:
        """Values of the variables of some conditions that fulfil them, or None where there are none.

        model: a near miss, from which guesses begin. The newest condition is the last. Raises SolverTimeout.
        """
        key = frozenset(each.get_id() for each in conditions)
        if key not in self._answers:
            self._answers[key] = (self._find_answer(conditions, model), tuple(conditions))
        answer = self._answers[key][0]
        if isinstance(answer, SolverTimeout):
            raise answer
        return None if answer is None else dict(answer)

    def _find_answer(self, conditions: Sequence[z3.BoolRef], model: Model) -> Model | SolverTimeout | None:
        is_slow = any(self.find_traits(each).is_slow for each in conditions)
        if is_slow and self.is_impossible(conditions):
            return None
        found = self.guess(conditions, model)
        if found is not None:
            return found
        names = frozenset().union(*(self.find_traits(each).names for each in conditions))
        return self._solve(conditions, names, _SLOW_EFFORT if is_slow else _EFFORT)

    def is_impossible(self, conditions: Sequence[z3.BoolRef]) -> bool:
        """Whether the bounds of floats alone exclude one of some conditions."""
        ranges = Ranges(self.inputs, narrow_floats(conditions))
        return any(ranges.is_impossible(each) for each in conditions)

    def guess(self, conditions: Sequence[z3.BoolRef], model: Model) -> dict[str, int] | None:
        """Values that fulfil some conditions without the solver, where these calculate with floats or multiply; None
        where none are guessed. model: from which guesses begin. The newest condition is the last."""
        traits = [self.find_traits(each) for each in conditions]
        names = frozenset().union(*(each.names for each in traits))
        constants = frozenset().union(*(each.constants for each in traits))
        is_slow = any(each.is_slow for each in traits)
        is_derived = any(name in self.derived for name in names)
        if is_slow or is_derived:
            found = self.guessing.guess_floats(conditions, names, constants, model, 60, self.deadline)
            if found is None and is_slow:
                found = self.guessing.search_line(conditions, names, constants, model, self.deadline)
            if found is not None:
                return found
        if any(each.has_products for each in traits):
            return self.guessing.guess_texts(conditions, names, model, self.deadline)
        return None

    def _solve(
        self, conditions: Sequence[z3.BoolRef], names: frozenset[str], effort: int
    ) -> Model | SolverTimeout | None:
        self.questions += 1
        solver = z3.Solver()
        # Effort is counted, not time: an answer does not hang on how busy the machine is.
        solver.set("rlimit", effort)
        solver.set("timeout", int(max(0.05, self.deadline - time.monotonic()) * 1000))
        solver.add(*conditions)
        answer = solver.check()
        if answer == z3.unsat:
            return None
        if answer != z3.sat:
            self.undecided += 1
            return SolverTimeout()
        solved = solver.model()
        found = {
            name: solved.eval(self.inputs[name].term, True).as_long()  # pyright: ignore[reportAttributeAccessIssue]
            for name in names
        }
        settled = dict(found)
        if self.holds_settled(conditions, settled):
            return settled
        return found

    def holds_settled(self, conditions: Iterable[z3.BoolRef], model: dict[str, int]) -> bool:
        """Whether conditions hold, after variables that are derived from others are calculated, in place."""
        self.settle(model, model.keys())
        return self.holds(conditions, model)
