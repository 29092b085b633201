"""Condition attributes of package.xml, after REP 149 and catkin_pkg."""

import ast
import re
from functools import lru_cache

from .environment import Environment
from .python import evaluate_truth, parse_expression

_TOKEN = re.compile(r"\s*(?:(==|!=|<=|>=|<|>|\(|\))|\$([A-Za-z_]\w*)|\"([^\"]*)\"|'([^']*)'|([\w.-]+))")
_KNOWN = frozenset(("ROS_DISTRO", "ROS_VERSION", "ROS_PYTHON_VERSION"))


@lru_cache(1024)
def _parse_expression(text: str) -> ast.expr | None:
    """A condition as an expression of Python, where comparisons, `and` and `or` mean the same; None for what is none.

    REP 149: a variable that is not set is the empty text."""
    words: list[str] = []
    position, text = 0, text.strip()
    while position < len(text):
        match = _TOKEN.match(text, position)
        if match is None:
            return None
        position = match.end()
        word = match.group(match.lastindex or 0)
        if match.lastindex == 2:
            words.append(f"os.environ[{word!r}]" if word in _KNOWN else "''")
        else:
            words.append(word if match.lastindex == 1 or match.group(5) in ("and", "or") else repr(word))
    node = parse_expression(" ".join(words))
    return node if node is not None and _is_condition(node) else None


def _is_condition(node: ast.expr) -> bool:
    """Whether an expression is made of comparisons of two texts."""
    if isinstance(node, ast.BoolOp):
        return all(map(_is_condition, node.values))
    return (
        isinstance(node, ast.Compare)
        and len(node.ops) == 1
        and not any(isinstance(operand, (ast.BoolOp, ast.Compare)) for operand in (node.left, *node.comparators))
    )


def evaluate(text: str, environment: Environment) -> bool | None:
    """Whether a condition holds; None where it cannot be known."""
    if not text.strip():
        return True
    node = _parse_expression(text)
    return None if node is None else evaluate_truth(node, environment)
