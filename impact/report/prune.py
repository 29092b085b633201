"""A plan of lighter messages, with what it gains where that was measured, as text and JSON."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from msgspec import to_builtins

from ...edges.console import format_count, format_json
from ..prune.planner import PrunePlan, TopicPlan
from ..prune.savings import TopicSaving
from ..prune.verify import Verification
from .bags import format_bytes
from .columns import LinePart, lay_out
from .fields import WIDE
from .schemas import SCHEMA
from .style import Style

if TYPE_CHECKING:
    from ..measure.gains import TopicGain

_MOST = 12


def render_plan_text(
    plan: PrunePlan, diff: str, everything: bool = False, style: Style = WIDE, gains: Sequence[TopicGain] = (),
    savings: Sequence[TopicSaving] = (),
) -> str:  # fmt: skip
    """The lighter messages, then the topics that keep theirs and why, then the changes. everything: fields that are
    dropped are all named. gains: of the topics that were measured. savings: of those whose rate is known."""
    lines: list[str] = []
    for one in plan.plans:
        lines += _render_topic(one, everything, style)
        lines += (line for saving in savings if saving.topic in one.topics for line in _render_saving(saving, style))
        lines += (line for gain in gains if gain.topic in one.topics for line in _render_gain(gain, style))
        lines.append("")
    for refusal in plan.refusals:
        head = [LinePart(refusal.topic, "bold"), LinePart("keeps", "dim"), LinePart(refusal.type)]
        lines += lay_out([*head, LinePart(refusal.reason)], style, 0, 4)
    count = format_count(len(plan.plans), "lighter message")
    files = format_count(len(plan.changed) + len(plan.created), "file")
    measured = _describe_measurement(gains)
    lines += ["", *measured] if measured and lines[-1] else measured
    lines += ["", f"{count}; {files} to change or write"] if plan.plans else ["", "no topic can be made lighter"]
    return "\n".join(lines).lstrip("\n") + "\n" + (f"\n{diff}" if diff else "")


def _render_topic(one: TopicPlan, everything: bool, style: Style) -> Iterator[str]:
    head = [LinePart(", ".join(one.topics), "bold"), LinePart(one.type), LinePart(f"{style.symbols[3]} {one.light}")]
    yield from lay_out(head, style, 0, 4)
    shown = one.dropped if everything else one.dropped[:_MOST]
    more = f" and {len(one.dropped) - len(shown)} more" if len(shown) < len(one.dropped) else ""
    yield from lay_out([LinePart("without", "dim"), LinePart(", ".join(shown) + more)], style, 2, 6)
    if one.full_bytes and one.light_bytes:
        share = 100 * (one.full_bytes - one.light_bytes) / one.full_bytes
        text = f"{one.full_bytes:,} B become {one.light_bytes:,} B ({share:.0f} % less)"
        yield from lay_out([LinePart("size", "dim"), LinePart(text)], style, 2, 6)
    yield from lay_out([LinePart("changes", "dim"), LinePart(", ".join(one.files))], style, 2, 6)


def _render_saving(saving: TopicSaving, style: Style) -> Iterator[str]:
    """What a topic no longer sends in a second."""
    each = f"{saving.saved_bytes:,.0f} B of {saving.full_bytes:,.0f} B in each message"
    text = f"{each}, {format_bytes(saving.saved_bytes_per_second)}/s at {saving.rate:.4g} Hz"
    yield from lay_out([LinePart("saves", "dim"), LinePart(saving.topic, "bold"), LinePart(text)], style, 2, 6)


def _render_gain(gain: TopicGain, style: Style) -> Iterator[str]:
    """What a topic's messages cost on the link, whole and pruned."""
    head = [LinePart("measured", "dim"), LinePart(gain.topic, "bold")]
    if gain.full is None or gain.pruned is None:
        yield from lay_out([*head, LinePart(f"not: {gain.failure}")], style, 2, 6)
        return
    from .measure import format_interval

    full, pruned = gain.full, gain.pruned
    yield from lay_out([*head, LinePart(f"at {gain.rate:g} Hz, {'; '.join(gain.notes)}")], style, 2, 6)
    pairs = [
        ("bytes", f"{full.bytes:,} B", f"{pruned.bytes:,} B"),
        ("sent", f"{full.offered_mbit:.2f} Mbit/s", f"{pruned.offered_mbit:.2f} Mbit/s"),
        *(
            (f"latency {name}", *(f"{format_interval(each.latency.get(name), 2)} ms" for each in (full, pruned)))
            for name in ("mean", "p95")
        ),
        ("dropped", f"{format_interval(full.dropped, 1)} %", f"{format_interval(pruned.dropped, 1)} %"),
    ]
    for name, before, after in pairs:
        yield from lay_out([LinePart(name, "dim"), LinePart(f"{before} become {after}")], style, 4, 8)


def _describe_measurement(gains: Sequence[TopicGain]) -> list[str]:
    cells = [each for gain in gains for each in (gain.full, gain.pruned) if each is not None]
    header = next((gain.header for gain in gains if gain.header is not None), None)
    if header is None:
        return []
    from .measure import describe_conditions  # it brings numpy, which a plan alone does not need

    return [*describe_conditions(header, cells), "bytes with the 20 that the measurement adds to each message"]


def render_plan_json(
    plan: PrunePlan, version: str, gains: Sequence[TopicGain] = (), savings: Sequence[TopicSaving] = ()
) -> str:
    """The whole plan, without the bytes of files. gains: of the topics that were measured. savings: of those whose
    rate is known."""
    document = {
        "schema": SCHEMA,
        "tool": {"name": "rosimpact", "version": version},
        "plans": [one._asdict() | _list_gains(one, gains) | _list_savings(one, savings) for one in plan.plans],
        "refusals": [one._asdict() for one in plan.refusals],
        "changed": sorted(plan.changed),
        "created": sorted(plan.created),
    }
    return format_json(document) + "\n"


def _list_gains(one: TopicPlan, gains: Sequence[TopicGain]) -> dict[str, object]:
    """The gains of a lighter message's topics; nothing where none was measured."""
    own = [to_builtins(gain._asdict()) for gain in gains if gain.topic in one.topics]
    return {"gains": own} if own else {}


def _list_savings(one: TopicPlan, savings: Sequence[TopicSaving]) -> dict[str, object]:
    """What a lighter message's topics save in a second; nothing where no rate is known."""
    own = [saving._asdict() for saving in savings if saving.topic in one.topics]
    return {"savings": own} if own else {}


def render_verification(done: Verification, style: Style = WIDE) -> str:
    """What was compared, topic by topic, and the first differences."""
    if done.failure:
        return f"{done.failure}\n"
    lines: list[str] = []
    for one in done.topics:
        counts = f"{one.before} messages before, {one.after} after"
        sizes = f"{one.bytes_before:,.0f} B a message before, {one.bytes_after:,.0f} B after"
        verdict = LinePart("differs", "error") if one.difference else LinePart(f"equal {one.how}", "good")
        head = [LinePart(one.topic, "bold"), LinePart(f"of {one.node}"), verdict, LinePart(counts), LinePart(sizes)]
        lines += lay_out(head, style, 0, 4)
        lines += lay_out([LinePart(one.difference)], style, 4, 4) if one.difference else []
    for text in done.exits:
        lines += lay_out([LinePart(text, "error")], style, 0, 4)
    if not done.topics:
        lines.append("both versions build; with --run, what they do is compared too")
    else:
        lines += ["", "both versions do the same" if done.is_equal else "the versions differ"]
    return "\n".join(lines) + "\n"
