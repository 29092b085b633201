"""The C++ names of other packages that a package can mean and that only some stored versions have, or have so.

What the files themselves say is read in cpp/uses.py.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from ..targets.surface.changes import Event, Line, Overload

CALLED = frozenset(("function", "method", "constructor", "conversion", "macro"))
"""Kinds of names that are called."""
CLASSES = frozenset(("class", "struct", "union"))
ASSIGNING = {f"operator{sign}=": f"{sign}=" for sign in "+-*/"}
"""Operators by name that are looked for where they stand behind an object, to the sign that they are written with."""


class Found(NamedTuple):
    """A use of such a name in a text.

    package, name, offset: whose, which, and where its last part stands. how: `name`, `call` or `override`. arguments:
    how many a call gives, or an override takes; -1: not to be told. given: of a call, what each argument shows itself
    to be (see ApiUses.shown); of an override, the types of its parameters, then `const` and `override` where they
    stand. templated: template arguments are written. sure: the name is written with its scopes, or the type of the
    object shows. through: packages of classes between the object's and the one that has the name.
    """

    package: str
    name: str
    offset: int
    how: str
    arguments: int
    given: tuple[str, ...]
    templated: bool
    sure: bool
    through: tuple[str, ...]


class Name:
    """A changing name, by all that happened to it; most of it is worked out where it is asked for. what: as in
    surface_changes.Told. there: some version has it not, or warns of it."""

    def __init__(self, package: str, events: tuple[Event, ...]):
        self.package, self.events = package, events
        self.what = events[0].told[0].what
        self.there = any(t.kind in _COMES_OR_GOES and "overload" not in t.aspects for e in events for t in e.told)

    @cached_property
    def forms(self) -> tuple[tuple[Overload, ...], ...]:
        """The overloads of each form that it had."""
        forms = (form for event in self.events for form in (event.had, event.has) if form is not None)
        return tuple(dict.fromkeys(form.overloads for form in forms))

    @cached_property
    def virtual(self) -> bool:
        """Whether it is a method that some version lets others override."""
        return self.what == "method" and any("virtual" in one.traits for form in self.forms for one in form)

    @cached_property
    def pure(self) -> bool:
        """Whether it is a method that some version makes others implement, and some does not."""
        if self.what != "method":
            return False
        pure = {any("pure" in one.traits for one in form.overloads) if form is not None else False
                for event in self.events for form in (event.had, event.has)}  # fmt: skip
        return len(pure) == 2

    @cached_property
    def typed(self) -> bool:
        """Whether parameters whose types show in a call are of other types in some version."""
        types = [{one.types for one in form} for form in self.forms]
        differing = {type_ for one in types for other in types for those in one ^ other for type_ in those}
        return any(_SHOWING.search(type_) for type_ in differing)

    @cached_property
    def defaults(self) -> bool:
        """Whether a default is another in some version."""
        return any(told.kind == "default" for event in self.events for told in event.told)

    @property
    def matters(self) -> bool:
        """Whether any use of it can be told to differ between versions."""
        return self.there or self.virtual or self.typed or self.defaults or self.counts

    @property
    def counts(self) -> bool:
        """Whether it does not take equally many arguments in all versions."""
        return len({frozenset((one.fewest, one.most) for one in form) for form in self.forms}) > 1

    def differs(self, how: str, arguments: int, given: tuple[str, ...], templated: bool = False) -> bool:
        """Whether a use of it is not the same to all versions."""
        if self.there or how in ("override", "implement"):
            return True
        if how != "call":
            return False
        if self.typed and any(given):
            return True
        if arguments < 0:
            return False
        if self.defaults and any(one.fewest <= arguments < one.most for form in self.forms for one in form):
            return True
        if any(not any(one.accepts(arguments) for one in form) for form in self.forms):
            return True
        # An argument of a template may have to be written.
        return not templated and any(one.most == arguments for one in self._passing)

    @cached_property
    def _passing(self) -> tuple[Overload, ...]:
        """Overloads that not all versions have."""
        kept = set(self.forms[0]).intersection(*self.forms) if self.forms else set()
        return tuple({one for form in self.forms for one in form} - kept)

class Known(NamedTuple):
    """What is asked of one package again and again. names: changing names of C++. by_last: those of which a
    use can matter, by their last part.
    bases: classes with the full names of their bases. classes: every class that shows. derived: last parts of classes
    by the last part of a base. heads: first parts of bases, packages that may have them. pure: classes with
    their methods that only some versions make others implement."""

    names: dict[str, Name]
    by_last: dict[str, tuple[str, ...]]
    bases: dict[str, tuple[str, ...]]
    classes: dict[str, str]
    derived: dict[str, tuple[str, ...]]
    heads: tuple[str, ...]
    pure: dict[str, tuple[str, ...]]


class Changes:
    """Where what changed in packages is asked for. lines: those of a package by ROS generation, none for one that is
    not known."""

    def __init__(self, lines: Callable[[str], Mapping[int, Line]]):
        self._lines = lines
        self._known: dict[tuple[str, int], Known | None] = {}

    def known(self, package: str, ros: int = 0) -> Known | None:
        """What of a package is not the same in all its versions of a ROS generation (0: of any)."""
        key = package, ros
        if key not in self._known:
            lines = [line for generation, line in self._lines(package).items() if ros in (0, generation)]
            self._known[key] = _known(package, lines) if lines else None
        return self._known[key]


_INTERNAL = frozenset(("detail", "details", "internal", "impl", "operator"))
_MEMBERS = frozenset(("method", "field", "constructor", "destructor", "conversion"))


def _known(package: str, lines: Iterable[Line]) -> Known:
    names: dict[str, Name] = {}
    by_last: dict[str, dict[str, None]] = {}
    bases: dict[str, dict[str, None]] = {}
    classes: dict[str, None] = {}
    for line in lines:
        for full, events in line.events.get("c++", {}).items():
            outer, _, last = full.rpartition("::")
            if not last.isidentifier() and last not in ASSIGNING:
                continue
            if "<" in full or not _INTERNAL.isdisjoint(full.split("::")):
                continue
            before = names.get(full)  # what another generation told of it
            name = names[full] = Name(package, events if before is None else (*events, *before.events))
            what = name.what
            if what in _MEMBERS:
                classes[outer] = None
            elif what in CLASSES:
                classes[full] = None
        for full, those in line.bases.items():
            classes[full] = None
            bases.setdefault(full, {}).update(dict.fromkeys(those))
    for full, name in names.items():
        if name.matters:
            by_last.setdefault(full.rpartition("::")[2], {})[full] = None
    derived: dict[str, dict[str, None]] = {}
    heads: dict[str, None] = {}
    pure: dict[str, list[str]] = {}
    for full, name in names.items():
        if name.pure:
            pure.setdefault(full.rpartition("::")[0], []).append(full)
    for full, those in bases.items():
        for base in those:
            derived.setdefault(base.rpartition("::")[2], {})[full.rpartition("::")[2]] = None
            if "::" in base:
                heads[base.partition("::")[0]] = None
    return Known(
        names,
        {last: tuple(fulls) for last, fulls in by_last.items()},
        {full: tuple(those) for full, those in bases.items()},
        dict.fromkeys(classes, package),
        {base: tuple(those) for base, those in derived.items()},
        tuple(heads),
        {owner: tuple(those) for owner, those in pure.items()},
    )


_COMES_OR_GOES = frozenset(("removed", "added", "moved", "deprecated", "access", "deleted"))
_SHOWING = re.compile(
    r"rmw_qos_profile_t|QoS|\bNode\b|Node\*|string|\bchar\*|double|float|bool|(?:shared|unique)_ptr<|Ptr\b"
)


class Vocabulary:
    """What the files of a package (own) can name of some others: changing names, and all classes with their bases. ros:
    the generation that it is built for, 0 for both. home: packages whose names are known but not looked for."""

    def __init__(
        self, packages: Iterable[str], own: str, changes: Changes, ros: int = 0, home: Collection[str] = frozenset()
    ):
        self.home = home
        self.names: dict[str, Name] = {}
        self.classes: dict[str, str] = {}
        """Full name of every known class to its package."""
        self._known: dict[str, Known] = {}
        self._by_last: dict[str, tuple[str, ...]] = {}
        self._members: dict[tuple[str, str], tuple[str, tuple[str, ...]] | None] = {}
        self._speakers: dict[str, frozenset[str]] = {}
        self._constructors: dict[str, tuple[str, ...]] = {}
        self._of_classes: dict[str, bool] = {}
        self._around: dict[str, tuple[bool, frozenset[str]]] = {}
        waiting = list(packages)
        for package in waiting:  # classes of other packages come along with what is derived from them
            known = changes.known(package, ros) if package not in self._known and package != own else None
            if known is not None:
                self._known[package] = known
                waiting.extend(known.heads)
        for known in reversed(self._known.values()):  # the first counts
            self.classes.update(known.classes)
            self.names.update(known.names)
        wanted = (known.by_last for package, known in self._known.items() if package not in home)
        self.words = frozenset().union(*wanted)
        """Last parts of the names that are looked for."""

    def by_last(self, word: str) -> tuple[str, ...]:
        """Changing names that end so and of which a use can matter."""
        known = self._by_last.get(word)
        if known is None:
            names = (name for one in self._known.values() for name in one.by_last.get(word, ()))
            known = self._by_last[word] = tuple(dict.fromkeys(names))
        return known

    def knows(self, package: str) -> bool:
        """Whether a package's names are among these."""
        return package in self._known

    def bases(self, full: str) -> tuple[str, ...]:
        """The bases of a class."""
        return self._known[self.classes[full]].bases.get(full, ()) if full in self.classes else ()

    def line(self, full: str) -> list[str]:
        """A class and those that it is derived from, nearest first."""
        found = [full]
        for one in found:
            found.extend(base for base in self.bases(one) if base not in found)
        return found

    def member(self, full: str, last: str) -> tuple[str, tuple[str, ...]] | None:
        """The changing name that a member of a class is, with the packages of the classes in between."""
        key = full, last
        if key not in self._members:
            between: list[str] = []
            found = None
            for one in self.line(full):
                name = f"{one}::{last}"
                if name in self.names:
                    found = name, tuple(dict.fromkeys(between))
                    break
                between.append(self.classes.get(one, ""))
            self._members[key] = found
        return self._members[key]

    def speakers_of(self, word: str) -> frozenset[str]:
        """Last parts of the classes that have a changing member of this name, and of those derived from them."""
        return frozenset().union(*(self.speakers(name.rpartition("::")[0]) for name in self.by_last(word)))

    def has_space(self, head: str) -> bool:
        """Whether names of a known package begin so."""
        return head in self._spaces

    @cached_property
    def _spaces(self) -> frozenset[str]:
        return frozenset(full.partition("::")[0] for full in self.classes if "::" in full)

    def pure(self, full: str) -> tuple[str, ...]:
        """The methods of a class that only some versions make others implement."""
        return self._known[self.classes[full]].pure.get(full, ()) if full in self.classes else ()

    def constructors(self, word: str) -> tuple[str, ...]:
        """Changing constructors of classes whose name ends so."""
        known = self._constructors.get(word)
        if known is None:
            ending = f"::{word}::{word}"
            known = tuple(name for name in self.by_last(word) if f"::{name}".endswith(ending))
            self._constructors[word] = known
        return known

    def of_classes(self, word: str) -> bool:
        """Whether a member of a class is so called."""
        known = self._of_classes.get(word)
        if known is None:
            known = any(name.rpartition("::")[0] in self.classes for name in self.by_last(word))
            self._of_classes[word] = known
        return known

    def can_be_meant(self, word: str, near: Iterable[frozenset[str]]) -> bool:
        """Whether a word can be the last part of a name that is looked for. near: the words of the file, and of each
        that it includes: the class or namespace around the name, or a class that is derived from it, has to be there
        too."""
        around = self._around.get(word)
        if around is None:
            wanted = [name for name in self.by_last(word) if self.names[name].package not in self.home]
            owners = [name.rpartition("::")[0] for name in wanted]
            speakers = frozenset().union(*(self.speakers(owner) for owner in owners if owner))
            around = self._around[word] = "" in owners, speakers
        return around[0] or any(not words.isdisjoint(around[1]) for words in near)

    def speakers(self, owner: str) -> frozenset[str]:
        """Last parts of the classes that may have what a class has: one of them stands wherever a member of it is
        used."""
        last = owner.rpartition("::")[2]
        found = self._speakers.get(last)
        if found is None:
            names = {last: None}
            for name in (waiting := [last]):
                for known in self._known.values():
                    for other in known.derived.get(name, ()):
                        if other not in names:
                            names[other] = None
                            waiting.append(other)
            found = self._speakers[last] = frozenset(names)
        return found
