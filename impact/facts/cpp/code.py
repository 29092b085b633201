"""A closer look at one C++ file, by its syntax: what it declares, and what stands at certain places.

The file is parsed when the first question comes, and only as much of it is walked as the question needs. What a name
means inside a function is found here; all that crosses files is the resolver's.
"""

import re
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from functools import cached_property

from tree_sitter import Node

from ....edges.memory import cache_method
from .flow_clean import has_lone_macro
from .flow_grammar import (
    DECLARED_TYPES,
    KIND,
    LISTS,
    NAMES,
    PARAMETERS,
    TYPES,
    get_items,
    get_kind,
    get_kinds,
)
from .lexical import Scan, scan
from .names import join_scope, strip_templates
from .parse import parse_source
from .schema import (
    CodePlace,
    CodeSpot,
    CppClass,
    CppUse,
    Declaration,
    Expr,
    FileDeclarations,
    Local,
    WrittenParameter,
)

_LEAVES = get_kinds("identifier", "field_identifier", "type_identifier", "namespace_identifier")
_TEMPLATES = get_kinds("template_function", "template_method", "template_type")
_CLASSES = get_kinds("class_specifier", "struct_specifier", "union_specifier")
_PREPROCESSOR = get_kinds("preproc_if", "preproc_ifdef", "preproc_else", "preproc_elif", "preproc_elifdef")
_DEFINES = get_kinds("preproc_def", "preproc_function_def")
_TRAIT_NODES = get_kinds("virtual_specifier", "type_qualifier", "storage_class_specifier") | {
    get_kind("virtual", False)
}
# Expressions without parts: kind and text.
_PLAIN = {
    KIND.this: ("this", "this"),
    KIND.lambda_expression: ("lambda", ""),
    KIND.parameter_pack_expansion: ("pack", ""),
    **dict.fromkeys(get_kinds("string_literal", "raw_string_literal", "concatenated_string"), ("literal", "text")),
    **dict.fromkeys(get_kinds("true", "false"), ("literal", "bool")),
    KIND.null: ("literal", "null"),
}
_TYPE_PARAMETERS = get_kinds(
    "type_parameter_declaration", "variadic_type_parameter_declaration", "optional_type_parameter_declaration",
    "template_template_parameter_declaration",
)  # fmt: skip
_BLOCKS = get_kinds("compound_statement", "case_statement", "translation_unit", "declaration_list")
_BODIES = get_kinds("compound_statement", "lambda_expression", "field_initializer_list")
_NAMED = get_kinds("alias_declaration", "namespace_definition", "namespace_alias_definition")
_TYPED = get_kinds("type_definition", "declaration", "field_declaration", "for_range_loop")
_STATEMENTS_WITH_HEAD = get_kinds("if_statement", "while_statement", "switch_statement")
_NAMES = NAMES - get_kinds("template_method", "namespace_identifier")
_WRAPPED = get_kinds("parenthesized_declarator", "array_declarator", "attributed_declarator", "variadic_declarator")
_MARKS = {KIND.pointer_declarator: "*", KIND.reference_declarator: "&"}
_TRAITS = frozenset(("virtual", "override", "final", "const", "static", "friend"))
_DIRECTIVE = re.compile(r"^[ \t]*#", re.M)
_DECLARED_END = re.compile(r"[;{]|\Z")
_DEEPEST = 60


