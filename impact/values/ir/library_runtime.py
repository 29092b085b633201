"""Models of the C++ runtime: blocks of the heap, exceptions, checks of the sanitizers, threads, time."""

from __future__ import annotations

import re
from typing import Any

import z3

from ..outcomes import NOWHERE, CodeLine, CrashKind, InputKind
from .access import copy_memory, fill_memory, load, read_text, store
from .exceptions import (
    DESTROY,
    WHAT,
    demangle_class,
    describe_exception,
    fill_standard_exception,
    find_type_number,
    find_upcast,
    get_info_key,
    get_raised,
    is_standard_exception,
    make_standard_exception,
)
from .executor import Call, Ended, ThrownError
from .layout import POINTER, get_integer_type
from .models import model, model_pattern
from .module import NULL, UNDEFINED, Pointer
from .state import Raised
from .terms import (
    add_offsets,
    compare_integers,
    compute_integer,
    make_bits,
    reduce_term,
)

_LARGEST_BLOCK = 65536
_I8, _I32, _I64 = (get_integer_type(bits) for bits in (8, 32, 64))


def allocate(call: Call, size: Any, name: str, is_zeroed: bool = False) -> Pointer:
    """A block of the heap; of a symbolic size it has room for the largest."""
    run, state = call.run, call.state
    if size is UNDEFINED:
        raise run.make_unknown("a block whose size nobody wrote")
    if isinstance(size, int):
        if size > 1 << 30:
            raise run.make_unknown(f"a block of {size} bytes")
        return run.add_object(state, size, "heap", name, is_zeroed)
    most = 0
    for bound in (256, 4096, _LARGEST_BLOCK):
        most = run.find_most(state, size, bound)
        if most < bound:
            break
    if most >= _LARGEST_BLOCK and not run.decide(state, reduce_term(z3.ULE(size, _LARGEST_BLOCK))):
        raise run.make_unknown(f"a block of more than {_LARGEST_BLOCK} bytes")
    pointer = run.add_object(state, most, "heap", name, is_zeroed)
    state.objects[pointer.object].limit = size
    return pointer


@model("_Znwm", "_Znam", "_ZnwmRKSt9nothrow_t", "_ZnamRKSt9nothrow_t", "_ZnwmSt11align_val_t", "_ZnamSt11align_val_t")
def allocate_new(call: Call) -> Any:
    return allocate(call, call.arguments[0], "a block of the heap")


@model("malloc")
def allocate_plain(call: Call) -> Any:
    return allocate(call, call.arguments[0], "a block of the heap")


@model("aligned_alloc")
def allocate_aligned(call: Call) -> Any:
    return allocate(call, call.arguments[1], "a block of the heap")


@model("calloc")
def allocate_zeroed(call: Call) -> Any:
    size = compute_integer("mul", call.arguments[0], call.arguments[1], 64)
    return allocate(call, size, "a block of the heap", is_zeroed=True)


@model("realloc")
def allocate_again(call: Call) -> Any:
    run, state = call.run, call.state
    old, size = call.arguments
    new = allocate(call, size, "a block of the heap")
    if isinstance(old, Pointer) and old.object:
        before = state.objects[old.object]
        if not isinstance(size, int) or before.limit is not None:
            raise run.make_unknown("realloc of a size that an input gives")
        copy_memory(run, state, new, old, min(size, before.size))
        run.free_object(state, old.object)
    return new


@model(
    "_ZdlPv",
    "_ZdaPv",
    "_ZdlPvm",
    "_ZdaPvm",
    "_ZdlPvSt11align_val_t",
    "_ZdlPvmSt11align_val_t",
    "_ZdaPvSt11align_val_t",
    "free",
)
def free_block(call: Call) -> Any:
    run, state = call.run, call.state
    pointer = call.arguments[0]
    if pointer is UNDEFINED:
        raise run.make_unknown("an address that nobody wrote is freed")
    if not isinstance(pointer, Pointer) or pointer.object not in state.objects:
        if pointer == NULL:
            return
        raise run.make_unknown("what is freed is not known")
    memory_object = state.objects[pointer.object]
    if not memory_object.is_live:
        raise run.make_crash(CrashKind.DANGLING, "freed twice")
    if memory_object.kind != "heap" or pointer.offset != 0:
        raise run.make_crash(CrashKind.ABORT, "what is freed is no block of the heap")
    run.free_object(state, pointer.object)


