"""What a harness calls: inputs, effects, logs, sent messages. See harness/runtime/rosimpact_values.h."""

from __future__ import annotations

from typing import Any

import z3

from ..outcomes import InputKind, Observable, Reaction, Sent
from .access import read_bytes_from, read_text, require_access
from .executor import Call, Ended
from .memory import MemoryObject
from .models import model
from .module import UNDEFINED, Pointer
from .state import Member, State
from .terms import (
    compare_integers,
    is_term,
    make_bits,
    make_float_bits,
    make_truth,
    pack_float,
    read_float_bits,
    reduce_term,
)

_SIZE_BITS = 16


def _read_name(call: Call, number: int) -> str:
    try:
        return read_text(call.run, call.state, call.arguments[number])
    except Ended:
        return "?"


def _make_path(state: State, name: str) -> str:
    path = ""
    for part in (*state.path, name):
        if part:
            path += part if part.startswith("[") or not path else f".{part}"
    return path


@model("ri_enter")
def enter_name(call: Call) -> Any:
    call.state.path = (*call.state.path, _read_name(call, 0))


@model("ri_enter_index")
def enter_index(call: Call) -> Any:
    index = call.arguments[0]
    if not isinstance(index, int):
        values = call.run.list_values(call.state, index, 64, 64)
        if values is None:
            raise call.run.make_unknown("an index of a field is any of many")
        index = call.run.choose(call.state, index, values)
    call.state.path = (*call.state.path, f"[{index}]")


@model("ri_leave")
def leave_name(call: Call) -> Any:
    call.state.path = call.state.path[:-1]


@model("ri_integer")
def make_integer(call: Call) -> Any:
    bits, is_signed = call.arguments[1], bool(call.arguments[2])
    path = _make_path(call.state, _read_name(call, 0))
    term = call.run.solving.make_input(path, InputKind.INTEGER, bits, is_signed).term
    if bits == 64:
        return term
    return reduce_term(z3.SignExt(64 - bits, term) if is_signed else z3.ZeroExt(64 - bits, term))


@model("ri_boolean")
def make_boolean(call: Call) -> Any:
    path = _make_path(call.state, _read_name(call, 0))
    return reduce_term(z3.ZeroExt(63, call.run.solving.make_input(path, InputKind.BOOLEAN, 1).term))


@model("ri_float64")
def make_float64(call: Call) -> Any:
    return _make_float(call, InputKind.FLOAT64, 64)


@model("ri_float32")
def make_float32(call: Call) -> Any:
    return _make_float(call, InputKind.FLOAT32, 32)


def _make_float(call: Call, kind: InputKind, bits: int) -> Any:
    path = _make_path(call.state, _read_name(call, 0))
    if path.endswith(".w") and path not in call.state.model:
        # Of a quaternion: the example to begin with turns nothing, instead of being no rotation at all.
        call.state.model[path] = pack_float(1.0, bits)
    return read_float_bits(call.run.solving.make_input(path, kind, bits, True).term, bits)


@model("ri_size")
def make_size(call: Call) -> Any:
    most = call.arguments[1]
    path = _make_path(call.state, _read_name(call, 0)) + ".size"
    term = call.run.solving.make_input(path, InputKind.SIZE, _SIZE_BITS, False, most).term
    call.run.assume(call.state, reduce_term(z3.ULE(term, most)))
    return reduce_term(z3.ZeroExt(64 - _SIZE_BITS, term))


@model("ri_characters")
def make_characters(call: Call) -> Any:
    run, state = call.run, call.state
    path = _make_path(state, _read_name(call, 0))
    most = call.arguments[2]
    target = require_access(run, state, call.arguments[1], most + 1)
    size = run.solving.inputs.get(path + ".size")
    memory_object = state.take_object(target.object)
    for index in range(most):
        term: Any = run.solving.make_input(f"{path}[{index}]", InputKind.CHARACTER, 8).term
        if size is not None:
            term = reduce_term(z3.If(z3.UGT(size.term, index), term, z3.BitVecVal(0, 8)))
        memory_object.write(target.offset + index, 1, term)
    memory_object.write(target.offset + most, 1, 0)


@model("ri_effect")
def note_effect(call: Call) -> Any:
    run, state = call.run, call.state
    observable = Observable(_read_name(call, 0), _read_name(call, 1), run.find_place(state))
    if observable not in state.effects:
        state.effects = (*state.effects, observable)


@model("ri_log")
def note_log(call: Call) -> Any:
    add_log(call.state, _read_name(call, 0))


def add_log(state: State, level: str):
    """Notes that something was logged."""
    if level not in state.logs:
        state.logs = (*state.logs, level)


@model("ri_sent_begin")
def begin_sent(call: Call) -> Any:
    call.state.sending = Sent(_read_name(call, 0), {}, {}, call.run.find_place(call.state))


@model("ri_sent_end")
def end_sent(call: Call) -> Any:
    if call.state.sending is not None:
        call.state.sent = (*call.state.sent, call.state.sending)
        call.state.sending = None


def _add_sent(state: State, path: str, value: Any, kind: tuple[InputKind, int, bool]):
    sending = state.sending
    # An address is no value of a field: raw bytes that somebody copied.
    if sending is not None and (isinstance(value, int) or is_term(value)):
        state.sending = sending._replace(values={**sending.values, path: value}, kinds={**sending.kinds, path: kind})


