"""Callbacks of Python nodes: what they handle, ignore and crash on, and that the real function does the same."""

import ast
import textwrap
from collections import Counter

import pytest
import z3
from rosimpact.impact.facts.interface import extract
from rosimpact.impact.values.evaluate import evaluate
from rosimpact.impact.values.harness.replay import is_confirmed
from rosimpact.impact.values.outcomes import Bounds, CrashKind, Reaction, Witness
from rosimpact.impact.values.python.explore import CallbackCode, explore_callback
from rosimpact.impact.values.python.messages import Messages
from rosimpact.impact.values.python.modules import ModuleCode
from rosimpact.impact.values.python.replay import ReplayPlace, replay_witness

MESSAGES = {
    "std_msgs/String": "string data\n",
    "std_msgs/Int32": "int32 data\n",
    "std_msgs/UInt8": "uint8 data\n",
    "std_msgs/Bool": "bool data\n",
    "std_msgs/Float64": "float64 data\n",
    "std_msgs/Header": "uint32 seq\ntime stamp\nstring frame_id\n",
    "geometry_msgs/Vector3": "float64 x\nfloat64 y\nfloat64 z\n",
    "geometry_msgs/Quaternion": "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n",
    "lamp_srvs/SwitchRequest": "uint8 level\n",
    "lamp_srvs/SwitchResponse": "bool success\nfloat64 share\n",
    "lamp_msgs/Stamped": "builtin_interfaces/Time stamp\n",
    "geometry_msgs/Twist": "Vector3 linear\nVector3 angular\n",
    "geometry_msgs/PointStamped": "std_msgs/Header header\nVector3 point\n",
    "sensor_msgs/LaserScan": "float32 range_min\nfloat32 range_max\nfloat32[] ranges\n",
    "sensor_msgs/JointState": "string[] name\nfloat64[] position\n",
    "lamp_msgs/Lamp": "uint8 OFF=0\nuint8 GREEN=1\nuint8 RED=3\nuint8 value\nint32[3] parts\n",
}
ONE_NUMBER = (("msg", "std_msgs/Int32"),)
HEAD = """
import math
import rospy
from std_msgs.msg import String, Int32, Float64, Bool, UInt8
from geometry_msgs.msg import Twist
from lamp_msgs.msg import Lamp
from motor_driver import MotorDriver
from std_srvs.srv import Empty


class Broken(Exception):
    pass


class Worse(Broken):
    pass


class Driver(object):
    def __init__(self):
        self.pub = rospy.Publisher("out", Int32, queue_size=1)
        self.drive = rospy.Publisher("drive", Twist, queue_size=1)
        self.reset = rospy.ServiceProxy("reset", Empty)
        self.enabled = False
        self.last = 0
        self.target = None
        self.table = {"start": 1, "stop": 2}
        self.limits = [1, 2, 3]
        self.rate = rospy.get_param("~rate", 10)
        self.motor = MotorDriver()

    def enable(self, msg):
        self.enabled = msg.data

    def remember(self, msg):
        self.target = msg

    def tell(self):
        return self.enabled, self.last, self.target

    def check(self, value):
        if value > 100:
            raise Worse("too much")
        return value

"""


def explore(body, message, tmp_path, bounds=None):
    """The exploration of `callback`, and what replays say of one witness per kind of outcome."""
    return explore_text(
        HEAD + textwrap.indent(textwrap.dedent(body), "    "), "Driver.callback", message, tmp_path, bounds
    )


def explore_text(text, name, message, tmp_path, bounds=None, joined=(), place_of_message=0, ros=1, kind="subscriber"):
    (tmp_path / "driver.py").write_text(text)
    sections = {name: extract(found.encode(), "msg").sections[0] for name, found in MESSAGES.items()}
    messages = Messages(sections.get, ros)
    module = ModuleCode("driver", "driver.py", ast.parse(text))
    code = CallbackCode(module, name, 0, message, joined, place_of_message, kind, ros == 2)
    found = explore_callback(code, messages, lambda name: None, bounds or Bounds(text=5))
    kinds = {name: (one.kind, one.bits, one.is_signed) for name, one in found.inputs.items()}
    seen = {}
    for path in found.paths:
        key = path.result, path.crash
        if path.result is Reaction.UNKNOWN or key in seen:
            continue
        solver = z3.Solver()
        solver.add(*path.condition)
        assert solver.check() == z3.sat
        model = solver.model()
        values = {name: model.eval(one.term, True).as_long() for name, one in found.inputs.items()}
        witness = Witness(values, path.result, path.crash, path.place)
        given = tuple(code.list_messages())
        place = ReplayPlace(tmp_path, (tmp_path,), "driver", name, given, tmp_path / "driver.py", kind == "service")
        replayed = replay_witness(place, witness, kinds, messages, tmp_path)
        seen[key] = is_confirmed(witness, replayed) or replayed
    return found, seen


