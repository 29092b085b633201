"""What a text has to contain so that a regular expression can match: asked first, since that is much cheaper."""

import re
from collections.abc import Iterator, Sequence
from functools import lru_cache
from typing import Any

from ...edges.patterns import names as codes
from ...edges.patterns import parser

# One parsed part of an expression: its code, and what belongs to it.
_Part = tuple[Any, Any]
_REPEATS = (codes.MAX_REPEAT, codes.MIN_REPEAT)
_NO_WIDTH = (codes.AT, codes.ASSERT, codes.ASSERT_NOT)
_BLANK = [(codes.IN, [(codes.CATEGORY, codes.CATEGORY_SPACE)])]
_WORD = re.compile(r"\w+")
_ANY_CASE = re.compile(r"\(\?[a-zA-Z]*i")


@lru_cache(maxsize=4096)
def find_needed(expression: str, shortest: int = 4) -> tuple[tuple[str, ...], ...]:
    """Words, or parts of them, that stand in whatever a regular expression matches: one of each tuple. shortest: the
    least number of characters of those that are told."""
    return tuple(dict.fromkeys(_find_needed(_parse(expression), shortest)))


def has_needed(expression: str, text: str) -> bool:
    """False where a text shows at once that an expression is not found in it."""
    return all(any(word in text for word in words) for words in find_needed(expression, 2))


@lru_cache(maxsize=4096)
def find_last_literals(expression: str) -> tuple[str, ...]:
    """Strings with one of which whatever a regular expression matches ends, blanks behind it aside; empty where they
    are not known."""
    return _ends(_parse(expression))


def _parse(expression: str) -> Sequence[Any]:
    """The parts of an expression; none where it does not mind upper and lower case."""
    return [] if _ANY_CASE.search(expression) else [*parser.parse(expression)]


def _find_needed(parts: Sequence[_Part], shortest: int) -> Iterator[tuple[str, ...]]:
    run = ""
    for code, value in [*parts, (None, None)]:
        if code is codes.LITERAL:
            run += chr(value)
            continue
        if code in _NO_WIDTH and code is not codes.ASSERT:
            continue
        yield from ((word,) for word in _WORD.findall(run) if len(word) >= shortest)
        run = ""
        if code is codes.SUBPATTERN:
            yield from _find_needed(value[-1], shortest)
        elif code is codes.ASSERT:
            yield from _find_needed(value[1], shortest)
        elif code in _REPEATS and value[0]:
            yield from _find_needed(value[2], shortest)
        elif code is codes.BRANCH:
            ways = [next(_find_needed(way, shortest), ()) for way in value[1]]
            if all(ways):
                yield tuple(word for words in ways for word in words)


def _ends(parts: Sequence[_Part]) -> tuple[str, ...]:
    left = list(parts)
    while left and (left[-1][0] in _NO_WIDTH or (left[-1][0] in _REPEATS and list(left[-1][1][2]) == _BLANK)):
        left.pop()
    run = ""
    while left and left[-1][0] is codes.LITERAL:
        run = chr(left.pop()[1]) + run
    if run or not left:
        return (run,) if run.strip() == run != "" else ()
    code, value = left[-1]
    if code is codes.SUBPATTERN:
        return _ends(value[-1])
    if code in _REPEATS or code is codes.BRANCH:
        # What may be left out has what stands before it at its end.
        ways = value[1] if code is codes.BRANCH else [value[2]] if value[0] else [value[2], left[:-1]]
        each = [_ends(way) for way in ways]
        return tuple(end for ends in each for end in ends) if all(each) else ()
    if code is codes.IN and all(inner is codes.LITERAL and not chr(at).isspace() for inner, at in value):
        return tuple(chr(at) for _, at in value)
    return ()
