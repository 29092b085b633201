"""The store: what goes in comes out, whatever happens to the disk or to other processes meanwhile."""

import contextlib
import errno
import os
import random
import signal
import socket
import sqlite3
import subprocess
import sys
import time

import pytest
import zstandard
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.edges.limits import Limits
from rosimpact.impact.cache import cache_folder
from rosimpact.impact.facts import store as store_module
from rosimpact.impact.facts.store import Store, make_fact_key, pack, unpack


def key(number, extractor="cpp.1"):
    return make_fact_key(f"{number:040x}", extractor)


def rows(start, count, size=50):
    return [(key(n), pack(f"{n}:".encode() + b"x" * size)) for n in range(start, start + count)]


def contents(folder):
    with Store(folder) as store:
        return store.find([key(n) for n in range(5000)])


@given(st.binary(max_size=2000))
def test_packing(data):
    assert unpack(pack(data)) == data


@pytest.mark.parametrize("data", [b"", b"?", b"z", b"znot packed", b"\x00\x01"])
def test_unpacking_what_was_not_packed(data):
    with pytest.raises(ValueError):
        unpack(data)


def test_what_goes_in_comes_out_of_a_later_run(tmp_path):
    with Store(tmp_path) as store:
        assert store.find([key(1)]) == set()
        store.put(rows(0, 3000))
        assert dict(store.get([key(7)])) == dict(rows(7, 1))
    with Store(tmp_path) as store:
        wanted = [key(n) for n in range(2500, 3500)]
        assert store.find(wanted) == set(wanted[:500])
        assert dict(store.get(wanted)) == dict(rows(2500, 500))
        assert store.notes == []


def test_another_version_of_an_extractor_is_another_row(tmp_path):
    with Store(tmp_path) as store:
        store.put([(key(1, "cpp.1"), pack(b"old")), (key(1, "cpp.2"), pack(b"new")), (key(1, "python.1"), pack(b"py"))])
        assert dict(store.get([key(1, "cpp.2")])) == {key(1, "cpp.2"): pack(b"new")}
        assert store.find([key(1, "cpp.3")]) == set()


def test_memo(tmp_path):
    with Store(tmp_path) as store:
        store.remember("digest", [(b"k", b"v"), (b"l", b"w" * 1000)])
        store.remember("other", [(b"k", b"else")])
    with Store(tmp_path) as store:
        assert store.find_memo("digest", b"k") == b"v"
        assert store.find_memo("other", b"k") == b"else"
        assert store.find_memo("digest", b"m") is None
        assert store.find_memos("digest", [b"k", b"l", b"m"]) == {b"k": b"v", b"l": b"w" * 1000}
        store.remember("digest", [(b"k", b"newer")])
        assert store.find_memo("digest", b"k") == b"newer"


def test_a_closed_store_opens_itself_again(tmp_path):
    store = Store(tmp_path)
    store.put(rows(0, 1))
    store.close()
    assert store.find([key(0)]) == {key(0)}
    store.close()


DAMAGE = {
    "no database": lambda path: path.write_bytes(b"this is text, and more than a header of it" * 10),
    "cut off": lambda path: path.write_bytes(path.read_bytes()[:6000]),
    "zeros inside": lambda path: path.write_bytes(path.read_bytes()[:4096] + b"\0" * (path.stat().st_size - 4096)),
    "its tables and another": lambda path: sqlite3.connect(path).executescript("CREATE TABLE more (a)").close(),
    "a table of another form": lambda path: sqlite3.connect(path).executescript(
        "PRAGMA writable_schema = ON; UPDATE sqlite_master SET sql = replace(sql, ' NOT NULL', '') WHERE name = 'facts'"
    ).close(),
    "other tables": lambda path: (
        path.unlink(),
        sqlite3.connect(path).executescript("CREATE TABLE facts (a); PRAGMA user_version = 3;").close(),
    ),
}


@pytest.mark.parametrize("damage", DAMAGE.values(), ids=DAMAGE)
def test_a_damaged_file_is_started_anew_with_one_line(tmp_path, damage):
    with Store(tmp_path) as store:
        store.put(rows(0, 2000))
    for suffix in ("-wal", "-shm"):
        (tmp_path / f"facts.sqlite{suffix}").unlink(missing_ok=True)
    damage(tmp_path / "facts.sqlite")
    with Store(tmp_path) as store:
        store.find([key(n) for n in range(2000)])
        list(store.get([key(n) for n in range(2000)]))
        store.put(rows(0, 10))
        assert store.find([key(3)]) == {key(3)}
        assert dict(store.get([key(3)])) == dict(rows(3, 1))
        assert len(store.notes) == 1 and "damaged" in store.notes[0] and "\n" not in store.notes[0]
    with Store(tmp_path) as store:
        assert store.find([key(3)]) == {key(3)}
        assert store.notes == []


