"""What the calls of a launch file in Python make: a row of MAKERS for each.

They make actions, substitutions and conditions of launch and launch_ros, paths, and what the few functions of the
standard library give that put these together.
"""

from __future__ import annotations

import ast
import json
from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

from .actions import Action, ActionCondition, Value, ValuePart, literal, named, other, plain, together
from .python_values import (
    NOTHING,
    ConditionValue,
    Context,
    Either,
    FilledFile,
    Guarded,
    Items,
    LaunchConstant,
    LaunchFunction,
    LaunchModule,
    Pairs,
    TextValue,
    TypedValue,
    Unknown,
    YamlContent,
    all_of,
    folder_of,
    source_of,
)

if TYPE_CHECKING:
    from .python import Walker

MOST_TURNS = 200
_TYPES = {"bool": "bool", "int": "int", "float": "double", "str": "str"}
_UNSCOPED = (("scoped", literal("false")),)


class LaunchCall(NamedTuple):
    """A call of a known name. path: as imported."""

    walker: Walker
    node: ast.Call
    path: str
    arguments: list[Any]
    keywords: dict[str, Any]

    @property
    def line(self) -> int:
        return self.node.lineno

    @property
    def unknown(self) -> Unknown:
        """What the call gives where that is not known."""
        return Unknown(source_of(self.node))

    def get(self, place: int, *names: str) -> Any:
        """The argument of a name, or at a place (-1 for none); None when it is not given."""
        for name in names:
            if name in self.keywords:
                return self.keywords[name]
        return self.arguments[place] if 0 <= place < len(self.arguments) else None

    def source(self, keyword: str) -> str:
        """The source of a keyword argument, its name where it is not given."""
        return next((source_of(each.value) for each in self.node.keywords if each.arg == keyword), keyword)

    def text(self, value: Any) -> Value:
        return self.walker.text(value, self.node)

    def texts(self, value: Any) -> list[Value]:
        """A list of texts, one each."""
        items = value.items if isinstance(value, Items) else [value]
        return [self.text(item.value if isinstance(item, Guarded) else item) for item in items]

    def piece(self, kind: str, *values: Any, is_str: bool = False) -> TextValue:
        """A substitution of several values."""
        return TextValue((ValuePart(kind, "", tuple(self.text(value) for value in values)),), is_str)

    def items(self, items: Iterable[Any], kind: str = "list") -> Items:
        return Items(list(items), len(self.walker.conditions), kind)

    def pairs(self, pairs: Iterable[tuple[Any, Any]] = ()) -> Pairs:
        return Pairs(list(pairs), len(self.walker.conditions))

    def branches(
        self, value: Any, extra: tuple[ActionCondition, ...] = ()
    ) -> Iterator[tuple[Any, tuple[ActionCondition, ...]]]:
        """What a value may be, with the conditions under which it is; nothing for None."""
        if isinstance(value, Guarded):
            yield from self.branches(value.value, (*extra, *value.conditions))
        elif isinstance(value, Either):
            yield from self.branches(value.yes, (*extra, ActionCondition("if", value.condition, self.line)))
            yield from self.branches(value.no, (*extra, ActionCondition("unless", value.condition, self.line)))
        elif is_given(value):
            yield value, extra

    def action(
        self,
        kind: str,
        attributes: Iterable[tuple[str, Value]],
        children: Iterable[Action] = (),
        more: tuple[ActionCondition, ...] = (),
    ) -> Action:
        """An action under the call's own conditions and more."""
        return Action(kind, self.line, tuple(attributes), (*self.conditions(), *more), tuple(children))

    def group(self, children: Iterable[Action], *more: ActionCondition) -> Action:
        """Actions that need no scope of their own."""
        return self.action("group", _UNSCOPED, children, more)

    def actions(self, value: Any) -> Iterator[Action]:
        return self.walker.actions(value, self.line)

    def skip_argument(self, keyword: str, value: Any, extra: tuple[ActionCondition, ...]) -> Action:
        """An argument that cannot be followed."""
        source = value.source if isinstance(value, Unknown) else self.source(keyword)
        text = other(f"{keyword.replace('_', ' ')}: {source}")
        return Action("unknown", self.line, (("text", (text,)),), extra)

    def attributes(self, *wanted: tuple[str, Any]) -> list[tuple[str, Value]]:
        return [(key, self.text(value)) for key, value in wanted if is_given(value)]

    def conditions(self) -> tuple[ActionCondition, ...]:
        given = self.keywords.get("condition")
        if not is_given(given):
            return ()
        if isinstance(given, ConditionValue):
            return given.conditions
        source = given.source if isinstance(given, Unknown) else self.source("condition")
        return (ActionCondition("if", (other(source),), self.line),)

    def remaps(self, value: Any, extra: tuple[ActionCondition, ...] = ()) -> Iterator[Action]:
        for held, conditions in self.branches(value, extra):
            if isinstance(held, Items):
                items = held.items
                first = items[0] if len(items) == 2 else None
                of_tuples = isinstance(first, Items) and first.kind == "tuple"
                if isinstance(first, TextValue) or (held.kind == "tuple" and first is not None and not of_tuples):
                    old, new = map(self.text, items)
                    yield Action("remap", self.line, (("from", old), ("to", new)), conditions)
                    continue
                for item in items:
                    yield from self.remaps(item, conditions)
            elif isinstance(held, Pairs):
                for pair in held.items:
                    yield from self.remaps(Items(list(pair), 0, "tuple"), conditions)
            else:
                yield self.skip_argument("remappings", held, conditions)

    def parameters(self, value: Any, extra: tuple[ActionCondition, ...] = ()) -> Iterator[Action]:
        for held, conditions in self.branches(value, extra):
            if isinstance(held, Items):
                for item in held.items:
                    yield from self.parameters(item, conditions)
            elif isinstance(held, Pairs):
                for key, each in held.items:
                    yield from self.parameter(self.text(key), each, conditions)
            elif isinstance(held, (TextValue, FilledFile)):
                fill = () if isinstance(held, TextValue) else (("substitute", literal("true")),)
                yield Action("parameter-file", self.line, (("file", held.value), *fill), conditions)
            elif isinstance(held, YamlContent):
                yield self.below(held, None, conditions)
            else:
                yield self.skip_argument("parameters", held, conditions)

    def below(self, value: YamlContent, name: Value | None, extra: tuple[ActionCondition, ...]) -> Action:
        """The values of a YAML file that is loaded by the launch file, under a name if one is given."""
        attributes = [("file", value.file), *(("below", key) for key in value.keys)]
        if name is not None:
            attributes.append(("name", name))
        return Action("parameter-file", self.line, tuple(attributes), extra)

    def parameter(self, name: Value, value: Any, extra: tuple[ActionCondition, ...] = ()) -> Iterator[Action]:
        """A parameter, or those of a nested dict."""
        if isinstance(value, Guarded):
            yield from self.parameter(name, value.value, (*extra, *value.conditions))
        elif isinstance(value, Pairs):
            for key, held in value.items:
                yield from self.parameter(together([name, literal("."), self.text(key)]), held, extra)
        elif isinstance(value, YamlContent):
            yield self.below(value, name, extra)
        else:
            text, type_ = self.typed(value)
            typed = (("type", literal(type_)),) if type_ else ()
            yield Action("parameter", self.line, (("name", name), ("value", text), *typed), extra)

    def typed(self, value: Any) -> tuple[Value, str]:
        """A parameter's value and type; no type where YAML's rules decide, as for substitutions."""
        if isinstance(value, TypedValue):
            return self.text(value.value), value.type
        if isinstance(value, LaunchConstant):
            return self.text(value), _TYPES.get(type(value.value).__name__, "")
        if isinstance(value, TextValue):
            return value.value, "str" if value.is_str else ""
        # A list of substitutions is one text; a list of values is a list.
        if not isinstance(value, Items) or any(isinstance(item, TextValue) and not item.is_str for item in value.items):
            return self.text(value), ""
        parts: list[Value] = []
        for item in value.items:
            text = self.text(item)
            known = plain(text) if isinstance(item, TextValue) else None
            parts += (literal(", " if parts else ""), text if known is None else literal(json.dumps(known)))
        return together([literal("["), *parts, literal("]")]), "list"


