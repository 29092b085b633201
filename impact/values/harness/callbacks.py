"""The callbacks of a workspace's C++ code, and what their harnesses need to know of the classes around them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from ....edges.groups import group_pairs
from ...facts.flow import DataMember, FlowCall, FlowExpr
from ...model.fields.topics import extract_uses
from ...model.flow.calls import FrameworkCall
from ...model.flow.code import SOURCES, FlowCode, Fn, find_argument, get_tail
from ...model.flow.endpoints import Site
from ...model.flow.graph import Endpoint, Graph
from ...model.flow.join import Join
from ...model.flow.types import Cls, split_name
from ...model.flow.workspace import get_flow
from ...model.workspace import Package, Workspace

_KINDS = {"subscriber": "subscriber", "server": "service", "action server": "action"}
_DEEPEST = 4
_SERVER_ROLES = {
    "goal": ("goal_callback", -1),
    "cancel": ("cancel_callback", -1),
    "accepted": ("handle_accepted_callback", -1),
}
_CLIENT_ROLES = {
    "send_goal_async": {"feedback": ("feedback_callback", 1)},
    "send_goal": {"done": ("done_cb", 1), "active": ("active_cb", 2), "feedback": ("feedback_cb", 3)},
    "add_done_callback": {"future": ("callback", 0)},
}
"""Methods of clients of actions to the callbacks that these are given: what they are for, name and place of the
parameter. Sources: rclpy's action/client.py and server.py, actionlib's simple_action_client.py."""
_FUTURES = {"send_goal_async": "response", "get_result_async": "result"}
_POINTED = re.compile(
    r"(?:const\s+)?(?:(?:std|boost)::(?:unique_ptr|shared_ptr|scoped_ptr)\s*<\s*([\w:]+)\s*>|([\w:]+)\s*\*(?:\s*const)?)"
)
"""A member that may point to its class's implementation."""


class ObservedMember(NamedTuple):
    """A member of a class or a variable outside of one. type: as written. value: its initialiser where that is a
    literal. is_state: a function other than a constructor writes it. is_read: something besides the callback names
    it. least: where it is only ever counted up or set to numbers, the least of these (the number itself where it is
    only counted up is what the constructor leaves); None for the others."""

    name: str
    type: str
    value: str
    is_state: bool
    is_read: bool
    least: int | None = None


class CppCallback(NamedTuple):
    """A callback with where it is given to the framework. kind: `subscriber`, `service`, `timer` or `action`, or `main`
    for a program from its start. path, line: of the call that subscribes. site: the function that it stands in.
    function: the callback's own, None where it is not known. message_type: `package/Name`, empty for a timer.
    is_filtered: it comes through a filter of messages; joined: then, or with a camera, the types of all messages that
    the callback is given, and place: the place of this one; registered: path and line of the call that gives the filter
    its callback, empty where that is not known. role: of an action's callback in Python: `execute`, `goal`, `cancel`,
    `accepted`, `feedback`, `response`, `result`, `done`, `active`."""

    kind: str
    path: str
    line: int
    site: Fn
    function: Fn | None
    message_type: str
    topics: tuple[str, ...]
    nodes: tuple[str, ...]
    is_filtered: bool = False
    joined: tuple[str, ...] = ()
    place: int = 0
    registered: tuple[str, int] = ("", 0)
    role: str = ""

    @property
    def name(self) -> str:
        """The callback's name."""
        if self.kind == "main" and not self.site.name:
            return "main"
        return self.function.name if self.function is not None else f"{self.site.name}:{self.line}"


def list_cpp_callbacks(workspace: Workspace, graph: Graph) -> list[CppCallback]:
    """All callbacks of the workspace's C++ code, in the order of their places."""
    return list_callbacks(workspace, graph, "cpp")


