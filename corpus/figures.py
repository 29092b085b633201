"""How the study looks: one style for all plots, tables as Markdown and CSV, and where both are written.

Colours are those of Okabe and Ito, which people of every colour vision tell apart; lines carry their names themselves.
"""

from __future__ import annotations

import csv
import hashlib
import io
import json
import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np

from ..edges.files import open_for_replacing, write_file
from .curves import Curve
from .report import LABELS_FILE, CorpusError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SETTINGS = "ROSIMPACT_STUDY"
"""The environment variable through which `study run` tells a notebook where to write and what to read."""

INK, GREY, PALE = "#222222", "#767676", "#d9d9d9"
BLUE, ORANGE, GREEN, PURPLE, SKY, RED, YELLOW = (
    "#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#b8a800",
)  # fmt: skip
COLOURS = (BLUE, RED, GREEN, ORANGE, PURPLE, SKY, YELLOW, INK)
LABEL_COLOURS = {
    "library-update": BLUE,
    "dependency": ORANGE,
    "inconsistency": GREEN,
    "message-logic": PURPLE,
    "other": GREY,
}

STYLE: dict[Any, Any] = {
    "figure.dpi": 100,
    "savefig.dpi": 120,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
    "font.family": "DejaVu Sans",
    "font.size": 10,
    "text.color": INK,
    "axes.edgecolor": GREY,
    "axes.labelcolor": GREY,
    "axes.titlelocation": "left",
    "axes.titlesize": 11,
    "axes.titleweight": "bold",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#ececec",
    "grid.linewidth": 0.8,
    "xtick.color": GREY,
    "ytick.color": GREY,
    "xtick.major.size": 0,
    "ytick.major.size": 0,
    "lines.linewidth": 2,
    "lines.solid_capstyle": "round",
    "svg.hashsalt": "rosimpact",
    "svg.fonttype": "none",
}


class Page:
    """What a notebook writes to, and what it may read. `Page.open()` gives the one that `study run` asked for.

    name: of the notebook. full: whether this is the full form. reports: the file with the reports' texts, None in the
    small form. data: the folder with the small shipped data. output: the folder that gets `figures/` and `tables/`.
    """

    def __init__(self, name: str, output: Path, data: Path, full: bool = False, reports: Path | None = None):
        self.name, self.output, self.data, self.full, self.reports = name, output, data, full, reports

    @classmethod
    def open(cls, name: str) -> Page:
        """The page of a notebook: as `study run` said, else the small form, written beside the notebook to `out/`."""
        import matplotlib

        matplotlib.use("Agg")
        matplotlib.rcParams.update(STYLE)
        said = json.loads(os.environ.get(SETTINGS, "{}"))
        reports = said.get("reports")
        return cls(
            name,
            Path(said.get("output", "out")),
            Path(said.get("data", "data")),
            bool(said.get("full", False)),
            Path(reports) if reports else None,
        )

    def show(self, figure: Figure, name: str) -> Any:
        """Writes a figure as `figures/NAME.svg` and `.png` and gives it to the notebook as a picture.

        Raises ValueError when nothing is drawn in it.
        """
        from IPython.display import Image

        if not any(axes.has_data() for axes in figure.axes):
            raise ValueError(f"figure `{name}` is empty: nothing was drawn")
        _, picture = save(figure, self.output / "figures", name)
        return Image(data=picture.read_bytes(), width=int(figure.get_figwidth() * 100))

    def write_table(self, name: str, columns: Sequence[str], rows: Iterable[Sequence[object]], most: int = 60) -> Any:
        """Writes a table as `tables/NAME.csv` and gives it to the notebook as Markdown, its first `most` rows.

        Numbers keep all their digits in the file. Raises ValueError when there is no row.
        """
        from IPython.display import Markdown

        kept = [list(row) for row in rows]
        if not kept:
            raise ValueError(f"table `{name}` is empty")
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerows([columns, *kept])
        write_file(self.output / "tables" / f"{name}.csv", text.getvalue().encode())
        lines = ["| " + " | ".join(columns) + " |", "|" + "|".join("---" for _ in columns) + "|"]
        lines += ["| " + " | ".join(_format_cell(value) for value in row) + " |" for row in kept[:most]]
        if len(kept) > most:
            lines += ["", f"{len(kept) - most} more rows in `tables/{name}.csv`."]
        return Markdown("\n".join(lines))

    def say(self, *sentences: str) -> Any:
        """Sentences with figures in them, as Markdown: one paragraph."""
        from IPython.display import Markdown

        return Markdown(" ".join(sentences))

    def show_versions(self, **more: str) -> Any:
        """What this was computed with: the form, the labels in use and whatever else is given, as a table."""
        from importlib.metadata import version

        labels = LABELS_FILE.read_bytes()
        rows = {
            "form": "full" if self.full else "small",
            "rosimpact": version("rosimpact"),
            "labels": f"{len(labels.splitlines()):,}, SHA-256 {hashlib.sha256(labels).hexdigest()[:16]}",
            **more,
        }
        from IPython.display import Markdown

        return Markdown("\n".join(["| what | version |", "|---|---|", *(f"| {k} | {v} |" for k, v in rows.items())]))

    def read_shipped(self, name: str) -> list[dict[str, str]]:
        """The rows of a CSV file of the small shipped data. Raises CorpusError when it is not there."""
        path = self.data / name
        try:
            with path.open(encoding="utf-8", newline="") as file:
                return list(csv.DictReader(file))
        except OSError as error:
            raise CorpusError(f"{path}: cannot be read: {error.strerror}; take the file from the repository") from None


