"""Witnesses for people and later runs: files that are replayed, messages as YAML, regression tests.

A file of witnesses is JSON, with a schema number; it is read within limits, and nothing of it is executed.
"""

from __future__ import annotations

import json
import math
import re
import struct
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, Protocol

from ...edges.documents import DocumentError, load_json
from ..facts.interface import PRIMITIVES, TIMES, Field, Interface, make_full_name
from ..model.flow.definitions import make_key
from ..targets.surface.fields import make_snake_case
from .field_types import find_integer
from .ir.terms import read_signed
from .outcomes import CodeLine, CrashKind, Reaction, Witness

SCHEMA = 1
_FIXED = re.compile(r"\[([0-9]+)\]")
_ARRAY_AT_MOST = 10_000
_FLOATS = {"float32": ("<f", 4), "float64": ("<d", 8)}
_WIDE_CHARACTER = 0xFFFF


class WitnessError(ValueError):
    """A file of witnesses cannot be read; the text is a clause that says why."""


class FindInterface(Protocol):
    """Gives the interface `package/msg/Name`, None where it is not known; ros is its generation."""

    ros: int

    def find(self, key: str) -> Interface | None: ...


class WitnessRecord(NamedTuple):
    """A witness with the callback that it is for. kind: `subscriber`, `service`, `timer` or `action`."""

    kind: str
    node: str
    topic: str
    callback: str
    message_type: str
    path: str
    line: int
    witness: Witness
    language: str = "cpp"


# Files


def format_witnesses(records: Sequence[WitnessRecord]) -> str:
    """A file of witnesses."""
    rows = [
        {
            "kind": one.kind, "node": one.node, "topic": one.topic, "callback": one.callback,
            "message_type": one.message_type, "path": one.path, "line": one.line, "language": one.language,
            "result": one.witness.result.value,
            "crash": one.witness.crash.value if one.witness.crash is not None else None,
            "place": {"path": one.witness.place.path, "line": one.witness.place.line},
            "values": dict(sorted(one.witness.values.items())),
        }
        for one in records
    ]  # fmt: skip
    return json.dumps({"schema": SCHEMA, "witnesses": rows}, indent=1) + "\n"


def parse_witnesses(text: str) -> list[WitnessRecord]:
    """The witnesses of a file. Raises WitnessError."""
    try:
        found = load_json(text)
    except DocumentError as error:
        raise WitnessError(f"is no JSON: {error}") from None
    if not isinstance(found, dict) or found.get("schema") != SCHEMA:
        raise WitnessError(f"is no file of witnesses of schema {SCHEMA}; write it anew with `rosimpact values`")
    rows = found.get("witnesses")
    if not isinstance(rows, list):
        raise WitnessError("has no `witnesses`")
    try:
        return [_parse_row(row) for row in rows]
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise WitnessError(f"has a witness that lacks something: {error}") from None


def _parse_row(row: dict[str, Any]) -> WitnessRecord:
    values = {}
    for path, bits in row["values"].items():
        if not isinstance(bits, int) or isinstance(bits, bool) or not 0 <= bits < 2**64 or "\n" in path or "=" in path:
            raise ValueError(f"`{path}` has no number of at most 64 bits")
        values[path] = bits
    crash = CrashKind(row["crash"]) if row["crash"] is not None else None
    place = CodeLine(_check_text(row["place"]["path"]), int(row["place"]["line"]))
    kind, node, topic, callback, message_type, path = (
        _check_text(row[key]) for key in ("kind", "node", "topic", "callback", "message_type", "path")
    )
    witness = Witness(values, Reaction(row["result"]), crash, place)
    language = _check_text(row.get("language", "cpp"))
    return WitnessRecord(kind, node, topic, callback, message_type, path, int(row["line"]), witness, language)


def _check_text(text: object) -> str:
    if not isinstance(text, str):
        raise ValueError("a text is expected")
    return text


# Messages


