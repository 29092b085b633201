"""`rosimpact corpus stats`: tables, notes, JSON, text and plots."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from xml.etree import ElementTree

import pytest
from rosimpact.corpus.report import BugReport, Label, read_labels, write_rows
from rosimpact.corpus.stats import compute_stats, find_project, find_year


def label(id, name, kind=None, phase="run", annotators=None, decided="single"):
    return Label(id, name, kind, phase, "why", tuple(annotators or [name]), decided)


LABELS = [
    label("Acme/Arm#1", "library-update", "ros", "build", ["library-update"] * 2, "agreed"),
    label("acme/arm#2", "dependency", "undeclared", "build"),
    label("acme/leg#1", "other", annotators=["other", "dependency"], decided="adjudicated"),
    label("ros-answers:7", "inconsistency", "value", annotators=["inconsistency"] * 2, decided="agreed"),
]
REPORTS = [
    BugReport("Acme/Arm#1", "", "github", "2021-03-04", "After upgrading to noetic", "worked on melodic"),
    BugReport("acme/arm#2", "", "github", None, "No rosdep key", ""),
    BugReport("ros-answers:7", "", "ros-answers", "Jul 3, 2013", "Units", "degrees"),
    BugReport("acme/none#9", "", "github", "2020-01-01", "without a label", "noetic"),
]


def row(**counts):
    names = ("library-update", "dependency", "inconsistency", "message-logic", "other")
    return {name: counts.get(name.replace("-", "_"), 0) for name in names}


def test_tables():
    found = compute_stats(LABELS, REPORTS)
    assert (found.reports, found.read) == (4, 3)
    assert found.labels == row(library_update=1, dependency=1, inconsistency=1, other=1)
    assert found.kinds["dependency"] == {"undeclared": 1, "unavailable": 0, "build-order": 0, "wrong": 0}
    assert found.phases == {"build": row(library_update=1, dependency=1), "run": row(inconsistency=1, other=1)}
    assert found.years == {
        "2013": row(inconsistency=1),
        "2021": row(library_update=1),
        "undated": row(dependency=1),
    }
    assert found.distros == {
        "melodic": row(library_update=1),
        "noetic": row(library_update=1),
        "none named": row(dependency=1, inconsistency=1),
    }
    assert list(found.projects) == ["acme/arm", "ROS Answers", "acme/leg"]  # the largest first
    assert found.decided["agreed"] == row(library_update=1, inconsistency=1)
    assert found.notes == ("years and distros: 1 text of 4 not at hand",)


def test_agreement_is_over_reports_with_two_annotators():
    found = compute_stats(LABELS).agreement
    assert (found.reports, found.same) == (3, 2)
    assert found.confusion["other"]["dependency"] == 1


def test_without_texts_years_and_distros_are_not_guessed():
    found = compute_stats(LABELS)
    assert found.years is None and found.distros is None
    assert "give those with --reports" in found.notes[0]


def test_every_label_of_the_corpus_is_counted_once_in_each_table():
    labels = read_labels()
    found = compute_stats(labels)
    for table in (found.phases, found.projects, found.decided):
        assert sum(sum(counts.values()) for counts in table.values()) == len(labels) == found.reports
    assert sum(sum(kinds.values()) for kinds in found.kinds.values()) == sum(bool(x.kind) for x in labels)


@pytest.mark.parametrize(
    ("id", "project"),
    [
        ("Acme/Arm#1", "acme/arm"),
        ("https://api.github.com/repos/acme/arm/issues/3", "acme/arm"),
        ("ros-answers:7", "ROS Answers"),
        ("robotics-se:7", "Robotics Stack Exchange"),
        ("robust:0027b57", "robust"),
    ],
)
def test_projects(id, project):
    assert find_project(id) == project


@pytest.mark.parametrize(
    ("date", "year"), [("2024-05-01", "2024"), ("Jul 3, 2013", "2013"), (None, ""), ("May 5", ""), ("12345", "")]
)
def test_years(date, year):
    assert find_year(date) == year


# -- the command -------------------------------------------------------------------------------------------------------


@pytest.fixture
def files(tmp_path, monkeypatch):
    monkeypatch.setenv("ROSIMPACT_CORPUS", str(tmp_path / "no-store"))
    write_rows(tmp_path / "labels.jsonl", LABELS)
    write_rows(tmp_path / "reports.jsonl", REPORTS)
    return tmp_path


def test_text_on_a_pipe_has_no_colours_and_cuts_nothing(say, files):
    long = "acme/" + "very_" * 16 + "long"
    write_rows(files / "labels.jsonl", [*LABELS, label(f"{long}#1", "other")])
    said = say("corpus", "stats", "--labels", files / "labels.jsonl", "--reports", files / "reports.jsonl")
    assert said.status == 0, said.err
    assert "\x1b" not in said.out
    assert long in said.out
    for part in ("5 labels", "noetic", "2013", "undeclared", "adjudicated", "2 the same, 66.7 %", "analytic", "Wilson"):
        assert part in said.out


def test_text_where_only_ascii_can_be_shown(files):
    command = [sys.executable, "-c", "from rosimpact.impact.cli.app import main; main()", "corpus", "stats", "--labels"]
    said = subprocess.run(
        [*command, str(files / "labels.jsonl")],
        env={**os.environ, "PYTHONIOENCODING": "ascii"},
        capture_output=True,
        text=True,
    )
    assert (said.returncode, said.stderr) == (0, "")
    assert "4 labels" in said.stdout


def test_json(say, files):
    said = say("corpus", "stats", "--labels", files / "labels.jsonl", "--format", "json")
    rows = json.loads(said.out)
    assert (rows["schema"], rows["reports"], rows["years"]) == (1, 4, None)
    assert set(rows["agreement"]["kappa"]) == {"value", "low", "high"}
    assert "analytic" in rows["kappa_interval"]


def test_plots_are_the_same_each_time(say, files):
    pytest.importorskip("matplotlib")
    for folder in ("one", "two"):
        said = say("corpus", "stats", "--labels", files / "labels.jsonl", "--reports", files / "reports.jsonl",
                   "--plots", files / folder)  # fmt: skip
        assert (said.status, said.err) == (0, f"14 plots in {files / folder}\n")
    names = {path.name for path in (files / "one").iterdir()}
    expected = ("labels", "kinds", "phases", "projects", "years", "distros", "agreement")
    assert names == {f"{name}.{kind}" for name in expected for kind in ("svg", "png")}
    for name in names:
        data = (files / "one" / name).read_bytes()
        assert data == (files / "two" / name).read_bytes()
        if name.endswith("svg"):
            assert ElementTree.fromstring(data).tag.endswith("svg")
        else:
            assert data.startswith(b"\x89PNG")


def test_one_is_one(say, files):
    write_rows(files / "labels.jsonl", LABELS[:1])
    said = say("corpus", "stats", "--labels", files / "labels.jsonl")
    assert said.out.startswith("1 label\n")
    assert "agreement over 1 report with two annotators" in said.out


def test_plots_without_numbers_are_left_out(say, files):
    pytest.importorskip("matplotlib")
    write_rows(files / "labels.jsonl", [label("a/b#1", "other")])
    said = say("corpus", "stats", "--labels", files / "labels.jsonl", "--plots", files / "plots")
    assert said.status == 0, said.err
    assert {path.stem for path in (files / "plots").iterdir()} == {"labels", "phases", "projects"}


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--format", "xml"], "choose text or json"),
        (["--labels", "nowhere.jsonl"], "nowhere.jsonl: is not there; give a labels file"),
        (["--reports", "nowhere.jsonl"], "nowhere.jsonl: cannot be read"),
        (["--plots", "{tmp}/labels.jsonl/x"], "x: cannot be written: Not a directory; give another folder"),
        (["--plots", "{tmp}/labels.jsonl"], "labels.jsonl: cannot be written: Not a directory; give another folder"),
    ],
)
def test_errors(say, files, arguments, told):
    said = say("corpus", "stats", *[a.replace("{tmp}", str(files)) for a in arguments])
    assert (said.status, said.out) == (2, "")
    assert told in said.err and "Traceback" not in said.err


def test_without_matplotlib_the_extra_is_named(say, files, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    said = say("corpus", "stats", "--labels", files / "labels.jsonl", "--plots", files / "plots")
    assert (said.status, said.out) == (2, "")
    assert "rosimpact[study]" in said.err


def test_no_labels_at_all(say, files):
    (files / "labels.jsonl").write_text("")
    said = say("corpus", "stats", "--labels", files / "labels.jsonl")
    assert said.status == 0
    assert "no report was read by two annotators" in said.out
