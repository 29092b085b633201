"""The C++ programs of this folder: compiled as a harness is, explored, and what their comments expect.

`// crash: ENTRY KIND` marks a line on which an entry crashes; `// also: ...` beside an entry, what else may follow.
"""

import re
import shutil
import subprocess
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest
from rosimpact.impact.values.ir.explore import explore_program
from rosimpact.impact.values.ir.reader import Program
from rosimpact.impact.values.outcomes import Bounds, Exploration, Reaction

FOLDER = Path(__file__).parent / "programs"
_FLAGS = (
    "-std=c++17", "-O1", "-gline-tables-only", "-S", "-emit-llvm", "-fno-vectorize", "-fno-slp-vectorize",
    "-fno-unroll-loops", "-fno-jump-tables", "-fno-discard-value-names", "-DRI_SYMBOLIC", "-D_GLIBCXX_ASSERTIONS",
    "-D_GLIBCXX_EXTERN_TEMPLATE=0", "-w", "-fno-sanitize-recover=all",
    "-fsanitize=null,bounds,shift,integer-divide-by-zero,signed-integer-overflow,float-cast-overflow,return,"
    "unreachable,vla-bound",
)  # fmt: skip


@cache
def find_clang() -> str:
    """The newest clang++ from 15 on; empty where there is none."""
    for name in (*(f"clang++-{version}" for version in range(22, 14, -1)), "clang++"):
        path = shutil.which(name)
        if path:
            said = subprocess.run([path, "--version"], capture_output=True, text=True, check=False).stdout
            version = re.search(r"version (\d+)", said)
            if version and int(version[1]) >= 15:
                return path
    return ""


needs_clang = pytest.mark.skipif(not find_clang(), reason="needs clang 15 or newer")


@cache
def compile_program(name: str, folder: Path, *flags: str) -> Program:
    """A program of this folder as LLVM IR. folder: where it is written."""
    target = folder / f"{name}{len(flags)}.ll"
    subprocess.run([find_clang(), *_FLAGS, *flags, str(FOLDER / f"{name}.cpp"), "-o", str(target)], check=True)
    return Program([target.read_text(encoding="utf-8")])


def is_of_programs(path: str) -> bool:
    return path.startswith(str(FOLDER)) and not path.endswith("kit.h")


_PATIENT = Bounds(seconds=120)


def explore_entry(program: Program, entry: str, bounds: Bounds = _PATIENT) -> Exploration:
    return explore_program(program, entry, bounds, is_of_programs)


class Expected(NamedTuple):
    """crashes: kind and line; others: what else may follow."""

    crashes: set[tuple[str, int]]
    others: set[str]


def read_expected(name: str) -> dict[str, Expected]:
    """What the comments of a program say, by entry."""
    crashes: dict[str, set[tuple[str, int]]] = {}
    others: dict[str, set[str]] = {}
    entry = ""
    for number, line in enumerate((FOLDER / f"{name}.cpp").read_text(encoding="utf-8").splitlines(), 1):
        for name_of, kind in re.findall(r"crash: (\w+) ([A-Z_]+)", line):
            crashes.setdefault(name_of, set()).add((kind, number))
        if head := re.match(r"(?:EXPLORE|HARNESS)\((\w+),", line):
            entry = head[1]
        if said := re.search(r"// also: (.*)$", line):
            others[entry] = set(said[1].split(", "))
    return {each: Expected(crashes.get(each, set()), said) for each, said in others.items()}


def collect_outcomes(exploration: Exploration) -> Expected:
    """What was found, in the same form."""
    return Expected(
        {(path.crash.name, path.place.line) for path in exploration.paths if path.crash is not None},
        {path.result.value for path in exploration.paths if path.result is not Reaction.CRASH},
    )
