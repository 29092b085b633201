"""CMake's regular expressions on top of Python's, kept from running away.

CMake knows `. [] * + ? ^ $ () |` and no more (string(), "Regex Specification"); a backslash only makes the next
character literal.
"""

import re
from collections.abc import Callable
from functools import lru_cache
from typing import Literal, NamedTuple

# What a match may cost at most: as a power of two, of steps from one place of the text on, ...
_MAX_BITS = 18
# ... of choices on the way, each of which may double the steps, ...
_MAX_CHOICES = 10
# ... and in characters, for an expression that is looked for from every place on.
_MAX_LENGTH = 30_000
# Steps of Python's matcher that take as long as one short command (see Interpreter.spend), as a power of two.
_STEP_BITS = 15

# What one match costs at least, in commands.
REGEX_STEPS = 25


class Expression(NamedTuple):
    """A CMake expression made ready for Python.

    matcher: None when it is malformed. repeats: how many unbounded repeats it has. nested: how many of those repeat
    something that repeats or offers a choice. choices: how many choices there are, as a power of two.
    """

    matcher: re.Pattern[str] | None
    repeats: int = 0
    nested: int = 0
    choices: int = 0


@lru_cache(maxsize=512)
def compile_expression(pattern: str) -> Expression:
    """An expression for Python."""
    out: list[str] = []
    index = 0
    repeats = 0
    groups: list[bool] = []  # per open group: does it hold a repeat or an alternative
    alternatives = [0]  # so far, at the top and per open group
    closed_with_repeat = False
    nested = choices = 0
    if len(pattern) > _MAX_LENGTH:
        return Expression(None)
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
                return Expression(None)
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
            nested += after_group
            if groups:
                groups[-1] = True
        elif letter in "|?":
            if letter == "?":
                choices += 1
            else:
                alternatives[-1] += 1
            if groups:
                groups[-1] = True
        elif letter == "(":
            groups.append(False)
            alternatives.append(0)
            if pattern[index + 1 : index + 2] == "?":
                return Expression(None)
        elif letter == ")" and groups:
            closed_with_repeat = groups.pop()
            choices += alternatives.pop().bit_length()
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
        return Expression(re.compile("".join(out), re.DOTALL), repeats, nested, choices + alternatives[0].bit_length())
    except (re.error, RecursionError, OverflowError):
        return Expression(None)


def compile_if_usable(pattern: str, text: str, spend: Callable[[int], None]) -> re.Pattern[str] | None:
    """The pattern when it is well formed and sure to finish soon on this text. spend: gets what matching it costs, in
    short commands, beyond REGEX_STEPS."""
    made, repeats, nested, choices = compile_expression(pattern)
    if made is None:
        return None
    length = len(text)
    # A repeat of what repeats can part a text in as many ways as there are subsets of its places.
    if nested and length > 16 // nested:
        return None
    # A backtracking match takes up to length**repeats steps from each place.
    bits = length.bit_length()
    if repeats > 1 and repeats * bits > _MAX_BITS:
        return None
    if choices > _MAX_CHOICES or (repeats and length > _MAX_LENGTH):
        return None
    places = 0 if pattern.startswith("^") else bits
    steps = repeats * bits + places + (length if nested else 0) + choices
    # Bits round up: a lone repeat and the places to begin at make a half of length**2.
    spend(1 << steps - _STEP_BITS - repeats - 1 if steps > _STEP_BITS + repeats + 1 else 0)
    return made


def match(pattern: str, text: str, spend: Callable[[int], None]) -> tuple[str, ...] | Literal[False] | None:
    """The match (all of it, then the groups), False when there is none, None when it cannot be known."""
    made = compile_if_usable(pattern, text, spend)
    if made is None:
        return None
    found = made.search(text)
    return (found.group(), *(group or "" for group in found.groups())) if found else False
