"""Bounds of terms without a solver: whether a condition cannot hold, where its two sides lie apart.

Bounds hold for all values of the variables, whatever the other conditions say; a size is known not to exceed its bound.
Those of integers are signed. Those of floats are exact at their ends: rounding to the nearest keeps the order.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

import z3

from ..outcomes import InputKind, SymbolicInput
from .terms import read_float_value, read_signed, round_float


class Span(NamedTuple):
    """Least and greatest signed value."""

    low: int
    high: int


class FloatSpan(NamedTuple):
    """Least and greatest value, and whether it may be NaN. The least exceeds the greatest where it is nothing else."""

    low: float
    high: float
    has_nan: bool


_ANY_FLOAT = FloatSpan(-math.inf, math.inf, True)
_ONLY_NAN = FloatSpan(math.inf, -math.inf, True)
_FLOAT_COMPARISONS = frozenset((z3.Z3_OP_FPA_LT, z3.Z3_OP_FPA_LE, z3.Z3_OP_FPA_GT, z3.Z3_OP_FPA_GE, z3.Z3_OP_FPA_EQ))
_COMPARISONS = frozenset((z3.Z3_OP_SLEQ, z3.Z3_OP_SGEQ, z3.Z3_OP_SLT, z3.Z3_OP_SGT))
_UNSIGNED = {
    z3.Z3_OP_ULEQ: z3.Z3_OP_SLEQ, z3.Z3_OP_UGEQ: z3.Z3_OP_SGEQ, z3.Z3_OP_ULT: z3.Z3_OP_SLT, z3.Z3_OP_UGT: z3.Z3_OP_SGT,
}  # fmt: skip


class Ranges:
    """Spans of terms, each found once."""

    def __init__(self, inputs: Mapping[str, SymbolicInput], known: Mapping[str | int, FloatSpan] | None = None):
        """known: spans of some floats, as `narrow_floats` gives them. The terms must live as long as this."""
        self._inputs = inputs
        self._known = known or {}
        self._spans: dict[int, tuple[Any, Span]] = {}
        self._float_spans: dict[int, tuple[Any, FloatSpan]] = {}

    def is_impossible(self, condition: z3.BoolRef) -> bool:
        """Whether no values at all fulfil a condition, as far as bounds show it."""
        return self._decide(condition, 8) is False

    def _decide(self, condition: Any, depth: int) -> bool | None:
        kind = condition.decl().kind()
        if depth == 0:
            return None
        if kind == z3.Z3_OP_NOT:
            inner = self._decide(condition.arg(0), depth - 1)
            return None if inner is None else not inner
        if kind in (z3.Z3_OP_AND, z3.Z3_OP_OR):
            answers = [self._decide(each, depth - 1) for each in condition.children()]
            decisive = kind == z3.Z3_OP_OR
            if decisive in answers:
                return decisive
            return None if None in answers else not decisive
        if kind in _COMPARISONS or kind in _UNSIGNED:
            left, right = self.find_span(condition.arg(0)), self.find_span(condition.arg(1))
            if kind in _UNSIGNED:
                bits = condition.arg(0).size()
                left, right = _make_unsigned(left, bits), _make_unsigned(right, bits)
                kind = _UNSIGNED[kind]
            return _compare(kind, left, right)
        if kind == z3.Z3_OP_EQ and z3.is_bv(condition.arg(0)):
            left, right = self.find_span(condition.arg(0)), self.find_span(condition.arg(1))
            if left.high < right.low or right.high < left.low:
                return False
        if kind in _FLOAT_COMPARISONS:
            return _compare_floats(kind, self.find_float_span(condition.arg(0)), self.find_float_span(condition.arg(1)))
        if kind == z3.Z3_OP_FPA_IS_NAN:
            span = self.find_float_span(condition.arg(0))
            return False if not span.has_nan else True if span.low > span.high else None
        return None

    def find_float_span(self, term: Any) -> FloatSpan:
        """Bounds of a float."""
        known = self._float_spans.get(term.get_id())
        if known is not None:
            return known[1]
        pending = [term]
        while pending:
            each = pending[-1]
            missing = [
                child for child in each.children() if z3.is_fp(child) and child.get_id() not in self._float_spans
            ]
            if missing and each.get_id() not in self._float_spans:
                pending.extend(missing)
                continue
            pending.pop()
            if each.get_id() not in self._float_spans:
                span = self._derive_float(each)
                if each.get_id() in self._known:
                    span = _narrow_span(span, self._known[each.get_id()])
                self._float_spans[each.get_id()] = (each, span)
        return self._float_spans[term.get_id()][1]

    def _derive_float(self, term: Any) -> FloatSpan:
        if z3.is_fp_value(term):
            value = read_float_value(term)
            return _ONLY_NAN if math.isnan(value) else FloatSpan(value, value, False)
        kind = term.decl().kind()
        bits = term.sort().ebits() + term.sort().sbits()
        parts = [self._float_spans[child.get_id()][1] for child in term.children() if z3.is_fp(child)]
        if kind in (z3.Z3_OP_FPA_TO_FP, z3.Z3_OP_FPA_TO_FP_UNSIGNED):
            return self._derive_conversion(term, parts, bits)
        if kind == z3.Z3_OP_ITE:
            return self._derive_choice(term, {}, 4)
        if kind == z3.Z3_OP_FPA_NEG:
            return FloatSpan(-parts[0].high, -parts[0].low, parts[0].has_nan)
        if kind == z3.Z3_OP_FPA_ABS:
            return _take_magnitude(parts[0])
        if kind == z3.Z3_OP_FPA_SQRT and parts[0].high >= 0:
            low = max(parts[0].low, 0.0)
            ends = [round_float(math.sqrt(each), bits) if each < math.inf else each for each in (low, parts[0].high)]
            return FloatSpan(ends[0], ends[1], parts[0].has_nan or parts[0].low < 0)
        if kind == z3.Z3_OP_FPA_ROUND_TO_INTEGRAL and parts[0].low <= parts[0].high:
            low, high = parts[0].low, parts[0].high
            return FloatSpan(
                float(math.floor(low)) if math.isfinite(low) else low,
                float(math.ceil(high)) if math.isfinite(high) else high, parts[0].has_nan,
            )  # fmt: skip
        if kind in _CORNERS and len(parts) == 2:
            is_square = kind == z3.Z3_OP_FPA_MUL and term.arg(1).eq(term.arg(2))
            return _combine_floats(kind, parts[0], parts[1], bits, is_square)
        return _ANY_FLOAT

    def _derive_choice(self, term: Any, known: Mapping[int, FloatSpan], depth: int) -> FloatSpan:
        """Of a choice: where its condition compares a term with a number (a clamp), each side knows the answer. known:
        spans of terms, by their numbers."""
        if term.decl().kind() != z3.Z3_OP_ITE or depth == 0:
            span = self.find_float_span(term) if depth < 4 else _ANY_FLOAT
            return _narrow_span(span, known[term.get_id()]) if term.get_id() in known else span
        sides = []
        for side, is_negated in ((term.arg(1), False), (term.arg(2), True)):
            condition, negated = term.arg(0), is_negated
            if condition.decl().kind() == z3.Z3_OP_NOT:
                condition, negated = condition.arg(0), not negated
            compared = _read_comparison(condition, negated)
            own = known
            if compared is not None:
                number = compared[0].get_id()
                own = {**known, number: _narrow_span(known.get(number, _ANY_FLOAT), compared[1])}
            sides.append(self._derive_choice(side, own, depth - 1))
        return _join_floats(sides)

    def _derive_conversion(self, term: Any, parts: list[FloatSpan], bits: int) -> FloatSpan:
        if parts:
            ends = (round_float(parts[0].low, bits), round_float(parts[0].high, bits))
            return FloatSpan(ends[0], ends[1], parts[0].has_nan)
        last = term.arg(term.num_args() - 1)
        if term.num_args() == 1:
            name = last.decl().name() if last.decl().kind() == z3.Z3_OP_UNINTERPRETED else ""
            return self._known.get(name, _ANY_FLOAT)
        if z3.is_bv(last):
            span = self.find_span(last)
            if term.decl().kind() == z3.Z3_OP_FPA_TO_FP_UNSIGNED:
                span = _make_unsigned(span, last.size())
            if abs(span.low) < 1 << 53 and abs(span.high) < 1 << 53:
                return FloatSpan(round_float(float(span.low), bits), round_float(float(span.high), bits), False)
        return _ANY_FLOAT

    def _convert_float(self, term: Any, everything: Span) -> Span:
        span = self.find_float_span(term.arg(1))
        if span.has_nan or not (math.isfinite(span.low) and math.isfinite(span.high)):
            return everything
        low, high = math.trunc(span.low) - 1, math.trunc(span.high) + 1
        return Span(low, high) if everything.low <= low and high <= everything.high else everything

    def find_span(self, term: Any) -> Span:
        """Bounds of a bit vector."""
        known = self._spans.get(term.get_id())
        if known is not None:
            return known[1]
        pending = [term]
        while pending:
            each = pending[-1]
            missing = [
                child
                for child in (() if each.decl().kind() in _FROM_FLOAT else each.children())
                if z3.is_bv(child) and child.get_id() not in self._spans
            ]
            if missing and each.get_id() not in self._spans:
                pending.extend(missing)
                continue
            pending.pop()
            if each.get_id() not in self._spans:
                self._spans[each.get_id()] = (each, self._derive(each))
        return self._spans[term.get_id()][1]

    def _derive(self, term: Any) -> Span:
        bits = term.size()
        everything = Span(-(1 << (bits - 1)), (1 << (bits - 1)) - 1)
        if z3.is_bv_value(term):
            value = read_signed(term.as_long(), bits)
            return Span(value, value)
        kind = term.decl().kind()
        if kind in _FROM_FLOAT:
            return self._convert_float(term, everything)
        spans = [self._spans[child.get_id()][1] for child in term.children() if z3.is_bv(child)]
        found: Span | None = None
        if kind == z3.Z3_OP_UNINTERPRETED:
            known = self._inputs.get(term.decl().name())
            if known is not None and known.kind is InputKind.SIZE:
                found = Span(0, known.most)
        elif kind == z3.Z3_OP_ITE:
            found = Span(min(spans[0].low, spans[1].low), max(spans[0].high, spans[1].high))
        elif kind == z3.Z3_OP_BADD:
            found = Span(sum(each.low for each in spans), sum(each.high for each in spans))
        elif kind == z3.Z3_OP_BSUB and len(spans) == 2:
            found = Span(spans[0].low - spans[1].high, spans[0].high - spans[1].low)
        elif kind == z3.Z3_OP_BNEG:
            found = Span(-spans[0].high, -spans[0].low)
        elif kind == z3.Z3_OP_BMUL:
            found = spans[0]
            for each in spans[1:]:
                corners = [a * b for a in found for b in each]
                found = Span(min(corners), max(corners))
        elif kind == z3.Z3_OP_SIGN_EXT:
            found = spans[0]
        elif kind == z3.Z3_OP_ZERO_EXT:
            found = _make_unsigned(spans[0], term.arg(0).size())
        elif kind == z3.Z3_OP_CONCAT:
            first = term.arg(0)
            if z3.is_bv_value(first) and first.as_long() == 0:
                if len(spans) == 2:
                    found = _make_unsigned(spans[1], term.arg(1).size())
                else:
                    found = Span(0, (1 << (bits - first.size())) - 1)
        elif kind == z3.Z3_OP_EXTRACT:
            first, last = term.params()
            if spans[0].low >= 0 and spans[0].high < 1 << (first + 1):
                found = Span(spans[0].low >> last, spans[0].high >> last)
            elif last == 0 and everything.low <= spans[0].low and spans[0].high <= everything.high:
                found = spans[0]
        elif kind == z3.Z3_OP_BAND:
            highs = [each.high for each in spans if each.low >= 0]
            if highs:
                found = Span(0, min(highs))
        elif kind in (z3.Z3_OP_BUREM, z3.Z3_OP_BUREM_I) and spans[1].low > 0:
            found = Span(0, spans[1].high - 1)
        elif kind in (z3.Z3_OP_BUDIV, z3.Z3_OP_BUDIV_I) and spans[0].low >= 0 and spans[1].low > 0:
            found = Span(spans[0].low // spans[1].high, spans[0].high // spans[1].low)
        elif kind == z3.Z3_OP_BLSHR and spans[0].low >= 0 and spans[1].low >= 0:
            found = Span(0, spans[0].high)
        if found is None or found.low < everything.low or found.high > everything.high:
            return everything
        return found


def _make_unsigned(span: Span, bits: int) -> Span:
    if span.low >= 0:
        return span
    if span.high < 0:
        return Span(span.low + (1 << bits), span.high + (1 << bits))
    return Span(0, (1 << bits) - 1)


def _compare(kind: int, left: Span, right: Span) -> bool | None:
    if kind in (z3.Z3_OP_SGEQ, z3.Z3_OP_SGT):
        left, right = right, left
        kind = z3.Z3_OP_SLEQ if kind == z3.Z3_OP_SGEQ else z3.Z3_OP_SLT
    if kind == z3.Z3_OP_SLEQ:
        return True if left.high <= right.low else False if left.low > right.high else None
    return True if left.high < right.low else False if left.low >= right.high else None


_FROM_FLOAT = frozenset((z3.Z3_OP_FPA_TO_SBV, z3.Z3_OP_FPA_TO_UBV))
_CORNERS = {
    z3.Z3_OP_FPA_ADD: lambda a, b: a + b,
    z3.Z3_OP_FPA_SUB: lambda a, b: a - b,
    z3.Z3_OP_FPA_MUL: lambda a, b: a * b,
    z3.Z3_OP_FPA_DIV: lambda a, b: a / b if b else math.nan,
}


def _join_floats(parts: list[FloatSpan]) -> FloatSpan:
    return FloatSpan(
        min(each.low for each in parts), max(each.high for each in parts), any(each.has_nan for each in parts)
    )


def _take_magnitude(span: FloatSpan) -> FloatSpan:
    if span.low >= 0 or span.low > span.high:
        return span
    low = 0.0 if span.high >= 0 else -span.high
    return FloatSpan(low, max(-span.low, span.high), span.has_nan)


def _combine_floats(kind: int, left: FloatSpan, right: FloatSpan, bits: int, is_square: bool) -> FloatSpan:
    """Of a sum, difference, product or quotient: its ends are among those of the ends."""
    if left.low > left.high or right.low > right.high:
        return _ONLY_NAN
    if kind == z3.Z3_OP_FPA_DIV and right.low <= 0 <= right.high:
        return _ANY_FLOAT
    if is_square:
        size = _take_magnitude(left)
        return FloatSpan(round_float(size.low * size.low, bits), round_float(size.high * size.high, bits), left.has_nan)
    corners = [_CORNERS[kind](a, b) for a in (left.low, left.high) for b in (right.low, right.high)]
    has_nan = left.has_nan or right.has_nan or any(math.isnan(each) for each in corners)
    if kind == z3.Z3_OP_FPA_MUL and not has_nan:
        # A zero between the ends of one and an infinity of the other.
        has_nan = any(
            one.low <= 0 <= one.high and (math.isinf(other.low) or math.isinf(other.high))
            for one, other in ((left, right), (right, left))
        )
    numbers = [round_float(each, bits) for each in corners if not math.isnan(each)]
    if not numbers:
        return _ONLY_NAN
    return FloatSpan(min(numbers), max(numbers), has_nan)


def _compare_floats(kind: int, left: FloatSpan, right: FloatSpan) -> bool | None:
    if left.low > left.high or right.low > right.high:
        return False
    if kind in (z3.Z3_OP_FPA_GT, z3.Z3_OP_FPA_GE):
        left, right = right, left
        kind = z3.Z3_OP_FPA_LT if kind == z3.Z3_OP_FPA_GT else z3.Z3_OP_FPA_LE
    may_fail = left.has_nan or right.has_nan
    if kind == z3.Z3_OP_FPA_LT:
        return False if left.low >= right.high else True if left.high < right.low and not may_fail else None
    if kind == z3.Z3_OP_FPA_LE:
        return False if left.low > right.high else True if left.high <= right.low and not may_fail else None
    return False if left.high < right.low or right.high < left.low else None


def narrow_floats(conditions: Iterable[Any]) -> dict[str | int, FloatSpan]:
    """Spans of terms that some of the conditions compare with numbers: inputs by their names, others by their numbers
    in z3."""
    spans: dict[str | int, FloatSpan] = {}
    pending = list(conditions)
    while pending:
        condition = pending.pop()
        kind = condition.decl().kind()
        if kind == z3.Z3_OP_AND:
            pending.extend(condition.children())
            continue
        is_negated = kind == z3.Z3_OP_NOT
        inner = condition.arg(0) if is_negated else condition
        compared = _read_comparison(inner, is_negated)
        if compared is not None:
            key = _read_input(compared[0]) or compared[0].get_id()
            spans[key] = _narrow_span(spans.get(key, _ANY_FLOAT), compared[1])
    return spans


def _narrow_span(first: FloatSpan, second: FloatSpan) -> FloatSpan:
    return FloatSpan(max(first.low, second.low), min(first.high, second.high), first.has_nan and second.has_nan)


def _read_comparison(condition: Any, is_negated: bool) -> tuple[Any, FloatSpan] | None:
    """What a comparison of a term with a number says of the term."""
    kind = condition.decl().kind()
    if kind not in _FLOAT_COMPARISONS:
        return None
    left, right = condition.arg(0), condition.arg(1)
    is_below = kind in (z3.Z3_OP_FPA_LT, z3.Z3_OP_FPA_LE)
    if z3.is_fp_value(left):
        left, right, is_below = right, left, not is_below
    if not z3.is_fp_value(right):
        return None
    value = read_float_value(right)
    if math.isnan(value):
        return None
    if kind == z3.Z3_OP_FPA_EQ:
        return None if is_negated else (left, FloatSpan(value, value, False))
    if is_below != is_negated:
        return left, FloatSpan(-math.inf, value, is_negated)
    return left, FloatSpan(value, math.inf, is_negated)


def _read_input(term: Any) -> str:
    """The input whose bits a float has; empty for another term."""
    if term.decl().kind() != z3.Z3_OP_FPA_TO_FP or term.num_args() != 1:
        return ""
    bits = term.arg(0)
    return bits.decl().name() if bits.decl().kind() == z3.Z3_OP_UNINTERPRETED else ""
