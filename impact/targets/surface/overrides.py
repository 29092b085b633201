"""Whether a method that a class declares overrides one of its base's, as the target's version of the base's package
declares it, where another version did or does."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from functools import lru_cache

from ...facts.surface import CLASSES, Entity
from .changes import ChangeEvent, Form, Overload, make_overload
from .offers import Offered, Offers, iterate_other_forms, make_offered

_RESULT = "-> "
_BASES = ": "
_MEANT = " = "


def describe_bases(bases: Sequence[tuple[str, str]]) -> str:
    """The mark of a method of a class whose bases are all known. bases: packages and names of the classes."""
    return _BASES + ", ".join(" ".join(base) for base in bases)


def describe_override(types: tuple[str, ...], marks: tuple[str, ...], result: str, class_: str) -> tuple[str, ...]:
    """What an override is described with: the types of its parameters as spell_type() writes them, `const` and
    `override` where they stand, what it gives back, and the class that declares it."""
    return (*types, *marks, f"{_RESULT}{result}", class_)


def spell_type(written: str, meant: str) -> str:
    """The type of a parameter as written, with what it is where aliases of the package are in it."""
    return written if written == meant else f"{written}{_MEANT}{meant}"


def says_override(given: tuple[str, ...], arguments: int) -> bool:
    """Whether `override` stands at a method that is so described."""
    return "override" in given[arguments:]


def extract_class(given: tuple[str, ...], arguments: int) -> str:
    """The class that declares a method that is so described; empty where that is not known."""
    return given[-1] if any(one.startswith(_RESULT) for one in given[arguments:]) else ""


def list_virtual_forms(form: Form | None) -> list[Overload]:
    """The overloads of a form that may be overridden."""
    return [one for one in form.overloads if "virtual" in one.traits] if form is not None else []


class Override:
    """A method that overrides, or is to override, one of a base class."""

    def __init__(self, offers: Offers, given: tuple[str, ...], arguments: int):
        marks = given[arguments:]
        self.offers = offers
        self.spelt = [tuple(dict.fromkeys(one.split(_MEANT))) for one in given[:arguments]]
        self.types = tuple(spellings[0] for spellings in self.spelt)
        self.const, self.says_so = "const" in marks, "override" in marks
        self.parameters: tuple[str, ...] = ()
        bases = next((one[len(_BASES) :] for one in marks if one.startswith(_BASES)), "")
        self.bases = [(base.partition(" ")[0], base.partition(" ")[2]) for base in bases.split(", ") if base]
        self.result = next((one[len(_RESULT) :] for one in marks if one.startswith(_RESULT)), "")

    def find_lost_change(self, line: Sequence[tuple[str, str]]) -> tuple[Offered, str, bool] | None:
        """The change that the method does not fit to, whether the target has no method of that name (`gone`) or another
        (`override`), and whether it was before the target's version; None where it overrides what the target has, or
        where that cannot be known. line: packages and names of the method in the base class, and in the bases of that.
        """
        classes = [one for package, name in line for one in self._list_entities(package, name.rpartition("::")[0])]
        self.parameters = tuple(parameter.name for one in classes for parameter in one.template or ())
        if any(_is_derived_from_parameter(one) for one in classes):
            return None  # whoever stands for it may have the method
        # Where others came beside a form that stayed, a later change took that form, maybe from a base class.
        found = min(self._iterate_lost_changes(line), key=lambda one: one[0], default=None)
        return found and found[1:]

    def _iterate_lost_changes(self, line: Sequence[tuple[str, str]]) -> Iterator[tuple[bool, Offered, str, bool]]:
        """The same of all changes, the nearest of each class first, and whether the method fits to both sides of it."""
        methods = [(at, one) for at in line for one in self._list_virtual_methods(*at)]
        fitting = {one.type for at, one in methods if self._fits(make_overload(one), *at)}
        here = [one for _, one in methods]
        for package, name in line:
            offer = self.offers.find_package(package)
            offered = offer.get("c++", name) if offer is not None else None
            for event, form, earlier in iterate_other_forms(self.offers, offered) if offered is not None else ():
                # A method that is not to override anything need not do so yet.
                mine = [one for one in list_virtual_forms(form) if self._fits(one, package, name)]
                if offered is None or not mine or not (earlier or self.says_so):
                    continue
                beyond = list_virtual_forms(event.has if earlier else event.had)
                stays = any(self._fits(one, package, name) for one in beyond)
                if fitting:
                    if self._gives_other(offered, event, earlier, fitting):
                        yield stays, make_offered(self.offers, offered, event, earlier), "override", earlier
                elif all(self._differs_surely(make_overload(one), mine, form, offered) for one in here):
                    lost = make_offered(self.offers, offered, event, earlier)
                    left = not earlier or any(self._list_entities(*one) for one in line)
                    yield stays, lost, "override" if left else "gone", earlier

    def find_unmatched(self, member: str) -> tuple[Entity, tuple[str, ...]] | None:
        """A method of this name that the base classes have where the method, which is to override one, surely overrides
        none of them, and the packages of all base classes; None where it may, or where one of the classes is not
        completely known."""
        lineage = list_lineage(self.offers, self.bases) if self.says_so and self.bases else None
        if lineage is None:
            return None
        methods = [one for package, name in lineage for one in self._list_entities(package, f"{name}::{member}")]
        parameters = {
            parameter.name
            for package, name in lineage
            for one in self._list_entities(package, name)
            for parameter in one.template or ()
        }
        if not methods or any(one.kind != "method" or self._may_match(one, parameters) for one in methods):
            return None
        return methods[0], tuple(dict.fromkeys(package for package, _ in lineage))

    def _may_match(self, method: Entity, parameters: set[str]) -> bool:
        """Whether the method may override another, as far as their types show. parameters: of templates, which may
        stand for anything."""
        overload = make_overload(method)
        if len(overload.types) != len(self.types) or ("const" in overload.traits) != self.const:
            return False
        pairs = list(zip(self.types, overload.types, strict=True))
        if not parameters.isdisjoint(name for type_ in overload.types for name in re.findall(r"\w+", type_)):
            return True
        return not any(differs_plainly(one, other) for one, other in pairs)

    def _list_entities(self, package: str, name: str, version: str = "") -> list[Entity]:
        return list_entities(self.offers, package, name, version)

    def _list_virtual_methods(self, package: str, name: str, version: str = "") -> list[Entity]:
        """The methods of a name that may be overridden."""
        return [one for one in self._list_entities(package, name, version) if "virtual" in one.traits]

    def _fits(self, overload: Overload, package: str, name: str) -> bool:
        """Whether the method can be the same as another, as their types are written. package, name: of the other."""
        if len(overload.types) != len(self.types) or ("const" in overload.traits) != self.const:
            return False
        return all(
            any(_agree(one, other, self.parameters) for one in spellings for other in self._spell(type_, package, name))
            for spellings, type_ in zip(self.spelt, overload.types, strict=True)
        )

    def _spell(self, type_: str, package: str, name: str) -> Iterator[str]:
        """A type as a method of a package has it, then with what aliases in it stand for."""
        yield type_
        scope = name.rpartition("::")[0]
        for _ in range(_DEEPEST):
            meant = _NAME.sub(lambda found: self._find_alias(found.group(), scope, package), type_)
            if meant == type_:
                return
            yield (type_ := meant)

    def _find_alias(self, name: str, scope: str, package: str) -> str:
        """What a name that is an alias stands for; else the name."""
        found = self._find_named(name, scope, package)[1]
        types = {entity.type if entity.kind == "alias" and entity.template is None else "" for entity in found}
        return (types.pop() or name) if len(types) == 1 else name

    def _differs_surely(self, overload: Overload, mine: list[Overload], form: Form, owner: Offered) -> bool:
        """Whether the method does not override another, however the types are spelt. mine: those that it overrides in
        another version, which has the form."""
        if len(overload.types) != len(self.types) or ("const" in overload.traits) != self.const:
            return True
        pairs = list(zip(self.types, overload.types, strict=True))
        if not any(
            _strip_scopes(one) == _strip_scopes(other)
            for spellings, type_ in zip(self.spelt, overload.types, strict=True)
            for one in spellings for other in self._spell(type_, owner.package, owner.name)
        ):  # fmt: skip
            return True
        if any(_differs(one, other) for one, other in pairs) or any(
            overload.types == one.types and "virtual" in one.traits for one in form.overloads
        ):
            return True  # what is declared beside another has other types
        scope = owner.name.rpartition("::")[0]
        return any(
            self._differ(one, other, scope, owner.package)
            for known in mine
            for one, other in zip(known.types, overload.types, strict=True)
        )

    def _gives_other(self, offered: Offered, event: ChangeEvent, earlier: bool, now: set[str]) -> bool:
        """Whether the method gives back what another version's does, and the target's surely does not. now: what those
        of the target do that it may override."""
        offer = self.offers.find_package(offered.package)
        if not self.result or offer is None or not any("result" in reported.aspects for reported in event.reported):
            return False
        version = offer.line.versions[event.place - 1 if earlier else event.place]
        before = sorted({one.type for one in self._list_virtual_methods(offered.package, offered.name, version)})
        if len(before) != 1 or not _agree(self.result, before[0], ()):
            return False
        scope = offered.name.rpartition("::")[0]
        return all(
            not _agree(self.result, one, ()) and self._differ(before[0], one, scope, offered.package) for one in now
        )

    def _differ(self, one: str, other: str, scope: str, package: str) -> bool:
        """Whether two types are surely not the same. scope: the class in which both are written."""
        kinds = [self._resolve_type(type_, scope, package) for type_ in (one, other)]
        return "" not in kinds and kinds[0] != kinds[1]

    def _resolve_type(self, type_: str, scope: str, package: str) -> str:
        """A type by a name that no other type has; empty where it may be an alias, or is a template's."""
        bare = " ".join(re.sub(r"\b(?:const|typename)\b|&", " ", type_).split())
        if "*" in bare or "<" in bare:
            return ""
        if bare in _FUNDAMENTAL or re.fullmatch(r"\w+::(?:msg|srv|action)::\w+", bare) or bare == "std::string":
            return bare
        class_, _, pointer = bare.rpartition("::")
        if pointer in _POINTERS:
            kind = self._resolve_type(class_, scope, package)
            return f"{kind}::{pointer}" if kind else ""
        full, found = self._find_named(bare, scope, package)
        return full if found and all(entity.kind in _TYPES for entity in found) else ""

    def _find_named(self, name: str, scope: str, package: str) -> tuple[str, list[Entity]]:
        """The full name of what a name stands for in a class of a package, and how it is declared; none where it is
        not."""
        while True:
            full = f"{scope}::{name}" if scope else name
            # What a header of the package names is declared by itself or by what it hands on.
            owners = [full.partition("::")[0], package] if scope else self._list_given(package, name.partition("::")[0])
            for owner in owners:
                found = self._list_entities(owner, full)
                if found:
                    return full, found
            if not scope:
                return "", []
            scope = scope.rpartition("::")[0]

    def _list_given(self, package: str, first: str) -> list[str]:
        """A package, and what it hands on to its dependants, also through each other: first the one of a name."""
        found = [first, package]
        for one in found:
            found.extend(other for other in self.offers.list_exports(one) or () if other not in found)
        return found


