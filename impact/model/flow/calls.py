"""Calls and objects of the code that a row of the table of frameworks describes, and what their arguments are."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import NamedTuple

from msgspec import structs

from ....edges.groups import group_pairs
from ....edges.memory import cache_method
from ...facts.cpp.names import split_at_commas
from ...facts.flow import Assignment, FlowCall, FlowExpr
from .code import FlowCode, Fn, Variable, get_outer, get_tail
from .elements import Elements
from .frameworks import FrameworkRow, Frameworks, Spot
from .types import Cls, FlowType, is_pointer, parse_flow_type, split_name

# Names that mean something else in most code: their receiver has to be known to be of the framework.
_COMMON = frozenset(
    ("publish", "subscribe", "advertise", "param", "get", "getCached", "init", "call", "sendTransform", "Register",
     "Notify", "load", "Subscriber", "Publisher", "Service", "Timer", "ActionServer", "ActionClient")
)  # fmt: skip

# What the call of a method does that no class of the code has, on an object that is not known to be of the framework.
FOREIGN = "foreign"


class FrameworkCall(NamedTuple):
    """A call, or an object that is made, that a row describes. call: with the arguments; for an object a call of its
    constructor. sure: False where only the name tells."""

    fn: Fn
    row: FrameworkRow
    call: FlowCall
    sure: bool = True


class Calls:
    """All uses of frameworks in a body of code."""

    def __init__(self, code: FlowCode, table: Frameworks):
        self.code, self.table = code, table
        self._kinds: dict[tuple[str, Cls | None], frozenset[str]] = {}
        self._uses: dict[tuple[Fn, int], FrameworkCall | None] = {}
        self._makers: dict[Cls, tuple[Fn | None, list[Fn]]] = {}

    @cached_property
    def uses(self) -> list[FrameworkCall]:
        """In the order of files and lines."""
        found: list[FrameworkCall] = []
        described = group_pairs(self.code.list_calls_named(self.table.calls))
        declaring = group_pairs(self.code.list_calls_named(("declare_parameters",)))
        for fn in self.code.functions:
            for call in described.get(fn, ()):
                use = self.find_use(fn, call)
                if use is not None:
                    found.append(use)
            for call in declaring.get(fn, ()):
                found.extend(self._list_declared(fn, call))
            found.extend(self._list_objects(fn))
        found.sort(key=lambda use: (use.fn.source.path, use.call.line, use.call.column))
        return found

    def _list_declared(self, fn: Fn, call: FlowCall) -> Iterator[FrameworkCall]:
        """The parameters that one call of declare_parameters() declares, each as if it were declared alone; one without
        a known name for what is not written out."""
        given = {one.text: one.parts[0] for one in call.arguments if one.kind == "keyword" and one.parts}
        positional = [one for one in call.arguments if one.kind != "keyword"]
        namespace = positional[0] if positional else given.get("namespace", FlowExpr("text"))
        rows = positional[1] if len(positional) > 1 else given.get("parameters", FlowExpr("list"))
        head = (namespace, FlowExpr("text", "."))
        if namespace.kind == "text":
            head = (FlowExpr("text", f"{namespace.text}."),) if namespace.text else ()
        known = self.table.calls.get("declare_parameter", ())
        described = [each for each in known if each.language in ("", fn.source.facts.language)]
        for row in self._list_declared_rows(rows, fn, call):
            name = row.parts[0] if row.kind == "list" and row.parts else row
            whole = FlowExpr("join", "", (*head, name)) if head else name
            if head and name.kind == namespace.kind == "text":
                whole = FlowExpr("text", f"{head[0].text}{name.text}")
            one = structs.replace(call, arguments=(whole, *row.parts[1:3]))
            yield from (FrameworkCall(fn, each, one) for each in described[:1])

    def _list_declared_rows(self, rows: FlowExpr, fn: Fn, call: FlowCall) -> list[FlowExpr]:
        """A list, with name and value, for each parameter that is declared at once."""
        if rows.kind == "list":
            return list(rows.parts)
        if rows.kind == "other" and len(rows.parts) == 1:
            return [rows.parts[0]]  # `[(name, 0) for name in names]`
        found = Elements(self.code).list_walked(rows, fn, call.line)
        return [one.value for one in found] if found else [FlowExpr("other", rows.text)]

    def select_uses(self, what: str) -> list[FrameworkCall]:
        """The uses that do something, as their rows call it; in order."""
        return self._doing.get(what, [])

    @cached_property
    def _doing(self) -> dict[str, list[FrameworkCall]]:
        return group_pairs((use.row.does, use) for use in self.uses)

    def find_kinds(self, kind: FlowType, fn: Fn) -> frozenset[str]:
        """Kinds of framework classes that a type belongs to, by itself or by its bases."""
        if not kind.name:
            return frozenset()
        cls = self.code.find_class_of(kind, fn)
        known = self._kinds.get((kind.name, cls))
        if known is None:
            found = {self.table.find_kind(kind.name)}
            if cls is not None:
                found |= {self.table.find_kind(name) for name in self.code.list_base_names(cls) if name}
            known = self._kinds[kind.name, cls] = frozenset(found - {""})
        return known

    def find_own_kinds(self, fn: Fn) -> frozenset[str]:
        """Kinds of the class that a function belongs to."""
        owner = self.code.find_owner(fn)
        return self.find_kinds(FlowType(fn.facts.owner, (), owner), fn) if fn.facts.owner else frozenset()

    def find_use(self, fn: Fn, call: FlowCall) -> FrameworkCall | None:
        """The use that a call is, None when no row describes it."""
        rows = self.table.calls.get(get_tail(call.callee))
        if not rows:
            return None
        # Files that are alike have the same facts.
        key = fn, id(call)
        if key not in self._uses:
            self._uses[key] = self._find_use(fn, call, rows)
        return self._uses[key]

    def _find_use(self, fn: Fn, call: FlowCall, rows: list[FrameworkRow]) -> FrameworkCall | None:
        language = fn.source.facts.language
        receiver, kinds, free = self._resolve_receiver(fn, call)
        weak = None
        for row in rows:
            if row.language and row.language != language:
                continue
            if row.first and not self._fits_first(row.first, fn, call):
                continue
            if row.does == "parameter" and row.first == "node":
                targets = self.code.list_targets(call.callee, fn)
                if not all(map(self.is_name_handed_on, targets)):
                    continue  # a helper of the code's own, which is followed
            if row.free or row.on:
                if free is not None and (free in row.free and (free or not receiver)):
                    return FrameworkCall(fn, row, call)
                if kinds & set(row.on):
                    return FrameworkCall(fn, row, call)
                inside = receiver or (free == "" and fn.facts.owner)
                unknown = row.on and inside and not kinds and not self.code.list_targets(call.callee, fn)
                if weak is not None or not unknown:
                    continue
                # A receiver of a type that is none of ours is not of the framework, as far as the code has the type.
                if receiver and not self._has_type(receiver, fn) and self._is_distinct(row, call):
                    weak = FrameworkCall(fn, row, call, False)
                elif row.does in ("publisher", "subscriber", "server", "client") and call.types:
                    weak = FrameworkCall(fn, FrameworkRow(row.framework, FOREIGN), call, False)
                continue
            if free is not None and free not in ("rclcpp", "this", "") and "::" in call.callee:
                continue
            if self.code.list_targets(call.callee, fn) and not kinds & {"node"}:
                continue  # a function of the code's own that has the same name
            return FrameworkCall(fn, row, call)
        return weak

    def is_name_handed_on(self, fn: Fn) -> bool:
        """Whether a function asks for a parameter by the name that its second argument is, and no other."""
        name = fn.facts.parameters[1].name if len(fn.facts.parameters) > 1 else ""
        asked = [
            call.arguments[0].text
            for call in fn.facts.calls
            if call.arguments
            and any(row.does == "parameter" for row in self.table.calls.get(get_tail(call.callee), ()))
        ]
        return bool(name) and bool(asked) and set(asked) == {name}

    def _resolve_receiver(self, fn: Fn, call: FlowCall) -> tuple[str, frozenset[str], str | None]:
        """The receiver as written, its kinds, and the scope of a function that has no receiver."""
        callee = call.callee
        if fn.source.facts.language == "python":
            receiver = get_outer(callee)
            if receiver in ("this", "super()"):
                return receiver, self.find_own_kinds(fn), None
            meant = self.code.resolve_name(callee, fn.source)
            head = split_name(callee)[0] if callee else ""
            imported = meant != callee or head in self.code.aliases[fn.source.path]
            if not receiver or imported:
                return receiver, frozenset(), get_outer(meant)
            return receiver, self.find_kinds(self.code.resolve_name_type(receiver, fn), fn), None
        if "." in callee:
            receiver = callee.rpartition(".")[0]
            if receiver == "this":
                return receiver, self.find_own_kinds(fn), None
            if receiver.endswith("()"):
                kind = self.code.resolve_call_type(receiver, fn)
            else:
                kind = self.code.resolve_name_type(receiver, fn)
            return receiver, self.find_kinds(kind, fn) | self._find_getter_kinds(receiver), None
        if "::" in callee:
            return "", frozenset(), get_outer(self.code.resolve_name(callee, fn.source, fn.scope))
        return "", self.find_own_kinds(fn), ""

    def _find_getter_kinds(self, receiver: str) -> frozenset[str]:
        """Return types of well-known functions: nodelets hand out node handles."""
        name = get_tail(receiver.removesuffix("()")) if receiver.endswith("()") else ""
        return frozenset(("handle",)) if name.endswith("NodeHandle") and name.startswith("get") else frozenset()

    def _has_type(self, receiver: str, fn: Fn) -> bool:
        return bool(not receiver.endswith("()") and self.code.resolve_name_type(receiver, fn).name)

    def _is_distinct(self, row: FrameworkRow, call: FlowCall) -> bool:
        if row.does in ("publisher", "subscriber") and call.types:
            return True
        return get_tail(call.callee) not in _COMMON or row.does == "publish"

    def _fits_first(self, wanted: str, fn: Fn, call: FlowCall) -> bool:
        positional = [argument for argument in call.arguments if argument.kind != "keyword"]
        if not positional:
            return wanted == "other" or (wanted == "text" and bool(call.arguments))
        return self.is_node(positional[0], fn) == (wanted == "node")

    def is_node(self, value: FlowExpr, fn: Fn) -> bool:
        """Whether an argument is a node, a node handle, or what stands for one."""
        if value.kind == "name":
            if value.text == "this" or value.text in ("self", "*this"):
                return True
            kind = self.code.resolve_type(value, fn)
            if self.find_kinds(kind, fn) & _STAND_FOR_NODES or get_tail(kind.name) in ("NodeT", "NodeType", "Node"):
                return True
            return not kind.name and get_tail(value.text).strip("_") in _NODES
        if value.kind == "call":
            name = get_tail(value.text)
            if self.find_kinds(self.code.resolve_type(value, fn), fn) & {"node", "handle"}:
                return True
            return name in ("shared_from_this", "lock", "get_node_base_interface", "getNodeHandle") or (
                name.endswith("NodeHandle") or name.startswith("get_node")
            )
        return value.kind == "other" and "this" in value.text

    def _list_objects(self, fn: Fn) -> Iterator[FrameworkCall]:
        seen = set()
        for name, call in self._list_made(fn):
            for row in self._list_rows(name, fn.source.facts.language):
                if row.does == "node" and not call.arguments:
                    continue
                if row.first and not self._fits_first(row.first, fn, call):
                    continue
                key = (row.types, call.line, call.target)
                if key not in seen:
                    seen.add(key)
                    yield FrameworkCall(fn, row, call)

    @cache_method
    def _list_rows(self, name: str, language: str) -> list[FrameworkRow]:
        """The rows about objects of a class that a function makes; none for most classes."""
        return self.table.list_objects(name, language == "python") if name else []

    def _list_made(self, fn: Fn) -> Iterator[tuple[str, FlowCall]]:
        """Objects of named classes, with the call that makes them: declared, initialised as members or bases, or made
        by make_shared."""
        code, source, scope = self.code, fn.source, fn.scope
        cpp = source.facts.language == "cpp"
        for call in fn.facts.calls:
            last = get_tail(call.callee)
            if last in ("make_shared", "make_unique") and call.types:
                kind = code.resolve_written(call.types, source, scope)
                yield _find_known_name(kind), structs.replace(call, types=", ".join(kind.arguments), returned=False)
            elif last == "make_shared" and "::" in call.callee:
                yield code.resolve_name(get_outer(call.callee), source, scope), call
            elif cpp and last[:1].isupper() and "::" in call.callee and "." not in call.callee:
                kind = code.resolve_written(call.callee, source, scope)
                types = ", ".join(kind.arguments)
                yield _find_known_name(kind), call if call.types else structs.replace(call, types=types, returned=False)
            for argument in call.arguments if cpp else ():
                for make in _list_nested(argument) if argument.parts or argument.kind == "make" else ():
                    target = get_outer(call.callee) if last == "reset" else ""
                    kind = code.resolve_written(make.text, source, scope)
                    yield _find_known_name(kind), _make_call(kind, make.text, make.parts, call, target)
            if last and not cpp:
                yield from ((name, call) for name in self._list_made_in_python(fn, call, last))
        yield from self._list_made_by_members(fn)
        for each in fn.facts.assignments:
            value = each.value
            base = code.find_base_made(fn, each) if each.target.startswith("this.") else None
            if base is not None:
                yield base[0], _make_call(FlowType(base[0]), *base, each, "")
                continue
            for make in _list_nested(value) if value.parts or value.kind == "make" else ():
                # A pointer that is declared alone makes nothing.
                if make.text and (make.parts or not make.text.endswith("*")):
                    kind = code.resolve_written(make.text, source, scope)
                    yield _find_known_name(kind), _make_call(kind, make.text, make.parts, each, each.target)
            if value.kind == "make" and value.text:
                continue
            whole = value.kind in ("list", "make")
            if whole or (value.kind in ("name", "text", "call") and each.target.startswith("this.")):
                kind = self._find_initialised_type(fn, each.target)
                given = value.parts if whole else (value,)
                yield _find_known_name(kind), _make_call(kind, kind.name, given, each, each.target)

    def _list_made_by_members(self, fn: Fn) -> Iterator[tuple[str, FlowCall]]:
        """Members that a class has by value, or makes where they stand, and that its constructors do not initialise,
        listed once."""
        owner = self.code.find_owner(fn) if fn.source.facts.language == "cpp" and fn.facts.owner else None
        if owner is None:
            return
        known = self._makers.get(owner)
        if known is None:
            functions = self.code.list_functions(owner)
            constructors = [one for one in functions if get_tail(one.name) == get_tail(owner.name)]
            # A class without a constructor of its own has them made by whatever makes it.
            known = self._makers[owner] = next(iter(constructors or functions), None), constructors
        maker, constructors = known
        if maker is not fn:
            return
        begun = {each.target for one in constructors for each in one.facts.assignments}
        for member in owner.facts.members:
            target = f"this.{member.name}"
            given = member.value
            if given is not None and given.kind == "make" and given.text and target not in begun:
                kind = self.code.resolve_written(given.text, owner.source, owner.name)
                types = ", ".join(kind.arguments)
                yield _find_known_name(kind), FlowCall(kind.name, given.parts, member.line, 0, -1, types, target)
            elif member.value is None and target not in begun and "*" not in member.type and "&" not in member.type:
                kind = self.code.resolve_written(member.type, owner.source, owner.name)
                # What is left is a pointer: `Client<T>::SharedPtr`.
                whole = "<" not in member.type or member.type.rstrip().endswith(">")
                if whole and parse_flow_type(member.type).name == member.type.partition("<")[0]:
                    types = ", ".join(kind.arguments)
                    yield _find_known_name(kind), FlowCall(kind.name, (), fn.facts.line, 0, -1, types, target)

    def _list_made_in_python(self, fn: Fn, call: FlowCall, last: str) -> Iterator[str]:
        if call.callee == "super().__init__":
            owner = self.code.find_owner(fn)
            yield from self.code.list_base_names(owner) if owner else ()
        elif last[:1].isupper():
            yield self.code.resolve_name(call.callee, fn.source)
        elif last == "__init__":
            yield self.code.resolve_name(get_outer(call.callee), fn.source)

    def _find_initialised_type(self, fn: Fn, target: str) -> FlowType:
        variable = self.code.identify(target, fn)
        text, source, scope = self.code.find_declared_type(variable, fn)
        return self.code.resolve_written(text, source, scope) if text else FlowType("")

    def find_argument(self, use: FrameworkCall, spots: tuple[Spot, ...]) -> FlowExpr | None:
        """The first of some spots that a use has."""
        call = use.call
        positional = [argument for argument in call.arguments if argument.kind != "keyword"]
        for spot in spots:
            if isinstance(spot, int):
                if spot < len(positional):
                    return positional[spot]
            elif spot.startswith("="):
                return FlowExpr("text", spot[1:])
            elif spot.startswith("text "):
                place = int(spot[5:])
                if place < len(positional) and self.is_textual(positional[place], use.fn):
                    return positional[place]
            elif spot.startswith("<"):
                continue
            elif spot == "after topic":
                topic = self.find_argument(use, use.row.topic)
                place = positional.index(topic) + 1 if topic in positional else len(positional)
                if place < len(positional):
                    return positional[place]
            else:
                for argument in call.arguments:
                    if argument.kind == "keyword" and argument.text == spot and argument.parts:
                        return argument.parts[0]
        return None

    def is_textual(self, value: FlowExpr, fn: Fn) -> bool:
        """Whether an expression shows itself to be a string."""
        if value.kind in ("text", "join"):
            return True
        kind = self.code.resolve_type(value, fn).name
        if value.kind == "make":
            return get_tail(kind) == "string"
        return get_tail(kind) in ("string", "str", "char") or (
            not kind
            and value.kind in ("name", "call")
            and any(part in value.text.lower() for part in ("name", "topic"))
        )

    def get_template_argument(self, use: FrameworkCall, number: int) -> str:
        """A template argument as written, empty when there is none."""
        arguments = split_at_commas(use.call.types) if use.call.types else []
        return arguments[number] if number < len(arguments) else ""

    def get_receiver(self, use: FrameworkCall) -> str:
        """The receiver of a method's call as written, empty for none."""
        callee = use.call.callee
        return callee.rpartition(".")[0] if "." in callee else ""

    def find_kept_variable(self, use: FrameworkCall) -> Variable | None:
        """The variable that a use's result is kept in."""
        return self.code.identify(use.call.target, use.fn) if use.call.target else None