def _cut(value: Any, bits: int) -> Any:
    if isinstance(value, int):
        return value & ((1 << bits) - 1)
    if not is_term(value):
        return UNDEFINED
    return reduce_term(z3.Extract(bits - 1, 0, value)) if bits < value.size() else value


@model("ri_sent_integer")
def add_sent_integer(call: Call) -> Any:
    bits, is_signed = call.arguments[1], bool(call.arguments[2])
    path = _make_path(call.state, _read_name(call, 0))
    _add_sent(call.state, path, _cut(call.arguments[3], bits), (InputKind.INTEGER, bits, is_signed))


@model("ri_sent_boolean")
def add_sent_boolean(call: Call) -> Any:
    path = _make_path(call.state, _read_name(call, 0))
    value = call.arguments[1]
    if isinstance(value, int) or is_term(value):
        value = compare_integers("ne", value, 0, 64)
        value = value if isinstance(value, int) else make_bits(make_truth(value), 1)
    _add_sent(call.state, path, value, (InputKind.BOOLEAN, 1, False))


@model("ri_sent_float64")
def add_sent_float64(call: Call) -> Any:
    path = _make_path(call.state, _read_name(call, 0))
    value = call.arguments[1]
    value = make_float_bits(value, 64) if isinstance(value, int | float) or is_term(value) else UNDEFINED
    _add_sent(call.state, path, value, (InputKind.FLOAT64, 64, True))


@model("ri_sent_float32")
def add_sent_float32(call: Call) -> Any:
    path = _make_path(call.state, _read_name(call, 0))
    value = call.arguments[1]
    value = make_float_bits(value, 32) if isinstance(value, int | float) or is_term(value) else UNDEFINED
    _add_sent(call.state, path, value, (InputKind.FLOAT32, 32, True))


@model("ri_sent_size")
def add_sent_size(call: Call) -> Any:
    path = _make_path(call.state, _read_name(call, 0)) + ".size"
    _add_sent(call.state, path, call.arguments[1], (InputKind.SIZE, 64, False))


@model("ri_sent_characters")
def add_sent_characters(call: Call) -> Any:
    run, state = call.run, call.state
    path = _make_path(state, _read_name(call, 0))
    pointer, size = call.arguments[1], call.arguments[2]
    most = run.find_most(state, size, 256)
    _add_sent(state, path + ".size", size, (InputKind.SIZE, 64, False))
    if not most:
        return
    parts = read_bytes_from(run, state, pointer, most)
    for index, value in enumerate(parts):
        _add_sent(state, f"{path}[{index}]", value, (InputKind.CHARACTER, 8, False))


@model("ri_member")
def note_member(call: Call) -> Any:
    run, state = call.run, call.state
    pointer, size = call.arguments[1], call.arguments[2]
    if not isinstance(pointer, Pointer) or not isinstance(pointer.offset, int) or not isinstance(size, int):
        raise run.make_unknown("a member without a place")
    name = _read_name(call, 0)
    state.owner = object()
    state.members = (*state.members, Member(name, pointer, size, dict(state.objects)))


@model("ri_begin")
def begin_callback(call: Call) -> Any:
    state = call.state
    state.has_begun = True
    state.begun_at = len(state.conditions)
    state.effects = state.logs = state.sent = ()
    # What was called before is none of the callback's, but may have changed what it works with.
    kept = tuple(each for each in state.notes if each.startswith("a member"))
    state.has_forgotten = state.has_forgotten or len(kept) < len(state.notes)
    state.assumed_notes = tuple(dict.fromkeys((*state.assumed_notes, *state.notes)))
    state.notes = kept


@model("ri_end")
def end_callback(call: Call) -> Any:
    raise Ended(Reaction.IGNORED)


@model("ri_resize")
def resize_block(call: Call) -> Any:
    pointer, size = call.arguments
    if not isinstance(pointer, Pointer) or pointer.object == 0:
        return
    memory_object: MemoryObject = call.state.take_object(pointer.object)
    if isinstance(size, int):
        memory_object.size = min(memory_object.size, size)
    else:
        memory_object.limit = size


@model("ri_unknown")
def end_unknown(call: Call) -> Any:
    raise call.run.make_unknown(_read_name(call, 0))


@model("ri_cut")
def end_cut(call: Call) -> Any:
    if call.state.has_begun:
        raise call.run.make_unknown(_read_name(call, 0))
    call.state.has_forgotten = True


@model("ri_foreign")
def note_foreign(call: Call) -> Any:
    name = _read_name(call, 0)
    call.state.has_forgotten = True
    if name not in call.state.notes:
        call.state.notes = (*call.state.notes, name)


@model("ri_forget")
def forget_bytes(call: Call) -> Any:
    pointer, size = call.arguments
    call.state.has_forgotten = True
    if isinstance(pointer, Pointer) and pointer.object and isinstance(size, int):
        call.run.forget_memory(call.state, pointer, size)


@model("ri_assume")
def assume_condition(call: Call) -> Any:
    call.run.assume(call.state, compare_integers("ne", call.arguments[0], 0, 32))
