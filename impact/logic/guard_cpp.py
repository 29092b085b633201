"""C++ conditions to terms, with tree-sitter. Whatever is not understood is opaque; nothing raises."""

import re
from typing import Any

from ...edges.dispatch import collect_methods
from ..facts.cpp.flow_grammar import PARSER
from .guard_terms import (
    DEEPEST,
    FALSE,
    FLIPPED,
    LONGEST,
    NOW,
    NULL,
    TRUE,
    Conjunct,
    GuardReading,
    Term,
    build_reading,
    compare,
    join,
    make_member,
    make_opaque,
    negate,
    parse_number,
    split_owner,
)

_WORDS = {"and": "&&", "or": "||", "not": "!", "not_eq": "!=", "compl": "~", "bitand": "&", "bitor": "|", "xor": "^"}
_CASTS = ("static_cast", "const_cast", "reinterpret_cast")
_INTEGERS = frozenset(("int", "long", "short", "unsigned", "signed", "char", "size_t"))
_WHOLE_TYPE = re.compile(r"(?:std::)?u?int(?:_fast|_least)?\d*_t|(?:std::)?s?size_t")
_PASSED_ON = frozenset(("std::move", "std::as_const", "std::forward", "std::ref", "std::cref"))
_ABSOLUTE = frozenset(("abs", "std::abs", "fabs", "std::fabs", "fabsf"))
_MATH = frozenset((
    "std::isnan", "std::isinf", "std::isfinite", "std::min", "std::max", "std::sqrt", "std::pow", "std::hypot",
    "std::round", "std::floor", "std::ceil", "std::fmod", "std::atan2", "std::signbit",
))  # fmt: skip
_SUFFIX = re.compile(r"(?<=[\d.])[uUlLfFzZ]+$")
_DURATION = re.compile(r"([\d.']+)(h|min|s|ms|us|ns)$")
_SECONDS = {"h": "3600", "min": "60", "s": "1", "ms": "1e-3", "us": "1e-6", "ns": "1e-9"}
_CATCH = re.compile(r"\bcatch\s*\(([^()]*)\)")
_CAUGHT = re.compile(r"(?:const\s+)?(?:[\w:]*::)?(\w+(?:<.*>)?)(?:\s+const)?(?:\s*[&*]+\s*\w*|\s+(?!as\b)\w+)?")
_DEFINED = re.compile(r"\bdefined\s+([A-Za-z_]\w*)")
_HAS_INCLUDE = re.compile(r"<([^<>\s]+\.?[^<>\s]*)>")


def parse_condition(text: str, holds: bool) -> GuardReading:
    """What a condition says when it holds, or when it does not."""
    text = text.strip()
    text = text.removeprefix("constexpr ")
    reader = _Reader(text)
    node = reader.find_clause()
    if node is None:
        term = make_opaque(text)
        return GuardReading((Conjunct(text if holds else f"!({text})", term if holds else negate(term)),))
    return build_reading(reader.split_pieces(node, holds), reader.names)


def parse_expression(text: str) -> Term:
    """The term of an expression."""
    reader = _Reader(text.strip())
    node = reader.find_clause()
    return make_opaque(text) if node is None else reader.parse_term(node, 0)


def parse_directive(text: str, holds: bool) -> GuardReading:
    """What the condition of an #if says."""
    text = _DEFINED.sub(r"defined(\1)", text)
    if "__has_include" in text:
        text = _HAS_INCLUDE.sub(r'"\1"', text)
    return parse_condition(text, holds)


def make_caught_term(declared: str) -> Term:
    """That an exception was caught, whatever the variable is called and the namespace is."""
    match = _CAUGHT.fullmatch(" ".join(declared.split()))
    return Term("opaque", f"catch {match[1] if match else ' '.join(declared.split())}")


def loop(head: str) -> GuardReading:
    """What the head of a range-for says: that there is an element."""
    inside = head.strip()
    match = re.match(r"for\s*\((.*)\)$", inside, re.DOTALL)
    inside = match[1] if match else inside
    # The colon that is no `::`, after the declaration.
    split = re.search(r"(?<!:):(?!:)", inside)
    variable = re.search(r"([A-Za-z_]\w*|\[[^\]]*\])\s*$", inside[: split.start()]) if split else None
    if split is None or variable is None:
        match = re.match(r"\w+\s*\(\s*(?:.*[\s&*])?([A-Za-z_]\w*)\s*,(.*)\)$", head.strip(), re.DOTALL)
        if match is None:
            return GuardReading((Conjunct(head, make_opaque(head)),))
        bound, walked = [match[1]], match[2]
    else:
        bound, walked = re.findall(r"\w+", variable[1]), inside[split.end() :]
    container = parse_expression(walked)
    element = Term("each", "", (container,))
    names = (
        [(bound[0], element)]
        if len(bound) == 1
        else [(name, make_member(element, f"{i}")) for i, name in enumerate(bound)]
    )
    return GuardReading((Conjunct(f"for ({head})" if match is None else head, element),), tuple(names))