def solve(found, result, name, crash=None):
    """Some values of an input that lead to a reaction, as numbers without sign."""
    values = set()
    for path in found.paths:
        if path.result is result and (crash is None or path.crash is crash):
            solver = z3.Solver()
            solver.add(*path.condition)
            while solver.check() == z3.sat and len(values) < 20:
                value = solver.model().eval(found.inputs[name].term, True).as_long()
                values.add(value)
                solver.add(found.inputs[name].term != value)
    return values


CRASHES = {
    "division": ("self.pub.publish(10 // msg.data)", "std_msgs/Int32", CrashKind.DIVISION),
    "modulo": ("self.pub.publish(10 % (msg.data - 4))", "std_msgs/Int32", CrashKind.DIVISION),
    "float division": ("self.pub.publish(1.0 / msg.data)", "std_msgs/Float64", CrashKind.DIVISION),
    "index": ("self.pub.publish(self.limits[msg.data])", "std_msgs/UInt8", CrashKind.INDEX),
    "negative index": ("self.pub.publish(self.limits[-msg.data])", "std_msgs/UInt8", CrashKind.INDEX),
    "empty array": ("self.pub.publish(int(msg.ranges[0] > 1))", "sensor_msgs/LaserScan", CrashKind.INDEX),
    "two arrays": (
        "for index, name in enumerate(msg.name):\n        self.pub.publish(msg.position[index] > 0)",
        "sensor_msgs/JointState", CrashKind.INDEX,
    ),
    "pop": ("found = [one for one in msg.ranges if one > 2]\n    self.pub.publish(found.pop() > 3)",
            "sensor_msgs/LaserScan", CrashKind.INDEX),
    "key": ("self.pub.publish(self.table[msg.data])", "std_msgs/String", CrashKind.EXCEPTION),
    "int of a text": ("self.pub.publish(int(msg.data))", "std_msgs/String", CrashKind.EXCEPTION),
    "part of a text": (
        "if msg.data.startswith('go'):\n        self.pub.publish(msg.data.split(':')[1] == 'x')",
        "std_msgs/String", CrashKind.INDEX,
    ),
    "unpacking": ("left, right = msg.data.split(',')\n    self.pub.publish(left == right)", "std_msgs/String",
                  CrashKind.EXCEPTION),
    "NaN to int": ("self.pub.publish(int(msg.data))", "std_msgs/Float64", CrashKind.FLOAT_TO_INTEGER),
    "rounding": ("self.pub.publish(round(min(msg.data, 5.0)))", "std_msgs/Float64", CrashKind.FLOAT_TO_INTEGER),
    "root": ("self.pub.publish(math.sqrt(msg.data) > 1)", "std_msgs/Float64", CrashKind.EXCEPTION),
    "sine of infinity": ("self.pub.publish(math.sin(msg.data) > 0)", "std_msgs/Float64", CrashKind.EXCEPTION),
    "None": (
        "self.pub.publish(self.find(msg.data).data)\n\ndef find(self, key):\n    if key > 3:\n        return Int32(1)",
        "std_msgs/Int32", CrashKind.NULL,
    ),
    "assertion": ("assert msg.data < 5\n    self.pub.publish(1)", "std_msgs/Int32", CrashKind.ASSERTION),
    "raised": ("self.pub.publish(self.check(msg.data))", "std_msgs/Int32", CrashKind.EXCEPTION),
    "minimum of nothing": ("self.pub.publish(min(msg.ranges) < 1)", "sensor_msgs/LaserScan", CrashKind.EXCEPTION),
    "field that is none": ("if msg.data == 7:\n        msg.missing = 1\n    self.pub.publish(1)", "std_msgs/Int32",
                           CrashKind.EXCEPTION),
    "nested": ("self.pub.publish(1 / msg.linear.x > 2)", "geometry_msgs/Twist", CrashKind.DIVISION),
}  # fmt: skip


