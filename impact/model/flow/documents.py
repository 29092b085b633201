"""YAML files of the workspace that code in Python reads by itself (`yaml.safe_load(open(path))`), as what is in them
would be written in the code."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple, Protocol

from ....edges.memory import cache_method
from ...facts.flow import FlowExpr
from ...facts.launch.parameter_files import ParameterEntry, ParameterFile
from .code import FlowCode, Fn, get_tail
from .elements import SETTING, select_reaching
from .reaching import FlowValue

_LOADS = frozenset(("yaml.safe_load", "yaml.load", "yaml.full_load", "yaml.unsafe_load"))
_LOAD_TAILS = frozenset(map(get_tail, _LOADS))
SHARES = frozenset(("get_package_share_directory", "get_package_share_path"))
"""Functions that give the folder in which a package is installed what it shares."""
# What a path is the same file after.
_SAME = frozenset(("abspath", "realpath", "normpath", "expanduser", "expandvars", "fspath", "Path", "PurePath", "str"))
_SAME_METHODS = frozenset(("resolve", "absolute", "as_posix", "read_text", "read", "open"))
_FOUND = re.compile(r"\$\(find ([\w.-]+)\)/*")
_TOP = "$(top)/"
_DEEPEST = 8
_MOST_ENTRIES = 2_000
_KEPT = (str, int, float, bool, type(None))


class KnownValues(Protocol):
    """What is known of expressions where the code runs."""

    code: FlowCode

    def evaluate(self, value: FlowExpr | None, fn: Fn, line: int = 0) -> list[FlowValue]:
        """What an expression may be worth."""
        ...


class _KnownPath(NamedTuple):
    """A path, from `$(find PACKAGE)` or from the top of the workspace. how: as in FlowValue."""

    text: str
    how: str = "literal"

    def change(self, text: str) -> _KnownPath:
        """Another path that is known in the same way."""
        return self._replace(text=text)


class Documents:
    """Asks which files a body of code reads, and what is in them. find_file: the workspace path of a file in a
    package's share folder, empty for none; read: the values of a file of the workspace, None where it has none."""

    def __init__(
        self,
        find_file: Callable[[str, str], str] = lambda package, path: "",
        read: Callable[[str], ParameterFile | None] = lambda path: None,
    ):
        self._find_file, self._read = find_file, read

    def find(self, value: FlowExpr, fn: Fn, line: int, values: KnownValues) -> FlowExpr | None:
        """What a call gives that loads a YAML file; None for all else, and where the file is not known. values: what
        expressions are worth where it runs."""
        if get_tail(value.text) not in _LOAD_TAILS or not value.parts or fn.source.facts.language != "python":
            return None
        if values.code.resolve_name(value.text, fn.source) not in _LOADS:
            return None
        path = _Paths(values).find(value.parts[0], fn, line)
        return self._make_document(path.text, path.how) if path is not None else None

    @cache_method
    def _make_document(self, path: str, how: str) -> FlowExpr | None:
        found = _FOUND.match(path)
        if found is not None:
            place = self._find_file(found[1], posixpath.normpath(path[found.end() :]))
        else:
            place = posixpath.normpath(path.removeprefix(_TOP)) if path.startswith(_TOP) else ""
        file = self._read(place) if place else None
        if file is None or file.problems or len(file.entries) > _MOST_ENTRIES:
            return None
        return _make_mapping(((entry.path, entry) for entry in file.entries), how)


