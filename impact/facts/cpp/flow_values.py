"""What stands inside C++ functions: expressions to calls, assignments and uses of variables.

One walk does it all. Reading a tree in Python costs more than parsing it, so the walk looks at a node once: it takes
the text of plain paths whole, and asks for children in one go instead of by field.

A use of a parameter or local variable is judged by where it stands: a test or an operand is a `read`; an argument is a
`pass`; so is a method called on it, with position -1; the value of another local variable is a `read` too, since the
Assignment tells what goes on from there; all that is not known to be safe is an `escape`.
"""

import re
from bisect import bisect_right
from collections.abc import Callable
from functools import lru_cache
from typing import Any

from tree_sitter import Node

from ..flow import Access, Assignment, FlowCall, FlowExpr, FlowFunction, Guard
from .flow_clean import Cleaned, Regions
from .flow_grammar import KIND, LISTS, LITERALS, OPERATORS, find_node_readers, get_items, list_children
from .names import strip_templates

# A position: kind of access, callee it is passed to, number of the argument.
READ, WRITE, PASS, ESCAPE = "read", "write", "pass", "escape"
RETURN = "return"  # in place of a target: no path is called so

LONGEST_OTHER = 120
LONGEST_CONDITION = 4000
DEEPEST = 24
NOTHING = FlowExpr("other")

_PLAIN = re.compile(r"(this->)?([A-Za-z_]\w*)(?:(?:\.|->)[A-Za-z_]\w*)*")
_ASIDE = re.compile(r'//[^\n]*|/\*.*?\*/|("(?:[^"\\]|\\.)*")', re.DOTALL)
_ESCAPES = {"n": "\n", "t": "\t", "\\": "\\", '"': '"', "'": "'", "0": "\0", "r": "\r"}
_ESCAPED = re.compile(r"\\(.)", re.DOTALL)

JOINING = frozenset("+/%")
SAFE = frozenset(("-", "*", "/", "%", "<", ">", "<=", ">=", "&&", "||", "&", "|", "^"))
# Calls that are no news: what they are given counts, themselves they do not.
_NOISE = re.compile(
    r"(?:ROS|RCLCPP|RCUTILS|NODELET|RCLC)_(?:DEBUG|INFO|WARN|ERROR|FATAL|LOG|SAFE_FWRITE|ASSERT|BREAK)\w*"
    r"|(?:EXPECT|ASSERT)_\w+|CONSOLE_BRIDGE_log\w+|assert"
)


@lru_cache(maxsize=4096)
def is_noise(callee: str) -> bool:
    """Whether a function only logs or checks."""
    return _NOISE.fullmatch(callee) is not None


# Functions that give what they are given.
THROUGH = frozenset((
    "std::move", "std::forward", "std::as_const", "std::ref", "std::cref", "boost::ref", "std::get",
    "static_cast", "dynamic_cast", "const_cast", "reinterpret_cast",
    "std::static_pointer_cast", "std::dynamic_pointer_cast", "std::const_pointer_cast",
    "boost::static_pointer_cast", "boost::dynamic_pointer_cast", "boost::const_pointer_cast",
))  # fmt: skip
BINDS = frozenset(("std::bind", "boost::bind", "bind", "std::bind_front", "std::mem_fn", "boost::mem_fn"))
MAKES = frozenset((
    "std::make_shared", "std::make_unique", "boost::make_shared", "boost::make_unique", "make_shared", "make_unique",
))  # fmt: skip
# Methods of containers, strings and pointers; a message's fields have no others.
ELEMENTS = frozenset(("at", "front", "back", "begin", "end", "cbegin", "cend", "rbegin", "rend"))
POINTEES = frozenset(("get", "lock", "value", "getMessage", "getConstMessage"))
LOOKS = frozenset((
    "size", "empty", "length", "c_str", "capacity", "max_size", "has_value", "valid", "count", "isZero", "toSec",
    "toNSec", "seconds", "nanoseconds", "expired", "use_count",
))  # fmt: skip
CHANGES = frozenset((
    "push_back", "emplace_back", "emplace", "resize", "clear", "assign", "reserve", "insert", "erase", "pop_back",
    "pop_front", "push_front", "swap", "reset", "append", "fill",
))  # fmt: skip
SILENT = ELEMENTS | {"size", "empty", "length", "c_str", "capacity", "has_value", "use_count"}


