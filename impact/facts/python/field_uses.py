"""What Python functions do with variables and what is below them: every name is looked at where it stands.

As for C++: the nodes around a name are asked from the inside outwards, and what is not known is a `use` of all that the
name holds.
"""

from __future__ import annotations

import ast
from collections import Counter

from ..field_uses import TYPE_TESTS, FieldFile, FieldFunction, PathUse
from ..place import Problem
from .source import read
from .text import SourceText

_THROUGH = frozenset(("copy", "deepcopy", "copy.copy", "copy.deepcopy", "list", "tuple", "reversed", "iter", "sorted",
                      "next", "cast", "typing.cast", "set"))  # fmt: skip
_TESTS = frozenset(("isinstance", "type", "id", "callable", "issubclass"))
_ADDS = frozenset(("append", "appendleft", "add", "put", "insert", "put_nowait", "push", "extend"))
_CHANGES = frozenset(("append", "extend", "insert", "clear", "reverse", "appendleft"))
_TAKES = frozenset(("pop", "popleft", "get", "get_nowait", "setdefault"))
_VIEWS = frozenset(("copy", "values"))
# What calls a function with each element of what it is given.
_CHOICES = frozenset(("max", "min"))
_PASSES = frozenset(("map", "filter"))
_FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)
_MOST_STEPS = 200
_LONGEST = 80


def extract(data: bytes) -> FieldFile:
    """What one Python file does with variables, Python 2 included as far as it can be rewritten. Never raises."""
    source = read(data)
    lines = source.parsed.count("\n") + 1
    if source.tree is None:
        return FieldFile("python", unread=((1, lines),), problems=source.problems)
    reader = _Reader(source.parsed)
    try:
        reader.read_module(source.tree)
    except RecursionError:
        return FieldFile("python", unread=((1, lines),), problems=(Problem(1, "nested too deeply to be read"),))
    return FieldFile("python", tuple(one for one in reader.functions if one.uses), problems=source.problems)


def _list_texts(tree: ast.Module) -> dict[str, str]:
    """The texts of names that a file gives a value once, at its top."""
    found = {
        target.id: node.value.value
        for node in tree.body
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)
        for target in node.targets
        if isinstance(target, ast.Name)
    }
    if not found:
        return {}
    # Whatever else may give a name a value: assignments, parameters, imports, patterns, functions and classes.
    given: Counter[str] = Counter()
    for node in ast.walk(tree):
        if isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load):
            given[node.id] += 1
        elif isinstance(node, ast.arg):
            given[node.arg] += 1
        elif isinstance(node, ast.alias):
            given[(node.asname or node.name).partition(".")[0]] += 1
            given.update(tuple(found) if node.name == "*" else ())
        elif isinstance(node, (ast.Global, ast.Nonlocal)):
            given.update(node.names)
        else:
            name = getattr(node, "name", None) or getattr(node, "rest", None)
            given.update((name,) if isinstance(name, str) else ())
    return {name: text for name, text in found.items() if given[name] == 1}


