"""What the options of a node of ROS 2 say of its name: arguments of its own, and that it takes none of the program's.

Source: rclcpp's NodeOptions, and rcl's node.c: arguments of the node come before those of the program, and with
`use_global_arguments(false)` those of the program, which a launch file gives, are not looked at.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from ...facts.flow import FlowCall, FlowExpr
from .calls import FrameworkCall
from .code import FlowCode, Fn, find_parameter, get_tail
from .names import RemappingRule, parse_ros2_rule
from .types import Cls
from .values import FlowValues

_STRINGS = frozenset(("std::string", "string"))
_CLASS = "NodeOptions"
_ALONE = "use_global_arguments"
_REMAPS = frozenset(("-r", "--remap"))
_DEEPEST = 4
_HANDS_ON = frozenset((_CLASS, "move", "forward"))
_ARGUMENTS = "arguments"


class GivenPiece(NamedTuple):
    """An expression that is given to a node. fn, line: where it is written; guard: under which, -1 for none; way: the
    call through which that function is reached, by the function."""

    value: FlowExpr
    fn: Fn
    line: int
    guard: int = -1
    way: tuple[tuple[Fn, FlowCall], ...] = ()

    def list_texts(self, values: FlowValues) -> set[str | None]:
        """What it may be, None for what is not known."""
        return {one.text for one in values.limit_to_calls(dict(self.way)).evaluate(self.value, self.fn, self.line)}


class NodeOptions:
    """Asks a body of code for the options that nodes are given."""

    def __init__(self, code: FlowCode):
        self.code = code

    def find_rule(self, use: FrameworkCall, rule: str, values: FlowValues) -> GivenPiece | None:
        """What the arguments among the options of a node remap to by a rule (`__ns:=`); None where they have none such.
        values: what expressions are worth where the node is made."""
        for piece in self._list_pieces(use, values):
            found = _find_rule(piece.value, rule)
            if found is not None:
                # Whether it is given hangs on a condition.
                return piece._replace(value=found if piece.guard < 0 else FlowExpr("other"))
        return None

    def is_alone(self, use: FrameworkCall, values: FlowValues) -> bool:
        """Whether a node does not take the arguments of its program."""
        return any(_is_turned_off(piece.value) for piece in self._list_pieces(use, values))

    def is_handed(self, use: FrameworkCall, loaded: Cls, values: FlowValues) -> bool:
        """Whether the options of a node are those that a container hands to a component, whose arguments they have.
        loaded: the class of the component."""
        pieces = list(self._list_pieces(use, values))
        if any(piece.value.parts and get_tail(piece.value.text) == _ARGUMENTS for piece in pieces):
            return False  # it has others
        return any(self._is_handed_in(piece, loaded) for piece in pieces)

    def _is_handed_in(self, piece: GivenPiece, loaded: Cls) -> bool:
        if piece.value.kind != "name" or not self.code.is_constructor(piece.fn):
            return False
        owner, place = self.code.find_owner(piece.fn), find_parameter(piece.fn, piece.value.text)
        of_class = owner is not None and owner.key == loaded.key
        return of_class and place is not None and _CLASS in piece.fn.facts.parameters[place[0]].type

    def are_dropped(self, loaded: Cls) -> bool:
        """Whether a component does nothing with the options that a container hands to it."""
        makers = [fn for fn in self.code.list_functions(loaded) if self.code.is_constructor(fn)]
        handed = [(fn, one.name) for fn in makers for one in fn.facts.parameters if _CLASS in one.type]
        return bool(handed) and not any(name and _mentions(fn, name) for fn, name in handed)

    def list_remaps(self, use: FrameworkCall, values: FlowValues) -> tuple[RemappingRule, ...]:
        """The remappings of names that the options of a node have, where these are written out."""
        found: dict[RemappingRule, None] = {}
        for piece in self._list_pieces(use, values):
            for text in _list_remaps(piece.value):
                rule = parse_ros2_rule(text)
                if rule is not None and not rule.match.startswith("__"):
                    found[rule] = None
        return tuple(found)

    def _list_pieces(self, use: FrameworkCall, values: FlowValues) -> Iterator[GivenPiece]:
        for argument in use.call.arguments:
            yield from self._follow(GivenPiece(argument, use.fn, use.call.line), values, 0)

    def _follow(self, piece: GivenPiece, values: FlowValues, depth: int) -> Iterator[GivenPiece]:
        """An expression with what it is made from: what is assigned to a variable of options, what is set in it, what a
        function of the code makes, and what a constructor is given."""
        yield piece
        value, fn = piece.value, piece.fn
        if depth > _DEEPEST:
            return
        if value.kind == "keyword" and value.parts:
            yield from self._follow(piece._replace(value=value.parts[0]), values, depth + 1)
        elif value.kind == "call":
            if get_tail(value.text) in _HANDS_ON and len(value.parts) == 1:
                yield from self._follow(piece._replace(value=value.parts[0]), values, depth + 1)
            targets = self.code.list_targets(value.text, fn)
            calls = [call for call in fn.list_calls(value.text) if call.arguments == value.parts]
            if value.receiver is not None:
                yield from self._follow(piece._replace(value=value.receiver), values, depth + 1)
            if "." in value.text and not value.text.startswith("()"):
                held = FlowExpr("name", value.text.partition("().")[0].rpartition(".")[0])
                yield from self._follow(piece._replace(value=held), values, depth + 1) if held.text else ()
            if len(targets) == 1 and calls:
                target = targets[0]
                written = [(row.guard, row.line, one) for row in target.facts.calls for one in row.arguments]
                written += [(row.guard, row.line, _make_expression(row)) for row in target.facts.calls]
                written += [(each.guard, each.line, each.value) for each in target.facts.assignments]
                for guard, line, one in written:
                    yield GivenPiece(one, target, line, guard, ((target, calls[0]),))
        elif value.kind == "make" and get_tail(value.text) in _HANDS_ON and len(value.parts) == 1:
            yield from self._follow(piece._replace(value=value.parts[0]), values, depth + 1)
        elif value.kind == "name":
            yield from self._follow_name(piece, values, depth)

    def _follow_name(self, piece: GivenPiece, values: FlowValues, depth: int) -> Iterator[GivenPiece]:
        name, fn = piece.value.text, piece.fn
        variable = self.code.identify(name, fn)
        written = self.code.list_writes(variable)
        kept = (_names_options(each.value) for _, each in written)
        if _CLASS not in self.code.resolve_name_type(name, fn).name and not any(kept):
            return
        for writer, each in written:
            if (writer is not fn or each.line <= piece.line) and each.value != piece.value:
                inner = GivenPiece(each.value, writer, each.line, each.guard, piece.way)
                yield from self._follow(inner, values, depth + 1)
        for call in fn.facts.calls:
            if call.line <= piece.line and call.callee.startswith(f"{name}."):
                yield GivenPiece(_make_expression(call), fn, call.line, call.guard, piece.way)
        place = find_parameter(fn, name)
        if place is not None:
            given = list(values.list_given(fn, place[0], name))
            # Of several that give something, it is not told which.
            for value, giver, line in given if len(given) == 1 else ():
                yield from self._follow(GivenPiece(value, giver, line), values, depth + 1)


def _mentions(fn: Fn, name: str) -> bool:
    """Whether a function does anything with a parameter."""
    given = [one for call in fn.facts.calls for one in call.arguments]
    given += [each.value for each in fn.facts.assignments]
    return any(_has_name(one, name) for one in given) or any(
        call.callee.startswith(f"{name}.") for call in fn.facts.calls
    )


def _has_name(value: FlowExpr, name: str) -> bool:
    own = value.kind in ("name", "other", "call") and name in value.text
    inner = (*value.parts, value.receiver) if value.receiver is not None else value.parts
    return own or any(_has_name(one, name) for one in inner)


def _names_options(value: FlowExpr) -> bool:
    """Whether an expression begins with an object of options."""
    return _CLASS in value.text or (value.receiver is not None and _names_options(value.receiver))


def _make_expression(call: FlowCall) -> FlowExpr:
    return FlowExpr("call", call.callee, call.arguments)


def _is_turned_off(value: FlowExpr) -> bool:
    """Whether an expression turns the arguments of the program off for a node."""
    if get_tail(value.text) == _ALONE and value.kind in ("call", "keyword"):
        return any(part.kind == "number" and part.text in ("false", "False", "0") for part in value.parts)
    inner = (*value.parts, value.receiver) if value.receiver is not None else value.parts
    return any(map(_is_turned_off, inner))


def _list_remaps(value: FlowExpr) -> Iterator[str]:
    """The texts that stand behind `-r` in the lists of an expression."""
    for option, one in zip(value.parts, value.parts[1:], strict=False):
        if option.kind == one.kind == "text" and option.text in _REMAPS:
            yield one.text
    for part in (*value.parts, value.receiver) if value.receiver is not None else value.parts:
        yield from _list_remaps(part)


def _find_rule(value: FlowExpr, rule: str) -> FlowExpr | None:
    if value.kind in ("text", "join"):
        every = value.parts or (value,)
        pieces = [part.parts[0] if part.text in _STRINGS and len(part.parts) == 1 else part for part in every]
        for place, piece in enumerate(pieces):
            if piece.kind == "text" and rule in piece.text:
                rest = FlowExpr("text", piece.text.partition(rule)[2])
                return FlowExpr("join", "+", (rest, *pieces[place + 1 :]))
    inner = (*value.parts, value.receiver) if value.receiver is not None else value.parts
    return next(filter(None, (_find_rule(one, rule) for one in inner)), None)
