"""Which fields callbacks read, at first sight: callbacks drawn from workspaces that nobody here had opened.

A set is benchmarks/callbacks/NAME.systems.jsonl (repo, commit) and NAME.drawn.jsonl, a record for each callback: repo,
commit, path and line (of the subscription), callback, type, fields (all leaves of the type). A reader of the sources
who has not seen the tool's answer adds
    reads   the leaves whose values the program may use, in the callback and wherever the message goes from there; of
            what is handed to code outside of the workspace, or copied whole into something that is sent or kept for
            others, all leaves below it
    wholly  true where the whole message is used so, with `why` in one clause
What the tool says is computed when it is scored, from the commit, so that a later state can be asked the same.

usage: field_sight.py draw --set NAME --clones FOLDER [--number 6] [--seed 19]
       field_sight.py score --set NAME --clones FOLDER
"""

from __future__ import annotations

import argparse
import json
import random
import sys
from collections.abc import Iterator
from pathlib import Path

import mining
from rosimpact.impact.analysis.fields import collect_fields
from rosimpact.impact.model.fields.report import SubscriberFields

SETS = Path(__file__).parent / "callbacks"


def list_callbacks(clone: mining.Clone, commit: str) -> Iterator[tuple[dict, SubscriberFields]]:
    """The subscribers of a commit that have a callback, with what the tool says of each; one for each place."""
    seen = set()
    report = collect_fields(clone.folder, rev=commit).report
    for topic in (*report.topics, *report.unnamed):
        for one in topic.subscribers:
            if one.callback and topic.fields and (one.path, one.line, topic.type) not in seen:
                seen.add((one.path, one.line, topic.type))
                record = {
                    "repo": clone.name, "commit": commit, "path": one.path, "line": one.line, "callback": one.callback,
                    "type": topic.type, "fields": list(topic.fields),
                }  # fmt: skip
                yield record, one


def score(clones: Path, systems: list[dict], records: list[dict]) -> None:
    """Prints how many fields that are read the tool does not know of, and how many that are not read it keeps."""
    missed = unread = lost = judged = handed = 0
    for system in systems:
        (clone,) = mining.find_clones(clones, [system["repo"]])
        said = {(r["path"], r["line"], r["type"]): one for r, one in list_callbacks(clone, system["commit"])}
        for record in records:
            if record["repo"] != system["repo"] or "reads" not in record:
                continue
            answer = said.get((record["path"], record["line"], record["type"]))
            if answer is None:
                print(f"{record['path']}:{record['line']}: the tool has no such subscriber")
                continue
            judged += 1
            read = set(record["fields"]) if record.get("wholly") else set(record["reads"])
            free = set(record["fields"]) - read
            handed += any(not escape.field for escape in answer.escapes)
            wrong, kept = read & set(answer.unread), free - set(answer.unread)
            missed, unread, lost = missed + len(wrong), unread + len(free), lost + len(kept)
            if wrong:
                where = f"{record['repo']} {record['path']}:{record['line']}"
                print(f"{where} {record['callback']}: missed {sorted(wrong)}")
            if kept:
                why = [f"{e.field or '*'} {e.reason} {e.path}:{e.line}" for e in answer.escapes]
                print(f"{record['path']}:{record['line']} {record['callback']}: kept {sorted(kept)}: {why}")
    share = f"{lost / unread:.1%}" if unread else "-"
    print(f"{judged} callbacks: {missed} read fields missed, {lost} of {unread} unread fields kept ({share}), "
          f"{handed} callbacks hand on the whole message")  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", choices=("draw", "score"))
    parser.add_argument("--set", required=True)
    parser.add_argument("--clones", type=Path, required=True)
    parser.add_argument("--number", type=int, default=6)
    parser.add_argument("--seed", type=int, default=19)
    options = parser.parse_args()
    drawn = SETS / f"{options.set}.drawn.jsonl"
    systems = [json.loads(line) for line in (SETS / f"{options.set}.systems.jsonl").read_text().splitlines()]
    if options.command == "score":
        score(options.clones, systems, [json.loads(line) for line in drawn.read_text().splitlines()])
        return
    with drawn.open("w") as out:
        for system in systems:
            (clone,) = mining.find_clones(options.clones, [system["repo"]])
            chance = random.Random(f"{options.seed} {clone.name} {system['commit']}")
            records = [record for record, _ in list_callbacks(clone, system["commit"])]
            for record in chance.sample(records, min(options.number, len(records))):
                out.write(json.dumps(record) + "\n")
            print(f"{system['repo']}: {len(records)} callbacks", file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
