"""What the parameters of C++ templates stand for, as far as the code itself says it.

A class template's parameter is what derived classes, members, objects and aliases give for it; a function template's
what its callers write between angle brackets. What is left to deduction, or given elsewhere, is not known.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import NamedTuple

from ...facts.cpp.names import split_at_commas
from .code import FlowCode, Fn, get_tail, list_made
from .modules import CodeFile
from .types import Cls, parse_flow_type

_DEEPEST = 4


class TemplateArgument(NamedTuple):
    """A type that is given for a parameter. text: as written; source, scope: where. cls: key of the class that gives it
    by deriving, or that holds such an object, empty for none; fn: the function that does."""

    text: str
    source: CodeFile
    scope: str
    cls: str = ""
    fn: Fn | None = None


class Templates:
    """Asks a body of code for the parameters of its templates."""

    def __init__(self, code: FlowCode):
        self.code = code

    def has(self, name: str, fn: Fn) -> bool:
        """Whether a name is, in a function, the parameter of a template around it."""
        return name.isidentifier() and self._find_parameter(name, fn) is not None

    def list_given(self, name: str, fn: Fn, depth: int = 0) -> Iterator[TemplateArgument]:
        """What is given for the parameter of a template that a name is in a function."""
        place = self._find_parameter(name, fn)
        if place is None or depth > _DEEPEST:
            return
        holder, number = place
        found = self._read_callers(holder, number) if isinstance(holder, Fn) else self._read_class(holder, number)
        for one, around in found:
            inner = parse_flow_type(one.text).name
            if around is not None and self.has(inner, around):
                yield from self.list_given(inner, around, depth + 1)
            elif around is None and (cls := self._find_class(one)) is not None and inner in cls.facts.types:
                for outer, _ in self._read_class(cls, cls.facts.types.index(inner), depth + 1):
                    yield outer
            else:
                yield one

    def _find_parameter(self, name: str, fn: Fn) -> tuple[Cls | Fn, int] | None:
        """The template whose parameter a name is, and the number of the parameter."""
        for one in self.code.list_enclosing_chain(fn):
            owner = self.code.find_owner(one)
            types = owner.facts.types if owner is not None else ()
            if owner is not None and name in types:
                return owner, types.index(name)
            if name in one.facts.types:
                number = one.facts.types.index(name)
                # Written outside of its class, under other names.
                outside = owner is not None and len(one.facts.types) == len(types)
                return (owner, number) if outside and owner is not None else (one, number)
        return None

    def _read_callers(self, fn: Fn, number: int) -> Iterator[tuple[TemplateArgument, Fn | None]]:
        for caller, call in self.code.callers.get(fn, ()):
            types = split_at_commas(call.types) if call.types else []
            if number < len(types):
                yield TemplateArgument(types[number], caller.source, caller.scope, "", caller), caller

    def _read_class(self, cls: Cls, number: int, depth: int = 0) -> Iterator[tuple[TemplateArgument, Fn | None]]:
        for arguments, given, around in self._instances.get(get_tail(cls.name), ()) if depth <= _DEEPEST else ():
            if number < len(arguments) and self.code.find_class(given.text, given.source, given.scope) is cls:
                yield given._replace(text=arguments[number]), around

    def _find_class(self, given: TemplateArgument) -> Cls | None:
        return next(iter(self.code.list_class_bodies(given.cls)), None)

    @cached_property
    def _instances(self) -> dict[str, list[tuple[tuple[str, ...], TemplateArgument, Fn | None]]]:
        """Uses of class templates by the last part of their name: arguments, the name with who uses it, and the
        function it stands in."""
        found: dict[str, list[tuple[tuple[str, ...], TemplateArgument, Fn | None]]] = {}
        templates = {get_tail(c.name) for classes in self.code.classes.values() for c in classes if c.facts.types}
        if not templates:
            return found

        def note(text: str, source: CodeFile, scope: str, owner: str = "", fn: Fn | None = None) -> None:
            if "<" in text:
                kind = parse_flow_type(text)
                if kind.arguments and get_tail(kind.name) in templates:
                    cls = self.code.find_class(owner, source, fn.scope if fn is not None else "") if owner else None
                    given = TemplateArgument(kind.name, source, scope, cls.key if cls is not None else "", fn)
                    found.setdefault(get_tail(kind.name), []).append((kind.arguments, given, fn))

        for source in self.code.sources:
            if source.facts.language != "cpp":
                continue
            for cls in source.facts.classes:
                for base in cls.bases:
                    note(base, source, cls.name, cls.name)
                for member in cls.members:
                    note(member.type, source, cls.name, cls.name)
            for alias in source.facts.aliases:
                note(alias.target, source, alias.scope)
        for fn in self.code.functions:
            if fn.source.facts.language == "cpp":
                for name, _, _ in list_made(fn, self.code):
                    note(name, fn.source, fn.scope, fn.facts.owner, fn)
                for each in fn.facts.assignments:
                    note(each.type, fn.source, fn.scope, fn.facts.owner, fn)
        return found
