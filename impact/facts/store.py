"""Facts by content: an SQLite file in the user's cache, shared by all workspaces and safe to delete at any time.

A row is what one version of one extractor made of one content. `memo` rows are dear joins, by whatever key their maker
chose. Losing any of it costs time and nothing else, so no fault of the disk stops a run: what cannot be written is kept
in memory and what cannot be read is made again; `notes` says so in one line each.

Every row carries a digest of its key and data, and one that does not match counts as lost: whatever happened to the
file, what comes out is what went in. This protects from damage, not from a person who may write into the user's cache
folder and makes rows with digests of their own: such a person can make a run answer wrongly. They still cannot make
it execute anything, since rows are plain data of declared types.
"""

from __future__ import annotations

import contextlib
import errno
import fcntl
import hashlib
import os
import sqlite3
import stat
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache
from typing import Any

import msgspec

from ...edges.console import escape
from ...edges.files import NOT_REGULAR
from ...edges.limits import get_limits
from ..cache import cache_folder

_SCHEMA_VERSION = 3
_TABLES = ("facts", "memo")
# used: the day of its last use, since 1970; seal: see _compute_seal()
_COLUMNS = (
    "id INTEGER PRIMARY KEY, key BLOB NOT NULL UNIQUE, used INTEGER NOT NULL, seal BLOB NOT NULL, data BLOB NOT NULL"
)
_SCHEMA = "".join(f"CREATE TABLE IF NOT EXISTS {table} ({_COLUMNS});" for table in _TABLES)
# What SQLite says of its tables when they are ours, and when they are none.
_LAYOUT = {(b"table", table.encode(), f"CREATE TABLE {table} ({_COLUMNS})".encode()) for table in _TABLES}
_FILES = ("", "-wal", "-shm", "-journal")
LIMIT_BYTES = 1_000_000_000
_BUSY_MS = 5_000
_LOCK_SECONDS = 2
# A store that is damaged again and again is done without.
_RESTARTS = 2
# SQLite before 3.32 takes at most 999 variables
_AT_ONCE = 900
_DAY = 86_400
# Below this, packing takes longer than reading the bytes it saves.
_PACK_FROM = 2_000


def make_fact_key(content_id: str, extractor: str) -> bytes:
    """The key of the facts that an extractor makes of a content (40 hex digits). extractor: its name and version."""
    return bytes.fromhex(content_id) + extractor.encode()


def pack(data: bytes) -> bytes:
    """Bytes as they are stored: packed at the fastest level when that is worth it. Called by the workers."""
    if len(data) >= _PACK_FROM:
        packed = _make_packer().compress(data)
        if len(packed) < len(data):
            return b"z" + packed
    return b"-" + data


@cache
def _make_packer() -> Any:
    import zstandard  # late: most runs on unchanged files need none

    return zstandard.ZstdCompressor(level=1)


def unpack(data: bytes) -> bytes:
    """Undoes pack(). Raises ValueError when the bytes are not what pack() makes."""
    if data[:1] == b"-":
        return data[1:]
    if data[:1] != b"z":
        raise ValueError("not packed by this version")
    import zstandard

    frame = memoryview(data)[1:]
    try:
        if not 0 <= zstandard.frame_content_size(frame) <= get_limits().row:
            raise ValueError("of no known size, or larger than a row may be")
        return zstandard.ZstdDecompressor().decompress(frame)
    except zstandard.ZstdError as error:
        raise ValueError(str(error)) from None


def encode_rows(rows: Iterable[tuple[bytes, Any]]) -> Iterator[tuple[bytes, bytes]]:
    """(key, value) as (key, msgpack), for remember(). Values that hold a name of bytes that are no UTF-8 are left out,
    since msgpack cannot carry them: they are made again by every run."""
    for key, value in rows:
        with contextlib.suppress(UnicodeEncodeError):
            yield key, msgspec.msgpack.encode(value)


