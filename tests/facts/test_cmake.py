"""CMake sources to commands: against the language's definition, and against CMake itself where it is installed."""

import json
import shutil
import subprocess

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.impact.facts.cmake import extract


def shape(source):
    """Commands as (name, [argument text with its quoting])."""
    return [(c.name, [a.quoting + a.text for a in c.arguments]) for c in extract(source.encode()).commands]


COMMANDS = [
    ("Project(a)", [("project", ["a"])]),
    ("set (X  a\tb\n c)", [("set", ["X", "a", "b", "c"])]),
    ("f()", [("f", [])]),
    ("f(a;b)", [("f", ["a;b"])]),
    ("f(# comment\na)", [("f", ["a"])]),
    ("f(a#comment\n)", [("f", ["a"])]),
    ('f("a b" "")', [("f", ['"a b', '"'])]),
    ('f("a\\"b")', [("f", ['"a\\"b'])]),
    ('f("two\nlines")', [("f", ['"two\nlines'])]),
    ('f("one \\\nline")', [("f", ['"one \\\nline'])]),
    ("f([[a ${b} ]c]])", [("f", ["[a ${b} ]c"])]),
    ("f([==[\nfirst newline goes ]] ]=] stays]==])", [("f", ["[first newline goes ]] ]=] stays"])]),
    ("f([a] b[c])", [("f", ["[a]", "b[c]"])]),
    ("f([=a])", [("f", ["[=a]"])]),
    ("#[[ block\ncomment ]] f(a #[=[ inside ]=] b)", [("f", ["a", "b"])]),
    ("if(NOT (A AND (B)))", [("if", ["NOT", "(", "A", "AND", "(", "B", ")", ")"])]),
    ('f("(" \\( )', [("f", ['"(', "\\("])]),
    ("f(a\\ b a\\;b \\${x})", [("f", ["a\\ b", "a\\;b", "\\${x}"])]),
    ("f($(MAKE) a$(X)b)", [("f", ["$(MAKE)", "a$(X)b"])]),
    ('f(-Da="b c" -Db="x"y)', [("f", ['-Da="b c"', '-Db="x"y'])]),
    ('f(-Da="b(c)")', [("f", ["-Da=", '"b(c)'])]),
    ('f("a"b)', [("f", ['"a', "b"])]),
    ("f($<BUILD_INTERFACE:${X}/include>)", [("f", ["$<BUILD_INTERFACE:${X}/include>"])]),
    ("f(a)\r\ng(b)\r\n", [("f", ["a"]), ("g", ["b"])]),
    ("f(ünïcode/Ä.cpp)", [("f", ["ünïcode/Ä.cpp"])]),
]


@pytest.mark.parametrize(("source", "expected"), COMMANDS)
def test_commands(source, expected):
    assert shape(source) == expected
    assert extract(source.encode()).problems == ()


def test_places_count_from_one_and_in_characters():
    facts = extract('set(A "ä" b)\n  add_library(x\n    # one\n    y.cpp\n  )\n'.encode())
    first, second = facts.commands
    assert [(a.line, a.column) for a in first.arguments] == [(1, 5), (1, 7), (1, 11)]
    assert (second.line, second.column, second.end_line) == (2, 3, 5)
    assert [(a.text, a.line, a.column) for a in second.arguments] == [("x", 2, 15), ("y.cpp", 4, 5)]


BROKEN = [
    # source, names of the commands still read, where the problem is, a word of its message
    ("find_package(catkin COMPONENTS\n  roscpp\n\ncatkin_package()\n", ["find_package", "catkin_package"], 1, "closed"),
    ('set(X "open)\nadd_library(a b)\n', ["set", "add_library"], 1, "string"),
    ("set(X [[open)\nadd_library(a b)\n", ["set", "add_library"], 1, "closed"),
    ("#[[ open\nadd_library(a b)\n", ["add_library"], 1, "closed"),
    ("add_library(a b", ["add_library"], 1, "closed"),
    ("set\nf(a)", ["f"], 1, "no command"),
    ("f(a)) g(b)\nh(c)", ["f", "h"], 1, "where a command"),
    ("f(a) g(b)", ["f", "g"], 1, "same line"),
    ("<<<<<<< HEAD\nf(a)\n=======\ng(b)\n>>>>>>> x\n", ["f", "g"], 1, "command"),
    ("f(a\0b)\ng(c)", ["f", "g"], 1, "arguments"),
    ("f(if\n (x)\n g(y)", ["f", "g"], 1, "closed"),
]


