"""A distro as of a day: released packages, declared dependencies, rosdep keys and platform libraries.

Availability follows syncs: a package counts from the day on which a sync brought it to apt, in the version that the
synced commit of rosdistro had. Before a distro's first known sync (tags exist from 2020-08 on) the commit's date stands
and the target is approximate.
"""

from __future__ import annotations

import datetime
import functools
import re
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from operator import itemgetter
from typing import Any, NamedTuple

from ....edges.console import UserError
from ....edges.groups import group_pairs
from ....edges.memory import cache_method
from ....edges.reach import walk
from ...conditions import Environment
from ...conditions.manifest import evaluate
from .. import snapshot as snapshots
from ..platform import find_neighbours, normalize_library_name, normalize_platform, parse_python_minor
from ..snapshot import KINDS, Snapshot
from ..tables import compute_data_stamp
from ..target import ReleasedDependency, Resolution
from ..version import parse_number
from .conda import CHANNELS, SID, find_libraries
from .known import (
    _strip_packaging,
    compute_end_of_day,
    find_distro,
    format_day,
    list_known_distros,
    list_public_rules,
    list_rosdep_systems,
    suggest_name,
)
from .rosdep import decode_rule, iterate_texts, resolve_rule, split_platform


class TargetError(UserError):
    """A target that cannot be made; the message says what is known instead."""


class Library(NamedTuple):
    """A platform library's version and the id of the source that states it."""

    version: str
    source: str


class _Recipe(NamedTuple):
    """What a target was asked for with."""

    distro: str
    date: str | None
    platform: str | None
    versions: dict[str, str]
    name: str | None


class _Released(NamedTuple):
    version: str
    repository: int
    ts: int


_WITH_KINDS = ("build_export", "buildtool_export", "exec")


def make_version_key(version: str) -> list[int]:
    """Numbers of a version, for ordering: `2.10.1-1` → [2, 10, 1, 1]."""
    return [parse_number(part) for part in re.findall(r"\d+", version)]


# Letters of KINDS for what is installed along with a package.
_COMES_ALONG = frozenset("eox")


@functools.lru_cache(maxsize=16)
def _read_released(data: Snapshot, distro: int, cut: int) -> Mapping[str, _Released]:
    """The packages that a distro has at a time, by name. Targets of one process that ask for the same share it. Raises
    SnapshotError."""
    found: dict[str, _Released] = {}
    for repository, ts, version, names in data.fetch(
        "SELECT r.repository, max(r.ts), r.version, p.names FROM release r"
        " LEFT JOIN packages p ON p.id = r.packages WHERE r.distro = ? AND r.ts <= ? GROUP BY r.repository",
        (distro, cut),
    ):
        if version is None:
            continue
        for name in names.split(" "):
            old = found.get(name)
            # Two repositories may name one package for a while; the later release is the one in force.
            if old is None or old.ts < ts:
                found[name] = _Released(version, repository, ts)
    return found


@functools.lru_cache(maxsize=20_000)
def _read_entries(entries: str) -> tuple[tuple[str, ReleasedDependency], ...]:
    """What a stored manifest declares, each with its condition; few of them differ between distros."""
    found = []
    for line in entries.splitlines():
        name, letters, condition, bounds = (*line.split("\t"), "", "")[:4]
        pairs = tuple((bound, value) for bound, _, value in (item.partition("=") for item in bounds.split()))
        found.extend((condition, ReleasedDependency(name, KINDS[letter], pairs)) for letter in letters)
    return tuple(found)


