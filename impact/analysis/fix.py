"""Fixes: edits made, checked, applied to bytes, shown as a diff and written, leaving the rest untouched to the byte."""

from __future__ import annotations

import os
import re
from array import array
from bisect import bisect_left
from collections.abc import Callable, Collection, Iterable, Sequence
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

from ...edges.files import write_file
from ..rules.fix_actions import Declare, Edit, FixAction, Insert, Remove, Replace, translate_tag
from ..rules.rule import Finding
from ..tree.paths import is_vendored

_BOM = b"\xef\xbb\xbf"
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.+-]*\Z")
_MARKUP = re.compile(
    rb"""<!--.*?-->|<!\[CDATA\[.*?\]\]>|<\?.*?\?>|<![^>\[]*(?:\[.*?\]\s*)?>"""
    rb"""|<(?P<close>/?)(?P<tag>[A-Za-z_][\w:.-]*)(?P<attributes>(?:[^<>"']|"[^"]*"|'[^']*')*?)(?P<empty>/?)>""",
    re.DOTALL,
)
# Bracket arguments and comments, quoted arguments, escapes and comments, in which a parenthesis is none.
# What is not closed reaches to the end of the file, so that going through it takes linear time.
_CMAKE = re.compile(
    rb"""(?:\#|(?<![^\s()]))\[(?P<equals>=*)\[.*?(?:\](?P=equals)\]|\Z)|"(?:[^"\\]|\\.)*(?:"|\Z)|\\.|\#[^\n]*|[()]""",
    re.DOTALL,
)
_CMAKE_REST = re.compile(rb"[ \t\r]*(?:#.*)?\Z")
_DECLARATION = re.compile(r"\s*<(?:\w+_)?depend>")
_COMMENTS_ONLY = re.compile(rb"(?:[ \t]*<!--(?:(?!-->|\n).)*-->)*[ \t]*\Z")
# The order in which REP 149 lists them and most manifests have them.
_TAG_ORDER = (
    "buildtool_depend", "buildtool_export_depend", "build_depend", "build_export_depend", "depend", "exec_depend",
    "run_depend", "test_depend", "doc_depend",
)  # fmt: skip
# What each tag of format 2 and 3 stands for, REP 140 "depend".
_COVERS = {
    "depend": ("build_depend", "build_export_depend", "exec_depend"),
    "run_depend": ("build_export_depend", "exec_depend"),
}


class Applied(NamedTuple):
    """New bytes of the files that change, and the edits that were refused, each with the reason in one clause."""

    files: dict[str, bytes]
    refused: list[tuple[Edit, str]]


def make_fixes(
    findings: Iterable[Finding],
    read: Callable[[str], bytes | None],
    originals: dict[str, bytes] | None = None,
    submodules: Collection[str] = (),
) -> list[Finding]:
    """Findings whose fixes are byte edits: what rules propose by name and place is looked up in the files.

    read: bytes of a path, None when it cannot be read. A fix of which a part cannot be made, or would change nothing,
    is dropped, and so is one of other people's code: in folders such as third_party, and in submodules. What several
    findings want of one dependency is declared once, in a form that holds for all. originals: gets what was read, which
    the edits count in.
    """
    foreign = tuple(f"{folder}/" for folder in submodules)
    findings = [
        finding._replace(fix=())
        if any(is_vendored(action.path) or action.path.startswith(foreign) for action in finding.fix)
        else finding
        for finding in findings
    ]
    wanted: dict[tuple[str, str], set[str]] = {}
    for finding in findings:
        for action in finding.fix:
            if isinstance(action, Declare):
                wanted.setdefault((action.path, action.name), set()).add(action.tag)
    content: dict[str, bytes | None] = {}

    def build_edits(fix: tuple[FixAction, ...]) -> tuple[Edit, ...]:
        result: list[Edit] = []
        for action in fix:
            if action.path not in content:
                content[action.path] = data = read(action.path)
                if originals is not None and data is not None:
                    originals[action.path] = data
            data = content[action.path]
            part = () if data is None else _make_edits(action, data, wanted)
            if not part:
                return ()
            result += part
        return tuple(result)

    return [finding._replace(fix=build_edits(finding.fix)) if finding.fix else finding for finding in findings]


