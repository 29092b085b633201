"""Condition attributes of package.xml, after REP 149 and catkin_pkg."""

from __future__ import annotations

import re
from functools import lru_cache

from .environment import COMPARISONS, Environment
from .logic import both, either

_MANIFEST_TOKEN = re.compile(r"\s*(?:(==|!=|<=|>=|<|>|\(|\))|\$([A-Za-z_]\w*)|\"([^\"]*)\"|'([^']*)'|([\w.-]+))")


@lru_cache(1024)
def _manifest_tokens(text: str) -> tuple[tuple[str, str], ...]:
    tokens: list[tuple[str, str]] = []
    position, text = 0, text.strip()
    while position < len(text):
        match = _MANIFEST_TOKEN.match(text, position)
        if match is None:
            return ()
        kind = ("operator", "variable", "text", "text", "word")[(match.lastindex or 1) - 1]
        tokens.append((kind, match.group(match.lastindex or 0)))
        position = match.end()
    return tuple(tokens)


class _Manifest:
    """A condition attribute: comparisons of texts joined by `and` and `or`; `and` binds tighter, as in catkin_pkg."""

    def __init__(self, text: str, environment: Environment) -> None:
        self.tokens = (*_manifest_tokens(text), ("end", ""))
        self.environment = environment
        self.at = 0

    def whole(self) -> bool | None:
        value = self.either()
        return value if self.tokens[self.at][0] == "end" else None

    def either(self) -> bool | None:
        value = self.both()
        while self.tokens[self.at] == ("word", "or"):
            self.at += 1
            value = either(value, self.both())
        return value

    def both(self) -> bool | None:
        value = self.comparison()
        while self.tokens[self.at] == ("word", "and"):
            self.at += 1
            value = both(value, self.comparison())
        return value

    def comparison(self) -> bool | None:
        if self.tokens[self.at] == ("operator", "("):
            self.at += 1
            value = self.either()
            if self.tokens[self.at] != ("operator", ")"):
                raise ValueError("`)` expected")
            self.at += 1
            return value
        left = self.operand()
        kind, compare = self.tokens[self.at]
        if kind != "operator" or compare not in COMPARISONS:
            raise ValueError("comparison expected")
        self.at += 1
        right = self.operand()
        return None if left is None or right is None else COMPARISONS[compare](left, right)

    def operand(self) -> str | None:
        kind, value = self.tokens[self.at]
        if kind in ("end", "operator"):
            raise ValueError("operand expected")
        self.at += 1
        if kind != "variable":
            return value
        if value == "ROS_DISTRO":
            return self.environment.ros_distro or None
        if value == "ROS_VERSION":
            return self.environment.ros_version or None
        if value == "ROS_PYTHON_VERSION":
            return str(self.environment.python[0]) if self.environment.python else None
        # REP 149: a variable that is not set is the empty text.
        return ""


def evaluate(text: str, environment: Environment) -> bool | None:
    if not text.strip():
        return True
    return _Manifest(text, environment).whole()
