"""What is printed speaks for us alone, on any stream and in any encoding."""

import io
import json
import os
import re
import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.edges import console
from rosimpact.edges.console import (
    cut_visibly,
    escape,
    escape_bytes_in_json,
    escape_commands,
    escape_json,
    escape_lines,
    escape_page,
    format_json,
    is_obeyed,
)

MEAN = st.text(
    st.one_of(
        st.sampled_from("\x1b\r\n\t\x00\x7f\x85\x9b\u202e\u2028\u200b\ufeff\udcff\ufffe\U000e0041#:[]`|\\\"' "),
        st.characters(),
    ),
    max_size=30,
)
COMMANDS = st.sampled_from(("", "::error::x", "##[group]x", "##vso[task.x]y", "##teamcity[x]", "\n::stop-commands::x"))
TEXTS = st.builds(lambda *parts: "".join(parts), MEAN, COMMANDS, MEAN)
HIDDEN = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\xad\u061c\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff\ud800-\udfff]")
FOR_CI = re.compile(r"##[A-Za-z]{0,20}\[")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("plain", "plain"),
        ("Größe ✗ 日本", "Größe ✗ 日本"),
        ("a\x1b[31mb", "a\\x1b[31mb"),
        ("a\nb\tc\rd", "a\\nb\\tc\\rd"),
        ("\u202eabc\u2066", "\\u202eabc\\u2066"),
        ("caf\udce9", "caf\\xe9"),
        ("\x85\x9b", "\\x85\\x9b"),
        ("\U000e0041", "\\U000e0041"),
        ("##[group]x ##vso[y]", "\\x23#[group]x \\x23#vso[y]"),
        ("a ## b", "a ## b"),
        ("x##y[i]", "x\\x23#y[i]"),
        ("###[x", "#\\x23#[x"),
    ],
)
def test_what_is_dangerous_is_shown_escaped(text, expected):
    assert escape(text) == expected


@given(TEXTS)
def test_nothing_is_hidden_in_what_is_shown(text):
    for shown in (escape(text), escape_lines(text)):
        assert not HIDDEN.search(shown) and not FOR_CI.search(shown)
    assert "\n" not in escape(text) and "\t" not in escape(text)
    assert escape(escape(text)) == escape(text), "what is shown twice is escaped once"
    assert not HIDDEN.search(escape_page(text))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("::error::x", "\\x3a:error::x"),
        ("a\n  ::error::x", "a\n  \\x3a:error::x"),
        ("a\n\u3000::error::x", "a\n\u3000\\x3a:error::x"),
        ("std::string", "std::string"),
        (" : :x", " : :x"),
    ],
)
def test_no_line_is_a_command(text, expected):
    assert escape_commands(text) == expected


@given(TEXTS, st.data())
def test_an_escaped_line_is_cut_where_it_was(text, data):
    offsets = sorted(data.draw(st.lists(st.integers(0, len(text)), max_size=4)))
    pieces = cut_visibly(text, *offsets)
    assert "".join(pieces) == escape_lines(text)
    assert len(pieces) == len(offsets) + 1
    for place, offset in enumerate(offsets):
        if offset < len(text) and text[offset] not in "#":
            rest = "".join(pieces[place + 1 :])
            assert rest.startswith(escape_lines(text[offset]))


@given(TEXTS)
def test_json_says_the_same_and_hides_nothing(text):
    shown = format_json({text: [text]})
    assert json.loads(shown) == {text: [text]}
    assert not HIDDEN.search(shown) and not FOR_CI.search(shown)
    shown.encode()


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("\udcff", '"\\udcff"'),
        ("##[x", '"\\u0023#[x"'),
        ("\u202e", '"\\u202e"'),
        ("\U000e0041", '"\\udb40\\udc41"'),
        ("é😀", '"é😀"'),
    ],
)
def test_json_escapes(text, expected):
    assert escape_json(json.dumps(text, ensure_ascii=False)) == expected


@given(TEXTS)
def test_where_lone_surrogates_are_refused_bytes_are_shown(text):
    shown = escape_json(escape_bytes_in_json(json.dumps(text, ensure_ascii=False)))
    json.loads(shown).encode("utf-8")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("--- a/x\n+++ b/x\n-\ta\f\r\n+\tb\r\n", False),
        ("+::error::x\n", False),
        (" ::error::x\n", True),
        (" \t::error::x\n", True),
        (" a\r::error::x\n", True),
        ("+##[group]x\n", True),
        ("+\x1b[31m\n", True),
        (" \u202e\n", True),
        (" latin \udce9\n", False),
        (" std::string x;\n", False),
    ],
)
def test_what_a_patch_would_say_to_others(text, expected):
    assert is_obeyed(text) is expected


