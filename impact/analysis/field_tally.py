"""What the messages of one topic hold, field by field, counted on their bytes: nothing is built of a message."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from typing import NamedTuple

import numpy

from ..model.wire import VARIABLE, Encoding, WireField

_UINT32 = {"<": struct.Struct("<I").unpack_from, ">": struct.Struct(">I").unpack_from}
_FLOATS = {"float32": "f4", "float64": "f8"}
# The second of the four bytes in front of a message says how it is encoded; see DDSI-RTPS 2.5, 10.5.
_ORDERS = {0: ">", 1: "<"}
_PADDING_AT_MOST = 3


class WrongBytes(ValueError):
    """A message is not as its definition says; the text is a clause."""


class FieldTally:
    """What is counted of a field. filled: a value other than 0, false and empty was seen. nonzero: one with a byte that
    is not 0. size: bytes in all. counts: how often an array or string was met, the least, all and the most that it
    held."""

    __slots__ = ("field", "filled", "least", "met", "most", "nonzero", "size", "total")

    def __init__(self, field: WireField):
        self.field = field
        self.filled = self.nonzero = False
        self.size = self.met = self.total = self.most = 0
        self.least = -1

    def add_length(self, length: int) -> None:
        self.met += 1
        self.total += length
        if length > self.most:
            self.most = length
        if self.least < 0 or length < self.least:
            self.least = length


class _Check(NamedTuple):
    """Bytes of a field from the beginning of its block on."""

    start: int
    end: int
    tally: FieldTally


class _Form:
    """A block at one place modulo 8. size: with the padding inside. visits: how often it was met there."""

    def __init__(self, block: _Block, at: int, aligned: bool):
        start = at
        self.checks: list[_Check] = []
        for tally in block.tallies:
            field = tally.field
            if aligned:
                at = -(-at // field.alignment) * field.alignment
            size = field.size * (1 if field.elements is None else field.elements)
            self.checks.append(_Check(at - start, at - start + size, tally))
            at += size
        self.size = at - start
        self.after = at % 8
        self.visits = 0
        self.bounds: tuple[int, int] = (0, self.size)


class _Block:
    """Neighbours that always take the same bytes."""

    def __init__(self) -> None:
        self.tallies: list[FieldTally] = []
        self.forms: list[_Form] = []

    def close(self, aligned: bool) -> None:
        self.forms = [_Form(self, at, aligned) for at in range(8 if aligned else 1)]

    def forget_filled(self) -> None:
        for form in self.forms:
            form.checks = [check for check in form.checks if not check.tally.nonzero]
            if form.checks:
                form.bounds = form.checks[0].start, form.checks[-1].end

    def fold(self) -> None:
        """Adds what was met to the sizes of the fields."""
        for form in self.forms:
            for tally in self.tallies:
                field = tally.field
                tally.size += form.visits * field.size * (1 if field.elements is None else field.elements)
            form.visits = 0


class _Text(NamedTuple):
    """A string."""

    tally: FieldTally


class _Texts(NamedTuple):
    """An array of strings."""

    tally: FieldTally


class _Values(NamedTuple):
    """An array of any number of primitive values."""

    tally: FieldTally


class _Structs(NamedTuple):
    """An array of messages."""

    tally: FieldTally
    steps: tuple[_Step, ...]


_Step = _Block | _Text | _Texts | _Values | _Structs


class MessageTally:
    """Counts messages of one layout. fields: one of each field, in order."""

    def __init__(self, layout: Sequence[WireField], encoding: Encoding):
        self.fields: list[FieldTally] = []
        self._aligned = encoding == "cdr"
        self._mask = 7 if self._aligned else 0
        self._head = 4 if self._aligned else 0
        self._blocks: list[_Block] = []
        self._steps = self._plan(layout)
        for block in self._blocks:
            block.close(self._aligned)

    def _plan(self, layout: Sequence[WireField]) -> tuple[_Step, ...]:
        steps: list[_Step] = []
        for field in layout:
            tally = FieldTally(field)
            if field.sent:
                self.fields.append(tally)
            if field.elements == 0:
                continue
            if field.members or (field.elements is not None and not field.size and not field.is_string):
                inner = self._plan(field.members)
                if inner or field.elements == VARIABLE:
                    steps.append(_Structs(tally, inner))
            elif field.is_string:
                steps.append((_Text if field.elements is None else _Texts)(tally))
            elif field.elements == VARIABLE:
                steps.append(_Values(tally))
            else:
                if not steps or not isinstance(steps[-1], _Block):
                    self._blocks.append(_Block())
                    steps.append(self._blocks[-1])
                self._blocks[-1].tallies.append(tally)
        return tuple(steps)

    def add(self, data: bytes) -> None:
        """Counts a message. Raises WrongBytes where it is not as its definition says; a part may be counted then."""
        order = "<"
        if self._aligned:
            order = _ORDERS.get(data[1], "") if len(data) >= self._head and not data[0] else ""
            if not order:
                raise WrongBytes(f"begins with {data[:4].hex(' ')}, which is no CDR of the first version")
        try:
            end = _Walk(data, self._head, self._mask, order).walk(self._steps, self._head)
        except struct.error:
            raise WrongBytes(f"ends early, after {len(data)} bytes") from None
        rest = len(data) - end
        if rest < 0 or rest > (_PADDING_AT_MOST if self._aligned else 0):
            raise WrongBytes(f"has {len(data)} bytes where its definition says {end}")

    def finish(self) -> None:
        """To be called once, after the last message."""
        for block in self._blocks:
            block.fold()


class _Walk:
    """The way through the bytes of one message."""

    def __init__(self, data: bytes, base: int, mask: int, order: str):
        self.data = data
        self.base = base
        self.mask = mask
        self.order = order
        self.read = _UINT32[order]

    def walk(self, steps: tuple[_Step, ...], at: int) -> int:
        """Where these steps end that begin at a place. Raises WrongBytes, struct.error."""
        data, base, mask = self.data, self.base, self.mask
        for step in steps:
            if isinstance(step, _Block):
                form = step.forms[(at - base) & mask]
                end = at + form.size
                if end > len(data):
                    raise WrongBytes(f"ends early, after {len(data)} bytes")
                form.visits += 1
                if form.checks:
                    self.check(step, form, at)
                at = end
            elif isinstance(step, _Text):
                tally = step.tally
                length, end = self.take_text(tally.field, at)
                if length and not tally.nonzero:
                    tally.filled = tally.nonzero = True
                tally.add_length(length)
                tally.size += end - at - ((base - at) & mask & 3)
                at = end
            elif isinstance(step, _Values):
                at = self.take_values(step.tally, at)
            elif isinstance(step, _Structs):
                at = self.take_structs(step, at)
            else:
                at = self.take_texts(step.tally, at)
        return at

    def check(self, block: _Block, form: _Form, at: int) -> None:
        data, changed = self.data, False
        first, last = form.bounds
        if data.count(0, at + first, at + last) == last - first:
            return
        for start, end, tally in form.checks:
            start += at
            end += at
            if data.count(0, start, end) != end - start and self.holds_value(tally.field, start, end):
                tally.filled = tally.nonzero = changed = True
        if changed:
            block.forget_filled()

    def holds_value(self, field: WireField, start: int, end: int) -> bool:
        """Whether bytes that are not all 0 are a value other than 0, which -0.0 is not."""
        kind = _FLOATS.get(field.type)
        return kind is None or bool(numpy.frombuffer(self.data[start:end], f"{self.order}{kind}").any())

    def take_count(self, at: int) -> tuple[int, int]:
        at += (self.base - at) & self.mask & 3
        return self.read(self.data, at)[0], at + 4

    def take_text(self, field: WireField, at: int) -> tuple[int, int]:
        """(bytes of a string, where it ends)."""
        length, at = self.take_count(at)
        at += length
        if at > len(self.data):
            raise WrongBytes(f"ends early: `{field.path}` is to have a string of {length:,} bytes")
        if self.mask and length:
            length -= 1  # the zero behind it
        return length, at

    def take_values(self, tally: FieldTally, at: int) -> int:
        field = tally.field
        number, at = self.take_count(at)
        begin = at
        if number:
            if self.mask:
                at += (self.base - at) % field.alignment
            start, at = at, at + number * field.size
            if at > len(self.data):
                raise WrongBytes(f"ends early: `{field.path}` is to have {number:,} elements")
            tally.filled = True
            if not tally.nonzero:
                zeros = self.data.count(0, start, at)
                tally.nonzero = zeros != at - start and self.holds_value(field, start, at)
        tally.add_length(number)
        # Padding in front is nobody's; that inside of an array is the array's.
        tally.size += at - begin + 4
        return at

    def take_texts(self, tally: FieldTally, at: int) -> int:
        field = tally.field
        number = field.elements
        assert number is not None
        at += (self.base - at) & self.mask & 3
        begin = at
        if number == VARIABLE:
            number, at = self.take_count(at)
            tally.filled = tally.filled or bool(number)
        for _ in range(number):
            length, at = self.take_text(field, at)
            if length:
                tally.filled = tally.nonzero = True
        tally.add_length(number)
        tally.size += at - begin
        return at

    def take_structs(self, step: _Structs, at: int) -> int:
        tally, number = step.tally, step.tally.field.elements
        if number == VARIABLE:
            number, at = self.take_count(at)
            tally.size += 4
        assert number is not None
        tally.add_length(number)
        if number and tally.field.elements == VARIABLE:
            tally.filled = True
        steps = step.steps
        if not steps or not number:
            return at
        if len(steps) == 1 and isinstance(steps[0], _Block):
            block = steps[0]
            if number > 1:
                first = block.forms[(at - self.base) & self.mask]
                then = block.forms[first.after & self.mask]
                if then.after & self.mask == first.after & self.mask:
                    at = self.walk(steps, at)
                    return self.take_equal(block, then, at, number - 1)
        for _ in range(number):
            at = self.walk(steps, at)
        return at

    def take_equal(self, block: _Block, form: _Form, at: int, number: int) -> int:
        """Elements of which all have the same form."""
        end = at + form.size * number
        if end > len(self.data):
            raise WrongBytes(f"ends early: an array is to have {number + 1:,} elements")
        form.visits += number
        if form.checks and form.size:
            rows = numpy.frombuffer(self.data, numpy.uint8, end - at, at).reshape(number, form.size)
            changed = False
            for start, stop, tally in form.checks:
                column = rows[:, start:stop]
                if column.any() and self.holds_any(tally.field, column):
                    tally.filled = tally.nonzero = changed = True
            if changed:
                block.forget_filled()
        return end

    def holds_any(self, field: WireField, column: numpy.ndarray) -> bool:
        kind = _FLOATS.get(field.type)
        return kind is None or bool(numpy.frombuffer(column.tobytes(), f"{self.order}{kind}").any())