class _Paths:
    """One search for the path that an expression is."""

    def __init__(self, values: KnownValues):
        self._values, self._code = values, values.code

    def find(self, value: FlowExpr, fn: Fn, line: int, depth: int = 0) -> _KnownPath | None:
        """The path; None where it is not known, or one of several. line: of the statement."""
        if depth > _DEEPEST:
            return None
        if value.kind == "text":
            return _KnownPath(value.text)
        if value.kind == "keyword" and value.parts:
            return self.find(value.parts[0], fn, line, depth + 1)
        if value.kind == "join":
            return self._join(value, fn, line, depth)
        if value.kind in ("call", "make"):
            return self._find_called(value, fn, line, depth)
        if value.kind == "index" and value.parts[0].text.endswith(".parents") and value.parts[1].text.isdecimal():
            inner = value.parts[0].receiver or FlowExpr("name", value.parts[0].text.removesuffix(".parents"))
            return self._climb(self.find(inner, fn, line, depth + 1), int(value.parts[1].text) + 1)
        if value.kind == "name" and value.text == "__file__":
            return _KnownPath(_TOP + fn.source.path)
        if value.kind == "name" and value.text.endswith(".parent"):
            inner = value.receiver or FlowExpr("name", value.text.removesuffix(".parent"))
            return self._climb(self.find(inner, fn, line, depth + 1), 1)
        if value.kind == "name":
            return self._find_named(value, fn, line, depth)
        return None

    def _join(self, value: FlowExpr, fn: Fn, line: int, depth: int) -> _KnownPath | None:
        parts = [self.find(part, fn, line, depth + 1) for part in value.parts]
        known = [part for part in parts if part is not None]
        if len(known) < len(parts) or value.text not in ("", "+", "/"):
            return None
        texts = [part.text for part in known]
        how = next((part.how for part in known if part.how != "literal"), "literal")
        return _KnownPath(posixpath.join(*texts) if value.text == "/" else "".join(texts), how)

    def _find_called(self, value: FlowExpr, fn: Fn, line: int, depth: int) -> _KnownPath | None:
        head, _, last = value.text.rpartition(".")
        inner = value.receiver or FlowExpr("name", head)
        if last in SHARES and len(value.parts) == 1 and value.parts[0].kind == "text":
            return _KnownPath(f"$(find {value.parts[0].text})")
        if last == "get_path" and len(value.parts) == 1 and value.parts[0].kind == "text":
            return _KnownPath(f"$(find {value.parts[0].text})") if self._is_pack(inner, fn) else None
        if last == "join" and head.rpartition(".")[2] in ("path", "osp", "posixpath"):
            return self._join(FlowExpr("join", "/", value.parts), fn, line, depth)
        if last == "joinpath":
            return self._join(FlowExpr("join", "/", (inner, *value.parts)), fn, line, depth)
        if last == "dirname" and len(value.parts) == 1:
            return self._climb(self.find(value.parts[0], fn, line, depth + 1), 1)
        if (last in _SAME or (last == "open" and not head)) and value.parts:
            return self.find(value.parts[0], fn, line, depth + 1)
        if last in _SAME_METHODS and head:
            return self.find(inner, fn, line, depth + 1)
        return self._evaluate(value, fn, line)

    def _is_pack(self, value: FlowExpr, fn: Fn) -> bool:
        """Whether an expression is what finds packages in ROS 1."""
        if value.kind == "call" or value.text.endswith("()"):
            return get_tail(value.text.removesuffix("()")) == "RosPack"
        written = self._code.list_writes(self._code.identify(value.text, fn))
        return bool(written) and all(get_tail(each.value.text) == "RosPack" for _, each in written)

    def _find_named(self, value: FlowExpr, fn: Fn, line: int, depth: int) -> _KnownPath | None:
        variable = self._code.identify(value.text, fn)
        written = self._code.list_writes(variable)
        if variable.kind == "local" and all(writer is fn for writer, _ in written):
            written = select_reaching(written, fn, line)
        if len(written) == 1 and written[0][1].operator == "=":
            writer, each = written[0]
            found = self.find(each.value, writer, each.line, depth + 1)
            if found is not None:
                return found
        return self._evaluate(value, fn, line)

    def _evaluate(self, value: FlowExpr, fn: Fn, line: int) -> _KnownPath | None:
        found = self._values.evaluate(value, fn, line)
        text = found[0].text if len(found) == 1 and not found[0].only_if else None
        return _KnownPath(text, found[0].how) if text is not None else None

    @staticmethod
    def _climb(path: _KnownPath | None, steps: int) -> _KnownPath | None:
        if path is None or path.text.count("/") < steps:
            return None
        text = path.text
        for _ in range(steps):
            text = posixpath.dirname(text)
        return path.change(text if text != _TOP.rstrip("/") else _TOP)


def _make_mapping(rows: Iterable[tuple[tuple[str, ...], ParameterEntry]], how: str) -> FlowExpr:
    """A dictionary of values by the keys that lead to them."""
    below: dict[str, list[tuple[tuple[str, ...], ParameterEntry]]] = {}
    for keys, entry in rows:
        if not keys:
            return _make_value(entry.value, how)
        below.setdefault(keys[0], []).append((keys[1:], entry))
    pairs = (FlowExpr("list", "", (FlowExpr("text", key), _make_mapping(inner, how))) for key, inner in below.items())
    return FlowExpr("list", "", tuple(pairs))


def _make_value(value: Any, how: str) -> FlowExpr:
    if isinstance(value, dict):
        pairs = ((FlowExpr("text", str(key)), _make_value(one, how)) for key, one in value.items())
        return FlowExpr("list", "", tuple(FlowExpr("list", "", pair) for pair in pairs))
    if isinstance(value, (list, tuple)):
        return FlowExpr("list", "", tuple(_make_value(one, how) for one in value))
    if not isinstance(value, _KEPT):
        return FlowExpr("other", str(value))
    if how != "literal":
        return FlowExpr(SETTING, str(value), (FlowExpr("text", how),))
    return FlowExpr("text" if isinstance(value, str) else "number", str(value))
