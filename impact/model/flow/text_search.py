"""What a search of the text finds of calls of the frameworks, beside what was understood of the code.

Reading code by its structure fails in silence where a call has a form that nothing knows: a search of the text tells
how much that is, package by package, and where.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache

from msgspec.structs import replace

from ...facts.flow import FlowExpr
from .code import Fn, get_tail
from .frameworks import load_frameworks
from .graph import Graph, PackageCoverage, Unresolved
from .join import Join

# Names that little else has; what is called `add_*` or `create_*` is asked for by the names in the table alone.
_STEMS = ("advertise", "create_", "subscribe", "declare_parameter", "add_")
_FILTER = "Subscriber"
_BYTES = tuple(stem.encode() for stem in (*_STEMS, _FILTER))
_ROLES = frozenset(
    ("publisher", "subscriber", "server", "client", "action server", "action client", "parameter", "timer")
)
_CPP = re.compile(r"//[^\n]*|/\*.*?\*/|\"(?:[^\"\\\n]|\\.)*\"|'(?:[^'\\\n]|\\.)'", re.DOTALL)
_PYTHON = re.compile(r"#[^\n]*|\"\"\".*?\"\"\"|'''.*?'''|\"(?:[^\"\\\n]|\\.)*\"|'(?:[^'\\\n]|\\.)*'", re.DOTALL)
# What stands before the name of a function that is declared or defined: a type, or `def`.
_DECLARES = re.compile(r"(?:\bdef|[\w>*&])\s+(?:[\w:]+::)?$")
_RETURNS = re.compile(r"\b(?:return|else|co_return|case|throw|await|in|and|or|not)\s+(?:[\w:]+::)?$")
_MACRO = re.compile(r"[ \t]*#")


def add_text_coverage(graph: Graph, code: Join, read: Callable[[str], bytes]) -> Graph:
    """A graph of code with what a search of its text finds. read: the content of a file."""
    known = _list_known(code, graph)
    functions: dict[str, list[Fn]] = {}
    for fn in code.code.functions:
        functions.setdefault(fn.source.path, []).append(fn)
    counts: dict[str, list[int]] = {}
    missed: list[Unresolved] = []
    for source in code.code.sources:
        path = source.path
        try:
            data = read(path)
        except (OSError, KeyError):
            continue
        if not any(stem in data for stem in _BYTES):
            continue
        text = data.decode("utf-8", "replace")
        hits = list(_search(text))
        if any((path, line) not in known for line, _ in hits):  # it may be a comment
            hits = list(_search(_blank(text, source.facts.language)))
        hits += _list_handed_on(functions.get(path, ())) if source.facts.language == "python" else ()
        own = _list_own(code, functions.get(path, ()), {name for _, name in hits}) if hits else set()
        for line, name in hits:
            if (line, name) in own:
                continue
            count = counts.setdefault(source.package, [0, 0])
            count[0] += 1
            if (path, line) in known:
                count[1] += 1
            else:
                reason = "it looks like a call of a framework, and is not known to be one"
                missed.append(Unresolved("call", reason, path, line, name))
    packages = tuple(PackageCoverage(package, *count) for package, count in sorted(counts.items()))
    return replace(graph, coverage=replace(graph.coverage, by_text=packages, missed=tuple(missed)))


@cache
def _list_searched() -> frozenset[str]:
    """The names of functions that are searched for."""
    calls = load_frameworks().calls
    making = (name for name, rows in calls.items() if any(row.does in _ROLES for row in rows))
    return frozenset(name for name in making if name.startswith(_STEMS))


@cache
def _compile_search() -> re.Pattern[str]:
    listed = "|".join(sorted(map(re.escape, _list_searched()), key=lambda name: (-len(name), name)))
    return re.compile(rf"({listed})\s*(?:<[^;{{}}()]*>\s*)?\(|(Subscriber)\s*<[^;{{}}()]*>\s*\w*\s*[({{]")


def _search(text: str) -> Iterator[tuple[int, str]]:
    """Lines on which a text calls what is named like a framework's function, each with that name."""
    pattern, places = _compile_search(), []
    for stem in (*_STEMS, _FILTER):
        at = text.find(stem)
        while at >= 0:
            places.append(at)
            at = text.find(stem, at + 1)
    line, counted = 1, 0
    for at in sorted(places):
        if at and (text[at - 1].isalnum() or text[at - 1] in "_~"):
            continue
        match = pattern.match(text, at)
        before = text[text.rfind("\n", 0, at) + 1 : at]
        if match is None or _MACRO.match(before) or (_DECLARES.search(before) and not _RETURNS.search(before)):
            continue
        line, counted = line + text.count("\n", counted, at), at
        yield line, match[1] or match[2]


def _list_handed_on(functions: Sequence[Fn]) -> list[tuple[int, str]]:
    """Where functions of Python hand on a method that is named like a framework's function, and it is not seen that it
    is called: by line and name."""
    names, found = _list_searched(), dict[tuple[int, str], None]()
    for fn in functions:
        given = [(each.value, each.line) for each in fn.facts.assignments]
        given += [(one, call.line) for call in fn.facts.calls for one in call.arguments]
        for value, line in ((part, line) for whole, line in given for part in _list_parts(whole)):
            name = get_tail(value.text) if value.kind in ("name", "function") and "." in value.text else ""
            inner = (one for one in functions if one is fn or one.name.startswith(f"{fn.name}."))
            if name in names and not any(one.list_calls(value.text) for one in inner):
                found[line, name] = None
    return list(found)


def _list_parts(value: FlowExpr) -> Iterator[FlowExpr]:
    """An expression, or those that it chooses from, lists or binds."""
    if value.kind not in ("choice", "list", "keyword", "bind"):
        yield value
    else:
        for part in value.parts:
            yield from _list_parts(part)


def _blank(text: str, language: str) -> str:
    """A text without comments and literals, its lines kept."""
    return (_CPP if language == "cpp" else _PYTHON).sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)


def _list_known(code: Join, graph: Graph) -> set[tuple[str, int]]:
    """The lines of what is in a graph, and of calls that are understood as no part of it."""
    rows = (*graph.endpoints, *graph.timers, *graph.parameters, *graph.coverage.unresolved, *graph.coverage.wrappers)
    found = {(row.path, row.line) for row in rows}
    uses = (use for use in code.calls.uses if not code.is_of_other_ros(use))
    found.update((use.fn.source.path, use.call.line) for use in uses)
    return found


def _list_own(code: Join, functions: Iterable[Fn], names: set[str]) -> set[tuple[int, str]]:
    """Where functions of the code have some names, or call such functions of the code: by line and name."""
    found: set[tuple[int, str]] = set()
    for fn in functions:
        if get_tail(fn.name) in names:
            found.update((line, get_tail(fn.name)) for line in range(fn.facts.line - 2, fn.facts.line + 1))
        for call in fn.facts.calls:
            name = get_tail(call.callee)
            if name in names and code.code.list_targets(call.callee, fn):
                found.add((call.line, name))
    return found
