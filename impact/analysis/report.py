"""Report: everything a run has to say, ready for any reporter. Every reporter module has `render(report) -> str`."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Collection, Iterable, Mapping
from itertools import product
from typing import TYPE_CHECKING, NamedTuple

from ...edges.console import format_count
from ..rules.rule import Finding, Rule

if TYPE_CHECKING:
    from ..config import Config
    from ..targets.resolve import Chosen
    from ..tree import Tree
    from .effects import Impact
    from .findings import UpgradeItem

CONTEXT = 1
_KEPT_FILES = 32


class ReportedTarget(NamedTuple):
    """A target as reported. reason: why it was chosen (`--target`, `rosimpact.toml`, `named by ci.yml`).
    notes: what was adjusted, such as a date moved to the distro's first release."""

    name: str
    distro: str
    date: str
    platform: str
    reason: str = ""
    notes: tuple[str, ...] = ()


def report_target(chosen: Chosen, notes: Iterable[str]) -> ReportedTarget:
    """A chosen target as reported. notes: further ones."""
    target = chosen.target
    return ReportedTarget(
        target.name, target.distro, target.date, target.platform, chosen.reason, (*target.notes, *notes)
    )


class ReportedPackage(NamedTuple):
    """A package of the workspace and its folder relative to the root."""

    name: str
    path: str


class AnalysisCoverage(NamedTuple):
    """What was analysed: packages, files that concern us, files parsed without trouble, and what stayed open."""

    packages: int = 0
    files: int = 0
    parsed: int = 0
    unresolved: Mapping[str, int] = {}


class Report(NamedTuple):
    """One run. Findings come sorted by path and line.

    version: of the tool. data: ISO day of the shipped data. suppressed: silenced by allow comments. known: in the
    baseline. rules: gives those that could speak, for help texts. excerpt(path, line): the lines `line - CONTEXT` (or
    1) to `line + CONTEXT`, empty when unreadable. root: what to call the workspace. base: the revision compared with,
    empty without one. failure: why the run failed, empty when it did not. impact: what the changes since
    the base reach in the message flow, None without a base. seconds: wall time.
    """

    version: str
    data: str
    targets: tuple[ReportedTarget, ...]
    findings: tuple[Finding, ...]
    coverage: AnalysisCoverage
    packages: tuple[ReportedPackage, ...] = ()
    suppressed: tuple[Finding, ...] = ()
    known: tuple[Finding, ...] = ()
    rules: Callable[[], Iterable[Rule]] = tuple
    seconds: float = 0.0
    excerpt: Callable[[str, int], list[str]] = lambda path, line: []
    root: str = "."
    base: str = ""
    failure: str = ""
    impact: Impact | None = None


class Checked(NamedTuple):
    """What a check gives: the report, and what it was made with. originals: what the files held that fixes change, when
    the fixes were made."""

    report: Report
    config: Config
    tree: Tree
    originals: Mapping[str, bytes]


class SourceLines:
    """Lines of source files for excerpts and fingerprints. Keeps the last few files it was asked for."""

    def __init__(self, read: Callable[[str], bytes | None]):
        """read: bytes of a path relative to the root, None when it cannot be read; an OSError counts as that."""
        self._read = read
        self._files: dict[str, list[str]] = {}

    def read_lines(self, path: str) -> list[str]:
        """Lines without their endings, empty when the file cannot be read. They end at LF or CRLF."""
        lines = self._files.pop(path, None)
        if lines is None:
            try:
                data = self._read(path) if path else None
            except OSError:
                data = None
            lines = [] if data is None else _split(data)
            while len(self._files) >= _KEPT_FILES:
                del self._files[next(iter(self._files))]
        self._files[path] = lines
        return lines

    def read_line(self, path: str, number: int) -> str:
        """One line counted from 1, empty when there is none."""
        lines = self.read_lines(path)
        return lines[number - 1] if 0 < number <= len(lines) else ""

    def read_excerpt(self, path: str, number: int) -> list[str]:
        """The line and CONTEXT lines around it, empty when there is no such line."""
        lines = self.read_lines(path)
        return lines[max(0, number - 1 - CONTEXT) : number + CONTEXT] if 0 < number <= len(lines) else []


def _split(data: bytes) -> list[str]:
    text = data.removeprefix(b"\xef\xbb\xbf").decode("utf-8", "replace")
    lines = [line.removesuffix("\r") for line in text.split("\n")]
    if not lines[-1]:
        lines.pop()
    return lines


class Shown(NamedTuple):
    """A source line made fit for showing, with the caret under the finding. start: character offset, width: in
    characters, 0 when no caret can be known."""

    text: str
    start: int
    width: int


# A word with the substitutions in it, or what stands in quotes or angle brackets.
_TOKEN = re.compile(r"""(?:\$\([^()]*\)|\$\{[^{}]*\}|[\w./:+$-])+|<[^<>]*>|"[^"]*"|'[^']*'|.""")


def locate_subject(line: str, column: int, subject: str) -> Shown:
    """Where in a source line the finding points: the subject at its column, else the word or quoted
    text there.

    column counts characters from 1; 0 means the whole line, then the subject is looked for.
    """
    start = column - 1
    if column <= 0:
        # A part of another word is not the subject.
        found = re.search(rf"(?<!\w){re.escape(subject)}(?!\w)", line) if subject else None
        return Shown(line, found.start(), len(subject)) if found else Shown(line, 0, 0)
    if start >= len(line):
        return Shown(line, 0, 0)
    if subject:
        near = line.find(subject, start, start + len(subject) + 2)
        if near >= 0:
            return Shown(line, near, len(subject))
    word = _TOKEN.match(line, start)
    return Shown(line, start, len(word.group()) if word else 1)