def test_an_empty_file_is_a_new_store(tmp_path):
    (tmp_path / "facts.sqlite").write_bytes(b"")
    with Store(tmp_path) as store:
        store.put(rows(0, 1))
        assert store.notes == []


def test_deleted_while_open(tmp_path):
    with Store(tmp_path) as store:
        store.put(rows(0, 10))
        for file in tmp_path.iterdir():
            file.unlink()
        store.put(rows(10, 10))
        assert store.find([key(0), key(15)]) == {key(0), key(15)}
    with Store(tmp_path) as store:
        store.put(rows(0, 1))
        assert store.find([key(0)]) == {key(0)}


def test_a_full_disk(tmp_path):
    with Store(tmp_path) as store:
        store.put(rows(0, 10))
        store._db.execute("PRAGMA max_page_count = 1")
        store.put(rows(100, 500, size=3000))
        store.put(rows(700, 10))
        wanted = [key(n) for n in (3, 100, 599, 705)]
        assert store.find(wanted) == set(wanted)
        assert {k for k, _ in store.get(wanted)} == set(wanted)
        assert len(store.notes) == 1 and "full" in store.notes[0] and "ROSIMPACT_CACHE" in store.notes[0]
    assert contents(tmp_path) == {key(n) for n in range(10)}, "all of a put, or nothing"


def test_a_folder_that_cannot_be_made(tmp_path):
    (tmp_path / "file").write_text("")
    with Store(tmp_path / "file" / "cache") as store:
        store.put(rows(0, 5))
        assert store.find([key(n) for n in range(9)]) == {key(n) for n in range(5)}
        store.remember("t", [(b"k", b"v")])
        assert store.find_memo("t", b"k") == b"v"
        assert len(store.notes) == 1


@pytest.mark.parametrize("error", [errno.EACCES, errno.EROFS, errno.ENOSPC])
def test_a_folder_that_cannot_be_written(tmp_path, monkeypatch, error):
    def refuse(*_, **__):
        raise OSError(error, os.strerror(error))

    monkeypatch.setattr(store_module.os, "makedirs", refuse)
    with Store(tmp_path / "cache") as store:
        store.put(rows(0, 5))
        assert dict(store.get([key(4)])) == dict(rows(4, 1))
        assert len(store.notes) == 1 and os.strerror(error).lower() in store.notes[0]


def test_a_file_that_can_only_be_read_is_read(tmp_path, monkeypatch):
    with Store(tmp_path) as store:
        store.put(rows(0, 10))
    connect = sqlite3.connect

    def read_only(place, *arguments, **options):
        if options.get("uri"):
            return connect(place, *arguments, **options)
        raise sqlite3.OperationalError("attempt to write a readonly database")

    monkeypatch.setattr(store_module.sqlite3, "connect", read_only)
    with Store(tmp_path) as store:
        assert store.find([key(3), key(11)]) == {key(3)}
        store.put(rows(10, 5))
        assert store.find([key(3), key(11)]) == {key(3), key(11)}
        assert len(store.notes) == 1 and "readonly" in store.notes[0]


def test_another_process_that_keeps_the_file_locked(tmp_path, monkeypatch):
    monkeypatch.setattr(store_module, "_BUSY_MS", 50)
    with Store(tmp_path) as store:
        store.put(rows(0, 10))
        other = sqlite3.connect(tmp_path / "facts.sqlite", isolation_level=None)
        other.execute("BEGIN IMMEDIATE")
        store.put(rows(10, 10))
        assert store.find([key(5), key(15)]) == {key(5), key(15)}
        assert len(store.notes) == 1 and "locked" in store.notes[0]
        other.execute("ROLLBACK")
        other.close()


WRITER = """
import sys
from rosimpact.impact.cache import cache_folder
from rosimpact.impact.facts.store import Store, make_fact_key, pack
folder, start, count = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
store = Store(folder)
print("ready", flush=True)
sys.stdin.readline()
for n in range(start, start + count):
    store.put([(make_fact_key(f"{n:040x}", "cpp.1"), pack(f"{n}:".encode() + b"x" * 50))])
    print(n, flush=True)
print(store.notes, flush=True)
store.close()
"""


