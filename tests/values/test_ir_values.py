"""Arithmetic, memory and bounds of the executor against independent models of them."""

import math
import struct

import pytest
import z3
from hypothesis import given, settings
from hypothesis import strategies as st
from rosimpact.impact.values.ir import terms
from rosimpact.impact.values.ir.layout import get_integer_type
from rosimpact.impact.values.ir.memory import AddressMap, MemoryObject, interpret_raw, read_raw
from rosimpact.impact.values.ir.ranges import FloatSpan, Ranges, narrow_floats
from rosimpact.impact.values.ir.solving import Solving
from rosimpact.impact.values.outcomes import InputKind

BYTES = st.integers(0, 255)
WORDS = st.integers(0, 2**32 - 1) | st.sampled_from([0, 1, 2**31 - 1, 2**31, 2**32 - 1])
INTEGER_OPERATIONS = ("add", "sub", "mul", "and", "or", "xor", "shl", "lshr", "ashr", "udiv", "urem", "sdiv", "srem")


@pytest.mark.parametrize("operation", INTEGER_OPERATIONS)
@given(left=WORDS, right=WORDS)
@settings(max_examples=40, deadline=None)
def test_numbers_are_calculated_as_z3_does(operation, left, right):
    if operation in ("udiv", "urem", "sdiv", "srem") and right == 0:
        right = 1
    if operation in ("shl", "lshr", "ashr"):
        right %= 32
    symbol = z3.BitVec("left", 32)
    term = terms.compute_integer(operation, symbol, right, 32)
    expected = term if isinstance(term, int) else z3.simplify(z3.substitute(term, (symbol, z3.BitVecVal(left, 32))))
    expected = expected if isinstance(expected, int) else expected.as_long()
    assert terms.compute_integer(operation, left, right, 32) == expected


@pytest.mark.parametrize("predicate", ["eq", "ne", "ult", "ule", "ugt", "uge", "slt", "sle", "sgt", "sge"])
@given(left=WORDS, right=WORDS)
@settings(max_examples=25, deadline=None)
def test_numbers_are_compared_as_z3_does(predicate, left, right):
    symbol = z3.BitVec("left", 32)
    term = terms.compare_integers(predicate, symbol, right, 32)
    if not isinstance(term, int):
        term = int(z3.is_true(z3.simplify(z3.substitute(term, (symbol, z3.BitVecVal(left, 32))))))
    assert terms.compare_integers(predicate, left, right, 32) == term


@pytest.mark.parametrize(
    "predicate", ["oeq", "one", "olt", "ole", "ogt", "oge", "ord", "ueq", "une", "ult", "ugt", "uno"]
)
@given(left=st.floats(), right=st.floats() | st.just(math.nan))
@settings(max_examples=25, deadline=None)
def test_floats_are_compared_as_z3_does(predicate, left, right):
    symbol = z3.FP("left", z3.Float64())
    term = terms.compare_floats(predicate, symbol, right, 64)
    if not isinstance(term, int):
        term = int(z3.is_true(z3.simplify(z3.substitute(term, (symbol, terms.make_float(left, 64))))))
    assert terms.compare_floats(predicate, left, right, 64) == term


@given(st.floats(width=32) | st.floats())
@settings(deadline=None)
def test_a_float_survives_its_bits(value):
    for bits in (32, 64):
        rounded = terms.round_float(value, bits)
        again = terms.unpack_float(terms.pack_float(rounded, bits), bits)
        assert again == rounded or (math.isnan(again) and math.isnan(rounded))


@given(
    st.lists(st.tuples(st.sampled_from([1, 2, 4, 8]), st.integers(0, 24), st.integers(0, 2**64 - 1)), max_size=12),
    st.sampled_from([1, 2, 4, 8]),
    st.integers(0, 24),
)
@settings(max_examples=200, deadline=None)
def test_memory_gives_back_the_bytes_that_were_written_last(writes, size, offset):
    memory = MemoryObject(32, "heap", "", None, is_zeroed=True)
    model = bytearray(32)
    for width, place, value in writes:
        value &= (1 << 8 * width) - 1
        memory.write(place, width, value)
        model[place : place + width] = value.to_bytes(width, "little")
    found = read_raw(memory, offset, size, AddressMap(), lambda bits: pytest.fail("all bytes are known"))
    type_ = get_integer_type(8 * size)
    assert interpret_raw(found, type_, AddressMap()) == int.from_bytes(model[offset : offset + size], "little")
    covered = [(start, width) for start, width, _ in memory.list_cells(offset, size)]
    assert all(offset <= start and start + width <= offset + size for start, width in covered)


