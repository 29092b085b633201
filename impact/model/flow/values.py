"""What an expression may be worth: strings from literals, constants, members, arguments and defaults of parameters."""

from __future__ import annotations

import ast
import posixpath
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence, Set
from functools import cached_property
from itertools import islice, product
from operator import itemgetter
from typing import NamedTuple, TypeVar, cast

from msgspec import structs

from ....edges.groups import group_pairs
from ...facts.flow import Assignment, FlowCall, FlowExpr, FlowParameter, Guard
from ...facts.python.flow_expressions import LONGEST_OTHER, make_join
from ...facts.python.text import format_pieces, split_percent_format
from .arguments import CommandLine
from .calls import Calls, FrameworkCall
from .code import Fn, Made, Variable, find_argument, find_parameter, get_tail, is_number, select_overloads
from .conditions import CASTS, ConditionReader, DecidedCondition, is_truth
from .documents import SHARES, Documents
from .elements import DEFAULT, SETTING, Elements, KnownCount, ListElement, find_begun, is_fallback
from .given_lists import GivenLists
from .graph import NOT_GIVEN, How
from .literals import spell_number
from .makers import Makers
from .named_in_turns import DefaultGiven, NamesInTurns
from .names import OR, is_open, make_open_part, resolve_ros1_name
from .origins import ObjectOrigins, Origins
from .printing import find_format_place
from .reaching import LOOPS, FlowValue, ReachingValues, lessen
from .types import Cls, split_name

_Row = TypeVar("_Row")

NODE, NAMESPACE = "{node}", "{ns}"
"""Stand in a value for the name and the namespace of the node that evaluates it (ROS 2 writes them so in names)."""
LOST = "?"
"""Begins the namespace of a node handle that is not known."""
_MOST = 12
_DEEPEST = 12
_FAR = 6
# Names that are known in part, of one endpoint.
_MOST_IN_PART = 4
# Up to here it is asked of each value whether its branch is come to.
_NEAR = 3
# Expressions looked at for one value, and characters of it: each variable may be written from two others.
_MOST_STEPS = 5_000
# Of all values together; navigation2 takes 25,000. A value that comes after them is followed for a few steps only.
_STEPS_IN_ALL, _STEPS_A_FUNCTION = 150_000, 100
_FEW_STEPS = 50
_STEPS_A_CONDITION = 500
_LONGEST = 10_000
# Of the values of a variable under the same circumstances those that are kept.
_MOST_KNOWN = 24
# Calls that give what they are called on, or their first argument, as a string.
_SAME = frozenset(
    ("c_str", "str", "as_string", "string_value", "value", "get_parameter_value", "strip", "lstrip", "rstrip", "data",
     "get_value", "string", "generic_string", "native", "to_string", "as_int", "as_bool", "as_double",
     "as_string_array", "string_array_value", "integer_value", "bool_value", "double_value")
)  # fmt: skip
_OF_FIRST = frozenset(("resolveName", "resolve_name", "remap_name", "resolve", "string", "str", "String", "move",
                       "forward", "ParameterValue", "expand_topic_or_service_name", "resolve_topic_name",
                       "resolve_service_name", "resolve_topic_or_service_name"))  # fmt: skip
_STRING_METHODS = frozenset(
    ("capitalize", "join", "lower", "lstrip", "removeprefix", "removesuffix", "replace", "rstrip", "strip", "upper")
)
# What is least certain of a text that is put together, first.
_LEAST: tuple[How, ...] = ("default", "launch", "given", "literal")
# Kinds of guards that ask something, and conditions that are a variable alone.
ASKING = frozenset(("if", "unless", "case"))
# The place of what a loop walks through, and what counts its turns.
_EACH = FlowExpr("other")
_COUNTER = "enumerate"
TOO_MANY = "too many steps"
# What a text is that was not given yet.
NOT_YET = frozenset(("", "None", "nullptr"))
WHICH_TURN = "which turn of the loop it is"
NOT_PASSED = "has no known value that passes the conditions around"
_TOGETHER = "these parts of the name belong together"
_MEASURES = re.compile(r"([\w.]+)\.size\(\)\Z")
_FLAG = re.compile(r"(!|not )?\s*\(?((?:self\.|this->|this\.)?[A-Za-z_]\w*)\)?")
_WORD = re.compile(r"[A-Za-z_]\w*")
_OF_PAIRS = frozenset(("first", "second"))
_PUT = frozenset(("push_back", "emplace_back", "append"))
# Functions that give a topic's type, and its name beside it.
_TELLS_TOPIC = frozenset(("get_topic_class", "get_topic_type"))
_NODE_NAME = frozenset(("get_name", "getName", "get_fully_qualified_name"))
_NODE_NAMESPACE = frozenset(("get_namespace", "getNamespace"))


_NOT_SET = FlowValue(None, "given", "a parameter that the launch does not set")
_NOT_GIVEN = FlowValue(None, "given", "an argument of the command line that is not given")


UNASKED: tuple[str, ...] = ("not asked for",)
"""Stands for arguments of the command line that were not asked for."""


class Work:
    """What something rests on while it is worked out. items: what was asked for whether it is being evaluated; lines:
    functions with lines of which it was asked which guard there is; settings: those that were asked for; runs, idle:
    functions that were asked for whether they run, and do or do not; is_limited: whether only some functions run; free:
    functions that any call was taken of; ways: those of which the only call was; unmade: functions that nobody in
    particular makes; makers: who makes the others; is_made: whether anything is made by somebody in particular;
    is_open: whether a launch gives anything. Where nothing asked, what is true or false is None, and arguments is
    UNASKED. higher, lower: by how much the
    number of things that are being evaluated could be larger or smaller without another answer of those that ask for
    it. turns: those of loops that were asked for, None for any; below: the settings below a prefix that were asked for.
    is_alone: whether nothing else had a part in it that may be otherwise another time. way, chosen, held: the calls,
    the turns and the makers of whoever works it out; what others chose on the way follows from these."""

    __slots__ = (
        "arguments", "below", "chosen", "free", "held", "higher", "idle", "is_alone", "is_limited", "is_made",
        "is_open", "items", "lines", "lower", "makers", "runs", "settings", "turns", "unmade", "way", "ways",
    )  # fmt: skip

    def __init__(
        self, way: Mapping[Fn, FlowCall], chosen: Mapping[tuple[str, int], int] = {},
        held: Mapping[Fn, Sequence[Made]] = {},
    ):  # fmt: skip
        self.way, self.chosen, self.held = way, chosen, held
        self.turns: dict[tuple[str, int], int | None] = {}
        self.items: set[tuple] = set()
        self.lines: set[tuple[Fn, int]] = set()
        self.settings: dict[str, FlowValue | None] = {}
        self.below: dict[str, dict[str, str]] = {}
        self.runs: set[Fn] = set()
        self.idle: set[Fn] = set()
        self.free: set[Fn] = set()
        self.ways: dict[Fn, FlowCall] = {}
        self.unmade: set[Fn] = set()
        self.makers: dict[Fn, Sequence[Made]] = {}
        self.is_made: bool | None = None
        self.arguments: tuple[str, ...] | None = UNASKED
        self.is_limited: bool | None = None
        self.is_open: bool | None = None
        self.higher = self.lower = _DEEPEST
        self.is_alone = True

    def note(self, other: Work, further: int = 0) -> None:
        """Notes that it rests on what something else rests on. further: how many more things are being evaluated than
        when that was worked out."""
        self.items |= other.items
        self.lines |= other.lines
        self.runs |= other.runs
        self.idle |= other.idle
        self.free |= other.free
        for fn, call in other.ways.items():
            self.note_way(fn, call)
        for loop, turn in other.turns.items():
            self.note_turn(loop, turn)
        self.unmade |= other.unmade
        for fn, made in other.makers.items():
            self.note_maker(fn, made)
        if other.is_made is not None:
            self.is_made = other.is_made
        if other.is_limited is not None:
            self.is_limited = other.is_limited
        self.note_given(other)
        if other.higher - further < self.higher:
            self.higher = other.higher - further
        if other.lower + further < self.lower:
            self.lower = other.lower + further

    def note_given(self, other: Work) -> None:
        """Notes of what something else rests on what a launch gives."""
        self.settings.update(other.settings)
        self.below.update(other.below)
        if other.arguments is not UNASKED:
            self.arguments = other.arguments
        if other.is_open is not None:
            self.is_open = other.is_open

    def note_way(self, fn: Fn, call: FlowCall | None) -> None:
        """Notes the only call of a function, other than one that was chosen on the way here."""
        if call is None:
            self.free.add(fn)
        elif self.way.get(fn) is call:
            self.ways[fn] = call

    def note_turn(self, loop: tuple[str, int], turn: int | None) -> None:
        """Notes the only turn of a loop, other than one that was chosen on the way here."""
        if turn is None or self.chosen.get(loop) == turn:
            self.turns[loop] = turn

    def note_maker(self, fn: Fn, made: Sequence[Made] | None) -> None:
        """Notes who in particular makes a function's objects, other than those who were chosen on the way here."""
        if made is None:
            self.unmade.add(fn)
        elif self.held.get(fn) == made:
            self.makers[fn] = made

    def note_depth(self, most: int, depth: int) -> None:
        """Notes that it was asked for whether more things than this are being evaluated. depth: how many are."""
        if depth > most:
            self.lower = min(self.lower, depth - most - 1)
        else:
            self.higher = min(self.higher, most - depth)


class _Known(NamedTuple):
    """Values of a variable that were worked out. rests: on what; within and asking: what of its items and lines was
    being evaluated, and depth: how much was; steps: those that it took."""

    values: list[FlowValue]
    rests: Work
    within: frozenset[tuple]
    asking: tuple[tuple, ...]
    depth: int
    steps: int


class _Reference(NamedTuple):
    """A variable that is passed to a function by reference. place: of the argument; inner: the parameter that it is in
    the function that is called."""

    caller: Fn
    call: FlowCall
    place: int
    target: Fn
    inner: Variable


# What is the same of a body of code whatever else is known.
_SHARED = ("filled", "declared", "by_name", "command_line", "origins", "parameter_words", "makers")
# How the reason begins why the value of a parameter is not known.
NO_DEFAULT = "the parameter "


