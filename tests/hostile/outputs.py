"""What must hold for every output: of its characters, its lines, and its format, read with a parser of that format.

Names of hostile workspaces hold the word `evil`, so that it is known what came from there.
"""

from __future__ import annotations

import json
import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import bs4
import markdown_it

# Control characters but line feed and tab, directions, and what breaks a line elsewhere.
_CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]")
_COLOUR = re.compile(r"\x1b\[[0-9;]{0,20}m")
_OURS = re.compile(
    r"::(error|warning|notice)( (file|title|line|col|endLine|endColumn)=[^,:\n]*"
    r"(,(file|title|line|col|endLine|endColumn)=[^,:\n]*)*)?::"
)
_FAULTS = (
    "Traceback (most recent call last)",
    "this is a fault of rosimpact",
    "Exception ignored",
    "Error in sys.excepthook",
)
_HANDLER = re.compile(r"on[a-z]+", re.I)


def plain_failures(name: str, data: bytes, command: Sequence[str], colours: bool, encoding: str) -> Iterator[str]:
    """What is wrong with an output as a text for terminals and CI systems."""
    if _format(command) == "html" and name != "errors" and _is_utf8(data):
        encoding = "utf-8"  # a page says so itself, whatever the terminal's encoding is
    try:
        text = data.decode(encoding)
    except UnicodeDecodeError as error:
        yield f"{name} is not {encoding}: {error.reason} {data[max(0, error.start - 20) : error.start + 20]!r}"
        text = data.decode(encoding, "replace")
    for fault in _FAULTS:
        if fault in text:
            yield f"{name}: {fault}: {text.strip().splitlines()[-1][:200]!r}"
    shown = _COLOUR.sub("", text) if colours else text
    match = _CONTROL.search(shown)
    if match:
        yield f"{name} holds {match[0]!r}: {shown[max(0, match.start() - 30) : match.end() + 20]!r}"
    github = _format(command) == "github" and name == "output"
    # The runner splits lines at \n and \r, and ignores any white space of Unicode before `::`.
    for line in re.split(r"[\n\r]", shown):
        start = line.lstrip()
        if start.startswith("::") and not (github and line == start and _OURS.match(start)):
            yield f"{name} speaks to CI: {line[:100]!r}"
            break
    match = re.search(r"##(vso|[a-z]*)\[", shown)
    if match:
        yield f"{name} speaks to CI: {shown[max(0, match.start() - 30) : match.end() + 20]!r}"


def _is_utf8(data: bytes) -> bool:
    try:
        data.decode("utf-8")
    except UnicodeDecodeError:
        return False
    return True


def _format(command: Sequence[str]) -> str:
    for option in ("-f", "--format"):
        if option in command:
            return command[list(command).index(option) + 1]
    return "text"


def format_failures(command: Sequence[str], ended: Any, texts: Mapping[str, bytes]) -> Iterator[str]:
    """What is wrong with an output as a document of the format asked for."""
    check = _json_lines if "--jsonl" in command else _CHECKS.get(_format(command))
    if check is None or ended.status not in (0, 1):
        return
    written = [data for name, data in texts.items() if name not in ("output", "errors")]
    data = written[0] if ("-o" in command or "--output" in command) and written else texts["output"]
    try:
        yield from check(data.decode("utf-8", "replace"))
    except Exception as error:
        yield f"{_format(command)} cannot be parsed: {type(error).__name__}: {str(error)[:150]}"


def _json(text: str) -> Iterator[str]:
    json.loads(text)
    yield from ()


def _json_lines(text: str) -> Iterator[str]:
    for line in text.splitlines():
        json.loads(line)
    yield from ()


def _sarif(text: str) -> Iterator[str]:
    # A message's text may hold links; a viewer shows them.
    def messages(value: Any) -> Iterator[str]:
        if isinstance(value, dict):
            message = value.get("message")
            if isinstance(message, dict):
                yield message.get("text", "")
                yield message.get("markdown", "")
            for each in value.values():
                yield from messages(each)
        elif isinstance(value, list):
            for each in value:
                yield from messages(each)

    for message in messages(json.loads(text)):
        match = re.search(r"(?<!\\)\[[^\]\\]*\]\([^)]*\)", message)
        if match and "evil" in match[0]:
            yield f"sarif: a link in a message: {match[0][:100]!r}"
            return


