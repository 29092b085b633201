"""What no file of a workspace can do to the one who reads it: each row is hostile text, and what is known of it."""

import resource
import subprocess
import sys

import pytest
from rosimpact.impact.facts import kinds
from rosimpact.impact.facts.allow import allows
from rosimpact.impact.facts.parameters import _cpp_value
from rosimpact.impact.facts.setup import ENTRY_POINT
from rosimpact.impact.facts.usage import template_arguments

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
    assert _cpp_value(text) == expected


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
    found = template_arguments(text, 0)
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
    ("parameters_cpp", 'void f(){n->declare_parameter("a", {' + "1" * 200 + "x});}"),
    ("setup_py", "from setuptools import setup\nsetup(entry_points={'console_scripts': ['a=b" + " " * 9_000 + ";']})"),
    ("pyproject", "a." * 50_000 + "a = 1"),
    ("pyproject", "x = {" + '"a".' * 50_000 + "a = 1}"),
    ("manifest", "<package>" + "<a>" * 50_000),
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