def list_callbacks(workspace: Workspace, graph: Graph, language: str) -> list[CppCallback]:
    """All callbacks of the workspace's code in a language (`cpp`, `python`), in the order of their places."""
    join = get_flow(workspace).code
    ends = group_pairs(((one.role, one.path, one.line), one) for one in graph.endpoints)
    found: dict[tuple[str, str, int, str], CppCallback] = {}
    rows = (
        *_list_endpoints(join, ends, language),
        *(_list_actions(join, ends) if language == "python" else ()),
        *_list_timers(join, graph, language),
        *_list_mains(join, graph, language),
    )
    for each in rows:
        found.setdefault((each.kind, each.path, each.line, each.name), each)
    return sorted(found.values(), key=lambda each: (each.path, each.line, each.kind, each.name))


def _list_endpoints(
    join: Join, ends: dict[tuple[str, str, int], list[Endpoint]], language: str
) -> Iterator[CppCallback]:
    for site in join.sites.endpoints:
        fn = site.use.fn
        if site.role not in _KINDS or site.implied or fn.source.facts.language != language:
            continue
        path, line = fn.source.path, site.use.call.line
        rows = ends.get((site.role, path, line), [])
        types = [site.type] if site.type else [each.type for each in site.types]
        for callback in site.callbacks or (None,):
            of = [one for one in rows if callback is None or one.callback is None or one.callback.name == callback.name]
            known = [one.type for one in of if "/" in one.type] or [each for each in types if "/" in each]
            found = CppCallback(
                _KINDS[site.role], path, line, fn, callback, known[0] if known else "",
                tuple(dict.fromkeys(one.topic for one in of if one.topic)),
                tuple(dict.fromkeys(one.node for one in of if one.node)),
            )  # fmt: skip
            if found.kind == "action" and language == "python":
                found = found._replace(role="execute", message_type=found.message_type.removesuffix("Action"))
            yield _join_messages(found, join, site, [one.type for one in of])


def _list_actions(join: Join, ends: dict[tuple[str, str, int], list[Endpoint]]) -> Iterator[CppCallback]:
    """The callbacks of actions in Python besides the one that executes a goal: those that a server is given by name,
    and those that are given with a goal, to the client of the class or file."""
    clients: dict[tuple[str, str], set[str]] = {}
    for site in join.sites.endpoints:
        fn = site.use.fn
        if fn.source.facts.language != "python" or site.implied or "/" not in site.type:
            continue
        type_ = site.type.removesuffix("Action")
        if site.role == "action client":
            clients.setdefault((fn.source.path, ".".join(fn.owner)), set()).add(type_)
        elif site.role == "action server":
            rows = ends.get((site.role, fn.source.path, site.use.call.line), [])
            topics = tuple(dict.fromkeys(one.topic for one in rows if one.topic))
            nodes = tuple(dict.fromkeys(one.node for one in rows if one.node))
            for role, function in _list_given(join, fn, site.use.call, _SERVER_ROLES, use=site.use):
                yield CppCallback(
                    "action", fn.source.path, site.use.call.line, fn, function, type_, topics, nodes, role=role
                )
    for (path, owner), types in clients.items():
        if len(types) != 1:
            continue
        (type_,) = types
        for fn in join.code.functions_in.get(path, ()):
            if ".".join(fn.owner) != owner:
                continue
            for call in fn.facts.calls:
                roles = _CLIENT_ROLES.get(get_tail(call.callee), {})
                for role, function in _list_given(join, fn, call, roles):
                    yield CppCallback("action", path, call.line, fn, function, type_, (), (), role=role)


def _list_given(
    join: Join, fn: Fn, call: FlowCall, roles: Mapping[str, tuple[str, int]], use: FrameworkCall | None = None
) -> Iterator[tuple[str, Fn]]:
    """The functions that a call is given for its parameters, with what these are for. roles: to the name and place of
    the parameter."""
    for role, (name, place) in roles.items():
        value = find_argument(call.arguments, place, name)
        meant = _find_asked(fn, call) if role == "future" else role
        if value is not None and meant:
            yield from ((meant, function) for function in join.sites.list_bodies(value, fn, use))


