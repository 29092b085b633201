"""Models of iostreams: what is written to the console is a log, what a string stream holds and gives is any text.

The constructors of libstdc++ lie in its library, while code that reads a stream's state and text is compiled into
callbacks. So a stream is laid out as there: with a table that tells where its ios part begins, a facet for characters
and a buffer of any text.
"""

from __future__ import annotations

import re
from typing import Any

import z3

from .access import fill_cells, require_access, store
from .executor import Call, Executor
from .harness_calls import add_log
from .layout import DOUBLE, FLOAT, IrType, get_integer_type
from .library_text import fill_any_text
from .memory import MemoryObject
from .models import model, model_pattern
from .module import UNDEFINED, Pointer
from .state import State
from .terms import add_offsets, reduce_term

_CONSOLES = ("_ZSt4cout", "_ZSt4cerr", "_ZSt4clog")
_WHAT = "the text of a stream"
_MOST = 8
_FILES = ("stdin", "stdout", "stderr")
# Where the buffer and the ios part of each class begin, and the size of it all.
_LAYOUTS = {
    "18basic_stringstream": (24, 128, 392),
    "19basic_ostringstream": (8, 112, 376),
    "19basic_istringstream": (16, 120, 384),
}
_STATE, _FILL, _FACET = 32, 224, 240
_WIDENED = 56
_STORED: dict[str, IrType] = {
    **dict.fromkeys("ijSs", get_integer_type(32)),
    **dict.fromkeys("lmxy", get_integer_type(64)),
    **dict.fromkeys("st", get_integer_type(16)),
    **dict.fromkeys("bach", get_integer_type(8)),
    "d": DOUBLE,
    "f": FLOAT,
}


@model_pattern(r"_ZNSt7__cxx11(?:18basic_string|19basic_ostring|19basic_istring)streamIcSt11char_traitsIcESaIcEEC1\w*")
def make_stream(call: Call) -> Any:
    run, state = call.run, call.state
    name = next(each for each in _LAYOUTS if each in call.name)
    buffer, ios, size = _LAYOUTS[name]
    place = require_access(run, state, call.arguments[0], size)
    memory_object = state.take_object(place.object)
    fill_cells(memory_object, place.offset, size, 0)
    _fill_ios(run, state, memory_object, place.offset, ios)
    if name == "18basic_stringstream":
        memory_object.write(place.offset + 16, 8, _make_table(run, state, ios - 16))
    text = run.add_object(state, _MOST + 1, "heap", _WHAT)
    for index in range(_MOST):
        state.objects[text.object].write(index, 1, run.make_any(state, _WHAT, 8))
    state.objects[text.object].write(_MOST, 1, 0)
    count = run.make_any(state, _WHAT, 8)
    run.assume(state, reduce_term(z3.ULE(count, _MOST)))
    memory_object = state.take_object(place.object)
    memory_object.write(place.offset + buffer + 32, 8, text)
    memory_object.write(place.offset + buffer + 40, 8, Pointer(text.object, reduce_term(z3.ZeroExt(56, count))))


def _fill_ios(run: Executor, state: State, memory_object: MemoryObject, start: int, ios: int):
    """The parts of a stream that compiled code reads. start: of the stream; ios: where its ios part is, from there."""
    memory_object.write(start, 8, _make_table(run, state, ios))
    memory_object.write(start + ios + _FILL, 1, 32)
    memory_object.write(start + ios + _FILL + 1, 1, 1)
    memory_object.write(start + ios + _FACET, 8, _make_facet(run, state))


def _make_table(run: Executor, state: State, ios: int) -> Pointer:
    """The address of a table of virtual functions before which stands where the ios part is."""
    table = run.find_variable(state, f"the table of a stream {ios}", 64)
    run.made_globals[table.object][1].cells[0] = (8, ios)
    return Pointer(table.object, 24)


def _make_facet(run: Executor, state: State) -> Pointer:
    """ctype<char>, which widens each character to itself."""
    facet = run.find_variable(state, "the facet of characters", 576)
    cells = run.made_globals[facet.object][1].cells
    cells[_WIDENED] = (1, 1)
    cells.update({_WIDENED + 1 + index: (1, index) for index in range(1, 256)})
    return facet


