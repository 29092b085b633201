"""Uses in one C++ file of other packages' names that are not the same in all versions: C++ names, overrides, fields."""

import re
from collections.abc import Collection, Iterable, Iterator

from ....edges.groups import group_pairs
from ....edges.memory import cache_method
from ...facts.cpp.schema import CodePlace, CodeSpot, CppClass, Expr, WrittenParameter
from ...facts.cpp.schema import CppUse as Written
from ...facts.cpp.syntax import UNREAD, Mention
from ...targets.surface.overrides import describe_bases, describe_override, spell_type
from ..api import CALLED, CLASSES, ChangingName, FoundName
from ..members import FoundField as FoundMember
from .resolver import CppType, KnownFile, Resolver, locate_class, substitute_class

# The types of quality of service: those of rclcpp, and the structure of rmw which they replaced.
_QOS_TYPES = {
    "qos": re.compile(r"(?:static |const )*rclcpp\s*::\s*\w*QoS\s*&?"),
    "profile": re.compile(r"(?:static |const |struct )*rmw_qos_profile_[ts]\s*&?"),
}
_CLASS = re.compile(r"(?:const )?((?:\w+::)+\w+)&?")
_DEEPEST = 8
_INTERFACES = ("::msg", "::srv", "::action")
_EMPLACING = {"emplace_back": "sequence", "emplace": "pointer"}
_TYPES = CLASSES | {"alias", "enum"}


