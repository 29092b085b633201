"""Writes files of surfaces: the one that is shipped, and those of `rosimpact surface build`.

targets/surface/store.py reads them."""

from __future__ import annotations

import hashlib
import sqlite3
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple
from urllib.parse import quote

import msgspec
import zstandard

from ..edges.files import open_for_replacing, read_chunks
from ..impact.facts.interface import Interface
from ..impact.facts.python.surface import Bound
from ..impact.facts.surface import Entity, HeaderSurface
from ..impact.targets.parameters import find_last_part
from ..impact.targets.surface.changes import PARAMETER, Line
from ..impact.targets.surface.includes import Include, Included, IncludesRow
from ..impact.targets.surface.store import About, StoredSurfacesError, SurfaceHistory
from ..impact.targets.surface.surface import TREE_NODE
from ..impact.targets.unpacked import read_packed

if TYPE_CHECKING:
    from ..impact.targets.surface.surface import Surface


_SCHEMA = """
CREATE TABLE package(name TEXT, ros INTEGER, data BLOB NOT NULL, changes BLOB NOT NULL, includes BLOB NOT NULL,
  PRIMARY KEY(name, ros)) WITHOUT ROWID;
CREATE TABLE elsewhere(data BLOB NOT NULL);
CREATE TABLE headers(data BLOB NOT NULL);
CREATE TABLE parameters(data BLOB NOT NULL);
CREATE TABLE tree_nodes(data BLOB NOT NULL);
CREATE TABLE about(packages INTEGER, versions INTEGER, distros TEXT, date TEXT);
"""
"""about: one row, see About. package: for each generation of ROS that has it, what its versions offer, what changed
between them (see surface_changes.py), and what their headers include (see surface_includes.py): a package of ROS 1 and
one of ROS 2 may share name and version, and be two. elsewhere: one row, packed: names that some version of
a package lost, with the packages that have or had one of that name. headers: one row, packed: headers that do not lie
in a folder that is called like their package, with the packages that have or had them. parameters: one row, packed: the
last parts of the names of parameters that came or went for sure, with the packages that declare or declared them.
tree_nodes: one row, packed: nodes of behaviour trees, with the packages that register or registered them for sure."""
_LEVEL = 19
# (kind, scope, value as JSON-like data)
_Row = tuple[str, str, Any]


class Packed(NamedTuple):
    """A package of one ROS generation as it is stored: what its versions offer, what changed between them, what their
    headers include."""

    data: bytes
    changes: bytes
    includes: bytes


class Stored(NamedTuple):
    """One version of a package. approximate: a branch stood for its tag."""

    version: str
    approximate: bool
    surface: Surface


class Packer:
    """Packs the versions of one package as they come, oldest first, without what their headers include. What is equal
    is kept once."""

    def __init__(self) -> None:
        self._versions: list[str] = []
        self._approximate: list[str] = []
        self._values: list[_Row] = []
        self._places: list[list[int]] = []
        self._numbers: dict[bytes, int] = {}
        self._parts: dict[bytes, list[int]] = {}

    def add(self, stored: Stored) -> None:
        """The next version."""
        place = len(self._versions)
        self._versions.append(stored.version)
        if stored.approximate:
            self._approximate.append(stored.version)
        for part in _list_parts(stored.surface):
            whole = _encoder.encode(part)
            numbers = self._parts.get(whole)
            if numbers is None:
                numbers = self._parts[whole] = [self._assign_number(row) for row in _make_rows(*part)]
            for number in numbers:
                places = self._places[number]
                if not places or places[-1] != place:
                    places.append(place)

    def _assign_number(self, row: _Row) -> int:
        key = _encoder.encode(row)
        number = self._numbers.setdefault(key, len(self._values))
        if number == len(self._values):
            self._values.append(row)
            self._places.append([])
        return number

    def pack_versions(self) -> bytes:
        """All versions as they are stored."""
        count = len(self._versions)
        rows = [(*value, find_spans(places, count)) for value, places in zip(self._values, self._places, strict=True)]
        rows.sort(key=lambda row: (row[0], row[1]))  # stable: what is declared first comes first
        whole = _encoder.encode((self._versions, self._approximate, rows))
        return zstandard.ZstdCompressor(level=_LEVEL).compress(whole)


_encoder = msgspec.msgpack.Encoder()


def _list_parts(surface: Surface) -> Iterator[tuple[str, str, Any]]:
    """What a surface consists of: kind, name, value. Each gives rows of its own."""
    from ..impact.targets.surface.surface import BuildSurface

    yield from (("header", path, header) for path, header in surface.headers)
    yield from (("module", module.name, module) for module in surface.python.modules)
    for what, listed in (("unknown", surface.python.unknown), ("unresolved", surface.python.unresolved)):
        yield from (("python", what, text) for text in listed)
    yield from (("interface", name, definition) for name, definition in surface.interfaces)
    for field in msgspec.structs.fields(BuildSurface):
        value = getattr(surface.build, field.name)
        if field.name in ("package", "version"):
            continue
        yield from (("build", field.name, item) for item in (value if isinstance(value, tuple) else (value,)))
    yield from (("parameter", name, default) for name, default in surface.parameters)
    yield "surface", "", [surface.guessed, surface.runs_with]


