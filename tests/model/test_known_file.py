"""What a file that is known declares, as others ask it."""

import pytest

from tests.model.known_files import make_known


@pytest.mark.parametrize(
    ("text", "declared", "others"),
    [
        ("class A;\n", {"A"}, {"class"}),
        ("subclass A;\nclassic B;\n", set(), {"A", "B"}),
        ("struct A : B {};\n", {"A"}, {"B"}),
        ("enum class A { X };\n", {"A"}, {"X"}),
        ("typedef a::B C;\nusing D = a::E;\n", {"B", "C", "D"}, {"E", "a"}),
        ("typedef std::map<int, a::B<c::D> > E;\n", {"B", "D", "E", "map"}, {"a", "c", "std"}),
        ("class A; B b; void f(C c);\nclass AB;\n", {"A", "AB"}, {"B", "C"}),
        ("ROS_DECLARE_MESSAGE(Twist)\n", {"Twist"}, set()),
    ],
)
def test_which_types_a_file_declares(text, declared, others):
    known = make_known(text)
    assert {name for name in declared | others if known.declares_type(name)} == declared


@pytest.mark.parametrize(
    ("text", "declared", "others"),
    [
        ("namespace tf2 {\nvoid fromMsg();\n}", {"fromMsg"}, {"Msg"}),
        ("void tf2::fromMsg() {}", {"fromMsg"}, {"tf2"}),
        ("template<> void doTransform(int);\n", {"doTransform"}, {"tf2"}),
        ("template<class T> void doTransform(T);\n", set(), {"doTransform"}),
        ("namespace a {\nvoid fromMsg();\n}", set(), {"fromMsg"}),
    ],
)
def test_which_names_a_file_declares_in_a_namespace(text, declared, others):
    known = make_known(text)
    assert {
        name for name in declared | others if known.declares_in("tf2", name) or known.has_special_form(name)
    } == declared


def test_what_a_type_may_declare():
    known = make_known("struct A { n::B b; B * c; std::vector<B> d; B e[2]; B f, g; B h(); B i{1}; };")
    assert [one.names for one in known.list_mentions(["B"]) if one.names] == [("b",), ("f", "g"), ("h",), ("i",)]


def test_names_that_using_makes_known():
    known = make_known("using a::b;\nusing A::A;\nusing namespace c;\nnamespace d = e::f;\n")
    assert (known.using, known.facts.opened, known.spaces) == ({"b": "a::b"}, ("c",), {"d": "e::f"})