Maker = Callable[[LaunchCall], Any]


def is_given(value: Any) -> bool:
    """False for an argument that is left out or None."""
    return value is not None and value != LaunchConstant(None)


def _node(kind: str) -> Maker:
    def make(call: LaunchCall) -> Any:
        attributes = call.attributes(
            ("package", call.get(-1, "package")),
            ("plugin", call.get(-1, "plugin", "node_plugin")),
            ("executable", call.get(-1, "executable", "node_executable")),
            ("name", call.get(-1, "name", "node_name")),
            ("namespace", call.get(-1, "namespace", "node_namespace")),
        )
        for key in ("arguments", "ros_arguments"):
            given = call.get(-1, key)
            if is_given(given):
                if key == "ros_arguments":
                    attributes.append(("arguments", literal("--ros-args")))
                attributes += [("arguments", text) for text in call.texts(given)]
        children = [*call.remaps(call.get(-1, "remappings")), *call.parameters(call.get(-1, "parameters"))]
        inner = call.get(-1, "composable_node_descriptions")
        if kind == "container" and inner is not None:
            children += call.actions(inner)
        return call.action(kind, attributes, children)

    return make


def _load(call: LaunchCall) -> Any:
    target = call.get(1, "target_container")
    if isinstance(target, Action):
        name = target.get("name") or (other(call.source("target_container")),)
        space = target.get("namespace")
        full = together([space, literal("/"), name]) if space is not None and plain(space) != "" else name
        attributes = [("container-node", full)]
    else:
        attributes = call.attributes(("container", target))
    return call.action("load", attributes, call.actions(call.get(0, "composable_node_descriptions")))


