"""Runs one callback of a Python node on one message, without ROS. A program of its own: `python -I stand_in.py`.

Reads a JSON object from standard input: root folders, module, function, messages with their definitions, the message,
members of the node, and what its surroundings answer. Modules that are not there are stood in for. Writes one JSON
object: what others would have observed, what was logged, and how the callback ended.
"""

import builtins
import importlib
import importlib.abc
import importlib.machinery
import inspect
import json
import math
import os
import struct
import sys
import traceback
import types

TASK = json.loads(sys.stdin.read()) if __name__ == "__main__" else {}
EVENTS = []
ASKED = {}
_BITS = {"float32": ("<I", "<f"), "float64": ("<Q", "<d")}


def note(kind, name=""):
    EVENTS.append([kind, name])


def answer(path, default=None):
    """What the witness has for a question of the callback to its surroundings; each further one has its own name."""
    count = ASKED[path] = ASKED.get(path, 0) + 1
    found = TASK["answers"].get(path if count == 1 else f"{path}#{count}")
    return default if found is None else decode(found)


def count_nanoseconds():
    now = answer("~now", 0)
    return now if isinstance(now, int) else 0


def decode(value):
    """A value of the witness: a number, or `{"float64": bits}` and the like."""
    if isinstance(value, dict) and len(value) == 1:
        kind, inner = next(iter(value.items()))
        if kind in _BITS:
            whole, real = _BITS[kind]
            return struct.unpack(real, struct.pack(whole, inner))[0]
        if kind == "text":
            return bytes.fromhex(inner).decode("latin-1")
        if kind == "list":
            return [decode(one) for one in inner]
        if kind == "message":
            return make_message(inner["type"], {name: decode(one) for name, one in inner["fields"].items()})
    return value


class _Message:
    """Of any type; fields by its definition."""

    _type = ""
    __slots__ = ("__dict__",)

    def __init__(self, *given, **named):
        definition = TASK["definitions"].get(self._type)
        for name, default in (definition or {"fields": {}})["fields"].items():
            setattr(self, name, decode(default))
        for name, value in zip((definition or {"fields": {}})["fields"], given, strict=False):
            setattr(self, name, value)
        for name, value in named.items():
            if definition is not None and name not in definition["fields"]:
                raise AttributeError(f"{self._type} has no field {name}")
            setattr(self, name, value)

    def __setattr__(self, name, value):
        definition = TASK["definitions"].get(self._type)
        if definition is not None and name not in definition["fields"]:
            raise AttributeError(f"{self._type} has no field {name}")
        object.__setattr__(self, name, value)

    def __eq__(self, other):
        return isinstance(other, _Message) and self._type == other._type and self.__dict__ == other.__dict__

    __hash__ = None  # type: ignore[assignment]

    def to_sec(self):
        numbers = list(self.__dict__.values())
        return numbers[0] + numbers[1] / 1e9


CLASSES = {}


def find_class(type_):
    if type_ not in CLASSES:
        definition = TASK["definitions"].get(type_) or {"constants": {}}
        members = {name: decode(value) for name, value in definition["constants"].items()}
        CLASSES[type_] = type(type_.rpartition("/")[2], (_Message,), {"_type": type_, "__slots__": (), **members})
    return CLASSES[type_]


def make_message(type_, fields):
    message = find_class(type_)()
    for name, value in fields.items():
        object.__setattr__(message, name, value)
    return message


class _Stub:
    """Anything of ROS: its members and calls are of this kind again; a few of them are observed."""

    def __init__(self, name="", kind=""):
        self.__dict__.update(_name=name, _kind=kind)

    def __getattr__(self, name):
        if name.startswith("__") and name.endswith("__"):
            raise AttributeError(name)
        return _Stub(f"{self._name}.{name}")

    def __call__(self, *given, **named):
        return call(self._name, given, named)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        return False

    def __iter__(self):
        return iter(())

    def __getitem__(self, key):
        return _Stub(f"{self._name}[]")

    def __setitem__(self, key, value):
        pass

    def __len__(self):
        return 0

    def __bool__(self):
        return True

    def __mro_entries__(self, bases):
        return (_Node,)

    def _calculate(self, *_):
        return _Stub(f"{self._name} calculated")

    __add__ = __radd__ = __sub__ = __rsub__ = __mul__ = __rmul__ = __truediv__ = __rtruediv__ = _calculate
    __floordiv__ = __rfloordiv__ = __mod__ = __rmod__ = __pow__ = __rpow__ = __neg__ = __abs__ = _calculate


