"""Parts of sources that do not compile, left out: statements, bodies of functions, declarations.

A statement that is left out ends the way in the callback as unknown, with its place. Lines stay where they are. The
files themselves are not changed: clang is told to read others in their place (`-ivfsoverlay`).
"""

from __future__ import annotations

import bisect
import json
import re
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from ....edges.files import read_file, write_file
from .stubs import CompileError

_BYTES = 4_000_000
_LONGEST_HEAD = 4000
"""What is looked at before a brace."""
_PLACE = re.compile(
    r"^(?P<path>[^\s:][^:]*):(?P<line>\d+):(?P<column>\d+): (?:fatal )?(?P<what>error|note): (?P<text>.*)$"
)
_MASKED = re.compile(
    r"//[^\n]*|/\*.*?\*/|R\"(?P<mark>[^()\\\s]*)\(.*?\)(?P=mark)\"|"
    r"\"(?:\\.|[^\"\\\n])*\"|(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'|"
    r"^[ \t]*#(?:[^\n\\]|\\.|\\\n)*",
    re.DOTALL | re.MULTILINE,
)
_INITIALISERS = re.compile(r"\)\s*(?:noexcept\s*(?:\([^()]*\))?\s*)?:(?!:)")
_BEFORE_BLOCK = re.compile(r"(?:[){};:\]]|\b(?:else|do|try|mutable|noexcept|const|override)|->\s*[\w:<>,&*\s]+)$")

_DECLARATION = re.compile(
    r"(?:(?:const|static|constexpr)\s+)*(?P<type>[A-Za-z_][\w:]*(?:\s*<[^;{}()]*>)?(?:::\w+)*)"
    r"(?:\s*[&*]+\s*|\s+)(?:const\s+)?(?P<name>[A-Za-z_]\w*)\s*(?:=(?!=)|\(|\{|;|\[)"
)
_NO_TYPES = frozenset(
    ("return", "delete", "throw", "else", "using", "typedef", "case", "goto", "new", "if", "for", "while", "do",
     "switch", "try", "template", "struct", "class", "enum", "union", "namespace", "typename", "co_return", "co_await")
)  # fmt: skip
"""Words that what is no declaration may begin with."""


class _Brace(NamedTuple):
    """A pair of braces. kind: `outer` (namespaces, classes), `function`, `block`, `other`; head: where what it belongs
    to begins."""

    start: int
    end: int
    kind: str
    head: int


class _Cut(NamedTuple):
    """What is left out: from start to before end. text: what stands there instead."""

    start: int
    end: int
    text: str


def mask_source(text: str) -> str:
    """A source with blanks for comments, texts and lines of the preprocessor."""
    return _MASKED.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), text)


def locate_errors(output: str, is_inside: Callable[[str], bool]) -> list[CompileError]:
    """Errors by where they are in files that are ours to change: those in other files, where these are used from."""
    found: list[CompileError] = []
    waiting: CompileError | None = None
    for line in output.splitlines():
        match = _PLACE.match(line)
        if match is None:
            continue
        place = CompileError(match["path"], int(match["line"]), int(match["column"]), match["text"])
        if match["what"] == "error":
            waiting = None if is_inside(place.path) else place
            if waiting is None:
                found.append(place)
        elif waiting is not None and is_inside(place.path) and "requested here" in place.text:
            found.append(place._replace(text=waiting.text))
            waiting = None
    return found


