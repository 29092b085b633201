"""CMake values that remember where each of their words stands, and the expansion of arguments into them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence

from ...facts.cmake import CMakeArgument
from ...facts.condition import Condition
from .build import At

MAX_WORDS = 20_000
MAX_TEXT = 200_000
_MAX_NESTING = 20
_MAX_WAYS = 16


class Word(str):
    """One list item: its text, where it stands, under which conditions it was put there.

    sure is False when the text rests on a value that is not known or that differs between branches. parts keeps the
    items of a list that was expanded inside quotes.
    """

    __slots__ = ("at", "conditions", "parts", "sure")
    at: At
    conditions: tuple[Condition, ...]
    sure: bool
    parts: tuple[Word, ...]


_new = str.__new__


def wrap(text: str, at: At, conditions: tuple[Condition, ...] = (), sure: bool = True) -> Word:
    """Makes a Word."""
    made = _new(Word, text)
    made.at = at
    made.conditions = conditions
    made.sure = sure
    made.parts = ()
    return made


class CMakeValue:
    """What a variable holds. words is the list view: the union of all branches that wrote it; text is what was written
    last, and chosen its words; sure is False when branches differ or a user may override it; defined is False for a
    variable that is known to be unset. ways: of what differing branches leave, each with the conditions under which it
    is left, of which no two hold together; None is never set. Empty where that is not known, and where all but one
    leave nothing. left: the same, these too."""

    __slots__ = ("chosen", "defined", "left", "sure", "text", "ways", "words")

    def __init__(self, words: tuple[Word, ...], sure: bool = True, defined: bool = True):
        self.words = words
        self.chosen = words
        self.text = words[0] if len(words) == 1 else ";".join(words)
        self.sure = sure
        self.defined = defined
        self.ways: tuple[tuple[tuple[Condition, ...], CMakeValue | None], ...] = ()
        self.left: tuple[tuple[tuple[Condition, ...], CMakeValue | None], ...] = ()


UNSET = CMakeValue((), True, False)


def make_unsure(value: CMakeValue) -> CMakeValue:
    """The same value, not to be relied upon in conditions."""
    if not value.sure:
        return value
    made = CMakeValue(value.words, False, value.defined)
    made.chosen = value.chosen
    made.text = value.text
    return made


def join(
    values: Sequence[CMakeValue | None], tests: Sequence[tuple[Condition, ...]] = ()
) -> CMakeValue | None:
    """One value for what several branches left behind, in order of writing; None stands for never set. tests: those
    that lead into each branch, where no two of them are taken."""
    distinct: list[CMakeValue | None] = []
    for value in values:
        if not any(value is other or _is_same(value, other) for other in distinct):
            distinct.append(value)
    if len(distinct) == 1:
        return distinct[0]
    known = [value for value in distinct if value is not None and value.defined]
    if not known:
        return None
    words: dict[str, Word] = {}
    for value in known:
        for item in value.words:
            before = words.setdefault(item, item)
            if before.conditions != item.conditions:
                common = tuple(c for c in before.conditions if c in item.conditions)
                words[item] = wrap(item, before.at, common, before.sure and item.sure)
    made = CMakeValue(tuple(words.values())[:MAX_WORDS], False)
    made.chosen = known[-1].chosen
    made.text = known[-1].text
    ways = [
        (merge(held, inner), way)
        for held, value in zip(tests, values, strict=False)
        for inner, way in ((value.ways if value is not None else ()) or (((), value),))
    ]
    if len(ways) <= _MAX_WAYS and len(tests) == len(values):
        made.left = tuple(ways)
    if len(known) > 1 and len(ways) <= _MAX_WAYS:
        made.ways = tuple(ways)
    return made


def _is_same(one: CMakeValue | None, other: CMakeValue | None) -> bool:
    if one is None or other is None:
        return one is other
    return (
        one.text == other.text and one.words == other.words and one.sure == other.sure and one.defined == other.defined
    )


def split_list(text: str) -> list[str]:
    """Splits a CMake list at its semicolons: `\\;` and semicolons inside square brackets do not separate."""
    if ";" not in text:
        return [text] if text else []
    if "\\" not in text and "[" not in text:
        return [part for part in text.split(";") if part]
    parts: list[str] = []
    current: list[str] = []
    nesting = 0
    index = 0
    while index < len(text):
        letter = text[index]
        if letter == "\\" and text[index + 1 : index + 2] == ";":
            current.append(";")
            index += 2
            continue
        nesting += (letter == "[") - (letter == "]")
        if letter == ";" and nesting <= 0:
            parts.append("".join(current))
            current = []
        else:
            current.append(letter)
        index += 1
    parts.append("".join(current))
    return [part for part in parts if part]


def find_position(items: Sequence[Word], keyword: str) -> int:
    """Where a keyword stands among arguments, -1 when it does not."""
    return next((index for index, item in enumerate(items) if item == keyword), -1)


def find_next(items: Sequence[Word], keyword: str) -> Word | None:
    """The argument after a keyword, None when there is none."""
    index = find_position(items, keyword)
    return items[index + 1] if 0 <= index < len(items) - 1 else None


def split_words(items: Iterable[Word]) -> list[Word]:
    """All list items inside the words, each with its own place where that is known."""
    found: list[Word] = []
    for item in items:
        if ";" in item:
            found.extend(item.parts or [wrap(part, item.at, item.conditions, item.sure) for part in split_list(item)])
        elif item:
            found.append(item)
    return found


def group_by_keyword(args: list[Word], keywords: frozenset[str]) -> dict[str, list[Word]]:
    """Arguments by the keyword they follow; those before any keyword are under the empty one."""
    found: dict[str, list[Word]] = {"": []}
    current = found[""]
    for item in args:
        if item in keywords:
            current = found.setdefault(str(item), [])
        else:
            current.append(item)
    return found


LITERAL, REFERENCE, QUOTED_REFERENCE, MIXED = range(4)


class Template:
    """An argument made ready for expansion. kind tells which of the fields count: words for LITERAL, name for the two
    reference kinds, parts (texts and (scope, parts) references) for MIXED."""

    __slots__ = ("at", "kind", "name", "parts", "quoted", "raw", "words")

    def __init__(self, argument: CMakeArgument, path: str):
        self.at = at = At(path, argument.line, argument.column)
        self.raw = raw = argument.text
        self.quoted = argument.quoting != ""
        self.kind = LITERAL
        self.name = ""
        self.parts: tuple = ()
        self.words: tuple[Word, ...] = ()
        plain = argument.quoting == "[" or ("$" not in raw and "\\" not in raw)
        simple = None if plain else _SIMPLE.fullmatch(raw)
        if simple is not None:
            self.kind = QUOTED_REFERENCE if self.quoted else REFERENCE
            self.name = simple.group(1)
            return
        parts = [raw] if plain else _parse(raw)
        if all(isinstance(part, str) for part in parts):
            text = "".join(parts)
            self.words = tuple(wrap(part, at) for part in ([text] if self.quoted else split_list(text)))
            return
        self.kind = MIXED
        self.parts = tuple(parts)


_SIMPLE = re.compile(r"\$\{([A-Za-z0-9_./+-]+)\}")
_PIECE = re.compile(r"[^\\$}]+|\\(?:.|\n)|\$(ENV|CACHE)?\{|\}|\$|\\", re.DOTALL)
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r", "0": ""}


def _parse(raw: str) -> list:
    """Texts and references of an argument. A reference is (scope, parts): scope is empty, ENV or CACHE."""
    stack: list[tuple[str, list]] = [("", [])]
    for piece in _PIECE.finditer(raw):
        text = piece.group()
        current = stack[-1][1]
        first = text[0]
        if first == "\\":
            following = text[1:]
            if following == "\n":
                continue
            if following == ";":
                current.append(";" if len(stack) > 1 else "\\;")
            else:
                current.append(_ESCAPES.get(following, following))
        elif first == "$" and text[-1] == "{" and len(stack) < _MAX_NESTING:
            stack.append((piece.group(1) or "", []))
        elif first == "}" and len(stack) > 1:
            scope, parts = stack.pop()
            stack[-1][1].append((scope, tuple(parts)))
        else:
            current.append(text)
    while len(stack) > 1:  # a reference that is never closed stays as it is written
        scope, parts = stack.pop()
        stack[-1][1].extend([f"${scope}{{", *parts])
    return stack[0][1]


def read_references(
    parts: tuple, lookup: Callable[[str, str], CMakeValue | None]
) -> tuple[str, bool, tuple[Condition, ...]]:
    """Text of a MIXED template, whether it is sure, and the conditions of what went into it. A variable that is not set
    stays as it is written."""
    texts: list[str] = []
    sure = True
    conditions: tuple[Condition, ...] = ()
    for part in parts:
        if isinstance(part, str):
            texts.append(part)
            continue
        scope, inner = part
        if len(inner) == 1 and isinstance(inner[0], str):
            name = inner[0]
        else:
            name, name_sure, _ = read_references(inner, lookup)
            sure = sure and name_sure
        value = lookup(scope, name)
        if value is None:
            texts.append(f"${scope}{{{name}}}")
            sure = False
            continue
        texts.append(value.text)
        sure = sure and value.sure
        for item in value.chosen:
            if item.conditions and item.conditions != conditions:
                conditions += tuple(held for held in item.conditions if held not in conditions)
    return "".join(texts), sure, conditions


def add_conditions(items: Iterable[Word], conditions: tuple[Condition, ...]) -> tuple[Word, ...]:
    """The words, each under these conditions as well."""
    if not conditions:
        return tuple(items)
    return tuple(
        item if item.conditions == conditions else wrap(item, item.at, merge(conditions, item.conditions), item.sure)
        for item in items
    )


def merge(outer: tuple[Condition, ...], inner: tuple[Condition, ...]) -> tuple[Condition, ...]:
    """Both sets of conditions, outermost first, each once."""
    if not inner or inner == outer:
        return outer
    if not outer:
        return inner
    return outer + tuple(condition for condition in inner if condition not in outer)
