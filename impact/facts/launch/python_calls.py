"""What the calls of a launch file in Python make: a row of MAKERS for each.

They make actions, substitutions and conditions of launch and launch_ros, paths, and what the few functions of the
standard library give that put these together.
"""

from __future__ import annotations

import ast
import json
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

from .actions import Action, Condition, Piece, Value, literal, named, other, plain, together
from .python_values import (
    NOTHING,
    Asked,
    Constant,
    Context,
    Either,
    FilledFile,
    Function,
    Guarded,
    Items,
    Module,
    Pairs,
    Text,
    Typed,
    Unknown,
    YamlContent,
    all_of,
    folder_of,
    source_of,
)

if TYPE_CHECKING:
    from .python import Walker

MOST_TURNS = 200


class Call(NamedTuple):
    """A call of a known name. path: as imported."""

    node: ast.Call
    path: str
    arguments: list[Any]
    keywords: dict[str, Any]

    def get(self, place: int, *names: str) -> Any:
        """The argument of a name, or at a place (-1 for none); None when it is not given."""
        for name in names:
            if name in self.keywords:
                return self.keywords[name]
        return self.arguments[place] if 0 <= place < len(self.arguments) else None


class _Making(NamedTuple):
    """What a maker of actions needs: the walker and the call."""

    walker: Walker
    call: Call

    def texts(self, value: Any) -> list[Value]:
        """A list of texts, one each."""
        if isinstance(value, Items):
            return [
                self.walker.text(item.value if isinstance(item, Guarded) else item, self.call.node)
                for item in value.items
            ]
        return [self.walker.text(value, self.call.node)]

    def attributes(self, *wanted: tuple[str, Any]) -> list[tuple[str, Value]]:
        given = [(key, value) for key, value in wanted if value is not None and value != Constant(None)]
        return [(key, self.walker.text(value, self.call.node)) for key, value in given]

    def conditions(self) -> tuple[Condition, ...]:
        given = self.call.keywords.get("condition")
        if given is None or given == Constant(None):
            return ()
        line = self.call.node.lineno
        if isinstance(given, Asked):
            return given.conditions
        if isinstance(given, Either):
            return (Condition("if", (other(_keyword_source(self.call.node, "condition")),), line),)
        source = given.source if isinstance(given, Unknown) else _keyword_source(self.call.node, "condition")
        return (Condition("if", (other(source),), line),)

    def remaps(self, value: Any, extra: tuple[Condition, ...] = ()) -> Iterator[Action]:
        line = self.call.node.lineno
        if isinstance(value, Guarded):
            yield from self.remaps(value.value, (*extra, *value.conditions))
        elif isinstance(value, Either):
            yield from self.remaps(value.yes, (*extra, Condition("if", value.condition, line)))
            yield from self.remaps(value.no, (*extra, Condition("unless", value.condition, line)))
        elif isinstance(value, Items):
            items = value.items
            first = items[0] if len(items) == 2 else None
            of_tuples = isinstance(first, Items) and first.kind == "tuple"
            pair = isinstance(first, Text) or (value.kind == "tuple" and first is not None and not of_tuples)
            if pair:
                old, new = (self.walker.text(item, self.call.node) for item in items)
                yield Action("remap", line, (("from", old), ("to", new)), extra)
                return
            for item in items:
                yield from self.remaps(item, extra)
        elif isinstance(value, Pairs):
            for old, new in value.items:
                yield from self.remaps(Items([old, new], 0, "tuple"), extra)
        elif value is not None and value != Constant(None):
            source = value.source if isinstance(value, Unknown) else _keyword_source(self.call.node, "remappings")
            yield Action("unknown", line, (("text", (other(f"remappings: {source}"),)),), extra)

    def parameters(self, value: Any, extra: tuple[Condition, ...] = ()) -> Iterator[Action]:
        line = self.call.node.lineno
        if isinstance(value, Guarded):
            yield from self.parameters(value.value, (*extra, *value.conditions))
        elif isinstance(value, Either):
            yield from self.parameters(value.yes, (*extra, Condition("if", value.condition, line)))
            yield from self.parameters(value.no, (*extra, Condition("unless", value.condition, line)))
        elif isinstance(value, Items):
            for item in value.items:
                yield from self.parameters(item, extra)
        elif isinstance(value, Pairs):
            for key, held in value.items:
                yield from self.one(self.walker.text(key, self.call.node), held, extra)
        elif isinstance(value, Text):
            yield Action("parameter-file", line, (("file", value.value),), extra)
        elif isinstance(value, YamlContent):
            yield self.below(value, None, extra)
        elif isinstance(value, FilledFile):
            yield Action("parameter-file", line, (("file", value.value), ("substitute", literal("true"))), extra)
        elif isinstance(value, Unknown):
            yield Action("unknown", line, (("text", (other(f"parameters: {value.source}"),)),), extra)
        elif value is not None and value != Constant(None):
            source = _keyword_source(self.call.node, "parameters")
            yield Action("unknown", line, (("text", (other(f"parameters: {source}"),)),), extra)

    def below(self, value: YamlContent, name: Value | None, extra: tuple[Condition, ...]) -> Action:
        """The values of a YAML file that is loaded by the launch file, under a name if one is given."""
        attributes = [("file", value.file), *(("below", key) for key in value.keys)]
        if name is not None:
            attributes.append(("name", name))
        return Action("parameter-file", self.call.node.lineno, tuple(attributes), extra)

    def one(self, name: Value, value: Any, extra: tuple[Condition, ...]) -> Iterator[Action]:
        """A parameter, or those of a nested dict."""
        line = self.call.node.lineno
        if isinstance(value, Guarded):
            yield from self.one(name, value.value, (*extra, *value.conditions))
        elif isinstance(value, Pairs):
            for key, held in value.items:
                yield from self.one(together([name, literal("."), self.walker.text(key, self.call.node)]), held, extra)
        elif isinstance(value, YamlContent):
            yield self.below(value, name, extra)
        else:
            text, type_ = self.typed(value)
            attributes = [("name", name), ("value", text)]
            if type_:
                attributes.append(("type", literal(type_)))
            yield Action("parameter", line, tuple(attributes), extra)

    def typed(self, value: Any) -> tuple[Value, str]:
        """A parameter's value and type; no type where YAML's rules decide, as for substitutions."""
        node = self.call.node
        if isinstance(value, Typed):
            return self.walker.text(value.value, node), value.type
        if isinstance(value, Constant):
            type_ = _TYPES.get(type(value.value).__name__, "")
            return self.walker.text(value, node), type_
        if isinstance(value, Text):
            return value.value, "str" if value.is_str else ""
        if isinstance(value, Items):
            # A list of substitutions is one text; a list of values is a list.
            if any(isinstance(item, Text) and not item.is_str for item in value.items):
                return self.walker.text(value, node), ""
            parts: list[Value] = []
            for item in value.items:
                text = self.walker.text(item, node)
                known = plain(text) if isinstance(item, Text) else None
                parts += (
                    literal(", ") if parts else literal(""),
                    literal(json.dumps(known)) if known is not None else text,
                )
            return together([literal("["), *parts, literal("]")]), "list"
        return self.walker.text(value, node), ""


