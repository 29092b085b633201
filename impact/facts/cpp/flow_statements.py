"""C++ statements to guards: under which conditions what stands in a function runs.

Every statement tells how control leaves it: STAYS (what follows runs), JUMPS (it never does), BREAKS (it leaves the
switch or loop around it), or, where it depends, the conditions under which what follows runs. Those are guards too.
A jump out of a loop from inside it says nothing about what follows the loop.
"""

import re
from bisect import bisect_right
from collections.abc import Callable, Iterator
from typing import NamedTuple

from tree_sitter import Node

from ..flow import Assignment, FlowExpr
from .flow_clean import Regions
from .flow_declarations import Declarations
from .flow_grammar import KIND, find_node_readers, get_items, get_kinds, list_children
from .flow_values import ESCAPE, READ, RETURN, VALUES, flatten


class FlowCondition(NamedTuple):
    """What must hold for what follows a statement to run. code: the text in C++, where that is another."""

    kind: str
    text: str
    line: int
    code: str = ""


STAYS = 0
JUMPS = 1
BREAKS = 2
Leaving = int | tuple[FlowCondition, ...]

ALTERNATIVES = (KIND.preproc_else, KIND.preproc_elif, KIND.preproc_elifdef)

_WORD = re.compile(r"[A-Za-z_]\w*")
_CONTINUE = re.compile(r"\bcontinue\b")
_MARKS = re.compile(r"[()\[\]{}]|\|\||\?|,|(?<![=!<>])=(?!=)")
NEVER_RETURNS = frozenset((
    "exit", "_exit", "::exit", "std::exit", "abort", "::abort", "std::abort", "std::terminate", "std::quick_exit",
    "ROS_BREAK",
))  # fmt: skip
ASSERTS = frozenset(("assert", "ROS_ASSERT"))
LONGEST_COMPOSED = 3000
MOST_CONDITIONS = 500
MOST_VALUES = 64


def negate_conditions(conditions: tuple[FlowCondition, ...]) -> str | None:
    """The text of when not all of some conditions hold; None when that has no words."""
    pieces: list[str] = []
    for condition in conditions:
        if condition.kind == "unless":
            pieces.append(condition.text)
        elif condition.kind in ("if", "case"):
            pieces.append(f"!({condition.code or condition.text})")
        else:
            return None
    return " || ".join(add_parentheses(piece) for piece in pieces) if len(pieces) > 1 else pieces[0]


def _is_thrown_again(body: Node | None) -> bool:
    """Whether at the end of a handler what it caught is thrown again, as it would be without the handler."""
    inside = [child for child in body.children if child.is_named] if body is not None else []
    return bool(inside) and inside[-1].kind_id == KIND.throw_statement and inside[-1].child_count == 2


def add_parentheses(text: str) -> str:
    """A condition that may stand beside `&&`."""
    depth = 0
    for mark in _MARKS.finditer(text):
        sign = mark[0]
        if sign in "([{":
            depth += 1
        elif sign in ")]}":
            depth -= 1
        elif depth == 0:
            return f"({text})"
    return text


