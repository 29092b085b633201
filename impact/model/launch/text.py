"""Texts of a launch as far as they are known, and the small expressions that launch files compute with.

Sources: roslaunch's substitution_args.py and convert_value(); launch's PythonExpression.
"""

import ast
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from ...facts.launch.actions import TEXT_METHODS, ActionCondition, Value, ValuePart
from ...facts.launch.parameter_files import extract as parameters
from ...facts.launch.parameter_files import parse_scalar
from ...facts.python.text import ARITHMETIC, COMPARISONS
from ..flow.names import join_name

LONGEST = 100_000


class LaunchText(NamedTuple):
    """A text as far as it is known. value: None where it is not. shown: what is known of it, the rest as `<...>`.
    reasons: why it is not known. chosen: whether it rests on the default of a launch argument, for which whoever starts
    the launch may give another value."""

    value: str | None
    shown: str
    reasons: tuple[str, ...] = ()
    chosen: bool = False


def wrap(value: str) -> LaunchText:
    """A text that is known."""
    return LaunchText(value, value)


def make_unknown(shown: str, *reasons: str) -> LaunchText:
    """A text that is not."""
    return LaunchText(None, f"<{shown}>", reasons)


_BETWEEN = " or "
_MOST_EITHER, _MORE = 6, "..."


def make_either(first: str, second: str, *reasons: str) -> LaunchText:
    """A text that is one of two, as each is shown: `<a or b>`. Each of what they may be stands once, however often it
    was put over another, and no more of them than a person reads."""
    found = list(dict.fromkeys(each for shown in (first, second) for each in list_either(shown)))
    if len(found) == 1 and "<" in found[0]:
        return LaunchText(None, found[0], reasons)
    if len(found) > _MOST_EITHER or _MORE in found:
        found = [*[each for each in found if each != _MORE][:_MOST_EITHER], _MORE]
    return make_unknown(_BETWEEN.join(found), *reasons)


def list_either(shown: str) -> list[str]:
    """What a text that make_either() made may be; the text itself for another."""
    if not (shown.startswith("<") and shown.endswith(">") and _BETWEEN in shown):
        return [shown]
    found, depth = [""], 0
    for character in shown[1:-1]:
        depth += (character == "<") - (character == ">")
        if depth < 0:  # Two parts that are not known, and not one that holds others.
            return [shown]
        found[-1] += character
        if depth == 0 and found[-1].endswith(_BETWEEN):
            found[-1] = found[-1].removesuffix(_BETWEEN)
            found.append("")
    return found


def join_texts(texts: Sequence[LaunchText], between: str = "") -> LaunchText:
    """Texts one after the other as one."""
    value = None if any(t.value is None for t in texts) else between.join(t.value or "" for t in texts)
    if value is not None and len(value) > LONGEST:
        return make_unknown("...", "is too long")
    shown = value if value is not None else between.join(t.shown for t in texts)[:LONGEST]
    return LaunchText(value, shown, merge_reasons(t.reasons for t in texts), any(t.chosen for t in texts))


def resolve(namespace: LaunchText, name: LaunchText) -> LaunchText:
    """A name put into a namespace."""
    if name.value is not None and name.value[:1] == "/":
        return name
    if namespace.value is None or name.value is None:
        both = join_texts((namespace, name), "/")
        return both._replace(value=None, shown=both.shown.replace("//", "/"))
    return wrap(join_name(namespace.value, name.value))


_MOST = 200


def merge_reasons(groups: Iterable[tuple[str, ...]]) -> tuple[str, ...]:
    """All of several reasons, each once, in order, as far as a person reads on."""
    return tuple(dict.fromkeys(item for group in groups for item in group))[:_MOST]


def show(value: Value) -> str:
    """A value as a person would write it."""
    return "".join(_show_piece(piece) for piece in value)


def _show_piece(piece: ValuePart) -> str:
    if piece.kind == "text":
        return piece.text
    if piece.kind == "other":
        return f"<{piece.text}>"
    parts = [show(part) for part in piece.parts]
    if piece.kind == "eval":
        return f"$(eval {parts[0]})"
    if piece.kind == "equals" and len(parts) == 2:
        return f"{parts[0]} == {parts[1]}"
    if piece.kind in ("and", "or"):
        return f" {piece.kind} ".join(f"({part})" for part in parts)
    if piece.kind == "not":
        return f"not ({parts[0]})" if parts else "not"
    if piece.kind == "in":
        return f"{parts[0]} in ({', '.join(parts[1:])})"
    if piece.kind == "choose":
        return f"({parts[1]} if {parts[0]} else {parts[2]})"
    if piece.kind == "join":
        return "/".join(parts)
    return f"$({' '.join([piece.kind, *([piece.text] if piece.text else []), *parts])})"


def show_condition(condition: ActionCondition) -> str:
    text = show(condition.value)
    return f"not ({text})" if condition.kind == "unless" else text


def parse_truth(text: LaunchText) -> bool | None:
    """What roslaunch and launch make of a text that is asked: True, False, or None for what they refuse."""
    if text.value is None:
        return None
    return {"true": True, "1": True, "false": False, "0": False}.get(text.value.strip().lower())


def format_flag(value: bool) -> str:
    return "true" if value else "false"


class CannotTell(Exception):
    """An expression that is not evaluated; the message says why."""


_FUNCTIONS: dict[str, Any] = {
    "str": str, "int": int, "float": float, "bool": bool, "abs": abs, "min": min, "max": max, "len": len,
    "round": round, "any": any, "all": all,
}  # fmt: skip
_OF_MATH = frozenset(("sqrt", "sin", "cos", "radians", "degrees", "floor", "ceil"))
METHODS = TEXT_METHODS | {"split", "isdigit", "find", "count"}


