"""What `measure` prints: a line for each cell with its intervals, or JSON."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import msgspec

from ..measure.intervals import CellSummary, MeanInterval
from ..measure.plan import SYNTHETIC, format_link
from ..measure.results import RunHeader

_COLUMNS = (
    "message", "bytes", "publishers", "Hz", "offered Mbit/s", "latency ms: mean", "p50", "p95", "p99",
    "dropped %", "publisher's queue", "subscriber's",
)  # fmt: skip

_KEPT_UP = 0.98
"""The share of a rate below which it is said that publishers did not reach it."""


def render_text(header: RunHeader, summaries: Sequence[CellSummary]) -> str:
    """The table of cells, and under which conditions they hold."""
    rows = [_COLUMNS, *(_render_row(header, each) for each in summaries)]
    widths = [max(len(row[place]) for row in rows) for place in range(len(_COLUMNS))]
    lines = [
        "  ".join(cell.ljust(width) if not place else cell.rjust(width)
                  for place, (cell, width) in enumerate(zip(row, widths, strict=True))).rstrip()
        for row in rows
    ]  # fmt: skip
    return "\n".join([*lines, "", *describe_conditions(header, summaries)])


def _render_row(header: RunHeader, summary: CellSummary) -> tuple[str, ...]:
    cell = summary.cell
    size = f"{cell.fields} fields" if header.conditions.message == SYNTHETIC else header.conditions.message
    latency = [format_interval(summary.latency.get(name), 2) for name in ("mean", "p50", "p95", "p99")]
    drops = [summary.dropped, summary.dropped_publisher, summary.dropped_subscriber]
    return (
        f"{size}, {cell.variant}", f"{summary.bytes:,}", str(cell.publishers), f"{cell.rate:g}",
        f"{summary.offered_mbit:.1f}", *latency, *(format_interval(each, 1) for each in drops),
    )  # fmt: skip


def format_interval(value: MeanInterval | None, digits: int) -> str:
    """`8.41 ±0.02`, by the larger side of the interval; `-` where nothing was delivered."""
    if value is None:
        return "-"
    if value.low is None or value.high is None:
        return f"{value.mean:.{digits}f}"
    half = max(value.mean - value.low, value.high - value.mean)
    return f"{value.mean:.{digits}f} ±{half:.{digits}f}"


def describe_conditions(header: RunHeader, summaries: Iterable[CellSummary]) -> list[str]:
    """Under which conditions cells were measured, by which clock, and what was beside them."""
    summaries = list(summaries)
    conditions = header.conditions
    link = {"namespaces": f"three network namespaces, links of {format_link(conditions.link)}",
            "loopback": "loopback, no limit", "machines": "two machines"}[conditions.network]  # fmt: skip
    repeated = sorted({each.repetitions for each in summaries})
    times = f"{repeated[0]} to {repeated[-1]}" if len(repeated) > 1 else str(*repeated or (0,))
    lines = [
        f"{conditions.nodes}, {link}, queues of {conditions.queue}, {conditions.seconds:g} s after "
        f"{conditions.warm_up:g} s of warm-up, repetitions: {times}; ± is the 95 % interval of Student's t over them",
        f"clock: {header.clock}",
    ]
    unsure = max((each.clock_uncertainty_ms for each in summaries), default=0)
    if unsure:
        lines.append(f"latencies are known to within ±{unsure:.2f} ms, as the offset of both clocks is")
    load, cores = max((each.load for each in summaries), default=0), header.machine.get("cores", "0")
    if load > float(cores) > 0:
        lines.append(f"other work ran beside it: the load average reached {load:.0f} on {cores} cores")
    lines += [
        f"{each.cell.describe()}: published at {each.achieved_rate.mean:.1f} Hz, more the publisher could not"
        for each in summaries if each.achieved_rate.mean < _KEPT_UP * each.cell.rate
    ]  # fmt: skip
    return lines


def render_json(header: RunHeader, summaries: Sequence[CellSummary]) -> str:
    """The header and the cells."""
    return msgspec.json.format(msgspec.json.encode({"header": header, "cells": summaries}), indent=2).decode()
