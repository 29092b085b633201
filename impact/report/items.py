"""Things to do, as text and as data: one cause in one package, with all its places."""

from collections.abc import Collection, Iterator, Sequence
from typing import Any

from ...edges.console import escape, format_count
from ..analysis.findings import UpgradeItem
from ..analysis.report import Report, group_alike
from ..rules.rule import Finding
from . import json
from .style import Style, paint
from .text import format_place, render_alike, render_more_places


def render_item(report: Report, item: UpgradeItem, style: Style, fixable: Collection[str] = ()) -> Iterator[str]:
    """An item with the code of its first place, and once more where other words are said of another place.

    fixable: fingerprints of findings that `check --fix` fixes.
    """
    for findings in group_alike(item.findings):
        first, *others = render_alike(report, findings, style)
        yield first + _format_fixable(findings, fixable, style)
        yield from others


def render_short_item(item: UpgradeItem, style: Style, fixable: Collection[str] = ()) -> Iterator[str]:
    """An item without code, set in by two."""
    for findings in group_alike(item.findings):
        yield f"  {escape(findings[0].message)}{_format_fixable(findings, fixable, style)}"
        yield f"    {paint(style, 'dim', style.symbols[3])} {format_place(findings[0])}"
        yield from (f"    {line}" for line in render_more_places(findings[1:]))
        if findings[0].help:
            yield f"    {paint(style, 'help', 'help:')} {escape(findings[0].help)}"


def _format_fixable(findings: Sequence[Finding], fixable: Collection[str], style: Style) -> str:
    number = sum(finding.fingerprint in fixable for finding in findings)
    if not number:
        return ""
    word = "fixable" if number == len(findings) else f"fixable at {format_count(number, 'place')}"
    return paint(style, "good", f" [{word}]")


def build_data(item: UpgradeItem) -> dict[str, Any]:
    """An item as the schemas have it."""
    return {
        "rule": item.rule,
        "severity": item.severity,
        "subject": item.subject,
        "findings": [json.build_finding_data(finding) for finding in item.findings],
    }
