"""The C++ names of other packages that a package can mean and that only some stored versions have, or have so.

What the files themselves say is read in cpp/uses.py.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from functools import cached_property, partial
from typing import Generic, NamedTuple, TypeVar

from ...edges.groups import group_pairs
from ...edges.memory import cache_method
from ..facts.cpp.schema import CodeSpot
from ..facts.cpp.syntax import ASSIGNING
from ..facts.surface import Entity
from ..targets.asked_versions import AskedVersions
from ..targets.surface.changes import ChangeEvent, Form, Line
from ..targets.surface.conversions import MEMBERS, Conversions, find_class_taken, takes_other_class
from ..targets.surface.offers import Standing, find_standing
from ..targets.surface.offers_cpp import (
    compare_defaults,
    find_lost_forms,
    is_accepted,
    is_not_deducible,
    list_callable_forms,
    makes_anew,
    may_be_implicit,
    may_have_taken,
    select_refused,
    takes_types,
)
from ..targets.surface.overrides import list_virtual_forms
from ..targets.surface.store import SurfaceHistory

T = TypeVar("T")
CALLED = frozenset(("function", "method", "constructor", "conversion", "macro"))
"""Kinds of names that are called."""
CLASSES = frozenset(("class", "struct", "union"))


class FoundName(NamedTuple):
    """A use of such a name in a text.

    package, name, at: whose, which, and where its last part stands. how: `name`, `call` or `override`. arguments: how
    many a call gives, or an override takes; -1: not to be told. given: of a call, what each argument shows itself to be
    (see ApiUses.classify), or its class; of an override, the types of its parameters, then `const` and `override` where
    they stand. templated: how many template arguments are written, -1 for none, UNREAD where that is not known. sure:
    the name is written with its scopes, or the type of the object shows. through: packages of classes between the
    object's and the one that has the name.
    """

    package: str
    name: str
    at: CodeSpot
    how: str
    arguments: int
    given: tuple[str, ...]
    templated: int
    sure: bool
    through: tuple[str, ...]


class AskedForm(NamedTuple):
    """How a version that is asked about has a changing name. version, last: as stored, it and the one before the last
    change up to it. find_history: gives all versions of a package; None where they are not to be had."""

    standing: Standing
    version: str
    last: str
    first: str
    find_history: Callable[[str], SurfaceHistory | None] | None


class ChangingName:
    """A changing name, as the versions that are asked about have it, worked out where it is needed. what: as in
    surface_changes.Told. lines: its events in the line of each ROS generation, and what makes the forms of them."""

    def __init__(self, package: str, name: str, what: str, lines: tuple[tuple[Sequence[ChangeEvent], _Forms], ...]):
        self.package, self.name, self.what, self._lines = package, name, what, lines
        self._by_count: dict[tuple[int, bool], tuple[bool, bool]] = {}
        self._objects_refused: dict[int, frozenset[int]] = {}

    def add_line(self, events: Sequence[ChangeEvent], forms_of: _Forms) -> ChangingName:
        """The same name with the line of another generation, which goes first and says what it is."""
        return ChangingName(self.package, self.name, events[0].reported[0].what, ((events, forms_of), *self._lines))

    @cached_property
    def forms(self) -> tuple[AskedForm, ...]:
        """How the versions that are asked about have it."""
        return tuple(form for events, forms_of in self._lines for form in forms_of(events))

    @cached_property
    def there(self) -> bool:
        """Whether one of the versions has it not, or warns of it."""
        return any(not one.standing.there or one.standing.deprecated for one in self.forms)

    @cached_property
    def matters(self) -> bool:
        """Whether a use of it may be wrong in one of the versions."""
        return (
            self.there
            or any(_list_other_forms(one.standing) or _has_other_default(one.standing) for one in self.forms)
            or self.virtual
            or self._has_other_template
        )

    @cached_property
    def takes_braces(self) -> bool:
        """Whether braces behind the name of the class call one of these constructors with what they hold: each of the
        versions declares some that make it no aggregate, and none takes all of it as one list."""
        return all(
            any(makes_anew(one, self.name) for one in forms)
            and not any("initializer_list" in type_ for one in forms for type_ in one.types)
            for forms in (list_callable_forms(form.standing.here) for form in self.forms)
        )

    @cached_property
    def virtual(self) -> bool:
        """Whether it is a method that others may override in one of the versions, or in one beside it."""
        return self.what == "method" and any(
            list_virtual_forms(form)
            for standing, *_ in self.forms
            for form in (standing.here, *(f for e in (*standing.past, *standing.future) for f in (e.had, e.has)))
        )

    @cached_property
    def pure(self) -> bool:
        """Whether it is a method that one of the versions makes others implement, and versions beside it do not."""
        if self.what != "method" or not any(
            _is_pure(form) for events, _ in self._lines for event in events for form in (event.had, event.has)
        ):
            return False
        return any(
            _is_pure(here) and ((past and not _is_pure(before)) or (future and not _is_pure(after)))
            for (_, _, here, before, after, past, future), *_ in self.forms
        )

    def differs(
        self, how: str, arguments: int, given: Sequence[Sequence[str]] = (), templated: int = -1
    ) -> bool:
        """Whether a use of it may be wrong in one of the versions. given: by argument, what it may show itself to be,
        empty where that is nothing."""
        if self.there or how in ("override", "implement") or (templated >= 0 and self.may_refuse_types(templated)):
            return True
        if how != "call" or arguments < 0:
            return False
        copied = self.what == "constructor" and may_be_implicit(self.name, (), arguments, given)
        known = self._by_count.get((arguments, copied))
        if known is None:
            known = self._by_count[arguments, copied] = self._differs(arguments, copied)
        return known[templated != -1] or (any(given) and self._may_refuse(arguments, given))

    def _may_refuse(self, arguments: int, given: Sequence[Sequence[str]]) -> bool:
        """Whether one of the versions takes no such arguments, and one beside it may."""
        for one in self.forms:
            here = [form for form in list_callable_forms(one.standing.here) if form.accepts(arguments)]
            refused = select_refused(given, here, takes_other_class)
            if not here or any(is_accepted(form, refused) for form in here):
                continue
            others = (form for other in _list_other_forms(one.standing) for form in list_callable_forms(other))
            if any(form.accepts(arguments) and may_have_taken(form, refused) for form in others):
                return True
        return False

    @cached_property
    def _has_other_template(self) -> bool:
        """Whether its template parameters are not the same in all versions."""
        every = (reported for events, _ in self._lines for event in events for reported in event.reported)
        return any("template" in one.aspects or "kind" in one.aspects for one in every)

    @cache_method
    def may_refuse_types(self, number: int) -> bool:
        """Whether one of the versions may take no such number of template arguments. number: as in FoundName."""
        if number == -1 or self.what == "constructor" or not self._has_other_template:
            return False
        stored = [self._find_stored(one, self.package) for one in self.forms if one.standing.there]
        return any(one is None or number < 0 or not takes_types(one[0], self.name, one[1], number) for one in stored)

    def may_refuse_objects(self, arguments: int, given: Sequence[Sequence[str]]) -> bool:
        """Whether one of the versions may take no object of some class that one beside it takes, of a call whose
        arguments show themselves to be no more than this."""
        places = self._objects_refused.get(arguments)
        if places is None:
            places = self._objects_refused[arguments] = frozenset(self._list_refused_objects(arguments))
        return any(place >= len(given) or not given[place] for place in places)

    def _list_refused_objects(self, arguments: int) -> Iterator[int]:
        """The places of such arguments among so many."""
        owner = self.name.rpartition("::")[0]
        for one in self.forms if self.what in MEMBERS and arguments > 0 else ():
            here = [form for form in list_callable_forms(one.standing.here) if form.accepts(arguments)]
            others = (form for other in _list_other_forms(one.standing) for form in list_callable_forms(other))
            conversions = Conversions(self.package, partial(self._find_stored, one))
            for form in others if here else ():
                for place, type_ in enumerate(form.types[:arguments] if form.accepts(arguments) else ()):
                    written = find_class_taken(type_)
                    refusing = [each.types[place] for each in here if place < len(each.types)]
                    others_taken = all(takes_other_class(each, f"::{written}") for each in refusing)
                    if len(refusing) < len(here) or not others_taken:
                        continue
                    given = conversions.find_class(written, owner)
                    if given and all(conversions.is_refused(self.name, each, given) for each in refusing):
                        yield place

    def _find_stored(self, form: AskedForm, package: str) -> tuple[SurfaceHistory, str] | None:
        """What is stored of a package, and the version in question of this one, or the newest of another."""
        history = form.find_history(package) if form.find_history is not None else None
        return history and (history, form.version if package == self.package else history.versions[-1])

    def _differs(self, arguments: int, implicit: bool) -> tuple[bool, bool]:
        """Whether a call with so many arguments may be wrong, and the same where its template arguments are written.
        implicit: it may be one of a constructor that the compiler makes, where no header declares others."""
        unwritten = False
        for standing, version, last, first, find_history in self.forms:
            declared = list_callable_forms(standing.here)
            here = [one for one in declared if one.accepts(arguments)]
            made = implicit and (arguments > 0 or may_be_implicit(self.name, declared, arguments, ()))
            if not here:
                others = (one for form in _list_other_forms(standing) for one in list_callable_forms(form))
                if not made and any(one.accepts(arguments) for one in others):
                    return True, True
                continue
            relying = not made and _has_other_default(standing)
            if (
                relying
                and all(one.most < 0 or arguments < one.most for one in here)
                and (
                    find_history is None
                    or compare_defaults(find_history(self.package), self.name, last, first, arguments)
                )
            ):
                return True, True
            if not unwritten and any(one.accepts(arguments) for one in find_lost_forms(standing.before, standing.here)):
                # An argument of a template may have to be written.
                known = find_history(self.package) if find_history is not None else None
                forms = standing.here, standing.before
                unwritten = known is None or is_not_deducible(known, self.name, *forms, version, last, arguments)
        return unwritten, False


def _list_other_forms(standing: Standing) -> list[Form]:
    """The forms that other versions have and that are not as one has it."""
    forms = (*(event.had for event in standing.past), *(event.has for event in standing.future))
    return [form for form in forms if form is not None and form != standing.here]


def _has_other_default(standing: Standing) -> bool:
    """Whether the last change up to a version was one of defaults alone, which forms do not tell."""
    return bool(standing.past) and all(reported.kind == "default" for reported in standing.past[-1].reported)


def _is_pure(form: Form | None) -> bool:
    """Whether a form makes others implement it."""
    return any("pure" in one.traits for one in list_virtual_forms(form))


class PackageNames:
    """What is asked of one package again and again. names: changing names of C++. bases: classes with the full names of
    their bases. classes: every class that shows, to the package."""

    def __init__(self, names: dict[str, ChangingName], bases: dict[str, tuple[str, ...]], classes: dict[str, str]):
        self.names, self.bases, self.classes = names, bases, classes

    @cached_property
    def by_last(self) -> dict[str, list[str]]:
        """The changing names by their last part, also those of which no use can matter."""
        return group_pairs((full.rpartition("::")[2], full) for full in self.names)

    @cached_property
    def derived(self) -> dict[str, dict[str, None]]:
        """Last parts of classes by the last part of a base."""
        found: dict[str, dict[str, None]] = {}
        for full, those in self.bases.items():
            for base in those:
                found.setdefault(base.rpartition("::")[2], {})[full.rpartition("::")[2]] = None
        return found

    @cached_property
    def heads(self) -> tuple[str, ...]:
        """First parts of bases: packages that may have them."""
        every = (base for those in self.bases.values() for base in those)
        return tuple(dict.fromkeys(base.partition("::")[0] for base in every if "::" in base))

    @cached_property
    def pure(self) -> dict[str, list[str]]:
        """Classes with their methods that only some versions make others implement."""
        return group_pairs((full.rpartition("::")[0], full) for full, name in self.names.items() if name.pure)

    @cached_property
    def constructed(self) -> frozenset[str]:
        """Last parts of the classes with constructors of which a use can matter."""
        made = (full for full, name in self.names.items() if name.what == "constructor" and name.matters)
        return frozenset(full.rpartition("::")[2] for full in made)

    @cached_property
    def names_begin(self) -> frozenset[str]:
        """First parts of the names, empty for those without scopes."""
        return _begins(self.names)

    @cached_property
    def classes_begin(self) -> frozenset[str]:
        """The same of the classes."""
        return _begins(self.classes)


class Changes:
    """Where what changed in packages is asked for. lines: those of a package by ROS generation, none for one that is
    not known. asked: the versions that a use may be wrong in, all when None."""

    def __init__(
        self,
        lines: Callable[[str], Mapping[int, Line]],
        asked: AskedVersions | None = None,
        history: Callable[[str, int], SurfaceHistory | None] | None = None,
    ):
        self._lines, self._asked, self._history = lines, asked, history

    @cache_method
    def find_package_names(self, package: str, ros: int = 0) -> PackageNames | None:
        """What of a package is not the same in all its versions of a ROS generation (0: of any)."""
        lines = {at: line for at, line in self._lines(package).items() if ros in (0, at)}
        asked = [(line, self._make_forms(package, at, line)) for at, line in lines.items()]
        return _collect_names(package, asked) if lines else None

    def list_types(self, package: str, ros: int, name: str, kinds: Collection[str]) -> frozenset[str]:
        """The types that the versions asked about (the last one stored when that is any) declare for a name, as
        written there; empty where one of them declares it as a template, or none declares it. kinds: of Entity."""
        found = list(self._list_entities(package, ros, name))
        if any(entity.template is not None for entity in found):
            return frozenset()
        return frozenset(entity.type for entity in found if entity.kind in kinds)

    def declares(self, package: str, ros: int, name: str) -> bool:
        """Whether one of these versions declares a name."""
        return any(True for _ in self._list_entities(package, ros, name))

    def _list_entities(self, package: str, ros: int, name: str) -> Iterator[Entity]:
        for at in self._lines(package):
            history = self._history(package, at) if self._history is not None and ros in (0, at) else None
            if history is None:
                continue
            asked = self._asked.list_asked(package, at) if self._asked is not None else ((history.versions[-1], False),)
            for version, ahead in asked:
                yield from history.iterate_entities(name, version) if not ahead else ()

    def _make_forms(self, package: str, ros: int, line: Line) -> _Forms:
        """What gives, of the events of a name of C++ in a line, how the versions that are asked about have it."""
        places: dict[int, bool] = {}
        for version, ahead in self._asked.list_asked(package, ros) if self._asked is not None else ():
            place = line.find_place(version)
            if place is not None:
                places[place] = ahead and places.get(place, True)
        find = self._history
        history = (lambda other: find(other, ros)) if find is not None else None
        every = self._asked is None
        return lambda events: tuple(
            _list_asked_forms(events, line, _list_event_places(events) if every else places, history)
        )  # fmt: skip


_Forms = Callable[[Sequence["ChangeEvent"]], tuple[AskedForm, ...]]


def _list_event_places(events: Sequence[ChangeEvent]) -> Mapping[int, bool]:
    """The first version, and those that the events are of."""
    return dict.fromkeys((0, *(event.place for event in events)), False)


def _list_asked_forms(
    events: Sequence[ChangeEvent],
    line: Line,
    places: Mapping[int, bool],
    find_history: Callable[[str], SurfaceHistory | None] | None,
) -> Iterator[AskedForm]:
    """How versions have a name. places: of the versions in their line, and of each whether only an update brings it."""
    for place, ahead in places.items():
        standing = find_standing("c++", events, place)
        if ahead and not standing.past:
            continue  # what an update breaks, it changes itself
        if ahead:
            standing = standing._replace(deprecated=False, after=None, future=())
        first = standing.past[-1].place if standing.past else 0
        yield AskedForm(standing, line.versions[place], line.versions[first - 1], line.versions[first], find_history)


_INTERNAL = frozenset(("detail", "details", "internal", "impl", "operator"))
_MEMBERS = frozenset(("method", "field", "constructor", "destructor", "conversion"))


def _collect_names(package: str, lines: Iterable[tuple[Line, _Forms]]) -> PackageNames:
    names: dict[str, ChangingName] = {}
    bases: dict[str, tuple[str, ...]] = {}
    classes: dict[str, str] = {}
    for line, forms_of in lines:
        for full, events in line.events.get("c++", {}).items():
            outer, _, last = full.rpartition("::")
            if not last.isidentifier() and last not in ASSIGNING:
                continue
            if "<" in full or not _INTERNAL.isdisjoint(full.split("::")):
                continue
            before = names.get(full)  # what another generation told of it
            what = events[0].reported[0].what
            if before is None:
                names[full] = ChangingName(package, full, what, ((events, forms_of),))
            else:
                names[full] = before.add_line(events, forms_of)
            if what in _MEMBERS:
                classes[outer] = package
            elif what in CLASSES:
                classes[full] = package
        for full, those in line.bases.items():
            classes[full] = package
            bases[full] = tuple(dict.fromkeys((*bases.get(full, ()), *those)))
    return PackageNames(names, bases, classes)


_KINDS = {"function": ("method", "function"), "variable": ("field", "variable"), "alias": ("alias",)}


class _Union(Generic[T]):
    """Several dictionaries of qualified names as one, in which the first counts. None is copied: a name is looked up in
    those that have names which begin like it. begins: the first parts of their names by dictionary, empty for those
    without scopes."""

    def __init__(self, parts: Iterable[tuple[frozenset[str], Mapping[str, T]]]):
        self._parts = group_pairs((head, names) for begins, names in parts for head in begins)

    def get(self, full: str) -> T | None:
        """What a name stands for; None for one that is not there."""
        head, scoped, _ = full.partition("::")
        for names in self._parts.get(head if scoped else "", ()):
            if full in names:
                return names[full]
        return None

    def __contains__(self, full: str) -> bool:
        return self.get(full) is not None

    def __getitem__(self, full: str) -> T:
        found = self.get(full)
        if found is None:
            raise KeyError(full)
        return found

    def begins(self, head: str) -> bool:
        """Whether names of it begin so."""
        return bool(head) and head in self._parts


def _begins(names: Iterable[str]) -> frozenset[str]:
    return frozenset(name.partition("::")[0] if "::" in name else "" for name in names)


class Vocabulary:
    """What the files of a package (own) can name of some others: changing names, and all classes with their bases. ros:
    the generation that it is built for, 0 for both. home: packages whose names are known but not looked for."""

    def __init__(
        self, packages: Iterable[str], own: str, changes: Changes, ros: int = 0, home: Collection[str] = frozenset()
    ):
        self.home = home
        self._changes, self._ros = changes, ros
        self._known: dict[str, PackageNames] = {}
        waiting = list(packages)
        for package in waiting:  # classes of other packages come along with what is derived from them
            known = changes.find_package_names(package, ros) if package not in self._known and package != own else None
            if known is not None:
                self._known[package] = known
                waiting.extend(known.heads)
        every = self._known.values()
        self.names = _Union((known.names_begin, known.names) for known in every)
        self.classes = _Union((known.classes_begin, known.classes) for known in every)
        """Full name of every known class to its package."""
        self._wanted = [known for package, known in self._known.items() if package not in home]
        self._looked_for: dict[str, bool] = {}
        self.words = frozenset().union(*(known.by_last for known in self._wanted))
        """Last parts of the names of which some may be looked for."""

    def select_wanted(self, words: Collection[str]) -> set[str]:
        """Those of some words that are the last part of a name which is looked for."""
        known = self._looked_for
        for word in words:
            if word not in known:
                known[word] = any(one.names[full].matters for one in self._wanted for full in one.by_last.get(word, ()))
        return {word for word in words if known[word]}

    @cache_method
    def list_by_last(self, word: str) -> tuple[str, ...]:
        """Changing names that end so and of which a use can matter."""
        names = (name for one in self._known.values() for name in one.by_last.get(word, ()) if one.names[name].matters)
        return tuple(dict.fromkeys(names))

    def knows(self, package: str) -> bool:
        """Whether a package's names are among these."""
        return package in self._known

    def list_bases(self, full: str) -> tuple[str, ...]:
        """The bases of a class."""
        return self._known[self.classes[full]].bases.get(full, ()) if full in self.classes else ()

    @cache_method
    def list_virtual_speakers(self, word: str) -> frozenset[str]:
        """As list_member_speakers(), for methods that are looked for and that others may override."""
        names = (full for one in self._wanted for full in one.by_last.get(word, ()) if one.names[full].virtual)
        return frozenset().union(*(self.list_speakers(full.rpartition("::")[0]) for full in names))

    def list_lineage(self, full: str) -> list[str]:
        """A class and those that it is derived from, nearest first."""
        found = [full]
        for one in found:
            found.extend(base for base in self.list_bases(one) if base not in found)
        return found

    @cache_method
    def find_member(self, full: str, last: str) -> tuple[str, tuple[str, ...]] | None:
        """The changing name that a member of a class is, with the packages of the classes in between; None where one
        of those has the member itself, which hides that of its base."""
        line = self.list_lineage(full)
        place = next((n for n, one in enumerate(line) if f"{one}::{last}" in self.names), None)
        if place is None:
            return None
        between = [(self.classes.get(one) or "", f"{one}::{last}") for one in line[:place]]
        if any(package and self._changes.declares(package, self._ros, name) for package, name in between):
            return None
        return f"{line[place]}::{last}", tuple(dict.fromkeys(package for package, _ in between))

    @cache_method
    def find_member_types(self, full: str, last: str, kind: str) -> tuple[str, frozenset[str]]:
        """The class that declares a member of a class, itself or a base of it, and the member's types as written
        there, see Changes.types(); empty ones where none does. kind: `function` for what it gives back, `variable`,
        `alias`."""
        for one in self.list_lineage(full):
            package = self.classes.get(one)
            types = self._changes.list_types(package, self._ros, f"{one}::{last}", _KINDS[kind]) if package else None
            if types:
                return one, types
        return "", frozenset()

    def list_member_speakers(self, word: str) -> frozenset[str]:
        """Last parts of the classes that have a changing member of this name, and of those derived from them."""
        return frozenset().union(*(self.list_speakers(name.rpartition("::")[0]) for name in self.list_by_last(word)))

    def has_space(self, head: str) -> bool:
        """Whether names of a known package begin so."""
        return self.classes.begins(head)

    def list_pure(self, full: str) -> Sequence[str]:
        """The methods of a class that only some versions make others implement."""
        return self._known[self.classes[full]].pure.get(full, ()) if full in self.classes else ()

    @cached_property
    def pure_words(self) -> dict[str, frozenset[str]]:
        """Last parts of the methods that only some versions make others implement, with those of the classes that have
        them, and of those derived from them."""
        owners = ((full.rpartition("::")[2], owner) for known in self._wanted
                  for owner, methods in known.pure.items() for full in methods)  # fmt: skip
        return {
            word: frozenset().union(*map(self.list_speakers, every)) for word, every in group_pairs(owners).items()
        }

    @cached_property
    def speakers_of_pure(self) -> frozenset[str]:
        """Last parts of the classes with methods that only some versions make others implement, and of those derived
        from them."""
        return frozenset().union(*self.pure_words.values())

    def has_pure(self, bases: frozenset[str], words: frozenset[str]) -> bool:
        """Whether a class may lack such a method. bases: words of its bases; words: of the file that defines it."""
        return any(
            word not in words and not speakers.isdisjoint(bases) for word, speakers in self.pure_words.items()
        )

    @cache_method
    def list_constructors(self, word: str) -> tuple[str, ...]:
        """Changing constructors of classes whose name ends so."""
        ending = f"::{word}::{word}"
        return tuple(name for name in self.list_by_last(word) if f"::{name}".endswith(ending))

    @cached_property
    def constructed(self) -> frozenset[str]:
        """Last parts of the classes with changing constructors of which a use can matter."""
        return frozenset().union(*(known.constructed for known in self._wanted))

    @cache_method
    def is_member(self, word: str) -> bool:
        """Whether a member of a class is so called."""
        return any(name.rpartition("::")[0] in self.classes for name in self.list_by_last(word))

    def can_be_meant(self, word: str, near: Iterable[frozenset[str]]) -> bool:
        """Whether a word can be the last part of a name that is looked for. near: the words of the file, and of each
        that it includes: the class or namespace around the name, or a class that is derived from it, has to be there
        too."""
        alone, speakers = self._find_owner_speakers(word)
        return alone or any(not words.isdisjoint(speakers) for words in near)

    @cache_method
    def _find_owner_speakers(self, word: str) -> tuple[bool, frozenset[str]]:
        wanted = [name for name in self.list_by_last(word) if self.names[name].package not in self.home]
        owners = [name.rpartition("::")[0] for name in wanted]
        return "" in owners, frozenset().union(*(self.list_speakers(owner) for owner in owners if owner))

    def list_speakers(self, owner: str) -> frozenset[str]:
        """Last parts of the classes that may have what a class has: one of them stands wherever a member of it is
        used."""
        return self._list_speakers(owner.rpartition("::")[2])

    @cache_method
    def _list_speakers(self, last: str) -> frozenset[str]:
        names = {last: None}
        for name in (waiting := [last]):
            for known in self._known.values():
                for other in known.derived.get(name, ()):
                    if other not in names:
                        names[other] = None
                        waiting.append(other)
        return frozenset(names)
