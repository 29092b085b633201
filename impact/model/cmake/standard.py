"""The C++ standard a package asks for, in every form it can be asked for."""

from __future__ import annotations

import re
from collections.abc import Iterable

from .interpreter import Interpreter
from .macros import note_flag_macros
from .values import Word

_FLAG = re.compile(r"(?:^|[\s;:,\"])--?std=(?:c|gnu)\+\+([0-9][0-9a-z])\b")
_FEATURE = re.compile(r"cxx_std_(\d\d)\b")
# By the documentation of CMAKE_CXX_KNOWN_FEATURES; what is not of C++98 or C++14 is of C++11.
_FEATURES_OF_14 = frozenset((
    "cxx_aggregate_default_initializers", "cxx_attribute_deprecated", "cxx_binary_literals",
    "cxx_contextual_conversions", "cxx_decltype_auto", "cxx_digit_separators", "cxx_generic_lambdas",
    "cxx_lambda_init_captures", "cxx_relaxed_constexpr", "cxx_return_type_deduction", "cxx_variable_templates",
))  # fmt: skip
_NAMES = {"0x": 11, "1y": 14, "1z": 17, "2a": 20, "2b": 23, "2c": 26, "03": 98}


def parse_flag_standard(text: str) -> int:
    """The standard of a `-std=` flag in a text (`-std=gnu++1z` is 17), 0 when there is none; the last one counts."""
    if "-std=" not in text:
        return 0
    found = _FLAG.findall(text)
    if not found:
        return 0
    name = found[-1]
    return _NAMES.get(name) or (int(name) if name.isdigit() else 0)


def parse_feature_standard(text: str) -> int:
    """The standard that a compile feature needs (`cxx_std_17`, `cxx_auto_type`), 0 for none."""
    found = _FEATURE.search(text)
    if found:
        return int(found.group(1))
    named = text.startswith("cxx_") and text != "cxx_template_template_parameters"
    return 14 if text in _FEATURES_OF_14 else 11 if named else 0


def is_default(run: Interpreter) -> bool:
    """True when a standard set here gives way to one that the user or a toolchain chose."""
    return any("CMAKE_CXX_STANDARD" in held.text for held in run.conditions)


def note_variable(run: Interpreter, name: str, text: str, item: Word) -> None:
    """Collects a standard that is set through a variable."""
    if name == "CMAKE_CXX_STANDARD":
        if text.isdigit() and len(text) == 2:
            run.add_standard(int(text), item.at, is_default(run), False)
    elif name.startswith("CMAKE_CXX_FLAGS"):
        note_flag_macros(run, text)
        run.open_flags = run.open_flags or "${" in text
        number = parse_flag_standard(text)
        if number:
            run.add_standard(number, item.at, is_default(run), True)


def note_options(run: Interpreter, items: Iterable[Word]) -> None:
    """Collects a standard that is set with add_compile_options() or add_definitions()."""
    for item in items:
        run.open_flags = run.open_flags or "${" in item
        number = parse_flag_standard(item)
        if number:
            run.add_standard(number, item.at, is_default(run), True)
