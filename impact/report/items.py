"""Things to do, as text and as data: one cause in one package, with all its places."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from typing import Any

from ...edges.console import counted, visible
from ..analysis.report import Report
from ..analysis.target_compare import UpgradeItem
from ..rules.rule import Finding
from . import json
from .style import Style, painted
from .text import finding_lines, place_of

_PLACES = 5


def item_lines(report: Report, item: UpgradeItem, style: Style, fixable: Collection[str] = ()) -> Iterator[str]:
    """An item with the code of its first place, and once more where other words are said of another place.

    fixable: fingerprints of findings that `check --fix` cures.
    """
    for findings in _by_message(item):
        first, *others = finding_lines(report, findings[0], style)
        yield first + _fixed(findings, fixable, style)
        yield from others
        yield from _places(findings[1:], style, "  ")


def short_lines(item: UpgradeItem, style: Style, fixable: Collection[str] = ()) -> Iterator[str]:
    """An item without code, set in by two."""
    for findings in _by_message(item):
        yield f"  {visible(findings[0].message)}{_fixed(findings, fixable, style)}"
        yield from _places(findings, style, "    ")
        if findings[0].help:
            yield f"    {painted(style, 'help', 'help:')} {visible(findings[0].help)}"


def _by_message(item: UpgradeItem) -> Iterable[list[Finding]]:
    groups: dict[tuple[str, str], list[Finding]] = {}
    for finding in item.findings:
        groups.setdefault((finding.message, finding.help), []).append(finding)
    return groups.values()


def _fixed(findings: Sequence[Finding], fixable: Collection[str], style: Style) -> str:
    number = sum(finding.fingerprint in fixable for finding in findings)
    if not number:
        return ""
    word = "fixable" if number == len(findings) else f"fixable at {counted(number, 'place')}"
    return painted(style, "good", f" [{word}]")


def _places(findings: Sequence[Finding], style: Style, margin: str) -> Iterator[str]:
    for finding in findings[:_PLACES]:
        yield f"{margin}{painted(style, 'dim', style.symbols[3])} {place_of(finding)}"
    if len(findings) > _PLACES:
        yield f"{margin}and {counted(len(findings) - _PLACES, 'more place')}"


def as_data(item: UpgradeItem) -> dict[str, Any]:
    """An item as the schemas have it."""
    return {
        "rule": item.rule,
        "severity": item.severity,
        "subject": item.subject,
        "findings": [json.as_data(finding) for finding in item.findings],
    }
