"""Symbolic values of Python: whole numbers without overflow, floats, truths, texts and lists of bounded size.

A value that is the same on every path is an ordinary object of Python; what is here stands for the others.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import z3

from ..ir.terms import unpack_float

FLOAT64 = z3.Float64()
FLOAT32 = z3.Float32()
NEAREST = z3.RNE()
_WIDEST = 256


class NotModelledError(Exception):
    """The executor cannot go on: what follows is unknown. Its text says why."""


class BoundReachedError(NotModelledError):
    """A bound on steps or time: nothing further is executed."""


@dataclass(frozen=True, slots=True)
class Whole:
    """An int. term: a signed bit vector that is wide enough; low and high: between which it is."""

    term: z3.BitVecRef
    low: int
    high: int


class RealSpan(NamedTuple):
    """Between which a float is; is_number: whether it is none of NaN."""

    low: float = -math.inf
    high: float = math.inf
    is_number: bool = False

    @property
    def is_finite(self) -> bool:
        """Whether it is a number that is not infinite."""
        return self.is_number and -math.inf < self.low and self.high < math.inf


ANY = RealSpan()


@dataclass(frozen=True, slots=True)
class Real:
    """A float. term of sort Float64; span: what is known without a solver; single: of sort Float32, where the float is
    one of these made wider, which compares faster."""

    term: z3.FPRef
    span: RealSpan = ANY
    single: z3.FPRef | None = None


@dataclass(frozen=True, slots=True)
class Truth:
    """A bool."""

    term: z3.BoolRef


@dataclass(frozen=True, slots=True)
class SymbolicText:
    """A str of ASCII. characters: bit vectors of 8 bits or numbers, as many as there may be at most; size: a Whole, or
    None where all of them are there."""

    characters: tuple[z3.BitVecRef | int, ...]
    size: Whole | None = None


@dataclass(slots=True)
class ListValue:
    """A list or tuple. elements: as many as there may be at most; size: None where all of them are there. Its content
    changes as a list's does."""

    elements: list[Any]
    size: Whole | None = None
    is_frozen: bool = False


@dataclass(slots=True)
class Opaque:
    """A value of which nothing is known but where it came from."""

    name: str


@dataclass(slots=True)
class ArrayValue(Opaque):
    """An array of numpy, or a dictionary, whose elements are not known. shape: None where it is not known either.
    changes: how often elements were set."""

    shape: tuple[int, ...] | None = None
    changes: int = 0


@dataclass(slots=True)
class Record:
    """A message. type: `package/Name`. fields: what is set; missing_reason: of a type whose definition is not known."""

    type: str
    fields: dict[str, Any] = field(default_factory=dict)
    is_known: bool = True


def count_bits(low: int, high: int) -> int:
    """Bits of the smallest usual signed number that holds what is between low and high. Raises NotModelledError."""
    needed = max(high.bit_length(), (-low - 1).bit_length() if low < 0 else 0) + 1
    for bits in (8, 16, 32, 64, 128, _WIDEST):
        if needed <= bits:
            return bits
    raise NotModelledError("an integer of more than 256 bits")


def make_whole(term: z3.BitVecRef, low: int, high: int) -> Whole | int:
    """A whole number of a term that is signed and holds low to high; an int where it is one number."""
    if low == high:
        return low
    value = z3.simplify(term)
    if z3.is_bv_value(value):
        return value.as_signed_long()
    bits = count_bits(low, high)
    if value.size() > bits:
        value = z3.simplify(z3.Extract(bits - 1, 0, value))
    return Whole(value, low, high)


def make_truth(term: z3.BoolRef) -> Truth | bool:
    """A truth of a term; a bool where it is always the same."""
    value = z3.simplify(term)
    if z3.is_true(value):
        return True
    return False if z3.is_false(value) else Truth(value)


def make_real(term: z3.FPRef, span: RealSpan = ANY) -> Real | float:
    """A float of a term; a float of Python where it is always the same."""
    value = z3.simplify(term)
    if isinstance(value, z3.FPNumRef):
        bits = z3.simplify(z3.fpToIEEEBV(value))
        if z3.is_bv_value(bits):
            return unpack_float(bits.as_long(), 64)
        if value.isNaN():
            return float("nan")
    return Real(value, span)


def extend(value: Any, bits: int) -> z3.BitVecRef:
    """The bits of a whole number, sign-extended to a width that holds it."""
    if isinstance(value, Whole):
        return z3.SignExt(bits - value.term.size(), value.term) if bits > value.term.size() else value.term
    return z3.BitVecVal(int(value), bits)


def get_range(value: Any) -> tuple[int, int]:
    """Between which a whole number is."""
    return (value.low, value.high) if isinstance(value, Whole) else (int(value), int(value))


def convert_to_real(value: Any) -> z3.FPRef:
    """The float of a number."""
    if isinstance(value, Real):
        return value.term
    if isinstance(value, Whole):
        return z3.fpSignedToFP(NEAREST, value.term, FLOAT64)
    if isinstance(value, Truth):
        return z3.If(value.term, z3.FPVal(1.0, FLOAT64), z3.FPVal(0.0, FLOAT64))
    return z3.FPVal(float(value), FLOAT64)


def convert_to_whole(value: Any) -> Any:
    """A truth as a number; others as they are."""
    if isinstance(value, Truth):
        return Whole(z3.If(value.term, z3.BitVecVal(1, 8), z3.BitVecVal(0, 8)), 0, 1)
    return int(value) if isinstance(value, bool) else value


def is_symbolic(value: Any) -> bool:
    """Whether a value, or a part of it, is not the same on every path."""
    if isinstance(value, ListValue):
        return value.size is not None or any(is_symbolic(one) for one in value.elements)
    return isinstance(value, (Whole, Real, Truth, SymbolicText, Opaque))


def is_number(value: Any) -> bool:
    """Whether a value is an int, float or bool, symbolic or not."""
    return isinstance(value, (int, float, Whole, Real, Truth))


def is_whole(value: Any) -> bool:
    """Whether a value is an int or bool, symbolic or not."""
    return isinstance(value, (int, Whole, Truth))


def get_span(value: Any) -> RealSpan:
    """Between which a number is, as a float."""
    if isinstance(value, Real):
        return value.span
    if isinstance(value, (Whole, Truth)):
        low, high = (value.low, value.high) if isinstance(value, Whole) else (0, 1)
        return RealSpan(math.nextafter(float(low), -math.inf), math.nextafter(float(high), math.inf), True)
    number = float(value)
    return RealSpan(is_number=False) if math.isnan(number) else RealSpan(number, number, True)
