"""A labelling session: what is offered, what answers make of labels, journal, undo, resumption."""

from __future__ import annotations

import json
import os
import random

import msgspec
import pytest
from rosimpact.corpus.labelling import (
    GivenLabel,
    Session,
    apply_answer,
    find_journal,
    list_opinions,
    read_current_labels,
    read_journal,
    select_offered,
    select_reports,
)
from rosimpact.corpus.report import BugReport, CorpusError, Label, read_labels, write_rows

UPDATE = GivenLabel("library-update", "system", "build", "compiler of the new distro refuses the alias")
MISSING = GivenLabel("dependency", "undeclared", "build", "package.xml lacks an entry")
OTHER = GivenLabel("other", None, "none", "a wish")


def report(number: int, **more) -> BugReport:
    id = f"acme/arm#{number}"
    return BugReport(
        id, f"https://github.com/acme/arm/issues/{number}", "github", "2024-05-01", f"Fault {number}", "text", **more
    )


REPORTS = [report(n) for n in range(1, 6)]


@pytest.fixture
def file(tmp_path):
    return tmp_path / "labels.jsonl"


def by_id(file):
    return {label.id: label for label in read_labels(file)}


def said(file, annotator, mode, *answers, reports=REPORTS):
    with Session(file, annotator, mode, reports) as session:
        for given in answers:
            session.record_answer(given)


def test_a_first_reading_makes_single_labels_in_the_order_of_the_reports(file):
    said(file, "ann", "first", UPDATE, OTHER)
    first, second = read_labels(file)
    assert first == Label("acme/arm#1", *msgspec.structs.astuple(UPDATE), ("library-update",), "single")
    assert (second.id, second.label, second.decided) == ("acme/arm#2", "other", "single")


def test_the_next_session_goes_on_where_the_last_stopped(file):
    said(file, "ann", "first", UPDATE, OTHER)
    with Session(file, "bob", "first", REPORTS) as session:
        assert [r.id for r in session.queue] == ["acme/arm#3", "acme/arm#4", "acme/arm#5"]


def test_what_is_put_off_comes_again_next_time(file):
    with Session(file, "ann", "first", REPORTS) as session:
        session.skip()
        session.record_answer(OTHER)
    with Session(file, "ann", "first", REPORTS) as session:
        assert [r.id for r in session.queue] == ["acme/arm#1", "acme/arm#3", "acme/arm#4", "acme/arm#5"]


@pytest.mark.parametrize(
    ("second", "decided"),
    [
        (UPDATE, "agreed"),
        (GivenLabel("library-update", "system", "build", "other words"), "agreed"),
        (MISSING, "disputed"),
        (GivenLabel("library-update", "ros", "build", "same label, other kind"), "disputed"),
        (GivenLabel("library-update", "system", "run", "same label, other phase"), "disputed"),
    ],
)
def test_a_second_reading_agrees_or_disputes(file, second, decided):
    said(file, "ann", "first", UPDATE)
    said(file, "bob", "second", second)
    label = by_id(file)["acme/arm#1"]
    assert label.decided == decided
    assert label.annotators == ("library-update", second.label)
    # Until somebody decides, the first answer stands.
    assert (label.label, label.kind, label.phase, label.why) == msgspec.structs.astuple(UPDATE)


def test_nobody_reads_second_what_they_read_first(file):
    said(file, "ann", "first", UPDATE)
    said(file, "bob", "first", OTHER)
    with Session(file, "ann", "second", REPORTS) as session:
        assert [r.id for r in session.queue] == ["acme/arm#2"]


@pytest.mark.parametrize("decided", ["single", "imported"])
def test_labels_of_others_files_can_be_read_second(file, decided):
    write_rows(file, [Label("acme/arm#3", *msgspec.structs.astuple(UPDATE), ("library-update",), decided)])
    said(file, "ann", "second", MISSING)
    assert by_id(file)["acme/arm#3"].annotators == ("library-update", "dependency")


def test_a_disagreement_is_decided_with_both_answers_in_sight(file):
    said(file, "ann", "first", UPDATE, OTHER)
    said(file, "bob", "second", MISSING, OTHER)
    with Session(file, "eve", "disagreements", REPORTS) as session:
        assert [r.id for r in session.queue] == ["acme/arm#1"]
        assert session.opinions == [UPDATE, MISSING]
        session.record_answer(MISSING)
    label = by_id(file)["acme/arm#1"]
    assert label == Label(
        "acme/arm#1", *msgspec.structs.astuple(MISSING), ("library-update", "dependency"), "adjudicated"
    )
    with Session(file, "eve", "disagreements", REPORTS) as session:
        assert session.queue == []


