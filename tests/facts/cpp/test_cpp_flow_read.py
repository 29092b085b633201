"""Guards of publish statements in real nodes, as a person read them, against what is extracted.

data/guards_read.jsonl was chosen for its variety and read beside the extractor while that grew; guards_read_blind.jsonl
was drawn at random from what a regular expression finds, and read before anything was extracted.
The sources come from mirrors (bare git directories, `owner+name/repo`) in the folder that ROSIMPACT_MIRROR names."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import pytest
from rosimpact.impact.facts.cpp.flow import extract

DATA = Path(__file__).parent / "data"
RIGHT_AT_LEAST = 39 / 40


def source(mirror: Path, site: dict) -> bytes | None:
    """The file of a site, None where there is no mirror that has it."""
    folder = mirror / site["repository"].replace("/", "+") / "repo"
    if not folder.is_dir():
        return None
    shown = subprocess.run(
        ["git", "-C", str(folder), "show", f"{site['commit']}:{site['path']}"], capture_output=True, check=False
    )
    return shown.stdout if shown.returncode == 0 else None


def guards_of_publish(data: bytes, line: int) -> list[list[list[str]]]:
    """The guards, from the outside in, of each call of `publish` on a line."""
    found = []
    for function in extract(data).functions:
        for call in function.calls:
            if call.line == line and call.callee.rpartition(".")[2] == "publish":
                guards = []
                place = call.guard
                while place >= 0:
                    guard = function.guards[place]
                    guards.insert(0, [guard.kind, guard.text])
                    place = guard.outer
                found.append(guards)
    return found


@pytest.mark.parametrize("read", ["guards_read.jsonl", "guards_read_blind.jsonl"])
def test_guards_are_those_that_a_person_reads(read):
    mirror = os.environ.get("ROSIMPACT_MIRROR")
    if not mirror:
        pytest.skip("ROSIMPACT_MIRROR names no folder of mirrors")
    wrong = []
    seen = 0
    for site in map(json.loads, (DATA / read).read_text().splitlines()):
        data = source(Path(mirror), site)
        if data is None:
            continue
        seen += 1
        found = guards_of_publish(data, site["line"])
        if found != [site["guards"]]:
            wrong.append((site["path"], site["line"], found))
    if not seen:
        pytest.skip("ROSIMPACT_MIRROR holds none of the repositories that were read")
    assert seen - len(wrong) >= RIGHT_AT_LEAST * seen, wrong
