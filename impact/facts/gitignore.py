"""A .gitignore file to its patterns, as gitignore(5) defines them."""

import msgspec

from .markup import decode
from .place import Problem


class IgnoreFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """The patterns of a file in order, comments and blank lines left out; negated ones keep their `!`."""

    patterns: tuple[str, ...] = ()
    problems: tuple[Problem, ...] = ()


def extract(data: bytes) -> IgnoreFile:
    """The patterns of a .gitignore file; never raises."""
    lines = (line.rstrip() for line in decode(data).splitlines())
    return IgnoreFile(tuple(line for line in lines if line and not line.startswith("#")))
