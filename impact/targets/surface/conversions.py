"""Which objects of classes the parameters of a target's functions take: those of the class, of one derived from it, and
of one that a constructor or a conversion turns into it. What is not known is taken."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from functools import lru_cache

from ....edges.memory import cache_method
from ...facts.surface import CLASSES, FUNCTIONS, Entity
from .changes import make_overload
from .store import SurfaceHistory

MEMBERS = frozenset(("method", "constructor"))
"""Functions of which all overloads are known: to those of a namespace, other packages may add some."""

_NUMBER = r"(?:bool|char|short|int|long|unsigned|float|double|size_t|u?int\d+_t)"
_OBJECT = re.compile(rf"(?:const )?(?!{_NUMBER}\b|std::)((?:\w+::)*[A-Za-z_]\w*)(?<!Ptr)&{{0,2}}")
# What no object of a class is without a conversion of its own, or a second one.
_NO_OBJECT = re.compile(rf"(?:const )?(?:{_NUMBER}\b|std::).*|.*\*")
_MESSAGE = re.compile(r"\w+::msg::\w+")


@lru_cache(maxsize=4096)
def find_class_taken(type_: str) -> str:
    """The class of which a parameter of a type may take an object, or a reference to one, as written; empty for
    templates, pointers, numbers and what lies in std."""
    found = _OBJECT.fullmatch(type_)
    return found[1] if found is not None else ""


def takes_other_class(type_: str, given: str) -> bool:
    """Whether a parameter of a type is of another class than an object that is given. given: what an argument shows
    itself to be, of which names of classes alone have scopes."""
    taken = find_class_taken(type_) if "::" in given else ""
    return taken != "" and taken.rpartition("::")[2] != given.rpartition("::")[2]


def names_class(type_: str, given: str) -> bool:
    """Whether a parameter of a type is of the class that an argument shows itself to be; True where it shows none."""
    return "::" not in given or f"::{given}".endswith(f"::{find_class_taken(type_) or '::'}")


class Conversions:
    """What a version of a package takes. package: whose functions are asked about; of other classes those count that
    lie in a namespace called after their package. find: what is stored of a package, with the version that counts."""

    def __init__(self, package: str, find: Callable[[str], tuple[SurfaceHistory, str] | None]):
        self._package, self._find = package, find

    def is_refused(self, name: str, type_: str, given: str) -> bool:
        """Whether a parameter of a member of a class surely takes no object of another class. name: of the member;
        type_: of the parameter; given: the class, in full."""
        owner = name.rpartition("::")[0]
        _, every = self._list_declared(name)
        if not self._is_plain(owner):
            return False
        if any(one.kind not in FUNCTIONS or one.template is not None or one.macro for one in every):
            return False
        written = find_class_taken(type_)
        around = self._list_lineage(owner)
        if around is None:
            if "::" not in written:
                return False  # a base may declare it
        elif any(self._list_declared(f"{base}::{written.partition('::')[0]}")[1] for base in around[1:]):
            return False
        taken = self.find_class(written, owner)
        if not taken:
            return False
        line, other = self._list_lineage(given), self._list_lineage(taken)
        if line is None or other is None or taken in line or given in other:
            return False
        return not any(map(self._may_convert, line)) and not self._may_construct(taken, line)

    def _may_construct(self, class_: str, line: Sequence[str]) -> bool:
        """Whether a constructor of a class may take an object of another, which has this line of classes."""
        if _MESSAGE.fullmatch(class_):
            return False
        for one in self._list_declared(f"{class_}::{class_.rpartition('::')[2]}")[1]:
            if one.kind != "constructor" or one.template is not None or one.macro:
                return True
            if "explicit" in one.traits or not make_overload(one).accepts(1):
                continue
            type_ = one.parameters[0].type if one.parameters else ""
            found = self.find_class(find_class_taken(type_), class_)
            if not _NO_OBJECT.fullmatch(type_) and (not found or found in line):
                return True
        bases = (self._list_lineage(class_) or ())[1:]
        # Theirs may be taken over.
        return any(self._list_declared(f"{class_}::{base.rpartition('::')[2]}")[1] for base in bases)

    def _may_convert(self, class_: str) -> bool:
        """Whether objects of a class may be converted to others by the class itself."""
        history, _ = self._list_declared(class_)
        return history is not None and class_.rpartition("::")[2] in history.converting

    @cache_method
    def _list_lineage(self, class_: str) -> tuple[str, ...] | None:
        """A class and those that it is derived from; None where one of them is not known."""
        found = [class_]
        for one in found:
            if _MESSAGE.fullmatch(one):
                continue
            if not self._is_plain(one):
                return None
            for base in self._list_declared(one)[1][0].bases:
                full = self.find_class(base.type, one.rpartition("::")[0])
                if not full:
                    return None
                found += [full] if full not in found else []
        return tuple(found)

    def find_class(self, written: str, scope: str) -> str:
        """The full name of the class that a name means in a scope; empty for anything else, and where it is not
        known."""
        if not written or _MESSAGE.fullmatch(written):
            return written
        while True:
            full = f"{scope}::{written}" if scope else written
            if self._list_declared(full)[1]:
                return full if self._is_plain(full) else ""
            if not scope:
                return ""
            scope = scope.rpartition("::")[0]

    def _is_plain(self, class_: str) -> bool:
        """Whether a name is that of one class, and of no template, that is read from its header as a whole."""
        history, every = self._list_declared(class_)
        if history is None or len(every) != 1 or not history.is_understood(class_):
            return False
        return every[0].kind in CLASSES and every[0].template is None and not every[0].arguments and not every[0].macro

    @cache_method
    def _list_declared(self, name: str) -> tuple[SurfaceHistory | None, tuple[Entity, ...]]:
        """What is declared by a name, and what else its package has."""
        for package in dict.fromkeys((self._package, name.partition("::")[0])):
            stored = self._find(package)
            declared = tuple(stored[0].iterate_entities(name, stored[1])) if stored is not None else ()
            if stored is not None and declared:
                return stored[0], declared
        return None, ()
