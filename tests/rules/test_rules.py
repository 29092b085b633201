"""Every rule on its own small workspaces: it speaks on `before`, and is silent on `after`, on every target.

A case is a folder `<family>/<rule>/`, with underscores for dashes, that holds the workspaces `before` and `after`, and a
file `targets` with one target a line. Rules of the interfaces family compare `after` (the base) with `before` (the
change). One snapshot shows every finding of every rule over all `before` workspaces, so that a stray hit of another rule
is seen in review.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from rosimpact.impact.base import compare
from rosimpact.impact.check import Options, check
from rosimpact.impact.rules.rule import all_rules

HERE = Path(__file__).parent
CASES = sorted(p.parent for p in HERE.glob("*/*/before"))


def name_of(case: Path) -> str:
    return case.name.replace("_", "-")


def run(case: Path, which: str):
    targets = tuple((case / "targets").read_text().split())
    if case.parent.name == "interfaces":
        findings = compare(case / which, case / "after", Options(targets=targets, preview=True)).findings
    else:
        findings = check(case / which, Options(targets=targets, preview=True)).findings
    return findings


@pytest.mark.parametrize("case", CASES, ids=name_of)
def test_it_speaks_before(case):
    assert name_of(case) in {f.rule for f in run(case, "before")}


@pytest.mark.parametrize("case", CASES, ids=name_of)
def test_it_is_silent_after(case):
    said = [f for f in run(case, "after") if f.rule == name_of(case) or f.severity == "error"]
    assert said == []


def test_every_rule_has_a_case():
    assert {name_of(c) for c in CASES} == set(all_rules())


def test_all_findings_before(snapshot):
    lines = []
    for case in CASES:
        lines.append(f"{case.parent.name}/{name_of(case)}")
        for f in run(case, "before"):
            lines.append(f"  {f.severity} {f.rule} {f.path}:{f.line} {f.subject} [{', '.join(f.targets)}] {f.message}")
    assert "\n".join(lines) == snapshot


@pytest.mark.parametrize("rule", all_rules().values(), ids=lambda r: r.name)
def test_documentation_has_its_sections(rule):
    text = rule.documentation
    assert text.startswith(f"{rule.name}: ")
    for section in ("What it does\n", "Why it "):
        assert section in text, f"{rule.name} lacks the section {section.strip()}"
