"""Measures how many of the breaks that a packager's newer libraries bring `check` names before anybody builds.

RoboStack builds ROS packages against conda-forge's libraries and patches what breaks. patches.jsonl has such patches,
each confirmed by a reader: what is at fault, in which file of which release, and the day of the patch;
patches_second.jsonl has others, and of a release that no clone has the newest commit before the patch. A record counts
as found when an error or warning for the platform on that day names the fault in that file, or elsewhere in the
package.

usage: patches.py --score score.py --clones FOLDER [--records FILE] [--out FILE] [--jobs 2]

`--score`: the judgement, as for breaks.py. `--clones`: git repositories as OWNER+NAME/repo, OWNER+NAME or OWNER/NAME.
"""

from __future__ import annotations

import argparse
import importlib.util
import sys
import tempfile
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import first_sight
import mining
from rosimpact.impact.analysis.check import check
from rosimpact.impact.analysis.session import Options

RECORDS = Path(__file__).with_name("patches.jsonl")
_STATE: dict = {}


def start(score_path: str) -> None:
    """Loads the judgement of names."""
    spec = importlib.util.spec_from_file_location("score", score_path)
    assert spec is not None and spec.loader is not None
    score = importlib.util.module_from_spec(spec)
    sys.modules["score"] = score
    spec.loader.exec_module(score)
    _STATE["same_name"] = score.same_name


def judge(findings: list[dict], record: dict) -> str:
    """`file` where an error or warning names the fault in its file, `package` elsewhere in the package, `note` where
    only a note does, else `missed`."""
    names = [record["expected_name"], *record["accepted_names"]]
    named = [f for f in findings if any(_STATE["same_name"](name, str(f["subject"] or "")) for name in names)]
    loud = [f for f in named if f["severity"] != "note"]
    if any(f["path"] == record["expected_file"] for f in loud):
        return "file"
    if any(f["package"] == record["package"]["name"] for f in loud):
        return "package"
    return "note" if any(f["package"] == record["package"]["name"] for f in named) else "missed"


def ask(job: tuple[mining.Clone, dict]) -> dict:
    """The record with `result` (see judge(); `failed` where the tree could not be checked) and `error`."""
    clone, record = job
    with tempfile.TemporaryDirectory() as folder:
        config = Path(folder, "rosimpact.toml")
        target = f'distro = "{record["distro"]}"\ndate = {record["date"]}\nplatform = "robostack"\n'
        config.write_text(f"[targets.packager]\n{target}", encoding="utf-8")
        report = check(clone.folder, Options(rev=record["commit"], config=config, jobs=1))
    if report.failure:
        return {**record, "result": "failed", "error": report.failure}
    return {**record, "result": judge([f._asdict() for f in report.findings], record), "error": ""}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--score", required=True)
    parser.add_argument("--clones", type=Path, required=True)
    parser.add_argument("--records", type=Path, default=RECORDS)
    parser.add_argument("--out", type=Path)
    parser.add_argument("--jobs", type=int, default=2)
    args = parser.parse_args()
    records = first_sight.read_records(args.records)
    clones = {one.name: one for one in mining.find_clones(args.clones, sorted({r["repo"] for r in records}))}
    jobs = [(clones[record["repo"]], record) for record in records if record["repo"] in clones]
    with ProcessPoolExecutor(args.jobs, initializer=start, initargs=(args.score,)) as pool:
        rows = list(pool.map(ask, jobs))
    if args.out:
        first_sight.write_records(args.out, rows)
    counted = Counter(row["result"] for row in rows)
    found = counted["file"] + counted["package"]
    absent = len(records) - len(rows)
    print(f"{found} of {len(rows)} found ({found / len(rows):.2f}): {dict(counted)}; {absent} not at hand")


if __name__ == "__main__":
    main()
