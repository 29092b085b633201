"""Exceptions: who catches what. Landing pads are matched by typeinfo, with base classes, as the C++ ABI does."""

from __future__ import annotations

import re
from typing import Any

from ..outcomes import CodeLine, CrashKind
from .access import load, read_text
from .layout import POINTER, get_integer_type
from .machine import Machine
from .module import NULL, UNDEFINED, Code, Instruction, Pointer
from .state import Raised, State
from .terms import add_offsets, read_signed

_CATCHES_ALL = 0x7FFF_FFFF
# Bases of the exceptions of the standard library, whose typeinfo lies in libstdc++. By their mangled names.
_STANDARD_BASES = {
    "St11logic_error": "St9exception",
    "St13runtime_error": "St9exception",
    "St9bad_alloc": "St9exception",
    "St8bad_cast": "St9exception",
    "St10bad_typeid": "St9exception",
    "St13bad_exception": "St9exception",
    "St17bad_function_call": "St9exception",
    "St12bad_weak_ptr": "St9exception",
    "St19bad_optional_access": "St9exception",
    "St18bad_variant_access": "St9exception",
    "St20bad_array_new_length": "St9bad_alloc",
    "St12bad_any_cast": "St8bad_cast",
    "St16invalid_argument": "St11logic_error",
    "St12out_of_range": "St11logic_error",
    "St12length_error": "St11logic_error",
    "St12domain_error": "St11logic_error",
    "St12future_error": "St11logic_error",
    "St11range_error": "St13runtime_error",
    "St14overflow_error": "St13runtime_error",
    "St15underflow_error": "St13runtime_error",
    "St12system_error": "St13runtime_error",
    "St11regex_error": "St13runtime_error",
    "NSt8ios_base7failureB5cxx11E": "St12system_error",
    "NSt10filesystem7__cxx1116filesystem_errorE": "St12system_error",
}
WHAT = "rosimpact.exception.what"
DESTROY = "rosimpact.exception.destroy"
_BUILT_IN = {
    "i": "int", "j": "unsigned int", "l": "long", "m": "unsigned long", "c": "char", "b": "bool", "d": "double",
    "f": "float", "PKc": "const char*", "Pc": "char*", "s": "short", "x": "long long",
}  # fmt: skip


def is_standard_exception(mangled: str) -> bool:
    return mangled == "St9exception" or mangled in _STANDARD_BASES


def demangle_class(key: str) -> str:
    """The name of a class from its typeinfo's name; the mangled one where it is no plain class."""
    name = key.split("#", 1)[0].removeprefix("_ZTI")
    if name in _BUILT_IN:
        return _BUILT_IN[name]
    parts, position = [], 0
    if name.startswith("N"):
        name = name[1:].removesuffix("E")
    if name.startswith("St"):
        parts.append("std")
        position = 2
    while position < len(name):
        length = re.match(r"\d+", name[position:])
        if length is None:
            break
        start = position + len(length[0])
        parts.append(name[start : start + int(length[0])])
        position = start + int(length[0])
    parts = [each for each in parts if each != "__cxx11"]
    return "::".join(parts) or name


def get_info_key(run: Machine, value: Any) -> str:
    """The key of the typeinfo that an address is of."""
    if isinstance(value, Pointer) and value.object in run.made_globals:
        return run.made_globals[value.object][0]
    return ""


def find_upcast(run: Machine, state: State, info: str, target: str, address: Pointer) -> Pointer | None:
    """The part of an object of class info that is of class target; None where that is no base of it."""
    if info == target or info.split("#")[0] == target.split("#")[0]:
        return address
    for base, offset, is_virtual in _list_bases(run, state, info):
        if is_virtual:
            table = load(run, state, address, POINTER)
            if not isinstance(table, Pointer):
                continue
            place = load(run, state, Pointer(table.object, add_offsets(table.offset, offset)), get_integer_type(64))
            if not isinstance(place, int):
                continue
            offset = read_signed(place, 64)
        found = find_upcast(run, state, base, target, Pointer(address.object, add_offsets(address.offset, offset)))
        if found is not None:
            return found
    return None


