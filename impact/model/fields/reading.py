"""Which fields of a message are read by a function that is given it, by all it hands it to, and wherever it is kept.

Sound before clever: what cannot be followed is a reading of all that is handed to it, with the reason why.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import NamedTuple

from ...facts.field_uses import TYPE_TESTS, PathUse
from ...facts.flow import FlowExpr
from ..flow.code import FlowCode, Fn, Variable, get_tail
from ..flow.types import Cls, find_interface, split_name
from .places import UsePlace, Uses, split_path
from .shapes import Path, Shapes, Spot

_MOST = 4_000
_PRINTS = frozenset(("print", "str", "repr", "format"))
_PUBLISHES = frozenset(("publish", "publish_", "Publish"))
_CONTAINERS = frozenset(("list", "deque", "dict", "set", "defaultdict", "OrderedDict", "Queue", "SimpleQueue"))
# Statements of a container that change nothing of what its elements are, and look at none.
_DROPS = frozenset(("erase", "pop_front", "pop_back", "pop", "clear", "reserve", "resize", "reset", "shrink_to_fit"))


class Holder(NamedTuple):
    """A variable that holds a field of the message; () for the whole of it."""

    variable: Variable
    base: Path


class ReadAt(NamedTuple):
    """Where a field is read first."""

    path: str
    line: int


class Escape(NamedTuple):
    """A message, or a part of it, that is handed to what is not followed. field: empty for the whole message."""

    field: Path
    why: str
    path: str
    line: int


class Reading(NamedTuple):
    """reads: leaves by where they are read first. sizes: arrays of messages whose number of elements is asked for.
    escapes: in the order in which they were found; what is below their fields counts as read. holders: variables that
    hold the message, with () for the whole of it, or a field. named: fields that the code names, whatever it does with
    them. typed: messages in it, () for itself, whose class the code asks for."""

    reads: dict[Path, ReadAt]
    sizes: dict[Path, ReadAt]
    escapes: tuple[Escape, ...]
    holders: frozenset[Holder] = frozenset()
    named: frozenset[Path] = frozenset()
    typed: Mapping[Path, ReadAt] = MappingProxyType({})


class FieldReader:
    """Reads for a body of code."""

    def __init__(self, code: FlowCode, uses: Uses, shapes: Shapes):
        self.code, self.uses, self.shapes = code, uses, shapes

    def read_parameter(self, fn: Fn, names: Iterable[str], type_: str) -> Reading:
        """What is read of a message `package/Name` that a function is given as parameters of some names."""
        holders = [Holder(Variable("local", fn.place, name), ()) for name in names]
        return _Walk(self, type_).run(holders)


class _Walk:
    """One message followed."""

    def __init__(self, reader: FieldReader, type_: str):
        self.reader, self.type = reader, type_
        self.code, self.uses, self.shapes = reader.code, reader.uses, reader.shapes
        self.reads: dict[Path, ReadAt] = {}
        self.sizes: dict[Path, ReadAt] = {}
        self.escapes: dict[tuple[Path, str], Escape] = {}
        self.named: dict[Path, ReadAt] = {}
        self.typed: dict[Path, ReadAt] = {}
        self.seen: set[Holder] = set()
        self.left: list[Holder] = []
        self.results = _Results()
        # What is no field of what a local variable holds, with that variable: it may hold something else there.
        self.strange: list[tuple[Variable, UsePlace, Spot]] = []

    def run(self, holders: Iterable[Holder]) -> Reading:
        for holder in holders:
            self.hold(holder.variable, holder.base)
            self.results.open(holder.variable.owner)
        while self.left or self.results.left:
            if len(self.seen) > _MOST:
                self.escapes[(), "held by too many variables"] = Escape((), "held by too many variables", "", 0)
                break
            if self.left:
                self._follow(self.left.pop())
            else:
                self._spread(*self.results.left.pop())
        for variable, place, spot in self.strange:
            if not self._holds_other(variable, place):
                self.escape_at(spot, f"`{place.use.path}` is no field that is known", place)
        self._count_elements()
        escapes, seen, named = tuple(self.escapes.values()), frozenset(self.seen), frozenset(self.named)
        return Reading(self.reads, self.sizes, escapes, seen, named, self.typed)

    def _count_elements(self) -> None:
        """Elements of which nothing is read may still be counted: `for p in points: number += 1`."""
        used = [*self.reads, *self.sizes, *(one.field for one in self.escapes.values())]
        for path, place in self.named.items():
            if path[-1] != "[]":
                continue
            array = path[:-1]
            if not any(one[: len(array)] == array or array[: len(one)] == one for one in used):
                self.sizes.setdefault(array, place)

    def _follow(self, holder: Holder) -> None:
        """All uses of a variable that holds a field."""
        self._check_readable(holder)
        variable = holder.variable
        for place in self.uses.list_uses(variable):
            if variable.kind != "local" or variable.owner != place.fn.place:
                self.results.open(place.fn.place)
            self.judge(place, self._find_spot(place, holder.base), variable)

    def _find_spot(self, place: UsePlace, base: Path) -> Spot:
        return self.shapes.find(self.type, base, split_path(place.use.path)[place.at + 1 :])

    def _holds_other(self, variable: Variable, place: UsePlace) -> bool:
        """Whether a variable holds a field too of which the path of a use is one: `for p in a`, then `for p in b`."""
        others = (holder.base for holder in self.seen if holder.variable == variable)
        return any(self._find_spot(place, base).kind != "none" for base in others)

    def _spread(self, fn: Fn, path: Path) -> None:
        """What is done with a field that a function gives back, where the message may have come from to it."""
        for result in self.uses.list_results(fn):
            if not self.results.take(fn, path, result):
                continue
            self.judge(result, self._find_spot(result, path))

    def hold(self, variable: Variable, base: Path) -> None:
        """A variable that holds a field of the message."""
        holder = Holder(variable, base)
        if holder not in self.seen:
            self.seen.add(holder)
            self.left.append(holder)

    def _check_readable(self, holder: Holder) -> None:
        """What did not parse, or stands in macros, may read anything."""
        variable = holder.variable
        if variable.kind == "local":
            path = variable.owner.split(":", 1)[0]
            fn = next((one for one in self.code.functions_in.get(path, ()) if one.place == variable.owner), None)
            if fn is not None and self.uses.is_unread(path, fn.facts.line, fn.facts.end):
                self.escape(holder.base, "its function is not parsed in full", path, fn.facts.line)
            if self.uses.is_in_macro(variable.name, path):
                self.escape(holder.base, f"a macro reads `{variable.name}`", path, fn.facts.line if fn else 0)
            return
        paths = {cls.source.path for cls in self.code.list_class_bodies(variable.owner)} or {variable.owner}
        for cls in self.code.list_class_bodies(variable.owner):
            paths.update(fn.source.path for fn in self.code.list_functions(cls))
        for path in sorted(paths & self.uses.files.keys()):
            file = self.uses.files[path]
            for first, last in file.unread:
                self.escape(holder.base, f"lines {first} to {last} are not parsed", path, first)
            if variable.name in file.macros:
                self.escape(holder.base, f"a macro reads `{variable.name}`", path, 1)

    def note_read(self, path: Path, at: UsePlace) -> None:
        known = self.reads.get(path)
        here = ReadAt(at.fn.source.path, at.use.line)
        if known is None or here < known:
            self.reads[path] = here

    def escape(self, path: Path, why: str, file: str, line: int) -> None:
        self.escapes.setdefault((path, why), Escape(path, why, file, line))

    def escape_at(self, spot: Spot, why: str, place: UsePlace) -> None:
        self.escape(spot.path, why, place.fn.source.path, place.use.line)

    def judge(self, place: UsePlace, spot: Spot, variable: Variable | None = None) -> None:
        """What a use means for what it is a use of. variable: whose use it is; None for what a function gives back."""
        use = place.use
        if spot.kind != "none" and spot.path:
            self.named.setdefault(spot.path, ReadAt(place.fn.source.path, use.line))
        if use.how == "test" and use.to in TYPE_TESTS and "." not in use.path and spot.kind != "message":
            return  # of a variable that holds a value or an array, which stays what it is
        if use.how in ("write", "change") and not (use.how == "write" and use.to not in ("=", "del", "")):
            return
        if spot.kind == "leaf":
            self.note_read(spot.path, place)
        elif spot.kind == "none" and variable is not None and variable.kind == "local":
            self.strange.append((variable, place, spot))
        elif spot.kind == "none":
            self.escape_at(spot, f"`{use.path}` is no field that is known", place)
        elif use.how == "size":
            if spot.kind == "array":
                self.sizes.setdefault(spot.path, ReadAt(place.fn.source.path, use.line))
        elif use.how == "kept":
            self._judge_kept(place, spot)
        elif use.how == "given":
            self._judge_given(place, spot)
        elif use.how == "added":
            self._judge_added(place, spot)
        elif use.how == "returned":
            self._judge_returned(place, spot)
        elif (use.how == "method" and use.to in _DROPS) or (use.how == "test" and spot.kind == "message"):
            if use.to in TYPE_TESTS:
                self.typed.setdefault(spot.path, ReadAt(place.fn.source.path, use.line))
            return
        elif use.how == "method":
            self.escape_at(spot, f"`{use.to}()` is called on it", place)
        else:
            self.escape_at(spot, _describe(use.how, use.to), place)

    def _judge_kept(self, place: UsePlace, spot: Spot) -> None:
        use, fn = place.use, place.fn
        target = ".".join(part for part in use.to.split(".") if part != "[]")
        if not target or target.startswith("()") or "()" in target:
            self.escape_at(spot, f"kept in `{use.to or 'something'}`", place)
            return
        if use.type.startswith("lambda@"):
            inner = next((one for one in self.code.functions_in[fn.source.path] if one.name.endswith(use.type)), None)
            if inner is None:
                self.escape_at(spot, "captured by a lambda", place)
            else:
                self.hold(Variable("local", inner.place, target), spot.path)
            return
        variable = self.code.identify(target, fn)
        written = use.type if use.type not in ("?", "") else ""
        kind = self.code.resolve_written(written, fn.source, fn.scope) if written else None
        if kind is None and variable.kind != "this":
            text, source, scope = self.code.find_declared_type(variable, fn)
            kind = self.code.resolve_written(text, source, scope) if text else None
        if kind is not None and kind.name and not self._holds(kind.name, spot):
            # What is made of the message by a constructor of the workspace is followed where it is given to that.
            if kind.cls is None or not use.count:
                self.escape_at(spot, f"made into `{get_tail(kind.name)}`", place)
            return
        self._put(target, variable, place, spot, bool(written))

    def _put(self, target: str, variable: Variable, place: UsePlace, spot: Spot, declared: bool = False) -> None:
        """A variable, or what it refers to, becomes the message. declared: it is, here."""
        fn = place.fn
        refers = self._list_referred(variable, fn, place.use.how == "added") if not declared else ()
        if refers is None:
            self.escape_at(spot, f"put into what `{variable.name}` stands for", place)
            return
        if not self._is_variable(target, fn):
            self.escape_at(spot, f"put into `{target.rpartition('.')[0]}`", place)
        elif not self._is_declared(variable, fn):
            self.escape_at(spot, f"kept in `{target}`, which is declared elsewhere", place)
        elif fn.source.facts.language != "cpp" and self._is_property(variable):
            self.escape_at(spot, f"given to `{variable.name}`, which is a property", place)
        else:
            for one in (variable, *refers):
                self.hold(one, spot.path)
                if one.owner != fn.place:
                    self.results.open(one.owner)
            if fn.source.facts.language != "cpp" and variable.kind == "member":
                self._set_properties(variable.name, spot)
                self._set_attribute(variable, spot)

    def _is_property(self, variable: Variable) -> bool:
        """Whether a member is made by `property(...)`, of functions that are not looked for."""
        writes = self.code.list_writes(variable) if variable.kind == "member" else ()
        return any(each.value.kind == "call" and get_tail(each.value.text) == "property" for _, each in writes)

    def _set_properties(self, name: str, spot: Spot) -> None:
        """Gives a field to all methods of a name in Python, of which one may set the property."""
        for one in self.code.by_tail.get(name, ()):
            if one.facts.owner and one.facts.parameters and one.source.facts.language == "python":
                self.hold(Variable("local", one.place, one.facts.parameters[0].name), spot.path)
                self.results.open(one.place)

    def _set_attribute(self, variable: Variable, spot: Spot) -> None:
        """Gives a field to `__setattr__` of the class that a member is of, which is called with the name and the
        value."""
        bodies = self.code.list_class_bodies(variable.owner)
        bases = {base.key for cls in bodies for base in self.code.list_bases(cls)}
        for one in self.code.by_tail.get("__setattr__", ()):
            owner = self.code.find_owner(one)
            if owner is not None and owner.key in bases and len(one.facts.parameters) > 1:
                self.hold(Variable("local", one.place, one.facts.parameters[1].name), spot.path)
                self.results.open(one.place)

    def _list_referred(self, variable: Variable, fn: Fn, adds: bool) -> tuple[Variable, ...] | None:
        """What else a local variable is a name of: what it refers to, where something is put into it. None where that
        is not known. adds: something is added to it, and not assigned."""
        owner = next((one for one in self.code.list_enclosing_chain(fn) if one.place == variable.owner), None)
        if variable.kind != "local" or owner is None:
            return ()
        cpp = fn.source.facts.language == "cpp"
        for parameter in owner.facts.parameters:
            if parameter.name == variable.name:
                refers = "&" in parameter.type or "*" in parameter.type or "Ptr" in parameter.type or not parameter.type
                return None if (refers if cpp else adds) else ()
        found: list[Variable] = []
        for each in owner.assigned.get(variable.name, ()):
            if cpp and each.type and not re.search(r"[&*]|auto|Ptr|_ptr", each.type):
                continue
            if not cpp and not adds:
                continue
            if each.value.kind == "name":
                found.append(self.code.identify(each.value.text, owner))
            elif each.value.kind in ("index", "call", "other", "choice") and not _is_fresh(each.value, cpp):
                if cpp and "&" not in each.type and "*" not in each.type:
                    continue
                return None
        return tuple(found)

    def _judge_added(self, place: UsePlace, spot: Spot) -> None:
        """An argument of a method that adds to a container, or of one of the code's own of that name."""
        use, fn = place.use, place.fn
        target = ".".join(part for part in use.to.split(".")[:-1] if part != "[]")
        if self.code.list_targets(use.to, fn):
            self._judge_given(place, spot)
            return
        if not target or "()" in target:
            self.escape_at(spot, f"given to `{get_tail(use.to)}`", place)
            return
        variable = self.code.identify(target, fn)
        if fn.source.facts.language == "cpp":
            text = self.code.find_declared_type(variable, fn)[0]
            kind = self.code.resolve_variable_type(variable, fn)
            plain = self._holds(kind.name, spot) and not re.search(r"\bset\s*<", text)
        else:
            values = [each.value for _, each in self.code.list_writes(variable)]
            plain = self._is_list(variable, fn, ())
            if variable.kind == "local" and not plain:
                plain = all(value.kind == "name" or _is_fresh(value, False) for value in values) and bool(values)
        if plain:
            self._put(target, variable, place, spot)
        else:
            self.escape_at(spot, f"given to `{use.to}`", place)

    def _is_list(self, variable: Variable, fn: Fn, seen: tuple[Variable, ...]) -> bool:
        """Whether a variable of Python is only ever a container made anew, or a copy of such a variable."""
        if variable in seen:
            return True
        writes = self.code.list_writes(variable)
        return bool(writes) and all(
            _is_fresh(each.value, False)
            or (
                each.value.kind == "call"
                and get_tail(each.value.text) == "copy"
                and each.value.text.count(".")
                and self._is_list(
                    self.code.identify(each.value.text.rpartition(".")[0], writer), writer, (*seen, variable)
                )
            )
            for writer, each in writes
        )

    def _is_declared(self, variable: Variable, fn: Fn) -> bool:
        """Whether a variable is declared in the code, so that nobody else can read it: a member may be that of a base
        class which is not here. Python declares none."""
        if fn.source.facts.language != "cpp" or variable.kind == "local":
            return True
        if variable.kind == "global":
            return bool(self.code.list_constants(variable, fn))
        bodies = self.code.list_class_bodies(variable.owner)
        return any(variable.name in self.code.list_members(cls) for cls in bodies)

    def _is_variable(self, target: str, fn: Fn) -> bool:
        """Whether a path is a variable, or a member of a class of the code: another message, or what is not known, goes
        on with what is put into it."""
        head, _, _ = target.removeprefix("this.").rpartition(".")
        if not head:
            return True
        before = target.rpartition(".")[0]
        kind = self.code.resolve_name_type(before, fn)
        return bool(kind.name) and self.code.find_class_of(kind, fn) is not None

    def _holds(self, name: str, spot: Spot) -> bool:
        """Whether a variable of a type may hold what a field is, and nothing else is made of it."""
        wanted = get_tail(spot.type.replace("/", "::"))
        found = find_interface(name, lower=True)
        tail = get_tail(found.replace("/", "::")) if found else get_tail(name)
        return tail == wanted or tail in (f"{wanted}ConstPtr", f"{wanted}Ptr", f"{wanted}_") or "MessageEvent" in name

    def _judge_given(self, place: UsePlace, spot: Spot) -> None:
        use, fn = place.use, place.fn
        if use.type and use.place >= 0:
            kind = self.code.resolve_written(use.type, fn.source, fn.scope)
            if use.count == 1 and (not kind.name or self._holds(kind.name, spot)):
                return  # a copy, which is kept or given on where it stands
        last = get_tail(use.to)
        if last in _PUBLISHES:
            self.escape_at(spot, "published again", place)
            return
        targets = self._find_targets(use.to, fn)
        if not targets:
            what = "printed whole" if last in _PRINTS else f"given to `{last or use.to}`, which is not here"
            self.escape_at(spot, what, place)
            return
        followed = [self._give(target, use, spot, fn) for target in targets]
        if fn.source.facts.language == "python" and use.place > 0 and self._find_class_before(use.to, fn):
            # `Class.method(self, path)`: a method's parameters are told without its object, a static one's are all.
            followed += [self._give(target, use, spot, fn, use.place - 1) for target in targets]
        if not any(followed):
            self.escape_at(spot, f"given to `{last}`", place)

    def _give(self, target: Fn, use: PathUse, spot: Spot, giver: Fn, place: int | None = None) -> bool:
        """Follows an argument into a function; False where that does not take it as it is. place: which argument it is,
        where that is not as the use says."""
        parameters = [one for one in target.facts.parameters if one.name != "*"]
        at = use.place if place is None else place
        if at < 0:
            parameter = next((one for one in parameters if one.name == use.type), None)
        else:
            parameter = parameters[at] if at < len(parameters) else None
        if parameter is None or parameter.name.startswith("*"):
            return False
        if not parameter.name:
            return True  # nothing reads what has no name
        kind = self.code.resolve_written(parameter.type, target.source, target.scope) if parameter.type else None
        templated = kind is not None and kind.name in target.facts.types
        if kind is not None and kind.name and not templated and not self._holds(kind.name, spot):
            return False
        self.results.give(target.place, giver.place)
        self.hold(Variable("local", target.place, parameter.name), spot.path)
        return True

    def _find_targets(self, callee: str, fn: Fn) -> list[Fn]:
        """The bodies that a call may run; of a class those of its constructors."""
        local = self.code.resolve_variable(callee, fn)[0] if "." not in callee and "::" not in callee else None
        if local is not None and local.kind == "local":
            owner = next(one for one in self.code.list_enclosing_chain(fn) if one.place == local.owner)
            values = [each.value for each in owner.assigned.get(callee, ())]
            names = {value.text for value in values if value.kind == "lambda"}
            found = [one for one in self.code.functions_in[fn.source.path] if one.name in names]
            return found if len(found) == len(values) else []
        found = self.code.list_targets(callee, fn) or self._list_included(callee, fn)
        if found:
            return found
        cls = self._find_class_before(callee, fn)
        if cls is not None:
            return self.code.find_method(cls, get_tail(callee))
        cls = self.code.find_class(callee, fn.source, fn.scope)
        return [one for one in self.code.list_functions(cls) if self.code.is_constructor(one)] if cls else []

    def _find_class_before(self, callee: str, fn: Fn) -> Cls | None:
        """In Python, the class by whose name a method is called: `Class.method`."""
        head = callee.rpartition(".")[0]
        python = fn.source.facts.language == "python"
        return self.code.find_class(head, fn.source, fn.scope) if python and head and "()" not in head else None

    def _list_included(self, callee: str, fn: Fn) -> list[Fn]:
        """Functions of C++ outside of classes that a call names which stand in what its file includes."""
        if fn.source.facts.language != "cpp" or "." in callee:
            return []
        wanted = split_name(self.code.resolve_name(callee, fn.source, fn.scope))
        named = self.code.by_tail.get(wanted[-1], ()) if wanted else ()
        return [
            one
            for one in named
            if not one.facts.owner
            and split_name(one.name)[-len(wanted) :] == wanted
            and self.code.includes(fn.source.path, one.source.path)
        ]

    def _judge_returned(self, place: UsePlace, spot: Spot) -> None:
        fn = place.fn
        tail = get_tail(fn.name)
        if not self.results.note(fn, spot.path):
            return
        if fn.is_lambda or not tail.isidentifier():
            self.escape_at(spot, "given back by a lambda or an operator", place)
            return
        given = self.code.resolve_written(fn.facts.returns, fn.source, fn.scope) if fn.facts.returns else None
        if given is not None and given.name and given.name not in fn.facts.types and not self._holds(given.name, spot):
            self.escape_at(spot, f"made into `{get_tail(given.name)}`", place)
            return
        if tail in self.code.handed_on and not fn.facts.owner:
            self.escape_at(spot, f"given back by `{tail}`, which is handed on", place)
            return
        self.results.spread(fn, spot.path)


