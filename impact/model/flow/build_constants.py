"""Constants that the build gives to sources of C++ (`target_compile_definitions(node PRIVATE NAME="scan")`)."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import NamedTuple

from ....edges.groups import group_pairs
from ...facts.flow import FlowExpr
from ..cmake.build import DefinedMacro

_TEXT = re.compile(r'"([^"\\$]*)"\Z')
_NUMBER = re.compile(r"\d+\Z")


class GivenMacros(NamedTuple):
    """What the build of a package gives to its compiler. compiled: of each target its sources."""

    package: str
    macros: tuple[DefinedMacro, ...]
    compiled: Mapping[str, tuple[str, ...]]


class BuildConstants:
    """Asks the builds of some packages what a name is that they define."""

    def __init__(self, packages: Iterable[GivenMacros] = ()):
        self._rows = group_pairs((macro.name, (one, macro)) for one in packages for macro in one.macros)

    def list_values(self, name: str, path: str, package: str) -> list[tuple[FlowExpr, bool]]:
        """What a name stands for in a file of a package, each with whether that hangs on a condition of the build: in a
        source as its targets are compiled, in a header as any target of the package is."""
        found: dict[tuple[FlowExpr, bool], None] = {}
        for one, macro in self._rows.get(name, ()):
            if one.package != package:
                continue
            targets = {target for target, sources in one.compiled.items() if path in sources}
            if not macro.target or macro.target in targets or not targets:
                found[_parse_value(macro.value), bool(macro.conditions)] = None
        return list(found)


def _parse_value(written: str) -> FlowExpr:
    text = _TEXT.match(written)
    if text is not None:
        return FlowExpr("text", text[1])
    return FlowExpr("number" if _NUMBER.match(written) else "other", written)
