"""What the headers of each stored version of a package include, packed by itself, so that following includes through
many packages reads little."""

import posixpath
from collections.abc import Callable, Iterator, Sequence
from functools import cached_property

import msgspec

from ...facts.cpp.lexical import Include
from ..version import find_newest_up_to


class IncludesRow(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """What a header includes, and which types it announces without defining them, in some versions. spans: first and
    last places of those, over and over; empty for all. includes, announced: places in Included.every and types."""

    spans: tuple[int, ...]
    includes: tuple[int, ...]
    announced: tuple[int, ...] = ()


class Included(msgspec.Struct, frozen=True, array_like=True, dict=True):
    """versions: of one ROS generation, oldest first. approximate: those that a branch stood for. headers: by the path
    that dependants write; those that are generated are not among them."""

    versions: tuple[str, ...]
    approximate: tuple[str, ...]
    every: tuple[Include, ...]
    types: tuple[str, ...]
    headers: dict[str, tuple[IncludesRow, ...]]

    def stands_for(self, version: str) -> str | None:
        """The stored version that stands for one: itself, or the newest before it that was read at its tag; None for
        one older than all."""
        return find_newest_up_to(version, [*self.read()])

    def read(self) -> Iterator[str]:
        """The versions that were read at their tags, oldest first."""
        return (version for version in self.versions if version not in self.approximate)

    def list_includes(self, header: str, version: str) -> tuple[Include, ...] | None:
        """What a header includes in a stored version, as written; None where the version has no such header."""
        row = self._find_row(header, version)
        return None if row is None else tuple(self.every[number] for number in row.includes)

    def list_announced_types(self, header: str, version: str) -> tuple[str, ...]:
        """Types that a header announces in a stored version without defining them."""
        row = self._find_row(header, version)
        return () if row is None else tuple(self.types[number] for number in row.announced)

    def _find_row(self, header: str, version: str) -> IncludesRow | None:
        place = self._places.get(version)
        if place is None:
            return None
        for row in self.headers.get(header, ()):
            if covers(row.spans, place):
                return row
        return None

    @cached_property
    def _places(self) -> dict[str, int]:
        return {version: place for place, version in enumerate(self.versions)}

    def resolve_include(self, include: Include, header: str, version: str) -> str:
        """The path that dependants would write for what a header includes, see path_of()."""
        return choose_path(include, header, lambda path: self._find_row(path, version) is not None)


def choose_path(include: Include, header: str, has: Callable[[str], object]) -> str:
    """The path that dependants would write for what a header includes: that of a header of the same package, where one
    lies there, else as it is written. has: gives something, or True, of a header that the package has."""
    if include.angled and has(include.path):
        return include.path
    folder, slash, _ = header.rpartition("/")
    beside = f"{folder}{slash}{include.path}"
    if "./" in beside or "//" in beside:
        beside = posixpath.normpath(posixpath.join(folder, include.path))
    return beside if has(beside) else include.path


def covers(spans: Sequence[int], place: int) -> bool:
    """Whether a place lies in some spans; none at all are all places."""
    return not spans or any([spans[at] <= place <= spans[at + 1] for at in range(0, len(spans), 2)])
