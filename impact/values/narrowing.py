"""Explorations narrowed to what is known of their inputs: messages that publishers send, parameters that are set."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import z3

from .answers import SentWay, read_number
from .ir.solving import SolverTimeout, Solving
from .ir.terms import make_float, pack_float, read_float_bits
from .outcomes import (
    CallbackPath,
    CodeLine,
    CrashKind,
    Exploration,
    InputKind,
    Reaction,
    Sent,
    SymbolicInput,
)
from .projection import FieldValues, Number, make_solving

_FLOATS = (InputKind.FLOAT32, InputKind.FLOAT64)
_MOST_WAYS = 24
_MESSAGE = "msg."
_PARAMETER = "~param."
_SURROUNDINGS = ("~ok", "~publisher", "~now")
"""Inputs that every running node has: ROS is up, somebody listens, time goes on."""

ParameterValues = Mapping[str, tuple[str | float | None, ...]]
"""What parameters may be, by their names in the code: texts, numbers, truth values; None for what the code says itself
where nobody sets it."""


class GivenMessage(NamedTuple):
    """A message that somebody sends. exact: values by path, sizes as `path.size`, bytes of texts as `path[0]`.
    possible: what other fields may hold; what is in neither may be anything."""

    exact: Mapping[str, Number]
    possible: Mapping[str, FieldValues] = {}


class MessageCrash(NamedTuple):
    """A crash that a message leads to. is_certain: whatever else holds, and nothing was taken for granted. fields: of
    the message, on which it depends."""

    kind: CrashKind
    place: CodeLine
    detail: str
    is_certain: bool
    fields: tuple[str, ...]


class MessageOutcome(NamedTuple):
    """What follows from one message. reactions: all that can; none where the message is beyond the bounds. is_whole:
    whether every way was followed."""

    reactions: frozenset[Reaction]
    crashes: tuple[MessageCrash, ...]
    is_whole: bool


def narrow_to_messages(
    exploration: Exploration, messages: Sequence[GivenMessage], seconds: float = 5.0
) -> Exploration | None:
    """The ways that some of these messages can take; None where one of them is beyond the bounds."""
    terms: list[z3.BoolRef] = []
    for message in messages:
        found = _constrain(exploration.inputs, message)
        if found is None:
            return None
        terms.append(_join_all(found[0]))
    narrowed = _narrow(exploration, z3.Or(*terms), seconds)  # pyright: ignore[reportArgumentType]
    return replace(narrowed, fixed=_list_fixed(exploration.inputs, messages[0])) if len(messages) == 1 else narrowed


def _list_fixed(inputs: Mapping[str, SymbolicInput], message: GivenMessage) -> dict[str, int]:
    """Inputs that a message fixes, with their bits."""
    found: dict[str, int] = {}
    for path, one in inputs.items():
        value = message.exact.get(path.removeprefix(_MESSAGE)) if path.startswith(_MESSAGE) else None
        bits = _encode(one, value) if value is not None else None
        if bits is not None:
            found[path] = bits
    return found


def narrow_to_parameters(exploration: Exploration, values: ParameterValues | None, seconds: float = 5.0) -> Exploration:
    """The ways that are open where parameters are what launch files and the code's defaults say. values: None where
    nothing is known of the parameters."""
    if values is None:
        return exploration
    terms: list[z3.BoolRef] = []
    fixed: dict[str, int] = {}
    for path, one in exploration.inputs.items():
        if path.startswith(_PARAMETER):
            name, is_set = path.removeprefix(_PARAMETER), False
            if name.endswith(".set"):
                name, is_set = name.removesuffix(".set"), True
            given = values.get(name, (None,))
            term = _constrain_parameter(exploration.inputs, one, given, is_set)
            if term is not None:
                terms.append(term)
                if len(given) == 1:
                    fixed[path] = int(given[0] is not None) if is_set else _fix_parameter(one, given[0])
    return replace(_narrow(exploration, _join_all(terms), seconds), fixed=fixed) if terms else exploration


def _fix_parameter(one: SymbolicInput, value: str | float | None) -> int:
    """The bits of a parameter that is set to a value, or left for its default; of no account where a flag says that it
    is not set."""
    known = one.default if value is None else value
    return (_encode(one, known) or 0) if isinstance(known, (int, float)) else 0


def judge_message(exploration: Exploration, message: GivenMessage, seconds: float = 5.0) -> MessageOutcome:
    """What follows from a message."""
    is_whole = not exploration.left
    found = _constrain(exploration.inputs, message)
    if found is None:
        return MessageOutcome(frozenset(), (), False)
    conditions, exact = found
    narrowed = _narrow(exploration, _join_all(conditions), seconds)
    solving = make_solving(exploration, time.monotonic() + seconds)
    reactions = frozenset(path.result for path in narrowed.paths)
    crashes: dict[tuple[CrashKind, CodeLine], MessageCrash] = {}
    only = reactions == {Reaction.CRASH} and is_whole
    for path in narrowed.paths:
        if path.result is not Reaction.CRASH or path.crash is None:
            continue
        names = frozenset().union(*(solving.find_traits(each).names for each in path.condition[:-1]))
        assumed = bool(path.assumed) or any(name in exploration.functions for name in names)
        certain = not assumed and (only or names <= exact)
        fields = tuple(sorted(name.removeprefix(_MESSAGE) for name in names if name.startswith(_MESSAGE)))
        one = MessageCrash(path.crash, path.place, path.detail, certain, fields)
        known = crashes.get((path.crash, path.place))
        if known is None or (certain and not known.is_certain):
            crashes[path.crash, path.place] = one
    return MessageOutcome(reactions, tuple(crashes.values()), is_whole and Reaction.UNKNOWN not in reactions)


def list_sent_ways(
    exploration: Exploration, rows: Iterable[tuple[CallbackPath, Sent]]
) -> tuple[tuple[SentWay, ...], bool]:
    """The messages that some ways send, as far as their fields have one value each; and whether these are all."""
    exact = exploration.fixed
    solving = make_solving(exploration, time.monotonic() + 2.0)
    found: dict[tuple[object, ...], SentWay] = {}
    is_listed = True
    for path, sent in rows:
        values: dict[str, Number] = {}
        for name, value in sent.values.items():
            known = value if isinstance(value, int) else _evaluate_exact(solving, value, exact)
            if known is not None:
                values[name] = read_number(*sent.kinds[name], known)
        asked = _list_asked(solving, path, exact)
        way = SentWay(values, sent.place, bool(path.assumed) or path.result is Reaction.UNKNOWN, asked)
        key = (tuple(sorted((name, repr(value)) for name, value in values.items())), sent.place)
        known_way = found.get(key)
        if known_way is None and len(found) >= _MOST_WAYS:
            is_listed = False
        elif known_way is None or (known_way.is_assumed, len(known_way.asks)) > (way.is_assumed, len(way.asks)):
            found[key] = way
    return tuple(found.values()), is_listed


def _list_asked(solving: Solving, path: CallbackPath, exact: Mapping[str, int]) -> frozenset[str]:
    """The inputs on which it depends whether a way is taken, but for those that are fixed and what surrounds a node."""
    found: set[str] = set()
    for condition in path.condition:
        names = {
            name
            for name in solving.find_traits(condition).names
            if not name.startswith(_SURROUNDINGS) and name not in exact
        }
        if names and not (len(names) == 1 and _is_bound(solving, condition, next(iter(names)))):
            found |= names
    return frozenset(found)


def _is_bound(solving: Solving, condition: z3.BoolRef, name: str) -> bool:
    """Whether a condition says no more of an input than what its kind does: a size within the bounds."""
    one = solving.inputs.get(name)
    most = {InputKind.SIZE: one.most, InputKind.BOOLEAN: 1, InputKind.CHARACTER: 127}.get(one.kind) if one else None
    if most is None or solving.find_traits(condition).names != {name}:
        return False
    return all(solving.holds([condition], {name: value}) for value in range(most + 1))


def _evaluate_exact(solving: Solving, term: z3.BitVecRef, exact: Mapping[str, int]) -> int | None:
    """The value of a term that speaks of exact inputs alone; None for others."""
    if not solving.find_traits(term).names <= exact.keys():
        return None
    value = solving.evaluate(term, exact)
    return value if isinstance(value, int) else None


def _narrow(exploration: Exploration, condition: z3.BoolRef, seconds: float) -> Exploration:
    """The ways on which a condition can hold, each with it as its last condition."""
    solving = make_solving(exploration, time.monotonic() + seconds)
    kept = [
        replace(path, condition=(*path.condition, condition), example={})
        for path in exploration.paths
        if _is_possible(solving, path, condition)
    ]
    return replace(exploration, paths=kept)


def _is_possible(solving: Solving, path: CallbackPath, condition: z3.BoolRef) -> bool:
    try:
        related = solving.select_related(path.condition, solving.find_traits(condition).names)
        return solving.find_model([*related, condition], path.example) is not None
    except SolverTimeout:
        return True


def _join_all(terms: Sequence[z3.BoolRef]) -> z3.BoolRef:
    if not terms:
        return z3.BoolVal(True)
    return z3.And(*terms) if len(terms) > 1 else terms[0]  # pyright: ignore[reportReturnType]


def _constrain(
    inputs: Mapping[str, SymbolicInput], message: GivenMessage
) -> tuple[list[z3.BoolRef], frozenset[str]] | None:
    """What a message says of the inputs, and which of these it fixes; None where it is beyond the bounds."""
    terms: list[z3.BoolRef] = []
    exact: set[str] = set()
    for path, one in inputs.items():
        if not path.startswith(_MESSAGE):
            continue
        leaf = path.removeprefix(_MESSAGE)
        value = message.exact.get(leaf)
        if value is not None:
            bits = _encode(one, value)
            if bits is None or (one.kind is InputKind.SIZE and bits > one.most):
                return None
            terms.append(one.term == bits)
            exact.add(path)
        elif _lies_past_end(leaf, message.exact):
            exact.add(path)
        elif leaf in message.possible and one.kind is not InputKind.CHARACTER:
            member = _make_membership(one, message.possible[leaf])
            if member is not None:
                terms.append(member)
    return terms, frozenset(exact)


def _lies_past_end(leaf: str, exact: Mapping[str, Number]) -> bool:
    """Whether a field belongs to an element that its array has not got in a message."""
    start = leaf.find("[")
    while start >= 0:
        size = exact.get(f"{leaf[:start]}.size")
        if size is not None and int(leaf[start + 1 : leaf.index("]", start)]) >= size:
            return True
        start = leaf.find("[", start + 1)
    return False


def _encode(one: SymbolicInput, value: Number) -> int | None:
    """The bits of a number as an input has them; None where it cannot have it."""
    if one.kind in _FLOATS:
        return pack_float(float(value), one.bits)
    if isinstance(value, float) and not value.is_integer():
        return None
    number = int(value)
    low, high = (-(1 << (one.bits - 1)), (1 << (one.bits - 1)) - 1) if one.is_signed else (0, (1 << one.bits) - 1)
    return number & ((1 << one.bits) - 1) if low <= number <= high else None


def _make_membership(one: SymbolicInput, values: FieldValues) -> z3.BoolRef | None:
    """That an input has one of some values; None where that says nothing."""
    if not values.is_complete or values.texts is not None:
        return None
    parts: list[z3.BoolRef] = []
    if one.kind in _FLOATS:
        number = read_float_bits(one.term, one.bits)
        for low, high in values.spans:
            bounds = (make_float(float(low), one.bits), make_float(float(high), one.bits))
            parts.append(z3.And(z3.fpGEQ(number, bounds[0]), z3.fpLEQ(number, bounds[1]), z3.Not(z3.fpIsInf(number))))  # pyright: ignore
        parts += [number == make_float(each, one.bits) for each in values.infinities]
        if values.has_nan:
            parts.append(z3.fpIsNaN(number))
    else:
        bottom, top = (-(1 << (one.bits - 1)), (1 << (one.bits - 1)) - 1) if one.is_signed else (0, (1 << one.bits) - 1)
        for low, high in values.spans:
            if isinstance(low, float) or isinstance(high, float):
                return None
            low, high = max(low, bottom), min(high, top)
            if low > high:
                continue
            if one.is_signed:
                parts.append(z3.And(one.term >= low, one.term <= high))  # pyright: ignore[reportArgumentType]
            else:
                parts.append(z3.And(z3.UGE(one.term, low), z3.ULE(one.term, high)))  # pyright: ignore
    return z3.Or(*parts) if parts else None  # pyright: ignore[reportReturnType]


def _constrain_parameter(
    inputs: Mapping[str, SymbolicInput], one: SymbolicInput, values: Sequence[str | float | None], is_set: bool
) -> z3.BoolRef | None:
    """What the values of a parameter say of one of its inputs. is_set: of that which tells whether it is set."""
    if is_set:
        given = {int(value is not None) for value in values}
        return one.term == given.pop() if len(given) == 1 else None
    name = one.path
    flag = inputs.get(f"{name}.set")
    if flag is None and None in values and one.default is None:
        return None
    parts: list[z3.BoolRef] = []
    for value in values:
        known = one.default if value is None else value
        if value is None and flag is not None:
            parts.append(flag.term == 0)
            continue
        if isinstance(known, str) or known is None:
            return None
        bits = _encode(one, known)
        if bits is None:
            return None
        term = one.term == bits
        parts.append(term if flag is None else z3.And(flag.term == 1, term))  # pyright: ignore[reportArgumentType]
    return z3.Or(*parts) if parts else None  # pyright: ignore[reportReturnType]