class FlowValues:
    """Evaluates expressions in the functions of a body of code."""

    def __init__(
        self,
        calls: Calls,
        settings: Mapping[str, str] | None = None,
        arguments: tuple[str, ...] | None = None,
        way: Mapping[Fn, FlowCall] | None = None,
        within: Set[Fn] | None = None,
        node: str = "",
        made: Mapping[Fn, Sequence[Made]] | None = None,
        turns: Mapping[tuple[str, int], int] | None = None,
    ):
        """settings: values of parameters that a launch sets, by name; in ROS 1 by the global name, and node is the full
        name of the node then. arguments: of the command line, without the program's name; None where they are not
        known. way: the only call through which a function is reached, by the function. within: the functions that run,
        all when None. made: by constructor who gives it its arguments, where that is not whoever makes an object of its
        class. turns: of loops, by the place of their function and their line, the only turn that it is about."""
        self.calls, self.code = calls, calls.code
        self.settings, self.arguments, self.way, self.within = settings or {}, arguments, way or {}, within
        self.node, self.made, self.turns = node, made or {}, turns or {}
        # The namespace of the node handle that a use is called on, and what is known of that, by the call.
        self.find_prefix: Callable[[FrameworkCall, FlowValues], str] = lambda use, values: ""
        # The value of a constant of a message or a released package by its path, where it is a string.
        self.find_outside_text: Callable[[str, Fn], str | None] = lambda path, fn: None
        self.documents = Documents()
        self._prefixes: dict[int, str] = {}
        self._asked_prefixes: set[int] = set()
        self._left = _MOST_STEPS
        # Limits of loops that are asked for.
        self._counted: set[tuple[Fn, FlowExpr]] = set()
        # How much more is being evaluated than was come to step by step: what stands for objects that make others.
        self._outer = 0
        self._budget = [_STEPS_IN_ALL + _STEPS_A_FUNCTION * len(self.code.functions)]
        # Decided guards, each with what it rests on.
        self._decided: dict[tuple, list[tuple[Work, DecidedCondition]]] = {}
        # Places of functions that may be under a guard that asks for what a launch gives.
        self._asking: dict[tuple[Fn, int], bool] = {}
        # The same where only some functions run, by their id().
        self._copies: dict[int, FlowValues] = {}
        # Values of variables, by all that does not show in what they rest on; and what is being worked out.
        self._known: dict[tuple, list[_Known]] = {}
        self._works: list[Work] = []

    def apply_launch(
        self, settings: Mapping[str, str], arguments: tuple[str, ...] | None = None, node: str = ""
    ) -> FlowValues:
        """The same code where a launch sets parameters and gives arguments; as for FlowValues()."""
        return self._make_copy(settings, arguments, self.way, self.within, node, self.made, self.turns)

    def rename(self, node: str) -> FlowValues:
        """The same where the code is a nodelet of another name."""
        return self.apply_launch(self.settings, self.arguments, node) if self.node else self

    def run(self, functions: Set[Fn]) -> FlowValues:
        """The same code where only some functions run: what others pass to them does not count."""
        known = self._copies.get(id(functions))
        if known is None:
            known = self._make_copy(
                self.settings, self.arguments, self.way, functions, self.node, self.made, self.turns
            )
            self._copies[id(functions)] = known  # which keeps the functions, so that nothing else comes by the same id
        return known

    def limit_to_calls(self, way: Mapping[Fn, FlowCall]) -> FlowValues:
        """The same code as far as it is reached through some calls, by the function called."""
        if not way:
            return self
        return self._make_copy(self.settings, self.arguments, way, self.within, self.node, self.made, self.turns)

    def limit_to_objects(self, made: Mapping[Fn, Sequence[Made]]) -> FlowValues:
        """The same code in some objects alone. made: who gives their constructors arguments."""
        return self._make_copy(self.settings, self.arguments, self.way, self.within, self.node, made, self.turns)

    def limit_to_turn(self, fn: Fn, line: int, turn: int) -> FlowValues:
        """The same code in one turn of the loop that begins on a line of a function."""
        turns = {**self.turns, (fn.place, line): turn}
        return self._make_copy(self.settings, self.arguments, self.way, self.within, self.node, self.made, turns)

    def find_turn(self, fn: Fn, line: int) -> int | None:
        """The only turn of the loop that begins on a line of a function, None for any."""
        turn = self.turns.get((fn.place, line))
        if self._works:
            self._works[-1].note_turn((fn.place, line), turn)
        return turn

    def count_turns(self, fn: Fn, guard: int) -> int:
        """How often the loop of a guard is gone through, 0 where that is not written out."""
        row = fn.facts.guards[guard]
        beside = [one for one in fn.facts.guards if one.line == row.line and one.kind in LOOPS]
        if row.kind not in LOOPS or len(beside) > 1:
            return 0
        counts: list[int] = []
        for each in fn.facts.assignments:
            if each.line != row.line or each.operator not in ("=", "for"):
                continue
            container = (find_walked(each) if each.guard == guard else None) or find_begun(each.value)
            measured = _MEASURES.search(row.text) if each.value.kind == "number" else None
            if measured is not None:
                container = FlowExpr("name", measured[1])
            elif container is None and each.value.kind == "number":
                inside = (one.line for one in fn.facts.calls if guard in fn.list_guards_around(one.guard))
                counts.append(len(self.elements.list_counted(each.target, fn, next(inside, row.line))))
            if container is not None and container.text != _COUNTER:
                counts.append(len(self.elements.list_turns(container, fn, each.line) or ()))
        known = [count for count in counts if count]
        return min(known, default=0)

    def _make_copy(self, *given) -> FlowValues:
        other = FlowValues(self.calls, *given)
        for name in _SHARED:
            other.__dict__[name] = getattr(self, name)
        other._budget, other._decided = self._budget, self._decided
        other._outer = self._outer
        other._known, other._works, other._asking = self._known, self._works, self._asking
        other.find_prefix, other._prefixes = self.find_prefix, self._prefixes
        other._asked_prefixes = self._asked_prefixes
        other.find_outside_text, other.documents = self.find_outside_text, self.documents
        return other

    def evaluate(self, value: FlowExpr | None, fn: Fn, line: int = 0) -> list[FlowValue]:
        """What an expression may be worth, each once; where nothing of it is known, one value that says why. Where
        something unknown may be in place of what is known, this is known in part, and one value that says why comes
        last. line: of the statement it stands in."""
        found = self.list_values(value, fn, line)
        known = [one for one in found if one.text is not None]
        beside = [one for one in found if one.beside][:1]
        if known and beside:
            return [*(one._replace(how="partly") for one in known), *beside]
        if known:
            return known
        # What begins with something unknown is no name, whatever follows.
        in_part = list({one.shown: one for one in found if one.shown[:1] not in ("", "<")}.values())
        if in_part:
            is_more = len(in_part) > _MOST_IN_PART or any(one.shown[:1] in ("", "<") for one in found)
            return [one._replace(more=True) for one in in_part[:_MOST_IN_PART]] if is_more else in_part
        if len(found) > 1 and found[0].shown:
            shown = list(dict.fromkeys(one.shown for one in found))
            is_more = "" in shown or len(shown) > _MOST_IN_PART
            return [found[0]._replace(shown="" if is_more else OR.join(shown))]
        return found[:1] or [FlowValue(None, "unresolved", "no value is given")]

    def find_only_text(self, value: FlowExpr, fn: Fn) -> str | None:
        """The first text that an expression may be worth, None where something unknown may be in its place."""
        found = self.evaluate(value, fn)
        return None if found[-1].text is None else found[0].text

    def list_values(self, value: FlowExpr | None, fn: Fn, line: int = 0) -> list[FlowValue]:
        """The same with all that is not known."""
        self._left = _MOST_STEPS if self._budget[0] > 0 else _FEW_STEPS
        return list(dict.fromkeys(self._evaluate(value, fn, line, ())))

    def _evaluate(self, value: FlowExpr | None, fn: Fn, line: int, seen: tuple) -> Iterator[FlowValue]:
        if value is None:
            yield FlowValue(None, "unresolved", "no value is given")
            return
        self._left -= 1
        self._budget[0] -= 1
        if self._works:
            self._works[-1].note_depth(_DEEPEST, len(seen) - self._outer)
        if len(seen) - self._outer > _DEEPEST or self._left < 0:
            yield FlowValue(None, "unresolved", TOO_MANY)
            return
        kind = value.kind
        if kind == "number" and value.text[:1] == "'":
            one = _read_character(value.text)
            yield FlowValue(one) if one else FlowValue(None, "unresolved", f"`{value.text}` is not followed")
        elif kind == "number":
            yield FlowValue(spell_number(value.text, fn.source.facts.language == "cpp"))
        elif kind == "text":
            yield FlowValue(value.text)
        elif kind == SETTING:
            yield FlowValue(value.text, cast(How, value.parts[0].text) if value.parts else "launch")
        elif kind == "name" and (called := _find_read_call(value.text, value)) is not None:
            yield from self._evaluate(called, fn, line, seen)
        elif kind == DEFAULT:
            for one in self._evaluate(value.parts[0], fn, line, seen):
                yield one if one.how not in ("literal", "given") else one._replace(how="default")
        elif kind == "name":
            yield from self._evaluate_name(value.text, fn, line, seen)
        elif kind == "join":
            yield from self._evaluate_join(value, fn, line, seen)
        elif kind == "choice" and len(value.parts) == 3 and is_fallback(value):
            yield from self._evaluate_fallback(value, fn, line, seen)
        elif kind == "choice" and len(value.parts) == 3:
            yield from self._evaluate_choice(value, fn, line, seen)
        elif kind == "call":
            yield from self._call(value, fn, line, seen)
        elif kind in ("make", "keyword", "list") and len(value.parts) == 1:
            yield from self._evaluate(value.parts[0], fn, line, seen)
        elif kind == "make" and not value.parts:
            return  # made empty, and written later
        elif kind == "index" and value.parts:
            yield from self._evaluate_element(value, fn, line, seen)
        elif kind == "other" and (decided := self._decide_truth(value, fn, line, seen)).holds is not None:
            yield from _put_under([FlowValue(str(decided.holds))], decided, "")
        else:
            what = value.text or kind
            yield FlowValue(None, "unresolved", f"`{what[:60]}` is not followed")

    def _decide_truth(self, value: FlowExpr, fn: Fn, line: int, seen: tuple) -> DecidedCondition:
        """Whether a comparison or negation whose truth is a value holds."""
        mark = ("truth", value.text)
        if len(value.text) >= LONGEST_OTHER or not is_truth(value.text, fn.source.facts.language == "cpp"):
            return DecidedCondition()
        if self._is_in(mark, seen):
            return DecidedCondition()
        return self._decide_guard(Guard("if", value.text, line, _find_guard_before(fn, line)), fn, (*seen, mark))

    def _evaluate_fallback(self, value: FlowExpr, fn: Fn, line: int, seen: tuple) -> Iterator[FlowValue]:
        """`a or b`: b is there where a may be empty, as a default where it is not known to be."""
        found = list(self._evaluate(value.parts[1], fn, line, seen))
        yield from (one for one in found if one.text not in NOT_YET)
        empty = [one for one in found if not one.text or one.text in NOT_YET]
        if found and not empty:
            return
        sure = all(one == _NOT_GIVEN or (one.text in NOT_YET and one.how != "default") for one in empty)
        conditions = {one.only_if for one in empty}
        condition = "" if "" in conditions else " or ".join(sorted(conditions))
        for one in put_under_more(self._evaluate(value.parts[2], fn, line, seen), condition):
            yield one if sure or one.how not in ("literal", "given") else one._replace(how="default")

    def _evaluate_join(self, value: FlowExpr, fn: Fn, line: int, seen: tuple) -> Iterator[FlowValue]:
        value = _spell_boost_format(value) or value
        pieces = [_take_first(self._evaluate(part, fn, line, seen)) for part in value.parts]
        # Of several pieces with several values each, it is not known which belong together.
        several = [{one.text for one in piece if one.text is not None} for piece in pieces]
        if sum(len(texts) > 1 for texts in several) > 1:
            for piece in (piece for piece, texts in zip(pieces, several, strict=True) if len(texts) > 1):
                piece[:] = [one._replace(only_if=_join_texts(one.only_if, _TOGETHER)) for one in piece]
        plain = value.text in ("+", "/", "%") and not any(map(_is_string, value.parts))
        for row in islice(product(*pieces), _MOST):
            # Numbers are added; of what may be either, it is not known.
            numbers = plain and all(one.text is not None and is_number(one.text) for one in row)
            counted = numbers and value.text == "+" and any(part.kind == "number" for part in value.parts)
            if any(one.text is None for one in row):
                yield _join_in_part(row, value) if value.text in ("", "+") else _join(row)
            elif counted:
                joined = _join(row)
                yield joined._replace(text=str(sum(int(one.text or "") for one in row)))
            elif numbers:
                yield FlowValue(None, "unresolved", "whether numbers are counted is not followed")
            elif value.text == "%":
                yield FlowValue(None, "unresolved", "what `%` makes of it is not followed")
            elif value.text == "/":
                # Of paths, where one that begins with a `/` stands alone.
                joined = _join(row)
                texts = [one.text or "" for one in row]
                yield joined if joined.text is None else joined._replace(text=posixpath.join(*texts))
            else:
                yield _join(row)

    def _evaluate_choice(self, value: FlowExpr, fn: Fn, line: int, seen: tuple) -> Iterator[FlowValue]:
        """What is chosen: one of two, where it is known which, else either."""
        asked = value.parts[0]
        text = asked.text if asked.kind in ("other", "name") else ""
        found: list[FlowValue] = []
        for part, kind in ((value.parts[1], "if"), (value.parts[2], "unless")):
            guard = Guard(kind, text, line, _find_guard_before(fn, line))
            decided = self._decide_guard(guard, fn, seen) if text else DecidedCondition()
            if decided.holds is not False:
                condition = "" if decided.holds or not text else spell_condition(kind, text)
                values = list(self._evaluate(part, fn, line, seen))
                found += _put_under(values if decided.holds else _mark_unknown(values), decided, condition)
        yield from _restore_alone(found)

    def decide_guards(self, fn: Fn, guard: int) -> Iterator[tuple[Guard, DecidedCondition]]:
        """The guards of a function at the place of one of them, innermost first, with whether they hold."""
        for place in fn.list_guards_around(guard):
            yield fn.facts.guards[place], self._recall_decided(fn, place)

    def _recall_decided(self, fn: Fn, place: int) -> DecidedCondition:
        """Whether a guard of a function holds; known already where all that this rests on is the same."""
        known = self._decided.setdefault((fn, place, bool(self.node)), [])
        for rests, found in known:
            if self.is_same(rests):
                if self._works:
                    self._works[-1].note(rests)
                return found
        found, rests = self.record(lambda: self._decide_guard(fn.facts.guards[place], fn, ()))
        known.append((rests, found))
        return found

    def record(self, work_out: Callable[[], _Row]) -> tuple[_Row, Work]:
        """What a function gives, and on what that rests."""
        work = Work(self.way, self.turns, self.made)
        self._works.append(work)
        try:
            return work_out(), work
        finally:
            self._works.pop()
            if self._works:
                self._works[-1].note(work)

    def _decide_guard(self, guard: Guard, fn: Fn, seen: tuple) -> DecidedCondition:
        # Who asks a variable for its value is not under the guard yet.
        inner = (*seen, ("asks", fn, guard.line, guard.outer))
        asks_open = False

        def list_known(value: FlowExpr) -> list[tuple[str, How]] | None:
            filling = self._find_filling(value, fn)
            if filling is not None:
                use, values = filling
                return [("true", "launch")] if values._is_set(use, inner) else None
            nonlocal asks_open
            found = [one for one in self._evaluate(value, fn, guard.line, inner) if not one.uncalled]
            asks_open = asks_open or any(
                one.reason.startswith(NO_DEFAULT) if one.text is None else is_open(one.text) for one in found
            )
            known: list[tuple[str, How]] = [
                (one.text, one.how)
                for one in found
                if one.text is not None and "{" not in one.text and not is_open(one.text)
            ]
            return known if len(known) == len(found) and not any(one.only_if for one in found) else None

        if not seen:
            self._left = _STEPS_A_CONDITION
            self._note_others()
        decided = ConditionReader(fn.source.facts.language == "cpp", list_known).decide_guard(guard)
        return decided._replace(asks_open=asks_open and decided.holds is None)

    def _find_filling(self, value: FlowExpr, fn: Fn) -> tuple[FrameworkCall, FlowValues] | None:
        """The use that reads a parameter into a variable, and tells whether it was there, with the code as it is
        reached; also where a function does so with what it is passed, and returns that. None for all else."""
        same = fn.list_calls(value.text) if value.kind == "call" else ()
        call = next((call for call in same if call.arguments == value.parts), None)
        if call is None:
            return None
        use = self.calls.find_use(fn, call)
        if use is not None:
            return (use, self) if self._fills(use) else None
        targets = self.code.list_targets(call.callee, fn)
        returned = [one for one in targets[0].facts.calls if one.returned] if len(targets) == 1 else []
        use = self.calls.find_use(targets[0], returned[0]) if len(returned) == 1 else None
        if use is None or not self._fills(use):
            return None
        return use, self.limit_to_calls({**self.way, targets[0]: call})

    def _fills(self, use: FrameworkCall) -> bool:
        """Whether a use reads a parameter into a variable."""
        if use.row.does != "parameter" or not use.row.variable:
            return False
        target = self.calls.find_argument(use, use.row.variable)
        default = self.calls.find_argument(use, use.row.default) if use.row.default else None
        return target is not None and target is not default

    def _is_set(self, use: FrameworkCall, seen: tuple) -> bool:
        """Whether a launch sets the parameter that a use reads."""
        given = self._find_setting_of(use, self._find_parameter_name(use, seen))
        return given is not None and given.text is not None

    @cached_property
    def command_line(self) -> CommandLine:
        """What of the code is the command line."""
        return CommandLine(self.code)

    def _evaluate_element(self, value: FlowExpr, fn: Fn, line: int, seen: tuple) -> Iterator[FlowValue]:
        container, index = value.parts[0], value.parts[-1]
        places = self.command_line.find_places(container, index, fn) if len(value.parts) == 2 else None
        if places is not None:
            self._note_arguments()
            if self.arguments is None:
                yield FlowValue(None, "given", "an argument of the command line")
            elif (following := self._list_following(index, fn, line)) is not None:
                yield from (FlowValue(argument, "given") for argument in following)
            else:
                given = self.arguments[max(places.start, 1) - 1 : places.stop - 1]
                single = places.stop - places.start == 1
                if not given and single and places.start and self.command_line.has_own(container, fn):
                    yield FlowValue(None, "unresolved", "an argument that ROS adds to the command line")
                elif len(given) == 1 or single or self._runs_over_all(fn, line):
                    yield from (FlowValue(argument, "given") for argument in given)
                else:
                    yield FlowValue(None, "given", "one of several arguments of the command line")
        elif container.kind == "call" and get_tail(container.text) in _TELLS_TOPIC and container.parts:
            yield from self._evaluate(container.parts[0], fn, line, seen)
        elif len(value.parts) == 2:
            yield from self._evaluate_chosen(container, index, fn, line, seen)
        else:
            yield from self._evaluate_elements(container, fn, line, seen)

    @cached_property
    def elements(self) -> Elements:
        """What lists and dictionaries of the code hold."""
        asked = (self.runs, self.find_only_call, self.find_makers, self._find_given_list, self.find_turn)
        return Elements(self.code, *asked, self._count)

    @cached_property
    def _given_lists(self) -> GivenLists:
        return GivenLists(self)

    def _find_given_list(self, value: FlowExpr, fn: Fn, line: int) -> list[ListElement] | None:
        """What a launch, or a file that the code reads, makes of an expression; None for all else."""
        document = self.documents.find(value, fn, line, self) if value.kind == "call" else None
        if document is not None and document.kind == "list":
            return [ListElement(part, fn, line) for part in document.parts]
        return self._given_lists.find(value, fn, line)

    def _count(self, value: FlowExpr, fn: Fn, line: int) -> KnownCount | None:
        """The only number that a limit of a loop may be."""
        mark = fn, value
        if mark in self._counted:
            return None
        self._counted.add(mark)
        left = self._left
        try:
            listed = _find_measured(value, fn)
            held = self.elements.list_turns(listed, fn, line) if listed is not None else None
            if held:
                return KnownCount(len(held), _tell_how(held))
            found = self.evaluate(value, fn, line)
        finally:
            self._counted.discard(mark)
            self._left = left
        one = found[0]
        if len(found) > 1 or one.text is None or not is_number(one.text) or one.only_if or one.how not in _LEAST:
            return None
        return KnownCount(int(one.text), one.how)

    def _evaluate_chosen(
        self, container: FlowExpr, index: FlowExpr, fn: Fn, line: int, seen: tuple
    ) -> Iterator[FlowValue]:  # fmt: skip
        """What stands at a place, at a key, or in each turn of a loop."""
        hows = frozenset[How]()
        if index.kind in ("number", "text"):
            found = self.elements.select(container, index, fn, line)
        elif index.kind == "other" and not index.text and container.text == _COUNTER:
            yield from self._evaluate_count(container, fn, line, seen)
            return
        elif index.kind == "other" and not index.text:
            found = self.elements.list_walked(container, fn, line)
            # A loop over a dictionary goes through its keys.
            found = [one._replace(value=_get_key(one.value)) for one in found or ()]
        else:
            found, hows = self._select_at_each(container, index, fn, line, seen)
        if found:
            for one in found:
                values = self._evaluate_listed(one, (*seen, ("element", one.value)))
                yield from _put_under(values, DecidedCondition(None, hows), "") if hows else values
        elif index.kind == "number":
            one_of = list(self._evaluate_elements(container, fn, line, seen))
            yield from one_of
            if sum(one.text is not None for one in one_of) > 1:
                reason = f"which element of `{container.text or container.kind}` it is"
                yield FlowValue(None, "unresolved", reason, beside=True)
        else:
            yield from self._evaluate_elements(container, fn, line, seen)

    def _evaluate_listed(self, one: ListElement, seen: tuple) -> Iterable[FlowValue]:
        """What an element of a list is worth, under the condition under which it is there."""
        return put_under_more(self._evaluate(one.value, one.fn, one.line, seen), one.only_if)

    def _evaluate_count(self, container: FlowExpr, fn: Fn, line: int, seen: tuple) -> Iterator[FlowValue]:
        """The number of a turn, as `enumerate` counts."""
        turn = self.find_turn(fn, line)
        begins = [FlowValue("0")] if not container.parts else list(self._evaluate(container.parts[0], fn, line, seen))
        for one in begins:
            known = turn is not None and is_number(one.text or "")
            unknown = FlowValue(None, "unresolved", WHICH_TURN)
            yield one._replace(text=str(int(one.text or 0) + (turn or 0))) if known else unknown

    def _list_counted(self, path: str, fn: Fn, line: int) -> list[ListElement]:
        """The numbers that a variable of a counting loop is in its turns, or in the one that is chosen."""
        found = self.elements.list_counted(path, fn, line)
        around = {place for guard in fn.collect_guards(line) for place in fn.list_guards_around(guard)} if found else ()
        loops = {fn.facts.guards[place].line for place in around if fn.facts.guards[place].kind in LOOPS}
        for each in fn.assigned.get(path, ()) if loops else ():
            if each.operator == "=" and each.line in loops:
                turn = self.find_turn(fn, each.line)
                return [found[turn]] if turn is not None and turn < len(found) else found
        return found

    def _select_at_each(
        self, container: FlowExpr, index: FlowExpr, fn: Fn, line: int, seen: tuple
    ) -> tuple[list[ListElement], frozenset[How]]:  # fmt: skip
        """What a dictionary has at each key that an expression may be worth, with how these are known; nothing where
        one of them is not known, or it has no such key."""
        if index.kind not in ("name", "call") or self._is_in(("key", index.text), seen):
            return [], frozenset()
        keys = list(self._evaluate(index, fn, line, (*seen, ("key", index.text))))
        found: list[ListElement] = []
        for key in keys:
            chosen = key.text is not None and self.elements.select(container, FlowExpr("text", key.text), fn, line)
            if not chosen and is_number(key.text or ""):
                chosen = self.elements.select(container, FlowExpr("number", key.text or ""), fn, line)
            if not chosen:
                return [], frozenset()
            found += chosen
        return found, frozenset(key.how for key in keys if key.how != "literal")

    def _list_following(self, index: FlowExpr, fn: Fn, line: int) -> list[str] | None:
        return self.command_line.list_following(index, fn, _find_guard(fn, line), self.arguments or ())

    def list_rows(self, value: FlowExpr, fn: Fn, depth: int = 0) -> list[FlowExpr]:
        """The lists that a list of lists holds where it is written; empty where it is none, or not written once."""
        if value.kind == "list":
            return list(value.parts) if value.parts and all(part.kind == "list" for part in value.parts) else []
        if value.kind == "name" and depth < 4:
            written = self.code.list_writes(self.code.identify(value.text, fn))
            if len(written) == 1:
                return self.list_rows(written[0][1].value, written[0][0], depth + 1)
        return []

    def _evaluate_elements(self, value: FlowExpr, fn: Fn, line: int, seen: tuple) -> Iterator[FlowValue]:
        if value.kind == "list":
            for part in value.parts:
                yield from self._evaluate(part, fn, line, seen)
            return
        if value.kind == "name":
            variable = self.code.identify(value.text, fn)
            lists = [row for row in self.code.list_writes(variable) if row[1].value.kind == "list"]
            for writer, each in lists:
                yield from self._evaluate_elements(each.value, writer, each.line, (*seen, variable))
            if lists:
                return
            puts = {f"{value.text}.{put}" for put in _PUT}
            pushed = [call for call in fn.facts.calls if call.callee in puts]
            if pushed and not self._is_in(variable, seen):
                for call in pushed:
                    for argument in call.arguments[:1]:
                        yield from self._evaluate(argument, fn, call.line, (*seen, variable))
                return
        listed = list(self._list_given_elements(value, fn, line, seen))
        yield from listed or [FlowValue(None, "unresolved", f"an element of `{value.text or value.kind}`")]

    def _list_given_elements(self, value: FlowExpr, fn: Fn, line: int, seen: tuple) -> Iterator[FlowValue]:
        """The elements of a list of texts that a launch gives to a parameter; nothing where it may be another list."""
        if value.kind not in ("name", "call"):
            return
        if self._works:
            self._works[-1].is_open = bool(self.settings or self.arguments)
        if not self.settings:
            return
        found = list(self._evaluate(value, fn, line, (*seen, ("elements", fn, value.text))))
        given = [one for one in found if one.how == "launch" and one.text is not None]
        if len(given) != 1 or any(one.beside for one in found):
            return
        try:
            listed = ast.literal_eval(given[0].text or "")
        except (ValueError, SyntaxError, MemoryError, RecursionError):
            return
        if isinstance(listed, list) and all(isinstance(each, str) for each in listed):
            yield from (given[0]._replace(text=each) for each in listed)

    def _evaluate_name(self, path: str, fn: Fn, line: int, seen: tuple) -> Iterator[FlowValue]:
        parts = split_name(path)
        if "." in path and parts[-1] in _SAME:
            yield from self._evaluate_name(path.rpartition(".")[0], fn, line, seen)
            return
        if path.endswith("()"):
            yield from self._evaluate_inner(path.removesuffix("()"), fn, line, seen)
            return
        known = self.elements.find_pair(path, fn, line) if parts[-1] in _OF_PAIRS and "." in path else None
        known = known or (self._list_counted(path, fn, line) if path in fn.locals else None)
        if known:
            for one in known:
                yield from self._evaluate_listed(one, (*seen, ("element", one.value)))
            return
        variable = self.code.identify(path, fn)
        if self._is_in(variable, seen):
            return
        known = self.elements.find_field(path, variable, fn, line) if "." in path else None
        if known:
            for one in known:
                yield from self._evaluate_listed(one, (*seen, variable))
            return
        is_parsed = "." in path and self.command_line.is_parsed(path, fn)
        if is_parsed:
            self._note_arguments()
        for text, how in self.command_line.list_parsed_texts(path, fn, self.arguments) if is_parsed else ():
            unknown = FlowValue(None, "given", f"`{path}` is an argument of the command line")
            lacking = unknown if self.arguments is None else _NOT_GIVEN
            yield lacking if text is None else FlowValue(text, "given" if how == "given" else "default")
            return
        # What other objects have is not written in turn here, except where it is written just before.
        at = 0 if "." in path.removeprefix("this.") else line
        last = self._find_written_before(path, fn, line) if line and not at else None
        if last is not None:
            yield from self._evaluate(last.value, fn, last.line, (*seen, variable))
            return
        found = list(self.evaluate_variable(variable, fn, (*seen, variable), self._find_origins(path, fn), at, line))
        if not found:
            found = list(self._evaluate_declared(path, fn, line, (*seen, variable)))
        told = None if found else self.find_outside_text(path, fn)
        if found:
            yield from found
        elif told is not None:
            yield FlowValue(told)
        else:
            how = "given" if is_parsed else "unresolved"
            yield FlowValue(None, how, f"nothing tells what `{path}` is")

    def _evaluate_declared(self, path: str, fn: Fn, line: int, seen: tuple) -> Iterator[FlowValue]:
        """What a path of Python is that names a member of a class, or a method that is read like a member."""
        head, _, name = path.rpartition(".")
        if fn.source.facts.language != "python" or not head:
            return
        owner = self.code.find_class(head, fn.source, fn.scope) if head != "this" else None
        if owner is not None:
            member = Variable("member", owner.key, name)
            if not self._is_in(member, seen):
                yield from self.evaluate_variable(member, fn, (*seen, member))
        elif self.code.list_targets(path, fn):
            yield from self._evaluate_inner(path, fn, line, seen)

    def _find_written_before(self, path: str, fn: Fn, line: int) -> Assignment | None:
        """The assignment to a member of another object that a line of a function surely comes after, where nothing
        between them names the object; None for none."""
        around = fn.list_guards_around(_find_guard(fn, line))
        rows = [each for each in fn.assigned.get(path, ()) if each.operator == "=" and each.line < line]
        last = max(rows, key=lambda each: each.line, default=None)
        if last is None or (last.guard >= 0 and last.guard not in around) or _mentions(last.value, path):
            return None
        root = path.rpartition(".")[0]
        targets = (each.target for each in fn.facts.assignments if last.line < each.line < line)
        calls = (call for call in fn.facts.calls if last.line < call.line < line)
        named = any(root == target or root.startswith(f"{target}.") for target in targets) or any(
            call.callee.startswith(f"{root}.") or any(_mentions(one, root) for one in call.arguments) for call in calls
        )
        return None if named else last

    def _find_origins(self, path: str, fn: Fn) -> Origins | None:
        """The origins of the objects of which a path names a member, None where they may be any of their class."""
        root, rest = self.code.resolve_variable(path, fn)
        return self.origins.find(root) if rest else None

    @cached_property
    def origins(self) -> ObjectOrigins:
        """Where the code's objects come from."""
        return ObjectOrigins(self.code)

    @cached_property
    def by_name(self) -> NamesInTurns:
        """What loops declare and set under names that they put together."""
        return NamesInTurns(self.calls, self._begin_anew, spell_condition)

    def _begin_anew(self) -> FlowValues:
        """The same code where nothing is known of who runs it."""
        other = FlowValues(self.calls)
        for name in _SHARED:
            other.__dict__[name] = getattr(self, name)
        other.find_prefix, other.find_outside_text = self.find_prefix, self.find_outside_text
        other.documents = self.documents
        return other

    @cached_property
    def makers(self) -> Makers:
        """Who gives base classes their arguments."""
        return Makers(self.code)

    def limit_to_held(self, call: FlowCall, fn: Fn) -> FlowValues:
        """The same in objects of the class of what a method is called on. call: of the method; fn: in which it
        stands."""
        head = call.callee.rpartition(".")[0]
        if head in ("", "this"):
            return self.limit_to_class(fn)
        kind = self.code.resolve_name_type(head, fn) if not head.endswith("()") else None
        cls = self.code.find_class_of(kind, fn) if kind is not None and kind.name else None
        return self._limit_to_objects_of(cls)

    def limit_to_class(self, fn: Fn) -> FlowValues:
        """The same in objects of the class of a method alone: what other classes give its bases is not theirs."""
        return self._limit_to_objects_of(self.code.find_owner(fn))

    def _limit_to_objects_of(self, cls: Cls | None) -> FlowValues:
        if self._works:
            self._works[-1].is_made = bool(self.made)
        made = self.makers.find_inside(cls) if cls is not None and not self.made else {}
        return self.limit_to_objects(made) if made else self

    def evaluate_variable(
        self, variable: Variable, fn: Fn, seen: tuple = (), origins: Origins | None = None, line: int = 0,
        filled_before: int = 0,
    ) -> Iterator[FlowValue]:  # fmt: skip
        """What a variable may be worth: from where it is declared, written, filled by a parameter, or passed. origins:
        of the objects that a member may be of, None for any. line: at which it is asked for, 0 for any. filled_before:
        the line at which it is asked for, also where assignments are not followed in turn: what a parameter was read
        into before has no more of what its object was made with."""
        key = (variable, fn, origins, line, filled_before, bool(self.node))
        rows = self._known.setdefault(key, [])
        for known in rows:
            if self._holds_again(known, seen):
                self._left -= known.steps
                if self._works:
                    self._works[-1].note(known.rests, len(seen) - self._outer - known.depth)
                yield from known.values
                return
        before = self._left
        values, work = self.record(
            lambda: list(self._follow_variable(variable, fn, seen, origins, line, filled_before))
        )
        if self._works:
            self._works[-1].is_alone &= work.is_alone
        if work.is_alone and self._left >= 0:
            within, asking = frozenset(work.items.intersection(seen)), _list_asking(seen, work.lines)
            depth = len(seen) - self._outer
            rows.append(_Known(values, work, within, asking, depth, before - self._left))
            del rows[:-_MOST_KNOWN]
        yield from values

    def _holds_again(self, known: _Known, seen: tuple) -> bool:
        """Whether values that were worked out are those of now. seen: what is being evaluated."""
        rests, further = known.rests, len(seen) - self._outer - known.depth
        return (
            self._left >= known.steps
            and -rests.lower <= further <= rests.higher
            and rests.items.intersection(seen) == known.within
            and _list_asking(seen, rests.lines) == known.asking
            and self.is_same(rests)
        )

    def is_same(self, rests: Work) -> bool:
        """Whether what something rests on is here as it was there."""
        within, way, made = self.within, self.way, self.made
        return (
            (rests.is_limited is None or rests.is_limited == (within is not None))
            and (rests.is_open is None or rests.is_open == bool(self.settings or self.arguments))
            and (not rests.idle if within is None else rests.runs.issubset(within) and rests.idle.isdisjoint(within))
            and (not way or rests.free.isdisjoint(way))
            and (not rests.ways or all(way.get(fn) is call for fn, call in rests.ways.items()))
            and (not made or rests.unmade.isdisjoint(made))
            and (not rests.makers or all(made.get(fn) == rows for fn, rows in rests.makers.items()))
            and (rests.is_made is None or rests.is_made == bool(made))
            and (not rests.turns or all(self.turns.get(loop) == turn for loop, turn in rests.turns.items()))
            and (rests.arguments is UNASKED or rests.arguments == self.arguments)
            and (not rests.below or all(self.list_settings_below(one) == given for one, given in rests.below.items()))
            and (not rests.settings or all(self.find_setting(name) == v for name, v in rests.settings.items()))
        )

    def find_makers(self, fn: Fn) -> Sequence[Made] | None:
        """Who in particular gives a constructor its arguments; None for whoever makes an object of its class."""
        made = self.made.get(fn)
        if self._works:
            self._works[-1].note_maker(fn, made)
        return made

    def find_only_call(self, fn: Fn) -> FlowCall | None:
        """The only call through which a function is reached; None for any."""
        only = self.way.get(fn)
        if self._works:
            self._works[-1].note_way(fn, only)
        return only

    def _note_arguments(self) -> None:
        """Notes that the arguments of the command line were asked for."""
        if self._works:
            self._works[-1].arguments = self.arguments

    def _note_others(self) -> None:
        """Notes that what is being worked out may be otherwise another time."""
        for work in self._works:
            work.is_alone = False

    def _is_in(self, item: tuple, seen: tuple) -> bool:
        """Whether something is being evaluated."""
        if self._works:
            self._works[-1].items.add(item)
        return item in seen

    def _is_asking(self, guard: Guard, fn: Fn, seen: tuple) -> bool:
        """Whether it is being worked out if a guard holds."""
        return self._is_in(("asks", fn, guard.line, guard.outer), seen)

    def _leave_out(self, variable: Variable, seen: tuple) -> tuple:
        """What is being evaluated without a variable."""
        self._is_in(variable, seen)
        if seen.count(variable) > 1:
            self._note_others()
        return tuple(one for one in seen if one != variable)

    def _find_guard_of(self, fn: Fn, line: int, seen: tuple) -> int:
        """The place of the innermost guard of what is asked at a line, -1 for none; where a guard on the line asks, the
        guard around that one. seen: what is being evaluated."""
        if self._works:
            self._works[-1].lines.add((fn, line))
        asking = _list_asking(seen, ((fn, line),))
        return asking[-1][3] if asking else _find_guard(fn, line)

    def _follow_variable(
        self, variable: Variable, fn: Fn, seen: tuple, origins: Origins | None, line: int, filled_before: int
    ) -> Iterator[FlowValue]:
        """The same, worked out."""
        written = self.code.list_writes(variable)
        if variable.kind == "member" and (named := self.by_name.list_set(variable)):
            written = [*written, *((one.fn, one.each) for one in named)]
        if origins is not None:
            written = [(w, each) for w, each in written if self.origins.may_be_of(each.target, w, origins)]
        if variable.kind == "member":
            # What another program writes into its own object, unless nothing that runs writes it.
            written = [(w, each) for w, each in written if self.runs(w)] or written
            written = self._select_declared(variable, written) if len(written) > 1 else written
        rows, given = self._select_given(written)
        own = [each for writer, each in rows if writer is fn and line]
        around = fn.list_guards_around(self._find_guard_of(fn, line, seen)) if line else ()
        found = ReachingValues(fn, around, lambda path: self.code.identify(path, fn) == variable)
        # What stands before the last that is surely assigned is of no interest.
        turns = _list_turns(own, fn, line, around)
        before = [each for each in own if each.line < line or each in turns or _is_declared_on(each, line)]
        early = [each for each in before if each.operator == "=" and (found.is_sure(each.guard) or each in turns)]
        sure = [each for each in early if not _mentions(each.value, each.target)]
        begun = max((each.line for each in sure), default=0)
        filled = self._list_filled(variable, seen, origins)
        sure_filled = [use for use, values in filled if use.fn is fn and use.call.guard < 0 and _is_sure(values)]
        passed_on = list(self._evaluate_references(variable, seen)) if not rows or variable.kind == "local" else []
        remade = any(use.call.line < filled_before for use in sure_filled) or (
            _is_of_parameters(passed_on) and self._is_passed_before(variable, fn, filled_before)
        )
        # What a member is declared with holds no more where the object is given something else from outside.
        outside = (each for writer, each in rows if each.guard < 0 and each.operator == "=" and writer is not fn)
        other = variable.kind == "member" and any("." in each.target.removeprefix("this.") for each in outside)
        left = f"nothing else is assigned to `{variable.name}`" if other else ""
        # In Python that is an assignment too.
        elsewhere = any("." in each.target.removeprefix("this.") for _, each in rows)
        replaced = elsewhere and self.makers.is_replaced(variable)
        begins = not rows or (fn.source.facts.language == "cpp" and not replaced)
        if not begun and not given and not remade and begins:
            found.add(put_under_more(self._evaluate_beginning(variable, fn, seen), left), rank=0)
        for writer, others in group_pairs(row for row in rows if row[0] is not fn or not line).items():
            if remade and writer is not fn and self.code.is_constructor(writer):
                continue
            if self.find_makers(writer) is not None and self._is_made_otherwise(writer):
                continue
            values = self._evaluate_outside(variable, writer, others, filled, origins, seen)
            found.add(put_under_more(values, left if self.code.is_class_body(writer) else ""), stays=True)
        here = [(use, values) for use, values in filled if use.fn is fn and use.call.line < line]
        for use, values in filled:
            if not (use.fn is fn and use.call.line < line):
                found.add(values, rank=2, stays=True)
        found.add(_mark_unknown(passed_on), rank=3, stays=True)
        if variable.kind == "local" and not begun:
            found.add(self._evaluate_parameters(variable, fn, seen), rank=4)
        steps: list[tuple[int, Assignment | FrameworkCall, list[FlowValue]]] = [
            (use.call.line, use, values) for use, values in here if use.call.line >= begun
        ]
        steps += [(each.line, each, []) for each in before if begun <= each.line]
        for _, step, values in sorted(steps, key=itemgetter(0)):
            if isinstance(step, Assignment) and step in turns[1:]:
                found.add(_mark_unknown(self._evaluate_written(step, fn, origins, seen)), step.guard)
            elif isinstance(step, Assignment):
                # What is made of the variable itself is made of what it was before.
                itself = _mentions(step.value, step.target)
                inner = self._leave_out(variable, seen) if itself else seen
                self._follow(step, fn, found, origins, inner)
            elif _is_sure(values):
                found.assign(values, step.call.guard, 2)
            else:
                found.lessen()
                found.add(values, step.call.guard, 2)
        # In the next turn of a loop.
        loops = {guard for guard in around if fn.facts.guards[guard].kind in LOOPS}
        last = [set(fn.list_guards_around(each.guard)) for each in sure if each.line == begun]
        again = loops.difference(set.intersection(*last) if last else ())
        # Or where the function is called anew.
        anew = not begun and variable.kind != "local" and bool(fn.facts.name)
        passed = {id(each) for each in before}
        for each in own:
            if id(each) not in passed and (anew or not again.isdisjoint(fn.list_guards_around(each.guard))):
                found.add(self._evaluate_written(each, fn, origins, seen))
        values = found.list_chosen(
            lambda places: _spell_guards([fn.facts.guards[place] for place in places]),
            lambda place: _spell_guards([fn.facts.guards[place]], negated=True),
        )
        if found.held and not values:
            yield FlowValue(None, "given", f"`{variable.name}` {NOT_PASSED}")
        yield from _restore_alone(values)

    def _select_overridden(self, callee: str, fn: Fn) -> list[Fn]:
        """The functions that a call may reach: of a method that deriving classes override, those of the objects that
        are made."""
        targets = self.code.list_targets(callee, fn)
        head, _, name = callee.rpartition(".")
        owner = self.code.find_owner(fn) if len(targets) > 1 and head in ("", "this") and "::" not in name else None
        if owner is None or not self.code.list_overrides(owner, name):
            return targets
        if self.code.is_constructor(fn) and fn.source.facts.language == "cpp":
            return self.code.find_method(owner, name) or targets  # what derives from it is not begun yet
        kept = {target for cls in self._list_object_classes(owner) for target in self.code.find_method(cls, name)}
        return [target for target in targets if target in kept] or targets

    def _select_declared(
        self, variable: Variable, written: Sequence[tuple[Fn, Assignment]]
    ) -> Sequence[tuple[Fn, Assignment]]:
        """Of what bodies of classes of Python give a member, what the objects have that are made."""
        bodies = {fn.facts.name for fn, _ in written if self.code.is_class_body(fn)}
        owner = next(iter(self.code.list_class_bodies(variable.owner)), None) if len(bodies) > 1 else None
        made = self._list_object_classes(owner) if owner is not None else []
        kept = {next((one.name for one in self.code.list_bases(cls) if one.name in bodies), "") for cls in made}
        left = bodies - kept if kept else set()
        return [row for row in written if row[0].facts.name not in left]

    def _list_object_classes(self, owner: Cls) -> list[Cls]:
        """A class and those that derive from it, as far as something that runs is seen to make objects of them, or a
        host may load them; of those alone that it is about, where it is about some objects."""
        found: list[Cls] = []
        own = [fn for one in self.code.list_bases(owner) for fn in self.code.list_functions(one)]
        limited = any([self.find_makers(fn) is not None for fn in own if self.code.is_constructor(fn)])
        for cls in (owner, *self.code.derived.get(owner.key, ())):
            functions = (fn for one in self.code.list_bases(cls) for fn in self.code.list_functions(one))
            begun = next(filter(self.code.is_constructor, functions), None)
            rows = [row for row in self.code.constructions.get(cls.key, ()) if self.runs(row[0])]
            about = not limited or (begun is not None and any(row in (self.find_makers(begun) or ()) for row in rows))
            exported = get_tail(cls.name) in {get_tail(one) for one in cls.source.facts.exports}
            if (rows and about) or exported:
                found.append(cls)
        return found

    def _is_made_otherwise(self, fn: Fn) -> bool:
        """Whether the objects that it is about are made by other constructors than this one."""
        owner = self.code.find_owner(fn)
        if self.made[fn] or owner is None:
            return False
        return any([self.find_makers(one) for one in self.code.list_functions(owner)])

    def _evaluate_beginning(self, variable: Variable, fn: Fn, seen: tuple) -> Iterator[FlowValue]:
        """What a member or a variable outside of functions is declared with."""
        if variable.kind == "member":
            for cls in self.code.list_class_bodies(variable.owner):
                for member in cls.facts.members:
                    if member.name == variable.name and member.value is not None:
                        holder = next(iter(self.code.list_functions(cls)), fn)
                        if holder.source.path == cls.source.path or member.value.kind == "text":
                            yield from self._evaluate(member.value, holder, member.line, seen)
        elif variable.kind == "global":
            yield from self._evaluate_constant(variable, fn, seen)

    def _evaluate_parameters(self, variable: Variable, fn: Fn, seen: tuple) -> Iterator[FlowValue]:
        """What is passed for a parameter of a function, or of one around it."""
        for one in self.code.list_enclosing_chain(fn):
            place = find_parameter(one, variable.name)
            if place is not None:
                yield from self._evaluate_passed(one, *place, seen)
                break

    def _list_filled(
        self, variable: Variable, seen: tuple, origins: Origins | None
    ) -> list[tuple[FrameworkCall, list[FlowValue]]]:
        """The calls that read a parameter into a variable, with what it is then; also those of functions that do so
        with what they are passed by reference."""
        found = [
            (use, list(self._evaluate_parameter(use, seen)))
            for use in self.filled.get(variable, ())
            if origins is None
            or (target := self.calls.find_argument(use, use.row.variable)) is None
            or self.origins.may_be_of(target.text, use.fn, origins)
        ]
        for one in self._list_references(variable, seen):
            if origins is None or self.origins.may_be_of(one.call.arguments[one.place].text, one.caller, origins):
                values = self.limit_to_calls({**self.way, one.target: one.call})
                values._left = self._left
                rows = values._list_filled(one.inner, (*seen, one.inner), None)
                found += [(use._replace(fn=one.caller, call=one.call), filled) for use, filled in rows]
                self._left = values._left
        return found

    def _select_given(self, rows: Sequence[tuple[Fn, Assignment]]) -> tuple[Sequence[tuple[Fn, Assignment]], bool]:
        """Of assignments those that may be with the arguments of the command line; where an option that is given sets
        the variable, that alone. And whether one does."""
        if not any(self.command_line.is_asked(writer, each.guard) for writer, each in rows):
            return rows, False
        self._note_arguments()
        if self.arguments is None:
            return rows, False
        may = [row for row in rows if not self.command_line.excludes(row[0], row[1].guard, self.arguments)]
        given = [row for row in may if self.command_line.is_option_given(row[0], row[1].guard, self.arguments)]
        return given or may, bool(given)

    def _evaluate_outside(
        self, variable: Variable, writer: Fn, rows: list[Assignment],
        filled: list[tuple[FrameworkCall, list[FlowValue]]], origins: Origins | None, seen: tuple,
    ) -> list[FlowValue]:  # fmt: skip
        """What a function writes into a variable, as it is in the object that the function is of."""
        mark = ("writes", variable, writer)
        inside = self._step_out(variable.owner, mark, writer, seen) if variable.kind == "member" else None
        if inside is None or self._is_in(mark, seen):
            return self._evaluate_elsewhere(variable, writer, rows, filled, origins, seen)
        values, inner = inside
        found = values._evaluate_elsewhere(variable, writer, rows, filled, origins, inner)
        self._left = values._left
        return found

    def _evaluate_elsewhere(
        self, variable: Variable, writer: Fn, rows: list[Assignment],
        filled: list[tuple[FrameworkCall, list[FlowValue]]], origins: Origins | None, seen: tuple,
    ) -> list[FlowValue]:  # fmt: skip
        """What a function writes into a variable, whichever of it holds where another function reads it."""
        found = ReachingValues(writer, (), lambda path: self.code.identify(path, writer) == variable)
        if variable.kind == "global" and self._runs_once(writer, rows):
            return self._follow_module(writer, rows, found, seen)
        sure = [use for use, values in filled if use.fn is writer and _is_sure(values)]
        unsure = [use.call.line for use, values in filled if use.fn is writer and not _is_sure(values)]
        read = {use.call.line for use, _ in filled if use.fn is writer}
        tested = False
        for each in rows:
            # What a parameter that surely has a value is read into is worth nothing else any more.
            if any(each.line < use.call.line and each.guard == use.call.guard for use in sure):
                continue
            if self.decide_branch(each.guard, writer, seen).holds is not False and found.may_run(each.guard):
                tested = found.exclude(each.guard) or tested
                values = _mark_unknown(self._evaluate_written(each, writer, origins, seen))
                # Before a parameter is read, or where it is not there.
                tests = {writer.facts.guards[place].line for place in writer.list_guards_around(each.guard)}
                is_default = any(each.line < line for line in unsure) or not read.isdisjoint(tests)
                found.add(map(lessen, values) if is_default else values, each.guard)
        return found.list_values() if tested else _restore_alone(found.list_values())

    def _runs_once(self, fn: Fn, rows: list[Assignment]) -> bool:
        """Whether a function is the body of a module of Python that gives a variable all of some values before it calls
        anything of the code."""
        if fn.name or fn.source.facts.language != "python" or len(rows) < 2:
            return False
        if any(each.operator != "=" or each.key is not None or "." in each.target for each in rows):
            return False
        lines = [each.line for each in rows]
        between = (call for call in fn.facts.calls if min(lines) < call.line <= max(lines))
        loops = (fn.facts.guards[place].kind for each in rows for place in fn.list_guards_around(each.guard))
        return LOOPS.isdisjoint(loops) and not any(self.code.list_targets(call.callee, fn) for call in between)

    def _follow_module(self, fn: Fn, rows: list[Assignment], found: ReachingValues, seen: tuple) -> list[FlowValue]:
        """What a variable is worth behind the body of its module, which assigns it one value after the other."""
        for each in sorted(rows, key=lambda row: row.line):
            holds = self._decide_by_constants(each.guard, fn, seen)
            if holds is False or self.decide_branch(each.guard, fn, seen).holds is False:
                continue
            values = _mark_unknown(self._evaluate_written(each, fn, None, seen))
            found.assign(values, -1 if holds else each.guard)
        return _restore_alone(
            found.list_chosen(
                lambda places: _spell_guards([fn.facts.guards[place] for place in places]),
                lambda place: _spell_guards([fn.facts.guards[place]], negated=True),
            )
        )

    def _decide_by_constants(self, guard: int, fn: Fn, seen: tuple) -> bool | None:
        """Whether a place in the body of a module is come to, as far as constants of the code alone decide it."""
        opens = True
        for place in fn.list_guards_around(guard):
            one = fn.facts.guards[place]
            asks = one.kind in ASKING and not one.text.startswith("except ")
            decided = self._decide_guard(one, fn, seen) if asks and not self._is_asking(one, fn, seen) else None
            holds = decided.holds if decided is not None and decided.hows <= {"literal"} else None
            if holds is False:
                return False
            opens = opens and holds is True
        return opens or None

    def _follow(
        self, each: Assignment, fn: Fn, found: ReachingValues, origins: Origins | None, seen: tuple
    ) -> None:  # fmt: skip
        """Goes on with an assignment in the function that reads the variable later."""
        branch = self.decide_branch(each.guard, fn, seen)
        if branch.holds is False or not found.may_run(each.guard):
            return
        # What the launch opens surely runs.
        guard = -1 if branch.holds else each.guard
        if each.operator == "+=" and _is_string(each.value) and found.is_counted(each.guard):
            added = list(self._evaluate(each.value, fn, each.line, seen))
            whole = FlowExpr("join", "", (FlowExpr("name", each.target), each.value))
            rows = [(one.value, more) for one in found.held[:_MOST] for more in added[:_MOST]][:_MOST]
            values = _mark_unknown(_join_in_part(row, whole) for row in rows)
        elif each.operator == "/=" and found.is_counted(each.guard):
            added = list(self._evaluate(each.value, fn, each.line, seen))
            rows = [(one.value, more) for one in found.held[:_MOST] for more in added[:_MOST]][:_MOST]
            paths = [(row, posixpath.join(*(one.text or "" for one in row))) for row in rows]
            joined = ((_join(row), path) for row, path in paths)
            values = _mark_unknown(one if one.text is None else one._replace(text=path) for one, path in joined)
        elif _mentions(each.value, each.target) and not found.is_counted(each.guard):
            values = [FlowValue(None, "unresolved", f"`{each.target}` is put together in steps", beside=True)]
        else:
            values = _mark_unknown(self._evaluate_written(each, fn, origins, seen))
        if each.operator in ("=", "+=", "/=") and "." not in each.target.removeprefix("this."):
            found.assign(values, guard)
        else:
            found.add(values, guard)

    def decide_branch(self, guard: int, fn: Fn, seen: tuple = ()) -> DecidedCondition:
        """Whether a place in a function is come to, as far as the launch decides it by parameters, or by how many
        arguments it gives; holds is None for all else, and for what is asked for by the way."""
        if guard < 0 or not self._find_asking(fn, guard):
            return DecidedCondition()
        if self.command_line.is_asked(fn, guard):
            self._note_arguments()
        is_open = bool(self.settings or self.arguments)
        if self._works:
            self._works[-1].is_open = is_open
            self._works[-1].note_depth(_NEAR, len(seen) - self._outer)
        if not is_open or len(seen) - self._outer > _NEAR:
            return DecidedCondition()
        opens = True
        for place in fn.list_guards_around(guard):
            one = fn.facts.guards[place]
            number = None if self.arguments is None else self.command_line.decide_number(one, fn, self.arguments)
            asks = self._may_ask(one)
            decided = self._decide_guard(one, fn, seen) if asks and not self._is_asking(one, fn, seen) else None
            if number is not None:
                decided = DecidedCondition(number, frozenset(("given",)))
            if decided is None or not decided.is_given or decided.holds is None:
                opens = False
            elif not decided.holds:
                return decided
        return DecidedCondition(opens or None)

    def _may_ask(self, guard: Guard) -> bool:
        """Whether a guard may ask for a parameter, by what stands in it."""
        return guard.kind in ASKING and not self.parameter_words.isdisjoint(_WORD.findall(guard.text))

    def _find_asking(self, fn: Fn, guard: int) -> bool:
        """Whether a guard of a function, or one around it, may ask for a parameter or for arguments."""
        known = self._asking.get((fn, guard))
        if known is None:
            around = (fn.facts.guards[place] for place in fn.list_guards_around(guard))
            known = any(map(self._may_ask, around)) or self.command_line.is_asked(fn, guard)
            self._asking[fn, guard] = known
        return known

    @cached_property
    def parameter_words(self) -> frozenset[str]:
        """The last parts of the names of variables that parameters are read into."""
        uses = self.calls.select_uses("parameter")
        words = {get_tail(use.call.target) for use in uses if use.call.target}
        words.update(variable.name for variable in self.filled)
        asked = group_pairs((use.fn, f"{use.call.callee}()") for use in uses if not use.call.target)
        for fn, callees in asked.items():
            # `self.mode = self.get_parameter("mode").value`, `self.go = bool(self.get_parameter("go").value)`
            rows = ((each.target, _find_cast(each.value).text) for each in fn.facts.assignments if each.target)
            words.update(get_tail(target) for target, text in rows if "()" in text and text.startswith(tuple(callees)))
        return frozenset(words)

    def _evaluate_written(
        self, each: Assignment, writer: Fn, origins: Origins | None, seen: tuple
    ) -> Iterator[FlowValue]:  # fmt: skip
        """What an assignment makes of a variable."""
        named = self.by_name.find_row(each) if each.operator == "=" else None
        if named is not None:
            values = self._limit_to_way(named.turns, named.way)
            values._left = self._left
            yield from put_under_more(values._evaluate(each.value, writer, each.line, seen), named.only_if)
            self._left = values._left
            return
        if each.operator == "=":
            if each.target.startswith("this.") and each.value.kind == "list" and len(each.value.parts) > 1:
                return
            if origins is not None and (place := self._find_given(each.value, writer)) is not None:
                yield from self._evaluate_given(writer, place, origins, seen)
                return
            yield from self._evaluate(each.value, writer, each.line, seen)
        elif each.operator == "for":
            yield from self._evaluate_elements(each.value, writer, each.line, seen)
        elif each.operator == "/=":
            yield FlowValue(None, "unresolved", f"`{each.target}` is put together in steps", True)
        elif each.operator == "+=":
            # What is counted has other values beside the first.
            counted = each.value.kind == "number"
            yield FlowValue(None, "unresolved", f"`{each.target}` is put together in steps", counted)

    def _runs_over_all(self, fn: Fn, line: int) -> bool:
        """Whether a loop does what stands on a line in every turn, not only for options that it recognises."""
        around = fn.list_guards_around(_find_guard(fn, line))
        return bool(around) and fn.facts.guards[around[0]].kind in LOOPS

    def _list_references(self, variable: Variable, seen: tuple) -> Iterator[_Reference]:
        """The calls that a variable is passed to by reference."""
        passed = self.code.list_passed(variable)
        if passed and self._works:
            self._works[-1].note_depth(_FAR, len(seen) - self._outer)
        if len(seen) - self._outer > _FAR:
            return  # from hand to hand: a walk over everything that is passed on would not end in time
        for caller, call, place in passed:
            for target in self.code.list_targets(call.callee, caller):
                parameters = target.facts.parameters
                if place < len(parameters) and _is_written_through(parameters[place].type):
                    inner = self.code.identify(parameters[place].name, target)
                    if not self._is_in(inner, seen):
                        yield _Reference(caller, call, place, target, inner)

    def _evaluate_references(self, variable: Variable, seen: tuple) -> Iterator[FlowValue]:
        """What functions write into a variable that is passed to them by reference."""
        for one in self._list_references(variable, seen):
            # Through this call alone.
            values = self.limit_to_calls({**self.way, one.target: one.call})
            values._left = self._left
            yield from values.evaluate_writes(one.inner, (*seen, one.inner))
            self._left = values._left

    def _is_passed_before(self, variable: Variable, fn: Fn, line: int) -> bool:
        """Whether a variable is surely passed on before a line of a function is come to, 0 for any."""
        return any(
            call.guard < 0 and (caller is not fn or not line or call.line < line)
            for caller, call, _ in self.code.list_passed(variable)
        )

    def evaluate_writes(self, variable: Variable, seen: tuple) -> Iterator[FlowValue]:
        """What is written into a variable, where it stands, or fills it from a parameter."""
        for writer, each in self.code.list_writes(variable):
            if each.operator == "=":
                yield from self._evaluate(each.value, writer, each.line, seen)
        for use in self.filled.get(variable, ()):
            yield from self._evaluate_parameter(use, seen)
        yield from self._evaluate_references(variable, seen)

    def _evaluate_constant(self, variable: Variable, fn: Fn, seen: tuple) -> Iterator[FlowValue]:
        name = variable.name
        found = self.code.list_constants(variable, fn)
        built = self.code.list_built_constants(name, fn)
        # The preprocessor, or the program that is built, chooses one of several.
        every = {constant.value for constant, _ in found if constant.value is not None}.union(one for one, _ in built)
        condition = f"`{name}` is defined so" if len(every) > 1 or any(depends for _, depends in built) else ""
        for value, _ in built:
            yield from put_under_more(self._evaluate(value, fn, 0, seen), condition)
        if built and not condition:
            return
        for constant, source in found:
            if constant.value is not None:
                holder = self.code.find_first(source, fn)
                yield from put_under_more(self._evaluate(constant.value, holder, constant.line, seen), condition)
        if found or built:
            return
        if "::" in name or "." in name:
            cls, _, member = name.replace(".", "::").rpartition("::")
            found_class = self.code.find_class(cls, fn.source, fn.scope)
            if found_class is not None:
                variable = Variable("member", found_class.key, member)
                defined = self.code.list_definitions(f"{found_class.name}::{member}")
                for constant, source in defined if len({one.value for one, _ in defined}) == 1 else ():
                    yield from self._evaluate(constant.value, self.code.find_first(source, fn), constant.line, seen)
                    return
                yield from self.evaluate_variable(variable, fn, seen)

    def _evaluate_passed(self, fn: Fn, place: int, parameter: FlowParameter, seen: tuple) -> Iterator[FlowValue]:
        """What callers pass for a parameter, and its default where one of them, or nobody that is known, passes it."""
        given, lacking = False, False
        only, made = self.find_only_call(fn), self.find_makers(fn)
        calls = ((caller, call.arguments, call.line) for caller, call in self.code.callers.get(fn, ())
                 if only is None or call is only)  # fmt: skip
        for caller, arguments, line in made or (*calls, *self.code.list_constructed(fn)):
            if self.runs(caller):
                argument = find_argument(arguments, place, parameter.name)
                given, lacking = given or argument is not None, lacking or argument is None
                if argument is not None:
                    yield from self._evaluate_made(argument, fn, caller, line, seen)
        default = self.code.find_default(fn, place, parameter)
        if default is not None and (lacking or not given):
            yield from self._evaluate(default, fn, fn.facts.line, seen)
        elif not given:
            reason = f"an argument of `{fn.name or 'the module'}`, which nothing here calls"
            yield FlowValue(None, "given", reason, uncalled=self.code.is_idle(fn), unpassed=True)

    def _evaluate_made(self, value: FlowExpr, fn: Fn, maker: Fn, line: int, seen: tuple) -> Iterator[FlowValue]:
        """What a function gives another one: where that makes an object, as it is in the object that the maker is of.
        fn: whom it is given; maker: who gives it."""
        cls = self.code.find_owner(fn)
        mark = ("makes", fn, maker, line)
        inside = self._step_out(cls.key if cls is not None else "", mark, maker, seen)
        if inside is None:
            yield from self._evaluate(value, maker, line, seen)
            return
        if self._is_in(mark, seen):
            yield FlowValue(None, "unresolved", f"`{maker.name}` makes objects that make it again")
            return
        values, inner = inside
        yield from values._evaluate(value, maker, line, inner)
        self._left = values._left

    def _step_out(self, key: str, mark: tuple, fn: Fn, seen: tuple) -> tuple[FlowValues, tuple] | None:
        """The same in objects of the class of a function, and what is being evaluated there; None where these are the
        objects that it is about, or no others are known. key: of the class whose objects it is about."""
        owner = self.code.find_owner(fn)
        outer = self.makers.find_outer(key, owner, self.find_makers) if owner is not None else None
        if not outer or owner is None:
            return None
        inner = (*self.makers.leave_out(seen, owner), mark)
        values = self.limit_to_objects({**self.made, **outer})
        # What is left out, and the mark, change nothing of how deep it is.
        values._left, values._outer = self._left, self._outer + len(inner) - len(seen)
        return values, inner

    def list_given(self, fn: Fn, place: int, name: str) -> Iterator[tuple[FlowExpr, Fn, int]]:
        """What those that run give for a parameter of a function, with who does and at which line."""
        only, made = self.find_only_call(fn), self.find_makers(fn)
        rows = [(caller, call.arguments, call.line) for caller, call in self.code.callers.get(fn, ())
                if only is None or call is only]  # fmt: skip
        rows += [(binder, arguments, 0) for binder, arguments in self.code.bound.get(fn, ())]
        for giver, arguments, line in made or (*rows, *self.code.list_constructed(fn)):
            argument = find_argument(arguments, place, name) if self.runs(giver) else None
            if argument is not None:
                yield argument, giver, line

    def is_left_out(self, fn: Fn) -> bool:
        """Whether a function is a constructor that makes none of the objects which these values are about."""
        return self.find_makers(fn) is not None and self._is_made_otherwise(fn)

    def _find_given(self, value: FlowExpr, fn: Fn) -> tuple[int, FlowParameter] | None:
        """The parameter of a constructor that a value is, None for all else."""
        return find_parameter(fn, value.text) if value.kind == "name" and self.code.is_constructor(fn) else None

    def _evaluate_given(
        self, fn: Fn, parameter: tuple[int, FlowParameter], origins: Origins, seen: tuple
    ) -> Iterator[FlowValue]:
        """What a constructor is given where some objects are made."""
        owner = self.code.find_owner(fn)
        place, facts = parameter
        for maker, arguments, line in self.code.constructions.get(owner.key, ()) if owner is not None else ():
            if (maker.place, arguments) in origins.made and self.runs(maker):
                argument = find_argument(arguments, place, facts.name) or self.code.find_default(fn, place, facts)
                if argument is not None:
                    yield from self._evaluate(argument, maker, line, seen)

    def runs(self, fn: Fn) -> bool:
        """Whether a function runs, as far as it is known which do."""
        runs = self.within is None or fn in self.within
        if self._works:
            (self._works[-1].runs if runs else self._works[-1].idle).add(fn)
        return runs

    def _call(self, value: FlowExpr, fn: Fn, line: int, seen: tuple) -> Iterator[FlowValue]:
        last = get_tail(value.text)
        head = value.text.rpartition(".")[0] if "." in value.text else ""
        # A method of the code may be called the same.
        own = last in _NODE_NAME | _NODE_NAMESPACE and self.code.list_targets(value.text, fn)
        if last in _NODE_NAME and not value.parts and not own:
            yield FlowValue(NODE)
            return
        python = fn.source.facts.language == "python"
        if last in _NODE_NAMESPACE and not value.parts and not own:
            # That of rospy ends in a slash.
            is_rospy = python and self.code.resolve_name(value.text, fn.source) == "rospy.get_namespace"
            yield FlowValue(f"{NAMESPACE}/" if is_rospy else NAMESPACE)
            return
        if python and last in _STRING_METHODS and (head or value.receiver is not None):
            yield from self._evaluate_string_method(value, fn, line, seen)
            return
        got = last == "get" and not python and value.receiver is not None and not value.parts
        if head and (last in _SAME or got):
            called = value.receiver if not python else _find_read_call(head, value)
            if called is not None and (called.kind == "call" or head == "()"):
                yield from self._evaluate(called, fn, line, seen)
            elif head.endswith("()"):
                yield from self._evaluate_inner(head.removesuffix("()"), fn, line, seen)
            else:
                yield from self._evaluate_name(head, fn, line, seen)
            return
        if head and last in ("get", "at") and value.parts and (python or value.receiver is None):
            chosen = self.elements.select(value.receiver or FlowExpr("name", head), value.parts[0], fn, line)
            if chosen:
                for one in chosen:
                    yield from self._evaluate_listed(one, (*seen, ("element", one.value)))
                return
            if python and last == "get" and len(value.parts) == 2 and not head.endswith("()"):
                # What a file holds that the program reads is not known; this is there where it lacks the key.
                yield from self._evaluate(value.parts[1], fn, line, seen)
                yield FlowValue(None, "unresolved", f"what `{value.text}` gives is not known", beside=True)
                return
        if python and last == "format" and head and not head.endswith("()") and value.receiver is None:
            yield from self._evaluate_format(value, head, fn, line, seen)
            return
        if python and value.text == "bool" and len(value.parts) == 1:
            # Of texts too it is asked later whether they stand for what is true.
            yield from self._evaluate(value.parts[0], fn, line, seen)
            return
        if python and value.text == "int" and len(value.parts) == 1:
            for one in self._evaluate(value.parts[0], fn, line, seen):
                whole = one.text is None or is_number(one.text)
                yield one if whole else FlowValue(None, "unresolved", "what `int` gives is not known")
            return
        if value.text == "format" and len(value.parts) == 2 and (python or value.parts[0].kind != "text"):
            written = next(iter(self._evaluate(value.parts[1], fn, line, seen)), _NOT_GIVEN).text
            for one in self._evaluate(value.parts[0], fn, line, seen):
                yield one if one.text is None else _format(one, written)
            return
        if value.text in ("fmt::format", "std::format") and value.parts and value.parts[0].kind == "text":
            joined = make_join(format_pieces(value.parts[0].text), value.parts[1:])
            if joined is not None:
                yield from self._evaluate_join(joined, fn, line, seen)
                return
        if last in ("to_string", "lexical_cast") and len(value.parts) == 1:
            found = list(self._evaluate(value.parts[0], fn, line, seen))
            # Of what is no whole number, it is not the same text.
            if found and all(one.text is not None and is_number(one.text) for one in found):
                yield from found
            else:
                reasons = [one.reason for one in found if one.text is None]
                yield FlowValue(None, "unresolved", (reasons or ["a number as a text is not followed"])[0])
            return
        # Options of ROS 1 are named by the name they are for.
        if last == "string" and len(value.parts) > 1:
            yield FlowValue(None, "unresolved", f"what `{value.text}` makes of several values is not followed")
            return
        if last == "path" and value.text.endswith(("filesystem::path", "fs::path")) and len(value.parts) == 1:
            yield from self._evaluate(value.parts[0], fn, line, seen)
            return
        if (last in _OF_FIRST or (last.startswith("create") and "Options::" in value.text)) and value.parts:
            yield from self._evaluate(value.parts[0], fn, line, seen)
            return
        if last in SHARES and len(value.parts) == 1:
            for one in self._evaluate(value.parts[0], fn, line, seen):
                yield one if one.text is None else one._replace(text=f"$(find {one.text})")
            return
        if last == "getCameraInfoTopic" and len(value.parts) == 1:
            for one in self._evaluate(value.parts[0], fn, line, seen):
                yield one if one.text is None else one._replace(text=make_sibling(one.text, "camera_info"))
            return
        if last == "getName" and len(value.parts) == 1 and head and self._is_loader(head, fn):
            for one in self._evaluate(value.parts[0], fn, line, seen):
                yield one if one.text is None else one._replace(text=re.split(r"[/:]", one.text)[-1])
            return
        if last == "append" and len(value.parts) == 2 and "names" in value.text:
            first, second = value.parts
            yield from self._evaluate_join(FlowExpr("join", "", (first, FlowExpr("text", "/"), second)), fn, line, seen)
            return
        yield from self._evaluate_inner(value.text, fn, line, seen, value.parts)

    def _is_loader(self, path: str, fn: Fn) -> bool:
        """Whether a variable is pluginlib's loader, whose getName() strips a name of its package."""
        return get_tail(self.code.resolve_name_type(path, fn).name) == "ClassLoader"

    def _evaluate_string_method(self, value: FlowExpr, fn: Fn, line: int, seen: tuple) -> Iterator[FlowValue]:
        """What a method of a string of Python gives, and `os.path.join`."""
        head, _, method = value.text.rpartition(".")
        unknown = FlowValue(None, "unresolved", f"what `{value.text}` gives is not known")
        arguments = value.parts
        if method == "join" and value.receiver is None and head.rpartition(".")[2] in ("path", "osp", "posixpath"):
            pieces = [_take_first(self._evaluate(part, fn, line, seen)) for part in arguments]
            for row in islice(product(*pieces), _MOST):
                joined = _join(row)
                texts = [one.text or "" for one in row]
                yield joined if joined.text is None else joined._replace(text=posixpath.join(*texts))
            return
        if method == "join":
            if len(arguments) != 1 or value.receiver is None:
                yield unknown
            elif arguments[0].kind == "list":
                between = [part for each in arguments[0].parts for part in (value.receiver, each)][1:]
                yield from self._evaluate_join(FlowExpr("join", "", tuple(between)), fn, line, seen)
            else:
                listed = self.elements.list_in_order(arguments[0], fn, line)
                if not listed or any(one.only_if for one in listed):
                    yield unknown
                    return
                held = [
                    _take_first(iter(self._evaluate_listed(one, (*seen, ("element", one.value))))) for one in listed
                ]
                for row in islice(product(*held), _MOST):
                    joined = _join(row)
                    texts = [one.text or "" for one in row]
                    yield joined if joined.text is None else joined._replace(text=value.receiver.text.join(texts))
            return
        called = _find_read_call(head, value) if head else value.receiver
        if called is not None:
            held = list(self._evaluate(called, fn, line, seen))
        elif head.endswith("()"):
            held = list(self._evaluate_inner(head.removesuffix("()"), fn, line, seen))
        else:
            held = list(self._evaluate_name(head, fn, line, seen))
        given = [_take_first(self._evaluate(part, fn, line, seen)) for part in arguments]
        for one, *row in islice(product(held, *given), _MOST):
            texts = [each.text for each in row if each.text is not None]
            if one.text is None or len(texts) < len(row):
                yield one if one.text is None else unknown
                continue
            try:
                yield _join((one, *row))._replace(text=getattr(one.text, method)(*texts))
            except (TypeError, AttributeError):
                yield unknown

    def _evaluate_format(
        self, value: FlowExpr, name: str, fn: Fn, line: int, seen: tuple
    ) -> Iterator[FlowValue]:  # fmt: skip
        """What `NAME.format()` puts together, where the text that a variable is, is known."""
        given: dict[int | str, FlowExpr] = dict(enumerate(one for one in value.parts if one.kind != "keyword"))
        given.update((one.text, one.parts[0]) for one in value.parts if one.kind == "keyword" and one.parts)
        for one in self._evaluate_name(name, fn, line, seen):
            if one.text is None:
                yield one
                continue
            pieces = format_pieces(one.text) if "*" not in given and "**" not in given else None
            asked = {piece.value for piece in pieces or () if not isinstance(piece, str)}
            if pieces is None or not asked <= given.keys():
                yield FlowValue(None, "unresolved", f"what `{value.text}` gives is not known")
                continue
            places = {field: place for place, field in enumerate(given)}
            joined = make_join(
                [one if isinstance(one, str) else one._replace(value=places[one.value]) for one in pieces],
                list(given.values()),
            )
            for each in self._evaluate_join(joined, fn, line, seen) if joined is not None else ():
                yield each if each.text is None else _join((one, each))._replace(text=each.text)

    def _evaluate_inner(
        self, callee: str, fn: Fn, line: int, seen: tuple, arguments: tuple[FlowExpr, ...] | None = None
    ) -> Iterator[FlowValue]:
        """What a call inside an expression gives: a parameter's default, or what a function of the code returns."""
        while arguments is None and get_tail(callee) in _SAME and (head := callee.rpartition(".")[0]).endswith("()"):
            callee = head.removesuffix("()")
        near = [*fn.list_calls(callee)]
        # What stands in an expression is not before it.
        near.sort(key=lambda call: (call.line < line, abs(call.line - line), call.arguments != arguments))
        if arguments is not None:
            near = [call for call in near if call.arguments == arguments] or near
        for call in near[:1]:
            use = self.calls.find_use(fn, call)
            if use is not None and use.row.does == "parameter":
                yield from self._evaluate_parameter(use, seen)
                return
            if arguments is None and get_tail(callee) in _OF_FIRST and call.arguments and call.line == line:
                yield from self._evaluate(call.arguments[0], fn, line, seen)
                return
        returned = False
        only = near[0] if near and arguments is not None else None
        targets = self._select_overridden(callee, fn)
        for target in targets if only is None else select_overloads(targets, only, fn):
            form = find_format_place(target) if arguments is not None else None
            if form is not None and arguments is not None:
                returned = True
                yield from self._evaluate_printed(callee, arguments[form:], fn, line, seen)
                continue
            if self._is_in(("returns", target), seen):
                continue
            inner = (*seen, ("returns", target))
            # Through this call alone, where it is seen.
            values = self.limit_to_calls({**self.way, target: only} if only is not None else {})
            values._left = self._left
            for each in target.facts.assignments:
                if each.operator == "return":
                    returned = True
                    yield from values._evaluate_returned(each, target, inner)
            self._left = values._left
        if not returned:
            yield FlowValue(None, "unresolved", f"what `{callee}` gives is not known")

    def _evaluate_printed(
        self, callee: str, arguments: tuple[FlowExpr, ...], fn: Fn, line: int, seen: tuple
    ) -> Iterator[FlowValue]:  # fmt: skip
        """What printf makes of a format and what follows it."""
        for one in self._evaluate(arguments[0], fn, line, seen) if arguments else ():
            pieces = split_percent_format(one.text) if one.text is not None else None
            joined = make_join(pieces, arguments[1:])
            if one.text is not None and joined is None:
                yield FlowValue(None, "unresolved", f"what `{callee}` makes of it is not followed")
            elif joined is None:
                yield one
            else:
                for each in self._evaluate_join(joined, fn, line, seen):
                    yield each if each.text is None else _join((one, each))._replace(text=each.text)

    def _evaluate_returned(self, each: Assignment, fn: Fn, seen: tuple) -> Iterator[FlowValue]:
        """What a function returns at one place, nothing where it does not come there."""
        guards = [fn.facts.guards[place] for place in fn.list_guards_around(each.guard)]
        # What follows a `try` runs where nothing is thrown.
        asking = [guard for guard in guards if guard.kind in ASKING and not guard.text.startswith("catch (")]
        asked = [(guard, self._decide_guard(guard, fn, seen)) for guard in asking]
        if any(decided.holds is False for _, decided in asked):
            return
        unknown = [spell_condition(guard.kind, guard.text) for guard, decided in asked if decided.holds is None]
        unknown += [f"catch ({guard.text})" for guard in guards if guard.kind == "catch"]
        hows: frozenset[How] = frozenset(how for _, decided in asked for how in decided.hows)
        found = self._evaluate(each.value, fn, each.line, seen)
        yield from _put_under(found, DecidedCondition(None, hows), " && ".join(reversed(unknown)))

    def _make_setting_name(self, name: str, use: FrameworkCall) -> str:
        """The name of a parameter in the namespace of the node handle that it is asked of."""
        if not self.node or name[:1] in ("/", "~"):
            return name
        prefix = self._find_prefix(use)
        return f"~{name}" if prefix == "~" else f"{prefix}/{name}" if prefix else name

    def _find_prefix(self, use: FrameworkCall) -> str:
        key = id(use.call)
        if key not in self._prefixes:
            self._note_others()
            self._prefixes[key] = LOST  # as long as it rests on itself
            self._prefixes[key] = self.find_prefix(use, self)
        if not self._prefixes[key].startswith(LOST) or not (self.way or self.made):
            return self._prefixes[key]
        # It may be known of the objects, or the calls, that this is about.
        self._note_others()
        if key in self._asked_prefixes:
            return LOST
        self._asked_prefixes.add(key)
        try:
            return self.find_prefix(use, self)
        finally:
            self._asked_prefixes.discard(key)

    def find_setting_key(self, name: str) -> str:
        """The key among the settings of a parameter by its name in the namespace of its node handle."""
        return resolve_ros1_name(name, self.node) if self.node else name.lstrip("~").lstrip("/")

    def find_setting(self, name: str) -> FlowValue | None:
        """What a launch sets a parameter to; None for nothing. name: in the namespace of its node handle."""
        if not self.node:
            given = self.settings.get(name.lstrip("~").lstrip("/"))
        elif not name.startswith(LOST):
            given = self.settings.get(resolve_ros1_name(name, self.node))
        elif any(key.endswith(name[len(LOST) :]) for key in self.settings):
            reason = f"the parameter `{name}`: the namespace of its node handle is not known"
            return FlowValue(None, "given", reason, beside=True)
        else:
            given = None
        return FlowValue(given, "launch") if given is not None else None

    def find_default(self, use: FrameworkCall) -> tuple[FlowExpr, Fn, int] | None:
        """The only default of the parameter that a use declares or reads, where no launch sets it, with where it
        stands."""
        names = self._list_parameter_names(use, ())
        name = names[0].text if len(names) == 1 else None
        if not name or self._find_setting_of(use, name) is not None:
            return None
        own = DefaultGiven(use)
        others = [one for one in self._list_declared(name) if one.use.call is not use.call]
        others = [one for one in others if one.use.fn.source.package == use.fn.source.package]
        near = [one for one in others if one.use.fn.source is use.fn.source]
        found: list[tuple[FlowExpr, Fn, int]] = []
        for one in (own, *(near or self._select_running(others) or others)):
            default = self.calls.find_argument(one.use, one.use.row.default) if one.use.row.default else None
            if default is not None and not _is_type(default):
                found.append((default, one.use.fn, one.use.call.line))
                if one is own:
                    break
        return found[0] if len(found) == 1 else None

    def list_turns(self, value: FlowExpr, fn: Fn, line: int) -> list[ListElement] | None:
        """What a loop over a list goes through in its turns."""
        return self.elements.list_turns(value, fn, line)

    def note_open(self) -> bool:
        """Whether a launch gives anything, which is noted."""
        if self._works:
            self._works[-1].is_open = bool(self.settings or self.arguments)
        return bool(self.settings)

    def list_settings_below(self, prefix: str) -> dict[str, str]:
        """What a launch sets below a prefix, by the rest of the name; in ROS 1 by a global prefix."""
        head = f"{prefix}{'/' if self.node else '.'}"
        found = {name[len(head) :]: value for name, value in self.settings.items() if name.startswith(head)}
        if self._works:
            self._works[-1].below[prefix] = found
        return found

    def read_server(self, name: str, use: FrameworkCall) -> tuple[str | None, dict[str, str]]:
        """What the parameter server of ROS 1 has under the name that a use gives a parameter: a value, or what is below
        it."""
        setting = self._make_setting_name(name, use)
        if not self.node or setting.startswith(LOST):
            return None, {}
        given = self._find_setting_of(use, name)
        below = self.list_settings_below(resolve_ros1_name(setting, self.node))
        return given.text if given is not None else None, below

    def _find_parameter_name(self, use: FrameworkCall, seen: tuple) -> str:
        """The name that a use gives a parameter, the first of several; empty where it is not known."""
        names = self._list_parameter_names(use, seen)
        return names[0].text or "" if names else ""

    def _list_parameter_names(self, use: FrameworkCall, seen: tuple) -> list[FlowValue]:
        """The names that a use gives a parameter."""
        written = self.calls.find_argument(use, use.row.topic)
        return list({one.text or "": one for one in self._evaluate(written, use.fn, use.call.line, seen)}.values())

    def _find_setting_of(self, use: FrameworkCall, name: str) -> FlowValue | None:
        """What a launch sets the parameter of a use to; None for nothing."""
        setting = self._make_setting_name(name, use)
        given = self.find_setting(setting) if name else None
        if self._works:
            self._works[-1].settings[setting] = given
        return given

    def _list_given_names(self, use: FrameworkCall, seen: tuple) -> list[FlowValue]:
        """The names that a use gives a parameter, where a launch tells them and sets each of these parameters."""
        written = self.calls.find_argument(use, use.row.topic)
        found = list(self._evaluate(written, use.fn, use.call.line, seen)) if written is not None else []
        told = len(found) > 1 and all(one.how == "launch" and one.text for one in found)
        return [self._find_setting_of(use, one.text or "") or _NOT_SET for one in found] if told else []

    def _evaluate_parameter(self, use: FrameworkCall, seen: tuple) -> Iterator[FlowValue]:
        """The default of the parameter that a use declares or reads."""
        several = self._list_given_names(use, seen)
        if several:
            yield from several
            return
        names = self._list_parameter_names(use, seen)
        for name in names[:_MOST] or (FlowValue("", "given"),):
            found = self._evaluate_named(use, name.text or "", seen)
            # Of a parameter that is one of several, each is as certain as its name.
            yield from put_under_more(found, name.only_if) if len(names) > 1 else found

    def _evaluate_named(self, use: FrameworkCall, name: str, seen: tuple) -> Iterator[FlowValue]:
        """The same under one of the names that the use may give the parameter."""
        given = self._find_setting_of(use, name)
        if given is not None:
            yield given
            return
        default = self.calls.find_argument(use, use.row.default) if use.row.default else None
        target = self.calls.find_argument(use, use.row.variable) if use.row.variable else None
        if default is not None and not (default.kind == "name" and default == target) and not _is_type(default):
            for one in self._evaluate(default, use.fn, use.call.line, seen):
                yield one if one.text is None else one._replace(how="default")
            return
        yielded = False
        mark = ("parameter", name)
        declared = self._list_declared(name) if name and not self._is_in(mark, seen) else ()
        others = [other for other in declared if other.use.call is not use.call]
        # Of a program by its own code: programs of one package may declare a parameter each for itself.
        near = [other for other in others if other.use.fn.source is use.fn.source]
        for other in near or self._select_running(others) or others:
            if other.use.fn.source.package != use.fn.source.package:
                continue
            for one in self._evaluate_declaration(other, name, (*seen, mark)):
                if one.text is not None:
                    yielded = True
                    yield one
        if not yielded and any(map(self._is_typed_alone, (DefaultGiven(use), *others))):
            # It has another value than what stands where it is missing.
            yield FlowValue(
                None, "unresolved", f"{NO_DEFAULT}`{name}` is declared without a value: it is given at start"
            )
        elif not yielded:
            reason = f"{NO_DEFAULT}`{name}` {NOT_GIVEN}" if name else "which parameter it is, is not known"
            yield FlowValue(None, "given", reason)

    def _is_typed_alone(self, one: DefaultGiven) -> bool:
        """Whether a parameter is declared with its type alone."""
        default = self.calls.find_argument(one.use, one.use.row.default) if one.use.row.default else None
        return default is not None and _is_type(default)

    def _evaluate_declaration(self, one: DefaultGiven, name: str, seen: tuple) -> Iterator[FlowValue]:
        """The default that a declaration gives a parameter, in the turns of the loops in which it gives it to this
        one."""
        values = self._limit_to_way(one.turns, one.way)
        values._left = self._left
        given = self.calls.find_argument(one.use, one.use.row.default) if one.use.row.default else None
        if given is not None and given.kind == "name":
            # The variable that asks may be the one that had the default before.
            variable = self.code.identify(given.text, one.use.fn)
            seen = self._leave_out(variable, seen) if variable.kind == "local" else seen
        yield from values._evaluate_named(one.use, name, seen)
        self._left = values._left

    def _limit_to_way(self, turns: Mapping[tuple[str, int], int], way: Mapping[Fn, FlowCall]) -> FlowValues:
        """The same code in some turns of loops and through some calls; itself for none."""
        if not turns and not way:
            return self
        chosen, calls = {**self.turns, **turns}, {**self.way, **way}
        return self._make_copy(self.settings, self.arguments, calls, self.within, self.node, self.made, chosen)

    def _list_declared(self, name: str) -> Sequence[DefaultGiven]:
        """The declarations of a parameter, and the reads with a default."""
        return [*self.declared.get(name, ()), *self.by_name.list_declared(name)]

    def _select_running(self, declared: list[DefaultGiven]) -> list[DefaultGiven]:
        """The declarations in functions that run, where it is known which do."""
        if self._works:
            self._works[-1].is_limited = self.within is not None
        return [one for one in declared if self.runs(one.use.fn)] if self.within is not None else []

    @cached_property
    def declared(self) -> dict[str, list[DefaultGiven]]:
        """Declarations of parameters and reads with a default, by their literal names."""
        found: dict[str, list[DefaultGiven]] = {}
        for use in self.calls.select_uses("parameter"):
            if self.calls.find_argument(use, use.row.default) is None:
                continue
            name = self.calls.find_argument(use, use.row.topic)
            if name is not None and name.kind == "text":
                found.setdefault(name.text, []).append(DefaultGiven(use))
        return found

    def list_filling(self, variable: Variable) -> list[FrameworkCall]:
        """The calls that fill a variable with the value of a parameter."""
        return self.filled.get(variable, [])

    @cached_property
    def filled(self) -> dict[Variable, list[FrameworkCall]]:
        """Variables that a call fills with the value of a parameter."""
        found: dict[Variable, list[FrameworkCall]] = {}
        for use in self.calls.select_uses("parameter"):
            if use.row.variable:
                target = self.calls.find_argument(use, use.row.variable)
                if target is not None and target.kind == "name" and not use.call.target:
                    found.setdefault(self.code.identify(target.text, use.fn), []).append(use)
        return found


