"""What a callback publishes: the values of one field, over all ways that publish it.

Least and greatest values are found by asking for something beyond those that are known, so few questions are needed
where a value is clamped. A set of few values is listed.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import z3

from .ir.ranges import Ranges, narrow_floats
from .ir.solving import SolverTimeout, Solving
from .ir.terms import make_float, pack_float, read_float_bits, read_signed, unpack_float
from .outcomes import CallbackPath, Exploration, InputKind, Reaction, Sent, SymbolicInput
from .projection import FieldValues, Number, make_solving, merge_spans, project_fields

_FLOATS = (InputKind.FLOAT32, InputKind.FLOAT64)
_SENT = "sent.value"
_FEW = 8
_TRIED = 12
_STEPS = 12


@dataclass
class _Collected:
    """What is known of one field while paths are looked at."""

    kind: InputKind
    bits: int
    is_signed: bool
    numbers: set[int] = field(default_factory=set)
    terms: list[tuple[CallbackPath, z3.BitVecRef]] = field(default_factory=list)


def project_sent(
    exploration: Exploration, rows: Sequence[tuple[CallbackPath, Sent]], name: str, kind: tuple[InputKind, int, bool],
    seconds: float,
) -> FieldValues | None:  # fmt: skip
    """The values of one field, over paths that send it; None where none says what it sends. kind: CHARACTER for a
    text, as a whole."""
    if kind[0] is InputKind.CHARACTER:
        return _project_text(exploration, rows, name, seconds)
    known = [(path, sent) for path, sent in rows if name in sent.values]
    if not known:
        return None
    collected = _Collected(*known[0][1].kinds[name])
    for path, sent in known:
        value = sent.values[name]
        if isinstance(value, int):
            collected.numbers.add(value)
        else:
            collected.terms.append((path, value))
    return _find_values(collected, make_solving(exploration, time.monotonic() + seconds))


def _project_text(
    exploration: Exploration, rows: Sequence[tuple[CallbackPath, Sent]], name: str, seconds: float
) -> FieldValues | None:
    """A text is projected as one that is received is: variables equal its size and its bytes on each way."""
    added: dict[str, SymbolicInput] = {}
    paths: list[CallbackPath] = []
    for way, one in rows:
        terms = list(_tie_text(one, name, added))
        if terms and all(term is not None for term in terms):
            condition = (*way.condition, *[term for term in terms if term is not None])
            paths.append(replace(way, result=Reaction.HANDLED, condition=condition, example={}, shown_by=()))
    if not paths:
        return None
    asked = replace(exploration, inputs={**exploration.inputs, **added}, paths=paths)
    found = next(iter(project_fields(asked, seconds, only=_SENT)), None)
    return found.values.get(Reaction.HANDLED) if found is not None else None


def _tie_text(sent: Sent, name: str, added: dict[str, SymbolicInput]) -> Iterator[z3.BoolRef | None]:
    """That variables, which are added, equal the size and the bytes of a text; None for what is not known."""
    leaves = [(".size", InputKind.SIZE, 64)]
    while f"{name}[{len(leaves) - 1}]" in sent.values:
        leaves.append((f"[{len(leaves) - 1}]", InputKind.CHARACTER, 8))
    for suffix, kind, bits in leaves:
        value = sent.values.get(name + suffix)
        if value is None:
            yield None
            return
        path = _SENT + suffix
        if path not in added:
            added[path] = SymbolicInput(path, kind, bits, False, z3.BitVec(path, bits), 1 << 20)
        given = z3.BitVecVal(value, bits) if isinstance(value, int) else value
        yield added[path].term == given if given.size() == bits else None  # pyright: ignore[reportReturnType]


def _find_values(collected: _Collected, solving: Solving) -> FieldValues:
    if not collected.terms:
        return _list_values(collected, collected.numbers)
    if collected.kind not in _FLOATS or len(collected.terms) == 1:
        few = _list_few(collected, solving)
        if few is not None:
            return _list_values(collected, few)
    return _find_hull(collected, solving)


def _read_value(collected: _Collected, bits: int) -> Number:
    if collected.kind in _FLOATS:
        return unpack_float(bits, collected.bits)
    return read_signed(bits, collected.bits) if collected.is_signed else bits


def _list_values(collected: _Collected, bits: Iterable[int]) -> FieldValues:
    """A set of single values."""
    values = [_read_value(collected, each) for each in bits]
    finite = [value for value in values if math.isfinite(value)]
    return FieldValues(
        merge_spans((value, value) for value in finite),
        tuple(sorted({float(value) for value in values if math.isinf(value)})),
        any(math.isnan(value) for value in values),
    )


def _list_few(collected: _Collected, solving: Solving) -> set[int] | None:
    """All values, where they are few and the solver names them."""
    found = set(collected.numbers)
    for path, term in collected.terms:
        conditions = solving.select_related(path.condition, solving.find_traits(term).names)
        if len(found | _find_some(solving, path, term, conditions)) > _FEW:
            return None
        own: list[z3.BoolRef] = []
        while True:
            try:
                model = solving.find_model([*conditions, *own], path.example) if (conditions or own) else path.example
            except SolverTimeout:
                return None
            if model is None:
                break
            value = solving.evaluate(term, {**path.example, **model})
            if not isinstance(value, int) or len(found) >= _FEW:
                return None
            found.add(value)
            own.append(term != z3.BitVecVal(value, collected.bits))  # pyright: ignore[reportArgumentType]
    return found


def _find_some(solving: Solving, path: CallbackPath, term: z3.BitVecRef, conditions: Sequence[z3.BoolRef]) -> set[int]:
    """Values of a term that are had without the solver, by small numbers for one of its inputs."""
    found: set[int] = set()
    for name in sorted(solving.find_traits(term).names)[:3]:
        given = solving.inputs.get(name)
        if given is None:
            continue
        for number in range(_TRIED):
            trial = {**path.example, name: pack_float(number, given.bits) if given.kind in _FLOATS else number}
            if solving.holds_settled(conditions, trial) and isinstance(value := solving.evaluate(term, trial), int):
                found.add(value)
    return found


def _find_hull(collected: _Collected, solving: Solving) -> FieldValues:
    """Least and greatest value; what the solver does not exclude is taken to be possible."""
    numbers = _list_values(collected, collected.numbers)
    spans = list(numbers.spans)
    infinities, has_nan, is_complete = set(numbers.infinities), numbers.has_nan, True
    for path, term in collected.terms:
        hull = _Hull(collected, solving, path, term)
        spans.extend(hull.find_span())
        if collected.kind in _FLOATS:
            infinities.update(each for each in (-math.inf, math.inf) if hull.allows_special(each))
            has_nan |= hull.allows_special(math.nan)
        is_complete &= hull.is_complete
    merged = merge_spans(spans)
    if len(merged) > 1 and collected.terms:
        merged = ((merged[0][0], merged[-1][1]),)
    return FieldValues(merged, tuple(sorted(infinities)), has_nan, is_relational=True, is_complete=is_complete)


class _Hull:
    """The values of one term under the conditions of one path."""

    def __init__(self, collected: _Collected, solving: Solving, path: CallbackPath, term: z3.BitVecRef):
        self.collected = collected
        self.solving = solving
        self.example = path.example
        self.bits = term
        self.is_float = collected.kind in _FLOATS
        self.is_complete = True
        self.term: Any = read_float_bits(term, collected.bits) if self.is_float else term
        self.conditions = solving.select_related(path.condition, solving.find_traits(term).names)

    def _ask(self, condition: Any) -> dict[str, int] | bool | None:
        """A model where a condition holds, None where it cannot, True where that is not known."""
        if self._is_excluded(condition):
            return None
        try:
            return self.solving.find_model([*self.conditions, condition], self.example)
        except SolverTimeout:
            return True

    def allows_special(self, value: float) -> bool:
        same = z3.fpIsNaN(self.term) if math.isnan(value) else self.term == make_float(value, self.collected.bits)
        return self._ask(same) is not None

    def _compare(self, predicate: str, value: Number) -> Any:
        if self.is_float:
            compare = z3.fpLT if predicate == "lt" else z3.fpGT
            infinite = z3.fpIsInf(self.term)
            return z3.And(compare(self.term, make_float(float(value), self.collected.bits)), z3.Not(infinite))
        if self.collected.is_signed:
            return self.term < value if predicate == "lt" else self.term > value
        return z3.ULT(self.term, value) if predicate == "lt" else z3.UGT(self.term, value)

    def find_span(self) -> Sequence[tuple[Number, Number]]:
        """One span, or none where there is no finite value."""
        start = self.solving.evaluate(self.bits, self.example)
        value = _read_value(self.collected, start) if isinstance(start, int) else math.nan
        if not math.isfinite(value):
            found = self._ask(z3.Not(z3.Or(z3.fpIsNaN(self.term), z3.fpIsInf(self.term)))) if self.is_float else None
            if not isinstance(found, dict):
                self.is_complete &= found is not True
                return ()
            start = self.solving.evaluate(self.bits, {**self.example, **found})
            value = _read_value(self.collected, start) if isinstance(start, int) else math.nan
            if not math.isfinite(value):
                return ()
        low, high = self._extend(value, "lt"), self._extend(value, "gt")
        return ((low, high),)

    def _extend(self, value: Number, predicate: str) -> Number:
        """The farthest value in one direction: what is farther is asked for until there is nothing."""
        limit = self._get_limit(predicate)
        for step in range(_STEPS):
            if step == 1 and self._ask(self._compare(predicate, _divide_limit(limit, self.is_float))) is not None:
                return limit
            found = self._ask(self._compare(predicate, value))
            if found is None:
                return value
            if not isinstance(found, dict):
                break
            bits = self.solving.evaluate(self.bits, {**self.example, **found})
            following = _read_value(self.collected, bits) if isinstance(bits, int) else math.nan
            if not math.isfinite(following) or following == value:
                break
            value = following
        else:
            return self._search_end(value, limit, predicate, is_asking=True)
        return self._search_end(value, limit, predicate, is_asking=False)

    def _get_limit(self, predicate: str) -> Number:
        bits = self.collected.bits
        if self.is_float:
            largest = 1.7976931348623157e308 if bits == 64 else 3.4028234663852886e38
            return -largest if predicate == "lt" else largest
        if self.collected.is_signed:
            return -(1 << (bits - 1)) if predicate == "lt" else (1 << (bits - 1)) - 1
        return 0 if predicate == "lt" else (1 << bits) - 1

    def _search_end(self, value: Number, limit: Number, predicate: str, is_asking: bool) -> Number:
        """Between a value that is there and one that need not be: what bounds do not exclude is kept. is_asking: nor
        the solver, as long as it answers."""
        outside = self._make_key(limit)
        inside = self._make_key(value) + (1 if predicate == "lt" else -1)  # So that the value itself may be the end.
        while abs(outside - inside) > 1:
            middle = (inside + outside) // 2
            beyond = self._compare(predicate, self._read_key(middle))
            answer = self._ask(beyond) if is_asking else None if self._is_excluded(beyond) else True
            is_asking = is_asking and answer is not True
            if answer is None:
                outside = middle
            else:
                inside = middle
        return self._read_key(outside)

    def _make_key(self, value: Number) -> int:
        """Whole numbers in the order of values, so that floats are halved by their bits."""
        if not self.is_float:
            return int(value)
        bits = pack_float(float(value), self.collected.bits)
        half = 1 << (self.collected.bits - 1)
        return half - bits if bits & half else bits

    def _read_key(self, key: int) -> Number:
        if not self.is_float:
            return key
        half = 1 << (self.collected.bits - 1)
        return unpack_float(half - key if key < 0 else key, self.collected.bits)

    def _is_excluded(self, condition: Any) -> bool:
        condition = z3.simplify(condition)
        ranges = Ranges(self.solving.inputs, narrow_floats(self.conditions))
        return z3.is_false(condition) or ranges.is_impossible(condition)  # pyright: ignore[reportArgumentType]


def _divide_limit(limit: Number, is_float: bool) -> Number:
    return limit / 2 if is_float else int(limit) // 2
