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


class SentField(msgspec.Struct, frozen=True, array_like=True):
    """A field of a message. type: a primitive one of ROS 1, or the name of another message of the schema. size: -1 for
    one value, 0 for an array of any length, else the length of the array."""

    name: str
    type: str
    size: int = -1


class SentSchema(msgspec.Struct, frozen=True):
    """Messages by name; the one that is measured is called `name`."""

    name: str
    messages: dict[str, tuple[SentField, ...]]

    def list_fields(self, name: str = "") -> tuple[SentField, ...]:
        """The fields of a message, of the measured one by default."""
        return self.messages[name or self.name]

    def render_definitions(self) -> dict[str, str]:
        """The text of each definition as `NAME.msg`, that of the sample included."""
        texts = {name: _render_fields(fields) for name, fields in self.messages.items()}
        texts[ROOT] = "".join(f"{type_} {name}\n" for name, type_ in _HEAD) + f"{self.name} {CONTENT}\n"
        return texts


def _render_fields(fields: Iterable[SentField]) -> str:
    brackets = {-1: "", 0: "[]"}
    return "".join(f"{each.type}{brackets.get(each.size, f'[{each.size}]')} {each.name}\n" for each in fields)


def make_synthetic(fields: int) -> SentSchema:
    """A message of so many strings."""
    return SentSchema("Blob", {"Blob": tuple(SentField(f"field_{number:03}", "string") for number in range(fields))})


def make_schema(type_: str, find: Callable[[str], Interface | None]) -> SentSchema:
    """The schema of a message `package/Name`. find: the definition of such a name, None when it is not known. Raises
    UserError."""
    messages: dict[str, tuple[SentField, ...]] = {}
    _add_message(type_, find, messages, (), type_)
    return SentSchema(_flatten_name(type_), messages)


def _add_message(
    type_: str, find: Callable[[str], Interface | None], messages: dict[str, Any], line: tuple[str, ...], asked: str
) -> None:
    if type_ in line or len(line) > _DEPTH:
        raise UserError(f"{asked}: `{type_}` contains itself; give another message")
    flat = _flatten_name(type_)
    if flat in messages:
        return
    if type_ in ("builtin_interfaces/Time", "builtin_interfaces/Duration"):
        seconds = SentField("sec", "int32"), SentField("nanosec", "uint32")
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
        fields.append(SentField(field.name, plain, _parse_size(field.array)))
    messages[flat] = tuple(fields)


def _flatten_name(type_: str) -> str:
    return type_.replace("/msg/", "/").replace("/", "__")


def _parse_size(array: str) -> int:
    inside = array.strip("[]")
    if not array:
        return -1
    return int(inside) if inside.isdigit() else 0


def encode(schema: SentSchema, value: Any, name: str = "") -> bytes:
    """The bytes of a message. value: a mapping, or an object with the fields as attributes; fields that a mapping lacks
    are zero or empty. Raises AttributeError for one that an object lacks."""
    parts: list[bytes] = []
    _encode_fields(schema, name or schema.name, value, parts)
    return b"".join(parts)


def _encode_fields(schema: SentSchema, name: str, value: Any, parts: list[bytes]) -> None:
    for field in schema.messages[name]:
        inner = value.get(field.name) if isinstance(value, Mapping) else _get_attribute(value, field.name)
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


def _get_attribute(value: Any, name: str) -> Any:
    # Headers of ROS 1 have a number that those of ROS 2 have not.
    return getattr(value, name, 0) if name == "seq" else getattr(value, name)


def _encode_values(schema: SentSchema, type_: str, values: Any, parts: list[bytes]) -> None:
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


def decode(schema: SentSchema, data: bytes, name: str = "") -> dict[str, Any]:
    """The fields of a message from its bytes: numbers, texts as bytes, times as their bytes, arrays of numbers as numpy
    arrays, others as lists. Raises ValueError where the bytes are not those of such a message."""
    found, end = _decode_fields(schema, name or schema.name, data, 0)
    if end != len(data):
        raise ValueError(f"{len(data) - end} bytes are left over")
    return found


def _decode_fields(schema: SentSchema, name: str, data: bytes, at: int) -> tuple[dict[str, Any], int]:
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


def _decode_values(schema: SentSchema, type_: str, count: int, data: bytes, at: int) -> tuple[Any, int]:
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


def fill(schema: SentSchema, lengths: Mapping[str, int] | int, name: str = "", above: str = "") -> dict[str, Any]:
    """A value of a message: numbers are zero, texts and arrays have the lengths that are given by path, or one for all
    texts; others are empty. Paths are those of list_lengths()."""
    found: dict[str, Any] = {}
    for field in schema.messages[name or schema.name]:
        path = f"{above}{field.name}"
        each = path if field.size < 0 else f"{path}[]"
        count = _get_length(lengths, path) if field.size == 0 else field.size
        if field.type in schema.messages:
            inner = fill(schema, lengths, field.type, f"{each}.")
            found[field.name] = inner if field.size < 0 else [inner] * count
        elif field.type == "string":
            text = b"x" * (lengths if isinstance(lengths, int) else lengths.get(each, 0))
            found[field.name] = text if field.size < 0 else [text] * count
        elif field.size == 0:
            found[field.name] = np.zeros(count, _CODES[field.type]) if field.type in _CODES else [None] * count
    return found


def _get_length(lengths: Mapping[str, int] | int, path: str) -> int:
    return 0 if isinstance(lengths, int) else lengths.get(path, 0)


def list_lengths(schema: SentSchema, name: str = "", above: str = "") -> Iterator[str]:
    """The paths to which a length can be given: texts, and arrays of any length. `points[].name` is the text in each
    element of an array, `names[]` each text of one."""
    for field in schema.messages[name or schema.name]:
        path = f"{above}{field.name}"
        each = path if field.size < 0 else f"{path}[]"
        if field.size == 0:
            yield path
        if field.type == "string":
            yield each
        if field.type in schema.messages:
            yield from list_lengths(schema, field.type, f"{each}.")
