"""How many bytes messages take: counted, and as serialisers write them."""

import json
import os
import subprocess
from textwrap import dedent

import pytest
from hypothesis import given, settings
from messages_drawn import drawn_messages, fill_message, parse_sections
from rosimpact.impact.model.wire import LayoutError, build_layout, compute_size

NUMPY = {"bool": "bool_", "char": "uint8", "byte": "uint8"}


def measure(text, lengths=None, encoding="cdr", others=None):
    sections = parse_sections({**(others or {}), "p/M": dedent(text)})
    return compute_size(build_layout(sections.get, "p/M", encoding), lengths or {}, encoding)


POINT = {"p/Point": "float64 x\nfloat64 y\nfloat64 z\n"}
CASES = [
    # text, lengths, bytes in ROS 1, bytes in CDR
    ("uint8 a\n", {}, 1, 4 + 1),
    ("uint8 a\nfloat64 b\n", {}, 9, 4 + 16),
    ("uint8 a\nfloat64[2] b\nuint16 c\n", {}, 19, 4 + 26),
    ("uint8 a\nfloat64[] b\n", {"b": 0}, 5, 4 + 8),
    ("uint8 a\nfloat64[] b\n", {"b": 2}, 21, 4 + 24),
    ("uint8[] a\n", {"a": 1_000_000}, 1_000_004, 4 + 1_000_004),
    ("string a\n", {"a": 5}, 9, 4 + 10),
    ("string a\nuint16 b\n", {"a": 4}, 10, 4 + 12),
    ("string[] a\n", {"a": 3, "a[]": 1}, 4 + 3 * 5, 4 + 4 + 8 + 8 + 6),
    ("string[2] a\n", {"a[]": 2}, 12, 4 + 8 + 7),
    ("Point[] a\n", {"a": 2}, 52, 4 + 8 + 48),
    ("Point[] a\n", {"a": 0}, 4, 4 + 4),
    ("Point a\nPoint b\n", {}, 48, 4 + 48),
    ("Empty a\nuint8 b\n", {}, 1, 4 + 2),
    ("builtin_interfaces/Time a\n", {}, 8, 4 + 8),
    ("Named[] a\n", {"a": 1_000_001, "a[].name": 1}, 4 + 6 * 1_000_001, 4 + 4 + 8 * 1_000_001 - 1),
    ("bool a\nbyte b\nchar c\nint8 d\nfloat32 e\nint64 f\n", {}, 16, 4 + 16),
]


@pytest.mark.parametrize(("text", "lengths", "ros1", "cdr"), CASES)
def test_counted(text, lengths, ros1, cdr):
    others = POINT | {"p/Empty": "uint8 ONLY=1\n", "p/Named": "string name\nbool b\n"}
    assert measure(text, lengths, "ros1", others) == ros1
    assert measure(text, lengths, "cdr", others) == cdr


def test_times_of_ros_1():
    assert measure("time a\nduration[] b\n", {"b": 3}, "ros1") == 8 + 4 + 24
    assert measure("time a\nduration[] b\n", {"b": 3}, "cdr") == 4 + 8 + 4 + 24
    header = {"std_msgs/Header": "uint32 seq\ntime stamp\nstring frame_id\n"}
    assert measure("Header header\n", {"header.frame_id": 3}, "ros1", header) == 19


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("wstring a\n", "`a` is a wstring"),
        ("Gone[] a\n", "the definition of p/Gone is not known"),
        ("M[] a\n", "p/M holds itself"),
        ("int8[99999999999999999999] a\n", "`a` has 999999999999... elements"),
        ("B0 a\n", "more than 20,000 fields"),
        ("D0 a\n", "more than 50 levels"),
    ],
)
def test_what_has_no_size(text, expected):
    bomb = {f"p/B{n}": f"B{n + 1} a\nB{n + 1} b\n" for n in range(40)} | {"p/B40": "int8 a\n"}
    deep = {f"p/D{n}": f"D{n + 1} a\n" for n in range(60)} | {"p/D60": "int8 a\n"}
    with pytest.raises(LayoutError, match=expected):
        measure(text, {}, "cdr", bomb | deep)


@given(drawn_messages())
@settings(max_examples=150)
def test_the_size_is_that_of_rosbags(drawn):
    typesys = pytest.importorskip("rosbags.typesys")
    numpy = pytest.importorskip("numpy")
    texts, full, lengths = drawn
    store = typesys.get_typestore(typesys.Stores.EMPTY)
    for name, text in texts.items():
        store.register(typesys.get_types_from_msg(text, name.replace("/", "/msg/")))

    def make(type_, value):
        if isinstance(value, dict):
            # A message without fields is given its byte.
            return store.types[type_.replace("/", "/msg/")](**value)
        plain = type_.removesuffix("[]")
        if plain == type_:
            return {"bool": bool, "float32": float, "float64": float}.get(plain, int)(value)
        known = plain in ("bool", "byte", "char") or plain.startswith(("int", "uint", "float"))
        return numpy.array(value, getattr(numpy, NUMPY.get(plain, plain))) if known else value

    message = fill_message(texts, full, lengths, make)
    sections = parse_sections(texts)
    name = full.replace("/", "/msg/")
    for encoding, data in (("cdr", store.serialize_cdr(message, name)), ("ros1", store.serialize_ros1(message, name))):
        layout = build_layout(sections.get, full, encoding)
        assert compute_size(layout, lengths, encoding) == len(data), (encoding, texts, lengths)


GENPY = """
import io, json, sys
import genpy.dynamic
for case in json.load(sys.stdin):
    classes = genpy.dynamic.generate_dynamic(case["full"], case["text"])
    def make(value):
        if isinstance(value, list):
            return [make(one) for one in value]
        if not isinstance(value, dict):
            return value
        if value["type"] in ("time", "duration"):
            return (genpy.Time if value["type"] == "time" else genpy.Duration)(1, 2)
        return classes[value["type"]](**{name: make(one) for name, one in value["values"].items()})
    out = io.BytesIO()
    make(case["message"]).serialize(out)
    print(len(out.getvalue()))
"""


def run_genpy(cases):
    """Sizes as ROS 1's own serialiser writes them; Debian's, which the system's Python has."""
    command = ["/usr/bin/python3", "-c", GENPY]
    if subprocess.run([*command[:2], "import genpy.dynamic"], capture_output=True).returncode:
        pytest.skip("python3-genpy is not installed")
    found = subprocess.run(command, input=json.dumps(cases), capture_output=True, text=True, env=os.environ)
    assert found.returncode == 0, found.stderr
    return [int(line) for line in found.stdout.split()]


def test_the_size_is_that_of_ros_1():
    cases, sizes = [], []

    @given(drawn_messages(times=("time", "duration"), bounded=False))
    @settings(max_examples=60, database=None)
    def collect(drawn):
        texts, full, lengths = drawn

        def make(type_, value):
            if isinstance(value, dict):
                return {"type": type_, "values": value}
            return {"type": type_} if type_ in ("time", "duration") else value

        rule = "=" * 80
        others = "".join(f"\n{rule}\nMSG: {name}\n{text}" for name, text in texts.items() if name != full)
        message = fill_message(texts, full, lengths, make)
        cases.append({"full": full, "text": f"{texts[full]}{others}\n", "message": message})
        layout = build_layout(parse_sections(texts).get, full, "ros1")
        sizes.append(compute_size(layout, lengths, "ros1"))

    collect()
    assert run_genpy(cases) == sizes
    assert len(set(sizes)) > 10
