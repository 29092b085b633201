"""Measures how right `check` is on repositories it has never met, and keeps the figures in a ledger.

A batch is a set of files benchmarks/batches/NAME.*:
    NAME.repos.txt        the repositories, drawn at random from rosdistro, and applications that it does not list
    NAME.breaks.jsonl     commits that repaired a broken build or dependency, each confirmed by a reader of its diff
    NAME.releases.jsonl   release trees that the build farm built; with `evidence` "ci": trees of a tag, or the newest
                          commit, that the repository's own CI builds for the distro
A batch is scored once before anybody has seen what the tool says about it. That row of the ledger is first sight; it
is never replaced, and later rows of the same batch are of material that was learned from.

usage: first_sight.py draw --distros FOLDER --exclude FILE... [--number 100] [--share-ros2 0.6] [--seed N]
       first_sight.py mine --clones FOLDER --repos FILE --out FILE [--exclude FILE...] [--number 320] [--seed N]
       first_sight.py releases --clones FOLDER --repos FILE --history history.sqlite.zst --out FILE
                               [--exclude FILE...] [--breaks FILE] [--seed N]
       first_sight.py score --batch NAME --score score.py --clones FOLDER [--out FILE] [--jobs 2]
       first_sight.py show
       first_sight.py plot FILE.svg

`--distros`: distribution files as DISTRO/distribution.yaml. `--clones`: git repositories as OWNER+NAME/repo,
OWNER+NAME or OWNER/NAME. `--exclude`: files of repositories that were used before; commits that a clone of one of them
has too are left out. `--history`: see released.py. What `mine` gives are candidates, see mining.py. `--score`: the
judgement, as for breaks.py.
"""

from __future__ import annotations

import argparse
import json
import random
import re
import subprocess
from collections import Counter, defaultdict
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from datetime import datetime, timezone
from importlib.util import find_spec
from pathlib import Path

import breaks
import mining
import released
import yaml

ROOT = Path(__file__).parents[1]
LEDGER = Path(__file__).with_name("first_sight.jsonl")
BATCHES = Path(__file__).with_name("batches")
SEED = 20261123
_UNWANTED = ("-release", "_release", "-gbp", "_vendor")


def read_names(files: Iterable[Path]) -> list[str]:
    """The repositories OWNER/NAME of files with one on each line."""
    return [line.strip() for file in files for line in file.read_text(encoding="utf-8").splitlines() if line.strip()]


def read_records(file: Path) -> list[dict]:
    return [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()] if file.exists() else []


def write_records(file: Path, records: Iterable[dict]) -> None:
    file.write_text("".join(json.dumps(record) + "\n" for record in records), encoding="utf-8")


def draw(distros: Path, excluded: Iterable[str], number: int, share_ros2: float, seed: int) -> list[str]:
    """GitHub repositories of rosdistro in random order, those of ROS 2 (of both generations too) as often as
    `share_ros2` says. Left out: excluded ones and those of the same name (forks, repositories that moved), those that
    release no package, release repositories, and packages that only wrap a library."""
    generations: dict[str, set[int]] = defaultdict(set)
    releases = set()
    for file in sorted(distros.glob("*/distribution.yaml")):
        listed = yaml.load(file.read_bytes(), Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))
        for entry in listed["repositories"].values():
            url = (entry.get("source") or entry.get("doc") or {}).get("url", "")
            name = re.match(r"https?://github\.com/([^/]+/[^/]+?)(?:\.git)?/?$", url)
            if name:
                generations[name[1]].add(1 if file.parent.name in mining.ROS1 else 2)
                if entry.get("release"):
                    releases.add(name[1])
    seen = {name.lower().rpartition("/")[2] for name in excluded}
    names = sorted(releases)
    ros2 = [name for name in names if 2 in generations[name]]
    ros1 = [name for name in names if 2 not in generations[name]]
    chance = random.Random(seed)
    for own in (ros2, ros1):
        chance.shuffle(own)
        own[:] = [name for name in own if name.lower().split("/")[1] not in seen and not name.endswith(_UNWANTED)]
    order: list[str] = []
    taken = 0
    while len(order) < number and (ros2 or ros1):
        from_ros2 = bool(ros2) and (not ros1 or taken < share_ros2 * (len(order) + 1))
        order.append((ros2 if from_ros2 else ros1).pop(0))
        taken += from_ros2
    return order


