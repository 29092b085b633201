"""Which Debian packages come along with one that is installed: the shipped graph, made by databuild/apt.py."""

from collections.abc import Iterator
from functools import cache, cached_property

import msgspec

from ....edges.groups import group_pairs
from ....edges.memory import cache_method
from ....edges.reach import walk
from ..platform import find_neighbours
from ..tables import find_table
from ..unpacked import read_table

INFERRED = 1 << 15
"""Bit of a relation that was read off the lists of files of Ubuntu's suites instead of a package's own dependencies."""


class AptGraph(msgspec.Struct, frozen=True, array_like=True):
    """suites: platforms (`debian bookworm`) whose indices were read. packages: their names, sorted; the rest is places
    in this list. base: what every machine that builds has. brings: package to (package, bits of the suites where it
    comes along with the first one)."""

    suites: tuple[str, ...]
    packages: tuple[str, ...]
    base: tuple[int, ...]
    brings: dict[int, list[tuple[int, int]]]


class Apt:
    """The graph as one platform sees it. Of a platform whose index was not read, all counts that the releases before
    and after it bring, or any of them where one of these two was not read: such an answer may say that something is
    there, and never that it is missing."""

    def __init__(self, graph: AptGraph, platform: str):
        self._graph = graph
        self._place = {name: place for place, name in enumerate(graph.packages)}
        near = find_neighbours(platform, graph.suites)
        self._inferred = platform not in graph.suites
        self._mask = sum({1 << graph.suites.index(one) for one in near}) if all(near) else INFERRED - 1

    def knows(self, package: str) -> bool:
        """Whether some archive that was read has a package which comes along with others, or brings others."""
        return package in self._place

    @cached_property
    def base(self) -> frozenset[str]:
        """Packages of every machine that builds."""
        return frozenset(self._graph.packages[place] for place in self._graph.base)

    @cache_method
    def list_added(self, package: str) -> frozenset[str]:
        """A package and those that are installed along with it, as far as rosdep keys install them."""
        return frozenset(self._iterate_brought_by(package))

    @cache_method
    def list_bringing(self, packages: frozenset[str]) -> frozenset[str]:
        """These packages and all that bring one of them along."""
        places = [place for name in packages if (place := self._place.get(name)) is not None]
        found = walk(places, lambda one: self._brought_with.get(one, ()))
        return packages.union(self._graph.packages[place] for place in found)

    @cached_property
    def _brought_with(self) -> dict[int, list[int]]:
        """Packages to those that bring them along."""
        mask = self._mask | (INFERRED if self._inferred else 0)
        return group_pairs(
            (other, place) for place, others in self._graph.brings.items() for other, bits in others if bits & mask
        )

    def _iterate_brought_by(self, package: str) -> Iterator[str]:
        yield package
        python = package.partition("-")[0]
        if python in ("python", "python3"):
            yield python  # Debian's Python policy, of packages that no suite here has too
        start = self._place.get(package)
        if start is None:
            return
        brings, mask = self._graph.brings, self._mask
        found = set(walk([start], lambda one: (other for other, bits in brings.get(one, ()) if bits & mask)))
        if self._inferred:
            # What was read off lists of files is complete as it is, and following it would add up its errors.
            found.update(other for other, bits in brings.get(start, ()) if bits & INFERRED)
        for place in found:
            name = self._graph.packages[place]
            yield name
            if self._inferred and name.startswith("python3"):
                yield name.replace("python3", "python", 1)  # older platforms have the library for Python 2


@cache
def _load_graph() -> AptGraph:
    return read_table(find_table("apt.json.zst"), AptGraph)


@cache
def load_apt(platform: str) -> Apt:
    """The shipped graph for a platform (`ubuntu jammy`). Raises SnapshotError when it is missing or damaged."""
    return Apt(_load_graph(), platform)
