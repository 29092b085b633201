"""`rosimpact dev new-rule` lays out a rule that works, with cases that hold."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest
import rule_cases
from rosimpact.impact.analysis.session import Options
from rosimpact.impact.rules import rule as registry

ROOT = Path(__file__).parents[1]


@pytest.fixture
def checkout(tmp_path) -> Path:
    """The folders of a checkout."""
    for family in ("api", "packages"):
        (tmp_path / "impact/rules" / family).mkdir(parents=True)
        (tmp_path / "impact/rules" / family / "__init__.py").touch()
        (tmp_path / "tests/rules" / family).mkdir(parents=True)
    (tmp_path / "impact/rules/api/removed_header.py").touch()
    return tmp_path


def test_a_new_rule_finds_what_its_cases_expect(checkout, say, cache, monkeypatch):
    said = say("dev", "new-rule", "bad-name", "--family", "packages", "--root", checkout)
    module, cases = checkout / "impact/rules/packages/bad_name.py", checkout / "tests/rules/packages/bad_name.md"
    assert (said.status, said.err) == (0, "")
    assert said.out.splitlines()[:2] == [str(module), str(cases)]
    registry.load_rules()
    monkeypatch.setattr(registry, "_RULES", dict(registry._RULES))
    spec = importlib.util.spec_from_file_location("rosimpact.impact.rules.packages.bad_name", module)
    assert spec and spec.loader
    loaded = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, spec.name, loaded)
    spec.loader.exec_module(loaded)
    rule = registry.load_rules()["bad-name"]
    assert (rule.family, rule.preview) == ("packages", True)
    assert rule.documentation.startswith("bad-name: ")
    silent, speaking = rule_cases.read_cases(cases)
    for case in (silent, speaking):
        report = rule_cases.check_files(case.files, Options(targets=case.targets, preview=True, cache=cache))
        assert rule_cases.render_findings(report.findings, "bad-name") == list(case.findings)
        assert {finding.rule for finding in report.findings} == ({"bad-name"} if case is speaking else set())
    assert not silent.findings and speaking.findings


@pytest.mark.parametrize(
    ("name", "family", "words"),
    [
        ("Bad-Name", "api", ("Bad-Name: not a rule name", "such as bad-name")),
        ("bad_name", "api", ("such as bad-name",)),
        ("../bad", "api", ("such as removed-header",)),
        ("bad-name", "qos", ("--family qos: unknown; choose one of api, packages",)),
        ("removed-header", "packages", ("impact/rules/api/removed_header.py: exists",)),
    ],
)
def test_what_cannot_be_a_rule_is_named_and_nothing_is_written(name, family, words, checkout, say):
    before = sorted(checkout.rglob("*"))
    said = say("dev", "new-rule", name, "--family", family, "--root", checkout)
    assert said.status == 2 and all(word in said.err for word in words)
    assert sorted(checkout.rglob("*")) == before


def test_elsewhere_than_in_a_checkout_it_says_where_to_start(tmp_path, say):
    said = say("dev", "new-rule", "bad-name", "--family", "api", "--root", tmp_path)
    assert said.status == 2 and "run the command where impact/ and tests/ are" in said.err


def test_it_is_no_part_of_the_ordinary_help(say):
    assert " dev " not in say("--help").out
    assert "new-rule" in say("dev", "--help").out
