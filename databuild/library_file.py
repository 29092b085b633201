"""Writes data/libraries.sqlite from what libraries.py read: a row for each library, in the form of surfaces.sqlite, and
which library a Debian package belongs to."""

from __future__ import annotations

import re
import sqlite3
import tempfile
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import msgspec
import zstandard

from ..edges.files import read_chunks, writing
from ..impact.facts.surface import Entity, HeaderSurface
from ..impact.targets.providers.libraries import NEAREST
from ..impact.targets.providers.providers import default_providers
from ..impact.targets.surface.changes import Line
from ..impact.targets.surface.store import Stored
from ..impact.targets.surface.surface import BuildSurface, Header, PythonSurface, Surface
from ..impact.targets.version import parts
from .libraries import INNER, INNER_NAME, upstream
from .surface_file import Including, Packer, pack

if TYPE_CHECKING:
    from .libraries import LibraryFacts, Texts

_SCHEMA = """
CREATE TABLE package(name TEXT, ros INTEGER, data BLOB NOT NULL, changes BLOB NOT NULL, includes BLOB NOT NULL,
  names BLOB NOT NULL, headers BLOB NOT NULL, versions TEXT NOT NULL, PRIMARY KEY(name, ros)) WITHOUT ROWID;
CREATE TABLE debian(name TEXT PRIMARY KEY, library TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE target(name TEXT PRIMARY KEY, library TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE header(name TEXT PRIMARY KEY, library TEXT NOT NULL) WITHOUT ROWID;
"""
"""package: as in surfaces.sqlite, of no ROS generation (0), with what headers declare apart, in names, in the form of
data; headers: the paths of all versions, a line each, packed; versions: `SUITE=VERSION ...`, oldest first. debian: the
development packages that were read. target: CMake targets with a namespace, and the library whose configurations
export them in some version, where that is one. header: headers
whose library the table of providers does not lead to."""


class WrittenCounts(NamedTuple):
    """What was written."""

    libraries: int
    versions: int
    headers: int
    bytes: int


def write(file: Path, suites: Mapping[str, Mapping[str, LibraryFacts]], texts: Texts) -> WrittenCounts:
    """Writes the file. suites: by name, oldest first, each with its libraries."""
    by_library: dict[str, list[tuple[str, LibraryFacts]]] = defaultdict(list)
    debian: dict[str, str] = {}
    for suite, libraries in suites.items():
        for name, facts in libraries.items():
            by_library[name].append((suite, facts))
            debian.update(dict.fromkeys(facts.packages, name))
    versions = headers = 0
    with tempfile.TemporaryDirectory() as folder:
        fresh = Path(folder, file.name)
        with closing(sqlite3.connect(fresh)) as db:
            db.execute("PRAGMA page_size=512")
            db.executescript(_SCHEMA)
            for name, each in sorted(by_library.items()):
                row = _packed(name, each, texts)
                versions += len(each)
                headers += sum(len(facts.headers) for _, facts in each)
                db.execute("INSERT INTO package VALUES(?, 0, ?, ?, ?, ?, ?, ?)", (name, *row))
            db.executemany("INSERT INTO target VALUES(?, ?)", sorted(_targets(by_library).items()))
            db.executemany("INSERT INTO header VALUES(?, ?)", sorted(_strays(by_library, debian).items()))
            db.executemany("INSERT INTO debian VALUES(?, ?)", sorted(debian.items()))
            db.commit()
            db.execute("VACUUM")
        with writing(file) as output:
            for piece in read_chunks(fresh):
                output.write(piece)
    return WrittenCounts(len(by_library), versions, headers, file.stat().st_size)


def _targets(by_library: Mapping[str, Sequence[tuple[str, LibraryFacts]]]) -> dict[str, str]:
    """Exported targets with a namespace to the library that has them. A library may make targets for what it needs."""
    found: dict[str, set[str]] = defaultdict(set)
    for library, each in by_library.items():
        for _, facts in each:
            spaces = {fold(name) for name in facts.cmake}
            for target in facts.targets:
                space, colons, _ = target.name.partition("::")
                if colons and fold(space) in spaces:
                    found[target.name].add(library)
    return {name: libraries.pop() for name, libraries in found.items() if len(libraries) == 1}


def _strays(
    by_library: Mapping[str, Sequence[tuple[str, LibraryFacts]]], debian: Mapping[str, str]
) -> dict[str, str]:
    """Headers that one library has, and of which those that bring it name none of its packages."""
    owners: dict[str, set[str]] = defaultdict(set)
    for library, each in by_library.items():
        for path in {header.path for _, facts in each for header in facts.headers}:
            owners[path].add(library)
    found = {}
    for path, libraries in owners.items():
        packages = [p.package for p in default_providers().header(path) if p.kind == "system" and p.package]
        if packages and len(libraries) == 1 and libraries.isdisjoint(map(debian.get, packages[:NEAREST])):
            found[path] = next(iter(libraries))
    return found


def fold(name: str) -> str:
    """A CMake name without case and marks."""
    return re.sub(r"[\W_]", "", name.lower())


def _packed(
    name: str, each: Sequence[tuple[str, LibraryFacts]], texts: Texts
) -> tuple[bytes, bytes, bytes, bytes, bytes, str]:
    """What is stored of a library: what its versions offer, nothing of what changed, what their headers include,
    what these declare, the headers of all versions, and the versions by suite."""
    packer, names, including = Packer(), Packer(), Including()
    of_suite = {suite: upstream(facts.version) for suite, facts in each}
    known: set[str] = set()
    for _, facts in sorted(each, key=lambda one: parts(upstream(one[1].version))):
        version = upstream(facts.version)
        if version in known:
            continue
        known.add(version)
        headers = list(_headers(facts, texts))
        packer.add(Stored(version, False, _surface(facts, version)))
        empty = BuildSurface(name, version), PythonSurface(name)
        names.add(Stored(version, False, Surface(name, version, *empty, headers=tuple(headers))))
        including.add(version, headers)
    line = Line(tuple(sorted(known, key=parts)), {})
    told = " ".join("=".join(one) for one in of_suite.items())
    paths = "\n".join(sorted({header.path for _, facts in each for header in facts.headers}))
    listed = zstandard.ZstdCompressor(level=19).compress(paths.encode())
    return packer.packed(), pack(line), including.packed(), names.packed(), listed, told


def _headers(facts: LibraryFacts, texts: Texts) -> Iterator[tuple[str, HeaderSurface]]:
    for header in facts.headers:
        text = texts.get(header.sha)
        if text.refuses:
            yield header.path, HeaderSurface((), deprecated=f"#error {text.refuses}")
            continue
        inner = INNER.search(header.path) is not None
        entities = () if inner else tuple(one for one in text.surface.entities if _is_told(one))
        yield header.path, msgspec.structs.replace(text.surface, entities=entities, announced=(), problems=(), lost=0)


def _is_told(one: Entity) -> bool:
    return not one.internal and one.access in ("", "public") and INNER_NAME.search(one.name) is None


def _surface(facts: LibraryFacts, version: str) -> Surface:
    build = BuildSurface(
        facts.library,
        version,
        cmake_names=facts.cmake,
        targets=facts.targets,
        libraries=facts.links,
        include_dirs=facts.roots,
        variables=facts.variables,
        headers=tuple(Header(one.path, "", " ".join(one.links)) for one in facts.headers),
        unknown=(("targets", "CMake works their names out"),) if facts.targets_open else (),
        pkgconfig=tuple(" ".join((name, *stems)) for name, stems in facts.pkgconfig),
    )
    return Surface(facts.library, version, build, PythonSurface(facts.library))
