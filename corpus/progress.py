"""How far a gathering is: a line that renews itself on a terminal, a line per page where `--verbose` asks for it."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from contextlib import suppress
from types import TracebackType
from typing import TYPE_CHECKING, TextIO

from ..edges.console import UserError, escape, write
from .gather import Progress
from .store import ReportCounts

if TYPE_CHECKING:
    from rich.progress import Progress as Bars
    from rich.progress import TaskID

_PAGES_TO_JUDGE = 3


class Estimate:
    """How long a job will still take, from how long it took so far, waits included. Says nothing before it can know.

    clock: seconds, ever growing.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic):
        self._clock = clock
        self._first: tuple[float, int] | None = None
        self._seen = 0

    def estimate_left(self, done: int, of: int | None) -> float | None:
        """Seconds, or None while that cannot be known. done, of: reports read and to be read in all."""
        now = self._clock()
        self._seen += 1
        if self._first is None:
            # what came before the first answer says nothing of the pace
            self._first = (now, done)
        since, start = self._first
        if of is None or self._seen <= _PAGES_TO_JUDGE or done <= start or of <= done:
            return None
        return (now - since) / (done - start) * (of - done)


class Reporter:
    """Tells of a job on standard error; a context manager. verbose: a line for each page off a terminal, too. quiet:
    nothing but waits."""

    def __init__(self, name: str, *, verbose: bool = False, quiet: bool = False, stream: TextIO | None = None):
        self._name = name
        self._stream = stream or sys.stderr
        self._verbose = verbose
        self._bars: Bars | None = None
        self._task: TaskID | None = None
        self._terminal = not quiet and self._stream is not None and self._stream.isatty()
        self._estimate = Estimate()

    def __enter__(self) -> Reporter:
        if self._terminal:
            from rich.console import Console
            from rich.progress import BarColumn, TextColumn
            from rich.progress import Progress as Bars

            self._bars = Bars(
                TextColumn("{task.description}", markup=False),
                BarColumn(bar_width=20),
                TextColumn("{task.fields[said]}", markup=False),
                console=Console(file=self._stream),
                transient=True,
            )
            self._bars.start()
            self._task = self._bars.add_task(self._name, total=None, said="asking")
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bars is not None:
            self._bars.stop()

    def report_page(self, progress: Progress) -> None:
        """Tells how far the job is."""
        left = self._estimate.estimate_left(progress.done, progress.of)
        said = describe_progress(progress, left)
        if self._bars is not None and self._task is not None:
            self._bars.update(self._task, completed=progress.done, total=progress.of, said=said)
        if self._verbose:
            self.print_line(f"{self._name}: {said}")

    def print_line(self, text: str) -> None:
        """A line that stays: why the job waits, for one."""
        if self._bars is not None:
            self._bars.console.print(escape(text), markup=False, highlight=False)
        elif self._stream is not None:
            with suppress(UserError, BrokenPipeError):
                write(text, self._stream)


def describe_progress(progress: Progress, left: float | None) -> str:
    """How far a job is, in words. left: seconds, None where nobody knows."""
    of = f" of about {progress.of:,}" if progress.of is not None and progress.of > progress.done else ""
    time_left = f", {format_span(left)} left" if left is not None else ""
    return f"{progress.done:,}{of} read; {describe_outcome(progress.taken)}{time_left}"


def describe_outcome(taken: ReportCounts) -> str:
    """What became of reports, in words."""
    named = [(taken.new, "new"), (taken.changed, "changed"), (taken.same, "unchanged"), (taken.gone, "gone")]
    return ", ".join(f"{count:,} {word}" for count, word in named if count) or "nothing new"


def format_span(seconds: float) -> str:
    """A span of time as people say it, in the unit that suits it."""
    if seconds < 90:
        return f"about {max(1, round(seconds))} s"
    return f"about {round(seconds / 60)} min" if seconds < 5400 else f"about {seconds / 3600:.1f} h"
