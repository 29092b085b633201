"""The README's commands are those that are run, and what it points to is there."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
CHECK = (
    "python3 -m venv .venv || "
    "{ $(command -v sudo) sh -c 'apt-get update && apt-get install -y python3-venv' && python3 -m venv .venv; } && "
    ".venv/bin/pip install . && .venv/bin/rosimpact check examples/ros2_ws --fail-on never"
)
TEST = (
    "command -v git && python3 -m venv .venv || "
    "{ $(command -v sudo) sh -c 'apt-get update && apt-get install -y git python3-venv' && python3 -m venv .venv; } && "
    ".venv/bin/pip install '.[test]' && .venv/bin/python -m pytest -n auto"
)


def test_two_commands_set_up_and_run():
    lines = [line.strip() for line in README.splitlines() if "venv .venv" in line]
    assert lines == [CHECK, TEST]


def test_ci_runs_the_test_command_word_for_word():
    lines = [line.strip() for line in (ROOT / ".ci/run").read_text(encoding="utf-8").splitlines()]
    assert TEST in lines


def test_the_output_shown_is_real(tmp_path):
    """Run the command and paste what it prints when this fails; only the seconds may differ."""
    shown = re.search(r"```console\n\$ (.+)\n((?s:.)+?)```", README)
    assert shown
    program, *arguments = shown[1].split()
    result = subprocess.run(
        [Path(sys.executable).parent / program, *arguments],
        cwd=ROOT,
        env=os.environ | {"XDG_CACHE_HOME": str(tmp_path), "PYTHONUTF8": "1"},
        capture_output=True,
        encoding="utf-8",
    )
    assert without_seconds(result.stdout) == without_seconds(shown[2])


def without_seconds(text: str) -> str:
    return re.sub(r"· [\d.]+ s$", "", text.rstrip())


@pytest.mark.parametrize(
    "document",
    [
        *("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "DATA.md", "examples/README.md"),
        *(f"docs/{path.name}" for path in sorted((ROOT / "docs").glob("*.md"))),
    ],
)
def test_links_lead_somewhere(document):
    path = ROOT / document
    targets = re.findall(r"\]\(([^)#\s]+)[^)]*\)", path.read_text(encoding="utf-8"))
    missing = [target for target in targets if "://" not in target and not (path.parent / target).exists()]
    assert missing == []
