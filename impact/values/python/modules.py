"""Modules of a workspace as the executor sees them: their classes, functions, constants and imports."""

from __future__ import annotations

import ast
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

FindModule = Callable[[str], "ModuleCode | None"]
"""The module of a dotted name, None for what is not in the workspace."""


@dataclass(slots=True)
class ModuleCode:
    """A file. names: what stands at its top, filled by the executor when the module is first needed."""

    name: str
    path: str
    tree: ast.Module
    names: dict[str, Any] = field(default_factory=dict)
    is_loaded: bool = False


@dataclass(frozen=True, slots=True)
class Outside:
    """Something of a module that is not in the workspace: `rospy.Publisher`, `geometry_msgs.msg.Twist`."""

    name: str

    def get(self, attribute: str) -> Outside:
        """A member of it."""
        return Outside(f"{self.name}.{attribute}")


@dataclass(slots=True)
class Scope:
    """Names of a function's call; outer: of the function around it, None at the top of a module."""

    module: ModuleCode
    names: dict[str, Any]
    outer: Scope | None = None
    outside: frozenset[str] = frozenset()
    """Names that `global` or `nonlocal` gives to an outer scope."""


@dataclass(slots=True)
class PythonFunction:
    """A function or lambda; scope: in which it was made."""

    node: ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda
    scope: Scope
    owner: PythonClass | None = None
    decorators: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """Its name, `lambda` for one without."""
        return "lambda" if isinstance(self.node, ast.Lambda) else self.node.name


@dataclass(slots=True)
class PythonClass:
    """A class of the workspace. bases: PythonClass, Outside or others."""

    node: ast.ClassDef
    module: ModuleCode
    bases: tuple[Any, ...]
    members: dict[str, Any]

    def find(self, name: str) -> Any:
        """A member of it or of its bases, None where there is none."""
        for one in self.list_order():
            if name in one.members:
                return one.members[name]
        return None

    def list_order(self) -> list[PythonClass]:
        """The class and its bases of the workspace, nearest first."""
        found: list[PythonClass] = [self]
        for base in self.bases:
            if isinstance(base, PythonClass):
                found.extend(one for one in base.list_order() if one not in found)
        return found

    def list_outside(self) -> list[str]:
        """Names of the bases that are not of the workspace."""
        return [base.name for one in self.list_order() for base in one.bases if isinstance(base, Outside)]


@dataclass(slots=True)
class PythonObject:
    """An object of a class of the workspace. written: members that were set since watching began."""

    cls: PythonClass
    members: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Unsettled:
    """A member of a node that began as None and may hold something by now; which of both is chosen when it is asked."""

    path: str


@dataclass(slots=True)
class BoundMethod:
    """A method with its object."""

    function: PythonFunction
    owner: Any


@dataclass(slots=True)
class Handle:
    """Something of ROS that a node keeps: kind `publisher`, `client`, `action`, `broadcaster`, `logger`, `clock`,
    `parameter`, `timer`, `subscription`, `lock`. name: in the code. content: what it is about."""

    kind: str
    name: str = ""
    content: Any = None


@dataclass(frozen=True, slots=True)
class KnownMethod:
    """A method of a value that the executor itself knows: of a text, a list, a handle, a message."""

    owner: Any
    name: str


@dataclass(slots=True)
class TimeValue:
    """A time or duration in nanoseconds: an int or a Whole. is_span: a duration."""

    nanoseconds: Any
    is_span: bool = False
