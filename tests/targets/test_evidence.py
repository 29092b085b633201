"""What a finding about a changed name rests on: bounds of the reviewed tables, stored versions, days of the distros."""

import pytest
from rosimpact.impact.targets import evidence as module
from rosimpact.impact.targets.changes import iterate_in_force
from rosimpact.impact.targets.distro.distro import DistroTarget
from rosimpact.impact.targets.distro.known import list_releases
from rosimpact.impact.targets.evidence import (
    add_surfaces,
    add_target_states,
    find_release_before,
    make_evidence,
    make_offer_evidence,
)
from rosimpact.impact.targets.evidence_record import Evidence
from rosimpact.impact.targets.providers.providers import load_providers
from rosimpact.impact.targets.surface.changes import ChangeEvent, ComparedThing, Line
from rosimpact.impact.targets.surface.offers import Offered
from rosimpact.impact.targets.version import is_at_least


def change(target, kind, package, old):
    known = iterate_in_force(target)
    return next(one for one in known if (one[0].kind, one[0].package, one[0].old) == (kind, package, old))


def seen(evidence, *targets, spoken_of):
    found = add_target_states(evidence, targets, spoken_of, load_providers())
    assert found is not None
    return found, [(one.target, one.holds, one.since) for one in found.targets]


def test_a_name_of_the_table_tells_between_which_versions_it_went_and_since_when_on_each_target():
    humble, jazzy = DistroTarget("humble"), DistroTarget("jazzy")
    found, on = seen(
        make_evidence(*change(jazzy, "api-removed", "rclcpp", "RCLCPP_SCOPE_EXIT")), humble, jazzy, spoken_of=["jazzy"]
    )
    assert (found.change, found.package, found.name, found.instead) == (
        "removed", "rclcpp", "RCLCPP_SCOPE_EXIT", "RCPPUTILS_SCOPE_EXIT")  # fmt: skip
    assert not is_at_least(found.last, found.first) and found.source
    assert on == [("humble", False, ""), ("jazzy", True, "2024-05-23")]


def test_a_day_before_the_change_says_when_it_comes():
    """message_filters/subscriber.hpp came to jazzy within its life."""
    early, late = DistroTarget("jazzy", "2024-08-01"), DistroTarget("jazzy")
    rows = (row for row, state in iterate_in_force(early) if state == "absent")
    row = next(row for row in rows if row.new == "message_filters/subscriber.hpp")
    _, on = seen(make_evidence(row, "absent"), early, late, spoken_of=["jazzy@2024-08-01"])
    (name, before, coming), (_, after, since) = on
    assert (name, before, after) == ("jazzy@2024-08-01", False, True)
    assert coming == since > "2024-08-01"


def test_rolling_has_no_day_for_what_it_never_had_otherwise():
    # gone since rclcpp 0.8.0 of Eloquent, before rolling was; and since rclcpp 20.0.0
    rolling = DistroTarget("rolling")
    for first, known in (("0.8.0", False), ("20.0.0", True)):
        _, on = seen(Evidence("rclcpp", "removed", "x", first=first), rolling, spoken_of=["rolling"])
        assert [(holds, bool(since)) for _, holds, since in on] == [(True, known)]


def test_what_the_versions_contradict_is_not_shown():
    humble = DistroTarget("humble")
    rumour = Evidence("rclcpp", "removed", "rclcpp::nothing", first="99.0.0", source="hearsay")
    found, on = seen(rumour, humble, spoken_of=["humble"])
    assert (found.first, found.last, on, found.source) == ("", "", [], "hearsay")
    assert add_target_states(rumour._replace(source=""), [humble], ["humble"], load_providers()) is None


def test_of_what_is_to_come_the_targets_do_not_have_it_yet():
    humble = DistroTarget("humble")
    _, on = seen(Evidence("rclcpp", "removed", "x", first="99.0.0", ahead=True), humble, spoken_of=["humble"])
    assert on == [("humble", False, "")]


def test_libraries_come_with_the_distro():
    noetic = DistroTarget("noetic")
    rows = (row for row, _ in iterate_in_force(noetic) if row.package == "opencv" and row.library)
    row = next(row for row in rows if row.old == "CV_BGR2GRAY")
    _, on = seen(make_evidence(row, "removed"), noetic, spoken_of=["noetic"])
    assert on == [("noetic", True, "2020-05-23")]
    robot = DistroTarget("noetic", versions={"opencv": "4.9"}, name="robot")
    assert seen(make_evidence(row, "removed"), robot, spoken_of=["robot"])[1] == [("robot", True, "")]


def test_a_version_that_was_given_has_no_day():
    robot = DistroTarget("humble", versions={"rclcpp": "28.1.0"}, name="robot")
    _, on = seen(Evidence("rclcpp", "removed", "x", first="20.0.0"), robot, spoken_of=["robot"])
    assert on == [("robot", True, "")]