_TYPES = {"bool": "bool", "int": "int", "float": "double", "str": "str"}


def _keyword_source(node: ast.Call, name: str) -> str:
    return next((source_of(keyword.value) for keyword in node.keywords if keyword.arg == name), name)


def _node(kind: str) -> Callable[[Walker, Call], Any]:
    def make(walker: Walker, call: Call) -> Any:
        making = _Making(walker, call)
        attributes = making.attributes(
            ("package", call.get(-1, "package")),
            ("plugin", call.get(-1, "plugin", "node_plugin")),
            ("executable", call.get(-1, "executable", "node_executable")),
            ("name", call.get(-1, "name", "node_name")),
            ("namespace", call.get(-1, "namespace", "node_namespace")),
        )
        for key in ("arguments", "ros_arguments"):
            given = call.get(-1, key)
            if given is not None and given != Constant(None):
                if key == "ros_arguments":
                    attributes.append(("arguments", literal("--ros-args")))
                attributes += [("arguments", text) for text in making.texts(given)]
        children = [*making.remaps(call.get(-1, "remappings")), *making.parameters(call.get(-1, "parameters"))]
        inner = call.get(-1, "composable_node_descriptions")
        if kind == "container" and inner is not None:
            children += walker.actions(inner, call.node.lineno)
        return Action(kind, call.node.lineno, tuple(attributes), making.conditions(), tuple(children))

    return make


