"""A Python function's or class's facts while they are extracted."""

from __future__ import annotations

import msgspec

from ..flow import Access, Assignment, DataMember, FlowCall, FlowClass, FlowExpr, FlowFunction, FlowParameter, Guard


class ClassBody(msgspec.Struct, eq=False):
    """A class while it is read. methods: all it declares; callbacks: those that a name refers to without calling, which
    leaves properties out, with those of its bases in the same file."""

    name: str
    bases: tuple[str, ...]
    line: int
    end: int
    methods: list[str] = []
    callbacks: set[str] = set()
    members: dict[str, DataMember] = {}

    def add_member(self, name: str, type: str, line: int, value: FlowExpr | None) -> None:
        """Keeps the first mention of a member that tells its type, else the first."""
        known = self.members.get(name)
        if known is None or (type and not known.type):
            self.members[name] = DataMember(name, type, line, value)

    def build_class(self) -> FlowClass:
        members = tuple(sorted(self.members.values(), key=lambda member: member.line))
        return FlowClass(self.name, self.bases, members, self.line, self.end)


class Body(msgspec.Struct, eq=False):
    """A function while it is read. this: the name by which it knows its object, empty for none. outer: the function
    around it whose variables it sees. outside: names declared global or
    nonlocal. bound_methods: of variables what they call, as a path, where each is worth a method of an object and
    nothing else; empty for the others."""

    name: str
    cls: ClassBody | None
    line: int
    end: int
    outer: Body | None = None
    is_class: bool = False
    this: str = ""
    parameters: tuple[FlowParameter, ...] = ()
    returns: str = ""
    locals: set[str] = set()
    outside: dict[str, type] = {}
    functions: set[str] = set()
    bound_methods: dict[str, str] = {}
    captured: set[str] = set()
    guards: list[Guard] = []
    calls: list[FlowCall] = []
    assignments: list[Assignment] = []
    accesses: list[Access] = []

    def is_captured(self, name: str) -> bool:
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

    def says_something(self) -> bool:
        """False for the body of a class that does nothing but define."""
        return not self.is_class or bool(self.calls or self.assignments or self.guards)

    def build_function(self) -> FlowFunction:
        owner = self.cls.name if self.cls is not None else ""
        return FlowFunction(
            self.name, owner, self.parameters, self.line, self.end, tuple(self.guards), tuple(self.calls),
            tuple(self.assignments), tuple(dict.fromkeys(self.accesses)), self.returns, tuple(self.outside),
        )  # fmt: skip