def _find_asked(fn: Fn, call: FlowCall) -> str:
    """What a future is of that is given a callback: `response` where it is of a goal that was sent, `result` of its
    result; empty where that does not show in the function."""
    holder = call.callee.rpartition(".")[0]
    for other in fn.facts.calls:
        if other.target == holder or f"{other.callee}()" == holder:
            role = _FUTURES.get(get_tail(other.callee))
            if role:
                return role
    return ""


def _join_messages(callback: CppCallback, join: Join, site: Site, types: Sequence[str]) -> CppCallback:
    """A callback with what it is given besides, where a synchronizer or a camera gives it several messages. types: of
    its endpoints at this place."""
    row = site.use.row
    if row.camera_info and callback.kind == "subscriber":
        joined = tuple(dict.fromkeys(types))
        return callback._replace(joined=joined if len(joined) == 2 and joined[0] == callback.message_type else ())
    if row.framework != "message_filters":
        return callback
    found = join.sites.find_joined(site)
    if found is None or len(found[0]) < 2:
        return callback._replace(is_filtered=True)
    joined, place, registered = found
    return callback._replace(is_filtered=True, joined=joined, place=place, registered=registered)


def _list_timers(join: Join, graph: Graph, language: str) -> Iterator[CppCallback]:
    nodes = group_pairs(((one.path, one.line), one.node) for one in graph.timers)
    for site in join.sites.timers:
        fn = site.use.fn
        if fn.source.facts.language != language:
            continue
        path, line = fn.source.path, site.use.call.line
        for callback in site.callbacks:
            names = tuple(dict.fromkeys(each for each in nodes.get((path, line), []) if each))
            yield CppCallback("timer", path, line, fn, callback, "", (), names)


def _list_mains(join: Join, graph: Graph, language: str) -> Iterator[CppCallback]:
    """Where programs begin that publish something before or beside their callbacks: main, the top of a script, or the
    constructor of a class that nothing of the workspace makes. The function is given as if it were a callback."""
    nodes: dict[tuple[str, int], dict[str, None]] = {}
    for one in graph.publishes:
        for way in one.by:
            if way.trigger.kind == "start":
                nodes.setdefault((way.trigger.path, way.trigger.line), {})[one.node] = None
    for (path, line), names in sorted(nodes.items()):
        for fn in join.code.functions_in.get(path, ()):
            if fn.facts.line == line and fn.source.facts.language == language:
                owned = tuple(each for each in names if each)
                yield CppCallback("main", path, line, fn, fn, "", (), owned)
                break


