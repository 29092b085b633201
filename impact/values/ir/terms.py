"""Values of the executor and arithmetic on them.

An integer is an `int` (not signed) or a z3 bit vector; an i1 is 0, 1 or a z3 truth value; a float is a `float` or a z3
floating-point term; then there are `Pointer`, `Code`, lists (aggregates) and `UNDEFINED`. What is concrete is
calculated here, the rest becomes a term.
"""

from __future__ import annotations

import ctypes
import math
import struct
from typing import Any

import z3

from .layout import FloatType

NEAREST = z3.RNE()
TOWARDS_ZERO = z3.RTZ()
SORTS = {32: z3.Float32(), 64: z3.Float64()}
_FLOAT_CONSTANTS: dict[tuple[int, int], z3.FPRef] = {}
ADDRESS_MASK = (1 << 64) - 1


def is_term(value: Any) -> bool:
    return isinstance(value, z3.ExprRef)


def reduce_term(term: Any) -> Any:
    """A term as simple as it gets: a number where it is one."""
    if not isinstance(term, z3.ExprRef):
        return int(term) if isinstance(term, bool) else term
    term = z3.simplify(term)
    if z3.is_bv_value(term):
        return term.as_long()  # pyright: ignore[reportAttributeAccessIssue]
    if z3.is_true(term):
        return 1
    if z3.is_false(term):
        return 0
    if z3.is_fp_value(term):
        return read_float_value(term)
    return term


def read_float_value(term: Any) -> float:
    """The number that a floating-point constant of z3 is."""
    if term.isNaN():
        return math.nan
    if term.isInf():
        return -math.inf if term.isNegative() else math.inf
    if term.isZero():
        return -0.0 if term.isNegative() else 0.0
    bits = z3.simplify(z3.fpToIEEEBV(term)).as_long()  # pyright: ignore[reportAttributeAccessIssue]
    return unpack_float(bits, term.sort().ebits() + term.sort().sbits())


def pack_float(value: float, bits: int) -> int:
    """IEEE bits of a float."""
    if bits == 64:
        return struct.unpack("<Q", struct.pack("<d", value))[0]
    return struct.unpack("<I", bytes(ctypes.c_float(value)))[0]


def unpack_float(value: int, bits: int) -> float:
    """The float of some IEEE bits."""
    if bits == 64:
        return struct.unpack("<d", struct.pack("<Q", value))[0]
    return struct.unpack("<f", struct.pack("<I", value))[0]


def round_float(value: float, bits: int) -> float:
    return value if bits == 64 else ctypes.c_float(value).value


def make_float(value: Any, bits: int) -> z3.FPRef:
    """A float as a term."""
    if isinstance(value, z3.ExprRef):
        return value  # pyright: ignore[reportReturnType]
    key = (pack_float(value, bits), bits)
    if key not in _FLOAT_CONSTANTS:
        if math.isnan(value):
            _FLOAT_CONSTANTS[key] = z3.fpNaN(SORTS[bits])
        else:
            _FLOAT_CONSTANTS[key] = z3.simplify(  # pyright: ignore[reportArgumentType]
                z3.fpBVToFP(z3.BitVecVal(key[0], bits), SORTS[bits])
            )
    return _FLOAT_CONSTANTS[key]


def make_float_bits(value: Any, bits: int) -> Any:
    """The IEEE bits of a float: a number or a bit vector."""
    if isinstance(value, z3.ExprRef):
        if value.decl().kind() == z3.Z3_OP_FPA_TO_FP and value.num_args() == 1:
            return value.arg(0)
        return z3.fpToIEEEBV(value)
    return pack_float(value, bits)


def read_float_bits(value: Any, bits: int) -> Any:
    """The float of IEEE bits that are a number or a bit vector."""
    if isinstance(value, int):
        return unpack_float(value, bits)
    if value.decl().kind() == z3.Z3_OP_FPA_TO_IEEE_BV:
        return value.arg(0)
    return z3.fpBVToFP(value, SORTS[bits])


def make_bits(value: Any, bits: int) -> z3.BitVecRef:
    """An integer as a bit vector."""
    if isinstance(value, int):
        return z3.BitVecVal(value, bits)
    if z3.is_bool(value):
        return z3.If(value, z3.BitVecVal(1, bits), z3.BitVecVal(0, bits))  # pyright: ignore[reportReturnType]
    return value


