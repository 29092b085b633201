"""From what a subscriber saw to numbers of one repetition, and from repetitions to means with intervals."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import numpy as np

from ...edges.console import UserError
from ...edges.files import read_file
from .plan import NetworkCell

ARRIVAL, CALLBACK = 0, 1
_RECORD = 5
_SAMPLES = 2 << 30
CONFIDENCE = 0.95
LATENCIES = ("mean", "p50", "p95", "p99")


class NetworkResult(msgspec.Struct, frozen=True, kw_only=True):
    """One repetition of one cell: a line of the file of results.

    bytes: of the message on the wire, its sample's head included. offered_mbit: what the publishers give, in Mbit/s,
    without headers of protocols. published, arrived, delivered: messages of the measured seconds; what is missing
    between them was dropped by the queue of the publisher, and by that of the subscriber, in percent of those
    published. achieved_rate: at which the slowest publisher published. late_percent: of all that was published, how
    much was more than a period behind schedule. latency: from the call that publishes to the callback, in
    milliseconds; none where nothing was delivered. waited_ms: how much of it, on the average, a message spent in the
    subscriber's queue. load: the machine's load average of a minute, behind the cell. clock_offset_ms,
    clock_uncertainty_ms: of two machines.
    """

    repetition: int
    publishers: int
    fields: int
    rate: float
    variant: str
    bytes: int
    offered_mbit: float
    published: int
    arrived: int
    delivered: int
    achieved_rate: float
    late_percent: float
    dropped_percent: float
    dropped_publisher_percent: float
    dropped_subscriber_percent: float
    latency_mean_ms: float | None
    latency_p50_ms: float | None
    latency_p95_ms: float | None
    latency_p99_ms: float | None
    latency_max_ms: float | None
    waited_ms: float | None
    load: float = 0
    clock_offset_ms: float = 0
    clock_uncertainty_ms: float = 0

    @property
    def cell(self) -> NetworkCell:
        """What was measured."""
        return NetworkCell(self.publishers, self.fields, self.rate, self.variant)


def read_samples(path: Path) -> Any:
    """The records that a subscriber wrote, a row for each: kind, publisher, number, sent, time. Raises UserError."""
    data = read_file(path, _SAMPLES)
    if len(data) % (8 * _RECORD):
        raise UserError(f"{path}: ends in the middle of a record; measure again")
    return np.frombuffer(data, "<i8").reshape(-1, _RECORD)


class PublishReport(NamedTuple):
    """How the publishers of a cell kept to their schedule: the rate of the slowest, and the share that was more than a
    period late, in percent."""

    rate: float
    late_percent: float


class Window(NamedTuple):
    """Which messages of each publisher count: those from `first` on, before `end`."""

    first: int
    end: int


def compute_result(
    samples: Any, cell: NetworkCell, repetition: int, window: Window, report: PublishReport, *, bytes: int,
    offset: float = 0, uncertainty: float = 0,
) -> NetworkResult:  # fmt: skip
    """The numbers of one repetition.

    samples: as read_samples() gives them. bytes: of one message. offset: what the subscriber's clock is ahead of the
    publishers', in nanoseconds; uncertainty: of that. Raises UserError for records that contradict each other.
    """
    counted = samples[(samples[:, 2] >= window.first) & (samples[:, 2] < window.end)]
    arrivals, callbacks = (counted[counted[:, 0] == kind] for kind in (ARRIVAL, CALLBACK))
    published = cell.publishers * (window.end - window.first)
    arrived, delivered = len(arrivals), len(callbacks)
    if delivered > arrived:
        raise UserError(f"{delivered - arrived} messages got a callback whose arrival was not seen; measure again")
    latency = (callbacks[:, 4] - callbacks[:, 3] - offset) / 1e6
    known = {(row[1], row[2]): row[4] for row in arrivals.tolist()}
    waits = [(row[4] - known[row[1], row[2]]) / 1e6 for row in callbacks.tolist() if (row[1], row[2]) in known]
    p50, p95, p99 = np.percentile(latency, [50, 95, 99]).tolist() if delivered else (None,) * 3

    def share(number: int) -> float:
        return round(100 * number / published, 4)

    return NetworkResult(
        repetition=repetition, publishers=cell.publishers, fields=cell.fields, rate=cell.rate, variant=cell.variant,
        bytes=bytes, offered_mbit=round(8e-6 * bytes * cell.rate * cell.publishers, 3), published=published,
        arrived=arrived, delivered=delivered, achieved_rate=round(report.rate, 3),
        late_percent=round(report.late_percent, 3), dropped_percent=share(published - delivered),
        dropped_publisher_percent=share(published - arrived), dropped_subscriber_percent=share(arrived - delivered),
        latency_mean_ms=_shorten(latency.mean() if delivered else None), latency_p50_ms=_shorten(p50),
        latency_p95_ms=_shorten(p95), latency_p99_ms=_shorten(p99),
        latency_max_ms=_shorten(latency.max() if delivered else None),
        waited_ms=_shorten(sum(waits) / len(waits) if waits else None), load=round(os.getloadavg()[0], 2),
        clock_offset_ms=round(offset / 1e6, 4),
        clock_uncertainty_ms=round(uncertainty / 1e6, 4),
    )  # fmt: skip


def _shorten(value: float | None) -> float | None:
    return None if value is None else round(float(value), 4)


class MeanInterval(msgspec.Struct, frozen=True):
    """A mean over repetitions with its interval; low and high are none for less than two."""

    mean: float
    low: float | None = None
    high: float | None = None

    def matches(self, other: MeanInterval) -> bool:
        """Whether both may be the same; False where one has no interval."""
        if self.low is None or self.high is None or other.low is None or other.high is None:
            return False
        return self.low <= other.high and other.low <= self.high


def compute_interval(values: Sequence[float], least: float | None = None, most: float | None = None) -> MeanInterval:
    """The mean of repetitions and the interval of Student's t around it, within bounds that the quantity has. Raises
    ValueError without values."""
    if not values:
        raise ValueError("no values")
    mean = math.fsum(values) / len(values)
    if len(values) < 2:
        return MeanInterval(mean)
    from scipy.stats import t  # a tenth of a second

    deviation = math.sqrt(math.fsum((value - mean) ** 2 for value in values) / (len(values) - 1))
    half = float(t.ppf(0.5 + CONFIDENCE / 2, len(values) - 1)) * deviation / math.sqrt(len(values))
    low = mean - half if least is None else max(least, mean - half)
    high = mean + half if most is None else min(most, mean + half)
    return MeanInterval(mean, low, high)


class CellSummary(msgspec.Struct, frozen=True, kw_only=True):
    """A cell over its repetitions. latency: by the names of LATENCIES, in milliseconds; empty where nothing came.
    dropped and its two parts are percent of the messages published. achieved_rate: as in NetworkResult.
    load, clock_uncertainty_ms: the highest of them."""

    cell: NetworkCell
    repetitions: int
    bytes: int
    offered_mbit: float
    latency: dict[str, MeanInterval]
    dropped: MeanInterval
    dropped_publisher: MeanInterval
    dropped_subscriber: MeanInterval
    achieved_rate: MeanInterval
    load: float
    clock_uncertainty_ms: float = 0


def summarize(results: Iterable[NetworkResult]) -> list[CellSummary]:
    """A summary for each cell, in the order in which they were first measured."""
    by_cell: dict[NetworkCell, list[NetworkResult]] = {}
    for result in results:
        by_cell.setdefault(result.cell, []).append(result)
    return [_summarize_cell(cell, rows) for cell, rows in by_cell.items()]


def _summarize_cell(cell: NetworkCell, rows: list[NetworkResult]) -> CellSummary:
    latency = {}
    for name in LATENCIES:
        values = [value for row in rows if (value := getattr(row, f"latency_{name}_ms")) is not None]
        if values:
            latency[name] = compute_interval(values, 0)
    drops: Mapping[str, MeanInterval] = {
        name: compute_interval([getattr(row, f"{name}_percent") for row in rows], 0, 100)
        for name in ("dropped", "dropped_publisher", "dropped_subscriber")
    }
    return CellSummary(
        cell=cell, repetitions=len(rows), bytes=rows[0].bytes, offered_mbit=rows[0].offered_mbit, latency=latency,
        achieved_rate=compute_interval([row.achieved_rate for row in rows]), load=max(row.load for row in rows),
        clock_uncertainty_ms=max(row.clock_uncertainty_ms for row in rows), **drops,
    )  # fmt: skip
