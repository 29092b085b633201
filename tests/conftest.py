"""The command line, run in the test's own process."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest


class Said(NamedTuple):
    """What a command said, and its exit status."""

    status: int
    out: str
    err: str

    @property
    def text(self) -> str:
        return self.out + self.err


@pytest.fixture(scope="session")
def cache(tmp_path_factory) -> Path:
    """A cache folder that tests share, so that the data is unpacked once."""
    return tmp_path_factory.mktemp("cache")


@pytest.fixture
def say(capfd, cache, monkeypatch) -> Callable[..., Said]:
    """Runs `rosimpact ...` and gives what it said. The environment of whoever runs the tests plays no part."""
    monkeypatch.setenv("NO_COLOR", "1")
    monkeypatch.setenv("ROSIMPACT_CACHE", str(cache))
    for name in ("ROS_DISTRO", "GITHUB_WORKSPACE", "GITHUB_STEP_SUMMARY", "FORCE_COLOR", "ROSIMPACT_DEBUG"):
        monkeypatch.delenv(name, raising=False)

    def run(*arguments: object) -> Said:
        from rosimpact.impact import cli

        monkeypatch.setattr(sys, "argv", ["rosimpact", *map(os.fsdecode, map(str, arguments))])
        capfd.readouterr()
        with pytest.raises(SystemExit) as ended:
            cli.main()
        out, err = capfd.readouterr()
        code = ended.value.code
        return Said(code if isinstance(code, int) else 0 if code is None else 1, out, err)

    return run
