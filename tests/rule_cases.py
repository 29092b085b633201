"""Cases of rules: a small workspace and changes of it in one Markdown file, with the findings of each change.

`tests/rules/<family>/<rule>.md` holds cases of a rule (underscores for dashes), `<rule>__<what they show>.md` further
ones. CONTRIBUTING.md describes the format.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from rosimpact.impact.analysis.check import check
from rosimpact.impact.analysis.report import Report
from rosimpact.impact.analysis.session import Options
from rosimpact.impact.rules.rule import Finding, load_rules
from rosimpact.impact.tree.paths import (
    PathProblem,
    TreeEntry,
    Walked,
    compute_blob_id,
    find_ignore_marker,
    normalize_path,
)

HERE = Path(__file__).parent / "rules"
Files = Mapping[str, str]


class CaseError(ValueError):
    """A case file that cannot be read; the text names the file, the line and what is wrong."""


class Case(NamedTuple):
    """One section of a case file: a workspace and what a rule reports about it.

    title: the section's heading. targets: as on the command line; none: those that the workspace names. others: rules
    that run along, where the rule reports on what others find. unchanged: the workspace of all sections, files: the
    same with this section's change; text by path. installed: built files of an install space, a line each. findings:
    the lines of its block of findings; none: nothing may be reported.
    """

    file: Path
    title: str
    targets: tuple[str, ...]
    others: tuple[str, ...]
    unchanged: Files
    files: Files
    installed: tuple[str, ...]
    findings: tuple[str, ...]

    @property
    def rule(self) -> str:
        return self.file.stem.partition("__")[0].replace("_", "-")

    @property
    def asked(self) -> tuple[str, ...]:
        """The rules that the case is checked by."""
        return self.rule, *self.others

    @property
    def family(self) -> str:
        return self.file.parent.name

    @property
    def name(self) -> str:
        return f"{self.family}/{self.file.stem}: {self.title}"


CheckCase = Callable[..., Report]
"""The fixture check_case() of rules/conftest.py: a case and the names of rules to its report."""


class Block(NamedTuple):
    """A fenced block. first, last: indexes of the lines of its fences. words: what follows the opening fence."""

    first: int
    last: int
    words: tuple[str, ...]
    lines: tuple[str, ...]


class Part(NamedTuple):
    """The lines of a case file from one heading to the next. end: index of the line after the last."""

    title: str
    start: int
    end: int
    targets: tuple[str, ...]
    others: tuple[str, ...]
    blocks: tuple[Block, ...]

    def lines_of(self, word: str) -> tuple[str, ...]:
        """The lines of all blocks of this word."""
        return tuple(line for block in self.blocks if block.words == (word,) for line in block.lines)


_LISTS = ("findings", "installed", "empty", "removed")
_TARGETS, _OTHERS = "Targets:", "Other rules:"


def find_cases() -> list[Case]:
    """The cases of all files, in the order of their paths."""
    return [case for file in sorted(HERE.glob("*/*.md")) for case in read_cases(file)]


def read_case_files(name: str, title: str = "") -> Files:
    """The workspace of one case. name: `<family>/<file>` without the ending. title: its heading; empty for the
    workspace without any change. Raises KeyError."""
    cases = {case.title: case for case in read_cases(HERE / f"{name}.md")}
    return cases[title].files if title else next(iter(cases.values())).unchanged


def read_changed_files(name: str) -> Files:
    """The workspace of the first case of a file in which its rule reports something."""
    return next(case.files for case in read_cases(HERE / f"{name}.md") if case.findings)


def read_cases(file: Path) -> list[Case]:
    """The cases of a file. Raises CaseError."""
    common, *sections = split_parts(file, file.read_text(encoding="utf-8").splitlines())
    unchanged = _change_files(file, {}, common)
    if not sections or not unchanged:
        raise CaseError(f"{file}: holds no {'files' if sections else 'section (`## What it shows`)'}")
    titles = [section.title for section in sections]
    if len(set(titles)) < len(titles):
        raise CaseError(f"{file}: two sections have the same heading")
    return [
        Case(
            file,
            section.title,
            section.targets or common.targets,
            section.others or common.others,
            unchanged,
            _change_files(file, unchanged, section),
            section.lines_of("installed") or common.lines_of("installed"),
            section.lines_of("findings"),
        )
        for section in sections
    ]


def split_parts(file: Path, lines: Sequence[str]) -> list[Part]:
    """A file's common part and its sections. Raises CaseError."""
    parts: list[Part] = []
    title, start, targets, others, blocks = "", 0, (), (), []
    at = 0
    while at <= len(lines):
        line = lines[at] if at < len(lines) else "## "
        if line.startswith("## "):
            parts.append(Part(title, start, at, targets, others, tuple(blocks)))
            title, start, targets, others, blocks = line[3:].strip(), at, (), (), []
        elif line.startswith(_TARGETS):
            targets = tuple(line.removeprefix(_TARGETS).replace(",", " ").split())
        elif line.startswith(_OTHERS):
            others = tuple(line.removeprefix(_OTHERS).replace(",", " ").split())
        elif line.startswith("```"):
            fence = line[: len(line) - len(line.lstrip("`"))]
            last = next((i for i in range(at + 1, len(lines)) if lines[i].rstrip() == fence), None)
            if last is None:
                raise CaseError(f"{file}:{at + 1}: the block is not closed")
            words = tuple(line.removeprefix(fence).split())
            if not (len(words) == 2 or (len(words) == 1 and words[0] in _LISTS)):
                known = ", ".join(f"`{word}`" for word in _LISTS)
                raise CaseError(f"{file}:{at + 1}: a block is {known}, `diff PATH` or `LANGUAGE PATH`")
            blocks.append(Block(at, last, words, tuple(lines[at + 1 : last])))
            at = last
        at += 1
    return parts


