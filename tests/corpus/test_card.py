"""The corpus's card in DATA.md tells the truth about labels.jsonl."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest
from rosimpact.corpus.report import LABELS, PHASES, Label, find_repository, read_labels
from rosimpact.corpus.splits import make_grouped_folds
from rosimpact.corpus.stats import compute_stats

TEXT = (Path(__file__).parents[2] / "DATA.md").read_text(encoding="utf-8")
CARD = TEXT[TEXT.index("\n# The corpus of bug reports\n") :]
WORDS = " ".join(CARD.split())
ROWS = read_labels()
STATS = compute_stats(ROWS)


def test_the_parts_of_a_dataset_card_are_there():
    for part in (
        "Dataset description", "Dataset structure", "Data fields", "Composition", "Data splits", "Dataset creation",
        "Source data", "Annotations", "Personal and sensitive information", "Discussion of biases",
        "Licensing and attribution",
    ):  # fmt: skip
        assert re.search(rf"^##+ {part}$", CARD, re.MULTILINE), part


@pytest.mark.parametrize("field", Label.__struct_fields__)
def test_every_field_is_explained(field):
    assert f"\n| `{field}` | " in CARD


@pytest.mark.parametrize("label", LABELS)
def test_numbers_of_labels_and_kinds(label):
    kinds = ", ".join(f"`{kind}` {count}" for kind, count in STATS.kinds.get(label, {}).items())
    assert f"| `{label}` | {STATS.labels[label]} | {kinds}".rstrip() in CARD


@pytest.mark.parametrize("phase", PHASES)
def test_numbers_of_phases(phase):
    assert f"| `{phase}` | {sum(STATS.phases[phase].values())} |" in CARD


def test_how_many_from_where():
    repositories = [find_repository(row.id) for row in ROWS]
    sites = Counter(row.id.partition(":")[0] for row, name in zip(ROWS, repositories, strict=True) if not name)
    assert f"**{len(ROWS):,} bug reports" in CARD
    assert f"{sum(map(bool, repositories)):,} reports are from {len(set(repositories) - {''})} repositories" in WORDS
    assert f"{sites['ros-answers']} from ROS Answers, {sites['robotics-se']} from Robotics Stack Exchange" in WORDS


def test_how_they_were_decided():
    decided = {name: sum(counts.values()) for name, counts in STATS.decided.items()}
    changed = sum(row.decided == "recheck" and row.label not in row.annotators for row in ROWS)
    assert f"(`adjudicated`, {decided['adjudicated']})" in WORDS
    assert f"{decided['recheck']} on which they had agreed were read once more (`recheck`), and {changed} of" in WORDS
    assert f"read the other {decided['single']:,} (`single`)" in WORDS


def test_how_far_they_agreed():
    found = STATS.agreement
    share, kappa = found.share, found.kappa
    assert f"On these {found.reports} the annotators gave the same label {found.same} times" in WORDS
    assert f"{100 * share.value:.1f} % ({100 * share.low:.1f} to {100 * share.high:.1f})" in WORDS
    assert f"Cohen's kappa {kappa.value:.2f} ({kappa.low:.2f} to {kappa.high:.2f})" in WORDS


def test_the_recommended_folds():
    folds = make_grouped_folds([row.id for row in ROWS], [row.label for row in ROWS])
    sizes = Counter(folds).values()
    rare = Counter(fold for fold, row in zip(folds, ROWS, strict=True) if row.label == "message-logic").values()
    assert f"{min(sizes)} to {max(sizes)} reports in a fold" in WORDS
    assert f"{min(rare)} or {max(rare)} of `message-logic`" in WORDS
