"""Crashes on ways on which something is not known: those that come whatever that is are told from the others."""

import pytest
import z3
from rosimpact.impact.values.ir.doubtful import DoubtfulCrash, list_certain, split_foreign
from rosimpact.impact.values.outcomes import CallbackPath, CodeLine, CrashKind, Reaction

UP, ERROR = z3.BitVec("~foreign[0]", 8), z3.BitVec("~foreign[1]", 32)
SPEED, LIMIT = z3.BitVec("msg.speed", 32), z3.BitVec("this.limit", 32)


def find_names(term):
    if z3.is_const(term):
        return {term.decl().name()} if term.decl().kind() == z3.Z3_OP_UNINTERPRETED else set()
    return {name for each in term.children() for name in find_names(each)}


def make_path(*conditions, line=7):
    return CallbackPath(Reaction.UNKNOWN, conditions, place=CodeLine("src/a.cpp", line), reason="not known")


@pytest.mark.parametrize(
    "paths, expected",
    [
        # Both answers lead to the line, at which the message decides.
        ([make_path(UP == 0, SPEED == 0), make_path(UP != 0, SPEED == 0)], [0, 1]),
        ([make_path(UP == 0, SPEED == 0), make_path(UP != 0, ERROR == 3, SPEED == 0)], []),
        ([make_path(UP == 0, SPEED == 0), make_path(UP != 0, SPEED == 0, line=8)], []),
        ([make_path(SPEED == 0)], [0]),
        # The answer itself, or something compared with it, decides about the crash.
        ([make_path(UP == 0), make_path(UP != 0)], []),
        ([make_path(LIMIT == ERROR, SPEED == LIMIT), make_path(LIMIT != ERROR, SPEED == LIMIT)], []),
        ([make_path(UP == 0, SPEED == 0), make_path(UP != 0, ERROR == SPEED, SPEED == 0)], []),
    ],
)
def test_crashes_that_come_anyway(paths, expected):
    crashes = [DoubtfulCrash(number, CrashKind.FLOAT_TO_INTEGER) for number in range(len(paths))]
    assert [one.number for one in list_certain(crashes, paths, find_names)] == expected


@pytest.mark.parametrize(
    "begun, expected",
    [
        # Only where the device answers does the callback begin at all.
        ([[UP == 0]], [0]),
        ([[UP == 0], [UP == 1, ERROR == 2]], []),
        ([[SPEED == 3]], []),
        ([[UP == 0, SPEED == 3]], [0]),
        ([], []),
    ],
)
def test_what_was_asked_before_the_callback_begins_is_as_it_was_then(begun, expected):
    paths = [make_path(UP == 0, SPEED == 0)]
    crashes = [DoubtfulCrash(0, CrashKind.INDEX)]
    assert [one.number for one in list_certain(crashes, paths, find_names, begun)] == expected


def test_what_has_to_do_with_the_unknown():
    conditions = (UP == 1, ERROR == SPEED, SPEED > 3, LIMIT == 0)
    assert split_foreign(conditions, find_names) == [UP == 1, ERROR == SPEED, SPEED > 3]
    assert split_foreign((LIMIT == 0, SPEED > 3), find_names) == []
    assert split_foreign((), find_names) is None
