"""C++ facts: what a source includes, names and registers, and under which conditions."""

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.impact.facts.cpp.lexical import CppFile, extract, scan


def conditions_of(item):
    return [("not " if c.negated else "") + c.text for c in item.conditions]


def includes(text):
    return [(i.path, *conditions_of(i)) for i in extract(text.encode()).includes]


def qualified(text):
    return [n.text for n in extract(text.encode()).qualified]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("#include <vector>", [("vector",)]),
        ('  #  include "a/b.h" // why', [("a/b.h",)]),
        ("#include_next <math.h>", [("math.h",)]),
        ("#include \\\n <a.h>", [("a.h",)]),
        ("#include /* odd */ <a.h>", [("a.h",)]),
        ("#include <a//b.h>", [("a/b.h",)]),
        ("// #include <a>\n/* #include <b>\n#include <c> */\n#include <d>", [("d",)]),
        ('const char* s = "\\n#include <a>";', []),
        ('auto s = R"x(\n#include <a>\n)x";\n#include <b>', [("b",)]),
        ("#include MACRO_HEADER\n#include <a>", [("a",)]),
        ("#ifdef X\n#include <a>\n#else\n#include <b>\n#endif\n#include <c>",
         [("a", "defined(X)"), ("b", "not defined(X)"), ("c",)]),
        ("#ifndef X\n#include <a>\n#endif", [("a", "not defined(X)")]),
        ("#if A\n#include <a>\n#elif B\n#include <b>\n#else\n#include <c>\n#endif",
         [("a", "A"), ("b", "not A", "B"), ("c", "not A", "not B")]),
        ("#ifdef A\n#elifdef B\n#include <b>\n#elifndef C\n#include <c>\n#endif",
         [("b", "not defined(A)", "defined(B)"), ("c", "not defined(A)", "not defined(B)", "not defined(C)")]),
        ("#ifndef A\n#elif B\n#include <b>\n#endif", [("b", "defined(A)", "B")]),
        ("#if A\n#if B\n#include <a>\n#endif\n#include <b>\n#endif", [("a", "A", "B"), ("b", "A")]),
        ("#if 0\n#include <a>\n#endif", [("a", "0")]),
        ("#if __has_include(<tf2/utils.hpp>) // new\n#include <tf2/utils.hpp>\n#endif",
         [("tf2/utils.hpp", "__has_include(<tf2/utils.hpp>)")]),
        ('#if __has_include("a.h")\n#include "a.h"\n#endif', [("a.h", '__has_include("a.h")')]),
        ("#if A \\\n   || /* x */ B\n#include <a>\n#endif", [("a", "A || B")]),
        ("#ifndef F_H\n#define F_H\n#include <a>\n#endif  // F_H\n", [("a",)]),
        ("// x\n#pragma once\n#ifndef F_H\n#define F_H 1\n#include <a>\n#endif\n", [("a",)]),
        ("#if !defined(F_H)\n#define F_H\n#include <a>\n#endif\n", [("a",)]),
        ("#ifndef F_H\n#define F_H\n#ifdef X\n#include <a>\n#endif\n#endif\n", [("a", "defined(X)")]),
        ("#ifndef F_H\n#define F_H\n#include <a>\n#endif\nint x;\n", [("a", "not defined(F_H)")]),
        ("#ifndef F_H\n#define F_H\n#else\n#include <a>\n#endif\n", [("a", "defined(F_H)")]),
        ("#ifndef F_H\n#define OTHER\n#include <a>\n#endif\n", [("a", "not defined(F_H)")]),
        ("#error don't \"stop\n#include <a>\n", [("a",)]),
        ("int n = 1'000'000; char c = '\\''; auto q = '\"';\n#include <a>\n", [("a",)]),
        ("#define S(x) #x\n#include <a>\r\n#include <b>\r\n", [("a",), ("b",)]),
        ("#endif\n#else\n#include <a>", [("a",)]),
    ],
)  # fmt: skip
def test_includes(text, expected):
    assert includes(text) == expected