class SourceFile:
    """One source with what is left out of it."""

    def __init__(self, text: str):
        self.text = text
        self.masked = mask_source(text)
        self.braces = sorted(_list_braces(self.masked))
        self.cuts: list[_Cut] = []
        self.rendered, self._origins = text, range(len(text) + 1)
        self._lines = _list_lines(text)

    def cut(self, line: int, column: int, shown: str) -> bool:
        """Leaves the least part out that is around a place of the rendered text; one around it, where that is left out
        already. Gives whether there was one."""
        if not 0 < line <= len(self._lines):
            return False
        whole = self.rendered[self._lines[line - 1] :].partition("\n")[0]
        if whole.lstrip().startswith("#"):
            return False  # what is around it has nothing to do with it
        at = min(self._lines[line - 1] + column - 1, len(self.rendered))
        at = min(self._origins[at], len(self.text) - 1)
        for part in self._list_parts(at, shown):
            if any(one.start <= part.start and part.end <= one.end for one in self.cuts):
                continue
            self.cuts = [one for one in self.cuts if not (part.start <= one.start and one.end <= part.end)]
            if any(one.start < part.end and part.start < one.end for one in self.cuts):
                continue
            bisect.insort(self.cuts, part)
            self._render()
            return True
        return False

    def _render(self) -> None:
        parts: list[str] = []
        origins: list[int] = []
        place = 0
        for start, end, text in self.cuts:
            kept = text + re.sub(r"[^\n]", "", self.text[start:end])
            parts += (self.text[place:start], kept)
            origins += (*range(place, start), *[start] * len(kept))
            place = end
        self.rendered = "".join((*parts, self.text[place:]))
        self._origins = [*origins, *range(place, len(self.text) + 1)]
        self._lines = _list_lines(self.rendered)

    def _list_parts(self, at: int, shown: str) -> Iterator[_Cut]:
        """What may be left out around a place, the least first."""
        around = [one for one in self.braces if one.start < at <= one.end and one.kind != "other"]
        quoted = json.dumps(shown)
        for brace in reversed(around):
            if brace.kind in ("block", "function"):
                start, end = self._find_statement(brace, at)
                if start <= at < end:
                    statement = self.masked[start:end]
                    gives = re.search(r"\breturn\s*[^;\s]", statement) is not None
                    declared = "".join(f" ::ri::Anything {name};" for name in _list_declared(statement))
                    yield _Cut(start, end, f"::ri::cut{'_end' if gives else ''}({quoted});{declared}")
            if brace.kind == "function":
                yield self._cut_body(brace, quoted)
                head = self.masked[brace.head : brace.start]
                found = _INITIALISERS.search(head)
                if found is not None:
                    yield _Cut(brace.head + found.end() - 1, brace.start, " ")
                yield _Cut(brace.head, brace.end + 1, "")
                return
        function = next((one for one in self.braces if one.kind == "function" and one.head <= at <= one.start), None)
        if function is not None:
            found = _INITIALISERS.search(self.masked[function.head : function.start])
            if found is not None and function.head + found.end() <= at:
                yield _Cut(function.head + found.end() - 1, function.start, " ")
            yield _Cut(function.head, function.end + 1, "")
            return
        start, end = self._find_declaration(around[-1] if around else None, at)
        if start < end:
            yield _Cut(start, end, "")

    def _cut_body(self, brace: _Brace, quoted: str) -> _Cut:
        head = self.masked[brace.head : brace.start]
        before = head.partition("(")[0]
        name = before.split()[-1] if before.split() else ""
        parts = [each for each in re.split(r"::", name) if each]
        made = bool(parts) and (
            (len(parts) > 1 and parts[-1].lstrip("~") == re.sub(r"<.*", "", parts[-2]))
            or not re.sub(r"\b(?:explicit|inline|virtual|constexpr|public|private|protected)\b:?", "", before)
            .replace(name, "").strip()
        )  # fmt: skip
        plain = made or (re.search(r"\bvoid\s+[\w:~<>]+\s*$", before) is not None)
        return _Cut(brace.start + 1, brace.end, f" ::ri::cut{'' if plain else '_end'}({quoted}); ")

    def _find_statement(self, block: _Brace, at: int) -> tuple[int, int]:
        """The statement in a block that a place is in."""
        masked, start, place = self.masked, block.start + 1, block.start + 1
        depth = 0
        while place < block.end:
            character = masked[place]
            if character in "([":
                depth += 1
            elif character in ")]":
                depth -= 1
            elif character == "{":
                inner = self._find_brace(place)
                place = inner.end if inner is not None else place
                if depth == 0 and inner is not None and inner.kind != "other":
                    behind = re.match(r"\s*(\w+|.)?", masked[place + 1 : block.end])
                    following = behind[1] if behind is not None else ""
                    if following not in ("else", "catch", "while", ",", ")", ";", ".", "("):
                        if at <= place:
                            return _skip_labels(masked, start, place + 1)
                        start = place + 1
            elif character == ";" and depth <= 0:
                if at <= place:
                    return _skip_labels(masked, start, place + 1)
                start, depth = place + 1, 0
            place += 1
        return start, start

    def _find_declaration(self, outer: _Brace | None, at: int) -> tuple[int, int]:
        """The declaration in a namespace or a class that a place is in."""
        first, last = (outer.start + 1, outer.end) if outer is not None else (0, len(self.masked))
        start = place = first
        while place < last:
            character = self.masked[place]
            if character == "{":
                inner = self._find_brace(place)
                if inner is not None:
                    place = inner.end
                    if inner.kind in ("function", "outer") and not re.match(r"\s*;", self.masked[place + 1 : last]):
                        start = place + 1
            elif character == ";":
                if at <= place:
                    return _skip_labels(self.masked, start, place + 1)
                start = place + 1
            place += 1
        return start, start

    def _find_brace(self, start: int) -> _Brace | None:
        number = bisect.bisect_left(self.braces, (start,))
        found = self.braces[number] if number < len(self.braces) else None
        return found if found is not None and found.start == start else None


def _list_declared(statement: str) -> list[str]:
    """The variables that a statement of a block declares, which what comes after it may use."""
    bound = re.match(r"(?:const\s+)?auto\s*[&\s]*\[([\w\s,]+)\]\s*=", statement)
    if bound is not None:
        return [each.strip() for each in bound[1].split(",")]
    found = _DECLARATION.match(statement)
    return [found["name"]] if found is not None and found["type"].split()[0] not in _NO_TYPES else []


