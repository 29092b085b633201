"""Literals of numbers as a program writes them out: `0x10` is 16."""

from __future__ import annotations

import re
from functools import lru_cache

_CPP_INTEGER = re.compile(r"(?P<sign>-?)(?:0[xX](?P<hex>[0-9a-fA-F]+)|0[bB](?P<bits>[01]+)|(?P<plain>\d+))[uUlLzZ]*\Z")
_PYTHON_INTEGER = re.compile(r"(?P<sign>-?)(?:0[xX](?P<hex>[0-9a-fA-F]+)|0[bB](?P<bits>[01]+)|0[oO](?P<octal>[0-7]+)"
                         r"|(?P<plain>\d+))\Z")  # fmt: skip
_PYTHON_FLOAT = re.compile(r"-?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?\Z")
_LONGEST = 40


@lru_cache(maxsize=10_000)
def spell_number(text: str, is_cpp: bool) -> str:
    """A number of a source as the program writes it: in decimal, and of Python a float as `str()` has it. What is no
    such literal stays as it is. is_cpp: whether it is of C++, where a leading 0 makes it octal."""
    if len(text) > _LONGEST or (not text[-1:].isalnum() and text[-1:] != "."):
        return text
    plain = text.replace("'", "") if is_cpp else text.replace("_", "")
    found = (_CPP_INTEGER if is_cpp else _PYTHON_INTEGER).match(plain)
    if found is None:
        return str(float(plain)) if not is_cpp and _PYTHON_FLOAT.match(plain) else text
    parts = found.groupdict()
    if parts["hex"] or parts["bits"] or parts.get("octal"):
        number = int(parts["hex"] or parts["bits"] or parts["octal"], 16 if parts["hex"] else 2 if parts["bits"] else 8)
    else:
        octal = is_cpp and len(parts["plain"]) > 1 and parts["plain"][0] == "0"
        if octal and parts["plain"].strip("01234567"):
            return text
        number = int(parts["plain"], 8 if octal else 10)
    return f"{parts['sign']}{number}"
