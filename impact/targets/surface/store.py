"""Surfaces of many versions in one file: facts only (names, signatures, versions), each kept once with its versions.

An SQLite file with a row for each package and ROS generation, packed by itself, so that one package is read in
milliseconds and the others not at all. What is packed: the versions in order, and rows of (kind, scope, value, the
first and last versions that have it, over and over). Lines, comments, and names of C++ parameters are left out.
"""

from __future__ import annotations

import hashlib
import os
import sqlite3
from collections.abc import Callable, Collection, Iterator, Sequence
from functools import cache, cached_property, lru_cache
from operator import itemgetter
from pathlib import Path
from typing import Any, NamedTuple

import msgspec

from ....edges.console import UserError
from ....edges.groups import group_pairs
from ....edges.memory import cache_method
from ...facts.interface import Interface
from ...facts.python.surface import Bound, ImportedName, ModuleSurface
from ...facts.surface import CLASSES, Entity, HeaderSurface, drop_inline, list_offered
from ..tables import find_table, suggest_repair
from ..unpacked import SnapshotError, make_decoder, read_packed
from .changes import Line
from .includes import Included, covers
from .surface import BuildSurface, InstalledModule, Plugin, PythonSurface, Surface

TYPES = CLASSES | {"enum", "alias"}
"""The kinds of types."""


class StoredSurfacesError(UserError):
    """The file cannot be read; the message names it and says what to do."""


class About(NamedTuple):
    """What a file holds. versions: of all packages together. distros: whose versions were read, space separated. date:
    the newest day of what was known of them."""

    packages: int
    versions: int
    distros: str
    date: str


# What a package has to itself, of the parts of a BuildSurface.
_OWN = frozenset({"targets", "libraries", "commands", "programs", "plugins", "launches", "headers"})


@cache
def _list_build_fields() -> dict[str, Any]:
    """The types of those fields of a BuildSurface that hold several values."""
    empty = BuildSurface("")
    fields = msgspec.structs.fields(BuildSurface)
    return {field.name: field.type for field in fields if isinstance(getattr(empty, field.name), tuple)}


