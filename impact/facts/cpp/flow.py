"""C++ sources to facts of message flow: what their classes, functions and variables are, what is called and when.

One file is read by itself, with tree-sitter: no headers, no build. Two functions stand for what is outside of all:
one without name and owner for the file, and one without a name for each class whose members are initialised by calls.
`T(x)` might call a function or make an object; it is told as a `call`. A member that is initialised by one argument is
assigned that argument, by more a `make` without a type; base classes are initialised the same way (`this.Node`).
What follows a try whose handler jumps is under `unless` with the text `catch (...)`.
"""

from __future__ import annotations

import re
from bisect import bisect_right

from tree_sitter import Node

from ..flow import Alias, Assignment, DataMember, FlowClass, FlowExpr, FlowFile
from ..place import Problem
from .flow_clean import Cleaned
from .flow_grammar import (
    DECLARATORS,
    DECLARED_TYPES,
    KIND,
    NAMES,
    TYPES,
    find_node_readers,
    list_children,
)
from .flow_macros import expand_macros
from .flow_statements import STATEMENTS, STAYS, CppStatements
from .flow_values import OPERATOR, PASS, READ, flatten, strip_template
from .lexical import EXPORTING, find_at_line_starts, list_exports, scan
from .names import join_scope
from .parse import parse_source

INCLUDED = re.compile(r"#[ \t]*include[ \t]*[<\"]([\w./+-]+)[>\"]")


def extract(data: bytes) -> FlowFile:
    """The flow of one C or C++ file. Never raises; what did not parse is in `unread`, what went wrong in `problems`."""
    data = expand_macros(data)
    readers: dict[bytes, _File] = {}

    def is_misread(source: Cleaned, root: Node) -> bool:
        reader = readers[source.source] = read(source, root)
        return reader.misread

    source, root, wrong = parse_source(data, is_misread)
    reader = readers.get(source.source) or read(source, root)
    reader.leave_outside()
    exports: tuple[str, ...] = ()
    if any(word in source.text for word in EXPORTING):
        exports = list_exports(scan(data).visible)
    included = (match.group(1) for match in find_at_line_starts(INCLUDED, source.text))
    return FlowFile(
        "cpp", tuple(reader.aliases), tuple(reader.classes), tuple(reader.functions), tuple(reader.constants), exports,
        tuple(sorted(wrong.union(source.hidden))), tuple(reader.problems), tuple(dict.fromkeys(included)),
        tuple(reader.defaults),
    )  # fmt: skip


def read(source: Cleaned, root: Node) -> _File:
    """A source as parsed, read."""
    reader = _File(source)
    try:
        reader.visit_scope(root.children, "", "", ())
    except RecursionError:
        reader.problems.append(Problem(1, "nested too deeply to be read in full"))
    return reader


