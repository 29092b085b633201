"""Statements and expressions of Python, executed one way at a time on symbolic values."""

from __future__ import annotations

import ast
import builtins
import contextlib
from collections.abc import Sequence
from typing import Any

import z3

from ..outcomes import CodeLine, Sent
from . import arrays, library, operators, texts
from .habits import has_yield, list_handed, list_outer_names, list_stored
from .messages import Messages
from .modules import (
    BoundMethod,
    FindModule,
    Handle,
    KnownMethod,
    ModuleCode,
    Outside,
    PythonClass,
    PythonFunction,
    PythonObject,
    Scope,
    TimeValue,
    Unsettled,
)  # fmt: skip
from .run import PythonRun, PythonThrownError
from .terms import (
    ArrayValue,
    BoundReachedError,
    ListValue,
    NotModelledError,
    Opaque,
    Real,
    Record,
    SymbolicText,
    Truth,
    Whole,
    is_number,
    is_symbolic,
    make_truth,
)  # fmt: skip

_DEEPEST = 40
_LONGEST_ARRAY = 64
_MISSING = object()
_PLAIN = (int, float, str, bytes, bool, type(None))
_CONTAINERS = (ListValue, dict)
_LOOSE = (*_PLAIN, Whole, Real, Truth, SymbolicText, Opaque)
"""What is any value of its kind where it is not known which it is."""


class _BreakSignal(Exception):
    """`break`."""


class _ContinueSignal(Exception):
    """`continue`."""


class _ReturnSignal(Exception):
    def __init__(self, value: Any):
        super().__init__()
        self.value = value


