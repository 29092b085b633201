"""Curves with intervals: how long things last when some still stand, and shares of things that come in groups."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

_Z95 = 1.959963984540054


class Curve(NamedTuple):
    """Values y at x with the bounds of their 95 % intervals; x rises."""

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    low: NDArray[np.float64]
    high: NDArray[np.float64]

    def evaluate(self, x: float) -> tuple[float, float, float]:
        """The value and its bounds in force at x: those of the last point not beyond it. Raises ValueError before the
        first point."""
        place = int(np.searchsorted(self.x, x, side="right")) - 1
        if place < 0:
            raise ValueError(f"the curve begins at {self.x[0]:g}, after {x:g}")
        return float(self.y[place]), float(self.low[place]), float(self.high[place])

    def invert(self) -> Curve:
        """The curve of what has happened from that of what has not: 1 - y, with its bounds."""
        return Curve(self.x, 1 - self.y, 1 - self.high, 1 - self.low)

    def find_first_below(self, share: float) -> float | None:
        """The first x at which y is at or below a share; None when it never is."""
        reached = np.flatnonzero(self.y <= share)
        return float(self.x[reached[0]]) if len(reached) else None


def estimate_survival(durations: Sequence[float], ended: Sequence[bool]) -> Curve:
    """Kaplan and Meier's estimate of the share that lasts longer than x, starting with 1 at x = 0.

    durations: how long each was followed. ended: whether it ended then; otherwise it was still standing. The interval
    is Greenwood's on the log-log scale (Kalbfleisch and Prentice, "The Statistical Analysis of Failure Time Data").
    Raises ValueError when nothing was followed.
    """
    times = np.asarray(durations, dtype=float)
    over = np.asarray(ended, dtype=bool)
    if not len(times):
        raise ValueError("nothing was followed, so there is no curve")
    x, y, low, high = [0.0], [1.0], [1.0], [1.0]
    share, spread = 1.0, 0.0
    for time in np.unique(times):
        at_risk, ends = int((times >= time).sum()), int((over & (times == time)).sum())
        if ends:
            share *= 1 - ends / at_risk
            spread += ends / (at_risk * (at_risk - ends)) if at_risk > ends else 0.0
        x.append(float(time))
        y.append(share)
        if 0 < share < 1:
            half = _Z95 * np.sqrt(spread) / abs(np.log(share))
            low.append(float(share ** np.exp(half)))
            high.append(float(share ** np.exp(-half)))
        else:
            low.append(share)
            high.append(share)
    if x[1] == 0:
        # What ended at once is gone at 0 already.
        x, y, low, high = x[1:], y[1:], low[1:], high[1:]
    return Curve(*(np.array(values) for values in (x, y, low, high)))


def estimate_pooled_share(hits: ArrayLike, totals: ArrayLike, x: Sequence[float], draws: int, seed: int = 0) -> Curve:
    """The share of all hits among all totals, with an interval over groups that hang together.

    hits: one row for each group, one column for each x. totals: one number for each group. The interval is the middle
    95 % of what comes out when whole groups are drawn anew, with replacement (percentile bootstrap).
    """
    counted, sizes = np.asarray(hits, dtype=float), np.asarray(totals, dtype=float)
    chance = np.random.default_rng(seed)
    weights = chance.multinomial(len(sizes), np.full(len(sizes), 1 / len(sizes)), size=draws).astype(float)
    shares = (weights @ counted) / np.maximum(weights @ sizes, 1e-12)[:, None]
    low, high = np.percentile(shares, [2.5, 97.5], axis=0)
    return Curve(np.asarray(x, dtype=float), counted.sum(axis=0) / sizes.sum(), low, high)
