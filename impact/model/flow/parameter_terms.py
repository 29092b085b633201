"""What values the parameters of a node take, as the code that declares them says: types, ranges, dynamic typing."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from ....edges.memory import cache_in_derived
from ...facts.flow import Assignment, FlowCall, FlowExpr
from ...facts.reconfigure import ReconfigurableParameter, ReconfigureFile
from ..parameter_library import LISTENER
from ..parameter_values import Limit, ParameterTerms, parse_cpp_type, parse_named_type
from ..workspace import Workspace
from .calls import FrameworkCall
from .code import Fn, get_tail, list_made
from .join import Join, Running
from .types import split_name

_RANGES = ("floating_point_range", "integer_range")
_BOUNDS = {"from_value": ">=", "to_value": "<=", "step": "step"}
_DYNAMIC = "dynamic_typing"
_RECONFIGURE = "dynamic_reconfigure"


def list_terms(
    join: Join, one: Running, libraries: Mapping[str, list[dict[str, ParameterTerms]]]
) -> dict[str, ParameterTerms]:  # fmt: skip
    """The parameters that a program declares by a known name, each as all its declarations agree on. libraries: as
    list_libraries() gives them."""
    found: dict[str, ParameterTerms] = {}
    for use in join.calls.select_uses("parameter"):
        if not use.row.declares or use.fn not in one.functions or not join.runs(one, use):
            continue
        names = [value.text for value in join.list_parameter_names(use)]
        for name in names:
            if name:
                terms = _read_terms(join, use, name) if len(names) == 1 else ParameterTerms(name)
                before = found.setdefault(name, terms)
                if (before.type, before.limits) != (terms.type, terms.limits):
                    found[name] = ParameterTerms(name)
    for root in _list_roots(join, one):
        generated = libraries.get(root, [])
        if len(generated) == 1:
            found |= {name: terms for name, terms in generated[0].items() if name not in found}
    return found


def _list_roots(join: Join, one: Running) -> Iterator[str]:
    """The namespaces that the listeners of generate_parameter_library may have that a program makes for all its
    parameters."""
    for fn in one.functions:
        for name, arguments, _ in list_made(fn, join.code):
            *scope, last = split_name(name.partition("<")[0])
            if last == LISTENER and not any(argument.kind == "text" and argument.text for argument in arguments[1:2]):
                yield from scope[-1:] or split_name(fn.scope)


def list_reconfigurable(join: Join, one: Running, workspace: Workspace) -> dict[str, ParameterTerms]:
    """The private parameters that servers of dynamic_reconfigure read for a program of ROS 1. Their types count where
    the server is written in C++: it leaves a value of a wrong type unread."""
    found: dict[str, ParameterTerms] = {}
    for use in join.calls.select_uses("server"):
        if use.row.framework != _RECONFIGURE or use.fn not in one.functions:
            continue
        given = any(join.calls.is_node(argument, use.fn) for argument in use.call.arguments)
        if given and join.sites.find_prefix(use) != "~":
            continue
        python = use.fn.source.facts.language == "python"
        first = use.call.arguments[0] if use.call.arguments else FlowExpr("other")
        written = join.code.resolve_name(first.text, use.fn.source) if python else use.call.types
        package, name = split_name(written)[0], get_tail(written).removesuffix("Config")
        for path, parameter in list_configurations(workspace).get((package, name), ()):
            limits = ((">=", parameter.low), ("<=", parameter.high))
            found[parameter.name] = ParameterTerms(
                parameter.name, "" if python else parameter.type,
                tuple((sign, bound) for sign, bound in limits if bound is not None), (), path, parameter.line,
            )  # fmt: skip
    return found


@cache_in_derived
def list_configurations(workspace: Workspace) -> dict[tuple[str, str], list[tuple[str, ReconfigurableParameter]]]:
    """The parameters of dynamic_reconfigure with the files that have them, by package and name of the configuration."""
    found: dict[tuple[str, str], list[tuple[str, ReconfigurableParameter]]] = {}
    for package in workspace:
        paths = [path for path in package.files if path.endswith(".cfg")]
        looked: Mapping[str, ReconfigureFile] = workspace.extraction.look(paths, "flow_reconfigure")
        for path, file in looked.items():
            found.setdefault((package.name, file.generated), []).extend((path, one) for one in file.parameters)
    return found


def _read_terms(join: Join, use: FrameworkCall, name: str) -> ParameterTerms:
    call = use.call
    positional = [one for one in call.arguments if one.kind != "keyword"]
    given = _list_keywords(FlowExpr("list", "", call.arguments))
    default = join.calls.find_argument(use, use.row.default)
    after = positional.index(default) + 1 if default is not None and default in positional else 2
    descriptor = given.get("descriptor") or next(iter(positional[after : after + 1]), None)
    ignores = given.get("ignore_override") or next(iter(positional[after + 1 : after + 2]), None)
    if (ignores is not None and ignores.text.lower() != "false") or _is_guarded(use):
        return ParameterTerms(name)
    described = _Descriptor(use.fn, call.line, descriptor)
    if described.is_dynamic:
        return ParameterTerms(name)
    type_ = parse_cpp_type(call.types) if call.types else _find_type(join, default, use.fn)
    return ParameterTerms(name, type_, tuple(described.list_limits()), (), use.fn.source.path, call.line)


def _is_guarded(use: FrameworkCall) -> bool:
    """Whether it depends on more than whether the parameter is declared already that it is declared here."""
    guards = use.fn.facts.guards
    at = use.call.guard
    while at >= 0:
        if guards[at].kind not in ("with", "for") and "has_parameter" not in guards[at].text:
            return True
        at = guards[at].outer
    return False


def _find_type(join: Join, value: FlowExpr | None, fn: Fn) -> str:
    """The type that a default value gives to a parameter; empty where it shows none."""
    if value is None:
        return ""
    python = fn.source.facts.language == "python"
    if value.kind == "text":
        return "string"
    if value.kind == "number":
        return _find_number_type(value.text, python)
    if value.kind == "name":
        named = parse_named_type(get_tail(value.text))
        if named or python:
            return named
        return parse_cpp_type(_find_written_type(join, value.text, fn))
    if value.kind in ("call", "make"):
        if get_tail(value.text) == "ParameterValue" and len(value.parts) == 1:
            return _find_type(join, value.parts[0], fn)
        return "" if python else parse_cpp_type(value.text)
    if value.kind == "list" and value.parts and python:
        kinds = {_find_type(join, part, fn) for part in value.parts}
        kind = kinds.pop() if len(kinds) == 1 else ""
        return f"{kind} array" if kind and " " not in kind else ""
    return ""


def _find_written_type(join: Join, path: str, fn: Fn) -> str:
    """The type that C++ code writes for a variable, with its containers; empty where it writes none."""
    owner = join.code.find_owner(fn)
    members = [one for cls in join.code.list_class_bodies(owner.key) for one in cls.facts.members] if owner else []
    name = path.removeprefix("this.")
    written = [one.type for one in fn.facts.assignments if one.target == path and one.type]
    written = written or [one.type for one in fn.facts.parameters if one.name == path]
    written = written or [one.type for one in (*members, *fn.source.facts.constants) if one.name == name]
    return written[0] if len(set(written)) == 1 else ""


def _find_number_type(text: str, python: bool) -> str:
    if text in ("true", "false", "True", "False"):
        return "bool"
    digits = text.lower().replace("'", "").replace("_", "").lstrip("+-")
    if not digits[:1].isdigit() and digits[:1] != ".":
        return ""
    if digits.startswith(("0x", "0b")):
        return "integer"
    is_real = "." in digits or "e" in digits or (not python and digits.endswith("f"))
    return "double" if is_real else "integer"


def _read_number(value: FlowExpr) -> float | None:
    """A number that is written out."""
    if value.kind != "number":
        return None
    try:
        return float(value.text.replace("'", "").rstrip("fFuUlL"))
    except ValueError:
        return None


class _Descriptor:
    """What the descriptor that a declaration is given says, which is built there or in the lines before."""

    def __init__(self, fn: Fn, line: int, value: FlowExpr | None):
        self.fn, self.line, self.value = fn, line, value
        self.variable = value.text if value is not None and value.kind == "name" else ""

    @property
    def is_dynamic(self) -> bool:
        """Whether values of any type may be set; also where that is not known, as of a descriptor that a function
        gives."""
        value = self.value
        if value is None:
            return False
        if self.variable:
            made = self._find_made(self.variable)
            if made is None or (made.value.kind == "call" and get_tail(made.value.text) != "ParameterDescriptor"):
                return True
            return _mentions_dynamic(made.value) or any(
                _DYNAMIC in f"{path}" for path in self._list_touched(self.variable)
            )
        return get_tail(value.text) != "ParameterDescriptor" or _mentions_dynamic(value)

    def list_limits(self) -> Iterator[Limit]:
        """The range, where it is written out in numbers."""
        whole = self.value
        if self.variable:
            made = self._find_made(self.variable)
            whole = made.value if made is not None else None
        parts = _list_keywords(whole) if whole is not None else {}
        for name in _RANGES:
            value = parts.get(name)
            bounds: dict[str, FlowExpr] = {}
            if self.variable:
                path = f"{self.variable}.{name}"
                value = next((one.value for one in self._list_assigned(path)), value)
                value = next((one.arguments[0] for one in self._list_added(path)), value)
                bounds = self._collect_bounds(f"{path}.[]") | self._collect_bounds(f"{path}.at()")
            bounds = self._read_range(value) | bounds
            numbers = {field: _read_number(bound) for field, bound in bounds.items()}
            for field, number in numbers.items() if None not in numbers.values() else ():
                if number is not None and (field != "step" or number > 0):
                    yield _BOUNDS[field], number

    def _read_range(self, value: FlowExpr | None) -> dict[str, FlowExpr]:
        """The fields of a range, which may be in a list of one."""
        if value is None:
            return {}
        if value.kind == "list" and len(value.parts) == 1:
            return self._read_range(value.parts[0])
        if value.kind == "name":
            made = self._find_made(value.text)
            own = self._read_range(made.value) if made is not None and made.value.kind != "name" else {}
            return own | self._collect_bounds(value.text)
        found = _list_keywords(value)
        link: FlowExpr | None = value
        while link is not None and link.kind == "call" and get_tail(link.text).startswith("set__"):
            if link.parts:
                found[get_tail(link.text).removeprefix("set__")] = link.parts[0]
            link = link.receiver
        return {field: bound for field, bound in found.items() if field in _BOUNDS}

    def _collect_bounds(self, path: str) -> dict[str, FlowExpr]:
        """What is assigned to the fields of a range before the declaration, the last of each."""
        found: dict[str, FlowExpr] = {}
        for field in _BOUNDS:
            for one in self._list_assigned(f"{path}.{field}"):
                found[field] = one.value
        for call in self.fn.facts.calls:
            owner, _, last = call.callee.rpartition(".")
            sets = last.startswith("set__") and owner.split(".set__")[0] == path
            if sets and call.line <= self.line and call.arguments:
                found[last.removeprefix("set__")] = call.arguments[0]
        return {field: bound for field, bound in found.items() if field in _BOUNDS}

    def _find_made(self, variable: str) -> Assignment | None:
        """The last assignment to a variable before the declaration."""
        return next(iter(reversed(list(self._list_assigned(variable)))), None)

    def _list_assigned(self, path: str) -> Iterator[Assignment]:
        return (one for one in self.fn.facts.assignments if one.target == path and self._comes_before(one))

    def _list_added(self, path: str) -> Iterator[FlowCall]:
        ways = {f"{path}.{way}" for way in ("push_back", "emplace_back", "append")}
        found = [one for one in self.fn.facts.calls if one.callee in ways and self._comes_before(one) and one.arguments]
        return (one for one in found if len(one.arguments) == 1)

    def _comes_before(self, one: Assignment | FlowCall) -> bool:
        head = one.target if isinstance(one, Assignment) else one.callee
        own = bool(self.variable) and head.startswith(f"{self.variable}.")
        lines = (each.line for each in self.fn.facts.assignments if each.target == self.variable)
        since = max((line for line in lines if line <= self.line), default=0) if own else 0
        return since <= one.line <= self.line

    def _list_touched(self, variable: str) -> Iterator[str]:
        for one in self.fn.facts.assignments:
            if one.target.startswith(f"{variable}.") and self._comes_before(one):
                yield one.target
        for call in self.fn.facts.calls:
            if call.callee.startswith(f"{variable}.") and self._comes_before(call):
                yield call.callee


def _list_keywords(value: FlowExpr) -> dict[str, FlowExpr]:
    return {part.text: part.parts[0] for part in value.parts if part.kind == "keyword" and part.parts}


def _mentions_dynamic(value: FlowExpr) -> bool:
    parts: Sequence[FlowExpr] = (*value.parts, *((value.receiver,) if value.receiver is not None else ()))
    return _DYNAMIC in value.text or any(map(_mentions_dynamic, parts))
