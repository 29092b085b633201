"""Models of <cstring>, <cctype>, numbers in texts, and output.

Texts are bytes of a bounded number, each a number or a term: lengths, comparisons and numbers are closed terms over
them, without a fork for each character.
"""

from __future__ import annotations

import ctypes
import math
import re
from typing import Any

import z3

from ..outcomes import CrashKind
from .access import read_bytes_from, read_text, require_access, store
from .executor import Call
from .harness_calls import add_log
from .layout import POINTER, get_integer_type
from .models import model, model_pattern
from .module import NULL, Pointer
from .terms import (
    add_offsets,
    choose_term,
    compare_integers,
    compute_integer,
    join_truths,
    make_bits,
    make_truth,
    negate_truth,
    reduce_term,
)

_I8, _I32, _I64 = (get_integer_type(bits) for bits in (8, 32, 64))
_ANY_TEXT = 8


def read_terminated(call: Call, pointer: Any, most: int | None = None) -> list[Any]:
    """The bytes of a C string up to the first one that is certainly zero, without it."""
    parts = read_bytes_from(call.run, call.state, pointer, most)
    for index, each in enumerate(parts):
        if isinstance(each, int) and each == 0:
            return parts[:index]
    if most is None or len(parts) < most:
        call.run.require(
            call.state, _join_any([compare_integers("eq", each, 0, 8) for each in parts]), CrashKind.INDEX, ""
        )
    return parts


def _join_any(conditions: list[Any]) -> Any:
    return negate_truth(join_truths(*[negate_truth(each) for each in conditions])) if conditions else 0


def measure_text(parts: list[Any]) -> Any:
    """Number of bytes before the first zero."""
    result: Any = len(parts)
    for index in reversed(range(len(parts))):
        result = choose_term(compare_integers("eq", parts[index], 0, 8), index, result, 64, False)
    return result


@model("strlen")
def measure_string(call: Call) -> Any:
    return measure_text(read_terminated(call, call.arguments[0]))


@model("strnlen")
def measure_string_bounded(call: Call) -> Any:
    count = call.arguments[1]
    if not isinstance(count, int):
        raise call.run.make_unknown("strnlen of a length that an input gives")
    return measure_text(read_terminated(call, call.arguments[0], count))


def compare_bytes(first: list[Any], second: list[Any], count: Any, stops_at_zero: bool) -> Any:
    """What memcmp or strcmp gives: -1, 0 or 1."""
    result: Any = 0
    most = min(len(first), len(second))
    for index in reversed(range(most)):
        left, right = first[index], second[index]
        same = compare_integers("eq", left, right, 8)
        if stops_at_zero:
            result = choose_term(compare_integers("eq", left, 0, 8), 0, result, 32, False)
        less = compare_integers("ult", left, right, 8)
        different = choose_term(less, 0xFFFF_FFFF, 1, 32, False)
        result = choose_term(same, result, different, 32, False)
        if not isinstance(count, int):
            result = choose_term(reduce_term(z3.UGT(count, index)), result, 0, 32, False)
    return result


@model("memcmp", "bcmp")
def compare_blocks(call: Call) -> Any:
    run, state = call.run, call.state
    first, second, count = call.arguments
    if isinstance(count, int):
        if count == 0:
            return 0
        require_access(run, state, first, count)
        require_access(run, state, second, count)
        most = count
    else:
        if NULL in (first, second):
            return 0
        most = run.find_most(state, count, 4096)
        if most == 0:
            return 0
    parts = [read_bytes_from(run, state, each, most) for each in (first, second)]
    return compare_bytes(parts[0], parts[1], count, False)


def _read_pair(call: Call, count: int | None) -> tuple[list[Any], list[Any]]:
    parts = [read_terminated(call, each, count) for each in call.arguments[:2]]
    length = max(len(each) for each in parts)
    padded = [[*each, *[0] * (length + (count is None) - len(each))] for each in parts]
    return padded[0], padded[1]


@model("strcmp", "strncmp", "strcoll")
def compare_strings(call: Call) -> Any:
    count = call.arguments[2] if call.name == "strncmp" else None
    if count is not None and not isinstance(count, int):
        raise call.run.make_unknown("strncmp of a length that an input gives")
    return compare_bytes(*_read_pair(call, count), 0, True)


