"""Findings of `check` on a batch's repositories that a reader judged by the sources: drawn, asked again, counted.

Beside a batch (see first_sight.py) lie its verdicts, one record for each judged finding:
    NAME.verdicts.jsonl   every error on the release trees (repo, tag, distro, ...)
    NAME.heads.jsonl      findings drawn on the newest commits (repo, commit, ...)
with rule, severity, package, path, line, subject, verdict ("true", "true-but-latent": of another target or a build that
the farm does not make, "badly said": the fault is there, the text misleads, "false"), why (one clause) and class.

usage: verdicts.py draw --batch NAME --clones FOLDER --out FILE [--number 100] [--share-errors 0.5] [--seed N]
                        [--preview]
       verdicts.py recheck --clones FOLDER [--batch NAME] [--jobs 2]
       verdicts.py precision FILE

`draw`: checks the newest commit of each repository with the targets that a user gets who names none, and draws errors
and warnings, of a repository and rule at most two. A repository that is a subject of the batch's breaks is a head like
any other. --preview: preview rules are asked too, so that one that became a preview by its verdicts can be
judged again. `recheck`: checks what the verdicts are about again; exits with 1 if a finding that was judged false is
back, and names the true ones that are gone. `precision`: writes the table that `rosimpact explain` reads, and beside it
imprecise.toml, the rules that are surely right less often than 9 times in 10: they are previews.
"""

from __future__ import annotations

import argparse
import json
import random
import sys
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

import first_sight
import mining
from rosimpact.edges.console import UserError
from rosimpact.impact.analysis.check import check
from rosimpact.impact.analysis.session import Options
from rosimpact.impact.rules.rule import load_rules
from scipy.stats import binom

NEWEST = 20
"""Findings of a rule by which it is decided whether it is a preview."""
RIGHT = frozenset(("true", "true-but-latent"))
PER_RULE = 2


def check_commit(job: tuple[mining.Clone, str, tuple[str, ...]], preview: bool = False) -> list[dict] | None:
    """What `check` says of a commit of a clone: its errors and warnings, with repo and commit; None where the clone has
    no such commit. job: the clone, the commit and the targets. A check that fails says nothing; its reason is
    printed."""
    clone, commit, targets = job
    try:
        report = check(str(clone.folder), Options(targets=targets, rev=commit, jobs=1, preview=preview))
    except UserError as error:  # a clone that lacks the commit
        print(f"{clone.name}: {error}", file=sys.stderr)
        return None
    if report.failure:
        print(f"{clone.name}: {report.failure}", file=sys.stderr)
        return []
    told = ("rule", "severity", "package", "path", "line", "subject", "message", "targets")
    found = (finding._asdict() for finding in report.findings)
    return [
        {"repo": clone.name, "commit": commit, **{name: finding[name] for name in told}}
        for finding in found
        if finding["severity"] in ("error", "warning")
    ]


def choose(findings: Iterable[dict], number: int, share_errors: float, seed: int) -> list[dict]:
    """`number` findings at random, `share_errors` of them errors as far as there are any, at most two of one rule in
    one repository, in an order that puts those of one repository together."""
    chance = random.Random(seed)
    ordered = sorted(findings, key=lambda f: (f["repo"], f["rule"], f["path"], f["line"], str(f["subject"])))
    chance.shuffle(ordered)
    taken: Counter[tuple[str, str]] = Counter()
    kept: dict[str, list[dict]] = defaultdict(list)
    for finding in ordered:
        key = finding["repo"], finding["rule"]
        if taken[key] < PER_RULE:
            taken[key] += 1
            kept[finding["severity"]].append(finding)
    errors = kept["error"][: round(number * share_errors)]
    chosen = errors + kept["warning"][: number - len(errors)]
    return sorted(chosen, key=lambda f: (f["repo"], f["rule"], f["path"], f["line"]))


def judged(batches: Path, only: str = "") -> list[dict]:
    """The records of all verdicts, or of one batch, each with its batch and, of a release, the day that it was scored
    as of."""
    found = []
    days: dict[tuple[str, str, str], str] = {}
    for file in sorted(batches.glob("*.jsonl")):
        batch, _, kind = file.name.removesuffix(".jsonl").rpartition(".")
        if kind == "releases":  # these go before the verdicts on them
            trees = first_sight.read_records(file)
            days.update(((r["repo"], r["tag"], r["distro"]), r["in_distro_until_at_least"][:10]) for r in trees)
        if kind in ("verdicts", "heads") and (not only or batch == only):
            found += [{"batch": batch, "severity": "error", **row} for row in first_sight.read_records(file)]
    for row in found:
        row["day"] = days.get((row["repo"], row.get("tag", ""), row.get("distro", "")), "")
    return found


def compare(records: Sequence[dict], said: Iterable[dict]) -> tuple[list[dict], list[dict]]:
    """Of the verdicts on one tree: those judged false that are said again, and right ones that are said no more. A
    finding is the same if rule, path and subject are, with a severity as high. A rule that was split since means those
    that it was split into."""
    rules = load_rules()
    now: dict[tuple, str] = {
        (name, f["path"], f["subject"]): f["severity"] for f in said for name in rules[f["rule"]].names[:-1]
    }
    again = []
    gone = []
    for record in records:
        severity = now.get((record["rule"], record["path"], record["subject"]), "")
        if record["verdict"] == "false" and severity and (severity == "error" or record["severity"] == "warning"):
            again.append(record)
        elif record["verdict"] in RIGHT and not severity:
            gone.append(record)
    return again, gone


