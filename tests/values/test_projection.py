"""Value sets of fields and witnesses, from conditions written by hand and from programs."""

import math
import time

import pytest
import z3
from ir_programs import compile_program, explore_entry, needs_clang
from rosimpact.impact.values.ir.solving import Solving
from rosimpact.impact.values.outcomes import (
    CallbackPath,
    CrashKind,
    Exploration,
    InputKind,
    Reaction,
    SymbolicInput,
)
from rosimpact.impact.values.projection import (
    FieldValues,
    complement_values,
    format_values,
    make_solving,
    make_witness,
    merge_spans,
    project_fields,
)


def make_input(path, kind=InputKind.INTEGER, bits=8, is_signed=False, most=0):
    return SymbolicInput(path, kind, bits, is_signed, z3.BitVec(path, bits), most)


def make_exploration(inputs, *paths, left=0):
    return Exploration({each.path: each for each in inputs}, [CallbackPath(*each) for each in paths], left=left)


def test_spans_of_a_field_are_exact_where_conditions_speak_of_it_alone():
    value = make_input("msg.value")
    term = value.term
    exploration = make_exploration(
        [value],
        (Reaction.HANDLED, (z3.Or(term == 3, z3.And(z3.UGE(term, 10), z3.ULE(term, 20))),)),
        (Reaction.LOG_ONLY, (z3.UGT(term, 200),)),
        (Reaction.IGNORED, (z3.ULE(term, 200), term != 3, z3.Or(z3.ULT(term, 10), z3.UGT(term, 20)))),
    )
    (field,) = project_fields(exploration)
    assert field.values[Reaction.HANDLED] == FieldValues(((3, 3), (10, 20)))
    assert field.values[Reaction.LOG_ONLY] == FieldValues(((201, 255),))
    assert field.surely_unhandled == FieldValues(((0, 2), (4, 9), (21, 255)))
    assert field.surely_ignored == FieldValues(((0, 2), (4, 9), (21, 200)))
    assert (
        format_values(field.values[Reaction.HANDLED], {3: "BLUE"}) == "BLUE, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20"
    )


def test_signed_fields_have_negative_values():
    speed = make_input("msg.speed", bits=16, is_signed=True)
    exploration = make_exploration(
        [speed], (Reaction.HANDLED, (speed.term > -5,)), (Reaction.IGNORED, (speed.term <= -5,))
    )
    (field,) = project_fields(exploration)
    assert field.values[Reaction.IGNORED].spans == ((-32768, -5),)
    assert field.values[Reaction.HANDLED].spans == ((-4, 32767),)


def test_floats_have_infinities_and_nan_apart():
    x = make_input("msg.x", InputKind.FLOAT64, 64, True)
    number = z3.fpBVToFP(x.term, z3.Float64())
    small = z3.fpLT(z3.fpAbs(number), z3.FPVal(0.5, z3.Float64()))
    exploration = make_exploration([x], (Reaction.HANDLED, (small,)), (Reaction.IGNORED, (z3.Not(small),)))
    (field,) = project_fields(exploration)
    below = math.nextafter(0.5, 0)
    assert field.values[Reaction.HANDLED] == FieldValues(((-below, below),))
    ignored = field.values[Reaction.IGNORED]
    assert (ignored.infinities, ignored.has_nan) == ((-math.inf, math.inf), True)
    assert field.surely_ignored == ignored


def test_two_fields_that_are_compared_are_relational():
    a, b = make_input("msg.a"), make_input("msg.b")
    exploration = make_exploration([a, b], (Reaction.HANDLED, (z3.UGT(a.term, b.term),)))
    first, second = project_fields(exploration)
    assert first.values[Reaction.HANDLED] == FieldValues(((1, 255),), is_relational=True)
    assert second.values[Reaction.HANDLED] == FieldValues(((0, 254),), is_relational=True)
    assert first.surely_unhandled == FieldValues(((0, 0),))


@pytest.mark.parametrize("left", [0, 1])
def test_nothing_is_sure_where_a_way_was_left_or_is_unknown(left):
    value = make_input("msg.value")
    unknown = (Reaction.UNKNOWN, (z3.UGE(value.term, 250),))
    exploration = make_exploration([value], (Reaction.HANDLED, (value.term == 0,)), unknown, left=left)
    (field,) = project_fields(exploration)
    assert field.surely_unhandled == (None if left else FieldValues(((1, 249),)))