def recall(store: Store | None, table: str, key: bytes, type_: Any, make: Callable[[], Any]) -> Any:
    """What was remembered under a key, as a value of a type; else, or where it is of another version, made anew and
    remembered."""
    data = store.find_memo(table, key) if store is not None else None
    if data is not None:
        with contextlib.suppress(msgspec.MsgspecError):
            return msgspec.msgpack.decode(data, type=type_)
    made = make()
    if store is not None:
        store.remember(table, encode_rows([(key, made)]))
    return made


def _compute_seal(table: str, key: bytes, data: bytes) -> bytes:
    """What is stored beside a row, and matches nothing but this row."""
    digest = hashlib.blake2b(key, digest_size=16, person=table.encode(), usedforsecurity=False)
    digest.update(data)
    return digest.digest()


FAULTS = (sqlite3.Error, UnicodeDecodeError)
"""What a statement raises on a damaged file: some messages of SQLite quote the file, and Python cannot decode them."""


class _Newer(Exception):
    """The file was made by a newer version of rosimpact, which goes on using it."""


class _Older(sqlite3.DatabaseError):
    """The file was made by an older version of rosimpact, so that nothing in it is of use."""


class Store:
    """An open store. Use as a context manager, or close() it.

    folder: where the file lies, cache_folder() when None. limit: bytes above which what was not used for longest is
    dropped, when the store is closed. notes: one line for each thing that went wrong and was got around.
    One Store belongs to one thread; any number of processes may have the same file open.
    """

    def __init__(self, folder: str | os.PathLike[str] | None = None, limit: int = LIMIT_BYTES):
        self.folder = os.fspath(cache_folder() if folder is None else folder)
        self.path = os.path.join(self.folder, "facts.sqlite")
        self.limit = limit
        self.notes: list[str] = []
        self._memory: dict[str, dict[bytes, bytes]] = {table: {} for table in _TABLES}
        self._db: sqlite3.Connection | None = None
        self._opened = False
        self._writable = True
        self._wrote = False
        self._touch = False
        self._restarts = 0
        self._file: tuple[int, int] | None = None

    def __enter__(self) -> Store:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def find(self, keys: Iterable[bytes]) -> set[bytes]:
        """Those of the keys that have facts, without loading them."""
        return self._find("facts", list(keys))

    def get(self, keys: Iterable[bytes]) -> Iterator[tuple[bytes, bytes]]:
        """(key, packed facts) of those that are there, in no order."""
        return self._get("facts", list(keys))

    def put(self, rows: Iterable[tuple[bytes, bytes]]) -> None:
        """Stores (key, packed facts) at once: all are there for every other process when this returns."""
        self._put("facts", list(rows))

    def find_memo(self, table: str, key: bytes) -> bytes | None:
        """What was remembered under a key, unpacked; None when nothing was."""
        for _, data in self._get("memo", [_make_memo_key(table, key)]):
            with contextlib.suppress(ValueError):
                return unpack(data)
        return None

    def find_memos(self, table: str, keys: Iterable[bytes]) -> dict[bytes, bytes]:
        """The same for many keys; those that are not there are left out."""
        prefix = len(_make_memo_key(table, b""))
        found = {}
        for key, data in self._get("memo", [_make_memo_key(table, key) for key in keys]):
            with contextlib.suppress(ValueError):
                found[key[prefix:]] = unpack(data)
        return found

    def remember(self, table: str, rows: Iterable[tuple[bytes, bytes]]) -> None:
        """Remembers (key, bytes) for later runs. The bytes are packed here."""
        self._put("memo", [(_make_memo_key(table, key), pack(data)) for key, data in rows])

    def close(self) -> None:
        """Drops what exceeds the limit and lets go of the file. The store can be used again; it opens itself."""
        if self._db is not None:
            try:
                if self._wrote and self._writable:
                    self._trim(self._db)
                self._db.close()
            except FAULTS:
                with contextlib.suppress(*FAULTS):
                    self._db.close()
        self._db = None
        self._opened = False
        self._wrote = False

    def _open(self) -> sqlite3.Connection | None:
        if self._opened:
            return self._db
        self._opened = True
        while self._db is None:
            try:
                self._db = self._connect()
            except _Newer as error:
                self._give_up_writing("used", error)
                break
            except OSError as error:
                self._give_up_writing("opened", error)
                break
            except FAULTS as error:
                if _is_of_the_disk(error):
                    self._give_up_writing("opened", error)
                    self._db = self._connect_to_read()
                    break
                if not self._start_anew(error):
                    self._give_up_writing("read", error)
                    break
        return self._db

    def _connect(self) -> sqlite3.Connection:
        os.makedirs(self.folder, exist_ok=True)
        with self._lock_folder(fcntl.LOCK_SH):
            self._check_files()
            db = sqlite3.connect(self.path, timeout=_BUSY_MS / 1000, isolation_level=None)
            try:
                self._file = self._find_identity()
                self._prepare(db)
            except BaseException:
                db.close()
                raise
        return db

    def _prepare(self, db: sqlite3.Connection) -> None:
        """Makes an open file one of ours. Raises _Newer, and sqlite3.Error where it cannot be."""
        db.text_factory = bytes  # where a damaged file says text there may be anything
        version = db.execute("PRAGMA user_version").fetchone()[0]
        if version > _SCHEMA_VERSION:
            raise _Newer(f"made by a newer rosimpact, layout {version}")
        if 0 < version < _SCHEMA_VERSION:
            raise _Older
        # Readers then never wait for a writer. Where it cannot be had (network folders), the default works too.
        with contextlib.suppress(sqlite3.OperationalError):
            if version != _SCHEMA_VERSION:
                db.execute("PRAGMA auto_vacuum = INCREMENTAL")
            db.execute("PRAGMA journal_mode = WAL")
        # Only a crash of the machine can lose or damage rows then, and damage is found and mended.
        db.execute("PRAGMA synchronous = OFF")
        if version != _SCHEMA_VERSION:
            db.executescript(f"BEGIN IMMEDIATE; {_SCHEMA} PRAGMA user_version = {_SCHEMA_VERSION}; COMMIT;")
        _check_layout(db)
        # rows are stamped as used only once dropping some is in sight, so that a warm run writes nothing
        self._touch = self._measure_size(db) > self.limit // 2

    def _connect_to_read(self) -> sqlite3.Connection | None:
        """A connection that only reads, for a cache folder that cannot be written; None when that fails too."""
        if not os.path.exists(self.path):
            return None
        from urllib.parse import quote

        for mode in ("mode=ro", "immutable=1"):
            try:
                db = sqlite3.connect(f"file:{quote(self.path)}?{mode}", uri=True, timeout=1, isolation_level=None)
            except FAULTS:
                continue
            try:
                db.text_factory = bytes
                if db.execute("PRAGMA user_version").fetchone()[0] == _SCHEMA_VERSION:
                    _check_layout(db)
                    return db
            except FAULTS:
                pass
            db.close()
        return None

    @contextlib.contextmanager
    def _lock_folder(self, kind: int) -> Iterator[None]:
        """Holds the folder, so that no process begins to use a file while another takes it away. Whoever cannot have
        the lock goes on without: what then may get lost are rows."""
        # The lock is on the folder, since closing a descriptor of the file would end SQLite's own locks.
        try:
            folder = os.open(self.folder, os.O_RDONLY | os.O_CLOEXEC | os.O_DIRECTORY)
        except OSError:
            yield
            return
        try:
            until = time.monotonic() + _LOCK_SECONDS
            while True:
                try:
                    fcntl.flock(folder, kind | fcntl.LOCK_NB)
                    break
                except BlockingIOError:
                    if time.monotonic() > until:
                        break
                    time.sleep(0.005)
                except OSError:  # a file system without locks
                    break
            yield
        finally:
            os.close(folder)

    def _check_files(self) -> None:
        """Raises OSError where SQLite would open anything but regular files: it would wait for a named pipe, and write
        through a link into what is not ours."""
        for suffix in _FILES:
            try:
                mode = os.lstat(self.path + suffix).st_mode
            except FileNotFoundError:
                continue
            if not stat.S_ISREG(mode):
                what = "is a link" if stat.S_ISLNK(mode) else NOT_REGULAR
                name = os.path.basename(self.path + suffix)
                raise OSError(errno.EINVAL, f"{what}: remove `{name}`", self.path + suffix)

    def _find_identity(self) -> tuple[int, int] | None:
        """What tells the file from another of the same name; None when there is none."""
        try:
            status = os.lstat(self.path)
        except OSError:
            return None
        return status.st_dev, status.st_ino

    def _give_up_writing(self, what: str, error: Exception) -> None:
        if self._writable:
            self._writable = False
            remedy = (
                "to another folder, or update rosimpact"
                if isinstance(error, _Newer)
                else "to a folder that can be written"
            )
            self.notes.append(
                f"the cache `{self.path}` cannot be {what} ({_format_error(error)}), so the next run starts from what "
                f"it holds now; set ROSIMPACT_CACHE {remedy}"
            )

    def _start_anew(self, error: Exception) -> bool:
        """Takes a damaged file away so that a new one can be made; False when that is not possible.

        Processes that still have it open keep it, with its log, until they close it: SQLite neither writes nor deletes
        a log once the file beside it is another one.
        """
        damaged = self._file
        self._close_connection()
        if self._restarts == _RESTARTS:
            return False
        self._restarts += 1
        try:
            with self._lock_folder(fcntl.LOCK_EX):
                if damaged is not None and self._find_identity() != damaged:
                    return True  # another process has done it meanwhile
                # The new file is there before the old one goes, so that it cannot get its number, by which others tell
                # them apart.
                fresh = self.path + ".new"
                with contextlib.suppress(FileNotFoundError):
                    os.remove(fresh)
                os.close(os.open(fresh, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o666))
                for suffix in _FILES[1:]:
                    with contextlib.suppress(FileNotFoundError):
                        os.remove(self.path + suffix)
                os.replace(fresh, self.path)
        except OSError:
            return False
        if not isinstance(error, _Older):
            self.notes.append(f"the cache `{self.path}` was damaged ({_format_error(error)}) and has been started anew")
        return True

    def _close_connection(self) -> None:
        if self._db is not None:
            with contextlib.suppress(*FAULTS):
                self._db.close()
        self._db = None
        self._file = None

    def _recover(self, error: Exception) -> None:
        """After an error of a statement: mends what can be mended, so that the next statement may work."""
        if self._writable and self._file is not None and self._find_identity() not in (self._file, None):
            # Another process started the file anew, and this one's is gone.
            self._close_connection()
            self._opened = self._restarts == _RESTARTS
            self._restarts += not self._opened
        elif _is_of_the_disk(error):
            self._give_up_writing("written", error)
        elif self._start_anew(error):
            self._opened = False
        else:
            self._give_up_writing("read", error)

    def _find(self, table: str, keys: Sequence[bytes]) -> set[bytes]:
        memory = self._memory[table]
        present = {key for key in keys if key in memory} if memory else set()
        db = self._open()
        if db is None:
            return present
        rows: list[tuple[int, bytes]] = []
        try:
            for part, marks in _split_values(keys):
                rows.extend(db.execute(f"SELECT id, key FROM {table} WHERE key IN ({marks})", part))
            self._use(db, table, [row[0] for row in rows])
        except FAULTS as error:
            self._recover(error)
        present.update(row[1] for row in rows)
        return present

    def _get(self, table: str, keys: Sequence[bytes]) -> Iterator[tuple[bytes, bytes]]:
        memory = self._memory[table]
        if memory:
            yield from ((key, memory[key]) for key in keys if key in memory)
            keys = [key for key in keys if key not in memory]
        for part, marks in _split_values(keys):
            db = self._open()
            if db is None:
                return
            try:
                rows = db.execute(f"SELECT id, key, seal, data FROM {table} WHERE key IN ({marks})", part).fetchall()
                self._use(db, table, [row[0] for row in rows])
            except FAULTS as error:
                self._recover(error)
                continue
            for _, key, seal, data in rows:
                if isinstance(key, bytes) and isinstance(data, bytes) and seal == _compute_seal(table, key, data):
                    yield key, data

    def _use(self, db: sqlite3.Connection, table: str, ids: Sequence[int]) -> None:
        if not self._touch or not self._writable:
            return
        today = int(time.time()) // _DAY
        for part, marks in _split_values(ids):
            with contextlib.suppress(sqlite3.OperationalError):
                db.execute(f"UPDATE {table} SET used = {today} WHERE used < {today} AND id IN ({marks})", part)

    def _put(self, table: str, rows: list[tuple[bytes, bytes]]) -> None:
        largest = get_limits().row
        self._memory[table].update((key, data) for key, data in rows if len(data) > largest)
        rows = [(key, data) for key, data in rows if len(data) <= largest]
        if not rows:
            return
        sealed = [(key, _compute_seal(table, key, data), data) for key, data in rows]
        for _ in (1, 2):  # the second time on a file that has been started anew
            db = self._open()
            if db is None or not self._writable:
                break
            today = int(time.time()) // _DAY
            try:
                db.execute("BEGIN IMMEDIATE")
                db.executemany(
                    f"INSERT OR REPLACE INTO {table} (key, used, seal, data) VALUES (?, {today}, ?, ?)", sealed
                )
                db.execute("COMMIT")
                self._wrote = True
                return
            except FAULTS as error:
                with contextlib.suppress(*FAULTS):
                    if db.in_transaction:
                        db.execute("ROLLBACK")
                self._recover(error)
        self._memory[table].update(rows)

    def _measure_size(self, db: sqlite3.Connection) -> int:
        pages = db.execute("PRAGMA page_count").fetchone()[0] - db.execute("PRAGMA freelist_count").fetchone()[0]
        return pages * db.execute("PRAGMA page_size").fetchone()[0]

    def _trim(self, db: sqlite3.Connection) -> None:
        """Above the limit, drops the rows not used for longest until three quarters of it are left."""
        size = self._measure_size(db)
        if size <= self.limit:
            return
        surplus = size - self.limit * 3 // 4
        today = int(time.time()) // _DAY  # what was used later was used by a clock that went wrong
        rows = [
            (used, row, length, table)
            for table in _TABLES
            for row, used, length in db.execute(
                f"SELECT id, CASE WHEN used BETWEEN 0 AND {today} THEN used ELSE 0 END, length(data) + 96 FROM {table}"
            )
        ]
        rows.sort()
        surplus *= sum(length for _, _, length, _ in rows) / size  # pages are not filled to the last byte
        doomed: dict[str, list[int]] = {table: [] for table in _TABLES}
        for _, row, length, table in rows:
            if surplus <= 0:
                break
            surplus -= length
            doomed[table].append(row)
        for table, ids in doomed.items():
            db.execute("BEGIN IMMEDIATE")
            for part, marks in _split_values(ids):
                db.execute(f"DELETE FROM {table} WHERE id IN ({marks})", part)
            db.execute("COMMIT")
        db.executescript("PRAGMA incremental_vacuum;")  # execute() would free one page only


