"""A C or C++ header to what it offers (impact/facts/surface.py).

Reading is by declarations: directives are blanked, the rest is cut at `;`, `{` and `}`, bodies of functions are skipped
unread, and each declaration is read from its tokens. No grammar of whole files is involved, so that a macro nobody
knows spoils one declaration at most. Where #if branches cut through a declaration, the first one counts.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache
from typing import Any, NamedTuple

from ...impact.facts.cpp.lexical import Scan, collect_includes, find_words, scan
from ...impact.facts.surface import Entity, HeaderSurface
from .cpp_declarations import (
    ClassHead,
    Declarator,
    Head,
    parse_class_head,
    parse_declarators,
    parse_head,
    remove_deprecation,
)
from .cpp_directives import HIDDEN, blank_directives, find_warning
from .cpp_enums import list_enumerators
from .cpp_macros import DECLARES, expand_macro
from .cpp_types import find_closing, format_type, join_tokens, split, split_tokens


class _Scope(NamedTuple):
    """A namespace or class that is open. prefix: its qualified name with `::`; class_name: simple, empty for a
    namespace; around: prefix of the namespace; resume: where to go on behind it, a place and the number of a mark."""

    prefix: str
    class_name: str
    around: str
    internal: bool
    deprecated: str | None
    resume: tuple[int, int]
    end: int


class _Opened(NamedTuple):
    """What a `{` opens: `init` (an initialiser), `body` (of a function, already read), `namespace`, `linkage`, or
    `type`, whose head is then given."""

    kind: str
    tokens: list[str]
    reading: Head
    found: ClassHead | None = None


_NO_HEAD = Head(0, None, frozenset(), frozenset())
_INIT = _Opened("init", [], _NO_HEAD)
_BODY = _Opened("body", [], _NO_HEAD)
_MARKS = re.compile(r"[{};]")
_PATH = re.compile(r"[\w+.-]+(?:/[\w+.-]+)*\.(?:hpp|hxx|hh|h)\b")
_ACCESS = frozenset(("public", "protected", "private", "signals", "Q_SIGNALS", "slots"))
_SECTION = re.compile(r"(?<!:):(?!:)")
_INTERNAL = re.compile(
    r"(?:\w+_)?(?:detail|details|internal|internals|impl|_impl|private|priv)(?:_\w+)?\Z", re.IGNORECASE
)
_ENDS_INIT = "=(,[&|+*?<"
_BODY_WORDS = frozenset(("const", "noexcept", "override", "final", "mutable", "try", "volatile"))
_LAST_WORD = re.compile(r"(\w+)\s*\Z")
_MADE = frozenset(("constructor", "destructor"))
_HEADER_MACROS = ("DEPRECATED_HEADER", "HEADER_DEPRECATED")


Facts = HeaderSurface
LIMITS = {"": "cpp"}
"""What facts/kinds.py asks a module that makes facts for: their type, and which limit the size of files has."""


def extract(data: bytes) -> HeaderSurface:
    """What a header offers. Never raises but RecursionError on what nobody writes; what was not understood is counted
    in `lost`."""
    return _Reader(scan(data)).read()


class _Reader:
    """Goes through one header. code: the text with comments, literals and directives blanked, offsets as in text."""

    def __init__(self, scanned: Scan) -> None:
        self.scanned = scanned
        self.text = scanned.text
        self.entities: list[Entity] = []
        self.inline: list[str] = []
        self.announced: dict[str, None] = {}
        self.lost = 0
        self.deprecated: str | None = None
        self.access = ""
        # Where the declaration that is read begins and ends.
        self.span = (0, 0)
        self.code, macros = blank_directives(scanned)
        self.entities += macros

    def read(self) -> HeaderSurface:
        self._walk()
        scanned = self.scanned
        includes = collect_includes(scanned)
        instead = ""
        if self.deprecated is None:
            self.deprecated = find_warning(self.text)
        if self.deprecated is not None:
            named = _PATH.findall(self.deprecated)
            taken = [include.path for include in includes]
            both = [path for path in taken if any(path == name or path.endswith("/" + name) for name in named)]
            instead = both[0] if both else taken[0] if len(taken) == 1 else ""
        return HeaderSurface(
            tuple(self.entities), includes, tuple(dict.fromkeys(self.inline)), self.deprecated, instead, self.lost,
            tuple(scanned.problems), tuple(self.announced),
        )  # fmt: skip

    def _walk(self) -> None:
        code = self.code
        marks = [match.start() for match in _MARKS.finditer(code)]
        partner = _match_braces(code, marks)
        count = len(marks)
        self.scopes = [_Scope("", "", "", False, None, (0, 0), len(code) + 1)]
        accesses: list[str] = []
        start = index = 0
        while index < count:
            at = marks[index]
            sign = code[at]
            if sign == "}":
                if len(self.scopes) > 1:
                    scope = self.scopes.pop()
                    if scope.class_name:
                        self.access = accesses.pop()
                    start, index = scope.resume
                else:
                    start = at + 1
                    index += 1
                continue
            head = code[start:at]
            if sign == ";":
                index += 1
                if head.count("(") > head.count(")"):
                    continue  # inside a lambda that is a default
                if head and not head.isspace():
                    self._read_statement(start, at)
                start = at + 1
                continue
            other = partner[index]
            behind = marks[other] + 1 if other < count else len(code)
            opened = self._read_opening(start, at, head)
            if opened is _INIT:
                index = other + 1
                continue
            if opened is _BODY:
                start = behind
                index = other + 1
                continue
            if opened.found is None:
                if opened.kind == "namespace":
                    self._open_namespace(opened.tokens, at, (behind, other + 1))
                else:
                    self.scopes.append(self.scopes[-1]._replace(class_name="", resume=(behind, other + 1)))
            else:
                # what stands between the closing brace and the next `;` names variables or types
                resume = (behind, other + 1)
                tail: list[str] = []
                if other + 1 < count and code[marks[other + 1]] == ";":
                    tail = split_tokens(code[behind : marks[other + 1]])
                    if declares_variables(tail):
                        resume = (marks[other + 1] + 1, other + 2)
                    else:
                        tail = []
                if not self._open_type(opened.reading, opened.found, tail, behind - 1, resume):
                    start, index = resume
                    continue
                accesses.append(self.access)
                self.access = "private" if opened.found.kind == "class" else "public"
            start = at + 1
            index += 1
        rest = code[start:]
        if rest and not rest.isspace():
            self._read_statement(start, len(code))

    def _read_opening(self, start: int, at: int, head: str) -> _Opened:
        """What a `{` opens. The function whose body it is, is read."""
        self.span = (start, at)
        stripped = head.rstrip()
        last = stripped[-1:]
        if not last:
            return _BODY
        if (
            last in _ENDS_INIT
            and not stripped.endswith(("operator=", "operator+", "operator*", "operator<"))
            and not (last in "&" and ")" in stripped[-12:])
        ):
            return _INIT
        if stripped.count("(") != stripped.count(")"):
            return _INIT if stripped.count("(") > stripped.count(")") else _BODY
        tokens, deprecated = self._read_tokens(head)
        scope = self.scopes[-1]
        reading = parse_head(tokens, scope.class_name)
        place = reading.place
        if place >= len(tokens):
            if "linkage" in reading.words:
                self._expand_macros(reading)
                return _Opened("linkage", tokens, reading)
            if reading.macros and not scope.class_name:
                # a macro that opens a block
                return _BODY
            self._count_lost(head)
            return _BODY
        word = tokens[place]
        if word == "namespace":
            self._expand_macros(reading)
            return _Opened("namespace", tokens, reading)
        while word in ("const", "volatile") and place + 1 < len(tokens):
            place += 1
            word = tokens[place]
        if word in ("class", "struct", "union", "enum"):
            found = parse_class_head(tokens, place)
            if found is not None:
                self._expand_macros(reading)
                if deprecated is not None:
                    reading = reading._replace(words=reading.words | {"deprecated:" + deprecated})
                return _Opened("type", tokens, reading, found)
        if ")" not in stripped or (
            "=" in tokens and "operator" not in tokens and len(split(tokens, "=")[0]) < len(tokens)
        ):
            return _INIT
        if last not in ")}":
            behind = tokens[_find_last_closing(tokens) + 1 :]
            if not (
                tokens[-1] in _BODY_WORDS
                or "->" in behind
                or "requires" in tokens
                or (len(behind) == 1 and behind[0].isupper())
                or all(token in _BODY_WORDS or token in ("&", "&&") or token.isupper() for token in behind)
            ):
                return _INIT
        self._declare(tokens, reading, deprecated)
        return _BODY

    def _read_tokens(self, head: str) -> tuple[list[str], str | None]:
        start, at = self.span
        if '"' in head or ("=" in head and "'" in self.text[start:at]):
            head = self._restore_literals(start, at, head)
        tokens = split_tokens(head.lstrip())
        place = 0
        # sections of a class: `public:`, `public Q_SLOTS:`
        if self.scopes[-1].class_name and ":" in tokens:
            while True:
                word = tokens[place : place + 1]
                if not word:
                    break
                if word[0] in _ACCESS:
                    if tokens[place + 1 : place + 2] == [":"]:
                        self.access = word[0] if word[0] in ("public", "protected", "private") else "public"
                        place += 2
                        continue
                    if tokens[place + 2 : place + 3] == [":"] and tokens[place + 1].isidentifier():
                        self.access = word[0]
                        place += 3
                        continue
                    break
                if _is_macro_before_section(tokens, place):
                    behind = place + 1
                    if tokens[behind] == "(":
                        behind = find_closing(tokens, behind)
                    self._expand_macro(word[0], tuple(tokens[place + 2 : behind - 1]))
                    place = behind
                    continue
                break
            if place:
                tokens = tokens[place:]
        if "(class)" in head or "(struct)" in head:
            # ATTRIBUTE_ALIGNED16(class) Name
            place = next(index for index, token in enumerate(tokens) if token in ("class", "struct"))
            if place > 1 and tokens[place + 1 : place + 2] == [")"] and tokens[place - 1] == "(":
                tokens[place - 2 : place + 2] = [tokens[place]]
        if "DEPRECATED" in head or "deprecated" in head:
            return remove_deprecation(tokens)
        return tokens, None

    def _restore_literals(self, start: int, at: int, head: str) -> str:
        """A piece of code with its literals."""
        pieces = list(head)
        text = self.text[start:at]
        for match in HIDDEN.finditer(text):
            first = match[0][0]
            if first == '"' and head[match.start()] == '"':
                pieces[match.start() : match.end()] = match[0]
            elif first == "'" and head[: match.start()].rstrip()[-1:] in tuple("=(,?:+-|&<>{"):
                line = text.rfind("\n", 0, match.start()) + 1
                if text[line : match.start()].lstrip()[:1] != "#":
                    pieces[match.start() : match.end()] = match[0]
        return "".join(pieces)

    def _read_statement(self, start: int, at: int) -> None:
        self.span = (start, at)
        head = self.code[start:at]
        tokens, deprecated = self._read_tokens(head)
        if not tokens:
            return
        first = tokens[0]
        scope = self.scopes[-1]
        if first in ("public", "private", "protected"):
            return
        reading = parse_head(tokens, scope.class_name)
        self._expand_macros(reading)
        place = reading.place
        if place >= len(tokens) or "instantiation" in reading.words:
            return
        if "friend" in reading.traits and "(" not in head:
            return
        word = tokens[place]
        if word == "using":
            self._read_using(tokens[place + 1 :], reading, deprecated)
        elif word == "namespace":
            if "=" in tokens:
                cut = tokens.index("=")
                self._add("namespace alias", tokens[cut - 1], type=join_tokens(tokens[cut + 1 :]).removeprefix("::"))
        elif word in ("static_assert", "_Static_assert", "_Pragma", "asm", "return"):
            return
        elif word == "concept":
            self._add("concept", "".join(tokens[place + 1 : place + 2]), template=reading.template)
        elif word in ("class", "struct", "union", "enum") and (forward := self._find_forward(tokens, place, reading)):
            if not scope.class_name and not reading.specialised and forward.name:
                self.announced[scope.prefix + forward.name] = None
        else:
            self._declare(tokens, reading, deprecated)

    def _find_forward(self, tokens: list[str], place: int, reading: Head) -> ClassHead | None:
        """The type that a statement declares and does not define."""
        found = parse_class_head(tokens, place) if "typedef" not in reading.words else None
        if found is None or "doubtful" in found.traits or not (found.ends or found.kind == "enum"):
            return None
        return found

    def _read_using(self, rest: list[str], reading: Head, deprecated: str | None) -> None:
        if not rest:
            return
        if rest[0] == "namespace":
            scope = self.scopes[-1].prefix[:-2]
            name = join_tokens(rest[1:]).removeprefix("::")
            self._add("using namespace", scope, type=name, whole=True)
            return
        if "=" in rest and rest[0] != "enum":
            cut = rest.index("=")
            type_ = format_type(rest[cut + 1 :])
            self._add("alias", rest[0], type=type_, template=reading.template, deprecated=deprecated)
            return
        for piece in split(rest):
            words = [word for word in piece if word not in ("typename", "...")]
            if "operator" in words:
                cut = words.index("operator")
                name = "operator" + join_tokens(words[cut + 1 :])
            else:
                name = next((word for word in reversed(words) if word.isidentifier()), "")
            if name and "::" in words:
                self._add("using", name, type=join_tokens(words).removeprefix("::"), deprecated=deprecated)

    def _expand_macros(self, reading: Head) -> None:
        for name, arguments in reading.macros:
            self._expand_macro(name, arguments)

    def _expand_macro(self, name: str, arguments: tuple[str, ...]) -> None:
        if name not in DECLARES:
            if any(mark in name for mark in _HEADER_MACROS) and self.deprecated is None:
                self.deprecated = "".join(word[1:-1] for word in arguments if word[:1] == '"')
            return
        for tokens in expand_macro(name, arguments):
            scope = self.scopes[-1]
            self._declare_macro(tokens, parse_head(tokens, scope.class_name), name)

    def _declare_macro(self, tokens: list[str], reading: Head, macro: str) -> None:
        place = reading.place
        if tokens[place : place + 1] == ["using"]:
            cut = tokens.index("=")
            self._add("alias", tokens[place + 1], type=format_type(tokens[cut + 1 :]), macro=macro, at_word=macro)
            return
        for one in parse_declarators(tokens, reading, self.scopes[-1].class_name) or ():
            self._emit(one, reading, None, macro)

    def _declare(self, tokens: list[str], reading: Head, deprecated: str | None) -> None:
        scope = self.scopes[-1]
        place = reading.place
        # a macro call that ends with `;` or a block
        word = tokens[place]
        if (
            tokens[place + 1 : place + 2] == ["("]
            and word != scope.class_name
            and (word in DECLARES or any(mark in word for mark in _HEADER_MACROS))
            and find_closing(tokens, place + 1) >= len(tokens)
        ):
            self._expand_macro(word, tuple(tokens[place + 2 : -1]))
            return
        found = parse_declarators(tokens, reading, scope.class_name)
        if found is None:
            self._count_lost(self.code[slice(*self.span)])
            return
        if reading.specialised and not scope.class_name:
            return  # the general template is what is offered
        for one in found:
            self._emit(one, reading, deprecated, "")

    def _emit(self, one: Declarator, reading: Head, deprecated: str | None, macro: str) -> None:
        scope = self.scopes[-1]
        kind = one.kind
        traits = one.traits
        in_class = bool(scope.class_name)
        if kind == "operator":
            kind = "method" if in_class and "friend" not in traits else "function"
        elif kind == "variable":
            kind = "field" if in_class else "variable"
        elif kind == "function" and in_class and "friend" not in traits:
            kind = "method"
        if "friend" in traits and kind not in ("function",):
            return
        word = "operator" if one.name.startswith("operator") and not macro else macro or one.name
        self._add(
            kind, one.name, traits, deprecated, word, type=one.type, parameters=one.parameters,
            template=reading.template, value=one.value, macro=macro,
        )  # fmt: skip

    def _add(
        self, kind: str, name: str, traits: frozenset[str] = frozenset(), deprecated: str | None = None,
        at_word: str = "", whole: bool = False, span: tuple[int, int] | None = None, **more: Any,
    ) -> None:  # fmt: skip
        """Notes what is declared. at_word: what stands where it is, its name when left out; whole: the name needs no
        scopes; more: what an Entity has besides."""
        scope = self.scopes[-1]
        if not name and not whole:
            return
        friend = "friend" in traits
        access = self.access if scope.class_name and not friend else ""
        if access == "private" and not ("virtual" in traits or "deleted" in traits or kind in _MADE):
            return
        if deprecated is None and not scope.class_name:
            deprecated = scope.deprecated
        offset = self._find_offset(at_word or name, *(span or self.span))
        prefix = "" if whole else scope.around if friend else scope.prefix
        self.entities.append(
            Entity(
                kind, prefix + name, self.scanned.locate(offset)[0], traits=_sort_traits(traits), access=access,
                deprecated=deprecated, internal=scope.internal, conditions=self.scanned.find_segment(offset)[2], **more,
            )
        )  # fmt: skip

    def _find_offset(self, word: str, start: int, at: int) -> int:
        """Where a declaration names what it declares."""
        code = self.code
        word = word.rpartition("::")[2]
        place = code.find(word + "(", start, at)
        if place >= 0 and not (code[place - 1].isalnum() or code[place - 1] == "_"):
            return place
        place = self._find_word(word, start, at)
        if place > start:
            return place
        head = code[start:at]
        return start + len(head) - len(head.lstrip())

    def _find_word(self, word: str, start: int, end: int) -> int:
        """Where a word stands by itself; the start when it does not."""
        return next(find_words(word, self.code, start, end), start)

    def _count_lost(self, head: str) -> None:
        self.lost += len(head.strip())

    def _open_namespace(self, tokens: list[str], at: int, resume: tuple[int, int]) -> None:
        around = self.scopes[-1]
        place = tokens.index("namespace")
        names: list[str] = []
        inline = [place > 0 and "inline" in tokens[:place]]
        position = place + 1
        while position < len(tokens):
            token = tokens[position]
            if token == "[" or (token == "(" and position):
                position = find_closing(tokens, position)
                continue
            if token == "::":
                inline.append(tokens[position + 1 : position + 2] == ["inline"])
            elif token.isidentifier() and token not in ("inline", "__attribute__") and len(names) < len(inline):
                names.append(token)
            position += 1
        prefix = around.prefix
        for name, transparent in zip(names, inline, strict=False):
            prefix += name + "::"
            if transparent:
                self.inline.append(prefix[:-2])
        internal = around.internal or any(_INTERNAL.match(name) for name in names)
        self.scopes.append(_Scope(prefix, "", prefix, internal, around.deprecated, resume, at))

    def _open_type(self, reading: Head, found: ClassHead, tail: list[str], end: int, resume: tuple[int, int]) -> bool:
        """Opens a class, or reads an enum; whether there is something to be read inside."""
        scope, at = self.scopes[-1], self.span[1]
        typedef = "typedef" in reading.words
        deprecated = next((word[11:] for word in reading.words if word.startswith("deprecated:")), None)
        if tail and ("DEPRECATED" in " ".join(tail) or "deprecated" in tail):
            tail, deprecated = remove_deprecation(tail)
        name = found.name
        if "::" in name or (scope.class_name and self.access == "private"):
            return False  # `struct A::Impl {`: nobody else sees it
        others = list_declarators(tail)
        if not name and typedef:
            name = next((word for word, stars in others if not stars), "")
            others = [(word, stars) for word, stars in others if word != name]
        member = "" if name else next((word for word, _ in others), "")
        traits = found.traits - {"doubtful"}
        if name:
            arguments = found.arguments if found.arguments or not reading.specialised else ""
            self._add(
                found.kind, name, traits, deprecated, found.name, type=found.type, template=reading.template,
                bases=found.bases, arguments=arguments,
            )  # fmt: skip
        for word, stars in others:
            kind = "alias" if typedef else "field" if scope.class_name else "variable"
            self._add(kind, word, reading.traits, span=(end, resume[0]), type=(name or found.kind) + stars)
        if found.kind == "enum":
            self._add_enumerators(name, "scoped" in traits, at, end)
            return False
        if reading.specialised and not name:
            return False
        label = name or member
        prefix = scope.prefix + (label + "::" if label else "")
        if found.arguments and label:
            prefix = f"{scope.prefix}{label}<{found.arguments}>::"
        # members of an unnamed union are members of the class around it
        class_name = label or scope.class_name or found.kind
        self.scopes.append(_Scope(prefix, class_name, scope.around, scope.internal, None, resume, at))
        return True

    def _add_enumerators(self, name: str, scoped: bool, at: int, end: int) -> None:
        scope = self.scopes[-1]
        body = self.code[at + 1 : end]
        if "'" in self.text[at:end] or '"' in body:
            body = self._restore_literals(at + 1, end, body)
        prefix = scope.prefix + (name + "::" if scoped and name else "")
        position = at + 1
        for word, value, deprecated in list_enumerators(body):
            offset = self._find_word(word, position, end)
            position = offset + len(word)
            self.entities.append(
                Entity(
                    "enumerator", prefix + word, self.scanned.locate(offset)[0], scope.prefix + name if name else "",
                    access=self.access if scope.class_name else "", value=value, deprecated=deprecated,
                    internal=scope.internal, conditions=self.scanned.find_segment(offset)[2],
                )
            )  # fmt: skip


@lru_cache(maxsize=4096)
def _sort_traits(traits: frozenset[str]) -> tuple[str, ...]:
    return tuple(sorted(traits))


def _match_braces(code: str, marks: list[int]) -> list[int]:
    """For every opening brace the number of the mark that closes it, the number of marks where none does."""
    partner = [len(marks)] * len(marks)
    opened: list[int] = []
    for index, at in enumerate(marks):
        sign = code[at]
        if sign == "{":
            opened.append(index)
        elif sign == "}" and opened:
            partner[opened.pop()] = index
    return partner


def _find_last_closing(tokens: Sequence[str]) -> int:
    for place in range(len(tokens) - 1, -1, -1):
        if tokens[place] == ")":
            return place
    return -1


def _is_macro_before_section(tokens: Sequence[str], place: int) -> bool:
    word = tokens[place]
    if not word.isidentifier() or not word.isupper():
        return False
    behind = place + 1
    if behind < len(tokens) and tokens[behind] == "(":
        behind = find_closing(tokens, behind)
    return behind < len(tokens) and (tokens[behind] in _ACCESS or word in DECLARES)


def declares_variables(tail: Sequence[str]) -> bool:
    """Whether what stands behind the closing brace of a class names variables, and is no new declaration."""
    return not tail or (
        len(tail) < 60
        and not any(
            word
            in ("class", "struct", "namespace", "using", "typedef", "enum", "template", "public", "private", "static")
            for word in tail
        )
    )


def list_declarators(tail: Sequence[str]) -> list[tuple[str, str]]:
    """Names behind a closing brace, with the pointers and array bounds they have."""
    found = []
    for piece in split(list(tail)):
        stars = "".join(word for word in piece if word in ("*", "&"))
        place = 0
        name = ""
        while place < len(piece):
            word = piece[place]
            if word in ("__attribute__", "__declspec", "alignas"):
                place = find_closing(piece, place + 1) if place + 1 < len(piece) else place + 1
                continue
            if word in ("=", ":", "{"):
                break
            if word == "[":
                behind = find_closing(piece, place)
                if name and piece[place + 1 : place + 2] != ["["]:
                    stars += join_tokens(piece[place:behind])
                place = behind
                continue
            if word == "(":
                place = find_closing(piece, place)
                continue
            if word.isidentifier() and word not in ("const", "volatile"):
                name = name if name else word
            place += 1
        if name and not (name.isupper() and name.endswith("PACKED")):
            found.append((name, stars))
    return found
