"""A launch file in Python followed without being run.

Its tree is walked as Python would run it, with values that are known, substitutions, or unknown. Branches that hang on
what is only known at launch are walked both, and what they add stands under their condition.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from ....edges.dispatch import collect_node_methods
from ..place import Problem
from ..python.text import fill_format, fill_percent, list_imported, list_parameters, make_mapping
from .actions import (
    TEXT_METHODS,
    Action,
    ActionCondition,
    Value,
    ValuePart,
    find_literal,
    join_all,
    make_literal,
    make_named,
    make_other,
)
from .python_values import (
    ConditionalValue,
    ConditionValue,
    Context,
    Either,
    FilledFile,
    Items,
    LaunchClass,
    LaunchConstant,
    LaunchFunction,
    LaunchModule,
    LaunchScope,
    Method,
    MoveItConfig,
    Object,
    Pairs,
    TextValue,
    TooMuch,
    TypedValue,
    Unknown,
    YamlContent,
    add_action_conditions,
    add_conditions,
    calculate_result,
    find_index,
    get_source,
    join_conditions,
    list_branches,
    make_parent_path,
    split_conditions,
)

MOST_STEPS = 200_000
STEPS = f"takes more than {MOST_STEPS} steps"
MOST_TURNS = 200
DEEPEST_CALL = 24
ENTRIES = ("generate_launch_description", "generate_test_description")


class HelperModule(NamedTuple):
    """A module that a launch file imports. package: relative imports in it are of this module's."""

    tree: ast.Module
    package: str