def test_only_the_label_is_known_of_an_answer_that_no_journal_holds():
    disputed = Label("acme/arm#1", *msgspec.structs.astuple(UPDATE), ("library-update", "other"), "disputed")
    assert list_opinions(disputed, []) == [UPDATE, GivenLabel("other", None, "", "")]


@pytest.mark.parametrize(
    ("given", "fault"),
    [
        (GivenLabel("library-update", None, "build", "x"), "kind"),
        (GivenLabel("other", "ros", "none", "x"), "kind"),
        (GivenLabel("other", None, "later", "x"), "phase"),
        (GivenLabel("bug", None, "none", "x"), "label"),
        (GivenLabel("other", None, "none", "  "), "reason"),
    ],
)
@pytest.mark.parametrize("mode", ["first", "second", "disagreements"])
def test_answers_that_break_the_guide_are_refused(given, fault, mode):
    before = Label("a/b#1", "other", None, "none", "w", ("other", "other")[: 2 - (mode == "second")], "single")
    with pytest.raises(ValueError, match=fault):
        apply_answer(None if mode == "first" else before, "a/b#1", given, mode)


def test_a_refused_answer_leaves_no_trace(file):
    with Session(file, "ann", "first", REPORTS) as session:
        with pytest.raises(ValueError):
            session.record_answer(GivenLabel("other", None, "none", ""))
        assert session.current == REPORTS[0]
    assert read_journal(find_journal(file)) == []
    assert not file.exists()


def test_undo_shows_the_report_again(file):
    with Session(file, "ann", "first", REPORTS) as session:
        session.record_answer(UPDATE)
        session.record_answer(OTHER)
        assert session.undo().id == "acme/arm#2"
        assert session.undo().id == "acme/arm#1"
        assert session.undo() is None
        assert [r.id for r in session.queue] == [r.id for r in REPORTS]
        session.record_answer(MISSING)
    assert [(label.id, label.label) for label in read_labels(file)] == [("acme/arm#1", "dependency")]


def test_undo_reaches_into_the_last_session_and_restores_what_was(file):
    said(file, "ann", "first", UPDATE)
    said(file, "bob", "second", MISSING)
    with Session(file, "bob", "second", REPORTS) as session:
        assert session.queue == []
        session.undo()
        assert session.current == REPORTS[0]
    assert by_id(file)["acme/arm#1"].decided == "single"


def test_nobody_takes_back_what_others_have_built_on(file):
    said(file, "ann", "first", UPDATE)
    said(file, "bob", "second", MISSING)
    with Session(file, "ann", "first", REPORTS) as session:
        assert session.undo() is None
    assert by_id(file)["acme/arm#1"].decided == "disputed"


def test_every_answer_is_on_disk_before_the_session_ends(file):
    session = Session(file, "ann", "first", REPORTS)
    session.record_answer(UPDATE)
    # As another process would find it, the labels file not yet written.
    assert not file.exists()
    assert read_current_labels(file)["acme/arm#1"].label == "library-update"
    session._journal.close()  # as if killed: nothing is merged
    with Session(file, "ann", "first", REPORTS) as later:
        assert later.current == REPORTS[1]
        assert by_id(file)["acme/arm#1"].label == "library-update"  # finished by the next session


def test_a_session_killed_between_labels_and_mark_changes_nothing_twice(file):
    said(file, "ann", "first", UPDATE)
    said(file, "bob", "second", MISSING)
    journal = find_journal(file)
    lines = journal.read_bytes().splitlines(keepends=True)
    journal.write_bytes(b"".join(line for line in lines if b'"merged"' not in line))
    before = read_labels(file)
    with Session(file, "eve", "first", REPORTS):
        pass
    assert read_labels(file) == before


@pytest.mark.parametrize("cut", [1, 5, 40])
def test_a_line_cut_short_by_a_crash_is_left_out(file, cut):
    said(file, "ann", "first", UPDATE)
    journal = find_journal(file)
    journal.write_bytes(journal.read_bytes() + journal.read_bytes().splitlines(keepends=True)[0][: -cut - 1])
    with Session(file, "ann", "first", REPORTS) as session:
        session.record_answer(OTHER)
    assert [label.label for label in read_labels(file)] == ["library-update", "other"]
    assert all(json.loads(line) for line in journal.read_bytes().splitlines())


