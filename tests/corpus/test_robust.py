"""`rosimpact corpus import robust`: records in ROBUST's format, written for these tests, and what they map to."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest
from rosimpact.corpus.report import find_faults, read_labels
from rosimpact.corpus.robust import (
    describe_licence,
    find_report,
    judge_record,
    make_rows,
    map_record,
    read_robust,
    summarize,
)

RECORD = """%YAML 1.1
---
id: {id}
title: {title}
description: >
  The arm's node looks for a thing that it
  does not name.
classification: {classification}
keywords: {keywords}
system: arm
severity: {severity}
links: []
bug:
  phase: {phase}
  specificity: ROS-specific
  architectural-location: application-specific code
  application: null
  task: N/A
  subsystem: driver
  package: ['acme/arm/arm_driver']
  languages:
    - C++
  detected-by: build system
  reported-by: guest user
  issue: {issue}
  time-reported: 2014-08-22T20:38:36Z
  reproducibility: always
  trace: null
fix:
  pull-request: {pull}
  fix-in: ['arm_driver/package.xml']
  languages:
    - Package XML
  time: 2014-08-25 (02:04)
{codes}"""


def write(folder, id, faults=(), failures=(), *, title="A fault", classification="A class (no CWE)", keywords="['arm']",
          severity="error", phase="build", issue="null", pull="null"):  # fmt: skip
    lines = []
    for name, codes in (("fault-codes", faults), ("failure-codes", failures)):
        if codes:
            lines += [f"{name}:", *(f"  - {code}" for code in codes)]
    path = folder / "arm" / id / f"{id}.bug"
    path.parent.mkdir(parents=True, exist_ok=True)
    text = RECORD.format(id=id, title=title, classification=classification, keywords=keywords, severity=severity,
                         phase=phase, issue=issue, pull=pull, codes="\n".join(lines))  # fmt: skip
    path.write_text(text + "\n")
    return path


def one(folder):
    (found,) = read_robust(folder).mapped
    return found


BUILD = ("SOFTWARE:BUILD", "SYSTEM:NONE")
CRASH = ("SOFTWARE:CRASHING", "SYSTEM:UNRESPONSIVE")
WRONG = ("SOFTWARE:BEHAVIORAL", "SYSTEM:BEHAVING-INCORRECTLY")


@pytest.mark.parametrize(
    ("faults", "failures", "classification", "words", "expected"),
    [
        # Something changed: library-update. What changed gives the kind, by its code or by words.
        (["EVOLUTION:PACKAGE"], BUILD, "API Incompatibility", "", ("library-update", "ros", "sure")),
        (["EVOLUTION:LANGUAGE"], BUILD, "Type error", "", ("library-update", "system", "sure")),
        (["EVOLUTION:FIRMWARE"], CRASH, "", "", ("library-update", "robot", "sure")),
        (["EVOLUTION:LIBRARY"], BUILD, "", "boost cast", ("library-update", "system", "likely")),
        (["EVOLUTION:DEPRECATION"], BUILD, "", "gazebo, sdf", ("library-update", "robot", "likely")),
        (["EVOLUTION:PATHS"], BUILD, "", "mesh", ("library-update", "ros", "likely")),
        (["BDO:DEPENDENCY", "EVOLUTION:LIBRARY"], BUILD, "", "", ("library-update", "ros", "likely")),
        (["CONFIG:REMAPPING", "EVOLUTION:PACKAGE"], WRONG, "", "", ("library-update", "ros", "likely")),
        # Dependencies.
        (["BDO:DEPENDENCY"], BUILD, "Missing Dependency", "Missing", ("dependency", "undeclared", "sure")),
        (["BDO:DEPENDENCY"], CRASH, "Run-time dependency issue", "wrong use", ("dependency", "undeclared", "likely")),
        (["BDO:DEPENDENCY"], BUILD, "Missing Include / Dependency", "missing", ("dependency", "undeclared", "likely")),
        (["BDO:DEPENDENCY"], BUILD, "Circular Dependencies", "", ("dependency", "wrong", "sure")),
        (["BDO:DEPENDENCY"], BUILD, "run-time dependency", "meta-package", ("dependency", "wrong", "sure")),
        (["BDO:BUILD", "BDO:DEPENDENCY"], BUILD, "Missing Dependency", "gencpp", ("dependency", "build-order", "sure")),
        (["BDO:BUILD"], BUILD, "Missing Build Dependency", "", ("dependency", "undeclared", "likely")),
        # A package's own files that are not installed are no dependency, nor is a slip in a build file.
        (["BDO:BUILD"], BUILD, "Missing Installation Dependencies", "", ("other", None, "likely")),
        (["BDO:DEPENDENCY"], BUILD, "Missing Installation Dependencies", "", ("other", None, "likely")),
        (["BDO:BUILD"], BUILD, "Syntax Error", "", ("other", None, "likely")),
        # Two sides.
        (["CONFIG:TOPIC"], WRONG, "", "", ("inconsistency", "connection", "likely")),
        (["MODELS:TRANSFORMATIONS"], WRONG, "", "", ("inconsistency", "frame-time", "likely")),
        # One process alone, as far as the failure tells.
        (["CONCURRENCY:NO-SYNC"], CRASH, "", "", ("other", None, "likely")),
        (["MODELS:ROBOT"], WRONG, "", "", ("other", None, "likely")),
        # What only the report can tell.
        (["PROGRAMMING:LOGIC"], WRONG, "", "", (None, None, "unmapped")),
        (["PROGRAMMING:UNINITIALISED"], ("SOFTWARE:NETWORK",), "", "", (None, None, "unmapped")),
        (["CONFIG:PARAM"], WRONG, "", "", (None, None, "unmapped")),
        (["SYSTEMS:OS"], BUILD, "", "", (None, None, "unmapped")),
        (["CONFIG:REMAPPING", "BDO:DEPENDENCY"], WRONG, "", "", (None, None, "unmapped")),
        (["NOT-A-BUG"], (), "", "", (None, None, "unmapped")),
        ([], (), "", "", (None, None, "unmapped")),
    ],
)  # fmt: skip
def test_what_codes_say(faults, failures, classification, words, expected):
    assert judge_record(faults, failures, f"{classification} (no CWE)", words)[:3] == expected


@pytest.mark.parametrize(
    ("phase", "failures", "severity", "expected"),
    [
        ("build", BUILD, "error", "build"),
        ("startup", CRASH, "error", "run"),
        ("runtime", WRONG, "error", "run"),
        ("deployment", CRASH, "error", "install"),
        ("does not apply", BUILD, "error", "none"),
        ("build", ("SOFTWARE:NONE", "SYSTEM:NONE"), "bad-smell", "none"),
        ("unknown", BUILD, "error", None),
    ],
)
def test_phases(tmp_path, phase, failures, severity, expected):
    write(tmp_path, "a1b2c3d", ["EVOLUTION:PACKAGE"], failures, phase=phase, severity=severity)
    assert one(tmp_path).phase == expected


@pytest.mark.parametrize(
    ("text", "id"),
    [
        ("https://github.com/Acme/arm/issues/12", "Acme/arm#12"),
        ("https://github.com/acme/arm/pull/3 | https://github.com/acme/leg/issues/4", "acme/arm#3"),
        ("http://answers.ros.org/question/194/the-slug/ | https://github.com/acme/arm/issues/4", "ros-answers:194"),
        ("https://groups.google.com/forum/#!topic/x", ""),
        ("N/A", ""),
    ],
)
def test_the_report_a_record_is_about(text, id):
    assert find_report(text) == id


def test_without_an_issue_the_pull_request_is_the_report_and_else_the_record(tmp_path):
    write(tmp_path, "1111111", issue="N/A", pull="https://github.com/acme/arm/pull/9")
    write(tmp_path, "2222222", issue="null")
    assert [found.id for found in read_robust(tmp_path).mapped] == ["acme/arm#9", "robust:2222222"]


@pytest.mark.parametrize("id", ["1e09040", "4089660", "0829607", "0x1f2e3"])
def test_commits_that_look_like_numbers_stay_what_they_are(tmp_path, id):
    write(tmp_path, id)
    assert one(tmp_path).record == id


def test_the_file_name_counts_where_the_id_inside_is_another_records(tmp_path):
    path = write(tmp_path, "aaaaaaa")
    path.write_text(path.read_text().replace("id: aaaaaaa", "id: bbbbbbb"))
    assert one(tmp_path).record == "aaaaaaa"


def test_nothing_of_a_records_text_is_taken(tmp_path):
    write(tmp_path, "a1b2c3d", ["BDO:DEPENDENCY"], BUILD, title="Secret title", classification="Missing Dependency")
    (row,) = make_rows(read_robust(tmp_path).mapped)
    assert "Secret" not in str(row) and "looks for" not in str(row)


def test_records_of_one_report_that_differ_make_no_label(tmp_path):
    issue = "https://github.com/acme/arm/issues/5"
    write(tmp_path, "1111111", ["EVOLUTION:PACKAGE"], BUILD, issue=issue)
    write(tmp_path, "2222222", ["BDO:BUILD"], BUILD, issue=issue)
    records = read_robust(tmp_path)
    assert list(make_rows(records.mapped)) == []
    assert summarize(records.mapped)["library-update"] == {"sure": 1, "likely": 0, "unmapped": 0}


@pytest.mark.parametrize("bug", ["bug: null", "bug: text", "bug: {issue: [1, 2], phase: {a: b}}", "bug: {}"])
def test_odd_records_are_unmapped_and_no_crash(tmp_path, bug):
    (tmp_path / "x.bug").write_text(f"id: 5\nfault-codes: {{a: b}}\nkeywords: one, two\nfix: []\n{bug}\n")
    assert one(tmp_path).confidence == "unmapped"


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        (b"title: [", "is no YAML in line"),
        (b"- a list", "no `bug`"),
        (b"\xff\xfe\x00", "is no YAML"),
        (b"a: " + b"[" * 100_000, "is n"),
    ],
)
def test_a_file_that_cannot_be_read_is_named_and_passed_over(tmp_path, text, fault):
    write(tmp_path, "a1b2c3d")
    (tmp_path / "bad.bug").write_bytes(text)
    records = read_robust(tmp_path)
    assert len(records.mapped) == 1
    ((path, told),) = records.unreadable
    assert path.name == "bad.bug" and fault in told


def test_the_licence_is_what_the_clone_says(tmp_path):
    assert "no licence file" in describe_licence(tmp_path)
    (tmp_path / "LICENSE.md").write_text("\n\nApache License\nmore")
    assert describe_licence(tmp_path) == "licence: LICENSE.md (Apache License)"


def test_a_missing_field_is_no_error():
    assert map_record({"bug": {}}, "abc").id == "robust:abc"


# -- the command -------------------------------------------------------------------------------------------------------


def test_the_command_writes_labels_that_read_back(say, tmp_path):
    write(tmp_path, "1111111", ["EVOLUTION:PACKAGE"], BUILD, issue="https://github.com/acme/arm/issues/5")
    write(tmp_path, "2222222", ["PROGRAMMING:LOGIC"], WRONG)
    output = tmp_path / "out" / "robust.jsonl"
    said = say("corpus", "import", "robust", tmp_path, "--output", output)
    assert said.status == 0, said.err
    assert "2 records" in said.out and "unmapped" in said.out
    assert "licence: the clone has no licence file" in said.err
    (label,) = read_labels(output)
    assert (label.id, label.label, label.kind, label.phase) == ("acme/arm#5", "library-update", "ros", "build")
    assert (label.decided, label.annotators, find_faults(label)) == ("imported", ("library-update",), "")
    (row,) = map(json.loads, output.read_text().splitlines())
    assert (row["confidence"], row["record"]) == ("sure", "1111111")


def test_json_tells_of_every_record(say, tmp_path):
    write(tmp_path, "2222222", ["PROGRAMMING:LOGIC"], WRONG)
    (row,) = json.loads(say("corpus", "import", "robust", tmp_path, "--format", "json").out)
    assert (row["label"], row["confidence"], row["codes"]) == (None, "unmapped", ["PROGRAMMING:LOGIC"])


@pytest.mark.parametrize("where", ["nowhere", "empty"])
def test_no_records_is_one_line_that_says_what_to_give(say, tmp_path, where):
    (tmp_path / "empty").mkdir()
    said = say("corpus", "import", "robust", tmp_path / where)
    assert said.status == 2
    assert "give a clone of" in said.err and len(said.err.splitlines()) == 1


@pytest.mark.skipif("ROSIMPACT_ROBUST" not in os.environ, reason="set ROSIMPACT_ROBUST to a clone of ROBUST")
def test_the_real_records_map_as_the_documentation_says():
    records = read_robust(Path(os.environ["ROSIMPACT_ROBUST"]))
    assert records.unreadable == []
    assert {name: sum(counts.values()) for name, counts in summarize(records.mapped).items()} == {
        "dependency": 43,
        "inconsistency": 12,
        "library-update": 34,
        "other": 55,
        "unmapped": 77,
    }