def _skip_labels(masked: str, start: int, end: int) -> tuple[int, int]:
    """Without blanks and labels before it."""
    label = re.compile(r"\s*(?:(?:case\b[^;{}?]*?|default|public|private|protected)\s*(?<!:):(?!:))?\s*")
    found = label.match(masked, start, end)
    return (found.end() if found is not None else start), end


def _list_lines(text: str) -> list[int]:
    return [0, *(found.end() for found in re.finditer("\n", text))]


def _list_braces(masked: str) -> Iterator[_Brace]:
    """All pairs of braces with what they are of."""
    opened: list[tuple[int, str, int]] = []
    head = 0
    for found in re.finditer(r"[{};]|\b(?:public|private|protected)\s*:(?!:)", masked):
        character, place = found[0][0], found.start()
        inside = opened[-1][1] if opened else "outer"
        if character == "{":
            kind = _find_kind(masked, head, place, inside)
            opened.append((place, kind, head))
            if kind != "other":
                head = place + 1
        elif character == "}":
            if opened:
                start, kind, before = opened.pop()
                yield _Brace(start, place, kind, before)
                head = before if kind == "other" else place + 1
        elif inside != "other":
            head = found.end()


def _find_kind(masked: str, head: int, place: int, inside: str) -> str:
    text = masked[max(head, place - _LONGEST_HEAD) : place].rstrip()
    if inside in ("block", "function", "other"):
        if inside == "other" and "[" not in text[-400:]:
            return "other"
        return "block" if not text or _BEFORE_BLOCK.search(text[-400:]) else "other"
    if re.search(r"\b(?:namespace|extern)\b[\w\s:]*$", text):
        return "outer"
    if re.search(r"\benum\b", text):
        return "other"
    made = _INITIALISERS.search(text)
    if made is not None and re.search(r"(?:^|[,:])\s*[\w:<>]+$", text[made.end() - 1 :]):
        return "other"
    if re.search(r"\)\s*(?:const|noexcept|override|final|try|volatile|&|->\s*[\w:<>,&*\s]+|:.*|\s)*$", text, re.DOTALL):
        return "function"
    return "outer" if re.search(r"\b(?:class|struct|union)\b", text) else "other"


class SourceCuts:
    """What is left out of the sources of one unit. root: of the workspace; folder: for the changed files."""

    def __init__(self, root: Path, folder: Path):
        self.root, self.folder = root, folder
        self.files: dict[str, SourceFile] = {}
        self.places: dict[str, str] = {}

    def __bool__(self) -> bool:
        return any(one.cuts for one in self.files.values())

    def is_inside(self, path: str) -> bool:
        return path.startswith(f"{self.root}/")

    def read_lines(self, path: str) -> list[str] | None:
        """The lines of a changed file, None for another."""
        file = self.files.get(path)
        return file.rendered.split("\n") if file is not None and file.cuts else None

    def cut(self, output: str) -> bool:
        """Leaves out what a compiler's errors are in; gives whether anything new."""
        done = False
        for path, errors in _group_by_path(locate_errors(output, self.is_inside)).items():
            file = self._read(path)
            if file is None:
                continue
            # From the end of the file on, so that the places of the others still hold.
            seen: set[tuple[int, int]] = set()
            for error in sorted(errors, key=lambda one: (-one.line, -one.column)):
                if (error.line, error.column) in seen:
                    continue
                seen.add((error.line, error.column))
                shown = f"{path.removeprefix(f'{self.root}/')}:{error.line} does not compile: {error.text[:90]}"
                shown = shown.encode("ascii", "replace").decode()
                if file.cut(error.line, error.column, shown):
                    done = True
                    self.places[f"{path}:{error.line}"] = error.text
        if done:
            self.write_into(self.folder)
        return done

    def _read(self, path: str) -> SourceFile | None:
        if path not in self.files:
            try:
                self.files[path] = SourceFile(read_file(Path(path), _BYTES).decode("latin-1"))
            except OSError:
                return None
        return self.files[path]

    @property
    def overlay(self) -> Path:
        """The file that tells clang what to read."""
        return self.folder / "changed.json"

    def write_into(self, folder: Path) -> Path:
        """Writes the changed files into a folder, and the file that tells clang of them; gives its path."""
        rows = []
        for number, (path, file) in enumerate(sorted(self.files.items())):
            if not file.cuts:
                continue
            at = folder / f"changed{number}.txt"
            write_file(at, file.rendered.encode("latin-1"))
            rows.append({"name": path, "type": "file", "external-contents": str(at)})
        whole = {"version": 0, "use-external-names": False, "roots": rows}
        write_file(folder / self.overlay.name, json.dumps(whole).encode())
        return folder / self.overlay.name


def _group_by_path(errors: Sequence[CompileError]) -> dict[str, list[CompileError]]:
    found: dict[str, list[CompileError]] = {}
    for one in errors:
        found.setdefault(one.path, []).append(one)
    return found