@model("strcasecmp", "strncasecmp")
def compare_strings_loosely(call: Call) -> Any:
    count = call.arguments[2] if call.name == "strncasecmp" else None
    if count is not None and not isinstance(count, int):
        raise call.run.make_unknown("strncasecmp of a length that an input gives")
    first, second = _read_pair(call, count)
    return compare_bytes([_lower(each, 8) for each in first], [_lower(each, 8) for each in second], 0, True)


@model("memchr", "strchr", "rawmemchr", "strchrnul", "index")
def find_byte(call: Call) -> Any:
    run, state = call.run, call.state
    pointer, wanted = call.arguments[:2]
    wanted = compute_integer("and", wanted, 255, 32)
    wanted = wanted if isinstance(wanted, int) else reduce_term(z3.Extract(7, 0, wanted))
    if call.name == "memchr":
        count = call.arguments[2]
        most = run.find_most(state, count, 4096)
        if most == 0:
            return NULL
        parts = read_bytes_from(run, state, pointer, most)
        within = [compare_integers("ugt", count, index, 64) for index in range(len(parts))]
    else:
        parts = [*read_terminated(call, pointer), 0]
        within: list[Any] = []
        alive: Any = 1
        for each in parts:
            within.append(alive)
            alive = join_truths(alive, compare_integers("ne", each, 0, 8))
    hits = [
        join_truths(inside, compare_integers("eq", each, wanted, 8)) for inside, each in zip(within, parts, strict=True)
    ]
    if not run.decide(state, _join_any(hits)):
        return NULL
    place: Any = len(parts) - 1
    for index in reversed(range(len(parts))):
        place = choose_term(hits[index], index, place, 64, False)
    return Pointer(pointer.object, add_offsets(pointer.offset, place))


@model("strstr")
def find_text(call: Call) -> Any:
    run, state = call.run, call.state
    wanted = read_text(run, state, call.arguments[1]).encode()
    parts = read_terminated(call, call.arguments[0])
    alive: Any = 1
    hits = []
    for index in range(len(parts) - len(wanted) + 1):
        hits.append(
            join_truths(
                alive, *[compare_integers("eq", parts[index + step], byte, 8) for step, byte in enumerate(wanted)]
            )
        )
        alive = join_truths(alive, compare_integers("ne", parts[index], 0, 8)) if index < len(parts) else alive
    if not run.decide(state, _join_any(hits)):
        return NULL
    place: Any = 0
    for index in reversed(range(len(hits))):
        place = choose_term(hits[index], index, place, 64, False)
    return Pointer(call.arguments[0].object, add_offsets(call.arguments[0].offset, place))


@model("strcpy", "strncpy", "stpcpy", "strcat")
def copy_string(call: Call) -> Any:
    run, state = call.run, call.state
    target, source = call.arguments[:2]
    text = read_text(run, state, source).encode()
    if call.name == "strcat":
        target = Pointer(target.object, add_offsets(target.offset, len(read_text(run, state, target))))
    if call.name == "strncpy":
        count = call.arguments[2]
        if not isinstance(count, int):
            raise run.make_unknown("strncpy of a length that an input gives")
        content = text[:count].ljust(count, b"\0")
    else:
        content = text + b"\0"
    for index, byte in enumerate(content):
        store(run, state, Pointer(target.object, add_offsets(target.offset, index)), _I8, byte)
    return call.arguments[0]


# Characters.


def _lies_in(value: Any, low: int, high: int, bits: int) -> Any:
    return join_truths(compare_integers("uge", value, low, bits), compare_integers("ule", value, high, bits))


def _lower(value: Any, bits: int) -> Any:
    return choose_term(_lies_in(value, 65, 90, bits), compute_integer("add", value, 32, bits), value, bits, False)


@model("tolower", "toupper")
def change_case(call: Call) -> Any:
    value = call.arguments[0]
    if call.name == "tolower":
        return _lower(value, 32)
    return choose_term(_lies_in(value, 97, 122, 32), compute_integer("sub", value, 32, 32), value, 32, False)


_CLASSES = {
    "isdigit": ((48, 57),),
    "isalpha": ((65, 90), (97, 122)),
    "isalnum": ((48, 57), (65, 90), (97, 122)),
    "isspace": ((9, 13), (32, 32)),
    "isupper": ((65, 90),),
    "islower": ((97, 122),),
    "isxdigit": ((48, 57), (65, 70), (97, 102)),
    "ispunct": ((33, 47), (58, 64), (91, 96), (123, 126)),
    "isprint": ((32, 126),),
    "iscntrl": ((0, 31), (127, 127)),
    "isblank": ((9, 9), (32, 32)),
    "isgraph": ((33, 126),),
}