def _simple(kind: str, *names: tuple[str, int, str]) -> Maker:
    """An action of nothing but attributes: (attribute, place, keyword) each."""
    return lambda call: call.action(
        kind, call.attributes(*((key, call.get(place, keyword)) for key, place, keyword in names))
    )


def _set_parameter(call: LaunchCall) -> Any:
    found = call.parameter(call.text(call.get(0, "name")), call.get(1, "value"))
    made = [Action(a.kind, a.line, a.attributes, (*call.conditions(), *a.conditions)) for a in found]
    return made[0] if len(made) == 1 else call.items(made)


def _sim_time(call: LaunchCall) -> Any:
    text, type_ = call.typed(call.get(0, "value"))
    named_ = ("name", literal("use_sim_time"))
    return call.action("parameter", (named_, ("value", text), ("type", literal(type_ or "bool"))))


def _group(call: LaunchCall) -> Any:
    attributes = call.attributes(("scoped", call.get(-1, "scoped")), ("forwarding", call.get(-1, "forwarding")))
    configurations = call.get(-1, "launch_configurations")
    lets = [
        Action("let", call.line, (("name", call.text(key)), ("value", call.text(value))))
        for key, value in (configurations.items if isinstance(configurations, Pairs) else ())
    ]
    return call.action("group", attributes, (*lets, *call.actions(call.get(0, "actions"))))


def _include(call: LaunchCall) -> Any:
    source = call.get(0, "launch_description_source")
    if isinstance(source, Items) and source.kind == "launch":
        return call.group(call.actions(source))
    return call.action("include", call.attributes(("file", source)), _passed(call, call.get(1, "launch_arguments")))


def _passed(call: LaunchCall, value: Any, extra: tuple[ActionCondition, ...] = ()) -> Iterator[Action]:
    """Arguments given to an include: pairs, or a dict."""
    for held, conditions in call.branches(value, extra):
        if isinstance(held, Pairs):
            for pair in held.items:
                yield from _passed(call, Items(list(pair), 0), conditions)
        elif not isinstance(held, Items):
            yield call.skip_argument("launch_arguments", held, conditions)
        elif len(held.items) == 2 and isinstance(held.items[0], TextValue):
            name, given = held.items
            if isinstance(given, Guarded):
                conditions, given = (*conditions, *given.conditions), given.value
            yield Action("pass", call.line, (("name", call.text(name)), ("value", call.text(given))), conditions)
        else:
            for item in held.items:
                yield from _passed(call, item, conditions)


