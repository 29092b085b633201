"""Everything that can be reached in a graph of names, kept as one bit for each name: unions of thousands of names then
cost next to nothing."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator
from typing import TypeVar

Name = TypeVar("Name", bound=Hashable)

# The names that a name leads to, and names that come along with it and lead nowhere.
_Look = Callable[[str], tuple[Iterable[str], Iterable[str]]]


class Reach:
    """A graph that is looked at when it is asked for, every name once. look: what a name leads to."""

    def __init__(self, look: _Look):
        self._look = look
        self._names: list[str] = []
        self._bits: dict[str, int] = {}
        self._masks: dict[str, tuple[int, int]] = {}

    def assign_bit(self, name: str) -> int:
        """The bit that stands for a name."""
        known = self._bits.get(name)
        if known is None:
            known = self._bits[name] = 1 << len(self._names)
            self._names.append(name)
        return known

    def combine_bits(self, names: Iterable[str]) -> int:
        """The bits of several names."""
        found, known = 0, self._bits
        for name in names:
            found |= known.get(name) or self.assign_bit(name)
        return found

    def list_names(self, mask: int) -> Iterator[str]:
        """The names whose bits a mask has."""
        for place, byte in enumerate(mask.to_bytes(-(-mask.bit_length() // 8), "little")):
            while byte:
                lowest = byte & -byte
                yield self._names[8 * place + lowest.bit_length() - 1]
                byte ^= lowest

    def collect_masks(self, names: Iterable[str]) -> tuple[int, int]:
        """The names that some lead to over any number of steps, themselves included, and those that come along."""
        reached = along = 0
        for name in names:
            leads, beside = self._masks.get(name) or self._find_masks(name)
            reached |= leads
            along |= beside
        return reached, along

    def collect_known_masks(self, names: Iterable[str]) -> tuple[int, int]:
        """The same as far as it is known without looking further."""
        reached = along = 0
        for name in names:
            leads, beside = self._masks.get(name) or (self.assign_bit(name), 0)
            reached |= leads
            along |= beside
        return reached, along

    def _find_masks(self, name: str) -> tuple[int, int]:
        """The same of one name. By Tarjan's algorithm: names that lead to each other have the same masks."""
        masks = self._masks
        order: dict[str, int] = {}
        low: dict[str, int] = {}
        component: list[str] = []
        path: list[_Step] = []
        waiting: str | None = name
        while True:
            if waiting is not None:
                order[waiting] = low[waiting] = len(order)
                component.append(waiting)
                leads, along = self._look(waiting)
                path.append(_Step(waiting, iter(leads), self.assign_bit(waiting), self.combine_bits(along)))
                waiting = None
            step = path[-1]
            for to in step.leads:
                known = masks.get(to)
                if known is not None:
                    step.reached |= known[0]
                    step.along |= known[1]
                elif to not in order:
                    waiting = to
                    break
                elif order[to] < low[step.name]:
                    low[step.name] = order[to]
            if waiting is not None:
                continue
            path.pop()
            if low[step.name] == order[step.name]:
                found = step.reached, step.along
                while True:
                    member = component.pop()
                    masks[member] = found
                    if member == step.name:
                        break
            if not path:
                return masks[name]
            above = path[-1]
            above.reached |= step.reached
            above.along |= step.along
            low[above.name] = min(low[above.name], low[step.name])


class _Step:
    """A name on the way, what of it was not looked at yet, and the bits that were found."""

    __slots__ = ("along", "leads", "name", "reached")

    def __init__(self, name: str, leads: Iterator[str], reached: int, along: int):
        self.name, self.leads, self.reached, self.along = name, leads, reached, along


def walk(start: Iterable[Name], leads: Callable[[Name], Iterable[Name]]) -> Iterator[Name]:
    """Everything that can be reached, each once, the start included. leads: where a thing leads to."""
    waiting = list(start)
    seen: set[Name] = set()
    while waiting:
        name = waiting.pop()
        if name not in seen:
            seen.add(name)
            yield name
            waiting.extend(leads(name))


class TransitiveNames:
    """Everything that names lead to, themselves included, kept name by name. leads: where a name leads to."""

    def __init__(self, leads: Callable[[str], Iterable[str]]):
        self._leads = leads
        self._known: dict[str, frozenset[str]] = {}

    def collect(self, names: Iterable[str]) -> frozenset[str]:
        """All that some names lead to."""
        return frozenset().union(*map(self._collect_one, names))

    def _collect_one(self, name: str) -> frozenset[str]:
        known = self._known
        if name not in known:
            found, waiting = {name}, [name]
            while waiting:
                for other in self._leads(waiting.pop()):
                    if other in found:
                        continue
                    found.add(other)
                    if other in known:
                        found |= known[other]
                    else:
                        waiting.append(other)
            known[name] = frozenset(found)
        return known[name]
