"""Training: labelled reports to a model; the same reports give the same model.

One linear model (logistic regression) reads the words of all views and the signs. Probabilities are calibrated, and the
point below which the model abstains is chosen, on reports of repositories that the model in question has not seen.
"""

from __future__ import annotations

import hashlib
import re
import warnings
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.sparse import csr_matrix, hstack
from sklearn.decomposition import TruncatedSVD
from sklearn.linear_model import LogisticRegression
from sklearn.model_selection import StratifiedGroupKFold

from ..corpus.report import LABELS, BugReport, CorpusError, read_labels
from ..corpus.store import open_reports
from .features import Counts, Signs, Words, count
from .model import FORMAT, ClassifierError, Model, compute_softmax, pack_json, pack_lines
from .reading import VIEWS, ReportReading, read
from .signs import DIGEST

FEWEST = 8
"""Reports that each label in use needs."""
DIMENSIONS = 48
"""Of the space in which the nearest reports are sought."""
SEED = 20
INNER_FOLDS = 5
ANSWERED = 0.65
RIGHT = 0.90
"""The shares of reports that are answered, and of answers that are right, from which abstaining is chosen."""

Progress = Callable[[str, int, int], None]
_DAY = re.compile(r"\d{4}-\d\d-\d\d\Z")


class Example(NamedTuple):
    """A report and its label. twice: whether two annotators read it."""

    report: BugReport
    label: str
    twice: bool


class Examples(NamedTuple):
    """Labelled reports in the order of their ids, and what is counted of them, a row a report."""

    rows: list[Example]
    counts: Counts

    def select_rows(self, rows: np.ndarray) -> Examples:
        """Some of them."""
        return Examples([self.rows[row] for row in rows], self.counts.select_rows(rows))

    @property
    def labels(self) -> np.ndarray:
        """The true labels."""
        return np.array([example.label for example in self.rows])

    @property
    def groups(self) -> np.ndarray:
        """The repositories."""
        return np.array([example.report.group for example in self.rows])


class Settings(NamedTuple):
    """What is learnt from; changed for ablations only."""

    views: tuple[str, ...] = tuple(VIEWS)
    signs: bool = True
    strength: float = 3.0


EVERYTHING = Settings()


class Linear(NamedTuple):
    """A fitted linear model. words and signs turn counts into the columns of coefficients (labels by columns)."""

    labels: tuple[str, ...]
    words: dict[str, Words]
    signs: Signs | None
    coefficients: np.ndarray
    intercept: np.ndarray

    def compute_scores(self, counts: Counts) -> np.ndarray:
        """One row a report, one column a label."""
        return np.asarray(_build_matrix(self.words, self.signs, counts) @ self.coefficients.T) + self.intercept


def read_examples(labels: Path, reports: Path, progress: Progress | None = None) -> Examples:
    """Reads labelled reports and counts what stands in them. Raises ClassifierError when there are too few."""
    try:
        known = {label.id: label for label in read_labels(labels)}
        texts = {report.id: report for report in open_reports(reports) if report.id in known}
    except CorpusError as error:
        raise ClassifierError(str(error)) from None
    if not known:
        raise ClassifierError(f"{labels}: holds no labels; give a file that does")
    found = [Example(texts[id], known[id].label, known[id].twice) for id in sorted(texts)]
    if not found:
        raise ClassifierError(
            f"{reports}: holds none of the {len(known):,} reports labelled in {labels}; "
            "gather them with `rosimpact corpus hydrate`, or give the file that belongs to these labels"
        )
    counts = Counter(example.label for example in found)
    few = [label for label, count in counts.items() if count < FEWEST]
    if len(counts) < 2 or few:
        say = ", ".join(f"{label} {counts[label]}" for label in LABELS if counts[label])
        raise ClassifierError(
            f"{labels}: too few labelled reports with texts ({say}); every label in use needs {FEWEST}, and there must "
            "be two labels: label more, or leave the rare label out"
        )
    if len({example.report.group for example in found}) < 2:
        raise ClassifierError(
            f"{reports}: all reports are of one repository; without a second one nothing can be calibrated: add one"
        )

    def iterate_readings() -> Iterator[ReportReading]:
        for number, example in enumerate(found, 1):
            yield read(example.report.title, example.report.body)
            if progress:
                progress("reading reports", number, len(found))

    return Examples(found, count(iterate_readings(), [example.report.group for example in found]))


def compute_digests(found: Sequence[Example]) -> dict[str, str]:
    """SHA-256 of the labels and of the texts that were learnt from."""
    labels, texts = hashlib.sha256(), hashlib.sha256()
    for example in found:
        report = example.report
        labels.update(f"{report.id}\t{example.label}\n".encode())
        texts.update(f"{report.id}\t{report.title}\t{report.body}\n".encode("utf-8", "surrogatepass"))
    return {"labels_digest": labels.hexdigest(), "texts_digest": texts.hexdigest()}


def make_splits(found: Examples, folds: int, seed: int) -> list[tuple[np.ndarray, np.ndarray]]:
    """Grouped by repository and stratified by label: pairs of rows to learn from and rows to judge."""
    folds = max(2, min(folds, len(set(found.groups))))
    splitter = StratifiedGroupKFold(folds, shuffle=True, random_state=seed)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # a label with fewer reports than folds is split as well as can be
        return list(splitter.split(np.zeros(len(found.rows)), found.labels, found.groups))