def test_place_of_an_include_is_its_delimiter():
    first, second = extract(b'\n#include <a.h>\n  #include "b.h"\n').includes
    assert (first.line, first.column, first.angled) == (2, 10, True)
    assert (second.line, second.column, second.angled) == (3, 12, False)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("std::vector<int> v;", ["std::vector"]),
        ("std::vector<int>::iterator i;", ["std::vector"]),
        ("std :: min(a, b);", ["std::min"]),
        ("tf2_ros::\n  Buffer b;", ["tf2_ros::Buffer"]),
        ("a::b\n  ::c();", ["a::b::c"]),
        ("::std::string s;", ["std::string"]),
        ("return ::ns::f();", ["ns::f"]),
        ("FOO_API ::ns::Type f();", ["ns::Type"]),
        ("return ::close(fd);", []),
        ("foo<int>::bar::baz();", []),
        ("std::cout; std::cout;", ["std::cout"]),
        ("// std::a\n/* std::b */ \"std::c\" '::'", []),
        ('auto s = R"(std::a)"; std::b();', ["std::b"]),
        ('LOG"std::a"; LR"x(std::b)x"; std::c();', ["std::c"]),
        ("std::chrono::system_clock::now()", ["std::chrono::system_clock::now"]),
        ("Foo::~Foo() {}", []),
        ("x ? a::b : c::d", ["a::b", "c::d"]),
        ("// continued \\\n std::a\nstd::b", ["std::b"]),
        ("case'a':x::y();", ["x::y"]),
        ("u8'a' + x::y", ["x::y"]),
    ],
)
def test_qualified_names(text, expected):
    assert qualified(text) == expected


def test_names_are_kept_once_per_conditions_with_their_first_place():
    facts = extract(b"std::a;\n#ifdef X\n  std::a; std::a;\n#endif\nstd::a;\n")
    assert [(n.text, n.line, n.column, conditions_of(n)) for n in facts.qualified] == [
        ("std::a", 1, 1, []),
        ("std::a", 3, 3, ["defined(X)"]),
    ]


@pytest.mark.parametrize("between", ["\n", " ", ","])
def test_names_of_long_files_are_all_found_where_they_first_stand(between):
    written = [f"ns::v{number % 9_000}" for number in range(20_000)]
    facts = extract(between.join(["T<int>::first::type", *written, "ns::v1::last"]).encode())
    assert [name.text for name in facts.qualified] == [*written[:9_000], "ns::v1::last"]
    assert facts.words == ""


@pytest.mark.parametrize(
    ("text", "variables"),
    [
        ("std::mutex m;\n  static const ns::T a = 1;\n::ns::U b{};", ("std::mutex", "ns::T", "ns::U")),
        ("f(std::mutex m);\nstd::mutex *m;\nreturn ::ns::T m;\n// std::mutex m;", ()),
    ],
)
def test_types_of_variables_that_begin_a_line(text, variables):
    assert extract(text.encode()).variables == variables


def test_columns_count_characters():
    (name,) = extract("/* äöü */ std::a;".encode()).qualified
    assert (name.line, name.column) == (1, 11)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("struct A { };", ()),
        ("namespace n { struct A { }; class B : public x::C<D> { }; class Announced; }", ("n::A", "n::B")),
        ("namespace n { struct EIGEN_ALIGN16 A final : B { }; enum class E : int { x }; union U { };}",
         ("n::A", "n::E", "n::U")),
        ("namespace n::m { using A = B; typedef std::vector<int> C; using namespace o; }", ("n::m::A", "n::m::C")),
        ("namespace n { void f(struct A * a); struct A b; }", ()),
    ],
)  # fmt: skip
def test_types_that_are_defined_in_namespaces(text, expected):
    assert extract(text.encode()).types == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("struct A { }; struct B; struct EXPORT(x) C final : n::D, public E<F> { };", [("C", "n D public E F")]),
        ("template <class T> class A : B { }; template <> struct A<n::T> : C { };", [("A", "B"), ("A", "C")]),
        ("class A : public B<void(int)> { };", [("A", "public B void")]),
        ("using A = n::B; typedef std::vector<C> D; typedef void (*E)(int);", [("A", "n B"), ("D", "std vector C")]),
    ],
)
def test_parents_of_classes_and_aliases(text, expected):
    assert list(extract(text.encode()).parents) == expected


