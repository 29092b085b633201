"""Misconfigurations that people made and mended, and whether `check` finds them: 19 bugs of ROS 1 systems (AutoRally,
Autoware, Husky, TurtleBot), published with ROSDiscover, which finds 8 of them.

A record of misconfigurations.jsonl is a fact, never text of a source: id; repo; the commits bug and fix; before: one
from before the bug came in, if known; beside: repositories of the same system, with commits; fault: what it is about;
names: the topics or parameters at fault.

A bug is found if `check --preview` at the commit bug has a finding that names one of these, and not the same one at the
commit fix. It is found with a base if the same holds for `check --preview --base`, with fix or before as the base.

usage: misconfigurations.py --clones FOLDER [--only TEXT] [--target noetic] [--out FILE]
"""

from __future__ import annotations

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import mining
from rosimpact.impact.analysis.check import check
from rosimpact.impact.analysis.session import Options

RECORDS = Path(__file__).parent / "misconfigurations.jsonl"
_DESCRIBES = "changed-trigger"  # tells what a change does, not that anything is wrong
_AUTHOR = {f"GIT_{who}_{what}": "2000-01-01T00:00Z" if what == "DATE" else "x" for who in ("AUTHOR", "COMMITTER")
           for what in ("NAME", "EMAIL", "DATE")}  # fmt: skip


class System:
    """The trees of several repositories, side by side in a repository of its own that borrows their objects."""

    def __init__(self, folder: Path, clones: Path, record: dict) -> None:
        self.folder, self.record = folder, record
        self._run("init", "-q")
        names = {record["repo"], *(repo for repo, _ in record.get("beside", ()))}
        found = mining.find_clones(clones, sorted(names))
        if missing := names - {clone.name for clone in found}:
            raise SystemExit(f"--clones {clones}: no clone of {', '.join(sorted(missing))}")
        lenders = "".join(f"{clone.folder.resolve() / 'objects'}\n" for clone in found)
        (folder / ".git/objects/info/alternates").write_text(lenders)

    def commit(self, commit: str, *parents: str) -> str:
        """The system with its first repository at a commit, as a commit with parents."""
        self._run("read-tree", "--empty")
        for number, (repo, at) in enumerate([(self.record["repo"], commit), *self.record.get("beside", ())]):
            self._run("read-tree", f"--prefix={number}_{repo.partition('/')[2]}/", at)
        tree = self._run("write-tree", "--missing-ok")
        return self._run("commit-tree", tree, "-m", "x", *(word for parent in parents for word in ("-p", parent)))

    def _run(self, *arguments: str) -> str:
        command = ["git", "-C", str(self.folder), *arguments]
        done = subprocess.run(command, capture_output=True, text=True, check=True, env={**os.environ, **_AUTHOR})
        return done.stdout.strip()


def find_faults(system: System, rev: str, target: str, base: str = "") -> dict[tuple[str, str, str], str]:
    """New findings that name what is at fault: rule, subject and path of each, and what it says."""
    names = "|".join(re.escape(name.lstrip("/")) for name in system.record["names"])
    fault = re.compile(rf"`/?(?:[\w/]+/)?(?:{names})`")
    options = Options(targets=(target,), rev=rev, base=(base,) if base else (), preview=True)
    return {
        (one.rule, one.subject, one.path): f"{one.path}:{one.line}: {one.rule}: {one.message}"
        for one in check(system.folder, options).findings
        if one.new and one.rule != _DESCRIBES and fault.search(f"`{one.subject}` {one.message}")
    }


def score(record: dict, clones: Path, target: str) -> dict:
    """What is found of a record: alone, with the fix as base, with the state before the bug as base."""
    with tempfile.TemporaryDirectory() as folder:
        system = System(Path(folder), clones, record)
        fix = system.commit(record["fix"])
        bases = {"fix": fix, **({"before": system.commit(record["before"])} if record.get("before") else {})}
        mended = find_faults(system, fix, target)
        bug = system.commit(record["bug"])
        found = {"alone": find_faults(system, bug, target)}
        for name, base in bases.items():
            found[name] = find_faults(system, system.commit(record["bug"], base), target, base)
        said = {name: [text for key, text in each.items() if key not in mended] for name, each in found.items()}
        return {"id": record["id"], **said}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--clones", type=Path, required=True)
    parser.add_argument("--only", default="")
    parser.add_argument("--target", default="noetic")
    parser.add_argument("--out", type=Path)
    args = parser.parse_args()
    records = [json.loads(line) for line in RECORDS.read_text().splitlines()]
    results = []
    for record in records:
        if args.only in record["id"]:
            results.append(score(record, args.clones, args.target))
            said = {name: len(texts) for name, texts in results[-1].items() if name != "id"}
            print(f"{record['id']}: {', '.join(f'{name} {count}' for name, count in said.items())}", flush=True)
    if args.out:
        args.out.write_text("".join(f"{json.dumps(one)}\n" for one in results))
    alone = sum(bool(one["alone"]) for one in results)
    based = sum(bool(one["fix"] or one.get("before")) for one in results)
    print(f"found of {len(results)}: {alone} without a base, {based} with one")


if __name__ == "__main__":
    sys.exit(main())
