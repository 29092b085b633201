"""Constants of a Python source: what expressions of literals and of names that hold them are, without running it.

Text, lists and mappings are followed through names, f-strings, `%`, `format`, `+`, `/` and `os.path.join`. Whatever
else an expression is, is Unresolved.
"""

from __future__ import annotations

import ast
from collections import Counter
from typing import Any


class Text(str):
    """A string of the file, with the line it stands on."""

    line: int

    def __new__(cls, text: str, line: int) -> Text:
        made = super().__new__(cls, text)
        made.line = line
        return made


class Unresolved:
    """A value that only running the file would give; what: its source in a clause."""

    __slots__ = ("what",)

    def __init__(self, what: str):
        self.what = what


JOINS = frozenset({"os.path.join", "path.join", "join", "posixpath.join", "osp.join"})
GLOBS = frozenset({"glob", "glob.glob", "iglob", "glob.iglob"})
SAME = frozenset({"list", "tuple", "sorted", "str", "os.path.normpath", "set"})


class Constants:
    """Names and what they hold, as statements assign it one after the other. unresolved: what was left out of mappings
    that were taken apart, in one clause each."""

    def __init__(self) -> None:
        self.names: dict[str, Any] = {}
        self.unresolved: list[str] = []

    def assign(self, target: ast.expr, value: Any) -> None:
        """Takes in an assignment. What a tuple is taken apart into is not followed."""
        if isinstance(target, ast.Name):
            self.names[target.id] = value
        elif isinstance(target, (ast.Tuple, ast.List)):
            for element in target.elts:
                self.assign(element, Unresolved("a tuple's part"))
        elif isinstance(target, ast.Subscript) and isinstance(target.value, ast.Name):
            owner, key = self.names.get(target.value.id), self.value(target.slice)
            if isinstance(owner, dict) and isinstance(key, str):
                owner[key] = value

    def keywords(self, call: ast.Call) -> dict[str, Any]:
        """The keyword arguments of a call, those of `**` included where they are known."""
        found: dict[str, Any] = {}
        for keyword in call.keywords:
            value = self.value(keyword.value)
            if keyword.arg is not None:
                found[keyword.arg] = value
            elif isinstance(value, dict):
                found.update(value)
            elif isinstance(value, Unresolved):
                self.unresolved.append(f"arguments are {value.what}")
        return found

    def value(self, node: ast.expr) -> Any:
        """A str (with its line), list, dict, or Unresolved; a file pattern is a str."""
        if isinstance(node, ast.Constant):
            return Text(node.value, node.lineno) if isinstance(node.value, str) else node.value
        if isinstance(node, (ast.List, ast.Tuple, ast.Set)):
            return [self.value(element) for element in node.elts]
        if isinstance(node, ast.Starred):
            return self.value(node.value)
        if isinstance(node, ast.Dict):
            pairs = [
                (None if k is None else self.value(k), self.value(v))
                for k, v in zip(node.keys, node.values, strict=True)
            ]
            merged: dict[str, Any] = {}
            for key, value in pairs:
                if isinstance(key, str):
                    merged[key] = value
                elif key is None and isinstance(value, dict):
                    merged.update(value)
            return merged
        if isinstance(node, ast.Name):
            return self.names.get(node.id, Unresolved(f"`{node.id}`"))
        if isinstance(node, ast.BinOp):
            return self.operation(node)
        if isinstance(node, ast.JoinedStr):
            parts = [self.value(v.value if isinstance(v, ast.FormattedValue) else v) for v in node.values]
            if all(isinstance(part, str) for part in parts):
                return Text("".join(parts), node.lineno)
        if isinstance(node, ast.Call):
            return self.result(node)
        if isinstance(node, ast.IfExp):
            return self.value(node.body)
        return Unresolved(source_of(node))

    def operation(self, node: ast.BinOp) -> Any:
        left, right = self.value(node.left), self.value(node.right)
        if isinstance(node.op, (ast.Add, ast.Div)):
            if isinstance(left, str) and isinstance(right, str):
                between = "/" if isinstance(node.op, ast.Div) else ""
                return Text(left + between + right, node.lineno)
            if isinstance(left, list) and isinstance(right, list):
                return left + right
            if isinstance(left, list) or isinstance(right, list):
                return (left if isinstance(left, list) else [left]) + (right if isinstance(right, list) else [right])
        if isinstance(node.op, ast.Mod) and isinstance(left, str):
            values = right if isinstance(right, list) else [right]
            if all(isinstance(v, str) for v in values) and left.count("%s") == len(values) == left.count("%"):
                pieces = left.split("%s")
                return Text(pieces[0] + "".join(v + p for v, p in zip(values, pieces[1:], strict=True)), node.lineno)
        return Unresolved(source_of(node))

    def result(self, call: ast.Call) -> Any:
        name = dotted(call.func)
        last = name.rpartition(".")[2]
        if name == "dict":
            return self.keywords(call)
        arguments = [self.value(argument) for argument in call.args]
        if name in JOINS or last == "Path":
            if arguments and all(isinstance(a, str) for a in arguments):
                return Text("/".join(a.rstrip("/") for a in arguments if a), call.lineno)
        elif (name in GLOBS or last == "glob") and len(arguments) >= 1:
            if isinstance(arguments[0], str):
                return [Text(arguments[0], call.lineno)]
        elif name in SAME and len(arguments) == 1:
            return arguments[0]
        elif last == "format" and isinstance(call.func, ast.Attribute):
            template = self.value(call.func.value)
            if isinstance(template, str) and all(isinstance(a, str) for a in arguments) and not call.keywords:
                pieces = template.split("{}")
                if len(pieces) == len(arguments) + 1 and "{" not in "".join(pieces):
                    return Text(
                        pieces[0] + "".join(a + p for a, p in zip(arguments, pieces[1:], strict=True)), call.lineno
                    )
        return Unresolved(source_of(call))


def dotted(node: ast.expr) -> str:
    parts: list[str] = []
    while isinstance(node, ast.Attribute):
        parts.append(node.attr)
        node = node.value
    parts.append(node.id if isinstance(node, ast.Name) else "")
    return ".".join(reversed(parts))


def source_of(node: ast.expr) -> str:
    text = " ".join(ast.unparse(node).split())
    return f"`{text if len(text) <= 60 else text[:57] + '...'}`"


def module_constants(tree: ast.Module) -> Constants:
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
            constants.assign(target, constants.value(statement.value))
    return constants