def test_words_are_bare_identifiers_of_four_letters():
    facts = extract(b"int32_t memcpy(std::size_t count); ::close(1); for (auto abc : list) return 0x1234; // word\n")
    assert facts.words == "close count int32_t list memcpy"


def test_words_leave_out_directives_but_not_the_bodies_of_macros():
    facts = extract(
        b"#if defined(SOME)\n#error some prose here\n#pragma omp parallel\n#endif\n#define TWICE(x) call_it(x)\n"
    )
    assert facts.words == "TWICE call_it"
    assert facts.defined == ("TWICE",)


def test_using():
    facts = extract(b"using namespace std::chrono_literals;\nusing cv::Mat;\nusing Ptr = std::shared_ptr<int>;\n")
    assert (facts.opened, facts.using) == (("std::chrono_literals",), ("cv::Mat",))


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("struct A { };", "A"),
        ("class ARM_API(x) A : public ::b::C { }; struct n::B final {};", "A B"),
        ("struct __attribute__((packed)) A;", ""),
        ("typedef struct a { int b; } A;", "A a"),
        ("ROS_DECLARE_MESSAGE(A)", "A"),
        ("// struct A { };\nstruct A a;", ""),
    ],
)
def test_names_of_types(text, names):
    assert " ".join(sorted(extract(text.encode()).type_names)) == names


@pytest.mark.parametrize(
    ("text", "made", "parents", "initializes"),
    [
        ("auto a = new A(1); auto b = std::make_shared<n::B>();", ("A", "n::B"), (), False),
        ("class X_API A final : public B { A() : b_(1) {} };", (), (("A", "public B"),), True),
        ("template<class T> struct A<T *>\n  : n::B<T>, C {};", (), (("A", "n B T C"),), False),
        ("struct A { n::B b; void f() { v.emplace_back(1); } }; // new A(), class A : public B", (), (), True),
        ("using A = n::B<C>; typedef ::n::D const * E; using n::F; typedef void (*G)(H);",
         (), (("A", "n B C"), ("E", "n D const")), False),
    ],
)  # fmt: skip
def test_what_is_made_derived_and_initialized(text, made, parents, initializes):
    facts = extract(text.encode())
    assert (facts.made, facts.parents, facts.initializes) == (made, parents, initializes)


def test_short_words_stand_apart():
    assert extract(b"int ab = run(abcd);").short == "ab run"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("PLUGINLIB_EXPORT_CLASS(ns::Plugin, base::Base)", ("ns::Plugin",)),
        ("PLUGINLIB_EXPORT_CLASS(\n  ns :: Plugin,\n  base::Base)", ("ns::Plugin",)),
        ("RCLCPP_COMPONENTS_REGISTER_NODE(::ns::Node)", ("ns::Node",)),
        ("PLUGINLIB_DECLARE_CLASS(pkg, Name, ns::Plugin, nodelet::Nodelet)", ("ns::Plugin",)),
        ("GZ_REGISTER_MODEL_PLUGIN(Obstacles)", ("Obstacles",)),
        ("IGNITION_ADD_PLUGIN(\n  ns::Pump, gz::sim::System)", ("ns::Pump",)),
        ("#define PLUGINLIB_EXPORT_CLASS(a, b) x", ()),
        ("// PLUGINLIB_EXPORT_CLASS(a, b)", ()),
    ],
)
def test_exports(text, expected):
    assert extract(text.encode()).exports == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('ros::package::getPath("my_pkg")', [("package", "my_pkg", "")]),
        ('ament_index_cpp::get_package_share_directory( "my_pkg" ) + "/x"', [("place", "my_pkg", "x")]),
        ('ros::package::getPath("my_pkg") + "/maps/" + name', [("place", "my_pkg", "maps")]),
        ('ros::package::getPath("my_pkg") + "/map" + number', [("package", "my_pkg", "")]),
        ('fs::path(get_package_share_path("my_pkg")) / "a" / "b.yaml"', [("place", "my_pkg", "a/b.yaml")]),
        ('f(ros::package::getPath("my_pkg"), "/x")', [("package", "my_pkg", "")]),
        ('f("package://my_pkg/meshes/a.dae")', [("file", "my_pkg", "meshes/a.dae")]),
        ('// "package://my_pkg/meshes/a.dae"', []),
        ("ros::package::getPath(name)", []),
        ('config.getPath("my_pkg")', []),
    ],
)
def test_references(text, expected):
    assert [(r.kind, r.package, r.name) for r in extract(text.encode()).references] == expected


