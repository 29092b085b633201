"""From many reports to numbers, for training with scikit-learn.

The n-grams of the reports are counted once, into one matrix a view; whatever is fitted to some of the reports, a fold
of cross-validation or all, takes its rows. What is learnt are vocabularies, weights and scales: plain arrays, which
the model file holds, so that triage needs no scikit-learn.
"""

from __future__ import annotations

import marshal
import tempfile
import zlib
from array import array
from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack
from itertools import compress
from typing import IO, Any, NamedTuple

import numpy as np
from scipy.sparse import csr_matrix
from sklearn.base import BaseEstimator, TransformerMixin
from sklearn.feature_extraction.text import TfidfTransformer
from sklearn.preprocessing import StandardScaler

from .reading import VIEWS, ReportReading
from .signs import LIMIT, SIGNS

MANY = 400
"""Reports from which on an n-gram must stand in FEW of them, and not only in half as many."""
FEW = 4
HOMES = 3
"""Repositories in which an n-gram must stand."""
_BUCKETS = 1 << 26


class Counts(NamedTuple):
    """What many reports hold.

    grams: of each view, how often (255 at most) each n-gram stands in each report, reports by n-grams. names: the
    n-grams of each view, sorted. signs: reports by SIGNS. groups: the number of each report's repository.
    """

    grams: dict[str, csr_matrix]
    names: dict[str, list[str]]
    signs: np.ndarray
    groups: np.ndarray

    def select_rows(self, rows: np.ndarray) -> Counts:
        """The same of some of the reports."""
        grams = {view: csr_matrix(matrix[rows]) for view, matrix in self.grams.items()}
        return Counts(grams, self.names, self.signs[rows], self.groups[rows])


def count(readings: Iterable[ReportReading], groups: Sequence[str]) -> Counts:
    """Counts the n-grams that can be learnt from these reports: those that stand in enough of them.

    readings: in the order of groups, the repository of each; read once, one at a time. Most n-grams stand in one
    report: a table of hashes tells those that surely do, so that their names need not be held. The readings wait in a
    temporary file until it is full. That file has no name and ends with this process, so that nobody else can have
    written what marshal reads.
    """
    seen = np.zeros(_BUCKETS, np.uint8)
    signs = array("d")
    names, grams = {}, {}
    with ExitStack() as files:
        spools = {view: files.enter_context(tempfile.TemporaryFile()) for view in VIEWS}
        for reading in readings:
            for view, spool in spools.items():
                counted = reading.grams[view]
                places = _compute_places(view, counted)
                seen[places] += seen[places] < 255
                packed = zlib.compress(marshal.dumps(dict(counted)), 1)
                spool.write(len(packed).to_bytes(4, "big") + packed)
            signs.extend(reading.signs)
        codes = np.unique(np.array(groups), return_inverse=True)[1].astype(np.int32)
        for view, spool in spools.items():
            names[view], grams[view] = _count_view(view, spool, seen, codes)
    return Counts(grams, names, np.frombuffer(signs).reshape(-1, len(SIGNS)), codes)