class CppCode:
    """One file. data: its bytes."""

    def __init__(self, data: bytes):
        self._data = data

    @cached_property
    def _parsed(self) -> tuple[str, str, Node]:
        """The text, what was parsed, and its tree."""
        source, root, _ = parse_source(self._data)
        return source.text, source.source.decode(), root

    @property
    def _text(self) -> str:
        return self._parsed[1]

    def _read(self, node: Node) -> str:
        """The text of a node."""
        return " ".join(self._text[node.start_byte : node.end_byte].split())

    def _find_path(self, offset: int) -> list[Node]:
        """The nodes around an offset, the outermost first; the last is a leaf."""
        cursor = self._parsed[2].walk()
        path: list[Node] = []
        node = cursor.node
        while node is not None and node.start_byte <= offset:
            path.append(node)
            node = cursor.node if cursor.goto_first_child_for_byte(offset) is not None else None
        return path

    @cached_property
    def _scanned(self) -> Scan:
        return scan(self._data)

    def _find_spot(self, offset: int) -> CodeSpot:
        return CodeSpot(*self._scanned.locate(offset), self._scanned.find_conditions(offset))

    def _is_split(self, at: int) -> bool:
        """Whether a directive stands in the declaration at an offset."""
        return self._has_directive(at, next(_DECLARED_END.finditer(self._parsed[0], at)).start())

    def _has_directive(self, begin: int, end: int) -> bool:
        return _DIRECTIVE.search(self._parsed[0], begin, end) is not None

    @cached_property
    def declarations(self) -> FileDeclarations:
        """What the file declares outside of functions."""
        return _Declarations(self).read(self._parsed[2])

    def list_uses(self, places: Iterable[tuple[str, int]]) -> Iterator[CppUse]:
        """What stands at places of the file. places: words with their offsets; of `operator+=` and its like, that of
        the operator. Where a word is declared, or is none of the code, there is no use."""
        for word, at in places:
            path = self._find_path(at)
            leaf = path[-1]
            if word.startswith("operator"):
                use = self._find_assigned(word, at, path)
            elif leaf.kind_id in _LEAVES and leaf.start_byte == at and leaf.end_byte == at + len(word):
                use = self._use(word, at, path)
            else:
                use = None
            if use is not None and use.at.conditions is not None:
                yield use

    def _find_assigned(self, word: str, at: int, path: list[Node]) -> CppUse | None:
        node = path[-2] if len(path) > 1 else path[-1]
        if path[-1].start_byte != at or node.kind_id != KIND.assignment_expression:
            return None
        left = node.child_by_field_name("left")
        if left is None:
            return None
        object_ = self._make_expr(left, path[:-1])
        return CppUse(word, self._find_spot(at), "assigned", word, self._find_place(path), object_)

    def _use(self, word: str, at: int, path: list[Node]) -> CppUse | None:
        spot, level = self._find_spot(at), len(path) - 1
        node = path[level]
        template = None
        last = True
        first = node
        while level:
            parent = path[level - 1]
            number = parent.kind_id
            if number in _TEMPLATES:
                if parent.child_by_field_name("name") != node:
                    break
                if node.end_byte == at + len(word):
                    template = self._list_template_arguments(parent)
            elif number == KIND.qualified_identifier:
                scope = parent.child_by_field_name("scope")
                if scope is not None and scope.start_byte <= at < scope.end_byte:
                    last = False
            elif number != KIND.dependent_name:
                break
            level -= 1
            node = path[level]
            first = node
        if path[-1].kind_id == KIND.namespace_identifier and last:
            return None
        written = strip_templates(self._text[first.start_byte : at + len(word)]).removeprefix("::")
        parent = path[level - 1] if level else node
        number = parent.kind_id
        outer = path[:level]
        form = "scoped" if "::" in written else "bare"
        if not last:
            return CppUse(word, spot, form, written, self._find_place(path), template=template, last=False)
        if number == KIND.field_expression:
            object_ = parent.child_by_field_name("argument")
            if object_ is None or object_ == node:
                return self._make_use(word, at, spot, form, written, template, None, False, path, outer)
            call = self._find_args(path, level - 1)
            operator = parent.child_by_field_name("operator")
            arrow = operator is not None and operator.end_byte - operator.start_byte == 2
            if "::" in written:
                return None
            return CppUse(word, spot, "member", written, self._find_place(path), self._make_expr(object_, outer), arrow,
                       call, template=template)  # fmt: skip
        if number == KIND.field_initializer:
            listed = parent.named_children[-1]
            braced = listed.kind_id == KIND.initializer_list
            return CppUse(word, spot, "initializer", written, self._find_place(path), template=template,
                       call=self._list_arguments(listed, outer), braced=braced)  # fmt: skip
        if number == KIND.call_expression:
            call = self._find_args(path, level)
            return self._make_use(word, at, spot, form, written, template, call, False, path, outer)
        if self._is_declared(node, parent):
            return None
        made, call, braced = self._find_construction(node, parent, path, level)
        use = self._make_use(word, at, spot, form, written, template, call, made, path, outer)
        return use._replace(braced=braced)

    def _make_use(self, word, at, spot, form, written, template, call, made, path, outer) -> CppUse:
        local = self._find_local(word, at, outer) if form == "bare" else None
        return CppUse(word, spot, form, written, self._find_place(path), None, False, call, made, template, local)

    def _find_args(self, path: Sequence[Node], level: int) -> tuple[Expr, ...] | None:
        """The arguments where the node at a level is what a call calls."""
        call = path[level - 1] if level else None
        if call is None or call.kind_id != KIND.call_expression or call.child_by_field_name("function") != path[level]:
            return None
        return self._list_arguments(call.child_by_field_name("arguments"), path[:level])

    def _list_arguments(self, node: Node | None, path: Sequence[Node]) -> tuple[Expr, ...] | None:
        if node is None or node.kind_id not in LISTS or node.has_error:
            return None
        items = get_items(node)
        starts, ends = [each.start_byte for each in items], [each.end_byte for each in items]
        # Of branches between the arguments, one was parsed, and which of them is compiled is not known.
        if any(map(self._has_directive, (node.start_byte, *ends), (*starts, node.end_byte))):
            return None
        return tuple(self._make_expr(each, path) for each in items)

    def _is_declared(self, node: Node, parent: Node) -> bool:
        """Whether a name stands where it is declared."""
        number = parent.kind_id
        if number in DECLARED_TYPES or number in _NAMED:
            return parent.child_by_field_name("name") == node
        if number in _DEFINES or parent.type == "enumerator" or number in _TYPE_PARAMETERS:
            return parent.child_by_field_name("name") == node or number in _TYPE_PARAMETERS
        if number in PARAMETERS or number in _TYPED:
            return parent.child_by_field_name("type") != node and node in parent.children_by_field_name("declarator")
        if number == KIND.init_declarator:
            return parent.child_by_field_name("declarator") == node
        return (
            number in (KIND.function_declarator, KIND.friend_declaration)
            or number in _MARKS
            or (number in _WRAPPED and parent.type != "parenthesized_declarator")
            or parent.type in ("destructor_name", "structured_binding_declarator", "labeled_statement",
                               "goto_statement", "lambda_capture_specifier", "preproc_defined", "attribute")
        )  # fmt: skip

    def _find_construction(self, node: Node, parent: Node, path: Sequence[Node], level: int):
        """Whether a name is the type of what is made, with which arguments, and whether braces are around them."""
        number = parent.kind_id
        if number in (KIND.new_expression, KIND.compound_literal_expression) and (
            parent.child_by_field_name("type") == node
        ):
            given = parent.child_by_field_name("arguments") or parent.child_by_field_name("value")
            if given is None:
                return True, (), False
            return True, self._list_arguments(given, path[:level]), given.kind_id == KIND.initializer_list
        if number == KIND.type_descriptor and level > 3 and path[level - 2].kind_id == KIND.template_argument_list:
            function = path[level - 3]
            name = function.child_by_field_name("name")
            if name is not None and self._read(name) in _MAKERS and path[level - 2].named_children[0] == parent:
                up = level - 3
                while up and path[up - 1].kind_id == KIND.qualified_identifier:
                    up -= 1
                if up and path[up - 1].kind_id == KIND.call_expression:
                    return True, self._find_args(path, up), False
        if number in (KIND.declaration, KIND.field_declaration) and parent.child_by_field_name("type") == node:
            for declarator in parent.children_by_field_name("declarator"):
                value = declarator.child_by_field_name("value") or parent.child_by_field_name("default_value")
                if value is not None:
                    inner = declarator.child_by_field_name("declarator") or declarator
                    if value.kind_id in LISTS and inner.kind_id in _LEAVES:
                        braced = value.kind_id == KIND.initializer_list
                        return True, self._list_arguments(value, path[:level]), braced
                elif declarator.kind_id == KIND.function_declarator and any(node.kind_id in _BODIES for node in path):
                    return True, self._read_as_arguments(declarator, path[:level]), False
        return False, None, False

    def _read_as_arguments(self, declarator: Node, path: Sequence[Node]) -> tuple[Expr, ...] | None:
        """The arguments of `A a(b, c)`, which look like the parameters of a function."""
        listed = declarator.child_by_field_name("parameters")
        inner = declarator.child_by_field_name("declarator")
        if listed is None or inner is None or inner.kind_id != KIND.identifier:
            return None
        found = []
        for each in get_items(listed):
            type_ = each.child_by_field_name("type") if each.kind_id == KIND.parameter_declaration else None
            if type_ is None or each.child_by_field_name("declarator") is not None or each.named_child_count != 1:
                return None
            found.append(self._make_expr(type_, path))
        return tuple(found) or None  # `A a();` declares a function

    def _find_place(self, path: Sequence[Node]) -> CodePlace:
        scope: list[str] = []
        owner, function = "", False
        opened: list[str] = []
        used: list[str] = []
        for node in path:
            number = node.kind_id
            if number == KIND.namespace_definition or number in _CLASSES:
                name = node.child_by_field_name("name")
                if name is not None:
                    scope.append(strip_templates(self._read(name)))
                if number in _CLASSES:
                    owner = "::".join(scope)
            elif number == KIND.function_definition:
                name, _, declarator, _ = self._split_declarator(node.child_by_field_name("declarator"))
                if name is not None and declarator is not None and self._read(name) in _FIXTURES:
                    listed = declarator.child_by_field_name("parameters")
                    owner = self._read(listed.named_children[0]) if listed is not None and listed.named_children else ""
                elif name is not None and name.kind_id == KIND.qualified_identifier:
                    written = strip_templates(self._read(name)).rpartition("::")[0]
                    owner = written.removeprefix("::")
            elif number in _BODIES:
                function = True
            if number == KIND.compound_statement:
                for at, name, _, how in self._list_block_names(node):
                    if how == "opened":
                        opened.append(name)
                    elif how == "used" and at < path[-1].start_byte:
                        used.append(name)
        return CodePlace("::".join(scope), owner, function, tuple(opened), tuple(used))

    def _find_local(self, name: str, at: int, path: Sequence[Node], depth: int = 0) -> Local | None:
        """What a name means at an offset, as declared in the blocks around it."""
        if depth > 8:
            return None
        for level in range(len(path) - 1, -1, -1):
            number = path[level].kind_id
            if number in _BLOCKS or number in _SCOPED:
                found = None
                for offset, other, node, how in self._list_block_names(path[level]):
                    if offset >= at:
                        break
                    if other == name and how not in ("opened", "used"):
                        found = offset, node, how
                if found is not None:
                    local = self._make_local(*found, path[: level + 1], depth)
                    return local._replace(apart=True) if local and self._has_directive(found[0], at) else local
            elif number in _CLASSES and any(node.kind_id == KIND.function_definition for node in path[level:]):
                members = path[level].child_by_field_name("body")
                if members is not None and self._is_member(members, name):
                    return None  # a member hides what is outside of the class
        return None

    def _is_member(self, body: Node, name: str) -> bool:
        text = self._text[body.start_byte : body.end_byte]
        return re.search(rf"\b{re.escape(name)}\s*(?:[;={{,]|\[)", text) is not None

    def _make_local(self, offset: int, node: Node, how: str, path: Sequence[Node], depth: int) -> Local | None:
        if how in ("template", "type"):
            return Local(how, "", None, offset)
        if how == "alias":
            return Local(how, self._read(node.child_by_field_name("type") or node), None, offset)
        if how == "captured":
            value = node.child_by_field_name("right")
            return Local("variable", "auto", self._parse_value(value, path, depth), offset)
        type_ = self._read_type(node)
        if how == "each":
            value = self._parse_value(node.child_by_field_name("right"), path, depth)
            value = Expr("each", "", offset, (value,)) if value is not None else None
            name_node, marks, *_ = self._split_declarator(node.child_by_field_name("declarator"))
            if name_node is not None and name_node.kind_id == KIND.structured_binding_declarator:
                return self._make_binding(name_node, value, offset)
            return Local("variable", type_ + marks, value, offset)
        for declarator in node.children_by_field_name("declarator"):
            name_node, marks, parameters, array = self._split_declarator(declarator)
            if name_node is None:
                continue
            if name_node.kind_id == KIND.structured_binding_declarator:
                given = declarator.child_by_field_name("value") or node.child_by_field_name("value")
                return self._make_binding(name_node, self._parse_value(given, path, depth), offset)
            if name_node.start_byte != offset:
                continue
            value = None
            # In the head of `if` or `while`, the value is the declaration's.
            given = declarator.child_by_field_name("value") or node.child_by_field_name("value")
            if given is not None:
                value = self._parse_value(given, path, depth) if "auto" in type_ else None
            elif how == "parameter" and "auto" in type_:
                value = self._find_passed(node, path, depth)
            elif parameters is not None and "auto" not in type_:
                # `A a(b);` looks like a function, and is one only with parameters that have names or kinds.
                if how == "variable" and self._may_be_arguments(declarator):
                    return Local("variable", type_ + marks, None, offset)
                return Local("function", type_ + marks, None, offset)
            return Local(how, type_ + marks + ("[]" if array else ""), value, offset)
        return Local("variable", "", None, offset)

    def _find_passed(self, node: Node, path: Sequence[Node], depth: int) -> Expr | None:
        """What a parameter of a lambda is, where a call of an algorithm of the standard library tells. path: up to the
        lambda."""
        if len(path) < 3 or path[-1].kind_id != KIND.lambda_expression or path[-3].kind_id != KIND.call_expression:
            return None
        function, arguments = path[-3].child_by_field_name("function"), path[-2]
        declarator = path[-1].child_by_field_name("declarator")
        listed = declarator.child_by_field_name("parameters") if declarator is not None else None
        if function is None or listed is None or arguments.kind_id != KIND.argument_list:
            return None
        outer, _, last = self._read(function).removeprefix("::").rpartition("::")
        if outer != "std" or get_items(listed).index(node) not in _TAKING_ELEMENTS.get(last, ()):
            return None
        first = self._make_expr(get_items(arguments)[0], path[:-2], depth + 1)
        return Expr(*(("each", "") if last == "erase_if" else ("unary", "*")), first.offset, (first,))

    def _make_binding(self, names: Node, value: Expr | None, offset: int) -> Local:
        """The name at an offset among those of a structured binding."""
        every = get_items(names)
        at = next(n for n, each in enumerate(every) if each.start_byte == offset)
        value = Expr("part", f"{at}/{len(every)}", offset, (value,)) if value is not None else None
        return Local("binding", "auto", value, offset)

    def _may_be_arguments(self, declarator: Node) -> bool:
        listed = declarator.child_by_field_name("parameters")
        return (
            listed is not None
            and all(
                each.kind_id == KIND.parameter_declaration and each.named_child_count == 1 for each in get_items(listed)
            )
            and bool(get_items(listed))
        )

    def _parse_value(self, node: Node | None, path: Sequence[Node], depth: int) -> Expr | None:
        if node is None:
            return None
        if node.kind_id in LISTS:
            inner = get_items(node)
            return self._make_expr(inner[0], path, depth + 1) if len(inner) == 1 else None
        return self._make_expr(node, path, depth + 1)

    @cache_method
    def _list_block_names(self, node: Node) -> list[tuple[int, str, Node, str]]:
        """What a block, loop, lambda or function declares itself: offset, name, node and how."""
        return sorted(self._declares(node), key=lambda each: each[0])

    def _declares(self, node: Node) -> Iterator[tuple[int, str, Node, str]]:
        number = node.kind_id
        if number in _BLOCKS:
            yield from self._declares_among(node.named_children)
        elif number == KIND.lambda_expression:
            declarator = node.child_by_field_name("declarator")
            if declarator is not None:
                yield from self._list_parameters(declarator)
            captures = node.child_by_field_name("captures")
            for each in captures.named_children if captures is not None else ():
                left = each.child_by_field_name("left")
                if left is not None:
                    yield left.start_byte, self._read(left), each, "captured"
        elif number == KIND.function_definition:
            declarator = node.child_by_field_name("declarator")
            while declarator is not None and declarator.kind_id != KIND.function_declarator:
                declarator = declarator.child_by_field_name("declarator") or (
                    declarator.named_children[-1] if declarator.kind_id in _MARKS else None
                )
            if declarator is not None:
                yield from self._list_parameters(declarator)
        elif number == KIND.catch_clause:
            yield from self._list_parameters(node)
        elif number == KIND.for_range_loop:
            yield from self._list_declared(node.child_by_field_name("declarator"), node, "each")
        elif number == KIND.for_statement:
            first = node.child_by_field_name("initializer")
            if first is not None:
                yield from self._declares_among([first])
        elif number in _STATEMENTS_WITH_HEAD:
            condition = node.child_by_field_name("condition")
            if condition is not None and condition.kind_id == KIND.condition_clause:
                for each in condition.named_children:
                    yield from self._declares_among(each.named_children if each.type == "init_statement" else [each])
        elif number == KIND.template_declaration:
            for name, at in self._list_template_parameters(node):
                yield at, name, node, "template"

    def _declares_among(self, children: Sequence[Node]) -> Iterator[tuple[int, str, Node, str]]:
        for child in children:
            number = child.kind_id
            if number == KIND.declaration:
                for declarator in child.children_by_field_name("declarator"):
                    yield from self._list_declared(declarator, child, "variable")
                type_ = child.child_by_field_name("type")
                if type_ is not None and type_.kind_id in _CLASSES:
                    yield from self._declares_among([type_])
            elif number in _PREPROCESSOR:
                yield from self._declares_among(child.named_children)
            elif number in (KIND.alias_declaration, KIND.type_definition):
                name = child.child_by_field_name("name") or child.child_by_field_name("declarator")
                if name is not None:
                    yield child.start_byte, self._read(name), child, "alias"
            elif number in DECLARED_TYPES:
                name = child.child_by_field_name("name")
                if name is not None and child.parent is not None and child.parent.kind_id == KIND.compound_statement:
                    yield name.start_byte, self._read(name), child, "type"
            elif number == KIND.using_declaration:
                text = self._read(child)
                full = text.removeprefix("using").strip(" ;")
                if full.startswith("namespace "):
                    space = "".join(full.removeprefix("namespace").split())
                    yield child.start_byte, space.removeprefix("::"), child, "opened"
                else:
                    yield child.start_byte, strip_templates(full).removeprefix("::"), child, "used"

    def _list_parameters(self, node: Node) -> Iterator[tuple[int, str, Node, str]]:
        listed = node.child_by_field_name("parameters")
        for each in listed.named_children if listed is not None else ():
            if each.kind_id in PARAMETERS:
                yield from self._list_declared(each.child_by_field_name("declarator"), each, "parameter")

    def _list_declared(self, declarator: Node | None, node: Node, how: str) -> Iterator[tuple[int, str, Node, str]]:
        """The names that a declarator has, of a binding each of its own."""
        name, *_ = self._split_declarator(declarator)
        if name is not None:
            for each in name.named_children if name.kind_id == KIND.structured_binding_declarator else [name]:
                yield each.start_byte, self._read(each), node, how

    def _list_template_parameters(self, node: Node) -> Iterator[tuple[str, int]]:
        listed = node.child_by_field_name("parameters")
        for each in listed.named_children if listed is not None else ():
            if each.kind_id in _TYPE_PARAMETERS:
                names = [inner for inner in each.named_children if inner.kind_id == KIND.type_identifier]
                if names:
                    yield self._read(names[0]), names[0].start_byte
            elif each.kind_id in PARAMETERS:
                for at, name, *_ in self._list_declared(each.child_by_field_name("declarator"), each, ""):
                    yield name, at

    def _split_declarator(self, node: Node | None) -> tuple[Node | None, str, Node | None, bool]:
        """Name, marks, parameters and whether it is an array, of a declarator."""
        marks, parameters, array = "", None, False
        while node is not None:
            number = node.kind_id
            if number in _NAMES or number == KIND.structured_binding_declarator:
                return node, marks, parameters, array
            if number in _MARKS:
                marks += _MARKS[number]
                inner = node.child_by_field_name("declarator")
                node = inner if inner is not None else next(
                    (c for c in reversed(node.named_children) if c.type != "type_qualifier"), None
                )  # fmt: skip
            elif number == KIND.function_declarator:
                parameters = node
                node = node.child_by_field_name("declarator")
            elif number == KIND.init_declarator:
                node = node.child_by_field_name("declarator")
            elif number in _WRAPPED:
                array = array or node.type == "array_declarator"
                inner = node.child_by_field_name("declarator")
                node = inner if inner is not None else (node.named_children[0] if node.named_child_count else None)
            else:
                return None, marks, parameters, array
        return None, marks, parameters, array

    def _read_type(self, node: Node) -> str:
        """The type that a declaration begins with, with its `const`."""
        type_ = node.child_by_field_name("type")
        if type_ is None:
            return ""
        if type_.kind_id in DECLARED_TYPES:
            name = type_.child_by_field_name("name")
            return self._read(name) if name is not None else ""
        constant = any(
            child.type == "type_qualifier" and self._read(child) == "const" for child in node.named_children[:3]
        )
        return ("const " if constant else "") + self._read(type_)

    def _list_template_arguments(self, node: Node) -> tuple[str, ...]:
        listed = node.child_by_field_name("arguments")
        return tuple(self._read(each) for each in get_items(listed)) if listed is not None else ()

    def _make_expr(self, node: Node, path: Sequence[Node], depth: int = 0) -> Expr:
        number, at = node.kind_id, node.start_byte
        if depth > _DEEPEST:
            return Expr("other", "", at)
        if number in (KIND.identifier, KIND.type_identifier):
            name = self._read(node)
            return Expr("name", name, at, local=self._find_local(name, at, path, depth))
        if number in (KIND.qualified_identifier, KIND.template_function, KIND.template_type):
            inner, template = node, None
            while inner is not None and inner.kind_id == KIND.qualified_identifier:
                inner = inner.child_by_field_name("name")
            if inner is not None and inner.kind_id in _TEMPLATES:
                template = self._list_template_arguments(inner)
                written = self._text[at : (inner.child_by_field_name("name") or inner).end_byte]
            else:
                written = self._text[at : node.end_byte]
            return Expr("name", strip_templates(written).removeprefix("::"), at, template=template)
        if number == KIND.field_expression:
            object_, field = node.child_by_field_name("argument"), node.child_by_field_name("field")
            if object_ is None or field is None:
                return Expr("other", "", at)
            if field.kind_id == KIND.dependent_name and field.named_child_count:
                field = field.named_children[-1]
            template = None
            if field.kind_id in _TEMPLATES:
                template = self._list_template_arguments(field)
                field = field.child_by_field_name("name") or field
            operator = node.child_by_field_name("operator")
            arrow = operator is not None and operator.end_byte - operator.start_byte == 2
            return Expr("member", self._read(field), field.start_byte, (self._make_expr(object_, path, depth + 1),),
                        arrow, template)  # fmt: skip
        if number == KIND.call_expression:
            function, arguments = node.child_by_field_name("function"), node.child_by_field_name("arguments")
            if function is None:
                return Expr("other", "", at)
            given = get_items(arguments) if arguments is not None else []
            parts = (function, *given)
            return Expr("call", "", at, tuple(self._make_expr(each, path, depth + 1) for each in parts))
        if number == KIND.parenthesized_expression and node.named_child_count:
            return self._make_expr(get_items(node)[0], path, depth + 1) if get_items(node) else Expr("other", "", at)
        if number in (KIND.pointer_expression, KIND.subscript_expression):
            inner = node.child_by_field_name("argument")
            how, sign = ("unary", self._text[at]) if number == KIND.pointer_expression else ("index", "")
            if inner is not None:
                return Expr(how, sign, at, (self._make_expr(inner, path, depth + 1),))
        if number in _PLAIN:
            how, text = _PLAIN[number]
            return Expr(how, text, at)
        if number == KIND.number_literal:
            text = self._read(node)
            floating = text[:2] not in ("0x", "0X") and any(c in text for c in ".eE")
            return Expr("literal", "float" if floating else "integer", at)
        if number in (KIND.new_expression, KIND.compound_literal_expression, KIND.cast_expression):
            type_ = node.child_by_field_name("type")
            given = node.child_by_field_name("arguments") or node.child_by_field_name("value")
            values = [] if given is None else get_items(given) if given.kind_id in LISTS else [given]
            how = "new" if number == KIND.new_expression else "cast" if number == KIND.cast_expression else "braces"
            return Expr(how, self._read(type_) if type_ is not None else "", at,
                        tuple(self._make_expr(each, path, depth + 1) for each in values))  # fmt: skip
        if number == KIND.initializer_list:
            return Expr("braces", "", at, tuple(self._make_expr(each, path, depth + 1) for each in get_items(node)))
        if number in (KIND.binary_expression, KIND.unary_expression):
            operator = node.child_by_field_name("operator")
            operands = [
                each for name in ("left", "right", "argument") if (each := node.child_by_field_name(name)) is not None
            ]
            how = "binary" if number == KIND.binary_expression else "unary"
            sign = self._read(operator) if operator is not None else ""
            return Expr(how, sign, at, tuple(self._make_expr(each, path, depth + 1) for each in operands))
        if number == KIND.conditional_expression:
            both = (node.child_by_field_name("consequence"), node.child_by_field_name("alternative"))
            parts = tuple(self._make_expr(each, path, depth + 1) for each in both if each is not None)
            return Expr("conditional", "", at, parts)
        return Expr("other", "", at)


