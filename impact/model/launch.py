"""What a launch file starts: its includes followed, its substitutions filled in, its conditions decided.

What is not known stays unknown, with the reason; what rests on the default of a launch argument says so. Paths in the
share folder of a package are written `$(find PACKAGE)/path`, whatever the launch file wrote.

Sources: roslaunch's loader.py, xmlloader.py and substitution_args.py; launch's actions and substitutions; launch_ros'
node.py, load_composable_nodes.py and push_ros_namespace.py.
"""

from __future__ import annotations

import ast
import math
import posixpath
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple, Protocol

from ..facts.flow_launch import (
    Action,
    Condition,
    Entry,
    LaunchFile,
    ParameterFile,
    Piece,
    Value,
    literal,
    parameters,
    plain,
    scalar,
    substitutions,
)
from .names_ros import canonical, joined, ros2_rule


class Sources(Protocol):
    """Where launch and parameter files come from. package and path: as in `$(find package)/path`, the path normal and
    without a leading slash. None for what is not there."""

    def launch(self, package: str, path: str) -> LaunchFile | None:
        """The facts of a launch file."""
        ...

    def parameters(self, package: str, path: str) -> ParameterFile | None:
        """The facts of a file of parameters."""
        ...


class At(NamedTuple):
    """A line of a file in a package's share folder."""

    package: str
    path: str
    line: int


class Text(NamedTuple):
    """A text as far as it is known. value: None where it is not. shown: what is known of it, the rest as `<...>`.
    reasons: why it is not known. assumed: launch arguments, and `$VARIABLE`s of the environment, on whose defaults it
    rests."""

    value: str | None
    shown: str
    reasons: tuple[str, ...] = ()
    assumed: tuple[str, ...] = ()


class Remap(NamedTuple):
    """A remapping as given; in ROS 2 old may have a node's name before it (`node:old`). conditions: as in Started."""

    old: Text
    new: Text
    at: At
    conditions: tuple[str, ...] = ()


class Setting(NamedTuple):
    """A parameter. name: private to its node (`scan_topic`), or global on ROS 1's parameter server (`/robot/scan`).
    value: bool, int, float, str, None or list, if text.value is known. conditions: as in Started."""

    name: str
    value: Any
    text: Text
    at: At
    conditions: tuple[str, ...] = ()


class SettingFile(NamedTuple):
    """A parameter file given to a node of ROS 2. entries: None where it could not be had. plain: its entries are
    parameters by themselves, without the name of a node above them."""

    file: Text
    entries: tuple[Entry, ...] | None
    at: At
    conditions: tuple[str, ...] = ()
    plain: bool = False


class Started(NamedTuple):
    """A node, or another program, that the launch starts.

    kind: `node`, `lifecycle`, `test`, `container`, `composable` (ROS 1: a nodelet that is loaded) or `process`.
    executable or plugin: what runs. container: full name of where a composable is loaded. name: empty where it is left
    to the program. namespace: absolute; empty where it is left to the program, which then means `/`.
    remaps, settings: in the order in which they are given to the node; of remaps ROS 1 takes the last for a name, ROS 2
    the first; of settings the last holds. settings of ROS 1 are on the server: Launched.values().
    conditions: those that could not be decided, as text. assumed: launch arguments whose defaults decided the others.
    after: events or times it waits for. at: the line that starts it. chain: the lines of the includes that lead there,
    outermost first.
    """

    kind: str
    generation: int
    package: Text
    executable: Text
    plugin: Text
    container: Text
    name: Text
    namespace: Text
    remaps: tuple[Remap, ...]
    settings: tuple[Setting | SettingFile, ...]
    arguments: tuple[Text, ...]
    conditions: tuple[str, ...]
    assumed: tuple[str, ...]
    after: tuple[str, ...]
    at: At
    chain: tuple[At, ...]

    @property
    def full_name(self) -> Text:
        """Namespace and name together; unknown where either is, or where the name is left to the program."""
        if self.name.value == "":
            return Text(None, joined(self.namespace.shown or "/", "<its own>"), ("the name is left to the program",))
        return within(self.namespace if self.namespace.value != "" else known("/"), self.name)


class Skipped(NamedTuple):
    """Something not started because a condition is false. assumed: the arguments whose defaults made it so; empty when
    it is false whatever the arguments."""

    kind: str
    at: At
    conditions: tuple[str, ...]
    assumed: tuple[str, ...]


class Unresolved(NamedTuple):
    """Something that could not be followed or filled in: what, and why."""

    at: At
    what: str
    reasons: tuple[str, ...]


class Argument(NamedTuple):
    """A launch argument as declared. value: what it has in this launch."""

    name: str
    value: Text
    at: At


class Launched(NamedTuple):
    """All that a launch does. server: ROS 1's parameters by their global names. files: (package, path) of the launch
    files read."""

    started: tuple[Started, ...]
    server: Mapping[str, Setting]
    arguments: tuple[Argument, ...]
    skipped: tuple[Skipped, ...]
    unresolved: tuple[Unresolved, ...]
    files: tuple[tuple[str, str], ...]

    def values(self, started: Started, name: str = "") -> dict[str, Setting]:
        """The private parameters of a node. name: its full name where the launch leaves it to the program; without one
        only what holds for any node is given."""
        full = name or started.full_name.value or ""
        if started.generation == 1:
            below = f"{full}/"
            return {
                key[len(below) :]: setting for key, setting in self.server.items() if full and key.startswith(below)
            }
        found: dict[str, Setting] = {}
        for setting in started.settings:
            if isinstance(setting, Setting):
                found.pop(setting.name, None)
                found[setting.name] = setting
                continue
            for key, entry in file_values(setting, full).items():
                found.pop(key, None)
                shown = str(entry.value)
                text = Text(shown, shown, (), setting.file.assumed)
                found[key] = Setting(key, entry.value, text, setting.at, setting.conditions)
        return found


DEEPEST = 30
MOST_ACTIONS = 20_000
LONGEST = 100_000


def known(value: str, assumed: tuple[str, ...] = ()) -> Text:
    """A text that is known."""
    return Text(value, value, (), assumed)


def unknown(shown: str, *reasons: str, assumed: tuple[str, ...] = ()) -> Text:
    """A text that is not."""
    return Text(None, f"<{shown}>", reasons, assumed)


def together(texts: Sequence[Text], between: str = "") -> Text:
    """Texts one after the other as one."""
    value = None if any(t.value is None for t in texts) else between.join(t.value or "" for t in texts)
    if value is not None and len(value) > LONGEST:
        return unknown("...", "is too long")
    shown = value if value is not None else between.join(t.shown for t in texts)[:LONGEST]
    return Text(value, shown, _all(t.reasons for t in texts), _all(t.assumed for t in texts))


def within(namespace: Text, name: Text) -> Text:
    """A name put into a namespace."""
    if name.value is not None and name.value[:1] == "/":
        return name
    if namespace.value is None or name.value is None:
        both = together((namespace, name), "/")
        return both._replace(value=None, shown=both.shown.replace("//", "/"))
    return Text(joined(namespace.value, name.value), joined(namespace.value, name.value), (),
                _all((namespace.assumed, name.assumed)))  # fmt: skip


