"""The distros that the snapshot knows, and when each was what."""

from __future__ import annotations

import datetime
import functools
from typing import TYPE_CHECKING, NamedTuple

import msgspec

from .. import snapshot as snapshots
from ..snapshot import Snapshot

if TYPE_CHECKING:
    pass


class DistroFacts(msgspec.Struct, frozen=True):
    """What data/distros.yaml says of a distro. Days are ISO; end_of_life None means none is set."""

    released: str
    end_of_life: str | None
    lts: bool
    platform: str
    libraries_from: dict[str, str] = {}
    libraries: dict[str, str] = {}


class KnownDistro(NamedTuple):
    """One distro of the snapshot in brief: first_day and last_day bound the releases known."""

    name: str
    ros: int
    python: int
    status: str
    released: str
    end_of_life: str
    lts: bool
    first_day: str
    last_day: str


def known_distros(data: Snapshot | None = None) -> tuple[KnownDistro, ...]:
    """All distros of the snapshot, oldest first."""
    return _known_distros(data or snapshots.default())


@functools.lru_cache(maxsize=4)
def _known_distros(data: Snapshot) -> tuple[KnownDistro, ...]:
    facts = dict(data.rows("SELECT name, facts FROM distro_fact"))
    found = []
    for name, ros, python, status, first, last in data.rows(
        "SELECT name, ros, python, status, first, last FROM distro LEFT JOIN"
        " (SELECT distro, min(ts) AS first, max(ts) AS last FROM release GROUP BY distro) ON distro = id ORDER BY id"
    ):
        fact = msgspec.json.decode(facts[name], type=DistroFacts) if name in facts else None
        found.append(
            KnownDistro(
                name,
                ros,
                python,
                status,
                fact.released if fact else day_of(first) if first else "",
                (fact.end_of_life or "") if fact else "",
                fact.lts if fact else False,
                day_of(first) if first else "",
                day_of(last) if last else "",
            )
        )
    return tuple(sorted(found, key=lambda known: known.released))


def releases(package: str) -> frozenset[tuple[int, str]]:
    """(ROS generation, version) of every release of a package in any distro."""
    rows = snapshots.default().rows(
        "SELECT DISTINCT d.ros, r.version, n.names FROM home h JOIN package p ON p.id = h.package"
        " JOIN distro d ON d.id = h.distro JOIN release r ON r.repository = h.repository AND r.distro = h.distro"
        " JOIN packages n ON n.id = r.packages WHERE p.name = ? AND r.version IS NOT NULL",
        (package,),
    )
    return frozenset((ros, _upstream(version)) for ros, version, names in rows if package in names.split(" "))


def day_of(ts: int) -> str:
    """The ISO day (UTC) of a moment, in seconds since 1970."""
    return datetime.datetime.fromtimestamp(ts, datetime.timezone.utc).date().isoformat()


def end_of_day(day: str) -> int:
    """The last second (UTC) of an ISO day, in seconds since 1970."""
    start = datetime.datetime.combine(datetime.date.fromisoformat(day), datetime.time(), datetime.timezone.utc)
    return int(start.timestamp()) + 86_399


def _upstream(version: str) -> str:
    """`1.2.3-0` → `1.2.3`: the part after the dash counts the packaging."""
    return version.partition("-")[0]


_FEW_RULES = 100
"""Keys with a rule that an operating system has at least; rosdep's files also hold misspelt names of systems."""


@functools.lru_cache(maxsize=4)
def systems_of_rosdep(data: Snapshot) -> frozenset[str]:
    """The operating systems that rosdep has rules for."""
    counted = data.rows("SELECT os, count(DISTINCT key) FROM rule GROUP BY os")
    return frozenset(name for name, keys in counted if keys >= _FEW_RULES and name != "*")
