"""What C++ functions declare: variables and what they begin with, parameters, and lambdas as functions of their own."""

from bisect import bisect_right
from typing import Any

from tree_sitter import Node

from ..flow import Assignment, FlowCall, FlowExpr, FlowFunction, FlowParameter
from .flow_grammar import (
    DECLARATORS,
    DECLARED_TYPES,
    KIND,
    NAMES,
    PARAMETERS,
    TYPES,
    find_node_readers,
    get_items,
    list_children,
)
from .flow_values import PASS, READ, VALUES, FunctionReader, flatten, strip_template


class Declarations(FunctionReader):
    """The reader of declarations inside functions."""

    def find_written_type(self, children: list[Node]) -> str:
        """The type that a declaration begins with, without its declarators."""
        pieces: list[str] = []
        typed = False
        for child in children:
            number = child.kind_id
            if number == KIND.type_qualifier:
                pieces.append(self.text[child.start_byte : child.end_byte])
            elif number in DECLARED_TYPES:
                name = child.child_by_field_name("name")
                pieces.append(self.spell_node(name) if name is not None else "")
                typed = True
            elif number in TYPES and not typed:
                pieces.append(self.spell_node(child))
                typed = True
            elif typed:
                break
        return " ".join(pieces) if len(pieces) > 1 else pieces[0] if pieces else ""

    def split_declarator(self, node: Node) -> tuple[Node | None, str]:
        """The name inside a declarator and the marks `*`, `&`, `&&` around it."""
        marks = ""
        for _ in range(64):
            number = node.kind_id
            if number in NAMES or number == KIND.structured_binding_declarator:
                return node, marks
            if number in (KIND.pointer_declarator, KIND.reference_declarator):
                mark = node.children[0]
                marks += self.text[mark.start_byte : mark.end_byte]
            for child in node.children:
                if child.kind_id in DECLARATORS:
                    node = child
                    break
            else:
                return None, marks
        return None, marks

    def evaluate_declaration(self, node: Node, guard: int, position: str, target: str) -> FlowExpr:
        """Local variables."""
        children = node.children
        kind_ = ""
        value = FlowExpr("other")
        typed = False
        for index, child in enumerate(children):
            number = child.kind_id
            if number == KIND.init_declarator:
                if not typed:
                    kind_, typed = self.find_written_type(children), True
                value = self.visit_initialization(child, guard, kind_)
            elif number in DECLARATORS and (
                number not in NAMES or typed or node.field_name_for_child(index) == "declarator"
            ):
                if not typed:
                    kind_, typed = self.find_written_type(children), True
                if number == KIND.function_declarator:
                    self.visit_construction(child, guard, kind_)
                    continue
                if number == KIND.reference_declarator and self.visit_and_call(child, guard, kind_):
                    continue
                given = children[index + 1] if index + 1 < len(children) else None
                if given is not None and given.kind_id == KIND.equals_sign and index + 2 < len(children):
                    # `if (auto x = f())` has no init_declarator.
                    value = self.keep_value(child, children[index + 2], guard, kind_)
                    break
                name, marks = self.split_declarator(child)
                if name is None:
                    continue
                empty = FlowExpr("text") if kind_.endswith("stringstream") else FlowExpr("make", kind_ + marks)
                self.assign(name, empty, guard, kind_ + marks)
            elif number in DECLARED_TYPES:
                self.add_local_type(child)
        return value

    def add_local_type(self, node: Node) -> None:
        """A class inside a function; who reads files says what is done with it."""

    def visit_initialization(self, node: Node, guard: int, kind_: str) -> FlowExpr:
        children = list_children(node)
        if len(children) == 3:
            return self.keep_value(children[0], children[2], guard, kind_)
        if len(children) != 2:
            return self.visit_anything(node, guard, READ, "")
        name, marks = self.split_declarator(children[0])
        given = children[1]
        if name is None or given.kind_id not in (KIND.argument_list, KIND.initializer_list):
            return self.visit_anything(node, guard, READ, "")
        if kind_.endswith("auto") or marks:
            inner = get_items(given)
            if len(inner) == 1:
                return self.keep_value(children[0], inner[0], guard, kind_)
        value = FlowExpr("make", kind_, self.visit_arguments(given, guard, PASS if strip_template(kind_) else READ))
        return self.assign(name, value, guard, kind_ + marks)

    def assign(self, name: Node, value: FlowExpr, guard: int, type_: str) -> FlowExpr:
        """Notes a variable that is declared here, with the value that it begins with."""
        variable = self.text[name.start_byte : name.end_byte]
        self.known.add(variable)
        self.assignments.append(Assignment(variable, value, self.find_line(name), guard, type_))
        return value

    def keep_value(self, declarator: Node, given: Node, guard: int, kind_: str) -> FlowExpr:
        """`T x = given`."""
        if declarator.kind_id == KIND.identifier:
            name, marks = declarator, ""
        else:
            name, marks = self.split_declarator(declarator)
            if name is None:
                return self.follow(given, guard, READ)
        if name.kind_id == KIND.structured_binding_declarator:
            value = self.follow(given, guard, READ)
            line = self.find_line(name)
            variables = [child for child in name.children if child.kind_id == KIND.identifier]
            for index, child in enumerate(variables):
                variable = self.text[child.start_byte : child.end_byte]
                self.known.add(variable)
                part = FlowExpr("index", "", (value, FlowExpr("number", str(index))))
                self.assignments.append(Assignment(variable, part, line, guard, kind_ + marks))
            return value
        variable = self.text[name.start_byte : name.end_byte]
        return self.assign(name, self.follow(given, guard, READ, variable), guard, kind_ + marks)

    def visit_construction(self, node: Node, guard: int, kind_: str) -> None:
        """`T x(a, f());` in a function, which the grammar takes for a function's declaration."""
        children = list_children(node)
        name, marks = self.split_declarator(children[0])
        listed = next((child for child in children if child.kind_id == KIND.parameter_list), None)
        if name is None or listed is None:
            return
        types = get_items(listed)
        if not types or kind_ == "void":
            return
        parts = self.follow_mistaken_parameters(types, guard)
        if parts is not None:
            self.assign(name, FlowExpr("make", kind_, parts), guard, kind_ + marks)

    def visit_and_call(self, node: Node, guard: int, asked: str) -> bool:
        """`a && g(b);`, which the grammar takes for the declaration of a function that gives an `a &&`."""
        children = list_children(node)
        if len(children) != 2 or children[0].type != "&&" or children[1].kind_id != KIND.function_declarator:
            return False
        name, listed = children[1].children[0], children[1].children[-1]
        if listed.kind_id != KIND.parameter_list:
            return False
        line, column = self.locate(name.start_byte)
        inner = self.guard("if", asked, line, guard)
        callee = strip_template(self.text[name.start_byte : name.end_byte])
        parts = self.follow_mistaken_parameters(get_items(listed), inner)
        if parts is not None:
            self.calls.append(FlowCall(callee, parts, line, column, inner))
        return True

    def follow_mistaken_parameters(self, nodes: list[Node], guard: int) -> tuple[FlowExpr, ...] | None:
        """Arguments that the grammar took for the types of parameters; None when one of them is a parameter."""
        parts: list[FlowExpr] = []
        for node in nodes:
            part = self.visit_mistaken_argument(node, guard)
            if part is None:
                return None
            parts.append(part)
        return tuple(parts)

    def visit_mistaken_argument(self, node: Node, guard: int) -> FlowExpr | None:
        """An argument that the grammar took for a parameter's type; None when it is a parameter."""
        children = list_children(node)
        if node.kind_id != KIND.parameter_declaration or not children or children[0].kind_id not in TYPES:
            return None
        name = strip_template(self.text[children[0].start_byte : children[0].end_byte])
        if len(children) == 1:
            if name in self.known:
                self.touch(name, PASS)
            return FlowExpr("name", name)
        if len(children) == 2 and children[1].kind_id == KIND.abstract_array_declarator:
            inner = get_items(children[1])
            if len(inner) != 1 or children[0].kind_id not in (KIND.type_identifier, KIND.qualified_identifier):
                return None
            if name in self.known:
                self.touch(f"{name}.[]", PASS)
            return FlowExpr("index", "", (FlowExpr("name", name), self.follow(inner[0], guard)))
        if len(children) == 2 and children[1].kind_id == KIND.abstract_function_declarator:
            listed = next((child for child in children[1].children if child.kind_id == KIND.parameter_list), None)
            parts = self.follow_mistaken_parameters(get_items(listed) if listed is not None else [], guard)
            if parts is None:
                return None
            line, column = self.locate(children[0].start_byte)
            self.calls.append(FlowCall(name, parts, line, column, guard))
            return FlowExpr("call", name, parts)
        return None

    def add_parameters(self, listed: Node | None, guard: int = -1) -> tuple[FlowParameter, ...]:
        """The parameters of a function; their names are known from here on."""
        result: list[FlowParameter] = []
        if listed is None:
            return ()
        for child in listed.children:
            number = child.kind_id
            if number not in PARAMETERS:
                continue
            children = child.children
            default: FlowExpr | None = None
            end = child.end_byte
            name: Node | None = None
            typed = False
            for index, part in enumerate(children):
                kind_ = part.kind_id
                if kind_ == KIND.equals_sign:
                    end = part.start_byte
                    if index + 1 < len(children):
                        default = self.follow(children[index + 1], guard)
                    break
                if typed:
                    if kind_ in DECLARATORS:
                        name, _ = self.split_declarator(part)
                elif kind_ in TYPES or kind_ in DECLARED_TYPES:
                    typed = True
            start = child.start_byte
            if name is None:
                if child.child_count == 1 and self.text[start:end] == "void":
                    continue
                result.append(FlowParameter("", flatten(self.text[start:end]), default))
                continue
            said = self.text[name.start_byte : name.end_byte]
            self.known.add(said)
            written = self.text[start : name.start_byte] + " " + self.text[name.end_byte : end]
            result.append(FlowParameter(said, flatten(written), default))
        return tuple(result)

    def evaluate_lambda_expression(self, node: Node, guard: int, position: str, target: str) -> FlowExpr:
        """A lambda becomes a Function; what it is called is its Expr."""
        line, column = self.locate(node.start_byte)
        name = f"{self.name}::lambda@{line}:{column}" if self.name else f"lambda@{line}:{column}"
        if self.name == "" and self.owner:
            name = f"{self.owner}::{name}"
        inits: list[tuple[str, FlowExpr]] = []
        captures, body = node.child_by_field_name("captures"), node.child_by_field_name("body")
        for capture in captures.children if captures is not None else ():
            if capture.kind_id == KIND.lambda_capture_initializer:
                parts = list_children(capture)
                said = self.text[parts[0].start_byte : parts[0].end_byte].lstrip("&")
                inits.append((said, self.follow(parts[-1], guard, READ)))
        listed: Node | None = None
        returns = ""
        declarator = node.child_by_field_name("declarator")
        for part in declarator.children if declarator is not None else ():
            if part.kind_id == KIND.parameter_list:
                listed = part
            elif part.kind_id == KIND.trailing_return_type:
                returns = self.spell_node(part).removeprefix("->").strip()
        state = self.get_state()
        self.begin(set(self.known))
        self.name = name
        parameters = self.add_parameters(listed)
        for said, value in inits:
            self.known.add(said)
            self.assignments.append(Assignment(said, value, line, -1, "auto"))
        if body is not None:
            self.visit_statement(body, -1)
        self.close(parameters, line, bisect_right(self.starts, max(0, node.end_byte - 1)), returns)
        self.restore(state)
        return FlowExpr("lambda", name)

    def close(
        self, parameters: tuple[FlowParameter, ...], line: int, end: int, returns: str = ""
    ) -> None:
        """Notes the function it is in."""
        self.functions.append(
            FlowFunction(
                self.name, self.owner, parameters, line, end, tuple(self.guards), tuple(self.calls),
                tuple(self.assignments), tuple(dict.fromkeys(self.accesses)), returns, types=self.types,
            )
        )  # fmt: skip

    def visit_statement(self, node: Node, guard: int) -> Any:
        """A statement of a function; given by who knows statements."""
        raise NotImplementedError


VALUES.update(find_node_readers(Declarations, "evaluate_"))
