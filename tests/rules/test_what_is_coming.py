"""What only the newest distro's libraries refuse: a warning where that distro is near, a note where it is far."""

from pathlib import Path

import pytest
from rosimpact.impact.check import Options, check

CASE = Path(__file__).parent / "api/changed_signature/before"


@pytest.mark.parametrize(
    ("target", "expected"),
    [
        ("melodic", {"warning"}),
        ("lunar", {"warning"}),
        ("jade", {"note"}),
        ("noetic", {"error"}),
    ],
)
def test_floating_point_durations_of_boost(target, expected, tmp_path):
    report = check(CASE, Options(targets=(target,), cache=tmp_path, jobs=1))
    told = {f.severity for f in report.findings if f.subject.startswith("boost::posix_time::milliseconds")}
    assert told == expected


def test_nothing_is_coming_where_the_newest_distro_is_asked_for_itself(tmp_path):
    def told(*targets):
        report = check(CASE, Options(targets=targets, cache=tmp_path, jobs=1))
        return {(f.severity, f.targets) for f in report.findings if f.subject.startswith("boost::posix_time::millis")}

    assert told("melodic") == {("warning", ("melodic",))}
    assert told("melodic", "noetic") == {("error", ("noetic",))}
    assert told("melodic") == {("warning", ("melodic",))}  # and what was said of two targets is not remembered for one
