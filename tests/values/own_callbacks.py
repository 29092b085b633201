"""Callbacks of our own, in callbacks/: ten as they occur on robots, and more for kinds of crashes and parts of C++.

`// NAME KIND` behind a line marks where a callback crashes, and how. What becomes of the values of its fields stands in
callbacks/expected.txt; write that file anew with

    python tests/values/own_callbacks.py > tests/values/callbacks/expected.txt

and read the difference.
"""

from __future__ import annotations

import functools
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from unittest import mock

from rosimpact.impact.analysis.values import explore_values
from rosimpact.impact.values import survey
from rosimpact.impact.values.answers import CallbackAnswer, FieldSets
from rosimpact.impact.values.outcomes import Bounds, CrashKind, Reaction

FOLDER = Path(__file__).parent / "callbacks"
WORKSPACES = ("ten", "roscpp", "rclcpp", "python")
_MARK = re.compile(r"(?://|#) (\w+) ([A-Z_]+)$")
_CALLBACK = re.compile(r"(?:void|def) (on\w+)\(|\[this\]\(")


@functools.cache
def explore_own(name: str) -> dict[str, CallbackAnswer]:
    """The callbacks of a workspace with replays, by the last part of their names, within bounds that no time limits."""
    patient = functools.partial(survey.evaluate, seconds=900.0)
    with mock.patch.object(survey, "evaluate", patient):
        answer = explore_values(FOLDER / name, bounds=Bounds(seconds=900.0), replays=True, publishers=False, jobs=2)
    return {_shorten(one.callback): one for one in answer.report.callbacks}


def list_names(name: str) -> list[str]:
    """The callbacks of a workspace, as its sources have them."""
    return [found or "lambda" for path in _list_sources(name) for found in _CALLBACK.findall(path.read_text())]


def list_marked(name: str) -> dict[str, set[tuple[CrashKind, int]]]:
    """The crashes that are marked in the sources of a workspace, by callback."""
    found: dict[str, set[tuple[CrashKind, int]]] = {}
    for path in _list_sources(name):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if mark := _MARK.search(line):
                found.setdefault(mark[1], set()).add((CrashKind[mark[2]], number))
    return found


def read_expected() -> dict[str, list[str]]:
    """The lines of expected.txt by callback: `WORKSPACE NAME`."""
    found: dict[str, list[str]] = {}
    rows: list[str] = []
    for line in (FOLDER / "expected.txt").read_text().splitlines():
        if line.startswith("  "):
            rows.append(line.strip())
        elif line:
            rows = found.setdefault(line, [])
    return found


def describe(answer: CallbackAnswer) -> Iterator[str]:
    """What becomes of each field, a line each. Of sets that are relational only that they are there is said: their ends
    hang on the solver."""
    if answer.reason:
        yield answer.reason
    for one in answer.fields:
        yield _describe_field(one)
    if answer.unknown or answer.left:
        yield f"unknown: {', '.join(sorted(answer.unknown)) or 'ways that were not ended'}"


def _describe_field(field: FieldSets) -> str:
    parts = [field.path]
    for reaction in Reaction:
        values = field.sets.get(reaction)
        if values is None or values.is_empty():
            continue
        parts.append(f"{reaction.value} {'relational' if values.is_relational else _spell(values)}")
    return "  ".join(parts)


def _spell(values) -> str:
    shown = [repr(each) for each in sorted(values.texts)] if values.texts is not None else []
    shown += [f"{low}" if low == high else f"{low}..{high}" for low, high in values.spans]
    shown += [str(each) for each in values.infinities]
    return ", ".join([*shown, *(["nan"] if values.has_nan else [])])


def _shorten(name: str) -> str:
    last = re.split(r"::|\.", name)[-1]
    return last.partition("@")[0] if last.startswith("lambda") else last


def _list_sources(name: str) -> list[Path]:
    return sorted(path for path in (FOLDER / name).rglob("*") if path.suffix in (".cpp", ".py"))


def main(names: list[str]) -> None:
    for workspace in names or WORKSPACES:
        for name, answer in explore_own(workspace).items():
            print(f"{workspace} {name}")
            for line in describe(answer):
                print(f"  {line}")
            for one in answer.examples:
                if not one.confirmed:
                    print(f"{workspace} {name}: not confirmed: {one.result.value} {one.note}", file=sys.stderr)


if __name__ == "__main__":
    main(sys.argv[1:])
