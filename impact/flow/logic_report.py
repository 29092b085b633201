"""Changes of the logic of publishing as text for a person, and as JSON."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator, Mapping
from itertools import groupby
from typing import Any, NamedTuple

from ...corpus.told import counted
from ..findings import printable
from ..report.report import one_line, safe
from .history import Commit
from .logic import Logic
from .logic_changes import KINDS, Change

SCHEMA = 1
_COLOURS = {"tightened": "1;31", "gone": "1;31", "trigger changed": "1;33", "changed": "1;33", "widened": "1;36",
            "new": "1;32", "equivalent": "2", "commit": "1", "dim": "2"}  # fmt: skip
_MOST_READERS = 6


class Style(NamedTuple):
    """How text is written. colours: terminal codes by kind, empty for none."""

    colours: Mapping[str, str] = {}


PLAIN = Style()
COLOURED = Style(_COLOURS)


def text(logic: Logic, style: Style = PLAIN) -> str:
    """The changes by commit, newest first, and one line on what was looked at."""
    lines: list[str] = []
    for commit, changes in groupby(logic.changes, key=lambda pair: pair[0]):
        lines.append(_painted(f"{commit.id[:10]}  {commit.date[:10]}  {one_line(commit.summary)}", "commit", style))
        for _, change in changes:
            lines.extend(_lines(change, style))
        lines.append("")
    lines.append(summary(logic))
    return safe("\n".join(lines))


def _lines(change: Change, style: Style) -> Iterator[str]:
    kind = _painted(f"{change.kind:15s}", change.kind, style)
    node = f" ({one_line(change.node)})" if change.node else ""
    yield f"  {kind} {one_line(change.topic) or '?'}{node}  {one_line(change.path)}:{change.line}"
    if change.why:
        yield f"      {one_line(change.why)}"
    if change.old is not None and change.new is not None:
        yield _painted(f"      - {one_line(change.old) or 'always'}", "dim", style)
        yield _painted(f"      + {one_line(change.new) or 'always'}", "dim", style)
    elif change.old or change.new:
        yield _painted(f"      {'-' if change.old else '+'} {one_line(change.old or change.new or '')}", "dim", style)
    for number, reached in enumerate(change.reaches):
        if number == _MOST_READERS:
            yield f"      … and {counted(len(change.reaches) - number, 'further subscriber')}"
            break
        callback = f", {reached.callback}" if reached.callback else ""
        place = f"{one_line(reached.path)}:{reached.line}"
        yield f"      reaches {one_line(reached.node or reached.package)}{one_line(callback)}  {place}"


def _painted(line: str, role: str, style: Style) -> str:
    code = style.colours.get(role)
    return f"\x1b[{code}m{line}\x1b[0m" if code else line


def summary(logic: Logic) -> str:
    """What was found and what was looked at, on one line."""
    counts = Counter(change.kind for _, change in logic.changes)
    told = [f"{counts[kind]} {kind}" for kind in KINDS if counts[kind]]
    found = ", ".join(told) or "no change of the logic of publishing"
    coverage = logic.coverage
    parts = [
        f"{counted(coverage.commits, 'commit')} of {one_line(logic.repository)} ({one_line(logic.range)})",
        f"{coverage.compared:,} compared",
    ]
    if coverage.cut_off:
        parts.append(f"{coverage.cut_off:,} without their parent (fetch more of the history)")
    if coverage.packages:
        known = coverage.statements - coverage.unresolved
        parts.append(
            f"at the newest {counted(coverage.packages, 'package')} with "
            f"{counted(coverage.statements, 'publish statement')}, topics of {known:,} known"
        )
    return f"{found}; {'; '.join(parts)}"


def as_json(logic: Logic, version: str) -> str:
    """The changes as JSON; docs/logic.md describes it."""
    coverage = logic.coverage
    document: dict[str, Any] = {
        "schema": SCHEMA,
        "tool": {"name": "rosimpact", "version": version},
        "repository": logic.repository,
        "range": logic.range,
        "commits": coverage.commits,
        "changes": [_entry(commit, change) for commit, change in logic.changes],
        "coverage": {
            "commits": coverage.commits,
            "compared": coverage.compared,
            "cut_off": coverage.cut_off,
            "packages": coverage.packages,
            "statements": coverage.statements,
            "unresolved": coverage.unresolved,
            "unread": list(coverage.unread),
        },
    }
    return printable(json.dumps(document, indent=1, ensure_ascii=False))


def _entry(commit: Commit, change: Change) -> dict[str, Any]:
    return {
        "commit": commit.id,
        "date": commit.date,
        "summary": commit.summary,
        "kind": change.kind,
        "package": change.package,
        "path": change.path,
        "line": change.line,
        "function": change.function,
        "node": change.node,
        "topic": change.topic,
        "topics": list(change.topics),
        "type": change.type,
        "old": change.old,
        "new": change.new,
        "why": change.why,
        "unreachable": change.unreachable,
        "reaches": [
            {
                "package": reached.package,
                "node": reached.node,
                "topic": reached.topic,
                "callback": reached.callback,
                "path": reached.path,
                "line": reached.line,
            }
            for reached in change.reaches
        ],
    }
