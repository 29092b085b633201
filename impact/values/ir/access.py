"""Loads, stores and copies, also at symbolic offsets and of symbolic sizes, without a fork where that is possible.

A load at a symbolic offset becomes a choice among what lies at all offsets that it can have; a store changes each of
them under a condition. Only addresses force a fork.
"""

from __future__ import annotations

from typing import Any

import z3

from ..outcomes import CrashKind
from .layout import IrType, get_integer_type
from .machine import Machine
from .memory import MemoryObject, interpret_raw, read_raw
from .module import UNDEFINED, Code, Pointer
from .state import State
from .terms import (
    add_offsets,
    choose_term,
    compare_integers,
    count_trailing_zeros,
    is_term,
    join_terms,
    join_truths,
    make_bits,
    make_float_bits,
    read_signed,
    reduce_term,
)

_MOST_OFFSETS = 512
_FEW_OFFSETS = 40
_BYTE = get_integer_type(8)


def require_access(run: Machine, state: State, pointer: Any, size: int) -> Pointer:
    """Ends the ways on which some bytes may not be used; gives the pointer for the others."""
    if not isinstance(pointer, Pointer):
        if isinstance(pointer, Code):
            raise run.make_unknown("a function is read as data")
        if pointer is UNDEFINED:
            raise run.make_unknown("an address that nobody wrote is used")
        raise run.make_unknown("an address that is calculated from inputs")
    if pointer.object == 0:
        raise run.make_crash(CrashKind.NULL, "")
    memory_object = state.objects.get(pointer.object)
    if memory_object is None:
        if pointer.object not in run.made_globals:
            raise run.make_unknown("an address outside of every object")
        memory_object = state.objects[pointer.object] = run.made_globals[pointer.object][1]
    if not memory_object.is_live:
        raise run.make_crash(CrashKind.DANGLING, memory_object.name)
    offset, limit = pointer.offset, memory_object.limit
    if limit is not None:
        inside = z3.And(z3.UGE(limit, size), z3.ULE(make_bits(offset, 64), limit - size))
        if isinstance(offset, int) and read_signed(offset, 64) < 0:
            inside = 0
        run.require(state, join_truths(reduce_term(inside), reduce_term(limit != 0)), CrashKind.INDEX, "",
                    also=(reduce_term(limit == 0), CrashKind.NULL))  # fmt: skip
    elif isinstance(offset, int):
        if read_signed(offset, 64) < 0 or offset + size > memory_object.size:
            raise run.make_crash(CrashKind.INDEX, f"byte {read_signed(offset, 64)} of {memory_object.size}")
    else:
        room = memory_object.size - size
        span = run.ranges.find_span(offset)
        if span.low >= 0 and span.high <= room:
            return pointer
        run.require(state, reduce_term(z3.ULE(offset, room)) if room >= 0 else 0, CrashKind.INDEX, "")
    return pointer


