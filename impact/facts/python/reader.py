"""What a Python syntax tree says: imports, names used through them, mentions of packages, the Python it needs."""

import ast
import re
import sys
from collections import Counter
from collections.abc import Iterator

import msgspec

from ....edges.dispatch import collect_node_methods
from ..condition import UNDECIDED, Condition
from ..place import Problem, Reference
from .bound import ALWAYS, DYNAMIC, PYTHON2_BUILTINS, PYTHON2_METHODS, list_bound_names
from .constants import MORE
from .text import (
    CHILD_FIELDS,
    SourceText,
    format_dotted,
    gives_up,
    iterate_children,
    list_caught_exceptions,
    list_imported,
    list_parameters,
    walk_nodes,
)
from .uses import CALLBACK_CALLS, ELEMENT, OWN, SURE_TO_RUN, ObjectUses, make_field_type
from .values import JOINS, PACKAGE_CALLS, PACKAGE_NAME, WRAPPERS, PackagePath, PythonScope


class Import(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """`import module` or `from module import names`. level counts leading dots. lazy: inside a function. called: what
    the names are called here, empty where that is how they are called there. started: only where the file itself is
    started (`if __name__ == "__main__"`)."""

    module: str
    names: tuple[str, ...]
    level: int
    line: int
    column: int
    lazy: bool = False
    conditions: tuple[Condition, ...] = ()
    called: tuple[str, ...] = ()
    started: bool = False


class AttributeUse(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """The first use of a dotted name whose head is an imported module or name, import aliases resolved
    (`import time as t; t.clock()` gives `time.clock`), per distinct set of conditions. The conditions are those of the
    import and those of the use that tell about the interpreter or the machine, not every `if`. A `try` whose except
    covers AttributeError counts. lazy: only functions that may not run use it."""

    text: str
    line: int
    column: int
    conditions: tuple[Condition, ...] = ()
    lazy: bool = False


TRY = Condition("python", "try")
EXCEPT = Condition("python", "try", True)
# The same of an except that catches anything; told apart by identity, as no name is expected to be missing there.
_EXCEPT_ANY = Condition("python", "try", True)
# An except that catches these makes the import, or the use of a name, optional.
IMPORT_ERRORS = frozenset(("ImportError", "ModuleNotFoundError", "Exception", "BaseException"))
_NAME_ERRORS = frozenset(("AttributeError", "NameError", "Exception", "BaseException"))
_ANY_ERRORS = frozenset(("Exception", "BaseException"))
# A test that mentions one of these tells about the interpreter or the machine rather than about the run.
_ABOUT_MACHINE = re.compile(
    r"version|PY[23]|PYTHON|TYPE_CHECKING|platform|os\.name|environ|getenv|ROS_|distro|hasattr|__slots__|field_types|"
    r"find_spec|find_loader",
    re.IGNORECASE,
)
# What tells whether an object, or a message, has a field.
_ABOUT_FIELDS = re.compile(r"\bhasattr\b|__slots__|field_types\b")
_ROS_VARIABLE = re.compile(r"(?:environ|getenv)\b.*\bROS_(?:DISTRO|VERSION|PYTHON_VERSION)\b", re.DOTALL)
_READING = frozenset((ast.Call, ast.Subscript))
_COMMAND_CALLS = frozenset((
    "system", "popen", "Popen", "call", "check_call", "check_output", "run", "getoutput", "ExecuteProcess",
    "ExecuteLocal", "Command",
))  # fmt: skip
# Where the functions among these are from.
_STARTING = frozenset(("os", "subprocess", "commands"))
_PROGRAM = re.compile(r"[A-Za-z_][\w.+-]*")
_IN_STRING = re.compile(
    r"package://(?P<url>[A-Za-z]\w*)(?P<url_path>/[^\s'\"<>$%{}]*)?"
    r"|\$\((?:find|find-pkg-share|find-pkg-prefix)\s+(?P<find>[A-Za-z][\w-]*)\)(?P<find_path>/[^\s'\"<>$%{}()]+)?"
)
# What statements and expressions need that are read like any other: the minor version of Python 3, and what it is.
_NEEDED = {
    "TemplateStr": (14, "t-string"), "TypeAlias": (12, "type alias statement"), "Nonlocal": (0, "nonlocal"),
    "YieldFrom": (3, "yield from"),
}  # fmt: skip
# What can be subscripted since Python 3.9, and joined to other types by `|` since 3.10 (PEP 585, PEP 604).
_GENERIC = frozenset(("dict", "frozenset", "list", "set", "tuple", "type"))
_TYPES = _GENERIC | {"bool", "bytes", "complex", "float", "int", "object", "str"}
# Private members, and by what members may be set that no assignment shows.
_PRIVATE = re.compile(r"__\w+")
_SETS_MEMBERS = re.compile(r"__getattr|setattr\(|__dict__|\bvars\(")
_QUOTE = re.compile(r"[A-Za-z]*(\"\"\"|'''|\"|')")
_TARGETS_OF_WITH = re.compile(r"with\s*\(\s*\Z")


class PythonReader(ObjectUses, SourceText):
    """One walk over a syntax tree, in the order of the source."""

    def __init__(self, text: str, original: str) -> None:
        ObjectUses.__init__(self, text)
        SourceText.__init__(self, text)
        # The two differ where Python 2 syntax was rewritten; lines are the same, indentation may not be.
        self.original = original.split("\n") if original != text else []
        self.has_paths = "package://" in text or "$(find" in text
        self.has_variables = "ROS_" in text
        self.handlers = _HANDLERS if self.has_paths else _WITHOUT_STRINGS
        self.imports: list[Import] = []
        # Line, offset, and whether only functions that may not run have it.
        self.uses: dict[tuple[PythonScope, str, tuple[Condition, ...]], tuple[int, int, bool]] = {}
        self.main_lines = range(0)
        self.assigned: set[tuple[PythonScope, str]] = set()
        self.imported_names: list[AttributeUse] = []
        self.references: dict[Reference, None] = {}
        # What the include around gives.
        self.included: tuple[str, ...] | None = None
        # Functions that look up the package named by one of their own parameters, and all calls by a plain name.
        self.lookups: dict[tuple[PythonScope, str], tuple[int, str]] = {}
        self.calls: list[tuple[PythonScope, str, ast.Call, bool]] = []
        self.defining: tuple[PythonScope, str] | None = None
        self.needs: tuple[int, int, str] | None = None
        self.python2_only: list[Problem] = []
        self.function = False
        self.conditions: tuple[Condition, ...] = ()
        self.consumed: set[int] = set()
        # Whether annotations are not evaluated, whether one is read, and the heads of names used elsewhere.
        self.postponed = self.annotating = False
        self.asked: set[str] = set()
        # Members of what names hold of which nothing shows the type.
        self.untyped: list[tuple[PythonScope, str, ast.Attribute]] = []
        # Names that the module imports as modules, where they are called or subscripted, and private members of `self`
        # that are read.
        self.modules: frozenset[str] = frozenset()
        self.values: list[tuple[PythonScope, AttributeUse]] = []
        self.private: list[AttributeUse] = []

    def read(self, tree: ast.Module) -> None:
        future = (node for node in tree.body if isinstance(node, ast.ImportFrom) and node.module == "__future__")
        self.postponed = any(alias.name == "annotations" for node in future for alias in node.names)
        self.module_names = list_bound_names(tree.body)
        imports = (node for node in tree.body if node.__class__ is ast.Import)
        aliases = (alias for node in imports for alias in node.names if "." not in alias.name)  # type: ignore[attr-defined]
        self.modules = frozenset(alias.asname or alias.name for alias in aliases)
        self.walk_all(tree.body)
        self.add_lookup_calls()

    def walk_all(self, nodes) -> None:
        handlers = self.handlers
        for node in nodes:
            handler = handlers.get(node.__class__)
            if handler is not None:
                handler(self, node)

    def visit(self, node) -> None:
        self.walk_all((node,))

    def walk_children(self, node) -> None:
        """Visits the children of a node."""
        self.walk_all(iterate_children(node))

    def find_column(self, line: int, offset: int) -> int:
        """The same, in the text as it was before Python 2 was rewritten."""
        if line > len(self.lines):
            return offset + 1
        column = super().find_column(line, offset)
        return max(1, column - len(self.lines[line - 1]) + len(self.original[line - 1])) if self.original else column

    def need(self, minor: int, reason: str, node) -> None:
        if self.needs is None or minor > self.needs[0]:
            self.needs = (minor, node.lineno, reason)

    def visit_Name(self, node: ast.Name) -> None:
        name = node.id
        if node.ctx.__class__ is not ast.Load:
            self.scope.bound.add(name)
            if node.ctx.__class__ is ast.Store:
                self.scope.objects[name] = ""
        elif name not in self.scope.bound and name not in self.module_names and name not in _SURE:
            self.note_use(name, node.lineno, node.col_offset)

    def note_use(self, text: str, line: int, offset: int) -> None:
        """Notes where a name, dotted or not, is used first; that of a method begins with the dot."""
        head = text.partition(".")[0]
        if not self.annotating:
            self.asked.add(head)
        if head in DYNAMIC and not self.scope.knows(head):
            self.watches_names = False
        key = (self.scope, text, self.use_conditions)
        known = self.uses.get(key)
        if known is None:
            self.uses[key] = (line, offset, self.may_not_run)
        elif known[2] and not self.may_not_run:
            self.uses[key] = (*known[:2], False)

    def visit_Attribute(self, node: ast.Attribute, call: ast.Call | None = None) -> None:
        if call is not None and node.attr in PYTHON2_METHODS:
            of_module = node.value.__class__ is ast.Name and self.find_imported(node.value.id)  # type: ignore[attr-defined]
            if not of_module:  # six.iteritems is no method
                self.note_use(f".{node.attr}", node.end_lineno or 0, (node.end_col_offset or 0) - len(node.attr))
        steps = [node]
        value = node.value
        while value.__class__ is ast.Attribute:
            steps.append(value)  # type: ignore[arg-type]
            value = value.value  # type: ignore[attr-defined]
        steps.reverse()
        if value.__class__ is not ast.Name:
            if value.__class__ is ast.Call and getattr(value.func, "id", "") == "super":  # type: ignore[attr-defined]
                self.use_of_super(steps[0].attr, call if len(steps) == 1 else None, node)
            elif type_ := self.find_type(value):
                self.use_member(type_, steps, call)
            else:
                self.note_unknown(steps[0])
            self.visit(value)
            return
        head = value.id  # type: ignore[attr-defined]
        parts = [step.attr for step in steps]
        own = head == self.me and self.inside_class is not None
        if own and parts[0][:2] == "__" and parts[0][-2:] != "__" and steps[0].ctx.__class__ is ast.Load:
            self.private.append(self.make_use(parts[0], steps[0]))
        if type_ := f"{OWN}{id(self.inside_class)}" if own else self.find_object_type(head):
            self.use_member(type_, steps, call)
        elif self.has_interfaces:
            self.use_constant(steps, call)
        if not type_ and head not in self.classes and not self.find_imported(head):
            self.untyped.append((self.scope, head, steps[0]))
        if own and len(steps) == 1 and node.ctx.__class__ is ast.Store:
            self.hold_own(node, None)
        if head == "self" or head == "cls":
            return
        if node.ctx.__class__ is ast.Store:
            self.assigned.add((self.scope, f"{head}.{'.'.join(parts)}"))
        self.note_use(f"{head}.{'.'.join(parts)}", value.lineno, value.col_offset)

    def make_use(self, text: str, node: ast.expr) -> AttributeUse:
        column = self.find_column(node.lineno, node.col_offset)
        return AttributeUse(text, node.lineno, column, self.use_conditions, self.may_not_run)

    def visit_value(self, node: ast.expr) -> None:
        """What is called or subscripted."""
        if node.__class__ is ast.Name and node.id in self.modules and not self.annotating:  # type: ignore[attr-defined]
            self.values.append((self.scope, self.make_use(node.id, node)))  # type: ignore[attr-defined]
        self.visit(node)

    def visit_Subscript(self, node: ast.Subscript) -> None:
        self.visit_value(node.value)
        self.visit(node.slice)

    def list_attributes(self) -> tuple[AttributeUse, ...]:
        """Names of other modules that the file uses. What it assigns itself (`sys.maxint = sys.maxsize`) is there."""
        assigned = ((scope, *text.partition(".")) for scope, text in self.assigned)
        own = {f"{dotted}.{rest}" for scope, head, _, rest in assigned for dotted, _ in self.find_imported(head, scope)}
        found: dict[tuple[str, tuple[Condition, ...]], tuple[int, int, bool]] = {}
        for attribute in self.imported_names:
            found.setdefault((attribute.text, attribute.conditions), (attribute.line, attribute.column, attribute.lazy))
        for (scope, text, conditions), (line, offset, lazy) in self.uses.items():
            head, _, rest = text.partition(".")
            if not rest:
                continue
            for dotted, extra in self.find_imported(head, scope):
                if dotted.startswith(".") or f"{dotted}.{rest}" in own:
                    continue
                both = conditions if not extra else (*extra, *(c for c in conditions if c not in extra))
                key = (f"{dotted}.{rest}", both)
                place = (line, self.find_column(line, offset))
                known = found.get(key, (*place, lazy))
                found[key] = (*min(place, known[:2]), lazy and known[2])
        return tuple(
            AttributeUse(text, line, column, conditions, lazy)
            for (text, conditions), (line, column, lazy) in sorted(found.items(), key=lambda item: item[1][:2])
        )

    def find_bound_names(self) -> set[str] | None:
        """Names that the module binds, for those who import it; None where that cannot be known."""
        bound = self.module_names
        bound |= {name for scope, name in self.declared_global if name in scope.bound or scope.imports.get(name)}
        certain = self.watches_names and DYNAMIC.isdisjoint(bound)
        for scope, head, member in self.untyped:
            if not certain or head in bound or head in ALWAYS or scope.knows(head):
                self.note_unknown(member)
        return bound if certain and not self.starred else None

    def list_misused(self) -> Iterator[AttributeUse]:
        """Modules that are called or subscripted, with `()` behind the name, and private members of `self` that nothing
        in the file sets, with `self.` before it. What is called so elsewhere in the text may be set there."""
        rebound = {name for _, name in self.declared_global}
        for scope, use in self.values if not self.starred else ():
            holder = next((one for one in scope.chain if use.text in one.imports or use.text in one.bound), None)
            if holder is not None and use.text not in holder.bound and use.text not in rebound:
                known = holder.imports[use.text]
                if len(known) == 1 and not known[0][1] and "." not in known[0][0]:
                    yield msgspec.structs.replace(use, text=f"{use.text}()")
        text = "\n".join(self.lines) if self.private else ""
        if not self.private or _SETS_MEMBERS.search(text):
            return
        read, written = Counter(use.text for use in self.private), Counter(_PRIVATE.findall(text))
        for use in self.private:
            if written[use.text] == read[use.text]:
                yield msgspec.structs.replace(use, text=f"self.{use.text}")

    def list_unbound_names(self, bound: set[str] | None) -> tuple[AttributeUse, ...]:
        """The first use of each name that nothing binds, a sure one where there is any; calls of methods that only
        Python 2 has and the file does not define, each with its dot; and what is misused."""
        found: dict[str, AttributeUse] = {}

        def keep(use: AttributeUse) -> None:
            known = found.get(use.text, use)
            found[use.text] = min(known, use, key=lambda one: (bool(one.conditions), one.lazy, one.line, one.column))

        is_program = bool(self.lines) and self.lines[0].startswith("#!")
        unstarted = range(0) if is_program else self.main_lines
        for (scope, text, conditions), (line, offset, lazy) in self.uses.items():
            lazy = lazy or line in unstarted
            head = text.partition(".")[0]
            if head and (bound is None or head in bound or head in ALWAYS or head not in self.asked):
                continue
            if scope.knows(head):
                continue
            if head not in PYTHON2_BUILTINS:
                conditions = tuple(one for one in conditions if one is not _EXCEPT_ANY)
            name = head or text
            if not head and any(f"def {text[1:]}" in one for one in self.lines):
                continue
            keep(AttributeUse(name, line, self.find_column(line, offset), conditions, lazy))
        for use in self.list_misused():
            keep(use)
        return tuple(sorted(found.values(), key=lambda one: (one.line, one.column)))

    def bind_imported(self, node: ast.Import | ast.ImportFrom) -> None:
        for name, dotted in list_imported(node):
            if name == "*":
                self.starred.append(dotted)
                continue
            known = self.scope.imports.setdefault(name, [])
            if (dotted, self.use_conditions) not in known:
                known.append((dotted, self.use_conditions))

    def visit_Import(self, node: ast.Import) -> None:
        for alias in node.names:
            column = self.find_column(alias.lineno, alias.col_offset)
            module = sys.intern(alias.name)
            started = alias.lineno in self.main_lines
            self.imports.append(
                Import(module, (), 0, alias.lineno, column, self.function, self.conditions, started=started)
            )
        self.bind_imported(node)

    def visit_ImportFrom(self, node: ast.ImportFrom) -> None:
        module = sys.intern(node.module or "")
        column = self.find_column(node.lineno, node.col_offset)
        names = tuple(sys.intern(alias.name) for alias in node.names)
        called = tuple(sys.intern(alias.asname or alias.name) for alias in node.names)
        self.imports.append(Import(module, names, node.level, node.lineno, column, self.function, self.conditions,
                                   () if called == names else called, node.lineno in self.main_lines))  # fmt: skip
        for alias in node.names:
            if alias.name != "*" and not node.level:
                column = self.find_column(alias.lineno, alias.col_offset)
                self.imported_names.append(
                    AttributeUse(f"{module}.{alias.name}", alias.lineno, column, self.use_conditions, self.may_not_run)
                )
        self.bind_imported(node)

    def walk_under(self, nodes, condition: Condition | None, use: Condition | None) -> None:
        """Visits statements with one more condition for imports and one for uses."""
        before = self.conditions, self.use_conditions, self.conditional, self.undecided
        if condition is not None:
            self.conditions = (*self.conditions, condition)
        if use is not None:
            self.use_conditions = (*self.use_conditions, use)
        else:
            self.undecided = True
        self.conditional = True
        self.walk_branch(nodes)
        self.conditions, self.use_conditions, self.conditional, self.undecided = before

    def walk_branch(self, nodes) -> None:
        """Visits statements, what these bind is noted in `ways` and holds no longer."""
        scope = self.scope
        before = scope.objects
        scope.objects = dict(before)
        self.walk_all(nodes)
        self.ways.append(scope.objects)
        scope.objects = before

    def visit_For(self, node) -> None:
        """A `for` or `while`, in which nothing is known that it binds itself."""
        first = len(self.ways)
        self.forget_rebound(node)
        if node.__class__ is ast.While:
            self.visit(node.test)
        else:
            self.visit(node.iter)
            self.bind_element(node.target, node.iter)
        self.walk_branch(node.body)
        self.walk_branch(node.orelse)
        self.merge(first)

    visit_AsyncFor = visit_While = visit_For

    def bind_element(self, target, over) -> None:
        """The variable of a loop, which holds an element of what is walked through."""
        self.visit(target)
        if self.has_interfaces and target.__class__ is ast.Name and (type_ := self.find_type(over)):
            self.scope.objects[target.id] = make_field_type(type_, ELEMENT)

    def visit_ListComp(self, node) -> None:
        outer = self.scope
        inner = PythonScope(outer, False)
        inner.parameters, inner.binder = outer.parameters, outer.binder
        for generator in node.generators:
            self.visit(generator.iter)
            self.scope = inner
            self.bind_element(generator.target, generator.iter)
            self.walk_all(generator.ifs)
        self.walk_all([node.key, node.value] if node.__class__ is ast.DictComp else [node.elt])
        self.scope = outer

    visit_SetComp = visit_GeneratorExp = visit_DictComp = visit_ListComp

    def visit_If(self, node: ast.If) -> None:
        test = self.format_test(node.test)
        self.visit(node.test)
        if "__main__" in test and "__name__" in test:
            self.main_lines = range(node.body[0].lineno, (node.body[-1].end_lineno or 0) + 1)
            self.walk_all(node.body)
            self.walk_all(node.orelse)
            return
        negated = False
        plain = node.test
        if isinstance(plain, ast.UnaryOp) and isinstance(plain.op, ast.Not):
            plain, negated = plain.operand, True
            test = self.format_test(plain)
        if test.endswith(".TYPE_CHECKING"):
            test = "TYPE_CHECKING"
        about_machine = _ABOUT_MACHINE.search(test) is not None
        first = len(self.ways)
        for branch, denied in ((node.body, negated), (node.orelse, not negated)):
            condition = Condition("python", test, denied)
            self.walk_under(branch, condition, condition if about_machine else None)
        self.merge(first)

    def format_test(self, node: ast.expr) -> str:
        """The source of a test, names that stand for a variable of the environment replaced by what reads it."""
        test = self.format_source(node)
        known = any(scope.machine for scope in self.scope.chain)
        for name in {part.id for part in walk_nodes(node) if isinstance(part, ast.Name)} if known else ():
            holder = next((scope for scope in self.scope.chain if name in scope.bound), None)
            if holder is not None and name in holder.machine:
                test = re.sub(rf"(?<![\w.'\"]){name}(?![\w'\"])", lambda _, text=holder.machine[name]: text, test)
        return test

    def visit_IfExp(self, node: ast.IfExp) -> None:
        self.visit(node.test)
        test = self.format_test(node.test)
        before = self.use_conditions, self.conditional, self.undecided
        self.conditional = True
        about_machine = _ABOUT_MACHINE.search(test) is not None
        self.undecided = self.undecided or not about_machine
        for branch, denied in ((node.body, False), (node.orelse, True)):
            if about_machine:
                self.use_conditions = (*before[0], Condition("python", test, denied))
            self.visit(branch)
        self.use_conditions, self.conditional, self.undecided = before

    def visit_Try(self, node) -> None:
        caught = list_caught_exceptions(node.handlers)
        covers_import = not caught.isdisjoint(IMPORT_ERRORS)
        covers_use = covers_import or not caught.isdisjoint(_NAME_ERRORS)
        # Whoever gives up where something is missing needs it.
        survived = list_caught_exceptions(handler for handler in node.handlers if not gives_up(handler.body))
        in_try = None if survived.isdisjoint(IMPORT_ERRORS) else TRY
        used_in_try = in_try if survived.isdisjoint(_NAME_ERRORS) else TRY
        # An except for TypeError expects that a call is refused, and nothing else of what is looked for here.
        outside = self.call_conditions
        refusal = "TypeError" in caught and not covers_use
        self.call_conditions = (*outside, TRY) if refusal else outside
        first, before = len(self.ways), self.scope.objects
        self.walk_under(node.body, in_try, used_in_try)
        done = self.ways[-1]
        # Handlers run after any part of the body.
        self.scope.objects = {name: type_ if done.get(name) == type_ else "" for name, type_ in before.items()}
        self.call_conditions = (*outside, EXCEPT) if refusal else outside
        instead = _EXCEPT_ANY if caught.isdisjoint((IMPORT_ERRORS | _NAME_ERRORS) - _ANY_ERRORS) else EXCEPT
        for handler in node.handlers:
            if handler.type is not None:
                self.visit(handler.type)
            if handler.name:
                self.scope.bound.add(handler.name)
                self.scope.objects[handler.name] = ""
            self.walk_under(handler.body, EXCEPT if covers_import else None, instead if covers_use else None)
        self.call_conditions = outside
        self.scope.objects = done
        self.walk_under(node.orelse, in_try, used_in_try)
        self.ways[first] = self.ways.pop()
        self.merge(first)
        self.walk_all(node.finalbody)

    def visit_TryStar(self, node) -> None:
        self.need(11, "`except*`", node)
        self.visit_Try(node)

    def visit_With(self, node) -> None:
        suppressed = False
        for item in node.items:
            call = item.context_expr
            if isinstance(call, ast.Call) and format_dotted(call.func).rpartition(".")[2] == "suppress":
                suppressed |= any(format_dotted(argument).rpartition(".")[2] in IMPORT_ERRORS for argument in call.args)
            self.visit(call)
            if item.optional_vars is not None:
                self.visit(item.optional_vars)
        if self.is_parenthesised(node):
            self.need(9, "parenthesised context managers", node)
        if suppressed:
            self.walk_under(node.body, TRY, TRY)
            self.merge(len(self.ways) - 1, self.scope.objects)
        else:
            self.walk_all(node.body)

    visit_AsyncWith = visit_With

    def is_parenthesised(self, node) -> bool:
        """`with (a as b, c as d):`. The tree does not tell; the text around the items does."""
        first, last = node.items[0], node.items[-1]
        if len(node.items) == 1 and first.optional_vars is None:
            return False
        line = self.get_line_bytes(first.context_expr.lineno)
        before = line[: first.context_expr.col_offset].decode("utf-8", "replace")
        if first.context_expr.lineno > node.lineno:
            before = self.lines[node.lineno - 1] + before
        if not _TARGETS_OF_WITH.search(before):
            return False
        end = last.optional_vars or last.context_expr
        inner = first.context_expr
        after = self.get_line_bytes(end.end_lineno)[end.end_col_offset :].lstrip()[:1]
        after_inner = self.get_line_bytes(inner.end_lineno)[inner.end_col_offset :].lstrip()[:1]
        return after in (b")", b",", b"") and after_inner != b")"

    def get_line_bytes(self, line: int) -> bytes:
        return self.lines[line - 1].encode("utf-8", "replace")

    def visit_FunctionDef(self, node) -> None:
        self.scope.bound.add(node.name)
        self.scope.machine.pop(node.name, None)
        answer = node.body[-1].value if isinstance(node.body[-1], ast.Return) else None
        if answer is not None and _ABOUT_FIELDS.search(self.format_source(answer)):
            self.scope.machine[node.name] = "hasattr"
        self.walk_all(node.decorator_list)
        arguments = node.args
        if arguments.posonlyargs:
            self.need(8, "positional-only parameters", node)
        elif arguments.kwonlyargs:
            self.need(0, "keyword-only parameters", node)
        self.bind_type_parameters(node)
        self.walk_defaults(arguments)
        if node.returns is not None:
            self.need(0, "annotations", node)
            self.walk_annotation(node.returns)
        annotated = self.find_annotated(node.returns)
        before = self.scope, self.function, self.defining, self.lazy, self.me
        outer, self.given = self.given, set()
        self.defining = (self.scope, node.name)
        self.lazy = self.lazy or self.scope.parent is not None or node.name not in SURE_TO_RUN
        if self.scope.is_class:
            self.enter_method(node)
            static = any(getattr(decorator, "id", "") == "staticmethod" for decorator in node.decorator_list)
            first = [argument.arg for argument in (*arguments.posonlyargs, *arguments.args)][:1]
            self.me = "" if static else "".join(first)
        types = [
            (argument.arg, type_)
            for argument in (*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs)
            if argument.annotation is not None and (type_ := self.find_annotated(argument.annotation))
        ]
        self.scope = PythonScope(self.scope, False)
        self.function = True
        self.bind_parameters(arguments)
        self.note_parameters(node)
        self.scope.objects.update(types)
        self.walk_all(node.body)
        self.scope, self.function, self.defining, self.lazy, self.me = before
        self.note_result(node, annotated)
        self.given = outer

    def bind_type_parameters(self, node) -> None:
        parameters = getattr(node, "type_params", ())
        if parameters:
            self.need(12, "type parameters", node)
            self.walk_all(parameters)

    def visit_Return(self, node: ast.Return) -> None:
        if node.value is not None:
            self.visit(node.value)
            if self.given is not None and getattr(node.value, "value", "") is not None:
                self.given.add(self.find_type(node.value))

    def visit_Yield(self, node) -> None:
        self.given = None
        self.walk_children(node)

    def visit_AsyncFunctionDef(self, node) -> None:
        self.need(5, "async functions", node)
        self.visit_FunctionDef(node)

    def walk_defaults(self, arguments: ast.arguments) -> None:
        self.walk_all(filter(None, (*arguments.defaults, *arguments.kw_defaults)))
        for _, argument, _ in list_parameters(arguments):
            if argument.annotation is not None:
                self.need(0, "annotations", argument)
                self.walk_annotation(argument.annotation)

    def walk_annotation(self, annotation: ast.expr) -> None:
        """Visits an annotation. Where it is sure to be evaluated, what it needs is a need of the file."""
        self.annotating = self.postponed
        self.visit(annotation)
        self.annotating = False
        simple = isinstance(annotation, (ast.Name, ast.Attribute, ast.Constant))
        if simple or self.postponed or self.function or self.conditions:
            return
        for node in walk_nodes(annotation):
            if isinstance(node, ast.Subscript) and self.is_type(node.value, _GENERIC):
                self.need(9, f"annotation {ast.unparse(node.value)}[...]", node)
            sides = (node.left, node.right) if isinstance(node, ast.BinOp) and isinstance(node.op, ast.BitOr) else ()
            if any(self.is_type(side, _TYPES) for side in sides):
                self.need(10, "annotation with | between types", node)

    def is_type(self, node: ast.expr, names: frozenset[str]) -> bool:
        """Whether an expression is one of these types of Python itself, or None."""
        if isinstance(node, ast.Constant):
            return node.value is None
        if not isinstance(node, ast.Name) or node.id not in names:
            return False
        return not any(node.id in scope.bound or node.id in scope.imports for scope in self.scope.chain)

    def bind_parameters(self, arguments: ast.arguments) -> None:
        self.scope.parameters = [argument.arg for argument in (*arguments.posonlyargs, *arguments.args)]
        self.scope.bound.update(argument.arg for _, argument, _ in list_parameters(arguments))

    def visit_Lambda(self, node: ast.Lambda) -> None:
        self.walk_defaults(node.args)
        before = self.scope, self.function, self.lazy
        self.scope = PythonScope(self.scope, False)
        self.function = self.lazy = True
        self.bind_parameters(node.args)
        self.visit(node.body)
        self.scope, self.function, self.lazy = before

    def visit_ClassDef(self, node: ast.ClassDef) -> None:
        self.scope.bound.add(node.name)
        self.walk_all(node.decorator_list)
        self.walk_all(node.bases)
        self.walk_all(keyword.value for keyword in node.keywords)
        self.bind_type_parameters(node)
        before = self.scope, self.inside_class, self.me
        self.inside_class, self.me = self.enter_class(node), ""
        self.scope = PythonScope(self.scope, True)
        self.walk_all(node.body)
        self.inside_class.members |= self.scope.bound
        for name, type_ in ((name, type_) for name, type_ in self.scope.objects.items() if type_):
            self.inside_class.objects[name] = type_ if self.inside_class.objects.get(name, type_) == type_ else ""
        self.scope, self.inside_class, self.me = before

    def visit_Global(self, node: ast.Global) -> None:
        # An import or assignment here binds the module's name.
        for name in node.names:
            self.declared_global.append((self.scope, name))
            self.scope.imports.setdefault(name, self.scope.chain[-1].imports.setdefault(name, []))

    def visit_Assign(self, node: ast.Assign) -> None:
        self.visit(node.value)
        for target in node.targets:
            if target.__class__ is ast.Name:
                self.remember(target.id, node.value)  # type: ignore[attr-defined]
            elif target.__class__ is not ast.Attribute or not self.hold_own(target, node.value):  # type: ignore
                self.visit(target)

    def visit_AnnAssign(self, node: ast.AnnAssign) -> None:
        self.need(6, "variable annotations", node)
        self.walk_annotation(node.annotation)
        annotated = self.find_annotated(node.annotation)
        if node.value is not None:
            self.visit(node.value)
            if isinstance(node.target, ast.Name):
                self.remember(node.target.id, node.value, annotated)
                return
        if isinstance(node.target, ast.Attribute) and self.hold_own(node.target, None, annotated):
            return
        self.visit(node.target)
        if isinstance(node.target, ast.Name):
            self.scope.objects[node.target.id] = annotated

    def remember(self, name: str, node: ast.expr, annotated: str = "") -> None:
        scope = self.scope
        reading = self.has_variables and name not in scope.bound and node.__class__ in _READING
        source = self.format_source(node) if reading else ""
        if _ROS_VARIABLE.search(source):
            scope.machine[name] = source
        else:
            scope.machine.pop(name, None)
        scope.bound.add(name)
        if isinstance(node, ast.List):
            scope.lists[name] = node
        value = self.find_text(node) or self.find_unpacked(name, node)
        if name in scope.values and scope.values[name] != value:
            value = None
        scope.values[name] = value
        if not annotated and node.__class__ is ast.Constant and node.value is None:  # type: ignore[attr-defined]
            scope.objects.pop(name, None)
        else:
            self.scope.objects[name] = annotated or self.find_type(node)

    def visit_NamedExpr(self, node: ast.NamedExpr) -> None:
        self.need(8, "assignment expression", node)
        self.visit(node.value)
        self.visit(node.target)
        self.scope.objects[node.target.id] = self.find_type(node.value)
        self.scope.binder.bound.add(node.target.id)

    def visit_MatchAs(self, node) -> None:
        """A pattern or parameter of a type, of which the name is no node."""
        name = getattr(node, "name", None) or getattr(node, "rest", None)
        if name:
            self.scope.bound.add(name)
        self.walk_children(node)

    visit_MatchStar = visit_MatchMapping = visit_TypeVar = visit_ParamSpec = visit_TypeVarTuple = visit_MatchAs

    def visit_Match(self, node) -> None:
        self.need(10, "match statement", node)
        self.visit(node.subject)
        first = len(self.ways)
        for case in node.cases:
            self.walk_branch([case])
        self.merge(first, self.scope.objects)

    def visit_TemplateStr(self, node) -> None:
        self.need(*_NEEDED[node.__class__.__name__], node)
        self.walk_children(node)

    visit_TypeAlias = visit_Nonlocal = visit_TemplateStr

    def visit_YieldFrom(self, node) -> None:
        self.given = None
        self.visit_TemplateStr(node)

    def visit_Raise(self, node: ast.Raise) -> None:
        if node.cause is not None:
            self.need(0, "raise from", node)
        self.walk_children(node)

    def visit_Constant(self, node: ast.Constant) -> None:
        if node.value.__class__ is str:
            self.add_mentions(node.value, node)  # type: ignore[arg-type]

    def add_mentions(self, text: str, node) -> None:
        for match in _IN_STRING.finditer(text):
            package = match.group("url") or match.group("find")
            path = (match.group("url_path") or match.group("find_path") or "").strip("/")
            self.refer_to("file" if path else "package", package, path, node)

    def visit_Expr(self, node: ast.Expr) -> None:
        # A string on its own is documentation.
        if node.value.__class__ is not ast.Constant:
            self.visit(node.value)

    def refer_to(self, kind: str, package: str, name: str, node, conditional: bool = False) -> None:
        column = self.find_column(node.lineno, node.col_offset)
        arguments = self.included if kind == "file" else None
        conditions = self.use_conditions
        if conditions and (self.undecided or conditional):
            conditions = (*conditions, UNDECIDED)
        conditional = self.conditional or conditional
        reference = Reference(kind, package, name, node.lineno, column, conditional, arguments, conditions)
        self.references[reference] = None

    def visit_BinOp(self, node: ast.BinOp) -> None:
        if node.op.__class__ is ast.Add or node.op.__class__ is ast.Div:
            self.add_path(node)
        elif node.op.__class__ is ast.MatMult:
            self.need(5, "`@` operator", node)
        elif node.op.__class__ is ast.RShift and getattr(node.left, "id", "") == "print":
            self.python2_only.append(Problem(node.lineno, "print statement"))
        self.visit(node.left)
        self.visit(node.right)

    def visit_JoinedStr(self, node: ast.JoinedStr) -> None:
        self.need(6, "f-string", node)
        if sys.version_info >= (3, 12):
            self.check_quotes(node)
        self.add_path(node)
        self.walk_all(node.values)

    def check_quotes(self, node: ast.JoinedStr) -> None:
        """Before 3.12 an expression in an f-string could hold neither the f-string's own quotes nor a backslash."""
        start = self.get_line_bytes(node.lineno)[node.col_offset :].decode("utf-8", "replace")
        match = _QUOTE.match(start)
        if match is None:
            return
        for value in node.values:
            if isinstance(value, ast.FormattedValue):
                expression = self.format_source(value.value)
                if match.group(1) in expression or "\\" in expression:
                    self.need(12, "quotes or backslash inside an f-string", node)

    def visit_List(self, node) -> None:
        if len(node.elts) > 1:
            self.add_path(node)
        self.walk_all(node.elts)

    visit_Tuple = visit_List

    def add_path(self, node) -> None:
        """A file reference, when the expression names a file in a package's share folder and nothing around it does."""
        if id(node) in self.consumed:
            return
        value = self.find_text(node)
        if isinstance(value, PackagePath) and value.path:
            self.consumed.update(map(id, walk_nodes(node)))
            self.refer_to("file", value.package, value.path, node, value.assumed)

    def visit_Call(self, node: ast.Call) -> None:
        function = self.find_callee(node.func)
        keywords = {keyword.arg: keyword.value for keyword in node.keywords if keyword.arg}
        if keywords and getattr(node.func, "id", "") == "print" and "print_function" not in "".join(self.lines):
            self.need(0, "`print` with keywords", node)
        before = self.conditional, self.undecided
        if "condition" in keywords and not isinstance(keywords["condition"], ast.Constant):
            self.conditional = self.undecided = True
        if function in JOINS or function in WRAPPERS:
            self.add_path(node)
        elif function in PACKAGE_CALLS or (function in ("get_path", "find") and node.args):
            self.add_package_call(node, function)
        elif function == "DeclareLaunchArgument":
            name = self.find_text(node.args[0]) if node.args else None
            default = self.find_text(keywords["default_value"]) if "default_value" in keywords else None
            if isinstance(name, str) and isinstance(default, str):
                self.launch_defaults[name] = default
        elif "package" in keywords:
            self.add_launched_node(keywords)
        elif function == "Node" and len(node.args) > 1 and format_dotted(node.func).startswith("roslaunch."):
            self.add_launched_node({"package": node.args[0], "executable": node.args[1]})
        elif function in _COMMAND_CALLS:
            self.add_command(node, function, keywords)
        elif function == "FindExecutable":
            name = self.find_text(keywords.get("name") or (node.args[0] if node.args else node.func))
            if isinstance(name, str) and _PROGRAM.fullmatch(name):
                self.refer_to("command", "", name, node)
        elif function == "find_node" or function == "find_resource":
            texts = [self.find_text(argument) for argument in node.args[:2]]
            if len(texts) == 2 and all(isinstance(text, str) for text in texts):
                self.refer_to("executable" if function == "find_node" else "sought", str(texts[0]), str(texts[1]), node)
        elif function == "MoveItConfigsBuilder":
            # moveit_configs_utils looks for <robot>_moveit_config unless told the package.
            named = keywords.get("package_name")
            robot = keywords.get("robot_name") or (node.args[0] if node.args else None)
            value = self.find_text(named or robot) if named is not None or robot is not None else None
            if isinstance(value, str) and PACKAGE_NAME.fullmatch(value):
                self.refer_to("package", value if named is not None else f"{value}_moveit_config", "", node)
        elif node.func.__class__ is ast.Name:
            self.calls.append((self.scope, node.func.id, node, self.conditional))  # type: ignore[attr-defined]
        if function in CALLBACK_CALLS and self.has_interfaces:
            self.note_callback(node, function)
        self.use_call(node)
        if node.func.__class__ is ast.Attribute:
            self.visit_Attribute(node.func, node)  # type: ignore[arg-type]
        else:
            self.visit_value(node.func)
        if function == "IncludeLaunchDescription" and node.args:
            self.included = self.list_given_arguments(keywords.get("launch_arguments"))
            self.visit(node.args[0])
            self.included = None
            self.walk_all(node.args[1:])
        else:
            self.walk_all(node.args)
        self.walk_all(keyword.value for keyword in node.keywords)
        self.conditional, self.undecided = before

    def list_given_arguments(self, node: ast.expr | None) -> tuple[str, ...] | None:
        """Names of the arguments that `launch_arguments=` of an include gives; None where they cannot all be known."""
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "items":
            node = node.func.value
        value = {} if node is None else self.find_value(node)
        if not isinstance(value, (dict, list)) or MORE in value:
            return None
        names = [one[0] if isinstance(one, list) and one else one for one in value]
        return tuple(map(str, names)) if all(isinstance(name, str) for name in names) else None

    def add_package_call(self, node: ast.Call, function: str) -> None:
        value = self.find_text(node)
        argument = node.args[0] if node.args else node.keywords[0].value if node.keywords else node
        if isinstance(value, PackagePath):
            if id(node) not in self.consumed:
                self.consumed.update(map(id, walk_nodes(node)))
                self.refer_to("package", value.package, "", argument, value.assumed)
        elif function == "find" or self.defining is None or not isinstance(argument, ast.Name):
            return
        elif argument.id in self.scope.parameters:
            self.lookups[self.defining] = (self.scope.parameters.index(argument.id), argument.id)

    def add_lookup_calls(self) -> None:
        """Packages named in calls of this file's own functions that look up a package by a parameter."""
        for scope, name, node, conditional in self.calls if self.lookups else ():
            looking = next((each for each in scope.chain if (each, name) in self.lookups), None)
            if looking is None:
                continue
            index, parameter = self.lookups[looking, name]
            given = [keyword.value for keyword in node.keywords if keyword.arg == parameter] or node.args[index:]
            self.scope = scope
            package = self.find_package_name(given[0]) if given else None
            if package is not None:
                self.refer_to("package", package[0], "", given[0], conditional or package[1])

    def add_launched_node(self, keywords: dict) -> None:
        """Node(package=, executable=), ComposableNode(package=, plugin=), everything that looks like them, and
        roslaunch.core.Node(package, node_type) of ROS 1."""
        package = self.find_package_name(keywords["package"])
        if package is None:
            return
        named = map(keywords.get, ("executable", "node_executable", "exec_name", "node_type"))
        executable = next(filter(None, named), None)
        plugin = keywords.get("plugin") or keywords.get("node_plugin")
        name = self.find_text(executable or plugin) if executable or plugin else None
        kind, at = ("executable" if executable else "plugin"), executable or plugin
        if not isinstance(name, str) or not name:
            kind, name, at = "package", "", keywords["package"]
        self.refer_to(kind, package[0], name, at, package[1])

    def add_command(self, node: ast.Call, function: str, keywords: dict) -> None:
        """A program started with literal arguments, and what rosrun, roslaunch and ros2 are told to start."""
        given = keywords.get("cmd") or keywords.get("args") or keywords.get("command") or next(iter(node.args), None)
        words: list[str | None] = []
        if isinstance(given, ast.Name):
            given = next((scope.lists[given.id] for scope in self.scope.chain if given.id in scope.lists), given)
        for item in given.elts if isinstance(given, (ast.List, ast.Tuple)) else filter(None, (given,)):
            text = self.find_text(item)
            words += text.split() if isinstance(text, str) else [*_find_start(item).split(), None]
        if words[:1] == ["sudo"]:
            del words[0]
        program = words[0] if words else None
        if program is None or not _PROGRAM.fullmatch(program):
            return
        if program == "ros2" and len(words) > 3 and words[1] in ("run", "launch"):
            kind, words = ("executable" if words[1] == "run" else "sought"), words[2:]
        elif program in ("rosrun", "roslaunch"):
            kind, words = ("executable" if program == "rosrun" else "sought"), [*words[1:], None, None]
        else:
            known = self.find_imported(format_dotted(node.func).partition(".")[0])
            if function[0].isupper() or any(dotted.partition(".")[0] in _STARTING for dotted, _ in known):
                self.refer_to("command", "", program, node)
            return
        package, name = words[0], words[1]
        if package and name and PACKAGE_NAME.fullmatch(package):
            self.refer_to(kind, package, name, node)


def _find_start(node: ast.expr) -> str:
    """The whole words that a text which is put together begins with, where they are written out."""
    while True:
        if node.__class__ is ast.BinOp:
            node = node.left  # type: ignore[attr-defined]
        elif node.__class__ is ast.JoinedStr:
            node = node.values[0]  # type: ignore[attr-defined]
        elif node.__class__ is ast.Call and getattr(node.func, "attr", "") == "format":  # type: ignore[attr-defined]
            node = node.func.value  # type: ignore[attr-defined]
        else:
            break
    text = getattr(node, "value", None)
    words = re.match(r".*\s", text, re.DOTALL) if isinstance(text, str) else None
    return words.group() if words is not None else ""


# What Python has itself, and what tells nothing of other names.
_SURE = ALWAYS - DYNAMIC
# By the class of a node; one of which nothing is said has no children.
_HANDLERS = {cls: PythonReader.walk_children for cls, fields in CHILD_FIELDS.items() if fields}
_HANDLERS |= collect_node_methods(PythonReader, "visit_")
_WITHOUT_STRINGS = {cls: handler for cls, handler in _HANDLERS.items() if cls is not ast.Constant}
