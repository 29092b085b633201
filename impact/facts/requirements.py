"""requirements.txt to facts: the Python packages that it lists."""

import re

import msgspec

from .markup import decode
from .place import Problem


class Requirement(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A requirement as it is written, `numpy<1.24; python_version < "3.9"`, and its line."""

    text: str
    line: int


class RequirementsFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """The requirements of a file, without its options and what it names by an address or path."""

    requirements: tuple[Requirement, ...] = ()
    problems: tuple[Problem, ...] = ()


_STARTS = re.compile(r"[A-Za-z0-9]")
_COMMENT = re.compile(r"(?:^|\s)#")
# What pip takes after a requirement: hashes and settings of its build.
_OPTION = re.compile(r"\s--?[a-z]")


def extract(data: bytes) -> RequirementsFile:
    """Facts of a requirements.txt; never raises."""
    found: list[Requirement] = []
    for number, line in enumerate(decode(data).split("\n"), 1):
        text = _OPTION.split(_COMMENT.split(line, 1)[0], 1)[0].rstrip("\\ \t\r").strip()
        if _STARTS.match(text) and "/" not in text:
            found.append(Requirement(text, number))
    return RequirementsFile(tuple(found))
