"""What a built program or shared library asks of the machine that runs it: a pure function of its bytes.

Read with pyelftools, as the System V ABI, gABI chapters 4 and 5, and the LSB's "Symbol Versioning" describe the format.
Symbols are read in one go with numpy, since a library has thousands of them.
"""

from __future__ import annotations

import io
import re
from typing import Any, NamedTuple

import msgspec

MAGIC = b"\x7fELF"
EXTRACTOR = "elf 1"
# Of a damaged file, a table that claims to be longer than this is not read.
_SYMBOLS_AT_MOST = 5_000_000
_WEAK = 2


class Asked(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """Symbol versions that are asked of one library: `libc.so.6` and (`GLIBC_2.34`, `GLIBC_2.38`)."""

    library: str
    versions: tuple[str, ...]


class Undefined(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A symbol that another file must have. version: empty without one. weak: it may be missing."""

    name: str
    version: str
    weak: bool


class Elf(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """One file. machine: `EM_X86_64`, as elf.h names it; bits: 32 or 64. program: it is started and not only loaded.

    soname: its own, empty without one. needed: sonames that the loader looks for. search: its DT_RUNPATH, else its
    DT_RPATH, folder by folder. asked: versions of symbols by the library they are of. offers: versions that it defines
    itself. undefined: symbols that it does not have. defined: how many others can use. build_id: hexadecimal.
    dynamic: it is linked at run time. problem: why what stands here is incomplete, empty when it is not.
    """

    machine: str = ""
    bits: int = 0
    program: bool = False
    soname: str = ""
    needed: tuple[str, ...] = ()
    search: tuple[str, ...] = ()
    asked: tuple[Asked, ...] = ()
    offers: tuple[str, ...] = ()
    undefined: tuple[Undefined, ...] = ()
    defined: int = 0
    build_id: str = ""
    dynamic: bool = False
    problem: str = ""


def read(data: bytes) -> Elf | None:
    """What a file asks for, None when it is no ELF file. Never raises: of a damaged file that is told which can be."""
    if data[:4] != MAGIC:
        return None
    found: dict[str, Any] = {}
    try:
        _read(data, found)
    except Exception as error:  # pyelftools raises whatever its parsers meet in damaged bytes
        found["problem"] = f"no ELF file that can be read to its end ({_clause(error)})"
    return Elf(**found)


def _read(data: bytes, found: dict[str, Any]) -> None:
    from elftools.elf.dynamic import DynamicSegment
    from elftools.elf.elffile import ELFFile
    from elftools.elf.gnuversions import GNUVerDefSection, GNUVerNeedSection, GNUVerSymSection
    from elftools.elf.sections import NoteSection, SymbolTableSection

    file = ELFFile(io.BytesIO(data))
    found["machine"], found["bits"] = str(file["e_machine"]), file.elfclass
    found["program"] = file["e_type"] == "ET_EXEC"
    for segment in file.iter_segments():
        if segment["p_type"] == "PT_INTERP":
            found["program"] = True
        elif isinstance(segment, DynamicSegment):
            found["dynamic"] = True
            _dynamic(segment, found)
    names: dict[int, str] = {}
    table, versions = None, None
    for section in file.iter_sections():
        if isinstance(section, GNUVerNeedSection):
            asked = []
            for library, each in section.iter_versions():
                of_library = []
                for version in each:
                    names[version["vna_other"] & 0x7FFF] = version.name
                    of_library.append(version.name)
                asked.append(Asked(library.name or "", tuple(sorted(of_library))))
            found["asked"] = tuple(asked)
        elif isinstance(section, GNUVerDefSection):
            # The first names the library itself.
            found["offers"] = tuple(
                next(iter(each)).name for version, each in section.iter_versions() if not version["vd_flags"] & 1
            )
        elif isinstance(section, GNUVerSymSection):
            versions = section
        elif isinstance(section, SymbolTableSection) and section["sh_type"] == "SHT_DYNSYM":
            table = section
        elif isinstance(section, NoteSection) and section.name == ".note.gnu.build-id":
            found["build_id"] = next((str(note["n_desc"]) for note in section.iter_notes()), "")
    if table is not None:
        _symbols(data, file, table, versions, names, found)


def _dynamic(segment: Any, found: dict[str, Any]) -> None:
    needed, run, old = [], [], []
    for tag in segment.iter_tags():
        kind = tag.entry.d_tag
        if kind == "DT_NEEDED":
            needed.append(tag.needed)
        elif kind == "DT_SONAME":
            found["soname"] = tag.soname
        elif kind == "DT_RUNPATH":
            run = tag.runpath.split(":")
        elif kind == "DT_RPATH":
            old = tag.rpath.split(":")
    found["needed"] = tuple(dict.fromkeys(needed))
    found["search"] = tuple(folder for folder in run or old if folder)


def _symbols(data: bytes, file: Any, table: Any, versions: Any, names: dict[int, str], found: dict[str, Any]) -> None:
    import numpy

    symbols, text = _table(data, file, table)
    count = len(symbols)
    given = numpy.zeros(count, "u2")
    if versions is not None and versions["sh_size"] // 2 >= count:
        order = "<" if file.little_endian else ">"
        given = numpy.frombuffer(data, order + "u2", count, versions["sh_offset"])
    found["defined"] = int(_for_others(symbols).sum())
    undefined = []
    for index in numpy.flatnonzero((symbols["name"] != 0) & (symbols["section"] == 0)).tolist():
        name = _name_at(text, int(symbols["name"][index])).decode("utf-8", "replace")
        weak = int(symbols["info"][index]) >> 4 == _WEAK
        undefined.append(Undefined(name, names.get(int(given[index]) & 0x7FFF, ""), weak))
    found["undefined"] = tuple(undefined)


def _table(data: bytes, file: Any, table: Any) -> tuple[Any, bytes]:
    """The symbols of a table as a numpy array, and the text that has their names."""
    import numpy

    order = "<" if file.little_endian else ">"
    if file.elfclass == 64:
        fields = [("name", "u4"), ("info", "u1"), ("other", "u1"), ("section", "u2"), ("value", "u8"), ("size", "u8")]
    else:
        fields = [("name", "u4"), ("value", "u4"), ("size", "u4"), ("info", "u1"), ("other", "u1"), ("section", "u2")]
    kind = numpy.dtype([(name, order + size) for name, size in fields])
    count = min(table["sh_size"] // kind.itemsize, _SYMBOLS_AT_MOST)
    strings = file.get_section(table["sh_link"])
    text = data[strings["sh_offset"] : strings["sh_offset"] + strings["sh_size"]]
    return numpy.frombuffer(data, kind, count, table["sh_offset"]), text


def _for_others(symbols: Any) -> Any:
    """Which of them are defined here and not local."""
    return (symbols["name"] != 0) & (symbols["section"] != 0) & ((symbols["info"] >> 4) != 0)


def _name_at(text: bytes, start: int) -> bytes:
    return text[start : text.index(b"\0", start)]


def defined(data: bytes) -> frozenset[str] | None:
    """The C++ symbols that a file has for others; None for one that is no ELF file, or cannot be read to its end."""
    from elftools.elf.elffile import ELFFile

    try:
        file = ELFFile(io.BytesIO(data))
        found: set[str] = set()
        for section in file.iter_sections("SHT_DYNSYM"):
            symbols, text = _table(data, file, section)
            starts = symbols["name"][_for_others(symbols)].tolist()
            names = (_name_at(text, start) for start in starts)
            found.update(name.decode("utf-8", "replace") for name in names if name.startswith(b"_Z"))
        return frozenset(found)
    except Exception:  # as in read()
        return None


_IDENTIFIER = re.compile(r"\d+")


class Member(NamedTuple):
    """A C++ symbol. name: `rclcpp::Node::now`, without its parameters; scope: how all symbols of its class or namespace
    go on behind `_ZN`, or `_ZNK`; empty for one of none."""

    name: str
    scope: str


def member(symbol: str) -> Member | None:
    """What a mangled name of C++ is a member of; None for names that do not begin with plain identifiers.

    Source: the Itanium C++ ABI, section 5.1 (nested names, special names)."""
    if not symbol.startswith("_Z"):
        return None
    special = symbol.startswith(("_ZTV", "_ZTI", "_ZTS"))
    rest = symbol[4:] if special else symbol[2:]
    nested = rest.startswith("N")
    rest = rest[1:].lstrip("rVKRO") if nested else rest
    names, at, before = [], 0, 0
    while (found := _IDENTIFIER.match(rest, at)) is not None:
        before, at = at, found.end() + int(found[0])
        names.append(rest[found.end() : at])
    if special or rest[at : at + 1] in ("C", "D", "I"):
        before = at
    return Member("::".join(names), rest[:before] if nested else "") if names else None


def _clause(error: Exception) -> str:
    return " ".join(str(error).split())[:80] or type(error).__name__


_SONAME = re.compile(r"(.+?\.so)\.(.+)\Z")


def stem_and_version(soname: str) -> tuple[str, str]:
    """`libpcl_common.so.1.12` gives (`libpcl_common.so`, `1.12`); without a version the second is empty."""
    match = _SONAME.match(soname)
    return (match[1], match[2]) if match else (soname, "")
