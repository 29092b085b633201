"""The report as a comment for a pull request: ten lines at most."""

import re
from collections.abc import Callable

from ...edges.console import format_count
from ..analysis.report import (
    Report,
    count_by_severity,
    format_causes,
    format_coverage,
    format_gaps,
    group_alike,
    list_new,
    put_different_first,
    select_causes,
)
from ..rules.rule import Finding
from .markdown_text import _LONGEST, escape_markdown, quote

_LINES = 10
_PLACES = 3
_SYMBOL = {"error": "❌", "warning": "⚠️", "note": "💡"}


def render(report: Report) -> str:
    """Markdown of at most ten lines: the verdict by target, the worst findings, what they rest on."""
    findings = list_new(report)
    head = [f"**rosimpact** {format_verdict(report)}", ""]
    tail = ["", f"<sub>{_render_tail(report, findings)}</sub>"]
    order = {"error": 0, "warning": 1}
    reported = select_causes(put_different_first(findings), order)
    reported.sort(key=lambda finding: order.get(finding.severity, len(order)))
    if report.impact is not None and report.impact.effects:
        from .impact import summarize

        tail.insert(0, f"\nMessage flow: {escape_markdown(summarize(report.impact))}")
    room = _LINES - len(head) - len("\n".join(tail).split("\n"))
    groups = group_alike(reported)
    left = groups[room - 1 :] if len(groups) > room else []
    rows = [_render_row(report, group) for group in groups[: len(groups) - len(left)]]
    if left:
        rows.append(f"- and {format_causes(finding for group in left for finding in group)} more")
    return "\n".join([*head, *rows, *tail] if rows else [head[0], *tail]) + "\n"


def format_verdict(report: Report, written: Callable[[str], str] | None = None, strong: str = "**") -> str:
    """`breaks on robot: 2; may break on rolling: 1; safe on: humble, jazzy`.

    Where something was not read or not resolved, nothing is safe: `no known break on: humble; 1 include unresolved`.
    written: how names and the failure are written, as in Markdown by default. strong: what stands around what breaks.
    """
    written = written or escape_markdown
    if report.failure:
        return f"failed: {written(report.failure)}"
    if not report.coverage.parsed:
        return "analysed nothing"
    causes = [finding for finding, *_ in group_alike(list_new(report))]
    by_target = {
        target.name: count_by_severity(f for f in causes if not f.targets or target.name in f.targets)
        for target in report.targets
    }
    bad = [f"{strong}{written(name)}{strong}: {cell['error']}" for name, cell in by_target.items() if cell["error"]]
    doubtful = [
        f"{written(name)}: {cell['warning']}"
        for name, cell in by_target.items()
        if cell["warning"] and not cell["error"]
    ]
    good = [written(name) for name, cell in by_target.items() if not cell["error"] and not cell["warning"]]
    parts = [f"breaks on {', '.join(bad)}"] if bad else []
    parts += [f"may break on {', '.join(doubtful)}"] if doubtful else []
    gaps = format_gaps(report.coverage)
    if good:
        parts += [f"no known break on: {', '.join(good)}", gaps] if gaps else [f"safe on: {', '.join(good)}"]
    return "; ".join(parts) or "found no target to check"


def _render_row(report: Report, alike: list[Finding]) -> str:
    """One line for findings that say the same, with the first few places of them."""
    finding = alike[0]
    places = [_quote_place(each) for each in alike[: _PLACES + 1]]
    others = ""
    if len(alike) > 1:
        named = ", ".join([*places[1:], "…"] if len(alike) > len(places) else places[1:])
        others = f" and {format_count(len(alike) - 1, 'more place')} ({named}):"
    reported = set(re.split(r"[\s,;()]+", finding.message)).issuperset(finding.targets)
    everywhere = len(finding.targets) == len(report.targets)
    names = "" if reported or everywhere else f" ({escape_markdown(', '.join(finding.targets))})"
    where = f"{places[0]}{others} " if finding.path else ""
    text = f"- {_SYMBOL[finding.severity]} {where}{escape_markdown(_shorten(finding.message))}{names}"
    return text + (f"; {escape_markdown(_shorten(finding.help))}" if finding.help else "")


def _quote_place(finding: Finding) -> str:
    return quote(finding.path + (f":{finding.line}" if finding.line else ""))


def _shorten(text: str) -> str:
    return text if len(text) <= _LONGEST else text[: _LONGEST - 1] + "…"


def _render_tail(report: Report, findings: list[Finding]) -> str:
    parts = [format_coverage(report.coverage)]
    notes = format_causes(select_causes(findings, ("note",)))
    parts += [notes] if notes else []
    parts += [f"new against {quote(report.base)}"] if report.base else []
    parts += [f"{len(report.suppressed):,} suppressed"] if report.suppressed else []
    parts += [f"{len(report.known):,} in the baseline"] if report.known else []
    parts.append(f"rosimpact {escape_markdown(report.version)}, data of {escape_markdown(report.data)}")
    return " · ".join(parts)