def _make_rows(kind: str, name: str, value: Any) -> Iterator[_Row]:
    bare = msgspec.to_builtins
    if kind == "header":
        yield "header", name, [value.inline, _shorten(value.deprecated), value.instead, value.lost]
        for one in value.entities:
            yield "entity", name, _trim_defaults(bare(_remove_text(one)), _ENTITY)
    elif kind == "module":
        surface = value.surface
        yield "module", name, [value.path, value.package, surface.all, surface.all_open, surface.open,
                               _shorten(surface.deprecated), surface.parsed]  # fmt: skip
        for bound in surface.names:
            bound = msgspec.structs.replace(bound, line=0, deprecated=_shorten(bound.deprecated))
            yield "bound", name, _trim_defaults(bare(bound), _BOUND)
        for taken in surface.imports:
            yield "taken", name, bare(msgspec.structs.replace(taken, line=0))
    elif kind == "interface":
        yield kind, name, bare(_remove_lines(value))
    else:
        yield kind, name, bare(value)


def _shorten(message: str | None) -> str | None:
    return None if message is None else shorten_message(message)


def _remove_text(one: Entity) -> Entity:
    """An entity without its line, names of parameters, statements and long messages."""
    parameters = one.parameters
    if parameters is not None:
        parameters = tuple(
            msgspec.structs.replace(p, name="", default=None if p.default is None else _remove_statements(p.default))
            for p in parameters
        )
    return msgspec.structs.replace(
        one,
        line=0,
        parameters=parameters,
        value=_remove_statements(one.value),
        deprecated=_shorten(one.deprecated),
    )


def _remove_statements(value: str) -> str:
    """A default or a constant; of one that calls a lambda only a digest, which tells it from another."""
    return f"[](){{{hashlib.sha1(value.encode()).hexdigest()[:8]}}}()" if "{" in value and ";" in value else value


def _remove_lines(definition: Interface) -> Interface:
    sections = tuple(
        msgspec.structs.replace(
            section,
            fields=tuple(msgspec.structs.replace(f, line=0, column=0) for f in section.fields),
            constants=tuple(msgspec.structs.replace(c, line=0, column=0) for c in section.constants),
        )
        for section in definition.sections
    )
    return msgspec.structs.replace(definition, sections=sections, problems=())


def _trim_defaults(values: list[Any], defaults: list[Any]) -> list[Any]:
    """The values up to the last that is not what it is by default."""
    end = len(values)
    while end and values[end - 1] == defaults[end - 1]:
        end -= 1
    return values[:end]


_ENTITY = msgspec.to_builtins(Entity("\0", "\0", -1))
_BOUND = msgspec.to_builtins(Bound("\0", "\0", -1))
Packages = Mapping[tuple[str, int], Packed]
"""Packed packages by name and ROS generation."""


def read_packages(file: Path) -> tuple[dict[tuple[str, int], Packed], tuple[str, ...]]:
    """The packed packages of a file, and the distros that it was made of. Raises StoredSurfacesError when it cannot be
    read."""
    try:
        with closing(sqlite3.connect(f"file:{quote(str(file))}?mode=ro", uri=True)) as db:
            rows = db.execute("SELECT name, ros, data, changes, includes FROM package")
            packages = {(name, ros): Packed(*packed) for name, ros, *packed in rows}
            (distros,) = db.execute("SELECT distros FROM about").fetchone()
    except sqlite3.Error as error:
        message = f"{file}: no file of surfaces ({error}); `rosimpact surface build` makes one"
        raise StoredSurfacesError(message) from error
    return packages, tuple(distros.split())


def write(file: Path, packages: Packages, distros: Sequence[str] = (), date: str = "") -> About:
    """Writes packed packages; a file that is there is replaced as a whole. distros, date: see About."""
    versions = {
        (name, version)
        for (name, _), packed in packages.items()
        for version in SurfaceHistory(name, packed.data, packed.includes).versions
    }
    about = About(len({name for name, _ in packages}), len(versions), " ".join(distros), date)
    with tempfile.TemporaryDirectory() as folder:
        fresh = Path(folder, "surfaces.sqlite")
        _fill(fresh, packages, about)
        with open_for_replacing(file) as output:
            for piece in read_chunks(fresh):
                output.write(piece)
    return about


def _fill(file: Path, packages: Packages, about: About) -> None:
    with closing(sqlite3.connect(file)) as db:
        db.execute("PRAGMA page_size=512")  # each packed value ends in a page that it fills in part
        db.executescript(_SCHEMA)
        db.executemany(
            "INSERT INTO package VALUES(?, ?, ?, ?, ?)", ((*key, *packed) for key, packed in sorted(packages.items()))
        )
        db.execute("INSERT INTO elsewhere VALUES(?)", (_pack_moved_names(packages),))
        db.execute("INSERT INTO headers VALUES(?)", (_pack_headers(packages),))
        db.execute("INSERT INTO parameters VALUES(?)", (_pack_parameters(packages),))
        db.execute("INSERT INTO tree_nodes VALUES(?)", (_pack_tree_nodes(packages),))
        db.execute("INSERT INTO about VALUES(?, ?, ?, ?)", about)
        db.commit()
        db.execute("VACUUM")


