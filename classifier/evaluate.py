"""How good the classifier is: grouped cross-validation, intervals, calibration, risk and coverage, and rivals.

No repository stands on both sides of a split. Whatever is chosen, temperature and threshold too, is chosen without the
reports that are judged. Intervals are bootstrapped over repositories, since reports of one are alike.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from ..corpus.report import LABELS
from .model import compute_softmax
from .reading import VIEWS
from .training import EVERYTHING, SEED, Examples, Progress, Settings, calibrate, compute_digests, fit, make_splits

FOLDS = 10
BINS = 15
RESAMPLES = 1_000
COVERAGES = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)

WHOLE = "words and signs, nothing left out"
ABLATIONS: dict[str, Settings] = {
    "without letters": Settings(views=tuple(view for view in VIEWS if view != "letters")),
    "without signs": Settings(signs=False),
    "without generalised words": Settings(views=("title", "prose", "errors", "letters")),
    "without plain words": Settings(views=("title-general", "prose-general", "errors-general", "letters")),
    "without error lines": Settings(views=("title", "prose", "title-general", "prose-general", "letters")),
    "title words and signs only": Settings(views=("title", "title-general")),
}

_KEYWORDS = (
    ("dependency", r"depend|package\.xml|rosdep|unable to locate|no module named|could not find a package"),
    (
        "library-update",
        r"deprecat|upgrad|undefined symbol|noetic|python ?3|no longer compiles|c\+\+1[147]|opencv ?[34]",
    ),
    ("inconsistency", r"frame_id|time ?stamp|md5|mismatch|qos|encoding|wrong unit|\bnan\b|tf tree"),
    (
        "message-logic",
        r"latch|publish(?:es|ed|ing)? (?:only|when|once)|no longer publish|stops publishing|publish rate",
    ),
)


class Predictions(NamedTuple):
    """What a model predicts for each report that had not seen its repository. chances: reports by LABELS."""

    chances: np.ndarray
    abstained: np.ndarray


class Score(NamedTuple):
    """A number with its 95 % interval."""

    value: float
    low: float
    high: float


def predict_out_of_fold(
    found: Examples, settings: Settings = EVERYTHING, *, calibrated: bool, seed: int = SEED,
    progress: Progress | None = None, name: str = "",
) -> Predictions:  # fmt: skip
    """Judges every report by a model trained on other repositories. calibrated: in each fold, which takes longer."""
    chances = np.zeros((len(found.rows), len(LABELS)))
    abstained = np.zeros(len(found.rows), bool)
    parts = make_splits(found, FOLDS, seed)
    for number, (learn, judge) in enumerate(parts, 1):
        seen = found.select_rows(learn)
        calibration = calibrate(seen, settings, seed) if calibrated else None
        model = fit(seen, settings)
        scores = model.compute_scores(found.counts.select_rows(judge))
        part = compute_softmax(scores / (calibration.temperature if calibration else 1.0))
        chances[np.ix_(judge, np.array([LABELS.index(label) for label in model.labels]))] = part
        if calibration:
            abstained[judge] = part.max(axis=1) < calibration.threshold
        if progress:
            progress(name or "cross-validation", number, len(parts))
    return Predictions(chances, abstained)


def judge_by_rivals(found: Examples, seed: int = SEED, progress: Progress | None = None) -> dict[str, np.ndarray]:
    """What simpler means say of each report, on the same splits: name to places in LABELS."""
    from sklearn.feature_extraction.text import TfidfVectorizer
    from sklearn.linear_model import LogisticRegression

    texts = [f"{example.report.title}\n{example.report.body}" for example in found.rows]
    truth = list_truths(found)
    said = {name: np.zeros(len(texts), int) for name in ("majority", "keyword rule", "nearest neighbours (10)")}
    said["plain TF-IDF with logistic regression"] = np.zeros(len(texts), int)
    rules = [(LABELS.index(label), re.compile(pattern, re.IGNORECASE)) for label, pattern in _KEYWORDS]
    for row, text in enumerate(texts):
        hits = (place for place, pattern in rules if pattern.search(text))
        said["keyword rule"][row] = next(hits, LABELS.index("other"))
    parts = make_splits(found, FOLDS, seed)
    for number, (learn, judge) in enumerate(parts, 1):
        said["majority"][judge] = np.bincount(truth[learn]).argmax()
        vectoriser = TfidfVectorizer(sublinear_tf=True, min_df=2, ngram_range=(1, 2))
        rows = vectoriser.fit_transform([texts[row] for row in learn])
        asked = vectoriser.transform([texts[row] for row in judge])
        regression = LogisticRegression(C=10, class_weight="balanced", max_iter=1_000).fit(rows, truth[learn])
        said["plain TF-IDF with logistic regression"][judge] = regression.predict(asked)
        likeness = np.asarray((asked @ rows.T).todense())
        for row, near in zip(judge, np.argsort(-likeness, axis=1, kind="stable")[:, :10], strict=True):
            votes = np.bincount(truth[learn][near], weights=likeness[np.searchsorted(judge, row)][near], minlength=5)
            said["nearest neighbours (10)"][row] = votes.argmax()
        if progress:
            progress("rivals", number, len(parts))
    return said


def list_truths(found: Examples) -> np.ndarray:
    """The places of the true labels in LABELS."""
    return np.array([LABELS.index(label) for label in found.labels])


def compute_f1(truth: np.ndarray, said: np.ndarray) -> np.ndarray:
    """F1 of each of LABELS; not a number where a label is neither true nor said."""
    size = len(LABELS)
    table = np.bincount(truth * size + said, minlength=size * size).reshape(size, size)
    total = table.sum(axis=0) + table.sum(axis=1)
    with np.errstate(invalid="ignore"):
        return np.where(total > 0, 2 * np.diag(table) / np.maximum(total, 1), np.nan)


def average_f1(truth: np.ndarray, said: np.ndarray) -> float:
    """The mean of F1 over the labels that are there."""
    return float(np.nanmean(compute_f1(truth, said)))


def estimate_interval(
    number: Callable[[np.ndarray, np.ndarray], float], truth: np.ndarray, said: np.ndarray,
    groups: Sequence[str] | np.ndarray, seed: int = SEED, resamples: int = RESAMPLES,
) -> Score:  # fmt: skip
    """A number and its 95 % interval, bootstrapped over groups."""
    _, codes = np.unique(np.array(groups), return_inverse=True)
    members = [np.flatnonzero(codes == code) for code in range(codes.max() + 1)]
    source = np.random.default_rng(seed)
    values: list[float] = []
    for _ in range(resamples):
        rows = np.concatenate([members[code] for code in source.integers(0, len(members), len(members))])
        values.append(number(truth[rows], said[rows]))
    low, high = np.nanquantile(values, (0.025, 0.975))
    return Score(number(truth, said), float(low), float(high))


def compute_calibration_error(sure: np.ndarray, right: np.ndarray, bins: int = BINS) -> float:
    """Expected calibration error of the likeliest label, with bins of equal mass."""
    order = np.argsort(sure, kind="stable")
    parts = np.array_split(order, min(bins, len(order)))
    return float(sum(abs(sure[part].mean() - right[part].mean()) * len(part) for part in parts) / len(order))


def evaluate(
    found: Examples, *, seed: int = SEED, resamples: int = RESAMPLES, ablations: bool = True,
    progress: Progress | None = None,
) -> dict:  # fmt: skip
    """All the numbers, as JSON takes them. progress: called with what is done, how many of how many."""
    predicted = predict_out_of_fold(found, calibrated=True, seed=seed, progress=progress)
    truth, said = list_truths(found), predicted.chances.argmax(axis=1)
    groups, reports = found.groups, [example.report for example in found.rows]
    sure, right = predicted.chances.max(axis=1), said == truth

    def score_rows(rows: np.ndarray) -> dict:
        return {
            "reports": int(rows.sum()),
            "macro_f1": estimate_interval(average_f1, truth[rows], said[rows], groups[rows], seed, resamples)._asdict(),
            "right": float(right[rows].mean()),
            "labels": {
                label: {
                    "reports": int((truth[rows] == place).sum()),
                    "f1": estimate_interval(
                        lambda t, s, place=place: float(compute_f1(t, s)[place]), truth[rows], said[rows], groups[rows],
                        seed, resamples,
                    )._asdict(),
                    "precision": _share(truth[rows] == place, said[rows] == place),
                    "recall": _share(said[rows] == place, truth[rows] == place),
                }
                for place, label in enumerate(LABELS)
                if (truth[rows] == place).any()
            },
        }  # fmt: skip

    original = np.array([report.wording == "original" for report in reports])
    subsets = {"all": np.ones(len(reports), bool), "wording original": original, "wording abridged": ~original}
    subsets["read twice, wording original"] = _select_twice_original(found)
    for source in sorted({report.source for report in reports}):
        subsets[f"source {source}"] = np.array([report.source == source for report in reports])
    order = np.argsort(-sure, kind="stable")
    answered = ~predicted.abstained
    result = {
        "reports": len(reports),
        "repositories": len(set(groups)),
        "folds": len(make_splits(found, FOLDS, seed)),
        **compute_digests(found.rows),
        "scores": {name: score_rows(rows) for name, rows in subsets.items() if rows.any()},
        "confusion": np.bincount(truth * len(LABELS) + said, minlength=len(LABELS) ** 2)
        .reshape(len(LABELS), len(LABELS))
        .tolist(),
        "calibration_error": compute_calibration_error(sure, right),
        "risk_coverage": [
            {"answered": share, "right": float(right[order[: max(1, round(share * len(order)))]].mean())}
            for share in COVERAGES
        ],
        "abstaining": {"answered": float(answered.mean()), "right": _share(right, answered)},
    }
    result["beside"] = score_rivals(
        found, predicted, seed=seed, resamples=resamples, ablations=ablations, progress=progress
    )
    return result


def score_rivals(
    found: Examples, predicted: Predictions, *, seed: int = SEED, resamples: int = RESAMPLES, ablations: bool = True,
    progress: Progress | None = None,
) -> dict[str, dict]:  # fmt: skip
    """Scores of simpler means and of the classifier with parts left out, by name, as JSON takes them.

    predicted: what the whole classifier says of the same reports; its own scores stand among the ablations.
    """
    said = judge_by_rivals(found, seed, progress)
    if ablations:
        said[WHOLE] = predicted.chances.argmax(axis=1)
        for name, settings in ABLATIONS.items():
            part = predict_out_of_fold(found, settings, calibrated=False, seed=seed, progress=progress, name=name)
            said[name] = part.chances.argmax(axis=1)
    truth, groups, twice = list_truths(found), found.groups, _select_twice_original(found)
    return {
        name: {
            "macro_f1": estimate_interval(average_f1, truth, answer, groups, seed, resamples)._asdict(),
            "read_twice_original": average_f1(truth[twice], answer[twice]) if twice.any() else None,
            "right": float((answer == truth).mean()),
        }
        for name, answer in said.items()
    }


def _select_twice_original(found: Examples) -> np.ndarray:
    return np.array([example.twice and example.report.wording == "original" for example in found.rows])


def _share(what: np.ndarray, among: np.ndarray) -> float | None:
    return float(what[among].mean()) if among.any() else None


def render_text(result: dict) -> str:
    """The numbers for people."""

    def score(value: dict) -> str:
        return f"{value['value']:.3f} ({value['low']:.3f} to {value['high']:.3f})"

    lines = [
        f"{result['reports']:,} reports of {result['repositories']} repositories, {result['folds']} folds "
        "by repository; 95 % intervals",
        "",
        f"{'':32s} {'reports':>7s}  {'right':>5s}  macro-F1",
    ]
    for name, part in result["scores"].items():
        lines.append(f"{name:32s} {part['reports']:7,d}  {part['right']:5.3f}  {score(part['macro_f1'])}")
    for name in ("all", "read twice, wording original"):
        if name not in result["scores"]:
            continue
        lines += ["", f"{name:32s} {'reports':>7s}  {'precision':>9s}  {'recall':>6s}  F1"]
        for label, row in result["scores"][name]["labels"].items():
            precision = "-" if row["precision"] is None else f"{row['precision']:.3f}"
            lines.append(
                f"  {label:30s} {row['reports']:7,d}  {precision:>9s}  {row['recall']:6.3f}  {score(row['f1'])}"
            )
    lines += ["", "rows are true, columns said: " + ", ".join(LABELS)]
    lines += [
        f"  {label:16s}" + "".join(f"{n:6d}" for n in row)
        for label, row in zip(LABELS, result["confusion"], strict=True)
    ]
    lines += ["", f"calibration error (bins of equal mass): {result['calibration_error']:.3f}"]
    lines.append(
        f"abstaining: answers {100 * result['abstaining']['answered']:.1f} %"
        + (
            f", of which {100 * result['abstaining']['right']:.1f} % are right"
            if result["abstaining"]["right"] is not None
            else ""
        )
    )
    lines += ["", "surest part   right"]
    lines += [f"{100 * row['answered']:9.0f} %   {100 * row['right']:.1f} %" for row in result["risk_coverage"]]
    lines += ["", f"{'beside':40s} {'right':>5s}  {'twice, original':>15s}  macro-F1"]
    for name, row in result["beside"].items():
        second = "-" if row["read_twice_original"] is None else f"{row['read_twice_original']:.3f}"
        lines.append(f"{name:40s} {row['right']:5.3f}  {second:>15s}  {score(row['macro_f1'])}")
    return "\n".join(lines) + "\n"
