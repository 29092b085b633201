"""What headers that are not here declare, worked out of what a compiler says."""

import pytest
from rosimpact.impact.values.harness.stubs import StubTable, parse_errors

LINES = {
    1: "  pcl::PointCloud<Point> cloud;",
    2: '  vendor::open("can0");',
    3: "  driver.start();",
    4: "class VENDOR_EXPORT Node : public Base {",
    5: "using namespace vendor::inner;",
    6: "    case vendor::RED: break;",
    7: "  vendor::Mode mode = vendor::AUTO;",
}


def learn(*rows, is_own=lambda scope, name: False):
    table = StubTable(lambda path, line: LINES.get(line, ""), is_own)
    output = "\n".join(f"/ws/a.cpp:{line}:{column}: error: {text}" for line, column, text in rows)
    return table, table.learn(parse_errors(output))


def test_errors_are_read():
    found = parse_errors("/ws/a.cpp:3:7: error: no\nnothing\n/ws/b.h:1:1: fatal error: 'x.h' file not found\n")
    assert [(one.path, one.line, one.column, one.text) for one in found] == [
        ("/ws/a.cpp", 3, 7, "no"), ("/ws/b.h", 1, 1, "'x.h' file not found"),
    ]  # fmt: skip


@pytest.mark.parametrize(
    "row, expected",
    [
        (
            (1, 8, "no template named 'PointCloud' in namespace 'pcl'"),
            "namespace pcl { template <class... RiT> struct PointCloud",
        ),
        ((7, 11, "no type named 'Mode' in namespace 'vendor'"), "namespace vendor { struct Mode : ri::Anything"),
        ((2, 11, "no member named 'open' in namespace 'vendor'"), "ri::Anything open(RiA &&...a)"),
        ((6, 18, "no member named 'RED' in namespace 'vendor'"), "inline constexpr int RED ="),
        ((7, 31, "no member named 'AUTO' in namespace 'vendor'"), "inline ri::Anything AUTO;"),
        ((2, 3, "use of undeclared identifier 'vendor'"), "namespace vendor { }"),
        ((5, 17, "expected namespace name"), "namespace vendor { namespace inner { } }"),
        ((3, 3, "no member named 'start' in 'ri::Anything'"), "#define RI_EXTRA_ri_Anything"),
    ],
)
def test_what_is_learnt(row, expected):
    table, new = learn(row)
    assert new and expected in table.render()
    assert not table.learn(parse_errors(f"/ws/a.cpp:{row[0]}:{row[1]}: error: {row[2]}"))


def test_members_are_of_what_is_stood_for():
    table, _ = learn((7, 11, "no type named 'Driver' in namespace 'vendor'"))
    assert table.learn(parse_errors("/ws/a.cpp:3:10: error: no member named 'start' in 'vendor::Driver'"))
    assert "static ri::Anything start(" in table.render()
    assert not table.learn(parse_errors("/ws/a.cpp:3:10: error: no member named 'start' in 'own::Class'"))


@pytest.mark.parametrize(
    "line, flag",
    [
        ("  VENDOR_ALIGNED_NEW", "-DVENDOR_ALIGNED_NEW="),
        ("VENDOR_ALIGNED_NEW(Own, 3);", "-DVENDOR_ALIGNED_NEW(...)="),
        ("VENDOR_ALIGNED_NEW own;", None),
    ],
)
def test_macro_on_a_line_of_its_own(line, flag):
    table = StubTable(lambda path, number: line)
    assert table.learn(parse_errors("/ws/a.cpp:1:3: error: unknown type name 'VENDOR_ALIGNED_NEW'"))
    assert table.flags == ({flag} if flag else set())


def test_base_of_a_class_of_the_code():
    line = "class Own : public vendor::Base {"
    table = StubTable(lambda path, number: line, list_bases=lambda name: ["vendor::Base"] if name == "ns::Own" else [])
    assert table.learn(parse_errors("/ws/a.cpp:1:28: error: expected class name"))
    assert "namespace vendor { struct Base : ri::Anything" in table.render()
    assert table.learn(parse_errors("/ws/a.cpp:9:1: error: no member named 'enable' in 'ns::Own'"))
    assert "ri::Anything enable;" in table.render()


def test_what_is_switched_on_is_a_number():
    lines = {
        1: "void f(const vendor::Event &event) {",
        2: "  switch (event.state) {",
        3: "    case vendor::Event::Down: break;",
    }
    table = StubTable(lambda path, number: lines.get(number, ""))
    for line, column, text in (
        (1, 22, "no type named 'Event' in namespace 'vendor'"),
        (2, 17, "no member named 'state' in 'vendor::Event'"),
        (3, 25, "no member named 'Down' in 'vendor::Event'"),
        (2, 3, "statement requires expression of integer type ('ri::Anything' invalid)"),
    ):
        assert table.learn(parse_errors(f"/ws/a.cpp:{line}:{column}: error: {text}"))
    assert "static inline ri::Number state;" in table.render()
    assert "static constexpr int Down = " in table.render()


def test_macros_come_first():
    table, _ = learn(
        (4, 32, "variable has incomplete type 'class VENDOR_EXPORT'"), (9, 1, "use of undeclared identifier 'member_'")
    )
    assert table.flags == {"-DVENDOR_EXPORT="} and "member_" not in table.render()


@pytest.mark.parametrize(
    "row",
    [(1, 1, "no type named 'vektor' in namespace 'std'"), (1, 1, "unknown type name 'Own'"), (1, 1, "expected ';'")],
)
def test_nothing_is_made_up(row):
    table, new = learn(row, is_own=lambda scope, name: name == "Own")
    assert not new and not table.list_names()


