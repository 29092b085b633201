"""The command line, run in the test's own process; a browser; properties without a clock."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import hypothesis
import pytest

# A busy machine is no failure.
hypothesis.settings.register_profile("untimed", deadline=None, suppress_health_check=[hypothesis.HealthCheck.too_slow])
hypothesis.settings.load_profile("untimed")


class Said(NamedTuple):
    """What a command said, and its exit status."""

    status: int
    out: str
    err: str

    @property
    def text(self) -> str:
        return self.out + self.err


@pytest.fixture(scope="session")
def browser():
    """A real Chromium, for pages. Skips where there is none."""
    selenium = pytest.importorskip("selenium.webdriver", reason="selenium is not installed, see the `test` extra")
    chromium = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
    driver = shutil.which("chromedriver")
    if not chromium or not driver:
        pytest.skip("no browser: install chromium and chromium-driver to test pages")
    options = selenium.ChromeOptions()
    options.binary_location = chromium
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--window-size=1400,900"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    chrome = selenium.Chrome(options=options, service=selenium.ChromeService(driver))
    yield chrome
    chrome.quit()


@pytest.fixture
def opened(browser, tmp_path):
    """Opens a page given as text, and gives the browser; fragment: what follows the `#` of its address."""

    def show(text: str, fragment: str = ""):
        file = tmp_path / "page of ours.html"
        file.write_text(text, encoding="utf-8")
        browser.get("about:blank")
        browser.get_log("browser")
        browser.get_log("performance")
        browser.get(file.as_uri() + fragment)
        return browser

    return show


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
