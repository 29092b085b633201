"""What one C++ file declares and uses, as plain data: nothing here is resolved across files.

Types and names are text as written, with single blanks.
"""

from __future__ import annotations

from typing import NamedTuple

import msgspec

from ..condition import Condition
from ..place import Problem


class CodeSpot(NamedTuple):
    """Where a name stands: line and column, from 1, and the preprocessor conditions around it; None in a directive."""

    line: int
    column: int
    conditions: tuple[Condition, ...] | None = ()


class WrittenParameter(NamedTuple):
    """A parameter of a function. type: as written, with `&` and `*`. default: as written, None for none."""

    type: str
    name: str = ""
    default: str | None = None


class Declaration(NamedTuple):
    """A function, method, variable, field, alias, enumerator or nested type. at: of a method, where its name stands.

    kind: `function`, `variable`, `alias`, `enumerator` or `type`. name: its last part. scope: the namespaces and
    classes around it, with those that are written before a name that is defined outside of them. type: result, type,
    or what an alias stands for. value: what a variable of type `auto` begins with. traits: those of virtual, pure,
    override, final, const, static, deleted and template that hold, and split: a directive stands in it, so that which
    parameters it has depends on that. template: names of template parameters."""

    kind: str
    name: str
    scope: str
    type: str = ""
    parameters: tuple[WrittenParameter, ...] = ()
    traits: frozenset[str] = frozenset()
    template: tuple[str, ...] = ()
    value: Expr | None = None
    at: CodeSpot | None = None


class CppClass(NamedTuple):
    """A class that is defined. name: in full. at: where its name stands. bases: as written. members: by name. template:
    names of template parameters. specialised: template arguments stand behind its name. open: something in it was not
    understood, so that it may have other members."""

    name: str
    at: CodeSpot
    bases: tuple[str, ...]
    members: dict[str, list[Declaration]]
    template: tuple[str, ...] = ()
    specialised: bool = False
    open: bool = False


class FileDeclarations(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """What a file declares outside of functions, in its order; aliases are among the names."""

    classes: tuple[CppClass, ...] = ()
    names: tuple[Declaration, ...] = ()
    problems: tuple[Problem, ...] = ()


class Local(NamedTuple):
    """What a name means inside a function: a variable or parameter. how: `variable`, `parameter`, `binding`,
    `function`, `alias` or `template`. value: what it begins with, where that is written. apart: a directive stands
    between its declaration and its use, which may leave one of them out."""

    how: str
    type: str
    value: Expr | None
    offset: int
    apart: bool = False


class Expr(NamedTuple):
    """An expression.

    | kind | text | parts |
    |---|---|---|
    | name | qualified, without template arguments | |
    | member | its name | the object |
    | call | | what is called, then the arguments |
    | braces | the type, empty where none is written | the values |
    | new, cast | the type | the values |
    | index | | the object, then the indices |
    | unary, binary | the operator | the operands |
    | conditional | | both values |
    | each | | the container that a loop runs through |
    | part | its place, `/` and the number of parts | the value that a structured binding takes apart |
    | literal | `text`, `float`, `integer`, `bool` or `null` | |
    | this, lambda, pack, other | | |

    arrow: the member is reached by `->`. template: template arguments that are written. local: of a name, what it
    means inside the function; None for what is declared elsewhere."""

    kind: str
    text: str
    offset: int
    parts: tuple[Expr, ...] = ()
    arrow: bool = False
    template: tuple[str, ...] | None = None
    local: Local | None = None


class CodePlace(NamedTuple):
    """Where a piece of code stands. scope: namespaces and classes around it, in full. owner: the class in whose method
    it is, as far as the file tells, else empty; it may be written without its namespaces. function: it is inside of
    one. opened: namespaces that the blocks around it open. used: names that they make known, in full."""

    scope: str
    owner: str
    function: bool
    opened: tuple[str, ...] = ()
    used: tuple[str, ...] = ()


class CppUse(NamedTuple):
    """A place where a word stands in code, and is not declared there. at: where it is.

    form: `member` (object.word), `scoped` (a::word), `bare`, `initializer` (of a base class or member), or `assigned`
    (object += ...). name: qualified, as written, without template arguments. object: of a member. call: the arguments
    of the call or construction it begins, None where there is none. made: it is the type of what is constructed.
    braced: by `{}`, which may be an aggregate's. template: template arguments behind it. local: what a bare word means
    inside the function. last: it is not followed by `::`."""

    word: str
    at: CodeSpot
    form: str
    name: str
    place: CodePlace
    object: Expr | None = None
    arrow: bool = False
    call: tuple[Expr, ...] | None = None
    made: bool = False
    template: tuple[str, ...] | None = None
    local: Local | None = None
    last: bool = True
    braced: bool = False
