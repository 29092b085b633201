"""The command line, run in the test's own process; a browser; properties without a clock."""

from __future__ import annotations

import contextlib
import ctypes
import functools
import gc
import os
import shutil
import signal
import struct
import sys
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

import hypothesis
import pytest

# A busy machine is no failure.
hypothesis.settings.register_profile("untimed", deadline=None, suppress_health_check=[hypothesis.HealthCheck.too_slow])
hypothesis.settings.load_profile("untimed")


# A shell that starts the tests in the background has them ignore Ctrl-C, and all that they start would ignore it too.
if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


_FIRST = (
    "hostile/test_attacks.py", "debian/", "measure/", "prune/", "values/", "test_processes.py", "test_damaged_cache.py",
    "test_report_cache.py", "test_signals.py", "test_gather.py", "test_surface_command.py", "corpus/test_study.py",
    "packaging/", "targets/test_cluster.py", "test_", "rules/test_other_rules.py", "rules/test_rules.py",
    "rules/test_silence.py", "corpus/", "classifier/",
)  # fmt: skip
"""Beginnings of the paths of tests that come first, in this order: those that start processes, while the process of the
tests is small and forks fast; then those that take long, so that with -n all processes end with short ones."""


def pytest_configure(config: pytest.Config) -> None:
    """Has each process of -n begin with another folder: a file that one has compiled the others only load. To compile
    all test files takes as long as all else that collecting takes."""
    worker = getattr(config, "workerinput", None)
    here = Path(__file__).parent
    if worker is None or [Path(config.invocation_params.dir, name) for name in config.args] != [here]:
        return
    entries = sorted(str(path) for path in here.iterdir() if path.is_dir() or path.match("test_*.py"))
    number, count = int(worker["workerid"].removeprefix("gw")), worker["workercount"]
    start = len(entries) * number // count
    config.args = [*entries[start:], *entries[:start]]


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Sorts files by _FIRST and then by their paths; within a file nothing moves."""

    @functools.cache
    def find_place(file: Path) -> tuple[int, tuple[str, ...]]:
        path = file.relative_to(Path(__file__).parent)
        beginnings = (rank for rank, start in enumerate(_FIRST) if path.as_posix().startswith(start))
        return next(beginnings, len(_FIRST)), path.parts

    items.sort(key=lambda item: find_place(item.path))


@pytest.hookimpl(hookwrapper=True)
def pytest_collection() -> Iterator[None]:
    """Collects tests without looking for garbage, of which there is next to none: a quarter of the time it takes."""
    gc.disable()
    yield
    gc.enable()


def pytest_collection_finish(session: pytest.Session) -> None:
    """Leaves what was loaded and collected out of garbage collection, and looks for cycles as seldom as the program
    does: a fifth of the time of many tests."""
    del session
    gc.collect()
    with contextlib.suppress(AttributeError, OSError, TypeError):  # only where the C library is glibc
        ctypes.CDLL(None).malloc_trim(0)  # 130 MB of what was only needed to collect, which every fork would take along
    gc.freeze()
    gc.set_threshold(200_000, 20, 100)


@pytest.hookimpl(trylast=True)
def pytest_runtest_teardown() -> None:
    """Looks for cycles once tests have left many files open: with thresholds that high, what a few hundred of them
    leave to garbage collection would use up the 1,024 files that many machines allow a process."""
    global _open_files_allowed
    if _count_open_files() > _open_files_allowed:
        gc.collect()
        _open_files_allowed = _count_open_files() + _MORE_FILES


_MORE_FILES = 100
_open_files_allowed = _MORE_FILES


def _count_open_files() -> int:
    """How many files the process holds open; 0 where the system does not say."""
    try:
        return len(os.listdir("/proc/self/fd"))
    except OSError:
        return 0


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers() -> int:
    """With -n auto one process more than there are cores: some tests wait for a time-out or for a process that they
    have started, and leave their core without work for a seventh of the time."""
    from rosimpact.edges import processes

    return processes.count_cores() + 1


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--update-cases", action="store_true", help="write the findings that cases of rules expect")


class Said(NamedTuple):
    """What a command said, and its exit status."""

    status: int
    out: str
    err: str

    @property
    def text(self) -> str:
        return self.out + self.err


MACHINES = {"EM_X86_64": 62, "EM_AARCH64": 183, "EM_RISCV": 243}


def elf_bytes(
    machine: str, needed: Iterable[str] = (), soname: str = "", runpath: str = "", program: bool = False
) -> bytes:
    """The bytes of a small but whole ELF file of 64 bits that is linked at run time and does nothing."""
    strings = bytearray(b"\0")

    def at(text: str) -> int:
        strings.extend(text.encode() + b"\0")
        return len(strings) - len(text) - 1

    tags = [(1, at(name)) for name in needed]  # DT_NEEDED
    tags += [(14, at(soname))] if soname else []  # DT_SONAME
    tags += [(29, at(runpath))] if runpath else []  # DT_RUNPATH
    start = 64 + 2 * 56
    size = 16 * (len(tags) + 3)
    tags += [(5, start + size), (10, len(strings)), (0, 0)]  # DT_STRTAB, DT_STRSZ, DT_NULL
    dynamic = b"".join(struct.pack("<QQ", *tag) for tag in tags)
    whole = start + size + len(strings)
    ident = b"\x7fELF" + bytes([2, 1, 1]) + bytes(9)
    kind = 2 if program else 3  # ET_EXEC, ET_DYN
    head = ident + struct.pack("<HHIQQQIHHHHHH", kind, MACHINES[machine], 1, 0, 64, 0, 0, 64, 56, 2, 0, 0, 0)
    load = struct.pack("<IIQQQQQQ", 1, 5, 0, 0, 0, whole, whole, 4096)
    segment = struct.pack("<IIQQQQQQ", 2, 6, start, start, start, size, size, 8)
    return head + load + segment + dynamic + bytes(strings)


@pytest.fixture(scope="session")
def made_elf() -> Callable[..., bytes]:
    """elf_bytes()."""
    return elf_bytes


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

    yield show
    # A page that is left open goes on working beside the tests that follow.
    browser.get("about:blank")


@pytest.fixture(scope="session")
def cache(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A cache folder that tests share, those of other processes too, so that the data is unpacked once and what depends
    on a target alone is worked out once."""
    place = tmp_path_factory.getbasetemp()
    folder = (place.parent if "PYTEST_XDIST_WORKER" in os.environ else place) / "cache"
    folder.mkdir(exist_ok=True)
    return folder


