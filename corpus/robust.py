"""ROBUST's bug records as labels: what their codes say of ours, and how sure that is.

ROBUST (robust-rosin/robust, "ROBUST: 221 bugs in the Robot Operating System", Empirical Software Engineering 29, 2024)
keeps one YAML file, `.bug`, for each bug. Its codes describe the fault in the code as the fix shows it; a label here
describes what the reporter tells. So the two meet only in part, and what does not meet stays unmapped. docs/labels.md
has the mapping as a table. Nothing of a record's text is taken: ids, codes and the address of the report are.
"""

from __future__ import annotations

import errno
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import msgspec

from ..edges.documents import DocumentError, load_yaml_as_text
from ..edges.files import read_file
from ..edges.limits import get_limits
from .report import KINDS, CorpusError, Label

LIKELY, SURE, UNMAPPED = "likely", "sure", "unmapped"
CONFIDENCES = (SURE, LIKELY, UNMAPPED)
"""sure: all of a record's fault codes say the same, and label and kind follow from them. likely: they say it beside
something else, or the kind is the commonest one. unmapped: only the report itself can tell."""

_EVOLUTION_KINDS = {"LANGUAGE": "system", "PACKAGE": "ros", "FIRMWARE": "robot", "ROBOT": "robot"}
# What else the record says of the thing that changed, where the code does not.
_EVOLUTION_WORDS = (
    ("robot", re.compile(r"\b(?:gazebo|firmware|sdf|rws)\b", re.IGNORECASE)),
    ("system", re.compile(r"\b(?:boost|qt|gcc|c\+\+|python|opencv|eigen|ubuntu|compiler)(?![\w+])", re.IGNORECASE)),
)
_LINK = ("TOPIC", "REMAPPING", "NAMESPACE")
_GITHUB = re.compile(r"https?://github\.com/([\w.-]+/[\w.-]+)/(?:issues|pull)/(\d+)")
_ANSWERS = re.compile(r"https?://answers\.ros\.org/question/(\d+)")
_EMPTY = ("", "null", "n/a", "none", "~")
_PHASES = {"build": "build", "deployment": "install", "startup": "run", "runtime": "run", "does not apply": "none"}
_LICENCES = ("LICENSE*", "LICENCE*", "COPYING*", "license*", "licence*")


class Mapped(msgspec.Struct, frozen=True, omit_defaults=False):
    """A record and what it maps to.

    id: of the report, as the corpus writes it, or `robust:RECORD` where none is public. record: the name of the
    record's file, which is its id. label, kind, phase: None where they do not follow. confidence: one of CONFIDENCES.
    codes: its fault codes. why: the reason for the mapping, in our words.
    """

    id: str
    record: str
    label: str | None
    kind: str | None
    phase: str | None
    confidence: str
    codes: tuple[str, ...]
    why: str


class MappedRow(Label, frozen=True):
    """A mapped record as a line of a labels file; whoever reads labels passes over what it has beyond a Label."""

    confidence: str
    record: str


class CodesVerdict(NamedTuple):
    """What codes say: label, kind, confidence and the reason."""

    label: str | None
    kind: str | None
    confidence: str
    why: str


class Records(NamedTuple):
    """The records of a folder: what could be mapped or not, what could not be read (file and why), and the licence."""

    mapped: list[Mapped]
    unreadable: list[tuple[Path, str]]
    licence: str


def read_robust(folder: Path) -> Records:
    """All `.bug` records below a folder, in the order of their paths. Raises CorpusError when there is none."""
    if not folder.is_dir():
        raise CorpusError(f"{folder}: is no folder; give a clone of github.com/robust-rosin/robust")
    mapped: list[Mapped] = []
    unreadable: list[tuple[Path, str]] = []
    for path in sorted(folder.rglob("*.bug")):
        try:
            mapped.append(map_record(_parse_record(path), path.stem))
        except ValueError as error:
            unreadable.append((path, str(error)))
    if not mapped:
        told = f"; {unreadable[0][0]}: {unreadable[0][1]}" if unreadable else ""
        raise CorpusError(f"{folder}: holds no record of ROBUST that can be read{told}; give a clone of its repository")
    return Records(mapped, unreadable, describe_licence(folder))