def _opaque(call: LaunchCall) -> Any:
    function = call.get(0, "function")
    if not isinstance(function, LaunchFunction):
        source = call.source("function") if call.keywords else source_of(call.node)
        return call.action("unknown", (("text", (other(f"OpaqueFunction({source})"),)),))
    args, kwargs = call.get(-1, "args"), call.get(-1, "kwargs")
    given = list(args.items) if isinstance(args, Items) else []
    pairs = kwargs.items if isinstance(kwargs, Pairs) else ()
    keywords = {plain(key.value) or "": value for key, value in pairs if isinstance(key, TextValue)}
    children = tuple(call.actions(call.walker.call_function(function, [Context(), *given], keywords)))
    return call.group(children) if children or call.conditions() else call.items(())


def _for_each(call: LaunchCall) -> Any:
    """ForEach and ForLoop: what their function makes, for each of what is only known at launch."""
    function = call.get(1, "function")
    if not isinstance(function, LaunchFunction):
        return call.unknown
    each = ActionCondition("each", (other(source_of(call.node)),), call.line)
    return call.group(call.actions(call.walker.call_function(function, [], {})), each)


def _timer(call: LaunchCall) -> Any:
    period = together([call.text(call.get(-1, "period")), literal(" s")])
    return call.group(call.actions(call.get(-1, "actions")), ActionCondition("after", period, call.line))


_HANDLED = ("on_exit", "on_start", "entities", "on_completion", "on_shutdown", "on_stdout", "on_stderr", "on_output")


def _handler(call: LaunchCall) -> Any:
    """An event handler: its actions, under the event."""
    held: list[Action] = []
    for key in _HANDLED:
        value = call.get(-1, key)
        if isinstance(value, LaunchFunction):
            value = call.walker.call_function(value, [Unknown("event"), Context()], {})
        if value is not None:
            held += call.actions(value)
    after = ActionCondition("after", literal(call.path.rpartition(".")[2]), call.line)
    return Action("group", call.line, _UNSCOPED, (after,), tuple(held))


def _register(call: LaunchCall) -> Any:
    handler = call.get(0, "event_handler")
    if isinstance(handler, Action):
        if not handler.children:
            return call.items(())
        conditions = (*call.conditions(), *handler.conditions)
        return Action(handler.kind, handler.line, handler.attributes, conditions, handler.children)
    return handler if handler is not None else call.unknown


def _description(call: LaunchCall) -> Any:
    given = call.get(0, "initial_entities")
    return call.items(given.items if isinstance(given, Items) else [given] if is_given(given) else (), "launch")


def _condition(kind: str) -> Maker:
    return lambda call: ConditionValue(
        (ActionCondition(kind, call.text(call.get(0, "predicate_expression")), call.line),)
    )


def _configuration_is(kind: str) -> Maker:
    def make(call: LaunchCall) -> Any:
        name = (named("arg", call.text(call.get(0, "launch_configuration_name"))),)
        value = (ValuePart("equals", "", (name, call.text(call.get(1, "expected_value")))),)
        return ConditionValue((ActionCondition(kind, value, call.line),))

    return make


def _substitution(kind: str, *names: tuple[int, str]) -> Maker:
    """A substitution with a name, the first of its arguments, and what else it is given."""

    def make(call: LaunchCall) -> Any:
        given = [call.get(place, keyword) for place, keyword in names]
        if given[0] is None:
            return call.unknown
        return TextValue((named(kind, *(call.text(value) for value in given if is_given(value))),), False)

    return make


def _share(call: LaunchCall) -> Any:
    given = call.get(0, "package_name", "package")
    kind = "prefix" if call.path.endswith("prefix") else "find"
    return call.unknown if given is None else TextValue((named(kind, call.text(given)),))


