"""BugReport and Label: what was reported, and what it was judged to be; their files, one JSON object a line.

The labels and what each means are in GUIDE.md; those of the corpus are in labels.jsonl beside this file.
Texts of reports belong to those who wrote them and are in no file of the project: they are gathered again by id.
"""

from __future__ import annotations

import codecs
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TypeVar

import msgspec

from ..edges.console import UserError
from ..edges.files import open_for_replacing, open_regular
from ..edges.limits import format_size, get_limits

LABELS = ("library-update", "dependency", "inconsistency", "message-logic", "other")
KINDS = {
    "library-update": ("ros", "system", "robot"),
    "dependency": ("undeclared", "unavailable", "build-order", "wrong"),
    "inconsistency": ("value", "frame-time", "type", "connection"),
}
"""Kinds of the labels that have some."""
PHASES = ("build", "install", "run", "none")
SOURCES = ("github", "ros-answers", "robotics-se")
WORDINGS = ("original", "abridged")
LABELS_FILE = Path(__file__).parent / "labels.jsonl"

_Row = TypeVar("_Row", bound=msgspec.Struct)


class CorpusError(UserError):
    """What was asked for cannot be done; the text names the file or place and what to do."""


class BugReport(msgspec.Struct, frozen=True, omit_defaults=True):
    """One GitHub issue or pull request, ROS Answers question or Robotics Stack Exchange question.

    id: `owner/name#12`, `ros-answers:10010` or `robotics-se:98659`; unique. url: where it can be read. source: one of
    SOURCES. date: the ISO day it was posted, None where that is not known. body: as posted, in Markdown. wording:
    `original`, or `abridged` where only a shortened text is at hand. kind: `issue`, `pull` or `question`. tags: labels
    or tags it carries. author: the public name of who wrote it, for attribution, and nothing else of the person.
    licence: of the text, as SPDX names it, empty where the source states none. same_as: id of the report that this one
    is a migrated copy of, or empty.
    """

    id: str
    url: str
    source: str
    date: str | None
    title: str
    body: str
    wording: str = "original"
    kind: str = "issue"
    tags: tuple[str, ...] = ()
    author: str = ""
    licence: str = ""
    same_as: str = ""

    @property
    def group(self) -> str:
        """Its find_group()."""
        return find_group(self.id)


class Label(msgspec.Struct, frozen=True):
    """What a report was judged to be.

    label: one of LABELS. kind: one of KINDS[label], None for labels without kinds. phase: one of PHASES. why: the
    reason in a few words of the annotators' own. annotators: the label that each of them gave. decided: `agreed`,
    `adjudicated`, `recheck` (two annotators), `single`, `disputed` (two that differ, nobody has decided yet: the first
    one's answer stands for now) or `imported` (mapped from another study).
    """

    id: str
    label: str
    kind: str | None
    phase: str
    why: str
    annotators: tuple[str, ...]
    decided: str

    @property
    def twice(self) -> bool:
        """Whether two annotators read it."""
        return len(self.annotators) > 1


def find_repository(id: str) -> str:
    """`owner/name` of a report on GitHub, in lower case as GitHub compares them; empty for others."""
    from re import match

    found = match(r"(?:https://api\.github\.com/repos/)?([\w.-]+/[\w.-]+)(?:#|/(?:issues|pull|pulls)/)\d+\Z", id)
    return found.group(1).lower() if found else ""


def find_group(id: str) -> str:
    """What must not stand on both sides of a split: the repository, or the report itself where there is none."""
    return find_repository(id) or id


def read_reports(path: Path) -> Iterator[BugReport]:
    """The reports of a JSON Lines file, one at a time. Raises CorpusError."""
    return _read(path, BugReport, "report")


def read_labels(path: Path = LABELS_FILE) -> list[Label]:
    """The labels of a file, by default those of the corpus. Raises CorpusError when one breaks the guide's rules."""
    found: dict[str, Label] = {}
    for number, label in enumerate(_read(path, Label, "label"), 1):
        fault = find_faults(label)
        if label.id in found:
            fault = "is there twice"
        if fault:
            raise CorpusError(f"{path}:{number}: `{label.id}` {fault}; mend the line")
        found[label.id] = label
    return list(found.values())


def find_faults(label: Label) -> str:
    """What breaks the guide's rules in a label, as a clause; empty when nothing does."""
    if label.label not in LABELS:
        return f"has the label `{label.label}`, which is none of {', '.join(LABELS)}"
    kinds = KINDS.get(label.label, ())
    if label.kind not in (kinds or (None,)):
        return f"has the kind `{label.kind}`, which is none of {', '.join(kinds) or 'null'}"
    if label.phase not in PHASES:
        return f"has the phase `{label.phase}`, which is none of {', '.join(PHASES)}"
    if not label.annotators or any(given not in LABELS for given in label.annotators):
        return "names no annotator's label, or one that is none"
    return ""


def write_rows(path: Path, rows: Iterable[msgspec.Struct | msgspec.Raw]) -> int:
    """Writes rows as JSON Lines, whole or not at all. Returns how many. Raises CorpusError."""
    encode = msgspec.json.Encoder().encode
    count = 0
    try:
        with open_for_replacing(path) as file:
            for row in rows:
                file.write(encode(row) + b"\n")
                count += 1
    except OSError as error:
        raise CorpusError(f"{path}: cannot be written: {error.strerror}; give another file") from None
    return count


def _read(path: Path, kind: type[_Row], name: str) -> Iterator[_Row]:
    decoder = msgspec.json.Decoder(kind)
    longest = get_limits().text
    try:
        with open(open_regular(path), "rb") as file:
            number = 0
            while line := file.readline(longest + 1):
                number += 1
                if len(line) > longest:
                    raise CorpusError(f"{path}:{number}: is longer than {format_size(longest)}; mend the line")
                if number == 1:
                    line = line.removeprefix(codecs.BOM_UTF8)
                if not line.strip():
                    continue
                try:
                    yield decoder.decode(line)
                except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
                    raise CorpusError(f"{path}:{number}: is no {name} ({error}); mend the line") from None
    except OSError as error:
        raise CorpusError(f"{path}: cannot be read: {error.strerror}; give a JSON Lines file") from None
