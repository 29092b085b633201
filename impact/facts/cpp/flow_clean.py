"""A C++ source made ready for its grammar: macros that break the parse are blanked, and no offset moves."""

import re
from bisect import bisect_right
from collections.abc import Sequence
from functools import partial
from itertools import pairwise
from typing import NamedTuple

from .lexical import (
    Directive,
    blank_stretches,
    decode_source,
    find_line_starts,
    list_conditional_blocks,
    make_blanks,
    scan,
)


class Region(NamedTuple):
    """A stretch that stands under a preprocessor condition and whose directives were blanked."""

    start: int
    end: int
    condition: str
    line: int


class Regions:
    """Stretches, of which one lies in another or beside it, and which of them are around a place."""

    def __init__(self, regions: Sequence[Region]):
        self._regions = regions
        self._outer: list[int] = []  # for each, the one around it
        self._turns: list[int] = [0]  # where another stretch becomes the innermost
        self._inner: list[int] = [-1]  # the innermost from there on
        opened: list[int] = []
        for number, region in enumerate(regions):
            self._close(opened, region.start)
            self._outer.append(opened[-1] if opened else -1)
            opened.append(number)
            self._turn(region.start, number)
        self._close(opened, -1)

    def _close(self, opened: list[int], at: int) -> None:
        while opened and (at < 0 or self._regions[opened[-1]].end <= at):
            end = self._regions[opened.pop()].end
            self._turn(end, opened[-1] if opened else -1)

    def _turn(self, at: int, number: int) -> None:
        self._turns.append(at)
        self._inner.append(number)

    def list_between(self, outside: int, inside: int) -> list[Region]:
        """Those around the place `inside` that begin behind the place `outside`, the outermost first."""
        found: list[Region] = []
        number = self._inner[bisect_right(self._turns, inside) - 1]
        while number >= 0 and self._regions[number].start > outside:
            found.append(self._regions[number])
            number = self._outer[number]
        found.reverse()
        return found


class Cleaned(NamedTuple):
    """text: the source; source: what is parsed, one byte for each character of text; starts: the offset of every
    line; regions: where directives were blanked; hidden: lines (first, last) that were left out."""

    text: str
    source: bytes
    starts: list[int]
    regions: tuple[Region, ...] = ()
    hidden: tuple[tuple[int, int], ...] = ()


_NOT_ASCII = re.compile(r"[^\x01-\x7f]")
_VISIBILITY_ENDS = ("_PUBLIC", "_EXPORT", "_API", "_LOCAL")
_VISIBILITY = re.compile(r"_(?:PUBLIC|EXPORTS?|LOCAL|API)(?:_TYPE)?\b(?=\s+(?:[A-Za-z_~]|::|\[\[))")
_LAST_WORD = re.compile(r"[A-Z][A-Z0-9_]*\Z")
_CLASS_MACRO = re.compile(
    r"(?:class|struct)\s+(?P<gone>[A-Z][A-Z0-9_]{5,}(?:\([^()\n]*\))?)(?=\s+\w+\s*(?:final\s*)?[:{])"
)
# Words that stand where the grammar knows none; gone, what is around them is plain C++.
_BARE = (
    "Q_OBJECT", "Q_GADGET", "Q_NAMESPACE", "Q_INVOKABLE", "Q_SLOT", "Q_SIGNAL", "Q_DECL_OVERRIDE", "Q_EMIT",
    "EIGEN_MAKE_ALIGNED_OPERATOR_NEW", "EIGEN_STRONG_INLINE", "EIGEN_DEVICE_FUNC", "BOOST_FORCEINLINE",
    "ROS_DEPRECATED", "ROS_FORCE_INLINE", "PCL_MAKE_ALIGNED_OPERATOR_NEW", "TF2_PUBLIC", "BOOST_NOEXCEPT",
    "__BEGIN_DECLS", "__END_DECLS", "__global__", "__device__", "__host__",
)  # fmt: skip
_RARE_VISIBILITY = re.compile(r"\b[A-Z][A-Z0-9_]*_(?:DECL|VISIBILITY|IMPORT|HIDDEN)\b(?=\s+(?:[A-Za-z_~]|::|\[\[))")
_BARE_WORD = re.compile(r"\b(?:" + "|".join(_BARE) + r")\b(?!\s*\()")
_FORMATS = re.compile(r"\bPRI[diouxX](?:LEAST|FAST)?(?:8|16|32|64|MAX|PTR)\b")
_SLOTS = re.compile(r"\b(?:public|protected|private)\s+(?P<gone>slots|Q_SLOTS)(?=\s*:)")
_SIGNALS = re.compile(r"^([ \t]*)(signals|Q_SIGNALS)([ \t]*:)(?!:)", re.MULTILINE)
_EACH_NAMES = ("_FOREACH", "foreach")
_EACH = re.compile(r"\b(?:BOOST_FOREACH|BOOST_REVERSE_FOREACH|Q_FOREACH|foreach)(?=\s*\()")
_BETWEEN = re.compile(r"[(),<>;{}]")


