"""What the classifier said of each labelled report, as facts that can be shipped: ids, labels and chances, no texts.

`rosimpact study predict` writes two files, from which the study of triage is made where no texts are at hand:
`triage_predictions.jsonl`, a Prediction a line, and `triage_beside.json`, the scores of simpler means and of ablations.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import msgspec

from ..corpus.report import LABELS, LABELS_FILE, SOURCES, WORDINGS, CorpusError, find_group, read_labels
from ..edges.console import run_command, say
from ..edges.documents import load_json
from ..edges.files import read_file, write_file
from ..edges.limits import get_limits

if TYPE_CHECKING:
    from .evaluate import Predictions
    from .training import Example

PREDICTIONS, BESIDE = "triage_predictions.jsonl", "triage_beside.json"
DIGITS = 5
"""Decimals of the shipped probabilities."""


class Prediction(msgspec.Struct, frozen=True):
    """What a model that had not seen the report's repository said of it.

    label: the true one. probabilities: by LABELS, calibrated. abstained: whether the model would not answer. length: of
    title and body, in characters. source, wording, decided: as in Report and Label.
    """

    id: str
    label: str
    probabilities: tuple[float, ...]
    abstained: bool
    length: int
    source: str
    wording: str
    decided: str

    @property
    def group(self) -> str:
        """What must not stand on both sides of a split, as Report has it."""
        return find_group(self.id)

    @property
    def twice(self) -> bool:
        """Whether two annotators read it."""
        return self.decided != "single"


class Measured(NamedTuple):
    """predictions: of all labelled reports with texts. beside: name of another means to its scores, as
    classifier/evaluate.py gives them. digests: SHA-256 of the labels and of the texts that were used."""

    predictions: list[Prediction]
    beside: dict[str, Any]
    digests: dict[str, str]


def run_study(reports: Path, output: Path, quiet: bool = False) -> int:
    """Measures the classifier on the reports' texts and writes both files to a folder. Returns the exit status."""

    def work() -> int:
        found = measure(reports, None if quiet else _make_progress())
        write(found, output)
        say(f"{len(found.predictions):,} predictions and {len(found.beside)} means beside: {output}")
        return 0

    return run_command(work, "interrupted; nothing was written")


def measure(reports: Path, progress: Callable[[str, int, int], None] | None = None) -> Measured:
    """Judges every labelled report out of fold, by the classifier, by simpler means and with parts left out.

    reports: the file that holds the texts. It takes some minutes. Raises CorpusError.
    """
    from . import evaluate as e
    from .model import ClassifierError
    from .training import compute_digests, read_examples

    try:
        found = read_examples(LABELS_FILE, reports, progress)
        predicted = e.predict_out_of_fold(found, calibrated=True, progress=progress)
        others = e.score_rivals(found, predicted, progress=progress)
    except ClassifierError as error:
        raise CorpusError(str(error)) from None
    return Measured(make_predictions(found.rows, predicted), others, compute_digests(found.rows))


def make_predictions(found: Sequence[Example], predicted: Predictions) -> list[Prediction]:
    """The facts of labelled reports and of what was said of them."""
    decided = {label.id: label.decided for label in read_labels()}
    return [
        Prediction(
            example.report.id, example.label, tuple(round(float(chance), DIGITS) for chance in chances), bool(silent),
            len(example.report.title) + len(example.report.body), example.report.source, example.report.wording,
            decided.get(example.report.id, "single"),
        )
        for example, chances, silent in zip(found, predicted.chances, predicted.abstained, strict=True)
    ]  # fmt: skip


def write(found: Measured, folder: Path) -> None:
    """Writes both files; they are replaced only when all is computed."""
    lines = b"".join(msgspec.json.encode(one) + b"\n" for one in found.predictions)
    text = json.dumps({**found.digests, "beside": found.beside}, indent=1) + "\n"
    for name, content in ((PREDICTIONS, lines), (BESIDE, text.encode())):
        write_file(folder / name, content)


def read(folder: Path) -> Measured:
    """What `write` wrote. Raises CorpusError that names the file and line."""
    path = folder / PREDICTIONS
    decoder = msgspec.json.Decoder(Prediction)
    predictions = []
    for number, line in enumerate(_read_bytes(path).splitlines(), 1):
        try:
            one = decoder.decode(line)
        except (msgspec.DecodeError, RecursionError) as error:
            raise CorpusError(f"{path}:{number}: {error}; {_AGAIN}") from None
        known = one.label in LABELS and one.source in SOURCES and one.wording in WORDINGS
        if not known or len(one.probabilities) != len(LABELS):
            raise CorpusError(f"{path}:{number}: `{one.id}` is no prediction of these labels; {_AGAIN}")
        predictions.append(one)
    path = folder / BESIDE
    try:
        about = load_json(_read_bytes(path))
        digests = {name: about[name] for name in ("labels_digest", "texts_digest")}
        return Measured(predictions, about["beside"], digests)
    except (ValueError, KeyError, TypeError) as error:
        raise CorpusError(f"{path}: cannot be read: {error}; {_AGAIN}") from None


_AGAIN = "make it again with `rosimpact study predict`"


def _read_bytes(path: Path) -> bytes:
    try:
        return read_file(path, get_limits().report)
    except OSError as error:
        raise CorpusError(f"{path}: cannot be read: {error.strerror}; {_AGAIN}") from None


def _make_progress() -> Callable[[str, int, int], None]:
    last = ""

    def show(what: str, done: int, total: int) -> None:
        nonlocal last
        if what != last:
            say(f"{what}: {total} steps")
        last = what

    return show
