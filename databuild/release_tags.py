"""Builds data/changes_ros_tags.json.zst: what packages of ROS lost, or deprecate, with versions that no surface is
stored of.

    python -P -m rosimpact.databuild.release_tags CLONES WORK [--only OWNER+NAME ...] --output DATA

CLONES holds git clones with their tags, called `OWNER+NAME`. Surfaces are stored of the versions that distros released;
a repository has tags of others, mostly older ones. Of these, and of the stored versions before and after them, the
packages are read as surfaces are, and compared version by version. A name is gone where no version from then on has
it, as far as they are known, and where the comparison is sure; one that several repositories might mean, a function's
without its scope, is left out, and so is what stored surfaces, or the table of interfaces, tell (superseded.py).

WORK keeps what was read of each clone, so that a run that was stopped goes on with the next one. Rows of repositories
that no clone is of stay as they are. Nobody reads what this makes row by row: names of libraries that a repository
holds a copy of are among them.
"""

from __future__ import annotations

import argparse
import hashlib
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import msgspec
import zstandard

from ..edges.files import write_file
from ..impact.facts.store import Store
from ..impact.targets.snapshot import load_snapshot
from ..impact.targets.surface.changes import ChangeEvent, Line
from ..impact.targets.surface.offers import find_standing
from ..impact.targets.surface.store import load_shipped
from ..impact.targets.tables import DATA
from ..impact.targets.unpacked import read_table
from ..impact.targets.version import parse
from ..impact.tree import TreeError
from .superseded import drop_superseded, is_bare
from .surface.clones import Clone, VersionError
from .surface.compare import RepositorySurfaces
from .surface.package import build_surfaces
from .surface.releases import find_git_directory, normalize_url
from .surface_changes import Lines
from .table_file import write_table

FILE = "changes_ros_tags.json.zst"
_RELEASE = re.compile(r"(?:v|release-|ros2_)?(\d+\.\d+(?:\.\d+)*)\Z")
_KINDS = {"header": ("header-removed", "header-renamed"), "c++": ("api-removed", "api-renamed"),
          "python": ("python-removed", "python-removed"), "command": ("cmake-removed", "cmake-removed"),
          "target": ("cmake-removed", "cmake-removed")}  # fmt: skip
"""Sides of a package to the kinds of rows: of what is gone, and of what has another name in another place."""
_INNER = re.compile(
    r"\w_\Z|(?:^|[/:._])(?:detail|details|internal|impl|private|tests?|_\w*)(?:[/:._]|$)|_(?:H|HPP|H_|HPP_)\Z"
    r"|_INCLUDED_*\Z"
)
_AT_MOST = 60
"""States of a clone that are read, the newest: what is older than all surfaces by more is of no use any longer."""


class ReadLine(msgspec.Struct, frozen=True, array_like=True):
    """What changed of a package from version to version. ros: the generation of ROS that its build is of."""

    package: str
    ros: int
    line: Line


def list_states(clone: Clone, stored: Callable[[str], frozenset[str]], store: Store) -> list[tuple[str, str]]:
    """The versions of a clone that are read, oldest first, each with the ref of its tag: those that are not stored, and
    the stored ones beside them. stored: the versions of a package that are."""
    tags: dict[tuple[int, ...], tuple[str, str]] = {}
    for tag, ref in sorted(clone.tags.items()):
        if match := _RELEASE.match(tag):
            tags.setdefault(parse(match[1]), (match[1], ref))
    ordered = [tags[key] for key in sorted(tags)]
    if not ordered:
        return []
    packages = build_surfaces(clone.read_tree(ordered[-1][1]), store, 1)
    known = frozenset().union(*(stored(package) for package in packages))
    new = {version for version, _ in ordered if version not in known}
    beside = {one for pair in pairwise(version for version, _ in ordered) for one in pair if not new.isdisjoint(pair)}
    return [(version, ref) for version, ref in ordered if version in new | beside][-_AT_MOST:]


def list_stored_versions(package: str) -> frozenset[str]:
    """The versions of a package that surfaces are stored of, whatever its generation of ROS."""
    lines = (load_shipped().find_line(package, ros) for ros in (1, 2))
    return frozenset(version for line in lines if line is not None for version in line.versions)


def read_clone(clone: Clone, states: Sequence[tuple[str, str]], store: Store) -> list[ReadLine]:
    """What changed in a clone's packages from state to state, as list_states() gives them."""
    lines = Lines()
    for version, ref in states:
        try:
            state = RepositorySurfaces(build_surfaces(clone.read_tree(ref), store, 1))
        except (TreeError, OSError) as error:
            print(f"{clone.name} {version}: {error}", file=sys.stderr, flush=True)
            continue
        for package, surface in state.surfaces.items():
            lines.add(package, version, (1 if surface.build.build_type == "catkin" else 2,), state)
    return [ReadLine(package, ros, line) for (package, ros), line in lines.list_lines()]


