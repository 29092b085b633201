"""`rosimpact logic` at first sight: changes drawn from histories that nobody here had opened.

A set of histories is benchmarks/histories/NAME.histories.jsonl (repo, commit), what was drawn of them and how readers
of the diffs judged it benchmarks/histories/NAME.drawn.jsonl. A record is a fact, never text of a source:
    change   a change that the tool lists: repo, commit, path, line, kind, function, topic, and how many the commit has
             of the same kind and reason (`alike`); verdict: `right`, `badly said` (publishing did change, and the
             sentence about it is not true), `not real` (when it publishes is as before), `wrong direction` (fewer cases
             said to be more, or the other way round); why: one clause; class: what kind of fault it is
    commit   a commit that changes conditions around a publish statement, found by reading `git log -p`: repo, commit,
             function; found: the tool lists a change of that commit and function (`elsewhere`: of that commit alone;
             `as gone`: the statement as gone)

usage: logic_sight.py draw --set NAME --clones FOLDER [--number 10] [--whole 4] [--seed 19]
       logic_sight.py score --set NAME
       logic_sight.py recheck --set NAME --clones FOLDER

`draw` writes records without verdicts: of each history `--number` changes of conditions, triggers and publishers, and
`--whole` statements that are new or gone. Of changes of a commit that are of one kind for one reason, one is drawn.
`score` prints the figures; `recheck` prints which judged changes the tool of today still lists, and which commits.
"""

from __future__ import annotations

import argparse
import json
import random
import subprocess
import sys
from collections import Counter, defaultdict
from collections.abc import Iterator
from pathlib import Path

import mining

SETS = Path(__file__).parent / "histories"
WHOLE = ("new", "gone")


def list_changes(folder: Path, commit: str) -> list[dict]:
    """All changes of the history of a commit, newest first."""
    command = [sys.executable, "-m", "rosimpact.impact.cli", "logic", str(folder), "--range", commit, "-q"]
    done = subprocess.run([*command, "--format", "json"], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)["changes"]


def draw(repo: str, changes: list[dict], number: int, whole: int, seed: int) -> Iterator[dict]:
    """Records of a history, each chosen at random."""
    chance = random.Random(f"{seed} {repo}")
    alike: dict[tuple[str, str, str], list[dict]] = defaultdict(list)
    for one in changes:
        alike[one["commit"], one["kind"], one["why"]].append(one)
    for wanted, count in ((False, number), (True, whole)):
        groups = [group for key, group in alike.items() if (key[1] in WHOLE) == wanted]
        for group in chance.sample(groups, min(count, len(groups))):
            one = chance.choice(group)
            about = {name: one[name] for name in ("commit", "path", "line", "kind", "function", "topic")}
            yield {"repo": repo, "record": "change", **about, "alike": len(group)}


def score(records: list[dict]) -> None:
    """Prints how right the changes are that readers judged, and how many of the commits they found are listed."""
    judged = [one for one in records if one["record"] == "change" and one.get("verdict")]
    for title, chosen in (
        ("all changes", judged),
        ("conditions, triggers, publishers", [one for one in judged if one["kind"] not in WHOLE]),
        ("statements new or gone", [one for one in judged if one["kind"] in WHOLE]),
    ):
        counted = Counter(one["verdict"] for one in chosen)
        print(f"{title}: {counted['right']} of {len(chosen)} right; {dict(counted)}")
    for name, times in Counter(one["class"] for one in judged if one.get("class")).most_common():
        print(f"  {times} {name}")
    commits = [one for one in records if one["record"] == "commit"]
    named = Counter(str(one["found"]) for one in commits)
    print(f"commits found by reading: {named['True']} of {len(commits)} listed; {dict(named)}")


def recheck(records: list[dict], listed: dict[str, list[dict]]) -> None:
    """Prints how many of the judged changes the tool of today lists, by verdict: right ones that it lost, others that
    it kept."""
    kept: dict[str, Counter[bool]] = defaultdict(Counter)
    for one in records:
        changes = listed[one["repo"]]
        if one["record"] == "commit":
            functions = {
                change["function"].replace("::", ".").rpartition(".")[2]
                for change in changes
                if change["commit"] == one["commit"]
            }
            now = one["function"] in functions or ("elsewhere" if functions else False)
            kept[f"commit, {one['found']} at first sight"][now is True] += 1
            if (now is True) != (one["found"] is True):
                print(f"{one['repo']} {one['commit'][:10]} {one['function']}: {now}, was {one['found']}")
        elif one.get("verdict"):
            about = ("commit", "path", "line", "kind", "function")
            now = any(all(change[name] == one[name] for name in about) for change in changes)
            kept[one["verdict"]][now] += 1
            if now != (one["verdict"] == "right"):
                said = f"{one['commit'][:10]} {one['path']}:{one['line']} {one['kind']}"
                print(f"{one['repo']} {said}: {one['verdict']}, {'still' if now else 'no longer'} listed")
    for verdict, count in kept.items():
        print(f"{verdict}: {count[True]} of {sum(count.values())} listed")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", choices=("draw", "score", "recheck"))
    parser.add_argument("--set", required=True)
    parser.add_argument("--clones", type=Path)
    parser.add_argument("--number", type=int, default=10)
    parser.add_argument("--whole", type=int, default=4)
    parser.add_argument("--seed", type=int, default=19)
    options = parser.parse_args()
    drawn = SETS / f"{options.set}.drawn.jsonl"
    if options.command == "score":
        score(_read(drawn))
        return
    histories = _read(SETS / f"{options.set}.histories.jsonl")
    listed: dict[str, list[dict]] = {}
    for history in histories:
        (clone,) = mining.find_clones(options.clones, [history["repo"]])
        listed[history["repo"]] = list_changes(clone.folder, history["commit"])
    if options.command == "recheck":
        recheck(_read(drawn), listed)
        return
    with drawn.open("w") as out:
        for repo, changes in listed.items():
            for record in draw(repo, changes, options.number, options.whole, options.seed):
                out.write(json.dumps(record) + "\n")


def _read(file: Path) -> list[dict]:
    return [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()]


if __name__ == "__main__":
    main()
