"""Types of LLVM IR with their sizes and offsets in memory, as on x86-64 and arm64 Linux (both lay out alike)."""

from __future__ import annotations

from functools import cached_property

_INTEGER_BYTES = {1: 1, 8: 1, 16: 2, 32: 4, 64: 8, 128: 16}


class UnknownSizeError(Exception):
    """A type has no size that is known here."""


class IrType:
    """A type. size and alignment are in bytes."""

    size: int = 0
    alignment: int = 1
    # Ten thousands of types are asked for what they are; these are quicker than isinstance.
    is_integer = is_float = is_pointer = is_aggregate = False
    bits = 0


class VoidType(IrType):
    """void, label, token, metadata: nothing that lies in memory."""


class IntegerType(IrType):
    """iN."""

    is_integer = True

    def __init__(self, bits: int):
        self.bits = bits
        self.size = _INTEGER_BYTES.get(bits, 1 << max(0, ((bits + 7) // 8 - 1).bit_length()))
        self.alignment = min(self.size, 16)


class FloatType(IrType):
    """float (bits 32) and double (bits 64)."""

    is_float = True

    def __init__(self, bits: int):
        self.bits = bits
        self.size = self.alignment = bits // 8


class LongDoubleType(IrType):
    """x86_fp80, half and fp128: they have a size, but no arithmetic here."""

    def __init__(self, size: int):
        self.size = self.alignment = size


class PointerType(IrType):
    """ptr."""

    is_pointer = True
    bits = 64
    size = alignment = 8


class ArrayType(IrType):
    """[N x T], and <N x T>, whose elements are packed alike for the element types that occur."""

    is_aggregate = True

    def __init__(self, count: int, element: IrType, is_vector: bool):
        self.count = count
        self.element = element
        self.is_vector = is_vector

    @cached_property
    def size(self) -> int:  # pyright: ignore[reportIncompatibleVariableOverride]
        if self.is_vector and self.element.bits == 1:
            return (self.count + 7) // 8
        return self.count * self.element.size

    @cached_property
    def alignment(self) -> int:  # pyright: ignore[reportIncompatibleVariableOverride]
        return min(16, 1 << max(0, self.size - 1).bit_length()) if self.is_vector else self.element.alignment

    def locate(self, index: int) -> tuple[int, IrType]:
        """Offset and type of an element."""
        return index * self.element.size, self.element

    def list_parts(self) -> list[IrType]:
        return [self.element] * self.count


class StructureType(IrType):
    """{...}, packed or not."""

    is_aggregate = True

    def __init__(self, fields: list[IrType], is_packed: bool, is_opaque: bool = False):
        self.fields = fields
        self.is_packed = is_packed
        self.is_opaque = is_opaque

    @cached_property
    def offsets(self) -> list[int]:
        offsets, offset = [], 0
        for each in self.fields:
            if not self.is_packed:
                offset = -(-offset // each.alignment) * each.alignment
            offsets.append(offset)
            offset += each.size
        return offsets

    @cached_property
    def size(self) -> int:  # pyright: ignore[reportIncompatibleVariableOverride]
        if self.is_opaque:
            raise UnknownSizeError("opaque type")
        if not self.fields:
            return 0
        end = self.offsets[-1] + self.fields[-1].size
        return -(-end // self.alignment) * self.alignment

    @cached_property
    def alignment(self) -> int:  # pyright: ignore[reportIncompatibleVariableOverride]
        return 1 if self.is_packed else max((each.alignment for each in self.fields), default=1)

    def locate(self, index: int) -> tuple[int, IrType]:
        """Offset and type of a field."""
        return self.offsets[index], self.fields[index]

    def list_parts(self) -> list[IrType]:
        return self.fields


VOID = VoidType()
POINTER = PointerType()
DOUBLE = FloatType(64)
FLOAT = FloatType(32)
_INTEGERS = {bits: IntegerType(bits) for bits in (1, 8, 16, 32, 64, 128)}


def get_integer_type(bits: int) -> IntegerType:
    """iN, one object for each N."""
    if bits not in _INTEGERS:
        _INTEGERS[bits] = IntegerType(bits)
    return _INTEGERS[bits]
