"""Names in the text of a workspace: in launch files, parameter files, robot descriptions and string literals of code.

Text tells who has a name in common where nobody knows what a plugin, a driver or a program of another package makes of
it.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Collection, Iterator
from contextlib import suppress
from typing import NamedTuple

from ..package import find_folder_role
from ..workspace import Workspace

SETTINGS = frozenset(("launch_xml", "launch_yaml", "xacro", "params"))
_GIVEN = SETTINGS - {"xacro"}
_CODE = frozenset(("cpp", "python", "script"))
_NAME = r"[~/]?[A-Za-z]\w*(?:/\w+)*/?"
_IN_SETTINGS = re.compile(rf"(?<![\w/~.$@:(){{}}<-])({_NAME})(?![\w/.$(){{}}=:-])")
_IN_CODE = re.compile(rf"""(?<=["'])({_NAME})(?=["'])""")
_COMMENT = re.compile(r"\s*(?:#|//|<!--)")
_MOST_LINES = 20_000


class ReplacedName(NamedTuple):
    """A name that was replaced by another, in a line that is the same in all else."""

    path: str
    line: int
    old: str
    new: str
    kind: str


class NameMention(NamedTuple):
    """A place that has a name. whole: not only as the end of a longer one."""

    path: str
    line: int
    whole: bool


def normalise_mention(name: str) -> str:
    """A name as it is compared: without what makes it absolute or private."""
    return name.strip("~/")


def list_replaced_names(workspace: Workspace, base: Workspace) -> Iterator[ReplacedName]:
    """Names that files of both workspaces have at the same place, and that differ."""
    ids, before = workspace.extraction.ids, base.extraction.ids
    for path, kind in sorted(workspace.extraction.kinds.items()):
        if kind not in SETTINGS | _CODE or path not in before or ids.get(path) == before[path]:
            continue
        if find_folder_role(path) == "test":
            continue
        old, new = (_read_lines(each, path) for each in (base, workspace))
        pattern = _IN_SETTINGS if kind in SETTINGS else _IN_CODE
        for at, left, right in _pair_lines(old, new):
            was, now = pattern.split(left.strip()), pattern.split(right.strip())
            if len(was) == len(now) and was[::2] == now[::2] and not _COMMENT.match(right):
                for one, other in zip(was[1::2], now[1::2], strict=True):
                    if normalise_mention(one) != normalise_mention(other):
                        yield ReplacedName(path, at, one, other, kind)


def _pair_lines(old: list[str], new: list[str]) -> Iterator[tuple[int, str, str]]:
    """Line number, line before and line now, of lines that were replaced one by one."""
    if max(len(old), len(new)) > _MOST_LINES:
        return
    for tag, start, end, first, last in difflib.SequenceMatcher(None, old, new, autojunk=False).get_opcodes():
        if tag == "replace" and end - start == last - first:
            for place in range(last - first):
                yield first + place + 1, old[start + place], new[first + place]


def list_settings_names(workspace: Workspace) -> Iterator[tuple[str, tuple[NameMention, str]]]:
    """Names of several parts, and words in remappings, that launch files and parameter files have: each with its place
    and the text of its line. Arguments of programs are left out."""
    for path, kind in sorted(workspace.extraction.kinds.items()):
        if kind in _GIVEN and find_folder_role(path) != "test":
            for number, line in enumerate(_read_lines(workspace, path), 1):
                if "/" in line and not _COMMENT.match(line) and "args=" not in line:
                    remaps = "<remap" in line
                    for match in _IN_SETTINGS.finditer(line):
                        name = normalise_mention(match[1])
                        if remaps or "/" in name:
                            yield name, (NameMention(path, number, True), line.strip())


def find_mentions(workspace: Workspace, names: Collection[str]) -> dict[str, list[NameMention]]:
    """Where the text of a workspace has names: as they are, absolute or private, or at the end of longer ones."""
    found: dict[str, list[NameMention]] = {name: [] for name in names}
    patterns = [(name, *_compile_search(name)) for name in names]
    for path, kind in sorted(workspace.extraction.kinds.items()) if names else ():
        if kind not in SETTINGS | _CODE or find_folder_role(path) == "test":
            continue
        lines = _read_lines(workspace, path)
        text = "\n".join(lines)
        for name, in_settings, in_code in patterns:
            if name in text:
                pattern = in_settings if kind in SETTINGS else in_code
                for number, line in enumerate(lines, 1):
                    if name in line and not _COMMENT.match(line):
                        found[name] += (
                            NameMention(path, number, match[1].strip("~/") == "") for match in pattern.finditer(line)
                        )
    return found


def _compile_search(name: str) -> tuple[re.Pattern[str], re.Pattern[str]]:
    body = rf"([~/]*(?:[\w$(){{}}]+/)*){re.escape(name)}/?"
    return re.compile(rf"(?<![\w/.$@:-]){body}(?![\w/.$({{:-])"), re.compile(rf"""["']{body}["']""")


def _read_lines(workspace: Workspace, path: str) -> list[str]:
    with suppress(OSError):
        return workspace.read(path).decode("utf-8", "replace").split("\n")
    return []