def fill_outside_stream(run: Executor, key: str, memory_object: MemoryObject):
    """What a variable of libstdc++ holds that code reads: the console, and tables of tables."""
    state = State()
    if key in _CONSOLES:
        memory_object.is_zeroed = True
        _fill_ios(run, state, memory_object, 0, 8)
    elif key in _FILES:
        memory_object.cells[0] = (8, run.find_variable(state, "a file of the console", 216))
    elif key.startswith("_ZTTNSt7__cxx11"):
        for name, (_, ios, _) in _LAYOUTS.items():
            if name in key:
                table = _make_table(run, state, ios)
                memory_object.cells.update({8 * index: (8, table) for index in range(12)})


@model("_ZSt16__throw_bad_castv")
def miss_facet(call: Call) -> Any:
    raise call.run.make_unknown("a facet of a locale")


def _is_console(call: Call, pointer: Any) -> bool:
    return isinstance(pointer, Pointer) and call.run.made_globals.get(pointer.object, ("", None))[0] in _CONSOLES


@model_pattern(
    r"_ZNSo(?:ls|9_M_insert|3put|5flush|5write)\w*|_ZSt(?:4endl|4ends|5flush|16__ostream_insert)I\w*"
    r"|_ZStls(?:ISt11char_traits|IcSt11char_traits)\w*"
)
def insert_into_stream(call: Call) -> Any:
    if not call.instruction.type.is_pointer or not isinstance(call.arguments[0], Pointer):
        raise call.run.make_unknown(f"a call of `{call.name}`")
    if _is_console(call, call.arguments[0]):
        add_log(call.state, "stdout")
    return call.arguments[0]


@model_pattern(r"_ZNSirsER\w|_ZNSi10_M_extractI\wEERSiRT_")
def extract_number(call: Call) -> Any:
    run, state = call.run, call.state
    found = re.match(r"_ZNSi(?:rsER|10_M_extractI)(\w)", call.name)
    type_ = _STORED.get(found[1]) if found is not None else None
    if type_ is None:
        raise run.make_unknown(f"a call of `{call.name}`")
    store(run, state, call.arguments[1], type_, run.make_any_scalar(state, "what is read from a stream", type_))
    return _forget_state(call)


@model_pattern(r"_ZStrsIcSt11char_traitsIcESaIcEE\w+|_ZSt7getlineIcSt11char_traitsIcESaIcEE\w+")
def extract_text(call: Call) -> Any:
    fill_any_text(call, call.arguments[1], "what is read from a stream")
    return _forget_state(call)


def _forget_state(call: Call) -> Any:
    """After reading, a stream may be good or not."""
    state, stream = call.state, call.arguments[0]
    table = state.objects[stream.object].cells.get(stream.offset, (8, None))[1]
    if isinstance(table, Pointer) and table.object in state.objects:
        ios = state.objects[table.object].cells.get(0, (8, None))[1]
        if isinstance(ios, int):
            place = add_offsets(stream.offset, ios + _STATE)
            state.take_object(stream.object).write(place, 4, UNDEFINED)
            return stream
    raise call.run.make_unknown("what is read from a stream")


@model_pattern(
    r"_ZNSt7__cxx11\d+basic_(?:string|ostring|istring)streamIcSt11char_traitsIcESaIcEED[12]\w*"
    r"|_ZNSt8ios_base(?:C2|D2)Ev|_ZNSt6locale(?:C1|D1)Ev|_ZNSt9basic_iosIcSt11char_traitsIcEE(?:4initE|5clearE)\w+"
    r"|_ZNSt7__cxx1115basic_stringbufIcSt11char_traitsIcESaIcEE(?:7_M_sync|17_M_stringbuf_init|3strE)\w+"
)
def skip_stream(call: Call) -> Any:
    return None


@model(
    "_ZNKSt7__cxx1118basic_stringstreamIcSt11char_traitsIcESaIcEE3strEv",
    "_ZNKSt7__cxx1119basic_ostringstreamIcSt11char_traitsIcESaIcEE3strEv",
    "_ZNKSt7__cxx1115basic_stringbufIcSt11char_traitsIcESaIcEE3strEv",
)
def read_stream(call: Call) -> Any:
    fill_any_text(call, call.arguments[0], _WHAT)
