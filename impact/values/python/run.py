"""One way through a callback: its decisions, what it did, and the solver that knows which ways there are."""

from __future__ import annotations

import builtins
import time
from collections.abc import Sequence
from typing import Any

import z3

from ..ir.solving import Solving
from ..outcomes import NOWHERE, Bounds, CodeLine, InputKind, Observable, Sent, SymbolicInput
from .terms import (
    FLOAT32,
    FLOAT64,
    NEAREST,
    BoundReachedError,
    ListValue,
    NotModelledError,
    Real,
    SymbolicText,
    Truth,
    Whole,
    count_bits,
    make_truth,
)  # fmt: skip

_SOLVER_MILLISECONDS = 1_000
_STEPS = 50_000
_STEPS_OF_PREPARATION = 20_000
GAVE_UP = "the solver gave up on a condition, so both ways are followed"
"""Stands among what is assumed."""


class PythonThrownError(Exception):
    """An exception of the program. name: of its class; bases: names of the classes that catch it as well; value: the
    object that `as` binds."""

    def __init__(self, name: str, detail: str, place: CodeLine, bases: tuple[str, ...] = (), value: Any = None):
        super().__init__(name)
        self.name, self.detail, self.place, self.bases, self.value = name, detail, place, bases, value

    def is_caught_by(self, name: str) -> bool:
        """Whether `except name` catches it."""
        if name in (self.name, *self.bases):
            return True
        own, other = getattr(builtins, self.name, None), getattr(builtins, name, None)
        bases = [getattr(builtins, base, None) for base in self.bases]
        return isinstance(other, type) and any(
            isinstance(one, type) and issubclass(one, other) for one in (own, *bases)
        )


class ProgramEndedError(Exception):
    """A program that runs from its start was followed far enough."""


class ProgramRounds:
    """The loops of a program that runs until somebody stops it: how far they are followed. is_cut: whether one went
    on."""

    def __init__(self, rounds: int = 3, sleeps: int = 12):
        self._rounds, self._sleeps = rounds, sleeps
        self.is_cut = False

    def is_up(self) -> bool:
        """Whether ROS is up, as a loop asks: for a few rounds."""
        self._rounds -= 1
        self.is_cut |= self._rounds < 0
        return self._rounds >= 0

    def sleep(self) -> None:
        """Raises ProgramEndedError where the program has slept so often that it is a loop without an end."""
        self._sleeps -= 1
        if self._sleeps < 0:
            self.is_cut = True
            raise ProgramEndedError


