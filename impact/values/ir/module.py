"""A module of LLVM IR as the executor reads it: functions, blocks, instructions, operands."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

from .layout import IrType


class ReadingError(Exception):
    """BytesConstant that is not understood: what stands there."""


class UndefinedValue:
    """undef and poison, and bytes that nobody wrote: any value."""

    def __repr__(self):
        return "undefined"


UNDEFINED = UndefinedValue()


class Pointer(NamedTuple):
    """An address: the number of an object and an offset into it (int, or a z3 bit vector of 64 bits). Object 0 is
    what null points to."""

    object: int
    offset: Any


class Code(NamedTuple):
    """The address of a function."""

    name: str


NULL = Pointer(0, 0)


class GlobalName(NamedTuple):
    """An operand: the address of a global variable or a function."""

    name: str


class Computed(NamedTuple):
    """An operand: a constant expression. what: `gep`, `cast` or an operation on integers."""

    what: str
    type: IrType
    operands: tuple


class Composite(NamedTuple):
    """An operand: an aggregate of operands, with their types."""

    parts: tuple[tuple[IrType, Any], ...]


class Zeros(NamedTuple):
    """An operand: an aggregate of zeros."""

    type: IrType


class BytesConstant(NamedTuple):
    """An operand: an array of bytes."""

    content: bytes


class Argument(NamedTuple):
    """An argument of a call. copied: the type of what is passed by a copy in memory (byval), or None. extent: the bytes
    that an address is of, 0 where that is not said."""

    type: IrType
    operand: Any
    copied: IrType | None
    extent: int = 0


class Instruction:
    """One instruction. result: register that is set, or "". operands and extra: as `reader.py` writes them for the
    opcode. location: number of its DILocation, 0 where there is none."""

    __slots__ = ("extra", "location", "opcode", "operands", "result", "type")

    def __init__(self, opcode: str, result: str, type_: IrType, operands: tuple, extra: Any = None):
        self.opcode = opcode
        self.result = result
        self.type = type_
        self.operands = operands
        self.extra = extra
        self.location = 0

    def __repr__(self):
        return f"{self.result} = {self.opcode} {self.operands} {self.extra}"


@dataclass
class BasicBlock:
    """A basic block. phis are at its start and run at once. number: its place in the function."""

    label: str
    number: int
    phis: list[Instruction]
    instructions: list[Instruction]


@dataclass
class Function:
    """A function with its body. key: its name among all modules. subprogram: number of its DISubprogram."""

    key: str
    name: str
    parameters: list[str]
    blocks: dict[str, BasicBlock]
    entry: str
    unit: Any
    subprogram: int = 0

    @cached_property
    def phis(self) -> list[Instruction]:
        """Those of all blocks."""
        return [phi for block in self.blocks.values() for phi in block.phis]


@dataclass
class GlobalVariable:
    """A global variable. value: its initial operand, None where another module has it."""

    key: str
    name: str
    type: IrType
    value: Any
    is_constant: bool
