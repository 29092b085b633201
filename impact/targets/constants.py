"""Constants of released packages that are texts as names have them: data/constants.json.zst, see DATA.md."""

from __future__ import annotations

from functools import cache

import msgspec

from .tables import find_table
from .unpacked import read_table


class ReleasedConstants(msgspec.Struct, frozen=True):
    """headers: by the path that `#include` names, the constants with their namespaces and classes (`ns::Class::NAME`,
    macros by their plain names); modules: by the dotted name of a module of Python, its own and those of its classes
    (`Class.NAME`); messages: by `package/Name`. One of several values in several versions is left out."""

    headers: dict[str, dict[str, str]]
    modules: dict[str, dict[str, str]]
    messages: dict[str, dict[str, str]]


@cache
def load_constants() -> ReleasedConstants:
    """The shipped table. Raises SnapshotError."""
    return read_table(find_table("constants.json.zst"), ReleasedConstants)
