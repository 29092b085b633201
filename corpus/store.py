"""What was gathered: reports, the answers they were read from, and how far each gathering is; one SQLite file.

A page of reports and the state that says so are written in one transaction: a gathering that is killed goes on from the
last page that is whole, and nothing is in the file twice. A report that its source has deleted loses its text here too
and keeps its id. Of a person, only the public name and the address of their page are kept, as attribution needs.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import sqlite3
import time
import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import msgspec

from ..edges.files import open_regular, read_start
from .outputs import explain_unwritable
from .report import BugReport, CorpusError, find_repository, read_reports

STORE_VARIABLE = "ROSIMPACT_CORPUS"
_SCHEMA_VERSION = 1
_MAGIC = b"SQLite format 3\0"
_BUSY_SECONDS = 30
_KEPT = "id, source, origin, etag, checked, gone"
# rows that a source can be asked about again
_CHECKABLE = "source = ? AND checked < ? AND origin NOT IN ('pages', 'askbot')"
_SCHEMA = """
CREATE TABLE report (
    key TEXT PRIMARY KEY,               -- the id in lower case, since GitHub compares names so
    id TEXT NOT NULL,
    source TEXT NOT NULL,
    origin TEXT NOT NULL,               -- how it came here: github, archive, pages, askbot, stack-exchange, import
    gone INTEGER NOT NULL DEFAULT 0,    -- 1: its source has it no more
    digest BLOB,                        -- of what came from the source, to know that nothing has changed
    etag TEXT NOT NULL DEFAULT '',
    first REAL NOT NULL,                -- seconds since 1970: when it came, was asked for last, changed last
    checked REAL NOT NULL,
    changed REAL NOT NULL,
    report BLOB,                        -- the texts last, so that the rest is read without them
    raw BLOB
);
CREATE INDEX report_checked ON report (source, checked);
CREATE TABLE alias (old TEXT PRIMARY KEY, key TEXT NOT NULL) WITHOUT ROWID;
CREATE INDEX alias_key ON alias (key);
CREATE TABLE wanted (id TEXT PRIMARY KEY, key TEXT NOT NULL) WITHOUT ROWID;
CREATE INDEX wanted_key ON wanted (key);
CREATE TABLE copy (copy TEXT PRIMARY KEY, original TEXT NOT NULL) WITHOUT ROWID;
CREATE INDEX copy_original ON copy (original);
CREATE TABLE gathering (name TEXT PRIMARY KEY, state BLOB NOT NULL, finished INTEGER NOT NULL, updated REAL NOT NULL)
    WITHOUT ROWID;
"""


class GatheredReport(NamedTuple):
    """A report as a source gave it.

    raw: the answer it was read from, reduced to what may be kept. digest: of the answer as it came, where reading it
    again is to be spared. asked: another id under which it was asked for, or was known before its repository moved.
    origin: how it came here.
    """

    report: BugReport
    raw: bytes = b""
    digest: bytes = b""
    etag: str = ""
    asked: str = ""
    origin: str = ""


class GatheredPage(NamedTuple):
    """A piece of a gathering: what it brought, and the state from which the next piece follows.

    done, of: how many reports were read so far in this run and will be in all, where that is known. gone: (id, source)
    of reports that the source has no more. copies: (copy, original) of posts that were migrated. moved: the old
    and the new `owner/name` of a repository whose reports these are.
    """

    reports: list[GatheredReport]
    state: dict[str, Any]
    finished: bool = False
    done: int = 0
    of: int | None = None
    gone: tuple[tuple[str, str], ...] = ()
    copies: tuple[tuple[str, str], ...] = ()
    moved: tuple[str, str] | None = None


class AskedReport(NamedTuple):
    """What became of a report that was asked for by its id. what: `here`, `same` (as its ETag says) or `gone`."""

    id: str
    what: str
    gathered: GatheredReport | None = None


class ReportCounts(NamedTuple):
    """What became of the reports of a page."""

    new: int = 0
    changed: int = 0
    same: int = 0
    gone: int = 0

    def add(self, other: ReportCounts) -> ReportCounts:
        return ReportCounts(*(mine + theirs for mine, theirs in zip(self, other, strict=True)))


class StoredRow(NamedTuple):
    """A row as refresh and hydrate need it."""

    id: str
    source: str
    origin: str
    etag: str
    checked: float
    gone: int


def store_path(chosen: Path | None = None, environment: Mapping[str, str] = os.environ) -> Path:
    """The file of the store: the one chosen, else $ROSIMPACT_CORPUS, else corpus.sqlite in the user's data folder."""
    if chosen:
        return chosen
    named = environment.get(STORE_VARIABLE)
    if named:
        return Path(os.path.abspath(os.path.expanduser(named)))
    import platformdirs

    return Path(platformdirs.user_data_dir("rosimpact", appauthor=False), "corpus.sqlite")