def list_entities(offers: Offers, package: str, name: str, version: str = "") -> list[Entity]:
    """What a version of a package, by default the target's, declares by a name."""
    offer = offers.find_package(package)
    return list(offer.history.iterate_entities(name, version or offer.stored)) if offer is not None else []


def list_lineage(offers: Offers, bases: Sequence[tuple[str, str]]) -> list[tuple[str, str]] | None:
    """Some classes and all that they are derived from, by their packages and names; None where one of them is not
    stored of the target's very version."""
    lineage = list(bases)
    for package, name in lineage:
        offer = offers.find_package(package)
        if offer is None or not offer.exact or offer.build.has_empty_folders:
            return None
        declared = [one for one in list_entities(offers, package, name) if one.kind in CLASSES]
        if not declared:
            return None
        for base in {base.type.partition("<")[0] for one in declared for base in one.bases}:
            if base == "std::enable_shared_from_this":
                continue  # which has nothing virtual
            full = next(
                (one for one in offer.line.bases.get(name, ()) if f"::{one}".endswith(f"::{base.lstrip(':')}")), ""
            )
            owners = dict.fromkeys((package, full.partition("::")[0])) if full else {}
            owner = next((one for one in owners if offers.has_name("c++", full, one)), None)
            if owner is None:
                return None
            if (owner, full) not in lineage:
                lineage.append((owner, full))
    return lineage


