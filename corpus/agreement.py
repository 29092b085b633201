"""Agreement of two annotators: percent, Cohen's kappa and their intervals, over all labels and label by label.

Kappa's interval is the analytic one: the large-sample standard error of Fleiss, Cohen and Everitt, "Large sample
standard errors of kappa and weighted kappa", Psychological Bulletin 72(5), 1969, formula for the hypothesis that kappa
is not zero. The share's interval is Wilson's, "Probable inference", JASA 22(158), 1927.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from math import sqrt

import msgspec

_Z95 = 1.959963984540054


class Interval(msgspec.Struct, frozen=True):
    """A value between 0 and 1 (kappa: -1 and 1) with its 95 % interval; None where it is not defined."""

    value: float | None
    low: float | None
    high: float | None


class LabelAgreement(msgspec.Struct, frozen=True):
    """Agreement on one label.

    label: its name. first, second: how often each annotator gave it. both: how often both did. specific: the share of
    the times either gave it that the other gave it too, 2 both / (first + second). kappa: of this label against all
    the others.
    """

    label: str
    first: int
    second: int
    both: int
    specific: float | None
    kappa: Interval


class Agreement(msgspec.Struct, frozen=True):
    """Agreement over reports read by two annotators.

    reports: how many. same: how many got the same label twice. share: same / reports. kappa: Cohen's. labels: label by
    label. confusion: how often the first gave one label and the second another, by both labels; equal ones are in it.
    """

    reports: int
    same: int
    share: Interval
    kappa: Interval
    labels: tuple[LabelAgreement, ...]
    confusion: dict[str, dict[str, int]]


def compute_agreement(pairs: Iterable[tuple[str, str]], names: Sequence[str]) -> Agreement:
    """Agreement of pairs of labels: the first annotator's and the second's. names: all labels, in their order."""
    counted = Counter(pairs)
    total = sum(counted.values())
    same = sum(count for (a, b), count in counted.items() if a == b)
    labels = []
    for name in names:
        first = sum(count for (a, _), count in counted.items() if a == name)
        second = sum(count for (_, b), count in counted.items() if b == name)
        both = counted[name, name]
        against: Counter[tuple[str, str]] = Counter()
        for (a, b), count in counted.items():
            against[str(a == name), str(b == name)] += count
        share = 2 * both / (first + second) if first + second else None
        labels.append(LabelAgreement(name, first, second, both, share, _estimate_kappa(against)))
    confusion = {a: {b: counted[a, b] for b in names} for a in names}
    return Agreement(total, same, compute_wilson(same, total), _estimate_kappa(counted), tuple(labels), confusion)


def compute_kappa(pairs: Iterable[tuple[str, str]]) -> Interval:
    """Cohen's kappa of pairs of labels with its analytic 95 % interval. Not defined where chance explains it all."""
    return _estimate_kappa(Counter(pairs))


def compute_wilson(hits: int, total: int) -> Interval:
    """A share with Wilson's 95 % interval; not defined when total is 0."""
    if not total:
        return Interval(None, None, None)
    share, z2 = hits / total, _Z95 * _Z95
    middle = (share + z2 / (2 * total)) / (1 + z2 / total)
    half = _Z95 * sqrt(share * (1 - share) / total + z2 / (4 * total * total)) / (1 + z2 / total)
    return Interval(share, max(0.0, middle - half), min(1.0, middle + half))


def _estimate_kappa(counted: Counter[tuple[str, str]]) -> Interval:
    total = sum(counted.values())
    if not total:
        return Interval(None, None, None)
    rows: Counter[str] = Counter()
    columns: Counter[str] = Counter()
    for (a, b), count in counted.items():
        rows[a] += count
        columns[b] += count
    row = {name: count / total for name, count in rows.items()}
    column = {name: count / total for name, count in columns.items()}
    observed = sum(count for (a, b), count in counted.items() if a == b) / total
    chance = sum(share * column.get(name, 0.0) for name, share in row.items())
    if chance >= 1:
        return Interval(None, None, None)
    value = (observed - chance) / (1 - chance)
    on = off = 0.0
    for (a, b), count in counted.items():
        share = count / total
        if a == b:
            on += share * (1 - (row[a] + column[a]) * (1 - value)) ** 2
        else:
            off += share * (column.get(a, 0.0) + row.get(b, 0.0)) ** 2
    variance = on + (1 - value) ** 2 * off - (value - chance * (1 - value)) ** 2
    half = _Z95 * sqrt(max(0.0, variance) / total) / (1 - chance)
    return Interval(value, max(-1.0, value - half), min(1.0, value + half))
