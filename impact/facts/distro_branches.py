"""What a file does for some distros alone: branches on ROS_DISTRO, and the names of distros that it compares this
variable with."""

from __future__ import annotations

import re
from collections.abc import Iterator

import msgspec

from .condition import Condition

VARIABLE = "ROS_DISTRO"


class Branch(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A way through an `if` after which a name is bound, or that does not come out of it. conditions: under which it is
    taken."""

    conditions: tuple[Condition, ...]


class BranchedName(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """What is there in branches alone which ask for the distro. kind: `name` (of Python, or an argument of a launch
    file; line, column: where it is used whichever branch was taken), `start` (what launch files start; the place and
    name are those of the first branch), or `key` (a table that is asked by the distro, with a branch for each entry).
    function: the function that they are in; empty outside of all."""

    name: str
    line: int
    column: int
    branches: tuple[Branch, ...]
    function: str = ""
    kind: str = "name"


class ComparedDistro(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A text that ROS_DISTRO is compared with."""

    name: str
    line: int
    column: int = 0


# Tests of CMake and of package.xml: what is compared on the other side, or looked through.
_VARIABLE = r"(?<![\w{])\"?(?:\$(?:ENV)?\{)?\$?ROS_DISTRO\b\}?\"?"
_COMPARED = re.compile(
    rf"{_VARIABLE}\s+(?:STREQUAL|MATCHES|IN_LIST|==|!=)\s+(?P<right>\S+)"
    rf"|(?P<left>\S+)\s+(?:STREQUAL|==|!=)\s+{_VARIABLE}"
)
_WORD = re.compile(r"(?<![\w$.{-])[A-Za-z]{4,}(?![\w.}-])")


def list_compared_words(test: str) -> Iterator[str]:
    """The words that a test of CMake or package.xml compares ROS_DISTRO with."""
    for found in _COMPARED.finditer(test):
        yield from _WORD.findall(found["right"] or found["left"])