def _load(walker: Walker, call: Call) -> Any:
    making = _Making(walker, call)
    target = call.get(1, "target_container")
    if isinstance(target, Action):
        name = target.get("name") or (other(_keyword_source(call.node, "target_container")),)
        space = target.get("namespace")
        full = together([space, literal("/"), name]) if space is not None and plain(space) != "" else name
        attributes = [("container-node", full)]
    else:
        attributes = making.attributes(("container", target))
    children = tuple(walker.actions(call.get(0, "composable_node_descriptions"), call.node.lineno))
    return Action("load", call.node.lineno, tuple(attributes), making.conditions(), children)


def _simple(kind: str, *names: tuple[str, int, str]) -> Callable[[Walker, Call], Any]:
    """An action of nothing but attributes: (attribute, place, keyword) each."""

    def make(walker: Walker, call: Call) -> Any:
        making = _Making(walker, call)
        attributes = making.attributes(*((key, call.get(place, keyword)) for key, place, keyword in names))
        return Action(kind, call.node.lineno, tuple(attributes), making.conditions())

    return make


def _set_parameter(walker: Walker, call: Call) -> Any:
    making = _Making(walker, call)
    found = list(making.one(walker.text(call.get(0, "name"), call.node), call.get(1, "value"), ()))
    made = [Action(a.kind, a.line, a.attributes, (*making.conditions(), *a.conditions)) for a in found]
    return made[0] if len(made) == 1 else Items(made, len(walker.conditions))


def _sim_time(walker: Walker, call: Call) -> Any:
    text, type_ = _Making(walker, call).typed(call.get(0, "value"))
    attributes = (("name", literal("use_sim_time")), ("value", text), ("type", literal(type_ or "bool")))
    return Action("parameter", call.node.lineno, attributes, _Making(walker, call).conditions())


def _group(walker: Walker, call: Call) -> Any:
    making = _Making(walker, call)
    line = call.node.lineno
    attributes = making.attributes(("scoped", call.get(-1, "scoped")), ("forwarding", call.get(-1, "forwarding")))
    lets: list[Action] = []
    configurations = call.get(-1, "launch_configurations")
    if isinstance(configurations, Pairs):
        for key, value in configurations.items:
            pair = (("name", walker.text(key, call.node)), ("value", walker.text(value, call.node)))
            lets.append(Action("let", line, pair))
    children = (*lets, *walker.actions(call.get(0, "actions"), line))
    return Action("group", line, tuple(attributes), making.conditions(), children)


def _include(walker: Walker, call: Call) -> Any:
    making = _Making(walker, call)
    source = call.get(0, "launch_description_source")
    if isinstance(source, Items) and source.is_launch:
        return Action("group", call.node.lineno, (("scoped", literal("false")),), making.conditions(),
                      tuple(walker.actions(source, call.node.lineno)))  # fmt: skip
    attributes = making.attributes(("file", source))
    children = tuple(_passed(making, call.get(1, "launch_arguments"), ()))
    return Action("include", call.node.lineno, tuple(attributes), making.conditions(), children)