class _Results:
    """What functions give back, and to whom. A function that has the message from a parameter alone gives it back to
    those that gave it to it; one that has it from elsewhere, to all that call it: it is open. Functions by place."""

    def __init__(self) -> None:
        self.left: list[tuple[Fn, Path]] = []
        self._noted: set[tuple[Fn, Path]] = set()
        self._spread: dict[str, list[tuple[Fn, Path]]] = {}
        self._givers: dict[str, set[str]] = {}
        self._open: set[str] = set()
        self._taken: set[tuple[str, Path, UsePlace]] = set()

    def note(self, fn: Fn, path: Path) -> bool:
        """Whether a function's field is new here."""
        new = (fn, path) not in self._noted
        self._noted.add((fn, path))
        return new

    def spread(self, fn: Fn, path: Path) -> None:
        """A field that a function gives back as it is."""
        self._spread.setdefault(fn.place, []).append((fn, path))
        self.left.append((fn, path))

    def open(self, place: str) -> None:
        """A function that has the message not from a parameter."""
        if place not in self._open:
            self._open.add(place)
            self.left += self._spread.get(place, ())

    def give(self, place: str, giver: str) -> None:
        """A function that is given the message by another."""
        givers = self._givers.setdefault(place, set())
        if giver not in givers:
            givers.add(giver)
            self.left += self._spread.get(place, ())

    def take(self, fn: Fn, path: Path, result: UsePlace) -> bool:
        """Whether a call may give back the message to where it stands, and was not looked at yet."""
        here = result.fn.place
        if fn.place in self._open:
            self.open(here)
        elif here not in self._givers.get(fn.place, ()):
            return False
        key = (fn.place, path, result)
        new = key not in self._taken
        self._taken.add(key)
        return new


