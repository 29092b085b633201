"""Who gives the constructors of base classes their arguments: in objects of one class it is not what other classes that
derive from the same base give."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence

from ....edges.groups import group_pairs
from ....edges.memory import cache_method
from .code import FlowCode, Fn, Made, Variable
from .types import Cls


def leave_out_passed_over(made: Mapping[Fn, list[Made]], begun: Collection[Fn] = ()) -> dict[Fn, list[Made]]:
    """Who gives the constructors of a class and its bases their arguments, without constructors of bases that run in no
    object: those that only hand on to another one, which the derived classes call themselves. begun: constructors that
    surely run. Where nothing else is left, it is what it was."""
    left = dict(made)
    while True:
        idle = {fn for fn, rows in left.items() if not rows and fn not in begun}
        fewer = {fn: [row for row in rows if row[0] not in idle] for fn, rows in left.items()}
        if fewer == left:
            return {fn: rows or made[fn] for fn, rows in left.items()}
        left = fewer


class Makers:
    """Asks a body of code who gives the constructors of base classes their arguments."""

    def __init__(self, code: FlowCode):
        self.code = code

    @cache_method
    def find_inside(self, cls: Cls) -> Mapping[Fn, Sequence[Made]]:
        """By constructor of a base of a class, who gives it its arguments in objects of the class and of those that
        derive from it; without those where it is not known."""
        inside = {one.key for each in (cls, *self.code.derived.get(cls.key, ())) for one in self.code.list_bases(each)}
        own = {id(row[1]) for key in inside for row in self.code.constructions.get(key, ())}
        found: dict[Fn, list[Made]] = {}
        for one in self.code.list_bases(cls)[1:]:
            for fn in self.code.list_functions(one):
                if fn.is_lambda or not self.code.is_constructor(fn):
                    continue
                callers = ((caller, call.arguments, call.line) for caller, call in self.code.callers.get(fn, ()))
                every = [*callers, *self.code.list_constructed(fn)]
                # An object of the base itself is none of the class.
                itself = {id(row[1]) for row in self.code.constructions.get(one.key, ())}
                rows = [row for row in every if self._is_of(row[0], inside) or id(row[1]) in own]
                found[fn] = [row for row in rows if id(row[1]) not in itself]
        return {fn: rows for fn, rows in leave_out_passed_over(found).items() if rows}

    def _is_of(self, fn: Fn, keys: set[str]) -> bool:
        owner = self.code.find_owner(fn)
        return owner is not None and owner.key in keys

    def find_outer(
        self, key: str, around: Cls, find_makers: Callable[[Fn], Sequence[Made] | None]
    ) -> dict[Fn, Sequence[Made]]:  # fmt: skip
        """Who gives constructors their arguments in objects of a class, where that is not known already. key: of the
        class whose objects are known, empty for none; find_makers: what is known."""
        if key and key in self._list_keys(around):
            return {}
        rows = self.find_inside(around).items()
        return {one: inside for one, inside in rows if not self._is_within(find_makers(one), inside)}

    @cache_method
    def _list_keys(self, cls: Cls) -> frozenset[str]:
        return frozenset(one.key for one in self.code.list_bases(cls))

    @cache_method
    def is_replaced(self, variable: Variable) -> bool:
        """Whether each object of a class is surely given a member by the function that makes it, so that what the
        member is declared with never holds."""
        made = self.code.constructions.get(variable.owner, ()) if variable.kind == "member" else ()
        written = group_pairs(self.code.list_writes(variable)) if made else {}
        for maker, _, line in made:
            around = {place for guard in maker.collect_guards(line) for place in maker.list_guards_around(guard)}
            rows = [each for each in written.get(maker, ()) if each.operator == "=" and each.line >= line]
            sure = (each for each in rows if each.guard < 0 or each.guard in around)
            if all(each.target.startswith("this.") for each in sure):
                return False
        return bool(made)

    @staticmethod
    def _is_within(known: Sequence[Made] | None, rows: Sequence[Made]) -> bool:
        return known is not None and all(row in rows for row in known)

    @cache_method
    def list_own(self, cls: Cls) -> frozenset[Fn]:
        """The functions of a class and of its bases."""
        return frozenset(fn for one in self.code.list_bases(cls) for fn in self.code.list_functions(one))

    def leave_out(self, seen: tuple, cls: Cls) -> tuple:
        """What is being evaluated, without what is of an object of a class: it may be asked for in another one."""
        keys, functions = self._list_keys(cls), self.list_own(cls)
        places = {fn.place for fn in functions}

        def is_own(item: object) -> bool:
            if isinstance(item, Variable):
                return item.owner in (keys if item.kind == "member" else places)
            return isinstance(item, tuple) and item[0] == "returns" and item[1] in functions

        return tuple(item for item in seen if not is_own(item))
