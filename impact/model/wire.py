"""How messages lie on the wire: their fields in order, and how many bytes they take.

ROS 1: http://wiki.ros.org/msg and roscpp's serialization.h; little-endian, nothing is aligned. ROS 2: CDR of OMG's DDS
X-Types 1.3 in its first version (XCDR1), as the RMW implementations write it: four bytes that name the encoding, then
every primitive value aligned to its own size, counted from behind these four bytes.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Literal, NamedTuple

from ..facts.interface import Section, make_full_name

Encoding = Literal["ros1", "cdr"]
HEAD: dict[Encoding, int] = {"ros1": 0, "cdr": 4}
"""Bytes before a message that name its encoding."""
SIZES = {
    "bool": 1, "byte": 1, "char": 1, "octet": 1, "int8": 1, "uint8": 1, "int16": 2, "uint16": 2, "int32": 4,
    "uint32": 4, "int64": 8, "uint64": 8, "float32": 4, "float64": 8,
}  # fmt: skip
TIMES = {"time": 8, "duration": 8, "builtin_interfaces/Time": 8, "builtin_interfaces/Duration": 8}
"""Two numbers of four bytes, which nobody takes apart: `time` is a primitive type of ROS 1 and a message of ROS 2."""
_STRING = "string"
_FIXED = re.compile(r"\[([0-9]+)\]")
_LEVELS = 50
_FIELDS_AT_MOST = 20_000
VARIABLE = -1

FindSection = Callable[[str], "Section | None"]
"""Gives the fields of the message `package/Name`, None where it is not known."""


class LayoutError(ValueError):
    """It is not known how a message lies on the wire; the text is a clause that says why."""


class WireField(NamedTuple):
    """A field as it lies on the wire; those of a nested message stand in its place, unless they are repeated.

    path: `pose.position.x`; `points[].x` of each element of an array. type: a primitive one or a time, or as the array
    of messages has it. size: bytes of one value; 0 for strings and messages. elements: None for one value,
    the number of them, or VARIABLE. members: those of one element of an array of messages. sent: False for the byte
    that a message without fields takes in CDR, which is nobody's field.
    """

    path: str
    type: str
    size: int
    elements: int | None = None
    members: tuple[WireField, ...] = ()
    sent: bool = True

    @property
    def alignment(self) -> int:
        """What a value's place is a multiple of in CDR."""
        return 4 if self.type not in SIZES else self.size

    @property
    def is_string(self) -> bool:
        return self.type == _STRING


def build_layout(find_section: FindSection, name: str, encoding: Encoding) -> tuple[WireField, ...]:
    """The fields of the message `package/Name` in order. Raises LayoutError: a nested message that is not known or
    holds itself, wstring and types of IDL alone, on whose form RMW implementations differ, and what is out of all
    proportion."""
    return _Layout(find_section, encoding).list_fields(name, "", ())


class _Layout:
    def __init__(self, find_section: FindSection, encoding: Encoding):
        self.find_section = find_section
        self.encoding: Encoding = encoding
        self.left = _FIELDS_AT_MOST

    def list_fields(self, name: str, above: str, around: tuple[str, ...]) -> tuple[WireField, ...]:
        if name in around:
            raise LayoutError(f"{name} holds itself")
        if len(around) >= _LEVELS:
            raise LayoutError(f"messages are nested more than {_LEVELS} levels deep")
        section = self.find_section(name)
        if section is None:
            raise LayoutError(f"the definition of {name} is not known")
        found: list[WireField] = []
        for field in section.fields:
            self.left -= 1
            if self.left < 0:
                raise LayoutError(f"there are more than {_FIELDS_AT_MOST:,} fields, nested ones included")
            path = f"{above}.{field.name}" if above else field.name
            found += self.make(field.type.partition("<=")[0], field.array, path, name, around)
        if not section.fields and self.encoding == "cdr":
            found.append(WireField(above, "uint8", 1, sent=False))
        return tuple(found)

    def make(
        self, type_: str, array: str, path: str, owner: str, around: tuple[str, ...]
    ) -> tuple[WireField, ...]:  # fmt: skip
        fixed = _FIXED.fullmatch(array)
        if fixed is not None and len(fixed[1]) > 12:
            raise LayoutError(f"`{path}` has {fixed[1][:12]}... elements")
        count = None if not array else int(fixed[1]) if fixed is not None else VARIABLE
        size = SIZES.get(type_) or TIMES.get(type_.replace("/msg/", "/"), 0)
        if size or type_ == _STRING:
            return (WireField(path, type_, size, count),)
        if type_ in ("wstring", "wchar", "float128"):
            raise LayoutError(f"`{path}` is a {type_}, which middlewares send in different forms")
        inside = path if count is None else f"{path}[]"
        members = self.list_fields(make_full_name(type_, owner.rpartition("/")[0]), inside, (*around, owner))
        return members if count is None else (WireField(path, type_, 0, count, members),)


def compute_size(
    layout: tuple[WireField, ...], lengths: Mapping[str, int], encoding: Encoding, default: int = 0
) -> int:  # fmt: skip
    """Bytes that a message takes, the four in front of it in ROS 2 included.

    layout: of build_layout(). lengths: of strings in bytes, and of arrays that have no fixed length in elements, by
    path: `header.frame_id`, `points`, `points[].name`; the strings of an array `names` are `names[]`. The same for all
    elements. default: of those that are not named.
    """
    sizer = _Sizer(lengths, encoding == "cdr", default)
    return HEAD[encoding] + sizer.walk(layout, 0)


class _Sizer:
    def __init__(self, lengths: Mapping[str, int], aligned: bool, default: int):
        self.lengths = lengths
        self.aligned = aligned
        self.default = default

    def walk(self, fields: tuple[WireField, ...], at: int) -> int:
        """Where these fields end that begin at a place."""
        for field in fields:
            count = field.elements
            if count == VARIABLE:
                at = self.pad(at, 4) + 4
                count = self.lengths.get(field.path, self.default)
            if field.members:
                at = self.loop(lambda place, inner=field.members: self.walk(inner, place), at, count)
            elif field.is_string:
                length = self.lengths.get(field.path if field.elements is None else f"{field.path}[]", self.default)
                end = 4 + length + self.aligned  # CDR counts and sends the zero behind a string
                at = self.loop(lambda place, end=end: self.pad(place, 4) + end, at, count)
            elif count != 0:
                at = self.pad(at, field.alignment) + (1 if count is None else count) * field.size
        return at

    def pad(self, at: int, size: int) -> int:
        return -(-at // size) * size if self.aligned else at

    def loop(self, step: Callable[[int], int], at: int, count: int | None) -> int:
        """Where elements end of which each begins where the one before ended."""
        left = 1 if count is None else count
        seen: dict[int, tuple[int, int]] = {}
        while left:
            # An element takes what it takes at the same place modulo 8, so that what comes repeats.
            if at % 8 in seen:
                left_then, at_then = seen.pop(at % 8)
                rounds = left // (left_then - left)
                at += rounds * (at - at_then)
                left -= rounds * (left_then - left)
                seen.clear()
                if not left:
                    break
            seen[at % 8] = left, at
            at = step(at)
            left -= 1
        return at
