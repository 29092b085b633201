"""What follows a statement that may jump: the conditions under which control gets there."""

import ast
from typing import NamedTuple


class HoldingCondition(NamedTuple):
    """A condition that holds behind a statement: kind, text and line of the Guard it becomes. opposite: the text of
    when it does not hold, to stand beside `and`, where kind and text do not give it."""

    kind: str
    text: str
    line: int
    opposite: str = ""


# How control leaves statements: not at all, or at their end under these conditions.
Leaving = tuple[HoldingCondition, ...] | None
STAYS: tuple[HoldingCondition, ...] = ()
JUMPS = None

LONGEST_COMPOSED = 1000
_LOOSE = (ast.IfExp, ast.Lambda, ast.NamedExpr, ast.Yield, ast.YieldFrom)


class AskedCondition(NamedTuple):
    """A condition that was asked, as text that can stand beside `and`, `or` and behind `not`."""

    text: str
    line: int
    conjunct: str
    negation: str


def make_condition(node: ast.expr, text: str, operand: str) -> AskedCondition:
    """The condition of an if. operand: the source of what it negates, empty for none."""
    cls = node.__class__
    loose = cls in _LOOSE or (cls is ast.BoolOp and node.op.__class__ is ast.Or)  # type: ignore[attr-defined]
    conjunct = f"({text})" if loose else text
    if operand:
        inner = node.operand.__class__  # type: ignore[attr-defined]
        return AskedCondition(text, node.lineno, text, f"({operand})" if inner in (*_LOOSE, ast.BoolOp) else operand)
    simple = cls in (ast.Name, ast.Attribute, ast.Call, ast.Subscript)
    return AskedCondition(text, node.lineno, conjunct, f"not {text}" if simple else f"not ({text})")


def merge_leavings(asked: AskedCondition, yes: Leaving, no: Leaving) -> Leaving:
    """How control leaves an if, from how it leaves its two branches."""
    if yes is None:
        return JUMPS if no is None else (HoldingCondition("unless", asked.text, asked.line), *no)
    if no is None:
        return (HoldingCondition("if", asked.text, asked.line), *yes)
    if not yes and not no:
        return STAYS
    if not yes and len(no) == 1 and no[0].kind == "if" and len(asked.text) + len(no[0].text) < LONGEST_COMPOSED:
        texts = (f"({text})" if " else " in text else text for text in (asked.text, no[0].text))
        return (HoldingCondition("if", " or ".join(texts), asked.line),)
    return (*combine_with_head(asked.conjunct, yes), *combine_with_head(asked.negation, no))


def combine_with_head(head: str, leaving: tuple[HoldingCondition, ...]) -> tuple[HoldingCondition, ...]:
    """What holds behind a branch that is entered when `head` holds and is left at its end under conditions."""
    result: list[HoldingCondition] = []
    for condition in leaving:
        tail = _negate_condition(condition)
        if tail and len(head) + len(tail) < LONGEST_COMPOSED:
            result.append(HoldingCondition("unless", f"{head} and {tail}" if head else tail, condition.line))
    return tuple(result)


def _negate_condition(condition: HoldingCondition) -> str:
    """The text of when a condition does not hold, beside an `and`; empty when that has no words."""
    if condition.opposite or condition.text.startswith("except"):
        return condition.opposite
    if condition.kind == "unless":
        return f"({condition.text})" if " or " in condition.text or " else " in condition.text else condition.text
    return f"not ({condition.text})" if condition.kind == "if" else ""
