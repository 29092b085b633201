"""Changes of the logic of publishing as text for a person, and as JSON."""

import re
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from itertools import groupby
from typing import Any

import msgspec

from ...edges.console import escape, format_count, format_json
from ..logic.changes import KINDS, LogicChange
from ..logic.history import Commit
from ..logic.repository import Logic, select
from .columns import UNBROKEN, LinePart, lay_out
from .style import PLAIN, Style

SCHEMA = 1
_ROLES = {"tightened": "error", "gone": "error", "trigger changed": "warning", "changed": "warning", "widened": "note",
          "new": "good", "equivalent": "dim"}  # fmt: skip
_MOST_READERS = 6
_MOST_NAMES = 8
_TITLE, _TOPIC = 24, 19
_LONG = 200
_PARTS = re.compile(r"(?<= && )|(?<= \|\| )|(?<= and )|(?<= or )|(?<=[:;] )")
_WIDE = PLAIN._replace(width=UNBROKEN)


def render_text(logic: Logic, style: Style = _WIDE) -> str:
    """The changes by commit, newest first, and what was looked at."""
    lines: list[str] = []
    for commit, changes in groupby(logic.changes, key=lambda pair: pair[0]):
        title = LinePart(escape(commit.summary), "bold", hang=_TITLE)
        lines += lay_out([LinePart(f"{commit.id[:10]}  {commit.date[:10]}", "bold"), title], style, 0, _TITLE)
        for _, change in changes:
            lines += _render_change(change, style)
        lines.append("")
    lines += lay_out([LinePart(summarize(logic))], style, 0, 2)
    return "\n".join(lines)


def _render_change(change: LogicChange, style: Style) -> Iterator[str]:
    node = f" ({escape(change.node)})" if change.node else ""
    head = [
        LinePart(f"{change.kind:15s}", _ROLES[change.kind]),
        LinePart((escape(change.topic) or "?") + node, hang=_TOPIC),
        LinePart("", path=f"{escape(change.path)}:{change.line}"),
    ]
    yield from lay_out(head, style, 2, 6)
    if change.why:
        yield from lay_out([LinePart(escape(change.why))], style, 6, 8)
    if change.old is not None and change.new is not None:
        old, new = trim_common_ends(change.old, change.new)
        said = [f"- {old or 'always'}", f"+ {new or 'always'}"]
    else:
        said = [f"{sign} {text}" for sign, text in (("-", change.old), ("+", change.new)) if text]
    for line in said:
        yield from lay_out([LinePart(escape(line), "dim")], style, 6, 8)
    for number, reached in enumerate(change.reaches):
        if number == _MOST_READERS:
            yield f"      and {format_count(len(change.reaches) - number, 'further subscriber')}"
            break
        callback = f", {reached.callback}" if reached.callback else ""
        who = LinePart(f"reaches {escape((reached.node or reached.package) + callback)}")
        yield from lay_out([who, LinePart("", path=f"{escape(reached.path)}:{reached.line}")], style, 6, 8)


def trim_common_ends(old: str, new: str) -> tuple[str, str]:
    """Two long conditions without most of what they begin and end with alike, for people to see where they differ."""
    if max(len(old), len(new)) <= _LONG:
        return old, new
    before, after = _PARTS.split(old), _PARTS.split(new)
    least = min(len(before), len(after))
    first = next((n for n in range(least) if before[n] != after[n]), least)
    last = next((n for n in range(least - first) if before[-1 - n] != after[-1 - n]), least - first)
    first, last = max(0, first - 1), max(0, last - 1)

    def cut_middle(parts: list[str]) -> str:
        return "… " * (first > 0) + "".join(parts[first : len(parts) - last]) + "…" * (last > 0)

    return cut_middle(before), cut_middle(after)


def describe_missed(logic: Logic, packages: Sequence[str], topics: Sequence[str], everything: bool) -> str:
    """Where nothing of what was asked for changed, and something else did: what that is of, for a name written wrongly
    to be seen. Empty otherwise. everything: as for select()."""
    if select(logic, packages, topics, everything).changes or not logic.changes:
        return ""
    options = (f"--package {', '.join(packages)}", f"--topic {', '.join(topics)}")
    asked: list[tuple[str, Callable[[LogicChange], str]]] = []
    if packages and not select(logic, packages, (), everything).changes:
        asked.append((options[0], lambda change: change.package))
    if topics and not select(logic, (), topics, everything).changes:
        asked.append((options[1], lambda change: change.topic))
    if not asked and packages and topics:
        return escape(f"{' '.join(options)}: changes match each of them, but nothing matches both")
    clauses = []
    for option, name_of in asked:
        names = sorted({name_of(change) or "?" for _, change in logic.changes})
        rest = f" and {len(names) - _MOST_NAMES} more" if len(names) > _MOST_NAMES else ""
        clauses.append(f"{option}: nothing of it changed; what did is of {', '.join(names[:_MOST_NAMES])}{rest}")
    return "; ".join(map(escape, clauses))


def summarize(logic: Logic) -> str:
    """What was found and what was looked at, on one line."""
    counts = Counter(change.kind for _, change in logic.changes)
    reported = [f"{counts[kind]} {kind}" for kind in KINDS if counts[kind]]
    found = ", ".join(reported) or "no change of the logic of publishing"
    coverage = logic.coverage
    parts = [
        f"{format_count(coverage.commits, 'commit')} of {escape(logic.repository)} ({escape(logic.range)})",
        f"{coverage.compared:,} compared",
    ]
    if coverage.cut_off:
        parts.append(f"{coverage.cut_off:,} without their parent (fetch more of the history)")
    if coverage.packages:
        known = coverage.statements - coverage.unresolved
        parts.append(
            f"at the newest {format_count(coverage.packages, 'package')} with "
            f"{format_count(coverage.statements, 'publish statement')}, topics of {known:,} known"
        )
    return f"{found}; {'; '.join(parts)}"


def render_json(logic: Logic, version: str) -> str:
    """The changes as JSON; docs/logic.md describes it."""
    document: dict[str, Any] = {
        "schema": SCHEMA,
        "tool": {"name": "rosimpact", "version": version},
        "repository": logic.repository,
        "range": logic.range,
        "commits": logic.coverage.commits,
        "changes": [_build_entry(commit, change) for commit, change in logic.changes],
        "coverage": msgspec.to_builtins(logic.coverage),
    }
    return format_json(document)


def _build_entry(commit: Commit, change: LogicChange) -> dict[str, Any]:
    entry = {"commit": commit.id, "date": commit.date, "summary": commit.summary, **msgspec.to_builtins(change)}
    entry["reaches"] = entry.pop("reaches")  # comes last
    return entry
