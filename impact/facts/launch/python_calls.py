"""What the calls of a launch file in Python make: a row of MAKERS for each.

They make actions, substitutions and conditions of launch and launch_ros, paths, and what the few functions of the
standard library give that put these together.
"""

from __future__ import annotations

import ast
import json
from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple

from .actions import (
    BRIDGE_FILE,
    Action,
    ActionCondition,
    Value,
    ValuePart,
    find_literal,
    join_all,
    make_literal,
    make_named,
    make_other,
)
from .python_values import (
    NOTHING,
    ConditionalValue,
    ConditionValue,
    Context,
    FilledFile,
    Items,
    LaunchConstant,
    LaunchFunction,
    LaunchModule,
    Pairs,
    TextValue,
    TypedValue,
    Unknown,
    YamlContent,
    add_action_conditions,
    get_source,
    is_given,
    join_conditions,
    list_branches,
    make_parent_path,
    split_conditions,
)
from .python_walk import MOST_TURNS, Walker

_TYPES = {"bool": "bool", "int": "int", "float": "double", "str": "str"}
_UNSCOPED = (("scoped", make_literal("false")),)


class LaunchCall(NamedTuple):
    """A call of a known name. path: as imported."""

    walker: Walker
    node: ast.Call
    path: str
    arguments: list[Any]
    keywords: dict[str, Any]

    @property
    def line(self) -> int:
        return self.walker.locate(self.node)

    @property
    def unknown(self) -> Unknown:
        """What the call gives where that is not known."""
        return Unknown(get_source(self.node))

    def get(self, place: int, *names: str) -> Any:
        """The argument of a name, or at a place (-1 for none); None when it is not given."""
        for name in names:
            if name in self.keywords:
                return self.keywords[name]
        return self.arguments[place] if 0 <= place < len(self.arguments) else None

    def find_source(self, keyword: str) -> str:
        """The source of a keyword argument, its name where it is not given."""
        return next((get_source(each.value) for each in self.node.keywords if each.arg == keyword), keyword)

    def make_text(self, value: Any) -> Value:
        return self.walker.make_text(value, self.node)

    def list_texts(self, value: Any) -> list[Value]:
        """A list of texts, one each."""
        items = value.items if isinstance(value, Items) else [value]
        return [self.make_text(split_conditions(item)[0]) for item in items]

    def make_piece(self, kind: str, *values: Any, is_str: bool = False) -> TextValue:
        """A substitution of several values."""
        return TextValue((ValuePart(kind, "", tuple(self.make_text(value) for value in values)),), is_str)

    def make_list(self, items: Iterable[Any], kind: str = "list") -> Items:
        return Items(list(items), len(self.walker.conditions), kind)

    def make_pairs(self, pairs: Iterable[tuple[Any, Any]] = ()) -> Pairs:
        return Pairs(list(pairs), len(self.walker.conditions))

    def make_action(
        self,
        kind: str,
        attributes: Iterable[tuple[str, Value]],
        children: Iterable[Action] = (),
        more: tuple[ActionCondition, ...] = (),
    ) -> Action:
        """An action under the call's own conditions and more."""
        return Action(kind, self.line, tuple(attributes), (*self.list_conditions(), *more), tuple(children))

    def group(self, children: Iterable[Action], *more: ActionCondition) -> Action:
        """Actions that need no scope of their own."""
        return self.make_action("group", _UNSCOPED, children, more)

    def list_actions(self, value: Any) -> Iterator[Action]:
        return self.walker.list_actions(value, self.line)

    def skip_argument(self, keyword: str, value: Any, extra: tuple[ActionCondition, ...]) -> Action:
        """An argument that cannot be followed."""
        source = value.source if isinstance(value, Unknown) else self.find_source(keyword)
        text = make_other(f"{keyword.replace('_', ' ')}: {source}")
        return Action("unknown", self.line, (("text", (text,)),), extra)

    def list_attributes(self, *wanted: tuple[str, Any]) -> list[tuple[str, Value]]:
        return [(key, self.make_text(value)) for key, value in wanted if is_given(value)]

    def list_conditions(self) -> tuple[ActionCondition, ...]:
        given = self.keywords.get("condition")
        if not is_given(given):
            return ()
        if isinstance(given, ConditionValue):
            return given.conditions
        source = given.source if isinstance(given, Unknown) else self.find_source("condition")
        return (ActionCondition("if", (make_other(source),), self.line),)

    def list_pairs(
        self, argument: str, kind: str, keys: tuple[str, str], value: Any, extra: tuple[ActionCondition, ...] = ()
    ) -> Iterator[Action]:
        """Actions with two attributes of what an argument gives as pairs: a dict, a pair, or a list of any of these."""
        for held, conditions in list_branches(value, self.line, extra):
            if not isinstance(held, (Items, Pairs)):
                yield self.skip_argument(argument, held, conditions)
                continue
            items = held.items if isinstance(held, Items) else [Items(list(pair), 0, "tuple") for pair in held.items]
            first = items[0] if len(items) == 2 else None
            of_tuples = isinstance(first, Items) and first.kind == "tuple"
            of_pair = isinstance(held, Items) and held.kind == "tuple" and first is not None and not of_tuples
            if isinstance(first, TextValue) or of_pair:
                second, more = split_conditions(items[1])
                texts = (self.make_text(first), self.make_text(second))
                yield Action(kind, self.line, tuple(zip(keys, texts, strict=True)), (*conditions, *more))
                continue
            for item in items:
                yield from self.list_pairs(argument, kind, keys, item, conditions)

    def list_parameters(self, value: Any, extra: tuple[ActionCondition, ...] = ()) -> Iterator[Action]:
        for held, conditions in list_branches(value, self.line, extra):
            if isinstance(held, Items):
                for item in held.items:
                    yield from self.list_parameters(item, conditions)
            elif isinstance(held, Pairs):
                for key, each in held.items:
                    yield from self.expand_parameter(self.make_text(key), each, conditions)
            elif isinstance(held, (TextValue, FilledFile)):
                fill = () if isinstance(held, TextValue) else (("substitute", make_literal("true")),)
                yield Action("parameter-file", self.line, (("file", held.value), *fill), conditions)
            elif isinstance(held, YamlContent):
                yield self.make_yaml_action(held, None, conditions)
            else:
                yield self.skip_argument("parameters", held, conditions)

    def make_yaml_action(self, value: YamlContent, name: Value | None, extra: tuple[ActionCondition, ...]) -> Action:
        """The values of a YAML file that is loaded by the launch file, under a name if one is given."""
        attributes = [("file", value.file), *(("below", key) for key in value.keys)]
        if name is not None:
            attributes.append(("name", name))
        return Action("parameter-file", self.line, tuple(attributes), extra)

    def expand_parameter(self, name: Value, value: Any, extra: tuple[ActionCondition, ...] = ()) -> Iterator[Action]:
        """A parameter, or those of a nested dict."""
        if isinstance(value, ConditionalValue):
            yield from self.expand_parameter(name, value.value, (*extra, *value.conditions))
        elif isinstance(value, Pairs):
            for key, held in value.items:
                yield from self.expand_parameter(join_all([name, make_literal("."), self.make_text(key)]), held, extra)
        elif isinstance(value, YamlContent):
            yield self.make_yaml_action(value, name, extra)
        else:
            text, type_ = self.make_typed_text(value)
            typed = (("type", make_literal(type_)),) if type_ else ()
            yield Action("parameter", self.line, (("name", name), ("value", text), *typed), extra)

    def make_typed_text(self, value: Any) -> tuple[Value, str]:
        """A parameter's value and type; no type where YAML's rules decide, as for substitutions."""
        if isinstance(value, TypedValue):
            return self.make_text(value.value), value.type
        if isinstance(value, LaunchConstant):
            return self.make_text(value), _TYPES.get(type(value.value).__name__, "")
        if isinstance(value, TextValue):
            return value.value, "str" if value.is_str else ""
        # A list of substitutions is one text; a list of values is a list.
        if not isinstance(value, Items) or any(isinstance(item, TextValue) and not item.is_str for item in value.items):
            return self.make_text(value), ""
        parts: list[Value] = []
        for item in value.items:
            text = self.make_text(item)
            known = find_literal(text) if isinstance(item, TextValue) else None
            parts += (make_literal(", " if parts else ""), text if known is None else make_literal(json.dumps(known)))
        return join_all([make_literal("["), *parts, make_literal("]")]), "list"


