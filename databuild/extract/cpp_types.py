"""Tokens of C++ declarations, and types in one form: how they are spaced and ordered is the author's taste."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache

from ...impact.facts.surface import CppParameter

TOKEN = re.compile(
    r"[^\W\d]\w*|\.?\d(?:[eEpP][+-]|[\w.'])*"
    r"|\"(?:[^\"\\]|\\.)*\"|'(?:[^'\\]|\\.)*'"
    r"|::|->\*?|\.\.\.|&&|\|\||<<=|<<|<=>|<=|>=(?!=)|[-=!+*/%^&|]=|\+\+|--|\S"
)
_OPENING = {"(": ")", "[": "]", "{": "}"}
_CLOSING = frozenset(")]}")
_WORD = re.compile(r"\w")
_BUILTIN_WORDS = frozenset(("unsigned", "signed", "long", "short", "int", "char", "double", "__int64"))
BUILTIN = _BUILTIN_WORDS | frozenset((
    "void", "bool", "float", "auto", "wchar_t", "char8_t", "char16_t", "char32_t",
))  # fmt: skip
"""Words that are types, or parts of one, by themselves."""
_DROPPED = frozenset(("class", "struct", "typename", "enum", "union", "template", "__extension__"))
_QUALIFIERS = ("const", "volatile")
_POINTERS = frozenset(("*", "&", "&&", "..."))
RESTRICT = frozenset(("restrict", "__restrict", "__restrict__"))
ATTRIBUTE_WORDS = frozenset(("__attribute__", "__attribute", "__declspec", "alignas", "_Alignas"))
DEDUCED = frozenset(("decltype", "typeof", "__typeof__"))
ASIDE = DEDUCED | ATTRIBUTE_WORDS | {"["}
"""How things in brackets begin that are no part of a name."""
_NO_UNITS = frozenset((*_DROPPED, *_QUALIFIERS, *RESTRICT, "register", "in", "mutable")) - {"in"}
CAPITALS = re.compile(r"_*[A-Z][A-Z0-9_]+\Z")
"""How macros are written, and some types."""


def split_tokens(text: str) -> list[str]:
    """The tokens of a piece of C++ without comments. Two `>` are two tokens."""
    return TOKEN.findall(text)


def find_closing(tokens: Sequence[str], at: int) -> int:
    """The place behind the bracket that closes the one at a place; the end when none does."""
    depth = 0
    for place in range(at, len(tokens)):
        token = tokens[place]
        if token in _OPENING:
            depth += 1
        elif token in _CLOSING:
            depth -= 1
            if depth <= 0:
                return place + 1
    return len(tokens)


def skip_aside(tokens: Sequence[str], place: int) -> int:
    """The place behind the thing in brackets that begins with a word of ASIDE; the same place when none follows it."""
    opening = place if tokens[place] == "[" else place + 1
    return find_closing(tokens, opening) if opening < len(tokens) else place


def find_closing_angle(tokens: Sequence[str], at: int) -> int:
    """The place behind the `>` that closes the `<` at a place, 0 when it is no bracket."""
    depth = 0
    place = at
    end = len(tokens)
    while place < end:
        token = tokens[place]
        if token == "<":
            depth += 1
        elif token == ">":
            depth -= 1
            if depth == 0:
                return place + 1
        elif token == ">=" and depth == 1:
            return 0
        elif token in _OPENING:
            place = find_closing(tokens, place)
            continue
        elif token in _CLOSING or token == ";":
            return 0
        place += 1
    return 0


def split(tokens: Sequence[str], mark: str = ",") -> list[list[str]]:
    """Tokens cut at a mark that stands in no brackets; no tokens are no piece."""
    if not tokens:
        return []
    pieces: list[list[str]] = []
    current: list[str] = []
    place = 0
    end = len(tokens)
    while place < end:
        token = tokens[place]
        if token == mark:
            pieces.append(current)
            current = []
            place += 1
            continue
        behind = 0
        if token in _OPENING:
            behind = find_closing(tokens, place)
        elif token == "<" and place and _WORD.match(tokens[place - 1]):
            behind = find_closing_angle(tokens, place)
        if behind:
            current += tokens[place:behind]
            place = behind
        else:
            current.append(token)
            place += 1
    pieces.append(current)
    return pieces


def join_tokens(tokens: Sequence[str]) -> str:
    """Tokens as text, words apart and operators between blanks; the same for however it was spaced."""
    pieces: list[str] = []
    before = ""
    for token in tokens:
        if (
            (before and _WORD.match(before[-1]) and _WORD.match(token))
            or before == ","
            or (before == "..." and _WORD.match(token))
        ):
            pieces.append(" ")
        pieces.append(token)
        before = token
    return "".join(pieces)


def format_type(tokens: Sequence[str]) -> str:
    """A type in one form: `const` first, builtin types in their shortest usual spelling, no elaborating keywords."""
    if len(tokens) == 1 and tokens[0] not in _BUILTIN_WORDS:
        return tokens[0]
    return _format_type(tuple(tokens))


@lru_cache(maxsize=65536)
def _format_type(tokens: tuple[str, ...]) -> str:
    base: list[str] = []
    qualifiers: set[str] = set()
    numbers: list[str] = []
    tail: list[str] = []
    place = 0
    end = len(tokens)
    while place < end:
        token = tokens[place]
        if token in _DROPPED or token in RESTRICT:
            place += 1
            continue
        if token in _QUALIFIERS:
            if tail:
                tail.append(" " + token)
            else:
                qualifiers.add(token)
        elif token in _BUILTIN_WORDS and not tail:
            numbers.append(token)
        elif token == "<" and base and not tail:
            behind = find_closing_angle(tokens, place)
            if behind == 0:
                base.append(token)
            else:
                base.append("<" + ", ".join(map(format_type, split(tokens[place + 1 : behind - 1]))) + ">")
                place = behind
                continue
        elif token in _POINTERS:
            tail.append(token)
        elif token == "[":
            behind = find_closing(tokens, place)
            tail.append("[" + join_tokens(tokens[place + 1 : behind - 1]) + "]")
            place = behind
            continue
        elif token == "(":
            behind = find_closing(tokens, place)
            inner = tokens[place + 1 : behind - 1]
            if base[-1:] == ["decltype"] and not tail:
                base.append("(" + join_tokens(inner) + ")")
            elif inner and (inner[0] in _POINTERS or ("::" in inner and inner[-1] == "*")):
                tail.append("(" + join_tokens(inner) + ")")
            else:
                tail.append(format_parameters(inner))
            place = behind
            continue
        elif token == "::" and not base and not tail:
            pass
        elif tail:
            tail.append(token)
        else:
            if base and _WORD.match(base[-1][-1]) and _WORD.match(token):
                base.append(" ")
            base.append(token)
        place += 1
    if numbers:
        base.append((" " if base else "") + _normalize_builtin(numbers))
    front = "".join(f"{word} " for word in _QUALIFIERS if word in qualifiers)
    return front + "".join(base) + "".join(tail)


def format_parameters(tokens: Sequence[str]) -> str:
    """What stands in the parentheses of a function type, names of parameters left out."""
    pieces = split(tokens)
    if pieces == [["void"]]:
        return "()"
    return "(" + ", ".join("..." if piece == ["..."] else read_parameter(piece).type for piece in pieces if piece) + ")"


def parse_parameters(tokens: Sequence[str]) -> tuple[tuple[CppParameter, ...], bool]:
    """The parameters between two parentheses, and whether `...` ends them."""
    if not tokens or (len(tokens) == 1 and tokens[0] == "void"):
        return (), False
    pieces = split(tokens)
    variadic = False
    last = pieces[-1]
    if last and last[-1] == "..." and (len(last) == 1 or (last[-2] not in ("&", "&&", "*") and len(last) > 2)):
        # `(int a, ...)` and `(int a ...)`
        variadic = len(last) == 1 or cut_name(last[:-1])[1] != ""
        if variadic:
            pieces[-1] = last[:-1]
    return tuple(read_parameter(piece) for piece in pieces if piece), variadic


def read_parameter(tokens: Sequence[str]) -> CppParameter:
    """A parameter of a function."""
    return _parse_parameter(tuple(tokens))


@lru_cache(maxsize=65536)
def _parse_parameter(tokens: tuple[str, ...]) -> CppParameter:
    default = None
    if "=" in tokens:
        front = split(tokens, "=")[0]
        if len(front) < len(tokens):
            default = join_tokens(tokens[len(front) + 1 :])
            tokens = tuple(front)
    type_, name = cut_name(tokens)
    return CppParameter(drop_outer_const(type_), name, default, "..." in tokens and "..." in type_)


def drop_outer_const(type_: str) -> str:
    """The type of a parameter without the `const` of the parameter itself."""
    if type_.endswith(" const"):
        return type_[:-6]
    if type_.startswith("const ") and type_[-1] not in "*&])." and not type_.endswith((" volatile", ")")):
        return type_[6:]
    return type_


def find_unit_end(tokens: Sequence[str], at: int) -> int:
    """The place behind a qualified name with its template arguments that starts at a place."""
    place = at
    end = len(tokens)
    if tokens[place] == "::":
        place += 1
    while place < end:
        if tokens[place] in ("template", "~"):
            place += 1
            continue
        if tokens[place] == "operator":
            return place
        place += 1
        if place < end and tokens[place] == "<":
            place = find_closing_angle(tokens, place) or place
            if tokens[place - 1] != ">":
                return place
        if place + 1 < end and tokens[place] == "::" and (tokens[place + 1].isidentifier() or tokens[place + 1] == "~"):
            place += 1
            continue
        return place
    return place


def cut_name(tokens: Sequence[str]) -> tuple[str, str]:
    """The type and the name (empty for none) of `type name`, as parameters and members of types have them."""
    units: list[tuple[int, int]] = []
    dropped: list[tuple[int, int]] = []
    builtin = False
    name_at = -1
    place = 0
    end = len(tokens)
    while place < end:
        token = tokens[place]
        if token in BUILTIN:
            builtin = True
        elif token in _NO_UNITS:
            pass
        elif token in ASIDE and (behind := skip_aside(tokens, place)) > place:
            if token in DEDUCED:
                builtin = True
            elif token != "[" or (place + 1 < end and tokens[place + 1] == "["):
                dropped.append((place, behind))
            place = behind
            continue
        elif token == "(":
            behind = find_closing(tokens, place)
            group = tokens[place + 1 : behind - 1]
            if (
                (units or builtin)
                and group
                and (group[0] in _POINTERS or (len(group) > 2 and "::" in group and "*" in group))
            ):
                name, operators = _split_group(group)
                front = format_type(_remove_macros(tokens[:place], units, builtin, dropped))
                rest = tokens[behind:]
                if rest[:1] == ("(",) or rest[:1] == ["("]:
                    inner_end = find_closing(rest, 0)
                    return f"{front}({operators}){format_parameters(rest[1 : inner_end - 1])}", name
                return f"{front}({operators}){join_tokens(rest)}", name
            if units and behind < end and tokens[behind].isidentifier():
                dropped.append((units.pop()[0], behind))  # a macro with arguments
            place = behind
            continue
        elif token.isidentifier() or token == "::":
            behind = find_unit_end(tokens, place)
            if behind > place:
                units.append((place, behind))
                place = behind
                continue
        place += 1
    if units and (len(units) > 1 or builtin):
        start, behind = units[-1]
        if behind == start + 1 and (behind == end or tokens[behind] in ("[", "(", ":")) and start:
            name_at = start
            units.pop()
    if name_at < 0:
        return format_type(_remove_macros(tokens, units, builtin, dropped)), ""
    rest = list(tokens[name_at + 1 :])
    if rest[:1] == [":"]:
        rest = []
    typed = _remove_macros(tokens[:name_at], units, builtin, dropped)
    return format_type([*typed, *rest]) if rest else format_type(typed), tokens[name_at]


def _remove_macros(
    tokens: Sequence[str], units: Sequence[tuple[int, int]], builtin: bool, dropped: Sequence[tuple[int, int]]
) -> Sequence[str]:
    """The tokens of a type without macros: a type has one name, or builtin words."""
    gone = list(dropped)
    if builtin:
        gone += [unit for unit in units if unit[1] == unit[0] + 1 and CAPITALS.match(tokens[unit[0]])]
    elif len(units) > 1:
        gone += units[:-1]
    if not gone:
        return tokens
    away = {place for start, behind in gone for place in range(start, behind)}
    return [token for place, token in enumerate(tokens) if place not in away]


def _split_group(group: Sequence[str]) -> tuple[str, str]:
    """The name in `(*name)`, `(&name)[3]`, `(Class::*name)`, and what is left without it."""
    place = max(index for index, token in enumerate(group) if token in _POINTERS) + 1
    rest = [token for token in group[place:] if token not in _QUALIFIERS]
    if rest and rest[0].isidentifier():
        return rest[0], join_tokens(group[:place])
    return "", join_tokens(group[:place])


def _normalize_builtin(words: list[str]) -> str:
    if "char" in words:
        sign = "unsigned " if "unsigned" in words else "signed " if "signed" in words else ""
        return sign + "char"
    if "double" in words:
        return "long double" if "long" in words else "double"
    if "__int64" in words:
        size = "long long"
    elif "short" in words:
        size = "short"
    else:
        size = " ".join(["long"] * words.count("long")) or "int"
    return f"unsigned {size}" if "unsigned" in words else size
