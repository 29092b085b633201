"""Parameters that files of generate_parameter_library declare: types, ranges and lists of allowed values.

Source: its README at 0.4 and 0.5, https://github.com/PickNikRobotics/generate_parameter_library.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterator, Mapping, Sequence

from ...edges.groups import group_pairs
from ...edges.memory import cache_in_derived
from ..facts.launch.parameter_files import ParameterEntry, ParameterFile
from .parameter_values import Limit, ParameterTerms, show_value
from .workspace import Workspace

LISTENER = "ParamListener"
"""The class that a generated header or module has, in a namespace that is called like the root of the file."""

_TYPE = re.compile(r"(bool|int|double|string)(_array)?(_fixed_\d+)?\Z")
_OF_SETUP = re.compile(r"\bgenerate_parameter_module\(\s*[\"'][^\"']+[\"']\s*,\s*[\"']([^\"']+)[\"']")
_WORDS = {"bool": "bool", "int": "integer", "double": "double", "string": "string"}
_BOUNDS = {
    "bounds": (">=", "<="), "element_bounds": (">=", "<="), "gt": (">",), "lt": ("<",), "gt_eq": (">=",),
    "lt_eq": ("<=",), "lower_bounds": (">=",), "upper_bounds": ("<=",), "lower_element_bounds": (">=",),
    "upper_element_bounds": ("<=",),
}  # fmt: skip
_VALIDATION = "validation"


@cache_in_derived
def list_libraries(workspace: Workspace) -> dict[str, list[dict[str, ParameterTerms]]]:
    """The parameters of each file of generate_parameter_library by their names, by the root of the file, which is the
    namespace of what is generated."""
    files = {
        path for package in workspace for item in package.build.generated if item.how == "parameters"
        for path in item.files if path in package.files
    }  # fmt: skip
    for package in workspace:
        for path in {path for path, _ in package.linked.setup if path.endswith("setup.py")}:
            folder = posixpath.dirname(path)
            given = _OF_SETUP.findall(workspace.read(path).decode("utf-8", "replace"))
            files |= {posixpath.normpath(posixpath.join(folder, file)) for file in given} & set(package.files)
    looked: Mapping[str, ParameterFile] = workspace.extraction.look(sorted(files), "flow_parameters")
    found = ((root, terms) for path, file in looked.items() for root, terms in read_library(file, path))
    return group_pairs(found)


def read_library(file: ParameterFile, path: str) -> Iterator[tuple[str, dict[str, ParameterTerms]]]:
    """The root of a file, and its parameters by their names, in which `*` stands for a part that other parameters
    name."""
    fields: dict[tuple[str, ...], dict[str, ParameterEntry]] = {}
    for entry in file.entries:
        owner = entry.path[: entry.path.index(_VALIDATION)] if _VALIDATION in entry.path else entry.path[:-1]
        if len(owner) > 1:
            fields.setdefault(owner, {})[".".join(entry.path[len(owner) :])] = entry
    found: dict[str, dict[str, ParameterTerms]] = {}
    for owner, given in fields.items():
        type_ = given["type"].value if "type" in given else None
        if isinstance(type_, str):
            parts = ["*" if part.startswith("__map_") else part for part in owner[1:]]
            name = ".".join(parts)
            found.setdefault(owner[0], {})[name] = _read_terms(name, type_, given, path)
    yield from found.items()


def _read_terms(name: str, type_: str, given: Mapping[str, ParameterEntry], path: str) -> ParameterTerms:
    known = _TYPE.match(type_)
    word = f"{_WORDS[known[1]]}{' array' if known[2] else ''}" if known is not None else ""
    limits: list[Limit] = []
    choices: tuple[str, ...] = ()
    for key, entry in given.items():
        head, _, validator = key.partition(".")
        validator = validator.removesuffix("<>")
        value = entry.value
        if head != _VALIDATION:
            continue
        if validator == "one_of" and isinstance(value, list):
            choices = tuple(map(show_value, value[0] if len(value) == 1 and isinstance(value[0], list) else value))
        elif validator in _BOUNDS:
            bounds = value if isinstance(value, list) else [value]
            numbers = [float(one) for one in bounds if isinstance(one, (int, float)) and not isinstance(one, bool)]
            if len(numbers) == len(_BOUNDS[validator]) == len(bounds):
                limits += zip(_BOUNDS[validator], numbers, strict=True)
    return ParameterTerms(name, word, tuple(limits), choices, path, given["type"].line)


def find_terms(
    declared: Mapping[str, ParameterTerms], name: str, several: Sequence[tuple[list[str], ParameterTerms]]
) -> ParameterTerms | None:
    """What a declared parameter takes, by the name that is set. several: as list_open() gives them."""
    if name in declared:
        return declared[name]
    parts = name.split(".")
    for pattern, terms in several:
        if len(pattern) == len(parts) and all(one in ("*", part) for one, part in zip(pattern, parts, strict=True)):
            return terms
    return None


def list_open(declared: Mapping[str, ParameterTerms]) -> list[tuple[list[str], ParameterTerms]]:
    """Of declared parameters those that stand for several, each with the parts of its name."""
    return [(known.split("."), terms) for known, terms in declared.items() if "*" in known]
