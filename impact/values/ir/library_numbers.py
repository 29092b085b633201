"""Models of intrinsics on numbers and of <cmath>. What z3 does not know (sines, logarithms) is a variable that lies
where the function's values lie; it is calculated where inputs are guessed."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import z3

from .access import store
from .executor import Call
from .layout import IrType
from .models import model, model_pattern
from .module import Pointer
from .terms import (
    NEAREST,
    choose_term,
    compare_floats,
    compare_integers,
    compute_float,
    compute_integer,
    convert_float_to_integer,
    is_term,
    join_truths,
    make_bits,
    make_float,
    make_float_bits,
    make_truth,
    negate_truth,
    read_float_bits,
    read_signed,
    reduce_term,
    round_float,
)

Lane = Callable[[Any, list[Any], IrType], Any]


def _apply(call: Call, compute: Callable[..., Any], count: int) -> Any:
    """compute(arguments..., type of them) for a scalar, or for each lane of a vector."""
    type_ = call.types[0]
    values = call.arguments[:count]
    if type_.is_aggregate:
        element = type_.element  # pyright: ignore[reportAttributeAccessIssue]
        lanes = zip(*[call.run.list_parts(each, type_) for each in values], strict=True)
        return [compute(*[call.run.define(call.state, each, element) for each in lane], element) for lane in lanes]
    return compute(*[call.run.define(call.state, each, type_) for each in values], type_)


# Integers.


@model_pattern(r"llvm\.[su](?:max|min)\.\w+")
def choose_extreme(call: Call) -> Any:
    name = call.name[5:9]
    predicate = name[0] + ("gt" if name[1:] == "max" else "lt")

    def compute(left: Any, right: Any, type_: IrType) -> Any:
        condition = call.run.compare(predicate, left, right, type_)
        return call.run.choose_value(call.state, condition, left, right, type_)

    return _apply(call, compute, 2)


@model("llvm.abs.*")
def compute_absolute(call: Call) -> Any:
    def compute(value: Any, type_: IrType) -> Any:
        negative = compute_integer("sub", 0, value, type_.bits)
        return choose_term(compare_integers("slt", value, 0, type_.bits), negative, value, type_.bits, False)

    return _apply(call, compute, 1)


@model("abs", "labs", "llabs")
def compute_absolute_plain(call: Call) -> Any:
    return compute_absolute(call)


@model_pattern(r"llvm\.[su](?:add|sub|mul)\.with\.overflow\.i\d+")
def compute_with_overflow(call: Call) -> Any:
    run, state = call.run, call.state
    type_ = call.types[0]
    left, right = (run.define(state, each, type_) for each in call.arguments[:2])
    if isinstance(left, Pointer) or isinstance(right, Pointer):
        return [run.compute(call.name[6:9], left, right, type_), 0]
    bits, is_signed, operation = type_.bits, call.name[5] == "s", call.name[6:9]
    result = compute_integer(operation, left, right, bits)
    if isinstance(left, int) and isinstance(right, int):
        if is_signed:
            left, right, short = read_signed(left, bits), read_signed(right, bits), read_signed(result, bits)
        else:
            short = result
        exact = left + right if operation == "add" else left - right if operation == "sub" else left * right
        return [result, int(exact != short)]
    if operation == "mul":
        wide = 2 * bits
        extend = z3.SignExt if is_signed else z3.ZeroExt
        product = extend(bits, make_bits(left, bits)) * extend(bits, make_bits(right, bits))
        return [result, reduce_term(product != extend(wide - bits, make_bits(result, bits)))]
    extend = z3.SignExt if is_signed else z3.ZeroExt
    first, second = extend(1, make_bits(left, bits)), extend(1, make_bits(right, bits))
    exact = first + second if operation == "add" else first - second
    return [result, reduce_term(exact != extend(1, make_bits(result, bits)))]


@model_pattern(r"llvm\.[su](?:add|sub)\.sat\.\w+")
def compute_saturated(call: Call) -> Any:
    is_signed, operation = call.name[5] == "s", call.name[6:9]

    def compute(left: Any, right: Any, type_: IrType) -> Any:
        bits = type_.bits
        extend = z3.SignExt if is_signed else z3.ZeroExt
        first, second = extend(2, make_bits(left, bits)), extend(2, make_bits(right, bits))
        exact = first + second if operation == "add" else first - second
        low, high = (-(1 << (bits - 1)), (1 << (bits - 1)) - 1) if is_signed else (0, (1 << bits) - 1)
        bounded = z3.If(
            exact < low, z3.BitVecVal(low, bits + 2), z3.If(exact > high, z3.BitVecVal(high, bits + 2), exact)
        )
        return reduce_term(z3.Extract(bits - 1, 0, bounded))

    return _apply(call, compute, 2)


@model("llvm.ctpop.*", "llvm.ctlz.*", "llvm.cttz.*", "llvm.bswap.*", "llvm.bitreverse.*")
def count_bits(call: Call) -> Any:
    what = call.name.split(".")[1]

    def compute(value: Any, type_: IrType) -> Any:
        bits = type_.bits
        if what == "bswap":
            if isinstance(value, int):
                return int.from_bytes(value.to_bytes(bits // 8, "little"), "big")
            return reduce_term(z3.Concat(*[z3.Extract(place + 7, place, value) for place in range(0, bits, 8)]))
        if what == "bitreverse":
            if isinstance(value, int):
                return int(f"{value:0{bits}b}"[::-1], 2)
            return reduce_term(z3.Concat(*[z3.Extract(place, place, value) for place in range(bits)]))
        if isinstance(value, int):
            if what == "ctpop":
                return bin(value).count("1")
            if value == 0:
                return bits
            return bits - value.bit_length() if what == "ctlz" else (value & -value).bit_length() - 1
        result: Any = z3.BitVecVal(0 if what == "ctpop" else bits, bits)
        if what == "ctpop":
            for place in range(bits):
                result = result + z3.ZeroExt(bits - 1, z3.Extract(place, place, value))
        else:
            places = range(bits) if what == "ctlz" else reversed(range(bits))
            for place in places:
                count = bits - 1 - place if what == "ctlz" else place
                result = z3.If(z3.Extract(place, place, value) == 1, z3.BitVecVal(count, bits), result)
        return reduce_term(result)

    return _apply(call, compute, 1)


@model("llvm.fshl.*", "llvm.fshr.*")
def shift_funnel(call: Call) -> Any:
    is_left = call.name[8] == "l"

    def compute(high: Any, low: Any, count: Any, type_: IrType) -> Any:
        bits = type_.bits
        whole = z3.Concat(make_bits(high, bits), make_bits(low, bits))
        amount = z3.ZeroExt(bits, z3.URem(make_bits(count, bits), z3.BitVecVal(bits, bits)))
        if is_left:
            return reduce_term(z3.Extract(2 * bits - 1, bits, whole << amount))
        return reduce_term(z3.Extract(bits - 1, 0, z3.LShR(whole, amount)))

    return _apply(call, compute, 3)


@model("llvm.objectsize.*")
def measure_object(call: Call) -> Any:
    pointer = call.arguments[0]
    memory_object = call.state.objects.get(pointer.object) if isinstance(pointer, Pointer) else None
    if memory_object is None or memory_object.limit is not None or not isinstance(pointer.offset, int):
        return 0 if call.arguments[1] else (1 << 64) - 1
    return max(0, memory_object.size - pointer.offset)


_PASSING = (
    "llvm.expect.*", "llvm.ssa.copy*", "llvm.launder.*", "llvm.strip.*", "llvm.threadlocal.address*",
    "llvm.annotation.*", "llvm.arithmetic.fence*", "llvm.ptrmask*",
)  # fmt: skip


@model(*_PASSING)
def pass_first(call: Call) -> Any:
    return call.arguments[0]


@model("llvm.is.constant.*")
def check_constant(call: Call) -> Any:
    return 0


@model("llvm.stacksave*", "llvm.returnaddress*", "llvm.frameaddress*")
def find_stack(call: Call) -> Any:
    return call.run.find_variable(call.state, "the stack", 8)


@model("llvm.fptosi.sat.*", "llvm.fptoui.sat.*")
def convert_saturated(call: Call) -> Any:
    run, state = call.run, call.state
    source, target = call.types[0], call.instruction.type
    value = run.define(state, call.arguments[0], source)
    is_signed = call.name.startswith("llvm.fptosi")
    bits = target.bits
    low, high = (-(1 << (bits - 1)), (1 << (bits - 1)) - 1) if is_signed else (0, (1 << bits) - 1)
    if isinstance(value, float):
        if math.isnan(value):
            return 0
        return int(max(low, min(high, value))) & ((1 << bits) - 1)
    inside = convert_float_to_integer(value, bits, source.bits, is_signed)
    too_low = compare_floats("olt", value, float(low), source.bits)
    too_high = compare_floats("oge", value, float(high), source.bits)
    result = choose_term(
        too_low, low & ((1 << bits) - 1), choose_term(too_high, high, inside, bits, False), bits, False
    )
    return choose_term(compare_floats("uno", value, value, source.bits), 0, result, bits, False)


# Floats.


def _round_number(value: float, how: str) -> float:
    if not math.isfinite(value):
        return value
    whole = {
        "floor": math.floor, "ceil": math.ceil, "trunc": math.trunc, "round": _round_away, "rint": round,
        "nearbyint": round, "roundeven": round,
    }[how](value)  # fmt: skip
    return math.copysign(float(whole), value)


def _round_away(value: float) -> int:
    return math.floor(value + 0.5) if value >= 0 and value % 1 != 0.49999999999999994 else math.ceil(value - 0.5)


_MODES = {
    "floor": z3.RTN, "ceil": z3.RTP, "trunc": z3.RTZ, "round": z3.RNA, "rint": z3.RNE, "nearbyint": z3.RNE,
    "roundeven": z3.RNE,
}  # fmt: skip
_ROUNDED = "floor|ceil|trunc|round|rint|nearbyint|roundeven"


@model_pattern(rf"llvm\.(?:{_ROUNDED})\.\w+|(?:{_ROUNDED})f?")
def round_whole(call: Call) -> Any:
    how = call.name.split(".")[1] if call.name.startswith("llvm.") else call.name
    if how not in _MODES:
        how = how.removesuffix("f")

    def compute(value: Any, type_: IrType) -> Any:
        if isinstance(value, float):
            return _round_number(value, how)
        return reduce_term(z3.fpRoundToIntegral(_MODES[how](), value))

    return _apply(call, compute, 1)


@model_pattern(r"llvm\.l?l?r(?:ound|int)\.\w+\.\w+|l?lr(?:ound|int)f?")
def round_to_integer(call: Call) -> Any:
    run, state = call.run, call.state
    source, target = call.types[0], call.instruction.type
    value = run.define(state, call.arguments[0], source)
    how = "round" if "round" in call.name else "rint"
    if isinstance(value, float):
        whole = _round_number(value, how)
    else:
        whole = reduce_term(z3.fpRoundToIntegral(_MODES[how](), value))
    limit = float(1 << (target.bits - 1))
    inside = join_truths(
        compare_floats("oge", whole, -limit, source.bits), compare_floats("olt", whole, limit, source.bits)
    )
    if not run.decide(state, inside):
        return run.make_any_scalar(state, f"{call.name} of a number that is too large", target)
    return convert_float_to_integer(whole, target.bits, source.bits, True)


@model("llvm.fabs.*", "fabs", "fabsf")
def compute_magnitude(call: Call) -> Any:
    return _apply(call, lambda value, _: abs(value) if isinstance(value, float) else reduce_term(z3.fpAbs(value)), 1)


@model("llvm.sqrt.*", "sqrt", "sqrtf")
def compute_root(call: Call) -> Any:
    def compute(value: Any, type_: IrType) -> Any:
        if isinstance(value, float):
            return math.nan if value < 0 or math.isnan(value) else round_float(math.sqrt(value), type_.bits)
        return reduce_term(z3.fpSqrt(NEAREST, value))

    return _apply(call, compute, 1)


@model("llvm.fma.*", "fma", "fmaf")
def compute_fused(call: Call) -> Any:
    def compute(first: Any, second: Any, third: Any, type_: IrType) -> Any:
        terms = [make_float(each, type_.bits) for each in (first, second, third)]
        return reduce_term(z3.fpFMA(NEAREST, *terms))

    return _apply(call, compute, 3)


@model("llvm.fmuladd.*")
def compute_multiplied(call: Call) -> Any:
    def compute(first: Any, second: Any, third: Any, type_: IrType) -> Any:
        return compute_float("fadd", compute_float("fmul", first, second, type_.bits), third, type_.bits)

    return _apply(call, compute, 3)


@model("llvm.copysign.*", "copysign", "copysignf")
def copy_sign(call: Call) -> Any:
    def compute(value: Any, sign: Any, type_: IrType) -> Any:
        bits = type_.bits
        if isinstance(value, float) and isinstance(sign, float):
            return math.copysign(value, sign)
        low = (1 << (bits - 1)) - 1
        kept = compute_integer("and", make_float_bits(value, bits), low, bits)
        top = compute_integer("and", make_float_bits(sign, bits), low + 1, bits)
        return reduce_term(read_float_bits(compute_integer("or", kept, top, bits), bits))

    return _apply(call, compute, 2)


@model_pattern(r"llvm\.(?:minnum|maxnum|minimum|maximum)\.\w+|f(?:min|max)f?")
def choose_float(call: Call) -> Any:
    is_least = "min" in call.name
    passes_nan = "imum" in call.name

    def compute(left: Any, right: Any, type_: IrType) -> Any:
        bits = type_.bits
        condition = compare_floats("olt" if is_least else "ogt", left, right, bits)
        result = choose_term(condition, left, right, bits, True)
        left_nan, right_nan = (compare_floats("uno", each, each, bits) for each in (left, right))
        if passes_nan:
            return choose_term(left_nan, left, choose_term(right_nan, right, result, bits, True), bits, True)
        return choose_term(left_nan, right, choose_term(right_nan, left, result, bits, True), bits, True)

    return _apply(call, compute, 2)


@model("llvm.is.fpclass.*")
def check_class(call: Call) -> Any:
    mask = call.arguments[1]

    def compute(value: Any, type_: IrType) -> Any:
        term = make_float(value, type_.bits)
        negative = z3.fpIsNegative(term)
        classes = (
            (3, z3.fpIsNaN(term)),
            (4, z3.And(z3.fpIsInf(term), negative)),
            (8, z3.And(z3.fpIsNormal(term), negative)),
            (16, z3.And(z3.fpIsSubnormal(term), negative)),
            (32, z3.And(z3.fpIsZero(term), negative)),
            (64, z3.And(z3.fpIsZero(term), z3.Not(negative))),
            (128, z3.And(z3.fpIsSubnormal(term), z3.Not(negative))),
            (256, z3.And(z3.fpIsNormal(term), z3.Not(negative))),
            (512, z3.And(z3.fpIsInf(term), z3.Not(negative))),
        )
        return reduce_term(z3.Or(*[each for bit, each in classes if mask & bit]))

    return _apply(call, compute, 1)


@model("isnan", "isnanf", "__isnan", "__isnanf")
def check_nan(call: Call) -> Any:
    value = call.run.define(call.state, call.arguments[0], call.types[0])
    return _widen(compare_floats("uno", value, value, call.types[0].bits))


@model("isinf", "isinff", "__isinf", "__isinff", "finite", "finitef", "__finite", "__finitef")
def check_infinite(call: Call) -> Any:
    bits = call.types[0].bits
    term = make_float(call.run.define(call.state, call.arguments[0], call.types[0]), bits)
    if "finite" in call.name:
        return _widen(reduce_term(z3.Not(z3.Or(z3.fpIsNaN(term), z3.fpIsInf(term)))))
    return _widen(reduce_term(z3.fpIsInf(term)))


def _widen(value: Any) -> Any:
    return value if isinstance(value, int) else reduce_term(make_bits(make_truth(value), 32))


# Functions whose values z3 does not know: how they are calculated, and between which bounds they lie. None: no bound.
_HALF_TURN = math.nextafter(math.pi, 4.0) if hasattr(math, "nextafter") else 3.1415926535897936
_KNOWN: dict[str, tuple[Callable[..., float], float | None, float | None]] = {
    "sin": (math.sin, -1.0, 1.0),
    "cos": (math.cos, -1.0, 1.0),
    "tan": (math.tan, None, None),
    "asin": (math.asin, -_HALF_TURN / 2, _HALF_TURN / 2),
    "acos": (math.acos, 0.0, _HALF_TURN),
    "atan": (math.atan, -_HALF_TURN / 2, _HALF_TURN / 2),
    "atan2": (math.atan2, -_HALF_TURN, _HALF_TURN),
    "sinh": (math.sinh, None, None),
    "cosh": (math.cosh, 1.0, None),
    "tanh": (math.tanh, -1.0, 1.0),
    "exp": (math.exp, 0.0, None),
    "exp2": (lambda value: 2.0**value, 0.0, None),
    "expm1": (math.expm1, -1.0, None),
    "log": (math.log, None, None),
    "log2": (math.log2, None, None),
    "log10": (math.log10, None, None),
    "log1p": (math.log1p, None, None),
    "pow": (math.pow, None, None),
    "hypot": (math.hypot, 0.0, None),
    "cbrt": (lambda value: math.copysign(abs(value) ** (1 / 3), value), None, None),
    "fmod": (math.fmod, None, None),
    "remainder": (math.remainder, None, None),
    "erf": (math.erf, -1.0, 1.0),
    "tgamma": (math.gamma, None, None),
    "lgamma": (math.lgamma, None, None),
    "powi": (lambda value, power: value ** read_signed(power, 32), None, None),
    "ldexp": (lambda value, power: math.ldexp(value, read_signed(power, 32)), None, None),
}
# Those that give no number for some numbers: where they do.
_DOMAINS: dict[str, Callable[[list[Any], int], Any]] = {
    "asin": lambda values, bits: _lies_between(values[0], -1.0, 1.0, bits),
    "acos": lambda values, bits: _lies_between(values[0], -1.0, 1.0, bits),
    "sin": lambda values, bits: _is_finite(values[0], bits),
    "cos": lambda values, bits: _is_finite(values[0], bits),
    "tan": lambda values, bits: _is_finite(values[0], bits),
    "log": lambda values, bits: compare_floats("oge", values[0], 0.0, bits),
    "log2": lambda values, bits: compare_floats("oge", values[0], 0.0, bits),
    "log10": lambda values, bits: compare_floats("oge", values[0], 0.0, bits),
    "log1p": lambda values, bits: compare_floats("oge", values[0], -1.0, bits),
    "fmod": lambda values, bits: join_truths(
        _is_finite(values[0], bits), compare_floats("une", values[1], 0.0, bits), _is_number(values[1], bits)
    ),
    "remainder": lambda values, bits: join_truths(
        _is_finite(values[0], bits), compare_floats("une", values[1], 0.0, bits), _is_number(values[1], bits)
    ),
}  # fmt: skip
_NAMES = "|".join(sorted(_KNOWN, key=len, reverse=True))


def _lies_between(value: Any, low: float, high: float, bits: int) -> Any:
    return join_truths(compare_floats("oge", value, low, bits), compare_floats("ole", value, high, bits))


def _is_finite(value: Any, bits: int) -> Any:
    return _lies_between(value, -_LARGEST[bits], _LARGEST[bits], bits)


def _is_number(value: Any, bits: int) -> Any:
    return compare_floats("ord", value, value, bits)


_LARGEST = {64: 1.7976931348623157e308, 32: 3.4028234663852886e38}


@model_pattern(rf"(?:__)?(?:{_NAMES})f?(?:_finite)?|llvm\.(?:{_NAMES})\.[\w.]+")
def compute_known(call: Call) -> Any:
    run, state = call.run, call.state
    name = call.name.removeprefix("__").removesuffix("_finite")
    name = name.split(".")[1] if name.startswith("llvm.") else name
    if name not in _KNOWN:
        name = name.removesuffix("f")
    compute, low, high = _KNOWN[name]
    bits = call.instruction.type.bits
    if not call.instruction.type.is_float:
        raise run.make_unknown(f"`{call.name}` of several numbers at once")
    values = [run.define(state, each, type_) for each, type_ in zip(call.arguments, call.types, strict=True)]
    if not any(is_term(each) for each in values):
        return calculate_known(compute, values, bits)
    result = run.make_derived(state, name, lambda *each: calculate_known(compute, list(each), bits), values, bits)
    floats = [each for each, type_ in zip(values, call.types, strict=True) if type_.is_float]
    if name in ("pow", "powi", "ldexp", "tgamma", "lgamma"):
        return result
    are_numbers = join_truths(*[_is_number(each, bits) for each in floats])
    inside = join_truths(are_numbers, _DOMAINS[name](values, bits)) if name in _DOMAINS else are_numbers
    number = compare_floats("ord", result, result, bits)
    bounds = [
        compare_floats(predicate, result, round_float(bound, bits), bits)
        for predicate, bound in (("oge", low), ("ole", high))
        if bound is not None
    ]
    if name in ("fmod", "remainder"):
        bounds.append(compare_floats("ole", take_magnitude(result), take_magnitude(values[1]), bits))
    holds = join_truths(number, *bounds)
    run.assume(state, _join_either(inside, holds, negate_truth(number)))
    return result


def take_magnitude(value: Any) -> Any:
    return abs(value) if isinstance(value, float) else z3.fpAbs(value)


def _join_either(condition: Any, first: Any, second: Any) -> Any:
    return choose_term(condition, first, second, 1, False)


def calculate_known(compute: Callable[..., float], values: list[Any], bits: int) -> float:
    """A function of <cmath> on numbers, with NaN and infinities as C gives them."""
    if any(isinstance(each, float) and math.isnan(each) for each in values):
        return math.nan
    try:
        return round_float(float(compute(*values)), bits)
    except ValueError:
        if compute in (math.log, math.log2, math.log10) and values[0] == 0:
            return -math.inf
        return math.nan
    except (OverflowError, ZeroDivisionError):
        return math.inf


@model("sincos", "sincosf")
def compute_both(call: Call) -> Any:
    run, state = call.run, call.state
    type_ = call.types[0]
    value = run.define(state, call.arguments[0], type_)
    for name, pointer in (("sin", call.arguments[1]), ("cos", call.arguments[2])):
        compute = _KNOWN[name][0]
        if isinstance(value, float):
            result: Any = calculate_known(compute, [value], type_.bits)
        else:
            result = run.make_derived(
                state, name, lambda *each, compute=compute: calculate_known(compute, list(each), type_.bits), [value],
                type_.bits,
            )  # fmt: skip
            number = compare_floats("ord", result, result, type_.bits)
            holds = join_truths(number, _lies_between(result, -1.0, 1.0, type_.bits))
            run.assume(state, _join_either(_is_finite(value, type_.bits), holds, negate_truth(number)))
        store(run, state, pointer, type_, result)


@model("modf", "modff")
def split_number(call: Call) -> Any:
    run, state = call.run, call.state
    type_ = call.types[0]
    value = run.define(state, call.arguments[0], type_)
    if isinstance(value, float):
        whole: Any = _round_number(value, "trunc")
    else:
        whole = reduce_term(z3.fpRoundToIntegral(z3.RTZ(), value))
    store(run, state, call.arguments[1], type_, whole)
    if isinstance(value, float) and math.isinf(value):
        return math.copysign(0.0, value)
    return compute_float("fsub", value, whole, type_.bits)


@model("frexp", "frexpf")
def split_exponent(call: Call) -> Any:
    raise call.run.make_unknown("frexp")
