"""Plots of the corpus's numbers, each as SVG and PNG."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from .outputs import need_folder
from .report import LABELS, CorpusError
from .stats import NONE_NAMED, UNDATED, Stats

PROJECTS = 20
"""How many projects are drawn."""


def need_plots(folder: Path) -> None:
    """Raises CorpusError when nothing can be drawn into a folder, so that it is known before the numbers are."""
    from importlib.util import find_spec

    if find_spec("matplotlib") is None:
        raise CorpusError("--plots: matplotlib is missing; install it with `pip install 'rosimpact[study]'`")
    need_folder(folder)


def draw(stats: Stats, folder: Path) -> list[Path]:
    """Draws all tables that have numbers into a folder, which is made. Returns the files. Raises CorpusError."""
    need_plots(folder)
    import matplotlib

    matplotlib.use("Agg")
    from .figures import STYLE

    try:
        with matplotlib.rc_context(STYLE):
            return list(_draw_plots(stats, folder))
    except OSError as error:
        raise CorpusError(f"{folder}: cannot be written: {error.strerror}; give another folder") from None


def _draw_plots(stats: Stats, folder: Path) -> Iterator[Path]:
    from .figures import LABEL_COLOURS, draw_heatmap, draw_stacked_bars, make_canvas, save

    labels = {name: {name: count} for name, count in stats.labels.items()}
    kinds = {f"{label}: {kind}": {label: count} for label, row in stats.kinds.items() for kind, count in row.items()}
    tables: dict[str, tuple[str, Mapping[str, Mapping[str, int]]]] = {
        "labels": ("Reports by label", labels),
        "kinds": ("Reports by kind", kinds),
        "phases": ("Reports by phase", stats.phases),
        "projects": ("Reports by project", dict(list(stats.projects.items())[:PROJECTS])),
        "years": ("Reports by year", _remove_row(stats.years, UNDATED)),
        "distros": ("Reports by distro named in them", _remove_row(stats.distros, NONE_NAMED)),
    }
    for name, (title, table) in tables.items():
        if not any(sum(row.values()) for row in table.values()):
            continue
        figure, axes = make_canvas(8, max(2.2, 1.2 + 0.3 * len(table)))
        series = {label: [row.get(label, 0) for row in table.values()] for label in LABELS}
        draw_stacked_bars(axes, list(table), series, LABEL_COLOURS)
        legend = axes.get_legend()
        if legend is not None and name in ("labels", "kinds"):  # the rows say it themselves
            legend.remove()
        axes.set_xlabel("reports")
        figure.suptitle(title, x=0.01, ha="left", fontweight="bold")
        yield from save(figure, folder, name)
    if stats.agreement.reports:
        figure, axes = make_canvas(8, 4.5)
        draw_heatmap(
            axes, [[row[b] for b in LABELS] for row in stats.agreement.confusion.values()], LABELS, LABELS, scale=1
        )
        axes.set_xlabel("second annotator")
        axes.set_ylabel("first annotator")
        figure.suptitle("Labels of two annotators", x=0.01, ha="left", fontweight="bold")
        yield from save(figure, folder, "agreement")


def _remove_row(table: Mapping[str, Mapping[str, int]] | None, row: str) -> dict[str, Mapping[str, int]]:
    return {name: counts for name, counts in (table or {}).items() if name != row}
