"""What an exploration says of each field: values that are handled, ignored, only logged, that crash; and witnesses.

A set is exact where the conditions of its paths speak of the field alone; else it is what lies between the least and
the greatest value, marked as relational. All are "may" sets: for some values of the other inputs. Only the complement
of what is handled is certain, where every way was followed to its end.
"""

from __future__ import annotations

import bisect
import itertools
import math
import re
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import z3

from .ir.ranges import FloatSpan, Ranges
from .ir.solving import SolverTimeout, Solving
from .ir.terms import pack_float, read_signed, unpack_float
from .outcomes import CallbackPath, Exploration, InputKind, Reaction, SymbolicInput, Witness

_FLOATS = (InputKind.FLOAT32, InputKind.FLOAT64)
_MOST_SPANS = 16
_MOST_TEXTS = 12
_INDEX = re.compile(r"\[\d+\]")

Number = int | float


@dataclass(frozen=True)
class FieldValues:
    """Values of one field. spans: closed, in order, not touching; infinities and NaN apart. texts: for a text, where it
    is one of a few. is_relational: no value outside of the spans belongs to it, and some inside may not. is_complete:
    whether the solver answered all questions; where it did not, more values may belong to it."""

    spans: tuple[tuple[Number, Number], ...] = ()
    infinities: tuple[float, ...] = ()
    has_nan: bool = False
    texts: tuple[bytes, ...] | None = None
    is_relational: bool = False
    is_complete: bool = True

    def is_empty(self) -> bool:
        return not (self.spans or self.infinities or self.has_nan or self.texts)


@dataclass(frozen=True)
class FieldProjection:
    """One field. path: `msg.ranges[]` stands for all elements. kind: CHARACTER for texts, whose spans are sizes.
    surely_unhandled: no input with such a value is handled; surely_ignored: nor crashes or logs. None where that
    is not known."""

    path: str
    kind: InputKind
    bits: int
    is_signed: bool
    values: Mapping[Reaction, FieldValues]
    surely_unhandled: FieldValues | None
    surely_ignored: FieldValues | None


class _Group(NamedTuple):
    """Conditions of a path that are tied to a field. is_own: they speak of nothing else."""

    conditions: tuple[z3.BoolRef, ...]
    is_own: bool


def project_fields(exploration: Exploration, seconds: float = 10.0, only: str = "") -> list[FieldProjection]:
    """Value sets of all fields that a condition speaks of, in the order of their inputs. seconds: for all of them;
    what is not answered by then is not complete. only: one field, by its path."""
    return _Projector(exploration, seconds).project(only)