def _all(groups: Iterable[tuple[str, ...]]) -> tuple[str, ...]:
    """All of several tuples, each once, in order."""
    return tuple(dict.fromkeys(item for group in groups for item in group))


def show(value: Value) -> str:
    """A value as a person would write it."""
    return "".join(_show_piece(piece) for piece in value)


def _show_piece(piece: Piece) -> str:
    if piece.kind == "text":
        return piece.text
    if piece.kind == "other":
        return f"<{piece.text}>"
    parts = [show(part) for part in piece.parts]
    if piece.kind == "eval":
        return f"$(eval {parts[0]})"
    if piece.kind == "equals" and len(parts) == 2:
        return f"{parts[0]} == {parts[1]}"
    if piece.kind in ("and", "or"):
        return f" {piece.kind} ".join(f"({part})" for part in parts)
    if piece.kind == "not":
        return f"not ({parts[0]})" if parts else "not"
    if piece.kind == "in":
        return f"{parts[0]} in ({', '.join(parts[1:])})"
    if piece.kind == "choose":
        return f"({parts[1]} if {parts[0]} else {parts[2]})"
    if piece.kind == "join":
        return "/".join(parts)
    return f"$({' '.join([piece.kind, *([piece.text] if piece.text else []), *parts])})"


def _show_condition(condition: Condition) -> str:
    text = show(condition.value)
    return f"not ({text})" if condition.kind == "unless" else text


# Parameter files


def file_values(setting: SettingFile, full_name: str) -> dict[str, Entry]:
    """The entries of a ROS 2 parameter file that hold for a node, later ones over earlier ones. full_name: empty for a
    node whose name is not known: then only what is for every node."""
    found: dict[str, Entry] = {}
    for entry in setting.entries or ():
        if setting.plain:
            found[".".join(entry.path)] = entry
            continue
        if "ros__parameters" not in entry.path:
            continue
        split = entry.path.index("ros__parameters")
        name = ".".join(entry.path[split + 1 :])
        if name and _names_node("/".join(entry.path[:split]), full_name):
            found.pop(name, None)
            found[name] = entry
    return found


def _names_node(pattern: str, full_name: str) -> bool:
    """Whether the keys above `ros__parameters` mean a node: `/**` any, `*` one part of a name, `**` any number."""
    pattern = canonical("/" + pattern)
    if pattern == "/**":
        return True
    if not full_name:
        return False
    parts = [r"(?:/\w+)*" if part == "**" else r"/\w+" if part == "*" else "/" + re.escape(part)
             for part in pattern.split("/")[1:]]  # fmt: skip
    return re.fullmatch("".join(parts), full_name) is not None


# Expressions


class _CannotTell(Exception):
    """An expression that is not evaluated; the message says why."""


_FUNCTIONS: dict[str, Any] = {
    "str": str, "int": int, "float": float, "bool": bool, "abs": abs, "min": min, "max": max, "len": len,
    "round": round, "any": any, "all": all,
}  # fmt: skip
_METHODS = frozenset(
    ("lower", "upper", "strip", "lstrip", "rstrip", "startswith", "endswith", "replace", "capitalize", "title", "split",
     "removeprefix", "removesuffix", "isdigit", "find", "count"),
)  # fmt: skip


def evaluate(expression: str, names: Mapping[str, Any], functions: Mapping[str, Any]) -> Any:
    """The value of a small Python expression: constants, comparisons, sums, methods of str, and the names and functions
    given. Raises _CannotTell for anything else."""
    if len(expression) > 10_000:
        raise _CannotTell("is too long")
    try:
        tree = ast.parse(expression.strip(), mode="eval")
        return _Evaluator(names, functions).value(tree.body)
    except _CannotTell:
        raise
    except (SyntaxError, ValueError, TypeError, ArithmeticError, LookupError, AttributeError) as error:
        raise _CannotTell(f"`{expression[:80]}` fails: {error}") from error
    except (RecursionError, MemoryError) as error:
        raise _CannotTell("is nested too deeply") from error


class _Evaluator:
    def __init__(self, names: Mapping[str, Any], functions: Mapping[str, Any]):
        self.names = names
        self.functions = functions

    def value(self, node: ast.expr) -> Any:
        if isinstance(node, ast.Constant):
            return node.value
        if isinstance(node, ast.Name):
            if node.id in self.names:
                found = self.names[node.id]
                if isinstance(found, _CannotTell):
                    raise found
                return found
            raise _CannotTell(f"`{node.id}` is no name an expression may use")
        if isinstance(node, ast.BoolOp):
            result: Any = None
            for part in node.values:
                result = self.value(part)
                if bool(result) == isinstance(node.op, ast.Or):
                    break
            return result
        if isinstance(node, ast.UnaryOp):
            operand = self.value(node.operand)
            if isinstance(node.op, ast.Not):
                return not operand
            if isinstance(node.op, ast.USub):
                return -operand
            if isinstance(node.op, ast.UAdd):
                return +operand
        if isinstance(node, ast.BinOp):
            return self.sum(node)
        if isinstance(node, ast.Compare):
            left = self.value(node.left)
            for op, right_node in zip(node.ops, node.comparators, strict=True):
                right = self.value(right_node)
                if not _COMPARISONS[type(op)](left, right):
                    return False
                left = right
            return True
        if isinstance(node, ast.IfExp):
            return self.value(node.body if self.value(node.test) else node.orelse)
        if isinstance(node, (ast.List, ast.Tuple)):
            return [self.value(element) for element in node.elts]
        if isinstance(node, ast.Subscript):
            return self.value(node.value)[self.index(node.slice)]
        if isinstance(node, ast.Call) and not node.keywords:
            return self.call(node)
        raise _CannotTell(f"`{ast.unparse(node)[:80]}` is not evaluated")

    def index(self, node: ast.expr) -> Any:
        if not isinstance(node, ast.Slice):
            return self.value(node)
        return slice(*(None if bound is None else self.value(bound) for bound in (node.lower, node.upper, node.step)))

    def sum(self, node: ast.BinOp) -> Any:
        left, right = self.value(node.left), self.value(node.right)
        calculate = _SUMS.get(type(node.op))
        if calculate is None:
            raise _CannotTell(f"`{ast.unparse(node)[:80]}` is not evaluated")
        if isinstance(node.op, (ast.Mult, ast.Mod)) and (
            isinstance(left, (str, list)) or isinstance(right, (str, list))
        ):
            raise _CannotTell(f"`{ast.unparse(node)[:80]}` is not evaluated")
        result = calculate(left, right)
        if isinstance(result, int) and abs(result) > 2**63:
            raise _CannotTell("is too large a number")
        return result

    def call(self, node: ast.Call) -> Any:
        arguments = [self.value(argument) for argument in node.args]
        if isinstance(node.func, ast.Name):
            function = self.functions.get(node.func.id) or _FUNCTIONS.get(node.func.id)
            if function is not None:
                return function(*arguments)
        if isinstance(node.func, ast.Attribute):
            if isinstance(node.func.value, ast.Name) and node.func.value.id == "math":
                function = getattr(math, node.func.attr, None)
                if callable(function) and node.func.attr in (
                    "sqrt",
                    "sin",
                    "cos",
                    "radians",
                    "degrees",
                    "floor",
                    "ceil",
                ):
                    return function(*arguments)
            if node.func.attr in _METHODS:
                receiver = self.value(node.func.value)
                if isinstance(receiver, str):
                    return getattr(receiver, node.func.attr)(*arguments)
        raise _CannotTell(f"`{ast.unparse(node)[:80]}` is not evaluated")