def test_a_use_has_its_label_and_bound():
    rolling = DistroTarget("rolling")
    known = (row for row, state in iterate_in_force(rolling) if row.kind == "call-changed" and state == "removed")
    use = next(row for row in known if row.package == "message_filters")
    found = make_evidence(use, "removed")
    assert (found.change, found.name, found.first[:1].isdigit()) == ("removed", use.old, True)


def test_the_version_before_is_one_of_the_same_generation():
    both = {ros for ros, _ in list_releases("tf2")}
    assert both == {1, 2}
    first = sorted((v for ros, v in list_releases("tf2") if ros == 2 and v.startswith("0.36.")), key=len)[0]
    before = find_release_before("tf2", first)
    assert (2, before) in list_releases("tf2") and not is_at_least(before, first)
    assert find_release_before("tf2", "123.4.5") == ""


def line(*versions, approximate=(), **names):
    def event(place, kind):
        return ChangeEvent(place, (ComparedThing(kind, "function"),), None, None)

    return Line(versions, {"c++": {name: tuple(event(*one) for one in events) for name, events in names.items()}}, {},
                approximate)  # fmt: skip


class Store:
    """Surfaces of which only the lines are asked."""

    def __init__(self, one):
        self.one = one

    def find_line(self, package, ros):
        return self.one if ros == 2 else None

    def find_history(self, package, ros):
        return None


@pytest.fixture
def stored(monkeypatch):
    def put(one):
        monkeypatch.setattr(module, "load_shipped", lambda: Store(one))

    return put


@pytest.mark.parametrize(
    ("change", "events", "expected"),
    [
        ("removed", [(2, "removed")], ("16.0.19", "28.1.21")),
        ("added", [(3, "added")], ("28.1.21", "31.0.3")),
        ("deprecated", [(1, "deprecated")], ("2.4.3", "16.0.19")),
        ("changed", [(1, "signature")], ("2.4.3", "16.0.19")),
        ("removed", [(1, "removed"), (2, "added")], None),  # it is back
        ("added", [(3, "removed")], None),
    ],
)
def test_stored_versions_tell_what_no_person_did(stored, change, events, expected):
    stored(line("2.4.3", "16.0.19", "28.1.21", "31.0.3", name=events))
    found = add_surfaces(Evidence("rclcpp", change, "name", side="c++"), DistroTarget("jazzy"))
    assert (found.stored, (found.last, found.first)) == ((True, expected) if expected else (False, ("", "")))


def test_a_bound_that_a_person_found_is_finer_than_the_stored_versions(stored):
    stored(line("16.0.19", "28.1.21", name=[(1, "removed")]))
    asked = Evidence("rclcpp", "removed", "name", side="c++", last="19.3.0", first="20.0.0")
    found = add_surfaces(asked, DistroTarget("jazzy"))
    assert (found.last, found.first, found.stored) == ("19.3.0", "20.0.0", False)


def test_between_stored_versions_nothing_is_claimed(stored):
    stored(line("16.0.19", "21.0.8", "28.1.21", name=[(2, "removed")]))
    jazzy, humble = DistroTarget("jazzy"), DistroTarget("humble")
    robot = DistroTarget("jazzy", versions={"rclcpp": "24.0.0"}, name="robot")
    evidence = Evidence("rclcpp", "removed", "name", side="c++")
    _, on = seen(evidence, humble, robot, jazzy, spoken_of=["jazzy"])
    # Versions 28.1.x are like 28.1.21, and jazzy was released with one of them; 24.0.0 may be either.
    assert on == [("humble", False, ""), ("jazzy", True, "2024-05-23")]


def test_a_branch_that_stood_for_a_version_tells_no_version(stored):
    stored(line("16.0.19", "28.1.21", approximate=("28.1.21",), name=[(1, "removed")]))
    found = add_surfaces(Evidence("rclcpp", "removed", "name", side="c++", source="who knows"), DistroTarget("jazzy"))
    assert (found.last, found.first, found.stored) == ("", "", False)


def test_what_a_target_offers_is_evidence(stored):
    stored(line("16.0.19", "21.0.8", "28.1.21", name=[(2, "removed")]))
    offered = Offered("rclcpp", "c++", "name", "function", "removed", "28.1.21", None, None, "21.0.8", "28.1.21", None,
                      "", "", (), "other", "", True)  # fmt: skip
    found, on = seen(make_offer_evidence(offered), DistroTarget("humble"), DistroTarget("jazzy"), spoken_of=["jazzy"])
    assert (found.change, found.instead, found.last, found.first) == ("removed", "other", "21.0.8", "28.1.21")
    assert [target[:2] for target in on] == [("humble", False), ("jazzy", True)]
