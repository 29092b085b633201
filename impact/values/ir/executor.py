"""The symbolic executor: runs a function of a program on symbolic inputs, one way after the other.

An instruction that has to decide (a branch, an index, a division) asks `decide`; where both answers are possible, the
state forks, and the twin runs the same instruction again with the other answer. So an instruction changes nothing
before its last decision. Every state has a model, values of the inputs that lead to it: one side of a decision needs no
solver.
"""

from __future__ import annotations

import ctypes
import math
import os
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import z3

from ..outcomes import (
    NOWHERE,
    Bounds,
    CallbackPath,
    CodeLine,
    CrashKind,
    Exploration,
    InputKind,
    Observable,
    Reaction,
    UnknownFunction,
)
from .access import fill_cells, load, read_scalar, require_access, store
from .doubtful import DoubtfulCrash, list_certain
from .exceptions import fill_standard_table, find_handler, get_raised, is_standard_exception, unwind
from .layout import ArrayType, IrType, StructureType, UnknownSizeError, get_integer_type
from .memory import AddressMap, MemoryObject, interpret_raw, read_raw
from .module import (
    NULL,
    UNDEFINED,
    Argument,
    BytesConstant,
    Code,
    Composite,
    Computed,
    Function,
    GlobalName,
    GlobalVariable,
    Instruction,
    Pointer,
    ReadingError,
    Zeros,
)
from .places import PlaceReader
from .ranges import Ranges
from .reader import FLOAT_OPERATIONS, INTEGER_OPERATIONS, Program
from .solving import Model, SolverTimeout, Solving, is_certain
from .state import Frame, Raised, State, Visit
from .terms import (
    add_offsets,
    choose_term,
    compare_floats,
    compare_integers,
    compute_float,
    compute_integer,
    convert_float,
    convert_float_to_integer,
    convert_integer_to_float,
    is_term,
    join_truths,
    make_bits,
    make_float,
    make_float_bits,
    make_truth,
    negate_truth,
    read_float_bits,
    read_signed,
    reduce_term,
    scale_index,
)

_DEEPEST = 300
_MOST_STEPS = 3_000_000
_OF_HARNESS = ("ri_begin", "ri_end", "ri_assume")
# Variables of libraries that have a known value: the callback runs alone.
_KNOWN_OUTSIDE = {"__libc_single_threaded": 1}


class Ended(Exception):
    """A way ends here. result: None where it cannot happen."""

    def __init__(self, result: Reaction | None, crash: CrashKind | None = None, detail: str = "", reason: str = ""):
        super().__init__(detail or reason)
        self.result = result
        self.crash = crash
        self.detail = detail
        self.reason = reason
        self.place: CodeLine | None = None


class ThrownError(Exception):
    """An exception of the program is thrown by the instruction that runs."""

    def __init__(self, raised: Raised):
        super().__init__(raised.info)
        self.raised = raised


class Moved:
    """What a modelled call gives that has itself put another frame on top, or gone elsewhere."""


MOVED = Moved()


class Call(NamedTuple):
    """A call of a function that is modelled. name: mangled; arguments and their types as they were passed."""

    run: Executor
    state: State
    instruction: Instruction
    name: str
    arguments: list[Any]
    types: list[IrType]


CallModel = Callable[[Call], Any]

# Variables of the C library that change how something is done, and not what.
_SETTINGS = frozenset(("__libc_single_threaded",))


