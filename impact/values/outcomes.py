"""What an exploration gives, whichever executor made it: inputs, outcomes with their conditions, bounds.

An executor (LLVM IR for C++, `ast` for Python) runs one callback on symbolic inputs. Every way through it is a
`CallbackPath`; its condition is a conjunction of z3 terms over the inputs. Projections, witnesses and reports read
these.
"""

from __future__ import annotations

import enum
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import z3


class Reaction(enum.Enum):
    """What follows from a message. `UNKNOWN` is never read as ignored."""

    HANDLED = "handled"
    LOG_ONLY = "log-only"
    IGNORED = "ignored"
    CRASH = "crash"
    UNKNOWN = "unknown"


class CrashKind(enum.Enum):
    """How a callback dies. The native replay must name the same kind."""

    ASSERTION = "failed assertion"
    INDEX = "index out of range"
    EMPTY = "access to an empty container"
    DIVISION = "division by zero"
    NULL = "null pointer"
    DANGLING = "memory used after it was freed"
    FLOAT_TO_INTEGER = "float that no integer can hold"
    OVERFLOW = "signed overflow"
    SHIFT = "shift by too many bits"
    EXCEPTION = "uncaught exception"
    ENDLESS = "loop without an end"
    UNREACHABLE = "end of a function that returns nothing"
    ABORT = "abort"


class InputKind(enum.Enum):
    """How an input's bits are read. SIZE: the number of elements of an array or of bytes of a text."""

    INTEGER = "integer"
    BOOLEAN = "boolean"
    FLOAT32 = "float32"
    FLOAT64 = "float64"
    SIZE = "size"
    CHARACTER = "character"


class SymbolicInput(NamedTuple):
    """One symbolic value. path: `msg.pose.position.x`, `msg.ranges[2]`, `msg.data.size`, `msg.data[0]` (a byte of a
    text), `this.enabled_` (a member of the node), `~now` (what the callback asks of its surroundings). term: a bit
    vector of `bits` bits (floats by their IEEE bits). most: largest value of a SIZE, 0 otherwise. default: of a
    parameter, the value that the code gives it, as a text, a number or a truth value."""

    path: str
    kind: InputKind
    bits: int
    is_signed: bool
    term: z3.BitVecRef
    most: int = 0
    default: str | float | None = None


class CodeLine(NamedTuple):
    """A line of the workspace's sources. line is 0 where the compiler names none."""

    path: str
    line: int


NOWHERE = CodeLine("", 0)


class Observable(NamedTuple):
    """Something that others can observe. kind: `publish`, `service`, `action`, `parameter`, `actuator`, `member`,
    `reply`, `transform`, `shutdown`. name: the publisher's or member's name in the code."""

    kind: str
    name: str
    place: CodeLine


class Sent(NamedTuple):
    """A message as it is published. publisher: its name in the code. values: field path to term (bit vectors; floats
    by their bits; sizes as `path.size`, bytes of texts as `path[0]`); a number where the value is the same always.
    A field that is not in values is not known."""

    publisher: str
    values: dict[str, z3.BitVecRef | int]
    kinds: dict[str, tuple[InputKind, int, bool]]
    place: CodeLine


@dataclass(frozen=True)
class CallbackPath:
    """One way through a callback.

    condition: all must hold; terms over the inputs. crash: set where result is CRASH. reason: why it is UNKNOWN.
    assumed: what was replaced by any value on this way (havoc), by name. shown_by: what an input must also fulfil for
    the effects to be seen in a replay (a member that is written differs from before); it narrows witnesses, not sets.
    example: an input that leads here, as the executor found it (input path to bits); empty where none was found.
    """

    result: Reaction
    condition: tuple[z3.BoolRef, ...]
    effects: tuple[Observable, ...] = ()
    logs: tuple[str, ...] = ()
    sent: tuple[Sent, ...] = ()
    crash: CrashKind | None = None
    place: CodeLine = NOWHERE
    detail: str = ""
    reason: str = ""
    assumed: tuple[str, ...] = ()
    shown_by: tuple[z3.BoolRef, ...] = ()
    example: Mapping[str, int] = field(default_factory=dict)


@dataclass(frozen=True)
class Bounds:
    """How far an exploration goes; printed with every answer. seconds: time limit of one callback; compiling: seconds
    of the processor for a source file of C++ with all that it calls."""

    text: int = 8
    array: int = 3
    loops: int = 8
    paths: int = 4000
    seconds: float = 20.0
    memory: int = 2_000_000_000
    compiling: float = 60.0


class UnknownFunction(NamedTuple):
    """A float of some bits that is calculated from terms."""

    compute: Callable[..., float]
    arguments: tuple[z3.ExprRef | int | float, ...]
    bits: int


@dataclass
class Exploration:
    """All that was found out about one callback. left: ways that were begun and not ended (time or number of paths);
    where it is not 0, nothing is surely ignored. functions: variables that stand for what z3 does not know (the sine of
    a term), with what calculates them. fixed: inputs that have one value, where it was narrowed to that. is_bare:
    no constructor of the node was run. exceeded: inputs, sizes of arrays and texts, that a condition was about which
    only larger ones fulfil."""

    inputs: dict[str, SymbolicInput] = field(default_factory=dict)
    paths: list[CallbackPath] = field(default_factory=list)
    bounds: Bounds = field(default_factory=Bounds)
    left: int = 0
    instructions: int = 0
    seconds: float = 0.0
    functions: dict[str, UnknownFunction] = field(default_factory=dict)
    fixed: Mapping[str, int] = field(default_factory=dict)
    is_bare: bool = False
    exceeded: frozenset[str] = frozenset()


class Witness(NamedTuple):
    """Values that lead to one outcome. values: input path to its bits as a number (not signed). result, crash, place:
    what the exploration expects of a replay."""

    values: dict[str, int]
    result: Reaction
    crash: CrashKind | None
    place: CodeLine
