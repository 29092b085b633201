"""Explores callbacks of Python nodes: makes the node, gives the callback a symbolic message, follows every way."""

from __future__ import annotations

import ast
import time
from dataclasses import dataclass
from typing import Any, NamedTuple

import z3

from ..ir.solving import Solving
from ..outcomes import Bounds, CallbackPath, CrashKind, Exploration, Reaction
from .habits import describe_class, list_called_by, list_read_attributes, list_read_names, list_set_globals
from .library import make_like
from .machine import PythonMachine
from .messages import Messages
from .modules import FindModule, Handle, ModuleCode, PythonClass, PythonFunction, PythonObject, Scope, Unsettled
from .run import PythonRun, PythonThrownError
from .terms import ArrayValue, ListValue, NotModelledError, Opaque, Record, SymbolicText, is_number

_KINDS = {
    "ZeroDivisionError": CrashKind.DIVISION, "IndexError": CrashKind.INDEX, "AssertionError": CrashKind.ASSERTION,
}  # fmt: skip


_ACTION_PARTS = {"execute": "Goal", "goal": "Goal", "feedback": "Feedback", "done": "Result"}
_LAST_STATE = 9
"""Of a goal, as actionlib_msgs/GoalStatus has them."""
_ANSWERING = frozenset(("execute", "goal", "cancel"))
"""What callbacks of actions are for whose value is sent to the client, as rclpy has it."""
RESPONSE = "response"
"""The path of what a service answers."""


class CallbackCode(NamedTuple):
    """Where a callback stands. name: dotted from its module on: `Driver.on_command`. message: `package/Name`, empty for
    a timer, the type of the service for one of these. joined: the types of all messages that a synchronizer gives it,
    empty where it is given one; place: of this one among them. kind: as of a callback; has_response: a service gives it
    the response to fill in, as rclpy does. role: of an action's callback: what it is for."""

    module: ModuleCode
    name: str
    line: int
    message: str
    joined: tuple[str, ...] = ()
    place: int = 0
    kind: str = "subscriber"
    has_response: bool = False
    role: str = ""

    def list_messages(self) -> list[tuple[str, str]]:
        """The messages that it is given: path of the input, type. A response is empty, and no input."""
        if self.kind == "service":
            response = [(RESPONSE, f"{self.message}Response")] if self.has_response else []
            return [("request", f"{self.message}Request"), *response]
        if self.kind == "action":
            part = _ACTION_PARTS.get(self.role, "")
            return [(part.lower(), f"{self.message}{part}")] if part else []
        if not self.joined:
            return [("msg", self.message)] if self.message else []
        return [("msg" if at == self.place else f"msg{at + 1}", type_) for at, type_ in enumerate(self.joined)]


def explore_callback(
    callback: CallbackCode, messages: Messages, find_module: FindModule, bounds: Bounds
) -> Exploration:
    """All ways through a callback within bounds. Nothing of the program runs; what cannot be executed on symbolic
    values is an unknown way with its reason."""
    started = time.monotonic()
    deadline = started + bounds.seconds
    found = Exploration(bounds=bounds)
    pending: list[list[bool]] = [[]]
    prepared: list[bool | None] = []
    solving = Solving(deadline, found.inputs)
    while pending:
        if time.monotonic() > deadline or len(found.paths) >= bounds.paths:
            break
        run = PythonRun(pending.pop(), bounds, found.inputs, deadline, prepared, solving)
        path = _take_way(callback, run, messages, find_module)
        found.instructions += run.steps
        pending.extend(run.open_ways)
        if path is not None:
            found.paths.append(path)
    found.left = len(pending)
    found.exceeded = frozenset(solving.exceeded)
    found.seconds = time.monotonic() - started
    return found


