"""JSON, SARIF, GitHub and Markdown: valid by their own definitions, and nothing escapes from its field."""

import json
import os
import re
from pathlib import Path
from urllib.parse import unquote

import jsonschema
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.impact.analysis.report import AnalysisCoverage, Report, ReportedTarget
from rosimpact.impact.report import github, html, markdown, sarif, text
from rosimpact.impact.report import json as findings_json
from rosimpact.impact.rules.rule import Finding

ROOT = Path(__file__).parents[2]
HEADER = "tf2_geometry_msgs/tf2_geometry_msgs.h"
REPORTS = ("team", "quiet", "hostile", "large")


@pytest.fixture(params=REPORTS)
def report(request):
    return request.getfixturevalue(request.param)


PLACES = st.integers(0, 5)
TEXTS = st.text(st.characters(), max_size=20)
FINDINGS = st.builds(
    Finding, st.sampled_from(["removed-header", "other"]), st.sampled_from(["error", "warning", "note"]), TEXTS, TEXTS,
    PLACES, PLACES, TEXTS, st.lists(st.sampled_from(["humble", "jazzy"]), unique=True).map(tuple), TEXTS, TEXTS,
)  # fmt: skip


@given(st.lists(FINDINGS, max_size=5), st.lists(TEXTS, max_size=3))
def test_every_format_takes_any_text(findings, lines):
    targets = tuple(ReportedTarget(name, name, "", "") for name in ("humble", "jazzy"))
    report = Report("0.1.0", "", targets, tuple(findings), AnalysisCoverage(1, 1, 1), excerpt=lambda path, line: lines)
    for module in (text, findings_json, sarif, github, markdown, html):
        module.render(report).encode()
    assert len(json.loads(findings_json.render(report))["findings"]) == len(findings)
    assert len(json.loads(sarif.render(report))["runs"][0]["results"]) == len(findings)
    assert len(github.render(report).split("\n")) == sum(finding.new for finding in findings) + 2
    assert len(markdown.render(report).split("\n")) <= 11


# JSON


@pytest.fixture(scope="module")
def schema():
    validator = jsonschema.Draft202012Validator(json.loads(findings_json.render_schema()))
    validator.check_schema(validator.schema)
    return validator


def test_json_follows_the_published_schema(report, schema):
    schema.validate(json.loads(findings_json.render(report).encode()))


def test_json_of_a_failed_run_is_valid(schema):
    data = json.loads(
        findings_json.render(Report("0.1.0", "", (), (), AnalysisCoverage(), failure="there is no folder `x`"))
    )
    schema.validate(data)
    assert data["failure"] == "there is no folder `x`"
    assert data["findings"] == []


def test_the_documented_schema_is_the_shipped_one():
    assert (ROOT / "docs/findings.schema.json").read_text() == findings_json.render_schema()


def test_json_has_every_documented_field(team):
    data = json.loads(findings_json.render(team))
    assert list(data) == ["schema", "tool", "targets", "findings", "coverage"]
    assert data["tool"] == {"name": "rosimpact", "version": "0.1.0", "data": "2026-08-22"}
    assert data["coverage"] == {"packages": 5, "files": 41, "parsed": 40, "unresolved": {"include": 3, "topic": 1}}
    (finding,) = [each for each in data["findings"] if each["rule"] == "removed-header"]
    assert re.fullmatch("[0-9a-f]{24}", finding.pop("fingerprint"))
    assert finding == {
        "rule": "removed-header",
        "severity": "error",
        "package": "localizer",
        "path": "src/localizer/src/node.cpp",
        "line": 2,
        "column": 11,
        "subject": "tf2_geometry_msgs/tf2_geometry_msgs.h",
        "targets": ["jazzy", "rolling"],
        "message": f"`{HEADER}` is gone in tf2_geometry_msgs 0.36.2 (jazzy), 0.41.0 (rolling)",
        "help": "include `tf2_geometry_msgs/tf2_geometry_msgs.hpp`, present on every target asked for",
        "new": True,
    }


@pytest.mark.parametrize(
    ("field", "value"),
    [("severity", "fatal"), ("line", -1), ("targets", ["a", "a"]), ("fingerprint", "x"), ("rule", "Not a rule")],
)
def test_the_schema_refuses_what_is_wrong(team, schema, field, value):
    data = json.loads(findings_json.render(team))
    data["findings"][0][field] = value
    assert not schema.is_valid(data)


# SARIF


@pytest.fixture(scope="module")
def official():
    """The schema that OASIS publishes, from a file: it is not ours to ship."""
    path = os.environ.get("ROSIMPACT_SARIF_SCHEMA")
    if not path:
        pytest.skip(f"set ROSIMPACT_SARIF_SCHEMA to a copy of {sarif.SCHEMA} to validate against it")
    schema = json.loads(Path(path).read_text(encoding="utf-8"))
    return jsonschema.validators.validator_for(schema)(schema)