@pytest.mark.parametrize(("source", "names", "line", "said"), BROKEN)
def test_what_is_broken_is_named_and_the_rest_is_read(source, names, line, said):
    facts = extract(source.encode())
    assert [command.name for command in facts.commands] == names
    assert facts.problems[0].line == line
    assert said in facts.problems[0].message


def test_an_unclosed_command_keeps_its_own_arguments_only():
    facts = extract(b"find_package(catkin COMPONENTS\n  roscpp\n\ncatkin_package(LIBRARIES x)\n")
    assert [a.text for a in facts.commands[0].arguments] == ["catkin", "COMPONENTS", "roscpp"]
    assert [a.text for a in facts.commands[1].arguments] == ["LIBRARIES", "x"]
    assert facts.commands[1].line == 4


ENCODINGS = [
    (b"\xef\xbb\xbfproject(a)", ["project"], 0),
    (b"project(a) # caf\xe9\nf(b)", ["project", "f"], 1),
    ("project(a)\nf(b)".encode("utf-16"), ["project", "f"], 1),
    (b"", [], 0),
]


@pytest.mark.parametrize(("data", "names", "problems"), ENCODINGS)
def test_encodings(data, names, problems):
    facts = extract(data)
    assert [command.name for command in facts.commands] == names
    assert len(facts.problems) == problems


def test_many_unclosed_commands_do_not_read_the_file_again_each_time():
    facts = extract(b"f(\n" * 5000)
    assert any("too many" in problem.message for problem in facts.problems)


PIECES = st.sampled_from(
    [
        "f",
        "(",
        ")",
        '"',
        "\\",
        "\n",
        " ",
        "#",
        "[[",
        "]]",
        "[=[",
        "]=]",
        "${",
        "}",
        "$<",
        ">",
        ";",
        "a b",
        "é",
        "\0",
        "$(X)",
    ]
)


@given(st.lists(PIECES, max_size=40).map("".join) | st.text(max_size=60))
def test_never_raises_and_stays_inside_the_file(source):
    facts = extract(source.encode("utf-8", errors="replace"))
    lines = source.encode("utf-8", errors="replace").decode().split("\n")
    for command in facts.commands:
        assert 1 <= command.line <= command.end_line <= len(lines)
        for argument in command.arguments:
            assert 1 <= argument.line <= len(lines)
            assert 1 <= argument.column <= len(lines[argument.line - 1]) + 1


@given(st.binary(max_size=200))
def test_never_raises_on_bytes(data):
    extract(data)


AGAINST_CMAKE = r"""
set(A a;b "c;d" [[e ${f}]] [=[
g]] h]=])
set(B "one \
line" "\t\"quoted\"\\" x\ y \${z} $(MAKE))
set(C -Da="b c" -Db="x"y -Dc="(z)" a[1] [i;j])
set(D "" [[]] #[[ none ]] #[=[ none
either ]=] d) # the end
if(NOT (A STREQUAL "x" AND (TRUE OR FALSE)))
  set(E yes#comment
  )
endif()
set(F "multi
line" $<BUILD_INTERFACE:${A}>)
"""


def test_same_arguments_as_cmake_traces(tmp_path):
    cmake = shutil.which("cmake")
    if cmake is None:
        pytest.skip("cmake is not installed; the lexer is checked against its own table only")
    script = tmp_path / "script.cmake"
    script.write_text(AGAINST_CMAKE)
    trace = tmp_path / "trace.json"
    command = [cmake, "--trace", "--trace-format=json-v1", f"--trace-redirect={trace}", "-P", str(script)]
    subprocess.run(command, check=True, capture_output=True)
    traced = [json.loads(line) for line in trace.read_text().splitlines()]
    expected = [(entry["line"], entry["cmd"], entry["args"]) for entry in traced if "cmd" in entry]
    commands = extract(script.read_bytes()).commands
    ours = [
        (c.line, c.name, [a.text.replace("\\\n", "") if a.quoting == '"' else a.text for a in c.arguments])
        for c in commands
        if c.name != "endif"
    ]
    assert ours == [entry for entry in expected if entry[1] != "endif"]
