"""Adds the declared dependencies of releases that no rosdistro cache tells of, read from the repositories' tags.

usage: python -P -m rosimpact.databuild.manifest_tags CLONES [--data DIR] [--output DIR]

CLONES holds git clones with their tags, bare or not, called `OWNER+NAME` (the git directory may lie below). The caches
begin with Melodic and with Crystal; what a package of an earlier distro declared stands in the package.xml of its
release's tag. Libraries whose own sources have none (console_bridge, urdfdom) got one in bloom's release repository,
`OWNER+NAME-release`. Only names, kinds, conditions and version bounds are kept.
"""

from __future__ import annotations

import argparse
import contextlib
import re
import sqlite3
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ..impact.targets.distro.distro import make_version_key
from ..impact.targets.snapshot import Snapshot, read_shipped
from ..impact.targets.tables import DATA
from .git import open_repository
from .manifests import DeclaredVersion, changes_only, parse_manifest
from .surface.releases import Release, find_git_directory, find_tag, list_releases
from .write import write_snapshot

_TREE = "tree"
_NAME = re.compile(rb"<name>\s*([^<\s]+)\s*</name>")


class ManifestReader:
    """Manifests of a git repository's packages at any commit. repository: a pygit2.Repository."""

    def __init__(self, repository: Any):
        self._repository = repository
        self._folders: dict[bytes, dict[str, str]] = {}

    def read_manifests(self, tree: Any) -> dict[str, str]:
        """Package to the text of its package.xml, as colcon finds them: the first one on the way down."""
        known = self._folders.get(tree.id.raw)
        if known is None:
            known = self._folders[tree.id.raw] = dict(self._find_manifests(tree))
        return known

    def _find_manifests(self, tree: Any) -> Iterator[tuple[str, str]]:
        entries = {entry.name: entry for entry in tree}
        manifest = entries.get("package.xml")
        if manifest is not None and manifest.type_str == "blob":
            match = _NAME.search(manifest.data)
            if match:
                yield match.group(1).decode("utf-8", "replace"), manifest.data.decode("utf-8", "replace")
            return
        for name, entry in entries.items():
            if entry.type_str == _TREE and not name.startswith("."):
                yield from self.read_manifests(entry).items()


def read_clone(place: Path, name: str, releases: list[Release]) -> Iterator[DeclaredVersion]:
    """What the packages of each release declare in the tree of its tag. name: `owner/name` of the repository.

    A release without a tag gives nothing, nor does a package that the tagged tree lacks or has in another version.
    """
    import pygit2

    repository = open_repository(place)
    reader = ManifestReader(repository)
    tags = {ref.removeprefix("refs/tags/"): ref for ref in repository.references if ref.startswith("refs/tags/")}
    for release in releases:
        ref = find_tag(tags, release.version, name.rpartition("/")[2])
        if ref is None:
            continue
        try:
            tree = repository.revparse_single(ref).peel(pygit2.Tree)
        except (KeyError, ValueError, pygit2.GitError):
            continue
        for package, text in reader.read_manifests(tree).items():
            declared = parse_manifest(release.distro, text) if package in release.packages else None
            if declared is not None and declared.version == release.version:
                yield declared


# Tags that bloom makes: release/hydro/console_bridge/0.2.4-0.
_BLOOM = re.compile(r"release/([a-z]+)/([\w-]+)/([\d.]+)-\d+\Z")


def read_release_clone(place: Path) -> Iterator[DeclaredVersion]:
    """The same for a release repository of bloom's, where each package of each distro has a tag of its own."""
    import pygit2

    repository = open_repository(place)
    for ref in repository.references:
        match = _BLOOM.match(ref.removeprefix("refs/tags/"))
        if match is None:
            continue
        distro, package, version = match.groups()
        try:
            text = repository.revparse_single(ref).peel(pygit2.Tree)["package.xml"].data.decode("utf-8", "replace")
        except (KeyError, ValueError, pygit2.GitError):
            continue
        declared = parse_manifest(distro, text)
        if declared is not None and (declared.package, declared.version) == (package, version):
            yield declared


def read_clones(folder: Path, snapshot: Snapshot) -> list[DeclaredVersion]:
    """The same for all clones in a folder, one entry where the declaration changed with a version."""
    found: list[DeclaredVersion] = []
    for clone in sorted(folder.iterdir()):
        where = find_git_directory(clone) if clone.is_dir() else None
        if where is not None:
            name = clone.name.replace("+", "/")
            found.extend(read_clone(where, name, list_releases(snapshot, name)))
            if name.endswith("-release"):
                found.extend(read_release_clone(where))
    return changes_only(found, make_version_key)


def add(raw: bytes, declared: list[DeclaredVersion]) -> tuple[bytes, int]:
    """A database with these manifests too, and how many came in. raw: an unpacked database.

    Packages of which the database knows a manifest in that distro, from a cache or an earlier run, stay as they are.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "distros.sqlite"
        path.write_bytes(raw)
        with contextlib.closing(sqlite3.connect(path)) as connection:
            connection.execute("PRAGMA journal_mode=OFF")
            known = set(connection.execute("SELECT DISTINCT distro, package FROM manifest"))
            distros = dict(connection.execute("SELECT name, id FROM distro"))
            packages = dict(connection.execute("SELECT name, id FROM package"))
            entries = {text: number for number, text in connection.execute("SELECT id, entries FROM dependencies")}
            rows = []
            for item in declared:
                place = distros.get(item.distro), packages.get(item.package)
                if None in place or place in known:
                    continue
                if item.entries not in entries:
                    entries[item.entries] = len(entries) + 1
                    connection.execute("INSERT INTO dependencies VALUES(?, ?)", (entries[item.entries], item.entries))
                rows.append((*place, item.version, entries[item.entries], item.build_type))
            connection.executemany("INSERT OR IGNORE INTO manifest VALUES(?, ?, ?, ?, ?)", rows)
            connection.commit()
            connection.execute("VACUUM")
        return path.read_bytes(), len(rows)


def main(arguments: list[str] | None = None) -> None:
    """The command line described at the top."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("clones", type=Path)
    parser.add_argument("--data", type=Path, default=DATA, help="the data folder to begin with")
    parser.add_argument("--output", type=Path, default=DATA)
    given = parser.parse_args(arguments)
    declared = read_clones(given.clones, Snapshot(given.data))
    raw, added = add(Snapshot(given.data).unpack(), declared)
    info = read_shipped(given.data)
    size = write_snapshot(raw, info.date, info.sources, given.output)
    print(f"{len(declared)} manifests at tags, {added} added; {size} bytes packed")


if __name__ == "__main__":
    main()