def make_truth(value: Any) -> z3.BoolRef:
    """An i1 as a truth value."""
    if isinstance(value, int):
        return z3.BoolVal(bool(value))
    if z3.is_bv(value):
        return value == 1
    return value


def negate_truth(value: Any) -> Any:
    if isinstance(value, int):
        return 1 - value
    return reduce_term(z3.Not(value))


def join_truths(*values: Any) -> Any:
    """Conjunction of truth values, some of them numbers."""
    terms = []
    for each in values:
        if isinstance(each, int):
            if not each:
                return 0
        else:
            terms.append(make_truth(each))
    return reduce_term(z3.And(*terms)) if terms else 1


def read_signed(value: int, bits: int) -> int:
    return value - (1 << bits) if value >> (bits - 1) else value


def add_offsets(left: Any, right: Any) -> Any:
    if isinstance(left, int) and isinstance(right, int):
        return (left + right) & ADDRESS_MASK
    if isinstance(right, int) and right == 0:
        return left
    return reduce_term(make_bits(left, 64) + make_bits(right, 64))


def scale_index(value: Any, bits: int, step: int) -> Any:
    """A signed index times the size of an element, as an offset."""
    if isinstance(value, int):
        return read_signed(value, bits) * step & ADDRESS_MASK
    value = make_bits(value, bits)
    wide = z3.SignExt(64 - bits, value) if bits < 64 else z3.Extract(63, 0, value) if bits > 64 else value
    return wide * step if step != 1 else wide  # pyright: ignore[reportOperatorIssue]


def _divide(left: int, right: int) -> int:
    return abs(left) // abs(right) * (1 if (left < 0) == (right < 0) else -1)


_CONCRETE = {
    "add": lambda a, b, w: a + b,
    "sub": lambda a, b, w: a - b,
    "mul": lambda a, b, w: a * b,
    "and": lambda a, b, w: a & b,
    "or": lambda a, b, w: a | b,
    "xor": lambda a, b, w: a ^ b,
    "shl": lambda a, b, w: a << b if b < w else 0,
    "lshr": lambda a, b, w: a >> b if b < w else 0,
    "ashr": lambda a, b, w: read_signed(a, w) >> min(b, w - 1),
    "udiv": lambda a, b, w: a // b,
    "urem": lambda a, b, w: a % b,
    "sdiv": lambda a, b, w: _divide(read_signed(a, w), read_signed(b, w)),
    "srem": lambda a, b, w: read_signed(a, w) - read_signed(b, w) * _divide(read_signed(a, w), read_signed(b, w)),
}
_SYMBOLIC = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "and": lambda a, b: a & b,
    "or": lambda a, b: a | b,
    "xor": lambda a, b: a ^ b,
    "shl": lambda a, b: a << b,
    "lshr": z3.LShR,
    "ashr": lambda a, b: a >> b,
    "udiv": z3.UDiv,
    "urem": z3.URem,
    "sdiv": lambda a, b: a / b,
    "srem": z3.SRem,
}
_TRUTHS = {"and": z3.And, "or": z3.Or, "xor": z3.Xor, "add": z3.Xor, "sub": z3.Xor, "mul": z3.And}


def compute_integer(operation: str, left: Any, right: Any, bits: int) -> Any:
    """An operation on two integers; a divisor is not zero."""
    if isinstance(left, int) and isinstance(right, int):
        return _CONCRETE[operation](left, right, bits) & ((1 << bits) - 1)
    if bits == 1 and operation in _TRUTHS:
        return reduce_term(_TRUTHS[operation](make_truth(left), make_truth(right)))
    return reduce_term(_SYMBOLIC[operation](make_bits(left, bits), make_bits(right, bits)))


def _divide_floats(left: float, right: float) -> float:
    if right:
        return left / right
    if not left or math.isnan(left):
        return math.nan
    return math.copysign(math.inf, left) * math.copysign(1.0, right)


def _multiply_floats(left: float, right: float) -> float:
    return left * right