# Copies.


@model("llvm.memcpy.*", "llvm.memmove.*", "memcpy", "memmove", "__memcpy_chk", "__memmove_chk")
def copy_bytes(call: Call) -> Any:
    copy_memory(call.run, call.state, *call.arguments[:3])
    return call.arguments[0]


@model("llvm.memset.*", "memset", "__memset_chk")
def fill_bytes(call: Call) -> Any:
    target, value, size = call.arguments[:3]
    if value is not UNDEFINED:
        value = compute_integer("and", value, 255, 32) if not isinstance(value, int) and value.size() == 32 else value
        value = value & 255 if isinstance(value, int) else z3.Extract(7, 0, value) if value.size() > 8 else value
    fill_memory(call.run, call.state, target, value, size)
    return target


# Exceptions.


@model("__cxa_allocate_exception")
def allocate_exception(call: Call) -> Any:
    return call.run.add_object(call.state, call.arguments[0], "heap", "an exception", is_zeroed=True)


@model("__cxa_free_exception", "__cxa_end_catch_cleanup", "_ZNSt9exceptionD2Ev", "_ZNSt9exceptionD1Ev", DESTROY)
def do_nothing(call: Call) -> Any:
    return None


@model("__cxa_throw")
def throw_exception(call: Call) -> Any:
    address, info = call.arguments[0], get_info_key(call.run, call.arguments[1])
    raise ThrownError(Raised(address, info, call.run.find_place(call.state), address))


@model("__cxa_rethrow")
def throw_again(call: Call) -> Any:
    if not call.state.caught:
        raise call.run.make_crash(CrashKind.EXCEPTION, "rethrown without an exception")
    raise ThrownError(call.state.caught[-1]._replace(place=call.run.find_place(call.state)))


@model("__cxa_begin_catch")
def begin_catch(call: Call) -> Any:
    raised = get_raised(call.run, call.state, call.arguments[0])
    call.state.caught = (*call.state.caught, raised)
    return raised.adjusted


@model("__cxa_get_exception_ptr")
def get_exception(call: Call) -> Any:
    return get_raised(call.run, call.state, call.arguments[0]).adjusted


@model("__cxa_end_catch")
def end_catch(call: Call) -> Any:
    call.state.caught = call.state.caught[:-1]


@model("llvm.eh.typeid.for", "llvm.eh.typeid.for.p0")
def get_type_number(call: Call) -> Any:
    return find_type_number(call.run, call.arguments[0])


@model("_ZSt9terminatev", "__cxa_call_unexpected", "__clang_call_terminate", "_ZSt10unexpectedv")
def end_by_terminate(call: Call) -> Any:
    run, state = call.run, call.state
    raised = state.caught[-1] if state.caught else state.raised
    if call.name == "__clang_call_terminate" or (raised is None and call.arguments):
        raised = get_raised(run, state, call.arguments[0])
    if raised is None:
        raise run.make_crash(CrashKind.ABORT, "std::terminate")
    end = run.make_crash(CrashKind.EXCEPTION, describe_exception(run, state, raised))
    end.place = raised.place
    raise end


@model("_ZSt18uncaught_exceptionv", "_ZSt19uncaught_exceptionsv")
def count_exceptions(call: Call) -> Any:
    return 0


@model_pattern(r"_ZSt\d+__throw_\w+")
def throw_standard(call: Call) -> Any:
    run, state = call.run, call.state
    found = re.match(r"_ZSt(\d+)__throw_", call.name)
    assert found is not None
    start = found.end(1)
    name = call.name[start : start + int(found[1])].removeprefix("__throw_").removesuffix("_fmt")
    message = call.arguments[0] if call.arguments and isinstance(call.arguments[0], Pointer) else None
    raise ThrownError(make_standard_exception(run, state, f"St{len(name)}{name}", message, run.find_place(state)))


