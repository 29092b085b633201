"""What differs between two machines, as text and JSON (see envdiff.schema.json)."""

from collections.abc import Iterator, Sequence
from typing import Any

from ...edges.console import escape, format_count
from ..analysis.machine_compare import DependencyUse, Machines
from ..analysis.report import ReportedTarget, format_severities, measure
from . import json
from .columns import LinePart, lay_out
from .items import build_data, render_item
from .style import Style, paint
from .text import describe_target

SCHEMA = 1
_TAKES = {
    "find_package": "finds", "component": "finds", "pkg-config": "finds", "include": "includes", "import": "imports",
    "launch": "starts", "shell": "starts", "plugin": "loads",
}  # fmt: skip
_IS = {"find_package": "found", "component": "found", "pkg-config": "found", "launch": "started", "shell": "started",
       "import": "imported", "plugin": "loaded"}  # fmt: skip
_USERS = 3
_SUBJECTS = 3


def render_text(found: Machines, style: Style) -> str:
    """What differs, for people: what breaks on one of them alone, then versions, then what is only counted."""
    lines = [f"compared: {describe_target(found.first)} and {describe_target(found.second)}"]
    lines += [f"  {escape(target.name)}: {escape(note)}" for target in _get_targets(found) for note in target.notes]
    if found.wire:
        lines += ["", *_render_wire(found, style)]
    if found.report is not None:
        for item in found.harms:
            lines += ["", *render_item(found.report, item, style)]
    if found.versions:
        lines += ["", *_render_versions(found, style)]
    return "\n".join([*lines, "", _format_summary(found, style)]) + "\n"


def _render_wire(found: Machines, style: Style) -> Iterator[str]:
    """What nodes on both machines cannot talk about."""
    yield paint(style, "bold", "what nodes on both cannot talk about")
    for each in found.wire:
        head = f"  {each.kind} {escape(each.name)}  {escape(each.type)}".rstrip()
        pieces = [LinePart(head), LinePart(escape(each.why))]
        pieces += [LinePart("", path=f"{escape(path)}:{line}") for path, line in each.places[:1]]
        yield from lay_out(pieces, style, 0, 4)


def _get_targets(found: Machines) -> tuple[ReportedTarget, ReportedTarget]:
    return found.first, found.second


def _render_versions(found: Machines, style: Style) -> Iterator[str]:
    head = (
        "versions" if found.report is None else "what it uses",
        escape(found.first.name),
        escape(found.second.name),
    )
    # No name begins a line: CI systems read what is there.
    rows = [
        (f"  {escape(each.name)}", escape(each.first or "-"), escape(each.second or "-")) for each, _ in found.versions
    ]
    widths = [max(measure(row[place]) for row in (head, *rows)) for place in range(3)]

    def pad_cells(row: Sequence[str]) -> list[str]:
        return [word + " " * (width - measure(word)) for word, width in zip(row, widths, strict=True)]

    yield paint(style, "bold", "  ".join(pad_cells(head)).rstrip())
    for row, used in zip(rows, found.versions, strict=True):
        pieces = [LinePart("  ".join(pad_cells(row)) if used.uses else "  ".join(pad_cells(row)).rstrip())]
        name = used.difference.name
        users = list(dict.fromkeys(use.package for use in used.uses))
        pieces += [
            LinePart(f"{package}: {_describe_use([use for use in used.uses if use.package == package], name)}", "dim")
            for package in users[:_USERS]
        ]
        if len(users) > _USERS:
            pieces.append(LinePart(f"and {format_count(len(users) - _USERS, 'more package')}", "dim"))
        yield from lay_out(pieces, style, 0, 4)


def _describe_use(uses: Sequence[DependencyUse], name: str) -> str:
    """How a package uses what has this name, in a clause: what it takes of it, or else that it takes it."""
    subjects: dict[str, list[str]] = {}
    for use in uses:
        subjects.setdefault(_TAKES.get(use.how, ""), []).extend(each for each in use.subjects if each != name)
    reported = [f"{verb} {_format_names(list(dict.fromkeys(each)))}" for verb, each in subjects.items() if each]
    how = next((use.how for use in uses if use.how != "declared"), "declared")
    return ", ".join(reported) or _IS.get(how, how)


def _format_names(names: list[str]) -> str:
    more = len(names) - _SUBJECTS
    return ", ".join(escape(name) for name in names[:_SUBJECTS]) + (f" and {more:,} more" if more > 0 else "")


def _format_summary(found: Machines, style: Style) -> str:
    if found.report is None:
        return format_count(len(found.machine) + len(found.versions), "difference")
    parts = [
        f"{alone} only on {escape(target.name)}"
        for target in _get_targets(found)
        if (alone := format_severities(h for h in found.harms if target.name in h.findings[0].targets))
    ]
    reported = ", ".join(parts) or "nothing breaks on only one of them"
    both = f"{format_count(found.both, 'finding')} on both" if found.both else ""
    versions = f"different versions: {len(found.versions):,} of what it uses, {found.others:,} others"
    return f" {style.symbols[4]} ".join(part for part in (reported, both, versions) if part)


def render_json(found: Machines, version: str) -> str:
    """What differs, for programs."""
    data: dict[str, Any] = {
        "schema": SCHEMA,
        "tool": {"name": "rosimpact", "version": version},
        "first": json.build_target_data(found.first),
        "second": json.build_target_data(found.second),
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
        data["wire"] = [
            each._asdict() | {"places": [f"{path}:{line}" for path, line in each.places]} for each in found.wire
        ]
        data["others"] = found.others
        data["both"] = found.both
        data["harms"] = [
            {"target": item.findings[0].targets[0], "package": item.package} | build_data(item) for item in found.harms
        ]
    return json.dump_json(data)


def render_schema() -> str:
    """The published JSON schema as text (draft 2020-12); docs/envdiff.schema.json holds it."""
    return json.merge_shared_schema("envdiff.schema.json")
