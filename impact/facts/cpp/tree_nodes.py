"""The nodes of behaviour trees that a C++ file registers with BehaviorTree.CPP, and the ports that its classes have.

A name is a literal among the first arguments of `registerNodeType`, `registerBuilder`, `registerSimpleAction` and its
sisters, of `CreateRosNodePlugin`, and of functions and macros that are called alike; or a constant of the same file.

A class has the ports that its static function `providedPorts()` names, or that of a base class. Nothing is run: such a
function may return what literals name and what other functions of the kind return; of any other nothing is known.
"""

import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cached_property

import msgspec

from ..condition import Condition

COMPUTED = "*"
"""Stands for names that the file does not tell."""
SIGNS = ("registerNodeType", "registerBuilder", "registerSimple", "BT_REGISTER", "RosNodePlugin")
"""One of these stands in every file that registers nodes."""
PORTS = "providedPorts"
"""The function that a factory asks for the ports of a class."""
_SURE = ("registerNodeType", "registerBuilder", "registerSimple")
_CALL = re.compile(
    r"\b(?P<called>\w*(?:[rR]egister|REGISTER)_?(?:\w*(?:[nN]ode|NODE)|Builder|Simple)\w*|CreateRosNodePlugin)"
    r"\s*(?:<(?P<class>[^;{}()]{0,300})>)?\s*\((?=\s*(?P<first>\w[\w:]*(?:\(\))?)?\s*(?P<end>[,)])?)"
)
_LITERAL = re.compile(r'\s*(?:[\w:.]{1,200}\s*,\s*){0,2}(?:std::string\s*[({]\s*)?"(?P<name>[^"\\\n]{1,200})"')


