"""Who calls whom in the code of a workspace, and what triggers it: small enough to be kept beside the graph."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator
from functools import cached_property
from typing import NamedTuple

import msgspec

from ....edges.groups import group_pairs
from .code import Fn
from .graph import Trigger
from .join import Join

_DEEPEST = 8


class Called(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A function. name: as facts have it; callers: places in Callers.functions; triggers: what runs it by itself."""

    path: str
    name: str
    line: int
    callers: tuple[int, ...] = ()
    triggers: tuple[Trigger, ...] = ()


class Led(NamedTuple):
    """What leads to a function. steps: calls between; callback: the function that is triggered."""

    trigger: Trigger
    steps: int
    callback: Called


class Callers(msgspec.Struct, frozen=True, array_like=True, dict=True):
    """All functions that something is called or triggered by, or that call something."""

    functions: tuple[Called, ...] = ()

    @cached_property
    def _places(self) -> dict[tuple[str, str, int], int]:
        return {(one.path, one.name, one.line): place for place, one in enumerate(self.functions)}

    @cached_property
    def _callees(self) -> dict[int, list[int]]:
        return group_pairs((caller, place) for place, one in enumerate(self.functions) for caller in one.callers)

    def list_triggers(self, path: str, name: str, line: int) -> list[Led]:
        """What triggers a function, itself or through its callers, nearest first."""
        place = self._places.get((path, name, line))
        if place is None:
            return []
        found: dict[Trigger, Led] = {}
        for each, steps in self._walk(place, lambda at: self.functions[at].callers):
            one = self.functions[each]
            for trigger in one.triggers:
                found.setdefault(trigger, Led(trigger, steps, one))
        return list(found.values())

    def list_called(self, path: str, name: str, line: int) -> list[Called]:
        """A function and all that it calls, nearest first; empty where it is not known."""
        place = self._places.get((path, name, line))
        if place is None:
            return []
        return [self.functions[each] for each, _ in self._walk(place, lambda at: self._callees.get(at, ()))]

    def _walk(self, start: int, following) -> Iterator[tuple[int, int]]:
        seen = {start}
        queue = deque([(start, 0)])
        while queue:
            place, steps = queue.popleft()
            yield place, steps
            if steps < _DEEPEST:
                fresh: Iterable[int] = [each for each in following(place) if each not in seen]
                seen.update(fresh)
                queue.extend((each, steps + 1) for each in fresh)


def build_callers(join: Join) -> Callers:
    """The callers of all functions of a Join."""
    code, triggers = join.code, join.triggers
    above: dict[Fn, list[Fn]] = {}
    for fn in code.functions:
        calling = [caller for caller, _ in code.callers.get(fn, ())]
        if not calling and not triggers.get(fn):
            # What is only defined there, a lambda or an inner function, runs because of what is around it.
            around = code.find_enclosing(fn)
            calling = [around] if around is not None else []
        above[fn] = list(dict.fromkeys(calling))
    calls = {caller for calling in above.values() for caller in calling}
    kept = [fn for fn in code.functions if above[fn] or triggers.get(fn) or fn in calls]
    places = {fn: place for place, fn in enumerate(kept)}
    return Callers(
        tuple(
            Called(
                fn.source.path, fn.name, fn.facts.line, tuple(places[caller] for caller in above[fn]),
                tuple(dict.fromkeys(triggers.get(fn, ()))),
            )
            for fn in kept
        )
    )  # fmt: skip
