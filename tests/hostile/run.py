"""Runs attacks and writes one line of JSON for each: python -m tests.hostile.run --jobs 2 --out FILE [--only CLASS]."""

from __future__ import annotations

import argparse
import json
import os
import sys
import traceback
from collections import Counter
from concurrent.futures import ProcessPoolExecutor, as_completed

from .harness import Range
from .table import attacks, order, sample

_RANGE: list[Range] = []


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--python", default=sys.executable, help="the interpreter that has rosimpact")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--out", help="file of JSON Lines")
    parser.add_argument("--only", default="", help="one class")
    parser.add_argument("--name", default="", help="only attacks whose name holds this")
    parser.add_argument("--from-failures", default="", help="only attacks that failed in this file")
    parser.add_argument("--experience", action="store_true", help="from a process that has checked before, as CI does")
    parser.add_argument("--sample", action="store_true", help="only the sample that CI takes")
    parser.add_argument("--resume", action="store_true", help="leave out what --out holds already, and add to it")
    asked = parser.parse_args()
    rows = [
        row
        for row in (sample() if asked.sample else attacks())
        if asked.only in ("", row.group) and asked.name in row.name
    ]
    if asked.from_failures:
        with open(asked.from_failures) as file:
            failed = {row["name"] for row in map(json.loads, file) if not row["ok"]}
        rows = [row for row in rows if row.name in failed]
    done: dict[str, dict[str, object]] = {}
    if asked.resume and asked.out and os.path.exists(asked.out):
        with open(asked.out) as file:
            done = {row["name"]: row for row in map(json.loads, file)}
    # In an order of chance that is always the same, so that what is done of a run that is stopped stands for all.
    names = [row.name for row in sorted(rows, key=order) if row.name not in done]
    good: Counter[str] = Counter()
    every: Counter[str] = Counter()
    with (
        open(asked.out or os.devnull, "a" if asked.resume else "w") as out,
        ProcessPoolExecutor(asked.jobs, initializer=_start, initargs=(asked.python, asked.experience)) as pool,
    ):
        for future in as_completed([pool.submit(_attempt, name) for name in names]):
            result = future.result()
            every[result["class"]] += 1
            good[result["class"]] += result["ok"]
            out.write(json.dumps(result) + "\n")
            out.flush()
            if not result["ok"]:
                print(f"{result['class']}: {result['name']}: {'; '.join(result['failures'])}", flush=True)
    for group in sorted(every):
        print(f"{group}: {good[group]} of {every[group]}")
    print(f"all: {good.total()} of {every.total()}")
    return 0 if good.total() == every.total() else 1


def _start(python: str, experience: bool) -> None:
    _RANGE.append(Range(python, experience=experience).__enter__())


def _attempt(name: str) -> dict[str, object]:
    attack = next(row for row in attacks() if row.name == name)
    try:
        result = _RANGE[0].attempt(attack)
    except Exception as error:
        text = traceback.format_exc().splitlines()
        return {
            "name": name,
            "class": attack.group,
            "ok": False,
            "failures": [f"HARNESS {error!r} {text[-3:]}"],
            "cpu": 0,
            "rss": 0,
        }
    return {
        "name": name,
        "class": attack.group,
        "ok": not result.failures,
        "failures": result.failures,
        "cpu": round(result.cpu, 2),
        "rss": result.rss,
    }


if __name__ == "__main__":
    sys.exit(main())
