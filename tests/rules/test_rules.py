"""Every rule on its cases: small workspaces and changes of them, each with what is reported (rule_cases.py).

A case asks its own rule only; test_other_rules.py asks the others. `--update-cases` writes what the rule finds.
"""

from __future__ import annotations

from collections import Counter

import pytest
import rule_cases
from rosimpact.impact.rules.rule import load_rules
from rule_cases import Case, CheckCase

CASES = rule_cases.find_cases()
each_case = pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)


@each_case
def test_its_rule_finds_what_the_case_expects(case: Case, check_case: CheckCase, updates: bool):
    report = check_case(case, case.asked)
    assert "rule" not in report.failure, report.failure  # one that fell says nothing, which may be what is expected
    found = rule_cases.render_findings(report.findings, case.rule)
    expected = list(case.findings)
    found = rule_cases.leave_out_details(found, expected)
    if updates and found != expected:
        rule_cases.update_findings(case, found)
        return
    assert found == expected


def test_every_rule_has_a_case_that_reports_and_one_that_does_not():
    assert {case.rule for case in CASES if case.findings} == set(load_rules())
    assert {case.rule for case in CASES if not case.findings} == set(load_rules())


def test_cases_in_which_nothing_is_reported_are_as_many_as_the_others():
    count = Counter(bool(case.findings) for case in CASES)
    assert count[False] >= count[True]


@each_case
def test_a_case_lies_in_the_folder_of_its_rules_family(case: Case):
    assert load_rules()[case.rule].family == case.family


def test_a_run_that_analysed_nothing_fails(check_case: CheckCase):
    (case,) = (case for case in CASES if case.rule == "nothing-analysed" and case.findings)
    report = check_case(case, case.asked)
    assert "all are ignored (`winch`: holds COLCON_IGNORE)" in report.failure
    assert [finding.rule for finding in report.findings] == ["nothing-analysed"]


# As files of cases are called, so that `-k removed_header` selects all that is about a rule.
@pytest.mark.parametrize("rule", load_rules().values(), ids=lambda rule: rule.name.replace("-", "_"))
def test_documentation_has_its_sections(rule):
    text = rule.documentation
    assert text.startswith(f"{rule.name}: ")
    sections = [line for line in text.splitlines() if line and not line.startswith((" ", f"{rule.name}: "))]
    order = ["What it does", "Why it breaks", "Why it matters", "Severity", "Example", "Use instead", "Not reported"]
    assert sections == [section for section in order if section in sections], (
        "sections missing, unknown or out of order"
    )
    assert {"What it does", "Severity"} < set(sections)
    assert len({"Why it breaks", "Why it matters"} & set(sections)) == 1
    assert ("Example" in sections) == ("Use instead" in sections)
