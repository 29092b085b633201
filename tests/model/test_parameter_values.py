"""Values of parameters against the types and ranges that are declared."""

import pytest
from rosimpact.impact.facts.launch.parameter_files import extract
from rosimpact.impact.model.parameter_library import find_terms, list_open, read_library
from rosimpact.impact.model.parameter_values import (
    ParameterTerms,
    find_broken_limit,
    find_type,
    fits_type,
    make_given_value,
    parse_cpp_type,
    parse_named_type,
)


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (True, "bool"), (1, "integer"), (1.0, "double"), ("a", "string"), ([1, 2], "integer array"),
        (["a"], "string array"), ([True], "bool array"), ([1, 2.0], ""), ([], ""), ([[1]], ""), (None, ""), ({}, ""),
    ],
)  # fmt: skip
def test_type_of_a_value(value, expected):
    assert find_type(value) == expected


@pytest.mark.parametrize(
    ("type_", "value", "fits"),
    [
        ("double", 1.0, True), ("double", 1, False), ("integer", 1.0, False), ("string", 1, False),
        ("bool", "yes", False), ("double array", [1, 2], False), ("double array", [1.5], True),
        ("double array", [], True),
        ("double", None, True), ("", 1, True), ("byte array", [1, 2], True), ("string array", "a", False),
    ],
)  # fmt: skip
def test_fits_type(type_, value, fits):
    assert fits_type(make_given_value("x", "", 1, value), ParameterTerms("x", type_)) == fits


@pytest.mark.parametrize(
    ("limits", "value", "broken"),
    [
        (((">=", 0.0), ("<=", 2.0)), 1.0, ""),
        (((">=", 0.0), ("<=", 2.0)), 2.5, "<= 2"),
        (((">=", 0.0), ("<=", 2.0)), 0.0, ""),
        (((">", 0.0),), 0.0, "> 0"),
        (((">=", -1.5),), [0.0, -2.0], ">= -1.5"),
        (((">=", 0.0), ("<=", 1.0), ("step", 0.1)), 0.3, ""),
        (((">=", 0.0), ("<=", 1.0), ("step", 0.1)), 0.35, "in steps of 0.1"),
        (((">=", 1.0), ("<=", 10.0), ("step", 4.0)), 10, ""),
        (((">=", 1.0), ("<=", 10.0), ("step", 4.0)), 9, ""),
        (((">=", 1.0), ("<=", 10.0), ("step", 4.0)), 8, "in steps of 4"),
        (((">=", 0.0),), float("nan"), ""),
        (((">=", 0.0),), "text", ""),
    ],
)
def test_limits(limits, value, broken):
    assert find_broken_limit(make_given_value("x", "", 1, value), ParameterTerms("x", "", limits)) == broken


def test_choices():
    terms = ParameterTerms("x", "string", (), ("fast", "slow"))
    assert find_broken_limit(make_given_value("x", "", 1, "quick"), terms) == "among fast, slow"
    assert find_broken_limit(make_given_value("x", "", 1, "slow"), terms) == ""


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("double", "double"), ("float", "double"), ("int", "integer"), ("int64_t", "integer"), ("uint8_t", "integer"),
        ("const std::string &", "string"), ("std::vector<double>", "double array"), 
        ("vector<std::string>", "string array"),
        ("std::vector<uint8_t>", "byte array"), ("std::array<double, 3>", "double array"), ("rclcpp::Parameter", ""),
        ("std::vector<Foo>", ""), ("T", ""),
    ],
)  # fmt: skip
def test_cpp_types(text, expected):
    assert parse_cpp_type(text) == expected


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("PARAMETER_DOUBLE", "double"), ("STRING_ARRAY", "string array"), ("PARAMETER_NOT_SET", ""), ("DOUBLES", ""),
        ("PARAMETER_BYTE_ARRAY", "byte array"),
    ],
)  # fmt: skip
def test_named_types(name, expected):
    assert parse_named_type(name) == expected


LIBRARY = """
arm:
  speed: {type: double, default_value: 1.0, validation: {gt<>: [0.0], upper_bounds<>: [2.0]}}
  mode: {type: string, validation: {"one_of<>": [[fast, slow]]}}
  names: {type: string_array_fixed_3, read_only: true}
  odd: {type: none}
  gains:
    __map_names:
      p: {type: double_array, validation: {element_bounds<>: [0.0, 9.0]}}
"""


def test_files_of_generate_parameter_library():
    ((root, terms),) = read_library(extract(LIBRARY.encode()), "arm.yaml")
    assert root == "arm"
    assert {name: (one.type, one.limits, one.choices) for name, one in terms.items()} == {
        "speed": ("double", ((">", 0.0), ("<=", 2.0)), ()),
        "mode": ("string", (), ("fast", "slow")),
        "names": ("string array", (), ()),
        "odd": ("", (), ()),
        "gains.*.p": ("double array", ((">=", 0.0), ("<=", 9.0)), ()),
    }


@pytest.mark.parametrize(
    ("name", "found"), [("speed", True), ("gains.left.p", True), ("gains.p", False), ("gains.a.b.p", False)]
)
def test_names_with_parts_that_parameters_name(name, found):
    ((_, terms),) = read_library(extract(LIBRARY.encode()), "arm.yaml")
    assert (find_terms(terms, name, list_open(terms)) is not None) == found