@model("__cxa_bad_cast", "__cxa_bad_typeid", "__cxa_throw_bad_array_new_length")
def throw_bad_cast(call: Call) -> Any:
    name = {"__cxa_bad_cast": "St8bad_cast", "__cxa_bad_typeid": "St10bad_typeid"}.get(
        call.name, "St20bad_array_new_length"
    )
    raise ThrownError(make_standard_exception(call.run, call.state, name, None, call.run.find_place(call.state)))


_MEMBER = re.compile(r"_ZNK?((?:St|NSt)\d+\w+?)(C[12]E\w*|D[012]Ev|4whatEv|aSE\w+)")


def _split_member(name: str) -> tuple[str, str] | None:
    """Class and member of an exception of the standard library, from a mangled name."""
    found = re.match(r"_ZNK?St(\d+)", name)
    if found is None:
        return None
    end = found.end() + int(found[1])
    mangled = name[found.start(1) - 2 : end]
    return (mangled, name[end:]) if is_standard_exception(mangled) else None


@model_pattern(
    r"_ZNK?St\d+(?:\w+_error|exception|invalid_argument|out_of_range|bad_\w+?)(?:C[12]E\w*|D[012]Ev|4whatEv|aSE\w+)"
)
def call_member_of_exception(call: Call) -> Any:
    run, state = call.run, call.state
    found = _split_member(call.name)
    if found is None:
        raise run.make_unknown(f"a call of `{call.name}`")
    mangled, member = found
    address = call.arguments[0]
    if member == "4whatEv":
        return _read_what(call)
    if member.startswith("D"):
        return None
    message: Any = None
    if len(call.arguments) > 1:
        message = call.arguments[1]
        if "RKS_" in member or "OS_" in member:
            message = load(run, state, Pointer(message.object, add_offsets(message.offset, 8)), POINTER)
        elif "PKc" not in member:
            message = load(run, state, message, POINTER)
        if isinstance(message, Pointer) and message.object:
            message = _keep_text(call, message)
    fill_standard_exception(run, state, address, mangled, message)
    return None


def _keep_text(call: Call, message: Pointer) -> Pointer:
    """A copy of a C string: exceptions have their own."""
    try:
        text = read_text(call.run, call.state, message).encode()
    except Ended:
        return message
    copy = call.run.add_object(call.state, len(text) + 1, "heap", "the message of an exception", is_zeroed=True)
    for index, byte in enumerate(text):
        call.state.objects[copy.object].cells[index] = (1, byte)
    return copy


@model(WHAT, "_ZNKSt9exception4whatEv")
def read_what(call: Call) -> Any:
    return _read_what(call)


def _read_what(call: Call) -> Any:
    run, state = call.run, call.state
    address = call.arguments[0]
    memory_object = state.objects[address.object]
    cell = memory_object.cells.get(address.offset + 8) if isinstance(address.offset, int) else None
    if cell is not None and isinstance(cell[1], Pointer):
        return cell[1]
    table = memory_object.cells.get(address.offset, (8, NULL))[1]
    name = demangle_class(get_info_key(run, table).replace("_ZTV", "_ZTI")) or "std::exception"
    text = run.add_object(state, len(name) + 1, "heap", "the name of an exception", is_zeroed=True)
    for index, byte in enumerate(name.encode()):
        state.objects[text.object].cells[index] = (1, byte)
    return text


@model("__dynamic_cast")
def cast_dynamically(call: Call) -> Any:
    run, state = call.run, call.state
    address, target = call.arguments[0], get_info_key(run, call.arguments[2])
    if address == NULL:
        return NULL
    table = load(run, state, address, POINTER)
    if not isinstance(table, Pointer) or not isinstance(table.offset, int):
        raise run.make_unknown("dynamic_cast of what has no table of virtual functions")
    info = get_info_key(run, load(run, state, Pointer(table.object, table.offset - 8), POINTER))
    to_top = load(run, state, Pointer(table.object, table.offset - 16), _I64)
    if not isinstance(to_top, int):
        raise run.make_unknown("dynamic_cast")
    whole = Pointer(address.object, add_offsets(address.offset, to_top))
    return find_upcast(run, state, info, target, whole) or NULL


