"""A translation unit of a harness."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from .cuts import SourceCuts
from .stubs import StubTable

_OPTIONAL = re.compile(
    r"\s+ri::(?:name_member|fill_state|fill_rising|watch_member|forget|forget_cut|make_member|set_member)\("
)


@dataclass
class SourceUnit:
    """A translation unit. text: what is compiled; blocks: first and last line of each part of it that may be left out,
    by name; standard: of C++, the last two digits of its year; definitions: of the preprocessor. stubs: what stands for
    headers that are not here; missing: these headers. boost: whether our headers of Boost are used. is_c: it is of C:
    nothing is stood for in it, and it is compiled as it is or not at all."""

    name: str
    text: str
    blocks: dict[str, tuple[int, int]] = field(default_factory=dict)
    standard: int = 17
    definitions: tuple[str, ...] = ()
    folders: tuple[str, ...] = ()
    stubs: StubTable | None = None
    missing: list[str] = field(default_factory=list)
    boost: bool = True
    is_c: bool = False
    dropped: dict[str, str] = field(default_factory=dict)
    cuts: SourceCuts | None = None
    """What is left out of the sources."""


def is_optional_line(line: str) -> bool:
    """Whether a line of a harness may be left out on its own: what is done to one member."""
    return _OPTIONAL.match(line) is not None