def make_sibling(topic: str, name: str) -> str:
    """A name in the namespace of a topic (image_transport puts camera_info beside the image)."""
    head, slash, _ = topic.rpartition("/")
    return f"{head}{slash}{name}"


def _join_in_part(row: tuple[FlowValue, ...], value: FlowExpr) -> FlowValue:
    """A text that is put together, known in part where a piece of it is not known. value: the expression."""
    joined = _join(row)
    if joined.text is not None:
        return joined
    parts = zip(row, value.parts, strict=True)
    shown = "".join(
        one.text if one.text is not None else one.shown or make_open_part(f"<{_label(part)}>") for one, part in parts
    )
    known = _WORD_OR_NUMBER.search(_BRACKETS.sub("", shown)) and len(shown) < _LONGEST_IN_PART and "{" not in shown
    return joined._replace(shown=shown if known else "")


def spell_pattern(values: Iterable[FlowValue]) -> str:
    """What names that are not known match, `*` being any text; empty where of one of them nothing is known."""
    found: dict[str, None] = {}
    for one in values:
        if one.text is None:
            patterns = _BRACKETS.sub("*", one.shown).split(OR)
            if one.more or not patterns[0]:
                return ""
            found.update((f"/{each}" if each[0] == "*" else each, None) for each in patterns)
    return OR.join(found)