def writer(folder, start, count):
    process = subprocess.Popen(
        [sys.executable, "-c", WRITER, str(folder), str(start), str(count)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout.readline() == "ready\n"
    return process


def test_processes_that_write_at_once(tmp_path):
    processes = [writer(tmp_path, start, 200) for start in (0, 100, 1000)]
    for process in processes:
        process.stdin.write("\n")
        process.stdin.flush()
    for process in processes:
        output, _ = process.communicate(timeout=60)
        assert output.endswith("[]\n"), "no notes"
    assert contents(tmp_path) == {key(n) for n in [*range(300), *range(1000, 1200)]}


def test_a_process_killed_in_the_middle(tmp_path):
    process = writer(tmp_path, 0, 100_000)
    process.stdin.write("\n")
    process.stdin.flush()
    stored = 0
    while stored < 50:
        stored = int(process.stdout.readline())
    process.send_signal(signal.SIGKILL)
    process.wait()
    with Store(tmp_path) as store:
        assert store.find([key(n) for n in range(51)]) == {key(n) for n in range(51)}
        store.put(rows(200_000, 1))
        assert store.notes == []


def test_the_least_recently_used_go_first(tmp_path, monkeypatch):
    limit = 400_000
    day = 86_400
    now = time.time()
    for age, start in ((30, 0), (20, 1000), (10, 2000)):
        monkeypatch.setattr(store_module.time, "time", lambda age=age: now - age * day)
        with Store(tmp_path, limit=10**9) as store:
            store.put([(key(n), b"-" + os.urandom(1500)) for n in range(start, start + 100)])
    monkeypatch.setattr(store_module.time, "time", lambda: now)
    with Store(tmp_path, limit=limit) as store:
        used_again = [key(n) for n in range(50)]
        assert store.find(used_again) == set(used_again)
        store.put([(key(3000), b"-new")])
    left = contents(tmp_path)
    assert key(3000) in left and set(used_again) <= left
    assert not {key(n) for n in range(50, 100)} & left, "the oldest that nobody used"
    assert (tmp_path / "facts.sqlite").stat().st_size <= limit
    assert len(left) > 100, "no more than needed"


def test_a_run_that_writes_nothing_drops_nothing(tmp_path):
    with Store(tmp_path) as store:
        store.put([(key(n), b"-" + os.urandom(1500)) for n in range(100)])
    with Store(tmp_path, limit=1000) as store:
        assert len(store.find([key(n) for n in range(100)])) == 100
    assert len(contents(tmp_path)) == 100


def test_where_the_cache_lies(tmp_path, monkeypatch):
    monkeypatch.setenv("ROSIMPACT_CACHE", str(tmp_path / "here"))
    assert os.fspath(cache_folder()) == str(tmp_path / "here")
    monkeypatch.delenv("ROSIMPACT_CACHE")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "xdg"))
    assert "rosimpact" in os.path.basename(cache_folder())


COLUMNS = ("id", "key", "used", "seal", "data")
VALUES = {
    "nothing": None,
    "a number": 7,
    "text": "x",
    "wrong text": b"\xff",
    "other bytes": b"zother",
    "a bomb": b"bomb",
}


@pytest.mark.parametrize("column", COLUMNS)
@pytest.mark.parametrize("value", VALUES.values(), ids=VALUES)
def test_a_damaged_row_counts_as_lost_whatever_it_holds(tmp_path, column, value):
    with Store(tmp_path) as store:
        store.put(rows(0, 3))
        store.remember("t", [(b"k", b"v" * 3000)])
    with contextlib.closing(sqlite3.connect(tmp_path / "facts.sqlite")) as db:
        # SQLite checks neither types nor NOT NULL of rows that are there already
        db.execute("PRAGMA writable_schema = ON")
        shape = db.execute("SELECT sql FROM sqlite_master WHERE name = 'facts'").fetchone()[0]
        db.execute("UPDATE sqlite_master SET sql = replace(sql, ' NOT NULL', '')")
        db.commit()
    with contextlib.closing(sqlite3.connect(tmp_path / "facts.sqlite")) as db:
        what = "CAST(? AS TEXT)" if value == b"\xff" else "?"
        value = b"z" + zstandard.compress(b"\0" * 10_000_000) if value == b"bomb" else value
        for table in ("facts", "memo"):
            with contextlib.suppress(sqlite3.Error):  # a key that is taken, an id that is no number
                db.execute(f"UPDATE {table} SET {column} = {what} WHERE id = 1", [value])
        db.execute("PRAGMA writable_schema = ON")
        db.execute("UPDATE sqlite_master SET sql = replace(?, 'facts', name) WHERE sql IS NOT NULL", [shape])
        db.commit()
    with Store(tmp_path) as store:
        found = dict(store.get([key(n) for n in range(5)]))
        assert found.items() <= dict(rows(0, 3)).items() and {key(1), key(2)} <= found.keys()
        assert store.find_memo("t", b"k") in (None, b"v" * 3000)
        store.put(rows(0, 1))
        store.remember("t", [(b"k", b"v" * 3000)])
        assert dict(store.get([key(n) for n in range(5)])) == dict(rows(0, 3))
        assert store.find_memo("t", b"k") == b"v" * 3000
        assert store.notes == []