def has_method(offers: Offers, bases: Sequence[tuple[str, str]], member: str) -> bool | None:
    """Whether some classes, or those that they are derived from, declare a method of a name; None where one of them is
    not completely known."""
    lineage = list_lineage(offers, bases)
    if lineage is None:
        return None
    histories = [(offers.find_history(package), name) for package, name in lineage]
    if not all(history is not None and history.is_understood(name) for history, name in histories):
        return None
    return any(list_entities(offers, package, f"{name}::{member}") for package, name in lineage)


def _is_derived_from_parameter(class_: Entity) -> bool:
    """Whether a class template is derived from what it is given."""
    parameters = {parameter.name for parameter in class_.template or ()}
    return any(base.type.removesuffix("...").strip() in parameters for base in class_.bases)


_NAME = re.compile(r"[A-Za-z_]\w*(?:::\w+)*")
_DEEPEST = 4
_FUNDAMENTAL = frozenset(("void", "bool", "char", "int", "unsigned int", "float", "double"))
_POINTERS = frozenset(("SharedPtr", "ConstSharedPtr", "WeakPtr", "ConstWeakPtr", "UniquePtr"))
_TYPES = frozenset(("class", "struct", "enum"))


@lru_cache(maxsize=4096)
def _agree(one: str, other: str, parameters: tuple[str, ...]) -> bool:
    """Whether two types as written can be the same: but for scopes that one of them leaves out, and for what stands for
    the parameters of the template in which the other is written."""
    names, others = _split_type(one), _split_type(other)
    return len(names) == len(others) and all(
        a == b or a.endswith(f"::{b}") or b.endswith(f"::{a}") or b.partition("::")[0] in parameters
        for a, b in zip(names, others, strict=True)
    )


