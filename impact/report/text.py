"""The report for a person at a terminal: targets, findings by package with code excerpts, matrix, one summary line."""

from collections import defaultdict
from collections.abc import Sequence

from ...edges.console import cut_visibly, escape, format_count
from ..analysis.report import (
    Report,
    ReportedTarget,
    Shown,
    count_by_severity,
    count_by_target,
    format_causes,
    format_coverage,
    group_alike,
    list_new,
    locate_in_excerpt,
    measure,
    select_causes,
)
from ..rules.rule import Finding
from . import evidence
from .style import PLAIN, Style, paint

_TAB = "    "
_PLACES = 5


def render(report: Report, style: Style = PLAIN) -> str:
    """The report as text that ends in a line end."""
    lines = _render_targets(report, style)
    shown = select_causes(list_new(report), style.severities)
    lines += _render_packages(report, shown, style)
    if report.impact is not None and report.impact.effects:
        from .impact import render_short

        lines += ["", paint(style, "bold", "affected by this change")]
        lines += render_short(report.impact, style, escape(report.base))
    table = _render_matrix(report, style)
    if table:
        lines += ["", *table]
    lines += ["", _format_summary(report, style)]
    return "\n".join(lines) + "\n"


def _render_targets(report: Report, style: Style) -> list[str]:
    """The first line: which targets, and why these; then what was adjusted."""
    if not report.targets:
        return ["targets: none"]
    by_reason: dict[str, list[ReportedTarget]] = {}
    for target in report.targets:
        by_reason.setdefault(target.reason, []).append(target)
    groups = []
    for reason, targets in by_reason.items():
        names = ", ".join(describe_target(target) for target in targets)
        groups.append(f"{names}: {escape(reason)}" if reason else names)
    base = f" (new against {escape(report.base)})" if report.base else ""
    lines = [paint(style, "bold", "targets ") + "; ".join(groups) + base]
    for target in report.targets:
        lines += [f"  {escape(target.name)}: {escape(note)}" for note in target.notes]
    return lines


def describe_target(target: ReportedTarget) -> str:
    """A target's name, with what is behind it."""
    parts = [target.distro if target.distro != target.name else "", target.date, target.platform]
    detail = ", ".join(part for part in parts if part)
    return escape(f"{target.name} ({detail})" if detail else target.name)


def _render_packages(report: Report, findings: list[Finding], style: Style) -> list[str]:
    """Findings grouped by package, packages in their first finding's order, errors before warnings in each."""
    folders = {package.name: package.path for package in report.packages}
    by_package: dict[str, list[Finding]] = defaultdict(list)
    for finding in findings:
        by_package[finding.package].append(finding)
    rank = {name: index for index, name in enumerate(("error", "warning", "note"))}
    lines: list[str] = []
    for name, group in by_package.items():
        lines += ["", render_heading(name, folders.get(name, ""), style)]
        for alike in group_alike(sorted(group, key=lambda finding: rank.get(finding.severity, 3))):
            lines += ["", *render_alike(report, alike, style)]
    return lines


def render_heading(package: str, folder: str, style: Style, word: str = "package ") -> str:
    """The line above what concerns a package. word: before its name: CI systems read what a line begins with."""
    title = paint(style, "bold", f"{word}{escape(package)}" if package else "workspace")
    shown = folder not in ("", ".", package)
    return title + (paint(style, "dim", f" {style.symbols[4]} {escape(folder)}") if shown else "")


def _render_head(report: Report, finding: Finding, style: Style) -> str:
    names = [target.name for target in report.targets]
    where = f" {', '.join(finding.targets)}" if len(names) > 1 and finding.targets else ""
    if where and len(finding.targets) == len(names):
        where = " all targets"
    label = paint(style, finding.severity, f"{finding.severity}[{finding.rule}]")
    return f"{label}{escape(where)}: {escape(finding.message)}"


def format_place(finding: Finding) -> str:
    """Path, line and column, as far as they are known."""
    numbers = (finding.line, finding.column) if finding.line else ()
    return ":".join((escape(finding.path), *(str(number) for number in numbers if number)))


def render_alike(report: Report, alike: Sequence[Finding], style: Style) -> list[str]:
    """Findings of one cause: the first with its place, its code and its help, and the places of the others."""
    finding = alike[0]
    lines = [_render_head(report, finding, style)]
    lines += [f"  {paint(style, 'dim', style.symbols[3])} {format_place(finding)}"] if finding.path else []
    excerpt = report.excerpt(finding.path, finding.line) if finding.line else []
    _, shown = locate_in_excerpt(finding, excerpt)
    margin = len(str(finding.line))
    if shown is not None and (near := _cut_around_caret(shown, style.width)).text.strip():
        text, offset, width = _clip_line(near, style.width - margin - 5)
        lines.append(f"  {paint(style, 'dim', f'{finding.line} |')} {text}")
        if width:
            caret = paint(style, finding.severity, "^" * width)
            lines.append(f"  {' ' * margin} {paint(style, 'dim', '|')} {' ' * offset}{caret}")
    lines += [f"  {line}" for line in render_more_places(alike[1:])]
    if finding.also:
        names = [*map(escape, finding.also[:_PLACES]), *(["..."] if len(finding.also) > _PLACES else [])]
        lines.append(f"  and in {format_count(len(finding.also), 'other package')}: {', '.join(names)}")
    for label, text in evidence.format_lines(finding):
        shown, room = escape(text), style.width - len(label) - 4
        # Declarations can be long; what they were called comes first.
        cut = label != "when" and measure(shown) > room
        lines.append(f"  {paint(style, 'dim', f'{label}:')} {shown[: room - 3] + '...' if cut else shown}")
    if finding.help:
        lines.append(f"  {paint(style, 'help', 'help:')} {escape(finding.help)}")
    return lines