class SurfaceHistory:
    """All stored versions of one package of one ROS generation, oldest first. approximate: those that a branch stood
    for."""

    def __init__(self, package: str, data: bytes, includes: bytes):
        self.package, self._includes = package, includes
        versions, approximate, rows = read_packed(data, _Rows)
        self.versions: tuple[str, ...] = tuple(versions)
        self.approximate = frozenset(approximate)
        # Values are read where they are asked for; a header is the scope of all that it declares.
        scopes: dict[str, str] = {}
        self._rows = group_pairs(
            (kind, (scopes.setdefault(scope, scope), value, spans)) for kind, scope, value, spans in rows
        )

    def load_surface(self, version: str) -> Surface | None:
        """What a version offers; None for one that is not stored."""
        build, python = self.build(version), self.load_python(version)
        if build is None or python is None:
            return None
        guessed, runs_with = next((value for _, value in self._iterate("surface", version)), (False, ()))
        return Surface(
            self.package,
            version,
            build,
            python,
            tuple(sorted(self._iterate_headers(version), key=_name)),
            tuple(sorted(self._iterate("interface", version, Interface), key=_name)),
            guessed,
            tuple(runs_with),
            self.list_parameters(version),
        )

    def list_parameters(self, version: str) -> tuple[tuple[str, str | None], ...]:
        """The parameters that a version declares, with their defaults, as in Surface."""
        return tuple(sorted(self._iterate("parameter", version), key=_name))

    def build(self, version: str, of: tuple[str, ...] = ()) -> BuildSurface | None:
        """What a version gives to CMake and at run time; None for one that is not stored. of: these fields alone."""
        if version not in self.versions:
            return None
        build = group_pairs(self._iterate("build", version, of=of))
        known = _list_build_fields()
        given = {
            name: msgspec.convert(values, known[name]) if name in known else values[-1]
            for name, values in build.items()
        }
        return BuildSurface(self.package, version, **given)

    def list_all_plugins(self) -> list[Plugin]:
        """The plugins of all versions."""
        decode = make_decoder(Plugin)
        return [decode(value) for scope, value, _ in self._rows.get("build", ()) if scope == "plugins"]

    def list_exports(self, version: str) -> tuple[str, ...] | None:
        """The packages, and the CMake names of system libraries, that a version hands on to its dependants; None for
        a version that is not stored, or whose build says nothing."""
        found: list[str] = []
        kinds = 0
        for scope, value in self._iterate("build", version, of=("build_type", "dependencies", "system")):
            if scope == "build_type":
                kinds += 1
            else:
                found.append(value)
        return tuple(found) if kinds else None

    def list_own_names(self, version: str) -> frozenset[tuple[str, str]]:
        """The headers, modules, programs and interfaces of a stored version, each with its kind, without the name of
        the package that their paths begin with."""
        surface = self.load_surface(version)
        if surface is None:
            return frozenset()
        found = {("header", header.include.partition("/")[2]) for header in surface.build.headers}
        found.update(("module", module.name.partition(".")[2]) for module in surface.python.modules)
        found.update(("program", program.name) for program in surface.build.programs)
        found.update(("interface", name) for name, _ in surface.interfaces)
        return frozenset(each for each in found if each[1])

    def is_bundle(self, version: str) -> bool:
        """True for a version that has nothing to include, import, link, start or load."""
        if version not in self.versions:
            return False
        place = self.versions.index(version)
        return not any(
            covers(spans, place)
            for kind, rows in self._rows.items()
            for scope, _, spans in rows
            if kind != "surface" and (kind != "build" or scope in _OWN)
        )

    def load_python(self, version: str) -> PythonSurface | None:
        """The Python of a version; None for one that is not stored."""
        if version not in self.versions:
            return None
        bound = group_pairs(self._iterate("bound", version, Bound))
        taken = group_pairs(self._iterate("taken", version, ImportedName))
        reported = group_pairs(self._iterate("python", version, str))
        modules = (
            InstalledModule(
                name,
                path,
                is_package,
                ModuleSurface(
                    tuple(bound.get(name, ())),
                    tuple(taken.get(name, ())),
                    None if all_ is None else tuple(all_),
                    all_open,
                    tuple((scope, why) for scope, why in open_),
                    deprecated,
                    parsed,
                ),
            )
            for name, (path, is_package, all_, all_open, open_, deprecated, parsed) in self._iterate("module", version)
        )
        return PythonSurface(
            self.package,
            tuple(sorted(modules, key=lambda module: module.name)),
            tuple(reported.get("unknown", ())),
            tuple(reported.get("unresolved", ())),
        )

    @cached_property
    def included(self) -> Included:
        """What the headers of each version include."""
        return read_packed(self._includes, Included)

    def load_interfaces(self, version: str) -> dict[str, Interface]:
        """The messages, services and actions of a version, by `msg/Name`."""
        return dict(self._iterate("interface", version, Interface))

    def iterate_entities(self, name: str, version: str) -> Iterator[Entity]:
        """What a version declares by a name of C++, as users write it; nothing for a version that is not stored."""
        if version not in self.versions:
            return iter(())
        place = self.versions.index(version)
        rows = self._by_last.get(name.rpartition("::")[2], ())
        near = tuple(make_decoder(Entity)(value) for _, value, spans in rows if covers(spans, place))
        found = list_offered([HeaderSurface(near, inline=self._list_inline_namespaces(version))]) if near else ()
        return (entity for entity in found if entity.name == name)

    def list_entities(self, version: str) -> Iterator[Entity]:
        """All that a version declares in C++, as users write it; nothing for a version that is not stored."""
        if version in self.versions:
            near = tuple(entity for _, entity in self._iterate("entity", version, Entity))
            yield from list_offered([HeaderSurface(near, inline=self._list_inline_namespaces(version))])

    @cached_property
    def _by_last(self) -> dict[str, list[Any]]:
        """The rows of what is declared in C++, by the last part of its name, with and without template arguments."""
        found: dict[str, list[Any]] = {}
        for row in self._rows.get("entity", ()):
            full = _decode_head(row[1]).name
            for last in {full.rpartition("::")[2], full.partition("<")[0].rpartition("::")[2]}:
                found.setdefault(last, []).append(row)
        return found

    @cached_property
    def converting(self) -> frozenset[str]:
        """Last parts of the classes that some version converts to other types by operators of their own."""
        heads = (_decode_head(value) for _, value, _ in self._rows.get("entity", ()))
        owners = (head.name.rpartition("::operator ")[0] for head in heads if head.kind == "conversion")
        return frozenset(owner.rpartition("::")[2] for owner in owners)

    def has_declared(self, last: str) -> bool:
        """Whether any version declares something in C++ whose name has such a last part."""
        return last in self._by_last

    def has_announced(self, name: str, version: str) -> bool:
        """Whether a header of a version announces a type, which another may define."""
        paths = (path for path, _ in self._iterate("header", version))
        return any(name in self.included.list_announced_types(path, version) for path in paths)

    def is_understood(self, name: str) -> bool:
        """Whether nothing is lost of the headers that declare a name in some version, or one that ends like it."""
        paths = {scope for scope, *_ in self._by_last.get(name.rpartition("::")[2], ())}
        return not any(scope in paths and _decoded(value)[3] for scope, value, _ in self._rows.get("header", ()))

    @cache_method
    def _list_inline_namespaces(self, version: str) -> tuple[str, ...]:
        """The inline namespaces of a version."""
        spaces = (space for _, (spaces, *_) in self._iterate("header", version) for space in spaces)
        return tuple(dict.fromkeys(spaces))

    def _iterate_headers(self, version: str) -> Iterator[tuple[str, HeaderSurface]]:
        entities = group_pairs(self._iterate("entity", version, Entity))
        for path, (inline, deprecated, instead, lost) in self._iterate("header", version):
            yield (
                path,
                HeaderSurface(
                    tuple(entities.get(path, ())),
                    self.included.list_includes(path, version) or (),
                    tuple(inline),
                    deprecated,
                    instead,
                    lost,
                    announced=self.included.list_announced_types(path, version),
                ),
            )

    def _iterate(
        self, kind: str, version: str, type_: Any = Any, of: tuple[str, ...] = ()
    ) -> Iterator[tuple[str, Any]]:
        """Scope and value of each row of a kind that a version has. of: these scopes."""
        place = self.versions.index(version) if version in self.versions else -1
        decode = make_decoder(type_)
        for scope, value, spans in self._rows.get(kind, ()):
            if of and scope not in of:
                continue
            if place >= 0 and covers(spans, place):
                yield scope, decode(value)

    @cached_property
    def _named(self) -> dict[str, tuple[int, ...]]:
        """The spans of everything that has a name of its own, of all that have the same; none are all versions."""
        found: dict[str, tuple[int, ...]] = {}
        for kind, named in _NAMED.items():
            for scope, value, spans in self._rows.get(kind, ()):
                name = named(self.package, scope, value)
                others = found.setdefault(name, spans)
                if others != spans:
                    found[name] = (*others, *spans) if others and spans else ()
        return found

    def has(self, name: str, version: str) -> bool:
        """Whether a version has a header, interface, C++ name, Python module or name."""
        spans = self._named.get(name)
        return version in self.versions and spans is not None and covers(spans, self.versions.index(version))

    def index_names(self) -> dict[str, tuple[str, ...]]:
        """Headers, interfaces, C++ names, Python modules and names that any version had, with the versions that do."""
        count = len(self.versions)
        found = {name: set(_expand(spans, count)) for name, spans in self._named.items()}
        return {name: tuple(self.versions[place] for place in sorted(places)) for name, places in found.items()}

    def index_types(self, kinds: Collection[str] = TYPES) -> dict[str, tuple[str, ...]]:
        """What any version had of some kinds, outside of classes, with the headers that define it."""
        inline = {name for _, value, _ in self._rows.get("header", ()) for name in _decoded(value)[0]}
        found: dict[str, dict[str, None]] = {}
        classes: set[str] = set()
        for scope, value, _ in self._rows.get("entity", ()):
            head = _decode_head(value)
            if head.kind in kinds:
                name = drop_inline(head.name, inline)
                found.setdefault(name, {})[scope] = None
                if head.kind in CLASSES:
                    classes.add(name)
        return {name: tuple(sorted(where)) for name, where in found.items() if name.rpartition("::")[0] not in classes}

    @cached_property
    def python_words(self) -> frozenset[str]:
        """Every word that some version binds somewhere in its Python modules, and the last parts of their names."""
        values = (value for kind in ("bound", "taken") for _, value, _ in self._rows.get(kind, ()))
        found = {_decode_first(value).name.rpartition(".")[2] for value in values}
        return frozenset(found.union(*(scope.split(".") for scope, *_ in self._rows.get("module", ()))))