def _take_way(
    callback: CallbackCode, run: PythonRun, messages: Messages, find_module: FindModule
) -> CallbackPath | None:
    """One way through a callback; None where no input takes it."""
    modules: dict[str, ModuleCode] = {}

    def find_fresh(name: str) -> ModuleCode | None:
        # Every way begins with modules as they are when the program starts.
        if name not in modules:
            code = find_module(name)
            if code is None:
                return None
            modules[name] = ModuleCode(code.name, code.path, code.tree)
        return modules[name]

    machine = PythonMachine(run, messages, find_fresh)
    module = ModuleCode(callback.module.name, callback.module.path, callback.module.tree)
    modules[module.name] = module
    watch = _Watch(machine)
    try:
        machine.is_quiet = run.is_preparing = True
        machine.load(module)
        owner, function = _find_callback(machine, module, callback)
        node: PythonObject | None = None
        if owner is not None:
            node = _make_node(machine, owner, function.name)
        _free_globals(machine, function.scope.module)
        _forget_preparation(run)
        watch.start(node, function)
        given: list[Any] = [] if node is None else [node]
        if callback.kind == "action":
            given.extend(_make_action_arguments(callback, messages, run))
        for path, type_ in callback.list_messages() if callback.kind != "action" else ():
            if path == RESPONSE:
                given.append(messages.make_empty(type_))
            else:
                given.append(messages.make_input(run, type_, path) if type_ else Opaque(path))
        machine.is_quiet = False
        run.is_preparing = False
        returned = machine.call_function(function, [*given, *_make_others(function, len(given))], {})
        answers = callback.kind == "service" or (callback.has_response and callback.role in _ANSWERING)
        if answers and returned is not None:
            run.note_effect("reply", RESPONSE)
        watch.finish()
    except PythonThrownError as error:
        return _make_crash(run, error)
    except NotModelledError as error:
        return _make_path(run, Reaction.UNKNOWN, reason=str(error))
    except RecursionError:
        return _make_path(run, Reaction.UNKNOWN, reason="nested too deep")
    except z3.Z3Exception as error:
        return _make_path(run, Reaction.UNKNOWN, reason=f"the solver refused a term: {str(error)[:80]}")
    except Exception as error:  # a mistake of the executor is no verdict on the program
        return _make_path(
            run, Reaction.UNKNOWN, reason=f"the executor failed: {type(error).__name__}: {str(error)[:80]}"
        )
    possible = run.is_possible()
    if possible is False:
        return None
    if possible is None:
        return _make_path(run, Reaction.UNKNOWN, reason="a condition that the solver could not decide")
    if run.effects:
        return _make_path(run, Reaction.HANDLED)
    if run.not_modelled:
        names = ", ".join(list(run.not_modelled)[:3])
        return _make_path(run, Reaction.UNKNOWN, reason=f"what {names} does is not known")
    return _make_path(run, Reaction.LOG_ONLY if run.logs else Reaction.IGNORED)


def _make_action_arguments(callback: CallbackCode, messages: Messages, run: PythonRun) -> list[Any]:
    """What a callback of an action is given: messages in rospy, handles and futures in rclpy."""

    def make(part: str) -> Any:
        return messages.make_input(run, f"{callback.message}{part}", part.lower())

    role = callback.role
    if not callback.has_response:
        if role == "done":
            return [run.get_number("state", _LAST_STATE), make("Result")]
        return [] if role == "active" else [make(_ACTION_PARTS[role])]
    if role == "goal":
        return [make("Goal")]
    if role == "feedback":
        return [Handle("action message", "feedback_msg", {"feedback": make("Feedback")})]
    if role in ("execute", "cancel", "accepted"):
        return [Handle("goal", "goal_handle", {"request": make("Goal")})]
    if role == "response":
        return [Handle("future", "future", Handle("goal", "goal_handle", {}))]
    if role == "result":
        status = run.get_whole("status", 8, True)
        result = Handle("action message", "result", {"result": make("Result"), "status": status})
        return [Handle("future", "future", result)]
    raise NotModelledError("a callback of an action whose argument is not known")


def _forget_preparation(run: PythonRun) -> None:
    """What happened while the node was made says nothing about the callback."""
    run.effects.clear()
    run.logs.clear()
    run.sent.clear()
    run.not_modelled.clear()
    run.assumed.clear()
    run.steps = 0


def _make_path(run: PythonRun, result: Reaction, **more: Any) -> CallbackPath:
    return CallbackPath(
        result, tuple(run.condition), tuple(run.effects), tuple(run.logs), tuple(run.sent), place=run.place,
        assumed=tuple(run.assumed), **more,
    )  # fmt: skip


