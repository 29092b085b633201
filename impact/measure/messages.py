"""Messages that are sent: their fields, down to primitive ones, and their bytes as ROS 1 puts them on the wire.

The measuring nodes know one package, `rosimpact_measure`, with one message, `Sample`: number, time and publisher, and
behind them what is measured. Types of other packages are copied into it under names of their own
(`geometry_msgs__Point`), so that no node needs the user's packages. ROS 1 has no padding: the bytes of a message are
those of its fields, one after the other (https://wiki.ros.org/roscpp/Overview/MessagesSerializationAndAdaptingTypes).
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

import msgspec
import numpy as np

from ...edges.console import UserError
from ..facts.interface import Interface, make_full_name

PACKAGE = "rosimpact_measure"
ROOT = "Sample"
CONTENT = "content"
_HEAD = (("number", "uint64"), ("sent", "int64"), ("publisher", "uint32"))
HEAD_BYTES = 20
# What a message of ROS 2 calls a type that ROS 1 has under another name, or not at all.
_ROS1_NAMES = {"octet": "uint8", "byte": "int8", "char": "uint8", "wchar": "uint16", "wstring": "string"}
_CODES = {
    "bool": "?", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4",
    "int64": "i8", "uint64": "u8", "float32": "f4", "float64": "f8",
}  # fmt: skip
# Two numbers of 32 bits each, seconds and nanoseconds.
_TIMES = ("time", "duration")
_TEXT_BYTES = 4
_DEPTH = 20


class WireField(msgspec.Struct, frozen=True, array_like=True):
    """A field of a message. type: a primitive one of ROS 1, or the name of another message of the schema. size: -1 for
    one value, 0 for an array of any length, else the length of the array."""

    name: str
    type: str
    size: int = -1


class WireSchema(msgspec.Struct, frozen=True):
    """Messages by name; the one that is measured is called `name`."""

    name: str
    messages: dict[str, tuple[WireField, ...]]

    def list_fields(self, name: str = "") -> tuple[WireField, ...]:
        """The fields of a message, of the measured one by default."""
        return self.messages[name or self.name]

    def render_definitions(self) -> dict[str, str]:
        """The text of each definition as `NAME.msg`, that of the sample included."""
        texts = {name: _render_fields(fields) for name, fields in self.messages.items()}
        texts[ROOT] = "".join(f"{type_} {name}\n" for name, type_ in _HEAD) + f"{self.name} {CONTENT}\n"
        return texts


def _render_fields(fields: Iterable[WireField]) -> str:
    brackets = {-1: "", 0: "[]"}
    return "".join(f"{each.type}{brackets.get(each.size, f'[{each.size}]')} {each.name}\n" for each in fields)


def make_synthetic(fields: int) -> WireSchema:
    """A message of so many strings."""
    return WireSchema("Blob", {"Blob": tuple(WireField(f"field_{number:03}", "string") for number in range(fields))})


def make_schema(type_: str, find: Callable[[str], Interface | None]) -> WireSchema:
    """The schema of a message `package/Name`. find: the definition of such a name, None when it is not known. Raises
    UserError."""
    messages: dict[str, tuple[WireField, ...]] = {}
    _add_message(type_, find, messages, (), type_)
    return WireSchema(_flatten_name(type_), messages)


def _add_message(
    type_: str, find: Callable[[str], Interface | None], messages: dict[str, Any], line: tuple[str, ...], asked: str
) -> None:
    if type_ in line or len(line) > _DEPTH:
        raise UserError(f"{asked}: `{type_}` contains itself; give another message")
    flat = _flatten_name(type_)
    if flat in messages:
        return
    if type_ in ("builtin_interfaces/Time", "builtin_interfaces/Duration"):
        seconds = WireField("sec", "int32"), WireField("nanosec", "uint32")
        messages[flat] = seconds
        return
    found = find(type_)
    if found is None:
        within = f" (in {' → '.join(line)})" if line else ""
        raise UserError(
            f"{type_}{within}: no definition is known; give the workspace that defines it, and write package/Type"
        )
    if found.problems:
        raise UserError(f"{type_}: line {found.problems[0].line}: {found.problems[0].message}; correct the definition")
    fields = []
    for field in found.sections[0].fields:
        plain = field.type.partition("<=")[0]
        plain = _ROS1_NAMES.get(plain, plain)
        if plain not in (*_CODES, *_TIMES, "string"):
            if plain == "float128":
                raise UserError(f"{type_}: `{field.name}` is a float128, which no node of ROS can send")
            nested = make_full_name(plain, type_.partition("/")[0])
            _add_message(nested, find, messages, (*line, type_), asked)
            plain = _flatten_name(nested)
        fields.append(WireField(field.name, plain, _parse_size(field.array)))
    messages[flat] = tuple(fields)


def _flatten_name(type_: str) -> str:
    return type_.replace("/msg/", "/").replace("/", "__")


def _parse_size(array: str) -> int:
    inside = array.strip("[]")
    if not array:
        return -1
    return int(inside) if inside.isdigit() else 0


def prune_schema(schema: WireSchema, keep: Iterable[str]) -> WireSchema:
    """The message with these fields alone, in their old order. keep: names, or paths such as `pose.position`. Raises
    UserError for one that is not there."""
    wanted: dict[str, set[str]] = {}
    for path in keep:
        head, _, rest = path.partition(".")
        wanted.setdefault(head, set()).add(rest)
    messages = dict(schema.messages)
    name = _prune_message(schema, schema.name, wanted, messages, "")
    used = set(_list_used(messages, name))
    return WireSchema(name, {each: fields for each, fields in messages.items() if each in used})


def _prune_message(
    schema: WireSchema, name: str, wanted: Mapping[str, set[str]], messages: dict[str, Any], above: str
) -> str:
    """Adds the pruned form of a message under a new name, which is returned."""
    known = [field.name for field in schema.messages.get(name, ())]
    missing = [each for each in wanted if each not in known]
    if missing:
        where = above.rstrip(".") or name.replace("__", "/")
        there = ", ".join(known) if known else "none"
        raise UserError(f"--keep: `{where}` has no field `{missing[0]}`; its fields are {there}")
    fields = []
    for field in schema.messages[name]:
        if field.name not in wanted:
            continue
        inner = wanted[field.name]
        if "" not in inner:
            deeper: dict[str, set[str]] = {}
            for path in inner:
                head, _, rest = path.partition(".")
                deeper.setdefault(head, set()).add(rest)
            field = WireField(
                field.name, _prune_message(schema, field.type, deeper, messages, f"{above}{field.name}."), field.size
            )
        fields.append(field)
    pruned = f"{name}__pruned{len(messages)}"
    messages[pruned] = tuple(fields)
    return pruned


def _list_used(messages: Mapping[str, tuple[WireField, ...]], name: str) -> Iterator[str]:
    yield name
    for field in messages[name]:
        if field.type in messages:
            yield from _list_used(messages, field.type)


def encode(schema: WireSchema, value: Any, name: str = "") -> bytes:
    """The bytes of a message. value: a mapping, or an object with the fields as attributes; fields that a mapping lacks
    are zero or empty."""
    parts: list[bytes] = []
    _encode_fields(schema, name or schema.name, value, parts)
    return b"".join(parts)


def _encode_fields(schema: WireSchema, name: str, value: Any, parts: list[bytes]) -> None:
    for field in schema.messages[name]:
        inner = value.get(field.name) if isinstance(value, Mapping) else getattr(value, field.name, None)
        if field.size < 0:
            _encode_values(schema, field.type, (inner,), parts)
            continue
        values = () if inner is None else inner
        count = len(values)
        if field.size == 0:
            parts.append(struct.pack("<I", count))
        elif count != field.size:
            values = [*values, *[None] * (field.size - count)][: field.size]
        _encode_values(schema, field.type, values, parts)


def _encode_values(schema: WireSchema, type_: str, values: Any, parts: list[bytes]) -> None:
    if type_ in _CODES:
        code = f"<{_CODES[type_]}" if _CODES[type_] != "?" else "?"
        if not isinstance(values, np.ndarray):
            values = [each or 0 for each in values] if not isinstance(values, (bytes, bytearray)) else list(values)
        parts.append(np.asarray(values).astype(code).tobytes())
        return
    for value in values:
        if type_ == "string":
            text = value.encode() if isinstance(value, str) else bytes(value or b"")
            parts += (struct.pack("<I", len(text)), text)
        elif type_ in _TIMES:
            signs = "<ii" if type_ == "duration" else "<II"
            parts.append(struct.pack(signs, getattr(value, "sec", 0), getattr(value, "nanosec", 0)))
        else:
            _encode_fields(schema, type_, {} if value is None else value, parts)


def decode(schema: WireSchema, data: bytes, name: str = "") -> dict[str, Any]:
    """The fields of a message from its bytes: numbers, texts as bytes, times as their bytes, arrays of numbers as numpy
    arrays, others as lists. Raises ValueError where the bytes are not those of such a message."""
    found, end = _decode_fields(schema, name or schema.name, data, 0)
    if end != len(data):
        raise ValueError(f"{len(data) - end} bytes are left over")
    return found


def _decode_fields(schema: WireSchema, name: str, data: bytes, at: int) -> tuple[dict[str, Any], int]:
    found: dict[str, Any] = {}
    for field in schema.messages[name]:
        count = 1 if field.size < 0 else field.size
        if field.size == 0:
            count, at = _decode_count(data, at)
        values, at = _decode_values(schema, field.type, count, data, at)
        found[field.name] = values[0] if field.size < 0 else values
    return found, at


def _decode_count(data: bytes, at: int) -> tuple[int, int]:
    if at + 4 > len(data):
        raise ValueError("the bytes end too early")
    return struct.unpack_from("<I", data, at)[0], at + 4


def _decode_values(schema: WireSchema, type_: str, count: int, data: bytes, at: int) -> tuple[Any, int]:
    if type_ in _CODES:
        code = np.dtype(_CODES[type_]).newbyteorder("<")
        if at + count * code.itemsize > len(data):
            raise ValueError("the bytes end too early")
        return np.frombuffer(data, code, count, at), at + count * code.itemsize
    values: list[Any] = []
    for _ in range(count):
        if type_ == "string":
            length, at = _decode_count(data, at)
            values.append(data[at : at + length])
            at += length
        elif type_ in _TIMES:
            values.append(_Moment(*struct.unpack_from("<ii" if type_ == "duration" else "<II", data, at)))
            at += 8
        else:
            value, at = _decode_fields(schema, type_, data, at)
            values.append(value)
        if at > len(data):
            raise ValueError("the bytes end too early")
    return values, at


class _Moment(msgspec.Struct, frozen=True):
    sec: int
    nanosec: int


def fill(schema: WireSchema, lengths: Mapping[str, int] | int, name: str = "", above: str = "") -> dict[str, Any]:
    """A value of a message: numbers are zero, texts and arrays have the lengths that are given by path (`ranges`,
    `header.frame_id`), or one for all texts; others are empty. Paths within arrays hold for each of their items."""
    found: dict[str, Any] = {}
    for field in schema.messages[name or schema.name]:
        path = f"{above}{field.name}"
        length = lengths if isinstance(lengths, int) else lengths.get(path, 0)
        if field.type in schema.messages:
            inner = fill(schema, lengths, field.type, f"{path}.")
            found[field.name] = inner if field.size < 0 else [inner] * (field.size or length)
        elif field.type == "string":
            text = b"x" * length
            found[field.name] = text if field.size < 0 else [text if field.size else b""] * (field.size or length)
        elif field.size == 0 and field.type in _CODES:
            found[field.name] = np.zeros(length, dtype=_CODES[field.type])
        elif field.size == 0:
            found[field.name] = [None] * length
    return found


def list_lengths(schema: WireSchema, name: str = "", above: str = "") -> Iterator[str]:
    """The paths to which a length can be given: texts, and arrays of any length."""
    for field in schema.messages[name or schema.name]:
        path = f"{above}{field.name}"
        if field.size == 0 or field.type == "string":
            yield path
        if field.type in schema.messages:
            yield from list_lengths(schema, field.type, f"{path}.")