@model("__cxa_pure_virtual", "__cxa_deleted_virtual")
def end_by_pure_virtual(call: Call) -> Any:
    raise call.run.make_crash(CrashKind.ABORT, "pure virtual function called")


# Crashes that are checked.

_SANITIZED = {
    "add_overflow": CrashKind.OVERFLOW,
    "sub_overflow": CrashKind.OVERFLOW,
    "mul_overflow": CrashKind.OVERFLOW,
    "negate_overflow": CrashKind.OVERFLOW,
    "shift_out_of_bounds": CrashKind.SHIFT,
    "out_of_bounds": CrashKind.INDEX,
    "pointer_overflow": CrashKind.INDEX,
    "local_out_of_bounds": CrashKind.INDEX,
    "vla_bound_not_positive": CrashKind.INDEX,
    "float_cast_overflow": CrashKind.FLOAT_TO_INTEGER,
    "missing_return": CrashKind.UNREACHABLE,
    "builtin_unreachable": CrashKind.UNREACHABLE,
    "nonnull_arg": CrashKind.NULL,
    "nonnull_return": CrashKind.NULL,
    "nullability_arg": CrashKind.NULL,
    "invalid_builtin": CrashKind.SHIFT,
}
_TRAPS = {
    0: CrashKind.OVERFLOW, 1: CrashKind.UNREACHABLE, 3: CrashKind.DIVISION, 5: CrashKind.FLOAT_TO_INTEGER,
    11: CrashKind.UNREACHABLE, 12: CrashKind.OVERFLOW, 13: CrashKind.OVERFLOW, 14: CrashKind.NULL,
    18: CrashKind.INDEX, 19: CrashKind.INDEX, 20: CrashKind.SHIFT, 21: CrashKind.OVERFLOW, 22: CrashKind.NULL,
}  # fmt: skip


@model_pattern(r"__ubsan_handle_\w+")
def end_by_sanitizer(call: Call) -> Any:
    run, state = call.run, call.state
    name = re.sub(r"(_v1)?(_minimal)?(_abort)?$", "", call.name.removeprefix("__ubsan_handle_"))
    if name == "type_mismatch":
        address = call.arguments[1] if len(call.arguments) > 1 else 0
        if isinstance(address, Pointer):
            is_null: Any = int(address.object == 0)
        else:
            is_null = compare_integers("eq", address, 0, 64)
        if run.decide(state, is_null):
            raise run.make_crash(CrashKind.NULL, "")
        raise run.make_crash(CrashKind.ABORT, "misaligned address")
    if name == "divrem_overflow":
        divisor = call.arguments[2]
        if isinstance(divisor, Pointer) or run.decide(state, compare_integers("eq", divisor, 0, 64)):
            raise run.make_crash(CrashKind.DIVISION, "")
        raise run.make_crash(CrashKind.OVERFLOW, "the smallest number by -1")
    if name == "load_invalid_value":
        raise run.make_unknown("a bool or an enumeration that has none of its values")
    kind = _SANITIZED.get(name)
    if kind is None:
        raise run.make_unknown(f"check of the sanitizer: {name}")
    end = run.make_crash(kind, "")
    if name == "missing_return":
        end.place = _read_check_place(call)
    raise end


def _read_check_place(call: Call) -> CodeLine | None:
    """The place that a check of the sanitizer names itself (of a function that returns nothing, its head)."""
    run, state = call.run, call.state
    data = call.arguments[0]
    if not isinstance(data, Pointer):
        return None
    try:
        path = read_text(run, state, load(run, state, data, POINTER))
        line = load(run, state, Pointer(data.object, add_offsets(data.offset, 8)), _I32)
    except Ended:
        return None
    place = run.places.make_place(path, line) if isinstance(line, int) else NOWHERE
    return place if place.path else None


