"""What callbacks send, per publisher and field."""

import pytest
from ir_programs import FOLDER, compile_program, explore_entry, needs_clang
from rosimpact.impact.values.outcomes import InputKind
from rosimpact.impact.values.projection import format_values
from rosimpact.impact.values.sent_values import list_sent_fields

EXPECTED = {
    "clamped": "-0.22..0.22, NaN (relational)",
    "constants": "1, 3",
    "guarded": "20..40 (relational)",
    "converted": "0.0..63.75 (relational)",
}


@pytest.fixture(scope="module")
def published(tmp_path_factory):
    return compile_program("published", tmp_path_factory.mktemp("programs"))


@needs_clang
@pytest.mark.parametrize("entry", EXPECTED)
def test_constants_clamps_and_guards_bound_what_is_sent(entry, published):
    (sent,) = list_sent_fields(explore_entry(published, entry), seconds=60)
    assert (sent.publisher, sent.path) == ("pub", "data")
    assert format_values(sent.values) == EXPECTED[entry]
    assert sent.values.is_complete
    line = next(
        number
        for number, text in enumerate((FOLDER / "published.cpp").read_text(encoding="utf-8").splitlines(), 1)
        if number > _find_line(f"void run_{entry}(") and "pub.publish(" in text
    )
    assert [place.line for place in sent.places] == [line]


def _find_line(text: str) -> int:
    lines = (FOLDER / "published.cpp").read_text(encoding="utf-8").splitlines()
    return next(number for number, line in enumerate(lines, 1) if text in line)


@needs_clang
def test_a_field_has_the_kind_that_the_harness_gives(published):
    (sent,) = list_sent_fields(explore_entry(published, "constants"))
    assert (sent.kind, sent.bits, sent.is_signed) == (InputKind.INTEGER, 8, False)
