"""What a launch file in Python holds while it is followed: text, lists, actions, functions, or what is unknown."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import msgspec
from msgspec import structs

from ..python.text import ARITHMETIC, COMPARISONS
from .actions import Action, ActionCondition, Value, ValuePart, make_literal


class TooMuch(Exception):
    """More than a launch file ever does; the message says what."""


class TextValue(NamedTuple):
    """Text, or a substitution. is_str: Python holds a str, so that it can be compared; a substitution is an object."""

    value: Value
    is_str: bool = True


class LaunchConstant(NamedTuple):
    """A number, bool or None."""

    value: Any


class Unknown(NamedTuple):
    """What cannot be followed; source: the expression."""

    source: str


class ConditionValue(NamedTuple):
    """An IfCondition and the like."""

    conditions: tuple[ActionCondition, ...]


class FilledFile(NamedTuple):
    """A ParameterFile with substitutions in it."""

    value: Value


class YamlContent(NamedTuple):
    """What a YAML file holds, below keys."""

    file: Value
    keys: tuple[Value, ...] = ()


class TypedValue(NamedTuple):
    """A ParameterValue: its value and the name of the type it is to have."""

    value: Any
    type: str


class ConditionalValue(NamedTuple):
    """A value that is only there under conditions."""

    value: Any
    conditions: tuple[ActionCondition, ...]


class Either(NamedTuple):
    """One of two values, as a condition decides."""

    condition: Value
    yes: Any
    no: Any


class LaunchModule(NamedTuple):
    """An imported module or name, as a dotted path."""

    path: str


class Method(NamedTuple):
    """A method taken from a value."""

    receiver: Any
    name: str


class LaunchFunction(NamedTuple):
    """A function of the file, with the names it sees and, for a method, its object."""

    node: ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda
    scope: LaunchScope
    self: Any = None


class Items(msgspec.Struct, eq=False):
    """A list, or as kind says a tuple or a LaunchDescription. depth: how many conditions stood when it was made."""

    items: list[Any]
    depth: int
    kind: str = "list"


class Pairs(msgspec.Struct, eq=False):
    """A dict, as pairs; a later pair of the same key replaces the earlier."""

    items: list[tuple[Any, Any]]
    depth: int

    def get(self, key: Any) -> Any:
        return next((value for known, value in reversed(self.items) if known == key), None)

    def set(self, key: Any, value: Any) -> None:
        for place, (known, _) in enumerate(self.items):
            if known == key:
                self.items[place] = (key, value)
                return
        self.items.append((key, value))


class LaunchClass(msgspec.Struct, eq=False):
    """A class of the file."""

    methods: dict[str, Any] = {}


class Object(msgspec.Struct, eq=False):
    """An object of a class of the file."""

    type: LaunchClass
    attributes: dict[str, Any] = {}


class LaunchScope(msgspec.Struct, eq=False):
    """Names and what they stand for. module: of the outermost scope of another file, its dotted name."""

    parent: LaunchScope | None
    names: dict[str, Any] = {}
    module: str = ""

    def find_module(self) -> str:
        """The dotted name of the file that it is in; empty for the launch file itself."""
        return self.module if self.parent is None else self.parent.find_module()

    def look(self, name: str) -> Any:
        if name in self.names or self.parent is None:
            return self.names.get(name)
        return self.parent.look(name)


class MoveItFile(NamedTuple):
    """A YAML file of a MoveIt configuration. below: the parameter that its content is under, None for none; on_disk:
    whether it is read hangs on what is there."""

    below: Value | None
    file: Value
    on_disk: bool = False


class MoveItConfig(msgspec.Struct, eq=False):
    """A MoveItConfigsBuilder, or what it builds (is_whole). path: what its methods are called below; folder: of its
    package; files: by section."""

    path: str
    folder: Value
    files: dict[str, list[MoveItFile]] = {}
    is_whole: bool = False
    attributes: dict[str, Any] = {}


class Context(NamedTuple):
    """The LaunchContext given to an OpaqueFunction, or its dict of configurations."""

    configurations: bool = False


def join_conditions(conditions: Sequence[ActionCondition]) -> Value:
    """Conditions as one value that is true when they all hold."""
    values = [c.value if c.kind != "unless" else (ValuePart("not", "", (c.value,)),) for c in conditions]
    return values[0] if len(values) == 1 else (ValuePart("and", "", tuple(values)),)


def add_conditions(value: Any, conditions: tuple[ActionCondition, ...]) -> Any:
    """A value under conditions, itself where there are none."""
    inner, more = split_conditions(value)
    return ConditionalValue(inner, (*conditions, *more)) if conditions else value


def split_conditions(value: Any) -> tuple[Any, tuple[ActionCondition, ...]]:
    """A value without the conditions that it stands under, and these."""
    return (value.value, value.conditions) if isinstance(value, ConditionalValue) else (value, ())


def list_branches(
    value: Any, line: int, extra: tuple[ActionCondition, ...] = ()
) -> Iterator[tuple[Any, tuple[ActionCondition, ...]]]:
    """What a value may be, with the conditions under which it is; nothing for one that is left out."""
    value, more = split_conditions(value)
    conditions = (*extra, *more)
    if isinstance(value, ConditionalValue):
        yield from list_branches(value, line, conditions)
    elif isinstance(value, Either):
        yield from list_branches(value.yes, line, (*conditions, ActionCondition("if", value.condition, line)))
        yield from list_branches(value.no, line, (*conditions, ActionCondition("unless", value.condition, line)))
    elif is_given(value):
        yield value, conditions


def is_given(value: Any) -> bool:
    """False for an argument that is left out or None."""
    return value is not None and value != LaunchConstant(None)


def add_action_conditions(action: Action, conditions: tuple[ActionCondition, ...]) -> Action:
    """An action under more conditions around its own."""
    return structs.replace(action, conditions=(*conditions, *action.conditions)) if conditions else action


def find_index(holder: Items, key: Any) -> int | None:
    """The place in a list that an index means, None when it is not known to be there."""
    if not isinstance(key, LaunchConstant) or not isinstance(key.value, int):
        return None
    return key.value if -len(holder.items) <= key.value < len(holder.items) else None


@lru_cache(maxsize=8192)
def get_source(node: ast.AST) -> str:
    """What a node says, in one line and cut short."""
    try:
        return " ".join(ast.unparse(node).split())[:120]
    except (RecursionError, ValueError, AttributeError):
        return type(node).__name__


def calculate_result(node: ast.BinOp | ast.Compare, left: Any, right: Any) -> Any:
    """Small sums and comparisons of known numbers."""
    op = node.op if isinstance(node, ast.BinOp) else node.ops[0]
    calculate = ARITHMETIC.get(type(op)) or COMPARISONS.get(type(op))
    if calculate is None or left is None or right is None:
        return Unknown(get_source(node))
    try:
        value = calculate(left, right)
    except (ArithmeticError, TypeError, ValueError):
        return Unknown(get_source(node))
    return LaunchConstant(value) if abs(value) < 2**60 else Unknown(get_source(node))


def make_parent_path(value: Value) -> Value:
    """The folder that a path lies in."""
    if value == (ValuePart("filename"),):
        return (ValuePart("dirname"),)
    return (ValuePart("join", "", (value, make_literal(".."))),)


NOTHING = Unknown("nothing()")
