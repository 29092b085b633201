"""What stands inside C++ functions: expressions to calls, assignments and uses of variables.

One walk does it all. Reading a tree in Python costs more than parsing it, so the walk looks at a node once: it takes
the text of plain paths whole, and asks for children in one go instead of by field.

A use of a parameter or local variable is judged by where it stands: a test or an operand is a `read`; an argument is a
`pass`; so is a method called on it, with position -1; the value of another local variable is a `read` too, since the
Assignment tells what goes on from there; all that is not known to be safe is an `escape`.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Callable
from typing import Any

import tree_sitter_cpp
from tree_sitter import Language, Node

from .flow import Access, Assignment, Call, Expr, Function, Guard, Parameter
from .flow_cpp_clean import Cleaned

LANGUAGE = Language(tree_sitter_cpp.language())


def kind(name: str, named: bool = True) -> int:
    """The number of a kind of node."""
    number = LANGUAGE.id_for_node_kind(name, named)
    if number is None:
        raise ValueError(f"the grammar knows no {name}")
    return number


IDENTIFIER = kind("identifier")
FIELD_IDENTIFIER = kind("field_identifier")
QUALIFIED = kind("qualified_identifier")
FIELD = kind("field_expression")
TEMPLATE_FUNCTION = kind("template_function")
TEMPLATE_METHOD = kind("template_method")
TEMPLATE_TYPE = kind("template_type")
DEPENDENT = kind("dependent_name")
THIS = kind("this")
CALL = kind("call_expression")
ARGUMENTS = kind("argument_list")
BRACES = kind("initializer_list")
COMMENT = kind("comment")
PARENTHESIZED = kind("parenthesized_expression")
POINTER = kind("pointer_expression")
SUBSCRIPT = kind("subscript_expression")
CAST = kind("cast_expression")
BINARY = kind("binary_expression")
STRING = kind("string_literal")
RAW_STRING = kind("raw_string_literal")
LAMBDA = kind("lambda_expression")
CONDITION = kind("condition_clause")
DECLARATION = kind("declaration")
FUNCTION_DECLARATOR = kind("function_declarator")
ABSTRACT_FUNCTION = kind("abstract_function_declarator")
INIT_DECLARATOR = kind("init_declarator")
REFERENCE = kind("reference_declarator")
POINTER_DECLARATOR = kind("pointer_declarator")
BINDING = kind("structured_binding_declarator")
PARAMETER = kind("parameter_declaration")
OPTIONAL_PARAMETER = kind("optional_parameter_declaration")
VARIADIC_PARAMETER = kind("variadic_parameter_declaration")
PARAMETERS = kind("parameter_list")
COMPOUND = kind("compound_statement")
STORAGE = kind("storage_class_specifier")
TYPE_QUALIFIER = kind("type_qualifier")
CAPTURES = kind("lambda_capture_specifier")
CAPTURE_INITIALIZER = kind("lambda_capture_initializer")
ERROR = LANGUAGE.id_for_node_kind("ERROR", True) or 65535
TYPE_FIELD = LANGUAGE.field_id_for_name("type")
BODY_FIELD = LANGUAGE.field_id_for_name("body")

DECLARED_TYPES = frozenset(
    kind(name) for name in ("class_specifier", "struct_specifier", "union_specifier", "enum_specifier")
)
PUNCTUATION = frozenset(
    (kind("(", False), kind(")", False), kind("{", False), kind("}", False), kind(",", False), COMMENT)
)
NAMES = frozenset(
    kind(name)
    for name in (
        "identifier", "field_identifier", "qualified_identifier", "destructor_name", "operator_name", "operator_cast",
        "type_identifier", "template_function", "template_method", "namespace_identifier",
    )
)  # fmt: skip

# A position: kind of access, callee it is passed to, number of the argument.
Position = tuple[str, str, int]
READ: Position = ("read", "", -1)
ESCAPE: Position = ("escape", "", -1)
WRITE: Position = ("write", "", -1)
RETURN = "return"  # in place of a target: no path is called so

LOGGING = re.compile(
    r"(?:ROS|RCLCPP|RCUTILS|NODELET|RCLC)_(?:DEBUG|INFO|WARN|ERROR|FATAL|LOG|SAFE_FWRITE|ASSERT|BREAK)\w*"
    r"|(?:EXPECT|ASSERT)_\w+|std::move|move|std::forward|std::as_const|std::ref|std::cref|boost::ref|std::get"
    r"|(?:static|dynamic|const|reinterpret)_cast|CONSOLE_BRIDGE_log\w+"
    r"|(?:std::)?(?:static|dynamic|const)_pointer_cast|boost::(?:static|dynamic|const)_pointer_cast|assert"
)
THROUGH = frozenset(
    [
        "std::move",
        "move",
        "std::forward",
        "std::as_const",
        "std::ref",
        "std::cref",
        "boost::ref",
        "static_cast",
        "dynamic_cast",
        "const_cast",
        "reinterpret_cast",
        "std::static_pointer_cast",
        "std::dynamic_pointer_cast",
        "std::const_pointer_cast",
        "boost::static_pointer_cast",
        "boost::dynamic_pointer_cast",
        "boost::const_pointer_cast",
        "std::get",
    ]
)
BINDS = frozenset(("std::bind", "boost::bind", "bind", "std::bind_front", "std::mem_fn", "boost::mem_fn"))
MAKES = frozenset(
    ["std::make_shared", "std::make_unique", "boost::make_shared", "boost::make_unique", "make_shared", "make_unique"]
)
NEVER_RETURNS = frozenset(
    [
        "exit",
        "_exit",
        "std::exit",
        "::exit",
        "abort",
        "std::abort",
        "::abort",
        "std::terminate",
        "std::quick_exit",
        "ROS_BREAK",
    ]
)
ASSERTS = frozenset(("assert", "ROS_ASSERT"))
# Methods of containers, strings and pointers: of a message's field they are nothing but that.
ELEMENTS = frozenset(["at", "front", "back", "begin", "end", "cbegin", "cend", "rbegin", "rend"])
POINTEES = frozenset(["get", "lock", "value", "getMessage", "getConstMessage"])
LOOKS = frozenset(
    [
        "size",
        "empty",
        "length",
        "c_str",
        "capacity",
        "max_size",
        "has_value",
        "valid",
        "count",
        "isZero",
        "toSec",
        "toNSec",
        "toNSec",
        "seconds",
        "nanoseconds",
        "expired",
        "use_count",
    ]
)
CHANGES = frozenset(
    [
        "push_back",
        "emplace_back",
        "emplace",
        "resize",
        "clear",
        "assign",
        "reserve",
        "insert",
        "erase",
        "pop_back",
        "pop_front",
        "push_front",
        "swap",
        "reset",
        "append",
        "fill",
    ]
)
SILENT = frozenset(
    [
        "size",
        "empty",
        "length",
        "c_str",
        "begin",
        "end",
        "cbegin",
        "cend",
        "rbegin",
        "rend",
        "at",
        "front",
        "back",
        "capacity",
        "has_value",
        "use_count",
    ]
)
LONGEST_OTHER = 120
LONGEST_CONDITION = 4000
DEEPEST = 24

_PLAIN = re.compile(r"(this->)?([A-Za-z_]\w*)(?:(?:\.|->)[A-Za-z_]\w*)*")
_ASIDE = re.compile(r'//[^\n]*|/\*.*?\*/|("(?:[^"\\]|\\.)*")', re.DOTALL)
_ESCAPES = {"n": "\n", "t": "\t", "\\": "\\", '"': '"', "'": "'", "0": "\0", "r": "\r"}
_ESCAPED = re.compile(r"\\(.)", re.DOTALL)
_SCOPE_BLANKS = re.compile(r"\s*::\s*")

SIMPLE_NUMBERS = ("true", "false", "null", "number_literal", "char_literal")


def flat(text: str) -> str:
    """A piece of source on one line, without comments."""
    if "/" in text and ("//" in text or "/*" in text):
        text = _ASIDE.sub(lambda match: match[1] or " ", text)
    if "\n" in text or "  " in text or "\t" in text:
        text = " ".join(text.split())
    return text.strip()


def bare(name: str) -> str:
    """A name without its template arguments and without blanks."""
    if "<" in name:
        depth = 0
        kept: list[str] = []
        for piece in re.split(r"([<>])", name):
            if piece == "<":
                depth += 1
            elif piece == ">":
                depth -= 1
            elif depth <= 0:
                kept.append(piece)
        if "operator" not in name:
            name = "".join(kept)
    return "".join(name.split()) if "operator" not in name else " ".join(name.split())


def grammatical(node: Node) -> list[Node]:
    """The children of a node without comments."""
    return [child for child in node.children if child.kind_id != COMMENT]


class Body:
    """The reader of one file's functions, and the function that it is in."""

    def __init__(self, cleaned: Cleaned) -> None:
        self.text = cleaned.text
        self.starts = cleaned.starts
        self.regions = cleaned.regions
        self.functions: list[Function] = []
        self.nesting = 0
        self.name = ""
        self.owner = ""
        self.begin(set())

    def begin(self, known: set[str]) -> None:
        """Starts an empty function that knows some variables."""
        self.guards: list[Guard] = []
        self.calls: list[Call] = []
        self.assignments: list[Assignment] = []
        self.accesses: list[Access] = []
        self.known = known

    def state(self) -> tuple[Any, ...]:
        """The function it is in, to be gone back to by restore()."""
        return (self.name, self.owner, self.guards, self.calls, self.assignments, self.accesses, self.known)

    def restore(self, state: tuple[Any, ...]) -> None:
        self.name, self.owner, self.guards, self.calls, self.assignments, self.accesses, self.known = state

    # Text and places

    def said(self, node: Node) -> str:
        """The source of a node on one line."""
        return flat(self.text[node.start_byte : node.end_byte])

    def line(self, node: Node) -> int:
        return bisect_right(self.starts, node.start_byte)

    def place(self, offset: int) -> tuple[int, int]:
        line = bisect_right(self.starts, offset)
        return line, offset - self.starts[line - 1] + 1

    def guard(self, kind_: str, text: str, line: int, outer: int, early: bool = False) -> int:
        """A new guard around what follows; gives its place."""
        self.guards.append(Guard(kind_, text[:LONGEST_CONDITION], line, outer, early))
        return len(self.guards) - 1

    # Expressions

    def value(self, node: Node, guard: int, position: Position = READ, target: str = "") -> Expr:
        """An expression that stands in a position; target: what it is kept in, RETURN for what the function returns."""
        return VALUES.get(node.kind_id, Body.anything)(self, node, guard, position, target)

    def other(self, node: Node) -> Expr:
        start = node.start_byte
        end = min(node.end_byte, start + 4 * LONGEST_OTHER)
        return Expr("other", flat(self.text[start:end])[:LONGEST_OTHER])

    def anything(self, node: Node, guard: int, position: Position, target: str) -> Expr:
        for child in node.children:
            read = VALUES.get(child.kind_id)
            if read is not None:
                read(self, child, guard, ESCAPE if position is READ else position, "")
            elif child.child_count:
                self.anything(child, guard, position, "")
        return self.other(node)

    def skipped(self, node: Node, guard: int, position: Position, target: str) -> Expr:
        return self.other(node)

    def identifier(self, node: Node, guard: int, position: Position, target: str) -> Expr:
        start = node.start_byte
        name = self.text[start : node.end_byte]
        if name in self.known:
            self.accesses.append(
                Access(name, position[0], bisect_right(self.starts, start), guard, position[1], position[2])
            )
        return Expr("name", name)

    def number(self, node: Node, guard: int, position: Position, target: str) -> Expr:
        return Expr("number", self.text[node.start_byte : node.end_byte])

    def this(self, node: Node, guard: int, position: Position, target: str) -> Expr:
        return Expr("name", "this")

    def string(self, node: Node, guard: int, position: Position, target: str) -> Expr:
        return Expr("text", self.literal(node))

    def literal(self, node: Node) -> str:
        """The value of a string literal."""
        text = self.text[node.start_byte : node.end_byte]
        if node.kind_id == RAW_STRING:
            start, end = text.find("("), text.rfind(")")
            return text[start + 1 : end] if start >= 0 else ""
        text = text[text.find('"') + 1 : -1]
        if "\\" in text:
            text = _ESCAPED.sub(lambda match: _ESCAPES.get(match[1], "" if match[1] == "\n" else match[0]), text)
        return text

    def strings(self, node: Node, guard: int, position: Position, target: str) -> Expr:
        parts: list[Expr] = []
        for child in node.children:
            number = child.kind_id
            if number in (STRING, RAW_STRING):
                text = self.literal(child)
                if parts and parts[-1].kind == "text":
                    text = parts.pop().text + text
                parts.append(Expr("text", text))
            elif number == IDENTIFIER:
                parts.append(Expr("name", self.text[child.start_byte : child.end_byte]))
        if len(parts) == 1:
            return parts[0]
        return Expr("join", "+", tuple(parts))

    def qualified(self, node: Node, guard: int, position: Position, target: str) -> Expr:
        return Expr("name", bare(self.text[node.start_byte : node.end_byte]))

    def field(self, node: Node, guard: int, position: Position, target: str) -> Expr:
        start = node.start_byte
        plain = _PLAIN.fullmatch(self.text, start, node.end_byte)
        if plain is not None:
            path = plain[0].replace("->", ".")
            if plain[1] is None and plain[2] in self.known:
                self.accesses.append(
                    Access(path, position[0], bisect_right(self.starts, start), guard, position[1], position[2])
                )
            return Expr("name", path)
        path, local = self.path(node, guard)
        if local:
            self.touch(path, node, guard, position)
        return Expr("name", path)

    def touch(self, path: str, node: Node, guard: int, position: Position) -> None:
        self.accesses.append(
            Access(path, position[0], bisect_right(self.starts, node.start_byte), guard, position[1], position[2])
        )

    def path(self, node: Node, guard: int) -> tuple[str, bool]:
        """A path and whether it begins at a variable of the function; what stands inside, such as an index, is read."""
        number = node.kind_id
        if number == IDENTIFIER:
            name = self.text[node.start_byte : node.end_byte]
            return name, name in self.known
        if number == FIELD:
            plain = _PLAIN.fullmatch(self.text, node.start_byte, node.end_byte)
            if plain is not None:
                return plain[0].replace("->", "."), plain[1] is None and plain[2] in self.known
            children = grammatical(node)
            path, local = self.path(children[0], guard)
            return f"{path}.{self.member(children[-1])}", local
        if number == THIS:
            return "this", False
        if number == QUALIFIED:
            return bare(self.text[node.start_byte : node.end_byte]), False
        if number in (PARENTHESIZED, POINTER, CAST):
            children = grammatical(node)
            return self.path(children[1] if number == PARENTHESIZED else children[-1], guard)
        if number == SUBSCRIPT:
            children = grammatical(node)
            path, local = self.path(children[0], guard)
            for index in children[1].children:
                if index.kind_id not in PUNCTUATION:
                    self.value(index, guard)
            return f"{path}.[]", local
        if number == CALL:
            children = grammatical(node)
            function = children[0]
            if function.kind_id == FIELD:
                method = self.member(function.children[-1])
                if method in ELEMENTS or method in POINTEES:
                    if method in POINTEES:
                        self.call(node, guard, READ, "")
                        receiver = self.plain(function.children[0])
                        return receiver if receiver is not None else (self.called(node) + "()", False)
                    path, local = self.path(function.children[0], guard)
                    for argument in children[-1].children:
                        if argument.kind_id not in PUNCTUATION:
                            self.value(argument, guard)
                    return f"{path}.[]", local
            else:
                arguments = [child for child in children[-1].children if child.kind_id not in PUNCTUATION]
                if len(arguments) == 1 and self.called(node) in THROUGH:
                    return self.path(arguments[0], guard)
            self.call(node, guard, ESCAPE, "")
            return self.called(node) + "()", False
        self.value(node, guard, ESCAPE)
        return "()", False

    def plain(self, node: Node) -> tuple[str, bool] | None:
        """The path of a node that is nothing but names."""
        plain = _PLAIN.fullmatch(self.text, node.start_byte, node.end_byte)
        if plain is None:
            return None
        return plain[0].replace("->", "."), plain[1] is None and plain[2] in self.known

    def called(self, node: Node) -> str:
        """The callee of a call, by its text alone."""
        function = node.children[0]
        number = function.kind_id
        if number == FIELD:
            children = grammatical(function)
            return f"{self.receiver(children[0])}.{self.member(children[-1])}"
        if number in (IDENTIFIER, QUALIFIED, TEMPLATE_FUNCTION):
            return bare(self.text[function.start_byte : function.end_byte])
        return self.receiver(function)

    def receiver(self, node: Node) -> str:
        """What a method is called on, as a path; nothing is noted."""
        number = node.kind_id
        if number == THIS:
            return "this"
        if number == IDENTIFIER:
            return self.text[node.start_byte : node.end_byte]
        if number == QUALIFIED:
            return bare(self.text[node.start_byte : node.end_byte])
        if number == FIELD:
            plain = self.plain(node)
            if plain is not None:
                return plain[0]
            children = grammatical(node)
            return f"{self.receiver(children[0])}.{self.member(children[-1])}"
        if number == PARENTHESIZED:
            return self.receiver(grammatical(node)[1])
        if number in (POINTER, CAST):
            return self.receiver(grammatical(node)[-1])
        if number == SUBSCRIPT:
            return self.receiver(node.children[0]) + ".[]"
        if number == CALL:
            name = self.called(node)
            if name in THROUGH:
                arguments = [child for child in node.children[-1].children if child.kind_id not in PUNCTUATION]
                if len(arguments) == 1:
                    return self.receiver(arguments[0])
            head, _, last = name.rpartition(".")
            if head and last in ELEMENTS:
                return head + ".[]"
            if head and last in POINTEES:
                return head
            return name + "()"
        return "()"

    def member(self, node: Node) -> str:
        """The name of a member in a field expression, without template arguments."""
        if node.kind_id == FIELD_IDENTIFIER:
            return self.text[node.start_byte : node.end_byte]
        if node.kind_id == DEPENDENT:
            node = node.children[-1]
        return bare(self.text[node.start_byte : node.end_byte])

    def call(self, node: Node, guard: int, position: Position, target: str) -> Expr:
        """A call, which is noted, and its Expr."""
        children = node.children
        if len(children) != 2:
            children = [child for child in children if child.kind_id not in (COMMENT, ERROR)]
            if len(children) < 2:
                return self.anything(node, guard, position, target)
        function = children[0]
        number = function.kind_id
        text = self.text
        types = ""
        at = start = function.start_byte
        method = ""
        local = False
        receiver = ""
        if number == IDENTIFIER:
            callee = text[start : function.end_byte]
        elif number == FIELD:
            plain = _PLAIN.fullmatch(text, start, function.end_byte)
            if plain is not None:
                callee = plain[0].replace("->", ".")
                receiver, _, method = callee.rpartition(".")
                at = function.end_byte - len(method)
                local = plain[1] is None and plain[2] in self.known
            else:
                parts = grammatical(function)
                member = parts[-1]
                if member.kind_id == DEPENDENT:
                    member = member.children[-1]
                at = member.start_byte
                if member.kind_id == TEMPLATE_METHOD:
                    name, written = member.children[0], member.children[-1]
                    method = text[name.start_byte : name.end_byte]
                    types = flat(text[written.start_byte + 1 : written.end_byte - 1])
                else:
                    method = self.member(member)
                receiver, local = self.path(parts[0], guard)
                callee = f"{receiver}.{method}"
        elif number == QUALIFIED:
            callee = text[start : function.end_byte]
            name = function
            while name.kind_id == QUALIFIED:
                name = name.children[-1]
            at = name.start_byte
            if name.kind_id == DEPENDENT:
                name = name.children[-1]
            if name.kind_id in (TEMPLATE_FUNCTION, TEMPLATE_METHOD):
                written = name.children[-1]
                types = flat(text[written.start_byte + 1 : written.end_byte - 1])
            callee = bare(callee)
        elif number == TEMPLATE_FUNCTION:
            name, written = function.children[0], function.children[-1]
            callee = text[name.start_byte : name.end_byte]
            types = flat(text[written.start_byte + 1 : written.end_byte - 1])
        else:
            callee, local = self.path(function, guard)
            if local:
                self.touch(callee, function, guard, READ)

        listed = children[-1]
        if callee in THROUGH:
            inner = [child for child in listed.children if child.kind_id not in PUNCTUATION]
            if len(inner) == 1:
                return self.value(inner[0], guard, position, target)
        if local and receiver:
            if method in ELEMENTS:
                self.touch(f"{receiver}.[]", node, guard, position)
            elif method in POINTEES:
                self.touch(receiver, node, guard, position)
            elif method in LOOKS:
                self.touch(receiver, node, guard, READ)
            elif method in CHANGES:
                self.touch(receiver, node, guard, WRITE)
            else:
                self.touch(receiver, node, guard, ("pass", callee, -1))
        logs = LOGGING.fullmatch(callee) is not None
        self.nesting += 1
        arguments: tuple[Expr, ...] = ()
        if listed.kind_id == ARGUMENTS or listed.kind_id == BRACES:
            if listed.child_count > 2:
                arguments = self.arguments(listed, guard, "" if logs else callee)
        else:
            self.value(listed, guard, ESCAPE)
        self.nesting -= 1
        if callee in BINDS and arguments:
            return Expr("bind", "", arguments)
        if not logs and not (method in SILENT and method):
            line, column = self.place(at)
            self.calls.append(
                Call(
                    callee, arguments, line, column, guard, types, "" if target == RETURN else target, target == RETURN
                )
            )
        if self.nesting > DEEPEST:
            return self.other(node)
        if callee in MAKES:
            return Expr("make", types, arguments)
        return Expr("call", callee, arguments)

    def arguments(self, listed: Node, guard: int, callee: str) -> tuple[Expr, ...]:
        """The arguments in a list, passed to a callee; without one they are merely read."""
        result: list[Expr] = []
        text = self.text
        known = self.known
        for child in listed.children:
            number = child.kind_id
            if number in PUNCTUATION:
                continue
            if number == IDENTIFIER:
                start = child.start_byte
                name = text[start : child.end_byte]
                if name in known:
                    line = bisect_right(self.starts, start)
                    self.accesses.append(
                        Access(name, "pass", line, guard, callee, len(result))
                        if callee
                        else Access(name, "read", line, guard)
                    )
                result.append(Expr("name", name))
            else:
                position = ("pass", callee, len(result)) if callee else READ
                result.append(VALUES.get(number, Body.anything)(self, child, guard, position, ""))
        return tuple(result)

    def subscript(self, node: Node, guard: int, position: Position, target: str) -> Expr:
        children = grammatical(node)
        path, local = self.path(children[0], guard)
        index = Expr("other")
        for child in children[1].children:
            if child.kind_id not in PUNCTUATION and child.kind_id != BRACKETS[0] and child.kind_id != BRACKETS[1]:
                index = self.value(child, guard)
        if local:
            self.touch(f"{path}.[]", node, guard, position)
        return Expr("index", "", (Expr("name", path), index))

    def parenthesized(self, node: Node, guard: int, position: Position, target: str) -> Expr:
        children = grammatical(node)
        if len(children) != 3:
            return self.anything(node, guard, position, target)
        return self.value(children[1], guard, position, target)

    def pointer(self, node: Node, guard: int, position: Position, target: str) -> Expr:
        children = grammatical(node)
        inner = children[-1]
        if self.text[node.start_byte] == "&":
            number = inner.kind_id
            if number in (QUALIFIED, TEMPLATE_FUNCTION):
                return Expr("function", bare(self.text[inner.start_byte : inner.end_byte]))
            if number == IDENTIFIER:
                name = self.text[inner.start_byte : inner.end_byte]
                if name not in self.known and name[-1] != "_":
                    return Expr("function", name)
        return self.value(inner, guard, position, target)

    def last_child(self, node: Node, guard: int, position: Position, target: str) -> Expr:
        return self.value(grammatical(node)[-1], guard, position, target)

    def binary(self, node: Node, guard: int, position: Position, target: str) -> Expr:
        """Operators in a row are walked through, since a long row is a deep tree."""
        operands: list[Node] = []
        signs: list[str] = []
        lefts: list[Node] = []
        spine = node
        while True:
            children = spine.children
            if len(children) != 3:
                children = [child for child in children if child.kind_id not in (COMMENT, ERROR)]
                if len(children) != 3:
                    break
            operands.append(children[2])
            signs.append(OPERATORS.get(children[1].kind_id, "?"))
            spine = children[0]
            lefts.append(spine)
            if spine.kind_id != BINARY:
                break
        if not operands:
            return self.anything(node, guard, position, target)
        if spine.kind_id == BINARY:
            self.anything(spine, guard, ESCAPE, "")
        operands.append(spine)
        operands.reverse()
        signs.reverse()
        lefts.reverse()
        joined = signs[0] in JOINING and self.nesting <= DEEPEST and all(sign == signs[0] for sign in signs)
        parts: list[Expr] = []
        outer = guard
        pending: list[Node] = []
        self.nesting += 1
        for index, operand in enumerate(operands):
            sign = signs[index - 1] if index else signs[0]
            number = operand.kind_id
            if index and (sign == "&&" or sign == "||"):
                if index > 1 and signs[index - 2] == sign:
                    pending.append(operands[index - 1])
                else:
                    guard = outer
                    pending = [lefts[index - 1]]
                if "(" in self.text[operand.start_byte : operand.end_byte]:
                    holds = "if" if sign == "&&" else "unless"
                    for asked in pending:
                        guard = self.guard(holds, self.outer_text(asked), self.line(asked), guard)
                    pending = []
            if number in LITERALS:
                read = LITERALS[number](self, operand, guard, READ, "")
            else:
                if sign in SAFE or (sign in ("==", "!=") and self.literal_beside(operands, index)):
                    where = READ
                else:
                    where = ESCAPE
                read = self.value(operand, guard, where)
            if joined:
                parts.append(read)
        self.nesting -= 1
        if joined:
            return Expr("join", signs[0], tuple(parts))
        return self.other(node)

    def literal_beside(self, operands: list[Node], index: int) -> bool:
        other = operands[index - 1] if index else operands[1] if len(operands) > 1 else operands[0]
        return other.kind_id in LITERALS

    def unary(self, node: Node, guard: int, position: Position, target: str) -> Expr:
        children = grammatical(node)
        inner = self.value(children[-1], guard, READ)
        if inner.kind == "number" and self.text[node.start_byte] == "-":
            return Expr("number", "-" + inner.text)
        return self.other(node)

    def update(self, node: Node, guard: int, position: Position, target: str) -> Expr:
        children = grammatical(node)
        operand = children[0] if children[-1].child_count == 0 and not children[-1].is_named else children[-1]
        path, local = self.path(operand, guard)
        if local:
            self.touch(path, operand, guard, WRITE)
        sign = (
            "+="
            if "++" in (self.text[node.start_byte : node.start_byte + 2], self.text[node.end_byte - 2 : node.end_byte])
            else "-="
        )
        self.assignments.append(Assignment(path, Expr("number", "1"), self.line(node), guard, "", sign))
        return Expr("name", path)

    def assignment(self, node: Node, guard: int, position: Position, target: str) -> Expr:
        children = grammatical(node)
        if len(children) != 3:
            return self.anything(node, guard, position, target)
        left, sign, right = children
        path, local = self.path(left, guard)
        if local:
            self.touch(path, left, guard, WRITE)
        operator = self.text[sign.start_byte : sign.end_byte]
        followed = operator != "=" or path in self.known
        value = self.value(right, guard, READ if followed else ESCAPE, path)
        self.assignments.append(Assignment(path, value, self.line(node), guard, "", operator))
        return value

    def conditional(self, node: Node, guard: int, position: Position, target: str) -> Expr:
        children = grammatical(node)
        if len(children) != 5:
            return self.anything(node, guard, position, target)
        asked, _, yes, _, no = children
        self.nesting += 1
        condition = self.value(asked, guard, READ)
        line = self.line(node)
        text = self.outer_text(asked)
        true = self.value(yes, self.guard("if", text, line, guard), position, target)
        false = self.value(no, self.guard("unless", text, line, guard), position, target)
        self.nesting -= 1
        if self.nesting > DEEPEST:
            return self.other(node)
        return Expr("choice", "", (condition, true, false))

    def outer_text(self, node: Node) -> str:
        """A condition as written, without parentheses around the whole."""
        while node.kind_id == PARENTHESIZED:
            children = grammatical(node)
            if len(children) != 3:
                break
            node = children[1]
        return self.said(node)

    def braces(self, node: Node, guard: int, position: Position, target: str) -> Expr:
        if self.nesting > DEEPEST:
            self.anything(node, guard, ESCAPE, "")
            return self.other(node)
        self.nesting += 1
        parts = tuple(self.value(child, guard, ESCAPE) for child in node.children if child.kind_id not in PUNCTUATION)
        self.nesting -= 1
        return Expr("list", "", parts)

    def made(self, node: Node, guard: int, position: Position, target: str) -> Expr:
        """`new T(...)` and `T{...}`."""
        children = grammatical(node)
        kind_ = ""
        parts: tuple[Expr, ...] = ()
        self.nesting += 1
        for child in children:
            if child.kind_id in (ARGUMENTS, BRACES):
                parts = self.arguments(child, guard, bare(kind_) or "new")
            elif child.is_named and not kind_:
                kind_ = self.said(child)
        self.nesting -= 1
        if self.nesting > DEEPEST:
            return self.other(node)
        return Expr("make", kind_, parts)

    def thrown(self, node: Node, guard: int, position: Position, target: str) -> Expr:
        return self.anything(node, guard, ESCAPE, "")

    def asked_only(self, node: Node, guard: int, position: Position, target: str) -> Expr:
        for child in node.children:
            read = VALUES.get(child.kind_id)
            if read is not None:
                read(self, child, guard, READ, "")
        return self.other(node)

    # Declarations

    def written_type(self, children: list[Node]) -> str:
        """The type that a declaration begins with, without its declarators."""
        pieces: list[str] = []
        typed = False
        for child in children:
            number = child.kind_id
            if number == TYPE_QUALIFIER:
                pieces.append(self.text[child.start_byte : child.end_byte])
            elif number in DECLARED_TYPES:
                name = child.child_by_field_name("name")
                pieces.append(self.said(name) if name is not None else "")
                typed = True
            elif number in TYPES and not typed:
                pieces.append(self.said(child))
                typed = True
            elif typed:
                break
        return " ".join(pieces) if len(pieces) > 1 else pieces[0] if pieces else ""

    def declared(self, node: Node) -> tuple[Node | None, str]:
        """The name inside a declarator and the marks `*`, `&`, `&&` around it."""
        marks = ""
        for _ in range(64):
            number = node.kind_id
            if number in NAMES or number == BINDING:
                return node, marks
            if number in (POINTER_DECLARATOR, REFERENCE):
                mark = node.children[0]
                marks += self.text[mark.start_byte : mark.end_byte]
            for child in node.children:
                if child.kind_id in DECLARATORS:
                    node = child
                    break
            else:
                return None, marks
        return None, marks

    def declaration(self, node: Node, guard: int, position: Position, target: str) -> Expr:
        """Local variables."""
        children = node.children
        kind_ = ""
        value = Expr("other")
        typed = False
        for index, child in enumerate(children):
            number = child.kind_id
            if number == INIT_DECLARATOR:
                if not typed:
                    kind_, typed = self.written_type(children), True
                value = self.initialised(child, guard, kind_)
            elif number in DECLARATORS and (number not in NAMES or typed or self.is_declarator(node, index)):
                if not typed:
                    kind_, typed = self.written_type(children), True
                if number == FUNCTION_DECLARATOR:
                    self.constructed(child, guard, kind_)
                    continue
                given = children[index + 1] if index + 1 < len(children) else None
                if given is not None and given.kind_id == EQUALS and index + 2 < len(children):
                    # `if (auto x = f())` has no init_declarator.
                    value = self.kept(child, children[index + 2], guard, kind_)
                    break
                name, marks = self.declared(child)
                if name is None:
                    continue
                variable = self.text[name.start_byte : name.end_byte]
                self.known.add(variable)
                self.assignments.append(
                    Assignment(variable, Expr("make", kind_ + marks), self.line(name), guard, kind_ + marks)
                )
            elif number in DECLARED_TYPES:
                self.local_type(child)
        return value

    def is_declarator(self, node: Node, index: int) -> bool:
        return node.field_name_for_child(index) == "declarator"

    def local_type(self, node: Node) -> None:
        """A class inside a function; who reads files says what is done with it."""

    def initialised(self, node: Node, guard: int, kind_: str) -> Expr:
        children = node.children
        if len(children) == 3 and children[1].kind_id == EQUALS:
            return self.kept(children[0], children[2], guard, kind_)
        children = grammatical(node)
        if len(children) == 3:
            return self.kept(children[0], children[2], guard, kind_)
        if len(children) != 2:
            return self.anything(node, guard, READ, "")
        name, marks = self.declared(children[0])
        given = children[1]
        if name is None or given.kind_id not in (ARGUMENTS, BRACES):
            return self.anything(node, guard, READ, "")
        variable = self.text[name.start_byte : name.end_byte]
        if kind_.endswith("auto") or marks:
            inner = [child for child in given.children if child.kind_id not in PUNCTUATION]
            if len(inner) == 1:
                return self.kept(children[0], inner[0], guard, kind_)
        value = Expr("make", kind_, self.arguments(given, guard, bare(kind_)))
        self.known.add(variable)
        self.assignments.append(Assignment(variable, value, self.line(name), guard, kind_ + marks))
        return value

    def kept(self, declarator: Node, given: Node, guard: int, kind_: str) -> Expr:
        """`T x = given`."""
        if declarator.kind_id == IDENTIFIER:
            name, marks = declarator, ""
        else:
            name, marks = self.declared(declarator)
            if name is None:
                return self.value(given, guard, READ)
        if name.kind_id == BINDING:
            value = self.value(given, guard, READ)
            line = self.line(name)
            variables = [child for child in name.children if child.kind_id == IDENTIFIER]
            for index, child in enumerate(variables):
                variable = self.text[child.start_byte : child.end_byte]
                self.known.add(variable)
                part = Expr("index", "", (value, Expr("number", str(index))))
                self.assignments.append(Assignment(variable, part, line, guard, kind_ + marks))
            return value
        variable = self.text[name.start_byte : name.end_byte]
        value = self.value(given, guard, READ, variable)
        self.known.add(variable)
        self.assignments.append(Assignment(variable, value, self.line(name), guard, kind_ + marks))
        return value

    def constructed(self, node: Node, guard: int, kind_: str) -> None:
        """`T x(a, f());` in a function, which the grammar takes for a function's declaration."""
        children = grammatical(node)
        name, marks = self.declared(children[0])
        listed = next((child for child in children if child.kind_id == PARAMETERS), None)
        if name is None or listed is None:
            return
        given = [child for child in listed.children if child.kind_id not in PUNCTUATION]
        if not given or kind_ == "void":
            return
        parts: list[Expr] = []
        callee = bare(kind_)
        for child in given:
            part = self.taken_for_parameter(child, guard, ("pass", callee, len(parts)))
            if part is None:
                return
            parts.append(part)
        variable = self.text[name.start_byte : name.end_byte]
        self.known.add(variable)
        self.assignments.append(
            Assignment(variable, Expr("make", kind_, tuple(parts)), self.line(name), guard, kind_ + marks)
        )

    def taken_for_parameter(self, node: Node, guard: int, position: Position) -> Expr | None:
        """An argument that the grammar took for a parameter's type; None when it is a parameter."""
        children = grammatical(node)
        if node.kind_id != PARAMETER or not children or children[0].kind_id not in TYPES:
            return None
        name = bare(self.text[children[0].start_byte : children[0].end_byte])
        if len(children) == 1:
            if name in self.known:
                self.touch(name, node, guard, position)
            return Expr("name", name)
        if len(children) == 2 and children[1].kind_id == ABSTRACT_FUNCTION:
            listed = next((child for child in children[1].children if child.kind_id == PARAMETERS), None)
            parts: list[Expr] = []
            for child in listed.children if listed is not None else ():
                if child.kind_id not in PUNCTUATION:
                    part = self.taken_for_parameter(child, guard, ("pass", name, len(parts)))
                    if part is None:
                        return None
                    parts.append(part)
            line, column = self.place(children[0].start_byte)
            self.calls.append(Call(name, tuple(parts), line, column, guard))
            return Expr("call", name, tuple(parts))
        return None

    # Functions

    def parameters(self, listed: Node | None, guard: int = -1) -> tuple[Parameter, ...]:
        """The parameters of a function; their names are known from here on."""
        result: list[Parameter] = []
        if listed is None:
            return ()
        for child in listed.children:
            number = child.kind_id
            if number not in (PARAMETER, OPTIONAL_PARAMETER, VARIADIC_PARAMETER):
                continue
            children = grammatical(child)
            default: Expr | None = None
            end = child.end_byte
            name: Node | None = None
            for index, part in enumerate(children):
                if part.kind_id == EQUALS:
                    end = part.start_byte
                    if index + 1 < len(children):
                        default = self.value(children[index + 1], guard)
                    break
                if (
                    part.kind_id in DECLARATORS
                    and index
                    and child.field_name_for_child(child.children.index(part)) == "declarator"
                ):
                    name, _ = self.declared(part)
            start = child.start_byte
            if name is None:
                if child.child_count == 1 and self.text[start:end] == "void":
                    continue
                result.append(Parameter("", flat(self.text[start:end]), default))
                continue
            said = self.text[name.start_byte : name.end_byte]
            self.known.add(said)
            written = self.text[start : name.start_byte] + " " + self.text[name.end_byte : end]
            result.append(Parameter(said, flat(written), default))
        return tuple(result)

    def lambda_(self, node: Node, guard: int, position: Position, target: str) -> Expr:
        """A lambda becomes a Function; what it is called is its Expr."""
        line, column = self.place(node.start_byte)
        name = f"{self.name}::lambda@{line}:{column}" if self.name else f"lambda@{line}:{column}"
        if self.name == "" and self.owner:
            name = f"{self.owner}::{name}"
        inits: list[tuple[str, Expr]] = []
        body: Node | None = None
        listed: Node | None = None
        returns = ""
        for child in node.children:
            number = child.kind_id
            if number == CAPTURES:
                for capture in child.children:
                    if capture.kind_id == CAPTURE_INITIALIZER:
                        parts = grammatical(capture)
                        said = self.text[parts[0].start_byte : parts[0].end_byte].lstrip("&")
                        inits.append((said, self.value(parts[-1], guard, READ)))
            elif number == COMPOUND:
                body = child
            elif number == ABSTRACT_FUNCTION:
                for part in child.children:
                    if part.kind_id == PARAMETERS:
                        listed = part
                    elif part.kind_id == TRAILING_RETURN:
                        returns = self.said(part).removeprefix("->").strip()
        state = self.state()
        self.begin(set(self.known))
        self.name = name
        parameters = self.parameters(listed)
        for said, value in inits:
            self.known.add(said)
            self.assignments.append(Assignment(said, value, line, -1, "auto"))
        if body is not None:
            self.run(body)
        self.close(parameters, line, bisect_right(self.starts, max(0, node.end_byte - 1)), returns)
        self.restore(state)
        return Expr("lambda", name)

    def close(
        self, parameters: tuple[Parameter, ...], line: int, end: int, returns: str = "", virtual: bool = False
    ) -> None:
        """Notes the function it is in."""
        self.functions.append(
            Function(
                self.name,
                self.owner,
                parameters,
                line,
                end,
                tuple(self.guards),
                tuple(self.calls),
                tuple(self.assignments),
                tuple(self.accesses),
                (),
                returns,
                virtual,
            )
        )

    def run(self, body: Node, guard: int = -1) -> None:
        """The statements of a function; given by who knows statements."""
        raise NotImplementedError


