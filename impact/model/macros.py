"""Preprocessor macros that a package's own CMake defines, under conditions of CMake.

`#ifdef` on such a macro asks what CMake asked: `if(rclcpp_VERSION VERSION_LESS 3) add_definitions(-DFOXY)`. What other
targets pass on with their definitions is not followed.
"""

import re
from collections.abc import Container, Iterable
from functools import lru_cache

from ..facts.condition import Condition
from .cmake.build import DefinedMacro

_ASKED = re.compile(r"(?:defined\s*\(\s*(?P<whether>[A-Za-z_]\w*)\s*\)|(?P<value>[A-Za-z_]\w*))\Z")


class Macros:
    """The macros of one package. defined: what its CMake defines. elsewhere: names that its sources #define too, of
    which CMake does not tell."""

    def __init__(self, defined: Iterable[DefinedMacro], elsewhere: Container[str]):
        self._tests: dict[str, tuple[DefinedMacro, ...]] = {}
        for macro in defined:
            if macro.name not in elsewhere:
                self._tests[macro.name] = (*self._tests.get(macro.name, ()), macro)
        self._known: dict[tuple[Condition, frozenset[str] | None], Condition] = {}

    def asked(self, conditions: tuple[Condition, ...], targets: Iterable[str]) -> tuple[Condition, ...]:
        """Conditions in a file that these targets compile, with those on such macros as CMake asks them."""
        if not self._tests or not any(c.language == "cpp" for c in conditions):
            return conditions
        compiled = frozenset(targets)
        return tuple(self._told(c, compiled) if c.language == "cpp" else c for c in conditions)

    def _told(self, condition: Condition, targets: frozenset[str]) -> Condition:
        found = _ASKED.match(condition.text.strip())
        if found is None:
            return condition
        name, value = found.group("whether"), found.group("value")
        macros = self._tests.get(name or value, ())
        if not macros or (value and any(m.value in ("0", "OFF", "FALSE") for m in macros)):
            return condition
        everywhere = tuple(m for m in macros if not m.target)
        given = {m.target for m in macros}
        if not everywhere and (not targets or not targets <= given):
            return condition  # what compiles the file without it is not told apart
        told = everywhere or tuple(m for m in macros if m.target in targets)
        return Condition("macro", _either(tuple(m.conditions for m in told)), condition.negated)


@lru_cache(1024)
def _either(alternatives: tuple[tuple[Condition, ...], ...]) -> str:
    """One test of CMake for: all conditions of any alternative hold."""
    return " OR ".join(
        "( {} )".format(" AND ".join(f"NOT ( {c.text} )" if c.negated else f"( {c.text} )" for c in each) or "TRUE")
        for each in dict.fromkeys(alternatives)
    )