def call_text_method(receiver: str, name: str, arguments: Sequence[Any]) -> Any:
    """What one of METHODS gives. Raises CannotTell for other methods, wrong arguments and long results."""
    longest = max((len(a) for a in arguments if isinstance(a, str)), default=0)
    if name not in METHODS or len(receiver) * longest > LONGEST:
        raise CannotTell(f"`{name}` is not evaluated")
    try:
        return getattr(receiver, name)(*arguments)
    except (TypeError, ValueError) as error:
        raise CannotTell(f"`{name}` fails: {error}") from error


def evaluate(expression: str, names: Mapping[str, Any], functions: Mapping[str, Any]) -> Any:
    """The value of a small Python expression: constants, comparisons, sums, methods of str, and the names and functions
    given. Raises CannotTell for anything else. names: to their values, or what gives these when they are asked for."""
    if len(expression) > 10_000:
        raise CannotTell("is too long")
    try:
        tree = ast.parse(expression.strip(), mode="eval")
        return _Evaluator(names, functions).evaluate(tree.body)
    except CannotTell:
        raise
    except (SyntaxError, ValueError, TypeError, ArithmeticError, LookupError, AttributeError) as error:
        raise CannotTell(f"`{expression[:80]}` fails: {error}") from error
    except (RecursionError, MemoryError) as error:
        raise CannotTell("is nested too deeply") from error


class _Evaluator:
    def __init__(self, names: Mapping[str, Any], functions: Mapping[str, Any]):
        self.names = names
        self.functions = functions

    def evaluate(self, node: ast.expr) -> Any:
        if isinstance(node, ast.Constant):
            return node.value
        if isinstance(node, ast.Name):
            if node.id in self.names:
                found = self.names[node.id]
                return found() if callable(found) else found
            raise CannotTell(f"`{node.id}` is no name an expression may use")
        if isinstance(node, ast.BoolOp):
            result: Any = None
            for part in node.values:
                result = self.evaluate(part)
                if bool(result) == isinstance(node.op, ast.Or):
                    break
            return result
        if isinstance(node, ast.UnaryOp):
            operand = self.evaluate(node.operand)
            if isinstance(node.op, ast.Not):
                return not operand
            if isinstance(node.op, ast.USub):
                return -operand
            if isinstance(node.op, ast.UAdd):
                return +operand
        if isinstance(node, ast.BinOp):
            return self.evaluate_arithmetic(node)
        if isinstance(node, ast.Compare):
            left = self.evaluate(node.left)
            for op, right_node in zip(node.ops, node.comparators, strict=True):
                right = self.evaluate(right_node)
                if not COMPARISONS[type(op)](left, right):
                    return False
                left = right
            return True
        if isinstance(node, ast.IfExp):
            return self.evaluate(node.body if self.evaluate(node.test) else node.orelse)
        if isinstance(node, (ast.List, ast.Tuple)):
            return [self.evaluate(element) for element in node.elts]
        if isinstance(node, ast.Subscript):
            return self.evaluate(node.value)[self.index(node.slice)]
        if isinstance(node, ast.Call) and not node.keywords:
            return self.call(node)
        raise CannotTell(f"`{ast.unparse(node)[:80]}` is not evaluated")

    def index(self, node: ast.expr) -> Any:
        if not isinstance(node, ast.Slice):
            return self.evaluate(node)
        return slice(
            *(None if bound is None else self.evaluate(bound) for bound in (node.lower, node.upper, node.step))
        )

    def evaluate_arithmetic(self, node: ast.BinOp) -> Any:
        left, right = self.evaluate(node.left), self.evaluate(node.right)
        calculate = ARITHMETIC.get(type(node.op))
        if calculate is None:
            raise CannotTell(f"`{ast.unparse(node)[:80]}` is not evaluated")
        if isinstance(node.op, (ast.Mult, ast.Mod)) and (
            isinstance(left, (str, list)) or isinstance(right, (str, list))
        ):
            raise CannotTell(f"`{ast.unparse(node)[:80]}` is not evaluated")
        result = calculate(left, right)
        if isinstance(result, int) and abs(result) > 2**63:
            raise CannotTell("is too large a number")
        return result

    def call(self, node: ast.Call) -> Any:
        arguments = [self.evaluate(argument) for argument in node.args]
        if isinstance(node.func, ast.Name):
            function = self.functions.get(node.func.id) or _FUNCTIONS.get(node.func.id)
            if function is not None:
                return function(*arguments)
        if isinstance(node.func, ast.Attribute):
            if isinstance(node.func.value, ast.Name) and node.func.value.id == "math":
                function = getattr(math, node.func.attr, None)
                if callable(function) and node.func.attr in _OF_MATH:
                    return function(*arguments)
            if node.func.attr in METHODS:
                receiver = self.evaluate(node.func.value)
                if isinstance(receiver, str):
                    return call_text_method(receiver, node.func.attr, arguments)
        raise CannotTell(f"`{ast.unparse(node)[:80]}` is not evaluated")


def parse_ros1_value(text: str) -> Any:
    """An argument of ROS 1 as an expression sees it, as roslaunch's convert_value() makes it; the text where it is no
    number and no bool."""
    try:
        if "." in text:
            return float(text)
        if "_" not in text:
            return int(text)
    except ValueError:
        pass
    word = text.lower().strip()
    return word == "true" if word in ("true", "false") else text


def parse_yaml_value(text: str) -> Any:
    """What a text is by YAML's rules; mappings stay text."""
    if text[:1] not in ("[", "'", '"', "-", "!", "&", "{", ">", "|"):
        return parse_scalar(text.strip())
    entries = parameters(text).entries
    return entries[0].value if len(entries) == 1 and entries[0].path == () else parse_scalar(text)
