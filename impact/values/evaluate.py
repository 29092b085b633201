"""From an exploration to an answer: value sets of fields, examples with witnesses, and what was published."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import z3

from .answers import CallbackExample, FieldSets, SentThrough, SentValues
from .narrowing import ParameterValues, list_sent_ways, narrow_to_parameters
from .outcomes import CallbackPath, CodeLine, CrashKind, Exploration, InputKind, Reaction, Sent
from .projection import FieldValues, make_witness, project_fields
from .sent_values import project_sent

_MOST_EXAMPLES = 24
_MOST_SENT_FIELDS = 60
_MOST_ENDING = 60
_BY_SIZE = (CrashKind.INDEX, CrashKind.EMPTY, CrashKind.EXCEPTION)
"""Crashes of which an array may be the cause that is too short."""


class Evaluated(NamedTuple):
    """What an exploration says, without terms of the solver."""

    counts: dict[Reaction, int]
    fields: tuple[FieldSets, ...]
    examples: tuple[CallbackExample, ...]
    sent: tuple[SentThrough, ...]
    unknown: dict[str, int]
    assumed: tuple[str, ...]
    left: int
    seconds: float
    asked: tuple[str, ...] = ()
    """Types of messages that the callback had to do with."""
    is_bare: bool = False
    beyond: tuple[str, ...] = ()
    """Arrays and texts of which larger ones may lead to something else."""


def evaluate(
    exploration: Exploration, names: Mapping[str, Mapping[int, str]], seconds: float = 10.0,
    parameters: ParameterValues | None = None,
) -> Evaluated:  # fmt: skip
    """Value sets, examples and sent values of an exploration. names: of constants, by type of the field and
    value. seconds: for the value sets, and again for what is sent. parameters: as far as known, for what is sent."""
    counts = dict(Counter(path.result for path in exploration.paths))
    unknown = dict(Counter(path.reason for path in exploration.paths if path.result is Reaction.UNKNOWN))
    assumed = tuple(sorted({name for path in exploration.paths for name in path.assumed}))
    beyond = tuple(dict.fromkeys(_name_array(name) for name in _list_exceeded(exploration)))
    fields = tuple(_list_fields(exploration, names, seconds, is_whole=not beyond))
    narrowed = narrow_to_parameters(exploration, parameters)
    sent = tuple(list_sent(narrowed, seconds, fields if narrowed is exploration else ()))
    return Evaluated(
        counts,
        fields,
        tuple(_list_examples(exploration)),
        sent,
        unknown,
        assumed,
        exploration.left,
        exploration.seconds,
        is_bare=exploration.is_bare,
        beyond=beyond,
    )


def _list_exceeded(exploration: Exploration) -> list[str]:
    """The sizes of arrays and texts that are looked at as far as it goes and may lead to something else beyond: those
    that a condition asked for larger ones of, and those at whose largest every way is a crash."""
    found = set(exploration.exceeded)
    crashing = [path for path in exploration.paths if path.crash in _BY_SIZE]
    ending = [path for path in exploration.paths if path.result not in (Reaction.CRASH, Reaction.UNKNOWN)]
    if crashing and len(ending) <= _MOST_ENDING:
        for name, size in exploration.inputs.items():
            if size.kind is InputKind.SIZE and size.most and name not in found:
                largest = size.term == size.most
                if _is_any_possible(crashing, largest, name) and not _is_any_possible(ending, largest):
                    found.add(name)
    return sorted(found)


def _is_any_possible(paths: Sequence[CallbackPath], condition: z3.BoolRef, name: str = "") -> bool:
    """Whether a condition can hold on one of some ways, as far as the solver tells in time; with the name of an input,
    of those alone that speak of it."""
    for path in paths:
        if name and not any(name in str(one) for one in path.condition):
            continue
        solver = z3.Solver()
        solver.set("timeout", 200)
        solver.add(*path.condition, condition)
        if solver.check() != z3.unsat:
            return True
    return False


def _name_array(size: str) -> str:
    """What a reader knows a size by; of what code gives that is not followed, there is no name."""
    return "arrays and texts of other code" if size[:1] == "~" else size.removesuffix(".size").removeprefix("msg.")


def _list_fields(
    exploration: Exploration, names: Mapping[str, Mapping[int, str]], seconds: float, is_whole: bool
) -> list[FieldSets]:
    """is_whole: what larger arrays lead to is known, too; else nothing is surely ignored."""
    found: list[FieldSets] = []
    for one in project_fields(exploration, seconds):
        path = one.path.removeprefix("msg.")
        sign = "int" if one.is_signed else "uint"
        known = names.get(f"{sign}{one.bits}", {}) if one.kind is InputKind.INTEGER else {}
        found.append(FieldSets(
            path, one.kind, one.bits, one.is_signed, dict(one.values), one.surely_unhandled if is_whole else None,
            one.surely_ignored if is_whole else None, known,
        ))  # fmt: skip
    return found


def _list_examples(exploration: Exploration) -> list[CallbackExample]:
    """One example for each kind of outcome: reaction, crash and line, or what was observed."""
    kinds = {name: (one.kind, one.bits, one.is_signed) for name, one in exploration.inputs.items()}
    found: dict[tuple[object, ...], CallbackExample] = {}
    # A way on which nothing is assumed is the better example.
    for path in sorted(exploration.paths, key=lambda one: len(one.assumed)):
        key = path.result, path.crash, path.place if path.crash else "", tuple(sorted({
            (one.kind, one.name) for one in path.effects
        })) if path.result is Reaction.HANDLED else ""  # fmt: skip
        if path.result is Reaction.UNKNOWN or key in found or len(found) >= _MOST_EXAMPLES:
            continue
        witness = make_witness(exploration, path)
        if witness is None:
            continue
        effects = tuple(dict.fromkeys(f"{one.kind} {one.name}".strip() for one in path.effects))
        found[key] = CallbackExample(
            path.result, witness.values, kinds, path.crash, path.place if path.crash else CodeLine("", 0), path.detail,
            path.assumed, effects,
        )  # fmt: skip
    return sorted(found.values(), key=lambda one: (one.result is not Reaction.CRASH, one.place))


def list_sent(exploration: Exploration, seconds: float, received: Sequence[FieldSets] = ()) -> list[SentThrough]:
    """Per publisher and statement, the values of each field over all ways that publish through it. received: the
    value sets of the callback's own message, as far as they are known."""
    ways: dict[tuple[str, CodeLine], list[tuple[CallbackPath, Sent]]] = {}
    for path in exploration.paths:
        for one in path.sent:
            ways.setdefault((one.publisher, one.place), []).append((path, one))
    is_whole = not exploration.left and not any(path.result is Reaction.UNKNOWN for path in exploration.paths)
    found: list[SentThrough] = []
    for (publisher, place), rows in ways.items():
        kinds: dict[str, tuple[InputKind, int, bool]] = {}
        for _, one in rows:
            kinds.update(one.kinds)
        fields: list[SentValues] = []
        passed = _list_passed_on(exploration, rows, received)
        for path in _list_leaves(kinds)[:_MOST_SENT_FIELDS]:
            kind = kinds.get(path) or (InputKind.CHARACTER, 8, False)
            values = passed.get(path) or project_sent(exploration, rows, path, kind, seconds / 10)
            if values is not None:
                name = path if path in kinds else f"{path}.size"
                everywhere = all(name in one.values for _, one in rows)
                fields.append(SentValues(path, *kind, values, is_whole and everywhere))
        exact, is_listed = list_sent_ways(exploration, rows)
        found.append(SentThrough(publisher, (place,), tuple(fields), exact, is_listed))
    return found