def list_groups(source: str, read: Iterable[ReadLine]) -> list[dict[str, Any]]:
    """The rows of a repository, in groups of the same package, kind and versions. source: what they say of where they
    are from."""
    groups: dict[tuple[str, ...], dict[str, str]] = {}
    both = {package for package, count in _count_packages(read).items() if count > 1}
    for one in read:
        for side, things in one.line.events.items():
            for name, events in things.items() if side in _KINDS else ():
                if _INNER.search(name) or (side == "c++" and is_bare(one.package, name)):
                    continue
                for kind, removed, deprecated, new in _find_loss(one.line, side, name, events):
                    ros = str(one.ros) if one.package in both else ""
                    groups.setdefault((one.package, kind, removed, deprecated, ros), {})[name] = new
    made = []
    for (package, kind, removed, deprecated, ros), names in sorted(groups.items()):
        bounds = {"removed_in": removed, "deprecated_in": deprecated, "ros": int(ros or 0)}
        shown = {key: value for key, value in bounds.items() if value}
        made.append({"kind": kind, "package": package, "source": source, **shown, "names": dict(sorted(names.items()))})
    return made


def _count_packages(read: Iterable[ReadLine]) -> dict[str, int]:
    found: dict[str, int] = {}
    for one in read:
        found[one.package] = found.get(one.package, 0) + 1
    return found


def _find_loss(line: Line, side: str, name: str, events: Sequence[ChangeEvent]) -> Iterator[tuple[str, str, str, str]]:
    """(kind, version without it, version that deprecates it, what to use instead) of a name that the newest version
    lacks or deprecates; nothing where that is not sure."""
    gone, moved = _KINDS[side]
    there = find_standing(side, events, len(line.versions) - 1).there
    instead = next((one.instead for event in reversed(events) for one in event.reported if one.instead), "")
    warned = next((line.versions[event.place] for event in events if _is_deprecated(event)), "")
    if there:
        if warned and instead != name:
            yield gone, "", warned, instead
        return
    last = next((event for event in reversed(events) if any(one.kind in _GONE for one in event.reported)), None)
    if last is None or any(one.sure < 1 or not one.breaks for one in last.reported):
        return
    new = next((one.instead for one in last.reported if one.instead), instead)
    removed = line.versions[last.place]
    elsewhere = any(one.moved_to or one.kind == "moved" for one in last.reported)
    yield moved if elsewhere and new else gone, removed, warned if warned != removed else "", new


def _is_deprecated(event: ChangeEvent) -> bool:
    """Whether a thing as a whole warns since an event, not only one of the functions that are called so."""
    warns = any(one.kind == "deprecated" for one in event.reported)
    return warns and (event.has is None or event.has.deprecated is not None)


_GONE = ("removed", "moved")


def build_groups(clones: Sequence[Path], work: Path) -> Iterator[tuple[str, list[dict[str, Any]]]]:
    """Clones that have versions which are not stored, as rows name them as their source, and the rows of each. work:
    the folder that keeps what was read. Prints how far it is."""
    with Store() as store:
        for place, folder in enumerate(clones, 1):
            kept = work / f"{folder.name}.msgpack.zst"
            try:
                clone = Clone(folder)
                key = hashlib.sha1(repr(sorted(clone.tags.items())).encode()).hexdigest()
                found = _read_kept(kept, key)
                if found is None:
                    states = list_states(clone, list_stored_versions, store)
                    found = read_clone(clone, states, store) if len(states) > 1 else []
                    data = msgspec.msgpack.encode((key, found))
                    write_file(kept, zstandard.ZstdCompressor(level=3).compress(data))
                    print(f"{place}/{len(clones)} {clone.name}: {len(states)} versions", flush=True)
            except (VersionError, TreeError, OSError) as error:
                print(f"{folder.name}: {error}", file=sys.stderr, flush=True)
                continue
            source = f"release tags of {clone.name}"
            yield source, list_groups(source, found)


def _read_kept(file: Path, key: str) -> list[ReadLine] | None:
    """What an earlier run read of a clone with the same tags."""
    if not file.exists():
        return None
    data = zstandard.ZstdDecompressor().decompress(file.read_bytes())
    of, found = msgspec.msgpack.decode(data, type=tuple[str, list[ReadLine]])
    return found if of == key else None


def list_released_clones(folder: Path) -> list[Path]:
    """The clones in a folder that are of a repository which some distro ever released."""
    urls = {normalize_url(text) for (text,) in load_snapshot().fetch("SELECT text FROM url") if text}
    names = {place: place.name.replace("+", "/", 1).lower() for place in sorted(folder.iterdir()) if place.is_dir()}
    return [place for place, name in names.items() if name in urls and find_git_directory(place) is not None]


def main(arguments: list[str] | None = None) -> None:
    """The command line described at the top."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("clones", type=Path)
    parser.add_argument("work", type=Path, help="folder that keeps what was read")
    parser.add_argument("--only", action="append", default=[], metavar="OWNER+NAME", help="read these clones alone")
    parser.add_argument("--output", type=Path, default=DATA)
    given = parser.parse_args(arguments)
    given.work.mkdir(parents=True, exist_ok=True)
    clones = [place for place in list_released_clones(given.clones) if not given.only or place.name in given.only]
    made = dict(build_groups(clones, given.work))
    file = given.output / FILE
    before = read_table(file, dict[str, Any])["changes"] if file.exists() else []
    groups = [*(group for group in before if group["source"] not in made), *(g for each in made.values() for g in each)]
    rows = {"changes": sorted(groups, key=lambda group: (group["package"], group["kind"], group["source"]))}
    write_table(file, rows)
    content, _ = drop_superseded(file)
    write_table(file, content)
    left = sum(len(group["names"]) for group in content["changes"])
    print(f"{len(made)} clones, {sum(len(g['names']) for g in groups)} rows, {left} that nothing else tells")


if __name__ == "__main__":
    main()
