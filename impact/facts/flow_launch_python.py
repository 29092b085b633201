"""Launch files in Python to the facts of flow_launch: generate_launch_description() followed without being run.

The tree is walked as Python would run it, with values that are known, substitutions, or unknown. Branches that hang on
what is only known at launch are walked both, and what they add stands under their condition.
"""

from __future__ import annotations

import ast
import json
from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple

from .flow_launch import (
    DEEPEST,
    Action,
    Condition,
    LaunchFile,
    Piece,
    Value,
    literal,
    named,
    other,
    plain,
    together,
)
from .place import Problem
from .python import read

MOST_STEPS = 200_000
STEPS = f"takes more than {MOST_STEPS} steps"
DEEPEST_CALL = 24
MOST_TURNS = 200
ENTRIES = ("generate_launch_description", "generate_test_description")


class _TooMuch(Exception):
    """More than a launch file ever does; the message says what."""


class _Text(NamedTuple):
    """Text, or a substitution. is_str: Python holds a str, so that it can be compared; a substitution is an object."""

    value: Value
    is_str: bool = True


class _Constant(NamedTuple):
    """A number, bool or None."""

    value: Any


class _Unknown(NamedTuple):
    """What cannot be followed; source: the expression."""

    source: str


class _Conditions(NamedTuple):
    """An IfCondition and the like."""

    conditions: tuple[Condition, ...]


class _File(NamedTuple):
    """A ParameterFile with substitutions in it."""

    value: Value


class _Yaml(NamedTuple):
    """What a YAML file holds, below keys."""

    file: Value
    keys: tuple[Value, ...] = ()


class _Typed(NamedTuple):
    """A ParameterValue: its value and the name of the type it is to have."""

    value: Any
    type: str


class _Guarded(NamedTuple):
    """A value that is only there under conditions."""

    value: Any
    conditions: tuple[Condition, ...]


class _Either(NamedTuple):
    """One of two values, as a condition decides."""

    condition: Value
    yes: Any
    no: Any


class _Module(NamedTuple):
    """An imported module or name, as a dotted path."""

    path: str


class _Method(NamedTuple):
    """A method taken from a value."""

    receiver: Any
    name: str


class _Function(NamedTuple):
    """A function of the file, with the names it sees and, for a method, its object."""

    node: ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda
    scope: _Scope
    self: Any = None


class _List:
    """A list, or as kind says a tuple or a LaunchDescription. depth: how many conditions stood when it was made."""

    __slots__ = ("depth", "items", "kind")

    def __init__(self, items: list[Any], depth: int, kind: str = "list"):
        self.items = items
        self.depth = depth
        self.kind = kind

    @property
    def is_launch(self) -> bool:
        return self.kind == "launch"


class _Dict:
    """A dict, as pairs; a later pair of the same key replaces the earlier."""

    __slots__ = ("depth", "items")

    def __init__(self, items: list[tuple[Any, Any]], depth: int):
        self.items = items
        self.depth = depth

    def get(self, key: Any) -> Any:
        return next((value for known, value in reversed(self.items) if known == key), None)

    def set(self, key: Any, value: Any) -> None:
        for place, (known, _) in enumerate(self.items):
            if known == key:
                self.items[place] = (key, value)
                return
        self.items.append((key, value))


class _Class:
    """A class of the file."""

    __slots__ = ("methods", "name", "scope")

    def __init__(self, name: str, scope: _Scope):
        self.name = name
        self.scope = scope
        self.methods: dict[str, Any] = {}


class _Object:
    """An object of a class of the file."""

    __slots__ = ("attributes", "type")

    def __init__(self, type_: _Class):
        self.type = type_
        self.attributes: dict[str, Any] = {}


class _Scope:
    """Names and what they stand for."""

    __slots__ = ("names", "parent")

    def __init__(self, parent: _Scope | None):
        self.parent = parent
        self.names: dict[str, Any] = {}

    def look(self, name: str) -> Any:
        scope: _Scope | None = self
        while scope is not None:
            if name in scope.names:
                return scope.names[name]
            scope = scope.parent
        return None


class _Context(NamedTuple):
    """The LaunchContext given to an OpaqueFunction, or its dict of configurations."""

    configurations: bool = False


def extract(data: bytes) -> LaunchFile:
    """The facts of a launch file in Python. Never raises.

    A file without generate_launch_description() says so as a problem.
    """
    source = read(data)
    problems = source.problems
    if source.tree is None:
        return LaunchFile("python", 2, (), problems or (Problem(1, "not parsed: is not Python 3"),))
    try:
        actions, more = _Walker().launch(source.tree)
        _measure(actions)
        return LaunchFile("python", 2, actions, (*problems, *more))
    except RecursionError:
        return LaunchFile("python", 2, (), (*problems, Problem(1, "nested too deeply to be read")))
    except _TooMuch as error:
        return LaunchFile("python", 2, (), (*problems, Problem(1, str(error))))


def _measure(actions: tuple[Action, ...]) -> None:
    """Raises _TooMuch for facts too large or too deep to be handed on: values may hold one another many times over."""
    pieces = 0
    rest: list[tuple[Any, int]] = [(action, 0) for action in actions]
    while rest:
        item, depth = rest.pop()
        pieces += 1
        if pieces > MOST_STEPS or depth > DEEPEST:
            raise _TooMuch("says too much to be kept")
        if isinstance(item, Action):
            values = [value for _, value in item.attributes] + [c.value for c in item.conditions]
            rest += [(child, depth + 1) for child in item.children]
        else:
            values = item.parts
        rest += [(piece, depth + 1) for value in values for piece in value]


def _negated(conditions: Sequence[Condition], line: int) -> Condition:
    return Condition("unless", _all(conditions), line)


def _all(conditions: Sequence[Condition]) -> Value:
    """Conditions as one value that is true when they all hold."""
    values = [c.value if c.kind != "unless" else (Piece("not", "", (c.value,)),) for c in conditions]
    return values[0] if len(values) == 1 else (Piece("and", "", tuple(values)),)