def _label(value: FlowExpr) -> str:
    """A short name for what is not known."""
    variable = _find_variable(value)
    if variable:
        return f"${variable}"
    while value.kind in ("call", "make", "keyword") and len(value.parts) == 1:
        value = value.parts[0]
    if value.kind == "index" and value.parts:
        return _label(value.parts[0])
    return get_tail(value.text.replace("[]", "").rstrip("().")) or "..."


def _find_variable(value: FlowExpr) -> str:
    """The variable of the environment that an expression asks for, empty for none."""
    asked = None
    if value.kind == "index" and len(value.parts) == 2 and value.parts[0].text.endswith("environ"):
        asked = value.parts[1]
    elif value.kind == "call" and value.parts and value.text.endswith(("environ.get", "getenv")):
        asked = value.parts[0]
    return asked.text if asked is not None and asked.kind == "text" else ""


def _join_texts(*texts: str) -> str:
    return " && ".join(dict.fromkeys(filter(None, texts)))


def _join(row: tuple[FlowValue, ...]) -> FlowValue:
    """A text that is put together, unknown where a piece of it is."""
    unknown = next((one for one in row if one.text is None), None)
    if unknown is not None:
        return unknown
    if sum(len(one.text or "") for one in row) > _LONGEST:
        return FlowValue(None, "unresolved", f"longer than {_LONGEST:,} characters")
    hows = {one.how for one in row}
    known: list[How] = [how for how in _LEAST if how in hows]
    only_if = " && ".join(dict.fromkeys(one.only_if for one in row if one.only_if))
    return FlowValue("".join(one.text or "" for one in row), known[0] if known else _LEAST[-1], only_if=only_if)


