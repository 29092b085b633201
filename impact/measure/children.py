"""Processes that the experiment starts: nodes, a master, `ip`, `tc`, compilers. None of them outlives it."""

from __future__ import annotations

import contextlib
import ctypes
import os
import selectors
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from ...edges.console import UserError
from ...edges.files import read_file

MARK = "measure:"
"""How lines begin that are meant for the runner; see nodes/__init__.py."""
_SYSTEM = ("/usr/sbin", "/usr/bin", "/sbin", "/bin")
_KEPT = ("HOME", "LANG", "LC_ALL", "TMPDIR", "USER")
_PR_SET_PDEATHSIG = 1
_TAIL = 600
_LOG = 64 << 20


def find_program(name: str) -> str:
    """The path of a program of the system, wherever the user's PATH looks; empty when it is not installed."""
    for folder in _SYSTEM:
        if os.access(f"{folder}/{name}", os.X_OK):
            return f"{folder}/{name}"
    return ""


def make_clean_environment() -> dict[str, str]:
    """What programs of the system are given: nothing of a virtual environment or a sourced ROS."""
    return {
        **{name: os.environ[name] for name in _KEPT if name in os.environ},
        "PATH": ":".join(_SYSTEM),
        "PYTHONDONTWRITEBYTECODE": "1",
    }


def _die_with_parent() -> None:
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)


def run_program(command: Sequence[str], environment: Mapping[str, str] | None = None, seconds: float = 60) -> str:
    """What a program prints on its standard output. Raises UserError where it fails, with the end of what it said."""
    try:
        ended = subprocess.run(
            command, env=dict(environment or make_clean_environment()), stdin=subprocess.DEVNULL, capture_output=True,
            encoding="utf-8", errors="replace", timeout=seconds, check=False, start_new_session=True,
            preexec_fn=_die_with_parent if sys.platform == "linux" else None,
        )  # fmt: skip
    except OSError as error:
        raise UserError(f"{command[0]}: cannot be started: {error.strerror}") from None
    except subprocess.TimeoutExpired:
        raise UserError(f"`{' '.join(command)}` did not end within {seconds:g} s") from None
    if ended.returncode:
        said = " ".join((ended.stderr or ended.stdout).split())[-_TAIL:]
        raise UserError(f"`{' '.join(command)}` failed: {said or f'status {ended.returncode}'}")
    return ended.stdout


class Child:
    """A process in a session of its own that is spoken with by lines. log: gets its standard error."""

    def __init__(self, command: Sequence[str], environment: Mapping[str, str], log: Path):
        self._log, self._read = log, b""
        with open(log, "wb") as errors:
            self._process = subprocess.Popen(
                command, env=dict(environment), stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=errors,
                start_new_session=True, preexec_fn=_die_with_parent if sys.platform == "linux" else None,
            )  # fmt: skip

    def send(self, line: str) -> None:
        """Writes a line to its standard input. Raises UserError where it has ended."""
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(f"{line}\n".encode())
            self._process.stdin.flush()
        except (BrokenPipeError, OSError):
            raise UserError(self._describe_end()) from None

    def wait_for_line(self, seconds: float) -> str:
        """The next line that is meant for the runner. Raises UserError where none comes in time."""
        assert self._process.stdout is not None
        until = time.monotonic() + seconds
        with selectors.DefaultSelector() as selector:
            selector.register(self._process.stdout, selectors.EVENT_READ)
            while True:
                while b"\n" in self._read:
                    line, _, self._read = self._read.partition(b"\n")
                    text = line.decode("utf-8", "replace")
                    if text.startswith(MARK):
                        return text[len(MARK) :]
                left = until - time.monotonic()
                if left <= 0:
                    raise UserError(f"a node said nothing for {seconds:g} s: {self.read_end()}")
                if selector.select(left):
                    data = os.read(self._process.stdout.fileno(), 1 << 16)
                    if not data:
                        raise UserError(self._describe_end())
                    self._read += data

    def wait(self, seconds: float) -> None:
        """Waits until it ends. Raises UserError where it does not, or fails."""
        try:
            status = self._process.wait(seconds)
        except subprocess.TimeoutExpired:
            raise UserError(f"a node did not end within {seconds:g} s: {self.read_end()}") from None
        if status:
            raise UserError(self._describe_end())

    def is_running(self) -> bool:
        """Whether it has not ended."""
        return self._process.poll() is None

    def read_end(self) -> str:
        """The end of what it said on its standard error."""
        with contextlib.suppress(OSError):
            said = read_file(self._log, _LOG)[-_TAIL:].decode("utf-8", "replace")
            return " ".join(said.split()) or "it said nothing"
        return "it said nothing"

    def _describe_end(self) -> str:
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(1)
        return f"a node ended with status {self._process.poll()}: {self.read_end()}"

    def stop(self) -> None:
        """Ends it, and what it started."""
        for stream in (self._process.stdin, self._process.stdout):
            if stream is not None:
                with contextlib.suppress(OSError):
                    stream.close()
        for number, seconds in ((signal.SIGTERM, 2.0), (signal.SIGKILL, 10.0)):
            if self._process.poll() is None:
                with contextlib.suppress(ProcessLookupError):
                    os.killpg(self._process.pid, number)
                with contextlib.suppress(subprocess.TimeoutExpired):
                    self._process.wait(seconds)


@contextlib.contextmanager
def hold_signals() -> Iterator[None]:
    """Within it, Ctrl-C and the request to end wait: what was set up is removed first."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