class _Walker:
    """One walk through a file."""

    def __init__(self) -> None:
        self.module = _Scope(None)
        self.module.names["__file__"] = _Text((Piece("filename"),))
        self.scope = self.module
        self.conditions: list[Condition] = []
        self.returns: list[tuple[tuple[Condition, ...], Any]] = []
        self.base = 0
        self.calls = 0
        self.steps = 0
        self.line = 1

    def launch(self, tree: ast.Module) -> tuple[tuple[Action, ...], tuple[Problem, ...]]:
        self.block(tree.body)
        entry = next((f for f in map(self.module.names.get, ENTRIES) if isinstance(f, _Function)), None)
        if entry is None:
            return (), (Problem(1, "has no generate_launch_description()"),)
        result = self.call_function(entry, [], {})
        if isinstance(result, _List) and result.kind == "tuple" and result.items:
            # A test's description, and what its cases are told
            result = result.items[0]
        return tuple(self.actions(result, entry.node.lineno)), ()

    # Statements

    def block(self, statements: Sequence[ast.stmt]) -> bool:
        """Walks statements; True when none that follows them can run."""
        added = 0
        try:
            for statement in statements:
                self.spend(1)
                handler = _STATEMENTS.get(type(statement))
                if handler is None:
                    continue
                outcome = handler(self, statement)
                if outcome is True:
                    return True
                if isinstance(outcome, Condition):
                    # One branch jumps: all that follows stands under the other's condition.
                    self.conditions.append(outcome)
                    added += 1
            return False
        finally:
            if added:
                del self.conditions[-added:]

    def expression(self, statement: ast.Expr) -> None:
        self.value(statement.value)

    def assign(self, statement: ast.Assign) -> None:
        value = self.value(statement.value)
        for target in statement.targets:
            self.bind(target, value)

    def annotated(self, statement: ast.AnnAssign) -> None:
        if statement.value is not None:
            self.bind(statement.target, self.value(statement.value))

    def augmented(self, statement: ast.AugAssign) -> None:
        added = self.value(statement.value)
        before = self.value(statement.target)
        if isinstance(before, _List) and isinstance(added, _List):
            self.extend(before, added.items)
        elif isinstance(before, _Dict) and isinstance(added, _Dict):
            for key, value in added.items:
                before.set(key, value)
        elif isinstance(statement.op, ast.Add):
            self.bind(statement.target, self.add(before, added, statement))
        else:
            self.bind(statement.target, _Unknown(_source(statement)))

    def bind(self, target: ast.expr, value: Any) -> None:
        if isinstance(target, ast.Name):
            self.scope.names[target.id] = value
        elif isinstance(target, (ast.Tuple, ast.List)):
            items = value.items if isinstance(value, _List) else ()
            known = len(items) == len(target.elts)
            for place, element in enumerate(target.elts):
                self.bind(element, items[place] if known else _Unknown(_source(element)))
        elif isinstance(target, ast.Subscript):
            holder = self.value(target.value)
            key = self.value(target.slice)
            if isinstance(holder, _Dict):
                holder.set(key, self.guarded(value, holder.depth))
            elif isinstance(holder, _List) and (place := _place(holder, key)) is not None:
                holder.items[place] = value
        elif isinstance(target, ast.Attribute):
            holder = self.value(target.value)
            if isinstance(holder, _Object):
                holder.attributes[target.attr] = value

    def returned(self, statement: ast.Return) -> bool:
        value = _Constant(None) if statement.value is None else self.value(statement.value)
        self.returns.append((tuple(self.conditions[self.base :]), value))
        return True

    def raised(self, statement: ast.Raise) -> bool:
        return True

    def jumped(self, statement: ast.stmt) -> bool:
        return True

    def branch(self, statement: ast.If) -> bool | Condition | None:
        decided = self.truth(statement.test)
        if isinstance(decided, bool):
            return self.block(statement.body if decided else statement.orelse)
        yes = Condition("if", decided, statement.lineno)
        no = Condition("unless", decided, statement.lineno)
        before = dict(self.scope.names)
        self.conditions.append(yes)
        body_jumps = self.block(statement.body)
        self.conditions.pop()
        after_body, self.scope.names = self.scope.names, dict(before)
        self.conditions.append(no)
        else_jumps = self.block(statement.orelse)
        self.conditions.pop()
        if body_jumps and else_jumps:
            return True
        if body_jumps:
            return no
        if else_jumps:
            self.scope.names = after_body
            return yes
        names = self.scope.names
        for name, value in after_body.items():
            if name not in names:
                names[name] = value
            elif names[name] is not value and names[name] != value:
                names[name] = _Either(decided, value, names[name])
        return None

    def loop(self, statement: ast.For) -> None:
        turns = self.turns(self.value(statement.iter))
        if turns is None:
            over = f"for {_source(statement.target)} in {_source(statement.iter)}"
            self.conditions.append(Condition("each", (other(over),), statement.lineno))
            self.bind_unknown(statement.target)
            self.block(statement.body)
            self.conditions.pop()
        else:
            for turn in turns:
                value, extra = (turn.value, turn.conditions) if isinstance(turn, _Guarded) else (turn, ())
                self.conditions += extra
                self.bind(statement.target, value)
                jumped = self.block(statement.body)
                if extra:
                    del self.conditions[-len(extra) :]
                if jumped and not _continues(statement.body):
                    break
        self.block(statement.orelse)

    def bind_unknown(self, target: ast.expr) -> None:
        for node in ast.walk(target):
            if isinstance(node, ast.Name):
                self.scope.names[node.id] = _Unknown(node.id)

    def turns(self, over: Any) -> list[Any] | None:
        """What a loop walks through, None when that is not known."""
        if isinstance(over, _Dict):
            items = [key for key, _ in over.items]
        elif isinstance(over, _List):
            items = over.items
        else:
            return None
        return items if len(items) <= MOST_TURNS else None

    def while_(self, statement: ast.While) -> None:
        self.conditions.append(Condition("each", (other(f"while {_source(statement.test)}"),), statement.lineno))
        self.block(statement.body)
        self.conditions.pop()

    def with_(self, statement: ast.With) -> bool:
        for item in statement.items:
            value = self.value(item.context_expr)
            if item.optional_vars is not None:
                self.bind(item.optional_vars, value)
        return self.block(statement.body)

    def try_(self, statement: ast.Try) -> bool:
        jumps = self.block(statement.body)
        if not jumps:
            jumps = self.block(statement.orelse)
        return self.block(statement.finalbody) or jumps

    def define(self, statement: ast.FunctionDef | ast.AsyncFunctionDef) -> None:
        self.scope.names[statement.name] = _Function(statement, self.scope)

    def class_(self, statement: ast.ClassDef) -> None:
        type_ = _Class(statement.name, self.scope)
        for inner in statement.body:
            if isinstance(inner, (ast.FunctionDef, ast.AsyncFunctionDef)):
                type_.methods[inner.name] = _Function(inner, self.scope)
        self.scope.names[statement.name] = type_

    def import_(self, statement: ast.Import) -> None:
        for alias in statement.names:
            if alias.asname:
                self.scope.names[alias.asname] = _Module(alias.name)
            else:
                top = alias.name.partition(".")[0]
                self.scope.names[top] = _Module(top)

    def import_from(self, statement: ast.ImportFrom) -> None:
        for alias in statement.names:
            self.scope.names[alias.asname or alias.name] = _Module(f"{statement.module or ''}.{alias.name}")

    # Conditions

    def truth(self, node: ast.expr) -> bool | Value:
        """Whether an expression is true: known, or a value that tells at launch."""
        return self.truth_of(self.value(node), node)

    def truth_of(self, value: Any, node: ast.AST) -> bool | Value:
        if isinstance(value, _Constant):
            return bool(value.value)
        if isinstance(value, _Text):
            if not value.is_str:
                return True
            text = plain(value.value)
            if text is not None:
                return bool(text)
            if len(value.value) == 1 and value.value[0].kind in _BOOLEAN_PIECES:
                return value.value
            return (Piece("not", "", ((Piece("equals", "", (value.value, literal(""))),),)),)
        if isinstance(value, (_List, _Dict)):
            if not value.items:
                return False
            if not any(isinstance(item, _Guarded) for item in value.items):
                return True
        if isinstance(value, (_Module, _Function, _Object, _Class, Action, _Context)):
            return True
        return (other(_source(node)),)

    def comparison(self, node: ast.Compare) -> Any:
        if len(node.ops) != 1:
            return _Unknown(_source(node))
        op = node.ops[0]
        left, right = self.value(node.left), self.value(node.comparators[0])
        same: Any = None
        if isinstance(op, (ast.Eq, ast.NotEq, ast.Is, ast.IsNot)):
            same = self.equal(left, right)
        elif isinstance(op, (ast.In, ast.NotIn)) and isinstance(right, (_List, _Dict)):
            items = [key for key, _ in right.items] if isinstance(right, _Dict) else right.items
            outcomes = [self.equal(left, item) for item in items]
            if any(outcome is True for outcome in outcomes):
                same = True
            elif all(outcome is False for outcome in outcomes):
                same = False
            elif isinstance(left, _Text) and all(isinstance(item, _Text) for item in items):
                same = (Piece("in", "", (left.value, *(item.value for item in items))),)
        elif isinstance(left, _Constant) and isinstance(right, _Constant):
            return _calculated(node, left.value, right.value)
        elif isinstance(op, (ast.In, ast.NotIn)) and isinstance(left, _Text) and isinstance(right, _Text):
            inner, outer = plain(left.value), plain(right.value)
            if inner is not None and outer is not None:
                same = inner in outer
        if same is None:
            return _Unknown(_source(node))
        negated = isinstance(op, (ast.NotEq, ast.IsNot, ast.NotIn))
        if isinstance(same, bool):
            return _Constant(same != negated)
        return _Text((Piece("not", "", (same,)),) if negated else same)

    def equal(self, left: Any, right: Any) -> bool | Value | None:
        """Whether two values are the same; None when that cannot be told."""
        if isinstance(left, _Constant) and isinstance(right, _Constant):
            return left.value == right.value
        if isinstance(left, _Text) and isinstance(right, _Text):
            a, b = plain(left.value), plain(right.value)
            if a is not None and b is not None:
                return a == b
            if not (left.is_str and right.is_str):
                return False
            return (Piece("equals", "", (left.value, right.value)),)
        if isinstance(left, _Either) or isinstance(right, _Either):
            return None
        if isinstance(left, _Unknown) or isinstance(right, _Unknown):
            return None
        return False

    # Expressions

    def value(self, node: ast.expr) -> Any:
        self.spend(1)
        handler = _EXPRESSIONS.get(type(node))
        if handler is None:
            return _Unknown(_source(node))
        return handler(self, node)

    def constant(self, node: ast.Constant) -> Any:
        if isinstance(node.value, str):
            return _Text(literal(node.value))
        if node.value is None or isinstance(node.value, (bool, int, float)):
            return _Constant(node.value)
        return _Unknown(_source(node))

    def name(self, node: ast.Name) -> Any:
        found = self.scope.look(node.id)
        return _Module(node.id) if found is None else found

    def attribute(self, node: ast.Attribute) -> Any:
        receiver = self.value(node.value)
        name = node.attr
        if isinstance(receiver, _Module):
            return _Module(f"{receiver.path}.{name}")
        if isinstance(receiver, _Object):
            if name in receiver.attributes:
                return receiver.attributes[name]
            method = receiver.type.methods.get(name)
            return _Unknown(_source(node)) if method is None else method._replace(self=receiver)
        if isinstance(receiver, _Context) and name == "launch_configurations":
            return _Context(True)
        if isinstance(receiver, _Text) and name == "parent":
            return _Text(_folder(receiver.value))
        if isinstance(receiver, _List) and name == "entities":
            return receiver
        if isinstance(receiver, _Unknown):
            return _Unknown(_source(node))
        return _Method(receiver, name)

    def subscript(self, node: ast.Subscript) -> Any:
        holder = self.value(node.value)
        key = self.value(node.slice) if not isinstance(node.slice, ast.Slice) else None
        if isinstance(holder, _Module) and holder.path == "os.environ" and isinstance(key, _Text):
            return _Text((named("env", key.value),))
        if isinstance(holder, _Yaml) and isinstance(key, _Text):
            return holder._replace(keys=(*holder.keys, key.value))
        if isinstance(holder, _Context) and isinstance(key, _Text):
            return _Text((named("arg", key.value),))
        if isinstance(holder, _Dict):
            found = holder.get(key)
            if found is not None and not isinstance(found, _Guarded):
                return found
        if isinstance(holder, _List) and (place := _place(holder, key)) is not None:
            return holder.items[place]
        return _Unknown(_source(node))

    def sequence(self, node: ast.List | ast.Tuple) -> Any:
        items: list[Any] = []
        for element in node.elts:
            if isinstance(element, ast.Starred):
                value = self.value(element.value)
                if isinstance(value, _List):
                    items += value.items
                else:
                    items.append(_Unknown(_source(element)))
            else:
                items.append(self.value(element))
        return _List(items, len(self.conditions), "tuple" if isinstance(node, ast.Tuple) else "list")

    def mapping(self, node: ast.Dict) -> Any:
        made = _Dict([], len(self.conditions))
        for key, item in zip(node.keys, node.values, strict=True):
            value = self.value(item)
            if key is not None:
                made.set(self.value(key), value)
            elif isinstance(value, _Dict):
                for inner, held in value.items:
                    made.set(inner, held)
            else:
                made.set(_Unknown(_source(item)), value)
        return made

    def formatted(self, node: ast.JoinedStr) -> Any:
        values: list[Value] = []
        for part in node.values:
            inner = part.value if isinstance(part, ast.FormattedValue) else part
            values.append(self.text(self.value(inner), inner))
        return _Text(together(values))

    def operation(self, node: ast.BinOp) -> Any:
        left, right = self.value(node.left), self.value(node.right)
        if isinstance(node.op, ast.Add):
            return self.add(left, right, node)
        if isinstance(node.op, ast.Div) and isinstance(left, _Text):
            return _Text((Piece("join", "", (left.value, self.text(right, node.right))),), left.is_str)
        if isinstance(node.op, ast.Mod) and isinstance(left, _Text):
            pattern = plain(left.value)
            given = right.items if isinstance(right, _List) else [right]
            if pattern is not None and pattern.count("%s") == len(given) == pattern.count("%"):
                values: list[Value] = []
                for place, piece in enumerate(pattern.split("%s")):
                    values.append(literal(piece))
                    if place < len(given):
                        values.append(self.text(given[place], node.right))
                return _Text(together(values))
        if isinstance(left, _Constant) and isinstance(right, _Constant):
            return _calculated(node, left.value, right.value)
        if isinstance(left, _Dict) and isinstance(right, _Dict) and isinstance(node.op, ast.BitOr):
            made = _Dict(list(left.items), len(self.conditions))
            for key, value in right.items:
                made.set(key, value)
            return made
        return _Unknown(_source(node))

    def add(self, left: Any, right: Any, node: ast.AST) -> Any:
        if isinstance(left, _List) and isinstance(right, _List):
            self.spend(len(left.items) + len(right.items))
            return _List([*left.items, *right.items], len(self.conditions), left.kind)
        if isinstance(left, _Text) or isinstance(right, _Text):
            if isinstance(left, (_Text, _Either)) and isinstance(right, (_Text, _Either)):
                parts = [self.text(left, node), self.text(right, node)]
                return _Text(together(parts), all(getattr(v, "is_str", True) for v in (left, right)))
            if isinstance(left, _List) or isinstance(right, _List):
                # A substitution and a list of them
                return _Text(together([self.text(left, node), self.text(right, node)]), False)
            if isinstance(left, _Unknown) or isinstance(right, _Unknown):
                return _Text(together([self.text(left, node), self.text(right, node)]))
        if isinstance(left, _Constant) and isinstance(right, _Constant) and isinstance(node, ast.BinOp):
            return _calculated(node, left.value, right.value)
        return _Unknown(_source(node))

    def boolean(self, node: ast.BoolOp) -> Any:
        """`and` and `or`: known where what comes first decides, else a value that tells at launch."""
        is_or = isinstance(node.op, ast.Or)
        open_: list[Value] = []
        for place, part in enumerate(node.values):
            value = self.value(part)
            truth = self.truth_of(value, part)
            if isinstance(truth, bool):
                if truth == is_or or (place == len(node.values) - 1 and not open_):
                    if not open_:
                        return value
                    if truth == is_or:
                        open_.append(literal(str(truth)))
                        break
                continue
            open_.append(truth)
        return _Text((Piece("or" if is_or else "and", "", tuple(open_)),)) if len(open_) > 1 else _Text(open_[0])

    def unary(self, node: ast.UnaryOp) -> Any:
        if isinstance(node.op, ast.Not):
            truth = self.truth(node.operand)
            return _Constant(not truth) if isinstance(truth, bool) else _Text((Piece("not", "", (truth,)),))
        value = self.value(node.operand)
        if isinstance(value, _Constant) and isinstance(value.value, (int, float)):
            if isinstance(node.op, ast.USub):
                return _Constant(-value.value)
            if isinstance(node.op, ast.UAdd):
                return value
        return _Unknown(_source(node))

    def either(self, node: ast.IfExp) -> Any:
        truth = self.truth(node.test)
        if isinstance(truth, bool):
            return self.value(node.body if truth else node.orelse)
        return _Either(truth, self.value(node.body), self.value(node.orelse))

    def lambda_(self, node: ast.Lambda) -> Any:
        return _Function(node, self.scope)

    def walrus(self, node: ast.NamedExpr) -> Any:
        value = self.value(node.value)
        self.bind(node.target, value)
        return value

    def starred(self, node: ast.Starred) -> Any:
        return self.value(node.value)

    def comprehension(self, node: ast.ListComp | ast.GeneratorExp | ast.SetComp | ast.DictComp) -> Any:
        outer, self.scope = self.scope, _Scope(self.scope)
        made: list[Any] = []
        depth = len(self.conditions)

        def walk(place: int) -> None:
            if place == len(node.generators):
                extra = tuple(self.conditions[depth:])
                if isinstance(node, ast.DictComp):
                    made.append((self.value(node.key), _guard(self.value(node.value), extra)))
                else:
                    made.append(_guard(self.value(node.elt), extra))
                return
            generator = node.generators[place]
            turns = self.turns(self.value(generator.iter))
            unknown = turns is None
            if turns is None:
                over = f"for {_source(generator.target)} in {_source(generator.iter)}"
                self.conditions.append(Condition("each", (other(over),), node.lineno))
                turns = [None]
            for turn in turns:
                start = len(self.conditions)
                if unknown:
                    self.bind_unknown(generator.target)
                elif isinstance(turn, _Guarded):
                    self.conditions += turn.conditions
                    self.bind(generator.target, turn.value)
                else:
                    self.bind(generator.target, turn)
                truths = [self.truth(test) for test in generator.ifs]
                if not any(truth is False for truth in truths):
                    self.conditions += [Condition("if", t, node.lineno) for t in truths if not isinstance(t, bool)]
                    walk(place + 1)
                del self.conditions[start:]
            if unknown:
                self.conditions.pop()

        try:
            walk(0)
        finally:
            self.scope = outer
            del self.conditions[depth:]
        return _Dict(made, depth) if isinstance(node, ast.DictComp) else _List(made, depth)

    # Lists under conditions

    def guarded(self, value: Any, depth: int) -> Any:
        return _guard(value, tuple(self.conditions[depth:]))

    def extend(self, holder: _List, items: Sequence[Any]) -> None:
        for item in items:
            holder.items.append(self.guarded(item, holder.depth))
            if len(holder.items) > MOST_STEPS:
                raise _TooMuch(STEPS)

    # Calls

    def call(self, node: ast.Call) -> Any:
        function = self.value(node.func)
        self.line = node.lineno
        arguments: list[Any] = []
        for argument in node.args:
            value = self.value(argument)
            if isinstance(argument, ast.Starred):
                arguments += value.items if isinstance(value, _List) else [_Unknown(_source(argument))]
            else:
                arguments.append(value)
        keywords: dict[str, Any] = {}
        for keyword in node.keywords:
            value = self.value(keyword.value)
            if keyword.arg is not None:
                keywords[keyword.arg] = value
            elif isinstance(value, _Dict):
                for key, held in value.items:
                    name = plain(key.value) if isinstance(key, _Text) else None
                    if name is not None:
                        keywords[name] = held
        if isinstance(function, _Function):
            return self.call_function(function, arguments, keywords)
        if isinstance(function, _Class):
            made = _Object(function)
            init = function.methods.get("__init__")
            if init is not None:
                self.call_function(init._replace(self=made), arguments, keywords)
            return made
        if isinstance(function, _Method):
            return self.call_method(function, arguments, keywords, node)
        if isinstance(function, _Module):
            maker = _CALLS.get(function.path.rpartition(".")[2])
            if maker is not None:
                return maker(self, _Call(node, function.path, arguments, keywords))
        return _Unknown(_source(node))

    def call_function(self, function: _Function, arguments: list[Any], keywords: dict[str, Any]) -> Any:
        node = function.node
        if self.calls >= DEEPEST_CALL:
            return _Unknown(getattr(node, "name", "lambda"))
        scope = _Scope(function.scope)
        signature = node.args
        names = [a.arg for a in (*signature.posonlyargs, *signature.args)]
        if function.self is not None:
            arguments = [function.self, *arguments]
        outer = (self.scope, self.returns, self.base)
        self.scope = function.scope
        for parameter, default in zip(reversed(names), reversed(signature.defaults), strict=False):
            scope.names[parameter] = self.value(default)
        for parameter, default in zip(signature.kwonlyargs, signature.kw_defaults, strict=True):
            if default is not None:
                scope.names[parameter.arg] = self.value(default)
        for parameter in (*names, *(a.arg for a in signature.kwonlyargs)):
            scope.names.setdefault(parameter, _Unknown(parameter))
        scope.names.update(zip(names, arguments, strict=False))
        if signature.vararg is not None:
            scope.names[signature.vararg.arg] = _List(arguments[len(names) :], len(self.conditions))
        known = {*names, *(a.arg for a in signature.kwonlyargs)}
        rest: list[tuple[Any, Any]] = []
        for key, value in keywords.items():
            if key in known:
                scope.names[key] = value
            else:
                rest.append((_Text(literal(key)), value))
        if signature.kwarg is not None:
            scope.names[signature.kwarg.arg] = _Dict(rest, len(self.conditions))
        self.scope, self.returns, self.base = scope, [], len(self.conditions)
        self.calls += 1
        try:
            if isinstance(node, ast.Lambda):
                return self.value(node.body)
            self.block(node.body)
            return self.result()
        finally:
            self.calls -= 1
            self.scope, self.returns, self.base = outer

    def result(self) -> Any:
        """What the return statements reached give together."""
        value: Any = _Constant(None)
        for place, (conditions, returned) in enumerate(reversed(self.returns)):
            if not conditions or place == 0:
                # The last one is what remains when no earlier one was taken.
                value = returned if place == 0 and len(self.returns) > 1 else _guard(returned, conditions)
            else:
                value = _Either(_all(conditions), returned, value)
        return value

    def call_method(self, method: _Method, arguments: list[Any], keywords: dict[str, Any], node: ast.Call) -> Any:
        receiver, name = method
        first = arguments[0] if arguments else None
        if isinstance(receiver, _List):
            if name in ("append", "add_action", "add_entity") and arguments:
                self.extend(receiver, arguments[:1])
                return _Constant(None)
            if name == "extend" and isinstance(first, _List):
                self.extend(receiver, first.items)
                return _Constant(None)
            if name == "extend" and arguments:
                self.extend(receiver, [_Unknown(_source(node.args[0]))])
                return _Constant(None)
            if name == "insert" and len(arguments) == 2:
                place = first.value if isinstance(first, _Constant) and isinstance(first.value, int) else 0
                receiver.items.insert(place, self.guarded(arguments[1], receiver.depth))
                return _Constant(None)
            if name == "remove" and first in receiver.items:
                receiver.items.remove(first)
                return _Constant(None)
            if name == "copy":
                return _List(list(receiver.items), len(self.conditions), receiver.kind)
        elif isinstance(receiver, _Dict):
            depth = len(self.conditions)
            if name == "items":
                pairs = [
                    (k, v.value, v.conditions) if isinstance(v, _Guarded) else (k, v, ()) for k, v in receiver.items
                ]
                return _List([_guard(_List([k, v], depth), c) for k, v, c in pairs], depth)
            if name in ("keys", "values"):
                return _List([pair[name == "values"] for pair in receiver.items], depth)
            if name == "update" and isinstance(first, _Dict):
                for key, value in first.items:
                    receiver.set(key, self.guarded(value, receiver.depth))
                return _Constant(None)
            if name in ("get", "pop") and arguments:
                found = receiver.get(first)
                if found is not None:
                    return found if not isinstance(found, _Guarded) else _Unknown(_source(node))
                if first is not None and all(isinstance(key, _Text) for key, _ in receiver.items):
                    return arguments[1] if len(arguments) > 1 else _Constant(None)
            if name == "copy":
                return _Dict(list(receiver.items), depth)
        elif isinstance(receiver, _Context):
            if name in ("get", "perform_substitution", "__getitem__") and first is not None:
                if not receiver.configurations:
                    return _Text(self.text(first, node))
                rest = [self.text(a, node) for a in arguments[1:]]
                return _Text((named("arg", self.text(first, node), *rest),))
        elif isinstance(receiver, _Conditions) and name == "evaluate":
            return _Text(_all(receiver.conditions))
        elif isinstance(receiver, (_Text, _Either)):
            return self.text_method(receiver, name, arguments, keywords, node)
        return _Unknown(_source(node))

    def text_method(
        self, receiver: Any, name: str, arguments: list[Any], keywords: dict[str, Any], node: ast.Call
    ) -> Any:
        value = self.text(receiver, node)
        if name in ("perform", "resolve", "as_posix", "absolute", "expanduser", "read", "read_text"):
            if name == "read_text":
                value = (Piece("content", "", (value,)),)
            return _Text(value)
        if name == "joinpath":
            return _Text((Piece("join", "", (value, *(self.text(a, node) for a in arguments))),))
        if name == "join" and len(arguments) == 1 and isinstance(arguments[0], _List):
            parts: list[Value] = []
            for item in arguments[0].items:
                parts += (*([value] if parts else ()), self.text(item, node))
            return _Text(together(parts))
        if name == "format":
            return self.format(value, arguments, keywords, node)
        if name in STRING_METHODS:
            return _Text((Piece("method", name, (value, *(self.text(a, node) for a in arguments))),))
        return _Unknown(_source(node))

    def format(self, value: Value, arguments: list[Any], keywords: dict[str, Any], node: ast.Call) -> Any:
        import string

        pattern = plain(value)
        if pattern is None:
            return _Unknown(_source(node))
        values: list[Value] = []
        place = 0
        try:
            for text, field, spec, _ in string.Formatter().parse(pattern):
                values.append(literal(text))
                if field is None:
                    continue
                if spec:
                    return _Unknown(_source(node))
                if field == "":
                    field, place = str(place), place + 1
                given = (
                    arguments[int(field)] if field.isdigit() and int(field) < len(arguments) else keywords.get(field)
                )
                if given is None:
                    return _Unknown(_source(node))
                values.append(self.text(given, node))
        except ValueError:
            return _Unknown(_source(node))
        return _Text(together(values))

    # Values as facts

    def spend(self, steps: int) -> None:
        """Counts steps; raises _TooMuch when there have been too many."""
        self.steps += steps
        if self.steps > MOST_STEPS:
            raise _TooMuch(STEPS)

    def text(self, value: Any, node: ast.AST) -> Value:
        """A value as text; node: what to show where it is not known."""
        self.spend(1)
        if isinstance(value, _Text):
            self.spend(len(value.value) + len(value.value[0].text) // 100 if value.value else 1)
            return value.value
        if isinstance(value, _Constant):
            return literal("" if value.value is None else str(value.value))
        if isinstance(value, (_File, _Typed)):
            return value.value if isinstance(value, _File) else self.text(value.value, node)
        if isinstance(value, _Either):
            return (Piece("choose", "", (value.condition, self.text(value.yes, node), self.text(value.no, node))),)
        if isinstance(value, _List) and not value.is_launch:
            return together([self.text(item, node) for item in value.items])
        if isinstance(value, _Unknown):
            return (other(value.source),)
        return (other(_source(node)),)

    def actions(self, value: Any, line: int, extra: tuple[Condition, ...] = ()) -> Iterator[Action]:
        """The actions that a value given for actions holds."""
        self.spend(1)
        if isinstance(value, Action):
            if extra:
                value = Action(value.kind, value.line, value.attributes, (*extra, *value.conditions), value.children)
            yield value
        elif isinstance(value, _List):
            for item in value.items:
                yield from self.actions(item, line, extra)
        elif isinstance(value, _Guarded):
            yield from self.actions(value.value, line, (*extra, *value.conditions))
        elif isinstance(value, _Either):
            yield from self.actions(value.yes, line, (*extra, Condition("if", value.condition, line)))
            yield from self.actions(value.no, line, (*extra, Condition("unless", value.condition, line)))
        elif isinstance(value, _Constant) or (isinstance(value, _Unknown) and value.source.startswith(_NO_ACTION)):
            return
        elif isinstance(value, _Dict):
            for _, item in value.items:
                yield from self.actions(item, line, extra)
        else:
            source = value.source if isinstance(value, _Unknown) else getattr(value, "path", type(value).__name__)
            yield Action("unknown", line, (("text", (other(str(source)),)),), extra)


_IDLE = _Unknown("nothing()")
# Calls whose result is no action, where a lambda stands for an action that is run for its effect.
_NO_ACTION = ("nothing()", "os.", "shutil.", "logging.", "sys.", "time.", "warnings.", "print(")
_BOOLEAN_PIECES = frozenset(("equals", "not", "and", "or", "in"))
STRING_METHODS = frozenset(
    ("lower", "upper", "strip", "lstrip", "rstrip", "startswith", "endswith", "replace", "capitalize", "title",
     "removeprefix", "removesuffix"),
)  # fmt: skip


def _guard(value: Any, conditions: tuple[Condition, ...]) -> Any:
    if not conditions:
        return value
    if isinstance(value, _Guarded):
        return _Guarded(value.value, (*conditions, *value.conditions))
    return _Guarded(value, conditions)


def _place(holder: _List, key: Any) -> int | None:
    """The place in a list that an index means, None when it is not known to be there."""
    if not isinstance(key, _Constant) or not isinstance(key.value, int):
        return None
    return key.value if -len(holder.items) <= key.value < len(holder.items) else None


def _source(node: ast.AST) -> str:
    try:
        return " ".join(ast.unparse(node).split())[:120]
    except (RecursionError, ValueError, AttributeError):
        return type(node).__name__


def _continues(body: Sequence[ast.stmt]) -> bool:
    """Whether the jump that ends a turn of a loop goes on with the next."""
    return any(isinstance(node, ast.Continue) for statement in body for node in ast.walk(statement)) and not any(
        isinstance(node, (ast.Break, ast.Return)) for statement in body for node in ast.walk(statement)
    )


def _calculated(node: ast.BinOp | ast.Compare, left: Any, right: Any) -> Any:
    """Small sums and comparisons of known numbers."""
    op = node.op if isinstance(node, ast.BinOp) else node.ops[0]
    calculate = _SUMS.get(type(op))
    if calculate is None or left is None or right is None:
        return _Unknown(_source(node))
    try:
        value = calculate(left, right)
    except (ArithmeticError, TypeError, ValueError):
        return _Unknown(_source(node))
    return _Constant(value) if abs(value) < 2**60 else _Unknown(_source(node))


_SUMS: dict[type, Callable[[Any, Any], Any]] = {
    ast.Add: lambda a, b: a + b,
    ast.Sub: lambda a, b: a - b,
    ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b,
    ast.FloorDiv: lambda a, b: a // b,
    ast.Mod: lambda a, b: a % b,
    ast.Lt: lambda a, b: a < b,
    ast.LtE: lambda a, b: a <= b,
    ast.Gt: lambda a, b: a > b,
    ast.GtE: lambda a, b: a >= b,
}


def _folder(value: Value) -> Value:
    """The folder that a path lies in."""
    if value == (Piece("filename"),):
        return (Piece("dirname"),)
    return (Piece("join", "", (value, literal(".."))),)


_STATEMENTS: dict[type, Callable[[_Walker, Any], Any]] = {
    ast.Expr: _Walker.expression,
    ast.Assign: _Walker.assign,
    ast.AnnAssign: _Walker.annotated,
    ast.AugAssign: _Walker.augmented,
    ast.Return: _Walker.returned,
    ast.Raise: _Walker.raised,
    ast.Break: _Walker.jumped,
    ast.Continue: _Walker.jumped,
    ast.If: _Walker.branch,
    ast.For: _Walker.loop,
    ast.While: _Walker.while_,
    ast.With: _Walker.with_,
    ast.Try: _Walker.try_,
    ast.FunctionDef: _Walker.define,
    ast.AsyncFunctionDef: _Walker.define,
    ast.ClassDef: _Walker.class_,
    ast.Import: _Walker.import_,
    ast.ImportFrom: _Walker.import_from,
}
_EXPRESSIONS: dict[type, Callable[[_Walker, Any], Any]] = {
    ast.Constant: _Walker.constant,
    ast.Name: _Walker.name,
    ast.Attribute: _Walker.attribute,
    ast.Subscript: _Walker.subscript,
    ast.List: _Walker.sequence,
    ast.Tuple: _Walker.sequence,
    ast.Dict: _Walker.mapping,
    ast.JoinedStr: _Walker.formatted,
    ast.BinOp: _Walker.operation,
    ast.BoolOp: _Walker.boolean,
    ast.UnaryOp: _Walker.unary,
    ast.Compare: _Walker.comparison,
    ast.IfExp: _Walker.either,
    ast.Lambda: _Walker.lambda_,
    ast.NamedExpr: _Walker.walrus,
    ast.Starred: _Walker.starred,
    ast.ListComp: _Walker.comprehension,
    ast.GeneratorExp: _Walker.comprehension,
    ast.SetComp: _Walker.comprehension,
    ast.DictComp: _Walker.comprehension,
    ast.Call: _Walker.call,
}


# What launch, launch_ros, ament_index_python and the standard library make


class _Call(NamedTuple):
    """A call of a known name. path: as imported."""

    node: ast.Call
    path: str
    arguments: list[Any]
    keywords: dict[str, Any]

    def get(self, place: int, *names: str) -> Any:
        """The argument of a name, or at a place (-1 for none); None when it is not given."""
        for name in names:
            if name in self.keywords:
                return self.keywords[name]
        return self.arguments[place] if 0 <= place < len(self.arguments) else None


class _Making(NamedTuple):
    """What a maker of actions needs: the walker and the call."""

    walker: _Walker
    call: _Call

    def texts(self, value: Any) -> list[Value]:
        """A list of texts, one each."""
        if isinstance(value, _List):
            return [
                self.walker.text(item.value if isinstance(item, _Guarded) else item, self.call.node)
                for item in value.items
            ]
        return [self.walker.text(value, self.call.node)]

    def attributes(self, *wanted: tuple[str, Any]) -> list[tuple[str, Value]]:
        given = [(key, value) for key, value in wanted if value is not None and value != _Constant(None)]
        return [(key, self.walker.text(value, self.call.node)) for key, value in given]

    def conditions(self) -> tuple[Condition, ...]:
        given = self.call.keywords.get("condition")
        if given is None or given == _Constant(None):
            return ()
        line = self.call.node.lineno
        if isinstance(given, _Conditions):
            return given.conditions
        if isinstance(given, _Either):
            return (Condition("if", (other(_keyword_source(self.call.node, "condition")),), line),)
        source = given.source if isinstance(given, _Unknown) else _keyword_source(self.call.node, "condition")
        return (Condition("if", (other(source),), line),)

    def remaps(self, value: Any, extra: tuple[Condition, ...] = ()) -> Iterator[Action]:
        line = self.call.node.lineno
        if isinstance(value, _Guarded):
            yield from self.remaps(value.value, (*extra, *value.conditions))
        elif isinstance(value, _Either):
            yield from self.remaps(value.yes, (*extra, Condition("if", value.condition, line)))
            yield from self.remaps(value.no, (*extra, Condition("unless", value.condition, line)))
        elif isinstance(value, _List):
            items = value.items
            first = items[0] if len(items) == 2 else None
            of_tuples = isinstance(first, _List) and first.kind == "tuple"
            pair = isinstance(first, _Text) or (value.kind == "tuple" and first is not None and not of_tuples)
            if pair:
                old, new = (self.walker.text(item, self.call.node) for item in items)
                yield Action("remap", line, (("from", old), ("to", new)), extra)
                return
            for item in items:
                yield from self.remaps(item, extra)
        elif isinstance(value, _Dict):
            for old, new in value.items:
                yield from self.remaps(_List([old, new], 0, "tuple"), extra)
        elif value is not None and value != _Constant(None):
            source = value.source if isinstance(value, _Unknown) else _keyword_source(self.call.node, "remappings")
            yield Action("unknown", line, (("text", (other(f"remappings: {source}"),)),), extra)

    def parameters(self, value: Any, extra: tuple[Condition, ...] = ()) -> Iterator[Action]:
        line = self.call.node.lineno
        if isinstance(value, _Guarded):
            yield from self.parameters(value.value, (*extra, *value.conditions))
        elif isinstance(value, _Either):
            yield from self.parameters(value.yes, (*extra, Condition("if", value.condition, line)))
            yield from self.parameters(value.no, (*extra, Condition("unless", value.condition, line)))
        elif isinstance(value, _List):
            for item in value.items:
                yield from self.parameters(item, extra)
        elif isinstance(value, _Dict):
            for key, held in value.items:
                yield from self.one(self.walker.text(key, self.call.node), held, extra)
        elif isinstance(value, _Text):
            yield Action("parameter-file", line, (("file", value.value),), extra)
        elif isinstance(value, _Yaml):
            yield self.below(value, None, extra)
        elif isinstance(value, _File):
            yield Action("parameter-file", line, (("file", value.value), ("substitute", literal("true"))), extra)
        elif isinstance(value, _Unknown):
            yield Action("unknown", line, (("text", (other(f"parameters: {value.source}"),)),), extra)
        elif value is not None and value != _Constant(None):
            source = _keyword_source(self.call.node, "parameters")
            yield Action("unknown", line, (("text", (other(f"parameters: {source}"),)),), extra)

    def below(self, value: _Yaml, name: Value | None, extra: tuple[Condition, ...]) -> Action:
        """The values of a YAML file that is loaded by the launch file, under a name if one is given."""
        attributes = [("file", value.file), *(("below", key) for key in value.keys)]
        if name is not None:
            attributes.append(("name", name))
        return Action("parameter-file", self.call.node.lineno, tuple(attributes), extra)

    def one(self, name: Value, value: Any, extra: tuple[Condition, ...]) -> Iterator[Action]:
        """A parameter, or those of a nested dict."""
        line = self.call.node.lineno
        if isinstance(value, _Guarded):
            yield from self.one(name, value.value, (*extra, *value.conditions))
        elif isinstance(value, _Dict):
            for key, held in value.items:
                yield from self.one(together([name, literal("."), self.walker.text(key, self.call.node)]), held, extra)
        elif isinstance(value, _Yaml):
            yield self.below(value, name, extra)
        else:
            text, type_ = self.typed(value)
            attributes = [("name", name), ("value", text)]
            if type_:
                attributes.append(("type", literal(type_)))
            yield Action("parameter", line, tuple(attributes), extra)

    def typed(self, value: Any) -> tuple[Value, str]:
        """A parameter's value and type; no type where YAML's rules decide, as for substitutions."""
        node = self.call.node
        if isinstance(value, _Typed):
            return self.walker.text(value.value, node), value.type
        if isinstance(value, _Constant):
            type_ = _TYPES.get(type(value.value).__name__, "")
            return self.walker.text(value, node), type_
        if isinstance(value, _Text):
            return value.value, "str" if value.is_str else ""
        if isinstance(value, _List):
            # A list of substitutions is one text; a list of values is a list.
            if any(isinstance(item, _Text) and not item.is_str for item in value.items):
                return self.walker.text(value, node), ""
            parts: list[Value] = []
            for item in value.items:
                text = self.walker.text(item, node)
                known = plain(text) if isinstance(item, _Text) else None
                parts += (
                    literal(", ") if parts else literal(""),
                    literal(json.dumps(known)) if known is not None else text,
                )
            return together([literal("["), *parts, literal("]")]), "list"
        return self.walker.text(value, node), ""


_TYPES = {"bool": "bool", "int": "int", "float": "double", "str": "str"}


def _keyword_source(node: ast.Call, name: str) -> str:
    return next((_source(keyword.value) for keyword in node.keywords if keyword.arg == name), name)


def _node(kind: str) -> Callable[[_Walker, _Call], Any]:
    def make(walker: _Walker, call: _Call) -> Any:
        making = _Making(walker, call)
        attributes = making.attributes(
            ("package", call.get(-1, "package")),
            ("plugin", call.get(-1, "plugin", "node_plugin")),
            ("executable", call.get(-1, "executable", "node_executable")),
            ("name", call.get(-1, "name", "node_name")),
            ("namespace", call.get(-1, "namespace", "node_namespace")),
        )
        for key in ("arguments", "ros_arguments"):
            given = call.get(-1, key)
            if given is not None and given != _Constant(None):
                if key == "ros_arguments":
                    attributes.append(("arguments", literal("--ros-args")))
                attributes += [("arguments", text) for text in making.texts(given)]
        children = [*making.remaps(call.get(-1, "remappings")), *making.parameters(call.get(-1, "parameters"))]
        inner = call.get(-1, "composable_node_descriptions")
        if kind == "container" and inner is not None:
            children += walker.actions(inner, call.node.lineno)
        return Action(kind, call.node.lineno, tuple(attributes), making.conditions(), tuple(children))

    return make


def _load(walker: _Walker, call: _Call) -> Any:
    making = _Making(walker, call)
    target = call.get(1, "target_container")
    if isinstance(target, Action):
        name = target.get("name") or (other(_keyword_source(call.node, "target_container")),)
        space = target.get("namespace")
        full = together([space, literal("/"), name]) if space is not None and plain(space) != "" else name
        attributes = [("container-node", full)]
    else:
        attributes = making.attributes(("container", target))
    children = tuple(walker.actions(call.get(0, "composable_node_descriptions"), call.node.lineno))
    return Action("load", call.node.lineno, tuple(attributes), making.conditions(), children)


def _simple(kind: str, *names: tuple[str, int, str]) -> Callable[[_Walker, _Call], Any]:
    """An action of nothing but attributes: (attribute, place, keyword) each."""

    def make(walker: _Walker, call: _Call) -> Any:
        making = _Making(walker, call)
        attributes = making.attributes(*((key, call.get(place, keyword)) for key, place, keyword in names))
        return Action(kind, call.node.lineno, tuple(attributes), making.conditions())

    return make


def _set_parameter(walker: _Walker, call: _Call) -> Any:
    making = _Making(walker, call)
    found = list(making.one(walker.text(call.get(0, "name"), call.node), call.get(1, "value"), ()))
    made = [Action(a.kind, a.line, a.attributes, (*making.conditions(), *a.conditions)) for a in found]
    return made[0] if len(made) == 1 else _List(made, len(walker.conditions))


def _sim_time(walker: _Walker, call: _Call) -> Any:
    text, type_ = _Making(walker, call).typed(call.get(0, "value"))
    attributes = (("name", literal("use_sim_time")), ("value", text), ("type", literal(type_ or "bool")))
    return Action("parameter", call.node.lineno, attributes, _Making(walker, call).conditions())


def _group(walker: _Walker, call: _Call) -> Any:
    making = _Making(walker, call)
    line = call.node.lineno
    attributes = making.attributes(("scoped", call.get(-1, "scoped")), ("forwarding", call.get(-1, "forwarding")))
    lets: list[Action] = []
    configurations = call.get(-1, "launch_configurations")
    if isinstance(configurations, _Dict):
        for key, value in configurations.items:
            pair = (("name", walker.text(key, call.node)), ("value", walker.text(value, call.node)))
            lets.append(Action("let", line, pair))
    children = (*lets, *walker.actions(call.get(0, "actions"), line))
    return Action("group", line, tuple(attributes), making.conditions(), children)


def _include(walker: _Walker, call: _Call) -> Any:
    making = _Making(walker, call)
    source = call.get(0, "launch_description_source")
    if isinstance(source, _List) and source.is_launch:
        return Action("group", call.node.lineno, (("scoped", literal("false")),), making.conditions(),
                      tuple(walker.actions(source, call.node.lineno)))  # fmt: skip
    attributes = making.attributes(("file", source))
    children = tuple(_passed(making, call.get(1, "launch_arguments"), ()))
    return Action("include", call.node.lineno, tuple(attributes), making.conditions(), children)


def _passed(making: _Making, value: Any, extra: tuple[Condition, ...]) -> Iterator[Action]:
    """Arguments given to an include: pairs, or a dict."""
    line = making.call.node.lineno
    if isinstance(value, _Guarded):
        yield from _passed(making, value.value, (*extra, *value.conditions))
    elif isinstance(value, _Either):
        yield from _passed(making, value.yes, (*extra, Condition("if", value.condition, line)))
        yield from _passed(making, value.no, (*extra, Condition("unless", value.condition, line)))
    elif isinstance(value, _Dict):
        for key, held in value.items:
            yield from _passed(making, _List([key, held], 0), extra)
    elif isinstance(value, _List):
        items = value.items
        if len(items) == 2 and isinstance(items[0], _Text):
            extra_value = items[1]
            if isinstance(extra_value, _Guarded):
                extra, extra_value = (*extra, *extra_value.conditions), extra_value.value
            name, text = (making.walker.text(item, making.call.node) for item in (items[0], extra_value))
            yield Action("pass", line, (("name", name), ("value", text)), extra)
        else:
            for item in items:
                yield from _passed(making, item, extra)
    elif value is not None and value != _Constant(None):
        source = value.source if isinstance(value, _Unknown) else _keyword_source(making.call.node, "launch_arguments")
        yield Action("unknown", line, (("text", (other(f"launch arguments: {source}"),)),), extra)


def _opaque(walker: _Walker, call: _Call) -> Any:
    making = _Making(walker, call)
    function = call.get(0, "function")
    line = call.node.lineno
    if not isinstance(function, _Function):
        source = _keyword_source(call.node, "function") if call.keywords else _source(call.node)
        return Action("unknown", line, (("text", (other(f"OpaqueFunction({source})"),)),), making.conditions())
    args, kwargs = call.get(-1, "args"), call.get(-1, "kwargs")
    given = list(args.items) if isinstance(args, _List) else []
    named_ = (
        {plain(k.value) or "": v for k, v in kwargs.items if isinstance(k, _Text)} if isinstance(kwargs, _Dict) else {}
    )
    result = walker.call_function(function, [_Context(), *given], named_)
    children = tuple(walker.actions(result, line))
    if not children and not making.conditions():
        return _List([], len(walker.conditions))
    return Action("group", line, (("scoped", literal("false")),), making.conditions(), children)


def _for_each(walker: _Walker, call: _Call) -> Any:
    """ForEach and ForLoop: what their function makes, for each of what is only known at launch."""
    making = _Making(walker, call)
    function = call.get(1, "function")
    if not isinstance(function, _Function):
        return _Unknown(_source(call.node))
    line = call.node.lineno
    each = Condition("each", (other(_source(call.node)),), line)
    children = tuple(walker.actions(walker.call_function(function, [], {}), line))
    return Action("group", line, (("scoped", literal("false")),), (*making.conditions(), each), children)


def _timer(walker: _Walker, call: _Call) -> Any:
    making = _Making(walker, call)
    line = call.node.lineno
    period = together([walker.text(call.get(-1, "period"), call.node), literal(" s")])
    children = tuple(walker.actions(call.get(-1, "actions"), line))
    conditions = (*making.conditions(), Condition("after", period, line))
    return Action("group", line, (("scoped", literal("false")),), conditions, children)


def _handler(walker: _Walker, call: _Call) -> Any:
    """An event handler: its actions, under the event."""
    event = call.path.rpartition(".")[2]
    held: list[Action] = []
    for key in (
        "on_exit",
        "on_start",
        "entities",
        "on_completion",
        "on_shutdown",
        "on_stdout",
        "on_stderr",
        "on_output",
    ):
        value = call.get(-1, key)
        if isinstance(value, _Function):
            value = walker.call_function(value, [_Unknown("event"), _Context()], {})
        if value is not None:
            held += walker.actions(value, call.node.lineno)
    after = (Condition("after", literal(event), call.node.lineno),)
    return Action("group", call.node.lineno, (("scoped", literal("false")),), after, tuple(held))


def _register(walker: _Walker, call: _Call) -> Any:
    handler = call.get(0, "event_handler")
    if isinstance(handler, Action):
        if not handler.children:
            return _List([], len(walker.conditions))
        conditions = (*_Making(walker, call).conditions(), *handler.conditions)
        return Action(handler.kind, handler.line, handler.attributes, conditions, handler.children)
    return handler if handler is not None else _Unknown(_source(call.node))


def _process(walker: _Walker, call: _Call) -> Any:
    making = _Making(walker, call)
    command = [("command", text) for text in making.texts(call.get(-1, "cmd"))]
    return Action("process", call.node.lineno, tuple(command), making.conditions())


def _description(walker: _Walker, call: _Call) -> Any:
    given = call.get(0, "initial_entities")
    made = _List([], len(walker.conditions), "launch")
    if isinstance(given, _List):
        made.items = list(given.items)
    elif given is not None and given != _Constant(None):
        made.items = [given]
    return made


def _idle(walker: _Walker, call: _Call) -> Any:
    return _IDLE


def _condition(kind: str) -> Callable[[_Walker, _Call], Any]:
    def make(walker: _Walker, call: _Call) -> Any:
        value = walker.text(call.get(0, "predicate_expression"), call.node)
        return _Conditions((Condition(kind, value, call.node.lineno),))

    return make


def _configuration_is(kind: str) -> Callable[[_Walker, _Call], Any]:
    def make(walker: _Walker, call: _Call) -> Any:
        name = walker.text(call.get(0, "launch_configuration_name"), call.node)
        expected = call.get(1, "expected_value")
        value = (Piece("equals", "", ((named("arg", name),), walker.text(expected, call.node))),)
        return _Conditions((Condition(kind, value, call.node.lineno),))

    return make


def _substitution(kind: str, *names: tuple[int, str]) -> Callable[[_Walker, _Call], Any]:
    """A substitution with a name, the first of its arguments, and what else it is given."""

    def make(walker: _Walker, call: _Call) -> Any:
        given = [call.get(place, keyword) for place, keyword in names]
        if given[0] is None:
            return _Unknown(_source(call.node))
        values = [walker.text(value, call.node) for value in given if value is not None and value != _Constant(None)]
        return _Text((named(kind, values[0], *values[1:]),), False)

    return make


def _share(walker: _Walker, call: _Call) -> Any:
    given = call.get(0, "package_name", "package")
    if given is None:
        return _Unknown(_source(call.node))
    kind = "prefix" if call.path.endswith("prefix") else "find"
    return _Text((named(kind, walker.text(given, call.node)),))


def _parts(kind: str, is_str: bool) -> Callable[[_Walker, _Call], Any]:
    """A substitution of several values, given each or as one list."""

    def make(walker: _Walker, call: _Call) -> Any:
        given = [*call.arguments, *call.keywords.values()]
        if len(given) == 1 and isinstance(given[0], _List):
            given = given[0].items
        return _Text((Piece(kind, "", tuple(walker.text(value, call.node) for value in given)),), is_str)

    return make


def _path_join(walker: _Walker, call: _Call) -> Any:
    # os.path.join and not str.join, whose receiver is no module
    return _parts("join", True)(walker, call) if call.path.endswith("path.join") else _Unknown(_source(call.node))


def _first(is_str: bool) -> Callable[[_Walker, _Call], Any]:
    """A wrapper through which its first argument passes."""

    def make(walker: _Walker, call: _Call) -> Any:
        given = call.get(0, "text", "launch_file_path", "variable")
        if given is None:
            return _Unknown(_source(call.node))
        if isinstance(given, _Text):
            return _Text(given.value, is_str)
        return _Text(walker.text(given, call.node), is_str)

    return make


def _path(walker: _Walker, call: _Call) -> Any:
    if len(call.arguments) > 1:
        return _parts("join", True)(walker, call)
    return _first(True)(walker, call)


def _str(walker: _Walker, call: _Call) -> Any:
    given = call.get(0, "object")
    return given if isinstance(given, _Text) and given.is_str else _Text(walker.text(given, call.node))


def _performed(walker: _Walker, call: _Call) -> Any:
    given = call.get(1, "subs")
    return _Unknown(_source(call.node)) if given is None else _Text(walker.text(given, call.node))


def _dirname(walker: _Walker, call: _Call) -> Any:
    given = call.get(0, "p")
    return _Text(_folder(given.value)) if isinstance(given, _Text) else _Unknown(_source(call.node))


def _environment(walker: _Walker, call: _Call) -> Any:
    """os.getenv() and os.environ.get()."""
    if not call.path.endswith(("os.getenv", "environ.get")):
        return _Unknown(_source(call.node))
    key, default = call.get(0, "key", "varname"), call.get(1, "default")
    if key is None:
        return _Unknown(_source(call.node))
    given = [walker.text(value, call.node) for value in (key, default) if value not in (None, _Constant(None))]
    return _Text((named("env", *given),))


def _executable(walker: _Walker, call: _Call) -> Any:
    given = (call.get(0, "executable"), call.get(1, "package"))
    return _Text((Piece("executable", "", tuple(walker.text(value, call.node) for value in given)),), False)


def _expression(walker: _Walker, call: _Call) -> Any:
    given = call.get(0, "expression")
    return _Text((Piece("eval", "launch", (walker.text(given, call.node),)),), False)


def _command(walker: _Walker, call: _Call) -> Any:
    given = call.get(0, "command")
    return _Text((Piece("command", "", (walker.text(given, call.node),)),), False)


def _not_equals(walker: _Walker, call: _Call) -> Any:
    return _Text((Piece("not", "", (_parts("equals", False)(walker, call).value,)),), False)


def _parameter_value(walker: _Walker, call: _Call) -> Any:
    type_ = call.get(1, "value_type")
    name = type_.path if isinstance(type_, _Module) else ""
    return _Typed(call.get(0, "value"), _TYPES.get(name, ""))


def _parameter_file(walker: _Walker, call: _Call) -> Any:
    value = walker.text(call.get(0, "param_file"), call.node)
    allow = call.get(-1, "allow_substs")
    return _Text(value, False) if allow is None or allow == _Constant(False) else _File(value)


def _content(walker: _Walker, call: _Call) -> Any:
    """The content of a file: open() and FileContent."""
    return _Text((Piece("content", "", (walker.text(call.get(0, "file"), call.node),)),))


def _loaded(walker: _Walker, call: _Call) -> Any:
    """yaml.safe_load() of an open file."""
    given = call.get(0, "stream")
    if isinstance(given, _Text) and len(given.value) == 1 and given.value[0].kind == "content":
        return _Yaml(given.value[0].parts[0])
    return _Unknown(_source(call.node))


def _boolean_argument(walker: _Walker, call: _Call) -> Any:
    """DeclareBooleanLaunchArg of moveit_configs_utils: its default is given as a bool."""
    making = _Making(walker, call)
    default = call.get(1, "default_value")
    attributes = making.attributes(("name", call.get(0, "name")), ("default", default))
    return Action("argument", call.node.lineno, tuple(attributes), making.conditions())


def _has_node(walker: _Walker, call: _Call) -> Any:
    """HasNodeParams of nav2_common."""
    given = (call.get(0, "source_file"), call.get(1, "node_name"))
    return _Text((Piece("has-node", "", tuple(walker.text(value, call.node) for value in given)),), False)


def _rewritten(walker: _Walker, call: _Call) -> Any:
    """RewrittenYaml of nav2_common."""
    parts = [walker.text(call.get(0, "source_file"), call.node)]
    root = call.get(2, "root_key")
    parts.append(walker.text(root, call.node) if root is not None else literal(""))
    rewrites = call.get(1, "param_rewrites")
    if isinstance(rewrites, _Dict):
        for key, value in rewrites.items:
            held = value.value if isinstance(value, _Guarded) else value
            parts += (walker.text(key, call.node), walker.text(held, call.node))
    return _Text((Piece("rewritten", "", tuple(parts)),), False)


def _replaced(walker: _Walker, call: _Call) -> Any:
    """ReplaceString of nav2_common."""
    parts = [walker.text(call.get(0, "source_file"), call.node)]
    replacements = call.get(1, "replacements")
    if isinstance(replacements, _Dict):
        for key, value in replacements.items:
            parts += (walker.text(key, call.node), walker.text(value, call.node))
    value = (Piece("replaced", "", tuple(parts)),)
    asked = _Making(walker, call).conditions()
    return _Text((Piece("choose", "", (_all(asked), value, parts[0])),) if asked else value, False)


def _range(walker: _Walker, call: _Call) -> Any:
    bounds = [value.value for value in call.arguments if isinstance(value, _Constant) and isinstance(value.value, int)]
    if len(bounds) != len(call.arguments) or not 1 <= len(bounds) <= 3 or (len(bounds) == 3 and bounds[2] == 0):
        return _Unknown(_source(call.node))
    numbers = range(*bounds)
    if len(numbers) > MOST_TURNS:
        return _Unknown(_source(call.node))
    return _List([_Constant(number) for number in numbers], len(walker.conditions))


def _enumerated(walker: _Walker, call: _Call) -> Any:
    turns = walker.turns(call.get(0, "iterable"))
    start = call.get(1, "start")
    first = start.value if isinstance(start, _Constant) and isinstance(start.value, int) else 0
    if turns is None or any(isinstance(turn, _Guarded) for turn in turns):
        return _Unknown(_source(call.node))
    depth = len(walker.conditions)
    return _List([_List([_Constant(n), turn], depth) for n, turn in enumerate(turns, first)], depth)


def _zipped(walker: _Walker, call: _Call) -> Any:
    lists = [walker.turns(argument) for argument in call.arguments]
    if any(items is None or any(isinstance(item, _Guarded) for item in items) for items in lists):
        return _Unknown(_source(call.node))
    depth = len(walker.conditions)
    return _List([_List(list(row), depth) for row in zip(*(items or [] for items in lists), strict=False)], depth)


def _listed(walker: _Walker, call: _Call) -> Any:
    given = call.get(0, "iterable")
    if given is None:
        return _List([], len(walker.conditions))
    turns = walker.turns(given)
    return _Unknown(_source(call.node)) if turns is None else _List(list(turns), len(walker.conditions))


def _dict(walker: _Walker, call: _Call) -> Any:
    made = _Dict([], len(walker.conditions))
    given = call.get(0)
    if isinstance(given, _Dict):
        made.items = list(given.items)
    elif isinstance(given, _List) and all(isinstance(i, _List) and len(i.items) == 2 for i in given.items):
        made.items = [(pair.items[0], pair.items[1]) for pair in given.items]
    elif given is not None:
        return _Unknown(_source(call.node))
    for key, value in call.keywords.items():
        made.set(_Text(literal(key)), value)
    return made


def _length(walker: _Walker, call: _Call) -> Any:
    given = call.get(0)
    if isinstance(given, (_List, _Dict)) and not any(isinstance(item, _Guarded) for item in given.items):
        return _Constant(len(given.items))
    return _Unknown(_source(call.node))


def _copied(walker: _Walker, call: _Call) -> Any:
    given = call.get(0)
    if isinstance(given, _List):
        return _List(list(given.items), len(walker.conditions), given.kind)
    return _Dict(list(given.items), len(walker.conditions)) if isinstance(given, _Dict) else given


_CALLS: dict[str, Callable[[_Walker, _Call], Any]] = {
    "LaunchDescription": _description,
    "Node": _node("node"),
    "LifecycleNode": _node("lifecycle"),
    "ComposableNodeContainer": _node("container"),
    "ComposableNode": _node("composable"),
    "ComposableLifecycleNode": _node("composable"),
    "LoadComposableNodes": _load,
    "DeclareLaunchArgument": _simple("argument", ("name", 0, "name"), ("default", 1, "default_value")),
    "SetLaunchConfiguration": _simple("let", ("name", 0, "name"), ("value", 1, "value")),
    "PushRosNamespace": _simple("namespace", ("namespace", 0, "namespace")),
    "PushROSNamespace": _simple("namespace", ("namespace", 0, "namespace")),
    "SetRemap": _simple("remap", ("from", 0, "src"), ("to", 1, "dst")),
    "SetEnvironmentVariable": _simple("environment", ("name", 0, "name"), ("value", 1, "value")),
    "SetParametersFromFile": _simple("parameter-file", ("file", 0, "filename")),
    "SetParameter": _set_parameter,
    "SetUseSimTime": _sim_time,
    "GroupAction": _group,
    "IncludeLaunchDescription": _include,
    "OpaqueFunction": _opaque,
    "TimerAction": _timer,
    "RosTimer": _timer,
    "RegisterEventHandler": _register,
    "ExecuteProcess": _process,
    "ExecuteLocal": _process,
    **dict.fromkeys(
        ("OnProcessExit", "OnProcessStart", "OnProcessIO", "OnStateTransition", "OnShutdown", "OnExecutionComplete",
         "EventHandler", "OnActionEventBase"),
        _handler,
    ),
    **dict.fromkeys(
        ("LogInfo", "EmitEvent", "Shutdown", "UnsetEnvironmentVariable", "UnsetLaunchConfiguration",
         "AppendEnvironmentVariable", "PrependEnvironmentVariable", "SetROSLogDir", "LifecycleTransition",
         "ReadyToTest", "KeepAliveProc", "print", "ResetEnvironment", "PushEnvironment", "PopEnvironment"),
        _idle,
    ),
    "IfCondition": _condition("if"),
    "UnlessCondition": _condition("unless"),
    "LaunchConfigurationEquals": _configuration_is("if"),
    "LaunchConfigurationNotEquals": _configuration_is("unless"),
    "LaunchConfiguration": _substitution("arg", (0, "variable_name"), (1, "default")),
    "LaunchConfigAsBool": _substitution("arg", (0, "name")),
    "EnvironmentVariable": _substitution("env", (0, "name"), (1, "default_value")),
    "OptEnvironmentVariable": _substitution("env", (0, "name"), (1, "default_value")),
    "AnonName": _substitution("anon", (0, "name")),
    "FindPackageShare": _substitution("find", (0, "package")),
    "FindPackagePrefix": _substitution("prefix", (0, "package")),
    "FindPackage": _substitution("prefix", (0, "package")),
    "FindExecutable": _substitution("program", (0, "name")),
    "get_package_share_directory": _share,
    "get_package_share_path": _share,
    "get_package_prefix": _share,
    "ExecutableInPackage": _executable,
    "PathJoinSubstitution": _parts("join", False),
    "ThisLaunchFileDir": lambda walker, call: _Text((Piece("dirname"),), False),
    "ThisLaunchFile": lambda walker, call: _Text((Piece("filename"),), False),
    "PythonExpression": _expression,
    "Command": _command,
    "EqualsSubstitution": _parts("equals", False),
    "NotEqualsSubstitution": _not_equals,
    "NotSubstitution": _parts("not", False),
    "AndSubstitution": _parts("and", False),
    "OrSubstitution": _parts("or", False),
    "AllSubstitution": _parts("and", False),
    "AnySubstitution": _parts("or", False),
    "IfElseSubstitution": lambda walker, call: _Text((Piece("choose", "", tuple(
        walker.text(value, call.node) if value is not None else literal("")
        for value in (call.get(0, "condition"), call.get(1, "if_value"), call.get(2, "else_value")))),), False),
    "TextSubstitution": _first(True),
    **dict.fromkeys(
        ("PythonLaunchDescriptionSource", "AnyLaunchDescriptionSource", "FrontendLaunchDescriptionSource",
         "XMLLaunchDescriptionSource", "YAMLLaunchDescriptionSource"),
        _first(False),
    ),
    "ParameterFile": _parameter_file,
    "ParameterValue": _parameter_value,
    "Parameter": lambda walker, call: _Dict([(call.get(0, "name"), call.get(1, "value"))], len(walker.conditions)),
    "ForEach": _for_each,
    "ForLoop": _for_each,
    "FileContent": _content,
    "open": _content,
    "safe_load": _loaded,
    "full_load": _loaded,
    "load": _loaded,
    "DeclareBooleanLaunchArg": _boolean_argument,
    "HasNodeParams": _has_node,
    "RewrittenYaml": _rewritten,
    "ReplaceString": _replaced,
    "perform_substitutions": _performed,
    "normalize_to_list_of_substitutions": _first(False),
    "join": _path_join,
    "dirname": _dirname,
    "abspath": _first(True),
    "realpath": _first(True),
    "normpath": _first(True),
    "expanduser": _first(True),
    "Path": _path,
    "PurePath": _path,
    "str": _str,
    "getenv": _environment,
    "get": _environment,
    "range": _range,
    "enumerate": _enumerated,
    "zip": _zipped,
    "list": _listed,
    "tuple": _listed,
    "reversed": _listed,
    "sorted": _listed,
    "dict": _dict,
    "len": _length,
    "copy": _copied,
    "deepcopy": _copied,
}  # fmt: skip
