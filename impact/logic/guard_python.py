"""Python conditions to terms. Whatever is not understood is opaque; nothing raises."""

import ast
import re
import warnings

from ...edges.dispatch import collect_node_methods
from ..facts.python.text import SIGNS
from .guard_terms import (
    DEEPEST,
    FALSE,
    FLIPPED,
    LONGEST,
    NOW,
    NULL,
    TRUE,
    Conjunct,
    GuardReading,
    Term,
    build_reading,
    compare,
    join,
    make_member,
    make_opaque,
    make_place,
    negate,
    parse_number,
    split_owner,
)

_COMPARED = {ast.Eq: "==", ast.NotEq: "!=", ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">="}
_MOST_MEMBERS = 50


def parse_condition(text: str, holds: bool) -> GuardReading:
    """What a condition says when it holds, or when it does not."""
    reader = _Reader()
    node = parse_tree(text)
    if node is None:
        term = make_opaque(text)
        return GuardReading((Conjunct(text if holds else f"not ({text})", term if holds else negate(term)),))
    return build_reading(reader.split_pieces(node, holds), reader.names)


def parse_expression(text: str) -> Term:
    """The term of an expression."""
    node = parse_tree(text)
    return make_opaque(text) if node is None else _Reader().parse_term(node, 0)


def parse_tree(text: str) -> ast.expr | None:
    """The syntax tree; None when there is none. Python 2's `<>` is known."""
    if not text.strip() or len(text) > LONGEST:
        return None
    for written in (text, text.replace("<>", "!=")):
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                return ast.parse(f"(\n{written}\n)", mode="eval").body
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            continue
    return None


def _parse_statement(text: str) -> ast.stmt | None:
    """The statement that a text begins with, None where it is none."""
    try:
        return ast.parse(text).body[0]
    except (SyntaxError, ValueError, RecursionError, MemoryError, IndexError):
        return None


def loop(head: str) -> GuardReading:
    """What the head of a `for` says: that there is an element."""
    inside = re.sub(r"^\s*(?:async\s+)?for\s+|:\s*$", "", head).strip()
    statement = _parse_statement(f"for {inside}: pass")
    if not isinstance(statement, ast.For) or len(inside) > LONGEST:
        return GuardReading((Conjunct(head, make_opaque(head)),))
    walked = _Reader().parse_term(statement.iter, 0)
    targets = statement.target.elts if isinstance(statement.target, (ast.Tuple, ast.List)) else []
    called = walked.parts[0].text if walked.kind == "call" and len(walked.parts) == 2 else ""
    if called in ("range", "xrange") and walked.parts[1].kind == "size":
        walked = walked.parts[1].parts[0]
        names = _unpack_target(statement.target, make_place(walked))
    elif called == "enumerate" and len(targets) == 2:
        walked = walked.parts[1]
        names = [
            *_unpack_target(targets[0], make_place(walked)),
            *_unpack_target(targets[1], Term("each", "", (walked,))),
        ]
    else:
        names = _unpack_target(statement.target, Term("each", "", (walked,)))
    return GuardReading((Conjunct(f"for {inside}", Term("each", "", (walked,))),), tuple(names))


def _unpack_target(target: ast.expr, value: Term) -> list[tuple[str, Term]]:
    if isinstance(target, ast.Name):
        return [(target.id, value)]
    if isinstance(target, (ast.Tuple, ast.List)):
        parts = enumerate(target.elts)
        return [pair for place, part in parts for pair in _unpack_target(part, make_member(value, f"{place}"))]
    return []


def parse_case_pattern(subject: Term, pattern: str) -> GuardReading:
    """What `case pattern` says of a subject."""
    statement = _parse_statement(f"match _:\n case {pattern}: pass")
    if not isinstance(statement, ast.Match) or len(statement.cases) != 1 or statement.cases[0].guard:
        return GuardReading((Conjunct("", compare("==", subject, make_opaque(pattern))),))
    names: list[tuple[str, Term]] = []
    term = _read_pattern(subject, statement.cases[0].pattern, names, 0)
    return GuardReading((Conjunct("", term),), tuple(names))