class Bytes:
    """A text stream over bytes, as standard output is."""

    def __init__(self, monkeypatch, encoding):
        self.buffer = io.BytesIO()
        self.stream = io.TextIOWrapper(self.buffer, encoding=encoding)
        monkeypatch.setattr(sys, "stdout", self.stream)

    def value(self):
        return self.buffer.getvalue()


ENCODINGS = ["utf-8", "ascii", "latin-1", "utf-16", "shift_jis", "cp1252"]


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_text_is_printed_in_every_encoding(monkeypatch, encoding):
    out = Bytes(monkeypatch, encoding)
    console.write("é ✗ 😀\udcff")
    console.write("::error::x")
    lines = out.value().decode(encoding).splitlines()
    assert lines[1] == "\\x3a:error::x"
    assert lines[0].endswith("\\xff")
    assert encoding != "ascii" or lines[0] == "\\xe9 \\u2717 \\U0001f600\\xff"


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_json_is_valid_in_every_encoding(monkeypatch, encoding):
    value = {"é": "✗ 😀 \udcff \u202e ##[x]"}
    out = Bytes(monkeypatch, encoding)
    console.write_json(format_json(value))
    assert json.loads(out.value().decode(encoding)) == value
    assert json.loads(out.value()) == value, "a reader that looks at the bytes understands it too"


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_documents_that_say_utf8_are_utf8(monkeypatch, encoding):
    out = Bytes(monkeypatch, encoding)
    console.write_exactly("é ::x \udce9")
    assert out.value() == "é ::x ".encode() + b"\xe9\n"


def test_colours_of_ours_stay_and_no_other_sequence():
    assert console._finish_text("\x1b[31mred\x1b[0m \x1b[2J") == "\x1b[31mred\x1b[0m \\x1b[2J"


def test_a_note_is_one_line(capsys):
    console.say("rosimpact: a\n::error::x\x1b[2J")
    assert capsys.readouterr().err == "rosimpact: a\\n::error::x\\x1b[2J\n"


def run(command, *, encoding="", **streams):
    around = {**os.environ, "PYTHONIOENCODING": encoding} if encoding else dict(os.environ)
    code = "from rosimpact.impact.cli.app import main; main()"
    return subprocess.run(
        [sys.executable, "-c", code, *command], env=around, check=False, timeout=60,
        **({"stdout": subprocess.PIPE, "stderr": subprocess.PIPE} | streams),
    )  # fmt: skip


COMMANDS_THAT_PRINT = [["explain"], ["--help"], ["check", "--schema"]]


@pytest.mark.parametrize("command", COMMANDS_THAT_PRINT, ids=" ".join)
def test_a_full_output_is_one_line_and_status_2(command):
    with open("/dev/full", "wb") as full:
        done = run(command, stdout=full)
    assert done.returncode == 2
    assert re.fullmatch(rb"rosimpact: standard output cannot be written: No space left [^\n]*\n", done.stderr)


@pytest.mark.parametrize("command", COMMANDS_THAT_PRINT, ids=" ".join)
def test_a_closed_output_is_one_line_and_status_2(command):
    done = run(command, stdout=None, preexec_fn=lambda: os.close(1))
    assert done.returncode == 2
    assert re.fullmatch(rb"rosimpact: standard output cannot be written: it is closed[^\n]*\n", done.stderr)


def test_who_reads_no_further_is_no_failure():
    read, write = os.pipe()
    os.close(read)
    done = run(["explain"], stdout=write)
    os.close(write)
    assert (done.returncode, done.stderr) == (0, b"")


def test_errors_have_no_need_of_an_error_stream():
    assert run(["check", "/nowhere"], stderr=None, preexec_fn=lambda: os.close(2)).returncode == 2


def test_a_wrong_argument_is_shown_on_one_line():
    done = run(["check", "--foo\n::add-mask::x\x1b[2J\u202e"])
    assert done.returncode == 2
    assert b"\x1b" not in done.stderr and "\u202e".encode() not in done.stderr
    assert not re.search(rb"(?m)^\s*::", done.stderr)
