"""Prints docs/queries.md, what a rule can ask: `python docs/queries.py > docs/queries.md`."""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Collection, Iterator
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from rosimpact.edges.memory import CachedMethod
from rosimpact.impact.facts.manifest import Manifest
from rosimpact.impact.facts.setup import SetupFile
from rosimpact.impact.model.cmake.build import Build
from rosimpact.impact.model.cpp.lost_headers import LostHeaders
from rosimpact.impact.model.package import LinkedPackage
from rosimpact.impact.model.python.programs import ScriptSetup
from rosimpact.impact.model.undeclared_parameters import UndeclaredParameter
from rosimpact.impact.model.view import TargetView
from rosimpact.impact.model.workspace import Package, Workspace
from rosimpact.impact.rules.rule import Diagnostic

START = (
    *(TargetView, Package, LinkedPackage, Manifest, Build, SetupFile, Workspace, Diagnostic),
    *(LostHeaders, ScriptSetup, UndeclaredParameter),
)
STEPS = 2
HEAD = """\
# What a rule can ask

A rule gets a `TargetView`: the workspace (`view.workspace`) as one target (`view.target`) sees it, and yields
`Diagnostic`s.

| to know | ask |
|---|---|
| which packages to report on, and all of them | `for package in view`, `for package in view.list_built()` |
| a package of the workspace by its name | `view.workspace.packages` |
| what package.xml says | `package.manifest` |
| what builds it: `ament_python`, `catkin` ... | `package.build_type` |
| what CMakeLists.txt builds, installs and exports | `package.build` |
| what setup.py, setup.cfg and pyproject.toml install | `package.linked.setup` |
| what its files include and import | `package.linked.includes`, `package.linked.imports` |
| which programs, files and plugins its launch files and scripts mention | `package.linked.references` |
| what a package uses of others, with who provides it | `view.list_needs(package)` |
| which ROS, which distro, which version of a package or library | `view.target` |
| whether something outside of the workspace is there | `view.find_availability(symbol)` |
| whether something that nobody is known to have may be there all the same | `view.unknown_contents.may_hold(...)` |
| what CMake finds along with packages, and what a package has at hand in a role | `view.roles` |
| what targets link, pass on and are given by name | `model/cmake/links.py` |
| what is linked of Boost, and what catkin packages hand on | `model/cmake/boost.py`, `model/cmake/catkin_links.py` |
| which header an include path that nobody has was meant to be | `model/absent_headers.py` |
| which C++ standard targets are compiled under | `find_standards(view, package)` of `model/standards.py` |
| which header brings a name, where nothing that a file includes does | `LostHeaders(view, package).find(need)` |
| which programs an ament_python package installs, and where | `ScriptSetup(package)` |
| which parameters are set that the target does not declare | `list_undeclared_parameters(view, package)` |

These are the public attributes and methods of these types and of those that they return. What is not explained here is
explained where the type is defined.
"""


class Row(NamedTuple):
    """One attribute or method: how it is written, what it gives, the first sentence of its docstring."""

    use: str
    gives: str
    says: str


def find_types() -> list[type]:
    """The types that rules begin with, and those that they lead to in a few steps, nearest first."""
    found: dict[type, None] = dict.fromkeys(START)
    nearest = list(START)
    for _ in range(STEPS):
        nearest = [other for kind in nearest for other in find_named(kind) if other not in found]
        found.update(dict.fromkeys(nearest))
    return list(found)


def find_named(kind: type) -> Iterator[type]:
    """Types of rosimpact that the attributes and methods of a type give."""
    for owner, gives in ((owner, row.gives) for owner, row in find_rows(kind)):
        names = vars(sys.modules[owner.__module__])
        for name in re.findall(r"\w+", gives):
            other = names.get(name)
            if inspect.isclass(other) and other.__module__.startswith("rosimpact.impact.") and list(find_rows(other)):
                yield other


def find_rows(kind: type) -> Iterator[tuple[type, Row]]:
    """The public attributes and methods of a type, with the class that defines each."""
    for owner in kind.__mro__:
        if not owner.__module__.startswith("rosimpact."):
            continue
        annotations = vars(owner).get("__annotations__", {})
        for name, gives in annotations.items():
            if not name.startswith("_"):
                yield owner, Row(name, name_type(gives), "")
        for name, value in vars(owner).items():
            if name.startswith("_") or name in annotations:
                continue
            if isinstance(value, (property, cached_property)):
                function = value.fget if isinstance(value, property) else value.func
                yield owner, Row(name, returned(function), first_sentence(function))
            elif isinstance(value, (staticmethod, classmethod, CachedMethod)) or inspect.isfunction(value):
                function = getattr(value, "__func__", value)
                parameters = [each for each in inspect.signature(function).parameters if each not in ("self", "cls")]
                yield owner, Row(f"{name}({', '.join(parameters)})", returned(function), first_sentence(function))


def name_type(annotation: object) -> str:
    """An annotation as it is written."""
    if isinstance(annotation, type) and not hasattr(annotation, "__args__"):
        return annotation.__name__
    return re.sub(r"[\w.]+\.(?=\w)", "", str(getattr(annotation, "__forward_arg__", annotation)))


def returned(function: object) -> str:
    """The annotation of what a function returns, empty without one."""
    return name_type(getattr(function, "__annotations__", {}).get("return", ""))


def first_sentence(of: object) -> str:
    """The first sentence of a docstring, empty without one."""
    text = " ".join((getattr(of, "__doc__", None) or "").partition("\n\n")[0].split())
    match = re.match(r".+?[.;](?=\s|\Z)", text)
    return (match.group() if match else text).rstrip(".;")


def explain(kind: type, names: Collection[str]) -> tuple[str, dict[str, str]]:
    """The docstring of a type: what it says of the type itself, and of each of these attributes (`name: ...` or
    `name, other: ...` at the start of a sentence)."""
    text = " ".join((inspect.getdoc(kind) or "").split()).replace("<", "&lt;")
    listed = "|".join(map(re.escape, names)) or r"(?!)"
    marks = list(re.finditer(rf"(?:\A|(?<=[.;:] ))((?:{listed})(?:, (?:{listed}))*): ", text))
    ends = [*(mark.start() for mark in marks), len(text)]
    of_each = {
        name: text[mark.end() : end].strip().rstrip(".;")
        for mark, end in zip(marks, ends[1:], strict=True)
        for name in mark[1].split(", ")
    }
    return text[: ends[0]].strip(), of_each


def print_type(kind: type) -> str:
    """The section of a type."""
    path = "../" + kind.__module__.removeprefix("rosimpact.").replace(".", "/") + ".py"
    if not (Path(__file__).parent / path).exists():
        path = path.removesuffix(".py") + "/__init__.py"
    rows = [row for _, row in find_rows(kind)]
    itself, of_each = explain(kind, [row.use for row in rows if "(" not in row.use])
    lines = [f"\n## `{kind.__name__}`\n", f"{itself} Defined in [{path.removeprefix('../')}]({path}).\n".lstrip()]
    lines += ["| | gives | |", "|---|---|---|"]
    for row in rows:
        gives = f"`{row.gives}`".replace("|", "\\|") if row.gives else ""
        says = row.says or of_each.get(row.use, "")
        lines.append(f"| `{row.use}` | {gives} | {says.replace('|', chr(92) + '|')} |")
    return "\n".join(lines) + "\n"


def page() -> str:
    """The text of docs/queries.md."""
    return HEAD + "".join(print_type(kind) for kind in find_types())


if __name__ == "__main__":
    print(page(), end="")
