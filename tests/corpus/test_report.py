"""Reports and labels: what their files may hold, and what is said of those that hold something else."""

import msgspec
import pytest
from rosimpact.corpus.report import (
    KINDS,
    LABELS,
    BugReport,
    CorpusError,
    Label,
    find_faults,
    find_repository,
    read_labels,
    read_reports,
    write_rows,
)

REPORT = BugReport("a/b#1", "https://github.com/a/b/issues/1", "github", "2024-01-31", "It stopped", "after the update")
LABEL = Label("a/b#1", "library-update", "ros", "run", "stopped after an update", ("library-update",), "single")


@pytest.mark.parametrize(
    ("id", "repository"),
    [
        ("ros/ros_comm#12", "ros/ros_comm"),
        ("Ros/Ros_Comm#12", "ros/ros_comm"),
        ("https://api.github.com/repos/a/b.c/issues/72", "a/b.c"),
        ("https://api.github.com/repos/a/b/pulls/7", "a/b"),
        ("ros-answers:10010", ""),
        ("robotics-se:98659", ""),
        ("a/b", ""),
        ("a/b/c#1", ""),
    ],
)
def test_repository_of(id, repository):
    assert find_repository(id) == repository
    assert msgspec.structs.replace(REPORT, id=id).group == (repository or id)


def test_rows_come_back_as_they_were_written(tmp_path):
    reports = [REPORT, msgspec.structs.replace(REPORT, id="ros-answers:3", date=None, tags=("tf", "π"), body="\0\n")]
    assert write_rows(tmp_path / "new/reports.jsonl", reports) == 2
    assert list(read_reports(tmp_path / "new/reports.jsonl")) == reports
    assert write_rows(tmp_path / "labels.jsonl", [LABEL]) == 1
    assert read_labels(tmp_path / "labels.jsonl") == [LABEL]


def test_writing_is_whole_or_not_at_all(tmp_path):
    file = tmp_path / "reports.jsonl"
    write_rows(file, [REPORT])

    def rows():
        yield REPORT
        raise RuntimeError

    with pytest.raises(RuntimeError):
        write_rows(file, rows())
    assert list(read_reports(file)) == [REPORT]
    assert [path.name for path in tmp_path.iterdir()] == ["reports.jsonl"]


@pytest.mark.parametrize(
    ("change", "fault"),
    [
        ({}, ""),
        ({"label": "bug"}, "the label `bug`"),
        ({"kind": "undeclared"}, "the kind `undeclared`"),
        ({"kind": None}, "the kind `None`"),
        ({"label": "other", "kind": "ros"}, "none of null"),
        ({"label": "other", "kind": None}, ""),
        ({"phase": "test"}, "the phase `test`"),
        ({"annotators": ()}, "no annotator"),
        ({"annotators": ("other", "bug")}, "or one that is none"),
    ],
)
def test_what_breaks_the_rules_of_the_guide(change, fault):
    said = find_faults(msgspec.structs.replace(LABEL, **change))
    assert (fault in said) if fault else said == ""


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (["{"], ":1: is no label"),
        (["", '{"id": "a"}'], ":2: is no label"),
        (["[]"], ":1: is no label"),
        ([b"\xff"], ":1: is no label"),
    ],
)
def test_a_file_that_holds_something_else_is_named_with_its_line(tmp_path, lines, message):
    file = tmp_path / "labels.jsonl"
    file.write_bytes(b"\n".join(line if isinstance(line, bytes) else line.encode() for line in lines))
    with pytest.raises(CorpusError, match=r"labels\.jsonl") as raised:
        read_labels(file)
    assert message in str(raised.value)


def test_an_id_stands_once(tmp_path):
    write_rows(tmp_path / "labels.jsonl", [LABEL, LABEL])
    with pytest.raises(CorpusError, match=r":2: `a/b#1` is there twice"):
        read_labels(tmp_path / "labels.jsonl")


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(CorpusError, match=r"none\.jsonl: cannot be read"):
        list(read_reports(tmp_path / "none.jsonl"))


def test_the_corpus_keeps_its_own_rules():
    labels = read_labels()
    assert len(labels) == 1630
    assert {label.label for label in labels} == set(LABELS)
    assert {label.kind for label in labels if label.kind} == {kind for kinds in KINDS.values() for kind in kinds}
    assert all(len(label.annotators) == 1 + label.twice for label in labels)
    assert all(label.twice == (label.decided != "single") for label in labels)


def test_a_byte_order_mark_is_no_fault(tmp_path):
    write_rows(tmp_path / "labels.jsonl", [LABEL])
    data = (tmp_path / "labels.jsonl").read_bytes()
    (tmp_path / "labels.jsonl").write_bytes(b"\xef\xbb\xbf" + data)
    assert read_labels(tmp_path / "labels.jsonl") == [LABEL]
