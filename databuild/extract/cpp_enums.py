"""Enumerators of C++ with their values, where the text alone tells them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from .cpp_declarations import remove_deprecation
from .cpp_types import join_tokens, split, split_tokens

_NUMBER = re.compile(r"(?:0[xX][\da-fA-F]+|\d+)[uUlL]*\Z")


def list_enumerators(body: str) -> Iterator[tuple[str, str, str | None]]:
    """Name, value and message of a deprecation of each enumerator in the body of an enum. A value is a number, else the
    expression as it is written, else the last such with what is added: `A`, `A+1`."""
    number: int | None = -1
    last = ""
    steps = 0
    for piece in split(split_tokens(body)):
        deprecated = None
        while piece and piece[0] == "#":
            piece = piece[1:]
        if any("eprecated" in word or "DEPRECATED" in word for word in piece[1:]):
            piece, deprecated = remove_deprecation(piece)
        if not piece or not piece[0].isidentifier():
            continue
        steps += 1
        if "=" in piece:
            value = piece[piece.index("=") + 1 :]
            number = _evaluate(value)
            if number is None:
                last = join_tokens(value)
                steps = 0
        elif number is not None:
            number += 1
        shown = str(number) if number is not None else last if steps == 0 else f"{last}+{steps}"
        yield piece[0], shown, deprecated


def _evaluate(tokens: Sequence[str]) -> int | None:
    """The number an enumerator is given, where that is told by the text alone."""
    sign = 1
    rest = list(tokens)
    while rest[:1] == ["("] and rest[-1:] == [")"]:
        rest = rest[1:-1]
    if rest[:1] in (["-"], ["+"]):
        sign = -1 if rest[0] == "-" else 1
        rest = rest[1:]
    if len(rest) == 3 and rest[1] == "<<" and all(_NUMBER.match(rest[place]) for place in (0, 2)):
        shift = _parse_number(rest[2])
        return sign * (_parse_number(rest[0]) << shift) if shift < 64 else None
    if len(rest) == 1:
        token = rest[0]
        if _NUMBER.match(token):
            return sign * _parse_number(token)
        if len(token) == 3 and token[0] == "'":
            return sign * ord(token[1])
    return None


def _parse_number(token: str) -> int:
    token = token.rstrip("uUlL")
    if token[:2] in ("0x", "0X"):
        return int(token, 16)
    if token[0] == "0" and len(token) > 1 and all(digit in "01234567" for digit in token):
        return int(token, 8)
    return int(token)
