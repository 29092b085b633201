"""Files of others that mean harm are one error, or are left out and named; nothing hangs or is written through."""

from __future__ import annotations

import io
import os
import sqlite3
import tarfile
import zipfile

import pytest
from rosimpact.classifier.model import ClassifierError, load
from rosimpact.corpus.gather import find_service, gather
from rosimpact.corpus.labelling import Session
from rosimpact.corpus.report import BugReport, CorpusError, read_reports, write_rows
from rosimpact.corpus.robust import read_robust
from rosimpact.corpus.sources.markup import convert_to_markdown
from rosimpact.corpus.sources.ros_answers import Archive, SavedPages
from rosimpact.corpus.store import CorpusStore, GatheredReport, open_reports
from rosimpact.impact.cli.app import app
from server import archived
from typer.testing import CliRunner

ROW = BugReport("o/r#1", "https://github.com/o/r/issues/1", "github", None, "t", "b")


def tar(path, members) -> None:
    with tarfile.open(path, "w:gz") as file:
        for name, kind, data in members:
            member = tarfile.TarInfo(f"answers-archive-HEAD/content/question/{name}")
            member.type, member.size, member.linkname = kind, len(data), "/etc/passwd"
            file.addfile(member, io.BytesIO(data))


def test_a_link_or_pipe_in_an_archive_hides_no_question(tmp_path):
    tar(tmp_path / "a.tar.gz", [("1.md", tarfile.SYMTYPE, b""), ("2.md", tarfile.FIFOTYPE, b""),
                                ("3.md", tarfile.LNKTYPE, b""), ("10.md", tarfile.REGTYPE, archived(10))])  # fmt: skip
    with CorpusStore(tmp_path / "corpus.sqlite") as store:
        gather(Archive(tmp_path / "a.tar.gz"), store)
        assert [report.id for report in store.iterate_reports()] == ["ros-answers:10"]


def test_an_archive_that_unpacks_without_end_is_refused(tmp_path):
    member = tarfile.TarInfo("x/content/question/1.md")
    member.size = 1 << 40
    (tmp_path / "a.tar").write_bytes(member.tobuf(tarfile.GNU_FORMAT) + bytes(10_000))
    with CorpusStore(tmp_path / "corpus.sqlite") as store, pytest.raises(CorpusError, match="is damaged"):
        gather(Archive(tmp_path / "a.tar"), store)


def test_links_pipes_and_large_files_of_a_clone_are_named_and_the_rest_is_read(tmp_path):
    folder = tmp_path / "content" / "question"
    folder.mkdir(parents=True)
    (tmp_path / "secret").write_bytes(archived(1, body="secret"))
    (folder / "1.md").symlink_to(tmp_path / "secret")
    os.mkfifo(folder / "2.md")
    with open(folder / "3.md", "wb") as file:
        file.truncate(3 << 30)
    (folder / "4.md").write_bytes(archived(4))
    source = Archive(tmp_path)
    with CorpusStore(tmp_path / "corpus.sqlite") as store:
        gather(source, store)
        assert [report.id for report in store.iterate_reports()] == ["ros-answers:4"]
    assert len(source.unread) == 3


def test_a_folder_without_pages_is_an_error(tmp_path):
    with pytest.raises(CorpusError, match=r"holds no \*\.html"):
        list(SavedPages(tmp_path).read_pages(None))


@pytest.mark.parametrize(
    "content",
    [
        b"bug: [&a [x,x,x,x,x,x,x,x,x]" + b"".join(b", &%c [%s]" % (98 + n, b",".join([b"*%c" % (97 + n)] * 9))
                                                 for n in range(9)) + b"]",
        b"bug: " + b"[" * 100_000,
        b"bug: \xff\xfe",
        b"a: 1\n: : :",
    ],
    ids=["aliases", "deep", "bytes", "broken"],
)  # fmt: skip
def test_a_hostile_record_of_robust_is_passed_over(content, tmp_path):
    (tmp_path / "bad.bug").write_bytes(content)
    (tmp_path / "good.bug").write_text("bug: {phase: build}\nfault-codes: ['BDO:DEPENDENCY']\n")
    os.mkfifo(tmp_path / "pipe.bug")
    (tmp_path / "link.bug").symlink_to("/proc/self/environ")
    (tmp_path / "LICENSE").symlink_to("/etc/passwd")
    records = read_robust(tmp_path)
    assert [found.record for found in records.mapped] == ["good"]
    assert {path.name for path, _ in records.unreadable} == {"bad.bug", "pipe.bug", "link.bug"}
    assert "root" not in records.licence


