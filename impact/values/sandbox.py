"""Runs programs of a workspace apart from this process: limits, an own folder, no network where the system allows it.

A workspace is hostile input. What is run here is its own code, and only because the user asked for it.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from ...edges.files import read_text

# Sets limits and leaves the network, then becomes the program; its own file says whether the network is gone.
_LAUNCHER = """
import ctypes, os, resource, sys
status, seconds, memory, size, *command = sys.argv[1:]
def limit(kind, most):
    hard = resource.getrlimit(kind)[1]
    resource.setrlimit(kind, (most if hard < 0 else min(most, hard),) * 2)
limit(resource.RLIMIT_CPU, int(seconds))
limit(resource.RLIMIT_FSIZE, int(size))
limit(resource.RLIMIT_CORE, 0)
if int(memory):
    limit(resource.RLIMIT_AS, int(memory))
gone = False
try:
    own = 0x40000000 if os.geteuid() == 0 else 0x40000000 | 0x10000000
    gone = ctypes.CDLL(None).unshare(own) == 0
except (AttributeError, OSError):
    pass
with open(status, "w") as file:
    file.write("offline" if gone else "online")
os.execvp(command[0], command)
"""
_MOST_OUTPUT = 5_000_000


class Finished(NamedTuple):
    """How a program ended. status: its exit status, negative for a signal. is_late: it was stopped at the time limit.
    is_offline: it had no network."""

    status: int
    output: str
    errors: str
    is_late: bool
    is_offline: bool


def run_apart(
    command: Sequence[str], folder: Path, *, text: str = "", seconds: float = 10.0, memory: int = 0,
    environment: Mapping[str, str] | None = None,
) -> Finished:  # fmt: skip
    """Runs a command in a folder of its own with some text as input.

    seconds: of the clock, and of the processor rounded up. memory: bytes of addresses, 0 for no limit (a program with
    AddressSanitizer reserves terabytes and has a limit of its own). environment: besides PATH and a folder for
    temporary files. Raises OSError where the command cannot be started."""
    with tempfile.TemporaryDirectory(prefix="rosimpact-") as own:
        status = Path(own, "status")
        limits = (str(status), str(int(seconds) + 1), str(memory), str(50_000_000))
        known = {"PATH": os.environ.get("PATH", os.defpath), "TMPDIR": own, "HOME": own, "LANG": "C.UTF-8"}
        process = subprocess.Popen(
            [sys.executable, "-I", "-c", _LAUNCHER, *limits, *command], cwd=folder, stdin=subprocess.PIPE,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace", start_new_session=True,
            env={**known, **(environment or {})},
        )  # fmt: skip
        is_late = False
        try:
            output, errors = process.communicate(text, timeout=seconds)
        except subprocess.TimeoutExpired:
            is_late = True
            _stop(process)
            output, errors = process.communicate()
        except BaseException:
            _stop(process)
            raise
        finally:
            _stop(process)
        told = read_text(status, 100) if status.exists() else ""
        return Finished(process.returncode, output[:_MOST_OUTPUT], errors[:_MOST_OUTPUT], is_late, told == "offline")


def _stop(process: subprocess.Popen[str]) -> None:
    """Ends a program with everything that it started."""
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except (ProcessLookupError, PermissionError):
        if process.poll() is None:
            process.kill()