class ClassReader:
    """What harnesses ask of the classes and variables of a workspace's C++ code."""

    def __init__(self, workspace: Workspace):
        self.workspace = workspace
        self.code: FlowCode = get_flow(workspace).code.code
        self._uses = extract_uses(workspace)
        self._named: dict[str, set[tuple[str, int]]] = {}
        for path, file in self._uses.items():
            for function in file.functions:
                for use in function.uses:
                    for part in use.path.replace("::", ".").split("."):
                        self._named.setdefault(part, set()).add((path, function.line))

    def find_class(self, fn: Fn | None) -> Cls | None:
        """The class whose method a function is, or stands in."""
        return self.code.find_owner(fn) if fn is not None else None

    def list_bases(self, cls: Cls) -> list[str]:
        """The names of all bases of a class, those of other packages included."""
        return list(self.code.list_base_names(cls))

    def list_constructors(self, cls: Cls) -> list[list[str]]:
        """The types of the parameters of each constructor that has a body, as written; those with a default left
        out."""
        found = []
        for fn in self.code.find_method(cls, cls.parts[-1]):
            types = [each.type for each in fn.facts.parameters if each.default is None]
            defaults = self._count_defaults(fn)
            found.append(types[: len(types) - defaults] if defaults else types)
        return sorted(found, key=len)

    def _count_defaults(self, fn: Fn) -> int:
        total = len(fn.facts.parameters)
        count = 0
        for place in range(total - 1, -1, -1):
            parameter = fn.facts.parameters[place]
            if parameter.default is None and self.code.find_default(fn, place, parameter) is None:
                break
            count += 1
        return count if all(each.default is None for each in fn.facts.parameters) else 0

    def has_method(self, cls: Cls, name: str) -> bool:
        return bool(self.code.find_method(cls, name))

    def list_members(self, cls: Cls, callback: Fn | None) -> list[ObservedMember]:
        """The data members of a class and of its bases in the workspace."""
        found: dict[str, ObservedMember] = {}
        for one in self.code.list_bases(cls):
            for member in one.facts.members:
                if "static" in member.type.split() or "constexpr" in member.type or not member.name.isidentifier():
                    continue
                if member.name not in found:
                    written = self._is_written_by_others(member.name, one)
                    read = self._is_named_by_others(member.name, callback)
                    least = self._find_least(member.name, one) if written else None
                    found[member.name] = _make_member(member, written, read)._replace(least=least)
        return list(found.values())

    def list_parts(self, cls: Cls, callback: Fn | None) -> list[tuple[str, Cls]]:
        """The data members of a class that point to its implementation, with the class of that: one that is declared in
        it, one that only the source file knows whose class it is not in, or the one that the callback is of."""
        own = self.find_class(callback)
        found: dict[str, Cls] = {}
        for one in self.code.list_bases(cls):
            for member in one.facts.members:
                pointed = _POINTED.fullmatch(member.type.strip())
                if pointed is None or not member.name.isidentifier():
                    continue
                inner = self.code.find_class_of_type(pointed[1] or pointed[2], one.source, one.name)
                if inner is None or not inner.facts.members or inner.key == cls.key:
                    continue
                is_hidden = inner.source.path.endswith(SOURCES) and inner.source.path != one.source.path
                is_inner = inner.name.startswith(f"{one.name}::")
                if is_hidden or is_inner or (own is not None and own.key == inner.key):
                    found.setdefault(member.name, inner)
        return list(found.items())

    def _is_written_by_others(self, name: str, cls: Cls) -> bool:
        """Whether a function of a class that is no constructor writes a member."""
        for fn in self.code.list_functions(cls):
            if self.code.is_constructor(fn):
                continue
            targets = (each.target for each in fn.facts.assignments)
            if any(name in _split_target(target) for target in targets):
                return True
            if any(name in _split_target(each.path) and each.kind == "write" for each in fn.facts.accesses):
                return True
        return self._changes(name, cls)

    def _find_least(self, name: str, cls: Cls) -> int | None:
        """The least number that a member is set to which is otherwise only counted up, as far as its class shows."""
        rows = [
            (each.operator, each.value)
            for fn in self.code.list_functions(cls)
            if not self.code.is_constructor(fn)
            for each in fn.facts.assignments
            if name in _split_target(each.target)
        ]
        paths = {fn.source.path for fn in self.code.list_functions(cls)}
        places = [
            use
            for path in paths & self._uses.keys()
            for function in self._uses[path].functions
            for use in function.uses
            if use.path.removeprefix("this.") == name and use.how not in ("read", "test", "size", "returned")
        ]
        # Whoever is handed it may set it to anything.
        if any(use.how != "write" and not (use.how == "kept" and "&" not in use.type) for use in places):
            return None
        return find_least(rows)

    def _changes(self, name: str, cls: Cls) -> bool:
        """Whether the field facts have it that something is put into a member."""
        paths = {fn.source.path for fn in self.code.list_functions(cls)}
        makers = {
            (fn.source.path, fn.facts.line) for fn in self.code.list_functions(cls) if self.code.is_constructor(fn)
        }
        for path in paths & self._uses.keys():
            for function in self._uses[path].functions:
                if (path, function.line) in makers:
                    continue
                for use in function.uses:
                    if use.how in ("write", "change") and name in map(get_tail, use.path.split(".")[:2]):
                        return True
        return False

    def _is_named_by_others(self, name: str, callback: Fn | None) -> bool:
        here = (callback.source.path, callback.facts.line) if callback is not None else ("", 0)
        return bool(self._named.get(name, set()) - {here}) or callback is None

    def list_variables(self, path: str, callback: Fn | None) -> list[ObservedMember]:
        """The variables outside of functions and classes that a file defines."""
        source = next((one for one in self.code.sources if one.path == path), None)
        if source is None:
            return []
        written = {
            part
            for fn in self.code.functions_in.get(path, ())
            if fn.name and get_tail(fn.name) != "main"
            for each in fn.facts.assignments
            if not each.type
            for part in _split_target(each.target)[:1]
        }
        found = []
        for row in source.facts.constants:
            if (
                not row.type
                or "const" in row.type.split()
                or "constexpr" in row.type
                or not row.name.replace("::", "").isidentifier()
            ):
                continue
            last = get_tail(row.name)
            found.append(_make_member(row, last in written, self._is_named_by_others(last, callback)))
        return found

    def find_package(self, path: str) -> Package | None:
        """The package that a file belongs to."""
        found = [one for one in self.workspace if not one.path or path.startswith(one.path + "/")]
        return max(found, key=lambda one: len(one.path), default=None)

    def find_standard(self, path: str) -> tuple[int, tuple[str, ...]]:
        """The C++ standard of the targets that compile a file (17 at least), and their definitions."""
        package = self.find_package(path)
        targets = [one for one in package.build.targets if path in one.sources] if package is not None else []
        standard = max((one.standard for one in targets if one.standard < 90), default=17)
        definitions = tuple(dict.fromkeys(each for one in targets for each in one.definitions if "$" not in each))
        return max(17, standard), definitions

    def list_defining(self, symbols: set[str], beside: str) -> list[str]:
        """The source files whose functions some symbols may be: mangled names of C++, and names of C, which are looked
        for in the package of a path."""
        found: dict[str, None] = {}
        package = self.find_package(beside)
        for fn in self.code.functions:
            path = fn.source.path
            if fn.source.facts.language != "cpp" or not fn.name or not path.endswith(SOURCES):
                continue
            if path.endswith(".c"):
                if fn.name in symbols and self.find_package(path) is package:
                    found[path] = None
                continue
            parts = split_name(fn.name)[-2:]
            mark = "".join(f"{len(part)}{part}" for part in parts)
            if len(parts) == 2 and parts[0] == parts[1]:
                mark = f"{len(parts[0])}{parts[0]}C"
            if any(symbol.startswith("_Z") and mark in symbol for symbol in symbols):
                found[path] = None
        return list(found)