@pytest.mark.parametrize("name", CRASHES)
def test_a_crash_is_found_and_seen_in_the_real_function(name, tmp_path):
    body, message, kind = CRASHES[name]
    found, replays = explore(f"def callback(self, msg):\n    {body}\n", message, tmp_path)
    assert kind in {path.crash for path in found.paths}
    assert set(replays.values()) == {True}, replays
    assert all(path.place.path == "driver.py" and path.place.line > 0 for path in found.paths if path.crash)


SAFE = {
    "checked division": ("if msg.data != 0:\n        self.pub.publish(10 // msg.data)", "std_msgs/Int32"),
    "caught": ("try:\n        self.pub.publish(int(msg.data))\n    except ValueError:\n        rospy.logwarn('no')",
               "std_msgs/String"),
    "caught by a base": (
        "try:\n        self.pub.publish(self.check(msg.data))\n    except Broken:\n        rospy.logerr('no')",
        "std_msgs/Int32",
    ),
    "checked size": ("if len(msg.ranges) > 1:\n        self.pub.publish(msg.ranges[1] > 1)", "sensor_msgs/LaserScan"),
    "half of a size": ("if msg.ranges:\n        self.pub.publish(msg.ranges[len(msg.ranges) // 2] > 1)",
                       "sensor_msgs/LaserScan"),
    "finite": ("if math.isfinite(msg.data) and abs(msg.data) < 1000:\n        self.pub.publish(int(msg.data))",
               "std_msgs/Float64"),
    "quotient of integers": ("if msg.data:\n        self.pub.publish(math.sin(1.0 / msg.data) > 0)", "std_msgs/Int32"),
    "get": ("self.pub.publish(self.table.get(msg.data, 0))", "std_msgs/String"),
    "fixed array": ("self.pub.publish(msg.parts[2])", "lamp_msgs/Lamp"),
}  # fmt: skip


@pytest.mark.parametrize("name", SAFE)
def test_what_is_guarded_is_no_crash(name, tmp_path):
    body, message = SAFE[name]
    found, replays = explore(f"def callback(self, msg):\n    {body}\n", message, tmp_path)
    assert Counter(path.crash for path in found.paths if path.result is Reaction.CRASH) == {}
    assert Reaction.HANDLED in {path.result for path in found.paths}
    assert set(replays.values()) == {True}, replays


def test_an_enumeration_is_handled_logged_and_ignored(tmp_path):
    body = """
    def callback(self, msg):
        if msg.value == Lamp.GREEN:
            self.pub.publish(1)
        elif msg.value in (Lamp.OFF, 9):
            self.reset()
        elif msg.value == Lamp.RED:
            rospy.logwarn("not yet")
    """
    found, replays = explore(body, "lamp_msgs/Lamp", tmp_path)
    assert solve(found, Reaction.HANDLED, "msg.value") == {0, 1, 9}
    assert solve(found, Reaction.LOG_ONLY, "msg.value") == {3}
    assert not solve(found, Reaction.IGNORED, "msg.value") & {0, 1, 3, 9}
    assert set(replays.values()) == {True} and len(replays) == 3


def test_commands_of_a_text(tmp_path):
    body = """
    def callback(self, msg):
        command = msg.data.strip().lower()
        if command == "go":
            self.pub.publish(1)
        elif command in self.table:
            self.pub.publish(self.table[command])
    """
    found, replays = explore(body, "std_msgs/String", tmp_path, Bounds(text=5, paths=2000))
    assert {path.crash for path in found.paths} == {None}
    assert solve(found, Reaction.HANDLED, "msg.data.size") >= {2, 4, 5}
    assert set(replays.values()) == {True}


