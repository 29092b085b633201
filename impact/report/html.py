"""The report as one self-contained page: it works from a file, loads nothing and runs no code but its own."""

from __future__ import annotations

import base64
import hashlib
import html
import json
import re
from pathlib import Path
from typing import Any

from ..findings import printable
from ..rules.rule import Finding
from .markdown import verdict
from .report import Report, count_by_severity, coverage_text, focus, fresh, matrix, safe

_LONGEST_LINE = 400
_PLACEHOLDER = re.compile(r"\{\{(policy|title|data)\}\}")


def render(report: Report) -> str:
    """The page as text. What comes from the workspace stands only in a JSON block that cannot be left, and the page's
    script puts it into text nodes; the content security policy allows that script and style alone, by their hashes."""
    template = Path(__file__).with_name("page.html").read_text(encoding="utf-8")
    values = {
        "policy": policy_of(template),
        "title": html.escape(safe(printable(f"rosimpact: {report.root}"))),
        "data": _data(report),
    }
    return _PLACEHOLDER.sub(lambda match: values[match[1]], template)


def policy_of(template: str) -> str:
    """The content security policy of a page: its own scripts and styles by their hashes, and nothing else."""
    sources = []
    for tag in ("script", "style"):
        found = re.search(rf"<{tag}>(.*?)</{tag}>", template, re.DOTALL)
        if found:
            digest = base64.b64encode(hashlib.sha256(found[1].encode()).digest()).decode()
            sources.append(f"{tag}-src 'sha256-{digest}'")
    return "; ".join(["default-src 'none'", *sources, "base-uri 'none'", "form-action 'none'"])


def _data(report: Report) -> str:
    """The report's data as JSON in which no character can end the block: < > & and line separators are escaped."""
    names = [target.name for target in report.targets]
    data = {
        "version": report.version,
        "data": report.data,
        "root": report.root,
        "base": report.base,
        "failure": report.failure,
        "verdict": re.sub(r"\*\*|\\(?=[^\w\s])|<!-- -->", "", verdict(report)),
        "coverage": coverage_text(report.coverage),
        "seconds": round(report.seconds, 2),
        "suppressed": len(report.suppressed),
        "known": len(report.known),
        "counts": count_by_severity(fresh(report)),
        "targets": [target._asdict() for target in report.targets],
        "folders": {package.name: package.path for package in report.packages},
        "matrix": [
            [
                package,
                [[row.get(name, {}).get(severity, 0) for severity in ("error", "warning", "note")] for name in names],
            ]
            for package, row in matrix(report).items()
        ],
        "rules": {
            rule.name: rule.documentation.strip().partition("\n")[0].partition(": ")[2]
            for rule in report.rules
            if rule.documentation
        },
        "findings": [_finding(report, finding, names) for finding in report.findings],
    }
    text = printable(json.dumps(clean(data), ensure_ascii=False, separators=(",", ":")))
    return re.sub("[<>&\u2028\u2029]", lambda match: f"\\u{ord(match[0]):04x}", text)


def _finding(report: Report, finding: Finding, names: list[str]) -> list[Any]:
    """Rule, severity, package, path, line, column, subject, target numbers, message, help, new, excerpt."""
    code = None
    if finding.line:
        lines = report.excerpt(finding.path, finding.line)
        first, shown = focus(finding, lines)
        if shown is not None:
            start, width = (shown.start, shown.width) if shown.start < _LONGEST_LINE else (0, 0)
            code = [first, [line[:_LONGEST_LINE] for line in lines], start, width]
    numbers = [names.index(name) for name in finding.targets if name in names]
    return [
        finding.rule, finding.severity, finding.package, finding.path, finding.line, finding.column, finding.subject,
        numbers, finding.message, finding.help, finding.new, code,
    ]  # fmt: skip


def clean(value: Any) -> Any:
    """The value with control and direction characters in its texts replaced."""
    if isinstance(value, str):
        return safe(value)
    if isinstance(value, dict):
        return {safe(key): clean(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [clean(item) for item in value]
    return value
