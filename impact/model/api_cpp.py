"""Uses of other packages' changing names in a C++ file, told by scopes, the types of variables, and base classes.

A name is looked at where its last part stands. What stands before it tells whose it is: scopes (through aliases and
`using`), an object whose type is declared in the file or in the package's headers that reach it, or, for a bare name,
the class around it. Where that cannot be told, nothing is said.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Collection, Iterable, Iterator
from functools import cached_property, lru_cache
from typing import NamedTuple

from ..facts.cpp import standing
from ..facts.usage import arguments_at, declares_next, template_arguments
from .api import ASSIGNING, CALLED, CLASSES, Found, Vocabulary
from .expressions_cpp import (
    FAR,
    Region,
    Step,
    blocks,
    chain_before,
    declarations_of,
    in_scope,
    regions,
    scopes_before,
    split_at_commas,
    without_templates,
)

_ASSIGNMENTS = {name: re.compile(re.escape(sign)) for name, sign in ASSIGNING.items()}
_TYPES = CLASSES | {"alias", "enum"}
_POINTERS = frozenset(["shared_ptr", "unique_ptr", "weak_ptr", "intrusive_ptr"])
_MAKERS = frozenset(["make_shared", "make_unique", "allocate_shared"])
_SEQUENCES = frozenset(["vector", "array", "deque", "list", "set", "initializer_list"])
_POINTED = re.compile(r"(?:Const|Shared|Unique|Weak)*(?:Ptr|_ptr)")
_SUFFIX = re.compile(r"(?:Const|Shared|Unique|Weak)*Ptr\Z")
_SAME = frozenset(["get()", "lock()", "value()"])
_ELEMENT = frozenset(["front()", "back()", "at()"])
_SPACE = re.compile(r"\s*")
_USING_NAMESPACE = re.compile(r"using\s+namespace\s+(?:::\s*)?([A-Za-z_][\w:\s]*?)\s*;")
_USING = re.compile(r"using\s+(?:typename\s+)?(?:::\s*)?([A-Za-z_]\w*(?:\s*::\s*\w+)+)\s*;")
_ALIAS = re.compile(
    r"using\s+(\w+)\s*=\s*(?:typename\s+)?([\w:<>,\s*&]+?)\s*;|typedef\s+(?:typename\s+)?([\w:<>,\s*&]+?)\s+(\w+)\s*;"
)
_NAMESPACE_ALIAS = re.compile(r"namespace\s+(\w+)\s*=\s*(?:::\s*)?([\w:\s]+?)\s*;")
_NAMESPACE = re.compile(r"namespace\s+([A-Za-z_][\w:\s]*?)\s*\{")
_CLASS = re.compile(
    r"(?:class|struct)(?:\s*\[\[[^\]]*\]\])?(?:\s+[A-Z][A-Z0-9_]{3,}(?:\s*\([^()]*\))?(?=\s+\w))?\s+([A-Za-z_][\w:]*)"
)
_QUALIFIERS = re.compile(r"\b(?:const|volatile|typename|class|struct|mutable|static|constexpr|inline)\b")
_TEMPLATE = re.compile(r"([\w:\s]+?)\s*<(.*)>\s*((?:::\s*\w+\s*)*)\Z", re.DOTALL)
_VARIABLE = re.compile(r"\s+[A-Za-z_]\w*\s*(?=[({])")
_CLOSED = re.compile(r"\s*>\s*(?=\()")
_MADE = re.compile(r"\s*(?:(?:std|boost)\s*)?(?:::\s*)?(make_shared|make_unique|allocate_shared)\s*<")
_AUTO = re.compile(r"\s*([=:])\s*")
_LONGEST_ALIAS = 2000
_NOT_BEFORE = re.compile(r"(?:\b(?:class|struct|enum|namespace|goto|typename)\s+|[#\"'])\Z")


def _statement(text: str, at: int) -> str:
    """What stands from a place on up to a semicolon, with single blanks; cut where it is longer than any alias."""
    end = text.find(";", at, at + _LONGEST_ALIAS)
    return " ".join(text[at : end + 1].split()) if end >= 0 else ""


class Type(NamedTuple):
    """What an expression is. name: the full name of a known class, or the name of one that the package declares itself
    (own). pointer: members are reached by `->`. several: a sequence of them."""

    name: str
    own: bool = False
    pointer: bool = False
    several: bool = False


class Text:
    """What one text tells whoever includes it, each thing read when it is asked for."""

    def __init__(self, text: str):
        self.text = text

    @cached_property
    def _at_using(self) -> tuple[int, ...]:
        return tuple(standing("using", self.text))

    @cached_property
    def _at_namespace(self) -> tuple[int, ...]:
        return tuple(standing("namespace", self.text))

    @cached_property
    def regions(self) -> tuple[Region, ...]:
        """Its namespaces, classes and functions."""
        return regions(self.text)

    @cached_property
    def classes(self) -> dict[str, list[Region]]:
        """Its classes by the last part of their name."""
        found: dict[str, list[Region]] = {}
        for region in self.regions:
            if region.kind == "class":
                found.setdefault(region.name.rpartition("::")[2], []).append(region)
        return found

    @cached_property
    def aliases(self) -> dict[str, str]:
        """Names that it gives to types."""
        found = {}
        for at in (*self._at_using, *standing("typedef", self.text)):
            match = _ALIAS.match(_statement(self.text, at))
            if match is not None and match.group(1):
                found[match.group(1)] = match.group(2)
            elif match is not None:
                found[match.group(4)] = match.group(3)
        return found

    @cached_property
    def using(self) -> dict[str, str]:
        """Names that `using a::b` makes known, in full."""
        found = {}
        for at in self._at_using:
            match = _USING.match(self.text, at)
            if match is not None:
                full = "".join(match.group(1).split())
                found[full.rpartition("::")[2]] = full
        return found

    @cached_property
    def opened(self) -> tuple[str, ...]:
        """Namespaces that `using namespace` opens."""
        matches = (_USING_NAMESPACE.match(_statement(self.text, at)) for at in self._at_using)
        return tuple(dict.fromkeys("".join(match.group(1).split()) for match in matches if match is not None))

    @cached_property
    def spaces(self) -> dict[str, str]:
        """Other names of namespaces."""
        matches = (_NAMESPACE_ALIAS.match(_statement(self.text, at)) for at in self._at_namespace)
        return {match.group(1): "".join(match.group(2).split()) for match in matches if match is not None}

    @cached_property
    def own_spaces(self) -> tuple[str, ...]:
        """Namespaces that it may add to."""
        found: list[str] = []
        for at in self._at_namespace:
            match = _NAMESPACE.match(self.text, at)
            if match is not None:
                name = "".join(match.group(1).split())
                found += [name, *(f"{outer}::{name}" for outer in found[-3:] if outer != name)]
        return tuple(dict.fromkeys(found))

    @cached_property
    def defined(self) -> frozenset[str]:
        """Last parts of all names that stand behind `class` or `struct`."""
        found = set()
        for word in ("class", "struct"):
            for at in standing(word, self.text):
                match = _CLASS.match(self.text, at)
                if match is not None:
                    found.add(match.group(1).rpartition("::")[2])
        return frozenset(found)


@lru_cache(maxsize=1024)
def told(text: str) -> Text:
    """What a text tells; many files of a package share its headers."""
    return Text(text)


class ApiUses:
    """Uses in one C++ file. text: visible text (comments and literals blank) of the file; headers: those of the
    package's headers that reach it. heads: first parts of the paths of other packages' headers that reach it."""

    def __init__(self, text: str, headers: Iterable[str], vocabulary: Vocabulary, heads: Collection[str] = ()):
        self.text, self.headers, self.vocabulary, self.heads = text, tuple(headers), vocabulary, heads
        self.told = told(text)
        self._texts = (self.told, *(told(header) for header in self.headers))
        self._variables: dict[str, list[tuple[int, Type | None]]] = {}
        self._types: dict[str, Type | None] = {}
        self._meanings: dict[str, tuple[str, ...]] = {}
        self._by_name: dict[str, Type | None] = {}
        self._meanings_of: dict[tuple[str, int, int], Type | None] = {}

    def found(self, words: Iterable[str]) -> Iterator[Found]:
        """Every use of a name that is looked for and whose last part is among the words."""
        home = self.vocabulary.home
        for word in words:
            if word in ASSIGNING:
                places = ((self._assigned(word, match.start()),) for match in _ASSIGNMENTS[word].finditer(self.text))
            else:
                places = ((self._at(word, at), self._construction(word, at)) for at in standing(word, self.text))
            for place in places:
                for found in place:
                    if found is not None and found.package not in home and self._differs(found):
                        yield found
        yield from (found for found in self._overrides(frozenset(words)) if found.package not in home)

    def _differs(self, found: Found) -> bool:
        return self.vocabulary.names[found.name].differs(found.how, found.arguments, found.given)

    # -- one place -----------------------------------------------------------------------------------------------------

    def _at(self, word: str, at: int) -> Found | None:
        text, before = self.text, at
        while before and text[before - 1] in " \t\n":
            before -= 1
        if text[before - 2 : before] == "->":
            return self._of_object(word, at, before - 2, "->")
        if text[before - 1 : before] == "." and text[before - 2 : before] != "..":
            return self._of_object(word, at, before - 1, ".")
        if text[before - 2 : before] == "::":
            return self._in_scope(word, at, before)
        return self._bare(word, at)

    def _of_object(self, word: str, at: int, end: int, by: str) -> Found | None:
        """`object.word`, `object->word`."""
        steps = chain_before(self.text, end)
        if steps is None:
            if re.search(r"\bthis\s*\Z", self.text[max(0, end - 20) : end]):
                return self._of_this(word, at)
            return None
        type_ = self._chain(steps, end)
        if type_ is None or type_.several or type_.pointer != (by == "->"):
            return None
        return self._member(type_, word, at)

    def _assigned(self, word: str, at: int) -> Found | None:
        """`object += ...`"""
        steps = chain_before(self.text, at)
        type_ = self._chain(steps, at) if steps is not None else None
        if type_ is None or type_.own or type_.several or type_.pointer:
            return None
        member = self.vocabulary.member(type_.name, word)
        return None if member is None else self._use(member[0], at, True, member[1])

    def _member(self, type_: Type, word: str, at: int) -> Found | None:
        if type_.own:
            return self._of_own(type_.name, word, at)
        member = self.vocabulary.member(type_.name, word)
        return None if member is None else self._use(member[0], at, True, member[1])

    def _of_own(self, class_: str, word: str, at: int) -> Found | None:
        member = self._own_member(class_, word)
        return None if member is None else self._use(member[0], at, "" not in member[1], member[1])

    def _in_scope(self, word: str, at: int, end: int) -> Found | None:
        """`scope::word`."""
        begins = scopes_before(self.text, end)
        if begins == end:
            return None
        ahead = self.text[max(0, begins - 40) : begins]
        if _NOT_BEFORE.search(ahead) and not ahead.rstrip().endswith("typename"):
            return None
        scope = without_templates(self.text[begins:end]).removesuffix("::")
        if scope == "std" or scope.startswith("std::"):
            return None
        for full in self._meant(scope):
            name = f"{full}::{word}"
            if name in self.vocabulary.names:
                return self._use(name, at, True, ())
        type_ = self._named(scope)
        if type_ is None or type_.own or type_.pointer:
            return None
        member = self.vocabulary.member(type_.name, word)
        return None if member is None else self._use(member[0], at, True, member[1])

    def _bare(self, word: str, at: int) -> Found | None:
        names, text = self.vocabulary.names, self.text
        ahead = text[max(0, at - 40) : at]
        if _NOT_BEFORE.search(ahead) and not ahead.rstrip().endswith("typename"):
            return None
        if word in names:
            # A macro, a function of C, or a type; what else lies in no namespace may be anybody's.
            known = names[word]
            if known.what in _TYPES:
                return self._use(word, at, True, ()) if self._is_bare_type(word, known.package, at) else None
            if known.what not in ("macro", "function", "enumerator") or "_" not in word or self._own_name(word):
                return None
            return self._use(word, at, known.package in self.heads, ())
        full = self._using.get(word)
        if full is not None:
            return self._use(full, at, True, ()) if full in names else None
        inner = self._of_this(word, at)
        if inner is not None:
            return inner
        for space in self._opened:
            full = f"{space}::{word}"
            if full in names and not self._own_name(word) and names[full].what not in ("method", "field"):
                return self._use(full, at, False, ())
        return None

    def _is_bare_type(self, word: str, package: str, at: int) -> bool:
        """Whether a package's type that lies in no namespace is surely meant: outside of classes and functions, where
        no base class has a name like it, and where nothing makes one known by another way."""
        around = [region for region in self.told.regions if region.start <= at < region.end]
        return (
            package in self.heads
            and not (word.islower() or word.isupper())
            and all(region.kind == "namespace" for region in around)
            and not any(self.vocabulary.knows(region.name.partition("::")[0]) for region in around)
            and not any(text.opened or word in text.aliases or word in text.using for text in self._texts)
            and not self._own_name(word)
        )

    def _of_this(self, word: str, at: int) -> Found | None:
        """A member of the class around a place that one of its bases in another package has."""
        if not self.vocabulary.of_classes(word):
            return None
        class_ = self._class_around(at)
        if class_ is None:
            return None
        behind = _SPACE.match(self.text, at + len(word))
        follows = self.text[behind.end() : behind.end() + 1] if behind else ""
        ahead = self.text[max(0, at - FAR) : at]
        if follows == "(" and declares_next(ahead):
            return None
        end = at + len(word)
        if any(it == end or (it < at and in_scope(self.text, it, at)) for it, *_ in declarations_of(word, self.text)):
            return None
        return self._of_own(class_, word, at)

    def _construction(self, word: str, at: int) -> Found | None:
        """A constructor that is called where the name of its class stands."""
        owners = self.vocabulary.constructors(word)
        if not owners:
            return None
        begins = scopes_before(self.text, at)
        written = without_templates(self.text[begins:at]) + word
        type_ = self._named(written)
        if type_ is None or type_.own or f"{type_.name}::{word}" not in owners:
            return None
        end, templated = at + len(word), False
        opened = _SPACE.match(self.text, end).end()  # type: ignore[union-attr]
        if self.text.startswith("<", opened):
            types = template_arguments(self.text, opened + 1)
            if types is None:
                return None
            end, templated = types.end(), True
        ahead = self.text[max(0, begins - FAR) : begins]
        closed = _CLOSED.match(self.text, end)
        variable = _VARIABLE.match(self.text, end)
        if closed is not None:
            if not re.search(r"\b(?:make_shared|make_unique)\s*<\s*\Z", ahead):
                return None
            opened = closed.end()
        elif variable is not None:
            if not self._in_function(at):
                return None
            opened = variable.end()
        else:
            opened = _SPACE.match(self.text, end).end()  # type: ignore[union-attr]
            if not self.text.startswith("(", opened) or declares_next(ahead):
                return None
            if not re.search(r"(?:(?<!:):|,)\s*\Z", ahead) and not self._in_function(at):
                return None
        count, given = given_to(self.text, opened)
        name = f"{type_.name}::{word}"
        package = self.vocabulary.names[name].package
        return Found(package, name, at, "call", count, given, templated, True, ())

    def _in_function(self, at: int) -> bool:
        return any(region.kind == "function" and region.start <= at < region.end for region in self.told.regions)

    def _use(self, name: str, at: int, sure: bool, through: tuple[str, ...]) -> Found:
        """The use that a name at a place is."""
        known = self.vocabulary.names[name]
        end = at + len(name.rpartition("::")[2])
        templated, how, count, given = False, "name", -1, ()
        opened = _SPACE.match(self.text, end).end()  # type: ignore[union-attr]
        if self.text.startswith("<", opened):
            types = template_arguments(self.text, opened + 1)
            if types is not None:
                templated, opened = True, _SPACE.match(self.text, types.end()).end()  # type: ignore[union-attr]
        if known.what in CALLED and self.text.startswith("(", opened):
            how = "call"
            count, given = given_to(self.text, opened)
        return Found(known.package, name, at, how, count, given, templated, sure, through)

    # -- names ---------------------------------------------------------------------------------------------------------

    @cached_property
    def _using(self) -> dict[str, str]:
        """Names that `using a::b` makes known, in full; the file's own count first."""
        return {word: full for text in reversed(self._texts) for word, full in text.using.items()}

    @cached_property
    def _opened(self) -> tuple[str, ...]:
        """Namespaces whose names can be written without them: those of `using namespace`, and of other packages that
        the file adds to."""
        found: dict[str, None] = {}
        for text in self._texts:
            found.update(dict.fromkeys(text.opened))
        found.update(dict.fromkeys(self.told.own_spaces))
        return tuple(found)

    def _meant(self, scope: str) -> tuple[str, ...]:
        """The full names that scopes as written can stand for."""
        found = self._meanings.get(scope)
        if found is None:
            found = self._meanings[scope] = tuple(dict.fromkeys(self._all_meant(scope)))
        return found

    def _all_meant(self, scope: str) -> Iterator[str]:
        yield scope
        head, _, rest = scope.partition("::")
        rest = f"::{rest}" if rest else ""
        for text in self._texts:
            meant = text.spaces.get(head) or text.using.get(head)
            if meant is None and head in text.aliases:
                meant = without_templates(_QUALIFIERS.sub(" ", text.aliases[head]).replace("*", "").replace("&", ""))
            if meant and meant != head:
                yield meant + rest
                deeper = meant.partition("::")[0]
                for other in self._texts:
                    if deeper in other.spaces:
                        yield other.spaces[deeper] + meant[len(deeper) :] + rest
        for space in self._opened:
            yield f"{space}::{scope}"

    def _own_name(self, word: str) -> bool:
        """Whether the file or a header of the package that reaches it declares a name itself."""
        if any(f"define {word}" in text for text in (self.text, *self.headers)):
            return True
        return any(word in told_by.defined for told_by in self._texts) or any(
            declarations_of(word, text) for text in (self.text, *self.headers)
        )

    # -- own classes ---------------------------------------------------------------------------------------------------

    def _class_around(self, at: int) -> str | None:
        """The class whose member the code at a place is."""
        found = None
        for region in self.told.regions:
            if region.start > at:
                break
            if region.end < at:
                continue
            if region.kind == "class" or (region.kind == "function" and region.name):
                found = region.name.rpartition("::")[2]
        return found

    def _directly_in_class(self, at: int) -> bool:
        """Whether what stands at a place is declared right in a class."""
        around = [region for region in self.told.regions if region.start <= at < region.end]
        return bool(around) and around[-1].kind == "class"

    def _own(self, class_: str) -> list[tuple[str, Region]]:
        """The texts in which the package defines a class of this name, and where."""
        return [
            (text.text, region)
            for text in self._texts
            if class_ in text.defined
            for region in text.classes.get(class_, ())
        ]

    def _own_member(self, class_: str, word: str, depth: int = 0) -> tuple[str, tuple[str, ...]] | None:
        """The changing name of another package that a member of an own class is, by its bases, and the packages in
        between, with an empty one where a base is not known."""
        homes = self._own(class_)
        if len(homes) != 1 or depth > 6:
            return None
        text, region = homes[0]
        if _declared_in(text, region.start, region.end, word):
            return None
        found, strange = None, False
        for base in region.bases:
            type_ = self.type_of(base)
            if type_ is None:
                strange = strange or not base.startswith("std::")
            elif type_.own:
                found = found or self._own_member(type_.name, word, depth + 1)
            else:
                found = found or self.vocabulary.member(type_.name, word)
        if found is not None and strange:
            return found[0], (*found[1], "")
        return found

    # -- types ---------------------------------------------------------------------------------------------------------

    def _named(self, name: str) -> Type | None:
        """The class that a name without template arguments is."""
        if name not in self._by_name:
            self._by_name[name] = self._find_named(name)
        return self._by_name[name]

    def _find_named(self, name: str) -> Type | None:
        classes = self.vocabulary.classes
        if "::" not in name and self._own(name):
            return Type(name, own=True)
        for full in self._meant(name):
            if full in classes:
                return Type(full)
        head, _, last = name.rpartition("::")
        if head and _POINTED.fullmatch(last):
            inner = self._named(head)
            return inner._replace(pointer=True) if inner is not None else None
        shorter = _SUFFIX.sub("", name)
        if shorter and shorter != name and not shorter.endswith("::"):
            inner = self._named(shorter)
            return inner._replace(pointer=True) if inner is not None and not inner.own else None
        return None

    def type_of(self, written: str, depth: int = 0) -> Type | None:
        """What a type as written is; None where it is no class that is known."""
        if depth > 6:
            return None
        if written in self._types:
            return self._types[written]
        text = _QUALIFIERS.sub(" ", written).strip()
        pointer = text.endswith("*")
        text = text.rstrip("*& \n\t")
        found = None
        template = _TEMPLATE.fullmatch(text)
        outer = without_templates(template.group(1) if template else text).removeprefix("::")
        last = outer.rpartition("::")[2]
        if template and not template.group(3) and last in _POINTERS:
            inner = self.type_of(split_at_commas(template.group(2))[0] if template.group(2).strip() else "", depth + 1)
            found = inner._replace(pointer=True) if inner is not None and not inner.several else None
        elif template and not template.group(3) and last in _SEQUENCES:
            inner = self.type_of(split_at_commas(template.group(2))[0] if template.group(2).strip() else "", depth + 1)
            found = inner._replace(several=True) if inner is not None and not inner.several else None
        else:
            plain = without_templates(text).removeprefix("::")
            meant = None
            if "::" not in plain and not self._own(plain):
                meant = next((t.aliases[plain] for t in self._texts if plain in t.aliases), None)
            found = self.type_of(meant, depth + 1) if meant and meant != written else self._named(plain)
        if found is not None and pointer:
            found = found._replace(pointer=True)
        self._types[written] = found
        return found

    def _chain(self, steps: list[Step], used: int, depth: int = 0) -> Type | None:
        """What a chain of members gives."""
        type_ = self._root(steps[0], used, depth)
        for step in steps[1:]:
            if type_ is None:
                return None
            if step.name == "[]" or step.name in _ELEMENT:
                type_ = type_._replace(several=False) if type_.several else None
            elif step.name in _SAME and type_.pointer and step.by == ".":
                continue
            elif type_.several or type_.pointer != (step.by == "->"):
                return None
            else:
                type_ = self._step(type_, step.name)
        return type_

    def _step(self, type_: Type, name: str) -> Type | None:
        """What a member of an object is: one that the package declares, or whose declaration is known."""
        plain = name.removesuffix("()")
        if type_.own:
            kinds = set()
            for text, region in self._own(type_.name):
                kinds.update(
                    self.type_of(written + mark)
                    for at, written, mark in declarations_of(plain, text)
                    if region.start <= at < region.end
                )
            if len(kinds) == 1:
                return next(iter(kinds))
            if kinds:
                return None
        return None

    def _root(self, step: Step, used: int, depth: int) -> Type | None:
        name = step.name
        if "::" in name:
            if not name.endswith("()"):
                return None
            outer, _, last = name.removesuffix("()").rpartition("::")
            if last in ("make_shared", "make_unique"):
                type_ = self._named(without_templates(outer))
                return type_._replace(pointer=True) if type_ is not None else None
            return None
        known = self._variables.get(name)
        plain = name.removesuffix("()")
        if known is None:
            known = self._variables[name] = [
                (at, None if re.search(r"\bauto\b", written) else self.type_of(written + mark))
                for at, written, mark in declarations_of(plain, self.text)
            ]
        # Where the same declarations come before, in the same block, a name means the same.
        braces = blocks(self.text)
        key = name, sum(at < used for at, _ in known), braces.around(bisect_left(braces.marks, used))
        if key not in self._meanings_of:
            self._meanings_of[key] = self._find(name, plain, known, used, depth)
        return self._meanings_of[key]

    def _find(self, name: str, plain: str, known: list[tuple[int, Type | None]], used: int, depth: int) -> Type | None:
        """The type of a variable, or what a function gives back, by the declarations of its name."""
        types: set[Type | None]
        if not name.endswith("()"):
            for at, type_ in reversed(known):
                if at < used and in_scope(self.text, at, used):
                    return type_ if type_ is not None else self._inferred(plain, at, depth)
            types = {type_ for at, type_ in known if self._directly_in_class(at)}
        else:
            types = {type_ for _, type_ in known}
        for header in self.headers:
            if plain not in header:
                continue
            for _, written, mark in declarations_of(plain, header):
                types.add(self.type_of(written + mark))
        return next(iter(types)) if len(types) == 1 else None

    def _inferred(self, name: str, end: int, depth: int) -> Type | None:
        """The type of `auto x = ...`, from where its name ends."""
        before = self.text[max(0, end - FAR) : end]
        if depth > 4 or not re.search(rf"\bauto\b(?:\s*const)?[\s&*]*{re.escape(name)}\s*\Z", before):
            return None
        given = _AUTO.match(self.text, end)
        if given is None:
            return None
        made = _MADE.match(self.text, given.end())
        if made is not None:
            types = template_arguments(self.text, made.end())
            arguments = split_at_commas(types.group()[:-1]) if types is not None else []
            inner = self.type_of(arguments[0]) if arguments else None
            return inner._replace(pointer=True) if inner is not None else None
        at, opened = given.end(), 0
        while at < len(self.text) and at < given.end() + 2000:
            mark = self.text[at]
            if mark in "({[":
                opened += 1
            elif mark in ")}]":
                opened -= 1
                if opened < 0:
                    break
            elif mark == ";" and opened == 0:
                break
            at += 1
        text = self.text[given.end() : at].strip()
        if text.startswith("*"):
            return None
        if given.group(1) == "=":
            built = re.match(r"((?:\w+\s*::\s*)*\w+)\s*(?:<[^;(){}]*>)?\s*[({]", text)
            whole = arguments_at(text, built.end() - 1) if built else None
            # What a method of the new object gives is something else.
            if built and whole is not None and whole[1] == len(text):
                type_ = self.type_of(text[: built.end() - 1])
                if type_ is not None and not type_.pointer:
                    return type_
        steps = chain_before(self.text, at)
        # The chain has to be all that is assigned.
        if steps is None or not text.startswith(("this", steps[0].name.removesuffix("()").partition("::")[0])):
            return None
        type_ = self._chain(steps, end, depth + 1)
        if type_ is None:
            return None
        if given.group(1) == ":":
            return type_._replace(several=False) if type_.several else None
        return type_

    # -- overrides -----------------------------------------------------------------------------------------------------

    def _overrides(self, words: frozenset[str]) -> Iterator[Found]:
        """Methods that classes of the file declare and that a base in another package has, virtual in some version."""
        names = self.vocabulary.names
        virtual = {word for word in words if any(names[name].virtual for name in self.vocabulary.by_last(word))}
        if not virtual or not self.told.defined:
            return
        for region in self.told.regions:
            if region.kind != "class" or not region.bases:
                continue
            lines = [self._known_bases(base) for base in region.bases]
            for word in sorted(virtual):
                for at, parameters, trailing in _methods(self.text, region, word):
                    for known_line in lines:
                        member = self._first(known_line, word)
                        if member is None:
                            continue
                        types = tuple(parameter_type(one) for one in parameters)
                        marks = tuple(mark for mark in ("const", "override") if mark in trailing)
                        if "final" in trailing and "override" not in marks:
                            marks = (*marks, "override")
                        yield Found(names[member[0]].package, member[0], at, "override", len(types), (*types, *marks),
                                    False, True, member[1])  # fmt: skip

    def _known_bases(self, base: str, depth: int = 0) -> list[str]:
        """The known classes that a base stands for, or is derived from."""
        type_ = self.type_of(base)
        if type_ is None or depth > 6:
            return []
        if not type_.own:
            return [type_.name]
        return [
            known
            for _, region in self._own(type_.name)
            for inner in region.bases
            for known in self._known_bases(inner, depth + 1)
        ]

    def _first(self, classes: Iterable[str], word: str) -> tuple[str, tuple[str, ...]] | None:
        return next((found for one in classes if (found := self.vocabulary.member(one, word)) is not None), None)


