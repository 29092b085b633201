"""Numbers of the corpus: labels by year, distro, project, kind and phase; how they were decided; agreement."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

import msgspec

from ..edges.console import escape, format_count, write
from .agreement import Agreement, Interval, compute_agreement
from .distros import DISTROS, find_distros
from .report import KINDS, LABELS, PHASES, BugReport, Label, find_repository

if TYPE_CHECKING:
    from rich.console import Console

NONE_NAMED = "none named"
UNDATED = "undated"
_ELSEWHERE = {"ros-answers": "ROS Answers", "robotics-se": "Robotics Stack Exchange"}
_YEAR = re.compile(r"\b(?:19|20)\d\d\b")

Table = dict[str, dict[str, int]]
"""Row to label to number of reports."""


class Stats(msgspec.Struct, frozen=True):
    """Numbers of labels.

    reports: how many labels. labels: how many of each. kinds: label to kind to number. phases, projects, decided:
    tables by label. years, distros: the same, None without texts; a report that names several distros counts for each.
    read: of how many labels the texts were at hand. agreement: of reports with two annotators. notes: what could not
    be told, as sentences.
    """

    schema: int
    reports: int
    labels: dict[str, int]
    kinds: Table
    phases: Table
    projects: Table
    decided: Table
    years: Table | None
    distros: Table | None
    read: int
    agreement: Agreement
    notes: tuple[str, ...]


def compute_stats(labels: Sequence[Label], reports: Iterable[BugReport] | None = None) -> Stats:
    """Counts labels. reports: the texts, for years and distros; those without a label are passed over."""
    by_id = {label.id: label for label in labels}
    years: dict[str, Counter[str]] = defaultdict(Counter)
    distros: dict[str, Counter[str]] = defaultdict(Counter)
    read: set[str] = set()
    for report in reports or ():
        label = by_id.get(report.id)
        if label is None or report.id in read:
            continue
        read.add(report.id)
        years[find_year(report.date) or UNDATED][label.label] += 1
        for name in find_distros(f"{report.title}\n{report.body}") or (NONE_NAMED,):
            distros[name][label.label] += 1
    notes = []
    if reports is None:
        notes.append("years and distros are not counted: they are in the texts; give those with --reports")
    elif len(read) < len(by_id):
        notes.append(f"years and distros: {format_count(len(by_id) - len(read), 'text')} of {len(by_id):,} not at hand")
    projects = _count_labels(labels, lambda label: find_project(label.id))
    return Stats(
        schema=1,
        reports=len(by_id),
        labels=_make_row(Counter(label.label for label in labels)),
        kinds={
            name: {kind: sum(label.label == name and label.kind == kind for label in labels) for kind in kinds}
            for name, kinds in KINDS.items()
        },
        phases=_order_table(_count_labels(labels, lambda label: label.phase), PHASES),
        projects=dict(sorted(projects.items(), key=lambda item: (-sum(item[1].values()), item[0]))),
        decided=_order_table(_count_labels(labels, lambda label: label.decided), ()),
        years=None if reports is None else _order_table(years, (*sorted(set(years) - {UNDATED}), UNDATED)),
        distros=None if reports is None else _order_table(distros, (*DISTROS, NONE_NAMED)),
        read=len(read),
        agreement=compute_agreement(
            ((label.annotators[0], label.annotators[1]) for label in labels if label.twice), LABELS
        ),
        notes=tuple(notes),
    )


def find_project(id: str) -> str:
    """The repository of a report, or the site where there is none."""
    site = id.partition(":")[0]
    return find_repository(id) or _ELSEWHERE.get(site, site)


def find_year(date: str | None) -> str:
    """The year in a date, however it is written; empty when there is none."""
    found = _YEAR.search(date or "")
    return found.group() if found else ""


def render_json(stats: Stats) -> str:
    """The numbers as JSON: the fields of Stats, and `kappa_interval`, how the interval was made."""
    import json

    rows = msgspec.to_builtins(stats)
    rows["kappa_interval"] = "95 %, analytic (Fleiss, Cohen and Everitt 1969); shares: Wilson"
    return json.dumps(rows, indent=1)


def print_text(stats: Stats, most: int = 15) -> None:
    """Prints the numbers as tables: in colour on a terminal, plain elsewhere. most: how many projects are listed."""
    from rich.console import Console

    console = Console(highlight=False, markup=False)
    if not console.is_terminal:  # whoever reads a pipe cuts lines by itself
        console = Console(highlight=False, markup=False, no_color=True, width=200, color_system=None)
    with console.capture() as printed:
        _print_text(stats, most, console)
    write(printed.get())


def _print_text(stats: Stats, most: int, console: Console) -> None:
    console.print(format_count(stats.reports, "label"))
    console.print(_make_labels_table(stats))
    tables: list[tuple[str, Table | None]] = [
        ("phase", stats.phases), ("decided", stats.decided), ("year", stats.years), ("distro", stats.distros),
    ]  # fmt: skip
    for title, table in tables:
        if table:
            console.print(_make_rich_table(title, table))
    shown = dict(list(stats.projects.items())[:most])
    console.print(_make_rich_table("project", shown))
    if len(stats.projects) > most:
        console.print(f"and {len(stats.projects) - most:,} more projects (all of them: --format json)\n")
    for line in _format_agreement(stats.agreement):
        console.print(line)
    if stats.agreement.reports:
        console.print(_make_agreement_table(stats.agreement))
        console.print(_make_rich_table("first \\ second", stats.agreement.confusion, total=False))
    for note in stats.notes:
        console.print(escape(f"note: {note}"))


def _make_labels_table(stats: Stats):
    table = _make_empty_table("label", "reports", "share", "kind", "reports")
    for name, count in stats.labels.items():
        share = f"{100 * count / stats.reports:.1f} %" if stats.reports else ""
        kinds = stats.kinds.get(name, {})
        table.add_row(name, f"{count:,}", share, "\n".join(kinds), "\n".join(f"{n:,}" for n in kinds.values()))
    return table


def _make_rich_table(title: str, rows: Mapping[str, Mapping[str, int]], total: bool = True):
    from rich.text import Text

    table = _make_empty_table(title, *LABELS, *(["all"] if total else []))
    for name, counts in rows.items():
        cells = [f"{counts[label]:,}" if counts[label] else "\u00b7" for label in LABELS]
        table.add_row(Text(escape(name)), *cells, *([f"{sum(counts.values()):,}"] if total else []))
    return table


def _format_agreement(found: Agreement) -> list[str]:
    if not found.reports:
        return ["agreement: no report was read by two annotators"]
    return [
        f"agreement over {format_count(found.reports, 'report')} with two annotators: {found.same:,} the same, "
        f"{_format_percent(found.share)}; Cohen's kappa {_format(found.kappa)}",
        "intervals of 95 %: Wilson for the share, analytic (Fleiss, Cohen and Everitt 1969) for kappa",
    ]


def _make_agreement_table(found: Agreement):
    table = _make_empty_table("agreement by label", "first", "second", "both", "specific", "kappa")
    for row in found.labels:
        specific = f"{100 * row.specific:.1f} %" if row.specific is not None else ""
        table.add_row(row.label, f"{row.first:,}", f"{row.second:,}", f"{row.both:,}", specific, _format(row.kappa))
    return table


def _make_empty_table(first: str, *others: str):
    import sys

    from rich.box import ASCII2, SIMPLE_HEAD
    from rich.table import Table as RichTable

    box = SIMPLE_HEAD if "utf" in (getattr(sys.stdout, "encoding", None) or "").lower() else ASCII2
    table = RichTable(box=box, pad_edge=False)
    table.add_column(first)
    for name in others:
        table.add_column(name, justify="left" if name == "kind" else "right")
    return table


def _format(interval: Interval) -> str:
    if interval.value is None:
        return "not defined"
    return f"{interval.value:.2f} ({interval.low:.2f} to {interval.high:.2f})"


def _format_percent(interval: Interval) -> str:
    if interval.value is None or interval.low is None or interval.high is None:
        return "not defined"
    return f"{100 * interval.value:.1f} % ({100 * interval.low:.1f} to {100 * interval.high:.1f})"


def _count_labels(labels: Iterable[Label], row_of) -> dict[str, Counter[str]]:
    found: dict[str, Counter[str]] = defaultdict(Counter)
    for label in labels:
        found[row_of(label)][label.label] += 1
    return found


def _order_table(table: Mapping[str, Counter[str]] | Mapping[str, Mapping[str, int]], order: Sequence[str]) -> Table:
    names = [*order, *sorted(set(table) - set(order))]
    return {name: _make_row(table[name]) for name in names if name in table}


def _make_row(counts: Mapping[str, int]) -> dict[str, int]:
    return {name: counts.get(name, 0) for name in LABELS}
