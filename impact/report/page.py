"""What every page has in common: head, colours and controls, a security policy, and data that cannot leave its block.

A page is one file: it works from a disk, loads nothing and runs no code but its own.
"""

import base64
import hashlib
import html
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...edges.console import escape_page, format_json

_PART = re.compile(r"\{\{([a-z]+\.(?:html|css|js))\}\}")
_PLACEHOLDER = re.compile(r"\{\{(policy|title|data)\}\}")


def render_page(template: Path, title: str, data: Mapping[str, Any]) -> str:
    """A page as text, from a template whose parts lie beside it or here.

    What comes from the workspace stands only in the title and in a JSON block that cannot be left, and the page's
    script puts it into text nodes; the content security policy allows that script and the styles by their hashes, and
    nothing else.
    """
    text = _read_template(template)
    values = {"policy": _build_policy(text), "title": _escape_html(title), "data": _render_block(data)}
    return _PLACEHOLDER.sub(lambda match: values[match[1]], text)


def _read_template(template: Path) -> str:
    """The template with its parts in it."""

    def read_part(match: re.Match[str]) -> str:
        beside = template.with_name(match[1])
        return _read_template(beside if beside.exists() else Path(__file__).with_name(match[1])).strip()

    return _PART.sub(read_part, template.read_text(encoding="utf-8"))


def _build_policy(text: str) -> str:
    """The content security policy of a page: its own scripts and styles by their hashes, and nothing else."""
    sources = []
    for tag in ("script", "style"):
        found = re.findall(rf"<{tag}>(.*?)</{tag}>", text, re.DOTALL)
        hashes = [base64.b64encode(hashlib.sha256(each.encode()).digest()).decode() for each in found]
        sources.append(" ".join([f"{tag}-src", *(f"'sha256-{each}'" for each in hashes)]))
    return "; ".join(["default-src 'none'", *sources, "base-uri 'none'", "form-action 'none'"])


def _render_block(data: Mapping[str, Any]) -> str:
    """JSON in which no character can end the block: < > & and what is invisible are escaped."""
    return re.sub("[<>&]", lambda match: f"\\u{ord(match[0]):04x}", format_json(_clean(data), None))


def _escape_html(text: str) -> str:
    """Text for the page's markup."""
    return html.escape(escape_page(text).replace("\n", " ")).replace("##", "&#35;&#35;")


def _clean(value: Any) -> Any:
    """The value with control and direction characters in its texts shown escaped."""
    if isinstance(value, str):
        return escape_page(value)
    if isinstance(value, Mapping):
        return {escape_page(key): _clean(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_clean(item) for item in value]
    return value
