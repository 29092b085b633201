"""XML read with a place for every attribute, and read on after a mistake: what expat alone cannot give.

Expat says whether a file is well-formed; the elements come from a single scan over the text that a stray `<` or a
forgotten closing tag does not stop. Entities that a file defines are neither expanded nor fetched.
"""

import codecs
import re
from bisect import bisect_right
from collections.abc import Iterable
from functools import cached_property
from typing import NamedTuple
from xml.parsers import expat

import msgspec

from .place import Problem

TOKEN = re.compile(
    r"<!--.*?(?:-->|\Z)"
    r"|<!\[CDATA\[(?P<cdata>.*?)(?:\]\]>|\Z)"
    r"|<\?.*?(?:\?>|\Z)"
    r"|<!DOCTYPE[^<>\[]*(?:\[.*?(?:\]\s*>|\Z)|>)"
    r"|<(?P<close>/?)(?P<name>[A-Za-z_][\w:.-]*)(?![\w:.-])"
    # XML allows no `<` in a value; some readers do (`type="a::B<c::D>"`), so one may stand there within a line
    r"(?P<rest>[^<>\"']*(?:(?:\"(?:[^\"<]*|[^\"<\n]{0,400}<[^\"\n]{0,400})\""
    r"|'(?:[^'<]*|[^'<\n]{0,400}<[^'\n]{0,400})')[^<>\"']*)*)>",
    re.DOTALL,
)
# A name is looked for once, from where it begins on.
ATTRIBUTE = re.compile(r"(?<![\w:.-])(?:(?![A-Za-z_])[\w:.-])*([A-Za-z_][\w:.-]*)\s*=\s*(?:\"([^\"]*)\"|'([^']*)')")
DECLARED_ENCODING = re.compile(rb"^\s*<\?xml[^>]{0,200}?encoding\s*=\s*[\"']([A-Za-z0-9._-]+)[\"']")
ENTITY = re.compile(r"&(#[0-9]{1,7}|#[xX][0-9a-fA-F]{1,6}|lt|gt|amp|quot|apos);")
PREDEFINED = {"lt": "<", "gt": ">", "amp": "&", "quot": '"', "apos": "'"}


class Attribute(NamedTuple):
    """An attribute; value unescaped; offset of the first character of its value in Document.text. listed: it is one
    item of a list, which YAML may have."""

    name: str
    value: str
    offset: int
    listed: bool = False


class Element(msgspec.Struct, eq=False):
    """An element in document order. parent: index into Document.elements, -1 for the root. text: its own text, children
    excluded, stripped; text_offset: where that starts (the tag's own start when there is none). children: those right
    in it."""

    name: str
    attributes: tuple[Attribute, ...]
    offset: int
    parent: int
    text_offset: int
    text: str = ""
    children: list["Element"] = []

    def get(self, name: str, default: str = "") -> str:
        """Value of an attribute, default when it is not there."""
        return next((attribute.value for attribute in self.attributes if attribute.name == name), default)

    def find(self, *names: str) -> Attribute | None:
        """The first attribute of one of these names."""
        return next((attribute for attribute in self.attributes if attribute.name in names), None)


class Document:
    """A scanned file: its text, its elements in order, what kept it from being well-formed. A line ends with a line
    feed."""

    def __init__(self, text: str, elements: Iterable[Element] = (), problems: tuple[Problem, ...] = ()):
        self.text = text
        self.elements = list(elements)
        self.problems = problems

    @cached_property
    def _starts(self) -> list[int]:
        return [0, *(line.end() for line in re.finditer("\n", self.text))]

    def locate(self, offset: int) -> tuple[int, int]:
        """Line and column of an offset, both from 1."""
        line = bisect_right(self._starts, offset)
        return line, offset - self._starts[line - 1] + 1


