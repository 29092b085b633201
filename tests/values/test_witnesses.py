"""Files of witnesses, and what is made of them for people and for tests."""

import struct

import pytest
from rosimpact.impact.facts.interface import extract
from rosimpact.impact.values.field_types import find_integer
from rosimpact.impact.values.outcomes import CodeLine, CrashKind, Reaction, Witness
from rosimpact.impact.values.witnesses import (
    WitnessError,
    WitnessRecord,
    build_message,
    format_publish_command,
    format_witnesses,
    format_yaml,
    parse_witnesses,
    write_tests,
)

TEXTS = {
    "own/msg/Wheel": "float64 speed\nuint8[] pins\nstring name\nbool on\nint8 trim\n",
    "own/msg/Car": "Wheel[2] wheels\nfloat32 fuel\nstring[] tags\n",
    "own/msg/Stamped": "Header header\nduration span\n",
    "std_msgs/msg/Header": "uint32 seq\ntime stamp\nstring frame_id\n",
    "own/srv/Ask": "string question\n---\nint32 answer\n",
}


class Interfaces:
    def __init__(self, ros):
        self.ros = ros

    def find(self, key):
        return extract(TEXTS[key].encode(), key.split("/")[1]) if key in TEXTS else None


def bits(value, form="<d"):
    return int.from_bytes(struct.pack(form, value), "little")


VALUES = {
    "msg.wheels[1].speed": bits(float("nan")), "msg.wheels[1].pins.size": 2, "msg.wheels[1].pins[1]": 255,
    "msg.wheels[0].name.size": 3, "msg.wheels[0].name[0]": 97, "msg.wheels[0].name[1]": 0, "msg.wheels[0].name[2]": 34,
    "msg.wheels[0].trim": 255, "msg.wheels[0].on": 1, "msg.fuel": bits(0.5, "<f"), "this.gear_": 3,
}  # fmt: skip


def record(values=VALUES, type_="own/Car", kind="subscriber", **more):
    witness = Witness(values, Reaction.CRASH, CrashKind.INDEX, CodeLine("src/a.cpp", 7))
    return WitnessRecord(kind, "n", "/car", "ns::Node::on_car", type_, "src/a.cpp", 5, witness, **more)


def test_a_file_is_read_as_it_was_written():
    rows = [record(), record({}, language="python")]
    assert parse_witnesses(format_witnesses(rows)) == rows


@pytest.mark.parametrize(
    "text, why",
    [
        ("{", "is no JSON"),
        ("[]", "no file of witnesses"),
        ('{"schema": 2, "witnesses": []}', "no file of witnesses"),
        ('{"schema": 1}', "has no `witnesses`"),
        ('{"schema": 1, "witnesses": [{}]}', "lacks something"),
        ('{"schema": 1, "witnesses": [3]}', "lacks something"),
        (format_witnesses([record({"a": 2**64})]), "no number of at most 64 bits"),
        (format_witnesses([record({"a\nb": 1})]), "no number of at most 64 bits"),
        (format_witnesses([record()]).replace('"crash"', '"crunch"', 1), "lacks something"),
    ],
)
def test_a_damaged_file_is_refused(text, why):
    with pytest.raises(WitnessError, match=why):
        parse_witnesses(text)


def test_message_and_yaml():
    message = build_message(Interfaces(2), "own/Car", VALUES)
    first = {"speed": 0.0, "pins": [], "name": 'a\0"', "on": True, "trim": -1}
    assert message["wheels"][0] == first
    assert message["fuel"] == 0.5
    assert format_yaml(message) == (
        '{wheels: [{speed: 0.0, pins: [], name: "a\\x00\\"", on: true, trim: -1}, '
        '{speed: .nan, pins: [0, 255], name: "", on: false, trim: 0}], fuel: 0.5, tags: []}'
    )


@pytest.mark.parametrize(
    "value, text",
    [(float("inf"), ".inf"), (float("-inf"), "-.inf"), (1e300, "1.0e+300"), (1.5e-7, "1.5e-07"), (-3, "-3")],
)
def test_numbers_in_yaml(value, text):
    assert format_yaml(value) == text


def test_commands():
    values = {"msg.span.sec": 2**32 - 1, "msg.header.stamp.nsec": 5}
    one = record(values, "own/Stamped")
    assert format_publish_command(Interfaces(1), one) == (
        'rostopic pub -1 /car own/Stamped \'{header: {seq: 0, stamp: {secs: 0, nsecs: 5}, frame_id: ""}, '
        "span: {secs: -1, nsecs: 0}}'"
    )
    quoted = record({"request.question.size": 1, "request.question[0]": 39}, "own/Ask", "service")
    assert format_publish_command(Interfaces(2), quoted) == (
        "ros2 service call /car own/srv/Ask '{question: \"'\\''\"}'"
    )
    assert format_publish_command(Interfaces(2), record()).startswith(
        "ros2 topic pub --once /car own/msg/Car '{wheels: "
    )
    assert format_publish_command(Interfaces(2), record({}, "", "timer")) == ""


def test_gtest_of_both_generations():
    two = write_tests(Interfaces(2), [record()])["test_witnesses.cpp"]
    assert "#include <own/msg/car.hpp>" in two and "TEST(Witnesses, ns_Node_on_car_0)" in two
    assert "message.wheels[1].speed = std::numeric_limits<double>::quiet_NaN();" in two
    assert 'message.wheels[0].name.assign("a\\000\\042", 3);' in two
    assert "// index out of range at src/a.cpp:7" in two
    one = write_tests(Interfaces(1), [record()])["test_witnesses.cpp"]
    assert "#include <own/Car.h>" in one and "ros::init(argc, argv" in one


def test_pytest_is_python(tmp_path):
    made = record({"msg.fuel": bits(float("inf"), "<f")}, language="python")._replace(
        callback="Node.on_car", path="ws/src/pkg/node.py"
    )
    text = write_tests(Interfaces(2), [made])["test_witnesses.py"]
    compile(text, "test_witnesses.py", "exec")
    assert "target.Node.on_car(MagicMock(), message)" in text and "float('inf')" in text
    assert "importorskip('pkg.node')" in text


@pytest.mark.parametrize(
    "type_, ros, expected",
    [
        ("byte", 1, (8, True)), ("byte", 2, (8, False)), ("char", 1, (8, False)), ("char", 2, (8, False)),
        ("octet", 2, (8, False)), ("int16", 1, (16, True)), ("uint64", 2, (64, False)), ("bool", 1, None),
        ("float32", 2, None), ("own/Wheel", 2, None),
    ],
)  # fmt: skip
def test_whole_numbers_of_both_generations(type_, ros, expected):
    assert find_integer(type_, ros) == expected