def list_offsets(run: Machine, state: State, pointer: Pointer, size: int, alignment: int) -> list[int]:
    """The offsets that a pointer can have, as far as they are told apart cheaply."""
    memory_object = state.objects[pointer.object]
    step = max(1, min(16, max(alignment, 1 << min(4, count_trailing_zeros(pointer.offset)))))
    span = run.ranges.find_span(pointer.offset)
    first, last = 0, memory_object.size - size
    if span.low >= 0:
        first, last = -(-span.low // step) * step, min(last, span.high)
    found = range(first, last + 1, step)
    has_addresses = any(isinstance(value, Pointer | Code) for _, value in memory_object.cells.values())
    if len(found) <= _MOST_OFFSETS and not has_addresses:
        return list(found)
    values = run.list_values(state, pointer.offset, 64, _FEW_OFFSETS)
    if values is None:
        raise run.make_unknown(f"an index into {memory_object.size} bytes is any of many")
    return sorted(values)


def read_scalar(run: Machine, state: State, memory_object: MemoryObject, offset: int, type_: IrType) -> Any:
    raw = read_raw(memory_object, offset, type_.size, run.addresses, run.make_any_byte)
    if raw is UNDEFINED and memory_object.kind == "outside":
        return run.make_outside(state, memory_object, type_)
    try:
        return interpret_raw(raw, type_, run.addresses)
    except ValueError as problem:
        raise run.make_unknown(str(problem)) from None


def load(run: Machine, state: State, pointer: Any, type_: IrType, alignment: int = 1) -> Any:
    """A value of any type from memory."""
    if type_.is_aggregate:
        parts = []
        for index in range(len(type_.list_parts())):  # pyright: ignore[reportAttributeAccessIssue]
            offset, part = type_.locate(index)  # pyright: ignore[reportAttributeAccessIssue]
            if not isinstance(pointer, Pointer):
                require_access(run, state, pointer, part.size)
            parts.append(load(run, state, Pointer(pointer.object, add_offsets(pointer.offset, offset)), part))
        return parts
    pointer = require_access(run, state, pointer, type_.size)
    memory_object = state.objects[pointer.object]
    if isinstance(pointer.offset, int):
        value = read_scalar(run, state, memory_object, pointer.offset, type_)
        if value is UNDEFINED and type_.is_pointer and state.has_begun and state.has_forgotten:
            value = run.make_any_address(state)
            write_scalar(run, state, pointer.object, pointer.offset, type_.size, value)
        return value
    offsets = list_offsets(run, state, pointer, type_.size, alignment)
    values = [read_scalar(run, state, memory_object, offset, type_) for offset in offsets]
    found = [(offset, value) for offset, value in zip(offsets, values, strict=True) if value is not UNDEFINED]
    if not found:
        return UNDEFINED
    if any(isinstance(value, Pointer | Code) for _, value in found):
        if all(value == found[0][1] for _, value in found if isinstance(value, Pointer | Code)) and len(
            [value for _, value in found if isinstance(value, Pointer | Code)]
        ) == len(found):
            return found[0][1]
        offset = run.choose(state, pointer.offset, offsets)
        return read_scalar(run, state, memory_object, offset, type_)
    return _join_choices(pointer.offset, found, type_)


def _join_choices(offset: Any, found: list[tuple[int, Any]], type_: IrType) -> Any:
    """A chain of choices; runs of the same value are one, and the most frequent is what is left over."""
    counts: dict[Any, int] = {}
    for _, value in found:
        key = value if isinstance(value, int | float) else value.get_id()
        counts[key] = counts.get(key, 0) + 1
    most = max(counts, key=counts.__getitem__)
    result: Any = None
    for _, value in found:
        if (value if isinstance(value, int | float) else value.get_id()) == most or len(counts) == 1:
            result = value
            break
    if result is None:
        result = found[-1][1]
    base = result
    for place, value in found:
        same = value is base or (isinstance(value, int) and isinstance(base, int) and value == base)
        if not same:
            result = join_terms(offset == place, value, result, type_.bits, type_.is_float)
    # Once for all of them: a table has hundreds.
    return reduce_term(result) if is_term(result) else result


def store(run: Machine, state: State, pointer: Any, type_: IrType, value: Any, alignment: int = 1):
    """Writes a value of any type."""
    if type_.is_aggregate:
        for index, part in enumerate(run.list_parts(value, type_)):
            offset, part_type = type_.locate(index)  # pyright: ignore[reportAttributeAccessIssue]
            if not isinstance(pointer, Pointer):
                require_access(run, state, pointer, part_type.size)
            store(run, state, Pointer(pointer.object, add_offsets(pointer.offset, offset)), part_type, part)
        return
    pointer = require_access(run, state, pointer, type_.size)
    if z3.is_bool(value):
        value = reduce_term(make_bits(value, 8))
    if isinstance(pointer.offset, int):
        write_scalar(run, state, pointer.object, pointer.offset, type_.size, value)
        return
    offsets = list_offsets(run, state, pointer, type_.size, alignment)
    old = [read_scalar(run, state, state.objects[pointer.object], offset, type_) for offset in offsets]
    if isinstance(value, Pointer | Code) or any(isinstance(each, Pointer | Code) for each in old):
        write_scalar(run, state, pointer.object, run.choose(state, pointer.offset, offsets), type_.size, value)
        return
    memory_object = state.take_object(pointer.object)
    for offset, before in zip(offsets, old, strict=True):
        if before is UNDEFINED or value is UNDEFINED:
            changed = value
        else:
            bits = type_.bits if type_.bits != 1 else 8
            changed = choose_term(pointer.offset == offset, value, before, bits, type_.is_float)
        memory_object.write(offset, type_.size, changed)


def write_scalar(run: Machine, state: State, number: int, offset: int, size: int, value: Any):
    """Writes at a place that was checked."""
    memory_object = state.take_object(number)
    if value is UNDEFINED and not memory_object.is_zeroed:
        memory_object.clear(offset, size)
    else:
        memory_object.write(offset, size, value)


def copy_memory(run: Machine, state: State, target: Any, source: Any, size: Any):
    """memcpy and memmove."""
    if isinstance(size, int):
        if size == 0:
            return
        source = require_access(run, state, source, size)
        target = require_access(run, state, target, size)
        if not isinstance(source.offset, int):
            source = fix_pointer(run, state, source)
        if not isinstance(target.offset, int):
            target = fix_pointer(run, state, target)
        _copy_cells(state, target, source, size)
        return
    source_object = _find_live(run, state, source)
    target_object = _find_live(run, state, target)
    if source_object is None or target_object is None:
        # One of them is null: nothing may be copied.
        run.require(state, compare_integers("eq", size, 0, 64), CrashKind.NULL, "")
        return
    require_range(run, state, source, source_object, size)
    require_range(run, state, target, target_object, size)
    if not isinstance(source.offset, int):
        source = fix_pointer(run, state, source)
    if not isinstance(target.offset, int):
        target = fix_pointer(run, state, target)
    most = min(source_object.size - source.offset, target_object.size - target.offset)
    most = min(most, run.find_most(state, size, most))
    step = 1 << min(4, count_trailing_zeros(size))
    source_cells = _cut_cells(run, source_object, source.offset, most, step)
    target_object = state.take_object(target.object)
    changes = []
    for start, width, value in source_cells:
        place = target.offset + start - source.offset
        before = read_raw(target_object, place, width, run.addresses, run.make_any_byte)
        if before is UNDEFINED:
            changes.append((place, width, value))
            continue
        condition = reduce_term(z3.UGT(size, start - source.offset))
        if isinstance(condition, int):
            if condition:
                changes.append((place, width, value))
            continue
        if isinstance(value, Pointer | Code | tuple) or isinstance(before, Pointer | Code | tuple):
            if value != before and run.decide(state, condition):
                changes.append((place, width, value))
            continue
        if value is UNDEFINED:
            continue
        is_float = (isinstance(value, float) or z3.is_fp(value)) and (isinstance(before, float) or z3.is_fp(before))
        if not is_float:
            value, before = (
                make_float_bits(each, 8 * width) if isinstance(each, float) or z3.is_fp(each) else each
                for each in (value, before)
            )
        changes.append((place, width, choose_term(condition, value, before, 8 * width, is_float)))
    for place, width, value in changes:
        state.take_object(target.object).write(place, width, value)


def _find_live(run: Machine, state: State, pointer: Any) -> MemoryObject | None:
    if not isinstance(pointer, Pointer):
        raise run.make_unknown("an address that is calculated from inputs")
    if pointer.object == 0:
        return None
    require_access(run, state, Pointer(pointer.object, 0), 0)
    return state.objects[pointer.object]


def require_range(run: Machine, state: State, pointer: Pointer, memory_object: MemoryObject, size: Any):
    """A symbolic number of bytes from a pointer on."""
    limit = make_bits(memory_object.size if memory_object.limit is None else memory_object.limit, 64)
    offset = make_bits(pointer.offset, 64)
    inside = z3.Or(size == 0, z3.And(z3.ULE(offset, limit), z3.ULE(make_bits(size, 64), limit - offset)))
    run.require(state, reduce_term(inside), CrashKind.INDEX, "")


def fix_pointer(run: Machine, state: State, pointer: Pointer) -> Pointer:
    """The pointer with an offset that is a number; forks."""
    if isinstance(pointer.offset, int):
        return pointer
    values = run.list_values(state, pointer.offset, 64, _FEW_OFFSETS)
    if values is None:
        raise run.make_unknown("a block begins at any of many places")
    return Pointer(pointer.object, run.choose(state, pointer.offset, sorted(values)))


def _cut_cells(
    run: Machine, memory_object: MemoryObject, offset: int, size: int, step: int
) -> list[tuple[int, int, Any]]:
    """Cells of a range, none of them over a border of step bytes."""
    cells = []
    for start, width, value in memory_object.list_cells(offset, size):
        if width > step or (start - offset) % step + width > step:
            cells.extend(
                (place, 1, read_raw(memory_object, place, 1, run.addresses, run.make_any_byte))
                for place in range(start, start + width)
            )
        else:
            cells.append((start, width, value))
    if memory_object.is_zeroed:
        covered = {place for start, width, _ in cells for place in range(start, start + width)}
        cells.extend((place, 1, 0) for place in range(offset, offset + size) if place not in covered)
        cells.sort(key=lambda cell: cell[0])
    return cells


def _copy_cells(state: State, target: Pointer, source: Pointer, size: int):
    source_object = state.objects[source.object]
    cells = source_object.list_cells(source.offset, size)
    is_zeroed = source_object.is_zeroed
    target_object = state.take_object(target.object)
    target_object.clear(target.offset, size)
    shift = target.offset - source.offset
    if is_zeroed != target_object.is_zeroed:
        if size == target_object.size:
            target_object.is_zeroed = is_zeroed
        elif is_zeroed:
            fill_cells(target_object, target.offset, size, 0)
        else:
            fill_cells(target_object, target.offset, size, UNDEFINED)
    for start, width, value in cells:
        target_object.write(start + shift, width, value)


def fill_cells(memory_object: MemoryObject, offset: int, size: int, value: Any):
    """size bytes of one value; zeros and nothing by eights."""
    place, end = offset, offset + size
    memory_object.clear(offset, size)
    while place < end:
        width = 8 if (value is UNDEFINED or (isinstance(value, int) and value == 0)) and end - place >= 8 else 1
        memory_object.cells[place] = (width, value)
        place += width


def fill_memory(run: Machine, state: State, target: Any, value: Any, size: Any):
    """memset."""
    if isinstance(size, int):
        if size == 0:
            return
        target = fix_pointer(run, state, require_access(run, state, target, size))
        memory_object = state.take_object(target.object)
        if isinstance(value, int) and value == 0 and target.offset == 0 and size == memory_object.size:
            memory_object.cells.clear()
            memory_object.is_zeroed = True
            return
        fill_cells(memory_object, target.offset, size, value)
        return
    memory_object = _find_live(run, state, target)
    if memory_object is None:
        run.require(state, compare_integers("eq", size, 0, 64), CrashKind.NULL, "")
        return
    require_range(run, state, target, memory_object, size)
    target = fix_pointer(run, state, target)
    memory_object = state.take_object(target.object)
    most = run.find_most(state, size, memory_object.size - target.offset)
    step = 1 << min(3, count_trailing_zeros(size))
    is_zero = isinstance(value, int) and value == 0
    width = step if is_zero else 1
    for start in range(0, most - width + 1, width):
        place = target.offset + start
        before = read_raw(memory_object, place, width, run.addresses, run.make_any_byte)
        if before is UNDEFINED or (isinstance(before, int) and isinstance(value, int) and before == value):
            memory_object.write(place, width, value)
            continue
        if isinstance(before, Pointer | Code | tuple):
            raise run.make_unknown("an address is overwritten by bytes")
        if isinstance(before, float) or z3.is_fp(before):
            before = make_float_bits(before, 8 * width)
        memory_object.write(
            place, width, choose_term(reduce_term(z3.UGT(size, start)), value, before, 8 * width, False)
        )


def read_byte(run: Machine, state: State, memory_object: MemoryObject, offset: int) -> Any:
    """A byte as a number or a term; what nobody wrote is any."""
    value = read_scalar(run, state, memory_object, offset, _BYTE)
    return run.make_any_byte(8) if value is UNDEFINED else value


def read_bytes_from(run: Machine, state: State, pointer: Any, count: int | None = None) -> list[Any]:
    """Bytes from a pointer to the end of its object, or as many as asked for. Past a symbolic limit they are read too:
    the caller has checked what may be used."""
    pointer = require_access(run, state, pointer, 1)
    memory_object = state.objects[pointer.object]
    if isinstance(pointer.offset, int):
        end = memory_object.size if count is None else min(memory_object.size, pointer.offset + count)
        return [read_byte(run, state, memory_object, place) for place in range(pointer.offset, end)]
    if memory_object.size > 256:
        pointer = fix_pointer(run, state, pointer)
        return read_bytes_from(run, state, pointer, count)
    everything = [read_byte(run, state, memory_object, place) for place in range(memory_object.size)]
    length = memory_object.size if count is None else min(count, memory_object.size)
    found = []
    for index in range(length):
        value: Any = 0
        for place in reversed(range(index, len(everything))):
            value = choose_term(reduce_term(pointer.offset == place - index), everything[place], value, 8, False)
        found.append(value)
    return found


def read_text(run: Machine, state: State, pointer: Any) -> str:
    """A C string whose bytes are numbers."""
    pointer = require_access(run, state, pointer, 1)
    if not isinstance(pointer.offset, int):
        raise run.make_unknown("a text begins at any of many places")
    memory_object = state.objects[pointer.object]
    found = bytearray()
    for place in range(pointer.offset, memory_object.size):
        value = read_byte(run, state, memory_object, place)
        if not isinstance(value, int):
            raise run.make_unknown("a text that inputs make")
        if value == 0:
            return found.decode("utf-8", "replace")
        found.append(value)
    raise run.make_unknown("a text without an end")