def _list_bases(run: Machine, state: State, info: str) -> list[tuple[str, int, bool]]:
    """Base classes: key of the typeinfo, offset (or where in the table of virtual functions it stands), whether it is a
    virtual one."""
    pointer = run.find_global(state, info)
    if not isinstance(pointer, Pointer):
        return []
    cells = state.objects[pointer.object].cells
    kind = get_info_key(run, cells.get(0, (8, NULL))[1])
    if "__si_class_type_info" in kind:
        return [(get_info_key(run, cells[16][1]), 0, False)]
    if "__vmi_class_type_info" in kind:
        bases = []
        count = cells[20][1] if 20 in cells else 0
        for index in range(count):
            base = get_info_key(run, cells[24 + 16 * index][1])
            flags = read_signed(cells.get(32 + 16 * index, (8, 0))[1], 64)
            if flags & 2:
                bases.append((base, flags >> 8, bool(flags & 1)))
        return bases
    standard = _STANDARD_BASES.get(info.removeprefix("_ZTI"))
    return [("_ZTI" + standard, 0, False)] if standard else []


def _get_type_number(run: Machine, info: str) -> int:
    numbers = run.type_numbers
    return numbers.setdefault(info.split("#")[0], len(numbers) + 1)


def find_type_number(run: Machine, value: Any) -> int:
    """llvm.eh.typeid.for."""
    return _CATCHES_ALL if value == NULL else _get_type_number(run, get_info_key(run, value))


def select_handler(run: Machine, state: State, landing: Instruction, raised: Raised) -> tuple[Raised, int] | None:
    """What a landing pad does with an exception: the exception as it is caught, and the selector; 0 to clean up only.
    None where it is passed over."""
    kinds, is_cleanup = landing.extra
    for kind, operand in zip(kinds, landing.operands, strict=True):
        value = run.read(state, {}, operand, POINTER)
        if kind == "catch":
            if value == NULL:
                return raised, _CATCHES_ALL
            info = get_info_key(run, value)
            if raised.info.startswith("_ZTIP"):
                if raised.info == info or (raised.info == "_ZTIPc" and info == "_ZTIPKc"):
                    content = load(run, state, raised.address, POINTER)
                    return raised._replace(adjusted=content), _get_type_number(run, info)
                continue
            found = find_upcast(run, state, raised.info, info, raised.address)
            if found is not None:
                return raised._replace(adjusted=found), _get_type_number(run, info)
        else:
            allowed = value if isinstance(value, list) else []
            if not any(
                find_upcast(run, state, raised.info, get_info_key(run, each), raised.address) for each in allowed
            ):
                return raised, (1 << 32) - 1
    return (raised, 0) if is_cleanup else None


def find_handler(run: Machine, state: State, landing: Instruction, raised: Raised) -> tuple[Pointer, int]:
    """The pair that a landing pad gives."""
    found = select_handler(run, state, landing, raised)
    if found is None:
        return raised.address, 0
    state.values[f"raised {raised.address.object}"] = found[0]
    return raised.address, found[1]


def get_raised(run: Machine, state: State, address: Any) -> Raised:
    """The exception in flight whose object lies at an address."""
    found = state.values.get(f"raised {address.object}") if isinstance(address, Pointer) else None
    if found is None:
        raise run.make_unknown("an exception that is not known")
    return found


