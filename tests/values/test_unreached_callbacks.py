"""A callback that no way leads to is not explored, and that is said."""

import pytest
from rosimpact.impact.values.answers import CallbackAnswer
from rosimpact.impact.values.evaluate import Evaluated
from rosimpact.impact.values.outcomes import Bounds, Reaction
from rosimpact.impact.values.survey import _read_result


@pytest.mark.parametrize(
    "counts, left, reason",
    [
        ({}, 0, "no way of making the node leads to the callback"),
        ({}, 2, ""),
        ({Reaction.UNKNOWN: 1}, 0, ""),
        ({Reaction.IGNORED: 1}, 0, ""),
    ],
)
def test_what_is_said_of_a_callback_without_ways(tmp_path, counts, left, reason):
    answer = CallbackAnswer("on", "subscriber", "cpp", "a.cpp", 3, "std_msgs/Int32", (), (), Bounds())
    said = _read_result(answer, Evaluated(counts, (), (), (), {}, (), left, 0.5), tmp_path)
    assert (said.reason, said.seconds, dict(said.counts)) == (reason, 0.5, counts)