def _parts(kind: str, is_str: bool = False) -> Maker:
    """A substitution of several values, given each or as one list."""

    def make(call: LaunchCall) -> Any:
        given = [*call.arguments, *call.keywords.values()]
        if len(given) == 1 and isinstance(given[0], Items):
            given = given[0].items
        return call.piece(kind, *given, is_str=is_str)

    return make


def _piece(kind: str, *names: str, is_str: bool = False) -> Maker:
    """A substitution of arguments by their places and names."""
    return lambda call: call.piece(
        kind, *(call.get(place, name) for place, name in enumerate(names)), is_str=is_str
    )


def _path_join(call: LaunchCall) -> Any:
    # os.path.join and not str.join, whose receiver is no module
    return _parts("join", True)(call) if call.path.endswith("path.join") else call.unknown


def _first(is_str: bool) -> Maker:
    """A wrapper through which its first argument passes."""

    def make(call: LaunchCall) -> Any:
        given = call.get(0, "text", "launch_file_path", "variable")
        if given is None:
            return call.unknown
        return TextValue(given.value if isinstance(given, TextValue) else call.text(given), is_str)

    return make


def _str(call: LaunchCall) -> Any:
    given = call.get(0, "object")
    return given if isinstance(given, TextValue) and given.is_str else TextValue(call.text(given))


def _performed(call: LaunchCall) -> Any:
    given = call.get(1, "subs")
    return call.unknown if given is None else TextValue(call.text(given))


def _dirname(call: LaunchCall) -> Any:
    given = call.get(0, "p")
    return TextValue(folder_of(given.value)) if isinstance(given, TextValue) else call.unknown


def _environment(call: LaunchCall) -> Any:
    """os.getenv() and os.environ.get()."""
    key, default = call.get(0, "key", "varname"), call.get(1, "default")
    if key is None or not call.path.endswith(("os.getenv", "environ.get")):
        return call.unknown
    return TextValue((named("env", *(call.text(value) for value in (key, default) if is_given(value))),))


def _choice(call: LaunchCall) -> Any:
    given = (call.get(0, "condition"), call.get(1, "if_value"), call.get(2, "else_value"))
    values = (literal("") if value is None else call.text(value) for value in given)
    return TextValue((ValuePart("choose", "", tuple(values)),), False)


def _parameter_value(call: LaunchCall) -> Any:
    type_ = call.get(1, "value_type")
    return TypedValue(call.get(0, "value"), _TYPES.get(type_.path if isinstance(type_, LaunchModule) else "", ""))


def _parameter_file(call: LaunchCall) -> Any:
    value = call.text(call.get(0, "param_file"))
    allow = call.get(-1, "allow_substs")
    return TextValue(value, False) if allow is None or allow == LaunchConstant(False) else FilledFile(value)


def _loaded(call: LaunchCall) -> Any:
    """yaml.safe_load() of an open file."""
    given = call.get(0, "stream")
    if isinstance(given, TextValue) and len(given.value) == 1 and given.value[0].kind == "content":
        return YamlContent(given.value[0].parts[0])
    return call.unknown


def _rewritten(call: LaunchCall) -> Any:
    """RewrittenYaml of nav2_common."""
    root = call.get(2, "root_key")
    parts = [call.text(call.get(0, "source_file")), literal("") if root is None else call.text(root)]
    rewrites = call.get(1, "param_rewrites")
    for key, value in rewrites.items if isinstance(rewrites, Pairs) else ():
        parts += (call.text(key), call.text(value.value if isinstance(value, Guarded) else value))
    value = (ValuePart("rewritten", "", tuple(parts)),)
    # Values that stand for others, wherever they are
    values = call.get(-1, "value_rewrites")
    if isinstance(values, Pairs) and values.items:
        value = (ValuePart("replaced", "", (value, *(call.text(item) for pair in values.items for item in pair))),)
    return TextValue(value, False)


def _replaced(call: LaunchCall) -> Any:
    """ReplaceString of nav2_common."""
    replacements = call.get(1, "replacements")
    pairs = replacements.items if isinstance(replacements, Pairs) else ()
    parts = (call.text(call.get(0, "source_file")), *(call.text(item) for pair in pairs for item in pair))
    value = (ValuePart("replaced", "", parts),)
    asked = call.conditions()
    return TextValue((ValuePart("choose", "", (all_of(asked), value, parts[0])),) if asked else value, False)


