"""The report as GitHub workflow commands, which GitHub shows beside the lines of a pull request.

Syntax and escapes: docs.github.com, "Workflow commands for GitHub Actions". GitHub shows at most ten annotations
of each level for one step; what goes beyond is printed as plain lines and told in the step summary.
"""

from collections.abc import Mapping

from ...edges.console import escape, escape_lines, format_count
from ...edges.files import append_file
from ..analysis.report import (
    Report,
    count_by_severity,
    format_coverage,
    list_new,
    locate_in_excerpt,
    put_different_first,
)
from ..rules.rule import Finding
from . import evidence, markdown, markdown_text

SHOWN = 10
_COMMAND = {"error": "error", "warning": "warning", "note": "notice"}


def render(report: Report, prefix: str = "") -> str:
    """Workflow commands, the rest of the findings as plain lines, and one line of coverage.

    prefix: the workspace's folder relative to the repository's root, where annotations need it.
    """
    folder = prefix.strip("/")
    folder = f"{folder}/" if folder not in ("", ".") else ""
    commands: list[str] = []
    rest: list[str] = []
    used = dict.fromkeys(_COMMAND, 0)
    rank = tuple(_COMMAND)
    findings = sorted(list_new(report), key=lambda finding: rank.index(finding.severity))
    for finding in put_different_first(findings):
        if used[finding.severity] < SHOWN:
            used[finding.severity] += 1
            commands.append(_format_command(report, finding, folder))
        else:
            rest.append(
                f"rosimpact: {escape(folder + finding.path)}:{finding.line}: {finding.severity}[{finding.rule}] "
                f"{escape(finding.message)}{_format_targets(report, finding)}"
            )
    if report.failure:
        commands.insert(0, f"::error title=rosimpact::{_escape_data(report.failure)}")
    counts = ", ".join(format_count(number, severity) for severity, number in count_by_severity(findings).items())
    return "\n".join([*commands, *rest, f"rosimpact: {counts}; {format_coverage(report.coverage)}"]) + "\n"


def render_step_summary(report: Report) -> str:
    """Markdown for the file that GITHUB_STEP_SUMMARY names: the verdict and a table of all errors and warnings."""
    lines = [markdown.render(report)]
    findings = sorted(
        (finding for finding in list_new(report) if finding.severity != "note"), key=lambda finding: finding.severity
    )
    if findings:
        lines += ["| | place | finding | targets |", "|---|---|---|---|"]
    for finding in findings[:500]:
        place = markdown_text.format_cell(markdown_text.quote(f"{finding.path}:{finding.line}"))
        message = markdown_text.format_cell(markdown_text.escape_markdown(finding.message))
        targets = markdown_text.format_cell(markdown_text.escape_markdown(", ".join(finding.targets)))
        lines.append(f"| {finding.severity} | {place} | {message} | {targets} |")
    if len(findings) > 500:
        lines.append(f"\nand {len(findings) - 500:,} more")
    return "\n".join(lines) + "\n"


def write_step_summary(report: Report, environment: Mapping[str, str]) -> None:
    """Appends the summary to the file GITHUB_STEP_SUMMARY names; nothing without it. Raises OSError."""
    path = environment.get("GITHUB_STEP_SUMMARY")
    if path:
        append_file(path, render_step_summary(report).encode("utf-8", "replace"))


def _format_command(report: Report, finding: Finding, folder: str) -> str:
    properties = {"file": folder + finding.path, "title": f"{finding.rule}{_format_targets(report, finding)}"}
    if finding.line:
        properties["line"] = str(finding.line)
    if finding.line and finding.column:
        properties["col"] = str(finding.column)
        _, shown = locate_in_excerpt(finding, report.excerpt(finding.path, finding.line))
        if shown is not None and shown.width:
            properties["endColumn"] = str(max(finding.column, shown.start + shown.width))
    shown = "".join(f"\n{label}: {line}" for label, line in evidence.format_lines(finding))
    text = finding.message + shown + (f"\nhelp: {finding.help}" if finding.help else "")
    reported = ",".join(f"{key}={_escape_property(value)}" for key, value in properties.items())
    return f"::{_COMMAND[finding.severity]} {reported}::{_escape_data(text)}"


def _format_targets(report: Report, finding: Finding) -> str:
    return f" ({escape(', '.join(finding.targets))})" if finding.targets and len(report.targets) > 1 else ""


def _escape_data(text: str) -> str:
    return escape_lines(text).replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _escape_property(text: str) -> str:
    return _escape_data(text).replace(":", "%3A").replace(",", "%2C")
