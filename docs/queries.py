"""Prints docs/queries.md, what a rule can ask: `python docs/queries.py > docs/queries.md`."""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Iterator
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from rosimpact.impact.facts.manifest import Manifest
from rosimpact.impact.model.cmake.build import Build
from rosimpact.impact.model.view import View
from rosimpact.impact.model.workspace import Workspace
from rosimpact.impact.rules.rule import Diagnostic

START = (View, Workspace, Diagnostic, Manifest, Build)
STEPS = 2
HEAD = """\
# What a rule can ask

A rule gets a `View`: the workspace (`view.workspace`) as one target (`view.target`) sees it. It yields `Diagnostic`s.
Of a package, `package.manifest` is what its package.xml says and `package.build` what its CMakeLists.txt or setup.py
builds. These are their public attributes and methods, and those of the types that they return, each with the first
sentence of its docstring. What no row explains is explained where the type is defined.
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
                yield owner, Row(name, str(getattr(gives, "__forward_arg__", gives)), "")
        for name, value in vars(owner).items():
            if name.startswith("_") or name in annotations:
                continue
            if isinstance(value, (property, cached_property)):
                function = value.fget if isinstance(value, property) else value.func
                yield owner, Row(name, returned(function), first_sentence(function))
            elif isinstance(value, (staticmethod, classmethod)) or inspect.isfunction(value):
                function = value.__func__ if isinstance(value, (staticmethod, classmethod)) else value
                parameters = [each for each in inspect.signature(function).parameters if each not in ("self", "cls")]
                yield owner, Row(f"{name}({', '.join(parameters)})", returned(function), first_sentence(function))


def returned(function: object) -> str:
    """The annotation of what a function returns, empty without one."""
    return str(getattr(function, "__annotations__", {}).get("return", ""))


def first_sentence(of: object) -> str:
    """The first sentence of a docstring, empty without one."""
    text = " ".join((getattr(of, "__doc__", None) or "").partition("\n\n")[0].split())
    match = re.match(r".+?[.;](?=\s|\Z)", text)
    return (match.group() if match else text).rstrip(".;")


def print_type(kind: type) -> str:
    """The section of a type."""
    path = "../" + kind.__module__.removeprefix("rosimpact.").replace(".", "/") + ".py"
    if not (Path(__file__).parent / path).exists():
        path = path.removesuffix(".py") + "/__init__.py"
    rows = [row for _, row in find_rows(kind)]
    lines = [f"\n## `{kind.__name__}`\n", f"{first_sentence(kind)}. Defined in [{path.removeprefix('../')}]({path}).\n"]
    lines += ["| | gives | |", "|---|---|---|"]
    for row in rows:
        gives = f"`{row.gives}`".replace("|", "\\|") if row.gives else ""
        lines.append(f"| `{row.use}` | {gives} | {row.says.replace('|', chr(92) + '|')} |")
    return "\n".join(lines) + "\n"


def page() -> str:
    """The text of docs/queries.md."""
    return HEAD + "".join(print_type(kind) for kind in find_types())


if __name__ == "__main__":
    print(page(), end="")
