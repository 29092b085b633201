"""A Python module to what it offers (impact/facts/python/surface.py). Nothing is imported or run."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator

import msgspec

from ...impact.facts.condition import Condition
from ...impact.facts.place import Problem
from ...impact.facts.python.reader import EXCEPT, IMPORT_ERRORS, TRY
from ...impact.facts.python.source import read
from ...impact.facts.python.surface import LATE, Bound, ImportedName, ModuleSurface, make_parameters, unparse_even
from ...impact.facts.python.text import format_dotted, list_caught_exceptions
from .module_getattr import read_module_getattr

LONGEST = 80
_WARNINGS = frozenset(("DeprecationWarning", "PendingDeprecationWarning", "FutureWarning"))
_NAMESPACES = frozenset(("globals", "locals", "vars"))
_PROPERTIES = frozenset(("property", "cached_property", "abstractproperty"))
# So many statements at the beginning of a body are looked at for a warning that it is deprecated.
_BEGIN = 4


Facts = ModuleSurface
LIMITS = {"": "python"}
"""What facts/kinds.py asks a module that makes facts for: their type, and which limit the size of files has."""


def extract(data: bytes) -> ModuleSurface:
    """What a Python source offers; Python 2 as far as python2.py rewrites it. Never raises.

    A source that does not parse gives nothing, with `parsed` False.
    """
    source = read(data)
    if source.tree is None:
        problems = source.problems or tuple(source.python2_only[:1])
        return ModuleSurface((), (), parsed=False, problems=problems)
    reader = _Module(source.tree.body)
    try:
        reader.visit_block(source.tree.body, "", ())
    except RecursionError:
        return ModuleSurface((), (), parsed=False, problems=(Problem(1, "nested too deeply"),))
    everything = None if reader.all is None else tuple(dict.fromkeys(reader.all))
    return ModuleSurface(
        tuple(reader.names),
        tuple(reader.imports),
        everything,
        reader.all_open,
        tuple(dict.fromkeys(reader.open)),
        _find_warning(source.tree.body),
        problems=source.problems,
    )


class _Module:
    """One walk over what runs when the module is imported, and over the bodies of its classes' methods."""

    def __init__(self, body: list[ast.stmt]) -> None:
        self.body = body
        self.names: list[Bound] = []
        self.imports: list[ImportedName] = []
        self.all: list[str] | None = None
        self.all_open = False
        self.open: list[tuple[str, str]] = []
        self.modules: set[str] = set()  # names that stand for an entry of sys.modules

    def visit_block(self, body: Iterable[ast.stmt], scope: str, conditions: tuple[Condition, ...]) -> None:
        """Statements of the module or of a class body. scope: the class, empty for the module."""
        for node in body:
            if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
                self.add_function(node, scope, conditions)
            elif isinstance(node, ast.ClassDef):
                self.add_class(node, scope, conditions)
            elif isinstance(node, ast.Assign):
                for target in node.targets:
                    self.bind_target(target, node.value, "", scope, conditions)
            elif isinstance(node, ast.AnnAssign):
                if node.value is not None or scope:  # `x: int` binds nothing in a module
                    self.bind_target(node.target, node.value, unparse_even(node.annotation), scope, conditions)
            elif isinstance(node, ast.AugAssign):
                self.extend_exports(node, scope)
            elif isinstance(node, ast.Import):
                for alias in node.names:
                    name = alias.asname or alias.name.partition(".")[0]
                    self.imports.append(ImportedName(name, alias.name, 0, "", node.lineno, scope, conditions))
            elif isinstance(node, ast.ImportFrom):
                for alias in node.names:
                    name, module = alias.asname or alias.name, node.module or ""
                    if name == "__getattr__":
                        self.open.append((scope, "__getattr__"))
                    self.imports.append(
                        ImportedName(name, module, node.level, alias.name, node.lineno, scope, conditions)
                    )
            elif isinstance(node, ast.Delete):
                self.remove_deleted(node, scope)
            elif isinstance(node, ast.Expr):
                self.visit_call_statement(node.value, scope)
            else:
                self.visit_nested(node, scope, conditions)

    def visit_nested(self, node: ast.stmt, scope: str, conditions: tuple[Condition, ...]) -> None:
        """Statements that hold others."""
        if isinstance(node, ast.If):
            self.visit_choice(node, scope, conditions)
        elif isinstance(node, ast.Try) or node.__class__.__name__ == "TryStar":
            self.visit_try(node, scope, conditions)
        elif isinstance(node, (ast.With, ast.AsyncWith)):
            for item in node.items:
                if item.optional_vars is not None:
                    self.bind_target(item.optional_vars, None, "", scope, conditions)
            hides = any(_format_dotted(item.context_expr).endswith("suppress") for item in node.items)
            self.visit_block(node.body, scope, (*conditions, TRY) if hides else conditions)
        elif isinstance(node, (ast.For, ast.AsyncFor, ast.While)):
            if not isinstance(node, ast.While):
                self.bind_target(node.target, None, "", scope, conditions)
            self.visit_block([*node.body, *node.orelse], scope, conditions)
        elif isinstance(node, ast.Match):
            for case in node.cases:
                self.visit_block(case.body, scope, (*conditions, Condition("python", "match")))
        elif node.__class__.__name__ == "TypeAlias":
            target = getattr(node, "name", None)
            if target is not None:
                self.bind_target(target, None, "", scope, conditions)

    def visit_choice(self, node: ast.If, scope: str, conditions: tuple[Condition, ...]) -> None:
        test = unparse_even(node.test)
        if test == "__name__ == '__main__'":
            return
        self.visit_block(node.body, scope, (*conditions, Condition("python", test)))
        self.visit_block(node.orelse, scope, (*conditions, Condition("python", test, True)))

    def visit_try(self, node, scope: str, conditions: tuple[Condition, ...]) -> None:
        """try: with an except that covers ImportError, what stands in it may be missing, as may the other branch."""
        guarded = not list_caught_exceptions(node.handlers).isdisjoint(IMPORT_ERRORS)
        self.visit_block(node.body, scope, (*conditions, TRY) if guarded else conditions)
        for handler in node.handlers:
            self.visit_block(handler.body, scope, (*conditions, EXCEPT))
        self.visit_block(node.orelse, scope, (*conditions, TRY) if guarded else conditions)
        self.visit_block(node.finalbody, scope, conditions)

    def add_function(self, node, scope: str, conditions: tuple[Condition, ...]) -> None:
        decorators = tuple(_format_dotted(decorator) for decorator in node.decorator_list)
        last = {decorator.rpartition(".")[2] for decorator in decorators}
        if last & {"setter", "deleter", "getter"} and scope:
            return  # of a property that is there already
        kind = "function"
        if scope:
            kind = "method"
            if last & _PROPERTIES:
                kind = "property"
            elif "staticmethod" in last:
                kind = "staticmethod"
            elif "classmethod" in last or node.name in ("__new__", "__init_subclass__", "__class_getitem__"):
                kind = "classmethod"
        if "overload" in last:
            conditions = (*conditions, Condition("python", "overload"))
        given = tuple(make_parameters(node.args))
        if scope and kind != "staticmethod" and given and given[0].kind in ("positional", "normal"):
            given = given[1:]
        name = f"{scope}.{node.name}" if scope else node.name
        returns = unparse_even(node.returns) if node.returns is not None else ""
        self.names.append(
            Bound(
                name, kind, node.lineno, () if kind == "property" else given, returns,
                decorators=tuple(name for name in decorators if name),
                deprecated=_find_deprecation(node.decorator_list) or _find_warning(node.body), conditions=conditions,
            )
        )  # fmt: skip
        if node.name == "__getattr__" and not scope and isinstance(node, ast.FunctionDef):
            self.add_served(node, conditions)
        elif node.name == "__getattr__":
            self.open.append((scope, "__getattr__"))
        elif scope and node.name == "__getattribute__":
            self.open.append((scope, "__getattribute__"))
        self.visit_function_body(node, scope if kind != "staticmethod" else "", conditions)

    def add_served(self, node: ast.FunctionDef, conditions: tuple[Condition, ...]) -> None:
        """What a module's `__getattr__` serves."""
        found = read_module_getattr(node, self.body)
        if found.served is None:
            self.open.append(("", "__getattr__"))
        for name in sorted(found.served or found.warned):
            warning = "deprecated" if name in found.warned else ""
            self.names.append(Bound(name, "attribute", node.lineno, deprecated=warning, conditions=conditions))

    def add_members_served(self, place: int, conditions: tuple[Condition, ...]) -> None:
        """What a class that a decorator makes the module's `__getattr__` of serves: its members. place: where it stands
        among the names."""
        head = "__getattr__."
        if any(scope == "__getattr__" for scope, _ in self.open):
            self.open.append(("", "__getattr__"))
        for bound in self.names[place:]:
            if bound.name.startswith(head) and bound.name.count(".") == 1:
                served = msgspec.structs.replace(bound, name=bound.name[len(head) :], kind="attribute", parameters=())
                self.names.append(msgspec.structs.replace(served, conditions=conditions))

    def visit_function_body(self, node, scope: str, conditions: tuple[Condition, ...]) -> None:
        """What a function binds outside of itself: attributes of `self`, names that it declares global."""
        first = [*node.args.posonlyargs, *node.args.args][:1]
        me = first[0].arg if first and scope else ""
        outside: set[str] = set()
        known = {bound.name for bound in self.names if bound.kind == "instance"} if me else set()
        stack: list[ast.AST] = list(reversed(node.body))
        while stack:
            at = stack.pop()
            late = (*conditions, LATE)
            self.names += (Bound(name, "attribute", getattr(at, "lineno", node.lineno), conditions=late)
                           for name in _iterate_bound(at) if name in outside)  # fmt: skip
            if isinstance(at, ast.Global):
                outside.update(at.names)
            elif isinstance(at, (ast.Assign, ast.AnnAssign, ast.AugAssign)):
                annotation = unparse_even(at.annotation) if isinstance(at, ast.AnnAssign) else ""
                of_module = isinstance(at.value, ast.Subscript) and _format_dotted(at.value.value) == "sys.modules"
                for target in _flatten_targets(at.targets if isinstance(at, ast.Assign) else [at.target]):
                    if isinstance(target, ast.Attribute) and me and _format_dotted(target.value) == me:
                        name = f"{scope}.{target.attr}"
                        if name not in known:
                            known.add(name)
                            self.names.append(Bound(name, "instance", at.lineno, (), annotation, conditions=conditions))
                    elif isinstance(target, ast.Subscript):
                        self.bind_subscript(target, "")
                    elif isinstance(target, ast.Name) and of_module:
                        self.modules.add(target.id)
                    elif isinstance(target, ast.Name) and target.id in outside:
                        self.names.append(Bound(target.id, "attribute", at.lineno, conditions=late))
            elif isinstance(at, ast.Call):
                self.visit_late_call(at, scope, me)
            if isinstance(at, (ast.expr, ast.ClassDef)) and not isinstance(at, ast.Call):
                continue
            stack.extend(child for child in ast.iter_child_nodes(at) if isinstance(child, _INSIDE))

    def add_class(self, node: ast.ClassDef, scope: str, conditions: tuple[Condition, ...]) -> None:
        name = f"{scope}.{node.name}" if scope else node.name
        decorators = tuple(_format_dotted(decorator) for decorator in node.decorator_list)
        metaclass = [_format_dotted(keyword.value) for keyword in node.keywords if keyword.arg == "metaclass"]
        place = len(self.names)
        bases = tuple(unparse_even(base) for base in node.bases)
        self.names.append(
            Bound(
                name, "class", node.lineno, bases=bases, decorators=tuple(d for d in decorators if d),
                deprecated=_find_deprecation(node.decorator_list), conditions=conditions,
            )
        )  # fmt: skip
        for meta in metaclass:
            if meta.rpartition(".")[2] not in ("ABCMeta", "EnumMeta", "type"):
                self.open.append((name, f"metaclass {meta}"))
        self.visit_block(node.body, name, ())
        if name == "__getattr__":
            self.add_members_served(place, conditions)
        made = [bound.deprecated for bound in self.names[place:] if bound.name == f"{name}.__init__"]
        if any(made) and not self.names[place].deprecated:
            deprecated = next(filter(None, made))
            self.names[place] = msgspec.structs.replace(self.names[place], deprecated=deprecated)

    def bind_target(
        self, target: ast.expr, value: ast.expr | None, annotation: str, scope: str, conditions: tuple[Condition, ...]
    ) -> None:
        if isinstance(target, ast.Name):
            if target.id == "__all__" and not scope:
                self.all = []
                self.add_exports(value)
                return
            name = f"{scope}.{target.id}" if scope else target.id
            text = _format_literal(value)
            if isinstance(value, ast.Subscript) and _format_dotted(value.value) == "sys.modules":
                self.modules.add(target.id)
            if target.id == "__getattr__":
                self.open.append((scope, "__getattr__"))
            self.names.append(Bound(name, "attribute", target.lineno, (), annotation, text, conditions=conditions))
            if value is not None:
                self.visit_call_statement(value, scope)
        elif isinstance(target, (ast.Tuple, ast.List)):
            parts: list[ast.expr | None] = [None] * len(target.elts)
            if isinstance(value, (ast.Tuple, ast.List)) and len(value.elts) == len(target.elts):
                parts = list(value.elts)
            for element, part in zip(target.elts, parts, strict=True):
                self.bind_target(element, part, "", scope, conditions)
        elif isinstance(target, ast.Starred):
            self.bind_target(target.value, None, "", scope, conditions)
        elif isinstance(target, ast.Subscript):
            self.bind_subscript(target, scope)
        elif isinstance(target, ast.Attribute) and isinstance(target.value, ast.Name) and not scope:
            # `Class.name = value` beside the class
            name = f"{target.value.id}.{target.attr}"
            if self.is_class(target.value.id):
                self.names.append(Bound(name, "attribute", target.lineno, (), "", _format_literal(value),
                                        conditions=conditions))  # fmt: skip

    def bind_subscript(self, target: ast.Subscript, scope: str) -> None:
        """`globals()[name] = ...` and `sys.modules[name] = ...`."""
        holder = target.value
        if isinstance(holder, ast.Call) and _format_dotted(holder.func) in _NAMESPACES:
            if isinstance(target.slice, ast.Constant) and isinstance(target.slice.value, str):
                name = f"{scope}.{target.slice.value}" if scope else target.slice.value
                self.names.append(Bound(name, "attribute", target.lineno))
            else:
                self.open.append((scope, f"{_format_dotted(holder.func)}()[...]"))
        elif _format_dotted(holder) == "sys.modules":
            self.open.append((scope, "sys.modules[...]"))

    def remove_deleted(self, node: ast.Delete, scope: str) -> None:
        for target in _flatten_targets(node.targets):
            if isinstance(target, ast.Name):
                name = f"{scope}.{target.id}" if scope else target.id
                self.names = [b for b in self.names if b.name != name and not b.name.startswith(f"{name}.")]
                self.imports = [t for t in self.imports if (t.name, t.scope) != (target.id, scope)]

    # __all__, and what puts names where no reader sees them

    def extend_exports(self, node: ast.AugAssign, scope: str) -> None:
        if isinstance(node.target, ast.Name) and node.target.id == "__all__" and not scope:
            self.all = self.all if self.all is not None else []
            self.add_exports(node.value)

    def add_exports(self, value: ast.expr | None) -> None:
        assert self.all is not None
        if isinstance(value, (ast.List, ast.Tuple, ast.Set)):
            for element in value.elts:
                if isinstance(element, ast.Constant) and isinstance(element.value, str):
                    self.all.append(element.value)
                elif isinstance(element, ast.Starred):
                    self.add_exports(element.value)
                else:
                    self.all_open = True
        elif isinstance(value, ast.BinOp) and isinstance(value.op, ast.Add):
            self.add_exports(value.left)
            self.add_exports(value.right)
        elif isinstance(value, ast.Attribute) and value.attr == "__all__":
            self.all.append(f"+{_format_dotted(value.value)}")
        elif not (isinstance(value, ast.Name) and value.id == "__all__"):
            self.all_open = True

    def visit_call_statement(self, node: ast.expr, scope: str) -> None:
        """A statement that is a call: of __all__.extend() and kin, or one that may bind names."""
        if not isinstance(node, ast.Call):
            return
        name = _format_dotted(node.func)
        if name in ("__all__.extend", "__all__.append", "__all__.remove") and not scope and len(node.args) == 1:
            self.all = self.all if self.all is not None else []
            argument = node.args[0]
            if name.endswith("extend"):
                self.add_exports(argument)
            elif isinstance(argument, ast.Constant) and isinstance(argument.value, str):
                if name.endswith("append"):
                    self.all.append(argument.value)
                elif argument.value in self.all:
                    self.all.remove(argument.value)
            else:
                self.all_open = True
            return
        self.call(node, scope)

    def call(self, node: ast.Call, scope: str) -> None:
        """A call that runs on import and may bind names by other means."""
        name = _format_dotted(node.func)
        owner = node.args[0] if node.args else None
        if name in ("exec", "execfile"):
            self.open.append((scope, f"{name}()"))
        elif name == "setattr" and isinstance(owner, ast.Name):
            self.open.append((owner.id if self.is_class(owner.id) else "", "setattr()"))
        elif name == "setattr":
            self.open.append((scope, "setattr()"))
        elif isinstance(node.func, ast.Attribute) and node.func.attr == "update":
            maker = _format_dotted(node.func.value) if isinstance(node.func.value, ast.Call) else ""
            if maker in _NAMESPACES:
                self.open.append((scope, f"{maker}().update()"))

    def is_class(self, name: str) -> bool:
        """Whether the module has bound a class of this name so far."""
        return any(bound.name == name and bound.kind == "class" for bound in self.names)

    def visit_late_call(self, node: ast.Call, scope: str, me: str) -> None:
        """The same in a function, where only the object itself and the module can be given names."""
        name = _format_dotted(node.func)
        if not isinstance(node.func, ast.Attribute):
            owner = node.args[0] if name == "setattr" and node.args else None
            if isinstance(owner, ast.Name) and owner.id == me:
                self.open.append((scope, "setattr()"))
            elif isinstance(owner, ast.Name) and self.is_class(owner.id):
                self.open.append((owner.id, "setattr()"))
            elif owner is not None and ("sys.modules" in unparse_even(owner) or unparse_even(owner) in self.modules):
                self.open.append(("", "setattr()"))
        elif me and name == f"{me}.__dict__.update":
            self.open.append((scope, "__dict__.update()"))
        elif node.func.attr == "update" and unparse_even(node.func.value) == "globals()":
            self.open.append(("", "globals().update()"))


