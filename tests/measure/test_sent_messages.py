"""Schemas of what is sent, and its bytes: against rosbags, which was written by others."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosimpact.edges.console import UserError
from rosimpact.impact.facts import interface
from rosimpact.impact.measure.messages import (
    SentField,
    SentSchema,
    decode,
    encode,
    fill,
    list_lengths,
    make_schema,
    make_synthetic,
)

BEAM = "float64 angle\nstring[] names\ntime at\n"
SWEEP = """uint8 KIND=1
Header header
float32[] ranges
Beam[] beams
Beam[2] ends
string<=40 note
duration took
byte flags
char[4] code
bool[] valid
geometry_msgs/Point origin
time[] times
"""
TEXTS = {
    "a_msgs/Sweep": SWEEP,
    "a_msgs/Beam": BEAM,
    "std_msgs/Header": "uint32 seq\ntime stamp\nstring frame_id\n",
    "geometry_msgs/Point": "float64 x\nfloat64 y\nfloat64 z\n",
}


def find(name, texts=TEXTS):
    return interface.extract(texts[name].encode(), "msg") if name in texts else None


def schema_of(**texts):
    own = {f"a_msgs/{name}": text for name, text in texts.items()}
    return make_schema("a_msgs/A", lambda name: find(name, {**TEXTS, **own}))


def test_a_schema_is_flat_and_names_its_own_types_alone():
    schema = make_schema("a_msgs/Sweep", find)
    texts = schema.render_definitions()
    assert set(texts) == {"a_msgs__Sweep", "a_msgs__Beam", "std_msgs__Header", "geometry_msgs__Point", "Sample"}
    assert texts["Sample"] == "uint64 number\nint64 sent\nuint32 publisher\na_msgs__Sweep content\n"
    assert texts["a_msgs__Sweep"].splitlines()[:6] == [
        *("std_msgs__Header header", "float32[] ranges", "a_msgs__Beam[] beams", "a_msgs__Beam[2] ends"),
        *("string note", "duration took"),
    ]


def test_bytes_are_those_that_rosbags_writes():
    store = get_typestore(Stores.ROS1_NOETIC)
    store.register(get_types_from_msg(BEAM, "a_msgs/msg/Beam"))
    store.register(get_types_from_msg(SWEEP.replace("<=40", ""), "a_msgs/msg/Sweep"))
    types = store.types
    moment, span = types["builtin_interfaces/msg/Time"], types["builtin_interfaces/msg/Duration"]
    beam = types["a_msgs/msg/Beam"](0.5, ["left", "höher"], moment(5, 6))
    message = types["a_msgs/msg/Sweep"](
        header=types["std_msgs/msg/Header"](7, moment(1, 2), "map"),
        ranges=np.arange(3, dtype=np.float32), beams=[beam], ends=[beam, beam], note="x", took=span(-1, 9), flags=-3,
        code=np.array([1, 2, 3, 255], dtype=np.uint8), valid=np.array([True, False]),
        origin=types["geometry_msgs/msg/Point"](1.0, -2.0, 3.5), times=[moment(3, 4)],
    )  # fmt: skip
    data = bytes(store.serialize_ros1(message, "a_msgs/msg/Sweep"))
    schema = make_schema("a_msgs/Sweep", find)
    assert encode(schema, message) == data
    assert encode(schema, decode(schema, data)) == data


def test_a_part_of_a_message_is_taken_by_the_names_of_its_fields():
    whole = schema_of(A="uint16 first\nstring second\nint8[2] third")
    part = schema_of(A="int8[2] third\nuint16 first")
    value = decode(whole, encode(whole, {"first": 513, "second": "gone", "third": [1, -1]}))
    assert encode(part, value) == b"\x01\xff\x01\x02"


@pytest.mark.parametrize(
    ("text", "lengths", "data"),
    [
        ("string a", {"a": 3}, b"\3\0\0\0xxx"),
        ("uint16[] a", {"a": 2}, b"\2\0\0\0" + bytes(4)),
        ("string[] a", {"a": 2, "a[]": 1}, b"\2\0\0\0" + 2 * b"\1\0\0\0x"),
        ("string[2] a", {"a[]": 1}, 2 * b"\1\0\0\0x"),
        ("B[] a", {"a": 2, "a[].b": 1}, b"\2\0\0\0" + 2 * b"\1\0\0\0x"),
        ("B a", {"a.b": 1}, b"\1\0\0\0x"),
        ("time[] a", {"a": 1}, b"\1\0\0\0" + bytes(8)),
        ("float32[3] a", {}, bytes(12)),
        ("", {}, b""),
    ],
)
def test_filling_with_lengths(text, lengths, data):
    schema = schema_of(A=text, B="string b")
    assert set(lengths) <= set(list_lengths(schema))
    assert encode(schema, fill(schema, lengths)) == data


def test_the_synthetic_message_is_as_long_as_the_study_has_it():
    schema = make_synthetic(25)
    assert len(encode(schema, fill(schema, 1000))) == 25 * 1004


@pytest.mark.parametrize(
    ("texts", "said"),
    [
        ({"A": "B b", "B": "A a"}, "contains itself"),
        ({"A": "other_msgs/C c"}, "other_msgs/C (in a_msgs/A): no definition is known"),
        ({"A": "float128 f"}, "float128"),
        ({"A": "int32 a b; system()"}, ""),
        ({"A": "int32 a\n?!"}, "line 2: "),
    ],
)
def test_what_cannot_be_sent(texts, said):
    if not said:  # a default: only names and types are taken over
        assert schema_of(**texts).render_definitions()["a_msgs__A"] == "int32 a\n"
        return
    with pytest.raises(UserError) as error:
        schema_of(**texts)
    assert said in str(error.value)


@pytest.mark.parametrize("data", [b"", b"\1\0", b"\2\0\0\0a", b"\1\0\0\0ab"])
def test_bytes_of_another_message_are_refused(data):
    with pytest.raises(ValueError, match="bytes"):
        decode(schema_of(A="string a"), data)


PRIMITIVES = ("bool", "int8", "uint16", "int64", "float32", "string", "time", "duration")


@given(st.data())
def test_every_message_comes_back_from_its_bytes(data):
    draw = data.draw
    count = draw(st.integers(1, 3))
    names = [f"M{number}" for number in range(count)]
    messages = {}
    for number, name in enumerate(names):
        kinds = st.sampled_from((*PRIMITIVES, *names[number + 1 :]))
        drawn = draw(st.lists(st.tuples(kinds, st.integers(-1, 3)), max_size=4))
        messages[name] = tuple(SentField(f"f{place}", *each) for place, each in enumerate(drawn))
    schema = SentSchema("M0", messages)
    lengths = {path: draw(st.integers(0, 3)) for path in sorted(set(list_lengths(schema)))}
    written = encode(schema, fill(schema, lengths))
    assert encode(schema, decode(schema, written)) == written
