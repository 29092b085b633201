"""Finds trees that the ROS build farm built: release tags of git repositories whose version rosdistro names.

A tag is taken if the version was the first bloom increment of that version in a distro's file, stayed there for at
least STAYED_DAYS, and every package that rosdistro names for it has a manifest with this version at the tag. A later
increment says that the first one did not build, so that tag is not taken.
"""

from __future__ import annotations

import contextlib
import random
import re
import sqlite3
import subprocess
import tempfile
from collections import defaultdict
from collections.abc import Iterator
from datetime import date, datetime, timezone
from pathlib import Path
from typing import NamedTuple

import zstandard
from mining import ROS1, Clone

STAYED_DAYS = 60


class Release(NamedTuple):
    """A version (with bloom's increment) of a repository in a distro, and the days on which it was there."""

    distro: str
    repository: str
    version: str
    first: date
    last: date
    sha: str
    url: str


@contextlib.contextmanager
def open_history(path: Path) -> Iterator[sqlite3.Connection]:
    """rosdistro's history, from history.sqlite or history.sqlite.zst."""
    with tempfile.NamedTemporaryFile(suffix=".sqlite") as unpacked:
        if path.suffix == ".zst":
            with path.open("rb") as packed:
                zstandard.ZstdDecompressor().copy_stream(packed, unpacked)
            unpacked.flush()
            path = Path(unpacked.name)
        with contextlib.closing(sqlite3.connect(f"file:{path}?mode=ro", uri=True)) as history:
            yield history


def find_sources(history: sqlite3.Connection) -> dict[str, list[tuple[int, int]]]:
    """The (distro, repository) ids of rosdistro by the GitHub repository, owner/name in lower case, that was their
    source at any time."""
    found: dict[str, list[tuple[int, int]]] = defaultdict(list)
    rows = history.execute("select distinct distro, repo, s from repo_event join str on str.id = src_url")
    for distro, repository, url in rows:
        name = re.search(r"github\.com[/:]([\w.-]+/[\w.-]+?)(?:\.git)?/?$", url)
        if name and (distro, repository) not in found[name[1].lower()]:
            found[name[1].lower()].append((distro, repository))
    return found


def list_releases(history: sqlite3.Connection, distro: int, repository: int) -> Iterator[Release]:
    """The first increments of all versions of a repository in a distro, oldest first, with the days they were there."""
    (end,) = history.execute("select max(ts) from repo_event").fetchone()
    names = "select (select name from distro where id = ?), (select name from repo where id = ?)"
    distro_name, repository_name = history.execute(names, (distro, repository)).fetchone()
    rows = history.execute(
        "select ts, gone, v.s, sha, u.s from repo_event left join str v on v.id = version "
        "left join str u on u.id = src_url where distro = ? and repo = ? order by ts",
        (distro, repository),
    ).fetchall()
    spans: list[list] = []
    for ts, gone, version, sha, url in rows:
        version = None if gone else version
        if not spans or spans[-1][0] != version:
            spans.append([version, ts, end, sha, url])
            if len(spans) > 1:
                spans[-2][2] = ts - 24 * 3600
    seen = set()
    for version, first, last, sha, url in spans:
        base = (version or "").rpartition("-")[0]
        if base and base not in seen and version.endswith(("-0", "-1")):
            first_day, last_day = (datetime.fromtimestamp(ts, timezone.utc).date() for ts in (first, last))
            yield Release(distro_name, repository_name, version, first_day, last_day, sha, url or "")
        seen.add(base)


def list_packages(history: sqlite3.Connection, release: Release) -> list[str]:
    """The packages that rosdistro names for a release on its last day."""
    rows = history.execute(
        "select p.name, v.s, r.name, max(ts) from pkg_event e join package p on p.id = e.package "
        "left join str v on v.id = e.version left join repo r on r.id = e.repo "
        "where e.distro = (select id from distro where name = ?) and e.ts < ? group by e.package",
        (release.distro, datetime(*release.last.timetuple()[:3], tzinfo=timezone.utc).timestamp()),
    )
    return sorted(name for name, version, repo, _ in rows if (version, repo) == (release.version, release.repository))


