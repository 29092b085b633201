"""Comments that silence a rule."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.impact.facts.allow import allows

COMMENTS = [
    (b"x = 1  # rosimpact: allow(a-rule)", [(1, ("a-rule",), False)]),
    (b"\n  # rosimpact: allow(a, b)\n", [(2, ("a", "b"), True)]),
    (b"int x; // rosimpact: allow(removed-header)\r\n", [(1, ("removed-header",), False)]),
    (b"/* rosimpact: allow(a) */\n", [(1, ("a",), True)]),
    (b"<depend>x</depend> <!-- rosimpact: allow(a) -->", [(1, ("a",), False)]),
    (b"<!-- rosimpact: allow(a) -->\n<x/>\n<!--rosimpact:allow(b)-->", [(1, ("a",), True), (3, ("b",), True)]),
    (b"# rosimpact: allow()", []),
    (b"# rosimpact: allow a", []),
    (b"rosimpact: allow(a)", []),
    (b"nothing", []),
]


@pytest.mark.parametrize(("data", "expected"), COMMENTS)
def test_comment_gives_rules(data, expected):
    assert [(a.line, a.rules, a.own_line) for a in allows(data)] == expected


@given(st.binary(max_size=200))
def test_never_raises_and_stays_in_the_file(data):
    data = data.replace(b"\x00", b"# rosimpact: allow(a)")
    for allow in allows(data):
        assert 1 <= allow.line <= data.count(b"\n") + 1
