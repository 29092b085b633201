"""Which packages an archive has, of those that rosdep keys install: `data/archive.json.zst` (databuild/archive.py).

Of Ubuntu the lists of files alone were read. An LTS release takes what Debian has at the time: a package is missing
there when its files are, which another release of Ubuntu has, and when the Debian releases before and after lack it.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache, cached_property

import msgspec

from ..platform import find_neighbours
from ..tables import find_table
from ..unpacked import read_table

FILE = "archive.json.zst"


class ArchiveTable(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """suites: platforms (`debian bookworm`) whose indices were read, oldest first. packages: names, space separated, by
    the bits of the suites that have them. listed: platforms whose lists of files were read; lacking: as packages, by
    those of which nothing is in these lists."""

    suites: tuple[str, ...]
    packages: dict[int, str]
    listed: tuple[str, ...] = ()
    lacking: dict[int, str] = {}


class Archives:
    """The archives that were read, ready to be asked."""

    def __init__(self, table: ArchiveTable):
        self._table = table

    @cached_property
    def _bits(self) -> dict[str, int]:
        return _index(self._table.packages)

    @cached_property
    def _lacking(self) -> dict[str, int]:
        return _index(self._table.lacking)

    def lacks(self, platform: str, package: str) -> bool:
        """Whether a platform's archive surely lacks a package that another one has."""
        table, bits = self._table, self._bits.get(package)
        if bits is None:
            return False
        if platform in table.suites:
            return not bits >> table.suites.index(platform) & 1
        near = find_neighbours(platform, table.suites)
        if platform not in table.listed or not all(near):
            return False
        listed = self._lacking.get(package, 0) >> table.listed.index(platform) & 1
        return bool(listed) and not any(bits >> table.suites.index(one) & 1 for one in near)

    def knows(self, platform: str) -> bool:
        """Whether the index of a platform's archive was read."""
        return platform in self._table.suites


def _index(groups: Mapping[int, str]) -> dict[str, int]:
    return {name: bits for bits, names in groups.items() for name in names.split()}


@cache
def load_archives() -> Archives:
    """The shipped archives. Raises SnapshotError when they cannot be read."""
    return Archives(read_table(find_table(FILE), ArchiveTable))