class PythonMachine:
    """Executes functions of a workspace on one PythonRun. find_module: other modules; messages: makes them."""

    def __init__(self, run: PythonRun, messages: Messages, find_module: FindModule):
        self.run, self.messages, self._find_module = run, messages, find_module
        self._depth = 0
        self.is_quiet = False
        """Whether effects are not noted: while a node is being made."""
        self.node: PythonObject | None = None
        """The object whose method the callback is."""

    # Modules and functions.

    def load(self, module: ModuleCode) -> ModuleCode:
        """Fills the names at the top of a module. What cannot be executed there has names of which nothing is known."""
        if not module.is_loaded:
            module.is_loaded = True
            scope = Scope(module, module.names)
            for statement in module.tree.body:
                self.execute_leniently(statement, scope)
        return module

    def execute_leniently(self, statement: ast.stmt, scope: Scope) -> None:
        """Executes a statement; where that cannot be done, what it sets may be anything."""
        try:
            self.execute(statement, scope)
        except (NotModelledError, PythonThrownError):
            self._forget(statement, scope)
        except (_BreakSignal, _ContinueSignal, _ReturnSignal):
            pass

    def _may_leave_out(self, error: NotModelledError) -> bool:
        """Whether what cannot be executed is left out and the rest is: while a node is made, unless a bound is
        reached."""
        return self.run.is_preparing and not isinstance(error, BoundReachedError)

    def _forget(self, statement: ast.stmt, scope: Scope) -> None:
        """Names and members that a statement sets are of things that nothing is known of, but for their kind where
        they were set before."""
        names, members = list_stored(statement)
        for name in names:
            if name not in scope.names or isinstance(scope.names[name], _LOOSE):
                scope.names[name] = Opaque(name)
        for node in members:
            try:
                owner = self.evaluate(node.value, scope)
            except (NotModelledError, PythonThrownError):
                continue
            if isinstance(owner, PythonObject):
                self._widen(owner, node.attr)
        for node in list_handed(statement):
            self._free_container(node, scope)

    def _free_container(self, node: ast.expr, scope: Scope) -> None:
        """Lets a list or dictionary hold anything that may have been changed in place."""
        if isinstance(node, ast.Name):
            if isinstance(scope.names.get(node.id), _CONTAINERS):
                scope.names[node.id] = Opaque(node.id)
            return
        assert isinstance(node, ast.Attribute)
        try:
            owner = self.evaluate(node.value, scope)
        except (NotModelledError, PythonThrownError):
            return
        if isinstance(owner, PythonObject) and isinstance(owner.members.get(node.attr), _CONTAINERS):
            owner.members[node.attr] = Opaque(f"this.{node.attr}")

    def _widen(self, owner: PythonObject, name: str) -> None:
        """Lets a member be any value of its kind; what ROS or the workspace made is kept."""
        path = f"this.{name}"
        value = owner.members.get(name, _MISSING)
        if owner is not self.node:
            if isinstance(value, _LOOSE) or value is _MISSING:
                owner.members[name] = Opaque(name)
        elif value is None:
            owner.members[name] = Unsettled(path)
        elif isinstance(value, _LOOSE):
            owner.members[name] = library.make_like(self, path, value)
        elif value is _MISSING:
            owner.members[name] = Opaque(path)

    def call_function(self, function: PythonFunction, given: Sequence[Any], named: dict[str, Any]) -> Any:
        """Calls a function of the workspace. Raises PythonThrownError and NotModelledError."""
        node = function.node
        if self._depth > _DEEPEST:
            raise NotModelledError("calls of more than 40 levels")
        if isinstance(node, ast.AsyncFunctionDef) or has_yield(node):
            raise NotModelledError(f"{function.name}() is a coroutine or generator")
        names = self._bind(function, list(given), dict(named))
        scope = Scope(function.scope.module, names, function.scope, list_outer_names(node))
        place = self.run.place
        self._depth += 1
        try:
            if isinstance(node, ast.Lambda):
                return self.evaluate(node.body, scope)
            self.execute_all(node.body, scope)
            return None
        except _ReturnSignal as signal:
            return signal.value
        finally:
            self._depth -= 1
            self.run.place = place

    def _bind(self, function: PythonFunction, given: list[Any], named: dict[str, Any]) -> dict[str, Any]:
        arguments = function.node.args
        positional = [*arguments.posonlyargs, *arguments.args]
        names: dict[str, Any] = {}
        for parameter, value in zip(positional, given, strict=False):
            names[parameter.arg] = value
        if len(given) > len(positional):
            if arguments.vararg is None:
                raise self.run.throw("TypeError", f"{function.name}() takes {len(positional)} arguments")
            names[arguments.vararg.arg] = ListValue(given[len(positional) :], is_frozen=True)
        elif arguments.vararg is not None:
            names[arguments.vararg.arg] = ListValue([], is_frozen=True)
        known = {one.arg for one in (*positional, *arguments.kwonlyargs)}
        rest = {name: value for name, value in named.items() if name not in known}
        names |= {name: value for name, value in named.items() if name in known}
        if arguments.kwarg is not None:
            names[arguments.kwarg.arg] = rest
        elif rest:
            raise self.run.throw("TypeError", f"{function.name}() got an unexpected argument {min(rest)}")
        defaults = positional[len(positional) - len(arguments.defaults) :]
        pairs = [
            *zip(defaults, arguments.defaults, strict=True),
            *zip(arguments.kwonlyargs, arguments.kw_defaults, strict=True),
        ]
        for parameter, default in pairs:
            if parameter.arg not in names and default is not None:
                names[parameter.arg] = self.evaluate(default, function.scope)
        for parameter in (*positional, *arguments.kwonlyargs):
            if parameter.arg not in names:
                raise self.run.throw("TypeError", f"{function.name}() misses argument {parameter.arg}")
        return names

    def make_instance(self, cls: PythonClass, given: Sequence[Any], named: dict[str, Any]) -> PythonObject:
        """An object of a class of the workspace, with its constructor run."""
        instance = PythonObject(cls)
        maker = cls.find("__init__")
        if isinstance(maker, PythonFunction):
            self.call_function(maker, [instance, *given], named)
        elif cls.find("__annotations__"):
            raise NotModelledError(f"how {cls.node.name} is made")
        return instance

    # Statements.

    def execute_all(self, body: Sequence[ast.stmt], scope: Scope) -> None:
        """Executes statements in order. While a node is made, what cannot be executed is left out one by one."""
        for statement in body:
            try:
                self.execute(statement, scope)
            except NotModelledError as error:
                if not self._may_leave_out(error):
                    raise
                self._forget(statement, scope)
                if isinstance(statement, ast.Return):
                    raise _ReturnSignal(Opaque(_spell(statement.value) if statement.value else "")) from None

    def execute(self, node: ast.stmt, scope: Scope) -> None:
        """Executes one statement."""
        self.run.count_step()
        self.run.place = CodeLine(scope.module.path, node.lineno)
        step = getattr(self, f"_execute_{type(node).__name__.lower()}", None)
        if step is None:
            raise NotModelledError(f"statement {type(node).__name__}")
        step(node, scope)

    def _execute_pass(self, node: ast.Pass, scope: Scope) -> None: ...

    def _execute_global(self, node: ast.Global, scope: Scope) -> None: ...

    def _execute_nonlocal(self, node: ast.Nonlocal, scope: Scope) -> None: ...

    def _execute_expr(self, node: ast.Expr, scope: Scope) -> None:
        self.evaluate(node.value, scope)

    def _execute_assign(self, node: ast.Assign, scope: Scope) -> None:
        value = self.evaluate(node.value, scope)
        for target in node.targets:
            self.assign(target, value, scope)

    def _execute_annassign(self, node: ast.AnnAssign, scope: Scope) -> None:
        if node.value is not None:
            self.assign(node.target, self.evaluate(node.value, scope), scope)

    def _execute_augassign(self, node: ast.AugAssign, scope: Scope) -> None:
        old = self.evaluate(_make_load(node.target), scope)
        value = self.evaluate(node.value, scope)
        if isinstance(old, ListValue) and not old.is_frozen and isinstance(node.op, ast.Add):
            self.run.fix_items(old).extend(self.iterate(value))
            self.assign(node.target, old, scope)
            return
        self.assign(node.target, self.calculate(type(node.op), old, value), scope)

    def _execute_if(self, node: ast.If, scope: Scope) -> None:
        try:
            is_chosen = self.is_true(self.evaluate(node.test, scope))
        except NotModelledError as error:
            if not self._may_leave_out(error):
                raise
            self._execute_either(node, scope)
            return
        self.execute_all(node.body if is_chosen else node.orelse, scope)

    def _execute_either(self, node: ast.If, scope: Scope) -> None:
        """Executes both branches while a node is made: what they set is there, with any value of its kind."""
        for body in (node.body, node.orelse):
            with contextlib.suppress(_BreakSignal, _ContinueSignal, _ReturnSignal, PythonThrownError):
                self.execute_all(body, scope)
        self._forget(node, scope)

    def _execute_for(self, node: ast.For, scope: Scope) -> None:
        for count, value in enumerate(self.iterate(self.evaluate(node.iter, scope))):
            if count >= 1_000:
                raise NotModelledError("a loop of more than 1,000 rounds")
            self.assign(node.target, value, scope)
            try:
                self.execute_all(node.body, scope)
            except _BreakSignal:
                return
            except _ContinueSignal:
                continue
        self.execute_all(node.orelse, scope)

    def _execute_while(self, node: ast.While, scope: Scope) -> None:
        asked = 0
        while True:
            condition = self.evaluate(node.test, scope)
            asked += is_symbolic(condition)
            if asked > self.run.bounds.loops:
                raise NotModelledError(f"a loop of more than {self.run.bounds.loops} rounds")
            if not self.is_true(condition):
                break
            try:
                self.execute_all(node.body, scope)
            except _BreakSignal:
                return
            except _ContinueSignal:
                continue
        self.execute_all(node.orelse, scope)

    def _execute_break(self, node: ast.Break, scope: Scope) -> None:
        raise _BreakSignal

    def _execute_continue(self, node: ast.Continue, scope: Scope) -> None:
        raise _ContinueSignal

    def _execute_return(self, node: ast.Return, scope: Scope) -> None:
        raise _ReturnSignal(self.evaluate(node.value, scope) if node.value is not None else None)

    def _execute_assert(self, node: ast.Assert, scope: Scope) -> None:
        if not self.is_true(self.evaluate(node.test, scope)):
            raise self.run.throw("AssertionError")

    def _execute_raise(self, node: ast.Raise, scope: Scope) -> None:
        if node.exc is None:
            caught = self._look_up("~caught", scope)
            raise caught if isinstance(caught, PythonThrownError) else self.run.throw("RuntimeError")
        value = self.evaluate(node.exc, scope)
        raise self._make_thrown(value)

    def _make_thrown(self, value: Any) -> PythonThrownError:
        if isinstance(value, PythonThrownError):
            return value
        if isinstance(value, PythonClass):
            return self._make_thrown(PythonObject(value))
        if isinstance(value, PythonObject):
            names = [one.node.name for one in value.cls.list_order()]
            outside = [name.rpartition(".")[2] for name in value.cls.list_outside()]
            return PythonThrownError(names[0], "", self.run.place, (*names[1:], *outside, "Exception"), value)
        if isinstance(value, Outside):
            return PythonThrownError(value.name.rpartition(".")[2], "", self.run.place, ("Exception",))
        raise NotModelledError("an exception that is not known")

    def _execute_try(self, node: ast.Try, scope: Scope) -> None:
        try:
            try:
                self.execute_all(node.body, scope)
            except PythonThrownError as error:
                self._handle(node, error, scope)
            else:
                self.execute_all(node.orelse, scope)
        except NotModelledError:
            raise
        except BaseException:
            self.execute_all(node.finalbody, scope)
            raise
        self.execute_all(node.finalbody, scope)

    def _handle(self, node: ast.Try, error: PythonThrownError, scope: Scope) -> None:
        for handler in node.handlers:
            if handler.type is None or any(error.is_caught_by(name) for name in self._list_caught(handler.type, scope)):
                before = scope.names.get("~caught", _MISSING)
                scope.names["~caught"] = error
                if handler.name:
                    scope.names[handler.name] = error.value if error.value is not None else error
                try:
                    self.execute_all(handler.body, scope)
                finally:
                    if before is _MISSING:
                        scope.names.pop("~caught", None)
                    else:
                        scope.names["~caught"] = before
                return
        raise error

    def _list_caught(self, node: ast.expr, scope: Scope) -> list[str]:
        value = self.evaluate(node, scope)
        found = value.elements if isinstance(value, ListValue) else [value]
        names: list[str] = []
        for one in found:
            if isinstance(one, PythonClass):
                names.append(one.node.name)
            elif isinstance(one, Outside):
                names.append(one.name.rpartition(".")[2])
            else:
                raise NotModelledError("which exceptions are caught")
        return names

    def _execute_with(self, node: ast.With, scope: Scope) -> None:
        for item in node.items:
            value = self.evaluate(item.context_expr, scope)
            if not isinstance(value, (Handle, Opaque, Outside)):
                raise NotModelledError("a context that is not known")
            if isinstance(value, Opaque) and not value.name.startswith("threading"):
                self.run.not_modelled[value.name] = None
            if item.optional_vars is not None:
                self.assign(item.optional_vars, value, scope)
        self.execute_all(node.body, scope)

    def _execute_delete(self, node: ast.Delete, scope: Scope) -> None:
        for target in node.targets:
            if isinstance(target, ast.Name):
                scope.names.pop(target.id, None)
            elif isinstance(target, ast.Subscript):
                owner, key = self.evaluate(target.value, scope), self.evaluate(target.slice, scope)
                if isinstance(owner, dict) and isinstance(key, _PLAIN):
                    if key not in owner:
                        raise self.run.throw("KeyError", str(key))
                    del owner[key]
                elif isinstance(owner, ListValue) and isinstance(key, int):
                    self.get_item(owner, key)
                    del owner.elements[key]
                else:
                    raise NotModelledError("what is deleted")
            else:
                raise NotModelledError("what is deleted")

    def _execute_functiondef(self, node: ast.FunctionDef, scope: Scope) -> None:
        decorators = tuple(_spell(one) for one in node.decorator_list)
        scope.names[node.name] = PythonFunction(node, scope, decorators=decorators)

    def _execute_asyncfunctiondef(self, node: ast.AsyncFunctionDef, scope: Scope) -> None:
        scope.names[node.name] = PythonFunction(node, scope)

    def _execute_classdef(self, node: ast.ClassDef, scope: Scope) -> None:
        members: dict[str, Any] = {}
        bases = tuple(self.evaluate(base, scope) for base in node.bases)
        cls = PythonClass(node, scope.module, bases, members)
        inner = Scope(scope.module, members, scope)
        for statement in node.body:
            self.execute_leniently(statement, inner)
        for value in members.values():
            if isinstance(value, PythonFunction) and value.scope is inner:
                value.scope, value.owner = scope, cls
        scope.names[node.name] = cls

    def _execute_import(self, node: ast.Import, scope: Scope) -> None:
        for alias in node.names:
            name = alias.name if alias.asname else alias.name.partition(".")[0]
            scope.names[alias.asname or name] = self._find_module(name) or Outside(name)

    def _execute_importfrom(self, node: ast.ImportFrom, scope: Scope) -> None:
        start = node.module or ""
        if node.level:
            parts = scope.module.name.split(".")
            start = ".".join([*parts[: len(parts) - node.level], *([start] if start else [])])
        module = self._find_module(start)
        for alias in node.names:
            if alias.name == "*":
                if module is not None:
                    scope.names.update(self.load(module).names)
                continue
            value: Any = _MISSING
            if module is not None:
                value = self.load(module).names.get(alias.name, _MISSING)
            if value is _MISSING:
                value = self._find_module(f"{start}.{alias.name}") or Outside(f"{start}.{alias.name}")
            scope.names[alias.asname or alias.name] = value

    def _execute_match(self, node: Any, scope: Scope) -> None:
        subject = self.evaluate(node.subject, scope)
        for case in node.cases:
            if self._matches(case.pattern, subject, scope) and (
                case.guard is None or self.is_true(self.evaluate(case.guard, scope))
            ):
                self.execute_all(case.body, scope)
                return

    def _matches(self, pattern: Any, subject: Any, scope: Scope) -> bool:
        kind = type(pattern).__name__
        if kind == "MatchValue":
            return self.is_true(self.compare(ast.Eq, subject, self.evaluate(pattern.value, scope)))
        if kind == "MatchSingleton":
            return subject is pattern.value
        if kind == "MatchOr":
            return any(self._matches(one, subject, scope) for one in pattern.patterns)
        if kind == "MatchAs":
            if pattern.pattern is not None and not self._matches(pattern.pattern, subject, scope):
                return False
            if pattern.name:
                scope.names[pattern.name] = subject
            return True
        if kind == "MatchSequence" and isinstance(subject, ListValue):
            found = self.run.fix_items(subject)
            return len(found) == len(pattern.patterns) and all(
                self._matches(one, value, scope) for one, value in zip(pattern.patterns, found, strict=True)
            )
        raise NotModelledError(f"pattern {kind}")

    # Names.

    def assign(self, target: ast.expr, value: Any, scope: Scope) -> None:
        """Gives a value to a name, a member, an element, or several of these."""
        if isinstance(target, ast.Name):
            holder = self._find_holder(target.id, scope) if target.id in scope.outside else scope
            if isinstance(value, Handle) and not value.name:
                value.name = target.id
            holder.names[target.id] = value
        elif isinstance(target, (ast.Tuple, ast.List)):
            found = self._unpack(value, target.elts)
            starred = [index for index, one in enumerate(target.elts) if isinstance(one, ast.Starred)]
            if starred:
                at, rest = starred[0], len(target.elts) - starred[0] - 1
                if len(found) < len(target.elts) - 1:
                    raise self.run.throw("ValueError", "not enough values to unpack")
                middle = ListValue(found[at : len(found) - rest])
                found = [*found[:at], middle, *found[len(found) - rest :]]
            if len(found) != len(target.elts):
                raise self.run.throw("ValueError", f"{len(target.elts)} values to unpack, {len(found)} given")
            for one, each in zip(target.elts, found, strict=True):
                self.assign(one.value if isinstance(one, ast.Starred) else one, each, scope)
        elif isinstance(target, ast.Attribute):
            self.set_member(self.evaluate(target.value, scope), target.attr, value)
        elif isinstance(target, ast.Subscript):
            self._set_item(self.evaluate(target.value, scope), self.evaluate(target.slice, scope), value)
        else:
            raise NotModelledError("what is assigned to")

    def _unpack(self, value: Any, targets: Sequence[ast.expr]) -> list[Any]:
        """The elements that several targets are given; what is not known is taken to have as many."""
        if isinstance(value, Opaque) and not any(isinstance(one, ast.Starred) for one in targets):
            self.run.assumed[f"{value.name} has {len(targets)} elements"] = None
            return [Opaque(f"{value.name}[{index}]") for index in range(len(targets))]
        return self.iterate(value)

    def set_member(self, owner: Any, name: str, value: Any) -> None:
        if isinstance(owner, PythonObject):
            setter = owner.cls.members.get(f"{name}.setter")
            if setter is not None:
                raise NotModelledError(f"the setter of {name}")
            if isinstance(value, Handle) and not value.name:
                value.name = name
            owner.members[name] = value
        elif isinstance(owner, Record):
            if owner.is_known and self._ensure_field(owner, name) is None and name not in owner.fields:
                raise self.run.throw("AttributeError", name)
            owner.fields[name] = value
        elif owner is None:
            raise self.run.throw("AttributeError", f"None has no {name}")
        elif isinstance(owner, (Opaque, Handle, Outside)):
            self.run.not_modelled[f"{_describe(owner)}.{name} = …"] = None
        elif isinstance(owner, PythonClass):
            owner.members[name] = value
        else:
            raise NotModelledError(f"a member {name} set")

    def _ensure_field(self, record: Record, name: str) -> Any:
        return self.messages.find_field(self.run, record, name)

    def _set_item(self, owner: Any, key: Any, value: Any) -> None:
        if isinstance(owner, dict):
            if not isinstance(key, _PLAIN):
                raise NotModelledError("a key that is not known")
            owner[key] = value
        elif isinstance(owner, ListValue):
            if owner.is_frozen:
                raise self.run.throw("TypeError", "a tuple does not change")
            if isinstance(key, slice):
                self._set_slice(owner, key, value)
            else:
                owner.elements[self._find_index(owner, key)] = value
        elif isinstance(owner, ArrayValue):
            arrays.set_elements(self.run, owner, key, value)
        elif isinstance(owner, Opaque):
            self.run.not_modelled[f"{owner.name}[…] = …"] = None
        elif owner is None:
            raise self.run.throw("TypeError", "None has no elements")
        else:
            raise NotModelledError("an element set")

    def _set_slice(self, owner: ListValue, key: slice, value: Any) -> None:
        if any(is_symbolic(one) or isinstance(one, Opaque) for one in (key.start, key.stop, key.step)):
            raise NotModelledError("a slice whose bounds are not known")
        items = self.iterate(value)
        try:
            self.run.fix_items(owner)[key] = items
        except ValueError as error:
            raise self.run.throw("ValueError", str(error)) from None

    def _find_holder(self, name: str, scope: Scope) -> Scope:
        one: Scope | None = scope.outer
        while one is not None and one.outer is not None:
            if name in one.names and name not in one.outside:
                return one
            one = one.outer
        return one or Scope(scope.module, scope.module.names)

    def _look_up(self, name: str, scope: Scope) -> Any:
        one: Scope | None = scope
        while one is not None:
            if name in one.names:
                return one.names[name]
            one = one.outer
        if name in scope.module.names:
            return scope.module.names[name]
        return _MISSING

    # Expressions.

    def evaluate(self, node: ast.expr, scope: Scope) -> Any:
        """The value of an expression. Raises PythonThrownError and NotModelledError, but for the latter while a node
        is made: what is not known is any value then."""
        step = getattr(self, f"_evaluate_{type(node).__name__.lower()}", None)
        try:
            if step is None:
                raise NotModelledError(f"expression {type(node).__name__}")
            return step(node, scope)
        except NotModelledError as error:
            if not self._may_leave_out(error):
                raise
            return Opaque(_spell(node) or "something")

    def _evaluate_constant(self, node: ast.Constant, scope: Scope) -> Any:
        return node.value

    def _evaluate_name(self, node: ast.Name, scope: Scope) -> Any:
        value = self._look_up(node.id, scope)
        if value is not _MISSING:
            return value
        if hasattr(builtins, node.id):
            return Outside(f"builtins.{node.id}")
        if node.id in ("unicode", "xrange", "raw_input", "long", "basestring"):
            return Outside(f"builtins.{node.id}")
        raise NotModelledError(f"the name {node.id}")

    def _evaluate_attribute(self, node: ast.Attribute, scope: Scope) -> Any:
        return self.get_member(self.evaluate(node.value, scope), node.attr)

    def get_member(self, owner: Any, name: str) -> Any:
        """`owner.name`."""
        if isinstance(owner, PythonObject):
            if name in owner.members:
                value = owner.members[name]
                if isinstance(value, Unsettled):
                    value = None if self.run.choose(f"{value.path} is still None") else Opaque(value.path)
                    owner.members[name] = value
                return value
            found = owner.cls.find(name)
            if isinstance(found, PythonFunction):
                if "property" in found.decorators or "cached_property" in found.decorators:
                    return self.call_function(found, [owner], {})
                if "staticmethod" in found.decorators:
                    return found
                if found.decorators and "classmethod" not in found.decorators:
                    raise NotModelledError(f"the decorator of {name}")
                return BoundMethod(found, owner.cls if "classmethod" in found.decorators else owner)
            if found is not None or name in owner.cls.members:
                return found
            if name == "__class__":
                return owner.cls
            if owner.cls.list_outside():
                return KnownMethod(owner, name)
            raise self.run.throw("AttributeError", name)
        if isinstance(owner, Record):
            value = self.messages.find_field(self.run, owner, name)
            if value is None and name not in owner.fields:
                constants = self.messages.find_constants(owner.type)
                if name in constants:
                    return constants[name]
                if not owner.is_known:
                    return Opaque(f"{owner.type}.{name}")
                if name.startswith("_") or name in library.RECORD_METHODS or _is_time(owner):
                    return KnownMethod(owner, name)
                raise self.run.throw("AttributeError", name)
            return value
        if isinstance(owner, Outside):
            return library.find_constant(owner, name, self.messages)
        if isinstance(owner, ModuleCode):
            names = self.load(owner).names
            if name in names:
                return names[name]
            return self._find_module(f"{owner.name}.{name}") or Opaque(f"{owner.name}.{name}")
        if isinstance(owner, PythonClass):
            found = owner.find(name)
            if found is None and name not in owner.members:
                return Outside(f"{owner.node.name}.{name}")
            return found
        if owner is None:
            raise self.run.throw("AttributeError", f"None has no {name}")
        if isinstance(owner, Opaque):
            return Opaque(f"{owner.name}.{name}")
        if isinstance(
            owner, (SymbolicText, str, ListValue, dict, Handle, TimeValue, Whole, int, float, Real, bytes, set)
        ):
            return library.find_member(self, owner, name)
        if isinstance(owner, PythonThrownError):
            return Opaque("an exception's member")
        raise NotModelledError(f"the member {name}")

    def _evaluate_call(self, node: ast.Call, scope: Scope) -> Any:
        if isinstance(node.func, ast.Name) and node.func.id == "super" and "super" not in scope.names:
            return self._make_super(scope)
        called = self.evaluate(node.func, scope)
        given: list[Any] = []
        for one in node.args:
            if isinstance(one, ast.Starred):
                given.extend(self.iterate(self.evaluate(one.value, scope)))
            else:
                given.append(self.evaluate(one, scope))
        named: dict[str, Any] = {}
        for keyword in node.keywords:
            value = self.evaluate(keyword.value, scope)
            if keyword.arg is not None:
                named[keyword.arg] = value
            elif isinstance(value, dict):
                named.update(value)
            else:
                raise NotModelledError("arguments that are not known")
        self.run.place = CodeLine(scope.module.path, node.lineno)
        return self.call(called, given, named)

    def _make_super(self, scope: Scope) -> Any:
        one: Scope | None = scope
        while one is not None and "self" not in one.names:
            one = one.outer
        if one is None or not isinstance(one.names["self"], PythonObject):
            raise NotModelledError("super()")
        return Handle("super", "super", one.names["self"])

    def call(self, called: Any, given: list[Any], named: dict[str, Any]) -> Any:
        """Calls something. What is not known gives a value that nothing is known of, and is noted."""
        self.run.count_step()
        if isinstance(called, PythonFunction):
            return self.call_function(called, given, named)
        if isinstance(called, BoundMethod):
            return self.call_function(called.function, [called.owner, *given], named)
        if isinstance(called, PythonClass):
            return self.make_instance(called, given, named)
        if isinstance(called, Outside):
            return library.call_outside(self, called.name, given, named)
        if isinstance(called, KnownMethod):
            return library.call_method(self, called.owner, called.name, given, named)
        if isinstance(called, Handle):
            return library.call_handle(self, called, given)
        if isinstance(called, Opaque):
            self.run.not_modelled[f"{called.name}()"] = None
            return Opaque(f"{called.name}()")
        if isinstance(called, PythonObject):
            return self.call(self.get_member(called, "__call__"), given, named)
        if called is None:
            raise self.run.throw("TypeError", "None is not callable")
        raise NotModelledError("what is called")

    def note_publish(self, handle: Handle, given: Sequence[Any], named: dict[str, Any]) -> None:
        """A message published through a handle."""
        if self.is_quiet:
            return
        self.run.note_effect("publish", handle.name)
        values: dict[str, Any] = {}
        kinds: dict[str, Any] = {}
        message = given[0] if given else None
        if isinstance(message, Record):
            self.messages.flatten(self.run, message, "", values, kinds)
        elif isinstance(handle.content, str) and (given or named):
            fields = self.messages.list_fields(handle.content)
            for name, value in [*zip(fields, given, strict=False), *named.items()]:
                self.messages.flatten(self.run, value, name, values, kinds)
        self.run.sent.append(Sent(handle.name, values, kinds, self.run.place))

    def _evaluate_boolop(self, node: ast.BoolOp, scope: Scope) -> Any:
        value: Any = None
        for one in node.values:
            value = self.evaluate(one, scope)
            if one is node.values[-1]:
                return value
            if self.is_true(value) != isinstance(node.op, ast.And):
                return value
        return value

    def _evaluate_unaryop(self, node: ast.UnaryOp, scope: Scope) -> Any:
        value = self.evaluate(node.operand, scope)
        if isinstance(node.op, ast.Not):
            if isinstance(value, Truth):
                return make_truth(z3.Not(value.term))
            return not self.is_true(value)
        if isinstance(value, Opaque):
            return Opaque(value.name)
        if not is_number(value):
            raise self.run.throw("TypeError", "bad operand")
        if not is_symbolic(value):
            return {ast.USub: lambda x: -x, ast.UAdd: lambda x: +x, ast.Invert: lambda x: ~x}[type(node.op)](value)
        if isinstance(node.op, ast.USub):
            return operators.negate(value)
        if isinstance(node.op, ast.UAdd):
            return value
        return operators.calculate(self.run, ast.Sub, operators.negate(value), 1)

    def _evaluate_binop(self, node: ast.BinOp, scope: Scope) -> Any:
        left, right = self.evaluate(node.left, scope), self.evaluate(node.right, scope)
        self.run.place = CodeLine(scope.module.path, node.lineno)
        return self.calculate(type(node.op), left, right)

    def calculate(self, kind: type[ast.operator], left: Any, right: Any) -> Any:
        """`left kind right`."""
        if isinstance(left, Opaque) or isinstance(right, Opaque):
            return Opaque(left.name if isinstance(left, Opaque) else right.name)
        if kind is ast.Mod and isinstance(left, (str, SymbolicText)):
            return Opaque("formatted text")
        if isinstance(left, TimeValue) or isinstance(right, TimeValue) or _is_time(left) or _is_time(right):
            return library.calculate_moment(self, kind, left, right)
        if is_number(left) and is_number(right):
            if is_symbolic(left) or is_symbolic(right):
                return operators.calculate(self.run, kind, left, right)
            return self._compute(kind, left, right)
        if isinstance(left, (str, SymbolicText)) and isinstance(right, (str, SymbolicText)) and kind is ast.Add:
            a, b = texts.list_characters(self.run, left), texts.list_characters(self.run, right)
            return texts.make_text((*a, *b))
        if isinstance(left, ListValue) and isinstance(right, ListValue) and kind is ast.Add:
            return ListValue([*self.run.fix_items(left), *self.run.fix_items(right)], is_frozen=left.is_frozen)
        if isinstance(left, ListValue) and isinstance(right, int) and kind is ast.Mult:
            if right > 10_000:
                raise NotModelledError("a long list")
            return ListValue(self.run.fix_items(left) * right, is_frozen=left.is_frozen)
        if isinstance(left, _PLAIN) and isinstance(right, _PLAIN):
            return self._compute(kind, left, right)
        if left is None or right is None:
            raise self.run.throw("TypeError", "an operator on None")
        raise NotModelledError(f"operator {kind.__name__}")

    def _compute(self, kind: type[ast.operator], left: Any, right: Any) -> Any:
        if kind is ast.Pow and (abs(left) > 1e6 or abs(right) > 100):
            raise NotModelledError("a large power")
        if kind in (ast.Mult, ast.LShift) and any(isinstance(one, str) for one in (left, right)):
            raise NotModelledError("a text repeated")
        if kind is ast.LShift and right > 1_000:
            raise NotModelledError("a large number")
        try:
            return operators.CONCRETE[kind](left, right)
        except (ArithmeticError, TypeError, ValueError) as error:
            raise self.run.throw(type(error).__name__, str(error)) from error

    def _evaluate_compare(self, node: ast.Compare, scope: Scope) -> Any:
        left = self.evaluate(node.left, scope)
        result: Any = True
        for kind, each in zip(node.ops, node.comparators, strict=True):
            right = self.evaluate(each, scope)
            result = self.compare(type(kind), left, right)
            if each is not node.comparators[-1] and not self.is_true(result):
                return False
            left = right
        return result

    def compare(self, kind: type[ast.cmpop], left: Any, right: Any) -> Any:
        """`left kind right`: a bool, a Truth, or an Opaque."""
        if kind in (ast.Is, ast.IsNot):
            if isinstance(left, Opaque) or isinstance(right, Opaque):
                return Opaque(_describe(left))
            same = left is right or (isinstance(left, (bool, int, str)) and type(left) is type(right) and left == right)
            if isinstance(left, Truth) or isinstance(right, Truth):
                return self.compare(ast.Eq if kind is ast.Is else ast.NotEq, left, right)
            return same == (kind is ast.Is)
        if kind in (ast.In, ast.NotIn):
            found = self._contains(right, left)
            if isinstance(found, Opaque) or kind is ast.In:
                return found
            return make_truth(z3.Not(found.term)) if isinstance(found, Truth) else not found
        if isinstance(left, Opaque) or isinstance(right, Opaque):
            return Opaque(_describe(left if isinstance(left, Opaque) else right))
        if is_number(left) and is_number(right):
            said = operators.compare(kind, left, right)
            if isinstance(said, bool):
                self.run.note_size(left, right)
                self.run.note_size(right, left)
            return said
        if isinstance(left, TimeValue) or isinstance(right, TimeValue) or _is_time(left) or _is_time(right):
            return library.compare_moments(self, kind, left, right)
        if kind in (ast.Eq, ast.NotEq):
            same = self._are_equal(left, right)
            if kind is ast.Eq or isinstance(same, Opaque):
                return same
            return make_truth(z3.Not(same.term)) if isinstance(same, Truth) else not same
        if isinstance(left, str) and isinstance(right, str):
            return operators.CONCRETE[kind](left, right)
        if (
            left is None
            or right is None
            or isinstance(left, (str, SymbolicText)) != isinstance(right, (str, SymbolicText))
        ):
            raise self.run.throw("TypeError", "values that have no order")
        raise NotModelledError("a comparison")

    def _are_equal(self, left: Any, right: Any) -> Any:
        if isinstance(left, (str, SymbolicText)) and isinstance(right, (str, SymbolicText)):
            return texts.are_equal(self.run, left, right)
        if isinstance(left, ListValue) and isinstance(right, ListValue):
            a, b = self.run.fix_items(left), self.run.fix_items(right)
            if len(a) != len(b):
                return False
            parts = [self.compare(ast.Eq, one, other) for one, other in zip(a, b, strict=True)]
            return all(self.is_true(part) for part in parts)
        if isinstance(left, Record) and isinstance(right, Record) and left.type == right.type:
            names = self.messages.list_fields(left.type)
            return all(
                self.is_true(self.compare(ast.Eq, self.get_member(left, name), self.get_member(right, name)))
                for name in names
            )
        if isinstance(left, (PythonObject, Handle, Record, ListValue, dict)) or isinstance(
            right, (PythonObject, Handle, Record, ListValue, dict)
        ):
            return left is right or (isinstance(left, dict) and isinstance(right, dict) and left == right)
        if isinstance(left, _PLAIN) and isinstance(right, _PLAIN):
            return left == right
        if left is None or right is None:
            return False
        if isinstance(left, (Outside, PythonClass)) or isinstance(right, (Outside, PythonClass)):
            return left == right
        return type(left) is type(right) and left is right

    def _contains(self, holder: Any, value: Any) -> Any:
        if isinstance(holder, (str, SymbolicText)) and isinstance(value, (str, SymbolicText)):
            if isinstance(holder, str) and isinstance(value, str):
                return value in holder
            return texts.contains(self.run, holder, value)
        if isinstance(holder, Opaque) or isinstance(value, Opaque):
            return Opaque(_describe(holder))
        if isinstance(holder, dict):
            keys: list[Any] = list(holder)
        elif isinstance(holder, ListValue):
            keys = self.run.fix_items(holder)
        elif holder is None:
            raise self.run.throw("TypeError", "None has no elements")
        else:
            keys = self.iterate(holder)
        terms: list[z3.BoolRef] = []
        for key in keys:
            same = self.compare(ast.Eq, value, key)
            if same is True:
                return True
            if isinstance(same, Truth):
                terms.append(same.term)
            elif isinstance(same, Opaque):
                return same
        return make_truth(z3.Or(*terms)) if terms else False

    def is_true(self, value: Any) -> bool:
        """Whether a value counts as true; decides where both can be."""
        if isinstance(value, bool):
            return value
        if isinstance(value, Truth):
            return self.run.decide(value)
        if isinstance(value, (Whole, Real)):
            return not self.run.decide(operators.is_zero(value))
        if isinstance(value, SymbolicText):
            return value.size is None or not self.run.decide(operators.compare(ast.Eq, value.size, 0))
        if isinstance(value, ListValue):
            if value.size is None:
                return bool(value.elements)
            return not self.run.decide(operators.compare(ast.Eq, value.size, 0))
        if isinstance(value, Opaque):
            return self.run.choose(value.name)
        if isinstance(value, (_PLAIN, dict)):
            return bool(value)
        if isinstance(value, PythonObject) and (value.cls.find("__bool__") or value.cls.find("__len__")):
            raise NotModelledError("whether an object is true")
        return True

    def _evaluate_ifexp(self, node: ast.IfExp, scope: Scope) -> Any:
        return self.evaluate(node.body if self.is_true(self.evaluate(node.test, scope)) else node.orelse, scope)

    def _evaluate_lambda(self, node: ast.Lambda, scope: Scope) -> Any:
        return PythonFunction(node, scope)

    def _evaluate_namedexpr(self, node: ast.NamedExpr, scope: Scope) -> Any:
        value = self.evaluate(node.value, scope)
        self.assign(node.target, value, scope)
        return value

    def _evaluate_tuple(self, node: ast.Tuple, scope: Scope) -> Any:
        return ListValue(self._evaluate_all(node.elts, scope), is_frozen=True)

    def _evaluate_list(self, node: ast.List, scope: Scope) -> Any:
        return ListValue(self._evaluate_all(node.elts, scope))

    def _evaluate_set(self, node: ast.Set, scope: Scope) -> Any:
        return ListValue(self._evaluate_all(node.elts, scope))

    def _evaluate_all(self, nodes: Sequence[ast.expr], scope: Scope) -> list[Any]:
        found: list[Any] = []
        for one in nodes:
            if isinstance(one, ast.Starred):
                found.extend(self.iterate(self.evaluate(one.value, scope)))
            else:
                found.append(self.evaluate(one, scope))
        return found

    def _evaluate_dict(self, node: ast.Dict, scope: Scope) -> Any:
        found: dict[Any, Any] = {}
        for key, value in zip(node.keys, node.values, strict=True):
            if key is None:
                more = self.evaluate(value, scope)
                if not isinstance(more, dict):
                    raise NotModelledError("a dictionary that is not known")
                found.update(more)
                continue
            name = self.evaluate(key, scope)
            if not isinstance(name, _PLAIN):
                name = _make_key(name)
            found[name] = self.evaluate(value, scope)
        return found

    def _evaluate_subscript(self, node: ast.Subscript, scope: Scope) -> Any:
        owner = self.evaluate(node.value, scope)
        key = self.evaluate(node.slice, scope)
        self.run.place = CodeLine(scope.module.path, node.lineno)
        if isinstance(key, slice):
            return self._cut(owner, [key.start, key.stop, key.step])
        return self.get_item(owner, key)

    def _evaluate_slice(self, node: ast.Slice, scope: Scope) -> Any:
        parts = (node.lower, node.upper, node.step)
        return slice(*[None if one is None else self.evaluate(one, scope) for one in parts])

    def _cut(self, owner: Any, parts: list[Any]) -> Any:
        if isinstance(owner, Opaque):
            return Opaque(owner.name)
        if any(isinstance(one, Opaque) for one in parts):
            raise NotModelledError("a slice whose bounds are not known")
        if any(is_symbolic(one) for one in parts):
            raise NotModelledError("a slice whose bounds are not known")
        if isinstance(owner, (str, SymbolicText)):
            return texts.cut_text(self.run, owner, *parts)
        if isinstance(owner, ListValue):
            return ListValue(self.run.fix_items(owner)[slice(*parts)], is_frozen=owner.is_frozen)
        if owner is None:
            raise self.run.throw("TypeError", "None has no elements")
        raise NotModelledError("a slice")

    def get_item(self, owner: Any, key: Any) -> Any:
        """`owner[key]`."""
        if isinstance(owner, ListValue):
            if isinstance(key, Opaque):
                return Opaque(key.name)
            return owner.elements[self._find_index(owner, key)]
        if isinstance(owner, (str, SymbolicText)):
            characters = texts.list_characters(self.run, owner)
            index = self._find_index(ListValue(list(characters)), key)
            return texts.make_text((characters[index],))
        if isinstance(owner, dict):
            return self._get_from_dictionary(owner, key)
        if isinstance(owner, Opaque):
            if isinstance(owner, ArrayValue):
                arrays.check_index(self.run, owner, key)
            return Opaque(f"{owner.name}[…]")
        if owner is None:
            raise self.run.throw("TypeError", "None has no elements")
        if isinstance(owner, Handle):
            return Opaque(owner.name)
        if isinstance(owner, PythonObject) and isinstance(owner.cls.find("__getitem__"), PythonFunction):
            return self.call_function(owner.cls.find("__getitem__"), [owner, key], {})
        raise NotModelledError("an element")

    def _get_from_dictionary(self, owner: dict[Any, Any], key: Any) -> Any:
        if isinstance(key, _PLAIN):
            if key not in owner:
                raise self.run.throw("KeyError", str(key))
            return owner[key]
        if isinstance(key, Opaque):
            return Opaque(key.name)
        for one, value in owner.items():
            plain = ListValue(list(one), is_frozen=True) if isinstance(one, tuple) else one
            if self.is_true(self.compare(ast.Eq, key, plain)):
                return value
        raise self.run.throw("KeyError")

    def _find_index(self, owner: ListValue, key: Any) -> int:
        """The index of an element, decided on. Raises what Python raises out of range."""
        if not isinstance(key, (int, Whole, Truth)):
            raise self.run.throw("TypeError", "an index that is no integer")
        if isinstance(key, int) and key >= 0 and owner.size is not None:
            if not self.run.decide(operators.compare(ast.Gt, owner.size, key)):
                raise self.run.throw("IndexError")
            return key
        elements = self.run.fix_items(owner)
        if isinstance(key, int):
            if not -len(elements) <= key < len(elements):
                raise self.run.throw("IndexError")
            return key if key >= 0 else key + len(elements)
        for index in range(-len(elements), len(elements)):
            if self.is_true(self.compare(ast.Eq, key, index)):
                return index % len(elements)
        raise self.run.throw("IndexError")

    def iterate(self, value: Any) -> list[Any]:
        """The elements that a loop over a value goes through."""
        if isinstance(value, ListValue):
            return list(self.run.fix_items(value))
        if isinstance(value, ArrayValue) and value.shape and value.shape[0] <= _LONGEST_ARRAY:
            rest = value.shape[1:]
            names = [f"{value.name}[{at}]" for at in range(value.shape[0])]
            return [ArrayValue(one, rest) if rest else Opaque(one) for one in names]
        if isinstance(value, dict):
            return list(value)
        if isinstance(value, (str, SymbolicText)):
            return [texts.make_text((one,)) for one in texts.list_characters(self.run, value)]
        if isinstance(value, range):
            return list(value)
        if value is None:
            raise self.run.throw("TypeError", "None has no elements")
        if isinstance(value, (int, float, Whole, Real)):
            raise self.run.throw("TypeError", "a number has no elements")
        raise NotModelledError(f"a loop over {_describe(value)}")

    def _evaluate_listcomp(self, node: ast.ListComp, scope: Scope) -> Any:
        return ListValue(
            self._build_comprehension(node.generators, scope, lambda inner: self.evaluate(node.elt, inner))
        )

    def _evaluate_generatorexp(self, node: ast.GeneratorExp, scope: Scope) -> Any:
        return ListValue(
            self._build_comprehension(node.generators, scope, lambda inner: self.evaluate(node.elt, inner))
        )

    def _evaluate_setcomp(self, node: ast.SetComp, scope: Scope) -> Any:
        return ListValue(
            self._build_comprehension(node.generators, scope, lambda inner: self.evaluate(node.elt, inner))
        )

    def _evaluate_dictcomp(self, node: ast.DictComp, scope: Scope) -> Any:
        pairs = self._build_comprehension(
            node.generators, scope, lambda inner: (self.evaluate(node.key, inner), self.evaluate(node.value, inner))
        )
        return {(key if isinstance(key, _PLAIN) else _make_key(key)): value for key, value in pairs}

    def _build_comprehension(self, generators: Sequence[ast.comprehension], scope: Scope, make: Any) -> list[Any]:
        found: list[Any] = []

        def go(level: int, inner: Scope) -> None:
            if level == len(generators):
                found.append(make(inner))
                return
            generator = generators[level]
            for value in self.iterate(self.evaluate(generator.iter, inner)):
                self.run.count_step()
                self.assign(generator.target, value, inner)
                if all(self.is_true(self.evaluate(test, inner)) for test in generator.ifs):
                    go(level + 1, inner)

        go(0, Scope(scope.module, {}, scope))
        return found

    def _evaluate_joinedstr(self, node: ast.JoinedStr, scope: Scope) -> Any:
        parts: list[Any] = []
        for one in node.values:
            if isinstance(one, ast.FormattedValue):
                value = self.evaluate(one.value, scope)
                parts.append(value if one.format_spec is None and one.conversion == -1 else Opaque("formatted text"))
            else:
                parts.append(self.evaluate(one, scope))
        return library.join_text(self, parts)

    def _evaluate_starred(self, node: ast.Starred, scope: Scope) -> Any:
        raise NotModelledError("a starred expression")


