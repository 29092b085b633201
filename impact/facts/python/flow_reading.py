"""What all readers of a Python syntax tree share: the function that is read, its guards and names, plain values."""

from __future__ import annotations

import ast

from ..flow import Access, Assignment, Call, Expr, Guard, Member
from .flow_body import Body, ClassBody
from .text import Text, printable

LONGEST_OTHER = 120
ANY = Expr("other")
_NUMBERS = {None: Expr("number", "None"), True: Expr("number", "True"), False: Expr("number", "False")}


class Reading(Text):
    """The base of the readers. It reads for one body at a time, into whose lists it writes."""

    body: Body
    guard: int
    this: str
    locals: set[str]
    guards: list[Guard]
    calls: list[Call]
    assignments: list[Assignment]
    accesses: list[Access]

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self.module_functions: set[str] = set()
        self.class_bodies: dict[str, ClassBody] = {}
        # Names that a class's own body knows without its object.
        self.own: set[str] = set()
        self.constants: list[Member] = []
        # Functions whose bodies are still to be read, since they see all variables of the one they stand in.
        self.waiting: list[tuple[Body, list[ast.stmt] | ast.expr]] = []
        # Whether names are bound in the body of a class.
        self.in_class = False

    def enter(self, body: Body) -> None:
        self.body = body
        self.guard = -1
        self.this = body.this
        self.locals = body.locals
        self.guards = body.guards
        self.calls = body.calls
        self.assignments = body.assignments
        self.accesses = body.accesses
        self.own = set()
        self.in_class = False
        self.unplaced = False

    def push(self, kind: str, text: str, line: int, early: bool = False) -> None:
        """A new guard around what follows."""
        self.guards.append(Guard(kind, text, line, self.guard, early))
        self.guard = len(self.guards) - 1

    def visit(self, node) -> None:
        """Records the calls and uses in an expression, the value of which nobody asks."""
        raise NotImplementedError

    def value(self, node, use: str, to: str = "", position: int = -1, keyword: str = "", target: str = "") -> Expr:
        """An expression. use, to, position, keyword: the Access that it is if it is a path; target: what it is kept
        in, `return` for what the function returns."""
        raise NotImplementedError

    # Names

    def sees(self, name: str) -> bool:
        return self.body.outer is not None and self.body.sees(name)

    def is_function(self, name: str) -> bool:
        body = self.body
        while body is not None:
            if name in body.functions:
                return True
            body = body.outer
        return name in self.module_functions

    def spelt(self, node) -> str:
        """The path of what is assigned to, nothing visited; empty for several."""
        cls = node.__class__
        if cls is ast.Name:
            if node.id == self.this:
                return "this"
            return "this." + node.id if node.id in self.own or self.in_class else node.id
        if cls is ast.Attribute:
            return f"{self.spelt(node.value)}.{node.attr}"
        if cls is ast.Subscript:
            inner = self.spelt(node.value)
            return inner if node.slice.__class__ is ast.Slice else f"{inner}.[]"
        return "" if cls in (ast.Tuple, ast.List, ast.Starred) else "()"

    # Plain values

    def member(self, path: str, name: str) -> Expr:
        cls = self.body.cls
        return Expr("function" if cls is not None and name in cls.callbacks else "name", path)

    def other(self, node) -> Expr:
        return Expr("other", self.source(node)[:LONGEST_OTHER])

    def constant(self, node: ast.Constant) -> Expr:
        value = node.value
        cls = value.__class__
        if cls is str:
            return Expr("text", value if value.isascii() else printable(value))  # type: ignore[union-attr]
        if value is None or cls is bool:
            return _NUMBERS[value]  # type: ignore[index]
        if cls is int or cls is float or cls is complex:
            return Expr("number", self.source(node))
        return self.other(node)

    def annotation(self, node) -> str:
        """A type as written, quotes around it left out."""
        if node is None:
            return ""
        if node.__class__ is ast.Constant and node.value.__class__ is str:
            return printable(node.value)
        return self.source(node)