def _methods(text: str, region: Region, word: str) -> Iterator[tuple[int, list[str], frozenset[str]]]:
    """Where a class declares a method of a name: its place, parameters, and what stands behind them."""
    for at in standing(word, text[region.start : region.end]):
        at += region.start
        opened = _SPACE.match(text, at + len(word)).end()  # type: ignore[union-attr]
        if not text.startswith("(", opened) or not declares_next(text[max(region.start, at - FAR) : at]):
            continue
        if text.count("{", region.start, at) != text.count("}", region.start, at):
            continue  # in a function of the class
        found = arguments_at(text, opened)
        if found is None:
            continue
        parameters, end = found
        if parameters == ["void"]:
            parameters = []
        behind = re.match(r"[^;{]*", text[end : end + FAR])
        yield at, parameters, frozenset(re.findall(r"\w+", behind.group() if behind else ""))


@lru_cache(maxsize=4096)
def _declared_in(text: str, start: int, end: int, word: str) -> bool:
    """Whether a class has a member of a name."""
    return any(start <= at <= end for at, *_ in declarations_of(word, text))


def given_to(text: str, at: int) -> tuple[int, tuple[str, ...]]:
    """How many arguments a call gives whose bracket opens at an offset (-1: not to be told), and what each shows."""
    found = arguments_at(text, at)
    if found is None:
        return -1, ()
    given = found[0]
    for argument in given:
        plain = argument.replace("->", "")
        if "..." in plain or plain.count("<") != plain.count(">") or not plain:
            return -1, ()
    return len(given), tuple(shown_as(argument) for argument in given)


