"""Things to do, as text and as data: one cause in one package, with all its places."""

from collections.abc import Collection, Iterable, Iterator, Sequence
from typing import Any

from ...edges.console import escape, format_count
from ..analysis.report import Report
from ..analysis.target_compare import UpgradeItem
from ..rules.rule import Finding
from . import json
from .style import Style, paint
from .text import format_place, render_finding

_PLACES = 5


def render_item(report: Report, item: UpgradeItem, style: Style, fixable: Collection[str] = ()) -> Iterator[str]:
    """An item with the code of its first place, and once more where other words are said of another place.

    fixable: fingerprints of findings that `check --fix` fixes.
    """
    for findings in _group_by_message(item):
        first, *others = render_finding(report, findings[0], style)
        yield first + _format_fixable(findings, fixable, style)
        yield from others
        yield from _render_places(findings[1:], style, "  ")


def render_short_item(item: UpgradeItem, style: Style, fixable: Collection[str] = ()) -> Iterator[str]:
    """An item without code, set in by two."""
    for findings in _group_by_message(item):
        yield f"  {escape(findings[0].message)}{_format_fixable(findings, fixable, style)}"
        yield from _render_places(findings, style, "    ")
        if findings[0].help:
            yield f"    {paint(style, 'help', 'help:')} {escape(findings[0].help)}"


def _group_by_message(item: UpgradeItem) -> Iterable[list[Finding]]:
    groups: dict[tuple[str, str], list[Finding]] = {}
    for finding in item.findings:
        groups.setdefault((finding.message, finding.help), []).append(finding)
    return groups.values()


def _format_fixable(findings: Sequence[Finding], fixable: Collection[str], style: Style) -> str:
    number = sum(finding.fingerprint in fixable for finding in findings)
    if not number:
        return ""
    word = "fixable" if number == len(findings) else f"fixable at {format_count(number, 'place')}"
    return paint(style, "good", f" [{word}]")


def _render_places(findings: Sequence[Finding], style: Style, margin: str) -> Iterator[str]:
    for finding in findings[:_PLACES]:
        yield f"{margin}{paint(style, 'dim', style.symbols[3])} {format_place(finding)}"
    if len(findings) > _PLACES:
        yield f"{margin}and {format_count(len(findings) - _PLACES, 'more place')}"


def build_data(item: UpgradeItem) -> dict[str, Any]:
    """An item as the schemas have it."""
    return {
        "rule": item.rule,
        "severity": item.severity,
        "subject": item.subject,
        "findings": [json.build_finding_data(finding) for finding in item.findings],
    }