def _make_crash(run: PythonRun, error: PythonThrownError) -> CallbackPath | None:
    possible = run.is_possible()
    if possible is False:
        return None
    if possible is None:
        return _make_path(
            run, Reaction.UNKNOWN, reason=f"a condition before {error.name} that the solver could not decide"
        )
    kind = find_crash_kind(error.name, error.detail)
    detail = f"{error.name}: {error.detail}" if error.detail else error.name
    if error.name == "SystemExit":
        return _make_path(run, Reaction.HANDLED, detail=detail)
    return CallbackPath(
        Reaction.CRASH, tuple(run.condition), tuple(run.effects), tuple(run.logs), tuple(run.sent), kind, error.place,
        detail, assumed=tuple(run.assumed),
    )  # fmt: skip


def find_crash_kind(name: str, detail: str) -> CrashKind:
    """The kind of crash that an exception of Python is, by its class and text."""
    if name in ("TypeError", "AttributeError") and "None" in detail:
        return CrashKind.NULL
    if name in ("ValueError", "OverflowError") and "convert float" in detail:
        return CrashKind.FLOAT_TO_INTEGER
    return _KINDS.get(name, CrashKind.EXCEPTION)


def _find_callback(
    machine: PythonMachine, module: ModuleCode, callback: CallbackCode
) -> tuple[PythonClass | None, PythonFunction]:
    parts = callback.name.split(".")
    value: Any = module.names.get(parts[0])
    owner: PythonClass | None = None
    for part in parts[1:]:
        if isinstance(value, PythonClass):
            owner = value
            value = value.find(part)
        else:
            value = None
    if not isinstance(value, PythonFunction):
        for node in ast.walk(module.tree):
            if isinstance(node, ast.Lambda) and node.lineno == callback.line:
                raise NotModelledError("a callback that is a lambda")
        raise NotModelledError(f"{callback.name} is not at the top of its module or class")
    return owner, value


def _make_others(function: PythonFunction, given: int) -> list[Any]:
    """Further arguments of a callback (`callback_args`): nothing is known of them."""
    arguments = function.node.args
    wanted = [*arguments.posonlyargs, *arguments.args]
    needed = wanted[given : len(wanted) - len(arguments.defaults)] if len(wanted) > given else []
    return [Opaque(one.arg) for one in needed]


def _make_node(machine: PythonMachine, cls: PythonClass, callback: str) -> PythonObject:
    """The object whose method the callback is: its constructor executed as far as that can be, and members that other
    methods set made symbolic."""
    node = machine.node = PythonObject(cls)
    maker = cls.find("__init__")
    if isinstance(maker, PythonFunction) and isinstance(maker.node, ast.FunctionDef):
        arguments = maker.node.args
        names = [one.arg for one in (*arguments.posonlyargs, *arguments.args)]
        defaults = arguments.defaults
        values: dict[str, Any] = {name: Opaque(name) for name in (*names, *[one.arg for one in arguments.kwonlyargs])}
        for name, default in zip(names[len(names) - len(defaults) :], defaults, strict=True):
            try:
                values[name] = machine.evaluate(default, maker.scope)
            except (NotModelledError, PythonThrownError):
                values[name] = Opaque(name)
        if names:
            values[names[0]] = node
        for extra, empty in ((arguments.vararg, ListValue([], is_frozen=True)), (arguments.kwarg, {})):
            if extra is not None:
                values[extra.arg] = empty
        scope = Scope(maker.scope.module, values, maker.scope)
        for statement in maker.node.body:
            machine.execute_leniently(statement, scope)
    habits = describe_class(cls)
    makers = list_called_by(cls, "__init__")
    for name, methods in sorted(habits.written.items()):
        if methods <= makers and name in node.members:
            continue
        if name not in node.members:
            continue
        node.members[name] = _make_state(machine, f"this.{name}", node.members[name])
    return node


def _free_globals(machine: PythonMachine, module: ModuleCode) -> None:
    """Makes the names of a module symbolic that its functions set: other callbacks may have been called before."""
    for name in sorted(list_set_globals(module.tree)):
        value = module.names.get(name, machine)
        if value is not machine and not isinstance(value, (PythonObject, PythonClass, PythonFunction)):
            module.names[name] = _make_state(machine, f"global.{name}", value)


