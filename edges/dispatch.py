"""Methods that are found by what they are called, as ast.NodeVisitor finds them, but looked up once."""

from __future__ import annotations

import ast
from collections.abc import Callable
from typing import Any


def collect_methods(cls: type, prefix: str) -> dict[str, Callable[..., Any]]:
    """The methods of a class, those it inherits included, by what stands behind a prefix in their names."""
    return {name[len(prefix) :]: getattr(cls, name) for name in dir(cls) if name.startswith(prefix)}


def collect_node_methods(cls: type, prefix: str) -> dict[type, Callable[..., Any]]:
    """The same by the class of Python's syntax tree that is named, as far as this Python has it: `visit_If`."""
    return {getattr(ast, name): method for name, method in collect_methods(cls, prefix).items() if hasattr(ast, name)}
