"""Conditions that ask one variable for its value: `not ns`, `ns.empty()`, `ns is None`, `ns == "robot"`.

Which variable it is, is read here; what it is asked, by the reader of conditions.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Any, NamedTuple

from ...facts.flow import FlowExpr, Guard
from .conditions import NOTHING, ConditionReader
from .graph import How

_PATH = r"(?:[A-Za-z_]\w*(?:\.|->))*[A-Za-z_]\w*"
_TEST = re.compile(
    rf"(?:!|not )? ?(?:(?P<empty>{_PATH})(?:\.|->)empty\(\)|len\((?P<len>{_PATH})\) ?== ?0"
    rf"|(?P<size>{_PATH})(?:\.|->)(?:size|length)\(\) ?== ?0"
    rf"|(?P<left>{_PATH}) ?(?:==|!=|is not\b|is\b) ?(?:None|nullptr|NULL|\"[^\"]*\"|'[^']*')"
    rf"|(?P<bare>{_PATH}))\Z"
)


class VariableTest(NamedTuple):
    """A condition on a variable. path: of the variable, as facts write it."""

    path: str
    guard: Guard
    is_cpp: bool

    def holds(self, text: str) -> bool | None:
        """Whether it is true of a value, None where that is not known."""
        return _decide(self, text)


@lru_cache(maxsize=20_000)
def read_variable_test(guard: Guard, is_cpp: bool) -> VariableTest | None:
    """What a guard says about a variable where it holds; None for other conditions."""
    text = guard.text.strip()
    while text[:1] == "(" and text[-1:] == ")" and ")" not in text[1:-1].replace("()", ""):
        text = text[1:-1].strip()
    found = _TEST.match(text) if guard.kind in ("if", "unless", "while") and len(text) < 200 else None
    if found is None:
        return None
    path = next(path for path in found.groups() if path is not None)
    kind = "unless" if guard.kind == "unless" else "if"
    return VariableTest(re.sub(r"^self\.", "this.", path.replace("->", ".")), Guard(kind, text, 0), is_cpp)


@lru_cache(maxsize=20_000)
def _decide(test: VariableTest, text: str) -> bool | None:
    def list_values(value: FlowExpr) -> list[tuple[str, How]]:
        del value
        return [(text, "literal")]

    return _OneValueReader(test.is_cpp, list_values).decide_guard(test.guard).holds


class _OneValueReader(ConditionReader):
    """Decides a condition for one value that a variable has where it is asked. Every text but a few is something: it
    may stand for an object."""

    def find_truth(self, value: Any) -> bool | None:
        return value not in _FALSE if isinstance(value, str) else super().find_truth(value)

    def compare_to_nothing(self, text: str, is_equal: bool) -> bool | None:
        return (text in NOTHING) == is_equal

    def measure(self, text: str) -> int | None:
        return len(text)


_FALSE = frozenset(("", "0", "False", "false", *NOTHING))
