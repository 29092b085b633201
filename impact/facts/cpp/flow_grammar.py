"""The kinds of nodes of the C++ grammar, by number, and the few names of functions that C++ code itself knows."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import lru_cache
from types import SimpleNamespace
from typing import Any

import tree_sitter_cpp
from tree_sitter import Language, Node, Parser

from ....edges.dispatch import methods_of

LANGUAGE = Language(tree_sitter_cpp.language())
PARSER = Parser(LANGUAGE)


def kind(name: str, named: bool = True) -> int:
    """The number of a kind of node."""
    number = LANGUAGE.id_for_node_kind(name, named) or (65535 if name == "ERROR" else None)
    if number is None:
        raise ValueError(f"the grammar knows no {name}")
    return number


def kinds(*names: str) -> frozenset[int]:
    """The numbers of some kinds of nodes."""
    return frozenset(map(kind, names))


def node_readers(cls: type, prefix: str) -> dict[int, Callable[..., Any]]:
    """The methods of a class by the kind of node that stands behind a prefix in their names."""
    return {kind(name): method for name, method in methods_of(cls, prefix).items()}


_NODE_NAMES = map(LANGUAGE.node_kind_for_id, range(LANGUAGE.node_kind_count))
_KINDS = {name: kind(name) for name in _NODE_NAMES if name and LANGUAGE.id_for_node_kind(name, True)}
_TOKENS = {"equals_sign": "=", "semicolon": ";", "colon": ":", "opening": "(", "closing": ")", "case_word": "case"}
KIND = SimpleNamespace(**_KINDS, ERROR=kind("ERROR"), **{name: kind(sign, False) for name, sign in _TOKENS.items()})
"""The number of each kind of node by its name in the grammar, `KIND.call_expression`, and of some signs."""
LISTS = (KIND.argument_list, KIND.initializer_list)
LITERALS = kinds(
    "true", "false", "null", "number_literal", "char_literal", "string_literal", "raw_string_literal",
    "concatenated_string",
)  # fmt: skip
DECLARED_TYPES = kinds("class_specifier", "struct_specifier", "union_specifier", "enum_specifier")
NAMES = kinds(
    "identifier", "field_identifier", "qualified_identifier", "destructor_name", "operator_name", "operator_cast",
    "type_identifier", "template_function", "template_method", "namespace_identifier",
)  # fmt: skip
PARAMETERS = kinds("parameter_declaration", "optional_parameter_declaration", "variadic_parameter_declaration")
DECLARATORS = NAMES | kinds(
    "function_declarator", "pointer_declarator", "reference_declarator", "array_declarator", "init_declarator",
    "parenthesized_declarator", "structured_binding_declarator", "variadic_declarator", "attributed_declarator",
)  # fmt: skip
TYPES = kinds(
    "type_identifier", "primitive_type", "sized_type_specifier", "qualified_identifier", "template_type",
    "placeholder_type_specifier", "decltype", "dependent_type", "auto",
)  # fmt: skip
OPERATORS = {
    kind(sign, False): {"and": "&&", "or": "||"}.get(sign, sign)
    for sign in (
        "+", "-", "*", "/", "%", "<", ">", "<=", ">=", "==", "!=", "&&", "||", "<<", ">>", "&", "|", "^", "<=>", "and",
        "or",
    )
}  # fmt: skip
JOINING = frozenset("+/%")
SAFE = frozenset(("-", "*", "/", "%", "<", ">", "<=", ">=", "&&", "||", "&", "|", "^"))


def grammatical(node: Node) -> list[Node]:
    """The children of a node without comments."""
    children = node.children
    for child in children:
        if child.kind_id == KIND.comment:
            return [child for child in children if child.kind_id != KIND.comment]
    return children


def listed_in(node: Node) -> list[Node]:
    """What is listed in parentheses or braces, without commas and comments."""
    children = node.named_children
    for child in children:
        if child.kind_id == KIND.comment:
            return [child for child in children if child.kind_id != KIND.comment]
    return children


# Calls that are no news: what they are given counts, themselves they do not.
_NOISE = re.compile(
    r"(?:ROS|RCLCPP|RCUTILS|NODELET|RCLC)_(?:DEBUG|INFO|WARN|ERROR|FATAL|LOG|SAFE_FWRITE|ASSERT|BREAK)\w*"
    r"|(?:EXPECT|ASSERT)_\w+|CONSOLE_BRIDGE_log\w+|assert"
)


@lru_cache(maxsize=4096)
def noise(callee: str) -> bool:
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
NEVER_RETURNS = frozenset((
    "exit", "_exit", "::exit", "std::exit", "abort", "::abort", "std::abort", "std::terminate", "std::quick_exit",
    "ROS_BREAK",
))  # fmt: skip
ASSERTS = frozenset(("assert", "ROS_ASSERT"))
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
