"""What Python, rospy, rclpy and a few others offer to callbacks, on symbolic values.

A function of a module that only computes gives a value that nothing is known of; one that may act on the world is
noted as not modelled, so that a way through it is never called ignored.
"""

from __future__ import annotations

import ast
import builtins
import math
from collections.abc import Callable, Sequence
from typing import Any

import z3

from . import arrays, images, operators, rotations, texts
from .messages import Messages
from .modules import Handle, KnownMethod, ModuleCode, Outside, PythonClass, PythonFunction, PythonObject, TimeValue
from .terms import (
    FLOAT64,
    ListValue,
    NotModelledError,
    Opaque,
    Real,
    RealSpan,
    Record,
    SymbolicText,
    Truth,
    Whole,
    convert_to_real,
    convert_to_whole,
    get_span,
    is_number,
    is_symbolic,
    is_whole,
    make_real,
    make_truth,
    make_whole,
)  # fmt: skip

Machine = Any
"""The executor, which imports this module."""

RECORD_METHODS = frozenset((
    "to_sec", "to_nsec", "to_time", "is_zero", "serialize", "deserialize", "serialize_numpy",
    "get_fields_and_field_types",
))  # fmt: skip
"""Methods of messages."""

_COMPUTES = frozenset((
    "numpy", "np", "math", "copy", "json", "re", "struct", "cv2", "collections", "datetime", "itertools", "functools",
    "scipy", "transforms3d", "tf_transformations", "random", "string", "enum", "yaml", "base64", "binascii", "array",
    "dataclasses", "typing", "operator", "cv_bridge", "sensor_msgs_py", "ros_numpy", "PIL", "quaternion", "decimal",
    "statistics", "bisect", "heapq", "uuid", "hashlib", "builtins", "traceback", "inspect", "PyKDL", "time", "abc",
    "tf2_geometry_msgs", "angles", "geometry_msgs", "std_msgs", "sensor_msgs", "nav_msgs", "rosidl_runtime_py",
    "rosidl_parser", "ament_index_python", "rospkg", "image_geometry", "laser_geometry", "six", "__future__", "sys",
))  # fmt: skip
"""Modules whose functions compute and change nothing outside."""
_LOGS = frozenset((
    "rospy.loginfo", "rospy.logwarn", "rospy.logerr", "rospy.logdebug", "rospy.logfatal", "builtins.print",
    "rospy.loginfo_throttle", "rospy.logwarn_throttle", "rospy.logerr_throttle", "rospy.logdebug_throttle",
    "rospy.loginfo_once", "rospy.logwarn_once", "rospy.logerr_once", "rospy.logdebug_once", "rospy.logfatal_once",
    "rospy.loginfo_throttle_identical", "rospy.logwarn_throttle_identical", "rospy.logerr_throttle_identical",
    "warnings.warn", "traceback.print_exc", "pprint.pprint", "logging.info", "logging.warning", "logging.error",
    "logging.debug", "logging.exception", "logging.critical",
))  # fmt: skip
_LOGGER_METHODS = frozenset((
    "debug", "info", "warn", "warning", "error", "fatal", "critical", "exception", "log",
))  # fmt: skip
_HANDLES = {
    "rospy.Publisher": "publisher", "rospy.Subscriber": "subscription", "rospy.ServiceProxy": "client",
    "rospy.Service": "server", "rospy.Timer": "timer", "rospy.Rate": "rate", "actionlib.SimpleActionClient": "action",
    "actionlib.ActionClient": "action", "rclpy.action.ActionClient": "action", "rclpy.action.ActionServer": "server",
    "actionlib.SimpleActionServer": "goal", "actionlib.ActionServer": "server",
    "tf.TransformBroadcaster": "broadcaster",
    "tf2_ros.TransformBroadcaster": "broadcaster", "tf2_ros.StaticTransformBroadcaster": "broadcaster",
    "tf2_ros.transform_broadcaster.TransformBroadcaster": "broadcaster", "threading.Lock": "lock",
    "threading.RLock": "lock", "tf.TransformListener": "listener", "tf2_ros.TransformListener": "listener",
    "tf2_ros.Buffer": "listener", "logging.getLogger": "logger", "tf2_ros.buffer.Buffer": "listener",
    "tf2_ros.transform_listener.TransformListener": "listener", "threading.Event": "event",
    **dict.fromkeys(images.BRIDGES, "bridge"),
}  # fmt: skip
_NODE_METHODS = {
    "create_publisher": "publisher", "create_subscription": "subscription", "create_client": "client",
    "create_service": "server", "create_timer": "timer", "create_rate": "rate", "get_logger": "logger",
    "get_clock": "clock", "create_guard_condition": "timer", "add_on_set_parameters_callback": "subscription",
}  # fmt: skip
# Methods of node objects and of ROS that only ask or wait.
_QUIET = frozenset((
    "rospy.init_node", "rospy.spin", "rospy.sleep", "time.sleep", "rospy.is_shutdown", "rospy.wait_for_service",
    "rospy.get_name", "rospy.on_shutdown", "rclpy.init", "rclpy.spin", "rclpy.spin_once", "rclpy.ok",
    "rospy.rostime.wallsleep",
    "message_filters.Subscriber", "message_filters.ApproximateTimeSynchronizer", "message_filters.TimeSynchronizer",
    "rclpy.qos.QoSProfile", "rospy.get_namespace", "rospy.get_caller_id",
    "rospy.get_published_topics",
))  # fmt: skip
_PLAIN_NODES = frozenset(("rclpy.node.Node", "rclpy.create_node"))
_ASKS_WHETHER_UP = frozenset(("rospy.is_shutdown", "rclpy.ok"))
_SLEEPS = frozenset(("rospy.sleep", "time.sleep", "rospy.rostime.wallsleep"))
_NODE_QUIET = frozenset((
    "get_name", "get_namespace", "declare_parameters", "count_subscribers", "count_publishers", "wait_for_service",
    "get_fully_qualified_name", "get_topic_names_and_types", "get_node_names", "has_parameter", "resolve_topic_name",
))  # fmt: skip