def format_percent(share: float, digits: int = 0) -> str:
    """`0.123` as `12 %`."""
    return f"{100 * share:.{digits}f} %"


def format_interval(value: float, low: float, high: float, digits: int = 0) -> str:
    """A share with its interval: `12 % (10 to 15)`."""
    return f"{100 * value:.{digits}f} % ({100 * low:.{digits}f} to {100 * high:.{digits}f})"


def make_canvas(wide: float = 9, high: float = 4.5, rows: int = 1, columns: int = 1, **more: Any) -> tuple[Figure, Any]:
    """A figure in inches, and its axes: one, or an array of rows x columns."""
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(rows, columns, figsize=(wide, high), layout="constrained", **more)
    return figure, axes


def save(figure: Figure, folder: Path, name: str) -> tuple[Path, Path]:
    """Writes a figure as NAME.svg and NAME.png into a folder, which is made; the same figure gives the same bytes.
    Returns both files. Raises OSError."""
    import matplotlib.pyplot as plt

    drawn, picture = folder / f"{name}.svg", folder / f"{name}.png"
    try:
        with open_for_replacing(drawn) as file:
            figure.savefig(file, format="svg", bbox_inches="tight", metadata={"Date": None, "Creator": "rosimpact"})
        pixels = io.BytesIO()
        figure.savefig(pixels, format="png", bbox_inches="tight")
        with open_for_replacing(picture) as file:
            write_palette_png(pixels, file)
    finally:
        plt.close(figure)
    return drawn, picture


def write_palette_png(picture: IO[bytes], file: IO[bytes]) -> None:
    """Writes a PNG with a palette of 256 colours, in a third of the bytes of matplotlib's true colour."""
    from PIL import Image, PngImagePlugin

    information = PngImagePlugin.PngInfo()
    information.add_text("Software", "rosimpact")
    with Image.open(picture) as drawn:
        few = drawn.convert("RGB").quantize(256, dither=Image.Dither.NONE)
        few.save(file, "PNG", optimize=True, pnginfo=information, dpi=drawn.info.get("dpi"))


def write_headline(axes: Axes, title: str, below: str = "") -> None:
    """A title, and under it in grey what is shown."""
    axes.set_title(title + ("\n" if below else ""), pad=8)
    if below:
        axes.annotate(below, (0, 1), (0, 8), xycoords="axes fraction", textcoords="offset points", color=GREY, size=9)


def mark_percent(axes: Axes, which: str = "y", top: float | None = None) -> None:
    """Marks an axis in percent, from 0 to `top` (a share) where that is given."""
    from matplotlib.ticker import PercentFormatter

    axis = axes.yaxis if which == "y" else axes.xaxis
    axis.set_major_formatter(PercentFormatter(1, decimals=0))
    limit = axes.set_ylim if which == "y" else axes.set_xlim
    if top is not None:
        limit(0, top)


def draw_line(axes: Axes, curve: Curve, name: str, colour: str, step: bool = True, band: bool = True) -> None:
    """One curve with its interval as a band. `names` writes its name later."""
    where = "steps-post" if step else "default"
    axes.plot(curve.x, curve.y, color=colour, drawstyle=where, label=name)
    if band:
        axes.fill_between(
            curve.x, curve.low, curve.high, step="post" if step else None, color=colour, alpha=0.15, linewidth=0
        )


def write_names(axes: Axes, room: float = 0.18, size: float = 9) -> None:
    """Writes each line's name at its end, in its colour; those of lines that end near each other are kept apart.
    room: added width for them, as a share of the axis."""
    from matplotlib.patheffects import withStroke

    left, right = axes.get_xlim()
    bottom, top = axes.get_ylim()
    ends = []
    for drawn in axes.get_lines():
        name = str(drawn.get_label())
        x, y = np.asarray(drawn.get_xdata(), dtype=float), np.asarray(drawn.get_ydata(), dtype=float)
        if name.startswith("_") or not len(x):
            continue
        ends.append([float(y[-1]), float(x[-1]), name, drawn.get_color()])
    height = axes.get_window_extent().height or 300
    gap = (size + 3) * 100 / 72 / height * (top - bottom)
    width = right - left
    axes.set_xlim(left, right + room * width)
    for near in _group_neighbours(ends, 0.05 * width):
        near.sort(key=lambda end: end[0])
        places = spread_places([end[0] for end in near], gap, bottom, top)
        for (y, x, name, colour), place in zip(near, places, strict=True):
            written = axes.annotate(
                name, (x, y), (x + 0.01 * width, place), color=colour, size=size, va="center", annotation_clip=False
            )
            written.set_path_effects([withStroke(linewidth=2.5, foreground="white")])