_HIGHEST = 2**31 - 1


def find_least(assignments: Sequence[tuple[str, FlowExpr]]) -> int | None:
    """The least value of what is only counted up (operator and value of each assignment) or set to whole numbers, from
    these: a high number where it is only counted up. None where it is changed otherwise."""
    least = _HIGHEST
    for operator, value in assignments:
        number = int(value.text) if value.kind == "number" and re.fullmatch(r"-?[0-9]{1,9}", value.text) else None
        if number is None or operator not in ("=", "+=") or (operator == "+=" and number < 0):
            return None
        if operator == "=":
            least = min(least, number)
    return least if assignments else None


def _make_member(member: DataMember, written: bool, read: bool) -> ObservedMember:
    return ObservedMember(member.name, member.type, _spell_literal(member.value), written, read)


def _split_target(path: str) -> list[str]:
    parts = [part for part in path.split(".") if part and part != "[]"]
    # `Class::member_` is a member as `this->member_` is.
    return [get_tail(part) for part in (parts[1:2] if parts[:1] == ["this"] else parts[:1])]


def _spell_literal(value: FlowExpr | None) -> str:
    if value is None:
        return ""
    if value.kind == "number" and value.text not in ("None",):
        return {"True": "true", "False": "false"}.get(value.text, value.text)
    if value.kind == "list" and len(value.parts) == 1:
        return _spell_literal(value.parts[0])
    if value.kind == "text":
        shown = "".join(
            f"\\{ord(c):03o}" if c in '"\\' or not " " <= c <= "~" else c for c in value.text if ord(c) < 256
        )
        return f'"{shown}"'
    return ""