def _passed(making: _Making, value: Any, extra: tuple[Condition, ...]) -> Iterator[Action]:
    """Arguments given to an include: pairs, or a dict."""
    line = making.call.node.lineno
    if isinstance(value, Guarded):
        yield from _passed(making, value.value, (*extra, *value.conditions))
    elif isinstance(value, Either):
        yield from _passed(making, value.yes, (*extra, Condition("if", value.condition, line)))
        yield from _passed(making, value.no, (*extra, Condition("unless", value.condition, line)))
    elif isinstance(value, Pairs):
        for key, held in value.items:
            yield from _passed(making, Items([key, held], 0), extra)
    elif isinstance(value, Items):
        items = value.items
        if len(items) == 2 and isinstance(items[0], Text):
            extra_value = items[1]
            if isinstance(extra_value, Guarded):
                extra, extra_value = (*extra, *extra_value.conditions), extra_value.value
            name, text = (making.walker.text(item, making.call.node) for item in (items[0], extra_value))
            yield Action("pass", line, (("name", name), ("value", text)), extra)
        else:
            for item in items:
                yield from _passed(making, item, extra)
    elif value is not None and value != Constant(None):
        source = value.source if isinstance(value, Unknown) else _keyword_source(making.call.node, "launch_arguments")
        yield Action("unknown", line, (("text", (other(f"launch arguments: {source}"),)),), extra)


def _opaque(walker: Walker, call: Call) -> Any:
    making = _Making(walker, call)
    function = call.get(0, "function")
    line = call.node.lineno
    if not isinstance(function, Function):
        source = _keyword_source(call.node, "function") if call.keywords else source_of(call.node)
        return Action("unknown", line, (("text", (other(f"OpaqueFunction({source})"),)),), making.conditions())
    args, kwargs = call.get(-1, "args"), call.get(-1, "kwargs")
    given = list(args.items) if isinstance(args, Items) else []
    named_ = (
        {plain(k.value) or "": v for k, v in kwargs.items if isinstance(k, Text)} if isinstance(kwargs, Pairs) else {}
    )
    result = walker.call_function(function, [Context(), *given], named_)
    children = tuple(walker.actions(result, line))
    if not children and not making.conditions():
        return Items([], len(walker.conditions))
    return Action("group", line, (("scoped", literal("false")),), making.conditions(), children)


def _for_each(walker: Walker, call: Call) -> Any:
    """ForEach and ForLoop: what their function makes, for each of what is only known at launch."""
    making = _Making(walker, call)
    function = call.get(1, "function")
    if not isinstance(function, Function):
        return Unknown(source_of(call.node))
    line = call.node.lineno
    each = Condition("each", (other(source_of(call.node)),), line)
    children = tuple(walker.actions(walker.call_function(function, [], {}), line))
    return Action("group", line, (("scoped", literal("false")),), (*making.conditions(), each), children)


def _timer(walker: Walker, call: Call) -> Any:
    making = _Making(walker, call)
    line = call.node.lineno
    period = together([walker.text(call.get(-1, "period"), call.node), literal(" s")])
    children = tuple(walker.actions(call.get(-1, "actions"), line))
    conditions = (*making.conditions(), Condition("after", period, line))
    return Action("group", line, (("scoped", literal("false")),), conditions, children)


def _handler(walker: Walker, call: Call) -> Any:
    """An event handler: its actions, under the event."""
    event = call.path.rpartition(".")[2]
    held: list[Action] = []
    for key in (
        "on_exit",
        "on_start",
        "entities",
        "on_completion",
        "on_shutdown",
        "on_stdout",
        "on_stderr",
        "on_output",
    ):
        value = call.get(-1, key)
        if isinstance(value, Function):
            value = walker.call_function(value, [Unknown("event"), Context()], {})
        if value is not None:
            held += walker.actions(value, call.node.lineno)
    after = (Condition("after", literal(event), call.node.lineno),)
    return Action("group", call.node.lineno, (("scoped", literal("false")),), after, tuple(held))


def _register(walker: Walker, call: Call) -> Any:
    handler = call.get(0, "event_handler")
    if isinstance(handler, Action):
        if not handler.children:
            return Items([], len(walker.conditions))
        conditions = (*_Making(walker, call).conditions(), *handler.conditions)
        return Action(handler.kind, handler.line, handler.attributes, conditions, handler.children)
    return handler if handler is not None else Unknown(source_of(call.node))


def _process(walker: Walker, call: Call) -> Any:
    making = _Making(walker, call)
    command = [("command", text) for text in making.texts(call.get(-1, "cmd"))]
    return Action("process", call.node.lineno, tuple(command), making.conditions())


def _description(walker: Walker, call: Call) -> Any:
    given = call.get(0, "initial_entities")
    made = Items([], len(walker.conditions), "launch")
    if isinstance(given, Items):
        made.items = list(given.items)
    elif given is not None and given != Constant(None):
        made.items = [given]
    return made