# The grammar takes quadratic time for attributes in a row; no code has that many.
_MOST_ATTRIBUTES = 32
_ATTRIBUTES = re.compile(rf"(?:\[\[[^\[\]]*\]\]\s*){{{_MOST_ATTRIBUTES},}}")


def clean_source(data: bytes) -> Cleaned:
    """The source of a file, ready to be parsed. Undecodable bytes become replacement characters, line breaks `\\n`."""
    text = decode_source(data)
    source = text
    if not source.isascii() or "\0" in source:
        source = _NOT_ASCII.sub(_stand_in, source)
    if source.count("]]") >= _MOST_ATTRIBUTES:
        source = blank_stretches(source, [match.span() for match in _ATTRIBUTES.finditer(source)])
    if any(end in source for end in _VISIBILITY_ENDS):
        source = _blank_visibility(source)
    if any(name in source for name in _EACH_NAMES):
        source = _rewrite_foreach(source)
    return Cleaned(text, source.encode(), find_line_starts(text))


def clean_further(data: bytes, before: Cleaned) -> Cleaned:
    """The source of a file that did not parse as it was: what is dear to look for is blanked too."""
    source = before.source.decode()
    for words, pattern, stand_in in _FURTHER:
        if any(word in source for word in words):
            source = pattern.sub(stand_in, source)
    source, regions, hidden = _flatten_branches(data, before.text, source, before.starts)
    return Cleaned(before.text, source.encode(), before.starts, regions, hidden)


def has_lone_macro(text: str, begin: int, end: int) -> bool:
    """Whether a macro stands alone on a line of a stretch, which may declare anything: none that is known to say how
    something is seen, stored or compiled."""
    found = (match["gone"] for match in _LONE_MACRO.finditer(text, begin, end))
    return any(word not in _BARE and not _NO_MEMBERS.match(word) for word in found)


def _blank_visibility(source: str) -> str:
    """`class FOO_PUBLIC A` as `class            A`. Searched from the end of the word, which is the rarer part."""
    gone: list[tuple[int, int]] = []
    for match in _VISIBILITY.finditer(source):
        line = source.rfind("\n", 0, match.start()) + 1
        word = _LAST_WORD.search(source, max(line, gone[-1][1] if gone else 0), match.start())
        if word is not None and source[line : word.start()].lstrip()[:1] != "#":
            gone.append((word.start(), match.end()))
    return blank_stretches(source, gone)


def _stand_in(match: re.Match[str]) -> str:
    # A letter, so that words in any script stay words.
    return " " if match[0] == "\0" else "x"


def _make_public(match: re.Match[str]) -> str:
    return match[1] + "public:".ljust(len(match[2]) + len(match[3]))


def _blank_unless_directive(match: re.Match[str]) -> str:
    text = match.string
    line = text.rfind("\n", 0, match.start()) + 1
    if text[line : match.start()].lstrip()[:1] == "#":
        return match[0]
    return " " * len(match[0])


def _rewrite_foreach(source: str) -> str:
    """`BOOST_FOREACH(T x, xs)` as `for(T x: xs)`."""
    pieces: list[str] = []
    position = 0
    for match in _EACH.finditer(source):
        line = source.rfind("\n", 0, match.start()) + 1
        if match.start() < position or source[line : match.start()].lstrip()[:1] == "#":
            continue
        depth = angles = 0
        comma = -1
        for mark in _BETWEEN.finditer(source, match.end(), match.end() + 2000):
            sign = mark[0]
            if sign == "(":
                depth += 1
            elif sign == ")":
                depth -= 1
                if depth == 0:
                    break
            elif sign == "<":
                angles += 1
            elif sign == ">":
                angles -= 1
            elif sign == ",":
                if depth == 1 and angles <= 0 and comma < 0:
                    comma = mark.start()
            else:
                break
        if comma < 0 or depth:
            continue
        pieces += [source[position : match.start()], "for".ljust(len(match[0])), source[match.end() : comma], ":"]
        position = comma + 1
    return "".join(pieces) + source[position:]


