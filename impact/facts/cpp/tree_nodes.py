"""The names by which a C++ file registers nodes of behaviour trees with BehaviorTree.CPP.

A name is a literal among the first arguments of `registerNodeType`, `registerBuilder`, `registerSimpleAction` and its
sisters, of `CreateRosNodePlugin`, and of functions and macros that are called alike; or a constant of the same file.
"""

import re
import sys
from collections.abc import Callable, Iterator

import msgspec

from ..condition import Condition

COMPUTED = "*"
"""Stands for names that the file does not tell."""
SIGNS = ("registerNodeType", "registerBuilder", "registerSimple", "BT_REGISTER", "RosNodePlugin")
"""One of these stands in every file that registers nodes."""
_SURE = ("registerNodeType", "registerBuilder", "registerSimple")
_CALL = re.compile(
    r"\b(?P<called>\w*(?:[rR]egister|REGISTER)_?(?:\w*(?:[nN]ode|NODE)|Builder|Simple)\w*|CreateRosNodePlugin)"
    r"\s*(?:<(?P<class>[^;{}()]{0,300})>)?\s*\((?=\s*(?P<first>\w[\w:]*(?:\(\))?)?\s*(?P<end>[,)])?)"
)
_LITERAL = re.compile(r'\s*(?:[\w:.]{1,200}\s*,\s*){0,2}(?:std::string\s*[({]\s*)?"(?P<name>[^"\\\n]{1,200})"')


class RegisteredNode(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A name, or COMPUTED; its class as written, without blanks, empty where none is; and the conditions of the
    preprocessor that the registration stands under."""

    name: str
    type: str
    conditions: tuple[Condition, ...]


def list_tree_nodes(
    text: str, visible: str, find_conditions: Callable[[int], tuple[Condition, ...]]
) -> Iterator[RegisteredNode]:
    """The nodes that a file registers. text, visible: of its Scan. find_conditions: those around an offset."""
    if not any(sign in visible for sign in SIGNS):
        return
    for call in _CALL.finditer(visible):
        conditions = find_conditions(call.start())
        type_ = "".join((call["class"] or "").split())
        literal = _LITERAL.match(text, call.end())
        if literal is not None and visible[literal.end() - 1] == '"':
            yield RegisteredNode(sys.intern(literal["name"]), type_, conditions)
        elif call["called"].startswith(_SURE) and call["first"] and call["end"]:
            name = _find_constant(text, visible, call["first"].removesuffix("()").rpartition(":")[2])
            yield RegisteredNode(name or COMPUTED, type_, conditions)
        elif call["called"].startswith(_SURE) and text[call.end() : call.end() + 1] == "#":
            yield RegisteredNode(COMPUTED, type_, conditions)


def _find_constant(text: str, visible: str, name: str) -> str:
    """The literal that a file gives to a name; empty where there is none."""
    assigned = re.search(rf'\b{re.escape(name)}\s*(?:\[\]\s*)?[=({{]\s*(?=")', visible)
    literal = _LITERAL.match(text, assigned.end()) if assigned is not None else None
    return sys.intern(literal["name"]) if literal is not None else ""