def count_precision(records: Iterable[dict]) -> dict[str, list[dict]]:
    """By rule, a row for each batch as `rosimpact explain` reads them: how many findings were judged, how many of them
    were right, and in how many repositories they were."""
    rules: dict[tuple[str, str], list[dict]] = defaultdict(list)
    for record in records:
        rules[record["rule"], record["batch"]].append(record)
    counted: dict[str, list[dict]] = defaultdict(list)
    for (rule, batch), rows in sorted(rules.items()):
        counted[rule].append(
            {
                "batch": batch,
                "repositories": len({row["repo"] for row in rows}),
                "findings": len(rows),
                "right": sum(row["verdict"] in RIGHT for row in rows),
                "badly_said": sum(row["verdict"] == "badly said" for row in rows),
            }
        )
    return dict(counted)


def find_imprecise(records: Iterable[dict]) -> dict[str, tuple[int, int]]:
    """Rules of which the findings on heads were surely true less often than 9 times in 10, badly said ones counted as
    true: how many of how many, in their newest batches up to NEWEST findings. Surely: of a rule that is right 9 times
    in 10, fewer than one sample in 20 has as many false ones. Release trees do not count, since what is right about
    them is rare: they built. A rule with fewer than three findings, or with all of them in one repository, is
    left out."""
    rules: dict[str, list[dict]] = defaultdict(list)
    for record in sorted(records, key=lambda record: record["batch"], reverse=True):
        if "tag" not in record:
            rules[record["rule"]].append(record)
    found = {}
    for rule, rows in rules.items():
        rows = rows[:NEWEST]
        right = sum(row["verdict"] != "false" for row in rows)
        if len(rows) > 2 and len({row["repo"] for row in rows}) > 1 and binom.cdf(right, len(rows), 0.9) < 0.05:
            found[rule] = right, len(rows)
    return found


def format_imprecise(found: Mapping[str, tuple[int, int]]) -> str:
    """What find_imprecise() found as the rules read it: they are previews by it."""
    head = "# Previews: of how many judged findings how many were true. `benchmarks/verdicts.py precision` writes it.\n"
    return head + "".join(f"{rule} = [{right}, {of}]\n" for rule, (right, of) in sorted(found.items()))


def _list_jobs(clones: Sequence[mining.Clone], records: Iterable[dict]) -> list[tuple[tuple, list[dict]]]:
    """The trees that verdicts are about with their records, as far as their clones are here."""
    by_name = {clone.name.lower(): clone for clone in clones}
    trees: dict[tuple[str, str, tuple[str, ...]], list[dict]] = defaultdict(list)
    for record in records:
        day = f"@{record['day']}" if record.get("day") else ""
        targets = (record["distro"] + day,) if record.get("distro") else ()
        revision = (record.get("commit") or record["tag"]).removeprefix("HEAD@")
        trees[record["repo"], revision, targets].append(record)
    return [
        ((by_name[repo.lower()], revision, targets), rows)
        for (repo, revision, targets), rows in trees.items()
        if repo.lower() in by_name
    ]


def recheck(clones: Path, batch: str, jobs: int) -> int:
    records = judged(first_sight.BATCHES, batch)
    trees = _list_jobs(mining.find_clones(clones, sorted({record["repo"] for record in records})), records)
    back = asked = 0
    with ProcessPoolExecutor(jobs) as pool:
        for (_, rows), said in zip(trees, pool.map(check_commit, [job for job, _ in trees]), strict=True):
            if said is None:
                continue
            asked += len(rows)
            again, gone = compare(rows, said)
            back += len(again)
            for word, found in (("false and back", again), ("right and gone", gone)):
                for row in found:
                    print(f"{word}: {row['repo']} {row['path']}:{row['line']} {row['rule']} {row['subject']}")
    print(f"{asked} of {len(records)} findings asked again, {back} that were judged false are back")
    return 1 if back else 0


def draw(args: argparse.Namespace) -> None:
    names = first_sight.read_names([first_sight.BATCHES / f"{args.batch}.repos.txt"])
    clones = mining.find_clones(args.clones, names)
    heads = [(c, first_sight.run_git(c.folder, "rev-parse", "HEAD").strip(), ()) for c in clones]
    found: list[dict] = []
    with ProcessPoolExecutor(args.jobs) as pool:
        for said in pool.map(partial(check_commit, preview=args.preview), heads):
            found += said or ()
    chosen = choose(found, args.number, args.share_errors, args.seed)
    first_sight.write_records(args.out, chosen)
    severities = Counter(finding["severity"] for finding in found)
    print(f"{len(chosen)} of {severities['error']} errors and {severities['warning']} warnings in {len(heads)} heads")


def main(given: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    drawn, again = commands.add_parser("draw"), commands.add_parser("recheck")
    for command in (drawn, again):
        command.add_argument("--clones", type=Path, required=True)
        command.add_argument("--batch", required=command is drawn, default="")
        command.add_argument("--jobs", type=int, default=2)
    drawn.add_argument("--out", type=Path, required=True)
    drawn.add_argument("--number", type=int, default=100)
    drawn.add_argument("--share-errors", type=float, default=0.5)
    drawn.add_argument("--seed", type=int, default=first_sight.SEED)
    drawn.add_argument("--preview", action="store_true")
    commands.add_parser("precision").add_argument("file", type=Path)
    args = parser.parse_args(given)
    if args.command == "draw":
        draw(args)
    elif args.command == "recheck":
        return recheck(args.clones, args.batch, args.jobs)
    else:
        counted = count_precision(judged(first_sight.BATCHES))
        args.file.write_text(json.dumps(counted, indent=1) + "\n", encoding="utf-8")
        found = find_imprecise(judged(first_sight.BATCHES))
        args.file.with_name("imprecise.toml").write_text(format_imprecise(found), encoding="utf-8")
        for rule, (right, of) in sorted(found.items()):
            print(f"{rule}: {right} of its newest {of} findings on heads were true")
    return 0


if __name__ == "__main__":
    sys.exit(main())
