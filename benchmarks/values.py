"""Callbacks with rosimpact and with KLEE, side by side: crashes by kind and line, ways to each reaction, seconds.

The harnesses are the same: what `rosimpact values --emit klee` writes. By default of tests/values/callbacks: ten
callbacks as they occur on robots, and two workspaces of crashes, containers and exceptions.

KLEE is not in Debian. Where it is on PATH (or named by --klee), the column is filled; else it says so. Version 3.2 was
built from its sources with Debian's llvm-14-dev, clang-14 and libz3-dev:

    cmake -DENABLE_SOLVER_Z3=ON -DENABLE_SOLVER_STP=OFF -DENABLE_POSIX_RUNTIME=OFF -DENABLE_UNIT_TESTS=OFF
          -DENABLE_SYSTEM_TESTS=OFF -DENABLE_TCMALLOC=OFF -DLLVM_DIR=/usr/lib/llvm-14/lib/cmake/llvm ...

It reads bitcode of the clang that it was built with: --clang clang++-14 --link llvm-link-14.

usage: values.py [WORKSPACE...] [--klee KLEE] [--klee-include FOLDER] [--clang CLANG] [--link LINK] [--seconds 30]
                 [--replay] [--out FACTS.jsonl]
       values.py --study FACTS.jsonl... --out notebooks/data/values.jsonl
                 what the notebook reads: such facts, and the callbacks of benchmarks/values
"""

from __future__ import annotations

import argparse
import json
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path
from typing import NamedTuple

from rosimpact.impact.analysis.session import open_tree
from rosimpact.impact.facts.store import Store
from rosimpact.impact.model.flow.workspace import get_flow, link_for_flow
from rosimpact.impact.values.answers import CallbackAnswer
from rosimpact.impact.values.outcomes import Bounds, Reaction
from rosimpact.impact.values.survey import Asked, Survey

SETS = Path(__file__).parent / "values"
OWN = Path(__file__).parents[1] / "tests" / "values" / "callbacks"
NO_KLEE = "KLEE is not installed: --klee names it, see the top of this file"
_ERROR = re.compile(r"^Error: (?P<text>.*)$|^File: (?P<path>.*)$|^[Ll]ine: (?P<line>\d+)$", re.MULTILINE)
_FRAME = re.compile(r"^\s+#\S+ in .* at (?P<path>\S+?):(?P<line>\d+)$", re.MULTILINE)
_SOURCES = (".cpp", ".cc", ".cxx", ".h", ".hpp")
_REACTIONS = {"handled": Reaction.HANDLED, "log": Reaction.LOG_ONLY, "ignored": Reaction.IGNORED}
_KINDS = (
    # One word of KLEE's for both.
    (r"division overflow|div(ide|ision) by zero", "division by zero"),
    (r"ASSERTION|assertion of libstdc", "failed assertion"),
    (r"outside the range|float.cast", "float that no integer can hold"), (r"overflow", "signed overflow"),
    (r"shift", "shift by too many bits"), (r"std::|exception", "uncaught exception"), (r"abort", "abort"),
    (r"null pointer", "null pointer"), (r"out of bound|index-out-of-bounds|bounds", "index out of range"),
    (r"use after free", "memory used after it was freed"),
)  # fmt: skip


class Crash(NamedTuple):
    """kind: as rosimpact names it, or KLEE's own words; path is relative to the workspace."""

    kind: str
    path: str
    line: int


class KleeRun(NamedTuple):
    """What KLEE made of one harness. ways: that reach each reaction; crashes; stopped: words for what it gave up on;
    is_complete: whether it followed all ways within its time. reason: why it did not run."""

    ways: dict[str, int]
    crashes: list[Crash]
    stopped: dict[str, int]
    is_complete: bool
    seconds: float
    reason: str = ""


def explore(workspace: Path, seconds: float, replays: bool, folder: Path) -> tuple[list[CallbackAnswer], list[Path]]:
    """The C++ callbacks of a workspace as rosimpact explores them, and their harnesses for KLEE, in the same order."""
    with Store() as store:
        model = link_for_flow(open_tree(workspace, ""), store, 2, None)
        survey = Survey(workspace, model, get_flow(model).system, Bounds(seconds=seconds))
        report, _ = survey.explore(Asked(), replays=replays, jobs=2)
        emitted = survey.emit_klee(Asked(), folder)
    answers = [one for one in report.callbacks if one.language == "cpp"]
    names = {re.sub(r"^\d+_", "", path.name): path for path in emitted}
    return answers, [names.get(_name_folder(one.callback), Path()) for one in answers]


def _name_folder(callback: str) -> str:
    return "".join(each if each.isalnum() else "_" for each in callback)


