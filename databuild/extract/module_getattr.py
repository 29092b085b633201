"""What a module's own `__getattr__` serves and refuses (PEP 562), as far as its code lists it."""

from __future__ import annotations

import ast
from collections.abc import Iterable
from typing import NamedTuple

from ...impact.facts.python.text import format_dotted

Names = frozenset[str]


class ServedNames(NamedTuple):
    """served: names that it answers, submodules left out; None where that cannot be known. warned: those of them with a
    warning. refused: names that it lists only to raise for them."""

    served: Names | None
    warned: Names
    refused: Names


def read_module_getattr(function: ast.FunctionDef, module: Iterable[ast.stmt]) -> ServedNames:
    """What a `__getattr__` of a module does. module: the statements that its variables are bound by."""
    parameters = [*function.args.posonlyargs, *function.args.args]
    if len(parameters) != 1:
        return ServedNames(None, frozenset(), frozenset())
    reader = _Reader(parameters[0].arg, list(module))
    if reader.visit_block(function.body, None, False) is not _ENDED:
        reader.serve(None, False)  # it ends without `raise`, and serves None
    served = None if reader.open else frozenset(reader.served)
    return ServedNames(served, frozenset(reader.warned), frozenset(reader.refused - reader.served - reader.warned))


_ENDED = frozenset(("",))
"""Stands for the names that get past a block that never ends without `return` or `raise`."""


