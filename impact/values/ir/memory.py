"""Memory: objects (variables of the stack, blocks of the heap, globals), each with cells at offsets.

What nobody wrote is `UNDEFINED`, not zero. A freed object is known as such. A state that forks shares its objects with
its twin until one of them writes.
"""

from __future__ import annotations

import bisect
import itertools
from collections.abc import Callable
from typing import Any

import z3

from .layout import IrType
from .module import NULL, UNDEFINED, Code, Pointer
from .terms import (
    ADDRESS_MASK,
    make_bits,
    make_float_bits,
    read_float_bits,
    reduce_term,
)

_WIDEST = 16


class MemoryObject:
    """A piece of memory. size: bytes that there are; limit: a term below which offsets may be used, where the size is
    symbolic. cells: offset to (size, value). is_zeroed: whether what has no cell is zero."""

    __slots__ = ("cells", "is_live", "is_zeroed", "kind", "limit", "name", "owner", "size")

    def __init__(self, size: int, kind: str, name: str, owner: object, is_zeroed: bool = False):
        self.size = size
        self.kind = kind
        self.name = name
        self.owner = owner
        self.is_zeroed = is_zeroed
        self.is_live = True
        self.limit: z3.BitVecRef | None = None
        self.cells: dict[int, tuple[int, Any]] = {}

    def copy(self, owner: object) -> MemoryObject:
        twin = MemoryObject(self.size, self.kind, self.name, owner, self.is_zeroed)
        twin.is_live = self.is_live
        twin.limit = self.limit
        twin.cells = dict(self.cells)
        return twin

    def find_cell(self, offset: int) -> tuple[int, int, Any] | None:
        """Start, size and value of the cell that covers a byte."""
        for back in range(_WIDEST):
            cell = self.cells.get(offset - back)
            if cell is not None:
                return (offset - back, *cell) if cell[0] > back else None
        return None

    def is_untouched(self, offset: int, size: int) -> bool:
        """Whether no cell covers any of some bytes."""
        if not self.cells:
            return True
        cells = self.cells
        if any(place in cells for place in range(offset, offset + size)):
            return False
        return self.find_cell(offset) is None

    def write(self, offset: int, size: int, value: Any):
        """A value of one to sixteen bytes."""
        cells = self.cells
        cell = cells.get(offset)
        if cell is None or cell[0] != size:
            self.clear(offset, size)
        cells[offset] = (size, value)

    def clear(self, offset: int, size: int):
        """Removes what lies there; of cells that reach over the edge, the rest stays, byte by byte."""
        first = self.find_cell(offset)
        if first is not None and first[0] < offset:
            self._split(*first)
        last = self.find_cell(offset + size)
        if last is not None and last[0] < offset + size:
            self._split(*last)
        if size > 4 * len(self.cells):
            for place in [place for place in self.cells if offset <= place < offset + size]:
                del self.cells[place]
        else:
            for place in range(offset, offset + size):
                self.cells.pop(place, None)

    def _split(self, start: int, size: int, value: Any):
        del self.cells[start]
        for index in range(size):
            self.cells[start + index] = (1, cut_byte(value, size, index))

    def list_cells(self, offset: int, size: int) -> list[tuple[int, int, Any]]:
        """Cells (start, size, value) that lie in a range, in order; those over its edges by bytes."""
        found = []
        place, end = offset, offset + size
        if size > 4 * len(self.cells) + _WIDEST:
            places = sorted(each for each in self.cells if offset - _WIDEST < each < end)
        else:
            places = [each for each in range(offset - _WIDEST + 1, end) if each in self.cells]
        for start in places:
            width, value = self.cells[start]
            if start >= place and start + width <= end:
                found.append((start, width, value))
            elif start + width > offset:
                found.extend(
                    (start + index, 1, cut_byte(value, width, index))
                    for index in range(width)
                    if offset <= start + index < end
                )
        return found


class ByteOfPointer(tuple):
    """One byte of an address: (pointer or code, which byte)."""

    __slots__ = ()


def cut_byte(value: Any, size: int, index: int) -> Any:
    """One byte of a value that has some."""
    if size == 1:
        return value
    if value is UNDEFINED:
        return UNDEFINED
    if isinstance(value, Pointer | Code):
        return ByteOfPointer((value, index))
    if isinstance(value, int):
        return value >> 8 * index & 255
    if isinstance(value, float) or z3.is_fp(value):
        value = make_float_bits(value, size * 8)
        if isinstance(value, int):
            return value >> 8 * index & 255
    return reduce_term(z3.Extract(8 * index + 7, 8 * index, make_bits(value, 8 * size)))