@pytest.mark.parametrize(
    ("text", "line", "part"),
    [
        ("\n/* no end", 2, "comment without an end"),
        ("int a;\n#if A\n", 3, "without `#endif`"),
        ("#endif", 1, "`#endif` without `#if`"),
        ("\n\n#include CONFIG_H", 3, "`#include CONFIG_H`"),
    ],
)
def test_problems(text, line, part):
    (problem,) = extract(text.encode()).problems
    assert problem.line == line
    assert part in problem.message


def test_other_encodings_are_read():
    assert includes_of(b"\xef\xbb\xbf#include <a>") == ["a"]
    assert includes_of("#include <a>\n".encode("utf-16")) == ["a"]
    assert includes_of(b"// \xe9\xff\n#include <a>\0\n") == ["a"]


def includes_of(data):
    return [i.path for i in extract(data).includes]


def test_hostile_depth_costs_no_quadratic_memory():
    deep = extract(b"#if A\n" * 3000 + b"std::a\n")
    assert len(deep.qualified[0].conditions) < 100
    wide = extract(b"#if A\n" + b"#elif B\nstd::a\n" * 3000 + b"#endif\n")
    assert max(len(name.conditions) for name in wide.qualified) < 100


PIECES = st.sampled_from([
    "#if A\n", "#else\n", "#elif B\n", "#endif\n", "#ifndef X\n#define X\n", "#include <a>\n", "#include", '"', "'",
    "\\", "\n", "/*", "*/", "//", 'R"x(', ')x"', "::", "std", " ", "std::a", "<", ">", "#", "\r\n", "\t", "\0", "é",
    "main(", "1'0", "int", "PLUGINLIB_EXPORT_CLASS(", ")", "using namespace a;", '"package://p/q"', "defined(",
])  # fmt: skip


def check(data):
    facts = extract(data)
    text = data.decode("utf-8-sig", "replace").replace("\r\n", "\n").replace("\r", "\n")
    lines = text.split("\n") if data[:2] not in (b"\xff\xfe", b"\xfe\xff") else None
    for item in (*facts.includes, *facts.qualified, *facts.references):
        assert item.line >= 1 and item.column >= 1
        if lines is not None:
            assert item.column <= len(lines[item.line - 1])
    for problem in facts.problems:
        assert problem.line >= 1
    assert msgspec.msgpack.decode(msgspec.msgpack.encode(facts), type=CppFile) == facts


@given(st.binary())
def test_never_raises_on_bytes(data):
    check(data)


@given(st.lists(PIECES).map("".join))
def test_never_raises_on_pieces(text):
    check(text.encode())


@pytest.mark.parametrize(
    ("code", "expected"),
    [
        ("class A {\n  arm::Hand left_;\n};", True),
        ("  static const ::arm::Hand left = made();", True),
        ("arm::Hand * left_;", False),
        ("std::shared_ptr<arm::Hand> left_;", False),
        ("void take(arm::Hand & left);", False),
        ("// arm::Hand left;", False),
    ],
)
def test_a_variable_of_a_type(code, expected):
    assert ("arm::Hand" in extract(code.encode()).variables) is expected


@pytest.mark.parametrize(
    ("text", "blanked"),
    [
        ("A_DEPRECATED_MSG(please use std::this_thread::sleep_for instead)\nvoid nap();", True),
        ("A_DEPRECATED(use std::this_thread::sleep_for for this)\nvoid nap();", True),
        ("A_DEPRECATED(std::this_thread::sleep_for(1));", False),
        ("A_DEPRECATED(inline std::this_thread::id x);", False),
        ("A_MSG(please use std::this_thread::sleep_for instead)", False),
    ],
)
def test_what_a_macro_of_deprecation_advises_is_no_code(text, blanked):
    visible = scan(text.encode()).visible
    assert ("std::this_thread" not in visible) == blanked
    assert len(visible) == len(text)