@model(*_CLASSES)
def check_character(call: Call) -> Any:
    value = call.arguments[0]
    inside = _join_any([_lies_in(value, low, high, 32) for low, high in _CLASSES[call.name]])
    return inside if isinstance(inside, int) else reduce_term(make_bits(make_truth(inside), 32))


# Numbers in texts.

_LONGEST_NUMBER = 18


def _is_space(value: Any) -> Any:
    return _join_any([_lies_in(value, 9, 13, 8), compare_integers("eq", value, 32, 8)])


def _is_digit(value: Any) -> Any:
    return _lies_in(value, 48, 57, 8)


def _store_end(call: Call, start: Pointer, length: Any):
    end = call.arguments[1] if len(call.arguments) > 1 else NULL
    if isinstance(end, Pointer) and end.object:
        store(call.run, call.state, end, POINTER, Pointer(start.object, add_offsets(start.offset, length)))


@model_pattern(r"(?:__isoc23_)?strto(?:l|ll|ul|ull|imax|umax)|ato(?:i|l|ll)|__strto(?:l|ul)_internal")
def read_integer(call: Call) -> Any:
    run, state = call.run, call.state
    start = call.arguments[0]
    is_signed = "toul" not in call.name and "toum" not in call.name
    base = call.arguments[2] if len(call.arguments) > 2 else 10
    parts = read_terminated(call, start)
    if all(isinstance(each, int) for each in parts) and isinstance(base, int):
        value, length, is_too_large = parse_integer(bytes(parts), base, is_signed)
        if is_too_large:
            store(run, state, run.find_variable(state, "errno", 4), _I32, 34)
        _store_end(call, start, length)
        return _fit(call, value & ((1 << 64) - 1))
    if base != 10:
        raise run.make_unknown("a number in a text, to another base than ten")
    value, length, is_long = make_integer_terms(parts)
    if run.decide(state, is_long):
        raise run.make_unknown(f"a number of more than {_LONGEST_NUMBER} digits")
    _store_end(call, start, length)
    return _fit(call, value)


def _fit(call: Call, value: Any) -> Any:
    bits = call.instruction.type.bits
    if bits >= 64:
        return value
    return value & ((1 << bits) - 1) if isinstance(value, int) else reduce_term(z3.Extract(bits - 1, 0, value))


def parse_integer(text: bytes, base: int, is_signed: bool) -> tuple[int, int, bool]:
    """Value, length and whether it is out of range, as strtol and strtoul say."""
    digits = {0: rb"0[xX][0-9a-fA-F]+|0[0-7]*|[1-9]\d*", 10: rb"\d+", 16: rb"(?:0[xX])?[0-9a-fA-F]+"}.get(base)
    if digits is None:
        alphabet = "0123456789abcdefghijklmnopqrstuvwxyz"[:base]
        digits = f"[{alphabet}{alphabet.upper()}]+".encode()
    found = re.match(rb"[ \t-\r]*([-+]?)(" + digits + rb")", text)
    if found is None:
        return 0, 0, False
    digit_text = found[2].decode()
    if base == 0:
        value = int(digit_text, 16 if digit_text[:2] in ("0x", "0X") else 8 if digit_text[0] == "0" else 10)
    else:
        value = int(digit_text, base)
    value = -value if found[1] == b"-" else value
    low, high = (-(1 << 63), (1 << 63) - 1) if is_signed else (-(1 << 64) + 1, (1 << 64) - 1)
    if low <= value <= high:
        return value, found.end(), False
    return (low if value < 0 and is_signed else high), found.end(), True