def find_revision(root: Path, ledger: Path) -> str:
    """The commit that is checked out. Raises SystemExit if a file but the ledger differs from it, or is not in it."""
    status = run_git(root, "status", "--porcelain", "-z").split("\0")
    ours = (line[3:] for line in status if line and not line.endswith("__pycache__/"))
    changed = [name for name in ours if root / name != ledger]
    if changed:
        raise SystemExit(f"first_sight: not scored, {changed[0]} is not committed; a row of the ledger names a commit")
    return run_git(root, "rev-parse", "HEAD").strip()


def run_git(root: Path, *command: str) -> str:
    return subprocess.run(["git", *command], cwd=root, capture_output=True, text=True, check=True).stdout


def summarize(judged: list[dict], trees: list[dict]) -> dict:
    """The figures of one row: what score.py says of each break and each release tree, counted. Raises SystemExit if
    more than 5 % of either have no repository at hand."""
    for name, rows in (("breaks", judged), ("releases", trees)):
        absent = sum(row["result"] == "no repository" for row in rows)
        if not rows or absent > 0.05 * len(rows):
            raise SystemExit(f"first_sight: not scored, {absent} of {len(rows)} {name} have their repository here")
    judged, trees = ([row for row in rows if row["result"] != "no repository"] for rows in (judged, trees))
    found = [row for row in judged if row["result"] == "found"]
    hard = [row for row in judged if row["tier"] == "A" and row["hardness"] == "hard"]
    packages = sum(tree["packages"] for tree in trees)
    families = Counter(row["family"] for row in judged)
    found_families = Counter(row["family"] for row in found)
    return {
        "breaks": len(judged),
        "found": len(found),
        "found_as_error": sum(row["error"] for row in found),
        "recall": round(len(found) / len(judged), 3),
        "as_errors": round(sum(row["error"] for row in found) / len(judged), 3),
        "tier_a_hard": len(hard),
        "tier_a_hard_found": sum(row["result"] == "found" for row in hard),
        "families": {family: [found_families[family], number] for family, number in sorted(families.items())},
        "trees": len(trees),
        "packages": packages,
        "packages_with_error": sum(tree["alarmed"] for tree in trees),
        "warnings_per_package": round(sum(tree["warnings"] for tree in trees) / max(1, packages), 3),
        "failed": sum(row["result"] == "failed" for row in judged + trees),
    }


def append_row(ledger: Path, batch: str, commit: str, figures: dict) -> dict:
    """Adds a row to the ledger; it is first sight if no row of this batch is there."""
    first = all(row["batch"] != batch for row in read_records(ledger))
    today = datetime.now(timezone.utc).date().isoformat()
    row = {"date": today, "commit": commit, "batch": batch, "first_sight": first, **figures}
    with ledger.open("a", encoding="utf-8") as lines:
        lines.write(json.dumps(row) + "\n")
    return row


def score(args: argparse.Namespace) -> dict:
    """Scores a batch and adds the row to the ledger. Raises SystemExit if the rosimpact that would be asked is another
    than the one beside this file."""
    asked = find_spec("rosimpact.impact")
    if not asked or not asked.origin or Path(asked.origin).resolve().parents[1] != Path(__file__).resolve().parents[1]:
        raise SystemExit(f"first_sight: not scored, rosimpact is installed from {asked and asked.origin}")
    commit = find_revision(ROOT, LEDGER)
    files = [BATCHES / f"{args.batch}.{kind}.jsonl" for kind in ("breaks", "releases")]
    setting = (str(args.score), str(args.clones), str(files[0]))
    with ProcessPoolExecutor(args.jobs, initializer=breaks.start, initargs=setting) as pool:
        judged = list(pool.map(breaks.one_break, read_records(files[0])))
        trees = list(pool.map(breaks.one_negative, read_records(files[1])))
    if args.out:
        write_records(args.out, judged + trees)
    return append_row(LEDGER, args.batch, commit, summarize(judged, trees))


def read_batches(ledger: Path) -> list[dict]:
    """The rows of the ledger that are about breaks; others have figures of their own, see field_sight.py."""
    return [row for row in read_records(ledger) if "breaks" in row]


