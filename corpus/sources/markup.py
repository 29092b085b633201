"""HTML of posts as Markdown: code, logs, lists and links survive, which a reader of bare text loses."""

from __future__ import annotations

import re
from collections import Counter
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from bs4 import Tag

_BLOCKS = ("p", "div", "section", "article", "table", "tr", "dl", "dt", "dd", "figure")
_HEADINGS = ("h1", "h2", "h3", "h4", "h5", "h6")
_SILENT = ("script", "style", "template", "noscript", "button", "form")
_VOID = (
    "area", "base", "br", "col", "embed", "hr", "img", "input", "link", "meta", "param", "source", "track", "wbr",
)  # fmt: skip
_TAG = re.compile(r"<(/?)([A-Za-z][A-Za-z0-9:-]{0,40})")
_DEEPEST = 600
_LONGEST = 1_000_000
_TIGHT = re.compile(r"[ \t]*\n(?:[ \t]*\n)+")


def parse_html(html: str):
    """A parsed page or piece of one; the bare text of one that nests deeper than any post, which would be parsed for
    minutes. What stands beyond a limit of characters is left out."""
    from bs4 import BeautifulSoup

    html = html[:_LONGEST]
    return BeautifulSoup(re.sub(r"<[^<>]*>", " ", html) if _measure_depth(html) > _DEEPEST else html, "html.parser")


def _measure_depth(html: str) -> int:
    """How deep tags nest at most, or more where they overlap."""
    counts: Counter[str] = Counter()
    deepest = depth = 0
    for match in _TAG.finditer(html):
        name = match[2].lower()
        if not match[1]:
            counts[name] += 1
            depth += name not in _VOID
            deepest = max(deepest, depth)
        elif counts[name] > 0:
            counts[name] -= 1
            depth -= name not in _VOID
    return deepest


def convert_to_markdown(html: str | Tag) -> str:
    """The Markdown of a post's HTML, without blank lines at its ends; its bare text where it nests too deeply."""
    page = parse_html(html) if isinstance(html, str) else html
    try:
        return _tidy(_render_children(page))
    except RecursionError:
        return _tidy("".join(page.strings))


def _tidy(text: str) -> str:
    """Blank lines in a row become one, but not inside fenced code."""
    parts = re.split(r"(^```+\n.*?^```+$)", text, flags=re.DOTALL | re.MULTILINE)
    return "".join(part if place % 2 else _TIGHT.sub("\n\n", part) for place, part in enumerate(parts)).strip("\n ")


def _render_children(element: Tag) -> str:
    return "".join(_render_node(child) for child in element.children)


def _render_node(node) -> str:
    from bs4.element import NavigableString, PreformattedString, Tag

    if isinstance(node, PreformattedString):  # comments, declarations
        return ""
    if isinstance(node, NavigableString):
        return re.sub(r"\s+", " ", str(node))
    if not isinstance(node, Tag) or node.name in _SILENT:
        return ""
    name = node.name
    if name == "pre":
        return _fence_code(node.get_text())
    if name == "code":
        return _render_code(node.get_text())
    if name == "br":
        return "\n"
    if name == "hr":
        return "\n\n---\n\n"
    if name == "img":
        return f"![{node.get('alt') or ''}]({node.get('src') or ''})"
    inner = _render_children(node)
    if name == "a":
        target = node.get("href")
        text = inner.strip()
        return f"[{text}]({target})" if target and text and text != target else inner
    if name in ("strong", "b"):
        return _mark_text(inner, "**")
    if name in ("em", "i"):
        return _mark_text(inner, "*")
    if name in _HEADINGS:
        return f"\n\n{'#' * int(name[1])} {inner.strip()}\n\n"
    if name == "li":
        return _render_item(node, inner)
    if name in ("ul", "ol"):
        return f"\n\n{inner.strip(chr(10))}\n\n"
    if name == "blockquote":
        quoted = "\n".join(f"> {line}".rstrip() for line in _tidy(inner).split("\n"))
        return f"\n\n{quoted}\n\n"
    if name in ("td", "th"):
        return f"{inner.strip()} "
    if name in _BLOCKS:
        return f"\n\n{inner.strip()}\n\n"
    return inner


def _render_item(node: Tag, inner: str) -> str:
    parent = node.parent
    mark = "-"
    if parent is not None and parent.name == "ol":
        mark = f"{1 + sum(1 for _ in node.find_previous_siblings('li'))}."
    first, *others = _tidy(inner).split("\n")
    return "\n".join([f"{mark} {first}", *(f"   {line}".rstrip() for line in others)]) + "\n"


def _fence_code(text: str) -> str:
    fence = "```"
    while fence in text:
        fence += "`"
    return f"\n\n{fence}\n{text.strip(chr(10))}\n{fence}\n\n"


def _render_code(text: str) -> str:
    if "\n" in text.strip("\n"):
        return _fence_code(text)
    fence = "`"
    while fence in text:
        fence += "`"
    room = " " if text.startswith("`") or text.endswith("`") else ""
    return f"{fence}{room}{text}{room}{fence}" if text else ""


def _mark_text(inner: str, mark: str) -> str:
    text = inner.strip()
    return f"{mark}{text}{mark}" if text and "\n\n" not in text else inner