def test_any_damage_of_the_file_gives_what_was_stored_or_nothing(tmp_path):
    chance = random.Random(7)
    with Store(tmp_path / "whole") as store:
        store.put(rows(0, 200, size=300))
        store.remember("t", [(b"%d" % n, b"%d" % n * 999) for n in range(50)])
    whole = (tmp_path / "whole" / "facts.sqlite").read_bytes()
    replaced = 0
    for turn in range(150):
        data = bytearray(whole)
        reach = 100 if turn % 3 == 0 else len(data)
        for _ in range((1, 1, 100)[turn % 3]):
            data[chance.randrange(reach)] = chance.randrange(256)
        if turn % 10 == 9:
            del data[chance.randrange(len(data)) :]
        folder = tmp_path / f"{turn}"
        folder.mkdir()
        (folder / "facts.sqlite").write_bytes(data)
        if turn % 7 == 0:
            (folder / "facts.sqlite-wal").write_bytes(chance.randbytes(5000))
        with Store(folder, limit=10_000 if turn % 5 == 0 else 10**9) as store:
            wanted = [key(n) for n in range(210)]
            store.find(wanted)
            assert dict(store.get(wanted)).items() <= dict(rows(0, 200, size=300)).items()
            assert all(data == k * 999 for k, data in store.find_memos("t", [b"%d" % n for n in range(60)]).items())
            store.put(rows(195, 10, size=300))
            assert dict(store.get(wanted)).items() <= dict(rows(0, 205, size=300)).items()
            assert len(store.notes) <= 1
            replaced += len(store.notes)
    assert 30 < replaced < 150


def test_a_file_of_a_newer_version_is_left_alone(tmp_path):
    with Store(tmp_path) as store:
        store.put(rows(0, 3))
    sqlite3.connect(tmp_path / "facts.sqlite").execute("PRAGMA user_version = 99").close()
    before = (tmp_path / "facts.sqlite").read_bytes()
    with Store(tmp_path) as store:
        store.put(rows(5, 3))
        assert store.find([key(1), key(6)]) == {key(6)}
        assert len(store.notes) == 1 and "newer rosimpact" in store.notes[0]
    assert (tmp_path / "facts.sqlite").read_bytes() == before


def test_a_file_of_an_older_version_is_replaced_without_a_word(tmp_path):
    old = "CREATE TABLE facts (id INTEGER PRIMARY KEY, key BLOB, used INTEGER, data BLOB); PRAGMA user_version = 1;"
    sqlite3.connect(tmp_path / "facts.sqlite").executescript(old).close()
    with Store(tmp_path) as store:
        store.put(rows(5, 3))
        assert store.notes == []
    assert contents(tmp_path) == {key(n) for n in range(5, 8)}


OTHER_FILES = {
    "a named pipe": os.mkfifo,
    "a folder": os.mkdir,
    "a link to a device": lambda path: os.symlink("/dev/zero", path),
    "a link to nothing": lambda path: os.symlink(path.parent.parent / "made", path),
    "a link to a file": lambda path: os.symlink(path.parent.parent / "other", path),
    "a socket": lambda path: socket.socket(socket.AF_UNIX).bind(os.fspath(path)),
}


@pytest.mark.parametrize("suffix", ["", "-wal", "-shm"])
@pytest.mark.parametrize("make", OTHER_FILES.values(), ids=OTHER_FILES)
def test_what_is_no_file_is_done_without(tmp_path, monkeypatch, make, suffix):
    (tmp_path / "other").write_bytes(b"")
    (tmp_path / "c").mkdir()
    monkeypatch.chdir(tmp_path)
    make(tmp_path / "c" / f"facts.sqlite{suffix}")
    with Store(tmp_path / "c") as store:
        store.put(rows(0, 3))
        store.remember("t", [(b"k", b"v")])
        assert store.find([key(1), key(7)]) == {key(1)}
        assert store.find_memo("t", b"k") == b"v"
        assert len(store.notes) == 1 and f"remove `facts.sqlite{suffix}`" in store.notes[0]
    assert (tmp_path / "other").read_bytes() == b"" and not (tmp_path / "made").exists()


