"""Text put into Markdown so that nothing in it acts: no link, mention, image or markup."""

import re
from collections.abc import Iterator

from ...edges.console import escape

_LONGEST = 300
_SPAN = re.compile(r"(`[^`]+`)")
_WORD = re.compile(r"\S+")
_LINKED = re.compile(r"@(?=\w)|#(?=\d)|\$|://|\bwww\.|\b(?:mailto|xmpp):|\bGH-(?=\d)", re.IGNORECASE)
_COMMIT = re.compile(r"\b[0-9a-f]{7,40}\b", re.IGNORECASE)


def escape_markdown(text: str) -> str:
    """Text that Markdown shows as it is on one line: what stands in single backticks is code, all else is inert.

    Words that GitHub makes a link of (mentions, issues, commits, addresses) are code too: nothing else stops it.
    """
    parts: list[str] = []
    for index, part in enumerate(_SPAN.split(escape(text))):
        shown = quote(part[1:-1]) if index % 2 else _disable_links(part)
        # Two spans that touch would be one with other ends.
        touches = parts and parts[-1].endswith("`") and shown.startswith("`")
        parts += [f" {shown}" if touches else shown] if shown else []
    return "".join(parts)


def _disable_links(text: str) -> str:
    parts: list[str] = []
    last = 0
    for match in _find_links(text):
        word = match[0].rstrip(_BEHIND)
        inner = word.lstrip(_BEFORE)
        start = match.start() + len(word) - len(inner)
        parts += [_escape_markup(text[last:start]), quote(inner) if inner else ""]
        last = start + len(inner)
    return "".join([*parts, _escape_markup(text[last:])])


def _find_links(text: str) -> Iterator[re.Match[str]]:
    """Words, or commits in them, that GitHub makes a link of."""
    for word in _WORD.finditer(text):
        if _LINKED.search(word[0]):
            yield word
        else:
            yield from _COMMIT.finditer(text, *word.span())


def _escape_markup(text: str) -> str:
    return re.sub(r"[\\`*_~\[\]<>&|$]", r"\\\g<0>", text)


def quote(text: str) -> str:
    """Text as inline code on one line, whatever backticks it holds."""
    text = escape(text)
    longest = max((len(run) for run in re.findall("`+", text)), default=0)
    fence = "`" * (longest + 1)
    pad = " " if not text or text.startswith("`") or text.endswith("`") else ""
    return f"{fence}{pad}{text}{pad}{fence}"


def format_cell(markdown: str) -> str:
    """Markdown of one line as a table's cell holds it: a bar is escaped there even in code."""
    return re.sub(r"\\(?=\|)", r"\\ ", markdown.replace("\\|", "|")).replace("|", "\\|")


_BEFORE, _BEHIND = "([{\"'", ")]}\"',.;:"
