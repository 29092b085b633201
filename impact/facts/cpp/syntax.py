"""What a join asks about the code of a C++ file beyond its facts, and what the store keeps of it: what the file
declares, how words are mentioned in its text, and what stands at certain places.

Mentions are found without a parser. They tell where one is worth its time: most words that stand in a file are not the
names that somebody asks about.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import lru_cache
from itertools import chain, islice
from typing import NamedTuple

import msgspec

from ..place import Problem
from ..usage import Rows, find_template_arguments
from .lexical import COMMENT, KEYWORDS, CppFile, decode_source, find_words
from .names import split_at_commas
from .schema import CppUse, FileDeclarations

ASSIGNING = {f"operator{sign}=": f"{sign}=" for sign in "+-*/"}
"""Operators by name that are looked for where they stand behind an object, to the sign that they are written with."""
UNREAD = -2
"""A number of arguments that is not known, or that only a parser can count."""


class Given(NamedTuple):
    """What parentheses or braces behind a name give. number: how many arguments; -1 where they open something else,
    UNREAD where it takes a parser. shown: by argument, what it may show itself to be; empty where none shows."""

    number: int
    shown: tuple[tuple[str, ...], ...] = ()


class Mention(NamedTuple):
    """A place where a word stands in a text, in comments too.

    form: `member` (behind `.` or `->`), `scoped`, `declared` (behind a type, or in a sentence), `assigned` (an
    operator) or `bare`. ahead: the scopes as written, without blanks and the colons at their end, empty where others
    than names stand there; of an operator the word, or the sign, before it. of_std: the scopes are a template of std.
    call: what is given behind it; construction: the same where it may be a class. templated: how many template
    arguments stand behind it, -1 for none, UNREAD where it takes a parser. typed: a type may stand before it. listed: a
    colon or comma stands before it and a bracket behind it, as in the initializer list of a constructor. names: what it
    may declare, as the type before these names."""

    word: str
    offset: int
    form: str
    ahead: str = ""
    of_std: bool = False
    call: Given | None = None
    construction: Given | None = None
    templated: int = -1
    typed: bool = False
    listed: bool = False
    names: tuple[str, ...] = ()


class MentionedCpp(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """mentions: of the words that are asked for, word by word."""

    mentions: tuple[Mention, ...] = ()
    problems: tuple[Problem, ...] = ()


class UsedCpp(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """uses: those that stand at the places that are asked for, in their order; what is declared there is left out."""

    uses: tuple[CppUse, ...] = ()
    problems: tuple[Problem, ...] = ()


def declared_cpp(data: bytes, facts: CppFile, table: None) -> FileDeclarations:
    """What a C++ file declares outside of functions."""
    return _open_code(data).declarations


def used_cpp(data: bytes, facts: CppFile, table: Rows[tuple[str, int]]) -> UsedCpp:
    """The uses that stand at places of a C++ file: words with their offsets."""
    return UsedCpp(tuple(_open_code(data).list_uses(table.rows)))


def mentioned_cpp(data: bytes, facts: CppFile, table: Rows[str]) -> MentionedCpp:
    """How words are mentioned in a C++ file."""
    text = decode_source(data)
    found = (islice(_list_mentions(text, word), _MOST_MENTIONS) for word in table.rows)
    return MentionedCpp(tuple(chain.from_iterable(found)))


@lru_cache(maxsize=2)  # what a file declares and uses is asked in turns
def _open_code(data: bytes):
    from .code import CppCode  # late: stored facts need no parser

    return CppCode(data)


# Both are matched backwards from what stands behind them.
_LAST_WORD = re.compile(r"\w*[A-Za-z_]")
_SCOPES = re.compile(r"(?:\s*::\s*\w*[A-Za-z_])+(?![\w>:])")
_OF_STD = re.compile(r"(?<![\w:])std\s*::\s*\w+\s*<[^<>;(){}]*>\s*::\s*\Z")
# What may stand before a name that is used, and is no type of one that is declared: `emit finished()`.
_NO_TYPES = KEYWORDS | {"emit", "not", "and", "or", "xor", "compl", "bitand", "bitor"}
# What an argument shows itself to be by its text, among what can be refused.
_SHOWN = re.compile(
    r"""
      (?P<text>\w{0,3}\".*)  |  (?P<lambda>\[.*)  |  (?P<this>this)  |  (?P<new>new\b.*)
    | (?P<bool>true|false)  |  (?P<null>nullptr|NULL)
    | (?P<float>[-+]?\s*(?!0[xX])(?=\.?\d)[\d'a-zA-Z]*[.eE][\w'.+-]*)
    | (?P<integer>[-+]?\s*(?:0[xX][\w']+|\d[\d'a-df-zA-DF-Z]*))
    """,
    re.VERBOSE | re.DOTALL,
)
# The same of what its type tells, so that its name may.
_SHOWN_BY_NAME = (
    ("qos", re.compile(r"rclcpp\s*::\s*\w*QoS|(?i:qos)\w*\s*(?![\w\s:({])")),
    ("profile", re.compile(r"rmw_qos_profile|(?i:qos|profile)\w*\s*(?![\w\s:({])")),
)
_SPACE = re.compile(r"\s*")
_MARKS = re.compile(r"[()\[\]{},;<\"']|/[/*]|\.\.\.")
_LITERALS = {'"': re.compile(r'"(?:[^"\\\n]|\\.)*"'), "'": re.compile(r"'(?:[^'\\\n]|\\.)*'")}
_CONSTRUCTED = re.compile(r"\s*(?:[({]|>\s*\(|[A-Za-z_]\w*\s*(?:\(|=?\s*\{))")
_NAMES = re.compile(r"\s+([A-Za-z_]\w*(?:\s*,\s*[A-Za-z_]\w*){0,9})\s*[;={(]")
_FARTHEST, _FAR = 4000, 160
# Beyond these, a file is no person's, and reading on would take too long.
_DEEPEST, _MOST_MENTIONS = 48, 5000


def _list_mentions(text: str, word: str) -> Iterator[Mention]:
    if word in ASSIGNING:
        sign = ASSIGNING[word]
        at = text.find(sign)
        while at >= 0:
            before = _find_end_before(text, at)
            yield Mention(word, at, "assigned", _find_ahead(_LAST_WORD, text, before) or text[before - 1 : before])
            at = text.find(sign, at + len(sign))
        return
    for at in find_words(word, text):
        before, end = _find_end_before(text, at), at + len(word)
        sign = text[before - 2 : before]
        form, ahead, of_std = "bare", "", False
        if sign == "->" or sign.endswith("."):
            form = "member"
        elif sign == "::":
            form = "scoped"
            scopes = _find_ahead(_SCOPES, text, before)
            ahead = "".join(scopes.split()).removesuffix("::")
            of_std = not scopes and _OF_STD.search(text, max(0, before - _FAR), before) is not None
        elif _is_declared(text, before, at):
            form = "declared"
        opened = _SPACE.match(text, end).end()  # type: ignore[union-attr]
        last = text[before - 1 : before]
        listed = form != "scoped" and last in (":", ",") and text.startswith(("(", "{"), opened)
        typed = last in ("*", "&") or (before < at and (last in (">", "]") or last.isalnum() or last == "_"))
        opening = text.startswith("<", opened)
        types = find_template_arguments(text, opened + 1) if opening else None
        if opening and types is None:
            yield Mention(word, at, form, ahead, of_std, Given(UNREAD), Given(UNREAD), UNREAD)
            continue
        templated = _count_template_arguments(types.group()) if types is not None else -1
        opened = types.end() if types is not None else end
        constructed = _CONSTRUCTED.match(text, opened)
        declared = _NAMES.match(text, opened)
        names = tuple(declared[1].replace(",", " ").split()) if declared is not None else ()
        construction = None
        if constructed is not None:
            construction = _parse_arguments(text, constructed.end() - 1)
            if names and construction.number == 0 and text[constructed.end() - 1] == "(":
                construction = None  # `Type name()` declares a function
        opened = _SPACE.match(text, opened).end()  # type: ignore[union-attr]
        call = _parse_arguments(text, opened) if text.startswith("(", opened) else None
        yield Mention(word, at, form, ahead, of_std, call, construction, templated, typed, listed, names)


def _count_template_arguments(text: str) -> int:
    """How many stand in a text up to its `>`; UNREAD where other signs than their own may part them."""
    return UNREAD if re.search(r"\.\.\.|[(/\"']", text) else len(split_at_commas(text.removesuffix(">")))


def _find_end_before(text: str, at: int) -> int:
    """Where what stands before an offset ends, blanks left out."""
    while at and text[at - 1] in " \t\n":
        at -= 1
    return at


def _find_ahead(pattern: re.Pattern[str], text: str, end: int) -> str:
    """What stands before an offset of a text, empty where it does not match. pattern: of the same backwards."""
    found = pattern.match(text[max(0, end - _FAR) : end][::-1])
    return found[0][::-1] if found is not None else ""


def _is_declared(text: str, before: int, at: int) -> bool:
    """Whether the name at an offset stands behind a type, or in a sentence. before: where what stands before it ends.
    In capitals may be a macro, which is no type."""
    last = _find_ahead(_LAST_WORD, text, before) if "\n" not in text[before:at] else ""
    return last != "" and last not in _NO_TYPES and not last.isupper() and not last.startswith("__")


def _show(argument: str) -> tuple[str, ...]:
    if "/" in argument:
        argument = COMMENT.sub(" ", argument)
    argument = argument.strip()
    while argument.startswith("(") and argument.endswith(")"):
        argument = argument[1:-1].strip()
    shown = _SHOWN.fullmatch(argument)
    if shown is not None and shown.lastgroup is not None:
        return (shown.lastgroup,)
    return tuple(kind for kind, pattern in _SHOWN_BY_NAME if pattern.search(argument))


@lru_cache(maxsize=64)  # a call is often looked at as a construction too
def _parse_arguments(text: str, at: int) -> Given:
    """What a bracket gives that opens at an offset."""
    depth, place, angle = 1, at + 1, -1
    starts = [place]
    while (mark := _MARKS.search(text, place, at + _FARTHEST)) is not None:
        sign, place = mark.group(), mark.end()
        if sign in "([{":
            depth += 1
            if depth > _DEEPEST:
                break
        elif sign in ")]}":
            depth -= 1
            if depth == 0:
                if 0 < angle < starts[-1] and ">" in text[angle:place]:
                    return Given(UNREAD)
                ends = (*(start - 1 for start in starts[1:]), place - 1)
                given = [text[start:end] for start, end in zip(starts, ends, strict=True)]
                shown = tuple(map(_show, given))
                return Given(len(given) if len(given) > 1 or given[0].strip() else 0, shown if any(shown) else ())
        elif sign == "," and depth == 1:
            starts.append(place)
        elif sign == ";" and depth == 1:
            return Given(-1)  # the body of a class
        elif sign == "<" and depth == 1:
            types = find_template_arguments(text, place)
            if types is not None and "," in types.group():
                return Given(UNREAD)
            if types is None and angle < 0:
                angle = place
        elif sign == "..." and depth == 1:
            return Given(UNREAD)
        elif sign == "//":
            place = text.find("\n", place)
        elif sign == "/*":
            place = text.find("*/", place)
        elif sign in _LITERALS and not (sign == "'" and text[mark.start() - 1].isalnum()):
            literal = _LITERALS[sign].match(text, mark.start())
            if literal is None or text[mark.start() - 1] == "R":
                return Given(UNREAD)
            place = literal.end()
        if place < 0:
            return Given(UNREAD)
    return Given(UNREAD)
