"""Writes data/libraries.sqlite from what libraries.py read: a row for each library, in the form of surfaces.sqlite, and
which library a Debian package belongs to."""

from __future__ import annotations

import re
import sqlite3
import tempfile
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import msgspec
import zstandard

from ..edges.files import open_for_replacing, read_chunks
from ..impact.facts.surface import Entity, HeaderSurface
from ..impact.targets.providers.libraries import NEAREST, HeaderBlock, HeaderState
from ..impact.targets.providers.providers import load_providers
from ..impact.targets.surface.surface import BuildSurface, PythonSurface, Surface
from ..impact.targets.version import parse
from .libraries import INNER, INNER_NAME, extract_upstream_version
from .surface_file import Packer, Stored, find_spans

if TYPE_CHECKING:
    from ..impact.facts.cpp.lexical import Include
    from .libraries import LibraryFacts, Texts

_SCHEMA = """
CREATE TABLE package(name TEXT PRIMARY KEY, data BLOB NOT NULL, names BLOB NOT NULL, roots TEXT NOT NULL,
  versions TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE block(library TEXT, start TEXT, data BLOB NOT NULL, PRIMARY KEY(library, start)) WITHOUT ROWID;
CREATE TABLE debian(name TEXT PRIMARY KEY, library TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE target(name TEXT PRIMARY KEY, library TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE header(name TEXT PRIMARY KEY, library TEXT NOT NULL) WITHOUT ROWID;
"""
"""package: data as in surfaces.sqlite, without headers, and with what these declare apart, in names, in the form of
data; roots: folders that flags name in any version, space separated; versions: `SUITE=VERSION ...`, oldest first.
block: headers of all versions, see HeaderBlock, and the first of them. debian: the development packages that were read.
target: CMake targets with a namespace, and the library whose configurations export them in some version, where that is
one. header: headers whose library the table of providers does not lead to."""
_BLOCK = 128
"""Headers that are read at once. More are smaller when packed, and take longer to read."""


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
                data, names, blocks = _pack_library(name, each, texts)
                versions += len(each)
                headers += sum(len(facts.headers) for _, facts in each)
                roots = " ".join(dict.fromkeys(root for _, facts in each for root in facts.roots))
                reported = " ".join(f"{suite}={extract_upstream_version(facts.version)}" for suite, facts in each)
                db.execute("INSERT INTO package VALUES(?, ?, ?, ?, ?)", (name, data, names, roots, reported))
                db.executemany("INSERT INTO block VALUES(?, ?, ?)", ((name, *block) for block in blocks))
            db.executemany("INSERT INTO target VALUES(?, ?)", sorted(_collect_targets(by_library).items()))
            db.executemany("INSERT INTO header VALUES(?, ?)", sorted(_find_stray_headers(by_library, debian).items()))
            db.executemany("INSERT INTO debian VALUES(?, ?)", sorted(debian.items()))
            db.commit()
            db.execute("VACUUM")
        with open_for_replacing(file) as output:
            for piece in read_chunks(fresh):
                output.write(piece)
    return WrittenCounts(len(by_library), versions, headers, file.stat().st_size)


def _collect_targets(by_library: Mapping[str, Sequence[tuple[str, LibraryFacts]]]) -> dict[str, str]:
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


def _find_stray_headers(
    by_library: Mapping[str, Sequence[tuple[str, LibraryFacts]]], debian: Mapping[str, str]
) -> dict[str, str]:
    """Headers that one library has, and of which those that bring it name none of its packages."""
    owners: dict[str, set[str]] = defaultdict(set)
    for library, each in by_library.items():
        for path in {header.path for _, facts in each for header in facts.headers}:
            owners[path].add(library)
    found = {}
    for path, libraries in owners.items():
        packages = [p.package for p in load_providers().find_header(path) if p.kind == "system" and p.package]
        if packages and len(libraries) == 1 and libraries.isdisjoint(map(debian.get, packages[:NEAREST])):
            found[path] = next(iter(libraries))
    return found


