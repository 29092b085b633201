"""Times triage: the start, and the stream of 1,000 reports after it.

usage: triage.py --reports FILE [--count N] [--runs N]

FILE is JSON Lines with `id`, `title` and `body`; it is repeated until there are N. Prints seconds and peak memory.
"""

from __future__ import annotations

import argparse
import itertools
import json
import pathlib
import resource
import subprocess
import sys
import time

_COMMAND = [sys.executable, "-c", "from rosimpact.impact.cli.app import main; main()", "triage"]


def timed(arguments: list[str], text: str) -> tuple[float, str]:
    """Seconds that a command takes, and what it prints."""
    start = time.perf_counter()
    done = subprocess.run([*_COMMAND, *arguments], input=text, capture_output=True, text=True, check=True)
    return time.perf_counter() - start, done.stdout


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--reports", type=pathlib.Path, required=True)
    parser.add_argument("--count", type=int, default=1_000)
    parser.add_argument("--runs", type=int, default=3)
    options = parser.parse_args()
    rows = [json.loads(line) for line in options.reports.read_text(encoding="utf-8").splitlines() if line.strip()]
    taken = itertools.islice(itertools.cycle(rows), options.count)
    text = "".join(json.dumps({name: row[name] for name in ("id", "title", "body")}) + "\n" for row in taken)
    start = min(timed(["a robot that does not move"], "")[0] for _ in range(options.runs))
    whole, printed = min((timed(["--jsonl", "-"], text) for _ in range(options.runs)), key=lambda pair: pair[0])
    memory = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    if len(printed.splitlines()) != options.count:
        raise SystemExit(f"{len(printed.splitlines())} answers to {options.count} reports")
    print(f"start and one report  {start:6.2f} s")
    print(f"{options.count:,} reports         {whole:6.2f} s, {1e3 * (whole - start) / options.count:.1f} ms each")
    print(f"peak memory           {memory:6.0f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