@pytest.fixture
def say(capfd, cache, monkeypatch) -> Callable[..., Said]:
    """Runs `rosimpact ...` and gives what it said. The environment of whoever runs the tests plays no part."""
    monkeypatch.setenv("NO_COLOR", "1")
    monkeypatch.setenv("ROSIMPACT_CACHE", str(cache))
    for name in ("ROS_DISTRO", "GITHUB_WORKSPACE", "GITHUB_STEP_SUMMARY", "FORCE_COLOR", "ROSIMPACT_DEBUG"):
        monkeypatch.delenv(name, raising=False)

    def run(*arguments: object) -> Said:
        from rosimpact.impact.cli import app as cli

        monkeypatch.setattr(sys, "argv", ["rosimpact", *map(os.fsdecode, map(str, arguments))])
        capfd.readouterr()
        with pytest.raises(SystemExit) as ended:
            cli.main()
        out, err = capfd.readouterr()
        code = ended.value.code
        return Said(code if isinstance(code, int) else 0 if code is None else 1, out, err)

    return run


@pytest.fixture(scope="session", autouse=True)
def commands_built_once() -> Iterator[None]:
    """Typer builds every command anew each time one is called, which takes 40 ms: more than many a command."""
    import typer.main
    import typer.testing

    build = functools.cache(typer.main.get_command)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(typer.main, "get_command", build)
        patch.setattr(typer.testing, "_get_command", build)
        yield


_IN_ONE_PROCESS = {
    "rules", "model", "report", "targets", "facts", "flow", "test_bad_input.py", "test_base.py", "test_check.py",
    "test_cli.py", "test_env_diff.py", "test_findings.py", "test_fix.py", "test_graph.py", "test_cross_target_fix.py",
    "test_impact_command.py", "test_installed.py", "test_new_rule.py", "test_one_change.py", "test_report_cache.py",
    "test_surface_command.py", "test_upgrade.py", "test_why.py",
}  # fmt: skip
"""Folders and files of tests that look at what is found, not at how it is divided among processes; that has tests of
its own (test_processes.py, test_gather.py, test_signals.py, test_same_every_time.py, hostile/)."""


@pytest.fixture(autouse=True)
def one_process(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """A forked process decodes anew what the tests before it have decoded already, and a fork of a process that has
    grown to a gigabyte of tests takes longer than most of them."""
    if request.path.relative_to(Path(__file__).parent).parts[0] in _IN_ONE_PROCESS:
        from rosimpact.edges import processes

        monkeypatch.setattr(processes, "may_fork", lambda: False)
        monkeypatch.setattr(processes, "count_cores", lambda: 1)