def test_a_member_that_others_read_is_an_effect_where_it_changes(tmp_path):
    body = """
    def callback(self, msg):
        if msg.data > 3:
            self.last = msg.data
    """
    found, replays = explore(body, "std_msgs/Int32", tmp_path)
    assert {effect.kind for path in found.paths for effect in path.effects} == {"member"}
    same = [path for path in found.paths if path.result is Reaction.IGNORED]
    assert same and set(replays.values()) == {True}
    solver = z3.Solver()
    solver.add(found.inputs["msg.data"].term == 7, z3.Or(*[z3.And(*path.condition) for path in same]))
    assert solver.check() == z3.sat
    assert solver.model().eval(z3.Extract(31, 0, found.inputs["this.last"].term)).as_long() == 7


def test_state_of_the_node_is_any_that_its_methods_leave(tmp_path):
    body = """
    def callback(self, msg):
        if not self.enabled:
            return
        self.pub.publish(msg.data)
    """
    found, _ = explore(body, "std_msgs/Int32", tmp_path)
    assert Counter(path.result for path in found.paths) == {Reaction.HANDLED: 1, Reaction.IGNORED: 1}
    assert "this.enabled" in found.inputs


PLAIN = """
import rospy
from std_msgs.msg import Int32

last = Int32()
level = 0
lost = 0
armed = False
seen = []
pub = None


def arm(msg):
    global armed
    armed = msg.data > 0


def main():
    global pub, level
    pub = rospy.Publisher("out", Int32, queue_size=1)
    level = 1
    print(last, level, seen)
"""


def test_a_name_of_the_module_that_others_read_is_an_effect_where_it_changes(tmp_path):
    body = """
    def callback(msg):
        global last, level, lost
        if msg.data == 8:
            last = msg
        elif msg.data == 4:
            level = msg.data
        elif msg.data == 2:
            lost = msg.data
        elif msg.data == 1:
            seen.append(msg.data)
    """
    found, replays = explore_text(PLAIN + textwrap.dedent(body), "callback", "std_msgs/Int32", tmp_path)
    effects = {effect.name for path in found.paths for effect in path.effects}
    assert effects == {"last", "level", "seen"}
    assert solve(found, Reaction.HANDLED, "msg.data") == {1, 4, 8}
    assert set(replays.values()) == {True}


def test_names_of_the_module_are_what_its_functions_leave(tmp_path):
    body = """
    def callback(msg):
        if armed and pub is not None:
            pub.publish(msg.data)
    """
    found, replays = explore_text(PLAIN + textwrap.dedent(body), "callback", "std_msgs/Int32", tmp_path)
    assert "global.armed" in found.inputs
    assert {path.result for path in found.paths} >= {Reaction.IGNORED}
    assert any(path.result is not Reaction.IGNORED for path in found.paths)
    assert replays[(Reaction.IGNORED, None)] is True


def test_members_of_the_objects_that_a_node_keeps_are_effects(tmp_path):
    body = """
    class Projector(object):
        def __init__(self):
            self.model = None
            self.note = 0

        def set_model(self, number):
            if number <= 0:
                return
            self.model = (number, number)

        def project(self):
            return self.model


    class Viewer(object):
        def __init__(self):
            self.projector = Projector()

        def callback(self, msg):
            self.projector.set_model(msg.data)
            self.projector.note = 1
    """
    text = PLAIN + textwrap.dedent(body)
    found, _ = explore_text(text, "Viewer.callback", "std_msgs/Int32", tmp_path)
    assert {effect.name for path in found.paths for effect in path.effects} == {"projector.model"}
    assert Counter(path.result for path in found.paths) == {Reaction.HANDLED: 1, Reaction.IGNORED: 1}


def test_what_a_foreign_object_does_is_unknown_and_never_ignored(tmp_path):
    body = """
    def callback(self, msg):
        if msg.data > 0:
            self.motor.turn(msg.data)
    """
    found, _ = explore(body, "std_msgs/Int32", tmp_path)
    assert Counter(path.result for path in found.paths) == {Reaction.UNKNOWN: 1, Reaction.IGNORED: 1}
    assert "turn" in next(path.reason for path in found.paths if path.result is Reaction.UNKNOWN)


