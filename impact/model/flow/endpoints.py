"""Publishers, subscribers, services, actions, timers, parameters and publish statements, as the code alone tells them.

What belongs to which node, and what its names become there, is told by nodes.py and join.py.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from typing import Any, NamedTuple, get_args

from msgspec import structs

from ....edges.groups import group_pairs
from ....edges.memory import cache_method
from ...facts.cpp.names import split_at_commas
from ...facts.flow import FlowCall, FlowExpr
from ...facts.python.text import join_dotted
from ...targets.constants import load_constants
from .calls import Calls, FrameworkCall
from .code import FlowCode, Fn, Variable, find_parameter, get_outer, get_tail, is_number
from .contexts import Contexts
from .defined import DefinedInterfaces
from .graph import Role
from .handles import NodeHandles, join_spaces
from .modules import CodeFile
from .outside_constants import OutsideConstants
from .templates import Templates
from .turn_conditions import TurnConditions
from .types import find_header_interface, find_interface, parse_flow_type
from .values import (
    LOST,
    NOT_PASSED,
    NOT_YET,
    WHICH_TURN,
    FlowValue,
    FlowValues,
    join_opposites,
    make_sibling,
    put_under_more,
    spell_condition,
)

_EMPTY = "the name is empty"
_CONNECTS = ("connectInput", "reset")
_PUTS = frozenset(("push_back", "emplace_back", "emplace", "insert", "append", "make_pair", "reset"))
_ROLES: dict[str, Role] = {role: role for role in get_args(Role)}
_MODULES = (".msg", ".srv", ".action")
_MODULES_OF: dict[str, tuple[str, ...]] = {
    **dict.fromkeys(("publisher", "subscriber"), (".msg",)), **dict.fromkeys(("server", "client"), (".srv",))
}  # fmt: skip
"""Of which modules the interfaces are that an endpoint may have: services alone are no messages. Those of actions are
messages in ROS 1."""


class TemplateType(NamedTuple):
    """A type that an endpoint in a template is of: where a class is made, or a function runs; always for
    neither."""

    type: str
    cls: str = ""
    fn: Fn | None = None


class Site(NamedTuple):
    """Where code makes an endpoint. names: what its name may be, before the node's own; prefix: the namespace of the
    node handle (`~` for private ones). callbacks: the bodies that may be called; reason: why there are none though one
    is given. implied: the framework fixes the name. types: instead of one type those that a template has."""

    role: Role
    use: FrameworkCall
    names: tuple[FlowValue, ...]
    written: str
    prefix: str
    type: str
    callbacks: tuple[Fn, ...] = ()
    variable: Variable | None = None
    reason: str = ""
    implied: bool = False
    types: tuple[TemplateType, ...] = ()


class JoinedFilters(NamedTuple):
    """Subscribers of filters that are given to one synchronizer, in their order. registered: path and line of the call
    that gives it the callback."""

    filters: tuple[Variable, ...]
    registered: tuple[str, int]


class Statement(NamedTuple):
    """A publish statement. sites: the publishers it may use. through: the function of the code's own called `publish`
    that it calls, which holds the statement that sends."""

    use: FrameworkCall
    sites: tuple[Site, ...]
    type: str
    expression: str
    reason: str = ""
    through: str = ""


class TimerSite(NamedTuple):
    """Where code makes a timer."""

    use: FrameworkCall
    period: str
    callbacks: tuple[Fn, ...]


def _feeds(kept: tuple[Fn, FlowCall | FlowExpr]) -> bool:
    """Whether what a variable keeps is fed by what it is given: what is made, or what a call gives."""
    given = kept[1]
    if isinstance(given, FlowExpr):
        return given.kind in ("make", "list", "call")
    last = get_tail(given.callee)
    return last not in _CONNECTS and (last != "registerCallback" or "." not in given.callee)


def _is_in_order(value: FlowExpr) -> bool:
    """Whether a callback takes what it is called with in that order: a bind may say otherwise."""
    names = [get_tail(part.text) for part in value.parts] if value.kind == "bind" else []
    numbers = [int(name[1:]) for name in names if re.fullmatch(r"_\d+", name)]
    return numbers == list(range(1, len(numbers) + 1))


def _list_words(value: FlowExpr) -> Iterator[str]:
    yield value.text
    for part in value.parts:
        yield from _list_words(part)


def _holds(value: FlowExpr, made: set[tuple[str, tuple[FlowExpr, ...]]]) -> bool:
    """Whether an expression is one of some calls, by callee and arguments, or has one among its parts."""
    return (value.kind in ("call", "make") and (value.text, value.parts) in made) or any(
        _holds(part, made) for part in value.parts
    )


def _serves(fn: Fn) -> bool:
    """Whether a function is for a service: its parameters are a request and a response."""
    types = [parameter.type for parameter in fn.facts.parameters]
    return any("::Request" in each or "::Response" in each for each in types)


def _split_row_index(value: FlowExpr) -> tuple[FlowExpr, int] | None:
    """What is walked through, and the place in each of its rows, of `rows[each][1]`."""
    if value.kind == "index" and len(value.parts) == 2 and value.parts[0].kind == "index":
        walked, place = value.parts[0].parts[:1], value.parts[1]
        if walked and place.kind == "number" and is_number(place.text):
            return walked[0], int(place.text)
    return None


def unparse(value: FlowExpr | None) -> str:
    """An expression for people, near to how it is written."""
    if value is None:
        return ""
    parts = [unparse(part) for part in value.parts]
    if value.kind == "text":
        return f'"{value.text}"'
    if value.kind in ("call", "make"):
        name = f"{unparse(value.receiver)}.{get_tail(value.text)}" if value.receiver is not None else value.text
        return f"{name}({', '.join(parts)})"
    if value.kind == "join":
        return f" {value.text or '+'} ".join(parts)
    if value.kind == "choice":
        return f"{parts[0]} ? {parts[1]} : {parts[2]}" if len(parts) == 3 else value.text
    if value.kind == "index":
        return f"{parts[0]}[{', '.join(parts[1:])}]" if parts else value.text
    if value.kind == "list":
        return f"{{{', '.join(parts)}}}"
    if value.kind == "keyword":
        return f"{value.text}={parts[0] if parts else ''}"
    if value.kind == "bind":
        return f"bind({', '.join(parts)})"
    return value.text


def _select_lost(names: Sequence[FlowValue]) -> list[FlowValue]:
    """Of names on one way to a call, where none is known, those that are there all the same; not what is empty."""
    if any(one.text is not None for one in names):
        return []
    passed = (one for one in names if one.reason != _EMPTY and not one.reason.endswith(NOT_PASSED))
    return [one for one in passed if not one.uncalled and not one.unpassed]


def _list_held_paths(value: FlowExpr) -> Iterator[str]:
    """The variables of which an expression is the value, an element, or a part of an element: `pub`, `pubs[i]`,
    `pubs.items()`, and each of `(a, b)` that a loop walks through. A call that gives something else ends in `()`."""
    keys: list[FlowExpr] = []
    while value.kind == "index" and value.parts:
        keys.append(value.parts[-1])
        value = value.parts[0]
    rows = [value]
    for key in reversed(keys):
        if any(row.kind != "list" for row in rows):
            break
        place = int(key.text) if key.kind == "number" and is_number(key.text) else None
        rows = [each for row in rows for each in (row.parts if place is None else row.parts[place : place + 1])]
    for row in rows:
        if row.kind == "name" and row.text:
            yield row.text
        elif row.kind == "call" and row.text:
            inner = get_tail(row.text) in ("at", "value", "get", "items", "values", "copy") and get_outer(row.text)
            yield inner or f"{row.text}()"


class Sites:
    """All sites of a body of code."""

    def __init__(self, code: FlowCode, calls: Calls, values: FlowValues, defined: DefinedInterfaces):
        self.code, self.calls, self.values, self.defined = code, calls, values, defined
        self.templates = Templates(code)
        self.handles, self.contexts = NodeHandles(calls), Contexts(code)
        self.turns = TurnConditions(code)
        values.find_prefix = self.find_prefix
        values.find_outside_text = self.find_outside_text

    @cached_property
    def endpoints(self) -> list[Site]:
        """In the order of files and lines; rows with further endpoints give several."""
        found: list[Site] = []
        for use in self.calls.uses:
            if use.row.does in _ROLES and not self.wraps(use.fn):
                for one in self._expand_rows(use):
                    found.extend(self._make_endpoints(one))
            elif use.row.does in ("node", "further"):
                found.extend(self._list_implied(Site("publisher", use, (), "", self.find_prefix(use), "")))
        return found

    @cached_property
    def wrapped(self) -> list[FrameworkCall]:
        """Uses inside wrappers of the framework's own functions."""
        return [use for use in self.calls.uses if use.row.does in _ROLES and self.wraps(use.fn)]

    def wraps(self, fn: Fn, does: str = "") -> bool:
        """Whether a function stands for the framework's own of the same name: its callers are the sites. does: what the
        framework's function does, any endpoint when left out."""
        rows = self.calls.table.calls.get(get_tail(fn.name), ())
        meant = any(row.does == does if does else row.does in _ROLES for row in rows)
        stands = bool(fn.facts.parameters) and meant and not fn.is_lambda
        return stands and (bool(does) or self._is_called_as_framework(fn))

    @cache_method
    def _is_called_as_framework(self, fn: Fn) -> bool:
        """Whether callers of a function of such a name, if there are any, look like callers of the framework. Those of
        a method of an object that is no node do not, so that it is followed as any other function."""
        if "node" in self.calls.find_own_kinds(fn):
            return True
        is_called = False
        for one, call in self.code.list_calls_named((get_tail(fn.name),)):
            if fn in self.code.list_targets(call.callee, one):
                is_called = True
                if self.calls.find_use(one, call) is not None:
                    return True
        return not is_called

    def _expand_rows(self, use: FrameworkCall) -> Iterator[FrameworkCall]:
        """The use for each row of the list that its arguments walk through together, with what the row has for them:
        `[Subscriber(topic, type) for topic, type in rows]`."""
        bound: dict[str, tuple[FlowExpr, int]] = {}
        for argument in use.call.arguments:
            if argument.kind == "name" and argument.text in use.fn.assigned:
                each = max(
                    (a for a in use.fn.assigned[argument.text] if a.line <= use.call.line),
                    key=lambda a: a.line, default=None,
                )  # fmt: skip
                place = _split_row_index(each.value) if each is not None else None
                if place is not None:
                    bound[argument.text] = place
        rows = self.values.list_rows(next(iter(bound.values()))[0], use.fn) if len(bound) > 1 else []
        if not rows or len({walked for walked, _ in bound.values()}) > 1:
            yield use
            return
        for row in rows:
            if all(place < len(row.parts) for _, place in bound.values()):
                arguments = tuple(
                    row.parts[bound[a.text][1]] if a.kind == "name" and a.text in bound else a
                    for a in use.call.arguments
                )
                yield use._replace(call=structs.replace(use.call, arguments=arguments))

    def _make_endpoints(self, use: FrameworkCall) -> Iterator[Site]:
        calls, row = self.calls, use.row
        named = calls.find_argument(use, row.topic)
        fixed = bool(row.topic) and isinstance(row.topic[0], str) and row.topic[0].startswith("=")
        prefix, names = self.find_names(use, self.values)
        callbacks, reason = self._find_callbacks(use)
        site = Site(
            _ROLES[row.does], use, names, unparse(named), prefix, self.find_type(use), callbacks,
            self._find_variable(use), reason, fixed,
        )  # fmt: skip
        if not site.type:
            site = site._replace(types=tuple(dict.fromkeys(self._list_template_types(use))))
        yield site
        if row.camera_info:
            # https://docs.ros.org/en/api/image_transport: camera_info stands beside the image's topic.
            infos = tuple(v if v.text is None else v._replace(text=make_sibling(v.text, "camera_info")) for v in names)
            yield site._replace(names=infos, type="sensor_msgs/CameraInfo", implied=True)
        yield from self._list_implied(site)

    def find_names(self, use: FrameworkCall, values: FlowValues) -> tuple[str, tuple[FlowValue, ...]]:
        """The namespace of the node handle that makes an endpoint, and what its name may be, before the node's own.
        Where there are several namespaces, it is empty, and the names have theirs. values: what expressions are worth
        where it runs."""
        prefix, names = self._find_names(use, values)
        return prefix, self._put_under_turns(use, names, values) if len(names) > 1 else names

    def _put_under_turns(
        self, use: FrameworkCall, names: tuple[FlowValue, ...], values: FlowValues
    ) -> tuple[FlowValue, ...]:  # fmt: skip
        """Names of several elements of a list, without those for which a condition in the loop does not hold; those for
        which that is not known are under it."""
        filters = " && ".join(self.turns.list_filters(use.fn, use.call.guard))
        if filters:
            names = tuple(put_under_more(names, filters))
        asked = self.turns.list_asked(use.fn, use.call.guard)
        if not asked:
            return names
        guards = [use.fn.facts.guards[place] for place in asked]
        condition = " && ".join(spell_condition(guard.kind, guard.text) for guard in guards)
        open_: dict[FlowValue, None] = {}
        sure: dict[FlowValue, None] = {}
        ways = self.contexts.list_contexts(use.fn, use.call.guard, values)
        for way in ways if len(ways) > 1 else ():
            decided = [next(way.decide_guards(use.fn, place))[1].holds for place in asked]
            if False not in decided:
                found = self._find_names(use, way)[1]
                (open_ if None in decided else sure).update(dict.fromkeys(found))
        if not open_ and not sure:
            return tuple(put_under_more(names, condition))
        left = [name for name in names if name in sure]
        return (*left, *put_under_more((name for name in names if name in open_ and name not in sure), condition))

    def _find_names(self, use: FrameworkCall, values: FlowValues) -> tuple[str, tuple[FlowValue, ...]]:
        inside = values.limit_to_class(use.fn)
        spaces, names = self._list_spaces(use, inside), self._list_written_names(use, inside)
        several = len(spaces) > 1 or len(names) > 1 or any(one.reason == WHICH_TURN for one in names)
        if several or (any(one.text is not None for one in names) and self._has_turns(use, values)):
            ways = self.contexts.list_contexts(use.fn, use.call.guard, values)
            if len(ways) > 1:
                rows = [(self._list_spaces(use, way), self._list_written_names(use, way)) for way in ways]
                if len({tuple(each) for each, _ in rows}) > 1 or len(spaces) > 1:
                    found = [one for each, own in rows for one in self._join_spaces(each, own)]
                    return "", tuple(dict.fromkeys(found))
                names = tuple(dict.fromkeys(one for _, own in rows for one in own))
                known = tuple(one for one in names if one.text is not None)
                in_part = tuple(one for one in names if one.shown)
                lost = self._list_lost(use, zip(ways, rows, strict=True)) if known else []
                names = known or in_part or names[:1] if not any(one.beside for one in names) else names
                if lost and names is known:
                    names = (*known, lost[0]._replace(beside=True, shown=""))
        if len(spaces) > 1:
            return "", self._join_spaces(spaces, names)
        prefix = spaces[0].text or ""
        if spaces[0].how != "literal" or spaces[0].only_if or prefix.startswith(LOST):
            return ("" if prefix != "~" else prefix), self._join_spaces(spaces, names)
        return prefix, names

    @staticmethod
    def _list_lost(
        use: FrameworkCall, rows: Iterable[tuple[FlowValues, tuple[object, tuple[FlowValue, ...]]]]
    ) -> list[FlowValue]:
        """Of the names on the ways to a call those of which nothing is known, though the call is come to."""
        found: list[FlowValue] = []
        for way, (_, names) in rows:
            lost = _select_lost(names)
            if lost and not any(decided.holds is False for _, decided in way.decide_guards(use.fn, use.call.guard)):
                found += lost
        return found

    def _has_turns(self, use: FrameworkCall, values: FlowValues) -> bool:
        """Whether an endpoint of a name that is not written as such is made in several turns of a loop."""
        named = self.calls.find_argument(use, use.row.topic)
        if named is None or named.kind == "text":
            return False
        fn = use.fn
        return any(values.count_turns(fn, place) > 1 for place in fn.list_guards_around(use.call.guard))

    def _list_spaces(self, use: FrameworkCall, values: FlowValues) -> list[FlowValue]:
        fixed = bool(use.row.topic) and isinstance(use.row.topic[0], str) and use.row.topic[0].startswith("=")
        return [FlowValue("")] if fixed else self.handles.list_prefixes(use, values)

    def _list_written_names(self, use: FrameworkCall, values: FlowValues) -> tuple[FlowValue, ...]:
        """What the name of an endpoint may be where it is made."""
        found = join_opposites(values.evaluate(self.calls.find_argument(use, use.row.topic), use.fn, use.call.line))
        # What is empty, or nothing, was not given yet.
        empty = (FlowValue(None, "unresolved", _EMPTY),)
        return tuple(one for one in found if one.text not in NOT_YET) or empty

    @staticmethod
    def _join_spaces(spaces: list[FlowValue], names: tuple[FlowValue, ...]) -> tuple[FlowValue, ...]:
        """Names in each of some namespaces."""
        found: list[FlowValue] = []
        for space in spaces:
            for name in names:
                lost = (space.text or "").startswith(LOST)
                if name.text is None and name.shown and name.shown[:1] not in ("/", "~", "<"):
                    inside = "" if lost else join_spaces(space, FlowValue(name.shown)).text or ""
                    found.append(name._replace(shown=inside))
                elif name.text is None or name.text[:1] in ("/", "~"):
                    found.append(name)
                elif lost:
                    reason = "the namespace of its node handle is not known"
                    found.append(FlowValue(None, "unresolved", f"`{space.text}/{name.text}`: {reason}"))
                else:
                    found.append(join_spaces(space, name))
        return tuple(dict.fromkeys(found))

    @staticmethod
    def _list_implied(site: Site) -> Iterator[Site]:
        """What the framework makes beside an endpoint or a node."""
        words = {get_tail(word) for argument in site.use.call.arguments for word in _list_words(argument)}
        for also in site.use.row.also:
            if words.intersection(also.unless):
                continue
            role, names = _ROLES[also.role], (FlowValue(also.topic),)
            yield site._replace(role=role, names=names, type=also.type, callbacks=(), reason="", implied=True)

    def _find_variable(self, use: FrameworkCall) -> Variable | None:
        kept = self.calls.find_kept_variable(use)
        if kept is not None:
            return kept
        if use.row.on and "filter" in use.row.on:
            receiver = self.calls.get_receiver(use)
            return self.code.identify(receiver, use.fn) if receiver else None
        put, wrapped = self._find_holders(use.fn)
        callee = put.get(use.call.arguments)
        if callee is not None:
            return self.code.identify(callee.rpartition(".")[0], use.fn)
        if use.row.does == "publisher":
            for each in wrapped.get((use.call.callee, use.call.arguments), ()):
                if self._is_publisher(each.value, use.fn):
                    return self.code.identify(each.target, use.fn)
        return None

    @cache_method
    def _find_holders(
        self, fn: Fn
    ) -> tuple[dict[tuple[FlowExpr, ...], str], dict[tuple[str, tuple[FlowExpr, ...]], list[Any]]]:
        """What a function puts into containers, by the arguments of the call that makes it: the first call that puts
        it; and what it wraps, by that call: the assignments."""
        # `pubs.push_back(nh.advertise(...))`, `pubs.emplace(name, create_publisher(...))`
        put: dict[tuple[FlowExpr, ...], str] = {}
        for call in fn.facts.calls:
            if "." in call.callee and get_tail(call.callee) in _PUTS:
                for argument in call.arguments:
                    if argument.kind in ("call", "make"):
                        put.setdefault(argument.parts, call.callee)
        # `fast_ = std::make_unique<RealtimePublisher<T>>(create_publisher<T>(...))`
        wrapped: dict[tuple[str, tuple[FlowExpr, ...]], list[Any]] = {}
        for each in fn.facts.assignments:
            for part in each.value.parts if each.value.kind == "make" else ():
                if part.kind == "call":
                    wrapped.setdefault((part.text, part.parts), []).append(each)
        return put, wrapped

    def _is_publisher(self, value: FlowExpr, fn: Fn) -> bool:
        """Whether an object that is made is a publisher."""
        return "publisher" in self.calls.find_kinds(self.code.resolve_written(value.text, fn.source, fn.scope), fn)

    def find_template_parameter(self, use: FrameworkCall) -> str:
        """The parameter of a template that tells an endpoint's type, empty for none."""
        for spot in use.row.type:
            text = ""
            if isinstance(spot, str) and spot.startswith("<"):
                text = self.calls.get_template_argument(use, int(spot.strip("<>")))
            elif spot == "of receiver":
                kind = self.code.resolve_name_type(self.calls.get_receiver(use), use.fn)
                text = kind.arguments[0] if kind.arguments else ""
            name = self.code.resolve_written(text, use.fn.source, use.fn.scope).name if text else ""
            if name and self.templates.has(name, use.fn):
                return name
        return ""

    def _list_template_types(self, use: FrameworkCall) -> Iterator[TemplateType]:
        name = self.find_template_parameter(use)
        for one in self.templates.list_given(name, use.fn) if name else ():
            kind = self.code.resolve_written(one.text, one.source, one.scope)
            known = find_interface(kind.name)
            if known:
                yield TemplateType(known, one.cls, one.fn)

    def find_type(self, use: FrameworkCall, values: FlowValues | None = None) -> str:
        """The interface an endpoint is of, as `package/Name`; `*` for any, empty when it is not known. values: what
        expressions are worth where it runs."""
        code, row, fn, values = self.code, use.row, use.fn, values or self.values
        for spot in row.type:
            text = ""
            if isinstance(spot, str) and spot.startswith("="):
                return spot[1:]
            if isinstance(spot, str) and spot.startswith("<"):
                text = self.calls.get_template_argument(use, int(spot.strip("<>")))
                if not text and row.does in ("subscriber", "server"):
                    text = self._find_parameter_type(use)
            elif spot == "of receiver":
                kind = code.resolve_name_type(self.calls.get_receiver(use), fn)
                if get_tail(kind.name) == "SubscriberFilter":
                    return "sensor_msgs/PointCloud2" if "point_cloud" in kind.name else "sensor_msgs/Image"
                text = kind.arguments[0] if kind.arguments else ""
            elif isinstance(spot, str) and spot.startswith("argument "):
                place = int(spot[9:])
                if place < len(use.call.arguments):
                    text = code.resolve_type(use.call.arguments[place], fn).name
            else:
                value = self.calls.find_argument(use, (spot,))
                if value is not None and value.kind == "text":
                    parts = value.text.split("/")
                    return f"{parts[0]}/{parts[-1]}" if len(parts) > 1 else value.text
                if value is not None and value.kind in ("name", "call"):
                    text = value.text
                    if fn.source.facts.language == "python":
                        text = self._find_python_type(value, fn, values, row.does)
                        if text == "*" or "/" in text:
                            return text
            if text:
                kind = code.resolve_written(text, fn.source, fn.scope)
                if self.templates.has(kind.name, fn):
                    continue
                if get_tail(kind.name) in ("ShapeShifter", "AnyMsg", "SerializedMessage"):
                    return "*"
                known = self.calls.table.types.get(kind.name) or find_interface(
                    f"{kind.name}<{', '.join(kind.arguments)}>" if kind.arguments else kind.name
                )
                if not known:
                    known = self._resolve_in_namespaces(kind.name, fn) or self._resolve_in_scope(kind.name, fn)
                if not known and self.defined.has(lower := find_interface(kind.name, lower=True)):
                    known = lower
                if known:
                    return known
        if not use.row.type and use.row.does in _ROLES:
            return ""
        options = self.calls.find_argument(use, (0,))
        if options is not None and options.kind == "name":
            for _, call in code.list_results(code.identify(options.text, fn)):
                if "Options::" in call.callee and call.types:
                    return self._resolve_interface(split_at_commas(call.types)[0], fn)
        kept = self.calls.find_kept_variable(use)
        if kept is not None:
            kind = code.resolve_variable_type(kept, fn)
            if kind.arguments:
                return self._resolve_interface(kind.arguments[0], fn)
        return ""

    def find_outside_text(self, path: str, fn: Fn) -> str | None:
        """The value of a constant that is a string: of a message (`Topics::SCAN`, `Topics.SCAN`), or of a released
        package. None for all else."""
        told = self._find_message_text(path, fn)
        return self._released.find(path, fn) if told is None else told

    @cached_property
    def _released(self) -> OutsideConstants:
        return OutsideConstants(self.code)

    def _find_message_text(self, path: str, fn: Fn) -> str | None:
        head, _, name = path.replace("::", ".").rpartition(".")
        if not head or head.startswith("this"):
            return None
        if fn.source.facts.language == "cpp":
            type_ = head.replace(".", "::")
            known = self._resolve_interface(type_, fn) or self._resolve_in_namespaces(type_, fn)
        else:
            known = self._find_imported_type(head, fn.source) or ""
        texts = self.defined.texts.get(known)
        return texts.get(name) if texts is not None else load_constants().messages.get(known, {}).get(name)

    def _resolve_interface(self, type_: str, fn: Fn) -> str:
        return find_interface(self.code.resolve_written(type_, fn.source, fn.scope).name)

    def _resolve_in_namespaces(self, name: str, fn: Fn) -> str:
        """A type's interface by `using namespace sensor_msgs` and `using namespace std_msgs::msg`."""
        bare = name.removesuffix("::Request").removesuffix("::Response")
        if fn.source.facts.language != "cpp" or ("::" in bare and not bare.startswith("msg::")):
            return ""
        found: list[str] = []
        for alias in self.code.aliases[fn.source.path].get("*", ()):
            known = find_interface(f"{alias.target}::{bare}", lower=True)
            named = alias.target.endswith(("::msg", "::srv", "::action", "_msgs", "_srvs")) and bare[:1].isupper()
            if known and (named or self.defined.has(known)):
                found.append(known)
        if len(found) > 1:
            included = {find_header_interface(header) for header in fn.source.facts.includes}
            found = [known for known in found if known in included] or found
        sure = [known for known in found if self.defined.has(known)]
        return self._select_last_existing([*found, *sure])

    def _select_last_existing(self, found: list[str]) -> str:
        """Of interfaces that a name may mean the last that exists; empty where that cannot be known."""
        may = [known for known in dict.fromkeys(reversed(found)) if self.defined.has(known) is not False]
        return may[0] if len(may) == 1 or (may and self.defined.has(may[0])) else ""

    def _resolve_in_scope(self, name: str, fn: Fn) -> str:
        """A type's interface by the namespaces around the function: `Pose` inside `namespace turtlesim`."""
        if fn.source.facts.language != "cpp":
            return ""
        scope = fn.name.rpartition("::")[0]
        while scope:
            known = find_interface(f"{scope}::{name}")
            package = known.partition("/")[0]
            ours = package == fn.source.package or package.endswith(("_msgs", "_srvs", "_interfaces"))
            if ours and self.defined.has(known) is not False:
                return known
            scope = scope.rpartition("::")[0]
        return ""

    def _is_free(self, name: str, fn: Fn) -> bool:
        """Whether a name of Python is neither a variable nor made in the file."""
        return self.code.identify(name, fn).kind == "global" and not self.code.list_writes(self.code.identify(name, fn))

    def _find_python_type(self, value: FlowExpr, fn: Fn, values: FlowValues, role: str) -> str:
        meant = self.code.resolve_name(value.text, fn.source)
        if find_interface(meant):
            return meant
        if value.kind == "name" and ("." in value.text or self._is_free(value.text, fn)):
            imported = self._find_imported_type(value.text, fn.source, _MODULES_OF.get(role, _MODULES))
            if imported is not None:
                return imported
        for one in values.evaluate(value, fn):
            if one.text and find_interface(one.text):
                return one.text
        by_name = self._find_class_by_name(value, fn, values)
        if by_name:
            return by_name
        # `import std_msgs.msg` leaves the name as it is; a variable may hold the class.
        variable = self.code.identify(value.text, fn)
        for writer, each in self.code.list_writes(variable):
            if each.value.kind == "name":
                found = self.code.resolve_name(each.value.text, writer.source)
                if find_interface(found):
                    return found
        return meant

    def _find_imported_type(
        self, name: str, source: CodeFile, modules: tuple[str, ...] = _MODULES, depth: int = 0
    ) -> str | None:
        """The interface that a name of Python means in a file by what that imports, itself or through other modules of
        the code; empty where several may have it, None where none is known to. modules: those of packages that have
        interfaces of the kind that is wanted."""
        meant = self.code.resolve_name(name, source)
        known = find_interface(meant)
        if known or depth > 4:
            return known or None
        # Of two modules that have it, the one that is imported last.
        stars = [alias.target for alias in self.code.aliases[source.path].get("*", ())] if "." not in name else []
        found = [find_interface(f"{star}.{name}") for star in stars if star.endswith(modules)]
        if found:
            return self._select_last_existing(found)
        for target in (meant, *(join_dotted(star, name) for star in reversed(stars))):
            place = self.code.modules.find_beginning(target, source)
            imported = self._find_imported_type(place[1], place[0], modules, depth + 1) if place is not None else None
            if imported is not None:
                return imported
        return None

    def _find_class_by_name(self, value: FlowExpr, fn: Fn, values: FlowValues, depth: int = 0) -> str:
        """The type of a class that is looked up by its name, `*` for that of whatever a topic has."""
        if value.kind == "index" and value.parts:
            value = value.parts[0]
        if value.kind == "call" and get_tail(value.text) in ("get_message_class", "get_service_class") and value.parts:
            return next((one.text for one in values.evaluate(value.parts[0], fn) if one.text and "/" in one.text), "")
        if value.kind == "call" and get_tail(value.text) == "get_topic_class":
            return "*"
        if value.kind == "name" and depth < 4:
            for writer, each in self.code.list_writes(self.code.identify(value.text, fn)):
                found = self._find_class_by_name(each.value, writer, values, depth + 1)
                if found:
                    return found
        return ""

    def _find_parameter_type(self, use: FrameworkCall) -> str:
        """The message type that a callback's parameter tells."""
        callbacks, _ = self._find_callbacks(use)
        for fn in callbacks:
            for parameter in fn.facts.parameters[:1]:
                kind = self.code.resolve_written(parameter.type, fn.source, fn.scope)
                name = kind.name if not kind.arguments else f"{kind.name}<{', '.join(kind.arguments)}>"
                if get_tail(kind.name) == "MessageEvent" and kind.arguments:
                    name = parse_flow_type(kind.arguments[0]).name
                if use.row.does == "server" and not name.endswith("::Request"):
                    name = name.removesuffix("Request")  # the name that ROS 1 gives to the type outside of the service
                if name:
                    return name
        return ""

    def _find_callbacks(self, use: FrameworkCall) -> tuple[tuple[Fn, ...], str]:
        row = use.row
        if not row.callback:
            return self._find_joined_callbacks(use)
        if isinstance(row.callback[0], str) and row.callback[0].startswith("="):
            name = row.callback[0][1:]
            owner = self.code.find_owner(use.fn)
            return tuple(self.code.find_method(owner, name)) if owner else (), ""
        value = None
        for spot in row.callback:
            one = self.calls.find_argument(use, (spot,))
            found = self.list_bodies(one, use.fn, use) if one is not None else []
            if found:
                return tuple(found), ""
            value = value or one
        if value is None:
            return self._find_options_callbacks(use) or self._find_joined_callbacks(use)
        return (), f"the callback `{unparse(value)[:80]}` is not in the workspace or not followed"

    def _find_options_callbacks(self, use: FrameworkCall) -> tuple[tuple[Fn, ...], str] | None:
        """Those of the options of ROS 1 that are all a call is given, None without any: `subscribe(options)`.

        Source: http://docs.ros.org/en/noetic/api/roscpp/html/structros_1_1SubscribeOptions.html (create, init)."""
        options = self.calls.find_argument(use, (0,))
        if options is None or options.kind != "name":
            return None
        fn, variable = use.fn, self.code.identify(options.text, use.fn)
        made = [call for _, call in self.code.list_results(variable) if "Options::create" in call.callee]
        made += [call for call in fn.facts.calls if call.callee.startswith(f"{options.text}.init")]
        found = [
            body for call in made if len(call.arguments) > 2 for body in self.list_bodies(call.arguments[2], fn, use)
        ]
        return (tuple(found), "") if found else None

    def _find_joined_callbacks(self, use: FrameworkCall) -> tuple[tuple[Fn, ...], str]:
        """For filters: the callbacks registered with whatever joins them."""
        # A listener to transforms that a filter waits for feeds nothing through it.
        fixed = isinstance(use.row.topic[0], str) and use.row.topic[0].startswith("=") if use.row.topic else False
        feeds = use.row.does == "subscriber" and not fixed
        variable = (self._find_variable(use) or self._find_joint(use)) if feeds else None
        if variable is None:
            return (), ""
        found = list(dict.fromkeys(fn for fn in self.joins.get(variable, ())))
        return tuple(found), ""

    def _find_joint(self, use: FrameworkCall) -> Variable | None:
        """What is made of filters that stand among its arguments: `sync = TimeSynchronizer([Subscriber(...)], 10)`."""
        calls, here = use.fn.facts.calls, (use.call.line, use.call.column)
        made = {(call.callee, call.arguments) for call in calls if (call.line, call.column) == here}
        around = [
            call
            for call in calls
            if call.target and (call.line, call.column) != here and any(_holds(each, made) for each in call.arguments)
        ]
        if around:
            nearest = min(around, key=lambda call: abs(call.line - use.call.line))
            return self.code.identify(nearest.target, use.fn)
        return None

    @cached_property
    def _connected(self) -> dict[Variable, list[tuple[Fn, FlowCall]]]:
        """The calls that connect filters to what joins them."""
        found: dict[Variable, list[tuple[Fn, FlowCall]]] = {}
        for fn, call in self.code.list_calls_named(_CONNECTS):
            if "." in call.callee:
                joint = self.code.identify(call.callee.rpartition(".")[0], fn)
                found.setdefault(joint, []).append((fn, call))
        return found

    @cached_property
    def joined_filters(self) -> list[JoinedFilters]:
        """The filters of each synchronizer whose callbacks take the messages in their order."""
        code = self.code
        sites = [one for one in self.endpoints if one.role == "subscriber" and not one.use.row.callback]
        filters = {self._find_variable(one.use) for one in sites} - {None}
        straight: dict[Variable, bool] = {}
        registered: dict[Variable, tuple[str, int]] = {}
        for fn, call in code.list_calls_named(("registerCallback",)):
            name = call.callee.rpartition(".")[0]
            if name:
                joint = code.identify(name, fn)
                straight[joint] = straight.get(joint, True) and all(map(_is_in_order, call.arguments[:1]))
                registered.setdefault(joint, (fn.source.path, call.line))
        found: list[JoinedFilters] = []
        for joint in straight:
            if not straight[joint]:
                continue
            for fn, given in (*self._connected.get(joint, ()), *filter(_feeds, code.list_kept(joint))):
                arguments = given.arguments if isinstance(given, FlowCall) else given.parts
                row = tuple(each for each in self._list_named(arguments, fn) if each in filters)
                if row:
                    found.append(JoinedFilters(row, registered[joint]))
        return found

    def find_position(self, site: Site) -> tuple[int, int] | None:
        """Which of the messages that come through a synchronizer is a subscriber's, and of how many; None where it is
        not known, or not one place."""
        variable, rows = self._find_joined(site)
        places = {(row.filters.index(variable), len(row.filters)) for row in rows if row.filters.count(variable) == 1}
        return next(iter(places)) if len(places) == 1 else None

    def find_joined(self, site: Site) -> tuple[tuple[str, ...], int, tuple[str, int]] | None:
        """The types of all messages that come through the synchronizer of a subscriber, the place of its own among
        them, and where the callback is registered; None where that is not known, or not one."""
        rows = self._find_joined(site)[1]
        place = self.find_position(site)
        if place is None or len({row.filters for row in rows}) != 1:
            return None
        known = {self._find_variable(one.use): one.type for one in self.endpoints if one.role == "subscriber"}
        return tuple(known.get(one, "") for one in rows[0].filters), place[0], rows[0].registered

    def _find_joined(self, site: Site) -> tuple[Variable | None, list[JoinedFilters]]:
        variable = self._find_variable(site.use)
        return variable, [row for row in self.joined_filters if variable is not None and variable in row.filters]

    @cached_property
    def joins(self) -> dict[Variable, list[Fn]]:
        """Filters to the callbacks that get what comes through them, synchronizers and caches in between."""
        code = self.code
        registered: dict[Variable, list[Fn]] = {}
        for fn, call in code.list_calls_named(("registerCallback",)):
            receiver = call.callee.rpartition(".")[0]
            if receiver and call.arguments:
                registered.setdefault(code.identify(receiver, fn), []).extend(self.list_bodies(call.arguments[0], fn))
        connected = self._connected if registered else {}
        found: dict[Variable, list[Fn]] = {}
        for joint, bodies in registered.items():
            queue, seen = [joint], {joint}
            while queue:
                one = queue.pop()
                found.setdefault(one, []).extend(bodies)
                for fn, given in (*connected.get(one, ()), *filter(_feeds, code.list_kept(one))):
                    arguments = given.arguments if isinstance(given, FlowCall) else given.parts
                    for fed in self._list_named(arguments, fn):
                        if fed not in seen and len(seen) < 40:
                            seen.add(fed)
                            queue.append(fed)
        return found

    def _list_named(self, arguments: tuple[FlowExpr, ...], fn: Fn, depth: int = 0) -> Iterator[Variable]:
        for argument in arguments:
            if argument.kind == "name":
                yield self.code.identify(argument.text, fn)
            elif depth < 3 and argument.kind in ("list", "make", "call", "keyword"):
                yield from self._list_named(argument.parts, fn, depth + 1)

    def list_bodies(self, value: FlowExpr, fn: Fn, use: FrameworkCall | None = None, depth: int = 0) -> list[Fn]:
        """The functions of the code that a callback expression may call."""
        code = self.code
        if depth > 5:
            return []
        if value.kind == "lambda":
            found = code.by_name.get((fn.source.path, value.text))
            return [found] if found else []
        if value.kind == "bind" and value.parts:
            return self.list_bodies(value.parts[0], fn, use, depth + 1)
        if value.kind in ("keyword", "make", "list") and value.parts:
            for part in value.parts:
                found = self.list_bodies(part, fn, use, depth + 1)
                if found:
                    return found
            return []
        if value.kind == "choice":
            return [one for part in value.parts[1:] for one in self.list_bodies(part, fn, use, depth + 1)]
        if value.kind == "function" or (value.kind == "name" and "::" in value.text):
            found = self._list_functions(value.text, fn)
            if found:
                return self._select_fitting(found, use)
        if value.kind in ("name", "function"):
            variable = code.identify(value.text, fn)
            for writer, each in code.list_writes(variable):
                if each.value != value:
                    found = self.list_bodies(each.value, writer, use, depth + 1)
                    if found:
                        return found
            found = self._list_functions(value.text, fn)
            if found:
                return self._select_fitting(found, use)
            return self._list_passed_bodies(value.text, fn, use, depth)
        if value.kind == "call":
            if get_tail(value.text) in ("forward", "move", "bind", "ref", "function") and value.parts:
                return self.list_bodies(value.parts[0], fn, use, depth + 1)
            for part in value.parts:
                if part.kind in ("function", "lambda", "bind"):
                    return self.list_bodies(part, fn, use, depth + 1)
            for target in code.list_targets(value.text, fn):
                for each in target.facts.assignments:
                    if each.operator == "return":
                        found = self.list_bodies(each.value, target, use, depth + 1)
                        if found:
                            return found
        return []

    def _list_passed_bodies(self, name: str, fn: Fn, use: FrameworkCall | None, depth: int) -> list[Fn]:
        for one in self.code.list_enclosing_chain(fn):
            place = find_parameter(one, name)
            if place is None:
                continue
            given = self.code.list_given(one, place[0], name)
            return list(
                dict.fromkeys(body for value, giver in given for body in self.list_bodies(value, giver, use, depth + 1))
            )
        return []

    def _list_functions(self, name: str, fn: Fn) -> list[Fn]:
        code = self.code
        if name.startswith("this."):
            owner = code.find_owner(fn)
            if owner is None:
                return []
            return code.find_method(owner, get_tail(name)) or code.list_overrides(owner, get_tail(name))
        if "::" in name:
            cls = code.find_class(get_outer(name), fn.source, fn.scope)
            if cls is not None:
                return code.find_method(cls, get_tail(name)) or code.list_overrides(cls, get_tail(name))
            own = code.find_owner(fn)
            # `&NodeT::callback` inside a template, `&Outer::callback` where only the definition tells the class.
            found = [
                f for f in code.by_tail.get(get_tail(name), ()) if get_tail(f.facts.owner) == get_tail(get_outer(name))
            ]
            if not found and own is not None:
                found = code.find_method(own, get_tail(name)) if get_tail(get_outer(name)) == get_tail(own.name) else []
            return found or [f for f in code.list_targets(name, fn) if not f.facts.owner]
        if "." in name:
            return code.list_targets(name, fn)
        found = code.list_targets(name, fn)
        if found:
            return found
        owner = code.find_owner(fn)
        return code.find_method(owner, name) if owner is not None else []

    def _select_fitting(self, found: list[Fn], use: FrameworkCall | None) -> list[Fn]:
        """Of overloads those that fit: a service's callback has its request, and a subscriber's first parameter is of
        the message's type."""
        if use is not None and len(found) > 1 and use.row.does in ("subscriber", "server"):
            serving = use.row.does == "server"
            found = [fn for fn in found if _serves(fn) == serving] or found
        if use is None or len(found) < 2 or not use.call.types:
            return found
        wanted = self._resolve_interface(self.calls.get_template_argument(use, 0), use.fn)
        given = ((fn, fn.facts.parameters[:1]) for fn in found)
        return [fn for fn, first in given if first and self._resolve_interface(first[0].type, fn) == wanted] or found

    # Namespaces of node handles

    def find_prefix(self, use: FrameworkCall, values: FlowValues | None = None) -> str:
        """The namespace of the handle that a name is given to, as Site.prefix has it; it begins with LOST where that is
        not known, or not one. values: what expressions are worth where it runs."""
        found = {one.text or "" for one in self.handles.list_prefixes(use, values or self.values)}
        return found.pop() if len(found) == 1 else LOST

    @cached_property
    def kept(self) -> dict[Variable, list[Site]]:
        """Publishers by the variable that keeps them."""
        return group_pairs(
            (site.variable, site) for site in self.endpoints if site.variable is not None and site.role == "publisher"
        )

    @cached_property
    def made_in(self) -> dict[Fn, list[Site]]:
        """Sites by the function that makes and returns them."""
        return group_pairs((site.use.fn, site) for site in self.endpoints if site.use.call.returned)

    @cached_property
    def statements(self) -> list[Statement]:
        """All publish statements, in the order of files and lines."""
        found: list[Statement] = []
        for use in self.calls.uses:
            if use.row.does == "publish":
                statement = self._make_statement(use)
                if statement is not None:
                    found.append(statement)
            elif use.row.does == "publish by name":
                named = self.calls.find_argument(use, use.row.topic)
                names = tuple(self.values.evaluate(named, use.fn, use.call.line))
                site = Site("publisher", use, names, unparse(named), "", "*")
                found.append(Statement(use, (site,), "*", unparse(self.calls.find_argument(use, use.row.message))))
        found.extend(self._find_wrapper_calls(found))
        found.sort(key=lambda one: (one.use.fn.source.path, one.use.call.line, one.use.call.column))
        return found

    def _find_wrapper_calls(self, direct: list[Statement]) -> Iterator[Statement]:
        """Calls of the code's own methods that are called as the framework's, and publish."""
        inside = group_pairs((statement.use.fn, statement) for statement in direct)
        names = {name for name, rows in self.calls.table.calls.items() if any(row.does == "publish" for row in rows)}
        for fn, call in self.code.list_calls_named(names):
            for target in self.code.list_targets(call.callee, fn):
                inner = inside.get(target) or [
                    statement
                    for further in target.facts.calls
                    for last in self.code.list_targets(further.callee, target)
                    for statement in inside.get(last, ())
                ]
                if inner:
                    sites = tuple(dict.fromkeys(site for statement in inner for site in statement.sites))
                    types = {statement.type for statement in inner}
                    use = FrameworkCall(fn, inner[0].use.row, call)
                    kind = types.pop() if len(types) == 1 else ""
                    message = unparse(call.arguments[0]) if call.arguments else ""
                    yield Statement(use, sites, kind, message, "", target.name)
                    break

    def _make_statement(self, use: FrameworkCall) -> Statement | None:
        receiver = self.calls.get_receiver(use)
        message = self.calls.find_argument(use, use.row.message)
        expression = unparse(message)
        if not receiver:
            return None
        sites = tuple(dict.fromkeys(self.list_publishers(receiver, use.fn)))
        if sites:
            types = {site.type for site in sites if site.type}
            return Statement(use, sites, types.pop() if len(types) == 1 else "", expression)
        kind = self.code.resolve_name_type(receiver, use.fn)
        if not use.sure and kind.name:
            return None  # of a class that is not a framework's
        if not use.sure and (len(use.call.arguments) > 2 or self._is_like_own_method(use)):
            return None
        known = self._resolve_interface(kind.arguments[0], use.fn) if kind.arguments else ""
        return Statement(use, (), known, expression, f"which publisher `{receiver}` is cannot be known")

    def _is_like_own_method(self, use: FrameworkCall) -> bool:
        """Whether a method of the code's own is called as this is, and takes as many arguments, none or several."""
        given = len(use.call.arguments)
        return given != 1 and any(
            target.facts.owner and len(target.facts.parameters) == given
            for target in self.code.by_tail.get(get_tail(use.call.callee), ())
        )

    def list_publishers(self, receiver: str, fn: Fn, depth: int = 0) -> Iterator[Site]:
        """The publishers that an expression may stand for: kept there, passed in, or copied from elsewhere."""
        if depth > 5:
            return
        code = self.code
        if receiver.endswith("()"):
            for target in code.list_targets(receiver.removesuffix("()"), fn):
                for each in target.facts.assignments:
                    if each.operator == "return" and each.value.kind == "name":
                        yield from self.list_publishers(each.value.text, target, depth + 1)
                yield from (site for site in self.made_in.get(target, ()) if site.role == "publisher")
            if get_tail(receiver.removesuffix("()")) in ("get", "lock", "at", "value", "second", "front", "back"):
                yield from self.list_publishers(get_outer(receiver.removesuffix("()")), fn, depth + 1)
            return
        variable = code.identify(receiver, fn)
        found = self.kept.get(variable)
        if found:
            yield from found
        wrapped = [(writer, each.value) for writer, each in code.list_writes(variable)]
        for writer, value in [*wrapped, *self.code.list_resets(variable)]:
            # `RealtimePublisher(publisher)`
            if value.kind == "make" and self._is_publisher(value, writer):
                for part in value.parts:
                    if part.kind == "name":
                        yield from self.list_publishers(part.text, writer, depth + 1)
        for writer, each in code.list_writes(variable):
            if each.operator in ("=", "for"):
                for text in _list_held_paths(each.value):
                    if text != receiver:
                        yield from self.list_publishers(text, writer, depth + 1)
        for writer, value in self._list_put(variable):
            yield from self.list_publishers(value.text, writer, depth + 1)
        if variable.kind == "local":
            for one in code.list_enclosing_chain(fn):
                place = find_parameter(one, variable.name)
                if place is None:
                    continue
                given = list(code.list_given(one, place[0], variable.name))
                around = code.find_enclosing(one)
                # `lambda message, to=publisher: to.publish(message)`
                if place[1].default is not None and around is not None:
                    given.append((place[1].default, around))
                for value, giver in given:
                    for text in _list_held_paths(value):
                        yield from self.list_publishers(text, giver, depth + 1)

    def _list_put(self, variable: Variable) -> list[tuple[Fn, FlowExpr]]:
        """The variables that are put into a container, with the functions that do."""
        return self._put_by_variable.get(variable, [])

    @cached_property
    def _put_by_variable(self) -> dict[Variable, list[tuple[Fn, FlowExpr]]]:
        calls = self.code.list_calls_named(("append", "push_back", "emplace_back"))
        return group_pairs(
            (self.code.identify(get_outer(call.callee), fn), (fn, argument))
            for fn, call in calls if "." in call.callee and "()" not in call.callee
            for argument in call.arguments if argument.kind == "name"
        )  # fmt: skip

    @cached_property
    def timers(self) -> list[TimerSite]:
        """All timers."""
        return [
            TimerSite(use, unparse(self.calls.find_argument(use, use.row.period)), self._find_callbacks(use)[0])
            for use in self.calls.uses
            if use.row.does == "timer"
        ]
