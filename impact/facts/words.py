"""The words of a file: what tells cheaply that it cannot have what is looked for."""

import re
from collections.abc import Collection

_WORD = re.compile(rb"[A-Za-z_]\w*")


def list_words(data: bytes) -> str:
    """The distinct words of a file, those of comments and literals too, sorted and joined by blanks."""
    return b" ".join(sorted(set(_WORD.findall(data)))).decode()


def mentions(name: str, words: Collection[str]) -> bool:
    """False where the words of a file show that a name does not stand in it."""
    return all(word.decode() in words for word in _WORD.findall(name.encode()))
