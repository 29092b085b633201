"""What a Python file does for each distro: names that it binds and what it starts in branches on ROS_DISTRO alone,
tables that it asks by it, names that it compares it with, and files that it names by it."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from ..condition import Condition
from ..distro_branches import VARIABLE, Branch, BranchedName, ComparedDistro
from ..place import Reference
from .text import format_dotted

DISTRO = "{distro}"
"""Stands in the name of a file for that of the distro."""
_LEAVING = frozenset(("exit", "quit", "_exit", "abort", "fail"))
_MOST_WAYS = 40
_DEEPEST = 40
_SCOPES = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef, ast.Lambda)


class _Way(NamedTuple):
    conditions: tuple[Condition, ...]
    body: Sequence[ast.stmt]


def list_branched_names(tree: ast.Module) -> Iterator[BranchedName]:
    """The names of a module and of its functions that are bound in branches on the distro alone, with the first use of
    each behind them; else where each branch of such an `if` starts something, and no `else` follows; and tables that
    are asked by the distro."""
    for scope in (tree, *(node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef))):
        machine = _find_machine_names(tree, scope)
        function = scope.name if isinstance(scope, ast.FunctionDef) else ""
        yield from _list_asked_tables(tree, scope, machine, function)
        for place, statement in enumerate(scope.body):
            if not isinstance(statement, ast.If):
                continue
            ways = list(_list_ways(statement, machine)) if _count_ways(statement) <= _MOST_WAYS else []
            if not any(VARIABLE in one.text for way in ways for one in way.conditions):
                continue
            starts = _list_starting(ways)
            inside = {name for way in ways for name in _list_bound(way.body)}
            outside = _find_bound_outside(scope, statement)
            for name in sorted(inside - outside):
                safe = [way for way in ways if name in _list_bound(way.body) or _leaves(way.body)]
                used = _find_use(scope.body[place + 1 :], name)
                if used is not None and len(safe) < len(ways):
                    branches = tuple(Branch(way.conditions) for way in safe)
                    yield BranchedName(name, used.lineno, used.col_offset + 1, branches, function)
                    starts = []
            if starts:
                branches = tuple(Branch(way.conditions) for way in starts)
                yield BranchedName(VARIABLE, statement.lineno, statement.col_offset + 1, branches, function, "start")


# Actions of launch that start something.
_STARTING = frozenset((
    "ComposableNode", "ComposableNodeContainer", "ExecuteProcess", "IncludeLaunchDescription", "LifecycleNode", "Node",
))  # fmt: skip


def _list_starting(ways: Sequence[_Way]) -> list[_Way]:
    """The ways of a chain of at least two tests of the distro, each of which starts something; none where one does not,
    or where something is done in all other cases."""
    *tested, last = ways or [_Way((), ())]
    if len(tested) < 2 or last.body or not all(VARIABLE in way.conditions[-1].text for way in tested):
        return []
    calls = ({format_dotted(node.func).rpartition(".")[2] for one in way.body for node in ast.walk(one)
              if isinstance(node, ast.Call)} for way in tested)  # fmt: skip
    return tested if not any(_STARTING.isdisjoint(names) for names in calls) else []


def _list_asked_tables(
    tree: ast.Module, scope: ast.Module | ast.FunctionDef, machine: dict[str, ast.expr], function: str
) -> Iterator[BranchedName]:
    """The tables that a module or function asks by the distro wherever it comes by."""
    bound: dict[str, list[ast.expr]] = {}
    for statement in (*tree.body, *(scope.body if scope is not tree else ())):
        if isinstance(statement, ast.Assign):
            for target in statement.targets:
                if isinstance(target, ast.Name):
                    bound.setdefault(target.id, []).append(statement.value)
    for node in _list_evaluated(scope.body):
        if not isinstance(node, ast.Subscript) or not isinstance(node.ctx, ast.Load):
            continue
        if not is_distro_read(node.slice) and not (isinstance(node.slice, ast.Name) and node.slice.id in machine):
            continue
        held = node.value
        name = held.id if isinstance(held, ast.Name) else VARIABLE
        values = bound.get(name, []) if isinstance(held, ast.Name) else [held]
        table = values[0] if len(values) == 1 else None
        if not isinstance(table, ast.Dict) or (name != VARIABLE and _is_changed(tree, name)):
            continue
        keys = [key.value for key in table.keys if isinstance(key, ast.Constant) and isinstance(key.value, str)]
        if keys and len(keys) == len(table.keys):
            tests = (Condition("python", f"os.environ['{VARIABLE}'] == {key!r}") for key in keys)
            branches = tuple(Branch((test,)) for test in tests)
            yield BranchedName(name, node.lineno, node.col_offset + 1, branches, function, "key")


def _is_changed(tree: ast.Module, name: str) -> bool:
    """Whether something may be added to a table, or a test asks what is in it."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Subscript) and isinstance(node.value, ast.Name) and node.value.id == name:
            if not isinstance(node.ctx, ast.Load):
                return True
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == name:
            return True
        elif isinstance(node, ast.Compare | ast.Call | ast.AugAssign):
            parts = (*node.comparators, node.left) if isinstance(node, ast.Compare) else ast.iter_child_nodes(node)
            if any(isinstance(part, ast.Name) and part.id == name for part in parts):
                return True
    return False