def find_constant(owner: Outside, name: str, messages: Messages) -> Any:
    """A member of something outside: constants of the math module and of messages are known."""
    if owner.name == "math" and name in ("pi", "e", "inf", "nan", "tau"):
        return getattr(math, name)
    type_ = find_message_type(owner.name)
    if type_:
        constants = messages.find_constants(type_)
        if name in constants:
            return constants[name]
    if owner.name == "sys" and name in ("maxsize", "version_info"):
        return 2**63 - 1 if name == "maxsize" else Opaque("sys.version_info")
    if owner.name == "rospy.Time" and name in ("now", "from_sec"):
        return Outside(f"rospy.Time.{name}")
    return owner.get(name)


def find_message_type(name: str) -> str:
    """`package/Name` of a class of messages by its dotted name, empty for others."""
    parts = name.split(".")
    if len(parts) >= 3 and parts[1] in ("msg", "srv", "action"):
        if parts[1] == "msg":
            return f"{parts[0]}/{parts[-1]}" if len(parts) <= 4 and parts[-1][:1].isupper() else ""
        # `SetBoolResponse` of ROS 1, `SetBool.Response` of ROS 2.
        whole = "".join(parts[2:])
        is_part = parts[1] == "srv" and len(parts) <= 4 and whole.endswith(("Request", "Response"))
        # `Count.Goal` of ROS 2; in ROS 1 these are messages.
        is_part |= parts[1] == "action" and len(parts) == 4 and whole.endswith(("Goal", "Result", "Feedback"))
        return f"{parts[0]}/{whole}" if is_part else ""
    return {
        "rospy.Header": "std_msgs/Header", "rospy.AnyMsg": "",
    }.get(name, "")  # fmt: skip


# What a program calls.


def _is_exception(name: str) -> bool:
    found = getattr(builtins, name, None)
    return isinstance(found, type) and issubclass(found, BaseException)


def call_outside(machine: Machine, name: str, given: list[Any], named: dict[str, Any]) -> Any:
    """Calls something of a module that is not in the workspace."""
    run = machine.run
    built_in = _BUILT_INS.get(name.removeprefix("builtins.")) if name.startswith("builtins.") else None
    if built_in is not None:
        return built_in(machine, given, named)
    if name.startswith("builtins.") and _is_exception(name.removeprefix("builtins.")):
        text = given[0] if given and isinstance(given[0], str) else ""
        return run.throw(name.removeprefix("builtins."), text)
    if name.startswith(("math.", "numpy.", "np.")):
        word = name.partition(".")[2]
        function = _MATH.get(word) if name.startswith("math.") or word in _SAME_IN_NUMPY else None
        if function is not None and all(is_number(one) for one in given) and given:
            return function(machine, given)
        if not name.startswith("math.") and (array := arrays.make_array(word, given, named)) is not None:
            return array
    if name in _LOGS:
        if not machine.is_quiet:
            run.logs.append(name.rpartition(".")[2])
        return None
    if run.program is not None and name in _ASKS_WHETHER_UP:
        return run.program.is_up() != (name == "rospy.is_shutdown")
    if run.program is not None and name in _SLEEPS:
        run.program.sleep()
    type_ = find_message_type(name)
    if type_:
        return _make_message(machine, type_, given, named)
    if name in _PLAIN_NODES:
        return _make_plain_node()
    if name in _HANDLES:
        content = given[1] if _HANDLES[name] == "publisher" and len(given) > 1 else named.get("data_class")
        about = find_message_type(content.name) if isinstance(content, Outside) else ""
        return Handle(_HANDLES[name], "", about)
    if name in ("rospy.get_param", "rospy.param.get_param"):
        return _make_parameter(machine, given, named)
    if name == "rospy.has_param":
        return Opaque("rospy.has_param()")
    if name in ("rospy.set_param", "rospy.delete_param"):
        if not machine.is_quiet:
            run.note_effect("parameter", str(given[0]) if given and isinstance(given[0], str) else "")
        return None
    if name in ("rospy.Time.now", "rospy.get_rostime"):
        return _ask_time(machine)
    if name in ("rospy.get_time", "time.time", "time.monotonic", "time.perf_counter"):
        return _divide_moment(_ask_time(machine))
    if name in ("rospy.Time", "rospy.Duration", "rclpy.time.Time", "rclpy.duration.Duration", "rospy.Duration.from_sec",
                "rospy.Time.from_sec", "genpy.Time", "genpy.Duration"):  # fmt: skip
        return _make_moment(machine, name, given, named)
    if name in ("rospy.signal_shutdown", "rclpy.shutdown", "sys.exit", "os._exit", "builtins.exit", "builtins.quit"):
        if not machine.is_quiet:
            run.note_effect("shutdown", name)
        if name not in ("rospy.signal_shutdown", "rclpy.shutdown"):
            raise run.throw("SystemExit")
        return None
    if name in ("copy.copy", "copy.deepcopy") and given:
        return copy_value(given[0])
    if name == "rospy.ServiceProxy":
        return Handle("client")
    if name in _QUIET:
        return Opaque(name)
    if (turned := rotations.call_rotation(run, name, given)) is not None:
        return turned
    if name in _MESSAGE_MOMENTS and given:
        return _read_moment(machine, name, given[0])
    if name.partition(".")[0] in _COMPUTES or name.startswith("tf.transformations."):
        return _compute_outside(machine, name, given)
    own = getattr(builtins, name.removeprefix("builtins."), None)
    if isinstance(own, type) and issubclass(own, BaseException):
        from .run import PythonThrownError

        return PythonThrownError(own.__name__, "", run.place)
    run.not_modelled[f"{name}()"] = None
    return Opaque(f"{name}()")


def _make_plain_node() -> PythonObject:
    """A node that is no object of an own class."""
    plain = ast.ClassDef(name="Node", bases=[], keywords=[], body=[], decorator_list=[])
    module = ModuleCode("rclpy.node", "", ast.Module(body=[], type_ignores=[]), is_loaded=True)
    return PythonObject(PythonClass(plain, module, (Outside("rclpy.node.Node"),), {}))


def _compute_outside(machine: Machine, name: str, given: Sequence[Any]) -> Any:
    """A function that only computes: any value. It may raise what nobody sees here, which is said."""
    if not machine.is_quiet:
        machine.run.assumed[f"{name}() gives any value"] = None
    return Opaque(f"{name}()")


