"""What is left out where two runs of a workspace are compared: what differs between any two runs."""

import pytest
from rosimpact.impact.prune.verify import leave_out_run

LOG = {"msg": "Server On", "file": "hear.cpp", "line": 12, "topics": ["/rosout", "/a"]}


@pytest.mark.parametrize(
    ("topic", "fields", "left"),
    [
        ("/rosout", LOG, {"msg": "Server On", "topics": ["/a", "/rosout"]}),
        ("/other", LOG, LOG),
        ("/arm/status", {"goals": [{"id": "/arm-1-1796043375.421"}]}, {"goals": [{"id": "/arm-1-now"}]}),
        ("/other", {"text": "at 1796043375.421", "n": 3}, {"text": "at 1796043375.421", "n": 3}),
        ("/other", None, None),
    ],
    ids=["a log", "what is no log", "a goal's number", "numbers that are no goal's", "a message that is not known"],
)
def test_what_differs_between_runs_is_left_out(topic, fields, left):
    assert leave_out_run(topic, fields) == left