def build_message(
    interfaces: FindInterface, message_type: str, values: Mapping[str, int], root: str = "msg"
) -> dict[str, Any]:
    """A message `package/Name` as dictionaries, lists, numbers and texts, from the bits of its fields by path; fields
    without bits are zero. root: what the paths begin with; for a service `request`."""
    folder = "srv" if root == "request" else "action" if root == "goal" else "msg"
    package, _, name = message_type.partition("/")
    interface = interfaces.find(f"{package}/{folder}/{name}")
    return _build(interfaces, interface, package, values, root, 0)


def _build(
    interfaces: FindInterface,
    interface: Interface | None,
    package: str,
    values: Mapping[str, int],
    path: str,
    depth: int,
) -> dict[str, Any]:
    if interface is None or not interface.sections or depth > 12:
        return {}
    return {
        field.name: _build_field(interfaces, field, package, values, f"{path}.{field.name}", depth)
        for field in interface.sections[0].fields
    }


def _build_field(
    interfaces: FindInterface, field: Field, package: str, values: Mapping[str, int], path: str, depth: int
) -> Any:
    plain = field.type.partition("<=")[0]
    if not field.array:
        return _build_one(interfaces, plain, package, values, path, depth)
    fixed = _FIXED.fullmatch(field.array)
    count = int(fixed[1]) if fixed is not None else values.get(f"{path}.size", 0)
    return [
        _build_one(interfaces, plain, package, values, f"{path}[{at}]", depth)
        for at in range(min(count, _ARRAY_AT_MOST))
    ]


def _build_one(
    interfaces: FindInterface, plain: str, package: str, values: Mapping[str, int], path: str, depth: int
) -> Any:
    bits = values.get(path, 0)
    if plain in _FLOATS:
        form, size = _FLOATS[plain]
        return struct.unpack(form, (bits & (256**size - 1)).to_bytes(size, "little"))[0]
    if plain == "bool":
        return bool(bits & 1)
    if plain == "wchar":
        return bits & _WIDE_CHARACTER
    if (number := find_integer(plain, interfaces.ros)) is not None:
        bits &= 2**number.bits - 1
        return read_signed(bits, number.bits) if number.is_signed else bits
    if plain in ("string", "wstring"):
        size = min(values.get(f"{path}.size", 0), _ARRAY_AT_MOST)
        if plain == "wstring":
            return "".join(chr(values.get(f"{path}[{at}]", 0) & 0xFFFF) for at in range(size))
        return bytes(values.get(f"{path}[{at}]", 0) & 255 for at in range(size)).decode("latin-1")
    if plain in TIMES and interfaces.ros == 1:
        names, is_signed = ("secs", "nsecs"), plain == "duration"
        parts = [values.get(f"{path}.{part}", 0) & 0xFFFFFFFF for part in ("sec", "nsec")]
        return {n: p - 2**32 if is_signed and p >> 31 else p for n, p in zip(names, parts, strict=True)}
    if plain in PRIMITIVES:
        return 0
    full = make_full_name(plain, package)
    interface = interfaces.find(make_key("topic", full))
    return _build(interfaces, interface, full.partition("/")[0], values, path, depth + 1)