def _make_message(machine: Machine, type_: str, given: Sequence[Any], named: dict[str, Any]) -> Record:
    record = machine.messages.make_empty(type_)
    names = machine.messages.list_fields(type_)
    if record.is_known:
        for name in named:
            if name not in names:
                raise machine.run.throw("AttributeError", name)
    record.fields.update(zip(names, given, strict=False))
    record.fields.update(named)
    return record


def _make_parameter(machine: Machine, given: Sequence[Any], named: dict[str, Any]) -> Any:
    name = given[0] if given and isinstance(given[0], str) else ""
    default = given[1] if len(given) > 1 else named.get("default")
    path = f"~param.{name.lstrip('~/')}" if name else machine.run.make_name("~param")
    value = make_like(machine, path, default)
    machine.run.note_default(path, default)
    return value


def make_like(machine: Machine, path: str, value: Any) -> Any:
    """An input of the kind of a value: what a parameter or a member of the node may be."""
    run = machine.run
    if isinstance(value, (bool, Truth)):
        return run.get_truth(path)
    if isinstance(value, (int, Whole)):
        return run.get_whole(path, 64, True)
    if isinstance(value, (float, Real)):
        return run.get_real(path, 64)
    if isinstance(value, (str, SymbolicText)):
        return run.get_text(path)
    return Opaque(path)


def _ask_time(machine: Machine) -> TimeValue:
    term = machine.run.get_whole(machine.run.make_name("~now"), 64, True)
    machine.run.assume(z3.And(term.term >= 0, term.term < 2**62))
    return TimeValue(Whole(term.term, 0, 2**62 - 1))


def _divide_moment(value: TimeValue) -> Any:
    real = make_real(convert_to_real(value.nanoseconds), get_span(value.nanoseconds))
    return divide_by(real, 1e9)


def divide_by(value: Any, by: float) -> Any:
    """A float divided by a number that is not 0."""
    return (
        value / by
        if isinstance(value, float)
        else make_real(z3.fpDiv(z3.RNE(), convert_to_real(value), z3.FPVal(by, FLOAT64)))
    )


def _make_moment(machine: Machine, name: str, given: Sequence[Any], named: dict[str, Any]) -> Any:
    is_span = "uration" in name
    if named.get("seconds") is not None or named.get("nanoseconds") is not None:
        given = [named.get("seconds", 0), named.get("nanoseconds", 0)]
    if not given:
        return TimeValue(0, is_span)
    if any(is_symbolic(one) or not isinstance(one, (int, float)) for one in given):
        return Opaque(name)
    seconds, more = given[0], given[1] if len(given) > 1 else 0
    return TimeValue(round(seconds * 1e9) + int(more), is_span)


_MESSAGE_MOMENTS = frozenset(("rclpy.time.Time.from_msg", "rclpy.duration.Duration.from_msg"))


def _read_moment(machine: Machine, name: str, message: Any) -> TimeValue:
    """The moment that a message holds. Source: rclpy/time.py, which refuses moments before the first one."""
    moment = read_time(machine, message)
    is_span = "uration" in name
    if not is_span and isinstance(message, Record):
        seconds = machine.get_member(message, machine.messages.list_fields(message.type)[0])
        if machine.run.decide(operators.compare(ast.Lt, seconds, 0)):
            raise machine.run.throw("ValueError", "Seconds value must not be negative")
    return TimeValue(moment.nanoseconds, is_span)


def read_time(machine: Machine, value: Any) -> TimeValue:
    """The moment of a message's time, of a moment itself. Raises NotModelledError for others."""
    if isinstance(value, TimeValue):
        return value
    if isinstance(value, Record):
        names = machine.messages.list_fields(value.type)
        if len(names) == 2:
            seconds, rest = (machine.get_member(value, name) for name in names)
            if is_whole(seconds) and is_whole(rest):
                total = machine.calculate(ast.Add, machine.calculate(ast.Mult, seconds, 10**9), rest)
                return TimeValue(total, value.type.endswith("Duration"))
    raise NotModelledError("a time")


def calculate_moment(machine: Machine, kind: type[ast.operator], left: Any, right: Any) -> Any:
    """`left kind right` of times and durations."""
    if kind in (ast.Add, ast.Sub):
        a, b = read_time(machine, left), read_time(machine, right)
        return TimeValue(
            machine.calculate(kind, a.nanoseconds, b.nanoseconds), a.is_span or (kind is ast.Sub and not b.is_span)
        )
    return Opaque("a time")


def compare_moments(machine: Machine, kind: type[ast.cmpop], left: Any, right: Any) -> Any:
    """`left kind right` of times and durations."""
    if left is None or right is None:
        return kind is ast.NotEq
    a, b = read_time(machine, left), read_time(machine, right)
    return operators.compare(kind, a.nanoseconds, b.nanoseconds)


# Members and methods.


def find_member(machine: Machine, owner: Any, name: str) -> Any:
    """A member of a value that the executor itself knows."""
    if isinstance(owner, TimeValue):
        if name == "nanoseconds":
            return owner.nanoseconds
        if name in ("secs", "sec"):
            return machine.calculate(ast.FloorDiv, owner.nanoseconds, 10**9)
        if name in ("nsecs", "nanosec"):
            return machine.calculate(ast.Mod, owner.nanoseconds, 10**9)
    if isinstance(owner, Handle):
        if owner.kind == "super" and isinstance(owner.content, PythonObject):
            for base in owner.content.cls.list_order()[1:]:
                found = base.members.get(name)
                if isinstance(found, PythonFunction):
                    from .modules import BoundMethod

                    return BoundMethod(found, owner.content)
            return KnownMethod(owner.content, name) if name != "__init__" else Outside("rclpy.init")
        if owner.kind == "parameter" and name == "value":
            return owner.content
        if owner.kind in ("goal", "action message"):
            return _find_action_member(machine, owner, name)
    if isinstance(owner, (int, float)) and not isinstance(owner, bool) and name in ("real", "imag"):
        return owner if name == "real" else 0
    if isinstance(owner, (str, SymbolicText)) and not hasattr(str, name):
        raise machine.run.throw("AttributeError", name)
    if isinstance(owner, (int, float, Whole, Real)) and not hasattr(float, name) and not hasattr(int, name):
        raise machine.run.throw("AttributeError", name)
    return KnownMethod(owner, name)


