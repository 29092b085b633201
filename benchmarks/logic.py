"""Times `rosimpact logic` on the whole history of a repository beside a checkout of every commit, and prints ratios.

usage: logic.py REPOSITORY [--range A..B] [--commits N] [--sample 40]

    cold       nothing is known (an empty cache folder)
    warm       a second run
Wall and processor time are of the whole process and those it forks, imports included; memory is the sum of all of them,
pages that they share counted for each. The anchor is `git checkout` of a commit from its parent in a clone, timed for a
sample of the commits and multiplied by their number: what a tool that reads files on disk would spend before it reads.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple


class Figures(NamedTuple):
    """Seconds of wall and processor time, MB at the peak."""

    wall: float
    processor: float
    memory: int


def run(command: list[str], environment: dict[str, str], output: Path) -> Figures:
    start = time.perf_counter()
    with output.open("wb") as file:
        process = subprocess.Popen(
            command, stdout=file, stderr=subprocess.DEVNULL, env=environment, start_new_session=True
        )
        peak = 0
        while True:
            done, status, usage = os.wait4(process.pid, os.WNOHANG)
            if done:
                break
            peak = max(peak, memory(process.pid))
            time.sleep(0.1)
    wall = time.perf_counter() - start
    if os.waitstatus_to_exitcode(status):
        raise SystemExit(f"{' '.join(command)} failed with status {os.waitstatus_to_exitcode(status)}")
    return Figures(wall, usage.ru_utime + usage.ru_stime, max(peak, usage.ru_maxrss // 1024))


def memory(session: int) -> int:
    """MB that all processes of a session hold, where the system tells."""
    total = 0
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            fields = folder.joinpath("stat").read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[3]) == session:
            total += int(fields[21]) * os.sysconf("SC_PAGE_SIZE")
    return total >> 20


def git(*arguments: str) -> str:
    return subprocess.run(["git", *arguments], check=True, capture_output=True, text=True).stdout


def checkouts(repository: str, commits: list[str], folder: Path) -> float:
    """Seconds that a checkout of a commit takes when its parent is checked out, on average."""
    git("clone", "-q", "--shared", "--no-checkout", repository, str(folder))
    total = 0.0
    for commit in commits:
        git("-C", str(folder), "checkout", "-q", "-f", "--detach", f"{commit}^")
        start = time.perf_counter()
        git("-C", str(folder), "checkout", "-q", "-f", "--detach", commit)
        total += time.perf_counter() - start
    return total / max(1, len(commits))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("repository")
    parser.add_argument("--range", default="HEAD")
    parser.add_argument("--commits", type=int)
    parser.add_argument("--sample", type=int, default=40)
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        environment = {**os.environ, "ROSIMPACT_CACHE": str(Path(scratch, "cache"))}
        output = Path(scratch, "logic.json")
        command = [
            sys.executable,
            "-m",
            "rosimpact.impact.cli.app",
            "logic",
            args.repository,
            "--format",
            "json",
            "--quiet",
        ]
        command += ["--range", args.range]
        if args.commits:
            command += ["--commits", str(args.commits)]
        cold = run(command, environment, output)
        first = output.read_bytes()
        warm = min((run(command, environment, output) for _ in range(3)), key=lambda figures: figures.wall)
        found = json.loads(first)
        if output.read_bytes() != first:
            raise SystemExit("the second run says something else")
        limit = [f"-n{args.commits}"] if args.commits else []
        revisions = git("-C", args.repository, "rev-list", "--no-merges", "--min-parents=1", *limit, args.range).split()
        step = max(1, len(revisions) // args.sample)
        sample = revisions[::step][: args.sample]
        each = checkouts(args.repository, sample, Path(scratch, "clone"))
        stored = sum(path.stat().st_size for path in Path(scratch, "cache").glob("*")) / 1e6
    anchor = each * found["commits"]
    print(
        f"{args.repository}: {found['commits']:,} commits, {found['coverage']['compared']:,} compared, "
        f"{len(found['changes']):,} changes; {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}"
    )
    for name, figures in (("cold", cold), ("warm", warm)):
        print(
            f"  {name}  {figures.wall:6.2f} s  {figures.processor:6.2f} s of processors  {figures.memory:4d} MB  "
            f"{figures.wall / anchor:.3f} x a checkout per commit"
        )
    print(
        f"  checkout per commit: {anchor:.1f} s ({each * 1000:.0f} ms each, {len(sample)} timed); cache {stored:.1f} MB"
    )


if __name__ == "__main__":
    main()