class _Reader(SourceText):
    """The reader of a file."""

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self.functions: list[FieldFunction] = []
        self.uses: list[PathUse] = []
        # Names by which the functions around know their object.
        self.own: tuple[str, ...] = ()
        self.parents: dict[ast.AST, ast.AST] = {}
        # Texts of names that stand for one alone in the whole file.
        self.texts: dict[str, str] = {}

    def read_module(self, tree: ast.Module) -> None:
        """The whole file."""
        for node in ast.walk(tree):
            for child in ast.iter_child_nodes(node):
                self.parents[child] = node
        self.texts = _list_texts(tree)
        self._walk_children(tree)
        self.functions.insert(0, FieldFunction("", 0, 0, tuple(self.uses)))

    def _walk_children(self, node: ast.AST) -> None:
        for child in ast.iter_child_nodes(node):
            self._walk(child)

    def _walk(self, node: ast.AST) -> None:
        if isinstance(node, (*_FUNCTIONS, ast.Lambda)):
            self._walk_function(node)
            return
        if isinstance(node, ast.Name):
            if not isinstance(node.ctx, ast.Store):
                self._look("this" if node.id in self.own else node.id, node)
        elif isinstance(node, ast.Call):
            name = _find_name(node.func)
            if name and name not in _THROUGH:
                self._look(f"{name}()", node)
        if isinstance(node, ast.AnnAssign):
            for part in (node.target, node.value):
                if part is not None:
                    self._walk(part)
            return
        self._walk_children(node)

    def _walk_function(self, node: ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda) -> None:
        arguments = node.args
        for default in (*arguments.defaults, *filter(None, arguments.kw_defaults)):
            self._walk(default)
        for decorator in getattr(node, "decorator_list", ()):
            self._walk(decorator)
        before, own = self.uses, self.own
        self.uses = []
        every = [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs]
        if isinstance(node, ast.Lambda):
            name = f"lambda@{node.lineno}:{self.find_column(node.lineno, node.col_offset)}"
        else:
            name = node.name
            if isinstance(self.parents.get(node), ast.ClassDef) and every and not _is_static(node):
                self.own = (*own, every[0].arg)
                every = every[1:]
        hidden = {one.arg for one in every}
        self.own = tuple(one for one in self.own if one not in hidden)
        for part in [node.body] if isinstance(node, ast.Lambda) else node.body:
            self._walk(part)
        if self.uses:
            self.functions.append(FieldFunction(name, node.lineno, node.end_lineno or node.lineno, tuple(self.uses)))
        self.uses, self.own = before, own

    # One name

    def _add(
        self, path: str, how: str, node: ast.AST, to: str = "", place: int = 0, count: int = 0, type_: str = ""
    ) -> None:
        if path == "this" or (how in ("test", "size") and "." not in path and to not in TYPE_TESTS):
            return  # it reads nothing
        self.uses.append(PathUse(path, how, node.lineno, to[:_LONGEST], place, count, type_[:200]))  # type: ignore

    def _look(self, path: str, node: ast.expr) -> None:
        """Notes what is done with a name, or with what a call gives."""
        at: ast.AST = node
        for _ in range(_MOST_STEPS):
            parent = self.parents.get(at)
            if parent is None:
                return
            step = self._climb(path, at, parent, node)
            if step is None:
                return
            path, at = step
        self._add(path, "use", node, "too deep")

    def _climb(self, path: str, at: ast.AST, parent: ast.AST, node: ast.AST) -> tuple[str, ast.AST] | None:
        """What the node around an expression makes of it: a path that goes on and the node it is now, or None where it
        ended, and was noted."""
        if isinstance(parent, ast.Attribute):
            return self._climb_attribute(path, parent, node)
        if isinstance(parent, ast.Subscript):
            return self._climb_subscript(path, at, parent, node)
        if isinstance(parent, ast.Call):
            return self._climb_call(path, at, parent, node)
        if isinstance(parent, (ast.Await, ast.NamedExpr, ast.Starred)) or _gives_value(parent, at):
            if isinstance(parent, ast.NamedExpr):
                self._add(path, "kept", node, parent.target.id)
            if isinstance(parent, ast.Starred):
                self._add(path, "use", node, "taken apart")
                return None
            return path, parent
        if isinstance(parent, ast.keyword):
            return self._climb_keyword(path, parent, node)
        if isinstance(parent, (ast.Assign, ast.AnnAssign)):
            self._end_assigned(path, parent, node)
        elif isinstance(parent, (ast.Tuple, ast.List)):
            self._end_listed(path, at, parent, node)
        elif isinstance(parent, (ast.For, ast.AsyncFor, ast.comprehension)) and parent.iter is at:
            self._end_iterated(path, parent.target, node)
        elif isinstance(parent, ast.Return) or (isinstance(parent, ast.Lambda) and parent.body is at):
            self._add(path, "returned", node)
        elif isinstance(parent, ast.Compare):
            others = [parent.left, *parent.comparators]
            none = any(isinstance(other, ast.Constant) and other.value is None for other in others)
            self._add(path, "test" if none else "read", node, "compared")
        elif isinstance(parent, (ast.If, ast.While, ast.IfExp, ast.Assert, ast.BoolOp)) or (
            isinstance(parent, ast.UnaryOp) and isinstance(parent.op, ast.Not)
        ):
            self._add(path, "test", node, "a condition")
        elif isinstance(parent, (ast.BinOp, ast.UnaryOp, ast.FormattedValue, ast.Slice, ast.AugAssign)):
            how = "write" if isinstance(parent, ast.AugAssign) and parent.target is at else "read"
            self._add(path, how, node, "+=" if how == "write" else "an operator")
        elif isinstance(parent, ast.Delete):
            self._add(path, "write", node, "del")
        elif not isinstance(parent, (ast.Expr, ast.Global, ast.Nonlocal)):
            self._add(path, "use", node, type(parent).__name__)
        return None

    def _climb_attribute(self, path: str, parent: ast.Attribute, node: ast.AST) -> tuple[str, ast.AST] | None:
        outer = self.parents.get(parent)
        if isinstance(outer, ast.Call) and outer.func is parent:
            if parent.attr in _TAKES or parent.attr in _VIEWS:
                return (path if parent.attr in _VIEWS else f"{path}.[]"), outer
            if parent.attr == "sort" and self._pass_to_key(path, outer, node):
                return None
            self._add(path, "change" if parent.attr in _CHANGES else "method", node, parent.attr)
            return None
        if isinstance(parent.ctx, ast.Store) and not isinstance(outer, ast.AugAssign):
            self._add(f"{path}.{parent.attr}", "write", node, "=")
            return None
        return f"{path}.{parent.attr}", parent

    def _climb_subscript(
        self, path: str, at: ast.AST, parent: ast.Subscript, node: ast.AST
    ) -> tuple[str, ast.AST] | None:
        if parent.value is not at:
            self._add(path, "read", node, "an index")
            return None
        element = path if isinstance(parent.slice, ast.Slice) else f"{path}.[]"
        if isinstance(parent.ctx, ast.Store) and not isinstance(self.parents.get(parent), ast.AugAssign):
            self._add(element, "write", node, "=")
            return None
        return element, parent

    def _find_text(self, node: ast.expr) -> str:
        """The text that an expression always is, empty where it may be another."""
        if isinstance(node, ast.Name):
            return self.texts.get(node.id, "")
        return str(node.value) if isinstance(node, ast.Constant) else ""

    def _climb_call(self, path: str, at: ast.AST, call: ast.Call, node: ast.AST) -> tuple[str, ast.AST] | None:
        if call.func is at:
            self._add(path, "use", node, "called")
            return None
        callee = _spell(call.func, self.own)
        name = self._find_text(call.args[1]) if len(call.args) > 1 and call.args[0] is at else ""
        if callee == "getattr" and name:
            return f"{path}.{name}", call
        if callee == "hasattr":
            if name:
                self._add(f"{path}.{name}", "test", node, callee)
            else:
                self._add(path, "use", node, "given")
            return None
        if callee == "sorted" and call.keywords and not self._pass_to_key(path, call, node):
            self._add(path, "use", node, "sorted by a key")
            return None
        if callee in _CHOICES and call.args == [at] and self._pass_to_key(path, call, node):
            return f"{path}.[]", call
        if callee in _PASSES and at in call.args:
            place = call.args.index(at) - 1  # type: ignore[arg-type]
            if self._pass_elements(path, call.args[0], place, node):
                return None if callee == "map" else (path, call)
        if callee in _THROUGH and at in call.args:
            return (f"{path}.[]" if callee == "next" else path), call
        if callee == "len":
            self._add(path, "size", node, callee)
        elif callee in _TESTS:
            self._add(path, "test", node, callee)
        elif callee in ("enumerate", "zip") and at in call.args and isinstance(
            self.parents.get(call), (ast.For, ast.AsyncFor, ast.comprehension)
        ):  # fmt: skip
            self._end_paired(path, at, call, callee, node)
        elif at in call.args and "()" not in callee and callee.rpartition(".")[2] in _ADDS and "." in callee:
            self._add(path, "added", node, callee, call.args.index(at), len(call.args))  # type: ignore[arg-type]
        elif at in call.args:
            self._add(path, "given", node, callee, call.args.index(at), len(call.args))  # type: ignore[arg-type]
        else:
            self._add(path, "use", node, "given")
        return None

    def _pass_to_key(self, path: str, call: ast.Call, node: ast.AST) -> bool:
        """The elements of a path go to the key that a call compares them by; False where that is no lambda. No key
        compares them by themselves."""
        keys = [one.value for one in call.keywords if one.arg == "key"]
        known = all(one.arg in ("key", "reverse", "default") for one in call.keywords)
        return known and len(keys) == 1 and self._pass_elements(path, keys[0], 0, node)

    def _pass_elements(self, path: str, function: ast.expr, place: int, node: ast.AST) -> bool:
        """The elements of a path go to a parameter of a lambda; False where there is none such."""
        if not isinstance(function, ast.Lambda) or not 0 <= place < len(function.args.args):
            return False
        name = f"lambda@{function.lineno}:{self.find_column(function.lineno, function.col_offset)}"
        self._add(f"{path}.[]", "kept", node, function.args.args[place].arg, type_=name)
        return True

    def _climb_keyword(self, path: str, keyword: ast.keyword, node: ast.AST) -> tuple[str, ast.AST] | None:
        """`f(name=path)`; `sorted(path, key=f)` and the like take no message so."""
        call = self.parents.get(keyword)
        callee = _spell(call.func, self.own) if isinstance(call, ast.Call) else ""
        if keyword.arg and callee:
            self._add(path, "given", node, callee, -1, 0, keyword.arg)
        else:
            self._add(path, "use", node, "given")
        return None

    def _end_paired(self, path: str, at: ast.AST, call: ast.Call, callee: str, node: ast.AST) -> None:
        """`for place, each in enumerate(path)` and `for one, other in zip(path, ...)`."""
        loop = self.parents[call]
        target = loop.target  # type: ignore[attr-defined]
        place = 1 if callee == "enumerate" else call.args.index(at)  # type: ignore[arg-type]
        if isinstance(target, (ast.Tuple, ast.List)) and place < len(target.elts):
            self._end_iterated(path, target.elts[place], node)
        else:
            self._add(path, "use", node, callee)

    def _end_iterated(self, path: str, target: ast.expr, node: ast.AST) -> None:
        kept = _spell(target, self.own)
        if kept:
            self._add(f"{path}.[]", "kept", node, kept)
        else:
            self._add(path, "use", node, "taken apart")

    def _end_assigned(self, path: str, parent: ast.Assign | ast.AnnAssign, node: ast.AST) -> None:
        targets = parent.targets if isinstance(parent, ast.Assign) else [parent.target]
        for target in targets:
            kept = _spell(target, self.own)
            if kept:
                type_ = ast.unparse(parent.annotation) if isinstance(parent, ast.AnnAssign) else ""
                self._add(path, "kept", node, kept, type_=type_)
            else:
                self._add(path, "use", node, "taken apart")

    def _end_listed(self, path: str, at: ast.AST, parent: ast.Tuple | ast.List, node: ast.AST) -> None:
        """An element of a list: `a, b = x, path` keeps it."""
        outer = self.parents.get(parent)
        if isinstance(outer, ast.Assign) and outer.value is parent:
            place = parent.elts.index(at)  # type: ignore[arg-type]
            for target in outer.targets:
                same = isinstance(target, (ast.Tuple, ast.List)) and len(target.elts) == len(parent.elts)
                kept = _spell(target.elts[place], self.own) if same else _spell(target, self.own)  # type: ignore
                if not kept:
                    self._add(path, "use", node, "in a list")
                else:
                    self._add(path, "kept", node, kept if same else f"{kept}.[]")
        else:
            self._add(path, "use", node, "in a list")