def _mark_unknown(values: Iterable[FlowValue]) -> list[FlowValue]:
    """What is assigned, as what may hold in place of others where nothing of it is known."""
    found = list(values)
    return found if any(one.text is not None for one in found) else [one.mark() for one in found]


def _get_key(value: FlowExpr) -> FlowExpr:
    """Of a pair, as a dictionary has it for each key, the key; all else as it is."""
    return value.parts[0] if value.kind == "list" and len(value.parts) == 2 else value


def _find_read_call(path: str, value: FlowExpr) -> FlowExpr | None:
    """The call whose result a path is, or what is kept in it; None where it is something else. value: an expression of
    Python that begins with the path."""
    while value.receiver is not None and get_tail(path) in _SAME:
        path = path.rpartition(".")[0]
    return value.receiver if path.endswith("()") else None


def _find_cast(value: FlowExpr) -> FlowExpr:
    """What an expression of Python makes a truth, a number or a text of; itself where it makes none."""
    return value.parts[0] if value.kind == "call" and value.text in CASTS and len(value.parts) == 1 else value


def _mentions(value: FlowExpr, path: str) -> bool:
    """Whether an expression has a path in it."""
    named = value.kind != "text" and (value.text == path or value.text.startswith(f"{path}."))
    inner = (*value.parts, *((value.receiver,) if value.receiver is not None else ()))
    return named or any(_mentions(part, path) for part in inner)