_INSIDE = (ast.stmt, ast.ExceptHandler, ast.Call, ast.withitem, ast.match_case)


def _iterate_bound(node: ast.AST) -> Iterator[str]:
    """The names that a statement binds otherwise than by an assignment."""
    targets: list[ast.expr] = []
    if isinstance(node, (ast.Import, ast.ImportFrom)):
        yield from (alias.asname or alias.name.partition(".")[0] for alias in node.names)
    elif isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
        yield node.name
    elif isinstance(node, (ast.For, ast.AsyncFor)):
        targets = [node.target]
    elif isinstance(node, ast.withitem) and node.optional_vars is not None:
        targets = [node.optional_vars]
    yield from (target.id for target in _flatten_targets(targets) if isinstance(target, ast.Name))


def _flatten_targets(targets: Iterable[ast.expr]) -> Iterator[ast.expr]:
    for target in targets:
        if isinstance(target, (ast.Tuple, ast.List)):
            yield from _flatten_targets(target.elts)
        elif isinstance(target, ast.Starred):
            yield target.value
        else:
            yield target


def _format_dotted(node: ast.AST) -> str:
    """A path of names, calls left out (`deprecated('x')` is `deprecated`); empty for anything else."""
    while isinstance(node, ast.Call):
        node = node.func
    path = format_dotted(node) if isinstance(node, ast.expr) else ""
    return "" if path.startswith(".") else path