def _cut_around_caret(shown: Shown, width: int) -> Shown:
    """The part of a very long line that may be shown."""
    far = max(1000, width)
    begins = max(0, shown.start - far)
    return shown._replace(text=shown.text[begins : shown.start + shown.width + far], start=shown.start - begins)


def _clip_line(shown: Shown, room: int) -> tuple[str, int, int]:
    """(text that fits into room columns, caret offset and width in columns). Leading space goes first, then the far
    ends of the line."""
    pieces = cut_visibly(shown.text, shown.start, shown.start + shown.width)
    before, under, after = (piece.replace("\t", _TAB) for piece in pieces)
    after = after.rstrip()
    if measure(before) + measure(under) + measure(after) > room:
        before = before.lstrip()
        under = under[:room]
        left = max(0, room - measure(under))
        if measure(before) > left // 2 and measure(before) + measure(after) > left:
            keep = max(left // 2, left - measure(after)) - 3
            before = "..." + (before[-keep:] if keep > 0 else "")
        left = max(0, left - measure(before))
        if measure(after) > left:
            after = (after[: left - 3] + "...") if left > 3 else ""
    return before + under + after, measure(before), measure(under)


def render_more_places(findings: Sequence[Finding]) -> list[str]:
    """The places behind the first of a cause, in a line: a few of them, then `...`; no line without any."""
    if not findings:
        return []
    places = [escape(f"{each.path}:{each.line}" if each.line else each.path) for each in findings[:_PLACES]]
    named = ", ".join([*places, "..."] if len(findings) > _PLACES else places)
    return [f"and {format_count(len(findings), 'more place')}: {named}"]


def _render_matrix(report: Report, style: Style) -> list[str]:
    """Packages by targets: how many errors and warnings. Packages without either share the last row."""
    bad, doubtful, fine = style.symbols[:3]
    names = [target.name for target in report.targets]
    table = count_by_target(report)
    rows: list[tuple[str, list[tuple[str, str]]]] = []
    good = 0
    for package, row in table.items():
        row_cells = []
        for name in names:
            cell = row.get(name, {})
            errors, warnings = cell.get("error", 0), cell.get("warning", 0)
            if errors:
                row_cells.append((f"{bad} {errors}", "error"))
            elif warnings:
                row_cells.append((f"{doubtful} {warnings}", "warning"))
            else:
                row_cells.append((fine, "good"))
        if any(role != "good" for _, role in row_cells):
            rows.append((f"  {escape(package or 'workspace')}", row_cells))
        elif package:
            good += 1
    if not rows or not names:
        return []
    if good:
        others = "other package" if good == 1 else "other packages"
        rows.append((f"  {good:,} {others}", [(fine, "good")] * len(names)))
    first = max(measure(label) for label, _ in rows)
    heads = [escape(name) for name in names]
    lines = [" " * first + "".join(f"  {head}" for head in heads)]
    for label, row_cells in rows:
        line = label + " " * (first - measure(label))
        for head, (text, role) in zip(heads, row_cells, strict=True):
            line += "  " + paint(style, role, text) + " " * max(0, measure(head) - measure(text))
        lines.append(line.rstrip())
    return lines


def _format_summary(report: Report, style: Style) -> str:
    """One line: what was found, what is hidden, what was covered, how long it took."""
    findings = list_new(report)
    found = [
        paint(style, severity, causes) + ("" if severity in style.severities else f" (shown with --{severity}s)")
        for severity in count_by_severity(())
        if (causes := format_causes(select_causes(findings, (severity,))))
    ]
    if report.failure:
        text = paint(style, "error", "failed") + f": {escape(report.failure)}"
    elif not report.coverage.parsed and not findings:
        text = paint(style, "error", "nothing was analysed")
    else:
        text = ", ".join(found) if found else paint(style, "good", "nothing found")
    if report.base:
        old = len(report.findings) - len(findings)
        text += f", {old:,} older" if old else ""
    hidden = [f"{len(report.suppressed):,} suppressed"] if report.suppressed else []
    hidden += [f"{len(report.known):,} in the baseline"] if report.known else []
    parts = [text, *hidden, format_coverage(report.coverage), f"{report.seconds:.2f} s"]
    return f" {style.symbols[4]} ".join(parts)