def test_a_message_that_is_sent_has_its_values(tmp_path):
    body = """
    def callback(self, msg):
        out = Twist()
        out.linear.x = 0.5 if msg.data else -0.5
        out.angular.z = max(-1.0, min(1.0, 0.25))
        self.drive.publish(out)
    """
    found, _ = explore(body, "std_msgs/Bool", tmp_path)
    sent = [path.sent[0] for path in found.paths]
    assert {one.publisher for one in sent} == {"drive"}
    assert {one.values["linear.x"] for one in sent} == {0x3FE0000000000000, 0xBFE0000000000000}
    assert {one.values["angular.z"] for one in sent} == {0x3FD0000000000000}
    assert {one.values["linear.y"] for one in sent} == {0}


def test_match_and_loops_with_bounds(tmp_path):
    body = """
    def callback(self, msg):
        count = msg.data
        while count > 0:
            count -= 1
        match msg.data:
            case 1 | 2:
                self.pub.publish(1)
            case _:
                pass
    """
    found, _ = explore(body, "std_msgs/Int32", tmp_path, Bounds(loops=4))
    reasons = {path.reason for path in found.paths if path.result is Reaction.UNKNOWN}
    assert reasons == {"a loop of more than 4 rounds"}
    assert solve(found, Reaction.HANDLED, "msg.data") == {1, 2}


def test_an_endless_loop_is_stopped_in_the_replay(tmp_path, monkeypatch):
    monkeypatch.setattr("rosimpact.impact.values.python.replay._SECONDS", 2.0)
    (tmp_path / "driver.py").write_text(HEAD + "    def callback(self, msg):\n        while True:\n            pass\n")
    messages = Messages({"std_msgs/Int32": extract(b"int32 data\n", "msg").sections[0]}.get, 1)
    place = ReplayPlace(tmp_path, (tmp_path,), "driver", "Driver.callback", ONE_NUMBER, tmp_path / "driver.py")
    witness = Witness({"msg.data": 1}, Reaction.CRASH, CrashKind.ENDLESS, replayed_place := ("", 0))
    seen = replay_witness(place, witness, {}, messages, tmp_path)
    assert (seen.result, seen.crash) == (Reaction.CRASH, CrashKind.ENDLESS) and replayed_place == ("", 0)


def test_a_module_that_cannot_be_loaded_is_said(tmp_path):
    (tmp_path / "driver.py").write_text("import os\nraise RuntimeError('no robot')\n")
    messages = Messages({"std_msgs/Int32": extract(b"int32 data\n", "msg").sections[0]}.get, 1)
    place = ReplayPlace(tmp_path, (tmp_path,), "driver", "Driver.callback", ONE_NUMBER, tmp_path / "driver.py")
    seen = replay_witness(place, Witness({}, Reaction.HANDLED, None, ("", 0)), {}, messages, tmp_path)
    assert seen.reason == "RuntimeError: no robot" and seen.place == ("driver.py", 2)
    assert not is_confirmed(Witness({}, Reaction.HANDLED, None, ("", 0)), seen)


ARRAYS = {
    "self.grid[:, 0] = msg.linear.x, msg.linear.y, msg.linear.z": ("geometry_msgs/Twist", {Reaction.HANDLED}),
    "self.row[:] = msg.ranges": ("sensor_msgs/LaserScan", {Reaction.HANDLED, Reaction.CRASH}),
    "self.row[msg.data] = 1.0": ("std_msgs/UInt8", {Reaction.HANDLED, Reaction.CRASH}),
    "if self.grid[1, msg.data] is None:\n        pass": ("std_msgs/UInt8", {Reaction.IGNORED, Reaction.CRASH}),
    "own = [1, 2, 3]\n    own[0:2] = [msg.data]\n    self.pub.publish(own[1])": ("std_msgs/UInt8", {Reaction.HANDLED}),
    "self.table['last'] = msg.data": ("std_msgs/UInt8", {Reaction.HANDLED}),
}


