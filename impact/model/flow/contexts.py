"""The ways in which a function comes to run: through which calls, and in which objects. Of a name that is put together
from several arguments, each way gives what belongs together."""

from __future__ import annotations

from collections.abc import Iterator

from ...facts.flow import FlowCall
from .code import FlowCode, Fn, Made, Variable
from .makers import leave_out_passed_over
from .reaching import LOOPS
from .types import Cls
from .values import FlowValues

_DEEPEST = 4
_MOST = 48


class Contexts:
    """Asks a body of code for the ways to its functions."""

    def __init__(self, code: FlowCode):
        self.code = code
        # By the class and the id() of where its object is made, which the code keeps.
        self._made: dict[tuple[str, int], dict[Fn, list[Made]]] = {}

    def list_contexts(self, fn: Fn, guard: int, values: FlowValues) -> list[FlowValues]:
        """What expressions are worth on each way to a place of a function, in each turn of the loops around. guard: of
        the place; values: in what runs. It is these alone where there is one way, where none is seen, and where there
        are too many."""
        found = [way for turn in self._list_turns(fn, guard, values) for way in self._list_ways(fn, turn, 0)]
        return found if 0 < len(found) <= _MOST else [values]

    @staticmethod
    def _list_turns(fn: Fn, guard: int, values: FlowValues) -> list[FlowValues]:
        """The turns of the loops around a place of a function."""
        found = [values]
        for place in fn.list_guards_around(guard):
            row = fn.facts.guards[place]
            count = values.count_turns(fn, place) if row.kind in LOOPS else 0
            if count > 1 and (fn.place, row.line) not in values.turns and len(found) * count <= _MOST:
                found = [one.limit_to_turn(fn, row.line, turn) for one in found for turn in range(count)]
        return found

    def _list_ways(self, fn: Fn, values: FlowValues, depth: int) -> Iterator[FlowValues]:
        number = 0
        for one in self._list_nearest(fn, values) if depth < _DEEPEST else ():
            caller, inside = one
            for further in self._list_ways(caller, inside, depth + 1):
                number += 1
                if number > _MOST:
                    return
                yield further
        if not number:
            yield values

    def _list_nearest(self, fn: Fn, values: FlowValues) -> Iterator[tuple[Fn, FlowValues]]:
        """What leads to a function: who calls it, or makes the object that it is called in, and what expressions are
        worth then."""
        around = self.code.find_enclosing(fn)
        if fn.is_lambda and around is not None:
            yield from self._list_nearest(around, values)
            return
        called = [row for row in self.code.callers.get(fn, ()) if values.runs(row[0])]
        differs = bool(fn.facts.parameters) or any(self._find_receiver(*row) is not None for row in called)
        if self.code.is_constructor(fn) or not differs or not called:
            yield from self._list_objects(fn, values, None)
            return
        for caller, call in called if fn not in values.way else ():
            held = self._find_receiver(caller, call)
            others = self._find_others(fn, held) if held is not None else {}
            inside = values.limit_to_calls({**others, **values.way, fn: call})
            objects = list(self._list_objects(fn, inside, held)) if held is not None else []
            # Who calls it does not follow from where its object is made.
            for _, limited in objects or [(caller, inside)]:
                yield from ((caller, turn) for turn in self._list_turns(caller, call.guard, limited))

    def _find_others(self, fn: Fn, held: Variable) -> dict[Fn, FlowCall]:
        """Of the methods of a method's class those that are called once on what a variable holds, with that call."""
        owner = self.code.find_owner(fn)
        found: dict[Fn, FlowCall] = {}
        for cls in self.code.list_bases(owner) if owner is not None else ():
            for one in self.code.list_functions(cls):
                rows = self.code.callers.get(one, ()) if one.facts.parameters else ()
                calls = [call for caller, call in rows if self._find_receiver(caller, call) == held]
                if len(calls) == 1:
                    found[one] = calls[0]
        return found

    def _find_receiver(self, caller: Fn, call: FlowCall) -> Variable | None:
        """The variable that holds what a method is called on."""
        head = call.callee.rpartition(".")[0]
        return self.code.identify(head, caller) if head and head != "this" and not head.endswith("()") else None

    def _list_objects(self, fn: Fn, values: FlowValues, held: Variable | None) -> Iterator[tuple[Fn, FlowValues]]:
        """The objects in which a method runs, with who makes them. held: the variable that holds them, None for any;
        those that are made elsewhere than where it is written are not distinguished then."""
        owner = self.code.find_owner(fn)
        if owner is None:
            return
        rows = [
            (cls, row)
            for cls in (owner, *self.code.derived.get(owner.key, ()))
            for row in self.code.constructions.get(cls.key, ())
            if values.runs(row[0])
        ]
        if held is not None:
            rows = self._select_held(rows, held) or rows
        for cls, row in rows:
            chain = self.code.list_bases(cls)
            constructors = [one for each in chain for one in self.code.list_functions(each) if self._begins(one)]
            if any(values.find_makers(one) is not None for one in constructors):
                continue  # it is known already which objects these are
            made = self._made.get((cls.key, id(row)))
            if made is None:
                made = self._made[cls.key, id(row)] = self.find_made(chain, [row])
            limited = values.limit_to_objects({**values.made, **made})
            guard = max(row[0].collect_guards(row[2]), default=-1)
            yield from ((row[0], turn) for turn in self._list_turns(row[0], guard, limited))

    def _select_held(self, rows: list[tuple[Cls, Made]], held: Variable) -> list[tuple[Cls, Made]]:
        """Of places where objects are made those of what a variable holds; none where that is not seen."""
        given = {
            (writer.place, each.line, arguments)
            for writer, each in self.code.list_writes(held)
            for arguments in (each.value.parts, (each.value,))
        }
        given.update((fn.place, call.line, call.arguments) for fn, call in self.code.list_results(held))
        found = [row for row in rows if (row[1][0].place, row[1][2], row[1][1]) in given]
        lines = {(place, line) for place, line, _ in given}
        return found or [row for row in rows if (row[1][0].place, row[1][2]) in lines]

    def _begins(self, fn: Fn) -> bool:
        return not fn.is_lambda and self.code.is_constructor(fn)

    def find_made(self, chain: list[Cls], rows: list[Made] | None) -> dict[Fn, list[Made]]:
        """Who gives the constructors of a class, and of its bases, their arguments in some objects. chain: the class
        with its bases; rows: where the objects are made, None for anywhere."""
        keys = {one.key for one in chain}
        made: dict[Fn, list[Made]] = {}
        for one in chain:
            for fn in self.code.list_functions(one):
                if not self.code.is_constructor(fn):
                    continue
                callers = ((caller, call.arguments, call.line) for caller, call in self.code.callers.get(fn, ()))
                every = [*callers, *self.code.list_constructed(fn)]
                inside = [row for row in every if (owner := self.code.find_owner(row[0])) and owner.key in keys]
                if rows is not None:
                    inside = [row for row in inside if self._may_begin(row[0], chain[0], rows)]
                if rows is not None:
                    own = rows
                else:
                    # Other classes that derive from a base make none of these objects.
                    own = self._list_own_constructed(fn, chain[0]) if one is chain[0] or not inside else ()
                made[fn] = [*inside, *(row for row in own if row in every and row not in inside)]
        return leave_out_passed_over(made, self.code.list_functions(chain[0]))

    def _list_own_constructed(self, fn: Fn, cls: Cls) -> list[Made]:
        """Where objects of a class itself are made by one of its constructors, and not those that derive from it; all
        where there are no others."""
        rows = list(self.code.list_constructed(fn))
        derived = {one.key for one in self.code.derived.get(cls.key, ())}
        owners = ((row, self.code.find_owner(row[0])) for row in rows)
        own = [row for row, owner in owners if not (owner and owner.key in derived and self._begins(row[0]))]
        return own or rows

    def _may_begin(self, fn: Fn, cls: Cls, rows: list[Made]) -> bool:
        """Whether a function of a class or its bases may be what makes objects at some places: of the constructors of
        the class itself, those that are called there, or by others."""
        owner = self.code.find_owner(fn)
        if owner is None or owner.key != cls.key or not self.code.is_constructor(fn):
            return True
        made = self.code.list_constructed(fn)
        return not made or any(row in rows for row in made) or bool(self.code.callers.get(fn))