class _File(CppStatements):
    """The reader of a whole file."""

    def __init__(self, source) -> None:
        super().__init__(source)
        self.aliases: list[Alias] = []
        self.classes: list[FlowClass] = []
        self.constants: list[DataMember] = []
        self.defaults: list[tuple[str, tuple[FlowExpr | None, ...]]] = []
        # Of the class that is read.
        self.members: list[DataMember] = []
        self.problems: list[Problem] = []
        self.namespaces: set[str] = set()
        self.misread = False
        self.outside = {"": self.get_state()}

    def go_outside(self, owner: str) -> None:
        """Into the function that stands for what is outside of functions, of the file or of a class."""
        if owner not in self.outside:
            self.name, self.owner = "", owner
            self.begin(set())
            self.outside[owner] = self.get_state()
        self.restore(self.outside[owner])

    def leave_outside(self) -> None:
        for state in self.outside.values():
            self.restore(state)
            if self.calls:
                line = min(call.line for call in self.calls)
                self.close((), line, max(call.line for call in self.calls))

    def visit_scope(self, children: list[Node], name: str, owner: str, conditions: tuple[tuple[str, int], ...]) -> None:
        """What stands in a file, namespace or class. name: the scopes so far; owner: the class, empty for none."""
        for child in children:
            read = SCOPED.get(child.kind_id)
            if read is not None:
                read(self, child, name, owner, conditions)

    def enter_namespace_definition(self, node: Node, name: str, owner: str, conditions) -> None:
        said = node.child_by_field_name("name")
        body = node.child_by_field_name("body")
        if body is None:
            return
        inner = name
        if said is not None:
            inner = join_scope(name, "".join(self.spell_node(said).replace("inline", "").split()))
            self.namespaces.add(inner)
        self.visit_scope(body.children, inner, "", conditions)

    def enter_linkage_specification(self, node: Node, name: str, owner: str, conditions) -> None:
        self.visit_scope(node.children, name, owner, conditions)

    enter_declaration_list = enter_template_instantiation = enter_friend_declaration = enter_linkage_specification

    def enter_template_declaration(self, node: Node, name: str, owner: str, conditions) -> None:
        before, parameters = self.types, node.child_by_field_name("parameters")
        self.types = tuple(map(self.find_type_parameter, parameters.named_children)) if parameters is not None else ()
        self.visit_scope(node.children, name, owner, conditions)
        self.types = before

    def find_type_parameter(self, node: Node) -> str:
        """The name of a template's parameter that is a type, empty for others."""
        if "type_parameter" not in node.type:
            return ""
        named = node.child_by_field_name("name") or next(
            (child for child in node.named_children if child.type == "type_identifier"), None
        )
        return self.spell_node(named) if named is not None else ""

    def enter_ERROR(self, node: Node, name: str, owner: str, conditions) -> None:
        """What did not parse: whatever is a whole piece in it is read."""
        for child in node.children:
            read = SCOPED.get(child.kind_id)
            if read is not None:
                read(self, child, name, owner, conditions)
            elif child.child_count:
                self.go_outside(owner)
                self.visit_statement(child, -1)

    def enter_preproc_if(self, node: Node, name: str, owner: str, conditions) -> None:
        branches = list(self.list_branches(node))
        asked, statements, line = branches[0]
        if not branches[1:] and not owner and asked.startswith("!(defined(") and is_include_guard(node, statements):
            self.visit_scope(statements, name, owner, conditions)
            return
        for asked, statements, _ in branches:
            self.visit_scope(statements, name, owner, (*conditions, (asked, line)) if asked else conditions)
            conditions = (*conditions, (f"!({asked})", line))

    enter_preproc_ifdef = enter_preproc_if

    def enter_alias_declaration(self, node: Node, name: str, owner: str, conditions) -> None:
        said = node.child_by_field_name("name")
        target = node.child_by_field_name("type")
        if said is not None and target is not None:
            self.aliases.append(Alias(self.spell_node(said), self.spell_node(target), name))

    def enter_type_definition(self, node: Node, name: str, owner: str, conditions) -> None:
        children = list_children(node)
        target = self.find_written_type(children)
        for child in children:
            if child.kind_id in DECLARED_TYPES:
                self.enter_class_specifier(child, name, owner, conditions)
        for child in node.children_by_field_name("declarator"):
            said, marks = self.split_declarator(child)
            if said is not None:
                self.aliases.append(Alias(self.spell_node(said), target + marks, name))

    def enter_using_declaration(self, node: Node, name: str, owner: str, conditions) -> None:
        children = list_children(node)
        target = next((child for child in children if child.kind_id in NAMES), None)
        if target is None:
            return
        said = strip_template(self.spell_node(target))
        if any(self.text[child.start_byte : child.end_byte] == "namespace" for child in children[:2]):
            self.aliases.append(Alias("*", said, name))
        elif not owner or said.split("::")[-2:-1] != said.split("::")[-1:]:
            # `using Base::Base` in a class takes over constructors, and gives nothing a name.
            self.aliases.append(Alias(said.rpartition("::")[2], said, name))

    def enter_namespace_alias_definition(self, node: Node, name: str, owner: str, conditions) -> None:
        children = list_children(node)
        if len(children) >= 4:
            self.aliases.append(Alias(self.spell_node(children[1]), strip_template(self.spell_node(children[3])), name))

    def enter_preproc_def(self, node: Node, name: str, owner: str, conditions) -> None:
        children = node.children
        if len(children) < 3:
            return
        said, written = children[1], children[2]
        text = flatten(self.text[written.start_byte : written.end_byte])
        value: FlowExpr | None = None
        if text[:1] == '"' and text[-1:] == '"' and len(text) > 1 and '"' not in text[1:-1]:
            value = FlowExpr("text", text[1:-1])
        elif text in ("true", "false") or (text.strip("()") and _is_number(text.strip("()"))):
            value = FlowExpr("number", text.strip("()"))
        if value is not None:
            self.constants.append(DataMember(self.spell_node(said), "", self.find_line(node), value))

    def enter_declaration(self, node: Node, name: str, owner: str, conditions) -> None:
        """A declaration outside of functions: variables; what declares functions tells only their names."""
        self.go_outside(owner)
        base = self.add_guards(conditions)
        children = node.children
        type_ = ""
        for child in children:
            if child.kind_id in DECLARED_TYPES:
                self.enter_class_specifier(child, name, owner, conditions)
        typed = False
        for index, child in enumerate(children):
            number = child.kind_id
            if number not in DECLARATORS or (number in NAMES and node.field_name_for_child(index) != "declarator"):
                continue
            if not typed:
                type_, typed = self.find_written_type(children), True
            self.go_outside(owner)
            self.add_variable(node, child, index, type_, name, owner, base)

    enter_field_declaration = enter_declaration

    def add_variable(self, node: Node, child: Node, index: int, type_: str, name: str, owner: str, base: int) -> None:
        function = self.find_function_declarator(child)
        if function is not None:
            self.add_defaults(function, name)
            return
        said, marks = self.split_declarator(child)
        if said is None:
            return
        if child.kind_id == KIND.parenthesized_declarator and node.children[-1].is_missing:
            return
        variable = strip_template(self.spell_node(said))
        target = f"this.{variable}" if owner else join_scope(name, variable)
        value: FlowExpr | None = None
        children = node.children
        given: Node | None = None
        if child.kind_id == KIND.init_declarator:
            given = child.children[-1]
        elif index + 1 < len(children):
            beside = children[index + 1]
            if beside.kind_id == KIND.equals_sign and index + 2 < len(children):
                given = children[index + 2]
            elif beside.kind_id == KIND.initializer_list:
                given = beside
        if given is not None:
            before = given.prev_sibling
            direct = given.kind_id == KIND.argument_list or (
                given.kind_id == KIND.initializer_list and before is not None and before.kind_id != KIND.equals_sign
            )
            if direct:
                value = self.visit_initializer(given, type_, base, READ, target)
            else:
                value = self.follow(given, base, READ, target)
        shared = bool(owner) and any(one.text == b"static" for one in children[:index])
        member = DataMember(variable if owner else target, type_ + marks, self.find_line(said), value, shared)
        (self.members if owner else self.constants).append(member)

    def find_function_declarator(self, node: Node) -> Node | None:
        """The declarator of a function, rather than of a pointer to one, that a declarator is or holds."""
        for _ in range(64):
            number = node.kind_id
            if number == KIND.function_declarator:
                return node if node.children[0].kind_id in NAMES else None
            if number == KIND.operator_cast:
                return node
            if number not in (KIND.pointer_declarator, KIND.reference_declarator, KIND.init_declarator):
                return None
            inner = next((child for child in node.children if child.kind_id in DECLARATORS), None)
            if inner is None:
                return None
            node = inner
        return None

    def add_defaults(self, node: Node, name: str) -> None:
        """The defaults of a function's parameters, where it has any."""
        listed = next((child for child in node.children if child.kind_id == KIND.parameter_list), None)
        if listed is not None and any(one.kind_id == KIND.optional_parameter_declaration for one in listed.children):
            defaults = tuple(parameter.default for parameter in self.add_parameters(listed))
            self.defaults.append((join_scope(name, self.spell_node(node.children[0])), defaults))

    def add_guards(self, conditions) -> int:
        """The guards of the preprocessor around what stands outside of functions."""
        guard = -1
        for text, line in conditions:
            guard = self.guard("cpp", text, line, guard)
        return guard

    def enter_class_specifier(self, node: Node, name: str, owner: str, conditions) -> None:
        """A class; also one in a function, whose name is then its scope."""
        body = node.child_by_field_name("body")
        if body is not None and node.kind_id == KIND.enum_specifier:
            self.add_enumerators(node, body, name, owner)
        if body is None or node.kind_id == KIND.enum_specifier:
            return
        said = node.child_by_field_name("name")
        inner = join_scope(name, strip_template(self.spell_node(said))) if said is not None else name
        bases: list[str] = []
        for child in node.children:
            if child.kind_id == KIND.base_class_clause:
                bases = [self.spell_node(part) for part in child.children if part.kind_id in TYPES]
        before, members, types = self.get_state(), self.members, self.types
        self.members, self.types = [], ()
        self.visit_scope(body.children, inner, inner, conditions)
        self.restore(before)
        lines = self.find_line(node), self.find_end_line(node)
        self.classes.append(FlowClass(inner, tuple(bases), tuple(self.members), *lines, types))
        self.members, self.types = members, types

    enter_struct_specifier = enter_union_specifier = enter_enum_specifier = enter_class_specifier

    def add_enumerators(self, node: Node, body: Node, name: str, owner: str) -> None:
        """The enumerators of an enumeration without a scope of its own, as far as their numbers are known."""
        if node.children[1].type in ("class", "struct"):
            return
        number: int | None = 0
        for child in body.children:
            said, given = child.child_by_field_name("name"), child.child_by_field_name("value")
            if said is None:
                continue
            if given is not None:
                text = self.text[given.start_byte : given.end_byte]
                number = int(text) if text.isdecimal() and len(text) < 10 else None
            if number is not None:
                spelt, value = self.spell_node(said), FlowExpr("number", str(number))
                member = DataMember(spelt if owner else join_scope(name, spelt), "", self.find_line(said), value)
                (self.members if owner else self.constants).append(member)
                number += 1

    def add_local_type(self, node: Node) -> None:
        self.enter_class_specifier(node, self.name or self.owner, "", ())

    def read_alias_declaration(self, node: Node, guard: int) -> int:
        """Another name for something inside a function."""
        SCOPED[node.kind_id](self, node, self.name, "", ())
        return STAYS

    read_type_definition = read_using_declaration = read_namespace_alias_definition = read_alias_declaration

    def find_end_line(self, node: Node) -> int:
        return bisect_right(self.starts, node.end_byte)

    def enter_function_definition(self, node: Node, name: str, owner: str, conditions) -> None:
        """A function with its body."""
        declarator: Node | None = None
        body: Node | None = None
        initializers: Node | None = None
        marks = ""
        children = node.children
        for index, child in enumerate(children):
            number = child.kind_id
            if number in (KIND.compound_statement, KIND.try_statement):
                body = child
            elif number == KIND.field_initializer_list:
                initializers = child
            elif number in DECLARATORS and (number not in NAMES or node.field_name_for_child(index) == "declarator"):
                declarator = child
            elif number in DECLARED_TYPES and child.child_by_field_name("body") is not None:
                self.enter_class_specifier(child, name, owner, conditions)
        while declarator is not None and declarator.kind_id in (KIND.pointer_declarator, KIND.reference_declarator):
            mark = declarator.children[0]
            marks += self.text[mark.start_byte : mark.end_byte]
            declarator = next((part for part in declarator.children if part.kind_id in DECLARATORS), None)
        if declarator is None or (declarator.kind_id == KIND.identifier and children[0].kind_id in DECLARED_TYPES):
            # `class MACRO Name { ... }` is taken for a function that gives a `class MACRO`.
            self.misread = True
            self.go_outside(owner)
            for child in children:
                if child.kind_id == KIND.compound_statement:
                    self.visit_statement(child, -1)
            return
        returns = ""
        listed: Node | None = None
        if declarator.kind_id == KIND.function_declarator:
            said = strip_template(self.spell_node(declarator.children[0]))
            for child in declarator.children:
                number = child.kind_id
                if number == KIND.parameter_list and listed is None:
                    listed = child
                elif number == KIND.trailing_return_type:
                    returns = self.spell_node(child).removeprefix("->").strip()
        else:
            said = self.spell_node(declarator)
            if declarator.kind_id == KIND.operator_cast or OPERATOR.search(said):
                said = said.partition("(")[0].strip()
            else:
                said = strip_template(said)
        if not returns:
            returns = self.find_written_type(children) + marks
        said = said.removeprefix("::")
        if owner:
            belongs = owner
        else:
            operator = OPERATOR.search(said)
            belongs = said[: operator.start()].rstrip(":") if operator is not None else said.rpartition("::")[0]
            belongs = join_scope(name, belongs) if belongs else ""
            if belongs in self.namespaces:
                belongs = ""
        if body is None and initializers is None:
            return
        self.name, self.owner = join_scope(name, said), belongs
        self.begin(set())
        guard = self.add_guards(conditions)
        line = self.find_line(node)
        parameters = self.add_parameters(listed, guard)
        state = self.get_state()
        try:
            if initializers is not None:
                self.visit_initializers(initializers, guard)
            if body is not None:
                self.visit_statement(body, guard)
        except RecursionError:
            self.problems.append(Problem(line, "nested too deeply to be read in full"))
            self.nesting = 0
            self.restore(state)
        self.close(parameters, line, self.find_end_line(node), returns)

    def visit_initializers(self, node: Node, guard: int) -> None:
        """The list of initialisers of a constructor: assignments to members, and to base classes by their names."""
        for child in node.children:
            if child.kind_id != KIND.field_initializer:
                continue
            parts = list_children(child)
            target = f"this.{strip_template(self.spell_node(parts[0]))}"
            value = self.visit_initializer(parts[-1], "", guard, PASS, target)
            self.assignments.append(Assignment(target, value, self.find_line(child), guard))

    def enter_expression_statement(self, node: Node, name: str, owner: str, conditions) -> None:
        """Macros and other statements outside of functions."""
        self.go_outside(owner)
        self.visit_statement(node, self.add_guards(conditions))


def _is_number(text: str) -> bool:
    try:
        float(text.rstrip("uUlLfF"))
    except ValueError:
        return text[:2] in ("0x", "0X") and text[2:].rstrip("uUlL").isalnum()
    return True


def is_include_guard(node: Node, statements: list[Node]) -> bool:
    """Whether an #ifndef is the guard of a header: it defines at once what it asks for."""
    if not statements or statements[0].kind_id != KIND.preproc_def:
        return False
    asked, defined = node.children[1], statements[0].children[1]
    return asked.text == defined.text


SCOPED = find_node_readers(_File, "enter_")
STATEMENTS.update(find_node_readers(_File, "read_"))
