"""What a bag tells, as text and JSON."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from ...edges.console import escape, format_count, format_json
from ...edges.version import __version__
from ..analysis.bags import BagFacts, BagField, BagTopicFacts
from .schemas import SCHEMA
from .style import Style, paint


def render_json(found: BagFacts) -> str:
    """The facts, all of them."""
    tool = {"name": "rosimpact", "version": __version__}
    return format_json({"schema": SCHEMA, "tool": tool, "bag": msgspec.to_builtins(found)})


def render_text(found: BagFacts, name: str, style: Style) -> str:
    """A table of the fields of each topic. name: of the bag."""
    return "\n".join([*_render_lines(found, name, style), ""])


def _render_lines(found: BagFacts, name: str, style: Style) -> Iterator[str]:
    part = "" if found.whole else " (the first, see --limit)"
    yield (
        f"{escape(name)}  {found.form}, {format_count(found.count, 'message')}{part} in {found.duration:.1f} s, "
        f"{format_count(len(found.topics), 'topic')}"
    )
    for topic in found.topics:
        yield ""
        yield from _render_topic(topic, style)
    if found.empty_topics:
        yield ""
        yield f"without messages: {escape(', '.join(found.empty_topics))}"


def _render_topic(topic: BagTopicFacts, style: Style) -> Iterator[str]:
    yield f"{paint(style, 'bold', escape(topic.topic))}  {escape(topic.type)}"
    rate = f", {topic.rate:.1f} Hz, {format_bytes(topic.bytes_per_second or 0)}/s" if topic.rate is not None else ""
    sizes = topic.bytes
    yield (
        f"  {format_count(topic.count, 'message')}{rate}; bytes: mean {sizes.mean:,.0f}, half up to {sizes.p50:,}, "
        f"95 % up to {sizes.p95:,}, most {sizes.max:,}"
    )
    if topic.definition and topic.definition != "bag":
        yield f"  definition: {escape(topic.definition)}"
    if topic.unlike:
        yield f"  {format_count(topic.unlike, 'message')} unlike the definition: {escape(topic.problem)}"
    elif topic.problem:
        yield f"  fields are not known: {escape(topic.problem)}; name the workspace that defines {escape(topic.type)}"
    rows = [
        (escape(field.field), f"{field.bytes:,.1f}".removesuffix(".0"), f"{100 * field.share:.1f} %", describe(field))
        for field in topic.fields
    ]
    if rows and topic.overhead > 0.05:
        share = 100 * topic.overhead / sizes.mean
        rows.append(("(padding)", f"{topic.overhead:,.1f}".removesuffix(".0"), f"{share:.1f} %", ""))
    widths = [max(len(row[at]) for row in rows) for at in range(3)] if rows else []
    for field, size, share, note in rows:
        line = f"    {field:<{widths[0]}}  {size:>{widths[1]}}  {share:>{widths[2]}}"
        yield f"{line}  {note}" if note else line


def describe(field: BagField) -> str:
    """What is to be said of a field's values."""
    if not field.bytes:
        return "never sent"
    lengths = field.lengths
    said = "" if field.filled else "always empty" if lengths is not None and not lengths.most else "always 0"
    if field.filled and not field.nonzero and lengths is not None and not field.type.partition("[")[0].count("/"):
        said = "always zeros"
    if lengths is None or not lengths.most or not field.type.endswith("[]"):
        return said
    range_ = f"{lengths.most:,}" if lengths.least == lengths.most else f"{lengths.least:,} to {lengths.most:,}"
    mean = "" if lengths.least == lengths.most else f", {lengths.mean:,.1f} on average"
    return "  ".join(filter(None, (f"{range_} elements{mean}", said)))


def format_bytes(number: float) -> str:
    """`1.2 MB`, `340 B`, in powers of ten, as bandwidth is given."""
    for size, unit in ((1e9, "GB"), (1e6, "MB"), (1e3, "kB")):
        if number >= size:
            return f"{number / size:.1f} {unit}"
    return f"{number:.0f} B"
