"""What the elements of lists and dictionaries are, where code writes them out: of literals, of what loops walk through,
and of what is looked up by a place or a key."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple

from ...facts.flow import Assignment, FlowCall, FlowExpr
from .code import FlowCode, Fn, Made, Variable, find_argument, find_parameter, get_tail, is_number
from .reaching import LOOPS
from .variable_tests import read_variable_test

SETTING = "setting"
"""The kind of an expression that stands for the value of a parameter as a launch gives it. Where it is known otherwise,
its only part says how."""
DEFAULT = "default"
"""The kind of an expression that stands for its only part as the default of a parameter."""
_DEEPEST = 8
_MOST = 200
# Expressions looked at for one list.
_MOST_STEPS = 400
_PUT = frozenset(("push_back", "emplace_back", "append"))
# Calls that change what a list or dictionary holds in ways that are not followed.
_CHANGES = frozenset(
    ("insert", "emplace", "extend", "update", "clear", "pop", "remove", "erase", "setdefault", "add", "pop_back",
     "swap", "resize", "assign", "sort", "reverse", "popitem", "push_front", "emplace_front", "insert_or_assign",
     "try_emplace")
)  # fmt: skip
# Classes of C++ whose braces hold the elements themselves.
_LISTS = frozenset(("vector", "array", "list", "set", "initializer_list", "deque", "unordered_set"))
_MAPS = frozenset(("map", "unordered_map"))
# Functions of Python that give the elements of their only argument.
_COPIES = frozenset(("list", "tuple", "set", "sorted", "reversed", "iter", "frozenset", "dict"))
_OF_DICTIONARIES = {"keys": 0, "values": 1}
# In a pair of C++.
_MEMBERS = {"first": 0, "second": 1}

# Facts have so much of a source that is not followed.
_LONGEST = 118
# Ends the path of an element at a place that is a variable.
_ANY = ".[]"
_BEGIN = re.compile(r"(.+)\.c?begin")
_COUNTS = re.compile(r"(\w+) (<=?) (\d{1,4}|(?:this->)?[A-Za-z_][\w:]*(?:\.size\(\))?)")


class ListElement(NamedTuple):
    """An expression where it stands. only_if: the condition under which it is among the elements, empty where it surely
    is."""

    value: FlowExpr
    fn: Fn
    line: int
    only_if: str = ""


class KnownCount(NamedTuple):
    """A number that an expression is, and how it is known."""

    number: int
    how: str


class HeldList(NamedTuple):
    """What a list or dictionary is written to hold. whole: whether it is that alone, in this order."""

    elements: tuple[ListElement, ...]
    whole: bool = True


class Elements:
    """The elements of the lists and dictionaries of a body of code. runs: which functions run; find_only: the only
    call through which a function is reached, and find_makers: who in particular gives a constructor its arguments, None
    for any. given: what a launch makes of an expression; find_turn: the only turn of the loop that begins on a line,
    None for any; count: the only number that an expression may be, None where that is not known."""

    def __init__(
        self, code: FlowCode, runs: Callable[[Fn], bool] = lambda fn: True,
        find_only: Callable[[Fn], FlowCall | None] = lambda fn: None,
        find_makers: Callable[[Fn], Sequence[Made] | None] = lambda fn: None,
        given: Callable[[FlowExpr, Fn, int], list[ListElement] | None] = lambda value, fn, line: None,
        find_turn: Callable[[Fn, int], int | None] = lambda fn, line: None,
        count: Callable[[FlowExpr, Fn, int], KnownCount | None] = lambda value, fn, line: None,
    ):  # fmt: skip
        self.code, self._runs, self._find_only, self._find_makers = code, runs, find_only, find_makers
        self._find_given, self._find_turn, self._count = given, find_turn, count
        self._left = 0

    def list_walked(self, container: FlowExpr, fn: Fn, line: int) -> list[ListElement] | None:
        """What a loop over a list or dictionary goes through: a pair for each key of a dictionary. None where that is
        not written out."""
        held = self._find_held(container, fn, line)
        return self._take_turn(held, fn, line) if held else None

    def list_turns(self, container: FlowExpr, fn: Fn, line: int) -> list[ListElement] | None:
        """What a loop goes through in its turns, one in each. None where that is not written out in one place."""
        held = self._find_held(container, fn, line)
        return list(held[0].elements) if held and len(held) == 1 and held[0].whole else None

    def list_in_order(self, container: FlowExpr, fn: Fn, line: int) -> list[ListElement] | None:
        """The elements of a list in the order in which they are written; None where that is not known."""
        return self.list_turns(container, fn, line) if self._is_in_order(container, fn) else None

    def _is_in_order(self, value: FlowExpr, fn: Fn, depth: int = 0) -> bool:
        """Whether a list is written as such, or as several one after the other: nothing sorts it."""
        if value.kind == "join" and value.text == "+":
            return all(self._is_in_order(part, fn, depth) for part in value.parts)
        if value.kind != "name" or depth > _DEEPEST:
            return value.kind == "list"
        variable = self.code.identify(value.text, fn)
        if variable.kind == "local" and find_parameter(fn, f"*{variable.name}") is not None:
            return True
        written = self.code.list_writes(variable)
        return bool(written) and all(self._is_in_order(each.value, writer, depth + 1) for writer, each in written)

    def _take_turn(self, held: list[HeldList], fn: Fn, line: int) -> list[ListElement]:
        """Of the elements of lists those that the loop which begins on a line goes through: that of its turn alone,
        where one is chosen."""
        turn = self._find_turn(fn, line) if len(held) == 1 and held[0].whole else None
        return _join_held(held) if turn is None else list(held[0].elements[turn : turn + 1])

    def select(self, container: FlowExpr, key: FlowExpr, fn: Fn, line: int) -> list[ListElement] | None:
        """What stands at a place, or at a key, that is a literal. None where that is not written out."""
        held = self._find_held(container, fn, line)
        if not held or not all(one.whole for one in held):
            return None
        found: list[ListElement] = []
        for one in held:
            chosen = _select_one(one, key)
            if chosen is None:
                return None
            found.append(chosen)
        return found

    def list_counted(self, path: str, fn: Fn, line: int) -> list[ListElement]:
        """The numbers that a variable of a loop `for (int i = 0; i < 4; ++i)` is in its turns; none for all else."""
        around = {place for guard in fn.collect_guards(line) for place in fn.list_guards_around(guard)}
        asked = (fn.facts.guards[place] for place in around if fn.facts.guards[place].kind not in LOOPS)
        if any(path in re.findall(r"\w+", guard.text) for guard in asked):
            return []  # not in all turns
        for each in fn.assigned.get(path, ()) if fn.source.facts.language == "cpp" else ():
            if each.operator != "=" or each.value.kind != "number" or not is_number(each.value.text):
                continue
            for place in around:
                guard = fn.facts.guards[place]
                limit = _COUNTS.fullmatch(guard.text)
                same = [one for one in fn.assigned[path] if one.guard == place]
                steps = [one.value.text for one in same if one.operator == "+="]
                if guard.kind == "while" and guard.line == each.line and limit and limit[1] == path and steps == ["1"]:
                    text = limit[3].replace("->", ".")
                    kind = "number" if text.isdecimal() else "call" if text.endswith("()") else "name"
                    most = self._find_count(FlowExpr(kind, text.removesuffix("()")), fn, each.line)
                    if len(same) != 1 or most is None:
                        return []
                    last = most.number + (limit[2] == "<=")
                    return _list_numbers(range(int(each.value.text), last), fn, line, most.how)
        return []

    def _find_count(self, value: FlowExpr, fn: Fn, line: int) -> KnownCount | None:
        """The number that a limit of a loop is."""
        if value.kind == "number":
            return KnownCount(int(value.text), "literal") if is_number(value.text) else None
        return self._count(value, fn, line)

    def _make_range(self, value: FlowExpr, fn: Fn, line: int) -> list[HeldList] | None:
        """The numbers that `range` counts, where its limits are known."""
        limits = [self._find_count(part, fn, line) for part in value.parts]
        known = [one for one in limits if one is not None]
        if not 0 < len(limits) < 3 or len(known) < len(limits):
            return None
        how = next((one.how for one in known if one.how != "literal"), "literal")
        found = _list_numbers(range(*(one.number for one in known)), fn, line, how)
        return [HeldList(tuple(found))] if found else None

    def find_pair(self, path: str, fn: Fn, line: int) -> list[ListElement] | None:
        """What `entry.first` and `entry.second` are, where a loop walks through pairs. None for all else."""
        head, _, last = path.rpartition(".")
        place = _MEMBERS.get(last)
        if place is None or not head or fn.source.facts.language != "cpp":
            return None
        held = self._find_held(FlowExpr("name", head), fn, line)
        if not held or not all(one.whole and len(one.elements) == 2 for one in held):
            return None
        return [one.elements[place] for one in held]

    def find_field(self, path: str, variable: Variable, fn: Fn, line: int) -> list[ListElement] | None:
        """What a member of an object is that braces fill, as in `Part part{"a", "b"}`. None for all else, and where it
        is written otherwise. variable: what the path names."""
        fields = self.code.fields.get(variable.owner, ()) if variable.kind == "member" else ()
        head = path.rpartition(".")[0]
        if variable.name not in fields or head in ("", "this") or self.code.list_writes(variable):
            return None
        place = fields.index(variable.name)
        held = self._find_held(FlowExpr("name", head), fn, line)
        if not held or not all(one.whole and place < len(one.elements) <= len(fields) for one in held):
            return None
        return [one.elements[place] for one in held]

    def _find_held(self, value: FlowExpr, fn: Fn, line: int) -> list[HeldList] | None:
        before, self._left = self._left, _MOST_STEPS
        try:
            return self._list_held(value, fn, line, 0)
        finally:
            self._left = before

    def _list_held(self, value: FlowExpr, fn: Fn, line: int, depth: int) -> list[HeldList] | None:
        """The lists that an expression may be, None where one of them is not written out."""
        self._left -= 1
        if depth > _DEEPEST or self._left < 0:
            return None
        if value.kind == "list":
            return [HeldList(tuple(ListElement(part, fn, line) for part in value.parts))]
        if value.kind in ("name", "call") and (given := self._find_given(value, fn, line)):
            return [HeldList(tuple(given))]
        if value.kind == "name" and value.text.endswith(_ANY):
            return self._list_any(value.text.removesuffix(_ANY), fn, line, depth)
        if value.kind == "make":
            return self._list_made(value, fn, line, depth)
        if value.kind == "name":
            return self._list_named(value.text, fn, line, depth)
        if value.kind == "index" and len(value.parts) == 2:
            return self._list_inner(value, fn, line, depth)
        if value.kind == "call":
            return self._list_called(value, fn, line, depth)
        if value.kind == "join" and value.text == "+":
            return self._list_joined(value, fn, line, depth)
        if value.kind == "choice" and len(value.parts) == 3 and is_fallback(value):
            # `a or {}` is the first where that holds anything.
            held = self._list_held(value.parts[1], fn, line, depth + 1)
            return held if held and all(one.whole and one.elements for one in held) else None
        if value.kind == "other" and len(value.parts) == 1 and value.text[:1] in ("[", "("):
            # `[... for each in ...]`
            return [HeldList((ListElement(value.parts[0], fn, line, _spell_filters(value, fn, line)),), False)]
        return None

    def _list_made(self, value: FlowExpr, fn: Fn, line: int, depth: int) -> list[HeldList] | None:
        name = get_tail(value.text.partition("<")[0])
        if name in self.code.classes and value.parts:
            cls = self.code.find_class(value.text, fn.source, fn.scope)
            filled = cls is not None and cls.key in self.code.fields
            return [HeldList(tuple(ListElement(part, fn, line) for part in value.parts))] if filled else None
        if fn.source.facts.language != "cpp" or name not in _LISTS | _MAPS:
            return None
        if len(value.parts) == 1 and value.parts[0].kind == "list" and name in _LISTS:
            return self._list_held(value.parts[0], fn, line, depth + 1)
        # `std::vector<std::string>(3, "x")` holds no list of these.
        if not value.parts or any(part.kind not in ("text", "list") for part in value.parts):
            return None
        return [HeldList(tuple(ListElement(part, fn, line) for part in value.parts))]

    def _list_inner(self, value: FlowExpr, fn: Fn, line: int, depth: int) -> list[HeldList] | None:
        """The lists that are elements of a list."""
        container, key = value.parts
        held = self._list_held(container, fn, line, depth + 1)
        if not held:
            return None
        if key.kind == "other" and not key.text:
            inner = self._take_turn(held, fn, line)
        else:
            chosen = [_select_one(one, key) if one.whole else None for one in held]
            inner = [one for one in chosen if one is not None]
            if len(inner) < len(chosen):
                return None
        return self._join_lists(inner, depth)

    def _list_any(self, path: str, fn: Fn, line: int, depth: int) -> list[HeldList] | None:
        """The lists that `path[i]` is in the turns of the only loop around it that counts the elements."""
        around = {place for guard in fn.collect_guards(line) for place in fn.list_guards_around(guard)}
        loops = [place for place in around if f"{path}.size()" in fn.facts.guards[place].text]
        held = self._list_held(FlowExpr("name", path), fn, line, depth + 1) if len(loops) == 1 else None
        return self._join_lists(self._take_turn(held, fn, fn.facts.guards[loops[0]].line), depth) if held else None

    def _join_lists(self, elements: Iterable[ListElement], depth: int) -> list[HeldList] | None:
        found: list[HeldList] = []
        for one in elements:
            lists = self._list_held(one.value, one.fn, one.line, depth + 1)
            if lists is None or len(found) > _MOST:
                return None
            found += [_put_under(each, one.only_if) for each in lists]
        return found

    def _list_called(self, value: FlowExpr, fn: Fn, line: int, depth: int) -> list[HeldList] | None:
        head, _, last = value.text.rpartition(".")
        python = fn.source.facts.language == "python"
        if python and head and not value.parts and last in ("items", "copy", *_OF_DICTIONARIES):
            called = self._find_called(head, fn, line)
            held = self._list_held(value.receiver or called or FlowExpr("name", head), fn, line, depth + 1)
            return _select_column(held, _OF_DICTIONARIES[last]) if held and last in _OF_DICTIONARIES else held
        if python and head and last == "get" and value.parts:
            chosen = self.select(value.receiver or FlowExpr("name", head), value.parts[0], fn, line)
            return self._join_lists(chosen, depth) if chosen else None
        if python and not head and value.text == "range":
            return self._make_range(value, fn, line)
        if python and not head and value.text in _COPIES and len(value.parts) == 1:
            return self._list_held(value.parts[0], fn, line, depth + 1)
        targets = self.code.list_targets(value.text, fn)
        returned = [(each, one) for one in targets for each in one.facts.assignments if each.operator == "return"]
        if len(returned) == 1:
            return self._list_held(returned[0][0].value, returned[0][1], returned[0][0].line, depth + 1)
        return None

    def _find_called(self, path: str, fn: Fn, line: int) -> FlowExpr | None:
        """The call that a path which ends in one names, with its arguments; None where a line has several such."""
        name = path.removesuffix("()")
        calls = [call for call in fn.list_calls(name) if call.line == line] if name != path else []
        return FlowExpr("call", name, calls[0].arguments) if len(calls) == 1 else None

    def _list_joined(self, value: FlowExpr, fn: Fn, line: int, depth: int) -> list[HeldList] | None:
        """`[...] + [...]`."""
        parts = [self._list_held(part, fn, line, depth + 1) for part in value.parts]
        known = [part[0] for part in parts if part is not None and len(part) == 1]
        if len(known) < len(parts):
            return None
        return [HeldList(tuple(one for part in known for one in part.elements), all(part.whole for part in known))]

    def _list_named(self, path: str, fn: Fn, line: int, depth: int) -> list[HeldList] | None:
        head, _, last = path.rpartition(".")
        if last in _MEMBERS and head and fn.source.facts.language == "cpp":
            # In a loop over a map, what each key has.
            rows = self._list_held(FlowExpr("name", head), fn, line, depth + 1)
            if rows and all(one.whole and len(one.elements) == 2 for one in rows):
                return self._join_lists([one.elements[_MEMBERS[last]] for one in rows], depth)
        variable = self.code.identify(path, fn)
        begun = self._find_walked(variable, fn)
        if begun is not None:
            each = FlowExpr("index", "", (FlowExpr("name", begun[0]), FlowExpr("other")))
            return self._list_inner(each, fn, begun[1], depth)
        found: list[HeldList] = []
        further: list[ListElement] = []
        written = self.code.list_writes(variable)
        if variable.kind == "member":
            # What another program writes into its own object, unless nothing that runs writes it.
            written = [row for row in written if self._runs(row[0])] or written
        for writer, each in _select_holding(written, variable, fn, line):
            if each.key is not None:
                further.append(ListElement(FlowExpr("list", "", (each.key, each.value)), writer, each.line))
                continue
            if each.operator not in ("=", "for") or "[" in each.target:
                return None
            if each.value.kind == "make" and not each.value.parts:
                continue
            inner = self._list_held(each.value, writer, each.line, depth + 1)
            if inner is None:
                return None
            found += inner
        for one in self._list_first(variable, fn) if not written else ():
            inner = self._list_held(one.value, one.fn, one.line, depth + 1)
            if inner is None:
                return None
            found += inner
        starred = self._list_starred(variable, fn) if not found else None
        if starred is not None:
            found.append(starred)
        for one in self._list_given(variable, fn) if not found else ():
            inner = self._list_held(one.value, one.fn, one.line, depth + 1)
            if inner is None:
                return None
            found += inner
        return self._add_put(found, further, path, fn)

    def _find_walked(self, variable: Variable, fn: Fn) -> tuple[str, int] | None:
        """The list or map that an iterator goes through one by one, and the line where it begins."""
        written = [each for writer, each in self.code.list_writes(variable) if writer is fn]
        if len(written) != 2 or written[1].operator != "+=":
            return None
        begun = find_begun(written[0].value)
        return (begun.text, written[0].line) if begun is not None else None

    def _add_put(self, found: list[HeldList], further: list[ListElement], path: str, fn: Fn) -> list[HeldList] | None:
        """Lists with what is put into them afterwards; None where that is not followed."""
        for call in fn.facts.calls:
            head, _, last = call.callee.rpartition(".")
            if head == path and last in _PUT and len(call.arguments) == 1:
                further.append(ListElement(call.arguments[0], fn, call.line))
            elif head == path and last in _CHANGES:
                return None
        if not further:
            return found
        held = [one for one in found if one.elements]
        return [*held, HeldList(tuple(further), False)] if len(held) < 2 else None

    def _list_first(self, variable: Variable, fn: Fn) -> Iterator[ListElement]:
        """What a member or a constant is declared with."""
        if variable.kind == "member":
            for cls in self.code.list_class_bodies(variable.owner):
                holder = next(iter(self.code.list_functions(cls)), fn)
                for member in cls.facts.members:
                    if member.name == variable.name and member.value is not None:
                        yield ListElement(member.value, holder, member.line)
        elif variable.kind == "global":
            for constant, source in self.code.list_constants(variable, fn):
                if constant.value is not None:
                    yield ListElement(constant.value, self.code.find_first(source, fn), constant.line)

    def _list_starred(self, variable: Variable, fn: Fn) -> HeldList | None:
        """What the only call of a function of Python gives for `*names`; None for all else."""
        place = find_parameter(fn, f"*{variable.name}") if variable.kind == "local" else None
        only = self._find_only(fn)
        called = [(giver, call) for giver, call in self.code.callers.get(fn, ()) if only is None or call is only]
        called = [(giver, call) for giver, call in called if self._runs(giver)]
        if place is None or len(called) != 1:
            return None
        giver, call = called[0]
        if any(one.kind == "keyword" and one.text in ("*", "**") for one in call.arguments):
            return None
        positional = [one for one in call.arguments if one.kind != "keyword"]
        return HeldList(tuple(ListElement(one, giver, call.line) for one in positional[place[0] :]))

    def _list_given(self, variable: Variable, fn: Fn) -> Iterator[ListElement]:
        """What callers that run give for a parameter of a function, and its default where one of them gives nothing."""
        place = find_parameter(fn, variable.name) if variable.kind == "local" else None
        if place is None:
            return
        only = self._find_only(fn)
        called = (
            (caller, call.arguments, call.line)
            for caller, call in self.code.callers.get(fn, ())
            if only is None or call is only
        )
        default = self.code.find_default(fn, *place)
        for giver, arguments, line in self._find_makers(fn) or (*called, *self.code.list_constructed(fn)):
            given = find_argument(arguments, place[0], variable.name) if self._runs(giver) else None
            if given is not None:
                yield ListElement(given, giver, line)
            elif default is not None and self._runs(giver):
                yield ListElement(default, fn, fn.facts.line)


def is_changed(path: str, fn: Fn) -> bool:
    """Whether a function changes what a list holds, other than by an assignment."""
    heads = (call.callee.rpartition(".") for call in fn.facts.calls)
    return any(head == path and last in _PUT | _CHANGES for head, _, last in heads)


def is_fallback(value: FlowExpr) -> bool:
    """Whether a choice is one between what is asked and something else: `a or b`, `a if a else b`."""
    asked, first = value.parts[0].text, value.parts[1]
    written = f"self.{first.text[5:]}" if first.text.startswith("this.") else first.text
    return (first.kind == "name" and asked == written) or (
        first.kind == "call" and asked.startswith(f"{written}(") and asked.endswith(")")
    )


def find_begun(value: FlowExpr) -> FlowExpr | None:
    """The list or map that `list.begin()` goes through; None for all else."""
    begun = _BEGIN.fullmatch(value.text) if value.kind == "call" else None
    return FlowExpr("name", begun[1]) if begun else None


def _select_holding(
    written: Sequence[tuple[Fn, Assignment]], variable: Variable, fn: Fn, line: int
) -> Sequence[tuple[Fn, Assignment]]:
    """Of assignments to a variable those that may hold on a line of a function: where it is a local one, none that is
    surely replaced before, and none that comes after."""
    if variable.kind != "local" or any(writer is not fn for writer, _ in written):
        return written
    return select_reaching(written, fn, line)


def select_reaching(
    written: Sequence[tuple[Fn, Assignment]], fn: Fn, line: int
) -> Sequence[tuple[Fn, Assignment]]:  # fmt: skip
    """Of assignments in a function those that may hold on a line of it, 0 for its end: none that is surely replaced
    before, and none that comes after."""
    guards = {place for guard in fn.collect_guards(line) for place in fn.list_guards_around(guard)}
    before = [each for _, each in written if not line or each.line <= line]
    sure = [
        each.line for each in before
        if each.key is None and each.operator in ("=", "for") and (each.guard < 0 or each.guard in guards)
    ]  # fmt: skip
    return [(fn, each) for each in before if each.line >= max(sure, default=0)]


def _put_under(held: HeldList, condition: str) -> HeldList:
    """A list whose elements are there under one more condition."""
    if not condition:
        return held
    elements = (one._replace(only_if=" && ".join(filter(None, (one.only_if, condition)))) for one in held.elements)
    return held._replace(elements=tuple(elements))


def _spell_filters(value: FlowExpr, fn: Fn, line: int) -> str:
    """The conditions of a comprehension on a line, but for those that ask for an element alone, which its values are
    held against."""
    rows, found = fn.facts.guards, list[str]()
    for row in rows:
        outer = rows[row.outer] if row.outer >= 0 else None
        inside = outer is not None and outer.kind in (*LOOPS, "if") and outer.line >= line
        near = line <= row.line <= line + len(value.text) // 8
        here = near and (row.text in value.text or len(value.text) >= _LONGEST)
        if row.kind == "if" and inside and here and read_variable_test(row, False) is None:
            found.append(row.text)
    return " && ".join(dict.fromkeys(found))


def _join_held(held: Iterable[HeldList]) -> list[ListElement]:
    return list(dict.fromkeys(element for one in held for element in one.elements))


def _select_column(held: Iterable[HeldList], place: int) -> list[HeldList] | None:
    """Of dictionaries, as pairs, the keys or the values."""
    found: list[HeldList] = []
    for one in held:
        if any(element.value.kind != "list" or len(element.value.parts) != 2 for element in one.elements):
            return None
        column = (element._replace(value=element.value.parts[place]) for element in one.elements)
        found.append(HeldList(tuple(column), one.whole))
    return found


def _select_one(held: HeldList, key: FlowExpr) -> ListElement | None:
    """What stands at a literal place or key; None where that is not one thing."""
    pairs = [one for one in held.elements if one.value.kind == "list" and len(one.value.parts) == 2]
    if key.kind == "number" and is_number(key.text.removeprefix("-")):
        place, count = int(key.text), len(held.elements)
        # What looks like the rows of a list may be a dictionary of numbers.
        if any(one.value.parts[0].kind == "number" for one in pairs) or not -count <= place < count:
            return None
        return held.elements[place]
    if key.kind == "text" and len(pairs) == len(held.elements):
        found = [one for one in pairs if one.value.parts[0] == key or one.value.parts[0] == FlowExpr(SETTING, key.text)]
        if len(found) == 1:
            return found[0]._replace(value=found[0].value.parts[1])
    return None


def _list_numbers(numbers: range, fn: Fn, line: int, how: str) -> list[ListElement]:
    """Numbers as they would be written; none where they are many. how: it is known how far they count."""
    told = () if how == "launch" else (FlowExpr("text", how),)
    made = (FlowExpr("number", str(n)) if how == "literal" else FlowExpr(SETTING, str(n), told) for n in numbers)
    return [ListElement(one, fn, line) for one in made] if len(numbers) <= _MOST else []