class RegisteredNode(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A name, or COMPUTED; its class as written, without blanks, empty where none is; and the conditions of the
    preprocessor that the registration stands under. extended: more may be registered than the ports of the class."""

    name: str
    type: str
    conditions: tuple[Condition, ...] = ()
    extended: bool = False

    @property
    def class_name(self) -> str:
        """The last part of the class's name; empty where its ports are not those of the node."""
        return "" if self.extended else find_last_name(self.type)


class NodeClass(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A class that may be one of a node. name: the last part of its name. bases: the same of its base classes. own: it
    has a function `providedPorts`."""

    name: str
    bases: tuple[str, ...]
    own: bool


class PortFunction(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A static function that returns ports: the class that it is of, empty for none, and its own name. ports: that it
    names. calls: (class, function) that it calls for more, the class empty where none is written, or (`*`, ``) where
    nothing tells all that it returns."""

    of: str
    name: str
    ports: tuple[str, ...]
    calls: tuple[tuple[str, str], ...]


class TreeNodes(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """What a file, or a package, tells of nodes of behaviour trees. Each once, and sorted."""

    nodes: tuple[RegisteredNode, ...] = ()
    classes: tuple[NodeClass, ...] = ()
    functions: tuple[PortFunction, ...] = ()


def merge_tree_nodes(found: Iterable[TreeNodes]) -> TreeNodes:
    """What several files tell together."""
    nodes: set[RegisteredNode] = set()
    classes: set[NodeClass] = set()
    functions: set[PortFunction] = set()
    for one in found:
        nodes.update(one.nodes)
        classes.update(one.classes)
        functions.update(one.functions)
    return TreeNodes(
        tuple(sorted(nodes, key=repr)), tuple(sorted(classes, key=repr)), tuple(sorted(functions, key=repr))
    )


def mark_extended(found: TreeNodes) -> TreeNodes:
    """The same, with nodes whose ports are not known, as of those that tests and examples register: others may be
    called like them."""
    nodes = (msgspec.structs.replace(node, extended=True) for node in found.nodes)
    return msgspec.structs.replace(found, nodes=tuple(nodes))


UNKNOWN_CALL = (COMPUTED, "")


def find_last_name(type_: str) -> str:
    """The last part of a class's name, without arguments of a template."""
    return type_.partition("<")[0].rpartition("::")[2]


def list_tree_nodes(
    text: str, visible: str, find_conditions: Callable[[int], tuple[Condition, ...]]
) -> Iterator[RegisteredNode]:
    """The nodes that a file registers. text, visible: of its Scan. find_conditions: those around an offset."""
    if not any(sign in visible for sign in SIGNS):
        return
    constants = _Constants(text, visible)
    for call in _CALL.finditer(visible):
        conditions = find_conditions(call.start())
        type_ = "".join((call["class"] or "").split())
        literal = _LITERAL.match(text, call.end())
        sure = call["called"].startswith(_SURE)
        if literal is not None and visible[literal.end() - 1] == '"':
            more = _FOLLOWED.match(visible, literal.end()) is not None and "Builder" not in call["called"]
            extended = sure and (more or call["called"].startswith("registerSimple"))
            if not type_ and not sure and call["first"] and call["end"] == ",":
                type_ = call["first"]  # CreateRosNodePlugin(Class, "Name")
            yield RegisteredNode(sys.intern(literal["name"]), type_, conditions, extended)
        elif sure and call["first"] and call["end"]:
            name = constants.find(call["first"].removesuffix("()").rpartition(":")[2])
            extended = call["end"] == "," and "Builder" not in call["called"]
            yield RegisteredNode(name or COMPUTED, type_, conditions, extended)
        elif sure and (text[call.end() : call.end() + 1] == "#" or _is_call(visible, call)):
            yield RegisteredNode(COMPUTED, type_, conditions)


_FOLLOWED = re.compile(r"\s*[)}]?\s*,")


def _is_call(visible: str, call: re.Match[str]) -> bool:
    """Whether a function of an object is called, rather than declared, and given something."""
    before = visible[max(0, call.start() - 200) : call.start()].rstrip().removesuffix("template").rstrip()
    return before.endswith((".", "->")) and _SOMETHING.match(visible, call.end()) is not None


_SOMETHING = re.compile(r"\s*\S")
_GIVEN = re.compile(r'\b(\w+)\s*(?:\[\]\s*)?[=({]\s*(?=")')


class _Constants:
    """The literals that a file gives to names. text, visible: of its Scan."""

    def __init__(self, text: str, visible: str):
        self._text, self._visible = text, visible

    @cached_property
    def _given(self) -> dict[str, str]:
        found: dict[str, str] = {}
        for given in _GIVEN.finditer(self._visible):
            literal = _LITERAL.match(self._text, given.end())
            if literal is not None:
                found.setdefault(given[1], sys.intern(literal["name"]))
        return found

    def find(self, name: str) -> str:
        """The literal of a name; empty where there is none."""
        return self._given.get(name, "")


_CLASS = re.compile(
    r"\b(?:class|struct)\s+(?:[A-Z_]+\s+)?(?P<name>(?!final\b)\w+)\s*(?:final\s*)?(?::(?!:)(?P<bases>[^;{}()]{1,1000}))?\{"
)
# One of these stands in every file that defines classes of nodes; far faster to look for than an expression.
_NODES = ("TreeNode", "ActionNode", "ConditionNode", "DecoratorNode", "ControlNode", "LeafNode", "ServiceNode")
_NODE_SIGNS = ("BT::", "PortsList", "namespace BT", *_NODES)
_FUNCTION = re.compile(
    r"\b(?:PortsList|auto)\s+(?:(?P<of>\w+)\s*(?:<[^;{}()]{0,200}>\s*)?::\s*)?(?P<name>\w+)\s*"
    r"\((?P<parameters>[^;{}]{0,500}?)\)\s*(?:noexcept\s*)?\{"
)
_PARAMETER = re.compile(r"(\w+)\s*(?:=[^,]*)?(?:,|\Z)")


def list_node_classes(text: str, visible: str) -> tuple[tuple[NodeClass, ...], tuple[PortFunction, ...]]:
    """The classes of a file that may be nodes, and its functions that return ports. text, visible: of its Scan."""
    if not any(sign in visible for sign in _NODE_SIGNS):
        return (), ()
    ends = _pair_brackets(visible)
    constants = _Constants(text, visible)
    found: list[tuple[int, int, str]] = []
    classes: dict[NodeClass, None] = {}
    for match in _CLASS.finditer(visible):
        start = match.end() - 1
        end = ends.get(start, start)
        found.append((start, end, match["name"]))
        bases = _split_bases(match["bases"] or "")
        own = visible.find(PORTS, start, end) >= 0
        if bases or own or match["name"].endswith(_NODES):
            classes[NodeClass(sys.intern(match["name"]), bases, own)] = None
    functions: dict[PortFunction, None] = {}
    inside: list[tuple[int, str]] = []
    todo = iter(found)
    following = next(todo, None)
    for match in _FUNCTION.finditer(visible) if "PortsList" in visible else ():
        while following is not None and following[0] < match.start():
            inside.append(following[1:])
            following = next(todo, None)
        while inside and inside[-1][0] < match.start():
            inside.pop()
        if not _OF_PORTS.search(match["name"]):
            continue
        of = match["of"] or (inside[-1][1] if inside else "")
        start = match.end() - 1
        parameters = frozenset(_PARAMETER.findall(match["parameters"]))
        ports, calls = _read_body(text, visible, (start + 1, ends.get(start, start)), ends, constants, parameters)
        functions[PortFunction(sys.intern(of), sys.intern(match["name"]), ports, calls)] = None
    return tuple(sorted(classes, key=repr)), tuple(sorted(functions, key=repr))


_BRACKET = re.compile(r"[(){}]")
_OPENING = {")": "(", "}": "{"}


def _pair_brackets(visible: str) -> dict[int, int]:
    """Where each parenthesis and brace that opens is closed."""
    opened: dict[str, list[int]] = {"(": [], "{": []}
    found: dict[int, int] = {}
    for match in _BRACKET.finditer(visible):
        bracket = match.group()
        if bracket in opened:
            opened[bracket].append(match.start())
        elif opened[_OPENING[bracket]]:
            found[opened[_OPENING[bracket]].pop()] = match.start()
    return found


_ACCESS = re.compile(r"\b(?:public|protected|private|virtual)\b")


def _split_bases(bases: str) -> tuple[str, ...]:
    """The last parts of the names of base classes, without arguments of templates."""
    found, depth = [""], 0
    for char in bases:
        depth += (char == "<") - (char == ">")
        if char == "," and depth == 0:
            found.append("")
        elif depth == 0 and char != ">":
            found[-1] += char
    names = ("".join(_ACCESS.sub("", one).split()).rpartition("::")[2] for one in found)
    return tuple(sys.intern(name) for name in names if name)


_CALLED = re.compile(
    r"(?:\b(?P<of>\w+)\s*(?:<[^;{}()]{0,300}>\s*)?::\s*)?\b(?P<name>\w+)\s*(?:<[^;{}()]{0,300}>\s*)?\("
)
_PORT = re.compile(r"\w*(?:Input|Output|Bidirectional)Port\Z")
_NAME = re.compile(r'\s*"(?P<name>[^"\\\n]{1,200})"\s*[,)]')
_FIRST = re.compile(r"\s*(?P<first>[A-Za-z_][\w:]*)\s*[,)]")
# What moves ports about and makes none; a superset of the ports is what counts.
_HARMLESS = frozenset(
    ("insert", "begin", "end", "cbegin", "cend", "merge", "move", "PortsList", "erase", "if", "for", "while", "reserve")
)


def _is_alone(visible: str, call: re.Match[str]) -> bool:
    """Whether a call without arguments is a statement of its own, as those that describe types to editors are."""
    before = visible[max(0, call.start() - 200) : call.start()].rstrip().removesuffix("BT::").rstrip()
    return before.endswith((";", "{", "}")) and _NO_ARGUMENTS.match(visible, call.end()) is not None


_NO_ARGUMENTS = re.compile(r"\s*\)\s*;")
_OF_PORTS = re.compile("[pP]orts")
_RETURN = re.compile(r"\breturn\s+(?P<name>[A-Za-z_]\w*)\s*;")


def _read_body(
    text: str,
    visible: str,
    span: tuple[int, int],
    ends: Mapping[int, int],
    constants: _Constants,
    parameters: frozenset[str],
) -> tuple[tuple[str, ...], tuple[tuple[str, str], ...]]:
    """The ports and calls of PortFunction. span: of the body. ends: where brackets are closed. parameters: what its
    callers give, so that it counts there."""
    ports: dict[str, None] = {}
    calls: dict[tuple[str, str], None] = {}
    at, end = span
    while (call := _CALLED.search(visible, at, end)) is not None:
        at = call.end()
        if _PORT.match(call["name"]):
            literal, first = _NAME.match(text, at), _FIRST.match(visible, at, end)
            name = literal["name"] if literal is not None else ""
            if not name and first is not None:
                name = constants.find(first["first"].rpartition(":")[2])
            if name:
                ports[sys.intern(name)] = None
            else:
                calls[UNKNOWN_CALL] = None
            at = min(ends.get(at - 1, end), end)
        elif call["name"] not in _HARMLESS and not _is_alone(visible, call):
            known = _OF_PORTS.search(call["name"]) is not None
            calls[(sys.intern(call["of"] or ""), sys.intern(call["name"])) if known else UNKNOWN_CALL] = None
    body = visible[slice(*span)]
    for returned in _RETURN.finditer(body):
        name = returned["name"]
        local = re.search(rf"(?:PortsList|auto)\s*&?\s*{re.escape(name)}\b", body)
        if name not in parameters and not local:
            calls[UNKNOWN_CALL] = None
    if "return" not in body:
        calls[UNKNOWN_CALL] = None
    return tuple(sorted(ports)), tuple(sorted(calls))