_NUMBER = re.compile(r"[-+]?\d[\d']*[uUlL]*\Z|[-+]?0[xX][0-9a-fA-F]+\Z")
_FLOAT = re.compile(r"[-+]?(?:\d+\.\d*|\.\d+|\d+(?:\.\d*)?[eE][-+]?\d+)[fFlL]?\Z")


def shown_as(argument: str) -> str:
    """What an argument shows itself to be: `text`, `float`, `integer`, `bool`, `lambda`, `bind`, `null`, `this`,
    `*this`, `qos` (an rclcpp::QoS) or `profile` (an rmw_qos_profile_t); empty for the rest."""
    if argument.startswith('"') and argument.endswith('"'):
        return "text"
    if argument.startswith("[") and argument.endswith("}"):
        return "lambda"
    if re.match(r"(?:std|boost)\s*::\s*bind\b", argument):
        return "bind"
    if argument in ("this", "*this"):
        return argument
    if argument.startswith("rmw_qos_profile_") or argument.endswith(".get_rmw_qos_profile()"):
        return "profile"
    if re.match(r"rclcpp\s*::\s*\w*QoS\s*[({]", argument) and argument.endswith((")", "}")):
        return "qos" if argument.count(".") == 0 else ""
    if argument in ("true", "false"):
        return "bool"
    if argument in ("nullptr", "NULL"):
        return "null"
    if _NUMBER.match(argument):
        return "integer"
    if _FLOAT.match(argument):
        return "float"
    return ""


_DEFAULT = re.compile(r"=(?!=).*\Z", re.DOTALL)
_PARAMETER_NAME = re.compile(r"(?<=[\s&*>])\s*[A-Za-z_]\w*\s*(?:\[\s*\w*\s*\])?\Z")


def parameter_type(parameter: str) -> str:
    """The type of a parameter as it is written, in one form."""
    text = _DEFAULT.sub("", parameter).strip()
    shorter = _PARAMETER_NAME.sub("", text).strip()
    if shorter and not re.fullmatch(r"(?:const|unsigned|signed|struct|class|typename)", shorter):
        text = shorter if not re.fullmatch(r"const\s+[\w:]+", text) else text
    return " ".join(re.sub(r"\s*([<>,&*:]+)\s*", r"\1", text).split())
