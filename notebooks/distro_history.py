"""The life of a distro: what stood in it on every day, what each sync changed, who depends on whom, what lags behind.

Versions are upstream ones (`1.2.3` of `1.2.3-4`): a package built again from the same source has not changed.
Availability follows syncs as in `impact/targets/distro/distro.py`: before a distro's first known sync the commit's day
stands.
"""

from __future__ import annotations

import bisect
import datetime
import functools
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from rosimpact.impact.conditions import Environment
from rosimpact.impact.conditions.manifest import evaluate
from rosimpact.impact.targets import snapshot as snapshots
from rosimpact.impact.targets.distro.distro import TargetError, make_version_key
from rosimpact.impact.targets.distro.known import KnownDistro, compute_end_of_day, format_day, list_known_distros
from rosimpact.impact.targets.snapshot import Snapshot
from rosimpact.impact.targets.version import parse

ABSENT = -1
"""Stands in a table of versions where a package is not released."""

_COMES_ALONG = frozenset("betox")
# Manifests of these distros are not known; what their packages declare is taken from the nearest later one.
_BORROWED = {"groovy": "melodic", "hydro": "melodic", "indigo": "melodic", "jade": "melodic", "kinetic": "melodic",
             "lunar": "melodic", "ardent": "crystal", "bouncy": "crystal"}  # fmt: skip


class Sync(NamedTuple):
    """What one sync did to a distro.

    packages: released after it. changed, added, removed: how many. major, minor: of the changed ones, how many moved
    the first or the second number of their version. reached: how many packages have at least one changed package
    beneath them, or changed themselves. changed_hubs: the hubs (see Graph.hubs) that changed, the most needed first.
    """

    distro: str
    day: str
    packages: int
    changed: int
    added: int
    removed: int
    major: int
    minor: int
    reached: int
    changed_hubs: tuple[str, ...]


class Lag(NamedTuple):
    """How long after a distro's release a package of its forerunner arrived: days, 0 when it was there on day one.

    arrived: whether it did; otherwise `days` is how long it had not when the distro ended or the data stops.
    """

    package: str
    days: int
    arrived: bool


class Behind(NamedTuple):
    """A package whose version in one distro is lower than in a newer one: for how many days that has been so."""

    package: str
    version: str
    newer: str
    days: int


class Life(NamedTuple):
    """One version of a repository's packages in a distro: days until the next, ended False when none came."""

    repository: str
    days: int
    ended: bool


class Drift(NamedTuple):
    """How far a machine that stays is from one that upgrades, `lags` days after both were equal.

    Sums over all starting days, one row for each repository (releases come by repository): `differing[r, n]` counts
    packages of it whose version differs after lags[n] days, `released[r]` those that were there at the start.
    The weighted ones count each package as often as packages depend on it. `by_start[s, n]` is the share of all
    packages for each starting day, `by_start_weighted` the weighted one, `reached[s, n]` the share of packages that
    have a differing one beneath them or differ themselves (at the lags in `reach_lags`).
    """

    distro: str
    lags: tuple[int, ...]
    starts: tuple[str, ...]
    repositories: tuple[str, ...]
    differing: NDArray[np.float64]
    released: NDArray[np.float64]
    differing_weighted: NDArray[np.float64]
    released_weighted: NDArray[np.float64]
    by_start: NDArray[np.float64]
    by_start_weighted: NDArray[np.float64]
    reach_lags: tuple[int, ...]
    reached: NDArray[np.float64]

    def share(self) -> NDArray[np.float64]:
        """Share of packages that differ, by lag."""
        return self.differing.sum(axis=0) / self.released.sum()

    def share_weighted(self) -> NDArray[np.float64]:
        """The same with each package counted as often as packages depend on it."""
        return self.differing_weighted.sum(axis=0) / self.released_weighted.sum()


