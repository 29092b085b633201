"""Periods as code writes them, in seconds."""

import ast
import re
from fractions import Fraction

_UNITS = {"h": 3600, "min": 60, "s": 1, "ms": Fraction(1, 10**3), "us": Fraction(1, 10**6), "ns": Fraction(1, 10**9)}
_CHRONO = {"hours": "h", "minutes": "min", "seconds": "s", "milliseconds": "ms", "microseconds": "us",
           "nanoseconds": "ns"}  # fmt: skip
_LITERAL = re.compile(r"([\d.']+)(h|min|s|ms|us|ns)")
_MADE = re.compile(r"(?:[\w:.]*(?:::|\.))?(\w+)\s*[({](.*)[)}]", re.DOTALL)
_IN_SECONDS = frozenset(("Duration", "WallDuration", "from_seconds", "toSec"))
_RATES = frozenset(("Rate", "WallRate"))
_LONGEST = 80


def parse_period(text: str) -> Fraction | None:
    """The seconds that an expression of literals alone is, in either language; None for any other."""
    text = text.strip()
    if len(text) > _LONGEST:
        return None
    literal = _LITERAL.fullmatch(text)
    if literal:
        number = _compute(literal[1].replace("'", ""))
        return None if number is None else number * _UNITS[literal[2]]
    made = _MADE.fullmatch(text)
    if made is None:
        return _compute(text)
    inside = parse_period(made[2].removeprefix("seconds="))
    if inside is None or made[1] not in _CHRONO.keys() | _IN_SECONDS | _RATES:
        return None
    if made[1] in _RATES:
        return 1 / inside if inside else None
    return inside * _UNITS[_CHRONO[made[1]]] if made[1] in _CHRONO else inside


def _compute(text: str) -> Fraction | None:
    """What numbers and signs between them come to; None for what differs between the languages, as 1 / 10 does."""
    try:
        return _fold(ast.parse(re.sub(r"(?<=[\d.])[fFlLuU]+\b", "", text.strip()), mode="eval").body)
    except (SyntaxError, ValueError, ZeroDivisionError, RecursionError, MemoryError):
        return None


def _fold(node: ast.expr) -> Fraction | None:
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        return Fraction(repr(node.value)) if abs(node.value) < 1e15 else None  # type: ignore[arg-type]
    if not isinstance(node, ast.BinOp):
        return None
    left, right = _fold(node.left), _fold(node.right)
    if left is None or right is None:
        return None
    if isinstance(node.op, ast.Mult):
        return left * right
    if isinstance(node.op, ast.Div) and any(
        isinstance(one, ast.Constant) and isinstance(one.value, float) for one in (node.left, node.right)
    ):
        return left / right
    return None
