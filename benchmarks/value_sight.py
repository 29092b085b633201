"""What callbacks do with values, at first sight: callbacks drawn from workspaces that nobody here had opened.

A set is benchmarks/values/NAME.systems.jsonl (repo, commit) and NAME.drawn.jsonl, a record for each callback: repo,
commit, path and line (of the subscription), callback, type. A reader of the sources who has not seen the tool's answer
adds, of messages within texts of 8 bytes and arrays of 3 elements and of any state of the node
    handles  whether something that others can observe may follow
    ignores  whether some message leads to nothing at all; logs: to a line in a log and nothing else
    crashes  what some message leads to: kind (as rosimpact names it) and line
    opaque   true where it cannot be said without code that is not in the workspace; then the others are left out
    beyond   true where something follows only from arrays that are longer
What the tool says is computed when it is scored, on a checkout of the commit, and written beside it (NAME.said.jsonl),
with what preparing, exploring and replaying it took once the workspace was read: seconds of the processor, of this
process and all that it started, those of the clock, and the most memory of all these, in MB.
A crash that the reader has not got is judged by hand afterwards: `true` in NAME.verdicts.jsonl (repo, path, line, kind)

usage: value_sight.py draw --set NAME --clones FOLDER [--number 6] [--seed 20]
       value_sight.py score --set NAME --clones FOLDER --work FOLDER [--replay] [--seconds 20] [--compiling 60]
                     [--resume] [--repo OWNER/NAME]
"""

from __future__ import annotations

import argparse
import json
import os
import random
import statistics
import subprocess
import sys
import threading
import time
from pathlib import Path
from types import TracebackType

import mining
from field_sight import list_callbacks
from rosimpact.impact.analysis.session import open_tree
from rosimpact.impact.facts.store import Store
from rosimpact.impact.model.flow.workspace import get_flow, link_for_flow
from rosimpact.impact.values.answers import CallbackAnswer
from rosimpact.impact.values.outcomes import Bounds, Reaction
from rosimpact.impact.values.survey import Asked, Survey

SETS = Path(__file__).parent / "values"
_WORDS = (("handles", Reaction.HANDLED), ("ignores", Reaction.IGNORED), ("logs", Reaction.LOG_ONLY))


def draw(options: argparse.Namespace, systems: list[dict]) -> None:
    """Draws callbacks by a fixed seed; those that were drawn before are kept."""
    with (SETS / f"{options.set}.drawn.jsonl").open("w") as out:
        for system in systems:
            (clone,) = mining.find_clones(options.clones, [system["repo"]])
            chance = random.Random(f"{options.seed} {clone.name} {system['commit']}")
            records = [record for record, _ in list_callbacks(clone, system["commit"])]
            for record in chance.sample(records, min(options.number, len(records))):
                del record["fields"]
                out.write(json.dumps(record) + "\n")
            print(f"{system['repo']}: {len(records)} callbacks", file=sys.stderr, flush=True)


class ProcessorTime:
    """Seconds of the processor, of users and of the system, that this process and all that it started have taken since
    it was made. What runs still is not counted."""

    def __init__(self) -> None:
        self._begun = self._read()

    @staticmethod
    def _read() -> float:
        found = os.times()
        return found.user + found.system + found.children_user + found.children_system

    def measure(self) -> float:
        return self._read() - self._begun


class MemoryWatch:
    """The most memory that this process and all that it started had at a time, in MB: the sum of their resident sizes,
    looked at ten times a second, so that pages which forked processes have in common count for each of them."""

    def __init__(self) -> None:
        self.peak = 0
        self._over = threading.Event()
        self._watching = threading.Thread(target=self._watch, daemon=True)

    def __enter__(self) -> MemoryWatch:
        self._watching.start()
        return self

    def __exit__(self, _: type[BaseException] | None, __: BaseException | None, ___: TracebackType | None) -> None:
        self._over.set()
        self._watching.join()

    def _watch(self) -> None:
        while not self._over.wait(0.1):
            self.peak = max(self.peak, measure_tree(os.getpid()))


def measure_tree(root: int) -> int:
    """The resident sizes of a process and of all below it, in MB."""
    parents: dict[int, int] = {}
    sizes: dict[int, int] = {}
    for folder in Path("/proc").iterdir():
        if not folder.name.isdigit():
            continue
        try:
            fields = (folder / "stat").read_text().rpartition(")")[2].split()
        except OSError:
            continue
        parents[int(folder.name)], sizes[int(folder.name)] = int(fields[1]), int(fields[21])
    own = {root}
    while more := {one for one, parent in parents.items() if parent in own} - own:
        own |= more
    return sum(sizes.get(one, 0) for one in own) * os.sysconf("SC_PAGE_SIZE") // 1_000_000


def describe(answer: CallbackAnswer) -> dict:
    """What the tool says of a callback, as facts."""
    return {
        "explored": answer.is_explored, "complete": answer.is_complete, "reason": answer.reason[:300],
        "ways": {one.value: count for one, count in answer.counts.items()},
        "crashes": [
            {"kind": one.crash.value, "path": one.place.path, "line": one.place.line, "confirmed": one.confirmed}
            for one in answer.examples
            if one.crash is not None
        ],
        "unknown": list(answer.unknown)[:5], "seconds": round(answer.seconds, 2),
        "compiled_in": round(answer.compiled_in, 1), "rounds": answer.rounds,
    }  # fmt: skip


def check_out(clone: mining.Clone, commit: str, folder: Path) -> None:
    """Writes the files of a commit into a folder, but for those that the clone lacks (large ones) and links."""
    listed = clone.read("ls-tree", "-r", "-z", commit).split("\0")
    for entry in filter(None, listed):
        head, _, path = entry.partition("\t")
        mode, _, blob = head.split()
        if mode not in ("100644", "100755"):
            continue
        read = subprocess.run(["git", "-C", clone.folder, "cat-file", "blob", blob], capture_output=True, check=False)
        if read.returncode == 0:
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_bytes(read.stdout)


