"""Which platform has which versioned shared library: data/sonames.json.zst, made by build_sonames.py, and sonames.yaml,
kept by hand.

The first is a file list and complete for its platforms. The second tells of some libraries, from their version alone,
which sonames a platform cannot have; that is how platforms without a file list are judged.
"""

import re
from functools import cache

import msgspec

from ...facts.elf import split_soname
from ..tables import find_table, suggest_repair
from ..unpacked import SnapshotError, read_table
from ..version import parse_number

FILE = "sonames.json.zst"


class SonamesTable(msgspec.Struct, frozen=True):
    """As stored. platforms: their names. symbols: how far the versions of symbols of each reach, by kind. names: a
    line for each library: name, platforms that have it as bits, a package that has it."""

    platforms: tuple[str, ...]
    symbols: tuple[dict[str, str], ...]
    names: str


class Family(msgspec.Struct, frozen=True):
    """A library whose sonames carry the first `numbers` numbers of its version. files: their names up to `.so`."""

    numbers: int
    files: tuple[str, ...]


class Reviewed(msgspec.Struct, frozen=True):
    """What sonames.yaml holds."""

    everywhere: tuple[str, ...]
    elsewhere: tuple[str, ...]
    libraries: dict[str, Family]


class Sonames:
    """The table, ready to be asked."""

    def __init__(self, table: SonamesTable, reviewed: Reviewed):
        self._bit = {platform: 1 << place for place, platform in enumerate(table.platforms)}
        self._symbols = dict(zip(table.platforms, table.symbols, strict=True))
        self.reviewed = reviewed
        self._families = {
            f"{file}.so": library for library, family in reviewed.libraries.items() for file in family.files
        }
        self._bits: dict[str, int] = {}
        self._packages: dict[str, str] = {}
        self._by_stem: dict[str, list[str]] = {}
        for line in table.names.splitlines():
            name, bits, package = line.split(" ")
            self._bits[name] = int(bits)
            self._packages[name] = package
            self._by_stem.setdefault(split_soname(name)[0], []).append(name)

    @property
    def platforms(self) -> frozenset[str]:
        """Platforms whose files are known."""
        return frozenset(self._bit)

    def has(self, platform: str, soname: str) -> bool | None:
        """Whether some package of a platform has a library; None where nobody can tell: the platform's files are not
        known, or no platform has a library of this stem in any version."""
        bit = self._bit.get(platform)
        if bit is None or split_soname(soname)[0] not in self._by_stem:
            return None
        return bool(self._bits.get(soname, 0) & bit)

    def has_stem(self, library: str) -> bool:
        """Whether some platform has a library that is linked by a name (`z` of libz.so.1), in any version."""
        return f"lib{library}.so" in self._by_stem

    def find_package(self, soname: str) -> str:
        """A Debian package that has the library on the newest platform that has it, empty when none does."""
        return self._packages.get(soname, "")

    def list_others(self, platform: str, soname: str) -> list[str]:
        """What a platform has of the same stem, shortest version first."""
        bit = self._bit.get(platform, 0)
        names = [name for name in self._by_stem.get(split_soname(soname)[0], ()) if self._bits[name] & bit]
        return sorted(names, key=lambda name: (len(name), name))

    def list_names(self, platform: str) -> list[str]:
        """Every library that a platform has."""
        bit = self._bit.get(platform, 0)
        return [name for name, bits in self._bits.items() if bits & bit]

    def reach(self, platform: str, kind: str) -> str:
        """The highest version of symbols of a kind (`GLIBC`, `GLIBCXX`) on a platform, empty when it is not known."""
        return self._symbols.get(platform, {}).get(kind, "")

    def find_family(self, soname: str) -> str:
        """The library (platform_versions.yaml) that a soname is of, empty when sonames.yaml names none."""
        return self._families.get(split_soname(soname)[0], "")

    def fits(self, soname: str, version: str) -> bool | None:
        """Whether a soname can be of this version of its family; None when that cannot be known."""
        family = self.reviewed.libraries.get(self.find_family(soname))
        asked = parse_numbers(split_soname(soname)[1])
        there = [parse_number(part) for part in re.findall(r"\d+", version)]
        if family is None or len(asked) < family.numbers or len(there) < family.numbers:
            return None
        return asked[: family.numbers] == there[: family.numbers]


def parse_numbers(version: str) -> list[int]:
    """The numbers that a soname's version says: `1.12` → 1, 12; `4.5d` → 4, 5; OpenCV's `406` → 4, 6."""
    if re.fullmatch(r"\d{3}", version):
        return [int(version[0]), int(version[1:])]
    return [parse_number(part) for part in re.findall(r"\d+", version)]


@cache
def load_sonames() -> Sonames:
    """The shipped table. Raises SnapshotError when it is missing or damaged."""
    import yaml

    table, path = read_table(find_table(FILE), SonamesTable), find_table("sonames.yaml")
    try:
        return Sonames(table, msgspec.convert(yaml.safe_load(path.read_bytes()), type=Reviewed))
    except (OSError, ValueError) as error:
        raise SnapshotError(f"{path}: {error}; {suggest_repair()}") from None
