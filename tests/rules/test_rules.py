"""Every rule on its cases: small workspaces and changes of them, each with what is reported (rule_cases.py).

A workspace is checked once, by all rules. What the case's own rule finds stands in the case; what other rules find
there stands in other_rules.txt, so that a finding that nobody expects is seen in review. `--update-cases` writes both.
"""

from __future__ import annotations

import functools
import itertools
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import pytest
import rule_cases
from rosimpact.impact.analysis.check import check
from rosimpact.impact.analysis.report import Report
from rosimpact.impact.analysis.session import Options
from rosimpact.impact.rules.rule import load_rules
from rosimpact.impact.targets.machine.loader import detect_machine
from rule_cases import Case

OTHERS = Path(__file__).parent / "other_rules.txt"
CASES = rule_cases.find_cases()
COMPARING = rule_cases.rules_that_compare()
Run = Callable[[Case], Report]
each_case = pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)


@pytest.fixture(scope="module")
def run(tmp_path_factory, made_elf, cache) -> Run:
    """Checks the workspace of a case, once for all tests."""

    def make_installed(case: Case) -> Path:
        """Writes the workspace and its install space."""
        folder = rule_cases.write_files(tmp_path_factory.mktemp("installed"), case.files)
        for line in case.installed:
            machine, path, *needed = line.split()
            file = folder / "install" / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(made_elf(detect_machine() if machine == "here" else machine, needed))
        return folder

    checked: dict[tuple[Path, str], Report] = {}

    def run_case(case: Case) -> Report:
        key = (case.file, case.title)
        if key not in checked:
            options = Options(targets=case.targets, preview=True, cache=cache, jobs=1)
            if case.installed:
                folder = make_installed(case)
                checked[key] = check(folder, options._replace(install=folder / "install"))
            else:
                base = case.unchanged if case.rule in COMPARING else None
                checked[key] = rule_cases.check_files(case.files, options, base)
        return checked[key]

    return run_case


@pytest.fixture
def updates(request: pytest.FixtureRequest) -> bool:
    """Whether expected findings are written rather than compared."""
    return request.config.getoption("--update-cases")


@each_case
def test_its_rule_finds_what_the_case_expects(case: Case, run: Run, updates: bool):
    found = rule_cases.render_findings(run(case).findings, case.rule)
    expected = list(case.findings)
    found = rule_cases.leave_out_details(found, expected)
    if updates and found != expected:
        rule_cases.update_findings(case, found)
        return
    assert found == expected


@each_case
def test_other_rules_find_what_is_known(case: Case, run: Run, updates: bool):
    found = rule_cases.render_others(run(case).findings, case.rule)
    known = read_others()
    if updates and found != known.get(case.name, []):
        write_others({**known, case.name: found})
        return
    assert found == known.get(case.name, [])


@pytest.mark.parametrize("case", [case for case in CASES if not case.findings], ids=lambda case: case.name)
def test_no_rule_warns_where_nothing_is_reported(case: Case, run: Run, updates: bool):
    report = run(case)
    if updates:  # which case reports nothing is known again afterwards
        return
    assert report.failure == ""
    assert [f for f in report.findings if f.severity != "note"] == []
    assert (report.coverage.unresolved, report.coverage.files - report.coverage.parsed) == ({}, 0)


def test_other_rules_are_known_of_cases_that_exist():
    assert set(read_others()) <= {case.name for case in CASES}


def test_every_rule_has_a_case_that_reports_and_one_that_does_not():
    assert {case.rule for case in CASES if case.findings} == set(load_rules())
    assert {case.rule for case in CASES if not case.findings} == set(load_rules())


def test_cases_in_which_nothing_is_reported_are_as_many_as_the_others():
    count = Counter(bool(case.findings) for case in CASES)
    assert count[False] >= count[True]


@each_case
def test_a_case_lies_in_the_folder_of_its_rules_family(case: Case):
    assert load_rules()[case.rule].family == case.family


def test_a_run_that_analysed_nothing_fails(run: Run):
    (case,) = (case for case in CASES if case.rule == "nothing-analysed" and case.findings)
    report = run(case)
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


@functools.cache
def _read_others(stamp: int) -> dict[str, list[str]]:
    del stamp
    known: dict[str, list[str]] = {}
    for line in OTHERS.read_text(encoding="utf-8").splitlines():
        if line.startswith("  "):
            known[next(reversed(known))].append(line[2:])
        elif line:
            known[line] = []
    return known


def read_others() -> dict[str, list[str]]:
    """What other rules find, by the name of a case; none for cases in which they find nothing."""
    return _read_others(OTHERS.stat().st_mtime_ns)


def write_others(known: dict[str, list[str]]) -> None:
    """Writes what other rules find, of the cases that exist."""
    names = {case.name for case in CASES}
    rows = ([name, *(f"  {line}" for line in known[name])] for name in sorted(known) if known[name] and name in names)
    OTHERS.write_text("".join(f"{line}\n" for line in itertools.chain.from_iterable(rows)), encoding="utf-8")