def _restore_alone(values: list[FlowValue]) -> list[FlowValue]:
    """Values, where nothing is known beside which what is not known could hold, without the mark."""
    return values if any(one.text is not None for one in values) else [one._replace(beside=False) for one in values]


def _find_measured(value: FlowExpr, fn: Fn) -> FlowExpr | None:
    """The list whose length an expression is: of `len(list)` and `list.size()`; None for all else."""
    if fn.source.facts.language == "python":
        return value.parts[0] if value.kind == "call" and value.text == "len" and len(value.parts) == 1 else None
    is_size = value.kind == "call" and value.text.endswith(".size") and not value.parts and value.receiver is None
    return FlowExpr("name", value.text.removesuffix(".size")) if is_size else None


def _tell_how(held: Iterable[ListElement]) -> How:
    """How the elements of a list are known, as far as these say it themselves."""
    kinds = {one.value.kind for one in held}
    return "default" if DEFAULT in kinds else "launch" if SETTING in kinds else "literal"


def _read_character(text: str) -> str:
    """The character that a literal of C++ is; empty where it is none that names can have."""
    inner = text[1:-1]
    if inner[:1] == "\\":
        inner = {"\\": "\\", "'": "'", '"': '"'}.get(inner[1:], "")
    return inner if len(inner) == 1 and inner.isprintable() else ""


