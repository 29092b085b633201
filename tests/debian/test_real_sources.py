"""Real packages in CI: ROS 1 as Debian ships it, read from the source packages.

`.ci/debian-sources FOLDER` unpacks them; ROSIMPACT_DEBIAN_SOURCES names the folder. What is known of them was found by
reading them, not by running the checker.
"""

import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from rosimpact.impact import check_workspace

SOURCES = os.environ.get("ROSIMPACT_DEBIAN_SOURCES", "")
NAMES = ("ros-ros-comm", "ros-image-pipeline")

# Packages by source package and upstream version, counted by hand.
COUNTED = {("ros-ros-comm", "1.15.15"): 32, ("ros-image-pipeline", "1.17.0"): 8}


@pytest.fixture(scope="module", params=NAMES)
def name(request):
    folder(request.param)
    return request.param


def folder(name: str) -> Path:
    """Where a source package lies; skips the test when it is not there."""
    if not SOURCES:
        pytest.skip("ROSIMPACT_DEBIAN_SOURCES is not set; unpack the sources with .ci/debian-sources FOLDER")
    path = Path(SOURCES) / name
    if not path.is_dir():
        pytest.skip(f"{name} is not in {SOURCES}; .ci/debian-sources says why it could not be had")
    return path


def version(name: str) -> str:
    """The upstream version in debian/changelog, without epoch, revision and repacking suffix."""
    first = (folder(name) / "debian/changelog").read_text(encoding="utf-8").splitlines()[0]
    match = re.search(r"\((?:\d+:)?([\d.]+)", first)
    assert match, first
    return match[1]


def manifests(top: Path) -> Iterator[Path]:
    """Folders with a package.xml, none of them below another, hidden folders left out."""
    if (top / "package.xml").is_file():
        yield top
        return
    for entry in sorted(top.iterdir()):
        if entry.is_dir() and not entry.is_symlink() and not entry.name.startswith("."):
            yield from manifests(entry)


@pytest.fixture(scope="module")
def report(name):
    """The JSON report of the command line, which must not have failed."""
    program = Path(sys.executable).parent / "rosimpact"
    command = [program, "check", folder(name), "--target", "noetic", "--format", "json"]
    result = subprocess.run(command, capture_output=True, text=True)
    assert "Traceback" not in result.stderr, result.stderr
    assert result.returncode in (0, 1), result.stderr
    return json.loads(result.stdout)
