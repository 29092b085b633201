"""The tests of if(), elseif() and while(), three-valued: True, False, or None when it cannot be known.

Source of the rules: cmake-commands(7), if(): parentheses first, then unary tests, binary tests, NOT, and then AND
and OR from left to right.
"""

from __future__ import annotations

import re
from typing import NamedTuple, Protocol

from .names import name_set
from .regex import match
from .values import Value, split_list

MAX_DEPTH = 60

_TRUE = frozenset({"1", "ON", "YES", "TRUE", "Y"})
_FALSE = frozenset({"", "0", "OFF", "NO", "FALSE", "N", "IGNORE", "NOTFOUND"})
_NUMBER = re.compile(r"\s*[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?\s*\Z")
_IDENTIFIER = re.compile(r"[A-Za-z_][A-Za-z0-9_.]*\Z")
_UNARY = name_set(
    """
    COMMAND POLICY TARGET TEST DEFINED EXISTS IS_DIRECTORY IS_SYMLINK IS_ABSOLUTE IS_READABLE IS_WRITABLE
    IS_EXECUTABLE
    """
)
_BINARY = name_set(
    """
    EQUAL LESS GREATER LESS_EQUAL GREATER_EQUAL STREQUAL STRLESS STRGREATER STRLESS_EQUAL STRGREATER_EQUAL
    VERSION_EQUAL VERSION_LESS VERSION_GREATER VERSION_LESS_EQUAL VERSION_GREATER_EQUAL MATCHES IN_LIST PATH_EQUAL
    IS_NEWER_THAN
    """
)
_COMPARISONS = {
    "EQUAL": lambda one, other: one == other,
    "LESS": lambda one, other: one < other,
    "GREATER": lambda one, other: one > other,
    "LESS_EQUAL": lambda one, other: one <= other,
    "GREATER_EQUAL": lambda one, other: one >= other,
}


class Token(NamedTuple):
    """One argument of if() after expansion. written: it stands in the file as it is, no reference in it."""

    text: str
    quoted: bool
    sure: bool
    written: bool


class World(Protocol):
    """What a condition may ask."""

    def variable(self, name: str) -> Value | None: ...

    def is_target(self, name: str) -> bool | None: ...

    def is_command(self, name: str) -> bool | None: ...

    def path_exists(self, path: str, directory: bool) -> bool | None: ...

    def matched(self, groups: tuple[str, ...]) -> None: ...

    def quotes_protect(self) -> bool: ...

    def spend(self, steps: int) -> None: ...


def evaluate(tokens: list[Token], world: World) -> bool | None:
    """The value of a condition, None when it depends on what is not known or is malformed."""
    if not tokens:
        return False
    parser = _Parser(tokens, world)
    value = parser.either(0)
    return value if parser.position == len(tokens) else None


def text_of(tokens: list[Token]) -> str:
    """The condition for a reader: arguments with one space between them."""
    return " ".join(token.text if token.text else '""' for token in tokens)


def constant(text: str) -> bool | None:
    """The truth of a constant, None when the text is no constant."""
    upper = text.upper()
    if upper in _TRUE:
        return True
    if upper in _FALSE or upper.endswith("-NOTFOUND"):
        return False
    if _NUMBER.match(text):
        return float(text) != 0
    return None


def version_key(text: str) -> tuple[int, ...]:
    """A version as CMake compares it: leading digits of each component, trailing zeros ignored."""
    numbers: list[int] = []
    for part in text.split("."):
        digits = re.match(r"\d+", part)
        if not digits:
            break
        numbers.append(int(digits.group()[:18]))
        if digits.end() != len(part):
            break
    while numbers and numbers[-1] == 0:
        numbers.pop()
    return tuple(numbers)


