"""Python's operators on symbolic numbers. Texts and containers are in texts.py and machine.py."""

from __future__ import annotations

import ast
import math
import operator
import struct
from collections.abc import Callable
from typing import Any, Protocol

import z3

from .terms import (
    ANY,
    FLOAT32,
    FLOAT64,
    NEAREST,
    NotModelledError,
    Real,
    RealSpan,
    Truth,
    Whole,
    convert_to_real,
    convert_to_whole,
    count_bits,
    extend,
    get_range,
    get_span,
    is_whole,
    make_real,
    make_truth,
    make_whole,
)  # fmt: skip

CONCRETE: dict[type[ast.AST], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv, ast.Mod: operator.mod, ast.Pow: operator.pow, ast.BitAnd: operator.and_,
    ast.BitOr: operator.or_, ast.BitXor: operator.xor, ast.LShift: operator.lshift, ast.RShift: operator.rshift,
    ast.Eq: operator.eq, ast.NotEq: operator.ne, ast.Lt: operator.lt, ast.LtE: operator.le, ast.Gt: operator.gt,
    ast.GtE: operator.ge,
}  # fmt: skip
"""Operators as functions, for values that are not symbolic."""

_LARGEST_FLOAT_AS_INTEGER = 2.0**62


class Decides(Protocol):
    """What operators ask of a run."""

    def decide(self, condition: Truth | bool) -> bool:
        """Whether a condition holds on this path; both ways are followed where both can be."""
        ...

    def throw(self, name: str, detail: str = "") -> Exception:
        """The exception of Python of a name, to be raised."""
        ...


def calculate(run: Decides, kind: type[ast.operator], left: Any, right: Any) -> Any:
    """A binary operator on numbers, at least one of them symbolic. Raises NotModelledError."""
    left, right = convert_to_whole(left), convert_to_whole(right)
    if is_whole(left) and is_whole(right) and kind is not ast.Div:
        return _calculate_whole(run, kind, left, right)
    if kind in (ast.Div, ast.FloorDiv, ast.Mod) and run.decide(compare(ast.Eq, right, 0)):
        raise run.throw("ZeroDivisionError")
    a, b = convert_to_real(left), convert_to_real(right)
    span = _combine(kind, left, right)
    if kind is ast.Add:
        return make_real(z3.fpAdd(NEAREST, a, b), span)
    if kind is ast.Sub:
        return make_real(z3.fpSub(NEAREST, a, b), span)
    if kind is ast.Mult:
        return make_real(z3.fpMul(NEAREST, a, b), span)
    if kind is ast.Div:
        return make_real(z3.fpDiv(NEAREST, a, b), span)
    if kind is ast.Pow and right == 2:
        return make_real(z3.fpMul(NEAREST, a, a), _combine(ast.Mult, left, left))
    if kind is ast.FloorDiv:
        return make_real(z3.fpRoundToIntegral(z3.RTN(), z3.fpDiv(NEAREST, a, b)))
    raise NotModelledError(f"operator {kind.__name__} of floats")


def _combine(kind: type[ast.operator], left: Any, right: Any) -> RealSpan:
    """Between which a result is, by the ends of both sides, which Python rounds as the operator does. A divisor that is
    an integer was asked whether it is 0 before."""
    one, other = get_span(left), get_span(right)
    if not (one.is_finite and other.is_finite) or kind not in (ast.Add, ast.Sub, ast.Mult, ast.Div):
        return ANY
    if kind is ast.Div:
        if isinstance(right, (Whole, int)):
            most = max(abs(one.low), abs(one.high))
            return RealSpan(-most, most, True)
        if other.low <= 0.0 <= other.high:
            return ANY
    operation = CONCRETE[kind]
    pairs = ((one.low, other.low), (one.low, other.high), (one.high, other.low), (one.high, other.high))
    ends = [operation(x, y) for x, y in pairs]
    return RealSpan(min(ends), max(ends), all(map(math.isfinite, ends))) if not any(map(math.isnan, ends)) else ANY