def _convert_to_bytes(machine: Machine, value: int | Whole, given: list[Any], named: dict[str, Any]) -> Any:
    """`value.to_bytes(length, order, signed=...)`. Raises what Python raises for a number that does not fit."""
    length = given[0] if given else named.get("length", 1)
    is_signed = named.get("signed", False)
    if type(length) is not int or type(is_signed) is not bool or not 0 < length <= 8:
        raise NotModelledError("to_bytes() of a length that is not known")
    bits = 8 * length
    low, high = (-(1 << (bits - 1)), (1 << (bits - 1)) - 1) if is_signed else (0, (1 << bits) - 1)
    for kind, limit in ((ast.Lt, low), (ast.Gt, high)):
        if machine.is_true(operators.compare(kind, value, limit)):
            below_zero = kind is ast.Lt and not is_signed
            raise machine.run.throw(
                "OverflowError", "can't convert negative int to unsigned" if below_zero else "int too big to convert"
            )
    return Opaque("bytes of a number")


def call_method(machine: Machine, owner: Any, name: str, given: list[Any], named: dict[str, Any]) -> Any:
    """Calls a method of a value that the executor itself knows."""
    if isinstance(owner, (str, SymbolicText)):
        return _call_text(machine, owner, name, given, named)
    if isinstance(owner, ListValue):
        return _call_items(machine, owner, name, given)
    if isinstance(owner, dict):
        return _call_dictionary(machine, owner, name, given)
    if isinstance(owner, Handle):
        return _call_handle_method(machine, owner, name, given, named)
    if isinstance(owner, PythonObject):
        return _call_base(machine, owner, name, given, named)
    if isinstance(owner, (int, Whole)) and name == "to_bytes":
        return _convert_to_bytes(machine, owner, given, named)
    if isinstance(owner, TimeValue) or (
        isinstance(owner, Record) and name in ("to_sec", "to_nsec", "to_time", "is_zero")
    ):
        moment = read_time(machine, owner)
        if name == "to_sec" or name == "to_time":
            return _divide_moment(moment) if is_symbolic(moment.nanoseconds) else moment.nanoseconds / 1e9
        if name == "to_nsec":
            return moment.nanoseconds
        if name == "is_zero":
            return operators.compare(ast.Eq, moment.nanoseconds, 0)
        if name == "to_msg":
            return Opaque("a time")
        if name == "seconds_nanoseconds":
            return ListValue(
                [find_member(machine, moment, "secs"), find_member(machine, moment, "nsecs")], is_frozen=True
            )
    if isinstance(owner, Record):
        return Opaque(f"{owner.type}.{name}()")
    if isinstance(owner, (float, Real)) and name == "is_integer":
        term = convert_to_real(owner)
        return make_truth(z3.fpEQ(z3.fpRoundToIntegral(z3.RTZ(), term), term))
    raise NotModelledError(f"the method {name}")


def _call_text(machine: Machine, owner: Any, name: str, given: list[Any], named: dict[str, Any]) -> Any:
    if name == "format":
        return Opaque("formatted text")
    if any(isinstance(one, Opaque) for one in given):
        return Opaque(f"str.{name}()")
    if name == "join":
        return _join(machine, owner, machine.iterate(given[0]))
    if isinstance(owner, str) and not any(is_symbolic(one) for one in (*given, *named.values())):
        plain = [tuple(one.elements) if isinstance(one, ListValue) else one for one in given]
        try:
            found = getattr(owner, name)(*plain, **named)
        except (
            TypeError,
            ValueError,
            IndexError,
            KeyError,
            LookupError,
            UnicodeError,
            OverflowError,
            MemoryError,
        ) as error:
            raise machine.run.throw(type(error).__name__, str(error)) from error
        return ListValue(list(found)) if isinstance(found, list) else found
    return texts.call_method(machine.run, owner, name, given)


def join_text(machine: Machine, parts: list[Any]) -> Any:
    """An f-string of parts."""
    if all(isinstance(one, (str, SymbolicText)) for one in parts):
        return _join(machine, "", parts)
    if not any(is_symbolic(one) or isinstance(one, (Record, ListValue, dict, PythonObject)) for one in parts):
        return "".join(map(str, parts))
    return Opaque("formatted text")


def _join(machine: Machine, between: Any, parts: list[Any]) -> Any:
    found: list[Any] = []
    for index, one in enumerate(parts):
        if isinstance(one, Opaque):
            return Opaque("joined text")
        if not isinstance(one, (str, SymbolicText)):
            raise machine.run.throw("TypeError", "sequence item: expected str")
        if index:
            found.extend(texts.list_characters(machine.run, between))
        found.extend(texts.list_characters(machine.run, one))
    return texts.make_text(tuple(found))


def _call_items(machine: Machine, owner: ListValue, name: str, given: list[Any]) -> Any:
    run = machine.run
    elements = run.fix_items(owner)
    if name in ("append", "add"):
        elements.append(given[0])
        return None
    if name == "extend":
        elements.extend(machine.iterate(given[0]))
        return None
    if name == "insert" and isinstance(given[0], int):
        elements.insert(given[0], given[1])
        return None
    if name == "clear":
        elements.clear()
        return None
    if name in ("pop", "popleft"):
        index = 0 if name == "popleft" else given[0] if given else -1
        if not isinstance(index, int):
            raise NotModelledError("which element is taken out")
        if not -len(elements) <= index < len(elements):
            raise run.throw("IndexError", "pop from empty list")
        return elements.pop(index)
    if name == "copy":
        return ListValue(list(elements))
    if name == "tolist":
        return ListValue(list(elements))
    if name == "reverse":
        elements.reverse()
        return None
    if name in ("index", "count", "remove", "discard"):
        places = [at for at, one in enumerate(elements) if machine.is_true(machine.compare(ast.Eq, one, given[0]))]
        if name == "count":
            return len(places)
        if not places:
            if name == "discard":
                return None
            raise run.throw("ValueError", "not in list")
        if name == "index":
            return places[0]
        del elements[places[0]]
        return None
    if name in ("sort", "union", "intersection", "difference", "issubset"):
        raise NotModelledError(f"list.{name}()")
    raise run.throw("AttributeError", name)