def _range(call: LaunchCall) -> Any:
    bounds = [
        value.value for value in call.arguments if isinstance(value, LaunchConstant) and isinstance(value.value, int)
    ]
    if len(bounds) != len(call.arguments) or not 1 <= len(bounds) <= 3 or (len(bounds) == 3 and bounds[2] == 0):
        return call.unknown
    numbers = range(*bounds)
    return call.unknown if len(numbers) > MOST_TURNS else call.items(map(LaunchConstant, numbers))


def _enumerated(call: LaunchCall) -> Any:
    turns = _sure(call, call.get(0, "iterable"))
    start = call.get(1, "start")
    first = start.value if isinstance(start, LaunchConstant) and isinstance(start.value, int) else 0
    if turns is None:
        return call.unknown
    return call.items(call.items((LaunchConstant(n), turn)) for n, turn in enumerate(turns, first))


def _zipped(call: LaunchCall) -> Any:
    lists = [_sure(call, argument) for argument in call.arguments]
    known = [turns for turns in lists if turns is not None]
    return call.items(map(call.items, zip(*known, strict=False))) if len(known) == len(lists) else call.unknown


def _sure(call: LaunchCall, value: Any) -> list[Any] | None:
    """What a loop over a value walks through, None where it is not known or hangs on conditions."""
    turns = call.walker.turns(value)
    return None if turns is None or any(isinstance(turn, Guarded) for turn in turns) else turns


def _listed(call: LaunchCall) -> Any:
    given = call.get(0, "iterable")
    turns = [] if given is None else call.walker.turns(given)
    return call.unknown if turns is None else call.items(turns)


def _dict(call: LaunchCall) -> Any:
    given = call.get(0)
    if isinstance(given, Items) and all(isinstance(item, Items) and len(item.items) == 2 for item in given.items):
        made = call.pairs((pair.items[0], pair.items[1]) for pair in given.items)
    elif given is None or isinstance(given, Pairs):
        made = call.pairs(() if given is None else given.items)
    else:
        return call.unknown
    for key, value in call.keywords.items():
        made.set(TextValue(literal(key)), value)
    return made


def _length(call: LaunchCall) -> Any:
    given = call.get(0)
    if isinstance(given, (Items, Pairs)) and not any(isinstance(item, Guarded) for item in given.items):
        return LaunchConstant(len(given.items))
    return call.unknown


def _copied(call: LaunchCall) -> Any:
    given = call.get(0)
    if isinstance(given, Items):
        return call.items(given.items, given.kind)
    return call.pairs(given.items) if isinstance(given, Pairs) else given


