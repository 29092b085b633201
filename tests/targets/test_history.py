"""The life of a distro: the same answers as DistroTarget, closures and steps on small graphs made by hand."""

import datetime

import pytest
from rosimpact.impact.targets.distro import DistroTarget, TargetError
from rosimpact.impact.targets.history import Graph, History, kind_of_step, lags


@pytest.mark.parametrize(
    ("distro", "day"), [("humble", "2024-03-01"), ("noetic", "2020-06-01"), ("noetic", "2025-05-31")]
)
def test_versions_are_those_of_the_target(distro, day):
    target = DistroTarget(distro, day)
    assert History(distro).versions(day) == {name: target.version(name) for name in target.released_names()}


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