def format_table(rows: list[dict]) -> str:
    """The rows of the ledger about breaks as a table of Markdown; others are about other questions."""
    lines = [
        "| date | commit | batch | sight | breaks | recall | as errors | hard, tier A | packages | with an error "
        "| warnings each |",
        "|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    for row in filter(_is_of_breaks, rows):
        sight = "first sight" if row["first_sight"] else "learned"
        lines.append(
            f"| {row['date']} | {row['commit'][:8]} | {row['batch']} | {sight} | {row['breaks']} | {row['recall']:.3f} "
            f"| {row['as_errors']:.3f} | {row['tier_a_hard_found']}/{row['tier_a_hard']} | {row['packages']} "
            f"| {row['packages_with_error']} | {row['warnings_per_package']:.2f} |"
        )
    return "\n".join(lines)


def _is_of_breaks(row: dict) -> bool:
    return "breaks" in row


def plot(rows: list[dict], file: Path) -> None:
    """Draws recall over the rows of the ledger: batches at first sight as a curve, learned ones as single marks."""
    import matplotlib.pyplot as plt

    rows = list(filter(_is_of_breaks, rows))
    figure, axes = plt.subplots(figsize=(7, 4))
    for key, label, colour in (("recall", "found", "tab:blue"), ("as_errors", "found as an error", "tab:red")):
        for first, style in ((True, "o-"), (False, "x")):
            points = [(at, row[key]) for at, row in enumerate(rows) if row["first_sight"] == first]
            if points:
                name = f"{label}, {'at first sight' if first else 'learned'}"
                axes.plot(*zip(*points, strict=True), style, color=colour, label=name)
    axes.set_xticks(range(len(rows)), [f"{row['batch']}\n{row['commit'][:8]}" for row in rows], fontsize=7)
    axes.set_ylim(0, 1)
    axes.set_ylabel("share of the breaks")
    axes.legend()
    figure.savefig(file, bbox_inches="tight")
    plt.close(figure)


def read_arguments(given: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    drawn = commands.add_parser("draw")
    drawn.add_argument("--distros", type=Path, required=True)
    mined, trees = commands.add_parser("mine"), commands.add_parser("releases")
    for command in (mined, trees):
        command.add_argument("--clones", type=Path, required=True)
        command.add_argument("--repos", type=Path, required=True)
        command.add_argument("--out", type=Path, required=True)
    mined.add_argument("--per-family", type=int, default=6)
    mined.add_argument("--since", default="2013-01-01")
    mined.add_argument("--share-recent", type=float, default=0.55)
    trees.add_argument("--history", type=Path, required=True)
    trees.add_argument("--breaks", type=Path)
    trees.add_argument("--per-repository", type=int, default=3)
    for command, number in ((drawn, 100), (mined, 320), (trees, 1_000_000)):
        command.add_argument("--exclude", type=Path, nargs="*", default=[])
        command.add_argument("--number", type=int, default=number)
        command.add_argument("--share-ros2", type=float, default=0.6)
        command.add_argument("--seed", type=int, default=SEED)
    scored = commands.add_parser("score")
    scored.add_argument("--batch", required=True)
    scored.add_argument("--score", type=Path, required=True)
    scored.add_argument("--clones", type=Path, required=True)
    scored.add_argument("--out", type=Path)
    scored.add_argument("--jobs", type=int, default=2)
    commands.add_parser("show")
    commands.add_parser("plot").add_argument("file", type=Path)
    return parser.parse_args(given)


def main(given: list[str] | None = None) -> None:
    args = read_arguments(given)
    excluded = mining.find_clones(args.clones, read_names(args.exclude)) if args.command in ("mine", "releases") else []
    if args.command == "draw":
        print("\n".join(draw(args.distros, read_names(args.exclude), args.number, args.share_ros2, args.seed)))
    elif args.command == "mine":
        clones = mining.find_clones(args.clones, read_names([args.repos]))
        found = [r for clone in clones for r in mining.mine(clone, args.since, args.per_family, args.seed)]
        known = mining.find_known(excluded, (record["fix"] for record in found))
        found = [record for record in found if record["fix"] not in known]
        chosen = mining.select(found, args.number, args.seed, args.share_recent, args.share_ros2)
        write_records(args.out, ({k: v for k, v in record.items() if k != "weight"} for record in chosen))
        print(f"{len(chosen)} candidates of {len(found)} from {len(clones)} repositories")
    elif args.command == "releases":
        repaired = read_records(args.breaks) if args.breaks else []
        with released.open_history(args.history) as history:
            sources = released.find_sources(history)
            found = []
            for clone in mining.find_clones(args.clones, read_names([args.repos])):
                found += released.find_releases(clone, history, sources, repaired, args.per_repository, args.seed)
        known = mining.find_known(excluded, (record["commit"] for record in found))
        found = [record for record in found if record["commit"] not in known]
        chosen = released.select(found, args.number, args.share_ros2, args.seed)
        write_records(args.out, chosen)
        packages = sum(len(record["packages"]) for record in chosen)
        print(f"{len(chosen)} trees of {len({r['repo'] for r in chosen})} repositories, {packages} packages")
    elif args.command == "score":
        print(format_table([score(args)]))
    elif args.command == "show":
        print(format_table(read_batches(LEDGER)))
    else:
        plot(read_batches(LEDGER), args.file)


if __name__ == "__main__":
    main()
