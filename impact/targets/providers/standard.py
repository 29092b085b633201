"""What libstdc++'s headers bring along: which standard header reaches the definition of a name in which GCC.

`data/std_names.json.zst`, which build/std_names.py makes by asking the compilers, tells for GCC 9 and later which names
each header brings under C++14, 17 and 20, which is much more from standard to standard.

`data/providers_std.json.zst` was made by preprocessing each standard header of GCC 5, 7 and 9 to 15 under the language
standards in use, and listing the standard headers that it read. Where standards differ, all that any of them reads
counts. It tells of GCC 5 and 7, of which names brought more than later versions did.
"""

from functools import cache

import msgspec

from ....edges.groups import group_pairs
from ..tables import find_table
from ..unpacked import read_table


class _Headers(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What data/std_headers.json holds. since: standard headers by the C++ standard that they are of. defined: names of
    `std` with the headers that define them, the public one first; a `bits/` one is libstdc++'s own that does.
    beside: a name of `std` that the compilers were asked about, with others that libstdc++ declares in the same file.
    brought_by_c: what headers of C and POSIX define: of a header above (`bits/` for glibc's own, which has the types
    only, with or without a sign), those that bring it."""

    class Defined(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
        """Names with the headers that define them."""

        headers: tuple[str, ...]
        names: str

    since_source: str
    since: dict[int, str]
    brought_by_c_source: str
    brought_by_c: dict[str, str]
    beside: dict[str, str]
    defined: list[Defined]


_KNOWN = read_table(find_table("std_headers.json"), _Headers)

DEFINED_IN: dict[str, tuple[str, ...]] = {
    **{f"std::{name}": row.headers for row in _KNOWN.defined for name in row.names.split()},
    **{
        name: ("cstdint", "stdint.h", f"bits/stdint-{'uintn' if name[0] == 'u' else 'intn'}")
        for row in _KNOWN.defined
        if row.headers == ("cstdint",)
        for name in row.names.split()
    },
    **dict.fromkeys(("FLT_MAX", "FLT_MIN", "FLT_EPSILON", "DBL_MAX", "DBL_MIN", "DBL_EPSILON"), ("cfloat", "float.h")),
    **dict.fromkeys(("INT_MAX", "INT_MIN", "UINT_MAX", "LONG_MAX"), ("climits", "limits.h")),
    **dict.fromkeys(("M_PI", "M_PI_2"), ("cmath", "math.h")),
    "usleep": ("unistd.h",),
    **{
        f"{sign}INT{bits}_{end}": ("cstdint", "stdint.h")
        for sign, end in (("U", "MAX"), ("", "MAX"), ("", "MIN"))
        for bits in (8, 16, 32, 64)
    },
}
"""Every name to the headers that define it, likewise."""

_BESIDE = {f"std::{name}": f"std::{asked}" for asked, names in _KNOWN.beside.items() for name in names.split()}

HEADER_SINCE = {header: standard for standard, headers in _KNOWN.since.items() for header in headers.split()}
"""Standard headers to the C++ standard that they are of: libstdc++'s stop the compiler below C++11, and are empty below
a later one."""


@cache
def _load_c_headers() -> dict[str, frozenset[str]]:
    """What headers of C and POSIX bring, by header."""
    known = ((brought, headers.split()) for brought, headers in _KNOWN.brought_by_c.items())
    found = group_pairs((header, brought) for brought, headers in known for header in headers)
    return {header: frozenset(brought) for header, brought in found.items()}


@cache
def _load_tables() -> tuple[tuple[int, dict[str, frozenset[str]]], ...]:
    read = read_table(find_table("providers_std.json.zst"), dict[str, dict[str, str]])
    return tuple(
        (int(major), {header: frozenset(text.split()) for header, text in table.items()})
        for major, table in sorted(read.items(), key=lambda item: int(item[0]))
    )


def list_brought(header: str, gcc: int) -> frozenset[str]:
    """Standard headers (and `bits/` ones of DEFINED_IN) that a standard header reads in a GCC, itself included.

    gcc: major version; one that is not known is answered as the nearest older one, or the oldest. Raises SnapshotError
    when the data cannot be read.
    """
    return _build_table(gcc).get(header, frozenset()) | {header}


@cache
def _build_table(gcc: int) -> dict[str, frozenset[str]]:
    older = [table for major, table in _load_tables() if major <= gcc]
    of_c, read = _load_c_headers(), older[-1] if older else _load_tables()[0][1]
    return {
        **of_c,
        **{header: found.union(*(of_c.get(h, ()) for h in (header, *found))) for header, found in read.items()},
    }


class StandardNames(msgspec.Struct, frozen=True):
    """The shipped table. names: each with the header that is its own, whose places stand for them. gcc: major version
    to C++ standard to header to the names that it brings, as a hexadecimal number with a bit for each."""

    names: dict[str, str]
    gcc: dict[str, dict[str, dict[str, str]]]


@cache
def load_names() -> StandardNames:
    """The names that are known. Raises SnapshotError when the data cannot be read."""
    return read_table(find_table("std_names.json.zst"), StandardNames)


@cache
def find_oldest_gcc() -> int:
    """The first GCC whose headers are known name by name."""
    return min(map(int, load_names().gcc))


# Headers of C that are known: `cmath` is `math.h` as well.
_C = frozenset(
    ("cstdint", "cfloat", "climits", "cmath", "cstdlib", "cstring", "cstdio", "cassert", "cerrno", "cinttypes",
     "csignal", "cstdarg")
)  # fmt: skip


@cache
def index_headers() -> dict[str, tuple[str, ...]]:
    """Names of the standard libraries to the headers that offer them, the one to include first."""
    reported = {
        name: (header, f"{header[1:]}.h") if header in _C and not name.startswith("std::") else (header,)
        for name, header in load_names().names.items()
    }
    beside = {name: reported[asked] for name, asked in _BESIDE.items()}
    return {**DEFINED_IN, **reported, **beside}


@cache
def list_own_names(header: str) -> tuple[str, ...]:
    """The names that a standard header is for, of those that are empty below the C++ standard that they are of; empty
    where that is not known."""
    if HEADER_SINCE.get(header, 0) < 17:
        return ()
    names = tuple(name for name, own in load_names().names.items() if own == header)
    return (f"std::{header}", *names) if names else ()


def is_empty(header: str, gcc: int) -> bool:
    """Whether a standard header is there in a GCC, and empty below the C++ standard that it is of."""
    return HEADER_SINCE.get(header, 0) >= 17 and header in _build_table(gcc)


@cache
def _index_bits() -> dict[str, int]:
    return {name: 1 << place for place, name in enumerate(load_names().names)}


def get_bit(name: str) -> int:
    """The bit that stands for a name in find_named(), and for others beside it; 0 for one that is not known."""
    return _index_bits().get(_BESIDE.get(name, name), 0)


def find_named(header: str, gcc: int, standard: int) -> int | None:
    """The names that a header brings alone, as bits; None for a header that is not known.

    gcc: major version; one that is not known is answered as the nearest older one, or the oldest. standard: year of the
    C++ standard, likewise.
    """
    return _select_names(gcc, standard).get(header)


@cache
def list_naming_headers(name: str, gcc: int, standard: int) -> tuple[str, ...]:
    """The standard headers that bring a name alone, see find_named()."""
    bit = get_bit(name)
    return tuple(header for header, bits in _select_names(gcc, standard).items() if bit & bits)


@cache
def _select_names(gcc: int, standard: int) -> dict[str, int]:
    majors = {int(major): table for major, table in load_names().gcc.items()}
    standards = majors[max((major for major in majors if major <= gcc), default=min(majors))]
    years = {2000 + int(number): table for number, table in standards.items()}
    reported = years[max((year for year in years if year <= standard), default=min(years))]
    return {header: int(bits, 16) for header, bits in reported.items()}
