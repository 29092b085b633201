"""Names of C and C++ that need a link, since they are compiled into a library: `data/compiled.json.zst`
(databuild/compiled.py). A header of a library may have others beside them, which need none."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from functools import cache
from typing import NamedTuple

import msgspec

from ..tables import find_table
from ..unpacked import read_table

FILE = "compiled.json.zst"


class CompiledTable(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What the table holds. system: names, space separated, by the stem of the library that has them (`yaml-cpp`), by
    library as in libraries.sqlite. ros: the same by package, by generation of ROS. `{}` follows classes of which no
    object is made without the library; the others are functions."""

    system: dict[str, dict[str, str]] = {}
    ros: dict[int, dict[str, str]] = {}


class CompiledName(NamedTuple):
    """Who has a name that needs a link. owner: a library as in libraries.sqlite, or a package of ROS. stem: of the
    library to link, empty for a package. ros: the generations of ROS that have the package, none for a library."""

    owner: str
    stem: str = ""
    ros: tuple[int, ...] = ()


class CompiledNames:
    """The names of a table, ready to be asked. functions: those that are called without a receiver, namespaces and all.
    classes: those of which no object is made without a link. words: functions of C. Of a name that several have
    nothing is said."""

    def __init__(self, table: CompiledTable):
        self.functions: dict[str, CompiledName] = {}
        self.classes: dict[str, CompiledName] = {}
        twice = set()
        for name, found in _list_names(table):
            kept, plain = (self.classes if name.endswith("{}") else self.functions), name.removesuffix("{}")
            before = kept.setdefault(plain, found)
            if before.owner != found.owner:
                twice.add(plain)
            elif found.ros and before.ros != found.ros:
                kept[plain] = CompiledName(found.owner, "", (*before.ros, *found.ros))
        for name in twice:
            self.functions.pop(name, None)
            self.classes.pop(name, None)
        self.words = frozenset(name for name in self.functions if "::" not in name)

    def find(self, name: str) -> CompiledName:
        """Who has a name. Raises KeyError for one that needs no link."""
        return self.functions[name] if name in self.functions else self.classes[name]


def _list_names(table: CompiledTable) -> Iterator[tuple[str, CompiledName]]:
    for library, stems in table.system.items():
        for stem, names in stems.items():
            yield from ((name, CompiledName(library, stem)) for name in names.split())
    for generation, packages in sorted(table.ros.items()):
        for package, names in packages.items():
            yield from ((name, CompiledName(package, "", (generation,))) for name in names.split())


@cache
def load_compiled() -> CompiledNames:
    """The shipped names, once for each process. Raises SnapshotError when they cannot be read."""
    return CompiledNames(read_table(find_table(FILE), CompiledTable))


def compute_compiled_stamp() -> str:
    """Differs whenever another table of names does."""
    return hashlib.sha1(find_table(FILE).read_bytes()).hexdigest()