def locate_in_excerpt(finding: Finding, lines: list[str]) -> tuple[int, Shown | None]:
    """(number of the first excerpt line, the finding's own line and caret), None without an excerpt."""
    first = max(1, finding.line - CONTEXT)
    index = finding.line - first
    return first, locate_subject(lines[index], finding.column, finding.subject) if 0 <= index < len(lines) else None


def measure(text: str) -> int:
    """Terminal columns a text takes: wide characters count twice, combining ones not at all."""
    if text.isascii():
        return len(text)
    return sum(
        0 if unicodedata.combining(char) else 2 if unicodedata.east_asian_width(char) in "WF" else 1 for char in text
    )


def list_new(report: Report) -> list[Finding]:
    """What the run is about: all findings, or those new against the base."""
    return [finding for finding in report.findings if finding.new]


def count_by_severity(graded: Iterable[Finding | UpgradeItem]) -> dict[str, int]:
    """How many errors, warnings and notes, in this order, zeros included."""
    counts = {"error": 0, "warning": 0, "note": 0}
    for one in graded:
        counts[one.severity] = counts.get(one.severity, 0) + 1
    return counts


def format_severities(graded: Iterable[Finding | UpgradeItem]) -> str:
    """`2 errors and 1 note`; empty without any."""
    return " and ".join(format_count(number, name) for name, number in count_by_severity(graded).items() if number)


def group_alike(findings: Iterable[Finding]) -> list[list[Finding]]:
    """Findings of one cause together, which say the same of one package at several places; in the order of the first
    ones. Errors are apart; of what is a warning at its first place and a note at the others, the warning leads."""
    groups: dict[tuple, list[Finding]] = {}
    for finding in findings:
        fails = finding.severity == "error"
        key = (finding.rule, fails, finding.package, finding.message, finding.help, finding.targets)
        groups.setdefault((*key, finding.new), []).append(finding)
    for group in groups.values():
        group.sort(key=lambda finding: finding.severity == "note")
    return list(groups.values())


def select_causes(findings: Iterable[Finding], severities: Collection[str]) -> list[Finding]:
    """The findings of all causes that are of one of these severities, in the order given."""
    found = [*findings]
    shown = {id(one) for group in group_alike(found) if group[0].severity in severities for one in group}
    return [finding for finding in found if id(finding) in shown]


def put_different_first(findings: Iterable[Finding]) -> list[Finding]:
    """Findings with those first that say something not said yet, for a report that shows only a few."""
    said: set[tuple[str, str]] = set()
    first, again = [], []
    for finding in findings:
        key = (finding.rule, finding.message)
        (again if key in said else first).append(finding)
        said.add(key)
    return first + again


def format_causes(findings: Iterable[Finding]) -> str:
    """`2 errors in 40 places, 1 note`: each cause once; empty without any."""
    groups = group_alike(findings)
    return ", ".join(
        format_count(number, severity) + format_places(group for group in groups if group[0].severity == severity)
        for severity, number in count_by_severity(group[0] for group in groups).items()
        if number
    )


def format_places(groups: Iterable[list[Finding]]) -> str:
    """` in 40 places`, where causes have more than one each; empty otherwise."""
    sizes = [len(group) for group in groups]
    return f" in {sum(sizes):,} places" if sum(sizes) > len(sizes) else ""


def count_by_target(report: Report) -> dict[str, dict[str, dict[str, int]]]:
    """package → target → severity → count of causes, of what is new. Every package and target is there; findings that
    name no package stand under the empty name, findings that name no target count for all."""
    names = [target.name for target in report.targets]
    table: dict[str, dict[str, dict[str, int]]] = {
        package.name: {name: {} for name in names} for package in report.packages
    }
    for finding, *_ in group_alike(list_new(report)):
        for package, name in product(finding.packages, finding.targets or names):
            cell = table.setdefault(package, {name: {} for name in names}).setdefault(name, {})
            cell[finding.severity] = cell.get(finding.severity, 0) + 1
    return table


def format_gaps(coverage: AnalysisCoverage) -> str:
    """What keeps a workspace without findings from being safe: `1 include unresolved`, `1 file not read`; empty when
    everything was read and resolved."""
    unread = coverage.files - coverage.parsed
    gaps = [f"{_format_unresolved(coverage)} unresolved"] if any(coverage.unresolved.values()) else []
    return ", ".join([*gaps, f"{format_count(unread, 'file')} not read"] if unread else gaps)


def _format_unresolved(coverage: AnalysisCoverage) -> str:
    return ", ".join(format_count(number, kind) for kind, number in sorted(coverage.unresolved.items()) if number)


def format_coverage(coverage: AnalysisCoverage) -> str:
    """Coverage as one clause: packages, files parsed of files, what stayed unresolved."""
    unresolved = _format_unresolved(coverage)
    files = format_count(coverage.files, "file")
    read = f"all of {files} read" if coverage.parsed == coverage.files else f"{coverage.parsed:,} of {files} read"
    return ", ".join([format_count(coverage.packages, "package"), read]) + (
        f", unresolved: {unresolved}" if unresolved else ""
    )