def _group_neighbours(ends: list[list[Any]], reach: float) -> list[list[list[Any]]]:
    """Ends (y, x, …) in groups: each is within reach of the one before it in x."""
    groups: list[list[list[Any]]] = []
    for end in sorted(ends, key=lambda end: end[1]):
        if groups and end[1] - groups[-1][-1][1] <= reach:
            groups[-1].append(end)
        else:
            groups.append([end])
    return groups


def spread_places(wanted: Sequence[float], gap: float, bottom: float, top: float) -> list[float]:
    """Places near the wanted ones (rising), a gap from each other at least, within bottom and top where they fit."""
    places: list[float] = []
    for value in wanted:
        places.append(max(value, places[-1] + gap) if places else max(value, bottom))
    limit = top
    for number in range(len(places) - 1, -1, -1):
        if places[number] <= limit:
            break
        places[number] = limit
        limit -= gap
    return places


def draw_dots(
    axes: Axes, rows: Sequence[str], series: Mapping[str, Sequence[tuple[float, float, float] | None]],
    colours: Sequence[str] = COLOURS,
) -> None:  # fmt: skip
    """For each row a dot with its interval (value, low, high) in each series, the first row on top; None draws none."""
    offsets = np.linspace(0.18, -0.18, len(series)) if len(series) > 1 else np.zeros(1)
    for (name, values), colour, offset in zip(series.items(), colours, offsets, strict=False):
        for place, value in enumerate(values):
            if value is None:
                continue
            y = len(rows) - 1 - place + offset
            axes.plot(value[1:], [y, y], color=colour, linewidth=2, alpha=0.45)
            axes.plot([value[0]], [y], "o", color=colour, markersize=5.5)
        axes.plot([], [], "o", color=colour, label=name)
    axes.set_yticks(range(len(rows)), list(reversed(rows)))
    axes.tick_params(axis="y", labelcolor=INK)
    axes.grid(axis="y", visible=False)
    if len(series) > 1:
        below = -0.35 * axes.figure.dpi / axes.figure.bbox.height  # a third of an inch, however high the figure
        axes.legend(frameon=False, loc="upper center", bbox_to_anchor=(0.5, below), ncols=len(series), labelcolor=INK)


def draw_stacked_bars(
    axes: Axes, rows: Sequence[str], series: Mapping[str, Sequence[float]], colours: Mapping[str, str],
    words: str = "{:.0f}", least: float = 0.06,
) -> None:  # fmt: skip
    """Lying bars in pieces, the first row on top; a piece of at least `least` of the longest bar carries its value."""
    left = np.zeros(len(rows))
    longest = max(sum(values) for values in zip(*series.values(), strict=True))
    places = np.arange(len(rows))[::-1]
    for name, values in series.items():
        axes.barh(places, values, left=left, color=colours[name], label=name, height=0.72)
        for place, start, value in zip(places, left, values, strict=True):
            if value >= least * longest:
                axes.text(start + value / 2, place, words.format(value), ha="center", va="center", size=8,
                          color=_choose_ink(colours[name]))  # fmt: skip
        left = left + np.asarray(values, dtype=float)
    axes.set_yticks(places, rows)
    axes.tick_params(axis="y", labelcolor=INK)
    axes.grid(axis="y", visible=False)
    if len(series) > 1:
        axes.legend(frameon=False, loc="lower left", bbox_to_anchor=(0, 1), ncols=len(series), borderpad=0,
                    handlelength=1, columnspacing=1.2, labelcolor=INK)  # fmt: skip


def draw_heatmap(
    axes: Axes, values: Any, rows: Sequence[str], columns: Sequence[str], words: str = "{:.0f}", scale: float = 100,
    top: float | None = None,
) -> None:  # fmt: skip
    """A table of cells, the darker the higher, each with its value times scale; what is no number stays blank."""
    table = np.asarray(values, dtype=float)
    axes.imshow(table, cmap="Blues", vmin=0, vmax=top if top is not None else np.nanmax(table), aspect="auto")
    limit = (top if top is not None else np.nanmax(table)) * 0.6
    for (row, column), value in np.ndenumerate(table):
        if not np.isnan(value):
            axes.text(column, row, words.format(value * scale), ha="center", va="center", size=8,
                      color="white" if value > limit else INK)  # fmt: skip
    axes.set_xticks(range(len(columns)), columns, rotation=45, ha="right")
    axes.set_yticks(range(len(rows)), rows)
    axes.tick_params(labelcolor=INK)
    axes.grid(visible=False)
    for spine in axes.spines.values():
        spine.set_visible(False)


def _choose_ink(colour: str) -> str:
    red, green, blue = (int(colour[place : place + 2], 16) for place in (1, 3, 5))
    return INK if 0.299 * red + 0.587 * green + 0.114 * blue > 140 else "white"


def _format_cell(value: object) -> str:
    if value is None:
        return ""
    if isinstance(value, float):
        return f"{value:.3f}"
    if isinstance(value, int) and not isinstance(value, bool):
        return f"{value:,}" if abs(value) >= 10_000 else str(value)
    return str(value).replace("|", "\\|").replace("\n", " ")