def _make_contained(owner: Term, key: Term) -> Term:
    """That a container has a key."""
    return compare("<", Term("whole", "0"), Term("call", "", (make_member(owner, "count"), key)))


def _compare(operator: str, left: Term, right: Term) -> Term:
    """A comparison; `m.find(key) != m.end()` says that the container has it."""
    if operator in ("==", "!="):
        for one, end in ((left, right), (right, left)):
            if one.kind == end.kind == "call" and len(one.parts) == 2 and len(end.parts) == 1:
                (owner, found), (other, last) = split_owner(one.parts[0]), split_owner(end.parts[0])
                if owner is not None and owner == other and found == "find" and last in ("end", "cend"):
                    contained = _make_contained(owner, one.parts[1])
                    return contained if operator == "!=" else negate(contained)
    return compare(operator, left, right)


class _Reader:
    """Reads the tree of one condition. names: variables that the condition makes."""

    def __init__(self, text: str) -> None:
        self.names: list[tuple[str, Term]] = []
        self.text = text
        # What was caught stands between conditions where branches are put together.
        text = _CATCH.sub(lambda match: f'catch_("{match[1]}")', text) if "catch" in text else text
        self.source = b"void f() { if (" + text.encode("utf-8", "replace") + b"\n) ; }"

    def find_clause(self) -> Any:
        """The condition's node; None when the text is not one condition."""
        if not self.text or len(self.text) > LONGEST or "\0" in self.text:
            return None
        root = PARSER.parse(self.source).root_node
        if root.has_error or root.named_child_count != 1:
            return None
        body = root.named_children[0].child_by_field_name("body")
        if body is None or body.named_child_count != 1 or body.named_children[0].type != "if_statement":
            return None
        clause = body.named_children[0].child_by_field_name("condition")
        if clause is None or clause.end_byte != len(self.source) - 4:
            return None
        for part in clause.named_children:
            if part.type == "init_statement":
                for declaration in part.named_children:
                    self.read_declaration(declaration, 0)
        return clause.child_by_field_name("value")

    def parse_text(self, node: Any) -> str:
        text = " ".join(self.source[node.start_byte : node.end_byte].decode("utf-8", "replace").split())
        return re.sub(r'catch_\("([^"]*)"\)', r"catch (\1)", text) if "catch_" in text else text

    def join_tokens(self, node: Any) -> str:
        found: list[str] = []
        waiting = [node]
        while waiting:
            node = waiting.pop()
            if node.type == "comment":
                continue
            if node.child_count and node.type not in ("string_literal", "char_literal", "raw_string_literal"):
                waiting.extend(reversed(node.children))
            else:
                found.append(self.parse_text(node))
        return " ".join(found)

    def make_opaque(self, node: Any) -> Term:
        return Term("opaque", self.join_tokens(node))

    def strip_parentheses(self, node: Any) -> Any:
        """The node without parentheses around it."""
        while node.type == "parenthesized_expression":
            inside = _list_children(node)
            if len(inside) != 1:
                return node
            node = inside[0]
        return node

    def parse_operator(self, node: Any) -> str:
        operator = node.child_by_field_name("operator")
        written = self.parse_text(operator) if operator is not None else ""
        return _WORDS.get(written, written)

    def flatten_chain(self, node: Any) -> tuple[list[Any], list[str]]:
        """Operands of a chain of binary operators that lean to the left, and the operators between them."""
        operands: list[Any] = []
        operators: list[str] = []
        while node.type == "binary_expression":
            operators.append(self.parse_operator(node))
            operands.append(node.child_by_field_name("right"))
            node = node.child_by_field_name("left")
        operands.append(node)
        return operands[::-1], operators[::-1]

    def split_pieces(self, node: Any, holds: bool) -> list[Conjunct]:
        """What must hold, one after the other, for the condition to hold (or not to)."""
        result: list[Conjunct] = []
        waiting = [(node, holds)]
        while waiting:
            node, holds = waiting.pop()
            node = self.strip_parentheses(node)
            if node.type == "unary_expression" and self.parse_operator(node) == "!":
                waiting.append((node.child_by_field_name("argument"), not holds))
            elif node.type == "binary_expression" and self.parse_operator(node) == ("&&" if holds else "||"):
                waiting.append((node.child_by_field_name("right"), holds))
                waiting.append((node.child_by_field_name("left"), holds))
            else:
                term = self.parse_term(node, 0)
                result.append(Conjunct(self.format_node(node, holds), term if holds else negate(term)))
        return result

    def format_node(self, node: Any, holds: bool) -> str:
        text = self.parse_text(node)
        if holds:
            return text
        if node.type == "binary_expression":
            flipped = FLIPPED.get(self.parse_operator(node))
            if flipped is None:
                return f"!({text})"
            left, right = node.child_by_field_name("left"), node.child_by_field_name("right")
            return f"{self.parse_text(left)} {flipped} {self.parse_text(right)}"
        simple = ("identifier", "field_expression", "call_expression", "qualified_identifier", "subscript_expression")
        return f"!{text}" if node.type in simple else f"!({text})"

    def parse_term(self, node: Any, depth: int) -> Term:
        node = self.strip_parentheses(node)
        read = _READ.get(node.type)
        if read is None or depth > DEEPEST:
            return self.make_opaque(node)
        return read(self, node, depth + 1)

    def parse_field(self, node: Any, name: str, depth: int) -> Term:
        part = node.child_by_field_name(name)
        return self.make_opaque(node) if part is None else self.parse_term(part, depth)

    def read_binary_expression(self, node: Any, depth: int) -> Term:
        operands, operators = self.flatten_chain(node)
        result = self.parse_term(operands[0], depth)
        position = 0
        while position < len(operators):
            operator = operators[position]
            if operator in ("&&", "||"):
                parts = [result]
                while position < len(operators) and operators[position] == operator:
                    position += 1
                    parts.append(self.parse_term(operands[position], depth))
                result = join("and" if operator == "&&" else "or", parts)
                continue
            position += 1
            if position > DEEPEST:
                return self.make_opaque(node)
            right = self.parse_term(operands[position], depth)
            if operator in FLIPPED:
                result = _compare(operator, result, right)
            elif operator in ("+", "-", "*"):
                result = Term(operator, "", (result, right))
            else:
                result = Term("op", operator, (result, right))
        return result

    def read_unary_expression(self, node: Any, depth: int) -> Term:
        operator = self.parse_operator(node)
        operand = self.parse_field(node, "argument", depth)
        if operator == "!":
            return negate(operand)
        if operator == "-":
            return Term("-", "", (Term("whole", "0"), operand))
        return operand if operator == "+" else Term("op", operator, (operand,))

    read_pointer_expression = read_unary_expression

    def read_identifier(self, node: Any, depth: int) -> Term:
        text = re.sub(r"\s+", "", self.join_tokens(node)).removeprefix("::")
        if text in ("std::nullopt", "nullopt", "boost::none"):
            return NULL
        return Term("name", text.removeprefix("std::") if text in _MATH else text)

    read_qualified_identifier = read_template_function = read_identifier

    def read_field_expression(self, node: Any, depth: int) -> Term:
        field = node.child_by_field_name("field")
        owner = node.child_by_field_name("argument")
        if field is None or owner is None:
            return self.make_opaque(node)
        return make_member(self.parse_term(owner, depth), re.sub(r"^template\s*|\s+", "", self.join_tokens(field)))

    def read_call_expression(self, node: Any, depth: int) -> Term:
        listed = node.child_by_field_name("arguments")
        called = node.child_by_field_name("function")
        if listed is None or called is None:
            return self.make_opaque(node)
        arguments = [self.parse_term(child, depth) for child in _list_children(listed)]
        called = self.strip_parentheses(called)
        if len(arguments) == 1:
            cast = self.find_cast_type(called)
            if cast is not None:
                return self.make_cast(cast, arguments[0])
        function = self.parse_term(called, depth)
        if function.text == "catch_" and len(arguments) == 1 and arguments[0].kind == "string":
            return make_caught_term(arguments[0].text[1:-1])
        if function.kind == "name" and len(arguments) == 1:
            if function.text in _PASSED_ON:
                return arguments[0]
            if function.text in _ABSOLUTE:
                return Term("abs", "", (arguments[0],))
        if not arguments:
            owner, method = split_owner(function)
            if owner is not None:
                if method == "size":
                    return Term("size", "", (owner,))
                if method == "empty":
                    return compare("==", Term("size", "", (owner,)), Term("whole", "0"))
                if method == "has_value":
                    return Term("truth", "", (owner,))
                if method == "load":
                    return owner  # of an atomic
                if method == "toSec":
                    return Term("call", "", (make_member(owner, "seconds"),))
                if method == "now":
                    return NOW  # of a node or its clock
            if function.text in ("ros::Time::now", "now"):
                return NOW
        owner, method = split_owner(function) if len(arguments) == 1 else (None, "")
        if owner is not None and method == "contains":
            return _make_contained(owner, arguments[0])
        return Term("call", "", (function, *arguments))

    def find_cast_type(self, called: Any) -> str | None:
        """The type, when what is called is a type or a cast."""
        if called.type == "template_function":
            name = called.child_by_field_name("name")
            types = called.child_by_field_name("arguments")
            if name is not None and types is not None and self.parse_text(name) in _CASTS:
                return self.parse_text(types)[1:-1].strip()
            return None
        if called.type in ("primitive_type", "sized_type_specifier"):
            return self.parse_text(called)
        if called.type in ("identifier", "qualified_identifier") and _WHOLE_TYPE.fullmatch(self.parse_text(called)):
            return self.parse_text(called)
        return None

    def make_cast(self, type_: str, value: Term) -> Term:
        """A cast is left out, save one that cuts a fraction off or asks for the truth."""
        if type_ == "bool":
            return Term("truth", "", (value,))
        whole = _WHOLE_TYPE.fullmatch(type_) or _INTEGERS.issuperset(type_.split())
        return Term("op", "cut", (value,)) if whole and _is_fractional(value) else value

    def read_cast_expression(self, node: Any, depth: int) -> Term:
        type_ = node.child_by_field_name("type")
        return self.make_cast(
            self.parse_text(type_) if type_ is not None else "", self.parse_field(node, "value", depth)
        )

    def read_subscript_expression(self, node: Any, depth: int) -> Term:
        indices = node.child_by_field_name("indices")
        parts = (self.parse_term(child, depth) for child in (_list_children(indices) if indices is not None else ()))
        return Term("index", "", (self.parse_field(node, "argument", depth), *parts))

    def read_conditional_expression(self, node: Any, depth: int) -> Term:
        parts = (self.parse_field(node, name, depth) for name in ("condition", "consequence", "alternative"))
        return Term("choice", "", tuple(parts))

    def read_number_literal(self, node: Any, depth: int) -> Term:
        text = self.parse_text(node).replace("'", "")
        duration = _DURATION.match(text)
        if duration:
            count, unit = parse_number(duration[1]), parse_number(_SECONDS[duration[2]])
            return self.make_opaque(node) if count is None or unit is None else Term("*", "", (count, unit))
        try:
            if text[:2] in ("0x", "0X", "0b", "0B"):
                return parse_number(str(int(re.sub(r"[uUlLzZ]+$", "", text)[:_LONGEST_HEX], 0))) or self.make_opaque(
                    node
                )
            plain = _SUFFIX.sub("", text)
            if plain.isdigit() and plain.startswith("0"):
                return parse_number(str(int(plain, 8))) or self.make_opaque(node)
        except ValueError:
            return self.make_opaque(node)
        return parse_number(plain) or self.make_opaque(node)

    read_user_defined_literal = read_number_literal

    def read_string_literal(self, node: Any, depth: int) -> Term:
        return Term("string", re.sub(r"\s*\n\s*", "", self.parse_text(node)))

    read_raw_string_literal = read_concatenated_string = read_char_literal = read_string_literal

    def read_assignment_expression(self, node: Any, depth: int) -> Term:
        """`a = b` has the value of b, which a stands for further in."""
        left = node.child_by_field_name("left")
        value = self.parse_field(node, "right", depth)
        if self.parse_operator(node) != "=" or left is None or left.type != "identifier":
            return self.make_opaque(node)
        self.names.append((self.parse_text(left), value))
        return value

    def read_declaration(self, node: Any, depth: int) -> Term:
        """`auto p = f()` has the value of f()."""
        declarator = node.child_by_field_name("declarator")
        value = node.child_by_field_name("value")
        if declarator is not None and declarator.type == "init_declarator":
            value = declarator.child_by_field_name("value")
            declarator = declarator.child_by_field_name("declarator")
        if declarator is None or value is None:
            return self.make_opaque(node)
        if value.type in ("initializer_list", "argument_list"):
            inside = _list_children(value)
            if len(inside) != 1:
                return self.make_opaque(node)
            value = inside[0]
        term = self.parse_term(value, depth)
        name = re.search(r"([A-Za-z_]\w*)$", self.parse_text(declarator))
        if name:
            self.names.append((name[1], term))
        return term

    def read_true(self, node: Any, depth: int) -> Term:
        return {"true": TRUE, "false": FALSE, "null": NULL, "this": Term("name", "this")}[node.type]

    read_false = read_null = read_this = read_true

    def read_sizeof_expression(self, node: Any, depth: int) -> Term:
        return Term("op", self.join_tokens(node))


def _list_children(node: Any) -> list[Any]:
    return [child for child in node.named_children if child.type != "comment"]


def _is_fractional(value: Term) -> bool:
    return value.kind == "real" or (value.kind in ("+", "-", "*", "op") and any(map(_is_fractional, value.parts)))


_LONGEST_HEX = 40
_READ = collect_methods(_Reader, "read_")
