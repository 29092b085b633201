"""Whatever the names are, Markdown of a report holds no link, mention, image or markup of theirs."""

import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from markdown_it import MarkdownIt
from rosimpact.impact.analysis.effects import Effect, Impact
from rosimpact.impact.analysis.report import AnalysisCoverage, Report, ReportedPackage, ReportedTarget
from rosimpact.impact.model.flow.graph import Coverage as FlowCoverage
from rosimpact.impact.report import github, markdown
from rosimpact.impact.report.impact import render_markdown as impact_markdown
from rosimpact.impact.report.markdown_text import escape_markdown, format_cell, quote
from rosimpact.impact.rules.rule import Finding

COVERAGE = FlowCoverage(0, 0, 0, 0)
READER = MarkdownIt("commonmark", {"html": True}).enable(["table", "strikethrough"])
# What GitHub makes a link of wherever it stands outside of code.
LINKED = re.compile(r"@\w|#\d|://|\bwww\.|\bGH-\d|mailto:|\b[0-9a-f]{7,40}\b", re.IGNORECASE)
PARTS = st.sampled_from([
    "`", "``", "```", "@user", "#1", "o/r#12", "GH-3", "https://x.org/a", "www.x.org", "a@b.org", "[x](y)", "![x](y)",
    "<img src=x>", "<!--", "*a*", "_a_", "**", "~~a~~", "|", "\\", "\\|", "$x$", "&lt;", "\n\n# h", "\n```\n", "\n- x",
    "\x1b[2J", "\u202e", " ", "", "name", "deadbeef", "std::vector<int>", "(", ")", "]", "[", "![",
])  # fmt: skip
NAMES = st.lists(PARTS, max_size=8).map("".join)


def tokens(text):
    for token in READER.parse(text):
        yield token
        yield from token.children or ()


def outside_code(text):
    return "".join(token.content for token in tokens(text) if token.type == "text")


def nothing_of_theirs(text, ours=("<sub>", "</sub>")):
    for token in tokens(text):
        assert token.type not in ("link_open", "image", "html_block", "fence", "code_block"), token
        assert token.type != "html_inline" or token.content in ours, token
        if token.type == "text":
            assert not LINKED.search(token.content), token.content


@given(NAMES, NAMES)
def test_text_stays_text(name, other):
    line = f"- {escape_markdown(f'`{name}` is gone in {other}, see `{other}`')} end"
    nothing_of_theirs(line, ())
    kinds = [token.type for token in READER.parse(line)]
    assert kinds == ["bullet_list_open", "list_item_open", "paragraph_open", "inline", "paragraph_close",
                     "list_item_close", "bullet_list_close"]  # fmt: skip
    assert outside_code(line).endswith(" end")
    assert not {token.type for token in tokens(line)} & {"em_open", "strong_open", "s_open"}


@given(NAMES)
def test_code_cannot_be_left(name):
    line = f"a {quote(name)} b"
    assert [token.type for token in tokens(line)][2:-1] == ["text", "code_inline", "text"]


@given(NAMES, NAMES)
def test_a_cell_stays_one_cell(name, other):
    cells = format_cell(quote(name)), format_cell(escape_markdown(f"`{other}` is {name}"))
    table = f"| a | b |\n|---|---|\n| {cells[0]} | {cells[1]} |\n"
    assert sum(token.type == "td_open" for token in tokens(table)) == 2
    nothing_of_theirs(table, ())


def report_of(name, other):
    message, help = f"`{name}` is {other}", f"use `{other}`"
    finding = Finding("removed-header", "error", name, other, 3, 1, name, (name,), message, help)
    return Report(
        "0.1.0", "2026-08-22", (ReportedTarget(name, "jazzy", "", ""), ReportedTarget("b", "b", "", "")), (finding,),
        AnalysisCoverage(1, 1, 1), (ReportedPackage(name, other),), base=other,
    )  # fmt: skip


@settings(max_examples=40)
@given(NAMES, NAMES)
def test_reports_have_nothing_of_theirs(name, other):
    report = report_of(name, other)
    shape = [token.type for token in READER.parse(markdown.render(report))]
    assert shape == [token.type for token in READER.parse(markdown.render(report_of("a", "b")))]
    nothing_of_theirs(github.render_step_summary(report))
    nothing_of_theirs(markdown.render(report))
    nothing_of_theirs(f"{markdown.format_verdict(report._replace(failure=name))}", ())
    effect = Effect("topic", "changed", name, name, other, 3, "", (), (), ())
    nothing_of_theirs(impact_markdown(Impact((effect,), (), 0, 0, COVERAGE)))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("on humble@2024-03-01, (see o/r#1).", "on `humble@2024-03-01`, (see `o/r#1`)."),
        ("at https://x.org/a", "at `https://x.org/a`"),
        ("commit deadbeef1", "commit `deadbeef1`"),
        ("`a``b`", "`a` `b`"),
        ("~~x~~", "\\~\\~x\\~\\~"),
        ("a\u202eb", "a\\\\u202eb"),
    ],
)
def test_words_that_github_links_are_code(text, expected):
    assert escape_markdown(text) == expected


def test_a_warning_has_the_places_of_its_notes(quiet):
    found = [Finding("r", severity, "ui", f"{severity}.cpp", 1, 0, "x", ("jazzy",), "`x` will go")
             for severity in ("note", "warning")]  # fmt: skip
    lines = markdown.render(quiet._replace(findings=tuple(found))).splitlines()
    assert lines[2] == "- ⚠️ `warning.cpp:1` and 1 more place (`note.cpp:1`): `x` will go (jazzy)"
    assert "note" not in lines[-1]
