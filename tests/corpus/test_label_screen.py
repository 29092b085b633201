"""The labelling screen without a terminal: any text can be shown, any keys can be pressed."""

from __future__ import annotations

import io
import tempfile
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rich.console import Console
from rosimpact.corpus.label_screen import GUIDE_FILE, Screen, clean
from rosimpact.corpus.labelling import WHY_LIMIT, Session, read_current_labels
from rosimpact.corpus.report import LABELS, PHASES, BugReport, find_faults

GUIDE = GUIDE_FILE.read_text(encoding="utf-8")
# It is drawn beside every text and takes most of the time: enough of it to be scrolled. A test of its own draws all.
SHORT = "\n".join(GUIDE.splitlines()[:30])
SIZES = [(100, 30), (60, 20), (20, 5), (200, 60)]
KEYS = [
    *"12345679nrsuab[]jkgG ",
    "<escape>",
    "<enter>",
    "<up>",
    "<pagedown>",
    "<resize>",
    "<unknown>",
    "why \u4f60",
    "<paste>x\ny",
]
MOVES = st.one_of(
    st.sampled_from(KEYS).map(lambda key: [key]),
    st.sampled_from(
        [["1", "2", "1", "update", "<enter>"], ["5", "4", "wish", "<enter>"], ["4", "3", "late", "<enter>"]]
    ),
)
PIECES = ["```", "> ", "* ", "1. ", "|a|b|", "|-|-|", "# ", "<b>", "[x](y)", "![i](j)", "\n", "    ", "\x1b[2J", "\x9b"]
PIECES += ["\u202e", "~~~cpp\n", "---"]
TEXTS = st.one_of(st.text(max_size=300), st.lists(st.sampled_from(PIECES), max_size=40).map("".join))


def report(number: int, title: str = "Title", body: str = "Body") -> BugReport:
    return BugReport(f"acme/arm#{number}", "https://github.com/acme/arm", "github", None, title, body)


def drawn(screen: Screen, width: int = 100, height: int = 30) -> str:
    console = Console(file=io.StringIO(), width=width, height=height, force_terminal=True, color_system=None)
    lines = console.render_lines(screen.draw(console), console.options.update(width=width, height=height))
    assert len(lines) == height
    return "\n".join("".join(segment.text for segment in line) for line in lines)


@settings(deadline=None, max_examples=60)
@given(TEXTS, TEXTS, st.sampled_from(SIZES))
def test_any_text_is_drawn_and_sends_no_control_character(title, body, size):
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "labels.jsonl"
        with Session(file, "ann", "first", [report(1, title, body)]) as session:
            screen = Screen(session, lambda title, body: ("other", {}), SHORT)
            for key in ("", "r", "G"):
                screen.press(key or "<resize>")
                shown = drawn(screen, *size)
                assert all(sign == "\n" or sign.isprintable() for sign in shown)


@pytest.mark.parametrize("size", SIZES)
def test_the_whole_guide_is_drawn_and_scrolled(tmp_path, size):
    with Session(tmp_path / "labels.jsonl", "ann", "first", [report(1)]) as session:
        screen = Screen(session, lambda title, body: ("other", {}), GUIDE)
        seen = []
        for _ in range(5):
            seen.append(drawn(screen, *size))
            assert all(sign == "\n" or sign.isprintable() for sign in seen[-1])
            screen.press("]")
        for _ in range(6):
            screen.press("[")
        assert drawn(screen, *size) == seen[0]
        assert (seen[1] != seen[0]) == (size[1] >= 30), "the small ones have no room for a guide"


@settings(deadline=None, max_examples=40)
@given(st.lists(MOVES, max_size=30), st.sampled_from(["first", "second", "disagreements"]))
def test_any_keys_leave_labels_that_follow_the_guide(moves, mode):
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "labels.jsonl"
        reports = [report(n) for n in range(1, 5)]
        for annotator, reading in (("ann", "first"), ("bob", "second"), ("eve", mode)):
            with Session(file, annotator, reading, reports) as session:
                screen = Screen(session, lambda title, body: ("other", {"other": 1.0}), SHORT)
                for key in (key for move in moves for key in move):
                    screen.press(key)
                assert not screen.ended
                drawn(screen)
        for label in read_current_labels(file).values():
            assert find_faults(label) == ""
            assert label.why and len(label.why) <= WHY_LIMIT


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("a\tb\r\nc\rd", "a   b\nc\nd"),
        ("\x1b[31mred\x07", "\\x1b[31mred\\x07"),
        ("wide\u00a0space\u2028line", "wide space\\u2028line"),
        ("left\u202eright\u200bjoin", "left\\u202eright\\u200bjoin"),
        ("caf\u00e9 \u4f60\u597d \U0001f916", "caf\u00e9 \u4f60\u597d \U0001f916"),
    ],
)
def test_clean(text, shown):
    assert clean(text) == shown


def test_a_body_of_a_megabyte_is_shown_as_plain_text(tmp_path):
    body = "# no heading\n" + "log line of some length\n" * 50_000
    with Session(tmp_path / "labels.jsonl", "ann", "first", [report(1, body=body)]) as session:
        screen = Screen(session, lambda title, body: ("other", {}), GUIDE)
        assert "# no heading" in drawn(screen)
        screen.press("G")
        assert "end" in drawn(screen)


def test_the_guide_explains_every_label_kind_and_phase():
    from rosimpact.corpus.report import KINDS

    for name in [*LABELS, *PHASES, *(kind for kinds in KINDS.values() for kind in kinds)]:
        assert f"`{name}`" in GUIDE
