"""Fields and constants of interfaces that a Python source uses, by what its variables are bound to.

A variable's type shows where it is bound to what a constructor gives, to a member of such a value, or annotated; in the
callback of a subscription or service; and, of `self.name`, where the class binds it to one type alone.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Iterator

import msgspec

from ..place import Problem
from .source import read
from .text import Text

KINDS = frozenset(("msg", "srv", "action"))
SECTIONS = frozenset(("Request", "Response", "Goal", "Result", "Feedback"))
ELEMENT = "[]"
_ASK_FOR_MESSAGES = frozenset(("create_subscription", "Subscriber"))
_ANSWER = frozenset(("create_service", "Service"))
_DEEPEST = 40
_FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)


class MemberUse(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """The first use like it of a member of an interface. type: dotted, `pkg.msg.Name`, `pkg.srv.Name.Request`. steps:
    fields on the way, ELEMENT for an element of a sequence; the last is the member that is used. line, column: of it.
    """

    type: str
    steps: tuple[str, ...]
    line: int
    column: int


# What a value is: its type, and the steps from there; None: not known.
_Value = tuple[str, tuple[str, ...]] | None
_Names = dict[str, _Value]


class InterfacesFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """What a Python file uses of interfaces, in the order of the source."""

    members: tuple[MemberUse, ...] = ()
    problems: tuple[Problem, ...] = ()


def extract(data: bytes) -> InterfacesFile:
    """Every use of a member of a value whose interface shows; nothing of a file that no parser reads."""
    source = read(data)
    imported = _imported(source.tree) if source.tree is not None else {}
    if source.tree is None or not imported:
        return InterfacesFile()
    walk = _Walk(imported, Text(source.parsed).column)
    walk.called_back = walk.callbacks(source.tree)
    walk.block(source.tree.body, {}, None)
    return InterfacesFile(tuple(sorted(walk.found.values(), key=lambda use: (use.line, use.column))))


def _imported(tree: ast.Module) -> dict[str, str]:
    """Names of the file to the interfaces, or the modules of them (`pkg.msg`), that they stand for."""
    found: dict[str, str] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and not node.level and node.module:
            package, _, kind = node.module.partition(".")
            for name in node.names:
                if kind in KINDS and name.name != "*":
                    found[name.asname or name.name] = f"{node.module}.{name.name}"
                elif not kind and name.name in KINDS:
                    found[name.asname or name.name] = f"{package}.{name.name}"
        elif isinstance(node, ast.Import):
            for name in node.names:
                package, _, kind = name.name.partition(".")
                if kind in KINDS:
                    found[name.asname or package] = name.name if name.asname else package
    return found


class _Class:
    """What `self` holds: one type by name, None where there are several or it does not show."""

    def __init__(self) -> None:
        self.held: _Names = {}


class _Walk:
    def __init__(self, imported: dict[str, str], column: Callable[[int, int], int]) -> None:
        self.imported, self.column = imported, column
        self.found: dict[tuple[str, tuple[str, ...]], MemberUse] = {}
        # Of functions that are handed over as callbacks, by name: the types of their parameters.
        self.called_back: dict[str, tuple[str, ...]] = {}

    # What things are

    def interface(self, node: ast.expr) -> _Value:
        """The interface that a name, `pkg.msg.Name` or `Name.Request` stands for, and what follows."""
        parts: list[str] = []
        while isinstance(node, ast.Attribute):
            parts.append(node.attr)
            node = node.value
        known = self.imported.get(node.id) if isinstance(node, ast.Name) else None
        if known is None:
            return None
        words = [*known.split("."), *reversed(parts)]
        if len(words) < 3 or words[1] not in KINDS:
            return None
        end = 4 if len(words) > 3 and words[3] in SECTIONS else 3
        return ".".join(words[:end]), tuple(words[end:])

    def made(self, node: ast.expr | None) -> _Value:
        """What a constructor of an interface gives."""
        value = self.interface(node.func) if isinstance(node, ast.Call) else None
        return (value[0], ()) if value is not None and not value[1] else None

    def annotated(self, node: ast.expr | None) -> _Value:
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and len(node.value) < 200:
            try:
                node = ast.parse(node.value, mode="eval").body
            except (SyntaxError, ValueError):
                return None
        value = self.interface(node) if isinstance(node, (ast.Name, ast.Attribute)) else None
        return (value[0], ()) if value is not None and not value[1] else None

    def value(self, node: ast.expr | None, names: _Names, own: _Class | None) -> _Value:
        if isinstance(node, ast.Name):
            return names.get(node.id)
        if isinstance(node, ast.Attribute):
            if isinstance(node.value, ast.Name) and node.value.id == "self" and own is not None:
                return own.held.get(node.attr)
            of = self.value(node.value, names, own)
            if of is not None and len(of[1]) < _DEEPEST:
                return of[0], (*of[1], node.attr)
            shadowed = isinstance(root := _root(node), ast.Name) and root.id in names
            value = self.interface(node) if of is None and not shadowed else None
            return value if value is not None and value[1] else None
        if isinstance(node, ast.Subscript) and not isinstance(node.slice, ast.Slice):
            of = self.value(node.value, names, own)
            return (of[0], (*of[1], ELEMENT)) if of is not None and len(of[1]) < _DEEPEST else None
        return self.made(node) if isinstance(node, ast.Call) and _unbound(node.func, names) else None

    def callbacks(self, tree: ast.Module) -> dict[str, tuple[str, ...]]:
        """Functions that are handed over beside an interface, by name."""
        found: dict[str, set[tuple[str, ...]]] = {}
        for node in ast.walk(tree):
            if not isinstance(node, ast.Call):
                continue
            function = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            if function not in _ASK_FOR_MESSAGES and function not in _ANSWER:
                continue
            arguments = [*node.args, *(keyword.value for keyword in node.keywords)]
            types = [value[0] for one in arguments if (value := self.annotated(one)) is not None]
            if len(types) != 1:
                continue
            given = (types[0],) if function in _ASK_FOR_MESSAGES else (f"{types[0]}.Request", f"{types[0]}.Response")
            for one in arguments:
                if isinstance(one, ast.Attribute) and isinstance(one.value, ast.Name) and one.value.id == "self":
                    found.setdefault(one.attr, set()).add(given)
                elif isinstance(one, ast.Name):
                    found.setdefault(one.id, set()).add(given)
        return {name: next(iter(types)) for name, types in found.items() if len(types) == 1}

    def held(self, node: ast.ClassDef) -> _Class:
        """What `self` holds in the methods of a class."""
        own = _Class()
        for inner in ast.walk(node):
            if isinstance(inner, ast.Assign):
                pairs = [(target, self.made(inner.value)) for target in inner.targets]
            elif isinstance(inner, ast.AnnAssign):
                pairs = [(inner.target, self.annotated(inner.annotation))]
            elif isinstance(inner, (ast.AugAssign, ast.NamedExpr, ast.For, ast.AsyncFor)):
                pairs = [(inner.target, None)]
            else:
                continue
            for target, value in pairs:
                for one in _flat(target):
                    if isinstance(one, ast.Attribute) and isinstance(one.value, ast.Name) and one.value.id == "self":
                        kept = own.held.get(one.attr, value) == value and not isinstance(target, (ast.Tuple, ast.List))
                        own.held[one.attr] = value if kept else None
        return own

    # The walk

    def block(self, body: Iterable[ast.stmt], names: _Names, own: _Class | None) -> None:
        """Goes through statements as they run one after the other; names are changed."""
        for node in body:
            self.statement(node, names, own)

    def statement(self, node: ast.stmt, names: _Names, own: _Class | None) -> None:
        if isinstance(node, _FUNCTIONS):
            names[node.name] = None
            self.function(node, names, own)
        elif isinstance(node, ast.ClassDef):
            names[node.name] = None
            self.block(node.body, dict(names), self.held(node))
        elif isinstance(node, ast.Assign):
            self.expressions(node, names, own)
            for target in node.targets:
                self.bind(target, self.value(node.value, names, own), names)
        elif isinstance(node, ast.AnnAssign):
            self.expressions(node, names, own)
            self.bind(node.target, self.annotated(node.annotation), names)
        else:
            inner = [part for _, part in ast.iter_fields(node) if isinstance(part, list) and part]
            blocks = [part for part in inner if isinstance(part[0], (ast.stmt, ast.ExceptHandler, _CASE))]
            if isinstance(node, (ast.For, ast.AsyncFor, ast.While)):
                # What the body binds is not known where the body begins for the second time.
                names.update(dict.fromkeys(_bound(node)))
            self.expressions(node, names, own)
            names.update(dict.fromkeys(_bound_by(node)))
            if isinstance(node, (ast.For, ast.AsyncFor)) and isinstance(node.target, ast.Name):
                of = self.value(node.iter, names, own)
                names[node.target.id] = (of[0], (*of[1], ELEMENT)) if of is not None else None
            if isinstance(node, (ast.With, ast.AsyncWith)):
                self.block(node.body, names, own)
                return
            ways = [names]
            for block in blocks:
                for each in [block] if isinstance(block[0], ast.stmt) else [part.body for part in block]:
                    way = dict(names)
                    if isinstance(node, ast.Try) and each is not node.body:  # which runs before, as far as it comes
                        way.update(dict.fromkeys(_bound(node)))
                    self.block(each, way, own)
                    ways.append(way)
            if blocks:
                for name in {name for way in ways for name in way}:
                    known = {way.get(name) for way in (ways[1:] if _takes_one(node) else ways)}
                    names[name] = known.pop() if len(known) == 1 else None

    def function(self, node, names: _Names, own: _Class | None) -> None:
        arguments = node.args
        positional = [*arguments.posonlyargs, *arguments.args]
        inner = dict(names)
        inner.update(dict.fromkeys(_bound(node)))
        every = [*positional, *arguments.kwonlyargs, *filter(None, (arguments.vararg, arguments.kwarg))]
        inner.update((one.arg, self.annotated(one.annotation)) for one in every)
        types = self.called_back.get(node.name, ())
        own_first = own is not None and positional[:1] and positional[0].arg == "self"
        handed = positional[1:] if own_first else positional
        if types and 0 < len(handed) <= len(types) and not any(one.annotation for one in handed):
            inner.update((one.arg, (type_, ())) for one, type_ in zip(handed, types, strict=False))
        for one in (*node.decorator_list, *arguments.defaults, *arguments.kw_defaults):
            self.expression(one, names, own)
        self.block(node.body, inner, own)

    def bind(self, target: ast.expr, value: _Value, names: _Names) -> None:
        if isinstance(target, ast.Name):
            names[target.id] = value
        else:
            names.update((one.id, None) for one in _flat(target) if isinstance(one, ast.Name))

    def expressions(self, node: ast.AST, names: _Names, own: _Class | None) -> None:
        """The expressions of a statement, its inner statements left out."""
        for _, part in ast.iter_fields(node):
            for one in part if isinstance(part, list) else (part,):
                if isinstance(one, (ast.expr, ast.withitem, ast.keyword)):
                    self.expression(one, names, own)

    def expression(self, node: ast.AST | None, names: _Names, own: _Class | None) -> None:
        if node is None or isinstance(node, (ast.Name, ast.Constant)):
            return
        if isinstance(node, ast.Lambda):
            names = {**names, **dict.fromkeys(one.arg for one in ast.walk(node.args) if isinstance(one, ast.arg))}
        elif isinstance(node, (ast.ListComp, ast.SetComp, ast.GeneratorExp, ast.DictComp)):
            names = {**names}
            for part in node.generators:
                of = self.value(part.iter, names, own)
                self.bind(part.target, (of[0], (*of[1], ELEMENT)) if of is not None else None, names)
        if isinstance(node, ast.Attribute):
            value = self.value(node, names, own)
            if value is not None and value[1]:
                self.note(value, node.end_lineno or 0, (node.end_col_offset or 0) - len(node.attr.encode()))
        elif isinstance(node, ast.Call):
            made = self.made(node) if _unbound(node.func, names) else None
            for keyword in node.keywords if made is not None else ():
                if keyword.arg is not None and made is not None:
                    self.note((made[0], (keyword.arg,)), keyword.lineno, keyword.col_offset)
            if isinstance(node.func, ast.Attribute):  # a method, not a member
                self.expression(node.func.value, names, own)
                for child in (*node.args, *(keyword.value for keyword in node.keywords)):
                    self.expression(child, names, own)
                return
        elif isinstance(node, ast.NamedExpr):
            self.expression(node.value, names, own)
            self.bind(node.target, self.value(node.value, names, own), names)
            return
        for child in ast.iter_child_nodes(node):
            self.expression(child, names, own)

    def note(self, value: tuple[str, tuple[str, ...]], line: int, offset: int) -> None:
        if value not in self.found:
            self.found[value] = MemberUse(*value, line, self.column(line, offset))


_CASE = getattr(ast, "match_case", ast.ExceptHandler)


def _root(node: ast.expr) -> ast.expr:
    while isinstance(node, (ast.Attribute, ast.Subscript)):
        node = node.value
    return node


def _unbound(node: ast.expr, names: _Names) -> bool:
    root = _root(node)
    return isinstance(root, ast.Name) and root.id not in names


def _takes_one(node: ast.stmt) -> bool:
    """Whether one of the blocks of a statement surely runs."""
    return isinstance(node, ast.If) and bool(node.orelse)


def _flat(target: ast.expr) -> Iterator[ast.expr]:
    if isinstance(target, (ast.Tuple, ast.List)):
        for one in target.elts:
            yield from _flat(one)
    else:
        yield target.value if isinstance(target, ast.Starred) else target


def _bound_by(node: ast.stmt) -> Iterator[str]:
    """Names that a statement itself binds, those of its inner statements left out."""
    for _, part in ast.iter_fields(node):
        for one in part if isinstance(part, list) else (part,):
            if isinstance(one, (ast.expr, ast.withitem, ast.alias, _CASE)):
                yield from _bound(one)


def _bound(node: ast.AST) -> Iterator[str]:
    """Names that a node or anything in it binds, what functions and classes in it bind left out."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.Name) and not isinstance(child.ctx, ast.Load):
            yield child.id
        elif isinstance(child, ast.ExceptHandler) and child.name:
            yield child.name
        elif isinstance(child, (*_FUNCTIONS, ast.ClassDef)):
            yield child.name
            continue
        elif child.__class__.__name__ in ("MatchAs", "MatchStar") and getattr(child, "name", None):
            yield child.name  # type: ignore[attr-defined]
        if not isinstance(child, ast.Lambda):
            yield from _bound(child)
