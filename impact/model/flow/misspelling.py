"""Names that differ by a slip of the pen."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Generic, TypeVar

from ....edges.groups import group_pairs
from ..misspelling import is_slip

T = TypeVar("T")

# Shorter words of one letter's difference are other words.
_SHORTEST = 5
_SIDES = (
    ("left", "right"), ("front", "rear"), ("front", "back"), ("in", "on"), ("up", "down"), ("upper", "lower"),
    ("min", "max"), ("row", "col"), ("input", "output"),
)  # fmt: skip
_SIDE_WORDS = frozenset(word for pair in _SIDES for word in pair) | {"center", "middle", "top", "bottom"}


def is_slip_of_name(one: str, other: str) -> bool:
    """Whether two names differ, in a single part, by a slip: a letter that is wrong, too many, missing or swapped with
    its neighbour, an underscore, or upper and lower case. Digits, and last letters that stand for a side or an axis,
    tell things apart."""
    a, b = one.strip("/").split("/"), other.strip("/").split("/")
    if len(a) != len(b):
        return False
    apart = [(x, y) for x, y in zip(a, b, strict=True) if x != y]
    return len(apart) == 1 and _is_slip_of_part(*apart[0])


def _is_slip_of_part(one: str, other: str) -> bool:
    if re.findall(r"\d+", one) != re.findall(r"\d+", other):
        return False
    plain = one.replace("_", "").lower(), other.replace("_", "").lower()
    if plain[0] == plain[1]:
        return True
    if min(len(one), len(other)) < _SHORTEST or any(one.replace(x, y) == other for x, y in (*_SIDES, *_swap_sides())):
        return False
    if not is_slip(one, other):
        return False
    short, long = sorted((one, other), key=len)
    place = next((i for i, (x, y) in enumerate(zip(short, long, strict=False)) if x != y), len(short))
    if len(short) < len(long):
        return not _is_alone(long, place)
    is_swap = one[place + 1 :] != other[place + 1 :]
    return is_swap or not (_is_alone(one, place) and _is_alone(other, place))


def _swap_sides():
    return ((y, x) for x, y in _SIDES)


def _is_alone(name: str, place: int) -> bool:
    """Whether a letter stands alone, as in `arm_l` and `arm_r`, or ends the name, as in `pose_x`."""
    before = place == 0 or not name[place - 1].isalpha()
    after = place == len(name) - 1 or not name[place + 1].isalpha()
    return before and after


def differs_in_words(one: str, other: str) -> bool:
    """Whether two names differ in a single part, which one of them has more words in: none that is a side or a number,
    which tell things apart."""
    a, b = one.strip("/").split("/"), other.strip("/").split("/")
    apart = [(x, y) for x, y in zip(a, b, strict=False) if x != y]
    if len(a) != len(b) or len(apart) != 1:
        return False
    short, long = sorted((set(part.split("_")) for part in apart[0]), key=len)
    more = long - short
    return short < long and not any(len(word) < 3 or not word.isalpha() or word in _SIDE_WORDS for word in more)


class NearNames(Generic[T]):
    """Things by their names, asked for those whose name is a misspelling of another, or within a namespace of it: as
    is_slip_of_name() and is_in_namespace() say, without comparing every name with every other. Very long names are no
    misspellings.
    """

    def __init__(self, things: Iterable[tuple[str, T]], *, namespaces: bool = False):
        self._named = list(things)
        self._namespaces = namespaces
        names = [(number, name) for number, (name, _) in enumerate(self._named) if len(name) <= _LONGEST]
        self._traces = group_pairs((trace, number) for number, name in names for trace in _compute_traces(name))
        inside = names if namespaces else []
        self._whole = group_pairs((name, number) for number, name in inside)
        self._ends = group_pairs((end, number) for number, name in inside for end in _list_ends(name))

    def find_near(self, name: str) -> Iterator[T]:
        """The things of nearly this name, in their order; at most a thousand are looked at."""
        if len(name) > _LONGEST:
            return
        found: set[int] = set()
        for trace in _compute_traces(name):
            found.update(self._traces.get(trace, ())[:_MOST_ALIKE])
        if self._namespaces:
            found.update(self._ends.get(name, ())[:_MOST_ALIKE])
            for end in _list_ends(name):
                found.update(self._whole.get(end, ())[:_MOST_ALIKE])
        for number in sorted(found)[:_MOST_ALIKE]:
            other, thing = self._named[number]
            if is_slip_of_name(name, other) or (self._namespaces and is_in_namespace(name, other)):
                yield thing


_LONGEST = 200
_MOST_ALIKE = 1000


def _compute_traces(name: str) -> set[str]:
    """Texts of which two names have one in common when one is a slip of the other: the name without a letter."""
    plain = name.strip("/")
    traces = {plain[:at] + plain[at + 1 :] for at in range(len(plain))}
    return {*traces, plain, plain.replace("_", "").lower()}


def _list_ends(name: str) -> Iterator[str]:
    return (name[at:] for at in range(1, len(name)) if len(name) - at >= _SHORTEST - 1)


def is_in_namespace(one: str, other: str) -> bool:
    """Whether one of two names is the other within a namespace."""
    a, b = sorted((one, other), key=len)
    return len(a.strip("/")) >= _SHORTEST - 1 and a != b and b.endswith(a)
