"""Which names a block of a Python source binds, and which are there without."""

import ast
import builtins
from typing import Any

from .text import iterate_children, list_imported

PYTHON2_BUILTINS = frozenset((
    "StandardError", "apply", "basestring", "buffer", "cmp", "coerce", "execfile", "file", "intern", "long",
    "raw_input", "reduce", "reload", "unichr", "unicode", "xrange",
))  # fmt: skip
"""Names that are there without an import in Python 2 alone. Source: the documentation of the standard library."""
PYTHON2_METHODS = frozenset(("has_key", "iteritems", "iterkeys", "itervalues", "viewitems", "viewkeys", "viewvalues"))
"""Methods of dictionaries in Python 2 alone. Source: "What's New In Python 3.0"."""
# What modules, classes and sessions have besides, and what only some versions or machines have. Source: as above.
ALWAYS = frozenset(dir(builtins)) | {
    "__annotations__", "__builtins__", "__class__", "__dict__", "__file__", "__module__", "__path__", "__qualname__",
    "BaseExceptionGroup", "EncodingWarning", "ExceptionGroup", "PythonFinalizationError", "WindowsError", "_", "aiter",
    "anext", "display", "get_ipython", "profile", "reveal_type",
}  # fmt: skip
# What may bind names that no scope shows.
DYNAMIC = frozenset(("__builtin__", "__builtins__", "__getattr__", "builtins", "exec", "execfile", "globals", "locals",
                     "vars"))  # fmt: skip
_SCOPES = frozenset((ast.AsyncFunctionDef, ast.ClassDef, ast.FunctionDef, ast.Lambda))
COMPREHENSIONS = frozenset((ast.DictComp, ast.GeneratorExp, ast.ListComp, ast.SetComp))


def list_bound_names(body: list[ast.stmt]) -> set[str]:
    """Names that statements bind in the scope that they stand in."""
    found: set[str] = set()
    rest: list[tuple[Any, bool]] = [(node, False) for node in body]
    for node, inside in rest:
        cls = node.__class__
        if cls is ast.Name:
            if node.ctx.__class__ is not ast.Load and not inside:
                found.add(node.id)
        elif cls is ast.Import or cls is ast.ImportFrom:
            found.update(name for name, _ in list_imported(node))
        else:
            for name in (getattr(node, "name", None), getattr(node, "rest", None)):
                if isinstance(name, str):
                    found.add(name)
            if cls not in _SCOPES:
                if cls is ast.NamedExpr:
                    found.add(node.target.id)
                inner = inside or cls in COMPREHENSIONS
                rest += [(child, inner) for child in iterate_children(node)]
    return found