def _compute_fewest(view: str, reports: int) -> int:
    return (FEW if reports >= MANY else FEW // 2) * VIEWS[view].rare


def _compute_places(view: str, grams: Iterable[str]) -> np.ndarray:
    hashes = np.fromiter(map(hash, grams), np.int64)
    return (hashes ^ hash(view)) & (_BUCKETS - 1)


def _read_spool(spool: IO[bytes]) -> Iterator[dict[str, int]]:
    spool.seek(0)
    while head := spool.read(4):
        yield marshal.loads(zlib.decompress(spool.read(int.from_bytes(head, "big"))))


def _count_view(view: str, spool: IO[bytes], seen: np.ndarray, codes: np.ndarray) -> tuple[list[str], csr_matrix]:
    names = _list_learnable(view, spool, seen, codes)
    known = {name: column for column, name in enumerate(names)}
    columns, times, starts = array("i"), array("B"), array("q", [0])
    for grams in _read_spool(spool):
        row = sorted((known[gram], min(number, 255)) for gram, number in grams.items() if gram in known)
        columns.extend(column for column, _ in row)
        times.extend(number for _, number in row)
        starts.append(len(times))
    shape = (len(codes), len(names))
    if not times:
        return names, csr_matrix(shape, dtype=np.uint8)
    arrays = (np.frombuffer(times, np.uint8), np.frombuffer(columns, np.int32), np.frombuffer(starts, np.int64))
    return names, csr_matrix(arrays, shape)


def _list_learnable(view: str, spool: IO[bytes], seen: np.ndarray, codes: np.ndarray) -> list[str]:
    """The n-grams of a view that stand in enough reports of enough repositories, sorted."""
    fewest = _compute_fewest(view, len(codes))
    places: dict[str, int] = {}
    often, homes = np.zeros(1_024, np.int32), np.full((HOMES, 1_024), -1, np.int32)
    for code, grams in zip(codes, _read_spool(spool), strict=True):
        common = seen[_compute_places(view, grams)] >= fewest
        row = np.array([places.setdefault(gram, len(places)) for gram in compress(grams, common)], np.int64)
        if len(places) > len(often):
            often = np.append(often, np.zeros(len(places), np.int32))
            homes = np.append(homes, np.full((HOMES, len(places)), -1, np.int32), axis=1)
        often[row] += 1
        new = row[(homes[:, row] != code).all(axis=0)]
        free = homes[:, new] < 0
        homes[free.argmax(axis=0)[free.any(axis=0)], new[free.any(axis=0)]] = code
    spread = (homes >= 0).sum(axis=0) >= min(HOMES, len(np.unique(codes)))
    kept = (often >= fewest) & spread
    return sorted(gram for gram, place in places.items() if kept[place])


def _select_common(counts: Any, codes: np.ndarray, fewest: int) -> np.ndarray:
    """The columns of what stands in enough reports of enough repositories."""
    homes = np.unique(codes)
    often = np.bincount(counts.indices, minlength=counts.shape[1]) >= fewest
    of_homes: Any = csr_matrix((np.ones(len(codes), bool), (np.searchsorted(homes, codes), np.arange(len(codes)))))
    there: Any = csr_matrix((np.ones(counts.nnz, bool), counts.indices, counts.indptr), counts.shape)
    spread = np.bincount((of_homes @ there).indices, minlength=counts.shape[1]) >= min(HOMES, len(homes))
    return np.flatnonzero(often & spread)


class Words(BaseEstimator, TransformerMixin):
    """TF-IDF of the n-grams of one view of reports.

    An n-gram is kept when it stands in enough reports of enough repositories: what one author wrote, or one project
    alone uses, is not learnt.
    """

    def __init__(self, view: str):
        self.view = view

    def fit(self, counts: Counts, groups: object = None) -> Words:
        """Learns the vocabulary and the weights."""
        matrix: Any = counts.grams[self.view]
        self.columns_ = _select_common(matrix, counts.groups, _compute_fewest(self.view, matrix.shape[0]))
        names = counts.names[self.view]
        self.vocabulary_ = [names[column] for column in self.columns_]
        self.weights_ = TfidfTransformer(sublinear_tf=True)
        if len(self.columns_):
            self.weights_.fit(matrix[:, self.columns_])
        return self

    def transform(self, counts: Counts) -> csr_matrix:
        """One row of unit length a report."""
        matrix = csr_matrix(counts.grams[self.view][:, self.columns_])
        if not len(self.columns_):
            return csr_matrix(matrix, dtype=float)
        rows = csr_matrix(self.weights_.transform(matrix))
        rows.sort_indices()
        return rows


class Signs(BaseEstimator, TransformerMixin):
    """The signs of a report, each to mean 0 and variance 1, the whole row scaled by the root of their number."""

    def fit(self, counts: Counts, groups: object = None) -> Signs:
        """Learns means and scales."""
        self.scaler_ = StandardScaler().fit(counts.signs)
        return self

    def transform(self, counts: Counts) -> np.ndarray:
        """One row a report."""
        scaled = self.scaler_.transform(counts.signs)
        return np.clip(scaled, -LIMIT, LIMIT) / np.sqrt(len(SIGNS))
