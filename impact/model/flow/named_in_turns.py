"""Names that code puts together where it declares parameters, or sets members by them: in the turns of a loop, or in a
function that is called with each of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any, NamedTuple

from ...facts.flow import Assignment, FlowCall, FlowExpr, Guard
from .calls import Calls, FrameworkCall
from .code import Fn, Variable
from .conditions import DecidedCondition
from .reaching import LOOPS, FlowValue

_MOST = 200
_ASKING = frozenset(("if", "unless", "case"))


class DefaultGiven(NamedTuple):
    """A use that declares a parameter, or reads it with a default. turns, way: the turns of loops, by the place of
    their function and their line, and the calls of functions in which it is about this parameter."""

    use: FrameworkCall
    turns: Mapping[tuple[str, int], int] = {}
    way: Mapping[Fn, FlowCall] = {}


class SetMember(NamedTuple):
    """A call of `setattr` that sets a member, as the assignment that it is. turns, way: as for DefaultGiven; only_if:
    the condition in the loops around under which it is come to, where that is not known."""

    fn: Fn
    each: Assignment
    turns: Mapping[tuple[str, int], int]
    way: Mapping[Fn, FlowCall]
    only_if: str


class NamesInTurns:
    """Asks a body of code for such names. begin: makes what evaluates expressions where nothing is known of who runs
    them; spell: the condition of a guard, as people read it."""

    def __init__(self, calls: Calls, begin: Callable[[], Any], spell: Callable[[str, str], str]):
        self._calls, self._code, self._begin, self._spell = calls, calls.code, begin, spell
        self._is_asked = False
        self._rows: dict[int, SetMember] = {}

    def list_declared(self, name: str) -> Sequence[DefaultGiven]:
        """The declarations of a parameter under a name that is put together. None while these are worked out."""
        return () if self._is_asked else self._declared.get(name, ())

    def list_set(self, variable: Variable) -> list[SetMember]:
        """The calls of `setattr` that set a member. None while these are worked out."""
        rows = () if self._is_asked else self._set.get(variable.name, ())
        return [one for one in rows if self._is_of(one.fn, variable)]

    def find_row(self, each: Assignment) -> SetMember | None:
        """The call of `setattr` that an assignment stands for, None for all else."""
        return self._rows.get(id(each))

    def _is_of(self, fn: Fn, variable: Variable) -> bool:
        """Whether what a method sets in its object is this member of it."""
        owner = self._code.find_owner(fn)
        if owner is None:
            return False
        below = (one.key for one in self._code.derived.get(owner.key, ()))
        return variable.owner in (owner.key, *below, *(one.key for one in self._code.list_bases(owner)))

    @cached_property
    def _declared(self) -> dict[str, list[DefaultGiven]]:
        found: dict[str, list[DefaultGiven]] = {}
        self._is_asked = True
        try:
            for use in self._calls.select_uses("parameter"):
                name = self._calls.find_argument(use, use.row.topic)
                default = self._calls.find_argument(use, use.row.default)
                if name is None or default is None or name.kind == "text":
                    continue
                for values, text, _ in self._list_named(name, use.fn, use.call):
                    found.setdefault(text, []).append(DefaultGiven(use, values.turns, values.way))
        finally:
            self._is_asked = False
        return found

    @cached_property
    def _set(self) -> dict[str, list[SetMember]]:
        found: dict[str, list[SetMember]] = {}
        self._is_asked = True
        try:
            for fn, call in self._code.list_calls_named(("setattr",)):
                if (
                    call.callee != "setattr"
                    or len(call.arguments) != 3
                    or call.arguments[0] != FlowExpr("name", "this")
                ):
                    continue
                for values, text, only_if in self._list_named(call.arguments[1], fn, call):
                    each = Assignment(f"this.{text}", call.arguments[2], call.line, call.guard)
                    row = SetMember(fn, each, values.turns, values.way, only_if)
                    self._rows[id(each)] = row
                    found.setdefault(text, []).append(row)
        finally:
            self._is_asked = False
        return found

    def _list_named(self, name: FlowExpr, fn: Fn, call: FlowCall) -> Iterator[tuple[Any, str, str]]:
        """The names that an expression is in a call, one on each way to it, with what evaluates there, and the
        condition in the loops around under which it is come to where that is not known."""
        for values in self._list_ways(fn, call.guard):
            found: list[FlowValue] = values.evaluate(name, fn, call.line)
            texts = {one.text for one in found if one.how == "literal" and not one.only_if}
            text = found[0].text
            if len(texts) != 1 or len(found) != 1 or not text:
                continue
            asked = [
                (guard, decided)
                for guard, decided in self._list_asked(values, fn, call.guard)
                if decided.holds is not True
            ]
            if all(decided.holds is None for _, decided in asked):
                yield values, text, " && ".join(self._spell(guard.kind, guard.text) for guard, _ in asked)

    @staticmethod
    def _list_asked(values: Any, fn: Fn, guard: int) -> Iterator[tuple[Guard, DecidedCondition]]:
        """The conditions around a place of a function that a loop around them asks in each turn."""
        loops = [place for place in fn.list_guards_around(guard) if fn.facts.guards[place].kind in LOOPS]
        lines = {fn.facts.guards[place].line for place in loops}
        for row, decided in values.decide_guards(fn, guard):
            inside = lines and row.line >= min(lines)
            if row.kind in _ASKING and inside:
                yield row, decided

    def _list_ways(self, fn: Fn, guard: int) -> list[Any]:
        """What evaluates expressions on each way to a place of a function: in each turn of the loops around, and
        through each call of it where it is given something. None where there are too many."""
        begun = self._begin()
        callers = self._code.callers.get(fn, ()) if fn.facts.parameters and not self._code.is_constructor(fn) else ()
        found: list[Any] = []
        for caller, call in callers:
            found += self._list_turns(begun.limit_to_calls({fn: call}), caller, call.guard)
        found = [turn for one in found or [begun] for turn in self._list_turns(one, fn, guard)]
        return found if len(found) <= _MOST else []

    @staticmethod
    def _list_turns(values: Any, fn: Fn, guard: int) -> list[Any]:
        found = [values]
        for place in fn.list_guards_around(guard):
            row = fn.facts.guards[place]
            count = values.count_turns(fn, place) if row.kind in LOOPS else 0
            if count and len(found) * count <= _MOST:
                found = [one.limit_to_turn(fn, row.line, turn) for one in found for turn in range(count)]
        return found
