"""Lines that fit a terminal: pieces, words, paths."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.impact.analysis.report import measure
from rosimpact.impact.report.columns import UNBROKEN, LinePart, lay_out, shorten_path
from rosimpact.impact.report.style import PLAIN


def lines(pieces, width, indent=2, hang=4):
    return list(lay_out(pieces, PLAIN._replace(width=width), indent, hang))


PIECES = [
    LinePart("publishes"),
    LinePart("/scan"),
    LinePart("", path="driver/sources/driver.cpp:12"),
    LinePart("when a and b"),
]


@pytest.mark.parametrize(
    ("width", "said"),
    [
        (UNBROKEN, ["  publishes  /scan  driver/sources/driver.cpp:12  when a and b"]),
        (62, ["  publishes  /scan  driver/sources/driver.cpp:12  when a and b"]),
        (61, ["  publishes  /scan  driver/sources/driver.cpp:12", "    when a and b"]),
        (40, ["  publishes  /scan", "    driver/sources/driver.cpp:12", "    when a and b"]),
        (28, ["  publishes  /scan", "    driver/.../driver.cpp:12", "    when a and b"]),
    ],
)
def test_a_line_is_broken_between_its_pieces(width, said):
    assert lines(PIECES, width) == said


def test_a_piece_that_is_longer_than_a_line_is_broken_between_words():
    long = LinePart("when " + " and ".join(f"condition_{n}" for n in range(4)))
    assert lines([LinePart("publish"), long], 30) == [
        "  publish",
        "    when condition_0 and",
        "    condition_1 and",
        "    condition_2 and",
        "    condition_3",
    ]


def test_a_piece_with_a_hang_begins_where_it_stands():
    nodes = LinePart("/first, /second, /third, /fourth", hang=12)
    assert lines([LinePart("publishes"), nodes], 30) == ["  publishes  /first, /second,", "            /third, /fourth"]


@pytest.mark.parametrize(
    ("path", "room", "said"),
    [
        ("a/b/c/d.cpp:1", 13, "a/b/c/d.cpp:1"),
        ("aaaa/bbbb/cccc/d.cpp:1", 21, "a" * 4 + "/.../cccc/d.cpp:1"),
        ("aaaa/bbbb/cccc/d.cpp:1", 16, "aaaa/.../d.cpp:1"),
        ("aaaa/bbbb/cccc/d.cpp:1", 15, ".../d.cpp:1"),
        ("aaaa/bbbb/cccc/d.cpp:1", 3, ".../d.cpp:1"),
        ("alone.cpp:1", 3, "alone.cpp:1"),
    ],
)
def test_a_path_loses_its_middle(path, room, said):
    assert shorten_path(path, room) == said


WORDS = st.lists(st.sampled_from(("a", "of", "漢字漢字", "condition_12")), min_size=1, max_size=12).map(" ".join)


@given(st.lists(WORDS, min_size=1, max_size=5), st.integers(40, 120))
def test_no_word_is_lost_and_no_line_too_long(texts, width):
    found = lines(list(map(LinePart, texts)), width)
    assert " ".join(found).split() == " ".join(texts).split()
    assert all(measure(line) <= width for line in found)
