"""The distros that the snapshot knows, and when each was what."""

from __future__ import annotations

import datetime
import functools
from collections.abc import Iterable
from typing import NamedTuple

import msgspec

from .. import snapshot as snapshots
from ..snapshot import Snapshot


class DistroFacts(msgspec.Struct, frozen=True):
    """What data/distros.yaml says of a distro. Days are ISO; end_of_life None means none is set."""

    released: str
    end_of_life: str | None
    lts: bool
    platform: str
    libraries_from: dict[str, str] = {}
    libraries: dict[str, str] = {}


class KnownDistro(NamedTuple):
    """One distro of the snapshot in brief. number: in the tables. released: the day of its first release where nobody
    says more; end_of_life: empty when none is set."""

    number: int
    name: str
    ros: int
    python: int
    status: str
    released: str
    end_of_life: str
    lts: bool
    facts: DistroFacts | None


def list_known_distros(data: Snapshot | None = None) -> tuple[KnownDistro, ...]:
    """All distros of the snapshot, oldest first."""
    return tuple(_load_known_distros(data or snapshots.load_snapshot()).values())


def find_distro(name: str, data: Snapshot | None = None) -> KnownDistro | None:
    """The distro of this name."""
    return _load_known_distros(data or snapshots.load_snapshot()).get(name)


def suggest_name(name: str, known: Iterable[str], before: str = "") -> str:
    """A question about a name that is none, after some text; empty where nothing is called like it."""
    import difflib

    close = difflib.get_close_matches(name, list(known), 1)
    return f"{before}did you mean `{close[0]}`?" if close else ""


def release_day(distro: str) -> str:
    """The ISO day of a distro's release; empty when the data does not tell."""
    known = find_distro(distro)
    return known.released if known is not None else ""


@functools.lru_cache(maxsize=4)
def _load_known_distros(data: Snapshot) -> dict[str, KnownDistro]:
    reported = data.fetch("SELECT name, facts FROM distro_fact")
    facts = {name: msgspec.json.decode(text, type=DistroFacts) for name, text in reported}
    found = []
    for number, name, ros, python, status, first in data.fetch(
        "SELECT id, name, ros, python, status, min(ts) FROM distro LEFT JOIN release ON distro = id"
        " GROUP BY id ORDER BY id"
    ):
        fact = facts.get(name)
        released = fact.released if fact else format_day(first) if first else ""
        end, lts = (fact.end_of_life or "", fact.lts) if fact else ("", False)
        found.append(KnownDistro(number, name, ros, python, status, released, end, lts, fact))
    return {known.name: known for known in sorted(found, key=lambda known: known.released)}


def list_releases(package: str) -> frozenset[tuple[int, str]]:
    """(ROS generation, version) of every release of a package in any distro."""
    return frozenset((ros, version) for ros, _, _, version in _fetch_releases(package, snapshots.load_snapshot()))


def find_release(package: str, version: str, data: Snapshot) -> tuple[str, tuple[str, ...]] | None:
    """The repository that released a package last, as rosdistro calls it, and the distros that released it in this
    version; None for a package that no distro has."""
    rows = _fetch_releases(package, data)
    if not rows:
        return None
    return rows[-1][2], tuple(dict.fromkeys(distro for _, distro, _, found in rows if found == version))


def _fetch_releases(package: str, data: Snapshot) -> list[tuple[int, str, str, str]]:
    """(ROS generation, distro, repository, version) of every release of a package in any distro, the oldest first."""
    rows = data.fetch(
        "SELECT d.ros, d.name, o.name, r.version, n.names FROM home h JOIN package p ON p.id = h.package"
        " JOIN distro d ON d.id = h.distro JOIN repository o ON o.id = h.repository"
        " JOIN release r ON r.repository = h.repository AND r.distro = h.distro"
        " JOIN packages n ON n.id = r.packages WHERE p.name = ? AND r.version IS NOT NULL ORDER BY r.ts",
        (package,),
    )
    return [
        (ros, distro, repository, _strip_packaging(version))
        for ros, distro, repository, version, names in rows
        if package in names.split(" ")
    ]


def format_day(ts: int) -> str:
    """The ISO day (UTC) of a moment, in seconds since 1970."""
    return datetime.datetime.fromtimestamp(ts, datetime.timezone.utc).date().isoformat()


def compute_end_of_day(day: str) -> int:
    """The last second (UTC) of an ISO day, in seconds since 1970."""
    start = datetime.datetime.combine(datetime.date.fromisoformat(day), datetime.time(), datetime.timezone.utc)
    return int(start.timestamp()) + 86_399


def _strip_packaging(version: str) -> str:
    """`1.2.3-0` → `1.2.3`: the part after the dash counts the packaging."""
    return version.partition("-")[0]


_FEW_RULES = 100
"""Keys with a rule that an operating system has at least; rosdep's files also hold misspelt names of systems."""


@functools.lru_cache(maxsize=4)
def list_rosdep_systems(data: Snapshot) -> frozenset[str]:
    """The operating systems that rosdep has rules for."""
    counted = data.fetch("SELECT os, count(DISTINCT key) FROM rule GROUP BY os")
    return frozenset(name for name, keys in counted if keys >= _FEW_RULES and name != "*")


@functools.lru_cache(maxsize=8)
def list_public_rules(data: Snapshot, system: str, ts: int) -> dict[str, str]:
    """The public rosdep rules of a moment for an operating system by key, as they are stored; targets share them."""
    asked = "SELECT key, rule, max(ts) FROM rule WHERE os = ? AND ts <= ? GROUP BY key"
    # Some keys stand for every operating system under the name `*`.
    rows = (row for name in ("*", system) for row in data.fetch(asked, (name, ts)))
    return {key: rule for key, rule, _ in rows if rule is not None}
