"""Writes the collected facts as the compressed database that is shipped."""

import hashlib
import os
import sqlite3
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import msgspec

from ..edges.files import write_file
from ..impact.targets.snapshot import SnapshotInfo
from .keys import RuleEvent
from .manifests import DeclaredVersion
from .releases import DistroHistory

FILES = ("distros.sqlite.zst", "snapshot.json")
"""What a data folder gets."""

SCHEMA = """
CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT) WITHOUT ROWID;
CREATE TABLE distro(id INTEGER PRIMARY KEY, name TEXT UNIQUE, ros INTEGER, python INTEGER, status TEXT);
CREATE TABLE platforms(distro INTEGER, ts INTEGER, names TEXT, PRIMARY KEY(distro, ts)) WITHOUT ROWID;
CREATE TABLE sync(distro INTEGER, day TEXT, cut INTEGER, PRIMARY KEY(distro, day)) WITHOUT ROWID;
CREATE TABLE repository(id INTEGER PRIMARY KEY, name TEXT UNIQUE);
CREATE TABLE package(id INTEGER PRIMARY KEY, name TEXT UNIQUE);
CREATE TABLE url(id INTEGER PRIMARY KEY, text TEXT);
CREATE TABLE packages(id INTEGER PRIMARY KEY, names TEXT);
CREATE TABLE release(distro INTEGER, repository INTEGER, ts INTEGER, version TEXT, packages INTEGER,
    PRIMARY KEY(distro, repository, ts)) WITHOUT ROWID;
CREATE TABLE home(package INTEGER, distro INTEGER, repository INTEGER,
    PRIMARY KEY(package, distro, repository)) WITHOUT ROWID;
CREATE TABLE source(distro INTEGER, repository INTEGER, ts INTEGER, url INTEGER, branch TEXT, status TEXT,
    PRIMARY KEY(distro, repository, ts)) WITHOUT ROWID;
CREATE TABLE manifest(distro INTEGER, package INTEGER, version TEXT, dependencies INTEGER, build_type TEXT,
    PRIMARY KEY(distro, package, version)) WITHOUT ROWID;
CREATE TABLE dependencies(id INTEGER PRIMARY KEY, entries TEXT);
CREATE TABLE rule(key TEXT, os TEXT, ts INTEGER, rule TEXT, PRIMARY KEY(key, os, ts)) WITHOUT ROWID;
"""
"""Tables of the shipped database. `ts` and `cut` are seconds since 1970 (UTC) of a commit in rosdistro.

release: what a repository released from that moment on; version NULL: nothing any more.
packages: names, space separated. home: where a package was ever released.
sync: on `day` apt got the packages as released at `cut`.
platforms: names such as `ubuntu jammy`, comma separated, main one first.
manifest: one row where a package's declared dependencies changed with a version. dependencies.entries: one line for
each, tab separated: name, kinds (letters of KINDS), condition, bounds (`version_gte=1.2 version_lt=2`).
rule: the rosdep rule of a key for an operating system as JSON; NULL: dropped.
"""


class DistroRow(NamedTuple):
    """A distro as the index lists it."""

    name: str
    ros: int
    python: int
    status: str


class Sync(NamedTuple):
    """A sync of a distro: on `day` apt got what rosdistro listed at `cut`."""

    distro: str
    day: str
    cut: int


class SnapshotData(NamedTuple):
    """Everything that goes into the database. date: newest day of the data. sources: repository → commit."""

    date: str
    sources: dict[str, str]
    distros: Sequence[DistroRow]
    histories: Mapping[str, DistroHistory]
    syncs: Sequence[Sync]
    rules: Sequence[RuleEvent]
    manifests: Sequence[DeclaredVersion]


class _Ids:
    """Small numbers for repeated texts, in order of first use."""

    def __init__(self) -> None:
        self.of: dict[str, int] = {}

    def __getitem__(self, text: str) -> int:
        return self.of.setdefault(text, len(self.of) + 1)

    def list_rows(self) -> list[tuple[int, str]]:
        return [(number, text) for text, number in self.of.items()]


def build_database(data: SnapshotData) -> bytes:
    """The SQLite database as bytes; the same facts give the same bytes with the same SQLite."""
    handle, name = tempfile.mkstemp(suffix=".sqlite")
    os.close(handle)
    try:
        connection = sqlite3.connect(name)
        try:
            connection.execute("PRAGMA journal_mode=OFF")
            connection.executescript(SCHEMA)
            _fill(connection, data)
            connection.commit()
            connection.execute("VACUUM")
        finally:
            connection.close()
        return Path(name).read_bytes()
    finally:
        os.unlink(name)


