"""Which objects a variable may hold, followed back through arguments, copies and results to where they are made."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

from ...facts.flow import FlowExpr
from .code import FlowCode, Fn, Variable, find_parameter

_MOST = 50


class Origins(NamedTuple):
    """Variables of functions that hold some objects. made: places of the functions that make them, and with which
    arguments."""

    variables: frozenset[Variable]
    made: frozenset[tuple[str, tuple[FlowExpr, ...]]]


class ObjectOrigins:
    """Asks a body of code for the origins of objects."""

    def __init__(self, code: FlowCode):
        self.code = code
        self._known: dict[Variable, Origins | None] = {}

    @cached_property
    def _functions(self) -> dict[str, Fn]:
        return {fn.place: fn for fn in self.code.functions}

    def find(self, variable: Variable) -> Origins | None:
        """The origins of what a variable holds; None where it may be any object, as that of a member may be."""
        if variable not in self._known:
            self._known[variable] = self._find(variable)
        return self._known[variable]

    def may_be_of(self, path: str, fn: Fn, origins: Origins) -> bool:
        """Whether the member that a path names in a function may be that of some objects."""
        root, rest = self.code.resolve_variable(path, fn)
        if not rest:
            return True  # by a method, which any object has
        if root.kind != "local":
            return False
        found = self.find(root)
        return found is None or not found.variables.isdisjoint(origins.variables)

    def _find(self, variable: Variable) -> Origins | None:
        variables, queue = {variable}, [variable]
        made: set[tuple[str, tuple[FlowExpr, ...]]] = set()
        while queue:
            one = queue.pop()
            fn = self._functions.get(one.owner) if one.kind == "local" else None
            if fn is None or len(variables) > _MOST:
                return None
            for value, around in self._list_values(one.name, fn):
                if value.kind in ("make", "list", "text", "number"):
                    made.add((around.place, value.parts))
                    continue
                further = self.code.resolve_variable(value.text, around)[0] if value.kind == "name" else None
                if further is None:
                    return None
                if further not in variables:
                    variables.add(further)
                    queue.append(further)
        return Origins(frozenset(variables), frozenset(made))

    def _list_values(self, name: str, fn: Fn) -> list[tuple[FlowExpr, Fn]]:
        """What a local variable is, with the function that says so."""
        found: list[tuple[FlowExpr, Fn]] = []
        parameter = find_parameter(fn, name)
        if parameter is not None:
            found += self.code.list_given(fn, parameter[0], name)
        for each in fn.assigned.get(name, ()):
            targets = self.code.list_targets(each.value.text, fn) if each.value.kind == "call" else []
            given = [(a.value, target) for target in targets for a in target.facts.assignments if not a.target]
            found += given or [(each.value, fn)]
        return found