def _call_dictionary(machine: Machine, owner: dict[Any, Any], name: str, given: list[Any]) -> Any:
    from .run import PythonThrownError

    if name in ("get", "pop", "setdefault"):
        try:
            found = machine.get_item(owner, given[0])
        except PythonThrownError as error:
            if error.name != "KeyError" or (name == "pop" and len(given) < 2):
                raise
            found = given[1] if len(given) > 1 else None
            if name == "setdefault":
                owner[given[0]] = found
            return found
        if name == "pop":
            owner.pop(given[0], None)
        return found
    if name in ("keys", "values", "items"):
        if name == "items":
            return ListValue([ListValue([key, value], is_frozen=True) for key, value in owner.items()])
        return ListValue(list(owner) if name == "keys" else list(owner.values()))
    if name == "update" and given and isinstance(given[0], dict):
        owner.update(given[0])
        return None
    if name == "clear":
        owner.clear()
        return None
    if name == "copy":
        return dict(owner)
    raise NotModelledError(f"dict.{name}()")


def call_handle(machine: Machine, handle: Handle, given: list[Any]) -> Any:
    """Calls a handle itself: a service proxy."""
    if handle.kind == "client":
        if not machine.is_quiet:
            machine.run.note_effect("service", handle.name)
        return Opaque(f"{handle.name}()")
    raise NotModelledError(f"a call of a {handle.kind}")


def _call_handle_method(machine: Machine, handle: Handle, name: str, given: list[Any], named: dict[str, Any]) -> Any:
    run, kind = machine.run, handle.kind
    loud = not machine.is_quiet
    if kind == "publisher":
        if name == "publish":
            machine.note_publish(handle, given, named)
            return None
        return Opaque(f"{handle.name}.{name}()")
    if kind == "logger":
        if name in _LOGGER_METHODS and loud:
            run.logs.append(name)
        return handle if name == "get_child" else None
    if kind in ("client", "action"):
        if name in ("call", "call_async", "__call__") or name.startswith(("send_goal", "cancel")):
            if loud:
                run.note_effect("service" if kind == "client" else "action", handle.name)
            return Opaque(f"{handle.name}.{name}()")
        return Opaque(f"{handle.name}.{name}()")
    if kind == "goal":
        return _call_goal(machine, handle, name)
    if kind == "future":
        return handle.content if name == "result" and handle.content is not None else Opaque(f"{handle.name}.{name}()")
    if kind == "bridge":
        if name == "imgmsg_to_cv2" and isinstance(picture := (given or [named.get("img_msg")])[0], Record):
            images.require_encoding(run, machine.get_member(picture, "encoding"))
        return _compute_outside(machine, f"cv_bridge.CvBridge.{name}", given)
    if kind == "broadcaster":
        if loud:
            run.note_effect("transform", handle.name)
        return None
    if kind == "clock":
        return _ask_time(machine) if name == "now" else Opaque(f"clock.{name}()")
    if kind == "lock":
        return True
    if kind == "event":
        if name in ("set", "clear") and loud:
            run.note_effect("member", handle.name)
        return Opaque(f"{handle.name}.{name}()")
    if kind == "parameter":
        if name == "get_parameter_value":
            return Handle("parameter", handle.name, handle.content)
        return Opaque(f"{handle.name}.{name}()")
    if kind == "listener":
        if name in ("lookup_transform", "lookupTransform", "transform", "transformPose", "transformPoint"):
            if run.choose(f"{name}() finds the transform"):
                return Opaque(f"{handle.name}.{name}()")
            exception = run.throw("TransformException", "no transform")
            exception.bases = ("LookupException", "ExtrapolationException", "ConnectivityException", "Exception")
            raise exception
        return Opaque(f"{handle.name}.{name}()")
    if kind == "rate" and name == "sleep" and run.program is not None:
        run.program.sleep()
    if kind in ("timer", "subscription", "rate", "server"):
        if name in ("shutdown", "cancel", "reset", "unregister", "destroy") and loud:
            run.note_effect("member", handle.name)
        return Opaque(f"{handle.name}.{name}()")
    return Opaque(f"{handle.name}.{name}()")


def _find_action_member(machine: Machine, handle: Handle, name: str) -> Any:
    """A member of a goal of an action, or of what comes of one."""
    if isinstance(handle.content, dict) and name in handle.content:
        return handle.content[name]
    if handle.kind == "goal" and name in ("is_cancel_requested", "accepted"):
        return machine.run.get_truth(f"~{name}")
    if name in ("goal_id", "stamp", "status") or handle.kind == "action message":
        return Opaque(f"{handle.name}.{name}")
    return KnownMethod(handle, name)


_ANSWERS = frozenset((
    "succeed", "abort", "canceled", "publish_feedback", "execute", "set_succeeded", "set_aborted", "set_preempted",
    "set_accepted", "set_rejected", "set_canceled", "accept_new_goal", "cancel_goal", "cancel_goal_async",
))  # fmt: skip
"""Methods of goals, and of servers of one goal, which others hear of."""


def _call_goal(machine: Machine, handle: Handle, name: str) -> Any:
    """A method of a goal of an action, or of a server that has one at a time."""
    if name in _ANSWERS and not machine.is_quiet:
        machine.run.note_effect("action", handle.name)
    if name in ("is_preempt_requested", "is_new_goal_available", "is_active"):
        return machine.run.get_truth(f"~{name}")
    if name == "get_result_async" and not machine.is_quiet:
        machine.run.note_effect("action", handle.name)
        return Handle("future", "result_future")
    return Opaque(f"{handle.name}.{name}()")


def _call_base(machine: Machine, owner: PythonObject, name: str, given: list[Any], named: dict[str, Any]) -> Any:
    """A method of a node's class that is not in the workspace: of rclpy's Node."""
    run = machine.run
    if name in _NODE_METHODS:
        about = find_message_type(given[0].name) if given and isinstance(given[0], Outside) else ""
        return Handle(_NODE_METHODS[name], "logger" if name == "get_logger" else "", about)
    if name == "declare_parameter":
        key = given[0] if given and isinstance(given[0], str) else ""
        default = given[1] if len(given) > 1 else named.get("value")
        value = make_like(machine, f"~param.{key}", default) if key else Opaque("~param")
        machine.run.note_default(f"~param.{key}", default)
        owner.members.setdefault("~parameters", {})[key] = value
        return Handle("parameter", key, value)
    if name in ("get_parameter", "get_parameter_or"):
        key = given[0] if given and isinstance(given[0], str) else ""
        known = owner.members.get("~parameters", {}).get(key)
        return Handle("parameter", key, known if known is not None else Opaque(f"~param.{key}"))
    if name == "set_parameters":
        if not machine.is_quiet:
            run.note_effect("parameter", "")
        return Opaque("set_parameters()")
    if name in ("destroy_node", "destroy_timer", "destroy_subscription"):
        if not machine.is_quiet:
            run.note_effect("shutdown", name)
        return None
    if name == "__init__" or name in _NODE_QUIET or name.startswith("__"):
        return Opaque(name)
    run.not_modelled[f"self.{name}()"] = None
    return Opaque(f"self.{name}()")