def _make_state(machine: PythonMachine, path: str, value: Any) -> Any:
    """What a member may hold when a message comes: anything of its kind. What began as None may still be that."""
    if value is None:
        return Unsettled(path)
    if is_number(value) or isinstance(value, (str, SymbolicText)):
        return make_like(machine, path, value)
    if isinstance(value, Handle):
        return value
    if isinstance(value, ArrayValue):
        return ArrayValue(path, value.shape)
    if isinstance(value, dict):
        return ArrayValue(path)  # whatever it holds, elements can be set
    return Opaque(path)


@dataclass(slots=True)
class _Watched:
    """What is watched of one holder of names: the node, the module, an object that one of both keeps. start: what the
    names of its effects begin with. held: the dictionary itself; before: as it was; sizes: by _measure."""

    start: str
    held: dict[str, Any]
    names: set[str]
    before: dict[str, Any]
    sizes: dict[str, int]


class _Watch:
    """What the callback leaves changed, of what something else reads: members of its node, names of its module, members
    of the objects that these keep."""

    def __init__(self, machine: PythonMachine):
        self._machine = machine
        self._watched: list[_Watched] = []

    def start(self, node: PythonObject | None, function: PythonFunction) -> None:
        """Remembers everything as it is."""
        module = function.scope.module
        kept: list[tuple[str, Any]] = []
        if node is not None:
            habits = describe_class(node.cls)
            own = function.name
            names = {
                name
                for name in {*habits.written, *node.members}
                if habits.read.get(name, frozenset()) - {own, "__init__"}
            } | {name for name, by in habits.read.items() if own in by and name in habits.written}
            self._add("", node.members, names)
            kept += node.members.items()
        read = list_read_names(module.tree, function.node)
        set_here = list_set_globals(module.tree)
        self._add("", module.names, {
            name for name, value in module.names.items()
            if name in read and (name in set_here or isinstance(value, (ListValue, dict, Record, ArrayValue)))
        })  # fmt: skip
        kept += [(name, value) for name, value in module.names.items() if name in read]
        self._add_objects(kept, module, {id(node)})

    def _add(self, start: str, held: dict[str, Any], names: set[str]) -> None:
        sizes = {name: _measure(value) for name, value in held.items() if name in names}
        self._watched.append(_Watched(start, held, names, {name: held.get(name) for name in names}, sizes))

    def _add_objects(self, kept: list[tuple[str, Any]], module: ModuleCode, seen: set[int]) -> None:
        """Objects of classes of the workspace that are reached by members: their members that are read somewhere in the
        module of their class or of the callback."""
        while kept:
            path, value = kept.pop()
            if not isinstance(value, PythonObject) or id(value) in seen:
                continue
            seen.add(id(value))
            written = describe_class(value.cls).written
            read = list_read_attributes(module.tree) | list_read_attributes(value.cls.module.tree)
            self._add(f"{path}.", value.members, {name for name in {*written, *value.members} if name in read})
            kept.extend((f"{path}.{name}", one) for name, one in value.members.items())

    def finish(self) -> None:
        """Notes what has changed as an effect; what may be as it was is decided on."""
        for one in self._watched:
            for name in sorted(one.names):
                before, after = one.before.get(name), one.held.get(name)
                if isinstance(before, Unsettled) and (
                    after is None or (isinstance(after, Opaque) and after.name == before.path)
                ):
                    continue
                if after is before and _measure(after) == one.sizes.get(name, 0):
                    continue
                if self._differs(before, after):
                    self._machine.run.note_effect("member", f"{one.start}{name}")

    def _differs(self, before: Any, after: Any) -> bool:
        if is_number(before) and is_number(after):
            return not self._machine.is_true(self._machine.compare(ast.Eq, before, after))
        if isinstance(before, (str, SymbolicText)) and isinstance(after, (str, SymbolicText)):
            return not self._machine.is_true(self._machine.compare(ast.Eq, before, after))
        return True


def _measure(value: Any) -> int:
    """Something that changes when a list or message is changed in place."""
    if isinstance(value, ListValue):
        return hash((len(value.elements), tuple(map(id, value.elements))))
    if isinstance(value, ArrayValue):
        return value.changes
    if isinstance(value, dict):
        return hash(tuple((repr(key), id(one)) for key, one in value.items()))
    if isinstance(value, Record):
        return hash(tuple((name, id(one)) for name, one in sorted(value.fields.items()) if name != "~path"))
    return 0