def _list_passed_on(
    exploration: Exploration, rows: Sequence[tuple[CallbackPath, Sent]], received: Sequence[FieldSets]
) -> dict[str, FieldValues]:
    """The values of what is sent as it was received, where all ways of one outcome send it and no others do: what the
    field may be on these is known already."""
    results = {path.result for path, _ in rows}
    sending = {id(path) for path, _ in rows}
    if len(results) != 1 or sending != {id(path) for path in exploration.paths if path.result in results}:
        return {}
    result = results.pop()
    known = {f"msg.{one.path}": one.sets[result] for one in received if result in one.sets}
    found: dict[str, FieldValues] = {}
    for name, kind in rows[0][1].kinds.items():
        terms = {str(one.values.get(name)) for _, one in rows}
        term = terms.pop() if len(terms) == 1 else ""
        one = exploration.inputs.get(term)
        if term in known and one is not None and (one.kind, one.bits, one.is_signed) == kind:
            found[name] = known[term]
    return found


def _list_leaves(kinds: Mapping[str, tuple[InputKind, int, bool]]) -> list[str]:
    """Fields that are sent, a text as one of them."""
    texts = {name[: name.rindex("[")] for name, kind in kinds.items() if kind[0] is InputKind.CHARACTER}
    found: list[str] = []
    for name, kind in kinds.items():
        if kind[0] is InputKind.SIZE and name.removesuffix(".size") in texts:
            found.append(name.removesuffix(".size"))
        elif kind[0] is not InputKind.CHARACTER:
            found.append(name)
    return found
