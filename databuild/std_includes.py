"""Builds data/providers_std.json.zst: which standard headers each standard header reads, by GCC.

    python -P -m rosimpact.databuild.std_includes 13=FOLDER 15=FOLDER ... --output DATA

FOLDER as for std_names.py. Each header is preprocessed alone, under the language standards in use; where they differ,
all that any of them reads counts. Of libstdc++'s own headers those count that are named in data/std_headers.json. GCCs
that the table has and no folder is given of stay as they are.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import tempfile
from collections.abc import Collection, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import zstandard

from ..impact.targets.providers.standard import DEFINED_IN
from ..impact.targets.tables import DATA
from .std_names import Probe
from .table_file import write_table

FILE = "providers_std.json.zst"
STANDARDS = (11, 14, 17, 20)
_OF_SYSTEM = ("pthread.h", "unistd.h")
"""Headers of POSIX that are asked about beside those of C++ and C."""


def list_headers(probe: Probe) -> list[str]:
    """The headers of a compiler's own C++ library."""
    return sorted(path.name for path in probe.places[0].iterdir() if path.is_file() and "." not in path.name)


def list_told(headers: Iterable[str]) -> frozenset[str]:
    """What is told of headers: which of these each reads. headers: those of the compiler."""
    named = {header for found in DEFINED_IN.values() for header in found}
    return frozenset((*headers, *named, *_OF_SYSTEM, *(f"{one[1:]}.h" for one in headers if one.startswith("c"))))


def parse_read(text: str, places: Collection[Path], told: Collection[str]) -> set[str]:
    """The headers of a rule for make, as `-M` writes it, that are told of; those of libstdc++ without their ending."""
    found = set()
    for word in text.replace("\\\n", " ").split()[1:]:
        for place in places:
            if word.startswith(f"{place}/"):
                name = word.removeprefix(f"{place}/")
                found.update({name, name.removesuffix(".h")} & frozenset(told))
    return found


def read_headers(probe: Probe) -> dict[str, str]:
    """Each header that a compiler has to those that it reads, space separated; those that read none are left out."""
    headers = list_headers(probe)
    told = list_told(headers)

    def read(header: str) -> tuple[str, set[str]]:
        found: set[str] = set()
        with tempfile.TemporaryDirectory() as folder:
            source = Path(folder, "probe.cpp")
            source.write_text(f"#include <{header}>\n")
            for standard in STANDARDS:
                run = subprocess.run(
                    [*(word for word in probe.command if word != "-fsyntax-only"), "-E", "-M", f"-std=gnu++{standard}",
                     str(source)], capture_output=True, text=True, timeout=300, check=False,
                )  # fmt: skip
                if run.returncode == 0:
                    found |= parse_read(run.stdout, probe.places, told)
        return header, found - {header}

    with ThreadPoolExecutor(2) as pool:
        return {header: " ".join(sorted(found)) for header, found in pool.map(read, headers) if found}


def build_table(folders: Mapping[int, Path], before: Mapping[str, dict[str, str]]) -> dict[str, dict[str, str]]:
    """The shipped table. before: that of other compilers."""
    made = dict(before)
    for major, folder in folders.items():
        made[str(major)] = read_headers(Probe(folder, major))
    return {major: made[major] for major in sorted(made, key=int)}


def main(arguments: list[str] | None = None) -> None:
    """The command line described at the top."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", metavar="GCC=FOLDER")
    parser.add_argument("--output", type=Path, default=DATA)
    given = parser.parse_args(arguments)
    folders = {int(major): Path(folder) for major, _, folder in (text.partition("=") for text in given.folders)}
    file = given.output / FILE
    before = json.loads(zstandard.ZstdDecompressor().decompress(file.read_bytes())) if file.exists() else {}
    made = build_table(folders, before)
    size = write_table(file, made)
    print(len(made), "compilers,", size, "bytes packed")


if __name__ == "__main__":
    main()
