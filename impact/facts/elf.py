"""What a built program or shared library asks of the machine that runs it: a pure function of its bytes.

Read with pyelftools, as the System V ABI, gABI chapters 4 and 5, and the LSB's "Symbol Versioning" describe the format.
Symbols are read in one go with numpy, since a library has thousands of them.

Nothing that a file claims about itself is believed: what is read of it has limits, so that a table that
leads back to itself, has 2^31 entries or names without an end costs a second and makes a problem.
"""

import io
import re
from collections.abc import Iterable, Iterator
from typing import IO, Any, NamedTuple

import msgspec

MAGIC = b"\x7fELF"
EXTRACTOR = "elf 2"
# The largest libraries of ROS distros have 100 needed libraries, 20,000 symbols that they lack and 300,000 that they
# have, and take a few thousand reads.
_READS = 200_000
_READ_BYTES = 64 << 20
_SYMBOLS = 2_000_000
_UNDEFINED = 500_000
_NAME_BYTES = 128 << 20
_NEEDED = 1_000
_SEARCHED = 100
_WEAK = 2


class AskedSymbolVersions(msgspec.Struct, frozen=True, array_like=True, gc=False):
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
    itself. undefined: symbols that it does not have. defined: how many others can use.
    dynamic: it is linked at run time. problem: why what stands here is incomplete, empty when it is not.
    """

    machine: str = ""
    bits: int = 0
    program: bool = False
    soname: str = ""
    needed: tuple[str, ...] = ()
    search: tuple[str, ...] = ()
    asked: tuple[AskedSymbolVersions, ...] = ()
    offers: tuple[str, ...] = ()
    undefined: tuple[Undefined, ...] = ()
    defined: int = 0
    dynamic: bool = False
    problem: str = ""


def read(data: bytes | IO[bytes]) -> Elf | None:
    """What a file asks for, None when it is no ELF file. data: its bytes, or the open file. Of a damaged file that is
    told which can be. Raises OSError, where reading the open file does, and nothing else."""
    stream = io.BytesIO(data) if isinstance(data, bytes) else data
    if stream.read(4) != MAGIC:
        return None
    found: dict[str, Any] = {}
    try:
        _read(stream, found)
    except (OSError, MemoryError):
        raise
    except Exception as error:  # pyelftools raises whatever its parsers meet in damaged bytes
        found["problem"] = f"no ELF file that can be read to its end ({_format_error(error)})"
    return Elf(**found)


class _TooMuch(Exception):
    """A file claims to have more of something than any file has."""


class _Bounded:
    """An open file for pyelftools, which reads for every entry of a table: reading too often ends in _TooMuch."""

    def __init__(self, stream: IO[bytes]):
        self._stream, self._reads, self._bytes = stream, 0, 0
        self.tell = stream.tell
        self.seek = stream.seek

    def read(self, size: int = -1) -> bytes:
        self._reads += 1
        self._bytes += size if size >= 0 else _READ_BYTES
        if self._reads > _READS or self._bytes > _READ_BYTES:
            raise _TooMuch("a table that does not end")
        return self._stream.read(size)


def _limit_stream(stream: IO[bytes]) -> Any:
    return _Bounded(stream)


def _read_piece(stream: IO[bytes], start: int, size: int) -> bytes:
    """A part of a file. Raises ValueError where the file ends before it does."""
    whole = stream.seek(0, io.SEEK_END)
    if start < 0 or size < 0 or start + size > whole:
        raise ValueError("a table lies behind the end of the file")
    stream.seek(start)
    return stream.read(size)


def _read(stream: IO[bytes], found: dict[str, Any]) -> None:
    from elftools.elf.dynamic import DynamicSegment
    from elftools.elf.elffile import ELFFile
    from elftools.elf.gnuversions import GNUVerDefSection, GNUVerNeedSection, GNUVerSymSection
    from elftools.elf.sections import SymbolTableSection

    file = ELFFile(_limit_stream(stream))
    found["machine"], found["bits"] = str(file["e_machine"]), file.elfclass
    found["program"] = file["e_type"] == "ET_EXEC"
    if file["e_type"] not in ("ET_EXEC", "ET_DYN"):
        return
    for segment in file.iter_segments():
        if segment["p_type"] == "PT_INTERP":
            found["program"] = True
        elif isinstance(segment, DynamicSegment):
            found["dynamic"] = True
            _read_dynamic(segment, found)
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
                asked.append(AskedSymbolVersions(library.name or "", tuple(sorted(of_library))))
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
    if table is not None:
        _read_symbols(stream, file, table, versions, names, found)


def _read_dynamic(segment: Any, found: dict[str, Any]) -> None:
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
    if len(found["needed"]) > _NEEDED or len(found["search"]) > _SEARCHED:
        found.update(needed=found["needed"][:_NEEDED], search=found["search"][:_SEARCHED])
        raise _TooMuch("more libraries or folders than any file asks for")


def _read_symbols(
    stream: IO[bytes], file: Any, table: Any, versions: Any, names: dict[int, str], found: dict[str, Any]
) -> None:
    import numpy

    symbols, text = _read_table(stream, file, table)
    count = len(symbols)
    given = numpy.zeros(count, "u2")
    if versions is not None and versions["sh_size"] // 2 >= count:
        order = "<" if file.little_endian else ">"
        given = numpy.frombuffer(_read_piece(stream, versions["sh_offset"], 2 * count), order + "u2")
    found["defined"] = int(_select_exported(symbols).sum())
    undefined = []
    places = numpy.flatnonzero((symbols["name"] != 0) & (symbols["section"] == 0))
    if len(places) > _UNDEFINED:
        raise _TooMuch("more symbols than any file asks for")
    for index, raw in zip(places.tolist(), _iterate_names(text, symbols["name"][places].tolist()), strict=True):
        name = raw.decode("utf-8", "replace")
        weak = int(symbols["info"][index]) >> 4 == _WEAK
        undefined.append(Undefined(name, names.get(int(given[index]) & 0x7FFF, ""), weak))
    found["undefined"] = tuple(undefined)


def _read_table(stream: IO[bytes], file: Any, table: Any) -> tuple[Any, bytes]:
    """The symbols of a table as a numpy array, and the text that has their names."""
    import numpy

    order = "<" if file.little_endian else ">"
    if file.elfclass == 64:
        fields = [("name", "u4"), ("info", "u1"), ("other", "u1"), ("section", "u2"), ("value", "u8"), ("size", "u8")]
    else:
        fields = [("name", "u4"), ("value", "u4"), ("size", "u4"), ("info", "u1"), ("other", "u1"), ("section", "u2")]
    kind = numpy.dtype([(name, order + size) for name, size in fields])
    count = table["sh_size"] // kind.itemsize
    strings = file.get_section(table["sh_link"])
    if count > _SYMBOLS or strings["sh_size"] > _NAME_BYTES:
        raise _TooMuch("more symbols than any file has")
    text = _read_piece(stream, strings["sh_offset"], strings["sh_size"])
    return numpy.frombuffer(_read_piece(stream, table["sh_offset"], count * kind.itemsize), kind), text


def _select_exported(symbols: Any) -> Any:
    """Which of them are defined here and not local."""
    return (symbols["name"] != 0) & (symbols["section"] != 0) & ((symbols["info"] >> 4) != 0)


def _iterate_names(text: bytes, starts: Iterable[int]) -> Iterator[bytes]:
    """The names that begin at some places of a text. Raises _TooMuch when they overlap so that they are endless."""
    left = _NAME_BYTES
    for start in starts:
        name = text[start : text.index(b"\0", start)]
        left -= len(name)
        if left < 0:
            raise _TooMuch("names of symbols that do not end")
        yield name


def read_defined_symbols(data: bytes | IO[bytes]) -> frozenset[str] | None:
    """The C++ symbols that a file has for others; None for one that is no ELF file, or cannot be read to its end."""
    from elftools.elf.elffile import ELFFile

    stream = io.BytesIO(data) if isinstance(data, bytes) else data
    try:
        file = ELFFile(_limit_stream(stream))
        section = next(file.iter_sections("SHT_DYNSYM"), None)  # a file has at most one
        if section is None:
            return frozenset()
        symbols, text = _read_table(stream, file, section)
        names = _iterate_names(text, symbols["name"][_select_exported(symbols)].tolist())
        return frozenset(name.decode("utf-8", "replace") for name in names if name.startswith(b"_Z"))
    except Exception:  # as in read()
        return None


_IDENTIFIER = re.compile(r"[0-9]{1,9}")


class SymbolName(NamedTuple):
    """A C++ symbol. name: `rclcpp::Node::now`, without its parameters; scope: how all symbols of its class or namespace
    go on behind `_ZN`, or `_ZNK`; empty for one of none."""

    name: str
    scope: str


def parse_symbol(symbol: str) -> SymbolName | None:
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
    return SymbolName("::".join(names), rest[:before] if nested else "") if names else None


def _format_error(error: Exception) -> str:
    return " ".join(str(error).split())[:80] or type(error).__name__


_SONAME = re.compile(r"(.+?\.so)\.(.+)\Z")


def split_soname(soname: str) -> tuple[str, str]:
    """`libpcl_common.so.1.12` gives (`libpcl_common.so`, `1.12`); without a version the second is empty."""
    match = _SONAME.match(soname)
    return (match[1], match[2]) if match else (soname, "")
