"""What is looked for in a file beyond its facts: made when the join of a package asks for it, and stored by content.

Most files have nothing of what a table describes, and their facts tell so; those that may have it are read again.
"""

import re
from collections.abc import Iterable, Iterator

import msgspec

from .condition import Condition
from .cpp.lexical import CppFile, find_word_uses, scan
from .place import Problem
from .usage import (
    Pattern,
    Rows,
    UsageTable,
    WatchedUse,
    declares,
    find_methods,
    find_uses,
    has_enum_constant,
    initializes_variable,
    list_row_uses,
)


class WordUse(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """The first use of a bare word outside of comments, with the preprocessor conditions around it; line 1, column 0
    where it stands in directives alone. own: the file declares a variable of this name with a value, a constant
    of an enum, or a function. in_macro: it stands in macros alone, which may be used elsewhere."""

    text: str
    line: int
    column: int
    conditions: tuple[Condition, ...] = ()
    own: bool = False
    in_macro: bool = False


class SearchedCpp(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """What a C++ file has of what a Table describes. uses: the first of every label under the same conditions.
    functions: those that such uses call and that the file declares itself. words: the bare words, in order."""

    uses: tuple[WatchedUse, ...] = ()
    functions: tuple[str, ...] = ()
    words: tuple[WordUse, ...] = ()
    problems: tuple[Problem, ...] = ()


def searched_cpp(data: bytes, facts: CppFile, table: UsageTable) -> SearchedCpp:
    """The uses, functions and words of a table that a C++ file has."""
    words = sorted(table.words.intersection(facts.words.split(" ")))
    uses, functions = find_uses(facts, data, table)
    return SearchedCpp(uses, functions, tuple(_find_word_use(data, word) for word in words))


def _find_word_use(data: bytes, word: str) -> WordUse:
    in_macros = scan(data).macro_lines
    outside = next((use for use in find_word_uses(data, word) if use[0] not in in_macros), None)
    line, column, conditions = outside or next(find_word_uses(data, word), (1, 0, ()))
    own = initializes_variable(data, word) or declares(data, word) or has_enum_constant(data, word)
    return WordUse(word, line, column, conditions, own, outside is None)


class SearchedText(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """uses: what a Python file or one of parameters has of what Rows describe. functions: those that such uses call and
    that a Python file defines itself."""

    uses: tuple[WatchedUse, ...] = ()
    problems: tuple[Problem, ...] = ()
    functions: tuple[str, ...] = ()


def searched_text(data: bytes, facts: object, table: Rows[tuple[str, Pattern]]) -> SearchedText:
    """The uses of a table that a file has."""
    rows = [(label, pattern) for label, pattern in table.rows if pattern.word.encode() in data]
    called = {pattern.word for _, pattern in rows if pattern.calls and pattern.language == "python"}
    uses = tuple(use for row in rows for use in list_row_uses(data, [row]))
    return SearchedText(uses, functions=find_methods(data, called))


class CalledCpp(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """What a C++ file defines and calls. functions: of classes and namespaces that it defines outside of them,
    `Class::function`, and those that it defines at the start of a line, `::function`. called: what is called without a
    receiver, and short names that are called on one, `.function`."""

    functions: frozenset[str] = frozenset()
    called: frozenset[str] = frozenset()
    problems: tuple[Problem, ...] = ()


# An expression that starts with a literal is found at the speed of one; what stands before it is looked at after.
_FUNCTION = re.compile(rb"(::(?<=\w::)[A-Za-z]\w{2,100})\s?(\([^;{}]{0,1000})\{")
_SCOPE = re.compile(rb"\w+\Z")
_FREE = re.compile(rb"\n(?!static|inline|template|else|return|typedef|using|extern)[a-zA-Z][\w:<>,]{0,100}[ \n*&]{1,4}"
                   rb"([A-Za-z]\w{3,100}) ?(\([^;{}]{0,1000})\{")  # fmt: skip
# Of what stands before a parenthesis, backwards: a name without a receiver, or a short one behind one.
_CALLED = re.compile(rb" ?(?:(\w{3,100}[A-Za-z])(?![\w.>])|(\w{2}[A-Za-z])[.>])")
_BRACKET = re.compile(rb"[()]")
_AFTER_PARAMETERS = re.compile(rb"\s*(?:\Z|[a-z/&]|:(?!:)|->)")


def called_cpp(data: bytes, facts: CppFile, table: None) -> CalledCpp:
    """The functions that a C++ file defines and calls, as its text shows them."""
    return CalledCpp(_decode_words((*_list_functions(data), *_free_functions(data))), _decode_words(_list_called(data)))


def _list_functions(data: bytes) -> Iterator[bytes]:
    for found in _FUNCTION.finditer(data):
        if _is_head(found[2]):
            scope = _SCOPE.search(data, max(0, found.start() - 100), found.start())
            yield (scope[0] if scope is not None else b"") + found[1]


def _free_functions(data: bytes) -> Iterator[bytes]:
    return (b"::" + found[1] for found in _FREE.finditer(b"\n" + data) if _is_head(found[2]))


def _list_called(data: bytes) -> Iterator[bytes]:
    for before in {part[:-104:-1] for part in data.split(b"(")[:-1]}:
        found = _CALLED.match(before)
        if found is not None:
            yield found[1][::-1] if found[1] else b"." + found[2][::-1]


def _is_head(text: bytes) -> bool:
    """Whether parameters and what follows them up to a brace are those of a function that is defined: in a condition or
    an argument a parenthesis opens before, or something else follows."""
    depth = 0
    for bracket in _BRACKET.finditer(text) if text.count(b"(") == text.count(b")") else ():
        depth += 1 if bracket[0] == b"(" else -1
        if depth == 0:
            return _AFTER_PARAMETERS.match(text, bracket.end()) is not None
    return False


def _decode_words(words: Iterable[bytes]) -> frozenset[str]:
    return frozenset(word.decode() for word in words)
