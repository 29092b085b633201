"""The shipped snapshot of distro data: unpacked once into the user's cache, then read as SQLite.

What is shipped: `data/distros.sqlite.zst` (its tables: databuild/write.py), `data/snapshot.json` (its date and content
hash) and the reviewed fact files `data/platform_versions.yaml` and `data/distros.yaml`, which are loaded into the same
database when it is unpacked. The unpacked file is named after the content of all three, so a new version of the data
never meets an old file. A file that turns out broken is unpacked again; where no folder can be written the database
lives in memory.
"""

import contextlib
import datetime
import os
import sqlite3
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import msgspec

from ...edges.files import read_file
from ...edges.limits import get_limits
from ...edges.memory import cache_method
from .tables import find_data_folder, find_updated_folder, suggest_repair
from .unpacked import AddFacts, ShippedDatabase, SnapshotError

FACT_SCHEMA = """
CREATE TABLE library(platform TEXT, name TEXT, version TEXT, source TEXT, PRIMARY KEY(platform, name)) WITHOUT ROWID;
CREATE TABLE source_note(id TEXT PRIMARY KEY, text TEXT) WITHOUT ROWID;
CREATE TABLE distro_fact(name TEXT PRIMARY KEY, facts TEXT) WITHOUT ROWID;
"""
"""Tables filled from the reviewed fact files while unpacking. distro_fact.facts is JSON (see data/distros.yaml)."""

KINDS = {
    "b": "build",
    "e": "build_export",
    "t": "buildtool",
    "o": "buildtool_export",
    "x": "exec",
    "s": "test",
    "d": "doc",
    "c": "conflict",
    "r": "replace",
    "g": "group",
    "m": "member_of_group",
}
"""One letter for each kind of dependency, as stored in dependencies.entries."""


class SnapshotInfo(msgspec.Struct, frozen=True):
    """What `snapshot.json` says: newest day of the data, SHA-256 of the unpacked database, and where it came from."""

    date: str
    sha256: str
    sources: dict[str, str] = {}


def read_shipped(data: Path) -> SnapshotInfo:
    """Date and content hash of the snapshot in a data folder.

    Raises SnapshotError when it is missing or damaged.
    """
    try:
        info = msgspec.json.decode(read_file(data / "snapshot.json", get_limits().settings), type=SnapshotInfo)
        datetime.date.fromisoformat(info.date)
        int(info.sha256, 16)
        return info
    except (OSError, ValueError, RecursionError) as error:
        raise SnapshotError(f"{data / 'snapshot.json'}: {error}; {suggest_repair()}") from None


def add_facts(connection: sqlite3.Connection, platforms: bytes, distros: bytes) -> None:
    """Loads the two reviewed fact files (YAML) into the database."""
    import yaml

    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    table = yaml.load(platforms, Loader=loader)
    connection.executescript(FACT_SCHEMA)
    connection.executemany("INSERT INTO source_note VALUES(?, ?)", table["sources"].items())
    connection.executemany(
        "INSERT INTO library VALUES(?, ?, ?, ?)",
        (
            (platform, name, str(cell["version"]), cell["source"])
            for platform, cells in table["platforms"].items()
            for name, cell in cells.items()
        ),
    )
    facts = yaml.load(distros, Loader=loader)
    connection.executemany(
        "INSERT INTO distro_fact VALUES(?, ?)",
        ((name, msgspec.json.encode(value).decode()) for name, value in facts["distros"].items()),
    )
    connection.commit()


class Snapshot(ShippedDatabase):
    """Read access to the database. Open one with `default()`, or `Snapshot(folder)` for another data folder."""

    kind, info_file, table = "distros", "snapshot.json", "distro_fact"
    fact_files = ("platform_versions.yaml", "distros.yaml")
    fill = staticmethod(add_facts)

    def __init__(self, data: Path | None = None, cache: Path | None = None, facts: Path | None = None):
        super().__init__(data or find_data_folder(), cache, facts or find_data_folder())
        self._info: SnapshotInfo | None = None

    @property
    def info(self) -> SnapshotInfo:
        if self._info is None:
            self._info = read_shipped(self.data)
        return self._info

    @property
    def date(self) -> str:
        """Newest day of the data (ISO)."""
        return self.info.date

    def query_row(self, sql: str, parameters: Iterable[Any] = ()) -> tuple | None:
        """The first row of a query, None when there is none."""
        found = self.fetch(sql, parameters)
        return found[0] if found else None

    @cache_method
    def list_values(self, table: str, column: str = "name") -> frozenset[str]:
        """All values of a column; read once, since every target asks the same."""
        return frozenset(value for (value,) in self.fetch(f"SELECT DISTINCT {column} FROM {table}"))

    def _read_sha256(self) -> str:
        return self.info.sha256

    def _read_contents(self) -> tuple[bytes, AddFacts]:
        try:
            return super()._read_contents()
        except SnapshotError:
            if self.data != find_updated_folder():
                raise
            # What an update left broken is passed over; the other data are always there.
            self.data, self._info = find_data_folder(), None
            return super()._read_contents()


_default: Snapshot | None = None


def load_snapshot() -> Snapshot:
    """The shipped snapshot, one for each process."""
    global _default
    if _default is None:
        _default = Snapshot(_find_newest_folder())
    return _default


def _find_newest_folder() -> Path:
    """The data folder in use, or the snapshot that `data update` made where that is newer and whole."""
    updated, other = find_updated_folder(), find_data_folder()
    if os.path.exists(updated / "snapshot.json"):
        with contextlib.suppress(SnapshotError):
            if read_shipped(updated).date > read_shipped(other).date and os.path.isfile(updated / "distros.sqlite.zst"):
                return updated
    return other
