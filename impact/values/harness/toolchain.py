"""Compilers of the system: which there are, and how they are run."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import NamedTuple

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


class CompilerRun(NamedTuple):
    """What a compiler said. status: -1 where it was stopped for its time."""

    status: int
    out: str
    errors: str


@cache
def find_clang() -> str:
    """The clang++ that IR is made with, empty where there is none that is new enough."""
    for name in _list_clangs():
        if (version := _read_version(name)) and version >= OLDEST:
            return name
    return ""


@cache
def find_native_compiler(of_clang: bool = False) -> str:
    """The compiler that replays are built with: g++, whose sanitizers come along, else clang++; empty for none.
    of_clang: only clang++ will do."""
    for name in (*(() if of_clang else ("g++",)), *_list_clangs()):
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


def _read_version(path: str) -> int:
    found = _VERSION.search(describe_version(path))
    return int(found[1]) if found is not None else 0


def _links(path: str, flags: Sequence[str], code: str) -> bool:
    command = [path, "-x", "c++", *flags, "-", "-o", os.devnull]
    return run_compiler(command, Path("/"), 60, code).status == 0


def run_compiler(command: Sequence[str], folder: Path, seconds: float = _SECONDS, given: str = "") -> CompilerRun:
    """Runs a compiler in a folder, with messages in English. given: its standard input."""
    environment = {"PATH": os.environ.get("PATH", os.defpath), "LC_ALL": "C", "HOME": str(folder)}
    try:
        done = subprocess.run(
            list(command), cwd=folder, env=environment, input=given, capture_output=True, text=True,
            errors="replace", timeout=seconds,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        return CompilerRun(-1, "", f"{Path(command[0]).name} took more than {seconds:.0f} seconds")
    except OSError as error:
        return CompilerRun(-1, "", f"{command[0]}: {error.strerror or error}")
    return CompilerRun(done.returncode, done.stdout, done.stderr)
