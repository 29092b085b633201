"""One declaration of C++ as its tokens, to what it declares. Macros that are not known are told by where they stand."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

from ...impact.facts.surface import Base, CppParameter, TemplateParameter
from .cpp_types import (
    ASIDE,
    ATTRIBUTE_WORDS,
    BUILTIN,
    CAPITALS,
    DEDUCED,
    cut_name,
    find_closing,
    find_closing_angle,
    find_unit_end,
    format_parameters,
    format_type,
    join_tokens,
    parse_parameters,
    read_parameter,
    skip_aside,
    split,
)


class Declarator(NamedTuple):
    """What a declaration declares. name: as written, empty for an alias or the like without one."""

    kind: str
    name: str
    type: str = ""
    parameters: tuple[CppParameter, ...] | None = None
    traits: frozenset[str] = frozenset()
    value: str = ""


class Head(NamedTuple):
    """The front of a declaration. place: where the rest begins; macros: (name, arguments) of those before it."""

    place: int
    template: tuple[TemplateParameter, ...] | None
    traits: frozenset[str]
    words: frozenset[str]
    macros: tuple[tuple[str, tuple[str, ...]], ...] = ()
    specialised: bool = False


class ClassHead(NamedTuple):
    """The head of a class, union or enum. type: what an enum is based on; arguments: of a specialisation."""

    kind: str
    name: str
    bases: tuple[Base, ...]
    traits: frozenset[str]
    type: str
    arguments: str
    ends: bool


TRAITS = {
    "static": "static", "virtual": "virtual", "constexpr": "constexpr", "consteval": "consteval", "extern": "extern",
    "inline": "inline", "mutable": "mutable", "__inline": "inline", "__inline__": "inline", "__forceinline": "inline",
    "explicit": "explicit", "friend": "friend", "BOOST_CONSTEXPR": "constexpr", "EIGEN_CONSTEXPR": "constexpr",
}  # fmt: skip
_SKIPPED = frozenset(("register", "thread_local", "constinit", "export", "__extension__", "typedef", "__thread"))
_NOTHING: frozenset[str] = frozenset()
_AFTER_FUNCTION = frozenset((
    "const", "volatile", "noexcept", "override", "final", "throw", "requires", "try",
))  # fmt: skip
_POINTERS = frozenset(("*", "&", "&&"))
_LITERAL = re.compile(r"[\d\"'.]|(?:true|false|nullptr|NULL)\Z")
_DEPRECATED = re.compile(r"[A-Z0-9_]*DEPRECATED[A-Z0-9_]*\Z")
_ACCESS = ("public", "protected", "private")
_GUARDS = re.compile(r"\w*(?:GUARDED_BY|ATTRIBUTE|REQUIRES|EXCLUDES|TSA|NOEXCEPT|ALIGN|LOCKS?)\w*\Z")


def remove_deprecation(tokens: list[str]) -> tuple[list[str], str | None]:
    """Tokens without the attributes and macros that say `deprecated`, and the message they say it with."""
    kept: list[str] = []
    message: str | None = None
    place = 0
    end = len(tokens)
    while place < end:
        token = tokens[place]
        behind = 0
        if (token == "[" and tokens[place + 1 : place + 2] == ["["]) or (token in ATTRIBUTE_WORDS and place + 1 < end):
            first = place if token == "[" else place + 1
            behind = find_closing(tokens, first)
            inner = tokens[first:behind]
            if "deprecated" in inner or "__deprecated__" in inner:
                message = _join_literals(inner) or message or ""
                others = [word for word in inner if word == "nodiscard"]
                if others:
                    kept += ["[", "[", "nodiscard", "]", "]"]
            else:
                kept += tokens[place:behind]
        elif "DEPRECATED" in token and _DEPRECATED.match(token) and not _is_declared_name(tokens, place):
            behind = place + 1
            if behind < end and tokens[behind] == "(":
                behind = find_closing(tokens, behind)
                inner = tokens[place + 2 : behind - 1]
                message = _join_literals(inner) or message or ""
                if "(" in inner and not any(word[0] == '"' for word in inner):
                    kept += inner  # DEPRECATED(void f(int))
            else:
                message = message or ""
        if behind:
            place = behind
        else:
            kept.append(token)
            place += 1
    return kept, message


def _is_declared_name(tokens: Sequence[str], place: int) -> bool:
    """Whether a word in capitals is what is declared, not a macro."""
    behind = tokens[place + 1] if place + 1 < len(tokens) else ""
    before = tokens[place - 1] if place else ""
    if behind in ("=", "[", ",") and before not in (")",):
        return True
    return before in ("::", "enum", "struct") or (before in BUILTIN and not behind)


def _join_literals(tokens: Sequence[str]) -> str:
    return "".join(token[1:-1] for token in tokens if token[0] == '"')


def parse_head(tokens: Sequence[str], class_name: str) -> Head:
    """Reads templates, specifiers, attributes and macros before a declaration."""
    place = 0
    end = len(tokens)
    template: tuple[TemplateParameter, ...] | None = None
    specialised = False
    traits: set[str] = set()
    words: set[str] = set()
    macros: list[tuple[str, tuple[str, ...]]] = []
    while place < end:
        token = tokens[place]
        if token == "(" and not place:
            place = find_closing(tokens, place)  # what is left of a macro
        elif token in TRAITS:
            traits.add(TRAITS[token])
            place += 1
            if place < end and token == "explicit" and tokens[place] == "(":
                place = find_closing(tokens, place)
            elif token == "extern" and place < end and tokens[place][0] == '"':
                words.add("linkage")
                place += 1
        elif token in _SKIPPED:
            words.add(token)
            place += 1
        elif token == "template":
            if tokens[place + 1 : place + 2] != ["<"]:
                words.add("instantiation")
                break
            behind = find_closing_angle(tokens, place + 1)
            if not behind:
                break
            inner = tokens[place + 2 : behind - 1]
            if inner:
                template = (template or ()) + parse_template_parameters(inner)
            else:
                specialised = True
            place = behind
            if place < end and tokens[place] == "requires":
                place = _skip_requires(tokens, place + 1)
        elif token == "[" and tokens[place + 1 : place + 2] == ["["]:
            behind = find_closing(tokens, place)
            if "nodiscard" in tokens[place:behind]:
                traits.add("nodiscard")
            place = behind
        elif token in ATTRIBUTE_WORDS and place + 1 < end:
            place = find_closing(tokens, place + 1)
        elif (
            place + 1 < end
            and tokens[place + 1] == "("
            and token != class_name
            and token != "decltype"
            and token not in BUILTIN
            and token.isidentifier()
            and token != "operator"
        ):
            behind = find_closing(tokens, place + 1)
            if behind < end and not (
                (tokens[behind].isidentifier() and tokens[behind] not in _AFTER_FUNCTION)
                or tokens[behind] in ("~", "::", "[", ";")
            ):
                break
            if behind < end and tokens[place + 2 : place + 3] and tokens[place + 2] in _POINTERS:
                break
            macros.append((token, tuple(tokens[place + 2 : behind - 1])))
            place = behind
        elif (
            place + 1 < end
            and CAPITALS.match(token)
            and (tokens[place + 1] in TRAITS or tokens[place + 1] in ("template", "class", "struct", "enum", "using"))
            and token != class_name
        ):
            macros.append((token, ()))
            place += 1
        elif token == ";":
            place += 1
        else:
            break
    return Head(place, template, frozenset(traits), frozenset(words), tuple(macros), specialised)


def _skip_requires(tokens: Sequence[str], place: int) -> int:
    end = len(tokens)
    while place < end:
        if tokens[place] == "!":
            place += 1
            continue
        place = find_closing(tokens, place) if tokens[place] == "(" else max(find_unit_end(tokens, place), place + 1)
        if place < end and tokens[place] in ("&&", "||"):
            place += 1
            continue
        break
    return place


def parse_template_parameters(tokens: Sequence[str]) -> tuple[TemplateParameter, ...]:
    """What stands between the angle brackets of `template <...>`."""
    found: list[TemplateParameter] = []
    for piece in split(tokens):
        if not piece:
            continue
        first = piece[0]
        if first == "template":
            behind = find_closing_angle(piece, 1) if len(piece) > 1 else 0
            rest = piece[behind + 1 :] if behind else []
            found.append(_parse_type_parameter("template", rest))
        elif (
            first in ("typename", "class") and not (len(piece) > 2 and piece[2] in ("::", "<")) and piece[1:2] != ["::"]
        ):
            found.append(_parse_type_parameter("type", piece[1:]))
        else:
            value = read_parameter(piece)
            found.append(TemplateParameter("value", value.name, value.type, value.default, value.pack))
    return tuple(found)


def _parse_type_parameter(kind: str, rest: list[str]) -> TemplateParameter:
    pack = rest[:1] == ["..."]
    rest = rest[1:] if pack else rest
    name = rest[0] if rest and rest[0].isidentifier() else ""
    default = None
    if "=" in rest:
        default = format_type(rest[rest.index("=") + 1 :])
    return TemplateParameter(kind, name, "", default, pack)


def parse_class_head(tokens: Sequence[str], place: int) -> ClassHead | None:
    """The head of a class, union or enum whose keyword stands at a place; None when it is something else."""
    kind = tokens[place]
    end = len(tokens)
    traits: set[str] = set()
    place += 1
    if kind == "enum" and place < end and tokens[place] in ("class", "struct"):
        traits.add("scoped")
        place += 1
    units: list[tuple[int, int]] = []
    while place < end:
        token = tokens[place]
        if token == "[":
            place = find_closing(tokens, place)
        elif token in ATTRIBUTE_WORDS and place + 1 < end:
            place = find_closing(tokens, place + 1)
        elif token == ":":
            break
        elif token == "final" and units:
            traits.add("final")
            place += 1
        elif token == "(" and units and CAPITALS.match(tokens[units[-1][0]]):
            units.pop()  # a macro with arguments
            place = find_closing(tokens, place)
        elif token.isidentifier() or token == "::":
            behind = find_unit_end(tokens, place)
            if behind <= place:
                return None
            units.append((place, behind))
            place = behind
        else:
            return None
    if len(units) > 1 and units[-1][1] == units[-1][0] + 1 and tokens[units[-1][0]].endswith("_FINAL"):
        traits.add("final")
        units.pop()
    if len(units) > 1 and place == end and not all(CAPITALS.match(tokens[start]) for start, _ in units[:-1]):
        # `struct Foo bar`: a variable; `class api Foo` with a body is told by whoever knows that there is one
        traits.add("doubtful")
    bases: tuple[Base, ...] = ()
    type_ = ""
    if place < end:
        rest = tokens[place + 1 :]
        if kind == "enum":
            type_ = format_type(rest)
        else:
            bases = tuple(_parse_base(piece, kind) for piece in split(rest) if piece)
    name = arguments = ""
    if units:
        start, behind = units[-1]
        unit = list(tokens[start:behind])
        if unit[-1] == ">":
            opening = next(index for index, token in enumerate(unit) if token == "<")
            depth = 0
            for index in range(len(unit) - 1, -1, -1):
                depth += (unit[index] == ">") - (unit[index] == "<")
                if depth == 0:
                    opening = index
                    break
            arguments = ", ".join(format_type(piece) for piece in split(unit[opening + 1 : -1]) if piece)
            unit = unit[:opening]
        name = "".join(unit).removeprefix("::")
    return ClassHead(kind, name, bases, frozenset(traits), type_, arguments, place >= end)


def _parse_base(tokens: Sequence[str], kind: str) -> Base:
    access = "private" if kind == "class" else "public"
    rest = []
    virtual = False
    for token in tokens:
        if token in _ACCESS:
            access = token
        elif token == "virtual":
            virtual = True
        elif token != "...":
            rest.append(token)
    return Base(format_type(rest), access, virtual)


def parse_declarators(tokens: list[str], head: Head, class_name: str) -> list[Declarator] | None:
    """What a declaration declares behind its head; nothing for what is defined elsewhere (`void A::f() {}`). None when
    it is not understood. class_name: of the class it stands in, empty for none."""
    rest = tokens[head.place :]
    if not rest:
        return []
    place = 0
    end = len(rest)
    units: list[tuple[int, int]] = []
    builtin = False
    while place < end:
        token = rest[place]
        if token in BUILTIN:
            builtin = True
        elif token in ("=", ",", ":", "{"):
            break
        elif token == "operator":
            return _parse_operator(rest, place, head)
        elif token in ASIDE and (behind := skip_aside(rest, place)) > place:
            builtin = builtin or token in DEDUCED
            place = behind
            continue
        elif token == "~" or token.isidentifier() or token == "::":
            if token not in _PLAIN:
                if token == "::" and not (place + 1 < end and (rest[place + 1].isidentifier())):
                    place += 1
                    continue
                behind = find_unit_end(rest, place)
                if behind > place:
                    units.append((place, behind))
                    place = behind
                    continue
        elif token == "(":
            behind = find_closing(rest, place)
            group = rest[place + 1 : behind - 1]
            last = units[-1] if units and units[-1][1] == place else None
            if last is None:
                return _parse_grouped(rest, place, behind, head) if units or builtin else None
            if (
                group
                and (group[0] in _POINTERS or ("*" in group and "::" in group and group[-1] != ")"))
                and (len(units) == 1 and not builtin and behind < end and rest[behind] in ("(", "["))
            ):
                return _parse_grouped(rest, place, behind, head)
            return _parse_called(rest, place, behind, units, builtin, head, class_name)
        place += 1
    return _parse_variables(rest, head)


_PLAIN = frozenset(("const", "volatile", "struct", "class", "union", "enum", "typename", "mutable", "restrict",
                    "__restrict", "__restrict__", "static", "inline", "constexpr", "virtual", "friend", "explicit",
                    "template", "typedef"))  # fmt: skip
_LATE = frozenset(("static", "inline", "constexpr", "virtual", "friend", "explicit"))


def _remove_late_specifiers(tokens: list[str], head: Head) -> tuple[list[str], Head]:
    """Tokens without specifiers that stand behind a type, and the head with these."""
    late = head.traits.union(_LATE.intersection(tokens))
    kept = [token for token in tokens if token not in _LATE]
    return (kept, head._replace(traits=late)) if len(kept) < len(tokens) else (tokens, head)


def _parse_called(
    rest: list[str], place: int, behind: int, units: list[tuple[int, int]], builtin: bool, head: Head, class_name: str
) -> list[Declarator] | None:
    """A name with parentheses behind it."""
    start, stop = units[-1]
    unit = rest[start:stop]
    group = rest[place + 1 : behind - 1]
    simple = unit[0] if len(unit) == 1 or unit[1:2] == ["<"] else ""
    real = [one for one in units[:-1] if not (one[1] == one[0] + 1 and CAPITALS.match(rest[one[0]]))]
    if class_name and simple == class_name and not builtin and not real:
        return [_make_function("constructor", class_name, "", rest, group, behind, head)]
    if unit[0] == "~" and len(unit) == 2 and class_name:
        return [_make_function("destructor", f"~{unit[1]}", "", rest, group, behind, head)]
    if "::" in unit:
        return []  # defined elsewhere, or a friend that is declared elsewhere
    if len(units) == 1 and not builtin:
        if behind < len(rest) and rest[behind] == "->":
            return []  # a deduction guide
        if behind < len(rest) and (rest[behind].isidentifier() or rest[behind] in ("~", "[")):
            # a macro, and what follows it
            again = parse_head(rest[behind:], class_name)
            return parse_declarators(rest[behind:], again._replace(traits=again.traits | head.traits), class_name)
        return []
    if len(unit) != 1:
        if unit[1:2] != ["<"]:
            return None
        # an explicit specialisation `f<int>(...)`
        return []
    name = unit[0]
    before = rest[:start]
    if (
        len(units) > 1
        and CAPITALS.match(name)
        and start == units[-2][1]
        and (len(real) > 1 or (builtin and real) or (_GUARDS.match(name) and (len(real) > 1 or builtin)))
        and not (head.traits & {"virtual"})
    ):
        return _parse_variables(rest[:start] + rest[behind:], head)  # `int member GUARDED_BY(mutex)`
    if not class_name and _contains_values(group):
        return _parse_variables([*list(rest[:place]), "=", "{", *group, "}", *list(rest[behind:])], head)
    before, head = _remove_late_specifiers(before, head)
    if "typedef" in head.words:
        type_ = cut_name([*before, name])[0]
        return [Declarator("alias", name, type_ + format_parameters(group))]
    kind = "method" if class_name and "friend" not in head.traits else "function"
    return [_make_function(kind, name, cut_name([*before, name])[0], rest, group, behind, head)]


def _contains_values(group: Sequence[str]) -> bool:
    """Whether what stands in parentheses are values, not parameters."""
    if not group:
        return False
    return any(
        bool(piece)
        and piece[0] != "..."
        and (
            _LITERAL.match(piece[0]) is not None
            or piece[0] in ("-", "+", "!", "&", "*", "{")
            or "." in piece
            or (len(piece) > 1 and piece[1] in ("+", "-", "/", "."))
        )
        for piece in split(group)
    )


def _make_function(
    kind: str, name: str, type_: str, rest: list[str], group: Sequence[str], behind: int, head: Head
) -> Declarator:
    parameters, variadic = parse_parameters(group)
    traits = set(head.traits)
    if variadic:
        traits.add("variadic")
    place = behind
    end = len(rest)
    while place < end:
        token = rest[place]
        if token in ("const", "volatile", "override", "final", "&", "&&"):
            traits.add(token)
        elif token == "noexcept" or token.endswith("_NOEXCEPT"):
            if place + 1 < end and rest[place + 1] == "(":
                stop = find_closing(rest, place + 1)
                if rest[place + 2 : stop - 1] != ["false"]:
                    traits.add("noexcept")
                place = stop
                continue
            traits.add("noexcept")
        elif token == "throw" and place + 1 < end:
            stop = find_closing(rest, place + 1)
            if stop == place + 3:
                traits.add("noexcept")
            place = stop
            continue
        elif token.endswith("_OVERRIDE"):
            traits.add("override")
        elif token == "->":
            stop = place + 1
            while stop < end and rest[stop] not in ("=", "requires", "override", "final", "try"):
                if rest[stop] in ("(", "{", "["):
                    stop = find_closing(rest, stop)
                elif rest[stop] == "<":
                    stop = find_closing_angle(rest, stop) or stop + 1
                else:
                    stop += 1
            type_ = format_type(rest[place + 1 : stop])
            place = stop
            continue
        elif token == "=":
            what = rest[place + 1] if place + 1 < end else ""
            if what == "0":
                traits |= {"pure", "virtual"}
            elif what == "delete":
                traits.add("deleted")
            elif what == "default":
                traits.add("defaulted")
            break
        elif token in (":", "try", "requires", "{"):
            break
        elif token == "(" or token == "[":
            place = find_closing(rest, place)
            continue
        place += 1
    if "override" in traits or ("final" in traits and kind in ("method", "destructor")):
        traits.add("virtual")
    return Declarator(kind, name, type_, parameters, frozenset(traits))


def _parse_operator(rest: list[str], place: int, head: Head) -> list[Declarator] | None:
    """A function whose name begins with `operator`."""
    if place and rest[place - 1] == "::":
        return []
    end = len(rest)
    stop = place + 1
    if rest[stop : stop + 2] == ["(", ")"] or tuple(rest[stop : stop + 2]) == ("(", ")"):
        name = "operator()"
        stop += 2
        converts = False
    else:
        word = stop < end and bool(rest[stop].isidentifier() or rest[stop] == "::")
        converts = word and rest[stop] not in ("new", "delete", "co_await")
        while stop < end and rest[stop] != "(":
            if converts and rest[stop] == "<":
                stop = find_closing_angle(rest, stop) or stop + 1
            elif converts and rest[stop] == "decltype":
                stop = find_closing(rest, stop + 1)
            else:
                stop += 1
        spelt = rest[place + 1 : stop]
        if not converts and spelt[-1:] == [">"] and "<" in spelt[1:]:
            return []  # an explicit specialisation
        name = f"operator {format_type(spelt)}" if converts else "operator" + join_tokens(spelt)
        if not converts and word:
            name = "operator " + join_tokens(spelt)
    if stop >= end or rest[stop] != "(":
        return None
    behind = find_closing(rest, stop)
    group = rest[stop + 1 : behind - 1]
    if converts:
        return [_make_function("conversion", name, format_type(rest[place + 1 : stop]), rest, group, behind, head)]
    before, head = _remove_late_specifiers(rest[:place], head)
    return [_make_function("operator", name, cut_name([*before, "x"])[0], rest, group, behind, head)]


def _parse_grouped(rest: list[str], place: int, behind: int, head: Head) -> list[Declarator] | None:
    """`type (*name)(arguments)`, `type (name)(arguments)`."""
    group = rest[place + 1 : behind - 1]
    if len(group) == 1 and group[0].isidentifier() and behind < len(rest) and rest[behind] == "(":
        return parse_declarators([*rest[:place], group[0], *rest[behind:]], head._replace(place=0), "")
    if "(" in group and group[0] in _POINTERS:
        # a function that gives a pointer to a function or array
        inner = [*rest[:place], "(", group[0], ")", *rest[behind:]]
        opening = group.index("(")
        stop = find_closing(group, opening)
        if opening and group[opening - 1].isidentifier():
            return [
                _make_function(
                    "function", group[opening - 1], cut_name(inner)[0], group, group[opening + 1 : stop - 1], stop, head
                )
            ]
        return None
    piece = split(rest, "=")[0] if "=" in rest else rest
    type_, name = cut_name(piece)
    if not name:
        return None
    return [Declarator("alias" if "typedef" in head.words else "variable", name, type_, None, head.traits)]


def _parse_variables(rest: list[str], head: Head) -> list[Declarator] | None:
    """`type a, *b = 0, c[3];`"""
    found: list[Declarator] = []
    base: list[str] = []
    for number, piece in enumerate(split(list(rest))):
        value = ""
        for mark in ("=", "{", ":"):
            if mark in piece:
                cut = split(piece, mark)[0] if mark != "{" else piece[: piece.index("{")]
                if len(cut) < len(piece):
                    if mark != ":":
                        value = join_tokens(piece[len(cut) + (mark == "=") :])
                    piece = list(cut)
        if number:
            piece = [*base, *piece]
        piece, own = _remove_late_specifiers(piece, head)
        type_, name = cut_name(piece)
        if not name:
            if any(token == "::" for token in piece[-3:]) or not piece:
                return found
            return None if number or len(piece) > 1 else []
        if number == 0:
            base = []
            for token in piece:
                if token == name or token in _POINTERS:
                    break
                base.append(token)
        traits = own.traits
        if type_.endswith(" const") or (type_.startswith("const ") and "*" not in type_ and "&" not in type_):
            traits = traits | {"const"}
        kind = "alias" if "typedef" in head.words else "variable"
        keep = kind == "variable" and traits & {"const", "constexpr"} and len(value) <= 60
        found.append(Declarator(kind, name, type_, None, traits, value if keep else ""))
    return found
