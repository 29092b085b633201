"""Which values of a variable reach a line of a function: what is assigned in turn, under which conditions."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

from ...facts.flow import Assignment, FlowCall
from .code import Fn
from .graph import How
from .variable_tests import VariableTest, read_variable_test

LOOPS = frozenset(("for", "while", "do"))


class FlowValue(NamedTuple):
    """text: what it is worth, None when it is not known; reason says why then, and how is `given` where a launch file
    may say it. beside: it is not known, and holds under some condition in place of values that are. only_if: the
    condition under which it is worth that, where it is not known whether that holds. unpassed: it is given by whoever
    calls a function, and nothing that runs does; uncalled: nothing at all does. shown: of what is not known, what is
    known in part, with brackets for the rest; more: it may be something else, too, of which nothing is known."""

    text: str | None
    how: How = "literal"
    reason: str = ""
    beside: bool = False
    only_if: str = ""
    uncalled: bool = False
    unpassed: bool = False
    shown: str = ""
    more: bool = False

    def mark(self) -> FlowValue:
        """The same as one that may hold in place of others."""
        return self._replace(beside=True) if self.text is None and self.how == "unresolved" else self


class Held(NamedTuple):
    """A value that a variable may have. rank: its place among others; guard: under which it was assigned, -1 for none
    or outside of the function. stays: whether nothing in the function surely takes its place."""

    rank: int
    value: FlowValue
    guard: int = -1
    stays: bool = False


class ReachingValues:
    """The values of one variable in one function, statement by statement. around: the guards of the place at which they
    are asked for, the nearest first. names: whether a path means the variable."""

    def __init__(self, fn: Fn, around: Sequence[int], names: Callable[[str], bool]):
        self.fn, self.around, self._names = fn, around, names
        self.held: list[Held] = []
        # Guards under which the variable is surely assigned.
        self._covered: set[int] = set()

    def may_run(self, guard: int) -> bool:
        """Whether what stands under a guard may run: no test of the variable rules it out for all values."""
        return not any(
            test is not None and before and not any(_may_hold(test, one.value) for one in before)
            for each in self._list_conditional(guard)
            for test, before in [(self.find_test(each), [h for h in self.held if not self._is_inside(h.guard, each)])]
        )

    def exclude(self, guard: int) -> bool:
        """Drops the values for which a guard that tests the variable holds, since another takes their place; gives
        whether it tests the variable."""
        conditional = self._list_conditional(guard)
        test = self.find_test(guard) if conditional else None
        if test is not None and len(conditional) == 1:
            self.held = [
                one for one in self.held
                if self._is_inside(one.guard, guard) or one.value.text is None or test.holds(one.value.text) is not True
            ]  # fmt: skip
        return test is not None

    def assign(self, values: Iterable[FlowValue], guard: int, rank: int = 1) -> None:
        """Values take the place of those that were assigned before, as far as that is sure."""
        values = list(values)
        self.exclude(guard)
        conditional = self._list_conditional(guard)
        self._replace(conditional[0] if conditional else -1)
        self._note_covered(guard)
        self.add(values, guard, rank)

    def add(self, values: Iterable[FlowValue], guard: int = -1, rank: int = 1, *, stays: bool = False) -> None:
        """Values come to those that were assigned before."""
        self.held += [Held(rank, value, guard, stays) for value in values]

    def lessen(self) -> None:
        """Values that were assigned before hold as a default does: a parameter takes their place where it has one."""
        self.held = [one._replace(value=lessen(one.value)) for one in self.held]

    def list_chosen(self, spell: Callable[[Sequence[int]], str], negate: Callable[[int], str]) -> list[FlowValue]:
        """What is left; of several texts each with the condition under which it is assigned here, or is not replaced.
        spell: the condition that some guards of the function are, from the nearest; negate: that of one that does not
        hold."""
        found = self._list_left()
        if len({one.value.text for one in found if one.value.text is not None}) < 2:
            return [one.value for one in found]
        around = {one.guard: self._list_conditional(one.guard) for one in found}
        # Of what may take the place of others, the condition that is the nearest.
        later = [(one.value.text, guard) for one in found if not one.stays for guard in around[one.guard][:1]]
        later = list(dict.fromkeys(row for row in later if row[0] is not None))
        chosen: list[FlowValue] = []
        for one in found:
            guards = around[one.guard]
            known = one.value.text is not None and not one.value.only_if
            if not known or one.stays or guards:
                condition = spell(guards) if known else ""
            else:
                others = dict.fromkeys(guard for text, guard in later if text != one.value.text)
                condition = " && ".join(filter(None, map(negate, others)))
            chosen.append(one.value._replace(only_if=condition) if condition else one.value)
        return chosen

    def list_values(self) -> list[FlowValue]:
        """What is left, as far as the conditions around the place allow it."""
        return [one.value for one in self._list_left()]

    def _list_left(self) -> list[Held]:
        found = self.held
        for guard in self.around:
            test = self.find_test(guard)
            if test is not None:
                found = [h for h in found if self._is_inside(h.guard, guard) or _may_hold(test, h.value)]
        return sorted(found, key=lambda one: one.rank)

    def find_test(self, guard: int) -> VariableTest | None:
        """What a guard asks of the variable."""
        test = read_variable_test(self.fn.facts.guards[guard], self.fn.source.facts.language == "cpp")
        return test if test is not None and self._names(test.path) else None

    def is_sure(self, guard: int) -> bool:
        """Whether what stands under a guard has run when the place is reached."""
        return guard < 0 or guard in self.around

    def is_counted(self, guard: int) -> bool:
        """Whether what stands under a guard runs once at most for each value that was assigned before."""
        loops = [each for each in self.fn.list_guards_around(guard) if self.fn.facts.guards[each].kind in LOOPS]
        return all(self._is_inside(one.guard, loop) for loop in loops for one in self.held)

    def _list_conditional(self, guard: int) -> list[int]:
        """The guards of a statement that are not around the place, the nearest first."""
        return [each for each in self.fn.list_guards_around(guard) if each not in self.around]

    def _is_inside(self, guard: int, outer: int) -> bool:
        return outer in self.fn.list_guards_around(guard)

    def _replace(self, guard: int) -> None:
        """Drops what was assigned under a guard, all for -1."""
        self.held = [one for one in self.held if one.stays or (guard >= 0 and not self._is_inside(one.guard, guard))]

    def _note_covered(self, guard: int) -> None:
        """Notes that the variable is surely assigned under a guard. With the other branch the same holds outside."""
        guards = self.fn.facts.guards
        while guard >= 0 and guard not in self.around:
            self._covered.add(guard)
            one = guards[guard]
            other = {"if": "unless", "unless": "if"}.get(one.kind)
            pair = [
                place
                for place in self._covered
                if (two := guards[place]).kind == other
                and (two.text, two.line, two.outer) == (one.text, one.line, one.outer)
            ]
            if not pair:
                return
            branches = (guard, *pair)
            guard = one.outer
            self.held = [
                h for h in self.held
                if h.stays or any(self._is_inside(h.guard, each) for each in branches)
                or not (self.is_sure(guard) or self._is_inside(h.guard, guard))
            ]  # fmt: skip


def find_last_write(
    fn: Fn, at: FlowCall | Assignment, rows: Iterable[tuple[Fn, FlowCall | Assignment]]
) -> FlowCall | Assignment | None:
    """Of what writes a variable, with the functions that do, that which surely does so last before a statement of a
    function; None for none."""
    around = {-1, *fn.list_guards_around(at.guard)}
    sure = [each for writer, each in rows if writer is fn and each.line < at.line and each.guard in around]
    return max(sure, key=lambda each: each.line, default=None)


def reaches(
    fn: Fn, written: FlowCall | Assignment, at: FlowCall | Assignment, last: FlowCall | Assignment | None
) -> bool:
    """Whether what a function writes to a variable may be what another of its statements meets: nothing surely comes
    between, also where a loop comes back to it. last: what find_last_write() gives for all that write the variable."""
    if last is not None and written.line < last.line:
        return False
    if written.line <= at.line:
        return True
    kept = fn.list_guards_around(last.guard) if last is not None else ()
    turns = set(fn.list_guards_around(at.guard)).intersection(fn.list_guards_around(written.guard)).difference(kept)
    return any(fn.facts.guards[guard].kind in LOOPS for guard in turns)


def lessen(value: FlowValue) -> FlowValue:
    """A value as one that holds where a parameter has none."""
    return value._replace(how="default") if value.text is not None and value.how in ("literal", "given") else value


def _may_hold(test: VariableTest, value: FlowValue) -> bool:
    return value.text is None or test.holds(value.text) is not False