def _idle(walker: Walker, call: Call) -> Any:
    return NOTHING


def _condition(kind: str) -> Callable[[Walker, Call], Any]:
    def make(walker: Walker, call: Call) -> Any:
        value = walker.text(call.get(0, "predicate_expression"), call.node)
        return Asked((Condition(kind, value, call.node.lineno),))

    return make


def _configuration_is(kind: str) -> Callable[[Walker, Call], Any]:
    def make(walker: Walker, call: Call) -> Any:
        name = walker.text(call.get(0, "launch_configuration_name"), call.node)
        expected = call.get(1, "expected_value")
        value = (Piece("equals", "", ((named("arg", name),), walker.text(expected, call.node))),)
        return Asked((Condition(kind, value, call.node.lineno),))

    return make


def _substitution(kind: str, *names: tuple[int, str]) -> Callable[[Walker, Call], Any]:
    """A substitution with a name, the first of its arguments, and what else it is given."""

    def make(walker: Walker, call: Call) -> Any:
        given = [call.get(place, keyword) for place, keyword in names]
        if given[0] is None:
            return Unknown(source_of(call.node))
        values = [walker.text(value, call.node) for value in given if value is not None and value != Constant(None)]
        return Text((named(kind, values[0], *values[1:]),), False)

    return make


def _share(walker: Walker, call: Call) -> Any:
    given = call.get(0, "package_name", "package")
    if given is None:
        return Unknown(source_of(call.node))
    kind = "prefix" if call.path.endswith("prefix") else "find"
    return Text((named(kind, walker.text(given, call.node)),))


def _parts(kind: str, is_str: bool) -> Callable[[Walker, Call], Any]:
    """A substitution of several values, given each or as one list."""

    def make(walker: Walker, call: Call) -> Any:
        given = [*call.arguments, *call.keywords.values()]
        if len(given) == 1 and isinstance(given[0], Items):
            given = given[0].items
        return Text((Piece(kind, "", tuple(walker.text(value, call.node) for value in given)),), is_str)

    return make


def _path_join(walker: Walker, call: Call) -> Any:
    # os.path.join and not str.join, whose receiver is no module
    return _parts("join", True)(walker, call) if call.path.endswith("path.join") else Unknown(source_of(call.node))


def _first(is_str: bool) -> Callable[[Walker, Call], Any]:
    """A wrapper through which its first argument passes."""

    def make(walker: Walker, call: Call) -> Any:
        given = call.get(0, "text", "launch_file_path", "variable")
        if given is None:
            return Unknown(source_of(call.node))
        if isinstance(given, Text):
            return Text(given.value, is_str)
        return Text(walker.text(given, call.node), is_str)

    return make


def _path(walker: Walker, call: Call) -> Any:
    if len(call.arguments) > 1:
        return _parts("join", True)(walker, call)
    return _first(True)(walker, call)


def _str(walker: Walker, call: Call) -> Any:
    given = call.get(0, "object")
    return given if isinstance(given, Text) and given.is_str else Text(walker.text(given, call.node))


def _performed(walker: Walker, call: Call) -> Any:
    given = call.get(1, "subs")
    return Unknown(source_of(call.node)) if given is None else Text(walker.text(given, call.node))


def _dirname(walker: Walker, call: Call) -> Any:
    given = call.get(0, "p")
    return Text(folder_of(given.value)) if isinstance(given, Text) else Unknown(source_of(call.node))


def _environment(walker: Walker, call: Call) -> Any:
    """os.getenv() and os.environ.get()."""
    if not call.path.endswith(("os.getenv", "environ.get")):
        return Unknown(source_of(call.node))
    key, default = call.get(0, "key", "varname"), call.get(1, "default")
    if key is None:
        return Unknown(source_of(call.node))
    given = [walker.text(value, call.node) for value in (key, default) if value not in (None, Constant(None))]
    return Text((named("env", *given),))


def _executable(walker: Walker, call: Call) -> Any:
    given = (call.get(0, "executable"), call.get(1, "package"))
    return Text((Piece("executable", "", tuple(walker.text(value, call.node) for value in given)),), False)