def make_integer_terms(parts: list[Any]) -> tuple[Any, Any, Any]:
    """The decimal number at the start of some bytes: value (64 bits), length, whether it has too many digits."""
    parts = [*parts, 0]
    count = len(parts)

    def read_digits(first: int) -> tuple[Any, Any, Any]:
        last = min(count - 1, first + _LONGEST_NUMBER)
        # As few bits as the largest number needs: products of 64 bits are slow to solve.
        bits = min(64, max(9, ((last - first) * 10 + 2) // 3 + 5))
        value: Any = 0
        end: Any = 0
        alive: Any = 1
        for place in range(first, last):
            alive = join_truths(alive, _is_digit(parts[place]))
            if isinstance(alive, int) and not alive:
                break
            digit = compute_integer("and", parts[place], 15, 8)
            digit = digit if isinstance(digit, int) else reduce_term(z3.ZeroExt(bits - 8, digit))
            following = compute_integer("add", compute_integer("mul", value, 10, bits), digit, bits)
            value = choose_term(alive, following, value, bits, False)
            end = choose_term(alive, place + 1, end, 64, False)
        place = first + _LONGEST_NUMBER
        is_long = join_truths(alive, _is_digit(parts[place])) if place < count - 1 else 0
        wide = value if isinstance(value, int) or bits == 64 else reduce_term(z3.ZeroExt(64 - bits, value))
        return wide, end, is_long

    digits = [read_digits(place) for place in range(count)]
    value: Any = 0
    length: Any = 0
    is_long: Any = 0
    before: Any = 1
    for place in range(count - 1):
        here = join_truths(before, negate_truth(_is_space(parts[place])))
        minus = compare_integers("eq", parts[place], 45, 8)
        signed = _join_any([minus, compare_integers("eq", parts[place], 43, 8)])
        plain, after = digits[place], digits[place + 1]
        negative = choose_term(minus, compute_integer("sub", 0, after[0], 64), after[0], 64, False)
        value = choose_term(here, choose_term(signed, negative, plain[0], 64, False), value, 64, False)
        length = choose_term(here, choose_term(signed, after[1], plain[1], 64, False), length, 64, False)
        is_long = choose_term(here, choose_term(signed, after[2], plain[2], 1, False), is_long, 1, False)
        before = join_truths(before, _is_space(parts[place]))
        if isinstance(before, int) and not before:
            break
    return value, length, is_long


@model("strtod", "strtof", "atof", "__strtod_internal", "strtold", "strtod_l", "strtof_l")
def read_float(call: Call) -> Any:
    run, state = call.run, call.state
    start = call.arguments[0]
    type_ = call.instruction.type
    if not type_.is_float:
        raise run.make_unknown("floats of 80 bits")
    parts = read_terminated(call, start)
    if all(isinstance(each, int) for each in parts):
        value, length = parse_float(bytes(parts), type_.bits)
        if math.isinf(value) and parts and any(48 <= each <= 57 for each in parts):
            store(run, state, run.find_variable(state, "errno", 4), _I32, 34)
        _store_end(call, start, length)
        return value
    if not run.decide(state, _begins_with_number(parts)):
        _store_end(call, start, 0)
        return 0.0
    result = run.make_derived(
        state, "the number in a text", lambda *each: parse_float(bytes(each).split(b"\0")[0], type_.bits)[0], parts,
        type_.bits,
    )  # fmt: skip
    length = run.make_any(state, "the length of a number in a text", 64)
    run.assume(state, _lies_in(length, 1, len(parts), 64))
    _store_end(call, start, length)
    return result


_FLOAT_TEXT = re.compile(
    rb"[ \t-\r]*[-+]?(?:0[xX](?:[0-9a-fA-F]+\.?[0-9a-fA-F]*|\.[0-9a-fA-F]+)(?:[pP][-+]?\d+)?"
    rb"|(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|[iI][nN][fF](?:[iI][nN][iI][tT][yY])?|[nN][aA][nN])"
)


def parse_float(text: bytes, bits: int) -> tuple[float, int]:
    """Value and length, as strtod says."""
    found = _FLOAT_TEXT.match(text)
    if found is None:
        return 0.0, 0
    number = found[0].strip().decode()
    try:
        value = float.fromhex(number) if "x" in number.lower() else float(number)
    except (ValueError, OverflowError):
        value = math.inf
    return (ctypes.c_float(value).value if bits == 32 else value), found.end()


def _begins_with_number(parts: list[Any]) -> Any:
    padded = [*parts, 0, 0, 0, 0]
    result: Any = 0
    before: Any = 1

    def begins(place: int) -> Any:
        dotted = join_truths(compare_integers("eq", padded[place], 46, 8), _is_digit(padded[place + 1]))
        words = [
            join_truths(
                *[compare_integers("eq", _lower(padded[place + step], 8), byte, 8) for step, byte in enumerate(word)]
            )
            for word in (b"inf", b"nan")
            if place + 2 < len(padded)
        ]
        return _join_any([_is_digit(padded[place]), dotted, *words])

    for place in range(len(parts)):
        here = join_truths(before, negate_truth(_is_space(padded[place])))
        signed = _join_any([compare_integers("eq", padded[place], byte, 8) for byte in (43, 45)])
        number = choose_term(signed, begins(place + 1), begins(place), 1, False)
        result = _join_any([result, join_truths(here, number)])
        before = join_truths(before, _is_space(padded[place]))
    return result


# Output.


def fill_any_text(call: Call, target: Pointer, what: str):
    """A std::string of the new ABI at an address, with a text that is not known."""
    run, state = call.run, call.state
    size = run.make_any(state, what, 8)
    run.assume(state, reduce_term(z3.ULE(size, _ANY_TEXT)))
    wide = z3.ZeroExt(56, size)
    buffer = Pointer(target.object, add_offsets(target.offset, 16))
    store(run, state, target, POINTER, buffer)
    store(run, state, Pointer(target.object, add_offsets(target.offset, 8)), _I64, wide)
    for index in range(16):
        value: Any = 0
        if index < _ANY_TEXT:
            value = reduce_term(z3.If(z3.UGT(size, index), run.make_any(state, what, 8), z3.BitVecVal(0, 8)))
        store(run, state, Pointer(target.object, add_offsets(buffer.offset, index)), _I8, value)


@model("_ZN9__gnu_cxx12__to_xstring*")
def format_number(call: Call) -> Any:
    fill_any_text(call, call.arguments[0], "a number as a text")


@model("snprintf", "vsnprintf", "sprintf", "vsprintf", "__snprintf_chk", "__vsnprintf_chk", "__sprintf_chk")
def format_text(call: Call) -> Any:
    run, state = call.run, call.state
    target = call.arguments[0]
    what = "a formatted text"
    most = _ANY_TEXT
    if "n" in call.name[:5].replace("__", "") and "snprintf" in call.name:
        count = call.arguments[1]
        if not isinstance(count, int):
            raise run.make_unknown("snprintf of a length that an input gives")
        most = min(most, count - 1)
    if isinstance(target, Pointer) and target.object and most >= 0:
        require_access(run, state, target, most + 1)
        for index in range(most):
            store(
                run, state, Pointer(target.object, add_offsets(target.offset, index)), _I8, run.make_any(state, what, 8)
            )
        store(run, state, Pointer(target.object, add_offsets(target.offset, most)), _I8, 0)
    result = run.make_any(state, what, 32)
    run.assume(state, reduce_term(z3.ULE(result, 1 << 16)))
    return result


_PRINTING = (
    "printf", "puts", "putchar", "fprintf", "fputs", "fputc", "putc", "fwrite", "vprintf", "vfprintf", "perror",
    "__printf_chk", "__fprintf_chk", "__vfprintf_chk", "syslog", "fputs_unlocked", "_IO_putc", "write",
)  # fmt: skip


@model(*_PRINTING)
def print_text(call: Call) -> Any:
    add_log(call.state, "stdout")
    type_ = call.instruction.type
    return 1 if type_.size else None


_STREAMS = ("_ZSt4cout", "_ZSt4cerr", "_ZSt4clog")


def _is_console(call: Call, pointer: Any) -> bool:
    return isinstance(pointer, Pointer) and call.run.made_globals.get(pointer.object, ("", None))[0] in _STREAMS


@model_pattern(
    r"_ZNSo(?:ls|9_M_insert|3put|5flush|5write)\w*|_ZSt(?:ls|4endl|4ends|5flush|16__ostream_insert)I?\w*"
    r"|_ZStlsISt11char_traits\w*|_ZStlsIcSt11char_traits\w*"
)
def insert_into_stream(call: Call) -> Any:
    if not call.instruction.type.is_pointer or not isinstance(call.arguments[0], Pointer):
        raise call.run.make_unknown(f"a call of `{call.name}`")
    if _is_console(call, call.arguments[0]):
        add_log(call.state, "stdout")
    return call.arguments[0]


@model_pattern(
    r"_ZNSt7__cxx11\d+basic_(?:string|ostring|istring)streamIcSt11char_traitsIcESaIcEE(?:C[12]|D[12])\w*"
    r"|_ZNSt8ios_base(?:C2|D2)Ev|_ZNSt6localeC1Ev|_ZNSt6localeD1Ev|_ZNSt9basic_iosIcSt11char_traitsIcEE4initE\w+"
)
def skip_stream(call: Call) -> Any:
    return None


@model_pattern(
    r"_ZNKSt7__cxx11\d+basic_(?:string|ostring|istring)streamIcSt11char_traitsIcESaIcEE3strEv"
    r"|_ZNKSt7__cxx1115basic_stringbufIcSt11char_traitsIcESaIcEE3strEv"
)
def read_stream(call: Call) -> Any:
    fill_any_text(call, call.arguments[0], "the text of a stream")
