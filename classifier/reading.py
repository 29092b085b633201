"""One report as the classifier reads it: its n-grams, view by view, and its signs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from typing import NamedTuple

from .signs import signs_of
from .text import general_words, n_grams, parts_of, plain_words

LONGEST_VIEW = 1_000
"""Words of a view that are read."""


class View(NamedTuple):
    """One way to read a report: which text, as which words, in runs of how many at most, with which weight.

    shown: how it is called where a word is shown to a person.
    """

    words: Callable[[str], list[str]]
    part: str
    longest: int
    weight: float
    shown: str


VIEWS = {
    "title": View(plain_words, "title", 2, 0.7, "title"),
    "prose": View(plain_words, "text", 2, 1.0, "text"),
    "errors": View(plain_words, "errors", 2, 0.6, "log"),
    "title-general": View(general_words, "title", 3, 0.7, "title"),
    "prose-general": View(general_words, "text", 3, 1.0, "text"),
    "errors-general": View(general_words, "errors", 2, 0.6, "log"),
}
"""Names of the views, which the model file uses too."""


class Reading(NamedTuple):
    """What is known of a report: how often each n-gram stands in each view, and the strength of each sign."""

    grams: dict[str, Counter[str]]
    signs: list[float]


def read(title: str, body: str) -> Reading:
    """Reads a report; any text will do."""
    parts = parts_of(title, body)
    texts = {"title": parts.title, "text": f"{parts.title}\n{parts.prose}", "errors": parts.errors}
    words = {name: view.words(texts[view.part])[:LONGEST_VIEW] for name, view in VIEWS.items()}
    grams = {name: Counter(n_grams(words[name], view.longest)) for name, view in VIEWS.items()}
    return Reading(grams, signs_of(parts, words["prose-general"]))


def read_reason(why: str) -> dict[str, Counter[str]]:
    """The n-grams of an annotator's reason, as if it were title and text of a report."""
    return {
        name: Counter(n_grams(view.words(why), view.longest)) if view.part != "errors" else Counter()
        for name, view in VIEWS.items()
    }
