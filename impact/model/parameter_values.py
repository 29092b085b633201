"""Types and ranges of parameters, and whether a value that is set fits them.

Types are those of rcl_interfaces/ParameterType by name: `bool`, `integer`, `double`, `string`, `byte`, and the arrays
of them (`double array`). ROS 2 has converted none into another since Galactic, also no integer into a double.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from typing import Any

import msgspec

Limit = tuple[str, float]
"""A bound of a value: `>=`, `>`, `<=` or `<` and a number, or `step` and the distance of values from the lower one."""

_LONGEST = 60


class ParameterTerms(msgspec.Struct, frozen=True):
    """What a declared parameter takes. type: empty where it is not known, or where it takes any. choices: the values
    that are allowed, as show_value() writes them; empty for no such list. path, line: of the declaration."""

    name: str
    type: str = ""
    limits: tuple[Limit, ...] = ()
    choices: tuple[str, ...] = ()
    path: str = ""
    line: int = 0

    @property
    def says_nothing(self) -> bool:
        """Whether every value fits."""
        return not (self.type or self.limits or self.choices)


class GivenValue(msgspec.Struct, frozen=True):
    """A value that a launch or parameter file sets. type: empty where it is not known. text: as show_value() writes it.
    numbers: of a number, or of a list of numbers, these."""

    name: str
    path: str
    line: int
    type: str
    text: str
    numbers: tuple[float, ...] = ()


def make_given_value(name: str, path: str, line: int, value: Any, type_: str = "") -> GivenValue:
    """A value as a file has it. type_: what it is made into, empty for what it is."""
    known = type_ or find_type(value)
    items = value if isinstance(value, list) else [value]
    is_number = known.partition(" ")[0] in ("integer", "double")
    numbers = tuple(float(item) for item in items) if is_number else ()
    return GivenValue(name, path, line, known, show_value(value), numbers)


def find_type(value: Any) -> str:
    """The type of a value of YAML; empty for what is no value of a parameter, as an empty list or one of several
    types."""
    if isinstance(value, bool):
        return "bool"
    if isinstance(value, int):
        return "integer"
    if isinstance(value, float):
        return "double"
    if isinstance(value, str):
        return "string"
    if isinstance(value, list):
        kinds = {find_type(item) for item in value}
        kind = kinds.pop() if len(kinds) == 1 else ""
        return f"{kind} array" if kind and " " not in kind else ""
    return ""


def show_value(value: Any) -> str:
    """A value as YAML has it, shortened."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list):
        value = f"[{', '.join(map(show_value, value))}]"
    text = str(value)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}..."


def fits_type(given: GivenValue, terms: ParameterTerms) -> bool:
    """Whether a value has the type of a parameter, as far as both are known."""
    if not given.type or not terms.type or given.type == terms.type:
        return True
    return terms.type.startswith("byte") and given.type.startswith("integer")


def find_broken_limit(given: GivenValue, terms: ParameterTerms) -> str:
    """What a value of the right type breaks: `>= 0`, `among 1, 2`; empty for nothing."""
    if terms.choices and given.type and given.text not in terms.choices and " array" not in given.type:
        return f"among {', '.join(terms.choices)}"
    lowest = next((bound for sign, bound in terms.limits if sign == ">="), None)
    for sign, bound in terms.limits:
        if not all(_holds(number, sign, bound, lowest, terms.limits) for number in given.numbers):
            return f"in steps of {_format_number(bound)}" if sign == "step" else f"{sign} {_format_number(bound)}"
    return ""


def _holds(number: float, sign: str, bound: float, lowest: float | None, limits: Iterable[Limit]) -> bool:
    if math.isnan(number):
        return True
    if sign == "step":
        if lowest is None or bound <= 0 or ("<=", number) in limits:
            return True
        nearest = lowest + round((number - lowest) / bound) * bound if math.isfinite(number) else math.inf
        return math.isclose(number, nearest, rel_tol=1e-9, abs_tol=1e-9)
    return {">=": number >= bound, ">": number > bound, "<=": number <= bound, "<": number < bound}[sign]


def _format_number(number: float) -> str:
    return str(int(number)) if number.is_integer() and abs(number) < 1e15 else str(number)


_CPP_TYPES = {
    "bool": "bool", "double": "double", "float": "double", "std::string": "string", "string": "string",
    "uint8_t": "byte", "std::uint8_t": "byte", "unsigned char": "byte",
    **dict.fromkeys(
        ("int", "long", "long int", "long long", "int64_t", "std::int64_t", "int32_t", "std::int32_t", "int16_t",
         "uint16_t", "uint32_t", "uint64_t", "std::uint32_t", "std::uint64_t", "std::uint16_t", "std::int16_t",
         "size_t", "std::size_t", "unsigned", "unsigned int", "short"), "integer"
    ),
}  # fmt: skip
_VECTOR = re.compile(r"(?:std::)?(?:vector|array)<\s*([\w:]+(?: [\w]+)*)\s*(?:,[^<>]*)?>\Z")


def parse_cpp_type(text: str) -> str:
    """The type of a parameter that is declared with a C++ type; empty for one that is none of a parameter. A single
    byte is an integer to ROS."""
    text = text.strip().removeprefix("const ").rstrip("&").strip()
    vector = _VECTOR.match(text)
    if vector is not None:
        inner = _CPP_TYPES.get(vector[1], "")
        return f"{inner} array" if inner else ""
    found = _CPP_TYPES.get(text, "")
    return "integer" if found == "byte" else found


_NAMED = {"BOOL": "bool", "INTEGER": "integer", "DOUBLE": "double", "STRING": "string", "BYTE": "byte"}


def parse_named_type(name: str) -> str:
    """The type that a constant names: `PARAMETER_DOUBLE`, `DOUBLE_ARRAY`; empty for none."""
    head, array, _ = name.removeprefix("PARAMETER_").partition("_ARRAY")
    return f"{_NAMED[head]}{' array' if array else ''}" if head in _NAMED else ""