def _make_edits(action: FixAction, data: bytes, wanted: dict[tuple[str, str], set[str]]) -> tuple[Edit, ...]:
    if isinstance(action, Declare):
        tags = wanted.get((action.path, action.name), {action.tag})
        return declare_dependency(data, action.name, _select_tag(action.tag, tags), action.path)
    if isinstance(action, Remove):
        return remove_dependency(data, action.name, action.tag, action.path)
    if isinstance(action, Replace):
        edit = replace_text(action.path, data, action.line, action.column, action.old, action.new)
        return (edit,) if edit else ()
    if isinstance(action, Insert):
        edit = insert_lines(action.path, data, action.line, action.text)
        return (edit,) if edit else ()
    return (action,)


def _select_tag(tag: str, tags: set[str]) -> str:
    """The tag to declare where several are wanted for one name: `depend` beside its own parts is an error (REP 140)."""
    parts = {*_COVERS["depend"], "depend"}
    if tag in parts and ("depend" in tags or parts - {"depend"} <= tags):
        return "depend"
    return "depend" if tag == "test_depend" and "depend" in tags else tag


def collect(findings: Iterable[Finding]) -> list[tuple[Edit, ...]]:
    """The fixes that findings offer as byte edits (see `made`), in their order, each once."""
    edits = (tuple(part for part in finding.fix if isinstance(part, Edit)) for finding in findings)
    return list(dict.fromkeys(fix for fix in edits if fix))


def apply(fixes: Iterable[Sequence[Edit]], read: Callable[[str], bytes | None]) -> Applied:
    """Applies fixes to the bytes of their files. A fix is applied whole or not at all.

    read: bytes of a path, None when it cannot be read. Where fixes overlap, the first is kept and the others refused;
    an edit asked for twice is made once. Insertions at one place keep their order, dependencies of a manifest excepted.
    """
    content: dict[str, bytes] = {}
    accepted: dict[str, list[Edit]] = {}
    refused: list[tuple[Edit, str]] = []
    for fix in fixes:
        reasons = []
        added: dict[str, list[Edit]] = {}
        for edit in fix:
            if edit.path not in content:
                data = read(edit.path)
                if data is None:
                    reasons.append((edit, "the file cannot be read"))
                    continue
                content[edit.path] = data
            made = accepted.get(edit.path, []) + added.get(edit.path, [])
            if edit in made:
                continue
            reason = _explain_refusal(edit, made, len(content[edit.path]))
            if reason:
                reasons.append((edit, reason))
            else:
                added.setdefault(edit.path, []).append(edit)
        if reasons:
            refused += reasons
            continue
        for path, edits in added.items():
            accepted.setdefault(path, []).extend(edits)
    files = {path: _apply_edits(content[path], edits) for path, edits in accepted.items()}
    return Applied({path: data for path, data in files.items() if data != content[path]}, refused)


def _explain_refusal(edit: Edit, made: Sequence[Edit], size: int) -> str:
    if not 0 <= edit.start <= edit.end <= size:
        return "it reaches outside the file"
    for other in made:
        # Touching is no overlap; an insertion overlaps only strictly inside what another fix replaces.
        if edit.start < other.end and other.start < edit.end:
            return "another fix changes the same place"
    return ""


def _apply_edits(data: bytes, edits: Iterable[Edit]) -> bytes:
    pieces = []
    position = 0
    # Insertions go before a replacement that starts at the same place; sorting is stable, so they keep their order.
    # Dependencies declared at one place are put in alphabetical order, since manifests often are.
    for edit in sorted(
        edits, key=lambda edit: (edit.start, edit.end, (_DECLARATION.match(edit.text) and edit.text) or "")
    ):
        pieces += (data[position : edit.start], edit.text.encode("utf-8", "surrogateescape"))
        position = edit.end
    return b"".join((*pieces, data[position:]))


