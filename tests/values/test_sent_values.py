"""What callbacks send, per publisher and field."""

from dataclasses import replace

import pytest
from ir_programs import FOLDER, compile_program, explore_entry, needs_clang
from rosimpact.impact.values import evaluate as evaluating
from rosimpact.impact.values import sent_values
from rosimpact.impact.values.evaluate import evaluate
from rosimpact.impact.values.outcomes import InputKind
from rosimpact.impact.values.projection import format_values

EXPECTED = {
    "clamped": (InputKind.FLOAT64, "-0.22..0.22, NaN (relational)"),
    "constants": (InputKind.INTEGER, "1, 3"),
    "guarded": (InputKind.INTEGER, "20..40 (relational)"),
    "converted": (InputKind.FLOAT64, "0.0..63.75 (relational)"),
}


@pytest.fixture(scope="module")
def published(tmp_path_factory):
    return compile_program("published", tmp_path_factory.mktemp("programs"))


@needs_clang
@pytest.mark.parametrize("entry", EXPECTED)
def test_constants_clamps_and_guards_bound_what_is_sent(entry, published):
    (through,) = evaluate(explore_entry(published, entry), {}, 600).sent
    (sent,) = through.fields
    assert (through.publisher, sent.path) == ("pub", "data")
    kind, values = EXPECTED[entry]
    assert sent.kind is kind
    assert format_values(sent.values).removesuffix(" (relational)") == values.removesuffix(" (relational)")
    assert sent.is_known
    lines = (FOLDER / "published.cpp").read_text(encoding="utf-8").splitlines()
    start = next(number for number, line in enumerate(lines) if f"void run_{entry}(" in line)
    expected = next(number for number, line in enumerate(lines) if number > start and "pub.publish(" in line) + 1
    assert [place.line for place in through.places] == [expected]


@needs_clang
@pytest.mark.parametrize("entry", ["guarded", "converted"])
def test_ends_are_found_where_the_solver_names_small_steps(entry, published, monkeypatch):
    """Which of many answers z3 gives hangs on what it was asked before: one step stands for many small ones."""
    monkeypatch.setattr(sent_values, "_STEPS", 1)
    (through,) = evaluate(explore_entry(published, entry), {}, 600).sent
    (sent,) = through.fields
    assert format_values(sent.values) == f"{EXPECTED[entry][1].removesuffix(' (relational)')} (relational)"


@needs_clang
def test_bounds_are_called_as_a_reader_knows_them(published):
    explored = replace(explore_entry(published, "constants"), exceeded=frozenset({"~foreign[0]", "msg.data.size"}))
    assert evaluate(explored, {}, 600).beyond == ("data", "arrays and texts of other code")


@needs_clang
def test_what_is_passed_on_is_what_is_handled(published, monkeypatch):
    """It is not looked for a second time; what only some ways pass on as it is, is looked for."""
    asked = []
    project = evaluating.project_sent
    monkeypatch.setattr(evaluating, "project_sent", lambda *given: asked.append(given[2]) or project(*given))
    (through,) = evaluate(explore_entry(published, "passed"), {}, 600).sent
    assert ([format_values(one.values) for one in through.fields], asked) == (["10..20"], [])
    (through,) = evaluate(explore_entry(published, "passed_in_part"), {}, 600).sent
    assert [format_values(one.values).removesuffix(" (relational)") for one in through.fields] == ["15..20"]
    assert asked == ["data"]
