"""What an upgrade breaks, as text, JSON (see upgrade.schema.json) and a page."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ...edges.console import counted, visible
from ..analysis.report import count_by_severity, coverage_text, severities_text
from ..analysis.target_compare import UpgradeItem
from ..analysis.upgrade import Upgrade
from . import html, json
from .items import as_data, item_lines, short_lines
from .page import page
from .style import Style, painted
from .text import described, heading

SCHEMA = 1


def verdict(found: Upgrade) -> str:
    """One line: safe, or what breaks.

    `humble → jazzy breaks 3 of 46 packages: 3 errors and 1 warning to fix, in 9 places`
    """
    way = f"{visible(found.old.name)} → {visible(found.new.name)}"
    total = counted(len(found.packages), "package")
    if not found.breaks:
        return f"{way} is safe: no known break in {total}"
    broken = {item.package for item in found.breaks if item.severity == "error"}
    touched = broken or {item.package for item in found.breaks}
    what = severities_text(found.breaks, " and ")
    places = counted(sum(len(item.findings) for item in found.breaks), "place")
    return f"{way} {'breaks' if broken else 'may break'} {len(touched):,} of {total}: {what} to fix, in {places}"


def by_fixes(found: Upgrade) -> str:
    """How much of the work can be done by the tool, empty without any."""
    told = []
    for items, noun in ((found.breaks, "item"), (found.deprecations, "deprecation")):
        some = [item for item in items if found.fixes(item)]
        whole = sum(found.fixes(item) == len(item.findings) for item in some)
        part = f" ({len(some) - whole:,} more in part)" if whole < len(some) else ""
        told += [f"{whole:,} of {counted(len(items), noun)}{part}"] if some else []
    return f"{' and '.join(told)} can be fixed: {found.command}" if told else ""


def rest(found: Upgrade) -> list[str]:
    """The findings that the upgrade does not cause, as clauses."""
    old, new = visible(found.old.name), visible(found.new.name)
    clauses = []
    if found.both:
        them = "it" if len(found.both) == 1 else "them"
        clauses.append(f"{severities_text(found.both)} already on {old}: {found.check_old} lists {them}")
    if found.over:
        clauses.append(f"{severities_text(found.over)} only on {old}, not on {new}")
    return clauses


def text(found: Upgrade, style: Style) -> str:
    """The list of work for people at a terminal."""
    role = "good" if not found.breaks else _worst(found.breaks)
    lines = [painted(style, role, verdict(found).replace("→", style.symbols[3]))]
    fixes = by_fixes(found)
    lines += [f"  {painted(style, 'help', visible(fixes))}"] if fixes else []
    for word, target in (("from", found.old), ("to", found.new)):
        lines.append(f"  {painted(style, 'dim', f'{word} {described(target)}')}")
        lines += [f"    {visible(note)}" for note in target.notes]
    steps = _steps(found.breaks)
    for number, (package, items) in enumerate(steps.items(), 1):
        lines += ["", _title(f"{number} of {len(steps)}", package, found, style)]
        for item in items:
            lines += ["", *item_lines(found.report, item, style, found.fixable)]
    if found.deprecations:
        lines += ["", painted(style, "bold", f"deprecated on {visible(found.new.name)}")]
        for package, items in _steps(found.deprecations).items():
            lines += ["", _title("", package, found, style)]
            for item in items:
                lines += short_lines(item, style, found.fixable)
    parts = [*rest(found), coverage_text(found.report.coverage), f"{found.seconds:.2f} s"]
    return "\n".join([*lines, "", f" {style.symbols[4]} ".join(parts)]) + "\n"


def _worst(items: Iterable[UpgradeItem]) -> str:
    return "error" if any(item.severity == "error" for item in items) else "warning"


def _steps(items: Iterable[UpgradeItem]) -> dict[str, list[UpgradeItem]]:
    """Items by package, in the order in which they come."""
    steps: dict[str, list[UpgradeItem]] = {}
    for item in items:
        steps.setdefault(item.package, []).append(item)
    return steps


def _title(number: str, package: str, found: Upgrade, style: Style) -> str:
    folders = {each.name: each.path for each in found.packages}
    title = heading(package, folders.get(package, ""), style, "" if number else "package ")
    return f"{painted(style, 'dim', f'{number}: ')}{title}" if number else title


def as_json(found: Upgrade) -> str:
    """The list of work for programs."""
    broken = {item.package for item in found.breaks}
    counts = count_by_severity(found.breaks)
    return json.dumped({
        "schema": SCHEMA,
        "tool": {"name": "rosimpact", "version": found.report.version, "data": found.report.data},
        "from": json.target_as_data(found.old) | json.notes_of(found.old),
        "to": json.target_as_data(found.new) | json.notes_of(found.new),
        "verdict": {
            "safe": not found.breaks,
            "text": verdict(found),
            "packages": len(broken),
            "errors": counts["error"],
            "warnings": counts["warning"],
            "places": sum(len(item.findings) for item in found.breaks),
        },
        "fix": {
            "items": sum(found.fixes(item) > 0 for item in (*found.breaks, *found.deprecations)),
            "command": found.command,
        },
        "work": _work(found, found.breaks),
        "deprecations": _work(found, found.deprecations),
        "both": count_by_severity(found.both),
        "over": count_by_severity(found.over),
        "coverage": json.coverage_as_data(found.report.coverage) | {"packages": len(found.packages)},
    })  # fmt: skip


def _work(found: Upgrade, items: Iterable[UpgradeItem]) -> list[dict[str, Any]]:
    folders = {package.name: package.path for package in found.packages}
    return [
        {
            "package": package,
            "path": folders.get(package, ""),
            "items": [as_data(item) | {"fixable": found.fixes(item)} for item in items],
        }
        for package, items in _steps(items).items()
    ]


def schema() -> str:
    """The published JSON schema as text (draft 2020-12); docs/upgrade.schema.json holds it."""
    return json.schema_with("upgrade.schema.json")


def as_html(found: Upgrade) -> str:
    """The list of work as one page that loads nothing."""
    return page(Path(__file__).with_name("upgrade.html"), f"rosimpact: upgrade of {found.report.root}", _data(found))


def _data(found: Upgrade) -> Mapping[str, Any]:
    report = found.report
    return {
        "version": report.version,
        "data": report.data,
        "root": report.root,
        "verdict": verdict(found),
        "bad": _worst(found.breaks) if found.breaks else "",
        "facts": [*rest(found), coverage_text(report.coverage)],
        "fixes": by_fixes(found).partition(": ")[0],
        "command": found.command,
        "from": found.old._asdict(),
        "to": found.new._asdict(),
        "seconds": round(found.seconds, 2),
        "folders": {package.name: package.path for package in found.packages},
        "rules": {rule.name: rule.summary for rule in report.rules() if rule.documentation},
        "items": [_row(found, item, group) for group, these in enumerate((found.breaks, found.deprecations))
                  for item in these],
    }  # fmt: skip


def _row(found: Upgrade, item: UpgradeItem, group: int) -> list[Any]:
    """Group (0 breaks, 1 deprecated), package, rule, subject, severity, how many places are fixable, findings."""
    names = [found.new.name]
    findings = [html.as_row(found.report, finding, names) for finding in item.findings]
    return [group, item.package, item.rule, item.subject, item.severity, found.fixes(item), findings]
