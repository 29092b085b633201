"""Uses that a name alone does not tell: a call with so many arguments, of such a kind; an access to a member.

The tables of known changes say how such a use looks. Here it is looked for in the text of a file whose comments and
literals are blanked; nothing is resolved, so a pattern has to be particular enough to mean one thing.
"""

import hashlib
import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import lru_cache
from typing import Generic, TypeVar

import msgspec

from .condition import Condition
from .cpp.lexical import KEYWORDS, CppFile, decode_source, find_words, scan
from .expressions import find_last_literals, find_needed, has_needed
from .python.python2 import mask

T = TypeVar("T")
_MEMBER = r"(?:->|\.)\s*"


class Pattern(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """How one use looks. All expressions are regular expressions over text whose literals are blank inside.

    word: an identifier that stands in the use, or a qualified name (`std::optional`) by itself. language: `cpp`,
    `python`, or `yaml` for files of parameters, whose comments alone are blank. before: matches right up to the
    word. template: matches all of the arguments in `<>` (empty: there must be none; unset: either). arguments:
    makes it a call or an initialisation, with `2`, `1-3` or `2+` arguments. where: argument number, from 1 (from
    the end: -1), or `any`, to what must be found in it: an expression, or `<float>`, `<text>` for an expression
    that shows itself to be a floating point number or a string (a literal, or a variable that the file declares
    so), `<string>` for an object of class string, `<shared>` for a shared pointer to what the file has just made.
    names: a variable may stand between the type that `word` is and its arguments. after: matches right behind the
    use. inside: `class` for what stands right in the body of a class, or what must be found in the head of that class
    (behind its name, so that it is of its bases). file: must be found in the file. unless: must
    not be found in it; what begins with `#include` is looked for among the includes, which are blank elsewhere.
    """

    word: str
    language: str = "cpp"
    before: str = ""
    template: str | None = None
    arguments: str = ""
    where: dict[str, str] = {}
    names: bool = False
    after: str = ""
    inside: str = ""
    file: str = ""
    unless: str = ""

    @property
    def shows_no_type(self) -> bool:
        """True for a member of something whose type nothing shows, such as `->stamp`."""
        return not self.arguments and self.before == _MEMBER

    @property
    def shows_no_class(self) -> bool:
        """True for calls of members of something whose class nothing shows."""
        return self.calls and "->" in self.before and "::" not in self.before

    @property
    def calls(self) -> bool:
        """True for calls of functions, which a package may have one of its own for."""
        return bool(self.arguments) and not self.names


class WatchedUse(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A use that a table describes, by the label it has there. types: the template arguments that are written."""

    label: str
    line: int
    column: int
    conditions: tuple[Condition, ...] = ()
    types: str = ""


Place = tuple[int, int, tuple[Condition, ...], str]
_FAR = 160
_LONGEST_LINE = 500
_LONGEST = 4000
_CLOSING = {"(": ")", "{": "}", "[": "]"}
_SPACE = re.compile(r"\s*")
_TEMPLATE_ARGUMENTS = re.compile(r"[\w:,\s*&]*(?:<[\w:,\s*&]*(?:<[\w:,\s*&<>]*>[\w:,\s*&]*)*>[\w:,\s*&]*)*>")
_TEMPLATE_TEXT = re.compile(r"[\w:,\s*&<>]*")
_MOST_BRACKETS = 16
_LONGEST_TYPES = 2000
_VARIABLE = re.compile(r"\s+[A-Za-z_]\w*\s*(?=[({])")
_BEFORE_CALL = re.compile(r"(?:([A-Za-z_]\w*)|(>))\s+(?:[A-Za-z_]\w*\s*::\s*)*\Z")
_NOT_A_TYPE = frozenset((
    "return", "else", "throw", "new", "co_return", "co_await", "co_yield", "case", "and", "or", "not", "do", "in", "if",
    "elif", "while",
))  # fmt: skip
_KINDS = frozenset(("<float>", "<text>", "<string>"))
_FLOAT = re.compile(r"(?<![\w.])(?:\d+\.\d*|\.\d+|\d+(?:\.\d*)?[eE][-+]?\d+)[fFlL]?(?![\w.])|\b(?:double|float)\s*[({]")
_TEXT = re.compile(r'"|\bstd::(?:to_)?string\s*[({]|\.str\(\)')
_STRING = re.compile(r'\Astd::(?:to_)?string\s*[({]|\.str\(\)\Z|"\s*\+|\+\s*"')
_NO_STRING = re.compile(r"\.(?:c_str|data)\(|\?")
_CHRONO = re.compile(r"\d(?:h|min|s|ms|us|ns)\b|\bchrono\b")
_PARAMETER = re.compile(r"(?:const\s+)?[A-Za-z_][\w:]*(?:\s*<[^()]*>)?(?:\s*&+\s*|\s+)[A-Za-z_]\w*")
_FLOAT_CAST = re.compile(r"static_cast\s*<\s*(?:double|float)\s*>")
_INTEGER_CAST = re.compile(r"static_cast|\bint\s*\(|\(int\)|\(long\)|\b(?:round|floor|ceil|trunc)\b|[<>=!]=?|\?")
_OPENED = re.compile(rb"\s*\(")
_AHEAD_OF_DECLARED = frozenset((b"", b" ", b"\t", b"\n", b":"))
_SCOPES = re.compile(rb"(?:[A-Za-z_]\w*::)+\Z")
_NO_TYPE_ENDS = frozenset((b"", b";", b"{", b"}", b",", b"(", b"=", b":"))
# A type at the end of a line that begins no comment.
_TYPE_AHEAD = re.compile(rb"\A(?!\s*(?://|\*))[^/\n]*?([A-Za-z_]\w*|[>*]|(?<!&)&)[ \t]+\Z")
# A macro in the place of a type: `SERVICE_PTR(T) create(...)`.
_MACRO_AHEAD = re.compile(rb"\A(?!\s*(?://|\*))[^/\n]*?\b([A-Z][A-Z0-9_]+)[ \t]*\([\w:<>, \t]*\)[ \t]+\Z")
# The same before a variable, which may be a reference or a pointer.
_TYPE_OF_VARIABLE = re.compile(rb"\A(?!\s*(?://|\*))[^/\n]*?([A-Za-z_]\w*|>)(?:\s*[&*]+\s*|[ \t]+)\Z")
_ASSIGNED = re.compile(rb"\s*(?:\[\w*\]\s*)?=(?!=)")
_IDENTIFIER = re.compile(r"(?<![\w.>:])[A-Za-z_]\w*(?!\s*[\w(.:<]|->)")


class UsageTable:
    """What to look for in C++ files: patterns with their labels, by a word that stands in each; and bare words.

    stamp: differs whenever another table does. heads: first parts of words that are qualified names. called: words that
    are functions in some pattern. keywords: words that are keywords of C++.
    """

    def __init__(self, patterns: Mapping[str, Sequence[tuple[str, Pattern]]], words: Collection[str] = ()):
        self.patterns = patterns
        self.words = frozenset(words)
        self.stamp = compute_stamp(sorted(patterns.items()), sorted(self.words))
        self.heads = frozenset(word.partition("::")[0] for word in patterns if "::" in word)
        self._heads = tuple(f"{head}::" for head in sorted(self.heads))
        self.keywords = sorted(KEYWORDS.intersection(patterns))
        self._needed: dict[str, list[tuple[tuple[str, Pattern], tuple[tuple[str, ...], ...]]]] = {}
        self.called = frozenset(word for word, rows in patterns.items() if any(p.calls for _, p in rows))

    def select_likely_rows(self, word: str, vocabulary: str) -> list[tuple[str, Pattern]]:
        """The rows of a word without those whose uses have a word, or a part of one, that a file lacks. vocabulary: the
        words of the file."""
        rows = self._needed.get(word)
        if rows is None:
            rows = self._needed[word] = [(row, _find_needed_parts(row[1])) for row in self.patterns[word]]
        return [row for row, needed in rows if all([any([part in vocabulary for part in each]) for each in needed])]

    def list_qualified_uses(self, facts: CppFile) -> Iterator[WatchedUse]:
        """Uses that are told by a qualified name as it stands, so that the file need not be looked at again."""
        for name in facts.qualified:
            if name.text.startswith(self._heads):
                for label, _ in self.patterns.get("::".join(name.text.split("::", 2)[:2]), ()):
                    yield WatchedUse(label, name.line, name.column, name.conditions)


class Rows(Generic[T]):
    """What to look for in files: words, places, or labels with patterns. stamp: differs whenever other rows do."""

    def __init__(self, rows: Sequence[T]):
        self.rows = rows
        self.stamp = compute_stamp(rows)


def compute_stamp(*tables: object) -> str:
    """A digest of what tables say."""
    return hashlib.sha1(repr(tables).encode()).hexdigest()[:16]


def find_uses(facts: CppFile, data: bytes, table: UsageTable) -> tuple[tuple[WatchedUse, ...], tuple[str, ...]]:
    """The uses in a C++ file that a table describes, see uses_of(), and those functions that such uses call and the
    file declares itself, or defines as macros. Never raises."""
    patterns = table.patterns
    vocabulary = scan(data).tokens_text
    spoken = {*facts.words.split(" "), *"::".join([name.text for name in facts.qualified]).split("::")}
    spoken.update([word for word in table.keywords if word in vocabulary])
    uses = list(table.list_qualified_uses(facts))
    functions = []
    for word in sorted(patterns.keys() & spoken):
        # What is all in capitals is a macro, which a definition alone makes one's own.
        if word in table.called and (word in facts.defined or (not word.isupper() and declares(data, word))):
            functions.append(word)
        rows = table.select_likely_rows(word, vocabulary)
        if rows:
            uses.extend(list_row_uses(data, rows))
    return tuple(uses), tuple(functions)


def list_row_uses(data: bytes, rows: Sequence[tuple[str, Pattern]]) -> Iterator[WatchedUse]:
    """Every call that a row describes, and the first of its other uses under each set of conditions. rows: labels and
    patterns of one word."""
    seen = set()
    for number, place in find_use_places(data, *(pattern for _, pattern in rows)):
        label, pattern = rows[number]
        key = (number, place[2], place[:2] if pattern.calls else ())
        if key not in seen:
            seen.add(key)
            yield WatchedUse(label, *place)


def find_template_arguments(text: str, at: int) -> re.Match[str] | None:
    """The arguments of a template, from behind its `<` to its `>`; None where they are none, or too many to be read."""
    end = _TEMPLATE_TEXT.match(text, at, at + _LONGEST_TYPES).end()  # type: ignore[union-attr]
    while text.count("<", at, end) > _MOST_BRACKETS:
        # Brackets can be paired in very many ways: only the first are.
        end = text.rfind("<", at, end)
    return _TEMPLATE_ARGUMENTS.match(text, at, end)


def declares(data: bytes, function: str) -> bool:
    """Whether a C++ file seems to declare or define a function of this name: a type, or a macro for one, stands before
    it in its line, or at the end of the line before where it begins its own."""
    for at, end in _find_occurrences(function.encode(), data):
        # Behind a blank a type may stand, behind colons a scope, and the start of a line tells nothing.
        if data[at - 1 : at] in _AHEAD_OF_DECLARED and _OPENED.match(data, end) is not None:
            start = _find_line_start(data, at)
            ahead = _SCOPES.sub(b"", data[start:at])
            if start and (not ahead or ahead.isspace()):
                ahead = data[_find_line_start(data, start - 1) : start - 1].rstrip() + b" "
            if ahead.rstrip(b" \t")[-1:] in _NO_TYPE_ENDS:
                continue
            found = _TYPE_AHEAD.search(ahead) or _MACRO_AHEAD.search(ahead)
            if found is not None and found.group(1).decode("ascii", "replace") not in _NOT_A_TYPE:
                return True
    return False


_DEFINED = re.compile(rb"(?m)^[ \t]+(?:async[ \t]+)?def[ \t]+(\w+)[ \t]*\(")


def find_methods(data: bytes, functions: Collection[str]) -> tuple[str, ...]:
    """Those of some functions that a Python file seems to define as methods, or in functions."""
    if not any(function.encode() in data for function in functions):
        return ()
    return tuple(sorted({name.decode() for name in _DEFINED.findall(data)}.intersection(functions)))


def initializes_variable(data: bytes, variable: str) -> bool:
    """Whether a C++ file declares a variable of this name with a value: a type stands before it and `=` behind."""
    for at, end in _find_occurrences(variable.encode(), data):
        before = data[at - 1 : at]
        if _ASSIGNED.match(data, end) is None or before.isalnum() or before == b"_":
            continue
        begins = max(_find_line_start(data, at), at - _FAR)
        ahead = _TYPE_OF_VARIABLE.search(data[begins:at])
        if ahead is not None and ahead.group(1).decode("ascii", "replace") not in _NOT_A_TYPE:
            return True
    return False


# How an enum begins, up to one of its constants: `enum class Code : int { A = 1, `.
_ENUM = re.compile(rb"enum\b(?:\s+(?:class|struct)\b)?(?:\s+[A-Za-z_]\w*)?(?:\s*:[\w:\s]+)?\s*\{(?:[^{}]*,)?\s*\Z")
_COMMENT = re.compile(rb"//[^\n]*|/\*.*?\*/", re.DOTALL)
_LONGEST_ENUM = 20_000
_WORD = re.compile(rb"\w")


def has_enum_constant(data: bytes, constant: str) -> bool:
    """Whether a C++ file has a constant of this name in an enum."""
    for at, end in _find_occurrences(constant.encode(), data):
        begins = data.rfind(b"enum", max(0, at - _LONGEST_ENUM), at)
        whole = not (_WORD.match(data[at - 1 : at]) or _WORD.match(data[end : end + 1]))
        if begins >= 0 and whole and _ENUM.match(_COMMENT.sub(b"", data[begins:at])):
            return True
    return False


def _find_line_start(data: bytes, at: int) -> int:
    """Where the line that a place stands in begins, or the last part of one that nobody wrote by hand."""
    earliest = max(0, at - _LONGEST_LINE)
    return max(data.rfind(b"\n", earliest, at) + 1, earliest)


def _find_occurrences(name: bytes, data: bytes) -> Iterator[tuple[int, int]]:
    """Where a name begins and ends, within other words too."""
    at = data.find(name)
    while at >= 0:
        yield at, at + len(name)
        at = data.find(name, at + len(name))


def find_use_places(data: bytes, *patterns: Pattern) -> Iterator[tuple[int, Place]]:
    """Every use that looks like one of the patterns, which are of one word and language, pattern by pattern: the number
    of the pattern, then line, column, preprocessor conditions and template arguments. Never raises."""
    word, language = patterns[0].word, patterns[0].language
    scanned = scan(data) if language == "cpp" else None
    text = scanned.visible if scanned is not None else _TEXTS[language](data)
    places: list[tuple[int, str]] = []
    ends = [find_last_literals(pattern.before) for pattern in patterns]
    lasts = tuple(last for each in ends for last in each) if all(ends) else ("",)
    for at in find_words(word, text):
        far = max(0, at - _FAR)
        ahead = text[far:at]
        if ahead.rstrip().endswith(lasts):
            # No use reaches back over the end of the statement before it.
            places.append((at, ahead[max(0, ahead.rfind(";")) :]))
    fitting = {"": places}
    for number, pattern in enumerate(patterns if places else ()):
        before = pattern.before
        if before not in fitting:
            last = find_last_literals(before)
            likely = [place for place in places if place[1].rstrip().endswith(last)] if last else places
            search = _compile(rf"(?:{before})\Z").search if likely else None
            fitting[before] = [place for place in likely if search is not None and search(place[1]) is not None]
        checked = not (pattern.file or pattern.unless)
        for at, ahead in fitting[before]:
            types = _fits(pattern, text, at + len(word), ahead)
            if types is None or (pattern.inside and not _stands_inside(pattern.inside, text, at)):
                continue
            conditions = () if scanned is None else scanned.find_conditions(at)
            if conditions is None:
                continue  # in a directive
            if not checked and not _is_in_such_a_file(pattern, data, text):
                break
            checked = True
            line, column = locate_in(text, at) if scanned is None else scanned.locate(at)
            yield number, (line, column, conditions, types)


def _find_needed_parts(pattern: Pattern) -> tuple[tuple[str, ...], ...]:
    """Parts of words in every file that has a use of a pattern, one of each tuple; arguments of a kind need none."""
    file = "" if "#include" in pattern.file + pattern.unless else pattern.file
    expressions = (pattern.before, pattern.template or "", pattern.after, file, *pattern.where.values())
    found = (find_needed("make_shared" if each == "<shared>" else each) for each in expressions if each not in _KINDS)
    return tuple(dict.fromkeys(part for parts in found for part in parts))


def _is_in_such_a_file(pattern: Pattern, data: bytes, text: str) -> bool:
    """Whether a file has what a pattern wants in it, and not what it does not."""
    whole = data.decode("utf-8", "replace") if "#include" in pattern.file + pattern.unless else text
    if pattern.file and not _stands_in(pattern.file, whole):
        return False
    return not pattern.unless or not _stands_in(pattern.unless, whole)


@lru_cache(maxsize=64)
def _stands_in(expression: str, text: str) -> bool:
    """Whether a file has what an expression looks for; many rows ask the same of it."""
    return has_needed(expression, text) and _compile(expression).search(text) is not None


def locate_in(text: str, offset: int) -> tuple[int, int]:
    """Line and column of an offset, from 1."""
    return text.count("\n", 0, offset) + 1, offset - text.rfind("\n", 0, offset)


@lru_cache(maxsize=4096)
def _compile(expression: str) -> re.Pattern[str]:
    return re.compile(expression)


_LONGEST_HEAD = 400


def _fits(pattern: Pattern, text: str, end: int, ahead: str) -> str | None:
    """The template arguments of a use (empty: none), None where the text does not look like the pattern. end: of the
    word. ahead: what stands before it, which fits."""
    at, shown = end, ""
    opened = _SPACE.match(text, at).end()  # type: ignore[union-attr]
    if pattern.language == "cpp" and text.startswith("<", opened):
        types = find_template_arguments(text, opened + 1)
        if types is not None:
            if pattern.template is not None and not _compile(pattern.template).fullmatch(types.group()[:-1].strip()):
                return None
            if pattern.template == "":
                return None
            at, shown = types.end(), " ".join(types.group()[:-1].split())
        elif pattern.template:
            return None
    elif pattern.template:
        return None
    if pattern.arguments:
        variable = _VARIABLE.match(text, at) if pattern.names else None
        at = variable.end() if variable else _SPACE.match(text, at).end()  # type: ignore[union-attr]
        if text[at : at + 1] not in ("(", "{") or (text[at] == "{" and not pattern.names):
            return None
        if text[at] == "{" and _OPENING_CLASS.search(text, max(0, end - _LONGEST_HEAD), end):
            return None  # the body of a class that derives from it
        if not pattern.names and declares_next(ahead):
            return None
        found = split_arguments(text, at)
        if found is None:
            return None
        given, at = found
        if not _matches_count(pattern.arguments, len(given)):
            return None
        for which, wanted in pattern.where.items():
            if which == "any":
                chosen = given
            else:
                number = int(which)
                index = number - 1 if number > 0 else number
                if not -len(given) <= index < len(given):
                    return None
                chosen = [given[index]]
            if not any(_is(argument, wanted, text) for argument in chosen):
                return None
    return shown if not pattern.after or _compile(pattern.after).match(text, at) else None


_OPENING_CLASS = re.compile(r"\b(?:class|struct)\s[^;{}()=]*\Z")


def _stands_inside(wanted: str, text: str, at: int) -> bool:
    """Whether a place stands in the body of a class, or of one whose head has what an expression looks for."""
    head = _find_class_around(text, at)
    return bool(head) and (wanted == "class" or _compile(wanted).search(head.partition(":")[2]) is not None)


def _find_class_around(text: str, at: int) -> str:
    """The head of the class in the body of which a place stands, not in a function of it; empty where there is none."""
    depth, position = 0, at
    while True:
        opened, closed = text.rfind("{", 0, position), text.rfind("}", 0, position)
        if opened == closed:
            return ""
        position = max(opened, closed)
        if closed > opened:
            depth += 1
        elif depth:
            depth -= 1
        else:
            begins = max(text.rfind(end, 0, position) for end in ";{}") + 1
            found = _OPENING_CLASS.search(text[begins:position])
            return found.group() if found is not None else ""


def declares_next(ahead: str) -> bool:
    """Whether a name behind this text is declared, not called: a type stands before it."""
    # Neither a type nor scopes have any of these in them: what stands before them need not be looked at.
    match = _BEFORE_CALL.search(ahead, max(map(ahead.rfind, ";{}(),=")) + 1)
    return bool(match) and match.group(1) not in _NOT_A_TYPE


def split_arguments(text: str, at: int) -> tuple[list[str], int] | None:
    """The arguments of the call whose bracket opens at an offset, and where it ends; None when it does not."""
    found = find_argument_spans(text, at)
    return ([text[begins:ends].strip() for begins, ends in found[0]], found[1]) if found is not None else None


_DIVIDER = re.compile(r"[(){}\[\]<,]")


def find_argument_spans(text: str, at: int) -> tuple[list[tuple[int, int]], int] | None:
    """The same by where each argument begins and ends, blanks around it included."""
    given, depth, begins, last = [], [_CLOSING[text[at]]], at + 1, min(len(text), at + _LONGEST)
    position = at + 1
    while (mark := _DIVIDER.search(text, position, last)) is not None:
        place, character = mark.start(), mark[0]
        position = place + 1
        if character in _CLOSING:
            depth.append(_CLOSING[character])
        elif character in ")}]":
            if character != depth.pop():
                return None
            if not depth:
                if given or text[begins:place].strip():
                    given.append((begins, place))
                return given, position
        elif character == "<":
            types = find_template_arguments(text, position)
            if types is not None and text[types.end() : types.end() + 1] in ("(", "{", ":", ",", ")", ">"):
                position = types.end()
        elif len(depth) == 1:
            given.append((begins, place))
            begins = position
    return None


def _matches_count(wanted: str, given: int) -> bool:
    if wanted.endswith("+"):
        return given >= int(wanted[:-1])
    low, _, high = wanted.partition("-")
    return int(low) <= given <= int(high or low)


def _is(argument: str, wanted: str, text: str) -> bool:
    if wanted.startswith("<") and _PARAMETER.fullmatch(argument):
        return False  # what stands in the declaration of a function
    if wanted == "<float>":
        if _INTEGER_CAST.search(argument) and not _FLOAT_CAST.match(argument):
            return False
        outer = _remove_call_arguments(argument)
        if _CHRONO.search(outer):
            return False
        return bool(_FLOAT_CAST.match(argument) or _FLOAT.search(outer)) or _is_declared_as(outer, "double|float", text)
    if wanted == "<text>":
        return bool(_TEXT.search(argument)) or _is_declared_as(argument, r"(?:std\s*::\s*)?string", text)
    if wanted == "<string>":
        if _NO_STRING.search(argument):
            return False
        return bool(_STRING.search(_remove_call_arguments(argument))) or (
            argument.isidentifier() and _is_declared_as(argument, r"(?:std\s*::\s*)?string", text)
        )
    if wanted == "<shared>":
        return argument.isidentifier() and _is_made_shared(argument, text)
    return bool(_compile(wanted).search(argument))


_CALL = re.compile(r"(?<=[\w>])\s*[({][^(){}]*[)}]")


def _remove_call_arguments(expression: str) -> str:
    """An expression without what is handed to the functions that it calls."""
    while True:
        shorter = _CALL.sub("\x00\x01", expression)
        if shorter == expression:
            return expression.replace("\x00", "(").replace("\x01", ")")
        expression = shorter


_TYPE_ENDS = frozenset(" \t\n&*\v\f\x1c\x1d\x1e\x1f\x85\xa0")
_DECLARED_AHEAD = re.compile(r"\s*[;={,)(]")
_TYPE_OF = re.compile(r"([\w:]+|char\s*\*)(?:\s*&\s*|\s+)\Z")
_SHARED_AHEAD = re.compile(r"\s*([;={,)(][^;]{0,60})")
_SHARED_TYPE = re.compile(r"([\w:>]+)(\s*[&*]+\s*|\s+)\Z")


def _find_type_ahead(pattern: re.Pattern[str], text: str, at: int) -> re.Match[str] | None:
    """The type before a variable, behind which a blank or mark stands."""
    return pattern.search(text, max(0, at - _FAR), at) if text[at - 1 : at] in _TYPE_ENDS else None


def _is_declared_as(argument: str, types: str, text: str) -> bool:
    """Whether a variable of an arithmetic expression is declared with one of the types, and nowhere with another."""
    for name in _IDENTIFIER.findall(argument):
        declared = []
        for at in find_words(name, text):
            if _DECLARED_AHEAD.match(text, at + len(name)):
                found = _find_type_ahead(_TYPE_OF, text, at)
                if found and found.group(1) not in _NOT_A_TYPE:
                    declared.append(found.group(1))
        if declared and all(re.fullmatch(types, d) for d in declared):
            return True
    return False


def _is_made_shared(name: str, text: str) -> bool:
    """Whether a file declares a variable as a shared pointer that it makes, and nowhere declares it otherwise."""
    declared = []
    for at in find_words(name, text):
        ahead = _SHARED_AHEAD.match(text, at + len(name))
        found = _find_type_ahead(_SHARED_TYPE, text, at) if ahead else None
        if ahead and found and found.group(1) not in _NOT_A_TYPE:
            declared.append((found.group(1), found.group(2), ahead.group(1)))
    return bool(declared) and all(
        not between.strip() and ahead.startswith("=") and "make_shared" in ahead for _, between, ahead in declared
    )


@lru_cache(maxsize=2)
def blank_python(data: bytes) -> str:
    """The text of a Python file with comments and the insides of literals blanked, offsets kept."""
    return mask(decode_source(data)).replace("'", '"')


_YAML_COMMENT = re.compile(r"(?m)(?:^|(?<=[ \t]))#.*$")


def blank_yaml(data: bytes) -> str:
    """The text of a YAML file with comments blanked, offsets kept."""
    return _YAML_COMMENT.sub(lambda match: " " * len(match.group()), decode_source(data))


_TEXTS = {"python": blank_python, "yaml": blank_yaml}
