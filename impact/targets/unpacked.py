"""A shipped SQLite file and the reviewed facts beside it: unpacked once into the user's cache, then only read.

The unpacked file's name says what is in it, `KIND-FORMAT-HASH-HASH.sqlite`, so that new data never meets an old file.
"""

import contextlib
import hashlib
import os
import sqlite3
import time
from collections.abc import Callable
from pathlib import Path

from ...edges.console import UserError
from ..cache import CACHE_VARIABLE

_STALE = 3600


class SnapshotError(UserError):
    """The shipped snapshot cannot be read; the message says what to do."""


def decompress(packed: Path, sha256: str, described: str) -> bytes:
    """What a `.zst` file holds. described: the file beside it that gave the hash.

    Raises SnapshotError when it is missing or damaged.
    """
    import zstandard

    try:
        raw = zstandard.ZstdDecompressor().decompress(packed.read_bytes())
    except (OSError, zstandard.ZstdError) as error:
        raise SnapshotError(f"{packed}: {error}; install rosimpact again") from None
    if hashlib.sha256(raw).hexdigest() != sha256:
        raise SnapshotError(f"{packed}: does not match {described}; install rosimpact again")
    return raw


def connect(path: Path, table: str) -> sqlite3.Connection | None:
    """Opens a finished file; None when there is none or it is not whole. table: one that the facts fill."""
    if not path.is_file():
        return None
    try:
        return _connect(path, table)
    except sqlite3.DatabaseError:
        return None


def of_this_process(
    connection: sqlite3.Connection | None, opener: int, open: Callable[[], sqlite3.Connection]
) -> tuple[sqlite3.Connection, int]:
    """A connection to read with, and the process that opened it: those given, or one just opened.

    In a forked process a file is opened anew: with its parent's connection both would move each other's place in it.
    A database in memory is a copy.
    """
    here = os.getpid()
    if connection is None or (here != opener and connection.execute("PRAGMA database_list").fetchone()[2]):
        connection = open()
    return connection, here


def unpack(raw: bytes, add_facts: Callable[[sqlite3.Connection], None], path: Path, table: str) -> sqlite3.Connection:
    """Makes the file from the database's bytes and opens it; in memory where it cannot be written."""
    try:
        _write(raw, add_facts, path)
        return _connect(path, table)
    except (OSError, sqlite3.DatabaseError):
        return _in_memory(raw, add_facts)


def _connect(path: Path, table: str) -> sqlite3.Connection:
    connection = sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro&immutable=1", uri=True, check_same_thread=False)
    try:
        (pages,) = connection.execute("PRAGMA page_count").fetchone()
        (size,) = connection.execute("PRAGMA page_size").fetchone()
        connection.execute(f"SELECT * FROM {table} LIMIT 1").fetchone()
        if pages * size != path.stat().st_size:
            raise sqlite3.DatabaseError("truncated")
    except BaseException:
        connection.close()
        raise
    return connection


def _write(raw: bytes, add_facts: Callable[[sqlite3.Connection], None], path: Path) -> None:
    """Makes the unpacked file under another name and renames it, so that nobody ever sees half of it."""
    import tempfile

    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(prefix=f".{_kind(path)}-", suffix=".part", dir=path.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(raw)
        with contextlib.closing(sqlite3.connect(name)) as connection:
            # A crash leaves only a .part file, so no journal is needed.
            connection.execute("PRAGMA journal_mode=OFF")
            add_facts(connection)
        os.replace(name, path)
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(name)
        raise
    _forget_old(path)


def _kind(path: Path) -> str:
    return path.name.partition("-")[0]


def _forget_old(path: Path) -> None:
    """Removes databases of earlier versions of the data, and what runs killed an hour ago or more left behind.

    Another run may still read an old database, which Unix allows.
    """
    for old in path.parent.glob(f"{_kind(path)}-*.sqlite"):
        if old.name != path.name:
            with contextlib.suppress(OSError):
                old.unlink()
    for part in path.parent.glob(f".{_kind(path)}-*.part"):
        with contextlib.suppress(OSError):
            if part.stat().st_mtime < time.time() - _STALE:
                part.unlink()


def _deserializer(connection: sqlite3.Connection) -> Callable[[bytes], None] | None:
    """What opens bytes as a database; only Python 3.11 and newer have it."""
    return getattr(connection, "deserialize", None)


def _in_memory(raw: bytes, add_facts: Callable[[sqlite3.Connection], None]) -> sqlite3.Connection:
    connection = sqlite3.connect(":memory:", check_same_thread=False)
    deserialize = _deserializer(connection)
    if deserialize is not None:
        deserialize(raw)
    else:
        import tempfile

        try:
            with tempfile.NamedTemporaryFile(suffix=".sqlite") as file:
                file.write(raw)
                file.flush()
                with contextlib.closing(sqlite3.connect(file.name)) as disk:
                    disk.backup(connection)
        except OSError as error:
            raise SnapshotError(f"no folder to unpack the shipped data into ({error}); set {CACHE_VARIABLE}") from None
    add_facts(connection)
    return connection
