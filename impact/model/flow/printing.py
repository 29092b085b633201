"""Functions of C++ that put a text together as printf does, of a format and the rest of what they are given."""

from __future__ import annotations

from ...facts.flow import FlowCall, FlowExpr
from .code import Fn, find_parameter, get_tail

# The place of the format in what a function prints with; those with `v` take a list of arguments.
_PRINTS = {"snprintf": 2, "sprintf": 1, "asprintf": 1, "vsnprintf": 2, "vsprintf": 1, "vasprintf": 1}
_GIVES_TEXT = frozenset((".c_str", ".data"))


def find_format_place(fn: Fn) -> int | None:
    """The place of the parameter by which a function formats all that it is given behind it, and gives the text; None
    for all other functions."""
    if fn.source.facts.language != "cpp" or "string" not in fn.facts.returns:
        return None
    printing = [call for call in fn.facts.calls if get_tail(call.callee) in _PRINTS]
    places = {_find_place(call, fn) for call in printing}
    returned = [each.value for each in fn.facts.assignments if each.operator == "return"]
    if len(places) != 1 or not returned or not all(_is_buffer(value) for value in returned):
        return None
    return places.pop()


def _find_place(call: FlowCall, fn: Fn) -> int | None:
    """The place of the parameter that is the format of a call, where the rest of what the function is given follows."""
    name = get_tail(call.callee)
    given = call.arguments[_PRINTS[name] :]
    if len(given) != 2:
        return None
    form, rest = given
    path = form.text[: -len(ending)] if (ending := _find_ending(form)) else form.text
    found = find_parameter(fn, path) if form.kind in ("name", "call") else None
    is_listed = name.startswith("v")
    is_pack = rest.kind == "other" and rest.text.endswith("...")
    if found is None or not (is_listed or is_pack):
        return None
    last = len(fn.facts.parameters) - 1 - (0 if is_listed else 1)
    return found[0] if found[0] == last else None


def _find_ending(value: FlowExpr) -> str:
    return next((ending for ending in _GIVES_TEXT if value.kind == "call" and value.text.endswith(ending)), "")


def _is_buffer(value: FlowExpr) -> bool:
    """Whether what is returned is a variable, as a string or a part of one."""
    inner = value.parts[0] if value.kind in ("call", "make") and value.parts else value
    return inner.kind == "name" or (inner.kind == "call" and inner.text.endswith((".get", ".data", ".begin")))
