"""What an upgrade breaks, as text, JSON (see upgrade.schema.json) and a page."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ...edges.console import escape, format_count
from ..analysis.findings import UpgradeItem
from ..analysis.report import count_by_severity, format_causes, format_coverage, format_gaps, format_severities
from ..analysis.upgrade import Upgrade
from ..rules.rule import Finding
from . import html, json
from .items import build_data, render_item, render_short_item
from .page import render_page
from .style import Style, paint
from .text import describe_target, render_heading

SCHEMA = 1


def format_verdict(found: Upgrade) -> str:
    """One line: safe, or what breaks, or why neither is said.

    `humble → jazzy breaks 3 of 46 packages and may break 1 more: 3 errors and 1 warning to fix, in 9 places`
    """
    way = f"{escape(found.old.name)} → {escape(found.new.name)}"
    total = format_count(len(found.packages), "package")
    if not found.breaks:
        if is_safe(found):
            return f"{way} is safe: no known break in {total}"
        old = format_causes(_list_old_errors(found))
        rest = [f"{old} already on {escape(found.old.name)}"] if old else []
        gaps = format_gaps(found.report.coverage)
        return "; ".join([f"{way}: no {'new' if old else 'known'} break in {total}", *rest, *([gaps] if gaps else [])])
    broken = _count_packages(found, (item for item in found.breaks if item.severity == "error"))
    affected = _count_packages(found, found.breaks)
    more = f" and may break {affected - broken:,} more" if 0 < broken < affected else ""
    what = format_severities(found.breaks)
    places = format_count(sum(len(item.findings) for item in found.breaks), "place")
    does = "breaks" if broken else "may break"
    return f"{way} {does} {broken or affected:,} of {total}{more}: {what} to fix, in {places}"


def _count_packages(found: Upgrade, items: Iterable[UpgradeItem]) -> int:
    """How many of the packages asked for items are about."""
    asked = {"", *(package.name for package in found.packages)}
    return len(asked & {package for item in items for finding in item.findings for package in finding.packages})


def is_safe(found: Upgrade) -> bool:
    """True where nothing breaks on the new target, and everything was read and resolved."""
    return not found.breaks and not _list_old_errors(found) and not format_gaps(found.report.coverage)


def _list_old_errors(found: Upgrade) -> list[Finding]:
    return [finding for finding in found.both if finding.severity == "error"]


def describe_fixable(found: Upgrade) -> str:
    """How much of the work can be done by the tool, empty without any."""
    reported = []
    for items, noun in ((found.breaks, "item"), (found.deprecations, "deprecation")):
        some = [item for item in items if found.count_fixes(item)]
        whole = sum(found.count_fixes(item) == len(item.findings) for item in some)
        part = f" ({len(some) - whole:,} more in part)" if whole < len(some) else ""
        reported += [f"{whole:,} of {format_count(len(items), noun)}{part}"] if some else []
    return f"{' and '.join(reported)} can be fixed: {found.command}" if reported else ""


def describe_rest(found: Upgrade) -> list[str]:
    """The findings that the upgrade does not cause, as clauses."""
    old, new = escape(found.old.name), escape(found.new.name)
    clauses = []
    if found.both:
        them = "it" if len(found.both) == 1 else "them"
        clauses.append(f"{format_causes(found.both)} already on {old}: {found.check_old} lists {them}")
    if found.over:
        clauses.append(f"{format_causes(found.over)} only on {old}, not on {new}")
    return clauses


def render_text(found: Upgrade, style: Style) -> str:
    """The list of work for people at a terminal."""
    role = "good" if is_safe(found) else _find_worst_severity(found.breaks)
    lines = [paint(style, role, format_verdict(found).replace("→", style.symbols[3]))]
    fixes = describe_fixable(found)
    lines += [f"  {paint(style, 'help', escape(fixes))}"] if fixes else []
    for word, target in (("from", found.old), ("to", found.new)):
        lines.append(f"  {paint(style, 'dim', f'{word} {describe_target(target)}')}")
        lines += [f"    {escape(note)}" for note in target.notes]
    steps = _group_by_package(found.breaks)
    for number, (package, items) in enumerate(steps.items(), 1):
        lines += ["", _format_title(f"{number} of {len(steps)}", package, found, style)]
        for item in items:
            lines += ["", *render_item(found.report, item, style, found.fixable)]
    if found.deprecations:
        lines += ["", paint(style, "bold", f"deprecated on {escape(found.new.name)}")]
        for package, items in _group_by_package(found.deprecations).items():
            lines += ["", _format_title("", package, found, style)]
            for item in items:
                lines += render_short_item(item, style, found.fixable)
    parts = [*describe_rest(found), format_coverage(found.report.coverage), f"{found.seconds:.2f} s"]
    return "\n".join([*lines, "", f" {style.symbols[4]} ".join(parts)]) + "\n"


def _find_worst_severity(items: Iterable[UpgradeItem]) -> str:
    return "error" if any(item.severity == "error" for item in items) else "warning"


def _group_by_package(items: Iterable[UpgradeItem]) -> dict[str, list[UpgradeItem]]:
    """Items by package, in the order in which they come."""
    steps: dict[str, list[UpgradeItem]] = {}
    for item in items:
        steps.setdefault(item.package, []).append(item)
    return steps


def _format_title(number: str, package: str, found: Upgrade, style: Style) -> str:
    folders = {each.name: each.path for each in found.packages}
    title = render_heading(package, folders.get(package, ""), style, "" if number else "package ")
    return f"{paint(style, 'dim', f'{number}: ')}{title}" if number else title


def render_json(found: Upgrade) -> str:
    """The list of work for programs."""
    counts = count_by_severity(found.breaks)
    return json.dump_json({
        "schema": SCHEMA,
        "tool": {"name": "rosimpact", "version": found.report.version, "data": found.report.data},
        "from": json.build_target_data(found.old) | json.build_notes(found.old),
        "to": json.build_target_data(found.new) | json.build_notes(found.new),
        "verdict": {
            "safe": is_safe(found),
            "text": format_verdict(found),
            "packages": _count_packages(found, found.breaks),
            "errors": counts["error"],
            "warnings": counts["warning"],
            "places": sum(len(item.findings) for item in found.breaks),
        },
        "fix": {
            "items": sum(found.count_fixes(item) > 0 for item in (*found.breaks, *found.deprecations)),
            "command": found.command,
        },
        "work": _build_work(found, found.breaks),
        "deprecations": _build_work(found, found.deprecations),
        "both": count_by_severity(found.both),
        "over": count_by_severity(found.over),
        "coverage": json.build_coverage_data(found.report.coverage) | {"packages": len(found.packages)},
    })  # fmt: skip


def _build_work(found: Upgrade, items: Iterable[UpgradeItem]) -> list[dict[str, Any]]:
    folders = {package.name: package.path for package in found.packages}
    return [
        {
            "package": package,
            "path": folders.get(package, ""),
            "items": [build_data(item) | {"fixable": found.count_fixes(item)} for item in items],
        }
        for package, items in _group_by_package(items).items()
    ]


def render_schema() -> str:
    """The published JSON schema as text (draft 2020-12); docs/upgrade.schema.json holds it."""
    return json.merge_shared_schema("upgrade.schema.json")


def render_html(found: Upgrade) -> str:
    """The list of work as one page that loads nothing."""
    return render_page(
        Path(__file__).with_name("upgrade.html"), f"rosimpact: upgrade of {found.report.root}", _build_data(found)
    )


def _build_data(found: Upgrade) -> Mapping[str, Any]:
    report = found.report
    return {
        "version": report.version,
        "data": report.data,
        "root": report.root,
        "verdict": format_verdict(found),
        "bad": "" if is_safe(found) else _find_worst_severity(found.breaks),
        "facts": [*describe_rest(found), format_coverage(report.coverage)],
        "fixes": describe_fixable(found).partition(": ")[0],
        "command": found.command,
        "from": found.old._asdict(),
        "to": found.new._asdict(),
        "seconds": round(found.seconds, 2),
        "folders": {package.name: package.path for package in found.packages},
        "rules": {rule.name: rule.summary for rule in report.rules() if rule.documentation},
        "items": [_build_row(found, item, group) for group, these in enumerate((found.breaks, found.deprecations))
                  for item in these],
    }  # fmt: skip


def _build_row(found: Upgrade, item: UpgradeItem, group: int) -> list[Any]:
    """Group (0 breaks, 1 deprecated), package, rule, subject, severity, how many places are fixable, findings."""
    names = [found.new.name]
    findings = [html.build_row(found.report, finding, names) for finding in item.findings]
    return [group, item.package, item.rule, item.subject, item.severity, found.count_fixes(item), findings]
