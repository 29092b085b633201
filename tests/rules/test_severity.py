"""The one policy of severities: each doubt allows a severity at most, and the lowest counts."""

from typing import cast

import pytest
from rosimpact.impact.facts.condition import Condition
from rosimpact.impact.model.view import TargetView
from rosimpact.impact.rules.severity import Doubt, limit_severity, list_place_doubts


@pytest.mark.parametrize(
    ("doubts", "expected"),
    [
        ((), "error"),
        ((True, None), "error"),
        ((Doubt.TEST,), "warning"),
        ((Doubt.INCOMPLETE, Doubt.CONDITIONAL), "warning"),
        ((Doubt.INCOMPLETE, Doubt.EXAMPLE), "note"),
        ((Doubt.DEPRECATED, Doubt.INCOMPLETE), "note"),
    ],
)
def test_lowest_counts(doubts, expected):
    assert limit_severity(*doubts) == expected
    assert limit_severity(*reversed(doubts)) == expected


def test_false_is_no_doubt():
    with pytest.raises(TypeError, match="known or"):
        limit_severity(False)


class _Place:
    """Conditions that begin with `known` hold; tests are built in ROS 2 alone."""

    def __init__(self, ros: int):
        self.ros = ros

    def is_built(self, role):
        return role in ("build", "run") or (role == "test" and self.ros == 2)

    def is_sure(self, conditions):
        return all(condition.text.startswith("known") for condition in conditions)


_KNOWN, _OPTION = Condition("cpp", "known"), Condition("cmake", "WITH_X")
_IF = Condition("cpp", "X_VERSION > 3")


@pytest.mark.parametrize(
    ("ros", "role", "conditions", "expected"),
    [
        (2, "build", (), ()),
        (2, "build", (_KNOWN,), ()),
        (2, "test", (), ()),
        (1, "test", (), (Doubt.TEST,)),
        (1, "test", (_OPTION,), (Doubt.TEST, Doubt.CONDITIONAL)),
        (2, "run", (_OPTION, _KNOWN), (Doubt.CONDITIONAL,)),
        (2, "build", (_OPTION, _IF), (Doubt.GUARDED,)),
        (2, "aside", (), (Doubt.EXAMPLE,)),
    ],
)
def test_doubts_of_a_place(ros, role, conditions, expected):
    assert list_place_doubts(cast(TargetView, _Place(ros)), role, conditions) == expected
