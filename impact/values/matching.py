"""What publishers send against what subscribers handle, topic by topic and field by field."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from ..model.flow.graph import Graph
from .answers import CallbackAnswer, CallbackExample, FieldSets, SentValues, read_number
from .outcomes import CodeLine, InputKind, Reaction
from .projection import FieldValues, Number, format_values

UNHANDLED, CRASHING, IMPOSSIBLE, FRAME = "unhandled-value", "crashing-value", "impossible-branch", "frame-mismatch"
SEVERITIES = {CRASHING: "error", UNHANDLED: "warning", IMPOSSIBLE: "note", FRAME: "warning"}
_FRAMES = ("frame_id", "child_frame_id")


class Sender(NamedTuple):
    """One publisher of a topic: the callback that publishes, where, and what it can send."""

    callback: str
    places: tuple[CodeLine, ...]
    fields: Mapping[str, SentValues]


@dataclass(frozen=True)
class Mismatch:
    """A value that one side sends and the other does not handle. kind: of SEVERITIES. values: as text. sure: of a
    crash, that a replay showed it or nothing was assumed, and that the sets are exact; of a value that is not handled,
    that nothing at all follows, not even a line in the log."""

    kind: str
    topic: str
    message_type: str
    field: str
    values: str
    sender: Sender | None
    subscriber: CallbackAnswer
    example: CallbackExample | None = None
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
            names = {topic for place in sent.places for topic in topics.get((place.path, place.line), ())}
            if len(names) == 1:
                row = Sender(answer.callback, sent.places, {one.path: one for one in sent.fields})
                found.setdefault(names.pop(), []).append(row)
    return found


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
            for row in rows:
                found.extend(_compare(answer, topic, row))
            seen = {(place.path, place.line) for row in rows for place in row.places}
            complete = not open_names and places.get(topic, set()) <= seen and _is_only_here(graph, topic)
            if complete and rows:
                found.extend(_list_impossible(answer, topic, rows))
    return found


def _is_only_here(graph: Graph, topic: str) -> bool:
    return not any(one.role == "publisher" and one.topic == topic and one.implied for one in graph.endpoints)


def _compare(answer: CallbackAnswer, topic: str, row: Sender) -> Iterator[Mismatch]:
    """What one publisher sends that one subscriber crashes on, or does not handle."""
    fields = [one for one in answer.fields if not one.path.startswith(("this.", "global.")) and one.path in row.fields]
    for example in answer.examples:
        if example.result is Reaction.CRASH and example.confirmed is not False and _may_be_sent(example, row):
            crashing = [(one, _find_met(row, one, one.sets.get(Reaction.CRASH))) for one in fields]
            telling = [(one, met) for one, met in crashing if met is not None and not met.is_empty()]
            # The field that says most is the one of which the least crashes.
            telling.sort(key=lambda pair: (pair[1].is_relational, _measure(pair[0].sets[Reaction.CRASH])))
            if telling:
                one, met = telling[0]
                sure = not met.is_relational and (example.confirmed is True or not example.assumed)
                yield _make(CRASHING, answer, topic, one, met, row, example, sure)
    for one in fields:
        met = _find_met(row, one, one.unhandled)
        if met is not None and not met.is_empty() and not met.is_relational:
            is_frame = one.path.rpartition(".")[2] in _FRAMES
            ignored = _find_met(row, one, one.ignored)
            sure = ignored is not None and not ignored.is_empty()
            yield _make(FRAME if is_frame else UNHANDLED, answer, topic, one, met, row, None, sure)


def _find_met(row: Sender, one: FieldSets, values: FieldValues | None) -> FieldValues | None:
    """Values of a field that are sent and in a set."""
    return find_common(row.fields[one.path].values, values) if values is not None else None


def _measure(values: FieldValues) -> float:
    """How much a set holds."""
    if values.texts is not None:
        return len(values.texts)
    return sum(high - low + 1 for low, high in values.spans)


def _may_be_sent(example: CallbackExample, row: Sender) -> bool:
    """Whether a publisher can send each value that an example has in the fields that are known of it."""
    for path, bits in example.values.items():
        plain = path.removeprefix("msg.")
        kind = example.kinds.get(path)
        sent = row.fields.get(plain)
        if path.startswith("msg.") and kind is not None and sent is not None and kind[0] is not InputKind.CHARACTER:
            if sent.kind is InputKind.CHARACTER or has_value(sent.values, read_number(*kind, bits)):
                continue
            return False
    return True


def _make(
    kind: str, answer: CallbackAnswer, topic: str, sets: FieldSets, met: FieldValues, row: Sender | None,
    example: CallbackExample | None, sure: bool,
) -> Mismatch:  # fmt: skip
    values = format_values(met, sets.names)
    return Mismatch(kind, topic, answer.message_type, sets.path, values, row, answer, example, sure)


def _list_impossible(answer: CallbackAnswer, topic: str, rows: Sequence[Sender]) -> Iterator[Mismatch]:
    """Values that a subscriber tells from all others and that nobody sends."""
    for sets in answer.fields:
        handled = sets.sets.get(Reaction.HANDLED)
        if handled is None or handled.is_relational or not answer.is_complete:
            continue
        if sets.path.startswith(("this.", "global.")):
            continue
        sent = [row.fields.get(sets.path) for row in rows]
        if any(one is None or not one.is_known for one in sent):
            continue
        known = [one.values for one in sent if one is not None]
        left = [span for span in handled.spans if span[0] == span[1] and isinstance(span[0], int)]
        never = tuple(span for span in left if not any(has_value(values, span[0]) for values in known))
        if never:
            yield _make(IMPOSSIBLE, answer, topic, sets, FieldValues(never), None, None, True)
        if handled.texts is not None and all(values.texts is not None for values in known):
            texts = {text for values in known for text in values.texts or ()}
            lost = tuple(sorted(set(handled.texts) - texts))
            if lost:
                yield _make(IMPOSSIBLE, answer, topic, sets, FieldValues(texts=lost), None, None, True)


def find_common(one: FieldValues, other: FieldValues) -> FieldValues:
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
