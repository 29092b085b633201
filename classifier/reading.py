"""One report as the classifier reads it: its n-grams, view by view, and its signs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from typing import NamedTuple

from .signs import signs_of
from .text import general_words, letters, n_grams, parts_of, plain_words

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
    "title": ReportView(plain_words, "title", 2, 0.7, "title"),
    "prose": ReportView(plain_words, "text", 2, 1.0, "text"),
    "errors": ReportView(plain_words, "errors", 2, 0.6, "log"),
    "title-general": ReportView(general_words, "title", 3, 0.7, "title"),
    "prose-general": ReportView(general_words, "text", 3, 1.0, "text"),
    "errors-general": ReportView(general_words, "errors", 2, 0.6, "log"),
    "letters": ReportView(letters, "whole", 1, 1.0, "", rare=2, most=10_000),
}
"""Names of the views, which the model file uses too."""


class ReportReading(NamedTuple):
    """What is known of a report: how often each n-gram stands in each view, and the strength of each sign."""

    grams: dict[str, Counter[str]]
    signs: list[float]


def read(title: str, body: str) -> ReportReading:
    """Reads a report; any text will do."""
    parts = parts_of(title, body)
    texts = {
        "title": parts.title,
        "text": f"{parts.title}\n{parts.prose}",
        "errors": parts.errors,
        # The title counts twice.
        "whole": f"{title[:TITLE]} . {title[:TITLE]} . {body[:BEGINNING]}",
    }
    words = {name: view.words(texts[view.part])[: view.most] for name, view in VIEWS.items()}
    grams = {name: Counter(n_grams(words[name], view.longest)) for name, view in VIEWS.items()}
    return ReportReading(grams, signs_of(parts, words["prose-general"]))
