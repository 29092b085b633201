"""What callbacks handle, ignore and crash on, as text and JSON."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from ...edges.console import format_count, format_json
from ..analysis.values import ValuesAnswer
from ..values.answers import CallbackAnswer, CallbackExample, FieldSets, read_example
from ..values.comparing import CALLBACK
from ..values.harness.replay import Replayed
from ..values.matching import CRASHING, FRAME, IMPOSSIBLE, SIZE, UNIT, Mismatch
from ..values.outcomes import Bounds, CodeLine, CrashKind, InputKind, Reaction
from ..values.projection import FieldValues, format_values
from ..values.witnesses import WitnessRecord
from .columns import UNBROKEN, LinePart, lay_out
from .schemas import SCHEMA
from .style import Style

WIDE = Style(width=UNBROKEN)
_MOST = 12
_ROLES = {Reaction.CRASH: "error", Reaction.IGNORED: "warning", Reaction.HANDLED: "good", Reaction.LOG_ONLY: "note"}
_SHOWN = (Reaction.HANDLED, Reaction.LOG_ONLY, Reaction.IGNORED, Reaction.CRASH)


def render_values_text(answer: ValuesAnswer, everything: bool = False, style: Style = WIDE) -> str:
    """The callbacks with the values of their fields, then what does not fit together; with a base, what changed since.
    everything: no list is cut."""
    if answer.base:
        return _render_changes(answer, style)
    lines: list[str] = []
    for callback in answer.report.callbacks:
        if everything or not callback.reason:
            lines += [*_render_callback(callback, everything, style), ""]
    for mismatch in answer.mismatches:
        lines += _render_mismatch(mismatch, style)
    if answer.mismatches:
        lines.append("")
    lines += _render_reasons(answer, everything, style)
    lines += lay_out([LinePart(summarize_values(answer))], style, 0, 2)
    lines += lay_out([LinePart(_describe_bounds(answer.report.bounds), "dim")], style, 0, 2)
    return "\n".join(lines) + "\n"


def _render_changes(answer: ValuesAnswer, style: Style) -> str:
    """The sets that changed since the base, callback by callback."""
    lines: list[str] = []
    last = ("", "", 0)
    for one in answer.changes:
        if (one.callback, one.path, one.line) != last:
            last = (one.callback, one.path, one.line)
            pieces = [LinePart(one.callback, "bold"), LinePart("", "dim", f"{one.path}:{one.line}")]
            lines += lay_out(pieces, style, 0, 4)
        if one.what == CALLBACK:
            lines += lay_out([LinePart(f"the callback is {one.new}")], style, 2, 6)
            continue
        role = next((_ROLES[each] for each in _SHOWN if each.value == one.what), "note")
        pieces = [LinePart(" ".join(part for part in (one.topic, one.field) if part)), LinePart(one.what, role)]
        pieces += [LinePart(f"was {one.old or 'nothing'}"), LinePart(f"is {one.new or 'nothing'}")]
        lines += lay_out(pieces, style, 2, 6)
    count = format_count(len([one for one in answer.changes if one.what != CALLBACK]), "set")
    lines += lay_out([LinePart(f"{count} of values changed since {answer.base}")], style, 0, 2)
    lines += lay_out([LinePart(_describe_bounds(answer.report.bounds), "dim")], style, 0, 2)
    return "\n".join(lines) + "\n"


def summarize_values(answer: ValuesAnswer) -> str:
    """What was found, on one line."""
    rows = answer.report.callbacks
    explored = [one for one in rows if one.is_explored]
    crashing = [one for one in explored if one.counts.get(Reaction.CRASH)]
    confirmed = sum(any(each.confirmed and each.crash for each in one.examples) for one in crashing)
    tried = f", {confirmed} of them seen in a replay" if answer.report.replayed and crashing else ""
    found = format_count(len(answer.mismatches), "value") + " sent that nobody handles" if answer.mismatches else ""
    text = (
        f"{format_count(len(rows), 'callback')}, {len(explored)} explored to a verdict; "
        f"{len(crashing)} can crash{tried}"
    )
    return f"{text}; {found}" if found else text


def _describe_bounds(bounds: Bounds) -> str:
    return (
        f"within texts of {bounds.text} bytes, arrays of {bounds.array} elements, loops of {bounds.loops} rounds and "
        f"{bounds.seconds:g} s for each callback ({bounds.compiling:g} s for compiling its source); values of other "
        "sizes were not looked at"
    )


def _render_callback(one: CallbackAnswer, everything: bool, style: Style) -> Iterator[str]:
    where = ", ".join(one.topics[:3]) or one.kind
    pieces = [LinePart(one.callback, "bold"), LinePart(where), LinePart(one.message_type, "dim")]
    yield from lay_out([*pieces, LinePart("", "dim", f"{one.path}:{one.line}")], style, 0, 4)
    if one.reason:
        yield from lay_out([LinePart("not explored:", "warning"), LinePart(one.reason)], style, 2, 6)
        return
    fields = one.fields if everything else one.fields[:_MOST]
    width = max((len(_name_field(field)) for field in fields), default=0)
    for field in fields:
        yield from _render_field(field, width, style)
    if len(fields) < len(one.fields):
        yield f"  and {format_count(len(one.fields) - len(fields), 'further field')}; --all shows them"
    for example in one.examples:
        if everything or example.result is Reaction.CRASH:
            yield from _render_example(example, style)
    counts = ", ".join(f"{one.counts[each]} {each.value}" for each in Reaction if one.counts.get(each))
    yield from lay_out([LinePart(f"ways: {counts}", "dim"), LinePart(f"{one.seconds:.1f} s", "dim")], style, 2, 6)
    for reason, count in sorted(one.unknown.items(), key=lambda row: -row[1])[: None if everything else 3]:
        yield from lay_out([LinePart("unknown:", "warning"), LinePart(f"{reason} ({count})")], style, 2, 6)
    if one.beyond:
        text = f"larger {', '.join(one.beyond[:3])} than --array and --text allow may lead to something else"
        yield from lay_out([LinePart("bound:", "warning"), LinePart(text)], style, 2, 6)
    if one.left:
        yield from lay_out([LinePart("unknown:", "warning"), LinePart(f"{one.left} ways were not ended")], style, 2, 6)
    if one.assumed:
        text = "; ".join(one.assumed if everything else one.assumed[:3])
        yield from lay_out([LinePart("taken to be any value:", "dim"), LinePart(text, "dim")], style, 2, 6)


def _name_field(field: FieldSets) -> str:
    return f"{field.path} (bytes)" if field.kind is InputKind.CHARACTER and _has_sizes(field) else field.path


def _has_sizes(field: FieldSets) -> bool:
    return any(values.texts is None for values in field.sets.values())


def _render_field(field: FieldSets, width: int, style: Style) -> Iterator[str]:
    pieces = [LinePart(_name_field(field).ljust(width))]
    for result in _SHOWN:
        values = field.sets.get(result)
        if values is not None and not values.is_empty():
            sure = field.ignored is not None and result is Reaction.IGNORED and not field.ignored.is_empty()
            word = "ignored" if sure else result.value
            pieces.append(LinePart(f"{word} {format_values(values, field.names)}", _ROLES[result]))
    yield from lay_out(pieces, style, 2, 4 + width)


def _render_example(one: CallbackExample, style: Style) -> Iterator[str]:
    values = ", ".join(f"{path.removeprefix('msg.')}={_spell(value)}" for path, value in _list_telling(one))
    what = one.crash.value if one.crash is not None else one.result.value
    pieces = [LinePart(what, _ROLES[one.result])]
    if one.place.line:
        pieces.append(LinePart("", "dim", f"{one.place.path}:{one.place.line}"))
    pieces.append(LinePart(f"for {values}" if values else "for any message"))
    if one.detail:
        pieces.append(LinePart(one.detail, "dim"))
    state = {True: "seen in a replay", False: "not confirmed", None: ""}[one.confirmed]
    if state or one.note:
        pieces.append(LinePart(f"{state}: {one.note}" if state and one.note else state or one.note, "dim"))
    yield from lay_out(pieces, style, 2, 6)


def _list_telling(one: CallbackExample) -> list[tuple[str, Any]]:
    """Values of an example that a person needs to see: those that are not what an empty message has, at most ten."""
    rows = [(path, value) for path, value in read_example(one).items() if value not in (0, "", False) or value != value]
    return rows[:10]


def _spell(value: Any) -> str:
    if isinstance(value, str):
        return '"' + value.encode("unicode_escape").decode() + '"'
    return repr(value)


def _render_mismatch(one: Mismatch, style: Style) -> Iterator[str]:
    severity = one.severity
    pieces = [LinePart(f"{severity}[{one.kind}]", severity), LinePart(one.topic, "bold"), LinePart(_explain(one))]
    yield from lay_out(pieces, style, 0, 4)
    for hop in one.sender.via if one.sender is not None else ():
        yield from _render_end(f"first sent on {hop.topic} by", hop.callback, hop.place, style)
    if one.sender is not None:
        yield from _render_end("sent by", one.sender.callback, one.sender.places[0], style)
    if one.subscriber is not None:
        received = CodeLine(one.subscriber.path, one.subscriber.line)
        yield from _render_end("received by", one.subscriber.callback, received, style)
    if one.example is not None:
        yield from (f"  {line}" for line in _render_example(one.example, style))
    elif one.place is not None:
        yield from _render_end("there", one.why if one.kind != UNIT else f"taken as {one.why}", one.place, style)


def _render_end(what: str, callback: str, place: CodeLine, style: Style) -> Iterator[str]:
    pieces = [LinePart(what), LinePart(callback), LinePart("", "dim", f"{place.path}:{place.line}")]
    yield from lay_out(pieces, style, 4, 8)


def _explain(one: Mismatch) -> str:
    word = "is" if one.is_sent else "may be"
    crashes = "crashes" if one.sure else "may crash"
    if one.kind == SIZE:
        are = "are" if one.is_sent else "may be"
        return f"arrays {are} sent with sizes at which a subscriber {crashes}: {one.values}"
    if one.kind == UNIT:
        reader = "a subscriber takes it as" if one.subscriber is not None else "REP-103 says"
        return f"`{one.field}` is sent in {one.values}; {reader} {one.why}"
    if one.kind == CRASHING:
        return f"`{one.field}` {word} sent as {one.values}, at which a subscriber {crashes}"
    if one.kind == IMPOSSIBLE:
        return f"a subscriber waits for `{one.field}` = {one.values}, which nobody sends"
    what = "ignores" if one.sure else "does not handle"
    value = f"frame {one.values}" if one.kind == FRAME else one.values
    return f"`{one.field}` is sent as {value}, which a subscriber {what}"


def _render_reasons(answer: ValuesAnswer, everything: bool, style: Style) -> Iterator[str]:
    """Why callbacks were not explored, as one line each reason."""
    if everything:
        return
    reasons: dict[str, int] = {}
    for one in answer.report.callbacks:
        if one.reason:
            reasons[_shorten(one.reason)] = reasons.get(_shorten(one.reason), 0) + 1
    for reason, count in sorted(reasons.items(), key=lambda row: -row[1])[:8]:
        pieces = [LinePart(f"not explored ({count}):", "warning"), LinePart(reason)]
        yield from lay_out(pieces, style, 0, 4)
    if reasons:
        yield ""


def _shorten(reason: str) -> str:
    """A reason without the place that it begins with."""
    head, mark, rest = reason.partition(": ")
    return rest if mark and head.rpartition(":")[2].isdigit() else reason


def render_values_json(answer: ValuesAnswer, version: str) -> str:
    """The whole report; floats that are not numbers are `NaN`, `Infinity` and `-Infinity` as texts."""
    document = {
        "schema": SCHEMA,
        "tool": {"name": "rosimpact", "version": version},
        "bounds": {"text": answer.report.bounds.text, "array": answer.report.bounds.array,
                   "loops": answer.report.bounds.loops, "paths": answer.report.bounds.paths,
                   "seconds": answer.report.bounds.seconds, "compiling": answer.report.bounds.compiling},
        "replayed": answer.report.replayed,
        "offline": answer.report.is_offline,
        "callbacks": [_describe_callback(one) for one in answer.report.callbacks],
        "mismatches": [_describe_mismatch(one) for one in answer.mismatches],
        "base": answer.base,
        "changes": [one._asdict() for one in answer.changes],
    }  # fmt: skip
    return format_json(document) + "\n"


def _describe_callback(one: CallbackAnswer) -> dict[str, Any]:
    return {
        "callback": one.callback, "kind": one.kind, "language": one.language, "path": one.path, "line": one.line,
        "type": one.message_type, "topics": one.topics, "nodes": one.nodes, "reason": one.reason,
        "ways": {result.value: count for result, count in one.counts.items()}, "left": one.left,
        "seconds": round(one.seconds, 3), "compiled_in": round(one.compiled_in, 3), "rounds": one.rounds,
        "beyond": one.beyond,
        "fields": [
            {
                "field": field.path, "kind": field.kind.value,
                "sets": {result.value: _describe_set(values, field.names) for result, values in field.sets.items()},
                "ignored_surely": None if field.ignored is None else _describe_set(field.ignored, field.names),
                "unhandled_surely": None if field.unhandled is None else _describe_set(field.unhandled, field.names),
            }
            for field in one.fields
        ],
        "examples": [_describe_example(example) for example in one.examples],
        "sent": [
            {
                "publisher": sent.publisher,
                "places": [{"path": place.path, "line": place.line} for place in sent.places],
                "fields": {
                    field.path: {**_describe_set(field.values, {}), "known": field.is_known} for field in sent.fields
                },
            }
            for sent in one.sent
        ],
        "unknown": one.unknown, "assumed": one.assumed, "stood_for": one.stood_for,
    }  # fmt: skip


def _describe_set(values: FieldValues, names: Mapping[int, str]) -> dict[str, Any]:
    return {
        "text": format_values(values, names),
        "spans": [[_convert_number(low), _convert_number(high)] for low, high in values.spans],
        "infinities": [_convert_number(one) for one in values.infinities],
        "nan": values.has_nan,
        "texts": None if values.texts is None else [one.decode("latin-1") for one in values.texts],
        "relational": values.is_relational,
        "complete": values.is_complete,
    }


def _describe_example(one: CallbackExample) -> dict[str, Any]:
    return {
        "result": one.result.value, "crash": one.crash.value if one.crash is not None else None,
        "path": one.place.path, "line": one.place.line, "detail": one.detail, "effects": one.effects,
        "assumed": one.assumed, "confirmed": one.confirmed, "note": one.note,
        "values": {path: _convert_number(value) for path, value in read_example(one).items()},
    }  # fmt: skip


def _describe_mismatch(one: Mismatch) -> dict[str, Any]:
    return {
        "rule": one.kind, "severity": one.severity, "topic": one.topic, "type": one.message_type,
        "field": one.field, "values": one.values, "sure": one.sure,
        "publisher": None if one.sender is None else {
            "callback": one.sender.callback,
            "places": [{"path": place.path, "line": place.line} for place in one.sender.places],
            "via": [
                {"callback": hop.callback, "topic": hop.topic, "path": hop.place.path, "line": hop.place.line}
                for hop in one.sender.via
            ],
        },
        "where": None if one.place is None else {"what": one.why, "path": one.place.path, "line": one.place.line},
        "subscriber": None if one.subscriber is None else {
            "callback": one.subscriber.callback, "path": one.subscriber.path, "line": one.subscriber.line,
        },
        "example": None if one.example is None else _describe_example(one.example),
    }  # fmt: skip


def _convert_number(value: Any) -> Any:
    """A number that JSON has."""
    if isinstance(value, float) and not math.isfinite(value):
        return "NaN" if math.isnan(value) else "Infinity" if value > 0 else "-Infinity"
    return value


def render_replays(rows: Sequence[tuple[WitnessRecord, Replayed, bool]]) -> str:
    """Recorded witnesses with what a replay of each showed."""
    lines: list[str] = []
    for record, seen, same in rows:
        state = "seen again" if same else "not seen"
        pieces = [LinePart(f"{state}:", "good" if same else "warning"), LinePart(record.callback, "bold")]
        pieces.append(LinePart(_tell(record.witness.crash, record.witness.result, record.witness.place)))
        if not same:
            pieces.append(LinePart(f"now: {seen.reason or _tell(seen.crash, seen.result, seen.place)}"))
        lines += lay_out(pieces, WIDE, 0, 4)
    again = sum(same for _, _, same in rows)
    lines.append(f"{format_count(len(rows), 'message')}, {again} seen again")
    return "\n".join(lines) + "\n"


def _tell(crash: CrashKind | None, result: Reaction, place: CodeLine) -> str:
    what = crash.value if crash is not None else result.value
    return f"{what} at {place.path}:{place.line}" if crash is not None and place.line else what
