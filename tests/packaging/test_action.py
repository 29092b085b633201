"""The GitHub action and the pre-commit hooks: well-formed, and their commands run."""

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest
import yaml

ROOT = Path(__file__).parents[2]
ACTION = yaml.safe_load((ROOT / "action.yml").read_text(encoding="utf-8"))
HOOKS = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text(encoding="utf-8"))
STEPS = ACTION["runs"]["steps"]
PROGRAM = Path(sys.executable).parent / "rosimpact"


def script(step_id: str) -> str:
    (step,) = [step for step in STEPS if step.get("id") == step_id]
    return step["run"]


class Ran(NamedTuple):
    """The step of the check after its run. folder: where it left its files."""

    folder: Path
    status: int
    outputs: dict[str, str]
    printed: str


def run_check_step(folder: Path, cache: Path, **inputs: str) -> Ran:
    """Runs the step as a runner does."""
    environment = {
        "PATH": f"{PROGRAM.parent}:{os.environ['PATH']}",
        "HOME": str(folder),
        "ROSIMPACT_CACHE": str(cache),
        "RUNNER_TEMP": str(folder),
        "GITHUB_OUTPUT": str(folder / "output"),
        "GITHUB_STEP_SUMMARY": str(folder / "summary"),
        "INPUT_PATH": str(ROOT / "examples/ros2_ws"),
        "INPUT_TARGETS": "",
        "INPUT_BASE": "",
        "INPUT_FAIL_ON": "",
        "INPUT_ARGUMENTS": "",
    } | {f"INPUT_{name.upper()}": value for name, value in inputs.items()}
    command = ["bash", "--noprofile", "--norc", "-e", "-o", "pipefail", "-c", script("check")]
    result = subprocess.run(command, env=environment, capture_output=True, text=True)
    lines = (folder / "output").read_text().splitlines()
    return Ran(folder, result.returncode, dict(line.split("=", 1) for line in lines), result.stdout)


@pytest.fixture(scope="module")
def step(tmp_path_factory, cache) -> Ran:
    """The step without any inputs."""
    return run_check_step(tmp_path_factory.mktemp("step"), cache)


@pytest.mark.parametrize(
    ("inputs", "status"),
    [
        ({"fail_on": "never"}, 0),
        ({"targets": "humble@2024-03-01 jazzy", "arguments": "--select removed-header"}, 1),
        ({"targets": "no-such-distro"}, 2),
    ],
)
def test_the_check_step(tmp_path, cache, inputs, status):
    ran = run_check_step(tmp_path, cache, **inputs)
    assert ran.status == status
    assert ran.outputs["status"] == str(status)


def test_the_check_step_without_inputs(step):
    assert step.status == 1
    assert step.outputs["status"] == "1"


def test_what_the_check_step_leaves(step):
    assert json.loads(Path(step.outputs["sarif-file"]).read_text())["version"] == "2.1.0"
    assert Path(step.outputs["html-file"]).read_text().lstrip().lower().startswith("<!doctype html>")
    assert len((step.folder / "rosimpact.markdown").read_text().splitlines()) <= 10
    assert (step.folder / "summary").read_text().count("- ❌ `src/porter_vision/CMakeLists.txt:16`") == 1
    assert re.search(r"^::error ", step.printed, re.MULTILINE)


def test_no_input_is_pasted_into_a_script():
    assert [step for step in STEPS if "${{" in step.get("run", "")] == []


def test_every_input_is_used():
    used = set(re.findall(r"inputs\.([a-z-]+)", (ROOT / "action.yml").read_text(encoding="utf-8")))
    assert used == set(ACTION["inputs"])


@pytest.mark.parametrize("hook", HOOKS, ids=lambda hook: hook["id"])
def test_hooks_know_their_options(hook):
    program, command, *options = shlex.split(hook["entry"])
    assert (program, hook["language"], hook["pass_filenames"]) == ("rosimpact", "python", False)
    environment = os.environ | {"COLUMNS": "200"}
    known = subprocess.run([PROGRAM, command, "--help"], capture_output=True, text=True, env=environment)
    assert [option for option in options if option not in known.stdout] == []


def test_nothing_of_the_checkout_runs_when_the_program_is_installed(tmp_path):
    """The step stands in the checkout of the pull request, which may hold modules of any name."""
    for name in ("venv", "ensurepip", "sitecustomize", "runpy"):
        (tmp_path / f"{name}.py").write_text("open('executed', 'w')")
    (install,) = [step["run"] for step in STEPS if step.get("name") == "Install rosimpact"]
    (making,) = [line for line in install.splitlines() if "-m venv" in line and line.strip().startswith('"$PYTHON"')]
    environment = {"PATH": os.environ["PATH"], "PYTHON": sys.executable, "RUNNER_TEMP": str(tmp_path / "temp")}
    subprocess.run(["bash", "-c", f"{making} --without-pip"], cwd=tmp_path, env=environment, check=True)
    assert (tmp_path / "temp/rosimpact-venv/bin/python").exists()
    assert not (tmp_path / "executed").exists()


def test_inputs_are_no_patterns_of_file_names():
    assert "set +e -fuo pipefail" in script("check")


def test_sarif_is_uploaded_by_what_the_check_says(step):
    """hashFiles() knows no files outside of the checkout, such as those in RUNNER_TEMP."""
    assert step.outputs["has-sarif"] == "true"
    assert "hashFiles" not in (ROOT / "action.yml").read_text(encoding="utf-8")


GH = """#!/bin/sh
if [ "$1" = pr ]; then cat "$HOME/comments.json" | jq -r "$9"; else echo "$@" >>"$HOME/calls"; fi
"""


@pytest.mark.skipif(shutil.which("jq") is None, reason="stands in for gh --jq")
@pytest.mark.parametrize(
    ("own", "call"),
    [
        (True, "api --silent -X PATCH repos/o/r/issues/comments/17 "),
        (False, "api --silent -X POST repos/o/r/issues/1/comments "),
    ],
)
def test_only_a_comment_of_our_own_is_changed(tmp_path, own, call):
    body = "<!-- rosimpact -->\nnothing breaks"
    comments = [
        {"viewerDidAuthor": False, "body": body, "url": "https://github.com/o/r/pull/1#issuecomment-16"},
        {"viewerDidAuthor": own, "body": body, "url": "https://github.com/o/r/pull/1#issuecomment-17"},
    ]
    (tmp_path / "comments.json").write_text(json.dumps({"comments": comments}))
    (tmp_path / "rosimpact.markdown").write_text("safe")
    (tmp_path / "gh").write_text(GH)
    (tmp_path / "gh").chmod(0o755)
    (step,) = [step["run"] for step in STEPS if step.get("name") == "Comment on the pull request"]
    environment = {
        "PATH": f"{tmp_path}:{os.environ['PATH']}", "HOME": str(tmp_path), "RUNNER_TEMP": str(tmp_path),
        "GITHUB_REPOSITORY": "o/r", "PULL_REQUEST": "1",
    }  # fmt: skip
    subprocess.run(["bash", "-e", "-o", "pipefail", "-c", step], env=environment, check=True)
    assert (tmp_path / "calls").read_text().startswith(call)