def _is_fresh(value: FlowExpr, cpp: bool) -> bool:
    """Whether an expression makes a container, or nothing, anew."""
    if value.kind in ("make", "list", "number", "text"):
        return True
    return value.kind == "call" and not cpp and get_tail(value.text) in _CONTAINERS


def _describe(how: str, what: str) -> str:
    if how == "read":
        return "printed whole" if what == "<<" else f"`{what}` is applied to it"
    return {"use": what, "test": "asked for as a value"}.get(how, how)


def select_parameters(fn: Fn, type_: str, code: FlowCode) -> list[str]:
    """The parameters of a callback that may be given a message `package/Name`: those of its type, else all that have no
    type that is known to be another."""
    typed: list[str] = []
    others: list[str] = []
    for parameter in fn.facts.parameters:
        if not parameter.name or parameter.name == "*":
            continue
        name = parameter.name.lstrip("*")
        kind = code.resolve_written(parameter.type, fn.source, fn.scope) if parameter.type else None
        text = kind.arguments[0] if kind is not None and "MessageEvent" in kind.name and kind.arguments else ""
        found = find_interface(text or (kind.name if kind is not None else ""), lower=True)
        if found == type_ or (kind is not None and get_tail(kind.name) == get_tail(type_.replace("/", "::"))):
            typed.append(name)
        elif not found and (kind is None or not kind.name or kind.name in fn.facts.types):
            others.append(name)
    return typed or others


