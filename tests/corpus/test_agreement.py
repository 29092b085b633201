"""Agreement of two annotators, against published numbers, scikit-learn and a bootstrap."""

from __future__ import annotations

import math
import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rosimpact.corpus.agreement import compute_agreement, compute_kappa, compute_wilson
from rosimpact.corpus.report import LABELS, read_labels


def pairs_of(table: list[list[int]]) -> list[tuple[str, str]]:
    names = "abcdefgh"
    return [(names[i], names[j]) for i, row in enumerate(table) for j, count in enumerate(row) for _ in range(count)]


TABLES = [
    [[106, 10, 4], [22, 28, 10], [2, 12, 6]],
    [[20, 5], [10, 15]],
    [[92, 1, 1], [3, 71, 0], [6, 0, 288]],
]


def value_of(shares: list[list[float]]) -> float:
    """Kappa as Cohen defines it, of a table of shares."""
    size = range(len(shares))
    chance = sum(sum(shares[i]) * sum(shares[k][i] for k in size) for i in size)
    return (sum(shares[i][i] for i in size) - chance) / (1 - chance)


def error_of(table: list[list[int]]) -> float:
    """Kappa's standard error by the delta method: its gradient by small differences, multinomial covariance."""
    total = sum(map(sum, table))
    shares = [[count / total for count in row] for row in table]
    mean = square = 0.0
    for i, row in enumerate(shares):
        for j, share in enumerate(row):
            nudged = [list(r) for r in shares]
            nudged[i][j] += 1e-7
            slope = (value_of(nudged) - value_of(shares)) / 1e-7
            mean += share * slope
            square += share * slope * slope
    return math.sqrt((square - mean * mean) / total)


@pytest.mark.parametrize("table", TABLES)
def test_the_interval_is_that_of_the_delta_method(table):
    found = compute_kappa(pairs_of(table))
    assert (found.high - found.low) / 2 / 1.959964 == pytest.approx(error_of(table), rel=1e-4)


def test_kappa_of_a_known_table():
    assert compute_kappa(pairs_of([[20, 5], [10, 15]])).value == pytest.approx(0.4)  # observed 0.7, by chance 0.5


@settings(deadline=None)  # the first call imports scikit-learn
@given(st.lists(st.tuples(st.sampled_from(LABELS), st.sampled_from(LABELS)), min_size=2, max_size=80))
def test_kappa_is_scikit_learns(pairs):
    from sklearn.metrics import cohen_kappa_score

    found = compute_kappa(pairs)
    if len({name for pair in pairs for name in pair}) == 1:
        assert found.value is None  # both always say the same one word: nothing beyond chance can be seen
        return
    first, second = zip(*pairs, strict=True)
    assert found.value == pytest.approx(cohen_kappa_score(first, second))
    assert -1 <= found.low <= found.value <= found.high <= 1


def test_the_analytic_interval_is_close_to_a_bootstrap():
    pairs = pairs_of(TABLES[0])
    random.seed(7)
    values = sorted(compute_kappa(random.choices(pairs, k=len(pairs))).value for _ in range(1000))
    found = compute_kappa(pairs)
    assert found.low == pytest.approx(values[25], abs=0.03)
    assert found.high == pytest.approx(values[975], abs=0.03)


@pytest.mark.parametrize(
    ("hits", "total", "low", "high"),
    [(81, 263, 0.2553, 0.3662), (0, 20, 0.0, 0.1611), (20, 20, 0.8389, 1.0)],  # the first as in Newcombe 1998, table I
)
def test_wilson(hits, total, low, high):
    found = compute_wilson(hits, total)
    assert (found.value, found.low, found.high) == (
        pytest.approx(hits / total),
        pytest.approx(low, abs=1e-4),
        pytest.approx(high, abs=1e-4),
    )


def test_label_by_label():
    found = compute_agreement(
        [("dependency", "dependency")] * 3 + [("dependency", "other")] + [("other", "other")] * 4, LABELS
    )
    assert (found.reports, found.same) == (8, 7)
    assert found.confusion["dependency"]["other"] == 1
    by_name = {row.label: row for row in found.labels}
    dependency = by_name["dependency"]
    assert (dependency.first, dependency.second, dependency.both) == (4, 3, 3)
    assert dependency.specific == pytest.approx(6 / 7)
    assert dependency.kappa.value == pytest.approx(0.75)
    assert by_name["message-logic"].specific is None


def test_nothing_read_twice():
    found = compute_agreement([], LABELS)
    assert (found.reports, found.share.value, found.kappa.value) == (0, None, None)


def test_the_corpus_agreed_as_its_card_says():
    found = compute_agreement([label.annotators[:2] for label in read_labels() if len(label.annotators) > 1], LABELS)
    assert (found.reports, found.same) == (630, 602)
    assert 0.9 < found.kappa.value < 0.97
