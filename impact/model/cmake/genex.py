"""Generator expressions reduced to what can be read from them without generating.

Source: cmake-generator-expressions(7).
"""

import re
from collections.abc import Iterator

from ...facts.condition import Condition
from .values import Word, split_list, wrap

_MAX_DEPTH = 20

# Expressions that hold a plain item as their only content.
_WRAPPERS = frozenset({"BUILD_INTERFACE", "LINK_ONLY", "BUILD_LOCAL_INTERFACE", "COMPILE_ONLY", "TARGET_NAME", "1"})
_TESTED = frozenset({"TARGET_NAME_IF_EXISTS"})
_DROPPED = frozenset({"INSTALL_INTERFACE", "0", "INSTALL_PREFIX", "ANGLE-R", "COMMA", "SEMICOLON"})


def rejoin(items: list[Word]) -> list[Word]:
    """Puts generator expressions together again that an unquoted semicolon or space took apart."""
    if not any("$<" in item for item in items):
        return items
    joined: list[Word] = []
    open_count = 0
    for item in items:
        if open_count > 0:
            last = joined[-1]
            joined[-1] = wrap(f"{last};{item}", last.at, last.conditions, last.sure)
        else:
            joined.append(item)
            open_count = 0
        open_count += item.count("$<") - (item.count(">") - item.count("->"))
    return joined


def reduce_expression(item: Word) -> Iterator[Word]:
    """The items an argument may stand for: itself when it is no generator expression, else what lies inside, under the
    expression's test as a condition. What only counts after installation is left out."""
    if "$<" not in item:
        yield item
        return
    yield from _reduce(item, item, (), 0)


def _reduce(text: str, origin: Word, tests: tuple[Condition, ...], depth: int) -> Iterator[Word]:
    for part in _split(text):
        if not part.startswith("$<") or depth > _MAX_DEPTH or next(_find_unnested(part[2:], ">"), -1) != len(part) - 3:
            yield wrap(part, origin.at, origin.conditions + tests, origin.sure)
            continue
        head, content = _split_head(part[2:-1])
        if head in _WRAPPERS:
            yield from _reduce(content, origin, tests, depth + 1)
        elif head in _DROPPED:
            continue
        elif head in _TESTED:
            yield from _reduce(content, origin, (*tests, Condition("cmake", f"TARGET {content}")), depth + 1)
        elif head == "IF":
            pieces = _cut(content, ",")
            if len(pieces) == 3:
                yield from _reduce(pieces[1], origin, (*tests, Condition("cmake", pieces[0])), depth + 1)
                yield from _reduce(pieces[2], origin, (*tests, Condition("cmake", pieces[0], True)), depth + 1)
        elif head.startswith("$<") and content:
            yield from _reduce(content, origin, (*tests, Condition("cmake", head)), depth + 1)
        else:
            yield wrap(part, origin.at, origin.conditions + tests, origin.sure)


def _split_head(inner: str) -> tuple[str, str]:
    """An expression's head and what follows its first colon outside of nested expressions."""
    colon = next(_find_unnested(inner, ":"), len(inner))
    return inner[:colon], inner[colon + 1 :]


def _split(text: str) -> list[str]:
    """List items; a semicolon inside an expression does not separate."""
    if ";" not in text:
        return [text] if text else []
    if "$<" not in text:
        return split_list(text)
    return [part for part in _cut(text, ";") if part]


def _cut(text: str, separator: str) -> list[str]:
    """The parts of a text between separators outside of nested expressions."""
    ends = [*_find_unnested(text, separator), len(text)]
    return [text[begin:end] for begin, end in zip([0, *(end + 1 for end in ends)], ends, strict=False)]


def _find_unnested(text: str, mark: str) -> Iterator[int]:
    """Offsets of a character outside of nested expressions; of `>`, where it closes none."""
    depth = 0
    for token in re.finditer(rf"\$<|>|{mark}", text):
        if token.group() == "$<":
            depth += 1
        elif token.group() == ">" and depth:
            depth -= 1
        elif token.group() == mark and not depth:
            yield token.start()
