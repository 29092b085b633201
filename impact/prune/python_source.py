"""Edits of Python sources that give a topic a lighter message."""

from __future__ import annotations

import ast
import re
from codecs import BOM_UTF8

from ..rules.fix_actions import Edit
from .cpp_source import EditRefused

_CODING = re.compile(rb"[ \t\f]*#.*?coding[:=][ \t]*[-\w.]+")


class PythonEditor:
    """The edits of one Python file. data: its bytes. Raises EditRefused where Python 3 does not read them."""

    def __init__(self, path: str, data: bytes):
        self.path, self.data = path, data
        try:
            self._tree = ast.parse(data.decode("utf-8-sig"))
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            raise EditRefused(f"{path} is not read by Python 3") from None
        if re.search(rb"\r(?!\n)|\f", data):
            raise EditRefused(f"{path} has lines that end in other ways than Python's own")
        self._starts = [len(BOM_UTF8) if data.startswith(BOM_UTF8) else 0]
        for line in data[self._starts[0] :].split(b"\n"):
            self._starts.append(self._starts[-1] + len(line) + 1)
        self.edits: list[Edit] = []
        self._imports: list[str] = []
        self._blocks: list[str] = []

    def _find_offset(self, line: int, column: int) -> int:
        return self._starts[line - 1] + column

    def replace(self, node: ast.expr, text: str) -> None:
        """Puts a text in the place of an expression."""
        end = self._find_offset(node.end_lineno or 0, node.end_col_offset or 0)
        self.edits.append(Edit(self.path, self._find_offset(node.lineno, node.col_offset), end, text))

    def find_call(self, line: int, name: str) -> ast.Call:
        """The call of a function or method of a name that begins in a line, or whose name stands there. Raises
        EditRefused."""
        found = [
            node
            for node in ast.walk(self._tree)
            if isinstance(node, ast.Call) and _find_called(node) == name and node.lineno <= line <= _find_last(node)
        ]
        if len(found) != 1:
            raise EditRefused(f"the call of `{name}` in line {line} is not found in its source")
        return found[0]

    def retype_call(self, line: int, name: str, old: str, new: str) -> None:
        """Changes the type in a call that makes an endpoint. Raises EditRefused."""
        call = self.find_call(line, name)
        wanted = old.partition("/")[2]
        given = [*call.args, *(keyword.value for keyword in call.keywords)]
        types = [node for node in given if isinstance(node, (ast.Name, ast.Attribute)) and _find_tail(node) == wanted]
        if len(types) != 1:
            raise EditRefused(f"the type in line {line} is named otherwise than `{wanted}`")
        self.replace(types[0], new.partition("/")[2])
        self.add_import(new)

    def wrap_argument(self, line: int, name: str, function: str) -> None:
        """Gives a publish statement what a function makes of its one argument. Raises EditRefused."""
        call = self.find_call(line, name)
        if len(call.args) != 1 or call.keywords or isinstance(call.args[0], (ast.Constant, ast.Starred)):
            raise EditRefused(f"line {line} publishes something other than one message")
        only = call.args[0]
        start = self._find_offset(only.lineno, only.col_offset)
        end = self._find_offset(only.end_lineno or 0, only.end_col_offset or 0)
        self.edits.append(Edit(self.path, start, start, f"{function}("))
        self.edits.append(Edit(self.path, end, end, ")"))

    def add_import(self, type_: str) -> None:
        """Imports a message `package/Name`."""
        package, _, name = type_.partition("/")
        text = f"from {package}.msg import {name}\n"
        if text not in self._imports:
            self._imports.append(text)

    def add_block(self, text: str) -> None:
        """Puts a function behind the imports."""
        if text not in self._blocks:
            self._blocks.append(text)

    def finish(self) -> list[Edit]:
        """All edits."""
        at = self._find_end_of_imports()
        start = "" if not at or self.data[at - 1 : at] == b"\n" else "\n"
        if self._imports:
            self.edits.append(Edit(self.path, at, at, start + "".join(self._imports)))
        if self._blocks:
            blank = re.match(rb"(?:[ \t]*\r?\n)*", self.data[at:])
            behind = at + (blank.end() if blank is not None else 0)
            lead = "" if behind > at and not start else "\n\n"
            text = "\n\n".join(self._blocks)
            self.edits.append(Edit(self.path, behind, behind, f"{lead}{text}\n\n"))
        ends = "\r\n" if b"\r\n" in self.data else "\n"
        return [Edit(one.path, one.start, one.end, one.text.replace("\n", ends)) for one in self.edits]

    def _find_end_of_imports(self) -> int:
        """The offset behind the last import that stands before functions and classes."""
        last = 0
        for node in self._tree.body:
            if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
                break
            is_text = isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and not last
            if isinstance(node, (ast.Import, ast.ImportFrom)) or is_text:
                last = node.end_lineno or 0
        if not last:
            # Python looks for the coding in the first two lines, the system for the interpreter in the first.
            lines = self.data.removeprefix(BOM_UTF8).split(b"\n")[:2]
            last = max((place for place, line in enumerate(lines, 1) if _CODING.match(line)), default=0)
            last = last or int(lines[0].startswith(b"#!"))
        return min(self._starts[last], len(self.data))


def _find_called(node: ast.Call) -> str:
    return _find_tail(node.func)


def _find_tail(node: ast.expr) -> str:
    """The last part of a name."""
    return node.id if isinstance(node, ast.Name) else node.attr if isinstance(node, ast.Attribute) else ""


def _find_last(node: ast.Call) -> int:
    return node.func.end_lineno or node.lineno
