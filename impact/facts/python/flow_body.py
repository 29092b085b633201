"""A Python function's or class's facts while they are gathered."""

from __future__ import annotations

import ast

from ..flow import Access, Assignment, DataMember, FlowCall, FlowClass, FlowExpr, FlowFunction, FlowParameter, Guard


class ClassBody:
    """A class while it is read. methods: all it declares; callbacks: those that a name refers to without calling, which
    leaves properties out, with those of its bases in the same file."""

    def __init__(self, name: str, bases: tuple[str, ...], node: ast.ClassDef) -> None:
        self.name = name
        self.bases = bases
        self.line = node.lineno
        self.end = node.end_lineno or node.lineno
        self.methods: list[str] = []
        self.callbacks: set[str] = set()
        self.members: dict[str, DataMember] = {}

    def member(self, name: str, type: str, line: int, value: FlowExpr | None) -> None:
        """Keeps the first mention of a member that tells its type, else the first."""
        known = self.members.get(name)
        if known is None or (type and not known.type):
            self.members[name] = DataMember(name, type, line, value)

    def finished(self) -> FlowClass:
        members = tuple(sorted(self.members.values(), key=lambda member: member.line))
        return FlowClass(self.name, self.bases, members, tuple(self.methods), self.line, self.end)


class Body:
    """A function while it is read. this: the name by which it knows its object, empty for none. outer: the function
    around it whose variables it sees. made: guard under which it is defined in outer."""

    __slots__ = (
        *("accesses", "assignments", "calls", "captured", "cls", "decorators", "end", "functions", "guards"),
        *("is_class", "line", "locals", "made", "name", "outer", "outside", "owner", "parameters", "returns", "this"),
    )

    def __init__(self, name: str, cls: ClassBody | None, line: int, end: int, outer: Body | None = None) -> None:
        self.name = name
        self.cls = cls
        self.owner = cls.name if cls is not None else ""
        self.line = line
        self.end = end
        self.outer = outer
        self.made = -1
        self.is_class = False
        self.this = ""
        self.parameters: tuple[FlowParameter, ...] = ()
        self.decorators: tuple[str, ...] = ()
        self.returns = ""
        self.locals: set[str] = set()
        # Names declared global or nonlocal.
        self.outside: dict[str, type] = {}
        self.functions: set[str] = set()
        self.captured: set[str] = set()
        self.guards: list[Guard] = []
        self.calls: list[FlowCall] = []
        self.assignments: list[Assignment] = []
        self.accesses: list[Access] = []

    def sees(self, name: str) -> bool:
        """Whether a function around this one has such a variable; it is then captured by all between."""
        outer = self.outer
        while outer is not None:
            if name in outer.locals:
                inner = self
                while inner is not outer:
                    inner.captured.add(name)
                    inner = inner.outer
                    assert inner is not None
                return True
            outer = outer.outer
        return False

    def captures(self, name: str, inner: Body) -> None:
        """A function inside this one uses one of its variables."""
        self.accesses.append(Access(name, "escape", inner.line, inner.made, inner.name))

    def says_something(self) -> bool:
        """False for the body of a class that does nothing but define."""
        return not self.is_class or bool(self.calls or self.assignments or self.guards)

    def finished(self) -> FlowFunction:
        return FlowFunction(
            self.name,
            self.owner,
            self.parameters,
            self.line,
            self.end,
            tuple(self.guards),
            tuple(self.calls),
            tuple(self.assignments),
            tuple(self.accesses),
            self.decorators,
            self.returns,
            outside=tuple(self.outside),
        )
