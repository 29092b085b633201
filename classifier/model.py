"""The trained classifier: a file of plain arrays, and what it says of a report.

The file is NumPy's npz without objects: names, vocabulary, weights and the known reports' vectors. Nothing in it is
code, nothing is unpickled, and scikit-learn, with which it was trained, is not needed to use it; so no version of that
has to match. What has to match are the signs of signs.py and the format: a model for others is refused.
"""

from __future__ import annotations

import io
import json
import zipfile
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..edges.console import UserError
from ..edges.files import open_for_replacing, read_file
from ..edges.limits import format_size, get_limits
from .reading import VIEWS, ReportReading
from .signs import DIGEST, LIMIT, SIGNS

FORMAT = 2
SHIPPED = Path(__file__).parent / "data" / "model.npz"


class ClassifierError(UserError):
    """What was asked for cannot be done; the text names the file or place and what to do."""


class KnownReport(NamedTuple):
    """A known report. likeness: cosine, 1 for the same words."""

    id: str
    url: str
    label: str
    likeness: float


class Reason(NamedTuple):
    """What spoke for the label. where: `title`, `text`, `log` or `sign`. weight: what it added to the label's score
    over the mean of the others."""

    where: str
    what: str
    weight: float


class ModelVerdict(NamedTuple):
    """What the model says. label: the likeliest, also where it abstains. probabilities: by label, their sum is 1."""

    label: str
    probabilities: dict[str, float]
    abstained: bool


class Model:
    """A trained classifier. arrays: as in the file. Raises ClassifierError for one made for other signs or formats."""

    def __init__(self, arrays: dict[str, np.ndarray], name: str = "the model"):
        remedy = "train it again with `rosimpact classifier train`, or install the rosimpact it came with"
        try:
            self.about: dict = json.loads(arrays["about"].tobytes())
            format, digest = self.about["format"], self.about["signs"]
        except (KeyError, ValueError, TypeError, RecursionError):
            raise ClassifierError(f"{name}: is no model of rosimpact; {remedy}") from None
        if format != FORMAT or digest != DIGEST:
            raise ClassifierError(
                f"{name}: was trained by rosimpact {self.about.get('rosimpact', '?')} for other features than this "
                f"version reads; {remedy}"
            )
        try:
            self.arrays = arrays
            self.labels: list[str] = self.about["labels"]
            self.temperature = float(self.about["temperature"])
            self.threshold = float(self.about["threshold"])
            self.seen: list[list[str]] = json.loads(arrays["known"].tobytes())
            self._coefficients = np.ascontiguousarray(arrays["coefficients"].T, dtype=np.float64)
            self._names: list[tuple[str, str]] = []
            self._columns: dict[str, dict[str, int]] = {}
            for view in VIEWS:
                grams = _unpack_lines(arrays[f"vocabulary {view}"])
                start = len(self._names)
                self._columns[view] = {gram: start + column for column, gram in enumerate(grams)}
                self._names.extend((view, gram) for gram in grams)
            self._weights = arrays["weights"].astype(np.float64)
            words = len(self._names)
            size, reports = arrays["vectors"].shape[1], len(self.seen)
            expected = {
                "coefficients": (len(self.labels), words + len(SIGNS)), "intercept": (len(self.labels),),
                "weights": (words,), "projection": (words, size), "vectors": (reports, size),
                "sign means": (len(SIGNS),), "sign scales": (len(SIGNS),),
            }  # fmt: skip
            for name, shape in expected.items():
                if arrays[name].shape != shape or arrays[name].dtype.kind != "f":
                    raise ValueError(name)
            if not self.labels or not all(isinstance(label, str) for label in self.labels):
                raise ValueError("labels")
            if not all(len(known) == 3 and all(isinstance(text, str) for text in known) for known in self.seen):
                raise ValueError("known")
        except (KeyError, ValueError, TypeError, IndexError, RecursionError):
            raise ClassifierError(f"{name}: is incomplete; {remedy}") from None

    def compute_scores(self, reading: ReportReading) -> np.ndarray:
        """The score of each label, before calibration."""
        columns, values = self._weigh_words(reading)
        signs = self._scale_signs(reading)
        words = len(self._names)
        return values @ self._coefficients[columns] + signs @ self._coefficients[words:] + self.arrays["intercept"]

    def judge(self, reading: ReportReading) -> ModelVerdict:
        """Label, calibrated probabilities, and whether it abstains: unsure of the label, or no word known."""
        chances = compute_softmax(self.compute_scores(reading) / self.temperature)
        best = int(chances.argmax())
        probabilities = {label: float(chance) for label, chance in zip(self.labels, chances, strict=True)}
        abstains = not self._knows(reading) or bool(chances[best] < self.threshold)
        return ModelVerdict(self.labels[best], probabilities, abstains)

    def list_reasons(self, reading: ReportReading, label: str, most: int = 8) -> list[Reason]:
        """The words and signs that spoke most for a label, strongest first."""
        place = self.labels.index(label)
        others = [other for other in range(len(self.labels)) if other != place]
        lead = self._coefficients[:, place] - self._coefficients[:, others].mean(axis=1)
        columns, values = self._weigh_words(reading)
        found: dict[tuple[str, str], float] = {}
        for column, weight in zip(columns, values * lead[columns], strict=True):
            view, gram = self._names[column]
            if VIEWS[view].shown:
                key = (VIEWS[view].shown, gram)
                found[key] = found.get(key, 0.0) + float(weight)
        signs = self._scale_signs(reading) * lead[len(self._names) :]
        for name, strength, weight in zip(SIGNS, reading.signs, signs, strict=True):
            if strength > 0:
                found["sign", name] = float(weight)
        best = sorted(((weight, *key) for key, weight in found.items() if weight > 0), reverse=True)[:most]
        return [Reason(where, what, weight) for weight, where, what in best]

    def find_nearest(self, reading: ReportReading, most: int = 5) -> list[KnownReport]:
        """The known reports whose words are most like those of a report; none when it shares no word with them."""
        columns, values = self._weigh_words(reading)
        vector = values @ self.arrays["projection"][columns].astype(np.float32)
        length = float(np.linalg.norm(vector))
        if length < 1e-9 or not len(self.seen) or not self._knows(reading):
            return []
        likeness = self.arrays["vectors"].astype(np.float32) @ (vector / length)
        order = np.argsort(-likeness, kind="stable")[:most]
        return [KnownReport(*self.seen[place], likeness=float(likeness[place])) for place in order]

    def _knows(self, reading: ReportReading) -> bool:
        """Whether the model knows any word of a report; letters it always does."""
        words = ((reading.grams[view], known) for view, known in self._columns.items() if VIEWS[view].shown)
        return any(gram in known for grams, known in words for gram in grams)

    def _weigh_words(self, reading: ReportReading) -> tuple[np.ndarray, np.ndarray]:
        columns: list[int] = []
        parts: list[np.ndarray] = []
        for view, known in self._columns.items():
            hits = [(known[gram], count) for gram, count in reading.grams[view].items() if gram in known]
            if not hits:
                continue
            places = [place for place, _ in hits]
            strength = (1 + np.log([count for _, count in hits])) * self._weights[places]
            columns.extend(places)
            parts.append(VIEWS[view].weight * strength / np.linalg.norm(strength))
        return np.array(columns, np.int64), np.concatenate(parts) if parts else np.zeros(0)

    def _scale_signs(self, reading: ReportReading) -> np.ndarray:
        scaled = (np.array(reading.signs) - self.arrays["sign means"]) / self.arrays["sign scales"]
        return np.clip(scaled, -LIMIT, LIMIT) / np.sqrt(len(SIGNS))

    def save(self, file: Path) -> None:
        """Writes the model; the same model gives the same bytes. Raises ClassifierError."""
        try:
            with open_for_replacing(file) as stream:
                np.savez_compressed(stream, allow_pickle=False, **self.arrays)
        except OSError as error:
            raise ClassifierError(f"{file}: cannot be written: {error.strerror}; give another file") from None


