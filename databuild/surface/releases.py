"""Which tag of which clone holds a released version."""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

from ...impact.targets.snapshot import Snapshot
from ...impact.targets.version import parse


class Release(NamedTuple):
    """One release of a repository in a distro, without its packaging number."""

    distro: str
    version: str
    packages: frozenset[str]


def normalize_url(url: str) -> str:
    """`https://github.com/Ros/geometry2.git` gives `ros/geometry2`, for comparison."""
    text = re.sub(r"(?:\.git)?/?$", "", url.strip().lower())
    return "/".join(re.split(r"[/:]", text)[-2:])


def list_releases(snapshot: Snapshot, name: str) -> list[Release]:
    """All releases of the repositories whose source is `…/name`, each distro's in order of version.

    The owner does not count: repositories moved between organisations, and a fork's tag is the same commit.
    """
    wanted = normalize_url(name).rpartition("/")[2]
    urls = [
        number
        for number, text in snapshot.fetch("SELECT id, text FROM url")
        if text and normalize_url(text).rpartition("/")[2] == wanted
    ]
    found: dict[tuple[str, str], Release] = {}
    for url in urls:
        for distro, version, names in snapshot.fetch(
            "SELECT d.name, r.version, p.names FROM release r JOIN distro d ON d.id = r.distro"
            " JOIN packages p ON p.id = r.packages WHERE r.version IS NOT NULL AND (r.distro, r.repository) IN"
            " (SELECT distro, repository FROM source WHERE url = ?) ORDER BY r.ts",
            (url,),
        ):
            plain = version.partition("-")[0]
            found[distro, plain] = Release(distro, plain, frozenset(names.split(" ")))
    return sorted(found.values(), key=lambda r: (r.distro, parse(r.version)))


def find_tag(tags: dict[str, str], version: str, name: str = "") -> str | None:
    """The ref of a version's tag, None when the repository (of that name) has none."""
    for spelling in (version, f"v{version}", f"{name}-{version}", f"ros2_{version}", f"release-{version}"):
        if spelling in tags:
            return tags[spelling]
    return None


def find_git_directory(clone: Path) -> Path | None:
    """The git directory of a clone, bare or not, or of one in its folder `repo`; None where there is none."""
    for candidate in (clone, clone / "repo", clone / "repo" / ".git", clone / ".git"):
        if (candidate / "HEAD").is_file() and (candidate / "objects").is_dir():
            return candidate
    return None