def format_yaml(value: Any) -> str:
    """A message as YAML in one line, as `rostopic pub` and `ros2 topic pub` read it."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {format_yaml(each)}" for key, each in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(format_yaml(each) for each in value) + "]"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        if math.isnan(value):
            return ".nan"
        if math.isinf(value):
            return ".inf" if value > 0 else "-.inf"
        text = repr(value)
        return text.replace("e", ".0e") if "e" in text and "." not in text else text
    if isinstance(value, str):
        shown = "".join(
            f"\\{c}"
            if c in '"\\'
            else c
            if " " <= c <= "~"
            else f"\\x{ord(c):02x}"
            if ord(c) < 256
            else f"\\u{ord(c):04x}"
            for c in value
        )
        return f'"{shown}"'
    return str(value)


def format_publish_command(interfaces: FindInterface, record: WitnessRecord) -> str:
    """The command line that sends a witness to a running node; empty for a timer."""
    package, _, name = record.message_type.partition("/")
    if record.kind not in ("subscriber", "service") or not name:
        return ""
    root = "request" if record.kind == "service" else "msg"
    text = format_yaml(build_message(interfaces, record.message_type, record.witness.values, root))
    quoted = "'" + text.replace("'", "'\\''") + "'"
    topic = record.topic or "/TOPIC"
    if record.kind == "service":
        head = "rosservice call" if interfaces.ros == 1 else "ros2 service call"
        type_ = "" if interfaces.ros == 1 else f" {package}/srv/{name}"
        return f"{head} {topic}{type_} {quoted}"
    if interfaces.ros == 1:
        return f"rostopic pub -1 {topic} {record.message_type} {quoted}"
    return f"ros2 topic pub --once {topic} {package}/msg/{name} {quoted}"


# Tests


def write_tests(interfaces: FindInterface, records: Sequence[WitnessRecord]) -> dict[str, str]:
    """Regression tests for witnesses, by file name: pytest for callbacks in Python, gtest for those in C++."""
    found: dict[str, str] = {}
    python = [one for one in records if one.language == "python" and one.kind == "subscriber"]
    cpp = [one for one in records if one.language == "cpp" and one.kind == "subscriber"]
    if python:
        found["test_witnesses.py"] = _write_pytest(interfaces, python)
    if cpp:
        found["test_witnesses.cpp"] = _write_gtest(interfaces, cpp)
    return found


def _name_test(record: WitnessRecord, number: int) -> str:
    return f"{re.sub(r'[^A-Za-z0-9]+', '_', record.callback).strip('_') or 'callback'}_{number}"


def _describe_witness(record: WitnessRecord) -> str:
    what = record.witness.crash.value if record.witness.crash is not None else record.witness.result.value
    place = record.witness.place
    return f"{what} at {place.path}:{place.line}" if place.path else what


def _write_pytest(interfaces: FindInterface, records: Sequence[WitnessRecord]) -> str:
    lines = [
        '"""Messages that callbacks once could not handle; written by rosimpact."""', "", "import importlib",
        "from unittest.mock import MagicMock", "", "import pytest", "", "",
        "def make(module, name, values):", '    """A message from dictionaries."""',
        "    message = getattr(importlib.import_module(module), name)()", "    fill(message, values)",
        "    return message", "", "",
        "def fill(message, values):", "    for key, value in values.items():",
        "        if isinstance(value, dict):", "            fill(getattr(message, key), value)",
        "        else:", "            setattr(message, key, value)", "",
    ]  # fmt: skip
    for number, one in enumerate(records):
        package, _, name = one.message_type.partition("/")
        module = one.path.removesuffix(".py").rpartition("/src/")[2].replace("/", ".")
        owner, _, function = one.callback.rpartition(".")
        values = build_message(interfaces, one.message_type, one.witness.values)
        call = f"target.{owner}.{function}(MagicMock(), message)" if owner else f"target.{function}(message)"
        lines += [
            "", f"def test_{_name_test(one, number)}():", f'    """{_describe_witness(one)}"""',
            f"    target = pytest.importorskip({module!r})",
            f"    message = make({package + '.msg'!r}, {name!r}, {_format_python(values)})", f"    {call}", "",
        ]  # fmt: skip
    return "\n".join(lines)


def _format_python(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key!r}: {_format_python(each)}" for key, each in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(_format_python(each) for each in value) + "]"
    if isinstance(value, float) and not math.isfinite(value):
        return f"float({str(value)!r})"
    return repr(value)


def _write_gtest(interfaces: FindInterface, records: Sequence[WitnessRecord]) -> str:
    """A test that sends each witness to the node under test, which has to be there still afterwards."""
    ros2 = interfaces.ros == 2
    headers = dict.fromkeys(
        f"{p}/msg/{make_snake_case(n)}.hpp" if ros2 else f"{p}/{n}.h"
        for p, _, n in (one.message_type.partition("/") for one in records)
    )
    lines = ["// Messages that callbacks once could not handle; written by rosimpact.",
             "// Start the node under test beside it, as launch_testing and rostest do.",
             "#include <array>", "#include <chrono>", "#include <limits>", "#include <thread>",
             "#include <gtest/gtest.h>",
             "#include <rclcpp/rclcpp.hpp>" if ros2 else "#include <ros/ros.h>",
             *(f"#include <{each}>" for each in headers), "",
             "template <class T>", "auto resize_array(T & array, size_t size) -> decltype(array.resize(size))",
             "{", "  array.resize(size);", "}",
             "template <class T, size_t N> void resize_array(std::array<T, N> &, size_t) {}",
             *([] if ros2 else ["template <class T, size_t N> void resize_array(boost::array<T, N> &, size_t) {}"]),
             ""]  # fmt: skip
    for number, one in enumerate(records):
        package, _, name = one.message_type.partition("/")
        type_ = f"{package}::msg::{name}" if ros2 else f"{package}::{name}"
        values = build_message(interfaces, one.message_type, one.witness.values)
        lines += [f"// {_describe_witness(one)}", f"TEST(Witnesses, {_name_test(one, number)})", "{"]
        lines += [f"  {type_} message;", *(f"  {each}" for each in _assign("message", values, ros2))]
        lines += _send_ros2(one, type_) if ros2 else _send_ros1(one, type_)
        lines += ["}", ""]
    end = "rclcpp::init(argc, argv);" if ros2 else 'ros::init(argc, argv, "test_witnesses");'
    lines += ["int main(int argc, char ** argv)", "{", "  testing::InitGoogleTest(&argc, argv);", f"  {end}",
              "  return RUN_ALL_TESTS();", "}", ""]  # fmt: skip
    return "\n".join(lines)


def _assign(target: str, value: Any, ros2: bool) -> list[str]:
    if isinstance(value, dict):
        names = {"secs": "sec", "nsecs": "nsec"} if not ros2 and set(value) == {"secs", "nsecs"} else {}
        return [line for key, each in value.items() for line in _assign(f"{target}.{names.get(key, key)}", each, ros2)]
    if isinstance(value, list):
        rows = [line for at, each in enumerate(value) for line in _assign(f"{target}[{at}]", each, ros2)]
        return [f"resize_array({target}, {len(value)});", *rows] if value else []
    if isinstance(value, bool):
        return [f"{target} = true;"] if value else []
    if isinstance(value, float):
        if math.isnan(value):
            return [f"{target} = std::numeric_limits<double>::quiet_NaN();"]
        if math.isinf(value):
            return [f"{target} = {'-' if value < 0 else ''}std::numeric_limits<double>::infinity();"]
        return [f"{target} = {value!r};"] if value else []
    if isinstance(value, str):
        shown = "".join(f"\\{ord(c) & 255:03o}" if c in '"\\?' or not " " <= c <= "~" else c for c in value)
        return [f'{target}.assign("{shown}", {len(value)});'] if value else []
    return (
        [f"{target} = static_cast<decltype({target})>({value}{'ULL' if value > 2**63 - 1 else 'LL'});"] if value else []
    )


def _send_ros2(record: WitnessRecord, type_: str) -> list[str]:
    return [
        '  auto node = std::make_shared<rclcpp::Node>("test_witnesses");',
        f'  auto publisher = node->create_publisher<{type_}>("{record.topic}", 10);',
        "  for (int turn = 0; turn < 100 && publisher->get_subscription_count() == 0; ++turn)",
        "    std::this_thread::sleep_for(std::chrono::milliseconds(100));",
        "  ASSERT_GT(publisher->get_subscription_count(), 0u);", "  publisher->publish(message);",
        "  std::this_thread::sleep_for(std::chrono::seconds(2));",
        "  EXPECT_GT(publisher->get_subscription_count(), 0u);",
    ]  # fmt: skip


def _send_ros1(record: WitnessRecord, type_: str) -> list[str]:
    return [
        "  ros::NodeHandle node;", f'  ros::Publisher publisher = node.advertise<{type_}>("{record.topic}", 10);',
        "  for (int turn = 0; turn < 100 && publisher.getNumSubscribers() == 0; ++turn)",
        "    ros::WallDuration(0.1).sleep();",
        "  ASSERT_GT(publisher.getNumSubscribers(), 0u);", "  publisher.publish(message);",
        "  ros::WallDuration(2.0).sleep();", "  EXPECT_GT(publisher.getNumSubscribers(), 0u);",
    ]  # fmt: skip