class _Projector:
    def __init__(self, exploration: Exploration, seconds: float):
        self.exploration = exploration
        self.deadline = time.monotonic() + seconds
        self.solving = make_solving(exploration, self.deadline)
        self.inputs = exploration.inputs
        self.used = frozenset().union(
            *(self.solving.find_traits(each).names for path in exploration.paths for each in path.condition)
        )
        self._related: dict[tuple[int, str], tuple[tuple[z3.BoolRef, ...], frozenset[str]]] = {}

    def project(self, only: str) -> list[FieldProjection]:
        found = []
        for path, members in self._group_fields().items():
            if only and path != only:
                continue
            first = self.inputs[members[0]]
            if _is_text(self.inputs, members[0]):
                found.append(self._project_text(path, members))
            else:
                found.append(self._project_number(path, members, first))
        return found

    def _group_fields(self) -> dict[str, list[str]]:
        """Generalized path to the inputs that it stands for; texts are named by their sizes."""
        groups: dict[str, list[str]] = {}
        for name, each in self.inputs.items():
            if name.startswith("~") or each.kind is InputKind.CHARACTER:
                continue
            if _is_text(self.inputs, name):
                parts = [name, *_list_characters(self.inputs, name)]
                if not any(part in self.used for part in parts):
                    continue
                groups.setdefault(_INDEX.sub("[]", name.removesuffix(".size")), []).append(name)
            elif name in self.used:
                groups.setdefault(_INDEX.sub("[]", name), []).append(name)
        return groups

    def _find_related(self, number: int, names: Iterable[str]) -> tuple[tuple[z3.BoolRef, ...], frozenset[str]]:
        path = self.exploration.paths[number]
        conditions = self.solving.select_related(path.condition, names)
        seen = frozenset().union(*(self.solving.find_traits(each).names for each in conditions))
        return tuple(conditions), seen

    def _list_existing(self, name: str) -> list[z3.BoolRef] | None:
        """Conditions under which an element exists; None where it never does."""
        found = []
        for index in _INDEX.finditer(name):
            size = self.inputs.get(name[: index.start()] + ".size")
            if size is not None:
                place = int(index[0][1:-1])
                if place >= size.most:
                    return None
                found.append(z3.UGT(size.term, place))
        return found

    def _list_groups(self, number: int, members: Sequence[str], own: frozenset[str]) -> _Group | None:
        """What a path says of a field; None where the field is not there on it."""
        existing = self._list_existing(members[0])
        if existing is None:
            return None
        conditions, seen = self._find_related(number, members)
        if existing:
            path = self.exploration.paths[number]
            whole = self.solving.select_related(
                path.condition, frozenset().union(*(self.solving.find_traits(each).names for each in existing))
            )
            if not self._is_possible([*whole, *existing, *conditions]):
                return None
        if seen <= own:
            return _Group(conditions, True)
        return _Group((*conditions, *existing), False)

    def _is_possible(self, conditions: Sequence[z3.BoolRef]) -> bool:
        try:
            return self.solving.find_model(list(conditions), {}) is not None
        except SolverTimeout:
            return True

    # Numbers.

    def _project_number(self, path: str, members: Sequence[str], first: SymbolicInput) -> FieldProjection:
        values: dict[Reaction, FieldValues] = {}
        for result in Reaction:
            parts = [self._project_member(name, result) for name in members]
            joined = _join_values([part for part in parts if part is not None], first)
            if joined is not None:
                values[result] = joined
        return FieldProjection(
            path, first.kind, first.bits, first.is_signed, values,
            self._find_complement(first, values, (Reaction.HANDLED, Reaction.UNKNOWN)),
            self._find_complement(
                first, values, (Reaction.HANDLED, Reaction.UNKNOWN, Reaction.CRASH, Reaction.LOG_ONLY)
            ),
        )  # fmt: skip

    def _find_complement(
        self, first: SymbolicInput, values: Mapping[Reaction, FieldValues], results: Sequence[Reaction]
    ) -> FieldValues | None:
        """What none of some results can have; None where a way was not followed to its end."""
        if self.exploration.left or not all(values[each].is_complete for each in results if each in values):
            return None
        return complement_values(first, [values[each] for each in results if each in values])

    def _project_member(self, name: str, result: Reaction) -> FieldValues | None:
        groups: dict[frozenset[int], _Group] = {}
        for number, path in enumerate(self.exploration.paths):
            if path.result is not result:
                continue
            if self._is_over():
                return self._list_seen(name, result)
            group = self._list_groups(number, (name,), frozenset((name,)))
            if group is not None:
                groups.setdefault(frozenset(each.get_id() for each in group.conditions), group)
        if not groups:
            return None
        search = _Search(self.inputs[name], self.solving, self.deadline)
        if all(group.is_own for group in groups.values()):
            return search.find_spans([group.conditions for group in groups.values()])
        examples = [
            path.example[name] for path in self.exploration.paths if path.result is result and name in path.example
        ]
        return search.find_extremes([group.conditions for group in groups.values()], examples)

    def _is_over(self) -> bool:
        return time.monotonic() > self.deadline

    def _list_seen(self, name: str, result: Reaction) -> FieldValues:
        """What ways showed as an example, where there is no time to ask for more."""
        search = _Search(self.inputs[name], self.solving, self.deadline)
        paths = (path for path in self.exploration.paths if path.result is result)
        found = search.find_extremes((), [path.example[name] for path in paths if name in path.example])
        return replace(found, is_complete=False)

    # Texts.

    def _project_text(self, path: str, members: Sequence[str]) -> FieldProjection:
        values: dict[Reaction, FieldValues] = {}
        size = self.inputs[members[0]]
        for result in Reaction:
            found = [self._project_text_member(name, result) for name in members]
            joined = _join_values([each for each in found if each is not None], size)
            if joined is not None:
                values[result] = joined
        complement = None
        if not self.exploration.left:
            complement = FieldValues() if Reaction.HANDLED not in values and Reaction.UNKNOWN not in values else None
            if complement is not None:
                complement = FieldValues(((0, size.most),))
        return FieldProjection(path, InputKind.CHARACTER, 8, False, values, complement, None)

    def _project_text_member(self, name: str, result: Reaction) -> FieldValues | None:
        characters = _list_characters(self.inputs, name)
        own = frozenset((name, *characters))
        size = self.inputs[name]
        texts: dict[bytes, None] = {}
        is_finite, is_relational, is_complete = True, False, True
        sizes: list[tuple[Number, Number]] = []
        known: set[frozenset[int]] = set()
        for number, path in enumerate(self.exploration.paths):
            if path.result is not result:
                continue
            if self._is_over():
                sizes.extend(self._list_seen(name, result).spans)
                is_finite = is_complete = False
                break
            group = self._list_groups(number, (name, *characters), own)
            if group is None:
                continue
            # Many ways say the same of a text, and differ in other fields.
            key = frozenset(each.get_id() for each in group.conditions)
            if key in known:
                continue
            known.add(key)
            is_relational |= not group.is_own
            if is_finite:
                found = self._list_texts(name, characters, group.conditions, _MOST_TEXTS + 1 - len(texts))
                if found is None:
                    is_finite = False
                else:
                    texts.update(dict.fromkeys(found))
                    is_finite = len(texts) <= _MOST_TEXTS
            part = _Search(size, self.solving, self.deadline).find_extremes(
                [group.conditions], [path.example[name]] if name in path.example else []
            )
            sizes.extend(part.spans)
            is_complete &= part.is_complete
        if not sizes:
            return None
        return FieldValues(
            merge_spans(sizes), texts=tuple(texts) if is_finite else None, is_relational=is_relational,
            is_complete=is_complete,
        )  # fmt: skip

    def _list_texts(
        self, name: str, characters: Sequence[str], conditions: Sequence[z3.BoolRef], most: int
    ) -> list[bytes] | None:
        """All texts that fulfil conditions, or None where there are more."""
        found: list[bytes] = []
        excluded: list[z3.BoolRef] = []
        size = self.inputs[name].term
        while len(found) < most and time.monotonic() < self.deadline:
            try:
                model = self.solving.find_model([*conditions, *excluded, z3.ULE(size, self.inputs[name].most)], {})
            except SolverTimeout:
                return None
            if model is None:
                return found
            length = model.get(name, 0)
            text = bytes(model.get(each, 0) for each in characters[:length])
            found.append(text)
            same = [self.inputs[each].term == byte for each, byte in zip(characters, text, strict=False)]
            excluded.append(z3.Not(z3.And(size == length, *same)))  # pyright: ignore[reportArgumentType]
        return None