def _format_literal(node: ast.expr | None) -> str:
    """The source of a literal, empty for what is none or is long."""
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub) and isinstance(node.operand, ast.Constant):
        return unparse_even(node)
    if isinstance(node, ast.Constant):
        if isinstance(node.value, (str, bytes)) and len(node.value) > LONGEST:
            return ""
        text = unparse_even(node)
        return text if len(text) <= LONGEST else ""
    return ""


def _find_deprecation(decorators: Iterable[ast.expr]) -> str:
    """The message of a decorator called `deprecated` (PEP 702's and the many that came before it)."""
    for decorator in decorators:
        if _format_dotted(decorator).rpartition(".")[2].lower() in ("deprecated", "deprecate"):
            return _find_message(decorator.args if isinstance(decorator, ast.Call) else ())
    return ""


def _find_message(arguments: Iterable[ast.expr]) -> str:
    for argument in arguments:
        text = "".join(
            part.value for part in ast.walk(argument) if isinstance(part, ast.Constant) and isinstance(part.value, str)
        )
        text = " ".join(text.encode("utf-8", "replace").decode().split())
        if text:
            return text[:200]
        break
    return "deprecated"


def _find_warning(body: list[ast.stmt]) -> str:
    """The message of a warning that a body gives at its beginning, whatever it is called with."""
    seen = 0
    for node in body:
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            continue
        if isinstance(node, (ast.Import, ast.ImportFrom)):
            continue
        seen += 1
        if seen > _BEGIN:
            break
        if not isinstance(node, ast.Expr) or not isinstance(node.value, ast.Call):
            continue
        call = node.value
        if _format_dotted(call.func).rpartition(".")[2] != "warn" or not call.args:
            continue
        given = [*call.args[1:2], *(k.value for k in call.keywords if k.arg == "category")]
        if any(_format_dotted(one).rpartition(".")[2] in _WARNINGS for one in given):
            return _find_message(call.args[:1])
    return ""
