"""What publishers send against what subscribers handle, topic by topic and field by field."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from ..model.flow.graph import Graph
from .answers import CallbackAnswer, Example, FieldSets, SentField, read_number
from .outcomes import CodeLine, Reaction
from .projection import FieldValues, Number, format_values

UNHANDLED, CRASHING, IMPOSSIBLE, FRAME = "unhandled-value", "crashing-value", "impossible-branch", "frame-mismatch"
SEVERITIES = {CRASHING: "error", UNHANDLED: "warning", IMPOSSIBLE: "note", FRAME: "warning"}
_INDEX = re.compile(r"\[\d+\]")
_FRAMES = ("frame_id", "child_frame_id")


class Sender(NamedTuple):
    """One publisher of a topic: the callback that publishes, where, and what it can send."""

    callback: str
    places: tuple[CodeLine, ...]
    fields: Mapping[str, SentField]


@dataclass(frozen=True)
class Mismatch:
    """A value that one side sends and the other does not handle. kind: of SEVERITIES. values: as text. sure: the value
    is surely sent, and surely treated so; where it is not, both sets are only known to meet."""

    kind: str
    topic: str
    message_type: str
    field: str
    values: str
    sender: Sender | None
    subscriber: CallbackAnswer
    example: Example | None = None
    sure: bool = True


def list_senders(answers: Iterable[CallbackAnswer], graph: Graph) -> dict[str, list[Sender]]:
    """What callbacks publish, by topic, as far as the graph names the topic of a statement."""
    topics: dict[tuple[str, int], set[str]] = {}
    for one in graph.publishes:
        if one.topic:
            topics.setdefault((one.path, one.line), set()).add(one.topic)
    found: dict[str, list[Sender]] = {}
    for answer in answers:
        for sent in answer.sent:
            names = {
                topic for place in sent.places for topic in topics.get((_shorten(place.path, answer), place.line), ())
            }
            if len(names) == 1:
                row = Sender(answer.callback, sent.places, {one.path: one for one in sent.fields})
                found.setdefault(names.pop(), []).append(row)
    return found


def _shorten(path: str, answer: CallbackAnswer) -> str:
    """A path of debug information as the workspace has it."""
    return answer.path if path.endswith(f"/{answer.path}") else path


def list_mismatches(answers: Sequence[CallbackAnswer], graph: Graph) -> list[Mismatch]:
    """All mismatches between the callbacks of a survey. Topics with a publisher that was not explored, or whose name
    is not certain, have no impossible branches."""
    senders = list_senders(answers, graph)
    places: dict[str, set[tuple[str, int]]] = {}
    for one in graph.publishes:
        places.setdefault(one.topic, set()).add((one.path, one.line))
    open_names = any(one.role == "publisher" and one.how in ("unresolved", "partly") for one in graph.endpoints)
    found: list[Mismatch] = []
    for answer in answers:
        if answer.kind != "subscriber" or not answer.is_explored:
            continue
        for topic in answer.topics:
            rows = senders.get(topic, [])
            for sets in answer.fields:
                if not sets.path.startswith("this."):
                    found.extend(_compare(answer, topic, sets, rows))
            seen = {(_shorten(place.path, answer), place.line) for row in rows for place in row.places}
            complete = not open_names and places.get(topic, set()) <= seen and _is_only_here(graph, topic)
            if complete and rows:
                found.extend(_list_impossible(answer, topic, rows))
    return found


def _is_only_here(graph: Graph, topic: str) -> bool:
    return not any(one.role == "publisher" and one.topic == topic and one.implied for one in graph.endpoints)


def _compare(answer: CallbackAnswer, topic: str, sets: FieldSets, rows: Sequence[Sender]) -> Iterator[Mismatch]:
    for row in rows:
        sent = row.fields.get(sets.path)
        if sent is None:
            continue
        crash = sets.sets.get(Reaction.CRASH)
        met = intersect(sent.values, crash) if crash is not None else None
        if met is not None and not met.is_empty():
            example = _find_example(answer, sets, met)
            if example is not None:
                sure = not (sent.values.is_relational or crash.is_relational)
                yield _make(CRASHING, answer, topic, sets, met, row, example, sure)
        elif sets.ignored is not None:
            met = intersect(sent.values, sets.ignored)
            if not met.is_empty() and not sent.values.is_relational:
                is_frame = sets.path.rpartition(".")[2] in _FRAMES
                yield _make(FRAME if is_frame else UNHANDLED, answer, topic, sets, met, row, None, True)


def _make(
    kind: str, answer: CallbackAnswer, topic: str, sets: FieldSets, met: FieldValues, row: Sender | None,
    example: Example | None, sure: bool,
) -> Mismatch:  # fmt: skip
    values = format_values(met, sets.names)
    return Mismatch(kind, topic, answer.message_type, sets.path, values, row, answer, example, sure)


def _find_example(answer: CallbackAnswer, sets: FieldSets, met: FieldValues) -> Example | None:
    """A confirmed crash, or one that was not tried, whose value of the field is among those that are sent. An array's
    elements are asked one by one."""
    for one in answer.examples:
        if one.result is not Reaction.CRASH or one.confirmed is False or one.assumed:
            continue
        for path, bits in one.values.items():
            plain = path.removeprefix("msg.")
            kind = one.kinds.get(path)
            is_field = kind is not None and sets.path in (plain, _INDEX.sub("[]", plain))
            if kind is not None and is_field and has_value(met, read_number(*kind, bits)):
                return one
    return None


def _list_impossible(answer: CallbackAnswer, topic: str, rows: Sequence[Sender]) -> Iterator[Mismatch]:
    """Values that a subscriber tells from all others and that nobody sends."""
    for sets in answer.fields:
        handled = sets.sets.get(Reaction.HANDLED)
        if handled is None or handled.is_relational or sets.path.startswith("this.") or not answer.is_complete:
            continue
        sent = [row.fields.get(sets.path) for row in rows]
        if any(one is None or not one.is_known for one in sent):
            continue
        left = [span for span in handled.spans if span[0] == span[1] and isinstance(span[0], int)]
        never = tuple(
            span for span in left if not any(has_value(one.values, span[0]) for one in sent if one is not None)
        )
        if never:
            yield _make(IMPOSSIBLE, answer, topic, sets, FieldValues(never), None, None, True)
        if handled.texts is not None and all(values.texts is not None for values in known):
            texts = {text for values in known for text in values.texts or ()}
            lost = tuple(sorted(set(handled.texts) - texts))
            if lost:
                yield _make(IMPOSSIBLE, answer, topic, sets, FieldValues(texts=lost), None, None, True)


def intersect(one: FieldValues, other: FieldValues) -> FieldValues:
    """Values that are in both sets."""
    spans: list[tuple[Number, Number]] = []
    for low, high in one.spans:
        for start, end in other.spans:
            if max(low, start) <= min(high, end):
                spans.append((max(low, start), min(high, end)))
    infinities = tuple(value for value in one.infinities if value in other.infinities)
    texts: tuple[bytes, ...] | None = None
    if one.texts is not None and other.texts is not None:
        texts = tuple(text for text in one.texts if text in other.texts)
        spans = []
    elif one.texts is not None or other.texts is not None:
        # Of a text without a list, the spans are sizes.
        listed, sized = (one, other) if one.texts is not None else (other, one)
        texts = tuple(text for text in listed.texts or () if has_value(sized, len(text)))
        spans = []
        if sized.is_relational or sized.spans:
            texts = ()
    return FieldValues(
        tuple(spans), infinities, one.has_nan and other.has_nan, texts, one.is_relational or other.is_relational
    )


def has_value(values: FieldValues, number: Number) -> bool:
    """Whether a number is in a set."""
    if isinstance(number, float) and math.isnan(number):
        return values.has_nan
    if isinstance(number, float) and math.isinf(number):
        return number in values.infinities
    return any(low <= number <= high for low, high in values.spans)
