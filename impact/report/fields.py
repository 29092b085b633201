"""Which fields of topics are read and set, as text and JSON."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import msgspec

from ...edges.console import format_count, format_json
from ..analysis.bags import BagFacts
from ..analysis.fields import FieldAnswer
from ..model.fields.report import FieldAt, FieldReport, PublisherFields, SubscriberFields, TopicFields
from .bags import format_bytes
from .columns import UNBROKEN, LinePart, lay_out
from .schemas import SCHEMA
from .style import Style

WIDE = Style(width=UNBROKEN)
_MOST = 12


def render_fields_text(answer: FieldAnswer, everything: bool = False, style: Style = WIDE) -> str:
    """The topics, each with who reads and sets what. everything: fields that are read are named one by one, and no list
    is cut."""
    report = answer.report
    lines: list[str] = []
    for topic in report.topics:
        lines += _render_topic(topic, everything, style)
        size = answer.sizes.get((topic.topic, topic.type))
        if size is not None and topic.unread:
            text = f"{size.unread:,} B of {size.full:,} B in each message"
            lines += lay_out([LinePart("saves", "good"), LinePart(text)], style, 2, 6)
        lines.append("")
    for topic in report.unnamed:
        lines += [*_render_topic(topic, everything, style), ""]
    for topic, type_ in report.unknown if everything else ():
        lines.append(f"{topic}  {type_}: its fields are not known")
    lines += list(lay_out([LinePart(summarize_fields(report))], style, 0, 2))
    return "\n".join(lines) + "\n"


def summarize_fields(report: FieldReport) -> str:
    """What was found, on one line."""
    rows = (*report.topics, *report.unnamed)
    callbacks = {(one.path, one.line): one for topic in rows for one in topic.subscribers}
    whole = sum(any(not escape.field for escape in one.escapes) for one in callbacks.values())
    unread = sum(len(topic.unread) for topic in report.topics)
    lighter = sum(bool(topic.unread) for topic in report.topics)
    more = f"; of {format_count(len(report.unknown), 'topic')} the fields are not known" if report.unknown else ""
    return (
        f"{format_count(len(report.topics), 'topic')}, {format_count(len(callbacks), 'subscriber')}, of which {whole} "
        f"hand on whole messages; {format_count(unread, 'field')} of {format_count(lighter, 'topic')} are read by "
        f"nobody{more}"
    )


def _render_topic(topic: TopicFields, everything: bool, style: Style) -> Iterator[str]:
    count = format_count(len(topic.fields), "field")
    name = LinePart(topic.topic, "bold") if topic.topic else LinePart("(a name that is not known)", "dim")
    yield from lay_out([name, LinePart(topic.type), LinePart(count, "dim")], style, 0, 4)
    for subscriber in _drop_equal(topic.subscribers):
        yield from _render_subscriber(subscriber, everything, style)
    for publisher in _drop_equal(topic.publishers):
        yield from _render_publisher(publisher, everything, style)
    for why in () if not topic.topic else topic.open if everything else topic.open[:2]:
        yield from lay_out([LinePart("may be read elsewhere:", "dim"), LinePart(why)], style, 2, 6)
    if not everything and len(topic.open) > 2:
        yield f"  and {format_count(len(topic.open) - 2, 'further reason')}; --all shows them"
    if topic.unread:
        text = _list_names(topic.unread, everything)
        yield from lay_out([LinePart("read by nobody:", "good"), LinePart(text)], style, 2, 6)


def _render_subscriber(one: SubscriberFields, everything: bool, style: Style) -> Iterator[str]:
    place = f"{one.path}:{one.line}"
    pieces = [LinePart("subscriber"), LinePart(one.callback, "bold"), LinePart("", "dim", place)]
    yield from lay_out(pieces, style, 2, 6)
    for escape in one.escapes if everything else one.escapes[:4]:
        what = escape.field or "the whole message"
        pieces = [LinePart("hands on"), LinePart(f"{what}: {escape.reason}")]
        yield from lay_out([*pieces, LinePart("", "dim", f"{escape.path}:{escape.line}")], style, 4, 8)
    if not everything and len(one.escapes) > 4:
        yield f"    and {format_count(len(one.escapes) - 4, 'further place')} that hand on; --all shows them"
    yield from _render_places("reads", (*one.reads, *one.sizes), everything, style)
    if one.unread:
        names = LinePart(_list_names(one.unread, everything))
        yield from lay_out([LinePart("never reads", "good"), names], style, 4, 8)


def _render_publisher(one: PublisherFields, everything: bool, style: Style) -> Iterator[str]:
    yield from lay_out([LinePart("publisher"), LinePart("", "dim", f"{one.path}:{one.line}")], style, 2, 6)
    yield from _render_places("sets", one.sets, everything, style)
    if one.unknown:
        yield from lay_out([LinePart(f"may set others: {one.unknown}", "dim")], style, 4, 8)


def _render_places(word: str, places: Sequence[FieldAt], everything: bool, style: Style) -> Iterator[str]:
    if everything:
        for one in places:
            yield from lay_out(
                [LinePart(word), LinePart(one.field), LinePart("", "dim", f"{one.path}:{one.line}")], style, 4, 8
            )
    elif places:
        yield from lay_out([LinePart(word), LinePart(_list_names([one.field for one in places], False))], style, 4, 8)


def _list_names(names: Sequence[str], everything: bool) -> str:
    shown = names if everything else names[:_MOST]
    more = f" and {len(names) - len(shown)} more" if len(shown) < len(names) else ""
    return ", ".join(shown) + more


def _drop_equal(rows: Sequence[Any]) -> list[Any]:
    """One of those that stand at one place, which several nodes run."""
    return list({(one.path, one.line): one for one in reversed(rows)}.values())[::-1]


def render_savings(report: FieldReport, bag: BagFacts, style: Style = WIDE) -> str:
    """What a recording says that the fields take which nobody reads."""
    rows = {(one.topic, one.type): one for one in report.topics if one.unread}
    lines: list[str] = []
    for topic in bag.topics:
        known = rows.get((topic.topic, topic.type))
        wasted = sum(field.bytes for field in topic.fields if known is not None and field.field in known.unread)
        if known is not None and wasted:
            each = f"{wasted:,.0f} B of {topic.bytes.mean:,.0f} B in each message"
            rate = f", {format_bytes(wasted * topic.rate)}/s" if topic.rate is not None else ""
            pieces = [LinePart(topic.topic, "bold"), LinePart("read by nobody here:", "good")]
            names = LinePart(f"{_list_names(known.unread, False)}: {each}{rate}")
            lines += lay_out([*pieces, names], style, 0, 4)
    return "\n" + "\n".join(lines) + "\n" if lines else ""


def render_fields_json(answer: FieldAnswer, version: str) -> str:
    """The whole report; `bytes` and `unread_bytes` of topics whose messages' size is known."""
    document = {"schema": SCHEMA, "tool": {"name": "rosimpact", "version": version}}
    document.update(msgspec.to_builtins(answer.report))
    for topic in document["topics"]:
        size = answer.sizes.get((topic["topic"], topic["type"]))
        if size is not None:
            topic.update(bytes=size.full, unread_bytes=size.unread)
    return format_json(document) + "\n"