def flatten(text: str) -> str:
    """A piece of source on one line, without comments."""
    if "/" in text and ("//" in text or "/*" in text):
        text = _ASIDE.sub(lambda match: match[1] or " ", text)
    if "\n" in text or "  " in text or "\t" in text:
        return " ".join(text.split())
    return text.strip()


OPERATOR = re.compile(r"\boperator\b")
"""The word in the name of an operator, and in no other name."""


def strip_template(name: str) -> str:
    """A name without its template arguments and without blanks."""
    if "<" not in name and " " not in name and "\n" not in name:
        return name
    return " ".join(name.split()) if OPERATOR.search(name) else strip_templates(name)


class FunctionReader:
    """The reader of one file's functions, and the function that it is in."""

    def __init__(self, cleaned: Cleaned) -> None:
        self.text = cleaned.text
        self.starts = cleaned.starts
        self.regions = Regions(cleaned.regions) if cleaned.regions else None
        self.functions: list[FlowFunction] = []
        self.nesting = 0
        self.name = ""
        self.owner = ""
        self.begin(set())
        # Of the call that was read last.
        self.callee = ""
        # What the receiver of the call that is read is, where it is a call too or is made there.
        self.received: FlowExpr | None = None
        # Parameters of the template that is read.
        self.types: tuple[str, ...] = ()

    def begin(self, known: set[str]) -> None:
        """Starts an empty function that knows some variables."""
        self.guards: list[Guard] = []
        self.calls: list[FlowCall] = []
        self.assignments: list[Assignment] = []
        self.accesses: list[Access] = []
        self.known = known

    def get_state(self) -> tuple[Any, ...]:
        """The function it is in, to be gone back to by restore()."""
        return (self.name, self.owner, self.guards, self.calls, self.assignments, self.accesses, self.known)

    def restore(self, state: tuple[Any, ...]) -> None:
        self.name, self.owner, self.guards, self.calls, self.assignments, self.accesses, self.known = state

    def spell_node(self, node: Node) -> str:
        """The source of a node on one line."""
        text = self.text[node.start_byte : node.end_byte]
        if "\n" in text or "  " in text or "/" in text or "\t" in text:
            return flatten(text)
        return text

    def find_line(self, node: Node) -> int:
        return bisect_right(self.starts, node.start_byte)

    def locate(self, offset: int) -> tuple[int, int]:
        line = bisect_right(self.starts, offset)
        return line, offset - self.starts[line - 1] + 1

    def guard(self, kind_: str, text: str, line: int, outer: int) -> int:
        """A new guard around what follows; gives its place."""
        self.guards.append(Guard(kind_, text[:LONGEST_CONDITION], line, outer))
        return len(self.guards) - 1

    def follow(self, node: Node, guard: int, position: str = READ, target: str | None = "") -> FlowExpr:
        """An expression that stands in a position; target: what it is kept in, RETURN for what the function returns,
        None where nobody asks what it says."""
        return VALUES[node.kind_id](self, node, guard, position, target)

    def make_other(self, node: Node) -> FlowExpr:
        start = node.start_byte
        end = min(node.end_byte, start + 4 * LONGEST_OTHER)
        return FlowExpr("other", flatten(self.text[start:end])[:LONGEST_OTHER])

    def visit_anything(self, node: Node, guard: int, position: str, target: str | None) -> FlowExpr:
        for child in node.children:
            read = VALUES.get(child.kind_id)
            if read is not None:
                read(self, child, guard, ESCAPE if position == READ else position, None)
            elif child.child_count:
                self.visit_anything(child, guard, position, None)
        return NOTHING if target is None else self.make_other(node)

    def evaluate_comment(self, node: Node, guard: int, position: str, target: str | None) -> FlowExpr:
        return self.make_other(node)

    evaluate_type_descriptor = evaluate_template_argument_list = evaluate_primitive_type = evaluate_comment
    evaluate_type_identifier = evaluate_field_identifier = evaluate_comment

    def evaluate_identifier(self, node: Node, guard: int, position: str, target: str | None) -> FlowExpr:
        name = self.text[node.start_byte : node.end_byte]
        if name in self.known:
            self.touch(name, position)
        return FlowExpr("name", name)

    def evaluate_number_literal(self, node: Node, guard: int, position: str, target: str | None) -> FlowExpr:
        return FlowExpr("number", self.text[node.start_byte : node.end_byte])

    evaluate_true = evaluate_false = evaluate_null = evaluate_char_literal = evaluate_number_literal

    def evaluate_string_literal(self, node: Node, guard: int, position: str, target: str | None) -> FlowExpr:
        text = self.text[node.start_byte : node.end_byte]
        if text[0:1] == '"' and "\\" not in text:
            return FlowExpr("text", text[1:-1])
        return FlowExpr("text", self.unquote_literal(node))

    evaluate_raw_string_literal = evaluate_string_literal

    def unquote_literal(self, node: Node) -> str:
        """The value of a string literal."""
        text = self.text[node.start_byte : node.end_byte]
        if node.kind_id == KIND.raw_string_literal:
            start, end = text.find("("), text.rfind(")")
            return text[start + 1 : end] if start >= 0 else ""
        text = text[text.find('"') + 1 : -1]
        if "\\" in text:
            text = _ESCAPED.sub(lambda match: _ESCAPES.get(match[1], "" if match[1] == "\n" else match[0]), text)
        return text

    def evaluate_concatenated_string(self, node: Node, guard: int, position: str, target: str | None) -> FlowExpr:
        parts: list[FlowExpr] = []
        for child in node.children:
            number = child.kind_id
            if number in (KIND.string_literal, KIND.raw_string_literal):
                text = self.unquote_literal(child)
                if parts and parts[-1].kind == "text":
                    text = parts.pop().text + text
                parts.append(FlowExpr("text", text))
            elif number == KIND.identifier:
                parts.append(FlowExpr("name", self.text[child.start_byte : child.end_byte]))
        if len(parts) == 1:
            return parts[0]
        return FlowExpr("join", "+", tuple(parts))

    def evaluate_qualified_identifier(self, node: Node, guard: int, position: str, target: str | None) -> FlowExpr:
        return FlowExpr("name", strip_template(self.text[node.start_byte : node.end_byte]))

    evaluate_template_function = evaluate_this = evaluate_qualified_identifier

    def evaluate_field_expression(self, node: Node, guard: int, position: str, target: str | None) -> FlowExpr:
        path, local = self.visit_path(node, guard)
        if local:
            self.touch(path, position)
        return FlowExpr("name", path)

    def touch(self, path: str, position: str) -> None:
        """Notes what may change a variable of the function."""
        if position != READ:
            self.accesses.append(Access(path, position))

    def visit_path(self, node: Node, guard: int) -> tuple[str, bool]:
        """A path and whether it begins at a variable of the function; what stands inside, such as an index, is read."""
        number = node.kind_id
        if number == KIND.identifier:
            name = self.text[node.start_byte : node.end_byte]
            return name, name in self.known
        if number == KIND.field_expression:
            plain = self.find_plain_path(node)
            if plain is not None:
                return plain
            children = list_children(node)
            path, local = self.visit_path(children[0], guard)
            return f"{path}.{self.find_member_name(children[-1])}", local
        if number in (KIND.this, KIND.qualified_identifier):
            return strip_template(self.text[node.start_byte : node.end_byte]), False
        if number in (KIND.parenthesized_expression, KIND.pointer_expression, KIND.cast_expression):
            children = list_children(node)
            return self.visit_path(children[1] if number == KIND.parenthesized_expression else children[-1], guard)
        if number == KIND.subscript_expression:
            children = list_children(node)
            path, local = self.visit_path(children[0], guard)
            for index in get_items(children[1]):
                self.follow(index, guard)
            return f"{path}.[]", local
        if number == KIND.call_expression:
            children = list_children(node)
            function = children[0]
            if function.kind_id == KIND.field_expression:
                method = self.find_member_name(function.children[-1])
                if method in ELEMENTS or method in POINTEES:
                    if method in POINTEES:
                        self.evaluate_call_expression(node, guard, READ, "")
                        receiver = self.find_plain_path(function.children[0])
                        return receiver if receiver is not None else (self.callee.rpartition(".")[0], False)
                    path, local = self.visit_path(function.children[0], guard)
                    for argument in get_items(children[-1]):
                        self.follow(argument, guard)
                    return f"{path}.[]", local
            else:
                arguments = get_items(children[-1])
                called = strip_template(self.text[function.start_byte : function.end_byte])
                if len(arguments) == 1 and called in THROUGH:
                    return self.visit_path(arguments[0], guard)
            self.received = self.evaluate_call_expression(node, guard, ESCAPE, "")
            return self.callee + "()", False
        self.received = self.follow(node, guard, ESCAPE)
        return "()", False

    def find_plain_path(self, node: Node) -> tuple[str, bool] | None:
        """The path of a node that is nothing but names."""
        plain = _PLAIN.fullmatch(self.text, node.start_byte, node.end_byte)
        if plain is None:
            return None
        return plain[0].replace("->", "."), plain[1] is None and plain[2] in self.known

    def find_member_name(self, node: Node) -> str:
        """The name of a member in a field expression, without template arguments."""
        if node.kind_id == KIND.field_identifier:
            return self.text[node.start_byte : node.end_byte]
        if node.kind_id == KIND.dependent_name:
            node = node.children[-1]
        return strip_template(self.text[node.start_byte : node.end_byte])

    def split_template(self, node: Node) -> tuple[str, str]:
        """The name and the arguments of a template, as written."""
        name, written = node.children[0], node.children[-1]
        types = flatten(self.text[written.start_byte + 1 : written.end_byte - 1])
        return self.text[name.start_byte : name.end_byte], types

    def evaluate_call_expression(self, node: Node, guard: int, position: str, target: str | None) -> FlowExpr:
        """A call, which is noted, and its Expr."""
        children = node.children
        if len(children) != 2:
            children = [child for child in children if child.kind_id not in (KIND.comment, KIND.ERROR)]
            if len(children) < 2:
                return self.visit_anything(node, guard, position, target)
        function = children[0]
        number = function.kind_id
        text = self.text
        types = ""
        at = start = function.start_byte
        method = ""
        local = False
        receiver = ""
        received: FlowExpr | None = None
        if number == KIND.identifier:
            callee = text[start : function.end_byte]
        elif number == KIND.field_expression:
            plain = _PLAIN.fullmatch(text, start, function.end_byte)
            if plain is not None:
                callee = plain[0].replace("->", ".")
                receiver, _, method = callee.rpartition(".")
                at = function.end_byte - len(method)
                local = plain[1] is None and plain[2] in self.known
            else:
                parts = list_children(function)
                member = parts[-1]
                if member.kind_id == KIND.dependent_name:
                    member = member.children[-1]
                at = member.start_byte
                if member.kind_id == KIND.template_method:
                    method, types = self.split_template(member)
                else:
                    method = self.find_member_name(member)
                receiver, local = self.visit_path(parts[0], guard)
                if receiver.endswith("()"):
                    received = self.received
                callee = f"{receiver}.{method}"
        elif number == KIND.qualified_identifier:
            callee = text[start : function.end_byte]
            name = function
            while name.kind_id == KIND.qualified_identifier:
                name = name.children[-1]
            at = name.start_byte
            if name.kind_id == KIND.dependent_name:
                name = name.children[-1]
            if name.kind_id in (KIND.template_function, KIND.template_method):
                _, types = self.split_template(name)
            callee = strip_template(callee)
        elif number == KIND.template_function:
            callee, types = self.split_template(function)
        else:
            callee, local = self.visit_path(function, guard)

        listed = children[-1]
        if callee in THROUGH:
            inner = get_items(listed)
            if len(inner) == 1:
                return self.follow(inner[0], guard, position, target)
        if local and receiver:
            if method in ELEMENTS:
                self.touch(f"{receiver}.[]", position)
            elif method in POINTEES:
                self.touch(receiver, position)
            elif method not in LOOKS:
                self.touch(receiver, WRITE if method in CHANGES else PASS)
        logs = is_noise(callee)
        arguments: tuple[FlowExpr, ...] = ()
        if listed.end_byte - listed.start_byte > 2:
            self.nesting += 1
            if listed.kind_id in LISTS:
                arguments = self.visit_arguments(listed, guard, READ if logs or not callee else PASS)
            else:
                self.follow(listed, guard, ESCAPE)
            self.nesting -= 1
        self.callee = callee
        if callee in BINDS and arguments and (callee != "bind" or arguments[0].kind == "function"):
            return FlowExpr("bind", "", arguments)
        if not logs and not (method in SILENT and method):
            line, column = self.locate(at)
            kept = "" if target is None or target == RETURN else target
            self.calls.append(FlowCall(callee, arguments, line, column, guard, types, kept, target == RETURN))
        if target is None:
            return NOTHING
        if self.nesting > DEEPEST:
            return self.make_other(node)
        if callee in MAKES:
            return FlowExpr("make", types, arguments)
        return FlowExpr("call", callee, arguments, received)

    def visit_arguments(self, listed: Node, guard: int, position: str) -> tuple[FlowExpr, ...]:
        """The arguments in a list, each in the same position."""
        given = (child for child in listed.named_children if child.kind_id != KIND.comment)
        return tuple(VALUES[child.kind_id](self, child, guard, position, "") for child in given)

    def visit_initializer(self, listed: Node, type_: str, guard: int, position: str, target: str) -> FlowExpr:
        """What a variable begins with that is given a list: its one element, else an object of a type."""
        inner = get_items(listed)
        if len(inner) == 1:
            return self.follow(inner[0], guard, position, target)
        return FlowExpr("make", type_, self.visit_arguments(listed, guard, PASS))

    def evaluate_subscript_expression(self, node: Node, guard: int, position: str, target: str | None) -> FlowExpr:
        children = list_children(node)
        path, local = self.visit_path(children[0], guard)
        index = FlowExpr("other")
        for child in get_items(children[1]):
            index = self.follow(child, guard)
        if local:
            self.touch(f"{path}.[]", position)
        return FlowExpr("index", "", (FlowExpr("name", path), index))

    def evaluate_parenthesized_expression(self, node: Node, guard: int, position: str, target: str | None) -> FlowExpr:
        children = list_children(node)
        if len(children) != 3:
            return self.visit_anything(node, guard, position, target)
        return self.follow(children[1], guard, position, target)

    def evaluate_pointer_expression(self, node: Node, guard: int, position: str, target: str | None) -> FlowExpr:
        children = list_children(node)
        inner = children[-1]
        if self.text.startswith("&", node.start_byte):
            number = inner.kind_id
            if number in (KIND.qualified_identifier, KIND.template_function):
                return FlowExpr("function", strip_template(self.text[inner.start_byte : inner.end_byte]))
            if number == KIND.identifier:
                name = self.text[inner.start_byte : inner.end_byte]
                if name and name not in self.known and not name.endswith("_"):
                    return FlowExpr("function", name)
        return self.follow(inner, guard, position, target)

    def evaluate_cast_expression(self, node: Node, guard: int, position: str, target: str | None) -> FlowExpr:
        return self.follow(list_children(node)[-1], guard, position, target)

    evaluate_initializer_pair = evaluate_co_await_expression = evaluate_cast_expression

    def evaluate_binary_expression(self, node: Node, guard: int, position: str, target: str | None) -> FlowExpr:
        """Operators in a row are walked through, since a long row is a deep tree."""
        operands: list[Node] = []
        signs: list[str] = []
        lefts: list[Node] = []
        spine = node
        while True:
            children = spine.children
            if len(children) != 3:
                children = [child for child in children if child.kind_id not in (KIND.comment, KIND.ERROR)]
                if len(children) != 3:
                    break
            operands.append(children[2])
            signs.append(OPERATORS.get(children[1].kind_id, "?"))
            spine = children[0]
            lefts.append(spine)
            if spine.kind_id != KIND.binary_expression:
                break
        if not operands:
            return self.visit_anything(node, guard, position, target)
        if spine.kind_id == KIND.binary_expression:
            self.visit_anything(spine, guard, ESCAPE, None)
        operands.append(spine)
        operands.reverse()
        signs.reverse()
        lefts.reverse()
        alike = all(sign == signs[0] for sign in signs)
        stream = self.find_stream(operands[0]) if alike and signs[0] == "<<" else ""
        joined = alike and (signs[0] in JOINING or bool(stream)) and self.nesting <= DEEPEST
        parts: list[FlowExpr] = []
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
                        guard = self.guard(holds, self.format_condition(asked), self.find_line(asked), guard)
                    pending = []
            if number in LITERALS:
                read = VALUES[number](self, operand, guard, READ, "")
            else:
                if sign in SAFE or (sign in ("==", "!=") and self.is_beside_literal(operands, index)):
                    where = READ
                else:
                    where = ESCAPE
                read = VALUES[number](self, operand, guard, where, "" if joined else None)
            if joined:
                parts.append(read)
        self.nesting -= 1
        if stream and joined:
            added = FlowExpr("join", "", tuple(parts[1:]))
            self.assignments.append(Assignment(stream, added, self.find_line(node), outer, "", "+="))
            return FlowExpr("name", stream)
        if joined:
            return FlowExpr("join", signs[0], tuple(parts))
        return NOTHING if target is None else self.make_other(node)

    def find_stream(self, node: Node) -> str:
        """The local variable that a node names, where it is a stream of text; empty for all else."""
        name = self.text[node.start_byte : node.end_byte]
        if node.kind_id != KIND.identifier or name not in self.known:
            return ""
        return name if any(e.target == name and e.type.endswith("stringstream") for e in self.assignments) else ""

    def is_beside_literal(self, operands: list[Node], index: int) -> bool:
        other = operands[index - 1] if index else operands[1] if len(operands) > 1 else operands[0]
        return other.kind_id in LITERALS

    def evaluate_unary_expression(self, node: Node, guard: int, position: str, target: str | None) -> FlowExpr:
        children = list_children(node)
        inner = self.follow(children[-1], guard, READ, None)
        if inner.kind == "number" and self.text[node.start_byte] == "-":
            return FlowExpr("number", "-" + inner.text)
        return NOTHING if target is None else self.make_other(node)

    def evaluate_update_expression(self, node: Node, guard: int, position: str, target: str | None) -> FlowExpr:
        children = list_children(node)
        operand = children[0] if children[-1].child_count == 0 and not children[-1].is_named else children[-1]
        path, local = self.visit_path(operand, guard)
        if local:
            self.touch(path, WRITE)
        sign = "+=" if any(child.type == "++" for child in children) else "-="
        self.assignments.append(Assignment(path, FlowExpr("number", "1"), self.find_line(node), guard, "", sign))
        return FlowExpr("name", path)

    def evaluate_assignment_expression(self, node: Node, guard: int, position: str, target: str | None) -> FlowExpr:
        children = list_children(node)
        if len(children) != 3:
            return self.visit_anything(node, guard, position, target)
        left, sign, right = children
        path, local = self.visit_path(left, guard)
        if local:
            self.touch(path, WRITE)
        operator = self.text[sign.start_byte : sign.end_byte]
        followed = operator != "=" or path in self.known
        value = self.follow(right, guard, READ if followed else ESCAPE, path)
        self.assignments.append(
            Assignment(path, value, self.find_line(node), guard, "", operator, self.find_key(left, guard))
        )
        return value

    def find_key(self, node: Node, guard: int) -> FlowExpr | None:
        """The literal in the brackets of an element's path."""
        if node.kind_id != KIND.subscript_expression:
            return None
        inner = get_items(list_children(node)[1])
        return self.follow(inner[0], guard) if len(inner) == 1 and inner[0].kind_id in LITERALS else None

    def evaluate_conditional_expression(self, node: Node, guard: int, position: str, target: str | None) -> FlowExpr:
        children = list_children(node)
        if len(children) != 5:
            return self.visit_anything(node, guard, position, target)
        asked, _, yes, _, no = children
        self.nesting += 1
        condition = self.follow(asked, guard, READ)
        line = self.find_line(node)
        text = self.format_condition(asked)
        true = self.follow(yes, self.guard("if", text, line, guard), position, target)
        false = self.follow(no, self.guard("unless", text, line, guard), position, target)
        self.nesting -= 1
        if self.nesting > DEEPEST:
            return self.make_other(node)
        return FlowExpr("choice", "", (condition, true, false))

    def format_condition(self, node: Node) -> str:
        """A condition as written, without parentheses around the whole."""
        while node.kind_id == KIND.parenthesized_expression:
            children = list_children(node)
            if len(children) != 3:
                break
            node = children[1]
        return self.spell_node(node)

    def evaluate_initializer_list(self, node: Node, guard: int, position: str, target: str | None) -> FlowExpr:
        if self.nesting > DEEPEST:
            self.visit_anything(node, guard, ESCAPE, "")
            return self.make_other(node)
        self.nesting += 1
        parts = tuple(self.follow(child, guard, ESCAPE) for child in get_items(node))
        self.nesting -= 1
        return FlowExpr("list", "", parts)

    def evaluate_new_expression(self, node: Node, guard: int, position: str, target: str | None) -> FlowExpr:
        """`new T(...)` and `T{...}`."""
        children = list_children(node)
        kind_ = ""
        parts: tuple[FlowExpr, ...] = ()
        self.nesting += 1
        for child in children:
            if child.kind_id in (KIND.argument_list, KIND.initializer_list):
                parts = self.visit_arguments(child, guard, PASS)
            elif child.is_named and not kind_:
                kind_ = self.spell_node(child)
        self.nesting -= 1
        if self.nesting > DEEPEST:
            return self.make_other(node)
        return FlowExpr("make", kind_, parts)

    evaluate_compound_literal_expression = evaluate_new_expression

    def evaluate_throw_statement(self, node: Node, guard: int, position: str, target: str | None) -> FlowExpr:
        return self.visit_anything(node, guard, ESCAPE, "")

    def evaluate_sizeof_expression(self, node: Node, guard: int, position: str, target: str | None) -> FlowExpr:
        for child in node.children:
            read = VALUES.get(child.kind_id)
            if read is not None:
                read(self, child, guard, READ, "")
        return self.make_other(node)

    evaluate_delete_expression = evaluate_sizeof_expression


class _Readers(dict[int, Callable[..., FlowExpr]]):
    """How each kind of node is read; one that is not listed is looked into."""

    def __missing__(self, number: int) -> Callable[..., FlowExpr]:
        return FunctionReader.visit_anything


VALUES = _Readers(find_node_readers(FunctionReader, "evaluate_"))
