"""Counts the features of synthetic labelled reports and trains on them: time and peak memory for each size.

usage: training.py [--reports 100000] [--steps 4] [--train]

The reports have about 2 kB, prose and a log, in words drawn by Zipf's law from 200,000, so that most n-grams are rare,
as in real reports. Each size is one process that reads them as a stream; with --train, the largest is trained on, too.
"""

from __future__ import annotations

import argparse
import os
import random
import resource
import subprocess
import sys
import time
from collections.abc import Iterator
from itertools import accumulate

WORDS = 200_000
HOMES = 300
LABELS = ("library-update", "dependency", "inconsistency", "message-logic", "other")


def texts(count: int) -> Iterator[str]:
    """The reports' bodies, the same for the same number."""
    chance = random.Random(1)
    weights = list(accumulate(1 / (rank + 1) for rank in range(WORDS)))

    def words(number: int) -> str:
        return " ".join(_word(word) for word in chance.choices(range(WORDS), cum_weights=weights, k=number))

    for number in range(count):
        log = "\n".join(f"[ERROR] [{1_600_000_000 + number + line}.1]: {words(8)}" for line in range(10))
        yield f"{words(180)}\n\n```\n{log}\n```\n"


def _word(number: int) -> str:
    number += 7
    letters = ""
    while number:
        number, syllable = divmod(number, 60)
        letters += "bcdfglmnprst"[syllable % 12] + "aeiou"[syllable // 12]
    return letters


def one(count: int, train: bool) -> None:
    """Measures one size in this process and prints its line."""
    from rosimpact.classifier import features, training
    from rosimpact.classifier.reading import read
    from rosimpact.corpus.report import BugReport

    groups = [f"o/r{number % HOMES}" for number in range(count)]
    start = time.perf_counter()
    counts = features.count((read(f"Report {n}", text) for n, text in enumerate(texts(count))), groups)
    took = time.perf_counter() - start
    columns = sum(map(len, counts.names.values()))
    cells = sum(matrix.nnz for matrix in counts.grams.values())
    line = f"{count:8,d}  {took:7.1f} s  {1e3 * took / count:5.2f} ms each  {_peak():6,d} MB  "
    print(f"{line}{columns:10,d} n-grams  {cells / count:6.0f} of them in a report", flush=True)
    if train:
        start = time.perf_counter()
        rows = [
            training.Example(BugReport(f"{group}#{n}", "https://x", "github", None, "", ""), LABELS[n % 5], False)
            for n, group in enumerate(groups)
        ]
        training.fit(training.Examples(rows, counts))
        print(f"   one fit  {time.perf_counter() - start:7.1f} s  {'':14s}  {_peak():6,d} MB", flush=True)


def _peak() -> int:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--reports", type=int, default=100_000)
    parser.add_argument("--steps", type=int, default=4, help="sizes: each half of the next")
    parser.add_argument("--train", action="store_true", help="also fit the linear model to the largest size")
    parser.add_argument("--one", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        one(options.reports, options.train)
        return 0
    print(f"{os.cpu_count()} cores")
    for step in reversed(range(options.steps)):
        size = options.reports >> step
        arguments = ["--one", "--reports", str(size), *(["--train"] if options.train and not step else [])]
        subprocess.run([sys.executable, __file__, *arguments], check=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