_STAND_FOR_NODES = frozenset(("node", "handle", "image_transport", "cloud_transport"))
_NODES = frozenset(("node", "nh", "n", "pnh", "private_nh", "node_handle", "nodehandle", "parent", "node_ptr"))


def _find_known_name(kind: FlowType) -> str:
    """The name of a type; of a class of the code the whole one, so that it is not taken for another's of that name: of
    one in no namespace, that derives from nothing, with `::` before it."""
    cls = kind.cls
    if cls is None or cls.source.facts.language != "cpp":
        return kind.name
    if "::" in cls.name:
        return cls.name
    return kind.name if cls.facts.bases else f"::{cls.name}"


def _make_call(
    kind: FlowType, name: str, arguments: tuple[FlowExpr, ...], at: FlowCall | Assignment, target: str
) -> FlowCall:  # fmt: skip
    """The call that makes an object where something else stands."""
    column = at.column if isinstance(at, FlowCall) else 0
    return FlowCall(name, arguments, at.line, column, at.guard, ", ".join(kind.arguments), target)


def _list_nested(value: FlowExpr, depth: int = 0) -> list[FlowExpr]:
    if value.kind == "make":
        # `boost::shared_ptr<T> x(new T(...))` makes a T.
        inner = value.parts[0] if len(value.parts) == 1 else None
        held = inner is not None and inner.kind == "make" and inner.text and is_pointer(value.text)
        return [inner] if inner is not None and held else [value]
    found: list[FlowExpr] = []
    for part in value.parts if depth < 3 and value.kind in ("call", "choice", "bind", "list") else ():
        if part.parts or part.kind == "make":
            found += _list_nested(part, depth + 1)
    return found