def fold(name: str) -> str:
    """A CMake name without case and marks."""
    return re.sub(r"[\W_]", "", name.lower())


def _pack_library(
    name: str, each: Sequence[tuple[str, LibraryFacts]], texts: Texts
) -> tuple[bytes, bytes, list[tuple[str, bytes]]]:
    """What is stored of a library: what its versions offer, what their headers declare, and the blocks of these."""
    packer, names = Packer(), Packer()
    blocks = Blocks(header.path for _, facts in each for header in facts.headers)
    of_version: dict[str, LibraryFacts] = {}
    for _, facts in each:
        of_version.setdefault(extract_upstream_version(facts.version), facts)
    for version, facts in sorted(of_version.items(), key=lambda one: parse(one[0])):
        headers = list(_select_headers(facts, texts))
        packer.add(Stored(version, False, _make_surface(facts, version)))
        empty = BuildSurface(name, version), PythonSurface(name)
        names.add(Stored(version, False, Surface(name, version, *empty, headers=tuple(headers))))
        links = (" ".join(header.links) for header in facts.headers)
        blocks.add((path, header.includes, reported) for (path, header), reported in zip(headers, links, strict=True))
    return packer.pack_versions(), names.pack_versions(), list(blocks.pack_blocks())


class Blocks:
    """Packs the headers of a library, version by version, oldest first. paths: all that will come, and those that only
    another release of Debian has of a version; of these no more is kept."""

    def __init__(self, paths: Iterable[str]) -> None:
        self._versions = 0
        self._places: dict[str, dict[tuple[tuple[Include, ...], str], list[int]]] = {p: {} for p in sorted(paths)}

    def add(self, headers: Iterable[tuple[str, tuple[Include, ...], str]]) -> None:
        """The next version: its headers, each with what it includes, and the stems of what is linked."""
        for path, includes, links in headers:
            places = self._places[path].setdefault((includes, links), [])
            if self._versions not in places:
                places.append(self._versions)
        self._versions += 1

    def pack_blocks(self) -> Iterator[tuple[str, bytes]]:
        """The first header of each block, and the block."""
        paths = list(self._places)
        for at in range(0, len(paths), _BLOCK):
            numbers: dict[Include, int] = {}
            headers = {
                path: tuple(
                    HeaderState(
                        tuple(find_spans(places, self._versions)),
                        tuple(numbers.setdefault(include, len(numbers)) for include in includes),
                        links,
                    )
                    for (includes, links), places in self._places[path].items()
                )
                for path in paths[at : at + _BLOCK]
            }
            whole = msgspec.msgpack.encode(HeaderBlock(tuple(numbers), headers))
            yield paths[at], zstandard.ZstdCompressor(level=19).compress(whole)


def _select_headers(facts: LibraryFacts, texts: Texts) -> Iterator[tuple[str, HeaderSurface]]:
    for header in facts.headers:
        text = texts.get(header.sha)
        if text.refuses:
            yield header.path, HeaderSurface((), deprecated=f"#error {text.refuses}")
            continue
        inner = INNER.search(header.path) is not None
        entities = () if inner else tuple(one for one in text.surface.entities if _is_public(one))
        yield header.path, msgspec.structs.replace(text.surface, entities=entities, announced=(), problems=(), lost=0)


def _is_public(one: Entity) -> bool:
    return not one.internal and one.access in ("", "public") and INNER_NAME.search(one.name) is None


def _make_surface(facts: LibraryFacts, version: str) -> Surface:
    build = BuildSurface(
        facts.library,
        version,
        cmake_names=facts.cmake,
        targets=facts.targets,
        libraries=facts.links,
        include_dirs=facts.roots,
        variables=facts.variables,
        unknown=(("targets", "CMake works their names out"),) if facts.targets_open else (),
        pkgconfig=tuple(" ".join((name, *stems)) for name, stems in facts.pkgconfig),
    )
    return Surface(facts.library, version, build, PythonSurface(facts.library))
