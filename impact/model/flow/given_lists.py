"""Lists and dictionaries that a launch gives by parameters: names below a prefix, mappings, and lists of mappings; and
lists that are the defaults of parameters."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Mapping
from typing import Any, Protocol

from ...facts.flow import FlowExpr
from .calls import Calls, FrameworkCall
from .code import Fn, Variable, get_tail
from .elements import DEFAULT, SETTING, ListElement, is_changed
from .reaching import FlowValue

_MOST = 200
# What gives the list that the value of a parameter is.
_GIVING = frozenset(
    ("value", "get_parameter_value", "string_array_value", "as_string_array", "get_value", "to_value_msg")
)


class SettingValues(Protocol):
    """What is known of expressions and of settings where a launch starts the code."""

    calls: Calls

    def list_filling(self, variable: Variable) -> list[FrameworkCall]:
        """The calls that fill a variable with the value of a parameter."""
        ...

    def evaluate(self, value: FlowExpr | None, fn: Fn, line: int = 0) -> list[FlowValue]:
        """What an expression may be worth."""
        ...

    def list_settings_below(self, prefix: str) -> dict[str, str]:
        """What the launch sets below a prefix, by the rest of the name."""
        ...

    def read_server(self, name: str, use: FrameworkCall) -> tuple[str | None, dict[str, str]]:
        """What the parameter server of ROS 1 has under a name: a value, or what is below it."""
        ...

    def note_open(self) -> bool:
        """Whether a launch gives anything."""
        ...

    def find_default(self, use: FrameworkCall) -> tuple[FlowExpr, Fn, int] | None:
        """The only default of the parameter that a use declares or reads, where no launch sets it, with where it
        stands."""
        ...

    def list_turns(self, value: FlowExpr, fn: Fn, line: int) -> list[ListElement] | None:
        """What a loop over a list goes through in its turns."""
        ...


class GivenLists:
    """The lists and dictionaries that what a launch sets makes of expressions. values: evaluates them."""

    def __init__(self, values: SettingValues):
        self._values, self._code, self._calls = values, values.calls.code, values.calls
        self._asked: set[tuple[Fn, FlowExpr]] = set()

    def find(self, value: FlowExpr, fn: Fn, line: int) -> list[ListElement] | None:
        """What an expression holds: a pair for each key of a dictionary. None where no launch gives it, and no default
        of a parameter."""
        if (fn, value) in self._asked:
            return None
        self._asked.add((fn, value))
        try:
            found = self._find(value, fn) if self._values.note_open() else None
            return [ListElement(one, fn, line) for one in found] if found else self._list_default(value, fn, line)
        finally:
            self._asked.discard((fn, value))

    def _list_default(self, value: FlowExpr, fn: Fn, line: int) -> list[ListElement] | None:
        """The elements of the list that is the default of the parameter whose value an expression is."""
        use = self._find_use(value, fn, line)
        given = self._values.find_default(use) if use is not None else None
        held = self._values.list_turns(*given) if given is not None else None
        return [one._replace(value=FlowExpr(DEFAULT, "", (one.value,))) for one in held] if held else None

    def _find_use(self, value: FlowExpr, fn: Fn, line: int) -> FrameworkCall | None:
        """The use that gives the value of a parameter, or fills the variable that an expression is."""
        if value.kind == "name" and value.receiver is None:
            # What is written otherwise, too, may be something else.
            variable = self._code.identify(value.text, fn)
            uses = self._values.list_filling(variable) if value.text.removeprefix("this.").isidentifier() else []
            values = (each.value for _, each in self._code.list_writes(variable))
            written = [one for one in values if one.kind != "make" or one.parts]
            return uses[0] if len(uses) == 1 and not written and not is_changed(value.text, fn) else None
        while value.receiver is not None and get_tail(value.text) in _GIVING:
            value = value.receiver
        if value.kind != "call" or value.receiver is not None:
            return None
        same = [one for one in fn.list_calls(value.text) if one.arguments == value.parts]
        call = min(same, key=lambda one: abs(one.line - line), default=None)
        use = self._calls.find_use(fn, call) if call is not None else None
        if use is None or use.row.does != "parameter":
            return None
        filled = use.row.variable and self._calls.find_argument(use, use.row.variable) is not None
        return None if filled else use

    def _find(self, value: FlowExpr, fn: Fn) -> list[FlowExpr] | None:
        head, _, last = value.text.rpartition(".")
        if value.kind == "name" and last in ("prefixes", "names"):
            call, caller = self._find_writing(head, fn)
            if call is not None and get_tail(call.text) == "list_parameters" and call.parts:
                return self._list_names(call.parts[0], caller, parents=last == "prefixes")
            return None
        if value.kind == "name":
            return self._find_filled(value.text, fn) if head in ("", "this") else None
        if value.kind == "call" and get_tail(value.text) == "get_parameters_by_prefix" and value.parts:
            return self._list_below(value.parts[0], fn)
        if value.kind == "call":
            call = next((one for one in fn.list_calls(value.text) if one.arguments == value.parts), None)
            use = self._calls.find_use(fn, call) if call is not None else None
            return self._read(use) if use is not None and not use.row.variable else None
        return None

    def _find_writing(self, path: str, fn: Fn) -> tuple[FlowExpr | None, Fn]:
        """The only call whose result a variable is."""
        written = self._code.list_writes(self._code.identify(path, fn))
        if len(written) == 1 and written[0][1].value.kind == "call" and written[0][1].operator == "=":
            return written[0][1].value, written[0][0]
        return None, fn

    def _find_filled(self, path: str, fn: Fn) -> list[FlowExpr] | None:
        """What a call reads into a variable: what is below a prefix in ROS 2, the value of a parameter in ROS 1."""
        target = FlowExpr("name", path)
        for call in fn.facts.calls:
            if get_tail(call.callee) == "get_parameters" and len(call.arguments) == 2 and call.arguments[1] == target:
                return self._list_below(call.arguments[0], fn)
        uses = self._values.list_filling(self._code.identify(path, fn))
        return self._read(uses[0]) if len(uses) == 1 else None

    def _find_text(self, value: FlowExpr, fn: Fn) -> str | None:
        found = self._values.evaluate(value, fn)
        return found[0].text if len(found) == 1 else None

    def _list_below(self, prefix: FlowExpr, fn: Fn) -> list[FlowExpr] | None:
        """A dictionary of the parameters below a prefix."""
        text = self._find_text(prefix, fn)
        given = self._values.list_settings_below(text) if text else {}
        return _make_pairs((key, FlowExpr(SETTING, value)) for key, value in given.items())

    def _list_names(self, prefixes: FlowExpr, fn: Fn, *, parents: bool) -> list[FlowExpr] | None:
        """The names of parameters below prefixes, or what stands before the last parts of these."""
        found: dict[str, None] = {}
        for part in prefixes.parts if prefixes.kind == "list" else (prefixes,):
            prefix = self._find_text(part, fn)
            if prefix is None:
                return None
            for name in self._values.list_settings_below(prefix):
                full = f"{prefix}.{name}"
                found[full.rpartition(".")[0] if parents else full] = None
        return [FlowExpr(SETTING, name) for name in found][:_MOST]

    def _read(self, use: FrameworkCall) -> list[FlowExpr] | None:
        """The list or dictionary that a parameter of ROS 1 is."""
        if use.row.does != "parameter" or use.row.framework not in ("roscpp", "rospy"):
            return None
        name = self._calls.find_argument(use, use.row.topic)
        text = self._find_text(name, use.fn) if name is not None else None
        if text is None:
            return None
        given, below = self._values.read_server(text, use)
        if below:
            return _make_expression(_make_nested(below)).parts[:_MOST]  # type: ignore[return-value]
        try:
            read = ast.literal_eval(given or "")
        except (ValueError, SyntaxError, MemoryError, RecursionError):
            return None
        # A list of texts is known otherwise.
        mappings = isinstance(read, list) and all(isinstance(one, (dict, list)) for one in read)
        return list(_make_expression(read).parts[:_MOST]) if mappings else None


def _make_pairs(rows: Iterable[tuple[str, FlowExpr]]) -> list[FlowExpr]:
    return [FlowExpr("list", "", (FlowExpr(SETTING, key), value)) for key, value in rows][:_MOST]


def _make_nested(below: Mapping[str, str]) -> dict[str, Any]:
    """Parameters by the parts of their names."""
    found: dict[str, Any] = {}
    for name, value in below.items():
        *heads, last = name.split("/")
        inner = found
        for head in heads:
            inner = inner.setdefault(head, {})
            if not isinstance(inner, dict):
                break
        else:
            inner[last] = value
    return found


def _make_expression(value: Any) -> FlowExpr:
    """A value of YAML as code would write it."""
    if isinstance(value, dict):
        return FlowExpr("list", "", tuple(_make_pairs((str(key), _make_expression(one)) for key, one in value.items())))
    if isinstance(value, list):
        return FlowExpr("list", "", tuple(map(_make_expression, value[:_MOST])))
    return FlowExpr(SETTING, str(value))
