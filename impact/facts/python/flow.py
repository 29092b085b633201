"""Python sources to facts of message flow: classes, functions, calls and the conditions around them."""

import ast
import re
from collections.abc import Iterator

from ....edges.dispatch import collect_node_methods
from ..flow import Access, Alias, Assignment, FlowExpr, FlowFile
from ..place import Problem
from .flow_body import Body, ClassBody
from .flow_conditions import (
    JUMPS,
    STAYS,
    AskedCondition,
    HoldingCondition,
    Leaving,
    combine_with_head,
    make_condition,
    merge_leavings,
)
from .flow_expressions import ANY, Expressions
from .source import PythonSource, read
from .text import SIGNS, list_imported

# Calls that never return.
EXITS = frozenset(("sys.exit", "exit", "quit", "os._exit", "os.abort"))
# Of `a = b = ...`, each of which repeats the value.
MOST_TARGETS = 16
# What stands behind these is no function when it is named.
_PROPERTIES = frozenset(("property", "cached_property", "functools.cached_property", "abc.abstractproperty"))


def extract(data: bytes) -> FlowFile:
    """The facts of one Python file, Python 2 included as far as it can be rewritten. Never raises."""
    return extract_flow(read(data))


def extract_flow(source: PythonSource) -> FlowFile:
    """The facts of a source that is already parsed. Never raises."""
    lines = source.parsed.count("\n") + 1
    if source.tree is None:
        return FlowFile("python", unread=((1, lines),), problems=source.problems)
    raised = {problem.line for problem in source.python2_only if problem.message.startswith("`raise")}
    reader = PythonStatements(source.parsed, raised)
    reader.read(source.tree, lines)
    bodies = sorted(reader.bodies, key=lambda body: (body.name != "", body.line))
    return FlowFile(
        "python",
        aliases=tuple(reader.aliases),
        classes=tuple(cls.build_class() for cls in sorted(reader.classes, key=lambda cls: cls.line)),
        functions=tuple(body.build_function() for body in bodies if body.says_something()),
        constants=tuple(reader.constants),
        unread=tuple(reader.unread),
        problems=(*source.problems, *reader.problems),
    )