class AddressMap:
    """Where objects lie, for code that takes an address as a number."""

    def __init__(self):
        self._bases: list[int] = [0]
        self._next = 0x10_0000
        self._numbers = itertools.count(1)
        self._codes: dict[str, int] = {}
        self._names: dict[int, str] = {}

    def add(self, size: int) -> int:
        """A number for a new object."""
        self._bases.append(self._next)
        self._next += (size + 95) // 32 * 32
        return next(self._numbers)

    def get_base(self, number: int) -> int:
        return self._bases[number]

    def compute_address(self, value: Any) -> Any:
        """The address of a pointer or a function: a number or a bit vector of 64 bits."""
        if isinstance(value, Code):
            if value.name not in self._codes:
                self._codes[value.name] = 0x1000 + 16 * len(self._codes)
                self._names[self._codes[value.name]] = value.name
            return self._codes[value.name]
        base = self._bases[value.object]
        if isinstance(value.offset, int):
            return (base + value.offset) & ADDRESS_MASK
        return reduce_term(value.offset + base) if base else value.offset

    def find_pointer(self, address: int) -> Pointer | Code:
        """What lies at an address."""
        if address in self._names:
            return Code(self._names[address])
        if address < self._bases[1] if len(self._bases) > 1 else True:
            return Pointer(0, address) if address else NULL
        number = bisect.bisect_right(self._bases, address) - 1
        return Pointer(number, address - self._bases[number])


def join_bytes(parts: list[Any], addresses: AddressMap, make_any: Callable[[int], Any]) -> Any:
    """The integer of some bytes, lowest first; a pointer where they are all bytes of one; UNDEFINED where nobody wrote
    any of them."""
    if all(part is UNDEFINED for part in parts):
        return UNDEFINED
    if len(parts) == 8 and all(
        isinstance(part, ByteOfPointer) and part[1] == index and part[0] == parts[0][0]
        for index, part in enumerate(parts)
    ):
        return parts[0][0]
    plain = []
    for part in parts:
        if part is UNDEFINED:
            part = make_any(8)
        elif isinstance(part, ByteOfPointer):
            part = cut_byte(addresses.compute_address(part[0]), 8, part[1])
        plain.append(part)
    if all(isinstance(part, int) for part in plain):
        return sum(part << 8 * index for index, part in enumerate(plain))
    if len(plain) == 1:
        return plain[0]
    return reduce_term(z3.Concat(*[make_bits(part, 8) for part in reversed(plain)]))


def read_raw(
    memory_object: MemoryObject, offset: int, size: int, addresses: AddressMap, make_any: Callable[[int], Any]
) -> Any:
    """What lies at an offset, whatever its type."""
    cell = memory_object.cells.get(offset)
    if cell is not None and cell[0] == size:
        return cell[1]
    blank = 0 if memory_object.is_zeroed else UNDEFINED
    if cell is None and memory_object.is_untouched(offset, size):
        return blank
    parts = []
    for place in range(offset, offset + size):
        found = memory_object.find_cell(place)
        parts.append(blank if found is None else cut_byte(found[2], found[1], place - found[0]))
    return join_bytes(parts, addresses, make_any)


def interpret_raw(value: Any, type_: IrType, addresses: AddressMap) -> Any:
    """A value from memory as one of a scalar type. Raises ValueError where it is an address that is not known."""
    if value is UNDEFINED:
        return value
    if isinstance(value, ByteOfPointer):
        value = cut_byte(addresses.compute_address(value[0]), 8, value[1])
    if type_.is_pointer:
        if isinstance(value, Pointer | Code):
            return value
        if isinstance(value, float) or z3.is_fp(value):
            value = make_float_bits(value, 64)
        if isinstance(value, int):
            return addresses.find_pointer(value)
        raise ValueError("an address that is calculated from inputs")
    if type_.is_float:
        if isinstance(value, float) or z3.is_fp(value):
            return value
        if isinstance(value, Pointer | Code):
            value = addresses.compute_address(value)
        return reduce_term(read_float_bits(value, type_.bits))
    if isinstance(value, float) or z3.is_fp(value):
        return reduce_term(make_float_bits(value, type_.size * 8))
    if isinstance(value, Pointer | Code):
        if type_.bits == 64 and value != NULL:
            return value
        value = addresses.compute_address(value)
    if isinstance(value, int):
        return value & ((1 << type_.bits) - 1)
    if z3.is_bool(value):
        return value if type_.bits == 1 else reduce_term(make_bits(value, type_.bits))
    if value.size() == type_.bits:
        return value
    cut = z3.Extract(type_.bits - 1, 0, value)
    return reduce_term(cut == 1 if type_.bits == 1 else cut)