def _expression(walker: Walker, call: Call) -> Any:
    given = call.get(0, "expression")
    return Text((Piece("eval", "launch", (walker.text(given, call.node),)),), False)


def _command(walker: Walker, call: Call) -> Any:
    given = call.get(0, "command")
    return Text((Piece("command", "", (walker.text(given, call.node),)),), False)


def _not_equals(walker: Walker, call: Call) -> Any:
    return Text((Piece("not", "", (_parts("equals", False)(walker, call).value,)),), False)


def _parameter_value(walker: Walker, call: Call) -> Any:
    type_ = call.get(1, "value_type")
    name = type_.path if isinstance(type_, Module) else ""
    return Typed(call.get(0, "value"), _TYPES.get(name, ""))


def _parameter_file(walker: Walker, call: Call) -> Any:
    value = walker.text(call.get(0, "param_file"), call.node)
    allow = call.get(-1, "allow_substs")
    return Text(value, False) if allow is None or allow == Constant(False) else FilledFile(value)


def _content(walker: Walker, call: Call) -> Any:
    """The content of a file: open() and FileContent."""
    return Text((Piece("content", "", (walker.text(call.get(0, "file"), call.node),)),))


def _loaded(walker: Walker, call: Call) -> Any:
    """yaml.safe_load() of an open file."""
    given = call.get(0, "stream")
    if isinstance(given, Text) and len(given.value) == 1 and given.value[0].kind == "content":
        return YamlContent(given.value[0].parts[0])
    return Unknown(source_of(call.node))


def _boolean_argument(walker: Walker, call: Call) -> Any:
    """DeclareBooleanLaunchArg of moveit_configs_utils: its default is given as a bool."""
    making = _Making(walker, call)
    default = call.get(1, "default_value")
    attributes = making.attributes(("name", call.get(0, "name")), ("default", default))
    return Action("argument", call.node.lineno, tuple(attributes), making.conditions())


def _has_node(walker: Walker, call: Call) -> Any:
    """HasNodeParams of nav2_common."""
    given = (call.get(0, "source_file"), call.get(1, "node_name"))
    return Text((Piece("has-node", "", tuple(walker.text(value, call.node) for value in given)),), False)


def _rewritten(walker: Walker, call: Call) -> Any:
    """RewrittenYaml of nav2_common."""
    parts = [walker.text(call.get(0, "source_file"), call.node)]
    root = call.get(2, "root_key")
    parts.append(walker.text(root, call.node) if root is not None else literal(""))
    rewrites = call.get(1, "param_rewrites")
    if isinstance(rewrites, Pairs):
        for key, value in rewrites.items:
            held = value.value if isinstance(value, Guarded) else value
            parts += (walker.text(key, call.node), walker.text(held, call.node))
    value = (Piece("rewritten", "", tuple(parts)),)
    # Values that stand for others, wherever they are
    values = call.get(-1, "value_rewrites")
    pairs = values.items if isinstance(values, Pairs) else []
    if pairs:
        replaced = [walker.text(item, call.node) for pair in pairs for item in pair]
        value = (Piece("replaced", "", (value, *replaced)),)
    return Text(value, False)


def _replaced(walker: Walker, call: Call) -> Any:
    """ReplaceString of nav2_common."""
    parts = [walker.text(call.get(0, "source_file"), call.node)]
    replacements = call.get(1, "replacements")
    if isinstance(replacements, Pairs):
        for key, value in replacements.items:
            parts += (walker.text(key, call.node), walker.text(value, call.node))
    value = (Piece("replaced", "", tuple(parts)),)
    asked = _Making(walker, call).conditions()
    return Text((Piece("choose", "", (all_of(asked), value, parts[0])),) if asked else value, False)


def _range(walker: Walker, call: Call) -> Any:
    bounds = [value.value for value in call.arguments if isinstance(value, Constant) and isinstance(value.value, int)]
    if len(bounds) != len(call.arguments) or not 1 <= len(bounds) <= 3 or (len(bounds) == 3 and bounds[2] == 0):
        return Unknown(source_of(call.node))
    numbers = range(*bounds)
    if len(numbers) > MOST_TURNS:
        return Unknown(source_of(call.node))
    return Items([Constant(number) for number in numbers], len(walker.conditions))