class ApiUses:
    """Uses of C++ names of other packages. heads: first parts of the paths of other packages' headers that reach the
    file. unresolved: places of members that may be such names, of objects whose type is not known, in a file that
    names a class which has such a member."""

    def __init__(self, resolver: Resolver, heads: Collection[str] = ()):
        assert resolver.vocabulary is not None
        self.resolver, self.heads = resolver, heads
        self.vocabulary = resolver.vocabulary
        self.unresolved: set[CodeSpot] = set()

    def find_uses(self, words: Iterable[str]) -> Iterator[FoundName]:
        """Every use of a name that is looked for and whose last part is among the words."""
        words = sorted(words)
        home = self.vocabulary.home
        known = self.resolver.known
        mentions = known.list_mentions(words) if words else ()
        for use in known.list_uses(filter(self._may_matter, mentions)):
            for found in (self._resolve_use(use), self._find_construction(use)):
                if found is not None and found.package not in home and self._differs(found):
                    yield found
        if known.facts.parents:
            declared = {one.word for one in mentions if one.typed and one.call is not None}
            yield from (found for found in self._find_overrides(declared) if found.package not in home)

    def _may_matter(self, mention: Mention) -> bool:
        """Whether a word may be such a use, as far as the text around it shows."""
        vocabulary, word = self.vocabulary, mention.word
        if mention.form == "assigned":
            if not mention.ahead.strip("]").isidentifier():
                return mention.ahead == "]"
            speakers = vocabulary.list_member_speakers(word)
            return mention.ahead.endswith("_") or any(self.resolver.known.mentions(one) for one in speakers)
        if mention.form == "member":
            return vocabulary.is_member(word) and self._may_be_any(vocabulary.list_by_last(word), mention)
        if mention.form != "scoped":
            return mention.form == "bare" and self._may_be_any(self._list_bare(word), mention)
        scope = mention.ahead
        if not scope:  # behind template arguments, or of the global namespace
            return not mention.of_std and self._may_be_any(vocabulary.list_by_last(word), mention)
        head = scope.partition("::")[0]
        if head == "std":
            return False
        full = f"{scope}::{word}"
        known = vocabulary.names.get(full)
        if known is not None and (known.there or _may_differ(known, mention)):
            return True
        if f"{full}::{word}" in vocabulary.list_constructors(word):
            return _may_differ(vocabulary.names[f"{full}::{word}"], mention)
        if known is not None or scope.endswith(_INTERFACES):
            return False
        if scope not in vocabulary.classes and vocabulary.has_space(head):
            return False
        return self._may_be_any(vocabulary.list_by_last(word), mention)

    def _may_be_any(self, names: Iterable[str], mention: Mention) -> bool:
        """Whether one of some names that all end alike may be used in a way that differs between versions."""
        every = map(self.vocabulary.names.__getitem__, names)
        return any(known.there or _may_differ(known, mention) for known in every)

    @cache_method
    def _list_bare(self, word: str) -> list[str]:
        """The names that a word without an object or scopes before it may be: what is around them has to be near."""
        owners = {name: name.rpartition("::")[0] for name in self.vocabulary.list_by_last(word)}
        return [n for n, owner in owners.items() if not owner or self._is_near(self.vocabulary.list_speakers(owner))]

    @cache_method
    def _is_near(self, names: frozenset[str]) -> bool:
        """Whether one of some names stands in the file or in a header of the package that it reaches."""
        return any(not names.isdisjoint(file.words) for file in self.resolver.files)

    def _differs(self, found: FoundName) -> bool:
        given = [(shown,) if shown else () for shown in found.given]
        return self.vocabulary.names[found.name].differs(found.how, found.arguments, given, found.templated)

    def _resolve_use(self, use: Written) -> FoundName | None:
        if use.form == "member":
            return self._find_object_member(use)
        if use.form == "scoped":
            return self._find_scoped(use)
        if use.form == "bare":
            return self._find_bare(use)
        if use.form == "assigned" and use.object is not None:
            type_ = self.resolver.resolve_value(use.object, use.place)
            return self._find_member(type_, use) if type_ is not None and type_.plain else None
        return None

    def _find_object_member(self, use: Written) -> FoundName | None:
        assert use.object is not None
        if use.object.kind == "this":
            return self._find_this_member(use)
        type_ = self.resolver.resolve_value(use.object, use.place)
        if type_ is None:
            if any(self.resolver.known.mentions(one) for one in self.vocabulary.list_member_speakers(use.word)):
                self.unresolved.add(use.at)
            return None
        reached = type_.reach(use.arrow)
        return self._find_member(reached, use) if reached is not None else None

    def _find_member(self, type_: CppType, use: Written) -> FoundName | None:
        if not type_.name:
            return None
        if type_.own:
            return self._find_own_member(type_.name, use)
        member = self.vocabulary.find_member(type_.name, use.word)
        return None if member is None else self._make_use(member[0], use, True, member[1])

    def _find_own_member(self, class_: str, use: Written) -> FoundName | None:
        member = self.resolver.find_own_member(class_, use.word)
        return None if member is None else self._make_use(member[0], use, "" not in member[1], member[1])

    def _find_scoped(self, use: Written) -> FoundName | None:
        """`scope::word`."""
        scope = use.name.rpartition("::")[0]
        if scope == "std" or scope.startswith("std::"):
            return None
        for full in self.resolver.list_meanings(scope, use.place):
            name = f"{full}::{use.word}"
            if name in self.vocabulary.names:
                return None if self.resolver.declares_in(full, use.word) else self._make_use(name, use, True, ())
            if full in self.vocabulary.classes:
                break  # a nearer class of this name, or one of another namespace that is opened as well
        type_ = self.resolver.resolve_name(scope, use.place)
        return self._find_member(type_, use) if type_ is not None and not type_.own and type_.plain else None

    def _find_bare(self, use: Written) -> FoundName | None:
        names, word = self.vocabulary.names, use.word
        if use.local is not None:
            return None
        if word in names:
            # A macro, a function of C, or a type; what else lies in no namespace may be anybody's.
            known = names[word]
            if known.what in _TYPES:
                return self._make_use(word, use, True, ()) if self._is_bare_type(use, known.package) else None
            if known.what not in ("macro", "function", "enumerator") or "_" not in word:
                return None
            return None if self.resolver.declares(word) else self._make_use(word, use, known.package in self.heads, ())
        full = self._find_using(use)
        if full is not None:
            return self._make_use(full, use, True, ()) if full in names else None
        inner = self._find_this_member(use)
        if inner is not None:
            # Without the member, the name is that of the package, if it declares one.
            return None if self.resolver.declares(word) else inner
        for space in (*self._list_namespaces(use.place), *self.resolver.list_opened(use.place)):
            full = f"{space}::{word}"
            if full in names and names[full].what not in ("method", "field") and not self.resolver.declares(word):
                return self._make_use(full, use, False, ())
        return None

    def _list_namespaces(self, place: CodePlace) -> Iterator[str]:
        """The namespaces around a place."""
        around = place.scope
        while around:
            yield around
            around = around.rpartition("::")[0]

    def _find_using(self, use: Written) -> str | None:
        """The full name that a using declaration makes known."""
        for full in use.place.used:
            if full.rpartition("::")[2] == use.word:
                return full
        return next(
            (full for file in self.resolver.files
             if (full := file.using.get(use.word)) is not None), None
        )  # fmt: skip

    def _is_bare_type(self, use: Written, package: str) -> bool:
        """Whether a package's type that lies in no namespace is surely meant: outside of classes and functions, where
        no base class has a name like it, and where nothing makes one known by another way."""
        word, place = use.word, use.place
        return (
            package in self.heads
            and not (word.islower() or word.isupper())
            and not place.function
            and (not place.owner or place.scope != place.owner)
            and not self.vocabulary.knows(place.scope.partition("::")[0])
            and not any(
                file.facts.opened or word in file.using or any(file.list_aliases(word))
                for file in self.resolver.files
            )
            and not self.resolver.declares(word)
        )

    def _find_this_member(self, use: Written) -> FoundName | None:
        """A member of the class around a place that one of its bases in another package has."""
        if not use.place.owner or not self.vocabulary.is_member(use.word):
            return None
        return self._find_own_member(use.place.owner, use)

    def _find_construction(self, use: Written) -> FoundName | None:
        """A constructor that is called where the name of its class stands."""
        if use.call is None or not use.last or use.form in ("member", "assigned") or use.local is not None:
            return None
        owners = self.vocabulary.list_constructors(use.word)
        if not owners:
            return None
        if not use.made and use.form != "initializer" and not use.place.function:
            return None
        found = self._find_constructor(self.resolver.resolve_name(use.name, use.place), use)
        return found if found is not None and found.name in owners else None

    def _find_constructor(self, type_: CppType | None, use: Written) -> FoundName | None:
        """The constructor of a class that a use calls, if it is one that changed."""
        if type_ is None or type_.own or not type_.plain or use.call is None:
            return None
        name = f"{type_.name}::{type_.name.rpartition('::')[2]}"
        known = self.vocabulary.names.get(name)
        if known is None or (use.braced and not known.takes_braces):
            return None
        # These are the class's, so that it is not known how many the constructor has.
        templated = UNREAD if use.template is not None and use.form not in ("member", "initializer") else -1
        count, given = self._describe_arguments(use)
        return FoundName(known.package, name, use.at, "call", count, given, templated, True, ())

    def find_initialized(self, classes: frozenset[str], files: Iterable[KnownFile]) -> Iterator[FoundName]:
        """Constructors of other packages' classes that initializer lists of the file call by the name of a member, and
        those that it calls by a container's emplace_back(). classes: last parts of the classes that may be meant.
        files: where members may be declared."""
        resolver, known = self.resolver, self.resolver.known
        # Those that a constructor initializes are declared where its class is.
        parts = (name.text.split("::")[-2:] for name in known.facts.qualified)
        owners = {one[0] for one in parts if one[0] == one[-1]} | known.type_names
        homes = [file for file in files if not owners.isdisjoint(file.type_names)]
        declared: dict[str, set[str]] = {}
        for file in homes:
            for mention in file.list_mentions(sorted(filter(file.mentions, classes))):
                for name in filter(known.mentions, mention.names):
                    declared.setdefault(name, set()).add(mention.word)
        mentions = known.list_mentions(sorted(declared)) if declared else ()
        listed = (one for one in mentions if one.listed and self._may_construct(declared[one.word], one))
        for use in known.list_uses(listed):
            if use.form == "initializer":
                yield from self._list_differing(resolver.resolve_variable(use.word, use.place), use)
        mentions = known.list_mentions(emplacing) if (emplacing := list(filter(known.mentions, _EMPLACING))) else ()
        for use in known.list_uses(one for one in mentions if self._may_construct(classes, one)):
            value = resolver.resolve_value(use.object, use.place) if use.object is not None else None
            holder = value.reach(use.arrow) if value is not None else None
            if holder is not None and holder.kind == _EMPLACING[use.word]:
                yield from self._list_differing(holder.parts[0], use)

    def _may_construct(self, classes: Iterable[str], mention: Mention) -> bool:
        """Whether arguments behind a word may be those of a constructor that differs between versions, of a class
        whose name ends with one of some words."""
        return any(self._may_be_any(self.vocabulary.list_constructors(one), mention) for one in classes)

    def _list_differing(self, type_: CppType | None, use: Written) -> Iterator[FoundName]:
        """The constructor of a class that a use calls, where that may be wrong."""
        found = self._find_constructor(type_, use)
        if found is not None and found.package not in self.vocabulary.home and self._differs(found):
            yield found

    def _make_use(self, name: str, use: Written, sure: bool, through: tuple[str, ...]) -> FoundName:
        """The use that a name at a place is."""
        known = self.vocabulary.names[name]
        how, count, given = "name", -1, ()
        if known.what in CALLED and use.call is not None and not use.made:
            how = "call"
            count, given = self._describe_arguments(use)
        return FoundName(known.package, name, use.at, how, count, given, _count_types(use), sure, through)

    def _describe_arguments(self, use: Written) -> tuple[int, tuple[str, ...]]:
        """How many arguments a call gives (-1: not to be told), and what each shows itself to be."""
        call = use.call or ()
        if any(argument.kind == "pack" for argument in call):
            return -1, ()
        return len(call), tuple(
            self.classify(argument, use.place) or self.find_class(argument, use.place) for argument in call
        )

    def classify(self, argument: Expr, place: CodePlace) -> str:
        """What an argument shows itself to be: `text`, `float`, `integer`, `bool`, `lambda`, `bind`, `null`, `this`,
        `*this`, `new`, `qos` (an rclcpp::QoS) or `profile` (an rmw_qos_profile_t); empty for the rest."""
        kind = argument.kind
        if kind == "literal":
            return argument.text
        if kind in ("lambda", "this", "new"):
            return kind
        if kind == "unary":
            inner = argument.parts[0] if argument.parts else None
            if inner is not None and argument.text == "*" and inner.kind == "this":
                return "*this"
            if inner is not None and argument.text in "+-" and inner.kind == "literal":
                return inner.text
            return ""
        if kind == "name":
            if argument.text == "NULL":
                return "null"
            made = argument.text.startswith("rmw_qos_profile_")
            return "profile" if made else self._classify_variable(argument, place)
        if kind not in ("call", "braces"):
            return ""
        callee = argument.parts[0] if kind == "call" else None
        name = argument.text if callee is None else callee.text
        if callee is not None and callee.kind == "name" and name in ("std::bind", "boost::bind"):
            return "bind"
        if callee is not None and callee.kind == "member":
            return "profile" if name == "get_rmw_qos_profile" else ""
        return "qos" if re.fullmatch(r"rclcpp\s*::\s*\w*QoS", name) else ""

    def find_class(self, argument: Expr, place: CodePlace) -> str:
        """The full name of the class of another package, or of the message, that an argument is an object of, where its
        type is known or written in full; whether it is a class, those know who have its surface. Empty for the rest."""
        if _is_apart(argument):
            return ""
        type_ = self.resolver.resolve_value(argument, place)
        if type_ is not None:
            if type_.own or not type_.plain or type_.arguments or "::" not in type_.name:
                return ""
            return "" if self.vocabulary.classes[type_.name] in self.vocabulary.home else type_.name
        name = argument.parts[0] if argument.kind == "call" else argument
        is_variable = name is argument and name.kind == "name"
        written = self.resolver.find_written_type(name, place) if is_variable else name.text
        class_ = _CLASS.fullmatch(written)
        if class_ is None or name.kind not in ("name", "braces", "cast") or name.template:
            return ""
        head, *_, last = class_[1].split("::")
        own = head in self.vocabulary.home or any(last in file.type_names for file in self.resolver.files)
        return "" if own else class_[1]

    def _classify_variable(self, name: Expr, place: CodePlace) -> str:
        """The same of a variable, by the type that it is declared with, or by what it begins with; empty where a
        directive stands between its declaration and here, which may leave that out."""
        local = name.local
        if local is not None and local.apart:
            return ""
        if local is not None and "auto" in local.type:
            return self.classify(local.value, place) if local.value is not None and local.how == "variable" else ""
        type_ = self.resolver.find_written_type(name, place)
        return next((shown for shown, known in _QOS_TYPES.items() if known.fullmatch(type_)), "")

    def _find_overrides(self, words: Collection[str]) -> Iterator[FoundName]:
        """Methods that classes of the file declare and that a base in another package has, virtual in some version."""
        names = self.vocabulary.names
        own = (name for name, _ in self.resolver.known.facts.parents)
        bases = collect_bases(own, self.resolver.files) if words else frozenset[str]()
        virtual = {word for word in words if not bases.isdisjoint(self.vocabulary.list_virtual_speakers(word))}
        for class_ in self.resolver.known.declarations.classes if virtual else ():
            if not class_.bases:
                continue
            declared = sorted(virtual.intersection(class_.members))
            lines = (
                [self.resolver.list_known_bases(base, locate_class(class_)) for base in class_.bases]
                if declared
                else []
            )
            for word in declared:
                for method in class_.members[word]:
                    spot = method.at
                    if method.kind != "function" or not method.traits.isdisjoint(("static", "split")) or spot is None:
                        continue
                    for line in lines:
                        member = self._find_first(line, word)
                        if member is None:
                            continue
                        types = tuple(self._spell_parameter(one, class_) for one in method.parameters)
                        marks = tuple(mark for mark in ("const", "override") if mark in method.traits)
                        if "final" in method.traits and "override" not in marks:
                            marks = (*marks, "override")
                        if "override" in marks and (bases := self._list_all_bases(class_, word)):
                            marks = (*marks, describe_bases(bases))
                        given = describe_override(types, marks, normalise_parameter(method.type), class_.name)
                        yield FoundName(names[member[0]].package, member[0], spot, "override", len(types),
                                    given, -1, True, member[1])  # fmt: skip

    def _spell_parameter(self, parameter: WrittenParameter, class_: CppClass) -> str:
        """The type of a parameter of a class's method, with what aliases of the package in it stand for."""
        meant = normalise_parameter(self.resolver.spell_out(parameter.type, class_))
        return spell_type(normalise_parameter(parameter), meant)

    def _list_all_bases(self, class_: CppClass, word: str, depth: int = 0) -> list[tuple[str, str]] | None:
        """The packages and names of the classes of other packages that a class is derived from; None where one of its
        bases is not known, or one of the package may have a member of that name itself."""
        found: list[tuple[str, str]] = []
        for base in class_.bases:
            type_ = self.resolver.find_type(base, locate_class(class_))
            if type_ is None or not type_.name or depth > _DEEPEST:
                return None
            if not type_.own:
                package = self.vocabulary.classes.get(type_.name)
                if package is None:
                    return None
                found.append((package, type_.name))
                continue
            own = self.resolver.list_own_classes(type_.name)
            if len(own) != 1 or own[0].open or word in own[0].members:
                return None
            filled = substitute_class(own[0], type_.arguments) if own[0].template else own[0]
            inner = self._list_all_bases(filled, word, depth + 1)
            if inner is None:
                return None
            found += inner
        return found

    def find_unimplemented(self, exported: Collection[str]) -> Iterator[FoundName]:
        """Methods that a base class in another package makes others implement in some version, and that a class of the
        file does not have of which objects are made. exported: the names of such classes."""
        known = self.resolver.known
        for class_ in known.declarations.classes if known.facts.parents else ():
            if class_.open or class_.template or not _is_among(class_.name, exported):
                continue
            own = self.resolver.list_own_lineage(class_.name)
            if any(one.open for one in own):
                continue
            # A macro may declare it (`MOCK_METHOD1(cancel, void(int))`): where the word stands, it may be there.
            names = [one.name.rpartition("::")[2] for one in own]
            files = [file for file in self.resolver.files if any(map(file.list_classes, names))]
            for one in own:
                for base in one.bases:
                    type_ = self.resolver.find_type(base, locate_class(one))
                    if type_ is None or type_.own or not type_.name:
                        continue
                    for name in self.vocabulary.list_pure(type_.name):
                        package, word = self.vocabulary.names[name].package, name.rpartition("::")[2]
                        if package not in self.vocabulary.home and not any(file.mentions(word) for file in files):
                            yield FoundName(package, name, class_.at, "implement", -1, (), -1, True, ())

    def _find_first(self, classes: Iterable[str], word: str) -> tuple[str, tuple[str, ...]] | None:
        return next((found for one in classes if (found := self.vocabulary.find_member(one, word)) is not None), None)