class CppStatements(Declarations):
    """The reader of statements."""

    def visit_statement(self, node: Node, guard: int) -> Leaving:
        if self.regions is not None:
            guard = self.add_region_guards(self.regions, node, guard)
        read = STATEMENTS.get(node.kind_id)
        if read is not None:
            return read(self, node, guard)
        value = VALUES.get(node.kind_id)
        if value is not None:
            value(self, node, guard, READ, "")
        elif node.child_count:
            return self.read_compound_statement(node, guard)
        return STAYS

    def add_region_guards(self, regions: Regions, node: Node, guard: int) -> int:
        """Adds the conditions of blanked directives that a statement, but not the one around it, stands under."""
        start = node.start_byte
        parent = node.parent
        if parent is not None and parent.kind_id == KIND.else_clause:
            parent = parent.parent
        for region in regions.list_between(parent.start_byte if parent is not None else -1, start):
            guard = self.guard("cpp", region.condition, region.line, guard)
        return guard

    def read_compound_statement(self, node: Node, guard: int) -> Leaving:
        return self.visit_sequence(node.named_children, guard)

    def visit_sequence(self, children: list[Node], guard: int) -> Leaving:
        """Statements one after the other."""
        base = guard
        ended = STAYS
        conditions: list[FlowCondition] = []
        headed: Node | None = None
        jumped: Node | None = None
        regions = self.regions
        for place, child in enumerate(children):
            number = child.kind_id
            if number == KIND.comment:
                continue
            if jumped is not None and number != KIND.labeled_statement:
                guard = self.add_never_guard(jumped, guard)
                jumped = None
            if headed is not None:
                outer = self.guard("macro", self.spell_node(headed), self.find_line(headed), guard)
                headed = None
                self.visit_statement(child, outer)
                continue
            if number == KIND.expression_statement and child.child_count == 2 and child.children[1].is_missing:
                if self.is_statement_head(child, children[place + 1 : place + 20]):
                    headed = child.children[0]
                    self.follow(headed, guard)
                    continue
            elif number == KIND.labeled_statement:
                guard, conditions, ended, jumped = base, [], STAYS, None
            read = STATEMENTS.get(number) if regions is None else None
            leaving = self.visit_statement(child, guard) if read is None else read(self, child, guard)
            if regions is not None and leaving in (JUMPS, BREAKS):
                leaving = self.limit_leaving(regions, child, leaving)
            if leaving == STAYS or ended:
                continue
            if not isinstance(leaving, tuple):
                ended, jumped = leaving, child
                continue
            conditions += leaving
            for condition in leaving:
                guard = self.guard(condition.kind, condition.text, condition.line, guard)
        return ended or tuple(conditions) or STAYS

    def add_never_guard(self, node: Node, guard: int) -> int:
        """A guard around what stands behind a statement that always leaves."""
        word = _WORD.search(self.text, node.start_byte, node.end_byte)
        return self.guard("never", f"after {word[0] if word else 'a jump'}", self.find_line(node), guard)

    def limit_leaving(self, regions: Regions, node: Node, leaving: Leaving) -> Leaving:
        """How control leaves a jump: only where the blanked directives let it be compiled that the statements around it
        do not stand under."""
        parent = node.parent
        around = parent.start_byte if parent is not None else node.start_byte
        inner = regions.list_between(around, node.start_byte)
        if not inner:
            return leaving
        return (FlowCondition("cpp", f"!({inner[0].condition})", inner[0].line),) if len(inner) == 1 else STAYS

    def is_statement_head(self, node: Node, children: list[Node]) -> bool:
        """Whether `NAME(...)` without a semicolon is the head of the statement that follows it: one on the same line,
        or further to the right."""
        following = next((child for child in children if child.start_byte >= node.end_byte and child.is_named), None)
        if following is None or node.children[0].kind_id != KIND.call_expression:
            return False
        _line, column = self.locate(node.start_byte)
        next_line, next_column = self.locate(following.start_byte)
        last_line = bisect_right(self.starts, node.end_byte)
        return next_line == last_line or (next_line <= last_line + 1 and next_column > column)

    def visit_condition(self, node: Node, guard: int) -> str:
        """Reads the condition in parentheses of an if, while or switch; gives its text."""
        children = get_items(node)
        for child in children:
            if child.kind_id == KIND.init_statement:
                for part in child.children:
                    if part.is_named:
                        self.visit_statement(part, guard)
            else:
                self.follow(child, guard, READ, None)
        if not children:
            return ""
        return self.format_condition(children[-1])

    def read_if_statement(self, node: Node, guard: int) -> Leaving:
        """An if with its chain of else-ifs, which is walked along since it is a deep tree."""
        branches: list[tuple[FlowCondition, Leaving]] = []
        last: Leaving = STAYS
        while True:
            asked, then = node.child_by_field_name("condition"), node.child_by_field_name("consequence")
            other = node.child_by_field_name("alternative")
            if asked is None:
                return self.visit_sequence(node.named_children, guard)
            line = self.find_line(node)
            text = self.visit_condition(asked, guard)
            leaving = self.visit_statement(then, self.guard("if", text, line, guard)) if then is not None else STAYS
            branches.append((FlowCondition("unless", text, line), leaving))
            if other is None:
                break
            guard = self.guard("unless", text, line, guard)
            follows = next(
                (child for child in reversed(other.children) if child.is_named and child.kind_id != KIND.comment), None
            )
            if follows is None:
                break
            if follows.kind_id == KIND.if_statement and self.regions is None:
                node = follows
                continue
            last = self.visit_statement(follows, guard)
            break
        for asked_, leaving in reversed(branches):
            last = self.merge_leavings(asked_, leaving, last)
        return last

    def merge_leavings(self, asked: FlowCondition, yes: Leaving, no: Leaving) -> Leaving:
        """How control leaves an if, from how it leaves its branches. asked: that its condition does not hold."""
        yes_ends = yes in (JUMPS, BREAKS)
        no_ends = no in (JUMPS, BREAKS)
        if yes_ends and no_ends:
            return yes if yes == no else BREAKS
        if yes_ends:
            return (asked, *no) if isinstance(no, tuple) and len(no) < MOST_CONDITIONS else (asked,)
        if no_ends:
            holds = FlowCondition("if", asked.text, asked.line)
            return (holds, *yes) if isinstance(yes, tuple) and len(yes) < MOST_CONDITIONS else (holds,)
        if yes == STAYS and isinstance(no, tuple) and len(no) == 1 and no[0].kind == "if":
            # Branches that go on, before an else that does not.
            text = f"{asked.text} || {no[0].text}"
            return (FlowCondition("if", text, asked.line),) if len(text) < LONGEST_COMPOSED else STAYS
        result: list[FlowCondition] = []
        for head, leaving in ((add_parentheses(asked.text), yes), (f"!({asked.text})", no)):
            if isinstance(leaving, tuple):
                tail = negate_conditions(leaving)
                if tail is not None and len(head) + len(tail) < LONGEST_COMPOSED:
                    result.append(FlowCondition("unless", f"{head} && {add_parentheses(tail)}", leaving[0].line))
        return tuple(result) or STAYS

    def read_while_statement(self, node: Node, guard: int) -> Leaving:
        asked, body = node.child_by_field_name("condition"), node.child_by_field_name("body")
        if asked is not None and body is not None:
            text = self.visit_condition(asked, guard)
            self.visit_statement(body, self.guard("while", text, self.find_line(node), guard))
        return STAYS

    def read_for_statement(self, node: Node, guard: int) -> Leaving:
        fields = ("initializer", "condition", "update", "body")
        begun, asked, update, body = map(node.child_by_field_name, fields)
        text = ""
        if begun is not None:
            self.follow(begun, guard, READ, None)
        if asked is not None:
            self.follow(asked, guard, READ, None)
            text = self.format_condition(asked)
        inner = self.guard("while", text or "true", self.find_line(node), guard)
        if body is not None:
            self.visit_statement(body, inner)
        if update is not None:
            self.follow(update, inner, READ, None)
        return STAYS

    def read_for_range_loop(self, node: Node, guard: int) -> Leaving:
        children = node.children
        declarator = node.child_by_field_name("declarator")
        walked = node.child_by_field_name("right")
        body = node.child_by_field_name("body")
        if declarator is None or walked is None or body is None:
            return self.visit_sequence(node.named_children, guard)
        container = self.follow(walked, guard, READ)
        name, marks = self.split_declarator(declarator)
        head_end = next((child.start_byte for child in children if child.kind_id == KIND.closing), walked.end_byte)
        head = next((child.end_byte for child in children if child.kind_id == KIND.opening), node.start_byte)
        line = self.find_line(node)
        inner = self.guard("for", flatten(self.text[head:head_end]), line, guard)
        if name is not None:
            type_ = self.find_written_type(children)
            each = FlowExpr("index", "", (container, FlowExpr("other")))
            parts = [part for part in name.children if part.is_named]
            for place, part in enumerate(parts or (name,)):
                variable = self.text[part.start_byte : part.end_byte]
                self.known.add(variable)
                value = FlowExpr("index", "", (each, FlowExpr("number", str(place)))) if parts else each
                self.assignments.append(Assignment(variable, value, line, inner, type_ + marks))
        self.visit_statement(body, inner)
        return STAYS

    def read_do_statement(self, node: Node, guard: int) -> Leaving:
        body = node.child_by_field_name("body")
        asked = node.child_by_field_name("condition")
        if body is None or asked is None:
            return self.visit_sequence(node.named_children, guard)
        text = self.format_condition(asked)
        inner = self.guard("do", text, self.find_line(node), guard)
        leaving = self.visit_statement(body, inner)
        self.follow(asked, inner)
        # `do { ... } while (false)` runs once: a return inside is one outside, and `continue` goes on behind it.
        goes_on = _CONTINUE.search(self.text, body.start_byte, body.end_byte)
        return JUMPS if leaving == JUMPS and not goes_on else STAYS

    def read_switch_statement(self, node: Node, guard: int) -> Leaving:
        asked = next((child for child in node.children if child.kind_id == KIND.condition_clause), None)
        body = node.child_by_field_name("body")
        if asked is None or body is None:
            return self.visit_sequence(node.named_children, guard)
        subject = self.visit_condition(asked, guard)
        line = self.find_line(node)
        cases = list(self.list_cases(body))
        named = [value for value, *_ in cases if value is not None]
        falling: list[str] = []
        other = False
        # Per label: how control leaves it at its end.
        leavings: list[tuple[str | None, Leaving]] = []
        for value, case, statements, condition in cases:
            if value is None:
                other = True
            else:
                falling.append(value)
            text = self.format_case(subject, falling, other, named)
            inner = guard
            if condition is not None:
                inner = self.guard("cpp", condition, self.find_line(case), inner)
            if text:
                inner = self.guard("case", text, self.find_line(case), inner)
            if not statements:
                leavings.append((value, STAYS))
                continue
            leaving = self.visit_sequence(statements, inner)
            leavings.append((value, leaving))
            if leaving in (JUMPS, BREAKS):
                falling, other = [], False
        for child in body.children:
            if child.kind_id != KIND.case_statement and child.is_named and child.kind_id not in PREPROC:
                self.visit_statement(child, guard)
        return self.merge_case_leavings(subject, leavings, line)

    def list_cases(self, body: Node):
        """The labels of a switch, nested ones too: value (None for default), node, statements, condition of #if."""
        for child in body.children:
            if child.kind_id == KIND.case_statement:
                yield from self.list_labels(child, None)
            elif child.kind_id in PREPROC:
                branches = list(self.list_branches(child))
                asked = branches[0][0]
                for place, (_, statements, _) in enumerate(branches):
                    for part in statements:
                        if part.kind_id == KIND.case_statement:
                            yield from self.list_labels(part, f"!({asked})" if place else asked)

    def list_labels(self, case: Node, condition: str | None):
        children = case.children
        colon = next((index for index, child in enumerate(children) if child.kind_id == KIND.colon), len(children) - 1)
        value: str | None = None
        if children[0].kind_id == KIND.case_word:
            value = flatten(self.text[children[0].end_byte : children[colon].start_byte])
        statements: list[Node] = []
        nested: Node | None = None
        for child in children[colon + 1 :]:
            if child.kind_id == KIND.case_statement:
                nested = child
                break
            if child.is_named and child.kind_id != KIND.comment:
                statements.append(child)
        yield value, case, statements, condition
        if nested is not None:
            yield from self.list_labels(nested, condition)

    @staticmethod
    def format_case(subject: str, falling: list[str], other: bool, named: list[str]) -> str:
        if other:
            if len(named) > MOST_CONDITIONS:
                return f"{subject} other than {len(named)} values"
            rest = [value for value in named if value not in falling]
            return f"{subject} other than {', '.join(rest)}" if rest else ""
        if len(falling) > MOST_VALUES:
            return f"{subject} == one of {len(falling)} values"
        return f"{subject} == {' or '.join(falling)}"

    def merge_case_leavings(self, subject: str, leavings: list[tuple[str | None, Leaving]], line: int) -> Leaving:
        jumping: list[str | None] = []
        staying: list[str | None] = []
        last: Leaving = STAYS
        for value, leaving in reversed(leavings):
            # A label without an end of its own falls into the next one.
            if leaving != STAYS and not isinstance(leaving, tuple):
                last = leaving
            (jumping if last == JUMPS else staying).append(value)
        if not jumping:
            return STAYS
        if None in jumping:
            if not staying:
                return JUMPS
            values = [str(value) for value in reversed(staying)]
            code = " || ".join(f"{subject} == {value}" for value in values)
            return (FlowCondition("case", f"{subject} == {' or '.join(values)}", line, code),)
        values = [str(value) for value in reversed(jumping)]
        code = " && ".join(f"{subject} != {value}" for value in values)
        return (FlowCondition("case", f"{subject} other than {', '.join(values)}", line, code),)

    def read_try_statement(self, node: Node, guard: int) -> Leaving:
        leaving: Leaving = STAYS
        caught: list[tuple[FlowCondition, Leaving]] = []
        for child in node.children:
            number = child.kind_id
            if number == KIND.catch_clause:
                listed = next((part for part in child.children if part.kind_id == KIND.parameter_list), None)
                text = flatten(self.text[listed.start_byte + 1 : listed.end_byte - 1]) if listed is not None else "..."
                line = self.find_line(child)
                self.add_parameters(listed)
                body = next((part for part in child.children if part.kind_id == KIND.compound_statement), None)
                inner = self.guard("catch", text, line, guard)
                left = self.visit_statement(body, inner) if body is not None else STAYS
                if not _is_thrown_again(body):
                    caught.append((FlowCondition("catch", text, line), left))
            elif number == KIND.compound_statement:
                leaving = self.visit_statement(child, guard)
            elif number == KIND.field_initializer_list:
                self.visit_statement(child, guard)
        going_on = [asked for asked, left in caught if left != JUMPS and left != BREAKS]
        if leaving in (JUMPS, BREAKS):
            if not going_on:
                return leaving
            return (going_on[0],) if len(going_on) == 1 else STAYS
        conditions = leaving if isinstance(leaving, tuple) else ()
        conditions += tuple(
            FlowCondition("unless", f"catch ({asked.text})", self.find_line(node))
            for asked, left in caught
            if left in (JUMPS, BREAKS)
        )
        return conditions or STAYS

    def read_return_statement(self, node: Node, guard: int) -> Leaving:
        for child in node.children:
            if child.is_named and child.kind_id != KIND.comment:
                value = self.follow(child, guard, ESCAPE, RETURN)
                self.assignments.append(Assignment("", value, self.find_line(node), guard, "", "return"))
        return JUMPS

    read_co_return_statement = read_return_statement

    def read_throw_statement(self, node: Node, guard: int) -> Leaving:
        self.visit_anything(node, guard, ESCAPE, "")
        return JUMPS

    def read_expression_statement(self, node: Node, guard: int) -> Leaving:
        child = node.children[0]
        number = child.kind_id
        if number == KIND.comment:
            child = next((part for part in node.children if part.kind_id != KIND.comment), child)
            number = child.kind_id
        value = VALUES[number](self, child, guard, READ, "")
        if number == KIND.call_expression:
            if value.kind == "call":
                if value.text in NEVER_RETURNS:
                    return JUMPS
                if value.text in ASSERTS and value.parts:
                    arguments = child.children[-1].children
                    return (FlowCondition("if", self.format_condition(arguments[1]), self.find_line(node)),)
        elif number == KIND.throw_statement:
            return JUMPS
        return STAYS

    def read_labeled_statement(self, node: Node, guard: int) -> Leaving:
        return self.visit_sequence(node.named_children[1:], guard)

    def read_function_definition(self, node: Node, guard: int) -> Leaving:
        """`NAME(...) { ... }` inside a function, which the grammar takes for a function's definition."""
        children = list_children(node)
        body = next((child for child in children if child.kind_id == KIND.compound_statement), None)
        head = next((child for child in children if child.kind_id == KIND.function_declarator), None)
        if body is None or head is None:
            return self.visit_sequence(node.named_children, guard)
        known = set(self.known)
        self.add_parameters(next((part for part in head.children if part.kind_id == KIND.parameter_list), None), guard)
        text = flatten(self.text[node.start_byte : body.start_byte])
        self.visit_statement(body, self.guard("macro", text, self.find_line(node), guard))
        self.known = known | self.known
        return STAYS

    def list_branches(self, node: Node) -> Iterator[tuple[str, list[Node], int]]:
        """The branches of an #if: condition (empty for #else), what stands in it, line."""
        branch: Node | None = node
        while branch is not None:
            asked, statements, rest = self.split_branch(branch)
            yield asked, statements, self.find_line(branch)
            branch = rest

    def split_branch(self, node: Node) -> tuple[str, list[Node], Node | None]:
        """The condition of an #if, #ifdef, #elif or #else, what stands in it, and the branch after it."""
        children = node.children
        first = children[0]
        word = self.text[first.start_byte : first.end_byte].replace(" ", "").replace("\t", "")
        start = 1
        asked = ""
        if word != "#else" and len(children) > 1:
            asked = self.find_directive_text(children[1].start_byte)
            start = 2
            if word.endswith("ndef"):
                asked = f"!(defined({asked}))"
            elif word.endswith("def"):
                asked = f"defined({asked})"
        statements: list[Node] = []
        rest: Node | None = None
        for child in children[start:]:
            if child.kind_id in ALTERNATIVES:
                rest = child
            elif child.is_named:
                statements.append(child)
        return asked, statements, rest

    def find_directive_text(self, start: int) -> str:
        """The rest of a directive's line."""
        end = self.text.find("\n", start)
        while end > 0 and self.text[end - 1] == "\\":
            end = self.text.find("\n", end + 1)
        return flatten(self.text[start : end if end >= 0 else len(self.text)].replace("\\\n", " "))

    def read_preproc_if(self, node: Node, guard: int) -> Leaving:
        """#if in a function; its branches are walked along."""
        ends: list[tuple[str, Leaving]] = []
        for asked, statements, line in self.list_branches(node):
            if ends and ends[-1][0]:
                guard = self.guard("cpp", f"!({ends[-1][0]})", line, guard)
            inner = self.guard("cpp", asked, line, guard) if asked else guard
            ends.append((asked, self.visit_sequence(statements, inner)))
        line = self.find_line(node)
        gone = [left in (JUMPS, BREAKS) for _, left in ends]
        if all(gone) and not ends[-1][0]:
            return ends[0][1]
        conditions: list[FlowCondition] = []
        for (asked, _), jumps in zip(ends, gone, strict=True):
            if jumps and asked:
                conditions.append(FlowCondition("cpp", f"!({asked})", line))
            elif jumps and len(ends) == 2 and not gone[0]:
                conditions.append(FlowCondition("cpp", ends[0][0], line))
            elif not jumps:
                break
        return tuple(conditions) or STAYS

    read_preproc_ifdef = read_preproc_if

    def read_ERROR(self, node: Node, guard: int) -> Leaving:
        """What did not parse: its pieces are read all the same, and nothing is concluded from their order."""
        for child in node.children:
            if child.is_named:
                self.visit_statement(child, guard)
        return STAYS

    def read_class_specifier(self, node: Node, guard: int) -> Leaving:
        self.add_local_type(node)
        return STAYS

    read_struct_specifier = read_union_specifier = read_enum_specifier = read_class_specifier


PREPROC = get_kinds("preproc_if", "preproc_ifdef")
STATEMENTS: dict[int, Callable[..., Leaving]] = {
    **find_node_readers(CppStatements, "read_"),
    **dict.fromkeys(get_kinds("continue_statement", "goto_statement"), lambda *_: JUMPS),
    **dict.fromkeys(get_kinds("break_statement"), lambda *_: BREAKS),
    **dict.fromkeys(
        get_kinds("comment", "preproc_def", "preproc_function_def", "preproc_call", "preproc_include",
              "static_assert_declaration", "access_specifier"),
        lambda *_: STAYS,
    ),
}  # fmt: skip
