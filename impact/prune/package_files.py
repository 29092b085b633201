"""Edits of CMakeLists.txt and package.xml for lighter messages."""

from __future__ import annotations

import re

from ..rules.fix_actions import Edit

_COMMENT = re.compile(rb"#[^\n]*")
_GLOB = re.compile(rb"(?is)\bfile\s*\(\s*GLOB\w*[^)]*\.msg|\badd_message_files\s*\((?:(?!FILES)[^)])*\)")


def list_messages(path: str, data: bytes, old: str, new: list[str]) -> list[Edit] | None:
    """The edits of a CMakeLists.txt that name new messages wherever it names an old one; none where it takes all files
    of a folder. None where it names it nowhere. old, new: names of messages."""
    blank = _COMMENT.sub(lambda match: b" " * len(match[0]), data)
    pattern = re.compile(rb"(?P<quote>\"?)(?P<folder>[\w./${}-]*?)\b" + old.encode() + rb"\.msg(?P=quote)(?![\w.])")
    edits: list[Edit] = []
    for match in pattern.finditer(blank):
        start = blank.rfind(b"\n", 0, match.start()) + 1
        before = blank[start : match.start()]
        between = "\n" + before.decode() if not before.strip() else " "
        quote, folder = match["quote"].decode(), match["folder"].decode()
        text = "".join(f"{between}{quote}{folder}{name}.msg{quote}" for name in new)
        edits.append(Edit(path, match.end(), match.end(), text))
    if not edits and not _GLOB.search(blank):
        return None
    return edits
