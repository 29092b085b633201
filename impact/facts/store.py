"""Facts by content: an SQLite file in the user's cache, shared by all workspaces and safe to delete at any time.

A row is what one version of one extractor made of one content. `memo` rows are dear joins, by whatever key their maker
chose. Losing any of it costs time and nothing else, so no fault of the disk stops a run: what cannot be written is kept
in memory and what cannot be read is made again; `notes` says so in one line each.
"""

from __future__ import annotations

import contextlib
import os
import sqlite3
import time
import zlib
from collections.abc import Iterable, Iterator, Sequence

from ..cache import cache_folder

_SCHEMA_VERSION = 1
_TABLES = ("facts", "memo")
# used: the day of its last use, since 1970
_COLUMNS = "id INTEGER PRIMARY KEY, key BLOB NOT NULL UNIQUE, used INTEGER NOT NULL, data BLOB NOT NULL"
_SCHEMA = "".join(f"CREATE TABLE IF NOT EXISTS {table} ({_COLUMNS});" for table in _TABLES)
LIMIT_BYTES = 1_000_000_000
_BUSY_MS = 5_000
# SQLite before 3.32 takes at most 999 variables
_AT_ONCE = 900
_DAY = 86_400
# Below this, deflating takes longer than reading the bytes it saves.
_PACK_FROM = 2_000


def fact_key(content_id: str, extractor: str) -> bytes:
    """The key of the facts that an extractor makes of a content (40 hex digits). extractor: its name and version."""
    return bytes.fromhex(content_id) + extractor.encode()


def pack(data: bytes) -> bytes:
    """Bytes as they are stored: deflated at the fastest level when that is worth it. Called by the workers."""
    if len(data) >= _PACK_FROM:
        packed = zlib.compress(data, 1)
        if len(packed) < len(data):
            return b"z" + packed
    return b"-" + data