def _change_files(file: Path, files: Files, part: Part) -> Files:
    """The files with the changes of a part. Raises CaseError."""
    changed = dict(files)
    for block in part.blocks:
        where = f"{file}:{block.first + 1}"
        if block.words[0] == "diff":
            path = block.words[1]
            if path not in changed:
                raise CaseError(f"{where}: there is no file `{path}` to change")
            changed[path] = apply_diff(changed[path], block.lines, where)
        elif block.words == ("removed",):
            for path in block.lines:
                if changed.pop(path, None) is None:
                    raise CaseError(f"{where}: there is no file `{path}` to remove")
        elif block.words == ("empty",):
            changed.update(dict.fromkeys(block.lines, ""))
        elif len(block.words) == 2:
            changed[block.words[1]] = "".join(f"{line}\n" for line in block.lines)
    return changed


def apply_diff(text: str, diff: Iterable[str], where: str) -> str:
    """A text with changes. diff: lines that begin with a space, `-` or `+`, in groups that lines with `@@` divide; what
    a group takes away and keeps has to be in the text once. where: begins the text of CaseError."""
    groups: list[list[str]] = [[]]
    for line in diff:
        if line.startswith("@@"):
            groups.append([])
        else:
            groups[-1].append(line)
    lines = text.splitlines()
    for group in filter(None, groups):
        if wrong := [line for line in group if line and line[0] not in " +-"]:
            raise CaseError(f"{where}: `{wrong[0]}` begins with none of ` `, `-`, `+`")
        old = [line[1:] for line in group if not line.startswith("+")]
        places = [at for at in range(len(lines) - len(old) + 1) if lines[at : at + len(old)] == old]
        if len(places) != 1:
            raise CaseError(f"{where}: the file has {len(places)} places with `{old[0] if old else ''}`, not one")
        lines[places[0] : places[0] + len(old)] = [line[1:] for line in group if not line.startswith("-")]
    return "".join(f"{line}\n" for line in lines)


