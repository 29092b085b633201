"""Declared dependencies that no cache tells of are read from tags, of source repositories and of bloom's."""

from __future__ import annotations

import sqlite3
from pathlib import Path

import pygit2
import pytest
from rosimpact.databuild.manifest_tags import add, read_clone, read_release_clone
from rosimpact.databuild.manifests import DeclaredVersion
from rosimpact.databuild.surface.releases import Release
from rosimpact.databuild.write import SCHEMA

SIGNATURE = pygit2.Signature("Robots", "robots@example.org", 1_400_000_000, 0)


def manifest(name: str, version: str, *depends: str) -> str:
    lines = "".join(f"<run_depend>{name}</run_depend>" for name in depends)
    return f"<package><name>{name}</name><version>{version}</version>{lines}</package>"


def commit(repository: pygit2.Repository, files: dict[str, str], tag: str) -> None:
    """Makes these files the next state, under a tag."""
    for path, text in files.items():
        place = Path(repository.workdir, path)
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(text)
        repository.index.add(path)
    tree = repository.index.write_tree()
    before = [] if repository.head_is_unborn else [repository.head.target]
    oid = repository.create_commit("HEAD", SIGNATURE, SIGNATURE, tag, tree, before)
    repository.references.create(f"refs/tags/{tag}", oid)


@pytest.fixture
def repository(tmp_path: Path) -> pygit2.Repository:
    return pygit2.init_repository(str(tmp_path / "sled"))


def read(repository: pygit2.Repository, *releases: Release) -> list[tuple[str, str, str, str]]:
    found = read_clone(Path(repository.path), "robots/sled", list(releases))
    return [(d.distro, d.package, d.version, d.entries) for d in found]


def test_each_release_is_read_at_its_tag(repository):
    commit(repository, {"sled/package.xml": manifest("sled", "1.0.0", "roscpp")}, "1.0.0")
    commit(repository, {"sled/package.xml": manifest("sled", "1.1.0", "roscpp", "tf")}, "v1.1.0")
    found = read(
        repository,
        Release("hydro", "1.0.0", frozenset({"sled"})),
        Release("indigo", "1.1.0", frozenset({"sled"})),
    )
    assert found == [("hydro", "sled", "1.0.0", "roscpp\tex"), ("indigo", "sled", "1.1.0", "roscpp\tex\ntf\tex")]


@pytest.mark.parametrize(
    "release",
    [
        Release("hydro", "2.0.0", frozenset({"sled"})),  # no such tag
        Release("hydro", "1.0.0", frozenset({"dogs"})),  # not what it released
        Release("hydro", "1.0.1", frozenset({"sled"})),  # the tag's manifest is of another version
    ],
)
def test_what_the_tag_does_not_tell_is_left_out(repository, release):
    commit(repository, {"sled/package.xml": manifest("sled", "1.0.0", "roscpp")}, "1.0.0")
    repository.references.create("refs/tags/1.0.1", repository.head.target)
    assert read(repository, release) == []


def test_a_package_within_a_package_is_none(repository):
    files = {"package.xml": manifest("sled", "1.0.0"), "inner/package.xml": manifest("dogs", "1.0.0")}
    commit(repository, files, "1.0.0")
    assert [row[1] for row in read(repository, Release("hydro", "1.0.0", frozenset({"sled", "dogs"})))] == ["sled"]


def test_release_repositories_have_a_tag_for_each_package_and_distro(repository):
    commit(repository, {"package.xml": manifest("sled", "0.2.4", "boost")}, "release/hydro/sled/0.2.4-1")
    repository.references.create("refs/tags/upstream/0.2.4", repository.head.target)
    repository.references.create("refs/tags/release/indigo/dogs/0.2.4-0", repository.head.target)
    found = list(read_release_clone(Path(repository.path)))
    assert [(d.distro, d.package, d.version, d.entries) for d in found] == [("hydro", "sled", "0.2.4", "boost\tex")]


@pytest.fixture
def raw(tmp_path: Path) -> bytes:
    """A database that knows two packages, and of one what it declares in Melodic."""
    path = tmp_path / "distros.sqlite"
    connection = sqlite3.connect(path)
    connection.executescript(SCHEMA)
    connection.execute("INSERT INTO distro VALUES(1, 'hydro', 1, 2, '')")
    connection.execute("INSERT INTO distro VALUES(2, 'melodic', 1, 2, '')")
    connection.executemany("INSERT INTO package VALUES(?, ?)", [(1, "sled"), (2, "dogs")])
    connection.execute("INSERT INTO dependencies VALUES(1, 'roscpp\tex')")
    connection.execute("INSERT INTO manifest VALUES(2, 1, '1.0.0', 1, '')")
    connection.commit()
    connection.close()
    return path.read_bytes()


def test_only_what_the_database_lacks_comes_in(raw, tmp_path):
    declared = [
        DeclaredVersion("hydro", "sled", "0.9.0", "roscpp\tex", ""),
        DeclaredVersion("hydro", "dogs", "0.9.0", "tf\tb", "cmake"),
        DeclaredVersion("melodic", "sled", "1.1.0", "tf\tb", ""),  # a cache tells of it there
        DeclaredVersion("hydro", "cats", "0.9.0", "", ""),  # never released
        DeclaredVersion("ardent", "sled", "0.9.0", "", ""),  # no distro of the database
    ]
    bigger, added = add(raw, declared)
    assert added == 2
    path = tmp_path / "bigger.sqlite"
    path.write_bytes(bigger)
    rows = sqlite3.connect(path).execute(
        "SELECT o.name, p.name, m.version, d.entries, m.build_type FROM manifest m JOIN distro o ON o.id = m.distro"
        " JOIN package p ON p.id = m.package JOIN dependencies d ON d.id = m.dependencies ORDER BY 1, 2"
    )
    assert rows.fetchall() == [
        ("hydro", "dogs", "0.9.0", "tf\tb", "cmake"),
        ("hydro", "sled", "0.9.0", "roscpp\tex", ""),
        ("melodic", "sled", "1.0.0", "roscpp\tex", ""),
    ]
    assert add(bigger, declared)[1] == 0  # once more, nothing is new