Maker = Callable[[LaunchCall], Any]


def _define_node(kind: str) -> Maker:
    def make(call: LaunchCall) -> Any:
        attributes = call.list_attributes(
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
                    attributes.append(("arguments", make_literal("--ros-args")))
                attributes += [("arguments", text) for text in call.list_texts(given)]
        remaps = call.list_pairs("remappings", "remap", ("from", "to"), call.get(-1, "remappings"))
        children = [*remaps, *call.list_parameters(call.get(-1, "parameters"))]
        inner = call.get(-1, "composable_node_descriptions")
        if kind == "container" and inner is not None:
            children += call.list_actions(inner)
        return call.make_action(kind, attributes, children)

    return make


def _load(call: LaunchCall) -> Any:
    target = call.get(1, "target_container")
    if isinstance(target, Action):
        name = target.get("name") or (make_other(call.find_source("target_container")),)
        space = target.get("namespace")
        full = join_all([space, make_literal("/"), name]) if space is not None and find_literal(space) != "" else name
        attributes = [("container-node", full)]
    else:
        attributes = call.list_attributes(("container", target))
    return call.make_action("load", attributes, call.list_actions(call.get(0, "composable_node_descriptions")))


def _make_simple(kind: str, *names: tuple[str, int, str]) -> Maker:
    """An action of nothing but attributes: (attribute, place, keyword) each."""
    return lambda call: call.make_action(
        kind, call.list_attributes(*((key, call.get(place, keyword)) for key, place, keyword in names))
    )


def _set_parameter(call: LaunchCall) -> Any:
    found = call.expand_parameter(call.make_text(call.get(0, "name")), call.get(1, "value"))
    made = [add_action_conditions(action, call.list_conditions()) for action in found]
    return made[0] if len(made) == 1 else call.make_list(made)


def _make_sim_time(call: LaunchCall) -> Any:
    text, type_ = call.make_typed_text(call.get(0, "value"))
    named_ = ("name", make_literal("use_sim_time"))
    return call.make_action("parameter", (named_, ("value", text), ("type", make_literal(type_ or "bool"))))


def _group(call: LaunchCall) -> Any:
    attributes = call.list_attributes(("scoped", call.get(-1, "scoped")), ("forwarding", call.get(-1, "forwarding")))
    configurations = call.get(-1, "launch_configurations")
    lets = [
        Action("let", call.line, (("name", call.make_text(key)), ("value", call.make_text(value))))
        for key, value in (configurations.items if isinstance(configurations, Pairs) else ())
    ]
    return call.make_action("group", attributes, (*lets, *call.list_actions(call.get(0, "actions"))))


def _include(call: LaunchCall) -> Any:
    source = call.get(0, "launch_description_source")
    if isinstance(source, Items) and source.kind == "launch":
        return call.group(call.list_actions(source))
    passed = call.list_pairs("launch_arguments", "pass", ("name", "value"), call.get(1, "launch_arguments"))
    return call.make_action("include", call.list_attributes(("file", source)), passed)


def _include_bridge(call: LaunchCall) -> Any:
    """RosGzBridge of ros_gz_bridge, which includes a launch file with all that it is given."""
    passed = [
        Action("pass", call.line, (("name", make_literal(name)), ("value", call.make_text(value))))
        for name, value in call.keywords.items()
        if name != "condition" and is_given(value)
    ]
    return call.make_action("include", (("file", BRIDGE_FILE),), passed)


def _run_opaque_function(call: LaunchCall) -> Any:
    function = call.get(0, "function")
    if not isinstance(function, LaunchFunction):
        source = call.find_source("function") if call.keywords else get_source(call.node)
        return call.make_action("unknown", (("text", (make_other(f"OpaqueFunction({source})"),)),))
    args, kwargs = call.get(-1, "args"), call.get(-1, "kwargs")
    given = list(args.items) if isinstance(args, Items) else []
    pairs = kwargs.items if isinstance(kwargs, Pairs) else ()
    keywords = {find_literal(key.value) or "": value for key, value in pairs if isinstance(key, TextValue)}
    children = tuple(call.list_actions(call.walker.call_function(function, [Context(), *given], keywords)))
    return call.group(children) if children or call.list_conditions() else call.make_list(())


def _run_for_each(call: LaunchCall) -> Any:
    """ForEach and ForLoop: what their function makes, for each of what is only known at launch."""
    function = call.get(1, "function")
    if not isinstance(function, LaunchFunction):
        return call.unknown
    each = ActionCondition("each", (make_other(get_source(call.node)),), call.line)
    return call.group(call.list_actions(call.walker.call_function(function, [], {})), each)


def _make_timer(call: LaunchCall) -> Any:
    period = join_all([call.make_text(call.get(-1, "period")), make_literal(" s")])
    return call.group(call.list_actions(call.get(-1, "actions")), ActionCondition("after", period, call.line))


_HANDLED = ("on_exit", "on_start", "entities", "on_completion", "on_shutdown", "on_stdout", "on_stderr", "on_output")


def _make_handler(call: LaunchCall) -> Any:
    """An event handler: its actions, under the event."""
    held: list[Action] = []
    for key in _HANDLED:
        value = call.get(-1, key)
        if isinstance(value, LaunchFunction):
            value = call.walker.call_function(value, [Unknown("event"), Context()], {})
        if value is not None:
            held += call.list_actions(value)
    after = ActionCondition("after", make_literal(call.path.rpartition(".")[2]), call.line)
    return Action("group", call.line, _UNSCOPED, (after,), tuple(held))


def _register(call: LaunchCall) -> Any:
    handler = call.get(0, "event_handler")
    if isinstance(handler, Action):
        return add_action_conditions(handler, call.list_conditions()) if handler.children else call.make_list(())
    return handler if handler is not None else call.unknown


def _make_description(call: LaunchCall) -> Any:
    given = call.get(0, "initial_entities")
    return call.make_list(given.items if isinstance(given, Items) else [given] if is_given(given) else (), "launch")


def _define_condition(kind: str) -> Maker:
    return lambda call: ConditionValue(
        (ActionCondition(kind, call.make_text(call.get(0, "predicate_expression")), call.line),)
    )


def _define_configuration_test(kind: str) -> Maker:
    def make(call: LaunchCall) -> Any:
        name = (make_named("arg", call.make_text(call.get(0, "launch_configuration_name"))),)
        value = (ValuePart("equals", "", (name, call.make_text(call.get(1, "expected_value")))),)
        return ConditionValue((ActionCondition(kind, value, call.line),))

    return make


def _define_substitution(kind: str, *names: tuple[str, ...], is_str: bool = False) -> Maker:
    """A substitution with a name, the first of its arguments, and what else it is given. names: of each argument."""

    def make(call: LaunchCall) -> Any:
        given = [call.get(place, *keywords) for place, keywords in enumerate(names)]
        if given[0] is None:
            return call.unknown
        return TextValue((make_named(kind, *(call.make_text(value) for value in given if is_given(value))),), is_str)

    return make


def _define_parts(kind: str, is_str: bool = False) -> Maker:
    """A substitution of several values, given each or as one list."""

    def make(call: LaunchCall) -> Any:
        given = [*call.arguments, *call.keywords.values()]
        if len(given) == 1 and isinstance(given[0], Items):
            given = given[0].items
        return call.make_piece(kind, *given, is_str=is_str)

    return make


def _define_piece(kind: str, *names: str, is_str: bool = False) -> Maker:
    """A substitution of arguments by their places and names."""
    return lambda call: call.make_piece(
        kind, *(call.get(place, name) for place, name in enumerate(names)), is_str=is_str
    )


def _join_path(call: LaunchCall) -> Any:
    # os.path.join and not str.join, whose receiver is no module
    return _define_parts("join", True)(call) if call.path.endswith("path.join") else call.unknown


def _define_wrapper(is_str: bool, place: int = 0) -> Maker:
    """A wrapper through which an argument passes."""

    def make(call: LaunchCall) -> Any:
        given = call.get(place, "text", "launch_file_path", "variable", "subs")
        if given is None:
            return call.unknown
        return TextValue(given.value if isinstance(given, TextValue) else call.make_text(given), is_str)

    return make


def _convert_to_str(call: LaunchCall) -> Any:
    given = call.get(0, "object")
    return given if isinstance(given, TextValue) and given.is_str else TextValue(call.make_text(given))


def _find_dirname(call: LaunchCall) -> Any:
    given = call.get(0, "p")
    return TextValue(make_parent_path(given.value)) if isinstance(given, TextValue) else call.unknown


def _read_environment(call: LaunchCall) -> Any:
    """os.getenv() and os.environ.get()."""
    key, default = call.get(0, "key", "varname"), call.get(1, "default")
    if key is None or not call.path.endswith(("os.getenv", "environ.get")):
        return call.unknown
    return TextValue((make_named("env", *(call.make_text(value) for value in (key, default) if is_given(value))),))


def _make_choice(call: LaunchCall) -> Any:
    given = (call.get(0, "condition"), call.get(1, "if_value"), call.get(2, "else_value"))
    values = (make_literal("") if value is None else call.make_text(value) for value in given)
    return TextValue((ValuePart("choose", "", tuple(values)),), False)


def _make_parameter_value(call: LaunchCall) -> Any:
    type_ = call.get(1, "value_type")
    return TypedValue(call.get(0, "value"), _TYPES.get(type_.path if isinstance(type_, LaunchModule) else "", ""))


def _make_parameter_file(call: LaunchCall) -> Any:
    value = call.make_text(call.get(0, "param_file"))
    allow = call.get(-1, "allow_substs")
    return TextValue(value, False) if allow is None or allow == LaunchConstant(False) else FilledFile(value)


def _load_yaml(call: LaunchCall) -> Any:
    """yaml.safe_load() of an open file."""
    given = call.get(0, "stream")
    if isinstance(given, TextValue) and len(given.value) == 1 and given.value[0].kind == "content":
        return YamlContent(given.value[0].parts[0])
    return call.unknown


def _rewrite_yaml(call: LaunchCall) -> Any:
    """RewrittenYaml of nav2_common."""
    root = call.get(2, "root_key")
    parts = [call.make_text(call.get(0, "source_file")), make_literal("") if root is None else call.make_text(root)]
    rewrites = call.get(1, "param_rewrites")
    for key, value in rewrites.items if isinstance(rewrites, Pairs) else ():
        parts += (call.make_text(key), call.make_text(split_conditions(value)[0]))
    value = (ValuePart("rewritten", "", tuple(parts)),)
    # Values that stand for others, wherever they are
    values = call.get(-1, "value_rewrites")
    if isinstance(values, Pairs) and values.items:
        value = (ValuePart("replaced", "", (value, *(call.make_text(item) for pair in values.items for item in pair))),)
    return TextValue(value, False)


def _replace_strings(call: LaunchCall) -> Any:
    """ReplaceString of nav2_common."""
    replacements = call.get(1, "replacements")
    pairs = replacements.items if isinstance(replacements, Pairs) else ()
    parts = (call.make_text(call.get(0, "source_file")), *(call.make_text(item) for pair in pairs for item in pair))
    value = (ValuePart("replaced", "", parts),)
    asked = call.list_conditions()
    return TextValue((ValuePart("choose", "", (join_conditions(asked), value, parts[0])),) if asked else value, False)


def _make_range(call: LaunchCall) -> Any:
    bounds = [
        value.value for value in call.arguments if isinstance(value, LaunchConstant) and isinstance(value.value, int)
    ]
    if len(bounds) != len(call.arguments) or not 1 <= len(bounds) <= 3 or (len(bounds) == 3 and bounds[2] == 0):
        return call.unknown
    numbers = range(*bounds)
    return call.unknown if len(numbers) > MOST_TURNS else call.make_list(map(LaunchConstant, numbers))


def _enumerate_turns(call: LaunchCall) -> Any:
    turns = _list_sure_turns(call, call.get(0, "iterable"))
    start = call.get(1, "start")
    first = start.value if isinstance(start, LaunchConstant) and isinstance(start.value, int) else 0
    if turns is None:
        return call.unknown
    return call.make_list(call.make_list((LaunchConstant(n), turn)) for n, turn in enumerate(turns, first))


def _zip_turns(call: LaunchCall) -> Any:
    lists = [_list_sure_turns(call, argument) for argument in call.arguments]
    known = [turns for turns in lists if turns is not None]
    return call.make_list(map(call.make_list, zip(*known, strict=False))) if len(known) == len(lists) else call.unknown


def _list_sure_turns(call: LaunchCall, value: Any) -> list[Any] | None:
    """What a loop over a value walks through, None where it is not known or hangs on conditions."""
    turns = call.walker.list_turns(value)
    return None if turns is None or any(isinstance(turn, ConditionalValue) for turn in turns) else turns


def _make_list(call: LaunchCall) -> Any:
    given = call.get(0, "iterable")
    turns = [] if given is None else call.walker.list_turns(given)
    return call.unknown if turns is None else call.make_list(turns)


def _make_dict(call: LaunchCall) -> Any:
    given = call.get(0)
    if isinstance(given, Items) and all(isinstance(item, Items) and len(item.items) == 2 for item in given.items):
        made = call.make_pairs((pair.items[0], pair.items[1]) for pair in given.items)
    elif given is None or isinstance(given, Pairs):
        made = call.make_pairs(() if given is None else given.items)
    else:
        return call.unknown
    for key, value in call.keywords.items():
        made.set(TextValue(make_literal(key)), value)
    return made


def _measure_length(call: LaunchCall) -> Any:
    given = call.get(0)
    if isinstance(given, (Items, Pairs)) and not any(isinstance(item, ConditionalValue) for item in given.items):
        return LaunchConstant(len(given.items))
    return call.unknown


def _copy_value(call: LaunchCall) -> Any:
    given = call.get(0)
    if isinstance(given, Items):
        return call.make_list(given.items, given.kind)
    return call.make_pairs(given.items) if isinstance(given, Pairs) else given


MAKERS: dict[str, Maker] = {
    "LaunchDescription": _make_description,
    "Node": _define_node("node"),
    "LifecycleNode": _define_node("lifecycle"),
    "ComposableNodeContainer": _define_node("container"),
    **dict.fromkeys(("ComposableNode", "ComposableLifecycleNode"), _define_node("composable")),
    "LoadComposableNodes": _load,
    "DeclareLaunchArgument": _make_simple("argument", ("name", 0, "name"), ("default", 1, "default_value")),
    "SetLaunchConfiguration": _make_simple("let", ("name", 0, "name"), ("value", 1, "value")),
    **dict.fromkeys(("PushRosNamespace", "PushROSNamespace"), _make_simple("namespace", ("namespace", 0, "namespace"))),
    "SetRemap": _make_simple("remap", ("from", 0, "src"), ("to", 1, "dst")),
    "SetEnvironmentVariable": _make_simple("environment", ("name", 0, "name"), ("value", 1, "value")),
    "SetParametersFromFile": _make_simple("parameter-file", ("file", 0, "filename")),
    "SetParameter": _set_parameter,
    "SetUseSimTime": _make_sim_time,
    "GroupAction": _group,
    "IncludeLaunchDescription": _include,
    "OpaqueFunction": _run_opaque_function,
    "RosGzBridge": _include_bridge,
    **dict.fromkeys(("TimerAction", "RosTimer"), _make_timer),
    "RegisterEventHandler": _register,
    **dict.fromkeys(
        ("ExecuteProcess", "ExecuteLocal"),
        lambda call: call.make_action("process", [("command", text) for text in call.list_texts(call.get(-1, "cmd"))]),
    ),
    **dict.fromkeys(
        ("OnProcessExit", "OnProcessStart", "OnProcessIO", "OnStateTransition", "OnShutdown", "OnExecutionComplete",
         "EventHandler", "OnActionEventBase"),
        _make_handler,
    ),
    **dict.fromkeys(
        ("LogInfo", "EmitEvent", "Shutdown", "UnsetEnvironmentVariable", "UnsetLaunchConfiguration",
         "AppendEnvironmentVariable", "PrependEnvironmentVariable", "SetROSLogDir", "LifecycleTransition",
         "ReadyToTest", "KeepAliveProc", "print", "ResetEnvironment", "PushEnvironment", "PopEnvironment"),
        lambda call: NOTHING,
    ),
    "IfCondition": _define_condition("if"),
    "UnlessCondition": _define_condition("unless"),
    "LaunchConfigurationEquals": _define_configuration_test("if"),
    "LaunchConfigurationNotEquals": _define_configuration_test("unless"),
    "LaunchConfiguration": _define_substitution("arg", ("variable_name",), ("default",)),
    "LaunchConfigAsBool": _define_substitution("arg", ("name",)),
    **dict.fromkeys(
        ("EnvironmentVariable", "OptEnvironmentVariable"), _define_substitution("env", ("name",), ("default_value",))
    ),
    "AnonName": _define_substitution("anon", ("name",)),
    "FindPackageShare": _define_substitution("find", ("package",)),
    **dict.fromkeys(("FindPackagePrefix", "FindPackage"), _define_substitution("prefix", ("package",))),
    "FindExecutable": _define_substitution("program", ("name",)),
    **dict.fromkeys(
        ("get_package_share_directory", "get_package_share_path"),
        _define_substitution("find", ("package_name", "package"), is_str=True),
    ),
    "get_package_prefix": _define_substitution("prefix", ("package_name", "package"), is_str=True),
    "ExecutableInPackage": _define_piece("executable", "executable", "package"),
    "PathJoinSubstitution": _define_parts("join"),
    "ThisLaunchFileDir": lambda call: TextValue((ValuePart("dirname"),), False),
    "ThisLaunchFile": lambda call: TextValue((ValuePart("filename"),), False),
    "PythonExpression": lambda call: TextValue(
        (ValuePart("eval", "launch", (call.make_text(call.get(0, "expression")),)),), False
    ),
    "Command": _define_piece("command", "command"),
    "EqualsSubstitution": _define_parts("equals"),
    "NotEqualsSubstitution": lambda call: TextValue(
        (ValuePart("not", "", (_define_parts("equals")(call).value,)),), False
    ),
    "NotSubstitution": _define_parts("not"),
    **dict.fromkeys(("AndSubstitution", "AllSubstitution"), _define_parts("and")),
    **dict.fromkeys(("OrSubstitution", "AnySubstitution"), _define_parts("or")),
    "IfElseSubstitution": _make_choice,
    **dict.fromkeys(("TextSubstitution", "abspath", "realpath", "normpath", "expanduser"), _define_wrapper(True)),
    **dict.fromkeys(
        ("PythonLaunchDescriptionSource", "AnyLaunchDescriptionSource", "FrontendLaunchDescriptionSource",
         "XMLLaunchDescriptionSource", "YAMLLaunchDescriptionSource"),
        _define_wrapper(False),
    ),
    "ParameterFile": _make_parameter_file,
    "ParameterValue": _make_parameter_value,
    "Parameter": lambda call: call.make_pairs([(call.get(0, "name"), call.get(1, "value"))]),
    **dict.fromkeys(("ForEach", "ForLoop"), _run_for_each),
    **dict.fromkeys(("FileContent", "open"), _define_piece("content", "file", is_str=True)),
    **dict.fromkeys(("safe_load", "full_load", "load"), _load_yaml),
    # of moveit_configs_utils: its default is given as a bool
    "DeclareBooleanLaunchArg": _make_simple("argument", ("name", 0, "name"), ("default", 1, "default_value")),
    "HasNodeParams": _define_piece("has-node", "source_file", "node_name"),  # of nav2_common
    "RewrittenYaml": _rewrite_yaml,
    "ReplaceString": _replace_strings,
    "perform_substitutions": _define_wrapper(True, 1),
    "normalize_to_list_of_substitutions": _define_wrapper(False),
    "join": _join_path,
    "dirname": _find_dirname,
    **dict.fromkeys(
        ("Path", "PurePath"),
        lambda call: (_define_parts("join", True) if len(call.arguments) > 1 else _define_wrapper(True))(call),
    ),
    "str": _convert_to_str,
    **dict.fromkeys(("getenv", "get"), _read_environment),
    "range": _make_range,
    "enumerate": _enumerate_turns,
    "zip": _zip_turns,
    **dict.fromkeys(("list", "tuple", "reversed", "sorted"), _make_list),
    "dict": _make_dict,
    "len": _measure_length,
    **dict.fromkeys(("copy", "deepcopy"), _copy_value),
}  # fmt: skip


def make(walker: Walker, node: ast.Call, path: str, arguments: list[Any], keywords: dict[str, Any]) -> Any:
    """What a call of an imported name makes, Unknown where that is not known. path: as imported."""
    call = LaunchCall(walker, node, path, arguments, keywords)
    maker = MAKERS.get(path.rpartition(".")[2])
    return call.unknown if maker is None else maker(call)