def _list_evaluated(body: Iterable[ast.stmt]) -> Iterator[ast.AST]:
    """What some statements evaluate in any case, up to one that may leave them."""
    for statement in body:
        if statement.__class__.__name__ in ("Try", "TryStar"):
            return  # it may be made for that
        if isinstance(statement, (ast.If, ast.For, ast.While, ast.With, ast.Match, *_SCOPES)):
            if any(isinstance(node, ast.Return | ast.Raise) for node in ast.walk(statement)):
                return
            continue
        waiting: list[ast.AST] = [statement]
        while waiting:
            node = waiting.pop(0)
            yield node
            # Only one side of these is evaluated, and what is in these when they are called.
            if not isinstance(node, (ast.IfExp, ast.BoolOp, *_SCOPES)):
                waiting.extend(ast.iter_child_nodes(node))
        if isinstance(statement, ast.Return | ast.Raise):
            return


def list_compared_distros(tree: ast.Module) -> Iterator[ComparedDistro]:
    """The texts that a module compares the distro with."""
    machine = _find_machine_names(tree, tree)
    for scope in ast.walk(tree):
        if isinstance(scope, ast.FunctionDef):
            machine.update(_find_machine_names(scope, scope))
    for node in ast.walk(tree):
        sides = (node.left, *node.comparators) if isinstance(node, ast.Compare) else ()
        if not any(is_distro_read(side) or (isinstance(side, ast.Name) and side.id in machine) for side in sides):
            continue
        for side in sides:
            for one in side.elts if isinstance(side, ast.Tuple | ast.List | ast.Set) else (side,):
                if isinstance(one, ast.Constant) and isinstance(one.value, str):
                    yield ComparedDistro(one.value, one.lineno, one.col_offset + 1)


def _find_machine_names(tree: ast.Module | ast.FunctionDef, scope: ast.Module | ast.FunctionDef) -> dict[str, ast.expr]:
    """Names that stand for the distro, with what reads it."""
    found: dict[str, list[ast.expr]] = {}
    for statement in (*tree.body, *(scope.body if scope is not tree else ())):
        if isinstance(statement, ast.Assign) and len(statement.targets) == 1:
            target = statement.targets[0]
            if isinstance(target, ast.Name):
                found.setdefault(target.id, []).append(statement.value)
    return {name: values[0] for name, values in found.items() if len(values) == 1 and is_distro_read(values[0])}


def is_distro_read(node: ast.expr) -> bool:
    """Whether an expression is the variable of the environment that names the distro."""
    if isinstance(node, ast.Subscript):
        key = node.slice
        asked = key.value if isinstance(key, ast.Constant) else None
        return asked == VARIABLE and format_dotted(node.value).endswith("environ")
    if not isinstance(node, ast.Call) or not node.args or not isinstance(node.args[0], ast.Constant):
        return False
    function = format_dotted(node.func)
    known = function.endswith(("environ.get", "getenv", "EnvironmentVariable"))
    return known and node.args[0].value == VARIABLE


class _Replacing(ast.NodeTransformer):
    def __init__(self, machine: dict[str, ast.expr]):
        self.machine = machine

    def visit_Name(self, node: ast.Name) -> ast.expr:
        return self.machine.get(node.id, node)


def _count_ways(node: ast.If) -> int:
    number = 2
    while len(node.orelse) == 1 and isinstance(node.orelse[0], ast.If):
        node, number = node.orelse[0], number + 1
    return number


def _list_ways(
    node: ast.If, machine: dict[str, ast.expr], before: tuple[Condition, ...] = ()
) -> Iterator[_Way]:
    """The ways through an `if` with all that follows by `elif` and `else`."""
    text = ast.unparse(_Replacing(machine).visit(ast.parse(ast.unparse(node.test), mode="eval").body))
    yield _Way((*before, Condition("python", text)), node.body)
    denied = (*before, Condition("python", text, True))
    if len(node.orelse) == 1 and isinstance(node.orelse[0], ast.If):
        yield from _list_ways(node.orelse[0], machine, denied)
    else:
        yield _Way(denied, node.orelse)


def _list_bound(body: Iterable[ast.stmt]) -> frozenset[str]:
    """Names that some statements may bind."""
    return frozenset(_iterate_bound(body))