_Rows = tuple[list[str], list[str], list[tuple[str, str, msgspec.Raw, tuple[int, ...]]]]
_name = itemgetter(0)


_decoded = make_decoder(Any)


class _Head(msgspec.Struct, array_like=True, gc=False):
    """How an entity begins: what follows is passed over."""

    kind: str
    name: str


class _First(msgspec.Struct, array_like=True, gc=False):
    """The same of a name of Python that is bound or taken."""

    name: str


_decode_head, _decode_first = make_decoder(_Head), make_decoder(_First)
# How what a row of a kind is about is called.
_NAMED: dict[str, Callable[[str, str, msgspec.Raw], str]] = {
    "header": lambda package, path, value: path,
    "entity": lambda package, path, value: _decode_head(value).name,
    "bound": lambda package, module, value: f"{module}.{_decode_first(value).name}",
    "module": lambda package, module, value: module,
    "interface": lambda package, name, value: f"{package}/{name}",
}


def _expand(spans: Sequence[int], count: int) -> Iterator[int]:
    for at in range(0, len(spans), 2):
        yield from range(spans[at], spans[at + 1] + 1)
    if not spans:
        yield from range(count)


class StoredRows:
    """An SQLite file that is only read, by any process. Its methods raise StoredSurfacesError when it cannot be."""

    def __init__(self, file: Path):
        self.file = file
        self._reader = 0  # the process that opened it

    def query_column(self, query: str, *values: str) -> list[Any]:
        """The first column of a query's rows."""
        return [row[0] for row in self.fetch(query, *values)]

    def fetch(self, query: str, *values: str | int) -> Iterator[tuple]:
        try:
            if self._reader != os.getpid():
                # No other process may go on with a connection of this one.
                self._db = sqlite3.connect(f"{self.file.absolute().as_uri()}?mode=ro&immutable=1", uri=True)
                self._reader = os.getpid()
            yield from self._db.execute(query, values)
        except sqlite3.Error as error:
            raise StoredSurfacesError(f"{self.file}: {error}; make it anew with `rosimpact surface build`") from None


