"""What a rule proposes to change, by name and place. Rules see no bytes; fix.py makes byte edits of it."""

from typing import NamedTuple


class Declare(NamedTuple):
    """Declare a dependency in a manifest. tag: as format 2 and 3 know it (`depend`, `exec_depend`, ...)."""

    path: str
    name: str
    tag: str = "depend"


class Remove(NamedTuple):
    """Take a dependency out of a manifest: one tag of it, or all when tag is empty."""

    path: str
    name: str
    tag: str = ""


class Replace(NamedTuple):
    """Replace `old`, which stands at a line and column (characters, from 1), by `new`. column 0: the only one."""

    path: str
    line: int
    column: int
    old: str
    new: str


class Insert(NamedTuple):
    """Put lines behind a line (0: at the start of the file), with that line's indentation; in CMake, behind the command
    that the line belongs to. text: without a line end."""

    path: str
    line: int
    text: str