_LEVELS = ("loginfo", "logwarn", "logerr", "logdebug", "logfatal")
_LOGGER = ("debug", "info", "warn", "warning", "error", "fatal", "critical", "exception")


def call(name, given, named):
    last = name.rpartition(".")[2]
    if last.startswith(_LEVELS) or (last in _LOGGER and "log" in name):
        note("log", last)
        return None
    if last == "Publisher":
        return _Publisher()
    if last == "ServiceProxy":
        return _Client()
    if last == "get_param" and given:
        default = given[1] if len(given) > 1 else named.get("default")
        return answer("~param." + str(given[0]).lstrip("~/"), default)
    if last == "set_param":
        note("parameter", str(given[0]) if given else "")
        return None
    if last in ("get_time", "time") and name.startswith(("rospy", "time")):
        return count_nanoseconds() / 1e9
    if last in ("now", "get_rostime") or name in (
        "rospy.Time",
        "rospy.Duration",
        "rospy.Time.from_sec",
        "rospy.Duration.from_sec",
    ):
        if last in ("now", "get_rostime"):
            return _Moment(count_nanoseconds())
        return _Moment(int(given[0] * 1e9) + (int(given[1]) if len(given) > 1 else 0) if given else 0)
    if name == "rclpy.time.Time.from_msg" and given and given[0].sec < 0:
        raise ValueError("Seconds value must not be negative")
    if name in ("rclpy.time.Time.from_msg", "rclpy.duration.Duration.from_msg") and given:
        return _Moment(_count(given[0]))
    if name.startswith(ROTATIONS) and last in COMPUTED:
        return COMPUTED[last](*given, **named)
    if name.startswith("cv_bridge.") and last == "imgmsg_to_cv2":
        check_encoding(given[0] if given else named.get("img_msg"))
    if last == "sendTransform":
        note("transform")
        return None
    if last.startswith("send_goal"):
        note("action")
    if last == "signal_shutdown" or name == "rclpy.shutdown":
        note("shutdown", name)
        return None
    if last == "is_shutdown":
        return False
    return _Stub(name + "()")


class CvBridgeError(TypeError):
    pass


def check_encoding(picture):
    """Raises what cv_bridge does for an encoding that it does not know."""
    encoding = getattr(picture, "encoding", None)
    if isinstance(encoding, str) and encoding not in ENCODINGS and not encoding.startswith(ENCODING_TYPES):
        raise CvBridgeError("Unrecognized image encoding [" + encoding + "]")


ENCODING_TYPES = ("8U", "8S", "16U", "16S", "32S", "32F", "64F")
ENCODINGS = ("mono8", "mono16", "rgb8", "rgb16", "bgr8", "bgr16", "rgba8", "rgba16", "bgra8", "bgra16", "yuv422")
ENCODINGS += ("bayer_rggb8", "bayer_bggr8", "bayer_gbrg8", "bayer_grbg8")
ENCODINGS += ("bayer_rggb16", "bayer_bggr16", "bayer_gbrg16", "bayer_grbg16")
ENCODINGS += ("yuv422_yuy2", "uyvy", "yuyv", "nv12", "nv21", "nv24")
ROTATIONS = ("tf.transformations.", "tf_transformations.", "transformations.")


def compute_euler(quaternion, axes="sxyz"):
    """Roll, pitch and yaw."""
    x, y, z, w = (float(quaternion[at]) for at in range(4))
    size = x * x + y * y + z * z + w * w
    if not size > 1e-15:
        return 0.0, 0.0, 0.0
    sine = 2 * (w * y - z * x) / size
    pitch = math.asin(max(-1.0, min(1.0, sine))) if sine == sine else sine
    roll = math.atan2(2 * (w * x + y * z) / size, 1 - 2 * (x * x + y * y) / size)
    return roll, pitch, math.atan2(2 * (w * z + x * y) / size, 1 - 2 * (y * y + z * z) / size)


def compute_quaternion(ai, aj, ak, axes="sxyz"):
    """x, y, z and w, of roll, pitch and yaw."""
    (a, b), (c, d), (e, f) = ((math.cos(angle / 2), math.sin(angle / 2)) for angle in (ai, aj, ak))
    return [b * c * e - a * d * f, a * d * e + b * c * f, a * c * f - b * d * e, a * c * e + b * d * f]


