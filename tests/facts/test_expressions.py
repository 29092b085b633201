import re

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.impact.facts.expressions import find_last_literals, find_needed, has_needed


@pytest.mark.parametrize(
    ("expression", "words", "ends"),
    [
        ("rclcpp::", ("rclcpp",), ("rclcpp::",)),
        (r"(?:->|\.)\s*", (), ("->", ".")),
        (r"static\s+const\s+", ("static", "const"), ("const",)),
        (r"\)\s*(?:const\s*)?", (), ("const", ")")),
        (r"\bvoid\s+(?:\w+::)*", ("void",), ("::", "void")),
        (r"(?:[;{}(,]|\bstruct\s|\bstatic)\s*", (), ()),
        (r"(?:const\s+)?urdf\s*::\s*(?:Link|Joint)", ("urdf", ("Link", "Joint")), ("Link", "Joint")),
        (r"(?s)\A(?=.*\busing\s+namespace\s+(?:std|boost)\s*;)", ("using", "namespace"), ()),
        (r"(?:depth|)::Image", ("Image",), ("::Image",)),
        (r"shared(?!_from)_ptr", ("shared_ptr",), ("_ptr",)),
        (r"(?i)depth", (), ()),
        (r"(?s)(?mi:depth) image", (), ()),
        (r"(?:depth)?", (), ()),
        (r"(?:depth)+", ("depth",), ("depth",)),
        ("", (), ()),
    ],
)
def test_what_a_match_contains_and_ends_with(expression, words, ends):
    assert find_needed(expression) == tuple((word,) if isinstance(word, str) else word for word in words)
    assert find_last_literals(expression) == ends


@given(st.from_regex(r"(?:\bnode|this)\s*(?:->|\.)\s*publish(?:er)?(?:_\w+)*\s*", fullmatch=True))
def test_all_that_matches_has_them(text):
    expression = r"(?:\bnode|this)\s*(?:->|\.)\s*publish(?:er)?(?:_\w+)*\s*"
    assert re.search(expression, text)
    assert all(any(word in text for word in words) for words in find_needed(expression))
    assert has_needed(expression, text)
    ends = find_last_literals(expression)
    assert not ends or text.rstrip().endswith(ends)
