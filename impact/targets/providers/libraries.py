"""System libraries as Debian packages them, by release: which library a header or CMake target is of, whether it is
compiled, and how it is linked. Looked up in `data/libraries.sqlite` (databuild/debian.py), some headers at a time.

Of Ubuntu no packages were read. An LTS release takes what Debian has at the time, so a library there is neither older
than in the Debian release before it nor newer than in the one after it: what both of these say holds.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Callable, Iterator
from functools import cache, cached_property, lru_cache, partial
from itertools import chain, islice, pairwise
from pathlib import Path
from typing import NamedTuple

import msgspec

from ....edges.memory import cache_method
from ...facts.cpp.lexical import Include
from ...facts.surface import Entity
from ..platform import find_neighbours
from ..surface.includes import choose_path, covers
from ..surface.store import StoredRows, StoredSurfacesError, SurfaceHistory
from ..surface.surface import BuildSurface
from ..tables import find_table, suggest_repair
from ..unpacked import SnapshotError, read_packed
from ..version import parse
from .providers import load_providers

NEAREST = 4
"""How many of those that bring a header, the nearest first, are asked whether it is theirs."""
_NAMED = ("cmake_names", "targets", "unknown")


class HeaderIncludes(NamedTuple):
    """What a header of a version of a library includes."""

    library: str
    version: str
    paths: tuple[str, ...]


class Presence(NamedTuple):
    """How a platform stands to a part of a library. here: None where its releases do not tell. version: the oldest that
    the platform may have. lost: some version lacks it, and the one before that had it."""

    library: str
    here: bool | None
    version: str
    lost: bool


class HeaderState(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A header in some versions. spans: as in IncludesRow. includes: places in HeaderBlock.every. links: stems of the
    libraries in its package, space separated."""

    spans: tuple[int, ...]
    includes: tuple[int, ...]
    links: str