def _fill(connection: sqlite3.Connection, data: SnapshotData) -> None:
    many = connection.executemany
    many("INSERT INTO meta VALUES(?, ?)", [("date", data.date), *sorted(data.sources.items())])
    distros = {row.name: number for number, row in enumerate(sorted(data.distros), 1)}
    many("INSERT INTO distro VALUES(?, ?, ?, ?, ?)", [(distros[row.name], *row) for row in sorted(data.distros)])
    many("INSERT OR REPLACE INTO sync VALUES(?, ?, ?)", [(distros[s.distro], s.day, s.cut) for s in data.syncs])
    repositories, packages, urls, sets, dependencies = _Ids(), _Ids(), _Ids(), _Ids(), _Ids()
    homes: set[tuple[int, int, int]] = set()
    for name in sorted(data.histories):
        _fill_history(connection, distros[name], data.histories[name], (repositories, packages, urls, sets), homes)
    many("INSERT INTO home VALUES(?, ?, ?)", sorted(homes))
    many(
        "INSERT OR REPLACE INTO manifest VALUES(?, ?, ?, ?, ?)",
        [
            (distros[item.distro], packages[item.package], item.version, dependencies[item.entries], item.build_type)
            for item in data.manifests
            if item.distro in distros
        ],
    )
    many("INSERT OR REPLACE INTO rule VALUES(?, ?, ?, ?)", [(r.key, r.os, r.ts, r.rule) for r in data.rules])
    for table, ids in (
        ("repository", repositories),
        ("package", packages),
        ("url", urls),
        ("packages", sets),
        ("dependencies", dependencies),
    ):
        many(f"INSERT INTO {table} VALUES(?, ?)", ids.list_rows())


def _fill_history(
    connection: sqlite3.Connection,
    distro: int,
    history: DistroHistory,
    ids: tuple[_Ids, _Ids, _Ids, _Ids],
    homes: set[tuple[int, int, int]],
) -> None:
    repositories, packages, urls, sets = ids
    connection.executemany(
        "INSERT OR REPLACE INTO platforms VALUES(?, ?, ?)",
        [(distro, event.ts, ",".join(event.names)) for event in history.platforms],
    )
    releases: dict[str, tuple[str | None, tuple[str, ...]]] = {}
    sources: dict[str, tuple[str, str, str]] = {}
    for event in history.events:
        entry, repository = event.entry, repositories[event.repository]
        release = (entry.version, entry.packages) if entry else (None, ())
        if releases.get(event.repository, (None, ())) != release:
            releases[event.repository] = release
            names = sets[" ".join(release[1])] if release[0] is not None else None
            connection.execute(
                "INSERT OR REPLACE INTO release VALUES(?, ?, ?, ?, ?)",
                (distro, repository, event.ts, release[0], names),
            )
            homes.update((packages[name], distro, repository) for name in release[1])
        source = (entry.url, entry.branch, entry.status) if entry else ("", "", "")
        if sources.get(event.repository, ("", "", "")) != source:
            sources[event.repository] = source
            connection.execute(
                "INSERT OR REPLACE INTO source VALUES(?, ?, ?, ?, ?, ?)",
                (
                    distro,
                    repository,
                    event.ts,
                    urls[source[0]] if source[0] else None,
                    source[1] or None,
                    source[2] or None,
                ),
            )


def write_snapshot(raw: bytes, date: str, sources: dict[str, str], folder: Path) -> int:
    """Writes FILES into a data folder; gives the compressed size in bytes."""
    import zstandard

    # A long window finds the repeats between far-apart tables; decompression then needs 64 MB at most.
    parameters = zstandard.ZstdCompressionParameters.from_level(19, window_log=26, enable_ldm=True)
    packed = zstandard.ZstdCompressor(compression_params=parameters).compress(raw)
    info = SnapshotInfo(date, hashlib.sha256(raw).hexdigest(), dict(sorted(sources.items())))
    for name, data in zip(FILES, (packed, msgspec.json.encode(info) + b"\n"), strict=True):
        write_file(folder / name, data)
    return len(packed)
