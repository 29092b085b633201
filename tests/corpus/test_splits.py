"""Splits of the corpus: by repository and by time."""

from __future__ import annotations

from collections import Counter

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.corpus.report import LABELS, find_group, read_labels
from rosimpact.corpus.splits import make_grouped_folds, make_grouped_splits, make_time_split, parse_day, select_unseen

IDS = st.builds(lambda repo, number: f"acme/r{repo}#{number}", st.integers(0, 12), st.integers(1, 9))


@given(st.lists(st.tuples(IDS, st.sampled_from(LABELS)), min_size=1, max_size=60), st.integers(2, 4))
def test_no_repository_on_both_sides_and_every_row_tested_once(rows, folds):
    ids, labels = [id for id, _ in rows], [label for _, label in rows]
    if len({find_group(id) for id in ids}) < folds:
        with pytest.raises(ValueError, match="groups"):
            make_grouped_splits(ids, labels, folds)
        return
    splits = make_grouped_splits(ids, labels, folds)
    assert sorted(i for split in splits for i in split.test) == list(range(len(rows)))
    for split in splits:
        assert sorted(split.train + split.test) == list(range(len(rows)))
        assert select_unseen(ids, split) == split.test != []


def test_the_corpus_is_split_evenly_and_the_same_each_time():
    rows = read_labels()
    ids, labels = [row.id for row in rows], [row.label for row in rows]
    folds = make_grouped_folds(ids, labels)
    assert folds == make_grouped_folds(ids, labels)
    assert folds != make_grouped_folds(ids, labels, seed=1)
    for name in LABELS:
        found = Counter(fold for fold, label in zip(folds, labels, strict=True) if label == name)
        even = sum(found.values()) / 5
        assert all(abs(found[fold] - even) <= max(2, 0.1 * even) for fold in range(5)), (name, found)


def test_the_order_of_rows_does_not_matter():
    rows = read_labels()
    ids, labels = [row.id for row in rows], [row.label for row in rows]
    forward = dict(zip(ids, make_grouped_folds(ids, labels), strict=True))
    assert dict(zip(ids[::-1], make_grouped_folds(ids[::-1], labels[::-1]), strict=True)) == forward


def test_repositories_are_compared_as_github_does():
    assert find_group("Acme/Arm#1") == find_group("acme/arm#2")
    assert find_group("ros-answers:1") != find_group("ros-answers:2")


def test_by_time():
    ids = ["a/b#1", "a/b#2", "c/d#3", "e/f#4", "g/h#5"]
    dates = ["2020-01-01", "2021-06-01", "2021-06-02", None, "Jul 3, 2013"]
    split = make_time_split(ids, dates, "2021-06-01")
    assert split == ([0, 4], [1, 2])
    assert select_unseen(ids, split) == [2]


def test_lists_of_different_length_are_refused():
    with pytest.raises(ValueError, match="one label for each"):
        make_grouped_folds(["a/b#1"], [])
    with pytest.raises(ValueError, match="one date"):
        make_time_split(["a/b#1"], [], "2020-01-01")


@pytest.mark.parametrize(
    ("date", "day"),
    [
        ("2019-03-10", "2019-03-10"),
        ("2019-03-10T21:33:53Z", "2019-03-10"),
        ("Mar 10, 2019", "2019-03-10"),
        ("Mar 5, 2019", "2019-03-05"),
        (None, ""),
        ("", ""),
        ("yesterday", ""),
        ("2019", ""),
    ],
)
def test_days(date, day):
    assert parse_day(date) == day
