"""How text looks on a terminal: colours, symbols, width."""

import os
import shutil
from collections.abc import Mapping
from typing import NamedTuple, TextIO

_COLOURS = {"error": "1;31", "warning": "1;33", "note": "1;36", "dim": "2", "bold": "1", "good": "32", "help": "36"}


class Style(NamedTuple):
    """How to write. symbols: error, warning, ok, arrow, dot of matrix and separators. colours: terminal codes by role,
    empty for none. severities: those whose findings are written out; the rest is counted. width: columns."""

    symbols: tuple[str, str, str, str, str] = ("✗", "!", "·", "→", "·")
    colours: Mapping[str, str] = {}
    severities: tuple[str, ...] = ("error", "warning")
    width: int = 120


ASCII_SYMBOLS = ("x", "!", ".", "->", "-")
PLAIN = Style()


def choose_style(stream: TextIO, *, severities: tuple[str, ...] = PLAIN.severities) -> Style:
    """The style that suits a stream: colours on a terminal unless NO_COLOR is set or TERM is dumb (FORCE_COLOR asks for
    them elsewhere), ASCII where the encoding is not Unicode, the terminal's width."""
    encoding = (getattr(stream, "encoding", None) or "ascii").lower().replace("-", "")
    terminal = bool(getattr(stream, "isatty", lambda: False)())
    coloured = terminal and os.environ.get("TERM") != "dumb"
    if os.environ.get("FORCE_COLOR"):
        coloured = True
    if os.environ.get("NO_COLOR"):
        coloured = False
    return Style(
        symbols=PLAIN.symbols if encoding.startswith("utf") else ASCII_SYMBOLS,
        colours=_COLOURS if coloured else {},
        severities=severities,
        width=max(40, shutil.get_terminal_size((120, 40)).columns) if terminal else PLAIN.width,
    )


def paint(style: Style, role: str, text: str) -> str:
    code = style.colours.get(role)
    return f"\x1b[{code}m{text}\x1b[0m" if code else text