def unwind(run: Machine, state: State, raised: Raised):
    """Goes to the landing pad of the innermost frame that has one for an exception. Where nobody catches it, the
    program ends where it was thrown."""
    if not any(_is_caught(run, state, number, raised) for number in reversed(range(len(state.frames)))):
        end = run.make_crash(CrashKind.EXCEPTION, describe_exception(run, state, raised))
        end.place = raised.place
        raise end
    state.raised = raised
    state.values[f"raised {raised.address.object}"] = raised
    while state.frames:
        frame = state.get_frame()
        label = _get_unwind_label(frame)
        if label:
            landing = _get_landing(frame, label)
            if landing is not None and select_handler(run, state, landing, raised) is not None:
                run.enter_block(state, frame, label)
                return
        run.leave_frame(state)
    raise run.make_crash(CrashKind.EXCEPTION, describe_exception(run, state, raised))


def _get_unwind_label(frame: Any) -> str:
    if frame.index >= len(frame.block.instructions):
        return ""
    instruction = frame.get_instruction()
    return instruction.extra[1] if instruction.opcode == "call" else ""


def _get_landing(frame: Any, label: str) -> Instruction | None:
    block = frame.function.blocks[label]
    return next((each for each in block.instructions if each.opcode == "landingpad"), None)


def _is_caught(run: Machine, state: State, number: int, raised: Raised) -> bool:
    frame = state.frames[number]
    label = _get_unwind_label(frame)
    landing = _get_landing(frame, label) if label else None
    if landing is None:
        return False
    found = select_handler(run, state, landing, raised)
    return found is not None and found[1] != 0


def describe_exception(run: Machine, state: State, raised: Raised) -> str:
    """`std::out_of_range: stoi`, as far as it is known."""
    name = demangle_class(raised.info)
    info = raised.info
    known: set[str] = set()
    while info and info not in known:
        known.add(info)
        if is_standard_exception(info.removeprefix("_ZTI")) and info != "_ZTISt9exception":
            message = _read_message(run, state, raised.address)
            return f"{name}: {message}" if message else name
        bases = _list_bases(run, state, info)
        info = bases[0][0] if len(bases) == 1 and not bases[0][2] else ""
    return name


def _read_message(run: Machine, state: State, address: Pointer) -> str:
    memory_object = state.objects.get(address.object)
    if memory_object is None or not isinstance(address.offset, int):
        return ""
    cell = memory_object.cells.get(address.offset + 8)
    if cell is None or not isinstance(cell[1], Pointer):
        return ""
    try:
        return read_text(run, state, cell[1])[:80]
    except Exception:
        # The text is made of inputs, or is not there: the class says enough.
        return ""


def make_standard_exception(run: Machine, state: State, mangled: str, message: Any, place: CodeLine) -> Raised:
    """An exception of the standard library as libstdc++ throws it. message: address of a C string, or None."""
    address = run.add_object(state, 64, "heap", "an exception", is_zeroed=True)
    fill_standard_exception(run, state, address, mangled, message)
    return Raised(address, find_standard_info(run, state, mangled), place, address)


def find_standard_info(run: Machine, state: State, mangled: str) -> str:
    """Key of a typeinfo; it is made where no module names it."""
    key = "_ZTI" + mangled
    run.find_global(state, key)
    return key


def fill_standard_exception(run: Machine, state: State, address: Pointer, mangled: str, message: Any):
    """Table of virtual functions and message of an exception, as its constructor sets them."""
    table = run.find_global(state, "_ZTV" + mangled)
    memory_object = state.take_object(address.object)
    offset = address.offset
    if isinstance(table, Pointer):
        memory_object.write(offset, 8, Pointer(table.object, 16))
    if message is not None and message is not UNDEFINED and mangled != "St9exception":
        memory_object.write(offset + 8, 8, message)


def fill_standard_table(run: Machine, state: State, key: str, memory_object: Any):
    """The table of virtual functions of an exception of the standard library, which no module has."""
    info = run.find_global(state, "_ZTI" + key.removeprefix("_ZTV"))
    for place, value in ((0, 0), (8, info), (16, Code(DESTROY)), (24, Code(DESTROY)), (32, Code(WHAT))):
        memory_object.cells[place] = (8, value)
