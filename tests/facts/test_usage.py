"""How uses look: calls, initialisations, members and types, told from the text of a file alone."""

import pytest
from rosimpact.impact.facts.usage import Pattern, declares, find_use_places, has_enum_constant, initializes_variable

CALL = Pattern("Duration", before=r"rclcpp\s*::\s*", arguments="1", names=True)
MEMBER = Pattern("codec", before=r"\bstreams\s*\[[^\]\n]*\]\s*->\s*", after=r"\s*->")
POINTER = Pattern("shared_ptr", before=r"\bboost\s*::\s*", template=r"(?:const\s+)?urdf\s*::\s*Link")
BARE = Pattern("make_settings", template="", arguments="1-2")
CONSTANT = Pattern("double", before=r"\bstatic\s+const\s+", after=r"\s+\w+\s*=", inside="class")
BOTH = Pattern("shared_ptr", before=r"(?:[^\w.:>\s]|\breturn)\s*", template=".+", file=r"using\s+namespace\s+boost\s*;",
               unless=r"#include\s*<boost/(?:shared|weak)_ptr\.hpp>")  # fmt: skip
THROW = Pattern("throw", before=r"\)\s*(?:const\s*)?", arguments="1+", names=True, after=r"\s*[;{]")

USES = (
    (
        CALL,
        {
            "auto a = rclcpp::Duration(5);": True,
            "rclcpp::Duration a(5);": True,
            "rclcpp::Duration a{5};": True,
            "rclcpp :: Duration a(f<1, 2>(3));": True,
            "auto a = rclcpp::Duration(5, 0);": False,
            "auto a = other::Duration(5);": False,
            "// rclcpp::Duration(5)": False,
            'auto a = "rclcpp::Duration(5)";': False,
            "rclcpp::Duration a;": False,
            "rclcpp::Duration_(5);": False,
        },
    ),
    (
        MEMBER,
        {
            "x = format->streams[i]->codec->width;": True,
            "x = format->streams[i]->codecpar->width;": False,
            "x = context->codec->name;": False,
        },
    ),
    (
        POINTER,
        {
            "boost::shared_ptr<urdf::Link> a;": True,
            "std::map<int, boost::shared_ptr< const urdf::Link > > a;": True,
            "boost::shared_ptr<urdf::LinkPtr> a;": False,
            "std::shared_ptr<urdf::Link> a;": False,
            "boost::shared_ptr a;": False,
        },
    ),
    (
        BARE,
        {
            "write(a, make_settings(' ', 4));": True,
            "write(a, make_settings<std::string>(' ', 4));": False,
            "write(a, make_settings(' ', 4, 5));": False,
        },
    ),
    (
        CONSTANT,
        {
            "class A { static const double X = 1.0; };": True,
            "template <class T> struct A : B<T> { int f() { return 1; } static const double X = 1.0; };": True,
            "static const double X = 1.0;": False,
            "namespace a { static const double X = 1.0; }": False,
            "class A { void f() { static const double X = 1.0; } };": False,
            "class A { static const double X; }; const double A::X = 1.0;": False,
        },
    ),
    (
        BOTH,
        {
            "using namespace boost; shared_ptr<int> a;": True,
            "using namespace boost; std::shared_ptr<int> a;": False,
            "shared_ptr<int> a;": False,
            "#include <boost/shared_ptr.hpp>\nusing namespace boost; shared_ptr<int> a;": False,
        },
    ),
    (
        THROW,
        {
            "void f() throw(std::runtime_error);": True,
            "int f() const throw (A, B) { return 1; }": True,
            "void f() throw();": False,
            "void f() { throw A(); }": False,
        },
    ),
)


def cases():
    return [
        pytest.param(pattern, text, seen, id=f"{pattern.word}: {text}")
        for pattern, texts in USES
        for text, seen in texts.items()
    ]


@pytest.mark.parametrize(("pattern", "text", "seen"), cases())
def test_a_use_is_told_by_its_looks(pattern, text, seen):
    assert bool(list(find_use_places(text.encode(), pattern))) is seen


@pytest.mark.parametrize(
    "text", ["", "\0", "rclcpp::Duration a(", "rclcpp::Duration(}", "class A { } } rclcpp::Duration("]
)
def test_broken_files_have_no_uses(text):
    assert list(find_use_places(text.encode(), CALL)) == []


def test_a_place_has_line_column_conditions_and_template_arguments():
    text = b"int a;\n#if OLD\n  boost::shared_ptr<const\n urdf::Link> b;\n#endif\n"
    ((_, (line, column, conditions, types)),) = find_use_places(text, POINTER)
    assert (line, column, [c.text for c in conditions], types) == (3, 10, ["OLD"], "const urdf::Link")


DECLARED = [
    ("void\nTable::turn(int)", True),
    ("  virtual void turn(int x);", True),
    ("std::shared_ptr<Disc> turn(int)", True),
    ("const Disc & turn(int);", True),
    ("  return turn(1);", False),
    ("  else turn(1);", False),
    ("  table.turn(1);", False),
    ("auto disc = turn(1);", False),
    ("  free && turn(1)", False),
    ("  // void turn(int)", False),
    ("// a table can\n  turn(1);", False),
    ("  std::shared_ptr<Disc>\n  turn(int speed)", True),
    ("  DISC_PTR(Disc)\n  turn(int speed)", True),
    ("  DISC_PTR(const lib::Disc) turn(int speed)", True),
    ("  disc =\n    turn(1);", False),
    ("  if (discs)\n    turn(1);", False),
    ("  else\n    turn(1);", False),
    ("  do\n    turn(1);", False),
]


@pytest.mark.parametrize(("code", "expected"), DECLARED)
def test_a_function_that_a_file_declares(code, expected):
    assert declares(code.encode(), "turn") is expected


INITIALISED = [
    ("  const cv::Vec3f &turn = all[0];", True),
    ("  auto* turn= all;", True),
    ("std::vector<int> turn = {};", True),
    ("  turn = 3;", False),
    ("  table.turn = 3;", False),
    ("  table->turn = 3;", False),
    ("  return turn == 3;", False),
    ("  int x = a & turn;", False),
    ("  else turn = 3;", False),
    ("  // int turn = 3;", False),
    ("  int returned = 3;", False),
]


@pytest.mark.parametrize(("code", "expected"), INITIALISED)
def test_a_variable_that_a_file_declares(code, expected):
    assert initializes_variable(code.encode(), "turn") is expected


@pytest.mark.parametrize(
    ("code", "expected"),
    [
        ("enum { TURN = 7 };", True),
        ("enum class Move : int { GO = (1 << 2), // c, d }\n  TURN };", True),
        ("typedef enum Move_t { GO, WAIT,\n /* last */ TURN } Move_t;", True),
        ("enum Move { GO = TURN };", False),
        ("enum Move { GO }; int move = TURN;", False),
        ("enum Move { MY_TURN };", False),
        ("void move(enum Move go, TURN);", False),
        ("move(TURN);", False),
    ],
)
def test_a_constant_of_an_enum(code, expected):
    assert has_enum_constant(code.encode(), "TURN") is expected
