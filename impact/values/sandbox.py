"""Runs programs of a workspace apart from this process: limits, an own folder, no network where the system allows it.

A workspace is hostile input. What is run here is its own code, and only because the user asked for it.
"""

from __future__ import annotations

import os
import resource
import shutil
import signal
import subprocess
import tempfile
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import NamedTuple

from ...edges.files import read_text, write_file

_MOST_OUTPUT = 5_000_000
_FILE_BYTES = 50_000_000


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
    isolation = find_isolation()
    with tempfile.TemporaryDirectory(prefix="rosimpact-") as own:
        known = {"PATH": os.environ.get("PATH", os.defpath), "TMPDIR": own, "HOME": own, "LANG": "C.UTF-8"}
        given, told, errors = (Path(own, name) for name in ("input", "output", "errors"))
        write_file(given, text.encode())
        # Files, not pipes: what a program prints without an end stops at the limit of a file's size.
        with given.open("rb") as source, told.open("wb") as output, errors.open("wb") as complaints:
            process = subprocess.Popen(
                [*isolation, *command], cwd=folder, stdin=source, stdout=output, stderr=complaints,
                start_new_session=True, env={**known, **(environment or {})},
                preexec_fn=make_limiter(int(seconds) + 1, _FILE_BYTES, memory),
            )  # fmt: skip
            try:
                process.wait(seconds)
                is_late = False
            except subprocess.TimeoutExpired:
                is_late = True
            finally:
                end_group(process)
        texts = [read_text(path, _FILE_BYTES, "replace")[:_MOST_OUTPUT] for path in (told, errors)]
        return Finished(process.returncode, texts[0], texts[1], is_late, bool(isolation))


@cache
def find_isolation() -> tuple[str, ...]:
    """The command in front of a program that cuts the network off; empty where the system does not allow it."""
    unshare = shutil.which("unshare")
    for flags in (("--net", "--map-root-user"), ("--net",)):
        if unshare is None:
            break
        command = (unshare, *flags, "--")
        try:
            done = subprocess.run([*command, "true"], capture_output=True, timeout=10)
        except (OSError, subprocess.TimeoutExpired):
            continue
        if done.returncode == 0:
            return command
    return ()


def end_group(process: subprocess.Popen) -> None:
    """Ends a program with all that it started."""
    with suppress(ProcessLookupError, PermissionError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def make_limiter(seconds: int, file_bytes: int, memory: int = 0, files: int = 0) -> Callable[[], None]:
    """What a new process calls before it becomes a program. seconds: of the processor; memory: bytes of addresses;
    files: that are open at once; 0 for no limit of these two."""
    wanted = (
        (resource.RLIMIT_CPU, seconds), (resource.RLIMIT_FSIZE, file_bytes), (resource.RLIMIT_CORE, None),
        (resource.RLIMIT_AS, memory), (resource.RLIMIT_NOFILE, files),
    )  # fmt: skip

    def limit() -> None:
        for what, most in wanted:
            if most is None or most:
                hard = resource.getrlimit(what)[1]
                allowed = (most or 0) if hard < 0 else min(most or 0, hard)
                resource.setrlimit(what, (allowed, allowed))

    return limit
