"""Questions to the solver: only the conditions that matter to one, answers kept, floats guessed before they are solved.

z3 takes seconds for products of floats; most of the time a handful of values (those that the conditions compare with,
their neighbours, 0, 1, NaN) answers. A guess is checked by calculating the conditions, so it is never wrong.
"""

from __future__ import annotations

import itertools
import math
import random
import time
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import z3

from ..outcomes import InputKind, SymbolicInput, UnknownFunction
from .terms import pack_float, read_float_value, reduce_term

_FLOATS = (InputKind.FLOAT32, InputKind.FLOAT64)
_USUAL = (0.0, 1.0, -1.0, 0.5, 2.0, math.nan, 100.0, math.inf, -math.inf, 1e10, -0.5)
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
    floats."""

    names: frozenset[str]
    constants: frozenset[float]
    is_slow: bool


_NOTHING = Traits(frozenset(), frozenset(), False)
Model = Mapping[str, int]


class Solving:
    """The variables of one exploration, and answers about conjunctions of conditions over them."""

    def __init__(self, deadline: float):
        self.deadline = deadline
        self.inputs: dict[str, SymbolicInput] = {}
        # Variables that are no inputs, and what each stands for.
        self.assumed: dict[str, str] = {}
        self.derived: dict[str, UnknownFunction] = {}
        self.questions = 0
        self.undecided = 0
        self._traits: dict[int, tuple[z3.ExprRef, Traits]] = {}
        self._answers: dict[frozenset[int], tuple[Model | None, Sequence[z3.BoolRef]]] = {}
        self._pairs: dict[tuple[str, int], tuple[z3.ExprRef, z3.ExprRef]] = {}
        self._random = random.Random(1)

    def make_input(self, path: str, kind: InputKind, bits: int, is_signed: bool = False, most: int = 0):
        """The variable of a path; made when it is asked for first."""
        found = self.inputs.get(path)
        if found is None:
            found = SymbolicInput(path, kind, bits, is_signed, z3.BitVec(path, bits), most)
            self.inputs[path] = found
        return found

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

    def _derive_traits(self, term: z3.ExprRef, children: Sequence[z3.ExprRef]) -> Traits:
        if not children:
            if z3.is_fp_value(term):
                return Traits(frozenset(), frozenset((read_float_value(term),)), False)
            if z3.is_const(term) and term.decl().kind() == z3.Z3_OP_UNINTERPRETED:
                name = term.decl().name()
                names = {name}
                if name in self.derived:
                    for argument in self.derived[name].arguments:
                        if isinstance(argument, z3.ExprRef):
                            names |= self.find_traits(argument).names
                return Traits(frozenset(names), frozenset(), False)
            return _NOTHING
        parts = [self._traits[child.get_id()][1] for child in children]
        if len(parts) == 1:
            names, constants = parts[0].names, parts[0].constants
        else:
            names = frozenset().union(*(part.names for part in parts))
            constants = frozenset().union(*(part.constants for part in parts))
        is_slow = any(part.is_slow for part in parts) or term.decl().kind() in _SLOW_OPERATIONS
        return Traits(names, constants, is_slow)

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
        return all(self.evaluate(each, model) == 1 for each in conditions)

    def find_model(self, conditions: Sequence[z3.BoolRef], model: Model) -> dict[str, int] | None:
        """Values of the variables of some conditions that fulfil them, or None where there are none.

        model: a near miss, from which guesses begin. Raises SolverTimeout.
        """
        key = frozenset(each.get_id() for each in conditions)
        if key in self._answers:
            answer = self._answers[key][0]
            return None if answer is None else dict(answer)
        traits = [self.find_traits(each) for each in conditions]
        names = frozenset().union(*(each.names for each in traits))
        is_slow = any(each.is_slow for each in traits)
        found: dict[str, int] | None = None
        if is_slow or any(name in self.derived for name in names):
            found = self.guess_model(conditions, traits, model, 60)
        if found is None:
            found = self._solve(conditions, traits, names, model)
        self._answers[key] = (found, tuple(conditions))
        return None if found is None else dict(found)

    def _solve(
        self, conditions: Sequence[z3.BoolRef], traits: Sequence[Traits], names: frozenset[str], model: Model
    ) -> dict[str, int] | None:
        self.questions += 1
        solver = z3.Solver()
        left = max(0.05, self.deadline - time.monotonic())
        solver.set("timeout", int(min(2.0, left) * 1000))
        solver.add(*conditions)
        answer = solver.check()
        if answer == z3.unsat:
            return None
        if answer == z3.sat:
            solved = solver.model()
            found = {
                name: solved.eval(self.inputs[name].term, True).as_long()  # pyright: ignore[reportAttributeAccessIssue]
                for name in names
            }
            if any(name in self.derived for name in names):
                settled = dict(found)
                self.settle(settled, names)
                if self.holds(conditions, settled):
                    return settled
            return found
        found = self.guess_model(conditions, traits, model, 200)
        if found is None:
            self.undecided += 1
            raise SolverTimeout
        return found

    def guess_model(
        self, conditions: Sequence[z3.BoolRef], traits: Sequence[Traits], model: Model, tries: int
    ) -> dict[str, int] | None:
        """Values for the floats among the variables, by trial; the others stay as in model."""
        names = frozenset().union(*(each.names for each in traits))
        floats = sorted(name for name in names if self.inputs[name].kind in _FLOATS and name not in self.derived)
        if not floats:
            return None
        base = {name: model.get(name, 0) for name in names}
        # What is hardest is asked first: the newest condition comes last in the list.
        ordered = list(reversed(conditions))
        constants = sorted(
            {abs(value) for each in traits for value in each.constants if math.isfinite(value)},
            key=lambda x: (x == 0, x),
        )[:6]
        for values in itertools.islice(self._list_guesses(floats, constants), tries):
            trial = dict(base)
            for name, value in values.items():
                trial[name] = pack_float(value, self.inputs[name].bits)
            self.settle(trial, names)
            if self.holds(ordered, trial):
                return trial
            if time.monotonic() > self.deadline:
                return None
        return None

    def _list_guesses(self, floats: Sequence[str], constants: Sequence[float]):
        near = (
            [
                signed
                for value in constants
                for each in (value, math.nextafter(value, math.inf), value * 1.5, value * 0.5)
                for signed in (each, -each)
            ]
            if hasattr(math, "nextafter")
            else [s for v in constants for e in (v, v * 1.5, v * 0.5) for s in (e, -e)]
        )
        pool = [*_USUAL[:6], *near, *_USUAL[6:]]
        yield {}
        for value in (0.0, 1.0):
            yield dict.fromkeys(floats, value)
        if len(floats) > 1:
            for name in floats[:8]:
                yield {each: 1.0 if each == name else 0.0 for each in floats}
        for value in pool[:16]:
            for name in floats[:3]:
                yield {name: value}
        while True:
            yield {
                name: self._random.choice(pool) if self._random.random() < 0.7 else self._random.uniform(-10, 10)
                for name in floats
            }
