"""Whose methods a C++ file calls, as far as it tells that they are not those of a class that is asked about."""

from collections.abc import Collection

from ...facts.cpp.schema import CppUse, Expr
from .resolver import CppType, Resolver, parse_type

_POINTERS = frozenset(("shared_ptr", "unique_ptr", "weak_ptr"))
_POINTED = frozenset(("Ptr", "ConstPtr", "SharedPtr", "UniquePtr", "WeakPtr", "ConstSharedPtr"))


class Receivers:
    """The objects of one file. near: the package, those that it declares, and those of the workspace, which may derive
    classes from the one that is asked about."""

    def __init__(self, resolver: Resolver, near: Collection[str]):
        assert resolver.vocabulary is not None
        self._resolver, self._vocabulary, self._near = resolver, resolver.vocabulary, near

    def list_strange_calls(self, words: Collection[str], of_libraries: Collection[str]) -> set[tuple[int, int]]:
        """Line and column of calls of methods with some names, of objects whose class defines the method itself and has
        no base of another package, or lies in a namespace that no package near has. of_libraries: the names that
        classes of system libraries have, in whose namespaces no package of ROS lies."""
        known = self._resolver.known
        mentions = (one for one in known.list_mentions(sorted(words)) if one.form == "member")
        uses = known.list_uses(mentions)
        return {(use.at.line, use.at.column) for use in uses if self._is_strange(use, use.word in of_libraries)}

    def _is_strange(self, use: CppUse, of_library: bool) -> bool:
        if use.object is None or use.object.kind == "this":
            return False
        type_ = self._resolver.resolve_value(use.object, use.place)
        if type_ is None:
            return not of_library and self._lies_far(use.object, use)
        reached = type_.reach(use.arrow)
        return reached is not None and reached.own and reached.plain and self._is_own_method(reached, use.word)

    def _is_own_method(self, type_: CppType, word: str) -> bool:
        line = self._resolver.list_own_lineage(type_.name)
        bases = (base for one in line for _, base in self._resolver.list_bases(one))
        return any(word in one.members for one in line) and all(base is not None and base.own for base in bases)

    def _lies_far(self, name: Expr, use: CppUse) -> bool:
        """Whether an object is declared with a class of a namespace that no package near has."""
        parts = parse_type(self._resolver.find_written_type(name, use.place) if name.kind == "name" else "")
        if parts.arguments and parts.outer.rpartition("::")[2] in _POINTERS:
            parts = parse_type(parts.arguments[0])
        scopes = parts.outer.removeprefix("::").split("::")
        if len(scopes) > 1 and scopes[-1] in _POINTED:
            scopes.pop()
        if len(scopes) < 2 or not scopes[0].islower() or scopes[0] == "std":
            return False
        meant = {full.partition("::")[0] for full in self._resolver.list_meanings(scopes[0], use.place)}
        return not (self._is_near(scopes[0]) or any(map(self._vocabulary.has_space, meant)))

    def _is_near(self, head: str) -> bool:
        return any(one == head or one.startswith(f"{head}_") for one in self._near)