def _blank_group(match: re.Match[str], sign: str = " ") -> str:
    """What a pattern calls `gone` as blanks, or as a row of another sign."""
    start, (first, last) = match.start(), match.span("gone")
    return match[0][: first - start] + sign * (last - first) + match[0][last - start :]


_word_group = partial(_blank_group, sign="x")


def _blank_lone(match: re.Match[str]) -> str:
    """A macro alone on its line as blanks, where what stands before it is complete and what follows begins anew."""
    text, (first, last) = match.string, match.span("gone")
    before = _LINE_COMMENT.sub("", text[max(0, first - 500) : first]).rstrip()
    after = _LINE_COMMENT.sub("", text[last : last + 500]).lstrip()
    if (before[-1:] in (";", "{", "}", ":") or before.endswith("*/")) and _BEGINS.match(after):
        return _blank_group(match)
    return match[0]


def _replace_braces(match: re.Match[str]) -> str:
    """`= {a, b}` as `= (a, b)`, and `= {}` as `= 0 `."""
    inner = match["inner"]
    return f"={match['blanks']}({inner})" if inner.strip() else f"={match['blanks']}0{' ' * (len(inner) + 1)}"


# What the grammar does not know, and what it does that means the same: (words to look for, pattern, stand-in).
_HAS_INCLUDE = re.compile(r"__has_include(?:_next)?\s*\(\s*(?P<gone>[<\"][^>\"\n]*[>\"])")
_COMPARED = re.compile(r"^[ \t]*#[ \t]*(?:el)?if\b[^\n]*?\(\s*(?P<gone>[<>=!]=?)(?=\s*,)", re.MULTILINE)
_NEW_POINTERS = re.compile(r"new(?<!\wnew)\s+[\w:]+\s*(?P<gone>\*+)(?=\s*\[)")
_DEFAULT_BRACES = re.compile(r"=(?P<blanks>\s*)\{(?P<inner>[^{};]*)\}(?=\s*[,)])")
_TYPENAME = re.compile(r"(?:=|\breturn)\s*(?P<gone>typename)\b")
_TEMPLATE = re.compile(r"(?:->|\.)\s*(?P<gone>template)(?=\s+\w+\s*\()")
_EXTERN_TEMPLATE = re.compile(r"\b(?P<gone>extern)(?=\s+template\s+(?:class|struct)\b)")
_SIGNATURE = re.compile(r"\b(?:SIGNAL|SLOT)\s*\((?P<gone>[^()\n]*(?:\([^()\n]*\))?[^()\n]*)\)")
_EACH_LIKE, _EACH_MACRO = (
    re.compile(rf"{word}\w*\s*\((?P<gone>[^()\n]*(?:\([^()\n]*\))?[^()\n]*)\)(?=\s*\{{)")
    for word in ("ach(?<=[Ee]ach)", "EACH")
)
_STATEMENT_MACRO = re.compile(
    r"^(?P<macro>(?P<blanks>[ \t]*)[A-Z][A-Z0-9_]{3,}\([^()\n]*\))[ \n]"
    r"(?![ \t]*[{;.,=#?:&|+<*)\]-])(?!(?P=blanks)[ \t]+\S)",
    re.MULTILINE,
)
# `PCL_ADD_POINT4D` in a class, without a semicolon.
_LONE_MACRO = re.compile(r"^[ \t]*(?P<gone>[A-Z][A-Z0-9_]{4,})[ \t]*(?=//|$)", re.MULTILINE)
_NO_MEMBERS = re.compile(r"\w+_(?:PUBLIC|EXPORTS?|LOCAL|API|DECL|VISIBILITY|IMPORT|HIDDEN|DEPRECATED)(?:_TYPE)?\Z")
# `REGISTER_POINT(Point, (float, x, x)(float, y, y))`
_SEQUENCE_MACRO = re.compile(
    r"^[ \t]*(?P<gone>[A-Z][A-Z0-9_]{5,}\s*\([^();{}]*(?:\([^();{}]*\)\s*(?://[^\n]*\s*)?){2,}\))", re.MULTILINE
)
_LINE_COMMENT = re.compile(r"//[^\n]*")
_BEGINS = re.compile(r"[A-Za-z_~}]")
_NO_BREAK = re.compile(r"[^\n]")
_FURTHER = (
    (("__has_include",), _HAS_INCLUDE, _word_group),
    (("(<", "(>", "(=", "(!"), _COMPARED, _word_group),
    (("new ",), _NEW_POINTERS, _blank_group),
    (("{",), _DEFAULT_BRACES, _replace_braces),
    (("typename",), _TYPENAME, _blank_group),
    (("template",), _TEMPLATE, _blank_group),
    (("extern",), _EXTERN_TEMPLATE, _blank_group),
    (("SIGNAL", "SLOT"), _SIGNATURE, _blank_group),
    (("ach",), _EACH_LIKE, _blank_group),
    (("EACH",), _EACH_MACRO, _blank_group),
    ((")",), _STATEMENT_MACRO, r"\g<macro>;"),
    (("class ", "struct "), _CLASS_MACRO, _blank_group),
    (("_DECL", "_VISIBILITY", "_IMPORT", "_HIDDEN"), _RARE_VISIBILITY, _blank_unless_directive),
    (_BARE, _BARE_WORD, _blank_unless_directive),
    (("_",), _LONE_MACRO, _blank_lone),
    (("_",), _SEQUENCE_MACRO, lambda match: _NO_BREAK.sub(" ", match[0])),
    (("PRI",), _FORMATS, make_blanks),
    (("slots", "Q_SLOTS"), _SLOTS, _blank_group),
    (("signals", "Q_SIGNALS"), _SIGNALS, _make_public),
)
_BRACES = re.compile(r"[{}()]")
_STARTS_INSIDE = re.compile(r"\s*(?:else\b|&&|\|\||<<|[,.?)+*/=]|:(?!:)|->|-)")
_ENDS_INSIDE = re.compile(r"(?:\belse|&&|\|\||<<|[,(=?+*/]|-)\s*\Z")
_HEADED = re.compile(r"\s*(?:\}\s*else\s+)?(?:if|while|for|else\s+if)\b[^;{}]*\)\s*\Z")