@pytest.mark.parametrize("statement", ARRAYS)
def test_elements_of_arrays_are_set_by_slices(statement, tmp_path):
    """numpy is not installed everywhere: what is found is checked, not replayed."""
    message, reactions = ARRAYS[statement]
    text = HEAD.replace("import math\n", "import math\nimport numpy as np\n").replace(
        "self.last = 0\n", "self.last = 0\n        self.grid = np.zeros((3, 4))\n        self.row = np.ones(2)\n"
    )
    text += f"""
    def callback(self, msg):
        {statement.replace(chr(10), chr(10) + "    ")}

    def report(self):
        self.pub.publish(int(self.grid[0, 0] + self.row[0] + self.table['last']))
"""
    sections = {name: extract(found.encode(), "msg").sections[0] for name, found in MESSAGES.items()}
    module = ModuleCode("driver", "driver.py", ast.parse(text))
    code = CallbackCode(module, "Driver.callback", 0, message)
    found = explore_callback(code, Messages(sections.get, 1), lambda name: None, Bounds())
    assert {path.result for path in found.paths} == reactions
    assert {path.crash for path in found.paths} <= {None, CrashKind.INDEX, CrashKind.EXCEPTION}


def test_a_constructor_opens_no_ways_and_what_it_leaves_open_is_any_value(tmp_path):
    text = HEAD.replace("self.last = 0\n", """self.last = 0
        self.gain = 1
        for name in rospy.get_param("~names", []):
            if name == "fast":
                self.gain = 5
        for number in range(12):
            if rospy.get_param("~wheel%d" % number, False):
                self.gain = number
        self.late = None
        if rospy.get_param("~late", False):
            self.late = rospy.Publisher("late", Int32, queue_size=1)
        else:
            self.late = rospy.Publisher("late", Int32, queue_size=2)
        while True:
            self.rate = self.rate + 1
""")  # fmt: skip
    body = """
    def callback(self, msg):
        if msg.data == 3:
            self.late.publish(self.gain)
        elif msg.data == 4 and self.gain > 100:
            self.pub.publish(1)

    def other(self):
        return self.gain
    """
    text += textwrap.indent(textwrap.dedent(body), "    ")
    sections = {name: extract(found.encode(), "msg").sections[0] for name, found in MESSAGES.items()}
    module = ModuleCode("driver", "driver.py", ast.parse(text))
    code = CallbackCode(module, "Driver.callback", 0, "std_msgs/Int32")
    found = explore_callback(code, Messages(sections.get, 1), lambda name: None, Bounds())
    assert found.left == 0
    counts = Counter(path.result for path in found.paths)
    assert counts[Reaction.HANDLED] >= 2 and counts[Reaction.IGNORED] >= 1 and counts[Reaction.UNKNOWN] == 0
    assert {one.name for path in found.paths for one in path.effects} == {"late", "pub"}
    assert len(found.paths) <= 6


@pytest.mark.parametrize("ros, expected", [(1, (0, 127)), (2, None)])
def test_a_byte_is_signed_in_ros_1_and_no_number_in_rclpy(ros, expected):
    sections = {"own/Raw": extract(b"byte data\n", "msg").sections[0]}
    text = "def callback(msg):\n    if msg.data >= 0:\n        raise IndexError('x')\n"
    module = ModuleCode("driver", "driver.py", ast.parse(text))
    code = CallbackCode(module, "callback", 0, "own/Raw")
    found = explore_callback(code, Messages(sections.get, ros), lambda name: None, Bounds())
    if expected is None:
        assert not found.inputs
        return
    assert (found.inputs["msg.data"].bits, found.inputs["msg.data"].is_signed) == (8, True)
    assert {path.result for path in found.paths} == {Reaction.CRASH, Reaction.IGNORED}


def test_a_number_that_does_not_fit_into_bytes(tmp_path):
    body = """
    def callback(self, msg):
        self.pub.publish(len(msg.data.to_bytes(2, "big", signed=True)))
    """
    found, seen = explore(body, "std_msgs/Int32", tmp_path)
    assert solve(found, Reaction.HANDLED, "msg.data") and solve(found, Reaction.CRASH, "msg.data")
    assert seen[(Reaction.CRASH, CrashKind.EXCEPTION)] is True


