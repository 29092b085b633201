"""What names and expressions of a C++ file stand for: classes of the package, of other packages, or interfaces.

A file is seen with the headers of its package that it includes. What it says are its facts; what other packages
offer is told by a vocabulary (model.api) and a scope of interfaces (model.members). None is an answer: not known.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cached_property, lru_cache
from typing import Any, NamedTuple, TypeVar

from ....edges.groups import group_pairs
from ....edges.memory import cache_method
from ...facts.cpp.lexical import CppFile
from ...facts.cpp.names import find_closing_angle, join_scope, split_at_commas, strip_templates
from ...facts.cpp.schema import CodePlace, CppClass, CppUse, Declaration, Expr, FileDeclarations
from ...facts.cpp.syntax import Mention
from ...facts.usage import Rows
from ..api import Vocabulary
from ..members import InterfaceScope, NamedInterface, find_section
from ..members import MemberType as InterfaceType

T = TypeVar("T")

_POINTERS = frozenset(("shared_ptr", "unique_ptr", "weak_ptr", "intrusive_ptr", "optional", "unique_lock"))
_MAKERS = frozenset(("make_shared", "make_unique", "allocate_shared"))
_SEQUENCES = frozenset((
    "vector", "array", "deque", "list", "set", "unordered_set", "multiset", "queue", "stack", "initializer_list",
    "BoundedVector", "span",
))  # fmt: skip
_TUPLES = frozenset(("pair", "tuple", "variant"))
_MAPS = frozenset(("map", "unordered_map", "multimap", "unordered_multimap"))
_CASTS = frozenset(("static_cast", "dynamic_cast", "const_cast", "reinterpret_cast"))
_POINTER_CASTS = frozenset(("static_pointer_cast", "dynamic_pointer_cast", "const_pointer_cast"))
_THROUGH = frozenset(("move", "forward", "as_const", "ref", "cref"))
_POINTED = re.compile(r"(?:Const|Shared|Unique|Weak)*(?:Ptr|_ptr)")
_SUFFIX = re.compile(r"(?:Const|Shared|Unique|Weak)*Ptr\Z")
_SAME = frozenset(("get", "lock"))
_ELEMENT = frozenset(("front", "back", "top", "emplace_back", "emplace_front"))
_ITERATOR = re.compile(r"(?:const_)?(?:reverse_)?iterator")
# Members of containers that give an iterator, those of maps that give one with a bool, and functions of std that give
# back one like their first argument.
_ENDS = frozenset(("begin", "end", "cbegin", "cend", "rbegin", "rend", "crbegin", "crend"))
_ITERATING = _ENDS | {"find", "lower_bound", "upper_bound", "erase", "emplace_hint"}
_INSERTING = frozenset(("insert", "emplace", "try_emplace", "insert_or_assign"))
_SEARCHING = frozenset((
    "find", "find_if", "find_if_not", "lower_bound", "upper_bound", "min_element", "max_element", "next", "prev",
))  # fmt: skip
_NAME = re.compile(r"[A-Za-z_]\w*(?:::\w+)*")
_QUALIFIERS = re.compile(r"\b(?:const|volatile|typename|class|struct|mutable|static|constexpr|inline)\b")
_DEEPEST = 8


class CppType(NamedTuple):
    """What an expression is. name: the full name of a class, of the package itself (own) or another; empty for an
    interface, which is then given with its section. arguments: template arguments as written. kind: empty for one
    object, else `pointer` (an iterator, too: members are reached by `->`), `sequence`, `map` or `tuple`; parts: the
    types of what it points to or holds, of a map those of key and value, None for what is not known."""

    name: str = ""
    own: bool = False
    interface: NamedInterface | None = None
    section: str = ""
    arguments: tuple[str, ...] = ()
    kind: str = ""
    parts: tuple[CppType | None, ...] = ()

    @property
    def plain(self) -> bool:
        """Whether it is one object, neither pointer nor several."""
        return not self.kind

    def add_pointer(self) -> CppType:
        """A pointer to it."""
        return _wrap("pointer", self)

    def remove_pointer(self) -> CppType | None:
        """What a pointer points to; None for what is none."""
        return self.parts[0] if self.kind == "pointer" else None

    def reach(self, arrow: bool) -> CppType | None:
        """The object whose members are reached by `.`, or by `->`."""
        return self.remove_pointer() if arrow else self

    def find_element(self) -> CppType | None:
        """What a loop over it runs through; None for what is no container."""
        return self.parts[0] if self.kind == "sequence" else _wrap("tuple", *self.parts) if self.kind == "map" else None

    def find_indexed(self) -> CppType | None:
        """What `[]` gives of a container or pointer."""
        return self.parts[-1] if self.kind in ("sequence", "map", "pointer") else None

    def find_part(self, at: int) -> CppType | None:
        """A part of a pair, tuple or variant."""
        return self.parts[at] if self.kind == "tuple" and at < len(self.parts) else None

    def find_result(self, member: str) -> CppType | None:
        """What a method of a pointer or container of the standard library gives back."""
        if self.kind == "pointer":
            return self if member in _SAME else self.parts[0] if member == "value" else None
        if member in _ITERATING and (element := self.find_element()) is not None:
            return element.add_pointer()
        if self.kind == "map" and member in _INSERTING:
            return _wrap("tuple", _wrap("tuple", *self.parts).add_pointer(), None)
        if self.kind == "sequence" and member in _ELEMENT:
            return self.parts[0]
        return self.find_indexed() if member == "at" else None

    def make_interface_type(self) -> InterfaceType:
        """The same as a scope of interfaces takes it."""
        assert self.interface is not None
        return InterfaceType(self.interface, self.section)


def _wrap(kind: str, *parts: CppType | None) -> CppType:
    return CppType(kind=kind, parts=parts)


class Written(NamedTuple):
    """A type in its parts. outer: the name without template arguments, `::` before that of the global namespace kept;
    arguments: those of its template, None without;
    tail: names behind the template; pointer: it ends with `*`."""

    outer: str
    arguments: tuple[str, ...] | None
    tail: str
    pointer: bool
    array: bool


@lru_cache(maxsize=16384)
def parse_type(text: str) -> Written:
    """A type as written, in its parts."""
    array = text.endswith("[]")
    text = _QUALIFIERS.sub(" ", text.removesuffix("[]")).strip()
    pointer = text.rstrip("& ").endswith("*")
    text = text.rstrip("*& \n\t")
    opened = text.find("<")
    if opened < 0:
        return Written("".join(text.split()), None, "", pointer, array)
    closed = find_closing_angle(text, opened)
    if closed < 0:
        return Written("", None, "", pointer, array)
    inner = tuple(split_at_commas(text[opened + 1 : closed]))
    tail = strip_templates(text[closed + 1 :]).removeprefix("::")
    return Written("".join(text[:opened].split()), inner, tail, pointer, array)


class KnownFile:
    """What one file declares, by the last parts of the names. Kept with the file, for all that include it. words: all
    that stand in it. look: gives facts of another kind of the file, with a table of what to look for."""

    def __init__(self, facts: CppFile, words: frozenset[str], look: Callable[[str, Any], Any]):
        self.facts, self.words, self._look = facts, words, look

    def mentions(self, word: str) -> bool:
        """Whether a word stands in it."""
        return word in self.words

    @cached_property
    def using(self) -> dict[str, str]:
        """Names that `using a::b;` makes known anywhere in the file, in full; not the constructors of a base class."""
        parts = ((full, *full.rpartition("::")[::2]) for full in self.facts.using)
        return {last: full for full, outer, last in parts if outer and outer.rpartition("::")[2] != last}

    @cached_property
    def spaces(self) -> dict[str, str]:
        """Other names of namespaces."""
        return dict(self.facts.spaces)

    @cached_property
    def declarations(self) -> FileDeclarations:
        """What it declares outside of functions."""
        return self._look("declared_cpp", None)

    def list_mentions(self, words: Iterable[str]) -> tuple[Mention, ...]:
        """Where words stand in its text."""
        return self._look("mentioned_cpp", Rows(tuple(words))).mentions

    def list_uses(self, mentions: Iterable[Mention]) -> tuple[CppUse, ...]:
        """What the code says where words are mentioned."""
        places = tuple(dict.fromkeys((one.word, one.offset) for one in mentions))
        return self._look("used_cpp", Rows(places)).uses if places else ()

    @cached_property
    def type_names(self) -> frozenset[str]:
        """Last parts of the types that it seems to define, aliases among them."""
        return frozenset(self.facts.type_names)

    def declares_type(self, word: str) -> bool:
        """Whether it announces or defines a type of a name, or uses it in a typedef, for which a header that only
        announces it is enough."""
        return word in self.type_names or word in self.facts.announced or word in self.facts.aliased

    @cached_property
    def classes(self) -> dict[str, list[CppClass]]:
        """Its classes."""
        every = self.declarations.classes
        return group_pairs((one.name.rpartition("::")[2], one) for one in every if not one.specialised)

    @cached_property
    def names(self) -> dict[str, list[Declaration]]:
        """What it declares outside of classes and functions."""
        return group_pairs((one.name, one) for one in self.declarations.names)

    @cached_property
    def members(self) -> frozenset[str]:
        """Names of all members of its classes."""
        return frozenset(name for one in self.declarations.classes for name in one.members)

    @cached_property
    def defines(self) -> frozenset[str]:
        """Names that it declares in any way, outside of functions."""
        return frozenset((*self.classes, *self.names, *self.members, *self.facts.defined))

    def declares_in(self, scope: str, word: str) -> bool:
        """Whether it declares a name in a namespace."""
        full = f"{scope}::{word}"
        return any(one.scope == scope for one in self.names.get(word, ())) or any(
            one.name == full for one in self.list_classes(word)
        )

    def has_special_form(self, word: str) -> bool:
        """Whether it has a special form of a template of functions that is called so."""
        return any(one.template == ("",) for one in self.names.get(word, ()))

    def list_aliases(self, name: str) -> Iterator[Declaration]:
        """What a name stands for, outside of classes."""
        if name in self.type_names:
            yield from (one for one in self.names.get(name, ()) if one.kind == "alias")

    def list_classes(self, last: str) -> list[CppClass]:
        """Its classes of a name."""
        if last in self.type_names:
            return self.classes.get(last, [])
        return []


class Resolver:
    """Resolves what one file writes, with the headers of the package that it reaches. files: the file and these
    headers, none for what stands in headers of other packages."""

    def __init__(self, files: Sequence[KnownFile], vocabulary: Vocabulary | None, scope: InterfaceScope | None):
        self.files = tuple(files)
        self.vocabulary, self.scope = vocabulary, scope
        self._types: dict[tuple[str, str, str], CppType | None] = {}
        self._named: dict[tuple[str, str, str], CppType | None] = {}
        self._lines: dict[str, tuple[CppClass, ...]] = {}
        self._opened: tuple[str, ...] | None = None
        self._elsewhere: Resolver | None = None if self.files else self

    @property
    def known(self) -> KnownFile:
        """The file itself."""
        return self.files[0]

    def list_meanings(self, name: str, place: CodePlace) -> Iterator[str]:
        """The full names that a name as written can stand for, nearest first."""
        around = place.scope
        while around:
            yield f"{around}::{name}"
            around = around.rpartition("::")[0]
        yield name
        head, colons, rest = name.partition("::")
        rest = colons + rest
        for full in place.used:
            if full.rpartition("::")[2] == head:
                yield full + rest
        for meant in self._list_head_meanings(head):
            yield meant + rest
        for space in self.list_opened(place):
            yield f"{space}::{name}"

    @cache_method
    def _list_head_meanings(self, head: str) -> tuple[str, ...]:
        """What the head of a name stands for by `using a::head` or `namespace head = a`."""
        found: list[str] = []
        for file in self.files:
            meant = file.spaces.get(head) or file.using.get(head)
            if meant and meant != head:
                found.append(meant)
                deeper, more, tail = meant.partition("::")
                found += [other.spaces[deeper] + more + tail for other in self.files if deeper in other.spaces]
        return tuple(dict.fromkeys(found))

    def list_opened(self, place: CodePlace) -> tuple[str, ...]:
        """Namespaces whose names can be written without them."""
        if self._opened is None:
            self._opened = tuple(dict.fromkeys(space for file in self.files for space in file.facts.opened))
        return (*place.opened, *self._opened)

    def declares(self, word: str) -> bool:
        """Whether the file or a header of the package declares a name itself, outside of functions."""
        return any(file.mentions(word) and word in file.defines for file in self.files)

    def declares_in(self, scope: str, word: str) -> bool:
        """Whether the file or a header of the package declares a name in a namespace, which may be another package's:
        then it is not theirs that is used."""
        return any(
            file.mentions(word) and file.declares_in(scope, word) for file in self.files
        )

    @cache_method
    def list_own_classes(self, class_: str) -> list[CppClass]:
        """The classes of the package that a name can be: those of that full name, else those that end so."""
        last = class_.rpartition("::")[2]
        found = [one for file in self.files for one in file.list_classes(last)]
        exact = [one for one in found if one.name == class_]
        ending = f"::{class_}"
        known = exact or [one for one in found if f"::{one.name}".endswith(ending)]
        if not known and "::" in class_:
            # A namespace may be left out, or brought by a macro.
            known = [one for one in found if "::" not in one.name]
        return known

    def find_type(self, written: str, place: CodePlace, depth: int = 0) -> CppType | None:
        """What a type as written is; None where it is nothing that is known."""
        key = written, place.scope, place.owner
        if key in self._types:
            return self._types[key]
        if depth > _DEEPEST:
            return None
        self._types[key] = None
        found = self._types[key] = self._resolve_type(written, place, depth)
        return found

    def _resolve_type(self, written: str, place: CodePlace, depth: int) -> CppType | None:
        parts = parse_type(written)
        if not parts.outer:
            return None
        last = parts.outer.rpartition("::")[2]
        found = None
        kind, most = _find_kind(last)
        if parts.arguments and kind and (not parts.tail or _ITERATOR.fullmatch(parts.tail)):
            inner = [self.find_type(one, place, depth + 1) for one in parts.arguments[:most]]
            if any(inner) and (most is None or len(inner) == most):
                found = self._find_nested(_wrap(kind, *inner), parts.tail, depth)
        else:
            name = f"{parts.outer}::{parts.tail}" if parts.tail else parts.outer
            found = self.resolve_name(name, place, depth)
            if found is not None and parts.arguments and found.plain:
                found = found._replace(arguments=parts.arguments)
        if found is None:
            return None
        if parts.array:
            found = _wrap("sequence", found)
        return found.add_pointer() if parts.pointer else found

    def resolve_name(self, name: str, place: CodePlace, depth: int = 0) -> CppType | None:
        """The class that a name without template arguments is."""
        if name.startswith("::"):
            name, place = name.removeprefix("::"), _NOWHERE
        key = name, place.scope, place.owner
        if key in self._named:
            return self._named[key]
        self._named[key] = None
        found = self._named[key] = self._resolve_name(name, place, depth)
        return found

    def _resolve_name(self, name: str, place: CodePlace, depth: int) -> CppType | None:
        if depth > _DEEPEST or name == "std" or name.startswith("std::"):
            return None
        head, _, rest = name.partition("::")
        # What the class around declares comes first.
        if place.owner:
            for one in self.list_own_lineage(place.owner):
                for member in one.members.get(head, ()):
                    if member.kind == "alias":
                        inner = self.find_type(member.type, _make_class_place(one), depth + 1)
                        return self._find_nested(inner, rest, depth)
                    if member.kind == "type":
                        name = f"{one.name}::{name}"
                        break
                for base in one.bases:
                    outer = parse_type(base).outer.removeprefix("::")
                    if outer.rpartition("::")[2] == head and outer != name:
                        return self._find_nested(self.find_type(base, locate_class(one), depth + 1), rest, depth)
        own = self._find_own_class(name, place)
        if own is not None:
            return own
        meanings = list(dict.fromkeys(self.list_meanings(name, place)))
        if rest:
            for full in meanings:
                scope, _, last = full.rpartition("::")
                tail = ""
                while scope:
                    for alias in (one for file in self.files for one in file.list_aliases(last) if one.scope == scope):
                        inner = self.find_type(alias.type, CodePlace(scope, "", False), depth + 1)
                        inner = self._find_nested(inner, tail, depth)
                        if inner is not None:
                            return inner
                    tail = join_scope(last, tail)
                    scope, _, last = scope.rpartition("::")
        for file in self.files:
            for alias in file.list_aliases(head):
                inner = self.find_type(alias.type, CodePlace(alias.scope, "", False), depth + 1)
                if inner is not None or not rest:
                    return self._find_nested(inner, rest, depth)
        if self.vocabulary is not None:
            for full in meanings:
                if full in self.vocabulary.classes:
                    return CppType(full)
        if self.scope is not None:
            for full in meanings:
                member = self._find_interface(full)
                if member is not None:
                    return member
        outer, _, last = name.rpartition("::")
        if outer and _POINTED.fullmatch(last):
            inner = self.resolve_name(outer, place, depth + 1)
            return inner.add_pointer() if inner is not None else None
        if outer and self.vocabulary is not None:
            around = next((full for full in self.list_meanings(outer, place) if full in self.vocabulary.classes), None)
            inner = self._find_released(around, last, "alias") if around is not None else None
            if inner is not None:
                return inner
        shorter = _SUFFIX.sub("", name)
        if shorter and shorter != name and not shorter.endswith("::"):
            inner = self.resolve_name(shorter, place, depth + 1)
            return inner.add_pointer() if inner is not None and not inner.own else None
        # An alias of some class, where nothing else is so called.
        found = {
            self._find_nested(self.find_type(member.type, _make_class_place(one), depth + 1), rest, depth)
            for file in self.files
            if head in file.type_names
            for one in file.declarations.classes
            for member in one.members.get(head, ())
            if member.kind == "alias"
        }
        return _select_only(found)

    def _find_nested(self, type_: CppType | None, rest: str, depth: int) -> CppType | None:
        """What `alias::rest` is."""
        if type_ is None or not rest:
            return type_
        if _ITERATOR.fullmatch(rest):
            element = type_.find_element()
            return element.add_pointer() if element is not None else None
        if type_.interface is not None:
            return self._select_section(type_, rest.split("::"))
        return self.resolve_name(f"{type_.name}::{rest}", _NOWHERE, depth + 1) if type_.name else None

    def _find_own_class(self, name: str, place: CodePlace) -> CppType | None:
        if name.startswith("::"):
            name, place = name.removeprefix("::"), _NOWHERE
        last = name.rpartition("::")[2]
        names = {one.name for file in self.files for one in file.list_classes(last)}
        if not names:
            return None
        for full in self.list_meanings(name, place):
            if full in names:
                return CppType(full, own=True)
        if "::" not in name:
            return CppType(name, own=True)
        ending = f"::{name}"
        found = [full for full in names if full.endswith(ending)]
        return CppType(found[0], own=True) if len(found) == 1 else None

    def _find_interface(self, name: str) -> CppType | None:
        """The interface that a qualified name is; only one may be meant."""
        assert self.scope is not None
        parts = name.split("::")
        for at in range(len(parts) - 1, max(-1, len(parts) - 4), -1):
            member = self._find_plain_interface(parts[: at + 1])
            if member is None:
                continue
            pointer = any(_POINTED.fullmatch(part) for part in parts[at + 1 :]) or member[2]
            section = find_section(member[:2], [part for part in parts[at + 1 :] if not _POINTED.fullmatch(part)])
            if section is not None:
                found = CppType(interface=member[0], section=section)
                return found.add_pointer() if pointer else found
        return None

    def _find_plain_interface(self, parts: list[str]) -> tuple[NamedInterface, str, bool] | None:
        assert self.scope is not None
        *outer, name = parts
        for spelt in (name, name.removesuffix("Ptr"), name.removesuffix("ConstPtr")):
            meant = self.scope.by_name.get(spelt, [])
            if outer:
                kind = outer[-1] if outer[-1] in ("msg", "srv", "action") else ""
                package = outer[-2] if kind and len(outer) > 1 else ("" if kind else outer[-1])
                meant = [
                    (i, s) for i, s in meant
                    if (not package or i.package == package) and (not kind or i.name.startswith(kind))
                ]  # fmt: skip
            if len(meant) == 1:
                return *meant[0], spelt != name
        return None

    def _select_section(self, type_: CppType, words: list[str]) -> CppType | None:
        assert type_.interface is not None
        pointer = any(_POINTED.fullmatch(word) for word in words)
        member = type_.interface, type_.section
        section = find_section(member, [word for word in words if not _POINTED.fullmatch(word)])
        if section is None:
            return None
        found = type_._replace(section=section)
        return found.add_pointer() if pointer else found

    def list_own_lineage(self, class_: str) -> tuple[CppClass, ...]:
        """A class of the package and those of the package that it is derived from, with the arguments of templates
        written where their parameters stood."""
        known = self._lines.get(class_)
        if known is None:
            self._lines[class_] = ()
            known = self._lines[class_] = tuple(self._find_line(class_, (), 0))
        return known

    def _find_line(self, class_: str, arguments: tuple[str, ...], depth: int) -> Iterator[CppClass]:
        homes = self.list_own_classes(class_)
        if len(homes) != 1 or depth > _DEEPEST:
            return
        one = substitute_class(homes[0], arguments) if homes[0].template and arguments else homes[0]
        yield one
        for base in one.bases:
            parts = parse_type(base)
            own = self._find_own_class(parts.outer, locate_class(one))
            if own is not None and own.name != one.name:
                yield from self._find_line(own.name, parts.arguments or (), depth + 1)

    def spell_out(self, type_: str, class_: CppClass) -> str:
        """A type as written in a class of the package, with what aliases of the package in it stand for."""
        for _ in range(_DEEPEST):
            meant = _NAME.sub(lambda found: self._find_alias(found.group(), class_), type_)
            if meant == type_:
                break
            type_ = meant
        return type_

    def _find_alias(self, name: str, class_: CppClass) -> str:
        """What a name stands for in a class, its own alias or one of a namespace around it; else the name."""
        inside = (one for each in self.list_own_lineage(class_.name) for one in each.members.get(name, ()))
        for one in inside:
            return one.type if one.kind == "alias" and not one.template else name
        around, last = set(self.list_meanings(name, locate_class(class_))), name.rpartition("::")[2]
        found = {
            one.type
            for file in self.files
            for one in file.list_aliases(last)
            if not one.template and join_scope(one.scope, last) in around
        }
        return _select_only(found) or name

    def list_bases(self, class_: CppClass) -> list[tuple[str, CppType | None]]:
        """The bases of a class of the package, with what they are."""
        return [(base, self.find_type(base, locate_class(class_))) for base in class_.bases]

    def find_own_member(self, class_: str, word: str, depth: int = 0) -> tuple[str, tuple[str, ...]] | None:
        """The changing name of another package that a member of an own class is, by its bases, and the packages in
        between, with an empty one where a base is not known."""
        assert self.vocabulary is not None
        homes = self.list_own_classes(class_)
        if len(homes) != 1 or depth > _DEEPEST or word in homes[0].members:
            return None
        found, strange = None, homes[0].open
        for base, type_ in self.list_bases(homes[0]):
            if type_ is None:
                strange = strange or not base.startswith("std::")
            elif type_.own:
                found = found or self.find_own_member(type_.name, word, depth + 1)
            elif type_.name:
                found = found or self.vocabulary.find_member(type_.name, word)
        if found is not None and strange:
            return found[0], (*found[1], "")
        return found

    def list_known_bases(self, base: str, place: CodePlace, depth: int = 0) -> list[str]:
        """The classes of other packages that a base stands for, or is derived from."""
        type_ = self.find_type(base, place)
        if type_ is None or depth > _DEEPEST or not type_.name:
            return []
        if not type_.own:
            return [type_.name]
        return [
            known
            for one in self.list_own_classes(type_.name)
            for inner in (substitute_class(one, type_.arguments) if one.template else one).bases
            for known in self.list_known_bases(inner, locate_class(one), depth + 1)
        ]

    def resolve_value(self, expr: Expr, place: CodePlace, depth: int = 0) -> CppType | None:
        """What an expression is."""
        if depth > 4 * _DEEPEST:
            return None
        kind = expr.kind
        if kind == "name":
            return self._resolve_name_value(expr, place, depth)
        if kind == "member":
            return self._resolve_member_value(expr, place, depth)
        if kind == "call":
            return self._resolve_call_value(expr, place, depth)
        if kind in ("index", "each", "part") or (kind == "unary" and expr.text in "*&"):
            type_ = self.resolve_value(expr.parts[0], place, depth + 1)
            if type_ is None:
                return None
            if kind == "part":
                at, _, number = expr.text.partition("/")
                return self._resolve_part(type_, int(at), int(number), place)
            if kind == "unary":
                return type_.remove_pointer() if expr.text == "*" else type_.add_pointer()
            return type_.find_indexed() if kind == "index" else type_.find_element()
        if kind == "this":
            return CppType(place.owner, own=True).add_pointer() if place.owner else None
        if kind in ("new", "cast", "braces") and expr.text:
            type_ = self.find_type(expr.text, place)
            return type_.add_pointer() if type_ is not None and kind == "new" else type_
        if kind == "conditional" and len(expr.parts) == 2:
            one, other = (self.resolve_value(part, place, depth + 1) for part in expr.parts)
            return one if one == other else None
        return None

    def _resolve_part(self, type_: CppType, at: int, number: int, place: CodePlace) -> CppType | None:
        """What one of the names of a structured binding is. number: how many they are."""
        if not type_.own or any(file.mentions("tuple_size") for file in self.files):
            return type_.find_part(at)
        for one in self.list_own_lineage(type_.name):
            fields = [name for name, those in one.members.items() if any(map(_is_field, those))]
            if fields or one.open:
                known = len(fields) == number and not one.open
                return self.resolve_member(type_, fields[at], place, False) if known else None
        return None

    def _resolve_name_value(self, expr: Expr, place: CodePlace, depth: int) -> CppType | None:
        local = expr.local
        if local is None:
            return None if "::" in expr.text else self.resolve_variable(expr.text, place)
        if local.how not in ("variable", "parameter", "binding"):
            return None
        if "auto" not in local.type:
            return self.find_type(local.type, place) if local.type else None
        return self.resolve_value(local.value, place, depth + 1) if local.value is not None else None

    def resolve_variable(self, name: str, place: CodePlace) -> CppType | None:
        """What a name is that no function declares: a member of the class around, or a variable outside of all."""
        if place.owner:
            for one in self.list_own_lineage(place.owner):
                if name in one.members:
                    return self._merge_declared_types(one.members[name], _make_class_place(one), "variable")
            inherited = self._resolve_inherited(place.owner, name, "variable")
            if inherited is not None:
                return inherited
        found = [
            self.find_type(one.type, CodePlace(one.scope, "", False))
            for file in self.files
            if file.mentions(name)
            for one in file.names.get(name, ())
            if one.kind == "variable" and "auto" not in one.type
        ]
        return found[0] if found and all(one == found[0] for one in found) else None

    def find_written_type(self, name: Expr, place: CodePlace) -> str:
        """The type that a variable, parameter or own member is declared with, as it is written there; empty where that
        is not to be told."""
        if name.local is not None:
            return name.local.type if name.local.how in ("variable", "parameter") else ""
        for one in self.list_own_lineage(place.owner) if place.owner and "::" not in name.text else ():
            written = {each.type for each in one.members.get(name.text, ()) if each.kind == "variable"}
            if written:
                return _select_only(written) or ""
        return ""

    def _merge_declared_types(self, those: Iterable[Declaration], place: CodePlace, kind: str) -> CppType | None:
        """What several declarations of one name give, where they agree."""
        found = {self.find_type(one.type, place) if one.type and "auto" not in one.type else None
                 for one in those if one.kind == kind}  # fmt: skip
        return _select_only(found)

    def _resolve_member_value(self, expr: Expr, place: CodePlace, depth: int, called: bool = False) -> CppType | None:
        value = self.resolve_value(expr.parts[0], place, depth + 1)
        type_ = value.reach(expr.arrow) if value is not None else None
        if type_ is None:
            return None
        if type_.plain:
            return self.resolve_member(type_, expr.text, place, called)
        if called:
            return type_.find_result(expr.text)
        return type_.find_part(_PAIR.index(expr.text)) if expr.text in _PAIR else None

    def resolve_member(self, type_: CppType, name: str, place: CodePlace, called: bool) -> CppType | None:
        """What a member of an object is."""
        if type_.interface is not None:
            if called or self.scope is None:
                return None
            found = self.scope.resolve_field(type_.make_interface_type(), name)
            if found is None:
                return None
            inner = CppType(interface=found.interface, section=found.section)
            return _wrap("sequence", inner) if found.several else inner
        kind = "function" if called else "variable"
        if not type_.own:
            return self._find_released(type_.name, name, kind)
        for one in self.list_own_lineage(type_.name):
            if name in one.members:
                found = self._merge_declared_types(one.members[name], _make_class_place(one), kind)
                written = _select_only({each.type for each in one.members[name] if each.kind == kind})
                if found is None and one.template and type_.arguments and written is not None:
                    return self.find_type(_substitute_text(written, one.template, type_.arguments), place)
                return found
        return self._resolve_inherited(type_.name, name, kind)

    def _resolve_inherited(self, class_: str, name: str, kind: str) -> CppType | None:
        """What a member is that a class of the package has of its one base of other packages."""
        bases = [type_ for one in self.list_own_lineage(class_) for _, type_ in self.list_bases(one)]
        others = [type_ for type_ in bases if type_ is None or not type_.own]
        return self._find_released(others[0].name, name, kind) if len(others) == 1 and others[0] is not None else None

    def _find_released(self, class_: str, name: str, kind: str) -> CppType | None:
        """What a member of a class of other packages is, or gives back, in the versions that are asked about."""
        if self.vocabulary is None or not class_:
            return None
        around, types = self.vocabulary.find_member_types(class_, name, kind)
        if self._elsewhere is None:
            self._elsewhere = Resolver((), self.vocabulary, None)
        found = {self._elsewhere.find_type(each, CodePlace(around, "", False)) for each in types}
        return _select_only(found)

    def _resolve_call_value(self, expr: Expr, place: CodePlace, depth: int) -> CppType | None:
        callee = expr.parts[0]
        if callee.kind == "member":
            return self._resolve_member_value(callee, place, depth, called=True)
        if callee.kind != "name":
            return None
        if callee.local is not None and callee.local.how != "function":
            return None
        name = callee.text
        outer, _, last = name.rpartition("::")
        if callee.template:
            if name in _CASTS:
                return self.find_type(callee.template[0], place)
            if last in _MAKERS or last in _POINTER_CASTS:
                type_ = self.find_type(callee.template[0], place)
                return type_.add_pointer() if type_ is not None else None
            if name in ("std::get", "std::get_if") and len(expr.parts) == 2:
                return self._resolve_get(callee.template[0], expr.parts[1], last == "get_if", place, depth)
        if outer == "std" and last in _ENDS and len(expr.parts) == 2:
            value = self.resolve_value(expr.parts[1], place, depth + 1)
            return value.find_result(last) if value is not None else None
        if (last in _SEARCHING and outer == "std") or (last in _THROUGH and outer in ("std", "boost")):
            return self.resolve_value(expr.parts[1], place, depth + 1) if len(expr.parts) > 1 else None
        if outer and last in _MAKERS and outer not in ("std", "boost"):
            type_ = self.resolve_name(outer, place)
            return type_.add_pointer() if type_ is not None else None
        if last in ("shared_from_this", "weak_from_this") and not outer:
            return CppType(place.owner, own=True).add_pointer() if place.owner else None
        written = f"{name}<{', '.join(callee.template)}>" if callee.template else name
        type_ = self.find_type(written, place)
        if type_ is not None and type_.kind != "pointer":
            return type_
        return self._resolve_result(name, place)

    def _resolve_get(self, which: str, given: Expr, arrow: bool, place: CodePlace, depth: int) -> CppType | None:
        """What `std::get<which>(given)` gives back, or with arrow `std::get_if<which>(given)`."""
        if which.isdecimal():
            value = self.resolve_value(given, place, depth + 1)
            value = value.reach(arrow) if value is not None else None
            found = value.find_part(int(which)) if value is not None else None
        else:
            found = self.find_type(which, place)
        return found.add_pointer() if found is not None and arrow else found

    def _resolve_result(self, name: str, place: CodePlace) -> CppType | None:
        """What a function gives back."""
        if "::" not in name and place.owner:
            for one in self.list_own_lineage(place.owner):
                if name in one.members:
                    return self._merge_declared_types(one.members[name], _make_class_place(one), "function")
            inherited = self._resolve_inherited(place.owner, name, "function")
            if inherited is not None:
                return inherited
        outer, _, last = name.rpartition("::")
        if outer:
            class_ = self.resolve_name(outer, place)
            if class_ is not None and class_.name:
                return self.resolve_member(class_, last, place, True)
        found = {
            self.find_type(one.type, CodePlace(one.scope, "", False)) if "auto" not in one.type else None
            for file in self.files
            if file.mentions(last)
            for one in file.names.get(last, ())
            if one.kind == "function" and (not outer or f"::{one.scope}".endswith(f"::{outer}"))
        }
        return _select_only(found)


_NOWHERE = CodePlace("", "", False)
_PAIR = ("first", "second")


def _find_kind(last: str) -> tuple[str, int | None]:
    """What a template of the standard library makes, by its name without scopes, and of how many of its arguments (None
    for all); empty for none that is known."""
    if last in _POINTERS:
        return "pointer", 1
    if last in _SEQUENCES:
        return "sequence", 1
    return ("map", 2) if last in _MAPS else ("tuple", None) if last in _TUPLES else ("", 0)


def _select_only(found: set[T]) -> T | None:
    """The one thing that was found; None where there is none, or several."""
    return next(iter(found)) if len(found) == 1 else None


def _substitute_text(text: str, parameters: Iterable[str], arguments: Iterable[str]) -> str:
    """A type with the arguments of a template in the places of its parameters."""
    for name, given in zip(parameters, arguments, strict=False):
        if name and name in text:
            text = re.sub(rf"\b{re.escape(name)}\b", lambda _, given=given: given, text)
    return text


def substitute_class(class_: CppClass, arguments: tuple[str, ...]) -> CppClass:
    """A class with the arguments of its template in the places of the parameters."""

    def fill(text: str) -> str:
        return _substitute_text(text, class_.template, arguments)

    members = {
        name: [
            one._replace(
                type=fill(one.type),
                parameters=tuple(parameter._replace(type=fill(parameter.type)) for parameter in one.parameters),
            )
            for one in those
        ]
        for name, those in class_.members.items()
    }
    bases = tuple(map(fill, class_.bases))
    return class_._replace(members=members, bases=bases)


def _is_field(one: Declaration) -> bool:
    """Whether a member is one of each object."""
    return one.kind == "variable" and "static" not in one.traits


def _make_class_place(class_: CppClass) -> CodePlace:
    return CodePlace(class_.name, class_.name, False)


def locate_class(class_: CppClass) -> CodePlace:
    """Where the bases of a class are written."""
    return CodePlace(class_.name.rpartition("::")[0], "", False)
