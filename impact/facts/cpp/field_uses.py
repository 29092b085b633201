"""What C++ functions do with variables and what is below them: every name is looked at where it stands.

The walk asks of each name what the nodes around it make of it, from the inside outwards. A node that is not known is a
`use` of all that the name holds, so what the grammar or this reader does not understand is never lost.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Callable
from typing import Any

from tree_sitter import Node

from ..field_uses import FieldFile, FieldFunction, PathUse
from ..place import Problem
from .flow_clean import Cleaned
from .flow_grammar import (
    DECLARATORS,
    DECLARED_TYPES,
    KIND,
    LITERALS,
    NAMES,
    OPERATORS,
    TYPES,
    get_items,
    get_kinds,
    list_children,
)
from .flow_values import BINDS, CHANGES, ELEMENTS, MAKES, POINTEES, THROUGH, flatten, strip_template
from .parse import parse_source

_MACRO = re.compile(r"(?m)^[ \t]*#[ \t]*define\b(?:[^\n]*\\\n)*[^\n]*")
_HEAD = re.compile(r"\b([A-Za-z_]\w*)\s*(?:->|\.)\s*[A-Za-z_]")
_WORD = re.compile(r"[A-Za-z_]\w*")
_SIZES = frozenset(("size", "empty", "length", "capacity", "max_size"))
_READS = frozenset(
    ("c_str", "isZero", "toSec", "toNSec", "seconds", "nanoseconds", "data", "str", "substr", "find", "compare",
     "rfind")
)  # fmt: skip
_TESTS = frozenset(("has_value", "valid", "expired", "use_count", "operator bool", "unique"))
_ADDS = frozenset(("push_back", "emplace_back", "push", "push_front", "emplace_front", "insert", "emplace", "add"))
_RESETS = frozenset(("reset", "assign"))
_ENDS = frozenset(("begin", "end", "cbegin", "cend", "rbegin", "rend", "crbegin", "crend"))
_ITERATED = ELEMENTS | _ENDS
# Algorithms of the standard library that call a function with the elements between two iterators: which parameters of
# it the elements become. Source: https://en.cppreference.com/w/cpp/algorithm
_CALLING = {
    **dict.fromkeys(
        ("for_each", "any_of", "all_of", "none_of", "find_if", "find_if_not", "count_if", "partition",
         "stable_partition", "remove_if", "partition_point", "transform"), (0,)
    ),
    **dict.fromkeys(
        ("sort", "stable_sort", "min_element", "max_element", "is_sorted", "unique", "adjacent_find"), (0, 1)
    ),
    "accumulate": (1,),
}  # fmt: skip
# Those that give an iterator to an element back.
_FINDING = frozenset(
    ("find_if", "find_if_not", "partition", "stable_partition", "remove_if", "partition_point", "min_element",
     "max_element", "unique", "adjacent_find")
)  # fmt: skip
_ARGUMENTS = {"accumulate": 4, "transform": 4}
_NULLS = frozenset(("nullptr", "NULL", "0"))
_NO_VALUE = frozenset(("this", "nullptr", "NULL", "true", "false"))
# What stands in these is the name of something; in the others the first part is.
_NAMELESS = (DECLARATORS - get_kinds("init_declarator")) | get_kinds(
    "preproc_def", "preproc_defined", "preproc_if", "preproc_elif", "preproc_ifdef", "preproc_function_def",
    "goto_statement", "labeled_statement", "using_declaration", "parameter_declaration", "preproc_params",
    "friend_declaration", "template_type", "type_descriptor",
)
_FIRST_IS_NAME = get_kinds("call_expression", "init_declarator", "enumerator")
_DECLARING = get_kinds("declaration", "field_declaration", "for_range_loop", "optional_parameter_declaration")
_LONGEST = 80
_MOST_STEPS = 200


def extract(data: bytes) -> FieldFile:
    """What one C or C++ file does with variables. Never raises."""
    source, root, wrong = parse_source(data)
    reader = _Reader(source)
    try:
        reader.walk(root)
    except RecursionError:
        reader.problems.append(Problem(1, "nested too deeply to be read in full"))
        wrong = {(1, len(source.starts))}
    macros = {word for macro in _MACRO.findall(source.text) for word in _HEAD.findall(macro)}
    return FieldFile(
        "cpp", reader.list_functions(), tuple(sorted(wrong.union(source.hidden))), tuple(sorted(macros)),
        tuple(reader.problems),
    )  # fmt: skip


_Climb = Callable[[Any, str, Node, Node, Node], tuple[str, Node] | None]


class _Reader:
    """The reader of a file."""

    def __init__(self, cleaned: Cleaned) -> None:
        self.text, self.starts = cleaned.text, cleaned.starts
        self.problems: list[Problem] = []
        self._functions: list[FieldFunction] = []
        # Of the function that is walked.
        self.uses: list[PathUse] = []
        self._outside = self.uses

    def list_functions(self) -> tuple[FieldFunction, ...]:
        """The functions that use anything, with what stands outside of all."""
        found = [FieldFunction("", 0, 0, tuple(self._outside)), *self._functions]
        return tuple(one for one in found if one.uses)

    def spell(self, node: Node) -> str:
        return flatten(self.text[node.start_byte : node.end_byte])

    def find_line(self, node: Node) -> int:
        return bisect_right(self.starts, node.start_byte)

    # The walk

    def walk(self, node: Node) -> None:
        """Looks at all names in a node."""
        number = node.kind_id
        if number in (KIND.function_definition, KIND.lambda_expression):
            self._walk_function(node)
        elif number == KIND.identifier or number in (KIND.this, KIND.qualified_identifier):
            self._look(node)
        elif number == KIND.call_expression:
            self._look(node)
            for child in node.children:
                self.walk(child)
        elif number in (KIND.type_identifier, KIND.primitive_type, KIND.comment, KIND.field_identifier):
            return
        elif number in (KIND.parameter_list, KIND.template_argument_list, KIND.template_parameter_list):
            self._walk_parameters(node)
        else:
            for child in node.children:
                if child.child_count or child.is_named:
                    self.walk(child)

    def _walk_function(self, node: Node) -> None:
        line, captures = self.find_line(node), None
        if node.kind_id == KIND.lambda_expression:
            captures = node.child_by_field_name("captures")
            if captures is not None:
                self.walk(captures)
        before = self.uses
        self.uses = []
        for child in node.children:
            if child.child_count and child != captures:
                self.walk(child)
        if node.kind_id == KIND.lambda_expression:
            name = f"lambda@{line}:{node.start_byte - self.starts[line - 1] + 1}"
            end = bisect_right(self.starts, max(0, node.end_byte - 1))
        else:
            name, end = self._find_name(node), bisect_right(self.starts, node.end_byte)
        if self.uses:
            self._functions.append(FieldFunction(name, line, end, tuple(self.uses)))
        self.uses = before

    def _find_name(self, function: Node) -> str:
        """The last part of a function's name; empty where it has none that is seen."""
        at = function.child_by_field_name("declarator")
        for _ in range(20):
            if at is None or at.kind_id in NAMES:
                break
            at = at.child_by_field_name("declarator") or next(
                (child for child in at.children if child.kind_id in DECLARATORS), None
            )
        return strip_template(self.spell(at)).rpartition("::")[2].strip() if at is not None else ""

    def _walk_parameters(self, node: Node) -> None:
        """Parameters of a function; in a body they may be arguments that the grammar took for types: `T x(a);`."""
        declaration = self._find_mistaken(node)
        if declaration is None:
            for child in node.children:
                for part in child.children:
                    if part.kind_id not in NAMES and part.kind_id not in DECLARATORS and part.child_count:
                        self.walk(part)
            return
        declarator, type_ = declaration
        arguments = get_items(node)
        for place, argument in enumerate(arguments):
            written = self.text[argument.start_byte : argument.end_byte].replace("->", ".")
            for word in dict.fromkeys(_WORD.findall(written)):
                whole = written.strip() == word
                how = ("given", type_, place, len(arguments)) if whole else ("use", "an argument", 0, 0)
                self._add(word, how[0], argument, how[1], how[2], how[3], type_ if whole else "")
                if whole and len(arguments) == 1:
                    self._add(word, "kept", argument, declarator, 0, 1, type_)

    def _find_mistaken(self, node: Node) -> tuple[str, str] | None:
        """The variable and type that the declaration in a body has which a list of parameters may be arguments of."""
        declarator = node.parent
        declaration = declarator.parent if declarator is not None else None
        block = declaration.parent if declaration is not None else None
        if declarator is None or declaration is None or block is None or declarator.kind_id != KIND.function_declarator:
            return None
        if declaration.kind_id != KIND.declaration or block.kind_id not in (
            KIND.compound_statement, KIND.case_statement, KIND.if_statement, KIND.else_clause,
        ):  # fmt: skip
            return None
        return self.spell(declarator.children[0]), self._find_type(declaration)

    def _find_type(self, declaration: Node) -> str:
        """The type that a declaration begins with, as written."""
        pieces = []
        for child in declaration.children:
            if child.kind_id in TYPES or child.kind_id in DECLARED_TYPES:
                pieces.append(self.spell(child))
                break
            if child.kind_id == KIND.type_qualifier:
                pieces.append(self.spell(child))
        return " ".join(pieces)

    # One name

    def _add(
        self, path: str, how: str, node: Node, to: str = "", place: int = 0, count: int = 0, type_: str = ""
    ) -> None:
        if path == "this" or (how in ("test", "size") and "." not in path):
            return  # it reads nothing
        self.uses.append(PathUse(path, how, self.find_line(node), to[:_LONGEST], place, count, type_[:200]))

    def _look(self, node: Node) -> None:
        """Notes what is done with a name, or with what a call gives."""
        path = self._begin(node)
        if path is None:
            return
        at = node
        for _ in range(_MOST_STEPS):
            parent = at.parent
            if parent is None:
                return
            step = self._climb(path, at, parent, node)
            if step is None:
                return
            path, at = step
        self._add(path, "use", node, "too deep")

    def _begin(self, node: Node) -> str | None:
        """The path that a node begins, None for what stands for no value: what is declared or called."""
        parent = node.parent
        if parent is None:
            return None
        kind = parent.kind_id
        if node.kind_id == KIND.call_expression:
            return self._begin_call(node)
        if kind in _NAMELESS or (kind in _FIRST_IS_NAME and parent.children[0] == node):
            return None
        if kind in _DECLARING and node not in map(parent.child_by_field_name, ("right", "value", "default_value")):
            return None
        if node.kind_id == KIND.this:
            return "this"
        name = self.text[node.start_byte : node.end_byte]
        if node.kind_id == KIND.qualified_identifier:
            name = strip_template(name).rpartition("::")[2]
        return name if name and name not in _NO_VALUE else None

    def _begin_call(self, node: Node) -> str | None:
        """The path of what a call gives; None where that is what it is given, or nothing of the code's own."""
        function = node.children[0]
        if function.kind_id == KIND.field_expression:
            method = self.spell(function.children[-1])
            if method in POINTEES or method in _ITERATED or method in _SIZES or method in CHANGES or method in _READS:
                return None
            return f"{strip_template(method)}()"
        if function.kind_id not in (KIND.identifier, KIND.qualified_identifier, KIND.template_function):
            return None
        name = strip_template(self.text[function.start_byte : function.end_byte])
        if name.startswith("std::") or name in THROUGH or name in MAKES or name in BINDS or name.isupper():
            return None
        return f"{name.rpartition('::')[2]}()"

    def _climb(self, path: str, at: Node, parent: Node, node: Node) -> tuple[str, Node] | None:
        """What the node around an expression makes of it: a path that goes on and the node it is now, or None where it
        ended, and was noted."""
        read = _CLIMBS.get(parent.kind_id)
        if read is not None:
            return read(self, path, at, parent, node)
        self._add(path, "use", node, parent.type.replace("_", " "))
        return None

    def _climb_through(self, path: str, at: Node, parent: Node, node: Node) -> tuple[str, Node] | None:
        return path, parent

    def _climb_member(self, path: str, at: Node, parent: Node, node: Node) -> tuple[str, Node] | None:
        children = list_children(parent)
        if children[0] != at:
            return None  # the member's own name
        member = strip_template(self.spell(children[-1])).removeprefix("template ").rpartition("::")[2]
        outer = parent.parent
        if outer is None or outer.kind_id != KIND.call_expression or outer.children[0] != parent:
            return f"{path}.{member}", parent
        return self._climb_method(path, member, outer, node)

    def _climb_method(self, path: str, method: str, call: Node, node: Node) -> tuple[str, Node] | None:
        if method in POINTEES:
            return path, call
        if method in _ENDS and self._is_compared(call):
            self._add(path, "size", node, method)
        elif method in _ITERATED:
            return f"{path}.[]", call
        elif method in _SIZES:
            self._add(path, "size", node, method)
        elif method in _TESTS:
            self._add(path, "test", node, method)
        elif method in _READS:
            self._add(path, "read", node, method)
        elif method in CHANGES and method != "swap":
            self._add(path, "change", node, method)
        else:
            self._add(path, "method", node, method)
        return None

    def _is_compared(self, node: Node) -> bool:
        """Whether an expression is only compared with another."""
        parent = node.parent
        return (
            parent is not None
            and parent.kind_id == KIND.binary_expression
            and OPERATORS.get(parent.children[1].kind_id) in ("==", "!=", "<", ">", "<=", ">=")
        )

    def _climb_index(self, path: str, at: Node, parent: Node, node: Node) -> tuple[str, Node] | None:
        if parent.children[0] == at:
            return f"{path}.[]", parent
        self._add(path, "read", node, "an index")
        return None

    def _climb_subscript(self, path: str, at: Node, parent: Node, node: Node) -> tuple[str, Node] | None:
        self._add(path, "read", node, "an index")
        return None

    def _climb_arguments(self, path: str, at: Node, parent: Node, node: Node) -> tuple[str, Node] | None:
        """An element of a list of arguments, in parentheses or braces."""
        outer = parent.parent
        if outer is None:
            return None
        items = get_items(parent)
        place = items.index(at) if at in items else 0
        if outer.kind_id == KIND.call_expression:
            return self._climb_argument(path, outer, place, len(items), node)
        if outer.kind_id == KIND.init_declarator:
            declaration = outer.parent
            type_ = self._find_type(declaration) if declaration is not None else ""
            declarator = self._name_declared(outer.children[0])
            if len(items) == 1 and declarator:
                self._add(path, "kept", node, declarator, 0, 1, type_)
            if not type_.endswith("auto"):
                self._add(path, "given", node, type_, place, len(items), type_)
            return None
        if outer.kind_id == KIND.field_initializer:
            target = f"this.{strip_template(self.spell(outer.children[0]))}"
            if len(items) == 1:
                self._add(path, "kept", node, target, type_="?")
            else:
                self._add(path, "use", node, "given to what is made")
            return None
        if outer.kind_id in (KIND.new_expression, KIND.compound_literal_expression):
            type_ = next((self.spell(child) for child in outer.children if child.kind_id in TYPES), "")
            self._add(path, "given", node, type_, place, len(items), type_)
            return (path, outer) if len(items) == 1 else None
        self._add(path, "use", node, "in a list")
        return None

    def _climb_argument(self, path: str, call: Node, place: int, count: int, node: Node) -> tuple[str, Node] | None:
        function = call.children[0]
        written = self.text[function.start_byte : function.end_byte]
        callee = strip_template(flatten(written)).replace("->", ".")
        if function.kind_id == KIND.primitive_type:
            self._add(path, "read", node, callee)
            return None
        if callee in THROUGH and count == 1:
            return path, call
        if callee.startswith("std::") and callee[5:] in _CALLING and self._pass_elements(path, call, place, node):
            return (path, call) if place == 0 and callee[5:] in _FINDING else None
        if callee.rpartition("::")[2] in ("make_shared", "make_unique", "allocate_shared"):
            found = written.find("<")
            type_ = flatten(written[found + 1 : written.rfind(">")]) if found >= 0 else callee.rpartition("::")[0]
            self._add(path, "given", node, type_, place, count, type_)
            return (path, call) if count == 1 else None
        method = callee.rpartition(".")[2]
        if "." in callee and method in _ADDS and self._is_plain(function):
            self._add(path, "added", node, callee, place, count)
            return None
        if "." in callee and method in _RESETS and self._is_plain(function):
            self._add(path, "kept", node, callee.rpartition(".")[0], type_="?")
            return None
        self._add(path, "given", node, callee, place, count)
        return None

    def _pass_elements(self, path: str, call: Node, place: int, node: Node) -> bool:
        """Whether an algorithm passes the elements of a path to a lambda; noted with the first of the two iterators.
        An iterator is a path of elements."""
        name = strip_template(self.spell(call.children[0])).removeprefix("std::")
        items = get_items(call.children[-1])
        if place > 1 or len(items) != _ARGUMENTS.get(name, 3) or items[-1].kind_id != KIND.lambda_expression:
            return False
        if not path.endswith(".[]") or not self._are_ends(items[0], items[1]):
            return False
        lambda_ = items[-1]
        line = self.find_line(lambda_)
        where = f"lambda@{line}:{lambda_.start_byte - self.starts[line - 1] + 1}"
        declarator = lambda_.child_by_field_name("declarator")
        listed = declarator.child_by_field_name("parameters") if declarator is not None else None
        parameters = get_items(listed) if listed is not None else []
        if len(parameters) <= max(_CALLING[name]):
            return False
        for number in _CALLING[name] if place == 0 else ():
            inner = parameters[number].child_by_field_name("declarator")
            parameter = self._name_declared(inner) if inner is not None else ""
            if parameter:
                self._add(path, "kept", node, parameter, type_=where)
        return True

    def _are_ends(self, first: Node, last: Node) -> bool:
        """Whether two expressions are where the same thing begins and ends."""
        ends = [re.fullmatch(r"(.+?)(?:\.|->)c?r?(begin|end)\(\)", self.spell(one)) for one in (first, last)]
        names = [(end[1], end[2]) for end in ends if end is not None]
        return len(names) == 2 and names[0][0] == names[1][0] and (names[0][1], names[1][1]) == ("begin", "end")

    def _is_plain(self, function: Node) -> bool:
        """Whether a method is called on a path alone."""
        return re.fullmatch(r"[\w.>\-\s\[\]]+", self.text[function.start_byte : function.end_byte]) is not None

    def _climb_initialiser(self, path: str, at: Node, parent: Node, node: Node) -> tuple[str, Node] | None:
        """`T x = path`."""
        declared = self._name_declared(parent.children[0])
        declaration = parent.parent
        if not declared or declaration is None:
            self._add(path, "use", node, "taken apart")
            return None
        self._add(path, "kept", node, declared, type_=self._find_type(declaration))
        return None

    def _name_declared(self, node: Node) -> str:
        """The variable that a declarator declares; empty where it is not one."""
        for _ in range(20):
            if node.kind_id in (KIND.identifier, KIND.field_identifier):
                return self.text[node.start_byte : node.end_byte]
            inner = [child for child in node.children if child.kind_id in DECLARATORS]
            if len(inner) != 1 or node.kind_id == KIND.structured_binding_declarator:
                return ""
            node = inner[0]
        return ""

    def _climb_declaration(self, path: str, at: Node, parent: Node, node: Node) -> tuple[str, Node] | None:
        """`if (auto x = path)`, and members' initialisers."""
        declarator = parent.child_by_field_name("declarator")
        declared = self._name_declared(declarator) if declarator is not None else ""
        if not declared:
            self._add(path, "use", node, "declaration")
            return None
        target = declared if parent.kind_id == KIND.declaration else f"this.{declared}"
        self._add(path, "kept", node, target, type_=self._find_type(parent))
        return None

    def _climb_loop(self, path: str, at: Node, parent: Node, node: Node) -> tuple[str, Node] | None:
        """`for (T x : path)`."""
        declarator = parent.child_by_field_name("declarator")
        declared = self._name_declared(declarator) if declarator is not None else ""
        if declared:
            self._add(f"{path}.[]", "kept", node, declared, type_=self._find_type(parent))
        else:
            self._add(path, "use", node, "taken apart")
        return None

    def _climb_assignment(self, path: str, at: Node, parent: Node, node: Node) -> tuple[str, Node] | None:
        children = list_children(parent)
        if len(children) != 3:
            self._add(path, "use", node, "assignment")
            return None
        operator = self.spell(children[1])
        if children[0] == at:
            self._add(path, "write", node, operator)
            return None
        if operator != "=":
            self._add(path, "read", node, operator)
            return None
        target = self._spell_path(children[0])
        if target:
            self._add(path, "kept", node, target, type_="?")
        else:
            self._add(path, "use", node, "assigned to what is not followed")
        outer = parent.parent
        return None if outer is None or outer.kind_id == KIND.expression_statement else (path, parent)

    def _spell_path(self, node: Node) -> str:
        """The path of an expression that is one; empty for others."""
        if node.kind_id == KIND.identifier:
            return self.text[node.start_byte : node.end_byte]
        if node.kind_id == KIND.this:
            return "this"
        if node.kind_id == KIND.qualified_identifier:
            return strip_template(self.spell(node)).rpartition("::")[2]
        children = list_children(node)
        if node.kind_id == KIND.field_expression:
            inner = self._spell_path(children[0])
            return f"{inner}.{self.spell(children[-1])}" if inner else ""
        if node.kind_id == KIND.subscript_expression:
            inner = self._spell_path(children[0])
            return f"{inner}.[]" if inner else ""
        if node.kind_id in (KIND.parenthesized_expression, KIND.pointer_expression):
            return self._spell_path(children[1])
        if node.kind_id == KIND.call_expression and children[0].kind_id == KIND.field_expression:
            inner, method = list_children(children[0])[0], self.spell(children[0].children[-1])
            inner_path = self._spell_path(inner) if method in _ITERATED or method in POINTEES else ""
            return inner_path and (inner_path if method in POINTEES else f"{inner_path}.[]")
        return ""

    def _climb_return(self, path: str, at: Node, parent: Node, node: Node) -> tuple[str, Node] | None:
        self._add(path, "returned", node)
        return None

    def _climb_binary(self, path: str, at: Node, parent: Node, node: Node) -> tuple[str, Node] | None:
        children = list_children(parent)
        sign = self.spell(children[1]) if len(children) == 3 else "operator"
        other = (children[2] if children[0] == at else children[0]) if len(children) == 3 else None
        if sign in ("&&", "||", "and", "or") or (other is not None and sign in ("==", "!=") and self._is_end(other)):
            self._add(path, "test", node, sign)
        else:
            self._add(path, "read", node, sign)
        return None

    def _is_end(self, node: Node) -> bool:
        """Whether an expression is a null pointer, or where an iteration begins or ends."""
        if node.kind_id in LITERALS or self.text[node.start_byte : node.end_byte] in _NULLS:
            return self.text[node.start_byte : node.end_byte] in _NULLS
        if node.kind_id == KIND.call_expression and node.children[0].kind_id == KIND.field_expression:
            return self.spell(node.children[0].children[-1]) in _ENDS
        return False

    def _climb_unary(self, path: str, at: Node, parent: Node, node: Node) -> tuple[str, Node] | None:
        sign = self.spell(parent.children[0])
        self._add(path, "test" if sign in ("!", "not") else "read", node, sign)
        return None

    def _climb_update(self, path: str, at: Node, parent: Node, node: Node) -> tuple[str, Node] | None:
        self._add(path, "test" if "." not in path else "write", node, "++")
        return None

    def _climb_choice(self, path: str, at: Node, parent: Node, node: Node) -> tuple[str, Node] | None:
        if parent.child_by_field_name("condition") == at:
            self._add(path, "test", node, "?")
            return None
        return path, parent

    def _climb_test(self, path: str, at: Node, parent: Node, node: Node) -> tuple[str, Node] | None:
        self._add(path, "test", node, "a condition")
        return None

    def _climb_switch(self, path: str, at: Node, parent: Node, node: Node) -> tuple[str, Node] | None:
        self._add(path, "read", node, "a condition")
        return None

    def _climb_end(self, path: str, at: Node, parent: Node, node: Node) -> tuple[str, Node] | None:
        """A statement by itself; what a call gives is dropped."""
        return None

    def _climb_capture(self, path: str, at: Node, parent: Node, node: Node) -> tuple[str, Node] | None:
        """What a lambda captures is used in its body, under the same name; `[x = path]` gives it another."""
        if parent.kind_id == KIND.lambda_capture_initializer:
            name = self.spell(list_children(parent)[0]).lstrip("&")
            whole = parent.parent.parent if parent.parent is not None else None
            if at != list_children(parent)[0] and whole is not None:
                line = self.find_line(whole)
                where = f"lambda@{line}:{whole.start_byte - self.starts[line - 1] + 1}"
                self._add(path, "kept", node, name, type_=where)
        return None