COMPUTED = {"euler_from_quaternion": compute_euler, "quaternion_from_euler": compute_quaternion}


class _Moment:
    def __init__(self, nanoseconds):
        self.nanoseconds = nanoseconds

    secs = sec = property(lambda self: self.nanoseconds // 10**9)
    nsecs = nanosec = property(lambda self: self.nanoseconds % 10**9)

    def to_sec(self):
        return self.nanoseconds / 1e9

    def to_nsec(self):
        return self.nanoseconds

    def __sub__(self, other):
        return _Moment(self.nanoseconds - _count(other))

    def __add__(self, other):
        return _Moment(self.nanoseconds + _count(other))

    def __lt__(self, other):
        return self.nanoseconds < _count(other)

    def __gt__(self, other):
        return self.nanoseconds > _count(other)

    def __le__(self, other):
        return self.nanoseconds <= _count(other)

    def __ge__(self, other):
        return self.nanoseconds >= _count(other)

    def __eq__(self, other):
        return self.nanoseconds == _count(other)

    __hash__ = None  # type: ignore[assignment]

    def to_msg(self):
        return self

    def is_zero(self):
        return self.nanoseconds == 0


def _count(other):
    if hasattr(other, "nanoseconds"):
        return other.nanoseconds
    numbers = list(vars(other).values())
    return numbers[0] * 10**9 + numbers[1]


class _Publisher:
    def publish(self, *given, **named):
        note("publish", find_name(self))

    def get_num_connections(self):
        return 1

    get_subscription_count = get_num_connections

    def unregister(self):
        pass


class _Client:
    def __call__(self, *given, **named):
        note("service", find_name(self))
        return _Stub("response")

    call = call_async = __call__

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        return _Stub(name)


OWNER = []


def find_name(value):
    """The name of the member that holds something."""
    for owner in OWNER:
        for name, one in vars(owner).items():
            if one is value:
                return name
    return ""


class _Node:
    """A base class that is not there."""

    def __init__(self, *given, **named):
        pass

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        if name == "create_publisher":
            return lambda *given, **named: _Publisher()
        if name == "create_client":
            return lambda *given, **named: _Client()
        if name == "declare_parameter":
            return lambda key, value=None, *more, **named: _Parameter(key, value)
        if name in ("get_parameter", "get_parameter_or"):
            return lambda key, *more: _Parameter(key, None)
        if name == "get_clock":
            return lambda: _Clock()
        if name == "get_logger":
            return lambda *given: _Stub("logger")
        if name in ("set_parameters", "destroy_node"):
            return lambda *given, **named: note("parameter" if name == "set_parameters" else "shutdown", name)
        if name.startswith(("create_", "get_", "add_", "destroy_", "declare_", "count_", "has_", "resolve_", "wait_")):
            return _Stub(name)
        raise AttributeError(f"{type(self).__name__} has no {name}")


class _Clock:
    def now(self):
        return _Moment(count_nanoseconds())


PARAMETERS = {}


class _Parameter:
    def __init__(self, key, default):
        if default is not None:
            PARAMETERS[key] = answer("~param." + key, default)
        self.value = PARAMETERS.get(key)

    def get_parameter_value(self):
        return self

    def __getattr__(self, name):
        if name.endswith("_value"):
            return self.value
        raise AttributeError(name)


class _Service:
    """A type of services, with those of its two messages."""

    def __init__(self, name):
        self.Request, self.Response = find_class(f"{name}Request"), find_class(f"{name}Response")


class _StandIn(types.ModuleType):
    """A module that is not there."""

    def __getattr__(self, name):
        if name.startswith("__") and name.endswith("__"):
            raise AttributeError(name)
        parts = self.__name__.split(".")
        if len(parts) > 1 and parts[1] == "msg" and name[:1].isupper():
            return find_class(f"{parts[0]}/{name}")
        if len(parts) > 1 and parts[1] == "srv" and name[:1].isupper():
            whole = f"{parts[0]}/{name}"
            return find_class(whole) if name.endswith(("Request", "Response")) else _Service(whole)
        if name == "CvBridgeError":
            made = CvBridgeError
        elif name.endswith(("Exception", "Error", "Interrupt")):
            made = type(name, (Exception,), {})
        elif name[:1].isupper() and self.__name__.startswith("rclpy") and name.endswith("Node"):
            made = _Node
        elif parts[0] == "rospy" and name in ("Header",):
            made = find_class("std_msgs/Header")
        else:
            made = _Stub(f"{self.__name__}.{name}")
        setattr(self, name, made)
        return made


class _Finder(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Comes last: what nobody else finds."""

    def find_spec(self, name, path=None, target=None):
        return importlib.machinery.ModuleSpec(name, self, is_package=True)

    def create_module(self, spec):
        module = _StandIn(spec.name)
        module.__path__ = []
        return module

    def exec_module(self, module):
        pass


def load_module(name, file):
    """A module by its name in a package, and else by its file, which may have no `.py`."""
    if "." in name:
        return importlib.import_module(name)
    loader = importlib.machinery.SourceFileLoader(name, file)
    module = types.ModuleType(name)
    module.__file__ = file
    sys.modules[name] = module
    loader.exec_module(module)
    return module


def find_line(error):
    """The innermost line of the workspace that an exception came through."""
    place = ["", 0]
    for frame, line in traceback.walk_tb(error.__traceback__):
        path = os.path.realpath(frame.f_code.co_filename)
        if any(path.startswith(root + os.sep) for root in ROOTS):
            place = [path, line]
    return place


ROOTS = [os.path.realpath(root) for root in TASK.get("roots", ())]


def main():
    result = {"end": "returned", "exception": "", "line": ["", 0]}
    real = sys.stdout
    sys.stdout = sys.stderr
    builtins.print = lambda *given, **named: note("log", "print")
    sys.path[:0] = TASK["folders"]
    sys.meta_path.append(_Finder())
    try:
        module = load_module(TASK["module"], TASK["file"])
        owner = module
        parts = TASK["function"].split(".")
        for part in parts[:-1]:
            owner = getattr(owner, part)
    except BaseException as error:
        result.update(end="not loaded", exception=f"{type(error).__name__}: {error}", line=find_line(error))
        real.write(json.dumps(result))
        return
    given = []
    if len(parts) > 1:
        node = getattr(owner, "__new__")(owner)  # noqa: B009
        OWNER.append(node)
        try:
            node.__init__()
        except BaseException as error:
            result["made"] = f"{type(error).__name__}: {error}"
        for name, value in TASK["members"].items():
            try:
                setattr(node, name, decode(value))
            except Exception as error:
                result["made"] = f"{type(error).__name__}: {error}"
        function = getattr(node, parts[-1])
    else:
        function = getattr(owner, parts[-1])
    for name, value in TASK["globals"].items():
        setattr(module, name, decode(value))
    given.extend(decode(one) for one in TASK["messages"])
    given.extend(_Stub(name) for name in list_others(function, len(given)))
    EVENTS.clear()
    held = [vars(one) for one in (*OWNER[:1], module)]
    before = [dict(one) for one in held]
    sizes = [{name: repr(value) for name, value in one.items() if is_plain(name, value)} for one in before]
    try:
        returned = function(*given)
        if TASK["replies"] and returned is not None:
            note("reply", "response")
    except BaseException as error:
        result.update(end="raised", exception=type(error).__name__, detail=str(error)[:300], line=find_line(error))
    for names, olds, texts in zip(held, before, sizes, strict=True):
        for name, value in list(names.items()):
            old = olds.get(name)
            changed = repr(value) != texts[name] if name in texts else value is not old and not is_same(value, old)
            if changed:
                note("member", name)
    result["events"] = EVENTS
    real.write(json.dumps(result))


def list_others(function, given):
    """The names of further arguments that a callback has to be given (`callback_args`)."""
    try:
        parameters = list(inspect.signature(function).parameters.values())
    except (TypeError, ValueError):
        return []
    wanted = [one for one in parameters if one.kind in (one.POSITIONAL_ONLY, one.POSITIONAL_OR_KEYWORD)]
    return [one.name for one in wanted[given:] if one.default is one.empty]


def is_plain(name, value):
    return isinstance(value, (list, dict, set)) and not name.startswith("__")


def is_same(one, other):
    try:
        return bool(one == other)
    except Exception:
        return False


if __name__ == "__main__":
    main()