def test_a_witness_is_small_and_fulfils_all_conditions():
    a, x = make_input("msg.a", bits=32, is_signed=True), make_input("msg.x", InputKind.FLOAT64, 64, True)
    number = z3.fpBVToFP(x.term, z3.Float64())
    conditions = (a.term > 3, z3.fpGT(number, z3.FPVal(7.25, z3.Float64())))
    exploration = make_exploration([a, x], (Reaction.HANDLED, conditions))
    witness = make_witness(exploration, exploration.paths[0])
    assert witness.values["msg.a"] == 4
    assert make_solving(exploration, time.monotonic() + 5).holds(conditions, witness.values)


def test_a_witness_shows_the_member_that_is_written():
    new, old = make_input("msg.mode"), make_input("this.mode_")
    path = CallbackPath(Reaction.HANDLED, (), shown_by=(new.term != old.term,))
    exploration = Exploration({"msg.mode": new, "this.mode_": old}, [path])
    witness = make_witness(exploration, path)
    assert witness.values["msg.mode"] != witness.values["this.mode_"]


def test_there_is_no_witness_of_what_cannot_be():
    value = make_input("msg.value")
    exploration = make_exploration([value], (Reaction.CRASH, (value.term == 1, value.term == 2)))
    assert make_witness(exploration, exploration.paths[0]) is None


def test_spans_merge_and_have_complements():
    assert merge_spans([(5, 7), (0, 1), (2, 3), (6, 9)]) == ((0, 3), (5, 9))
    value = make_input("msg.value")
    assert complement_values(value, [FieldValues(((0, 3), (5, 255)))]) == FieldValues(((4, 4),))
    assert complement_values(value, [FieldValues(((0, 255),))]).is_empty()


def test_a_solver_guesses_products_of_floats():
    solving = Solving(time.monotonic() + 60)
    parts = [z3.fpBVToFP(solving.make_input(name, InputKind.FLOAT64, 64, True).term, z3.Float64()) for name in "xyzw"]
    norm = parts[0] * parts[0]
    for part in parts[1:]:
        norm = norm + part * part
    near = z3.fpLT(z3.fpAbs(norm - z3.FPVal(1.0, z3.Float64())), z3.FPVal(0.1, z3.Float64()))
    model = solving.find_model([near], {})
    assert solving.holds([near], model)
    assert solving.questions == 0


@pytest.fixture(scope="module")
def first(tmp_path_factory):
    return compile_program("first_callbacks", tmp_path_factory.mktemp("programs"))


@needs_clang
def test_sets_of_callbacks(first):
    (value,) = project_fields(explore_entry(first, "led"))
    assert format_values(value.values[Reaction.HANDLED]) == "0..2"
    assert format_values(value.values[Reaction.LOG_ONLY]) == "3..255"
    (mode,) = project_fields(explore_entry(first, "mode"))
    assert format_values(mode.surely_ignored) == "-2147483648..-1, 2..2147483647"
    linear, angular = project_fields(explore_entry(first, "velocity"), seconds=60)
    assert format_values(linear.values[Reaction.CRASH]) == "NaN"
    assert format_values(angular.surely_ignored) == "-0.009999999999999998..0.009999999999999998"
    sizes = {each.path: each for each in project_fields(explore_entry(first, "scan"), seconds=60)}
    assert format_values(sizes["msg.ranges.size"].values[Reaction.CRASH]) == "0"
    goal = {each.path: each for each in project_fields(explore_entry(first, "goal"), seconds=60)}
    assert format_values(goal["msg.header.frame_id"].values[Reaction.HANDLED]) == '"map"'


@needs_clang
def test_witnesses_of_callbacks_fulfil_their_conditions(first):
    for entry in ("text", "joints", "command", "goal"):
        exploration = explore_entry(first, entry)
        solving = make_solving(exploration, time.monotonic() + 60)
        crashes = {path.crash for path in exploration.paths}
        for path in exploration.paths:
            witness = make_witness(exploration, path, seconds=60)
            assert solving.holds([*path.condition, *path.shown_by], witness.values)
            assert (witness.result, witness.crash) == (path.result, path.crash)
        assert crashes - {None} <= set(CrashKind)


@needs_clang
def test_larger_bounds_find_what_small_ones_hide(tmp_path):
    program = compile_program("first_callbacks", tmp_path, "-DTEXT_BOUND=16", "-DARRAY_BOUND=8")
    details = {path.detail for path in explore_entry(program, "text").paths if path.crash is CrashKind.EXCEPTION}
    assert details == {"std::invalid_argument: stoi", "std::out_of_range: stoi"}
    joints = explore_entry(program, "joints")
    overflows = [path for path in joints.paths if path.crash is CrashKind.INDEX and not path.detail]
    sizes = [make_witness(joints, path, seconds=60).values["msg.name.size"] for path in overflows]
    assert min(sizes) == 7
