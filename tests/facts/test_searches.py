"""What is looked for in files beyond their facts: the places of words, uses that rows describe, what C++ declares."""

import pytest
from rosimpact.impact.facts.condition import Condition
from rosimpact.impact.facts.cpp import lexical as cpp
from rosimpact.impact.facts.kinds import decode, encode, search
from rosimpact.impact.facts.searches import WordUse
from rosimpact.impact.facts.usage import Pattern, Rows, UsageTable

TABLE = UsageTable({"advertise": [("advertise(a)", Pattern("advertise", arguments="1"))]}, ["changed", "other"])
CPP = [
    ("// changed\nint changed;\n", (), (), [WordUse("changed", 2, 5)]),
    ("int changed = 2;\n", (), (), [WordUse("changed", 1, 5, (), True)]),
    (
        "#ifdef NEW\nf(changed);\n#endif\n", (), (),
        [WordUse("changed", 2, 3, (Condition("cpp", "defined(NEW)"),))],
    ),
    ("#define A changed\n", (), (), [WordUse("changed", 1, 11, in_macro=True)]),
    ("#define A \\\n changed\nint changed;\n", (), (), [WordUse("changed", 3, 5)]),
    ("unchanged(1);\n", (), (), []),
    ("n.advertise(1);\nn.advertise(2);\n", [("advertise(a)", 1, 3), ("advertise(a)", 2, 3)], (), []),
    ("n.advertise(1, 2);\n", (), (), []),
    ("void advertise(int a);\nn.advertise(1);\n", [("advertise(a)", 2, 3)], ("advertise",), []),
]  # fmt: skip


def looked(kind, text, table):
    found = search(kind, text.encode(), cpp.extract(text.encode()), table)
    assert decode(kind, encode(found)) == found
    assert not found.facts.problems
    return found.facts


@pytest.mark.parametrize(("text", "uses", "functions", "words"), CPP)
def test_what_a_table_describes(text, uses, functions, words):
    found = looked("searched_cpp", text, TABLE)
    assert [(use.label, use.line, use.column) for use in found.uses] == list(uses)
    assert found.functions == functions
    assert found.words == tuple(words)


def test_what_rows_describe_in_text():
    rows = Rows([("spin_once", Pattern("spin_once", language="python", arguments="1"))])
    found = looked("searched_text", "# spin_once(n)\nrclpy.spin_once(n)\nrclpy.spin_once()\n", rows)
    assert [(use.label, use.line, use.column) for use in found.uses] == [("spin_once", 2, 7)]


@pytest.mark.parametrize(("text", "functions"), [
    ("void Arm::raise(int by) { }\n", {"Arm::raise"}),
    ("template<class T>\nint Arm::lower(T t) const noexcept\n{\n}\n", {"Arm::lower"}),
    ("Arm::Arm() : a_(1), b_{2} { }\nArm::~Arm() { }\n", {"Arm::Arm"}),
    ("double normalize(double angle)\n{\n}\n", {"::normalize"}),
    ("static double halve(double angle) {\n}\ninline double twice(double a) { return 2 * a; }\n", set()),
    ("double normalize(double angle);\n  double indented() { }\n", set()),
    ("Robot::Robot(int a) : Base(a), b_(f(1)) { }\n", {"Robot::Robot"}),
    ("void Arm::raise(int by);\n", set()),
    ("void f() { if (Arm::ready(1)) { g(); } Arm::raise(2); call(Arm::lower(3), [] { }); }\n", set()),
])  # fmt: skip
def test_which_functions_of_classes_a_file_defines(text, functions):
    assert looked("called_cpp", text, None).functions == functions


def test_what_a_file_calls_without_a_receiver():
    text = "arm::normalize(1); arm.raise(2); arm->run(); Joint(3);\n"
    assert looked("called_cpp", text, None).called == {"normalize", "Joint", ".run"}


def test_tables_that_differ_have_other_stamps():
    stamps = {
        UsageTable({}).stamp,
        UsageTable({}, ["a"]).stamp,
        TABLE.stamp,
        UsageTable(TABLE.patterns).stamp,
        Rows([]).stamp,
    }
    assert len(stamps) == 5 and UsageTable(TABLE.patterns, TABLE.words).stamp == TABLE.stamp
