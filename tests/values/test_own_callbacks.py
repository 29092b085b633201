"""Callbacks of our own: what becomes of each field's values, each crash with kind and line, each shown by a replay."""

import pytest
from harness_workspaces import needs_compiler
from own_callbacks import WORKSPACES, describe, explore_own, list_marked, list_names, read_expected
from rosimpact.impact.values.outcomes import CrashKind

CASES = [(workspace, name) for workspace in WORKSPACES for name in list_names(workspace)]


@needs_compiler
@pytest.mark.parametrize(("workspace", "name"), CASES, ids=[f"{one}-{name}" for one, name in CASES])
def test_sets_and_crashes_are_found_and_replays_show_them(workspace, name):
    answer = explore_own(workspace)[name]
    assert list(describe(answer)) == read_expected()[f"{workspace} {name}"]
    crashes = {(one.crash, one.place.line) for one in answer.examples if one.crash is not None}
    expected = list_marked(workspace).get(name, set())
    assert {kind for kind, _ in crashes} == {kind for kind, _ in expected}
    # Of a loop without an end, the line is that on which it was stopped.
    exact = {one for one in expected if one[0] is not CrashKind.ENDLESS}
    assert {one for one in crashes if one[0] is not CrashKind.ENDLESS} == exact
    assert [one.note for one in answer.examples if one.confirmed is not True] == []
    assert answer.examples


def test_there_are_ten_and_thirty_more():
    names = {workspace: list_names(workspace) for workspace in WORKSPACES}
    assert len(names["ten"]) == 10
    assert sum(map(len, names.values())) >= 40 + len(names["python"])
    kinds = {kind for one in WORKSPACES for crashes in list_marked(one).values() for kind, _ in crashes}
    # What is left is the end of a function that returns nothing, which no compiler lets pass silently.
    assert kinds == set(CrashKind) - {CrashKind.UNREACHABLE}
