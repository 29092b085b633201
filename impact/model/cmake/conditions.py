"""The tests of if(), elseif() and while() where CMake's files are interpreted: what operands mean there."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Protocol

from ...conditions.cmake import COMPARISONS, NUMBER, CMakeTest, Token, parse_constant
from .names import SINCE
from .regex import match
from .values import CMakeValue, split_list

_IDENTIFIER = re.compile(r"[A-Za-z_][A-Za-z0-9_.]*\Z")


class CMakeWorld(Protocol):
    """What tests ask of the interpreter, which describes it. None is what is not known."""

    def get(self, name: str) -> CMakeValue | None: ...
    def is_target(self, name: str) -> bool | None: ...
    def is_command(self, name: str) -> bool | None: ...
    def has_path(self, path: str) -> bool | None: ...
    def protects_quoted(self) -> bool: ...
    def set_match_groups(self, groups: tuple[str, ...]) -> None: ...
    def spend(self, steps: int) -> None: ...


def evaluate(tokens: Sequence[Token], world: CMakeWorld) -> bool | None:
    """The value of a condition, None when it depends on what is not known or is malformed."""
    return _InWorld(tokens, world).evaluate_tokens() if tokens else False


def format_condition(tokens: Sequence[Token], world: CMakeWorld) -> str:
    """The condition for a reader: arguments with one space between them, a list that is known in place of its name."""
    texts = [token.text or '""' for token in tokens]
    for place, token in enumerate(tokens[1:], 1):
        held = world.get(token.text) if tokens[place - 1].text == "IN_LIST" else None
        if held is not None and held.sure and held.defined:
            texts[place] = f"{held.text};"
    return " ".join(texts)


def make_version_key(text: str) -> tuple[int, ...]:
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


class _InWorld(CMakeTest):
    """A test with the variables, targets and files that the interpreter knows."""

    def __init__(self, tokens: Sequence[Token], world: CMakeWorld) -> None:
        super().__init__(tokens)
        self.world = world

    def evaluate_argument(self, token: Token) -> bool | None:
        if not token.sure:
            return None
        value = parse_constant(token.text)
        if value is not None:
            return value
        if token.quoted and self.world.protects_quoted():
            return False
        held = self.world.get(token.text)
        if held is None:
            if "${" in token.text or "$ENV{" in token.text:
                return None
            return None if _IDENTIFIER.match(token.text) or token.text.endswith("_FOUND") else False
        if not held.sure:
            return None
        if not held.defined:
            return False
        value = parse_constant(held.text)
        return True if value is None else value

    def evaluate_unary(self, kind: str, operand: Token) -> bool | None:
        if kind == "DEFINED":
            if not operand.sure or operand.text.startswith(("ENV{", "CACHE{")):
                return None
            held = self.world.get(operand.text)
            if held is None:
                return None
            return held.defined if held.sure else None
        if not operand.sure:
            return None
        text = operand.text
        if kind == "POLICY":
            return None if text in SINCE else True
        if kind == "TARGET":
            return self.world.is_target(text)
        if kind == "COMMAND":
            return self.world.is_command(text)
        if kind in ("EXISTS", "IS_DIRECTORY"):
            return self.world.has_path(text)
        if kind == "IS_ABSOLUTE":
            return text.startswith("/")
        return None

    def resolve_operand(self, token: Token, left: bool) -> tuple[str, bool]:
        """Text of an operand after automatic dereference, and whether it is known."""
        if not token.sure:
            return token.text, False
        if token.quoted and self.world.protects_quoted():
            return token.text, True
        held = self.world.get(token.text)
        if held is not None and (held.defined or not token.quoted):
            return (held.text, held.sure) if held.defined else (token.text, True)
        # A name on the left that nothing sets is a variable of somebody else's (CMAKE_BUILD_TYPE), not a text.
        if left and token.written and not token.quoted and _IDENTIFIER.match(token.text):
            return token.text, parse_constant(token.text) is not None
        return token.text, True

    def evaluate_comparison(self, left: Token, kind: str, right: Token) -> bool | None:
        one, one_known = self.resolve_operand(left, True)
        if kind == "IN_LIST":
            held = self.world.get(right.text)
            if held is None or not one_known:
                return None
            if one in held.words and held.sure:
                return True
            return (one in split_list(held.text)) if held.sure else None
        if kind == "MATCHES":
            if not one_known or not right.sure:
                return None
            groups = match(right.text, one, self.world.spend)
            if groups is None or groups is False:
                return groups
            self.world.set_match_groups(groups)
            return True
        other, other_known = self.resolve_operand(right, False)
        if not one_known or not other_known:
            return None
        if kind.startswith("VERSION_"):
            return COMPARISONS[kind[8:]](make_version_key(one), make_version_key(other))
        if kind.startswith("STR"):
            return COMPARISONS[kind[3:]](one, other)
        if kind == "PATH_EQUAL":
            return re.sub("/+", "/", one) == re.sub("/+", "/", other)
        if kind == "IS_NEWER_THAN":
            return None
        if not NUMBER.match(one) or not NUMBER.match(other):
            return False
        return COMPARISONS[kind](float(one), float(other))