def _gives_value(parent: ast.AST, at: ast.AST) -> bool:
    """Whether an expression may be what the one around it is."""
    return isinstance(parent, ast.BoolOp) or (isinstance(parent, ast.IfExp) and parent.test is not at)


def _is_static(node: ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    return any(isinstance(one, ast.Name) and one.id == "staticmethod" for one in node.decorator_list)


def _find_name(function: ast.expr) -> str:
    """The last part of what is called."""
    if isinstance(function, ast.Name):
        return function.id
    return function.attr if isinstance(function, ast.Attribute) else ""


def _spell(node: ast.expr, own: tuple[str, ...]) -> str:
    """The path of an expression that is one, `()` for what a call in it gives; empty for others."""
    parts: list[str] = []
    while True:
        if isinstance(node, ast.Attribute):
            parts.append(node.attr)
            node = node.value
        elif isinstance(node, ast.Subscript):
            parts.append("[]")
            node = node.value
        elif isinstance(node, ast.Name):
            parts.append("this" if node.id in own else node.id)
            return ".".join(reversed(parts))
        elif parts and isinstance(node, ast.Call):
            name = _find_name(node.func)
            return ".".join([f"{name}()", *reversed(parts)])
        else:
            return ".".join(["()", *reversed(parts)]) if parts else ""