def decode(data: bytes) -> str:
    """Text of a file in UTF-8 or, as byte order mark or XML declaration say, another encoding; never raises."""
    if data[:3] == b"\xef\xbb\xbf":
        return data[3:].decode("utf-8", "replace")
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return data.decode("utf-16", "replace")
    declared = DECLARED_ENCODING.match(data)
    if declared is not None:
        try:
            return data.decode(find_text_encoding(declared.group(1).decode("ascii")), "replace")
        except (LookupError, ValueError):
            pass
    return data.decode("utf-8", "replace")


# Codecs of Python that are no encodings of files; the first two take quadratic time.
_NO_ENCODINGS = frozenset(("punycode", "idna", "unicode-escape", "raw-unicode-escape", "undefined"))


def find_text_encoding(name: str) -> str:
    """The name that Python has for an encoding that a file declares. Raises LookupError for what is none of text."""
    found = codecs.lookup(name).name
    if found in _NO_ENCODINGS:
        raise LookupError(name)
    return found


def unescape(text: str) -> str:
    """Predefined and numeric references resolved; any other stays as written."""
    if "&" not in text:
        return text
    return ENTITY.sub(_resolve_reference, text)


def _resolve_reference(match: re.Match[str]) -> str:
    name = match.group(1)
    if name[0] != "#":
        return PREDEFINED[name]
    code = int(name[2:], 16) if name[1] in "xX" else int(name[1:])
    return chr(code) if code < 0x110000 and not 0xD800 <= code < 0xE000 else match.group(0)


class _EntityDefined(Exception):
    """The document type defines an entity."""


def _refuse_entity(*_: object) -> None:
    raise _EntityDefined


def find_xml_problems(data: bytes) -> tuple[Problem, ...]:
    """What keeps data from being plain, well-formed XML: nothing, or one Problem."""
    parser = expat.ParserCreate()
    parser.EntityDeclHandler = _refuse_entity
    try:
        parser.Parse(data, True)
    except _EntityDefined:
        line, column = parser.CurrentLineNumber, parser.CurrentColumnNumber + 1
        return (Problem(line, "defines XML entities, which are not expanded", column),)
    except expat.ExpatError as error:
        why = expat.ErrorString(error.code) or "syntax error"
        last = data.count(b"\n") + 1
        column = error.offset + 1 if 1 <= error.lineno <= last else 0
        return (Problem(min(max(error.lineno, 1), last), f"not well-formed XML: {why}", column),)
    except (ValueError, LookupError) as error:
        return (Problem(1, f"not readable as XML: {error}"),)
    return ()


def scan(data: bytes) -> Document:
    """All elements of an XML file, with places; reads on after mistakes and never raises."""
    text = decode(data)
    elements: list[Element] = []
    open_: list[int] = []
    at = 0
    for token in TOKEN.finditer(text):
        start = token.start()
        if open_ and start > at:
            _add_text(elements[open_[-1]], unescape(text[at:start]), at)
        at = token.end()
        name = token["name"]
        if name is None:
            if open_ and token["cdata"]:
                _add_text(elements[open_[-1]], token["cdata"], token.start("cdata"))
            continue
        if token["close"]:
            for depth in range(len(open_) - 1, max(len(open_) - 64, -1), -1):
                if elements[open_[depth]].name == name:
                    del open_[depth:]
                    break
            continue
        rest = token["rest"]
        attributes: tuple[Attribute, ...] = ()
        if "=" in rest:
            base = token.start("rest")
            attributes = tuple(
                Attribute(m[1], unescape(m[m.lastindex or 2]), base + m.start(m.lastindex or 2))
                for m in ATTRIBUTE.finditer(rest)
            )
        elements.append(Element(name, attributes, start, open_[-1] if open_ else -1, start))
        if open_:
            elements[open_[-1]].children.append(elements[-1])
        if not rest.endswith("/"):
            open_.append(len(elements) - 1)
    return Document(text, elements, find_xml_problems(data))


def _add_text(element: Element, text: str, offset: int) -> None:
    stripped = text.strip()
    if not stripped:
        return
    if element.text:
        element.text += text.rstrip()
        return
    element.text = stripped
    element.text_offset = offset + text.find(stripped[0])
