"""Which fields of a message are set before it is published, and how long texts and arrays are made."""

from __future__ import annotations

import re
from typing import NamedTuple

from ...facts.flow import FlowExpr
from ..flow.code import Fn, Variable, get_tail
from ..flow.types import find_interface
from .places import UsePlace, split_path
from .reading import FieldReader, ReadAt
from .shapes import Path

_MOST = 200
_SETS = frozenset(("write", "change"))
_SIZED = frozenset(("resize", "assign"))
_REPEATED = re.compile(r"\[[^\[\],]*\] ?\* ?([0-9]{1,9})|([0-9]{1,9}) ?\* ?\[[^\[\],]*\]")
_VECTOR = re.compile(r"(?:std::)?vector(?:<.*>)?")
_NUMBER = re.compile(r"([0-9]{1,9})[uUlL]*")


class Writing(NamedTuple):
    """sets: fields, or what is above them, by where they are set first. unknown: why others may be set too. lengths: of
    texts in bytes and of arrays in elements, the longest that the code writes as a constant; `[]` behind a path for the
    texts in an array."""

    sets: dict[Path, ReadAt]
    unknown: str
    lengths: dict[Path, int]


def find_writes(reader: FieldReader, value: FlowExpr | None, fn: Fn, line: int, type_: str) -> Writing:
    """What is set of a message `package/Name` that a publish statement is given. value: its argument."""
    return _Walk(reader, type_).run(value, fn, line)


class _Walk:
    """One message followed backwards."""

    def __init__(self, reader: FieldReader, type_: str):
        self.reader, self.type = reader, type_
        self.code, self.uses, self.shapes = reader.code, reader.uses, reader.shapes
        self.sets: dict[Path, ReadAt] = {}
        self.lengths: dict[Path, int] = {}
        self.unknown = ""
        self.seen: set[tuple[Variable, Path]] = set()

    def run(self, value: FlowExpr | None, fn: Fn, line: int) -> Writing:
        if value is None:
            return Writing({}, "what is published is not known", {})
        self._take(value, fn, line, ())
        return Writing(self.sets, self.unknown, self.lengths)

    def _give_up(self, why: str) -> None:
        self.unknown = self.unknown or why

    def _set(self, path: Path, file: str, line: int) -> None:
        here = ReadAt(file, line)
        if path not in self.sets or here < self.sets[path]:
            self.sets[path] = here

    def _measure_use(self, path: Path, place: UsePlace) -> None:
        """The length that a field is given where it is assigned, or its container is told one."""
        use, facts = place.use, place.fn.facts
        if use.how == "write":
            for each in facts.assignments:
                if each.line == use.line and each.target == use.path and each.operator == "=":
                    self._measure(path, each.value)
        elif use.to in _SIZED:
            for call in facts.calls:
                if call.line == use.line and call.callee == f"{use.path}.{use.to}" and call.arguments:
                    self._measure_number(path, call.arguments[0])

    def _measure(self, path: Path, value: FlowExpr) -> None:
        """The length of what a field becomes, where the code writes it."""
        if value.kind == "text":
            self._keep_longest(path, len(value.text.encode("utf-8", "replace")))
        elif value.kind == "list":
            self._keep_longest(path, len(value.parts))
            for one in value.parts:
                if one.kind == "text":
                    self._measure((*path, "[]"), one)
        elif value.kind in ("make", "call") and _VECTOR.fullmatch(value.text) and value.parts:
            self._measure_number(path, value.parts[0])
        elif value.kind == "other" and (found := _REPEATED.fullmatch(value.text)):
            self._keep_longest(path, int(found[1] or found[2]))

    def _measure_number(self, path: Path, value: FlowExpr) -> None:
        if value.kind == "number" and (found := _NUMBER.fullmatch(value.text)):
            self._keep_longest(path, int(found[1]))

    def _keep_longest(self, path: Path, length: int) -> None:
        self.lengths[path] = max(length, self.lengths.get(path, 0))

    def _take(self, value: FlowExpr, fn: Fn, line: int, base: Path) -> None:
        """What an expression sets of the field that it becomes."""
        if value.kind == "name":
            parts = split_path(value.text)
            if len(parts) == 1 or (len(parts) == 2 and parts[0] == "this"):
                self._follow(self.code.identify(value.text, fn), fn, base)
            else:
                self._give_up(f"`{value.text}` is a part of something else")
        elif value.kind in ("make", "call") and self._makes_message(value, fn):
            for argument in value.parts:
                if argument.kind == "keyword" and argument.parts and not argument.text.startswith("*"):
                    self._set((*base, argument.text), fn.source.path, line)
                    self._measure((*base, argument.text), argument.parts[0])
                else:
                    self._give_up("it is made from something else")
        else:
            self._give_up(f"`{value.text or value.kind}` gives it")

    def _makes_message(self, value: FlowExpr, fn: Fn) -> bool:
        kind = self.code.resolve_type(value, fn)
        return bool(kind.name) and find_interface(kind.name, lower=True) == self.type

    def _follow(self, variable: Variable, fn: Fn, base: Path) -> None:
        """All that sets a variable, or something in it."""
        if (variable, base) in self.seen or len(self.seen) > _MOST:
            return
        self.seen.add((variable, base))
        if variable.kind == "local" and any(one.name == variable.name for one in fn.facts.parameters):
            self._give_up(f"`{variable.name}` is given to the function")
        for writer, each in self.code.list_writes(variable):
            if each.value.kind == "make" and not each.value.parts:
                continue
            if self.code.identify(each.target, writer) == variable and "." not in each.target.removeprefix("this."):
                self._take(each.value, writer, each.line, base)
        for place in self.uses.list_uses(variable):
            use = place.use
            spot = self.shapes.find(self.type, base, split_path(use.path)[place.at + 1 :])
            if use.how in _SETS:
                if spot.path != base:
                    self._set(spot.path, place.fn.source.path, use.line)
                    self._measure_use(spot.path, place)
            elif use.how == "kept" and spot.kind in ("message", "array"):
                inner = self.code.identify(".".join(p for p in use.to.split(".") if p != "[]"), place.fn)
                if inner.kind == "local" and spot.path != base:
                    self._follow(inner, place.fn, spot.path)
                elif inner != variable:
                    self._give_up(f"it is kept in `{use.to}` too")
            elif use.how == "given" and spot.kind in ("message", "array") and get_tail(use.to) not in _READS:
                self._give_up(f"it is given to `{get_tail(use.to)}`")
            elif use.how in ("use", "method", "returned") and spot.kind in ("message", "array"):
                self._give_up(f"{use.how} `{use.to}`")


_READS = frozenset(("publish", "publish_", "Publish", "print", "str", "repr", "make_shared", "make_unique"))
