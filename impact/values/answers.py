"""What was found out about the callbacks of a workspace: plain data, without terms of a solver."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from .ir.terms import read_signed, unpack_float
from .outcomes import NOWHERE, Bounds, CodeLine, CrashKind, InputKind, Reaction
from .projection import FieldValues


@dataclass(frozen=True)
class CallbackExample:
    """A message that leads to a reaction. values: input path to bits; kinds: what these are, by path. confirmed: a
    replay did the same; None where none was made. note: what the replay did instead, or why there was none."""

    result: Reaction
    values: Mapping[str, int]
    kinds: Mapping[str, tuple[InputKind, int, bool]]
    crash: CrashKind | None = None
    place: CodeLine = NOWHERE
    detail: str = ""
    assumed: tuple[str, ...] = ()
    effects: tuple[str, ...] = ()
    confirmed: bool | None = None
    note: str = ""


@dataclass(frozen=True)
class FieldSets:
    """One field of a message. path: without `msg.`, `[]` for all elements of an array; `this.x` for a member of the
    node. sets: by reaction. unhandled, ignored: values that are surely not handled, surely ignored; None where that is
    not known. names: of constants, by value."""

    path: str
    kind: InputKind
    bits: int
    is_signed: bool
    sets: Mapping[Reaction, FieldValues]
    unhandled: FieldValues | None
    ignored: FieldValues | None
    names: Mapping[int, str] = field(default_factory=dict)


@dataclass(frozen=True)
class SentValues:
    """What a publisher can put into a field. values: a "may" set. is_known: whether every way that publishes was
    followed, and the field known on it; where not, it may send more."""

    path: str
    kind: InputKind
    bits: int
    is_signed: bool
    values: FieldValues
    is_known: bool


class SentWay(NamedTuple):
    """A message that a callback publishes on one way. exact: the values of fields that are the same whatever comes in,
    by path; sizes as `path.size`, bytes of texts as `path[0]`. is_assumed: something was taken for granted on the way.
    asks: inputs on which it depends whether the way is taken: of the message that came in, of the node's state.
    """

    exact: Mapping[str, int | float]
    place: CodeLine
    is_assumed: bool
    asks: frozenset[str] = frozenset()


@dataclass(frozen=True)
class SentThrough:
    """What a callback publishes through one publisher. publisher: its name in the code; places: of the statements.
    ways: those with different exact values, at most a few; is_listed: whether these are all."""

    publisher: str
    places: tuple[CodeLine, ...]
    fields: tuple[SentValues, ...]
    ways: tuple[SentWay, ...] = ()
    is_listed: bool = False


@dataclass(frozen=True)
class CallbackAnswer:
    """One callback. kind: `subscriber`, `service`, `timer`, `action`. reason: why it was not explored; empty else.
    unknown: why ways are unknown, with their number. left: ways that were not ended. stood_for: what the harness stands
    in for. is_bare: no constructor of the node was run, so that members are empty. compiled_in: seconds of the
    processor that compilers worked for its source and what that calls; rounds: how often they ran. beyond: arrays and
    texts of which larger ones than were looked at may lead to something else."""

    callback: str
    kind: str
    language: str
    path: str
    line: int
    message_type: str
    topics: tuple[str, ...]
    nodes: tuple[str, ...]
    bounds: Bounds
    reason: str = ""
    counts: Mapping[Reaction, int] = field(default_factory=dict)
    fields: tuple[FieldSets, ...] = ()
    examples: tuple[CallbackExample, ...] = ()
    sent: tuple[SentThrough, ...] = ()
    unknown: Mapping[str, int] = field(default_factory=dict)
    assumed: tuple[str, ...] = ()
    stood_for: tuple[str, ...] = ()
    left: int = 0
    seconds: float = 0.0
    is_bare: bool = False
    compiled_in: float = 0.0
    rounds: int = 0
    beyond: tuple[str, ...] = ()

    @property
    def is_explored(self) -> bool:
        """Whether some way was followed to a verdict."""
        return any(count for result, count in self.counts.items() if result is not Reaction.UNKNOWN)

    @property
    def is_complete(self) -> bool:
        """Whether every way was followed to a verdict."""
        return self.is_explored and not self.left and not self.counts.get(Reaction.UNKNOWN)


@dataclass(frozen=True)
class ValuesReport:
    """The callbacks of a workspace. is_offline: replays had no network; None where there were none."""

    callbacks: tuple[CallbackAnswer, ...]
    bounds: Bounds
    replayed: bool
    is_offline: bool | None = None


def read_number(kind: InputKind, bits: int, is_signed: bool, value: int) -> int | float:
    """The number that some bits of an input are."""
    if kind in (InputKind.FLOAT32, InputKind.FLOAT64):
        return unpack_float(value, bits)
    return read_signed(value, bits) if is_signed else value


def read_example(example: CallbackExample) -> dict[str, int | float | bool | str]:
    """The values of an example as a person writes them: texts as one, the elements of arrays one by one."""
    found: dict[str, int | float | bool | str] = {}
    for path, bits in example.values.items():
        kind, width, is_signed = example.kinds[path]
        if kind is InputKind.CHARACTER:
            continue
        stem = path.removesuffix(".size")
        if kind is InputKind.SIZE and _is_text(example, stem):
            text = bytes(example.values.get(f"{stem}[{at}]", 0) & 0xFF for at in range(bits))
            found[stem] = text.decode("latin-1")
        elif kind is InputKind.BOOLEAN:
            found[path] = bool(bits)
        elif not _is_past_end(example, path):
            found[path] = read_number(kind, width, is_signed, bits)
    return found


def _is_text(example: CallbackExample, stem: str) -> bool:
    return example.kinds.get(f"{stem}[0]", (None,))[0] is InputKind.CHARACTER


def _is_past_end(example: CallbackExample, path: str) -> bool:
    """Whether a path is of an element that its array has not got in this example."""
    start = path.find("[")
    while start >= 0:
        end = path.index("]", start)
        size = example.values.get(f"{path[:start]}.size")
        if size is not None and int(path[start + 1 : end]) >= size:
            return True
        start = path.find("[", end)
    return False
