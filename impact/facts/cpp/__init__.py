"""C++: what every check reads of a file (lexical.py), and its syntax where somebody asks: for names and types in use
(code.py), for what a header offers (surface.py), and for the flow of messages (flow.py)."""

from .lexical import (
    EXPORTING,
    KEYWORDS,
    CppFile,
    Include,
    NameUseInFile,
    Scan,
    beginning_lines,
    exports_of,
    extract,
    includes_of,
    line_starts,
    places_of,
    scan,
    standing,
    text_of,
)

__all__ = [
    "EXPORTING",
    "KEYWORDS",
    "CppFile",
    "Include",
    "NameUseInFile",
    "Scan",
    "beginning_lines",
    "exports_of",
    "extract",
    "includes_of",
    "line_starts",
    "places_of",
    "scan",
    "standing",
    "text_of",
]