def _make_key(value: Any) -> Any:
    """A key of a dictionary: tuples of plain values."""
    if isinstance(value, ListValue) and value.size is None and all(isinstance(one, _PLAIN) for one in value.elements):
        return tuple(value.elements)
    raise NotModelledError("a key that is not known")


def _is_time(value: Any) -> bool:
    return isinstance(value, Record) and value.type in ("builtin_interfaces/Time", "builtin_interfaces/Duration")


def _describe(value: Any) -> str:
    if isinstance(value, (Opaque, Handle, Outside)):
        return value.name
    return type(value).__name__.lower()


def _make_load(node: ast.expr) -> ast.expr:
    """The expression that reads what a statement assigns to."""
    if isinstance(node, ast.Name):
        return ast.copy_location(ast.Name(node.id, ast.Load()), node)
    if isinstance(node, ast.Attribute):
        return ast.copy_location(ast.Attribute(node.value, node.attr, ast.Load()), node)
    if isinstance(node, ast.Subscript):
        return ast.copy_location(ast.Subscript(node.value, node.slice, ast.Load()), node)
    return node


def _spell(node: ast.expr) -> str:
    """The last name of an expression, empty where it has none."""
    if isinstance(node, ast.Call):
        node = node.func
    if isinstance(node, ast.Attribute):
        return node.attr
    return node.id if isinstance(node, ast.Name) else ""
