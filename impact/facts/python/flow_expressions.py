"""What stands inside Python functions: expressions to calls, assignments and what may change variables.

One walk does it all; what nobody asks the value of (a condition, an operand) is visited without making an Expr of it.

A use of a parameter or local variable is judged by where it stands: a test or an operand is a `read`, which is not
noted; an argument is a `pass`, a method called on it too; the value of another local variable is a `read`, since the
Assignment tells what goes on from there; what is kept elsewhere, returned or listed is an `escape`.
"""

import ast
from collections.abc import Sequence

from ....edges.dispatch import collect_node_methods
from ..flow import Access, Assignment, DataMember, FlowCall, FlowExpr, FlowParameter, Guard
from .flow_body import Body, ClassBody
from .text import (
    FormatPiece,
    SourceText,
    drop_surrogates,
    format_pieces,
    iterate_children,
    list_parameters,
    split_percent_format,
)

# Tables of numbers are no part of any flow.
LONGEST_LIST = 500
_PLACES = tuple(FlowExpr("number", str(number)) for number in range(16))
# Methods of dictionaries that tell what is in them.
_OF_MAPPINGS = frozenset(("get", "items", "keys", "values"))
_PARTIAL = frozenset(("partial", "functools.partial"))
# Builtins that keep nothing of what they are given.
_READING = frozenset(
    (
        *("abs", "all", "any", "bool", "float", "format", "hasattr", "hash", "id", "int", "isinstance", "len", "max"),
        *("min", "ord", "pow", "print", "range", "repr", "round", "str", "sum", "type", "unicode"),
    )
)
# Methods whose argument becomes an element of what they are called on.
_KEEPING = {"append": 0, "add": 0, "appendleft": 0, "insert": 1, "setdefault": 1, "put": 0}
_PATHS = (ast.Name, ast.Attribute, ast.Subscript)
LONGEST_OTHER = 120
ANY = FlowExpr("other")
_NUMBERS = {None: FlowExpr("number", "None"), True: FlowExpr("number", "True"), False: FlowExpr("number", "False")}


def _is_reordered(node) -> bool:
    """Whether what is walked through is in another order than it is written in."""
    name = node.func.id if node.__class__ is ast.Call and node.func.__class__ is ast.Name else ""
    return name in ("sorted", "reversed", "set")