def test_an_exception_of_python_that_is_made_and_raised(tmp_path):
    body = """
    def callback(self, msg):
        try:
            if msg.data == 1:
                raise ValueError("one")
            if msg.data == 2:
                raise KeyError("two")
        except ValueError as error:
            rospy.logwarn("%s", error)
            return
        self.pub.publish(msg.data)
    """
    found, seen = explore(body, "std_msgs/UInt8", tmp_path)
    assert solve(found, Reaction.LOG_ONLY, "msg.data") == {1} and solve(found, Reaction.CRASH, "msg.data") == {2}
    assert set(seen.values()) == {True}, seen


JOINED = """
import rospy
from std_msgs.msg import Int32
pub = rospy.Publisher("out", Int32, queue_size=1)


def callback(scan, level, *more):
    if scan.range_max > 1.0:
        pub.publish(Int32(level.data // (len(more) + scan.range_min)))
"""


@pytest.mark.parametrize("place, own, other", [(0, "msg.range_max", "msg2.data"), (1, "msg1.range_max", "msg.data")])
def test_all_messages_of_a_synchronizer_are_given(tmp_path, place, own, other):
    joined = ("sensor_msgs/LaserScan", "std_msgs/Int32")
    found, seen = explore_text(JOINED, "callback", joined[place], tmp_path, joined=joined, place_of_message=place)
    assert own in found.inputs and other in found.inputs
    assert seen[Reaction.CRASH, CrashKind.DIVISION] is True and seen[Reaction.HANDLED, None] is True
    assert set(seen.values()) == {True}


def test_further_arguments_of_a_callback_are_given_in_a_replay(tmp_path):
    text = HEAD + "    def callback(self, msg, what, more=3):\n        self.pub.publish(Int32(msg.data))\n"
    _, seen = explore_text(text, "Driver.callback", "std_msgs/Int32", tmp_path)
    assert seen == {(Reaction.HANDLED, None): True}


TURNED = """
import rospy
from std_msgs.msg import Float64
from geometry_msgs.msg import Quaternion
from tf.transformations import euler_from_quaternion, quaternion_from_euler, quaternion_matrix
pub = rospy.Publisher("yaw", Float64, queue_size=1)


def by_numbers(msg):
    roll, pitch, yaw = euler_from_quaternion([msg.x, msg.y, msg.z, msg.w])
    x, y, z, w = quaternion_from_euler(0, 0, yaw)
    rotation = quaternion_matrix([x, y, z, w])
    pub.publish(Float64(rotation[3][3]))


def by_message(msg):
    pub.publish(Float64(euler_from_quaternion(msg)[2]))


def beyond_half_a_turn(msg):
    if euler_from_quaternion([msg.x, msg.y, msg.z, msg.w])[2] > 3.2:
        pub.publish(Float64(1.0))
"""


@pytest.mark.parametrize(
    "name, expected",
    [
        ("by_numbers", {(Reaction.HANDLED, None): True}),
        ("by_message", {(Reaction.CRASH, CrashKind.EXCEPTION): True}),
        ("beyond_half_a_turn", {(Reaction.IGNORED, None): True}),
    ],
)
def test_rotations(tmp_path, name, expected):
    _, seen = explore_text(TURNED, name, "geometry_msgs/Quaternion", tmp_path)
    assert seen == expected


MOMENTS = """
from rclpy.node import Node
from rclpy.time import Time
from rclpy.duration import Duration


class Driver(Node):
    def __init__(self):
        super().__init__("driver")

    def of_time(self, msg):
        moment = Time.from_msg(msg.stamp)
        self.get_logger().info(f"{(self.get_clock().now() - moment).nanoseconds}")

    def of_duration(self, msg):
        self.get_logger().info(f"{Duration.from_msg(msg.stamp).nanoseconds}")
"""


@pytest.mark.parametrize(
    "name, expected",
    [
        ("of_time", {(Reaction.CRASH, CrashKind.EXCEPTION): True, (Reaction.LOG_ONLY, None): True}),
        ("of_duration", {(Reaction.LOG_ONLY, None): True}),
    ],
)
def test_moments_of_messages(tmp_path, name, expected):
    _, seen = explore_text(MOMENTS, f"Driver.{name}", "lamp_msgs/Stamped", tmp_path, ros=2)
    assert seen == expected