class Walker:
    """One walk through a file. make: what a call of an imported name makes, see python_calls.make(). helpers: modules
    that it imports, by their dotted names. imports: after the walk all that was imported, in order."""

    def __init__(
        self,
        make: Callable[[Walker, ast.Call, str, list[Any], dict[str, Any]], Any],
        helpers: Mapping[str, HelperModule] | None = None,
    ) -> None:
        self.make = make
        self.helpers = helpers or {}
        self.imports: dict[str, None] = {}
        self._entered: dict[str, LaunchScope] = {}
        # The line that leads out of the launch file, 0 within it; and the last line of a call in it.
        self.outside = self.last_line = 0
        self.module = LaunchScope(None)
        self.module.names["__file__"] = TextValue((ValuePart("filename"),))
        self.scope = self.module
        self.conditions: list[ActionCondition] = []
        self.returns: list[tuple[tuple[ActionCondition, ...], Any]] = []
        self.base = 0
        self.calls = 0
        self.steps = 0

    def launch(self, tree: ast.Module) -> tuple[tuple[Action, ...], tuple[Problem, ...]]:
        self.walk_block(tree.body)
        entry = next((f for f in map(self.module.names.get, ENTRIES) if isinstance(f, LaunchFunction)), None)
        if entry is None:
            return (), (Problem(1, "has no generate_launch_description()"),)
        result = self.call_function(entry, [], {})
        if isinstance(result, Items) and result.kind == "tuple" and result.items:
            # A test's description, and what its cases are told
            result = result.items[0]
        return tuple(self.list_actions(result, entry.node.lineno)), ()

    def walk_block(self, statements: Sequence[ast.stmt]) -> bool:
        """Walks statements; True when none that follows them can run."""
        added = 0
        try:
            for statement in statements:
                self.count_steps(1)
                handler = _STATEMENTS.get(type(statement))
                if handler is None:
                    continue
                outcome = handler(self, statement)
                if outcome is True:
                    return True
                if isinstance(outcome, ActionCondition):
                    # One branch jumps: all that follows stands under the other's condition.
                    self.conditions.append(outcome)
                    added += 1
            return False
        finally:
            if added:
                del self.conditions[-added:]

    def walk_under(self, statements: Sequence[ast.stmt], *conditions: ActionCondition) -> bool:
        """Walks statements under more conditions; True as from block()."""
        count = len(self.conditions)
        self.conditions += conditions
        jumps = self.walk_block(statements)
        del self.conditions[count:]
        return jumps

    def run_Expr(self, statement: ast.Expr) -> None:
        self.evaluate(statement.value)

    def run_Assign(self, statement: ast.Assign) -> None:
        value = self.evaluate(statement.value)
        for target in statement.targets:
            self.bind(target, value)

    def run_AnnAssign(self, statement: ast.AnnAssign) -> None:
        if statement.value is not None:
            self.bind(statement.target, self.evaluate(statement.value))

    def run_AugAssign(self, statement: ast.AugAssign) -> None:
        added = self.evaluate(statement.value)
        before = self.evaluate(statement.target)
        if isinstance(before, Items) and isinstance(added, Items):
            self.extend(before, added.items)
        elif isinstance(before, Pairs) and isinstance(added, Pairs):
            for key, value in added.items:
                before.set(key, value)
        elif isinstance(statement.op, ast.Add):
            self.bind(statement.target, self.add(before, added, statement))
        else:
            self.bind(statement.target, Unknown(get_source(statement)))

    def bind(self, target: ast.expr, value: Any) -> None:
        if isinstance(target, ast.Name):
            self.scope.names[target.id] = value
        elif isinstance(target, (ast.Tuple, ast.List)):
            items = value.items if isinstance(value, Items) else ()
            known = len(items) == len(target.elts)
            for place, element in enumerate(target.elts):
                self.bind(element, items[place] if known else Unknown(get_source(element)))
        elif isinstance(target, ast.Subscript):
            holder = self.evaluate(target.value)
            key = self.evaluate(target.slice)
            if isinstance(holder, Pairs):
                holder.set(key, self.add_conditions(value, holder.depth))
            elif isinstance(holder, Items) and (place := find_index(holder, key)) is not None:
                holder.items[place] = value
        elif isinstance(target, ast.Attribute):
            holder = self.evaluate(target.value)
            if isinstance(holder, Object):
                holder.attributes[target.attr] = value

    def run_Return(self, statement: ast.Return) -> bool:
        value = LaunchConstant(None) if statement.value is None else self.evaluate(statement.value)
        self.returns.append((tuple(self.conditions[self.base :]), value))
        return True

    def run_Break(self, statement: ast.stmt) -> bool:
        return True

    run_Continue = run_Raise = run_Break

    def run_If(self, statement: ast.If) -> bool | ActionCondition | None:
        decided = self.evaluate_test(statement.test)
        if isinstance(decided, bool):
            return self.walk_block(statement.body if decided else statement.orelse)
        yes = ActionCondition("if", decided, self.locate(statement))
        no = ActionCondition("unless", decided, self.locate(statement))
        before = dict(self.scope.names)
        body_jumps = self.walk_under(statement.body, yes)
        after_body, self.scope.names = self.scope.names, dict(before)
        else_jumps = self.walk_under(statement.orelse, no)
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
                names[name] = Either(decided, value, names[name])
        return None

    def run_For(self, statement: ast.For) -> None:
        turns = self.list_turns(self.evaluate(statement.iter))
        if turns is None:
            over = f"for {get_source(statement.target)} in {get_source(statement.iter)}"
            self.bind_unknown(statement.target)
            self.walk_under(statement.body, ActionCondition("each", (make_other(over),), self.locate(statement)))
        else:
            for value, extra in map(split_conditions, turns):
                self.bind(statement.target, value)
                if self.walk_under(statement.body, *extra) and not _jumps_to_next_turn(statement.body):
                    break
        self.walk_block(statement.orelse)

    def bind_unknown(self, target: ast.expr) -> None:
        for node in ast.walk(target):
            if isinstance(node, ast.Name):
                self.scope.names[node.id] = Unknown(node.id)

    def list_turns(self, over: Any) -> list[Any] | None:
        """What a loop walks through, None when that is not known."""
        if not isinstance(over, (Items, Pairs)) or len(over.items) > MOST_TURNS:
            return None
        return [key for key, _ in over.items] if isinstance(over, Pairs) else over.items

    def run_While(self, statement: ast.While) -> None:
        self.walk_under(
            statement.body,
            ActionCondition("each", (make_other(f"while {get_source(statement.test)}"),), self.locate(statement)),
        )

    def run_With(self, statement: ast.With) -> bool:
        for item in statement.items:
            value = self.evaluate(item.context_expr)
            if item.optional_vars is not None:
                self.bind(item.optional_vars, value)
        return self.walk_block(statement.body)

    def run_Try(self, statement: ast.Try) -> bool:
        jumps = self.walk_block(statement.body)
        if not jumps:
            jumps = self.walk_block(statement.orelse)
        return self.walk_block(statement.finalbody) or jumps

    def run_FunctionDef(self, statement: ast.FunctionDef | ast.AsyncFunctionDef) -> None:
        self.scope.names[statement.name] = LaunchFunction(statement, self.scope)

    run_AsyncFunctionDef = run_FunctionDef

    def locate(self, node: ast.stmt | ast.expr) -> int:
        """The line of the launch file that something is at: what stands in another file is where that is called."""
        return self.outside or node.lineno

    def run_ClassDef(self, statement: ast.ClassDef) -> None:
        type_ = LaunchClass()
        for inner in statement.body:
            if isinstance(inner, (ast.FunctionDef, ast.AsyncFunctionDef)):
                type_.methods[inner.name] = LaunchFunction(inner, self.scope)
        self.scope.names[statement.name] = type_

    def run_Import(self, statement: ast.Import | ast.ImportFrom) -> None:
        if isinstance(statement, ast.Import):
            self.imports.update(dict.fromkeys(alias.name for alias in statement.names))
        for name, path in list_imported(statement):
            path = self._make_absolute(path)
            self.imports[path] = None
            found = self._find_helper(path, self.locate(statement))
            if name == "*":
                self.scope.names.update(found.names if isinstance(found, LaunchScope) else {})
            else:
                self.scope.names[name] = LaunchModule(path) if isinstance(found, LaunchScope) else found

    def _make_absolute(self, path: str) -> str:
        """A dotted path that may be relative to the file it stands in, from the root."""
        up = len(path) - len(path.lstrip("."))
        helper = self.helpers.get(self.scope.find_module())
        if not up or helper is None:
            return path
        base = helper.package.split(".")
        return ".".join((*base[: max(0, len(base) - up + 1)], path[up:])).strip(".")

    def _find_helper(self, path: str, line: int) -> Any:
        """What a dotted path stands for: the scope of a module that is there, what it has under a name, or else the
        path itself. line: of what asks for it."""
        if path in self.helpers:
            return self._enter(path, line)
        module, _, name = path.rpartition(".")
        if module in self.helpers:
            found = self._enter(module, line).names.get(name)
            if found is not None:
                return found
        return LaunchModule(path)

    def _enter(self, module: str, line: int) -> LaunchScope:
        """The names of a module, which is run when it is first asked for."""
        if module not in self._entered:
            scope = self._entered[module] = LaunchScope(None, {}, module)
            outer = self.scope, self.conditions, self.returns, self.base, self.outside
            self.scope, self.conditions, self.returns, self.base, self.outside = scope, [], [], 0, self.outside or line
            try:
                self.walk_block(self.helpers[module].tree.body)
            finally:
                self.scope, self.conditions, self.returns, self.base, self.outside = outer
        return self._entered[module]

    run_ImportFrom = run_Import

    def evaluate_test(self, node: ast.expr) -> bool | Value:
        """Whether an expression is true: known, or a value that tells at launch."""
        value = self._join_conditions(node) if isinstance(node, ast.BoolOp) else self.evaluate(node)
        return self.find_truth(value, node)

    def find_truth(self, value: Any, node: ast.AST) -> bool | Value:
        if isinstance(value, LaunchConstant):
            return bool(value.value)
        if isinstance(value, TextValue):
            if not value.is_str:
                return True
            text = find_literal(value.value)
            if text is not None:
                return bool(text)
            if len(value.value) == 1 and value.value[0].kind in _BOOLEAN_PIECES:
                return value.value
            return (ValuePart("not", "", ((ValuePart("equals", "", (value.value, make_literal(""))),),)),)
        if isinstance(value, (Items, Pairs)):
            if not value.items:
                return False
            if not any(isinstance(item, ConditionalValue) for item in value.items):
                return True
        if isinstance(value, (LaunchModule, LaunchFunction, Object, LaunchClass, Action, Context)):
            return True
        return (make_other(get_source(node)),)

    def evaluate_Compare(self, node: ast.Compare) -> Any:
        if len(node.ops) != 1:
            return Unknown(get_source(node))
        op = node.ops[0]
        left, right = self.evaluate(node.left), self.evaluate(node.comparators[0])
        same: Any = None
        if isinstance(op, (ast.Eq, ast.NotEq, ast.Is, ast.IsNot)):
            same = self.are_equal(left, right)
        elif isinstance(op, (ast.In, ast.NotIn)) and isinstance(right, (Items, Pairs)):
            items = [key for key, _ in right.items] if isinstance(right, Pairs) else right.items
            outcomes = [self.are_equal(left, item) for item in items]
            if any(outcome is True for outcome in outcomes):
                same = True
            elif all(outcome is False for outcome in outcomes):
                same = False
            elif isinstance(left, TextValue) and all(isinstance(item, TextValue) for item in items):
                same = (ValuePart("in", "", (left.value, *(item.value for item in items))),)
        elif isinstance(left, LaunchConstant) and isinstance(right, LaunchConstant):
            return calculate_result(node, left.value, right.value)
        elif isinstance(op, (ast.In, ast.NotIn)) and isinstance(left, TextValue) and isinstance(right, TextValue):
            inner, outer = find_literal(left.value), find_literal(right.value)
            if inner is not None and outer is not None:
                same = inner in outer
        if same is None:
            return Unknown(get_source(node))
        negated = isinstance(op, (ast.NotEq, ast.IsNot, ast.NotIn))
        if isinstance(same, bool):
            return LaunchConstant(same != negated)
        return TextValue((ValuePart("not", "", (same,)),) if negated else same)

    def are_equal(self, left: Any, right: Any) -> bool | Value | None:
        """Whether two values are the same; None when that cannot be known."""
        if isinstance(left, LaunchConstant) and isinstance(right, LaunchConstant):
            return left.value == right.value
        if isinstance(left, TextValue) and isinstance(right, TextValue):
            a, b = find_literal(left.value), find_literal(right.value)
            if a is not None and b is not None:
                return a == b
            if not (left.is_str and right.is_str):
                return False
            return (ValuePart("equals", "", (left.value, right.value)),)
        if isinstance(left, Either) or isinstance(right, Either):
            return None
        if isinstance(left, Unknown) or isinstance(right, Unknown):
            return None
        return False

    def evaluate(self, node: ast.expr) -> Any:
        self.count_steps(1)
        handler = _EXPRESSIONS.get(type(node))
        if handler is None:
            return Unknown(get_source(node))
        return handler(self, node)

    def evaluate_Constant(self, node: ast.Constant) -> Any:
        if isinstance(node.value, str):
            return TextValue(make_literal(node.value))
        if node.value is None or isinstance(node.value, (bool, int, float)):
            return LaunchConstant(node.value)
        return Unknown(get_source(node))

    def evaluate_Name(self, node: ast.Name) -> Any:
        found = self.scope.look(node.id)
        return LaunchModule(node.id) if found is None else found

    def evaluate_Attribute(self, node: ast.Attribute) -> Any:
        receiver = self.evaluate(node.value)
        name = node.attr
        if isinstance(receiver, LaunchModule):
            found = self._find_helper(f"{receiver.path}.{name}", self.locate(node))
            return LaunchModule(f"{receiver.path}.{name}") if isinstance(found, LaunchScope) else found
        if isinstance(receiver, Object):
            if name in receiver.attributes:
                return receiver.attributes[name]
            method = receiver.type.methods.get(name)
            return Unknown(get_source(node)) if method is None else method._replace(self=receiver)
        if isinstance(receiver, MoveItConfig):
            return receiver.attributes.get(name) or Method(receiver, name)
        if isinstance(receiver, Context) and name == "launch_configurations":
            return Context(True)
        if isinstance(receiver, TextValue) and name == "parent":
            return TextValue(make_parent_path(receiver.value))
        if isinstance(receiver, Items) and name == "entities":
            return receiver
        if isinstance(receiver, Unknown):
            return Unknown(get_source(node))
        return Method(receiver, name)

    def evaluate_Subscript(self, node: ast.Subscript) -> Any:
        holder = self.evaluate(node.value)
        key = self.evaluate(node.slice) if not isinstance(node.slice, ast.Slice) else None
        if isinstance(holder, LaunchModule) and holder.path == "os.environ" and isinstance(key, TextValue):
            return TextValue((make_named("env", key.value),))
        if isinstance(holder, YamlContent) and isinstance(key, TextValue):
            return holder._replace(keys=(*holder.keys, key.value))
        if isinstance(holder, Context) and isinstance(key, TextValue):
            return TextValue((make_named("arg", key.value),))
        if isinstance(holder, Pairs):
            found = holder.get(key)
            if found is not None and not isinstance(found, ConditionalValue):
                return found
        if isinstance(holder, Items) and (place := find_index(holder, key)) is not None:
            return holder.items[place]
        return Unknown(get_source(node))

    def evaluate_List(self, node: ast.List | ast.Tuple) -> Any:
        items: list[Any] = []
        for element in node.elts:
            if isinstance(element, ast.Starred):
                value = self.evaluate(element.value)
                if isinstance(value, Items):
                    items += value.items
                else:
                    items.append(Unknown(get_source(element)))
            else:
                items.append(self.evaluate(element))
        return Items(items, len(self.conditions), "tuple" if isinstance(node, ast.Tuple) else "list")

    evaluate_Tuple = evaluate_List

    def evaluate_Dict(self, node: ast.Dict) -> Any:
        made = Pairs([], len(self.conditions))
        for key, item in zip(node.keys, node.values, strict=True):
            value = self.evaluate(item)
            if key is not None:
                made.set(self.evaluate(key), value)
            elif isinstance(value, Pairs):
                for inner, held in value.items:
                    made.set(inner, held)
            else:
                made.set(Unknown(get_source(item)), value)
        return made

    def evaluate_JoinedStr(self, node: ast.JoinedStr) -> Any:
        values: list[Value] = []
        for part in node.values:
            inner = part.value if isinstance(part, ast.FormattedValue) else part
            values.append(self.make_text(self.evaluate(inner), inner))
        return TextValue(join_all(values))

    def evaluate_BinOp(self, node: ast.BinOp) -> Any:
        left, right = self.evaluate(node.left), self.evaluate(node.right)
        if isinstance(node.op, ast.Add):
            return self.add(left, right, node)
        if isinstance(node.op, ast.Div) and isinstance(left, TextValue):
            return TextValue((ValuePart("join", "", (left.value, self.make_text(right, node.right))),), left.is_str)
        if isinstance(node.op, ast.Mod) and isinstance(left, TextValue):
            pattern = find_literal(left.value)
            given = right.items if isinstance(right, Items) else [right]
            if pattern is not None:
                texts = [self.make_text(value, node.right) for value in given]
                return _join_filled(fill_percent(pattern, texts), node)
        if isinstance(left, LaunchConstant) and isinstance(right, LaunchConstant):
            return calculate_result(node, left.value, right.value)
        if isinstance(left, Pairs) and isinstance(right, Pairs) and isinstance(node.op, ast.BitOr):
            made = Pairs(list(left.items), len(self.conditions))
            for key, value in right.items:
                made.set(key, value)
            return made
        return Unknown(get_source(node))

    def add(self, left: Any, right: Any, node: ast.AST) -> Any:
        if isinstance(left, Items) and isinstance(right, Items):
            self.count_steps(len(left.items) + len(right.items))
            return Items([*left.items, *right.items], len(self.conditions), left.kind)
        # What a YAML file holds at a key is put together as what it is: a text.
        left, right = (
            TextValue(self.make_text(one, node)) if isinstance(one, YamlContent) and one.keys else one
            for one in (left, right)
        )
        kinds = {type(left), type(right)}
        if TextValue in kinds and kinds <= {TextValue, Either, Items, Unknown}:
            # A list beside a substitution is one of these
            is_str = Items not in kinds and (Unknown in kinds or all(getattr(v, "is_str", True) for v in (left, right)))
            return TextValue(join_all([self.make_text(left, node), self.make_text(right, node)]), is_str)
        if isinstance(left, LaunchConstant) and isinstance(right, LaunchConstant) and isinstance(node, ast.BinOp):
            return calculate_result(node, left.value, right.value)
        return Unknown(get_source(node))

    def evaluate_BoolOp(self, node: ast.BoolOp) -> Any:
        """`and` and `or`: known where what comes first decides, else a value that tells at launch whether they hold.
        What they are worth is not known where that may be a text: `url or "http://localhost"`."""
        found = self._join_conditions(node)
        values = [self.evaluate(part) for part in node.values]
        return found if found in values or all(map(_is_flag, values)) else Unknown(get_source(node))

    def _join_conditions(self, node: ast.BoolOp) -> Any:
        is_or = isinstance(node.op, ast.Or)
        open_: list[Value] = []
        for place, part in enumerate(node.values):
            value = self._join_conditions(part) if isinstance(part, ast.BoolOp) else self.evaluate(part)
            truth = self.find_truth(value, part)
            if isinstance(truth, bool):
                if truth == is_or or (place == len(node.values) - 1 and not open_):
                    if not open_:
                        return value
                    if truth == is_or:
                        open_.append(make_literal(str(truth)))
                        break
                continue
            open_.append(truth)
        joined: Value = (ValuePart("or" if is_or else "and", "", tuple(open_)),)
        return TextValue(joined if len(open_) > 1 else open_[0])

    def evaluate_UnaryOp(self, node: ast.UnaryOp) -> Any:
        if isinstance(node.op, ast.Not):
            truth = self.evaluate_test(node.operand)
            known = isinstance(truth, bool)
            return LaunchConstant(not truth) if known else TextValue((ValuePart("not", "", (truth,)),))
        value = self.evaluate(node.operand)
        is_number = isinstance(value, LaunchConstant) and isinstance(value.value, (int, float))
        if is_number and not isinstance(node.op, ast.Invert):
            return LaunchConstant(-value.value) if isinstance(node.op, ast.USub) else value
        return Unknown(get_source(node))

    def evaluate_IfExp(self, node: ast.IfExp) -> Any:
        truth = self.evaluate_test(node.test)
        if isinstance(truth, bool):
            return self.evaluate(node.body if truth else node.orelse)
        return Either(truth, self.evaluate(node.body), self.evaluate(node.orelse))

    def evaluate_Lambda(self, node: ast.Lambda) -> Any:
        return LaunchFunction(node, self.scope)

    def evaluate_NamedExpr(self, node: ast.NamedExpr) -> Any:
        value = self.evaluate(node.value)
        self.bind(node.target, value)
        return value

    def evaluate_Starred(self, node: ast.Starred) -> Any:
        return self.evaluate(node.value)

    def evaluate_ListComp(self, node: ast.ListComp | ast.GeneratorExp | ast.SetComp | ast.DictComp) -> Any:
        outer, self.scope = self.scope, LaunchScope(self.scope)
        made: list[Any] = []
        depth = len(self.conditions)

        def walk(place: int) -> None:
            if place == len(node.generators):
                extra = tuple(self.conditions[depth:])
                if isinstance(node, ast.DictComp):
                    made.append((self.evaluate(node.key), add_conditions(self.evaluate(node.value), extra)))
                else:
                    made.append(add_conditions(self.evaluate(node.elt), extra))
                return
            generator = node.generators[place]
            turns = self.list_turns(self.evaluate(generator.iter))
            unknown = turns is None
            if turns is None:
                over = f"for {get_source(generator.target)} in {get_source(generator.iter)}"
                self.conditions.append(ActionCondition("each", (make_other(over),), self.locate(node)))
                turns = [None]
            for value, extra in map(split_conditions, turns):
                start = len(self.conditions)
                if unknown:
                    self.bind_unknown(generator.target)
                else:
                    self.bind(generator.target, value)
                    self.conditions += extra
                truths = [self.evaluate_test(test) for test in generator.ifs]
                if not any(truth is False for truth in truths):
                    self.conditions += [
                        ActionCondition("if", t, self.locate(node)) for t in truths if not isinstance(t, bool)
                    ]
                    walk(place + 1)
                del self.conditions[start:]
            if unknown:
                self.conditions.pop()

        try:
            walk(0)
        finally:
            self.scope = outer
            del self.conditions[depth:]
        return Pairs(made, depth) if isinstance(node, ast.DictComp) else Items(made, depth)

    evaluate_GeneratorExp = evaluate_SetComp = evaluate_DictComp = evaluate_ListComp

    def add_conditions(self, value: Any, depth: int) -> Any:
        return add_conditions(value, tuple(self.conditions[depth:]))

    def extend(self, holder: Items, items: Sequence[Any]) -> None:
        for item in items:
            holder.items.append(self.add_conditions(item, holder.depth))
            if len(holder.items) > MOST_STEPS:
                raise TooMuch(STEPS)

    def evaluate_Call(self, node: ast.Call) -> Any:
        function = self.evaluate(node.func)
        arguments: list[Any] = []
        for argument in node.args:
            value = self.evaluate(argument)
            if isinstance(argument, ast.Starred):
                arguments += value.items if isinstance(value, Items) else [Unknown(get_source(argument))]
            else:
                arguments.append(value)
        given = self.evaluate_Dict(make_mapping(node)).items
        named = [(find_literal(key.value), value) for key, value in given if isinstance(key, TextValue)]
        keywords = {name: value for name, value in named if name is not None}
        self.last_line = self.locate(node)
        if isinstance(function, LaunchFunction):
            return self.call_function(function, arguments, keywords)
        if isinstance(function, LaunchClass):
            made = Object(function)
            init = function.methods.get("__init__")
            if init is not None:
                self.call_function(init._replace(self=made), arguments, keywords)
            return made
        if isinstance(function, Method):
            return self.call_method(function, arguments, keywords, node)
        if isinstance(function, LaunchModule):
            return self.make(self, node, function.path, arguments, keywords)
        return Unknown(get_source(node))

    def call_function(self, function: LaunchFunction, arguments: list[Any], keywords: dict[str, Any]) -> Any:
        node = function.node
        if self.calls >= DEEPEST_CALL:
            return Unknown(getattr(node, "name", "lambda"))
        scope, depth = LaunchScope(function.scope), len(self.conditions)
        outer = (self.scope, self.returns, self.base, self.outside)
        self.scope = function.scope
        if function.scope.find_module():
            self.outside = self.outside or self.last_line
        positional = iter(arguments if function.self is None else [function.self, *arguments])
        rest = dict(keywords)
        for kind, parameter, default in list_parameters(node.args):
            name = parameter.arg
            if kind == "args":
                value: Any = Items([*positional], depth)
            elif kind == "kwargs":
                value = Pairs([(TextValue(make_literal(key)), each) for key, each in rest.items()], depth)
            else:
                missing = Unknown(name) if default is None else self.evaluate(default)
                value = rest.pop(name, missing if kind == "keyword" else next(positional, missing))
            scope.names[name] = value
        self.scope, self.returns, self.base = scope, [], depth
        self.calls += 1
        try:
            if isinstance(node, ast.Lambda):
                return self.evaluate(node.body)
            self.walk_block(node.body)
            return self.merge_returns()
        finally:
            self.calls -= 1
            self.scope, self.returns, self.base, self.outside = outer

    def merge_returns(self) -> Any:
        """What the return statements reached give together."""
        value: Any = LaunchConstant(None)
        for place, (conditions, returned) in enumerate(reversed(self.returns)):
            if not conditions or place == 0:
                # The last one is what remains when no earlier one was taken.
                value = returned if place == 0 and len(self.returns) > 1 else add_conditions(returned, conditions)
            else:
                value = Either(join_conditions(conditions), returned, value)
        return value

    def call_method(self, method: Method, arguments: list[Any], keywords: dict[str, Any], node: ast.Call) -> Any:
        receiver, name = method
        first = arguments[0] if arguments else None
        if isinstance(receiver, MoveItConfig):
            return self.make(self, node, f"{receiver.path}.{name}", [receiver, *arguments], keywords)
        if isinstance(receiver, Items):
            if name in ("append", "add_action", "add_entity") and arguments:
                self.extend(receiver, arguments[:1])
            elif name == "extend" and arguments:
                self.extend(receiver, first.items if isinstance(first, Items) else [Unknown(get_source(node.args[0]))])
            elif name == "insert" and len(arguments) == 2:
                place = first.value if isinstance(first, LaunchConstant) and isinstance(first.value, int) else 0
                receiver.items.insert(place, self.add_conditions(arguments[1], receiver.depth))
            elif name == "remove" and first in receiver.items:
                receiver.items.remove(first)
            elif name == "update" and receiver.kind == "parameters" and arguments:
                self.extend(receiver, arguments[:1])
            elif name == "copy":
                return Items(list(receiver.items), len(self.conditions), receiver.kind)
            else:
                return Unknown(get_source(node))
            return LaunchConstant(None)
        if isinstance(receiver, Pairs):
            depth = len(self.conditions)
            if name == "items":
                pairs = [(key, *split_conditions(value)) for key, value in receiver.items]
                return Items([add_conditions(Items([k, v], depth), c) for k, v, c in pairs], depth)
            if name in ("keys", "values"):
                return Items([pair[name == "values"] for pair in receiver.items], depth)
            if name == "update" and isinstance(first, Pairs):
                for key, value in first.items:
                    receiver.set(key, self.add_conditions(value, receiver.depth))
                return LaunchConstant(None)
            if name in ("get", "pop") and arguments:
                found = receiver.get(first)
                if found is not None:
                    return found if not isinstance(found, ConditionalValue) else Unknown(get_source(node))
                if first is not None and all(isinstance(key, TextValue) for key, _ in receiver.items):
                    return arguments[1] if len(arguments) > 1 else LaunchConstant(None)
            if name == "copy":
                return Pairs(list(receiver.items), depth)
        elif isinstance(receiver, Context):
            if name in ("get", "perform_substitution", "__getitem__") and first is not None:
                if not receiver.configurations:
                    return TextValue(self.make_text(first, node))
                rest = [self.make_text(a, node) for a in arguments[1:]]
                return TextValue((make_named("arg", self.make_text(first, node), *rest),))
        elif isinstance(receiver, ConditionValue) and name == "evaluate":
            return TextValue(join_conditions(receiver.conditions))
        elif isinstance(receiver, (TextValue, Either)):
            return self.call_text_method(receiver, name, arguments, keywords, node)
        return Unknown(get_source(node))

    def call_text_method(
        self, receiver: Any, name: str, arguments: list[Any], keywords: dict[str, Any], node: ast.Call
    ) -> Any:
        value = self.make_text(receiver, node)
        if name in ("perform", "resolve", "as_posix", "absolute", "expanduser", "read", "read_text"):
            if name == "read_text":
                value = (ValuePart("content", "", (value,)),)
            return TextValue(value)
        is_finder = isinstance(receiver, TextValue) and not receiver.is_str and value[:1] and value[0].kind in _FINDING
        if name == "find" and is_finder:
            # A substitution of a package's folder gives that of any package that it is asked for.
            asked = arguments[0] if arguments else keywords.get("package_name")
            return TextValue((make_named(value[0].kind, self.make_text(asked, node)),))
        if name == "joinpath":
            return TextValue((ValuePart("join", "", (value, *(self.make_text(a, node) for a in arguments))),))
        if name == "join" and len(arguments) == 1 and isinstance(arguments[0], Items):
            parts: list[Value] = []
            for item in arguments[0].items:
                parts += (*([value] if parts else ()), self.make_text(item, node))
            return TextValue(join_all(parts))
        if name == "format" and (pattern := find_literal(value)) is not None:
            given = {**dict(enumerate(arguments)), **keywords}
            filled = fill_format(pattern, {key: self.make_text(each, node) for key, each in given.items()})
            return _join_filled(filled, node)
        if name in TEXT_METHODS:
            return TextValue((ValuePart("method", name, (value, *(self.make_text(a, node) for a in arguments))),))
        return Unknown(get_source(node))

    def count_steps(self, steps: int) -> None:
        """Counts steps; raises TooMuch when there have been too many."""
        self.steps += steps
        if self.steps > MOST_STEPS:
            raise TooMuch(STEPS)

    def make_text(self, value: Any, node: ast.AST) -> Value:
        """A value as text; node: what to show where it is not known."""
        self.count_steps(1)
        if isinstance(value, TextValue):
            self.count_steps(len(value.value) + len(value.value[0].text) // 100 if value.value else 1)
            return value.value
        if isinstance(value, LaunchConstant):
            return make_literal("" if value.value is None else str(value.value))
        if isinstance(value, (FilledFile, TypedValue)):
            return value.value if isinstance(value, FilledFile) else self.make_text(value.value, node)
        if isinstance(value, Either):
            yes, no = self.make_text(value.yes, node), self.make_text(value.no, node)
            return (ValuePart("choose", "", (value.condition, yes, no)),)
        if isinstance(value, Items) and value.kind != "launch":
            return join_all([self.make_text(item, node) for item in value.items])
        if isinstance(value, Unknown):
            return (make_other(value.source),)
        if isinstance(value, YamlContent) and value.keys:
            return (ValuePart("yaml", "", (value.file, *value.keys)),)
        return (make_other(get_source(node)),)

    def list_actions(self, value: Any, line: int, extra: tuple[ActionCondition, ...] = ()) -> Iterator[Action]:
        """The actions that a value given for actions holds."""
        for held, conditions in list_branches(value, line, extra):
            self.count_steps(1)
            if isinstance(held, Action):
                yield add_action_conditions(held, conditions)
            elif isinstance(held, (Items, Pairs)):
                for item in held.items if isinstance(held, Items) else [each for _, each in held.items]:
                    yield from self.list_actions(item, line, conditions)
            elif isinstance(held, Unknown) and not held.source.startswith(_NO_ACTION):
                yield Action("unknown", line, (("text", (make_other(held.source),)),), conditions)
            elif not isinstance(held, (LaunchConstant, Unknown)):
                source = getattr(held, "path", type(held).__name__)
                yield Action("unknown", line, (("text", (make_other(str(source)),)),), conditions)


# Calls whose result is no action, where a lambda stands for an action that is run for its effect.
_NO_ACTION = ("nothing()", "os.", "shutil.", "logging.", "sys.", "time.", "warnings.", "print(")
_FINDING = frozenset(("find", "prefix"))
_BOOLEAN_PIECES = frozenset(("equals", "not", "and", "or", "in"))


def _is_flag(value: Any) -> bool:
    """Whether a value is true or false, and no text that stands for either."""
    if isinstance(value, LaunchConstant):
        return isinstance(value.value, bool)
    is_piece = isinstance(value, TextValue) and len(value.value) == 1
    return is_piece and value.value[0].kind in _BOOLEAN_PIECES


def _join_filled(pieces: Sequence[Any], node: ast.AST) -> TextValue | Unknown:
    """Literal text and values one after the other, where all are there."""
    if None in pieces:
        return Unknown(get_source(node))
    return TextValue(join_all([make_literal(piece) if isinstance(piece, str) else piece for piece in pieces]))


def _jumps_to_next_turn(body: Sequence[ast.stmt]) -> bool:
    """Whether the jump that ends a turn of a loop goes on with the next."""
    kinds = {node.__class__ for statement in body for node in ast.walk(statement)}
    return ast.Continue in kinds and kinds.isdisjoint((ast.Break, ast.Return))


_STATEMENTS = collect_node_methods(Walker, "run_")
_EXPRESSIONS = collect_node_methods(Walker, "evaluate_")