def load(file: Path | None = None) -> Model:
    """Reads a model, by default the one that is shipped. Raises ClassifierError."""
    file = file or SHIPPED
    none = f"{file}: is no model of rosimpact; make one with `rosimpact classifier train`"
    try:
        data = read_file(file, get_limits().report)
    except OSError as error:
        raise ClassifierError(
            f"{file}: cannot be read: {error.strerror or error}; make one with `rosimpact classifier train`"
        ) from None
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as packed:
            # zipfile gives no more bytes than it says here, and reads nothing of what is packed otherwise
            if sum(member.file_size for member in packed.infolist()) > get_limits().report:
                raise ClassifierError(
                    f"{file}: unpacks to more than {format_size(get_limits().report)}; give another model"
                )
        with np.load(io.BytesIO(data), allow_pickle=False) as stored:
            arrays = {name: stored[name] for name in stored.files}
    except ClassifierError:
        raise
    except Exception:  # whatever zipfile, zlib and NumPy raise over a file that is damaged, or none of theirs
        raise ClassifierError(none) from None
    return Model(arrays, str(file))


def compute_softmax(scores: np.ndarray) -> np.ndarray:
    """Scores to probabilities, along the last axis."""
    shifted = np.exp(scores - scores.max(axis=-1, keepdims=True))
    return shifted / shifted.sum(axis=-1, keepdims=True)


def pack_json(value: object) -> np.ndarray:
    """A value as JSON in an array of bytes."""
    return np.frombuffer(json.dumps(value, sort_keys=True, ensure_ascii=False).encode(), np.uint8)


def pack_lines(lines: list[str]) -> np.ndarray:
    """Lines in an array of bytes."""
    return np.frombuffer("\n".join(lines).encode(), np.uint8)


def _unpack_lines(array: np.ndarray) -> list[str]:
    text = array.tobytes().decode()
    return text.split("\n") if text else []
