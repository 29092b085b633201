"""All rules on the cases of one another, family by family: what a rule finds in cases of others is known.

It stands in other_rules.txt, so that a finding that nobody expects is seen in review; `--update-cases` writes it.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest
import rule_cases
from rosimpact.impact.analysis.report import Report
from rule_cases import Case, CheckCase

OTHERS = Path(__file__).parent / "other_rules.txt"
CASES = rule_cases.find_cases()
each_family = pytest.mark.parametrize("family", sorted({case.family for case in CASES}))
Known = dict[str, list[str]]


class CheckedCase(NamedTuple):
    """A case, and what all rules together report on it."""

    case: Case
    report: Report


@pytest.fixture(scope="module")
def check_family(check_case: CheckCase):
    """Checks the cases of a family by all rules, once for all tests."""

    @cache
    def run(family: str) -> list[CheckedCase]:
        return [CheckedCase(case, check_case(case)) for case in CASES if case.family == family]

    return run


@each_family
def test_other_rules_find_what_is_known(family: str, check_family, updates: bool):
    lines = {
        case.name: rule_cases.render_others(report.findings, case.rule) for case, report in check_family(family)
    }
    found = {name: each for name, each in lines.items() if each}
    known = read_others()
    of_family = {name: known[name] for name in known if name.startswith(f"{family}/")}
    if updates and found != of_family:
        write_others({**{name: known[name] for name in known.keys() - of_family.keys()}, **found})
        return
    assert found == of_family


@each_family
def test_no_rule_warns_where_nothing_is_reported(family: str, check_family, updates: bool):
    silent = [checked for checked in check_family(family) if not checked.case.findings]
    if updates:  # which case reports nothing is known again afterwards
        return
    faults = {
        case.name: faults
        for case, report in silent
        if (faults := [finding for finding in report.findings if finding.severity != "note"])
    }
    assert faults == {}
    for case, report in silent:
        read = (report.failure, report.coverage.unresolved, report.coverage.files - report.coverage.parsed)
        assert read == ("", {}, 0), case.name


def test_other_rules_are_known_of_cases_that_exist():
    assert set(read_others()) <= {case.name for case in CASES}


def read_others() -> Known:
    """What other rules find, by the name of a case; none for cases in which they find nothing."""
    known: Known = {}
    for line in OTHERS.read_text(encoding="utf-8").splitlines():
        if line.startswith("  "):
            known[next(reversed(known))].append(line[2:])
        elif line:
            known[line] = []
    return known


def write_others(known: Mapping[str, list[str]]) -> None:
    """Writes what other rules find, of the cases that exist."""
    names = known.keys() & {case.name for case in CASES}
    rows = (line for name in sorted(names) for line in (name, *(f"  {each}" for each in known[name])))
    OTHERS.write_text("".join(f"{line}\n" for line in rows), encoding="utf-8")
