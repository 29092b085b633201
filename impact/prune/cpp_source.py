"""Edits of C++ sources that give a topic a lighter message: types, parameters, publish statements, functions."""

from __future__ import annotations

import re
from bisect import bisect_right
from codecs import BOM_UTF8
from collections.abc import Collection, Iterator

from tree_sitter import Node

from ..facts.cpp.flow_grammar import KIND, get_items
from ..facts.cpp.names import strip_templates
from ..facts.cpp.parse import parse_source
from ..rules.fix_actions import Edit
from .conversions import spell_cpp

_ANY_TYPE = re.compile(r"\bauto\b|\w+Base\b|\bros::(?:Publisher|Subscriber)\b|\bimage_transport\b")
_POINTER = re.compile(r"Ptr\b|_ptr\s*<|\*")
_QUOTED = re.compile(r"\"(?:[^\"\\\n]|\\.)*\"|//[^\n]*|/\*.*?\*/", re.DOTALL)
_INCLUDE = re.compile(rb"(?m)^[ \t]*#[ \t]*include[ \t]*([<\"][^>\"\n]+[>\"])[^\n]*\n?")
_SNAKE = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")


class EditRefused(Exception):
    """A place that cannot be changed; the text is a clause that says why."""


def find_header(type_: str, ros: int) -> str:
    """The generated header of a message `package/Name`."""
    package, _, name = type_.partition("/")
    return f"{package}/{name}.h" if ros == 1 else f"{package}/msg/{_SNAKE.sub('_', name).lower()}.hpp"


def list_offsets(data: bytes) -> list[int]:
    """Where each character of a source begins in its bytes, and where the last one ends: without a byte order mark,
    with a line break for one character, and one for what is not UTF-8, as sources are decoded to be parsed."""
    at = len(BOM_UTF8) if data.startswith(BOM_UTF8) else 0
    found: list[int] = []
    while at < len(data):
        try:
            text, bad, behind = data[at:].decode(), 0, len(data)
        except UnicodeDecodeError as error:
            text, bad, behind = data[at : at + error.start].decode(), 1, at + error.end
        for each in text:
            if each != "\n" or not found or data[found[-1]] != 0x0D or found[-1] + 1 != at:
                found.append(at)
            at += len(each.encode())
        found += [at] * bad
        at = behind
    return [*found, len(data)]


