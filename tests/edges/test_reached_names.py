"""What can be reached in a graph, against a plain walk."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.edges.reach import Reach

GRAPHS = [
    pytest.param({"a": "b", "b": "c"}, {}, "a", "abc", "", id="chain"),
    pytest.param({"a": "ab"}, {}, "a", "ab", "", id="itself"),
    pytest.param({"a": "b", "b": "c", "c": "ad"}, {}, "b", "abcd", "", id="circle"),
    pytest.param({"a": "bc", "b": "d", "c": "d"}, {"d": "xy", "b": "z"}, "a", "abcd", "xyz", id="what comes along"),
    pytest.param({"a": "b"}, {"b": "c", "c": "y"}, "a", "ab", "c", id="what comes along leads nowhere"),
]


@pytest.mark.parametrize(("leads", "along", "start", "reached", "besides"), GRAPHS)
def test_what_is_reached(leads, along, start, reached, besides):
    reach = Reach(lambda name: (leads.get(name, ""), along.get(name, "")))
    found = reach.collect_masks((start,))
    assert ["".join(sorted(reach.list_names(mask))) for mask in found] == [reached, besides]


NAMES = st.sampled_from("abcdefgh")


@given(st.dictionaries(NAMES, st.lists(NAMES, max_size=4)), st.dictionaries(NAMES, st.lists(NAMES, max_size=2)),
       st.lists(NAMES, min_size=1, max_size=8))  # fmt: skip
def test_every_order_of_questions_gives_what_a_walk_gives(leads, along, asked):
    reach = Reach(lambda name: (leads.get(name, ()), along.get(name, ())))
    for start in asked:
        walked, waiting = {start}, [start]
        for name in waiting:
            fresh = set(leads.get(name, ())) - walked
            walked |= fresh
            waiting += fresh
        besides = {one for name in walked for one in along.get(name, ())}
        assert tuple(set(reach.list_names(mask)) for mask in reach.collect_masks((start,))) == (walked, besides)


def test_each_name_is_looked_at_once():
    looked = []
    reach = Reach(lambda name: (looked.append(name) or "abc", ()))
    reach.collect_masks(("a",))
    reach.collect_masks(("c", "a"))
    assert sorted(looked) == ["a", "b", "c"]
