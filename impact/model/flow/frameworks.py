"""The table of frameworks: which calls and objects make publishers, subscribers and their like, and where what stands.

The table itself is frameworks.toml, whose head says how to read it.
"""

from __future__ import annotations

import sys
from functools import cache
from pathlib import Path
from typing import Any

import msgspec

from ....edges.groups import group_pairs

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib  # pyright: ignore[reportMissingImports]

Spot = int | str
TABLE = Path(__file__).with_name("frameworks.toml")


class Also(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A further endpoint that a row makes, unless one of some words is among the arguments."""

    role: str
    topic: str
    type: str
    unless: tuple[str, ...] = ()


class FrameworkRow(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A row of the table. Spots (topic, type, ...) are in the order in which they are tried; see frameworks.toml."""

    framework: str
    does: str
    names: tuple[str, ...] = ()
    types: tuple[str, ...] = ()
    language: str = ""
    on: tuple[str, ...] = ()
    free: tuple[str, ...] = ()
    first: str = ""
    topic: tuple[Spot, ...] = ()
    type: tuple[Spot, ...] = ()
    queue: tuple[Spot, ...] = ()
    qos: tuple[Spot, ...] = ()
    callback: tuple[Spot, ...] = ()
    latch: tuple[Spot, ...] = ()
    period: tuple[Spot, ...] = ()
    default: tuple[Spot, ...] = ()
    variable: tuple[Spot, ...] = ()
    message: tuple[Spot, ...] = ()
    remaps: tuple[Spot, ...] = ()
    namespace: tuple[Spot, ...] = ()
    anonymous: tuple[Spot, ...] = ()
    declares: bool = False
    camera_info: bool = False
    also: tuple[Also, ...] = ()


class Frameworks:
    """The table, ready to be asked. calls: rows by the last part of the callee; objects: rows by the last part of the
    type that is made; kinds: last part of a class's name to its full names and their kinds; types: classes to the
    interfaces that they are sent as; generations: frameworks to the generation of ROS that they are of."""

    def __init__(self, table: dict[str, Any]):
        """table: as frameworks.toml has it. Raises msgspec.ValidationError that names what is wrong."""
        self.types: dict[str, str] = dict(table.get("types", {}))
        self.generations: dict[str, int] = dict(table.get("generations", {}))
        self.calls = group_pairs((name, row) for row in map(_make_row, table.get("call", ())) for name in row.names)
        objects = map(_make_row, table.get("object", ()))
        self.objects = group_pairs((get_last_part(name), row) for row in objects for name in row.types)
        kinds = ((name, kind) for kind, names in table.get("kinds", {}).items() for name in names)
        self.kinds = group_pairs((get_last_part(name), (name, kind)) for name, kind in kinds)

    def find_kind(self, name: str) -> str:
        """The kind of a class by its name, as qualified as it is known; empty for none."""
        for full, kind in self.kinds.get(get_last_part(name), ()):
            if _is_ending(full, name):
                return kind
        return ""

    def list_objects(self, name: str, python: bool = False) -> list[FrameworkRow]:
        """Rows about objects of a class, by its name as qualified as it is known; with `::` before it where that is
        whole. python: whether Python makes it."""
        return [
            row
            for row in self.objects.get(get_last_part(name), ())
            if any(("::" in full) != python and _is_ending(full, name) for full in row.types)
        ]


def get_last_part(name: str) -> str:
    """The last part of a qualified name of either language."""
    return name.replace("::", ".").rpartition(".")[2]


def _is_ending(full: str, name: str) -> bool:
    if name.startswith("::"):
        return full == name.removeprefix("::")
    one, other = full.replace("::", ".").split("."), name.replace("::", ".").strip(".").split(".")
    return one[-len(other) :] == other or other[-len(one) :] == one


def _make_row(raw: dict[str, Any]) -> FrameworkRow:
    spots = (
        "topic", "type", "queue", "qos", "callback", "latch", "period", "default", "variable", "message", "remaps",
        "namespace", "anonymous",
    )  # fmt: skip
    fixed = {name: value if isinstance(value, list) else [value] for name, value in raw.items() if name in spots}
    return msgspec.convert({**raw, **fixed}, FrameworkRow)


@cache
def load_frameworks() -> Frameworks:
    """The shipped table."""
    return Frameworks(tomllib.loads(TABLE.read_text(encoding="utf-8")))
