"""Macros that CMake defines: what an #if on them asks, in a package's own CMake and sources."""

import pytest
from rosimpact.impact.conditions import Environment, evaluate_all
from rosimpact.impact.facts.cmake import extract
from rosimpact.impact.facts.condition import Condition
from rosimpact.impact.model.cmake.build import DefinedMacro
from rosimpact.impact.model.cmake.interpret import interpret
from rosimpact.impact.model.macros import Macros


def defined(source):
    """What a CMakeLists.txt gives to the compiler: name, value, target, conditions."""
    build = interpret("pkg", lambda path: extract(source.encode()), lambda path: True, lambda *_: [], package="pkg")
    return [
        (m.name, m.value, m.target, " & ".join(("!" if c.negated else "") + c.text for c in m.conditions))
        for m in build.macros
    ]


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("add_definitions(-DFOO)", [("FOO", "", "", "")]),
        ("add_definitions(-Wall -DFOO=1 -DBAR)", [("FOO", "1", "", ""), ("BAR", "", "", "")]),
        ("add_definitions(-Wall)", []),
        ("add_compile_definitions(FOO)", [("FOO", "", "", "")]),
        ("add_compile_options(-DFOO)", [("FOO", "", "", "")]),
        ("if(A)\nadd_definitions(-DFOO)\nelse()\nadd_definitions(-DBAR)\nendif()",
         [("FOO", "", "", "A"), ("BAR", "", "", "!A")]),
        ("add_library(x a.cpp)\nif(A)\ntarget_compile_definitions(x PRIVATE FOO -DBAR)\nendif()",
         [("FOO", "", "x", "A"), ("BAR", "", "x", "A")]),
        # A variable that is filled under a condition carries it along.
        ("if(A)\nset(DEFS -DFOO)\nendif()\nadd_definitions(${DEFS})", [("FOO", "", "", "A")]),
        # The flags of everything, which later commands lengthen.
        ('if(A)\nset(CMAKE_CXX_FLAGS "${CMAKE_CXX_FLAGS} -DFOO")\nendif()\n'
         'set(CMAKE_CXX_FLAGS "${CMAKE_CXX_FLAGS} -Wall")', [("FOO", "", "", "A")]),
    ],
)  # fmt: skip
def test_macros_given_to_the_compiler(source, expected):
    assert defined(source) == expected


OLD = Condition("cmake", "rclcpp_VERSION VERSION_LESS 3")
HUMBLE = Condition("cmake", "ROS_DISTRO STREQUAL humble")
IFDEF = Condition("cpp", "defined(FOXY)")
IFNDEF = Condition("cpp", "defined(FOXY)", True)


def on(version, distro="humble"):
    return Environment(ros_distro=distro, versions=lambda name: version if name == "rclcpp" else None)


@pytest.mark.parametrize(
    ("macros", "condition", "environment", "holds"),
    [
        ([DefinedMacro("FOXY", "", "", (OLD,))], IFDEF, on("2.4.0"), True),
        ([DefinedMacro("FOXY", "", "", (OLD,))], IFDEF, on("16.0.0"), False),
        ([DefinedMacro("FOXY", "", "", (OLD,))], IFNDEF, on("2.4.0"), False),
        ([DefinedMacro("FOXY", "", "", (OLD,))], IFDEF, on(None), None),
        ([DefinedMacro("FOXY", "", "", (OLD,)), DefinedMacro("FOXY", "", "", (HUMBLE,))], IFDEF, on("16.0.0"), True),
        ([DefinedMacro("FOXY", "", "", (OLD, HUMBLE))], IFDEF, on("2.4.0", "foxy"), False),
        ([DefinedMacro("FOXY", "1", "", (OLD,))], Condition("cpp", "FOXY"), on("2.4.0"), True),
        ([DefinedMacro("FOXY", "0", "", (OLD,))], Condition("cpp", "FOXY"), on("2.4.0"), None),
        # What it is defined as is not known, or is the name of no macro.
        ([DefinedMacro("FOXY", "$<BOOL:${OLD}>", "", ())], Condition("cpp", "FOXY"), on("2.4.0"), None),
        ([DefinedMacro("FOXY", "${OLD}", "", ())], Condition("cpp", "FOXY"), on("2.4.0"), None),
        ([DefinedMacro("FOXY", "ON", "", ())], Condition("cpp", "FOXY"), on("2.4.0"), None),
        ([DefinedMacro("FOXY", "$<BOOL:${OLD}>", "", (OLD,))], IFDEF, on("2.4.0"), True),
        ([DefinedMacro("FOXY", "", "", ())], Condition("cpp", "FOXY"), on("2.4.0"), True),
        ([DefinedMacro("FOXY", "", "", ())], IFDEF, on(None), True),
        # Of what nothing defines nothing is known: another package's header or the user may.
        ([DefinedMacro("OTHER", "", "", ())], IFDEF, on("2.4.0"), None),
        # What another target is given.
        ([DefinedMacro("FOXY", "", "node", (OLD,))], IFDEF, on("2.4.0"), True),
        ([DefinedMacro("FOXY", "", "tool", (OLD,))], IFDEF, on("2.4.0"), False),
        ([DefinedMacro("FOXY", "", "tool", (OLD,))], IFNDEF, on("2.4.0"), True),
        ([DefinedMacro("FOXY", "", "linked", (OLD,))], IFDEF, on("2.4.0"), True),
        ([DefinedMacro("FOXY", "", "linked", (OLD,))], IFDEF, on("16.0.0"), False),
    ],
)
def test_what_a_condition_asks(macros, condition, environment, holds):
    links = {"node": {"core"}, "core": {"linked"}}
    assert evaluate_all(Macros(macros, (), links).resolve_conditions((condition,), ("node",)), environment) is holds


def test_a_macro_of_some_of_the_targets_that_compile_a_file_is_left_alone():
    macros = Macros([DefinedMacro("FOXY", "", "node", (OLD,))], ())
    assert macros.resolve_conditions((IFDEF,), ("node", "tool")) == (IFDEF,)


def test_a_macro_that_an_unread_link_may_bring_is_left_alone():
    macros = Macros([DefinedMacro("FOXY", "", "tool", (OLD,))], (), {"node": {"${core_TARGETS}"}})
    assert macros.resolve_conditions((IFDEF,), ("node",)) == (IFDEF,)


def test_a_macro_that_sources_define_too_is_left_alone():
    assert Macros([DefinedMacro("FOXY", "", "", (OLD,))], {"FOXY"}).resolve_conditions((IFDEF,), ("node",)) == (IFDEF,)