def collect_bases(names: Iterable[str], files: Iterable[KnownFile]) -> frozenset[str]:
    """Words that the bases of some classes can be named by, by what some files say of these and of aliases. names: the
    last parts of the classes."""
    parents = group_pairs(pair for file in files for pair in file.facts.parents)
    waiting = list(dict.fromkeys(names))
    seen, found = set(waiting), set[str]()
    for name in waiting:
        more = {word for meant in parents.get(name, ()) for word in meant.split()}
        found |= more
        waiting.extend(more - seen)
        seen |= more
    return frozenset(found)


def _count_types(use: Written) -> int:
    """How many template arguments a use has, as in FoundName."""
    if use.template is None:
        return -1
    return UNREAD if any("..." in one for one in use.template) else len(use.template)


def _is_apart(expr: Expr) -> bool:
    """Whether a directive stands between the declaration of a name in an expression and its use."""
    local = expr.local
    begun = local is not None and (local.apart or (local.value is not None and _is_apart(local.value)))
    return begun or any(map(_is_apart, expr.parts))


def _may_differ(known: ChangingName, mention: Mention) -> bool:
    """Whether what follows a name may use it in a way that not all versions take."""
    if known.may_refuse_types(mention.templated):
        return True
    if known.what not in CALLED:
        return False
    given = mention.construction if known.what == "constructor" else mention.call
    if given is None or given.number == UNREAD:
        return given is not None
    return known.differs("call", given.number, given.shown, mention.templated) or (
        known.may_refuse_objects(given.number, given.shown)
    )


