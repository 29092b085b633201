"""Python sources to facts: imports, names used, and mentions of packages (launch files in Python included)."""

import msgspec

from .condition import Condition
from .place import Problem, Reference


class Import(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """`import module` or `from module import names`. level counts leading dots. lazy: inside a function."""

    module: str
    names: tuple[str, ...]
    level: int
    line: int
    column: int
    lazy: bool = False
    conditions: tuple[Condition, ...] = ()


class Attribute(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """The first use of a dotted name whose head is an imported module or name, import aliases resolved
    (`import time as t; t.clock()` gives `time.clock`)."""

    text: str
    line: int
    column: int
    conditions: tuple[Condition, ...] = ()


class PythonFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """python2_only: (line, what) of syntax that Python 3 refuses (print statement, except X, e, backticks ...), found
    when the file does not parse. needs: the highest minor version of Python 3 its syntax asks for, with line and reason
    (match: 10, except*: 11, type parameters: 12, ...), or None. executable: has a `python` shebang; interpreter: that
    line. main: has an `if __name__ == '__main__'` block."""

    imports: tuple[Import, ...]
    attributes: tuple[Attribute, ...]
    references: tuple[Reference, ...]
    python2_only: tuple[Problem, ...] = ()
    needs: tuple[int, int, str] | None = None
    interpreter: str = ""
    main: bool = False
    problems: tuple[Problem, ...] = ()
