"""The report as one self-contained page: it works from a file, loads nothing and runs no code but its own."""

from pathlib import Path
from typing import Any

from ...edges.console import escape_page
from ..analysis.report import Report, count_by_severity, count_by_target, format_coverage, list_new, locate_in_excerpt
from ..rules.rule import Finding
from . import evidence
from .markdown import format_verdict
from .page import render_page

_LONGEST_LINE = 400
_MOST_EFFECTS = 200
_MOST_REACHED = 12


def render(report: Report) -> str:
    """The page as text."""
    return render_page(Path(__file__).with_name("report.html"), f"rosimpact: {report.root}", _build_data(report))


def _build_data(report: Report) -> dict[str, Any]:
    names = [target.name for target in report.targets]
    return {
        "version": report.version,
        "data": report.data,
        "root": report.root,
        "base": report.base,
        "failure": report.failure,
        "verdict": format_verdict(report, str, ""),
        "coverage": format_coverage(report.coverage),
        "seconds": round(report.seconds, 2),
        "suppressed": len(report.suppressed),
        "known": len(report.known),
        "counts": count_by_severity(list_new(report)),
        "targets": [target._asdict() for target in report.targets],
        "folders": {package.name: package.path for package in report.packages},
        "matrix": [
            [
                package,
                [[row.get(name, {}).get(severity, 0) for severity in ("error", "warning", "note")] for name in names],
            ]
            for package, row in count_by_target(report).items()
        ],
        "rules": {rule.name: rule.summary for rule in report.rules() if rule.documentation},
        "impact": _build_impact(report),
        "findings": [build_row(report, finding, names) for finding in report.findings],
    }


def _build_impact(report: Report) -> dict[str, Any] | None:
    """What the change reaches: a summary, and change, subject, place, why and reached nodes of each; None without."""
    if report.impact is None or not report.impact.effects:
        return None
    from ..model.flow.connections import name_nodes
    from .impact import summarize

    names = name_nodes(report.impact.nodes)
    rows = []
    for effect in report.impact.effects[:_MOST_EFFECTS]:
        near = list(dict.fromkeys(names.get(hop.node, hop.node) for hop in effect.reaches))
        more = len(near) - _MOST_REACHED
        reported = ", ".join(near[:_MOST_REACHED]) + (f" and {more} more" if more > 0 else "")
        rows.append([f"{effect.kind} {effect.change}", effect.subject, effect.path, effect.line, effect.why, reported])
    return {"summary": summarize(report.impact), "rows": rows, "left": max(0, len(report.impact.effects) - len(rows))}


def build_row(report: Report, finding: Finding, names: list[str]) -> list[Any]:
    """Rule, severity, package, path, line, column, subject, target numbers, message, help, new, excerpt, evidence as
    (label, text) pairs, further packages."""
    code = None
    if finding.line:
        lines = report.excerpt(finding.path, finding.line)
        first, shown = locate_in_excerpt(finding, lines)
        if shown is not None:
            start, width = (shown.start, shown.width) if shown.start < _LONGEST_LINE else (0, 0)
            # The page shows some characters escaped, which moves what is behind them.
            before, under = (escape_page(shown.text[part]) for part in (slice(start), slice(start, start + width)))
            code = [first, [line[:_LONGEST_LINE] for line in lines], len(before), len(under)]
    numbers = [names.index(name) for name in finding.targets if name in names]
    source = finding.evidence.source if finding.evidence is not None else ""
    return [
        finding.rule, finding.severity, finding.package, finding.path, finding.line, finding.column, finding.subject,
        numbers, finding.message, finding.help, finding.new, code,
        [*evidence.format_lines(finding), *([("source", source)] if source else [])], finding.also,
    ]  # fmt: skip