def _read_pattern(subject: Term, pattern: ast.pattern, names: list[tuple[str, Term]], depth: int) -> Term:
    if isinstance(pattern, ast.MatchValue):
        return compare("==", subject, _Reader().parse_term(pattern.value, depth))
    if isinstance(pattern, ast.MatchSingleton):
        return _is(subject, {None: NULL, True: TRUE, False: FALSE}[pattern.value])
    if isinstance(pattern, ast.MatchOr) and depth < DEEPEST:
        return join("or", [_read_pattern(subject, part, names, depth + 1) for part in pattern.patterns])
    if isinstance(pattern, ast.MatchAs):
        if pattern.name:
            names.append((pattern.name, subject))
        return TRUE if pattern.pattern is None else _read_pattern(subject, pattern.pattern, names, depth + 1)
    try:
        return Term("op", "matches", (subject, make_opaque(ast.unparse(pattern))))
    except RecursionError:
        return Term("op", "matches", (subject,))


def _is(left: Term, right: Term) -> Term:
    """`left is right`."""
    if NULL in (left, right):
        return compare("==", left, right)
    return Term("op", "is", tuple(sorted((left, right))))


class _Reader:
    """Reads the tree of one condition. names: variables that the condition makes."""

    def __init__(self) -> None:
        self.names: list[tuple[str, Term]] = []

    def make_opaque(self, node: ast.AST) -> Term:
        try:
            return make_opaque(ast.unparse(node))
        except (RecursionError, ValueError):
            return make_opaque("too deep")

    def split_pieces(self, node: ast.expr, holds: bool) -> list[Conjunct]:
        """What must hold, one after the other, for the condition to hold (or not to)."""
        result: list[Conjunct] = []
        waiting = [(node, holds)]
        while waiting:
            node, holds = waiting.pop()
            if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
                waiting.append((node.operand, not holds))
            elif isinstance(node, ast.BoolOp) and isinstance(node.op, ast.And if holds else ast.Or):
                waiting.extend((part, holds) for part in reversed(node.values))
            else:
                term = self.parse_term(node, 0)
                result.append(Conjunct(self.format_node(node, holds), term if holds else negate(term)))
        return result

    def format_node(self, node: ast.expr, holds: bool) -> str:
        text = self.make_opaque(node).text
        if holds:
            return text
        if isinstance(node, ast.Compare) and len(node.ops) == 1:
            left, right = self.make_opaque(node.left).text, self.make_opaque(node.comparators[0]).text
            operator = node.ops[0]
            words = {ast.Is: "is not", ast.IsNot: "is", ast.In: "not in", ast.NotIn: "in"}
            flipped = words.get(type(operator)) or FLIPPED[_COMPARED[type(operator)]]
            return f"{left} {flipped} {right}"
        simple = isinstance(node, (ast.Name, ast.Attribute, ast.Call, ast.Subscript))
        return f"not {text}" if simple else f"not ({text})"

    def parse_term(self, node: ast.expr, depth: int) -> Term:
        read = _READ.get(type(node))
        if read is None or depth > DEEPEST:
            return self.make_opaque(node)
        return read(self, node, depth + 1)

    def read_BoolOp(self, node: ast.BoolOp, depth: int) -> Term:
        parts = [self.parse_term(part, depth) for part in node.values]
        return join("and" if isinstance(node.op, ast.And) else "or", parts)

    def read_UnaryOp(self, node: ast.UnaryOp, depth: int) -> Term:
        operand = self.parse_term(node.operand, depth)
        if isinstance(node.op, ast.Not):
            return negate(operand)
        if isinstance(node.op, ast.USub):
            return Term("-", "", (Term("whole", "0"), operand))
        return operand if isinstance(node.op, ast.UAdd) else Term("op", "~", (operand,))

    def read_Compare(self, node: ast.Compare, depth: int) -> Term:
        terms = [self.parse_term(part, depth) for part in (node.left, *node.comparators)]
        links: list[Term] = []
        for place, operator in enumerate(node.ops):
            left, right = terms[place], terms[place + 1]
            if isinstance(operator, (ast.In, ast.NotIn)):
                link = self.expand_membership(left, node.comparators[place], right, depth)
            elif isinstance(operator, (ast.Is, ast.IsNot)):
                link = _is(left, right)
            else:
                link = compare(_COMPARED[type(operator)], left, right)
            links.append(negate(link) if isinstance(operator, (ast.NotIn, ast.IsNot)) else link)
        return join("and", links)

    def expand_membership(self, left: Term, written: ast.expr, right: Term, depth: int) -> Term:
        """`left in (a, b)` as `left == a or left == b`; anything else is as it is."""
        if right.kind == "call" and len(right.parts) == 1:
            owner, method = split_owner(right.parts[0])
            right = owner if owner is not None and method in ("keys", "iterkeys") else right
        listed = written.elts if isinstance(written, (ast.Tuple, ast.List, ast.Set)) else None
        if listed is None or len(listed) > _MOST_MEMBERS or any(isinstance(part, ast.Starred) for part in listed):
            return Term("op", "in", (left, right))
        if not listed:
            return FALSE
        return join("or", [compare("==", left, self.parse_term(part, depth)) for part in listed])

    def read_BinOp(self, node: ast.BinOp, depth: int) -> Term:
        operands, sign = (self.parse_term(node.left, depth), self.parse_term(node.right, depth)), SIGNS[type(node.op)]
        return Term(sign, "", operands) if sign in ("+", "-", "*") else Term("op", sign, operands)

    def read_IfExp(self, node: ast.IfExp, depth: int) -> Term:
        return Term("choice", "", tuple(self.parse_term(part, depth) for part in (node.test, node.body, node.orelse)))

    def read_Name(self, node: ast.Name, depth: int) -> Term:
        return Term("name", "this" if node.id == "self" else node.id)

    def read_Attribute(self, node: ast.Attribute, depth: int) -> Term:
        return make_member(self.parse_term(node.value, depth), node.attr)

    def read_Constant(self, node: ast.Constant, depth: int) -> Term:
        value = node.value
        if value is None:
            return NULL
        if isinstance(value, bool):
            return TRUE if value else FALSE
        if isinstance(value, (int, float)):
            try:
                return parse_number(repr(value)) or self.make_opaque(node)
            except ValueError:
                return make_opaque("a large number")
        if isinstance(value, (str, bytes)):
            return Term("string", repr(value))
        return self.make_opaque(node)

    def read_Subscript(self, node: ast.Subscript, depth: int) -> Term:
        return Term("index", "", (self.parse_term(node.value, depth), self.parse_term(node.slice, depth)))

    def read_Call(self, node: ast.Call, depth: int) -> Term:
        function = self.parse_term(node.func, depth)
        arguments = [self.parse_term(argument, depth) for argument in node.args]
        named = sorted((word.arg or "**", self.parse_term(word.value, depth)) for word in node.keywords)
        if not arguments and not named:
            owner, method = split_owner(function)
            asks_clock = owner is not None and owner.kind == "call" and split_owner(owner.parts[0])[1] == "get_clock"
            if function.text in ("rospy.Time.now", "rospy.get_rostime") or (method == "now" and asks_clock):
                return NOW
        owner, method = split_owner(function) if len(arguments) == 1 and not named else (None, "")
        if owner is not None and method == "has_key":
            return Term("op", "in", (arguments[0], owner))
        if len(arguments) == 1 and not named and isinstance(node.func, ast.Name):
            known = {"len": "size", "bool": "truth", "abs": "abs"}.get(node.func.id)
            if known:
                return Term(known, "", (arguments[0],))
        return Term("call", "", (function, *arguments, *(Term("op", f"{name}=", (value,)) for name, value in named)))

    def read_NamedExpr(self, node: ast.NamedExpr, depth: int) -> Term:
        value = self.parse_term(node.value, depth)
        if isinstance(node.target, ast.Name):
            self.names.append((node.target.id, value))
        return value

    def read_Await(self, node: ast.Await, depth: int) -> Term:
        return self.parse_term(node.value, depth)


_READ = collect_node_methods(_Reader, "read_")