_SUMS = {
    ast.Add: lambda a, b: a + b,
    ast.Sub: lambda a, b: a - b,
    ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b,
    ast.FloorDiv: lambda a, b: a // b,
    ast.Mod: lambda a, b: a % b,
}
_COMPARISONS = {
    ast.Eq: lambda a, b: a == b,
    ast.NotEq: lambda a, b: a != b,
    ast.Lt: lambda a, b: a < b,
    ast.LtE: lambda a, b: a <= b,
    ast.Gt: lambda a, b: a > b,
    ast.GtE: lambda a, b: a >= b,
    ast.In: lambda a, b: a in b,
    ast.NotIn: lambda a, b: a not in b,
    ast.Is: lambda a, b: a is b or a == b,
    ast.IsNot: lambda a, b: not (a is b or a == b),
}


def ros1_value(text: str, type_: str = "auto") -> Any:
    """A parameter of ROS 1 from its text, as roslaunch's convert_value() makes it; the text where that would fail."""
    kind = type_.lower().strip() or "auto"
    try:
        if kind == "auto":
            if "." in text:
                return float(text)
            if "_" not in text:
                return int(text)
        elif kind == "int":
            return int(text)
        elif kind == "double":
            return float(text)
    except ValueError:
        pass
    if kind in ("auto", "bool", "boolean"):
        word = text.lower().strip()
        if word in ("true", "false"):
            return word == "true"
        if kind != "auto" and word in ("1", "0"):
            return word == "1"
    if kind == "yaml":
        return _yaml_value(text)
    return text


def _yaml_value(text: str) -> Any:
    """What a text is by YAML's rules; mappings stay text."""
    if text[:1] not in ("[", "'", '"', "-", "!", "&", "{", ">", "|"):
        return scalar(text.strip())
    entries = parameters(text).entries
    return entries[0].value if len(entries) == 1 and entries[0].path == () else scalar(text)


# Following a launch


class _Scope:
    """What holds where an action runs. open: how many undecided conditions stood when it began."""

    __slots__ = ("arguments", "constants", "environment", "namespace", "open", "private", "remaps", "settings")

    def __init__(self, arguments: dict[str, Text], environment: dict[str, Text], open_: int):
        self.arguments = arguments
        self.environment = environment
        self.namespace = known("")
        self.remaps: list[Remap] = []
        self.settings: list[Setting | SettingFile] = []
        self.private: list[Action] = []
        self.constants: set[str] = set()
        self.open = open_

    def inner(self, open_: int) -> _Scope:
        """A copy, whose changes do not reach this one."""
        scope = _Scope(dict(self.arguments), dict(self.environment), open_)
        scope.namespace = self.namespace
        scope.remaps = list(self.remaps)
        scope.settings = list(self.settings)
        scope.private = list(self.private)
        scope.constants = set(self.constants)
        return scope


class _Rewrite(NamedTuple):
    """A parameter file that is changed before it is read. root: the key all is put below. changes: values by the key
    they replace; replaced: texts by what they replace."""

    source: Text
    root: Text
    changes: tuple[tuple[Text, Text], ...]
    is_text: bool


def follow(
    package: str,
    path: str,
    sources: Sources,
    arguments: Mapping[str, str] | None = None,
    environment: Mapping[str, str] | None = None,
    generation: int = 0,
) -> Launched:
    """All that the launch file `$(find package)/path` starts.

    arguments: as given on the command line. environment: variables that are known. generation: of the workspace, for
    files that could be of either.
    """
    given = {name: known(value) for name, value in (arguments or {}).items()}
    variables = {name: known(value) for name, value in (environment or {}).items()}
    launch = _Launch(sources, given, variables, generation)
    launch.top(package, posixpath.normpath(path).lstrip("/"))
    return Launched(
        tuple(launch.started),
        launch.server,
        tuple(launch.declared),
        tuple(launch.skipped),
        tuple(launch.unresolved),
        tuple(dict.fromkeys(launch.files)),
    )


