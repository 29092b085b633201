"""How declarations, calls and chains of members look in the text of a C++ file whose comments and literals are blank.

Nothing is parsed as a whole: each question is answered by what stands around one place.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Iterator
from functools import lru_cache
from typing import NamedTuple

FAR = 240
"""How many characters before a place are looked at."""
NO_TYPES = frozenset(
    [
        "return",
        "delete",
        "throw",
        "new",
        "else",
        "case",
        "goto",
        "using",
        "typename",
        "template",
        "operator",
        "const",
        "constexpr",
        "static",
        "if",
        "while",
        "for",
        "switch",
        "sizeof",
        "co_return",
        "co_await",
        "co_yield",
        "and",
        "or",
        "not",
    ]
)
"""Words before a name that do not declare it."""
_LONGEST = 80
"""So many characters before a place a word is looked for."""
_FIRST = frozenset("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_")
_SCOPES_BACK = re.compile(r"((?:[A-Za-z_]\w*\s*::\s*)+)\Z")
_TYPE_BACK = re.compile(
    r"(?P<type>[A-Za-z_][\w:]*(?:\s*<[^;(){}]*>)?(?:\s*::\s*\w+)*)(?:\s+const)?(?:\s*(?P<mark>[&*]+)\s*(?:const\s+)?|\s+)\Z"
)
_BEFORE_NAME = frozenset(" \t\n&*")
_DECLARED = re.compile(r"\s*(?:[;=,){(\[]|:(?!:))")
_BRACES = re.compile(r"[{}]")
_PAIRS = {")": "(", "]": "[", ">": "<"}


@lru_cache(maxsize=8192)
def declarations_of(name: str, text: str) -> tuple[tuple[int, str, str], ...]:
    """Where a name is declared, behind the name, with which type, and what stands between (`*`, `&`)."""
    return tuple(_declarations_of(name, text))


def _declarations_of(name: str, text: str) -> Iterator[tuple[int, str, str]]:
    at = text.find(name)
    while at >= 0:
        end = at + len(name)
        # Most places are told by the signs around them.
        if text[at - 1 : at] in _BEFORE_NAME and _DECLARED.match(text, end):
            # No type has any of these in it: what stands before them need not be looked at.
            far = max(0, at - FAR)
            begins = max(text.rfind(";", far, at), text.rfind("{", far, at), text.rfind("}", far, at),
                         text.rfind("(", far, at), text.rfind(")", far, at)) + 1  # fmt: skip
            ahead = _TYPE_BACK.search(text, max(begins, far), at)
            if ahead and ahead.group("type") not in NO_TYPES:
                yield end, ahead.group("type"), ahead.group("mark") or ""
        at = text.find(name, end)


class Blocks:
    """The braces of a text. marks: where they stand; closes: for each, where its block ends (of a closing one, the
    place itself)."""

    def __init__(self, text: str):
        self.marks: list[int] = []
        self.closes: list[int] = []
        self._end = len(text)
        self._around: list[int] = []  # for each stretch before a brace, and behind the last: which brace opened it
        self._stray: list[int] = []  # closing braces that close nothing
        opened = [-1]
        for number, match in enumerate(_BRACES.finditer(text)):
            at = match.start()
            self.marks.append(at)
            self._around.append(opened[-1])
            if match.group() == "{":
                self.closes.append(self._end)
                opened.append(number)
            else:
                self.closes.append(at)
                if len(opened) > 1:
                    self.closes[opened.pop()] = at
                else:
                    self._stray.append(at)
        self._around.append(opened[-1])

    def around(self, stretch: int) -> int:
        """Where the block ends that is around the stretch before a brace, or behind the last one. What nothing opened
        ends where a brace closes it."""
        opened = self._around[stretch]
        if opened >= 0:
            return self.closes[opened]
        if not self._stray or stretch == len(self.marks):
            return self._end
        following = bisect_left(self._stray, self.marks[stretch])
        return self._stray[following] if following < len(self._stray) else self._end


@lru_cache(maxsize=256)
def blocks(text: str) -> Blocks:
    """The braces of a text, which are asked for again and again."""
    return Blocks(text)


def in_scope(text: str, declared: int, used: int) -> bool:
    """Whether a name declared at one offset can be meant at another: its block, or function, is still open."""
    known = blocks(text)
    following = bisect_left(known.marks, declared)
    if following == len(known.marks) or known.marks[following] >= used:
        return True
    between = text[declared : known.marks[following]]
    if between.count(")") > between.count("("):  # a parameter of the function whose body opens here
        return text[known.marks[following]] == "{" and known.closes[following] >= used
    return known.around(following) >= used


class Step(NamedTuple):
    """One link of `a->b[0].at(1)`: `a`, `b`, `[]` and `at()`; by: what leads to it, `.`, `->` or nothing."""

    name: str
    by: str


def chain_before(text: str, end: int) -> list[Step] | None:
    """The expression that ends at an offset, link by link; None for what is no such chain. A leading `this->` is left
    out. The first link may be a call, and may have scopes."""
    steps: list[Step] = []
    at = end
    while True:
        while at and text[at - 1] in " \t\n":
            at -= 1
        last = text[at - 1 : at]
        if last == "]":
            at = opening(text, at)
            if at < 0:
                return None
            steps.append(Step("[]", ""))
            continue
        called = ""
        if last == ")":
            inner = at
            at = opening(text, at)
            if at < 0:
                return None
            word = _word_before(text, at)
            if word is None:
                content = re.fullmatch(r"\(\s*\*?\s*([A-Za-z_]\w*)\s*\)", text[at:inner])
                if content is None:
                    return None
                steps.append(Step(content.group(1), ""))
                break
            called = "()"
        else:
            word = _word_before(text, at)
            if word is None:
                return None
        at = word[0]
        name = text[at : word[1]] + called
        while at and text[at - 1] in " \t\n":
            at -= 1
        if text[at - 1 : at] == ".":
            at -= 1
            steps.append(Step(name, "."))
        elif text[at - 2 : at] == "->":
            at -= 2
            steps.append(Step(name, "->"))
        elif text[at - 2 : at] == "::":
            scopes = _SCOPES_BACK.search(text, max(0, at - FAR), at)
            if scopes is None:
                return None
            steps.append(Step("".join(scopes.group(1).split()) + name, ""))
            break
        else:
            steps.append(Step(name, ""))
            break
    steps.reverse()
    if steps[0].name == "this":
        steps = steps[1:]
    return steps or None


def _word_before(text: str, end: int) -> tuple[int, int] | None:
    """Where the word begins and ends that stands before an offset, with no more than white space in between."""
    far = max(0, end - _LONGEST)
    while end > far and text[end - 1].isspace():
        end -= 1
    begins = end
    while begins > far and (text[begins - 1].isalnum() or text[begins - 1] == "_"):
        begins -= 1
    while begins < end and text[begins] not in _FIRST:
        begins += 1
    return (begins, end) if begins < end else None


def scopes_before(text: str, end: int) -> int:
    """Where `a::B<c>::` begins that ends at an offset; the offset itself where there are no such scopes."""
    begins = at = end
    while True:
        while at and text[at - 1] in " \t\n":
            at -= 1
        if text[at - 2 : at] != "::":
            return begins
        at -= 2
        while at and text[at - 1] in " \t\n":
            at -= 1
        if text[at - 1 : at] == ">":
            at = opening(text, at)
            if at < 0:
                return begins
            while at and text[at - 1] in " \t\n":
                at -= 1
        word = at
        while word and (text[word - 1] == "_" or text[word - 1].isalnum()):
            word -= 1
        if word == at or text[word].isdigit():
            return begins
        begins = at = word


def opening(text: str, end: int) -> int:
    """Where the bracket opens that closes right before an offset; -1 when it does not, or far away."""
    closing = text[end - 1]
    opened, depth = _PAIRS[closing], 0
    for at in range(end - 1, max(-1, end - 2000), -1):
        if text[at] == closing:
            depth += 1
        elif text[at] == opened:
            depth -= 1
            if depth == 0:
                return at
    return -1


# -- classes and functions of a file ----------------------------------------------------------------------------------


class Region(NamedTuple):
    """What a pair of braces encloses. kind: `namespace`, `class`, `function` or `other`. name: of a function, the class
    before its name (`A::B` for `A::B::f() {`). bases: of a class, as written. start, end: inside the braces."""

    kind: str
    name: str
    bases: tuple[str, ...]
    start: int
    end: int


_MARKS = re.compile(r"[{};]")
_DIRECTIVE = re.compile(r"^[ \t]*#[^\n]*(?:(?<=\\)\n[^\n]*)*", re.MULTILINE)
_NAMESPACE = re.compile(r"(?:\bnamespace\b(?:\s*\[\[[^\]]*\]\])?([\w:\s]*)|\bextern\s*\"[^\"]*\")\Z")
_CLASS = re.compile(
    r"\b(?:class|struct|union)\b(?:\s*\[\[[^\]]*\]\]|\s*\b__attribute__\s*\(\([^()]*(?:\([^()]*\)[^()]*)*\)\)|\s+[A-Z][A-Z0-9_]{3,}(?:\s*\([^()]*\))?)*"
    r"\s+(?P<name>[A-Za-z_][\w:]*)\s*(?:<[^;{}]*>)?\s*(?:\bfinal\b\s*)?(?::(?!:)(?P<bases>[^;{}]*))?\Z",
    re.DOTALL,
)
# The arguments of a template, in which others may stand two deep: a text can be read in one way only.
_ARGUMENTS = r"<[^()<>]*(?:<[^()<>]*(?:<[^()<>]*>[^()<>]*)*>[^()<>]*)*>"
_QUALIFIED_FUNCTION = re.compile(
    rf"((?:[A-Za-z_]\w*(?:\s*{_ARGUMENTS})?\s*::\s*)+)(?:~\s*)?(?:operator\b[^(]*|\w+)\s*\Z"
)
# No head of a class or function is longer.
_LONGEST_HEAD = 8000
_ACCESS = re.compile(r"\b(?:public|protected|private|virtual|typename)\b")
_TEMPLATE = re.compile(r"<[^<>]*>")


def regions(text: str) -> tuple[Region, ...]:
    """Namespaces, classes and functions of a file; what is in a function is not looked into."""
    known = blocks(text)
    found: list[Region] = []
    opened: list[tuple[str, str, tuple[str, ...], int]] = []
    begins, at, pending = 0, 0, ""
    while True:
        match = _MARKS.search(text, at)
        if match is None:
            break
        mark, at = match.group(), match.start()
        if mark == "{":
            kind, name, bases = ("function", pending, ()) if pending else _head(text[begins:at])
            pending = ""
            if kind in ("namespace", "class"):
                opened.append((kind, name, bases, at + 1))
            else:
                end = known.closes[bisect_left(known.marks, at)]
                found.append(Region(kind, name, bases, at + 1, end))
                # The braces were of an initialiser before the body.
                rest = text[end + 1 : end + 80].lstrip()
                pending = name if kind == "function" and rest[:1] in (",", "{") else ""
                at = end
        elif mark == "}" and opened:
            found.append(Region(*opened.pop(), at))
        at += 1
        begins = at
    found.extend(Region(*one, len(text)) for one in opened)
    return tuple(sorted(found, key=lambda region: (region.start, -region.end)))


def _head(text: str) -> tuple[str, str, tuple[str, ...]]:
    """What the text before an opening brace begins."""
    if "#" in text:
        text = _DIRECTIVE.sub("", text)
    text = text[-_LONGEST_HEAD:].rstrip()
    space = _NAMESPACE.search(text) if "namespace" in text or "extern" in text else None
    if space:
        return "namespace", "".join((space.group(1) or "").split()), ()
    if "class" in text or "struct" in text or "union" in text:
        class_ = _CLASS.search(text)
        if class_ and not re.search(r"\benum\s*\Z", text[: class_.start()]):
            bases = tuple(
                " ".join(_ACCESS.sub(" ", base).split()) for base in split_at_commas(class_.group("bases") or "")
            )
            return "class", class_.group("name"), tuple(base for base in bases if base)
    paren = text.find("(")
    if paren < 0 or text.endswith("="):
        return "other", "", ()
    ahead = text[max(0, paren - FAR) : paren]
    scopes = _QUALIFIED_FUNCTION.search(ahead) if "::" in ahead else None
    return "function", "".join(_TEMPLATE.sub("", scopes.group(1)).split()).removesuffix("::") if scopes else "", ()


def split_at_commas(text: str) -> list[str]:
    """The parts of a list, split at commas outside of brackets of every kind, `<>` among them."""
    parts, depth, begins = [], 0, 0
    for at, character in enumerate(text):
        if character in "<({[":
            depth += 1
        elif character in ")}]" or (character == ">" and text[at - 1 : at] != "-"):
            depth -= 1
        elif character == "," and depth == 0:
            parts.append(text[begins:at].strip())
            begins = at + 1
    final = text[begins:].strip()
    return [*parts, final] if final or parts else []


def without_templates(text: str) -> str:
    """A type without its template arguments and white space."""
    while True:
        shorter = _TEMPLATE.sub("", text)
        if shorter == text:
            return "".join(text.split())
        text = shorter
