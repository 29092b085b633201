"""What is there and will be gone: which places are warnings."""

from rosimpact.impact.analysis.findings import lower_repeats
from rosimpact.impact.model.cmake.build import At
from rosimpact.impact.rules.rule import Diagnostic, Rule, Upcoming, rate_upcoming
from rosimpact.impact.rules.severity import Doubt
from rosimpact.impact.targets.distro.distro import DistroTarget
from rosimpact.impact.targets.symbol import Horizon

TARGET = DistroTarget("jazzy")
SYNC, UPDATE = Horizon(TARGET, "the next sync of jazzy"), Horizon(TARGET, "jazzy of 2026-08-22")
NEWEST, FAR = Horizon(TARGET, "lyrical", platform=True), Horizon(TARGET, "lyrical", platform=True, far=True)


def one(line, changed="opencv", horizon=NEWEST, doubts=(), order=()):
    return Upcoming(Diagnostic(At("a.cpp", line), f"x{line}", doubts=doubts), changed, horizon, order or (line,))


def severities(*upcoming, packages=("dock",)):
    """Severities in the order of lines, of a rule whose findings are errors, in packages that have the same."""
    rule = Rule("r", "f", "error", lambda: iter(()))
    yielded = [("r", each._replace(package=name)) for name in packages for each in rate_upcoming(upcoming)]
    lowered = lower_repeats(yielded, {"r": rule})
    lowered.sort(key=lambda each: (packages.index(each[1].package), each[1].at.line))
    return [rule.compute_severity(diagnostic) for _, diagnostic in lowered]


def test_the_first_of_a_kind_is_a_warning():
    assert severities(one(1), one(2), one(3, "boost")) == ["warning", "note", "warning"]


def test_what_breaks_first_is_first_and_the_order_given_stays():
    assert severities(one(1, order=(9,)), one(2, order=(3,))) == ["note", "warning"]


def test_one_warning_is_enough_for_the_workspace():
    assert severities(one(1), one(2, "boost"), packages=("dock", "crane")) == ["warning", "warning", "note", "note"]


def test_a_note_does_not_take_the_place_of_a_warning():
    assert severities(one(1, doubts=(Doubt.EXAMPLE,)), one(2)) == ["note", "warning"]


def test_every_horizon_counts_alike_and_a_far_distro_as_a_note():
    for horizon in (SYNC, UPDATE, NEWEST):
        assert severities(one(1, horizon=horizon), one(2, horizon=horizon)) == ["warning", "note"]
    assert severities(one(1, horizon=FAR), one(2, "boost", FAR)) == ["note", "note"]


def test_what_is_gone_already_keeps_its_severity():
    plain = Diagnostic(At("a.cpp", 1), "x")
    assert severities(plain, one(2)) == ["error", "warning"]