def make_unified_diff(path: str, old: bytes, new: bytes) -> str:
    """The change as `git apply` and `patch -p1` read it, empty when nothing changes. Bytes that are no UTF-8 come as
    surrogate escapes."""
    from difflib import unified_diff as diff

    if old == new:
        return ""
    before, after = (re.findall(r"[^\n]*\n|[^\n]+", data.decode("utf-8", "surrogateescape")) for data in (old, new))
    lines = []
    for line in diff(before, after, _diff_name(f"a/{path}"), _diff_name(f"b/{path}")):
        lines.append(line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n")
    return "".join(lines)


def _diff_name(path: str) -> str:
    """A path as git writes it in a patch: in quotes where it holds control characters, ended with a tab where it holds
    a space, so that no reader takes the rest for a date."""
    if re.search("[\x00-\x1f\x7f]", path):
        quoted = re.sub(r'["\\]', r"\\\g<0>", path)
        return '"' + re.sub("[\x00-\x1f\x7f]", lambda match: f"\\{ord(match[0]):03o}", quoted) + '"'
    return f"{path}\t" if " " in path else path


def write(root: Path, path: str, data: bytes, original: bytes) -> None:
    """Replaces the content of a file of a workspace in one step, keeping its mode.

    original: what the fixes were made for; a file that holds anything else by now is left alone. So is one that is a
    link, or that is reached through a link: its fix belongs to where it lies. Raises OSError; the file is then as it
    was.
    """
    write_file(os.path.join(root, path), data, beneath=root, instead_of=original)


def compute_offset(data: bytes, line: int, column: int = 1) -> int:
    """Byte offset of a line and column, both counted from 1, columns in characters; a byte-order mark takes none.

    The column behind the last character is the line's end. Raises ValueError for a place outside the file.
    """
    starts = _find_line_starts(data)
    if line > len(starts):
        raise ValueError(f"there is no line {line}")
    start = starts[max(line, 1) - 1]
    end = data.find(b"\n", start)
    text = data[start : len(data) if end < 0 else end].decode("utf-8", "surrogateescape")
    if line < 1 or not 1 <= column <= len(text) + 1:
        raise ValueError(f"there is no column {column} in line {line}")
    return start + len(text[: column - 1].encode("utf-8", "surrogateescape"))


@lru_cache(maxsize=4)
def _find_line_starts(data: bytes) -> array[int]:
    """The offset of each line; one file may have as many fixes as lines."""
    starts = array("q", (len(_BOM) if data.startswith(_BOM) else 0,))
    starts.extend(match.end() for match in re.finditer(rb"\n", data))
    return starts


def replace_text(path: str, data: bytes, line: int, column: int, old: str, new: str) -> Edit | None:
    """The edit that replaces `old` by `new` where it starts at a line and column (0: its only place in the line), None
    when it does not stand there."""
    wanted = old.encode()
    try:
        start = compute_offset(data, line, max(column, 1))
    except ValueError:
        return None
    if column < 1:
        end = data.find(b"\n", start)
        if data.count(wanted, start, len(data) if end < 0 else end) != 1:
            return None
        start = data.find(wanted, start)
    return Edit(path, start, start + len(wanted), new) if data.startswith(wanted, start) else None


def insert_lines(path: str, data: bytes, line: int, text: str) -> Edit | None:
    """The edit that puts lines behind a line (0: at the start), indented and ended as that line is; None when there is
    no such line. In CMake, where a command may span lines, they go behind the last line of the command, or nowhere when
    something else follows it there."""
    if line and (path.endswith(".cmake") or path.rpartition("/")[2] == "CMakeLists.txt"):
        return _insert_after_command(path, data, line, text)
    ending = _find_line_ending(data, 0)
    if line == 0:
        start = len(_BOM) if data.startswith(_BOM) else 0
        return Edit(path, start, start, text.replace("\n", ending) + ending)
    try:
        start = compute_offset(data, line)
    except ValueError:
        return None
    if start == len(data):
        return None
    end = data.find(b"\n", start)
    return _insert_lines_after(path, data, start, end, text, ending if end < 0 else _find_line_ending(data, start))


def _insert_lines_after(path: str, data: bytes, start: int, end: int, text: str, ending: str) -> Edit:
    """The edit that puts lines behind those of a place, indented as the first of them is. end: of the last, or -1."""
    own = data[start : len(data) if end < 0 else end]
    indent = own[: len(own) - len(own.lstrip(b" \t"))].decode("ascii")
    lines = ending.join(indent + each if each else each for each in text.split("\n"))
    if end < 0:
        return Edit(path, len(data), len(data), ending + lines)
    return Edit(path, end + 1, end + 1, lines + ending)


def _insert_after_command(path: str, data: bytes, line: int, text: str) -> Edit | None:
    """As insert_lines, behind the CMake command that the first word of a line belongs to."""
    try:
        start = compute_offset(data, line)
    except ValueError:
        return None
    depth, opened = 0, 0
    for match in _CMAKE.finditer(data):
        if match[0] == b"(":
            opened = opened if depth else data.rfind(b"\n", 0, match.start()) + 1
            depth += 1
        elif match[0] == b")":
            depth -= 1
            if depth or match.end() <= start:
                continue
            end = data.find(b"\n", match.end())
            if not _CMAKE_REST.match(data[match.end() : len(data) if end < 0 else end]):
                return None
            return _insert_lines_after(path, data, opened, end, text, _find_line_ending(data, opened))
    return None


class _Element(NamedTuple):
    """A child of <package>: tag, stripped text, whether it stands under a condition, byte offsets of all of it."""

    tag: str
    text: str
    conditional: bool
    start: int
    end: int


class _Manifest(NamedTuple):
    format: int
    children: tuple[_Element, ...]
    close: int


def declare_dependency(data: bytes, name: str, tag: str = "depend", path: str = "package.xml") -> tuple[Edit, ...]:
    """Edits that declare a dependency in a manifest, empty when it is there already or none would be surely right.

    data: the manifest. tag: as format 2 and 3 know it; what it stands for in format 1 is written there. A new element
    goes behind the last one of its tag, or to its place where they are sorted, with their indentation and line ending.
    Parts that are declared already are left out: `depend` beside a `build_depend` adds only what is missing.
    """
    manifest = _parse_manifest(data)
    if manifest is None or not _NAME.match(name):
        return ()
    present = {child.tag for child in manifest.children if child.text == name}
    if any(child.conditional for child in manifest.children if child.text == name):
        return ()
    if manifest.format == 1:
        tags = tuple(each for each in translate_tag(tag, 1) if each not in present)
        covered = present & ({"build_depend", "run_depend"} if tag == "test_depend" else {"test_depend"})
    else:
        wanted = _COVERS.get(tag, (tag,))
        have = {part for each in present for part in _COVERS.get(each, (each,))}
        missing = tuple(part for part in wanted if part not in have)
        tags = ("depend",) if tag == "depend" and missing == wanted else missing
        covered = {"depend"} & present if tag == "test_depend" else set()
    if covered:
        return ()
    return tuple(_insert_dependency(data, manifest, name, each, path) for each in tags)


def remove_dependency(data: bytes, name: str, tag: str = "", path: str = "package.xml") -> tuple[Edit, ...]:
    """Edits that take a dependency out of a manifest, of one tag or of all. A line that holds nothing else goes too."""
    manifest = _parse_manifest(data)
    edits = []
    for child in manifest.children if manifest else ():
        if child.text != name or child.tag not in _TAG_ORDER or tag not in ("", child.tag):
            continue
        start, end = _find_line_span(data, child.start, child.end)
        alone = not data[start : child.start].strip() and not data[child.end : end].strip()
        edits.append(Edit(path, start, end, "") if alone else Edit(path, child.start, child.end, ""))
    return tuple(edits)


@lru_cache(maxsize=4)
def _parse_manifest(data: bytes) -> _Manifest | None:
    """The children of <package> with their offsets, None when the file is no manifest that can be followed."""
    # In what is no XML, or has a DOCTYPE, the patterns take quadratic time, and mean something else.
    if b"<!DOCTYPE" in data or not _is_xml(data):
        return None
    children: list[_Element] = []
    open_tags: list[str] = []
    version = 1
    opened, text_from, conditional = 0, 0, False
    for match in _MARKUP.finditer(data):
        if match["tag"] is None:
            continue
        tag = match["tag"].decode("ascii", "replace")
        if not open_tags and not match["close"]:
            if tag != "package" or match["empty"]:
                return None
            found = re.search(rb"""\bformat\s*=\s*["']\s*([0-9]{1,9})\b""", match["attributes"])
            version = int(found[1]) if found else 1
        if match["close"]:
            if not open_tags or open_tags.pop() != tag:
                return None
            if not open_tags:
                return _Manifest(version, tuple(children), match.start())
            if len(open_tags) == 1:
                text = data[text_from : match.start()].decode("utf-8", "replace")
                text = re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL).strip()
                children.append(_Element(tag, text, conditional, opened, match.end()))
        else:
            if len(open_tags) == 1:
                opened, text_from = match.start(), match.end()
                conditional = re.search(rb"\bcondition\s*=", match["attributes"]) is not None
                if match["empty"]:
                    children.append(_Element(tag, "", conditional, opened, match.end()))
            if not match["empty"]:
                open_tags.append(tag)
    return None


