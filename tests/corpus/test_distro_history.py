"""The life of a distro: the same answers as DistroTarget, closures and steps on small graphs made by hand."""

import datetime
import json
import sqlite3
import sys
from pathlib import Path

import pytest
from rosimpact.databuild.write import SCHEMA
from rosimpact.impact.targets.distro.distro import DistroTarget, TargetError
from rosimpact.impact.targets.snapshot import FACT_SCHEMA

sys.path.insert(0, str(Path(__file__).parents[2] / "notebooks"))
from distro_history import Behind, Graph, History, Life, Sync, behind, kind_of_step, lags


@pytest.mark.parametrize(
    ("distro", "day"), [("humble", "2024-03-01"), ("noetic", "2020-06-01"), ("noetic", "2025-05-31")]
)
def test_versions_are_those_of_the_target(distro, day):
    target = DistroTarget(distro, day)
    assert History(distro).versions(day) == {name: target.find_version(name) for name in target.list_released()}


def test_an_unknown_distro():
    with pytest.raises(TargetError, match="unknown distro `humbel`"):
        History("humbel")


def test_who_has_whom_beneath():
    graph = Graph(["app", "lib", "core", "alone"], [("app", "lib"), ("lib", "core"), ("core", "boost")])
    assert graph.dependents == {"app": 0, "lib": 1, "core": 2, "alone": 0}
    assert graph.reached(["core"]) == 3
    assert graph.reached(["app", "alone"]) == 2
    assert graph.reached([]) == 0
    assert graph.hubs(0.5) == ("core",)


def test_a_circle_has_all_of_itself_beneath():
    graph = Graph(["a", "b"], [("a", "b"), ("b", "a")])
    assert graph.dependents == {"a": 1, "b": 1}


@pytest.mark.parametrize(
    ("old", "new", "kind"),
    [
        ("1.2.3", "2.0.0", "major"),
        ("1.2.3", "1.3.0", "minor"),
        ("1.2.3", "1.2.4", "patch"),
        ("1.2", "1.2.1", "patch"),
        ("1.2.3", "1.2.2", "back"),
    ],
)
def test_kind_of_step(old, new, kind):
    assert kind_of_step(old, new) == kind


def test_nothing_arrives_after_the_end_and_all_is_followed():
    older, newer = History("dashing"), History("foxy")
    found = lags(older, newer)
    assert {lag.package for lag in found} == set(older.versions(newer.begin))
    first = newer.first_available()
    assert all((first.get(lag.package, "9999") <= newer.end) == lag.arrived and lag.days >= 0 for lag in found)


def test_drift_begins_at_nothing_and_counts_what_differs():
    one = History("eloquent")
    drift = one.drift(horizon=60, every=60)
    start = one.versions(drift.starts[0])
    assert drift.share()[0] == drift.share_weighted()[0] == 0
    day = (datetime.date.fromisoformat(drift.starts[0]) + datetime.timedelta(days=60)).isoformat()
    later = one.versions(day)
    differing = sum(later.get(name) != version for name, version in start.items())
    assert drift.by_start[0, 60] == pytest.approx(differing / len(start))


class Made:
    """Data made by hand, asked as the shipped snapshot is."""

    date = "2021-12-31"

    def __init__(self, distros, releases, syncs=(), dependencies=()):
        """distros: name to ISO day of its release. releases: (distro, day, repository, version or None, packages).
        syncs: (distro, day), each holding what was released the day before. dependencies: (distro, package, names)."""
        self._data = sqlite3.connect(":memory:")
        self._data.executescript(SCHEMA + FACT_SCHEMA)
        put = self._data.execute
        ids = {name: number for number, name in enumerate(distros, 1)}
        for name, released in distros.items():
            put("INSERT INTO distro VALUES (?, ?, 2, 3, 'active')", (ids[name], name))
            fact = {"released": released, "end_of_life": None, "lts": False, "platform": "ubuntu focal"}
            put("INSERT INTO distro_fact VALUES (?, ?)", (name, json.dumps(fact)))
        for number, (distro, day, repository, version, packages) in enumerate(releases, 1):
            put("INSERT OR IGNORE INTO repository(name) VALUES (?)", (repository,))
            ((home,),) = put("SELECT id FROM repository WHERE name = ?", (repository,)).fetchall()
            put("INSERT INTO packages VALUES (?, ?)", (number, packages))
            put("INSERT INTO release VALUES (?, ?, ?, ?, ?)", (ids[distro], home, noon(day), version, number))
        for distro, day in syncs:
            put("INSERT INTO sync VALUES (?, ?, ?)", (ids[distro], day, noon(day) - 43200))
        for number, (distro, package, names) in enumerate(dependencies, 1):
            put("INSERT INTO package VALUES (?, ?)", (number, package))
            put("INSERT INTO dependencies VALUES (?, ?)", (number, "\n".join(f"{name}\tb" for name in names)))
            put("INSERT INTO manifest VALUES (?, ?, '1.0.0', ?, 'ament_cmake')", (ids[distro], number, number))

    def fetch(self, sql, parameters=()):
        return self._data.execute(sql, parameters).fetchall()

    def query_row(self, sql, parameters=()):
        return next(iter(self.fetch(sql, parameters)), None)