def map_record(record: Mapping[str, Any], stem: str) -> Mapped:
    """One record, as YAML gives it with every scalar as text. stem: its file's name, which is its id; the `id` inside
    is now and then another record's."""
    bug = record["bug"] if isinstance(record.get("bug"), Mapping) else {}
    codes = _clean_texts(record.get("fault-codes"))
    failures = _clean_texts(record.get("failure-codes"))
    classification = " ".join(_clean_text(record.get("classification")).split())
    words = " ".join([*_clean_texts(record.get("keywords")), classification, _clean_text(record.get("title"))])
    severity = _clean_text(record.get("severity"))
    found = judge_record(codes, failures, classification, words, severity)
    phase = _PHASES.get(_clean_text(bug.get("phase")))
    if phase and found.label and "SOFTWARE:NONE" in failures and severity != "error":
        phase = "none"  # nothing is shown failing
    # The issue, else the pull request that mended it.
    id = find_report(_clean_text(bug.get("issue"))) or _find_pull(record) or f"robust:{stem}"
    return Mapped(
        id, stem, found.label, found.kind, phase if found.label else None, found.confidence, tuple(codes), found.why
    )


def judge_record(
    codes: Sequence[str], failures: Sequence[str], classification: str, words: str, severity: str = "error"
) -> CodesVerdict:
    """What a record's codes say. codes, failures: its fault and failure codes, `FAMILY:NAME`. words: keywords,
    classification and title, in which the kind is looked for where codes do not give it."""
    if severity == "not-a-bug" or "NOT-A-BUG" in codes:
        return CodesVerdict(None, None, UNMAPPED, "ROBUST counts it as no bug")
    if not codes:
        return CodesVerdict(None, None, UNMAPPED, "no fault code")
    families: dict[str, list[str]] = {}
    for code in codes:
        family, _, name = code.partition(":")
        families.setdefault(family, []).append(name)
    told = ", ".join(codes)
    evolved = [name for name in families.get("EVOLUTION", ()) if name != "DOCS"]
    if evolved:
        kind, certain = _find_evolution_kind(evolved, words)
        alone = set(families) == {"EVOLUTION"}
        return CodesVerdict("library-update", kind, SURE if alone and certain else LIKELY, f"ROBUST: {told}")
    linked = any(name in _LINK for name in families.get("CONFIG", ()))
    if re.search(r"installation dependenc", classification, re.IGNORECASE):
        return CodesVerdict("other", None, LIKELY, f"ROBUST: {told}, the package's own files are not installed")
    if "DEPENDENCY" in families.get("BDO", ()):
        if linked:
            return CodesVerdict(
                None, None, UNMAPPED, f"ROBUST: {told}; which of the two causes counts is in the report"
            )
        kind, certain = _find_dependency_kind(classification, words)
        alone = set(codes) <= {"BDO:DEPENDENCY", "BDO:BUILD"}
        return CodesVerdict("dependency", kind, SURE if alone and certain else LIKELY, f"ROBUST: {told}")
    if "BUILD" in families.get("BDO", ()) and re.search(r"dependenc", classification, re.IGNORECASE):
        kind, _ = _find_dependency_kind(classification, words)
        return CodesVerdict("dependency", kind, LIKELY, f"ROBUST: {told}, {_strip_marks(classification)}")
    if linked:
        return CodesVerdict("inconsistency", "connection", LIKELY, f"ROBUST: {told}")
    if "TRANSFORMATIONS" in families.get("MODELS", ()):
        return CodesVerdict("inconsistency", "frame-time", LIKELY, f"ROBUST: {told}")
    if "SYSTEMS" in families:
        return CodesVerdict(None, None, UNMAPPED, f"ROBUST: {told}; whether the platform is blamed is in the report")
    if "CONFIG" in families:
        return CodesVerdict(None, None, UNMAPPED, f"ROBUST: {told}; whether two sides disagree is in the report")
    if set(families) == {"MODELS"} or set(families) == {"BDO"}:
        return CodesVerdict("other", None, LIKELY, f"ROBUST: {told}")
    if any(
        code in failures for code in ("SOFTWARE:BEHAVIORAL", "SOFTWARE:NETWORK", "SOFTWARE:UX", "SYSTEM:MONITORING")
    ):
        return CodesVerdict(
            None, None, UNMAPPED, f"ROBUST: {told}; whether others were sent wrong values, or none, is in the report"
        )
    return CodesVerdict("other", None, LIKELY, f"ROBUST: {told}")


