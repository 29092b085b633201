"""Whether conditions in C++ and Python code hold, as far as what they ask for has values that are known."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator
from functools import lru_cache
from itertools import product
from typing import Any, NamedTuple

from ...conditions.logic import combine_and, combine_or, negate
from ...conditions.python import parse_expression
from ...facts.flow import FlowExpr, Guard
from ...facts.python.text import COMPARISONS
from .graph import How

# Longer conditions are not looked into.
_LONGEST = 500
_MOST_COMBINED = 64
# What C++ writes otherwise than Python; `~` binds as `!` does. Of the operators on bits nothing is known.
_CPP = re.compile(
    r"\"(?:[^\"\\]|\\.)*\"|'(?:[^'\\]|\\.)*'|&&|\|\||!=|!|->|::|[~&|^]|\b(?:not|true|false|nullptr|NULL)\b"
)
_AS_PYTHON = {
    "&&": " and ", "||": " or ", "!": " ~", "not": " ~", "->": ".", "::": "._of_.", "true": "True", "false": "False",
    "nullptr": "None", "NULL": "None",
}  # fmt: skip
_BITS = frozenset("~&|^")
_TRUTH = {"true": True, "True": True, "false": False, "False": False}
NOTHING = frozenset(("None", "nullptr", "NULL"))
"""What code calls an object that is not there."""
# Questions that strings answer, by the method's name; how long something is may be asked of a list.
_ASKED: dict[str, Callable[..., Any]] = {
    "empty": lambda text: not text, "front": lambda text: text[:1], "back": lambda text: text[-1:],
    "startswith": str.startswith, "starts_with": str.startswith, "endswith": str.endswith, "ends_with": str.endswith,
    "lower": str.lower, "upper": str.upper, "strip": str.strip,
}  # fmt: skip
_LENGTHS = frozenset(("size", "length"))
CASTS = frozenset(("int", "float", "bool", "double", "str"))
_Known = list[tuple[Any, frozenset[How]]]


class DecidedCondition(NamedTuple):
    """holds: None where that cannot be known. hows: how the values are known that it rests on; of a condition that may
    hold or not, none where one of its values is not known at all. asks_open: it asks for a parameter that nothing known
    gives a value."""

    holds: bool | None = None
    hows: frozenset[How] = frozenset()
    asks_open: bool = False

    @property
    def is_given(self) -> bool:
        """Whether it rests on what a launch gives, and on nothing that whoever starts the node may change."""
        return not self.hows.isdisjoint(("launch", "given")) and "default" not in self.hows


class ConditionReader:
    """Decides the conditions of one function. is_cpp: its language; list_values: what an expression may be worth there,
    as text with how it is known; None for what is not known."""

    def __init__(self, is_cpp: bool, list_values: Callable[[FlowExpr], list[tuple[str, How]] | None]):
        self._is_cpp, self._list_values = is_cpp, list_values

    def decide_guard(self, guard: Guard) -> DecidedCondition:
        """Whether what is under a guard is come to."""
        node = _parse_guard(guard.kind, guard.text, self._is_cpp)
        if node is None:
            return DecidedCondition()
        decided = self._decide(node)
        return decided._replace(holds=negate(decided.holds)) if guard.kind == "unless" else decided

    def _decide(self, node: ast.expr) -> DecidedCondition:
        if isinstance(node, ast.BoolOp):
            parts = [self._decide(value) for value in node.values]
            both = isinstance(node.op, ast.And)
            # One part that decides is enough, and rests on nothing else.
            deciding = [part for part in parts if part.holds is not both and part.holds is not None]
            if deciding:
                return next((part for part in deciding if part.is_given), deciding[0])
            holds = parts[0].holds
            for part in parts[1:]:
                holds = (combine_and if both else combine_or)(holds, part.holds)
            if holds is None and any(part.holds is None and not part.hows for part in parts):
                return DecidedCondition()
            return DecidedCondition(holds, parts[0].hows.union(*(part.hows for part in parts)))
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Invert if self._is_cpp else ast.Not):
            inner = self._decide(node.operand)
            return inner._replace(holds=negate(inner.holds))
        if isinstance(node, ast.Compare):
            left, right = (self._evaluate(part) for part in (node.left, node.comparators[0]))
            compare = COMPARISONS.get(type(node.ops[0]))
            if len(node.ops) > 1 or left is None or right is None or compare is None:
                return DecidedCondition()
            pairs = product(left, right)
            return _combine((self._compare(one[0], other[0], compare), one[1] | other[1]) for one, other in pairs)
        values = self._evaluate(node)
        return _combine((self.find_truth(value), hows) for value, hows in values or ())

    def find_truth(self, value: Any) -> bool | None:
        """Whether a value holds where it is a condition."""
        return _find_truth(value, self._is_cpp)

    def compare_to_nothing(self, text: str, is_equal: bool) -> bool | None:
        """Whether a value is None or nullptr, or is not."""
        del text, is_equal
        return None  # what is nothing at first is made meanwhile

    def measure(self, text: str) -> int | None:
        """How long a text is."""
        del text
        return None  # it may be asked of a list

    def _compare(self, left: Any, right: Any, compare: Callable[[Any, Any], Any]) -> bool | None:
        if compare in _EQUALITY and isinstance(left, str) and right is None:
            return self.compare_to_nothing(left, compare in _EQUAL)
        return _compare(left, right, compare)

    def _evaluate(self, node: ast.expr) -> _Known | None:
        """What an expression may be worth, None where that is not known."""
        if isinstance(node, ast.Constant):
            return [(node.value, frozenset())]
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub) and isinstance(node.operand, ast.Constant):
            value = node.operand.value
            return [(-value, frozenset())] if isinstance(value, (int, float)) else None
        if isinstance(node, (ast.Tuple, ast.List, ast.Set)):
            parts = [part.value for part in node.elts if isinstance(part, ast.Constant)]
            return [(tuple(parts), frozenset())] if len(parts) == len(node.elts) else None
        asked = self._evaluate_question(node)
        if asked is not None:
            return asked
        expression = _convert(node)
        known = self._list_values(expression) if expression is not None else None
        return None if not known else [(text, frozenset((how,))) for text, how in known[:_MOST_COMBINED]]

    def _evaluate_question(self, node: ast.expr) -> _Known | None:
        """What a string says about itself: `text.empty()`, `text.startswith("/")`, `text[0]`."""
        ask: Callable[..., Any] | None = None
        inner: ast.expr | None = None
        given: list[ast.expr] = []
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            ask, inner, given = _ASKED.get(node.func.attr), node.func.value, node.args
            if node.func.attr in _LENGTHS and not node.args:
                return self._measure(node.func.value)
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and len(node.args) == 1:
            ask = (lambda text: text) if node.func.id in CASTS else None
            inner = node.args[0]
            if node.func.id == "len":
                return self._measure(inner)
        elif isinstance(node, ast.Call) and _asks_for_bool(node):
            return self._evaluate_bool(node.args[0])
        elif isinstance(node, ast.Subscript):
            ask, inner, given = (lambda text, place: text[place]), node.value, [node.slice]
        arguments = [self._evaluate(one) for one in given] if ask is not None else []
        values = self._evaluate(inner) if ask is not None and inner is not None else None
        if ask is None or values is None or any(one is None or len(one) != 1 for one in arguments):
            return None
        if any(not isinstance(value, str) or value[:1] == "[" for value, _ in values):
            return None
        found: _Known = []
        for value, hows in values:
            try:
                found.append((ask(value, *(one[0][0] for one in arguments if one)), hows))
            except (TypeError, IndexError, ValueError):
                return None
        return found

    def _evaluate_bool(self, node: ast.expr) -> _Known | None:
        """Whether what an expression is worth is a bool."""
        values = self._evaluate(node) or []
        return [(isinstance(value, bool) or value in _TRUTH, hows) for value, hows in values] or None

    def _measure(self, node: ast.expr) -> _Known | None:
        """How long a text is."""
        values = self._evaluate(node) or []
        found = [(self.measure(value) if isinstance(value, str) else None, hows) for value, hows in values]
        return None if not found or any(length is None for length, _ in found) else found


def is_truth(text: str, is_cpp: bool) -> bool:
    """Whether an expression is a comparison or a negation, which gives true or false."""
    node = _parse_guard("if", text, is_cpp)
    negation = ast.Invert if is_cpp else ast.Not
    return isinstance(node, ast.Compare) or (isinstance(node, ast.UnaryOp) and isinstance(node.op, negation))


def _asks_for_bool(node: ast.Call) -> bool:
    """Whether a call is `isinstance(..., bool)`."""
    names = [one.id for one in (node.func, *node.args[1:]) if isinstance(one, ast.Name)]
    return names == ["isinstance", "bool"] and len(node.args) == 2


def _combine(every: Iterator[tuple[bool | None, frozenset[How]]]) -> DecidedCondition:
    rows = list(every)
    answers = {answer for answer, _ in rows}
    hows: frozenset[How] = frozenset(how for _, here in rows for how in here)
    return DecidedCondition(answers.pop() if len(answers) == 1 else None, hows)


def _find_truth(value: Any, is_cpp: bool) -> bool | None:
    if not isinstance(value, str):
        return bool(value)
    number = _find_number(value)
    if value in _TRUTH or value in NOTHING:
        return _TRUTH.get(value)
    return bool(number) if number is not None else None if is_cpp else bool(value)


def _compare(left: Any, right: Any, compare: Callable[[Any, Any], Any]) -> bool | None:
    """Of two values, which are texts where the code does not write them."""
    for one, other in ((left, right), (right, left)):
        if not isinstance(one, str):
            continue
        if isinstance(other, tuple):
            return bool(compare(one, other)) if one is left and all(isinstance(each, str) for each in other) else None
        if isinstance(other, bool):
            one = _TRUTH.get(one)
        elif other is None:
            return None  # what is nothing at first is made meanwhile
        elif isinstance(other, (int, float)):
            one = _find_number(one)
        elif _find_number(one) is not None and _find_number(other) is not None:
            return bool(compare(_find_number(one), _find_number(other))) if compare in _ORDERED else None
        else:
            return bool(compare(left, right)) if compare in _EQUALITY else None
        if one is None:
            return None
        left, right = (one, other) if isinstance(left, str) else (other, one)
    try:
        return bool(compare(left, right))
    except TypeError:
        return None


_EQUALITY = (COMPARISONS[ast.Eq], COMPARISONS[ast.NotEq], COMPARISONS[ast.Is], COMPARISONS[ast.IsNot])
_EQUAL = (COMPARISONS[ast.Eq], COMPARISONS[ast.Is])
_ORDERED = (*_EQUALITY, *(COMPARISONS[one] for one in (ast.Lt, ast.LtE, ast.Gt, ast.GtE)))


def _find_number(text: str) -> float | None:
    try:
        return float(text) if text[:1] in "+-.0123456789" and text else None
    except ValueError:
        return None


@lru_cache(maxsize=16384)
def _parse_guard(kind: str, text: str, is_cpp: bool) -> ast.expr | None:
    """What a guard asks, as Python has it; None for what is not followed."""
    if kind == "case":
        subject, other, values = text.partition(" other than ")
        if not other:
            subject, _, values = text.partition(" == ")
        sign, joint, between = ("!=", " and ", ", ") if other else ("==", " or ", " or ")
        text = joint.join(f"({subject}) {sign} ({value})" for value in values.split(between))
    elif kind not in ("if", "unless"):
        return None
    if len(text) > _LONGEST:
        return None
    if is_cpp:
        if not _BITS.isdisjoint(match for match in _CPP.findall(text)):
            return None
        text = _CPP.sub(lambda match: _AS_PYTHON.get(match[0], match[0]), text)
    return parse_expression(text)


def _convert(node: ast.expr) -> FlowExpr | None:
    """A name or call as facts have it, None for all else."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return FlowExpr("text", node.value)
    if isinstance(node, ast.Call):
        callee, arguments = _spell(node.func), [_convert(one) for one in node.args]
        known = callee and not node.keywords and None not in arguments
        return FlowExpr("call", callee, tuple(one for one in arguments if one is not None)) if known else None
    path = _spell(node)
    return FlowExpr("name", path) if path else None


def _spell(node: ast.expr) -> str:
    """A path as facts have it, empty for what is none."""
    parts: list[str] = []
    while isinstance(node, (ast.Attribute, ast.Call)):
        if isinstance(node, ast.Attribute):
            parts.append(node.attr)
            node = node.value
        else:
            node = node.func
            if isinstance(node, ast.Attribute):
                parts.append(f"{node.attr}()")
                node = node.value
            elif isinstance(node, ast.Name):
                node = ast.Name(f"{node.id}()")
    if not isinstance(node, ast.Name):
        return ""
    parts.append("this" if node.id == "self" else node.id)
    return ".".join(reversed(parts)).replace("._of_.", "::")
