"""A C or C++ header to what it offers (surface.py).

Reading is by declarations: directives are blanked, the rest is cut at `;`, `{` and `}`, bodies of functions are skipped
unread, and each declaration is read from its tokens. No grammar of whole files is involved, so that a macro nobody
knows spoils one declaration at most. Where #if branches cut through a declaration, the first one counts.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

from .condition import Condition
from .cpp import Scan, includes_of, scan
from .surface import Argument, Entity, HeaderSurface
from .surface_cpp_declarations import ClassHead, Declared, Head, class_head, declared, head_of, without_deprecation
from .surface_cpp_macros import DECLARES
from .surface_cpp_types import (
    arguments_of,
    closed,
    joined,
    split,
    tokens_of,
    type_text,
)


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
_DIRECTIVE = re.compile(r"^[ \t]*#[ \t]*(\w*)([^\n]*(?:(?<=\\)\n[^\n]*)*)", re.MULTILINE)
_NOT_NEWLINE = re.compile(r"[^\n]+")
_HIDDEN = re.compile(r"//[^\n]*|/\*.*?(?:\*/|\Z)|\"(?:[^\"\\\n]|\\.)*\"|'(?:[^'\\\n]|\\.)*'", re.DOTALL)
_DEFINE = re.compile(r"\s*([^\W\d]\w*)(\([^()]*\))?(.*)", re.DOTALL)
_LITERAL = re.compile(r"\(?\s*([-+]?(?:0[xX][\da-fA-F]+|\d[\d.]*(?:[eE][-+]?\d+)?)[uUlLfF]*|\"[^\"\n]{0,60}\")\s*\)?\Z")
_WARNS = re.compile(
    r"^[ \t]*#[ \t]*(?:warning|pragma[ \t]+(?:message|GCC[ \t]+warning))\b([^\n]*(?:(?<=\\)\n[^\n]*)*)", re.MULTILINE
)
_GONE = re.compile(r"deprecat|obsolete|has moved|been moved|been renamed|instead", re.IGNORECASE)
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
_NUMBER = re.compile(r"(?:0[xX][\da-fA-F]+|\d+)[uUlL]*\Z")
_HEADER_MACROS = ("DEPRECATED_HEADER", "HEADER_DEPRECATED")


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
        self.lost = 0
        self.deprecated: str | None = None
        self.access = ""
        self.under_all = scanned.segments[0][2] if len(scanned.segments) == 1 else None
        self.code = self._without_directives()

    def read(self) -> HeaderSurface:
        self._walk()
        scanned = self.scanned
        includes = includes_of(scanned)
        instead = ""
        self._header_warning()
        if self.deprecated is not None:
            named = _PATH.findall(self.deprecated)
            taken = [include.path for include in includes]
            both = [path for path in taken if any(path == name or path.endswith("/" + name) for name in named)]
            instead = both[0] if both else taken[0] if len(taken) == 1 else ""
        return HeaderSurface(
            tuple(self.entities),
            includes,
            tuple(dict.fromkeys(self.inline)),
            self.deprecated,
            instead,
            self.lost,
            tuple(scanned.problems),
        )

    # Directives

    def _without_directives(self) -> str:
        visible = self.scanned.visible
        if "#" not in visible:
            return visible
        gone: list[tuple[int, int]] = []
        opened: list[list[tuple[int, int, str, str]]] = []
        undefined: set[str] = set()
        defines: list[tuple[int, int, str]] = []
        for match in _DIRECTIVE.finditer(visible):
            start, end = match.span()
            word = match[1]
            gone.append((start, end))
            if word == "define":
                defines.append((start, end, match[2]))
            elif word == "undef":
                undefined.add(match[2].strip())
            elif word in ("if", "ifdef", "ifndef"):
                opened.append([(start, end, word, match[2].strip())])
            elif opened and word in ("else", "elif", "elifdef", "elifndef"):
                opened[-1].append((start, end, word, match[2].strip()))
            elif opened and word == "endif":
                branches = opened.pop()
                if len(branches) > 1 or branches[0][3] == "0":
                    gone += _cut(visible, [*branches, (start, end, word, "")])
        gone.sort()
        pieces: list[str] = []
        position = 0
        for start, end in gone:
            if end <= position:
                continue
            start = max(start, position)
            hidden = visible[start:end]
            pieces += [
                visible[position:start],
                _NOT_NEWLINE.sub(_spaces, hidden) if "\n" in hidden else " " * len(hidden),
            ]
            position = end
        pieces.append(visible[position:])
        self._macros(defines, undefined)
        return "".join(pieces)

    def _macros(self, defines: list[tuple[int, int, str]], undefined: set[str]) -> None:
        seen: set[tuple[str, tuple[Condition, ...]]] = set()
        for start, end, body in defines:
            match = _DEFINE.match(body)
            if match is None or match[1] in undefined:
                continue
            name = match[1]
            conditions = self._conditions(start)
            if (name, conditions) in seen:
                continue
            parameters = None
            value = ""
            if match[2]:
                parameters = arguments_of(tokens_of(match[2][1:-1].replace("\\\n", " ")))
            else:
                whole = _HIDDEN.sub(_kept, self.text[start:end])
                found = _DEFINE.match(whole.split("define", 1)[-1])
                rest = found[3].strip() if found else ""
                literal = _LITERAL.match(rest)
                value = literal[1] if literal else ""
                if not rest and self._is_guard(name, start):
                    continue
            seen.add((name, conditions))
            plain = None
            if parameters is not None:
                plain = tuple(Argument(parameter.type) for parameter in parameters[0])
                if parameters[1] or "..." in match[2]:
                    plain = (*(one for one in plain if one.type), Argument("..."))
            self.entities.append(
                Entity(
                    "macro", name, self.scanned.place(start)[0], parameters=plain, value=value, conditions=conditions
                )
            )

    def _is_guard(self, name: str, start: int) -> bool:
        before = self.scanned.visible[max(0, start - 400) : start].rstrip()
        line = before[before.rfind("\n") + 1 :]
        return line.lstrip()[:1] == "#" and name in line

    def _header_warning(self) -> None:
        text = self.text
        if self.deprecated is not None or ("warning" not in text and "pragma" not in text):
            return
        for match in _WARNS.finditer(text):
            before = text[: match.start()]
            if before.rfind("/*") > before.rfind("*/"):
                continue
            message = " ".join(re.sub(r'\\\n|["()]', " ", match[1]).split())
            if _GONE.search(message):
                self.deprecated = message
                return

    # Declarations

    def _walk(self) -> None:
        code = self.code
        marks = [match.start() for match in _MARKS.finditer(code)]
        partner = _partners(code, marks)
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
                    self._statement(start, at)
                start = at + 1
                continue
            other = partner[index]
            behind = marks[other] + 1 if other < count else len(code)
            opened = self._opened(start, at, head)
            if opened is _INIT:
                index = other + 1
                continue
            if opened is _BODY:
                start = behind
                index = other + 1
                continue
            if opened.found is None:
                if opened.kind == "namespace":
                    self._namespace(opened.tokens, at, (behind, other + 1))
                else:
                    self.scopes.append(self.scopes[-1]._replace(class_name="", resume=(behind, other + 1)))
            else:
                # what stands between the closing brace and the next `;` names variables or types
                resume = (behind, other + 1)
                tail: list[str] = []
                if other + 1 < count and code[marks[other + 1]] == ";":
                    tail = tokens_of(code[behind : marks[other + 1]])
                    if _is_tail(tail):
                        resume = (marks[other + 1] + 1, other + 2)
                    else:
                        tail = []
                if not self._type(opened.reading, opened.found, tail, start, at, behind - 1, resume):
                    start, index = resume
                    continue
                accesses.append(self.access)
                self.access = "private" if opened.found.kind == "class" else "public"
            start = at + 1
            index += 1
        rest = code[start:]
        if rest and not rest.isspace():
            self._statement(start, len(code))

    def _opened(self, start: int, at: int, head: str) -> _Opened:
        """What a `{` opens. The function whose body it is, is read."""
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
        tokens, deprecated = self._tokens(start, at, head)
        scope = self.scopes[-1]
        reading = head_of(tokens, scope.class_name)
        place = reading.place
        if place >= len(tokens):
            if "linkage" in reading.words:
                self._expanded(reading, start, at)
                return _Opened("linkage", tokens, reading)
            if reading.macros and not scope.class_name:
                # a macro that opens a block
                return _BODY
            self._lose(head)
            return _BODY
        word = tokens[place]
        if word == "namespace" or (word == "inline" and tokens[place + 1 : place + 2] == ["namespace"]):
            self._expanded(reading, start, at)
            return _Opened("namespace", tokens, reading)
        while word in ("const", "volatile") and place + 1 < len(tokens):
            place += 1
            word = tokens[place]
        if word in ("class", "struct", "union", "enum"):
            found = class_head(tokens, place)
            if found is not None:
                self._expanded(reading, start, at)
                if deprecated is not None:
                    reading = reading._replace(words=reading.words | {"deprecated:" + deprecated})
                return _Opened("type", tokens, reading, found)
        if ")" not in stripped or (
            "=" in tokens and "operator" not in tokens and len(split(tokens, "=")[0]) < len(tokens)
        ):
            return _INIT
        if last not in ")}":
            behind = tokens[_last_closing(tokens) + 1 :]
            if not (
                tokens[-1] in _BODY_WORDS
                or "->" in behind
                or "requires" in tokens
                or (len(behind) == 1 and behind[0].isupper())
                or all(token in _BODY_WORDS or token in ("&", "&&") or token.isupper() for token in behind)
            ):
                return _INIT
        self._declare(tokens, reading, deprecated, start, at)
        return _BODY

    def _tokens(self, start: int, at: int, head: str) -> tuple[list[str], str | None]:
        if '"' in head or ("=" in head and "'" in self.text[start:at]):
            head = self._restored(start, at, head)
        tokens = tokens_of(head.lstrip())
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
                        behind = closed(tokens, behind)
                    self._macro(word[0], tuple(tokens[place + 2 : behind - 1]), start, at)
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
            return without_deprecation(tokens)
        return tokens, None

    def _restored(self, start: int, at: int, head: str) -> str:
        """A piece of code with its literals."""
        pieces = list(head)
        text = self.text[start:at]
        for match in _HIDDEN.finditer(text):
            first = match[0][0]
            if first == '"' and head[match.start()] == '"':
                pieces[match.start() : match.end()] = match[0]
            elif first == "'" and head[: match.start()].rstrip()[-1:] in tuple("=(,?:+-|&<>{"):
                line = text.rfind("\n", 0, match.start()) + 1
                if text[line : match.start()].lstrip()[:1] != "#":
                    pieces[match.start() : match.end()] = match[0]
        return "".join(pieces)

    def _statement(self, start: int, at: int) -> None:
        head = self.code[start:at]
        tokens, deprecated = self._tokens(start, at, head)
        if not tokens:
            return
        first = tokens[0]
        scope = self.scopes[-1]
        if first in ("public", "private", "protected"):
            return
        reading = head_of(tokens, scope.class_name)
        self._expanded(reading, start, at)
        place = reading.place
        if place >= len(tokens) or "instantiation" in reading.words:
            return
        if "friend" in reading.traits and "(" not in head:
            return
        word = tokens[place]
        if word == "using":
            self._using(tokens[place + 1 :], reading, deprecated, start, at)
        elif word == "namespace":
            if "=" in tokens:
                cut = tokens.index("=")
                self._add(
                    "namespace alias", tokens[cut - 1], start, at, type=joined(tokens[cut + 1 :]).removeprefix("::")
                )
        elif word in ("static_assert", "_Static_assert", "_Pragma", "asm", "return"):
            return
        elif word == "concept":
            self._add(
                "concept", tokens[place + 1] if place + 1 < len(tokens) else "", start, at, template=reading.template
            )
        elif word in ("class", "struct", "union", "enum") and self._is_forward(tokens, place, reading):
            return
        else:
            self._declare(tokens, reading, deprecated, start, at)

    def _is_forward(self, tokens: list[str], place: int, reading: Head) -> bool:
        if "typedef" in reading.words:
            return False
        found = class_head(tokens, place)
        return found is not None and (found.ends or found.kind == "enum") and "doubtful" not in found.traits

    def _using(self, rest: list[str], reading: Head, deprecated: str | None, start: int, at: int) -> None:
        if not rest:
            return
        if rest[0] == "namespace":
            scope = self.scopes[-1].prefix[:-2]
            name = joined(rest[1:]).removeprefix("::")
            self._add("using namespace", scope, start, at, type=name, whole=True)
            return
        if "=" in rest and rest[0] != "enum":
            cut = rest.index("=")
            self._add(
                "alias",
                rest[0],
                start,
                at,
                type=type_text(rest[cut + 1 :]),
                template=reading.template,
                deprecated=deprecated,
            )
            return
        for piece in split(rest):
            words = [word for word in piece if word not in ("typename", "...")]
            if "operator" in words:
                cut = words.index("operator")
                name = "operator" + joined(words[cut + 1 :])
            else:
                name = next((word for word in reversed(words) if word.isidentifier()), "")
            if name and "::" in words:
                self._add("using", name, start, at, type=joined(words).removeprefix("::"), deprecated=deprecated)

    def _expanded(self, reading: Head, start: int, at: int) -> None:
        for name, arguments in reading.macros:
            self._macro(name, arguments, start, at)

    def _macro(self, name: str, arguments: tuple[str, ...], start: int, at: int) -> None:
        if name not in DECLARES:
            if any(mark in name for mark in _HEADER_MACROS) and self.deprecated is None:
                self.deprecated = "".join(word[1:-1] for word in arguments if word[:1] == '"')
            return
        for tokens in _expansion(name, arguments):
            scope = self.scopes[-1]
            self._declare_macro(tokens, head_of(tokens, scope.class_name), name, start, at)

    def _declare_macro(self, tokens: list[str], reading: Head, macro: str, start: int, at: int) -> None:
        place = reading.place
        if tokens[place : place + 1] == ["using"]:
            cut = tokens.index("=")
            self._add(
                "alias", tokens[place + 1], start, at, type=type_text(tokens[cut + 1 :]), macro=macro, at_word=macro
            )
            return
        for one in declared(tokens, reading, self.scopes[-1].class_name) or ():
            self._emit(one, reading, None, start, at, macro)

    def _declare(self, tokens: list[str], reading: Head, deprecated: str | None, start: int, at: int) -> None:
        scope = self.scopes[-1]
        place = reading.place
        # a macro call that ends with `;` or a block
        word = tokens[place]
        if (
            tokens[place + 1 : place + 2] == ["("]
            and word != scope.class_name
            and (word in DECLARES or any(mark in word for mark in _HEADER_MACROS))
            and closed(tokens, place + 1) >= len(tokens)
        ):
            self._macro(word, tuple(tokens[place + 2 : -1]), start, at)
            return
        found = declared(tokens, reading, scope.class_name)
        if found is None:
            self._lose(self.code[start:at])
            return
        if reading.specialised and not scope.class_name:
            return  # the general template is what is offered
        for one in found:
            self._emit(one, reading, deprecated, start, at, "")

    def _emit(self, one: Declared, reading: Head, deprecated: str | None, start: int, at: int, macro: str) -> None:
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
            kind,
            one.name,
            start,
            at,
            type=one.type,
            parameters=one.parameters,
            template=reading.template,
            traits=traits,
            value=one.value,
            deprecated=deprecated,
            macro=macro,
            at_word=word,
            friend="friend" in traits,
        )

    def _add(
        self,
        kind: str,
        name: str,
        start: int,
        at: int,
        type: str = "",
        parameters=None,
        template=None,
        traits: frozenset[str] = frozenset(),
        value: str = "",
        deprecated: str | None = None,
        bases=(),
        arguments: str = "",
        macro: str = "",
        at_word: str = "",
        whole: bool = False,
        friend: bool = False,
    ) -> None:
        scope = self.scopes[-1]
        if not name and not whole:
            return
        access = self.access if scope.class_name and not friend else ""
        if access == "private" and not ("virtual" in traits or "deleted" in traits or kind in _MADE):
            return
        offset = self._offset(at_word or name, start, at)
        prefix = scope.around if friend else scope.prefix
        self.entities.append(
            Entity(
                kind,
                name if whole else prefix + name,
                self.scanned.place(offset)[0],
                type,
                parameters,
                template,
                _sorted(traits) if traits else (),
                access,
                value,
                deprecated if deprecated is not None else scope.deprecated if not scope.class_name else None,
                bases,
                arguments,
                scope.internal,
                macro,
                self._conditions(offset),
            )
        )

    def _offset(self, word: str, start: int, at: int) -> int:
        """Where a declaration names what it declares."""
        code = self.code
        word = word.rpartition("::")[2]
        place = code.find(word + "(", start, at)
        if place >= 0 and not (code[place - 1].isalnum() or code[place - 1] == "_"):
            return place
        place = self._word(word, start, at)
        if place > start:
            return place
        head = code[start:at]
        return start + len(head) - len(head.lstrip())

    def _word(self, word: str, start: int, end: int) -> int:
        """Where a word stands by itself; the start when it does not."""
        code = self.code
        at = code.find(word, start, end)
        while at >= 0:
            behind = code[at + len(word) : at + len(word) + 1]
            if not (behind.isalnum() or behind == "_") and not (code[at - 1].isalnum() or code[at - 1] == "_"):
                return at
            at = code.find(word, at + 1, end)
        return start

    def _conditions(self, offset: int) -> tuple[Condition, ...]:
        if self.under_all is not None:
            return self.under_all
        scanned = self.scanned
        _start, _, conditions = scanned.segments[min(bisect_right(scanned.ends, offset), len(scanned.segments) - 1)]
        return conditions

    def _lose(self, head: str) -> None:
        self.lost += len(head.strip())

    # Scopes

    def _namespace(self, tokens: list[str], at: int, resume: tuple[int, int]) -> None:
        around = self.scopes[-1]
        place = tokens.index("namespace")
        names: list[str] = []
        inline = [place > 0 and "inline" in tokens[:place]]
        position = place + 1
        while position < len(tokens):
            token = tokens[position]
            if token == "[" or (token == "(" and position):
                position = closed(tokens, position)
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

    def _type(
        self,
        reading: Head,
        found: ClassHead,
        tail: list[str],
        start: int,
        at: int,
        end: int,
        resume: tuple[int, int],
    ) -> bool:
        """Opens a class, or reads an enum; whether there is something to be read inside."""
        scope = self.scopes[-1]
        typedef = "typedef" in reading.words
        deprecated = next((word[11:] for word in reading.words if word.startswith("deprecated:")), None)
        if tail and ("DEPRECATED" in " ".join(tail) or "deprecated" in tail):
            tail, deprecated = without_deprecation(tail)
        name = found.name
        if "::" in name or (scope.class_name and self.access == "private"):
            return False  # `struct A::Impl {`: nobody else sees it
        others = _declarators(tail)
        if not name and typedef:
            name = next((word for word, stars in others if not stars), "")
            others = [(word, stars) for word, stars in others if word != name]
        member = "" if name else next((word for word, _ in others), "")
        traits = found.traits - {"doubtful"}
        if name:
            self._add(
                found.kind,
                name,
                start,
                at,
                type=found.type,
                template=reading.template,
                traits=traits,
                deprecated=deprecated,
                bases=found.bases,
                arguments=found.arguments if found.arguments or not reading.specialised else "",
                at_word=found.name,
            )
        for word, stars in others:
            kind = "alias" if typedef else "field" if scope.class_name else "variable"
            self._add(kind, word, end, resume[0], type=(name or found.kind) + stars, traits=reading.traits)
        if found.kind == "enum":
            self._enumerators(name, "scoped" in traits, at, end)
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

    def _enumerators(self, name: str, scoped: bool, at: int, end: int) -> None:
        scope = self.scopes[-1]
        body = self.code[at + 1 : end]
        if "'" in self.text[at:end] or '"' in body:
            body = self._restored(at + 1, end, body)
        prefix = scope.prefix + (name + "::" if scoped and name else "")
        number: int | None = -1
        last = ""
        steps = 0
        position = at + 1
        for piece in split(tokens_of(body)):
            deprecated = None
            while piece and piece[0] == "#":
                piece = piece[1:]
            if any("eprecated" in word or "DEPRECATED" in word for word in piece[1:]):
                piece, deprecated = without_deprecation(piece)
            if not piece or not piece[0].isidentifier():
                continue
            word = piece[0]
            offset = self._word(word, position, end)
            position = offset + len(word)
            steps += 1
            if "=" in piece:
                value = piece[piece.index("=") + 1 :]
                number = _value(value)
                if number is None:
                    last = joined(value)
                    steps = 0
            elif number is not None:
                number += 1
            shown = str(number) if number is not None else last if steps == 0 else f"{last}+{steps}"
            self.entities.append(
                Entity(
                    "enumerator",
                    prefix + word,
                    self.scanned.place(offset)[0],
                    scope.prefix + name if name else "",
                    access=self.access if scope.class_name else "",
                    value=shown,
                    deprecated=deprecated,
                    internal=scope.internal,
                    conditions=self._conditions(offset),
                )
            )


@lru_cache(maxsize=4096)
def _sorted(traits: frozenset[str]) -> tuple[str, ...]:
    return tuple(sorted(traits))


@lru_cache(maxsize=1024)
def _expansion(name: str, arguments: tuple[str, ...]) -> list[list[str]]:
    """The declarations of a known macro, each as tokens."""
    parameters, text = DECLARES[name]
    given = split(list(arguments))
    if len(parameters) == 1:
        given = [list(arguments)]
    values = dict(zip(parameters, given, strict=False))
    statements: list[list[str]] = []
    for statement in text.split(";"):
        tokens: list[str] = []
        pending = False
        for token in tokens_of(statement.replace("##", " \x01 ")):
            if token == "\x01":
                pending = True
            elif pending:
                tokens[-1] += token
                pending = False
            else:
                tokens += values.get(token, [token])
        if tokens:
            statements.append(tokens)
    return statements


def _value(tokens: Sequence[str]) -> int | None:
    """The number an enumerator is given, where that is told by the text alone."""
    sign = 1
    rest = list(tokens)
    while rest[:1] == ["("] and rest[-1:] == [")"]:
        rest = rest[1:-1]
    if rest[:1] in (["-"], ["+"]):
        sign = -1 if rest[0] == "-" else 1
        rest = rest[1:]
    if len(rest) == 3 and rest[1] == "<<" and all(_NUMBER.match(rest[place]) for place in (0, 2)):
        shift = _number(rest[2])
        return sign * (_number(rest[0]) << shift) if shift < 64 else None
    if len(rest) == 1:
        token = rest[0]
        if _NUMBER.match(token):
            return sign * _number(token)
        if len(token) == 3 and token[0] == "'":
            return sign * ord(token[1])
    return None


def _number(token: str) -> int:
    token = token.rstrip("uUlL")
    if token[:2] in ("0x", "0X"):
        return int(token, 16)
    if token[0] == "0" and len(token) > 1 and all(digit in "01234567" for digit in token):
        return int(token, 8)
    return int(token)


def _spaces(match: re.Match[str]) -> str:
    return " " * (match.end() - match.start())


def _kept(match: re.Match[str]) -> str:
    """Literals stay, comments go."""
    return " " if match[0][0] == "/" else match[0]


def _partners(code: str, marks: list[int]) -> list[int]:
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


def _cut(visible: str, branches: list[tuple[int, int, str, str]]) -> list[tuple[int, int]]:
    """Of branches that cut through a declaration, all but one are left out; so is what stands under `#if 0`."""
    bodies = [(branches[number][1], branches[number + 1][0]) for number in range(len(branches) - 1)]
    never = 0 if branches[0][3] == "0" and branches[0][2] == "if" else -1
    if len(bodies) > 1 and any(
        not _whole(visible[start:end]) for number, (start, end) in enumerate(bodies) if number != never
    ):
        keep = 1 if never == 0 else 0
        return [body for number, body in enumerate(bodies) if number != keep]
    return [bodies[0]] if never == 0 else []


def _whole(body: str) -> bool:
    if body.count("{") != body.count("}") or body.count("(") != body.count(")"):
        return False
    last = ""
    for line in reversed(body.split("\n")):
        line = line.strip()
        if line and line[0] != "#":
            last = line[-1]
            break
    return not last or last in ";{}:)"


def _last_closing(tokens: Sequence[str]) -> int:
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
        behind = closed(tokens, behind)
    return behind < len(tokens) and (tokens[behind] in _ACCESS or word in DECLARES)


def _is_tail(tail: Sequence[str]) -> bool:
    """Whether what stands behind the closing brace of a class names variables, and is no new declaration."""
    return not tail or (
        len(tail) < 60
        and "(" not in [word for word in tail if word == "operator"]
        and not any(
            word
            in ("class", "struct", "namespace", "using", "typedef", "enum", "template", "public", "private", "static")
            for word in tail
        )
    )


def _declarators(tail: Sequence[str]) -> list[tuple[str, str]]:
    """Names behind a closing brace, with the pointers and array bounds they have."""
    found = []
    for piece in split(list(tail)):
        stars = "".join(word for word in piece if word in ("*", "&"))
        place = 0
        name = ""
        while place < len(piece):
            word = piece[place]
            if word in ("__attribute__", "__declspec", "alignas"):
                place = closed(piece, place + 1) if place + 1 < len(piece) else place + 1
                continue
            if word in ("=", ":", "{"):
                break
            if word == "[":
                behind = closed(piece, place)
                if name and piece[place + 1 : place + 2] != ["["]:
                    stars += joined(piece[place:behind])
                place = behind
                continue
            if word == "(":
                place = closed(piece, place)
                continue
            if word.isidentifier() and word not in ("const", "volatile"):
                name = name if name else word
            place += 1
        if name and not (name.isupper() and name.endswith("PACKED")):
            found.append((name, stars))
    return found
