"""Builds data/std_headers.json: which standard headers define the names of the standard library, since which C++
standard they have any, and what headers of C bring.

    python -P -m rosimpact.databuild.std_headers 9=FOLDER 13=FOLDER ... [--work WORK] --output DATA

FOLDER as for std_names.py. Every header is preprocessed alone under each C++ standard, and what remains of each file is
read as any header is. A header is of the first standard under which it declares something for users; that of the
compiler that has it first counts. A name is defined by the header that is its own and by the file of libstdc++ that
declares it. Functions that one file declares under the same standards are brought by the same headers: those that the
compilers are not asked about (std_names.py) are told with one that they are. A header of C brings `stdint.h` and the
like where a program that includes it alone may use what they define, in any of these releases.

Which names are told of is what the table before has. WORK keeps what was read of each compiler, so that a run that was
stopped goes on with the next header.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import re
import subprocess
import tempfile
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import msgspec

from ..edges.files import write_file
from ..impact.facts.surface import CLASSES
from ..impact.targets.tables import DATA
from ..impact.targets.unpacked import read_table
from .extract import cpp
from .std_includes import list_headers
from .std_names import NAMES, Probe, list_names

FILE = "std_headers.json"
STANDARDS = (98, 11, 14, 17, 20, 23, 26)
"""C++ standards, by the last digits of their years."""
_EARLY_NAMES = {20: "2a", 23: "2b", 26: "2c"}
"""As compilers call them that have them before they are standards; later ones do so too."""
_CONFIGURES = re.compile(
    r"bits/(?:c\+\+config|os_defines|cpu_defines|version|requires_hosted|\w*c\+\+0x_warning|wordsize)\.h\Z"
    r"|(?:pstl/pstl_config|features|sys/cdefs|gnu/stubs.*)\.h\Z"
)
"""Files that say how the others are compiled, which any of them includes."""
_MARK = re.compile(r'# \d+ "([^"\n]*)"[^\n]*\n?')
_BESIDE = ("algorithm", "numeric")
"""Headers whose functions other headers bring along, all those of one file together."""
_WORD = re.compile(r"[A-Za-z]\w*\Z")
_OWN_FILE = re.compile(r"bits/\w+(?<!fwd)\Z")
"""Files of libstdc++ that define; those called so only announce."""
_INCLUDED = re.compile(r"^\s*#\s*include\s*<([\w/]+)\.h>", re.MULTILINE)
_ASKED_UNDER = (14, 17, 20)
_C_NAMES = {
    "stdint.h": ("UINT8_MAX", "uint_fast32_t"),
    "bits/stdint-uintn": ("uint8_t",),
    "bits/stdint-intn": ("int8_t",),
    "limits.h": ("INT_MAX",),
    "math.h": ("hypot",),
    "float.h": ("FLT_MAX",),
    "unistd.h": ("usleep",),
}
"""What is told of headers of C, by names of each; the first covers the next two."""
_C_APART = re.compile(r"(?:c\+\+|asm|asm-generic|bits|gnu|rdma|x86_64-linux-gnu)/")
_KINDS = frozenset((*CLASSES, "enum", "alias", "function", "variable", "concept"))
_VERSIONED = re.compile(r"(?:_V\d+|__cxx11|__8)::")
"""Inline namespaces, which users do not write."""


class DeclaredNames(msgspec.Struct, frozen=True, array_like=True):
    """What a file declares for users. functions, others: of namespace std. elsewhere: whether there is anything outside
    of it."""

    functions: tuple[str, ...] = ()
    others: tuple[str, ...] = ()
    elsewhere: bool = False

    def __bool__(self) -> bool:
        return bool(self.functions or self.others or self.elsewhere)


Declaring = dict[str, DeclaredNames]
"""Files that declare anything, by their path (`bits/stl_algo`), with what of it is for users."""


class ReadCompiler(msgspec.Struct, frozen=True):
    """What was read of a compiler. headers: by standard. of_c: what headers of C bring. texts: of its own headers,
    those of C that libstdc++ has itself (`math.h`) among them."""

    headers: dict[str, dict[int, Declaring]]
    of_c: dict[str, tuple[str, ...]]
    texts: dict[str, str] = {}


class HeaderReader:
    """Reads the headers of one compiler. kept: the folder that keeps what was read."""

    def __init__(self, probe: Probe, kept: Path):
        self._probe, self._kept = probe, kept
        self._command = [word for word in probe.command if word != "-fsyntax-only"]
        self._declared: dict[str, DeclaredNames | None] = {}
        kept.mkdir(parents=True, exist_ok=True)

    def read(self) -> ReadCompiler:
        """All of it, printing how far it is."""
        headers = list_headers(self._probe)
        found = {}
        for place, header in enumerate(headers, 1):
            file = self._kept / f"{header}.msgpack"
            if not file.exists():
                write_file(file, msgspec.msgpack.encode(self._read_header(header)))
                print(f"{self._kept.name}: {header} {place}/{len(headers)}", flush=True)
            found[header] = msgspec.msgpack.decode(file.read_bytes(), type=dict[int, Declaring])
        file = self._kept / "c.msgpack"
        if not file.exists():
            write_file(file, msgspec.msgpack.encode(self._read_c_headers()))
        of_c = msgspec.msgpack.decode(file.read_bytes(), type=dict[str, tuple[str, ...]])
        texts = {
            path.name: path.read_text(errors="replace") for path in self._probe.places[0].iterdir() if path.is_file()
        }
        return ReadCompiler(found, of_c, texts)

    def _read_header(self, header: str) -> dict[int, Declaring]:
        with ThreadPoolExecutor(2) as pool:
            texts = pool.map(lambda standard: self._run_preprocessor(header, standard), STANDARDS)
        found = {}
        for standard, text in zip(STANDARDS, texts, strict=True):
            if text is not None:
                found[standard] = self._list_declared(text)
        return found

    def _run_preprocessor(self, header: str, standard: int) -> str | None:
        """A header and what it includes; None where the compiler stops at it, or has no such standard."""
        named = _EARLY_NAMES.get(standard, standard)
        with tempfile.TemporaryDirectory() as folder:
            source = Path(folder, "probe.cpp")
            source.write_text(f"#include <{header}>\n")
            run = subprocess.run(
                [*self._command, "-E", f"-std=c++{named}", str(source)], capture_output=True, text=True, timeout=300,
                errors="replace", check=False,
            )  # fmt: skip
        return run.stdout if run.returncode == 0 else None

    def _list_declared(self, text: str) -> Declaring:
        found = {}
        for name, part in split_files(text, self._probe.places).items():
            if not _CONFIGURES.search(name) and (names := self._list_names(part)) is not None:
                found[name.removesuffix(".h")] = names
        return found

    def _list_names(self, text: str) -> DeclaredNames | None:
        """What a file declares; None for nothing at all."""
        key = hashlib.sha1(text.encode()).hexdigest()
        if key not in self._declared:
            functions, others, elsewhere = set(), set(), False
            entities = [one for one in cpp.extract(text.encode()).entities if one.kind in _KINDS]
            for one in entities:
                plain = _VERSIONED.sub("", one.name)
                name = plain.removeprefix("std::")
                if any(part.startswith("_") or not _WORD.match(part) for part in name.split("::")):
                    continue
                if name == plain:
                    elsewhere = True
                else:
                    (functions if one.kind == "function" else others).add(name)
            read = DeclaredNames(tuple(sorted(functions)), tuple(sorted(others)), elsewhere)
            self._declared[key] = read if entities else None
        return self._declared[key]

    def _read_c_headers(self) -> dict[str, tuple[str, ...]]:
        headers = sorted(_list_c_headers(self._probe.folder))
        with ThreadPoolExecutor(2) as pool:
            return {header: found for header, found in zip(headers, pool.map(self._ask, headers), strict=True) if found}

    def _ask(self, header: str) -> tuple[str, ...]:
        """What a header of C brings of what is told of."""
        lines, asked = [f"#include <{header}>"], {}
        for name in (name for names in _C_NAMES.values() for name in names):
            lines.append(f"#ifndef {name}")
            asked[len(lines) + 1] = name
            lines += [f"namespace p{len(lines)} {{ using ::{name}; }}", "#endif"]
        with tempfile.TemporaryDirectory() as folder:
            source = Path(folder, "probe.cpp")
            source.write_text("\n".join(lines) + "\n")
            run = subprocess.run(
                [*self._probe.command, "-std=gnu++17", str(source)], capture_output=True, text=True, timeout=300,
                errors="replace", check=False,
            )  # fmt: skip
        if "fatal error" in run.stderr:
            return ()
        missing = {asked.get(int(line)) for line in re.findall(r"probe\.cpp:(\d+):", run.stderr)}
        return tuple(brought for brought, names in _C_NAMES.items() if not missing.intersection(names))


def _list_c_headers(folder: Path) -> Iterator[str]:
    """Headers of C, POSIX and Linux, as they are included."""
    for place in (folder / "usr/include", folder / "usr/include/x86_64-linux-gnu"):
        for path in place.glob("**/*.h"):
            header = path.relative_to(place).as_posix()
            if not _C_APART.match(header):
                yield header


def split_files(text: str, places: Sequence[Path]) -> dict[str, str]:
    """What a preprocessor leaves of each file, by its path below one of these places."""
    starts = sorted((f"{place}/" for place in places), key=len, reverse=True)
    found: dict[str, list[str]] = defaultdict(list)
    marks = list(_MARK.finditer(text))
    ends = [*(mark.start() for mark in marks[1:]), len(text)]
    for mark, end in zip(marks, ends, strict=True):
        start = next((start for start in starts if mark[1].startswith(start)), None)
        if start is not None:
            found[mark[1].removeprefix(start)].append(text[mark.end() : end])
    return {name: "".join(parts) for name, parts in found.items()}


def _has_names(header: str, declaring: Declaring) -> bool:
    """Whether a header has anything for users: itself, in files that are parts of it, or where it declares nothing, in
    any that it includes."""
    if header not in declaring:
        return any(declaring.values())
    parts = (each for file, each in declaring.items() if file.startswith("bits/"))
    return bool(declaring[header]) or any(each.functions or each.others for each in parts)


def find_since(read: Mapping[int, ReadCompiler]) -> dict[int, list[str]]:
    """Standard headers by the C++ standard from which on one of the compilers has anything in them, those of C++98 left
    out."""
    since: dict[str, int] = {}
    for compiler in read.values():
        for header, by_standard in compiler.headers.items():
            first = _find_first(header, by_standard, "c++0x_warning.h" in compiler.texts.get(header, ""))
            if first is not None:
                since[header] = min(first, since.get(header, first))
    found: dict[int, list[str]] = {}
    for header, place in sorted(since.items()):
        if place:
            found.setdefault(STANDARDS[place], []).append(header)
    return dict(sorted(found.items()))


def _find_first(header: str, by_standard: Mapping[int, Declaring], refuses: bool) -> int | None:
    """The place of the standard under which a header has something first; None for one of macros. refuses: it stops the
    compiler itself under C++98. What it includes of others tells of C++98 alone: later headers include some always."""
    if refuses:
        return STANDARDS.index(11)
    if 98 in by_standard and _has_names(header, by_standard[98]):
        return 0
    told = [(place, by_standard[one]) for place, one in enumerate(STANDARDS) if one in by_standard]
    if any(header in declaring for _, declaring in told):
        return next((place for place, declaring in told if declaring.get(header)), None)
    return next((place for place, declaring in told if any(declaring.values())), None)


def find_defining(names: Iterable[str], read: Mapping[int, ReadCompiler]) -> dict[str, tuple[str, ...]]:
    """Names with the headers that define them: their own, C's where libstdc++ has it, and the files that it includes
    itself: others have forms for types of their own. The oldest compiler tells, since the names that each header brings
    in later ones are known (std_names.py)."""
    homes = {name: header for header, text in reversed(NAMES.items()) for name in list_names(text)}
    found = {}
    for name in names:
        home = homes.get(name)
        if home is None:
            continue
        found[name] = (home, *next(filter(None, (_find_inner(name, home, read[gcc]) for gcc in sorted(read))), ()))
    return found


def _find_inner(name: str, home: str, compiler: ReadCompiler) -> tuple[str, ...]:
    """What defines a name beside the header that is its own."""
    inner = {f"{home[1:]}.h"} & compiler.texts.keys() if home.startswith("c") else set()
    included = set(_INCLUDED.findall(compiler.texts.get(home, "")))
    for declaring in compiler.headers.get(home, {}).values():
        for file, each in declaring.items():
            if file in included and _OWN_FILE.match(file) and (name in each.functions or name in each.others):
                inner.add(file)
    return tuple(sorted(inner))


def find_beside(read: Mapping[int, ReadCompiler]) -> dict[str, list[str]]:
    """Names that the compilers are asked about, with functions beside them of which they are not: declared in the same
    files of every compiler under the standards that they are asked under."""
    asked = {name: header for header, text in NAMES.items() for name in list_names(text) if header in _BESIDE}
    places: dict[str, set[tuple[int, int, str]]] = defaultdict(set)
    for gcc, compiler in read.items():
        for header in _BESIDE:
            for standard in _ASKED_UNDER:
                for file, each in compiler.headers.get(header, {}).get(standard, {}).items():
                    for name in each.functions if _OWN_FILE.match(file) else ():
                        places[name].add((gcc, standard, file))
    found: dict[str, list[str]] = {}
    for name, where in sorted(places.items()):
        alike = next((one for one in asked if places.get(one) == where), None)
        if name not in asked and "::" not in name and alike is not None:
            found.setdefault(alike, []).append(name)
    return dict(sorted(found.items()))


def find_brought_by_c(read: Iterable[ReadCompiler]) -> dict[str, list[str]]:
    """What headers of C bring: of a header above, those that bring it in any release, itself left out."""
    brought: dict[str, set[str]] = defaultdict(set)
    for compiler in read:
        for header, found in compiler.of_c.items():
            whole = "stdint.h" in found
            for one in found:
                if header != one and not (whole and one.startswith("bits/")):
                    brought[one].add(header)
    whole = brought.get("stdint.h", set()) | {"stdint.h"}
    return {one: sorted(brought[one] - (whole if one.startswith("bits/") else set())) for one in _C_NAMES}


def build_table(read: Mapping[int, ReadCompiler], before: Mapping[str, list[dict]]) -> dict:
    """The shipped table. before: the one that is there, whose names are told of anew."""
    told = [name for row in before["defined"] for name in row["names"].split()]
    defining = find_defining(told, read)
    rows: dict[tuple[str, ...], list[str]] = {}
    for name in told:
        rows.setdefault(defining.get(name) or _find_headers(before, name), []).append(name)
    versions = f"GCC {', '.join(map(str, sorted(read)))}"
    return {
        "since_source": f"what each header declares under each C++ standard in {versions}",
        "since": {str(standard): " ".join(headers) for standard, headers in find_since(read).items()},
        "brought_by_c_source": f"each header compiled alone with a use of one name, by {versions}",
        "brought_by_c": {one: " ".join(headers) for one, headers in find_brought_by_c(read.values()).items()},
        "beside": {name: " ".join(each) for name, each in find_beside(read).items()},
        "defined": [{"headers": list(headers), "names": " ".join(names)} for headers, names in sorted(rows.items())],
    }


def _find_headers(before: Mapping[str, list[dict]], name: str) -> tuple[str, ...]:
    """What the table before has of a name that no compiler at hand declares any longer."""
    return next(tuple(row["headers"]) for row in before["defined"] if name in row["names"].split())


def read_compilers(folders: Mapping[int, Path], work: Path) -> dict[int, ReadCompiler]:
    """All compilers, by their version."""
    return {major: HeaderReader(Probe(folder, major), work / str(major)).read()
            for major, folder in sorted(folders.items())}  # fmt: skip


def main(arguments: Collection[str] | None = None) -> None:
    """The command line described at the top."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", metavar="GCC=FOLDER")
    parser.add_argument("--work", type=Path, help="folder that keeps what was read; by default a temporary one")
    parser.add_argument("--output", type=Path, default=DATA)
    given = parser.parse_args(list(arguments) if arguments is not None else None)
    folders = {int(major): Path(folder) for major, _, folder in (text.partition("=") for text in given.folders)}
    with tempfile.TemporaryDirectory() as folder:
        read = read_compilers(folders, given.work or Path(folder))
    table = build_table(read, read_table(given.output / FILE, dict))
    write_file(given.output / FILE, (json.dumps(table, indent=1) + "\n").encode())
    print(len(read), "compilers,", sum(len(row["names"].split()) for row in table["defined"]), "names")


if __name__ == "__main__":
    main()
