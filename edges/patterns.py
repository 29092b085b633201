"""Python's regular expressions, matched in time that does not run away.

Patterns of a workspace's settings are anybody's. re backtracks, and a pattern such as `(a+)+$` keeps it busy for ever;
here all ways through a pattern are followed at once (Thompson's simulation), which takes time in proportion to the
pattern times the text. Python's own parser reads the pattern.
"""

from __future__ import annotations

import re
import sys
import warnings
from functools import lru_cache
from typing import Any

if sys.version_info >= (3, 11):
    from re import _constants as names  # pyright: ignore[reportAttributeAccessIssue]
    from re import _parser as parser  # pyright: ignore[reportAttributeAccessIssue]
else:
    import sre_constants as names
    import sre_parse as parser

_LONGEST = 1_000
_STATES_AT_MOST = 5_000
_STEPS_AT_MOST = 2_000_000
_WORD, _DIGIT, _SPACE = re.compile(r"\w"), re.compile(r"\d"), re.compile(r"\s")
_CATEGORIES = {
    names.CATEGORY_WORD: (_WORD, True), names.CATEGORY_NOT_WORD: (_WORD, False),
    names.CATEGORY_DIGIT: (_DIGIT, True), names.CATEGORY_NOT_DIGIT: (_DIGIT, False),
    names.CATEGORY_SPACE: (_SPACE, True), names.CATEGORY_NOT_SPACE: (_SPACE, False),
}  # fmt: skip
_START = (names.AT_BEGINNING, names.AT_BEGINNING_STRING)

# A state: what it takes (a test of one character, a position, or nothing) and the states after it.
_State = list[Any]


class PatternError(ValueError):
    """A pattern that is not matched: no regular expression, or one of a kind that cannot be matched safely."""


@lru_cache(maxsize=256)
def _compile_pattern(pattern: str) -> tuple[list[_State], int]:
    """(states, the first). State 0 is the end. Raises PatternError."""
    if len(pattern) > _LONGEST:
        raise PatternError(f"longer than {_LONGEST:,} characters")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            parsed = parser.parse(pattern)
    except (re.error, RecursionError, OverflowError) as error:
        raise PatternError(f"no regular expression: {error}") from None
    if parsed.state.flags & ~re.UNICODE:
        raise PatternError("flags are not matched")
    states: list[_State] = [[None, None, ()]]
    try:
        return states, _build(states, parsed, 0)
    except RecursionError:
        raise PatternError("nested too deeply") from None


def _add(states: list[_State], kind: Any, argument: Any, after: tuple[int, ...]) -> int:
    if len(states) >= _STATES_AT_MOST:
        raise PatternError("its repetitions come to too much")
    states.append([kind, argument, after])
    return len(states) - 1


def _build(states: list[_State], parsed: Any, after: int) -> int:
    """The first state of a part of a pattern that goes on with a state."""
    for kind, argument in reversed(list(parsed)):
        after = _build_one(states, kind, argument, after)
    return after


def _build_one(states: list[_State], kind: Any, argument: Any, after: int) -> int:
    if kind in (names.LITERAL, names.NOT_LITERAL, names.ANY, names.IN, names.AT):
        return _add(states, kind, argument, (after,))
    if kind is names.SUBPATTERN:
        _, added, removed, inner = argument
        if added or removed:
            raise PatternError("flags are not matched")
        return _build(states, inner, after)
    if kind is names.BRANCH:
        return _add(states, None, None, tuple(_build(states, each, after) for each in argument[1]))
    if kind in (names.MAX_REPEAT, names.MIN_REPEAT):
        least, most, inner = argument
        if most is names.MAXREPEAT:
            loop = _add(states, None, None, ())
            states[loop][2] = (_build(states, inner, loop), after)
            after = loop
        else:
            end = after
            for _ in range(most - least):
                after = _add(states, None, None, (_build(states, inner, after), end))
        for _ in range(least):
            after = _build(states, inner, after)
        return after
    raise PatternError(f"{str(kind).lower()} is not matched")


def compute_cost(pattern: str, text: str) -> int:
    """How many steps matching a text may take. Raises PatternError."""
    return len(_compile_pattern(pattern)[0]) * (len(text) + 1)


def matches(pattern: str, text: str) -> bool:
    """Whether re.match() would find the pattern at the beginning of a text. Raises PatternError."""
    states, first = _compile_pattern(pattern)
    left = _STEPS_AT_MOST
    current = {first}
    for at in range(len(text) + 1):
        # All states that are reached without taking a character.
        pending, reached = list(current), set(current)
        while pending:
            kind, argument, after = states[pending.pop()]
            if kind is None or (kind is names.AT and _holds(argument, text, at)):
                for each in after:
                    if each not in reached:
                        reached.add(each)
                        pending.append(each)
        if 0 in reached:
            return True
        left -= len(reached)
        if at == len(text) or not reached:
            return False
        if left < 0:
            raise PatternError("takes too long")
        character = text[at]
        current = set()
        for state in reached:
            kind, argument, after = states[state]
            if kind is not None and kind is not names.AT and _takes(kind, argument, character):
                current.update(after)
    return False


def _holds(position: Any, text: str, at: int) -> bool:
    if position in _START:
        return at == 0
    if position is names.AT_END_STRING:
        return at == len(text)
    if position is names.AT_END:
        return at == len(text) or (at == len(text) - 1 and text[at] == "\n")
    if not text and sys.version_info < (3, 14):
        return False  # neither is found in nothing
    boundary = _is_word(text, at - 1) != _is_word(text, at)
    return boundary if position is names.AT_BOUNDARY else not boundary


def _is_word(text: str, at: int) -> bool:
    return 0 <= at < len(text) and _WORD.match(text[at]) is not None


def _takes(kind: Any, argument: Any, character: str) -> bool:
    if kind is names.LITERAL:
        return ord(character) == argument
    if kind is names.NOT_LITERAL:
        return ord(character) != argument
    if kind is names.ANY:
        return character != "\n"
    taken = True
    for what, value in argument:
        if what is names.NEGATE:
            taken = False
        elif what is names.CATEGORY:
            test, expected = _CATEGORIES[value]
            if (test.match(character) is not None) == expected:
                return taken
        elif what is names.LITERAL:
            if ord(character) == value:
                return taken
        elif value[0] <= ord(character) <= value[1]:
            return taken
    return not taken