def copy_value(value: Any) -> Any:
    """A copy of a message or a list, all the way down."""
    if isinstance(value, Record):
        return Record(value.type, {name: copy_value(one) for name, one in value.fields.items()}, value.is_known)
    if isinstance(value, ListValue):
        return ListValue([copy_value(one) for one in value.elements], value.size, value.is_frozen)
    if isinstance(value, dict):
        return {key: copy_value(one) for key, one in value.items()}
    return value


# Built-in functions.


def _call_len(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    value = given[0]
    if isinstance(value, SymbolicText):
        return texts.get_length(value)
    if isinstance(value, ListValue):
        return value.size if value.size is not None else len(value.elements)
    if isinstance(value, (str, dict, bytes, range)):
        return len(value)
    if isinstance(value, Opaque):
        return Opaque(f"len({value.name})")
    if value is None or is_number(value):
        raise machine.run.throw("TypeError", "object has no len()")
    raise NotModelledError("len()")


def _call_int(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    if not given:
        return 0
    value = given[0]
    if isinstance(value, (str, SymbolicText)):
        if isinstance(value, str):
            try:
                return int(value, *[one for one in given[1:] if isinstance(one, int)])
            except ValueError as error:
                raise machine.run.throw("ValueError", "invalid literal for int()") from error
        if len(given) > 1:
            raise NotModelledError("int() with a base")
        return texts.parse_whole(machine.run, value)
    if isinstance(value, Real):
        return operators.convert_to_integer(machine.run, value)
    if isinstance(value, float):
        try:
            return int(value)
        except (ValueError, OverflowError) as error:
            raise machine.run.throw(type(error).__name__, str(error)) from error
    return _pass(machine, value, convert_to_whole)


def _call_float(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    if not given:
        return 0.0
    value = given[0]
    if isinstance(value, SymbolicText):
        return texts.parse_real(machine.run, value)
    if isinstance(value, str):
        try:
            return float(value)
        except ValueError as error:
            raise machine.run.throw("ValueError", "could not convert string to float") from error
    if is_number(value):
        return value if isinstance(value, (float, Real)) else make_real(convert_to_real(value), get_span(value))
    return _pass(machine, value, lambda one: one)


def _pass(machine: Machine, value: Any, change: Callable[[Any], Any]) -> Any:
    if isinstance(value, Opaque):
        return Opaque(value.name)
    if value is None or isinstance(value, (ListValue, dict)):
        raise machine.run.throw("TypeError", "argument must be a string or a number")
    if is_number(value):
        return change(value)
    raise NotModelledError("a conversion")


def _call_bool(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    return machine.is_true(given[0]) if given else False


def _call_str(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    value = given[0] if given else ""
    if isinstance(value, (str, SymbolicText)):
        return value
    if isinstance(value, (int, float, type(None))):
        return str(value)
    return Opaque("text of a value")


def _call_range(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    numbers: list[int] = []
    for one in given:
        whole = convert_to_whole(one)
        if isinstance(whole, Whole):
            if len(given) > 2 or whole.low < -1 or whole.high > 64:
                whole = _fix_small(machine, whole)
            else:
                whole = machine.run.fix_size(whole) if whole.low >= 0 else _fix_small(machine, whole)
        if not isinstance(whole, int):
            if isinstance(whole, Opaque):
                raise NotModelledError("a range that is not known")
            raise machine.run.throw("TypeError", "range() of no integer")
        numbers.append(whole)
    try:
        return range(*numbers)
    except (TypeError, ValueError) as error:
        raise machine.run.throw(type(error).__name__, str(error)) from error


def _fix_small(machine: Machine, whole: Whole) -> int:
    """A number that ends up in a range: 0 for what is below, and one number each up to the bound of loops."""
    if machine.run.decide(operators.compare(ast.LtE, whole, 0)):
        return 0
    for count in range(1, machine.run.bounds.loops + 1):
        if machine.run.decide(operators.compare(ast.Eq, whole, count)):
            return count
    raise NotModelledError(f"a loop of more than {machine.run.bounds.loops} rounds")


def _call_abs(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    value = given[0]
    if isinstance(value, Opaque):
        return value
    if not is_number(value):
        raise machine.run.throw("TypeError", "bad operand type for abs()")
    return operators.find_magnitude(value) if is_symbolic(value) else abs(value)


def _choose_extreme(is_least: bool) -> Callable[[Machine, list[Any], dict[str, Any]], Any]:
    def choose(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
        if "key" in named:
            raise NotModelledError("min() or max() with a key")
        if len(given) == 1 and isinstance(given[0], Opaque):
            return given[0]
        values = machine.iterate(given[0]) if len(given) == 1 else given
        if not values:
            if "default" in named:
                return named["default"]
            raise machine.run.throw("ValueError", "empty sequence")
        best = values[0]
        for one in values[1:]:
            if isinstance(one, Opaque) or isinstance(best, Opaque):
                return Opaque("min() or max()")
            is_better = machine.compare(ast.Lt if is_least else ast.Gt, one, best)
            if isinstance(is_better, Truth) and is_number(one) and is_number(best):
                best = _merge(is_better, one, best)
            elif machine.is_true(is_better):
                best = one
        return best

    return choose


def _merge(condition: Truth, one: Any, other: Any) -> Any:
    """One of two numbers, as a condition says; a float where one of them is."""
    one, other = convert_to_whole(one), convert_to_whole(other)
    if is_whole(one) and is_whole(other):
        from .terms import count_bits, extend, get_range

        (a, b), (c, d) = get_range(one), get_range(other)
        bits = count_bits(min(a, c), max(b, d))
        return make_whole(z3.If(condition.term, extend(one, bits), extend(other, bits)), min(a, c), max(b, d))
    a, b = get_span(one), get_span(other)
    span = RealSpan(min(a.low, b.low), max(a.high, b.high), a.is_number and b.is_number)
    narrow = operators.narrow(one, other)
    if narrow is None:
        return make_real(z3.If(condition.term, convert_to_real(one), convert_to_real(other)), span)
    single = z3.If(condition.term, *narrow)
    return Real(z3.fpFPToFP(z3.RNE(), single, FLOAT64), span, single)


def _call_sum(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    total: Any = given[1] if len(given) > 1 else 0
    for one in machine.iterate(given[0]):
        total = machine.calculate(ast.Add, total, one)
    return total


def _call_round(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    value = given[0]
    if isinstance(value, Real):
        if len(given) > 1:
            return Opaque("round()")
        return operators.convert_to_integer(machine.run, value, z3.RNE())
    if isinstance(value, float):
        try:
            return round(value, *[one for one in given[1:] if isinstance(one, int)])
        except (ValueError, OverflowError) as error:
            raise machine.run.throw(type(error).__name__, str(error)) from error
    return _pass(machine, value, convert_to_whole)


def _call_isinstance(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    value, kinds = given[0], given[1].elements if isinstance(given[1], ListValue) else [given[1]]
    if isinstance(value, Opaque):
        return Opaque(value.name)
    for kind in kinds:
        if isinstance(kind, PythonClass):
            if isinstance(value, PythonObject) and kind in value.cls.list_order():
                return True
        elif isinstance(kind, Outside):
            name = kind.name.removeprefix("builtins.")
            known = {
                "int": is_whole(value), "float": isinstance(value, (float, Real)),
                "bool": isinstance(value, (bool, Truth)), "str": isinstance(value, (str, SymbolicText)),
                "list": isinstance(value, ListValue) and not value.is_frozen,
                "tuple": isinstance(value, ListValue) and value.is_frozen, "dict": isinstance(value, dict),
            }  # fmt: skip
            if name in known:
                if known[name]:
                    return True
            elif isinstance(value, Record):
                if find_message_type(kind.name) == value.type:
                    return True
            else:
                return Opaque("isinstance()")
    return False


def _call_any(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    return any(machine.is_true(one) for one in machine.iterate(given[0]))


def _call_all(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    return all(machine.is_true(one) for one in machine.iterate(given[0]))


def _call_list(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    if given and isinstance(given[0], Opaque):
        return given[0]
    return ListValue(machine.iterate(given[0]) if given else [])


def _call_tuple(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    found = _call_list(machine, given, named)
    return ListValue(found.elements, is_frozen=True) if isinstance(found, ListValue) else found


def _call_dict(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    if not given:
        return dict(named)
    if isinstance(given[0], dict):
        return {**given[0], **named}
    pairs = [machine.iterate(one) for one in machine.iterate(given[0])]
    if any(len(pair) != 2 or not isinstance(pair[0], (int, str, float, bool)) for pair in pairs):
        raise NotModelledError("dict()")
    return {**dict(pairs), **named}


def _call_enumerate(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    start = named.get("start", given[1] if len(given) > 1 else 0)
    return ListValue([ListValue([start + at, one], is_frozen=True) for at, one in enumerate(machine.iterate(given[0]))])


def _call_zip(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    rows = zip(*[machine.iterate(one) for one in given], strict=False)
    return ListValue([ListValue(list(row), is_frozen=True) for row in rows])


def _call_map(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    return ListValue(
        [machine.call(given[0], list(row), {}) for row in zip(*map(machine.iterate, given[1:]), strict=False)]
    )


def _call_filter(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    keep = given[0]
    return ListValue([
        one for one in machine.iterate(given[1])
        if machine.is_true(one if keep is None else machine.call(keep, [one], {}))
    ])  # fmt: skip


def _call_reversed(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    return ListValue(machine.iterate(given[0])[::-1])


def _call_sorted(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    elements = machine.iterate(given[0])
    if named or any(is_symbolic(one) or not isinstance(one, (int, float, str)) for one in elements):
        raise NotModelledError("sorted() of values that are not known")
    try:
        return ListValue(sorted(elements))
    except TypeError as error:
        raise machine.run.throw("TypeError", str(error)) from error


def _call_hasattr(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    from .run import PythonThrownError

    if not isinstance(given[1], str):
        return Opaque("hasattr()")
    try:
        found = machine.get_member(given[0], given[1])
    except PythonThrownError as error:
        if error.name == "AttributeError":
            return False
        raise
    return Opaque("hasattr()") if isinstance(found, (Opaque, KnownMethod)) else True


def _call_getattr(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    from .run import PythonThrownError

    if not isinstance(given[1], str):
        raise NotModelledError("getattr() of a name that is not known")
    try:
        return machine.get_member(given[0], given[1])
    except PythonThrownError as error:
        if error.name == "AttributeError" and len(given) > 2:
            return given[2]
        raise


def _call_setattr(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    if not isinstance(given[1], str):
        raise NotModelledError("setattr() of a name that is not known")
    machine.set_member(given[0], given[1], given[2])


def _call_chr(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    if isinstance(given[0], int):
        try:
            return chr(given[0])
        except ValueError as error:
            raise machine.run.throw("ValueError", str(error)) from error
    return Opaque("chr()")


def _call_ord(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    characters = texts.list_characters(machine.run, given[0]) if isinstance(given[0], (str, SymbolicText)) else ()
    if len(characters) != 1:
        raise machine.run.throw("TypeError", "ord() expected a character")
    one = characters[0]
    return one if isinstance(one, int) else make_whole(z3.ZeroExt(8, one), 0, 127)


def _call_type(machine: Machine, given: list[Any], named: dict[str, Any]) -> Any:
    return given[0].cls if isinstance(given[0], PythonObject) else Opaque("type()")


_BUILT_INS: dict[str, Callable[[Any, list[Any], dict[str, Any]], Any]] = {
    "len": _call_len, "int": _call_int, "long": _call_int, "float": _call_float, "bool": _call_bool,
    "str": _call_str, "unicode": _call_str, "repr": _call_str, "range": _call_range, "xrange": _call_range,
    "abs": _call_abs, "min": _choose_extreme(True), "max": _choose_extreme(False), "sum": _call_sum,
    "round": _call_round, "isinstance": _call_isinstance, "any": _call_any, "all": _call_all, "list": _call_list,
    "tuple": _call_tuple, "dict": _call_dict, "enumerate": _call_enumerate, "zip": _call_zip, "map": _call_map,
    "filter": _call_filter, "reversed": _call_reversed, "sorted": _call_sorted, "hasattr": _call_hasattr,
    "getattr": _call_getattr, "setattr": _call_setattr, "chr": _call_chr, "ord": _call_ord, "type": _call_type,
    "set": _call_list, "frozenset": _call_list, "bytearray": _call_list,
}  # fmt: skip


# Mathematics.


def _compute(function: Callable[..., Any]) -> Callable[[Machine, list[Any]], Any]:
    """A function of math of numbers that are known; of others a float between some bounds that it keeps."""

    def compute(machine: Machine, given: list[Any]) -> Any:
        if not any(is_symbolic(one) for one in given):
            try:
                return function(*given)
            except (ValueError, OverflowError, TypeError, ZeroDivisionError) as error:
                raise machine.run.throw(type(error).__name__, str(error)) from error
        _refuse_outside_domain(machine, function.__name__, given)
        name = machine.run.make_name(f"~{function.__name__}")
        machine.run.assumed[f"{function.__name__}() gives any value"] = None
        value = machine.run.get_real(name, 64)
        bound = _BOUNDS.get(function.__name__)
        if bound is not None:
            magnitude = z3.fpAbs(value.term)
            known = z3.Or(z3.fpIsNaN(value.term), z3.fpLEQ(magnitude, z3.FPVal(bound, FLOAT64)))
            machine.run.assume(known)
            if all(get_span(one).is_finite for one in given):
                machine.run.assume(z3.Not(z3.fpIsNaN(value.term)))
                return Real(value.term, RealSpan(-bound, bound, True))
        return value

    return compute


def _refuse_outside_domain(machine: Machine, name: str, given: list[Any]) -> None:
    """Raises what Python's functions raise for numbers that they have no value for."""
    term, one = convert_to_real(given[0]), z3.FPVal(1.0, FLOAT64)
    bad: z3.BoolRef | None = None
    if name in ("sin", "cos", "tan") and not get_span(given[0]).is_finite:
        bad = z3.fpIsInf(term)
    elif name in ("asin", "acos"):
        bad = z3.fpGT(z3.fpAbs(term), one)
    elif name in ("log", "log10"):
        bad = z3.fpLEQ(term, z3.FPVal(0.0, FLOAT64))
    elif name == "fmod":
        bad = z3.Or(z3.fpIsInf(term), z3.fpIsZero(convert_to_real(given[1])))
    if bad is not None and machine.run.decide(make_truth(bad)):
        raise machine.run.throw("ValueError", "math domain error")
    if name == "exp" and machine.run.decide(make_truth(z3.And(
        z3.fpGT(term, z3.FPVal(709.782712893384, FLOAT64)), z3.Not(z3.fpIsInf(term))
    ))):  # fmt: skip
        raise machine.run.throw("OverflowError", "math range error")


_SAME_IN_NUMPY = frozenset(("isnan", "isinf", "isfinite", "fabs", "deg2rad", "rad2deg", "radians", "degrees"))
"""Functions of numpy that do with a float what those of math do."""
_BOUNDS = {
    "sin": 1.0,
    "cos": 1.0,
    "atan": math.pi / 2,
    "atan2": math.pi,
    "asin": math.pi / 2,
    "acos": math.pi,
    "tanh": 1.0,
}


def _is_nan(machine: Machine, given: list[Any]) -> Any:
    return not get_span(given[0]).is_number and make_truth(z3.fpIsNaN(convert_to_real(given[0])))


def _is_infinite(machine: Machine, given: list[Any]) -> Any:
    return not get_span(given[0]).is_finite and make_truth(z3.fpIsInf(convert_to_real(given[0])))


def _is_finite(machine: Machine, given: list[Any]) -> Any:
    term = convert_to_real(given[0])
    if get_span(given[0]).is_finite:
        return True
    return make_truth(z3.Not(z3.Or(z3.fpIsNaN(term), z3.fpIsInf(term))))


def _take_root(machine: Machine, given: list[Any]) -> Any:
    term = convert_to_real(given[0])
    if machine.run.decide(operators.compare(ast.Lt, given[0], 0.0)):
        raise machine.run.throw("ValueError", "math domain error")
    return make_real(z3.fpSqrt(z3.RNE(), term))


def _round_to(rounding: Any) -> Callable[[Machine, list[Any]], Any]:
    def round_to(machine: Machine, given: list[Any]) -> Any:
        value = given[0]
        if isinstance(value, Real):
            return operators.convert_to_integer(machine.run, value, rounding)
        if isinstance(value, float):
            try:
                return math.floor(value) if rounding.eq(z3.RTN()) else math.ceil(value)
            except (ValueError, OverflowError) as error:
                raise machine.run.throw(type(error).__name__, str(error)) from error
        return convert_to_whole(value)

    return round_to


def _scale(by: float) -> Callable[[Machine, list[Any]], Any]:
    return lambda machine, given: machine.calculate(ast.Mult, given[0], by)


def _find_magnitude(machine: Machine, given: list[Any]) -> Any:
    return make_real(z3.fpAbs(convert_to_real(given[0])))


_MATH: dict[str, Callable[[Any, list[Any]], Any]] = {
    "isnan": _is_nan, "isinf": _is_infinite, "isfinite": _is_finite, "sqrt": _take_root, "fabs": _find_magnitude,
    "floor": _round_to(z3.RTN()), "ceil": _round_to(z3.RTP()), "radians": _scale(math.pi / 180),
    "degrees": _scale(180 / math.pi), "deg2rad": _scale(math.pi / 180), "rad2deg": _scale(180 / math.pi),
    **{name: _compute(getattr(math, name)) for name in (
        "sin", "cos", "tan", "atan", "atan2", "asin", "acos", "hypot", "pow", "exp", "log", "fmod", "copysign", "log10",
        "sinh", "cosh", "tanh",
    )},
}  # fmt: skip
