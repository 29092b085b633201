"""What memory and exceptions need of the executor that runs them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

import z3

from ..outcomes import CrashKind
from .layout import IrType
from .memory import AddressMap, MemoryObject
from .module import Code, Pointer
from .ranges import Ranges
from .state import Frame, State


class Machine(Protocol):
    """An executor, as its parts see it."""

    addresses: AddressMap
    made_globals: dict[int, tuple[str, MemoryObject]]
    type_numbers: dict[str, int]
    ranges: Ranges

    def make_crash(self, kind: CrashKind, detail: str) -> Any: ...

    def make_unknown(self, reason: str) -> Any: ...

    def make_any_byte(self, bits: int) -> z3.BitVecRef: ...

    def make_any_address(self, state: State) -> Any: ...

    def make_outside(self, state: State, memory_object: MemoryObject, type_: IrType) -> Any: ...

    def decide(self, state: State, condition: Any) -> bool: ...

    def require(
        self, state: State, condition: Any, crash: CrashKind, detail: str, also: tuple[Any, CrashKind] | None = None
    ) -> None: ...

    def choose(self, state: State, term: Any, values: Sequence[int]) -> int: ...

    def list_values(self, state: State, term: Any, bits: int, most: int) -> list[int] | None: ...

    def find_most(self, state: State, term: Any, most: int) -> int: ...

    def list_parts(self, value: Any, type_: IrType) -> list[Any]: ...

    def read(self, state: State, registers: dict[str, Any], operand: Any, type_: IrType) -> Any: ...

    def find_global(self, state: State, key: str) -> Pointer | Code: ...

    def add_object(self, state: State, size: int, kind: str, name: str, is_zeroed: bool = False) -> Pointer: ...

    def enter_block(self, state: State, frame: Frame, label: str) -> None: ...

    def leave_frame(self, state: State) -> None: ...
