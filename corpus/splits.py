"""Splits of the corpus: folds grouped by repository, and a split by time. The same input gives the same split.

No repository stands on both sides, since reports of one project share words, people and faults. Reports that belong to
no repository are groups of their own. These are for comparing systems on the corpus: nothing but ids, labels and this
file decides them. The classifier is measured on folds that scikit-learn draws, as its other uses of folds are.
"""

from __future__ import annotations

import random
from collections import Counter, defaultdict
from collections.abc import Sequence
from typing import NamedTuple

from .report import find_group

FOLDS = 5
SEED = 20260822


class TrainTestSplit(NamedTuple):
    """Places of the rows to train on and to test on, each rising."""

    train: list[int]
    test: list[int]


def make_grouped_folds(ids: Sequence[str], labels: Sequence[str], folds: int = FOLDS, seed: int = SEED) -> list[int]:
    """The fold of each row, 0 to folds - 1: no group in two folds, and in each about the same number of every label.

    ids, labels: of the rows, equally long. Large groups are placed first, each where the labels come out most even;
    the seed decides between equals. Raises ValueError when there are fewer groups than folds.
    """
    if len(ids) != len(labels):
        raise ValueError(f"{len(ids)} ids and {len(labels)} labels; give one label for each id")
    content: dict[str, Counter[str]] = defaultdict(Counter)
    for id, label in zip(ids, labels, strict=True):
        content[find_group(id)][label] += 1
    if folds < 2 or len(content) < folds:
        raise ValueError(f"{folds} folds of {len(content)} groups; give 2 to {len(content)}")
    total = Counter(labels)
    groups = sorted(content)
    random.Random(seed).shuffle(groups)
    groups.sort(key=lambda group: -sum(content[group].values()))
    filled = [Counter[str]() for _ in range(folds)]
    fold_of: dict[str, int] = {}
    for group in groups:

        def compute_unevenness(fold: int, added: Counter[str] = content[group]) -> tuple[float, int]:
            # What the fold gains in squared shares of each label: rare labels weigh as much as common ones.
            gain = sum(((filled[fold][x] + n) ** 2 - filled[fold][x] ** 2) / total[x] ** 2 for x, n in added.items())
            return gain, sum(filled[fold].values())

        fold = min(range(folds), key=compute_unevenness)
        filled[fold].update(content[group])
        fold_of[group] = fold
    return [fold_of[find_group(id)] for id in ids]


def make_grouped_splits(
    ids: Sequence[str], labels: Sequence[str], folds: int = FOLDS, seed: int = SEED
) -> list[TrainTestSplit]:
    """The splits of grouped_folds: each fold once as the test side."""
    fold_of = make_grouped_folds(ids, labels, folds, seed)
    return [
        TrainTestSplit([i for i, f in enumerate(fold_of) if f != fold], [i for i, f in enumerate(fold_of) if f == fold])
        for fold in range(folds)
    ]


def make_time_split(ids: Sequence[str], dates: Sequence[str | None], first_test_day: str) -> TrainTestSplit:
    """Rows before a day to train on, rows from that day on to test on.

    dates: as day_of reads them; rows without one are on neither side. first_test_day: an ISO day. The test side keeps
    reports of repositories that the train side knows, since that is how a classifier is used; `unseen` has the others.
    Raises ValueError when the lists differ in length.
    """
    if len(ids) != len(dates):
        raise ValueError(f"{len(ids)} ids and {len(dates)} dates; give one date, or None, for each id")
    dated = [(i, day) for i, date in enumerate(dates) if (day := parse_day(date))]
    return TrainTestSplit(
        [i for i, day in dated if day < first_test_day], [i for i, day in dated if day >= first_test_day]
    )


def parse_day(date: str | None) -> str:
    """The ISO day of a date, written as `2019-03-10`, with or without a time, or as `Mar 10, 2019`; else empty."""
    from datetime import datetime

    for text, form in (((date or "")[:10], "%Y-%m-%d"), ((date or "").strip(), "%b %d, %Y")):
        try:
            return datetime.strptime(text, form).date().isoformat()
        except ValueError:
            continue
    return ""


def select_unseen(ids: Sequence[str], split: TrainTestSplit) -> list[int]:
    """The rows of a split's test side whose group is not on its train side."""
    seen = {find_group(ids[i]) for i in split.train}
    return [i for i in split.test if find_group(ids[i]) not in seen]
