"""What classes and modules do with names and members, read off their syntax trees once for all ways."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from functools import cache
from typing import NamedTuple

from .modules import PythonClass

_CHANGES = frozenset(("append", "extend", "pop", "clear", "insert", "add", "update", "popleft", "remove"))


class Habits(NamedTuple):
    """What the methods of a class do with members of their object. written: names, by the methods that set them; read:
    the same."""

    written: Mapping[str, frozenset[str]]
    read: Mapping[str, frozenset[str]]


def describe_class(cls: PythonClass) -> Habits:
    """Which methods of a class write and read which members."""
    return _describe(tuple(one.node for one in cls.list_order()))


@cache
def _describe(classes: tuple[ast.ClassDef, ...]) -> Habits:
    written: dict[str, set[str]] = {}
    read: dict[str, set[str]] = {}
    for one in classes:
        for method in one.body:
            if isinstance(method, (ast.FunctionDef, ast.AsyncFunctionDef)):
                for name, is_written in _list_members(method):
                    (written if is_written else read).setdefault(name, set()).add(method.name)
    return Habits(*({name: frozenset(by) for name, by in rows.items()} for rows in (written, read)))


def _list_members(method: ast.FunctionDef | ast.AsyncFunctionDef) -> Iterator[tuple[str, bool]]:
    own = method.args.args[0].arg if method.args.args else ""

    def is_own(node: ast.AST) -> bool:
        return isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == own

    for node in ast.walk(method):
        inner: ast.AST | None = None
        if isinstance(node, ast.Attribute) and is_own(node):
            yield node.attr, isinstance(node.ctx, ast.Store)
        elif isinstance(node, ast.Subscript) and isinstance(node.ctx, ast.Store):
            inner = node.value
        elif isinstance(node, ast.AugAssign):
            inner = node.target
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in _CHANGES:
            inner = node.func.value
        if isinstance(inner, ast.Attribute) and is_own(inner):
            yield inner.attr, True


def list_called_by(cls: PythonClass, name: str) -> frozenset[str]:
    """A method, and those that only it calls, as far as the class shows."""
    return _list_called(tuple(one.node for one in cls.list_order()), name)


@cache
def _list_called(classes: tuple[ast.ClassDef, ...], name: str) -> frozenset[str]:
    named: dict[str, set[str]] = {}
    called: dict[str, set[str]] = {}
    methods = [each for one in classes for each in one.body if isinstance(each, ast.FunctionDef)]
    for method in methods:
        for node in ast.walk(method):
            if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "self":
                named.setdefault(node.attr, set()).add(method.name)
            elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
                called.setdefault(method.name, set()).add(node.func.attr)
    own = {method.name for method in methods}
    found = {name}
    while True:
        direct = {each for method in found for each in called.get(method, ())}
        more = {each for each in direct & own - found if each in named and named[each] <= found}
        if not more:
            return frozenset(found)
        found |= more


@cache
def list_set_globals(tree: ast.Module) -> frozenset[str]:
    """Names of a module that one of its functions sets after `global`."""
    found: set[str] = set()
    for function in ast.walk(tree):
        if isinstance(function, (ast.FunctionDef, ast.AsyncFunctionDef)):
            given = list_outer_names(function)
            found |= {
                node.id
                for node in (ast.walk(function) if given else ())
                if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store) and node.id in given
            }
    return frozenset(found)


@cache
def list_read_attributes(tree: ast.Module) -> frozenset[str]:
    """Names of the members that are read somewhere in a module."""
    return frozenset(
        one.attr for one in ast.walk(tree) if isinstance(one, ast.Attribute) and isinstance(one.ctx, ast.Load)
    )


@cache
def list_read_names(tree: ast.Module, without: ast.AST) -> frozenset[str]:
    """Names that a module reads, but for one function."""
    inside = set(ast.walk(without))
    return frozenset(
        one.id for one in ast.walk(tree)
        if isinstance(one, ast.Name) and isinstance(one.ctx, ast.Load) and one not in inside
    )  # fmt: skip


@cache
def list_outer_names(node: ast.AST) -> frozenset[str]:
    """Names that `global` and `nonlocal` give to an outer scope in a function."""
    return frozenset(
        name for one in ast.walk(node) if isinstance(one, (ast.Global, ast.Nonlocal)) for name in one.names
    )


@cache
def has_yield(node: ast.AST) -> bool:
    """Whether a function is a generator or a coroutine."""
    stack = list(ast.iter_child_nodes(node))
    while stack:
        one = stack.pop()
        if isinstance(one, (ast.Yield, ast.YieldFrom, ast.Await)):
            return True
        if not isinstance(one, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda, ast.ClassDef)):
            stack.extend(ast.iter_child_nodes(one))
    return False


@cache
def list_stored(statement: ast.stmt) -> tuple[tuple[str, ...], tuple[ast.Attribute, ...]]:
    """The names and the members that a statement sets, wherever in it."""
    names: dict[str, None] = {}
    members: list[ast.Attribute] = []
    for node in ast.walk(statement):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            names[node.id] = None
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            members.append(node)
    return tuple(names), tuple(members)


_LOOKS = frozenset(
    ("len", "range", "sorted", "enumerate", "zip", "min", "max", "sum", "str", "int", "float", "bool", "print", "list",
     "tuple", "set", "dict", "isinstance", "any", "all", "repr", "reversed", "map", "filter", "type", "id", "hasattr")
)  # fmt: skip


def list_handed(statement: ast.stmt) -> tuple[ast.expr, ...]:
    """The names and members that a statement calls methods of or hands to functions: what they hold may be changed in
    place. What the functions of Python do that only look is left out."""
    found: list[ast.expr] = []
    for node in ast.walk(statement):
        if not isinstance(node, ast.Call):
            continue
        if isinstance(node.func, ast.Attribute):
            found.append(node.func.value)
        if not (isinstance(node.func, ast.Name) and node.func.id in _LOOKS):
            found += [*node.args, *(each.value for each in node.keywords)]
    return tuple(one for one in found if isinstance(one, (ast.Name, ast.Attribute)))
