"""What callbacks handle, ignore, crash on and send, at two states of a workspace."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from ..model.flow.graph import Graph
from .answers import CallbackAnswer
from .matching import TopicPublishers, list_senders
from .outcomes import Reaction
from .projection import format_values

CALLBACK, SENT = "callback", "sent"


class ValueChange(NamedTuple):
    """A set that is another one than at the base. what: a reaction, `sent`, or `callback` for one that is new or gone.
    field: of the message, empty for a callback; topic: empty where it has none. old, new: as text, empty for nothing.
    path, line: of the callback, at the base where it is gone."""

    callback: str
    topic: str
    field: str
    what: str
    old: str
    new: str
    path: str
    line: int


class _Sets(NamedTuple):
    """Sets by topic, field and what they are, as texts; None where it is not sure. place: of the callback."""

    place: tuple[str, int]
    texts: Mapping[tuple[str, str, str], str | None]


def compare_values(
    old: Sequence[CallbackAnswer], old_graph: Graph, new: Sequence[CallbackAnswer], new_graph: Graph
) -> list[ValueChange]:
    """The changes between two explorations, by callback and field. A callback that was not explored on one side is left
    out; so are sets for which the solver ran out of time."""
    before, after = _collect(old, old_graph), _collect(new, new_graph)
    found: list[ValueChange] = []
    for key in dict.fromkeys((*after, *before)):
        one, other = before.get(key), after.get(key)
        name = key[0]
        if one is None or other is None:
            here = one if one is not None else other
            assert here is not None
            state = ("there", "gone") if other is None else ("not there", "new")
            found.append(ValueChange(name, "", "", CALLBACK, *state, *here.place))
            continue
        for topic, field, what in dict.fromkeys((*other.texts, *one.texts)):
            was, now = one.texts.get((topic, field, what), ""), other.texts.get((topic, field, what), "")
            if was is not None and now is not None and was != now:
                found.append(ValueChange(name, topic, field, what, was, now, *other.place))
    return found


def _collect(answers: Iterable[CallbackAnswer], graph: Graph) -> dict[tuple[str, str, str], _Sets]:
    """The sets of each callback that was explored, by its name, kind and the type of its message."""
    answers = list(answers)
    found: dict[tuple[str, str, str], _Sets] = {}
    publishers = TopicPublishers(graph)
    for answer in answers:
        if answer.is_explored or answer.sent:
            texts: dict[tuple[str, str, str], str | None] = {}
            texts.update(_list_reactions(answer))
            texts.update(_list_sent(answer, publishers))
            found[answer.callback, answer.kind, answer.message_type] = _Sets((answer.path, answer.line), texts)
    return found


def _list_reactions(answer: CallbackAnswer) -> Iterator[tuple[tuple[str, str, str], str | None]]:
    topic = ", ".join(answer.topics)
    for one in answer.fields:
        if one.path.startswith(("this.", "global.", "~")):
            continue
        for result, values in one.sets.items():
            if result is not Reaction.UNKNOWN and not values.is_empty():
                text = format_values(values, one.names) if values.is_complete else None
                yield (topic, one.path, result.value), text
    for result in (Reaction.HANDLED, Reaction.LOG_ONLY, Reaction.IGNORED, Reaction.CRASH):
        if answer.counts.get(result) and not any(result in one.sets for one in answer.fields):
            yield (topic, "", result.value), "every message"


def _list_sent(
    answer: CallbackAnswer, publishers: TopicPublishers
) -> Iterator[tuple[tuple[str, str, str], str | None]]:  # fmt: skip
    for topic, rows in list_senders([answer], publishers).items():
        texts: dict[str, dict[str, None]] = {}
        unsure: set[str] = set()
        for row in rows:
            for path, sent in row.fields.items():
                texts.setdefault(path, {})[format_values(sent.values)] = None
                if not sent.values.is_complete:
                    unsure.add(path)
        for path, every in texts.items():
            yield (topic, path, SENT), None if path in unsure else "; ".join(sorted(every))