def _split_type(type_: str) -> list[str]:
    """The names and signs of a type, without what callers do not see: `const` stands before what it is of, and smart
    pointers are written as what their aliases stand for."""
    bare = _ALIASED.sub(lambda found: f"{found[3].lower()}_ptr<{found[2].lower()} {found[1]}>", type_)
    parts: list[str] = []
    starts, start = [], 0
    for part in re.findall(r"(?:::)?\w+(?:::\w+)*|[^\w\s]", re.sub(r"\btypename\b", " ", bare)):
        before = parts[-1] if parts else ""
        if part == "const" and (before == ">" or before[-1:].isalnum()) and before != "const":
            parts.insert(start, part)
            continue
        if part == "<":
            starts.append(start)
        elif part == ">" and starts:
            start = starts.pop()
        elif part[-1].isalnum() and not (before[-1:].isalnum() and before != "const"):
            start = len(parts)
        parts.append(part)
    return parts[1:] if parts[:1] == ["const"] and parts[-1] not in "&*" else parts


_ALIASED = re.compile(r"((?:::)?\w+(?:::\w+)*)::(Const|)(Shared|Weak|Unique)Ptr\b")
_SHAPE = re.compile(r"(?:\b|::)(Const)?(Shared|Weak|Unique)Ptr\b|\b(shared|weak|unique)_ptr<")


def _differs(one: str, other: str) -> bool:
    """Whether two types differ in more than what an alias can stand for: a reference against a value, or one sort of
    smart pointer against another."""
    if one.endswith("&") != other.endswith("&"):
        return True
    sorts = [[(match.group(2) or match.group(3)).lower() for match in _SHAPE.finditer(text)] for text in (one, other)]
    return bool(sorts[0]) and bool(sorts[1]) and sorts[0] != sorts[1]


_PLAIN = re.compile(r"std::(?:string|vector|map|function|shared_ptr|unique_ptr|weak_ptr|optional)\b")
_MESSAGE = re.compile(r"\w+::(?:msg|srv|action)::\w+")


def differs_plainly(one: str, other: str) -> bool:
    """Whether two types are surely not the same, whatever the names in them stand for."""
    bare = [" ".join(re.sub(r"\bconst\b|&", " ", type_).split()) for type_ in (one, other)]
    known = [type_ in _FUNDAMENTAL or type_ == "std::string" or bool(_MESSAGE.fullmatch(type_)) for type_ in bare]
    if all(known) and bare[0] != bare[1]:
        return True
    # What is no alias shows whether it is a reference, and what sort of pointer.
    shown = [
        sure or bool(_PLAIN.match(type_)) or type_.rpartition("::")[2] in _POINTERS
        for type_, sure in zip(bare, known, strict=True)
    ]
    return all(shown) and max(len(_SHAPE.findall(type_)) for type_ in bare) < 2 and _differs(one, other)


def _strip_scopes(type_: str) -> str:
    """A type without its scopes."""
    return re.sub(r"(?:\w+::)+(?=\w)", "", " ".join(_split_type(type_)))