def unpack(data: bytes) -> bytes:
    """Undoes pack(). Raises ValueError when the bytes are not what pack() makes."""
    if data[:1] == b"-":
        return data[1:]
    if data[:1] != b"z":
        raise ValueError("not packed by this version")
    try:
        return zlib.decompress(data[1:])
    except zlib.error as error:
        raise ValueError(str(error)) from None


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

    def memo(self, table: str, key: bytes) -> bytes | None:
        """What was remembered under a key, unpacked; None when nothing was."""
        for _, data in self._get("memo", [_memo_key(table, key)]):
            with contextlib.suppress(ValueError):
                return unpack(data)
        return None

    def memos(self, table: str, keys: Iterable[bytes]) -> dict[bytes, bytes]:
        """The same for many keys; those that are not there are left out."""
        prefix = len(_memo_key(table, b""))
        found = {}
        for key, data in self._get("memo", [_memo_key(table, key) for key in keys]):
            with contextlib.suppress(ValueError):
                found[key[prefix:]] = unpack(data)
        return found

    def remember(self, table: str, rows: Iterable[tuple[bytes, bytes]]) -> None:
        """Remembers (key, bytes) for later runs. The bytes are packed here."""
        self._put("memo", [(_memo_key(table, key), pack(data)) for key, data in rows])

    def close(self) -> None:
        """Drops what exceeds the limit and lets go of the file. The store can be used again; it opens itself."""
        if self._db is not None:
            try:
                if self._wrote and self._writable:
                    self._trim(self._db)
                self._db.close()
            except sqlite3.Error:
                with contextlib.suppress(sqlite3.Error):
                    self._db.close()
        self._db = None
        self._opened = False
        self._wrote = False

    def _open(self) -> sqlite3.Connection | None:
        if self._opened:
            return self._db
        self._opened = True
        for attempt in (1, 2):
            try:
                self._db = self._connect()
                break
            except OSError as error:
                self._give_up_writing("opened", error)
                break
            except sqlite3.Error as error:
                if _is_of_the_disk(error):
                    self._give_up_writing("opened", error)
                    self._db = self._connect_to_read()
                    break
                if attempt == 2 or not self._discard(error):
                    self._give_up_writing("opened", error)
                    break
        return self._db

    def _connect(self) -> sqlite3.Connection:
        os.makedirs(self.folder, exist_ok=True)
        db = sqlite3.connect(self.path, timeout=_BUSY_MS / 1000, isolation_level=None)
        try:
            version = db.execute("PRAGMA user_version").fetchone()[0]
            if version > _SCHEMA_VERSION:
                raise sqlite3.DatabaseError(f"made by a newer rosimpact (layout {version})")
            # Readers then never wait for a writer. Where it cannot be had (network folders), the default works too.
            with contextlib.suppress(sqlite3.OperationalError):
                if version != _SCHEMA_VERSION:
                    db.execute("PRAGMA auto_vacuum = INCREMENTAL")
                db.execute("PRAGMA journal_mode = WAL")
            # Only a crash of the machine can lose or damage rows then, and damage is found and mended.
            db.execute("PRAGMA synchronous = OFF")
            if version != _SCHEMA_VERSION:
                db.executescript(f"BEGIN IMMEDIATE; {_SCHEMA} PRAGMA user_version = {_SCHEMA_VERSION}; COMMIT;")
            # rows are stamped as used only once dropping some is in sight, so that a warm run writes nothing
            self._touch = self._bytes(db) > self.limit // 2
        except BaseException:
            db.close()
            raise
        return db

    def _connect_to_read(self) -> sqlite3.Connection | None:
        """A connection that only reads, for a cache folder that cannot be written; None when that fails too."""
        if not os.path.exists(self.path):
            return None
        from urllib.parse import quote

        for mode in ("mode=ro", "immutable=1"):
            try:
                db = sqlite3.connect(f"file:{quote(self.path)}?{mode}", uri=True, timeout=1, isolation_level=None)
            except sqlite3.Error:
                continue
            try:
                if db.execute("PRAGMA user_version").fetchone()[0] == _SCHEMA_VERSION:
                    db.execute("SELECT id FROM facts LIMIT 1").fetchone()
                    return db
            except sqlite3.Error:
                pass
            db.close()
        return None

    def _give_up_writing(self, what: str, error: Exception) -> None:
        if self._writable:
            self._writable = False
            self.notes.append(
                f"the cache `{self.path}` cannot be {what} ({_clause(error)}), so the next run starts from what "
                "it holds now; set ROSIMPACT_CACHE to a folder that can be written"
            )

    def _discard(self, error: Exception) -> bool:
        """Deletes a damaged file so that a new one can be made; False when that is not possible."""
        if self._db is not None:
            with contextlib.suppress(sqlite3.Error):
                self._db.close()
            self._db = None
        try:
            for suffix in ("", "-wal", "-shm", "-journal"):
                with contextlib.suppress(FileNotFoundError):
                    os.remove(self.path + suffix)
        except OSError:
            return False
        self.notes.append(f"the cache `{self.path}` was damaged ({_clause(error)}) and has been started anew")
        return True

    def _failed(self, error: sqlite3.Error) -> None:
        """After an error of a statement: mends what can be mended, so that the next statement may work."""
        if _is_of_the_disk(error):
            self._give_up_writing("written", error)
        elif self._discard(error):
            self._opened = False
        else:
            self._give_up_writing("read", error)
            self._db = None

    def _find(self, table: str, keys: Sequence[bytes]) -> set[bytes]:
        memory = self._memory[table]
        present = {key for key in keys if key in memory} if memory else set()
        db = self._open()
        if db is None:
            return present
        rows: list[tuple[int, bytes]] = []
        try:
            for part, marks in _parts(keys):
                rows.extend(db.execute(f"SELECT id, key FROM {table} WHERE key IN ({marks})", part))
            self._use(db, table, [row[0] for row in rows])
        except sqlite3.Error as error:
            self._failed(error)
        present.update(row[1] for row in rows)
        return present

    def _get(self, table: str, keys: Sequence[bytes]) -> Iterator[tuple[bytes, bytes]]:
        memory = self._memory[table]
        if memory:
            yield from ((key, memory[key]) for key in keys if key in memory)
            keys = [key for key in keys if key not in memory]
        for part, marks in _parts(keys):
            db = self._open()
            if db is None:
                return
            try:
                rows = db.execute(f"SELECT id, key, data FROM {table} WHERE key IN ({marks})", part).fetchall()
                self._use(db, table, [row[0] for row in rows])
            except sqlite3.Error as error:
                self._failed(error)
                continue
            for _, key, data in rows:
                yield key, data

    def _use(self, db: sqlite3.Connection, table: str, ids: Sequence[int]) -> None:
        if not self._touch or not self._writable:
            return
        today = int(time.time()) // _DAY
        for part, marks in _parts(ids):
            with contextlib.suppress(sqlite3.OperationalError):
                db.execute(f"UPDATE {table} SET used = {today} WHERE used < {today} AND id IN ({marks})", part)

    def _put(self, table: str, rows: list[tuple[bytes, bytes]]) -> None:
        if not rows:
            return
        for _ in (1, 2):  # the second time on a file that has been started anew
            db = self._open()
            if db is None or not self._writable:
                break
            today = int(time.time()) // _DAY
            try:
                db.execute("BEGIN IMMEDIATE")
                db.executemany(f"INSERT OR REPLACE INTO {table} (key, used, data) VALUES (?, {today}, ?)", rows)
                db.execute("COMMIT")
                self._wrote = True
                return
            except sqlite3.Error as error:
                with contextlib.suppress(sqlite3.Error):
                    if db.in_transaction:
                        db.execute("ROLLBACK")
                self._failed(error)
        self._memory[table].update(rows)

    def _bytes(self, db: sqlite3.Connection) -> int:
        pages = db.execute("PRAGMA page_count").fetchone()[0] - db.execute("PRAGMA freelist_count").fetchone()[0]
        return pages * db.execute("PRAGMA page_size").fetchone()[0]

    def _trim(self, db: sqlite3.Connection) -> None:
        """Above the limit, drops the rows not used for longest until three quarters of it are left."""
        size = self._bytes(db)
        if size <= self.limit:
            return
        surplus = size - self.limit * 3 // 4
        rows = [
            (used, row, length, table)
            for table in _TABLES
            for row, used, length in db.execute(f"SELECT id, used, length(data) + 80 FROM {table}")
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
            for part, marks in _parts(ids):
                db.execute(f"DELETE FROM {table} WHERE id IN ({marks})", part)
            db.execute("COMMIT")
        db.executescript("PRAGMA incremental_vacuum;")  # execute() would free one page only


# Faults of the disk or of other users of the file, by SQLite's words (Python 3.10 does not give the codes). Everything
# else means that the file is not what this version wrote.
_DISK = ("locked", "disk I/O", "disk is full", "readonly", "unable to open", "out of memory", "interrupted")


def _is_of_the_disk(error: sqlite3.Error) -> bool:
    return isinstance(error, sqlite3.OperationalError) and any(words in str(error) for words in _DISK)


def _memo_key(table: str, key: bytes) -> bytes:
    return table.encode() + b"\0" + key


def _parts(values: Sequence) -> Iterator[tuple[Sequence, str]]:
    """Values in pieces that fit one statement, each with its question marks."""
    for start in range(0, len(values), _AT_ONCE):
        part = values[start : start + _AT_ONCE]
        yield part, ",".join("?" * len(part))


def _clause(error: Exception) -> str:
    if isinstance(error, OSError):
        return (error.strerror or type(error).__name__).lower()
    return str(error) or type(error).__name__