def find_tag(clone: Clone, tags: dict[str, str], release: Release) -> tuple[str, str] | None:
    """The tag of a release and its commit."""
    version, name = release.version.rpartition("-")[0], clone.name.split("/")[1]
    for prefix in ("", "v", f"{release.distro}-", f"{release.distro}/", f"{name}-", f"{release.repository}-"):
        for tag in (prefix + version, f"{prefix}{version}-{release.distro}"):
            if tag in tags:
                return tag, tags[tag]
    return None


def find_manifests(clone: Clone, commit: str, version: str) -> dict[str, str]:
    """The folders of the packages of one version at a commit, by name."""
    found = {}
    for path in clone.list_files(commit):
        if path.rsplit("/", 1)[-1] == "package.xml":
            text = clone.show(commit, path)
            name = re.search(r"<name>\s*([\w-]+)\s*</name>", text)
            if name and re.search(rf"<version[^>]*>\s*{re.escape(version)}\s*</version>", text):
                found[name[1]] = path[: -len("package.xml")].rstrip("/") or "."
    return found


def find_latent(clone: Clone, commit: str, breaks: list[dict]) -> list[str]:
    """The ids of breaks of the repository that were mended in no ancestor of a commit and whose file is there."""
    files = set(clone.list_files(commit))
    found = []
    for record in breaks:
        if record["repo"] == clone.name and record["expected_file"] in files:
            command = ["git", "--git-dir", str(clone.folder), "merge-base", "--is-ancestor", record["fix"], commit]
            if subprocess.run(command, capture_output=True, check=False).returncode:
                found.append(record["id"])
    return found


def find_releases(
    clone: Clone, history: sqlite3.Connection, sources: dict, breaks: list[dict], most: int, seed: int
) -> list[dict]:
    """At most `most` release trees of a repository, each of another distro and, as long as there are such, of another
    commit, drawn with a seed. Each is a record ready for a line of JSON."""
    commit = "%(if)%(*objectname)%(then)%(*objectname)%(else)%(objectname)%(end)"
    lines = clone.read("for-each-ref", "refs/tags", f"--format=%(refname:strip=2) {commit}").splitlines()
    tags: dict[str, str] = {tag: commit for tag, commit in map(str.split, lines)}
    by_distro = defaultdict(list)
    for distro, repository in sources.get(clone.name.lower(), ()):
        for release in list_releases(history, distro, repository):
            tag = find_tag(clone, tags, release)
            if tag and (release.last - release.first).days >= STAYED_DAYS:
                by_distro[release.distro].append((release, *tag))
    chance = random.Random(f"{seed} {clone.name}")
    choices = [item for _, found in sorted(by_distro.items()) for item in found]
    chance.shuffle(choices)
    records, used = [], set()
    for again in (False, True):
        for release, tag, commit in choices:
            if len(records) == most or release.distro in used or (commit in used) != again:
                continue
            version = release.version.rpartition("-")[0]
            packages = list_packages(history, release)
            folders = find_manifests(clone, commit, version)
            if not packages or not folders.keys() >= set(packages):
                continue
            used |= {release.distro, commit}
            records.append(
                {
                    "repo": clone.name,
                    "tag": tag,
                    "commit": commit,
                    "distro": release.distro,
                    "ros": 1 if release.distro in ROS1 else 2,
                    "packages": packages,
                    "package_paths": [{"name": name, "path": folders[name]} for name in packages],
                    "release": release.version,
                    "rosdistro_commit": release.sha,
                    "in_distro_from": release.first.isoformat(),
                    "in_distro_until_at_least": release.last.isoformat(),
                    "source_url": release.url,
                    "possibly_latent": find_latent(clone, commit, breaks),
                }
            )
    return records


def select(records: list[dict], number: int, share_ros2: float, seed: int) -> list[dict]:
    """At most `number` trees, in the order given. Some of ROS 1, drawn with a seed, are left out until ROS 2 has its
    share."""
    chance = random.Random(seed)
    ros2 = [at for at, record in enumerate(records) if record["ros"] == 2]
    ros1 = [at for at, record in enumerate(records) if record["ros"] == 1]
    ros2 = chance.sample(ros2, min(len(ros2), number))
    most = len(ros1) if share_ros2 <= 0 else int(len(ros2) * (1 - share_ros2) / share_ros2)
    ros1 = chance.sample(ros1, min(len(ros1), most, number - len(ros2)))
    return [records[at] for at in sorted(ros1 + ros2)]
