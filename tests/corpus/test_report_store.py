"""The store: one file, read as a stream of reports whoever else has it open, that says what it cannot do."""

from __future__ import annotations

import contextlib
import itertools
import os
import sqlite3
import threading
import zlib
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rosimpact.corpus.report import BugReport, CorpusError, write_rows
from rosimpact.corpus.store import CorpusStore, GatheredPage, GatheredReport, ReportCounts, open_reports, store_path

NAMES = ("a/b#1", "A/b#2", "a/c#1", "a/b#3")


def report(id: str, body: str = "text", **more) -> BugReport:
    source = "github" if "#" in id else id.partition(":")[0]
    return BugReport(id, f"https://example.org/{id}", source, "2024-01-01", "title", body, **more)


@pytest.fixture
def path(tmp_path) -> Path:
    return tmp_path / "data" / "corpus.sqlite"


def test_a_store_and_a_file_give_the_same_reports(path, tmp_path):
    reports = [report("a/b#1", tags=("bug",)), report("ros-answers:7", author="Ann", licence="CC-BY-SA-3.0")]
    with CorpusStore(path) as store:
        store.put([GatheredReport(one) for one in reports])
    write_rows(tmp_path / "corpus.jsonl", reports)
    assert list(open_reports(path)) == list(open_reports(tmp_path / "corpus.jsonl")) == reports


def test_where_the_store_is(monkeypatch, tmp_path):
    assert store_path(Path("x.sqlite"), {"ROSIMPACT_CORPUS": "/y"}) == Path("x.sqlite")
    assert store_path(None, {"ROSIMPACT_CORPUS": str(tmp_path / "y.sqlite")}) == tmp_path / "y.sqlite"
    monkeypatch.setattr("platformdirs.user_data_dir", lambda name, **more: str(tmp_path / name))
    assert store_path(None, {}) == tmp_path / "rosimpact" / "corpus.sqlite"


def test_a_page_is_written_with_its_state_or_not_at_all(path):
    with CorpusStore(path) as store:
        store.take("job", GatheredPage([GatheredReport(report("a/b#1"))], {"after": 1}))

        class Broken(BugReport, frozen=True):
            @property
            def source(self) -> str:  # type: ignore[override]
                raise RuntimeError("a fault in the middle of a page")

        with pytest.raises(Exception, match=r".*"):
            store.take(
                "job", GatheredPage([GatheredReport(report("a/b#2")), None], {"after": 2})
            )  # type: ignore[list-item]
        assert [one.id for one in store.iterate_reports()] == ["a/b#1"]
        assert store.read_state("job") == {"after": 1}


def test_a_file_is_made_for_reports_and_for_nothing_less(path):
    with CorpusStore(path) as store:
        store.want(["A/b#1"])
        store.take("job", GatheredPage([], {"since": "2024"}))
        store.mark_seen(["a/b#1"])
        assert store.put([]) == ReportCounts() and store.forget([]) == 0
        assert (store.read_state("job"), store.find_kept("a/b#1"), list(store.iterate_reports())) == (
            {"since": "2024"},
            None,
            [],
        )
    assert not path.parent.exists()
    with CorpusStore(path) as store:
        store.want(["A/b#1"])
        store.take("job", GatheredPage([], {"since": "2024"}))
        store.put([GatheredReport(report("a/b#1"))])
    with CorpusStore(path) as store:
        assert store.read_state("job") == {"since": "2024"}
        assert [one.id for one in store.iterate_reports()] == ["A/b#1"]


def test_a_file_that_another_has_made_meanwhile_is_gone_on_with(path):
    with CorpusStore(path) as late, CorpusStore(path) as early:
        late.take("job", GatheredPage([], {"after": 1}))
        late.take("own", GatheredPage([], {"after": 5}))
        early.take("job", GatheredPage([GatheredReport(report("a/b#1"))], {"after": 2}))
        late.put([GatheredReport(report("a/b#2"))])
        assert (late.read_state("job"), late.read_state("own")) == ({"after": 2}, {"after": 5})
        assert [one.id for one in late.iterate_reports()] == ["a/b#1", "a/b#2"]