def _flatten_branches(
    data: bytes, text: str, source: str, starts: list[int]
) -> tuple[str, tuple[Region, ...], tuple[tuple[int, int], ...]]:
    """The source without those #if blocks that cut through a statement: of each, the first branch is kept and becomes
    a Region, the others are left out."""
    if "#if" not in source and "# if" not in source:
        return source, (), ()
    scanned = scan(data)
    visible = scanned.visible
    if len(visible) != len(text):
        return source, (), ()
    blank: list[tuple[int, int]] = []
    regions: list[Region] = []
    hidden: list[tuple[int, int]] = []
    for directives in list_conditional_blocks(scanned.directives):
        if not _cuts_statement(visible, directives):
            continue
        first_start, first_end, first_word, condition = directives[0]
        if first_word == "ifdef":
            condition = f"defined({condition})"
        elif first_word == "ifndef":
            condition = f"!(defined({condition}))"
        line = bisect_right(starts, first_start)
        kept_end = directives[1][0]
        blank.append((first_start, first_end))
        regions.append(Region(first_end, kept_end, condition, line))
        blank.append((kept_end, directives[-1][1]))
        if len(directives) > 2:
            hidden.append((bisect_right(starts, directives[1][1]) + 1, bisect_right(starts, directives[-1][0]) - 1))
    return blank_stretches(source, sorted(blank)), tuple(sorted(regions)), tuple(hidden)


def _cuts_statement(visible: str, directives: list[Directive]) -> bool:
    """Whether an #if block cuts through a statement, so that its branches are none by themselves."""
    before = visible[max(0, directives[0][0] - 2000) : directives[0][0]]
    while True:  # directives before it are no code
        stripped = before.rstrip()
        line = stripped.rfind("\n") + 1
        if stripped[line:].lstrip()[:1] != "#":
            break
        before = stripped[:line]
    last = stripped[-1:]
    if last and last in ",(=<+-&|?":
        return True
    for (_, start, _, _), (end, _, _, _) in pairwise(directives):
        body = visible[start:end]
        depth = round_depth = 0
        for mark in _BRACES.finditer(body):
            sign = mark[0]
            if sign == "{":
                depth += 1
            elif sign == "}":
                depth -= 1
                if depth < 0:
                    return True
            elif sign == "(":
                round_depth += 1
            else:
                round_depth -= 1
                if round_depth < 0:
                    return True
        if depth or round_depth:
            return True
        if _STARTS_INSIDE.match(body) or _ENDS_INSIDE.search(body) or _HEADED.match(body):
            return True
    return False
