"""Conditions that ask one variable for its value: `not ns`, `ns.empty()`, `ns is None`, `ns == "robot"`."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import NamedTuple

from ...facts.flow import Guard

_PATH = r"(?:[A-Za-z_]\w*(?:\.|->))*[A-Za-z_]\w*"
_TEST = re.compile(
    rf"(?P<no>!|not )? ?(?:(?P<empty>{_PATH})(?:\.|->)empty\(\)|len\((?P<len>{_PATH})\) ?== ?0"
    rf"|(?P<size>{_PATH})(?:\.|->)(?:size|length)\(\) ?== ?0"
    rf"|(?P<left>{_PATH}) ?(?P<operator>==|!=|is not\b|is\b) ?(?P<right>None|nullptr|NULL|\"[^\"]*\"|'[^']*')"
    rf"|(?P<bare>{_PATH}))\Z"
)
_NOTHING = ("None", "nullptr", "NULL")
_FALSE = frozenset(("", "0", "False", "false", *_NOTHING))


class VariableTest(NamedTuple):
    """A condition on a variable: its value is one of some texts, or none of them. path: of the variable, as facts write
    it."""

    path: str
    texts: frozenset[str]
    among: bool

    def holds(self, text: str) -> bool:
        """Whether it is true of a value."""
        return (text in self.texts) == self.among


@lru_cache(maxsize=20_000)
def read_variable_test(guard: Guard) -> VariableTest | None:
    """What a guard says about a variable where it holds; None for other conditions."""
    text = guard.text.strip()
    while text[:1] == "(" and text[-1:] == ")" and ")" not in text[1:-1].replace("()", ""):
        text = text[1:-1].strip()
    found = _TEST.match(text) if guard.kind in ("if", "unless", "while") and len(text) < 200 else None
    if found is None:
        return None
    path = found["empty"] or found["len"] or found["size"] or found["left"] or found["bare"]
    among = bool(found["no"]) == (guard.kind == "unless")
    if found["left"]:
        right = found["right"]
        texts = frozenset(_NOTHING if right in _NOTHING else (right[1:-1],))
        among = among == (found["operator"] in ("==", "is"))
    elif found["bare"]:
        texts, among = _FALSE, not among
    else:
        texts = frozenset(("",))
    return VariableTest(re.sub(r"^self\.", "this.", path.replace("->", ".")), texts, among)