def noon(day):
    return int(datetime.datetime.fromisoformat(f"{day}T12:00:00+00:00").timestamp())


def test_how_long_versions_live():
    data = Made(
        {"amber": "2021-01-01"},
        [
            ("amber", "2020-12-01", "core", "1.0.0-1", "core"),  # ends before the distro is announced: left out
            ("amber", "2020-12-10", "core", "1.1.0-1", "core"),  # counts from the announcement
            ("amber", "2021-01-11", "core", "1.1.0-2", "core"),  # built again: the same version
            ("amber", "2021-01-31", "core", "1.2.0-1", "core"),  # stands to the end of the data
            ("amber", "2021-03-01", "tool", "2.0.0-1", "tool"),
            ("amber", "2021-03-11", "tool", None, ""),  # taken out
        ],
    )
    assert sorted(History("amber", data).lives()) == [
        Life("core", 29, True),
        Life("core", 334, False),
        Life("tool", 10, True),
    ]


def test_what_each_sync_changes():
    packages = {"base": "1.0.0-1", "app": "1.0.0-1", "tool": "1.0.0-1", "lone": "1.0.0-1"}
    data = Made(
        {"amber": "2021-01-01"},
        [("amber", "2021-01-01", name, version, name) for name, version in packages.items()]
        + [
            ("amber", "2021-02-03", "base", "2.0.0-1", "base"),
            ("amber", "2021-02-03", "lone", None, ""),
            ("amber", "2021-02-04", "new", "0.1.0-1", "new"),
            ("amber", "2021-03-03", "tool", "1.1.0-1", "tool"),
            ("amber", "2021-03-04", "app", "1.0.0-2", "app"),  # built again: no change
        ],
        syncs=[("amber", day) for day in ("2021-02-01", "2021-03-01", "2021-04-01")],
        dependencies=[("amber", "app", ["base"]), ("amber", "tool", ["app"])],
    )
    assert History("amber", data).sync_changes() == [
        # base changed, and app and tool have it beneath them; lone went and new came
        Sync("amber", "2021-03-01", 4, 1, 1, 1, 1, 0, 3, ("base",)),
        Sync("amber", "2021-04-01", 4, 1, 0, 0, 0, 1, 1, ()),
    ]


def test_what_is_behind_and_since_when():
    data = Made(
        {"amber": "2021-01-01", "beryl": "2021-06-01"},
        [
            ("amber", "2021-01-01", "same", "1.0.0-1", "same"),
            ("amber", "2021-01-01", "early", "1.0.0-1", "early"),
            ("amber", "2021-01-01", "late", "1.0.0-1", "late"),
            ("amber", "2021-01-01", "ahead", "3.0.0-1", "ahead"),
            ("amber", "2021-01-01", "gone", "1.0.0-1", "gone"),
            ("beryl", "2021-05-01", "same", "1.0.0-7", "same"),
            ("beryl", "2021-05-01", "early", "2.0.0-1", "early"),  # before the announcement: counts from then
            ("beryl", "2021-05-01", "late", "1.0.0-1", "late"),
            ("beryl", "2021-07-01", "late", "1.0.1-1", "late"),
            ("beryl", "2021-08-01", "late", "1.10.0-1", "late"),
            ("beryl", "2021-05-01", "ahead", "2.9.0-1", "ahead"),
        ],
    )
    older, newer = History("amber", data), History("beryl", data)
    assert behind(older, newer, "2021-09-01") == [
        Behind("early", "1.0.0", "2.0.0", 92),
        Behind("late", "1.0.0", "1.10.0", 62),
    ]
    assert [item.package for item in behind(older, newer, "2021-06-15")] == ["early"]