# Macros of gtest that open the body of a method of a class that is derived from what they are given first.
_FIXTURES = frozenset(("TEST_F", "TEST_P", "TYPED_TEST", "TYPED_TEST_P"))
_MAKERS = frozenset(("make_shared", "make_unique"))
# Algorithms, with the places of the parameters that are elements of the first range, of the functions they are given.
_TAKING_ELEMENTS = {
    **dict.fromkeys((
        "for_each", "for_each_n", "find_if", "find_if_not", "any_of", "all_of", "none_of", "count_if", "remove_if",
        "remove_copy_if", "copy_if", "replace_if", "replace_copy_if", "erase_if", "partition", "stable_partition",
        "partition_point", "partition_copy", "is_partitioned", "transform", "lower_bound",
    ), (0,)),
    **dict.fromkeys((
        "sort", "stable_sort", "partial_sort", "nth_element", "is_sorted", "is_sorted_until", "max_element",
        "min_element", "minmax_element", "unique", "adjacent_find",
    ), (0, 1)),
    **dict.fromkeys(("upper_bound", "accumulate"), (1,)),
}  # fmt: skip
_SCOPED = _STATEMENTS_WITH_HEAD | get_kinds(
    "lambda_expression", "function_definition", "catch_clause", "for_range_loop", "for_statement",
    "template_declaration",
)  # fmt: skip