class _Parser:
    def __init__(self, tokens: list[Token], world: World):
        self.tokens = tokens
        self.world = world
        self.position = 0

    def peek(self) -> Token | None:
        return self.tokens[self.position] if self.position < len(self.tokens) else None

    def keyword(self, *names: str) -> str:
        token = self.peek()
        return token.text if token is not None and not token.quoted and token.text in names else ""

    def either(self, depth: int) -> bool | None:
        value = self.negation(depth)
        while True:
            operator = self.keyword("AND", "OR")
            if not operator:
                return value
            self.position += 1
            other = self.negation(depth)
            if operator == "AND":
                value = False if value is False or other is False else (None if None in (value, other) else True)
            else:
                value = True if value is True or other is True else (None if None in (value, other) else False)

    def negation(self, depth: int) -> bool | None:
        negated = False
        while self.keyword("NOT"):
            self.position += 1
            negated = not negated
        value = self.test(depth)
        return value if value is None or not negated else not value

    def test(self, depth: int) -> bool | None:
        token = self.peek()
        if token is None:
            return None
        self.position += 1
        if token.text == "(" and not token.quoted:
            if depth >= MAX_DEPTH:
                self.position = len(self.tokens) + 1
                return None
            value = self.either(depth + 1)
            if self.keyword(")"):
                self.position += 1
                return value
            self.position = len(self.tokens) + 1
            return None
        if not token.quoted and token.text in _UNARY and self.peek() is not None:
            operand = self.tokens[self.position]
            if operand.quoted or operand.text not in _BINARY:
                self.position += 1
                return self.unary(token.text, operand)
        operator = self.peek()
        if operator is not None and not operator.quoted and operator.text in _BINARY:
            right = self.tokens[self.position + 1] if self.position + 1 < len(self.tokens) else None
            if right is not None:
                self.position += 2
                return self.binary(token, operator.text, right)
        return self.truth(token)

    def truth(self, token: Token) -> bool | None:
        if not token.sure:
            return None
        value = constant(token.text)
        if value is not None:
            return value
        if token.quoted and self.world.quotes_protect():
            return False
        held = self.world.variable(token.text)
        if held is None:
            if "${" in token.text or "$ENV{" in token.text:
                return None
            return None if _IDENTIFIER.match(token.text) else False
        if not held.sure:
            return None
        if not held.defined:
            return False
        value = constant(held.text)
        return True if value is None else value

    def unary(self, name: str, operand: Token) -> bool | None:
        if name == "DEFINED":
            if not operand.sure or operand.text.startswith(("ENV{", "CACHE{")):
                return None
            held = self.world.variable(operand.text)
            if held is None:
                return None
            return held.defined if held.sure else None
        if not operand.sure:
            return None
        text = operand.text
        if name == "POLICY":
            return True
        if name == "TARGET":
            return self.world.is_target(text)
        if name == "COMMAND":
            return self.world.is_command(text)
        if name == "EXISTS":
            return self.world.path_exists(text, False)
        if name == "IS_DIRECTORY":
            return self.world.path_exists(text, True)
        if name == "IS_ABSOLUTE":
            return text.startswith("/")
        return None

    def operand(self, token: Token, left: bool) -> tuple[str, bool]:
        """Text of an operand after automatic dereference, and whether it is known."""
        if not token.sure:
            return token.text, False
        if token.quoted and self.world.quotes_protect():
            return token.text, True
        held = self.world.variable(token.text)
        if held is not None and (held.defined or not token.quoted):
            return (held.text, held.sure) if held.defined else (token.text, True)
        # A name on the left that nothing sets is a variable of somebody else's (CMAKE_BUILD_TYPE), not a text.
        if left and token.written and not token.quoted and _IDENTIFIER.match(token.text):
            return token.text, constant(token.text) is not None
        return token.text, True

    def binary(self, one: Token, operator: str, other: Token) -> bool | None:
        left, left_known = self.operand(one, True)
        if operator == "IN_LIST":
            held = self.world.variable(other.text)
            if held is None or not left_known:
                return None
            if left in held.words and held.sure:
                return True
            return (left in split_list(held.text)) if held.sure else None
        if operator == "MATCHES":
            if not left_known or not other.sure:
                return None
            groups = match(other.text, left, self.world.spend)
            if groups is None or groups is False:
                return groups
            self.world.matched(groups)
            return True
        right, right_known = self.operand(other, False)
        if not left_known or not right_known:
            return None
        if operator.startswith("VERSION_"):
            return _COMPARISONS[operator[8:]](version_key(left), version_key(right))
        if operator.startswith("STR"):
            return _COMPARISONS[operator[3:]](left, right)
        if operator == "PATH_EQUAL":
            return re.sub("/+", "/", left) == re.sub("/+", "/", right)
        if operator == "IS_NEWER_THAN":
            return None
        if not _NUMBER.match(left) or not _NUMBER.match(right):
            return False
        return _COMPARISONS[operator](float(left), float(right))
