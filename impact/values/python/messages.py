"""Messages of Python nodes: symbolic ones that come in, and empty ones that a callback fills."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import z3

from ...facts.interface import PRIMITIVES, Field, Section, make_full_name
from ..field_types import FieldInteger, find_integer
from ..ir.terms import pack_float
from ..outcomes import InputKind
from .run import PythonRun
from .terms import ListValue, Opaque, Real, Record, SymbolicText, Truth, Whole, convert_to_whole, extend

FindSection = Callable[[str], Section | None]
"""The fields of `package/Name`, None where they are not known."""

_DEEPEST = 12
_TIMES = ("builtin_interfaces/Time", "builtin_interfaces/Duration")


class Messages:
    """Makes messages. ros: 1 or 2."""

    def __init__(self, find_section: FindSection, ros: int):
        self._find_section, self._ros = find_section, ros
        self.asked: set[str] = set()
        """Types whose fields or constants somebody wanted to know."""

    def find_constants(self, type_: str) -> dict[str, Any]:
        """The constants of a type, as values of Python."""
        self.asked.add(type_)
        section = self._find_section(type_)
        return {one.name: _parse_constant(one.type, one.value) for one in section.constants} if section else {}

    def make_input(self, run: PythonRun, type_: str, path: str) -> Record:
        """A symbolic message of a type; its fields are made when they are looked at."""
        record = Record(type_, is_known=self.find_fields(type_) is not None)
        record.fields["~path"] = path
        return record

    def make_empty(self, type_: str) -> Record:
        """A message as its constructor makes it."""
        return Record(type_, is_known=self.find_fields(type_) is not None)

    def list_fields(self, type_: str) -> list[str]:
        """Names of the fields of a type, in order; none where it is not known."""
        return [one.name for one in self.find_fields(type_) or ()]

    def find_field(self, run: PythonRun, record: Record, name: str) -> Any:
        """A field of a message, made when it is first asked for; None where the type has none."""
        if name in record.fields:
            return record.fields[name]
        fields = self.find_fields(record.type)
        field = next((one for one in fields or () if one.name == name), None)
        if field is None:
            return None
        path = record.fields.get("~path")
        if path is None:
            value = self._make_default(field, record.type)
        else:
            value = self._make_symbolic(run, field, record.type, f"{path}.{name}")
        record.fields[name] = value
        return value

    def find_integer(self, type_: str) -> FieldInteger | None:
        """The whole number that a field of a type is, None for other types."""
        return find_integer(type_, self._ros)

    def is_of(self, type_: str, name: str) -> bool:
        """Whether a type has a field."""
        return any(one.name == name for one in self.find_fields(type_) or ())

    def find_fields(self, type_: str) -> tuple[Field, ...] | None:
        """The fields of a type, None where it is not known."""
        self.asked.add(type_)
        if type_ in _TIMES:
            names = ("secs", "nsecs") if self._ros == 1 else ("sec", "nanosec")
            kinds = (
                ("int32", "uint32")
                if self._ros == 2
                else (("uint32", "uint32") if type_.endswith("Time") else ("int32", "int32"))
            )
            return tuple(Field(name, kind, "", "", 0) for name, kind in zip(names, kinds, strict=True))
        section = self._find_section(type_)
        return section.fields if section is not None else None

    def _make_symbolic(self, run: PythonRun, field: Field, owner: str, path: str) -> Any:
        if not field.array:
            return self._make_one(run, field.type, owner, path)
        fixed = re.fullmatch(r"\[(\d+)\]", field.array)
        bounded = re.fullmatch(r"\[<=(\d+)\]", field.array)
        if fixed:
            count = int(fixed.group(1))
            return ListValue([self._make_one(run, field.type, owner, f"{path}[{index}]") for index in range(count)])
        most = min(run.bounds.array, int(bounded.group(1))) if bounded else run.bounds.array
        elements = [self._make_one(run, field.type, owner, f"{path}[{index}]") for index in range(most)]
        return ListValue(elements, run.get_size(path, most))

    def _make_one(self, run: PythonRun, type_: str, owner: str, path: str) -> Any:
        plain = type_.partition("<")[0]
        if plain == "byte" and self._ros == 2:
            return Opaque(path)  # rclpy has bytes there
        if (number := self.find_integer(plain)) is not None:
            return run.get_whole(path, *number)
        if plain == "bool":
            return run.get_truth(path)
        if plain in ("float32", "float64"):
            return run.get_real(path, int(plain[5:]))
        if plain in ("string", "wstring"):
            return run.get_text(path)
        return self.make_input(run, make_full_name(plain, owner.partition("/")[0]), path)

    def _make_default(self, field: Field, owner: str) -> Any:
        if field.array:
            fixed = re.fullmatch(r"\[(\d+)\]", field.array)
            count = int(fixed.group(1)) if fixed else 0
            return ListValue([self._make_default_one(field, owner) for _ in range(count)])
        if field.default and field.type in PRIMITIVES:
            return _parse_constant(field.type, field.default)
        return self._make_default_one(field, owner)

    def _make_default_one(self, field: Field, owner: str) -> Any:
        plain = field.type.partition("<")[0]
        if self.find_integer(plain) is not None:
            return 0
        if plain == "bool":
            return False
        if plain.startswith("float"):
            return 0.0
        if plain in ("string", "wstring"):
            return ""
        return self.make_empty(make_full_name(plain, owner.partition("/")[0]))

    def flatten(
        self, run: PythonRun, value: Any, path: str, found: dict[str, Any], kinds: dict[str, Any], deep: int = 0
    ) -> None:
        """Lists what a message that is published holds: leaf paths with bit vectors or numbers. What is not known is
        left out."""
        if deep > _DEEPEST:
            return
        if isinstance(value, Record):
            inner = value.fields.get("~path")
            for name in self.list_fields(value.type) if value.is_known else ():
                if inner is not None and name not in value.fields and deep > 2:
                    continue
                self.flatten(
                    run, self.find_field(run, value, name), f"{path}.{name}" if path else name, found, kinds, deep + 1
                )
            return
        if isinstance(value, ListValue):
            size = value.size if value.size is not None else len(value.elements)
            _put(found, kinds, f"{path}.size", size, InputKind.SIZE)
            for index, one in enumerate(value.elements[:16]):
                self.flatten(run, one, f"{path}[{index}]", found, kinds, deep + 1)
            return
        if isinstance(value, (str, SymbolicText)):
            characters = tuple(map(ord, value)) if isinstance(value, str) else value.characters
            size = value.size if isinstance(value, SymbolicText) and value.size is not None else len(characters)
            _put(found, kinds, f"{path}.size", size, InputKind.SIZE)
            for index, one in enumerate(characters):
                found[f"{path}[{index}]"], kinds[f"{path}[{index}]"] = one, (InputKind.CHARACTER, 8, False)
            return
        if isinstance(value, (bool, Truth)):
            _put(found, kinds, path, value, InputKind.BOOLEAN)
        elif isinstance(value, (int, Whole)):
            _put(found, kinds, path, value, InputKind.INTEGER)
        elif isinstance(value, (float, Real)):
            _put(found, kinds, path, value, InputKind.FLOAT64)


def _put(found: dict[str, Any], kinds: dict[str, Any], path: str, value: Any, kind: InputKind) -> None:
    if kind is InputKind.FLOAT64:
        term = z3.fpToIEEEBV(value.term) if isinstance(value, Real) else pack_float(value, 64)
        found[path], kinds[path] = term, (kind, 64, True)
        return
    whole = convert_to_whole(value)
    bits = 8 if kind is InputKind.BOOLEAN else 64
    if isinstance(whole, Whole):
        size = whole.term.size()
        found[path] = extend(whole, bits) if size <= bits else z3.Extract(bits - 1, 0, whole.term)
    else:
        found[path] = whole & ((1 << bits) - 1)
    kinds[path] = (kind, bits, kind is InputKind.INTEGER)


def _parse_constant(type_: str, value: str) -> Any:
    plain = type_.partition("<")[0]
    if plain in ("string", "wstring"):
        return value.strip("\"'")
    if plain == "bool":
        return value.strip().lower() in ("true", "1")
    try:
        return float(value) if plain.startswith("float") else int(value, 0)
    except ValueError:
        return 0
