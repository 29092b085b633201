"""Constants of a Python source: what expressions of literals and of names that hold them are, without running it.

Text, places in packages, lists and mappings are followed through names, f-strings, `%`, `format`, `+`, `/` and
`os.path.join`. Whatever else an expression is, is Unresolved.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable
from typing import Any, ClassVar, NamedTuple

from ....edges.dispatch import collect_node_methods
from .text import fill_format, fill_percent, format_dotted, get_source, make_mapping


class TextConstant(str):
    """A string of the file, with the line it stands on."""

    line: int

    def __new__(cls, text: str, line: int) -> TextConstant:
        made = super().__new__(cls, text)
        made.line = line
        return made


class UnknownValue:
    """A value that only running the file would give."""

    __slots__ = ("_source",)

    def __init__(self, source: str | ast.expr):
        self._source = source

    @property
    def what(self) -> str:
        """Its source in a clause."""
        if isinstance(self._source, str):
            return self._source
        text = get_source(self._source)
        return f"`{text if len(text) <= 60 else text[:57] + '...'}`"


class PackagePath(NamedTuple):
    """A value known to lie in the share folder of a package; path is empty for the folder itself. assumed: as far as a
    launch argument keeps its default."""

    package: str
    path: str
    assumed: bool = False


def put_together(parts: Iterable[Any], line: int = 1) -> TextConstant | PackagePath | None:
    """Texts and at most one package folder, put together; None for anything else. `/` between parts of a path is never
    doubled."""
    base: PackagePath | None = None
    text = ""
    for part in parts:
        if isinstance(part, PackagePath):
            if base is not None or text not in ("", "file://"):
                return None
            base, text = part, part.path
        elif not isinstance(part, str):
            return None
        elif text.endswith("/") and part.startswith("/"):
            text += part[1:]
        elif base is not None and not text and not part.startswith("/"):
            return None
        else:
            text += part
    return TextConstant(text, line) if base is None else PackagePath(base.package, text.lstrip("/"), base.assumed)


def join_path(parts: Iterable[Any], line: int) -> Any:
    """Parts of a path put together; None where one is not known."""
    interleaved = [each for part in parts for each in (part, "/")]
    return put_together(interleaved[:-1], line)


MORE = "**"
"""The key of what a mapping has besides, under keys that are not known."""
JOINS = frozenset({"os.path.join", "path.join", "join", "posixpath.join", "osp.join"})
GLOBS = frozenset({"glob", "glob.glob", "iglob", "glob.iglob"})
SAME = frozenset({"list", "tuple", "sorted", "str", "os.path.normpath", "set"})


class Constants:
    """Names and what they hold, as statements assign it one after the other."""

    evaluators: ClassVar[dict[type, Callable[..., Any]]]

    def __init__(self) -> None:
        self.names: dict[str, Any] = {}

    def assign(self, target: ast.expr, value: Any) -> None:
        """Takes in an assignment. What a tuple is taken apart into is not followed."""
        if isinstance(target, ast.Name):
            self.names[target.id] = value
        elif isinstance(target, (ast.Tuple, ast.List)):
            for element in target.elts:
                self.assign(element, UnknownValue("a tuple's part"))
        elif isinstance(target, ast.Subscript) and isinstance(target.value, ast.Name):
            owner, key = self.names.get(target.value.id), self.find_value(target.slice)
            if isinstance(owner, dict) and isinstance(key, str):
                owner[key] = value

    def find_keywords(self, call: ast.Call) -> dict[str, Any]:
        """The keyword arguments of a call, those of `**` included where they are known, else an unknown value MORE."""
        return self.evaluate_Dict(make_mapping(call))

    def find_value(self, node: ast.expr) -> Any:
        """A str (with its line), PackagePath, list, dict, or Unresolved; a file pattern is a str."""
        evaluate = self.evaluators.get(node.__class__)
        found = evaluate(self, node) if evaluate is not None else None
        return UnknownValue(node) if found is None else found

    def evaluate_Constant(self, node: ast.Constant) -> Any:
        return TextConstant(node.value, node.lineno) if isinstance(node.value, str) else node.value

    def evaluate_List(self, node: ast.List | ast.Tuple | ast.Set) -> Any:
        return [self.find_value(element) for element in node.elts]

    evaluate_Tuple = evaluate_Set = evaluate_List

    def evaluate_Starred(self, node: ast.Starred) -> Any:
        return self.find_value(node.value)

    def evaluate_Dict(self, node: ast.Dict) -> Any:
        merged: dict[str, Any] = {}
        for key_node, value_node in zip(node.keys, node.values, strict=True):
            key, value = None if key_node is None else self.find_value(key_node), self.find_value(value_node)
            if isinstance(key, str):
                merged[key] = value
            elif key is None and isinstance(value, dict):
                merged.update(value)
            else:
                merged[MORE] = UnknownValue(key_node or value_node)
        return merged

    def evaluate_Name(self, node: ast.Name) -> Any:
        return self.names.get(node.id)

    def evaluate_JoinedStr(self, node: ast.JoinedStr) -> Any:
        parts = (self.find_value(v.value if isinstance(v, ast.FormattedValue) else v) for v in node.values)
        return put_together(parts, node.lineno)

    def evaluate_IfExp(self, node: ast.IfExp) -> Any:
        return self.find_value(node.body)

    def evaluate_BinOp(self, node: ast.BinOp) -> Any:
        op = node.op.__class__
        if op not in (ast.Add, ast.Div, ast.Mod):
            return None
        left, right = self.find_value(node.left), self.find_value(node.right)
        if op is not ast.Mod:
            if isinstance(left, list) or isinstance(right, list):
                return (left if isinstance(left, list) else [left]) + (right if isinstance(right, list) else [right])
            return put_together((left, "/", right) if op is ast.Div else (left, right), node.lineno)
        if isinstance(left, str):
            return _join_strings(fill_percent(left, right if isinstance(right, list) else [right]), node)
        return None

    def evaluate_Call(self, node: ast.Call) -> Any:
        return self.find_result(node)

    def find_result(self, call: ast.Call) -> Any:
        """What a call gives; None where that is not known."""
        name = format_dotted(call.func)
        last = name.rpartition(".")[2]
        if name == "dict":
            return self.find_keywords(call)
        arguments = [self.find_value(argument) for argument in call.args]
        if name in JOINS or last == "Path":
            if arguments and all(isinstance(a, str) for a in arguments):
                return join_path((a for a in arguments if a), call.lineno)
        elif (name in GLOBS or last == "glob") and len(arguments) >= 1:
            if isinstance(arguments[0], str):
                return [TextConstant(arguments[0], call.lineno)]
        elif name in SAME and len(arguments) == 1:
            return arguments[0]
        elif last == "format" and isinstance(call.func, ast.Attribute):
            template = self.find_value(call.func.value)
            if isinstance(template, str):
                given = {**dict(enumerate(arguments)), **self.find_keywords(call)}
                return _join_strings(fill_format(template, given), call)
        return None


def _join_strings(parts: list[Any], node: ast.expr) -> TextConstant | None:
    """Strings one after the other; None where not all are known."""
    return TextConstant("".join(parts), node.lineno) if all(isinstance(part, str) for part in parts) else None


Constants.evaluators = collect_node_methods(Constants, "evaluate_")
