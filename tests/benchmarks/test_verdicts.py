"""Judged findings: drawn from heads, asked again, counted by rule for `rosimpact explain`."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from rosimpact.impact.rules import explain
from rosimpact.impact.rules import rule as registry

sys.path.append(str(Path(__file__).parents[2] / "benchmarks"))

import first_sight
import verdicts

FILES = {
    "talker/package.xml": """<package format="3">
  <name>talker</name>
  <version>0.0.1</version>
  <description>Talks.</description>
  <maintainer email="someone@example.org">someone</maintainer>
  <license>BSD</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
""",
    "talker/CMakeLists.txt": """cmake_minimum_required(VERSION 3.16)
project(talker)
find_package(ament_cmake REQUIRED)
install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})
find_package(rclcpp REQUIRED)
add_executable(talker src/talker.cpp)
target_link_libraries(talker rclcpp::rclcpp)
install(TARGETS talker DESTINATION lib/${PROJECT_NAME})
ament_package()
""",
    "talker/src/talker.cpp": "#include <rclcpp/rclcpp.hpp>\nint main(int argc, char ** argv)\n{\n"
    "  rclcpp::init(argc, argv);\n}\n",
}
FINDINGS = [
    ("error", "nonexistent-install", "talker/CMakeLists.txt", "launch"),
    ("error", "undeclared-package", "talker/CMakeLists.txt", "rclcpp"),
]


def record(rule: str, subject: str, verdict: str, repo: str = "someone/talker", **fields) -> dict:
    path, severity = "talker/CMakeLists.txt", "error"
    return {"repo": repo, "severity": severity, "rule": rule, "path": path, "line": 4, "subject": subject} | {
        "verdict": verdict,
        **fields,
    }


@pytest.fixture
def batches(tmp_path: Path, cache: Path, monkeypatch) -> Path:
    """A batch x of one repository, whose clone is beside it; gives the folder of the batch."""
    folder = tmp_path / "clones" / "someone+talker"
    for name, text in FILES.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    git = ["git", "-c", "user.name=someone", "-c", "user.email=someone@example.org", "-C", str(folder)]
    for command in (["init", "-q", "-b", "main"], ["add", "."], ["commit", "-q", "-m", "initial"], ["tag", "0.0.1"]):
        subprocess.run([*git, *command], check=True)
    found = tmp_path / "batches"
    found.mkdir()
    (found / "x.repos.txt").write_text("someone/talker\nsomeone/absent\n")
    monkeypatch.setattr(first_sight, "BATCHES", found)
    monkeypatch.setenv("ROSIMPACT_CACHE", str(cache))
    return found


def test_findings_are_drawn_from_heads(batches, tmp_path, capsys):
    out = tmp_path / "heads.jsonl"
    clones = ["--clones", str(tmp_path / "clones"), "--jobs", "1"]
    assert verdicts.main(["draw", "--batch", "x", "--out", str(out), "--share-errors", "1", *clones]) == 0
    found = first_sight.read_records(out)
    assert [(f["severity"], f["rule"], f["path"], f["subject"]) for f in found] == FINDINGS
    assert {(f["repo"], len(f["commit"])) for f in found} == {("someone/talker", 40)}
    assert "2 of 2 errors and 0 warnings in 1 heads" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("verdict", "subject", "status", "printed"),
    [
        ("false", "rclcpp", 1, "false and back: someone/talker talker/CMakeLists.txt:4 undeclared-package rclcpp\n"),
        ("false", "rclpy", 0, ""),
        ("true", "rclcpp", 0, ""),
        ("true", "rclpy", 0, "right and gone: someone/talker talker/CMakeLists.txt:4 undeclared-package rclpy\n"),
        ("badly said", "rclpy", 0, ""),
    ],
)
def test_what_was_judged_false_must_not_come_back(batches, tmp_path, capsys, verdict, subject, status, printed):
    row = record("undeclared-package", subject, verdict, tag="0.0.1", distro="jazzy")
    absent = record("undeclared-package", "rclcpp", "false", "someone/absent", tag="0.0.1", distro="jazzy")
    first_sight.write_records(batches / "x.verdicts.jsonl", [row, absent])
    assert verdicts.main(["recheck", "--clones", str(tmp_path / "clones"), "--jobs", "1"]) == status
    again = int(status == 1)
    end = f"1 of 2 findings asked again, {again} that were judged false are back\n"
    assert capsys.readouterr().out == printed + end


def test_a_release_is_asked_about_as_of_the_day_that_it_was_scored_as_of(batches):
    where = {"repo": "someone/talker", "tag": "0.0.1", "distro": "jazzy"}
    release = where | {"in_distro_until_at_least": "2025-03-01"}
    first_sight.write_records(batches / "x.releases.jsonl", [release])
    first_sight.write_records(batches / "x.verdicts.jsonl", [record("undeclared-package", "rclcpp", "false", **where)])
    first_sight.write_records(batches / "x.heads.jsonl", [record("undeclared-package", "rclcpp", "false", commit="c")])
    assert [row["day"] for row in verdicts.judged(batches)] == ["", "2025-03-01"]


def test_a_false_error_may_come_back_as_a_warning_only_if_it_was_an_error():
    said = [{"rule": "unused-dependency", "path": "talker/CMakeLists.txt", "subject": "a", "severity": "warning"}]
    error = record("unused-dependency", "a", "false")
    warning = error | {"severity": "warning"}
    assert verdicts.compare([error], said) == ([], [])
    assert verdicts.compare([warning], said) == ([warning], [])


def test_a_finding_of_a_rule_that_was_split_is_still_known():
    said = [{"rule": "duplicate-target", "path": "talker/CMakeLists.txt", "subject": "a", "severity": "error"}]
    before = record("refused-cmake-name", "a", "false")
    assert verdicts.compare([before], said) == ([before], [])


def test_two_findings_of_a_rule_and_repository_are_drawn_at_most():
    found = [record(rule, str(at), "") for at in range(5) for rule in ("one", "two")]
    found += [record(rule, "a", "") | {"severity": "warning"} for rule in ("three", "four", "five")]
    drawn = [[f["severity"] for f in verdicts.choose(found, number, 0.5, seed=1)] for number in (100, 4)]
    assert [(s.count("error"), s.count("warning")) for s in drawn] == [(4, 3), (2, 2)]


def test_precision_is_counted_by_rule_and_batch():
    rows = [record("r", "a", v, batch="x") for v in ("true", "true-but-latent", "badly said", "false")]
    rows += [record("r", "a", "true", "someone/other", batch="y"), record("q", "a", "false", batch="x")]
    assert verdicts.count_precision(rows) == {
        "q": [{"batch": "x", "repositories": 1, "findings": 1, "right": 0, "badly_said": 0}],
        "r": [
            {"batch": "x", "repositories": 1, "findings": 4, "right": 2, "badly_said": 1},
            {"batch": "y", "repositories": 1, "findings": 1, "right": 1, "badly_said": 0},
        ],
    }


def test_explain_tells_the_precision_that_the_verdicts_give():
    counted = verdicts.count_precision(verdicts.judged(first_sight.BATCHES))
    assert json.loads(explain.PRECISION.read_text()) == counted, "run `benchmarks/verdicts.py precision`"
    assert explain.describe_precision([explain.BatchPrecision("x", 2, 9, 7, 1)]).splitlines() == [
        "Precision at first sight",
        "    x: 7 of 9 findings right, 1 badly said (repositories: 2)",
    ]


def test_rules_of_which_too_few_findings_were_true_are_previews():
    found = verdicts.find_imprecise(verdicts.judged(first_sight.BATCHES))
    assert registry.IMPRECISE.read_text() == verdicts.format_imprecise(found), "run `benchmarks/verdicts.py precision`"
    rules = registry.load_rules()
    assert not [name for name in found if name in rules and not rules[name].preview]
    assert explain.explain("uninstalled-script", rules).endswith("of its newest findings on heads, 3 of 7 were true.")


def test_a_rule_is_imprecise_when_surely_less_than_nine_in_ten_of_its_findings_on_heads_are_true():
    def rows(rule, right, false, batch="x"):
        made = [record(rule, str(at), "true" if at < right else "false", f"o/{at}") for at in range(right + false)]
        return [{"batch": batch, **row} for row in made]

    given = [*rows("seldom", 1, 4), *rows("mostly", 17, 3), *rows("few", 0, 2), *rows("mended", 0, 9)]
    given += [*rows("mended", 20, 0, "y"), *({**row, "repo": "o/r"} for row in rows("once", 0, 9))]
    given += [{**row, "tag": "1.0.0"} for row in rows("released", 0, 9)]
    assert verdicts.find_imprecise(given) == {"seldom": (1, 5)}