def test_a_link_to_the_folder_is_followed(tmp_path):
    (tmp_path / "c").mkdir()
    (tmp_path / "link").symlink_to("c")
    with Store(tmp_path / "link") as store:
        store.put(rows(0, 3))
        assert store.notes == []
    assert contents(tmp_path / "c") == {key(0), key(1), key(2)}


def test_a_file_that_another_process_replaced(tmp_path):
    with Store(tmp_path) as first, Store(tmp_path) as second:
        first.put(rows(0, 3))
        second.put(rows(3, 3))
        second._start_anew(sqlite3.DatabaseError("of a page that only this one read"))
        second._opened = False
        second.put(rows(10, 3))
        first.put(rows(20, 3))
        assert first.find([key(1), key(21)]) == {key(1), key(21)}, "it keeps what it had open"
        first._recover(sqlite3.DatabaseError("the same page"))
        first.put(rows(30, 3))
        assert first.find([key(1), key(11), key(31)]) == {key(11), key(31)}
        assert first.notes == []
    assert contents(tmp_path) == {key(n) for n in (10, 11, 12, 30, 31, 32)}
    with contextlib.closing(sqlite3.connect(tmp_path / "facts.sqlite")) as db:
        assert db.execute("PRAGMA integrity_check").fetchone() == ("ok",)


def test_a_file_that_is_damaged_again_and_again_is_done_without(tmp_path):
    with Store(tmp_path) as store:
        for n in range(5):
            store.put(rows(n, 1))
            store._recover(sqlite3.DatabaseError("malformed"))
        store.put(rows(9, 1))
        assert store.find([key(9)]) == {key(9)}
        assert len(store.notes) == 3


def test_a_damaged_file_that_cannot_be_replaced_is_done_without(tmp_path, monkeypatch):
    opened = []

    def connect(store, real=Store._connect):
        opened.append(store)
        assert len(opened) < 9, "it is opened again and again"
        return real(store)

    def replace(*_):
        raise PermissionError(errno.EACCES, "Permission denied")

    (tmp_path / "facts.sqlite").write_bytes(b"this is text, and more than a header of it" * 10)
    monkeypatch.setattr(Store, "_connect", connect)
    monkeypatch.setattr(os, "replace", replace)
    with Store(tmp_path) as store:
        store.put(rows(1, 1))
        assert store.find([key(1)]) == {key(1)}
        assert len(store.notes) == 1 and "cannot be read" in store.notes[0]


@pytest.mark.parametrize("before", [b"", b"SQLite format 3\0" + b"\7" * 9000])
def test_ten_processes_that_begin_on_a_damaged_file(tmp_path, before):
    (tmp_path / "facts.sqlite").write_bytes(before)
    processes = [writer(tmp_path, 100 * start, 30) for start in range(10)]
    for process in processes:
        process.stdin.write("\n")
        process.stdin.flush()
    notes = 0
    for process in processes:
        output, _ = process.communicate(timeout=60)
        assert process.returncode == 0
        assert output.endswith("[]\n") or "started anew" in output.splitlines()[-1]
        notes += not output.endswith("[]\n")
    assert notes <= 1, "one of them replaces it"
    assert contents(tmp_path) == {key(100 * start + n) for start in range(10) for n in range(30)}
    with contextlib.closing(sqlite3.connect(tmp_path / "facts.sqlite")) as db:
        assert db.execute("PRAGMA integrity_check").fetchone() == ("ok",)


def test_a_clock_that_goes_back(tmp_path, monkeypatch):
    future = time.time() + 10_000 * 86_400
    monkeypatch.setattr(store_module.time, "time", lambda: future)
    with Store(tmp_path) as store:
        store.put([(key(n), b"-" + os.urandom(1500)) for n in range(100)])
    monkeypatch.undo()
    with Store(tmp_path, limit=250_000) as store:
        store.put([(key(n), b"-" + os.urandom(1500)) for n in range(1000, 1050)])
    assert {key(n) for n in range(1000, 1050)} <= contents(tmp_path), "what was used today is not the oldest"


def test_a_row_larger_than_its_limit_is_kept_for_this_run_only(tmp_path, monkeypatch):
    monkeypatch.setattr(store_module, "get_limits", lambda: Limits(row=1000))
    with Store(tmp_path) as store:
        store.put([(key(1), b"-" + b"x" * 2000), (key(2), b"-x")])
        assert {k for k, _ in store.get([key(1), key(2)])} == {key(1), key(2)}
        assert store.notes == []
    assert contents(tmp_path) == {key(2)}
    with pytest.raises(ValueError, match="larger"):
        unpack(b"z" + zstandard.compress(b"\0" * 2000))