def _enumerated(walker: Walker, call: Call) -> Any:
    turns = walker.turns(call.get(0, "iterable"))
    start = call.get(1, "start")
    first = start.value if isinstance(start, Constant) and isinstance(start.value, int) else 0
    if turns is None or any(isinstance(turn, Guarded) for turn in turns):
        return Unknown(source_of(call.node))
    depth = len(walker.conditions)
    return Items([Items([Constant(n), turn], depth) for n, turn in enumerate(turns, first)], depth)


def _zipped(walker: Walker, call: Call) -> Any:
    lists = [walker.turns(argument) for argument in call.arguments]
    if any(items is None or any(isinstance(item, Guarded) for item in items) for items in lists):
        return Unknown(source_of(call.node))
    depth = len(walker.conditions)
    return Items([Items(list(row), depth) for row in zip(*(items or [] for items in lists), strict=False)], depth)


def _listed(walker: Walker, call: Call) -> Any:
    given = call.get(0, "iterable")
    if given is None:
        return Items([], len(walker.conditions))
    turns = walker.turns(given)
    return Unknown(source_of(call.node)) if turns is None else Items(list(turns), len(walker.conditions))


def _dict(walker: Walker, call: Call) -> Any:
    made = Pairs([], len(walker.conditions))
    given = call.get(0)
    if isinstance(given, Pairs):
        made.items = list(given.items)
    elif isinstance(given, Items) and all(isinstance(i, Items) and len(i.items) == 2 for i in given.items):
        made.items = [(pair.items[0], pair.items[1]) for pair in given.items]
    elif given is not None:
        return Unknown(source_of(call.node))
    for key, value in call.keywords.items():
        made.set(Text(literal(key)), value)
    return made


def _length(walker: Walker, call: Call) -> Any:
    given = call.get(0)
    if isinstance(given, (Items, Pairs)) and not any(isinstance(item, Guarded) for item in given.items):
        return Constant(len(given.items))
    return Unknown(source_of(call.node))


def _copied(walker: Walker, call: Call) -> Any:
    given = call.get(0)
    if isinstance(given, Items):
        return Items(list(given.items), len(walker.conditions), given.kind)
    return Pairs(list(given.items), len(walker.conditions)) if isinstance(given, Pairs) else given