def test_a_float_and_a_pair_of_integers_share_memory():
    memory = MemoryObject(8, "stack", "", None)
    memory.write(0, 8, 1.5)
    low, high = struct.unpack("<II", struct.pack("<d", 1.5))
    values = [read_raw(memory, place, 4, AddressMap(), lambda bits: None) for place in (0, 4)]
    assert values == [low, high]


def make_float_input(solving: Solving, name: str) -> z3.FPRef:
    return terms.read_float_bits(solving.make_input(name, InputKind.FLOAT64, 64, True).term, 64)


FLOATS = st.floats(-1e6, 1e6) | st.sampled_from([0.0, -0.0, math.inf, -math.inf, math.nan, 1e308])


@given(FLOATS, FLOATS, st.lists(st.sampled_from(["fadd", "fsub", "fmul", "fdiv", "square", "abs"]), max_size=4))
@settings(max_examples=150, deadline=None)
def test_a_calculated_float_lies_within_its_bounds(first, second, operations):
    solving = Solving(0.0)
    x, y = make_float_input(solving, "x"), make_float_input(solving, "y")
    term, value = x, first
    for operation in operations:
        if operation == "square":
            term, value = terms.compute_float("fmul", term, term, 64), terms.compute_float("fmul", value, value, 64)
        elif operation == "abs":
            term, value = terms.reduce_term(z3.fpAbs(term)), abs(value)
        else:
            term, value = (
                terms.compute_float(operation, term, y, 64), terms.compute_float(operation, value, second, 64)
            )  # fmt: skip
    known = {
        name: FloatSpan(math.inf, -math.inf, True) if math.isnan(each) else FloatSpan(each, each, False)
        for name, each in (("x", first), ("y", second))
    }
    span = Ranges(solving.inputs, known).find_float_span(term)
    assert span.has_nan if math.isnan(value) else span.low <= value <= span.high


@pytest.mark.parametrize(
    "convert, low, high", [(z3.fpToFPUnsigned, 0.0, 255.0), (z3.fpSignedToFP, -128.0, 127.0)]
)
def test_an_integer_that_becomes_a_float_keeps_its_bounds(convert, low, high):
    byte = Solving(0.0).make_input("byte", InputKind.INTEGER, 8).term
    assert Ranges({}).find_float_span(convert(z3.RNE(), byte, z3.Float64())) == FloatSpan(low, high, False)


@given(
    BYTES, st.lists(st.tuples(st.sampled_from(["add", "mul", "urem", "and", "sub"]), st.integers(1, 40)), max_size=5)
)
@settings(max_examples=150, deadline=None)
def test_a_calculated_integer_lies_within_its_bounds(byte, operations):
    solving = Solving(0.0)
    symbol = solving.make_input("byte", InputKind.INTEGER, 8).term
    term, value = z3.ZeroExt(24, symbol), byte
    for operation, constant in operations:
        term = terms.compute_integer(operation, term, constant, 32)
        value = terms.compute_integer(operation, value, constant, 32)
    if isinstance(term, int):
        assert term == value
        return
    span = Ranges(solving.inputs).find_span(term)
    assert span.low <= terms.read_signed(value, 32) <= span.high


def test_conditions_narrow_a_float():
    solving = Solving(0.0)
    x = make_float_input(solving, "x")
    conditions = [terms.compare_floats("ogt", x, 1.0, 64), z3.Not(terms.compare_floats("ogt", x, 3.0, 64))]
    assert narrow_floats(conditions) == {"x": FloatSpan(1.0, 3.0, False)}
    square = terms.compute_float("fmul", x, x, 64)
    impossible = terms.compare_floats("ogt", square, 9.5, 64)
    assert Ranges(solving.inputs, narrow_floats(conditions)).is_impossible(impossible)
    assert not Ranges(solving.inputs).is_impossible(impossible)


def test_trailing_zeros_of_scaled_indices():
    symbol = z3.BitVec("index", 64)
    assert terms.count_trailing_zeros(symbol * 8) == 3
    assert terms.count_trailing_zeros(symbol * 24 + 16) == 3
    assert terms.count_trailing_zeros(symbol * 8 + 4) == 2
    assert terms.count_trailing_zeros(z3.Concat(z3.BitVec("high", 60), z3.BitVecVal(0, 4))) == 4
    assert terms.count_trailing_zeros(symbol) == 0
