"""Fields and constants of other packages' interfaces that a C++ file uses, told by the types of its variables.

A variable's type is read from its declaration in the file, or in the package's headers that reach it; `a.b[0].c` is
followed through the fields' types. Where that is not possible, only names that can mean nothing else count.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import lru_cache

from .expressions_cpp import FAR, NO_TYPES, chain_before, declarations_of, in_scope
from .members import Found, Interface, Scope, Type, section_of

_POINTERS = frozenset(
    [
        "shared_ptr",
        "unique_ptr",
        "make_shared",
        "make_unique",
        "weak_ptr",
        "SharedPtr",
        "intrusive_ptr",
        "allocate_shared",
    ]
)
_SEQUENCES = frozenset(["vector", "array", "deque", "list", "BoundedVector"])
_SAME = frozenset(["get", "operator", "value", "lock"])
_ELEMENT = frozenset(["front", "back", "at"])
_POINTED = re.compile(r"(?:Const|Shared|Unique|Weak)*Ptr")
_QUALIFIED_BACK = re.compile(r"((?:[A-Za-z_]\w*\s*::\s*)+)\Z")
_WRAPPER_BACK = re.compile(r"(\w+)\s*<\s*(?:const\s+)?\Z")
_ASSIGNED_BACK = re.compile(r"(?<![\w.>])(\w+)\s*=\s*(?:(?:std|boost)\s*::\s*)?\Z")
_TAIL = re.compile(r"((?:\s*::\s*\w+)*)")
_DECLARED = re.compile(r"[\s&*]*(?:const\b[\s&*]*)?([A-Za-z_]\w*)\s*(?=[;=,){(\[:])(?!::)")
_USE = re.compile(r"(?:\.|->|::)\s*([A-Za-z_]\w*)(?!\w|\s*\(|\s*::)")
_NAME = re.compile(r"[A-Za-z_]\w*")


def mentions(text: str, scope: Scope) -> bool:
    """Whether a text has anything of the form of a use of a member that some version lacks."""
    return any(match.group(1) in scope.changing for match in _USE.finditer(text))


class CppUses:
    """Uses in one C++ file. texts: visible texts (comments and literals blank) of the file and, behind it, the
    package's headers that reach it. package: for aliases and handwritten members, the package's other texts."""

    def __init__(self, text: str, headers: Iterable[str], scope: Scope):
        self.text, self.headers, self.scope = text, tuple(headers), scope
        self._aliases: dict[str, tuple[Interface, str]] = {}
        self._collect_aliases()
        self._declared: dict[int, dict[str, list[tuple[int, Type]]]] = {}

    def found(self) -> Iterator[Found]:
        """Every use of a member that some version lacks."""
        for match in _USE.finditer(self.text):
            name = match.group(1)
            if name not in self.scope.changing:
                continue
            if self.text[match.start()] == ":":
                use = self._constant(name, match.start(), match.start(1))
                if use is not None:
                    yield use
                continue
            type_ = self._type_before(match.start(), match.start())
            section = self.scope.changes(type_, name) if type_ is not None else None
            if type_ is not None and section is not None:
                yield Found(type_.interface, section, name, match.start(1), True)

    def untold(self) -> Iterator[Found]:
        """Accesses to such members through something whose type does not show, of names that only one interface has."""
        telling: dict[str, tuple[Interface, str] | None] = {}
        for match in _USE.finditer(self.text):
            name = match.group(1)
            if "_" not in name or name not in self.scope.changing or self.text[match.start()] == ":":
                continue
            if self._type_before(match.start(), match.start()) is not None or self._told(match.start()):
                continue
            if name not in telling:
                telling[name] = self._only(name)
            meant = telling[name]
            if meant is not None:
                yield Found(*meant, name, match.start(1), False)

    def _only(self, name: str) -> tuple[Interface, str] | None:
        """The one interface and section that has a member; None when others do, or the package's files declare it."""
        meant = [(i, s) for i, d in self.scope.definitions.items() for s in d.sections if name in d.sections[s]]
        if len(meant) != 1 or any(declarations_of(name, text) for text in (self.text, *self.headers)):
            return None
        return meant[0]

    # -- types ---------------------------------------------------------------------------------------------------------

    def _collect_aliases(self) -> None:
        """`using Switch = pkg::srv::Switch;` and the like, in the file or its headers."""
        for text in (*self.headers, self.text):
            for name, meant in _aliases_of(text):
                parts = [part.strip() for part in meant.split("::")]
                for at in range(len(parts)):
                    told = self._interface(parts[: at + 1])
                    section = section_of(told, parts[at + 1 :]) if told is not None else None
                    if told is not None and section is not None and name not in self.scope.by_name:
                        self._aliases[name] = (told[0], section)
                        break

    def _interface(self, parts: list[str]) -> tuple[Interface, str] | None:
        """The interface that qualified words name; only one may be meant."""
        *outer, name = parts
        outer = [part for part in outer if part]
        if not outer and name in self._aliases:
            return self._aliases[name]
        meant = self.scope.by_name.get(name, [])
        if outer:
            kind = outer[-1] if outer[-1] in ("msg", "srv", "action") else ""
            package = outer[-2] if kind and len(outer) > 1 else ("" if kind else outer[-1])
            meant = [
                (i, s) for i, s in meant
                if (not package or i.package == package) and (not kind or i.name.startswith(kind))
            ]  # fmt: skip
        return meant[0] if len(meant) == 1 else None

    def _spelt(self, text: str, match: re.Match[str]) -> tuple[Type, int, int] | None:
        """The type whose name was matched, where it starts and where its scopes end."""
        start = match.start()
        ahead = text[max(0, start - FAR) : start]
        qualified = _QUALIFIED_BACK.search(ahead)
        if qualified:
            start -= len(qualified.group(1))
        elif text[start - 1 : start] in (".", ">"):
            return None
        name = self._names_type(match.group())
        if name is None:
            return None
        outer = [part.strip() for part in qualified.group(1).split("::")] if qualified else []
        told = self._interface([*outer, name])
        suffix = _TAIL.match(text, match.end())
        words = [w.strip() for w in suffix.group(1).split("::") if w.strip()] if suffix else []
        if told is None:
            return None
        section = section_of(told, [w for w in words if not _POINTED.fullmatch(w)])
        return None if section is None else (Type(told[0], section), start, suffix.end() if suffix else match.end())

    def _names_type(self, word: str) -> str | None:
        """The interface's or alias's name in a word that may end with ROS 1's `Ptr` and `ConstPtr`."""
        for name in (word, word.removesuffix("Ptr"), word.removesuffix("ConstPtr")):
            if name in self.scope.by_name or name in self._aliases:
                return name
        return None

    def _declarations(self, which: int) -> dict[str, list[tuple[int, Type]]]:
        """Variables of interfaces' types in the file (0) or one of its headers, by name: offsets and types."""
        known = self._declared.get(which)
        text = (self.text, *self.headers)[which]
        # Many files of a package share its headers.
        shared = (text, tuple(self._aliases.items())) if which else None
        if known is None and shared in self.scope.declared:
            known = self._declared[which] = self.scope.declared[shared]
        if known is None:
            known = self._declared[which] = {}
            if shared is not None:
                self.scope.declared[shared] = known
            for match in _NAME.finditer(text):
                if self._names_type(match.group()) is None:
                    continue
                for name, offset, type_ in self._declared_by(text, match):
                    known.setdefault(name, []).append((offset, type_))
        return known

    def _declared_by(self, text: str, match: re.Match[str]) -> Iterator[tuple[str, int, Type]]:
        spelt = self._spelt(text, match)
        if spelt is None:
            return
        type_, start, end = spelt
        ahead = text[max(0, start - FAR) : start]
        if re.search(r"(?:using|typedef|namespace|class|struct|enum|new)\s+\Z", ahead):
            return
        wrapper = _WRAPPER_BACK.search(ahead)
        if wrapper:
            kind = wrapper.group(1)
            closing = re.compile(r"\s*(?:const\s*)?>").match(text, end)
            if closing is None or not (kind in _POINTERS or kind in _SEQUENCES):
                closing = re.compile(r"\s*(?:const\s*)?,\s*\d+\s*>").match(text, end) if kind == "array" else None
                if closing is None:
                    return
            type_ = type_._replace(several=kind in _SEQUENCES)
            end = closing.end()
            begins = start - len(ahead) + wrapper.start()
            outer = text[max(0, begins - FAR) : begins]
            before_name = re.sub(r"(?:\w+\s*::\s*)+\Z", "", outer)
            if before_name.rstrip().endswith("<"):
                return
            if kind.startswith(("make_", "allocate_")):
                assigned = _ASSIGNED_BACK.search(outer)
                if assigned:
                    yield assigned.group(1), begins, type_
                return
        else:
            assigned = _ASSIGNED_BACK.search(ahead)
            if assigned and text[end : end + 1] in ("(", "{"):
                yield assigned.group(1), start, type_
                return
        declared = _DECLARED.match(text, end)
        if declared and declared.group(1) not in NO_TYPES and declared.start(1) > end:
            after = text[declared.end() : declared.end() + 2]
            if after == "::":
                return
            if re.match(r"\[\s*\w*\s*\]", text[declared.end() :][:40]):
                type_ = type_._replace(several=True)
            yield declared.group(1), declared.start(1), type_
            # `X a, b;`
            at = declared.end()
            while not wrapper and text[at : at + 1] == "," and text.count("(", start, at) == text.count(")", start, at):
                more = re.compile(r",\s*([A-Za-z_]\w*)\s*(?=[,;])").match(text, at)
                if not more:
                    break
                yield more.group(1), more.start(1), type_
                at = more.end()

    def _variable(self, name: str, offset: int, depth: int) -> Type | None:
        """The type of a variable where it is used."""
        here = [(at, type_) for at, type_ in self._declarations(0).get(name, ()) if at < offset]
        others = [at for at, *_ in declarations_of(name, self.text) if at < offset and in_scope(self.text, at, offset)]
        here = [(at, type_) for at, type_ in here if in_scope(self.text, at, offset)]
        if here:
            at, type_ = here[-1]
            latest = max(others, default=-1)
            # A later declaration that is not this one hides it.
            if latest > at + len(name):
                return self._inferred(name, latest, depth)
            return type_
        if others:
            return self._inferred(name, max(others), depth)
        types = set()
        for which, header in enumerate(self.headers, 1):
            written = len(declarations_of(name, header)) if name in header else 0
            known = [type_ for _, type_ in self._declarations(which).get(name, ())] if written else []
            if written > len(known):
                return None
            types.update(known)
        if len(types) != 1:
            return None
        return next(iter(types))

    def _inferred(self, name: str, end: int, depth: int) -> Type | None:
        """The type of `auto & x = a.b;` and `for (auto & x : a.b)`, from where its name ends."""
        if depth > 4 or not re.search(rf"\bauto\b(?:\s*const)?[\s&*]*{re.escape(name)}\s*\Z", self.text[:end][-FAR:]):
            return None
        match = re.compile(r"\s*([=:])\s*(\*?\s*[\w.\->\[\]]+(?:\(\))?)\s*([;)])").match(self.text, end)
        if not match:
            return None
        if (match.group(1) == ":") != (match.group(3) == ")"):
            return None
        type_ = self._type_before(match.end(2), end, depth + 1)
        if type_ is None:
            return None
        if match.group(1) == ":":
            return type_._replace(several=False) if type_.several else None
        return type_

    def _type_before(self, end: int, used: int, depth: int = 0) -> Type | None:
        """The type of the expression that ends at an offset."""
        steps = self._steps_before(end)
        if steps is None:
            return None
        type_ = self._variable(steps[0], used, depth)
        for step in steps[1:]:
            if type_ is None:
                return None
            if step == "[]" or (step.endswith("()") and step[:-2] in _ELEMENT):
                type_ = type_._replace(several=False) if type_.several else None
            elif step.endswith("()"):
                type_ = type_ if step[:-2] in _SAME and not type_.several else None
            else:
                type_ = self.scope.step(type_, step)
        return type_

    def _told(self, end: int) -> bool:
        """Whether an expression's root has a declared type of its own that is no interface's."""
        steps = self._steps_before(end)
        if steps is None or len(steps) > 1:
            return False
        return any(not re.search(r"\bauto\b", type_) for _, type_, _ in declarations_of(steps[0], self.text))

    def _steps_before(self, end: int) -> list[str] | None:
        """`a->b[0].at(1)` before an offset as `a`, `b`, `[]`, `at()`; None for what no variable begins."""
        steps = chain_before(self.text, end)
        if steps is None or steps[0].name.endswith(("()", "[]")) or "::" in steps[0].name:
            return None
        return [step.name for step in steps]

    def _constant(self, member: str, end: int, offset: int) -> Found | None:
        """`pkg::msg::Type::CONSTANT`, also through an alias or a part (`Type::Request::CONSTANT`)."""
        match = re.search(r"((?:[A-Za-z_]\w*\s*::\s*)*[A-Za-z_]\w*)\s*\Z", self.text[max(0, end - FAR) : end])
        if match is None:
            return None
        parts = [part.strip() for part in match.group(1).split("::")]
        for at in (len(parts) - 1, len(parts) - 2):
            if at < 0:
                continue
            told = self._interface(parts[: at + 1])
            section = section_of(told, parts[at + 1 :]) if told is not None else None
            if told is None or section is None:
                continue
            if self.scope.changes(Type(told[0], section), member) is not None:
                return Found(told[0], section, member, offset, True)
        return None


@lru_cache(maxsize=1024)
def _aliases_of(text: str) -> tuple[tuple[str, str], ...]:
    """Names that a text gives to others, with those."""
    return tuple(
        (match.group(1), match.group(2).strip()) if match.group(1) else (words[1], words[0].strip())
        for match in _ALIAS.finditer(text)
        if len(words := (match.group(3) or "- -").rsplit(None, 1)) == 2
    )


_ALIAS = re.compile(r"\busing\s+(\w+)\s*=([\w:\s]+);|\btypedef\s([\w:\s]+);")
