"""Classes whose bases are classes of the workspace too: methods that override none of theirs, and pure virtual ones
that a class of which objects are made leaves out.

An answer rests on classes that are known as a whole: of one definition, without macros; templates with the arguments
that they are given. Where such a base is derived from a class of another package in turn, the target has a say.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Iterator
from typing import NamedTuple

from ....edges.memory import cache_method
from ...facts.cpp.schema import CodePlace, CodeSpot, CppClass, Declaration
from ...targets.surface.overrides import differs_plainly
from .resolver import KnownFile, Resolver, parse_type, substitute_class
from .uses import normalise_parameter

# A base of the standard library that has nothing virtual.
_WITHOUT_METHODS = re.compile(r"std::enable_shared_from_this\b")
_ACCESS = frozenset(("public", "protected", "private", "virtual"))
_INTEGER = frozenset(("unsigned", "signed", "short", "long", "int"))
_SIZED = re.compile(r"(?:std::)?(?:u?int(?:8|16|32|64)_t|s?size_t|ptrdiff_t)")
_SORTS = frozenset(("void", "bool", "char", "float", "double", "std::string"))
_DEEPEST = 16


class ClassFile(NamedTuple):
    """A file with its path."""

    path: str
    known: KnownFile


class LostOverride(NamedTuple):
    """A method that is to override one and does not.

    kind: `absent` (no base has a method of its name), `plain` (none of them is virtual), `types` (they have other
    parameters), or `result`. base: the class that has the method, else the first base. declared: the method of the
    base, as far as it is known. outer: the classes of other packages among the bases, which must have no method of its
    name."""

    kind: str
    base: str
    method: str
    spot: CodeSpot
    class_: str
    declared: str
    outer: tuple[str, ...] = ()


class Lineage(NamedTuple):
    """The bases of a class, and theirs. own: of the workspace; outer: of other packages, as they are written."""

    own: tuple[CppClass, ...]
    outer: tuple[str, ...]


class LeftOut(NamedTuple):
    """A pure virtual method that a class does not have. path, spot: of the class."""

    base: str
    method: str
    path: str
    spot: CodeSpot
    class_: str
    declared: str


class OwnClasses:
    """The classes of a file and of the headers of the workspace that it reaches. files: these, the file itself first.
    count: how many definitions of a class the package has."""

    def __init__(self, files: Iterable[ClassFile], resolver: Resolver, count: Callable[[str], int]):
        self.files, self.resolver, self.count = tuple(files), resolver, count

    def list_lost_overrides(self, class_: CppClass) -> Iterator[LostOverride]:
        """Methods of a class that say `override` and surely override nothing."""
        marked = [one for same in class_.members.values() for one in same if _is_marked(one)]
        bases = self.list_bases(class_) if marked and not class_.template else None
        for method in marked if bases is not None and bases.own else ():
            found = self._judge(method, class_, bases.own) if bases is not None else None
            if found is not None and bases is not None:
                yield found._replace(outer=bases.outer)

    def _judge(self, method: Declaration, class_: CppClass, bases: Collection[CppClass]) -> LostOverride | None:
        assert method.at is not None
        same = [(base, one) for base in bases for one in base.members.get(method.name, ())]
        if any(one.kind != "function" or not one.traits.isdisjoint(("template", "split")) for _, one in same):
            return None
        if not same:
            if not all(map(_is_closed, bases)):
                return None
            return LostOverride("absent", next(iter(bases)).name, method.name, method.at, class_.name, "")
        virtual = [(base, one) for base, one in same if not one.traits.isdisjoint(_VIRTUAL)]
        base, first = (virtual or same)[0]
        shown = _spell(base, first)
        if not virtual:
            return LostOverride("plain", base.name, method.name, method.at, class_.name, shown)
        if all(self._differs(method, class_, one, other) for other, one in same):
            return LostOverride("types", base.name, method.name, method.at, class_.name, shown)
        equal = [one for _, one in same if _make_shape(one) == _make_shape(method)]
        if len(same) == 1 and equal and self._gives_other(method, class_, first, base):
            return LostOverride("result", base.name, method.name, method.at, class_.name, shown)
        return None

    def list_left_out(self, class_: CppClass, path: str) -> Iterator[LeftOut]:
        """The pure virtual methods that a class and its bases surely do not implement."""
        lineage = self.list_bases(class_) if not class_.template else None
        bases = lineage.own if lineage is not None else ()
        if not bases or not all(map(_is_closed, (class_, *bases))):
            return
        for base in bases:
            for one in (one for same in base.members.values() for one in same):
                pure = "pure" in one.traits and one.at is not None and one.at.conditions == ()
                if not pure or one.name.startswith("~") or not one.traits.isdisjoint(("split", "template")):
                    continue
                others = [
                    (other, each)
                    for other in (class_, *bases)
                    for each in other.members.get(one.name, ())
                    if "pure" not in each.traits
                ]
                if all(each.kind == "function" and self._differs(each, other, one, base) for other, each in others):
                    yield LeftOut(base.name, one.name, path, class_.at, class_.name, _spell(base, one))

    def list_made(self, lasts: Collection[str], exports: Iterable[str]) -> Iterator[tuple[str, CodeSpot | None]]:
        """The classes of which the file makes objects, with where; those of plugins without. lasts: last parts of the
        classes that are asked about. exports: what it gives to the macros of plugins."""
        known = self.files[0].known
        for name in exports:
            own = self.find_class(name, "") if name.rpartition("::")[2] in lasts else None
            if own is not None:
                yield own[1].name, None
        words = [word for word in sorted(lasts) if known.mentions(word)]
        for use in known.list_uses(known.list_mentions(words)):
            own = self.find_class(use.name, use.place.scope) if use.made and use.last and use.local is None else None
            if own is not None:
                yield own[1].name, use.at
        for class_ in known.declarations.classes:
            if class_.template or class_.specialised:
                continue
            for one in (one for same in class_.members.values() for one in same):
                last = one.type.rpartition("::")[2]
                if one.kind == "variable" and last in lasts and one.traits.isdisjoint(("static", "template")):
                    own = self.find_class(one.type, class_.name)
                    if own is not None and own[1].name != class_.name:
                        yield own[1].name, class_.at

    def find_class(self, written: str, scope: str) -> tuple[str, CppClass] | None:
        """The class of the workspace that a name in a namespace or class is, with the path of its file; None where it
        is none, or has several definitions."""
        name, last = written.removeprefix("::"), written.rpartition("::")[2]
        known = [(file.path, one) for file in self.files for one in file.known.list_classes(last)]
        place = CodePlace("" if written.startswith("::") else scope, "", False)
        for full in self.resolver.list_meanings(name, place) if known else ():
            found = [(path, one) for path, one in known if one.name == full]
            if found:
                return found[0] if len(found) == 1 and self.count(full) < 2 else None
        return None

    @cache_method
    def _list_words(self, name: str) -> tuple[frozenset[str], ...]:
        """The words behind the names of the classes that end so, as the text has them."""
        pairs = (pair for file in self.files for pair in file.known.facts.parents)
        return tuple(frozenset(words.split()) - _ACCESS for last, words in pairs if last == name)

    def list_bases(self, class_: CppClass) -> Lineage | None:
        """All bases of a class; None where one is not known. What those of other packages are derived from is left out,
        which is nothing of the workspace."""
        found: dict[str, CppClass] = {}
        outer: dict[str, None] = {}
        # Each as it is written, and with the arguments of a template.
        waiting = [(class_, class_)]
        while waiting:
            at, filled = waiting.pop(0)
            # Where a directive stands between the bases, what was parsed is one of several possibilities.
            words = frozenset(re.findall(r"[A-Za-z_]\w*", " ".join(at.bases)))
            if at.bases and (len(found) > _DEEPEST or self._list_words(at.name.rpartition("::")[2]) != (words,)):
                return None
            for base in filled.bases:
                if _WITHOUT_METHODS.match(base):
                    continue
                parts = parse_type(base)
                own = self.find_class(parts.outer, at.name.rpartition("::")[0]) if not parts.tail else None
                if own is None:
                    name = base.partition("<")[0].rpartition("::")[2]
                    if any(file.known.declares_type(name) for file in self.files):
                        return None
                    outer[self.resolver.spell_out(base, at)] = None
                elif own[1].specialised or bool(own[1].template) != bool(parts.arguments):
                    return None
                elif own[1].name not in found and own[1].name != class_.name:
                    arguments = tuple(self._spell_argument(one, at) for one in parts.arguments or ())
                    found[own[1].name] = substitute_class(own[1], arguments) if arguments else own[1]
                    waiting.append((own[1], found[own[1].name]))
        return Lineage(tuple(found.values()), tuple(outer))

    def _spell_argument(self, argument: str, class_: CppClass) -> str:
        """An argument of a template as it is understood wherever it stands; one that only says that it is a type where
        that cannot be known."""
        spelt = self.resolver.spell_out(argument, class_)
        bare = spelt.strip()
        if bare in _SORTS or _INTEGER.issuperset(bare.split()) or "::" in bare:
            return bare
        own = self.find_class(bare, class_.name.rpartition("::")[0])
        return f"::{own[1].name}" if own is not None else f"typename {bare}"

    def _differs(self, method: Declaration, class_: CppClass, other: Declaration, base: CppClass) -> bool:
        """Whether two methods surely do not have the same parameters."""
        if not {*method.traits, *other.traits}.isdisjoint(("split", "template")):
            return False
        if ("const" in method.traits) != ("const" in other.traits) or len(method.parameters) != len(other.parameters):
            return True
        return any(
            self._differ(one.type, class_, another.type, base)
            for one, another in zip(method.parameters, other.parameters, strict=True)
        )

    def _gives_other(self, method: Declaration, class_: CppClass, other: Declaration, base: CppClass) -> bool:
        """Whether two methods surely give back other things: a class of the package may be derived from another."""
        sorts = [self._sort(one.type, within) for one, within in ((method, class_), (other, base))]
        return all(sort[0] in (*_SORTS, "integer") for sort in sorts) and sorts[0] != sorts[1]

    def _differ(self, one: str, class_: CppClass, other: str, base: CppClass) -> bool:
        """Whether a type in a class is surely another one than a type in its base."""
        first, second = self._sort(one, class_), self._sort(other, base)
        if first[0] and second[0]:
            return first != second
        spelt = (self.resolver.spell_out(type_, at) for type_, at in ((one, class_), (other, base)))
        return differs_plainly(*map(normalise_parameter, spelt))

    def _sort(self, type_: str, class_: CppClass) -> tuple[str, str]:
        """What a type surely is, and how it is handed over; empty where its name may stand for anything."""
        spelt = normalise_parameter(self.resolver.spell_out(type_, class_))
        words = spelt.rstrip("*& ").split()
        marks = spelt[len(spelt.rstrip("*& ")) :].replace(" ", "")
        constant = "const" in words
        bare = " ".join(word for word in words if word != "const")
        if re.search(r"[<(\[*&]", bare):
            return "", ""
        how = f"const{marks}" if constant and marks else marks
        if bare in _SORTS:
            return bare, how
        if _INTEGER.issuperset(bare.split()) or _SIZED.fullmatch(bare):
            return "integer", how
        own = self.find_class(bare, class_.name)
        return (own[1].name, how) if own is not None and not own[1].template else ("", "")


_VIRTUAL = frozenset(("virtual", "pure", "override", "final"))


def _is_marked(one: Declaration) -> bool:
    """Whether it is a method that has to override another one."""
    plain = one.traits.isdisjoint(("static", "split", "template", "deleted"))
    marked = not one.traits.isdisjoint(("override", "final"))
    return one.kind == "function" and plain and marked and one.at is not None and one.name.isidentifier()


def _is_closed(class_: CppClass) -> bool:
    """Whether a class has no other members than those that are known: it has no macro that may declare some."""
    last = class_.name.rpartition("::")[2]
    return not class_.open and not any(
        one.kind == "function" and not one.type and name != last and not name.startswith(("~", "operator"))
        for name, same in class_.members.items()
        for one in same
    )


def _make_shape(one: Declaration) -> tuple:
    return tuple(normalise_parameter(each) for each in one.parameters), "const" in one.traits


def _spell(class_: CppClass, one: Declaration) -> str:
    """A method as its class declares it."""
    types = ", ".join(normalise_parameter(each) for each in one.parameters)
    marks = (" const" if "const" in one.traits else "") + (" = 0" if "pure" in one.traits else "")
    virtual = "virtual " if "virtual" in one.traits else ""
    return f"{virtual}{one.type} {class_.name}::{one.name}({types}){marks}"