class PythonStatements(Expressions):
    """The reader of statements. raised: lines whose Python 2 `raise E, "..."` was rewritten into a plain expression."""

    def __init__(self, text: str, raised: set[int]) -> None:
        super().__init__(text)
        self.raised = raised
        self.aliases: list[Alias] = []
        self.classes: list[ClassBody] = []
        self.bodies: list[Body] = []
        self.unread: list[tuple[int, int]] = []
        self.problems: list[Problem] = []

    def read(self, tree: ast.Module, lines: int) -> None:
        self.module_functions = {node.name for node in _list_definitions(tree.body)}
        self.waiting.append((Body("", None, 1, lines), tree.body))
        place = 0
        while place < len(self.waiting):
            body, code = self.waiting[place]
            place += 1
            self.bodies.append(body)
            self.enter(body)
            try:
                self.walk_block(code)
            except RecursionError:
                self.unread.append((body.line, body.end))
                self.problems.append(Problem(body.line, "nested too deeply"))
        for body in self.bodies:
            if body.outer is not None:
                for name in sorted(body.captured):
                    body.outer.accesses.append(Access(name, "escape"))

    def walk_block(self, statements: list[ast.stmt]) -> Leaving:
        """Reads statements; gives how control leaves them."""
        saved = self.guard
        left: list[HoldingCondition] | None = None
        jumped: ast.stmt | None = None
        behind = False
        readers = _STATEMENTS
        for node in statements:
            if jumped is not None and not behind:
                self.add_never_guard(jumped)
                behind = True
            reader = readers.get(node.__class__)
            if reader is None:
                self.visit(node)
                continue
            leaving = reader(self, node)
            if leaving is None:
                jumped = jumped or node
            elif leaving and jumped is None:
                left = left or []
                left += leaving
                for condition in leaving:
                    self.push(condition.kind, condition.text, condition.line)
        self.guard = saved
        if jumped is not None:
            return JUMPS
        return tuple(left) if left else STAYS

    def add_never_guard(self, node: ast.stmt) -> None:
        """A guard around what stands behind a statement that always leaves."""
        word = "exit" if node.__class__ is ast.Expr else node.__class__.__name__.lower()
        self.push("never", f"after {word}", node.lineno)

    def make_condition(self, node: ast.expr) -> AskedCondition:
        operand = ""
        if node.__class__ is ast.UnaryOp and node.op.__class__ is ast.Not:  # type: ignore[attr-defined]
            operand = self.format_source(node.operand)  # type: ignore[attr-defined]
        return make_condition(node, self.format_source(node), operand)

    def walk_under(self, kind: str, text: str, line: int, statements: list[ast.stmt]) -> Leaving:
        saved = self.guard
        self.push(kind, text, line)
        leaving = self.walk_block(statements)
        self.guard = saved
        return leaving

    def read_If(self, node: ast.If) -> Leaving:
        """An if with its chain of elifs."""
        saved = self.guard
        branches: list[tuple[AskedCondition, Leaving]] = []
        last: Leaving = STAYS
        while True:
            self.visit(node.test)
            asked = self.make_condition(node.test)._replace(line=node.lineno)
            branches.append((asked, self.walk_under("if", asked.text, node.lineno, node.body)))
            other = node.orelse
            if not other:
                break
            self.push("unless", asked.text, node.lineno)
            if len(other) == 1 and other[0].__class__ is ast.If:
                node = other[0]  # type: ignore[assignment]
                continue
            last = self.walk_block(other)
            break
        self.guard = saved
        for asked, leaving in reversed(branches):
            last = merge_leavings(asked, leaving, last)
        return last

    def read_While(self, node: ast.While) -> Leaving:
        self.visit(node.test)
        text = self.format_source(node.test)
        self.walk_under("while", text, node.lineno, node.body)
        broken = can_break(node.body)
        endless = node.test.__class__ is ast.Constant and bool(node.test.value)  # type: ignore[attr-defined]
        left: Leaving = STAYS
        if node.orelse:
            left = self.walk_under("unless", text, node.lineno, node.orelse)
        if broken:
            return (HoldingCondition("if", "break", node.lineno),) if left is None else STAYS
        return JUMPS if endless else left

    def read_For(self, node: ast.For) -> Leaving:
        saved = self.guard
        self.walk_loop_head(node.target, node.iter, node.lineno)
        self.walk_block(node.body)
        self.guard = saved
        if not node.orelse:
            return STAYS
        if not can_break(node.body):
            return self.walk_block(node.orelse)
        if self.walk_under("unless", "break", node.lineno, node.orelse) is None:
            return (HoldingCondition("if", "break", node.lineno),)
        return STAYS

    read_AsyncFor = read_For

    def read_Try(self, node: ast.Try) -> Leaving:
        saved = self.guard
        left = self.walk_block(node.body)
        caught: list[tuple[str, int, Leaving]] = []
        for handler in node.handlers:
            what = "BaseException"
            if handler.type is not None:
                self.visit(handler.type)
                what = self.format_source(handler.type)
            if handler.name:
                self.locals.add(handler.name)
            left_so = self.walk_under("catch", what, handler.lineno, handler.body)
            if not _is_raised_again(handler):
                caught.append((what, handler.lineno, left_so))
        if node.orelse and left is not None:
            for condition in left:
                self.push(condition.kind, condition.text, condition.line)
            for what, _, _ in caught:
                self.push("unless", f"except {what}", node.lineno)
            more = self.walk_block(node.orelse)
            left = JUMPS if more is None else (*left, *more)
            self.guard = saved
        last = self.walk_block(node.finalbody)
        if last is None:
            return JUMPS
        going_on = [(what, line) for what, line, leaving in caught if leaving is not None]
        if left is None:
            if not going_on:
                return JUMPS
            return (HoldingCondition("catch", ", ".join(what for what, _ in going_on), going_on[0][1]), *last)
        jumping = tuple(
            HoldingCondition("unless", f"except {what}", node.lineno) for what, _, leaving in caught if leaving is None
        )
        return (*jumping, *last) if going_on else (*left, *jumping, *last)

    read_TryStar = read_Try

    def read_With(self, node: ast.With) -> Leaving:
        heads: list[str] = []
        for item in node.items:
            variable = item.optional_vars
            if variable is None:
                self.visit(item.context_expr)
                heads.append(self.format_source(item.context_expr))
            else:
                value = self.follow(item.context_expr, "read", self.find_target(variable))
                self.bind(variable, value, node.lineno)
                heads.append(f"{self.format_source(item.context_expr)} as {self.format_source(variable)}")
        leaving = self.walk_under("with", ", ".join(heads), node.lineno, node.body)
        swallows = leaving is None and any(_SWALLOWS.match(head) for head in heads)
        return STAYS if swallows else leaving

    read_AsyncWith = read_With

    def read_Match(self, node: ast.Match) -> Leaving:
        subject = self.follow(node.subject, "read")
        head = self.format_source(node.subject)
        if node.subject.__class__ not in (ast.Name, ast.Attribute, ast.Call, ast.Subscript):
            head = f"({head})"
        # Values that a case takes whatever else holds, cases that ask more, and how those that are taken are left.
        taken: list[str] = []
        asking: list[tuple[list[str], str]] = []
        jumping: list[str] = []
        staying: list[tuple[list[str], str]] = []
        conditions: list[HoldingCondition] = []
        other: Leaving = STAYS
        for case in node.cases:
            saved, line = self.guard, case.pattern.lineno
            values = self.walk_case_pattern(case.pattern)
            entered = [" or ".join(f"{head} == {value}" for value in values)] if values else []
            if len(values) > 1:
                entered = [f"({entered[0]})"]
            self.bind_captured(case.pattern, subject, line)
            if values:
                self.push("case", f"{head} == {' or '.join(values)}", line)
            elif taken:
                self.push("case", f"{head} other than {', '.join(taken)}", line)
                entered = [f"{head} != {value}" for value in taken]
            for asked_values, text in asking:
                if not values or not asked_values or not set(values).isdisjoint(asked_values):
                    self.push("unless", text, line)
            if case.guard is not None:
                self.visit(case.guard)
                self.push("if", self.format_source(case.guard), line)
                entered.append(self.make_condition(case.guard).conjunct)
            leaving = self.walk_block(case.body)
            self.guard = saved
            text = " and ".join(entered)
            if leaving is None:
                if case.guard is not None:
                    conditions.append(HoldingCondition("unless", text, line))
                elif values:
                    jumping += values
                else:
                    other = JUMPS
            else:
                staying.append((values if case.guard is None else [], text))
                conditions += combine_with_head(text, leaving)
            if case.guard is None:
                taken += values
            else:
                asking.append((values, text))
            if not values and case.guard is None:
                break
        if other is None:
            if not staying:
                return JUMPS
            if all(values for values, _ in staying):
                values = [value for values, _ in staying for value in values]
                text = f"{head} == {' or '.join(values)}"
                opposite = " and ".join(f"{head} != {value}" for value in values)
                return (*conditions, HoldingCondition("case", text, node.lineno, opposite))
            return (*conditions, HoldingCondition("if", " or ".join(text for _, text in staying), node.lineno))
        if jumping:
            text = f"{head} other than {', '.join(jumping)}"
            opposite = " or ".join(f"{head} == {value}" for value in jumping)
            conditions.append(HoldingCondition("case", text, node.lineno, f"({opposite})"))
        return tuple(conditions)

    def walk_case_pattern(self, node) -> list[str]:
        """The values a pattern stands for; none for one that takes everything."""
        cls = node.__class__
        if cls is ast.MatchAs:
            return [] if node.pattern is None else self.walk_case_pattern(node.pattern)
        if cls is ast.MatchOr:
            parts = [self.walk_case_pattern(part) for part in node.patterns]
            return [text for part in parts for text in part] if all(parts) else []
        return [self.format_source(node)]

    def bind_captured(self, pattern, subject: FlowExpr, line: int) -> None:
        """The names that a pattern binds."""
        for node in ast.walk(pattern):
            name = getattr(node, "name", None) or getattr(node, "rest", None)
            if name and isinstance(name, str):
                value = subject if node is pattern else FlowExpr("index", "", (subject, ANY))
                self.bind(ast.Name(name, ast.Store()), value, line)

    def read_Return(self, node: ast.Return) -> Leaving:
        if node.value is not None:
            value = self.follow(node.value, "escape", "return")
            self.assignments.append(Assignment("", value, node.lineno, self.guard, "", "return"))
        return JUMPS

    def read_Raise(self, node: ast.Raise) -> Leaving:
        if node.exc is not None:
            self.follow(node.exc, "escape")
        if node.cause is not None:
            self.visit(node.cause)
        return JUMPS

    def read_Break(self, node: ast.stmt) -> Leaving:
        return JUMPS

    read_Continue = read_Break

    def read_Assert(self, node: ast.Assert) -> Leaving:
        self.visit(node.test)
        if node.msg is not None:
            self.visit(node.msg)
        return (HoldingCondition("if", self.format_source(node.test), node.lineno),)

    def read_Expr(self, node: ast.Expr) -> Leaving:
        value = node.value
        if value.__class__ is ast.Call:
            return JUMPS if self.call(value).text in EXITS else STAYS  # type: ignore[arg-type]
        self.visit(value)
        return JUMPS if node.lineno in self.raised and value.__class__ is ast.Tuple else STAYS

    def read_Assign(self, node: ast.Assign) -> Leaving:
        targets = node.targets
        first = targets[0]
        if len(targets) == 1 and first.__class__ in (ast.Tuple, ast.List):
            value = self.walk_unpacked(first, node.value)
        else:
            to = self.find_target(first)
            use = "read" if self.is_local(first) or to.partition(".")[0] in self.locals else "escape"
            value = self.follow(node.value, use, to)
        for place, target in enumerate(targets):
            self.bind(target, value if place < MOST_TARGETS else ANY, node.lineno)
        return STAYS

    def is_local(self, target: ast.expr) -> bool:
        """Whether a target is a variable of the function itself."""
        return target.__class__ is ast.Name and not self.in_class and target.id not in self.body.outside  # type: ignore[attr-defined]

    def walk_unpacked(self, target, value: ast.expr) -> FlowExpr:
        """The value of `a, b = ...`, in which each part knows what it is kept in."""
        parts = target.elts
        if value.__class__ in (ast.Tuple, ast.List) and len(value.elts) == len(parts):  # type: ignore[attr-defined]
            pairs = zip(parts, value.elts)  # type: ignore[attr-defined] # noqa: B905
            return FlowExpr(
                "list", "", tuple(self.follow(each, "escape", self.find_target(part)) for part, each in pairs)
            )
        return self.follow(value, "escape")

    def read_AnnAssign(self, node: ast.AnnAssign) -> Leaving:
        type = self.format_annotation(node.annotation)
        target = node.target
        if node.value is not None:
            value = self.follow(node.value, "read" if self.is_local(target) else "escape", self.find_target(target))
            self.bind(target, value, node.lineno, type)
        elif self.is_local(target):
            self.locals.add(target.id)  # type: ignore[attr-defined]
        else:
            head, _, name = self.find_target(target).partition(".")
            if head == "this" and "." not in name and self.body.cls is not None:
                if self.in_class:
                    self.own.add(name)
                self.body.cls.add_member(name, type, node.lineno, None)
        return STAYS

    def read_AugAssign(self, node: ast.AugAssign) -> Leaving:
        target = node.target
        self.visit(target)
        path = self.find_target(target)
        value = self.follow(node.value, "read", path if node.op.__class__ is ast.Add else "")
        self.bind(target, value, node.lineno, operator=f"{SIGNS[node.op.__class__]}=")
        return STAYS

    def read_Delete(self, node: ast.Delete) -> Leaving:
        for target in node.targets:
            if target.__class__ is ast.Attribute or target.__class__ is ast.Subscript:
                path, local, _ = self.reach(target)
                if local:
                    self.touch(path, "write")
        return STAYS

    def read_Global(self, node: ast.Global | ast.Nonlocal) -> Leaving:
        for name in node.names:
            self.body.outside[name] = node.__class__
            self.locals.discard(name)
        return STAYS

    read_Nonlocal = read_Global

    def read_Import(self, node: ast.Import | ast.ImportFrom) -> Leaving:
        self.aliases += (Alias(name, meant, self.body.name) for name, meant in list_imported(node))
        return STAYS

    read_ImportFrom = read_Import

    def list_decorators(self, node) -> tuple[str, ...]:
        found: list[str] = []
        for decorator in node.decorator_list:
            if decorator.__class__ is ast.Call:
                found.append(self.call(decorator).text)
            else:
                found.append(self.reach(decorator)[0])
        return tuple(found)

    def read_FunctionDef(self, node) -> Leaving:
        decorators = self.list_decorators(node)
        current = self.body
        method = self.in_class
        name = f"{current.name}.{node.name}" if current.name else node.name
        body = self.make_body(name, node, node.args)
        body.returns = self.format_annotation(node.returns)
        if not method:
            if current.name:
                current.functions.add(node.name)
        elif "staticmethod" not in decorators:
            # The object itself is no argument that callers write.
            positional = node.args.posonlyargs or node.args.args
            if positional:
                body.this = positional[0].arg
                body.parameters = body.parameters[1:]
                body.locals.discard(body.this)
        self.waiting.append((body, node.body))
        return STAYS

    read_AsyncFunctionDef = read_FunctionDef

    def read_ClassDef(self, node: ast.ClassDef) -> Leaving:
        self.list_decorators(node)
        outer, saved, in_class, own = self.body, self.guard, self.in_class, self.own
        name = f"{outer.name}.{node.name}" if outer.name else node.name
        bases: list[str] = []
        for base in node.bases:
            self.visit(base)
            bases.append(self.format_source(base))
        for keyword in node.keywords:
            self.visit(keyword.value)
        last = node.end_lineno or node.lineno
        cls = ClassBody(name, tuple(bases), node.lineno, last)
        for base in bases:
            if base in self.class_bodies:
                cls.callbacks |= self.class_bodies[base].callbacks
        for method in _list_definitions(node.body):
            if method.name not in cls.methods:
                cls.methods.append(method.name)
            if not any(self.find_target(decorator) in _PROPERTIES for decorator in method.decorator_list):
                cls.callbacks.add(method.name)
        self.classes.append(cls)
        self.class_bodies[name] = cls
        around = outer.outer if outer.is_class else outer
        body = Body(name, cls, node.lineno, last, around if around and around.name else None)
        body.is_class = True
        self.bodies.append(body)
        self.enter(body)
        self.own, self.in_class = set(cls.methods), True
        self.walk_block(node.body)
        self.enter(outer)
        self.guard, self.in_class, self.own = saved, in_class, own
        return STAYS


