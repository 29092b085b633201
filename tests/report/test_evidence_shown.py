"""What a finding rests on, in each format: a few lines for a person, everything for programs."""

import json

import pytest
from rosimpact.impact.analysis.findings import format_baseline
from rosimpact.impact.report import evidence, github, html, markdown, sarif, text
from rosimpact.impact.report import json as json_report
from rosimpact.impact.report.style import PLAIN
from rosimpact.impact.rules.rule import Finding
from rosimpact.impact.targets.evidence_record import Evidence, OnTarget

jsonschema = pytest.importorskip("jsonschema")

PAIR = Evidence(
    "rclcpp",
    "changed",
    "rclcpp::Node::create",
    old=("void rclcpp::Node::create(int)",),
    new=("void rclcpp::Node::create(int, int)",),
    last="27.0.0",
    first="28.0.0",
    source="release tags of ros2/rclcpp",
    targets=(
        OnTarget("humble", "16.0.20", False),
        OnTarget("jazzy", "28.1.16", True, "2024-05-23"),
        OnTarget("rolling", "31.0.0", True, "2024-02-12"),
    ),
)
ON = PAIR.targets


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({}, ["was: void rclcpp::Node::create(int)", "now: void rclcpp::Node::create(int, int)",
              "when: changed between rclcpp 27.0.0 and 28.0.0: jazzy since 2024-05-23, rolling since 2024-02-12, "
              "not on humble (16.0.20)"]),
        ({"change": "removed", "new": ()}, ["was: void rclcpp::Node::create(int)",
              "when: removed between rclcpp 27.0.0 and 28.0.0: jazzy since 2024-05-23, rolling since 2024-02-12, "
              "still on humble (16.0.20)"]),
        ({"change": "added", "old": (), "last": "", "targets": (OnTarget("humble@2024-01-01", "16.0.1", False,
              "2024-03-01"),)},
         ["new: void rclcpp::Node::create(int, int)",
          "when: added in rclcpp 28.0.0: not on humble@2024-01-01 (16.0.1, until 2024-03-01)"]),
        ({"change": "deprecated", "old": (), "new": (), "last": "", "first": "lyrical", "targets": ON[:1]},
         ["when: deprecated in lyrical: not on humble (16.0.20)"]),
        # A distro as a bound says nothing that the message does not, where all are alike.
        ({"change": "removed", "old": (), "new": (), "last": "", "first": "jazzy", "targets": ()}, []),
        ({"change": "removed", "old": (), "new": (), "last": "", "first": "", "targets": ()}, []),
        ({"old": ("void f()", "void f(int)", "void f(char)"), "new": (), "targets": ()},
         ["was: void f()", "was: void f(int) (and 1 more)", "when: changed between rclcpp 27.0.0 and 28.0.0"]),
        # Overloads that stayed are not shown, unless nothing else is there now.
        ({"old": ("void f()", "void f(int)"), "new": ("void f()", "void f(char)"), "targets": ()},
         ["was: void f(int)", "now: void f(char)", "when: changed between rclcpp 27.0.0 and 28.0.0"]),
        ({"old": ("void f()", "void f(int)"), "new": ("void f()",), "targets": ()},
         ["was: void f(int)", "now: void f()", "when: changed between rclcpp 27.0.0 and 28.0.0"]),
    ],
)  # fmt: skip
def test_lines(changes, expected):
    finding = Finding("r", "error", "p", "a.cpp", 1, 1, "x", (), "m", evidence=PAIR._replace(**changes))
    assert [f"{label}: {line}" for label, line in evidence.format_lines(finding)] == expected


def resting_on(report, evidence):
    """The report with the evidence at its removed header."""
    return report._replace(
        findings=tuple(f._replace(evidence=evidence) if f.rule == "removed-header" else f for f in report.findings)
    )


@pytest.fixture
def told(team):
    return resting_on(team, PAIR)


def test_json_has_it_whole(told):
    data = json.loads(json_report.render(told))
    jsonschema.validate(data, json.loads(json_report.render_schema()))
    (found,) = (finding["evidence"] for finding in data["findings"] if "evidence" in finding)
    assert found == {
        "package": "rclcpp",
        "change": "changed",
        "name": "rclcpp::Node::create",
        "old": ["void rclcpp::Node::create(int)"],
        "new": ["void rclcpp::Node::create(int, int)"],
        "last": "27.0.0",
        "first": "28.0.0",
        "source": "release tags of ros2/rclcpp",
        "targets": [
            {"target": "humble", "version": "16.0.20", "holds": False},
            {"target": "jazzy", "version": "28.1.16", "holds": True, "since": "2024-05-23"},
            {"target": "rolling", "version": "31.0.0", "holds": True, "since": "2024-02-12"},
        ],
    }


def test_sarif_has_it_among_the_properties(told):
    (run,) = json.loads(sarif.render(told))["runs"]
    first = next(result for result in run["results"] if result["ruleId"] == "removed-header")
    assert first["properties"]["evidence"]["first"] == "28.0.0"
    assert "\nwas: void rclcpp::Node::create(int)\n" in first["message"]["text"]


def test_text_and_annotations_have_it_between_the_code_and_the_help(told):
    lines = text.render(told).splitlines()
    at = next(n for n, line in enumerate(lines) if line.startswith("  was: "))
    assert [line[:7] for line in lines[at : at + 4]] == ["  was: ", "  now: ", "  when:", "  help:"]
    assert "%0Awas: void rclcpp::Node::create(int)%0Anow: " in github.render(told)


def test_a_long_declaration_fits_the_width(team):
    told = resting_on(team, PAIR._replace(old=("void f(" + "int, " * 99,)))
    line = next(line for line in text.render(told).splitlines() if line.startswith("  was: "))
    assert (len(line), line[-3:]) == (PLAIN.width, "...")


def test_the_page_has_it_with_its_source_and_the_comment_is_as_short_as_before(told, team):
    assert "release tags of ros2/rclcpp" in html.render(told)
    assert markdown.render(told) == markdown.render(team)


def test_baselines_do_not_know_it(told, team):
    assert format_baseline(told.findings) == format_baseline(team.findings)
