"""The kinds of nodes of the C++ grammar, by number, and what is asked of nodes of any kind."""

from bisect import bisect_right
from collections.abc import Callable
from types import ModuleType
from typing import Any

import tree_sitter_cpp
from tree_sitter import Language, Node, Parser

from ....edges.dispatch import collect_methods

LANGUAGE = Language(tree_sitter_cpp.language())
PARSER = Parser(LANGUAGE)


def get_kind(name: str, named: bool = True) -> int:
    """The number of a kind of node."""
    number = LANGUAGE.id_for_node_kind(name, named) or (65535 if name == "ERROR" else None)
    if number is None:
        raise ValueError(f"the grammar knows no {name}")
    return number


def get_kinds(*names: str) -> frozenset[int]:
    """The numbers of some kinds of nodes."""
    return frozenset(map(get_kind, names))


def find_node_readers(cls: type, prefix: str) -> dict[int, Callable[..., Any]]:
    """The methods of a class by the kind of node that stands behind a prefix in their names."""
    return {get_kind(name): method for name, method in collect_methods(cls, prefix).items()}


_NODE_NAMES = map(LANGUAGE.node_kind_for_id, range(LANGUAGE.node_kind_count))
_KINDS = {name: get_kind(name) for name in _NODE_NAMES if name and LANGUAGE.id_for_node_kind(name, True)}
_TOKENS = {"equals_sign": "=", "semicolon": ";", "colon": ":", "opening": "(", "closing": ")", "case_word": "case"}
# Looking a name up in a module takes a quarter of the time that it takes in other objects of so many names.
KIND = ModuleType("KIND")
vars(KIND).update(_KINDS, ERROR=get_kind("ERROR"), **{name: get_kind(sign, False) for name, sign in _TOKENS.items()})
"""The number of each kind of node by its name in the grammar, `KIND.call_expression`, and of some signs."""
LISTS = (KIND.argument_list, KIND.initializer_list)
LITERALS = get_kinds(
    "true", "false", "null", "number_literal", "char_literal", "string_literal", "raw_string_literal",
    "concatenated_string",
)  # fmt: skip
DECLARED_TYPES = get_kinds("class_specifier", "struct_specifier", "union_specifier", "enum_specifier")
NAMES = get_kinds(
    "identifier", "field_identifier", "qualified_identifier", "destructor_name", "operator_name", "operator_cast",
    "type_identifier", "template_function", "template_method", "namespace_identifier",
)  # fmt: skip
PARAMETERS = get_kinds("parameter_declaration", "optional_parameter_declaration", "variadic_parameter_declaration")
DECLARATORS = NAMES | get_kinds(
    "function_declarator", "pointer_declarator", "reference_declarator", "array_declarator", "init_declarator",
    "parenthesized_declarator", "structured_binding_declarator", "variadic_declarator", "attributed_declarator",
)  # fmt: skip
TYPES = get_kinds(
    "type_identifier", "primitive_type", "sized_type_specifier", "qualified_identifier", "template_type",
    "placeholder_type_specifier", "decltype", "dependent_type", "auto",
)  # fmt: skip
OPERATORS = {
    get_kind(sign, False): {"and": "&&", "or": "||"}.get(sign, sign)
    for sign in (
        "+", "-", "*", "/", "%", "<", ">", "<=", ">=", "==", "!=", "&&", "||", "<<", ">>", "&", "|", "^", "<=>", "and",
        "or",
    )
}  # fmt: skip


def list_children(node: Node) -> list[Node]:
    """The children of a node without comments."""
    children = node.children
    for child in children:
        if child.kind_id == KIND.comment:
            return [child for child in children if child.kind_id != KIND.comment]
    return children


def get_items(node: Node) -> list[Node]:
    """What is listed in parentheses or braces, without commas and comments."""
    children = node.named_children
    for child in children:
        if child.kind_id == KIND.comment:
            return [child for child in children if child.kind_id != KIND.comment]
    return children


def find_errors(root: Node, starts: list[int]) -> set[tuple[int, int]]:
    """Lines, first and last, of what the grammar did not understand."""
    found: set[tuple[int, int]] = set()
    waiting = [root] if root.has_error else []
    while waiting:
        node = waiting.pop()
        # A semicolon after a macro is often missing, and nothing is lost by it.
        if node.kind_id == KIND.ERROR or (node.is_missing and node.kind_id != KIND.semicolon):
            # `template class A<int>;` declares nothing, and the grammar looks for a name.
            if node.is_missing and node.parent is not None and node.parent.kind_id == KIND.template_instantiation:
                continue
            found.add((bisect_right(starts, node.start_byte), bisect_right(starts, node.end_byte)))
        elif node.has_error:
            waiting += node.children
    return found
