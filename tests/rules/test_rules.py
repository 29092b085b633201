"""Every rule on its own small workspaces: it speaks on `before`, and is silent on `after`, on every target.

A case is a folder `<family>/<rule>/`, with underscores for dashes, that holds the workspaces `before` and `after`, and
a file `targets` with one target a line (without it, each workspace names its own in rosimpact.toml). A workspace with
a file `installed.txt` has an install space with these built files: machine (`here`: this one), path,
and the libraries that each needs. A further case of
the same rule is `<rule>__<what it shows>`. Rules that compare are given `after` as the base of both workspaces.
One snapshot shows every finding of every rule over all `before` workspaces, so that a stray hit of another rule is seen
in review.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest
from rosimpact.impact.analysis.check import check, compare
from rosimpact.impact.analysis.report import Report
from rosimpact.impact.analysis.session import Options
from rosimpact.impact.rules.rule import all_rules
from rosimpact.impact.targets.machine.loader import own_machine

HERE = Path(__file__).parent
CASES = sorted(path.parent for path in HERE.glob("*/*/before"))
Run = Callable[[Path, str], Report]


def rule_of(case: Path) -> str:
    return case.name.partition("__")[0].replace("_", "-")


def name_of(case: Path) -> str:
    return f"{case.parent.name}/{case.name}"


@pytest.fixture(scope="module")
def run(tmp_path_factory, made_elf) -> Run:
    """Checks one workspace of a case, once for all tests."""
    store = tmp_path_factory.mktemp("cache")

    @cache
    def checked(case: Path, which: str) -> Report:
        targets = case / "targets"
        asked = tuple(targets.read_text().split()) if targets.exists() else ()
        options = Options(targets=asked, preview=True, cache=store, jobs=1)
        if all_rules()[rule_of(case)].has_base:
            return compare(case / which, case / "after", options)
        built = case / which / "installed.txt"
        if built.exists():
            copy = tmp_path_factory.mktemp("built") / which
            shutil.copytree(case / which, copy)
            for line in built.read_text().splitlines():
                machine, path, *needed = line.split()
                file = copy / "install" / path
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_bytes(made_elf(own_machine() if machine == "here" else machine, needed))
            return check(copy, options._replace(install=copy / "install"))
        return check(case / which, options)

    return checked


@pytest.mark.parametrize("case", CASES, ids=name_of)
def test_it_speaks_before(case: Path, run: Run):
    assert rule_of(case) in {finding.rule for finding in run(case, "before").findings}


@pytest.mark.parametrize("case", CASES, ids=name_of)
def test_all_is_well_after(case: Path, run: Run):
    report = run(case, "after")
    assert report.failure == ""
    assert [f for f in report.findings if f.rule == rule_of(case) or f.severity != "note"] == []


@pytest.mark.parametrize("case", CASES, ids=name_of)
def test_everything_is_read(case: Path, run: Run):
    coverage = run(case, "after").coverage
    assert (coverage.unresolved, coverage.files - coverage.parsed) == ({}, 0)


def test_every_rule_has_a_case():
    assert {rule_of(case) for case in CASES} == set(all_rules())


@pytest.mark.parametrize("case", CASES, ids=name_of)
def test_a_case_lies_in_the_folder_of_its_rules_family(case: Path):
    assert all_rules()[rule_of(case)].family == case.parent.name


def test_a_run_that_analysed_nothing_fails(run: Run):
    report = run(HERE / "general/nothing_analysed", "before")
    assert "all are ignored (`winch`: holds COLCON_IGNORE)" in report.failure
    assert [finding.rule for finding in report.findings] == ["nothing-analysed"]


def test_all_findings_before(run: Run, snapshot):
    lines = []
    for case in CASES:
        lines.append(name_of(case))
        for f in run(case, "before").findings:
            lines.append(f"  {f.severity} {f.rule} {f.path}:{f.line} {f.subject} [{', '.join(f.targets)}] {f.message}")
    assert "\n".join(lines) == snapshot


@pytest.mark.parametrize("rule", all_rules().values(), ids=lambda rule: rule.name)
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