_FLOAT_CONCRETE = {
    "fadd": lambda a, b: a + b,
    "fsub": lambda a, b: a - b,
    "fmul": _multiply_floats,
    "fdiv": _divide_floats,
    "frem": lambda a, b: math.nan if math.isnan(a + b) or math.isinf(a) or not b else math.fmod(a, b),
}
_FLOAT_SYMBOLIC = {"fadd": z3.fpAdd, "fsub": z3.fpSub, "fmul": z3.fpMul, "fdiv": z3.fpDiv}


def compute_float(operation: str, left: Any, right: Any, bits: int) -> Any:
    """An operation on two floats; `frem` only on numbers."""
    if isinstance(left, float) and isinstance(right, float):
        return round_float(_FLOAT_CONCRETE[operation](left, right), bits)
    return reduce_term(_FLOAT_SYMBOLIC[operation](NEAREST, make_float(left, bits), make_float(right, bits)))


_COMPARED = {
    "eq": lambda a, b, w: a == b,
    "ne": lambda a, b, w: a != b,
    "ult": lambda a, b, w: a < b,
    "ule": lambda a, b, w: a <= b,
    "ugt": lambda a, b, w: a > b,
    "uge": lambda a, b, w: a >= b,
    "slt": lambda a, b, w: read_signed(a, w) < read_signed(b, w),
    "sle": lambda a, b, w: read_signed(a, w) <= read_signed(b, w),
    "sgt": lambda a, b, w: read_signed(a, w) > read_signed(b, w),
    "sge": lambda a, b, w: read_signed(a, w) >= read_signed(b, w),
}
_COMPARED_TERMS = {
    "eq": lambda a, b: a == b,
    "ne": lambda a, b: a != b,
    "ult": z3.ULT,
    "ule": z3.ULE,
    "ugt": z3.UGT,
    "uge": z3.UGE,
    "slt": lambda a, b: a < b,
    "sle": lambda a, b: a <= b,
    "sgt": lambda a, b: a > b,
    "sge": lambda a, b: a >= b,
}


def compare_integers(predicate: str, left: Any, right: Any, bits: int) -> Any:
    if isinstance(left, int) and isinstance(right, int):
        return int(_COMPARED[predicate](left, right, bits))
    if bits == 1 and predicate in ("eq", "ne"):
        left, right = make_truth(left), make_truth(right)
        return reduce_term(left == right if predicate == "eq" else left != right)
    return reduce_term(_COMPARED_TERMS[predicate](make_bits(left, bits), make_bits(right, bits)))


_FLOAT_COMPARED = {
    "eq": lambda a, b: a == b,
    "ne": lambda a, b: a != b,
    "lt": lambda a, b: a < b,
    "le": lambda a, b: a <= b,
    "gt": lambda a, b: a > b,
    "ge": lambda a, b: a >= b,
}
_FLOAT_COMPARED_TERMS = {
    "eq": z3.fpEQ,
    "ne": lambda a, b: z3.Not(z3.fpEQ(a, b)),
    "lt": z3.fpLT,
    "le": z3.fpLEQ,
    "gt": z3.fpGT,
    "ge": z3.fpGEQ,
}


def compare_floats(predicate: str, left: Any, right: Any, bits: int) -> Any:
    if predicate in ("true", "false"):
        return int(predicate == "true")
    if isinstance(left, float) and isinstance(right, float):
        if math.isnan(left) or math.isnan(right):
            return int(predicate[0] == "u")
        return (
            1 if predicate == "ord" else 0 if predicate == "uno" else int(_FLOAT_COMPARED[predicate[1:]](left, right))
        )
    unordered = [
        z3.fpIsNaN(each) if is_term(each) else z3.BoolVal(math.isnan(each)) for each in (left, right)
    ]  # fmt: skip
    if predicate in ("uno", "ord"):
        either = z3.Or(*unordered)
        return reduce_term(either if predicate == "uno" else z3.Not(either))
    compared = _FLOAT_COMPARED_TERMS[predicate[1:]](make_float(left, bits), make_float(right, bits))
    if predicate[0] == "u":
        return reduce_term(z3.Or(*unordered, compared))
    # Of the ordered ones, only `one` says nothing of NaN by itself.
    return reduce_term(z3.And(z3.Not(z3.Or(*unordered)), compared) if predicate == "one" else compared)


