"""msg, srv, action and IDL definitions to facts."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.impact.facts.interface import extract


def only(text, kind="msg"):
    interface = extract(text.encode(), kind)
    assert interface.problems == ()
    return interface.sections[0]


FIELDS = [
    ("int32 x", ("x", "int32", "", "", "")),
    ("  int32   x  # the way", ("x", "int32", "", "", "the way")),
    ("int32 x#near", ("x", "int32", "", "", "near")),
    ("geometry_msgs/Point[] points", ("points", "geometry_msgs/Point", "[]", "", "")),
    ("Header header", ("header", "Header", "", "", "")),
    ("float64[36] covariance", ("covariance", "float64", "[36]", "", "")),
    ("int8[<=5] few", ("few", "int8", "[<=5]", "", "")),
    ("string<=10 name", ("name", "string<=10", "", "", "")),
    ("wstring<=10[<=3] names", ("names", "wstring<=10", "[<=3]", "", "")),
    ("int32 x 5", ("x", "int32", "", "5", "")),
    ("int32 x -5 # five", ("x", "int32", "", "-5", "five")),
    ("int32[] x [1, 2, 3]", ("x", "int32", "[]", "[1, 2, 3]", "")),
    ('string s "a # b" # said', ("s", "string", "", '"a # b"', "said")),
    ("string s 'it''s'", ("s", "string", "", "'it''s'", "")),
    ("string s it's # odd", ("s", "string", "", "it's", "odd")),
    ("pkg/msg/Deep d\r", ("d", "pkg/msg/Deep", "", "", "")),
    ("\tuint8 tabbed", ("tabbed", "uint8", "", "", "")),
]


@pytest.mark.parametrize(("line", "expected"), FIELDS)
def test_field(line, expected):
    (field,) = only(line).fields
    assert (field.name, field.type, field.array, field.default, field.comment) == expected
    assert (field.line, field.column) == (1, len(line) - len(line.lstrip()) + 1)


CONSTANTS = [
    ("int32 X=1", ("X", "int32", "1")),
    ("int32 X = 1 # one", ("X", "int32", "1")),
    ("uint8 MASK=0x0F", ("MASK", "uint8", "0x0F")),
    ("float32 PI=-3.14", ("PI", "float32", "-3.14")),
    ("string S=all of it # this too", ("S", "string", "all of it # this too")),
    ('string S="quoted" # not this', ("S", "string", '"quoted"')),
    ("string S='a # b'", ("S", "string", "'a # b'")),
    ("string<=5 S=abc", ("S", "string<=5", "abc")),
    ("string S=", ("S", "string", "")),
    ("bool YES=True", ("YES", "bool", "True")),
]


@pytest.mark.parametrize(("line", "expected"), CONSTANTS)
def test_constant(line, expected):
    section = only(line)
    assert section.fields == ()
    assert [(c.name, c.type, c.value) for c in section.constants] == [expected]


def test_comments_above_belong_to_the_next_field_unless_a_blank_line_parts_them():
    fields = only("# A walker.\n\n# how far\n# in metres\nfloat32 x # forward\nfloat32 y\n").fields
    assert [f.comment for f in fields] == ["how far\nin metres\nforward", ""]
    assert [f.line for f in fields] == [5, 6]


def test_annotations_are_kept():
    fields = only('@optional\nint32 x\n@unit("m") @key int32 y\nint32 z\n').fields
    assert [f.annotations for f in fields] == [("@optional",), ('@unit("m")', "@key"), ()]


def test_sections():
    names = {kind: [s.name for s in extract(b"---\n---\n", kind).sections] for kind in ("srv", "action")}
    assert names == {"srv": ["request", "response"], "action": ["goal", "result", "feedback"]}
    action = extract(b"int32 a\n---\nint32 b\n---\nint32 c\nint32 D=1\n", "action")
    assert [[f.name for f in s.fields] for s in action.sections] == [["a"], ["b"], ["c"]]
    assert [c.name for c in action.sections[2].constants] == ["D"]
    assert action.problems == ()


PROBLEMS = [
    ("msg", "int32\n", [(1, "`int32` is neither a field nor a constant")]),
    ("msg", "int32 ok\n12 x\nint32 ok2\n", [(2, "`12 x` is neither a field nor a constant")]),
    ("msg", "int32 a\n---\nint32 b\n", [(2, "has more than 1 parts, which is all a .msg file may have")]),
    ("srv", "int32 a\n", [(1, "has no `---` before its response")]),
    ("action", "int32 a\n---\n", [(2, "has no `---` before its feedback")]),
    ("idl", "struct A { float", [(1, "ends in the middle")]),
    ("idl", "module a {\nunion U {};\n};", [(2, "`union` opens nothing that ROS interfaces are made of")]),
]


@pytest.mark.parametrize(("kind", "text", "expected"), PROBLEMS)
def test_what_cannot_be_read_is_named(kind, text, expected):
    assert [(p.line, p.message) for p in extract(text.encode(), kind).problems] == expected


IDL = """
#include "geometry_msgs/msg/Point.idl"
/* a comment
   of two lines */