@pytest.mark.parametrize("depth", [100, 1_000, 50_000])
def test_nested_html_is_text_at_worst(depth):
    assert "deep" in convert_to_markdown("<div>" * depth + "deep" + "</div>" * depth)


@pytest.mark.parametrize("content", [b"[" * 100_000, b'{"id": "\\ud800"}', b"\xff", b"9" * 5_000])
def test_a_line_that_is_no_report(content, tmp_path):
    (tmp_path / "r.jsonl").write_bytes(content)
    with pytest.raises(CorpusError, match=r"r\.jsonl:1: is no report"):
        list(read_reports(tmp_path / "r.jsonl"))


def test_a_pipe_is_no_file_of_reports_and_no_store(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for read in (lambda: list(open_reports(tmp_path / "pipe")), lambda: CorpusStore(tmp_path / "pipe")):
        with pytest.raises(CorpusError, match="not a regular file"):
            read()


@pytest.mark.parametrize(
    "harm",
    ["UPDATE report SET report = x'00'", "UPDATE report SET report = 'text'", "UPDATE gathering SET state = x'5b'",
     "CREATE VIEW v AS SELECT 1", "DROP TABLE copy"],
)  # fmt: skip
def test_a_damaged_store_is_an_error_and_stays(harm, tmp_path):
    path = tmp_path / "corpus.sqlite"
    with CorpusStore(path) as store:
        store.put([GatheredReport(ROW)])
        store._db.execute("INSERT INTO gathering VALUES ('x', '{}', 1, 1)")
    with sqlite3.connect(path) as db:
        db.execute(harm)
    db.close()
    before = path.read_bytes()
    with pytest.raises(CorpusError, match=r"corpus\.sqlite: (is|cannot be)"), CorpusStore(path) as store:
        store.read_state("x")
        list(store.iterate_reports())
    assert path.read_bytes() == before


def test_nothing_is_written_through_a_link(tmp_path):
    (tmp_path / "target").write_text("kept")
    for name in ("r.jsonl", "l.journal.jsonl"):
        (tmp_path / name).symlink_to(tmp_path / "target")
    with pytest.raises(CorpusError, match="is a link"):
        write_rows(tmp_path / "r.jsonl", [ROW])
    with pytest.raises(CorpusError, match="is a link"):
        Session(tmp_path / "l.jsonl", "ann", "first", [])
    assert (tmp_path / "target").read_text() == "kept"


def test_a_model_that_unpacks_to_too_much_is_refused(tmp_path):
    with (
        zipfile.ZipFile(tmp_path / "m.npz", "w", zipfile.ZIP_DEFLATED, compresslevel=1) as file,
        file.open("about.npy", "w") as member,
    ):
        for _ in range(600):
            member.write(bytes(1 << 20))
    with pytest.raises(ClassifierError, match="unpacks to more than 512 MB"):
        load(tmp_path / "m.npz")
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(ClassifierError, match="not a regular file"):
        load(tmp_path / "pipe")


@pytest.mark.parametrize("id", ["ros-answers:" + "9" * 5_000, "ros-answers:\u00b2", "robotics-se:", "x:1"])
def test_an_id_of_no_source(id):
    assert find_service(id) == ""


@pytest.mark.parametrize("wait", ["nan", "inf", "-inf", "-1"])
def test_a_wait_that_is_no_number_of_minutes(wait):
    assert CliRunner().invoke(app, ["corpus", "gather", "github:o/r", "--wait", wait]).exit_code == 2


def test_a_repository_of_which_nothing_is_there_is_an_error(tmp_path):
    write_rows(tmp_path / "r.jsonl", [ROW])
    given = ["corpus", "label", "--list", "--reports", str(tmp_path / "r.jsonl"), "--labels", str(tmp_path / "l.jsonl")]
    assert CliRunner().invoke(app, [*given, "--repository", "O/R"]).exit_code == 0
    result = CliRunner().invoke(app, [*given, "--repository", "o/nosuch"])
    assert result.exit_code == 2 and "--repository o/nosuch: no report is of it" in result.stderr