def run_klee(harness: Path, workspace: Path, options: argparse.Namespace) -> KleeRun:
    """Runs KLEE on a harness, with the script that lies in it."""
    if not options.klee:
        return KleeRun({}, [], {}, False, 0.0, NO_KLEE)
    environment = {
        **os.environ, "KLEE": options.klee, "CLANG": options.clang, "LLVM_LINK": options.link,
        "KLEE_INCLUDE": options.klee_include, "SECONDS_AT_MOST": f"{options.seconds:g}",
    }  # fmt: skip
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    began = time.monotonic()
    try:
        done = subprocess.run(
            ["sh", str(harness / "run_klee.sh")], env=environment, capture_output=True, text=True, errors="replace",
            timeout=options.seconds * 4 + 300, check=False,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        return KleeRun({}, [], {}, False, time.monotonic() - began, "did not end")
    found = harness / "klee-last"
    if not (found / "info").exists():
        said = done.stderr.strip().splitlines() or ["nothing"]
        return KleeRun({}, [], {}, False, 0.0, next((one for one in said if "error" in one.lower()), said[-1])[:200])
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return read_klee(found, workspace, spent)


def read_klee(found: Path, workspace: Path, seconds: float) -> KleeRun:
    """What KLEE wrote into its folder."""
    ways: Counter[str] = Counter()
    stopped: Counter[str] = Counter()
    crashes: dict[Crash, None] = {}
    for error in sorted(found.glob("test*.err")):
        suffix = error.name.split(".")[1]
        if suffix in _REACTIONS:
            ways[_REACTIONS[suffix].value] += 1
            continue
        if suffix == "early" or error.name.endswith(".early"):
            continue
        text = error.read_text(errors="replace")
        crash = read_error(text, suffix, workspace)
        if crash.line and suffix not in ("exec", "external", "model", "solver", "xxx"):
            ways[Reaction.CRASH.value] += 1
            crashes[crash] = None
        else:
            stopped[crash.kind] += 1
    info = (found / "info").read_text(errors="replace")
    early = len(list(found.glob("test*.early")))
    return KleeRun(
        dict(ways), list(crashes), dict(stopped), not early and "HaltTimer" not in info, seconds
    )  # fmt: skip


def read_error(text: str, suffix: str, workspace: Path) -> Crash:
    """An error of KLEE: its kind, and the innermost line of the workspace on its stack."""
    said = next((found["text"] for found in _ERROR.finditer(text) if found["text"]), suffix)
    kind = next((name for pattern, name in _KINDS if re.search(pattern, said)), said)
    places = [(found["path"], int(found["line"])) for found in _FRAME.finditer(text)]
    first = re.search(r"^File: (.*)\n[Ll]ine: (\d+)", text, re.MULTILINE)
    if first is not None:
        places.insert(0, (first[1], int(first[2])))
    sources = [path.relative_to(workspace).as_posix() for path in workspace.rglob("*") if path.suffix in _SOURCES]
    for path, line in places:
        # KLEE leaves parts out at the beginning of some paths.
        for source in sources:
            if f"/{path.lstrip('/')}".endswith(f"/{source}") and f"{workspace}/{source}".endswith(path):
                return Crash(kind, source, line)
    return Crash(kind, "", 0)


def describe(answer: CallbackAnswer, klee: KleeRun) -> dict:
    """One callback as a record of facts."""
    ignored = {
        field.path: [list(span) for span in field.sets[Reaction.IGNORED].spans]
        for field in answer.fields
        if Reaction.IGNORED in field.sets
        and field.sets[Reaction.IGNORED].spans
        and not field.sets[Reaction.IGNORED].is_relational
    }
    crashes = {
        (one.crash.value, one.place.path, one.place.line, one.confirmed)
        for one in answer.examples
        if one.crash is not None
    }
    return {
        "callback": answer.callback, "type": answer.message_type, "path": answer.path,
        "rosimpact": {
            "reason": answer.reason, "ways": {one.value: count for one, count in answer.counts.items()},
            "crashes": [list(one) for one in sorted(crashes, key=str)], "ignored": ignored,
            "complete": answer.is_complete, "unknown": list(answer.unknown), "seconds": round(answer.seconds, 2),
        },
        "klee": {**klee._asdict(), "crashes": [list(one) for one in klee.crashes], "seconds": round(klee.seconds, 2)},
    }  # fmt: skip


def render(record: dict) -> list[str]:
    """A record on a few lines: rosimpact's column, then KLEE's."""
    lines = [f"{record['callback']}  {record['type']}"]
    for name in ("rosimpact", "klee"):
        one = record[name]
        if one["reason"]:
            lines.append(f"  {name:<10}{one['reason']}")
            continue
        ways = ", ".join(f"{count} {word}" for word, count in sorted(one["ways"].items())) or "no way"
        crashes = "; ".join(f"{kind} :{line}" for kind, _, line, *_ in one["crashes"]) or "no crash"
        given_up = [] if name == "rosimpact" else [f"{count} x {text}" for text, count in one["stopped"].items()]
        whole = one["complete"] if name == "rosimpact" else one["is_complete"]
        tail = ("" if whole else "  not all ways") + (f"  gave up on: {'; '.join(given_up)[:100]}" if given_up else "")
        lines.append(f"  {name:<10}{ways}  |  {crashes}  |  {one['seconds']:.1f} s{tail}")
    return lines


def summarize(records: list[dict]) -> list[str]:
    """How many crashes each finds."""
    own = {(r["callback"], *one[:3]) for r in records for one in r["rosimpact"]["crashes"]}
    theirs = {(r["callback"], *one[:3]) for r in records for one in r["klee"]["crashes"]}
    places = {(name, line) for name, _, _, line in own}
    same_line = {(name, line) for name, _, _, line in theirs} & places
    run = [r for r in records if not r["klee"]["reason"]]
    return [
        f"{len(records)} callbacks; rosimpact: {len(own)} crashes, "
        f"{sum(r['rosimpact']['seconds'] for r in records):.1f} s",
        f"KLEE ran on {len(run)}: {len(theirs)} crashes, {len(same_line)} on lines that rosimpact has, "
        f"{len(own & theirs)} of the same kind; {sum(r['klee']['is_complete'] for r in run)} followed to the end, "
        f"{sum(r['klee']['seconds'] for r in run):.1f} s of processor time, with the compiler",
    ]


_TOLD = ("explored", "complete", "ways", "seconds")


def list_real() -> list[dict]:
    """The callbacks of real repositories that readers judged (benchmarks/values), with what the tool said of them."""
    found: list[dict] = []
    for drawn in sorted(SETS.glob("*.drawn.jsonl")):
        name = drawn.name.partition(".")[0]
        said = {_identify(row): row for row in _read_rows(SETS / f"{name}.said.jsonl")}
        judged = {
            (r["repo"], r["path"], r["line"], r["kind"]): r["true"] for r in _read_rows(SETS / f"{name}.verdicts.jsonl")
        }
        for row in _read_rows(drawn):
            told = said.get(_identify(row))
            if told is None:
                continue
            crashes = [
                {**one, "true": judged.get((row["repo"], one["path"], one["line"], one["kind"]))}
                for one in told["crashes"]
            ]
            found.append({
                "of": "real", "set": name, "repo": row["repo"], "callback": row["callback"],
                "language": "cpp" if row["path"].endswith((".cpp", ".cc", ".cxx", ".hpp", ".h")) else "python",
                "opaque": bool(row.get("opaque")),
                "read": {key: row.get(key) for key in ("handles", "ignores", "logs", "crashes")},
                "said": {**{key: told.get(key) for key in _TOLD}, "crashes": crashes},
            })  # fmt: skip
    return found


def _identify(row: dict) -> tuple:
    return row["repo"], row["path"], row["line"], row["callback"]


def _read_rows(path: Path) -> list[dict]:
    return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []


def write_study(facts: list[Path], out: Path) -> None:
    """Writes what the notebook reads."""
    rows = [{"of": "harness", **row} for path in facts for row in _read_rows(path)]
    out.write_text("".join(json.dumps(row) + "\n" for row in (*rows, *list_real())))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("workspaces", nargs="*", type=Path)
    parser.add_argument("--klee", default=shutil.which("klee") or "")
    parser.add_argument("--klee-include", default="")
    parser.add_argument("--clang", default="clang++-14")
    parser.add_argument("--link", default="llvm-link-14")
    parser.add_argument("--seconds", type=float, default=30.0)
    parser.add_argument("--replay", action="store_true")
    parser.add_argument("--out", type=Path)
    parser.add_argument("--study", type=Path, nargs="+")
    options = parser.parse_args()
    if options.study:
        write_study(options.study, options.out)
        return
    records: list[dict] = []
    for workspace in options.workspaces or [OWN / name for name in ("ten", "roscpp", "rclcpp")]:
        root = workspace.resolve()
        with tempfile.TemporaryDirectory(prefix="rosimpact-klee-") as folder:
            answers, harnesses = explore(root, options.seconds, options.replay, Path(folder))
            for answer, harness in zip(answers, harnesses, strict=True):
                record = {"workspace": root.name, **describe(answer, run_klee(harness, root, options))}
                records.append(record)
                if options.out is not None:
                    options.out.write_text("".join(json.dumps(one) + "\n" for one in records))
                print("\n".join(render(record)), flush=True)
    print("\n".join(["", *summarize(records)]))
    sys.exit(0)


if __name__ == "__main__":
    main()