def _is_among(class_: str, names: Collection[str]) -> bool:
    """Whether a class is one of those that are named, in full or without the namespaces around."""
    return any(f"::{class_}".endswith(f"::{name}") for name in names)


def normalise_parameter(parameter: WrittenParameter | str) -> str:
    """The type of a parameter in the form that surfaces have."""
    text = parameter if isinstance(parameter, str) else parameter.type
    return " ".join(re.sub(r"\s*([<>,&*:]+)\s*", r"\1", text).split())


_REACHED = ("member", "scoped")


class MemberUses:
    """Uses of fields and constants of other packages' interfaces that some version lacks."""

    def __init__(self, resolver: Resolver):
        assert resolver.scope is not None
        self.resolver, self.scope = resolver, resolver.scope

    def find_uses(self, words: Iterable[str], guess: bool) -> Iterator[FoundMember]:
        """Every use of such a member; guess: also accesses through something whose type does not show, of names that
        only one interface has."""
        known = self.resolver.known
        mentions = known.list_mentions(words) if words else ()
        for use in known.list_uses(one for one in mentions if one.form in _REACHED and one.call is None):
            if use.form == "scoped":
                found = self._find_constant(use)
            elif use.form == "member" and use.call is None:
                found = self._find_field(use, guess)
            else:
                continue
            if found is not None:
                yield found

    def _find_field(self, use: Written, guess: bool) -> FoundMember | None:
        assert use.object is not None
        type_ = self.resolver.resolve_value(use.object, use.place)
        if type_ is None:
            if not guess or "_" not in use.word or self._shows(use.object) or self.resolver.declares(use.word):
                return None
            known = self.scope.definitions.items()
            meant = [(i, s) for i, d in known for s in d.sections if "." not in s and use.word in d.sections[s]]
            return FoundMember(*meant[0], use.word, use.at, False) if len(meant) == 1 else None
        reached = type_.reach(use.arrow)
        if reached is None or reached.interface is None:
            return None
        section = self.scope.find_changed_section(reached.make_interface_type(), use.word)
        return FoundMember(reached.interface, section, use.word, use.at, True) if section is not None else None

    def _shows(self, object_: Expr) -> bool:
        """Whether an object has a declared type of its own that is no interface's."""
        if object_.kind in ("this", "call"):
            return object_.kind == "this"
        if object_.kind != "name":
            return False
        local = object_.local
        if local is not None:
            return "auto" not in local.type
        return any(
            one.kind == "variable" and "auto" not in one.type
            for file in self.resolver.files
            if file.mentions(object_.text)
            for one in (*file.names.get(object_.text, ()), *_list_members(file, object_.text))
        )

    def _find_constant(self, use: Written) -> FoundMember | None:
        """`pkg::msg::Type::CONSTANT`, also through an alias or a part (`Type::Request::CONSTANT`)."""
        type_ = self.resolver.resolve_name(use.name.rpartition("::")[0], use.place)
        if type_ is None or type_.interface is None:
            return None
        if self.scope.find_changed_section(type_.make_interface_type(), use.word) is None:
            return None
        return FoundMember(type_.interface, type_.section, use.word, use.at, True)


def _list_members(file: KnownFile, name: str):
    return [one for class_ in file.declarations.classes for one in class_.members.get(name, ())]