def choose_term(condition: Any, first: Any, second: Any, bits: int, is_float: bool) -> Any:
    """first where condition holds, else second; numbers or terms."""
    if isinstance(condition, int):
        return first if condition else second
    return reduce_term(join_terms(condition, first, second, bits, is_float))


def join_terms(condition: z3.BoolRef, first: Any, second: Any, bits: int, is_float: bool) -> Any:
    """The same, as it is written."""
    if is_float:
        first, second = make_float(first, bits), make_float(second, bits)
    elif bits == 1:
        first, second = make_truth(first), make_truth(second)
    else:
        first, second = make_bits(first, bits), make_bits(second, bits)
    return z3.If(condition, first, second)


def convert_float_to_integer(value: Any, bits: int, float_bits: int, is_signed: bool) -> Any:
    """Rounded towards zero; where no such integer exists, anything."""
    if isinstance(value, float):
        return int(value) & ((1 << bits) - 1) if math.isfinite(value) else 0
    convert = z3.fpToSBV if is_signed else z3.fpToUBV
    return reduce_term(convert(TOWARDS_ZERO, make_float(value, float_bits), z3.BitVecSort(bits)))


def convert_integer_to_float(value: Any, bits: int, target: FloatType, is_signed: bool) -> Any:
    if isinstance(value, int):
        number = read_signed(value, bits) if is_signed else value
        if target.bits == 64:
            return float(number)
        return reduce_term(z3.fpRealToFP(NEAREST, z3.RealVal(number), SORTS[32]))
    convert = z3.fpSignedToFP if is_signed else z3.fpUnsignedToFP
    return reduce_term(convert(NEAREST, make_bits(value, bits), SORTS[target.bits]))


def convert_float(value: Any, source: FloatType, target: FloatType) -> Any:
    if isinstance(value, float):
        return round_float(value, target.bits)
    return reduce_term(z3.fpFPToFP(NEAREST, make_float(value, source.bits), SORTS[target.bits]))


def count_trailing_zeros(term: Any) -> int:
    """How many of the lowest bits of an integer are certainly zero (at most 64)."""
    if isinstance(term, int):
        return 64 if term == 0 else (term & -term).bit_length() - 1
    return _count_zeros(term, {}) if z3.is_bv(term) else 0


def _count_zeros(term: Any, known: dict[int, int]) -> int:
    """The same of a term; known: of its parts, of which many are in it more than once."""
    # A chain of choices, as a table is read, may be longer than functions may call themselves.
    chain: list[tuple[int, int]] = []
    while (number := term.get_id()) not in known and term.decl().kind() == z3.Z3_OP_ITE:
        chain.append((number, _count_zeros(term.arg(1), known)))
        term = term.arg(2)
    if number not in known:
        known[number] = _count_parts(term, known)
    count = known[number]
    for number, first in reversed(chain):
        count = known[number] = min(count, first)
    return count


def _count_parts(term: Any, known: dict[int, int]) -> int:
    if z3.is_bv_value(term):
        return count_trailing_zeros(term.as_long())
    kind = term.decl().kind()
    parts = [term.arg(index) for index in range(term.num_args())]
    if kind == z3.Z3_OP_BMUL:
        return min(64, sum(_count_zeros(each, known) for each in parts))
    if kind in (z3.Z3_OP_BADD, z3.Z3_OP_BSUB, z3.Z3_OP_BOR, z3.Z3_OP_BXOR, z3.Z3_OP_BNEG):
        return min(_count_zeros(each, known) for each in parts)
    if kind == z3.Z3_OP_CONCAT:
        count = 0
        for each in reversed(parts):
            zeros = _count_zeros(each, known)
            count += min(zeros, each.size())
            if zeros < each.size():
                break
        return min(64, count)
    if kind in (z3.Z3_OP_ZERO_EXT, z3.Z3_OP_SIGN_EXT):
        zeros = _count_zeros(parts[0], known)
        return 64 if zeros >= parts[0].size() else zeros
    if kind == z3.Z3_OP_BSHL and z3.is_bv_value(parts[1]):
        return min(64, _count_zeros(parts[0], known) + parts[1].as_long())
    if kind == z3.Z3_OP_EXTRACT and term.params()[1] == 0:
        return min(64, _count_zeros(parts[0], known))
    return 0