BRACKETS = (kind("[", False), kind("]", False))
EQUALS = kind("=", False)
TRAILING_RETURN = kind("trailing_return_type")
DECLARATORS = NAMES | frozenset(
    kind(name)
    for name in (
        "function_declarator", "pointer_declarator", "reference_declarator", "array_declarator", "init_declarator",
        "parenthesized_declarator", "structured_binding_declarator", "variadic_declarator", "attributed_declarator",
    )
)  # fmt: skip
TYPES = frozenset(
    kind(name)
    for name in (
        "type_identifier", "primitive_type", "sized_type_specifier", "qualified_identifier", "template_type",
        "placeholder_type_specifier", "decltype", "dependent_type", "auto",
    )
)  # fmt: skip
OPERATORS = {
    kind(sign, False): sign
    for sign in [
        "+",
        "-",
        "*",
        "/",
        "%",
        "<",
        ">",
        "<=",
        ">=",
        "==",
        "!=",
        "&&",
        "||",
        "<<",
        ">>",
        "&",
        "|",
        "^",
        "<=>",
        "and",
        "or",
    ]
    if LANGUAGE.id_for_node_kind(sign, False)
}
OPERATORS = {number: {"and": "&&", "or": "||"}.get(sign, sign) for number, sign in OPERATORS.items()}
JOINING = frozenset("+/%")
SAFE = frozenset(["-", "*", "/", "%", "<", ">", "<=", ">=", "&&", "||", "&", "|", "^"])
LITERALS: dict[int, Callable[..., Expr]] = {
    **{kind(name): Body.number for name in SIMPLE_NUMBERS},
    STRING: Body.string,
    RAW_STRING: Body.string,
    kind("concatenated_string"): Body.strings,
}
VALUES: dict[int, Callable[..., Expr]] = {
    **LITERALS,
    IDENTIFIER: Body.identifier,
    QUALIFIED: Body.qualified,
    TEMPLATE_FUNCTION: Body.qualified,
    FIELD: Body.field,
    THIS: Body.this,
    CALL: Body.call,
    SUBSCRIPT: Body.subscript,
    PARENTHESIZED: Body.parenthesized,
    POINTER: Body.pointer,
    CAST: Body.last_child,
    BINARY: Body.binary,
    kind("unary_expression"): Body.unary,
    kind("update_expression"): Body.update,
    kind("assignment_expression"): Body.assignment,
    kind("conditional_expression"): Body.conditional,
    BRACES: Body.braces,
    kind("initializer_pair"): Body.last_child,
    kind("new_expression"): Body.made,
    kind("compound_literal_expression"): Body.made,
    LAMBDA: Body.lambda_,
    kind("co_await_expression"): Body.last_child,
    kind("throw_statement"): Body.thrown,
    kind("sizeof_expression"): Body.asked_only,
    kind("delete_expression"): Body.asked_only,
    DECLARATION: Body.declaration,
    COMMENT: Body.skipped,
    kind("type_descriptor"): Body.skipped,
    kind("template_argument_list"): Body.skipped,
    kind("primitive_type"): Body.skipped,
    kind("type_identifier"): Body.skipped,
    kind("field_identifier"): Body.skipped,
}