def _calculate_whole(run: Decides, kind: type[ast.operator], left: Whole | int, right: Whole | int) -> Any:
    (a, b), (c, d) = get_range(left), get_range(right)
    if kind in (ast.Add, ast.Sub, ast.Mult):
        if kind is ast.Add:
            low, high = a + c, b + d
        elif kind is ast.Sub:
            low, high = a - d, b - c
        else:
            ends = (a * c, a * d, b * c, b * d)
            low, high = min(ends), max(ends)
        bits = count_bits(min(low, a, c), max(high, b, d))
        x, y = extend(left, bits), extend(right, bits)
        return make_whole(x + y if kind is ast.Add else x - y if kind is ast.Sub else x * y, low, high)
    if kind in (ast.FloorDiv, ast.Mod):
        if run.decide(compare(ast.Eq, right, 0)):
            raise run.throw("ZeroDivisionError")
        bits = count_bits(min(a, c) - 1, max(b, d) + 1)
        x, y = extend(left, bits), extend(right, bits)
        rest = z3.SRem(x, y)
        crosses = z3.And(rest != 0, (rest < 0) != (y < 0))
        if kind is ast.FloorDiv:
            most = max(abs(a), abs(b)) + 1
            return make_whole(z3.If(crosses, x / y - 1, x / y), -most, most)
        most = max(abs(c), abs(d))
        return make_whole(z3.If(crosses, rest + y, rest), min(0, -most if c < 0 else 0), most if d > 0 else 0)
    if kind in (ast.BitAnd, ast.BitOr, ast.BitXor):
        bits = count_bits(min(a, c), max(b, d))
        x, y = extend(left, bits), extend(right, bits)
        term = x & y if kind is ast.BitAnd else x | y if kind is ast.BitOr else x ^ y
        if a >= 0 and c >= 0:
            most = (1 << max(b.bit_length(), d.bit_length())) - 1
            return make_whole(term, 0, min(b, d) if kind is ast.BitAnd else most)
        if kind is ast.BitAnd and (a >= 0 or c >= 0):
            return make_whole(term, 0, b if a >= 0 else d)
        return make_whole(term, -(1 << (bits - 1)), (1 << (bits - 1)) - 1)
    if kind in (ast.LShift, ast.RShift) and isinstance(right, int) and 0 <= right <= 64:
        if kind is ast.LShift:
            return _calculate_whole(run, ast.Mult, left, 1 << right)
        return make_whole(extend(left, count_bits(a, b)) >> right, a >> right, b >> right)
    if kind is ast.Pow and isinstance(right, int) and 0 <= right <= 4:
        result: Any = 1
        for _ in range(right):
            result = _calculate_whole(run, ast.Mult, result, left)
        return result
    raise NotModelledError(f"operator {kind.__name__} of integers")


def compare(kind: type[ast.cmpop], one: Any, other: Any) -> Truth | bool:
    """A comparison of numbers."""
    left: Any = convert_to_whole(one)
    right: Any = convert_to_whole(other)
    if not isinstance(left, (Whole, Real)) and not isinstance(right, (Whole, Real)):
        return bool(CONCRETE[kind](left, right))
    if is_whole(left) and is_whole(right):
        (a, b), (c, d) = get_range(left), get_range(right)
        sure = _compare_ranges(kind, a, b, c, d)
        if sure is not None:
            return sure
        bits = count_bits(min(a, c), max(b, d))
        x, y = extend(left, bits), extend(right, bits)
        terms = {ast.Eq: x == y, ast.NotEq: x != y, ast.Lt: x < y, ast.LtE: x <= y, ast.Gt: x > y, ast.GtE: x >= y}
        return make_truth(terms[kind])
    sure = _compare_spans(kind, get_span(left), get_span(right))
    if sure is not None:
        return sure
    easy = _compare_single(kind, left, right)
    if easy is not None:
        return easy
    # A float beside an integer: as numbers; exact for what a float holds.
    x, y = narrow(left, right) or (convert_to_real(left), convert_to_real(right))
    if kind is ast.NotEq:
        return make_truth(z3.Not(z3.fpEQ(x, y)))
    terms = {ast.Eq: z3.fpEQ, ast.Lt: z3.fpLT, ast.LtE: z3.fpLEQ, ast.Gt: z3.fpGT, ast.GtE: z3.fpGEQ}
    return make_truth(terms[kind](x, y))


_MIRRORED: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Lt: ast.Gt, ast.LtE: ast.GtE, ast.Gt: ast.Lt, ast.GtE: ast.LtE, ast.Eq: ast.Eq, ast.NotEq: ast.NotEq,
}  # fmt: skip


def _compare_single(kind: type[ast.cmpop], left: Any, right: Any) -> Truth | bool | None:
    """A comparison of a float of 32 bits with a number that none of these is: with its neighbour among them instead."""
    if not isinstance(left, Real):
        left, right, kind = right, left, _MIRRORED[kind]
    if not isinstance(left, Real) or left.single is None or not isinstance(right, (int, float)):
        return None
    number = float(right)
    if _is_single(number) or not abs(number) < 1e38:
        return None
    if kind in (ast.Eq, ast.NotEq):
        return kind is ast.NotEq
    near = struct.unpack("<f", struct.pack("<f", number))[0]
    below = near if near < number else _step_down(near)
    # Nothing of 32 bits lies between: x < number is x <= below.
    bound = z3.FPVal(below, FLOAT32)
    return make_truth(z3.fpLEQ(left.single, bound) if kind in (ast.Lt, ast.LtE) else z3.fpGT(left.single, bound))