def test_a_place_for_no_file_is_refused_at_once(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(CorpusError, match=r"file/x/corpus.sqlite: cannot be opened \(Not a directory\)"):
        CorpusStore(tmp_path / "file" / "x" / "corpus.sqlite")


def test_ids_of_github_are_the_same_in_any_case(path):
    with CorpusStore(path) as store:
        assert store.put([GatheredReport(report("ANYbotics/x#1"))]).new == 1
        assert store.put([GatheredReport(report("anybotics/x#1", body="edited"))]).changed == 1
        assert [one.body for one in store.iterate_reports()] == ["edited"]


def test_what_is_the_same_is_not_written_anew(path):
    ticks = itertools.count(1.0)
    with CorpusStore(path, clock=lambda: next(ticks)) as store:
        store.put([GatheredReport(report("a/b#1"))])
        assert store.put([GatheredReport(report("a/b#1"))]).same == 1
        assert store._fetch_all("SELECT first, checked, changed FROM report") == [(1.0, 2.0, 1.0)]


def test_one_reads_while_another_writes(path):
    with CorpusStore(path) as writer:
        writer.put([GatheredReport(report(f"a/b#{n}")) for n in range(500)])
        reader = open_reports(path)
        first = next(reader)
        writer.put([GatheredReport(report(f"a/c#{n}")) for n in range(500)])
        assert len([first, *reader]) == 500, "a reader sees what was there when it began"


def test_many_write_at_once(path):

    def write(name: str) -> None:
        with CorpusStore(path) as store:
            for n in range(30):
                store.take(name, GatheredPage([GatheredReport(report(f"{name}/x#{n}"))], {"after": n}))

    threads = [threading.Thread(target=write, args=(f"w{n}",)) for n in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    with CorpusStore(path) as store:
        assert len(list(store.iterate_reports())) == 120
        assert [store.read_state(f"w{n}") for n in range(4)] == [{"after": 29}] * 4


def test_many_make_the_file_at_once(path):
    faults: list[Exception] = []

    def make() -> None:
        try:
            with CorpusStore(path) as store:
                store.put([GatheredReport(report("a/b#1"))])
        except Exception as error:
            faults.append(error)

    threads = [threading.Thread(target=make) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert faults == []
    assert [one.id for one in open_reports(path)] == ["a/b#1"]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"SQLite format 3\0" + b"\xff" * 5000, "is damaged or no store"),
        (b"something else entirely, and long enough to be a page" * 100, "is damaged or no store"),
    ],
)
def test_a_file_that_is_no_store_is_left_alone(path, content, message):
    path.parent.mkdir()
    path.write_bytes(content)
    with pytest.raises(CorpusError, match=message):
        CorpusStore(path)
    assert path.read_bytes() == content


def test_a_database_of_something_else_is_left_alone(path):
    path.parent.mkdir()
    with sqlite3.connect(path) as db:
        db.execute("CREATE TABLE theirs (x)")
    db.close()
    with pytest.raises(CorpusError, match="is a database of something else"):
        CorpusStore(path)
    with sqlite3.connect(path) as db:
        assert db.execute("SELECT name FROM sqlite_master").fetchall() == [("theirs",)]
    db.close()


def test_a_store_of_a_newer_version_is_not_touched(path):
    with CorpusStore(path) as store:
        store.put([GatheredReport(report("a/b#1"))])
    with sqlite3.connect(path) as db:
        db.execute("PRAGMA user_version = 99")
    db.close()
    with pytest.raises(CorpusError, match=r"made by a newer rosimpact \(layout 99\); update rosimpact"):
        CorpusStore(path)


def test_a_folder_cannot_be_a_store(tmp_path):
    with pytest.raises(CorpusError, match="cannot be"):
        CorpusStore(tmp_path)


def test_reports_of_a_file_that_is_not_there(tmp_path):
    with pytest.raises(CorpusError, match=r"cannot be read: No such file .*; give a JSON Lines file, or a store"):
        next(open_reports(tmp_path / "none"))


