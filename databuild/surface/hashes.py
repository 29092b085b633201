"""The hashes by which both ends of a connection tell that they mean the same message, worked out from definitions.

Sources: genmsg's compute_md5_text (ROS 1); REP 2016 and rosidl's type descriptions (ROS 2 since Iron).
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from typing import Any

from ...impact.facts.interface import Field, Interface, make_full_name

Find = Callable[[str], Interface | None]
"""The definition of `package/Name`, a message; None where it is not known."""

_PRIMITIVES_1 = frozenset((
    "bool", "byte", "char", "string", "time", "duration", "float32", "float64",
    "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64",
))  # fmt: skip
# Numbers of types in type_description_interfaces/FieldType; `char` of a .msg file is a uint8.
_NUMBERS = {
    "int8": 2, "uint8": 3, "char": 3, "int16": 4, "uint16": 5, "int32": 6, "uint32": 7, "int64": 8, "uint64": 9,
    "float32": 10, "float64": 11, "float128": 12, "wchar": 14, "bool": 15, "byte": 16, "octet": 16,
    "string": 17, "wstring": 18,
}  # fmt: skip
_NESTED, _BOUNDED_STRING, _BOUNDED_WSTRING = 1, 21, 22
_ARRAY, _BOUNDED, _SEQUENCE = 48, 96, 144
_EMPTY = Field("structure_needs_at_least_one_member", "uint8", "", "", 0)


def compute_md5(package: str, definition: Interface, find: Find) -> str | None:
    """The hash of a message or service of ROS 1; None where something in it is not known, and of actions, which are
    several messages."""
    if definition.kind not in ("msg", "srv"):
        return None
    texts = [_build_hash_text(package, section.constants, section.fields, find, ()) for section in definition.sections]
    if None in texts:
        return None
    return hashlib.md5("".join(text for text in texts if text is not None).encode()).hexdigest()


def _build_hash_text(package: str, constants: Any, fields: Any, find: Find, above: tuple[str, ...]) -> str | None:
    """What the hash is taken of: constants, then fields, with the hash of each message in the place of its name."""
    lines = [f"{one.type} {one.name}={one.value.strip()}" for one in constants]
    for field in fields:
        if field.type in _PRIMITIVES_1:
            lines.append(f"{field.type}{field.array} {field.name}")
            continue
        name = make_full_name(field.type, package)
        inner = find(name)
        if inner is None or name in above:
            return None
        (section,) = inner.sections[:1] or (None,)
        text = (
            ""
            if section is None
            else _build_hash_text(name.partition("/")[0], section.constants, section.fields, find, (*above, name))
        )
        if text is None:
            return None
        lines.append(f"{hashlib.md5(text.encode()).hexdigest()} {field.name}")
    return "\n".join(lines)


def compute_rihs01(package: str, name: str, definition: Interface, find: Find) -> str | None:
    """The type hash of a message of ROS 2, as `RIHS01_...`; None where something in it is not known, and of services
    and actions, which have messages of their own. name: without its package."""
    if definition.kind != "msg" or len(definition.sections) != 1:
        return None
    known: dict[str, dict[str, Any]] = {}
    whole = f"{package}/msg/{name}"
    if not _describe(package, name, definition, find, known):
        return None
    others = [known[other] for other in sorted(known) if other != whole]
    described = {"type_description": known[whole], "referenced_type_descriptions": others}
    return f"RIHS01_{hashlib.sha256(json.dumps(described).encode()).hexdigest()}"


def _describe(package: str, name: str, definition: Interface, find: Find, known: dict[str, dict[str, Any]]) -> bool:
    """Adds the description of a message and of all that it has inside; False where one of those is not known."""
    fields: list[dict[str, Any]] = []
    known[f"{package}/msg/{name}"] = {"type_name": f"{package}/msg/{name}", "fields": fields}
    for field in definition.sections[0].fields or (_EMPTY,):
        array = _parse_array(field.array)
        plain, _, limit = field.type.partition("<=")
        nested = ""
        if array is None or not (limit or "0").isdecimal():
            return False  # bounded by a constant of an IDL file
        if limit:
            number = _BOUNDED_STRING if plain == "string" else _BOUNDED_WSTRING
        elif plain in _NUMBERS:
            number = _NUMBERS[plain]
        else:
            other, _, short = make_full_name(plain, package).partition("/")
            number, nested = _NESTED, f"{other}/msg/{short}"
            if nested not in known:
                inner = find(f"{other}/{short}")
                if inner is None or not inner.sections or not _describe(other, short, inner, find, known):
                    return False
        type_ = {
            "type_id": array[0] + number,
            "capacity": array[1],
            "string_capacity": int(limit or 0),
            "nested_type_name": nested,
        }
        fields.append({"name": field.name, "type": type_})
    return True


def _parse_array(text: str) -> tuple[int, int] | None:
    """What is added to a type's number, and how many elements there may be; None where that is no number."""
    inside = text.strip("[]")
    if not inside:
        return (_SEQUENCE if text else 0), 0
    most = inside.removeprefix("<=")
    if not most.isdecimal():
        return None
    return (_ARRAY if most == inside else _BOUNDED), int(most)


def compute_hash(name: str, ros: int, definition: Interface, find: Find) -> str | None:
    """The hash of an interface (`package/msg/Name`) in a ROS generation; None where it has none, or it is not known."""
    package, _, rest = name.partition("/")
    if ros == 1:
        return compute_md5(package, definition, find)
    return compute_rihs01(package, rest.partition("/")[2], definition, find)
