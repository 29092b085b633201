"""Transformers from reports to numbers, for training with scikit-learn.

Each takes what `Reading` holds of a report and gives one row. What they learn is a vocabulary, weights and scales:
plain arrays, which the model file holds, so that triage needs no scikit-learn.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from scipy.sparse import csr_matrix
from sklearn.base import BaseEstimator, TransformerMixin
from sklearn.feature_extraction.text import TfidfTransformer
from sklearn.preprocessing import StandardScaler

from .reading import Reading
from .signs import LIMIT, SIGNS


class Words(BaseEstimator, TransformerMixin):
    """TF-IDF of the n-grams of one view of a report.

    An n-gram is kept when it stands in `reports` reports of `groups` repositories or more: what one author wrote, or
    one project alone uses, is not learnt.
    """

    def __init__(self, view: str, reports: int = 4, groups: int = 3):
        self.view = view
        self.reports = reports
        self.groups = groups

    def fit(self, readings: Sequence[Reading], groups: Sequence[str]) -> Words:
        """Learns vocabulary and weights. groups: the repository of each report."""
        times: Counter[str] = Counter()
        homes: dict[str, set[str]] = {}
        for reading, group in zip(readings, groups, strict=True):
            for gram in reading.grams[self.view]:
                times[gram] += 1
                seen = homes.setdefault(gram, set())
                if len(seen) < self.groups:
                    seen.add(group)
        kept = sorted(g for g, count in times.items() if count >= self.reports and len(homes[g]) >= self.groups)
        self.vocabulary_ = {gram: column for column, gram in enumerate(kept)}
        self.weights_ = TfidfTransformer(sublinear_tf=True)
        if kept:
            self.weights_.fit(self._counts(reading.grams[self.view] for reading in readings))
        return self

    def transform(self, readings: Sequence[Reading]) -> csr_matrix:
        """One row of unit length a report."""
        counts = self._counts(reading.grams[self.view] for reading in readings)
        return csr_matrix(self.weights_.transform(counts)) if self.vocabulary_ else counts

    def _counts(self, grams: Iterable[Mapping[str, int]]) -> csr_matrix:
        data: list[int] = []
        columns: list[int] = []
        starts = [0]
        for counted in grams:
            for gram, count in counted.items():
                column = self.vocabulary_.get(gram)
                if column is not None:
                    columns.append(column)
                    data.append(count)
            starts.append(len(data))
        shape = (len(starts) - 1, len(self.vocabulary_))
        matrix = csr_matrix((np.array(data, float), np.array(columns, np.int32), np.array(starts, np.int32)), shape)
        matrix.sort_indices()
        return matrix


class Signs(BaseEstimator, TransformerMixin):
    """The signs of a report, each to mean 0 and variance 1, the whole row scaled by the root of their number."""

    def fit(self, readings: Sequence[Reading], groups: object = None) -> Signs:
        """Learns means and scales."""
        self.scaler_ = StandardScaler().fit(np.array([reading.signs for reading in readings]))
        return self

    def transform(self, readings: Sequence[Reading]) -> np.ndarray:
        """One row a report."""
        scaled = self.scaler_.transform(np.array([reading.signs for reading in readings]))
        return np.clip(scaled, -LIMIT, LIMIT) / np.sqrt(len(SIGNS))