class _Reader:
    """One walk over the function. Names that may get to a statement are a set, or None for any name."""

    def __init__(self, asked: str, module: list[ast.stmt]):
        self.asked, self.module = asked, module
        self.blocks = _assign_blocks(module)
        self.served: set[str] = set()
        self.warned: set[str] = set()
        self.refused: set[str] = set()
        self.open = False
        self.imported = {"import_module", "__import__"}

    def serve(self, names: Names | None, warns: bool) -> None:
        if names is None:
            self.open = True
        else:
            (self.warned if warns else self.served).update(names)
            self.served.update(names)

    def visit_block(self, body: Iterable[ast.stmt], names: Names | None, warns: bool) -> Names | None:
        """The names that get past the statements; _ENDED for none."""
        for node in body:
            if isinstance(node, ast.Raise):
                self.refused.update(names or ())
                return _ENDED
            if isinstance(node, ast.Return):
                self.visit_return(node.value, names, warns)
                return _ENDED
            if isinstance(node, ast.If):
                names = self.visit_choice(node, names, warns)
            elif isinstance(node, ast.Try):
                names = self.visit_try(node, names, warns)
            elif isinstance(node, (ast.With, ast.AsyncWith)):
                names = self.visit_block(node.body, names, warns)
            elif isinstance(node, (ast.For, ast.While, ast.Match)):
                self.open = True
            elif isinstance(node, (ast.Import, ast.ImportFrom)):
                self.imported.update(alias.asname or alias.name for alias in node.names)
            elif not isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                names = self._narrow(names, self._find_subscripted(node))
                warns = warns or _is_warning(node)
            if names is _ENDED:
                return _ENDED
        return names

    def visit_return(self, value: ast.expr | None, names: Names | None, warns: bool) -> None:
        if isinstance(value, ast.Subscript) and self._is_asked(value.slice):
            if isinstance(value.value, ast.Call) and format_dotted(value.value.func) == "globals":
                return  # what the module has is there without it
            names = self._narrow(names, self._find_keys(value.value))
        made = value.func if isinstance(value, ast.Call) else value
        if names is not None and made is not None and format_dotted(made).rpartition(".")[2] in self.imported:
            return  # a submodule
        self.serve(names, warns)

    def visit_choice(self, node: ast.If, names: Names | None, warns: bool) -> Names | None:
        inside, negated = self._read_test(node.test)
        yes, no = (names, self._narrow(names, inside)) if negated else (self._narrow(names, inside), names)
        after = [self.visit_block(node.body, yes, warns), self.visit_block(node.orelse, no, warns)]
        left = [one for one in after if one is not _ENDED]
        return _ENDED if not left else None if None in left else frozenset().union(*(one or () for one in left))

    def visit_try(self, node: ast.Try, names: Names | None, warns: bool) -> Names | None:
        """`try: x = TABLE[name]` with an except for what is not in it: what the else, or the rest of the body, gets."""
        through = self.visit_block(node.body, names, warns)
        if through is not _ENDED:
            through = self.visit_block(node.orelse, through, warns)
        for handler in node.handlers:
            raised = self.visit_block(handler.body, names, warns)
            if raised is not _ENDED:
                through = None if None in (raised, names) else names
        return self.visit_block(node.finalbody, through, warns) if through is not _ENDED else _ENDED

    def _narrow(self, names: Names | None, inside: Names | None) -> Names | None:
        return names if inside is None else inside if names is None else names & inside

    def _is_asked(self, node: ast.expr) -> bool:
        return isinstance(node, ast.Name) and node.id == self.asked

    def _read_test(self, test: ast.expr) -> tuple[Names | None, bool]:
        """The names for which a condition may hold, None where unknown; with True, for which it may not."""
        if isinstance(test, ast.BoolOp) and isinstance(test.op, ast.And):
            read = [self._read_test(value) for value in test.values]
            return next((one for one in read if one[0] is not None and not one[1]), (None, False))
        if not isinstance(test, ast.Compare) or len(test.ops) != 1 or not self._is_asked(test.left):
            return None, False
        other, operator = test.comparators[0], test.ops[0]
        if isinstance(operator, (ast.Eq, ast.NotEq)):
            text = other.value if isinstance(other, ast.Constant) else None
            return (frozenset((text,)) if isinstance(text, str) else None), isinstance(operator, ast.NotEq)
        if isinstance(operator, (ast.In, ast.NotIn)):
            return self._find_keys(other), isinstance(operator, ast.NotIn)
        return None, False

    def _find_subscripted(self, node: ast.stmt) -> Names | None:
        """The names that a statement does not raise KeyError for."""
        value = node.value if isinstance(node, (ast.Assign, ast.AnnAssign, ast.Expr)) else None
        if isinstance(value, ast.Subscript) and self._is_asked(value.slice):
            return self._find_keys(value.value)
        return None

    def _find_keys(self, node: ast.expr, depth: int = 0) -> Names | None:
        """What strings a collection may hold; None where that cannot be known."""
        elements = self._list_elements(node, depth)
        if elements is None or not all(isinstance(one, ast.Constant) for one in elements):
            return None
        return frozenset(one.value for one in elements if isinstance(one, ast.Constant) and isinstance(one.value, str))

    def _list_elements(self, node: ast.expr | None, depth: int = 0) -> list[ast.expr] | None:
        """The elements of a collection, keys of a dictionary, as written."""
        if depth > 8 or node is None:
            return None
        if isinstance(node, (ast.List, ast.Tuple, ast.Set)):
            parts = [self._list_elements(one.value, depth + 1) if isinstance(one, ast.Starred) else [one]
                     for one in node.elts]  # fmt: skip
        elif isinstance(node, ast.Dict):
            pairs = zip(node.keys, node.values, strict=True)
            parts = [[key] if key is not None else self._list_elements(value, depth + 1) for key, value in pairs]
        elif isinstance(node, (ast.DictComp, ast.SetComp, ast.ListComp, ast.GeneratorExp)):
            return self._list_generated(node, depth)
        elif isinstance(node, ast.BinOp) and isinstance(node.op, (ast.Add, ast.BitOr)):
            parts = [self._list_elements(node.left, depth + 1), self._list_elements(node.right, depth + 1)]
        elif isinstance(node, ast.Call):
            maker = format_dotted(node.func)
            if maker == "dict" and not node.args and all(one.arg for one in node.keywords):
                return [ast.Constant(one.arg) for one in node.keywords]
            if maker in ("frozenset", "set", "dict", "list", "tuple", "sorted") and len(node.args) == 1:
                return self._list_elements(node.args[0], depth + 1)
            return [] if maker in ("frozenset", "set", "dict", "list", "tuple") and not node.args else None
        elif isinstance(node, ast.Name):
            parts = [self._list_elements(value, depth + 1) for value in self._list_values(node)] or [None]
        else:
            return None
        return None if None in parts else [one for part in parts for one in part or ()]

    def _list_generated(
        self, node: ast.DictComp | ast.SetComp | ast.ListComp | ast.GeneratorExp, depth: int
    ) -> list[ast.expr] | None:
        """Those of a comprehension whose elements, or keys, are what it runs over, or a part of that."""
        made = node.key if isinstance(node, ast.DictComp) else node.elt
        if len(node.generators) != 1 or not isinstance(made, ast.Name):
            return None
        generator = node.generators[0]
        over = self._list_elements(generator.iter, depth + 1)
        if over is None or isinstance(generator.target, ast.Name):
            return over if over is None or ast.unparse(generator.target) == made.id else None
        if not isinstance(generator.target, ast.Tuple):
            return None
        place = next((n for n, one in enumerate(generator.target.elts) if ast.unparse(one) == made.id), None)
        if place is None or not all(isinstance(one, ast.Tuple) and len(one.elts) > place for one in over):
            return None
        return [one.elts[place] for one in over if isinstance(one, ast.Tuple)]

    def _list_values(self, name: ast.Name) -> list[ast.expr | None]:
        """What is put into a variable of the module, anywhere in it; None for what cannot be read. What stands in one
        block with a later assignment, before a use, does not get there."""
        found: list[tuple[int, ast.expr | None]] = []
        start, block = 0, self.blocks.get(name.lineno)
        for node in (inner for statement in self.module for inner in ast.walk(statement)):
            if isinstance(node, (ast.Assign, ast.AnnAssign, ast.AugAssign)):
                for target in node.targets if isinstance(node, ast.Assign) else [node.target]:
                    if isinstance(target, ast.Name) and target.id == name.id:
                        found.append((node.lineno, node.value))
                        plain = not isinstance(node, ast.AugAssign) and self.blocks.get(node.lineno) == block
                        start = max(start, node.lineno) if plain and block and node.lineno < name.lineno else start
                    elif isinstance(target, ast.Subscript) and ast.unparse(target.value) == name.id:
                        found.append((node.lineno, ast.Set([target.slice])))
            elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.args:
                if ast.unparse(node.func.value) == name.id and node.func.attr in ("update", "extend"):
                    found += [(node.lineno, one) for one in node.args]
                elif ast.unparse(node.func.value) == name.id and node.func.attr in ("add", "append", "insert"):
                    found.append((node.lineno, None))
            elif isinstance(node, (ast.Import, ast.ImportFrom)):
                found += [(node.lineno, None) for alias in node.names if (alias.asname or alias.name) == name.id]
        return [value for line, value in found if line >= start and (line < name.lineno or not start)]


def _assign_blocks(module: Iterable[ast.stmt]) -> dict[int, int]:
    """Of each line of what runs on import, the innermost block that it stands in."""
    found: dict[int, int] = {}
    blocks = [list(module)]
    for number, block in enumerate(blocks, 1):
        for node in block:
            lines = range(node.lineno, (node.end_lineno or node.lineno) + 1)
            if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
                found = {line: at for line, at in found.items() if line not in lines}
            else:
                found.update(dict.fromkeys(lines, number))
                blocks += [inner for _, inner in ast.iter_fields(node)
                           if isinstance(inner, list) and inner and isinstance(inner[0], ast.stmt)]  # fmt: skip
                blocks += [handler.body for handler in getattr(node, "handlers", ())]
    return found


def _is_warning(node: ast.stmt) -> bool:
    call = node.value if isinstance(node, ast.Expr) else None
    return isinstance(call, ast.Call) and format_dotted(call.func).rpartition(".")[2] == "warn"