def test_a_fault_in_the_middle_of_a_journal_is_named(file):
    find_journal(file).write_bytes(b'{"event": "merged"}\nnonsense\n{"event": "merged"}\n')
    with pytest.raises(CorpusError, match=r"labels\.journal\.jsonl:2"):
        Session(file, "ann", "first", REPORTS)


def test_two_sessions_cannot_write_at_once(file):
    with Session(file, "ann", "first", REPORTS), pytest.raises(CorpusError, match="another session"):
        Session(file, "bob", "first", REPORTS)
    with Session(file, "bob", "first", REPORTS) as session:
        assert session.current


def test_untouched_lines_keep_every_byte(file):
    rows = [Label(f"acme/arm#{n}", "other", None, "none", "a wish", ("other",), "single") for n in (1, 2)]
    spaced = [json.dumps(msgspec.to_builtins(row)).encode() for row in rows]
    file.write_bytes(b"\n".join(spaced) + b"\n")
    said(file, "ann", "second", OTHER)
    lines = file.read_bytes().splitlines()
    assert lines[1] == spaced[1]
    assert json.loads(lines[0])["decided"] == "agreed"
    assert lines[0].startswith(b'{"id": "acme/arm#1", "label": "other", "kind": null')


def test_the_file_keeps_its_permissions_and_its_link(file, tmp_path):
    said(file, "ann", "first", UPDATE)
    os.chmod(file, 0o640)
    link = tmp_path / "elsewhere" / "labels.jsonl"
    link.parent.mkdir()
    link.symlink_to(file)
    said(link, "ann", "first", OTHER)
    assert file.stat().st_mode & 0o777 == 0o640
    assert link.is_symlink()
    assert len(read_labels(file)) == 2


def test_edits_by_hand_after_a_session_stay(file):
    said(file, "ann", "first", UPDATE)
    file.write_text(file.read_text().replace("compiler of the new distro", "clang"))
    with Session(file, "ann", "first", REPORTS) as session:
        session.record_answer(OTHER)
    assert by_id(file)["acme/arm#1"].why.startswith("clang")


def test_the_journal_knows_who_looked_at_a_suggestion(file):
    with Session(file, "ann", "first", REPORTS) as session:
        session.note_suggestion_seen()
        session.record_answer(UPDATE)
        session.record_answer(OTHER)
    answers = [event for event in read_journal(find_journal(file)) if event.event == "answer"]
    assert [(event.annotator, event.suggested) for event in answers] == [("ann", True), ("ann", False)]
    assert b"ann" not in file.read_bytes().replace(b"annotators", b"")


def test_only_the_reports_asked_for():
    elsewhere = BugReport("ros-answers:7", "https://answers.ros.org/question/7", "ros-answers", None, "t", "b")
    copy = report(9, same_as="acme/arm#1")
    everything = [*REPORTS[:2], elsewhere, copy, REPORTS[0]]
    assert [r.id for r in select_reports(everything, (), ())] == ["acme/arm#1", "acme/arm#2", "ros-answers:7"]
    assert select_reports(everything, ("ros-answers",), ()) == [elsewhere]
    assert select_reports(everything, (), ("Acme/Arm",)) == REPORTS[:2]
    assert select_offered([], {}, [], "first", "ann") == []


@pytest.mark.parametrize("seed", range(8))
def test_whatever_is_pressed_labels_are_what_the_journal_says(file, seed):
    """Random answers, undos, put-offs and kills by several people: the journal, replayed, gives the file."""
    chance = random.Random(seed)
    for _ in range(12):
        mode = chance.choice(["first", "second", "disagreements"])
        session = Session(file, chance.choice(["ann", "bob", "eve"]), mode, REPORTS)
        for _ in range(chance.randrange(6)):
            move = chance.random()
            if move < 0.25:
                session.undo()
            elif session.current and move < 0.35:
                session.skip()
            elif session.current:
                session.record_answer(chance.choice([UPDATE, MISSING, OTHER]))
        expected = dict(session.labels)
        if chance.random() < 0.5:
            session._journal.close()  # killed
        else:
            session.__exit__(None, None, None)
        assert read_current_labels(file) == expected
    replayed = {}
    for event in read_journal(find_journal(file)):
        row = event.after if event.event == "answer" else event.before
        if event.event != "merged":
            replayed[event.id] = row
    assert {id: row for id, row in replayed.items() if row} == read_current_labels(file)