def make_rows(mapped: Sequence[Mapped]) -> Iterator[MappedRow]:
    """The lines of a labels file: every report that has a label and a phase, each once. Where several records name one
    report and differ, it is left out."""
    by_id: dict[str, list[Mapped]] = {}
    for found in mapped:
        if found.label and found.phase and (found.kind is not None or found.label not in KINDS):
            by_id.setdefault(found.id, []).append(found)
    for id, records in by_id.items():
        first = records[0]
        if all((other.label, other.kind, other.phase) == (first.label, first.kind, first.phase) for other in records):
            yield MappedRow(
                id, str(first.label), first.kind, str(first.phase), first.why, (str(first.label),), "imported",
                first.confidence, first.record,
            )  # fmt: skip


def summarize(mapped: Sequence[Mapped]) -> dict[str, dict[str, int]]:
    """Label, or `unmapped`, to confidence to number of records."""
    counts = Counter((found.label or UNMAPPED, found.confidence) for found in mapped)
    names = sorted({name for name, _ in counts}, key=lambda name: (name == UNMAPPED, name))
    return {name: {level: counts[name, level] for level in CONFIDENCES} for name in names}


def find_report(text: str) -> str:
    """The first report that a text links to, as the corpus writes its id; empty when there is none."""
    places = [(match.start(), f"{match[1]}#{match[2]}") for match in _GITHUB.finditer(text)]
    places += [(match.start(), f"ros-answers:{match[1]}") for match in _ANSWERS.finditer(text)]
    return min(places)[1] if places else ""


def describe_licence(folder: Path) -> str:
    """What a clone says of its licence, as a sentence: the name of its licence file, or that it has none."""
    for pattern in _LICENCES:
        for path in sorted(folder.glob(pattern)):
            first = next((line.strip() for line in _read_head(path).splitlines() if line.strip()), "")
            return f"licence: {path.name} ({first[:80]})" if first else f"licence: {path.name}"
    return (
        "licence: the clone has no licence file, so its records may be read and not passed on; only ids, codes and the "
        "labels mapped from them are written"
    )


def _find_evolution_kind(names: Sequence[str], words: str) -> tuple[str, bool]:
    kinds = {_EVOLUTION_KINDS[name] for name in names if name in _EVOLUTION_KINDS}
    if len(kinds) == 1:
        return kinds.pop(), True
    for kind, pattern in _EVOLUTION_WORDS:
        if pattern.search(words):
            return kind, False
    return "ros", False


def _find_dependency_kind(classification: str, words: str) -> tuple[str, bool]:
    """The kind, and whether the record says it plainly."""
    wrong = re.search(r"circular|non-existent|wrong dependenc|broken", classification, re.IGNORECASE)
    if wrong or re.search(r"meta-?package", words, re.IGNORECASE):
        return "wrong", True
    if re.search(r"gencpp|add_dependencies", words, re.IGNORECASE):
        return "build-order", True
    # "Missing Include / Dependency" is used for headers too.
    plain = re.search(r"missing", words, re.IGNORECASE) and re.search(r"dependenc", classification, re.IGNORECASE)
    return "undeclared", bool(plain) and "include" not in classification.lower()


def _strip_marks(classification: str) -> str:
    """A classification without ROBUST's marks."""
    return re.sub(r"\s*(?:\(no CWE\)|#\w+|internal classification.*).*", "", classification).strip()


def _find_pull(record: Mapping[str, Any]) -> str:
    fix = record.get("fix")
    return find_report(_clean_text(fix.get("pull-request"))) if isinstance(fix, Mapping) else ""


def _parse_record(path: Path) -> Mapping[str, Any]:
    """A record with every scalar as text: `1e09040` is a commit and no number. Raises ValueError."""
    try:
        record = load_yaml_as_text(read_file(path, get_limits().settings, follow=False))
    except OSError as error:
        raise ValueError(f"cannot be read: {_describe_error(error)}") from None
    except DocumentError as error:
        raise ValueError(f"is no YAML{f' in line {error.line}' if error.line else ''}: {error}") from None
    if not isinstance(record, Mapping) or "bug" not in record:
        raise ValueError("is no record of ROBUST: it has no `bug`")
    return record


def _clean_text(value: object) -> str:
    text = value.strip() if isinstance(value, str) else ""
    return "" if text.lower() in _EMPTY else text


def _clean_texts(value: object) -> list[str]:
    if isinstance(value, str):
        value = value.split(",")
    return [text for item in value if (text := _clean_text(item))] if isinstance(value, list) else []


def _describe_error(error: OSError) -> str:
    return "is a link" if error.errno == errno.ELOOP else error.strerror or type(error).__name__


def _read_head(path: Path) -> str:
    try:
        return read_file(path, get_limits().text, follow=False)[:2000].decode("utf-8", "replace")
    except OSError:
        return ""
