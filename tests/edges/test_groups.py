import pytest
from rosimpact.edges.groups import group_pairs


@pytest.mark.parametrize(
    ("pairs", "groups"),
    [
        ([], {}),
        ([("a", 1)], {"a": [1]}),
        ([("b", 2), ("a", 1), ("b", 0), ("b", 2)], {"b": [2, 0, 2], "a": [1]}),
    ],
)
def test_pairs_are_grouped_in_their_order(pairs, groups):
    found = group_pairs(iter(pairs))
    assert found == groups
    assert list(found) == list(groups)