class CppEditor:
    """The edits of one C++ file. data: its bytes."""

    def __init__(self, path: str, data: bytes, ros: int):
        self.path, self.ros = path, ros
        source, self._root, _ = parse_source(data)
        self._starts = source.starts
        # What is parsed has one byte for each character, and `\n` alone; offsets are of that until finish().
        self._original = data
        self.data = source.text.encode("ascii", "replace")
        self.edits: list[Edit] = []
        self._blocks: list[str] = []

    # Finding places

    def _spell_node(self, node: Node) -> str:
        return self.data[node.start_byte : node.end_byte].decode("utf-8", "surrogateescape")

    def _find_line(self, node: Node) -> int:
        return bisect_right(self._starts, node.start_byte)

    def _walk(self, node: Node, *kinds: int) -> Iterator[Node]:
        waiting = [node]
        while waiting:
            one = waiting.pop()
            if one.kind_id in kinds:
                yield one
            waiting += reversed(one.children)

    def find_call(self, line: int, column: int) -> Node:
        """The call whose function's name stands at a place. Raises EditRefused."""
        at = self._starts[line - 1] + column - 1
        node = self._root.descendant_for_byte_range(at, at + 1)
        while node is not None and node.kind_id != KIND.call_expression:
            node = node.parent
        if node is None:
            raise EditRefused("the call is not found in its source")
        return node

    def find_function(self, line: int, name: str) -> Node:
        """The function, or lambda, of a name that begins in a line. Raises EditRefused."""
        tail = name.rpartition("::")[2]
        if tail.startswith("lambda@"):
            at_line, _, column = tail[len("lambda@") :].partition(":")
            at = self._starts[int(at_line) - 1] + int(column) - 1
            for node in self._walk(self._root, KIND.lambda_expression):
                if node.start_byte == at:
                    return node
        for node in self._walk(self._root, KIND.function_definition):
            if self._find_line(node) == line:
                return node
        raise EditRefused(f"`{tail}` is not found in its source")

    def list_declarations(self, name: str, owner: str) -> list[Node]:
        """The parameter lists of declarations of a function without a body. owner: the last name of its class, empty
        for a free function."""
        found: list[Node] = []
        for node in self._walk(self._root, KIND.function_declarator):
            parent = node.parent
            while parent is not None and parent.kind_id in (KIND.pointer_declarator, KIND.reference_declarator):
                parent = parent.parent
            if parent is None or parent.kind_id not in (KIND.field_declaration, KIND.declaration):
                continue
            if strip_templates(self._spell_node(node.children[0])) == name and self._find_class(parent) == owner:
                found.append(node)
        return found

    def _find_class(self, node: Node) -> str:
        """The last name of the class that a node stands in."""
        outer = node.parent
        while outer is not None:
            if outer.kind_id in (KIND.class_specifier, KIND.struct_specifier):
                named = outer.child_by_field_name("name")
                return strip_templates(self._spell_node(named)).rpartition("::")[2] if named is not None else ""
            outer = outer.parent
        return ""

    # Edits

    def replace(self, start: int, end: int, text: str) -> None:
        """Puts a text in the place of some bytes."""
        self.edits.append(Edit(self.path, start, end, text))

    def replace_type(self, start: int, end: int, old: str, new: str) -> int:
        """Puts one message `package/Name` in the place of another wherever it is named between two offsets. Gives how
        often."""
        package, _, name = old.partition("/")
        pattern = re.compile(
            rf"(?<![\w:.>])(?:::)?(?:{package}::(?:msg::)?)?\b{name}(?P<end>(?:Const)?(?:Shared|Unique)?(?:Const)?Ptr|_)?\b"
        )
        # A topic may be called like its type.
        text = _QUOTED.sub(lambda match: " " * len(match[0]), self.data[start:end].decode("latin-1"))
        count = 0
        for match in pattern.finditer(text):
            spelt = spell_cpp(new, self.ros) + (match["end"] or "")
            self.replace(start + match.start(), start + match.end(), spelt)
            count += 1
        return count

    def retype_call(self, line: int, column: int, old: str, new: str) -> int:
        """Changes the type in a call that makes an endpoint, outside of the lambdas in it. Gives how often."""
        call = self.find_call(line, column)
        at = call.start_byte
        count = 0
        for inner in self._walk(call, KIND.lambda_expression):
            if inner.start_byte >= at:
                count += self.replace_type(at, inner.start_byte, old, new)
                at = inner.end_byte
        return count + self.replace_type(at, call.end_byte, old, new)

    def retype_member(self, line: int, name: str, old: str, new: str, own: Collection[str]) -> None:
        """Changes the type of a variable that is declared in a line, where that names the message. own: all variables
        whose type is changed. Raises EditRefused for one of another type, and beside one that keeps its type."""
        for node in self._walk(self._root, KIND.field_declaration, KIND.declaration):
            first, last = self._find_line(node), bisect_right(self._starts, node.end_byte)
            if first <= line <= last and re.search(rf"\b{re.escape(name)}\b", self._spell_node(node)):
                declared = node.child_by_field_name("type")
                text = self._spell_node(declared) if declared is not None else ""
                if declared is None or _ANY_TYPE.search(text):
                    return
                if not self.replace_type(declared.start_byte, declared.end_byte, old, new):
                    raise EditRefused(f"`{name}` at {self.path}:{line} is of type `{text}`")
                for declarator in node.children_by_field_name("declarator"):
                    spelt = self._spell_node(declarator)
                    if not any(re.search(rf"\b{re.escape(one)}\b", spelt) for one in own):
                        where = f"{self.path}:{line}"
                        raise EditRefused(f"`{name}` at {where} is declared with `{spelt}`, which keeps its type")
                return

    def _find_parameter(self, listed: Node, place: int) -> Node:
        rows = [one for one in get_items(listed) if one.type.endswith("parameter_declaration")]
        if place >= len(rows):
            raise EditRefused("a callback's parameter is not found in its source")
        return rows[place]

    def retype_parameter(self, function: Node, place: int, old: str, new: str, optional: bool = False) -> str:
        """Changes the type of a function's parameter; gives it as it was, with its name. function: a definition,
        declarator or lambda. optional: the type need not be named. Raises EditRefused."""
        parameter = self._find_parameter(self._find_list(function), place)
        text = self._spell_node(parameter)
        if not self.replace_type(parameter.start_byte, parameter.end_byte, old, new) and not optional:
            raise EditRefused(f"its callback names the type otherwise: `{text}`")
        return text

    def count_parameters(self, declarator: Node) -> int:
        """How many parameters a declarator lists."""
        rows = get_items(self._find_list(declarator))
        return sum(one.type.endswith("parameter_declaration") for one in rows)

    def _find_list(self, function: Node) -> Node:
        for node in self._walk(function, KIND.parameter_list):
            return node
        raise EditRefused("a callback without parameters")

    def widen_parameter(self, function: Node, place: int, name: str, old: str, new: str, convert: str) -> None:
        """Changes the type of a parameter and gives it another name; the body begins with a variable of the old type
        and name that is made of it. convert: the function that makes it. Raises EditRefused."""
        parameter = self._find_parameter(self._find_list(function), place)
        text = self._spell_node(parameter)
        body = next((one for one in function.children if one.kind_id == KIND.compound_statement), None)
        if body is None or "MessageEvent" in text or "auto" in text:
            raise EditRefused(f"its callback takes `{text}`")
        self.retype_parameter(function, place, old, new)
        given = f"{name}_light"
        at = [m.end() for m in re.finditer(rf"\b{re.escape(name)}\b", text)]
        end = parameter.start_byte + len(text[: at[-1]].encode("utf-8", "surrogateescape"))
        self.replace(end - len(name), end, given)
        declared = re.sub(r"\s*&&?\s*$", "", text[: at[-1] - len(name)].rstrip())
        full = spell_cpp(old, self.ros)
        if _POINTER.search(declared):
            made = f"{declared} {name}(new {full}({convert}(*{given})));"
        else:
            made = f"{declared} {name} = {convert}({given});"
        indent = self._find_indent(body)
        self.replace(body.start_byte + 1, body.start_byte + 1, f"\n{indent}{made}")

    def _find_indent(self, body: Node) -> str:
        inner = next((one for one in body.children if one.is_named), None)
        line = self._find_line(inner if inner is not None else body)
        start = self._starts[line - 1]
        found = re.match(rb"[ \t]*", self.data[start:])
        own = (found[0] if found else b"").decode()
        same = inner is None or line == self._find_line(body)
        return own + "  " if same else own

    def wrap_argument(self, line: int, column: int, function: str) -> bool:
        """Gives a publish statement what a function makes of its one argument; tells whether the argument may be a
        pointer. Raises EditRefused."""
        call = self.find_call(line, column)
        items = get_items(call.children[-1])
        if len(items) != 1:
            raise EditRefused(f"line {line} publishes something other than one message")
        only = items[0]
        if only.kind_id == KIND.initializer_list:
            raise EditRefused(f"line {line} publishes a list in braces")
        self.replace(only.start_byte, only.start_byte, f"{function}(")
        self.replace(only.end_byte, only.end_byte, ")")
        return not self._spell_node(only).startswith("*")

    def has_header(self, header: str) -> bool:
        """Whether the file itself includes a header."""
        return any(row[1][1:-1] == header.encode() for row in _INCLUDE.finditer(self.data))

    def add_header(self, header: str, beside: str) -> None:
        """Includes a generated header, behind that of the full message where the file has it."""
        if self.has_header(header):
            return
        rows = list(_INCLUDE.finditer(self.data))
        near = [row for row in rows if row[1][1:-1] == beside.encode()] or rows[-1:]
        if not near:
            self.replace(0, 0, f"#include <{header}>\n")
            return
        self._insert_behind(near[0], f"#include <{header}>\n")

    def add_block(self, text: str) -> None:
        """Puts a function behind the last include at the top of the file."""
        if text not in self._blocks:
            self._blocks.append(text)

    def finish(self) -> list[Edit]:
        """All edits."""
        if self._blocks:
            rows = [row for row in _INCLUDE.finditer(self.data) if not self._is_inside(row.start())]
            text = "\n".join(self._blocks)
            at = rows[-1].end() if rows else 0
            blank = re.match(rb"(?:[ \t]*\r?\n)+", self.data[at:])
            # Behind the blank line that follows the includes, so that other includes stay together with these.
            text = f"{text}\n" if blank is not None or not rows else f"\n{text}"
            at += blank.end() if blank is not None else 0
            self.replace(at, at, text if not at or self.data[at - 1 : at] == b"\n" else f"\n{text}")
            self._blocks.clear()
        return self._translate_edits()

    def _translate_edits(self) -> list[Edit]:
        """The edits by offsets of the file's own bytes, with its line breaks. Raises EditRefused."""
        at = list_offsets(self._original)
        if len(at) != len(self.data) + 1:
            raise EditRefused(f"{self.path} has characters that are not read one by one")
        ends = "\r\n" if b"\r\n" in self._original else "\n"
        return [
            Edit(one.path, at[one.start], at[one.end], one.text.replace("\n", ends)) for one in self.edits
        ]

    def _is_inside(self, offset: int) -> bool:
        """Whether an offset lies in a conditional block other than a header's guard, a function or a class."""
        node = self._root.descendant_for_byte_range(offset, offset + 1)
        depth = 0
        while node is not None and node.parent is not None:
            if node.kind_id in (KIND.preproc_if, KIND.preproc_else, KIND.preproc_elif, KIND.preproc_ifdef):
                depth += 1
            elif node.kind_id in (KIND.compound_statement, KIND.field_declaration_list, KIND.declaration_list):
                return True
            node = node.parent
        guarded = re.match(rb"\s*(?:(?://[^\n]*|/\*.*?\*/)\s*)*#\s*ifndef", self.data, re.DOTALL) is not None
        return depth > int(guarded)

    def _insert_behind(self, row: re.Match[bytes], text: str) -> None:
        ended = row[0].endswith(b"\n")
        self.replace(row.end(), row.end(), text if ended else "\n" + text.rstrip("\n"))
