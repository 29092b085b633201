"""Bounds of integer terms without a solver: whether a condition cannot hold, where its two sides lie apart.

Bounds are those of signed numbers. They hold for all values of the variables, whatever the other conditions say; a
size is known not to exceed its bound.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import z3

from ..outcomes import InputKind, SymbolicInput
from .terms import read_signed


class Span(NamedTuple):
    """Least and greatest signed value."""

    low: int
    high: int


_COMPARISONS = frozenset((z3.Z3_OP_SLEQ, z3.Z3_OP_SGEQ, z3.Z3_OP_SLT, z3.Z3_OP_SGT))
_UNSIGNED = {
    z3.Z3_OP_ULEQ: z3.Z3_OP_SLEQ, z3.Z3_OP_UGEQ: z3.Z3_OP_SGEQ, z3.Z3_OP_ULT: z3.Z3_OP_SLT, z3.Z3_OP_UGT: z3.Z3_OP_SGT,
}  # fmt: skip


class Ranges:
    """Spans of terms, each found once."""

    def __init__(self, inputs: Mapping[str, SymbolicInput]):
        self._inputs = inputs
        self._spans: dict[int, tuple[Any, Span]] = {}

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
        return None

    def find_span(self, term: Any) -> Span:
        """Bounds of a bit vector."""
        known = self._spans.get(term.get_id())
        if known is not None:
            return known[1]
        pending = [term]
        while pending:
            each = pending[-1]
            missing = [
                child for child in each.children() if z3.is_bv(child) and child.get_id() not in self._spans
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
        elif kind == z3.Z3_OP_EXTRACT and term.params()[1] == 0:
            if everything.low <= spans[0].low and spans[0].high <= everything.high:
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
