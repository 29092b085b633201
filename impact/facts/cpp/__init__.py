"""C++: the first look at a file (lexical.py), and a closer one at its syntax where somebody asks (code.py)."""

from .lexical import (
    EXPORTING,
    KEYWORDS,
    CppFile,
    Include,
    Name,
    Scan,
    exports_of,
    extract,
    includes_of,
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
    "Name",
    "Scan",
    "exports_of",
    "extract",
    "includes_of",
    "places_of",
    "scan",
    "standing",
    "text_of",
]