def test_moves_there_and_back_lose_nothing(path):
    with CorpusStore(path) as store:
        store.put([GatheredReport(report("old/x#1")), GatheredReport(report("old/x#2"))])
        store.take(
            "job", GatheredPage([GatheredReport(report("new/x#1"), asked="old/x#1")], {}, moved=("old/x", "new/x"))
        )
        assert [one.id for one in store.iterate_reports()] == ["new/x#1", "new/x#2"]
        assert store.report("old/x#2") == store.report("new/x#2")
        store.take(
            "job", GatheredPage([GatheredReport(report("old/x#1"), asked="new/x#1")], {}, moved=("new/x", "old/x"))
        )
        assert [one.id for one in store.iterate_reports()] == ["old/x#1", "old/x#2"]
        assert store.report("new/x#1") == store.report("old/x#1")


STEPS = st.one_of(
    st.tuples(st.just("put"), st.sampled_from(NAMES), st.sampled_from("xyz")),
    st.tuples(st.just("move"), st.sampled_from(NAMES), st.sampled_from(NAMES)),
    st.tuples(st.just("want"), st.sampled_from(NAMES), st.none()),
    st.tuples(st.just("forget"), st.sampled_from(NAMES), st.none()),
)


@settings(max_examples=60, deadline=None)
@given(st.lists(STEPS, max_size=12))
def test_whatever_happens_to_ids_no_report_is_there_twice(tmp_path_factory, steps):
    """Posted, moved, labelled, deleted in any order: ids stay unique, every text that was put last can be read by the
    id it was put under, and a store that is opened again says the same."""
    path = tmp_path_factory.mktemp("s") / "corpus.sqlite"
    with CorpusStore(path) as store:
        for what, id, other in steps:
            if what == "put":
                store.put([GatheredReport(report(id, body=other))])
                found = store.report(id)
                assert found is not None and found.body == other
            elif what == "move":
                store.put([GatheredReport(report(other), asked=id)])
                assert store.report(id) == store.report(other) is not None
            elif what == "want":
                store.want([id])
            else:
                store.forget([(id, "github")])
                assert store.report(id) is None
        before = list(store.iterate_reports())
        ids = [one.id.lower() for one in before]
        assert len(ids) == len(set(ids))
    assert (list(open_reports(path)) if path.exists() else []) == before


BLOBS = [None, 7, "text", b"", b"no zlib", zlib.compress(b"no JSON"), zlib.compress(b"[]"), zlib.compress(b'{"id": 3}')]


@pytest.mark.parametrize("value", BLOBS)
@pytest.mark.parametrize("column", ["report.report", "report.raw", "gathering.state", "report.id"])
def test_a_damaged_row_is_named(path, column, value):
    with CorpusStore(path) as store:
        store.take("job", GatheredPage([GatheredReport(report("a/b#1"), raw=b"answer")], {"after": 1}))
    table, _, name = column.partition(".")
    with contextlib.closing(sqlite3.connect(path)) as db, contextlib.suppress(sqlite3.IntegrityError):
        db.execute(f"UPDATE {table} SET {name} = ?", [value])
        db.commit()
    with CorpusStore(path) as store:
        for read in (
            lambda: list(store.iterate_reports()),
            lambda: store.report("a/b#1"),
            lambda: store.read_raw("a/b#1"),
            lambda: store.read_state("job"),
            lambda: store.take("job", GatheredPage([], {"after": 2}, moved=("a/b", "c/d"))),
        ):
            try:
                read()
            except CorpusError as error:
                assert "is damaged" in str(error) and "\n" not in str(error)


@pytest.mark.parametrize("make", [os.mkfifo, lambda path: path.symlink_to("/dev/zero")])
def test_what_is_no_file_cannot_be_a_store(tmp_path, make):
    make(tmp_path / "x")
    with pytest.raises(CorpusError, match="not a regular file"):
        CorpusStore(tmp_path / "x")
