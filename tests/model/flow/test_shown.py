"""How expressions are shown to people."""

import pytest
from rosimpact.impact.facts.flow import FlowExpr
from rosimpact.impact.model.flow.endpoints import unparse

ONE, RATE, PATH = FlowExpr("number", "1"), FlowExpr("name", "rate"), FlowExpr("text", "a")


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (None, ""),
        (FlowExpr("call", "ros::Duration", (FlowExpr("join", "/", (ONE, RATE)),)), "ros::Duration(1 / rate)"),
        (FlowExpr("join", "+", (PATH, RATE)), '"a" + rate'),
        (FlowExpr("join", "", (PATH, RATE)), '"a" + rate'),  # of an f-string
    ],
)
def test_expressions_are_shown_as_they_are_written(value, expected):
    assert unparse(value) == expected
