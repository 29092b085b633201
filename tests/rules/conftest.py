"""Cases of rules, checked."""

from __future__ import annotations

from pathlib import Path

import pytest
import rule_cases
from rosimpact.impact.analysis.check import check
from rosimpact.impact.analysis.report import Report
from rosimpact.impact.analysis.session import Options
from rosimpact.impact.targets.machine.loader import detect_machine
from rule_cases import Case, CheckCase


@pytest.fixture(scope="session")
def check_case(tmp_path_factory, made_elf, cache) -> CheckCase:
    """Checks the workspace of a case by these rules, previews too; by all where none is named."""
    comparing = rule_cases.rules_that_compare()

    def make_installed(case: Case) -> Path:
        """Writes the workspace and its install space."""
        folder = rule_cases.write_files(tmp_path_factory.mktemp("installed"), case.files)
        for line in case.installed:
            machine, path, *needed = line.split()
            file = folder / "install" / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(made_elf(detect_machine() if machine == "here" else machine, needed))
        return folder

    def run(case: Case, rules: tuple[str, ...] = ()) -> Report:
        options = Options(targets=case.targets, select=rules, preview=True, cache=cache, jobs=1)
        if case.installed:
            folder = make_installed(case)
            return check(folder, options._replace(install=folder / "install"))
        return rule_cases.check_files(case.files, options, case.unchanged if case.rule in comparing else None)

    return run


@pytest.fixture
def updates(request: pytest.FixtureRequest) -> bool:
    """Whether expected findings are written rather than compared."""
    return request.config.getoption("--update-cases")
