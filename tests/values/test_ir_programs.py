"""The executor over LLVM IR against callbacks whose crashes and reactions are marked in their sources."""

import pytest
from ir_programs import collect_outcomes, compile_program, explore_entry, needs_clang, read_expected

PROGRAMS = ("first_callbacks", "crashes", "exceptions", "structures", "published", "foreign")
CASES = [(name, entry) for name in PROGRAMS for entry in read_expected(name)]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("programs")


@needs_clang
@pytest.mark.parametrize(("name", "entry"), CASES, ids=[entry for _, entry in CASES])
def test_every_crash_and_every_reaction_is_found_and_no_other(name, entry, folder):
    exploration = explore_entry(compile_program(name, folder), entry)
    assert exploration.left == 0
    assert collect_outcomes(exploration) == read_expected(name)[entry]


def test_there_are_cases_for_every_kind_of_crash():
    from rosimpact.impact.values.outcomes import CrashKind

    kinds = {kind for name in PROGRAMS for expected in read_expected(name).values() for kind, _ in expected.crashes}
    assert kinds == {kind.name for kind in CrashKind}
    assert len(CASES) >= 75