@model("llvm.ubsantrap")
def end_by_trap_of_sanitizer(call: Call) -> Any:
    kind = _TRAPS.get(call.arguments[0])
    if kind is None:
        raise call.run.make_unknown(f"check of the sanitizer: number {call.arguments[0]}")
    raise call.run.make_crash(kind, "")


@model("llvm.trap")
def end_by_trap(call: Call) -> Any:
    # Of clang's check that an access stays in a variable (local-bounds), blocks are called `trap`.
    is_bound = call.state.frames[-1].block.label.startswith("%trap")
    raise call.run.make_crash(CrashKind.INDEX if is_bound else CrashKind.ABORT, "")


@model("llvm.debugtrap", "abort", "_ZSt7__abortv", "quick_abort", "raise")
def end_by_abort(call: Call) -> Any:
    raise call.run.make_crash(CrashKind.ABORT, "")


@model("exit", "_exit", "quick_exit", "_Exit")
def end_by_exit(call: Call) -> Any:
    raise call.run.make_unknown("the callback ends the program")


@model("__assert_fail", "__assert_rtn", "__assert")
def end_by_assertion(call: Call) -> Any:
    raise call.run.make_crash(CrashKind.ASSERTION, _read_quietly(call, 0))


def _read_quietly(call: Call, number: int) -> str:
    try:
        return read_text(call.run, call.state, call.arguments[number])
    except (Ended, IndexError):
        return ""


@model("_ZSt21__glibcxx_assert_failPKciS0_S0_", "_ZSt20__replacement_assertPKciS0_S0_")
def end_by_library_assertion(call: Call) -> Any:
    condition = _read_quietly(call, 3)
    raise call.run.make_crash(classify_library_assertion(condition), condition)


def classify_library_assertion(condition: str) -> CrashKind:
    """What a failed assertion of libstdc++ says, from its condition."""
    if "empty()" in condition or "_M_is_engaged" in condition or "has_value" in condition:
        return CrashKind.EMPTY
    if "size()" in condition or "__n <" in condition or "__n <=" in condition:
        return CrashKind.INDEX
    if "nullptr" in condition or "pointer()" in condition or "_M_get()" in condition:
        return CrashKind.NULL
    return CrashKind.ASSERTION


# Variables that are initialized, threads, time.


@model("__cxa_guard_acquire")
def acquire_guard(call: Call) -> Any:
    value = load(call.run, call.state, call.arguments[0], _I8)
    return 1 if value is UNDEFINED or value == 0 else 0


@model("__cxa_guard_release")
def release_guard(call: Call) -> Any:
    store(call.run, call.state, call.arguments[0], _I8, 1)


_SKIPPED = (
    "__cxa_guard_abort", "_ZNSt8ios_base4InitC1Ev", "_ZNSt8ios_base4InitD1Ev", "llvm.stackrestore*",
    "llvm.prefetch*", "llvm.invariant.start*", "llvm.invariant.end*", "llvm.va_end*", "__ubsan_on_report",
    "llvm.donothing", "llvm.var.annotation*",
)  # fmt: skip


@model(*_SKIPPED)
def skip_call(call: Call) -> Any:
    return None


@model("llvm.invariant.start*")
def begin_constant(call: Call) -> Any:
    return NULL


@model("__cxa_atexit", "atexit", "__cxa_thread_atexit", "at_quick_exit")
def register_end(call: Call) -> Any:
    return 0


_SUCCEEDING = (
    "pthread_mutex_lock", "pthread_mutex_unlock", "pthread_mutex_trylock", "pthread_mutex_init",
    "pthread_mutex_destroy", "pthread_mutexattr_init", "pthread_mutexattr_settype", "pthread_mutexattr_destroy",
    "pthread_rwlock_rdlock", "pthread_rwlock_wrlock", "pthread_rwlock_unlock", "pthread_rwlock_init",
    "pthread_rwlock_destroy", "pthread_cond_signal", "pthread_cond_broadcast", "pthread_cond_init",
    "pthread_cond_destroy", "sched_yield", "usleep", "sleep", "nanosleep", "clock_nanosleep",
    "pthread_mutex_timedlock", "pthread_mutex_clocklock", "_ZNSt18condition_variable10notify_allEv",
    "_ZNSt18condition_variable10notify_oneEv", "_ZNSt18condition_variableC1Ev", "_ZNSt18condition_variableD1Ev",
    "fflush", "setvbuf", "sync", "srand", "_ZNSt15__exception_ptr13exception_ptr10_M_releaseEv",
    "_ZNSt15__exception_ptr13exception_ptr9_M_addrefEv",
)  # fmt: skip


