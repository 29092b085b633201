"""Generated pages of docs/ say what the code says."""

import importlib.util
import re
from pathlib import Path

import pytest
from rosimpact.impact.rules.rule import load_rules

DOCS = Path(__file__).parents[2] / "docs"


@pytest.mark.parametrize("name", ["rules", "queries"])
def test_the_page_is_current(name):
    """Run `python docs/rules.py > docs/rules.md` (or queries) when this fails."""
    spec = importlib.util.spec_from_file_location(f"docs_{name}", DOCS / f"{name}.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    assert module.page() == (DOCS / f"{name}.md").read_text(encoding="utf-8")


def test_every_rule_has_a_line():
    page = (DOCS / "rules.md").read_text(encoding="utf-8")
    assert sorted(re.findall(r"^\| \[`([\w-]+)`\]", page, re.MULTILINE)) == sorted(load_rules())


def test_queries_of_every_kind_are_listed():
    """An attribute, a method, a cached one, and what a tuple of another module holds."""
    page = (DOCS / "queries.md").read_text(encoding="utf-8")
    for heading in ("TargetView", "Workspace", "Diagnostic", "Package", "DistroTarget"):
        assert page.count(f"\n## `{heading}`\n") == 1
    for row in ("`subject` | `str` |", "`reports_on(name)` | `bool` | True for", "`underlaid` | `bool` | True when"):
        assert f"\n| {row}" in page
