"""What no file of a workspace can do to the one who reads it: each row is hostile text, and what is known of it."""

import random
import resource
import subprocess
import sys

import pytest
from rosimpact.databuild.extract.parameters import _normalize
from rosimpact.impact.facts import kinds
from rosimpact.impact.facts.allow import allows
from rosimpact.impact.facts.cpp.flow_clean import Region, Regions, clean_source
from rosimpact.impact.facts.markup import find_text_encoding
from rosimpact.impact.facts.setup import ENTRY_POINT
from rosimpact.impact.facts.usage import find_template_arguments

MOST = 20_000


@pytest.mark.parametrize(
    ("kind", "text", "field"),
    [
        ("cpp", "".join(f"#include <a{n}.h>\n" for n in range(MOST + 5)), "includes"),
        ("python", "".join(f"import a{n}\n" for n in range(MOST + 5)), "imports"),
        ("cmake", "a()\n" * (MOST + 5), "commands"),
        (
            "manifest",
            "<package format='3'><name>a</name>" + "<depend>b</depend>" * (MOST + 5) + "</package>",
            "dependencies",
        ),
    ],
)
def test_lists_longer_than_anybody_writes_are_cut_and_named(kind, text, field):
    facts = kinds.extract(kind, text.encode()).facts
    assert len(getattr(facts, field)) == MOST
    assert facts.problems[0].message == f"lists more than 20,000 {field}; the rest was not read"


def test_lists_of_real_files_stay_whole():
    facts = kinds.extract("cpp", b"#include <a.h>\n" * 200).facts
    assert len(facts.includes) == 200
    assert not facts.problems


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("{1, 2}", "{1, 2}"),
        ("{1 2,}", "{1 2,}"),
        ('{"a", "b"}', '{"a", "b"}'),
        ('std::string( "a" )', '"a"'),
        ("rclcpp::ParameterValue(std::string{true})", "true"),
        ("a + b", "?"),
        ("{" + "1" * 60, "?"),
        ("{" + "true " * 60 + "x", "?"),
        ("std::string(" * 100_000, "?"),
    ],
)
def test_defaults_of_parameters(text, expected):
    assert _normalize(text) == expected


@pytest.mark.parametrize(
    ("text", "end"),
    [
        ("int> x", 4),
        ("std::vector<int>> x", 17),
        ("A<B<C>>> x", 8),
        ("a b", None),
        ("<,<>,>&" * 40, None),
        ("<" * 5000, None),
    ],
)
def test_template_arguments(text, end):
    found = find_template_arguments(text, 0)
    assert (found.end() if found else None) == end


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("run = a.b:main", ("run", "a.b")),
        (" run=a :main [x]", ("run", "a")),
        ("run = a.b:main [x, y] ", ("run", "a.b")),
        ("run", None),
        ("run = a." + " " * 100 + "x", None),
    ],
)
def test_entry_points(text, expected):
    found = ENTRY_POINT.match(text)
    assert ((found[1].rstrip(), found[2]) if found else None) == expected


def test_comments_that_allow():
    assert allows(b"x  # rosimpact: allow( a-b , c )")[0].rules == ("a-b", "c")
    assert allows(b"# rosimpact: allow(" + b" " * 50_000) == ()