def _is_string(value: FlowExpr) -> bool:
    """Whether an expression shows itself to be a string, and no number."""
    written = value.kind == "text" or (value.kind == "number" and value.text[:1] == "'")
    return written or (value.kind == "join" and (not value.text or any(map(_is_string, value.parts))))


_BOOST = re.compile(r"%(?:(?P<place>[1-9])%|\|(?P<barred>[1-9])\$[sd]?\||(?P<next>[sd])|(?P<itself>%))")


def _spell_boost_format(value: FlowExpr) -> FlowExpr | None:
    """`boost::format("/a%1%/%s") % b % c` as a text that is put together; None for all else, and for other formats."""
    if value.text != "%":
        return None
    given: list[FlowExpr] = []
    while value.kind == "join" and value.text == "%" and value.parts:
        given[:0] = value.parts[1:]
        value = value.parts[0]
    written = value.parts[0] if value.parts else None
    if value.kind not in ("call", "make") or get_tail(value.text) != "format" or len(value.parts) != 1:
        return None
    if written is None or written.kind != "text":
        return None
    pieces: list[FlowExpr] = []
    at = number = 0
    for found in _BOOST.finditer(written.text):
        pieces.append(FlowExpr("text", written.text[at : found.start()]))
        at = found.end()
        if found["itself"]:
            pieces.append(FlowExpr("text", "%"))
            continue
        place = int(found["place"] or found["barred"] or 0) - 1 if not found["next"] else number
        number += bool(found["next"])
        if place >= len(given):
            return None
        pieces.append(given[place])
    pieces.append(FlowExpr("text", written.text[at:]))
    plain = "%" not in "".join(one.text for one in pieces[::2])
    return FlowExpr("join", "", tuple(one for one in pieces if one.kind != "text" or one.text)) if plain else None


