"""Conditions that are asked anew in each turn of a loop, or of each element of a list: where they are not decided, it
is not known for which of the elements something is made."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ....edges.memory import cache_method
from ...facts.flow import Assignment, FlowExpr
from .code import FlowCode, Fn
from .reaching import LOOPS
from .values import find_walked, spell_condition
from .variable_tests import read_variable_test

_WORD = re.compile(r"[A-Za-z_]\w*")
_ASKING = frozenset(("if", "unless", "case"))
_PUT = frozenset(("push_back", "emplace_back", "append", "add", "insert", "emplace"))
# Whether something is among others.
_IS_AMONG = re.compile(
    r"\w+ in ([\w.]+)|([\w.>-]+)\.(?:count|contains)\(\w+\)|([\w.>-]+)\.find\(\w+\) != [\w.>-]+\.end\(\)"
)


class TurnConditions:
    """Asks a body of code for such conditions."""

    def __init__(self, code: FlowCode):
        self.code = code

    @cache_method
    def list_asked(self, fn: Fn, guard: int) -> tuple[int, ...]:
        """The guards, by their places, around a place of a function that ask for the variable of a loop around them;
        but for those that ask for it alone, which values are held against."""
        found: list[int] = []
        around = fn.list_guards_around(guard)
        for place in around:
            row = fn.facts.guards[place]
            if row.kind not in _ASKING or read_variable_test(row, fn.source.facts.language == "cpp") is not None:
                continue
            if row.kind == "unless" and self._is_kept_meanwhile(row.text, fn):
                continue
            words = set(_WORD.findall(row.text))
            loops = [one for one in fn.list_guards_around(place) if fn.facts.guards[one].kind in LOOPS]
            if any(not words.isdisjoint(self._list_variables(fn, loop)) for loop in loops):
                found.append(place)
        return tuple(found)

    @staticmethod
    def _is_kept_meanwhile(text: str, fn: Fn) -> bool:
        """Whether a condition is that something is among what a function itself keeps: made in an earlier turn, it is
        not made again."""
        found = _IS_AMONG.fullmatch(text.strip())
        if found is None:
            return False
        path = re.sub(r"^self\.", "this.", next(filter(None, found.groups())).replace("->", "."))
        targets = {each.target for each in fn.facts.assignments} | {call.target for call in fn.facts.calls}
        puts = {f"{path}.{put}" for put in _PUT}
        return f"{path}.[]" in targets or any(call.callee in puts for call in fn.facts.calls)

    @cache_method
    def _list_variables(self, fn: Fn, loop: int) -> frozenset[str]:
        """The variables that a loop over elements gives a value in each turn."""
        return frozenset(each.target for each, _ in self._list_walks(fn, loop))

    @staticmethod
    def _list_walks(fn: Fn, loop: int) -> Iterator[tuple[Assignment, FlowExpr]]:
        """What a loop over elements assigns in each turn, with what it walks through."""
        for each in fn.facts.assignments:
            if each.guard == loop and each.line == fn.facts.guards[loop].line:
                walked = each.value if each.operator == "for" else find_walked(each)
                if walked is not None:
                    yield each, walked

    @cache_method
    def list_filters(self, fn: Fn, guard: int) -> tuple[str, ...]:
        """The conditions under which elements are put into the lists that the loops around a place of a function walk
        through."""
        found: list[str] = []
        for place in fn.list_guards_around(guard):
            if fn.facts.guards[place].kind in LOOPS:
                walked = (container for _, container in self._list_walks(fn, place))
                found += [text for container in walked for text in self._list_filters_of(container, fn)]
        return tuple(dict.fromkeys(found))

    def _list_filters_of(self, walked: FlowExpr, fn: Fn) -> Iterator[str]:
        if walked.kind != "name":
            return
        for call in fn.facts.calls:
            head, _, last = call.callee.rpartition(".")
            if last in _PUT and head == walked.text:
                rows = (fn.facts.guards[place] for place in self.list_asked(fn, call.guard))
                yield from (spell_condition(row.kind, row.text) for row in rows)