ROSPY_SERVICE = """
import rospy
from std_msgs.msg import Int32
from lamp_srvs.srv import Switch, SwitchResponse


class Driver(object):
    def __init__(self):
        self.pub = rospy.Publisher("out", Int32, queue_size=1)
        rospy.Service("switch", Switch, self.on_switch)

    def on_switch(self, request):
        if request.level > 200:
            return None
        if request.level > 100:
            self.pub.publish(Int32(request.level))
        return SwitchResponse(success=True, share=1 / request.level)
"""
RCLPY_SERVICE = """
from rclpy.node import Node
from lamp_srvs.srv import Switch


class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.create_service(Switch, "switch", self.on_switch)

    def on_switch(self, request, response):
        response.share = 1 / request.level
        other = Switch.Response(success=request.level > 7)
        response.success = other.success
        return response
"""


@pytest.mark.parametrize(
    "text, ros, others, sent",
    [(ROSPY_SERVICE, 1, {(Reaction.IGNORED, None)}, {"pub"}), (RCLPY_SERVICE, 2, set(), set())],
)
def test_services(tmp_path, text, ros, others, sent):
    found, seen = explore_text(text, "Driver.on_switch", "lamp_srvs/Switch", tmp_path, ros=ros, kind="service")
    assert set(seen) == {(Reaction.HANDLED, None), (Reaction.CRASH, CrashKind.DIVISION)} | others
    assert set(seen.values()) == {True}
    assert solve(found, Reaction.CRASH, "request.level") == {0}
    assert {one.publisher for path in found.paths for one in path.sent} == sent
    replies = [path for path in found.paths if ("reply", "response") in {(one.kind, one.name) for one in path.effects}]
    assert replies and all(path.result is Reaction.HANDLED for path in replies)


@pytest.mark.parametrize(
    "lines, beyond",
    [
        ("if len(msg.ranges) > 10: self.pub.publish(Int32(1))", ("ranges",)),
        ("self.pub.publish(Int32(len(msg.ranges[9:])))", ()),
        ("self.last = msg.ranges[5]", ("ranges",)),
        ("self.last = msg.ranges[3]", ("ranges",)),
        ("self.last = msg.ranges[1]", ()),
        ("for one in msg.ranges: self.pub.publish(Int32(1))", ()),
    ],
)
def test_larger_arrays_than_were_looked_at(tmp_path, lines, beyond):
    text = HEAD + f"    def callback(self, msg):\n        {lines}\n"
    found, _ = explore_text(text, "Driver.callback", "sensor_msgs/LaserScan", tmp_path)
    assert found.bounds.array == 3
    said = evaluate(found, {})
    assert said.beyond == beyond
    assert not beyond or all(one.ignored is None and one.unhandled is None for one in said.fields)


FILLED = """
import rospy
from std_msgs.msg import Int32


class Driver(object):
    def __init__(self):
        self.pub = rospy.Publisher("out", Int32, queue_size=1)
        self.commands, self.fixed, self.table = [], [], {}
        for name in self.read_names():
            self.commands.append(name)
        for name in rospy.get_published_topics():
            self.keep(self.table, name)
            print(len(self.fixed))
        found = {}
        for name in rospy.get_published_topics():
            self.keep(found, name)
        self.found = found

    def keep(self, table, name):
        table[name] = 1

    def read_names(self):
        names = []
        for name in rospy.get_published_topics():
            names.append(name)
        return names

    def on_commands(self, msg):
        for one in self.commands:
            self.pub.publish(msg)

    def on_table(self, msg):
        for one in self.table:
            self.pub.publish(msg)

    def on_found(self, msg):
        for one in self.found:
            self.pub.publish(msg)

    def on_fixed(self, msg):
        for one in self.fixed:
            self.pub.publish(msg)
"""


@pytest.mark.parametrize(
    "name, expected",
    [("commands", Reaction.UNKNOWN), ("table", Reaction.UNKNOWN), ("found", Reaction.UNKNOWN),
     ("fixed", Reaction.IGNORED)],
)  # fmt: skip
def test_lists_that_are_filled_while_the_node_is_made(tmp_path, name, expected):
    found, _ = explore_text(FILLED, f"Driver.on_{name}", "std_msgs/Int32", tmp_path)
    assert {path.result for path in found.paths} == {expected}