# Texts that took minutes, at a size at which they do not when each part of them is read once.
HOSTILE = [
    ("cpp", "void f(){if(a)x();" + "else if(a)x();" * 20_000 + "}"),
    ("flow_cpp", "int main(){" + "a() " * 20_000 + "}"),
    ("python", "print 'a'\nfrom" + " " * 20_000),
    ("python", "x=" + "(" * 50_000),
    ("xacro", "<robot>" + "<!--" * 50_000),
    ("xacro", "<" + "a" * 100_000),
    ("launch_xml", "<launch><a " + "a" * 100_000 + "></launch>"),
    ("flow_python", "x = '%" + "0" * 50_000 + "' % 1"),
    ("rosimpact.databuild.extract.parameters:cpp", 'void f(){n->declare_parameter("a", {' + "1" * 200 + "x});}"),
    ("setup_py", "from setuptools import setup\nsetup(entry_points={'console_scripts': ['a=b" + " " * 9_000 + ";']})"),
    ("pyproject", "a." * 50_000 + "a = 1"),
    ("pyproject", "x = {" + '"a".' * 50_000 + "a = 1}"),
    ("manifest", "<package>" + "<a>" * 50_000),
    ("idl", 'module a { "' + '\\"' * 100_000),
    ("idl", "module a { '" + "\\'" * 100_000),
    ("idl", '@verbatim(text /* "' + '\\"' * 100_000 + "*/) module a {"),
    ("flow_cpp", "void f(){" + "[[a]] " * 10_000 + "x();}"),
    ("flow_cpp", "[[a]]\n" * 10_000 + "int x;"),
    ("flow_cpp", "void f(){\n" + "#if A\n if(a){\n#endif\n b();}\n" * 10_000 + "}\n"),
    ("python", "# coding: punycode\n" + "a" * 1_000_000),
    ("xml", "<?xml version='1.0' encoding='punycode'?>" + "a" * 1_000_000),
]


@pytest.mark.parametrize(("kind", "text"), HOSTILE, ids=[f"{kind}-{n}" for n, (kind, _) in enumerate(HOSTILE)])
def test_hostile_texts_are_read_once(kind, text):
    """In a process that has ten seconds of processor time, of which starting takes one."""
    code = (
        "import sys; from rosimpact.impact.facts import kinds; "
        "print(kinds.extract(sys.argv[1], sys.stdin.buffer.read()).kind)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, kind],
        input=text.encode(),
        capture_output=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (10, 10)),
    )
    assert done.returncode == 0, done.stderr[-500:]
    assert done.stdout.decode().strip() == kind


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("utf-8", "utf-8"),
        ("UTF8", "utf-8"),
        ("latin-1", "iso8859-1"),
        ("shift_jis", "shift_jis"),
        ("utf-16", "utf-16"),
        ("punycode", None),
        ("IDNA", None),
        ("unicode_escape", None),
        ("no-such-encoding", None),
    ],
)
def test_encodings_of_text(name, expected):
    if expected is None:
        with pytest.raises(LookupError):
            find_text_encoding(name)
    else:
        assert find_text_encoding(name) == expected


# Stretches from 0 to 100, 10 to 40, 20 to 30 and 50 to 60: which are around a place, and begin behind another.
STRETCHES = [Region(0, 100, "a", 1), Region(10, 40, "b", 2), Region(20, 30, "c", 3), Region(50, 60, "d", 4)]


@pytest.mark.parametrize(
    ("outside", "inside", "expected"),
    [
        (-1, 0, "a"),
        (-1, 10, "ab"),
        (-1, 25, "abc"),
        (0, 25, "bc"),
        (10, 25, "c"),
        (20, 25, ""),
        (-1, 30, "ab"),
        (-1, 45, "a"),
        (5, 55, "d"),
        (-1, 99, "a"),
        (-1, 100, ""),
        (-1, 5_000, ""),
    ],
)
def test_stretches_around_a_place(outside, inside, expected):
    assert "".join(one.condition for one in Regions(STRETCHES).list_between(outside, inside)) == expected


def test_stretches_are_those_that_a_walk_over_all_finds():
    chance = random.Random(3)
    made: list[Region] = []

    def fill(start, end):
        while end - start > 4 and chance.random() < 0.8:
            begins = chance.randrange(start, end - 2)
            ends = chance.randrange(begins + 1, end)
            made.append(Region(begins, ends, f"{begins}", 1))
            fill(begins + 1, ends)
            start = ends

    fill(0, 400)
    made.sort()
    regions = Regions(made)
    for _ in range(2_000):
        inside, outside = chance.randrange(410), chance.randrange(-1, 410)
        walked = [one for one in made if one.start <= inside < one.end and one.start > outside]
        assert regions.list_between(outside, inside) == walked


@pytest.mark.parametrize(("number", "kept"), [(31, True), (32, False)])
def test_attributes_in_a_row(number, kept):
    text = "int a; " + "[[x]] " * number + "int b;"
    source = clean_source(text.encode()).source.decode()
    assert (source == text) is kept
    assert len(source) == len(text)
    assert source.endswith("int b;")
