"""What publishers send against what subscribers handle, topic by topic and field by field."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from ..model.flow.graph import Graph
from ..model.flow.workspace import get_flow
from .answers import CallbackAnswer, CallbackExample, FieldSets, SentThrough, SentValues, SentWay
from .narrowing import GivenMessage, MessageCrash, MessageOutcome
from .outcomes import CodeLine, CrashKind, InputKind, Reaction
from .projection import FieldValues, Number, format_values
from .survey import CallbackKey, Judged, Request, Survey, get_key

UNHANDLED, CRASHING, IMPOSSIBLE = "unhandled-value", "crashing-value", "impossible-branch"
FRAME, SIZE, UNIT = "frame-mismatch", "size-mismatch", "unit-mismatch"
_FRAMES = ("frame_id", "child_frame_id")
_MOST_MESSAGES = 24
_INDEX = re.compile(r"\[\d+\]")
_SEVERITIES = ("note", "warning", "error")
_MOST_LISTED = 32
_BEYOND_END = (CrashKind.INDEX, CrashKind.EMPTY)
# What members lead to that a constructor would have filled.
_OF_MEMBERS = (CrashKind.INDEX, CrashKind.EMPTY, CrashKind.NULL, CrashKind.DANGLING, CrashKind.EXCEPTION)


class EarlierSender(NamedTuple):
    """Who sent what a publisher passes on: the callback, the topic, and where."""

    callback: str
    topic: str
    place: CodeLine


class Sender(NamedTuple):
    """One statement that publishes on a topic: the callback that it runs in, where it is, and what it can send. ways:
    the messages with what is exact of them; is_listed: whether these are all. via: who sent what the callback received;
    empty where that may be anybody. key: of the callback; nodes: that run it."""

    callback: str
    places: tuple[CodeLine, ...]
    fields: Mapping[str, SentValues]
    type: str = ""
    ways: tuple[SentWay, ...] = ()
    is_listed: bool = False
    via: tuple[EarlierSender, ...] = ()
    key: CallbackKey | None = None
    nodes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Mismatch:
    """A value that one side sends and the other does not handle. kind: the name of a rule. severity: error, warning or
    note. values: as text. sure: of a crash, that this very message leads to it, whatever else holds; of a value that is
    not handled, that nothing at all follows, not even a line in the log. is_sent: the publisher sends it without being
    asked, or because of what it is known to receive. subscriber: None where a value goes against
    the standard alone. place: of the crash, or of what reads a unit. why: what crashes, or what the unit should be."""

    kind: str
    severity: str
    topic: str
    message_type: str
    field: str
    values: str
    sender: Sender | None
    subscriber: CallbackAnswer | None
    example: CallbackExample | None = None
    sure: bool = True
    place: CodeLine | None = None
    why: str = ""
    is_sent: bool = True


class TopicPublishers:
    """What is known of the publishers of topics."""

    def __init__(self, graph: Graph):
        self.graph = graph
        self._topics: dict[tuple[str, int], dict[str, set[str]]] = {}
        self._types: dict[tuple[str, int], set[str]] = {}
        self._places: dict[str, set[tuple[str, int]]] = {}
        for one in graph.publishes:
            place = (one.path, one.line)
            self._topics.setdefault(place, {}).setdefault(one.node, set()).add(one.topic)
            self._places.setdefault(one.topic, set()).add(place)
            if one.type:
                self._types.setdefault(place, set()).add(one.type)
        self._has_open_names = any(
            one.role == "publisher" and one.how in ("unresolved", "partly") for one in graph.endpoints
        ) or any(not one.topic for one in graph.publishes)
        # TopicPublishers of which no statement is known: who gets them may send anything.
        sending = {(one.node, one.topic) for one in graph.publishes}
        self._unknown = {
            one.topic
            for one in graph.endpoints
            if one.role == "publisher" and (one.implied or (one.node, one.topic) not in sending)
        }

    def list_topics(self, place: CodeLine) -> set[str]:
        """The topics on which a statement publishes: one for each node that runs it; none where a node publishes on
        several there, or where one is not known."""
        by_node = self._topics.get((place.path, place.line), {})
        if not all(len(topics) == 1 for topics in by_node.values()):
            return set()
        found = {topic for topics in by_node.values() for topic in topics}
        return set() if "" in found else found

    def find_type(self, place: CodeLine) -> str:
        """The type that a statement publishes, empty where it is not known."""
        found = self._types.get((place.path, place.line), set())
        return next(iter(found)) if len(found) == 1 else ""

    def is_complete(self, topic: str, senders: Iterable[Sender]) -> bool:
        """Whether some senders are all that publish on a topic, as far as the workspace tells."""
        if self._has_open_names or topic in self._unknown:
            return False
        seen = {(place.path, place.line) for row in senders for place in row.places}
        return bool(seen) and self._places.get(topic, set()) <= seen


Senders = dict[str, list[Sender]]
"""By topic."""


def list_senders(answers: Iterable[CallbackAnswer], publishers: TopicPublishers) -> Senders:
    """What callbacks publish, by topic, as far as the graph names the topic of a statement."""
    found: Senders = {}
    for answer in answers:
        for sent in answer.sent:
            for topic in _list_common_topics(sent, publishers):
                found.setdefault(topic, []).append(_make_sender(answer, sent, publishers))
    return found


def _list_common_topics(sent: SentThrough, publishers: TopicPublishers) -> set[str]:
    return publishers.list_topics(sent.places[0]) if len(sent.places) == 1 else set()


def _make_sender(
    answer: CallbackAnswer, sent: SentThrough, publishers: TopicPublishers, via: tuple[EarlierSender, ...] = ()
) -> Sender:
    return Sender(
        answer.callback, sent.places, {one.path: one for one in sent.fields}, publishers.find_type(sent.places[0]),
        sent.ways, sent.is_listed, via, get_key(answer), answer.nodes,
    )  # fmt: skip


def list_mismatches(
    answers: Sequence[CallbackAnswer], graph: Graph, survey: Survey, ros: int, jobs: int = 1
) -> list[Mismatch]:
    """All mismatches between the callbacks of a survey. ros: 1 or 2. Topics with a publisher that was not explored, or
    whose name is not certain, have no impossible branches."""
    publishers = TopicPublishers(graph)
    senders = _follow_one_hop(answers, list_senders(answers, publishers), publishers, survey, jobs)
    judged = _Verdicts(answers, senders, survey, jobs)
    started = [{one.node for one in launch.starts} for launch in get_flow(survey.workspace).launches]
    found: list[Mismatch] = []
    for answer in answers:
        if answer.kind != "subscriber" or not answer.is_explored:
            continue
        for topic in answer.topics:
            rows = [row for row in senders.get(topic, []) if _fits(row, answer)]
            for row in rows:
                for one in _list_crashes(answer, topic, row, judged, ros):
                    is_lone = one.severity == "error" and not _run_together(row.nodes, answer.nodes, started)
                    found.append(replace(one, severity="warning") if is_lone else one)
                found.extend(_list_unhandled(answer, topic, row, judged))
            if publishers.is_complete(topic, rows):
                found.extend(_list_impossible(answer, topic, rows))
    return _drop_repeats(found)


def _run_together(some: Sequence[str], others: Sequence[str], started: Sequence[set[str]]) -> bool:
    """Whether some nodes run at the same time as others, as far as is known: a launch file starts both, they are one,
    or no launch file starts any of them. started: nodes by launch file."""
    if set(some) & set(others) or any(not nodes.isdisjoint(some) and not nodes.isdisjoint(others) for nodes in started):
        return True
    return bool(some and others) and all(nodes.isdisjoint((*some, *others)) for nodes in started)


def _drop_repeats(found: Iterable[Mismatch]) -> list[Mismatch]:
    """Each once: a statement that several programs or callbacks run says the same. What is certain comes first, then
    what needs no earlier sender."""
    kept: dict[tuple[object, ...], Mismatch] = {}
    for one in found:
        values = one.values if one.place is None else ""
        reader = get_key(one.subscriber) if one.subscriber is not None else None
        places = one.sender.places if one.sender is not None else ()
        key = (one.kind, one.topic, one.field, values, reader, one.place, places)
        known = kept.get(key)
        if known is None or _rank(one) > _rank(known):
            kept[key] = one
    return list(kept.values())


def _rank(one: Mismatch) -> tuple[int, bool]:
    return _SEVERITIES.index(one.severity), not (one.sender is not None and one.sender.via)


def _fits(row: Sender, answer: CallbackAnswer) -> bool:
    """Whether a message of a publisher reaches a subscriber: the types are one."""
    return not row.type or not answer.message_type or row.type == answer.message_type


def _make_message(row: Sender, way: SentWay) -> GivenMessage:
    possible = {
        one.path: one.values
        for one in row.fields.values()
        if one.kind is not InputKind.CHARACTER and one.is_known and one.path not in way.exact
    }
    return GivenMessage(way.exact, possible)


def _follow_one_hop(
    answers: Sequence[CallbackAnswer], senders: Senders, publishers: TopicPublishers, survey: Survey, jobs: int
) -> Senders:
    """Senders with what callbacks make of what they receive. A callback whose publishers are all known sends no more
    than what follows from these; any callback passes on what follows from a message that is known."""
    requests: list[Request] = []
    origins: dict[CallbackKey, list[tuple[str, Sender, SentWay]]] = {}
    by_key = {get_key(one): one for one in answers}
    heard = {topic for one in answers if one.kind == "subscriber" for topic in one.topics}
    for answer in answers:
        if answer.kind != "subscriber" or not answer.sent:
            continue
        rows = [
            (topic, row, way)
            for topic in answer.topics
            for row in senders.get(topic, [])
            if _fits(row, answer) and row.key != get_key(answer)
            for way in row.ways
        ]
        if not rows or not any(heard & _list_common_topics(sent, publishers) for sent in answer.sent):
            continue
        if len(rows) <= _MOST_MESSAGES:
            origins[get_key(answer)] = rows
            messages = tuple(_make_message(row, way) for _, row, way in rows)
            requests.append(Request(get_key(answer), messages, True))
    judged = survey.judge(requests, jobs) if requests else {}
    found: Senders = {topic: list(rows) for topic, rows in senders.items()}
    for key, one in judged.items():
        answer = by_key[key]
        is_closed = all(
            publishers.is_complete(topic, senders.get(topic, []))
            and all(row.is_listed and row.key != key for row in senders.get(topic, []))
            and all(field.is_known for row in senders.get(topic, []) for field in row.fields.values())
            for topic in answer.topics
        )
        if is_closed and one.together is not None:
            found = {topic: [row for row in rows if row.key != key] for topic, rows in found.items()}
            _add_senders(found, answer, one.together, publishers, ())
        for (topic, row, way), sent in zip(origins[key], one.sent, strict=True):
            if not way.is_assumed:
                _add_senders(found, answer, sent, publishers, (EarlierSender(row.callback, topic, way.place),))
    return found


def _add_senders(
    found: Senders,
    answer: CallbackAnswer,
    sent: Sequence[SentThrough],
    publishers: TopicPublishers,
    via: tuple[EarlierSender, ...],
) -> None:
    """Adds what a callback sends, where that is not known of it already."""
    for one in sent:
        for topic in _list_common_topics(one, publishers):
            rows = found.setdefault(topic, [])
            known = {
                _spell_exact(way)
                for row in rows
                if row.places == one.places and not row.via
                for way in row.ways
                if _is_sent_surely(way)
            }
            ways = tuple(way for way in one.ways if not via or _spell_exact(way) not in known)
            if ways:
                rows.append(_make_sender(answer, replace(one, ways=ways), publishers, via))


def _spell_exact(way: SentWay) -> tuple[tuple[str, str], ...]:
    return tuple(sorted((path, repr(value)) for path, value in way.exact.items()))


class _Verdicts:
    """What subscribers do with the messages of their publishers."""

    def __init__(self, answers: Sequence[CallbackAnswer], senders: Senders, survey: Survey, jobs: int):
        self._outcomes: dict[tuple[CallbackKey, int], MessageOutcome] = {}
        self._subscribers: dict[str, list[CallbackAnswer]] = {}
        self._open: dict[str, bool] = {}
        requests: list[Request] = []
        numbers: dict[CallbackKey, list[int]] = {}
        for answer in answers:
            if answer.kind != "subscriber":
                continue
            for topic in answer.topics:
                self._subscribers.setdefault(topic, []).append(answer)
            if not _can_fail(answer):
                continue
            rows = [
                (way, _make_message(row, way))
                for topic in answer.topics
                for row in senders.get(topic, [])
                if _fits(row, answer)
                for way in row.ways
            ][: 4 * _MOST_MESSAGES]
            if rows:
                numbers[get_key(answer)] = [id(way) for way, _ in rows]
                requests.append(Request(get_key(answer), tuple(message for _, message in rows), False))
        self._kept = senders  # whose ways are told from each other by their ids
        judged: dict[CallbackKey, Judged] = survey.judge(requests, jobs) if requests else {}
        for key, one in judged.items():
            for number, outcome in zip(numbers[key], one.outcomes, strict=True):
                self._outcomes[key, number] = outcome

    def find(self, answer: CallbackAnswer, way: SentWay) -> MessageOutcome | None:
        return self._outcomes.get((get_key(answer), id(way)))

    def may_be_handled_elsewhere(self, topic: str, way: SentWay, answer: CallbackAnswer) -> bool:
        """Whether another subscriber of a topic may do something with a message."""
        for other in self._subscribers.get(topic, []):
            if get_key(other) == get_key(answer):
                continue
            outcome = self.find(other, way)
            if outcome is None or not outcome.reactions or not outcome.is_whole:
                return True
            if Reaction.HANDLED in outcome.reactions:
                return True
        return False


def _can_fail(answer: CallbackAnswer) -> bool:
    """Whether something else than being handled can follow from a message."""
    others = (Reaction.CRASH, Reaction.IGNORED, Reaction.LOG_ONLY)
    return answer.is_explored and any(answer.counts.get(each) for each in others)


def _list_crashes(
    answer: CallbackAnswer, topic: str, row: Sender, judged: _Verdicts, ros: int
) -> Iterator[Mismatch]:  # fmt: skip
    """Crashes of a subscriber that messages of a publisher lead to, each once."""
    found: dict[tuple[CrashKind, CodeLine], tuple[str, SentWay, MessageCrash]] = {}
    if answer.counts.keys() <= {Reaction.CRASH, Reaction.UNKNOWN}:
        return  # what crashes on every message has most likely not been made as in a real node
    for way in row.ways:
        outcome = judged.find(answer, way)
        for crash in outcome.crashes if outcome is not None else ():
            # Whether it crashes depends on more than the message, or whether the message is sent does.
            certain = crash.is_certain and not (answer.is_bare and crash.kind in _OF_MEMBERS)
            severity = "note" if not certain else "error" if _is_sent_surely(way) else "warning"
            known = found.get((crash.kind, crash.place))
            if known is None or _SEVERITIES.index(severity) > _SEVERITIES.index(known[0]):
                found[crash.kind, crash.place] = severity, way, crash
    for severity, way, crash in found.values():
        example = _find_example(answer, crash)
        if example is not None and example.confirmed is False:
            continue
        sizes = _list_sizes(answer, way, crash) if crash.kind in _BEYOND_END else []
        told = _find_telling(answer, way, crash) if not sizes else (sizes[0][0], _spell_sizes(sizes))
        if told is None:
            continue
        field, values = told
        # In rospy, an exception ends the callback, and the node goes on.
        goes_on = ros == 1 and answer.language == "python" and crash.kind is not CrashKind.ENDLESS
        yield Mismatch(
            SIZE if sizes else CRASHING, "warning" if goes_on and severity == "error" else severity, topic,
            answer.message_type, field, values, row, answer, example, severity != "note", crash.place, crash.kind.value,
            _is_sent_surely(way),
        )  # fmt: skip


def _is_sent_surely(way: SentWay) -> bool:
    """Whether a publisher sends a message without being asked, or because of what it is known to receive."""
    return not way.is_assumed and not way.asks


def _list_sizes(answer: CallbackAnswer, way: SentWay, crash: MessageCrash) -> list[tuple[str, int]]:
    """The arrays on whose sizes a crash depends, the smallest first."""
    every = ((0, answer.bounds.array),)
    free = {one.path for one in answer.fields if Reaction.CRASH in one.sets and one.sets[Reaction.CRASH].spans == every}
    names = [one for one in crash.fields if one.endswith(".size") and not _is_text(answer, one) and one not in free]
    found = [(one.removesuffix(".size"), int(way.exact[one])) for one in names if one in way.exact]
    return sorted(found, key=lambda row: row[1])


def _spell_sizes(sizes: Sequence[tuple[str, int]]) -> str:
    return ", ".join(f"{name} {size}" for name, size in sizes)


def _find_example(answer: CallbackAnswer, crash: MessageCrash) -> CallbackExample | None:
    same = [one for one in answer.examples if one.crash is crash.kind and one.place == crash.place]
    return same[0] if same else None


def _find_telling(answer: CallbackAnswer, way: SentWay, crash: MessageCrash) -> tuple[str, str] | None:
    """The field of a message that tells most of a crash, and its value: the one of which the least crashes."""
    rows: list[tuple[int, float, FieldSets | None, str]] = []
    sets = {one.path: one for one in answer.fields}
    order = list(sets)
    names = sorted(crash.fields, key=lambda name: order.index(name) if name in sets else len(order))
    for name in names:
        value = way.exact.get(name)
        one = sets.get(name)
        if value is None:
            continue
        crashing = one.sets.get(Reaction.CRASH) if one is not None else None
        if one is None or crashing is None or not has_value(crashing, _adapt(one, value)):
            rows.append((1, math.inf, one, name))
        else:
            rows.append((0, _measure(crashing), one, name))
    if not rows:
        return None
    # Of several fields that say as much, the size of an array, then the first.
    rows.sort(key=lambda row: (row[0], row[1], not row[3].endswith(".size")))
    _, _, one, name = rows[0]
    return name, _spell_value(way.exact[name], one)


def _is_text(answer: CallbackAnswer, field: str) -> bool:
    stem = _INDEX.sub("[]", field.removesuffix(".size"))
    return any(one.path == stem and one.kind is InputKind.CHARACTER for one in answer.fields)


def _adapt(one: FieldSets, value: Number) -> Number:
    """A value as a field has it."""
    return float(value) if one.kind in (InputKind.FLOAT32, InputKind.FLOAT64) else value


def _spell_value(value: Number, one: FieldSets | None) -> str:
    if one is not None and isinstance(value, int) and value in one.names:
        return one.names[value]
    return "NaN" if isinstance(value, float) and math.isnan(value) else repr(value)


def _measure(values: FieldValues) -> float:
    """How much a set holds."""
    if values.texts is not None:
        return len(values.texts)
    return sum(high - low + 1 for low, high in values.spans)


def _list_unhandled(answer: CallbackAnswer, topic: str, row: Sender, judged: _Verdicts) -> Iterator[Mismatch]:
    """Messages of a publisher after which nothing follows, by the field that makes the difference."""
    if not answer.counts.get(Reaction.HANDLED):
        return  # it only looks on
    found: dict[str, dict[str, tuple[bool, bool, FieldSets]]] = {}
    for way in row.ways:
        outcome = judged.find(answer, way)
        if outcome is None or not outcome.is_whole or not outcome.reactions or way.is_assumed:
            continue
        if not outcome.reactions <= {Reaction.IGNORED, Reaction.LOG_ONLY}:
            continue
        elsewhere = judged.may_be_handled_elsewhere(topic, way, answer)
        for one, text in _list_telling_values(answer, way):
            is_silent = outcome.reactions == {Reaction.IGNORED}
            known = found.setdefault(one.path, {}).get(text)
            found[one.path][text] = (
                is_silent and (known is None or known[0]), elsewhere or (known is not None and known[1]), one,
            )  # fmt: skip
    for path, values in found.items():
        one = next(iter(values.values()))[2]
        is_frame = path.rpartition(".")[2] in _FRAMES
        elsewhere = any(each[1] for each in values.values())
        # What an empty message has is often meant to do nothing.
        is_plain = not is_frame and values.keys() <= {"0", "False", '""', one.names.get(0, "0")}
        severity = "warning" if _is_choice(one) and not elsewhere and not is_plain else "note"
        sure = all(each[0] for each in values.values())
        kind = FRAME if is_frame else UNHANDLED
        yield Mismatch(
            kind, severity, topic, answer.message_type, path, ", ".join(values), row, answer, None, sure,
        )  # fmt: skip


def _list_telling_values(answer: CallbackAnswer, way: SentWay) -> Iterator[tuple[FieldSets, str]]:
    """Fields whose value in a message is none of those that a callback handles."""
    for one in answer.fields:
        handled = one.sets.get(Reaction.HANDLED)
        if handled is None or one.path.startswith(("this.", "global.", "~")) or not handled.is_complete:
            continue
        if one.kind is InputKind.CHARACTER:
            text = _read_text(way, one.path)
            if text is not None and handled.texts is not None and text not in handled.texts:
                yield one, format_values(FieldValues(texts=(text,)))
            continue
        value = way.exact.get(one.path)
        if value is not None and not has_value(handled, _adapt(one, value)):
            yield one, _spell_value(_adapt(one, value), one)


def _read_text(way: SentWay, path: str) -> bytes | None:
    size = way.exact.get(f"{path}.size")
    if size is None:
        return None
    found = [way.exact.get(f"{path}[{at}]") for at in range(int(size))]
    return bytes(int(each) & 0xFF for each in found if each is not None) if None not in found else None


def _is_choice(one: FieldSets) -> bool:
    """Whether a callback tells a few values of a field from each other: a switch, a chain of comparisons with names."""
    handled = one.sets[Reaction.HANDLED]
    if one.kind is InputKind.CHARACTER:
        return handled.texts is not None
    if one.kind is not InputKind.INTEGER or handled.infinities or handled.has_nan:
        return False
    listed = len(_list_single(handled))
    return listed > 1 or (listed == 1 and bool(one.names))


def _tells_apart(one: FieldSets) -> bool:
    """Whether there are values of a field that a callback surely does not handle, or a few texts that it does. Where it
    handles all, it may not look at the field."""
    return one.sets[Reaction.HANDLED].texts is not None or (one.unhandled is not None and not one.unhandled.is_empty())


def _list_impossible(answer: CallbackAnswer, topic: str, rows: Sequence[Sender]) -> Iterator[Mismatch]:
    """Values that a subscriber tells from all others and that nobody sends."""
    for sets in answer.fields:
        handled = sets.sets.get(Reaction.HANDLED)
        if handled is None or handled.is_relational or not answer.is_complete:
            continue
        if sets.path.startswith(("this.", "global.", "~")) or not _tells_apart(sets):
            continue
        sent = [row.fields.get(sets.path) for row in rows]
        if any(one is None or not one.is_known for one in sent):
            continue
        known = [one.values for one in sent if one is not None]
        # Lengths of a text go as far as was looked, and are no values that a callback waits for.
        listed = _list_single(handled) if sets.kind not in (InputKind.SIZE, InputKind.CHARACTER) else []
        never = tuple((value, value) for value in listed if not any(has_value(values, value) for values in known))
        lost: tuple[bytes, ...] = ()
        if handled.texts is not None and all(values.texts is not None for values in known):
            texts = {text for values in known for text in values.texts or ()}
            lost = tuple(sorted(set(handled.texts) - texts))
        for values in (FieldValues(never) if never else None, FieldValues(texts=lost) if lost else None):
            if values is not None:
                text = format_values(values, sets.names)
                yield Mismatch(IMPOSSIBLE, "note", topic, answer.message_type, sets.path, text, None, answer)


def _list_single(values: FieldValues) -> list[int]:
    """The values of a set of whole numbers, where it lists a few."""
    spans = [(low, high) for low, high in values.spans if isinstance(low, int) and isinstance(high, int)]
    if len(spans) != len(values.spans) or sum(high - low + 1 for low, high in spans) > _MOST_LISTED:
        return []
    return [value for low, high in spans for value in range(low, high + 1)]


def has_value(values: FieldValues, number: Number) -> bool:
    """Whether a number is in a set."""
    if isinstance(number, float) and math.isnan(number):
        return values.has_nan
    if isinstance(number, float) and math.isinf(number):
        return number in values.infinities
    return any(low <= number <= high for low, high in values.spans)