def _markdown(text: str) -> Iterator[str]:
    parsed = markdown_it.MarkdownIt("commonmark", {"html": True}).enable("table").parse(text)
    for token in parsed:
        if token.type == "html_block" and not _harmless(token.content):
            yield f"markdown: raw HTML: {token.content[:100]!r}"
        if token.type in ("fence", "code_block", "heading_open", "hr"):
            continue
        for child in token.children or ():
            if child.type == "image":
                yield f"markdown: an image: {child.attrs.get('src')!r}"
            elif child.type == "link_open" and "evil" in str(child.attrs.get("href")):
                yield f"markdown: a link: {child.attrs.get('href')!r}"
            elif child.type == "html_inline" and not _harmless(child.content):
                yield f"markdown: raw HTML: {child.content[:100]!r}"
            elif child.type == "text":
                match = re.search(r"(?<![\w`])@[A-Za-z]|(https?://|www\.)\S*evil|evil\S*#\d", child.content)
                if match:
                    around = child.content[max(0, match.start() - 30) : match.end() + 30]
                    yield f"markdown: a mention or link: {around!r}"
    for token in parsed:
        if token.type == "heading_open" and token.map and "evil" in text.splitlines()[token.map[0]]:
            yield f"markdown: a heading: {text.splitlines()[token.map[0]][:100]!r}"


def _harmless(html: str) -> bool:
    rest = re.sub(r"</?(details|summary|sub|br|b|code|table|tr|td|th|p|kbd)\s*/?>|<!--[^<>]*-->", "", html)
    return "<" not in rest and "evil" not in re.sub(r"<!--[^<>]*-->", "", html)


def _html(text: str) -> Iterator[str]:
    page = bs4.BeautifulSoup(text, "html.parser")
    policy = page.find("meta", attrs={"http-equiv": re.compile("content-security-policy", re.I)})
    if policy is None or "default-src 'none'" not in str(policy):
        yield "html: no content security policy"
    elif "unsafe" in str(policy) or "*" in str(policy.get("content")):
        yield f"html: a weak policy: {policy}"
    scripts = page.find_all("script")
    kinds = [script.get("type", "") for script in scripts]
    if sorted(kinds) not in (["", "application/json"], [""], ["", "", "application/json"]):
        yield f"html: scripts {kinds}"
    for script in scripts:
        if script.get("type") == "application/json":
            json.loads(script.string or "null")
        elif "evil" in (script.string or "") or script.get("src"):
            yield "html: a script of the workspace"
    for element in page.find_all(True):
        for name, value in element.attrs.items():
            if _HANDLER.fullmatch(name):
                yield f"html: {element.name} has {name}"
            if name in ("href", "src", "action", "data", "srcset") and re.match(
                r"\s*(javascript|data|vbscript):|.*evil\.example", str(value), re.I
            ):
                yield f"html: {element.name} {name}={value!r}"
        if element.name == "form" and element.get("action"):
            yield "html: a form that is sent"
        if element.name in ("img", "iframe", "object", "embed", "base", "link", "frame", "video", "audio"):
            yield f"html: an element {element.name}"


def _graphml(text: str) -> Iterator[str]:
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        yield "graphml: a document type"
    ElementTree.fromstring(text)


_DOT = re.compile(
    r"""\s+|//[^\n]*|/\*.*?\*/|(?P<quoted>"(?:[^"\\]|\\.)*")|(?P<id>[A-Za-z_\x80-\uffff][\w\x80-\uffff]*|-?[\d.]+)"""
    r"""|(?P<sign>->|--|[{}\[\];,=:])|(?P<html><)""",
    re.S,
)


def _dot(text: str) -> Iterator[str]:
    position, depth, last = 0, 0, ""
    while position < len(text):
        match = _DOT.match(text, position)
        if match is None:
            yield f"dot: broken at {text[max(0, position - 40) : position + 40]!r}"
            return
        position = match.end()
        if match["html"]:
            yield "dot: an HTML label"
            return
        if match["id"]:
            if "evil" in match["id"]:
                yield f"dot: an unquoted name {match['id']!r}"
            if match["id"].lower() in ("url", "href", "image", "shapefile", "fontpath"):
                yield f"dot: {match['id']}"
        if match["sign"] in ("{", "[") or match["sign"] in ("}", "]"):
            depth += 1 if match["sign"] in ("{", "[") else -1
        last = match[0]
    if depth:
        yield f"dot: brackets do not match, after {last!r}"


def _mermaid(text: str) -> Iterator[str]:
    for line in text.splitlines():
        rest = re.sub(r'"[^"\n]*"', '""', line)
        if "evil" in rest:
            yield f"mermaid: outside of quotes: {line[:120]!r}"
            return
        if re.search(r"<(?!br\s*/?>)[a-z/!]|`|javascript:", line, re.I) and "evil" in line:
            yield f"mermaid: markup in a label: {line[:120]!r}"
            return
        if re.match(r"\s*(click|%%\{|href|style|classDef|linkStyle|callback)\b", line) and "evil" in line:
            yield f"mermaid: {line[:120]!r}"


_CHECKS = {
    "json": _json,
    "sarif": _sarif,
    "markdown": _markdown,
    "html": _html,
    "graphml": _graphml,
    "dot": _dot,
    "mermaid": _mermaid,
}