class Executor:
    """One exploration of one function. find_call_model: what is called instead of a function of some name.
    fill_outside: fills a variable that no module defines."""

    def __init__(
        self,
        program: Program,
        bounds: Bounds,
        is_workspace_file: Callable[[str], bool],
        find_call_model: Callable[[str], CallModel | None],
        fill_outside: Callable[[Executor, str, MemoryObject], None],
    ):
        self.program = program
        self.bounds = bounds
        self.started = time.monotonic()
        self.deadline = self.started + bounds.seconds
        self.memory_before = read_memory_in_use()
        self.solving = Solving(self.deadline)
        self.ranges = Ranges(self.solving.inputs)
        self.places = PlaceReader(is_workspace_file)
        self.addresses = AddressMap()
        self.exploration = Exploration(inputs={}, bounds=bounds)
        self.pending: list[State] = []
        # Places among the paths of those on which the callback had not begun.
        self.early: list[int] = []
        self.doubtful: list[DoubtfulCrash] = []
        # The conditions under which the callback began, of each way that came there.
        self.begun: dict[tuple[int, ...], tuple[z3.BoolRef, ...]] = {}
        self.globals: dict[str, int] = {}
        self.made_globals: dict[int, tuple[str, MemoryObject]] = {}
        self.instructions = 0
        self.current: State | None = None
        self.kept: list[Any] = []
        self.type_numbers: dict[str, int] = {}
        self._find_call_model = find_call_model
        self._fill_outside = fill_outside
        self._models: dict[str, CallModel | None] = {}
        self._loop_bound = max(bounds.loops, bounds.text + 2, bounds.array + 2)
        self._handlers: dict[str, Callable[[State, Frame, Instruction], None]] = {
            "icmp": self._run_icmp,
            "fcmp": self._run_fcmp,
            "fneg": self._run_fneg,
            "freeze": self._run_freeze,
            "cast": self._run_cast,
            "alloca": self._run_alloca,
            "load": self._run_load,
            "store": self._run_store,
            "atomicrmw": self._run_atomic,
            "cmpxchg": self._run_compare_exchange,
            "fence": self._run_nothing,
            "gep": self._run_gep,
            "jump": self._run_jump,
            "br": self._run_branch,
            "switch": self._run_switch,
            "select": self._run_select,
            "ret": self._run_return,
            "call": self._run_call,
            "landingpad": self._run_landing,
            "resume": self._run_resume,
            "unreachable": self._run_unreachable,
            "extractvalue": self._run_extract,
            "insertvalue": self._run_insert,
            "extractelement": self._run_extract_lane,
            "insertelement": self._run_insert_lane,
            "shufflevector": self._run_shuffle,
            "asm": self._run_assembly,
        }
        self._handlers.update(dict.fromkeys(INTEGER_OPERATIONS, self._run_integer))
        self._handlers.update(dict.fromkeys(FLOAT_OPERATIONS, self._run_float))

    # What is made.

    def make_crash(self, kind: CrashKind, detail: str) -> Ended:
        return Ended(Reaction.CRASH, crash=kind, detail=detail)

    def make_unknown(self, reason: str) -> Ended:
        return Ended(Reaction.UNKNOWN, reason=reason)

    def make_any(self, state: State, what: str, bits: int, kind: InputKind = InputKind.INTEGER) -> z3.BitVecRef:
        """A new variable that is no input; what: what it stands for. Bits of a float for the kinds of floats."""
        number = state.counts.get("any", 0)
        state.counts["any"] = number + 1
        path = f"~{what}#{number}.{bits}"
        self.solving.assumed[path] = what
        return self.solving.make_input(path, kind, bits).term

    def make_any_byte(self, bits: int) -> z3.BitVecRef:
        assert self.current is not None
        return self.make_any(self.current, _UNWRITTEN, bits)

    def make_any_scalar(self, state: State, what: str, type_: IrType) -> Any:
        """Any value of a scalar type; ends the way for one that is an address."""
        if type_.is_integer:
            term = self.make_any(state, what, max(8, type_.bits))
            return reduce_term(z3.Extract(0, 0, term) == 1) if type_.bits == 1 else term
        if type_.is_float:
            kind = InputKind.FLOAT64 if type_.bits == 64 else InputKind.FLOAT32
            return read_float_bits(self.make_any(state, what, type_.bits, kind), type_.bits)
        raise self.make_unknown(what)

    def make_any_address(self, state: State) -> Pointer:
        """An address that is not known: none, or that of an object of its own that nothing is known of. What is written
        there is not seen to do nothing."""
        if self.decide(state, self.make_any(state, _UNWRITTEN, 8) == 0):
            return NULL
        if _OTHER not in state.notes:
            state.notes = (*state.notes, _OTHER)
        return self.add_object(state, _OTHER_SIZE, "other", _OTHER)

    def make_derived(
        self, state: State, what: str, compute: Callable[..., float], arguments: Sequence[Any], bits: int
    ) -> Any:
        """A float that is a function of others, which z3 does not know. The same one for the same arguments."""
        key = (
            what
            + ":"
            + ",".join(str(each.get_id()) if isinstance(each, z3.ExprRef) else repr(each) for each in arguments)
        )
        if key not in state.values:
            self.kept.extend(arguments)
            path = f"~{what}#{len(self.solving.derived)}"
            self.solving.assumed[path] = what
            self.solving.derived[path] = UnknownFunction(compute, tuple(arguments), bits)
            kind = InputKind.FLOAT64 if bits == 64 else InputKind.FLOAT32
            term = self.solving.make_input(path, kind, bits).term
            self.solving.settle(state.model, (path,))
            state.values[key] = read_float_bits(term, bits)
        return state.values[key]

    def make_outside(self, state: State, memory_object: MemoryObject, type_: IrType) -> Any:
        if memory_object.name.lstrip("@") in _SETTINGS:
            return 1
        return self.make_any_scalar(state, f"variable {memory_object.name}", type_)

    def add_object(self, state: State, size: int, kind: str, name: str, is_zeroed: bool = False) -> Pointer:
        number = self.addresses.add(size)
        state.objects[number] = MemoryObject(size, kind, name, state.owner, is_zeroed)
        return Pointer(number, 0)

    def free_object(self, state: State, number: int):
        memory_object = state.take_object(number)
        memory_object.is_live = False
        memory_object.cells = {}

    def find_variable(self, state: State, name: str, size: int) -> Pointer:
        """A variable of the surroundings that no module has (errno)."""
        number = self.globals.get(f"~{name}")
        if number is None:
            number = self.addresses.add(size)
            self.globals[f"~{name}"] = number
            self.made_globals[number] = (name, MemoryObject(size, "global", name, None, True))
        if number not in state.objects:
            state.objects[number] = self.made_globals[number][1]
        return Pointer(number, 0)

    # Globals.

    def find_global(self, state: State, key: str) -> Pointer | Code:
        """The address of a variable or function; a variable is filled when it is asked for first."""
        if self.program.is_function(key):
            return Code(key)
        number = self.globals.get(key)
        if number is None:
            variable = self.program.get_variable(key)
            if isinstance(variable, str):
                return self.find_global(state, variable)
            number = self._make_global(key, variable)
        if number not in state.objects:
            state.objects[number] = self.made_globals[number][1]
        return Pointer(number, 0)

    def _make_global(self, key: str, variable: GlobalVariable | None) -> int:
        try:
            size = variable.type.size if variable is not None else 4096
        except (UnknownSizeError, ReadingError):
            size = 4096
        number = self.addresses.add(max(size, 1))
        self.globals[key] = number
        is_outside = variable is None or variable.value is None
        is_constant = variable is not None and variable.is_constant
        kind = "outside" if is_outside else "constant" if is_constant else "global"
        memory_object = MemoryObject(max(size, 4096) if is_outside else size, kind, key, None, not is_outside)
        self.made_globals[number] = (key, memory_object)
        if key in _KNOWN_OUTSIDE:
            memory_object.cells[0] = (1, _KNOWN_OUTSIDE[key])
        if is_outside:
            self._fill_outside(self, key, memory_object)
        if is_outside and is_standard_exception(key.removeprefix("_ZTV")):
            fill_standard_table(self, State(), key, memory_object)
        if variable is not None and variable.value is not None:
            scratch = State()
            self._write_initial(scratch, memory_object, 0, variable.type, variable.value)
        return number

    def _write_initial(self, state: State, memory_object: MemoryObject, offset: int, type_: IrType, operand: Any):
        if isinstance(operand, Zeros) or operand is UNDEFINED:
            return
        if isinstance(operand, BytesConstant):
            for index, byte in enumerate(operand.content):
                if byte:
                    memory_object.cells[offset + index] = (1, byte)
        elif isinstance(operand, Composite):
            for index, (part, each) in enumerate(operand.parts):
                place, _ = type_.locate(index)  # pyright: ignore[reportAttributeAccessIssue]
                self._write_initial(state, memory_object, offset + place, part, each)
        else:
            value = self.read(state, {}, operand, type_)
            if not (isinstance(value, int) and value == 0):
                memory_object.cells[offset] = (type_.size, value)

    # Operands.

    def read(self, state: State, registers: dict[str, Any], operand: Any, type_: IrType) -> Any:
        """The value of an operand."""
        if isinstance(operand, str):
            return registers[operand]
        if isinstance(operand, int | float | Pointer) or operand is UNDEFINED:
            return operand
        if isinstance(operand, GlobalName):
            return self.find_global(state, operand.name)
        if isinstance(operand, Zeros):
            return self._make_zeros(operand.type)
        if isinstance(operand, Composite):
            return [self.read(state, registers, each, part) for part, each in operand.parts]
        if isinstance(operand, BytesConstant):
            return list(operand.content)
        if isinstance(operand, Computed):
            return self._compute_constant(state, operand)
        raise self.make_unknown(f"operand {operand!r}")

    def _make_zeros(self, type_: IrType) -> Any:
        if type_.is_aggregate:
            return [self._make_zeros(part) for part in type_.list_parts()]  # pyright: ignore[reportAttributeAccessIssue]
        return 0.0 if type_.is_float else NULL if type_.is_pointer else 0

    def _compute_constant(self, state: State, operand: Computed) -> Any:
        if operand.what == "gep":
            source, parts = operand.operands
            values = [self.read(state, {}, each, type_) for type_, each in parts]
            return self._add_indices(values[0], source, [type_ for type_, _ in parts[1:]], values[1:])
        if operand.what == "cast":
            name, source, inner = operand.operands
            return self.convert(name, self.read(state, {}, inner, source), source, operand.type)
        if operand.what == "icmp":
            predicate, (type_, left), (_, right) = operand.operands
            return self.compare(predicate, self.read(state, {}, left, type_), self.read(state, {}, right, type_), type_)
        if operand.what == "select":
            (_, condition), (type_, first), (_, second) = operand.operands
            return self.read(state, {}, first if self.read(state, {}, condition, type_) else second, type_)
        (type_, left), (_, right) = operand.operands
        return self.compute(operand.what, self.read(state, {}, left, type_), self.read(state, {}, right, type_), type_)

    def list_parts(self, value: Any, type_: IrType) -> list[Any]:
        """The parts of an aggregate, also of one that is not defined."""
        if isinstance(value, list):
            return value
        return [UNDEFINED] * len(type_.list_parts())  # pyright: ignore[reportAttributeAccessIssue]

    def define(self, state: State, value: Any, type_: IrType) -> Any:
        """A value to calculate with: what is not defined is any."""
        if value is UNDEFINED:
            if type_.is_pointer:
                raise self.make_unknown("an address that nobody wrote is used")
            return self.make_any_scalar(state, _UNWRITTEN, type_)
        return value

    # Conditions.

    def decide(self, state: State, condition: Any) -> bool:
        """Whether a condition holds; forks where it may and may not."""
        if isinstance(condition, int):
            return bool(condition)
        number = len(state.taken)
        if number < len(state.replay):
            answer = state.replay[number]
            state.taken = (*state.taken, answer)
            return answer
        condition = make_truth(condition)
        known = state.known.get(condition.get_id())
        if known is not None:
            state.taken = (*state.taken, known)
            return known
        opposite = negate_truth(condition)
        if isinstance(opposite, int):
            state.taken = (*state.taken, not opposite)
            return not opposite
        held = self.solving.evaluate(condition, state.model)
        if not isinstance(held, int):
            # The model leaves it open: a float that no integer holds, as an integer.
            model = self._ask(state, condition)
            if model is _UNDECIDED:
                raise self.make_unknown(_NO_ANSWER)
            if model is None:
                self.solving.note_impossible(condition)
                self._note_known(state, condition, False)
                state.taken = (*state.taken, False)
                return False
            held = 1
            state.model.update(model)
        first, second = (condition, opposite) if held == 1 else (opposite, condition)
        answer = held == 1
        other = self._ask(state, second)
        if other is _UNDECIDED:
            self._record(state, self.make_unknown(_NO_ANSWER), extra=second, model={})
            self._add_condition(state, first)
        elif other is not None:
            twin = state.fork()
            twin.replay = (*state.taken, not answer)
            twin.taken = ()
            self._add_condition(twin, second)
            twin.model.update(other)
            self._note_known(twin, condition, not answer)
            self.pending.append(twin)
            self._add_condition(state, first)
        else:
            self.solving.note_impossible(second)
        self._note_known(state, condition, answer)
        state.taken = (*state.taken, answer)
        return answer

    def _note_known(self, state: State, condition: z3.BoolRef, answer: bool):
        self.kept.append(condition)
        state.known[condition.get_id()] = answer

    def _add_condition(self, state: State, condition: z3.BoolRef):
        state.conditions.append(condition)
        state.known[condition.get_id()] = True

    def _ask(self, state: State, condition: z3.BoolRef) -> Any:
        """A model of a condition beside those of a state, for the variables that are tied to it; None where there is
        none, `_UNDECIDED` where the solver does not know."""
        if self.ranges.is_impossible(condition):
            return None
        related = self.solving.select_related(state.conditions, self.solving.find_traits(condition).names)
        try:
            return self.solving.find_model([*related, condition], state.model)
        except SolverTimeout:
            return _UNDECIDED

    def assume(self, state: State, condition: Any):
        """Goes on only where a condition holds."""
        if isinstance(condition, int):
            if not condition:
                raise Ended(None)
            return
        condition = make_truth(condition)
        known = state.known.get(condition.get_id())
        if known is True:
            return
        if known is False:
            raise Ended(None)
        if not is_certain(self.solving.evaluate(condition, state.model)):
            model = self._ask(state, condition)
            if model is None:
                raise Ended(None)
            if model is _UNDECIDED:
                raise self.make_unknown(_NO_ANSWER)
            state.model.update(model)
        self._add_condition(state, condition)

    def require(
        self, state: State, condition: Any, crash: CrashKind, detail: str, also: tuple[Any, CrashKind] | None = None
    ):
        """A way ends in a crash where the condition does not hold. also: a condition under which it is another kind."""
        if isinstance(condition, int):
            if not condition:
                if also is not None and self.decide(state, also[0]):
                    raise self.make_crash(also[1], detail)
                raise self.make_crash(crash, detail)
            return
        condition = make_truth(condition)
        if state.known.get(condition.get_id()):
            return
        opposite = make_truth(negate_truth(condition))
        cases = [(opposite, crash)]
        if also is not None and not isinstance(also[0], int):
            cases = [
                (make_truth(join_truths(opposite, also[0])), also[1]),
                (make_truth(join_truths(opposite, negate_truth(also[0]))), crash),
            ]
        for failure, kind in cases:
            model = self._ask(state, failure)
            if model is None:
                continue
            if model is _UNDECIDED:
                self._record(state, self.make_unknown(_NO_ANSWER), extra=failure, model={})
            else:
                end = Ended(Reaction.CRASH, crash=kind, detail=detail)
                self._record(state, end, extra=failure, model={**state.model, **model})
        self.assume(state, condition)

    def choose(self, state: State, term: Any, values: Sequence[int]) -> int:
        """One of the values that a term can have; forks."""
        for value in values:
            if self.decide(state, reduce_term(term == value)):
                return value
        raise Ended(None)

    def list_values(self, state: State, term: Any, bits: int, most: int) -> list[int] | None:
        """All values that a term can have here, or None where there are more than some."""
        if isinstance(term, int):
            return [term]
        names = self.solving.find_traits(term).names
        conditions = self.solving.select_related(state.conditions, names)
        found: list[int] = []
        model: Any = state.model
        excluded: list[z3.BoolRef] = []
        while len(found) <= most:
            value = self.solving.evaluate(term, model) if model is not None else None
            if not isinstance(value, int) or value in found:
                try:
                    model = (
                        self.solving.find_model([*conditions, *excluded], state.model)
                        if (conditions or excluded)
                        else {}
                    )
                except SolverTimeout:
                    return None
                if model is None:
                    return found
                value = self.solving.evaluate(term, model)
                if not isinstance(value, int):
                    return None
            found.append(value)
            excluded.append(term != z3.BitVecVal(value, bits))
            model = None
        return None

    def find_most(self, state: State, term: Any, most: int) -> int:
        """A number that a term does not exceed; most if it may."""
        if isinstance(term, int):
            return min(term, most)
        value = self.solving.evaluate(term, state.model)
        low = min(value, most) if isinstance(value, int) else 0
        high = most
        while low < high:
            middle = (low + high) // 2
            model = self._ask(state, z3.UGT(term, middle))
            if model is None:
                high = middle
            elif model is _UNDECIDED:
                return most
            else:
                value = self.solving.evaluate(term, {**(state.model), **model})
                low = min(max(middle + 1, value if isinstance(value, int) else 0), most)
        return high

    # Running.

    def explore(self, entry: str) -> Exploration:
        """All ways through a function without parameters, after the variables of all modules are initialized."""
        state = State()
        if not self.program.has_body(entry):
            self.exploration.paths.append(CallbackPath(Reaction.UNKNOWN, (), reason=f"there is no function `{entry}`"))
            return self.exploration
        first, *later = *(key for key in self.program.list_constructors() if self.program.has_body(key)), entry
        state.upcoming = tuple(later)
        try:
            self._push(state, self.program.get_function(first), [], [])
        except (ReadingError, UnknownSizeError, ValueError, LookupError) as problem:
            unread = CallbackPath(Reaction.UNKNOWN, (), reason=f"`{first}` cannot be read: {problem}")
            self.exploration.paths.append(unread)
            return self.exploration
        self.pending.append(state)
        while self.pending:
            if self._is_over():
                self.exploration.left = len(self.pending)
                break
            self._run_way(self.pending.pop())
        self._restore_crashes()
        self._exclude_early()
        self.exploration.inputs.update(self.solving.inputs)
        self.exploration.functions.update(self.solving.derived)
        self.exploration.exceeded = frozenset(self.solving.exceeded)
        self.exploration.instructions = self.instructions
        self.exploration.seconds = time.monotonic() - self.started
        return self.exploration

    def _restore_crashes(self):
        """A crash that comes whatever the values are that nothing is known of is one."""
        paths = self.exploration.paths
        for one in self.pending:
            self._note_beginning(one)
        begun = list(self.begun.values())
        for one in list_certain(self.doubtful, paths, self._find_open_names, begun):
            paths[one.number] = replace(paths[one.number], result=Reaction.CRASH, crash=one.kind, reason="")

    def _find_open_names(self, condition: z3.BoolRef) -> set[str]:
        """The inputs that a condition speaks of; what nobody has written is none that is known, either."""
        assumed = self.solving.assumed
        names = self.solving.find_traits(condition).names
        return {f"~foreign {name}" if assumed.get(name) == _UNWRITTEN else name for name in names}

    def _note_beginning(self, state: State):
        if state.has_begun:
            conditions = tuple(state.conditions[: state.begun_at])
            self.begun.setdefault(tuple(each.get_id() for each in conditions), conditions)

    def _exclude_early(self):
        """Where the harness says when the callback begins, what happened before is none of it."""
        paths = self.exploration.paths
        # A harness in which the callback cannot begin has no call that says so.
        if len(self.early) == len(paths) and not any(map(self.program.is_function, _OF_HARNESS)):
            return
        for number in self.early:
            path = paths[number]
            if path.result is not Reaction.UNKNOWN:
                what = path.crash.value if path.crash is not None else "the end of the program"
                reason = f"{what} before the callback begins"
                paths[number] = replace(path, result=Reaction.UNKNOWN, crash=None, reason=reason, effects=(), logs=())

    def _is_over(self) -> bool:
        return (
            time.monotonic() > self.deadline
            or len(self.exploration.paths) >= self.bounds.paths
            or read_memory_in_use() - self.memory_before > self.bounds.memory
        )

    def _run_way(self, state: State):
        """One state to the end of its way. Whatever goes wrong in the tool ends the way as unknown."""
        self.current = state
        try:
            while True:
                try:
                    self._step(state)
                except Ended as end:
                    if not self._go_on(state, end):
                        self._record(state, end)
                        return
        except (MemoryError, RecursionError, z3.Z3Exception, ctypes.ArgumentError, ArithmeticError, LookupError,
                TypeError, ValueError, AttributeError, AssertionError, ReadingError,
                UnknownSizeError) as problem:  # fmt: skip
            instruction = state.frames[-1].get_instruction() if state.frames else None
            what = instruction.opcode if instruction is not None else "the end"
            if os.environ.get("ROSIMPACT_VALUES_RAISE"):
                raise
            reason = f"the executor failed on `{what}`: {type(problem).__name__}: {problem}"
            self._record(state, Ended(Reaction.UNKNOWN, reason=reason))

    def _go_on(self, state: State, end: Ended) -> bool:
        """Whether another function runs after one that ended: what initializes variables may fail."""
        if not state.upcoming or end.result not in (Reaction.UNKNOWN, Reaction.IGNORED) or state.has_begun:
            return False
        if end.result is Reaction.UNKNOWN:
            if time.monotonic() > self.deadline:
                return False
            name = state.frames[0].function.name if state.frames else ""
            state.notes = (*state.notes, f"variables that `{name}` initializes ({end.reason})")
            while state.frames:
                self.leave_frame(state)
        key, *rest = state.upcoming
        state.upcoming = tuple(rest)
        state.replay = ()
        self._push(state, self.program.get_function(key), [], [])
        return True

    def _step(self, state: State):
        frame = state.get_frame()
        instruction = frame.block.instructions[frame.index]
        state.taken = ()
        self.instructions += 1
        state.steps += 1
        # A single one may take a second, where a table is asked for a place that nothing is known of.
        if not self.instructions & 3 and time.monotonic() > self.deadline:
            raise self.make_unknown("time limit")
        if not self.instructions & 511:
            if not self.instructions & 65535 and read_memory_in_use() - self.memory_before > self.bounds.memory:
                raise self.make_unknown("memory limit")
            if state.steps > _MOST_STEPS:
                raise self.make_unknown("too many instructions")
        handler = self._handlers.get(instruction.opcode)
        if handler is None:
            raise self.make_unknown(f"instruction is not modelled: {instruction.extra or instruction.opcode}")
        try:
            handler(state, frame, instruction)
        except ThrownError as thrown:
            self.throw(state, thrown.raised)
        if state.replay:
            state.replay = ()

    def finish_instruction(self, state: State, frame: Frame, instruction: Instruction, value: Any):
        """Sets the result and goes on to the next instruction."""
        if instruction.result:
            frame.registers[instruction.result] = value
        if instruction.opcode == "call" and instruction.extra[0]:
            self.enter_block(state, frame, instruction.extra[0])
        else:
            frame.index += 1

    def _push(self, state: State, function: Function, values: list[Any], copies: list[int]):
        if len(state.frames) > _DEEPEST:
            raise self.make_unknown("calls are nested too deeply")
        if len(values) < len(function.parameters):
            raise self.make_unknown(f"`{function.name}` is called with too few arguments")
        frame = Frame(function, dict(zip(function.parameters, values, strict=False)))
        frame.locals.extend(copies)
        state.frames.append(frame)

    def enter_block(self, state: State, frame: Frame, label: str):
        """A jump: values of phis, and what is known of loops."""
        block = frame.function.blocks[label]
        source = frame.block
        if block.phis:
            registers = frame.registers
            values = [self.read(state, registers, phi.extra[source.label], phi.type) for phi in block.phis]
            for phi, value in zip(block.phis, values, strict=True):
                registers[phi.result] = value
        is_backward = block.number <= source.number
        frame.block = block
        frame.index = 0
        frame.arrived_from = source.label
        if is_backward:
            self._check_loop(state, frame)
        elif block.number in frame.visits:
            del frame.visits[block.number]
            frame.saved.pop(block.number, None)
            frame.growing.pop(block.number, None)

    def _check_loop(self, state: State, frame: Frame):
        """Ends a way that comes to the same place in the same state, or too often with new conditions."""
        block = frame.block
        count = frame.visits.get(block.number, 0) + 1
        frame.visits[block.number] = count
        fresh = sum(state.counts.values())
        saved = frame.saved.get(block.number)
        if saved is not None and saved.inputs == fresh:
            same = self._compare_visit(state, frame, saved)
            if isinstance(same, int):
                if same:
                    raise self.make_crash(CrashKind.ENDLESS, "")
            elif count <= 4:
                model = self._ask(state, same)
                if model is not None and model is not _UNDECIDED:
                    self._record(
                        state, Ended(Reaction.CRASH, crash=CrashKind.ENDLESS), extra=same,
                        model={**state.model, **model},
                    )  # fmt: skip
        if saved is not None and len(state.conditions) > saved.conditions:
            growing = frame.growing.get(block.number, 0) + 1
            frame.growing[block.number] = growing
            if growing > self._loop_bound:
                raise self.make_unknown(f"a loop runs more than {self._loop_bound} times")
            frame.saved[block.number] = saved._replace(conditions=len(state.conditions))
        if saved is None or count & (count - 1) == 0 or count <= 4:
            state.owner = object()
            frame.saved[block.number] = Visit(
                {phi.result: frame.registers[phi.result] for phi in frame.function.phis
                 if phi.result in frame.registers},
                dict(state.objects),
                len(state.conditions), fresh,
            )  # fmt: skip

    def _compare_visit(self, state: State, frame: Frame, saved: Visit) -> Any:
        """Whether all is as at an earlier visit: 0, 1 or a condition."""
        conditions: list[Any] = []
        # Those of all blocks: a block may be jumped back to within a loop whose counter another block has.
        for phi in frame.function.phis:
            before, now = saved.registers.get(phi.result, UNDEFINED), frame.registers.get(phi.result, UNDEFINED)
            if is_same_value(before, now):
                continue
            if phi.type.is_pointer or phi.type.is_aggregate or before is UNDEFINED or now is UNDEFINED:
                return 0
            if isinstance(before, Pointer | Code) or isinstance(now, Pointer | Code):
                return 0
            if not is_term(before) and not is_term(now):
                return 0
            if phi.type.is_float:
                same = make_float(before, phi.type.bits) == make_float(now, phi.type.bits)
            elif phi.type.bits == 1:
                same = make_truth(before) == make_truth(now)
            else:
                same = make_bits(before, phi.type.bits) == make_bits(now, phi.type.bits)
            same = reduce_term(same)
            if isinstance(same, int) and not same:
                return 0
            conditions.append(same)
        for number, memory_object in state.objects.items():
            before = saved.objects.get(number)
            if before is memory_object or not memory_object.is_live:
                continue
            if before is None:
                if memory_object.kind in ("constant", "global", "outside"):
                    continue
                return 0
            if not is_same_content(before, memory_object):
                return 0
        return join_truths(*conditions)

    # Ends.

    def _record(self, state: State, end: Ended, extra: Any = None, model: Model | None = None):
        """Notes the end of a way."""
        if end.result is None:
            return
        conditions = tuple(state.conditions) if extra is None else (*state.conditions, extra)
        result, reason, shown = end.result, end.reason, ()
        effects = state.effects
        if result is Reaction.IGNORED:
            changed, shown = self._find_changed_members(state)
            effects = (*effects, *changed)
            result = Reaction.HANDLED if effects else Reaction.LOG_ONLY if state.logs else Reaction.IGNORED
            if result is not Reaction.HANDLED and state.notes:
                result, reason = Reaction.UNKNOWN, f"what {state.notes[0]} does is not known"
        model = state.model if model is None else model
        names = frozenset().union(*(self.solving.find_traits(each).names for each in (*conditions, *shown)))
        assumed = dict.fromkeys(self.solving.assumed[name] for name in sorted(names) if name in self.solving.assumed)
        assumed.update(dict.fromkeys((*state.notes, *state.assumed_notes)))
        self._note_beginning(state)
        if not state.has_begun:
            self.early.append(len(self.exploration.paths))
        place = end.place or self.find_place(state)
        if result is Reaction.CRASH and not place.path:
            kind = end.crash.value if end.crash is not None else ""
            result, reason = Reaction.UNKNOWN, f"{kind} outside of the workspace's code"
        if (
            result is Reaction.CRASH
            and state.has_forgotten
            and (
                end.crash in (CrashKind.NULL, CrashKind.DANGLING)
                or _UNWRITTEN in assumed
                or any(name.startswith("~foreign") for name in names)
            )
        ):
            kind = end.crash.value if end.crash is not None else ""
            result, reason = Reaction.UNKNOWN, f"{kind}, unless what is not known prevents it"
            if end.crash not in (None, CrashKind.NULL, CrashKind.DANGLING):
                self.doubtful.append(DoubtfulCrash(len(self.exploration.paths), end.crash))
        if result in (Reaction.HANDLED, Reaction.LOG_ONLY, Reaction.IGNORED):
            place = NOWHERE
        self.exploration.paths.append(
            CallbackPath(
                result, conditions, effects, state.logs, state.sent,
                end.crash if result is Reaction.CRASH else None, place, end.detail, reason, tuple(assumed), shown,
                self._fill_model(model) if model else {},
            )
        )  # fmt: skip

    def _fill_model(self, model: Model) -> dict[str, int]:
        """With the inputs that no condition speaks of."""
        return {path: model.get(path, 0) for path in self.solving.inputs}

    def find_place(self, state: State) -> CodeLine:
        """The line of the workspace that runs: of the innermost frame that has one."""
        for frame in reversed(state.frames):
            if frame.index < len(frame.block.instructions):
                place = self.places.find_place(frame.function.unit, self._find_location(frame))
                if place.path:
                    return place
        return NOWHERE

    def _find_location(self, frame: Frame) -> int:
        """The location of an instruction; where the compiler has joined several, of one that ran before it."""
        unit = frame.function.unit
        location = frame.get_instruction().location
        if self.places.has_line(unit, location):
            return location
        before = frame.function.blocks.get(frame.arrived_from)
        earlier = [*(before.instructions if before is not None else ()), *frame.block.instructions[: frame.index]]
        for each in reversed(earlier):
            if self.places.has_line(unit, each.location):
                return each.location
        return location

    def _find_changed_members(self, state: State) -> tuple[list[Observable], tuple[z3.BoolRef, ...]]:
        """Members that may differ from before, and a condition under which one of them does (none, where one does in
        any case)."""
        changed, conditions, is_shown = [], [], bool(state.effects)
        for member in state.members:
            differs = self._compare_member(state, member)
            if isinstance(differs, int):
                if differs:
                    is_shown = True
                    changed.append(Observable("member", member.name, NOWHERE))
                continue
            if is_certain(self.solving.evaluate(differs, state.model)):
                found: Any = {}
            else:
                found = self._ask(state, differs)
            if found is None:
                continue
            if found is not _UNDECIDED:
                state.model.update(found)
            changed.append(Observable("member", member.name, NOWHERE))
            conditions.append(differs)
        if is_shown or not conditions:
            return changed, ()
        return changed, (reduce_term(z3.Or(*conditions)) if len(conditions) > 1 else conditions[0],)

    def _compare_member(self, state: State, member: Any) -> Any:
        """Whether a member or what it owns differs: 0, 1 or a condition."""
        differences: list[Any] = []
        pending = [(member.address.object, member.address.offset, member.size)]
        seen: set[int] = {member.address.object}
        while pending:
            number, offset, size = pending.pop()
            before, now = member.objects.get(number), state.objects.get(number)
            if before is None or now is None or before is now:
                if before is not None:
                    self._list_owned(before, offset, size, seen, pending)
                continue
            if not now.is_live and before.is_live:
                return 1
            difference = self._compare_range(before, now, offset, size)
            if isinstance(difference, int):
                if difference:
                    return 1
            else:
                differences.append(difference)
            self._list_owned(before, offset, size, seen, pending)
        return negate_truth(join_truths(*[negate_truth(each) for each in differences])) if differences else 0

    def _list_owned(self, before: MemoryObject, offset: int, size: int, seen: set[int], pending: list):
        for _, _, value in before.list_cells(offset, size):
            if isinstance(value, Pointer) and value.object and value.object not in seen:
                seen.add(value.object)
                if self.made_globals.get(value.object) is None:
                    pending.append((value.object, 0, 1 << 40))

    def _compare_range(self, before: MemoryObject, now: MemoryObject, offset: int, size: int) -> Any:
        end = min(offset + size, max(before.size, now.size))
        places = sorted({each for cells in (before.cells, now.cells) for each in cells if offset - 16 < each < end})
        differences: list[Any] = []
        for place in places:
            first, second = before.cells.get(place), now.cells.get(place)
            if (
                first is not None
                and second is not None
                and first[0] == second[0]
                and is_same_value(first[1], second[1])
            ):
                continue
            start = max(place, offset)
            width = min(place + max(each[0] for each in (first, second) if each is not None), end) - start
            if width <= 0:
                continue
            old, new = (read_raw(each, start, width, self.addresses, self.make_any_byte) for each in (before, now))
            if new is UNDEFINED or is_same_value(old, new):
                continue
            if old is UNDEFINED or isinstance(old, Pointer | Code | tuple) or isinstance(new, Pointer | Code | tuple):
                return 1
            old, new = (
                make_float_bits(each, 8 * width) if isinstance(each, float) or z3.is_fp(each) else each
                for each in (old, new)
            )
            difference = compare_integers("ne", old, new, 8 * width)
            if isinstance(difference, int):
                if difference:
                    return 1
            else:
                differences.append(difference)
        return negate_truth(join_truths(*[negate_truth(each) for each in differences])) if differences else 0

    # Instructions.

    def _run_nothing(self, state: State, frame: Frame, instruction: Instruction):
        frame.index += 1

    def _run_assembly(self, state: State, frame: Frame, instruction: Instruction):
        if instruction.extra.startswith(('asm sideeffect ""', 'asm ""')) and not instruction.result:
            frame.index += 1
            return
        raise self.make_unknown("inline assembly")

    def compute(self, operation: str, left: Any, right: Any, type_: IrType) -> Any:
        """An operation on integers, which addresses may be."""
        if isinstance(left, Pointer) or isinstance(right, Pointer):
            if operation == "sub" and isinstance(left, Pointer) and isinstance(right, Pointer):
                if left.object == right.object:
                    return compute_integer("sub", left.offset, right.offset, 64)
            elif operation == "add" and not (isinstance(left, Pointer) and isinstance(right, Pointer)):
                pointer, other = (left, right) if isinstance(left, Pointer) else (right, left)
                return Pointer(pointer.object, add_offsets(pointer.offset, self._make_plain(other)))
            elif operation == "sub" and isinstance(left, Pointer):
                return Pointer(left.object, compute_integer("sub", left.offset, self._make_plain(right), 64))
            elif operation == "and" and isinstance(right, int) and right >> 63 and isinstance(left, Pointer):
                # An address is rounded down.
                kept = compute_integer("and", self._make_plain(left), right, 64)
                return Pointer(left.object, compute_integer("sub", kept, self.addresses.get_base(left.object), 64))
        return compute_integer(operation, self._make_plain(left), self._make_plain(right), type_.bits)

    def _make_plain(self, value: Any) -> Any:
        return self.addresses.compute_address(value) if isinstance(value, Pointer | Code) else value

    def _run_integer(self, state: State, frame: Frame, instruction: Instruction):
        type_ = instruction.type
        left = self.read(state, frame.registers, instruction.operands[0], type_)
        right = self.read(state, frame.registers, instruction.operands[1], type_)
        if type_.is_aggregate:
            element = type_.element  # pyright: ignore[reportAttributeAccessIssue]
            value: Any = [
                self._compute_lane(state, instruction.opcode, first, second, element)
                for first, second in zip(self.list_parts(left, type_), self.list_parts(right, type_), strict=True)
            ]
        else:
            value = self._compute_lane(state, instruction.opcode, left, right, type_)
        frame.registers[instruction.result] = value
        frame.index += 1

    def _compute_lane(self, state: State, operation: str, left: Any, right: Any, type_: IrType) -> Any:
        left, right = self.define(state, left, type_), self.define(state, right, type_)
        if operation in ("udiv", "sdiv", "urem", "srem"):
            right = self._make_plain(right)
            self.require(state, compare_integers("ne", right, 0, type_.bits), CrashKind.DIVISION, "")
        return self.compute(operation, left, right, type_)

    def _run_float(self, state: State, frame: Frame, instruction: Instruction):
        type_ = instruction.type
        left = self.read(state, frame.registers, instruction.operands[0], type_)
        right = self.read(state, frame.registers, instruction.operands[1], type_)
        if type_.is_aggregate:
            element = type_.element  # pyright: ignore[reportAttributeAccessIssue]
            value: Any = [
                self._compute_float_lane(state, instruction.opcode, first, second, element)
                for first, second in zip(self.list_parts(left, type_), self.list_parts(right, type_), strict=True)
            ]
        else:
            value = self._compute_float_lane(state, instruction.opcode, left, right, type_)
        frame.registers[instruction.result] = value
        frame.index += 1

    def _compute_float_lane(self, state: State, operation: str, left: Any, right: Any, type_: IrType) -> Any:
        if not type_.is_float:
            raise self.make_unknown("floats of 80 bits")
        left, right = self.define(state, left, type_), self.define(state, right, type_)
        if operation == "frem" and (is_term(left) or is_term(right)):
            return self.make_derived(state, "fmod", math.fmod, (left, right), type_.bits)
        return compute_float(operation, left, right, type_.bits)

    def _run_fneg(self, state: State, frame: Frame, instruction: Instruction):
        value = self.read(state, frame.registers, instruction.operands[0], instruction.type)

        def negate_lane(each: Any, type_: IrType) -> Any:
            each = self.define(state, each, type_)
            return -each if isinstance(each, float) else reduce_term(z3.fpNeg(each))

        if instruction.type.is_aggregate:
            element = instruction.type.element  # pyright: ignore[reportAttributeAccessIssue]
            value = [negate_lane(each, element) for each in self.list_parts(value, instruction.type)]
        else:
            value = negate_lane(value, instruction.type)
        frame.registers[instruction.result] = value
        frame.index += 1

    def _run_freeze(self, state: State, frame: Frame, instruction: Instruction):
        value = self.read(state, frame.registers, instruction.operands[0], instruction.type)
        if value is UNDEFINED and not (instruction.type.is_pointer or instruction.type.is_aggregate):
            value = self.define(state, value, instruction.type)
        frame.registers[instruction.result] = value
        frame.index += 1

    def compare(self, predicate: str, left: Any, right: Any, type_: IrType) -> Any:
        """icmp of two scalars."""
        if isinstance(left, Pointer | Code) or isinstance(right, Pointer | Code):
            if isinstance(left, Code) and isinstance(right, Code) and predicate in ("eq", "ne"):
                return int((left == right) == (predicate == "eq"))
            if isinstance(left, Pointer) and isinstance(right, Pointer) and left.object != right.object:
                if predicate in ("eq", "ne") and self._lies_inside(left) and self._lies_inside(right):
                    return int(predicate == "ne")
            elif isinstance(left, Pointer) and isinstance(right, Pointer) and predicate in ("eq", "ne"):
                return compare_integers(predicate, left.offset, right.offset, 64)
            left, right = self._make_plain(left), self._make_plain(right)
        return compare_integers(predicate, left, right, type_.bits)

    def _lies_inside(self, pointer: Pointer) -> bool:
        """Whether a pointer cannot be the address of another object. Those with an offset that is not known are taken
        to lie in their object: an index out of it is found where it is used."""
        return not isinstance(pointer.offset, int) or pointer.object == 0 or pointer.offset < 1 << 40

    def _run_icmp(self, state: State, frame: Frame, instruction: Instruction):
        type_ = instruction.type
        left = self.read(state, frame.registers, instruction.operands[0], type_)
        right = self.read(state, frame.registers, instruction.operands[1], type_)
        if type_.is_aggregate:
            element = type_.element  # pyright: ignore[reportAttributeAccessIssue]
            value: Any = [
                self.compare(instruction.extra, self.define(state, a, element), self.define(state, b, element), element)
                for a, b in zip(self.list_parts(left, type_), self.list_parts(right, type_), strict=True)
            ]
        else:
            value = self.compare(
                instruction.extra, self.define(state, left, type_), self.define(state, right, type_), type_
            )
        frame.registers[instruction.result] = value
        frame.index += 1

    def _run_fcmp(self, state: State, frame: Frame, instruction: Instruction):
        type_ = instruction.type
        left = self.read(state, frame.registers, instruction.operands[0], type_)
        right = self.read(state, frame.registers, instruction.operands[1], type_)
        if type_.is_aggregate:
            element = type_.element  # pyright: ignore[reportAttributeAccessIssue]
            pairs = zip(self.list_parts(left, type_), self.list_parts(right, type_), strict=True)
            value: Any = [
                compare_floats(
                    instruction.extra, self.define(state, a, element), self.define(state, b, element), element.bits
                )
                for a, b in pairs
            ]
        else:
            if not type_.is_float:
                raise self.make_unknown("floats of 80 bits")
            value = compare_floats(
                instruction.extra, self.define(state, left, type_), self.define(state, right, type_), type_.bits
            )
        frame.registers[instruction.result] = value
        frame.index += 1

    def convert(self, name: str, value: Any, source: IrType, target: IrType) -> Any:
        """A cast of a scalar."""
        if name in ("ptrtoint", "inttoptr", "addrspacecast"):
            return self._convert_address(name, value, target)
        if name == "bitcast":
            if source.is_pointer or (source.is_integer and target.is_integer):
                return value
            return interpret_raw(value, target, self.addresses)
        if name in ("zext", "sext", "trunc"):
            return self._convert_integer(name, self._make_plain(value), source.bits, target.bits)
        if name in ("fpext", "fptrunc"):
            if not (source.is_float and target.is_float):
                raise self.make_unknown("floats of 80 bits")
            return convert_float(value, source, target)  # pyright: ignore[reportArgumentType]
        if name in ("fptosi", "fptoui"):
            if not source.is_float:
                raise self.make_unknown("floats of 80 bits")
            return convert_float_to_integer(value, target.bits, source.bits, name == "fptosi")
        if not target.is_float:
            raise self.make_unknown("floats of 80 bits")
        return convert_integer_to_float(
            self._make_plain(value),
            source.bits,
            target,  # pyright: ignore[reportArgumentType]
            name == "sitofp",
        )

    def _convert_address(self, name: str, value: Any, target: IrType) -> Any:
        if name == "inttoptr":
            if isinstance(value, int):
                return self.addresses.find_pointer(value)
            if is_term(value):
                raise self.make_unknown("an address that is calculated from inputs")
        elif name == "ptrtoint" and target.bits != 64:
            return self._convert_integer("trunc", self._make_plain(value), 64, target.bits)
        elif name == "ptrtoint" and value == NULL:
            return 0
        return value

    def _convert_integer(self, name: str, value: Any, source: int, target: int) -> Any:
        if isinstance(value, int):
            if name == "sext":
                value = read_signed(value, source)
            return value & ((1 << target) - 1)
        if source == 1:
            ones = (1 << target) - 1 if name == "sext" else 1
            return reduce_term(z3.If(make_truth(value), z3.BitVecVal(ones, target), z3.BitVecVal(0, target)))
        if name == "zext":
            return reduce_term(z3.ZeroExt(target - source, value))
        if name == "sext":
            return reduce_term(z3.SignExt(target - source, value))
        cut = z3.Extract(target - 1, 0, value)
        return reduce_term(cut == 1 if target == 1 else cut)

    def _run_cast(self, state: State, frame: Frame, instruction: Instruction):
        name, source = instruction.extra
        value = self.read(state, frame.registers, instruction.operands[0], source)
        target = instruction.type
        if source.is_aggregate or target.is_aggregate:
            value = self._convert_lanes(state, name, value, source, target)
        elif value is UNDEFINED and name in ("bitcast", "ptrtoint", "inttoptr", "trunc"):
            pass
        else:
            value = self.convert(name, self.define(state, value, source), source, target)
        frame.registers[instruction.result] = value
        frame.index += 1

    def _convert_lanes(self, state: State, name: str, value: Any, source: IrType, target: IrType) -> Any:
        if name != "bitcast":
            parts = self.list_parts(value, source)
            from_type, to_type = source.element, target.element  # pyright: ignore[reportAttributeAccessIssue]
            return [self.convert(name, self.define(state, each, from_type), from_type, to_type) for each in parts]
        # Through memory, as its definition says.
        scratch = MemoryObject(source.size, "stack", "", None)
        if source.is_aggregate:
            for index, each in enumerate(self.list_parts(value, source)):
                place, part = source.locate(index)  # pyright: ignore[reportAttributeAccessIssue]
                if each is not UNDEFINED:
                    scratch.write(place, part.size, each)
        elif value is not UNDEFINED:
            scratch.write(0, source.size, value)
        if not target.is_aggregate:
            return read_scalar(self, state, scratch, 0, target)
        places = [target.locate(index) for index in range(len(target.list_parts()))]  # pyright: ignore[reportAttributeAccessIssue]
        return [read_scalar(self, state, scratch, place, part) for place, part in places]

    def _run_alloca(self, state: State, frame: Frame, instruction: Instruction):
        count = self.read(state, frame.registers, instruction.operands[0], get_integer_type(64))
        if not isinstance(count, int):
            raise self.make_unknown("an array on the stack whose size an input gives")
        pointer = self.add_object(state, instruction.type.size * count, "stack", "a variable of a function that ended")
        frame.locals.append(pointer.object)
        frame.registers[instruction.result] = pointer
        frame.index += 1

    def _run_load(self, state: State, frame: Frame, instruction: Instruction):
        address = self.read(state, frame.registers, instruction.operands[0], instruction.type)
        frame.registers[instruction.result] = load(self, state, address, instruction.type, instruction.extra)
        frame.index += 1

    def _run_store(self, state: State, frame: Frame, instruction: Instruction):
        value = self.read(state, frame.registers, instruction.operands[0], instruction.type)
        address = self.read(state, frame.registers, instruction.operands[1], instruction.type)
        store(self, state, address, instruction.type, value, instruction.extra)
        frame.index += 1

    def _run_atomic(self, state: State, frame: Frame, instruction: Instruction):
        type_ = instruction.type
        address = self.read(state, frame.registers, instruction.operands[0], type_)
        operand = self.read(state, frame.registers, instruction.operands[1], type_)
        before = load(self, state, address, type_, type_.size)
        operation = instruction.extra
        if operation == "xchg":
            after = operand
        elif operation in ("add", "sub", "and", "or", "xor"):
            after = self.compute(
                operation, self.define(state, before, type_), self.define(state, operand, type_), type_
            )
        elif operation in ("fadd", "fsub"):
            after = compute_float(operation, self.define(state, before, type_), operand, type_.bits)
        elif operation in ("max", "min", "umax", "umin"):
            predicate = ("u" if operation[0] == "u" else "s") + ("gt" if operation.endswith("max") else "lt")
            before = self.define(state, before, type_)
            after = choose_term(self.compare(predicate, before, operand, type_), before, operand, type_.bits, False)
        else:
            raise self.make_unknown(f"atomic operation {operation}")
        store(self, state, address, type_, after, type_.size)
        frame.registers[instruction.result] = before
        frame.index += 1

    def _run_compare_exchange(self, state: State, frame: Frame, instruction: Instruction):
        type_ = instruction.type
        address, expected, new = (self.read(state, frame.registers, each, type_) for each in instruction.operands)
        before = self.define(state, load(self, state, address, type_, type_.size), type_)
        same = self.compare("eq", before, self.define(state, expected, type_), type_)
        is_same = self.decide(state, same)
        if is_same:
            store(self, state, address, type_, new, type_.size)
        frame.registers[instruction.result] = [before, int(is_same)]
        frame.index += 1

    def _add_indices(self, base: Any, source: IrType, types: Sequence[IrType], indices: Sequence[Any]) -> Any:
        if base is UNDEFINED:
            raise self.make_unknown("an address that nobody wrote is used")
        if isinstance(base, Code):
            return base
        if not isinstance(base, Pointer):
            raise self.make_unknown("an address that is calculated from inputs")
        offset, current = base.offset, source
        for number, (type_, index) in enumerate(zip(types, indices, strict=True)):
            if number == 0:
                offset = add_offsets(offset, scale_index(self._make_plain(index), type_.bits, source.size))
            elif isinstance(current, StructureType):
                place, current = current.locate(index)
                offset = add_offsets(offset, place)
            elif isinstance(current, ArrayType):
                current = current.element
                offset = add_offsets(offset, scale_index(self._make_plain(index), type_.bits, current.size))
            else:
                raise self.make_unknown("an index into a scalar")
        return Pointer(base.object, offset)

    def _run_gep(self, state: State, frame: Frame, instruction: Instruction):
        source, types = instruction.extra
        registers = frame.registers
        base = self.read(state, registers, instruction.operands[0], instruction.type)
        indices = [
            self.define(state, self.read(state, registers, operand, type_), type_)
            for operand, type_ in zip(instruction.operands[1:], types, strict=True)
        ]
        registers[instruction.result] = self._add_indices(base, source, types, indices)
        frame.index += 1

    def _run_jump(self, state: State, frame: Frame, instruction: Instruction):
        self.enter_block(state, frame, instruction.extra[0])

    def _run_branch(self, state: State, frame: Frame, instruction: Instruction):
        bit = get_integer_type(1)
        condition = self.define(state, self.read(state, frame.registers, instruction.operands[0], bit), bit)
        waiting = len(self.pending)
        here, other = instruction.extra[:2] if self.decide(state, condition) else instruction.extra[1::-1]
        # A decision may have made the frame another one's, too.
        frame = state.get_frame()
        self.enter_block(state, frame, here)
        if len(self.pending) > waiting and frame.function.blocks[other].instructions[-1].opcode == "unreachable":
            # What ends there ends at once, and is not to be lost where time runs out.
            state.replay = ()
            self.pending.insert(-1, state)
            raise Ended(None)

    def _run_switch(self, state: State, frame: Frame, instruction: Instruction):
        type_ = instruction.type
        value = self._make_plain(
            self.define(state, self.read(state, frame.registers, instruction.operands[0], type_), type_)
        )
        default, cases = instruction.extra
        label = default
        if isinstance(value, int):
            for constant, target in cases:
                if constant == value:
                    label = target
                    break
        else:
            targets: dict[str, list[int]] = {}
            for constant, target in cases:
                targets.setdefault(target, []).append(constant)
            for target, constants in targets.items():
                if target == default:
                    continue
                condition = reduce_term(z3.Or(*[value == constant for constant in constants]))
                if self.decide(state, condition):
                    label = target
                    break
        self.enter_block(state, state.get_frame(), label)

    def _run_select(self, state: State, frame: Frame, instruction: Instruction):
        bit, type_ = get_integer_type(1), instruction.type
        condition = self.read(state, frame.registers, instruction.operands[0], bit)
        first = self.read(state, frame.registers, instruction.operands[1], type_)
        second = self.read(state, frame.registers, instruction.operands[2], type_)
        if isinstance(condition, list):
            element = type_.element  # pyright: ignore[reportAttributeAccessIssue]
            value: Any = [
                choose_term(each, a, b, element.bits, element.is_float)
                for each, a, b in zip(
                    condition, self.list_parts(first, type_), self.list_parts(second, type_), strict=True
                )
            ]
        else:
            value = self.choose_value(state, self.define(state, condition, bit), first, second, type_)
        frame = state.get_frame()
        frame.registers[instruction.result] = value
        frame.index += 1

    def choose_value(self, state: State, condition: Any, first: Any, second: Any, type_: IrType) -> Any:
        """first or second; forks only for addresses of different objects."""
        if isinstance(condition, int):
            return first if condition else second
        if is_same_value(first, second):
            return first
        if first is UNDEFINED or second is UNDEFINED:
            if type_.is_pointer or type_.is_aggregate:
                return first if self.decide(state, condition) else second
            first, second = self.define(state, first, type_), self.define(state, second, type_)
        if isinstance(first, Pointer) and isinstance(second, Pointer) and first.object == second.object:
            return Pointer(first.object, choose_term(condition, first.offset, second.offset, 64, False))
        if (
            type_.is_pointer
            or type_.is_aggregate
            or isinstance(first, Pointer | Code)
            or isinstance(second, Pointer | Code)
        ):
            return first if self.decide(state, condition) else second
        return choose_term(condition, first, second, type_.bits, type_.is_float)

    def _run_extract(self, state: State, frame: Frame, instruction: Instruction):
        value = self.read(state, frame.registers, instruction.operands[0], instruction.type)
        for index in instruction.extra:
            value = value[index] if isinstance(value, list) else UNDEFINED
        frame.registers[instruction.result] = value
        frame.index += 1

    def _run_insert(self, state: State, frame: Frame, instruction: Instruction):
        whole = self.read(state, frame.registers, instruction.operands[0], instruction.type)
        part = self.read(state, frame.registers, instruction.operands[1], instruction.type)
        frame.registers[instruction.result] = self._insert_part(whole, instruction.type, instruction.extra, part)
        frame.index += 1

    def _insert_part(self, whole: Any, type_: IrType, indices: Sequence[int], part: Any) -> Any:
        if not indices:
            return part
        parts = list(self.list_parts(whole, type_))
        inner = type_.list_parts()[indices[0]]  # pyright: ignore[reportAttributeAccessIssue]
        parts[indices[0]] = self._insert_part(parts[indices[0]], inner, indices[1:], part)
        return parts

    def _run_extract_lane(self, state: State, frame: Frame, instruction: Instruction):
        lanes = self.list_parts(
            self.read(state, frame.registers, instruction.operands[0], instruction.type), instruction.type
        )
        index = self.read(state, frame.registers, instruction.operands[1], get_integer_type(64))
        if not isinstance(index, int):
            raise self.make_unknown("a lane that an input names")
        frame.registers[instruction.result] = lanes[index]
        frame.index += 1

    def _run_insert_lane(self, state: State, frame: Frame, instruction: Instruction):
        type_ = instruction.type
        lanes = list(self.list_parts(self.read(state, frame.registers, instruction.operands[0], type_), type_))
        element = type_.element  # pyright: ignore[reportAttributeAccessIssue]
        index = self.read(state, frame.registers, instruction.operands[2], get_integer_type(64))
        if not isinstance(index, int):
            raise self.make_unknown("a lane that an input names")
        lanes[index] = self.read(state, frame.registers, instruction.operands[1], element)
        frame.registers[instruction.result] = lanes
        frame.index += 1

    def _run_shuffle(self, state: State, frame: Frame, instruction: Instruction):
        type_ = instruction.type
        first, second = (
            self.list_parts(self.read(state, frame.registers, each, type_), type_) for each in instruction.operands[:2]
        )
        mask = instruction.operands[2]
        lanes = [*first, *second]
        if isinstance(mask, Zeros):
            indices: list[Any] = [0] * len(mask.type.list_parts())  # pyright: ignore[reportAttributeAccessIssue]
        else:
            indices = [each for _, each in mask.parts]
        frame.registers[instruction.result] = [UNDEFINED if each is UNDEFINED else lanes[each] for each in indices]
        frame.index += 1

    def _run_unreachable(self, state: State, frame: Frame, instruction: Instruction):
        raise self.make_crash(CrashKind.UNREACHABLE, "")

    # Calls, returns, exceptions.

    def _run_return(self, state: State, frame: Frame, instruction: Instruction):
        value = (
            self.read(state, frame.registers, instruction.operands[0], instruction.type)
            if instruction.operands
            else None
        )
        self.leave_frame(state)
        if not state.frames:
            raise Ended(Reaction.IGNORED)
        caller = state.get_frame()
        self.finish_instruction(state, caller, caller.get_instruction(), value)

    def _is_other(self, state: State, pointer: Pointer) -> bool:
        found = state.objects.get(pointer.object)
        return found is not None and found.kind == "other"

    def leave_frame(self, state: State):
        """Takes the topmost frame away, and its variables."""
        frame = state.frames.pop()
        state.shared_frames = min(state.shared_frames, len(state.frames))
        for number in frame.locals:
            self.free_object(state, number)

    def find_model_of(self, name: str) -> CallModel | None:
        if name not in self._models:
            self._models[name] = self._find_call_model(name)
        return self._models[name]

    def _run_call(self, state: State, frame: Frame, instruction: Instruction):
        operands = instruction.operands
        callee = self.read(state, frame.registers, operands[0], instruction.type)
        if not isinstance(callee, Code):
            if isinstance(callee, Pointer) and callee.object == 0:
                raise self.make_crash(CrashKind.NULL, "a function pointer is called")
            if not (isinstance(callee, Pointer) and self._is_other(state, callee)):
                raise self.make_unknown("a call of what is not known to be a function")
            callee = Code(_OTHER_FUNCTION)
        registers = frame.registers
        arguments: list[Argument] = list(operands[1:])
        values = [
            UNDEFINED if each.type.size == 0 and not each.type.is_aggregate
            else self.read(state, registers, each.operand, each.type)
            for each in arguments
        ]  # fmt: skip
        self.call_function(state, instruction, callee.name, values, arguments)

    def call_function(
        self, state: State, instruction: Instruction, key: str, values: list[Any], arguments: Sequence[Argument]
    ):
        """Calls a function by key: a model, one with a body, or one of which nothing is known."""
        name = key.split("#", 1)[0]
        call_model = self.find_model_of(name)
        if call_model is not None:
            value = call_model(Call(self, state, instruction, name, values, [each.type for each in arguments]))
            if value is not MOVED:
                self.finish_instruction(state, state.get_frame(), instruction, value)
            return
        if self.program.has_body(key):
            function = self.program.get_function(key)
            copies: list[int] = []
            for index, each in enumerate(arguments):
                if each.copied is not None:
                    values[index] = self._copy_argument(state, values[index], each.copied, copies)
            self._push(state, function, values, copies)
            return
        value = self._call_unknown(state, instruction, name, values, [each.extent for each in arguments])
        self.finish_instruction(state, state.get_frame(), instruction, value)

    def _copy_argument(self, state: State, value: Any, type_: IrType, copies: list[int]) -> Pointer:
        source = require_access(self, state, value, type_.size)
        target = self.add_object(state, type_.size, "stack", "an argument of a function that ended")
        copies.append(target.object)
        content = state.objects[source.object]
        if not isinstance(source.offset, int):
            raise self.make_unknown("an argument that lies at any of many places")
        for start, width, cell in content.list_cells(source.offset, type_.size):
            state.objects[target.object].write(start - source.offset, width, cell)
        state.objects[target.object].is_zeroed = content.is_zeroed
        return target

    def _call_unknown(
        self, state: State, instruction: Instruction, name: str, values: Sequence[Any], extents: Sequence[int] = ()
    ) -> Any:
        """A function without a body: its result is any, and so is what its arguments point to. extents: the bytes that
        each argument is of; where that is not known, all from there on."""
        note = f"a call of `{name}`"
        if note not in state.notes:
            state.notes = (*state.notes, note)
        if instruction.type.is_pointer or instruction.type.is_aggregate:
            raise self.make_unknown(f"{note}, which gives an address or a structure")
        for number, value in enumerate(values):
            if isinstance(value, Pointer):
                self.forget_memory(state, value, extents[number] if number < len(extents) else 0)
        if instruction.type.size == 0:
            return None
        return self.make_any_scalar(state, note, instruction.type)

    def forget_memory(self, state: State, pointer: Pointer, size: int):
        """Some bytes are any from here on; size 0: all behind the address."""
        memory_object = state.objects.get(pointer.object)
        if memory_object is None or not memory_object.is_live or memory_object.kind in ("constant", "outside"):
            return
        memory_object = state.take_object(pointer.object)
        offset = pointer.offset
        if not isinstance(offset, int) or not 0 <= offset <= memory_object.size:
            memory_object.cells = {}
            memory_object.is_zeroed = False
            return
        end = min(offset + size, memory_object.size) if size else memory_object.size
        if offset == 0 and end == memory_object.size:
            memory_object.cells = {}
            memory_object.is_zeroed = False
        elif memory_object.is_zeroed:
            fill_cells(memory_object, offset, end - offset, UNDEFINED)
        else:
            memory_object.clear(offset, end - offset)

    def throw(self, state: State, raised: Raised):
        """Unwinds to who catches or cleans up."""
        unwind(self, state, raised)

    def _run_landing(self, state: State, frame: Frame, instruction: Instruction):
        assert state.raised is not None
        frame.registers[instruction.result] = list(find_handler(self, state, instruction, state.raised))
        frame.index += 1

    def _run_resume(self, state: State, frame: Frame, instruction: Instruction):
        pair = self.read(state, frame.registers, instruction.operands[0], instruction.type)
        raised = get_raised(self, state, pair[0])
        self.leave_frame(state)
        unwind(self, state, raised)