_WORD_OR_NUMBER = re.compile(r"\w")
_BRACKETS = re.compile(r"<[^<>]*>")
_LONGEST_IN_PART = 200
_COUNTED = re.compile(r"0?[0-9]{0,2}d?")


def _format(value: FlowValue, spec: str | None) -> FlowValue:
    """A value as a format of Python writes it."""
    if spec is None or not _COUNTED.fullmatch(spec) or not is_number(value.text or ""):
        return FlowValue(None, "unresolved", f"how `{spec or '{}'}` writes it is not followed")
    return value._replace(text=format(int(value.text or ""), spec))


def _is_type(value: FlowExpr) -> bool:
    """Whether what stands for a default is the type of the parameter alone: `Parameter.Type.INTEGER`."""
    return value.kind == "name" and value.text.rpartition(".")[0].endswith("Parameter.Type")


def _is_written_through(type: str) -> bool:
    """Whether a function may write into what it is passed for a parameter of a type."""
    return ("&" in type or "*" in type) and "const" not in type


def _is_sure(values: list[FlowValue]) -> bool:
    """Whether a parameter surely has a value."""
    return bool(values) and all(one.how in ("launch", "default") for one in values)


def _is_of_parameters(values: list[FlowValue]) -> bool:
    """Whether values are those of parameters alone, one of which is known."""
    known = [one for one in values if one.text is not None and not one.only_if]
    return _is_sure(known) and all(one.how == "given" for one in values if one.text is None)


def _take_first(values: Iterator[FlowValue]) -> list[FlowValue]:
    """The first different values. What comes after them is not worked out."""
    found: dict[FlowValue, None] = {}
    for value in values:
        found[value] = None
        if len(found) == _MOST:
            break
    return list(found)


def _list_asking(seen: tuple, lines: Collection[tuple[Fn, int]]) -> tuple[tuple, ...]:
    """Of what is being evaluated, the guards that ask on some lines."""
    return tuple(one for one in seen if one[0] == "asks" and one[1:3] in lines)


def _find_guard(fn: Fn, line: int) -> int:
    """The place of the innermost guard that calls and assignments on a line of a function are under, -1 for none."""
    return max(fn.collect_guards(line), default=-1)


def _list_turns(rows: Iterable[Assignment], fn: Fn, line: int, around: Sequence[int]) -> list[Assignment]:
    """Of assignments to a variable the one that the innermost loop around a line begins each turn with, which a
    comprehension has behind its element; several where the line has several loops beside each other. around: the guards
    of what is asked at the line."""
    heads = [each for each in rows if each.guard >= 0 and _begins_turn(each, fn)]
    if heads:
        at = {*around, *(place for guard in fn.collect_guards(line) for place in fn.list_guards_around(guard))}
        heads = [each for each in heads if each.guard in at]
    outer = {place for each in heads for place in fn.list_guards_around(each.guard)[1:]}
    return [each for each in heads if each.guard not in outer]


def _begins_turn(each: Assignment, fn: Fn) -> bool:
    guard = fn.facts.guards[each.guard]
    return guard.kind == "for" and guard.line == each.line


def find_walked(each: Assignment) -> FlowExpr | None:
    """What the loop walks through of which an assignment begins the turns; None for all else."""
    value = each.value
    if value.kind == "index" and len(value.parts) == 2 and value.parts[1] != _EACH:
        value = value.parts[0]
    walks = value.kind == "index" and len(value.parts) == 2 and value.parts[1] == _EACH
    return value.parts[0] if walks else None


def _is_declared_on(each: Assignment, line: int) -> bool:
    """Whether an assignment declares a variable on a line, for what stands behind it there."""
    return each.line == line and bool(each.type) and not _mentions(each.value, each.target)


def _find_guard_before(fn: Fn, line: int) -> int:
    """The place of the innermost guard around a line that begins before the line, -1 for none."""
    around = fn.list_guards_around(_find_guard(fn, line))
    return next((place for place in around if fn.facts.guards[place].line < line), -1)


def spell_condition(kind: str, text: str) -> str:
    """The condition of a guard, as people read it."""
    found = _FLAG.fullmatch(text)
    if found is None:
        return f"!({text})" if kind == "unless" else text
    path = found[2].replace("->", ".").replace("self.", "this.")
    return path if (kind == "unless") == bool(found[1]) else f"!{path}"


def put_under_more(values: Iterable[FlowValue], condition: str) -> Iterable[FlowValue]:
    """Values that are there under one more condition."""
    return [one._replace(only_if=_join_texts(one.only_if, condition)) for one in values] if condition else values


def join_opposites(values: Iterable[FlowValue]) -> tuple[FlowValue, ...]:
    """Values, where the same text is so under a condition and under its opposite, without these."""
    found = list(dict.fromkeys(values))
    by_text = group_pairs((one.text, one.only_if) for one in found if one.text is not None and one.only_if)
    for text, conditions in by_text.items():
        pairs = ((each, opposite) for each in conditions for opposite in (f"!({each})", f"!{each}"))
        both = {one for pair in pairs if pair[1] in conditions for one in pair}
        certain = [one for one in found if one.text == text and one.only_if in both]
        if certain:
            found[found.index(certain[0])] = certain[0]._replace(only_if="")
            found = [one for one in found if one not in certain]
    return tuple(found)


def _spell_guards(guards: Sequence[Guard], negated: bool = False) -> str:
    """The condition under which all of some guards hold, given from the nearest, or do not."""
    kinds = {"if": "unless", "unless": "if"} if negated else {}
    asking = [one for one in guards if one.kind in ASKING and not one.text.startswith("catch (")]
    caught = [structs.replace(one, kind="if", text=f"catch ({one.text})") for one in guards if one.kind == "catch"]
    asking = sorted((*asking, *caught), key=lambda one: one.line, reverse=True) if caught else asking
    return " && ".join(spell_condition(kinds.get(one.kind, one.kind), one.text) for one in reversed(asking))


def _put_under(values: Iterable[FlowValue], decided: DecidedCondition, condition: str) -> Iterator[FlowValue]:
    """Values that hold under a condition that is decided by others: no more certain than these are."""
    for one in values:
        known: list[How] = [how for how in _LEAST if how in decided.hows or how == one.how]
        how = known[0] if one.text is not None and known else one.how
        both = " && ".join(dict.fromkeys(filter(None, (condition, one.only_if))))
        yield one._replace(how=how, only_if=both if one.text is not None else "")