MAKERS: dict[str, Callable[[Walker, Call], Any]] = {
    "LaunchDescription": _description,
    "Node": _node("node"),
    "LifecycleNode": _node("lifecycle"),
    "ComposableNodeContainer": _node("container"),
    "ComposableNode": _node("composable"),
    "ComposableLifecycleNode": _node("composable"),
    "LoadComposableNodes": _load,
    "DeclareLaunchArgument": _simple("argument", ("name", 0, "name"), ("default", 1, "default_value")),
    "SetLaunchConfiguration": _simple("let", ("name", 0, "name"), ("value", 1, "value")),
    "PushRosNamespace": _simple("namespace", ("namespace", 0, "namespace")),
    "PushROSNamespace": _simple("namespace", ("namespace", 0, "namespace")),
    "SetRemap": _simple("remap", ("from", 0, "src"), ("to", 1, "dst")),
    "SetEnvironmentVariable": _simple("environment", ("name", 0, "name"), ("value", 1, "value")),
    "SetParametersFromFile": _simple("parameter-file", ("file", 0, "filename")),
    "SetParameter": _set_parameter,
    "SetUseSimTime": _sim_time,
    "GroupAction": _group,
    "IncludeLaunchDescription": _include,
    "OpaqueFunction": _opaque,
    "TimerAction": _timer,
    "RosTimer": _timer,
    "RegisterEventHandler": _register,
    "ExecuteProcess": _process,
    "ExecuteLocal": _process,
    **dict.fromkeys(
        ("OnProcessExit", "OnProcessStart", "OnProcessIO", "OnStateTransition", "OnShutdown", "OnExecutionComplete",
         "EventHandler", "OnActionEventBase"),
        _handler,
    ),
    **dict.fromkeys(
        ("LogInfo", "EmitEvent", "Shutdown", "UnsetEnvironmentVariable", "UnsetLaunchConfiguration",
         "AppendEnvironmentVariable", "PrependEnvironmentVariable", "SetROSLogDir", "LifecycleTransition",
         "ReadyToTest", "KeepAliveProc", "print", "ResetEnvironment", "PushEnvironment", "PopEnvironment"),
        _idle,
    ),
    "IfCondition": _condition("if"),
    "UnlessCondition": _condition("unless"),
    "LaunchConfigurationEquals": _configuration_is("if"),
    "LaunchConfigurationNotEquals": _configuration_is("unless"),
    "LaunchConfiguration": _substitution("arg", (0, "variable_name"), (1, "default")),
    "LaunchConfigAsBool": _substitution("arg", (0, "name")),
    "EnvironmentVariable": _substitution("env", (0, "name"), (1, "default_value")),
    "OptEnvironmentVariable": _substitution("env", (0, "name"), (1, "default_value")),
    "AnonName": _substitution("anon", (0, "name")),
    "FindPackageShare": _substitution("find", (0, "package")),
    "FindPackagePrefix": _substitution("prefix", (0, "package")),
    "FindPackage": _substitution("prefix", (0, "package")),
    "FindExecutable": _substitution("program", (0, "name")),
    "get_package_share_directory": _share,
    "get_package_share_path": _share,
    "get_package_prefix": _share,
    "ExecutableInPackage": _executable,
    "PathJoinSubstitution": _parts("join", False),
    "ThisLaunchFileDir": lambda walker, call: Text((Piece("dirname"),), False),
    "ThisLaunchFile": lambda walker, call: Text((Piece("filename"),), False),
    "PythonExpression": _expression,
    "Command": _command,
    "EqualsSubstitution": _parts("equals", False),
    "NotEqualsSubstitution": _not_equals,
    "NotSubstitution": _parts("not", False),
    "AndSubstitution": _parts("and", False),
    "OrSubstitution": _parts("or", False),
    "AllSubstitution": _parts("and", False),
    "AnySubstitution": _parts("or", False),
    "IfElseSubstitution": lambda walker, call: Text((Piece("choose", "", tuple(
        walker.text(value, call.node) if value is not None else literal("")
        for value in (call.get(0, "condition"), call.get(1, "if_value"), call.get(2, "else_value")))),), False),
    "TextSubstitution": _first(True),
    **dict.fromkeys(
        ("PythonLaunchDescriptionSource", "AnyLaunchDescriptionSource", "FrontendLaunchDescriptionSource",
         "XMLLaunchDescriptionSource", "YAMLLaunchDescriptionSource"),
        _first(False),
    ),
    "ParameterFile": _parameter_file,
    "ParameterValue": _parameter_value,
    "Parameter": lambda walker, call: Pairs([(call.get(0, "name"), call.get(1, "value"))], len(walker.conditions)),
    "ForEach": _for_each,
    "ForLoop": _for_each,
    "FileContent": _content,
    "open": _content,
    "safe_load": _loaded,
    "full_load": _loaded,
    "load": _loaded,
    "DeclareBooleanLaunchArg": _boolean_argument,
    "HasNodeParams": _has_node,
    "RewrittenYaml": _rewritten,
    "ReplaceString": _replaced,
    "perform_substitutions": _performed,
    "normalize_to_list_of_substitutions": _first(False),
    "join": _path_join,
    "dirname": _dirname,
    "abspath": _first(True),
    "realpath": _first(True),
    "normpath": _first(True),
    "expanduser": _first(True),
    "Path": _path,
    "PurePath": _path,
    "str": _str,
    "getenv": _environment,
    "get": _environment,
    "range": _range,
    "enumerate": _enumerated,
    "zip": _zipped,
    "list": _listed,
    "tuple": _listed,
    "reversed": _listed,
    "sorted": _listed,
    "dict": _dict,
    "len": _length,
    "copy": _copied,
    "deepcopy": _copied,
}  # fmt: skip