class PythonRun:
    """A way that begins with some decisions and goes on by itself. inputs: those of all ways, by path; open_ways: the
    decisions of ways that branch off this one. prepared: what conditions are while a node is made, None where both can
    be: the same on all ways, and filled by the first. solving: guesses values where the solver gives up; one for all
    ways."""

    def __init__(
        self, decisions: Sequence[bool], bounds: Bounds, inputs: dict[str, SymbolicInput], deadline: float,
        prepared: list[bool | None] | None = None, solving: Solving | None = None,
    ):  # fmt: skip
        self._decisions, self._taken = decisions, 0
        self.bounds, self.inputs, self.deadline = bounds, inputs, deadline
        self.condition: list[z3.BoolRef] = []
        self.open_ways: list[list[bool]] = []
        self._trace: list[bool] = []
        self._solver = z3.Solver()
        self._solver.set("timeout", _SOLVER_MILLISECONDS)
        self._model: z3.ModelRef | None = None
        self._found: z3.ModelRef | None = None
        self.effects: list[Observable] = []
        self.logs: list[str] = []
        self.sent: list[Sent] = []
        self.assumed: dict[str, None] = {}
        self.not_modelled: dict[str, None] = {}
        self.place = NOWHERE
        self.steps = 0
        self._fresh: dict[str, int] = {}
        self._solving = solving if solving is not None else Solving(deadline, inputs)
        self.program: ProgramRounds | None = None
        """Where what runs is a program from its start, and no callback."""
        self._prepared = prepared if prepared is not None else []
        self._asked = 0
        self.is_preparing = False
        """Whether a node is being made: no way is opened then, and what is undecided raises NotModelledError."""

    # Decisions.

    def assume(self, term: z3.BoolRef) -> None:
        """What holds on this way without being asked."""
        self.condition.append(term)
        self._solver.add(term)

    def decide(self, condition: Truth | bool) -> bool:
        """Whether a condition holds on this way; where both can be, the other way is opened."""
        if not isinstance(condition, Truth):
            return bool(condition)
        if self.is_preparing:
            return self._decide_once(condition.term)
        if self._taken < len(self._decisions):
            chosen = self._decisions[self._taken]
            self._taken += 1
            self._trace.append(chosen)
            self.assume(condition.term if chosen else z3.Not(condition.term))
            return chosen
        chosen = self._choose_way(condition.term)
        self._taken += 1
        self._trace.append(chosen)
        self.assume(condition.term if chosen else z3.Not(condition.term))
        return chosen

    def _decide_once(self, term: z3.BoolRef) -> bool:
        """Whether a condition holds while a node is made. Raises NotModelledError where it may and may not."""
        if self._asked == len(self._prepared):
            may_hold, may_fail = self._check(term), self._check(z3.Not(term))
            self._prepared.append(None if may_hold and may_fail else may_hold)
        answer = self._prepared[self._asked]
        self._asked += 1
        if answer is None:
            raise NotModelledError("a condition in a constructor")
        return answer

    def _choose_way(self, term: z3.BoolRef) -> bool:
        """Which way to go on; the other is opened where it can be gone too. The last model saves a question."""
        negated = z3.Not(term)
        known = self._model.eval(term, model_completion=True) if self._model is not None else None
        if known is not None and z3.is_true(known):
            if self._check(negated):
                self.open_ways.append([*self._trace, False])
            else:
                self._solving.note_impossible(negated)
            return True
        if known is not None and z3.is_false(known):
            kept = self._model
            if not self._check(term):
                self._solving.note_impossible(term)
                return False
            self.open_ways.append([*self._trace, True])
            self._model = kept
            return False
        if not self._check(term):
            self._solving.note_impossible(term)
            return False
        model = self._found
        if self._check(negated):
            self.open_ways.append([*self._trace, False])
        else:
            self._solving.note_impossible(negated)
        self._model = model
        return True

    def choose(self, name: str) -> bool:
        """One of two ways that nothing is known about; both are followed. name: what is assumed. Raises
        NotModelledError while a node is made."""
        if self.is_preparing:
            raise NotModelledError(f"whether {name}")
        self.assumed[name] = None
        if self._taken < len(self._decisions):
            chosen = self._decisions[self._taken]
        else:
            chosen = True
            self.open_ways.append([*self._trace, False])
        self._taken += 1
        self._trace.append(chosen)
        return chosen

    def _check(self, term: z3.BoolRef) -> bool:
        answer = self._solver.check(term)
        self._found = self._solver.model() if answer == z3.sat else None
        if answer == z3.unknown:
            if self._solving.is_impossible([*self.condition, term]):
                return False
            self._found = self._guess([*self.condition, term])
            if self._found is None:
                self.assumed[GAVE_UP] = None
        return answer != z3.unsat

    def _guess(self, condition: Sequence[z3.BoolRef]) -> z3.ModelRef | None:
        """A model that is guessed, and checked by calculating; None where none is found."""
        values = self._solving.guess(condition, {})
        if values is None:
            return None
        solver = z3.Solver()
        solver.add(*[self.inputs[name].term == value for name, value in values.items()])
        return solver.model() if solver.check() == z3.sat else None

    def is_possible(self) -> bool | None:
        """Whether some input takes this way; None where the solver does not know."""
        answer = self._solver.check()
        if answer == z3.unknown:
            if self._solving.is_impossible(self.condition):
                return False
            return True if self._guess(self.condition) is not None else None
        return answer == z3.sat

    def count_step(self) -> None:
        """Raises NotModelledError where the bounds are reached."""
        self.steps += 1
        if self.steps > (_STEPS_OF_PREPARATION if self.is_preparing else _STEPS):
            raise BoundReachedError("too many steps")
        if not self.steps & 63 and time.monotonic() > self.deadline:
            raise BoundReachedError("the time limit")

    def throw(self, name: str, detail: str = "") -> PythonThrownError:
        """The exception of Python of a name at the present place, to be raised."""
        return PythonThrownError(name, detail, self.place)

    # Inputs.

    def _get_input(self, path: str, kind: InputKind, bits: int, is_signed: bool, most: int = 0) -> z3.BitVecRef:
        known = self.inputs.get(path)
        if known is None:
            known = SymbolicInput(path, kind, bits, is_signed, z3.BitVec(path, bits), most)
            self.inputs[path] = known
        return known.term

    def get_whole(self, path: str, bits: int, is_signed: bool) -> Whole:
        """The input of a path, a whole number of some bits."""
        term = self._get_input(path, InputKind.INTEGER, bits, is_signed)
        if is_signed:
            return Whole(term, -(1 << (bits - 1)), (1 << (bits - 1)) - 1)
        high = (1 << bits) - 1
        wide = count_bits(0, high)
        return Whole(z3.ZeroExt(wide - bits, term) if wide > bits else term, 0, high)

    def get_number(self, path: str, most: int) -> Whole:
        """The input of a path, a whole number of 8 bits that is not above another one."""
        number = self.get_whole(path, 8, False)
        self._assume_once(path, z3.ULE(number.term, most))
        return Whole(number.term, 0, most)

    def get_truth(self, path: str) -> Truth:
        """The input of a path, true or false."""
        term = self._get_input(path, InputKind.BOOLEAN, 8, False)
        self._assume_once(path, z3.ULE(term, 1))
        return Truth(term != 0)

    def get_real(self, path: str, bits: int) -> Real:
        """The input of a path, a float of 32 or 64 bits."""
        if bits == 32:
            term = self._get_input(path, InputKind.FLOAT32, 32, True)
            single = z3.fpBVToFP(term, FLOAT32)
            return Real(z3.fpFPToFP(NEAREST, single, FLOAT64), single=single)
        return Real(z3.fpBVToFP(self._get_input(path, InputKind.FLOAT64, 64, True), FLOAT64))

    def note_default(self, path: str, value: Any) -> None:
        """Keeps what an input is where nobody sets it, where that is a plain value."""
        known = self.inputs.get(path)
        if known is not None and isinstance(value, (bool, int, float, str)):
            self.inputs[path] = known._replace(default=value)

    def get_size(self, path: str, most: int) -> Whole:
        """The size of what stands at a path, 0 to most."""
        name = f"{path}.size"
        term = self._get_input(name, InputKind.SIZE, 64, False, most)
        self._assume_once(name, z3.ULE(term, most))
        bits = count_bits(0, most)
        return Whole(z3.Extract(bits - 1, 0, term), 0, most)

    def note_size(self, size: Any, number: Any) -> None:
        """Takes in that the size of an array or text was compared with a number that only larger ones come to."""
        if isinstance(size, Whole) and type(number) is int and number > size.high and z3.is_app(size.term):
            for name in self._solving.find_traits(size.term).names:
                if (known := self.inputs.get(name)) is not None and known.kind is InputKind.SIZE:
                    self._solving.exceeded.add(name)

    def get_text(self, path: str) -> SymbolicText:
        """The input of a path, a text of ASCII."""
        size = self.get_size(path, self.bounds.text)
        characters: list[z3.BitVecRef | int] = []
        for index in range(self.bounds.text):
            name = f"{path}[{index}]"
            term = self._get_input(name, InputKind.CHARACTER, 8, False)
            self._assume_once(name, z3.ULE(term, 127))
            characters.append(term)
        return SymbolicText(tuple(characters), size)

    def _assume_once(self, name: str, term: z3.BoolRef) -> None:
        if name not in self._fresh:
            self._fresh[name] = 1
            self.assume(term)

    def make_name(self, stem: str) -> str:
        """A name for what the callback asks of its surroundings, another one each time: `~now`, `~now#2`."""
        count = self._fresh[stem] = self._fresh.get(stem, 0) + 1
        return stem if count == 1 else f"{stem}#{count}"

    # Sizes.

    def fix_text(self, text: SymbolicText) -> tuple[z3.BitVecRef | int, ...]:
        """The characters of a text whose size is decided on."""
        if text.size is None:
            return text.characters
        return text.characters[: self.fix_size(text.size)]

    def fix_items(self, items: ListValue) -> list[Any]:
        """The elements of a list whose size is decided on; from then on it is known."""
        if items.size is not None:
            count = self.fix_size(items.size)
            del items.elements[count:]
            items.size = None
        return items.elements

    def fix_size(self, size: Whole | int) -> int:
        """One number for a size on this way."""
        if not isinstance(size, Whole):
            return int(size)
        for count in range(size.low, size.high):
            if self.decide(make_truth(size.term == count)):
                return count
        return size.high

    # What others see.

    def note_effect(self, kind: str, name: str) -> None:
        """Something that others can observe."""
        self.effects.append(Observable(kind, name, self.place))