def fit(found: Examples, settings: Settings = EVERYTHING) -> Linear:
    """Fits the linear model. Raises ClassifierError when only one label is left."""
    words = {view: Words(view).fit(found.counts) for view in settings.views}
    signs = Signs().fit(found.counts) if settings.signs else None
    rows = _build_matrix(words, signs, found.counts)
    labels = found.labels
    present = tuple(label for label in LABELS if label in set(labels))
    if len(present) < 2:
        raise ClassifierError("only one label is left to learn from in one part of the reports; label more")
    regression: Any = LogisticRegression(C=settings.strength, class_weight="balanced", max_iter=2_000)
    regression.fit(rows, labels)
    order = [list(regression.classes_).index(label) for label in present]
    coefficients, intercept = regression.coef_, regression.intercept_
    if len(present) == 2:
        coefficients, intercept = (
            np.vstack([-coefficients, coefficients]) / 2,
            np.array([-intercept[0], intercept[0]]) / 2,
        )
    return Linear(present, words, signs, coefficients[order], intercept[order])


class Calibration(NamedTuple):
    """temperature divides the scores; below threshold, a probability, the model abstains."""

    temperature: float
    threshold: float


def calibrate(
    found: Examples,
    settings: Settings = EVERYTHING,
    seed: int = SEED,
    step: Callable[[], None] = lambda: None,
) -> Calibration:
    """Calibration by grouped cross-validation inside the given reports.

    The temperature is the likeliest one. The threshold is the lowest at which 90 in 100 answers are right, or the one
    that answers 65 in 100 if that is lower.
    """
    present = tuple(label for label in LABELS if label in set(found.labels))
    scores = np.full((len(found.rows), len(present)), -30.0)
    for learn, judge in make_splits(found, INNER_FOLDS, seed):
        model = fit(found.select_rows(learn), settings)
        part = model.compute_scores(found.counts.select_rows(judge))
        scores[np.ix_(judge, np.array([present.index(label) for label in model.labels]))] = part
        step()
    truth = np.array([present.index(label) for label in found.labels])

    def compute_loss(logarithm: float) -> float:
        chances = compute_softmax(scores / np.exp(logarithm))[np.arange(len(truth)), truth]
        return float(-np.log(np.maximum(chances, 1e-12)).mean())

    best: Any = minimize_scalar(compute_loss, bounds=(-2.0, 2.0), method="bounded")
    temperature = float(np.exp(best.x))
    chances = compute_softmax(scores / temperature)
    sure = chances.max(axis=1)
    right = chances.argmax(axis=1) == truth
    order = np.argsort(-sure, kind="stable")
    precision = np.cumsum(right[order]) / np.arange(1, len(order) + 1)
    good = np.flatnonzero(precision >= RIGHT)
    quantile = float(np.quantile(sure, 1 - ANSWERED))
    threshold = min(quantile, float(sure[order[good[-1]]])) if len(good) else quantile
    # Rounded down: a model that is sure of everything would abstain from everything otherwise.
    return Calibration(round(temperature, 6), float(np.floor(threshold * 1e6 - 1) / 1e6))


def train(found: Examples, seed: int = SEED, progress: Progress | None = None) -> Model:
    """A model of all the reports given. Raises ClassifierError."""
    done = [0]

    def report_step() -> None:
        done[0] += 1
        if progress:
            progress("fitting", done[0], INNER_FOLDS + 1)

    calibration = calibrate(found, seed=seed, step=report_step)
    linear = fit(found)
    report_step()
    words = np.concatenate([_get_idf(linear.words[view]) for view in VIEWS])
    assert linear.signs is not None
    rows = _build_matrix(linear.words, None, found.counts)
    columns = len(words)
    size = max(2, min(DIMENSIONS, columns - 1, len(found.rows) - 1))
    if columns > size:
        space: Any = TruncatedSVD(size, random_state=seed)
        basis = np.asarray(space.fit(rows).components_).T
    else:
        basis = np.eye(columns)
    vectors = np.asarray(rows @ basis)
    vectors /= np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-9)
    import sklearn

    from . import __version__

    about = {
        "format": FORMAT,
        "signs": DIGEST,
        "rosimpact": __version__,
        "scikit-learn": sklearn.__version__,
        "labels": list(linear.labels),
        "temperature": calibration.temperature,
        "threshold": calibration.threshold,
        "seed": seed,
        "reports": len(found.rows),
        "newest": max((date for example in found.rows if _DAY.match(date := example.report.date or "")), default=""),
        **compute_digests(found.rows),
    }
    arrays = {
        "about": pack_json(about),
        "coefficients": linear.coefficients.astype(np.float32),
        "intercept": linear.intercept,
        "weights": words.astype(np.float32),
        "sign means": np.asarray(linear.signs.scaler_.mean_),
        "sign scales": np.asarray(linear.signs.scaler_.scale_),
        "projection": basis.astype(np.float16),
        "vectors": vectors.astype(np.float16),
        "known": pack_json([[example.report.id, example.report.url, example.label] for example in found.rows]),
    }
    for view in VIEWS:
        arrays[f"vocabulary {view}"] = pack_lines(linear.words[view].vocabulary_)
    return Model(arrays)


def _get_idf(words: Words) -> np.ndarray:
    return np.asarray(words.weights_.idf_) if words.vocabulary_ else np.zeros(0)


def _build_matrix(words: dict[str, Words], signs: Signs | None, counts: Counts) -> csr_matrix:
    parts = [VIEWS[view].weight * words[view].transform(counts) for view in words]
    if signs is not None:
        parts.append(csr_matrix(signs.transform(counts)))
    return csr_matrix(hstack(parts))