class Surfaces(StoredRows):
    """A file of surfaces. Raises StoredSurfacesError when it cannot be opened."""

    def __init__(self, file: Path):
        super().__init__(file)
        self._generations: dict[str, tuple[int, ...]] = {}
        for name, ros in self.fetch("SELECT name, ros FROM package ORDER BY name, ros"):
            self._generations[name] = (*self._generations.get(name, ()), ros)
        self.packages = frozenset(self._generations)

    def list_ros(self, package: str) -> tuple[int, ...]:
        """The ROS generations of which versions of a package are stored; 0 alone for a library of the platform."""
        return self._generations.get(package, ())

    def is_library(self, package: str) -> bool:
        """Whether a package is a library of the platform, which is of no ROS generation."""
        return self.list_ros(package) == (0,)

    def find_history(self, package: str, ros: int) -> SurfaceHistory | None:
        """All versions of a package that a ROS generation, or any, has, None when there is none."""
        # Most packages that are asked for are not stored, and must not displace those that are.
        ros = 0 if self.is_library(package) else ros
        return self._load_history(package, ros) if ros in self.list_ros(package) else None

    @lru_cache(maxsize=256)  # noqa: B019  (one of them lives as long as the program)
    def _load_history(self, package: str, ros: int) -> SurfaceHistory | None:
        row = self._query_row("data, includes", package, ros)
        return SurfaceHistory(package, *row) if row else None

    @lru_cache(maxsize=1024)  # noqa: B019
    def find_line(self, package: str, ros: int) -> Line | None:
        """What changed in a package of a ROS generation, or of any, from version to version, None when it is not
        there."""
        row = self._query_row("changes", package, 0 if self.is_library(package) else ros)
        return read_packed(row[0], Line) if row else None

    def find_lines(self, package: str) -> dict[int, Line]:
        """The same by ROS generation; empty when the package is not there."""
        return {ros: line for ros in self.list_ros(package) if (line := self.find_line(package, ros)) is not None}

    @lru_cache(maxsize=1024)  # noqa: B019
    def find_included(self, package: str, ros: int) -> Included | None:
        """What the headers of each version of a package of a ROS generation include, None when it is not there."""
        row = self._query_row("includes", package, ros)
        return read_packed(row[0], Included) if row else None

    def _query_row(self, columns: str, package: str, ros: int) -> tuple | None:
        if ros not in self.list_ros(package):
            return None
        return next(self.fetch(f"SELECT {columns} FROM package WHERE name = ? AND ros = ?", package, ros), None)

    def list_holders(self, header: str) -> tuple[str, ...]:
        """The packages that may have, or have had, a header, by the path that dependants write."""
        head, separator, _ = header.partition("/")
        named = (head,) if separator and head in self.packages else ()
        return (*named, *self._headers.get(header, ()))

    @cached_property
    def _headers(self) -> dict[str, tuple[str, ...]]:
        """Headers that do not lie in a folder called like their package."""
        (data,) = next(self.fetch("SELECT data FROM headers"))
        return read_packed(data, dict[str, tuple[str, ...]])

    @cached_property
    def changing_parameters(self) -> dict[str, frozenset[str]]:
        """The last parts of names of parameters that some versions of a package surely declare and others surely do
        not, with those packages."""
        (data,) = next(self.fetch("SELECT data FROM parameters"))
        return read_packed(data, dict[str, frozenset[str]])

    @cached_property
    def tree_nodes(self) -> dict[str, tuple[str, ...]]:
        """Nodes of behaviour trees that some version of a package surely registers, with those packages."""
        (data,) = next(self.fetch("SELECT data FROM tree_nodes"))
        return read_packed(data, dict[str, tuple[str, ...]])

    @cached_property
    def about(self) -> About:
        """What the file holds."""
        return About(*next(self.fetch("SELECT packages, versions, distros, date FROM about")))

    @cached_property
    def plugin_owners(self) -> dict[str, tuple[tuple[str, int], ...]]:
        """The lookup names and types of plugins that some version of a package has, with those packages and their ROS
        generations. All packages are read for it."""
        decode = make_decoder(Plugin)
        rows = (
            (name, (package, ros))
            for package, ros, data in self.fetch("SELECT name, ros, data FROM package ORDER BY name, ros")
            for kind, scope, value, _ in (read_packed(data, _Rows)[2] if ros else ())
            if kind == "build" and scope == "plugins"
            for plugin in (decode(value),)
            for name in (plugin.name, plugin.type)
            if name
        )
        return {name: tuple(dict.fromkeys(owners)) for name, owners in group_pairs(rows).items()}

    def list_other_packages(self, name: str) -> tuple[str, ...]:
        """The packages that have, or had, a name that some package lost."""
        return self._elsewhere.get(name, ())

    @cached_property
    def _elsewhere(self) -> dict[str, tuple[str, ...]]:
        (data,) = next(self.fetch("SELECT data FROM elsewhere"))
        return read_packed(data, dict[str, tuple[str, ...]])

    @cached_property
    def stamp(self) -> str:
        """Differs whenever the file does."""
        return hashlib.sha1(self.file.read_bytes()).hexdigest()[:16]


@cache
def load_shipped() -> Surfaces:
    """The surfaces that come with the program. Raises SnapshotError when they cannot be read."""
    try:
        return Surfaces(find_table("surfaces.sqlite"))
    except StoredSurfacesError as error:
        raise SnapshotError(f"{str(error).partition(';')[0]}; {suggest_repair()}") from None
