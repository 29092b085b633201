"""The kinds of nodes of the C++ grammar, by number, and the few names of functions that C++ code itself knows."""

from __future__ import annotations

import re
from functools import lru_cache

import tree_sitter_cpp
from tree_sitter import Language, Node

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
TYPE_QUALIFIER = kind("type_qualifier")
CAPTURES = kind("lambda_capture_specifier")
CAPTURE_INITIALIZER = kind("lambda_capture_initializer")
LISTS = (ARGUMENTS, BRACES)
ERROR = LANGUAGE.id_for_node_kind("ERROR", True) or 65535

DECLARED_TYPES = frozenset(
    kind(name) for name in ("class_specifier", "struct_specifier", "union_specifier", "enum_specifier")
)
NAMES = frozenset(
    kind(name)
    for name in (
        "identifier", "field_identifier", "qualified_identifier", "destructor_name", "operator_name", "operator_cast",
        "type_identifier", "template_function", "template_method", "namespace_identifier",
    )
)  # fmt: skip

EQUALS = kind("=", False)
RVALUE = kind("&&", False)
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
        if child.kind_id == COMMENT:
            return [child for child in children if child.kind_id != COMMENT]
    return children


def listed_in(node: Node) -> list[Node]:
    """What is listed in parentheses or braces, without commas and comments."""
    children = node.named_children
    for child in children:
        if child.kind_id == COMMENT:
            return [child for child in children if child.kind_id != COMMENT]
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