@model(*_SUCCEEDING)
def succeed(call: Call) -> Any:
    return 0 if call.instruction.type.size else None


@model("pthread_self", "getpid", "gettid")
def get_own_number(call: Call) -> Any:
    return 1


@model("pthread_once")
def run_once(call: Call) -> Any:
    raise call.run.make_unknown("pthread_once")


@model("_ZNSt6thread15_M_start_thread*")
def start_thread(call: Call) -> Any:
    note = "a thread that is started does not run"
    if note not in call.state.assumed_notes:
        call.state.assumed_notes = (*call.state.assumed_notes, note)
    store(call.run, call.state, call.arguments[0], _I64, 1)


@model("_ZNSt6thread4joinEv", "_ZNSt6thread6detachEv")
def end_thread(call: Call) -> Any:
    store(call.run, call.state, call.arguments[0], _I64, 0)


@model("_ZNSt6thread20hardware_concurrencyEv")
def count_processors(call: Call) -> Any:
    return 2


def make_now(call: Call, name: str) -> Any:
    """What a clock says, in nanoseconds: an input, not negative."""
    run, state = call.run, call.state
    number = state.counts.get(name, 0)
    state.counts[name] = number + 1
    path = f"~{name}" if number == 0 else f"~{name}[{number}]"
    term = run.solving.make_input(path, InputKind.INTEGER, 64, True).term
    previous = state.values.get(name, 0)
    run.assume(state, reduce_term(z3.ULE(term, 1 << 61)))
    if "steady" in name or number:
        run.assume(state, reduce_term(z3.UGE(term, make_bits(previous, 64))))
    state.values[name] = term
    return term


@model("_ZNSt6chrono3_V212system_clock3nowEv", "_ZNSt6chrono3_V212steady_clock3nowEv")
def read_clock(call: Call) -> Any:
    return make_now(call, "now")


@model("time")
def read_seconds(call: Call) -> Any:
    value = compute_integer("udiv", make_now(call, "now"), 1_000_000_000, 64)
    if isinstance(call.arguments[0], Pointer) and call.arguments[0].object:
        store(call.run, call.state, call.arguments[0], _I64, value)
    return value


@model("clock_gettime", "gettimeofday")
def read_clock_into(call: Call) -> Any:
    run, state = call.run, call.state
    pointer = call.arguments[1 if call.name == "clock_gettime" else 0]
    now = make_now(call, "now")
    unit = 1 if call.name == "clock_gettime" else 1000
    rest = compute_integer("udiv", compute_integer("urem", now, 1_000_000_000, 64), unit, 64)
    store(run, state, pointer, _I64, compute_integer("udiv", now, 1_000_000_000, 64))
    store(run, state, Pointer(pointer.object, add_offsets(pointer.offset, 8)), _I64, rest)
    return 0


@model("rand", "random")
def draw_number(call: Call) -> Any:
    run, state = call.run, call.state
    term = run.make_any(state, "rand", call.instruction.type.bits)
    run.assume(state, reduce_term(z3.ULE(term, (1 << 31) - 1)))
    return term


@model("__errno_location")
def find_error_number(call: Call) -> Any:
    run, state = call.run, call.state
    return run.find_variable(state, "errno", 4)


@model("getenv", "secure_getenv")
def read_environment(call: Call) -> Any:
    note = "an environment variable that is not set"
    if note not in call.state.notes:
        call.state.assumed_notes = (*call.state.assumed_notes, note)
    return NULL