module walker_msgs {
  module msg {
    typedef double double__9[9];
    module Step_Constants {
      const long LEFT = 0;
      @verbatim (language="comment", text="the other")
      const string NAME = "step" "s";
    };
    @verbatim (language="comment", text="One step")
    struct Step {
      @verbatim (language="comment", text="where" "\\n" "to")
      geometry_msgs::msg::Point target;
      @default (value=5)
      unsigned long long count;
      double__9 covariance;
      sequence<string<8>, 3> names;
      sequence<walker_msgs::msg::Foot> feet; // all
      octet raw[2][3];
      @key @unit(value="m") float a, b;
    };
  };
};
"""


def test_idl():
    interface = extract(IDL.encode(), "idl")
    assert (interface.name, interface.module, interface.problems) == ("Step", "walker_msgs/msg", ())
    (section,) = interface.sections
    assert [(f.name, f.type, f.array, f.default, f.comment) for f in section.fields] == [
        ("target", "geometry_msgs/msg/Point", "", "", "where\nto"),
        ("count", "uint64", "", "5", ""),
        ("covariance", "float64", "[9]", "", ""),
        ("names", "string<=8", "[<=3]", "", ""),
        ("feet", "walker_msgs/msg/Foot", "[]", "", ""),
        ("raw", "byte", "[6]", "", ""),
        ("a", "float32", "", "", ""),
        ("b", "float32", "", "", ""),
    ]
    assert section.fields[-1].annotations == ("@key", '@unit(value="m")')
    assert [(c.name, c.type, c.value, c.line) for c in section.constants] == [
        ("LEFT", "int32", "0", 9),
        ("NAME", "string", '"step" "s"', 11),
    ]
    assert [f.line for f in section.fields] == [16, 18, 19, 20, 21, 22, 23, 23]


def test_idl_service_has_a_request_and_a_response():
    text = "module a { module srv { struct Set_Request { long x; }; struct Set_Response { boolean ok; }; }; };"
    interface = extract(text.encode(), "idl")
    assert (interface.name, interface.module) == ("Set", "a/srv")
    assert [(s.name, s.fields[0].type) for s in interface.sections] == [("request", "int32"), ("response", "bool")]


def test_idl_reads_on_after_a_mistake():
    interface = extract(b"module a { struct A { long x\n long y; };\n struct B { long z; }; };", "idl")
    assert len(interface.problems) == 1
    assert [f.name for s in interface.sections for f in s.fields][-1] == "z"


WORDS = [
    "int32",
    "string",
    " ",
    "\n",
    "x",
    "X=1",
    "---",
    "#",
    "[]",
    "[3",
    "<=",
    '"',
    "'",
    "@",
    "(",
    ")",
    "5",
    "é",
    "\r",
]
IDL_WORDS = ["module", "struct", "a", "{", "}", ";", "sequence", "<", ">", "const", "long", "=", "1", "@", "(", ")",
             '"', "::", "typedef", "[", "]", ",", "/*", "//", "\n", " "]  # fmt: skip


@pytest.mark.parametrize("kind", ["msg", "srv", "action", "idl"])
@given(
    st.one_of(
        st.binary(max_size=120),
        st.lists(st.sampled_from(WORDS), max_size=30).map(lambda w: "".join(w).encode()),
        st.lists(st.sampled_from(IDL_WORDS), max_size=30).map(lambda w: " ".join(w).encode()),
    )
)
def test_never_raises_and_lines_lie_in_the_file(kind, data):
    interface = extract(data, kind)
    last = data.count(b"\n") + 1
    places = [p.line for p in interface.problems]
    for section in interface.sections:
        places += [f.line for f in section.fields] + [c.line for c in section.constants]
    assert all(1 <= line <= last for line in places)
