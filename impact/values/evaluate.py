"""From an exploration to an answer: value sets of fields, examples with witnesses, and what was published."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import NamedTuple

from .answers import CallbackExample, FieldSets, SentThrough, SentValues
from .narrowing import ParameterValues, list_sent_ways, narrow_to_parameters
from .outcomes import CallbackPath, CodeLine, Exploration, InputKind, Reaction, Sent
from .projection import make_witness, project_fields
from .sent_values import project_sent

_MOST_EXAMPLES = 24
_MOST_SENT_FIELDS = 60


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


def evaluate(
    exploration: Exploration, names: Mapping[str, Mapping[int, str]], seconds: float = 10.0,
    parameters: ParameterValues | None = None,
) -> Evaluated:  # fmt: skip
    """Value sets, examples and sent values of an exploration. names: of constants, by type of the field and
    value. seconds: for the value sets, and again for what is sent. parameters: as far as known, for what is sent."""
    counts = dict(Counter(path.result for path in exploration.paths))
    unknown = dict(Counter(path.reason for path in exploration.paths if path.result is Reaction.UNKNOWN))
    assumed = tuple(sorted({name for path in exploration.paths for name in path.assumed}))
    fields = tuple(_list_fields(exploration, names, seconds))
    sent = tuple(list_sent(narrow_to_parameters(exploration, parameters), seconds))
    return Evaluated(
        counts,
        fields,
        tuple(_list_examples(exploration)),
        sent,
        unknown,
        assumed,
        exploration.left,
        exploration.seconds,
    )


def _list_fields(exploration: Exploration, names: Mapping[str, Mapping[int, str]], seconds: float) -> list[FieldSets]:
    found: list[FieldSets] = []
    for one in project_fields(exploration, seconds):
        path = one.path.removeprefix("msg.")
        sign = "int" if one.is_signed else "uint"
        known = names.get(f"{sign}{one.bits}", {}) if one.kind is InputKind.INTEGER else {}
        found.append(FieldSets(
            path, one.kind, one.bits, one.is_signed, dict(one.values), one.surely_unhandled, one.surely_ignored, known,
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


def list_sent(exploration: Exploration, seconds: float) -> list[SentThrough]:
    """Per publisher and statement, the values of each field over all ways that publish through it."""
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
        for path in _list_leaves(kinds)[:_MOST_SENT_FIELDS]:
            kind = kinds.get(path) or (InputKind.CHARACTER, 8, False)
            values = project_sent(exploration, rows, path, kind, seconds / 10)
            if values is not None:
                name = path if path in kinds else f"{path}.size"
                everywhere = all(name in one.values for _, one in rows)
                fields.append(SentValues(path, *kind, values, is_whole and everywhere))
        exact, is_listed = list_sent_ways(exploration, rows)
        found.append(SentThrough(publisher, (place,), tuple(fields), exact, is_listed))
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