def _iterate_bound(nodes: Iterable[ast.AST]) -> Iterator[str]:
    for node in nodes:
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store | ast.Del):
            yield node.id
        elif isinstance(node, ast.Import | ast.ImportFrom):
            yield from (alias.asname or alias.name.partition(".")[0] for alias in node.names)
        elif isinstance(node, ast.Global | ast.Nonlocal):
            yield from node.names
        elif isinstance(node, ast.ExceptHandler) and node.name:
            yield node.name
        if isinstance(node, _SCOPES):
            if not isinstance(node, ast.Lambda):
                yield node.name
        else:
            yield from _iterate_bound(ast.iter_child_nodes(node))


def _find_bound_outside(scope: ast.Module | ast.FunctionDef, branched: ast.If) -> frozenset[str]:
    """Names that a module or function binds elsewhere than in an `if`, its functions by `global` too."""
    names = set(_iterate_bound(one for one in scope.body if one is not branched))
    if isinstance(scope, ast.FunctionDef):
        arguments = scope.args
        every = (*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs, arguments.vararg, arguments.kwarg)
        names.update(one.arg for one in every if one is not None)
    for node in ast.walk(scope):
        if isinstance(node, ast.Global | ast.Nonlocal):
            names.update(node.names)
        elif isinstance(node, ast.ImportFrom) and any(alias.name == "*" for alias in node.names):
            names.update(one.id for one in ast.walk(scope) if isinstance(one, ast.Name))
    return frozenset(names)


def _leaves(body: Sequence[ast.stmt]) -> bool:
    """Whether what follows some statements is not reached, as far as their last one tells."""
    if not body:
        return False
    last = body[-1]
    if isinstance(last, ast.Return | ast.Raise | ast.Continue | ast.Break):
        return True
    return isinstance(last, ast.Expr) and isinstance(last.value, ast.Call) and (
        format_dotted(last.value.func).rpartition(".")[2] in _LEAVING
    )


def _find_use(body: Sequence[ast.stmt], name: str) -> ast.Name | None:
    """The first use of a name that some statements come by in any case."""
    names = (node for node in _list_evaluated(body) if isinstance(node, ast.Name) and node.id == name)
    return next((node for node in names if isinstance(node.ctx, ast.Load)), None)


def list_distro_files(tree: ast.Module) -> Iterator[Reference]:
    """Files that are named by the distro: the end of their path, as far as it is known, with DISTRO in it."""
    machine = _find_machine_names(tree, tree)
    for scope in ast.walk(tree):
        if isinstance(scope, ast.FunctionDef):
            machine.update(_find_machine_names(scope, scope))
    if any(isinstance(node, ast.Name) and node.id in _ASKING for node in ast.walk(tree)) or any(
        isinstance(node, ast.Attribute) and node.attr in _ASKING for node in ast.walk(tree)
    ):
        return
    waiting: list[ast.AST] = [tree]
    while waiting:
        node = waiting.pop()
        text = _read_path(node, machine) if isinstance(node, ast.expr) else ""
        if DISTRO not in text or not isinstance(node, ast.expr):
            waiting.extend(ast.iter_child_nodes(node))
            continue
        _, unknown, name = text.rpartition("\0")
        # What is glued to something unknown is not a whole name.
        whole = DISTRO in name and (not unknown or name.startswith("/"))
        if whole and "." in name.rpartition("/")[2] and not name.endswith(DISTRO):
            yield Reference("distro file", "", name.lstrip("/"), node.lineno, node.col_offset + 1)


# What asks whether a file is there.
_ASKING = frozenset(("exists", "isfile", "is_file", "listdir", "glob", "iterdir"))


def _read_path(node: ast.expr, machine: dict[str, ast.expr], depth: int = 0) -> str:
    """A path as an expression makes it: `\\0` for what is not known."""
    if depth > _DEEPEST:
        return "\0"
    if isinstance(node, ast.Constant):
        return node.value if isinstance(node.value, str) else "\0"
    if (isinstance(node, ast.Name) and node.id in machine) or is_distro_read(node):
        return DISTRO
    if isinstance(node, ast.JoinedStr):
        parts = (one.value if isinstance(one, ast.FormattedValue) else one for one in node.values)
        return "".join(_read_path(one, machine, depth + 1) for one in parts)
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Div):
        between = "/" if isinstance(node.op, ast.Div) else ""
        return between.join(_read_path(one, machine, depth + 1) for one in (node.left, node.right))
    function = format_dotted(node.func) if isinstance(node, ast.Call) else ""
    if isinstance(node, ast.Call) and function.endswith("path.join"):
        return "/".join(_read_path(one, machine, depth + 1) for one in node.args)
    if isinstance(node, ast.Call) and function.endswith("PathJoinSubstitution") and node.args:
        items = node.args[0].elts if isinstance(node.args[0], ast.List) else ()
        return "/".join(_read_path(one, machine, depth + 1) for one in items) or "\0"
    if isinstance(node, ast.List):  # substitutions that are put together
        return "".join(_read_path(one, machine, depth + 1) for one in node.elts)
    return "\0"
