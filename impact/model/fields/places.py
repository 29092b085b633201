"""Where variables are used in the code of a workspace: the field facts, by the variable that they are about."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import lru_cache
from typing import NamedTuple

from ....edges.groups import group_pairs
from ...facts.field_uses import FieldFile, FieldFunction, PathUse
from ...facts.flow import FlowFunction
from ..flow.code import FlowCode, Fn, Variable, get_tail


class UsePlace(NamedTuple):
    """A use in a function. at: which part of its path is meant."""

    fn: Fn
    use: PathUse
    at: int


@lru_cache(maxsize=100_000)
def split_path(path: str) -> tuple[str, ...]:
    """The parts of a use's path."""
    return tuple(path.split("."))


def _find_line(fn: Fn) -> int:
    """Where a function begins; 0 for what stands outside of functions."""
    return fn.facts.line if fn.facts.name else 0


def _match(facts: FieldFunction, found: Sequence[Fn]) -> Fn | None:
    """The function whose uses some facts are, of those that begin on its line: most often there is one."""
    is_lambda = facts.name.startswith("lambda@")
    same = [fn for fn in found if fn.is_lambda == is_lambda]
    named = [fn for fn in same if fn.name.endswith(facts.name) and get_tail(fn.name) == facts.name]
    return next(iter(named or (() if is_lambda else same)), None)


class Uses:
    """All uses of a body of code. files: field facts by path, for all files of the code that could be read."""

    def __init__(self, code: FlowCode, files: Mapping[str, FieldFile]):
        self.code, self.files = code, files
        self._by_name: dict[str, dict[str, list[UsePlace]]] = {}
        # Variables that hold messages: what is behind them are fields, no members of classes.
        self.messages: set[Variable] = set()
        for source in code.sources:
            file = files.get(source.path)
            if file is None:
                continue
            known = group_pairs((_find_line(fn), fn) for fn in self.code.functions_in.get(source.path, ()))
            for facts in file.functions:
                fn = _match(facts, known.get(facts.line, ())) or Fn(source, FlowFunction("", "", (), 0, 0))
                self._add(fn, facts)

    def _add(self, fn: Fn, facts: FieldFunction) -> None:
        path = fn.source.path
        for use in facts.uses:
            for at, part in enumerate(split_path(use.path)):
                if part not in ("[]", "this"):
                    self._by_name.setdefault(part, {}).setdefault(path, []).append(UsePlace(fn, use, at))

    def list_named(self, name: str, paths: Collection[str] = ()) -> Iterator[UsePlace]:
        """The uses whose path has a part of a name; paths: in these files alone, in all where there are none."""
        known = self._by_name.get(name, {})
        for path in paths or known:
            yield from known.get(path, ())

    def list_uses(self, variable: Variable) -> Iterator[UsePlace]:
        """The uses of a variable, and those that may be of it."""
        own = [variable.owner.split(":", 1)[0]] if variable.kind == "local" else []
        language = self._find_language(variable)
        for place in self.list_named(variable.name, own):
            if language in ("", place.fn.source.facts.language) and self._is_of(place, variable):
                yield place

    def _find_language(self, variable: Variable) -> str:
        """The language of the code that a variable is of, which no other has; empty where that is not known."""
        if variable.kind == "member":
            found = {cls.source.facts.language for cls in self.code.list_class_bodies(variable.owner)}
        else:
            file = self.files.get(variable.owner.split(":", 1)[0])
            found = {file.language} if file is not None else set()
        return found.pop() if len(found) == 1 else ""

    def _is_of(self, place: UsePlace, variable: Variable) -> bool:
        parts = split_path(place.use.path)
        is_head = place.at == 0 or (place.at == 1 and parts[0] == "this")
        if is_head:
            found, _ = self.code.resolve_variable(".".join(parts[: place.at + 1]), place.fn)
            if found == variable:
                return True
            # A name that the code does not declare, outside of what was matched.
            return variable.kind != "local" and not place.fn.facts.end and found.kind != "local"
        if variable.kind == "local":
            return False
        return self._may_be_member(place, parts, variable)

    def _may_be_member(self, place: UsePlace, parts: tuple[str, ...], variable: Variable) -> bool:
        """Whether a part of a path behind its head may be a member, or a variable of another module."""
        head = parts[:2] if parts[0] == "this" else parts[:1]
        if parts[0].endswith("()"):
            return True
        found, _ = self.code.resolve_variable(".".join(head), place.fn)
        if found in self.messages:
            return False
        is_direct = place.at == 1 and variable.kind == "member" and found.kind == "global"
        if is_direct and self._is_module(parts[0], place.fn):
            return False
        before = ".".join(part for part in parts[: place.at] if part != "[]")
        kind = self.code.resolve_name_type(before, place.fn)
        if variable.kind == "global":
            return place.fn.source.facts.language == "python" and not kind.name
        cls = self.code.find_class_of(kind, place.fn) if kind.name else None
        if cls is None:
            return not kind.name
        return self.code.identify(f"{before}.{variable.name}", place.fn) == variable

    def _is_module(self, name: str, fn: Fn) -> bool:
        """Whether a name is that of a module of Python: `import os`, `import numpy as np`. No member of one is that of
        an object."""
        facts = fn.source.facts
        return facts.language == "python" and any(
            alias.name == name and alias.target and "." not in alias.target for alias in facts.aliases
        )

    def is_unread(self, path: str, first: int, last: int) -> bool:
        """Whether some of the lines of a file did not parse."""
        file = self.files.get(path)
        return file is None or any(start <= last and first <= end for start, end in file.unread)

    def is_in_macro(self, name: str, path: str) -> bool:
        """Whether the macros of a file read members of a variable of that name."""
        file = self.files.get(path)
        return file is not None and name in file.macros

    def list_results(self, fn: Fn) -> Iterator[UsePlace]:
        """What is done with what a function gives back, by its name alone."""
        tail = get_tail(fn.name)
        yield from self.list_named(f"{tail}()")
        if fn.source.facts.language == "python" and fn.facts.owner:
            # A property is named and not called.
            yield from (place for place in self.list_named(tail) if place.at)
