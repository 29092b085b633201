"""Scores `check` on historical breaks and on releases that built, straight from git, without a checkout.

The same judgement as the benchmark's own score.py, which is given as a file; only the trees are read from the
repositories, so that a whole run takes minutes. Recall is also told without the records of undetectable.yaml.

usage: breaks.py --score score.py --repos DIR [--breaks FILE] [--negatives FILE [--known BREAKS]] [--only TEXT]
                 [--accepted] [--out FILE] [--jobs N]

--accepted: a record counts as found under the other names of accepted.yaml too.
"""

from __future__ import annotations

import argparse
import collections
import importlib.util
import json
import os
import pathlib
import sys
import time
import traceback
from concurrent.futures import ProcessPoolExecutor

import yaml

_STATE: dict = {}


def start(score_path: str, repos: str, breaks: str | None) -> None:
    spec = importlib.util.spec_from_file_location("score", score_path)
    score = importlib.util.module_from_spec(spec)
    sys.modules["score"] = score
    spec.loader.exec_module(score)
    _STATE.update(score=score, repos=pathlib.Path(repos))
    by_id = {r["id"]: r for r in score.load(breaks, 0)} if breaks else {}
    _STATE["args"] = argparse.Namespace(repos=_STATE["repos"], by_id=by_id, command="")

    def tree(git, commit, folder) -> bool:
        pathlib.Path(folder, "REVISION").write_text(f"{git}\n{commit}")
        return True

    def check(command, folder, targets, timeout=300):
        from rosimpact.impact.analysis.check import check as run
        from rosimpact.impact.analysis.session import Options

        git, commit = pathlib.Path(folder, "REVISION").read_text().split("\n")
        began = time.monotonic()
        try:
            report = run(git, Options(targets=tuple(targets), rev=commit, jobs=1))
        except Exception as error:
            return None, "".join(traceback.format_exception(error))[-600:], time.monotonic() - began
        if report.failure:
            return None, report.failure, time.monotonic() - began
        found = [f._asdict() for f in report.findings]
        _STATE["last"] = found
        return found, None, time.monotonic() - began

    score.tree, score.check = tree, check


def undetectable() -> frozenset[str]:
    """The ids of records that no static checker could catch, by the reviewed list beside this file."""
    listed = yaml.safe_load(pathlib.Path(__file__).with_name("undetectable.yaml").read_bytes())
    return frozenset(record["id"] for record in listed["records"])


def accepted() -> dict[str, list[str]]:
    """Other names of what records are about, by their ids, from the reviewed list beside this file."""
    listed = yaml.safe_load(pathlib.Path(__file__).with_name("accepted.yaml").read_bytes())
    return {record["id"]: record["names"] for record in listed["records"]}


def args_notes() -> list[str]:
    """Rules whose notes are kept in the output too, from the environment: for judging whether they deserve more."""
    return os.environ.get("NOTES_OF", "").split()


def one_break(record):
    row = _STATE["score"].score_break(_STATE["args"], record)
    row["record"] = record
    return row


def one_negative(record):
    row = _STATE["score"].score_negative(_STATE["args"], record)
    if row["result"] == "run":
        folders = sorted(
            ((p["path"].strip("./"), p["name"]) for p in record["package_paths"]), key=lambda p: -len(p[0])
        )
        own = lambda path: next((n for at, n in folders if not at or path.startswith(at + "/")), None)  # noqa: E731
        row["said"] = [
            (f["severity"], f["rule"], own(f["path"]), f["path"], f["line"], f["subject"], f["message"])
            for f in _STATE["last"]
            if (f["severity"] != "note" or f["rule"] in args_notes()) and (own(f["path"]) or "/" not in f["path"])
        ]
    return row


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("--score", "--repos"):
        parser.add_argument(name, required=True)
    for name in ("--breaks", "--known", "--negatives", "--only", "--out"):
        parser.add_argument(name)
    parser.add_argument("--accepted", action="store_true")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--sample", type=int, default=0)
    args = parser.parse_args()
    start(args.score, args.repos, args.breaks or args.known)
    load = _STATE["score"].load
    keep = lambda rows: [r for r in rows if not args.only or args.only in json.dumps(r)]  # noqa: E731
    setting = (args.score, args.repos, args.breaks or args.known)
    with (
        open(args.out or os.devnull, "w") as out,
        ProcessPoolExecutor(args.jobs, initializer=start, initargs=setting) as pool,
    ):
        if args.breaks:
            records = keep(load(args.breaks, args.sample))
            others = accepted() if args.accepted else {}
            for record in records:
                if record["id"] in others:
                    record["accepted_names"] = [*record.get("accepted_names", ()), *others[record["id"]]]
            rows = [r for r in pool.map(one_break, records) if r["result"] != "no repository"]
            for label, part in (
                ("all", rows),
                ("tier A, hard", [r for r in rows if r["tier"] == "A" and r["hardness"] == "hard"]),
            ):
                won = [r for r in part if r["result"] == "found"]
                print(
                    f"recall, {label}: {len(won)}/{len(part)} = {len(won) / max(1, len(part)):.3f}, "
                    f"as errors {sum(r['error'] for r in won) / max(1, len(part)):.3f}"
                )
            seen = [r for r in rows if r["id"] not in undetectable()]
            won = [r for r in seen if r["result"] == "found"]
            print(
                f"recall, without {len(rows) - len(seen)} that no checker could catch: "
                f"{len(won)}/{len(seen)} = {len(won) / max(1, len(seen)):.3f}"
            )
            families = collections.defaultdict(collections.Counter)
            for r in rows:
                families[r["family"]][r["result"]] += 1
            for family, counts in sorted(families.items()):
                print(f"  {family:28s} {counts['found']:3d}/{sum(counts.values()):3d}  {dict(counts)}")
            out.writelines(json.dumps(r) + "\n" for r in rows)
        if args.negatives:
            rows = [
                r
                for r in pool.map(one_negative, keep(load(args.negatives, args.sample)))
                if r["result"] != "no repository"
            ]
            packages = sum(r["packages"] for r in rows)
            alarmed = sum(r["alarmed"] for r in rows)
            print(
                f"false alarms: {sum(len(r['alarms']) for r in rows)} errors in {alarmed} of {packages} "
                f"released packages = {alarmed / max(1, packages):.4f}; "
                f"failed {sum(r['result'] == 'failed' for r in rows)}"
            )
            print(f"noise: {sum(r['warnings'] for r in rows) / max(1, packages):.3f} warnings per released package")
            for severity in ("error", "warning"):
                rules = collections.Counter(s[1] for r in rows for s in r.get("said", ()) if s[0] == severity)
                print(f"  {severity}: " + ", ".join(f"{rule} {n}" for rule, n in rules.most_common()))
            out.writelines(json.dumps(r) + "\n" for r in rows)


if __name__ == "__main__":
    main()