class MemoryTree(Walked):
    """A tree of texts. files: by path."""

    def __init__(self, files: Files):
        self.label = self.name = "case"
        self.problems: list[PathProblem] = []
        self.skipped: list[PathProblem] = []
        self.aliases: dict[str, str] = {}
        self._entries: list[TreeEntry] | None = None
        self._data = {path: text.encode() for path, text in files.items()}
        self._folders = {""} | {path[:at] for path in files for at, letter in enumerate(path) if letter == "/"}

    @property
    def repositories(self) -> dict[str, str]:
        return {}

    def _walk(self, found: list[TreeEntry]) -> None:
        names: dict[str, set[str]] = {}
        for path in sorted(self._data):
            folder, _, name = path.rpartition("/")
            names.setdefault(folder, set()).add(name)
        ignored = {folder: marker for folder, each in names.items() if (marker := find_ignore_marker(each))}
        self.skipped += [PathProblem(folder or ".", f"holds {marker}") for folder, marker in ignored.items()]
        for path, data in self._data.items():
            if not any(not folder or path.startswith(f"{folder}/") for folder in ignored):
                found.append(TreeEntry(path, len(data)))

    def read(self, path: str, limit: int = 0) -> bytes:
        data = self._data.get(normalize_path(path) or "")
        if data is None:
            raise FileNotFoundError(2, "No such file or directory", path)
        if limit and len(data) > limit:
            raise OSError(27, "File too large", path)
        return data

    def read_with_id(self, path: str, limit: int = 0) -> tuple[bytes, str]:
        data = self.read(path, limit)
        return data, compute_blob_id(data)

    def find_content_id(self, path: str) -> str:
        return compute_blob_id(self.read(path))

    def find_known_id(self, path: str) -> str | None:
        return self.find_content_id(path)

    def exists(self, path: str) -> bool:
        clean = normalize_path(path)
        return clean in self._data or clean in self._folders

    def is_dir(self, path: str) -> bool:
        return normalize_path(path) in self._folders

    def make_memory_key(self) -> bytes | None:
        return None

    def recall(self, memory: bytes) -> None:
        del memory

    def make_memory(self) -> bytes | None:
        return None


def check_files(files: Files, options: Options, base: Files | None = None) -> Report:
    """The report on a workspace of texts. base: what it is compared with."""
    base_tree = None if base is None else MemoryTree(base)
    return check("case", options._replace(jobs=1), tree=MemoryTree(files), base_tree=base_tree)


def write_files(folder: Path, files: Files) -> Path:
    """Writes texts into a folder, which is made where it is missing, and returns the folder."""
    for path, text in files.items():
        place = folder / path
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(text.encode())
    return folder


def render_findings(findings: Iterable[Finding], rule: str) -> list[str]:
    """The lines that a case gives for the findings of a rule: severity, place, subject and targets in one line, below
    it the message and the help."""
    lines = []
    for finding in findings:
        if finding.rule == rule:
            lines.append(_render_head(finding.severity, finding))
            lines.append(f"  {finding.message}")
            lines += [f"  help: {line}" for line in finding.help.splitlines()]
    return lines


def render_others(findings: Iterable[Finding], rule: str) -> list[str]:
    """A line for each finding of another rule."""
    return [_render_head(f"{one.severity} {one.rule}", one) for one in findings if one.rule != rule]


def _render_head(head: str, finding: Finding) -> str:
    return f"{head} {finding.path}:{finding.line} {finding.subject} [{', '.join(finding.targets)}]"


def leave_out_details(lines: Sequence[str], expected: Sequence[str]) -> list[str]:
    """The lines of findings without message and help where the expected finding at the same position has none."""
    groups, wanted = _group_findings(lines), _group_findings(expected)
    left = []
    for at, group in enumerate(groups):
        left += group[:1] if at < len(wanted) and len(wanted[at]) == 1 else group
    return left


def _group_findings(lines: Iterable[str]) -> list[list[str]]:
    groups: list[list[str]] = []
    for line in lines:
        if line.startswith(" ") and groups:
            groups[-1].append(line)
        else:
            groups.append([line])
    return groups


def update_findings(case: Case, lines: Sequence[str]) -> None:
    """Writes the findings of a case into its file."""
    text = case.file.read_text(encoding="utf-8").splitlines()
    part = next(part for part in split_parts(case.file, text) if part.title == case.title)
    known = [block for block in part.blocks if block.words == ("findings",)]
    end = part.end
    for block in reversed(known):
        first = block.first - 1 if block.first and not text[block.first - 1] else block.first
        del text[first : block.last + 1]
        end -= block.last + 1 - first
    while end > part.start and not text[end - 1]:
        end -= 1
    if lines:
        text[end:end] = ["", "```findings", *lines, "```"]
    case.file.write_text("\n".join(text) + "\n", encoding="utf-8")


def rules_that_compare() -> set[str]:
    """Names of the rules that need a base."""
    return {name for name, rule in load_rules().items() if rule.has_base}