def test_a_name_that_the_code_declares_itself_is_taken_back():
    table, new = learn((7, 3, "unknown type name 'Mode'"), (7, 11, "no type named 'Mode' in namespace 'vendor'"))
    assert new and table.list_names() == ["Mode", "vendor::Mode"]
    text = "/ws/a.cpp:9:7: error: typedef redefinition with different types ('vendor::Mode' vs 'Mode')"
    assert not table.remove_names(parse_errors("/ws/a.cpp:9:7: error: redefinition of 'Other'"))
    assert table.remove_names(parse_errors(text))
    assert table.list_names() == ["vendor::Mode"]
    assert not table.learn(parse_errors("/ws/a.cpp:7:3: error: unknown type name 'Mode'"))


def test_what_is_called_of_an_object_is_no_type():
    table = StubTable(lambda path, line: "  solver->Solve(x);" if line == 1 else "vendor::Solver *solver;")
    assert table.learn(parse_errors("/ws/a.cpp:2:9: error: no type named 'Solver' in namespace 'vendor'"))
    assert table.learn(parse_errors("/ws/a.cpp:1:11: error: no member named 'Solve' in 'vendor::Solver'"))
    assert "static ri::Anything Solve(RiB &&...a)" in table.render()


@pytest.mark.parametrize(
    "lines, text, expected",
    [
        ("auto n = vendor::now().since_epoch().count();", "no member named 'now' in namespace 'vendor'",
         {"since_epoch": "function", "count": "function"}),
        ("auto n = vendor::all[0].", "no member named 'all' in namespace 'vendor'", {}),
        ("auto n = vendor::all[at(0)].info.get<int>(3)->last;", "no member named 'all' in namespace 'vendor'",
         {"info": "member", "get": "function", "last": "member"}),
        ("auto n = vendor::now(a,\n  b(1))\n  .count(); x.other();", "no member named 'now' in namespace 'vendor'",
         {"count": "function"}),
        ("vendor::Now n; n.count();", "no type named 'Now' in namespace 'vendor'", {}),
    ],
)  # fmt: skip
def test_what_is_asked_of_what_a_name_gives_is_learnt_with_it(lines, text, expected):
    rows = lines.split("\n")
    table = StubTable(lambda path, number: rows[number - 1] if number <= len(rows) else "")
    column = rows[0].index("vendor::") + 9
    assert table.learn(parse_errors(f"/ws/a.cpp:1:{column}: error: {text}"))
    assert table.extras == ({"ri::Anything": expected} if expected else {})


@pytest.mark.parametrize(
    "line, text, expected",
    [
        ("using vendor::ImagePtr;", "no member named 'ImagePtr' in namespace 'vendor'", "struct ImagePtr"),
        ("using vendor::share;", "no member named 'share' in namespace 'vendor'", "ri::Anything share("),
        ("auto x = vendor::share;", "no member named 'share' in namespace 'vendor'", "inline ri::Anything share;"),
    ],
)
def test_what_is_used_from_a_namespace(line, text, expected):
    table = StubTable(lambda path, number: line)
    assert table.learn(parse_errors(f"/ws/a.cpp:1:{line.index('::') + 3}: error: {text}"))
    assert expected in table.render()


def test_what_hides_a_type_is_one():
    table = StubTable(lambda path, number: "auto x = vendor::Kind;")
    assert table.learn(parse_errors("/ws/a.cpp:1:18: error: no member named 'Kind' in namespace 'vendor'"))
    tag = "error: must use 'struct' tag to refer to type 'Kind' in this scope"
    assert table.learn(parse_errors(f"/ws/a.cpp:2:3: {tag}")) and "struct Kind" in table.render()
    assert not table.learn(parse_errors(f"/ws/a.cpp:2:3: {tag}"))


def test_a_macro_that_a_condition_asks_and_nobody_defines():
    table = StubTable(lambda path, number: "#if VENDOR_VERSION_GTE(1, 2)")
    text = "/ws/a.cpp:1:5: error: function-like macro 'VENDOR_VERSION_GTE' is not defined"
    rest = "\n/ws/a.cpp:9:1: error: use of undeclared identifier 'member_'"
    assert table.learn(parse_errors(text + rest)) and not table.list_names()
    assert table.flags == {"-DVENDOR_VERSION_GTE(...)=0"}
    assert not table.learn(parse_errors(text))


def test_a_namespace_is_learnt_before_what_is_asked_of_it():
    table, _ = learn((2, 3, "use of undeclared identifier 'vendor'"), (9, 1, "use of undeclared identifier 'member_'"))
    assert table.list_names() == [] and "namespace vendor { }" in table.render()


def test_a_type_of_anything_is_not_derived_from_it():
    line = "tf2_ros::Own::Options o;"
    table = StubTable(lambda path, number: line)
    assert table.learn(parse_errors("/ws/a.cpp:1:15: error: no type named 'Options' in 'tf2_ros::Own'"))
    assert "using Options = Anything;" in table.render() and "struct Options" not in table.render()


def test_what_a_header_taught_one_unit_is_known_to_the_next():
    first, _ = learn(
        (7, 11, "no type named 'Mode' in namespace 'vendor'"), (3, 3, "no member named 'go' in 'ri::Anything'")
    )
    second = StubTable(lambda path, line: LINES.get(line, ""), extras={"ri::Anything": {"stop": "function"}})
    second.learn_again(first.lessons)
    assert second.list_names() == ["vendor::Mode"] and second.extras == {"ri::Anything": {"stop": "function"}}
    assert "ri::Anything stop(" in second.render_extras()[0]
