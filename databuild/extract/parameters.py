"""Parameters that the sources of a node declare by their names, with their defaults.

Read are calls of `declare_parameter` and of functions that are called alike, in C++ and Python; the parameter files of
generate_parameter_library; and `gen.add` in the .cfg files of dynamic_reconfigure. Nothing is run: a name that is put
together counts by its last part, written `*.name`, and a default that is no plain value is `?`.

Names that are declared in yet another way (from a table, by a function of the package's own) are not found, so that a
file also tells which names its texts mention at all: what no file mentions, no file declares.
"""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from typing import Any

import msgspec

from ...edges.documents import load_yaml
from ...impact.facts.cpp.lexical import scan
from ...impact.facts.cpp.tree_nodes import SIGNS, RegisteredNode
from ...impact.facts.place import Problem
from ...impact.facts.python.constants import Constants
from ...impact.facts.python.source import read
from ...impact.facts.usage import find_argument_spans
from ...impact.targets.parameters import find_last_part


class DeclaredParameter(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A parameter. default: as written, None for none, `?` where it is no plain value."""

    name: str
    default: str | None = None


class ParametersFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """parameters: in the order of the file. mentioned: see mentions(), the last parts of names (`scale` of
    `PathAlign.scale`), each once; comments count too. tree_nodes: nodes of behaviour trees, in the order of
    the file."""

    parameters: tuple[DeclaredParameter, ...] = ()
    problems: tuple[Problem, ...] = ()
    mentioned: tuple[str, ...] = ()
    tree_nodes: tuple[RegisteredNode, ...] = ()


Facts = ParametersFile
LIMITS = {"cpp": "cpp", "python": "python", "cfg": "script", "yaml": "parameters"}
"""What facts/kinds.py asks a module that makes facts for: their type, and which limit the size of files has."""


def make_kind(language: str) -> str:
    """The kind of these facts of files in one of the languages of LIMITS."""
    return f"{__name__}:{language}"


def extract(data: bytes, language: str) -> ParametersFile:
    """What a file declares. language: one of LIMITS. Raises nothing that kinds.extract() does not contain."""
    readers = {"cpp": _list_in_cpp, "python": _list_in_python, "cfg": _list_in_cfg, "yaml": _list_in_yaml}
    mentioned = _list_mentioned_names(data) if language in ("cpp", "python") else ()
    problems: tuple[Problem, ...] = ()
    if language in ("python", "cfg"):
        source = read(data)
        problems = source.problems or source.python2_only[:1] if source.tree is None else ()
    tree_nodes = tuple(scan(data).list_tree_nodes()) if any(sign in data for sign in _SIGNS) else ()
    return ParametersFile(tuple(dict.fromkeys(readers[language](data))), problems, mentioned, tree_nodes)


_SIGNS = tuple(sign.encode() for sign in SIGNS)


_TEXT = re.compile(rb"""["']([A-Za-z_~/.][\w./]{0,80})["']""")


def _list_mentioned_names(data: bytes) -> tuple[str, ...]:
    """The last parts of all texts that could be, or end, the name of a parameter."""
    return tuple(sorted({find_last_part(text.decode("ascii").rstrip("./")) for text in _TEXT.findall(data)} - {""}))


def mentions(mentioned: Collection[str], name: str) -> bool:
    """Whether one of the texts of ParametersFile.mentioned may be, begin or end a parameter's name."""
    last = find_last_part(name)
    return last in mentioned or any(
        (one[0] == "_" and last.endswith(one)) or (one[-1] == "_" and last.startswith(one)) for one in mentioned
    )


_DECLARES = re.compile(r"declare\w*_parameters?(?:_\w+)?\Z")
_CALL = re.compile(r"\b(declare\w*_parameters?(?:_\w+)?)\s*(?:<[^;(){}]*>)?\s*\(")
_NAME = re.compile(r'\s*(?:std::string\s*\(\s*)?"([\w./]+)"\s*\)?\s*\Z')
_LAST_NAME = re.compile(r'[\s\S]*[\w)]\s*\+\s*"\.?([\w./]+)"\s*\Z')
_PAIR = re.compile(r'\{\s*"([\w./]+)"\s*,([^{}]*|[^{}]*\{[^{}]*\}[^{}]*)\}')
_WRAPPED = re.compile(r"(?:(?:rclcpp::)?ParameterValue|std::string)\s*[({](.*)[)}]\Z", re.DOTALL)
_VALUE = r'(?:[-+]?[\d.][\w.+\'-]*|true|false|"(?:[^"\\\n]|\\.)*")'
_VECTOR = re.compile(r"\Astd::vector<[\w:]+>\s*(?=\{)")
# Something stands between two values, so that a row of digits can be parted in one way only.
_PLAIN = re.compile(rf"{_VALUE}\Z|\{{\s*(?:{_VALUE}(?:\s*,\s*|\s+|(?=[\"}}])))*\}}\Z")
_NO_DEFAULT = re.compile(
    r"(?:rclcpp::)?(?:ParameterType::)?PARAMETER_\w+\Z|rcl_interfaces::|(?:\w+_)?desc(?:riptor)?\w*\Z"
)
_SHOWN = 60
# No default value that anybody compares is longer.
_LONGEST = 10_000


def _list_in_cpp(data: bytes) -> Iterator[DeclaredParameter]:
    if b"declare" not in data:
        return
    scanned = scan(data)
    for call in _CALL.finditer(scanned.visible):
        # Where they end is told by the text without literals and comments; they are read as they are written.
        spans, _ = find_argument_spans(scanned.visible, call.end() - 1) or ((), 0)
        arguments = [scanned.text[begins:ends] for begins, ends in spans]
        if call[1].endswith("_parameters"):
            space = _NAME.match(arguments[0]) if arguments else None
            for name, value in _PAIR.findall(arguments[1]) if len(arguments) > 1 else ():
                yield DeclaredParameter(f"{space[1]}.{name}" if space else name, _normalize(value))
            continue
        for place, text in enumerate(arguments[:2]):
            whole, last = _NAME.match(text), _LAST_NAME.match(text)
            if whole or last:
                name = whole[1] if whole else f"*.{last[1]}" if last else ""
                yield DeclaredParameter(name, _normalize(arguments[place + 1]) if place + 1 < len(arguments) else None)
                break


def _normalize(text: str) -> str | None:
    value = " ".join(text.split())
    if len(value) > _LONGEST:
        return "?"
    while (wrapped := _WRAPPED.match(value)) is not None:
        value = wrapped[1].strip()
    if not value or _NO_DEFAULT.match(value):
        return None
    value = _VECTOR.sub("", value.replace("'", ""))
    return _shorten(_normalize_number(value)) if _PLAIN.match(value) else "?"


def _normalize_number(value: str) -> str:
    """A real number as Python writes it; anything else as it is."""
    try:
        return str(float(value.rstrip("fF"))) if "." in value and value[0] not in '"{' else value
    except ValueError:
        return value


def _shorten(value: str) -> str:
    return value if len(value) <= _SHOWN else "?"


def _list_in_python(data: bytes) -> Iterator[DeclaredParameter]:
    tree = read(data).tree if b"declare" in data else None
    if tree is None:
        return
    constants = find_module_constants(tree)
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Attribute):
            continue
        if not _DECLARES.match(node.func.attr):
            continue
        given = {keyword.arg: keyword.value for keyword in node.keywords}
        if node.func.attr.endswith("_parameters"):
            space, listed = [*node.args, None, None][:2]
            space, listed = space or given.get("namespace"), listed or given.get("parameters")
            reported = constants.find_value(space) if space is not None else None
            start = f"{reported}." if isinstance(reported, str) and reported else ""
            for item in listed.elts if isinstance(listed, (ast.List, ast.Tuple)) else ():
                if isinstance(item, (ast.Tuple, ast.List)) and item.elts:
                    default = item.elts[1] if len(item.elts) > 1 else None
                    yield from _read_python_parameter(item.elts[0], default, constants, start)
            continue
        name = node.args[0] if node.args else given.get("name")
        yield from _read_python_parameter(name, node.args[1] if len(node.args) > 1 else given.get("value"), constants)


def find_module_constants(tree: ast.Module) -> Constants:
    """The names that the module itself binds and nothing in it binds again, so that they mean the same everywhere."""
    bound = Counter(
        node.id if isinstance(node, ast.Name) else node.arg
        for node in ast.walk(tree)
        if isinstance(node, ast.arg) or (isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load))
    )
    constants = Constants()
    for statement in tree.body:
        if isinstance(statement, ast.Assign) and len(statement.targets) == 1:
            target = statement.targets[0]
        elif isinstance(statement, ast.AnnAssign):
            target = statement.target
        else:
            continue
        if isinstance(target, ast.Name) and bound[target.id] == 1 and statement.value is not None:
            constants.assign(target, constants.find_value(statement.value))
    return constants