def _pack_moved_names(packages: Packages) -> bytes:
    """Names that a package lost and others have or had, with those packages."""
    lost: dict[str, set[str]] = {}
    for (package, _), packed in packages.items():
        events = read_packed(packed.changes, Line).events
        for side in ("c++", "header", "python"):
            for name in events.get(side, ()):
                lost.setdefault(name, set()).add(package)
    found: dict[str, dict[str, None]] = {}
    for (package, _), packed in sorted(packages.items()):
        for name in SurfaceHistory(package, packed.data, packed.includes).index_names().keys() & lost.keys():
            if lost[name] != {package}:
                found.setdefault(name, {})[package] = None
    return _pack_names(found)


def _pack_headers(packages: Packages) -> bytes:
    """Headers that do not lie in a folder called like their package, with the packages that have or had them."""
    found: dict[str, dict[str, None]] = {}
    for (package, _), packed in sorted(packages.items()):
        for header in read_packed(packed.includes, Included).headers:
            if not header.startswith(f"{package}/"):
                found.setdefault(header, {})[package] = None
    return _pack_names(found)


def _pack_names(found: dict[str, dict[str, None]]) -> bytes:
    ordered = {name: list(packages) for name, packages in sorted(found.items())}
    return zstandard.ZstdCompressor(level=_LEVEL).compress(_encoder.encode(ordered))


def _pack_parameters(packages: Packages) -> bytes:
    """The last parts of names of parameters that came or went for sure, with the packages they did so in."""
    found: dict[str, dict[str, None]] = {}
    for (package, _), packed in sorted(packages.items()):
        for name, events in read_packed(packed.changes, Line).events.get(PARAMETER, {}).items():
            if any(t.kind in ("added", "removed") and t.sure >= 1 for event in events for t in event.reported):
                found.setdefault(find_last_part(name), {})[package] = None
    return _pack_names(found)


def _pack_tree_nodes(packages: Packages) -> bytes:
    """Nodes of behaviour trees, with the packages of which some version registers them for sure."""
    found: dict[str, dict[str, None]] = {}
    for (package, _), packed in sorted(packages.items()):
        for plugin in SurfaceHistory(package, packed.data, packed.includes).list_all_plugins():
            if plugin.base == TREE_NODE and plugin.sure:
                found.setdefault(plugin.name, {})[package] = None
    return _pack_names(found)


def find_spans(places: Sequence[int], count: int) -> list[int]:
    """First and last places of each run; nothing for all of them."""
    if len(places) == count:
        return []
    runs: list[int] = []
    for place in places:
        if runs and runs[-1] == place - 1:
            runs[-1] = place
        else:
            runs += [place, place]
    return runs


class IncludesPacker:
    """Packs what the headers of a package include, version by version, oldest first."""

    def __init__(self) -> None:
        self._versions: list[str] = []
        self._approximate: list[str] = []
        self._numbers: dict[Include, int] = {}
        self._types: dict[str, int] = {}
        self._places: dict[str, dict[tuple[tuple[int, ...], tuple[int, ...]], list[int]]] = {}

    def add(
        self,
        version: str,
        headers: Iterable[tuple[str, HeaderSurface]],
        approximate: bool = False,
    ) -> None:
        """The next version."""
        place = len(self._versions)
        self._versions.append(version)
        if approximate:
            self._approximate.append(version)
        for path, header in headers:
            includes = tuple(self._numbers.setdefault(include, len(self._numbers)) for include in header.includes)
            announced = tuple(self._types.setdefault(name, len(self._types)) for name in header.announced)
            self._places.setdefault(path, {}).setdefault((includes, announced), []).append(place)

    def pack_versions(self) -> bytes:
        """All versions as they are stored."""
        count = len(self._versions)
        headers = {
            path: tuple(IncludesRow(tuple(find_spans(places, count)), *state) for state, places in states.items())
            for path, states in sorted(self._places.items())
        }
        whole = Included(
            tuple(self._versions),
            tuple(self._approximate),
            tuple(self._numbers),
            tuple(self._types),
            headers,
        )
        return zstandard.ZstdCompressor(level=19).compress(_encoder.encode(whole))


def shorten_message(message: str) -> str:
    """A message of a deprecation, cut where it is longer than a sentence."""
    if len(message) <= _SENTENCE:
        return message
    return message[: message.rindex(" ", 0, _SENTENCE) if " " in message[:_SENTENCE] else _SENTENCE] + " ..."


_SENTENCE = 160


def pack(line: Line) -> bytes:
    """A line as it is stored."""
    return zstandard.ZstdCompressor(level=19).compress(_encoder.encode(line))