class Graph:
    """Who depends on whom in a distro on a day: `beneath[i, j]` says that package i has j beneath it, however deep.

    A package is beneath itself. Dependencies to build and to run count, those to test and to document do not.
    """

    def __init__(self, packages: Sequence[str], direct: Iterable[tuple[str, str]]):
        self.packages = tuple(packages)
        place = {name: number for number, name in enumerate(self.packages)}
        below: list[set[int]] = [set() for _ in self.packages]
        for above, dependency in direct:
            if above in place and dependency in place:
                below[place[above]].add(place[dependency])
        self.beneath = _closure(below)
        self.dependents: dict[str, int] = dict(
            zip(self.packages, (self.beneath.sum(axis=0, dtype=np.int64) - 1).tolist(), strict=True)
        )

    def hubs(self, share: float = 0.1) -> tuple[str, ...]:
        """Packages that at least this share of the others depend on, the most needed first."""
        least = share * (len(self.packages) - 1)
        chosen = [name for name, count in self.dependents.items() if count >= least and count]
        return tuple(sorted(chosen, key=lambda name: (-self.dependents[name], name)))

    def reached(self, changed: Iterable[str]) -> int:
        """How many packages have one of these beneath them; they themselves count."""
        wanted = set(changed)
        marks = np.fromiter((name in wanted for name in self.packages), bool, len(self.packages))
        return int(self.beneath[:, marks].any(axis=1).sum())