def _read_python_parameter(
    name: ast.expr | None, default: ast.expr | None, constants: Constants, start: str = ""
) -> Iterator[DeclaredParameter]:
    reported = constants.find_value(name) if name is not None else None
    if isinstance(reported, str):
        yield DeclaredParameter(start + reported, _read_python_value(default, constants))
        return
    last = name.values[-1] if isinstance(name, ast.JoinedStr) and name.values else None
    last = name.right if isinstance(name, ast.BinOp) else last
    if isinstance(last, ast.Constant) and isinstance(last.value, str) and last.value.strip("."):
        yield DeclaredParameter(f"*.{last.value.lstrip('.')}", _read_python_value(default, constants))


def _read_python_value(node: ast.expr | None, constants: Constants) -> str | None:
    if node is None or (isinstance(node, ast.Attribute) and "Parameter" in ast.unparse(node)):
        return None  # a type
    try:
        return _format_value(ast.literal_eval(node))
    except (ValueError, TypeError, SyntaxError, MemoryError):
        reported = constants.find_value(node)
        return _format_value(reported) if isinstance(reported, (str, bool, int, float)) else "?"


def _format_value(value: Any) -> str:
    """A value in the words of C++, as both languages may declare the same."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _shorten(f'"{value}"')
    if isinstance(value, (list, tuple)):
        return _shorten("{" + ", ".join(map(_format_value, value)) + "}")
    return _shorten(str(value))


def _list_in_cfg(data: bytes) -> Iterator[DeclaredParameter]:
    tree = read(data).tree
    constants = find_module_constants(tree) if tree is not None else Constants()
    for node in ast.walk(tree) if tree is not None else ():
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "add":
            given = {keyword.arg: keyword.value for keyword in node.keywords}
            name = node.args[0] if node.args else given.get("name")
            if len(node.args) + len(node.keywords) > 2 and isinstance(name, ast.Constant):
                default = node.args[4] if len(node.args) > 4 else given.get("default")
                yield from _read_python_parameter(name, default, constants)


def _list_in_yaml(data: bytes) -> Iterator[DeclaredParameter]:
    whole = load_yaml(data)
    for each in whole.values() if isinstance(whole, Mapping) else ():
        yield from _list_in_library(each, "")


def _list_in_library(node: Any, start: str) -> Iterator[DeclaredParameter]:
    """Parameters of generate_parameter_library: what has a `type` is one, all else is a group."""
    for name, inner in node.items() if isinstance(node, Mapping) else ():
        if not isinstance(inner, Mapping):
            continue
        path = f"{start}{'*' if str(name).startswith('__map_') else name}"
        if isinstance(inner.get("type"), str):
            default = inner.get("default_value")
            yield DeclaredParameter(path, None if default is None else _format_value(default))
        else:
            yield from _list_in_library(inner, f"{path}.")