def _is_xml(data: bytes) -> bool:
    from xml.parsers import expat

    try:
        expat.ParserCreate().Parse(data, True)
    except (expat.ExpatError, ValueError, LookupError):
        return False
    return True


def _insert_dependency(data: bytes, manifest: _Manifest, name: str, tag: str, path: str) -> Edit:
    element = f"<{tag}>{name}</{tag}>"
    siblings = [child for child in manifest.children if child.tag == tag]
    texts = [child.text for child in siblings]
    if len(siblings) > 1 and texts == sorted(texts):
        place = bisect_left(texts, name)
        return (
            _insert_after(data, siblings[place - 1], element, path)
            if place
            else _insert_before(data, siblings[0], element, path)
        )
    if siblings:
        return _insert_after(data, siblings[-1], element, path)
    rank = _TAG_ORDER.index(tag) if tag in _TAG_ORDER else len(_TAG_ORDER)
    related = [child for child in manifest.children if child.tag in _TAG_ORDER]
    earlier = [child for child in related if _TAG_ORDER.index(child.tag) < rank]
    if earlier:
        return _insert_after(data, earlier[-1], element, path)
    for child in manifest.children:
        if child in related or child.tag in ("member_of_group", "group_depend", "export"):
            return _insert_before(data, child, element, path)
    if manifest.children:
        return _insert_after(data, manifest.children[-1], element, path)
    return Edit(path, manifest.close, manifest.close, element)


