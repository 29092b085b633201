"""docs/rules.md says what the rules say of themselves."""

import re
import subprocess
import sys
from pathlib import Path

from rosimpact.impact.rules.rule import all_rules

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs/rules.md").read_text(encoding="utf-8")


def test_the_page_is_current():
    """Run `python docs/rules.py > docs/rules.md` when this fails."""
    command = [sys.executable, "-X", "utf8", ROOT / "docs/rules.py"]
    result = subprocess.run(command, capture_output=True, encoding="utf-8", check=True)
    assert result.stdout == PAGE


def test_every_rule_has_a_line():
    assert sorted(re.findall(r"^\| \[`([\w-]+)`\]", PAGE, re.MULTILINE)) == sorted(all_rules())