class HeaderBlock(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """Headers of a library that follow one another in the order of their paths, by those; in all its versions. A header
    without states is in one that was not read for itself."""

    every: tuple[Include, ...]
    headers: dict[str, tuple[HeaderState, ...]]


class SystemLibraries:
    """The shipped file, or another of its form. Raises SnapshotError when it cannot be read."""

    def __init__(self, file: Path | None = None) -> None:
        self._file = StoredRows(file or find_table("libraries.sqlite"))
        try:
            self._file.query_column("SELECT name FROM package LIMIT 1")
        except StoredSurfacesError as error:
            raise SnapshotError(f"{str(error).partition(';')[0]}; {suggest_repair()}") from None

    def _query_first(self, query: str, value: str) -> str:
        return next(iter(self._file.query_column(query, value)), "")

    @cache_method
    def find_by_package(self, debian: str) -> str:
        """The library that a Debian development package is of; empty where it was not read."""
        return self._query_first("SELECT library FROM debian WHERE name = ?", debian)

    @cache_method
    def list_versions(self, library: str) -> dict[str, str]:
        """The version of a library in each Debian release that was read, oldest first."""
        reported = self._query_first("SELECT versions FROM package WHERE name = ?", library)
        found = dict(one.split("=") for one in reported.split())
        return {f"debian {suite}": version for suite, version in found.items()}

    @cache_method
    def list_packages(self, library: str) -> frozenset[str]:
        """The development packages of a library."""
        return frozenset(self._file.query_column("SELECT name FROM debian WHERE library = ?", library))

    def find_range(self, library: str, platform: str) -> tuple[str, str]:
        """The versions between which a platform's lies; empty for one that is not known."""
        known = self.list_versions(library)
        before, after = find_neighbours(platform, known)
        return known.get(before, ""), known.get(after, "")

    @lru_cache(maxsize=256)  # noqa: B019  (one of them lives as long as the program)
    def build(self, library: str, version: str, of: tuple[str, ...] = ()) -> BuildSurface | None:
        """What a version gives to CMake and the linker, without its headers. of: these fields alone."""
        history = self._load_history(library)
        return history.build(version, of) if history is not None else None

    @lru_cache(maxsize=256)  # noqa: B019
    def _load_history(self, library: str) -> SurfaceHistory | None:
        data = self._file.query_column("SELECT data FROM package WHERE name = ?", library)
        return SurfaceHistory(library, data[0], b"") if data else None

    def list_declared(self, library: str, platform: str) -> list[Entity]:
        """What the headers of a library declare for its users on a platform that was read."""
        data = self._file.query_column("SELECT names FROM package WHERE name = ?", library)
        version = self.list_versions(library).get(platform, "")
        return list(SurfaceHistory(library, data[0], b"").list_entities(version)) if data else []

    @cache_method
    def find_by_header(self, header: str) -> str:
        """The library that has a header in some version; empty for none that was read."""
        if stray := self._strays.get(header):
            return stray
        providers = (p for p in load_providers().find_header(header) if p.kind == "system" and p.package)
        nearest = dict.fromkeys(
            library for p in islice(providers, NEAREST) if (library := self.find_by_package(p.package))
        )
        return next((library for library in nearest if self.has(library, header)), "")

    @cached_property
    def _strays(self) -> dict[str, str]:
        """Headers that no list of files leads to, with their libraries."""
        return dict(self._file.fetch("SELECT name, library FROM header"))

    def has(self, library: str, header: str) -> bool:
        """Whether some version of a library has a header."""
        return any(self._find_states(library, path) is not None for path in _spell(header, self._list_roots(library)))

    def _find_states(self, library: str, path: str) -> tuple[tuple[Include, ...], tuple[HeaderState, ...]] | None:
        """What is stored of a header, by its path below the folders that flags name: of its block HeaderBlock.every,
        and its states; None for one that no version has."""
        starts = self._starts(library)
        place = bisect_right(starts, path)
        block = self._load_block(library, starts[place - 1]) if place else None
        return (block.every, block.headers[path]) if block is not None and path in block.headers else None

    @cache_method
    def _starts(self, library: str) -> tuple[str, ...]:
        """The first header of each block of a library."""
        return tuple(self._file.query_column("SELECT start FROM block WHERE library = ? ORDER BY start", library))

    @lru_cache(maxsize=64)  # noqa: B019
    def _load_block(self, library: str, start: str) -> HeaderBlock:
        (data,) = self._file.query_column("SELECT data FROM block WHERE library = ? AND start = ?", library, start)
        return read_packed(data, HeaderBlock)

    def _find_state(self, library: str, version: str, path: str) -> tuple[tuple[Include, ...], HeaderState] | None:
        """The same with the one state that it has in a version; None where the version has no such header."""
        found = self._find_states(library, path)
        if found is None:
            return None
        place = self._index_versions(library)[version]
        for state in found[1]:
            if covers(state.spans, place):
                return found[0], state
        return None

    @cache_method
    def _index_versions(self, library: str) -> dict[str, int]:
        """The versions of a library, oldest first, with their places in the spans of its headers."""
        versions = sorted(dict.fromkeys(self.list_versions(library).values()), key=parse)
        return {version: place for place, version in enumerate(versions)}

    def find_included(self, header: str, platform: str) -> HeaderIncludes | None:
        """What a header includes in a platform's version, or in either of those between which that lies; None where
        neither has it, one of them was not read, or it is of no library that was."""
        library = self.find_by_header(header)
        before, after = self.find_range(library, platform) if library else ("", "")
        if not (before and after):
            return None
        found = [self._list_included(library, version, header) for version in (before, after)]
        known = [paths for paths in found if paths is not None]
        return HeaderIncludes(library, before, tuple(dict.fromkeys(chain(*known)))) if known else None

    @cache_method
    def _list_included(self, library: str, version: str, header: str) -> tuple[str, ...] | None:
        """What a header includes in a version of its library; None where that has it not."""
        for path in _spell(header, self._list_roots(library)):
            if (stored := self._find_state(library, version, path)) is not None:
                every, state = stored
                has = partial(self._find_state, library, version)
                return tuple(choose_path(every[number], path, has) for number in state.includes)
        return None

    @cache_method
    def _list_roots(self, library: str) -> tuple[str, ...]:
        """The folders that flags name in any version."""
        return tuple(self._query_first("SELECT roots FROM package WHERE name = ?", library).split())

    @cache_method
    def find_folder(self, header: str) -> str:
        """The folder below the system's include folder that a header lies in, so that compilers find it only where they
        are told to look there; empty where its path leads to it, or it is of no library that was read."""
        library = self.find_by_header(header)
        inner = (root for root in self._list_roots(library) if "linux-gnu" not in root) if library else ()
        return next((root for root in inner if load_providers().find_header(f"{root}/{header}")), "")

    def find_target(self, name: str, platform: str, version_of: Callable[[str], str | None]) -> Presence | None:
        """How a platform stands to a CMake target that a library exports in some version; None where none does.
        version_of: the platform's version of a library, where that is known."""
        library = self._query_first("SELECT library FROM target WHERE name = ?", name)
        if not library:
            return None
        return self._compute_presence(library, platform, version_of, lambda build: _exports(build, name))

    def find_configuration(
        self, library: str, name: str, platform: str, version_of: Callable[[str], str | None]
    ) -> Presence | None:
        """The same of a CMake package of a library; None where no version has it."""
        found = self._compute_presence(library, platform, version_of, lambda build: name in build.cmake_names)
        builds = (self.build(library, version, _NAMED) for version in self.list_versions(library).values())
        return found if any(build is not None and name in build.cmake_names for build in builds) else None

    def list_components(self, library: str, package: str) -> dict[str, frozenset[str]]:
        """The components of a library's CMake package as its targets (`opencv_core`, `VTK::CommonCore`) or pkg-config
        files (`pcl_io`) tell them, with the versions that have each; none of fewer than three."""
        starts = (f"{package}::", f"{package.lower()}_")
        found: dict[str, set[str]] = {}
        for version in dict.fromkeys(self.list_versions(library).values()):
            build = self.build(library, version)
            names = (*(target.name for target in build.targets), *build.pkgconfig) if build is not None else ()
            for name in (_VERSION_BEHIND.sub("", name.partition(" ")[0]) for name in names):
                for start in starts:
                    if name.startswith(start):
                        found.setdefault(name[len(start) :], set()).add(version)
        return {name: frozenset(versions) for name, versions in found.items()} if len(found) > 2 else {}

    def _compute_presence(
        self,
        library: str,
        platform: str,
        version_of: Callable[[str], str | None],
        has: Callable[[BuildSurface], bool | None],
    ) -> Presence:
        versions = dict.fromkeys(self.list_versions(library).values())
        reported = {one: has(build) for one in versions if (build := self.build(library, one, _NAMED))}
        exact = version_of(library)
        before, after = (exact, exact) if exact in reported else self.find_range(library, platform)
        states = {reported.get(version) for version in (before, after) if version}
        # What the oldest release lacks and a later one has came with that: it was not there before either.
        complete = (before and after) or (after and reported.get(after) is False)
        here = states.pop() if complete and len(states) == 1 else None
        lost = any(reported[one] and reported[two] is False for one, two in pairwise(reported))
        return Presence(library, here, before or after, lost)


def _exports(build: BuildSurface, name: str) -> bool | None:
    """Whether a build exports a target, None where that cannot be known."""
    if any(target.name == name for target in build.targets):
        return True
    return None if any(part == "targets" for part, _ in build.unknown) or not build.cmake_names else False


def _spell(header: str, roots: tuple[str, ...]) -> Iterator[str]:
    """A header as it is written, and as it lies below the folders that flags name."""
    yield header
    folders = header.split("/")
    for place in range(1, len(folders)):
        folder = "/".join(folders[:place])
        if any(f"/{root}".endswith(f"/{folder}") for root in roots):
            yield "/".join(folders[place:])


# `pcl_io-1.11`
_VERSION_BEHIND = re.compile(r"-\d+(?:\.\d+)*\Z")


@cache
def load_libraries() -> SystemLibraries:
    """The shipped libraries, one for each process."""
    return SystemLibraries()