class Expressions(SourceText):
    """The reader of expressions, of which it visits some and makes values of others. It reads for one body at a time,
    into whose lists it writes."""

    body: Body
    guard: int
    this: str
    locals: set[str]
    guards: list[Guard]
    calls: list[FlowCall]
    assignments: list[Assignment]
    accesses: list[Access]

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self.module_functions: set[str] = set()
        self.class_bodies: dict[str, ClassBody] = {}
        # Names that a class's own body knows without its object.
        self.own: set[str] = set()
        self.constants: list[DataMember] = []
        # Functions whose bodies are still to be read, since they see all variables of the one they stand in.
        self.waiting: list[tuple[Body, list[ast.stmt]]] = []
        # Whether names are bound in the body of a class.
        self.in_class = False

    def enter(self, body: Body) -> None:
        self.body = body
        self.guard = -1
        self.this = body.this
        self.locals = body.locals
        self.guards = body.guards
        self.calls = body.calls
        self.assignments = body.assignments
        self.accesses = body.accesses
        self.own = set()
        self.in_class = False
        self.unplaced = False

    def push(self, kind: str, text: str, line: int) -> None:
        """A new guard around what follows."""
        self.guards.append(Guard(kind, text, line, self.guard))
        self.guard = len(self.guards) - 1

    def knows(self, name: str) -> bool:
        """Whether a name is a variable of the function, or of one around it, which then is captured."""
        return name in self.locals or (self.body.outer is not None and self.body.is_captured(name))

    def touch(self, path: str, use: str) -> None:
        """Notes what may change a variable of the function."""
        if use != "read":
            self.accesses.append(Access(path, use))

    def count_notes(self) -> int:
        """How much was noted of the function up to here."""
        return len(self.calls) + len(self.accesses) + len(self.assignments)

    def note_bound_method(self, name: str, value: FlowExpr, operator: str) -> None:
        """Notes what a variable of the function calls that is worth a method of an object and nothing else:
        `declare = self.declare_parameter`."""
        is_method = value.kind in ("name", "function") and operator == "=" and name not in self.locals
        self.body.bound_methods[name] = value.text if is_method and "." in value.text else ""

    def find_bound_method(self, name: str) -> str:
        """What a variable of the function, or of one around it, calls, as note_bound_method() has it; empty where it is
        no method, or not one alone."""
        body = self.body
        while body is not None and name not in body.locals:
            body = body.outer
        method = body.bound_methods.get(name, "") if body is not None else ""
        receiver = method.rpartition(".")[0]
        if receiver and self.knows(receiver.partition(".")[0]):
            self.touch(receiver, "pass")
        return method

    def is_function(self, name: str) -> bool:
        body = self.body
        while body is not None:
            if name in body.functions:
                return True
            body = body.outer
        return name in self.module_functions

    def find_target(self, node) -> str:
        """The path of what is assigned to, nothing visited; empty for several."""
        cls = node.__class__
        if cls is ast.Name:
            if node.id == self.this:
                return "this"
            return "this." + node.id if node.id in self.own or self.in_class else node.id
        if cls is ast.Attribute:
            return f"{self.find_target(node.value)}.{node.attr}"
        if cls is ast.Subscript:
            inner = self.find_target(node.value)
            return inner if node.slice.__class__ is ast.Slice else f"{inner}.[]"
        return "" if cls in (ast.Tuple, ast.List, ast.Starred) else "()"

    def make_member(self, path: str, name: str) -> FlowExpr:
        cls = self.body.cls
        return FlowExpr("function" if cls is not None and name in cls.callbacks else "name", path)

    def make_other(self, node) -> FlowExpr:
        return FlowExpr("other", self.format_source(node)[:LONGEST_OTHER])

    def make_constant(self, node: ast.Constant) -> FlowExpr:
        value = node.value
        cls = value.__class__
        if cls is str:
            return FlowExpr("text", value if value.isascii() else drop_surrogates(value))  # type: ignore[union-attr]
        if value is None or cls is bool:
            return _NUMBERS[value]  # type: ignore[index]
        if cls is int or cls is float or cls is complex:
            return FlowExpr("number", self.format_source(node))
        return self.make_other(node)

    def format_annotation(self, node) -> str:
        """A type as written, quotes around it left out."""
        if node is None:
            return ""
        if node.__class__ is ast.Constant and node.value.__class__ is str:
            return drop_surrogates(node.value)
        return self.format_source(node)

    # Visiting, for calls and uses alone

    def visit(self, node) -> None:
        """Records the calls and uses in an expression, the value of which nobody asks."""
        visitor = _VISITORS.get(node.__class__)
        if visitor is not None:
            visitor(self, node)
            return
        for one in iterate_children(node):
            self.visit(one)

    def visit_Attribute(self, node) -> None:
        self.reach(node)

    visit_Subscript = visit_Attribute

    def visit_IfExp(self, node) -> None:
        self.follow(node, "read")

    visit_BoolOp = visit_Lambda = visit_NamedExpr = visit_JoinedStr = visit_IfExp
    visit_ListComp = visit_SetComp = visit_GeneratorExp = visit_DictComp = visit_Call = visit_Name = visit_IfExp

    def visit_Yield(self, node) -> None:
        if node.value is not None:
            self.follow(node.value, "escape")

    visit_YieldFrom = visit_Yield

    def reach(self, node) -> tuple[str, bool, FlowExpr | None]:
        """The path that an expression names, whether it begins at a variable of the function, and the call that it
        begins with, None for none; what stands inside it, such as an index or a call, is visited."""
        parts: list[str] = []
        while True:
            cls = node.__class__
            if cls is ast.Attribute:
                parts.append(node.attr)
                node = node.value
            elif cls is ast.Subscript:
                self.visit(node.slice)
                # A slice is still the container.
                if node.slice.__class__ is not ast.Slice:
                    parts.append("[]")
                node = node.value
            elif cls is ast.Await:
                node = node.value
            else:
                break
        local, called = False, None
        if cls is ast.Name:
            head = node.id
            if head == self.this:
                head = "this"
            elif self.knows(head):
                local = True
            elif head in self.own:
                head = "this." + head
        elif cls is ast.Call:
            called = self.call(node)
            head = called.text + "()"
        else:
            self.visit(node)
            head = "()"
        if not parts:
            return head, local, called
        parts.append(head)
        parts.reverse()
        return ".".join(parts), local, called

    def find_chosen(self, node) -> FlowExpr | None:
        """The elements that literal keys choose of what a path names, as in `config["left"]["topics"]`; None for all
        else."""
        keys: list[FlowExpr] = []
        while node.__class__ is ast.Subscript and node.slice.__class__ is ast.Constant:
            keys.append(self.make_constant(node.slice))
            node = node.value
        inner = node
        while inner.__class__ is ast.Attribute:
            inner = inner.value
        if not keys or inner.__class__ is not ast.Name:
            return None
        chosen = FlowExpr("name", self.reach(node)[0])
        for key in reversed(keys):
            chosen = FlowExpr("index", "", (chosen, key))
        return chosen

    def follow(self, node, use: str, target: str = "") -> FlowExpr:
        """An expression. use: the Access that it is if it is a path, `read` for none; target: what it is kept in,
        `return` for what the function returns."""
        cls = node.__class__
        if cls is ast.Constant:
            return self.make_constant(node)
        if cls is ast.Name:
            name = node.id
            if name == self.this:
                return FlowExpr("name", "this")
            if self.knows(name):
                self.touch(name, use)
                return FlowExpr("name", name)
            if name in self.own:
                return self.make_member("this." + name, name)
            return FlowExpr("function" if self.is_function(name) else "name", name)
        if cls is ast.Attribute:
            path, local, called = self.reach(node)
            if local:
                self.touch(path, use)
                return FlowExpr("name", path)
            head, _, name = path.rpartition(".")
            if head == "this":
                return self.make_member(path, name)
            known = self.class_bodies.get(head)
            kind = "function" if known is not None and name in known.callbacks else "name"
            return FlowExpr(kind, path, (), called)
        if cls is ast.Call:
            return self.walk_call(node, target)
        maker = _VALUES.get(cls)
        if maker is not None:
            return maker(self, node, use, target)
        self.visit(node)
        return self.make_other(node)

    def evaluate_Subscript(self, node: ast.Subscript, use: str, target: str) -> FlowExpr:
        container = self.follow(node.value, "read")
        if node.slice.__class__ is ast.Slice:
            self.visit(node.slice)
            index = self.make_other(node.slice)
            suffix = ""
        else:
            index = self.follow(node.slice, "read")
            suffix = ".[]"
        # The element is used, not the container.
        if node.value.__class__ in _PATHS:
            path = self.find_target(node.value)
            if self.knows(path.partition(".")[0]):
                self.touch(path + suffix, use)
        return FlowExpr("index", "", (container, index))

    def evaluate_IfExp(self, node: ast.IfExp, use: str, target: str) -> FlowExpr:
        saved = self.guard
        self.visit(node.test)
        text, line = self.format_source(node.test), node.test.lineno
        count = len(self.guards)
        facts = self.count_notes()
        self.push("if", text, line)
        true = self.follow(node.body, use, target)
        self.guard = saved
        self.push("unless", text, line)
        false = self.follow(node.orelse, use, target)
        self.guard = saved
        if facts == self.count_notes():
            del self.guards[count:]
        return FlowExpr("choice", "", (FlowExpr("other", text[:LONGEST_OTHER]), true, false))

    def evaluate_BoolOp(self, node: ast.BoolOp, use: str, target: str) -> FlowExpr:
        """`a or b` is a choice between a and b; `a and b` one between b and a."""
        saved, count = self.guard, len(self.guards)
        both = node.op.__class__ is ast.And
        values: list[FlowExpr] = []
        texts: list[str] = []
        facts = 0
        for operand in node.values:
            if texts:
                self.push("if" if both else "unless", texts[-1], node.values[len(texts) - 1].lineno)
            values.append(self.follow(operand, use, target))
            if not texts:
                facts = self.count_notes()
            texts.append(self.format_source(operand))
        self.guard = saved
        if facts == self.count_notes():
            del self.guards[count:]
        result = values.pop()
        texts.pop()
        while values:
            first = values.pop()
            asked = FlowExpr("other", texts.pop()[:LONGEST_OTHER])
            result = FlowExpr("choice", "", (asked, result, first) if both else (asked, first, result))
        return result

    def evaluate_UnaryOp(self, node: ast.UnaryOp, *_: object) -> FlowExpr:
        operand = node.operand
        if node.op.__class__ is ast.USub and operand.__class__ is ast.Constant:
            return FlowExpr("number", self.format_source(node))
        self.visit(operand)
        return self.make_other(node)

    def evaluate_Tuple(self, node, use: str, target: str) -> FlowExpr:
        element = target + ".[]" if target and target != "return" else ""
        elements = node.elts
        kept = [self.follow(each, "escape", element) for each in elements[:LONGEST_LIST]]
        if len(elements) > LONGEST_LIST:
            for each in elements[LONGEST_LIST:]:
                self.visit(each)
            kept.append(FlowExpr("other", f"{len(elements) - LONGEST_LIST} more"))
        return FlowExpr("list", "", tuple(kept))

    evaluate_List = evaluate_Set = evaluate_Tuple

    def evaluate_Dict(self, node: ast.Dict, use: str, target: str) -> FlowExpr:
        element = target + ".[]" if target and target != "return" else ""
        pairs: list[FlowExpr] = []
        for key, value in zip(node.keys, node.values, strict=False):
            if len(pairs) == LONGEST_LIST:
                pairs.append(FlowExpr("other", f"{len(node.keys) - LONGEST_LIST} more"))
            if len(pairs) > LONGEST_LIST:
                self.visit(value)
            elif key is None:
                pairs.append(FlowExpr("keyword", "**", (self.follow(value, "escape"),)))
            else:
                name = self.follow(key, "read")
                pairs.append(FlowExpr("list", "", (name, self.follow(value, "escape", element))))
        return FlowExpr("list", "", tuple(pairs))

    def evaluate_Starred(self, node: ast.Starred, use: str, *_: object) -> FlowExpr:
        return FlowExpr("keyword", "*", (self.follow(node.value, "escape"),))

    def evaluate_Await(self, node: ast.Await, use: str, target: str) -> FlowExpr:
        return self.follow(node.value, use, target)

    def evaluate_NamedExpr(self, node: ast.NamedExpr, use: str, *_: object) -> FlowExpr:
        target = self.find_target(node.target)
        value = self.follow(node.value, "read", target)
        self.bind(node.target, value, node.lineno)
        return value

    def evaluate_Lambda(self, node: ast.Lambda, use: str, *_: object) -> FlowExpr:
        around = self.body.name
        own = f"lambda@{node.lineno}:{self.find_column(node.lineno, node.col_offset)}"
        name = f"{around}.{own}" if around else own
        body = self.make_body(name, node, node.args)
        self.waiting.append((body, [ast.copy_location(ast.Return(node.body), node.body)]))
        return FlowExpr("lambda", name)

    def make_body(self, name: str, node, arguments: ast.arguments) -> Body:
        """A function that stands where the reader is, with its parameters; defaults are visited here."""
        current = self.body
        outer = current.outer if current.is_class else current if current.name else None
        body = Body(name, current.cls, node.lineno, node.end_lineno, outer)
        body.this = current.this
        body.parameters = self.list_parameters(arguments)
        for parameter in body.parameters:
            bare = parameter.name.lstrip("*")
            body.locals.add(bare)
            if bare == body.this:
                body.this = ""
        return body

    def list_parameters(self, arguments: ast.arguments) -> tuple[FlowParameter, ...]:
        found: list[FlowParameter] = []
        starred = False
        for kind, argument, default in list_parameters(arguments):
            if kind == "keyword" and not starred:
                found.append(FlowParameter("*"))
            starred = starred or kind in ("args", "keyword")
            value = None if default is None else self.follow(default, "escape")
            name = {"args": "*", "kwargs": "**"}.get(kind, "") + argument.arg
            found.append(FlowParameter(name, self.format_annotation(argument.annotation), value))
        return tuple(found)

    def evaluate_ListComp(self, node, use: str, target: str) -> FlowExpr:
        saved, in_class = self.guard, self.in_class
        self.in_class = False
        for generator in node.generators:
            self.walk_loop_head(generator.target, generator.iter, generator.iter.lineno)
            for condition in generator.ifs:
                self.visit(condition)
                self.push("if", self.format_source(condition), condition.lineno)
        element = target + ".[]" if target and target != "return" else ""
        if node.__class__ is ast.DictComp:
            self.visit(node.key)
            each = self.follow(node.value, "escape", element)
        else:
            each = self.follow(node.elt, "escape", element)
        self.guard, self.in_class = saved, in_class
        return FlowExpr("other", self.make_other(node).text, (each,))

    evaluate_SetComp = evaluate_GeneratorExp = evaluate_DictComp = evaluate_ListComp

    def walk_loop_head(self, target, iterated, line: int) -> None:
        """The head of a for: what is walked through and the variable that is each of it, under the loop's guard."""
        container = self.walk_elements(iterated)
        self.push("for", f"{self.format_source(target)} in {self.format_source(iterated)}", line)
        self.bind_walked(target, container, line)

    def bind_walked(self, target, container: FlowExpr, line: int) -> None:
        """The variables of a loop, each of what is walked through; of what goes beside another, each its own."""
        beside = container.kind == "list" and container.text == "each"
        if beside and target.__class__ in (ast.Tuple, ast.List) and len(target.elts) == len(container.parts):
            for part, each in zip(target.elts, container.parts, strict=False):
                self.bind_walked(part, each, line)
        elif container is ANY:
            self.bind(target, ANY, line)
        else:
            plain = FlowExpr("list", "", container.parts) if beside else container
            self.bind(target, FlowExpr("index", "", (plain, ANY)), line)

    def walk_elements(self, node) -> FlowExpr:
        """What is walked through by an expression; a list `each` for what goes beside another, as zip does."""
        if node.__class__ is ast.Call and node.func.__class__ is ast.Name and node.func.id not in self.locals:
            name, arguments = node.func.id, node.args
            if arguments and not any(argument.__class__ is ast.Starred for argument in arguments):
                if name in ("sorted", "reversed", "list", "tuple", "set", "iter"):
                    for keyword in node.keywords:
                        self.visit(keyword.value)
                    return self.walk_elements(arguments[0])
                if name == "enumerate":
                    begins = [*arguments[1:], *(one.value for one in node.keywords if one.arg == "start")]
                    start = tuple(self.follow(one, "read") for one in begins[:1])
                    count = ANY if _is_reordered(arguments[0]) else FlowExpr("call", "enumerate", start)
                    return FlowExpr("list", "each", (count, self.walk_elements(arguments[0])))
                if name in ("zip", "izip"):
                    each = ((one, self.walk_elements(one)) for one in arguments)
                    return FlowExpr("list", "each", tuple(ANY if _is_reordered(one) else held for one, held in each))
        return self.follow(node, "read")

    def bind(self, target, value: FlowExpr, line: int, type: str = "", operator: str = "=") -> None:
        """An assignment of a value, already read, to a name, a member, an element or several of them."""
        cls = target.__class__
        if cls is ast.Name:
            name = target.id
            body = self.body
            if self.in_class:
                self.own.add(name)
                body.cls.add_member(name, type or find_made_class(value), line, value)  # type: ignore[union-attr]
                path = "this." + name
            else:
                path = name
                self.note_bound_method(name, value, operator)
                if not body.name:
                    self.constants.append(DataMember(name, type, line, value))
                    self.locals.add(name)
                elif name in body.outside:
                    if body.outside[name] is ast.Global:
                        self.constants.append(DataMember(name, type, line, value))
                else:
                    self.locals.add(name)
            self.assignments.append(Assignment(path, value, line, self.guard, type, operator))
        elif cls is ast.Attribute or cls is ast.Subscript:
            path, local, _ = self.reach(target)
            if local:
                self.touch(path, "write")
            elif path.startswith("this.") and path.count(".") == 1 and operator == "=" and self.body.cls is not None:
                self.body.cls.add_member(path[5:], type or find_made_class(value), line, value)
            key = target.slice if cls is ast.Subscript and target.slice.__class__ is ast.Constant else None
            named = self.follow(key, "read") if key is not None else None
            self.assignments.append(Assignment(path, value, line, self.guard, type, operator, named))
        elif cls is ast.Tuple or cls is ast.List:
            parts = target.elts
            starred = any(part.__class__ is ast.Starred for part in parts)
            if value.kind == "list" and len(value.parts) == len(parts) and not starred:
                for part, each in zip(parts, value.parts, strict=False):
                    self.bind(part, each, line)
            else:
                if value.kind == "list" or len(parts) > len(_PLACES):
                    value = ANY
                for place, part in enumerate(parts):
                    known = not starred and place < len(_PLACES)
                    self.bind(part, FlowExpr("index", "", (value, _PLACES[place] if known else ANY)), line)
        elif cls is ast.Starred:
            self.bind(target.value, value, line)
        else:
            self.visit(target)

    # Strings and paths that are put together: joins of their pieces

    def evaluate_BinOp(self, node: ast.BinOp, use: str, target: str) -> FlowExpr:
        op = node.op.__class__
        if op is ast.Add:
            # Long sums lean to the left.
            operands = [node.right]
            left = node.left
            while left.__class__ is ast.BinOp and left.op.__class__ is ast.Add:  # type: ignore[attr-defined]
                operands.append(left.right)  # type: ignore[attr-defined]
                left = left.left  # type: ignore[attr-defined]
            operands.append(left)
            operands.reverse()
            return FlowExpr("join", "+", tuple(self.follow(operand, "read") for operand in operands))
        if op is ast.Mod and node.left.__class__ is ast.Constant and node.left.value.__class__ is str:  # type: ignore[attr-defined]
            return self.walk_percent_format(node)
        if op is ast.Div:
            left = self.follow(node.left, "read")
            right = self.follow(node.right, "read")
            if (
                "text" in (left.kind, right.kind)
                or left.text.endswith("Path")
                or (left.kind, left.text) == ("join", "/")
            ):
                parts = left.parts if (left.kind, left.text) == ("join", "/") else (left,)
                return FlowExpr("join", "/", (*parts, right))
            return self.make_other(node)
        self.visit(node.left)
        self.visit(node.right)
        return self.make_other(node)

    def walk_percent_format(self, node: ast.BinOp) -> FlowExpr:
        pieces = split_percent_format(node.left.value)  # type: ignore[attr-defined]
        right = node.right
        values: dict[int | str, FlowExpr] = {}
        if right.__class__ is ast.Tuple:
            for place, element in enumerate(right.elts):  # type: ignore[attr-defined]
                values[place] = self.follow(element, "read")
        elif right.__class__ is ast.Dict and None not in right.keys:  # type: ignore[attr-defined]
            for key, element in zip(right.keys, right.values, strict=False):  # type: ignore[attr-defined]
                known = key.value if key.__class__ is ast.Constant else ""
                values[known if known.__class__ is str else ""] = self.follow(element, "read")
        else:
            values[0] = self.follow(right, "read")
        return self.put_together(node, pieces, values)

    def put_together(
        self, node, pieces: list[str | FormatPiece] | None, values: dict[int | str, FlowExpr]
    ) -> FlowExpr:  # fmt: skip
        """The join of literal pieces and values; other when a value is not told apart."""
        if pieces is None:
            return self.make_other(node)
        parts: list[FlowExpr] = []
        for piece in pieces:
            if isinstance(piece, str):
                parts.append(FlowExpr("text", drop_surrogates(piece)))
            elif piece.value in values:
                parts.append(make_formatted(values[piece.value], piece.spec))
            elif isinstance(piece.value, int):
                return self.make_other(node)
            else:
                parts.append(FlowExpr("other", drop_surrogates(piece.value)[:LONGEST_OTHER]))
        if len(parts) == 1 and parts[0].kind == "text":
            return parts[0]
        return FlowExpr("join", "", tuple(parts))

    def walk_format_call(self, node: ast.Call) -> FlowExpr:
        """`"...".format(...)`."""
        values: dict[int | str, FlowExpr] = {}
        unpacked = False
        for place, argument in enumerate(node.args):
            unpacked = unpacked or argument.__class__ is ast.Starred
            values[place] = self.follow(argument, "read")
        for keyword in node.keywords:
            value = self.follow(keyword.value, "read")
            if keyword.arg is not None:
                values[keyword.arg] = value
        if unpacked:
            return self.make_other(node)
        return self.put_together(node, format_pieces(node.func.value.value), values)  # type: ignore[attr-defined]

    def evaluate_JoinedStr(self, node: ast.JoinedStr, use: str, *_: object) -> FlowExpr:
        outermost = not self.unplaced and node.lineno != node.end_lineno
        if outermost:
            # Where things stand in a string of several lines, interpreters before 3.12 do not know.
            self.unplaced = True
            for inner in ast.walk(node):
                if hasattr(inner, "lineno"):
                    inner.lineno, inner.end_lineno = node.lineno, node.lineno  # type: ignore[attr-defined]
                    inner.col_offset = inner.end_col_offset = node.col_offset  # type: ignore[attr-defined]
        parts: list[FlowExpr] = []
        for piece in node.values:
            if piece.__class__ is ast.Constant:
                parts.append(self.make_constant(piece))  # type: ignore[arg-type]
            elif piece.__class__ is ast.FormattedValue:
                value = self.follow(piece.value, "read")  # type: ignore[attr-defined]
                written = piece.format_spec  # type: ignore[attr-defined]
                spec = "" if piece.conversion in (-1, ord("s")) else f"!{chr(piece.conversion)}"  # type: ignore[attr-defined]
                if written is not None:
                    self.visit(written)
                    whole = len(written.values) == 1 and written.values[0].__class__ is ast.Constant
                    spec += drop_surrogates(written.values[0].value) if whole else "{}"
                parts.append(make_formatted(value, "" if spec == "s" else spec))
            else:
                self.visit(piece)
                parts.append(ANY)
        if outermost:
            self.unplaced = False
        if not parts:
            return FlowExpr("text", "")
        return parts[0] if len(parts) == 1 and parts[0].kind == "text" else FlowExpr("join", "", tuple(parts))

    def walk_call(self, node: ast.Call, target: str = "") -> FlowExpr:
        """A call as a value."""
        func = node.func
        if (
            func.__class__ is ast.Attribute
            and func.attr == "format"  # type: ignore[attr-defined]
            and func.value.__class__ is ast.Constant  # type: ignore[attr-defined]
            and func.value.value.__class__ is str  # type: ignore[attr-defined]
        ):
            return self.walk_format_call(node)
        called = self.call(node, target)
        callee, arguments = called.text, called.parts
        if callee in _PARTIAL and arguments:
            return FlowExpr("bind", "", arguments)
        last = callee.rpartition(".")[2].lstrip("_")
        if last[:1].isupper() and not last.isupper():
            return FlowExpr("make", callee, arguments)
        literal = func.value if func.__class__ is ast.Attribute else None  # type: ignore[attr-defined]
        # `"/".join(names)`
        if literal.__class__ is ast.Constant and literal.value.__class__ is str:  # type: ignore[union-attr]
            return FlowExpr("call", callee, arguments, self.make_constant(literal))  # type: ignore[arg-type]
        return called

    def call(self, node: ast.Call, target: str = "") -> FlowExpr:
        """Records a call, with what it is given and what it is called on, and gives it. Its receiver is the call that
        gives what it is called on, None for none."""
        func = node.func
        cls = func.__class__
        line = node.lineno
        reading, keeping, kept = False, -1, ""
        receiver = None
        if cls is ast.Attribute:
            path, local, receiver = self.reach(func.value)  # type: ignore[attr-defined]
            attribute = func.attr  # type: ignore[attr-defined]
            callee = f"{path}.{attribute}"
            if receiver is None and attribute in _OF_MAPPINGS:
                receiver = self.find_chosen(func.value)  # type: ignore[attr-defined]
            if local:
                self.touch(path, "pass")
            keeping = _KEEPING.get(attribute, -1)
            kept = path + ".[]"
        elif cls is ast.Name:
            name = func.id  # type: ignore[attr-defined]
            if not self.knows(name):
                if name in self.own:
                    name = "this." + name
                else:
                    reading = name in _READING
            callee = self.find_bound_method(name) or (name if name != self.this else "this")
        else:
            callee, _, receiver = self.reach(func)
        arguments: list[FlowExpr] = []
        for place, argument in enumerate(node.args):
            inside = argument.__class__
            if inside is ast.Constant:
                arguments.append(self.make_constant(argument))  # type: ignore[arg-type]
            elif reading:
                arguments.append(self.follow(argument, "read"))
            elif inside in _PATHS:
                arguments.append(self.follow(argument, "pass"))
            else:
                inner = kept if place == keeping else ""
                arguments.append(self.follow(argument, "escape", inner))
        for keyword in node.keywords:
            value, name = keyword.value, keyword.arg
            if name is None:
                arguments.append(FlowExpr("keyword", "**", (self.follow(value, "escape"),)))
            else:
                use = "pass" if value.__class__ in _PATHS else "escape"
                arguments.append(FlowExpr("keyword", name, (self.follow(value, use),)))
        if callee.endswith(".__init__") and arguments and node.args and getattr(node.args[0], "id", None) == self.this:
            # `Base.__init__(self, name)` is what `super().__init__(name)` is.
            arguments = arguments[1:]
        given = tuple(arguments)
        if callee != "super":
            returned = target == "return"
            column = self.find_column(line, node.col_offset)
            self.calls.append(
                FlowCall(callee, given, line, column, self.guard, "", "" if returned else target, returned)
            )
        return FlowExpr("call", callee, given, receiver)


def make_formatted(value: FlowExpr, spec: str) -> FlowExpr:
    """A value as a format writes it."""
    return FlowExpr("call", "format", (value, FlowExpr("text", drop_surrogates(spec)))) if spec else value


def make_join(pieces: Sequence[str | FormatPiece] | None, values: Sequence[FlowExpr]) -> FlowExpr | None:
    """What a format puts together of values, None where one of them is not told apart."""
    parts: list[FlowExpr] = []
    for piece in pieces or ():
        if isinstance(piece, str):
            parts.append(FlowExpr("text", piece))
        elif isinstance(piece.value, int) and piece.value < len(values):
            parts.append(make_formatted(values[piece.value], piece.spec))
        else:
            return None
    return FlowExpr("join", "", tuple(parts)) if pieces is not None else None


def find_made_class(value: FlowExpr) -> str:
    """The class that a value is an object of, as written; empty for what is not made here."""
    return value.text if value.kind == "make" else ""


_VISITORS = collect_node_methods(Expressions, "visit_")
_VALUES = collect_node_methods(Expressions, "evaluate_")