class History:
    """All releases of one distro. Raises TargetError for an unknown one.

    begin, end: ISO days of its announced release, and of its end of life or of the data's last day if that is earlier.
    packages: every package ever released in it, sorted. syncs: (day, moment of the commit that it held).
    """

    def __init__(self, distro: str, data: Snapshot | None = None):
        self._data = data or snapshots.load_snapshot()
        known = {one.name: one for one in list_known_distros(self._data)}
        if distro not in known:
            raise TargetError(f"unknown distro `{distro}`; known are {', '.join(known)}")
        self.known: KnownDistro = known[distro]
        self.distro = distro
        self.begin = self.known.released
        self.end = min(self.known.end_of_life or self._data.date, self._data.date)
        (self._id,) = self._data.query_row("SELECT id FROM distro WHERE name = ?", (distro,)) or (None,)
        self.syncs: tuple[tuple[str, int], ...] = tuple(
            self._data.fetch("SELECT day, cut FROM sync WHERE distro = ? ORDER BY day", (self._id,))
        )
        self._steps, self.repository_of, self._lives = self._read()
        self.packages = tuple(sorted(self._steps))
        self._graphs: dict[str, Graph] = {}
        self._sync_days = [day for day, _ in self.syncs]

    def _read(self):
        names = dict(self._data.fetch("SELECT id, name FROM repository"))
        sets = {key: tuple(text.split(" ")) for key, text in self._data.fetch("SELECT id, names FROM packages")}
        events: dict[int, list[tuple[int, int, str | None, tuple[str, ...]]]] = {}
        lives: list[tuple[str, int, int | None]] = []
        standing: dict[int, tuple[int, str]] = {}
        for repository, ts, version, key in self._data.fetch(
            "SELECT repository, ts, version, packages FROM release WHERE distro = ? ORDER BY ts, repository",
            (self._id,),
        ):
            plain = version.partition("-")[0] if version else None
            events.setdefault(ts, []).append((repository, ts, plain, sets.get(key, ()) if plain else ()))
            old = standing.get(repository)
            if old and old[1] != plain:
                lives.append((names[repository], old[0], ts))
            if plain is None:
                standing.pop(repository, None)
            elif not old or old[1] != plain:
                standing[repository] = (ts, plain)
        lives.extend((names[repository], since, None) for repository, (since, _) in standing.items())
        steps: dict[str, list[tuple[int, str | None]]] = {}
        home: dict[str, str] = {}
        here: dict[int, tuple[str, ...]] = {}
        holders: dict[str, dict[int, tuple[int, str]]] = {}
        for ts, at_once in sorted(events.items()):
            touched: set[str] = set()
            for repository, _, version, packages in at_once:
                for package in here.get(repository, ()):
                    holders[package].pop(repository, None)
                    touched.add(package)
                for package in packages:
                    holders.setdefault(package, {})[repository] = (ts, version or "")
                    touched.add(package)
                here[repository] = packages
            for package in touched:
                # Two repositories may name one package for a while; the later release is the one in force.
                held = holders[package]
                winner = min(held, key=lambda one: (-held[one][0], one)) if held else None
                version = held[winner][1] if winner is not None else None
                past = steps.setdefault(package, [])
                if (past[-1][1] if past else None) != version:
                    past.append((ts, version))
                if winner is not None:
                    home[package] = names[winner]
        return steps, home, lives

    def cut(self, day: str) -> int:
        """The moment (seconds since 1970) of the rosdistro commit that stands on a day."""
        place = bisect.bisect_right(self._sync_days, day)
        return self.syncs[place - 1][1] if place else compute_end_of_day(day)

    def versions(self, day: str) -> dict[str, str]:
        """Package to version, of all that is released on a day."""
        cut = self.cut(day)
        found = {}
        for package, (times, versions) in self._turns.items():
            version = versions[bisect.bisect_right(times, cut)]
            if version is not None:
                found[package] = version
        return found

    @functools.cached_property
    def _turns(self) -> dict[str, tuple[list[int], list[str | None]]]:
        """Of each package the moments at which its version changed, and its versions before, between and after them."""
        return {
            package: ([ts for ts, _ in steps], [None, *(version for _, version in steps)])
            for package, steps in self._steps.items()
        }

    def table(self, days: Sequence[str]) -> tuple[NDArray[np.int32], tuple[str, ...]]:
        """Which version each package (column, as in `packages`) has on each day (row): places in the second value."""
        cuts = np.array([self.cut(day) for day in days], dtype=np.int64)
        ids: dict[str, int] = {}
        found = np.full((len(days), len(self.packages)), ABSENT, dtype=np.int32)
        for column, package in enumerate(self.packages):
            steps = self._steps[package]
            times = np.array([ts for ts, _ in steps], dtype=np.int64)
            numbers = np.array(
                [ABSENT] + [ABSENT if v is None else ids.setdefault(v, len(ids)) for _, v in steps], dtype=np.int32
            )
            found[:, column] = numbers[np.searchsorted(times, cuts, side="right")]
        return found, tuple(ids)

    def sync_of(self, ts: int) -> str:
        """The first day on which a commit of this moment was available; empty when it has not been yet."""
        if not self.syncs or ts <= self._first_commit_by_sync():
            return format_day(ts)
        return next((day for day, cut in self.syncs if cut >= ts), "")

    def _first_commit_by_sync(self) -> int:
        """Commits up to the day before the first known sync were available on their own day, as far as is known."""
        return compute_end_of_day(self.syncs[0][0]) - 86400

    def first_available(self) -> dict[str, str]:
        """Package to the first day on which it was there."""
        found = {}
        for package, steps in self._steps.items():
            day = self.sync_of(steps[0][0])
            if day:
                found[package] = day
        return found

    def lives(self) -> list[Life]:
        """How long each version of each repository stood before another took its place, within the distro's life.

        By the commit's moment. Versions of before the announced release count from then; those that ended before are
        left out.
        """
        begin, end = compute_end_of_day(self.begin), compute_end_of_day(self.end)
        found = []
        for repository, since, until in self._lives:
            start, stop = max(since, begin), min(until or end, end)
            if stop > start:
                found.append(Life(repository, (stop - start) // 86400, until is not None and until <= end))
        return found

    # Who depends on whom

    @property
    def borrows(self) -> str:
        """The distro whose manifests stand in for this one's, empty when its own are known."""
        return _BORROWED.get(self.distro, "")

    @functools.cached_property
    def _manifests(self) -> dict[str, list[tuple[list[int], tuple[str, ...]]]]:
        here = Environment(self.distro, str(self.known.ros), (self.known.python, 0))

        @functools.cache
        def come_along(entries: str) -> tuple[str, ...]:
            return _names_that_come_along(entries, here)

        found: dict[str, list[tuple[list[int], tuple[str, ...]]]] = {}
        for package, version, entries in self._data.fetch(
            "SELECT p.name, m.version, s.entries FROM manifest m JOIN package p ON p.id = m.package"
            " JOIN distro d ON d.id = m.distro LEFT JOIN dependencies s ON s.id = m.dependencies WHERE d.name = ?",
            (self.borrows or self.distro,),
        ):
            found.setdefault(package, []).append((make_version_key(version), come_along(entries or "")))
        for rows in found.values():
            rows.sort(key=lambda row: row[0])
        return found

    def graph(self, day: str) -> Graph:
        """Who depends on whom on a day, by the manifests of the versions in force.

        Between two known manifests of a package the earlier one stands, before the first known one that one.
        """
        versions = self.versions(day)
        pairs = []
        for package, version in versions.items():
            rows = self._manifests.get(package)
            if rows:
                place = bisect.bisect_right(rows, make_version_key(version), key=lambda row: row[0])
                pairs.extend((package, name) for name in rows[max(place - 1, 0)][1])
        return Graph(sorted(versions), pairs)

    def graph_of_half_year(self, day: str) -> Graph:
        """The graph at the beginning of a day's half-year, or at the distro's release if that is later."""
        half = max(self.begin, f"{day[:4]}-{'01' if day[5:7] < '07' else '07'}-01")
        if half not in self._graphs:
            self._graphs[half] = self.graph(half)
        return self._graphs[half]

    # What changed

    def sync_changes(self) -> list[Sync]:
        """What each sync changed, added and removed, against the one before it. The first one has none to compare."""
        found = []
        for before, after in zip(self.syncs, self.syncs[1:], strict=False):
            old, new = self.versions(before[0]), self.versions(after[0])
            changed = {package for package, version in new.items() if package in old and old[package] != version}
            graph = self.graph_of_half_year(after[0])
            hubs = tuple(name for name in graph.hubs() if name in changed)
            found.append(
                Sync(
                    self.distro,
                    after[0],
                    len(new),
                    len(changed),
                    len(new.keys() - old.keys()),
                    len(old.keys() - new.keys()),
                    sum(kind_of_step(old[package], new[package]) == "major" for package in changed),
                    sum(kind_of_step(old[package], new[package]) == "minor" for package in changed),
                    graph.reached(changed),
                    hubs,
                )
            )
        return found

    def drift(self, horizon: int = 365, every: int = 14, reach_lags: Sequence[int] = (7, 30, 90, 180, 365)) -> Drift:
        """How two machines drift apart of which one stays as it was and one is upgraded.

        horizon: days to follow them, at most half of the distro's life so far. every: days between starting days. A
        package that was removed differs; one that was added meanwhile does not count, since the first machine cannot
        miss what it did not have. Every starting day is followed for the whole horizon.
        """
        begin, end = datetime.date.fromisoformat(self.begin), datetime.date.fromisoformat(self.end)
        horizon = min(horizon, (end - begin).days // 2)
        days = [(begin + datetime.timedelta(days=n)).isoformat() for n in range((end - begin).days + 1)]
        versions, _ = self.table(days)
        repositories = sorted({self.repository_of[package] for package in self.packages})
        place = {name: number for number, name in enumerate(repositories)}
        owner = np.array([place[self.repository_of[package]] for package in self.packages])
        lags = tuple(range(horizon + 1))
        asked = tuple(lag for lag in reach_lags if lag <= horizon)
        starts = range(0, len(days) - horizon, every)
        differing, differing_weighted = np.zeros((2, len(repositories), horizon + 1))
        released, released_weighted = np.zeros((2, len(repositories)))
        by_start, by_start_weighted = np.zeros((2, len(starts), horizon + 1))
        reached = np.zeros((len(starts), len(asked)))
        for row, start in enumerate(starts):
            there = np.flatnonzero(versions[start] != ABSENT)
            differs = (versions[start : start + horizon + 1, there] != versions[start, there]).T
            graph = self.graph_of_half_year(days[start])
            names = [self.packages[column] for column in there]
            weight = np.array([graph.dependents.get(name, 0) for name in names], dtype=float)
            owners = owner[there]
            _add_groups(differing, owners, differs)
            _add_groups(released, owners, np.ones(len(there)))
            _add_groups(differing_weighted, owners, differs * weight[:, None])
            _add_groups(released_weighted, owners, weight)
            by_start[row] = differs.mean(axis=0)
            by_start_weighted[row] = weight @ differs / max(weight.sum(), 1)
            known = {name: number for number, name in enumerate(graph.packages)}
            both = [(known[name], number) for number, name in enumerate(names) if name in known]
            rows, columns = (np.array(side, dtype=int) for side in zip(*both, strict=True))
            beneath = graph.beneath[np.ix_(rows, rows)].astype(np.float32)
            hit = beneath @ differs[np.ix_(columns, np.array(asked, dtype=int))].astype(np.float32)
            reached[row] = (hit > 0).mean(axis=0)
        return Drift(
            self.distro, lags, tuple(days[start] for start in starts), tuple(repositories), differing, released,
            differing_weighted, released_weighted, by_start, by_start_weighted, asked, reached,
        )  # fmt: skip


@functools.lru_cache(maxsize=32)
def history(distro: str) -> History:
    """The history of a distro in the data in use; read once."""
    return History(distro)


def distros(ros: int | None = None, long_term: bool = False) -> list[str]:
    """Distros of the data, oldest first, rolling left out. ros: of this generation. long_term: only those with
    long-term support."""
    return [
        one.name
        for one in list_known_distros()
        if one.status != "rolling" and ros in (None, one.ros) and (one.lts or not long_term)
    ]


def carried(names: Sequence[str]) -> NDArray[np.float64]:
    """Share of the packages of one distro (row), as it ended or stands now, that another (column) carries then."""
    sets = [set(history(name).versions(history(name).end)) for name in names]
    return np.array([[len(one & other) / len(one) for other in sets] for one in sets])


def left_behind(older: History, later: Iterable[History]) -> tuple[set[str], set[str]]:
    """Packages of a distro as it ended, and those of them that none of the later ones ever released by this name."""
    there = set(older.versions(older.end))
    seen: set[str] = set().union(*(one.packages for one in later))
    return there, there - seen


def lags(older: History, newer: History) -> list[Lag]:
    """When each package that the older distro carried at the newer one's release arrived in the newer one."""
    first = newer.first_available()
    found = []
    for package in sorted(older.versions(newer.begin)):
        day = first.get(package, "")
        arrived = bool(day) and day <= newer.end
        found.append(Lag(package, max(0, _days_between(newer.begin, day if arrived else newer.end)), arrived))
    return found


def behind(older: History, newer: History, day: str) -> list[Behind]:
    """Packages that both carry on a day and whose version is lower in the older one.

    The days count from the first on which the newer distro had a version above the one that the older still has, at the
    earliest from the newer one's announced release.
    """
    old, new = older.versions(day), newer.versions(day)
    found = []
    for package in sorted(old.keys() & new.keys()):
        if parse(new[package]) > parse(old[package]):
            since = next(
                ts
                for ts, version in newer._steps[package]
                if version is not None and parse(version) > parse(old[package])
            )
            start = max(newer.sync_of(since) or day, newer.begin)
            found.append(Behind(package, old[package], new[package], max(0, _days_between(start, day))))
    return found


def kind_of_step(old: str, new: str) -> str:
    """`major`, `minor` or `patch`: the first number of a version that moved; `back` when it went down."""
    left, right = parse(old), parse(new)
    if right <= left:
        return "back"
    for name, one, other in zip(("major", "minor"), left, right, strict=False):
        if one != other:
            return name
    return "patch"


def _add_groups(sums: NDArray[np.float64], groups: NDArray[np.int64], rows: NDArray[Any]) -> None:
    """Adds each row to the sum of its group. What np.add.at() does, many times faster."""
    order = np.argsort(groups, kind="stable")
    there, begins = np.unique(groups[order], return_index=True)
    if len(there):
        sums[there] += np.add.reduceat(rows[order], begins, axis=0, dtype=np.float64)


def _closure(below: list[set[int]]) -> NDArray[np.bool_]:
    """What is beneath each, however deep, itself included. Sets of places are kept as bits of one number each."""
    bits = [1 << place for place in range(len(below))]
    again = True
    while again:
        again = False
        for place, direct in enumerate(below):
            merged = bits[place]
            for other in direct:
                merged |= bits[other]
            if merged != bits[place]:
                bits[place] = merged
                again = True
    size = (len(below) + 7) // 8
    raw = np.frombuffer(b"".join(number.to_bytes(size, "little") for number in bits), dtype=np.uint8)
    return np.unpackbits(raw.reshape(len(below), size), axis=1, bitorder="little")[:, : len(below)].astype(bool)


def _names_that_come_along(entries: str, here: Environment) -> tuple[str, ...]:
    found = []
    for line in entries.splitlines():
        name, letters, condition = (*line.split("\t"), "", "")[:3]
        if _COMES_ALONG.intersection(letters) and (not condition or evaluate(condition, here)):
            found.append(name)
    return tuple(found)


def _days_between(first: str, last: str) -> int:
    return (datetime.date.fromisoformat(last) - datetime.date.fromisoformat(first)).days