MAKERS: dict[str, Maker] = {
    "LaunchDescription": _description,
    "Node": _node("node"),
    "LifecycleNode": _node("lifecycle"),
    "ComposableNodeContainer": _node("container"),
    **dict.fromkeys(("ComposableNode", "ComposableLifecycleNode"), _node("composable")),
    "LoadComposableNodes": _load,
    "DeclareLaunchArgument": _simple("argument", ("name", 0, "name"), ("default", 1, "default_value")),
    "SetLaunchConfiguration": _simple("let", ("name", 0, "name"), ("value", 1, "value")),
    **dict.fromkeys(("PushRosNamespace", "PushROSNamespace"), _simple("namespace", ("namespace", 0, "namespace"))),
    "SetRemap": _simple("remap", ("from", 0, "src"), ("to", 1, "dst")),
    "SetEnvironmentVariable": _simple("environment", ("name", 0, "name"), ("value", 1, "value")),
    "SetParametersFromFile": _simple("parameter-file", ("file", 0, "filename")),
    "SetParameter": _set_parameter,
    "SetUseSimTime": _sim_time,
    "GroupAction": _group,
    "IncludeLaunchDescription": _include,
    "OpaqueFunction": _opaque,
    **dict.fromkeys(("TimerAction", "RosTimer"), _timer),
    "RegisterEventHandler": _register,
    **dict.fromkeys(
        ("ExecuteProcess", "ExecuteLocal"),
        lambda call: call.action("process", [("command", text) for text in call.texts(call.get(-1, "cmd"))]),
    ),
    **dict.fromkeys(
        ("OnProcessExit", "OnProcessStart", "OnProcessIO", "OnStateTransition", "OnShutdown", "OnExecutionComplete",
         "EventHandler", "OnActionEventBase"),
        _handler,
    ),
    **dict.fromkeys(
        ("LogInfo", "EmitEvent", "Shutdown", "UnsetEnvironmentVariable", "UnsetLaunchConfiguration",
         "AppendEnvironmentVariable", "PrependEnvironmentVariable", "SetROSLogDir", "LifecycleTransition",
         "ReadyToTest", "KeepAliveProc", "print", "ResetEnvironment", "PushEnvironment", "PopEnvironment"),
        lambda call: NOTHING,
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
    **dict.fromkeys(("FindPackagePrefix", "FindPackage"), _substitution("prefix", (0, "package"))),
    "FindExecutable": _substitution("program", (0, "name")),
    **dict.fromkeys(("get_package_share_directory", "get_package_share_path", "get_package_prefix"), _share),
    "ExecutableInPackage": _piece("executable", "executable", "package"),
    "PathJoinSubstitution": _parts("join"),
    "ThisLaunchFileDir": lambda call: TextValue((ValuePart("dirname"),), False),
    "ThisLaunchFile": lambda call: TextValue((ValuePart("filename"),), False),
    "PythonExpression": lambda call: TextValue(
        (ValuePart("eval", "launch", (call.text(call.get(0, "expression")),)),), False
    ),
    "Command": _piece("command", "command"),
    "EqualsSubstitution": _parts("equals"),
    "NotEqualsSubstitution": lambda call: TextValue((ValuePart("not", "", (_parts("equals")(call).value,)),), False),
    "NotSubstitution": _parts("not"),
    **dict.fromkeys(("AndSubstitution", "AllSubstitution"), _parts("and")),
    **dict.fromkeys(("OrSubstitution", "AnySubstitution"), _parts("or")),
    "IfElseSubstitution": _choice,
    **dict.fromkeys(("TextSubstitution", "abspath", "realpath", "normpath", "expanduser"), _first(True)),
    **dict.fromkeys(
        ("PythonLaunchDescriptionSource", "AnyLaunchDescriptionSource", "FrontendLaunchDescriptionSource",
         "XMLLaunchDescriptionSource", "YAMLLaunchDescriptionSource"),
        _first(False),
    ),
    "ParameterFile": _parameter_file,
    "ParameterValue": _parameter_value,
    "Parameter": lambda call: call.pairs([(call.get(0, "name"), call.get(1, "value"))]),
    **dict.fromkeys(("ForEach", "ForLoop"), _for_each),
    **dict.fromkeys(("FileContent", "open"), _piece("content", "file", is_str=True)),
    **dict.fromkeys(("safe_load", "full_load", "load"), _loaded),
    # of moveit_configs_utils: its default is given as a bool
    "DeclareBooleanLaunchArg": _simple("argument", ("name", 0, "name"), ("default", 1, "default_value")),
    "HasNodeParams": _piece("has-node", "source_file", "node_name"),  # of nav2_common
    "RewrittenYaml": _rewritten,
    "ReplaceString": _replaced,
    "perform_substitutions": _performed,
    "normalize_to_list_of_substitutions": _first(False),
    "join": _path_join,
    "dirname": _dirname,
    **dict.fromkeys(
        ("Path", "PurePath"),
        lambda call: (_parts("join", True) if len(call.arguments) > 1 else _first(True))(call),
    ),
    "str": _str,
    **dict.fromkeys(("getenv", "get"), _environment),
    "range": _range,
    "enumerate": _enumerated,
    "zip": _zipped,
    **dict.fromkeys(("list", "tuple", "reversed", "sorted"), _listed),
    "dict": _dict,
    "len": _length,
    **dict.fromkeys(("copy", "deepcopy"), _copied),
}  # fmt: skip