def test_sarif_follows_the_official_schema(report, official):
    finding = Finding("removed-header", "note", "", "", 0, 0, "", (), "whole workspace", fingerprint="0" * 24)
    full = report._replace(suppressed=report.findings[:2], known=(finding,), failure="it failed", base="main")
    for each in (report, full):
        log = json.loads(sarif.render(each).encode())
        errors = [f"{list(error.path)}: {error.message}" for error in official.iter_errors(log)]
        assert errors == []


def test_sarif_results(team):
    first = team.findings[0]
    report = team._replace(suppressed=(first,), known=(first,))
    (run,) = json.loads(sarif.render(report))["runs"]
    rules = [rule["id"] for rule in run["tool"]["driver"]["rules"]]
    assert rules == ["library-version", "removed-header", "undeclared-package", "unused-dependency"]
    assert [rules[result["ruleIndex"]] for result in run["results"]] == [result["ruleId"] for result in run["results"]]
    assert [result["level"] for result in run["results"]] == ["note", "error", "warning", "error", "note", "note"]
    assert [result.get("suppressions", [{}])[0].get("kind") for result in run["results"]] == [
        *[None] * 4,
        "inSource",
        "external",
    ]
    header = run["results"][1]
    assert header["properties"]["targets"] == ["jazzy", "rolling"]
    assert header["partialFingerprints"] == {"rosimpact/v1": team.findings[1].fingerprint}
    region = header["locations"][0]["physicalLocation"]["region"]
    assert (region["startLine"], region["startColumn"], region["endColumn"]) == (2, 11, 48)
    assert region["snippet"]["text"][10:47] == "tf2_geometry_msgs/tf2_geometry_msgs.h"
    (replacement,) = run["results"][2]["fixes"][0]["artifactChanges"][0]["replacements"]
    assert replacement["deletedRegion"] == {"byteOffset": 49, "byteLength": 0}
    assert run["invocations"][0]["executionSuccessful"] is True
    assert [target["name"] for target in run["properties"]["targets"]] == ["humble", "jazzy", "rolling", "robot"]


def test_sarif_rules_carry_their_documentation(team):
    (run,) = json.loads(sarif.render(team))["runs"]
    rule = run["tool"]["driver"]["rules"][1]
    assert rule["shortDescription"]["text"] == "an included header is gone on a target."
    assert rule["fullDescription"]["text"] == "Reports `#include` lines."
    assert rule["help"]["markdown"] == "**What it does**\n\nReports `#include` lines."
    assert rule["defaultConfiguration"] == {"level": "error"}


def test_sarif_paths_are_relative_uris(hostile):
    (run,) = json.loads(sarif.render(hostile))["runs"]
    location = run["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"]
    assert re.fullmatch(r"[A-Za-z0-9%/._~-]+", location["uri"])
    assert unquote(location["uri"], errors="surrogateescape") == hostile.findings[0].path
    assert location["uriBaseId"] == "%SRCROOT%"


def test_a_failed_run_says_so_in_sarif(quiet):
    (run,) = json.loads(sarif.render(quiet._replace(failure="no such folder")))["runs"]
    assert run["invocations"][0]["executionSuccessful"] is False
    assert run["invocations"][0]["toolExecutionNotifications"][0]["message"]["text"] == "no such folder"


# GitHub


def test_github_commands(team):
    lines = github.render(team, "ws/").splitlines()
    assert lines[0] == (
        "::error file=ws/src/localizer/src/node.cpp,title=removed-header (jazzy%2C rolling),"
        f"line=2,col=11,endColumn=47::`{HEADER}` is gone in tf2_geometry_msgs 0.36.2 (jazzy), 0.41.0 (rolling)"
        "%0Ahelp: include `tf2_geometry_msgs/tf2_geometry_msgs.hpp`, present on every target asked for"
    )
    assert [line.split(" ")[0] for line in lines[:-1]] == ["::error", "::error", "::warning", "::notice"]
    assert lines[-1].startswith("rosimpact: 2 errors, 1 warning, 1 note; 5 packages")


def test_github_shows_ten_of_a_level_and_prints_the_rest(large):
    lines = github.render(large).splitlines()
    for level in ("error", "warning", "notice"):
        assert sum(line.startswith(f"::{level} ") for line in lines) <= 10
    assert len(lines) == 5001


def test_github_says_different_things_first(quiet):
    findings = tuple(
        Finding("r", "error", "p", f"{number}.cpp", 1, 0, "x", (), "again" if number < 20 else f"other {number}")
        for number in range(22)
    )
    shown = [line for line in github.render(quiet._replace(findings=findings)).splitlines() if line.startswith("::")]
    assert sum(line.endswith("::again") for line in shown) == 8
    assert any(line.endswith("::other 21") for line in shown)


def test_nobody_writes_a_command_but_us(hostile):
    for output in (github.render(hostile), github.render(hostile, "x"), github.render(hostile._replace(findings=()))):
        for line in output.splitlines():
            assert not line.startswith("::") or re.match(r"::error file=[^:,]*,title=[^:,]*,line=1", line)


