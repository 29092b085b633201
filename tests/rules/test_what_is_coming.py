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
