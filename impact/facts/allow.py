"""The comments that silence a rule: `rosimpact: allow(rule, rule)` in the comment syntax of any file type."""

import re

from ...edges.limits import get_limits
from .place import Allow

MARK = b"rosimpact:"
# `#` and `//` open a comment that the line's end closes; `<!--` and `/*` are closed by what follows the parenthesis.
COMMENT = re.compile(
    rb"^(?P<before>.*?)(?:#|//|<!--|/\*|%|;|--)\s*rosimpact:\s*allow\((?P<rules>[A-Za-z0-9_\-*,\s]*)\)"
)
NAME = re.compile(rb"[A-Za-z0-9_*-]+")


def allows(data: bytes) -> tuple[Allow, ...]:
    """All such comments of a file, in order, up to the limit of items. own_line is True where nothing but the comment
    stands on the line."""
    at = data.find(MARK)
    if at == -1:
        return ()
    found: list[Allow] = []
    line, counted = 1, 0
    most = get_limits().items
    while at != -1 and len(found) < most:
        start = data.rfind(b"\n", 0, at) + 1
        end = data.find(b"\n", at)
        end = len(data) if end == -1 else end
        line += data.count(b"\n", counted, start)
        counted = start
        comment = COMMENT.match(data[start:end])
        if comment is not None:
            rules = tuple(name.decode("ascii") for name in NAME.findall(comment["rules"]))
            if rules:
                found.append(Allow(line, rules, not comment["before"].strip()))
        at = data.find(MARK, end)
    return tuple(found)