def _step_down(number: float) -> float:
    """The next float of 32 bits below one."""
    bits = struct.unpack("<i", struct.pack("<f", number))[0]
    if number == 0.0:
        return -(2.0**-149)
    return struct.unpack("<f", struct.pack("<i", bits - 1 if number > 0 else bits + 1))[0]


def narrow(left: Any, right: Any) -> tuple[z3.FPRef, z3.FPRef] | None:
    """Both sides as floats of 32 bits, where both are some: comparing these is easier for a solver."""
    found: list[z3.FPRef] = []
    for one in (left, right):
        if isinstance(one, Real):
            if one.single is None:
                return None
            found.append(one.single)
        elif isinstance(one, (int, float)) and _is_single(float(one)):
            found.append(z3.FPVal(float(one), FLOAT32))
        else:
            return None
    return found[0], found[1]


def _is_single(number: float) -> bool:
    try:
        return struct.unpack("<f", struct.pack("<f", number))[0] == number
    except OverflowError:
        return False


def _compare_spans(kind: type[ast.cmpop], one: RealSpan, other: RealSpan) -> bool | None:
    """What a comparison of floats gives for sure, by what is known of both."""
    apart = one.high < other.low or other.high < one.low
    if kind in (ast.Eq, ast.NotEq):
        return kind is ast.NotEq if apart else None
    if kind in (ast.Gt, ast.GtE):
        one, other = other, one
        kind = ast.Lt if kind is ast.Gt else ast.LtE
    if one.low > other.high or (kind is ast.Lt and one.low >= other.high):
        return False
    if one.is_number and other.is_number and (one.high < other.low or (kind is ast.LtE and one.high <= other.low)):
        return True
    return None


def _compare_ranges(kind: type[ast.cmpop], a: int, b: int, c: int, d: int) -> bool | None:
    """What a comparison of numbers between a and b with some between c and d gives for sure."""
    if kind in (ast.Eq, ast.NotEq):
        return kind is ast.NotEq if b < c or d < a else None
    if kind in (ast.Gt, ast.GtE):
        a, b, c, d = c, d, a, b
        kind = ast.Lt if kind is ast.Gt else ast.LtE
    if b < c or (kind is ast.LtE and b <= c):
        return True
    return False if a > d or (kind is ast.Lt and a >= d) else None


def negate(value: Any) -> Any:
    """`-value` of a symbolic number."""
    value = convert_to_whole(value)
    if isinstance(value, Real):
        span = value.span
        return make_real(z3.fpNeg(value.term), RealSpan(-span.high, -span.low, span.is_number))
    low, high = get_range(value)
    return make_whole(
        -extend(value, count_bits(-high, -low) if low > -high else count_bits(low - 1, -low)), -high, -low
    )


def find_magnitude(value: Any) -> Any:
    """`abs(value)` of a symbolic number."""
    value = convert_to_whole(value)
    if isinstance(value, Real):
        span = value.span
        most = max(abs(span.low), abs(span.high))
        return make_real(z3.fpAbs(value.term), RealSpan(0.0, most, span.is_number))
    low, high = get_range(value)
    most = max(abs(low), abs(high))
    term = extend(value, count_bits(-most, most))
    return make_whole(z3.If(term < 0, -term, term), 0, most)


def convert_to_integer(run: Decides, value: Real, rounding: Any = None) -> Any:
    """`int(value)` of a float; rounding: another of z3's for floor, ceil and round. NaN and infinity raise what Python
    raises."""
    span = value.span
    if not span.is_number and run.decide(make_truth(z3.fpIsNaN(value.term))):
        raise run.throw("ValueError", "cannot convert float NaN to integer")
    if not span.is_finite and run.decide(make_truth(z3.fpIsInf(value.term))):
        raise run.throw("OverflowError", "cannot convert float infinity to integer")
    if span.is_finite and max(abs(span.low), abs(span.high)) < 2.0**62:
        low, high = math.floor(span.low) - 1, math.ceil(span.high) + 1
        bits = count_bits(low, high)
        return make_whole(z3.fpToSBV(rounding or z3.RTZ(), value.term, z3.BitVecSort(bits)), low, high)
    small = z3.fpLT(z3.fpAbs(value.term), z3.FPVal(_LARGEST_FLOAT_AS_INTEGER, FLOAT64))
    if not run.decide(make_truth(small)):
        raise NotModelledError("a float above 2^62 made an integer")
    term = z3.fpToSBV(rounding if rounding is not None else z3.RTZ(), value.term, z3.BitVecSort(64))
    most = 2**62
    return make_whole(term, -most, most)


def is_zero(value: Any) -> Truth | bool:
    """Whether a number is 0: what makes it false."""
    return compare(ast.Eq, value, 0)