class _Launch:
    """One launch under way."""

    def __init__(self, sources: Sources, arguments: dict[str, Text], environment: dict[str, Text], generation: int):
        self.sources = sources
        self.generation = generation or 2
        self.scope = _Scope(arguments, environment, 0)
        self.package = ""
        self.path = ""
        self.chain: list[At] = []
        self.open: list[str] = []
        self.assumed: list[str] = []
        self.after: list[str] = []
        self.container = known("")
        self.budget = MOST_ACTIONS
        self.rewrites: dict[str, _Rewrite] = {}
        self.started: list[Started] = []
        self.server: dict[str, Setting] = {}
        self.declared: list[Argument] = []
        self.skipped: list[Skipped] = []
        self.unresolved: list[Unresolved] = []
        self.files: list[tuple[str, str]] = []

    def top(self, package: str, path: str) -> None:
        self.package, self.path = package, path
        file = self.sources.launch(package, path)
        if file is None:
            self.unresolved.append(Unresolved(At(package, path, 0), path, ("the launch file is not there",)))
            return
        self.file(file)

    def file(self, file: LaunchFile) -> None:
        self.files.append((self.package, self.path))
        before = self.generation
        self.generation = file.generation or before
        for problem in file.problems:
            self.miss(problem.line, "the launch file", problem.message)
        self.run(file.actions)
        self.generation = before

    def at(self, line: int) -> At:
        return At(self.package, self.path, line)

    def miss(self, line: int, what: str, *reasons: str) -> None:
        unresolved = Unresolved(self.at(line), what, reasons)
        if unresolved not in self.unresolved[-20:]:
            self.unresolved.append(unresolved)

    def told(self, text: Text, line: int, what: str) -> Text:
        """The text; where it is not known that is listed."""
        if text.value is None:
            self.miss(line, f"{what} `{text.shown}`", *text.reasons)
        return text

    # Actions

    def run(self, actions: Iterable[Action]) -> None:
        for action in actions:
            self.budget -= 1
            if self.budget <= 0:
                if self.budget == 0:
                    self.miss(action.line, "the rest of the launch", f"more than {MOST_ACTIONS} actions")
                return
            verdict, open_, assumed, after = self.decide(action.conditions)
            if verdict is False:
                if action.kind in _STARTING:
                    texts = tuple(_show_condition(c) for c in action.conditions)
                    self.skipped.append(Skipped(action.kind, self.at(action.line), texts, assumed))
                continue
            marks = len(self.open), len(self.assumed), len(self.after)
            self.open += open_
            self.assumed += assumed
            self.after += after
            _DOING.get(action.kind, _Launch.do_unknown)(self, action)
            del self.open[marks[0] :], self.assumed[marks[1] :], self.after[marks[2] :]

    def decide(self, conditions: Sequence[Condition]) -> tuple[bool | None, list[str], tuple[str, ...], list[str]]:
        """Whether conditions hold (None: not known), which are not known, the defaults they rest on, and events."""
        open_: list[str] = []
        after: list[str] = []
        assumed: list[tuple[str, ...]] = []
        for condition in conditions:
            if condition.kind == "after":
                after.append(self.text(condition.value).shown)
                continue
            if condition.kind == "each":
                open_.append(show(condition.value))
                continue
            text = self.text(condition.value)
            truth = _truth(text)
            if truth is None:
                open_.append(_show_condition(condition))
                reasons = text.reasons or (f"`{text.value}` is neither true nor false",)
                self.miss(condition.line, f"condition `{_show_condition(condition)}`", *reasons)
                continue
            assumed.append(text.assumed)
            if truth == (condition.kind == "unless"):
                return False, open_, _all(assumed), after
        return (None if open_ else True), open_, _all(assumed), after

    def uncertain(self) -> bool:
        """Whether what is set here may not be set at all, as seen by what follows."""
        return len(self.open) > self.scope.open

    def set(self, name: str, text: Text) -> None:
        """An argument's new value; one set under an undecided condition is not known afterwards."""
        if self.uncertain():
            before = self.scope.arguments.get(name)
            if before is not None and before.value is not None and before.value == text.value:
                return
            shown = text.shown if before is None else f"{before.shown} or {text.shown}"
            text = unknown(shown, f"`{name}` is set only if {self.open[-1]}")
        self.scope.arguments[name] = text

    def name_of(self, action: Action) -> str | None:
        text = self.told(self.text(action.get("name") or literal("")), action.line, f"name of {action.kind}")
        return text.value

    def do_argument(self, action: Action) -> None:
        name = self.name_of(action)
        if name is None:
            return
        value, default = action.get("value"), action.get("default")
        if value is not None and self.generation == 1:
            if name in self.scope.arguments and name not in self.scope.constants:
                self.miss(action.line, f"argument `{name}`", "it is constant and is given another value")
            self.set(name, self.text(value))
            self.scope.constants.add(name)
        elif name not in self.scope.arguments:
            if default is None:
                reason = f"argument `{name}` has no default and is not given"
                self.scope.arguments[name] = unknown(f"{name}", reason)
            else:
                text = self.text(default)
                self.set(name, text._replace(assumed=_all((text.assumed, (name,)))))
        self.declared.append(Argument(name, self.scope.arguments[name], self.at(action.line)))

    def do_let(self, action: Action) -> None:
        name = self.name_of(action)
        if name is not None:
            self.set(name, self.text(action.get("value") or literal("")))

    def do_environment(self, action: Action) -> None:
        name = self.name_of(action)
        if name is not None:
            self.scope.environment[name] = self.text(action.get("value") or literal(""))

    def do_group(self, action: Action) -> None:
        scoped = action.get("scoped")
        if self.generation == 2 and scoped is not None and _truth(self.text(scoped)) is False:
            self.run(action.children)
            return
        outer, self.scope = self.scope, self.scope.inner(len(self.open))
        forwarding = action.get("forwarding")
        if forwarding is not None and _truth(self.text(forwarding)) is False:
            self.scope = _Scope({}, {}, len(self.open))
        if action.get("namespace") is not None:
            self.scope.namespace = self.inside(self.text(action.get("namespace") or literal("")))
        self.clear(action, self.scope.namespace)
        self.run(action.children)
        self.scope = outer

    def inside(self, namespace: Text) -> Text:
        """A namespace below the one that holds here, absolute."""
        base = self.scope.namespace
        if namespace.value == "":
            return base
        return within(base if base.value != "" else known("/"), namespace)

    def do_namespace(self, action: Action) -> None:
        pushed = self.text(action.get("namespace") or literal(""))
        namespace = self.inside(pushed)
        if self.uncertain() and namespace.value != self.scope.namespace.value:
            namespace = unknown(
                f"{self.scope.namespace.shown or '/'} or {namespace.shown}", f"pushed only if {self.open[-1]}"
            )
        self.scope.namespace = namespace

    def do_remap(self, action: Action) -> None:
        self.scope.remaps.append(self.remap(action))

    def remap(self, action: Action) -> Remap:
        old = self.told(self.text(action.get("from") or literal("")), action.line, "remapping from")
        new = self.told(self.text(action.get("to") or literal("")), action.line, "remapping to")
        return Remap(old, new, self.at(action.line), tuple(self.open[self.scope.open :]))

    def do_include(self, action: Action) -> None:
        file = self.told(self.text(action.get("file") or literal("")), action.line, "include")
        if file.value is None:
            return
        place = self.place(file.value)
        if place is None:
            self.miss(action.line, f"include `{file.shown}`", "it lies in no package that is named")
            return
        found = self.sources.launch(*place)
        if found is None:
            self.miss(action.line, f"include `{file.shown}`", "the file is not in the workspace")
            return
        if len(self.chain) >= DEEPEST or [(a.package, a.path) for a in self.chain].count(place) > 3:
            self.miss(action.line, f"include `{file.shown}`", "includes go round in a circle or too deep")
            return
        outer = self.scope, self.package, self.path
        if (found.generation or self.generation) == 1:
            self.scope = self.scope1(action)
        else:
            # One after the other: the value of one argument may name an argument given before it.
            for name, text in self.passed(action):
                self.scope.arguments[name] = text
        self.chain.append(self.at(action.line))
        self.package, self.path = place
        self.assumed += file.assumed
        self.file(found)
        del self.assumed[len(self.assumed) - len(file.assumed) :]
        self.chain.pop()
        scope, self.package, self.path = outer
        self.scope = scope

    def passed(self, action: Action) -> Iterator[tuple[str, Text]]:
        """The arguments given to an include, in order, each filled in when it is asked for."""
        for child in action.children:
            if child.kind == "unknown":
                self.do_unknown(child)
                continue
            if child.kind != "pass":
                continue
            verdict, open_, _, _ = self.decide(child.conditions)
            name = self.name_of(child)
            if verdict is False or name is None:
                continue
            value, default = child.get("value"), child.get("default")
            text = self.text(value if value is not None else default if default is not None else literal(""))
            if verdict is None:
                text = unknown(text.shown, f"`{name}` is given only if {open_[-1]}")
            yield name, text

    def scope1(self, action: Action) -> _Scope:
        """The scope of a file that roslaunch includes: namespace and remappings are passed on, arguments only as
        given."""
        scope = self.scope.inner(len(self.open))
        if action.get("namespace") is not None:
            scope.namespace = self.inside(self.text(action.get("namespace") or literal("")))
        self.clear(action, scope.namespace)
        all_ = action.get("pass-all")
        scope.arguments = dict(self.scope.arguments) if all_ is not None and _truth(self.text(all_)) else {}
        scope.arguments.update(list(self.passed(action)))
        # With pass_all_args, a constant of the included file replaces what is passed without complaint
        scope.constants = set(scope.arguments) if all_ is not None else set()
        return scope

    def clear(self, action: Action, namespace: Text) -> None:
        clear = action.get("clear")
        if clear is not None and namespace.value and _truth(self.text(clear)):
            self.forget(namespace.value)

    def forget(self, name: str) -> None:
        """Removes parameters of the server below a name."""
        for key in [key for key in self.server if key == name or key.startswith(f"{name.rstrip('/')}/")]:
            del self.server[key]

    def do_unknown(self, action: Action) -> None:
        text = action.get("text")
        self.miss(action.line, show(text) if text is not None else action.kind, "it cannot be followed")

    def do_nothing(self, action: Action) -> None:
        """What has no place where it stands."""

    # Parameters

    def do_parameter(self, action: Action) -> None:
        if self.generation == 1:
            name = self.text(action.get("name") or literal(""))
            if name.value is not None and name.value[:1] == "~":
                self.scope.private.append(action)
                return
            self.serve(action, self.scope.namespace)
            return
        setting = self.setting(action)
        if setting is not None:
            self.scope.settings.append(setting)

    def do_parameter_file(self, action: Action) -> None:
        if self.generation == 1:
            self.serve_file(action, self.scope.namespace)
            return
        self.scope.settings.append(self.setting_file(action))

    def setting(self, action: Action) -> Setting | None:
        """A parameter of a ROS 2 node."""
        name = self.name_of(action)
        if name is None:
            return None
        text = self.text(action.get("value") or literal(""))
        type_ = plain(action.get("type")) or ""
        value: Any = text.value
        if value is not None and type_ not in ("str", "string"):
            value = _yaml_value(value)
        return Setting(name, value, text, self.at(action.line), tuple(self.open[self.scope.open :]))

    def setting_file(self, action: Action) -> SettingFile:
        """A parameter file of a ROS 2 node."""
        file = self.text(action.get("file") or literal(""))
        at, conditions = self.at(action.line), tuple(self.open[self.scope.open :])
        if file.value is None:
            self.miss(action.line, f"parameters `{file.shown}`", *file.reasons)
            return SettingFile(file, None, at, conditions)
        if file.value == "":
            return SettingFile(file, (), at, conditions)
        entries = self.entries(file.value, action.line)
        if entries is not None and plain(action.get("substitute")) is not None:
            entries = tuple(self.substituted(entry) for entry in entries)
        below = [self.text(key).value for key in action.all("below")]
        name = action.get("name")
        if not below and name is None:
            return SettingFile(file, entries, at, conditions)
        prefix = (self.text(name).shown,) if name is not None else ()
        if entries is not None:
            entries = tuple(
                Entry((*prefix, *entry.path[len(below) :]), entry.value, entry.line)
                for entry in entries
                if list(entry.path[: len(below)]) == below
            )
        return SettingFile(file, entries, at, conditions, True)

    def substituted(self, entry: Entry) -> Entry:
        """An entry whose keys or values hold substitutions, filled in where that can be done."""
        path = tuple(self.filled(part) if "$(" in part else part for part in entry.path)
        return Entry(path, self.filled_value(entry.value), entry.line)

    def filled(self, text: str) -> str:
        made = self.text(substitutions(text, self.generation))
        return text if made.value is None else made.value

    def filled_value(self, value: Any) -> Any:
        if isinstance(value, str) and "$(" in value:
            return _yaml_value(self.filled(value))
        if isinstance(value, list):
            return [self.filled_value(item) for item in value]
        if isinstance(value, dict):
            return {self.filled(key): self.filled_value(item) for key, item in value.items()}
        return value

    def entries(self, file: str, line: int) -> tuple[Entry, ...] | None:
        """The entries of a parameter file, changed as it is before it is read; None where it cannot be had."""
        rewrite = self.rewrites.get(file)
        if rewrite is not None:
            if rewrite.source.value is None:
                self.miss(line, f"parameters `{rewrite.source.shown}`", *rewrite.source.reasons)
                return None
            entries = self.entries(rewrite.source.value, line)
            return None if entries is None else _rewritten(entries, rewrite)
        place = self.place(file)
        if place is None:
            self.miss(line, f"parameters `{file}`", "the file lies in no package that is named")
            return None
        found = self.sources.parameters(*place)
        if found is None:
            self.miss(line, f"parameters `{file}`", "the file is not in the workspace")
            return None
        for problem in found.problems:
            self.miss(line, f"parameters `{file}`, line {problem.line}", problem.message)
        return found.entries

    def serve(self, action: Action, namespace: Text) -> None:
        """Puts a <param> of ROS 1 on the server, below a namespace."""
        name = self.text(action.get("name") or literal(""))
        if name.value is not None and name.value[:1] == "~":
            name = known(name.value[1:], name.assumed)
        full = self.told(within(namespace if namespace.value != "" else known("/"), name), action.line, "parameter")
        if full.value is None:
            return
        given = next((key for key in ("textfile", "binfile", "command") if action.get(key) is not None), "value")
        if given == "value":
            text = self.text(action.get("value") or literal(""))
        else:
            what = {"command": "the output of a command"}.get(given, "the content of a file")
            text = unknown(show(action.get(given) or literal("")), f"it is {what}")
        value = None
        if text.value is not None:
            value = ros1_value(text.value.strip(), plain(action.get("type")) or "auto")
        self.put(full.value, value, text, action.line)

    def put(self, name: str, value: Any, text: Text, line: int) -> None:
        if self.open:
            before = self.server.get(name)
            if before is not None and before.text.value != text.value:
                text, value = unknown(f"{before.text.shown} or {text.shown}", f"set only if {self.open[-1]}"), None
        self.server.pop(name, None)
        self.server[name] = Setting(name, value, text, self.at(line), tuple(self.open))

    def serve_file(self, action: Action, namespace: Text) -> None:
        """Does a <rosparam>."""
        below = self.text(action.get("name") or literal(""))
        base = namespace if namespace.value != "" else known("/")
        if below.value is not None and below.value[:1] == "~":
            below = known(below.value[1:].lstrip("/"), below.assumed)
        full = base if below.value == "" else within(base, below)
        if self.told(full, action.line, "parameters below").value is None:
            return
        command = plain(action.get("command")) or "load"
        if command == "delete":
            self.forget(full.value or "/")
        if command != "load":
            return
        substitute = action.get("substitute")
        fill = substitute is not None and _truth(self.text(substitute)) is True
        file, content = action.get("file"), action.get("text")
        if file is not None:
            text = self.told(self.text(file), action.line, "parameters")
            entries = self.entries(text.value, action.line) if text.value is not None else None
            assumed = text.assumed
        else:
            # What is filled in may be any piece of YAML, so that it comes before reading.
            text = self.text(content or literal(""))
            entries, assumed, fill = parameters(text.shown).entries, text.assumed, False
        for entry in entries or ():
            filled = self.substituted(entry) if fill else entry
            key = "/".join(part.strip("/") for part in (full.value or "/", *filled.path) if part.strip("/"))
            self.put(f"/{key}", filled.value, known(str(filled.value), assumed), action.line)

    # Nodes

    def do_node(self, action: Action) -> None:
        if self.generation == 1:
            self.node1(action)
        else:
            self.node2(action, known(""))

    def node2(self, action: Action, container: Text) -> None:
        package, executable, plugin = (self.field(action, key) for key in ("package", "executable", "plugin"))
        name = self.field(action, "name")
        namespace = self.field(action, "namespace")
        full_namespace = self.scope.namespace if namespace.value == "" else self.inside(namespace)
        arguments = tuple(self.text(value) for value in action.all("arguments"))
        outer = self.scope
        self.scope = outer.inner(len(self.open))
        first_remaps, first_settings, renamed, moved = self.ros_arguments(arguments, action.line)
        self.run(child for child in action.children if child.kind in _OF_NODE)
        remaps, settings = self.scope.remaps, self.scope.settings
        self.scope = outer
        if moved is not None:
            full_namespace = within(known("/"), moved)
        if renamed is not None:
            name = renamed
        kind = action.kind if action.kind in ("lifecycle", "container", "composable", "test") else "node"
        started = self.begin(
            action,
            kind,
            package=package,
            executable=executable,
            plugin=plugin,
            container=container,
            name=name,
            namespace=full_namespace,
            remaps=(*first_remaps, *remaps),
            settings=(*first_settings, *settings),
            arguments=arguments,
        )
        if kind == "container":
            self.load(action, started.full_name)

    def field(self, action: Action, key: str) -> Text:
        return self.text(action.get(key) or literal(""))

    def begin(self, action: Action, kind: str, **fields: Any) -> Started:
        """Notes that an action starts something. fields: those of Started that are not empty."""
        empty = known("")
        texts: dict[str, Any] = {key: fields.get(key, empty) for key in _TEXTS}
        lists: dict[str, Any] = {key: tuple(fields.get(key, ())) for key in ("remaps", "settings", "arguments")}
        started = Started(
            kind=kind,
            generation=self.generation,
            **texts,
            **lists,
            conditions=tuple(self.open),
            assumed=_all([tuple(self.assumed)]),
            after=tuple(self.after),
            at=self.at(action.line),
            chain=tuple(self.chain),
        )
        self.started.append(started)
        for key, text in texts.items():
            self.told(text, action.line, f"{key} of {kind}")
        return started

    def ros_arguments(
        self, arguments: Sequence[Text], line: int
    ) -> tuple[list[Remap], list[Setting | SettingFile], Text | None, Text | None]:
        """Remappings, parameters, name and namespace that ROS 2 arguments on a command line give."""
        remaps: list[Remap] = []
        settings: list[Setting | SettingFile] = []
        name: Text | None = None
        namespace: Text | None = None
        inside, option = False, ""
        for text in arguments:
            word = text.value
            if word == "--ros-args":
                inside, option = True, ""
            elif word == "--":
                inside = False
            elif not inside:
                continue
            elif word in ("-r", "--remap", "-p", "--param", "--params-file"):
                option = word
            elif option and word is not None:
                old, _, new = word.partition(":=")
                rule = ros2_rule(word)
                if option in ("-r", "--remap") and rule is not None:
                    if rule.match in ("__node", "__name"):
                        name = name or known(new, text.assumed)
                    elif rule.match == "__ns":
                        namespace = namespace or known(new, text.assumed)
                    else:
                        remaps.append(Remap(known(old), known(new, text.assumed), self.at(line)))
                elif option in ("-p", "--param"):
                    settings.append(Setting(old, _yaml_value(new), known(new, text.assumed), self.at(line)))
                elif option == "--params-file":
                    settings.append(SettingFile(text, self.entries(word, line), self.at(line)))
                option = ""
            elif option:
                self.miss(line, f"argument `{option} {text.shown}`", *text.reasons)
                option = ""
        return remaps, settings, name, namespace

    def load(self, action: Action, container: Text) -> None:
        """Starts the composable nodes below an action."""
        outer, self.scope = self.scope, self.scope.inner(len(self.open))
        before, self.container = self.container, container
        self.run(child for child in action.children if child.kind == "composable")
        self.container = before
        self.scope = outer

    def do_load(self, action: Action) -> None:
        own = action.get("container-node")
        if own is not None:
            container = self.inside(self.text(own))
        else:
            container = within(known("/"), self.field(action, "container"))
        self.load(action, self.told(container, action.line, "container"))

    def do_composable(self, action: Action) -> None:
        self.node2(action, self.container)

    def do_process(self, action: Action) -> None:
        words = tuple(self.text(value) for value in action.all("command"))
        package = executable = known("")
        rest = words
        if [w.value for w in words[:2]] == ["ros2", "run"] and len(words) >= 4:
            package, executable, rest = words[2], words[3], words[4:]
        elif words:
            installed = _INSTALLED.match(words[0].value or "")
            executable, rest = words[0], words[1:]
            if installed is not None:
                package, executable = (known(part, words[0].assumed) for part in installed.groups())
        remaps, settings, name, namespace = self.ros_arguments(rest, action.line)
        self.begin(
            action,
            "process",
            package=package,
            executable=executable,
            name=name or known(""),
            namespace=namespace or known(""),
            remaps=remaps,
            settings=settings,
            arguments=words,
        )

    def node1(self, action: Action) -> None:
        package, executable, name = (self.field(action, key) for key in ("package", "executable", "name"))
        base = self.scope.namespace if self.scope.namespace.value != "" else known("/")
        namespace = within(base, self.field(action, "namespace")) if action.get("namespace") is not None else base
        words = [word for value in action.all("arguments") for word in self.split(self.text(value))]
        for text in words:
            if text.value is not None and text.value.startswith("__name:="):
                name = known(text.value[8:], text.assumed)
            elif text.value is not None and text.value.startswith("__ns:="):
                namespace = within(known("/"), known(text.value[6:], text.assumed))
        full = within(namespace, name)
        if full.value is not None:
            self.clear(action, full)
        outer, self.scope = self.scope, self.scope.inner(len(self.open))
        self.scope.remaps = []
        own: list[Remap] = []
        given: list[tuple[Action, list[str]]] = [(action, []) for action in self.scope.private]
        for child in action.children:
            verdict, open_, _, _ = self.decide(child.conditions)
            if verdict is False:
                continue
            self.open += open_
            if child.kind == "remap":
                own.append(self.remap(child))
            elif child.kind == "parameter":
                given.append((child, open_))
            elif child.kind == "parameter-file" and full.value is not None:
                self.serve_file(child, full)
            del self.open[len(self.open) - len(open_) :]
        self.scope = outer
        # Files are loaded as they are met, then come the private parameters of the scope, then the node's own.
        for child, open_ in given if full.value is not None else ():
            self.open += open_
            self.serve(child, full)
            del self.open[len(self.open) - len(open_) :]
        remaps = _without_earlier([*self.scope.remaps, *own])
        for text in words:
            old, sign, new = (text.value or "").partition(":=")
            if not sign or old.startswith("__"):
                continue
            if old.startswith("_"):
                if full.value is not None:
                    self.put(f"{full.value}/{old[1:]}", ros1_value(new), known(new, text.assumed), action.line)
            else:
                remaps.append(Remap(known(old), known(new, text.assumed), self.at(action.line)))
        kind, plugin, container = ("test" if action.kind == "test" else "node"), known(""), known("")
        if package.value == "nodelet" and words:
            command = words[0].value
            if command == "manager":
                kind = "container"
            elif command in ("load", "standalone") and len(words) > 1:
                plugin = words[1]
                kind = "composable" if command == "load" else "node"
                if command == "load" and len(words) > 2:
                    container = within(namespace, words[2])
        self.begin(
            action,
            kind,
            package=package,
            executable=executable,
            plugin=plugin,
            container=container,
            name=name,
            namespace=namespace,
            remaps=remaps,
            arguments=words,
        )

    def split(self, text: Text) -> list[Text]:
        """The words of one argument, which a substitution may have brought several of."""
        if text.value is None:
            return [text]
        return [known(word, text.assumed) for word in text.value.split()] if " " in text.value else [text]

    # Substitutions

    def place(self, path: str) -> tuple[str, str] | None:
        """Package and path in it of a file below a package's share folder."""
        m = _PLACE.match(path)
        if m is None:
            return None
        inner = posixpath.normpath(m[2].lstrip("/")) if m[2].strip("/") else ""
        return None if inner.startswith("..") or not inner else (m[1], inner)

    def text(self, value: Value) -> Text:
        """A value with its substitutions filled in."""
        if len(value) == 1:
            return self.piece(value[0])
        return together([self.piece(piece) for piece in value])

    def piece(self, piece: Piece) -> Text:
        if piece.kind == "text":
            return known(piece.text)
        if piece.kind == "other":
            return unknown(piece.text, "it is only known when it runs")
        maker = _FILLING.get(piece.kind)
        if maker is None or len(piece.parts) < _PARTS.get(piece.kind, 0):
            return unknown(piece.kind, f"`{piece.kind}` is not filled in")
        return maker(self, piece)

    def named(self, piece: Piece) -> tuple[Text, tuple[Value, ...]]:
        """A piece's name, and its other parts."""
        if piece.text:
            return known(piece.text), piece.parts
        return (self.text(piece.parts[0]), piece.parts[1:]) if piece.parts else (known(""), ())

    def fill_arg(self, piece: Piece) -> Text:
        name, rest = self.named(piece)
        if name.value is None:
            return unknown(name.shown, *name.reasons)
        text = self.scope.arguments.get(name.value)
        if text is not None:
            return text._replace(assumed=_all((text.assumed, name.assumed)))
        if rest:
            default = self.text(rest[0])
            return default._replace(assumed=_all((default.assumed, (name.value,))))
        return unknown(name.value, f"argument `{name.value}` has no value")

    def fill_env(self, piece: Piece) -> Text:
        name, rest = self.named(piece)
        if name.value is None:
            return unknown(name.shown, *name.reasons)
        text = self.scope.environment.get(name.value)
        if text is not None:
            return text
        if rest:
            default = self.text(rest[0])
            return default._replace(assumed=_all((default.assumed, (f"${name.value}",))))
        return unknown(f"${name.value}", f"the environment variable `{name.value}` is not known")

    def fill_package(self, piece: Piece) -> Text:
        name, _ = self.named(piece)
        if name.value is None:
            return unknown(f"$({piece.kind} {name.shown})", *name.reasons)
        return known(f"$({piece.kind} {name.value})", name.assumed)

    def fill_executable(self, piece: Piece) -> Text:
        name, package = (self.text(part) for part in piece.parts[:2])
        return together((known("$(prefix "), package, known(")/lib/"), package, known("/"), name))

    def fill_program(self, piece: Piece) -> Text:
        return self.named(piece)[0]

    def fill_dirname(self, piece: Piece) -> Text:
        folder = posixpath.dirname(self.path)
        return known(f"$(find {self.package})" + (f"/{folder}" if folder else ""))

    def fill_filename(self, piece: Piece) -> Text:
        return known(f"$(find {self.package})/{self.path}")

    def fill_anon(self, piece: Piece) -> Text:
        name, _ = self.named(piece)
        return Text(None, f"{name.shown}_<anonymous>", ("an anonymous name is made up at every start",))

    def fill_command(self, piece: Piece) -> Text:
        return unknown(show((piece,)), "it is the output of a command")

    def fill_content(self, piece: Piece) -> Text:
        return unknown(show((piece,)), "it is the content of a file")

    def fill_join(self, piece: Piece) -> Text:
        texts: list[Text] = []
        for part in piece.parts:
            text = self.text(part)
            if (text.value is not None and text.value[:1] == "/") or (text.value or "").startswith("$("):
                texts = []
            texts.append(text)
        if not texts:
            return known("")
        done = [t._replace(value=t.value.rstrip("/") if t.value is not None else None, shown=t.shown.rstrip("/"))
                for t in texts[:-1]]  # fmt: skip
        return together([*done, texts[-1]], "/")

    def fill_equals(self, piece: Piece) -> Text:
        left, right = (self.text(part) for part in piece.parts[:2])
        both = together((left, right))
        if both.value is None:
            return both._replace(shown=show((piece,)))
        return known(_flag(left.value == right.value), both.assumed)

    def fill_in(self, piece: Piece) -> Text:
        texts = [self.text(part) for part in piece.parts]
        both = together(texts)
        if both.value is None:
            return both._replace(shown=show((piece,)))
        return known(_flag(texts[0].value in [t.value for t in texts[1:]]), both.assumed)

    def fill_not(self, piece: Piece) -> Text:
        text = self.text(piece.parts[0]) if piece.parts else known("")
        truth = _truth(text)
        if truth is None:
            return unknown(show((piece,)), *(text.reasons or (f"`{text.value}` is neither true nor false",)))
        return known(_flag(not truth), text.assumed)

    def fill_logic(self, piece: Piece) -> Text:
        """`and` and `or`: what decides them alone is enough."""
        deciding = piece.kind == "or"
        texts = [self.text(part) for part in piece.parts]
        truths = [_truth(text) for text in texts]
        for text, truth in zip(texts, truths, strict=True):
            if truth is deciding:
                return known(_flag(deciding), text.assumed)
        if None in truths:
            return unknown(show((piece,)), *_all(t.reasons for t in texts))
        return known(_flag(not deciding), _all(t.assumed for t in texts))

    def fill_choose(self, piece: Piece) -> Text:
        asked = self.text(piece.parts[0])
        truth = _truth(asked)
        if truth is None:
            yes, no = (self.text(part) for part in piece.parts[1:3])
            if yes.value is not None and yes.value == no.value:
                return yes
            reasons = asked.reasons or (f"`{asked.value}` is neither true nor false",)
            return unknown(f"{yes.shown} or {no.shown}", *reasons)
        text = self.text(piece.parts[1 if truth else 2])
        return text._replace(assumed=_all((text.assumed, asked.assumed)))

    def fill_method(self, piece: Piece) -> Text:
        texts = [self.text(part) for part in piece.parts]
        both = together(texts)
        if both.value is None or piece.text not in _METHODS:
            return unknown(show((piece,)), *both.reasons)
        try:
            result = getattr(texts[0].value, piece.text)(*(t.value for t in texts[1:]))
        except (TypeError, ValueError) as error:
            return unknown(show((piece,)), f"`{piece.text}` fails: {error}")
        return known(_flag(result) if isinstance(result, bool) else str(result), both.assumed)

    def fill_rewritten(self, piece: Piece) -> Text:
        """A changed parameter file: its name stands for it until it is read."""
        texts = [self.text(part) for part in piece.parts]
        is_text = piece.kind == "replaced"
        source, rest = texts[0], texts[1:] if is_text else texts[2:]
        pairs = tuple(zip(rest[::2], rest[1::2], strict=False))
        rewrite = _Rewrite(source, known("") if is_text else texts[1], pairs, is_text)
        name = f"$({piece.kind} {source.shown} {len(self.rewrites)})"
        self.rewrites[name] = rewrite
        return known(name, source.assumed)

    def fill_has_node(self, piece: Piece) -> Text:
        file, node = (self.text(part) for part in piece.parts[:2])
        both = together((file, node))
        entries = self.entries(file.value, 0) if both.value is not None and file.value is not None else None
        if entries is None:
            return unknown(show((piece,)), *(both.reasons or ("the file is not in the workspace",)))
        return known(_flag(any(node.value in entry.path[:-1] for entry in entries)), both.assumed)

    def fill_eval(self, piece: Piece) -> Text:
        expression = self.text(piece.parts[0])
        if expression.value is None:
            return unknown(f"$(eval {expression.shown})", *expression.reasons, assumed=expression.assumed)
        used: list[tuple[str, ...]] = [expression.assumed]

        def argument(name: str) -> Any:
            text = self.fill_arg(Piece("arg", name))
            if text.value is None:
                raise _CannotTell(*text.reasons)
            used.append(text.assumed)
            return ros1_value(text.value)

        def variable(name: str, *default: str) -> str:
            text = self.fill_env(Piece("env", name, tuple(literal(d) for d in default)))
            if text.value is None:
                raise _CannotTell(*text.reasons)
            used.append(text.assumed)
            return text.value

        functions: dict[str, Any] = {}
        names: Any = {"True": True, "False": False, "None": None, "pi": math.pi}
        if piece.text == "roslaunch":
            functions = {
                "arg": argument,
                "env": variable,
                "optenv": lambda name, default="": variable(name, default),
                "find": lambda package: f"$(find {package})",
                "dirname": lambda: self.fill_dirname(piece).value,
            }
            names = _Arguments(self.scope.arguments, argument)
        try:
            result = evaluate(expression.value, names, functions)
        except _CannotTell as error:
            return unknown(f"$(eval {expression.value[:80]})", str(error), assumed=_all(used))
        return known(str(result), _all(used))