def hash_bytes(data: bytes) -> bytes:
    """Sixteen bytes that stand for a content."""
    return hashlib.blake2b(data, digest_size=16).digest()


def open_reports(path: Path) -> Iterator[BugReport]:
    """The reports of a store or of a JSON Lines file, one at a time. Raises CorpusError.

    Of a store: one for each thing reported. A migrated question and its original count once; the one that was asked for
    by its id (see `hydrate`) is preferred, else the original.
    """
    try:
        is_store = read_start(path, len(_MAGIC)) == _MAGIC
    except OSError as error:
        raise CorpusError(
            f"{path}: cannot be read: {error.strerror}; give a JSON Lines file, or a store made by "
            "`rosimpact corpus gather`"
        ) from None
    if not is_store:
        yield from read_reports(path)
        return
    with CorpusStore(path) as store:
        yield from store.iterate_reports()


class CorpusStore:
    """An open store; a context manager. Raises CorpusError when the file is none, or cannot be read or written.

    Any number of processes may have the same file open; one CorpusStore belongs to one thread. A file that is not there
    is made when there is a report to keep: a gathering that fails before, or finds nothing, leaves none behind.
    """

    def __init__(self, path: Path, clock: Callable[[], float] = time.time):
        self.path = path
        self.now = clock
        self._forgot = False
        self._made = os.path.lexists(path)
        fault = "" if self._made else explain_unwritable(path)
        if fault:
            raise CorpusError(f"{path}: cannot be opened ({fault}); give another file with --store")
        self._db = sqlite3.connect(":memory:", isolation_level=None)
        try:
            if self._made:
                self._open()
            else:
                self._prepare()
        except BaseException:
            self._db.close()
            raise

    def __enter__(self) -> CorpusStore:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def close(self) -> None:
        """Lets go of the file; texts that were taken away leave its journal too."""
        with contextlib.suppress(sqlite3.Error):
            if self._forgot:
                self._db.execute("PRAGMA wal_checkpoint(TRUNCATE)")
        self._db.close()

    def take(self, name: str, page: GatheredPage) -> ReportCounts:
        """Writes a page of the gathering `name` and its state, all or nothing."""
        now = self.now()
        if page.reports or page.gone or page.copies:
            self._make()
        with self._begin_transaction():
            taken = ReportCounts()
            if page.moved is not None:
                self._move_all(*page.moved)
            for gathered in page.reports:
                taken = taken.add(self._put(gathered, now))
            for id, source in page.gone:
                taken = taken.add(ReportCounts(gone=self._forget(id, source, now)))
            self._db.executemany("INSERT OR REPLACE INTO copy VALUES (?, ?)", _lower(page.copies))
            self._db.execute(
                "INSERT OR REPLACE INTO gathering VALUES (?, ?, ?, ?)",
                (name, msgspec.json.encode(page.state), page.finished, now),
            )
        return taken

    def put(self, reports: Iterable[GatheredReport]) -> ReportCounts:
        """Writes reports outside any gathering, all or nothing."""
        now = self.now()
        taken = ReportCounts()
        given = list(reports)
        if given:
            self._make()
        with self._begin_transaction():
            for gathered in given:
                taken = taken.add(self._put(gathered, now))
        return taken

    def forget(self, ids: Iterable[tuple[str, str]]) -> int:
        """Takes away the texts of reports, given as (id, source), that their source has no more; ids that were not
        here are noted as gone. Returns how many had a text."""
        now = self.now()
        given = list(ids)
        if given:
            self._make()
        with self._begin_transaction():
            return sum([self._forget(id, source, now) for id, source in given])

    def mark_seen(self, ids: Iterable[str]) -> None:
        """Notes that reports were asked for and have not changed."""
        now = self.now()
        with self._begin_transaction():
            for id in ids:
                self._db.execute("UPDATE report SET checked = ? WHERE key = ?", (now, self._find_key(id)))

    def want(self, ids: Iterable[str]) -> None:
        """Notes ids that have a label. Their reports go by these ids, however their source spells them today."""
        with self._begin_transaction():
            for id in ids:
                self._db.execute("INSERT OR REPLACE INTO wanted VALUES (?, ?)", (id, self._find_key(id)))

    def read_state(self, name: str) -> dict[str, Any] | None:
        """The state of a gathering, None when it was never begun."""
        rows = self._fetch_all("SELECT state FROM gathering WHERE name = ?", (name,))
        try:
            return msgspec.json.decode(rows[0][0], type=dict) if rows else None
        except (msgspec.MsgspecError, TypeError, RecursionError) as error:
            raise self._make_damage_error(error) from None

    def list_gatherings(self) -> list[tuple[str, bool, float]]:
        """(name, whether it came to its end, seconds since 1970 of its last page) of each gathering."""
        rows = self._fetch_all("SELECT name, finished, updated FROM gathering ORDER BY name")
        return [(name, bool(finished), updated) for name, finished, updated in rows]

    def read_digest(self, id: str) -> bytes:
        """Of what the source gave for a report; empty when it is not here."""
        rows = self._fetch_all("SELECT digest FROM report WHERE key = ?", (self._find_key(id),))
        return (rows[0][0] or b"") if rows else b""

    def read_raw(self, id: str) -> bytes:
        """What is kept of the answer that a report was read from; empty when there is none."""
        rows = self._fetch_all("SELECT raw FROM report WHERE key = ?", (self._find_key(id),))
        return self._unpack_report(rows[0][0]) if rows and rows[0][0] else b""

    def report(self, id: str) -> BugReport | None:
        """One report by its id or by one it had before; None when it is not here or has no text any more."""
        rows = self._fetch_all(f"{_REPORTS} AND r.key = ?", (self._find_key(id),))
        return self._decode_report(*rows[0][1:]) if rows else None

    def iterate_reports(self) -> Iterator[BugReport]:
        """All reports with a text in the order of their keys, each thing reported once (see open_reports)."""
        left_out = self._find_left_out()
        try:
            for key, *row in self._db.execute(f"{_REPORTS} ORDER BY r.key"):
                if key not in left_out:
                    yield self._decode_report(*row)
        except sqlite3.Error as error:
            raise self._make_error(error) from None

    def find_kept(self, id: str) -> StoredRow | None:
        """What is known of an id; None when nothing is."""
        rows = self._fetch_all(f"SELECT {_KEPT} FROM report WHERE key = ?", (self._find_key(id),))
        return StoredRow(*rows[0]) if rows else None

    def list_to_check(self, source: str, before: float, limit: int) -> list[StoredRow]:
        """Reports of a source that were last asked for before a time (seconds since 1970), longest ago first; without
        those that came from where nobody can be asked."""
        rows = self._fetch_all(
            f"SELECT {_KEPT} FROM report WHERE {_CHECKABLE} ORDER BY checked, key LIMIT ?", (source, before, limit)
        )
        return [StoredRow(*row) for row in rows]

    def count_to_check(self, source: str, before: float) -> int:
        """How many reports list_to_check() would give without a limit."""
        return self._fetch_all(f"SELECT count(*) FROM report WHERE {_CHECKABLE}", (source, before))[0][0]

    def list_ids(self, origin: str) -> list[str]:
        """Ids of all reports with a text that came a certain way."""
        return [row[0] for row in self._fetch_all("SELECT id FROM report WHERE origin = ? AND gone = 0", (origin,))]

    def count_reports(self) -> list[tuple[str, int, int, int]]:
        """(source, reports with a text, of them with a label, gone) for each source."""
        return self._fetch_all(
            "SELECT source, sum(gone = 0), sum(gone = 0 AND key IN (SELECT key FROM wanted)), sum(gone) FROM report "
            "GROUP BY source ORDER BY source"
        )

    def count_copied(self) -> int:
        """How many reports with a text reports() leaves out, since another post of the same is there."""
        return len(self._find_left_out())

    def _find_left_out(self) -> set[str]:
        """Keys of posts that another one speaks for: the one with a label, else the original, else the first."""
        posts: dict[str, list[tuple[bool, bool, str]]] = {}
        for key, original, wanted in self._fetch_all(
            "SELECT r.key, coalesce(c.original, r.key), EXISTS (SELECT 1 FROM wanted w WHERE w.key = r.key) "
            "FROM report r LEFT JOIN copy c ON c.copy = r.key WHERE r.report IS NOT NULL "
            "AND (c.copy IS NOT NULL OR r.key IN (SELECT original FROM copy))"
        ):
            posts.setdefault(original, []).append((not wanted, key != original, key))
        return {key for group in posts.values() for _, _, key in sorted(group)[1:]}

    def _put(self, gathered: GatheredReport, now: float) -> ReportCounts:
        report = gathered.report
        key = report.id.lower()
        self._drop_alias(key)
        if gathered.asked and gathered.asked.lower() != key:
            self._move(gathered.asked.lower(), key)
        if report.same_as:
            self._db.execute("INSERT OR REPLACE INTO copy VALUES (?, ?)", (key, report.same_as.lower()))
        digest = gathered.digest or hash_bytes(gathered.raw or msgspec.json.encode(report))
        rows = self._fetch_all("SELECT digest, gone FROM report WHERE key = ?", (key,))
        if rows and rows[0] == (digest, 0):
            self._db.execute("UPDATE report SET checked = ?, etag = ? WHERE key = ?", (now, gathered.etag, key))
            return ReportCounts(same=1)
        # which post is a copy of which is in the table `copy`, whichever came first
        text = msgspec.json.encode(msgspec.structs.replace(report, same_as=""))
        self._db.execute(
            "INSERT INTO report (key, id, source, origin, report, raw, digest, etag, first, checked, changed) "
            "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?9, ?9) ON CONFLICT (key) DO UPDATE SET "
            "id = ?2, source = ?3, origin = ?4, report = ?5, raw = ?6, digest = ?7, etag = ?8, checked = ?9, "
            "changed = ?9, gone = 0",
            (
                key,
                report.id,
                "github" if find_repository(report.id) else report.source,  # who can be asked for it
                gathered.origin or "import",
                zlib.compress(text, _LEVEL),
                zlib.compress(gathered.raw, _LEVEL) if gathered.raw else None,
                digest,
                gathered.etag,
                now,
            ),
        )
        return ReportCounts(changed=1) if rows and not rows[0][1] else ReportCounts(new=1)

    def _drop_alias(self, key: str) -> None:
        """A source says that a report has this id: it is no former name of another one, though it may have been."""
        if self._fetch_all("SELECT 1 FROM alias WHERE old = ?", (key,)):
            self._db.execute("DELETE FROM alias WHERE old = ?", (key,))
            self._db.execute("UPDATE wanted SET key = ? WHERE lower(id) = ?", (key, key))

    def _move(self, old: str, key: str) -> None:
        """A report that was known, or asked for, under an old id is the one of another key."""
        if self._fetch_all("SELECT 1 FROM report WHERE key = ?", (key,)):
            self._db.execute("DELETE FROM report WHERE key = ?", (old,))
        else:
            self._db.execute("UPDATE report SET key = ? WHERE key = ?", (key, old))
        self._db.execute("UPDATE alias SET key = ? WHERE key = ?", (key, old))
        self._db.execute("UPDATE wanted SET key = ? WHERE key = ?", (key, old))
        self._db.execute("INSERT OR REPLACE INTO alias VALUES (?, ?)", (old, key))

    def _move_all(self, old: str, new: str) -> None:
        """The reports of a repository go by its new name, those too that were not asked for again."""
        # `$` follows `#` in the order of characters
        for key, id, packed in self._fetch_all(
            "SELECT key, id, report FROM report WHERE key >= ? AND key < ?", (f"{old.lower()}#", f"{old.lower()}$")
        ):
            if not isinstance(id, str):
                raise self._make_damage_error(TypeError(f"the id of `{key}` is no text"))
            number = id.rpartition("#")[2]
            now_id = f"{new}#{number}"
            if packed is not None:
                report = self._decode_report(packed, None, None)
                url = report.url.replace(f"/{old}/", f"/{new}/")
                packed = zlib.compress(msgspec.json.encode(msgspec.structs.replace(report, id=now_id, url=url)), _LEVEL)
            self._db.execute("UPDATE report SET id = ?, report = ? WHERE key = ?", (now_id, packed, key))
            self._drop_alias(now_id.lower())
            self._move(key, now_id.lower())

    def _forget(self, id: str, source: str, now: float) -> int:
        key = self._find_key(id)
        rows = self._fetch_all("SELECT gone FROM report WHERE key = ?", (key,))
        self._db.execute(
            "INSERT INTO report (key, id, source, origin, gone, first, checked, changed) "
            "VALUES (?1, ?2, ?3, '', 1, ?4, ?4, ?4) ON CONFLICT (key) DO UPDATE SET gone = 1, report = NULL, "
            "raw = NULL, digest = NULL, etag = '', checked = ?4, changed = CASE gone WHEN 1 THEN changed ELSE ?4 END",
            (key, id, source, now),
        )
        self._forgot = True
        return int(rows == [(0,)])

    def _find_key(self, id: str) -> str:
        rows = self._fetch_all("SELECT key FROM alias WHERE old = ?", (id.lower(),))
        return rows[0][0] if rows else id.lower()

    def _make(self) -> None:
        """Makes the file, unless it is there, of the wishes and states that were noted until now."""
        if self._made:
            return
        wanted = [id for (id,) in self._fetch_all("SELECT id FROM wanted")]
        states = self._fetch_all("SELECT * FROM gathering")
        self._open()
        self._made = True
        self.want(wanted)
        with self._begin_transaction():
            # another process may have made it, and be further
            self._db.executemany("INSERT OR IGNORE INTO gathering VALUES (?, ?, ?, ?)", states)

    def _open(self) -> None:
        """Goes on with the file; with what it had before when that cannot be opened."""
        before = self._db
        try:
            if os.path.lexists(self.path):
                os.close(open_regular(self.path))
            self.path.parent.mkdir(parents=True, exist_ok=True)
            self._db = sqlite3.connect(self.path, timeout=_BUSY_SECONDS, isolation_level=None)
        except (OSError, sqlite3.Error) as error:
            raise CorpusError(
                f"{self.path}: cannot be opened ({_describe(error)}); give another file with --store"
            ) from None
        try:
            self._prepare()
        except BaseException:
            self._db.close()
            self._db = before
            raise
        before.close()

    def _prepare(self) -> None:
        try:
            version = self._db.execute("PRAGMA user_version").fetchone()[0]
            if version not in (0, _SCHEMA_VERSION):
                raise CorpusError(
                    f"{self.path}: made by a newer rosimpact (layout {version}); update rosimpact, or give another "
                    "file with --store"
                )
            self._db.execute("PRAGMA trusted_schema = OFF")
            if version and self._fetch_all("SELECT 1 FROM sqlite_master WHERE type IN ('view', 'trigger')"):
                raise CorpusError(f"{self.path}: is a database of something else; give another file with --store")
            with contextlib.suppress(sqlite3.OperationalError):  # network folders have no shared memory
                self._db.execute("PRAGMA journal_mode = WAL")
            self._db.execute("PRAGMA synchronous = NORMAL")
            self._db.execute("PRAGMA secure_delete = ON")  # a text that was taken back is not to stay in free pages
            if version == 0:
                with self._begin_transaction():
                    # another process may have made them since
                    if self._db.execute("PRAGMA user_version").fetchone()[0] == 0:
                        if self._db.execute("SELECT count(*) FROM sqlite_master").fetchone()[0]:
                            raise CorpusError(
                                f"{self.path}: is a database of something else; give another file with --store"
                            )
                        for statement in filter(str.strip, _SCHEMA.split(";")):
                            self._db.execute(statement)
                        self._db.execute(f"PRAGMA user_version = {_SCHEMA_VERSION}")
        except sqlite3.Error as error:
            raise self._make_error(error) from None

    @contextlib.contextmanager
    def _begin_transaction(self) -> Iterator[None]:
        try:
            self._db.execute("BEGIN IMMEDIATE")
            try:
                yield
            except BaseException:
                self._db.execute("ROLLBACK")
                raise
            self._db.execute("COMMIT")
        except sqlite3.Error as error:
            raise self._make_error(error) from None

    def _fetch_all(self, statement: str, values: tuple = ()) -> list[tuple]:
        try:
            return self._db.execute(statement, values).fetchall()
        except sqlite3.Error as error:
            raise self._make_error(error) from None

    def _decode_report(self, packed: bytes, wanted: str | None, original: str | None) -> BugReport:
        try:
            report = _decode(self._unpack_report(packed))
        except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
            raise self._make_damage_error(error) from None
        if not wanted and not original:
            return report
        return msgspec.structs.replace(report, id=wanted or report.id, same_as=original or "")

    def _unpack_report(self, packed: bytes) -> bytes:
        unpacker = zlib.decompressobj()
        try:
            data = unpacker.decompress(packed, _LARGEST)
        except (zlib.error, TypeError) as error:
            raise self._make_damage_error(error) from None
        if not unpacker.eof:
            raise self._make_damage_error(ValueError("a report that is cut off or too large"))
        return data

    def _make_damage_error(self, error: Exception) -> CorpusError:
        """The store is left as it is: what can still be read of it belongs to its user."""
        return CorpusError(
            f"{self.path}: is damaged ({_describe(error)[:200]}); bring back a copy, or give another file with --store"
        )

    def _make_error(self, error: sqlite3.Error) -> CorpusError:
        if "locked" in str(error):
            return CorpusError(f"{self.path}: another process writes to it; wait until that has ended")
        if isinstance(error, sqlite3.OperationalError):
            return CorpusError(
                f"{self.path}: cannot be used ({error}); check the disk, or give another file with --store"
            )
        return CorpusError(f"{self.path}: is damaged or no store ({error}); give another file with --store")


_LEVEL = 6
_LARGEST = 256 << 20
"""Bytes of one report, unpacked."""
_REPORTS = (
    "SELECT r.key, r.report, (SELECT min(w.id) FROM wanted w WHERE w.key = r.key), c.original "
    "FROM report r LEFT JOIN copy c ON c.copy = r.key WHERE r.report IS NOT NULL"
)
_decode = msgspec.json.Decoder(BugReport).decode


def _lower(pairs: Iterable[tuple[str, str]]) -> Iterator[tuple[str, str]]:
    return ((copy.lower(), original.lower()) for copy, original in pairs)


def _describe(error: Exception) -> str:
    return (error.strerror if isinstance(error, OSError) else str(error)) or type(error).__name__
