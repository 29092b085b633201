"""CMake sources to commands, as cmake-language(7) defines them. Meaning is given by model/build.py."""

import msgspec

from .place import Problem


class Argument(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """One argument: its raw text (references not expanded, escapes kept), how it was quoted, where it starts.

    quoting: `` for unquoted, `"` for quoted, `[` for bracket arguments.
    """

    text: str
    quoting: str
    line: int
    column: int


class Command(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """One command invocation. name is in lower case, arguments in order; nested parentheses appear as `(` and `)`."""

    name: str
    arguments: tuple[Argument, ...]
    line: int
    column: int
    end_line: int


class CMakeFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """All commands of a file in order, flat; block structure is made by the interpreter."""

    commands: tuple[Command, ...]
    problems: tuple[Problem, ...] = ()
