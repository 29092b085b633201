"""Fields and constants of other packages' interfaces that a Python file uses, told by what its variables are bound to.

A variable's type is read from the constructor or annotation that binds it, and from the subscription or service whose
callback takes it.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator
from functools import cached_property

from ..members import FAR, Found, Interface, Scope, Type, any_of, section_of

_IMPORTED = re.compile(r"^[ \t]*from[ \t]+(\w+)\.(msg|srv|action)[ \t]+import[ \t]*(\([^)]*\)|[^\n]*)", re.MULTILINE)
_AS = re.compile(r"(\w+)(?:\s+as\s+(\w+))?")
_HEAD = re.compile(r"^([ \t]*)(async[ \t]+def|def|class)\b", re.MULTILINE)
_ACCESS = re.compile(r"\.(\w+)(?!\w|\s*\()")
_KEYWORD = re.compile(r"(?<![\w.])(\w+)\s*=(?!=)")
_PYTHON_NAME = r"(?<![\w.])(?:self\.)?[A-Za-z_]\w*"


class PythonUses:
    """Uses in one Python file. text: with comments and literals blank."""

    def __init__(self, text: str, scope: Scope):
        self.text, self.scope = text, scope
        self._names = self._imported()
        self._bound_at: dict[str, list[int]] = {}

    @cached_property
    def _variables(self) -> dict[str, list[tuple[int, int, Type]]]:
        """Variables by name: where they are bound, how far that reaches, and the type."""
        return self._bound()

    def found(self) -> Iterator[Found]:
        """Every use of a member that some version lacks, in constructors and on variables whose type shows."""
        if not self._names:
            return
        changing = self.scope.changing
        for match in _ACCESS.finditer(self.text):
            name = match.group(1)
            if name not in changing:
                continue
            type_ = self._type_before(match.start(), match.start())
            section = self.scope.changes(type_, name) if type_ is not None else None
            if type_ is not None and section is not None:
                yield Found(type_.interface, section, name, match.start(1), True)
        if not any(match.group(1) in changing for match in _KEYWORD.finditer(self.text)):
            return
        for match in self._constructions():
            type_ = self._class(match.group(1))
            if type_ is None:
                continue
            for name, offset in _keywords(self.text, match.end() - 1):
                section = self.scope.changes(type_, name)
                if section is not None:
                    yield Found(type_.interface, section, name, offset, True)

    def _imported(self) -> dict[str, tuple[Interface, str]]:
        found = {}
        for match in _IMPORTED.finditer(self.text):
            for name, alias in _AS.findall(match.group(3)):
                meant = [
                    told for told in self.scope.by_name.get(name, ())
                    if told[0].package == match.group(1) and told[0].name.startswith(match.group(2) + "/")
                ]  # fmt: skip
                # Both generations spell a bare interface alike: the rule asks for the one that holds.
                if meant:
                    found[alias or name] = meant[0]
        return found

    def _constructions(self) -> Iterator[re.Match[str]]:
        return re.finditer(rf"(?<![\w.])((?:{any_of(self._names)})(?:\.\w+)?)\s*\(", self.text)

    def _class(self, text: str) -> Type | None:
        """The type that `Name` or `Name.Request` constructs."""
        name, *rest = text.strip().split(".")
        told = self._names.get(name)
        section = section_of(told, rest) if told is not None else None
        return Type(told[0], section) if told is not None and section is not None else None

    def _bound(self) -> dict[str, list[tuple[int, int, Type]]]:
        found: dict[str, list[tuple[int, int, Type]]] = {}
        if not self._names:
            return found
        names = rf"((?:{any_of(self._names)})(?:\.\w+)?)"

        def bind(name: str, at: int, written: str, end: int) -> None:
            type_ = self._class(written)
            if type_ is not None:
                found.setdefault(name, []).append((at, end, type_))

        for match in re.finditer(rf"({_PYTHON_NAME})\s*(?::[^=\n]+)?=\s*{names}\s*\(", self.text):
            end = len(self.text) if match.group(1).startswith("self.") else self._end_of_block(match.start())
            bind(match.group(1), match.start(), match.group(2), end)
        for match in re.finditer(rf"(?<![\w.])(\w+)\s*:\s*{names}\s*(?=[,)=])", self.text):
            bind(match.group(1), match.start(), match.group(2), self._end_of_block(match.start()))
        callbacks = re.compile(
            rf"\b(?:create_subscription|create_service|Subscriber|Service)\s*\((?:[^()]*?,)??\s*(?:\w+\s*=\s*)?{names}\s*,"
            r"((?:[^()]|\([^()]*\))*)\)"
        )
        for match in callbacks.finditer(self.text):
            told = self._names[match.group(1).split(".")[0]]
            for name in set(re.findall(r"(?<![\w.])(?:self\.)?([A-Za-z_]\w*)", match.group(2))):
                for definition in re.finditer(
                    rf"^[ \t]*(?:async[ \t]+)?def[ \t]+{name}[ \t]*\(\s*(?:self\s*,\s*)?(\w+)\s*(?:,\s*(\w+)\s*)?\)",
                    self.text, re.MULTILINE,
                ):  # fmt: skip
                    end = self._end_of_block(definition.end())
                    if told[0].name.startswith("msg/"):
                        found.setdefault(definition.group(1), []).append((definition.start(), end, Type(*told)))
                    elif told[0].name.startswith("srv/"):
                        for name, part in zip(definition.groups(), ("request", "response"), strict=True):
                            if name:
                                found.setdefault(name, []).append((definition.start(), end, Type(told[0], part)))
        return found

    @cached_property
    def _heads(self) -> list[tuple[int, int, bool]]:
        """Offset and indentation of every `def` and `class`, and whether it is a function."""
        return [
            (match.start(), len(match.group(1)), match.group(2) != "class")
            for match in _HEAD.finditer(self.text)
        ]  # fmt: skip

    def _end_of_block(self, at: int) -> int:
        """Where the function ends in which an offset lies, or that is defined there."""
        line = self.text.find("\n", at) + 1 or len(self.text)
        place = bisect_right(self._heads, (line, -1, False)) - 1
        while place >= 0 and not self._heads[place][2]:
            place -= 1
        if place < 0:
            return len(self.text)
        return next(
            (start for start, indent, _ in self._heads[place + 1 :] if indent <= self._heads[place][1]), len(self.text)
        )

    def _type_before(self, end: int, used: int) -> Type | None:
        chain = re.search(
            r"(?<![\w.\])])((?:self\.)?[A-Za-z_]\w*)((?:\.\w+|\[[^\[\]\n]*\])*)\Z", self.text[max(0, end - FAR) : end]
        )
        if chain is None:
            return None
        type_ = self._variable(chain.group(1), used)
        for step in re.findall(r"\.(\w+)|(\[)", chain.group(2)):
            if type_ is None:
                break
            if step[1]:
                type_ = type_._replace(several=False) if type_.several else None
            else:
                type_ = self.scope.step(type_, step[0])
        if type_ is None and chain.group(1).split(".")[0] in self._names:
            return self._class(chain.group(1) + chain.group(2))
        return type_

    def _bindings(self, name: str) -> list[int]:
        """Where a name is bound to anything."""
        known = self._bound_at.get(name)
        if known is not None:
            return known
        plain = re.escape(name)
        known = self._bound_at[name] = [
            match.start()
            for match in re.finditer(
                rf"(?<![\w.]){plain}\s*(?::[^=\n(),]+)?(?:,\s*\w+\s*)*=(?!=)|\bfor\s+(?:\w+\s*,\s*)*{plain}\b"
                rf"|\bas\s+{plain}\b|\b(?:def\s+\w+|lambda)\b[^\n]*?(?<=[(,\s]){plain}\b",
                self.text,
            )
        ]
        return known

    def _variable(self, name: str, used: int) -> Type | None:
        bound = [(at, type_) for at, end, type_ in self._variables.get(name, ()) if at < used < end]
        if name.startswith("self."):
            types = {type_ for _, _, type_ in self._variables.get(name, ())}
            return types.pop() if len(types) == 1 and len(self._bindings(name)) == len(self._variables[name]) else None
        if not bound:
            return None
        at, type_ = bound[-1]
        latest = max((b for b in self._bindings(name) if b < used), default=-1)
        line = self.text.count("\n", min(at, latest), max(at, latest)) if latest > at else 0
        return type_ if latest <= at or not line else None


def _keywords(text: str, opening: int) -> Iterator[tuple[str, int]]:
    """Names of the keyword arguments of the call whose bracket opens at an offset."""
    depth = 0
    for match in re.compile(r"[()\[\]{}]|(?<![\w.])(\w+)\s*=(?!=)").finditer(text, opening, opening + 4000):
        if match.group(1):
            if depth == 1:
                yield match.group(1), match.start(1)
        elif match.group() in "([{":
            depth += 1
        else:
            depth -= 1
            if depth == 0:
                return
