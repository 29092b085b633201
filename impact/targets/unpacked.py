"""A shipped SQLite file and the reviewed facts beside it: unpacked once into the user's cache, then only read.

The unpacked file's name says what is in it, `KIND-FORMAT-HASH-HASH.sqlite`, so that new data never meets an old file.
A file beside it, `….sqlite.sum`, has the digest of what was unpacked and the file's size, times and inode. While those
are the same the file is taken as it is; otherwise it is read once and compared, and unpacked again when it differs.
"""

import contextlib
import hashlib
import os
import sqlite3
import stat
import threading
import time
from collections.abc import Callable, Iterable
from functools import cache
from pathlib import Path
from typing import Annotated, Any, ClassVar, TypeVar

import msgspec

from ...edges.console import UserError
from ...edges.files import read_chunks, read_file, read_with_status, write_file
from ..cache import CACHE_VARIABLE, cache_folder
from ..facts.store import FAULTS
from .tables import LARGEST, suggest_repair

T = TypeVar("T")
_STALE = 3600
_SUM = ".sum"
_SUM_BYTES = 1000
# A change within this time of another may leave a file's times as they were.
_TICK_NS = 20_000_000
# Of a packed table; the largest has 12 MB when it is unpacked.
_UNPACKED_BYTES = 256 << 20


class SnapshotError(UserError):
    """The shipped snapshot cannot be read; the message says what to do."""


def read_table(path: Path, kind: type[T]) -> T:
    """What a shipped file of JSON holds, packed (`.zst`) or not. Raises SnapshotError when it is missing or damaged."""
    import zstandard

    try:
        raw = read_file(path, LARGEST)
        raw = _decompress_bounded(raw) if path.suffix == ".zst" else raw
        return msgspec.json.decode(raw, type=kind)
    except (OSError, ValueError, RecursionError, zstandard.ZstdError) as error:
        raise SnapshotError(f"{path}: {error}; {suggest_repair()}") from None


def _decompress_bounded(data: bytes) -> bytes:
    """What a frame holds. Raises ZstdError, ValueError where it claims too much."""
    import zstandard

    # Memory for all that a frame says to hold is taken before the first byte is unpacked.
    if zstandard.frame_content_size(data) > _UNPACKED_BYTES:
        raise ValueError("claims to hold too much")
    return zstandard.ZstdDecompressor().decompress(data, max_output_size=_UNPACKED_BYTES)


@cache
def make_decoder(kind: Any) -> Callable[[bytes | msgspec.Raw], Any]:
    """What reads MessagePack as a type."""
    return msgspec.msgpack.Decoder(kind).decode


def read_packed(data: bytes, kind: Any) -> Any:
    """What databuild packed into a row, as MessagePack."""
    import zstandard

    return make_decoder(kind)(zstandard.ZstdDecompressor().decompress(data))


def decompress(packed: Path, sha256: str, described: str) -> bytes:
    """What a `.zst` file holds. described: the file beside it that gave the hash.

    Raises SnapshotError when it is missing or damaged.
    """
    import zstandard

    try:
        raw = _decompress_bounded(read_file(packed, LARGEST))
    except (OSError, ValueError, zstandard.ZstdError) as error:
        raise SnapshotError(f"{packed}: {error}; {suggest_repair()}") from None
    if hashlib.sha256(raw).hexdigest() != sha256:
        raise SnapshotError(f"{packed}: does not match {described}; {suggest_repair()}")
    return raw


class _Info(msgspec.Struct, frozen=True):
    sha256: Annotated[str, msgspec.Meta(pattern=r"\A[0-9a-f]{16,}\Z")]


# What adds the reviewed facts to a database.
AddFacts = Callable[[sqlite3.Connection], None]


