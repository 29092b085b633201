"""What changed between two versions of a package's headers: old, new, and all that is said about it."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rosimpact.databuild.extract.cpp import extract
from rosimpact.databuild.surface.compare_cpp import compare


def told(old: str, new: str) -> list[tuple]:
    return [
        (change.kind, change.name, " ".join(change.what), change.compatible)
        for change in compare({"a.h": extract(old.encode())}, {"a.h": extract(new.encode())})
    ]


CASES = [
    # the same
    ("void f(int a);", "void f(int b);", []),
    ("void f(A const& a);", "\n\nvoid\nf(const A &a);", []),
    ("inline namespace v1 { void f(); }", "inline namespace v2 { void f(); }", []),
    # gone and come
    ("void f();", "", [("removed", "f", "", False)]),
    ("", "void f();", [("added", "f", "", True)]),
    ("struct A { int a; void f(); };", "", [("removed", "A", "", False)]),
    ("struct A { int a; int b; };", "struct A { int a; };", [("removed", "A::b", "", False)]),
    ("struct A {};", "struct A { virtual void f() = 0; };", [("added", "A::f", "", False)]),
    ("struct A { A(); ~A(); };", "struct A {};", [("removed", "A::A", "", True), ("removed", "A::~A", "", True)]),
    ("struct A { A(int); };", "struct A {};", [("removed", "A::A", "", False)]),
    ("struct A { A(int); A(const A &); };", "struct A { A(int); };", [("removed", "A::A", "overload", True)]),
    ("class A { public: A(); };", "class A { private: A(); };", [("access", "A::A", "", False)]),
    # signatures
    ("void f(int a);", "void f(int a, int b = 0);", [("signature", "f", "arity", True)]),
    ("void f(int a);", "void f(int a, int b);", [("signature", "f", "arity", False)]),
    ("void f(A a);", "void f(const A & a);", [("signature", "f", "types", True)]),
    ("void f(const A & a);", "void f(A & a);", [("signature", "f", "types", False)]),
    ("void f();", "int f();", [("signature", "f", "result", True)]),
    ("int f();", "void f();", [("signature", "f", "result", False)]),
    ("struct A { int f(); };", "struct A { int f() const; };", [("signature", "A::f", "const", True)]),
    ("struct A { int f() const; };", "struct A { int f(); };", [("signature", "A::f", "const", False)]),
    ("struct A { static int f(); };", "struct A { int f(); };", [("signature", "A::f", "static", False)]),
    ("struct A { A(int); };", "struct A { explicit A(int); };", [("signature", "A::A", "explicit", False)]),
    (
        "struct A { virtual void f(int); };",
        "struct A { virtual void f(int, int = 0); };",
        [("signature", "A::f", "arity override", False)],
    ),
    ("struct A { int a; };", "struct A { long a; };", [("signature", "A::a", "type", False)]),
    ("struct A { int a; };", "struct B { int a; }; using A = B;", [
        ("removed", "A::a", "", False), ("signature", "A", "kind", True), ("added", "B", "", True)]),
    # overloads
    ("void f(int); void f(A);", "void f(A); void f(int);", []),
    ("void f(int); void f(A);", "void f(int);", [("removed", "f", "overload", False)]),
    ("void f(int);", "void f(int); void f(A);", [("added", "f", "overload", True)]),
    ("void f(); void f(int);", "void f(int = 0);", [("removed", "f", "overload", True)]),
    ("void f(int, int = 1);", "void f(int); void f(int, int);", [
        ("added", "f", "overload", True), ("default", "f", "", True)]),
    # the rest
    ("void f(int a = 1);", "void f(int a = 2);", [("default", "f", "", True)]),
    ("void f(int a = 1);", "void f(int a);", [("default", "f", "", False)]),
    ("void f();", '[[deprecated("g")]] void f();', [("deprecated", "f", "", True)]),
    ("enum E { A, B };", "enum E { X, A, B };", [
        ("added", "X", "", True), ("value", "A", "", True), ("value", "B", "", True)]),
    ("struct A : B {};", "struct A : C {};", [("base", "A", "", False)]),
    ("struct A : B {};", "struct A : B, C {};", [("base", "A", "", True)]),
    ("struct A { int a; };", "class A { protected: int a; };", [("access", "A::a", "", False)]),
    ("struct A { A(const A&); };", "struct A { A(const A&) = delete; };", [("deleted", "A::A", "", False)]),
    ("struct A { virtual void f(); };", "struct A { virtual void f() = 0; };", [("pure", "A::f", "", False)]),
    ("struct A {};", "struct A final {};", [("final", "A", "", False)]),
    ("#define F(a) a", "#define F(a, b) a", [("signature", "F", "arity", False)]),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "expected"), CASES)
def test_changes(old, new, expected):
    assert sorted(told(old, new)) == sorted(expected)


def test_moves():
    a = extract(b"namespace n { struct A { int a; }; }")
    forwarding = extract(b'#warning obsolete, include n/a.hpp\n#include "n/a.hpp"\n')
    changes = compare({"n/a.h": a}, {"n/a.h": forwarding, "n/a.hpp": a})
    assert [(change.kind, change.name, change.new_header) for change in changes] == [
        ("moved", "n::A", "n/a.hpp"),
    ]
    assert [change.kind for change in compare({"n/a.h": a}, {})] == ["removed"]


RENAMES = [
    ("struct A { int getSpeed(int a); };", "struct A { int get_speed(int b); };", ("A::getSpeed", "A::get_speed")),
    ("namespace a { void spin(B b); }", "namespace c { void spin(B b); }", ("a::spin", "c::spin")),
    (
        "struct PoseMsg { int x; int y; };",
        "struct PoseMessage { int x; int y; };",
        ("PoseMsg", "PoseMessage"),
    ),
    ("void spin(int a);", "void speak(A a);", None),
    ("void spin(int a);", "void halt(int a);", None),
]


@pytest.mark.parametrize(("old", "new", "expected"), RENAMES)
def test_renames_are_hints(old, new, expected):
    changes = compare({"a.h": extract(old.encode())}, {"a.h": extract(new.encode())})
    hints = [(c.old.name, c.new.name) for c in changes if c.kind == "renamed" and c.old and c.new]
    assert hints == ([expected] if expected else [])
    assert all(0.6 <= change.sure <= 1 for change in changes if change.kind == "renamed")


def test_of_two_that_are_alike_the_one_in_the_same_header_is_the_hint():
    new = {f"{name}.h": extract(f"namespace {name} {{ using Result = int; }}".encode()) for name in "ab"}
    changes = compare({"b.h": extract(b"using Result = int;")}, new)
    hints = [change.new.name for change in changes if change.kind == "renamed" and change.new]
    assert hints == ["b::Result"]


@settings(deadline=None)
@given(st.lists(st.sampled_from([text for pair in CASES for text in pair[:2]]), max_size=4))
def test_nothing_changed_and_nothing_is_said(texts):
    surface = extract("\n".join(texts).encode())
    assert compare({"a.h": surface}, {"a.h": surface}) == ()
