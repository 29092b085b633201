"""CMake's regular expressions on top of Python's, kept from running away.

CMake knows `. [] * + ? ^ $ () |` and no more (string(), "Regex Specification"); a backslash only makes the next
character literal.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Literal

_MAX_STEPS = 250_000

# What one match may cost at most, in commands (see Interpreter.spend).
REGEX_STEPS = 25


@lru_cache(maxsize=512)
def compiled(pattern: str) -> tuple[re.Pattern[str] | None, int, bool]:
    """The pattern for Python, None when it is malformed; how many unbounded repeats it has; whether they nest."""
    out: list[str] = []
    index = 0
    repeats = 0
    groups: list[bool] = []  # per open group: does it hold a repeat or an alternative
    closed_with_repeat = False
    nested = False
    while index < len(pattern):
        letter = pattern[index]
        after_group = closed_with_repeat
        closed_with_repeat = False
        if letter == "\\":
            following = pattern[index + 1 : index + 2]
            out.append(re.escape(following))
            index += 2
            continue
        if letter == "[":
            end = pattern.find("]", index + (3 if pattern[index + 1 : index + 2] == "^" else 2))
            if end < 0:
                return None, 0, False
            inner = pattern[index + 1 : end]
            negated = inner.startswith("^")
            inner = inner[1:] if negated else inner
            inner = inner.replace("\\", "\\\\").replace("[", "\\[").replace("]", "\\]").replace("&&", "&\\&")
            inner = inner.replace("||", "|\\|").replace("~~", "~\\~").replace("^", "\\^")
            if inner[1:-1].find("--") >= 0:
                inner = inner.replace("--", "-\\-")
            out.append(f"[{'^' if negated else ''}{inner}]")
            index = end + 1
            continue
        if letter in "*+":
            repeats += 1
            nested = nested or after_group
            if groups:
                groups[-1] = True
        elif letter == "|":
            if groups:
                groups[-1] = True
        elif letter == "(":
            groups.append(False)
            if pattern[index + 1 : index + 2] == "?":
                return None, 0, False
        elif letter == ")" and groups:
            closed_with_repeat = groups.pop()
            if groups and closed_with_repeat:
                groups[-1] = True
        elif letter == "$":
            out.append(r"\Z")
            index += 1
            continue
        elif letter in "{}":
            letter = "\\" + letter
        out.append(letter)
        index += 1
    try:
        return re.compile("".join(out), re.DOTALL), repeats, nested
    except (re.error, RecursionError, OverflowError):
        return None, 0, False


def usable(pattern: str, text: str) -> re.Pattern[str] | None:
    """The pattern when it is well formed and sure to finish soon on this text."""
    made, repeats, nested = compiled(pattern)
    if made is None:
        return None
    length = len(text)
    if nested and length > 16:
        return None
    # A backtracking match takes up to length**repeats steps.
    if repeats > 1 and repeats * length.bit_length() > _MAX_STEPS.bit_length():
        return None
    return made


def match(pattern: str, text: str) -> tuple[str, ...] | Literal[False] | None:
    """The match (all of it, then the groups), False when there is none, None when it cannot be told."""
    made = usable(pattern, text)
    if made is None:
        return None
    found = made.search(text)
    return (found.group(), *(group or "" for group in found.groups())) if found else False