class _Arguments(dict):
    """The names that an expression of roslaunch sees: launch arguments, and a few constants."""

    def __init__(self, arguments: Mapping[str, Text], look: Any):
        super().__init__(true=True, false=False, True_=True, pi=math.pi)
        self.arguments = arguments
        self.look = look

    def __contains__(self, name: object) -> bool:
        return super().__contains__(name) or name in self.arguments

    def __getitem__(self, name: str) -> Any:
        return super().__getitem__(name) if super().__contains__(name) else self.look(name)


_PLACE = re.compile(r"\$\(find ([\w.-]+)\)(/.*|)\Z", re.DOTALL)
_INSTALLED = re.compile(r"\$\(prefix ([\w.-]+)\)/lib/\1/([^/]+)\Z")
_TEXTS = ("package", "executable", "plugin", "container", "name", "namespace")
_OF_NODE = frozenset(("remap", "parameter", "parameter-file", "unknown"))
_STARTING = frozenset(("node", "lifecycle", "test", "container", "composable", "load", "include", "group", "process"))
_DOING = {
    "argument": _Launch.do_argument,
    "let": _Launch.do_let,
    "environment": _Launch.do_environment,
    "group": _Launch.do_group,
    "namespace": _Launch.do_namespace,
    "remap": _Launch.do_remap,
    "include": _Launch.do_include,
    "parameter": _Launch.do_parameter,
    "parameter-file": _Launch.do_parameter_file,
    "node": _Launch.do_node,
    "lifecycle": _Launch.do_node,
    "test": _Launch.do_node,
    "container": _Launch.do_node,
    "composable": _Launch.do_composable,
    "load": _Launch.do_load,
    "process": _Launch.do_process,
    "pass": _Launch.do_nothing,
}
_FILLING = {
    "arg": _Launch.fill_arg,
    "env": _Launch.fill_env,
    "find": _Launch.fill_package,
    "prefix": _Launch.fill_package,
    "executable": _Launch.fill_executable,
    "program": _Launch.fill_program,
    "dirname": _Launch.fill_dirname,
    "filename": _Launch.fill_filename,
    "anon": _Launch.fill_anon,
    "command": _Launch.fill_command,
    "content": _Launch.fill_content,
    "join": _Launch.fill_join,
    "equals": _Launch.fill_equals,
    "in": _Launch.fill_in,
    "not": _Launch.fill_not,
    "and": _Launch.fill_logic,
    "or": _Launch.fill_logic,
    "choose": _Launch.fill_choose,
    "method": _Launch.fill_method,
    "rewritten": _Launch.fill_rewritten,
    "replaced": _Launch.fill_rewritten,
    "has-node": _Launch.fill_has_node,
    "eval": _Launch.fill_eval,
}


