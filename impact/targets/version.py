"""Versions as dotted numbers, compared as Debian and CMake compare plain ones."""

import re
from collections.abc import Sequence
from functools import lru_cache

_NUMBER = re.compile(r"\d+")


@lru_cache(maxsize=20000)
def parse(version: str) -> tuple[int, ...]:
    """`4.5.4+dfsg-9ubuntu4` gives (4, 5, 4): epoch, revision and packaging suffixes are left out."""
    text = version.split(":", 1)[-1]
    text = re.split(r"[-+~]", text, maxsplit=1)[0]
    return tuple(parse_number(n) for n in _NUMBER.findall(text)[:4])


def parse_number(digits: str) -> int:
    """A number of a version. Python refuses to read thousands of digits; of more than forty, the first forty count."""
    return int(digits[:40])


@lru_cache(maxsize=20000)
def _strip_zeros(version: str) -> tuple[int, ...]:
    """The parts without zeros at their end, which tuples are compared by as if missing parts were zeros."""
    found = parse(version)
    while found and not found[-1]:
        found = found[:-1]
    return found


def compare(a: str, b: str) -> int:
    """-1, 0 or 1. Missing parts count as 0, as in CMake's VERSION_LESS."""
    left, right = _strip_zeros(a), _strip_zeros(b)
    return (left > right) - (left < right)


def is_at_least(version: str, bound: str) -> bool:
    """True when version is bound or newer."""
    return _strip_zeros(version) >= _strip_zeros(bound)


def find_newest_up_to(bound: str, versions: Sequence[str]) -> str | None:
    """The last of some versions, oldest first, that is not newer than the bound; None where all are."""
    highest = _strip_zeros(bound)
    return next((version for version in reversed(versions) if _strip_zeros(version) <= highest), None)