def ask(options: argparse.Namespace, system: dict, records: list[dict]) -> list[dict]:
    """What the tool says of the callbacks of one system, in their order."""
    (clone,) = mining.find_clones(options.clones, [system["repo"]])
    folder = options.work / clone.name.replace("/", "+")
    if not folder.exists():
        check_out(clone, system["commit"], folder)
    bounds = Bounds(seconds=options.seconds, compiling=options.compiling)
    tree = open_tree(folder, "")
    with Store() as store:
        workspace = link_for_flow(tree, store, 2, None)
        with Survey(folder, workspace, get_flow(workspace).system, bounds) as survey:
            return [ask_one(options, survey, record) for record in records]


def ask_one(options: argparse.Namespace, survey: Survey, record: dict) -> dict:
    """What the tool says of one callback, and what that took."""
    asked = Asked(callbacks=(record["callback"],))
    processor, begun = ProcessorTime(), time.monotonic()
    with MemoryWatch() as watch:
        report, _ = survey.explore(asked, publishers=False, replays=options.replay, jobs=1)
    rows = [one for one in report.callbacks if one.callback == record["callback"]]
    rows = [one for one in rows if one.path == record["path"]] or rows
    same = [one for one in rows if one.message_type == record["type"]] or rows
    said = describe(same[0]) if same else {"explored": False, "reason": "the tool has no such callback"}
    took = {"processor": round(processor.measure(), 2), "clock": round(time.monotonic() - begun, 2)}
    return {**said, **took, "memory": watch.peak}


def score(options: argparse.Namespace, systems: list[dict], records: list[dict]) -> None:
    """Prints how many callbacks are explored, and how often tool and reader say the same."""
    pairs: list[tuple[dict, dict]] = []
    kept = SETS / f"{options.set}.said.jsonl"
    known = [json.loads(line) for line in kept.read_text().splitlines()] if options.resume or options.repo else []
    with kept.open("w") as out:
        for system in systems:
            own = [record for record in records if record["repo"] == system["repo"]]
            answers = [one for one in known if one["repo"] == system["repo"]]
            is_asked = system["repo"] in options.repo if options.repo else len(answers) != len(own)
            if is_asked:
                answers = ask(options, system, own)
            for record, said in zip(own, answers, strict=True):
                pairs.append((record, said))
                where = {key: record[key] for key in ("repo", "path", "line", "callback")}
                out.write(json.dumps({**where, **said}) + "\n")
                out.flush()
    explored = [(record, said) for record, said in pairs if said["explored"]]
    print(f"{len(pairs)} callbacks, {len(explored)} explored to a verdict")
    for word, reaction in _WORDS:
        judged = [(record[word], bool(said["ways"].get(reaction.value))) for record, said in explored if word in record]
        wrong = [f"{record['callback']}" for record, said in explored
                 if word in record and record[word] != bool(said["ways"].get(reaction.value))]  # fmt: skip
        print(f"{word}: {len(judged) - len(wrong)} of {len(judged)} the same; otherwise: {', '.join(wrong)}")
    found = missed = unconfirmed = confirmed = 0
    others: list[str] = []
    for record, said in explored:
        known = {(one["kind"], one["line"]) for one in record.get("crashes", ())}
        seen = {(one["kind"], one["line"]) for one in said["crashes"]}
        found, missed = found + len(known & seen), missed + len(known - seen)
        unconfirmed += sum(one["confirmed"] is False for one in said["crashes"])
        confirmed += sum(one["confirmed"] is True for one in said["crashes"])
        others += [f"{record['repo']} {record['callback']}:{line} {kind}" for kind, line in sorted(seen - known)]
    print(f"crashes: {found} as the reader has them, {missed} missed; "
          f"{confirmed} confirmed by the replay, {unconfirmed} not")  # fmt: skip
    print("to be judged: " + ("; ".join(others) or "none"))
    times = [said["seconds"] for _, said in pairs if "seconds" in said]
    if times:
        print(f"seconds: median {statistics.median(times):.2f}, most {max(times):.2f}")
    for word in ("processor", "clock"):
        if whole := [said[word] for _, said in pairs if word in said]:
            middle, most = statistics.median(whole), max(whole)
            print(f"seconds of the {word} with compiling and replays: median {middle:.2f}, most {most:.2f}")
    sizes = [said["memory"] for _, said in pairs if "memory" in said]
    if sizes:
        print(f"memory of all processes of a run: most {max(sizes)} MB")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", choices=("draw", "score"))
    parser.add_argument("--set", required=True)
    parser.add_argument("--clones", type=Path, required=True)
    parser.add_argument("--work", type=Path, default=Path("build/values"))
    parser.add_argument("--number", type=int, default=6)
    parser.add_argument("--seed", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--compiling", type=float, default=60.0, help="seconds of the processor for each source")
    parser.add_argument("--replay", action="store_true")
    parser.add_argument("--resume", action="store_true", help="systems that have an answer already are not asked again")
    parser.add_argument("--repo", action="append", help="only these of the set; the answers of the others stay")
    options = parser.parse_args()
    systems = [json.loads(line) for line in (SETS / f"{options.set}.systems.jsonl").read_text().splitlines()]
    if options.command == "draw":
        draw(options, systems)
        return
    records = [json.loads(line) for line in (SETS / f"{options.set}.drawn.jsonl").read_text().splitlines()]
    score(options, systems, records)


if __name__ == "__main__":
    main()