# How many parts a piece needs before it can be filled in.
_PARTS = {"executable": 2, "equals": 2, "in": 1, "choose": 3, "method": 1, "rewritten": 2, "replaced": 1, "has-node": 2,
          "eval": 1}  # fmt: skip


def _truth(text: Text) -> bool | None:
    """What roslaunch and launch make of a text that is asked: True, False, or None for what they refuse."""
    if text.value is None:
        return None
    return {"true": True, "1": True, "false": False, "0": False}.get(text.value.strip().lower())


def _flag(value: bool) -> str:
    return "true" if value else "false"


def _without_earlier(remaps: list[Remap]) -> list[Remap]:
    """Remappings less those for whose name there is a later one, as roslaunch keeps them."""
    kept: list[Remap] = []
    for remap in remaps:
        if remap.old.value is not None and not remap.conditions:
            kept = [k for k in kept if k.old.value is None or canonical(k.old.value) != canonical(remap.old.value)]
        kept.append(remap)
    return kept


def _rewritten(entries: Sequence[Entry], rewrite: _Rewrite) -> tuple[Entry, ...]:
    """Entries as RewrittenYaml or ReplaceString of nav2_common would leave them."""
    if rewrite.is_text:
        return tuple(_replaced(entry, rewrite.changes) for entry in entries)
    changes = {old.value: new for old, new in rewrite.changes if old.value is not None}
    root = (rewrite.root.value,) if rewrite.root.value else ()
    made: list[Entry] = []
    for entry in entries:
        new = changes.get(".".join(entry.path), changes.get(entry.path[-1] if entry.path else ""))
        value = entry.value
        if new is not None:
            value = scalar(new.value) if new.value else new.shown
        made.append(Entry((*root, *entry.path), value, entry.line))
    return tuple(made)


def _replaced(entry: Entry, changes: tuple[tuple[Text, Text], ...]) -> Entry:
    def change(text: str) -> str:
        for old, new in changes:
            if old.value:
                text = text.replace(old.value, new.value if new.value is not None else new.shown)
        return text

    value = entry.value
    if isinstance(value, str):
        value = change(value)
    elif isinstance(value, list):
        value = [change(item) if isinstance(item, str) else item for item in value]
    path = tuple(part for key in entry.path for part in [change(key)] if part)
    return Entry(path, value, entry.line)