class ShippedDatabase:
    """A shipped database that is opened when it is first read; one that breaks while it is read is unpacked again, in
    memory. data: its folder. cache: where to unpack it, by default the user's cache folder. facts: the folder of the
    reviewed facts. What cannot be read raises SnapshotError."""

    kind: str
    """How the names of its files begin."""
    info_file: str
    """What tells the hash of the database."""
    fact_files: tuple[str, ...]
    table: str
    """One that the facts fill."""
    fill: ClassVar[Callable[..., None]]
    """Adds what the files of reviewed facts hold to a connection."""
    form = 1

    def __init__(self, data: Path, cache: Path | None, facts: Path):
        self.data, self.facts, self._cache = data, facts, cache
        self._connection: sqlite3.Connection | None = None
        self._reader = 0  # the process that opened it
        self._lock = threading.Lock()

    def fetch(self, sql: str, parameters: Iterable[Any] = ()) -> list[tuple]:
        """All rows of a query."""
        arguments = tuple(parameters)
        with self._lock:
            connection = self._open()
            try:
                return connection.execute(sql, arguments).fetchall()
            except FAULTS:
                connection.close()
                # Later runs compare the file with what was unpacked, however whole it looks.
                with contextlib.suppress(OSError):
                    os.unlink(f"{self.get_path()}{_SUM}")
                self._connection = _open_in_memory(*self._read_contents())
                return self._connection.execute(sql, arguments).fetchall()

    def get_path(self) -> Path:
        """Where the unpacked file belongs in the cache."""
        facts = hashlib.sha256(b"\0".join(self._read_facts())).hexdigest()
        name = f"{self.kind}-{self.form}-{self._read_sha256()[:16]}-{facts[:16]}.sqlite"
        return (self._cache or cache_folder()) / name

    def unpack(self) -> bytes:
        """The database as bytes, decompressed and checked against its hash, before the reviewed facts are added."""
        return decompress(self.data / f"{self.kind}.sqlite.zst", self._read_sha256(), self.info_file)

    def _read_contents(self) -> tuple[bytes, AddFacts]:
        """What the file is made of: the database without the reviewed facts, and what adds them."""
        raw, facts = self.unpack(), self._read_facts()
        return raw, lambda connection: self.fill(connection, *facts)

    def _read_sha256(self) -> str:
        return read_table(self.data / self.info_file, _Info).sha256

    def _read_facts(self) -> list[bytes]:
        try:
            return [(self.facts / name).read_bytes() for name in self.fact_files]
        except OSError as error:
            raise SnapshotError(f"{error}; {suggest_repair()}") from None

    def _open(self) -> sqlite3.Connection:
        """A connection of this process. In a forked one a file is opened anew: with its parent's connection both would
        move each other's place in it. A database in memory is a copy."""
        here = os.getpid()
        known = self._connection
        if known is None or (here != self._reader and known.execute("PRAGMA database_list").fetchone()[2]):
            known = self._connection = self._open_whole() or self._unpack()
        self._reader = here
        return known

    def _open_whole(self) -> sqlite3.Connection | None:
        """The finished file; None when there is none or it is not whole."""
        path = self.get_path()
        try:
            return _connect(path, self.table) if _is_whole(path) else None
        except (OSError, *FAULTS):
            return None

    def _unpack(self) -> sqlite3.Connection:
        """Makes the file and opens it; in memory where it cannot be written."""
        raw, add_facts = self._read_contents()
        path = self.get_path()
        try:
            _write(raw, add_facts, path)
            return _connect(path, self.table)
        except (OSError, *FAULTS):
            return _open_in_memory(raw, add_facts)


def _is_whole(path: Path) -> bool:
    """Whether a file holds what was unpacked. Raises OSError."""
    status = os.stat(path)
    if not stat.S_ISREG(status.st_mode):
        return False
    data, noted = read_with_status(f"{path}{_SUM}", _SUM_BYTES)
    digest, _, stamp = data.decode("ascii", "replace").partition(" ")
    if stamp == _format_stamp(status) and noted.st_mtime_ns > status.st_ctime_ns + _TICK_NS:
        return True
    if _compute_digest(path) != digest:
        return False
    _note(path, digest)
    return True


def _format_stamp(status: os.stat_result) -> str:
    return f"{status.st_size} {status.st_mtime_ns} {status.st_ctime_ns} {status.st_ino}"


def _compute_digest(path: str | os.PathLike[str]) -> str:
    found = hashlib.blake2b(digest_size=16, usedforsecurity=False)
    for chunk in read_chunks(path):
        found.update(chunk)
    return found.hexdigest()


def _note(path: Path, digest: str) -> None:
    """Writes what is known of a file beside it; where that cannot be, every run compares."""
    with contextlib.suppress(OSError):
        write_file(f"{path}{_SUM}", f"{digest} {_format_stamp(os.stat(path))}".encode())


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


def _write(raw: bytes, add_facts: AddFacts, path: Path) -> None:
    """Makes the unpacked file under another name and renames it, so that nobody ever sees half of it."""
    import tempfile

    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(prefix=f".{_get_kind(path)}-", suffix=".part", dir=path.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(raw)
        with contextlib.closing(sqlite3.connect(name)) as connection:
            # A crash leaves only a .part file, so no journal is needed.
            connection.execute("PRAGMA journal_mode=OFF")
            add_facts(connection)
        digest = _compute_digest(name)
        os.replace(name, path)
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(name)
        raise
    _note(path, digest)
    _forget_old(path)


def _get_kind(path: Path) -> str:
    return path.name.partition("-")[0]


def _forget_old(path: Path) -> None:
    """Removes databases of earlier versions of the data, and what runs killed an hour ago or more left behind.

    Another run may still read an old database, which Unix allows.
    """
    for old in path.parent.glob(f"{_get_kind(path)}-*.sqlite"):
        if old.name != path.name:
            for each in (old, f"{old}{_SUM}"):
                with contextlib.suppress(OSError):
                    os.unlink(each)
    for part in path.parent.glob(f".{_get_kind(path)}-*.part"):
        with contextlib.suppress(OSError):
            if part.stat().st_mtime < time.time() - _STALE:
                part.unlink()


def _find_deserializer(connection: sqlite3.Connection) -> Callable[[bytes], None] | None:
    """What opens bytes as a database; only Python 3.11 and newer have it."""
    return getattr(connection, "deserialize", None)


def _open_in_memory(raw: bytes, add_facts: AddFacts) -> sqlite3.Connection:
    """The database in memory alone. Raises SnapshotError."""
    connection = sqlite3.connect(":memory:", check_same_thread=False)
    deserialize = _find_deserializer(connection)
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
