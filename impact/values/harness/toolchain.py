"""Compilers of the system: which there are, and how they are run."""

from __future__ import annotations

import math
import os
import re
import resource
import shutil
import signal
import subprocess
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import NamedTuple

from ..sandbox import make_limiter

OLDEST = 15
"""Of clang: from this version on, pointers in LLVM IR have no types."""
NO_CLANG = f"clang {OLDEST} or newer is needed to explore C++ callbacks: `sudo apt install clang` or clang-16, or newer"
NO_COMPILER = "a C++ compiler is needed to replay: `sudo apt install g++`"
NO_SANITIZER = (
    "clang's sanitizers are needed to replay sources of which parts are left out: `sudo apt install libclang-rt-dev`"
)
NO_FUZZER = "libFuzzer is needed for --fuzz: `sudo apt install clang libclang-rt-dev`"
_VERSION = re.compile(r"clang version ([0-9]+)")
_SECONDS = 180
_FILE_BYTES = 2_000_000_000


class CompilerRun(NamedTuple):
    """What a compiler said. status: -1 where it was stopped for its time or cannot be run. is_stopped: it had used up
    its time of the processor."""

    status: int
    out: str
    errors: str
    is_stopped: bool = False


class CompilerTime:
    """How long compilers may work for what is prepared together. seconds: of the processor, so that a busy machine
    changes nothing; used: those until now; rounds: how often a compiler ran."""

    def __init__(self, seconds: float):
        self.seconds = seconds
        self.used, self.rounds = 0.0, 0

    @property
    def is_over(self) -> bool:
        """Whether nothing is left."""
        return self.used >= self.seconds

    def describe(self) -> str:
        """That it is over, for the user."""
        return f"compiling took more than {self.seconds:g} s ({self.rounds} runs of the compiler)"

    def run(self, command: Sequence[str], folder: Path) -> CompilerRun:
        """Runs a compiler within what is left."""
        start = _measure_children()
        run = run_compiler(command, folder, processor=max(self.seconds - self.used, 1.0))
        self.used += _measure_children() - start
        self.rounds += 1
        if run.is_stopped:
            self.used = max(self.used, self.seconds)
        return run


def _measure_children() -> float:
    """The processor time of the processes that ended."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


@cache
def find_clang() -> str:
    """The clang++ that IR is made with, empty where there is none that is new enough."""
    for name in _list_clangs():
        if (version := _read_version(name)) and version >= OLDEST:
            return name
    return ""


@cache
def find_native_compiler(of_clang: bool = False) -> str:
    """The compiler that replays are built with: clang++, which has the facade compiled already, else g++, whose
    sanitizers come along; empty for none. of_clang: only clang++ will do."""
    clangs = _list_clangs()
    if (first := find_clang()) in clangs:
        clangs = [first, *(each for each in clangs if each != first)]
    for name in (*clangs, *(() if of_clang else ("g++",))):
        path = shutil.which(name)
        if path and _links(path, ("-fsanitize=address,undefined",), "int main() { return 0; }"):
            return path
    return ""


@cache
def find_fuzzer() -> str:
    """The clang++ that has libFuzzer, empty where there is none."""
    code = 'extern "C" int LLVMFuzzerTestOneInput(const unsigned char *, unsigned long) { return 0; }'
    return next((path for path in _list_clangs() if _links(path, ("-fsanitize=fuzzer,address",), code)), "")


def _list_clangs() -> list[str]:
    names = ["clang++", *(f"clang++-{number}" for number in range(30, 13, -1))]
    return [path for path in map(shutil.which, names) if path]


@cache
def describe_version(path: str) -> str:
    """What a compiler says of itself."""
    return run_compiler([path, "--version"], Path("/"), 20).out


@cache
def find_header_folders(path: str) -> tuple[str, ...]:
    """Where a compiler looks for headers by itself."""
    said = run_compiler([path, "-x", "c++", "-E", "-v", "-", "-o", os.devnull], Path("/"), 20).errors
    listed = said.partition("search starts here:\n")[2].partition("End of search list")[0]
    return tuple(each.strip() for each in listed.splitlines() if each.startswith(" /"))


def _read_version(path: str) -> int:
    found = _VERSION.search(describe_version(path))
    return int(found[1]) if found is not None else 0


def _links(path: str, flags: Sequence[str], code: str) -> bool:
    command = [path, "-x", "c++", *flags, "-", "-o", os.devnull]
    return run_compiler(command, Path("/"), 60, code).status == 0


def run_compiler(
    command: Sequence[str], folder: Path, seconds: float = _SECONDS, given: str = "", processor: float = 0.0
) -> CompilerRun:
    """Runs a compiler in a folder, with messages in English. given: its standard input. seconds: of the clock;
    processor: seconds of the processor, 0 for no limit."""
    environment = {"PATH": os.environ.get("PATH", os.defpath), "LC_ALL": "C", "HOME": str(folder)}
    limit = make_limiter(math.ceil(processor), _FILE_BYTES) if processor else None
    try:
        done = subprocess.run(
            list(command), cwd=folder, env=environment, input=given, capture_output=True, text=True,
            errors="replace", timeout=seconds, preexec_fn=limit,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        return CompilerRun(-1, "", f"{Path(command[0]).name} took more than {seconds:.0f} seconds")
    except OSError as error:
        return CompilerRun(-1, "", f"{command[0]}: {error.strerror or error}")
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        return CompilerRun(-1, "", f"{Path(command[0]).name} was stopped for its time", is_stopped=True)
    return CompilerRun(done.returncode, done.stdout, done.stderr)
