"""What one Python module offers: the names it binds, with parameters, defaults, decorators and deprecations.

Nothing outside of the file is looked at: what an import or a base class means is resolved by the join
(targets/surface/python.py).
"""

import ast
from collections.abc import Iterator

import msgspec

from ..condition import Condition
from ..place import Problem
from .text import get_source, list_parameters


class PythonParameter(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A parameter. kind: `positional` (before `/`), `normal`, `keyword` (after `*`), `args` (`*args`) or `kwargs`.
    default: its source, white space and quotes made even; None for a parameter that must be given. annotation: its
    source, empty for none."""

    name: str
    kind: str = "normal"
    default: str | None = None
    annotation: str = ""


class Bound(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A name that the module, or a class of it, binds. The same name may come several times; the last one that runs
    holds.

    name: dotted inside classes (`Node.create_timer`). kind: `class`, `function`, `method`, `classmethod`,
    `staticmethod`, `property`, `attribute`, or `instance` (assigned to `self` in a method). parameters: without `self`
    or `cls`; of a property none. value: of an attribute, its source where it is a literal of at most 80 characters.
    annotation: of an attribute; what a function or property returns. bases: of a class. decorators: as dotted paths.
    deprecated: the message of a deprecation, `deprecated` where it has none, empty for what is not. conditions:
    the `if` and `try` it stands under. A condition with the text `late` is added where only a function that runs
    (`global x`) binds it.
    """

    name: str
    kind: str
    line: int
    parameters: tuple[PythonParameter, ...] = ()
    annotation: str = ""
    value: str = ""
    bases: tuple[str, ...] = ()
    decorators: tuple[str, ...] = ()
    deprecated: str = ""
    conditions: tuple[Condition, ...] = ()

    @property
    def private(self) -> bool:
        """True where a leading underscore in any part says that others should not use it; `__init__` and its kin are
        not private."""
        return any(is_private(part) for part in self.name.split("."))


class ImportedName(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A name bound by an import. name: what it is called here, `*` for all of a module. module: as written, without
    the leading dots that level counts. original: the name over there, empty for the module itself (`import a.b` binds
    `a` and has module `a.b`). scope: the class whose body imports, empty for the module."""

    name: str
    module: str
    level: int
    original: str
    line: int
    scope: str = ""
    conditions: tuple[Condition, ...] = ()


class ModuleSurface(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """What a module offers.

    all: the literal part of `__all__`, None where there is none. all_open: more is put into it than can be known; a
    module whose `__all__` is added to is named as `+module`. open: (scope, why) of the module (empty scope) or of
    classes that may have more names than are listed: a module's `__getattr__`, `globals()[...] = `, `setattr` and kin,
    a metaclass or `__getattr__` of a class. deprecated: of the whole module. parsed: False for a file that could not be
    read, whose names are then not known.
    """

    names: tuple[Bound, ...]
    imports: tuple[ImportedName, ...]
    all: tuple[str, ...] | None = None
    all_open: bool = False
    open: tuple[tuple[str, str], ...] = ()
    deprecated: str = ""
    parsed: bool = True
    problems: tuple[Problem, ...] = ()


LATE = Condition("python", "late")


def is_private(part: str) -> bool:
    """True for `_x` and `__x`, not for `__x__`."""
    return part.startswith("_") and not (part.startswith("__") and part.endswith("__") and len(part) > 4)


def make_parameters(arguments: ast.arguments) -> Iterator[PythonParameter]:
    """Parameters in order, `self` and `cls` among them."""
    for kind, argument, default in list_parameters(arguments):
        annotation = unparse_even(argument.annotation) if argument.annotation is not None else ""
        yield PythonParameter(argument.arg, kind, None if default is None else unparse_even(default), annotation)


def unparse_even(node: ast.AST) -> str:
    """An expression's source, written evenly."""
    if isinstance(node, ast.Name):
        return node.id
    if isinstance(node, ast.Constant):
        return "..." if node.value is ... else repr(node.value).encode("utf-8", "replace").decode()
    if isinstance(node, ast.Attribute):
        return f"{unparse_even(node.value)}.{node.attr}"
    return get_source(node)
