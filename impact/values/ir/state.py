"""Where one way through the program stands: frames, memory, conditions, what was observed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import z3

from ..outcomes import CodeLine, Observable, Sent
from .memory import MemoryObject
from .module import BasicBlock, Function, Instruction, Pointer


class Raised(NamedTuple):
    """A C++ exception in flight. address: of the object; info: key of its typeinfo; place: where it was thrown;
    adjusted: the part of it that is caught."""

    address: Pointer
    info: str
    place: CodeLine
    adjusted: Any


class Visit(NamedTuple):
    """A block as it was entered before: by these registers, with this memory. conditions: how many there were."""

    registers: Mapping[str, Any]
    objects: Mapping[int, MemoryObject]
    conditions: int
    inputs: int


class Frame:
    """A call that runs. registers: by name. block, index: the next instruction; arrived_from: label of the block
    before. growing: how often each block was entered with new conditions."""

    __slots__ = (
        "arrived_from", "block", "function", "growing", "index", "locals", "registers", "saved", "visits",
    )  # fmt: skip

    def __init__(self, function: Function, registers: dict[str, Any]):
        self.function = function
        self.registers = registers
        self.block: BasicBlock = function.blocks[function.entry]
        self.index = 0
        self.arrived_from = ""
        self.locals: list[int] = []
        self.visits: dict[int, int] = {}
        self.saved: dict[int, Visit] = {}
        self.growing: dict[int, int] = {}

    def copy(self) -> Frame:
        twin = Frame.__new__(Frame)
        twin.function = self.function
        twin.registers = dict(self.registers)
        twin.block = self.block
        twin.index = self.index
        twin.arrived_from = self.arrived_from
        twin.locals = list(self.locals)
        twin.visits = dict(self.visits)
        twin.saved = dict(self.saved)
        twin.growing = dict(self.growing)
        return twin

    def get_instruction(self) -> Instruction:
        return self.block.instructions[self.index]


class Member(NamedTuple):
    """A member of the node as it was when the callback began."""

    name: str
    address: Pointer
    size: int
    objects: Mapping[int, MemoryObject]


class State:
    """One way through the program. model: values of the variables that lead here."""

    def __init__(self):
        self.owner = object()
        self.frames: list[Frame] = []
        self.shared_frames = 0
        self.objects: dict[int, MemoryObject] = {}
        self.conditions: list[z3.BoolRef] = []
        self.known: dict[int, bool] = {}
        self.model: dict[str, int] = {}
        self.effects: tuple[Observable, ...] = ()
        self.logs: tuple[str, ...] = ()
        self.sent: tuple[Sent, ...] = ()
        self.has_begun = False
        # How many conditions there were when the callback began.
        self.begun_at = 0
        # Whether members are as nobody knows when the callback begins.
        self.has_forgotten = False
        self.path: tuple[str, ...] = ()
        self.sending: Sent | None = None
        self.members: tuple[Member, ...] = ()
        # What was called and is not known, and what else was taken for granted.
        self.notes: tuple[str, ...] = ()
        self.assumed_notes: tuple[str, ...] = ()
        self.raised: Raised | None = None
        self.caught: tuple[Raised, ...] = ()
        # Decisions of the instruction that runs: those that it takes again after a fork, and those taken.
        self.replay: tuple[bool, ...] = ()
        self.taken: tuple[bool, ...] = ()
        self.steps = 0
        # Functions that run when the last frame is left: those that initialize variables, then the entry.
        self.upcoming: tuple[str, ...] = ()
        # Numbers of calls of one kind on this way, for inputs that are new with each.
        self.counts: dict[str, int] = {}
        self.values: dict[str, Any] = {}

    def fork(self) -> State:
        twin = State.__new__(State)
        twin.__dict__.update(self.__dict__)
        twin.owner, self.owner = object(), object()
        # The topmost frame of both is their own: an instruction that has forked still writes to it.
        twin.frames = list(self.frames)
        twin.frames[-1] = self.frames[-1].copy()
        twin.shared_frames = self.shared_frames = len(self.frames) - 1
        twin.objects = dict(self.objects)
        twin.conditions = list(self.conditions)
        twin.known = dict(self.known)
        twin.model = dict(self.model)
        twin.counts = dict(self.counts)
        twin.values = dict(self.values)
        return twin

    def get_frame(self) -> Frame:
        """The topmost frame, which nobody else has."""
        number = len(self.frames) - 1
        if number < self.shared_frames:
            self.frames[number] = self.frames[number].copy()
            self.shared_frames = number
        return self.frames[number]

    def take_object(self, number: int) -> MemoryObject:
        """An object to write to."""
        found = self.objects[number]
        if found.owner is not self.owner:
            found = found.copy(self.owner)
            self.objects[number] = found
        return found
