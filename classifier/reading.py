"""One report as the classifier reads it: its n-grams, view by view, and its signs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from typing import NamedTuple

from .signs import measure_signs
from .text import list_general_words, list_letter_runs, list_plain_words, make_n_grams, split_parts

TITLE, BEGINNING = 250, 1_500
"""Characters of title and body that are read letter by letter."""


class ReportView(NamedTuple):
    """One way to read a report: which text, as which words, in runs of how many at most, with which weight.

    shown: how it is called where a word is shown to a person; empty for what would tell a person nothing. rare: how
    many times more reports than others its n-grams must stand in. most: words that are read.
    """

    words: Callable[[str], list[str]]
    part: str
    longest: int
    weight: float
    shown: str
    rare: int = 1
    most: int = 1_000


VIEWS = {
    "title": ReportView(list_plain_words, "title", 2, 0.7, "title"),
    "prose": ReportView(list_plain_words, "text", 2, 1.0, "text"),
    "errors": ReportView(list_plain_words, "errors", 2, 0.6, "log"),
    "title-general": ReportView(list_general_words, "title", 3, 0.7, "title"),
    "prose-general": ReportView(list_general_words, "text", 3, 1.0, "text"),
    "errors-general": ReportView(list_general_words, "errors", 2, 0.6, "log"),
    "letters": ReportView(list_letter_runs, "whole", 1, 1.0, "", rare=2, most=10_000),
}
"""Names of the views, which the model file uses too."""


class ReportReading(NamedTuple):
    """What is known of a report: how often each n-gram stands in each view, and the strength of each sign."""

    grams: dict[str, Counter[str]]
    signs: list[float]


def read(title: str, body: str) -> ReportReading:
    """Reads a report; any text will do."""
    parts = split_parts(title, body)
    texts = {
        "title": parts.title,
        "text": f"{parts.title}\n{parts.prose}",
        "errors": parts.errors,
        # The title counts twice.
        "whole": f"{title[:TITLE]} . {title[:TITLE]} . {body[:BEGINNING]}",
    }
    words = {name: view.words(texts[view.part])[: view.most] for name, view in VIEWS.items()}
    grams = {name: Counter(make_n_grams(words[name], view.longest)) for name, view in VIEWS.items()}
    return ReportReading(grams, measure_signs(parts, words["prose-general"]))
