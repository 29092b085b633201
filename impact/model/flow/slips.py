"""Names that differ by a slip of the pen."""

from __future__ import annotations

import re

# Shorter words of one letter's difference are other words.
_SHORTEST = 5
_SIDES = (
    ("left", "right"), ("front", "rear"), ("front", "back"), ("in", "on"), ("up", "down"), ("upper", "lower"),
    ("min", "max"), ("row", "col"), ("input", "output"),
)  # fmt: skip


def is_slip(one: str, other: str) -> bool:
    """Whether two names differ, in a single part, by a slip: a letter that is wrong, too many, missing or swapped with
    its neighbour, an underscore, or upper and lower case. Digits, and last letters that stand for a side or an axis,
    tell things apart."""
    a, b = one.strip("/").split("/"), other.strip("/").split("/")
    if len(a) != len(b):
        return False
    apart = [(x, y) for x, y in zip(a, b, strict=True) if x != y]
    return len(apart) == 1 and _is_slip(*apart[0])


def _is_slip(one: str, other: str) -> bool:
    if re.findall(r"\d+", one) != re.findall(r"\d+", other):
        return False
    plain = one.replace("_", "").lower(), other.replace("_", "").lower()
    if plain[0] == plain[1]:
        return True
    if min(len(one), len(other)) < _SHORTEST or any(one.replace(x, y) == other for x, y in (*_SIDES, *_turned())):
        return False
    if len(one) == len(other):
        wrong = [place for place, (x, y) in enumerate(zip(one, other, strict=True)) if x != y]
        if len(wrong) == 1:
            return not _tells(one, other, wrong[0])
        first = wrong[0]
        return len(wrong) == 2 and wrong[1] == first + 1 and one[first : first + 2] == other[first : first + 2][::-1]
    short, long = sorted((one, other), key=len)
    if len(long) - len(short) != 1:
        return False
    place = next((i for i, (x, y) in enumerate(zip(short, long, strict=False)) if x != y), len(short))
    return short[place:] == long[place + 1 :] and not _alone(long, place)


def _turned():
    return ((y, x) for x, y in _SIDES)


def _tells(one: str, other: str, place: int) -> bool:
    """Whether a letter that differs stands alone, as in `arm_l` and `arm_r`, or ends the name, as in `pose_x`."""
    return _alone(one, place) and _alone(other, place)


def _alone(name: str, place: int) -> bool:
    before = place == 0 or not name[place - 1].isalpha()
    after = place == len(name) - 1 or not name[place + 1].isalpha()
    return before and after


def is_in_namespace(one: str, other: str) -> bool:
    """Whether one of two names is the other within a namespace."""
    a, b = sorted((one, other), key=len)
    return len(a.strip("/")) >= _SHORTEST - 1 and a != b and b.endswith(a)
