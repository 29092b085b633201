"""Builds data/sonames.json.zst: which platform has which versioned shared library, and in which package.

Read from the Contents and Packages indices of Debian and Ubuntu suites, as apt keeps them. Every file whose name is
that of a versioned library counts, wherever below a lib folder it lies: an index does not say which of them are
sonames, and one name too many never makes a library count as gone. Only names, versions and their relations are kept.

    python -P -m rosimpact.databuild.sonames --suite "debian bookworm=LISTS" --output DATA

LISTS is a `Dir::State::lists` folder of an apt that was told to fetch Contents indices as well.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import NamedTuple

from ..impact.targets.machine.sonames import FILE, SonamesTable
from ..impact.targets.tables import DATA
from .providers import unpack
from .table_file import write_table

_LIBRARY = re.compile(rb"(?:usr/)?lib(?:32|64|x32)?/(?!debug/)(?:[^ \t]*/)?([^/ \t]+\.so\.\d[\w.+~-]*)[ \t]+(\S+)$")
_NO_LIBRARY = (b".py", b".gz", b".hmac", b".txt")


class SuiteLibraries(NamedTuple):
    """What the indices of one suite say. libraries: file name to a package that has it. symbols: how far the versions
    of symbols reach, by their kind (`GLIBC`, `GLIBCXX`)."""

    platform: str
    libraries: dict[str, str]
    symbols: dict[str, str]


def read_suite(platform: str, lists: Path) -> SuiteLibraries:
    """Reads one suite's indices from an apt lists folder. Raises FileNotFoundError without them."""
    contents = sorted(lists.glob("*Contents-*"))
    packages = sorted(lists.glob("*_Packages*"))
    if not contents or not packages:
        raise FileNotFoundError(f"{lists}: no Contents or no Packages index; enable apt's Contents targets and update")
    libraries = parse_libraries(line for index in contents for line in unpack(index))
    return SuiteLibraries(
        platform, libraries, parse_symbols(libraries, (line for index in packages for line in unpack(index)))
    )


def parse_libraries(lines: Iterable[bytes]) -> dict[str, str]:
    """File name to package, from the lines of a Contents index."""
    found: dict[str, str] = {}
    for line in lines:
        match = _LIBRARY.match(line.rstrip())
        if match and not match[1].endswith(_NO_LIBRARY):
            # Of several packages the shortest name: `libfoo1`, and not `libfoo1-dbg`.
            names = [item.rpartition(b"/")[2].decode() for item in match[2].split(b",")]
            name = match[1].decode("utf-8", "replace")
            known = found.get(name)
            found[name] = min([*names, *([known] if known else [])], key=lambda n: (len(n), n))
    return found


def parse_symbols(libraries: Mapping[str, str], lines: Iterable[bytes]) -> dict[str, str]:
    """How far the versions of symbols of the C and C++ libraries reach. lines: those of a Packages index.

    glibc 2.36 has symbols up to GLIBC_2.36; libstdc++.so.6.0.30 is the one that added GLIBCXX_3.4.30 (GCC, "libstdc++
    ABI Policy and Guidelines").
    """
    found: dict[str, str] = {}
    package = ""
    for line in lines:
        key, _, value = line.decode("utf-8", "replace").rstrip().partition(": ")
        if key == "Package":
            package = value
        elif key == "Version" and package == "libc6":
            found["GLIBC"] = re.split(r"[-+~]", value.partition(":")[2] or value, maxsplit=1)[0]
    own = (name for name, package in libraries.items() if package == "libstdc++6")
    numbers = [int(match[1]) for name in own if (match := re.fullmatch(r"libstdc\+\+\.so\.6\.0\.(\d+)", name))]
    if numbers:
        found["GLIBCXX"] = f"3.4.{max(numbers)}"
    return found


def build_table(suites: Iterable[SuiteLibraries]) -> SonamesTable:
    """The table of all suites, a later suite's package standing for a library that several have."""
    suites = list(suites)
    bits: dict[str, int] = {}
    packages: dict[str, str] = {}
    for place, suite in enumerate(suites):
        for name, package in suite.libraries.items():
            bits[name] = bits.get(name, 0) | 1 << place
            packages[name] = package
    return SonamesTable(
        tuple(suite.platform for suite in suites),
        tuple(suite.symbols for suite in suites),
        "\n".join(f"{name} {bits[name]} {packages[name]}" for name in sorted(bits)),
    )


def main(arguments: list[str] | None = None) -> None:
    """The command line described at the top."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--suite", action="append", default=[], help='"debian bookworm=LISTS"')
    parser.add_argument("--output", type=Path, default=DATA)
    given = parser.parse_args(arguments)
    suites = []
    for item in given.suite:
        platform, _, lists = item.partition("=")
        suites.append(read_suite(platform, Path(lists)))
        print(platform, len(suites[-1].libraries), "libraries", suites[-1].symbols, flush=True)
    size = write_table(given.output / FILE, build_table(suites), level=22)
    print(size, "bytes packed")


if __name__ == "__main__":
    main()