def _is_raised_again(handler: ast.ExceptHandler) -> bool:
    """Whether at the end of a handler what it caught is raised again, as it would be without the handler."""
    last = handler.body[-1]
    return isinstance(last, ast.Raise) and last.exc is None


def can_break(statements: list[ast.stmt]) -> bool:
    """Whether a loop over these statements can be left by `break`."""
    stack: list[ast.AST] = list(statements)
    while stack:
        node = stack.pop()
        if node.__class__ is ast.Break:
            return True
        if node.__class__ in (ast.For, ast.While, ast.AsyncFor):
            stack += node.orelse  # type: ignore[attr-defined]
        elif not isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            stack += _list_inner_statements(node)
    return False


def _list_definitions(statements: list[ast.stmt]) -> Iterator[ast.FunctionDef | ast.AsyncFunctionDef]:
    """The functions defined by statements, under an if or try too."""
    stack: list[ast.AST] = list(reversed(statements))
    while stack:
        node = stack.pop()
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            yield node
        elif node.__class__ in (ast.If, ast.Try):
            stack += reversed(_list_inner_statements(node))


def _list_inner_statements(node: ast.AST) -> list[ast.stmt]:
    """The statements right in another one."""
    parts = (node, *getattr(node, "handlers", ()), *getattr(node, "cases", ()))
    fields = ((part, field) for part in parts for field in ("body", "orelse", "finalbody"))
    return [statement for part, field in fields for statement in getattr(part, field, ())]


_SWALLOWS = re.compile(r"(?:[\w.]+\.)?(?:suppress|raises|assertRaises\w*)\(")
_STATEMENTS = collect_node_methods(PythonStatements, "read_")