_UNDECIDED: Any = object()
_OTHER = "an object that the callback has not made"
_OTHER_SIZE = 4096
_OTHER_FUNCTION = "a function that is not known"
_UNWRITTEN = "memory that nobody wrote"
_NO_ANSWER = "the solver gave no answer in time"


def is_same_value(first: Any, second: Any) -> bool:
    """Whether two values are written alike."""
    if first is second:
        return True
    if isinstance(first, z3.ExprRef):
        return isinstance(second, z3.ExprRef) and first.eq(second)
    if isinstance(first, float):
        return isinstance(second, float) and ((first == second and math.copysign(1, first) == math.copysign(1, second))
                                              or (math.isnan(first) and math.isnan(second)))  # fmt: skip
    if isinstance(first, Pointer):
        return (
            isinstance(second, Pointer) and first.object == second.object and is_same_value(first.offset, second.offset)
        )
    if isinstance(first, list):
        return isinstance(second, list) and all(map(is_same_value, first, second))
    if isinstance(first, tuple):
        return type(first) is type(second) and len(first) == len(second) and all(map(is_same_value, first, second))
    return type(first) is type(second) and first == second


def is_same_content(first: MemoryObject, second: MemoryObject) -> bool:
    if first is second:
        return True
    if first.cells.keys() != second.cells.keys() or first.is_live != second.is_live:
        return False
    return all(
        size == second.cells[place][0] and is_same_value(value, second.cells[place][1])
        for place, (size, value) in first.cells.items()
    )


def read_memory_in_use() -> int:
    """Bytes that this process has in memory; 0 where the system does not say."""
    try:
        with open("/proc/self/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    except (OSError, ValueError, IndexError):
        return 0
