"""Directives of a header: blanked, so that declarations are read without them; macros and warnings that they make."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...impact.facts.condition import Condition
from ...impact.facts.cpp.lexical import Directive, Scan, blank_stretches, list_conditional_blocks
from ...impact.facts.surface import CppParameter, Entity
from .cpp_types import parse_parameters, split_tokens

HIDDEN = re.compile(r"//[^\n]*|/\*.*?(?:\*/|\Z)|\"(?:[^\"\\\n]|\\.)*\"|'(?:[^'\\\n]|\\.)*'", re.DOTALL)
"""Comments and literals."""
_DIRECTIVE = re.compile(r"^[ \t]*#[ \t]*(\w*)([^\n]*(?:(?<=\\)\n[^\n]*)*)", re.MULTILINE)
_DEFINE = re.compile(r"\s*([^\W\d]\w*)(\([^()]*\))?(.*)", re.DOTALL)
_LITERAL = re.compile(r"\(?\s*([-+]?(?:0[xX][\da-fA-F]+|\d[\d.]*(?:[eE][-+]?\d+)?)[uUlLfF]*|\"[^\"\n]{0,60}\")\s*\)?\Z")
_GONE = re.compile(r"deprecat|obsolete|has moved|been moved|been renamed|instead", re.IGNORECASE)
_WARNS = re.compile(
    r"^[ \t]*#[ \t]*(?:warning|pragma[ \t]+(?:message|GCC[ \t]+warning))\b([^\n]*(?:(?<=\\)\n[^\n]*)*)", re.MULTILINE
)


def blank_directives(scanned: Scan) -> tuple[str, list[Entity]]:
    """The visible text with its directives blanked, and the macros that it defines. Where #if branches cut through a
    declaration, all but the first are blanked too."""
    visible = scanned.visible
    if "#" not in visible:
        return visible, []
    gone: list[tuple[int, int]] = []
    undefined: set[str] = set()
    defines: list[tuple[int, int, str]] = []
    directives: list[Directive] = []
    for match in _DIRECTIVE.finditer(visible):
        start, end = match.span()
        gone.append((start, end))
        if match[1] == "define":
            defines.append((start, end, match[2]))
        elif match[1] == "undef":
            undefined.add(match[2].strip())
        else:
            directives.append((start, end, match[1], match[2].strip()))
    for branches in list_conditional_blocks(directives):
        if len(branches) > 2 or branches[0][3] == "0":
            gone += _cut(visible, branches)
    return blank_stretches(visible, sorted(gone)), list(_list_macros(scanned, defines, undefined))


def _list_macros(scanned: Scan, defines: list[tuple[int, int, str]], undefined: set[str]) -> Iterator[Entity]:
    seen: set[tuple[str, tuple[Condition, ...]]] = set()
    for start, end, body in defines:
        match = _DEFINE.match(body)
        if match is None or match[1] in undefined:
            continue
        name = match[1]
        conditions = scanned.find_segment(start)[2]
        if (name, conditions) in seen:
            continue
        parameters = None
        value = ""
        if match[2]:
            parameters = parse_parameters(split_tokens(match[2][1:-1].replace("\\\n", " ")))
        else:
            whole = HIDDEN.sub(_keep_literal, scanned.text[start:end])
            found = _DEFINE.match(whole.split("define", 1)[-1])
            rest = found[3].strip() if found else ""
            literal = _LITERAL.match(rest)
            value = literal[1] if literal else ""
            if not rest and _is_guard(scanned, name, start):
                continue
        seen.add((name, conditions))
        plain = None
        if parameters is not None:
            plain = tuple(CppParameter(parameter.type) for parameter in parameters[0])
            if parameters[1] or "..." in match[2]:
                plain = (*(one for one in plain if one.type), CppParameter("..."))
        line = scanned.locate(start)[0]
        yield Entity("macro", name, line, parameters=plain, value=value, conditions=conditions)


def _is_guard(scanned: Scan, name: str, start: int) -> bool:
    before = scanned.visible[max(0, start - 400) : start].rstrip()
    line = before[before.rfind("\n") + 1 :]
    return line.lstrip()[:1] == "#" and name in line


def find_warning(text: str) -> str | None:
    """What a header that warns of itself says, None when it does not."""
    if "warning" not in text and "pragma" not in text:
        return None
    for match in _WARNS.finditer(text):
        before = text[: match.start()]
        if before.rfind("/*") > before.rfind("*/"):
            continue
        message = " ".join(re.sub(r'\\\n|["()]', " ", match[1]).split())
        if _GONE.search(message):
            return message
    return None


def _keep_literal(match: re.Match[str]) -> str:
    """Literals stay, comments go."""
    return " " if match[0][0] == "/" else match[0]


def _cut(visible: str, branches: list[Directive]) -> list[tuple[int, int]]:
    """Of branches that cut through a declaration, all but one are left out; so is what stands under `#if 0`."""
    bodies = [(branches[number][1], branches[number + 1][0]) for number in range(len(branches) - 1)]
    never = 0 if branches[0][3] == "0" and branches[0][2] == "if" else -1
    if len(bodies) > 1 and any(
        not _is_complete(visible[start:end]) for number, (start, end) in enumerate(bodies) if number != never
    ):
        keep = 1 if never == 0 else 0
        return [body for number, body in enumerate(bodies) if number != keep]
    return [bodies[0]] if never == 0 else []


def _is_complete(body: str) -> bool:
    if body.count("{") != body.count("}") or body.count("(") != body.count(")"):
        return False
    last = ""
    for line in reversed(body.split("\n")):
        line = line.strip()
        if line and line[0] != "#":
            last = line[-1]
            break
    return not last or last in ";{}:)"
