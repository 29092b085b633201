"""Builds data/gz_systems.json.zst: which systems each version of gz-sim (Ignition Gazebo until 6) has, by what name
its loader finds them, and which version of it each release of `gz_sim_vendor` builds.

A world or model names the library of a system: `gz-sim-imu-system` is that of `gz_add_system(imu)`. The loader takes
the name that the libraries of its version begin with, and the other one where its source has it too.

    python -P -m rosimpact.databuild.gz_systems CLONES      # gazebosim+gz-sim, ros2-gbp+gz_sim_vendor-release
"""

from __future__ import annotations

import re
import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ..impact.facts.cmake import extract
from ..impact.targets.gz_systems import PREFIXES, GzSystems
from ..impact.targets.tables import DATA
from ..impact.targets.version import parse
from .git import BuildError, open_repository
from .surface.releases import find_git_directory
from .surface_file import find_spans
from .table_file import write_table

_RELEASE = re.compile(rf"refs/tags/(?P<prefix>{'|'.join(PREFIXES)})\d*_(?P<version>\d+\.\d+\.\d+)\Z")
_VENDOR = re.compile(r"refs/tags/upstream/(?P<version>\d+\.\d+\.\d+)\Z")
_LOADER = ("src/SystemLoader.cc", "src/Util.cc")
_PART = re.compile(r"set\(LIB_VER_(?:MAJOR|MINOR|PATCH) (\d+)\)")


def build_table(systems: Path, vendor: Path) -> GzSystems:
    """The table from the two clones. Raises BuildError."""
    repository = open_repository(find_git_directory(systems) or systems)
    releases = {m["version"]: (m[0], m["prefix"]) for name in repository.references if (m := _RELEASE.match(name))}
    versions = sorted(releases, key=parse)
    if not versions:
        raise BuildError(f"{systems} has no tags of releases")
    found: dict[str, list[int]] = defaultdict(list)
    taken: dict[str, list[int]] = defaultdict(list)
    for place, version in enumerate(versions):
        name, prefix = releases[version]
        tree = _read_tree(repository, name)
        loader = "".join(tree[path].data.decode() for path in _LOADER if path in tree)
        for other in PREFIXES:
            if other == prefix or f'"{other}"' in loader:
                taken[other].append(place)
        for system in sorted(set(_list_systems(tree["src/systems"]))):
            found[system].append(place)
    count = len(versions)
    return GzSystems(
        tuple(versions),
        {name: tuple(find_spans(places, count)) for name, places in sorted(found.items())},
        {name: tuple(find_spans(places, count)) for name, places in sorted(taken.items())},
        dict(sorted(_list_vendored(vendor), key=lambda each: parse(each[0]))),
    )


def _read_tree(repository: Any, revision: str) -> Any:
    import pygit2

    return repository.revparse_single(revision).peel(pygit2.Tree)


def _list_systems(folder: Any) -> Iterator[str]:
    for entry in folder:
        if entry.type_str == "tree":
            yield from _list_systems(entry)
        elif entry.name == "CMakeLists.txt":
            for command in extract(entry.data).commands:
                if command.name == "gz_add_system" and command.arguments and "$" not in command.arguments[0].text:
                    yield command.arguments[0].text


def _list_vendored(vendor: Path) -> Iterator[tuple[str, str]]:
    repository = open_repository(find_git_directory(vendor) or vendor)
    for name in repository.references:
        if release := _VENDOR.match(name):
            parts = _PART.findall(_read_tree(repository, name)["CMakeLists.txt"].data.decode())
            yield release["version"], ".".join(parts)


def main(arguments: list[str]) -> None:
    """Writes the table."""
    clones = Path(arguments[0])
    table = build_table(clones / "gazebosim+gz-sim", clones / "ros2-gbp+gz_sim_vendor-release")
    write_table(DATA / "gz_systems.json.zst", table)


if __name__ == "__main__":
    main(sys.argv[1:])