def _collect_climbs() -> dict[int, _Climb]:
    reader = _Reader
    table = {
        "field_expression": reader._climb_member,
        "subscript_expression": reader._climb_index,
        "subscript_argument_list": reader._climb_subscript,
        "argument_list": reader._climb_arguments,
        "initializer_list": reader._climb_arguments,
        "init_declarator": reader._climb_initialiser,
        "declaration": reader._climb_declaration,
        "field_declaration": reader._climb_declaration,
        "for_range_loop": reader._climb_loop,
        "assignment_expression": reader._climb_assignment,
        "return_statement": reader._climb_return,
        "binary_expression": reader._climb_binary,
        "unary_expression": reader._climb_unary,
        "update_expression": reader._climb_update,
        "conditional_expression": reader._climb_choice,
        "lambda_capture_specifier": reader._climb_capture,
        "lambda_capture_initializer": reader._climb_capture,
    }
    table.update(dict.fromkeys(
        ("parenthesized_expression", "pointer_expression", "cast_expression", "comma_expression"), reader._climb_through
    ))
    table.update(dict.fromkeys(
        ("if_statement", "while_statement", "do_statement", "for_statement", "condition_clause", "case_statement"),
        reader._climb_test,
    ))
    table.update(dict.fromkeys(
        ("expression_statement", "compound_statement", "sizeof_expression", "decltype", "delete_expression",
         "static_assert_declaration"), reader._climb_end
    ))
    return {getattr(KIND, name): method for name, method in table.items()}


_CLIMBS = _collect_climbs()