class DistroTarget:
    """A target: what another developer or a robot has. A distro at a date, with overrides.

    distro: its name. date: ISO day, None for the newest day of the data. platform: `ubuntu jammy`, None for the
    distro's main one at that date. versions: versions that differ on this machine, by ROS package or platform library;
    an empty text means "not installed". name: what to call the target, by default as it was asked for. rules: rosdep
    rules of one's own by key, as in a rosdep file; they go over the public ones.

    Raises TargetError for an unknown distro or a malformed date. Further attributes: ros (1 or 2), python_major (2 or
    3), data_date (newest day of the data), notes (what was adjusted, such as a date moved to the first release),
    approximate (True before the first sync tag), moving (its distro is built for another platform by now and has had no
    sync there), end_of_life (ISO day, empty when none is set), lts.
    """

    def __init__(
        self,
        distro: str,
        date: str | None = None,
        platform: str | None = None,
        versions: Mapping[str, str] | None = None,
        name: str | None = None,
        data: Snapshot | None = None,
        rules: Mapping[str, Any] | None = None,
    ):
        self._data = data or snapshots.load_snapshot()
        self._neighbours: dict[str, DistroTarget] = {}
        self._asked = _Recipe(distro, date, platform, dict(versions or {}), name)
        self._rules = dict(rules or {})
        known = find_distro(distro, self._data)
        if known is None:
            raise TargetError(_describe_unknown_distro(distro, self._data))
        self._id, self.ros, self.python_major = known.number, known.ros, known.python
        self.distro = distro
        self.data_date = self._data.date
        self._overrides = {key: str(value) for key, value in (versions or {}).items()}
        self._own_libraries = {normalize_library_name(key): value for key, value in self._overrides.items()}
        self._facts, self.end_of_life, self.lts = known.facts, known.end_of_life, known.lts
        notes: list[str] = []
        self.date = self._move_date(date, notes)
        self._cut, self.approximate = self._find_commit_time()
        self._rule_ts = compute_end_of_day(self.date)
        self.moving = False
        self.platform = self._choose_platform(platform, notes)
        self._notes = tuple(notes)
        self.name = name or (distro if date is None else f"{distro}@{date}")

    @cached_property
    def notes(self) -> tuple[str, ...]:
        """What was adjusted, and that no versions of libraries are known on the platform."""
        if self.knows_libraries:
            return self._notes
        given = " besides those given for the target" if self._own_libraries else ""
        platform = self.platform or "its platform"
        return (*self._notes, f"no library versions of {platform} are known{given}: what they lack is not reported")

    def __reduce__(self):
        # A target travels to worker processes as its recipe; each opens the shared cache file itself.
        taken = {"_cut": self._cut, "platform": self.platform, "_notes": self._notes}
        return DistroTarget, (*self._asked, None, self._rules), taken

    def compute_identity(self) -> str:
        """Differs whenever the target, or the data that answers for it, does."""
        known = (self.name, self.distro, self.date, self._cut, self.platform, self._overrides, self._rules)
        return repr((tuple(self._asked), *known, compute_data_stamp()))

    def copy_with_changes(
        self,
        date: str | None = None,
        platform: str | None = None,
        versions: Mapping[str, str] | None = None,
        name: str | None = None,
    ) -> DistroTarget:
        """This target with another date, platform or name, and further versions on top of its own."""
        own = self._asked
        mixed = {**own.versions, **(versions or {})}
        recipe = _Recipe(own.distro, date or own.date, platform or own.platform, mixed, name or own.name)
        return DistroTarget(*recipe, self._data, self._rules)

    def add_surroundings(self, versions: Mapping[str, str], rules: Mapping[str, Any]) -> DistroTarget:
        """This target with packages and rosdep rules that its machine has besides the public ones. A version that the
        target itself gives for a package stays."""
        recipe = self._asked._replace(versions={**versions, **self._asked.versions})
        return DistroTarget(*recipe, self._data, {**rules, **self._rules})

    def _move_date(self, date: str | None, notes: list[str]) -> str:
        if date is None:
            return self.data_date
        try:
            day = datetime.date.fromisoformat(str(date)).isoformat()
        except ValueError:
            raise TargetError(f"`{str(date)[:40]}` is no date: write it as in `{self.distro}@2024-03-01`") from None
        first = self._data.query_row("SELECT min(ts) FROM release WHERE distro = ?", (self._id,))
        if first and first[0] is not None and day < format_day(first[0]):
            moved = format_day(first[0])
            notes.append(f"{self.distro} had no release on {day}: moved to its first, {moved}")
            return moved
        if day > self.data_date:
            notes.append(f"the distro data ends on {self.data_date}: {day} is answered as of then")
        return day

    def _find_commit_time(self) -> tuple[int, bool]:
        """The rosdistro commit time that stands on this day, and whether that is approximate."""
        sync = self._data.query_row(
            "SELECT cut FROM sync WHERE distro = ? AND day <= ? ORDER BY day DESC LIMIT 1", (self._id, self.date)
        )
        return (sync[0], False) if sync else (compute_end_of_day(self.date), True)

    def _choose_platform(self, platform: str | None, notes: list[str]) -> str:
        """The platform asked for, else the main one that the synced packages were built for."""
        if platform:
            return normalize_platform(platform)
        built_for, now = self._find_main_platform(self._cut), self._find_main_platform(compute_end_of_day(self.date))
        self.moving = built_for != now
        if self.moving:
            notes.append(
                f"{self.distro} had moved to {now}, not yet synced there: answered as of its last on {built_for}"
            )
        return built_for

    def _find_main_platform(self, ts: int) -> str:
        row = self._data.query_row(
            "SELECT names FROM platforms WHERE distro = ? AND ts <= ? ORDER BY ts DESC LIMIT 1", (self._id, ts)
        ) or self._data.query_row("SELECT names FROM platforms WHERE distro = ? ORDER BY ts LIMIT 1", (self._id,))
        supported = row[0].split(",") if row and row[0] else []
        if self._facts and (self._facts.platform in supported or not supported):
            return self._facts.platform
        return supported[0] if supported else ""

    @cache_method
    def _load_packages(self) -> Mapping[str, _Released]:
        return _read_released(self._data, self._id, self._cut)

    @cache_method
    def find_version(self, package: str) -> str | None:
        """Version of a released ROS package on this target (`2.0.1`), None when it is not there."""
        if package in self._overrides and self._is_package(package):
            return self._overrides[package] or None
        released = self._load_packages().get(package)
        return _strip_packaging(released.version) if released else None

    def assumes_built(self, package: str) -> bool:
        """Whether a package counts as installable here since the distro names it, which says nothing of whether the
        build farm has built it for the platform: its version is none that was given for this target."""
        return package not in self._overrides and package in self._load_packages()

    @cache_method
    def list_released(self) -> frozenset[str]:
        """All packages released here, overrides included."""
        names = set(self._load_packages())
        for name, version in self._overrides.items():
            if self._is_package(name):
                names.add(name) if version else names.discard(name)
        return frozenset(names)

    def _is_package(self, name: str) -> bool:
        """Whether an override means a ROS package: one released ever, or a name of no platform library."""
        return self.was_ever_released(name) or normalize_library_name(name) not in self._data.list_values("library")

    def was_ever_released(self, package: str) -> bool:
        """True when any distro at any date has released a package of this name."""
        return package in self._data.list_values("package")

    def list_releases(self, package: str) -> tuple[tuple[str, str | None], ...]:
        """(day, version) of every release of a package in this distro, oldest first; version None: dropped."""
        return tuple((format_day(ts), version) for ts, version in self._list_steps(package))

    @cache_method
    def list_arrivals(self, package: str) -> tuple[tuple[str, str | None], ...]:
        """The same with the days on which the versions could be had: those of the sync that brought each, and before
        the distro's first known sync of the commit. What no sync has brought yet is left out; of versions that one
        sync brought, the last counts."""
        syncs = self._data.fetch("SELECT day, cut FROM sync WHERE distro = ? ORDER BY day", (self._id,))
        # Commits up to the day before the first known sync were available on their own day, as far as is known.
        early = compute_end_of_day(syncs[0][0]) - 86400 if syncs else None
        days: dict[str, str | None] = {}
        for ts, version in self._list_steps(package):
            if early is None or ts <= early:
                days[format_day(ts)] = version
            elif day := next((day for day, cut in syncs if cut >= ts), ""):
                days[day] = version
        return tuple(days.items())

    def _list_steps(self, package: str) -> list[tuple[int, str | None]]:
        """(moment, version) of every release of a package in this distro."""
        events = []
        homes = self._data.fetch(
            "SELECT h.repository FROM home h JOIN package p ON p.id = h.package WHERE p.name = ? AND h.distro = ?",
            (package, self._id),
        )
        for (repository,) in homes:
            held = False
            for ts, version, names in self._data.fetch(
                "SELECT r.ts, r.version, p.names FROM release r LEFT JOIN packages p ON p.id = r.packages"
                " WHERE r.distro = ? AND r.repository = ? ORDER BY r.ts",
                (self._id, repository),
            ):
                here = version is not None and package in names.split(" ")
                if here or held:
                    events.append((ts, not here, _strip_packaging(version) if version and here else None))
                held = here
        events.sort(key=lambda event: event[:2])
        steps: list[tuple[int, str | None]] = []
        last: tuple[int, str | None] | None = None
        for ts, _, version in events:
            # A move between repositories in one commit is no drop: its arrival sorts first.
            if version is None and last and last[0] == ts and last[1] is not None:
                continue
            if last is None or last[1] != version:
                steps.append((ts, version))
            last = (ts, version)
        return steps

    def find_first_day(self, package: str) -> str:
        """ISO day of the package's first release in this distro, empty when it never was; the commit's day."""
        steps = self.list_releases(package)
        return steps[0][0] if steps else ""

    def find_repository(self, package: str) -> tuple[str, str, str] | None:
        released = self._load_packages().get(package)
        if released is None:
            return None
        row = self._data.query_row(
            "SELECT n.name, u.text, s.branch FROM repository n"
            " LEFT JOIN source s ON s.repository = n.id AND s.distro = ? AND s.ts <= ?"
            " LEFT JOIN url u ON u.id = s.url WHERE n.id = ? ORDER BY s.ts DESC LIMIT 1",
            (self._id, max(self._cut, released.ts), released.repository),
        )
        return (row[0], row[1] or "", row[2] or "") if row else None

    @cached_property
    def knows_manifests(self) -> bool:
        row = self._data.query_row("SELECT 1 FROM manifest WHERE distro = ? LIMIT 1", (self._id,))
        return row is not None

    @cache_method
    def list_dependencies(self, package: str) -> tuple[ReleasedDependency, ...] | None:
        """What the released package declares, None when no manifest of it is known in this distro.

        Where this very version's manifest is not known, the nearest earlier one stands, else the nearest later one.
        """
        manifest = self._find_manifest(package)
        if manifest is None:
            return None
        return tuple(found for condition, found in _read_entries(manifest[0]) if not condition or self.holds(condition))

    def _list_manifests(self, package: str) -> list[tuple[list[int], str, str]]:
        """What is known of the manifests of a package in this distro, by their versions, oldest first: dependencies as
        they are stored, and the build type."""
        rows = self._data.fetch(
            "SELECT m.version, d.entries, m.build_type FROM manifest m JOIN package p ON p.id = m.package"
            " LEFT JOIN dependencies d ON d.id = m.dependencies WHERE p.name = ? AND m.distro = ?",
            (package, self._id),
        )
        keyed = [(make_version_key(known), entries or "", build or "") for known, entries, build in rows]
        return sorted(keyed, key=itemgetter(0))

    def _find_manifest(self, package: str) -> tuple[str, str] | None:
        version = self.find_version(package)
        known = self._list_manifests(package) if version is not None else []
        if version is None or not known:
            return None
        wanted = make_version_key(version)
        _, entries, build = next((row for row in reversed(known) if row[0] <= wanted), known[0])
        return entries, build

    def list_later_dependencies(self, package: str) -> frozenset[str]:
        """Names that come along with the next later version whose manifest is known here, where this very version's is
        not known: what dependencies() may lack."""
        version = self.find_version(package)
        wanted = make_version_key(version or "")
        known = [(of, entries) for of, entries, _ in self._list_manifests(package) if of >= wanted] if version else []
        return _parse_companions(known[0][1]) if known and known[0][0] != wanted else frozenset()

    def build_type(self, package: str) -> str:
        """`ament_cmake`, `ament_python`, `catkin`, `cmake` ...; empty when not known or not said."""
        manifest = self._find_manifest(package)
        return manifest[1] if manifest else ""

    def find_newest(self) -> DistroTarget | None:
        """The newest long-term distro of this generation, None when this distro is it or newer."""
        return _find_newest(self.distro, self.date if self.distro == "rolling" else "", self._data)

    def find_testing(self) -> DistroTarget | None:
        """The same distro with what has been released on its day and waits for the next sync, which its build farm
        builds against already; None when nothing waits, or syncs are not known."""
        if self.approximate or self._cut >= compute_end_of_day(self.date):
            return None
        found = self.copy_with_changes()
        found._cut = compute_end_of_day(self.date)
        return found

    def follow_release(self, versions: Iterable[tuple[str, str]]) -> DistroTarget:
        """This target, or, where a workspace is a release that waits for the next sync, what its build farm builds that
        release against. A target with versions of its own is a machine, and stays.

        versions: the packages of the workspace, each with its version.
        """
        testing = self.find_testing() if not self._overrides else None
        if testing is None:
            return self
        released = [(name, version) for name, version in versions if testing.find_version(name) == version]
        if not released or any(self.find_version(name) == version for name, version in released):
            return self
        name, version = released[0]
        note = f"{name} {version} waits for the next sync of {self.distro}: answered as of what is released, not synced"
        testing.platform = normalize_platform(self._asked.platform or self._find_main_platform(testing._cut))
        testing._notes = (note,)
        return testing

    def find_updated(self) -> DistroTarget | None:
        """The same distro as of the data's newest day, None when this is it."""
        if self.date >= self.data_date and not self._overrides:
            return None
        return DistroTarget(self.distro, data=self._data)

    def list_similar(self, package: str) -> tuple[ReleasedDependency, ...] | None:
        """What the package declares in the nearest distro of the same generation whose manifest of it is known.

        For distros whose own manifests are not: what rests on it is likely, not sure.
        """
        for neighbour in self._iterate_near_distros(package):
            if neighbour.knows_manifests and (found := neighbour.list_dependencies(package)) is not None:
                return found
        return None

    def list_possible(self, package: str) -> frozenset[str]:
        """Names that come along with a package in some version of some distro of this generation.

        Conditions count as held: this is what the package may bring where its own manifest is not known.
        """
        rows = self._data.fetch(
            "SELECT DISTINCT d.entries FROM manifest m JOIN package p ON p.id = m.package JOIN distro o ON"
            " o.id = m.distro JOIN dependencies d ON d.id = m.dependencies WHERE p.name = ? AND o.ros = ?",
            (package, self.ros),
        )
        return frozenset().union(*(_parse_companions(entries) for (entries,) in rows))

    def list_build_types(self, package: str) -> frozenset[str]:
        """Every build type that a package is known to have had in a distro of this generation."""
        rows = self._data.fetch(
            "SELECT DISTINCT m.build_type FROM manifest m JOIN package p ON p.id = m.package JOIN distro o ON"
            " o.id = m.distro WHERE p.name = ? AND o.ros = ?",
            (package, self.ros),
        )
        return frozenset(build or "" for (build,) in rows)

    def is_other_generation(self, package: str) -> bool:
        """True when distros have released a package of this name, and all of them are of the other ROS."""
        return self.was_ever_released(package) and not self._list_distros_with(package)

    def find_similar_build_type(self, package: str) -> str:
        """The build type of the package in the nearest distro of the same generation that says it; likely, not sure."""
        near = self._iterate_near_distros(package)
        return next((found for one in near if one.knows_manifests and (found := one.build_type(package))), "")

    def _iterate_near_distros(self, package: str) -> Iterator[DistroTarget]:
        """Other distros of this generation that have released a package, the nearest first."""
        homes = self._list_distros_with(package)
        for name in self._nearest if homes else ():
            if name in homes:
                if name not in self._neighbours:
                    self._neighbours[name] = DistroTarget(name, data=self._data)
                yield self._neighbours[name]

    @cached_property
    def _nearest(self) -> list[str]:
        """The other distros of this generation, the nearest first."""
        names = [known.name for known in list_known_distros(self._data) if known.ros == self.ros]
        here = names.index(self.distro) if self.distro in names else 0
        near = sorted(names, key=lambda name: (abs(names.index(name) - here), -names.index(name)))
        return [name for name in near if name != self.distro]

    @cache_method
    def _list_distros_with(self, package: str) -> frozenset[str]:
        """Distros of this generation that have ever released a package."""
        if not self.was_ever_released(package):
            return frozenset()
        rows = self._data.fetch(
            "SELECT d.name FROM home h JOIN package p ON p.id = h.package JOIN distro d ON d.id = h.distro"
            " WHERE p.name = ? AND d.ros = ?",
            (package, self.ros),
        )
        return frozenset(name for (name,) in rows)

    @cache_method
    def list_repositories(self, package: str) -> frozenset[str]:
        """Names of the repositories that have released a package in some distro."""
        rows = self._data.fetch(
            "SELECT DISTINCT n.name FROM home h JOIN package p ON p.id = h.package"
            " JOIN repository n ON n.id = h.repository WHERE p.name = ?",
            (package,),
        )
        return frozenset(name for (name,) in rows)

    @cache_method
    def list_repository_urls(self, package: str) -> frozenset[str]:
        """Where the source of the repositories is that have released a package in some distro."""
        rows = self._data.fetch(
            "SELECT DISTINCT u.text FROM home h JOIN package p ON p.id = h.package"
            " JOIN source s ON s.repository = h.repository JOIN url u ON u.id = s.url WHERE p.name = ?",
            (package,),
        )
        return frozenset(url for (url,) in rows)

    @cache_method
    def holds(self, condition: str) -> bool:
        """Whether a manifest condition such as `$ROS_VERSION == 2` holds here. One that cannot be read holds not."""
        here = Environment(self.distro, str(self.ros), (self.python_major, 0))
        return bool(condition) and evaluate(condition, here) is True

    def list_transitive(self, package: str, kinds: Iterable[str] = _WITH_KINDS) -> frozenset[str]:
        """Names that come along with a released package: its dependencies of these kinds, and theirs of these kinds.

        The package itself is not in it. Names that are no released package (rosdep keys) are, and end there.
        """
        wanted = frozenset(kinds)

        def list_wanted(name: str) -> Iterable[str]:
            return (dependency.name for dependency in self.list_dependencies(name) or () if dependency.kind in wanted)

        return frozenset(walk([package], list_wanted)) - {package}

    # rosdep keys

    @cache_method
    def resolve(self, key: str) -> Resolution | None:
        """The rosdep rule for a key on this platform, None when there is none."""
        os_name, release = split_platform(self.platform)
        own = self._rules.get(key, {})
        for system in (os_name, "*"):
            if system in own:
                return resolve_rule(own[system], os_name, release)
        found = (resolve_rule(decode_rule(rules.get(key)), os_name, release) for rules in self._public_rules)
        return next(filter(None, found), None)

    @cached_property
    def _public_rules(self) -> list[dict[str, str]]:
        """The public rules for the platform's system by key, as they are stored: those of the target's day, then those
        of the day on which its distro ended. rosdistro drops the rules of old releases; machines of an ended distro
        were set up when they stood."""
        moments = [self._rule_ts]
        if self.end_of_life and self.end_of_life < self.date:
            moments.append(compute_end_of_day(self.end_of_life))
        return [list_public_rules(self._data, split_platform(self.platform)[0], ts) for ts in moments]

    def has_ended(self) -> bool:
        """Whether the distro was no longer maintained on the target's day."""
        return bool(self.end_of_life) and self.end_of_life <= self.date[:10]

    def knows_key(self, key: str) -> bool:
        """True when rosdep has, or had, a key of this name for any platform."""
        return key in self._rules or key in self._data.list_values("rule", "key")

    def has_rosdep_rules(self) -> bool:
        """True when rosdep knows the platform's operating system, so that a key without a rule cannot be installed."""
        return split_platform(self.platform)[0] in list_rosdep_systems(self._data) or bool(self._rules)

    def find_replacement_keys(self, key: str) -> tuple[str, ...]:
        """rosdep keys that install here what a key installs on other releases, best first."""
        asked = "SELECT rule FROM rule WHERE key = ? AND os IN ('debian', 'ubuntu') ORDER BY ts DESC"
        rules = [decode_rule(rule) for (rule,) in self._data.fetch(asked, (key,))]
        packages = dict.fromkeys(name for rule in rules for name in iterate_texts(rule))
        # Modules of Python 3 are packaged under another name.
        names = [n for name in packages for n in (name, re.sub(r"^python-", "python3-", name))]
        found = dict.fromkeys(k for name in names for k in self.find_keys(name) if k != key)
        # A number tells a release, which the archive may have no longer.
        numbers = set(re.findall(r"\d+", key))
        return tuple(k for k in found if numbers.issuperset(re.findall(r"\d+", k.removeprefix("python3"))))

    def list_keys(self) -> frozenset[str]:
        """Every rosdep key that any platform has, or had."""
        return self._data.list_values("rule", "key") | self._rules.keys()

    def find_last_distro(self, package: str) -> str:
        """The newest distro of the same generation that has released a package, empty when none has."""
        names = sorted(self._list_distros_with(package))
        order = {known.name: place for place, known in enumerate(list_known_distros(self._data))}
        return max(names, key=lambda name: order.get(name, -1), default="")

    def find_keys(self, debian_package: str) -> tuple[str, ...]:
        """rosdep keys that install this system package on the platform, sorted; shortest names first."""
        return self._by_debian.get(debian_package, ())

    @cached_property
    def _by_debian(self) -> dict[str, tuple[str, ...]]:
        found: dict[str, list[str]] = {}
        for key, resolution in self._resolve_keys().items():
            if resolution.manager in ("apt", "dnf", "yum"):
                for name in resolution.packages:
                    found.setdefault(name, []).append(key)
        return {name: tuple(sorted(keys, key=lambda k: (len(k), k))) for name, keys in found.items()}

    @cached_property
    def python_keys(self) -> dict[str, tuple[str, ...]]:
        """Rosdep keys that install a Python package here, by pip or as the platform's own, by the name that PyPI or
        Debian has for it, in lower case with `-`."""
        from packaging.utils import canonicalize_name  # few checks read requirements

        installed = ((name, key) for key, resolution in self._resolve_keys().items() for name in resolution.packages)
        plain = ((canonicalize_name(re.split(r"[=<>!~\[ ]", name)[0]), key) for name, key in installed)
        found = group_pairs((name.removeprefix("python3-"), key) for name, key in plain)
        return {name: tuple(sorted(keys)) for name, keys in found.items()}

    @cache_method
    def _resolve_keys(self) -> dict[str, Resolution]:
        """Every key that resolves here with its resolution."""
        keys = dict.fromkeys((*self._rules, *(key for rules in self._public_rules for key in rules)))
        return {key: found for key in keys if (found := self.resolve(key)) is not None}

    @cache_method
    def _load_libraries(self) -> dict[str, Library]:
        if self.platform in CHANNELS:
            pinned = find_libraries(self.platform, self.distro, self.date)
            return {name: Library(version, f"pins of {channel}") for name, (version, channel) in pinned.items()}
        if self.platform == SID:
            daily = find_libraries(self.platform, self.distro, self.date)
            return {name: Library(version, "changelogs of Debian") for name, (version, _) in daily.items()}
        return {
            name: Library(version, source)
            for name, version, source in self._data.fetch(
                "SELECT name, version, source FROM library WHERE platform = ?", (self.platform,)
            )
        }

    @property
    def python(self) -> int:
        """Minor version of the Python 3 that ROS code runs on; 0 on Python 2 (python_major 2) and where not known."""
        if self.python_major == 2:
            return 0
        return parse_python_minor(self.find_library("python")) or 0

    def find_library(self, name: str) -> str | None:
        """Version of a platform library by the name of platform_versions.yaml (opencv, boost, gcc, python3 ...)."""
        return next(self._iterate_library(name), None)

    def list_library_versions(self, name: str) -> list[str]:
        """All versions of a platform library that a machine has: a released package may bring another one beside the
        platform's, which CMake finds first."""
        return list(dict.fromkeys(self._iterate_library(name)))

    def _iterate_library(self, name: str) -> Iterator[str]:
        wanted = normalize_library_name(name)
        if wanted in self._own_libraries:
            if self._own_libraries[wanted]:
                yield self._own_libraries[wanted]
            return
        if self.platform not in (*CHANNELS, SID) and self._facts:
            instead = self._facts.libraries_from.get(wanted)
            if instead and (version := self.find_version(instead)):
                yield version
            if wanted in self._facts.libraries:
                yield self._facts.libraries[wanted]
                return
        if (cell := self._load_libraries().get(wanted)) is not None and cell.version:
            yield cell.version

    def find_oldest_library(self, name: str) -> str | None:
        """The oldest version that a platform library of unknown version may have here: that of the platform which was
        frozen last before this one."""
        known = dict(self._data.fetch("SELECT platform, version FROM library WHERE name = ?", (name,)))
        return known.get(find_neighbours(self.platform, known)[0])

    def was_added_with_release(self, name: str) -> bool:
        """True for platform libraries that everybody has in this version since the distro's release: it stays on one
        platform, this one, and nothing else brings the library."""
        wanted = normalize_library_name(name)
        if self._facts is None or self.distro == "rolling" or self.platform != self._facts.platform:
            return False
        return wanted not in self._own_libraries and wanted not in self._facts.libraries_from

    def is_overridden(self, package: str) -> bool:
        """True for ROS packages whose version was given for this machine, and is not the distro's."""
        return package in self._overrides

    @property
    def knows_libraries(self) -> bool:
        """Whether versions of libraries are known on the platform, besides those that are given for the target."""
        return bool(self._load_libraries())

    def list_library_names(self) -> frozenset[str]:
        """Platform libraries whose version is known here."""
        own = {name for name, value in self._own_libraries.items() if value} & self._data.list_values("library")
        return frozenset(self._load_libraries()) | own | (self._facts.libraries.keys() if self._facts else frozenset())


def _parse_companions(entries: str) -> frozenset[str]:
    """The names among the stored entries of a manifest that are installed along with it, conditions aside."""
    fields = (line.split("\t") for line in entries.splitlines())
    return frozenset(name for name, letters, *_ in fields if not _COMES_ALONG.isdisjoint(letters))


@functools.cache
def _find_newest(distro: str, day: str, data: Snapshot) -> DistroTarget | None:
    here = find_distro(distro, data)
    if here is None:
        return None
    lasting = [k for k in list_known_distros(data) if k.ros == here.ros and k.lts]
    last = lasting[-1] if lasting else None
    return DistroTarget(last.name, data=data) if last and last.released > (day or here.released) else None


def _describe_unknown_distro(name: str, data: Snapshot) -> str:
    names = [known.name for known in list_known_distros(data)]
    return f"unknown distro `{name}`{suggest_name(name, names, '; ') or '.'} Known: {', '.join(names)}"