def make_solving(exploration: Exploration, deadline: float) -> Solving:
    """A solver that knows the variables of an exploration."""
    solving = Solving(deadline)
    solving.inputs.update(exploration.inputs)
    solving.derived.update(exploration.functions)
    return solving


def _is_text(inputs: Mapping[str, SymbolicInput], name: str) -> bool:
    """Whether a size is that of a text."""
    first = inputs.get(name.removesuffix(".size") + "[0]")
    return name.endswith(".size") and first is not None and first.kind is InputKind.CHARACTER


def _list_characters(inputs: Mapping[str, SymbolicInput], name: str) -> list[str]:
    base = name.removesuffix(".size")
    paths = (f"{base}[{index}]" for index in itertools.count())
    return list(itertools.takewhile(lambda path: path in inputs, paths))


class _Search:
    """Finds least and greatest values of one input under conditions. Keys are not signed numbers in the order of the
    values, so that floats and signed integers are searched alike."""

    def __init__(self, variable: SymbolicInput, solving: Solving, deadline: float):
        self.variable = variable
        self.deadline = deadline
        self.solving = solving
        bits, term = variable.bits, variable.term
        self.top = (1 << bits) - 1
        if variable.kind in _FLOATS:
            negative = z3.Extract(bits - 1, bits - 1, term) == 1
            self.key = z3.If(negative, ~term, term | z3.BitVecVal(1 << (bits - 1), bits))
        elif variable.is_signed:
            self.key = term ^ z3.BitVecVal(1 << (bits - 1), bits)
        else:
            self.key = term
        self.is_complete = True

    def make_key(self, value: int) -> int:
        """Of the bits of a value."""
        half = 1 << (self.variable.bits - 1)
        if self.variable.kind in _FLOATS:
            return value ^ self.top if value & half else value | half
        return value ^ half if self.variable.is_signed else value

    def make_bits(self, key: int) -> int:
        """Of a float's value, from its key."""
        half = 1 << (self.variable.bits - 1)
        return key ^ half if key & half else key ^ self.top

    def read_key(self, key: int) -> Number:
        half = 1 << (self.variable.bits - 1)
        if self.variable.kind in _FLOATS:
            return unpack_float(self.make_bits(key), self.variable.bits)
        return read_signed(key ^ half, self.variable.bits) if self.variable.is_signed else key

    def _get_bounds(self) -> tuple[int, int]:
        if self.variable.kind in _FLOATS:
            bits = self.variable.bits
            largest = 1.7976931348623157e308 if bits == 64 else 3.4028234663852886e38
            return self.make_key(pack_float(-largest, bits)), self.make_key(pack_float(largest, bits))
        if self.variable.kind is InputKind.BOOLEAN:
            return 0, 1
        return 0, self.variable.most if self.variable.kind is InputKind.SIZE else self.top

    def _find_end(self, question: _Question, low: int, high: int, is_least: bool, hints: Sequence[int]) -> int | None:
        """The least or greatest key between two that is allowed; hints are asked first."""
        edge = low if is_least else high
        if question.find_key(edge, edge, is_least) is not None:
            return edge
        best = question.find_key(low, high, is_least)
        if best is None:
            return None
        low, high = (low, best) if is_least else (best, high)
        while low < high:
            inside = hints[bisect.bisect_left(hints, low) : bisect.bisect_left(hints, high)]
            middle = inside[len(inside) // 2] if inside else (low + high) // 2
            if not is_least:
                middle = max(middle, low + 1) if inside else (low + high + 1) // 2
            found = question.find_key(low, middle, True) if is_least else question.find_key(middle, high, False)
            if found is None:
                if not question.is_complete:
                    self.is_complete = False
                    return best
                low, high = (middle + 1, high) if is_least else (low, middle - 1)
            elif is_least:
                best = high = found
            else:
                best = low = found
        return low if is_least else high

    def _list_hints(self, groups: Iterable[Sequence[z3.BoolRef]]) -> list[int]:
        """Keys at which a set may begin or end: of the constants in its conditions, and beside them."""
        keys: set[int] = set()
        for term in {each.get_id(): each for group in groups for each in group}.values():
            if self.variable.kind in _FLOATS:
                for value in self.solving.find_traits(term).constants:
                    if math.isfinite(value):
                        for signed in (value, -value):
                            key = self.make_key(pack_float(signed, self.variable.bits))
                            keys.update((key - 1, key, key + 1))
            else:
                for value in self.solving.list_integers(term):
                    key = self.make_key(value & self.top)
                    keys.update((key - 1, key, key + 1))
        low, high = self._get_bounds()
        if self.variable.kind in _FLOATS:
            zero = self.make_key(0)
            keys.update((zero - 1, zero))
        return sorted(key for key in {*keys, low, high} if low <= key <= high)

    def _find_special(self, groups: Sequence[Sequence[z3.BoolRef]]) -> tuple[tuple[float, ...], bool]:
        """Infinities and NaN that some group allows."""
        if self.variable.kind not in _FLOATS:
            return (), False
        found = []
        for value in (-math.inf, math.inf, math.nan):
            bits = pack_float(value, self.variable.bits)
            found.append(any(self._allows(group, bits) for group in groups))
        return tuple(v for v, there in zip((-math.inf, math.inf), found[:2], strict=True) if there), found[2]

    def _allows(self, group: Sequence[z3.BoolRef], bits: int) -> bool:
        pair = (self.variable.term, z3.BitVecVal(bits, self.variable.bits))
        left = [z3.simplify(z3.substitute(each, pair)) for each in group]
        if any(z3.is_false(each) for each in left):
            return False
        left = [each for each in left if not z3.is_true(each)]
        if not left:
            return True
        ranges = Ranges(self.solving.inputs)
        if any(ranges.is_impossible(each) for each in left):  # pyright: ignore[reportArgumentType]
            return False
        try:
            return self.solving.find_model(left, {}) is not None  # pyright: ignore[reportArgumentType]
        except SolverTimeout:
            self.is_complete = False
            return True

    def find_spans(self, groups: Sequence[Sequence[z3.BoolRef]]) -> FieldValues:
        """The exact set of values that some group of conditions allows; each speaks of this input alone."""
        low, high = self._get_bounds()
        if any(not group for group in groups):
            is_float = self.variable.kind in _FLOATS
            return FieldValues(
                ((self.read_key(low), self.read_key(high)),), (-math.inf, math.inf) if is_float else (), is_float
            )
        hints = self._list_hints(groups)
        union: z3.BoolRef = z3.Or(*[z3.And(*group) for group in groups])  # pyright: ignore[reportAssignmentType]
        inside, outside = _Question(self, [union], False), _Question(self, [z3.Not(union)], False)  # pyright: ignore[reportArgumentType]
        spans: list[tuple[int, int]] = []
        place = low
        while place <= high and len(spans) < _MOST_SPANS:
            first = self._find_end(inside, place, high, True, hints)
            if first is None:
                break
            after = self._find_end(outside, first, high, True, hints)
            last = high if after is None else after - 1
            spans.append((first, last))
            place = last + 1
        is_relational = False
        if len(spans) == _MOST_SPANS:
            # Too many to list: from the last one on, up to the greatest.
            greatest = self._find_end(inside, low, high, False, hints)
            if greatest is not None and greatest > spans[-1][1]:
                spans[-1] = (spans[-1][0], greatest)
                is_relational = True
        infinities, has_nan = self._find_special(groups)
        return FieldValues(
            tuple((self.read_key(first), self.read_key(last)) for first, last in spans), infinities, has_nan,
            is_relational=is_relational, is_complete=self.is_complete,
        )  # fmt: skip

    def find_extremes(self, groups: Sequence[Sequence[z3.BoolRef]], examples: Sequence[int]) -> FieldValues:
        """Least and greatest value; examples are bits that are known to be allowed."""
        low, high = self._get_bounds()
        keys = [key for key in map(self.make_key, examples) if low <= key <= high]
        hints = self._list_hints(groups)
        least, greatest = (min(keys), max(keys)) if keys else (None, None)
        for group in groups:
            question = _Question(self, group, True)
            for is_least in (True, False):
                known = least if is_least else greatest
                start, end = (low, high) if known is None else (low, known - 1) if is_least else (known + 1, high)
                if start > end:
                    continue
                found = self._find_end(question, start, end, is_least, hints)
                self.is_complete &= question.is_complete
                if found is not None:
                    least, greatest = (found, greatest) if is_least else (least, found)
                    least = found if least is None else least
                    greatest = found if greatest is None else greatest
        infinities, has_nan = self._find_special(groups)
        spans = ((self.read_key(least), self.read_key(greatest)),) if least is not None and greatest is not None else ()
        return FieldValues(spans, infinities, has_nan, is_relational=True, is_complete=self.is_complete)


class _Question:
    """Conditions of which is asked, again and again, whether they allow a key between two. Bounds answer first, then
    trials, then the solver. is_wide: once the solver gave no answer, what bounds do not exclude is allowed."""

    def __init__(self, search: _Search, conditions: Sequence[z3.BoolRef], is_wide: bool):
        self.is_wide = is_wide
        self._is_given_up = False
        self.search = search
        self.conditions = list(conditions)
        self.is_complete = True
        self._traits = [search.solving.find_traits(each) for each in conditions]
        self._is_slow = any(each.is_slow for each in self._traits)
        self._names = frozenset().union(*(each.names for each in self._traits))
        self._solver: z3.Solver | None = None

    def find_key(self, low: int, high: int, is_least: bool) -> int | None:
        """A key from low to high that the conditions allow, or None. is_least: whether a small one is looked for."""
        search = self.search
        if time.monotonic() > search.deadline:
            self.is_complete = False
            return None
        if search.variable.kind in _FLOATS:
            span = FloatSpan(float(search.read_key(low)), float(search.read_key(high)), False)
            ranges = Ranges(search.solving.inputs, {search.variable.path: span})
            if any(ranges.is_impossible(each) for each in self.conditions):
                return None
            found = self._guess_key(low, high)
            if found is not None:
                return found
        if not self._is_given_up:
            found = self._solve(low, high)
            if not self._is_given_up:
                return found
        return high if is_least else low

    def _guess_key(self, low: int, high: int) -> int | None:
        search = self.search
        name, solving = search.variable.path, search.solving
        floats = [
            each
            for each in self._names
            if each != name and each not in solving.derived and solving.inputs[each].kind in _FLOATS
        ]
        base = dict.fromkeys(self._names, 0)
        others = [dict.fromkeys(floats, 0.0)]
        if floats:
            others.append(dict.fromkeys(floats, 1.0))
        if self._is_slow:
            others += [{**others[0], each: step / 10} for each in floats[:2] for step in (9, 7, 5, 3, 10, 15, 20)]
        keys = dict.fromkeys((low, high, (low + high) // 2))
        for key in keys:
            bits = search.make_bits(key)
            for values in others:
                packed = {each: pack_float(value, solving.inputs[each].bits) for each, value in values.items()}
                trial = {**base, **packed, name: bits}
                solving.settle(trial, self._names)
                if solving.holds(self.conditions, trial):
                    return key
        return None

    def _solve(self, low: int, high: int) -> int | None:
        search = self.search
        if self._solver is None:
            self._solver = z3.Solver()
            self._solver.add(*self.conditions)
        solver = self._solver
        limit = 0.3 if self._is_slow else 2.0
        solver.set("timeout", int(1000 * max(0.05, min(limit, search.deadline - time.monotonic()))))
        solver.push()
        solver.add(z3.UGE(search.key, low), z3.ULE(search.key, high))
        answer = solver.check()
        found = None
        if answer == z3.sat:
            found = solver.model().eval(search.key, True).as_long()  # pyright: ignore[reportAttributeAccessIssue]
        elif answer == z3.unknown:
            self.is_complete = self.is_wide
            self._is_given_up = self.is_wide
        solver.pop()
        return found


def merge_spans(spans: Iterable[tuple[Number, Number]]) -> tuple[tuple[Number, Number], ...]:
    """Spans in order, those that overlap or touch as one."""
    merged: list[tuple[Number, Number]] = []
    for low, high in sorted(spans):
        step = 1 if isinstance(low, int) else 0
        if merged and low <= merged[-1][1] + step:
            merged[-1] = (merged[-1][0], max(merged[-1][1], high))
        else:
            merged.append((low, high))
    return tuple(merged)


def _join_values(parts: Sequence[FieldValues], first: SymbolicInput) -> FieldValues | None:
    if not parts:
        return None
    texts: dict[bytes, None] | None = {}
    for part in parts:
        if part.texts is None:
            texts = None
            break
        texts.update(dict.fromkeys(part.texts))
    return FieldValues(
        merge_spans(span for part in parts for span in part.spans),
        tuple(sorted({value for part in parts for value in part.infinities})),
        any(part.has_nan for part in parts),
        tuple(texts) if texts is not None else None,
        any(part.is_relational for part in parts),
        all(part.is_complete for part in parts),
    )


def complement_values(first: SymbolicInput, parts: Sequence[FieldValues]) -> FieldValues:
    """All values of an input but some."""
    search = _Search(first, Solving(0.0), 0.0)
    low, high = search._get_bounds()
    taken = sorted(
        (search.make_key(_pack(first, span[0])), search.make_key(_pack(first, span[1])))
        for part in parts
        for span in part.spans
    )
    spans: list[tuple[Number, Number]] = []
    place = low
    for start, end in taken:
        if start > place:
            spans.append((search.read_key(place), search.read_key(start - 1)))
        place = max(place, end + 1)
    if place <= high:
        spans.append((search.read_key(place), search.read_key(high)))
    is_float = first.kind in _FLOATS
    taken_infinities = {value for part in parts for value in part.infinities}
    return FieldValues(
        tuple(spans),
        tuple(value for value in (-math.inf, math.inf) if value not in taken_infinities) if is_float else (),
        is_float and not any(part.has_nan for part in parts),
    )


def _pack(variable: SymbolicInput, value: Number) -> int:
    if variable.kind in _FLOATS:
        return pack_float(float(value), variable.bits)
    return int(value) & ((1 << variable.bits) - 1)


def format_values(values: FieldValues, names: Mapping[int, str] | None = None) -> str:
    """A set as text: `GREEN, ORANGE, 3..255`; names: of constants, by value. `relational` is added where it is so."""
    parts: list[str] = []
    if values.texts is not None:
        parts = [_quote(each) for each in sorted(values.texts)]
    else:
        for low, high in values.spans:
            if names and isinstance(low, int) and isinstance(high, int) and high - low < 16:
                parts.extend(names.get(each, str(each)) for each in range(low, high + 1))
            else:
                parts.append(_spell(low) if low == high else f"{_spell(low)}..{_spell(high)}")
    parts.extend("inf" if each > 0 else "-inf" for each in values.infinities)
    if values.has_nan:
        parts.append("NaN")
    text = ", ".join(parts) or "none"
    return f"{text} (relational)" if values.is_relational else text


def _spell(value: Number) -> str:
    return repr(value) if isinstance(value, float) else str(value)


def _quote(text: bytes) -> str:
    return '"' + text.decode("latin-1").encode("unicode_escape").decode().replace('"', '\\"') + '"'


# Witnesses.

_INTEGERS = (0, 1, 2, 3, -1, 4, 5, 10, 100, -10, -100)
_FLOAT_VALUES = (0.0, 1.0, -1.0, 0.5, 2.0, -0.5, -2.0, 10.0, -10.0, 100.0, -100.0)
_CHARACTERS = b"a0 1bx_-./"


def make_witness(exploration: Exploration, path: CallbackPath, seconds: float = 2.0) -> Witness | None:
    """An input that leads along a path, with small values that a person can read: 0, 1, short printable texts. Where a
    member is written, it differs from before. None where no input was found.

    The values are of all inputs but those that stand for what is not known (`~` with `#`).
    """
    deadline = time.monotonic() + seconds
    solving = make_solving(exploration, deadline)
    conditions = [*path.condition, *path.shown_by]
    model = {name: path.example.get(name, 0) for name in exploration.inputs}
    names = frozenset().union(*(solving.find_traits(each).names for each in conditions))
    solving.settle(model, names)
    if not path.example or not solving.holds(conditions, model):
        found = _solve_parts(solving, conditions, model)
        if found is None and path.shown_by:
            # What cannot be shown is left: a replay sees no member change.
            conditions = list(path.condition)
            found = _solve_parts(solving, conditions, model)
        if found is None and not path.example:
            return None
        model.update(found or path.example)
    for name in _order_inputs(exploration.inputs):
        if name not in names:
            model[name] = 0
    _reduce_values(exploration, solving, conditions, model, names, deadline)
    values = {name: value for name, value in model.items() if "#" not in name}
    return Witness(values, path.result, path.crash, path.place)


def _solve_parts(solving: Solving, conditions: Sequence[z3.BoolRef], model: Mapping[str, int]) -> dict[str, int] | None:
    """A model of conditions, part by part."""
    found: dict[str, int] = dict(model)
    left = list(conditions)
    while left:
        part = solving.select_related(left, solving.find_traits(left[0]).names) or [left[0]]
        try:
            answer = solving.find_model(part, found)
        except SolverTimeout:
            return None
        if answer is None:
            return None
        found.update(answer)
        numbers = {each.get_id() for each in part}
        left = [each for each in left if each.get_id() not in numbers]
    return found


def _order_inputs(inputs: Mapping[str, SymbolicInput]) -> list[str]:
    """Sizes first: what lies past an end is of no account."""
    return sorted(inputs, key=lambda name: inputs[name].kind is not InputKind.SIZE)


def _reduce_values(
    exploration: Exploration, solving: Solving, conditions: Sequence[z3.BoolRef], model: dict[str, int],
    names: frozenset[str], deadline: float,
):  # fmt: skip
    """Replaces values by simpler ones, as long as all conditions hold, in place."""
    derived = set(solving.derived)
    for name in _order_inputs(exploration.inputs):
        if name not in names or "#" in name:
            continue
        variable = exploration.inputs[name]
        own = [each for each in conditions if name in solving.find_traits(each).names]
        tied = derived & frozenset().union(*(solving.find_traits(each).names for each in own))
        simpler = _list_simple(variable, model[name])
        if _lies_past_end(exploration.inputs, model, name):
            simpler = iter((0,))
        for value in simpler:
            if value == model[name]:
                break
            if time.monotonic() > deadline:
                return
            trial = dict(model)
            trial[name] = value
            if tied:
                solving.settle(trial, tied)
            if solving.holds(own, trial):
                model.update(trial)
                break


def _lies_past_end(inputs: Mapping[str, SymbolicInput], model: Mapping[str, int], name: str) -> bool:
    """Whether an array or a text ends before an element."""
    for index in _INDEX.finditer(name):
        size = name[: index.start()] + ".size"
        if size in inputs and int(index[0][1:-1]) >= model.get(size, 0):
            return True
    return False


def _list_simple(variable: SymbolicInput, current: int) -> Iterator[int]:
    """Bits of values to try, simplest first; it ends at those that are no simpler than the current one."""
    bits = variable.bits
    top = (1 << bits) - 1
    if variable.kind is InputKind.SIZE:
        yield from range(current)
    elif variable.kind is InputKind.CHARACTER:
        yield from (*_CHARACTERS, 0) if not 32 < current < 127 or current == 92 else ()
    elif variable.kind is InputKind.BOOLEAN:
        yield 0
    elif variable.kind in _FLOATS:
        yield from (pack_float(value, bits) for value in _FLOAT_VALUES)
        now = unpack_float(current, bits)
        if math.isfinite(now):
            for digits in range(-3, 4):
                rounded = round(now, digits)
                if abs(rounded) <= 3e38 or bits == 64:
                    yield pack_float(rounded, bits)
    else:
        yield from (value & top for value in _INTEGERS if variable.is_signed or value >= 0)
        size = read_signed(current, bits) if variable.is_signed else current
        for power in range(1, 20):
            if abs(size) > 10**power:
                yield (10**power if size > 0 else -(10**power)) & top
