"""Lines of text that fit a terminal: broken between pieces first, then between words; paths lose their middle."""

import sys
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from ...edges.console import escape
from ..analysis.report import measure
from .style import Style, paint

UNBROKEN = sys.maxsize
"""A width at which no line is broken: for files and pipes, where a line is what `grep` finds."""
_BETWEEN = "  "
_LEAST = 20


class LinePart(NamedTuple):
    """Part of a line. role: how it is painted. path: `path:line` after the text; a piece with one is not broken, but
    may lose folders. hang: columns before its further lines, for one that begins where it stands."""

    text: str
    role: str = ""
    path: str = ""
    hang: int | None = None


def lay_out(pieces: Sequence[LinePart], style: Style, indent: int, hang: int) -> Iterator[str]:
    """One line of pieces with two spaces between them, or as many as the style's width asks for.

    What the pieces hold is shown escaped where a terminal or CI would obey it. indent: columns before the first line,
    hang: before those that follow. A word that is longer than a line stands on one of its own.
    """
    line, used, gap = " " * indent, indent, ""
    for piece in pieces:
        room = max(_LEAST, style.width - hang)
        reported = escape(piece.text)
        text = reported + shorten_path(escape(piece.path), room - measure(reported))
        if gap and piece.hang is None and used + len(gap) + measure(text) > style.width:
            yield line
            line, used, gap = " " * hang, hang, ""
        inner = hang if piece.hang is None else piece.hang
        first, *others = [text] if piece.path else _wrap_words(text, style.width - used - len(gap), style.width - inner)
        line, used = line + gap + paint(style, piece.role, first), used + len(gap) + measure(first)
        for other in others:
            yield line
            line, used = " " * inner + paint(style, piece.role, other), inner + measure(other)
        gap = _BETWEEN
    yield line


def _wrap_words(text: str, first: int, room: int) -> list[str]:
    """The text as lines broken at spaces: one of at most `first` columns, then of at most `room`."""
    if measure(text) <= first:
        return [text]
    margin = text[: len(text) - len(text.lstrip())]
    lines = [""]
    for word in text.split():
        longer = f"{lines[-1]} {word}" if lines[-1] else word
        if lines[-1] and measure(longer) > max(_LEAST, room if lines[1:] else first - len(margin)):
            lines.append(word)
        else:
            lines[-1] = longer
    return [margin + lines[0], *lines[1:]]


def shorten_path(path: str, room: int) -> str:
    """A path that is too long without some of its folders: the file's name says most, then the first folder."""
    if measure(path) <= room:
        return path
    folders = path.split("/")
    shorter = ["/".join([folders[0], "...", *folders[cut:]]) for cut in range(2, len(folders))]
    if len(folders) > 1:
        shorter.append(f".../{folders[-1]}")
    return next((each for each in shorter if measure(each) <= room), shorter[-1] if shorter else path)
