"""Preprocessor macros that a package's own CMake defines, under conditions of CMake.

`#ifdef` on such a macro asks what CMake asked: `if(rclcpp_VERSION VERSION_LESS 3) add_definitions(-DFOXY)`. A macro
that is given to single targets is defined for those that link one of them too, and for no other target.
"""

import re
from collections.abc import Collection, Container, Iterable, Mapping
from functools import lru_cache
from types import MappingProxyType

from ...edges.memory import cache_method
from ...edges.reach import walk
from ..facts.condition import Condition
from .cmake.build import DefinedMacro

# What a macro is defined as that `#if` takes for true: nothing written is 1, and a name that is none of a macro is 0.
_TRUE = re.compile(r"|0*[1-9]\d*[uUlL]*|true|0[xX]0*[1-9a-fA-F][\da-fA-F]*")
_ASKED = re.compile(r"(?:defined\s*\(\s*(?P<whether>[A-Za-z_]\w*)\s*\)|(?P<value>[A-Za-z_]\w*))\Z")


class Macros:
    """The macros of one package. defined: what its CMake defines. elsewhere: names that its sources #define too, of
    which CMake does not tell. links: the items that each target links."""

    def __init__(
        self,
        defined: Iterable[DefinedMacro],
        elsewhere: Container[str],
        links: Mapping[str, Collection[str]] = MappingProxyType({}),
    ):
        self._links = links
        self._tests: dict[str, tuple[DefinedMacro, ...]] = {}
        for macro in defined:
            if macro.name not in elsewhere:
                self._tests[macro.name] = (*self._tests.get(macro.name, ()), macro)

    def resolve_conditions(self, conditions: tuple[Condition, ...], targets: Iterable[str]) -> tuple[Condition, ...]:
        """Conditions in a file that these targets compile, with those on such macros as CMake asks them."""
        if not self._tests or not any(c.language == "cpp" for c in conditions):
            return conditions
        compiled = frozenset(targets)
        return tuple(self._resolve_condition(c, compiled) if c.language == "cpp" else c for c in conditions)

    def _resolve_condition(self, condition: Condition, targets: frozenset[str]) -> Condition:
        found = _ASKED.match(condition.text.strip())
        if found is None:
            return condition
        name, value = found.group("whether"), found.group("value")
        macros = self._tests.get(name or value, ())
        if not macros or (value and not all(_TRUE.fullmatch(m.value) for m in macros)):
            return condition  # what it is defined as, or what that expands to, is not known to be true
        deciding = tuple(m for m in macros if not m.target)
        if not deciding:
            given = {m.target for m in macros}
            reached = [self._follow(target) for target in targets]
            with_it = [linked for linked in reached if not given.isdisjoint(linked)]
            if not reached or (with_it and len(with_it) < len(reached)):
                return condition  # what compiles the file without it is not told apart
            if not with_it:
                open_ended = any("$" in item for linked in reached for item in linked)
                return condition if open_ended else Condition("macro", "FALSE", condition.negated)
            deciding = tuple(m for m in macros if any(m.target in linked for linked in with_it))
        return Condition("macro", _join_alternatives(tuple(m.conditions for m in deciding)), condition.negated)

    @cache_method
    def _follow(self, target: str) -> frozenset[str]:
        """A target and what it links, by links of links."""
        return frozenset(walk([target], lambda one: self._links.get(one, ())))


@lru_cache(1024)
def _join_alternatives(alternatives: tuple[tuple[Condition, ...], ...]) -> str:
    """One test of CMake for: all conditions of any alternative hold."""
    return " OR ".join(
        "( {} )".format(" AND ".join(f"NOT ( {c.text} )" if c.negated else f"( {c.text} )" for c in each) or "TRUE")
        for each in dict.fromkeys(alternatives)
    )