# Faults of the disk or of other users of the file, by SQLite's words (Python 3.10 does not give the codes). Everything
# else means that the file is not what this version wrote.
_DISK = ("locked", "disk I/O", "disk is full", "readonly", "unable to open", "out of memory", "interrupted")


def _is_of_the_disk(error: Exception) -> bool:
    return isinstance(error, sqlite3.OperationalError) and any(words in str(error) for words in _DISK)


def _check_layout(db: sqlite3.Connection) -> None:
    """Raises sqlite3.DatabaseError unless a file has our tables and nothing else."""
    if set(db.execute("SELECT type, name, sql FROM sqlite_master WHERE sql IS NOT NULL")) != _LAYOUT:
        raise sqlite3.DatabaseError("its tables are not those of rosimpact")


def _make_memo_key(table: str, key: bytes) -> bytes:
    return table.encode() + b"\0" + key


def _split_values(values: Sequence) -> Iterator[tuple[Sequence, str]]:
    """Values in pieces that fit one statement, each with its question marks."""
    for start in range(0, len(values), _AT_ONCE):
        part = values[start : start + _AT_ONCE]
        yield part, ",".join("?" * len(part))


def _format_error(error: Exception) -> str:
    if isinstance(error, OSError):
        return (error.strerror or type(error).__name__).lower()
    if isinstance(error, UnicodeDecodeError):
        return "malformed database schema"
    return escape(str(error))[:200] or type(error).__name__
