"""The systems of gz-sim (Ignition Gazebo until version 6), which worlds and models load by the names of their
libraries: data/gz_systems.json.zst, see DATA.md."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

import msgspec

from .surface.includes import covers
from .tables import find_table
from .unpacked import read_table
from .version import find_newest_up_to

if TYPE_CHECKING:
    from .distro.distro import DistroTarget

PREFIXES = ("ignition-gazebo", "gz-sim")
"""What names of libraries of systems begin with."""
_NAME = re.compile(rf"(?:lib)?(?P<prefix>{'|'.join(PREFIXES)})(?P<major>\d*)-(?P<system>[\w-]+)-system(?:\.so)?")
_KEY = re.compile(rf"(?:lib)?(?:{'|'.join(PREFIXES)})(\d+)(?:-dev)?")


class GzSystems(msgspec.Struct, frozen=True):
    """versions: releases, oldest first. systems: each with the spans of versions that have it; prefixes: the same of
    what its loader accepts. vendors: the version that each release of gz_sim_vendor builds."""

    versions: tuple[str, ...]
    systems: dict[str, tuple[int, ...]]
    prefixes: dict[str, tuple[int, ...]]
    vendors: dict[str, str]

    def has(self, spans: tuple[int, ...], version: str) -> bool:
        """Whether spans cover a version."""
        return covers(spans, self.versions.index(version))

    def find_first(self, spans: tuple[int, ...], version: str) -> str:
        """The first version after one that spans cover; empty where there is none."""
        return next((one for one in self.versions[self.versions.index(version) :] if self.has(spans, one)), "")

    def find_last(self, spans: tuple[int, ...], version: str) -> str:
        """The last version before one that spans cover; empty where there is none."""
        return next((one for one in self.versions[self.versions.index(version) :: -1] if self.has(spans, one)), "")


@cache
def load_gz_systems() -> GzSystems:
    """The shipped table. Raises SnapshotError."""
    return read_table(find_table("gz_systems.json.zst"), GzSystems)


class SystemName(NamedTuple):
    """A library's name by its parts. major: of the version, empty for the name that all versions have."""

    prefix: str
    major: str
    system: str


def split_name(library: str) -> SystemName | None:
    """The parts of the name of a system's library; None for one that is called otherwise."""
    name = _NAME.fullmatch(library)
    return SystemName(name["prefix"], name["major"], name["system"]) if name is not None else None


def find_gz_version(target: DistroTarget, along: Iterable[str]) -> str:
    """The version of gz-sim that a target's packages use, as far as the table has it; empty where that is not known.
    along: packages and rosdep keys that come along, which name it where no package vendors it."""
    table = load_gz_systems()
    vendored = target.find_version("gz_sim_vendor")
    if vendored is None:
        majors = {key[1] for name in along if (key := _KEY.fullmatch(name)) is not None}
        wanted = f"{majors.pop()}.999" if len(majors) == 1 else ""
    else:
        wanted = table.vendors.get(find_newest_up_to(vendored, tuple(table.vendors)) or "", "")
    found = find_newest_up_to(wanted, table.versions) if wanted else None
    return found if found is not None and found.partition(".")[0] == wanted.partition(".")[0] else ""