def test_step_summary_is_appended(team, tmp_path):
    file = tmp_path / "summary"
    file.write_text("before\n")
    github.write_step_summary(team, {"GITHUB_STEP_SUMMARY": str(file)})
    github.write_step_summary(team, {})
    lines = file.read_text().splitlines()
    assert lines[0] == "before"
    assert lines[1].startswith("**rosimpact** breaks on **jazzy**: 1")
    assert sum(line.startswith("| error |") for line in lines) == 2


# Markdown


def test_markdown_of_the_team(team):
    assert markdown.render(team).splitlines() == [
        "**rosimpact** breaks on **jazzy**: 1, **rolling**: 1, **robot**: 1; may break on humble: 1",
        "",
        f"- ❌ `src/localizer/src/node.cpp:2` `{HEADER}` is gone in tf2\\_geometry\\_msgs 0.36.2 (jazzy), "
        f"0.41.0 (rolling); include `{HEADER}pp`, present on every target asked for",
        "- ❌ `src/planner/CMakeLists.txt:2` `find_package(OpenCV 4.6)` asks for more than opencv 4.5.4 "
        "(robot); ask for `4.5`, which every target asked for has",
        "- ⚠️ `src/localizer/src/node.cpp:3` `cv_bridge` is included and not declared; "
        "add `<depend>cv_bridge</depend>` to `src/localizer/package.xml`",
        "",
        "<sub>5 packages, 40 of 41 files read, unresolved: 3 includes, 1 topic · 1 note · rosimpact 0.1.0, data of "
        "2026-08-22</sub>",
    ]


def test_markdown_has_ten_lines_at_most(report):
    assert len(markdown.render(report).splitlines()) <= 10


def test_markdown_says_a_thing_once(quiet):
    gone = [Finding("r", "error", "ui", f"{n}.cpp", 1, 0, "x", ("jazzy",), "`x` is gone", "use `z`") for n in range(9)]
    others = [Finding("r", "error", "ui", "a.cpp", n, 0, f"y{n}", ("jazzy",), f"`y{n}` is gone") for n in range(8)]
    rows = markdown.render(quiet._replace(findings=(*gone, *others))).splitlines()[2:-2]
    shown = "- ❌ `0.cpp:1` and 8 more places (`1.cpp:1`, `2.cpp:1`, `3.cpp:1`, …): `x` is gone (jazzy); use `z`"
    assert rows[0] == shown
    assert rows[-1] == "- and 4 errors more"


def test_markdown_of_what_has_no_place(quiet):
    finding = Finding("r", "error", "", "", 0, 0, "x", (), "nothing is there", "add it")
    rows = markdown.render(quiet._replace(findings=(finding,), targets=quiet.targets[:1])).splitlines()
    assert rows[2] == "- ❌ nothing is there; add it"


def test_markdown_counts_what_it_leaves_out(large):
    assert markdown.render(large).splitlines()[7] == "- and 3,745 errors more"


@pytest.mark.parametrize(
    ("changes", "verdict"),
    [
        ({}, "no known break on: humble, jazzy, rolling, robot; 3 includes, 1 topic unresolved, 1 file not read"),
        ({"coverage": AnalysisCoverage(1, 3, 3, {"import": 0})}, "safe on: humble, jazzy, rolling, robot"),
        (
            {"coverage": AnalysisCoverage(1, 3, 3, {"import": 1})},
            "no known break on: humble, jazzy, rolling, robot; 1 import unresolved",
        ),
        ({"coverage": AnalysisCoverage(1, 3, 0)}, "analysed nothing"),
        ({"failure": "no *such* folder"}, "failed: no \\*such\\* folder"),
        ({"targets": ()}, "found no target to check"),
    ],
)
def test_verdict(quiet, changes, verdict):
    assert markdown.format_verdict(quiet._replace(**changes)) == verdict


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a `b_c` d_e", "a `b_c` d\\_e"),
        ("<img> [x](y) *a* | b", "\\<img\\> \\[x\\](y) \\*a\\* \\| b"),
        ("ask @team about #12", "ask `@team` about `#12`"),
        ("one\ntwo", "one\\\\ntwo"),
        ("odd ` backtick", "odd \\` backtick"),
    ],
)
def test_escaped(text, expected):
    assert markdown.escape_markdown(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"), [("a", "`a`"), ("a`b", "``a`b``"), ("`a`", "`` `a` ``"), ("a``b", "```a``b```")]
)
def test_code(text, expected):
    assert markdown.quote(text) == expected


def test_hostile_text_makes_no_markup_in_markdown(hostile):
    outside = re.sub(r"(`+)(?!`).+?(?<!`)\1(?!`)", "", markdown.render(hostile))
    assert not re.search(r"(?<!\\)<(?!/?sub>|!-- -->)", outside)