def _find_line_span(data: bytes, start: int, end: int) -> tuple[int, int]:
    """Offsets of the whole lines around a piece, the last line's end included."""
    after = data.find(b"\n", end)
    return data.rfind(b"\n", 0, start) + 1, len(data) if after < 0 else after + 1


def _indent(data: bytes, child: _Element) -> tuple[int, str | None]:
    """(start of the child's line, its indentation; None when something else stands before it there)."""
    start = data.rfind(b"\n", 0, child.start) + 1
    before = data[start : child.start]
    return start, before.decode("ascii", "replace") if not before.strip(b" \t") else None


def _find_line_ending(data: bytes, offset: int) -> str:
    """The line ending behind an offset, or before it on the last line."""
    end = data.find(b"\n", offset)
    if end < 0:
        end = data.rfind(b"\n", 0, offset)
    return "\r\n" if end > 0 and data[end - 1 : end] == b"\r" else "\n"


def _insert_after(data: bytes, child: _Element, element: str, path: str) -> Edit:
    _, indent = _indent(data, child)
    if indent is None:
        return Edit(path, child.end, child.end, element)
    end = data.find(b"\n", child.end)
    end = len(data) if end < 0 else end
    end -= data[end - 1 : end] == b"\r"
    # A remark on the sibling's own line stays with it.
    place = end if _COMMENTS_ONLY.match(data[child.end : end]) else child.end
    return Edit(path, place, place, _find_line_ending(data, child.end) + indent + element)


def _insert_before(data: bytes, child: _Element, element: str, path: str) -> Edit:
    start, indent = _indent(data, child)
    if indent is None:
        return Edit(path, child.start, child.start, element)
    return Edit(path, start + len(indent), start + len(indent), element + _find_line_ending(data, child.end) + indent)