class _Declarations:
    """Reads what a file declares outside of functions.

    A tree-sitter query for the nodes in question takes as long (0.095 s for 400 files, this 0.102 s), since it goes
    through the bodies of functions too."""

    def __init__(self, code: CppCode):
        self.code = code
        self.classes: list[CppClass] = []
        self.names: list[Declaration] = []

    def read(self, root: Node) -> FileDeclarations:
        with suppress(RecursionError):  # what nobody writes by hand is read as far as it goes
            self._add_nodes(root.named_children, "", None, ())
        return FileDeclarations(tuple(self.classes), tuple(self.names))

    def _add_nodes(self, children: Sequence[Node], scope: str, members: dict | None, template: tuple[str, ...]) -> None:
        for node in children:
            number = node.kind_id
            if number == KIND.namespace_definition:
                name = node.child_by_field_name("name")
                inner = join_scope(scope, "".join(self.code._read(name).split())) if name is not None else scope
                body = node.child_by_field_name("body")
                if body is not None:
                    self._add_nodes(body.named_children, inner, None, ())
            elif number in (KIND.declaration, KIND.field_declaration, KIND.function_definition):
                self._add_declaration(node, scope, members, template)
            elif number in _CLASSES:
                self._add_class(node, scope, members, template)
            elif number == KIND.enum_specifier:
                self._add_enum(node, scope, members)
            elif number == KIND.template_declaration:
                inner = tuple(name for name, _ in self.code._list_template_parameters(node))
                self._add_nodes(node.named_children[1:], scope, members, inner or ("",))
            elif number in _PREPROCESSOR:
                self._add_nodes(node.named_children, scope, members, template)
            elif number == KIND.linkage_specification:
                body = node.child_by_field_name("body")
                if body is not None:
                    several = body.kind_id == KIND.declaration_list
                    self._add_nodes(body.named_children if several else [body], scope, members, ())
            elif number in (KIND.alias_declaration, KIND.type_definition):
                self._add_alias(node, scope, members, template)
            elif number in (KIND.ERROR, KIND.declaration_list):
                self._add_nodes(node.named_children, scope, members, template)

    def _add(self, members: dict[str, list[Declaration]] | None, one: Declaration) -> None:
        if members is None:
            self.names.append(one)
        else:
            members.setdefault(one.name, []).append(one)

    def _add_declaration(self, node: Node, scope: str, members, template: tuple[str, ...]) -> None:
        code = self.code
        type_node = node.child_by_field_name("type")
        declarators = node.children_by_field_name("declarator")
        if type_node is not None:
            if type_node.kind_id in _CLASSES:
                self._add_class(type_node, scope, members, template if not declarators else ())
            elif type_node.kind_id == KIND.enum_specifier:
                self._add_enum(type_node, scope, members)
        type_ = code._read_type(node)
        traits = {
            text for child in node.children if child.kind_id in _TRAIT_NODES and (text := code._read(child)) in _TRAITS
        } - {"const"}
        if template:
            traits.add("template")
        for declarator in declarators:
            name, marks, function, array = code._split_declarator(declarator)
            if name is None or name.kind_id == KIND.structured_binding_declarator:
                continue
            written = strip_templates(code._read(name))
            outer, _, last = written.removeprefix("::").rpartition("::")
            around = join_scope(scope, outer) if outer else scope
            if function is not None:
                inner = set(traits)
                result = type_ + marks
                for child in function.children:
                    if child.kind_id in _TRAIT_NODES and code._read(child) in _TRAITS:
                        inner.add(code._read(child))
                    elif child.kind_id == KIND.trailing_return_type and child.named_child_count:
                        result = code._read(child.named_children[-1])
                behind = code._text[function.end_byte : node.end_byte][:40]
                if node.kind_id == KIND.field_declaration and re.match(r"\s*=\s*0\s*;", behind):
                    inner.add("pure")
                if re.match(r"[^{;]*=\s*delete\b", behind):
                    inner.add("deleted")
                method = members is not None and not outer
                if method and code._is_split(name.start_byte):
                    inner.add("split")
                self._add(members if not outer else None,
                          Declaration("function", last, around, result, self._list_parameters(function),
                                      frozenset(inner), template,
                                      at=code._find_spot(name.start_byte) if method else None))  # fmt: skip
            else:
                value = None
                if "auto" in type_ and declarator.kind_id == KIND.init_declarator:
                    given = declarator.child_by_field_name("value")
                    value = code._parse_value(given, (), 0)
                self._add(members if not outer else None,
                          Declaration("variable", last, around, type_ + marks + ("[]" if array else ""), (),
                                      frozenset(traits), template, value))  # fmt: skip

    def _list_parameters(self, function: Node) -> tuple[WrittenParameter, ...]:
        code = self.code
        listed = function.child_by_field_name("parameters")
        found = []
        for each in get_items(listed) if listed is not None else ():
            if each.kind_id not in PARAMETERS:
                found.append(WrittenParameter("..." if each.type == "variadic_parameter" else code._read(each)))
                continue
            declarator = each.child_by_field_name("declarator")
            name, *_ = code._split_declarator(declarator)
            default = each.child_by_field_name("default_value")
            # The type is all but the name and the default.
            end = default.start_byte if default is not None else each.end_byte
            text = code._text[each.start_byte : end].rstrip(" \t\n=")
            if name is not None and name.kind_id == KIND.identifier:
                start = name.start_byte - each.start_byte
                text = text[:start] + text[start + name.end_byte - name.start_byte :]
            found.append(WrittenParameter(" ".join(text.split()), code._read(name) if name is not None else "",
                                   code._read(default) if default is not None else None))  # fmt: skip
        return tuple(found) if [p.type for p in found] != ["void"] else ()

    def _add_class(self, node: Node, scope: str, members, template: tuple[str, ...]) -> None:
        code = self.code
        name = node.child_by_field_name("name")
        body = node.child_by_field_name("body")
        if name is None:
            if body is not None:  # members of what is around it
                self._add_nodes(body.named_children, scope, members, ())
            return
        written = code._read(name)
        full = join_scope(scope, strip_templates(written))
        if body is None:
            return
        bases = []
        for child in node.named_children:
            if child.kind_id == KIND.base_class_clause:
                bases = [code._read(one) for one in child.named_children if one.kind_id in TYPES]
        inside: dict[str, list[Declaration]] = {}
        place = len(self.classes)
        self._add_nodes(body.named_children, full, inside, ())
        hidden = any(map(self._may_hide_members, body.children))
        open_ = hidden or has_lone_macro(code._parsed[0], body.start_byte, body.end_byte) or any(
            each.type.isupper() and each.type not in template for those in inside.values() for each in those
        )
        spot = code._find_spot(name.start_byte)
        one = CppClass(full, spot, tuple(bases), inside, template, "<" in written, open_)
        self.classes.insert(place, one)
        if members is not None:
            self._add(members, Declaration("type", strip_templates(written), scope))

    def _may_hide_members(self, node: Node) -> bool:
        """Whether a part of a class may declare what is not seen: it was not understood, as a macro alone is, or
        includes a file."""
        if node.kind_id == KIND.ERROR or node.is_missing:
            return True
        if node.kind_id in (KIND.preproc_call, KIND.preproc_include) and "include" in self.code._read(node):
            return True
        if node.kind_id == KIND.field_declaration and node.child_by_field_name("declarator") is None:
            type_ = node.child_by_field_name("type")
            if type_ is not None and type_.kind_id == KIND.type_identifier:
                return True
        # What is wrong with the body of a function is not one of its class's members.
        heads = [child for child in node.children if child.kind_id not in _BODIES]
        return node.has_error and any(child.has_error or child.is_missing for child in heads)

    def _add_enum(self, node: Node, scope: str, members) -> None:
        code = self.code
        name, body = node.child_by_field_name("name"), node.child_by_field_name("body")
        text = code._text[node.start_byte : node.start_byte + 12]
        scoped = re.match(r"enum\s+(?:class|struct)\b", text) is not None
        full = scope
        if name is not None:
            last = strip_templates(code._read(name))
            full = join_scope(scope, last)
            self._add(members, Declaration("type", last, scope))
        for each in body.named_children if body is not None else ():
            inner = each.child_by_field_name("name")
            if inner is not None:
                one = Declaration("enumerator", code._read(inner), full if scoped else scope, full)
                if scoped:
                    self.names.append(one)
                else:
                    self._add(members, one)

    def _add_alias(self, node: Node, scope: str, members, template: tuple[str, ...]) -> None:
        code = self.code
        if node.kind_id == KIND.alias_declaration:
            name, type_ = node.child_by_field_name("name"), node.child_by_field_name("type")
            if name is not None and type_ is not None:
                one = Declaration("alias", code._read(name), scope, code._read(type_), template=template)
                self._add(members, one)
            return
        type_ = node.child_by_field_name("type")
        if type_ is not None and type_.kind_id in _CLASSES:
            self._add_class(type_, scope, members, ())
        for declarator in node.children_by_field_name("declarator"):
            name, marks, function, array = code._split_declarator(declarator)
            if name is not None and function is None:
                meant = code._read_type(node) + marks + ("[]" if array else "")
                self._add(members, Declaration("alias", code._read(name), scope, meant))
