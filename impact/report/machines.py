"""What differs between two machines, as text and JSON (see envdiff.schema.json)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from ...edges.console import counted, visible
from ..analysis.machine_compare import DependencyUse, Machines
from ..analysis.report import ReportedTarget, cells, severities_text
from . import json
from .columns import LinePart, laid_out
from .items import as_data, item_lines
from .style import Style, painted
from .text import described

SCHEMA = 1
_TAKES = {
    "find_package": "finds", "component": "finds", "pkg-config": "finds", "include": "includes", "import": "imports",
    "launch": "starts", "shell": "starts", "plugin": "loads",
}  # fmt: skip
_IS = {"find_package": "found", "component": "found", "pkg-config": "found", "launch": "started", "shell": "started",
       "import": "imported", "plugin": "loaded"}  # fmt: skip
_USERS = 3
_SUBJECTS = 3


def text(found: Machines, style: Style) -> str:
    """What differs, for people: what breaks on one of them alone, then versions, then what is only counted."""
    lines = [f"compared: {described(found.first)} and {described(found.second)}"]
    lines += [f"  {visible(target.name)}: {visible(note)}" for target in _targets(found) for note in target.notes]
    if found.report is not None:
        for item in found.harms:
            lines += ["", *item_lines(found.report, item, style)]
    if found.versions:
        lines += ["", *_versions(found, style)]
    return "\n".join([*lines, "", _summary(found, style)]) + "\n"


def _targets(found: Machines) -> tuple[ReportedTarget, ReportedTarget]:
    return found.first, found.second


def _versions(found: Machines, style: Style) -> Iterator[str]:
    head = (
        "versions" if found.report is None else "what it uses",
        visible(found.first.name),
        visible(found.second.name),
    )
    # No name begins a line: CI systems read what is there.
    rows = [
        (f"  {visible(each.name)}", visible(each.first or "-"), visible(each.second or "-"))
        for each, _ in found.versions
    ]
    widths = [max(cells(row[place]) for row in (head, *rows)) for place in range(3)]

    def padded(row: Sequence[str]) -> list[str]:
        return [word + " " * (width - cells(word)) for word, width in zip(row, widths, strict=True)]

    yield painted(style, "bold", "  ".join(padded(head)).rstrip())
    for row, used in zip(rows, found.versions, strict=True):
        pieces = [LinePart("  ".join(padded(row)) if used.uses else "  ".join(padded(row)).rstrip())]
        name = used.difference.name
        users = list(dict.fromkeys(use.package for use in used.uses))
        pieces += [
            LinePart(f"{package}: {_told([use for use in used.uses if use.package == package], name)}", "dim")
            for package in users[:_USERS]
        ]
        if len(users) > _USERS:
            pieces.append(LinePart(f"and {counted(len(users) - _USERS, 'more package')}", "dim"))
        yield from laid_out(pieces, style, 0, 4)


def _told(uses: Sequence[DependencyUse], name: str) -> str:
    """How a package uses what has this name, in a clause: what it takes of it, or else that it takes it."""
    subjects: dict[str, list[str]] = {}
    for use in uses:
        subjects.setdefault(_TAKES.get(use.how, ""), []).extend(each for each in use.subjects if each != name)
    told = [f"{verb} {_some(list(dict.fromkeys(each)))}" for verb, each in subjects.items() if each]
    how = next((use.how for use in uses if use.how != "declared"), "declared")
    return ", ".join(told) or _IS.get(how, how)


def _some(names: list[str]) -> str:
    more = len(names) - _SUBJECTS
    return ", ".join(visible(name) for name in names[:_SUBJECTS]) + (f" and {more:,} more" if more > 0 else "")


def _summary(found: Machines, style: Style) -> str:
    if found.report is None:
        return counted(len(found.machine) + len(found.versions), "difference")
    parts = [
        f"{alone} only on {visible(target.name)}"
        for target in _targets(found)
        if (alone := severities_text((h for h in found.harms if target.name in h.findings[0].targets), " and "))
    ]
    told = ", ".join(parts) or "nothing breaks on only one of them"
    both = f"{counted(found.both, 'finding')} on both" if found.both else ""
    versions = f"different versions: {len(found.versions):,} of what it uses, {found.others:,} others"
    return f" {style.symbols[4]} ".join(part for part in (told, both, versions) if part)


def as_json(found: Machines, version: str) -> str:
    """What differs, for programs."""
    data: dict[str, Any] = {
        "schema": SCHEMA,
        "tool": {"name": "rosimpact", "version": version},
        "first": json.target_as_data(found.first),
        "second": json.target_as_data(found.second),
        "machine": [each._asdict() for each in found.machine],
        "versions": [
            used.difference._asdict()
            | (
                {"uses": [use._asdict() | {"subjects": list(use.subjects)} for use in used.uses]}
                if found.report is not None
                else {}
            )
            for used in found.versions
        ],
    }
    if found.report is not None:
        data["others"] = found.others
        data["both"] = found.both
        data["harms"] = [
            {"target": item.findings[0].targets[0], "package": item.package} | as_data(item) for item in found.harms
        ]
    return json.dumped(data)


def schema() -> str:
    """The published JSON schema as text (draft 2020-12); docs/envdiff.schema.json holds it."""
    return json.schema_with("envdiff.schema.json")
